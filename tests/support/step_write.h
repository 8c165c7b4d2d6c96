/* STEP and IGES files for tests, written by OpenCASCADE, and what it knows of them exactly: none of it comes from
 * triangles. */
#ifndef TESTS_SUPPORT_STEP_WRITE_H
#define TESTS_SUPPORT_STEP_WRITE_H

#include <stdbool.h>
#include <stddef.h>

#ifdef __cplusplus
extern "C" {
#endif

enum { STEP_WRITE_POINTS = 20000 };

typedef struct step_truth {
    double volume, area;    /* mm³, mm² */
    double low[3], high[3]; /* mm */
    size_t edges;           /* of the solid, without seams */
    size_t point_count;     /* points on these edges, three numbers each */
    double points[3 * STEP_WRITE_POINTS];
} step_truth;

/* Where the bracket's bolt hole is and how wide it is: along z, mm. */
#define STEP_WRITE_HOLE_X      20.0
#define STEP_WRITE_HOLE_Y      15.0
#define STEP_WRITE_HOLE_RADIUS 6.0

/* An angle with a hole and a fillet, of faces without colour but for the red one that is low in z; in millimetres. */
bool step_write_bracket(const char *path, step_truth *out);
/* In inches: "stand", an assembly of "plate" (grey 0.5 sRGB, 2 × 2 × 0.25 in), two "pin" (blue, 0.5 in wide, 1 in
 * high), "left pin" at (0.5, 1, 0.25) in and "right pin" at (1.5, 1, 0.25) in, the right one red and turned by 90°
 * about x, and a group "inner" that has a third pin, without a name, at (0, 0, 2) in. */
bool step_write_assembly(const char *path);
/* Two boxes in one part without names of their own, and a wire that bounds no face. */
bool step_write_loose(const char *path);
/* A cylinder of radius 5 mm along z whose side and ends are two faces each. */
bool step_write_halves(const char *path, double height);
/* `count` cylinders in one part. */
bool step_write_many(const char *path, int count);

/* The bracket as IGES, in a unit of OpenCASCADE's ("MM", "INCH"); as a solid, or else as faces that know nothing of
 * each other. Its header says author "A. Writer" and organisation "Works". */
bool iges_write_bracket(const char *path, const char *unit, bool solid, step_truth *out);
/* Faces that know nothing of each other: of a green box "near" from (0, 0, 0) to (10, 20, 30) mm and of a blue one
 * "far" from (40, 0, 0) to (50, 20, 30), without its lid if it is open; and a circle of radius 8 mm at z = 60. */
bool iges_write_loose(const char *path, bool open);

#ifdef __cplusplus
}
#endif
#endif
