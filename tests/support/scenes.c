#include "scenes.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

const char *const scene_names[SCENE_KINDS] = {"closed", "open", "crossing", "coincident"};

double scene_random(uint32_t *state)
{
    *state = *state * 1664525u + 1013904223u;
    uint32_t h = *state;
    h = (h ^ (h >> 16)) * 0x7FEB352Du;
    h = (h ^ (h >> 15)) * 0x846CA68Bu;
    return (h ^ (h >> 16)) / 4294967296.0;
}

double scene_between(uint32_t *state, double low, double high)
{
    return low + (high - low) * scene_random(state);
}

static dvec random_point(uint32_t *state, double half)
{
    double x = scene_between(state, -half, half), y = scene_between(state, -half, half);
    return dvec_of(x, y, scene_between(state, -half, half));
}

static void place_anywhere(shape *s, uint32_t *state, double half)
{
    dvec   axis = dvec_add(random_point(state, 1), dvec_of(0.01, 0.02, 0.03));
    double degrees = scene_between(state, 10, 350);
    shape_place(s, axis, degrees, random_point(state, half));
}

static void closed(shape *s, uint32_t *state)
{
    char name[32];
    for (int i = 0; i < 6; i++) {
        snprintf(name, sizeof name, "closed%d", i);
        double a = scene_between(state, 0.3, 0.8), b = scene_between(state, 0.2, 0.7),
               c = scene_between(state, 0.2, 0.7);
        if (i % 3 == 0)
            shape_box(s, name, dvec_of(-a, -b, -c), dvec_of(a, b, c));
        else if (i % 3 == 1)
            shape_sphere(s, name, dvec_of(0, 0, 0), a, 24, 48, true);
        else
            shape_torus(s, name, a, 0.3 * b, 48, 24);
        place_anywhere(s, state, 0.7);
    }
}

/* Keeps the triangles that the mask names. */
static void keep_triangles(shape_part *p, const bool *kept)
{
    uint32_t at = 0;
    for (uint32_t k = 0; k < p->index_count; k += 3)
        if (kept[k / 3]) {
            memmove(&p->indices[at], &p->indices[k], 3 * sizeof *p->indices);
            at += 3;
        }
    p->index_count = at;
}

void scene_holed_sphere(shape *s, const char *name, double radius, int stacks, int slices, double pole_degrees)
{
    shape_sphere(s, name, dvec_of(0, 0, 0), radius, stacks, slices, true);
    shape_part *p = &s->parts[s->count - 1];
    bool       *kept = check_alloc(p->index_count / 3, sizeof *kept);
    double      limit = cos(pole_degrees / 57.29577951308232);
    for (uint32_t k = 0; k < p->index_count; k += 3) {
        double height = 0;
        for (uint32_t c = 0; c < 3; c++)
            height += (double)p->normals[p->indices[k + c]][1] / 3;
        uint32_t column = k / (p->index_count / (uint32_t)slices);
        kept[k / 3] = fabs(height) < limit && column % 3 != 0;
    }
    keep_triangles(p, kept);
    free(kept);
}

static void open(shape *s, uint32_t *state)
{
    char name[32];
    for (int i = 0; i < 3; i++) {
        snprintf(name, sizeof name, "plate%d", i);
        shape_quad(s, name, scene_between(state, 0.5, 1.1), 0);
        place_anywhere(s, state, 0.6);
    }
    shape_terrain(s, "hills", 1, 0.6, 32, (uint32_t)(1000 * scene_random(state)));
    place_anywhere(s, state, 0.4);
    scene_holed_sphere(s, "holed", scene_between(state, 0.6, 1), 24, 36, 35);
    place_anywhere(s, state, 0.4);
    scene_holed_sphere(s, "inner", scene_between(state, 0.3, 0.5), 24, 36, 20);
    place_anywhere(s, state, 0.2);
}

static void crossing(shape *s, uint32_t *state)
{
    char name[32];
    for (int i = 0; i < 7; i++) {
        snprintf(name, sizeof name, "cross%d", i);
        double a = scene_between(state, 0.8, 1.3), b = scene_between(state, 0.05, 0.5),
               c = scene_between(state, 0.05, 0.2);
        if (i == 6)
            shape_torus(s, name, 0.7, 0.25, 48, 24);
        else if (i % 3 == 2)
            shape_sphere(s, name, dvec_of(0, 0, 0), b + 0.3, 24, 48, true);
        else
            shape_box(s, name, dvec_of(-a, -b, -c), dvec_of(a, b, c));
        place_anywhere(s, state, 0.1);
    }
}

void scene_double(shape *s, bool turned)
{
    shape_part *p = &s->parts[s->count - 1];
    shape_part  before = *p;
    shape       grown = {0};
    shape_part *n =
        shape_add(&grown, before.name, 2 * before.vertex_count, 2 * before.index_count, before.normals != NULL, false);
    for (uint32_t v = 0; v < 2 * before.vertex_count; v++) {
        uint32_t from = v % before.vertex_count;
        memcpy(n->positions[v], before.positions[from], sizeof *n->positions);
        for (int k = 0; before.normals && k < 3; k++)
            n->normals[v][k] = turned && v >= before.vertex_count ? -before.normals[from][k] : before.normals[from][k];
    }
    for (uint32_t k = 0; k < before.index_count; k++) {
        uint32_t swapped = k % 3 == 0 ? k : k % 3 == 1 ? k + 1 : k - 1;
        n->indices[k] = before.indices[k];
        n->indices[before.index_count + k] = before.vertex_count + before.indices[turned ? swapped : k];
    }
    memcpy(n->matrix, before.matrix, sizeof n->matrix);
    memcpy(n->colour, before.colour, sizeof n->colour);
    n->has_matrix = before.has_matrix;
    free(before.positions);
    free(before.normals);
    free(before.uvs);
    free(before.indices);
    *p = *n;
    free(grown.parts);
}

static void add_copy(shape *s, const shape_part *from, const char *name)
{
    shape_part *p = shape_add(s, name, from->vertex_count, from->index_count, from->normals != NULL, from->uvs != NULL);
    memcpy(p->positions, from->positions, p->vertex_count * sizeof *p->positions);
    memcpy(p->indices, from->indices, p->index_count * sizeof *p->indices);
    if (p->normals)
        memcpy(p->normals, from->normals, p->vertex_count * sizeof *p->normals);
    if (p->uvs)
        memcpy(p->uvs, from->uvs, p->vertex_count * sizeof *p->uvs);
    memcpy(p->matrix, from->matrix, sizeof p->matrix);
    memcpy(p->colour, from->colour, sizeof p->colour);
    p->has_matrix = from->has_matrix;
}

void scene_copy(shape *s, size_t part, const char *name)
{
    shape_part from = s->parts[part]; /* adding moves the parts, not what they own */
    add_copy(s, &from, name);
}

void scene_reorder(shape *out, const shape *s, const size_t *order)
{
    for (size_t i = 0; i < s->count; i++)
        add_copy(out, &s->parts[order[i]], s->parts[order[i]].name);
}

/* Boxes that touch: a and b share a whole face, c is flush with a's side and lies on part of it. A ball twice at
 * one position; a sheet with two sides; a sheet that lies there twice the same way round, which is one surface. */
static void coincident(shape *s, uint32_t *state)
{
    double x = scene_between(state, -0.3, 0.3), y = scene_between(state, 0.3, 0.6), z = scene_between(state, 0.3, 0.6);
    shape_box(s, "a", dvec_of(-1, -y, -z), dvec_of(x, y, z));
    shape_box(s, "b", dvec_of(x, -y, -z), dvec_of(1, y, z));
    shape_box(s, "c", dvec_of(-0.8, y, -z), dvec_of(x - 0.1, y + 0.4, 0.5 * z));
    shape_sphere(s, "ball", dvec_of(0, 0, 0), scene_between(state, 0.4, 0.7), 16, 32, true);
    place_anywhere(s, state, 0.5);
    scene_copy(s, 3, "ball again");
    shape_quad(s, "two-sided", 0.9, 0);
    place_anywhere(s, state, 0.5);
    scene_double(s, true);
    shape_quad(s, "doubled", 0.8, 0);
    place_anywhere(s, state, 0.5);
    scene_double(s, false);
}

void scene_colour(shape *s)
{
    for (size_t i = 0; i < s->count; i++)
        for (uint32_t k = 0; k < 3; k++)
            s->parts[i].colour[k] = (float)(0.04 + 0.9 * (int)(((i + 1) * (k + 2) * 37 + 11 * k) % 29) / 28.0);
}

void scene_make(shape *s, scene_kind kind, uint32_t seed)
{
    static void (*const makers[SCENE_KINDS])(shape *, uint32_t *) = {closed, open, crossing, coincident};
    uint32_t state = seed * 2654435761u + (uint32_t)kind * 40503u;
    makers[kind](s, &state);
    scene_colour(s);
}

void scene_anchor(shape *s, const char *name, dvec low, dvec high)
{
    shape_part *p = shape_add(s, name, 6, 6, true, false);
    for (uint32_t i = 0; i < 6; i++) {
        dvec   at = i < 3 ? low : high;
        double step = i < 3 ? 0.01 : -0.01;
        p->positions[i][0] = (float)(at.x + (i % 3 == 1 ? step : 0));
        p->positions[i][1] = (float)(at.y + (i % 3 == 2 ? step : 0));
        p->positions[i][2] = (float)at.z;
        p->normals[i][2] = 1;
        p->indices[i] = i;
    }
}
