/* Curves through the points of paths: no farther from the lines than is said, held against dense samples of both; few
 * pieces where few are enough; corners and straight lines as they are. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "base/memory.h"
#include "sheet/fit.h"

#define PI 3.14159265358979323846
enum { CHAINS = 1000, POINTS_MOST = 600, SAMPLES_MOST = 6000 };

typedef struct chain {
    float    points[POINTS_MOST][2];
    uint32_t count;
    bool     closed;
} chain;

static uint32_t random_state = 12345;

static double number(double low, double high)
{
    random_state = random_state * 1664525u + 1013904223u;
    return low + (high - low) * (random_state >> 8) / 16777216;
}

static void put(chain *c, double x, double y)
{
    if (c->count == POINTS_MOST)
        return;
    c->points[c->count][0] = (float)x;
    c->points[c->count++][1] = (float)y;
}

/* --- random chains: whatever lines may be made of, one behind the other --------------------------------- */

typedef struct pen {
    double x, y, direction;
} pen;

static void bend(chain *c, pen *p, double length, double from, double to, int steps, double noise)
{
    for (int i = 0; i < steps; i++) {
        double turn = from + (to - from) * i / steps;
        p->direction += turn * length / steps;
        p->x += length / steps * cos(p->direction);
        p->y += length / steps * sin(p->direction);
        put(c, p->x + number(-noise, noise), p->y + number(-noise, noise));
    }
}

static void make_chain(chain *c, double error)
{
    pen p = {number(0, 50), number(0, 50), number(0, 2 * PI)};
    *c = (chain){.closed = number(0, 1) < 0.2};
    put(c, p.x, p.y);
    int pieces = 1 + (int)number(0, 5);
    for (int i = 0; i < pieces; i++) {
        double length = number(0.1, 2.5), noise = number(0, 1) < 0.3 ? number(0, 2) * error : 0, bent = number(-4, 4);
        int    steps = 1 + (int)number(0, number(0, 1) < 0.5 ? 8 : 60);
        switch ((int)number(0, 6)) {
        case 0: bend(c, &p, length, 0, 0, steps, noise); break;
        case 1: bend(c, &p, length, bent, bent, steps, noise); break;
        case 2: bend(c, &p, length, bent, number(-4, 4), steps, noise); break;
        case 3: p.direction += number(-PI, PI); break;
        case 4: /* to and fro */
            bend(c, &p, length / 4, 0, 0, 2, 0);
            p.direction += PI;
            bend(c, &p, length / 5, 0, 0, 2, 0);
            break;
        default: /* the same point again, and a jump */
            put(c, p.x, p.y);
            p.x += number(-1, 1);
            p.y += number(-1, 1);
            put(c, p.x, p.y);
        }
    }
    if (number(0, 1) < 0.2) { /* a whole ellipse */
        double wide = number(0.05, 1), high = number(0.05, 1), turn = number(0, PI);
        int    steps = 5 + (int)number(0, 80);
        c->count = 0;
        c->closed = true;
        for (int i = 0; i < steps; i++) {
            double x = wide * cos(2 * PI * i / steps), y = high * sin(2 * PI * i / steps);
            put(c, p.x + cos(turn) * x - sin(turn) * y, p.y + sin(turn) * x + cos(turn) * y);
        }
    }
}

/* --- the reference -------------------------------------------------------------------------------------- */

static double (*curve)[2], (*lines)[2];
static size_t curve_count, line_count;
static double sampled_off; /* that samples of arcs are off them, between two */

static void sample(double (*to)[2], size_t *count, double x, double y)
{
    assert_true(*count < SAMPLES_MOST);
    to[*count][0] = x;
    to[(*count)++][1] = y;
}

/* A piece at a fraction, by formulas of its own: the angle of an arc is added to that of its turn as matrices, cubics
 * are divided. */
static void at(const sheet_piece *p, const double from[2], double u, double out[2])
{
    double line[2][2] = {{from[0], from[1]}, {p->end[0], p->end[1]}};
    if (p->kind == SHEET_ARC) {
        double angle = p->from + u * p->sweep, a[2] = {p->radii[0] * cos(p->turn), p->radii[0] * sin(p->turn)},
               b[2] = {-p->radii[1] * sin(p->turn), p->radii[1] * cos(p->turn)};
        for (int k = 0; k < 2; k++)
            out[k] = p->centre[k] + cos(angle) * a[k] + sin(angle) * b[k];
        return;
    }
    for (int k = 0; k < 2; k++) {
        double q[4] = {from[k], p->controls[0][k], p->controls[1][k], p->end[k]};
        if (p->kind == SHEET_LINE) {
            out[k] = line[0][k] + u * (line[1][k] - line[0][k]);
            continue;
        }
        for (int left = 3; left > 0; left--)
            for (int i = 0; i < left; i++)
                q[i] += u * (q[i + 1] - q[i]);
        out[k] = q[0];
    }
}

static double extent_of(const sheet_piece *p, const double from[2])
{
    double sum = 0, before[2] = {from[0], from[1]}, now[2];
    for (int i = 1; i <= 16; i++, memcpy(before, now, sizeof before)) {
        at(p, from, i / 16.0, now);
        sum += hypot(now[0] - before[0], now[1] - before[1]);
    }
    return sum;
}

/* Samples so far apart of the path's curve and of its lines; the curve must hang together. */
static void sample_path(const sheet *s, double apart)
{
    const sheet_path *path = &s->paths[0];
    const float(*points)[2] = (const float(*)[2])s->points + path->first;
    double from[2] = {(double)points[0][0], (double)points[0][1]}, there[2];
    curve_count = line_count = 0;
    sampled_off = 1e-6;
    sample(curve, &curve_count, from[0], from[1]);
    for (uint32_t i = 0; i < path->piece_count; i++) {
        const sheet_piece *p = &s->pieces[path->first_piece + i];
        int                steps = 1 + (int)(extent_of(p, from) / apart);
        if (p->kind == SHEET_ARC)
            sampled_off = fmax(sampled_off, fmax(p->radii[0], p->radii[1]) * pow(p->sweep / steps, 2) / 8);
        at(p, from, 0, there);
        assert_true(hypot(there[0] - from[0], there[1] - from[1]) < 1e-5);
        at(p, from, 1, there);
        assert_true(hypot(there[0] - p->end[0], there[1] - p->end[1]) < 1e-5);
        for (int k = 1; k <= steps; k++) {
            at(p, from, (double)k / steps, there);
            sample(curve, &curve_count, there[0], there[1]);
        }
        memcpy(from, p->end, sizeof from);
    }
    uint32_t last = path->closed ? 0 : path->count - 1;
    assert_true(hypot(from[0] - (double)points[last][0], from[1] - (double)points[last][1]) < 1e-5);
    for (uint32_t i = 0; i < path->count - !path->closed; i++) {
        const float *a = points[i], *b = points[(i + 1) % path->count];
        int          steps = 1 + (int)((double)hypotf(b[0] - a[0], b[1] - a[1]) / apart);
        for (int k = 0; k <= steps; k++)
            sample(lines, &line_count, (double)a[0] + (double)(b[0] - a[0]) * k / steps,
                   (double)a[1] + (double)(b[1] - a[1]) * k / steps);
    }
}

/* The farthest that samples of one are from the other. */
static double farthest(const double (*from)[2], size_t count, const double (*to)[2], size_t to_count)
{
    double most = 0;
    for (size_t i = 0; i < count; i++) {
        double least = INFINITY;
        for (size_t k = 0; k + 1 < to_count && least > most * most; k++) {
            double x = to[k + 1][0] - to[k][0], y = to[k + 1][1] - to[k][1], square = x * x + y * y,
                   px = from[i][0] - to[k][0], py = from[i][1] - to[k][1];
            double u = square > 0 ? fmin(fmax((px * x + py * y) / square, 0), 1) : 0;
            px -= u * x;
            py -= u * y;
            least = fmin(least, px * px + py * py);
        }
        most = fmax(most, sqrt(least));
    }
    return most;
}

static void fit_chain(sheet *s, const chain *c, double error)
{
    sheet_begin(s, 100, 100, 4);
    sheet_add_item(s, SHEET_PATH, 0, (colour){0, 0, 0, 1}, 0);
    sheet_add_path(s, &(sheet_path){.width = 0.3f, .curved = true, .closed = c->closed}, (const float(*)[2])c->points,
                   c->count);
    sheet_fit(s, error);
    assert_false(s->failed);
}

static void nowhere_farther_than_said(void **state)
{
    static chain c;
    size_t       pieces = 0, points = 0, fitted = 0;
    double       worst = 0;
    (void)state;
    curve = mem_alloc(SAMPLES_MOST * sizeof *curve);
    lines = mem_alloc(SAMPLES_MOST * sizeof *lines);
    for (int i = 0; i < CHAINS; i++) {
        double error = number(0, 1) < 0.5 ? 0.02 : number(0.008, 0.1);
        sheet  s;
        make_chain(&c, error);
        fit_chain(&s, &c, error);
        if (s.path_count && s.paths[0].piece_count) {
            sample_path(&s, error / 2);
            double there = farthest((const double(*)[2])curve, curve_count, (const double(*)[2])lines, line_count),
                   back = farthest((const double(*)[2])lines, line_count, (const double(*)[2])curve, curve_count);
            worst = fmax(worst, fmax(there, back) / error);
            if (fmax(there, back) > error + sampled_off)
                fail_msg("chain %d: %.5f and %.5f apart, allowed %.5f", i, there, back, error);
            pieces += s.paths[0].piece_count;
            points += s.paths[0].count;
            fitted++;
        }
        sheet_release(&s);
    }
    print_message("%zu chains, %zu points in %zu pieces, at worst %.3f of the error\n", fitted, points, pieces, worst);
    assert_true(fitted > CHAINS * 9 / 10 && points > 3 * pieces);
    mem_free(curve);
    mem_free(lines);
}

/* --- few pieces, and the right ones --------------------------------------------------------------------- */

static void check_piece(const sheet_piece *p, sheet_piece_kind kind, double wide, double high, double slack)
{
    assert_int_equal(p->kind, kind);
    if (kind == SHEET_ARC && (fabs(p->radii[0] - wide) > slack || fabs(p->radii[1] - high) > slack))
        fail_msg("radii %.4f and %.4f instead of %.4f and %.4f", p->radii[0], p->radii[1], wide, high);
}

static void a_straight_stays_straight(void **state)
{
    static chain c;
    sheet        s;
    (void)state;
    c = (chain){.count = 0};
    for (int i = 0; i <= 200; i++)
        put(&c, 10 + 0.3 * i, 20 + 0.1 * i + (i % 2 ? 0.006 : -0.006));
    fit_chain(&s, &c, 0.02);
    assert_int_equal(s.paths[0].piece_count, 1);
    check_piece(&s.pieces[0], SHEET_LINE, 0, 0, 0);
    sheet_release(&s);
}

static void round_things_are_one_piece(void **state)
{
    static chain c;
    sheet        s;
    (void)state;
    for (int i = 0; i < 4; i++) { /* whole ones, and three quarters */
        double wide = 12, high = i % 2 ? 5 : 12;
        c = (chain){.closed = i < 2};
        for (int k = 0; k < (i < 2 ? 120 : 91); k++)
            put(&c, 40 + wide * cos(2 * PI * k / 120), 40 + high * sin(2 * PI * k / 120));
        fit_chain(&s, &c, 0.02);
        assert_int_equal(s.paths[0].piece_count, 1);
        check_piece(&s.pieces[0], SHEET_ARC, wide, high, 0.02);
        assert_true(fabs(fabs(s.pieces[0].sweep) - (i < 2 ? 2 : 1.5) * PI) < 1e-3);
        sheet_release(&s);
    }
}

/* A rounded rectangle: its arcs begin where the straight sides end, with their radius, and not where an error would let
 * them. */
static void fillets_keep_their_radius(void **state)
{
    static chain c;
    sheet        s;
    (void)state;
    c = (chain){.closed = true};
    static const double centres[4][2] = {{60, 40}, {20, 40}, {20, 20}, {60, 20}};
    for (int corner = 0; corner < 4; corner++)
        for (int k = 0; k <= 24; k++) {
            double angle = 0.5 * PI * (corner + k / 24.0);
            put(&c, centres[corner][0] + 5 * cos(angle), centres[corner][1] + 5 * sin(angle));
        }
    fit_chain(&s, &c, 0.02);
    size_t arcs = 0, straight = 0;
    for (uint32_t i = 0; i < s.paths[0].piece_count; i++) {
        const sheet_piece *p = &s.pieces[s.paths[0].first_piece + i];
        arcs += p->kind == SHEET_ARC;
        straight += p->kind == SHEET_LINE;
        if (p->kind == SHEET_ARC)
            check_piece(p, SHEET_ARC, 5, 5, 0.01);
    }
    print_message("%zu arcs, %zu lines\n", arcs, straight);
    assert_true(arcs >= 4 && arcs <= 5 && straight == 4 && s.paths[0].piece_count == arcs + straight);
    sheet_release(&s);
}

/* A corner is a point of the curve, however near the error would let it pass. */
static void corners_stay(void **state)
{
    static const float zigzag[5][2] = {{10, 10}, {20, 10.5f}, {30, 10}, {30, 30}, {10, 30}};
    static chain       c;
    sheet              s;
    (void)state;
    c = (chain){.count = 5, .closed = true};
    memcpy(c.points, zigzag, sizeof zigzag);
    fit_chain(&s, &c, 0.02);
    assert_int_equal(s.paths[0].piece_count, 5);
    for (int i = 0; i < 5; i++) {
        double least = INFINITY;
        for (int k = 0; k < 5; k++)
            least = fmin(least,
                         hypot(s.pieces[k].end[0] - (double)zigzag[i][0], s.pieces[k].end[1] - (double)zigzag[i][1]));
        assert_true(least < 1e-6);
        check_piece(&s.pieces[i], SHEET_LINE, 0, 0, 0);
    }
    sheet_release(&s);
}

static void nothing_is_asked_for(void **state)
{
    static chain c;
    sheet        s;
    (void)state;
    make_chain(&c, 0.02);
    fit_chain(&s, &c, 0);
    assert_int_equal(s.piece_count, 0);
    sheet_release(&s);
    const float line[3][2] = {{1, 2}, {3, 4}, {5, 7}};
    sheet_begin(&s, 100, 100, 4);
    sheet_add_item(&s, SHEET_PATH, 0, (colour){0, 0, 0, 1}, 0);
    sheet_add_path(&s, &(sheet_path){.width = 0.3f}, line, 3); /* does not stand for a curve */
    sheet_fit(&s, 0.1);
    assert_int_equal(s.piece_count, 0);
    sheet_release(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(nowhere_farther_than_said),
        cmocka_unit_test(a_straight_stays_straight),
        cmocka_unit_test(round_things_are_one_piece),
        cmocka_unit_test(fillets_keep_their_radius),
        cmocka_unit_test(corners_stay),
        cmocka_unit_test(nothing_is_asked_for),
    };
    return cmocka_run_group_tests_name("fit", tests, NULL, NULL);
}
