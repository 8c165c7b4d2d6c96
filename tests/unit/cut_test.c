/* Sections against answers known without them: areas and volumes of solids, and meshes that must stay closed. */
#include "import_support.h"

#include <math.h>
#include <time.h>

#include "base/text.h"
#include "cut/cut.h"

static const double pi = 3.14159265358979323846;

/* --- meshes --------------------------------------------------------------------------------------------- */

typedef struct model {
    vec3     positions[70000];
    uint32_t indices[400000];
    uint32_t vertices, corners;
} model;

static void clear(model *m)
{
    m->vertices = m->corners = 0;
}

static uint32_t add_vertex(model *m, double x, double y, double z)
{
    m->positions[m->vertices] = (vec3){(float)x, (float)y, (float)z};
    return m->vertices++;
}

static void add_triangle(model *m, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t t[3] = {a, b, c};
    memcpy(m->indices + m->corners, t, sizeof t);
    m->corners += 3;
}

static void add_quad(model *m, uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    add_triangle(m, a, b, c);
    add_triangle(m, a, c, d);
}

/* Inside out when high < low in an odd number of axes. */
static void add_box(model *m, double x0, double y0, double z0, double x1, double y1, double z1)
{
    uint32_t v[8];
    for (int i = 0; i < 8; i++)
        v[i] = add_vertex(m, i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0);
    add_quad(m, v[0], v[2], v[3], v[1]);
    add_quad(m, v[4], v[5], v[7], v[6]);
    add_quad(m, v[0], v[1], v[5], v[4]);
    add_quad(m, v[2], v[6], v[7], v[3]);
    add_quad(m, v[0], v[4], v[6], v[2]);
    add_quad(m, v[1], v[3], v[7], v[5]);
}

/* Around z; a hollow when `sign` is −1. */
static void add_torus(model *m, double major, double minor, int around, int across, int sign)
{
    uint32_t base = m->vertices;
    for (int i = 0; i < around; i++)
        for (int k = 0; k < across; k++) {
            double a = 2 * pi * i / around, b = 2 * pi * k / across;
            add_vertex(m, (major + minor * cos(b)) * cos(a), (major + minor * cos(b)) * sin(a), minor * sin(b));
        }
    for (int i = 0; i < around; i++)
        for (int k = 0; k < across; k++) {
            uint32_t p = base + (uint32_t)(i * across + k), q = base + (uint32_t)((i + 1) % around * across + k);
            uint32_t r = base + (uint32_t)((i + 1) % around * across + (k + 1) % across),
                     s = base + (uint32_t)(i * across + (k + 1) % across);
            if (sign > 0)
                add_quad(m, p, q, r, s);
            else
                add_quad(m, p, s, r, q);
        }
}

static void add_sphere(model *m, double radius, double x, int rows, int columns, int sign)
{
    uint32_t top = add_vertex(m, x, 0, radius), bottom = add_vertex(m, x, 0, -radius), base = m->vertices;
    for (int i = 1; i < rows; i++)
        for (int k = 0; k < columns; k++) {
            double a = pi * i / rows, b = 2 * pi * k / columns;
            add_vertex(m, x + radius * sin(a) * cos(b), radius * sin(a) * sin(b), radius * cos(a));
        }
    for (int k = 0; k < columns; k++) {
        uint32_t next = (uint32_t)((k + 1) % columns), last = base + (uint32_t)((rows - 2) * columns);
        uint32_t t[2][3] = {{top, base + (uint32_t)k, base + next}, {bottom, last + next, last + (uint32_t)k}};
        for (int i = 0; i < 2; i++)
            add_triangle(m, t[i][0], sign > 0 ? t[i][1] : t[i][2], sign > 0 ? t[i][2] : t[i][1]);
        for (int i = 0; i + 2 < rows; i++) {
            uint32_t p = base + (uint32_t)(i * columns), q = p + (uint32_t)columns;
            if (sign > 0)
                add_quad(m, p + (uint32_t)k, q + (uint32_t)k, q + next, p + next);
            else
                add_quad(m, p + (uint32_t)k, p + next, q + next, q + (uint32_t)k);
        }
    }
}

/* --- measuring ------------------------------------------------------------------------------------------ */

static uint32_t random_state = 1;

static double random_number(double low, double high)
{
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * (random_state >> 8) / 16777216.0;
}

static mat4 random_turn(void)
{
    double r[4], zero[3] = {0, 0, 0}, one[3] = {1, 1, 1};
    for (int i = 0; i < 4; i++)
        r[i] = random_number(-1, 1);
    return mat4_from_trs(zero, r, one);
}

/* The triangles of a result, caps last; corners in `out`, as many as are returned. */
static size_t gather(const cut_result *r, const model *m, const mat4 *world, vec3 *out, size_t *first_cap)
{
    size_t             n = 0;
    const cut_surface *s = r->surfaces;
    for (size_t i = 0; i < s->whole_count; i++)
        for (int k = 0; k < 3; k++)
            out[n++] = m->positions[m->indices[3 * s->whole[i] + (uint32_t)k]];
    for (size_t i = 0; i < s->corner_count; i++)
        out[n++] = s->corners[i].position;
    *first_cap = n;
    for (size_t c = 0; c < r->cap_count; c++)
        for (size_t i = 0; i < r->caps[c].count; i++)
            out[n++] = r->caps[c].positions[i];
    (void)world;
    return n;
}

static double volume_of(const vec3 *c, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i += 3) {
        vec3 a = c[i], b = c[i + 1], d = c[i + 2];
        sum += a.x * ((double)b.y * d.z - (double)b.z * d.y) + a.y * ((double)b.z * d.x - (double)b.x * d.z) +
               a.z * ((double)b.x * d.y - (double)b.y * d.x);
    }
    return sum / 6;
}

static double area_of(const vec3 *c, size_t count)
{
    double sum = 0;
    for (size_t i = 0; i < count; i += 3) {
        double u[3] = {c[i + 1].x - (double)c[i].x, c[i + 1].y - (double)c[i].y, c[i + 1].z - (double)c[i].z};
        double v[3] = {c[i + 2].x - (double)c[i].x, c[i + 2].y - (double)c[i].y, c[i + 2].z - (double)c[i].z};
        double x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2], z = u[0] * v[1] - u[1] * v[0];
        sum += sqrt(x * x + y * y + z * z);
    }
    return sum / 2;
}

typedef struct side {
    uint32_t a, b;
} side;

static int compare_sides(const void *p, const void *q)
{
    return memcmp(p, q, sizeof(side));
}

/* Directed edges without one that runs back, by position. */
static size_t open_edges(const vec3 *corners, size_t count)
{
    primitive p = {.vertex_count = (uint32_t)count, .positions = mem_copy(corners, count * sizeof *corners)};
    uint32_t *ids = mesh_position_ids(&p);
    side     *there = mem_alloc(count * sizeof *there), *back = mem_alloc(count * sizeof *back);
    size_t    sides = 0, open = 0;
    for (size_t i = 0; i < count; i++) {
        uint32_t a = ids[i], b = ids[i - i % 3 + (i + 1) % 3];
        if (a == b)
            continue;
        there[sides] = (side){a, b};
        back[sides++] = (side){b, a};
    }
    qsort(there, sides, sizeof *there, compare_sides);
    qsort(back, sides, sizeof *back, compare_sides);
    for (size_t i = 0, k = 0; i < sides || k < sides;) {
        int order = i == sides ? 1 : k == sides ? -1 : compare_sides(&there[i], &back[k]);
        open += order != 0;
        i += order <= 0;
        k += order >= 0;
    }
    mem_free(p.positions);
    mem_free(ids);
    mem_free(there);
    mem_free(back);
    return open;
}

typedef struct measured {
    cut_verdict verdict;
    double      volume, area;
    size_t      open_edges, caps;
    bool        open, normals_right;
} measured;

static model *shape;
static vec3  *corners;

/* The caps' triangles must face where their normal says. `world` must be a turn. */
static bool normals_are_right(const cut_result *r, const cut *c, const mat4 *world)
{
    for (size_t i = 0; i < r->cap_count; i++) {
        const cut_cap *cap = &r->caps[i];
        const double  *n = c->planes[cap->plane].normal, *m = world->m;
        double         turned = 0, length = 0;
        for (int k = 0; k < 3; k++) {
            double w = m[k] * cap->normal.x + m[4 + k] * cap->normal.y + m[8 + k] * cap->normal.z;
            turned += w * n[k] * (cap->positive ? 1 : -1);
            length += w * w;
        }
        if (fabs(turned - sqrt(length)) > 1e-6 * turned)
            return false;
        for (size_t t = 0; t < cap->count; t += 3) {
            const vec3 *q = &cap->positions[t];
            double      u[3] = {q[1].x - (double)q[0].x, q[1].y - (double)q[0].y, q[1].z - (double)q[0].z};
            double      v[3] = {q[2].x - (double)q[0].x, q[2].y - (double)q[0].y, q[2].z - (double)q[0].z};
            double along = cap->normal.x * (u[1] * v[2] - u[2] * v[1]) + cap->normal.y * (u[2] * v[0] - u[0] * v[2]) +
                           cap->normal.z * (u[0] * v[1] - u[1] * v[0]);
            if (along < -1e-6)
                return false;
        }
    }
    return true;
}

static measured cut_with(const cut *c, const mat4 *world)
{
    measured   out = {0};
    cut_result r;
    cut_input  input = {shape->positions, shape->vertices, shape->indices, shape->corners};
    assert_int_equal(cut_part(&r, c, world, &input, 1, NULL), LMN_OK);
    out.verdict = r.verdict;
    out.open = r.open;
    out.caps = r.cap_count;
    if (r.verdict == CUT_CROSSED) {
        size_t first_cap, count = gather(&r, shape, world, corners, &first_cap);
        out.volume = volume_of(corners, count);
        out.area = area_of(corners + first_cap, count - first_cap);
        out.open_edges = open_edges(corners, count);
        out.normals_right = normals_are_right(&r, c, world);
    }
    cut_result_release(&r);
    return out;
}

static box3 shape_box(const mat4 *world)
{
    box3 box = box3_empty();
    for (uint32_t i = 0; i < shape->vertices; i++)
        box = box3_with_point(box, mat4_transform_point(world, shape->positions[i]));
    return box;
}

static measured cut_turned(const char *spec, const mat4 *world)
{
    cut       c;
    lmn_error error = {0};
    if (cut_parse(&c, spec, shape_box(world), &error) != LMN_OK)
        fail_msg("%s: %s", spec, error.message);
    return cut_with(&c, world);
}

static measured cut_by(const char *spec)
{
    mat4 world = mat4_identity();
    return cut_turned(spec, &world);
}

#define assert_near(a, b, tolerance) assert_near_at(a, b, tolerance, #a, __LINE__)
static void assert_near_at(double a, double b, double tolerance, const char *what, int line)
{
    if (!(fabs(a - b) <= tolerance * fmax(1, fabs(b))))
        fail_msg("line %d: %s is %.9g, expected %.9g", line, what, a, b);
}

static void assert_solid(measured m, double volume, double area, double tolerance)
{
    assert_int_equal(m.verdict, CUT_CROSSED);
    assert_near(m.volume, volume, tolerance);
    assert_near(m.area, area, tolerance);
    assert_int_equal(m.open_edges, 0);
    assert_false(m.open);
    assert_true(m.normals_right);
}

/* --- planes --------------------------------------------------------------------------------------------- */

static void a_cube_is_cut_by_planes(void **state)
{
    (void)state;
    clear(shape);
    add_box(shape, 0, 0, 0, 2, 2, 2);
    assert_solid(cut_by("x"), 4, 4, 1e-6);
    assert_solid(cut_by("x=0.5"), 2, 4, 1e-6);
    assert_solid(cut_by("-x=0.5"), 6, 4, 1e-6);
    assert_solid(cut_by("-z=75%"), 2, 4, 1e-6);
    assert_solid(cut_by("1,1,1@1,1,1"), 4, 3 * sqrt(3.0), 1e-6);       /* a regular hexagon of side √2 */
    assert_solid(cut_by("-1,-1,0 @ 1,1,0"), 4, 4 * sqrt(2.0), 1e-6);   /* through four corners */
    assert_solid(cut_by("1,1,1@2,0,0"), 8.0 / 6, 2 * sqrt(3.0), 1e-6); /* through three */
    assert_solid(cut_by("x=1; y=1"), 2, 4, 1e-6);
    assert_int_equal(cut_by("x=3").verdict, CUT_WHOLE);
    assert_int_equal(cut_by("x=-1").verdict, CUT_GONE);
}

static void faces_in_the_plane_are_no_cut_faces(void **state)
{
    (void)state;
    clear(shape);
    add_box(shape, 0, 0, 0, 2, 2, 2);
    measured m = cut_by("x=2");
    assert_true(m.verdict == CUT_WHOLE || (m.caps == 0 && m.open_edges == 0));
    m = cut_by("x=0");
    assert_true(m.verdict == CUT_GONE || (m.caps == 0 && m.volume == 0));
    /* Two steps: the lower one's top lies in the plane and stays bare, the upper one is cut. */
    add_box(shape, 5, 0, 0, 6, 2, 3);
    m = cut_by("z=2");
    assert_solid(m, 8 + 4, 2, 1e-6);
    assert_int_equal(m.caps, 1);
    /* One L-shaped solid, the same. */
    clear(shape);
    const double outline[6][2] = {{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 2}, {0, 2}};
    for (int i = 0; i < 6; i++)
        for (int k = 0; k < 2; k++)
            add_vertex(shape, outline[i][0], k, outline[i][1]);
    for (uint32_t i = 0; i < 6; i++) {
        uint32_t next = (i + 1) % 6;
        add_quad(shape, 2 * i, 2 * next, 2 * next + 1, 2 * i + 1);
    }
    for (uint32_t k = 0; k < 2; k++) {
        const uint32_t t[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 5}, {3, 4, 5}};
        for (int i = 0; i < 4; i++)
            add_triangle(shape, 2 * t[i][0] + k, 2 * t[i][k ? 1 : 2] + k, 2 * t[i][k ? 2 : 1] + k);
    }
    m = cut_by("z=1");
    assert_int_equal(m.open_edges, 0);
    assert_near(fabs(m.volume), 3, 1e-6);
    assert_near(m.area, 1, 1e-6);
    m = cut_by("-z=1");
    assert_int_equal(m.open_edges, 0);
    assert_near(fabs(m.volume), 1, 1e-6);
    assert_near(m.area, 1, 1e-6);
}

static void round_solids_have_round_sections(void **state)
{
    (void)state;
    clear(shape);
    add_sphere(shape, 1, 0, 128, 256, 1);
    assert_solid(cut_by("x=0.5"), pi * (4.0 / 3 - 0.25 * 2.5 / 3), pi * 0.75, 1e-3);
    assert_solid(cut_by("z=0"), 2 * pi / 3, pi, 1e-3);
    assert_solid(cut_by("1,2,3@0,0,0"), 2 * pi / 3, pi, 1e-3);
    clear(shape);
    add_torus(shape, 2, 0.5, 256, 64, 1);
    measured m = cut_by("x=0");
    assert_solid(m, pi * pi * 2 * 0.25, 2 * pi * 0.25, 2e-3);
    assert_int_equal(m.caps, 1);
    assert_solid(cut_by("z=0"), pi * pi * 2 * 0.25, pi * (2.5 * 2.5 - 1.5 * 1.5), 2e-3);
}

static void hollows_stay_open(void **state)
{
    (void)state;
    clear(shape);
    add_sphere(shape, 3, 0, 32, 64, 1);
    add_sphere(shape, 2, 0, 32, 64, -1);
    add_sphere(shape, 1, 0, 32, 64, 1);
    double   disc = 64 * sin(2 * pi / 64) / 2, ball = volume_of(corners, 0);
    measured m = cut_by("z=0");
    ball = m.volume;
    assert_solid(m, ball, disc * (9 - 4 + 1), 1e-5);
    assert_near(ball, 2 * pi / 3 * (27 - 8 + 1), 1e-2);
    assert_int_equal(m.caps, 2);
    /* Inside out as a whole, as some files are. */
    for (uint32_t i = 0; i < shape->corners; i += 3) {
        uint32_t kept = shape->indices[i];
        shape->indices[i] = shape->indices[i + 1];
        shape->indices[i + 1] = kept;
    }
    m = cut_by("z=0");
    assert_near(m.area, disc * (9 - 4 + 1), 1e-5);
    assert_int_equal(m.open_edges, 0);
    assert_near(m.volume, -ball, 1e-5);
}

static void overlapping_shells_are_filled_once(void **state)
{
    (void)state;
    clear(shape);
    add_box(shape, 0, 0, 0, 4, 4, 4);
    add_box(shape, 3, 1, 0, 5, 2, 4); /* a bar that sticks in it */
    measured m = cut_by("z=2");
    assert_near(m.area, 16 + 1, 1e-6);
    assert_int_equal(m.caps, 2);
    clear(shape);
    add_torus(shape, 2, 0.5, 64, 32, 1);
    add_sphere(shape, 1.6, 0, 32, 64, 1); /* fills the ring's inside and cuts into it */
    m = cut_by("z=0");
    assert_near(m.area, pi * 2.5 * 2.5, 1e-2);
}

/* --- cases by the hundred ------------------------------------------------------------------------------- */

static void make_random_shape(int kind)
{
    clear(shape);
    switch (kind) {
    case 0: add_box(shape, -1, -1, -1, 1, 1, 1); break;
    case 1: add_sphere(shape, 1, 0, 16, 24, 1); break;
    case 2: add_torus(shape, 1, 0.4, 24, 16, 1); break;
    case 3:
        add_sphere(shape, 1, 0, 12, 16, 1);
        add_sphere(shape, 0.6, 0.1, 10, 12, -1);
        break;
    default:
        add_torus(shape, 1, 0.4, 30, 20, 1);
        add_torus(shape, 1, 0.25, 30, 12, -1);
        break;
    }
}

static void random_cuts_stay_closed(void **state)
{
    (void)state;
    for (int i = 0; i < 500; i++) {
        make_random_shape(i % 5);
        mat4 world = random_turn();
        char spec[128];
        snprintf(spec, sizeof spec, "%.6f,%.6f,%.6f@%.6f,%.6f,%.6f", random_number(-1, 1), random_number(-1, 1),
                 random_number(-1, 1), random_number(-0.4, 0.4), random_number(-0.4, 0.4),
                 i % 3 ? 0.0 : random_number(-0.4, 0.4));
        if (i % 4 == 0) { /* often through vertices and along edges */
            world = mat4_identity();
            snprintf(spec, sizeof spec, "%s=%d%%", i % 8 ? "x" : "-z", 25 * (1 + i / 8 % 3));
        }
        measured m = cut_turned(spec, &world);
        cut      c;
        assert_int_equal(cut_parse(&c, spec, shape_box(&world), NULL), LMN_OK);
        c.cells[0].faces[0].positive = !c.cells[0].faces[0].positive;
        measured rest = cut_with(&c, &world);
        size_t   first_cap;
        (void)first_cap;
        if (m.verdict != CUT_CROSSED)
            continue;
        if (m.open_edges || m.open || !m.normals_right)
            fail_msg("case %d, %s: %zu open edges", i, spec, m.open_edges);
        if (rest.verdict == CUT_CROSSED) { /* both halves are the whole, and share their cut face */
            assert_near(rest.area, m.area, 1e-5);
            assert_int_equal(rest.open_edges, 0);
        }
    }
}

static double whole_volume(void)
{
    for (uint32_t i = 0; i < shape->corners; i++)
        corners[i] = shape->positions[shape->indices[i]];
    return volume_of(corners, shape->corners);
}

static void halves_add_up(void **state)
{
    (void)state;
    for (int i = 0; i < 60; i++) {
        make_random_shape(i % 5);
        mat4   world = random_turn();
        double n[3] = {random_number(-1, 1), random_number(-1, 1), random_number(-1, 1)};
        char   one[128], other[128];
        snprintf(one, sizeof one, "%.6f,%.6f,%.6f@0.1,0.2,0.1", n[0], n[1], n[2]);
        snprintf(other, sizeof other, "%.6f,%.6f,%.6f@0.1,0.2,0.1", -n[0], -n[1], -n[2]);
        assert_near(cut_turned(one, &world).volume + cut_turned(other, &world).volume, whole_volume(), 1e-5);
    }
}

/* --- boxes ---------------------------------------------------------------------------------------------- */

static void boxes_take_a_piece_out(void **state)
{
    (void)state;
    clear(shape);
    add_box(shape, 0, 0, 0, 2, 2, 2);
    assert_solid(cut_by("box=1,0,1:2,2,2"), 8 - 2, 4, 1e-6); /* its outer faces lie in the cube's */
    assert_solid(cut_by("box=50%,0%,50%:100%,100%,100%"), 8 - 2, 4, 1e-6);
    assert_solid(cut_by("box=1,-1,1:3,3,3"), 8 - 2, 4, 1e-6);
    assert_solid(cut_by("box=3,3,3:1,1,1"), 8 - 1, 3, 1e-6);
    assert_solid(cut_by("box=0.5,0.5,0.5:1.5,1.5,1.5"), 8 - 1, 6, 1e-6);        /* a hollow */
    assert_solid(cut_by("box=0.5,0.5,-1:1.5,1.5,3"), 8 - 2, 8, 1e-6);           /* a hole */
    assert_solid(cut_by("box=1,1,1:3,3,3;box=-1,-1,-1:1,1,1"), 8 - 2, 6, 1e-6); /* meet in a point */
    assert_solid(cut_by("box=1,1,1:3,3,3;box=0.5,0.5,1.5:3,3,3"), 8 - 1 - (1.5 * 1.5 - 1) * 0.5,
                 1 + 1.25 + 2 * 1 * 0.5 + 2 * 1.5 * 0.5, 1e-6);
    assert_solid(cut_by("x=1.5;box=1,1,1:3,3,3"), 6 - 0.5, 4 - 1 + 1 + 0.5 * 2, 1e-6);
    assert_solid(cut_by("box=0,0,1:1,1,3;box=1,0,1:2,1,3"), 8 - 2, 4, 1e-6); /* side by side, no wall between */
    assert_int_equal(cut_by("box=-1,-1,-1:3,3,3").verdict, CUT_GONE);
}

/* Two planes bound what goes, and one of them runs on through what stays: triangles there are what they were. */
static void what_nothing_is_taken_from_stays_whole(void **state)
{
    cut        c;
    cut_result r;
    mat4       world = mat4_identity();
    size_t     wanted = 0, whole = 0;
    (void)state;
    clear(shape);
    add_torus(shape, 2, 0.5, 40, 16, 1);
    const cut_input input = {shape->positions, shape->vertices, shape->indices, shape->corners};
    assert_int_equal(cut_parse(&c, "box=0,-9,0.1:9,9,9", (box3){{-3, -3, -3}, {3, 3, 3}}, NULL), LMN_OK);
    assert_int_equal(cut_part(&r, &c, &world, &input, 1, NULL), LMN_OK);
    for (uint32_t t = 0; t < shape->corners / 3; t++) {
        bool left = true;
        for (uint32_t k = 0; k < 3; k++)
            left = left && shape->positions[shape->indices[3 * t + k]].x < -0.4f; /* no neighbour crosses the plane */
        wanted += left;
        for (size_t i = 0; i < r.surfaces[0].whole_count && left; i++)
            whole += r.surfaces[0].whole[i] == t;
    }
    print_message("%zu of %zu triangles are whole\n", whole, wanted);
    assert_true(wanted > 400 && whole == wanted);
    cut_result_release(&r);
    assert_int_equal(cut_by("box=0,-9,0.1:9,9,9").open_edges, 0);
}

static void boxes_cut_round_solids(void **state)
{
    (void)state;
    clear(shape);
    add_sphere(shape, 1, 0, 64, 128, 1);
    measured m = cut_by("box=0,-2,0:2,0,2"); /* an eighth */
    assert_near(m.volume, 7 * pi / 6, 2e-3);
    assert_near(m.area, 3 * pi / 4, 2e-3);
    assert_true(m.normals_right);
    assert_int_equal(m.open_edges, 0);
    for (int i = 0; i < 60; i++) {
        make_random_shape(i % 5);
        mat4   world = random_turn();
        char   box[128];
        double low[3], high[3];
        for (int k = 0; k < 3; k++) {
            low[k] = random_number(-0.8, 0.2);
            high[k] = low[k] + random_number(0.2, 0.9);
        }
        snprintf(box, sizeof box, "box=%.6f,%.6f,%.6f:%.6f,%.6f,%.6f", low[0], low[1], low[2], high[0], high[1],
                 high[2]);
        m = cut_turned(box, &world);
        /* What the box takes is what six planes leave. */
        char planes[256];
        snprintf(planes, sizeof planes, "-x=%.6f;x=%.6f;-y=%.6f;y=%.6f;-z=%.6f;z=%.6f", low[0], high[0], low[1],
                 high[1], low[2], high[2]);
        measured inside = cut_turned(planes, &world);
        if (m.verdict != CUT_CROSSED || inside.verdict != CUT_CROSSED)
            continue;
        assert_near(m.volume + inside.volume, whole_volume(), 1e-5);
        assert_near(m.area, inside.area, 1e-5);
        assert_false(m.open);
        if (m.open_edges || inside.open_edges)
            fail_msg("case %d, %s: %zu and %zu open edges", i, box, m.open_edges, inside.open_edges);
    }
}

/* --- what files bring ----------------------------------------------------------------------------------- */

static void open_meshes_are_told(void **state)
{
    (void)state;
    clear(shape);
    add_box(shape, 0, 0, 0, 2, 2, 2);
    shape->corners -= 6; /* without its last face */
    measured m = cut_by("z=1");
    assert_true(m.open);
    assert_int_equal(m.caps, 0);
    add_box(shape, 5, 0, 0, 6, 2, 2); /* beside a good one */
    m = cut_by("z=1");
    assert_true(m.open);
    assert_int_equal(m.caps, 1);
    assert_near(m.area, 2, 1e-6);
}

static void small_gaps_are_closed(void **state)
{
    (void)state;
    clear(shape);
    add_sphere(shape, 1, 0, 24, 48, 1);
    model   *m = shape;
    uint32_t vertices = m->vertices;
    for (uint32_t i = 0; i < m->corners; i++) { /* each corner its own, a little off */
        vec3 p = m->positions[m->indices[i]];
        m->indices[i] = add_vertex(m, p.x + random_number(-1e-6, 1e-6), p.y + random_number(-1e-6, 1e-6),
                                   p.z + random_number(-1e-6, 1e-6));
    }
    memmove(m->positions, m->positions + vertices, (m->vertices - vertices) * sizeof(vec3));
    m->vertices -= vertices;
    for (uint32_t i = 0; i < m->corners; i++)
        m->indices[i] -= vertices;
    measured cut = cut_by("x=0.33");
    assert_false(cut.open);
    assert_near(cut.area, pi * (1 - 0.33 * 0.33), 1e-2);
}

static void mixed_winding_is_filled(void **state)
{
    (void)state;
    clear(shape);
    add_sphere(shape, 1, 0, 24, 48, 1);
    for (uint32_t i = 0; i < shape->corners; i += 3)
        if (random_number(0, 1) < 0.4) {
            uint32_t kept = shape->indices[i];
            shape->indices[i] = shape->indices[i + 1];
            shape->indices[i + 1] = kept;
        }
    measured m = cut_by("x=0.33");
    assert_false(m.open);
    assert_near(m.area, pi * (1 - 0.33 * 0.33), 1e-2);
}

static void bad_numbers_do_no_harm(void **state)
{
    (void)state;
    clear(shape);
    add_sphere(shape, 1, 0, 8, 12, 1);
    shape->positions[5].x = NAN;
    shape->positions[9].y = INFINITY;
    shape->positions[12].z = -1e38f;
    cut_by("x=0.1;box=0,0,0:1,1,1");
    cut        c;
    mat4       world = mat4_identity();
    cut_input  none = {.positions = shape->positions};
    cut_result r;
    assert_int_equal(cut_parse(&c, "x=0", box3_empty(), NULL), LMN_OK);
    assert_int_equal(cut_part(&r, &c, &world, &none, 1, NULL), LMN_OK);
    cut_result_release(&r);
    assert_int_equal(cut_part(&r, &c, &world, NULL, 0, NULL), LMN_OK);
    cut_result_release(&r);
    for (int k = 0; k < 16; k++)
        world.m[k] = 0;
    cut_with(&c, &world);
    /* Triangles without any order. */
    for (int i = 0; i < 200; i++) {
        clear(shape);
        for (int k = 0; k < 30; k++)
            add_vertex(shape, floor(random_number(-2, 3)), floor(random_number(-2, 3)), floor(random_number(-2, 3)));
        for (int k = 0; k < 60; k++)
            add_triangle(shape, (uint32_t)random_number(0, 30), (uint32_t)random_number(0, 30),
                         (uint32_t)random_number(0, 30));
        cut_by(i % 2 ? "x=0;-1,1,0@0,0,0" : "box=-1,-1,-1:1,1,1;z=1");
    }
}

static void mirrored_parts_are_cut_alike(void **state)
{
    (void)state;
    clear(shape);
    add_sphere(shape, 1, 0.5, 16, 24, 1);
    double   none[3] = {0, 0, 0}, turn[4] = {0, 0, 0, 1}, size[3] = {-1, 1, 1};
    mat4     mirror = mat4_from_trs(none, turn, size);
    measured m = cut_turned("-x=0", &mirror), plain = cut_by("x=0");
    assert_near(m.volume, plain.volume, 1e-6);
    assert_near(m.area, plain.area, 1e-6);
    assert_int_equal(m.open_edges, 0);
}

static void failing_memory_is_reported(void **state)
{
    (void)state;
    clear(shape);
    add_torus(shape, 1, 0.4, 8, 6, 1);
    cut       c;
    mat4      world = mat4_identity();
    cut_input input = {shape->positions, shape->vertices, shape->indices, shape->corners};
    assert_int_equal(cut_parse(&c, "x;box=0,0,0:1,1,1", shape_box(&world), NULL), LMN_OK);
    for (long n = 1;; n++) {
        cut_result r;
        mem_fail_at(n);
        lmn_status status = cut_part(&r, &c, &world, &input, 1, NULL);
        mem_fail_at(0);
        cut_result_release(&r);
        if (status == LMN_OK)
            break;
        assert_int_equal(status, LMN_MEMORY);
        assert_true(n < 10000);
    }
}

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void a_gearbox_is_cut_quickly(void **state)
{
    (void)state;
    const char *folder = data_folder(),
               *specs[] = {"x", "-y", "z", "1,1,0.3@40%,50%,50%", "box=50%,0%,50%:100%,50%,100%"};
    char path[1100];
    if (!folder)
        skip();
    snprintf(path, sizeof path, "%s/mesh/gearbox-100k.stl", folder);
    lmn_scene       *scene = load_or_fail(path);
    const primitive *p = &scene->meshes[0].primitives[0];
    cut_input        input = {p->positions, p->vertex_count, p->indices, p->index_count};
    mat4             world = mat4_identity();
    for (size_t i = 0; i < sizeof specs / sizeof *specs; i++) {
        cut        c;
        cut_result r;
        assert_int_equal(cut_parse(&c, specs[i], p->bounds, NULL), LMN_OK);
        double start = now_ms();
        assert_int_equal(cut_part(&r, &c, &world, &input, 1, NULL), LMN_OK);
        double area = 0;
        for (size_t k = 0; k < r.cap_count; k++)
            area += area_of(r.caps[k].positions, r.caps[k].count);
        print_message("%s: %.1f ms, %zu faces, area %.1f%s\n", specs[i], now_ms() - start, r.cap_count, area,
                      r.open ? ", open" : "");
        assert_false(r.open);
        assert_true(r.cap_count > 0);
        cut_result_release(&r);
    }
    lmn_scene_destroy(&scene);
}

/* --- words ---------------------------------------------------------------------------------------------- */

static void wrong_words_are_refused(void **state)
{
    (void)state;
    const char *const wrong[] = {"w",
                                 "x=",
                                 "x=a",
                                 "x=nan",
                                 "x=inf",
                                 "x=1e30",
                                 "x=1,2",
                                 "xx",
                                 "1,2@0,0,0",
                                 "1,2,3",
                                 "1,2,3@1,2",
                                 "0,0,0@1,1,1",
                                 "box",
                                 "box=1,2,3",
                                 "box=1,2,3:4,5",
                                 "box=1,2,3,4,5,6",
                                 "x y",
                                 "x;;y",
                                 ";x",
                                 "--x",
                                 "x=5%%",
                                 "x;x;x;x;x;x;x;x;x",
                                 "box=1,2,3:4,5,6 x"};
    box3              box = {{0, 0, 0}, {10, 10, 10}};
    cut               c;
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        lmn_error error = {0};
        if (cut_parse(&c, wrong[i], box, &error) != LMN_USAGE)
            fail_msg("'%s' is taken", wrong[i]);
        assert_true(error.message[0] && error.hint[0]);
    }
    const char *const good[] = {
        "", " ", "x", "+x", "-x", "x=1", " x = 1 ; -y = 40% ", "z=-1.5e1;", "1,0,0@50%,0,0", "box=0,0,0:50%,50%,50%"};
    for (size_t i = 0; i < sizeof good / sizeof *good; i++)
        if (cut_parse(&c, good[i], box, NULL) != LMN_OK)
            fail_msg("'%s' is refused", good[i]);
    assert_int_equal(cut_parse(&c, "-x=40%;x=4;box=4,0,0:10,10,10", box, NULL), LMN_OK);
    assert_int_equal(c.cell_count, 3);
    assert_int_equal(c.plane_count, 6); /* the same plane three times is one */
    assert_near(c.planes[0].offset, -4, 1e-12);
    assert_true(c.cells[0].faces[0].positive);
    assert_false(c.cells[1].faces[0].positive);
}

static void boxes_are_judged(void **state)
{
    (void)state;
    box3 bounds = {{0, 0, 0}, {10, 10, 10}};
    cut  c;
    assert_int_equal(cut_parse(&c, "x=5;box=0,0,0:2,2,2", bounds, NULL), LMN_OK);
    assert_int_equal(cut_judge_box(&c, (box3){{6, 0, 0}, {7, 1, 1}}), CUT_GONE);
    assert_int_equal(cut_judge_box(&c, (box3){{3, 0, 0}, {4, 1, 1}}), CUT_WHOLE);
    assert_int_equal(cut_judge_box(&c, (box3){{4, 0, 0}, {6, 1, 1}}), CUT_CROSSED);
    assert_int_equal(cut_judge_box(&c, (box3){{0.5, 0.5, 0.5}, {1, 1, 1}}), CUT_GONE);
    assert_int_equal(cut_judge_box(&c, (box3){{1, 1, 1}, {3, 3, 3}}), CUT_CROSSED);
}

static int make_room(void **state)
{
    (void)state;
    shape = mem_alloc(sizeof *shape);
    corners = mem_alloc(2000000 * sizeof *corners);
    return !shape || !corners;
}

static int end_room(void **state)
{
    (void)state;
    mem_free(shape);
    mem_free(corners);
    return 0;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cube_is_cut_by_planes),
        cmocka_unit_test(faces_in_the_plane_are_no_cut_faces),
        cmocka_unit_test(round_solids_have_round_sections),
        cmocka_unit_test(hollows_stay_open),
        cmocka_unit_test(overlapping_shells_are_filled_once),
        cmocka_unit_test(random_cuts_stay_closed),
        cmocka_unit_test(halves_add_up),
        cmocka_unit_test(boxes_take_a_piece_out),
        cmocka_unit_test(what_nothing_is_taken_from_stays_whole),
        cmocka_unit_test(boxes_cut_round_solids),
        cmocka_unit_test(open_meshes_are_told),
        cmocka_unit_test(small_gaps_are_closed),
        cmocka_unit_test(mixed_winding_is_filled),
        cmocka_unit_test(bad_numbers_do_no_harm),
        cmocka_unit_test(mirrored_parts_are_cut_alike),
        cmocka_unit_test(failing_memory_is_reported),
        cmocka_unit_test(a_gearbox_is_cut_quickly),
        cmocka_unit_test(wrong_words_are_refused),
        cmocka_unit_test(boxes_are_judged),
    };
    return cmocka_run_group_tests(tests, make_room, end_room);
}
