/* Sessions: the renderer with what it keeps of the last scene, and a drawing that is set up. */
#ifndef LIMNER_DRAW_SESSION_H
#define LIMNER_DRAW_SESSION_H

#include <stdatomic.h>

#include "frame/frame.h"
#include "limner/draw.h"
#include "plan/round_scene.h"
#include "plan/time.h"
#include "pose/pose.h"
#include "stage/made_textures.h"

/* What a drawing has left on the GPU. Its renderer and the drawing own it together. */
typedef struct kept_textures {
    atomic_int    owners;
    lmn_renderer *renderer; /* NULL: it has drawn since or ended, and the textures are gone */
    gpu_texture  *picture;
    frame_maps    maps;
} kept_textures;

struct lmn_renderer {
    gpu             *g;
    kept_textures   *kept;        /* of the last drawing; NULL: it has left none */
    round_scene      round;       /* of the last scene that a look drew round */
    pose             pose;        /* of the last scene that was drawn */
    pose_deformation deformation; /* that its moment asks for */
    swept_boxes      swept;       /* of its clips */
    swept_boxes      plate;       /* of the times of its plate */
    upload           up;
    const lmn_scene *scene; /* that `up` belongs to; compared, never followed after a draw */
    bool             up_valid;
    made_textures    made;
    int width, height, samples; /* of the last drawing: its pictures stay in the pool for one of the same size */
};

/* Makes them the renderer's, too; NULL is none. Inside of its context. */
void kept_lend(kept_textures *k, lmn_renderer *r);
/* The renderer draws again, or ends: its textures go back to the pool. Inside of its context. */
void kept_drop(lmn_renderer *r);
/* An owner less; NULL is accepted. */
void kept_release(kept_textures *k);

lmn_status renderer_create(lmn_renderer **out, const lmn_renderer_desc *desc, lmn_error *error);
void       renderer_destroy(lmn_renderer **r);

/* Samples along each side of a pixel. */
int samples_side(const lmn_draw_desc *desc);

/* What a drawing is made for. */
typedef struct draw_options {
    const lmn_draw_desc *desc;
    bool                 maps; /* its buffers alone, one sample a pixel */
    const char          *cut;  /* what is cut away instead of what the look says; NULL: that */
    bool surfaces_only;        /* what lies below the lines of a sheet: neither lines, nor marks, nor hatching */
    /* One of several times of an exposure. */
    const pose        *held;        /* parts without `moves` are as in this pose; NULL: all are as at the time */
    const bool        *moves;       /* per part, then per ghost */
    const view_camera *camera;      /* NULL: as the description says */
    bool               keeps_depth; /* of the frame, until the session is closed */
} draw_options;

/* A drawing set up and ready to be repeated. */
typedef struct session {
    lmn_renderer *renderer;
    plan          plan;
    plan_textures textures;
    frame         frame;
    gpu_texture  *out;
} session;
lmn_status session_open(session *s, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                        const draw_options *options, warnings *warnings, lmn_error *error);
void       session_close(session *s);

#endif
