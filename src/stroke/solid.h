/* Solids of set operations as strokes see them: an edge mesh whose faces are all faces of all operands, turned so that
 * they look outwards where they bound the solid, and whose edges are the lines that bound it: edges of operands and
 * lines in which two of them meet, each as far as the solid ends there. Nothing is meshed: what hides is found from the
 * operands' faces and the tree. Inside an operand is what an odd number of its faces encloses, as in pictures. */
#ifndef LIMNER_STROKE_SOLID_H
#define LIMNER_STROKE_SOLID_H

#include "csg_tree/program.h"
#include "stroke/edges.h"
#include "stroke/solid_section.h"

typedef struct edge_solid {
    csg_program           program;
    uint32_t             *operands;      /* per face, from 0 on */
    uint16_t             *planes;        /* per face: of those that several operands share, from 1 on; 0: none */
    uint32_t              open_operands; /* that are no closed meshes: what they enclose is not certain */
    struct solid_builder *ground;        /* what is asked whether a line bounds the solid */
} edge_solid;

/* The lines of what a form leaves. `c`, `cutters`: what solid_form_cut took away, as boxes with the number behind the
 * scene's last mesh; NULL: nothing. No vertices when the form is empty. End with edge_mesh_release. Errors: LMN_MEMORY,
 * LMN_LIMIT, LMN_CANCELLED. */
lmn_status edge_mesh_create_solid(edge_mesh *out, const lmn_scene *scene, const solid_form *form, const cut *c,
                                  const solid_cutter *cutters, double crease_angle, lmn_error *error);
void       edge_solid_destroy(edge_solid **s);

/* Where a line that lies in one of the faces bounds the solid with it: shares of the line, ascending. For one thread;
 * open once, for all lines. False when memory is gone. */
typedef struct solid_trimmer solid_trimmer;
typedef struct solid_share {
    double from, to;
} solid_share;
solid_trimmer *solid_trimmer_create(const edge_solid *s);
void           solid_trimmer_destroy(solid_trimmer **t);
bool solid_trim(solid_trimmer *t, uint32_t face, const double from[3], const double to[3], const solid_share **out,
                size_t *count);

/* Which operands hold, and what their tree makes of it. */
typedef struct solid_state {
    const csg_program *program;
    bool              *inside; /* per operand */
    int32_t           *held;   /* per term: operands that hold, more than when nothing is there */
    bool               value;  /* of the whole tree */
} solid_state;

/* Nothing holds. False when memory is gone. */
bool solid_state_open(solid_state *s, const csg_program *program);
void solid_state_release(solid_state *s);
/* Goes through the operand's surface. */
void solid_state_pass(solid_state *s, uint32_t operand);

/* The faces of one solid on a line, from where it begins. */
typedef struct solid_hit {
    double   at;
    uint32_t operand;
    uint32_t plane; /* hits of one plane are one event; 0: none */
    bool     sure;
} solid_hit;
/* How often the solid begins along the line, and ends where it held before: all, and those that are sure. Sorts the
 * hits; leaves the state as it was. */
typedef struct solid_entries {
    uint32_t all, sure;
} solid_entries;
solid_entries solid_count_entries(solid_state *s, solid_hit *hits, size_t count);
/* The first place at which the solid begins, or ends where it held before; false: nowhere. Likewise. */
bool solid_first_entry(solid_state *s, solid_hit *hits, size_t count, double *at);

#endif
