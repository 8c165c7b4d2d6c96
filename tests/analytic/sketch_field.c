/* The field of uncertainty itself: that it is noise, how long its waves are, and that it stays on the model while
 * the model moves. */
#include <limner/draw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "scenes.h"
#include "sketch_twin.h"

static const double pi = 3.14159265358979323846;

static const shot_view front = {.width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};

/* A look with this perturbation and nothing else of note; valid until the next call but three. The small amount
 * keeps the rim in which fields shrink out of the measurements. */
static const char *look_of(const char *settings)
{
    static char texts[4][640];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 4;
    snprintf(
        text, sizeof texts[0],
        "{\"version\":1,\"name\":\"t\",\"rules\":[{\"select\":\"*\",\"surface\":\"flat\",\"lines\":\"discontinuity\","
        "\"perturb\":{\"technique\":\"uncertainty\",%s%s}}]}",
        strstr(settings, "\"amount\"") ? "" : "\"amount\":0.5,", settings);
    return text;
}

static bool field_of(shot *out, const shape *s, const char *settings, const shot_view *view)
{
    return shot_of_shape(out, s, "field.glb", look_of(settings), NULL, view) &&
           check_that("S02", out->uncertainty != NULL, "the drawing has its field of uncertainty");
}

/* The field of a wall that fills the picture. */
static bool wall_field(shot *out, const char *settings, const shot_view *view)
{
    shape s = {0};
    shape_quad(&s, "wall", 40, 0);
    bool ok = field_of(out, &s, settings, view);
    shape_release(&s);
    return ok;
}

/* A component of the field at a pixel (row 0 on top). */
static double at(const shot *s, int x, int y, int channel)
{
    return (double)s->uncertainty[(size_t)y * (size_t)s->width + (size_t)x][channel];
}

static double largest_difference(const shot *a, const shot *b)
{
    double worst = 0;
    for (int i = 0; i < a->width * a->height; i++)
        for (int c = 0; c < 3; c++)
            worst = fmax(worst, fabs((double)a->uncertainty[i][c] - (double)b->uncertainty[i][c]));
    return worst;
}

/* --- noise ---------------------------------------------------------------------------------------------- */

enum { RIM = 4 };

typedef struct field_numbers {
    double mean, rms, low, high, wave; /* wave: length by changes of sign, px */
} field_numbers;

static field_numbers numbers_of(const shot *s, int channel)
{
    field_numbers n = {.low = INFINITY, .high = -INFINITY};
    double        sum = 0, squares = 0;
    size_t        count = 0, changes = 0;
    for (int y = RIM; y < s->height - RIM - 1; y++)
        for (int x = RIM; x < s->width - RIM - 1; x++) {
            double v = at(s, x, y, channel);
            sum += v;
            squares += v * v;
            n.low = fmin(n.low, v);
            n.high = fmax(n.high, v);
            changes += (size_t)(v * at(s, x + 1, y, channel) < 0) + (size_t)(v * at(s, x, y + 1, channel) < 0);
            count++;
        }
    n.mean = sum / (double)count;
    n.rms = sqrt(squares / (double)count);
    /* A straight line meets waves of all directions at a slant: by a factor of sqrt 2 fewer changes than across
     * each wave. */
    n.wave = 2 * sqrt(0.5) * 2 * (double)count / (double)(changes ? changes : 1);
    return n;
}

/* Correlation of a channel of one field with a channel of another, moved by (dx, dy); `turned`: the other upside
 * down. */
static double correlation(const shot *a, int channel_a, const shot *b, int channel_b, int dx, int dy, bool turned)
{
    double ab = 0, aa = 0, bb = 0;
    for (int y = RIM; y < a->height - RIM - dy; y++)
        for (int x = RIM; x < a->width - RIM - dx; x++) {
            int    bx = x + dx, by = y + dy;
            double va = at(a, x, y, channel_a),
                   vb = turned ? at(b, b->width - 1 - bx, b->height - 1 - by, channel_b) : at(b, bx, by, channel_b);
            ab += va * vb;
            aa += va * va;
            bb += vb * vb;
        }
    return ab / sqrt(aa * bb);
}

static void noise(void)
{
    static const char *const locks[] = {"screen", "object"};
    for (int l = 0; l < 2; l++) {
        char   settings[128];
        double near = 1, wave = 0, mean = 0, rms = 0, cross = 0, turned = 0, seeds = 0, low = 0, high = 0;
        shot   fields[4];
        int    taken = 0;
        for (int k = 0; k < 4; k++) {
            snprintf(settings, sizeof settings, "\"lock\":\"%s\",\"seed\":%d", locks[l], k);
            taken += wall_field(&fields[k], settings, &front);
        }
        for (int k = 0; k < 4 && taken == 4; k++)
            for (int c = 0; c < 3; c++) {
                const shot   *f = &fields[k];
                field_numbers n = numbers_of(f, c);
                near = fmin(near, fmin(correlation(f, c, f, c, 1, 0, false), correlation(f, c, f, c, 0, 1, false)));
                wave += (correlation(f, c, f, c, 60, 0, false) + correlation(f, c, f, c, 0, 60, false)) / 24;
                mean += n.mean / 12;
                rms += n.rms / 12;
                low = fmin(low, n.low);
                high = fmax(high, n.high);
                cross += correlation(f, c, f, (c + 1) % 3, 0, 0, false) / 12;
                turned += correlation(f, c, f, (c + 1) % 3, 0, 0, true) / 12;
                seeds += correlation(f, c, &fields[(k + 1) % 4], c, 0, 0, false) / 12;
            }
        check_at_least("S02", near, 0.98, "%s: correlation of neighbouring pixels, the least of 12 fields", locks[l]);
        check_near("S02", wave, 0, 0.12, "  of pixels a wave apart");
        check_near("S02", mean, 0, 0.06, "  mean");
        check_near("S02", rms, 0.45, 0.2, "  root of the mean square");
        check_at_least("S02", low, -1, "  the least value");
        check_at_most("S02", high, 1, "  the greatest");
        check_at_least("S02", fmin(-low, high), 0.75, "  both reach far");
        check_near("S02", cross, 0, 0.12, "  correlation of the components with one another");
        check_near("S02", turned, 0, 0.12, "  with one another turned about the middle, as the seed has them");
        check_near("S02", seeds, 0, 0.12, "  of fields of different seeds");
        for (int k = 0; k < 4; k++)
            shot_release(&fields[k]);
    }
}

static void compare(const char *what, const char *a, const char *b, const shot_view *view_a, const shot_view *view_b,
                    bool alike)
{
    shot first, second;
    bool ok = wall_field(&first, a, view_a);
    ok = wall_field(&second, b, view_b) && ok;
    if (ok && alike)
        check_at_most("S02", largest_difference(&first, &second), 0, "%s: difference", what);
    else if (ok)
        check_at_least("S02", largest_difference(&first, &second), 0.3, "%s: difference", what);
    shot_release(&first);
    shot_release(&second);
}

static void seeds_and_time(void)
{
    static const char *const locks[] = {"screen", "object"};
    for (int l = 0; l < 2; l++) {
        char plain[128], third[128], boiling[128];
        snprintf(plain, sizeof plain, "\"lock\":\"%s\"", locks[l]);
        snprintf(third, sizeof third, "\"lock\":\"%s\",\"seed\":3", locks[l]);
        snprintf(boiling, sizeof boiling, "\"lock\":\"%s\",\"boil\":4", locks[l]);
        shot_view seeded = front, early = front, later = front, late = front;
        seeded.seed = 3;
        early.time_s = 0.30;
        later.time_s = 0.45;
        late.time_s = 0.55;
        compare("the same twice", plain, plain, &front, &front, true);
        compare("another seed of the rule", plain, third, &front, &front, false);
        compare("another seed of the drawing", plain, plain, &front, &seeded, false);
        compare("the two seeds add up", plain, third, &seeded, &front, true);
        compare("two times, nothing boils", plain, plain, &front, &late, true);
        compare("two times of one phase", boiling, boiling, &early, &later, true);
        compare("two phases", boiling, boiling, &later, &late, false);
    }
}

static void waves(void)
{
    static const char *const locks[] = {"screen", "object"};
    static const int         scales[] = {24, 48, 96};
    for (int l = 0; l < 2; l++) {
        double length[3] = {0};
        for (int k = 0; k < 3; k++)
            for (int seed = 0; seed < 3; seed++) {
                char settings[128];
                shot field;
                snprintf(settings, sizeof settings, "\"lock\":\"%s\",\"octaves\":1,\"seed\":%d,\"scale\":%d", locks[l],
                         seed, scales[k]);
                if (wall_field(&field, settings, &front))
                    length[k] += (numbers_of(&field, 0).wave + numbers_of(&field, 1).wave) / 6;
                shot_release(&field);
            }
        for (int k = 0; k < 3; k++)
            check_near("S02", length[k] / scales[k], 1, 0.6, "%s, scale %d: length of the waves over the scale",
                       locks[l], scales[k]);
        check_near("S02", length[1] / length[0], 2, 0.35, "  twice the scale, times the length");
        check_near("S02", length[2] / length[1], 2, 0.35, "  and again");
    }
}

/* Every further octave has half the height and half the length of the one before: slopes add up as squares, and what is
 * made of n octaves is as high as what is made of one. */
static void octaves(void)
{
    double first = 0, squares = 0;
    for (int n = 1; n <= 4; n++) {
        double sum = 0, all = 0;
        for (int seed = 0; seed < 4; seed++) {
            char settings[128];
            shot field;
            snprintf(settings, sizeof settings, "\"lock\":\"screen\",\"octaves\":%d,\"seed\":%d,\"scale\":96", n, seed);
            if (wall_field(&field, settings, &front))
                for (int y = RIM; y < field.height - RIM - 1; y++)
                    for (int x = RIM; x < field.width - RIM - 1; x++)
                        for (int c = 0; c < 2; c++) {
                            double across = at(&field, x + 1, y, c) - at(&field, x, y, c),
                                   up = at(&field, x, y + 1, c) - at(&field, x, y, c);
                            sum += across * across + up * up;
                            all += at(&field, x, y, c) * at(&field, x, y, c);
                        }
            shot_release(&field);
        }
        squares += pow(0.25, n - 1);
        first = n == 1 ? sum / all : first;
        check_near("S02", sum / all / first / (n / squares), 1, 0.2,
                   "%d octaves: squares of slopes, of one octave's, against %.2f", n, n / squares);
    }
}

static void tiles(void)
{
    static const int cases[][2] = {{128, 32}, {100, 30}, {90, 60}};
    for (int c = 0; c < 3; c++) {
        char settings[128];
        shot field;
        snprintf(settings, sizeof settings, "\"lock\":\"screen\",\"tile\":%d,\"scale\":%d", cases[c][0], cases[c][1]);
        if (wall_field(&field, settings, &front)) {
            double worst = 0, half = 0;
            int    tile = cases[c][0];
            for (int y = RIM; y < field.height - tile - RIM; y++)
                for (int x = RIM; x < field.width - tile - RIM; x++)
                    for (int k = 0; k < 3; k++) {
                        worst = fmax(worst, fmax(fabs(at(&field, x, y, k) - at(&field, x + tile, y, k)),
                                                 fabs(at(&field, x, y, k) - at(&field, x, y + tile, k))));
                        half = fmax(half, fabs(at(&field, x, y, k) - at(&field, x + tile / 2, y, k)));
                    }
            check_at_most("S02", worst, 1e-3, "tile %d, scale %d: difference of pixels a tile apart", tile,
                          cases[c][1]);
            check_at_least("S02", half, 0.3, "  and half a tile apart");
            field_numbers n = numbers_of(&field, 0);
            check_near("S02", n.wave / cases[c][1], 1, 0.6, "  length of the waves over the scale");
        }
        shot_release(&field);
    }
}

/* Sharp turns where an octave changes its sign: the field bends more than noise of the same scale. */
static double largest_bend(const shot *s)
{
    double sum = 0;
    for (int y = RIM; y < s->height - RIM; y++)
        for (int x = RIM + 6; x < s->width - RIM - 6; x++) {
            double bend = at(s, x + 6, y, 0) + at(s, x - 6, y, 0) - 2 * at(s, x, y, 0);
            sum += bend * bend * bend; /* turbulence turns upwards */
        }
    return cbrt(sum / (s->width * s->height));
}

/* No position of the model is at rest whatever the seed: not its middle, nor a plane through it. */
static void middle(void)
{
    static const char *const locks[] = {"screen", "object"};
    for (int l = 0; l < 2; l++) {
        double squares[2] = {0};
        for (int seed = 0; seed < 16; seed++) {
            char settings[96];
            shot field;
            snprintf(settings, sizeof settings, "\"lock\":\"%s\",\"seed\":%d", locks[l], seed);
            if (wall_field(&field, settings, &front))
                for (int c = 0; c < 3; c++) {
                    squares[0] += pow(at(&field, 200, 200, c), 2) / 48;
                    squares[1] += pow(at(&field, 130, 90, c), 2) / 48;
                }
            shot_release(&field);
        }
        check_at_least("S02", sqrt(squares[0]), 0.15,
                       "%s: strength of the field in the middle of the model, over 16 seeds (elsewhere %.3f)", locks[l],
                       sqrt(squares[1]));
    }
}

static void turbulence(void)
{
    static const char *const locks[] = {"screen", "object"};
    for (int l = 0; l < 2; l++) {
        double mean = 0, rms = 0, low = 0, high = 0, bends[2] = {0};
        for (int seed = 0; seed < 3; seed++) {
            char plain[128], settings[128];
            shot field, smooth;
            snprintf(settings, sizeof settings, "\"lock\":\"%s\",\"seed\":%d,\"field\":\"turbulence\"", locks[l], seed);
            snprintf(plain, sizeof plain, "\"lock\":\"%s\",\"seed\":%d", locks[l], seed);
            bool ok = wall_field(&field, settings, &front);
            if (wall_field(&smooth, plain, &front) && ok) {
                for (int c = 0; c < 3; c++) {
                    field_numbers n = numbers_of(&field, c);
                    mean += n.mean / 9;
                    rms += n.rms / 9;
                    low = fmin(low, n.low);
                    high = fmax(high, n.high);
                }
                bends[0] += largest_bend(&smooth) / 3;
                bends[1] += largest_bend(&field) / 3;
                check_at_least("S02", largest_difference(&field, &smooth), 0.3, "%s: turbulence differs from noise",
                               locks[l]);
            }
            shot_release(&field);
            shot_release(&smooth);
        }
        check_near("S02", mean, 0, 0.15, "%s: turbulence, mean", locks[l]);
        check_near("S02", rms, 0.4, 0.2, "  root of the mean square");
        check_at_least("S02", low, -1, "  the least value");
        check_at_most("S02", high, 1, "  the greatest");
        check_at_least("S02", bends[1] - fabs(bends[0]), 0.02, "  it turns sharply one way (noise: %.3f)", bends[0]);
    }
}

/* Towards the picture's border the field shrinks evenly over twice the largest offset. */
static void rim(void)
{
    static const char *const locks[] = {"screen", "object"};
    for (int l = 0; l < 2; l++) {
        char   small[96], large[96];
        shot   a, b;
        double worst = 0;
        snprintf(small, sizeof small, "\"lock\":\"%s\",\"scale\":200", locks[l]);
        snprintf(large, sizeof large, "\"lock\":\"%s\",\"scale\":200,\"amount\":15,\"edges_xy\":0.5",
                 locks[l]); /* 15·1.5 px at most */
        bool ok = wall_field(&a, small, &front);
        if (wall_field(&b, large, &front) && ok) {
            for (int y = 2; y < 398; y++)
                for (int x = 2; x < 398; x++) {
                    int border = x < y ? x : y;
                    border = 399 - x < border ? 399 - x : border;
                    border = 399 - y < border ? 399 - y : border;
                    worst = fmax(worst, fabs(at(&b, x, y, 0) - at(&a, x, y, 0) * fmin(1, border / 45.0)));
                }
            check_at_most("C25", worst, 0.02, "%s: the shrunken field against the whole one times its fraction",
                          locks[l]);
        }
        shot_release(&a);
        shot_release(&b);
    }
}

/* --- on the model --------------------------------------------------------------------------------------- */

/* The same waves at any distance. */
static void distances(void)
{
    enum { STEPS = 9 };
    double rms[STEPS] = {0}, length[STEPS] = {0}, low_rms = INFINITY, high_rms = 0, low_direction = INFINITY,
           high_direction = 0;
    for (int k = 0; k < STEPS; k++)
        for (int seed = 0; seed < 3; seed++) {
            char      settings[96];
            shot      field;
            shot_view view = {.width = 320, .height = 320, .eye = {0, 0, 2.2 * pow(2, k / 2.0)}, .up = {0, 1, 0}};
            snprintf(settings, sizeof settings, "\"lock\":\"object\",\"scale\":40,\"seed\":%d", seed);
            if (wall_field(&field, settings, &view))
                for (int c = 0; c < 2; c++) {
                    field_numbers n = numbers_of(&field, c);
                    rms[k] += n.rms / 6;
                    length[k] += n.wave / 6;
                }
            shot_release(&field);
        }
    for (int k = 0; k < STEPS; k++) {
        check_note("distance %5.2f times: root of the mean square %.3f, waves of %.1f px", pow(2, k / 2.0), rms[k],
                   length[k]);
        low_rms = fmin(low_rms, rms[k]);
        high_rms = fmax(high_rms, rms[k]);
        low_direction = fmin(low_direction, length[k]);
        high_direction = fmax(high_direction, length[k]);
    }
    check_at_most("S12", high_rms / low_rms, 1.3,
                  "strength of the field at distances 1 to 16 times: the greatest over the least");
    check_at_most("S12", high_direction / low_direction, 1.7,
                  "length of its waves on the page: the greatest over the least");
    check_near("S12", (high_direction + low_direction) / 2 / 40, 1, 0.6, "  over the scale");
}

/* A closed shape with bumps, a ring around it and two boxes. */
static void model(shape *s)
{
    shape_sphere(s, "head", dvec_of(0, 0, 0), 1, 48, 96, false);
    shape_part *p = &s->parts[0];
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        float *v = p->positions[i];
        float  bump = 1 + 0.12f * sinf(5 * v[0] + 1) * sinf(6 * v[1]) * cosf(4 * v[2]);
        for (int k = 0; k < 3; k++)
            v[k] *= bump;
    }
    shape_torus(s, "ring", 1.35, 0.14, 64, 24);
    shape_place(s, dvec_of(1, 0.2, 0), 25, dvec_of(0, -0.1, 0));
    shape_box(s, "crate", dvec_of(-1.9, -0.6, 0.2), dvec_of(-1.2, 0.5, 0.9));
    shape_box(s, "bar", dvec_of(0.9, -1.1, -0.2), dvec_of(1.3, 1.2, 0.2));
}

static shot_view frame_view(int frame)
{
    double angle = (30 + 1.2 * frame) * pi / 180, distance = 9 * pow(0.992, frame);
    return (shot_view){.width = 480,
                       .height = 360,
                       .eye = {distance * sin(angle), 0.35 * distance, distance * cos(angle)},
                       .up = {0, 1, 0}};
}

typedef enum position_class {
    POSITION_AMID,
    POSITION_WITHIN,
    POSITION_BEHIND,
    POSITION_OUTSIDE,
    POSITION_CLASSES
} position_class;

static const char *const position_names[POSITION_CLASSES] = {"amid surfaces", "up to 6 px within silhouettes",
                                                             "up to 6 px behind a nearer border",
                                                             "up to 6 px outside silhouettes"};

/* Gives the pixels within six pixels of a step from one pixel to a farther one their class: on the side of which of
 * the two they are. */
static void classify_around(const shot *s, uint8_t *classes, int near, int far)
{
    for (int v = -6; v <= 6; v++)
        for (int u = -6; u <= 6; u++) {
            int x = near % s->width + u, y = near / s->width + v, i = y * s->width + x;
            if (u * u + v * v > 36 || x < 0 || y < 0 || x >= s->width || y >= s->height)
                continue;
            bool behind =
                isfinite(s->depth[far]) && fabsf(s->depth[i] - s->depth[far]) < fabsf(s->depth[i] - s->depth[near]);
            uint8_t class = !isfinite(s->depth[i]) ? POSITION_OUTSIDE : behind ? POSITION_BEHIND : POSITION_WITHIN;
            classes[i] = class > classes[i] ? class : classes[i];
        }
}

static uint8_t *classes_of(const shot *s)
{
    uint8_t *classes = check_alloc((size_t)s->width * (size_t)s->height, 1);
    for (int y = 0; y + 1 < s->height; y++)
        for (int x = 0; x + 1 < s->width; x++)
            for (int mode = 0; mode < 2; mode++) {
                int   a = y * s->width + x, b = mode ? a + s->width : a + 1;
                float step = s->depth[b] - s->depth[a];
                if (isinf(s->depth[a]) && isinf(s->depth[b]))
                    continue;
                if (fabsf(step) > 0.1f)
                    classify_around(s, classes, step > 0 ? a : b, step > 0 ? b : a);
            }
    return classes;
}

/* Where the surface at a pixel of one frame is in the next, in pixels with row 0 on top; false when it is hidden
 * there. */
static bool followed(const shot *from, const shot *to, int x, int y, double *to_x, double *to_y)
{
    double depth = (double)from->depth[y * from->width + x];
    dvec   origin, direction;
    shot_ray(from, x + 0.5, y + 0.5, &origin, &direction);
    dvec   point = dvec_add(origin, dvec_scale(direction, depth)), position = shot_project(to, point);
    double eye_depth = -shot_to_eye(to, point, 1).z;
    *to_x = position.x - 0.5;
    *to_y = position.y - 0.5;
    int px = (int)floor(position.x), py = (int)floor(position.y);
    return px >= 1 && py >= 1 && px < to->width - 1 && py < to->height - 1 &&
           fabs((double)to->depth[py * to->width + px] - eye_depth) < 0.01 * eye_depth;
}

/* The nearest pixel within six that is on a surface and not behind a border; false when there is none. */
static bool nearest_border(const shot *s, const uint8_t *classes, int x, int y, int *nx, int *ny)
{
    int best = 37;
    for (int v = -6; v <= 6; v++)
        for (int u = -6; u <= 6; u++)
            if (u * u + v * v < best && x + u >= 0 && y + v >= 0 && x + u < s->width && y + v < s->height &&
                isfinite(s->depth[(y + v) * s->width + x + u]) &&
                classes[(y + v) * s->width + x + u] < POSITION_BEHIND) {
                best = u * u + v * v;
                *nx = x + u;
                *ny = y + v;
            }
    return best < 37;
}

typedef struct drift {
    double sum[POSITION_CLASSES], worst[POSITION_CLASSES];
    size_t count[POSITION_CLASSES], jumps[POSITION_CLASSES];
} drift;

/* How much the field changes on surfaces that move from one picture to the next. `fields` are where the field is
 * taken from. */
static void add_drift(drift *d, const shot *from, const shot *to, const uint8_t *classes, const shot *field_from,
                      const shot *field_to)
{
    sketch_maps next = sketch_maps_of(field_to);
    for (int y = 8; y < from->height - 8; y += 2)
        for (int x = 8; x < from->width - 8; x++) {
            int i = y * from->width + x, sx = x, sy = y;
            position_class class = (position_class)classes[i];
            double to_x, to_y;
            if (class == POSITION_AMID && !isfinite(from->depth[i]))
                continue;
            /* Outside of a border and behind it the nearer surface has the say. */
            if (class >= POSITION_BEHIND && !nearest_border(from, classes, x, y, &sx, &sy))
                continue;
            if (!followed(from, to, sx, sy, &to_x, &to_y))
                continue;
            to_x += x - sx;
            to_y += y - sy;
            double change =
                hypot(sketch_field(&next, to_x, from->height - 1 - to_y, 0) - (double)field_from->uncertainty[i][0],
                      sketch_field(&next, to_x, from->height - 1 - to_y, 1) - (double)field_from->uncertainty[i][1]);
            d->sum[class] += change;
            d->worst[class] = fmax(d->worst[class], change);
            d->jumps[class] += change > 0.25;
            d->count[class]++;
        }
}

/* Is the pixel's surroundings all on one part and, with `flat`, on one face? */
static bool amid(const shot *s, int x, int y, int radius, bool flat)
{
    int own = y * s->width + x;
    for (int v = -radius; v <= radius; v++)
        for (int u = -radius; u <= radius; u++) {
            int i = (y + v) * s->width + x + u;
            if (s->id[i] != s->id[own] ||
                (flat &&
                 fabsf(s->normal[i][0] - s->normal[own][0]) + fabsf(s->normal[i][1] - s->normal[own][1]) > 0.01f))
                return false;
        }
    return true;
}

/* What is moved in a model of two boxes. */
typedef enum moved { MOVED_NOTHING, MOVED_PART, TURNED_PART, TURNED_ALL, MOVED_KINDS } moved;

/* Two boxes below one node; the second's node is animated. What moves goes to the right; what turns, turns by a
 * quarter about Z. */
static bool write_moving(const char *name, double right, moved what)
{
    static const uint16_t    faces[36] = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                                          2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    static const char *const turns[2] = {"0,0,0,1", "0,0,0.70710678,0.70710678"};
    float corners[2][24], key[4] = {0, what == MOVED_PART || what == TURNED_PART ? (float)right : 0, 0, 0};
    for (int part = 0; part < 2; part++)
        for (int k = 0; k < 8; k++) {
            corners[part][3 * k] = (k & 1 ? 0.5f : -0.5f) + (part ? 0.3f : -0.9f);
            corners[part][3 * k + 1] = k & 2 ? 0.8f : -0.8f;
            corners[part][3 * k + 2] = k & 4 ? 0.5f : -0.5f;
        }
    FILE *bytes = fopen(check_path("moving.bin"), "wb");
    bool  ok = bytes && fwrite(corners, sizeof corners, 1, bytes) && fwrite(faces, sizeof faces, 1, bytes) &&
              fwrite(key, sizeof key, 1, bytes);
    ok = bytes && fclose(bytes) == 0 && ok;
    FILE *text = fopen(check_path("%s", name), "w");
    if (!text)
        return false;
    fprintf(text,
            "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[2]}],\"nodes\":[{\"name\":\"still\","
            "\"mesh\":0},{\"name\":\"moving\",\"mesh\":1,"
            "\"translation\":[%.9g,0,0],\"rotation\":[%s]},{\"name\":\"all\",\"children\":[0,1],\"rotation\":[%s]}],",
            (double)key[1], turns[what == TURNED_PART], turns[what == TURNED_ALL]);
    fputs("\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0},\"indices\":2}]},{\"primitives\":[{"
          "\"attributes\":{\"POSITION\":1},\"indices\":2}]}],"
          "\"buffers\":[{\"uri\":\"moving.bin\",\"byteLength\":280}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,"
          "\"byteLength\":96},"
          "{\"buffer\":0,\"byteOffset\":96,\"byteLength\":96},{\"buffer\":0,\"byteOffset\":192,\"byteLength\":72},{"
          "\"buffer\":0,\"byteOffset\":264,\"byteLength\":4},"
          "{\"buffer\":0,\"byteOffset\":268,\"byteLength\":12}],\"accessors\":["
          "{\"bufferView\":0,\"componentType\":5126,\"count\":8,\"type\":\"VEC3\",\"min\":[-1.4,-0.8,-0.5],\"max\":[-0."
          "4,0.8,0.5]},"
          "{\"bufferView\":1,\"componentType\":5126,\"count\":8,\"type\":\"VEC3\",\"min\":[-0.2,-0.8,-0.5],\"max\":[0."
          "8,0.8,0.5]},"
          "{\"bufferView\":2,\"componentType\":5123,\"count\":36,\"type\":\"SCALAR\"},"
          "{\"bufferView\":3,\"componentType\":5126,\"count\":1,\"type\":\"SCALAR\",\"min\":[0],\"max\":[0]},"
          "{\"bufferView\":4,\"componentType\":5126,\"count\":1,\"type\":\"VEC3\"}],"
          "\"animations\":[{\"samplers\":[{\"input\":3,\"output\":4}],\"channels\":[{\"sampler\":0,\"target\":{"
          "\"node\":1,\"path\":\"translation\"}}]}]}",
          text);
    return fclose(text) == 0 && ok;
}

/* How the field at positions of both parts changes between two drawings; `right` is in pixels. */
static void compare_moved(const shot *before, const shot *after, moved what, int right)
{
    static const char *const names[2][MOVED_KINDS] = {{"", "rests", "rests", "is turned with all"},
                                                      {"", "is moved", "is moved and turned", "is turned with all"}};
    double                   sum[2] = {0}, worst[2] = {0};
    int                      count[2] = {0};
    for (int y = 8; y < 312; y++)
        for (int x = 8; x < 312; x++) {
            /* Where the position is afterwards: a quarter about the middle of the page turns right into up. */
            int  id = before->id[y * 320 + x];
            bool own = id == 2 && what != TURNED_ALL, turned = what == TURNED_ALL || (own && what == TURNED_PART);
            int  to_x = (turned ? y : x) + (own ? right : 0), to_y = turned ? 319 - x : y;
            if (!id || to_x >= 312 || !amid(before, x, y, 16, false) || !amid(after, to_x, to_y, 16, false) ||
                after->id[to_y * 320 + to_x] != id)
                continue;
            double change =
                hypot(at(before, x, y, 0) - at(after, to_x, to_y, 0), at(before, x, y, 1) - at(after, to_x, to_y, 1));
            sum[id - 1] += change;
            worst[id - 1] = fmax(worst[id - 1], change);
            count[id - 1]++;
        }
    for (int k = 0; k < 2; k++) {
        check_at_least("S12", count[k], 500, "pixels of the part that %s", names[k][what]);
        check_at_most("S12", count[k] ? sum[k] / count[k] : 9, 0.05, "  mean change of the field on it, greatest %.3f",
                      worst[k]);
    }
}

/* A part, or all, is moved or turned by a quarter before a still view: the field goes with it, and stays where it
 * is on what rests. */
static void moved_part(void)
{
    char      rest[560];
    shot_view view = {.width = 320, .height = 320, .eye = {0, 0, 12}, .up = {0, 1, 0}, .orthographic = true};
    double    pixel = 2 * 12 * tan(15 * pi / 180) / 320;
    shot      before;
    bool      ok = check_that("S12", write_moving("rest.gltf", 0, MOVED_NOTHING), "a model is written");
    snprintf(rest, sizeof rest, "%s", check_path("rest.gltf"));
    ok = ok && shot_take(&before, rest, look_of("\"lock\":\"object\""), NULL, &view) && before.uncertainty;
    for (int what = MOVED_PART; what < MOVED_KINDS && ok; what++) {
        shot after;
        ok = write_moving("moved.gltf", 40 * pixel, (moved)what) &&
             shot_take(&after, check_path("moved.gltf"), look_of("\"lock\":\"object\""), NULL, &view) &&
             after.uncertainty;
        if (ok)
            compare_moved(&before, &after, (moved)what, 40);
        shot_release(&after);
    }
    check_that("S12", ok, "all are drawn");
    shot_release(&before);
}

static double mean_drift(const drift *d, position_class class)
{
    return d->count[class] ? d->sum[class] / (double)d->count[class] : INFINITY;
}

/* Row C23: with lock=screen the field belongs to the page, whoever looks from where. */
static void page_locked(void)
{
    shape s = {0};
    shot  first;
    model(&s);
    shot_view view = frame_view(0);
    if (field_of(&first, &s, "\"lock\":\"screen\",\"amount\":6", &view)) {
        for (int frame = 7; frame < 30; frame += 11) {
            shot now;
            view = frame_view(frame);
            if (field_of(&now, &s, "\"lock\":\"screen\",\"amount\":6", &view)) {
                double worst = 0;
                int    both = 0;
                for (int i = 0; i < now.width * now.height; i++) /* it is there where something is drawn */
                    for (int c = 0; c < 3 && isfinite(now.depth[i]) && isfinite(first.depth[i]); c++, both++)
                        worst = fmax(worst, fabs((double)(now.uncertainty[i][c] - first.uncertainty[i][c])));
                check_at_least("C23", both, 10000, "values of the field on the page, seen from elsewhere");
                check_at_most("C23", worst, 0, "  difference");
            }
            shot_release(&now);
        }
    }
    shot_release(&first);
    shape_release(&s);
}

/* The field of a turning, approaching model, frame by frame, for one that stays on the model, one on the page and
 * one that is new in each frame. */
static void coherence(void)
{
    enum { FRAMES = 60 };
    /* Waves of a tenth of the picture, as the look "sketch" has them on a page. */
    static const char *const settings[3] = {"\"amount\":4,\"scale\":40,\"lock\":\"object\"",
                                            "\"amount\":4,\"scale\":40,\"lock\":\"screen\"",
                                            "\"amount\":4,\"scale\":40,\"lock\":\"screen\""};
    /* Round silhouettes slide over the surface as fast as it moves on the page: outside of them nothing can be tied
     * to a position of it. And whoever approaches must see waves fade in and out, or they would not keep their length
     * on the page. */
    static const double      limits[POSITION_CLASSES] = {0.25, 0.4, 0.8, 0.8};
    static const char *const names[3] = {"on the model", "on the page", "new each frame"};
    shape                    s = {0};
    shot                     before[3] = {{0}};
    drift                    drifts[3] = {{{0}}};
    bool                     ok = true;
    model(&s);
    for (int frame = 0; frame < FRAMES && ok; frame++) {
        shot now[3] = {{0}};
        for (int k = 0; k < 3 && ok; k++) {
            shot_view view = frame_view(frame);
            view.seed = k == 2 ? (uint32_t)frame : 0;
            ok = shot_of_shape(&now[k], &s, "moving.glb", look_of(settings[k]), NULL, &view) && now[k].uncertainty;
        }
        if (ok && frame > 0) {
            uint8_t *classes = classes_of(&before[0]);
            for (int k = 0; k < 3; k++)
                add_drift(&drifts[k], &before[0], &now[0], classes, &before[k], &now[k]);
            free(classes);
        }
        for (int k = 0; k < 3; k++) {
            shot_release(&before[k]);
            before[k] = now[k];
        }
    }
    check_that("S11", ok, "%d frames are drawn", FRAMES);
    for (int c = 0; c < POSITION_CLASSES && ok; c++) {
        for (int k = 0; k < 3; k++)
            check_note("%-33s %-15s mean change %.4f, greatest %.3f, above 0.25: %.5f of %zu", position_names[c],
                       names[k], mean_drift(&drifts[k], (position_class)c), drifts[k].worst[c],
                       (double)drifts[k].jumps[c] / (double)drifts[k].count[c], drifts[k].count[c]);
        check_at_most("S12", mean_drift(&drifts[0], (position_class)c) / mean_drift(&drifts[1], (position_class)c),
                      limits[c], "%s: change a frame, on the model over on the page", position_names[c]);
        check_at_most("S11", mean_drift(&drifts[0], (position_class)c) / mean_drift(&drifts[2], (position_class)c), 0.1,
                      "  on the model over new each frame");
        check_at_most(
            "S11", (double)drifts[0].jumps[c] / (double)drifts[1].jumps[c], 0.4,
            "  places whose lines jump by a quarter of the amount from a frame to the next, over those on the page");
    }
    double all[3] = {0};
    for (int k = 0; k < 3; k++) {
        for (int c = 0; c < POSITION_OUTSIDE; c++)
            all[k] += drifts[k].sum[c];
        shot_release(&before[k]);
    }
    check_at_most("S12", all[0] / all[1], 0.25, "all visible places: change a frame, on the model over on the page");
    check_at_most("S11", all[0] / all[2], 0.1, "  on the model over new each frame");
    shape_release(&s);
}

static void standstill(void)
{
    static const char *const settings[] = {
        "\"lock\":\"object\",\"amount\":6", "\"lock\":\"screen\",\"amount\":6,\"rough\":2,\"repeat\":2",
        "\"lock\":\"object\",\"amount\":6,\"outward\":\"enlarged\",\"pressure\":0.5"};
    shape s = {0};
    model(&s);
    for (int k = 0; k < 3; k++) {
        shot      a, b, other;
        shot_view view = frame_view(7), between = frame_view(30);
        bool      ok = field_of(&a, &s, settings[k], &view);
        ok =
            field_of(&other, &s, settings[k], &between) && ok; /* what was drawn in between must leave nothing behind */
        if (field_of(&b, &s, settings[k], &view) && ok) {
            check_that("C23", memcmp(a.picture, b.picture, (size_t)(a.width * a.height) * 4) == 0,
                       "the same frame again has the same pixels, %s", settings[k]);
            check_at_most("C23", largest_difference(&a, &b), 0, "  and the same field");
        }
        shot_release(&a);
        shot_release(&b);
        shot_release(&other);
    }
    shape_release(&s);
}

/* The view moves sideways by whole pixels: the field moves with it. */
static void panned(void)
{
    static const int modes[] = {10, 7, 33};
    shape            s = {0};
    model(&s);
    for (int k = 0; k < 3; k++) {
        shot      a, b;
        shot_view view = {.width = 320, .height = 320, .eye = {0, 0, 12}, .up = {0, 1, 0}, .orthographic = true},
                  moved = view;
        double pixel = 2 * 12 * tan(15 * pi / 180) / 320, worst = 0, sum = 0;
        int    count = 0, far = 0, wx = 0, wy = 0;
        moved.eye.x -= modes[k] * pixel;
        moved.target.x -= modes[k] * pixel;
        bool ok = field_of(&a, &s, "\"lock\":\"object\"", &view);
        if (field_of(&b, &s, "\"lock\":\"object\"", &moved) && ok) {
            for (int y = 10; y < 310; y++)
                for (int x = 10; x < 270; x++)
                    if (isfinite(a.depth[y * 320 + x])) {
                        double change = hypot(at(&a, x, y, 0) - at(&b, x + modes[k], y, 0),
                                              at(&a, x, y, 1) - at(&b, x + modes[k], y, 1));
                        if (change > worst) {
                            worst = change;
                            wx = x;
                            wy = y;
                        }
                        far += change > 0.3;
                        sum += change;
                        count++;
                    }
            check_at_most("S12", sum / count, 0.02, "moved by %d px: mean change of the field on the model", modes[k]);
            check_at_most("S12", (double)far / count, 0.003,
                          "  fraction of places where it changes by more than 0.3 (the greatest, %.3f, at %d %d)",
                          worst, wx, wy);
        }
        shot_release(&a);
        shot_release(&b);
    }
    shape_release(&s);
}

/* Is the figure within 14 px? Farther outside no lookup of an ordinary drawing comes from, and the field may end
 * anyhow. */
static bool near_figure(const shot *s, int x, int y)
{
    for (int v = -14; v <= 14; v++)
        for (int u = -14; u <= 14; u++)
            if (u * u + v * v <= 196 && x + u >= 0 && y + v >= 0 && x + u < s->width && y + v < s->height &&
                isfinite(s->depth[(y + v) * s->width + x + u]))
                return true;
    return false;
}

/* How much neighbouring pixels differ: the most, where, and how often by more than any smooth wave of this scale
 * has it. */
typedef struct steepness {
    double worst;
    int    x, y, jumps;
} steepness;

static steepness steepness_of(const shot *s)
{
    steepness r = {0};
    for (int y = RIM; y < s->height - RIM; y++)
        for (int x = RIM; x < s->width - RIM; x++)
            for (int c = 0; c < 2; c++) {
                double step =
                    fmax(fabs(at(s, x, y, c) - at(s, x + 1, y, c)), fabs(at(s, x, y, c) - at(s, x, y + 1, c)));
                if (step < 0.2 && step <= r.worst)
                    continue;
                if (!near_figure(s, x, y))
                    continue;
                r.jumps += step > 0.2;
                if (step > r.worst) {
                    r.worst = step;
                    r.x = x;
                    r.y = y;
                }
            }
    return r;
}

/* Spread from the surfaces the field has no jumps, where depth has them too; that of the enlarged model has. */
static void continuity(void)
{
    shape s = {0};
    shot  wall;
    int   smooth_jumps = 0, enlarged_jumps = 0;
    model(&s);
    if (wall_field(&wall, "\"lock\":\"object\"", &front))
        check_note("a wall's greatest difference of neighbouring pixels: %.3f", steepness_of(&wall).worst);
    shot_release(&wall);
    for (int frame = 0; frame < 60; frame += 20) {
        shot      smooth, enlarged;
        shot_view view = frame_view(frame);
        bool      ok = field_of(&smooth, &s, "\"lock\":\"object\"", &view);
        if (field_of(&enlarged, &s, "\"lock\":\"object\",\"outward\":\"enlarged\"", &view) && ok) {
            steepness a = steepness_of(&smooth), b = steepness_of(&enlarged);
            check_at_most("S12", a.worst, 4 * 2 * pi / 60,
                          "frame %d: greatest difference of neighbouring pixels (at %d, %d from the upper left), "
                          "spread from surfaces",
                          frame, a.x, a.y);
            check_at_least("S13", b.worst / a.worst, 1.5, "  how much more it is with the enlarged model");
            check_note("enlarged: %.3f; pairs that differ by more than 0.2: %d and %d", b.worst, a.jumps, b.jumps);
            smooth_jumps += a.jumps;
            enlarged_jumps += b.jumps;
        }
        shot_release(&smooth);
        shot_release(&enlarged);
    }
    check_at_least("S13", enlarged_jumps, 100, "jumps of the field of the enlarged model");
    check_at_most("S13", (double)smooth_jumps / enlarged_jumps, 1 / 3.0,
                  "  jumps of the field spread from surfaces over those");
    shape_release(&s);
}

/* --- beside the model ----------------------------------------------------------------------------------- */

static void enlarged(void)
{
    static const double distances[] = {6, 10, 24};
    for (int k = 0; k < 3; k++)
        for (int wide = 0; wide < 2; wide++) {
            char      settings[96];
            shape     s = {0};
            shot      field;
            shot_view view = {
                .width = 360, .height = 360, .eye = {0, 0.3 * distances[k], distances[k]}, .up = {0, 1, 0}};
            int width = wide ? 30 : 12, band = 0, empty = 0, beyond = 0, traces = 0, inner = 0, holes = 0;
            shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
            snprintf(settings, sizeof settings,
                     "\"lock\":\"object\",\"amount\":%d,\"scale\":24,\"outward\":\"enlarged\",\"enlarge\":%d", width,
                     width);
            if (field_of(&field, &s, settings, &view)) {
                dvec   middle = shot_project(&field, dvec_of(0, 0, 0));
                double radius = 0;
                for (int i = 0; i < 360 * 360; i++)
                    if (isfinite(field.depth[i]))
                        radius = fmax(radius, hypot(i % 360 + 0.5 - middle.x, i / 360 + 0.5 - middle.y));
                for (int i = 0; i < 360 * 360; i++) {
                    double far = hypot(i % 360 + 0.5 - middle.x, i / 360 + 0.5 - middle.y) - radius;
                    bool   there = fabsf(field.uncertainty[i][0]) > 1e-4f || fabsf(field.uncertainty[i][1]) > 1e-4f;
                    band += far > 1 && far < width - 3;
                    empty += far > 1 && far < width - 3 && !there;
                    inner += far < -1;
                    holes += far < -1 && !there;
                    beyond += far > width + 6;
                    traces += far > width + 6 && there;
                }
                check_at_most(
                    "S13", (double)empty / band, 0.02,
                    "enlarged by %d px, distance %g: fraction of the band outside the silhouette (radius %.0f) "
                    "without a field",
                    width, distances[k], radius);
                check_at_most("S13", (double)holes / inner, 0.02, "  fraction of what is inside without one");
                check_at_most("S13", (double)traces / beyond, 0.002, "  fraction of what is farther outside with one");
            }
            shot_release(&field);
            shape_release(&s);
        }
}

/* Outside, as far as a displaced line may lie, the field is as strong as inside, and nowhere missing. */
static void outside(void)
{
    static const int cases[][2] = {{4, 60}, {20, 60}, {40, 60}, {20, 20}, {40, 12}};
    for (int k = 0; k < 5; k++) {
        char      settings[96];
        shape     s = {0};
        shot      field;
        shot_view view = front;
        view.width = view.height = 480;
        shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 48, 96, true); /* 112 px */
        snprintf(settings, sizeof settings, "\"lock\":\"object\",\"amount\":%d,\"scale\":%d", cases[k][0], cases[k][1]);
        if (field_of(&field, &s, settings, &view)) {
            double sum[2] = {0};
            int    count[2] = {0}, missing = 0;
            for (int i = 0; i < 480 * 480; i++) {
                double far = hypot(i % 480 - 239.5, i / 480 - 239.5) - 112;
                if (fabs(far) > cases[k][0])
                    continue;
                double n = (double)field.uncertainty[i][0], m = (double)field.uncertainty[i][1];
                sum[far > 0] += n * n + m * m;
                count[far > 0]++;
                missing += far > 0 && hypot(n, m) < 1e-4;
            }
            check_near("S13", sqrt(sum[1] / count[1] / (sum[0] / count[0])), 0.9, 0.4,
                       "scale %d: strength of the field up to %d px outside over that inside", cases[k][1],
                       cases[k][0]);
            check_at_most("S13", (double)missing / count[1], 0.01, "  fraction of the pixels there without a field");
        }
        shot_release(&field);
        shape_release(&s);
    }
}

/* --- of other properties -------------------------------------------------------------------------------- */

static void by_normal(void)
{
    shape     s = {0};
    shot      field;
    shot_view view = {.width = 360, .height = 360, .eye = {4, 3, 5}, .up = {0, 1, 0}};
    shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    if (field_of(&field, &s, "\"lock\":\"object\",\"by\":\"normal\"", &view)) {
        double low[3], high[3];
        int    count[3] = {0};
        for (int y = 20; y < 340; y++)
            for (int x = 20; x < 340; x++) {
                const float *n = field.normal[y * 360 + x];
                if (!field.id[y * 360 + x] || !amid(&field, x, y, 26, true))
                    continue;
                int    face = n[1] > 0.5f ? 0 : n[0] > 0 ? 1 : 2;
                double v = at(&field, x, y, 0);
                low[face] = count[face] ? fmin(low[face], v) : v;
                high[face] = count[face] ? fmax(high[face], v) : v;
                count[face]++;
            }
        for (int k = 0; k < 3; k++)
            if (check_at_least("S12", count[k], 500, "by normal: pixels amid face %d of a box", k))
                check_at_most("S12", high[k] - low[k], 0.01, "  difference of the field among them (about %.3f)",
                              low[k]);
        check_at_least("S12", fmax(fabs(low[0] - low[1]), fmax(fabs(low[1] - low[2]), fabs(low[0] - low[2]))), 0.05,
                       "  difference of faces");
    }
    shot_release(&field);
    shape_release(&s);
}

static void by_curvature(void)
{
    shape s = {0};
    shot  field;
    shape_sphere(&s, "large", dvec_of(-0.7, 0, 0), 1.2, 96, 192, true);
    shape_sphere(&s, "small", dvec_of(1.3, 0, 0), 0.6, 96, 192, true);
    if (field_of(&field, &s, "\"lock\":\"object\",\"by\":\"curvature\"", &front)) {
        double low[2] = {0}, high[2] = {0}, mean[2] = {0};
        int    count[2] = {0};
        for (int y = 20; y < 380; y++)
            for (int x = 20; x < 380; x++) {
                const float *n = field.normal[y * 400 + x];
                if (!field.id[y * 400 + x] || n[2] < 0.6f || !amid(&field, x, y, 24, false))
                    continue;
                int    ball = field.id[y * 400 + x] - 1;
                double v = at(&field, x, y, 0);
                low[ball] = count[ball] ? fmin(low[ball], v) : v;
                high[ball] = count[ball] ? fmax(high[ball], v) : v;
                mean[ball] += v;
                count[ball]++;
            }
        for (int k = 0; k < 2; k++)
            if (check_at_least("S12", count[k], 500, "by curvature: pixels amid the %s ball", k ? "small" : "large"))
                check_at_most("S12", high[k] - low[k], 0.12, "  difference of the field among them (mean %.3f)",
                              mean[k] / count[k]);
        check_at_least("S12", fabs(mean[0] / count[0] - mean[1] / count[1]), 0.05, "  difference of the balls");
    }
    shot_release(&field);
    shape_release(&s);
}

/* --- narrow parts ----------------------------------------------------------------------------------------- */

/* Greatest displacement on a bar, pixels, and the bar's width. */
static double bar_moves(const char *settings, double amount, int *width)
{
    shape  s = {0};
    shot   field;
    double worst = 0;
    shape_box(&s, "bar", dvec_of(-0.06, -1, -0.1), dvec_of(0.06, 1, 0.1));
    *width = 0;
    if (field_of(&field, &s, settings, &front))
        for (int y = 0; y < field.height; y++)
            for (int x = 0; x < field.width; x++)
                if (!isinf(field.depth[y * field.width + x])) {
                    *width += y == field.height / 2;
                    worst = fmax(worst, amount * fmax(fabs(at(&field, x, y, 0)), fabs(at(&field, x, y, 1))));
                }
    shot_release(&field);
    shape_release(&s);
    return worst;
}

static void narrow_parts(void)
{
    int    width, same;
    double freely = bar_moves("\"amount\":20", 20, &width), held = bar_moves("\"amount\":20,\"narrow\":0.2", 20, &same);
    check_at_least("S02", width, 4, "pixels across the bar");
    check_at_least("S02", freely, 0.5 * width, "pixels that the bar is moved by freely");
    check_at_most("S02", held, 0.2 * width + 0.5, "  and by with a fifth of its width allowed");
    check_at_least("S02", held, 0.02 * width, "  which is not nothing");
    shot wall, same_wall;
    bool ok = wall_field(&wall, "\"seed\":1", &front);
    if (wall_field(&same_wall, "\"seed\":1,\"narrow\":0.2", &front) && ok)
        check_at_most("S02", largest_difference(&wall, &same_wall), 0, "change of the field on a wide wall");
    shot_release(&wall);
    shot_release(&same_wall);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"noise", noise},
        {"seeds", seeds_and_time},
        {"waves", waves},
        {"page", page_locked},
        {"octaves", octaves},
        {"tiles", tiles},
        {"middle", middle},
        {"turbulence", turbulence},
        {"rim", rim},
        {"distances", distances},
        {"coherence", coherence},
        {"standstill", standstill},
        {"panned", panned},
        {"moved part", moved_part},
        {"continuity", continuity},
        {"enlarged", enlarged},
        {"outside", outside},
        {"normal", by_normal},
        {"curvature", by_curvature},
        {"narrow", narrow_parts},
    };
    int status = check_main(argc, argv, "sketch_field", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
