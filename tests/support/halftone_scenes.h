/* Surfaces for halftone screens, with two sets of texture coordinates each and lights from the file, written as
 * glTF; pictures whose pixels lie on a known grid of the world; and a sampler of given mip chains that knows
 * nothing of shaders. */
#ifndef TRUTH_HALFTONE_SCENES_H
#define TRUTH_HALFTONE_SCENES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/mip_chain.h"
#include "shot.h"

/* One corner: v grows upwards, as screens count. */
typedef struct halftone_corner {
    float at[3], normal[3], uv[2], unique[2];
} halftone_corner;

/* A grid of across x up cells over the square 0 … 1; `position` says where each corner is. */
typedef void (*halftone_place)(double s, double t, const void *user, halftone_corner *out);

typedef struct halftone_part {
    char             name[32], picture[64]; /* picture: the file's name of its base colour, or empty */
    halftone_corner *corners;
    int              across, up;
    float            colour[3]; /* linear */
    bool             second;    /* the unique coordinates are written */
} halftone_part;

typedef struct halftone_scene {
    halftone_part *parts;
    size_t         count;
    double         lights[4][3]; /* point lights, white */
    int            light_count;
} halftone_scene;

halftone_part *halftone_add(halftone_scene *s, const char *name, int across, int up, halftone_place position,
                            const void *user);
void           halftone_release(halftone_scene *s);
/* FILE.gltf with its bytes inside, or .obj (one set of coordinates, colours and pictures in a .mtl beside). */
bool halftone_write(const char *path, const halftone_scene *s);

/* A rectangle in the plane z from a corner, facing +z; texture coordinates are the position times `uv`. */
typedef struct halftone_wall {
    double x, y, z, width, height, uv;
} halftone_wall;
halftone_part *halftone_add_wall(halftone_scene *s, const char *name, halftone_wall wall);
/* The ground y = 0 from z = near to far (both negative), 2 half wide; u across, v into the depth, or turned. */
typedef struct halftone_floor {
    double near, far, half, uv;
    bool   turned;
} halftone_floor;
halftone_part *halftone_add_floor(halftone_scene *s, const char *name, halftone_floor floor);
/* A cylinder around the y axis from 0 to height; u around (`around` times the screen), v up. Unique: 0 … 1 around
 * and up. */
typedef struct halftone_tube {
    double radius, height, around, up;
} halftone_tube;
halftone_part *halftone_add_tube(halftone_scene *s, const char *name, halftone_tube tube);

/* Parallel rays along -z: the middle of pixel (x, y from the bottom) is at ((x + 0.5), (y + 0.5)) / pixels of the
 * world. */
shot_view halftone_view(int width, int height, double pixels);

/* A look with black ink on white paper, unless it names an ink; `surface` begins with the technique's name, then
 * more keys: "screen\",\"x\":1". */
const char *halftone_look(const char *surface);
/* The same with a scene's JSON (without braces) as well, and everything after the surface in the rule. */
const char *halftone_look_with(const char *surface, const char *scene, const char *more);

/* Fraction of ink at a pixel, row 0 on top. */
double halftone_ink(const shot *s, int x, int y);
/* Mean over a rectangle. */
double halftone_mean(const shot *s, int x, int y, int width, int height);
/* The same with parts of pixels. */
double halftone_box(const shot *s, double x, double y, double width, double height);

/* Mean difference of the light of two pictures of one size. */
double halftone_difference(const shot *a, const shot *b);

/* The value 0 … 1 of a chain that repeats, trilinear (or of the nearest texel of the nearest level, as the chain
 * says); v upwards. */
double halftone_sample(const mip_chain *chain, int layer, double u, double v, double level);

/* Draws; the file is written to the program's folder first. */
bool halftone_shot(shot *out, const halftone_scene *s, const char *file, const char *look, const char *const *changes,
                   const shot_view *view);

/* A wall that fills the picture however far it is: `octave` 0 is 100 px a unit. */
bool halftone_far(shot *out, const char *surface, double octave, int side, double uv);
/* Mean height of runs of ink in columns whose middle is dark, and the fraction of those of 0.5 to 1.5 px. */
double halftone_width(const shot *s, double *within);

/* Runs the command with these arguments; what it says on both streams (at most room - 1 bytes). The exit status, -1
 * when it did not end by itself. */
int halftone_command(const char *command, const char *arguments, char *out, size_t capacity);

/* Screens are made here and not taken from earlier runs. Call first. */
void halftone_begin(void);
/* The same, but what is made once is found again by later drawings of this run: for tests of what is drawn with
 * textures that take long to make. */
void halftone_begin_kept(const char *program);

#endif
