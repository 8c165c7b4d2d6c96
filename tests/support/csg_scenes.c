#include "csg_scenes.h"

#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "scenes.h"

static const double pi = 3.14159265358979323846;

const char *const csg_scene_names[CSG_SCENES] = {"convex", "concave", "deep", "many", "coincident"};

/* --- leaves --------------------------------------------------------------------------------------------- */

static csg_mesh *new_mesh(csg *c, int parent, size_t points, size_t faces)
{
    int       node = csg_add(c, parent, CSG_LEAF);
    csg_mesh *m = &c->nodes[node].mesh;
    m->points = check_alloc(points, sizeof *m->points);
    m->faces = check_alloc(faces, 3 * sizeof *m->faces);
    return m;
}

static void put_point(csg_mesh *m, double x, double y, double z)
{
    m->points[m->point_count++] = dvec_of(x, y, z);
}

static void put_face(csg_mesh *m, size_t a, size_t b, size_t c)
{
    uint32_t *f = &m->faces[3 * m->face_count++];
    f[0] = (uint32_t)a;
    f[1] = (uint32_t)b;
    f[2] = (uint32_t)c;
}

static void put_quad(csg_mesh *m, size_t a, size_t b, size_t c, size_t d)
{
    put_face(m, a, b, c);
    put_face(m, a, c, d);
}

int csg_box(csg *c, int parent, dvec low, dvec high)
{
    static const uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                         {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
    csg_mesh             *m = new_mesh(c, parent, 8, 12);
    for (int i = 0; i < 8; i++)
        put_point(m, i & 1 ? high.x : low.x, i & 2 ? high.y : low.y, i & 4 ? high.z : low.z);
    for (int i = 0; i < 6; i++)
        put_quad(m, faces[i][0], faces[i][1], faces[i][2], faces[i][3]);
    return c->count - 1;
}

int csg_turned(csg *c, int parent, const double (*profile)[2], int count, int slices)
{
    size_t    n = (size_t)slices, rings = (size_t)count - 2, top = rings * n + 1;
    csg_mesh *m = new_mesh(c, parent, top + 1, 2 * n * rings);
    put_point(m, 0, 0, profile[0][1]);
    for (size_t i = 0; i < rings; i++)
        for (size_t j = 0; j < n; j++) {
            double a = 2 * pi * (double)j / slices;
            put_point(m, profile[i + 1][0] * cos(a), profile[i + 1][0] * sin(a), profile[i + 1][1]);
        }
    put_point(m, 0, 0, profile[count - 1][1]);
    for (size_t j = 0; j < n; j++) {
        size_t k = (j + 1) % n;
        put_face(m, 0, 1 + k, 1 + j);
        for (size_t i = 0; i + 1 < rings; i++)
            put_quad(m, 1 + i * n + j, 1 + i * n + k, 1 + (i + 1) * n + k, 1 + (i + 1) * n + j);
        put_face(m, top, 1 + (rings - 1) * n + j, 1 + (rings - 1) * n + k);
    }
    return c->count - 1;
}

int csg_ball(csg *c, int parent, double radius, int stacks, int slices)
{
    double(*profile)[2] = check_alloc((size_t)stacks + 1, sizeof *profile);
    for (int i = 0; i <= stacks; i++) {
        profile[i][0] = radius * sin(pi * i / stacks);
        profile[i][1] = -radius * cos(pi * i / stacks);
    }
    int node = csg_turned(c, parent, (const double(*)[2])profile, stacks + 1, slices);
    free(profile);
    return node;
}

/* A tip is a ring of its own only where there is a radius. */
int csg_cylinder(csg *c, int parent, double bottom, double top, double height, int slices)
{
    double profile[4][2] = {{0, 0}};
    int    count = 1;
    if (bottom > 0)
        memcpy(profile[count++], (double[]){bottom, 0}, sizeof *profile);
    if (top > 0)
        memcpy(profile[count++], (double[]){top, height}, sizeof *profile);
    profile[count++][1] = height;
    return csg_turned(c, parent, (const double(*)[2])profile, count, slices);
}

int csg_cup(csg *c, int parent, double radius, double height, double wall, int slices)
{
    double profile[6][2] = {{0, 0},   {radius, 0}, {radius, height}, {radius - wall, height}, {radius - wall, wall},
                            {0, wall}};
    return csg_turned(c, parent, (const double(*)[2])profile, 6, slices);
}

int csg_torus(csg *c, int parent, double major, double minor, int around, int across)
{
    size_t    u = (size_t)around, v = (size_t)across;
    csg_mesh *m = new_mesh(c, parent, u * v, 2 * u * v);
    for (size_t i = 0; i < u; i++)
        for (size_t j = 0; j < v; j++) {
            double a = 2 * pi * (double)i / around, b = 2 * pi * (double)j / across;
            size_t i1 = (i + 1) % u, j1 = (j + 1) % v;
            put_point(m, (major + minor * cos(b)) * cos(a), (major + minor * cos(b)) * sin(a), minor * sin(b));
            put_quad(m, i * v + j, i1 * v + j, i1 * v + j1, i * v + j1);
        }
    return c->count - 1;
}

int csg_prism(csg *c, int parent, const double (*outline)[2], int count, const double centre[2], double height)
{
    size_t    n = (size_t)count;
    csg_mesh *m = new_mesh(c, parent, 2 * n + 2, 4 * n);
    for (int end = 0; end < 2; end++) {
        for (size_t i = 0; i < n; i++)
            put_point(m, outline[i][0], outline[i][1], end * height);
        put_point(m, centre[0], centre[1], end * height);
    }
    for (size_t i = 0; i < n; i++) {
        size_t k = (i + 1) % n;
        put_face(m, n, k, i);
        put_face(m, 2 * n + 1, n + 1 + i, n + 1 + k);
        put_quad(m, i, k, n + 1 + k, n + 1 + i);
    }
    return c->count - 1;
}

int csg_angle(csg *c, int parent, double side, double thick, double height)
{
    double outline[6][2] = {{0, 0}, {side, 0}, {side, thick}, {thick, thick}, {thick, side}, {0, side}},
           centre[2] = {0.4 * thick, 0.6 * thick};
    return csg_prism(c, parent, (const double(*)[2])outline, 6, centre, height);
}

int csg_star(csg *c, int parent, double outer, double inner, int points, double height)
{
    double(*outline)[2] = check_alloc(2 * (size_t)points, sizeof *outline), centre[2] = {0, 0};
    for (int i = 0; i < 2 * points; i++) {
        double radius = i % 2 ? inner : outer;
        outline[i][0] = radius * cos(pi * i / points);
        outline[i][1] = radius * sin(pi * i / points);
    }
    int node = csg_prism(c, parent, (const double(*)[2])outline, 2 * points, centre, height);
    free(outline);
    return node;
}

/* Every triple of points against all others: slow, and hard to get wrong. */
int csg_hull(csg *c, int parent, double radius, int points, uint32_t *state)
{
    size_t    n = (size_t)points;
    csg_mesh *m = new_mesh(c, parent, n, 2 * n);
    while (m->point_count < n) {
        double x = scene_between(state, -1, 1), y = scene_between(state, -1, 1), z = scene_between(state, -1, 1);
        double far = radius * scene_between(state, 0.8, 1);
        dvec   p = dvec_unit(dvec_of(x, y, z));
        put_point(m, far * p.x, far * p.y, far * p.z);
    }
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < n; j++)
            for (size_t k = 0; k < n; k++) {
                if (j <= i || k <= i || j == k)
                    continue;
                dvec area = dvec_cross(dvec_sub(m->points[j], m->points[i]), dvec_sub(m->points[k], m->points[i]));
                bool outside = false;
                for (size_t l = 0; l < n && !outside; l++)
                    outside = l != i && l != j && l != k && dvec_dot(area, dvec_sub(m->points[l], m->points[i])) > 0;
                if (!outside && m->face_count < 2 * n)
                    put_face(m, i, j, k);
            }
    return c->count - 1;
}

void csg_place(csg *c, int node, dvec scale, dvec axis, double degrees, dvec translation)
{
    shape turned = {0};
    shape_add(&turned, "", 0, 0, false, false);
    shape_place(&turned, axis, degrees, translation);
    double *m = c->nodes[node].matrix, factors[3] = {scale.x, scale.y, scale.z};
    for (int k = 0; k < 16; k++)
        m[k] = turned.parts[0].matrix[k] * (k < 12 ? factors[k / 4] : 1);
    shape_release(&turned);
}

void csg_move(csg *c, int node, double x, double y, double z)
{
    csg_place(c, node, dvec_of(1, 1, 1), dvec_of(0, 0, 1), 0, dvec_of(x, y, z));
}

void csg_colour(csg *c)
{
    for (int i = 0, k = 0; i < c->count; i++) {
        csg_node *n = &c->nodes[i];
        if (n->kind != CSG_LEAF)
            continue;
        n->has_colour = true;
        n->colour[0] = (uint8_t)(30 + 55 * (k % 5));
        n->colour[1] = (uint8_t)(40 + 50 * (k / 5 % 5));
        n->colour[2] = (uint8_t)(50 + 60 * (k / 25 % 4));
        k++;
    }
}

static int put_cylinder(csg *c, int parent, double radius, double x, double y, double z, double height, int slices)
{
    int node = csg_cylinder(c, parent, radius, radius, height, slices);
    csg_move(c, node, x, y, z);
    return node;
}

void csg_spanner(csg *c)
{
    int root = csg_add(c, -1, CSG_DIFFERENCE), body = csg_add(c, root, CSG_UNION);
    csg_box(c, body, dvec_of(-1.2, -0.18, -0.1), dvec_of(1.2, 0.18, 0.1));
    put_cylinder(c, body, 0.55, -1.3, 0, -0.16, 0.32, 48);
    put_cylinder(c, body, 0.45, 1.35, 0, -0.16, 0.32, 48);
    csg_place(c, csg_box(c, root, dvec_of(-0.9, -0.24, -1), dvec_of(0.1, 0.24, 1)), dvec_of(1, 1, 1), dvec_of(0, 0, 1),
              15, dvec_of(-1.3, 0, 0));
    put_cylinder(c, root, 0.28, 1.35, 0, -1, 2, 6);
    for (int side = -1; side <= 1; side += 2)
        csg_box(c, root, dvec_of(-0.6, -0.1, side > 0 ? 0.05 : -1), dvec_of(0.75, 0.1, side > 0 ? 1 : -0.05));
    csg_place(c, csg_cylinder(c, root, 0.05, 0.05, 2.6, 16), dvec_of(1, 1, 1), dvec_of(0, 1, 0), 90,
              dvec_of(-1.3, 0.14, 0));
}

/* --- trees from seeds ----------------------------------------------------------------------------------- */

typedef struct maker {
    csg     *c;
    uint32_t state;
    double   size, spread, concave; /* of leaves; share that is not convex */
    bool     lattice;
} maker;

static int whole(maker *m, int low, int high)
{
    int n = low + (int)((high - low + 1) * scene_random(&m->state));
    return n > high ? high : n;
}

static int convex_leaf(maker *m, int parent, double size)
{
    double a = size * scene_between(&m->state, 0.6, 1), b = size * scene_between(&m->state, 0.6, 1);
    switch (whole(m, 0, 4)) {
    case 0: return csg_box(m->c, parent, dvec_of(-a, -b, -size), dvec_of(b, a, size));
    case 1: return csg_ball(m->c, parent, a, 8, 14);
    case 2: return csg_cylinder(m->c, parent, 0.7 * a, 0.7 * a, 1.5 * b, 16);
    case 3: return csg_cylinder(m->c, parent, a, whole(m, 0, 1) ? 0 : 0.4 * b, 1.6 * b, 14);
    default: return csg_hull(m->c, parent, size, whole(m, 7, 12), &m->state);
    }
}

static int concave_leaf(maker *m, int parent, double size)
{
    double a = size * scene_between(&m->state, 0.6, 1), b = size * scene_between(&m->state, 0.3, 0.45);
    switch (whole(m, 0, 3)) {
    case 0: return csg_torus(m->c, parent, a, b, 18, 10);
    case 1: return csg_angle(m->c, parent, 1.6 * a, 1.5 * b, a);
    case 2: return csg_star(m->c, parent, 1.3 * a, b, whole(m, 4, 6), a);
    default: return csg_cup(m->c, parent, a, 1.3 * a, 0.6 * b, 16);
    }
}

static void any_leaf(maker *m, int parent, bool large)
{
    double size = m->size * (large ? 1.3 : 1);
    bool   concave = scene_random(&m->state) < m->concave;
    int    node = concave ? concave_leaf(m, parent, size) : convex_leaf(m, parent, size);
    double x = scene_between(&m->state, -1, 1), y = scene_between(&m->state, -1, 1),
           z = scene_between(&m->state, -1, 1);
    dvec axis = dvec_of(y + 0.01, z + 0.02, x + 0.03), scale = {1, 1, 1};
    if (scene_random(&m->state) < 0.25)
        scale = dvec_of(scene_random(&m->state) < 0.5 ? -1 : 1, scene_between(&m->state, 0.7, 1), 1);
    double far = m->spread * (large ? 0.5 : 1);
    csg_place(m->c, node, scale, axis, scene_between(&m->state, 0, 360), dvec_scale(dvec_of(x, y, z), far));
}

/* Corners on a lattice of halves; now and then what is there already. */
static void lattice_leaf(maker *m, int parent, bool large)
{
    int kind = whole(m, 0, 5), last = -1;
    for (int i = m->c->count - 1; i >= 0 && kind == 0; i--)
        if (m->c->nodes[i].kind == CSG_LEAF && scene_random(&m->state) < 0.5)
            last = last < 0 ? i : last;
    if (last >= 0) {
        csg_copy(m->c, parent, m->c, last);
        return;
    }
    int span = large ? 3 : 2, low[3], high[3];
    for (int k = 0; k < 3; k++) {
        low[k] = whole(m, -2, large ? -1 : 1);
        high[k] = low[k] + whole(m, large ? 2 : 1, span);
    }
    if (kind == 1) {
        int node = csg_cylinder(m->c, parent, 0.5 * span / 2, 0.5 * span / 2, (high[2] - low[2]) / 2.0, 16);
        csg_move(m->c, node, low[0] / 2.0, low[1] / 2.0, low[2] / 2.0);
    } else if (kind == 2) {
        int node = csg_ball(m->c, parent, span / 2.2, 8, 16);
        csg_move(m->c, node, low[0] / 2.0, low[1] / 2.0, low[2] / 2.0);
    } else {
        csg_box(m->c, parent, dvec_of(low[0] / 2.0, low[1] / 2.0, low[2] / 2.0),
                dvec_of(high[0] / 2.0, high[1] / 2.0, high[2] / 2.0));
    }
}

static void put_leaf(maker *m, int parent, bool large)
{
    if (m->lattice)
        lattice_leaf(m, parent, large);
    else
        any_leaf(m, parent, large);
}

/* An operation over so many leaves; what others take away from or meet with is larger, so that something is left. */
static void grow(maker *m, int parent, int leaves, int depth, bool large)
{
    static const csg_kind kinds[] = {CSG_UNION, CSG_UNION, CSG_DIFFERENCE, CSG_DIFFERENCE, CSG_INTERSECTION};
    if (leaves == 1) {
        put_leaf(m, parent, large);
        return;
    }
    csg_kind kind = kinds[whole(m, 0, 4)];
    int      node = csg_add(m->c, parent, kind), children = whole(m, 2, kind == CSG_INTERSECTION ? 2 : 5);
    if (children > leaves || depth <= 1)
        children = leaves;
    if (scene_random(&m->state) < 0.2)
        csg_place(m->c, node, dvec_of(1, 1, m->lattice ? -1 : 0.9), dvec_of(0, 0, 1), m->lattice ? 90 : 40,
                  dvec_of(0, 0, 0));
    for (int k = 0; k < children; k++) {
        int fraction = k == children - 1 ? leaves : 1 + whole(m, 0, 2 * (leaves - children + k) / (children - k));
        fraction = fraction > leaves - (children - 1 - k) ? leaves - (children - 1 - k) : fraction;
        leaves -= fraction;
        grow(m, node, fraction, depth - 1, kind == CSG_INTERSECTION || (kind == CSG_DIFFERENCE && k == 0));
    }
}

/* Is at least a twentieth of the box solid? */
static bool worth_drawing(const csg *c)
{
    csg_rays *r = csg_rays_create(c, 30);
    dvec      low, high;
    uint32_t  state = 7;
    int       inside = 0;
    csg_rays_box(r, &low, &high);
    for (int k = 0; k < 400; k++) {
        double x = scene_between(&state, low.x, high.x), y = scene_between(&state, low.y, high.y);
        inside += csg_inside(r, dvec_of(x, y, scene_between(&state, low.z, high.z)));
    }
    csg_rays_destroy(r);
    return inside >= 20;
}

void csg_random(csg *c, csg_scene kind, uint32_t seed)
{
    static const struct {
        int    least, most, depth;
        double size, spread, concave;
    } of[CSG_SCENES] = {{2, 8, 3, 0.8, 0.6, 0},
                        {2, 8, 3, 0.8, 0.6, 0.75},
                        {7, 14, 6, 0.8, 0.6, 0.3},
                        {40, 60, 4, 0.5, 0.95, 0.3},
                        {3, 10, 3, 0, 0, 0}};
    maker m = {.c = c,
               .state = seed * 2654435761u + (uint32_t)kind * 40503u,
               .size = of[kind].size,
               .spread = of[kind].spread,
               .concave = of[kind].concave,
               .lattice = kind == CSG_COINCIDENT};
    do {
        csg_release(c);
        grow(&m, -1, whole(&m, of[kind].least, of[kind].most), of[kind].depth, true);
        if (m.lattice)
            csg_place(c, 0, dvec_of(1, 1, 1), dvec_of(1, 2, 0.5), scene_between(&m.state, 10, 350),
                      dvec_of(0.05, -0.03, 0.02));
    } while (!worth_drawing(c));
    csg_colour(c);
}

bool csg_find_position(csg_rays *r, bool in_solid, uint32_t seed, dvec *out)
{
    static const dvec around[] = {{0, 0, 0}, {1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    dvec              low, high;
    uint32_t          state = seed;
    csg_rays_box(r, &low, &high);
    for (int k = 0; k < 2000; k++) {
        double x = scene_between(&state, low.x, high.x), y = scene_between(&state, low.y, high.y);
        *out = dvec_of(x, y, scene_between(&state, low.z, high.z));
        bool good = true, in_leaf = false;
        for (int leaf = 0; leaf < (int)csg_rays_leaves(r) && !in_solid; leaf++)
            in_leaf = in_leaf || csg_inside_leaf(r, leaf, *out);
        good = in_solid || in_leaf;
        for (int n = 0; n < 7 && good; n++)
            good = csg_inside(r, dvec_add(*out, dvec_scale(around[n], 0.04 * csg_rays_extent(r)))) == in_solid;
        if (good)
            return true;
    }
    return false;
}
