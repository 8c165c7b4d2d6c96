/* Pictures that passes write and read. One row has all there is to know of a picture; formats, sizes, clearing,
 * declarations in shaders and lifetimes follow from it. Pictures that one technique alone makes and reads are rows
 * of its own (technique.targets). */
#ifndef LIMNER_TECHNIQUE_TARGET_H
#define LIMNER_TECHNIQUE_TARGET_H

#include <stdbool.h>

/* Pictures by which techniques know of each other. What is in them: target.c. */
typedef enum target {
    TARGET_NONE = 0,
    TARGET_NORMAL_DEPTH,
    TARGET_ID,
    TARGET_ALBEDO,
    TARGET_FORM,
    TARGET_FORM_HALF,
    TARGET_SHADE,
    TARGET_REST,
    TARGET_VELOCITY,
    TARGET_DETAIL,
    TARGET_PAST_1,
    TARGET_PAST_2,
    TARGET_PAST_3,
    TARGET_STRETCHED,
    TARGET_DEPTH,
    TARGET_MEETING,
    TARGET_EDGE,
    TARGET_EDGE_BEFORE,
    TARGET_NEARER,
    TARGET_DASH,
    TARGET_OVERSHOOT,
    TARGET_STROKES,
    TARGET_GROUND,
    TARGET_UNCERTAINTY,
    TARGET_FIELD,
    TARGET_REFLECTION,
    TARGET_SHADOW,
    TARGET_DIRECTION,
    TARGET_MOVER,
    TARGET_MOVER_DEPTH,
    TARGET_SCENE_DEPTH,
    TARGET_LAYERS,
    TARGET_PAGE,
    TARGET_COUNT
} target;

/* Behind them lie the technique's own, in the order of its rows. */
enum { OWN_TARGETS_MAX = 14, TARGET_SLOTS = TARGET_COUNT + OWN_TARGETS_MAX };
#define TARGET_OWN(index) ((target)(TARGET_COUNT + (index)))

typedef enum target_format {
    TEXEL_NONE,
    TEXEL_R8,
    TEXEL_RGBA8,
    TEXEL_RGBA16F,
    TEXEL_RGBA32F,
    TEXEL_RG32UI,
    TEXEL_RGBA32UI,
    TEXEL_DEPTH32F,
    TEXEL_FORMAT_COUNT
} target_format;

/* Texels of a picture. */
typedef enum target_scale {
    SCALE_PAGE,  /* one a pixel */
    SCALE_HALF,  /* one for 2² pixels, of that at their lower left */
    SCALE_APART, /* one for DIRECTION_APART² pixels, of the one in its middle */
    SCALE_CELL,  /* one a cell of the figure's perturbation, at its corners */
    SCALE_TILE,  /* one a square of TILE_PIXELS² pixels */
    SCALE_OWN    /* as who makes it says */
} target_scale;

enum { DIRECTION_APART = 4, TILE_PIXELS = 16 };

/* Who has a picture, and until when. Figures that are layered have theirs from the first layer to the last. */
typedef enum target_owner {
    OWNER_TECHNIQUE, /* the technique, while its passes run */
    OWNER_LINES,     /* the figure, until its next line technique begins */
    OWNER_ALL_LINES, /* the figure, until its lines are looked for again */
    OWNER_FIGURE,    /* the figure */
    OWNER_LAYER,     /* the figure; of layered ones, the layer, for all of them */
    OWNER_LAYERS,    /* all layers together, for all their figures */
    OWNER_FRAME      /* the frame */
} target_owner;

/* The far plane's depth, in `empty`. */
#define EMPTY_FAR (-1.0f)

typedef struct target_row {
    const char   *name; /* of the sampler, "t_edge"; passes that read a picture that is there get HAS_EDGE besides */
    target_format format;
    target_scale  scale;
    target_owner  owner;
    bool          filtered; /* samplers mix texels; whoever wants whole ones fetches them */
    float empty[4]; /* what it is cleared to: what later passes find where nothing was drawn. Of depth: always 1 */
} target_row;

extern const target_row target_rows[TARGET_COUNT];

/* What the picture is cleared to, with this far plane. */
void target_empty(const target_row *row, double far, float out[4]);

#endif
