/* Marks on meshes: dots whose every prefix is blue noise, strokes of textures laid over triangles, strokes that
 * follow a surface. Rows EX-26 to EX-28, EX-31, EX-33. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/limits.h"
#include "base/memory.h"
#include "marks/marks.h"
#include "base/random.h"
#include "stroke_texture/strokes.h"

static void assert_near(double value, double wanted, double off)
{
    if (!(fabs(value - wanted) <= off))
        fail_msg("%.9g is not %.9g within %.3g", value, wanted, off);
}

/* --- surfaces ------------------------------------------------------------------------------------------- */

typedef struct sheet {
    mark_surface surface;
    vec3        *positions, *normals;
    vec2        *uvs;
    uint32_t    *indices;
} sheet;

/* A sheet of n × n cells over texture coordinates from 0 to `repeat`; each cell two triangles. Bent: part of a
 * ball's upper half. */
static sheet make_sheet(uint32_t n, double width, double height, double repeat, bool bent)
{
    sheet s = {.positions = malloc(sizeof(vec3) * (n + 1) * (n + 1)),
               .normals = malloc(sizeof(vec3) * (n + 1) * (n + 1)),
               .uvs = malloc(sizeof(vec2) * (n + 1) * (n + 1)),
               .indices = malloc(sizeof(uint32_t) * 6 * n * n)};
    for (uint32_t y = 0; y <= n; y++)
        for (uint32_t x = 0; x <= n; x++) {
            uint32_t i = y * (n + 1) + x;
            double   u = (double)x / n, v = (double)y / n, a = (u - 0.5) * width, b = (v - 0.5) * height,
                   c = bent ? sqrt(1 - a * a - b * b) : 0;
            s.positions[i] = (vec3){(float)a, (float)b, (float)c};
            s.normals[i] = bent ? s.positions[i] : (vec3){0, 0, 1};
            s.uvs[i] = (vec2){(float)(u * repeat), (float)(v * repeat)};
        }
    for (uint32_t y = 0; y < n; y++)
        for (uint32_t x = 0; x < n; x++) {
            uint32_t a = y * (n + 1) + x, b = a + 1, c = a + n + 1, d = c + 1;
            memcpy(&s.indices[6 * (y * n + x)], (uint32_t[]){a, b, d, a, d, c}, 6 * sizeof(uint32_t));
        }
    s.surface = (mark_surface){s.positions, s.normals, s.uvs, s.indices, (n + 1) * (n + 1), 2 * n * n};
    return s;
}

static void release_sheet(sheet *s)
{
    free(s->positions);
    free(s->normals);
    free(s->uvs);
    free(s->indices);
}

/* --- dots (EX-31) --------------------------------------------------------------------------------------- */

/* Of the first `count` dots on the unit sheet: the least distance, the pair correlation below six tenths of the
 * distance in the densest packing, and the power at low frequencies, each against what dots that know nothing of
 * each other would have (0, 1, 1). */
typedef struct spectrum {
    double closest, near_pairs, low_power, peak;
} spectrum;

static spectrum measure(const marks *m, size_t count)
{
    enum { WAVES = 24 };
    spectrum s = {.closest = INFINITY};
    double   packed = sqrt(2 / (sqrt(3.0) * (double)count)), within = 0.6 * packed;
    size_t   pairs = 0, inner = 0;
    for (size_t i = 0; i < count; i++) {
        double x = (double)m->dots[i].position.x, y = (double)m->dots[i].position.y;
        if (fabs(x) > 0.4 || fabs(y) > 0.4)
            continue;
        inner++;
        for (size_t k = 0; k < count; k++) {
            double away =
                k == i ? INFINITY : hypot((double)m->dots[k].position.x - x, (double)m->dots[k].position.y - y);
            pairs += away < within;
            s.closest = fmin(s.closest, away / packed);
        }
    }
    s.near_pairs = (double)pairs / ((double)inner * (double)count * 3.14159265 * within * within);
    /* Rings of whole frequencies: up to a third of the dots' own, and around it. */
    double own = sqrt((double)count), low = 0, most = 0;
    for (int ring = 0; ring < 2; ring++)
        for (int w = 0; w < WAVES; w++) {
            double f = (ring ? 0.8 + 0.5 * w / WAVES : 0.08 + 0.25 * w / WAVES) * own, angle = 2.399963 * w, re = 0,
                   im = 0;
            double u = floor(f * cos(angle)), v = floor(f * sin(angle));
            for (size_t i = 0; i < count; i++) {
                double phase = 6.283185307 * (u * (double)m->dots[i].position.x + v * (double)m->dots[i].position.y);
                re += cos(phase);
                im += sin(phase);
            }
            double power = (re * re + im * im) / (double)count;
            if (ring)
                most = fmax(most, power);
            else
                low += power / WAVES;
        }
    s.low_power = low;
    s.peak = most;
    return s;
}

static void test_prefixes(void **state)
{
    (void)state;
    enum { COUNT = 10000 };
    sheet s = make_sheet(3, 1, 1, 1, false);
    marks m;
    assert_int_equal(marks_stipple(&m, &s.surface, COUNT, 1, NULL), LMN_OK);
    assert_int_equal(m.dot_count, COUNT);
    const size_t prefixes[] = {COUNT / 10, COUNT / 4, COUNT / 2, 3 * COUNT / 4, COUNT};
    for (size_t k = 0; k < 5; k++) {
        spectrum p = measure(&m, prefixes[k]);
        printf("%zu dots: closest %.3f of the densest packing's, pairs nearer than 0.6: %.4f, low frequencies %.3f, "
               "highest peak %.1f\n",
               prefixes[k], p.closest, p.near_pairs, p.low_power, p.peak);
        assert_true(p.closest > 0.45);
        assert_true(p.near_pairs < 0.02);
        assert_true(p.low_power < 0.25);
        assert_true(p.peak < 12); /* no rows: a grid of these would have as many as there are dots */
    }
    for (size_t i = 0; i < COUNT; i++) {
        assert_near((double)m.dots[i].priority, 1 - (double)i / COUNT, 1e-6);
        const uint32_t *c = &s.indices[3 * m.dots[i].triangle];
        float           a = m.dots[i].fraction[0], b = m.dots[i].fraction[1];
        assert_true(a >= 0 && b >= 0 && a + b <= 1.00001f);
        assert_near((double)m.dots[i].position.x,
                    (double)((1 - a - b) * s.positions[c[0]].x + a * s.positions[c[1]].x + b * s.positions[c[2]].x),
                    1e-6);
    }
    surface_marks_release(&m);
    release_sheet(&s);
}

/* A ring, closed, whose inner triangles are a third as large as the outer ones: every part of it has as many dots
 * as its area, in every prefix. */
static void test_fractions_of_area(void **state)
{
    (void)state;
    enum { COUNT = 4000, CELLS = 24 };
    sheet s = make_sheet(CELLS, 1, 1, 1, false);
    for (uint32_t i = 0; i < s.surface.vertex_count; i++) {
        double u = 6.283185307179586 * (double)s.uvs[i].x, v = 6.283185307179586 * (double)s.uvs[i].y;
        s.positions[i] =
            (vec3){(float)((1 + 0.5 * cos(v)) * cos(u)), (float)((1 + 0.5 * cos(v)) * sin(u)), (float)(0.5 * sin(v))};
        s.normals[i] = (vec3){(float)(cos(v) * cos(u)), (float)(cos(v) * sin(u)), (float)sin(v)};
    }
    marks m;
    assert_int_equal(marks_stipple(&m, &s.surface, COUNT, 3, NULL), LMN_OK);
    double whole = mark_surface_area(&s.surface);
    for (size_t prefix = COUNT / 4; prefix <= COUNT; prefix *= 2)
        for (uint32_t band = 0; band < 8; band++) {
            mark_surface part = s.surface;
            part.indices = &s.indices[band * 6 * CELLS * CELLS / 8];
            part.triangle_count = 2 * CELLS * CELLS / 8;
            size_t count = 0;
            for (size_t i = 0; i < prefix; i++)
                count += m.dots[i].triangle / part.triangle_count == band;
            double wanted = mark_surface_area(&part) / whole;
            /* Dots that know nothing of each other would be off by √n on the mean; these are never by 0.7 of that,
             * and by less the more there are. */
            assert_near((double)count / (double)prefix / wanted, 1, 0.7 / sqrt(wanted * (double)prefix));
        }
    surface_marks_release(&m);
    release_sheet(&s);
}

/* Both sides of a thin wall have dots of their own, and none of them knows the other's. */
static void test_thin_wall(void **state)
{
    (void)state;
    enum { COUNT = 2000 };
    vec3     positions[8], normals[8];
    uint32_t indices[12] = {0, 1, 2, 0, 2, 3, 4, 6, 5, 4, 7, 6};
    for (int i = 0; i < 8; i++) {
        positions[i] = (vec3){i % 4 == 1 || i % 4 == 2 ? 0.5f : -0.5f, i % 4 >= 2 ? 0.5f : -0.5f, i < 4 ? 0 : -1e-4f};
        normals[i] = (vec3){0, 0, i < 4 ? 1 : -1};
    }
    mark_surface wall = {positions, normals, NULL, indices, 8, 4};
    marks        m;
    assert_int_equal(marks_stipple(&m, &wall, COUNT, 1, NULL), LMN_OK);
    marks front = {.dots = malloc(COUNT * sizeof *front.dots)};
    for (size_t i = 0; i < COUNT; i++)
        if (m.dots[i].normal.z > 0)
            front.dots[front.dot_count++] = m.dots[i];
    assert_near((double)front.dot_count, COUNT / 2.0, 40);
    spectrum p = measure(&front, front.dot_count);
    assert_true(p.closest > 0.4 && p.low_power < 0.25);
    free(front.dots);
    surface_marks_release(&m);
}

static void test_same_again(void **state)
{
    (void)state;
    sheet s = make_sheet(5, 1, 1, 1, true);
    marks a, b, c;
    assert_int_equal(marks_stipple(&a, &s.surface, 30000, 1, NULL), LMN_OK);
    assert_int_equal(marks_stipple(&b, &s.surface, 30000, 1, NULL), LMN_OK);
    assert_int_equal(marks_stipple(&c, &s.surface, 30000, 2, NULL), LMN_OK);
    assert_memory_equal(a.dots, b.dots, 30000 * sizeof *a.dots);
    assert_memory_not_equal(a.dots, c.dots, 30000 * sizeof *a.dots);
    surface_marks_release(&b);
    surface_marks_release(&c);
    /* Kept on disk, they come back as they were; what is damaged is made again. */
    char folder[] = "/tmp/limner-marks-XXXXXX";
    assert_non_null(mkdtemp(folder));
    setenv("LIMNER_CACHE", folder, 1);
    for (int round = 0; round < 2; round++) {
        assert_int_equal(marks_stipple_kept(&b, &s.surface, 30000, 1, NULL), LMN_OK);
        assert_memory_equal(a.dots, b.dots, 30000 * sizeof *a.dots);
        surface_marks_release(&b);
    }
    char command[96];
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
    setenv("LIMNER_CACHE", "", 1);
    surface_marks_release(&a);
    release_sheet(&s);
}

static void test_odd_surfaces(void **state)
{
    (void)state;
    vec3         positions[3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, normals[3] = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}};
    vec2         uvs[3] = {{0, 0}, {1, 0}, {2, 0}};
    uint32_t     indices[3] = {0, 1, 2};
    mark_surface flat = {positions, normals, uvs, indices, 3, 1}, empty = {positions, normals, uvs, indices, 3, 0};
    strokes      texture = {NULL, 0, 0, 1};
    strokes_add(&texture, (texture_stroke){0, 0, 1, 1, 1, 1, 0});
    marks               m;
    lmn_error           error;
    const mark_surface *both[] = {&flat, &empty};
    for (int i = 0; i < 2; i++) {
        assert_int_equal(marks_stipple(&m, both[i], 100, 1, &error), LMN_OK);
        assert_int_equal(m.dot_count, 0);
        surface_marks_release(&m);
        assert_int_equal(marks_tile(&m, both[i], &texture, &(tile_options){.repeat = 1}, &error), LMN_OK);
        assert_int_equal(m.line_count, 0);
        surface_marks_release(&m);
        assert_int_equal(marks_trace(&m, both[i], &(trace_options){.count = 10, .length = 1, .series = 1}, &error),
                         LMN_OK);
        assert_int_equal(m.line_count, 0);
        surface_marks_release(&m);
    }
    positions[2] = (vec3){0, 1, 0};
    assert_int_equal(marks_stipple(&m, &flat, LIMIT_MARKS + 1, 1, &error), LMN_LIMIT);
    assert_int_equal(marks_stipple(&m, &flat, 1, 1, &error), LMN_OK);
    assert_int_equal(m.dot_count, 1);
    surface_marks_release(&m);
    uvs[2] = (vec2){1e9f, 1e9f};
    assert_int_equal(marks_tile(&m, &flat, &texture, &(tile_options){.repeat = 1}, &error), LMN_LIMIT);
    flat.uvs = NULL;
    assert_int_equal(marks_tile(&m, &flat, &texture, &(tile_options){.repeat = 1}, &error), LMN_USAGE);
    strokes_release(&texture);
}

/* --- strokes of a texture (EX-26 to EX-28, EX-33) ------------------------------------------------------- */

static strokes some_strokes(int count)
{
    strokes       s = {NULL, 0, 0, 1};
    random_source r = random_start(9, 1);
    for (int i = 0; i < count; i++) {
        float u = (float)random_unit(&r), v = (float)random_unit(&r);
        strokes_add(&s,
                    (texture_stroke){u, v, u + (float)(0.3 * random_signed(&r)), v + (float)(0.3 * random_signed(&r)),
                                     1 - (float)i / (float)count, (float)random_unit(&r), 0});
    }
    return s;
}

/* Length of all copies inside the sheet, from each copy cut by the sheet's border. */
static double wanted_length(const strokes *s, double repeat, double side)
{
    double sum = 0;
    for (size_t i = 0; i < s->count; i++)
        for (int y = -2; y < repeat + 2; y++)
            for (int x = -2; x < repeat + 2; x++) {
                const texture_stroke *k = &s->items[i];
                double                a[2] = {(double)k->u0 + x, (double)k->v0 + y},
                       d[2] = {(double)k->u1 - (double)k->u0, (double)k->v1 - (double)k->v0}, low = 0, high = 1;
                for (int c = 0; c < 2; c++) {
                    double from = -a[c] / d[c], to = (repeat - a[c]) / d[c];
                    low = fmax(low, fmin(from, to));
                    high = fmin(high, fmax(from, to));
                }
                if (high > low)
                    sum += (high - low) * hypot(d[0], d[1]) * side / repeat;
            }
    return sum;
}

static void test_tiling(void **state)
{
    (void)state;
    strokes        texture = some_strokes(60);
    const uint32_t cells[] = {1, 2, 16};
    size_t         stroke_count = 0;
    double         wanted = wanted_length(&texture, 3, 2);
    for (int k = 0; k < 3; k++) {
        sheet s = make_sheet(cells[k], 2, 2, 3, false);
        marks m;
        assert_int_equal(marks_tile(&m, &s.surface, &texture, &(tile_options){.repeat = 1}, NULL), LMN_OK);
        assert_near(m.line_length / wanted, 1, 1e-4);
        if (k == 0)
            stroke_count = m.stroke_count;
        assert_int_equal(m.stroke_count, stroke_count); /* numbers do not depend on triangles */
        for (size_t i = 0; i < m.line_count; i++) {
            const mark_line *l = &m.lines[i], *before = i > 0 ? l - 1 : NULL;
            bool             goes_on = before && before->stroke == l->stroke;
            assert_near((double)(l->to - l->from), hypot((double)(l->b.x - l->a.x), (double)(l->b.y - l->a.y)), 1e-5);
            assert_near((double)l->from, goes_on ? (double)before->to : 0, 1e-6);
            if (goes_on) {
                assert_near(hypot((double)(before->b.x - l->a.x), (double)(before->b.y - l->a.y)), 0, 1e-5);
                assert_true(before->light == l->light && before->perspective == l->perspective);
                assert_memory_equal(&before->middle, &l->middle, sizeof l->middle);
            }
            /* Lifted, each end still has the texture coordinates that it had: those of the sheet are linear. */
            double corners[3][2], fraction[3];
            for (int c = 0; c < 3; c++) {
                corners[c][0] = (double)s.positions[s.indices[3 * l->triangle + (uint32_t)c]].x;
                corners[c][1] = (double)s.positions[s.indices[3 * l->triangle + (uint32_t)c]].y;
            }
            const double end[2] = {(double)l->a.x, (double)l->a.y};
            assert_true(mark_barycentrics(end, (const double(*)[2])corners, fraction));
            double u = 0;
            for (int c = 0; c < 3; c++) {
                assert_true(fraction[c] > -1e-4 && fraction[c] < 1.0001);
                u += fraction[c] * (double)s.uvs[s.indices[3 * l->triangle + (uint32_t)c]].x;
            }
            assert_near(u, (end[0] / 2 + 0.5) * 3, 1e-5);
            assert_near((double)l->density, m.line_length / 4, 0.1 * m.line_length / 4);
        }
        surface_marks_release(&m);
        release_sheet(&s);
    }
    strokes_release(&texture);
}

/* A stroke along the border between two triangles belongs to one of them; mirrored triangles have theirs too. */
static void test_along_an_edge(void **state)
{
    (void)state;
    strokes texture = {NULL, 0, 0, 1};
    strokes_add(&texture, (texture_stroke){0.25f, 0.25f, 0.75f, 0.75f, 1, 1, 0});
    strokes_add(&texture, (texture_stroke){0.5f, 0.1f, 0.5f, 0.9f, 1, 1, 0});
    for (int mirrored = 0; mirrored < 2; mirrored++) {
        sheet s = make_sheet(2, 1, 1, 1, false);
        for (int i = 0; mirrored && i < 9; i++)
            s.uvs[i].x = 1 - s.uvs[i].x;
        marks m;
        assert_int_equal(marks_tile(&m, &s.surface, &texture, &(tile_options){.repeat = 1}, NULL), LMN_OK);
        assert_near(m.line_length, sqrt(0.5) + 0.8, 1e-5);
        assert_int_equal(m.stroke_count, 2);
        surface_marks_release(&m);
        release_sheet(&s);
    }
    strokes_release(&texture);
}

static void test_indication(void **state)
{
    (void)state;
    strokes      texture = some_strokes(400);
    sheet        s = make_sheet(4, 1, 1, 4, false);
    marks        plain, same, stepped;
    const float  grey[4] = {0.5f, 0.5f, 0.5f, 0.5f}, step[4] = {0, 1, 0, 1}; /* more on the left, fewer on the right */
    tile_options options = {.repeat = 1}, on_grey = {.repeat = 1,
                                                     .indication = grey,
                                                     .indication_width = 2,
                                                     .indication_height = 2,
                                                     .indication_strength = 0.6f};
    tile_options on_step = on_grey;
    on_step.indication = step;
    assert_int_equal(marks_tile(&plain, &s.surface, &texture, &options, NULL), LMN_OK);
    assert_int_equal(marks_tile(&same, &s.surface, &texture, &on_grey, NULL), LMN_OK);
    assert_int_equal(marks_tile(&stepped, &s.surface, &texture, &on_step, NULL), LMN_OK);
    assert_int_equal(plain.line_count, same.line_count);
    assert_memory_equal(plain.lines, same.lines, plain.line_count * sizeof *plain.lines);
    /* At light 0.5 a half is drawn; with priorities moved by 0.3, four fifths and a fifth of the strokes. In full
     * light what is above 1 stays: three tenths. */
    double drawn[2] = {0, 0}, all[2] = {0, 0}, bright = 0;
    for (size_t i = 0; i < stepped.line_count; i++) {
        const mark_line *l = &stepped.lines[i];
        if (i > 0 && l[-1].stroke == l->stroke)
            continue;
        double u = (double)l->middle.x * 4 + 8;
        int    side = u - floor(u) >= 0.5;
        all[side]++;
        drawn[side] += mark_is_drawn(l->light, 1, 0.5f, 0);
        bright += side == 0 && mark_is_drawn(l->light, 1, 1, 0);
    }
    assert_near(drawn[0] / all[0], 0.8, 0.03);
    assert_near(drawn[1] / all[1], 0.2, 0.03);
    assert_near(bright / all[0], 0.3, 0.03);
    surface_marks_release(&plain);
    surface_marks_release(&same);
    surface_marks_release(&stepped);
    strokes_release(&texture);
    release_sheet(&s);
}

static void test_jitter(void **state)
{
    (void)state;
    strokes      texture = some_strokes(100);
    sheet        s = make_sheet(6, 1, 1, 6, false);
    marks        plain, moved, again;
    tile_options options = {.repeat = 1}, jittered = {.repeat = 1, .jitter = 0.1f, .seed = 4};
    assert_int_equal(marks_tile(&plain, &s.surface, &texture, &options, NULL), LMN_OK);
    assert_int_equal(marks_tile(&moved, &s.surface, &texture, &jittered, NULL), LMN_OK);
    assert_int_equal(marks_tile(&again, &s.surface, &texture, &jittered, NULL), LMN_OK);
    assert_near(moved.line_length / plain.line_length, 1, 0.01); /* as much ink */
    assert_int_equal(moved.line_count, again.line_count);
    assert_memory_equal(moved.lines, again.lines, moved.line_count * sizeof *moved.lines);
    /* Without, each stroke in the middle tile has a twin one tile on. */
    const marks *both[] = {&plain, &moved};
    int          twins[2] = {0, 0}, looked_for[2] = {0, 0};
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < both[k]->line_count; i++) {
            vec3 a = both[k]->lines[i].middle;
            if (fabsf(a.x) > 0.15f || fabsf(a.y) > 0.15f)
                continue;
            bool found = false;
            for (size_t j = 0; j < both[k]->line_count && !found; j++)
                found = hypot((double)(both[k]->lines[j].middle.x - a.x) - 1.0 / 6,
                              (double)(both[k]->lines[j].middle.y - a.y)) < 1e-5;
            twins[k] += found;
            looked_for[k]++;
        }
    assert_true(twins[0] > 0.95 * looked_for[0] && looked_for[0] > 100);
    assert_true(twins[1] < 0.05 * looked_for[1]);
    surface_marks_release(&plain);
    surface_marks_release(&moved);
    surface_marks_release(&again);
    strokes_release(&texture);
    release_sheet(&s);
}

/* --- strokes that follow a surface ---------------------------------------------------------------------- */

static void test_trace(void **state)
{
    (void)state;
    sheet s = make_sheet(24, 1.2, 1.2, 1, true);
    for (int once = 0; once < 1; once++) {
        marks         m;
        trace_options options = {.count = 600, .length = 0.1, .uneven = 0, .series = 2, .turn = 1, .seed = 1};
        assert_int_equal(marks_trace(&m, &s.surface, &options, NULL), LMN_OK);
        assert_true(m.stroke_count > 590 && m.stroke_count <= 600);
        size_t whole = 0;
        for (size_t i = 0; i < m.line_count; i++) {
            const mark_line *l = &m.lines[i];
            bool             goes_on = i > 0 && l[-1].stroke == l->stroke;
            double           away = sqrt((double)(l->a.x * l->a.x + l->a.y * l->a.y + l->a.z * l->a.z));
            assert_near(away, 1, 0.003); /* on the ball */
            assert_true(l->length <= 0.1001f && l->to <= l->length + 1e-6f);
            assert_near((double)l->from, goes_on ? (double)l[-1].to : 0, 1e-6);
            if (goes_on)
                assert_memory_equal(&l[-1].b, &l->a, sizeof l->a);
            whole += !goes_on && l->length > 0.098f;
            assert_near((double)l->span, 0.5, 1e-6);
            assert_true(l->light == 1 || l->light == 0.5f);
        }
        assert_true(whole > 0.8 * (double)m.stroke_count); /* all but those that come to the border */
        surface_marks_release(&m);
    }
    release_sheet(&s);
}

/* --- memory --------------------------------------------------------------------------------------------- */

static void test_memory(void **state)
{
    (void)state;
    sheet   s = make_sheet(4, 1, 1, 2, true);
    strokes texture = some_strokes(20);
    for (int what = 0; what < 3; what++) {
        bool failed = true;
        for (long n = 1; failed && n < 2000; n++) {
            marks     m;
            lmn_error error;
            mem_fail_at(n);
            lmn_status status =
                what == 0 ? marks_stipple(&m, &s.surface, 200, 1, &error)
                : what == 1
                    ? marks_tile(&m, &s.surface, &texture, &(tile_options){.repeat = 1}, &error)
                    : marks_trace(&m, &s.surface, &(trace_options){.count = 50, .length = 0.2, .series = 2}, &error);
            mem_fail_at(0);
            failed = status != LMN_OK;
            assert_true(!failed || status == LMN_MEMORY);
            surface_marks_release(&m);
        }
        assert_false(failed);
    }
    strokes_release(&texture);
    release_sheet(&s);
}

int main(void)
{
    setenv("LIMNER_CACHE", "", 1);
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_prefixes),      cmocka_unit_test(test_fractions_of_area),
        cmocka_unit_test(test_thin_wall),     cmocka_unit_test(test_same_again),
        cmocka_unit_test(test_odd_surfaces),  cmocka_unit_test(test_tiling),
        cmocka_unit_test(test_along_an_edge), cmocka_unit_test(test_indication),
        cmocka_unit_test(test_jitter),        cmocka_unit_test(test_trace),
        cmocka_unit_test(test_memory),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
