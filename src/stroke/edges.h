/* Edges of meshes, sorted before anything is drawn into those that are always lines, those that may become an
 * outline, and the rest, which never are. Freudenberg 2003, section 7.1; rows OE-01 to OE-04. */
#ifndef LIMNER_STROKE_EDGES_H
#define LIMNER_STROKE_EDGES_H

#include "scene/scene.h"

#define EDGE_NO_FACE UINT32_MAX

typedef enum edge_flag {
    EDGE_BORDER = 1 << 0,   /* one face only, or faces that do not pair */
    EDGE_CREASE = 1 << 1,   /* its faces turn by more than the crease angle, or the file says that it is hard */
    EDGE_MATERIAL = 1 << 2, /* its faces have different materials */
    EDGE_CANDIDATE =
        1 << 3, /* an outline from where one face is seen from the front and the other from behind: smooth and strictly
                 * convex, or smooth and not flat where the piece it belongs to is not closed, or EDGE_HOLLOW */
    EDGE_TWISTED = 1 << 4, /* beside others: both faces pass it the same way, so that one of them is inside out */
    EDGE_QUIET = 1 << 6,   /* turns by more than the crease angle but is no crease: no line unless it is an outline */
    EDGE_HOLLOW = 1 << 7, /* beside EDGE_CANDIDATE: of a hollow, so that the outline is always hidden: sides of bores */
    EDGE_ROUNDED = 1 << 5 /* beside EDGE_CREASE: the middle of a narrow rounding, as sharp as that turns in all */
} edge_flag;

/* What a file says of an edge (glTF's EXT_mesh_primitive_edge_visibility). It overrules the angle. From EDGE_TURNED on
 * it is hard and turned by so much before it was made round (edge_turn). */
typedef enum edge_saying { SAID_HIDDEN, SAID_SILHOUETTE, SAID_HARD, SAID_REPEATED, SAID_NOTHING } edge_saying;

/* One edge. Its faces, as seen along it from vertex[0] to vertex[1]: face[0] is the one whose winding has it in
 * this order. */
typedef struct mesh_edge {
    uint32_t vertex[2];
    uint32_t face[2]; /* EDGE_NO_FACE: none */
    uint32_t flags;   /* of edge_flag, not 0 */
    float    turn;    /* of the chain of creases that it is part of, radians, the mean; 0: not known, its own counts */
} mesh_edge;

/* How a mesh samples a surface, as scans do: densely, and more or less truly. */
typedef struct edge_sampling {
    bool  sampled;   /* it does, in edges that are short beside it */
    float noise;     /* by how much edges turn that should not, radians */
    float mean_edge; /* length */
    float size;      /* diagonal of the mesh */
} edge_sampling;

/* A line that the file brings (stroke/drawn.h). */
typedef struct mesh_line {
    uint32_t vertex[2];
    uint32_t edge; /* that it runs along; EDGE_NO_FACE: none of those with flags */
    float    lift; /* so far it may lie off a surface and still be on it */
} mesh_line;

/* A cut face of a section: what says how it is hatched. Its faces have a material that is no file's. */
typedef struct edge_cap {
    int32_t  axis;              /* 0 … 2, that its plane is nearest to being at right angles to */
    uint32_t body;              /* of the part, from 0 on */
    double   normal[3], offset; /* of its plane, world axes */
} edge_cap;
#define EDGE_CAP_MATERIAL(cap) (-2 - (int32_t)(cap))

/* A mesh with all its primitives welded by position: vertices that lie at one position are one. Triangles that were
 * there twice are one, those without area are gone. Positions are the mesh's own. */
typedef struct edge_mesh {
    uint32_t vertex_count, face_count, edge_count, piece_count, line_count;
    vec3    *positions;
    uint32_t (*faces)[3];
    vec3      *normals;   /* per face, unit, by winding */
    int32_t   *materials; /* per face; NULL: all alike */
    mesh_edge *edges;     /* those with flags, in a fixed order */
    mesh_line *lines;     /* all of them are the last piece, which has no faces */
    uint32_t  *pieces;    /* per face: what hangs together over edges, numbered from 0 */
    bool      *closed;    /* per piece: each edge has two faces that pass it in opposite directions */
    bool      *inward;    /* per closed piece: its faces look inwards */
    box3      *boxes;     /* per piece */
    uint32_t  *planes; /* per face: the plane in which it lies with others, from 1 on; 0: none; NULL: not asked for */
    uint32_t   plane_count;
    uint32_t  *opposite; /* per half-edge 3 · face + corner: the other one of an edge whose two faces agree which way
                            round  they are, EDGE_NO_FACE: there is none; NULL: not known */
    uint8_t                *said; /* per corner, of the edge that begins there: edge_saying; NULL: nothing */
    edge_sampling           sampling;
    edge_cap               *caps;
    uint32_t                cap_count;
    struct edge_refinement *refinement; /* stroke/butterfly_mesh.h; NULL: the mesh is as it was given */
    struct edge_solid      *solid;      /* stroke/solid.h: the faces are those of its operands; NULL: of a mesh */
    bool                  moves; /* a pose or a call has put it where it is: in the next picture it may be elsewhere */
    struct edge_topology *topology;  /* of its poses, borrowed; NULL: none is kept */
    uint32_t all_edges, loose_edges; /* of the mesh: how many there are, and how many do not have exactly two faces */
} edge_mesh;

/* Sorts the edges of a mesh; crease_angle in radians. `positions` (may be NULL) replaces the positions of all
 * primitives, one after the other, where the mesh has a pose. End with edge_mesh_release. Errors: LMN_MEMORY. */
lmn_status edge_mesh_create(edge_mesh *out, const mesh *m, const vec3 *positions, double crease_angle,
                            lmn_error *error);
/* The same with all faces, those that are there twice, too: as operands of solids, two of these enclose nothing. */
lmn_status edge_mesh_create_whole(edge_mesh *out, const mesh *m, const vec3 *positions, double crease_angle,
                                  lmn_error *error);
void       edge_mesh_release(edge_mesh *m);

/* What the poses of a mesh have in common: vertices that are one, faces, and which of these meet. Of the mesh at rest:
 * what only comes to touch in a pose stays apart. Errors: those of edge_mesh_create. */
typedef struct edge_topology edge_topology;
lmn_status                   edge_topology_create(edge_topology **out, const mesh *m, lmn_error *error);
void                         edge_topology_destroy(edge_topology **t);
/* What form_surface_make keeps with it; NULL: nothing yet. */
struct form_knots **edge_topology_knots(edge_topology *t);
uint64_t            edge_topology_revision(const edge_topology *t); /* of the mesh's topology, as it was then */

/* edge_mesh_create for a pose, a few times as fast. *fits is false, and nothing is made, where vertices that were one
 * have come apart, or faces have no area in the pose or at rest. */
lmn_status edge_mesh_pose(edge_mesh *out, const edge_topology *t, const vec3 *positions, double crease_angle,
                          bool *fits, lmn_error *error);

/* The same of faces whose vertices are welded already. `numbers` gets each face's number in the mesh, EDGE_NO_FACE
 * where it was dropped. */
typedef struct edge_faces {
    const vec3 *positions;
    const uint32_t (*faces)[3];
    const int32_t *materials; /* may be NULL, as in edge_mesh */
    const uint8_t *said;      /* likewise */
    uint32_t       vertex_count, face_count;
} edge_faces;
lmn_status edge_mesh_create_from(edge_mesh *out, const edge_faces *faces, double crease_angle, uint32_t *numbers,
                                 lmn_error *error);

#endif
