/* Closed leaves, convex and not, and trees of them made from seeds: the same on every machine. */
#ifndef TRUTH_CSG_SCENES_H
#define TRUTH_CSG_SCENES_H

#include "csg_truth.h"

/* Each appends a leaf and returns its node. Round ones have z as their axis. */
int csg_box(csg *c, int parent, dvec low, dvec high);
int csg_ball(csg *c, int parent, double radius, int stacks, int slices);
/* From z = 0 to the height; a radius of 0 is a tip. */
int csg_cylinder(csg *c, int parent, double bottom, double top, double height, int slices);
int csg_torus(csg *c, int parent, double major, double minor, int around, int across);
/* An outline seen from +z, anticlockwise, each point of which can be seen from `centre`. */
int csg_prism(csg *c, int parent, const double (*outline)[2], int count, const double centre[2], double height);
int csg_angle(csg *c, int parent, double side, double thick, double height); /* an L */
int csg_star(csg *c, int parent, double outer, double inner, int points, double height);
/* A profile of (radius, z) from the axis at the bottom to the axis at the top, turned around z. */
int csg_turned(csg *c, int parent, const double (*profile)[2], int count, int slices);
int csg_cup(csg *c, int parent, double radius, double height, double wall, int slices);
/* The convex hull of points near a sphere. */
int csg_hull(csg *c, int parent, double radius, int points, uint32_t *state);

/* What node.matrix does: scale (negative ones mirror), rotation about an axis by degrees, translation. */
void csg_place(csg *c, int node, dvec scale, dvec axis, double degrees, dvec translation);
void csg_move(csg *c, int node, double x, double y, double z);

/* A colour of its own for each leaf, in the leaves. */
void csg_colour(csg *c);

/* A double-ended spanner: a jaw, a ring with a hexagonal hole, a recessed shaft with a bore along it. Two units
 * long. */
void csg_spanner(csg *c);

typedef enum csg_scene {
    CSG_CONVEX,     /* up to 8 convex leaves */
    CSG_CONCAVE,    /* up to 8 leaves, most of them not convex */
    CSG_DEEP,       /* up to 14 leaves, nested up to six deep */
    CSG_MANY,       /* up to 60 leaves */
    CSG_COINCIDENT, /* faces in one plane, leaves twice at one position, cuts flush with faces */
    CSG_SCENES
} csg_scene;

extern const char *const csg_scene_names[CSG_SCENES];

/* Fits into a ball of radius 2; never empty. */
void csg_random(csg *c, csg_scene kind, uint32_t seed);

/* A point inside the solid (or inside some leaf and outside of the solid), some way from all surfaces. False when
 * there is none. */
bool csg_find_position(csg_rays *r, bool in_solid, uint32_t seed, dvec *out);

#endif
