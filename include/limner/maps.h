/* What a drawing was made of, in the caller's memory: maps, what is seen at a pixel, and where the camera puts points.
 * The drawing must have been made with lmn_draw_desc.maps. Pixels are counted from the top left corner, x to the right,
 * y down; the middle of the first one is 0.5, 0.5. Drawings are read by any thread. No GL context needed. Errors:
 * LMN_USAGE. All since 0.1. */
#ifndef LIMNER_MAPS_H
#define LIMNER_MAPS_H

#include "limner/draw.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Maps of what is nearest, one value a pixel, row 0 on top. Numbers are float, but those of ID are uint32_t. */
typedef enum lmn_map {
    LMN_MAP_DEPTH = 0, /* 1: distance from the camera along its axis, in the scene's unit; INFINITY where empty */
    LMN_MAP_NORMAL,    /* 3: unit, in the camera's axes (+x right, +y up, +z to the viewer); 0 where empty */
    LMN_MAP_ID,        /* 1: the part (lmn_part_info.id); 0 where empty */
    LMN_MAP_EDGE,  /* 4: what lines leave of the ground, 0 … 1: outlines, inner lines, all lines, parts' borders */
    LMN_MAP_SHADE, /* 4: the surface without lines, sRGB, multiplied by its alpha */
    LMN_MAP_UNCERTAINTY, /* 3: where figures are looked up elsewhere, pixels; only where the look perturbs */
    LMN_MAP_VELOCITY,    /* 3: pixels moved over the exposure, right, up, 0; only of scenes drawn at a time */
    LMN_MAP_DIRECTION    /* 3: of strokes on the page, s · (cos 2θ, sin 2θ), 0; only where strokes follow the form */
} lmn_map;

/* How many numbers a pixel a map has; 0 for what is no map. */
LMN_API int lmn_map_components(lmn_map map);

/* Copies a map into `out`, which has room for `count` numbers: width · height · components. LMN_USAGE also where the
 * drawing does not have this map. */
LMN_API lmn_status lmn_drawing_copy_map(const lmn_drawing *drawing, lmn_map map, void *out, size_t count,
                                        lmn_error *error);

/* What is seen at a pixel. */
typedef struct lmn_pick {
    uint32_t part;        /* 0: nothing, and all else is 0 */
    double   position[3]; /* in the scene's axes and unit */
    double   normal[3];   /* unit, in the scene's axes */
    double   depth;       /* as LMN_MAP_DEPTH */
} lmn_pick;

/* What is seen at this pixel; pixels outside of the picture show nothing. */
LMN_API lmn_status lmn_drawing_pick(const lmn_drawing *drawing, int x, int y, lmn_pick *out, lmn_error *error);

/* The same without a drawing: draws what this one pixel of the described picture shows, and nothing else of it, as
 * lmn_draw with `maps` and lmn_drawing_pick would answer. For programs that ask while the picture is one of
 * lmn_draw_into. As lmn_draw it needs the renderer's context, and takes the place of its last textures (limner/host.h).
 * `textures` of the description is not heeded. Errors: those of lmn_draw. */
LMN_API lmn_status lmn_draw_pick(lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                                 const lmn_draw_desc *desc, int x, int y, lmn_pick *out, lmn_error *error);

/* The parts that are seen in a rectangle of pixels, each once, by their numbers: at most `capacity` of them are written
 * to `parts` (which may be NULL with 0), and *count gets how many there are. */
LMN_API lmn_status lmn_drawing_pick_parts(const lmn_drawing *drawing, int x, int y, int width, int height,
                                          uint32_t *parts, size_t capacity, size_t *count, lmn_error *error);

/* Where the drawing's camera puts a point of the scene: pixels, and its depth as LMN_MAP_DEPTH. False behind a camera
 * with perspective. Drawings without maps tell this too. */
LMN_API bool lmn_drawing_project(const lmn_drawing *drawing, const double point[3], double pixel[2], double *depth);

/* The point of the scene that is seen at a position of the picture in this depth. */
LMN_API void lmn_drawing_unproject(const lmn_drawing *drawing, const double pixel[2], double depth, double point[3]);

/* The camera that the drawing was made with: from the scene's axes to its own, and from there to clip space, 16 numbers
 * each, column after column. */
LMN_API void lmn_drawing_camera(const lmn_drawing *drawing, double view[16], double projection[16]);

#ifdef __cplusplus
}
#endif
#endif
