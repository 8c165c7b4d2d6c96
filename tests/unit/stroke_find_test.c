/* Which lines are found, what hides them, and how they are chained, against bodies whose answers are known and
 * against rays. */
#include "stroke_shapes.h"

static const double origin[3] = {0, 0, 0};

static stroke_options all_lines(void)
{
    stroke_options w = STROKE_OPTIONS_INIT;
    w.hidden = 1;
    w.crowd = 0;
    return w;
}

/* A cube of side 2, seen along a space diagonal: its outline is a regular hexagon of side 2·√(2/3). */
static void cube_has_six_nine_twelve(void **state)
{
    (void)state;
    for (int perspective = 0; perspective < 2; perspective++) {
        lmn_scene *s = stroke_scene_begin();
        add_box(s, -1, -1, -1, 1, 1, 1);
        stroke_camera c = look_along(-1, -1.1, -0.9, origin, 20, perspective ? 0.1 : 2, !perspective, 400, 400);
        stroke_shot   shot = shoot(s, c, all_lines());
        assert_int_equal(count_strokes(&shot.set, STROKE_CONTOUR, 0, NULL), 1);
        assert_true(shot.set.strokes[0].closed);
        assert_int_equal(shot.set.strokes[0].count, 7);
        assert_int_equal(count_strokes(&shot.set, STROKE_CREASE, 0, NULL), 3);
        assert_int_equal(count_strokes(&shot.set, STROKE_CREASE, 1, NULL), 3);
        assert_int_equal(shot.set.stroke_count, 7);
        assert_int_equal(shot.check.wrong + shot.check.miscounted, 0);
        shot_release(&shot);
    }
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    stroke_shot shot = shoot(s, look_along(-1, -1, -1, origin, 20, 2, true, 400, 400), all_lines());
    double      length;
    count_strokes(&shot.set, STROKE_CONTOUR, 0, &length);
    assert_true(fabs(length - 6 * 2 * sqrt(2.0 / 3) * 100) < 0.1);
    shot_release(&shot);
}

/* A square plate with a round hole through it, along z. */
static void add_bored_plate(lmn_scene *s, double radius)
{
    enum { SIDES = 32, RINGS = 4 };
    vec3     positions[SIDES * RINGS];
    uint32_t corners[SIDES * RINGS * 6], count = 0;
    for (uint32_t k = 0; k < SIDES; k++) {
        double c = cos(2 * stroke_pi * k / SIDES), d = sin(2 * stroke_pi * k / SIDES), out = 2 / fmax(fabs(c), fabs(d));
        for (uint32_t ring = 0; ring < RINGS; ring++) { /* outside below and above, inside above and below */
            double far = ring < 2 ? out : radius;
            positions[ring * SIDES + k] = (vec3){(float)(far * c), (float)(far * d), ring == 1 || ring == 2 ? 1 : 0};
        }
    }
    for (uint32_t ring = 0; ring < RINGS; ring++)
        for (uint32_t k = 0; k < SIDES; k++) {
            uint32_t a = ring * SIDES + k, b = ring * SIDES + (k + 1) % SIDES, up = (ring + 1) % RINGS * SIDES;
            uint32_t quad[6] = {a, b, up + b % SIDES, a, up + b % SIDES, up + a % SIDES};
            memcpy(corners + count, quad, sizeof quad);
            count += 6;
        }
    add_part(s, positions, SIDES * RINGS, corners, count);
}

/* Seen from the side and a little from above, both sides of the bore are hidden lines from face to face, and hang
 * together along its far rim below. */
static void bores_have_hidden_sides(void **state)
{
    (void)state;
    for (int hidden = 0; hidden < 2; hidden++) {
        lmn_scene     *s = stroke_scene_begin();
        stroke_options w = all_lines();
        double         length;
        w.hidden = hidden != 0;
        add_bored_plate(s, 0.75);
        stroke_shot shot = shoot(s, look_along(0.001, 1, 0.002, origin, 20, 4, true, 400, 400), w);
        assert_int_equal(count_strokes(&shot.set, STROKE_CONTOUR, 1, &length), hidden);
        assert_true(!hidden || fabs(length - (50 + 75 + 50)) < 1);
        assert_true(count_strokes(&shot.set, STROKE_CONTOUR, 0, NULL) > 0);
        assert_int_equal(shot.check.wrong, 0);
        shot_release(&shot);
    }
}

/* A rod below k plates: each stretch has as many surfaces in front as there are plates over it. */
static void plates_are_counted(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -8, -0.1, -1, 8, 0.1, -0.8);
    for (int k = 0; k < 5; k++)
        add_plate(s, -5 + k, -3, 5, 3, k);
    stroke_options w = all_lines();
    stroke_shot    shot = shoot(s, look_along(0, 0, -1, origin, 40, 10, true, 1000, 1000), w);
    /* The rod's upper edges lie above its lower ones exactly; they are its outline. 50 px a unit. */
    double wanted[6] = {3 + 3, 1, 1, 1, 1, 6};
    for (int k = 0; k < 6; k++) {
        double length;
        bool   found = false;
        for (size_t i = 0; i < shot.set.stroke_count; i++) {
            const stroke       *t = &shot.set.strokes[i];
            const stroke_point *p = &shot.set.points[t->first], *q = p + t->count - 1;
            if (t->part != 1 || t->hidden_by != (uint32_t)k || fabs((double)p->y - q->y) > 1e-3)
                continue;
            length = fabs((double)q->x - p->x) / 50;
            found = found || fabs(length - (k == 0 ? 3 : wanted[k])) < 0.002;
        }
        assert_true(found);
    }
    assert_int_equal(shot.check.wrong, 0);
    shot_release(&shot);
}

/* A plate over a far line, in perspective: it is hidden between the plate's rims as central projection has them. */
static void rims_hide_where_they_are(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_plate(s, -1, -1, 1, 1, 0);
    add_box(s, -6, -0.5, -4, 6, 0.5, -3.99);
    stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 8, 0.8, false, 1000, 1000), all_lines());
    double      half = 1.0 / 8 / 0.8 * 500; /* of the plate on the page: 78.125 px */
    double      depth = 8 + 3.99, edge = 0.5 / depth / 0.8 * 500;
    size_t      found = 0;
    for (size_t i = 0; i < shot.set.stroke_count; i++) {
        const stroke       *t = &shot.set.strokes[i];
        const stroke_point *p = &shot.set.points[t->first], *q = p + t->count - 1;
        if (t->part != 2 || t->hidden_by != 1 || fabs(fabs(p->y - 500.0) - edge) > 0.05 ||
            fabs((double)p->y - q->y) > 0.01)
            continue;
        double low = fmin(p->x, q->x), high = fmax(p->x, q->x);
        found += fabs(low - (500 - half)) < 0.02 && fabs(high - (500 + half)) < 0.02;
    }
    assert_int_equal(found, 2);
    assert_int_equal(shot.check.wrong + shot.check.miscounted, 0);
    shot_release(&shot);
}

/* A vault over a rectangle, open, of so many cells. */
static void add_vault(lmn_scene *s, const double from[2], const double to[2], uint32_t columns, uint32_t rows, double z)
{
    vec3     *positions = mem_alloc((size_t)(columns + 1) * (rows + 1) * sizeof *positions);
    uint32_t *corners = mem_alloc((size_t)columns * rows * 6 * sizeof *corners), k = 0;
    for (uint32_t r = 0; r <= rows; r++)
        for (uint32_t c = 0; c <= columns; c++) {
            double x = from[0] + (to[0] - from[0]) * c / columns, y = from[1] + (to[1] - from[1]) * r / rows;
            positions[r * (columns + 1) + c] =
                (vec3){(float)x, (float)y, (float)(z + 0.5 * cos(x) + 0.3 * cos(1.3 * y))};
        }
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t c = 0; c < columns; c++) {
            uint32_t       a = r * (columns + 1) + c, up = columns + 1;
            const uint32_t quad[6] = {a, a + 1, a + up + 1, a, a + up + 1, a + up};
            memcpy(corners + k, quad, sizeof quad);
            k += 6;
        }
    add_part(s, positions, (columns + 1) * (rows + 1), corners, k);
    mem_free(positions);
    mem_free(corners);
}

/* A patch that lies on a vault, tessellated otherwise, is now in front and now behind: its rim is whole, and where the
 * two cross is no line. */
static void shells_that_coincide_are_one(void **state)
{
    static const double low[2] = {-1, -1}, high[2] = {1, 1}, from[2] = {-0.6, -0.7}, to[2] = {0.8, 0.5};
    static const double lifts[] = {0, 0.0003, -0.0003};
    (void)state;
    for (int k = 0; k < 3; k++) {
        lmn_scene *s = stroke_scene_begin();
        add_vault(s, low, high, 40, 33, 0);
        add_vault(s, from, to, 33, 27, lifts[k]);
        stroke_shot shot = shoot(s, look_along(0.1, 0.2, -1, origin, 20, 2, true, 900, 900), all_lines());
        double      crossing, visible, hidden;
        count_strokes(&shot.set, STROKE_INTERSECTION, -1, &crossing);
        count_strokes(&shot.set, STROKE_BORDER, 0, &visible);
        count_strokes(&shot.set, STROKE_BORDER, 1, &hidden);
        assert_true(crossing < 1);
        assert_true(visible > 2500 && hidden < 1);
        assert_int_equal(shot.check.wrong, 0);
        shot_release(&shot);
    }
}

/* Balls that are one, twice, have the outline of one. */
static void balls_that_coincide_are_one(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 60, 40);
    add_ball(s, 0, 0, 0, 1.0003, 53, 37);
    stroke_shot shot = shoot(s, look_along(0.3, 0.2, -1, origin, 20, 2, true, 900, 900), all_lines());
    double      crossing;
    count_strokes(&shot.set, STROKE_INTERSECTION, -1, &crossing);
    assert_true(crossing < 1);
    shot_release(&shot);
}

/* A pipe around an axis, in so many rings. */
static void add_pipe(lmn_scene *s, int axis, uint32_t rings)
{
    enum { AROUND = 48 };
    vec3     *positions = mem_alloc((size_t)(rings + 1) * AROUND * sizeof *positions);
    uint32_t *corners = mem_alloc((size_t)rings * AROUND * 6 * sizeof *corners), k = 0;
    for (uint32_t r = 0; r <= rings; r++)
        for (uint32_t i = 0; i < AROUND; i++) {
            double      turn = 2 * stroke_pi * (i + 0.37 * axis) / AROUND, along = -1.5 + 3.0 * r / rings;
            const float at[3] = {(float)along, (float)(0.5 * cos(turn)), (float)(0.5 * sin(turn))};
            positions[r * AROUND + i] = (vec3){at[(3 - axis) % 3], at[(4 - axis) % 3], at[(5 - axis) % 3]};
        }
    for (uint32_t r = 0; r < rings; r++)
        for (uint32_t i = 0; i < AROUND; i++) {
            uint32_t       a = r * AROUND + i, b = r * AROUND + (i + 1) % AROUND;
            const uint32_t quad[6] = {a, b, b + AROUND, a, b + AROUND, a + AROUND};
            memcpy(corners + k, quad, sizeof quad);
            k += 6;
        }
    add_part(s, positions, (rings + 1) * AROUND, corners, k);
    mem_free(positions);
    mem_free(corners);
}

/* Pipes of one width that cross touch in two places without an angle: their line goes on there. */
static void pipes_that_cross_have_whole_lines(void **state)
{
    (void)state;
    for (uint32_t rings = 1; rings <= 40; rings += 39) {
        lmn_scene *s = stroke_scene_begin();
        add_pipe(s, 0, rings);
        add_pipe(s, 1, rings);
        stroke_shot shot = shoot(s, look_along(0.5, 0.4, -1, origin, 20, 2, true, 900, 900), all_lines());
        double      length;
        size_t      count = count_strokes(&shot.set, STROKE_INTERSECTION, 0, &length);
        assert_in_range(count, 1, 8);
        assert_true(length > 400);
        shot_release(&shot);
    }
}

/* A plate of half a per cent keeps both of its rims, and hides what is below it. */
static void thin_plates_hide(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_vault(s, (const double[2]){-1, -1}, (const double[2]){1, 1}, 40, 33, 0);
    add_vault(s, (const double[2]){-0.5, -0.5}, (const double[2]){0.5, 0.5}, 33, 27, -0.015);
    stroke_shot shot = shoot(s, look_along(0.1, 0.2, -1, origin, 20, 2, true, 900, 900), all_lines());
    double      hidden;
    count_strokes(&shot.set, STROKE_BORDER, 1, &hidden);
    assert_true(hidden > 800);
    shot_release(&shot);
}

/* Two boxes that touch, or nearly do, lie on a third, one of whose sides ends right below the joint: it is hidden, from
 * whichever side it is looked at. Beside a joint that is open it is seen. */
static void joints_hide_what_lies_below(void **state)
{
    static const double gaps[] = {0, 1e-6, 3e-6, 2e-5, -1e-6, 0.0012, 0.05}; /* one unit is 90 */
    (void)state;
    for (size_t i = 0; i < sizeof gaps / sizeof *gaps; i++)
        for (int turned = 0; turned < 4; turned++) {
            double     side = turned % 2 ? -1 : 1, joint = 0.31, wide[2][2];
            lmn_scene *s = stroke_scene_begin();
            for (int k = 0; k < 2; k++) { /* to both sides of the joint, and what ends below it */
                wide[0][k] = side * (joint + (k ? gaps[i] : -4));
                wide[1][k] = side * (joint + (k ? 4 : 0));
            }
            for (int k = 0; k < 2; k++) {
                double a = k ? wide[0][1] : wide[0][0], b = k ? wide[1][1] : wide[1][0];
                add_box(s, fmin(a, b), -3, 0, fmax(a, b), 3, 1);
            }
            add_box(s, side > 0 ? -2 : -joint, -2, -3, side > 0 ? joint : 2, 2, -0.5);
            stroke_shot shot =
                shoot(s, look_along(0, turned < 2 ? 0 : 1e-9, -1, origin, 20, 5, true, 900, 900), all_lines());
            double seen = 0;
            for (size_t k = 0; k < shot.set.stroke_count; k++) {
                const stroke       *t = &shot.set.strokes[k];
                const stroke_point *p = &shot.set.points[t->first];
                if (t->part == 3 && t->hidden_by == 0)
                    seen += (double)(p[t->count - 1].arc - p->arc);
            }
            if (gaps[i] > 0.001 ? seen < 300 : seen > 0)
                fail_msg("gap %g, way %d: %.1f units of what lies below are seen", gaps[i], turned, seen);
            assert_int_equal(shot.check.wrong, 0);
            shot_release(&shot);
        }
}

/* A ball cut by a plate: the crossing is a circle of √(r² − h²). */
static void pieces_that_cross_have_a_line(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 96, 64);
    add_box(s, -2, -2, 0.4, 2, 2, 0.5);
    stroke_options w = all_lines();
    stroke_shot    shot = shoot(s, look_along(0, 0, -1, origin, 20, 3, true, 900, 900), w);
    double         length;
    size_t         count = count_strokes(&shot.set, STROKE_INTERSECTION, -1, &length);
    assert_int_equal(count, 2); /* where the ball enters and where it leaves */
    double wanted = 2 * stroke_pi * (sqrt(1 - 0.16) + sqrt(1 - 0.25)) * 150;
    assert_true(fabs(length - wanted) < 0.005 * wanted);
    for (size_t i = 0; i < shot.set.stroke_count; i++)
        if (shot.set.strokes[i].kind == STROKE_INTERSECTION)
            assert_true(shot.set.strokes[i].closed);
    assert_int_equal(count_strokes(&shot.set, STROKE_INTERSECTION, 0, NULL), 1);
    assert_int_equal(shot.check.wrong, 0);
    w.intersections = 0;
    stroke_set without;
    assert_int_equal(stroke_find(&without, shot.view, &w, NULL, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(count_strokes(&without, STROKE_INTERSECTION, -1, NULL), 0);
    stroke_set_release(&without);
    shot_release(&shot);
}

/* A post of eight sides in the middle of a wall's end: the wall's plane passes through two of its upright edges, where
 * no face is on both sides of the plane. The seams are there all the same, as when the post stands a little beside. */
static void walls_meet_edges_of_posts(void **state)
{
    (void)state;
    for (int beside = 0; beside < 2; beside++) {
        lmn_scene *s = stroke_scene_begin();
        vec3       positions[16];
        uint32_t   corners[48];
        for (uint32_t k = 0; k < 16; k++) {
            double turn = 2 * stroke_pi * (k % 8) / 8;
            positions[k] = (vec3){(float)cos(turn), (float)(sin(turn) + (beside ? 0.05 : 0)), k < 8 ? 0.0f : 3.0f};
        }
        positions[0].y = positions[8].y = positions[4].y = positions[12].y = beside ? 0.05f : 0;
        for (uint32_t k = 0; k < 8; k++) {
            const uint32_t j = (k + 1) % 8, quad[6] = {k, j, j + 8, k, j + 8, k + 8};
            memcpy(corners + 6 * k, quad, sizeof quad);
        }
        add_part(s, positions, 16, corners, 48);
        const vec3     wall[4] = {{0, 0, 0.5f}, {4, 0, 0.5f}, {4, 0, 2.5f}, {0, 0, 2.5f}};
        const uint32_t faces[6] = {0, 1, 2, 0, 2, 3};
        add_part(s, wall, 4, faces, 6);
        stroke_options w = all_lines();
        w.shortest = 0;
        w.simplify = 0;
        stroke_shot shot = shoot(s, look_along(-0.4, 1, 0, (const double[3]){1, 0, 1.5}, 20, 5, true, 800, 800), w);
        double      crossing;
        count_strokes(&shot.set, STROKE_INTERSECTION, -1, &crossing);
        printf("a seam %s the edge: %.1f\n", beside ? "beside" : "on", crossing);
        assert_true(fabs(crossing - 2 * 80) < 0.5); /* 2 of 10 that are 800 high */
        shot_release(&shot);
    }
}

/* What only touches does not cross, and what lies in a face is not hidden by it. */
static void flush_parts_are_calm(void **state)
{
    (void)state;
    const double views[4][3] = {{-1, -1.3, -0.8}, {-0.4, 1, -0.5}, {1, 0.02, -0.9}, {-0.3, -0.2, -1}};
    for (int v = 0; v < 4; v++)
        for (int orthographic = 0; orthographic < 2; orthographic++) {
            lmn_scene *s = stroke_scene_begin();
            add_box(s, -3, -3, -1, 3, 3, 0.1);
            add_box(s, -1, -1, 0.1, 1, 1, 0.7);   /* stands on the other one */
            add_box(s, -1, -1, 0.7, 0.3, 1, 1.3); /* flush with three faces of the one below */
            stroke_camera c = look_along(views[v][0], views[v][1], views[v][2], origin, 30, orthographic ? 5 : 0.17,
                                         orthographic, 700, 500);
            stroke_shot   shot = shoot(s, c, all_lines());
            assert_int_equal(shot.check.wrong, 0);
            assert_int_equal(count_strokes(&shot.set, STROKE_INTERSECTION, -1, NULL), 0);
            assert_in_range(shot.set.stroke_count, 12, 60);
            shot_release(&shot);
        }
}

/* Coplanar plates that overlap hide nothing of each other. */
static void coplanar_plates_do_not_hide(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_plate(s, -2, -2, 1, 1, 0.3);
    add_plate(s, -1, -1, 2, 2, 0.3);
    add_plate(s, -1, -1, 2, 2, 0.3);
    stroke_shot shot = shoot(s, look_along(-0.5, -0.6, -1, origin, 30, 4, true, 600, 600), all_lines());
    assert_int_equal(count_strokes(&shot.set, STROKE_CLASS_COUNT, -2, NULL), 0);
    assert_int_equal(count_strokes(&shot.set, STROKE_BORDER, 0, NULL), 3);
    assert_int_equal(shot.check.wrong, 0);
    shot_release(&shot);
}

/* Every triangle of a heap of hundreds has its border drawn, cut by all others. */
static void heaps_agree_with_rays(void **state)
{
    (void)state;
    uint64_t samples = 0;
    for (uint32_t seed = 0; seed < 12; seed++) {
        lmn_scene *s = stroke_scene_begin();
        for (uint32_t i = 0; i < 60; i++) {
            vec3           p[3];
            const uint32_t corners[3] = {0, 1, 2};
            for (uint32_t k = 0; k < 3; k++) {
                uint32_t n = ((seed * 60 + i) * 3 + k) * 3;
                float    reach = i % 7 == 0 ? 6 : 2;
                p[k] = (vec3){(float)(stroke_random(n) - 0.5) * reach, (float)(stroke_random(n + 1) - 0.5) * reach,
                              (float)(stroke_random(n + 2) - 0.5) * reach};
            }
            add_part(s, p, 3, corners, 3);
        }
        bool          orthographic = seed % 2;
        stroke_camera c = look_along(stroke_random(seed * 31) - 0.5, stroke_random(seed * 31 + 1) - 0.5,
                                     stroke_random(seed * 31 + 2) - 0.5, origin, seed % 3 ? 20 : 1.5,
                                     orthographic ? 4
                                     : seed % 3   ? 0.2
                                                  : 1,
                                     orthographic, 640, 480);
        stroke_shot   shot = shoot(s, c, all_lines());
        samples += shot.check.samples;
        assert_int_equal(shot.check.wrong, 0);
        assert_true(shot.check.miscounted * 50 <= shot.check.samples); /* counts that change from pixel to pixel */
        shot_release(&shot);
    }
    assert_true(samples > 100000);
}

/* The eye inside a room: what is behind it is cut off, walls hide what is behind them. */
static void eye_may_be_inside(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -4, -4, -2, 4, 4, 2);
    add_box(s, 2, -1, -2, 3, 1, 0);
    add_box(s, 6, -1, -2, 7, 1, 0); /* outside */
    stroke_camera c = look_along(1, 0.1, -0.1, origin, 1, 0.6, false, 800, 600);
    stroke_shot   shot = shoot(s, c, all_lines());
    assert_int_equal(shot.check.wrong, 0);
    for (size_t i = 0; i < shot.set.stroke_count; i++)
        assert_true(shot.set.strokes[i].part != 3 || shot.set.strokes[i].hidden_by > 0);
    for (size_t i = 0; i < shot.set.point_count; i++) {
        stroke_point p = shot.set.points[i];
        assert_true(p.x >= 0 && p.x <= 800 && p.y >= 0 && p.y <= 600 && p.depth > 0);
    }
    assert_true(count_strokes(&shot.set, STROKE_CLASS_COUNT, 0, NULL) > 6);
    shot_release(&shot);
}

static bool sets_are_equal(const stroke_set *a, const stroke_set *b)
{
    return a->stroke_count == b->stroke_count && a->point_count == b->point_count &&
           memcmp(a->points, b->points, a->point_count * sizeof *a->points) == 0;
}

static void same_call_same_strokes(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 60, 40);
    add_ball(s, 0.7, 0.2, 0.4, 1, 50, 30);
    stroke_shot    shot = shoot(s, look_along(-1, -1, -1, origin, 20, 3, true, 900, 900), all_lines());
    stroke_options w = all_lines();
    stroke_set     again;
    assert_int_equal(stroke_scene_cross(shot.scene, NULL, 0, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(stroke_find(&again, shot.view, &w, NULL, NULL, NULL, NULL), LMN_OK);
    assert_true(sets_are_equal(&shot.set, &again));
    stroke_set_release(&again);
    shot_release(&shot);
}

/* Normals of crossing surfaces look out of what they enclose, whichever way round corners and axes are; an open
 * plate encloses nothing. */
static void crossings_look_outwards(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    add_box(s, 2.5, 0.2, -0.6, 0.5, 1.5, 1.4); /* inside out */
    add_box(s, -0.5, 0.3, 0.2, 0.6, 0.7, 2.5);
    node_own_place(&s->nodes[s->node_count - 1])->scale[1] = -2; /* from −1.4 to −0.6 */
    add_plate(s, -2, -2, 2, 2, 0.1);
    stroke_shot shot = shoot(s, look_along(-1, -1, -1, origin, 20, 3, true, 900, 900), all_lines());
    assert_int_equal(stroke_scene_cross(shot.scene, NULL, 0, NULL, NULL, NULL), LMN_OK);
    const double boxes[3][6] = {
        {-1, -1, -1, 1, 1, 1}, {0.5, 0.2, -0.6, 2.5, 1.5, 1.4}, {-0.5, -1.4, 0.2, 0.6, -0.6, 2.5}};
    size_t on_box[3] = {0}, open = 0;
    for (size_t i = 0; i < stroke_scene_crossing_count(shot.scene); i++) {
        double ends[2][3];
        vec3   outward[2];
        stroke_scene_crossing(shot.scene, i, ends, outward);
        for (int k = 0; k < 2; k++) {
            const double n[3] = {(double)outward[k].x, (double)outward[k].y, (double)outward[k].z};
            size_t       fitting = 0;
            for (int b = 0; b < 3; b++) {
                bool out = false, in = true;
                for (int axis = 0; axis < 3; axis++) {
                    double middle = (ends[0][axis] + ends[1][axis]) / 2, before = middle - 1e-3 * n[axis],
                           beyond = middle + 1e-3 * n[axis];
                    in = in && before >= boxes[b][axis] && before <= boxes[b][axis + 3];
                    out = out || beyond < boxes[b][axis] - 1e-4 || beyond > boxes[b][axis + 3] + 1e-4;
                }
                fitting += in && out;
                on_box[b] += in && out;
            }
            bool none = n[0] * n[0] + n[1] * n[1] + n[2] * n[2] == 0;
            open += none;
            assert_true(none || fitting == 1);
        }
    }
    assert_true(on_box[0] > 8 && on_box[1] > 4 && on_box[2] > 4 && open > 8);
    shot_release(&shot);
}

/* OE-11: chains of creases end at corners, and smooth outlines close. */
static void chains_end_at_corners(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    add_ball(s, 5, 0, 0, 1, 48, 32);
    double      at[3] = {2, 0, 0};
    stroke_shot shot = shoot(s, look_along(-1, -1.2, -0.7, at, 30, 5, true, 1000, 600), all_lines());
    for (size_t i = 0; i < shot.set.stroke_count; i++) {
        const stroke *t = &shot.set.strokes[i];
        if (t->kind == STROKE_CREASE)
            assert_int_equal(t->count, 2);
        if (t->part == 2)
            assert_true(t->closed && t->kind == STROKE_CONTOUR && t->hidden_by == 0);
    }
    double length;
    assert_int_equal(count_strokes(&shot.set, STROKE_CONTOUR, 0, &length), 2);
    shot_release(&shot);
}

/* Arc lengths run along chains without a jump. */
static void arcs_run_on(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 48, 32);
    add_box(s, -2, -0.2, 1.5, 2, 0.2, 1.6);
    stroke_shot shot = shoot(s, look_along(0, 0.3, -1, origin, 30, 2, true, 1000, 1000), all_lines());
    for (size_t i = 0; i < shot.set.stroke_count; i++) {
        const stroke *t = &shot.set.strokes[i];
        for (uint32_t k = 1; k < t->count; k++) {
            const stroke_point *p = &shot.set.points[t->first + k];
            double chord = hypot((double)p->x - p[-1].x, (double)p->y - p[-1].y), arc = (double)p->arc - p[-1].arc;
            assert_true(arc >= chord - 1e-3 && arc <= 1.2 * chord + 0.6);
            assert_true(p->arc <= t->chain_length + 1e-2f);
        }
        const stroke *next = t + 1;
        if (i + 1 < shot.set.stroke_count && next->chain == t->chain && next->hidden_by != t->hidden_by) {
            const stroke_point *end = &shot.set.points[t->first + t->count - 1], *begin = &shot.set.points[next->first];
            assert_true(fabs((double)end->arc - begin->arc) < 1e-3 &&
                        hypot((double)end->x - begin->x, (double)end->y - begin->y) < 1e-3);
        }
    }
    shot_release(&shot);
}

/* While the eye moves a little, what repeats along an outline stays near where it was. */
static void phases_follow(void **state)
{
    (void)state;
    stroke_set before = {0};
    double     worst = 0;
    size_t     known = 0, all = 0;
    for (int frame = 0; frame < 20; frame++) {
        lmn_scene *s = stroke_scene_begin();
        add_box(s, -1, -1, -1, 1, 1, 1);
        add_ball(s, 2.2, 0, 0, 1, 64, 48);
        double      turn = 0.4 + frame * 0.005;
        stroke_shot shot =
            shoot(s, look_along(-cos(turn), -sin(turn), -0.5, origin, 20, 3, true, 800, 800), all_lines());
        stroke_follow(&shot.set, &before);
        for (size_t i = 0; frame && i < shot.set.mark_count; i++)
            for (size_t k = 0; k < before.mark_count; k++) {
                if (before.marks[k].id != shot.set.marks[i].id)
                    continue;
                double phases[2] = {0, 0}, length = 0;
                for (size_t n = 0; n < shot.set.stroke_count; n++)
                    if (shot.set.strokes[n].chain == shot.set.marks[i].chain) {
                        phases[0] = shot.set.strokes[n].phase;
                        length = shot.set.strokes[n].closed ? shot.set.strokes[n].chain_length : 0;
                    }
                for (size_t n = 0; n < before.stroke_count; n++)
                    phases[1] = before.strokes[n].chain == before.marks[k].chain ? before.strokes[n].phase : phases[1];
                double moved = phases[0] + shot.set.marks[i].arc - phases[1] - before.marks[k].arc;
                worst = fmax(worst, fabs(moved - (length > 0 ? length * round(moved / length)
                                                             : 0))); /* closed chains come round again */
                if (getenv("SHOW") && fabs(moved - (length > 0 ? length * round(moved / length) : 0)) > 12)
                    printf("frame %d moved %.1f length %.1f arc %.1f was %.1f phases %.1f %.1f\n", frame, moved, length,
                           shot.set.marks[i].arc, before.marks[k].arc, phases[0], phases[1]);
                known++;
            }
        all += shot.set.mark_count;
        stroke_set_release(&before);
        before = shot.set;
        memset(&shot.set, 0, sizeof shot.set);
        shot_release(&shot);
    }
    stroke_set_release(&before);
    assert_true(known * 2 > all); /* most edges last */
    assert_true(worst < 12);      /* the ball's outline moves over its meridians; without phases it would be hundreds */
}

/* What lies on a line is left out, what crosses it is not. */
static void lines_on_lines_are_left_out(void **state)
{
    (void)state;
    for (int crowd = 0; crowd < 2; crowd++) {
        lmn_scene *s = stroke_scene_begin();
        add_plate(s, -2, -2, 2, 2, 0);
        add_plate(s, -2, -2, 2, 2, -1);    /* right below */
        add_plate(s, -3, -0.5, 3, 0.5, 1); /* across */
        stroke_options w = all_lines();
        w.crowd = crowd ? 0.75f : 0;
        stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 4, true, 800, 800), w);
        double      hidden, visible;
        count_strokes(&shot.set, STROKE_BORDER, -2, &hidden);
        count_strokes(&shot.set, STROKE_BORDER, 0, &visible);
        assert_true(fabs(visible - (14 * 100 + (16 - 2) * 100)) < 2);
        assert_true(fabs(hidden - (crowd ? 200 : 200 + 1600)) < 2);
        shot_release(&shot);
    }
}

static void bad_meshes_are_drawn(void **state)
{
    (void)state;
    lmn_scene     *s = stroke_scene_begin();
    vec3           p[9] = {{0, 0, 0},    {2, 0, 0},     {2, 2, 0},    {0, 2, 0}, {1, 0, 0},
                           {1, 1, 1.5f}, {1, 1, -1.5f}, {3, 1, 0.5f}, {1, 1, 0}};
    const uint32_t corners[] = {0, 1, 2, 0, 2, 3,          /* a square */
                                0, 1, 2, 2, 1, 0,          /* the same triangle again, and turned round */
                                0, 2, 5, 0, 2, 6, 0, 2, 7, /* five triangles at one edge */
                                0, 4, 5, 4, 1, 5,          /* T-junction: 4 lies on 0–1 */
                                8, 8, 1, 0, 4, 1};         /* no area */
    add_part(s, p, 9, corners, sizeof corners / sizeof *corners);
    stroke_shot shot = shoot(s, look_along(-1, -0.6, -0.8, origin, 20, 3, true, 500, 500), all_lines());
    assert_int_equal(shot.check.wrong, 0);
    assert_in_range(shot.set.stroke_count, 8, 40);
    shot_release(&shot);
    s = stroke_scene_begin();
    vec3           speck[3] = {{0, 0, 0}, {1e-6f, 0, 0}, {0, 1e-6f, 0}};
    const uint32_t one[3] = {0, 1, 2};
    add_part(s, speck, 3, one, 3);
    shot = shoot(s, look_along(-1, -0.6, -0.8, origin, 20, 3, true, 500, 500), all_lines());
    assert_int_equal(shot.set.stroke_count, 0); /* smaller than the shortest chain */
    shot_release(&shot);
}

/* Memory may run out anywhere. */
static void memory_may_run_out(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 12, 8);
    add_box(s, -0.5, -0.5, 0, 2, 0.5, 0.5);
    lmn_error error = {0};
    assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    pose at_rest;
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    stroke_camera  c = look_along(-1, -0.6, -0.8, origin, 20, 3, true, 200, 200);
    stroke_options w = all_lines();
    bool           done = false;
    w.detail = 0.5f;
    for (long n = 1; n < 400 && !done; n++) {
        stroke_scene scene;
        stroke_view *view = NULL;
        stroke_set   set;
        mem_fail_at(n);
        lmn_status status = stroke_scene_create(&scene, &at_rest, NULL, 0.5, NULL, NULL, &error);
        if (status == LMN_OK) {
            status = stroke_view_create(&view, &scene, &c, NULL, NULL, &error);
            if (status == LMN_OK)
                status = stroke_find(&set, view, &w, NULL, NULL, NULL, &error);
            if (status == LMN_OK)
                stroke_set_release(&set);
            stroke_view_destroy(&view);
            stroke_scene_release(&scene);
        }
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        done = status == LMN_OK;
    }
    assert_true(done);
    pose_release(&at_rest);
    scene_free(s);
}

static bool stop_at_once(double fraction, const char *stage, void *user)
{
    (void)fraction;
    (void)stage;
    return --*(int *)user > 0;
}

/* Two rods and a ball that run through each other: moved by nodes, which put things exactly where they say. */
static void add_cross(lmn_scene *s, const double at[3], double size)
{
    add_box(s, -size, -0.2 * size, -0.2 * size, size, 0.2 * size, 0.2 * size);
    add_box(s, -0.15 * size, -0.15 * size, -size, 0.15 * size, 0.15 * size, size);
    add_ball(s, 0, 0.15 * size, 0, 0.35 * size, 120, 90);
    for (size_t i = s->node_count - 3; i < s->node_count; i++)
        memcpy(node_own_place(&s->nodes[i])->translation, at, 3 * sizeof *at);
}

typedef struct cross_lines {
    double seen[STROKE_CLASS_COUNT], hidden[STROKE_CLASS_COUNT];
} cross_lines;

/* Lengths of the lines of a small cross, with or without something huge beside it. */
static cross_lines draw_cross(const double at[3], double size, double beside)
{
    cross_lines out;
    lmn_scene  *s = stroke_scene_begin();
    if (beside > 0)
        add_box(s, at[0] - 4 * size - beside, at[1] - beside, at[2] - beside, at[0] - 4 * size, at[1] + beside,
                at[2] + beside);
    add_cross(s, at, size);
    stroke_shot shot = shoot(s, look_along(-1, -0.8, -0.6, at, 20 * size, 1.5 * size, true, 600, 600), all_lines());
    for (size_t i = 0; i < shot.set.stroke_count; i++)
        if (beside > 0 && shot.set.strokes[i].part == 1)
            shot.set.strokes[i].kind = STROKE_PAST; /* nobody asks */
    for (int kind = 0; kind < STROKE_CLASS_COUNT; kind++) {
        count_strokes(&shot.set, kind, 0, &out.seen[kind]);
        count_strokes(&shot.set, kind, -2, &out.hidden[kind]);
    }
    shot_release(&shot);
    return out;
}

static void assert_same_lines(const cross_lines *a, const cross_lines *b, double most)
{
    for (int kind = 0; kind < STROKE_PAST; kind++)
        if (fabs(a->seen[kind] - b->seen[kind]) > most || fabs(a->hidden[kind] - b->hidden[kind]) > most)
            fail_msg("%s: %g px seen and %g hidden, not %g and %g", stroke_class_name((stroke_class)kind),
                     b->seen[kind], b->hidden[kind], a->seen[kind], a->hidden[kind]);
}

/* How exact positions are is each part's own matter: what is a millionth of the size of another part keeps its lines.
 */
static void small_parts_keep_their_lines(void **state)
{
    (void)state;
    cross_lines alone = draw_cross(origin, 1e-6, 0), beside = draw_cross(origin, 1e-6, 1);
    assert_true(alone.seen[STROKE_INTERSECTION] > 50 && alone.hidden[STROKE_CREASE] > 100);
    assert_same_lines(&alone, &beside, 1);
}

/* A model that its node moves by a million of its sizes has the same lines. */
static void far_parts_keep_their_lines(void **state)
{
    static const double away[3] = {1e6, -7e5, 3e5};
    (void)state;
    cross_lines here = draw_cross(origin, 1, 0), there = draw_cross(away, 1, 0);
    assert_true(here.seen[STROKE_INTERSECTION] > 50 && here.hidden[STROKE_CREASE] > 100);
    assert_same_lines(&here, &there, 1);
}

static void work_can_be_cancelled(void **state)
{
    (void)state;
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 40, 30);
    lmn_error error = {0};
    assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    pose at_rest;
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    stroke_camera  c = look_along(-1, -0.6, -0.8, origin, 20, 3, true, 200, 200);
    stroke_options w = all_lines();
    stroke_scene   scene;
    stroke_view   *view;
    stroke_set     set;
    int            calls = 1;
    assert_int_equal(stroke_scene_create(&scene, &at_rest, NULL, 0.5, stop_at_once, &calls, &error), LMN_CANCELLED);
    assert_int_equal(stroke_scene_create(&scene, &at_rest, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    calls = 1;
    assert_int_equal(stroke_view_create(&view, &scene, &c, stop_at_once, &calls, &error), LMN_CANCELLED);
    assert_null(view);
    assert_int_equal(stroke_view_create(&view, &scene, &c, NULL, NULL, &error), LMN_OK);
    calls = 1;
    assert_int_equal(stroke_find(&set, view, &w, NULL, stop_at_once, &calls, &error), LMN_CANCELLED);
    assert_int_equal(set.stroke_count, 0);
    stroke_view_destroy(&view);
    stroke_scene_release(&scene);
    pose_release(&at_rest);
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(cube_has_six_nine_twelve),
        cmocka_unit_test(bores_have_hidden_sides),
        cmocka_unit_test(plates_are_counted),
        cmocka_unit_test(rims_hide_where_they_are),
        cmocka_unit_test(shells_that_coincide_are_one),
        cmocka_unit_test(balls_that_coincide_are_one),
        cmocka_unit_test(pipes_that_cross_have_whole_lines),
        cmocka_unit_test(thin_plates_hide),
        cmocka_unit_test(joints_hide_what_lies_below),
        cmocka_unit_test(pieces_that_cross_have_a_line),
        cmocka_unit_test(walls_meet_edges_of_posts),
        cmocka_unit_test(flush_parts_are_calm),
        cmocka_unit_test(coplanar_plates_do_not_hide),
        cmocka_unit_test(heaps_agree_with_rays),
        cmocka_unit_test(eye_may_be_inside),
        cmocka_unit_test(same_call_same_strokes),
        cmocka_unit_test(crossings_look_outwards),
        cmocka_unit_test(chains_end_at_corners),
        cmocka_unit_test(arcs_run_on),
        cmocka_unit_test(phases_follow),
        cmocka_unit_test(lines_on_lines_are_left_out),
        cmocka_unit_test(bad_meshes_are_drawn),
        cmocka_unit_test(small_parts_keep_their_lines),
        cmocka_unit_test(far_parts_keep_their_lines),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(work_can_be_cancelled),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
