/* Inside mesh_round: a mesh as it grows. */
#ifndef LIMNER_SCENE_ROUND_PRIVATE_H
#define LIMNER_SCENE_ROUND_PRIVATE_H

#include "base/vector3.h"
#include "scene/scene.h"

#define NOWHERE UINT32_MAX

/* A half-edge: corner `corner` of the primitive's triangles to the next one. */
typedef struct half_edge {
    uint64_t ends; /* numbers of its two positions, the lower one first */
    uint32_t primitive, corner;
} half_edge;

/* A primitive as it grows. */
typedef struct growing {
    primitive made;
    uint32_t *positions; /* number of each vertex's position, the same for all at one place */
    int64_t  *middles;   /* per corner: the vertex half-way to the next corner, or WHOLE */
    uint32_t *planes;    /* per triangle: the plane that it lies in, NOWHERE for what is none */
    size_t    room;      /* for vertices */
} growing;

typedef struct rounding {
    growing   *parts;
    size_t     part_count;
    uint32_t   position_count;
    double     tolerance; /* a length */
    half_edge *halves;
    size_t     half_count;
    uint32_t  *starts; /* the corners at a position are corners[starts[p]] to corners[starts[p + 1] - 1] */
    half_edge *corners;
    double (*planes)[3]; /* normals of planes */
} rounding;

static inline void point_of(double out[3], vec3 v)
{
    vector3_set(out, (double)v.x, (double)v.y, (double)v.z);
}

static inline uint32_t next_corner(uint32_t corner)
{
    return corner % 3 == 2 ? corner - 2 : corner + 1;
}

/* Which triangles lie in planes, of a mesh of which the halves are listed: what is wide and even from rim to rim,
 * though its normals lean there over to bevels and roundings. LMN_MEMORY. */
lmn_status round_planes_find(rounding *r, lmn_error *error);

#endif
