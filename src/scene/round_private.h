/* Inside mesh_round: a mesh as it grows. */
#ifndef LIMNER_SCENE_ROUND_PRIVATE_H
#define LIMNER_SCENE_ROUND_PRIVATE_H

#include "base/vector3.h"
#include "scene/scene.h"

/* What triangles lie in, beside planes: nothing that is known; a free form that is fine enough, and those that have so
 * many rounds before them. */
#define NOWHERE   UINT32_MAX
#define FORM_DONE (UINT32_MAX - 1)
enum { FORM_ROUNDS = 3, FORM_TRIANGLES_LEAST = 64 };

/* Of edge_visibility. */
enum { ROUND_SILHOUETTE = 1, ROUND_NOTHING = 4 };

/* A half-edge: corner `corner` of the primitive's triangles to the next one. */
typedef struct half_edge {
    uint64_t ends; /* numbers of its two positions, the lower one first */
    uint32_t primitive, corner;
} half_edge;

/* A primitive as it grows. */
typedef struct growing {
    primitive made;
    uint32_t *positions;              /* number of each vertex's position, the same for all at one place */
    int64_t  *middles;                /* per corner: the vertex half-way to the next corner, or WHOLE */
    uint32_t *planes;                 /* per triangle: the plane that it lies in, or one of the above */
    size_t    room;                   /* for vertices */
    bool      own_normals, own_edges; /* the file's: not made here */
} growing;

typedef struct rounding {
    growing   *parts;
    size_t     part_count;
    uint32_t   position_count;
    double     tolerance; /* a length */
    bool       forms_only;
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

static inline bool is_plane(uint32_t plane)
{
    return plane < FORM_DONE - FORM_ROUNDS;
}

static inline bool is_form(uint32_t plane)
{
    return !is_plane(plane) && plane != NOWHERE;
}

static inline bool is_form_to_halve(uint32_t plane)
{
    return is_form(plane) && plane != FORM_DONE;
}

static inline uint32_t plane_in_next_round(uint32_t plane)
{
    return is_form_to_halve(plane) ? plane + 1 : plane;
}

/* --- round_form.c --- */
/* Marks the triangles of coarse free forms, once planes are known, and widens their cages. LMN_MEMORY. */
lmn_status round_form_find(rounding *r, lmn_error *error);
/* A round, between that new vertices are there and that triangles are cut: puts all vertices where they belong. False
 * when memory is gone. */
bool round_form_halve(rounding *r);
/* Normals of free forms as they are now, of a mesh that is listed. Likewise. */
bool round_form_shade(rounding *r);

#endif
