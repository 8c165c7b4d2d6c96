/* Shapes of scripts: round ones are turned about the axis that points up. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "import/build.h"
#include "import/script.h"

enum { ROUND_PIECES = 48, PROFILE_MAX = 32 };

typedef struct mesh_in_work {
    vec3    *positions;
    uint32_t vertex_count, *indices, index_count;
} mesh_in_work;

static void corner(mesh_in_work *m, double x, double y, double z)
{
    m->positions[m->vertex_count++] = (vec3){(float)x, (float)y, (float)z};
}

static void triangle(mesh_in_work *m, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t all[3] = {a, b, c};
    memcpy(m->indices + m->index_count, all, sizeof all);
    m->index_count += 3;
}

/* Vertex `piece` of a ring; where the radius is 0 the ring is one vertex. */
static uint32_t of_ring(const uint32_t *first, const double (*profile)[2], size_t ring, uint32_t piece)
{
    return first[ring] + (profile[ring][0] > 0 ? piece % ROUND_PIECES : 0);
}

/* Turns a profile of radius and height, from below to above, about y. It begins and ends on the axis. */
static void turn(mesh_in_work *m, const double (*profile)[2], size_t count)
{
    uint32_t first[PROFILE_MAX];
    for (size_t i = 0; i < count; i++) {
        first[i] = m->vertex_count;
        for (int k = 0; k < (profile[i][0] > 0 ? ROUND_PIECES : 1); k++) {
            double angle = 6.283185307179586 * k / ROUND_PIECES;
            corner(m, profile[i][0] * cos(angle), profile[i][1], -profile[i][0] * sin(angle));
        }
    }
    for (size_t i = 0; i + 1 < count; i++)
        for (uint32_t k = 0; k < ROUND_PIECES; k++) {
            uint32_t a = of_ring(first, profile, i, k), b = of_ring(first, profile, i, k + 1),
                     c = of_ring(first, profile, i + 1, k), d = of_ring(first, profile, i + 1, k + 1);
            if (a != b)
                triangle(m, a, b, d);
            if (c != d)
                triangle(m, a, d, c);
        }
}

static void box(mesh_in_work *m, const double size[3])
{
    static const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    for (int i = 0; i < 8; i++)
        corner(m, (i & 1 ? 0.5 : -0.5) * size[0], (i & 2 ? 0.5 : -0.5) * size[1], (i & 4 ? 0.5 : -0.5) * size[2]);
    for (int i = 0; i < 6; i++) {
        triangle(m, faces[i][0], faces[i][1], faces[i][2]);
        triangle(m, faces[i][0], faces[i][2], faces[i][3]);
    }
}

static void make_sphere(mesh_in_work *m, double radius)
{
    enum { RINGS = 24 };
    double profile[RINGS + 1][2];
    for (int i = 0; i <= RINGS; i++) {
        double angle = 3.141592653589793 * i / RINGS;
        profile[i][0] = i == 0 || i == RINGS ? 0 : radius * sin(angle);
        profile[i][1] = -radius * cos(angle);
    }
    turn(m, (const double(*)[2])profile, RINGS + 1);
}

/* In metres, centred; cylinders and cones stand on their middle. */
static void make(script_reader *r, json_t *shape, const char *kind, mesh_in_work *m)
{
    double radius = 0.5, height = 1, size[3] = {1, 1, 1}, unit = r->file->length;
    if (strcmp(kind, "box") == 0) {
        script_check_keys(r, shape, "size");
        script_vector(r, shape, "size", 3, unit, size);
        /* Shapes are made with y up. */
        box(m, r->scene->up == 'z' ? (const double[]){size[0], size[2], size[1]} : size);
    } else if (strcmp(kind, "plane") == 0) {
        script_check_keys(r, shape, "size");
        script_vector(r, shape, "size", 2, unit, size);
        for (int i = 0; i < 4; i++)
            corner(m, (i & 1 ? 0.5 : -0.5) * size[0], 0, (i & 2 ? 0.5 : -0.5) * size[1]);
        triangle(m, 0, 2, 3);
        triangle(m, 0, 3, 1);
    } else {
        script_check_keys(r, shape, strcmp(kind, "sphere") == 0 ? "radius" : "radius height");
        script_number(r, shape, "radius", unit, &radius);
        script_number(r, shape, "height", unit, &height);
        const double tip[][2] = {{0, -height / 2}, {radius, -height / 2}, {0, height / 2}};
        const double tube[][2] = {{0, -height / 2}, {radius, -height / 2}, {radius, height / 2}, {0, height / 2}};
        if (strcmp(kind, "sphere") == 0)
            make_sphere(m, radius);
        else
            turn(m, strcmp(kind, "cone") == 0 ? tip : tube, strcmp(kind, "cone") == 0 ? 3 : 4);
    }
    if (!(radius > 0 && height > 0 && size[0] > 0 && size[1] > 0 && size[2] > 0))
        script_fail(r, LMN_FORMAT, "a shape has sizes above 0");
}

static int32_t add_material(script_reader *r, json_t *value)
{
    double linear[3];
    if (value && !script_colour(r, value, linear))
        return NONE;
    int32_t index = build_plain_material(r->scene, false);
    if (index == NONE) {
        script_out_of_memory(r);
        return NONE;
    }
    if (value)
        r->scene->materials[index].base_colour = (vec4){(float)linear[0], (float)linear[1], (float)linear[2], 1};
    return index;
}

int32_t script_shape(script_reader *r, json_t *node, const char *kind)
{
    enum { VERTICES_MAX = ROUND_PIECES * PROFILE_MAX };
    mesh_in_work m = {.positions = mem_calloc(VERTICES_MAX, sizeof *m.positions),
                      .indices = mem_calloc((size_t)6 * VERTICES_MAX, sizeof *m.indices)};
    primitive    p = {.positions = m.positions, .indices = m.indices, .welded = true};
    json_t      *colour = json_object_get(node, "colour");
    if (!m.positions || !m.indices)
        script_out_of_memory(r);
    else
        make(r, json_object_get(node, kind), kind, &m);
    for (uint32_t i = 0; r->status == LMN_OK && i < m.vertex_count && r->scene->up == 'z'; i++)
        m.positions[i] = (vec3){m.positions[i].x, -m.positions[i].z, m.positions[i].y};
    p.vertex_count = m.vertex_count;
    p.index_count = m.index_count;
    p.material = r->status == LMN_OK ? add_material(r, colour) : NONE;
    mesh *made = p.material != NONE ? scene_append_mesh(r->scene) : NULL;
    if (made && mesh_set_primitives(made, &p, 1))
        return (int32_t)r->scene->mesh_count - 1;
    script_out_of_memory(r);
    primitive_release(&p);
    return NONE;
}
