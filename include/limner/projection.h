/* Projections that no single camera has: a scene is bent so that an ordinary camera sees it as they do. */
#ifndef LIMNER_PROJECTION_H
#define LIMNER_PROJECTION_H

#include "limner/draw.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum lmn_projection {
    LMN_PROJECTION_MULTI_PERSPECTIVE, /* what is near as the camera sees it, what is far from above */
    LMN_PROJECTION_PANORAMA           /* all around the eye on a cylinder: equal angles are equal widths */
} lmn_projection;

typedef struct lmn_projection_desc {
    size_t         struct_size;
    lmn_projection projection;
    /* Of a multi-perspective view, how far the ground stands up in the distance, 1 … 90 degrees less than the view
     * looks down; 0: so that it is seen from 65 degrees above. Of a panorama, how much of the horizon the picture is
     * wide, 30 … 360; 0: 180. */
    double angle_deg;
    /* Of a multi-perspective view: where the ground begins to rise and where it is as steep as it gets, fractions of
     * the way from the viewer, or from the near side of the scene, to its far side. 0 ≤ from < to ≤ 1. */
    double from, to;
} lmn_projection_desc;
#define LMN_PROJECTION_DESC_INIT                                                                                       \
    {                                                                                                                  \
        sizeof(lmn_projection_desc), LMN_PROJECTION_MULTI_PERSPECTIVE, 0, 0.25, 0.75                                   \
    }

/* A copy of the scene at the time that `desc` says, bent so that an ordinary drawing of it shows the projection:
 * pictures, sheets, maps, labels and shadows alike. Parts keep their names, paths, attributes and order. Faces are cut
 * as finely as the bend asks for. Light comes from where it does in the copy: in the distance it turns with the ground.
 * `desc` is changed to the view that the copy is to be drawn with. The copy has no animations.
 * Errors: LMN_USAGE (a view from straight above has no distance; panoramas need an eye and a perspective; numbers out
 * of range), LMN_UNSUPPORTED (solids, unless `lenient` leaves them out; matrices; buildings too tall for the bend),
 * LMN_LIMIT, LMN_MEMORY. No GL context needed. */
LMN_API lmn_status lmn_scene_project(lmn_scene **out, const lmn_scene *scene, lmn_draw_desc *desc,
                                     const lmn_projection_desc *projection, lmn_error *error);

/* "multi-perspective" and "panorama"; NULL for any other number. */
LMN_API const char *lmn_projection_name(int projection);

#ifdef __cplusplus
}
#endif
#endif
