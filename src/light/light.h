/* The kind "scene": light and what else belongs to the whole scene. */
#ifndef LIMNER_LIGHT_LIGHT_H
#define LIMNER_LIGHT_LIGHT_H

#include "technique/technique.h"

extern const kind kind_scene;

enum { LIGHTS_MAX = 8 };

typedef enum light_source { LIGHTS_STUDIO, LIGHTS_FILE } light_source;
/* Which coarse meshes are drawn curved: src/plan/round_scene.h. */
typedef enum round_kind { ROUND_NONE, ROUND_ALL, ROUND_FORMS } round_kind;
/* Which tones are drawn as paper and as black: src/plan/tone_range.h. */
typedef enum tone_range_kind { TONE_RANGE_NONE, TONE_RANGE_AUTO } tone_range_kind;
/* What a model stands on: src/plan/ground.h. */
typedef enum ground_kind { GROUND_NONE, GROUND_CONTACT, GROUND_CAST } ground_kind;

/* The parameters, read by src/plan and src/frame when it sets the scene up. */
typedef struct scene_values {
    direction   light_direction;
    float       fill, rim, crease_angle;
    int32_t     round, lights;
    float       light_scale;
    bool        shadows;
    float       shadow_softness, occlusion, occlusion_radius;
    int32_t     tone_range, ground;
    float       ground_strength, ground_reach, ground_fade, ground_edge, ground_hatch, ground_angle, ground_smoothing;
    bool        ground_flat;
    colour      ground_colour;
    float       focus, focus_at, focus_depth;
    float       depth_cue;
    param_words datum, datum_words;
    palette     datum_palette;
    float       datum_from, datum_to;
    int32_t     datum_classes;
    colour      datum_other;
    param_words cut, cut_keep;
    float       cut_hatch, cut_angle, cut_width;
    colour      cut_colour, cut_fill;
} scene_values;

#endif
