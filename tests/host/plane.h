/* A host's scene with a camera of its own: a coloured plane through the origin, drawn by OpenGL, and what rays say of
 * it and of a cube of side 1 around the origin. */
#ifndef LIMNER_TESTS_HOST_PLANE_H
#define LIMNER_TESTS_HOST_PLANE_H

#include <epoxy/gl.h>
#include <stdbool.h>

/* How the host's projection makes depth. */
typedef enum plane_depth { PLANE_USUAL, PLANE_REVERSED, PLANE_RANGE, PLANE_DEPTHS } plane_depth;

typedef struct plane {
    GLuint      program, array, buffer;
    double      view[16], projection[16];
    plane_depth depth;
    bool        orthographic;
    double      corners[4][3], normal[3], shift; /* normal · x = shift */
} plane;

void plane_open(plane *p, plane_depth depth, bool orthographic, double shift);
/* Clip control, range and function of depth, the clear depth: what this host's scene needs. */
void plane_set_depth(const plane *p);
void plane_draw(const plane *p);
void plane_close(plane *p);

/* What the ray through a point of the picture (pixels from the bottom left) meets first. */
typedef enum plane_seen { SEEN_NOTHING, SEEN_PLANE, SEEN_CUBE } plane_seen;
plane_seen plane_ray(const plane *p, double x, double y, int width, int height);

#endif
