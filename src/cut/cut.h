/* Sections: parts cut by planes and boxes, and the faces that close them. What is cut away is a union of cells,
 * each the inside of a few half-spaces. All is done in the mesh, so that whatever draws sees ordinary geometry. */
#ifndef LIMNER_CUT_CUT_H
#define LIMNER_CUT_CUT_H

#include "scene/scene.h"

enum { CUT_PLANES_MAX = 32, CUT_CELLS_MAX = 8, CUT_CELL_FACES_MAX = 6 };

/* Points where normal·p − offset is above 0 are on the positive side. */
typedef struct cut_plane {
    double normal[3], offset; /* unit normal */
} cut_plane;

typedef struct cut_face {
    int32_t plane;
    bool    positive; /* the side that the cell is on */
} cut_face;

/* What lies inside all faces is cut away. */
typedef struct cut_cell {
    int32_t  count;
    cut_face faces[CUT_CELL_FACES_MAX];
} cut_cell;

typedef struct cut {
    int32_t   plane_count, cell_count; /* no cells: nothing is cut */
    cut_plane planes[CUT_PLANES_MAX];
    cut_cell  cells[CUT_CELLS_MAX];
    double    snap; /* vertices this near to a plane lie in it */
} cut;

/* Reads planes and boxes separated by ';' (docs/reference/draw.md). Percentages count from the near to the far side of
 * `bounds`. All bytes of *out are set, so that two cuts can be compared with memcmp. Errors: LMN_USAGE. */
lmn_status cut_parse(cut *out, const char *spec, box3 bounds, lmn_error *error);

typedef enum cut_verdict { CUT_WHOLE, CUT_GONE, CUT_CROSSED } cut_verdict;
/* What becomes of anything inside the box; CUT_CROSSED when that cannot be told from the box. */
cut_verdict cut_judge_box(const cut *c, box3 world_box);

/* One primitive of a part, in its pose. */
typedef struct cut_input {
    const vec3     *positions; /* before `world` */
    uint32_t        vertex_count;
    const uint32_t *indices;
    uint32_t        index_count;
} cut_input;

/* A corner of a new triangle: where it is and what it is made of. */
typedef struct cut_corner {
    vec3     position;   /* before `world` */
    uint32_t triangle;   /* of the primitive */
    float    weights[3]; /* of that triangle's corners, sum 1 */
} cut_corner;

/* What is left of a primitive. */
typedef struct cut_surface {
    uint32_t   *whole; /* triangles that stay as they are */
    size_t      whole_count, whole_capacity;
    cut_corner *corners; /* three a triangle */
    size_t      corner_count, corner_capacity;
} cut_surface;

/* A cut face: flat, of one body (a shell with its cavities). */
typedef struct cut_cap {
    int32_t  plane;
    bool     positive;  /* the side that its normal points to: what was cut away */
    uint32_t body;      /* counts from 0 within the part, the same for all its faces */
    uint32_t primitive; /* that most of its outline belongs to */
    vec3     normal;    /* before the normal matrix of `world` */
    vec3    *positions; /* three a triangle, before `world`; wound as the part's own triangles */
    size_t   count, capacity;
} cut_cap;

typedef struct cut_result {
    cut_verdict  verdict;  /* surfaces and caps are there when CUT_CROSSED */
    cut_surface *surfaces; /* as many as inputs */
    size_t       surface_count;
    cut_cap     *caps;
    size_t       cap_count, cap_capacity;
    bool         open; /* some outlines do not close; they have no cut face */
} cut_result;

/* Cuts one instance of a part. Errors: LMN_MEMORY; the result can be released in any case. */
lmn_status cut_part(cut_result *out, const cut *c, const mat4 *world, const cut_input *inputs, size_t input_count,
                    lmn_error *error);
void       cut_result_release(cut_result *r);

#endif
