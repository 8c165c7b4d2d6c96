/* Cylinders found in faces: every one that is there, exactly, and none that is not. */
#include "stroke_shapes.h"

#include <ctype.h>
#include <time.h>

#include "base/vector3.h"
#include "draft/cylinders.h"
#include "draft/pitch.h"

enum { CORNERS_MOST = 4096 };

/* What a lathe or an extrusion is put together from. */
typedef struct pieces {
    vec3     positions[CORNERS_MOST];
    uint32_t corners[6 * CORNERS_MOST], position_count, corner_count;
} pieces;

/* Leaning, and away from the origin: nothing may depend on where things lie. */
static const double origin[3] = {3, -7, 11};
static double       frame[3][3]; /* across, across, along */

static void lean(void)
{
    vector3_set(frame[2], 0.4, -0.3, 0.8);
    vector3_normalise(frame[2]);
    vector3_set(frame[0], 0.8, 0, -0.4);
    vector3_normalise(frame[0]);
    vector3_cross(frame[1], frame[2], frame[0]);
}

static uint32_t put(pieces *p, double x, double y, double z)
{
    double at[3];
    vector3_add(at, origin, x, frame[0]);
    vector3_add(at, at, y, frame[1]);
    vector3_add(at, at, z, frame[2]);
    assert_true(p->position_count < CORNERS_MOST);
    p->positions[p->position_count] = (vec3){(float)at[0], (float)at[1], (float)at[2]};
    return p->position_count++;
}

static void face(pieces *p, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t all[3] = {a, b, c};
    memcpy(p->corners + p->corner_count, all, sizeof all);
    p->corner_count += 3;
}

static uint32_t ring(pieces *p, double radius, double z, int count, double turn)
{
    uint32_t first = p->position_count;
    for (int i = 0; i < count; i++)
        put(p, radius * cos(turn + 2 * stroke_pi * i / count), radius * sin(turn + 2 * stroke_pi * i / count), z);
    return first;
}

/* Between two rings, which may have different numbers of corners; `inward`: seen from their middle. */
static void sew(pieces *p, uint32_t low, int low_count, uint32_t high, int high_count, bool inward)
{
    for (int i = 0, k = 0; i < low_count || k < high_count;) {
        bool     below = (double)(i + 1) / low_count <= (double)(k + 1) / high_count;
        uint32_t a = low + (uint32_t)(i % low_count), b = high + (uint32_t)(k % high_count);
        uint32_t c = below ? low + (uint32_t)((i + 1) % low_count) : high + (uint32_t)((k + 1) % high_count);
        i += below;
        k += !below;
        inward ? face(p, a, b, c) : face(p, a, c, b);
    }
}

/* Closes a ring with a fan around its first corner. */
static void close_ring(pieces *p, uint32_t first, int count, bool up)
{
    for (int i = 1; i + 1 < count; i++)
        up ? face(p, first, first + (uint32_t)i, first + (uint32_t)i + 1)
           : face(p, first, first + (uint32_t)i + 1, first + (uint32_t)i);
}

static void add_pieces(lmn_scene *s, const pieces *p)
{
    add_part(s, p->positions, p->position_count, p->corners, p->corner_count);
}

static void add_drum(lmn_scene *s, double radius, double height, int below, int above)
{
    pieces  *p = mem_calloc(1, sizeof *p);
    uint32_t a = ring(p, radius, 0, below, 0), b = ring(p, radius, height, above, 0);
    sew(p, a, below, b, above, false);
    close_ring(p, a, below, false);
    close_ring(p, b, above, true);
    add_pieces(s, p);
    mem_free(p);
}

/* A convex outline drawn out along the axis. */
static void add_bar(lmn_scene *s, const double (*outline)[2], int count, double height)
{
    pieces *p = mem_calloc(1, sizeof *p);
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < count; i++)
            put(p, outline[i][0], outline[i][1], k * height);
    sew(p, 0, count, (uint32_t)count, count, false);
    close_ring(p, 0, count, false);
    close_ring(p, (uint32_t)count, count, true);
    add_pieces(s, p);
    mem_free(p);
}

/* Takes the scene. */
static draft_cylinders find(lmn_scene *s)
{
    draft_cylinders out;
    stroke_scene    scene;
    pose            at_rest;
    lmn_error       error = {0};
    if (!s->part_count)
        assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(&scene, &at_rest, NULL, 30 * stroke_pi / 180, NULL, NULL, &error), LMN_OK);
    assert_int_equal(draft_cylinders_find(&out, &scene, &error), LMN_OK);
    stroke_scene_release(&scene);
    pose_release(&at_rest);
    scene_free(s);
    return out;
}

/* How far a cylinder's axis is from another one, in radii, over its whole length. */
static double axis_error(const draft_cylinder *c, const double at[3], const double axis[3])
{
    double most = 0;
    for (int k = 0; k < 2; k++) {
        double d[3];
        vector3_add(d, c->ends[k], -1, at);
        vector3_add(d, d, -vector3_dot(d, axis), axis);
        most = fmax(most, vector3_length(d) / c->radius);
    }
    return most;
}

static void assert_drum(const draft_cylinder *c, double radius, double low, double high, bool hollow)
{
    double error = axis_error(c, origin, frame[2]), ends[2];
    for (int k = 0; k < 2; k++) {
        double d[3];
        vector3_add(d, c->ends[k], -1, origin);
        ends[k] = vector3_dot(d, frame[2]);
    }
    print_message("radius %.6f (%g), axis off by %.1e radii, %.4f to %.4f, sweep %.3f\n", c->radius, radius, error,
                  ends[0], ends[1], c->sweep);
    assert_true(error < 1e-3 && fabs(c->radius - radius) < 1e-3 * radius && c->hollow == hollow);
    assert_true(fabs(fmin(ends[0], ends[1]) - low) < 1e-3 * radius &&
                fabs(fmax(ends[0], ends[1]) - high) < 1e-3 * radius);
    assert_true(c->sweep > 6.27);
}

static void test_drums(void **state)
{
    static const struct {
        double radius, height;
        int    below, above;
    } drums[] = {{5, 20, 24, 24}, {5, 20, 9 + 7, 16}, {40, 2, 64, 64},
                 {3, 12, 20, 31}, {10, 2, 24, 37},    {0.01, 0.05, 256, 256}};
    (void)state;
    for (size_t i = 0; i < sizeof drums / sizeof *drums; i++) {
        lmn_scene *s = stroke_scene_begin();
        add_drum(s, drums[i].radius, drums[i].height, drums[i].below, drums[i].above);
        draft_cylinders found = find(s);
        assert_int_equal(found.count, 1);
        assert_drum(&found.items[0], drums[i].radius, 0, drums[i].height, false);
        draft_cylinders_release(&found);
    }
}

/* A stepped sleeve: two cylinders outside, a bore through both, roundings between. */
static void test_sleeve(void **state)
{
    enum { N = 48, STEPS = 6 };
    lmn_scene *s = stroke_scene_begin();
    pieces    *p = mem_calloc(1, sizeof *p);
    uint32_t   rings[4 + STEPS], count = 0;
    (void)state;
    rings[count++] = ring(p, 12, 0, N, 0);
    rings[count++] = ring(p, 12, 10, N, 0);
    rings[count++] = ring(p, 9, 10, N, 0); /* a hollow rounding of 1 into the thinner one */
    for (int i = 1; i <= STEPS; i++) {
        double angle = stroke_pi / 2 * i / STEPS;
        rings[count++] = ring(p, 9 - sin(angle), 11 - cos(angle), N, 0);
    }
    rings[count++] = ring(p, 8, 25, N, 0);
    for (uint32_t i = 0; i + 1 < count; i++)
        sew(p, rings[i], N, rings[i + 1], N, false);
    uint32_t inner[2] = {ring(p, 5, 0, N, 0), ring(p, 5, 25, N, 0)};
    sew(p, inner[0], N, inner[1], N, true);
    sew(p, rings[0], N, inner[0], N, true);
    sew(p, rings[count - 1], N, inner[1], N, false);
    add_pieces(s, p);
    mem_free(p);
    draft_cylinders found = find(s);
    assert_int_equal(found.count, 3);
    for (size_t i = 0; i < found.count; i++) {
        const draft_cylinder *c = &found.items[i];
        if (c->hollow)
            assert_drum(c, 5, 0, 25, true);
        else if (c->radius > 10)
            assert_drum(c, 12, 0, 10, false);
        else
            assert_drum(c, 8, 11, 25, false);
    }
    draft_cylinders_release(&found);
}

static void assert_none(const char *what, lmn_scene *s)
{
    draft_cylinders found = find(s);
    if (found.count)
        fail_msg("%s: %zu cylinders, the first of radius %g", what, found.count, found.items[0].radius);
    draft_cylinders_release(&found);
}

static int round_corner(double (*out)[2], int at, double x, double y, double radius, double from, double to, int steps)
{
    for (int i = 0; i <= steps; i++, at++) {
        double angle = (from + (to - from) * i / steps) * stroke_pi / 180;
        out[at][0] = x + radius * cos(angle);
        out[at][1] = y + radius * sin(angle);
    }
    return at;
}

static void test_none(void **state)
{
    double     outline[200][2];
    int        count;
    lmn_scene *s;
    (void)state;
    s = stroke_scene_begin();
    add_box(s, 0, 0, 0, 3, 4, 5);
    assert_none("a box", s);
    for (int sides = 3; sides <= 8; sides++) {
        s = stroke_scene_begin();
        add_drum(s, 5, 10, sides, sides);
        assert_none("a prism", s);
    }
    const double chamfered[8][2] = {{-9, -10}, {9, -10}, {10, -9}, {10, 9}, {9, 10}, {-9, 10}, {-10, 9}, {-10, -9}};
    s = stroke_scene_begin();
    add_bar(s, chamfered, 8, 6);
    assert_none("chamfers", s);
    s = stroke_scene_begin();
    count = round_corner(outline, 0, 0, 0, 8, -90, 90, 16);
    add_bar(s, (const double(*)[2])outline, count, 10);
    assert_none("half a round", s);
    s = stroke_scene_begin();
    count = round_corner(outline, 0, 10, 0, 4, -90, 90, 16);
    count = round_corner(outline, count, -10, 0, 4, 90, 270, 16);
    add_bar(s, (const double(*)[2])outline, count, 10);
    assert_none("a feather key", s);
    s = stroke_scene_begin();
    count = 0;
    for (int i = 0; i < 4; i++)
        count = round_corner(outline, count, (i == 0 || i == 3) ? 9 : -9, i < 2 ? 6 : -6, 2, 90 * i, 90 * i + 90, 8);
    add_bar(s, (const double(*)[2])outline, count, 10);
    assert_none("rounded corners", s);
    for (uint32_t rings = 7; rings < 34; rings += 4) {
        s = stroke_scene_begin();
        add_ball(s, 1, 2, 3, 6, 32, rings);
        assert_none("a ball", s);
    }
    s = stroke_scene_begin();
    count = 0;
    for (int i = 0; i < 40; i++, count++) { /* an ellipse */
        outline[i][0] = 10 * cos(2 * stroke_pi * i / 40);
        outline[i][1] = 9 * sin(2 * stroke_pi * i / 40);
    }
    add_bar(s, (const double(*)[2])outline, count, 10);
    assert_none("an oval bar", s);
}

static double seconds_for_ball(uint32_t columns)
{
    double least = INFINITY;
    for (int turn = 0; turn < 2; turn++) {
        lmn_scene      *s = stroke_scene_begin();
        struct timespec from, to;
        add_ball(s, 1, 2, 3, 6, columns, columns / 2);
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &from);
        assert_none("a ball", s);
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &to);
        least = fmin(least, (double)(to.tv_sec - from.tv_sec) + (double)(to.tv_nsec - from.tv_nsec) * 1e-9);
    }
    return least;
}

/* A wide band of a ball lies on any cylinder around it, as far as the first growth asks; four times the faces must not
 * cost sixteen times as much. */
static void test_growth(void **state)
{
    (void)state;
    double few = seconds_for_ball(48), many = seconds_for_ball(96);
    printf("a ball of 48 columns %.3f s, of 96 %.3f s\n", few, many);
    assert_true(many < 8 * few);
}

/* --- cones ---------------------------------------------------------------------------------------------- */

/* A body turned around the axis: radii and heights from ring to ring; radius 0: a tip. */
static void add_turned(lmn_scene *s, const double (*profile)[2], int count, int sides, double oval)
{
    pieces  *p = mem_calloc(1, sizeof *p);
    uint32_t rings[64];
    int      sizes[64];
    for (int i = 0; i < count; i++) {
        sizes[i] = profile[i][0] > 0 ? sides : 1;
        rings[i] = p->position_count;
        for (int k = 0; k < sizes[i]; k++)
            put(p, profile[i][0] * cos(2 * stroke_pi * k / sides),
                oval * profile[i][0] * sin(2 * stroke_pi * k / sides), profile[i][1]);
    }
    for (int i = 0; i + 1 < count; i++)
        for (int k = 0; k < sides; k++) {
            uint32_t a = rings[i] + (uint32_t)(k % sizes[i]), b = rings[i] + (uint32_t)((k + 1) % sizes[i]),
                     c = rings[i + 1] + (uint32_t)(k % sizes[i + 1]),
                     d = rings[i + 1] + (uint32_t)((k + 1) % sizes[i + 1]);
            if (a != b)
                face(p, a, b, d);
            if (c != d)
                face(p, a, d, c);
        }
    if (sizes[0] > 1)
        close_ring(p, rings[0], sides, false);
    if (sizes[count - 1] > 1)
        close_ring(p, rings[count - 1], sides, true);
    add_pieces(s, p);
    mem_free(p);
}

static void assert_cone(const draft_cylinder *c, double low_radius, double low, double high_radius, double high)
{
    double error = axis_error(c, origin, frame[2]), ends[2];
    for (int k = 0; k < 2; k++) {
        double d[3];
        vector3_add(d, c->ends[k], -1, origin);
        ends[k] = vector3_dot(d, frame[2]);
    }
    int first = ends[0] < ends[1] ? 0 : 1;
    print_message("radii %.5f %.5f, axis off by %.1e radii, %.4f to %.4f, sweep %.3f\n", c->radii[first],
                  c->radii[1 - first], error, ends[first], ends[1 - first], c->sweep);
    double size = fmax(low_radius, high_radius);
    assert_true(c->cone && error < 1e-3 && fabs(c->radius - size) < 1e-3 * size);
    assert_true(fabs(c->radii[first] - low_radius) < 2e-3 * size &&
                fabs(c->radii[1 - first] - high_radius) < 2e-3 * size);
    assert_true(fabs(ends[first] - low) < 2e-3 * size && fabs(ends[1 - first] - high) < 2e-3 * size);
    assert_true(c->sweep > 6.27);
}

static void test_cones(void **state)
{
    static const struct {
        double low, high, height;
        int    sides;
    } cones[] = {{6, 5.5, 10, 40}, {6, 0, 9, 24},          {10, 4, 3, 64},    {2, 9, 20, 16},
                 {8, 2, 2, 200},   {0.03, 0.01, 0.05, 32}, {20, 18, 60, 360}, {6, 0, 30, 12}};
    (void)state;
    for (size_t i = 0; i < sizeof cones / sizeof *cones; i++) {
        const double profile[2][2] = {{cones[i].low, 0}, {cones[i].high, cones[i].height}};
        lmn_scene   *s = stroke_scene_begin();
        add_turned(s, profile, 2, cones[i].sides, 1);
        draft_cylinders found = find(s);
        assert_int_equal(found.count, 1);
        assert_cone(&found.items[0], cones[i].low, 0, cones[i].high, cones[i].height);
        draft_cylinders_release(&found);
    }
}

/* A spindle: a point of 60 degrees, a shaft, a taper that goes on smoothly from it, a chamfer of 45 degrees. */
static void test_spindle(void **state)
{
    const double    profile[][2] = {{0, -5}, {5 * 0.57735, 0}, {5, 0}, {5, 20}, {8, 40}, {7, 41}};
    lmn_scene      *s = stroke_scene_begin();
    draft_cylinders found;
    size_t          cones = 0;
    (void)state;
    add_turned(s, profile, 6, 48, 1);
    found = find(s);
    assert_int_equal(found.count, 4);
    for (size_t i = 0; i < found.count; i++) {
        const draft_cylinder *c = &found.items[i];
        cones += c->cone;
        if (!c->cone)
            assert_drum(c, 5, 0, 20, false);
        else if (c->radius < 3)
            assert_cone(c, 0, -5, 5 * 0.57735, 0);
        else if (fabs(c->radii[0] - 5) < 0.1 || fabs(c->radii[1] - 5) < 0.1)
            assert_cone(c, 5, 20, 8, 40);
        else
            assert_cone(c, 8, 40, 7, 41);
    }
    assert_int_equal(cones, 3);
    draft_cylinders_release(&found);
}

/* Domes, vases, lenses, tapers that are oval or have sides, springs and screws: whatever is no cone. */
static void test_no_cones(void **state)
{
    double     profile[64][2];
    lmn_scene *s;
    (void)state;
    for (int sides = 3; sides <= 8; sides++) {
        const double taper[2][2] = {{5, 0}, {3, 10}};
        s = stroke_scene_begin();
        add_turned(s, taper, 2, sides, 1);
        assert_none("a pyramid", s);
    }
    const double taper[2][2] = {{6, 0}, {4, 12}};
    s = stroke_scene_begin();
    add_turned(s, taper, 2, 48, 0.85);
    assert_none("an oval taper", s);
    for (int rings = 5; rings < 30; rings += 3) {
        for (int i = 0; i <= rings; i++) {
            profile[i][0] = i == rings ? 0 : 7 * cos(stroke_pi / 2 * i / rings);
            profile[i][1] = 7 * sin(stroke_pi / 2 * i / rings);
        }
        s = stroke_scene_begin();
        add_turned(s, (const double(*)[2])profile, rings + 1, 48, 1);
        assert_none("a dome", s);
        if (rings < 11) /* coarser ones have edges that are drawn around them, and are stacks of cones */
            continue;
        for (int i = 0; i <= rings; i++)
            profile[i][1] *= 0.3;
        s = stroke_scene_begin();
        add_turned(s, (const double(*)[2])profile, rings + 1, 48, 1);
        assert_none("a lens", s);
    }
    for (int i = 0; i <= 30; i++) {
        profile[i][0] = 5 + 1.5 * sin(i * 0.4);
        profile[i][1] = i;
    }
    s = stroke_scene_begin();
    add_turned(s, (const double(*)[2])profile, 31, 48, 1);
    assert_none("a vase", s);
    pieces *p = mem_calloc(1, sizeof *p);
    for (int i = 0; i < 240; i++) /* a spring: a tube of 8 sides along a helix of 5 turns */
        for (int k = 0; k < 8; k++) {
            double around = 2 * stroke_pi * i / 48, across = 2 * stroke_pi * k / 8, radius = 10 + 1.5 * cos(across);
            put(p, radius * cos(around), radius * sin(around), i / 48.0 * 6 + 1.5 * sin(across));
        }
    for (uint32_t i = 0; i + 1 < 240; i++)
        for (uint32_t k = 0; k < 8; k++) {
            uint32_t a = 8 * i + k, b = 8 * i + (k + 1) % 8;
            face(p, a, a + 8, b);
            face(p, b, a + 8, b + 8);
        }
    s = stroke_scene_begin();
    add_pieces(s, p);
    memset(p, 0, sizeof *p);
    assert_none("a spring", s);
    for (int i = 0; i < 240; i++) /* a screw: crest and root run up together */
        for (int k = 0; k < 2; k++) {
            double around = 2 * stroke_pi * i / 48;
            put(p, (k ? 6 : 5) * cos(around), (k ? 6 : 5) * sin(around), i / 48.0 * 2 + k);
        }
    for (uint32_t i = 0; i + 1 < 240; i++) {
        face(p, 2 * i, 2 * i + 2, 2 * i + 1);
        face(p, 2 * i + 1, 2 * i + 2, 2 * i + 3);
        if (i + 48 + 1 < 240) {
            face(p, 2 * i + 1, 2 * i + 3, 2 * (i + 48));
            face(p, 2 * i + 3, 2 * (i + 49), 2 * (i + 48));
        }
    }
    s = stroke_scene_begin();
    add_pieces(s, p);
    mem_free(p);
    assert_none("a screw", s);
}

static void add_ring_body(lmn_scene *s, int columns, int rings)
{
    pieces *p = mem_calloc(1, sizeof *p);
    for (int r = 0; r < rings; r++) /* half a step turned: rings lie beside the middle of the outside */
        ring(p, 10 + 3 * cos(2 * stroke_pi * (r + 0.5) / rings), 3 * sin(2 * stroke_pi * (r + 0.5) / rings), columns,
             0);
    for (int r = 0; r < rings; r++)
        sew(p, (uint32_t)(r * columns), columns, (uint32_t)((r + 1) % rings * columns), columns, false);
    add_pieces(s, p);
    mem_free(p);
}

static void test_torus(void **state)
{
    (void)state;
    for (int rings = 13; rings < 40; rings += 3) { /* fewer turn so far that their edges are drawn */
        lmn_scene *s = stroke_scene_begin();
        add_ring_body(s, 48, rings);
        assert_none("a torus", s);
    }
}

/* --- files ---------------------------------------------------------------------------------------------- */

static draft_cylinders find_in_file(const char *path)
{
    return find(load_or_fail(path));
}

static draft_cylinders find_in_text(const char *name, const char *text)
{
    return find_in_file(temp_file(name, text, strlen(text)));
}

static const draft_cylinder *cylinder_at(const draft_cylinders *all, double x, double y, double z, double radius,
                                         bool hollow, const double axis[3])
{
    const double at[3] = {x, y, z};
    for (size_t i = 0; i < all->count; i++)
        if (fabs(all->items[i].radius - radius) < 1e-3 * radius && all->items[i].hollow == hollow &&
            axis_error(&all->items[i], at, axis) < 1e-3)
            return &all->items[i];
    fail_msg("no cylinder of radius %g at %g, %g, %g", radius, x, y, z);
    return NULL;
}

/* Of a solid there is what bounds it: bores as deep as they are, no operand inside another, no half of a rounding. */
static void test_solid(void **state)
{
    static const double up[3] = {0, 0, 1}, across[3] = {1, 0, 0};
    draft_cylinders     found = find_in_text(
            "plate.csg",
            "difference() {\n"
                " union() { cube(size=[60,40,10], center=false);\n"
                "  multmatrix([[1,0,0,30],[0,1,0,20],[0,0,1,0],[0,0,0,1]]) { cylinder($fn=64, h=30, r1=12, r2=12); }\n"
                "  multmatrix([[1,0,0,10],[0,1,0,20],[0,0,1,2],[0,0,0,1]]) { cylinder($fn=32, h=4, r1=3, r2=3); }\n"
                "  multmatrix([[1,0,0,60],[0,1,0,20],[0,0,1,0],[0,0,0,1]]) { cylinder($fn=48, h=10, r1=20, r2=20); } }\n"
                " multmatrix([[1,0,0,30],[0,1,0,20],[0,0,1,-1],[0,0,0,1]]) { cylinder($fn=48, h=40, r1=7, r2=7); }\n"
                " multmatrix([[1,0,0,8],[0,1,0,8],[0,0,1,4],[0,0,0,1]]) { cylinder($fn=32, h=40, r1=2.5, r2=2.5); }\n"
                " multmatrix([[0,0,1,-5],[0,1,0,20],[-1,0,0,22],[0,0,0,1]]) { cylinder($fn=32, h=100, r1=3, r2=3); }\n"
                "}\n");
    (void)state;
    for (size_t i = 0; i < found.count; i++)
        print_message("radius %g hollow %d sweep %.2f at %g %g %g\n", found.items[i].radius, found.items[i].hollow,
                      found.items[i].sweep, found.items[i].ends[0][0], found.items[i].ends[0][1],
                      found.items[i].ends[0][2]);
    assert_int_equal(found.count, 4);
    const draft_cylinder *c = cylinder_at(&found, 30, 20, 0, 12, false, up);
    assert_true(fabs(fmin(c->ends[0][2], c->ends[1][2]) - 10) < 1e-3 &&
                fabs(fmax(c->ends[0][2], c->ends[1][2]) - 30) < 1e-3);
    c = cylinder_at(&found, 30, 20, 0, 7, true, up);
    assert_true(fabs(c->ends[0][2] - c->ends[1][2]) > 29.99 && fabs(c->ends[0][2] - c->ends[1][2]) < 30.01);
    c = cylinder_at(&found, 8, 8, 0, 2.5, true, up);
    assert_true(fabs(fabs(c->ends[0][2] - c->ends[1][2]) - 6) < 1e-3);
    c = cylinder_at(&found, 0, 20, 22, 3, true, across); /* through both walls of the sleeve */
    assert_true(fabs(c->ends[0][0] - c->ends[1][0]) > 23 && fabs(c->ends[0][0] - c->ends[1][0]) < 24.01);
    draft_cylinders_release(&found);
}

#ifdef LIMNER_HAVE_STEP
/* The numbers of an entity of a STEP file: what stands behind "#12 = ". */
static const char *entity_of(const char *text, unsigned number)
{
    char name[32];
    snprintf(name, sizeof name, "\n#%u = ", number);
    const char *at = strstr(text, name);
    assert_non_null(at);
    return at + strlen(name);
}

/* What the file itself says of its bore; its other cylinder is the rounding of a corner. */
static void test_step(void **state)
{
    file_data   file;
    lmn_error   error = {0};
    const char *path = LIMNER_SOURCE_DIR "/examples/bracket.step";
    (void)state;
    assert_int_equal(file_load(&file, path, &error), LMN_OK);
    const char     *text = (const char *)file.data, *at;
    draft_cylinders found = find_in_file(path);
    size_t          whole = 0;
    for (at = strstr(text, "CYLINDRICAL_SURFACE"); at; at = strstr(at + 1, "CYLINDRICAL_SURFACE")) {
        unsigned placement, point, axis;
        double   radius, p[3], a[3];
        assert_int_equal(sscanf(at, "CYLINDRICAL_SURFACE('',#%u,%lf", &placement, &radius), 2);
        assert_int_equal(sscanf(entity_of(text, placement), "AXIS2_PLACEMENT_3D('',#%u,#%u", &point, &axis), 2);
        assert_int_equal(sscanf(entity_of(text, point), "CARTESIAN_POINT('',(%lf,%lf,%lf", &p[0], &p[1], &p[2]), 3);
        assert_int_equal(sscanf(entity_of(text, axis), "DIRECTION('',(%lf,%lf,%lf", &a[0], &a[1], &a[2]), 3);
        for (size_t i = 0; i < found.count; i++)
            if (fabs(found.items[i].radius - radius) < 1e-3 * radius) {
                double off = axis_error(&found.items[i], p, a);
                print_message("radius %g: axis off by %.1e radii\n", radius, off);
                assert_true(off < 1e-3);
                whole++;
            }
    }
    assert_int_equal(found.count, 1);
    assert_int_equal(whole, 1);
    draft_cylinders_release(&found);
    file_data_release(&file);
}
#endif

/* --- pitch circles -------------------------------------------------------------------------------------- */

static draft_pitches pitches_of(draft_cylinders *found)
{
    draft_pitches out;
    lmn_error     error = {0};
    assert_int_equal(draft_pitches_find(&out, found, &error), LMN_OK);
    return out;
}

static void add_bore(draft_cylinders *all, double x, double y, double radius)
{
    draft_cylinder c = {.radius = radius, .sweep = 2 * stroke_pi, .hollow = true, .part = 1};
    assert_true(mem_grow((void **)&all->items, &all->capacity, all->count + 1, sizeof *all->items));
    vector3_copy(c.axis, frame[2]);
    for (int k = 0; k < 2; k++) {
        vector3_add(c.ends[k], origin, x, frame[0]);
        vector3_add(c.ends[k], c.ends[k], y, frame[1]);
        vector3_add(c.ends[k], c.ends[k], 10 * k, frame[2]);
    }
    all->items[all->count++] = c;
}

static void add_bores(draft_cylinders *all, double x, double y, double around, int count, int of, double radius)
{
    for (int i = 0; i < count; i++)
        add_bore(all, x + around * cos(0.3 + 2 * stroke_pi * i / of), y + around * sin(0.3 + 2 * stroke_pi * i / of),
                 radius);
}

static void check_pitches(draft_cylinders *all, const double (*wanted)[4], size_t count)
{
    draft_pitches p = pitches_of(all);
    if (p.count != count)
        fail_msg("%zu circles instead of %zu", p.count, count);
    for (size_t i = 0; i < count; i++) {
        double centre[3], off;
        vector3_add(centre, p.items[i].centre, -1, origin);
        off = hypot(vector3_dot(centre, frame[0]) - wanted[i][0], vector3_dot(centre, frame[1]) - wanted[i][1]);
        assert_true(off < 1e-9 && fabs(p.items[i].radius - wanted[i][2]) < 1e-9);
        assert_int_equal(p.items[i].count, (size_t)wanted[i][3]);
    }
    draft_pitches_release(&p);
    draft_cylinders_release(all);
}

static void test_pitch(void **state)
{
    draft_cylinders all = {NULL, 0, 0};
    (void)state;
    add_bores(&all, 4, 5, 30, 6, 6, 3); /* without anything in the middle */
    check_pitches(&all, (const double[][4]){{4, 5, 30, 6}}, 1);
    add_bores(&all, 4, 5, 30, 3, 3, 3);
    add_bore(&all, 4, 5, 9);
    check_pitches(&all, (const double[][4]){{4, 5, 30, 3}}, 1);
    add_bores(&all, 0, 0, 30, 8, 8, 3); /* two circles of one size of bores, and a stray one */
    add_bores(&all, 90, 0, 20, 5, 5, 3);
    add_bore(&all, 40, 40, 3);
    check_pitches(&all, (const double[][4]){{0, 0, 30, 8}, {90, 0, 20, 5}}, 2);
    add_bores(&all, 0, 0, 25, 4, 6, 3); /* four of six, around a bore */
    add_bore(&all, 0, 0, 8);
    check_pitches(&all, (const double[][4]){{0, 0, 25, 4}}, 1);
    for (int i = 0; i < 4; i++) /* corners of a plate */
        add_bore(&all, i & 1 ? 40 : -40, i & 2 ? 25 : -25, 3);
    add_bore(&all, 0, 0, 8);
    check_pitches(&all, NULL, 0);
    for (int i = 0; i < 4; i++)
        add_bore(&all, i & 1 ? 40 : -40, i & 2 ? 40 : -40, 3);
    check_pitches(&all, NULL, 0);
    for (int i = 0; i < 12; i++) /* a grid */
        add_bore(&all, 10 * (i % 4), 10 * (i / 4), 2);
    check_pitches(&all, NULL, 0);
    add_bores(&all, 4, 5, 30, 6, 6, 3);
    all.items[3].radius = 3.1; /* another one */
    check_pitches(&all, NULL, 0);
}

/* The pump's bolts lie at three of six places around each shaft, in four parts; as examples/make_pump.c has it. */
static void test_pump(void **state)
{
    draft_cylinders found = find_in_file(LIMNER_SOURCE_DIR "/examples/pump.glb");
    draft_pitches   p = pitches_of(&found);
    size_t          bolts = 0, bores = 0;
    (void)state;
    assert_int_equal(p.count, 8);
    for (size_t i = 0; i < p.count; i++) {
        assert_true(fabs(p.items[i].radius - 0.029) < 1e-6 && fabs(p.items[i].centre[0]) < 1e-6);
        assert_true(fabs(fabs(p.items[i].centre[1]) - 0.0195) < 1e-6);
        assert_true(p.items[i].count == 3 && p.items[i].steps == 6);
    }
    for (size_t i = 0; i < found.count; i++) {
        const draft_cylinder *c = &found.items[i];
        double                turn = atan2(fabs(c->ends[0][1]) - 0.0195, c->ends[0][0]) * 180 / stroke_pi;
        bolts += !c->hollow && !c->cone && fabs(c->radius - 0.003) < 1e-6 && fabs(remainder(turn - 30, 60)) < 0.01;
        bores += c->hollow && !c->cone && fabs(c->radius - 0.0045) < 1e-6 && fabs(fabs(c->ends[0][0]) - 0.046) < 1e-6;
    }
    assert_int_equal(bolts, 6);
    assert_int_equal(bores, 4);
    draft_pitches_release(&p);
    draft_cylinders_release(&found);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_drums),    cmocka_unit_test(test_sleeve), cmocka_unit_test(test_none),
        cmocka_unit_test(test_torus),    cmocka_unit_test(test_cones),  cmocka_unit_test(test_spindle),
        cmocka_unit_test(test_no_cones), cmocka_unit_test(test_solid),  cmocka_unit_test(test_pitch),
        cmocka_unit_test(test_pump),     cmocka_unit_test(test_growth),
#ifdef LIMNER_HAVE_STEP
        cmocka_unit_test(test_step),
#endif
    };
    lean();
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
