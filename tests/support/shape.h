/* Scenes whose answer is known: parts of triangles, made in memory, written to model files and given to the
 * references. */
#ifndef TRUTH_SHAPE_H
#define TRUTH_SHAPE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "vec.h"

typedef struct shape_part {
    char     name[32];
    uint32_t vertex_count, index_count;
    float (*positions)[3];
    float (*normals)[3]; /* NULL: the reader makes them */
    float (*uvs)[2];     /* NULL: none */
    uint32_t *indices;
    double    matrix[16];
    bool      has_matrix;
    float     colour[4];            /* linear base colour */
    uint8_t  *texture, *normal_map; /* RGBA8, owned; NULL: none */
    int       texture_size;         /* both are squares of this side */
} shape_part;

/* The tag is for headers that only pass shapes on. */
typedef struct shape {
    shape_part *parts;
    size_t      count;
} shape;

void shape_release(shape *s);

/* An empty part with room for the given counts; normals and uvs on demand. Vertices and indices are filled by the
 * caller. */
shape_part *shape_add(shape *s, const char *name, uint32_t vertices, uint32_t indices, bool normals, bool uvs);

/* Places the last part: rotation about an axis by degrees, then translation, as the node's matrix. */
void shape_place(shape *s, dvec axis, double degrees, dvec translation);

/* A point of a part in the scene's axes. */
dvec shape_point(const shape_part *p, uint32_t vertex);
dvec shape_normal(const shape_part *p, uint32_t vertex);

void shape_box(shape *s, const char *name, dvec low, dvec high);

/* A staircase along x: column i reaches from edges[i] to edges[i+1] and up to heights[i]; z from 0 to depth. */
void shape_steps(shape *s, const char *name, const double *edges, const double *heights, int columns, double depth);
void shape_sphere(shape *s, const char *name, dvec centre, double radius, int stacks, int slices, bool normals);
void shape_torus(shape *s, const char *name, double major, double minor, int around, int across);

/* Smooth hills over the square of side 2·half in the xz plane, cells·cells·2 triangles. */
void shape_terrain(shape *s, const char *name, double half, double height, int cells, uint32_t seed);

/* Two unit squares that meet in the line x = 0, folded away from +z so that their normals differ by `degrees`; with
 * normals. */
void shape_wedge(shape *s, const char *name, double degrees);

/* A square of side 2·half in the plane z, facing +z, with normals and texture coordinates (v down from the top). */
void shape_quad(shape *s, const char *name, double half, double z);

/* Gives every part normals: at each corner the area-weighted mean of the faces of the part around its position whose
 * normals are within the crease angle of the corner's own face. Corners are no longer shared. */
void shape_make_normals(shape *s, double crease_degrees);

/* All parts moved into one, as one mesh. */
void shape_join(shape *out, const char *name, const shape *s);

#endif
