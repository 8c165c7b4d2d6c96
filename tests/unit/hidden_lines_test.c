/* Hidden lines as ISO 128 wants them: whole, from corner to corner, or not at all. Lengths are worked out by hand from
 * edges and the view's direction. */
#include "stroke_shapes.h"

#include "stroke/ribbon.h"

enum { PAGE = 600 };
#define UNIT 150.0 /* of the page for one of the model */

static stroke_style dashed_style(void)
{
    stroke_style style = {.width = 1.5f,
                          .crease_width = 0.7f,
                          .wobble_length = 30,
                          .repeats = 1,
                          .hidden = HIDDEN_DASHED,
                          .hidden_colour = {NAN, 0, 0, 1},
                          .hidden_width = 0.75f,
                          .hidden_dash = 4.5f,
                          .hidden_gap = 3,
                          .hidden_fade = 1};
    for (int i = 0; i < STROKE_CLASS_COUNT; i++)
        style.colours[i] = (colour){NAN, 0, 0, 1};
    style.colours[STROKE_CONTOUR] = (colour){0, 0, 0, 1};
    return style;
}

/* From the first dash of each run to its last; a gap wider than two of the style's ends a run. */
static double hidden_length_of(const stroke_set *set, stroke_style style, size_t *dashes)
{
    ribbon_set r;
    lmn_error  error = {0};
    double     sum = 0, before = 0;
    int64_t    chain = -1;
    *dashes = 0;
    assert_int_equal(ribbons_make(&r, set, &style, 1, &error), LMN_OK);
    for (size_t i = 0; i < r.ribbon_count; i++) {
        const ribbon_point *p = &r.points[r.ribbons[i].first], *q = p + r.ribbons[i].count - 1;
        if (r.ribbons[i].hidden_by == 0)
            continue;
        double gap = (double)p->arc - before;
        sum += (double)q->arc - p->arc + (r.ribbons[i].chain == chain && gap < 2 * 3 ? gap : 0);
        chain = r.ribbons[i].chain;
        before = q->arc;
        ++*dashes;
    }
    ribbon_set_release(&r);
    return sum;
}

static double hidden_length(const stroke_set *set, size_t *dashes)
{
    return hidden_length_of(set, dashed_style(), dashes);
}

static double hidden_length_crowded(const stroke_set *set, size_t *dashes)
{
    stroke_style style = dashed_style();
    style.hidden_crowd = 4.5f;
    return hidden_length_of(set, style, dashes);
}

static void assert_near(double value, double wanted, double within)
{
    if (!(fabs(value - wanted) <= within))
        fail_msg("%.4f instead of %.4f", value, wanted);
}

/* --- solids ---------------------------------------------------------------------------------------------- */

/* How long a unit along an axis is on the page. */
static double seen(const double eye[3], int axis)
{
    double square = eye[0] * eye[0] + eye[1] * eye[1] + eye[2] * eye[2];
    return UNIT * sqrt(1 - eye[axis] * eye[axis] / square);
}

static double hidden_of(lmn_scene *s, const double eye[3], const double middle[3])
{
    stroke_options options = STROKE_OPTIONS_INIT;
    options.hidden = true;
    stroke_camera camera = look_along(-eye[0], -eye[1], -eye[2], middle, 20, PAGE / 2 / UNIT, true, PAGE, PAGE);
    stroke_shot   shot = shoot(s, camera, options);
    size_t        dashes;
    double        length = hidden_length(&shot.set, &dashes);
    shot_release(&shot);
    return length;
}

static void test_cube(void **state)
{
    const double eye[3] = {3, 2, 1.5}, middle[3] = {0.5, 0.5, 0.5};
    lmn_scene   *s = stroke_scene_begin();
    (void)state;
    add_box(s, 0, 0, 0, 1, 1, 1);
    /* The three edges of the corner that lies farthest. */
    assert_near(hidden_of(s, eye, middle), seen(eye, 0) + seen(eye, 1) + seen(eye, 2), 0.05);
}

/* A prism over an L whose arms are two long and one wide. */
static void add_l(lmn_scene *s, float height)
{
    const float    plan[6][2] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    const uint32_t fans[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {0, 4, 5}};
    vec3           positions[12];
    uint32_t       corners[60], k = 0;
    for (int i = 0; i < 12; i++)
        positions[i] = (vec3){plan[i % 6][0], plan[i % 6][1], i < 6 ? 0 : height};
    for (int i = 0; i < 4; i++) {
        const uint32_t both[6] = {fans[i][0], fans[i][2], fans[i][1], 6 + fans[i][0], 6 + fans[i][1], 6 + fans[i][2]};
        memcpy(corners + k, both, sizeof both);
        k += 6;
    }
    for (uint32_t i = 0; i < 6; i++) {
        uint32_t       n = (i + 1) % 6;
        const uint32_t wall[6] = {i, n, 6 + n, i, 6 + n, 6 + i};
        memcpy(corners + k, wall, sizeof wall);
        k += 6;
    }
    add_part(s, positions, 12, corners, k);
}

static void test_l(void **state)
{
    const double eye[3] = {-1, 2, 1}, middle[3] = {1, 1, 1}, height = 2;
    double       x = seen(eye, 0), y = seen(eye, 1), z = seen(eye, 2);
    lmn_scene   *s = stroke_scene_begin();
    (void)state;
    add_l(s, (float)height);
    /* Behind all: the bottom edges at y = 0, x = 2 and x = 1, the upright ones at (2, 0) and in the notch. The bottom
     * edge of the notch's other wall is hidden as far as the arm reaches over it: 1 along y is ½ along x. */
    assert_near(hidden_of(s, eye, middle), 2 * x + y + y + 2 * height * z + 0.5 * x, 0.05);
}

enum { SIDES = 24 };

/* A square box, 2 wide around the axis, with a bore through it. */
static void add_bored(lmn_scene *s, double radius, float height)
{
    const float square[4][2] = {{1, 1}, {-1, 1}, {-1, -1}, {1, -1}};
    vec3        positions[2 * (SIDES + 4)];
    uint32_t    corners[3 * 200], k = 0, layer = SIDES + 4;
    for (uint32_t i = 0; i < 2 * layer; i++) {
        double turn = 2 * stroke_pi * (i % layer) / SIDES;
        bool   round = i % layer < SIDES;
        positions[i] =
            (vec3){round ? (float)(radius * cos(turn)) : square[i % layer - SIDES][0],
                   round ? (float)(radius * sin(turn)) : square[i % layer - SIDES][1], i < layer ? 0 : height};
    }
    for (uint32_t i = 0; i < SIDES + 4; i++) { /* top and bottom: each corner has a quarter of the rim */
        uint32_t a = i < SIDES ? SIDES + i / 6 : SIDES + (i - SIDES),
                 b = i < SIDES ? (i + 1) % SIDES : SIDES + (i + 1) % 4, c = i < SIDES ? i : (i - SIDES + 1) % 4 * 6;
        const uint32_t both[6] = {layer + a, layer + b, layer + c, a, c, b};
        memcpy(corners + k, both, sizeof both);
        k += 6;
    }
    for (uint32_t i = 0; i < SIDES + 4; i++) {
        uint32_t       n = i < SIDES ? (i + 1) % SIDES : SIDES + (i - SIDES + 1) % 4;
        const uint32_t inner[6] = {n, i, layer + i, n, layer + i, layer + n};
        const uint32_t outer[6] = {i, n, layer + n, i, layer + n, layer + i};
        memcpy(corners + k, i < SIDES ? inner : outer, sizeof inner);
        k += 6;
    }
    add_part(s, positions, 2 * layer, corners, k);
}

static void test_bored(void **state)
{
    const double eye[3] = {1, 2, 2}, middle[3] = {0, 0, 0.6}, height = 1.2, radius = 0.4, square = 9;
    double       rim = 0;
    lmn_scene   *s = stroke_scene_begin();
    (void)state;
    add_bored(s, radius, (float)height);
    for (int i = 0; i < SIDES; i++) {
        double a = 2 * stroke_pi * i / SIDES, b = 2 * stroke_pi * (i + 1) / SIDES;
        double x = radius * (cos(b) - cos(a)), y = radius * (sin(b) - sin(a)), along = x * eye[0] + y * eye[1];
        rim += UNIT * sqrt(x * x + y * y - along * along / square);
    }
    /* Three edges of the box, the bore's lower rim, and both sides of the bore: so steep is the view that none of them
     * is seen through it. */
    assert_near(hidden_of(s, eye, middle), 2 * seen(eye, 0) + 2 * seen(eye, 1) + 3 * height * seen(eye, 2) + rim, 0.05);
}

/* --- figures --------------------------------------------------------------------------------------------- */

static stroke_point points[128];
static stroke       strokes[32];
static stroke_set   set;

static void begin(void)
{
    memset(strokes, 0, sizeof strokes);
    set = (stroke_set){.strokes = strokes, .points = points};
}

static void add(float x0, float y0, float x1, float y1, uint32_t hidden_by, bool goes_on)
{
    stroke *s = &strokes[set.stroke_count++];
    float   arc = goes_on ? points[set.point_count - 1].arc : 0, length = hypotf(x1 - x0, y1 - y0);
    set.chain_count += !goes_on;
    *s = (stroke){.kind = STROKE_CREASE,
                  .part = 1,
                  .hidden_by = hidden_by,
                  .chain = (uint32_t)set.chain_count - 1,
                  .id = 5 * set.chain_count,
                  .first = (uint32_t)set.point_count,
                  .count = 2};
    points[set.point_count++] = (stroke_point){x0, y0, 5, arc, 1};
    points[set.point_count++] = (stroke_point){x1, y1, 5, arc + length, 1};
    for (stroke *t = s; t >= strokes && t->chain == s->chain; t--)
        t->chain_length = arc + length;
}

static void add_posts(float x0, float x1)
{
    add(x0, -50, x0, 50, 0, false);
    add(x1, -50, x1, 50, 0, false);
}

/* Four dashes and three gaps are 27: what is shorter is left out, though it lies between two lines. */
static void test_short(void **state)
{
    size_t dashes;
    (void)state;
    begin();
    add_posts(0, 26.5f);
    add(0, 0, 26.5f, 0, 1, false);
    assert_near(hidden_length(&set, &dashes), 0, 0);
    begin();
    add_posts(0, 27.5f);
    add(0, 0, 27.5f, 0, 1, false);
    assert_near(hidden_length(&set, &dashes), 27.5, 1e-3);
    assert_int_equal(dashes, 4);
}

/* What ends at nothing is left out, however long it is. */
static void test_loose(void **state)
{
    size_t dashes;
    (void)state;
    for (int loose = 0; loose < 3; loose++) {
        begin();
        add_posts(loose == 2 ? -20 : 0, loose ? 220 : 200);
        add(0, 0, 200, 0, 1, false);
        assert_near(hidden_length(&set, &dashes), loose ? 0 : 200, 1e-3);
    }
}

/* And so is what ended there alone, one line after the other, up to where a line goes on that is whole. */
static void test_pruned(void **state)
{
    size_t dashes;
    (void)state;
    for (int open = 0; open < 2; open++) {
        begin();
        add_posts(0, 300);
        add(0, 0, 300, 0, 1, false);
        add(100, 0, 100, 40, 1, false);
        add(100, 40, 180, 40, 1, false);
        add(180, 40, 180, open ? 10 : 0, 1, false);
        assert_near(hidden_length(&set, &dashes), open ? 300 : 460, 1e-3);
    }
}

/* A run of which a piece is left out, from corner to corner because other lines crowd there, must end beside those. */
static void test_torn(void **state)
{
    size_t dashes;
    (void)state;
    for (int beside = 0; beside < 2; beside++) {
        begin();
        /* It bends at 100, and from there on it runs beside a visible line, or most of the way. */
        float length = 100 + hypotf(80, 80), from = beside ? 97 : 125;
        add_posts(0, 180);
        add(180, 50, 180, 100, 0, false);
        add(0, 0, 100, 0, 1, false);
        points[set.point_count++] = (stroke_point){180, 80, 5, length, 1};
        strokes[set.stroke_count - 1].count = 3;
        strokes[set.stroke_count - 1].chain_length = length;
        add(from, from - 103, 180, 77, 0, false);
        assert_near(hidden_length_crowded(&set, &dashes), beside ? 100 : 0, 1e-3);
    }
}

/* Two short runs that end at one corner are one figure. */
static void test_corner(void **state)
{
    size_t dashes;
    (void)state;
    for (int apart = 0; apart < 2; apart++) {
        begin();
        add_posts(0, 60);
        add(0, 0, 14, 0, 1, false);
        add(14 + (float)apart * 5, 0, 14 + (float)apart * 5, 14, 1, false);
        add(0, 14, 60, 14, 0, false);
        assert_near(hidden_length(&set, &dashes), apart ? 0 : 28, 1e-3);
    }
}

/* A line that turns before a dash and a gap are through, 7.5, shows nothing; one with longer pieces does, and one that
 * turns a little at a time. */
static void test_crumpled(void **state)
{
    enum { TURNS = 12 };
    size_t dashes;
    (void)state;
    for (int kind = 0; kind < 3; kind++) {
        const float piece = kind == 1 ? 8 : 6, across = piece * sqrtf(0.5f), up = kind == 2 ? across / 8 : across,
                    length = hypotf(across, up);
        begin();
        add_posts(0, TURNS * across);
        add(0, 0, across, up, 1, false);
        for (int i = 2; i <= TURNS; i++)
            points[set.point_count++] = (stroke_point){(float)i * across, i % 2 ? up : 0, 5, (float)i * length, 1};
        strokes[set.stroke_count - 1].count = TURNS + 1;
        strokes[set.stroke_count - 1].chain_length = TURNS * length;
        assert_near(hidden_length(&set, &dashes), kind == 0 ? 0 : TURNS * (double)length, 1e-3);
    }
}

/* A body with much of that, 32 dashes and gaps, shows no hidden lines at all; with little, those that are whole. */
static void test_crumpled_body(void **state)
{
    size_t dashes;
    (void)state;
    for (int much = 0; much < 2; much++) {
        const int   turns = much ? 60 : 20;
        const float across = 6 * sqrtf(0.5f);
        begin();
        add_posts(0, 260);
        add(0, 0, 260, 0, 1, false);
        add_posts(0, (float)turns * across);
        add(0, -20, across, across - 20, 1, false);
        for (int i = 2; i <= turns; i++)
            points[set.point_count++] =
                (stroke_point){(float)i * across, i % 2 ? across - 20 : -20, 5, (float)i * 6, 1};
        strokes[set.stroke_count - 1].count = (uint32_t)turns + 1;
        strokes[set.stroke_count - 1].chain_length = (float)turns * 6;
        assert_near(hidden_length(&set, &dashes), much ? 0 : 260, 1e-3);
    }
}

/* Neither a surface more in front nor a visible stretch that no one sees ends the dashes' row. */
static void test_run(void **state)
{
    (void)state;
    for (int visible = 0; visible < 2; visible++) {
        ribbon_set   r;
        lmn_error    error = {0};
        stroke_style style = dashed_style();
        float        at = 0, gap = visible ? 0.5f : 0;
        begin();
        add(0, -50, 0, 50, 0, false);
        add(60, -50, 60, 50, 0, false);
        add(0, 0, 20, 0, 1, false);
        if (visible)
            add(20, 0, 20 + gap, 0, 0, true);
        add(20 + gap, 0, 60, 0, 3, true);
        assert_int_equal(ribbons_make(&r, &set, &style, 1, &error), LMN_OK);
        for (size_t i = 0; i < r.ribbon_count; i++) {
            const ribbon_point *p = &r.points[r.ribbons[i].first], *q = p + r.ribbons[i].count - 1;
            if (r.ribbons[i].hidden_by == 0)
                continue;
            /* A dash or a gap at the change, never an end with its ink on both sides. */
            assert_true(p->arc - at <= 3.4f && q->arc - p->arc <= 5.1f);
            at = q->arc;
        }
        assert_float_equal(at, 60, 1e-3);
        ribbon_set_release(&r);
    }
}

/* --- whole features and bodies --------------------------------------------------------------------------- */

/* Half a circle around the middle of the page, from the angle `from` on. */
static void add_half(float radius, double from, stroke_class kind)
{
    stroke *s = &strokes[set.stroke_count++];
    float   arc = 0;
    set.chain_count++;
    *s = (stroke){.kind = kind,
                  .part = 2,
                  .piece = 2,
                  .hidden_by = 1,
                  .chain = (uint32_t)set.chain_count - 1,
                  .id = 5 * set.chain_count,
                  .first = (uint32_t)set.point_count,
                  .count = 25};
    for (int i = 0; i < 25; i++) {
        double angle = from + stroke_pi * i / 24;
        float  x = 300 + radius * (float)cos(angle), y = 300 + radius * (float)sin(angle);
        if (i > 0)
            arc += hypotf(x - points[set.point_count - 1].x, y - points[set.point_count - 1].y);
        points[set.point_count++] = (stroke_point){x, y, 5, arc, 1};
    }
    s->chain_length = arc;
}

/* The rim of a bore changes its kind halfway round. A nearer hidden line lies beside one half of it, or beside nothing:
 * the two halves are drawn, or neither is. */
static void test_whole_rim(void **state)
{
    const float radius = 100;
    (void)state;
    for (int crowded = 0; crowded < 2; crowded++) {
        size_t dashes;
        begin();
        add(300, 180, 300, 420, 0, false); /* what is seen of the body */
        strokes[0].piece = strokes[0].part = 2;
        add_half(radius, 0, STROKE_CONTOUR);
        add_half(radius, stroke_pi, STROKE_CREASE);
        strokes[1].hidden_by = strokes[2].hidden_by = 2;
        add_half(radius - (crowded ? 2 : 40), 0, STROKE_CONTOUR);
        strokes[3].piece = strokes[3].part = 1;
        add(150, 300, 450, 300, 0, false); /* where it ends */
        strokes[4].part = 1;
        double half = stroke_pi * (double)radius,
               rims = crowded ? half - 2 * stroke_pi : 2 * half + half - 40 * stroke_pi;
        assert_near(hidden_length_crowded(&set, &dashes), rims, 2);
    }
}

/* Of a body that cannot be seen at all, most is drawn or nothing; and so of bodies of one part, such as joists. */
static void test_whole_body(void **state)
{
    (void)state;
    for (int mode = 0; mode < 3; mode++) { /* one body; bodies of one part; all apart */
        size_t dashes;
        begin();
        add_posts(0, 200);
        for (uint32_t i = 0; i < 3; i++) {
            /* Two of them lie beside hidden lines of something nearer. */
            add(0, -30 + 30 * (float)i, 200, -30 + 30 * (float)i, 2, false);
            strokes[set.stroke_count - 1].part = mode < 2 ? 2 : 2 + i;
            strokes[set.stroke_count - 1].piece = mode < 1 ? 7 : 7 + i;
            if (i == 2)
                continue;
            add(0, -28 + 30 * (float)i, 200, -28 + 30 * (float)i, 1, false);
            strokes[set.stroke_count - 1].part = strokes[set.stroke_count - 1].piece = 20;
        }
        strokes[0].part = strokes[1].part = 1;
        assert_near(hidden_length_crowded(&set, &dashes), mode < 2 ? 400 : 600, 1e-3);
    }
}

/* Small and wholly hidden: left out, unless some of it is seen. */
static void test_island(void **state)
{
    (void)state;
    for (int seen = 0; seen < 2; seen++) {
        size_t dashes;
        begin();
        add_posts(0, 28);
        add(0, 0, 28, 0, 1, false);
        strokes[2].piece = strokes[2].part = 2;
        if (seen)
            strokes[0].piece = strokes[0].part = 2;
        assert_near(hidden_length_crowded(&set, &dashes), seen ? 28 : 0, 1e-3);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_cube),       cmocka_unit_test(test_l),
                                       cmocka_unit_test(test_bored),      cmocka_unit_test(test_short),
                                       cmocka_unit_test(test_loose),      cmocka_unit_test(test_corner),
                                       cmocka_unit_test(test_crumpled),   cmocka_unit_test(test_crumpled_body),
                                       cmocka_unit_test(test_run),        cmocka_unit_test(test_pruned),
                                       cmocka_unit_test(test_torn),       cmocka_unit_test(test_whole_rim),
                                       cmocka_unit_test(test_whole_body), cmocka_unit_test(test_island)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
