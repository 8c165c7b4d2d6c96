/* Image-based evaluation of solids: their trees as programs that shaders run, and the planes in which faces of
 * several operands lie. Nienhaus et al. 2006, section 2; Nienhaus 2005, section 5.6; rows K01–K04, C1–C6. */
#ifndef LIMNER_CSG_CSG_H
#define LIMNER_CSG_CSG_H

#include "csg_tree/form.h"

/* Operands and terms of several solids as one list of links, two numbers each. Operands come first: the link to the
 * term above, and the number of its solid. Then the terms: the link, and how many of its operands must hold more
 * than when nothing is there (1 for a union). A link is (term + 1) · 2 + 1 if what is below is negated for the
 * term; 0 ends. Operands are numbered from 1 over all solids. */
typedef struct csg_program {
    uint32_t (*operands)[2];
    bool  *taken_away; /* per operand */
    size_t operand_count, operand_capacity, taken_capacity;
    uint32_t (*terms)[2];
    size_t term_count, term_capacity;
    size_t solid_count;
} csg_program;

/* Corners of triangles have a key: is the operand kept in the end, or taken away (an odd number of negations above
 * it); the operand from 1 on; a plane from 1 on or 0. Fragments have the same with two other bits at the top: does
 * the solid begin there, and is the triangle seen from its front? So keys order what lies at one depth: ends before
 * beginnings; among beginnings, what is taken away before what is kept, and among ends the other way round. Of
 * several operands the one at which the solid changes in this order is the one whose face people see there. */
#define CSG_KEY_KEPT 0x80000000u
enum { CSG_KEY_OPERAND_SHIFT = 16, CSG_OPERANDS_MAX = 16383, CSG_PLANES_MAX = 65535 };

/* Adds a solid; its operands get consecutive numbers from operand_count + 1 on, in the order of solid_form_used.
 * False when memory is gone. */
bool csg_program_add(csg_program *p, const solid_form *form);
void csg_program_release(csg_program *p);

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
