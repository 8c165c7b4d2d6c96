/* One frame: runs a plan on the GPU. */
#ifndef LIMNER_FRAME_FRAME_H
#define LIMNER_FRAME_FRAME_H

#include "gpu/profile.h"
#include "limner/maps.h"
#include "plan/camera.h"
#include "plan/tone_range.h"
#include "plan/ground.h"
#include "plan/plan.h"
#include "stage/plan_textures.h"
#include "stage/upload.h"
#include "stroke/stroke.h"
#include "trace/trace.h"

typedef struct frame_maps frame_maps;

/* Dots and strokes on surfaces, of all figures: those there are, those that were drawn, what they take on the GPU. Of
 * clusters the same, and how many marks were left out with or in them: outside of the page, on faces that turn away, or
 * more than the most that can be needed there. */
typedef struct mark_facts {
    uint64_t there, drawn, bytes, clusters, clusters_drawn, beside, turned_away, too_dense;
} mark_facts;

typedef struct frame {
    gpu                 *g;
    upload              *up;
    const plan          *plan;
    const used_textures *sheet; /* of the plan's sheet */
    view_camera          camera;
    view_camera          camera_past[POSE_PAST_MAX]; /* where it was at the steps of the pose's past */
    int                  width, height;              /* of the page, supersamples counted */
    int                  samples;                    /* a side */
    int          window[4]; /* of the page, from its lower left corner: what will be looked at; width 0: all of it */
    double       pixels_per_mm; /* of paper, supersamples counted */
    colour       ground;
    box3         anchor; /* strokes that lie on the page move with its middle */
    uint32_t     seed;
    double       time_s;
    gpu_profile  profile;
    frame_maps  *maps; /* collects the figures' buffers when not NULL */
    gpu_texture *page, *page_depth;
    bool         draft;       /* lmn_draw_desc.draft */
    bool         keeps_depth; /* of the page, for who asks after frame_draw */
    gpu_texture *kept_depth;  /* with keeps_depth: the page's; the caller's to release */
    gpu_texture
        *seen_depth; /* the same of what is seen through or moves, which the page's leaves out; NULL: there is none */
    gpu_texture *moved_depth; /* of what is seen through and perturbed, where its sketch is; NULL: there is none */
    int          seen_reach;  /* how far ink of that lies beside it, samples */
    gpu_texture *facts;       /* what is known of parts in packs: facts.c; NULL: there are none, or no page is drawn */
    gpu_texture *shadow;      /* depth of what the first light sees; NULL: it throws no shadow */
    view_camera  shadow_camera; /* the light's eye */
    gpu_texture *visibility; /* light that arrives at what is seen, soft; NULL: the look wants neither soft shadows nor
                                occlusion */
    tone_range     tone_range;
    ground_plane   ground_plane;                /* what the model stands on */
    float          clip_plane[4];               /* eye space, while a mirror's view is drawn */
    int            layers;                      /* drawn by the deepest stack */
    const char    *producer;                    /* of layers; NULL: there were none */
    bool           lists_full;                  /* lists had no room, so that layers were peeled instead */
    const figure  *mirror;                      /* whose view is drawn; NULL: the scene itself */
    uint64_t       strokes[STROKE_CLASS_COUNT]; /* that were chained and drawn */
    mark_facts     marks;
    outline_search search; /* for them */
    trace_facts    traces; /* of all figures */
} frame;

/* The camera of strokes: what the frame sees, on its sheet, whatever pixels it has. All its bytes are set. */
stroke_camera frame_sheet_camera(const frame *f);

/* Draws the page and encodes it into `out` (RGBA8, width/samples wide). Errors stick to the GPU. */
void frame_draw(frame *f, gpu_texture *out);

/* The same for pictures of several times. Each is drawn and taken into the mean (RGBA32F, made when *mean is NULL, the
 * caller's to release), of which it is this `part` of all so far; then the mean is encoded. */
void frame_draw_into_mean(frame *f, gpu_texture **mean, double part);
/* Instead, laid over each other: each channel of a pixel keeps what differs most from the ground; of this picture, that
 * is made less by `ink` first. Where it has the parts that `hides` says (NULL: none), it alone is kept. */
void frame_draw_onto_plate(frame *f, gpu_texture **plate, double ink, bool *hides);
void frame_encode_mean(frame *f, gpu_texture *mean, gpu_texture *out);

/* What one layer was made of: 28 bytes a pixel. */
typedef struct layer_map {
    float    depth; /* eye depth, INFINITY where empty */
    float    normal[3];
    uint32_t id;
    uint8_t  edge[4], shade[4]; /* shade: sRGB, straight alpha */
} layer_map;

/* Those of all layers, nearest first. */
typedef struct layer_maps {
    layer_map **items;
    size_t      count, capacity;
} layer_maps;

enum { FRAME_MAPS = LMN_MAP_DIRECTION + 1 };

/* What the figures were made of, merged by nearest depth; row 0 at the bottom. */
struct frame_maps {
    int       x, y, width, height; /* of the page: a pixel for a pick, else all of it */
    float    *depth;               /* eye depth, INFINITY where empty */
    float    *normal;              /* 3 */
    uint32_t *id;
    float    *edge;        /* 4 */
    float    *shade;       /* 4, sRGB, premultiplied */
    float    *uncertainty; /* 3; NULL while nothing is perturbed */
    float    *velocity;    /* 3: pixels moved over the exposure, right, up, 0; NULL: the scene is at rest */
    float *direction; /* 3: the directions of strokes on the page, s · (cos 2θ, sin 2θ), 0; NULL where no surface asks
                         for it */
    bool       whole;     /* all maps, of all layers too; else only depth and id of what is nearest, the rest is NULL */
    bool       part;      /* not whole: a box of the page, and its normals too */
    layer_maps layers;    /* of figures that are seen through */
    layer_maps perturbed; /* depth, edge and shade as compositions find them: of what is nearest, one, or none where
                             nothing is perturbed */
    layer_maps perturbed_layers;
    /* The same on the GPU instead, by lmn_map, without those of layers; the caller's to release. */
    bool         on_gpu;
    gpu_texture *textures[FRAME_MAPS];
    gpu_texture *edges; /* of the figure that is drawn: darkest of its line techniques' edge maps */
};
lmn_status frame_maps_create(frame_maps *out, int width, int height, bool whole, lmn_error *error);
/* Of one pixel, with its normal. */
lmn_status frame_maps_create_pixel(frame_maps *out, int x, int y, lmn_error *error);
/* On the GPU; errors stick to it. */
void frame_maps_open(frame_maps *out, gpu *g, int width, int height);
void frame_maps_release(frame_maps *m); /* not what lies on the GPU */
void frame_maps_release_textures(frame_maps *m, gpu *g);
/* Reads the textures into maps in memory. False when that is gone. */
bool frame_maps_read(const frame_maps *m, gpu *g, frame_maps *out);

#endif
