/* Light by counting rays: how much of a disc and of a sky is seen from a position, against what a drawing says. It
 * knows nothing of shaders. */
#ifndef TRUTH_LIGHT_TRUTH_H
#define TRUTH_LIGHT_TRUTH_H

#include "shape.h"
#include "shot.h"
#include "trace.h"

/* A drawing of a scene with one light and no other, its colours white, and what its positions are. */
typedef struct light_scene {
    shape       s;
    const char *file;
    shot_view   view;
    dvec        towards;           /* the light, world axes */
    double      softness;          /* degrees across */
    double      occlusion, radius; /* strength; fraction of the box's diagonal */
    const char *layers;            /* the rule's, JSON behind a comma; NULL: none */
    double      fill, rim;         /* strengths of a second light, and of one from behind */
} light_scene;

/* A world direction as this view sees it: right, up, to the viewer. */
dvec light_seen_from(const shot_view *view, dvec direction);
/* With or without what keeps light off. */
bool light_shot(shot *out, const light_scene *l, bool kept_off);

typedef struct light_map {
    int    width, height;
    float *drawn,
        *truth; /* fractions of light, row 0 on top; below 0 where nothing can be told: empty, borders, turned away */
} light_map;

/* What the drawing says, for pixels whose light alone is strong enough: with over without. */
void light_map_drawn(light_map *out, const shot *with, const shot *without);
/* The same by rays; `step`: only each such pixel of a row. With 5 the positions are a fifth of all, spread evenly. */
void light_map_shadows(light_map *m, const light_scene *l, const shot *s, int rays, int step);
void light_map_occlusion(light_map *m, const light_scene *l, const shot *s, int rays, int step);
void light_map_release(light_map *m);

typedef struct light_score {
    double mean, worst; /* difference */
    double far;         /* fraction of positions that are off by more than a quarter */
    double wrong;       /* … that are lit where they should not be, or the other way round: by more than a half */
    int    positions;
} light_score;
light_score light_compare(const light_map *m);
/* Writes both beside each other. */
void light_map_write(const light_map *m, const char *name);

/* The fraction of a disc that many degrees wide that is seen from a position with this normal. */
double light_of_disc(const tracer *t, dvec position, dvec normal, dvec towards, double degrees, int rays);

#endif
