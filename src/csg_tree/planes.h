/* The planes in which faces of several operands lie: what is coincident is decided by their numbers, never by
 * distances. Rows C1–C6. */
#ifndef LIMNER_CSG_TREE_PLANES_H
#define LIMNER_CSG_TREE_PLANES_H

#include "scene/scene.h"

/* Numbers end here. */
enum { CSG_PLANES_MAX = 65535 };
/* Triangles closer to a plane than this fraction of the solid's extent lie in it: beyond what six printed digits and
 * single precision leave unsure, and far below what people model. */
#define CSG_COINCIDENT 4e-6

/* Triangles of several operands in one space. */
typedef struct csg_soup {
    const vec3     *positions;
    const uint32_t *indices; /* 3 a triangle */
    const uint32_t *owners;  /* operand of each triangle */
    size_t          triangle_count;
    double          extent; /* of the solid, whatever the operands' */
} csg_soup;

/* A plane: normal · x = distance. */
typedef struct csg_plane {
    double normal[3], distance;
} csg_plane;

/* Finds planes in which triangles of two or more operands lie, either way round: numbers from 1 on, one a triangle
 * (0: none), at most CSG_PLANES_MAX. What is coincident is decided here once, in double precision, and not by
 * depth. Owned results (mem_free). False when memory is gone. */
bool csg_find_planes(const csg_soup *soup, uint16_t **numbers, csg_plane **planes, size_t *plane_count);

#endif
