/* Image-based evaluation of solids: what their trees as programs (csg_tree/program.h) and planes (csg_tree/planes.h)
 * are to shaders. Nienhaus et al. 2006, section 2; Nienhaus 2005, section 5.6; rows K01–K04, C1–C6. */
#ifndef LIMNER_CSG_CSG_H
#define LIMNER_CSG_CSG_H

#include "csg_tree/planes.h"
#include "csg_tree/program.h"

/* Corners of triangles have a key: is the operand kept in the end, or taken away (an odd number of negations above
 * it); the operand from 1 on; a plane from 1 on or 0. Fragments have the same with two other bits at the top: does
 * the solid begin there, and is the triangle seen from its front? So keys order what lies at one depth: ends before
 * beginnings; among beginnings, what is taken away before what is kept, and among ends the other way round. Of
 * several operands the one at which the solid changes in this order is the one whose face people see there. */
#define CSG_KEY_KEPT 0x80000000u
enum { CSG_KEY_OPERAND_SHIFT = 16, CSG_OPERANDS_MAX = 16383 };

#endif
