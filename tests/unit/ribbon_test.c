/* Ribbons: how strokes made by hand are drawn. Every expectation is worked out from the lines' positions, not from
 * ribbons. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "stroke/ribbon.h"

enum { POINTS_MOST = 4096, STROKES_MOST = 128 };

typedef struct drawing {
    stroke_point points[POINTS_MOST];
    stroke       strokes[STROKES_MOST];
    stroke_set   set;
} drawing;

static drawing d; /* large */

static void begin(void)
{
    memset(&d, 0, sizeof d);
    d.set = (stroke_set){.strokes = d.strokes, .points = d.points};
}

static stroke_style plain_style(void)
{
    stroke_style style = {.width = 2,
                          .crease_width = 0.5f,
                          .wobble_length = 30,
                          .repeats = 1,
                          .overshoot_most = 0.35f,
                          .hidden = HIDDEN_SOLID,
                          .hidden_colour = {NAN, 0, 0, 1},
                          .hidden_width = 1,
                          .hidden_gap = 4,
                          .hidden_fade = 1};
    for (int i = 0; i < STROKE_CLASS_COUNT; i++)
        style.colours[i] = (colour){NAN, 0, 0, 1};
    style.colours[STROKE_CONTOUR] = (colour){0, 0, 0, 1};
    return style;
}

/* A stroke through points {x, y, depth}; `goes_on`: of the same chain as the one before. */
static stroke *add(const float (*positions)[3], uint32_t count, uint32_t hidden_by, bool goes_on)
{
    stroke *s = &d.strokes[d.set.stroke_count];
    float   arc = goes_on ? d.points[d.set.point_count - 1].arc : 0;
    assert_true(d.set.stroke_count < STROKES_MOST && d.set.point_count + count <= POINTS_MOST);
    if (!goes_on)
        d.set.chain_count++;
    *s = (stroke){.kind = STROKE_CONTOUR,
                  .part = (uint32_t)d.set.chain_count,
                  .piece = (uint32_t)d.set.chain_count,
                  .hidden_by = hidden_by,
                  .chain = (uint32_t)d.set.chain_count - 1,
                  .id = 77 * d.set.chain_count,
                  .first = (uint32_t)d.set.point_count,
                  .count = count};
    for (uint32_t i = 0; i < count; i++) {
        if (i > 0)
            arc += hypotf(positions[i][0] - positions[i - 1][0], positions[i][1] - positions[i - 1][1]);
        d.points[d.set.point_count++] = (stroke_point){positions[i][0], positions[i][1], positions[i][2], arc, 1};
    }
    for (size_t k = d.set.stroke_count + 1; k-- > 0 && d.strokes[k].chain == s->chain;)
        d.strokes[k].chain_length = arc;
    d.set.stroke_count++;
    return s;
}

static stroke *add_line(float x0, float y0, float x1, float y1, float depth, uint32_t hidden_by)
{
    const float ends[2][3] = {{x0, y0, depth}, {x1, y1, depth}};
    return add(ends, 2, hidden_by, false);
}

static stroke *add_circle(float x, float y, float radius, int pieces, uint32_t hidden_by)
{
    float positions[256][3];
    for (int i = 0; i <= pieces; i++) {
        double angle = 2 * 3.14159265358979 * (i % pieces) / pieces;
        positions[i][0] = x + radius * (float)cos(angle);
        positions[i][1] = y + radius * (float)sin(angle);
        positions[i][2] = 5;
    }
    stroke *s = add((const float(*)[3])positions, (uint32_t)pieces + 1, hidden_by, false);
    s->closed = true;
    return s;
}

static ribbon_set make_seeded(const stroke_style *style, uint32_t seed)
{
    ribbon_set out;
    lmn_error  error = {0};
    assert_int_equal(ribbons_make(&out, &d.set, style, seed, &error), LMN_OK);
    return out;
}

static ribbon_set make(const stroke_style *style)
{
    return make_seeded(style, 0);
}

static const ribbon_point *point_of(const ribbon_set *r, size_t ribbon_index, uint32_t i)
{
    return &r->points[r->ribbons[ribbon_index].first + i];
}

static const ribbon_point *end_of(const ribbon_set *r, size_t i)
{
    return point_of(r, i, r->ribbons[i].count - 1);
}

/* --- plain ---------------------------------------------------------------------------------------------- */

static void test_plain(void **state)
{
    const float  bent[4][3] = {{10, 10, 1}, {50, 10, 1}, {50, 40, 2}, {90, 80, 3}};
    stroke_style style = plain_style();
    (void)state;
    begin();
    add(bent, 4, 0, false);
    add_line(0, 0, 100, 0, 9, 2);
    d.strokes[0].kind = STROKE_CREASE;
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 2);
    assert_int_equal(r.ribbons[0].hidden_by, 2); /* what is visible lies on it */
    assert_float_equal(point_of(&r, 0, 0)->half, 0.5f, 1e-6);
    assert_true(r.ribbons[1].even && !r.ribbons[1].closed);
    assert_int_equal(r.ribbons[1].count, 4);
    assert_int_equal(r.ribbons[1].end, RIBBON_ROUND);
    for (uint32_t i = 0; i < 4; i++) {
        assert_float_equal(point_of(&r, 1, i)->x, bent[i][0], 1e-5);
        assert_float_equal(point_of(&r, 1, i)->y, bent[i][1], 1e-5);
        assert_float_equal(point_of(&r, 1, i)->depth, bent[i][2], 1e-5);
        assert_float_equal(point_of(&r, 1, i)->half, 0.5f,
                           1e-6); /* a crease: half of 2, and half the width to a side */
    }
    ribbon_set_release(&r);
    style.hidden = HIDDEN_NONE;
    r = make(&style);
    assert_int_equal(r.ribbon_count, 1);
    ribbon_set_release(&r);
    style.hidden = HIDDEN_SOLID;
    for (style.hidden_depth = 1; style.hidden_depth < 4; style.hidden_depth++) {
        r = make(&style);
        assert_int_equal(r.ribbon_count, style.hidden_depth < 2 ? 1 : 2);
        ribbon_set_release(&r);
    }
}

static void test_colours_and_fading(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    begin();
    for (uint32_t k = 0; k < 6; k++)
        add_line(0, 20 * (float)k, 50, 20 * (float)k, 5, k);
    style.colours[STROKE_CREASE] = (colour){1, 0.5f, 0, 1};
    d.strokes[0].kind = STROKE_CREASE;
    style.hidden_colour = (colour){0, 0, 1, 0.5f};
    style.hidden_fade = 0.5f;
    ribbon_set  r = make(&style);
    const float wanted[6] = {1, 1, 0.5f, 0.5f, 0.25f, 1}; /* behind 1 … 5 surfaces, then the visible one */
    for (size_t i = 0; i < 6; i++)
        assert_float_equal(point_of(&r, i, 0)->alpha, wanted[i], 1e-6);
    assert_float_equal(r.ribbons[0].ink.b, 1, 1e-6);
    assert_float_equal(r.ribbons[0].ink.a, 0.5f, 1e-6);
    assert_float_equal(r.ribbons[5].ink.r, 1, 1e-6);
    assert_float_equal(r.ribbons[5].ink.g, 0.5f, 1e-4);
    ribbon_set_release(&r);
}

/* --- dashes --------------------------------------------------------------------------------------------- */

static void test_dashes(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    begin();
    add_line(10, 10, 110, 10, 5, 0);
    style.dash = 7;
    style.gap = 4;
    ribbon_set r = make(&style);
    /* (100 + 4) / 11 rounds to 9 dashes; 9 · 7 + 8 · 4 = 95 is stretched to 100. */
    assert_int_equal(r.ribbon_count, 9);
    for (size_t i = 0; i < 9; i++) {
        assert_float_equal(point_of(&r, i, 0)->x, 10 + 11 * (float)i * 100 / 95, 1e-3);
        assert_float_equal(end_of(&r, i)->x, 10 + (11 * (float)i + 7) * 100 / 95, 1e-3);
        assert_int_equal(r.ribbons[i].end, RIBBON_BUTT);
    }
    ribbon_set_release(&r);
    /* What repeats stays where it was: the chain has grown at its beginning by 3. */
    d.strokes[0].phase = 3;
    ribbon_set moved = make(&style);
    assert_float_equal(point_of(&moved, 2, 0)->x + 3, 10 + 11.0f * 2 * 100 / 95, 1e-3);
    assert_float_equal(point_of(&moved, 0, 0)->x, 10, 1e-3);
    assert_float_equal(end_of(&moved, moved.ribbon_count - 1)->x, 110, 1e-3);
    ribbon_set_release(&moved);
    /* A gap longer than all of it. */
    d.strokes[0].phase = 0;
    style.gap = 500;
    r = make(&style);
    assert_int_equal(r.ribbon_count, 1);
    ribbon_set_release(&r);
}

/* A dashed line that stays whole: one ribbon, whose dashes are the ribbons that it would be. */
static void test_whole_dashes(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    for (int round = 0; round < 2; round++) {
        begin();
        if (round)
            add_circle(100, 100, 40, 120, 0);
        else
            add_line(10, 10, 110, 10, 5, 0);
        style.dash = 7;
        style.gap = 4;
        style.keeps_dashed = false;
        ribbon_set loose = make(&style);
        style.keeps_dashed = true;
        ribbon_set whole = make(&style);
        assert_int_equal(whole.ribbon_count, 1);
        assert_true(loose.ribbon_count > 3 && whole.ribbons[0].end == RIBBON_BUTT && whole.ribbons[0].even);
        assert_int_equal(whole.ribbons[0].dash_count, loose.ribbon_count);
        float begin = point_of(&whole, 0, 0)->arc;
        for (size_t i = 0; i < loose.ribbon_count; i++) {
            assert_int_equal(loose.ribbons[i].dash_count, 0);
            assert_float_equal(begin + whole.dashes[i][0], point_of(&loose, i, 0)->arc, 1e-3);
            assert_float_equal(begin + whole.dashes[i][1], end_of(&loose, i)->arc, 1e-3);
        }
        ribbon_set_release(&loose);
        ribbon_set_release(&whole);
    }
    style.taper = 20; /* what varies is drawn dash by dash */
    ribbon_set varied = make(&style);
    assert_true(varied.dash_count == 0 || varied.ribbons[0].even);
    ribbon_set_release(&varied);
}

static void test_closed_dashes(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    begin();
    add_circle(100, 100, 40, 120, 0);
    style.dash = 6;
    style.gap = 6;
    ribbon_set r = make(&style);
    float      length = d.strokes[0].chain_length, inked = 0;
    for (size_t i = 0; i < r.ribbon_count; i++)
        inked += end_of(&r, i)->arc - point_of(&r, i, 0)->arc;
    assert_float_equal(inked, length / 2, 0.02f * length); /* as much ink as gaps, all around */
    ribbon_set_release(&r);
    style.dash = 0;
    r = make(&style);
    assert_int_equal(r.ribbon_count, 1);
    assert_true(r.ribbons[0].closed);
    assert_float_equal(point_of(&r, 0, 0)->x, end_of(&r, 0)->x, 1e-6);
    ribbon_set_release(&r);
}

/* A chain that goes behind something: dashes there, which begin and end with ink where they meet the visible
 * stretches. */
static void test_hidden_dashes(void **state)
{
    const float one[2][3] = {{0, 0, 5}, {33, 0, 5}}, two[2][3] = {{33, 0, 5}, {151, 0, 5}},
                three[2][3] = {{151, 0, 5}, {200, 0, 5}};
    stroke_style style = plain_style();
    (void)state;
    style.hidden = HIDDEN_DASHED;
    style.hidden_dash = 8;
    style.hidden_gap = 5;
    begin();
    add(one, 2, 0, false);
    add(two, 2, 1, true);
    add(three, 2, 0, true);
    ribbon_set r = make(&style);
    assert_true(r.ribbon_count > 8);
    assert_float_equal(point_of(&r, 0, 0)->x, 33, 1e-4);
    assert_float_equal(end_of(&r, r.ribbon_count - 3)->x, 151, 1e-4);
    float before = -1;
    for (size_t i = 0; i < r.ribbon_count - 2; i++) {
        float from = point_of(&r, i, 0)->x, to = end_of(&r, i)->x;
        assert_true(r.ribbons[i].hidden_by == 1 && from > before + 2);
        assert_true(to - from >= 4 - 1e-3f); /* half a dash at least */
        before = to;
    }
    assert_float_equal(end_of(&r, r.ribbon_count - 1)->x, 200, 1e-4);
    ribbon_set_release(&r);
}

/* --- halos ---------------------------------------------------------------------------------------------- */

static void test_halos(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.halo = 3;
    begin();
    add_line(0, 50, 100, 50, 9, 0);  /* behind */
    add_line(40, 0, 40, 100, 2, 0);  /* passes in front */
    add_line(70, 0, 70, 100, 12, 1); /* passes behind, hidden */
    add_line(90, 20, 90, 48, 1, 0);  /* in front, and does not reach it */
    add_line(20, 0, 20, 100, 1, 1);  /* nearer, but hidden itself: nobody sees it */
    ribbon_set r = make(&style);
    float      ends[4] = {0};
    int        pieces = 0;
    for (size_t i = 0; i < r.ribbon_count; i++)
        if (r.ribbons[i].chain == 0 && pieces < 2) {
            ends[2 * pieces] = point_of(&r, i, 0)->x;
            ends[2 * pieces + 1] = end_of(&r, i)->x;
            pieces++;
        }
    assert_int_equal(pieces, 2);
    assert_float_equal(ends[1], 40 - 3 - 1, 1e-3); /* the gap beside the ink, which is 1 to a side */
    assert_float_equal(ends[2], 40 + 3 + 1, 1e-3);
    assert_float_equal(ends[3], 100, 1e-3);
    /* The hidden line stops short of the visible one in front of it, and of nothing else. */
    assert_int_equal(r.ribbons[0].chain, 2);
    assert_int_equal(r.ribbons[2].chain, 4);
    assert_float_equal(end_of(&r, 2)->y - point_of(&r, 2, 0)->y, 100, 1e-3);
    assert_float_equal(end_of(&r, 0)->y, 46, 1e-3);
    assert_float_equal(point_of(&r, 1, 0)->y, 54, 1e-3);
    ribbon_set_release(&r);
}

/* Gaps leave no crumbs between them. */
static void test_halo_crumbs(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.halo = 3;
    begin();
    add_line(0, 50, 100, 50, 9, 0);
    add_line(40, 0, 40, 100, 2, 0);
    add_line(49, 0, 49, 100, 2, 0); /* 36 … 44 and 45 … 53 */
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 4);
    assert_float_equal(end_of(&r, 0)->x, 36, 1e-3);
    assert_float_equal(point_of(&r, 1, 0)->x, 53, 1e-3);
    ribbon_set_release(&r);
}

/* A stroke that ends at what hides it. And the edges of a corner, which meet at one position and leave no gaps. */
static void test_halos_at_ends(void **state)
{
    const float corner[2][3] = {{200, 200, 5}, {260, 200, 7}}, other[2][3] = {{200, 200, 5}, {200, 260, 7}},
                third[2][3] = {{200, 200, 5}, {150, 150, 7}};
    stroke_style style = plain_style();
    (void)state;
    style.halo = 3;
    begin();
    add_line(0, 50, 39.2f, 50, 9, 0); /* ends up to a pixel before it */
    add_line(40, 0, 40, 100, 2, 0);
    add_line(40.8f, 70, 90, 70, 9, 0);
    add(corner, 2, 0, false);
    add(other, 2, 0, false);
    add(third, 2, 0, false);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 6);
    assert_float_equal(end_of(&r, 0)->x, 36, 1e-2);
    assert_float_equal(point_of(&r, 2, 0)->x, 44, 1e-2);
    for (size_t i = 1; i < 6; i += i == 1 ? 2 : 1)
        assert_float_equal(end_of(&r, i)->arc - point_of(&r, i, 0)->arc, d.strokes[i].chain_length, 1e-3);
    ribbon_set_release(&r);
}

/* Two lines that cross on the page, one from near to far: which is in front there depends on how depth runs between
 * its ends. */
static void test_halos_in_perspective(void **state)
{
    const float  deep[2][3] = {{0, 50, 1}, {100, 50, 9}};
    stroke_style style = plain_style();
    (void)state;
    style.halo = 3;
    begin();
    add(deep, 2, 0, false);         /* in the middle at depth 5, or in perspective at 2 / (1 + 1/9) = 1.8 */
    add_line(50, 0, 50, 100, 3, 0); /* between */
    for (int perspective = 0; perspective < 2; perspective++) {
        d.set.perspective = perspective;
        ribbon_set r = make(&style);
        assert_int_equal(r.ribbon_count, 3);
        assert_int_equal(r.ribbons[perspective ? 1 : 0].chain, perspective); /* the one that is cut has two pieces */
        assert_int_equal(r.ribbons[perspective ? 2 : 1].chain, perspective);
        ribbon_set_release(&r);
    }
}

/* --- hidden lines that crowd ---------------------------------------------------------------------------- */

static void test_crowds(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.hidden_crowd = 5;
    begin();
    for (int i = 0; i < 40; i++)
        add_line(0, 100 + (float)i, 200, 100 + (float)i, 5, 1 + (uint32_t)(i % 3));
    add_line(100, 0, 100, 300, 5, 1); /* runs across all, for the most part in the open */
    add_line(0, 280, 200, 280, 5, 3); /* alone */
    add_line(0, 60, 200, 60, 5, 0);   /* visible: stays, and so nothing is drawn beside it */
    add_line(0, 63, 200, 63, 5, 1);
    add_line(300, 20, 310, 20, 5, 1); /* a crumb, and what is just more */
    add_line(300, 40, 314, 40, 5, 1);
    for (int i = 1; i < 3; i++) /* of what is seen */
        d.strokes[d.set.stroke_count - (size_t)i].piece = d.strokes[d.set.stroke_count - 4].piece;
    ribbon_set r = make(&style);
    float      before = -100;
    int        left = 0;
    bool       across = false, alone = false, crumb = false, more = false;
    for (size_t i = 0; i < r.ribbon_count; i++) {
        const ribbon_point *a = point_of(&r, i, 0), *b = end_of(&r, i);
        across = across || (a->x == b->x && b->y - a->y > 100);
        crumb = crumb || (a->x == 300 && a->y == 20);
        more = more || (a->x == 300 && a->y == 40);
        alone = alone || (a->y == 280 && b->x - a->x == 200);
        assert_false(r.ribbons[i].hidden_by > 0 && a->y == 63 && b->y == 63);
        if (a->y != b->y || a->y < 90 || a->y > 150)
            continue;
        assert_true(a->y - before >= 5 - 1e-3f);     /* apart */
        assert_float_equal(b->x - a->x, 200, 1e-3);  /* and whole */
        assert_int_equal(r.ribbons[i].hidden_by, 1); /* the nearest */
        before = a->y;
        left++;
    }
    assert_in_range(left, 5, 8);
    assert_true(across && alone && more && !crumb);
    ribbon_set_release(&r);
}

/* A line that is crowded for a fraction of its length is left out as a whole, or not at all. */
static void check_turns(float length, bool stays)
{
    stroke_style style = plain_style();
    style.hidden_crowd = 5;
    begin();
    for (int i = 0; i < 20; i++)
        add_line(41 * (float)i, 100, 41 * (float)i + length + (float)(i % 3), 100, 5, 0);
    add_line(0, 102, 820, 102, 5, 1);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, stays ? 21 : 20);
    if (stays) {
        assert_true(fabsf(point_of(&r, 0, 0)->x) < 1e-3f);
        assert_true(fabsf(end_of(&r, 0)->x - 820) < 1e-3f);
    }
    ribbon_set_release(&r);
}

static void test_crowds_in_turns(void **state)
{
    (void)state;
    check_turns(8, true);
    check_turns(24, false);
}

/* What is left out crowds nothing: not with that part of it either that would lie free. */
static void test_what_is_gone_crowds_nothing(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.hidden_crowd = 5;
    begin();
    add_line(0, 100, 200, 100, 5, 0);
    add_line(0, 102, 300, 102, 5, 1);
    add_line(210, 104, 300, 104, 5, 2);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 2);
    assert_float_equal(point_of(&r, 0, 0)->y, 104, 1e-3);
    ribbon_set_release(&r);
}

/* Dashed lines go from corner to corner. */
static void test_crowds_to_corners(void **state)
{
    const float  bent[3][3] = {{0, 102, 5}, {200, 102, 5}, {200, 282, 5}};
    stroke_style style = plain_style();
    float        least = 300;
    (void)state;
    style.hidden = HIDDEN_DASHED;
    style.hidden_dash = 6;
    style.hidden_crowd = 5;
    begin();
    add_line(0, 100, 200, 100, 5, 0);
    add_line(150, 282, 250, 282, 5, 0); /* where the dashed one ends */
    add(bent, 3, 1, false)->kind = STROKE_CREASE;
    ribbon_set r = make(&style);
    assert_true(r.ribbon_count > 12);
    for (size_t i = 0; i < r.ribbon_count; i++)
        if (r.ribbons[i].hidden_by > 0) {
            assert_float_equal(point_of(&r, i, 0)->x, 200, 1e-3);
            least = fminf(least, point_of(&r, i, 0)->y);
        }
    assert_float_equal(least, 102, 1e-3);
    ribbon_set_release(&r);
}

/* What crowds leave of a hidden line is as long as any that says something, or it goes too: 34 pixels are too few for
 * four dashes. */
static void test_crowds_leave_no_crumbs(void **state)
{
    (void)state;
    for (int more = 0; more < 2; more++) {
        const float  end = more ? 150 : 136, bent[3][3] = {{0, 102, 5}, {30, 102, 5}, {30, end, 5}};
        stroke_style style = plain_style();
        style.hidden = HIDDEN_DASHED;
        style.hidden_dash = 6;
        style.hidden_crowd = 3;
        begin();
        add_line(0, 100, 30, 100, 5, 0);
        add_line(0, 90, 0, 110, 5, 0); /* where the dashed one begins, and where it ends */
        add_line(20, end, 40, end, 5, 0);
        add(bent, 3, 1, false)->kind = STROKE_CREASE;
        ribbon_set r = make(&style);
        assert_int_equal(r.ribbon_count > 3, more);
        ribbon_set_release(&r);
    }
}

/* A spring seen from the side: one chain whose windings crowd each other. */
static void test_spring(void **state)
{
    float        positions[1200][3];
    stroke_style style = plain_style();
    (void)state;
    begin();
    for (int i = 0; i < 1200; i++) {
        double angle = i * 0.2;
        positions[i][0] = 100 + 60 * (float)cos(angle);
        positions[i][1] = 50 + 2.0f * (float)(angle / 6.2831853); /* 2 pixels a winding, 38 windings */
        positions[i][2] = 5;
    }
    add((const float(*)[3])positions, 1200, 1, false);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 1);
    ribbon_set_release(&r);
    style.hidden_crowd = 6;
    r = make(&style);
    assert_int_equal(r.ribbon_count, 0); /* grey mud, or nothing */
    ribbon_set_release(&r);
}

/* --- the hand ------------------------------------------------------------------------------------------- */

static float position_at(const ribbon_set *r, uint32_t chain, float arc, float *y)
{
    for (size_t i = 0; i < r->ribbon_count; i++)
        for (uint32_t k = 0; r->ribbons[i].chain == chain && k + 1 < r->ribbons[i].count; k++) {
            const ribbon_point *a = point_of(r, i, k), *b = a + 1;
            if (arc < a->arc || arc > b->arc || !(b->arc > a->arc))
                continue;
            float t = (arc - a->arc) / (b->arc - a->arc);
            *y = a->y + t * (b->y - a->y);
            return a->x + t * (b->x - a->x);
        }
    return NAN;
}

static void test_wobble(void **state)
{
    const float  one[2][3] = {{0, 50, 5}, {90, 50, 5}}, two[2][3] = {{90, 50, 5}, {300, 50, 5}};
    stroke_style style = plain_style();
    (void)state;
    style.wobble = 3;
    begin();
    add_line(0, 50, 300, 50, 5, 0);
    ribbon_set whole = make(&style), other = make_seeded(&style, 1);
    float      most = 0, y = 0, other_y = 0, differ = 0;
    for (uint32_t i = 0; i < whole.ribbons[0].count; i++)
        most = fmaxf(most, fabsf(point_of(&whole, 0, i)->y - 50));
    assert_true(most > 1 && most <= 3);
    assert_true(whole.ribbons[0].count > 50 && whole.ribbons[0].even);
    /* The same line in two strokes: nothing moves, and they are drawn as one. */
    begin();
    add(one, 2, 0, false);
    add(two, 2, 0, true);
    ribbon_set cut = make(&style);
    assert_int_equal(cut.ribbon_count, 1);
    for (float arc = 1; arc < 300; arc += 7) {
        float x = position_at(&whole, 0, arc, &y), cut_x = position_at(&cut, 0, arc, &other_y);
        assert_float_equal(x, cut_x, 0.15);
        assert_float_equal(y, other_y, 0.15);
        position_at(&other, 0, arc, &other_y);
        differ = fmaxf(differ, fabsf(y - other_y));
    }
    assert_true(differ > 0.5f); /* another seed, another hand */
    ribbon_set_release(&whole);
    ribbon_set_release(&other);
    ribbon_set_release(&cut);
    /* Longer at its beginning by 45, and followed from there: the hand stays where it was. */
    begin();
    add_line(-45, 50, 300, 50, 5, 0);
    d.strokes[0].phase = -45;
    ribbon_set longer = make(&style);
    begin();
    add_line(0, 50, 300, 50, 5, 0);
    ribbon_set usual = make(&style);
    for (float arc = 1; arc < 300; arc += 7) {
        position_at(&usual, 0, arc, &y);
        position_at(&longer, 0, arc + 45, &other_y);
        assert_float_equal(y, other_y, 0.15);
    }
    ribbon_set_release(&longer);
    ribbon_set_release(&usual);
    begin();
    add_circle(100, 100, 40, 90, 0);
    d.strokes[0].phase = -20;
    ribbon_set round = make(&style);
    assert_true(round.ribbons[0].closed);
    const ribbon_point *a = point_of(&round, 0, 0), *b = end_of(&round, 0), *c = b - 1, *after = a + 1;
    assert_float_equal(a->x, b->x, 1e-5);
    assert_true((b->x - c->x) * (after->x - a->x) + (b->y - c->y) * (after->y - a->y) >
                0); /* no kink where it closes */
    ribbon_set_release(&round);
}

static void test_overshoot(void **state)
{
    float        arc[40][3];
    stroke_style style = plain_style();
    (void)state;
    style.overshoot = 10;
    begin();
    add_line(50, 50, 150, 50, 5, 0);
    add_line(50, 80, 150, 80, 5, 1);
    add_line(50, 90, 58, 90, 5, 0); /* short: runs on less */
    for (int i = 0; i < 40; i++) {
        arc[i][0] = 200 + 8 * cosf((float)i * 0.1f);
        arc[i][1] = 200 + 8 * sinf((float)i * 0.1f);
        arc[i][2] = 5;
    }
    add((const float(*)[3])arc, 40, 0, false);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 4);
    assert_float_equal(point_of(&r, 0, 0)->x, 50, 1e-4); /* the hidden one */
    assert_true(point_of(&r, 1, 0)->x <= 45 + 1e-3f && point_of(&r, 1, 0)->x >= 40 - 1e-3f);
    assert_true(end_of(&r, 1)->x >= 155 - 1e-3f && end_of(&r, 1)->x <= 160 + 1e-3f);
    assert_float_equal(point_of(&r, 1, 0)->y, 50, 1e-4);
    assert_true(end_of(&r, 2)->x > 58 && end_of(&r, 2)->x < 62);
    assert_float_equal(point_of(&r, 3, 0)->x, 208, 1e-4); /* bent */
    ribbon_set_release(&r);
}

static void test_widths(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.taper = 30;
    begin();
    add_line(0, 50, 200, 50, 5, 0);
    add_circle(100, 150, 40, 60, 0);
    ribbon_set r = make(&style);
    assert_false(r.ribbons[0].even);
    assert_true(r.ribbons[1].even); /* has no ends */
    assert_true(point_of(&r, 0, 0)->half < 0.2f && end_of(&r, 0)->half < 0.2f);
    float before = 0;
    for (uint32_t i = 0; i < r.ribbons[0].count && point_of(&r, 0, i)->arc <= 30; i++) {
        assert_true(point_of(&r, 0, i)->half >= before);
        before = point_of(&r, 0, i)->half;
    }
    assert_float_equal(before, 1, 1e-4);
    ribbon_set_release(&r);
    style.taper = 0;
    style.pressure = 1;
    r = make(&style);
    float least = 10, most = 0;
    for (uint32_t i = 0; i < r.ribbons[0].count; i++) {
        least = fminf(least, point_of(&r, 0, i)->half);
        most = fmaxf(most, point_of(&r, 0, i)->half);
    }
    assert_true(least >= 0.5f && most <= 1.5f && most - least > 0.2f);
    ribbon_set_release(&r);
    /* Lines that are not sure of themselves: a pen gets thin, a pencil faint. */
    style.pressure = 0;
    d.points[0].weight = 0;
    r = make(&style);
    assert_float_equal(point_of(&r, 0, 0)->half, 0, 1e-6);
    assert_float_equal(end_of(&r, 0)->alpha, 1, 1e-6);
    ribbon_set_release(&r);
    style.brush = BRUSH_PENCIL;
    r = make(&style);
    assert_float_equal(point_of(&r, 0, 0)->half, 1, 1e-6);
    assert_float_equal(point_of(&r, 0, 0)->alpha, 0, 1e-6);
    ribbon_set_release(&r);
}

/* --- as a hand draws ------------------------------------------------------------------------------------ */

static stroke_style hand_style(void)
{
    stroke_style style = plain_style();
    style.repeats = 4;
    style.repeat_apart = 4;
    style.repeat_turn = 3;
    return style;
}

static float slope_of(const ribbon_set *r, size_t i)
{
    const ribbon_point *a = point_of(r, i, 0), *b = end_of(r, i);
    return (b->y - a->y) / (b->x - a->x);
}

static void test_repeats(void **state)
{
    stroke_style style = hand_style();
    (void)state;
    begin();
    add_line(0, 50, 200, 50, 5, 0);
    add_line(0, 90, 200, 90, 5, 1);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 1 + 4);
    float apart = 0;
    for (size_t i = 1; i < 5; i++) {
        for (uint32_t k = 0; k < r.ribbons[i].count; k++) {
            assert_true(fabsf(point_of(&r, i, k)->y - 50) <= 1.5f * 4);
            apart = fmaxf(apart, fabsf(point_of(&r, i, k)->y - 50));
        }
        /* No two are parallel, neighbours lean to different sides and so cross; none turns by more than it may. */
        assert_true(fabsf(slope_of(&r, i)) <= tanf(3 * 3.14159265f / 180) + 1e-3f);
        for (size_t k = i + 1; k < 5; k++)
            assert_true(fabsf(slope_of(&r, i) - slope_of(&r, k)) > 1e-4f);
        if (i > 1)
            assert_true(slope_of(&r, i) * slope_of(&r, i - 1) < 0);
    }
    assert_true(apart > 1);
    ribbon_set_release(&r);
    /* Ends of their own: some fall short while others run on. */
    float least = 1e9f, most = -1e9f;
    for (uint32_t seed = 0; seed < 4; seed++) {
        r = make_seeded(&style, seed);
        for (size_t i = 1; i < 5; i++) {
            least = fminf(least, fminf(end_of(&r, i)->x - 200, -point_of(&r, i, 0)->x));
            most = fmaxf(most, fmaxf(end_of(&r, i)->x - 200, -point_of(&r, i, 0)->x));
        }
        ribbon_set_release(&r);
    }
    assert_true(least < -0.5f && most > 1);
}

/* Copies that follow each other are not on top of each other: also in the middle, where they lean to both sides of it,
 * most lie apart. */
static void test_repeats_lie_apart(void **state)
{
    stroke_style style = hand_style();
    double       apart = 0;
    int          count = 0, close = 0;
    (void)state;
    style.wobble = 0;
    style.repeat_turn = 0;
    begin();
    add_line(0, 50, 200, 50, 5, 0);
    for (uint32_t seed = 0; seed < 32; seed++) {
        ribbon_set r = make_seeded(&style, seed);
        for (size_t i = 1; i + 1 < r.ribbon_count; i++, count++) {
            float one = 0.5f * (point_of(&r, i, 0)->y + end_of(&r, i)->y),
                  other = 0.5f * (point_of(&r, i + 1, 0)->y + end_of(&r, i + 1)->y);
            apart += fabs((double)one - (double)other);
            close += fabsf(one - other) < 0.15f * style.repeat_apart;
        }
        ribbon_set_release(&r);
    }
    assert_true(count == 32 * 2);
    assert_true(apart / count > 0.4 * (double)style.repeat_apart);
    assert_true(close * 20 < count);
}

/* Corners are run past by a hand as it happens: some not at all, most a little, a few far. */
static void test_corners_are_run_past_unevenly(void **state)
{
    stroke_style style = hand_style();
    int          met = 0, little = 0, far = 0;
    (void)state;
    style.wobble = style.repeat_apart = 0;
    style.repeats = 1;
    style.pull = 400;
    style.overshoot = 10;
    style.overshoot_most = 0;
    begin();
    add_line(0, 50, 200, 50, 5, 0);
    for (uint32_t seed = 0; seed < 200; seed++) {
        ribbon_set r = make_seeded(&style, seed);
        float      by = end_of(&r, 0)->x - 200;
        assert_true(by > -1e-3f && by <= 16 + 1e-3f);
        met += by < 0.1f;
        little += by >= 0.1f && by < 8;
        far += by >= 11;
        ribbon_set_release(&r);
    }
    assert_true(met > 30 && met < 70);
    assert_true(little > 60);
    assert_true(far > 20 && far < 70);
}

static void test_short_lines_are_drawn_once(void **state)
{
    stroke_style style = hand_style();
    (void)state;
    style.repeat_least = 30;
    begin();
    add_line(0, 50, 29, 50, 5, 0);
    add_line(0, 90, 61, 90, 5, 0);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 1 + 4);
    assert_true(fabsf(slope_of(&r, 0)) <= tanf(3 * 3.14159265f / 180));
    ribbon_set_release(&r);
}

/* A hand stops at corners, and runs past each by a fraction of what it has drawn. */
static void test_corners(void **state)
{
    static const float square[5][3] = {{50, 80, 5}, {50, 50, 5}, {110, 50, 5}, {110, 80, 5}, {50, 80, 5}};
    static const float angle[3][3] = {{200, 50, 5}, {280, 50, 5}, {280, 70, 5}};
    stroke_style       style = plain_style();
    (void)state;
    style.overshoot = 30;
    style.overshoot_most = 0.1f;
    begin();
    add(square, 5, 0, false)->closed = true;
    add(angle, 3, 0, false);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 4 + 2);
    for (size_t i = 0; i < r.ribbon_count; i++) {
        const ribbon_point *a = point_of(&r, i, 0), *b = end_of(&r, i);
        float               length = hypotf(b->x - a->x, b->y - a->y), own = i == 5                    ? 20
                                                                             : i == 4                  ? 80
                                                                             : fabsf(b->x - a->x) > 40 ? 60
                                                                                                       : 30;
        assert_false(r.ribbons[i].closed);
        assert_true(a->x == b->x || a->y == b->y); /* one side, straight on beyond its corners */
        assert_float_equal(length, 1.2f * own, 1e-3f * own);
    }
    ribbon_set_release(&r);
}

/* Circles have no corner: each copy begins elsewhere, goes all the way round, and its ends miss each other. */
static void test_circles(void **state)
{
    stroke_style style = hand_style();
    (void)state;
    begin();
    add_circle(100, 100, 40, 90, 0);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 4);
    for (size_t i = 0; i < 4; i++) {
        const ribbon_point *a = point_of(&r, i, 0), *b = end_of(&r, i);
        assert_false(r.ribbons[i].closed);
        assert_true(b->arc - a->arc > 2 * 3.1415f * 40 && b->arc - a->arc < 1.2f * 2 * 3.1416f * 40);
        for (uint32_t k = 0; k + 1 < r.ribbons[i].count; k++) {
            const ribbon_point *p = point_of(&r, i, k);
            assert_true(fabsf(hypotf(p->x - 100, p->y - 100) - 40) < 1.5f * 4);
            assert_true(hypotf(p[1].x - p->x, p[1].y - p->y) < 4);
        }
        /* At the angle where it began it comes by again, elsewhere. */
        float gap = 1e9f;
        for (uint32_t k = r.ribbons[i].count / 2; k < r.ribbons[i].count; k++)
            gap = fminf(gap, hypotf(point_of(&r, i, k)->x - a->x, point_of(&r, i, k)->y - a->y));
        assert_true(gap > 0.2f);
    }
    float first = atan2f(point_of(&r, 0, 0)->y - 100, point_of(&r, 0, 0)->x - 100),
          second = atan2f(point_of(&r, 1, 0)->y - 100, point_of(&r, 1, 0)->x - 100);
    assert_true(cosf(first - second) < cosf(0.2f));
    ribbon_set_release(&r);
}

/* Long curves take several pulls, each beginning before the one before it ends; straight lines one. */
static void test_pulls(void **state)
{
    float        arc[80][3];
    stroke_style style = plain_style();
    (void)state;
    style.pull = 60;
    style.repeat_apart = 2;
    for (int i = 0; i < 80; i++) {
        arc[i][0] = 200 + 150 * cosf((float)i * 0.02f);
        arc[i][1] = 200 + 150 * sinf((float)i * 0.02f);
        arc[i][2] = 5;
    }
    begin();
    add_line(0, 300, 237, 300, 5, 0);
    add((const float(*)[3])arc, 80, 0, false); /* 237 long */
    ribbon_set r = make(&style);
    assert_true(r.ribbon_count >= 1 + 4 && r.ribbon_count <= 1 + 5);
    for (size_t i = 2; i < r.ribbon_count; i++) {
        assert_true(point_of(&r, i, 0)->arc < end_of(&r, i - 1)->arc - 1);
        assert_true(point_of(&r, i, 0)->arc > point_of(&r, i - 1, 0)->arc + 20);
    }
    assert_float_equal(point_of(&r, 1, 0)->arc, 0, 1e-4);
    assert_float_equal(end_of(&r, r.ribbon_count - 1)->arc, 237, 0.2);
    ribbon_set_release(&r);
}

/* Where lines run side by side a hand draws each once, and true; lines that cross it do not matter. */
static void test_hand_beside_others(void **state)
{
    (void)state;
    for (int mode = 0; mode < 3; mode++) { /* alone, beside others, among lines that cross it */
        stroke_style style = plain_style();
        size_t       copies = 0;
        float        off = 0;
        style.repeats = 4;
        style.repeat_apart = 4;
        style.repeat_least = 20;
        begin();
        add_line(0, 100, 300, 100, 5, 0);
        for (int i = 0; i < 20; i++) {
            if (mode == 1 && i < 2)
                add_line(0, 96 + 8 * (float)i, 300, 96 + 8 * (float)i, 5, 0);
            if (mode == 2)
                add_line(5 + 15 * (float)i, 50, 5 + 15 * (float)i, 150, 5, 0);
        }
        ribbon_set r = make(&style);
        for (size_t i = 0; i < r.ribbon_count; i++)
            for (uint32_t k = 0; r.ribbons[i].chain == 0 && k < r.ribbons[i].count; k++) {
                copies += k == 0;
                off = fmaxf(off, fabsf(point_of(&r, i, k)->y - 100));
            }
        assert_int_equal(copies, mode == 1 ? 1 : 4);
        assert_true(mode == 1 ? off < 0.5f : off > 1);
        ribbon_set_release(&r);
    }
}

/* Ends of lines side by side would make a hedge where all of them run on. */
static void test_no_hedges(void **state)
{
    (void)state;
    float beyond[3];
    for (int mode = 0; mode < 3; mode++) { /* alone, between two others, and with these farther away */
        stroke_style style = plain_style();
        float        apart = mode == 1 ? 6 : 16;
        style.overshoot = 10;
        begin();
        add_line(50, 100, 150, 100, 5, 0);
        for (int side = -1; side <= 1 && mode > 0; side += 2)
            add_line(50, 100 + (float)side * apart, 150, 100 + (float)side * apart, 5, 0);
        ribbon_set r = make(&style);
        beyond[mode] = end_of(&r, 0)->x - 150;
        ribbon_set_release(&r);
    }
    assert_true(beyond[0] >= 5 && beyond[0] <= 10);
    assert_true(beyond[1] >= 0 && beyond[1] < 0.15f * beyond[0]);
    assert_true(beyond[2] > 0.5f * beyond[0] && beyond[2] < 0.95f * beyond[0]);
}

/* --- hostile -------------------------------------------------------------------------------------------- */

static void everything(stroke_style *style)
{
    *style = plain_style();
    style->hidden = HIDDEN_DASHED;
    style->hidden_dash = 6;
    style->dash = 9;
    style->gap = 4;
    style->halo = 3;
    style->hidden_crowd = 4;
    style->wobble = 2;
    style->taper = 10;
    style->pressure = 0.5f;
    style->overshoot = 5;
    style->repeats = 2;
    style->repeat_apart = 2;
    style->repeat_turn = 3;
    style->repeat_fade = 0.8f;
    style->pull = 40;
}

static void test_hostile(void **state)
{
    stroke_style style;
    (void)state;
    everything(&style);
    begin();
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 0);
    ribbon_set_release(&r);
    add_line(0, 50, 200, 50, 5, 0);
    add_line(NAN, 50, 200, 50, 5, 0);
    add_line(0, INFINITY, 200, 50, 5, 1);
    add_line(0, 60, 3e30f, 60, 5, 1);
    add_line(7, 7, 7, 7, 5, 0);
    add_line(0, 70, 200, 70, NAN, 1);
    d.points[1].weight = NAN;
    r = make(&style);
    for (size_t i = 0; i < r.point_count; i++)
        assert_true(isfinite(r.points[i].x) && isfinite(r.points[i].y) && isfinite(r.points[i].half) &&
                    isfinite(r.points[i].alpha));
    assert_true(r.ribbon_count > 0);
    ribbon_set_release(&r);
}

static void test_out_of_memory(void **state)
{
    stroke_style style;
    lmn_status   status = LMN_MEMORY;
    (void)state;
    everything(&style);
    begin();
    for (int i = 0; i < 12; i++) {
        add_line(0, 20 + 3 * (float)i, 200, 25 + 3 * (float)i, 9, (uint32_t)i % 3);
        add_line(20 * (float)i, 0, 20 * (float)i + 5, 100, 5, 0);
    }
    ribbon_set good = make(&style);
    long       n = 1;
    for (; status != LMN_OK && n < 10000; n++) {
        ribbon_set r;
        lmn_error  error = {0};
        mem_fail_at(n);
        status = ribbons_make(&r, &d.set, &style, 0, &error);
        mem_fail_at(0);
        if (status == LMN_OK) {
            assert_int_equal(r.ribbon_count, good.ribbon_count);
            assert_memory_equal(r.points, good.points, good.point_count * sizeof *good.points);
        } else {
            assert_int_equal(status, LMN_MEMORY);
            assert_null(r.ribbons);
            assert_null(r.points);
        }
        ribbon_set_release(&r);
    }
    assert_in_range(n, 10, 9999);
    ribbon_set_release(&good);
}

/* --- where lines meet ----------------------------------------------------------------------------------- */

static float half_at_end(const ribbon_set *r, uint32_t chain, bool at_end)
{
    for (size_t i = 0; i < r->ribbon_count; i++)
        if (r->ribbons[i].chain == chain)
            return at_end ? end_of(r, i)->half : point_of(r, i, 0)->half;
    return NAN;
}

/* Three lines from one corner keep their width there and run out at their other ends. */
static void test_nodes(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.taper = 20;
    begin();
    add_line(100, 100, 200, 100, 5, 0);
    add_line(100, 100, 50, 180, 5, 0)->kind = STROKE_CREASE;
    add_line(60, 20, 100, 100, 5, 0)->kind = STROKE_CREASE;
    ribbon_set r = make(&style);
    assert_float_equal(half_at_end(&r, 0, false), 1, 1e-3);
    assert_float_equal(half_at_end(&r, 1, false), 0.5f, 1e-3);
    assert_float_equal(half_at_end(&r, 2, true), 0.5f, 1e-3);
    assert_true(half_at_end(&r, 0, true) < 0.2f && half_at_end(&r, 1, true) < 0.1f && half_at_end(&r, 2, false) < 0.1f);
    ribbon_set_release(&r);
}

/* An outline that goes on as a finer crease thins out to that. */
static void test_outline_into_crease(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.taper = 20;
    begin();
    add_line(0, 50, 100, 50, 5, 0);
    add_line(100, 50, 200, 52, 5, 0)->kind = STROKE_CREASE;
    ribbon_set r = make(&style);
    assert_float_equal(half_at_end(&r, 0, true), 0.5f, 1e-2);
    assert_float_equal(half_at_end(&r, 1, false), 0.5f, 1e-3);
    ribbon_set_release(&r);
}

/* A line that stops a little before the axis of the one that hides it runs on to it; with halos it stops before. */
static void test_junctions(void **state)
{
    stroke_style style = plain_style();
    (void)state;
    style.taper = 20;
    begin();
    add_line(0, 50, 98.5f, 50, 9, 0);
    add_line(100, 0, 100, 100, 2, 0);
    add_line(0, 80, 90, 80, 9, 0); /* too far from it */
    ribbon_set r = make(&style);
    assert_float_equal(end_of(&r, 0)->x, 100, 1e-3);
    assert_float_equal(end_of(&r, 0)->half, 1, 1e-3);
    assert_float_equal(end_of(&r, 2)->x, 90, 1e-3);
    assert_true(end_of(&r, 2)->half < 0.2f);
    ribbon_set_release(&r);
    style.halo = 4;
    r = make(&style);
    assert_float_equal(end_of(&r, 0)->x, 95, 1e-2);
    ribbon_set_release(&r);
}

/* Lines that run side by side, one a little nearer, do not cross: halos leave them whole. */
static void test_halos_beside(void **state)
{
    float        wavy[64][3];
    stroke_style style = plain_style();
    (void)state;
    style.halo = 4;
    for (int i = 0; i < 64; i++) {
        wavy[i][0] = 5.0f * (float)i;
        wavy[i][1] = 50 + (i % 2 ? 0.2f : -0.2f);
        wavy[i][2] = 5;
    }
    begin();
    add((const float(*)[3])wavy, 64, 0, false);
    add_line(-100, 50, 400, 50, 4, 0);
    add_line(20, 10, 20, 20, 60, 0);
    ribbon_set r = make(&style);
    assert_int_equal(r.ribbon_count, 3);
    assert_float_equal(end_of(&r, 0)->arc - point_of(&r, 0, 0)->arc, d.strokes[0].chain_length, 1e-3);
    ribbon_set_release(&r);
}

/* Dashes turn corners with ink to both sides, and are never shorter than two widths. */
static void test_dashes_at_corners(void **state)
{
    const float  bent[3][3] = {{0, 0, 5}, {47, 0, 5}, {47, 90, 5}};
    stroke_style style = plain_style();
    (void)state;
    style.dash = 1;
    style.gap = 3;
    begin();
    add(bent, 3, 0, false);
    ribbon_set r = make(&style);
    bool       turned = false;
    for (size_t i = 0; i < r.ribbon_count; i++) {
        float from = point_of(&r, i, 0)->arc, to = end_of(&r, i)->arc;
        assert_true(to - from >= 4 * 0.8f); /* the pattern is stretched by less than that */
        turned = turned || (from < 47 - 3 && to > 47 + 3);
    }
    assert_true(turned && r.ribbon_count > 12);
    ribbon_set_release(&r);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_nodes),
                                       cmocka_unit_test(test_outline_into_crease),
                                       cmocka_unit_test(test_junctions),
                                       cmocka_unit_test(test_halos_beside),
                                       cmocka_unit_test(test_dashes_at_corners),
                                       cmocka_unit_test(test_plain),
                                       cmocka_unit_test(test_colours_and_fading),
                                       cmocka_unit_test(test_dashes),
                                       cmocka_unit_test(test_whole_dashes),
                                       cmocka_unit_test(test_closed_dashes),
                                       cmocka_unit_test(test_hidden_dashes),
                                       cmocka_unit_test(test_halos),
                                       cmocka_unit_test(test_halos_at_ends),
                                       cmocka_unit_test(test_halo_crumbs),
                                       cmocka_unit_test(test_crowds_in_turns),
                                       cmocka_unit_test(test_what_is_gone_crowds_nothing),
                                       cmocka_unit_test(test_crowds_to_corners),
                                       cmocka_unit_test(test_crowds_leave_no_crumbs),
                                       cmocka_unit_test(test_halos_in_perspective),
                                       cmocka_unit_test(test_crowds),
                                       cmocka_unit_test(test_spring),
                                       cmocka_unit_test(test_wobble),
                                       cmocka_unit_test(test_overshoot),
                                       cmocka_unit_test(test_widths),
                                       cmocka_unit_test(test_repeats),
                                       cmocka_unit_test(test_repeats_lie_apart),
                                       cmocka_unit_test(test_corners_are_run_past_unevenly),
                                       cmocka_unit_test(test_short_lines_are_drawn_once),
                                       cmocka_unit_test(test_corners),
                                       cmocka_unit_test(test_circles),
                                       cmocka_unit_test(test_pulls),
                                       cmocka_unit_test(test_hostile),
                                       cmocka_unit_test(test_out_of_memory),
                                       cmocka_unit_test(test_hand_beside_others),
                                       cmocka_unit_test(test_no_hedges)};
    return cmocka_run_group_tests_name("ribbon", tests, NULL, NULL);
}
