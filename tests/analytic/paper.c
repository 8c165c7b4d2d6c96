/* Paper on the page: ink on hills and on flanks that face the stroke, bare paper, tones, grounds, samples, sizes;
 * and a paper that goes with the model, measured against how its surface moves. Row P28 of the notes on the pencil
 * city. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone/paper.h"
#include "halftone_scenes.h"
#include "picture.h"
#include "shape.h"

enum { SIDE = 256, KINDS = PAPER_COUNT };

typedef struct wanted {
    int         paper, samples, size; /* 0: 1 sample, SIDE */
    bool        es;
    const char *ink, *ground, *keys; /* of the sheet, beginning with a comma, or "" */
} wanted;

/* The papers themselves, made once. */
static const paper *paper_of(int kind)
{
    static paper papers[KINDS];
    if (!papers[kind].heights && !check_that("P28", paper_create(&papers[kind], (paper_kind)kind, 0, NULL) == LMN_OK,
                                             "%s can be made", paper_names[kind]))
        exit(2);
    return &papers[kind];
}

/* A wall of one colour in the upper three quarters of the page. */
static bool take(shot *out, wanted w)
{
    char look[600];
    int  size = w.size ? w.size : SIDE;
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"%s\",\"paper\":\"%s\"%s},\"rules\":[{\"surface\":{"
             "\"technique\":\"flat\",\"colour\":\"%s\"}}]}",
             w.ground, paper_names[w.paper], w.keys, w.ink);
    halftone_scene s = {0};
    shot_view      view = halftone_view(size, size, size / 4.0);
    view.samples = w.samples;
    view.es = w.es;
    view.without_maps = true; /* nearly all of the time would go into writing and reading them */
    halftone_add_wall(&s, "wall", (halftone_wall){-1, 1, 0, 6, 6, 1});
    bool ok = halftone_shot(out, &s, "paper.gltf", look, NULL, &view);
    halftone_release(&s);
    return ok;
}

/* A grey whose ink on white is this fraction; its ink as it is rounded. */
static const char *grey(double ink, double *rounded)
{
    static char texts[8][8];
    static int  next;
    int         byte = (int)(picture_level(1 - ink) + 0.5);
    next = (next + 1) % 8;
    snprintf(texts[next], sizeof texts[next], "#%02x%02x%02x", byte, byte, byte);
    if (rounded)
        *rounded = 1 - picture_shown((uint8_t)byte);
    return texts[next];
}

static bool same_pixels(const shot *a, const shot *b, int first_row, int rows)
{
    return memcmp(a->picture + 4 * (size_t)first_row * (size_t)a->width,
                  b->picture + 4 * (size_t)first_row * (size_t)a->width, 4 * (size_t)rows * (size_t)a->width) == 0;
}

/* --- ink and grain -------------------------------------------------------------------------------------- */

/* Height and lean towards the stroke under a pixel of paper that lies still, between texels. */
static void under(const paper *p, double size, int x, int row, double *height, double *facing)
{
    double u = (x + 0.5) * PAPER_TEXELS_A_GRAIN / size - 0.5,
           v = (SIDE - row - 0.5) * PAPER_TEXELS_A_GRAIN / size - 0.5;
    int left = (int)floor(u), low = (int)floor(v);
    *height = *facing = 0;
    for (int k = 0; k < 4; k++) {
        float  normal[3];
        int    i = left + (k & 1), j = low + k / 2;
        double weight = (k & 1 ? u - left : 1 - u + left) * (k / 2 ? v - low : 1 - v + low);
        paper_normal(p, i, j, normal);
        *height += weight * (double)p->heights[(j & (PAPER_SIDE - 1)) * PAPER_SIDE + (i & (PAPER_SIDE - 1))];
        *facing += weight * ((double)normal[1] - (double)normal[0]) * 0.70711;
    }
}

typedef struct relation {
    double sums[2], squares[2], product;
    int    count;
} relation;

static void relate(relation *r, double a, double b)
{
    r->sums[0] += a;
    r->sums[1] += b;
    r->squares[0] += a * a;
    r->squares[1] += b * b;
    r->product += a * b;
    r->count++;
}

static double correlation(const relation *r)
{
    double n = r->count, a = r->squares[0] / n - r->sums[0] * r->sums[0] / n / n,
           b = r->squares[1] / n - r->sums[1] * r->sums[1] / n / n;
    return (r->product / n - r->sums[0] * r->sums[1] / n / n) / sqrt(fmax(a * b, 1e-20));
}

/* Ink of the wall against what lies under it. `light`: the ink is lighter than its ground. */
static void compare(const shot *s, const paper *p, double size, bool light)
{
    relation of_height = {{0}}, of_facing = {{0}}, of_another = {{0}};
    double   flank[2] = {0};
    int      flanks[2] = {0};
    for (int y = 0; y < SIDE / 2; y++)
        for (int x = 0; x < SIDE; x++) {
            double height, facing, elsewhere, unused, ink = light ? 1 - halftone_ink(s, x, y) : halftone_ink(s, x, y);
            under(p, size, x, y, &height, &facing);
            under(p, size, x + 97, y + 31, &elsewhere, &unused);
            relate(&of_height, ink, height);
            relate(&of_facing, ink, facing);
            relate(&of_another, ink, elsewhere);
            if (height > 0.4 && height < 0.6 && fabs(facing) > 0.15) {
                flank[facing > 0] += ink;
                flanks[facing > 0]++;
            }
        }
    check_at_least("P28", correlation(&of_height), 0.75, "%s%s: correlation of ink with height", paper_names[p->kind],
                   light ? ", light on dark" : "");
    check_at_least("P28", correlation(&of_facing), 0.2, "with the lean of its normals towards the stroke");
    check_at_most("P28", fabs(correlation(&of_another)), p->kind < PAPER_LAID ? 0.05 : 0.6,
                  "with the height elsewhere");
    check_at_least("P28", flank[1] / flanks[1] - flank[0] / flanks[0], 0.05,
                   "more ink on flanks that face it than on those that do not, alike in height");
}

static void ink_stays_on_hills(void)
{
    for (int kind = 1; kind < KINDS; kind++) {
        shot s;
        if (take(&s,
                 (wanted){.paper = kind, .ink = grey(0.5, NULL), .ground = "#ffffff", .keys = ",\"grain_size\":3"})) {
            compare(&s, paper_of(kind), 3, false);
            shot_release(&s);
        }
        if (take(&s, (wanted){.paper = kind, .ink = "#888888", .ground = "#102018", .keys = ",\"grain_size\":3"})) {
            compare(&s, paper_of(kind), 3, true);
            shot_release(&s);
        }
    }
}

static void bare_paper_is_its_ground(void)
{
    static const char *const grounds[] = {"#ffffff", "#e8dcc0", "#26322e", "#fefefe", "#000000", "none", "#80604080"};
    for (int g = 0; g < 7; g++)
        for (int samples = 1; samples <= 4; samples += 3) {
            const char *ink = g == 2 ? "#a0a0a0" : g == 4 ? "#909090" : g >= 5 ? "#88a87840" : "#88a878";
            shot        without, with;
            if (!take(&without, (wanted){.samples = samples, .ink = ink, .ground = grounds[g], .keys = ""}))
                return;
            for (int kind = 1; kind < KINDS; kind++)
                if (take(&with, (wanted){.paper = kind,
                                         .samples = samples,
                                         .ink = ink,
                                         .ground = grounds[g],
                                         .keys = ",\"grain\":1,\"relief\":0"})) {
                    check_that("P28", same_pixels(&without, &with, SIDE * 3 / 4, SIDE / 4),
                               "%s, %s, %d samples: bare paper is the ground to the byte", paper_names[kind],
                               grounds[g], samples);
                    check_at_least("P28", shot_differing(&without, &with, 8), SIDE * SIDE / 4,
                                   "pixels of ink that it changes");
                    shot_release(&with);
                }
            shot_release(&without);
        }
}

static void no_grain_is_no_paper(void)
{
    shot none, grainless;
    if (!take(&none, (wanted){.ink = "#777777", .ground = "#ffffff", .keys = ""}))
        return;
    if (take(&grainless,
             (wanted){.paper = PAPER_ROUGH, .ink = "#777777", .ground = "#ffffff", .keys = ",\"grain\":0"})) {
        check_that("P28", same_pixels(&none, &grainless, 0, SIDE), "grain 0 is no paper to the byte");
        shot_release(&grainless);
    }
    shot_release(&none);
}

/* Mean ink of the wall. */
static double mean_of(const shot *s)
{
    return halftone_mean(s, 0, 0, s->width, s->height * 3 / 4);
}

static void tones_stay(void)
{
    static const struct {
        const char *keys;
        double      mid, full; /* how much off, up to half ink and above */
    } cases[] = {{",\"grain\":1,\"pressure\":1", 0.012, 0.012},
                 {"", 0.02, 0.035},
                 {",\"grain\":1,\"pressure\":0.6", 0.08, 0.2},
                 {",\"motion\":\"zooming\",\"pressure\":1", 0.015, 0.015}};
    for (int k = 0; k < 4; k++)
        for (int kind = 1; kind < KINDS; kind++) {
            double mid = 0, full = 0;
            for (int i = 2; i <= 20; i += 2) {
                double ink;
                shot   s;
                if (!take(&s,
                          (wanted){
                              .paper = kind, .ink = grey(i / 20.0, &ink), .ground = "#ffffff", .keys = cases[k].keys}))
                    return;
                double off = fabs(mean_of(&s) - ink);
                shot_release(&s);
                mid = i <= 10 ? fmax(mid, off) : mid;
                full = fmax(full, off);
            }
            check_at_most("P28", mid, cases[k].mid, "%s%s: mean ink off, up to half ink", paper_names[kind],
                          cases[k].keys);
            check_at_most("P28", full, cases[k].full, "up to full ink");
        }
}

/* Between its ground and the strongest ink of its hue: differences from the ground keep their proportions, whatever
 * the grain makes of them. */
static void ink_keeps_its_hue(void)
{
    static const struct {
        const char *ink, *ground;
    } cases[] = {{"#d04020", "#ffffff"}, {"#70a0d0", "#f4ecd8"}, {"#f0c040", "#20283c"}};
    for (int k = 0; k < 3; k++) {
        shot   plain, grained;
        double off = 0;
        int    at = SIDE / 2 * SIDE + 7, bare = (SIDE - 2) * SIDE + 7;
        if (!take(&plain, (wanted){.ink = cases[k].ink, .ground = cases[k].ground, .keys = ""}))
            return;
        if (take(&grained, (wanted){.paper = PAPER_ROUGH,
                                    .ink = cases[k].ink,
                                    .ground = cases[k].ground,
                                    .keys = ",\"grain\":1,\"pressure\":0.8"})) {
            double wanted[3], ground[3], size = 0;
            for (int c = 0; c < 3; c++) {
                ground[c] = picture_shown(plain.picture[4 * bare + c]);
                wanted[c] = picture_shown(plain.picture[4 * at + c]) - ground[c];
                size += wanted[c] * wanted[c];
            }
            for (int i = 0; i < SIDE * SIDE * 3 / 4; i++) {
                double along = 0;
                for (int c = 0; c < 3; c++)
                    along += (picture_shown(grained.picture[4 * i + c]) - ground[c]) * wanted[c] / size;
                for (int c = 0; c < 3; c++)
                    off = fmax(off, fabs(picture_shown(grained.picture[4 * i + c]) - ground[c] - along * wanted[c]));
            }
            check_at_most("P28", off, 0.01, "%s on %s: how far a pixel is off the line from its ground through its ink",
                          cases[k].ink, cases[k].ground);
            shot_release(&grained);
        }
        shot_release(&plain);
    }
}

/* Hills get no more than the pencil has, and tones stay. */
static void hills_get_no_more_than_the_pencil_has(void)
{
    static const struct {
        const char *ink, *ground, *keys;
        int         byte, sign; /* of the strongest ink; whether ink is darker or lighter than its ground */
    } cases[] = {{"#dadada", "#ffffff", ",\"grain\":1,\"pressure\":1,\"ink\":\"#cbcbcb\"", 0xcb, -1},
                 {"#959595", "#202020", ",\"grain\":1,\"pressure\":1,\"ink\":\"#aaaaaa\"", 0xaa, 1}};
    for (int k = 0; k < 2; k++)
        for (int kind = 1; kind < KINDS; kind++) {
            shot limited, not ;
            int  beyond[2] = {0};
            if (!take(&limited,
                      (wanted){.paper = kind, .ink = cases[k].ink, .ground = cases[k].ground, .keys = cases[k].keys}))
                return;
            if (take(&not, (wanted){.paper = kind,
                                    .ink = cases[k].ink,
                                    .ground = cases[k].ground,
                                    .keys = ",\"grain\":1,\"pressure\":1"})) {
                for (int i = 0; i < SIDE * SIDE * 3 / 4; i++) {
                    beyond[0] += (limited.picture[4 * i] - cases[k].byte) * cases[k].sign > 1;
                    beyond[1] += (not .picture[4 * i] - cases[k].byte) * cases[k].sign > 1;
                }
                check_at_most("P28", beyond[0], 0, "%s: pixels of %s on %s beyond the pencil's own", paper_names[kind],
                              cases[k].ink, cases[k].ground);
                check_at_least("P28", beyond[1], 500, "without a limit");
                check_near("P28", mean_of(&limited), mean_of(&not ), 0.012, "mean ink with and without");
                shot_release(&not );
            }
            shot_release(&limited);
        }
}

static void more_ink_gives_more(void)
{
    for (int kind = 1; kind < KINDS; kind++) {
        shot   before = {0}, now;
        int    less = 0;
        double bare_faint = 0, bare_firm = 0;
        for (int i = 1; i <= 20; i++) {
            double ink;
            if (!take(&now, (wanted){.paper = kind,
                                     .ink = grey(i / 20.0, &ink),
                                     .ground = "#ffffff",
                                     .keys = ",\"grain\":1,\"pressure\":1"}))
                break;
            for (int y = 0; y < SIDE * 3 / 4; y++)
                for (int x = 0; x < SIDE; x++) {
                    less += before.picture && now.picture[4 * (y * SIDE + x)] > before.picture[4 * (y * SIDE + x)];
                    bare_faint += i == 4 && halftone_ink(&now, x, y) < 0.3 * ink;
                    bare_firm += i == 18 && halftone_ink(&now, x, y) < 0.3 * ink;
                }
            if (i == 20)
                check_near("P28", mean_of(&now), 1, 1e-6, "%s: full ink at full pressure fills the valleys",
                           paper_names[kind]);
            if (before.picture)
                shot_release(&before);
            before = now;
        }
        if (before.picture)
            shot_release(&before);
        check_at_most("P28", less, 0, "pixels that get lighter where there is more ink, in 20 steps");
        check_at_least("P28", bare_faint - bare_firm, 0.1 * SIDE * SIDE * 3 / 4,
                       "pixels that faint ink leaves out and firm ink does not");
    }
}

static void samples_and_size_do_not_matter(void)
{
    for (int kind = 1; kind < KINDS; kind++) {
        shot   one, four, large, es;
        wanted w = {.paper = kind, .ink = "#888888", .ground = "#f0f0f0", .keys = ",\"grain_size\":3"};
        if (!take(&one, w))
            return;
        w.samples = 4;
        if (take(&four, w)) {
            check_at_most("P28", shot_differing(&one, &four, 1), 0, "%s: pixels that 4 samples change",
                          paper_names[kind]);
            shot_release(&four);
        }
        w.samples = 1;
        w.es = true;
        if (take(&es, w)) {
            check_at_most("P28", shot_differing(&one, &es, 1), 0, "pixels in which OpenGL ES differs");
            shot_release(&es);
        }
        w.es = false;
        w.size = 2 * SIDE;
        if (take(&large, w)) {
            int differ = 0;
            for (int y = 0; y < SIDE; y++) /* both have ink in rows from SIDE / 2 to SIDE from the bottom */
                for (int x = 0; x < SIDE && y >= SIDE / 2; x++)
                    differ += abs(one.picture[4 * ((SIDE - 1 - y) * SIDE + x)] -
                                  large.picture[4 * ((2 * SIDE - 1 - y) * 2 * SIDE + x)]) > 1;
            check_at_most("P28", differ, 0, "pixels in which a larger page has another grain");
            shot_release(&large);
        }
        shot_release(&one);
    }
}

static void transparent_pages_keep_their_ink(void)
{
    for (int kind = 1; kind < KINDS; kind++) {
        shot   s;
        double alpha = 0, squares = 0;
        int    wrong = 0, count = SIDE * SIDE * 3 / 4;
        if (!take(&s,
                  (wanted){
                      .paper = kind, .ink = "#40608080", .ground = "none", .keys = ",\"relief\":0.5,\"pressure\":1"}))
            return;
        for (int i = 0; i < count; i++) {
            const uint8_t *p = s.picture + 4 * i;
            alpha += p[3] / 255.0 / count;
            squares += p[3] / 255.0 * p[3] / 255.0 / count;
            wrong += p[3] > 16 && (abs(p[0] - 0x40) > 2 || abs(p[1] - 0x60) > 2 || abs(p[2] - 0x80) > 2);
        }
        for (int i = count; i < SIDE * SIDE; i++)
            wrong += s.picture[4 * i + 3] != 0;
        check_near("P28", alpha, 128 / 255.0, 0.012, "%s, no ground: mean opacity", paper_names[kind]);
        check_at_least("P28", sqrt(squares - alpha * alpha), 0.05, "deviation of opacity");
        check_at_most("P28", wrong, 0, "pixels of another colour than the ink's");
        shot_release(&s);
    }
}

static void relief_shows_on_bare_paper(void)
{
    for (int kind = 1; kind < KINDS; kind++) {
        shot     s;
        relation lit = {{0}};
        if (take(&s, (wanted){.paper = kind,
                              .ink = "#888888",
                              .ground = "#e0d8c8",
                              .keys = ",\"relief\":0.4,\"grain_size\":3"})) {
            for (int y = SIDE * 3 / 4; y < SIDE; y++)
                for (int x = 0; x < SIDE; x++) {
                    double height, facing;
                    under(paper_of(kind), 3, x, y, &height, &facing);
                    relate(&lit, -halftone_ink(&s, x, y), facing);
                }
            check_at_least("P28", correlation(&lit), 0.95,
                           "%s: correlation of bare paper's light with the lean to the upper left", paper_names[kind]);
            shot_release(&s);
        }
    }
}

/* --- motion --------------------------------------------------------------------------------------------- */

enum { WIDE = 288, HIGH = 240, PATCH = 10, AROUND = 9, STEP = 12 };

typedef struct stand {
    double azimuth, elevation, distance, aside, roll; /* degrees; sizes of the model; the same; degrees */
} stand;

static shot_view view_at(stand s)
{
    const double degree = 0.017453292519943295;
    double       a = s.azimuth * degree, e = s.elevation * degree, r = s.roll * degree;
    dvec         to = {sin(a) * cos(e), sin(e), cos(a) * cos(e)}, right = {cos(a), 0, -sin(a)},
         up = {-sin(a) * sin(e), cos(e), -cos(a) * sin(e)};
    dvec target = dvec_scale(right, s.aside);
    return (shot_view){.width = WIDE,
                       .height = HIGH,
                       .eye = dvec_add(target, dvec_scale(to, s.distance)),
                       .target = target,
                       .up = dvec_add(dvec_scale(right, sin(r)), dvec_scale(up, cos(r))),
                       .fov_deg = 30};
}

static bool on_model(const shot *s, int x, int y, int around)
{
    for (int j = y - around; j <= y + around; j += around)
        for (int i = x - around; i <= x + around; i += around)
            if (i < 0 || j < 0 || i >= s->width || j >= s->height || !isfinite(s->depth[j * s->width + i]))
                return false;
    return true;
}

/* Stops where it is not below `enough` any more: most of a search's candidates are given up after a few rows. */
static double unlike(const shot *a, const shot *b, int x, int y, int dx, int dy, double enough)
{
    double sum = 0;
    for (int j = -PATCH; j <= PATCH && sum < enough; j++)
        for (int i = -PATCH; i <= PATCH; i++) {
            double off =
                a->picture[4 * ((y + j) * a->width + x + i)] - b->picture[4 * ((y + j + dy) * b->width + x + i + dx)];
            sum += off * off;
        }
    return sum;
}

static double vertex(double before, double at, double after)
{
    double bend = before + after - 2 * at;
    return bend > 0 ? 0.5 * (before - after) / bend : 0;
}

/* Where the grain around a pixel has gone, by the best match between the pictures. */
static dvec grain_motion(const shot *a, const shot *b, int x, int y)
{
    int    best_x = 0, best_y = 0;
    double least = INFINITY;
    for (int dy = -AROUND; dy <= AROUND; dy++)
        for (int dx = -AROUND; dx <= AROUND; dx++) {
            double now = unlike(a, b, x, y, dx, dy, least);
            if (now < least) {
                least = now;
                best_x = dx;
                best_y = dy;
            }
        }
    dvec out = {best_x, best_y, 0};
    if (least > 0) {
        out.x += vertex(unlike(a, b, x, y, best_x - 1, best_y, INFINITY), least,
                        unlike(a, b, x, y, best_x + 1, best_y, INFINITY));
        out.y += vertex(unlike(a, b, x, y, best_x, best_y - 1, INFINITY), least,
                        unlike(a, b, x, y, best_x, best_y + 1, INFINITY));
    }
    return out;
}

/* Where the surface under a pixel has gone. */
static dvec surface_motion(const shot *a, const shot *b, int x, int y)
{
    dvec origin, direction, position = {0};
    shot_ray(a, x + 0.5, y + 0.5, &origin, &direction);
    dvec   from = shot_to_eye(a, origin, 1), along = shot_to_eye(a, direction, 0);
    double t = (-(double)a->depth[y * a->width + x] - from.z) / along.z;
    position = dvec_add(origin, dvec_scale(direction, t));
    dvec to = shot_project(b, position);
    return (dvec){to.x - x - 0.5, to.y - y - 0.5, 0};
}

typedef struct slip {
    double off, moved;
    int    count;
} slip;

static void measure(slip *out, const shot *a, const shot *b)
{
    const int margin = PATCH + AROUND + 2;
    for (int y = margin; y < HIGH - margin; y += STEP)
        for (int x = margin; x < WIDE - margin; x += STEP) {
            if (!on_model(a, x, y, margin))
                continue;
            dvec   surface = surface_motion(a, b, x, y), grain = grain_motion(a, b, x, y);
            double off = hypot(grain.x - surface.x, grain.y - surface.y), moved = hypot(surface.x, surface.y);
            if (moved > AROUND - 2)
                continue;
            out->off += off;
            out->moved += moved;
            out->count++;
        }
}

/* One small move from each of several places. */
typedef struct sequence {
    const char *name;
    stand       first, next, move; /* `next` is added from position to place, `move` is what is measured */
    int         positions;
} sequence;

static const sequence sequences[] = {
    {"orbit", {0, 10, 7, 0, 0}, {45, 0, 0, 0, 0}, {1.5, 0, 0, 0, 0}, 8},
    {"orbit from above", {0, 40, 7, 0, 0}, {75, 0, 0, 0, 0}, {1.5, 0, 0, 0, 0}, 5},
    {"tilt", {30, -20, 7, 0, 0}, {20, 10, 0, 0, 0}, {0, 1.5, 0, 0, 0}, 6},
    {"pan", {20, 15, 7, -0.4, 0}, {30, 0, 0, 0.2, 0}, {0, 0, 0, 0.05, 0}, 5},
    {"roll", {20, 15, 7, 0, -60}, {30, 0, 0, 0, 25}, {0, 0, 0, 0, 2}, 5},
    {"zoom", {20, 15, 8, 0, 0}, {40, 0, -0.6, 0, 0}, {0, 0, -0.2, 0, 0}, 6},
};

static stand moved_by(stand s, stand by, double times)
{
    return (stand){s.azimuth + times * by.azimuth, s.elevation + times * by.elevation, s.distance + times * by.distance,
                   s.aside + times * by.aside, s.roll + times * by.roll};
}

static slip run(const shape *model, const sequence *q, const char *motion)
{
    slip out = {0};
    char look[400];
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"paper\":\"drawing\",\"grain\":1,\"grain_size\":4,\"motion\":"
             "\"%s\"},\"rules\":[{\"surface\":{\"technique\":"
             "\"flat\",\"colour\":\"#bbbbbb\"}}]}",
             motion);
    for (int i = 0; i < q->positions; i++) {
        shot      a, b;
        stand     here = moved_by(q->first, q->next, i);
        shot_view from = view_at(here), to = view_at(moved_by(here, q->move, 1));
        to.without_maps = true; /* only depth of the first one is needed */
        if (!shot_of_shape(&a, model, "moving.glb", look, NULL, &from))
            return out;
        if (shot_of_shape(&b, model, "moving.glb", look, NULL, &to)) {
            measure(&out, &a, &b);
            shot_release(&b);
        }
        shot_release(&a);
    }
    return out;
}

static void paper_goes_with_the_model(void)
{
    static const char *const motions[] = {"fixed", "following", "zooming"}, *const names[] = {"ball", "box"};
    /* What is left of the shower door, by sequence: of a ball, whose points differ in speed, about 0.3 is the least
     * that a stiff paper can have. */
    static const double limits[2][6] = {{0.45, 0.7, 0.45, 0.12, 0.15, 1}, {0.55, 0.7, 0.55, 0.12, 0.15, 0.3}};
    shape               models[2] = {{0}};
    shape_sphere(&models[0], "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
    shape_box(&models[1], "box", dvec_of(-1, -0.7, -0.85), dvec_of(1, 0.7, 0.85));
    for (int k = 0; k < 2; k++)
        for (int q = 0; q < 6; q++)
            for (int m = 0; m < 3; m++) {
                slip   s = run(&models[k], &sequences[q], motions[m]);
                double fraction = s.off / fmax(s.moved, 1e-9);
                check_at_least("P28", s.count, 60, "%s, %s, %s: places measured, which moved by %.2f px", names[k],
                               sequences[q].name, motions[m], s.moved / fmax(s.count, 1));
                if (m == 0)
                    check_near("P28", fraction, 1, 1e-9,
                               "slip of the paper over the surface as a fraction of its motion");
                else
                    check_at_most("P28", fraction, limits[m - 1][q],
                                  "slip of the paper over the surface as a fraction of its motion");
            }
    shape_release(&models[0]);
    shape_release(&models[1]);
}

/* A full turn, and the same view twice, give the same page; a little turn a little change. */
static void paper_depends_on_the_view_alone(void)
{
    static const char *const motions[] = {"following", "zooming"};
    shape                    model = {0};
    shape_sphere(&model, "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
    for (int m = 0; m < 2; m++) {
        shot      first, again, round;
        char      look[400];
        stand     here = {179.99, 12, 6, 0.1, 0}, there = {-179.99, 12, 6, 0.1, 0}, far = {20, 12, 6, 0.1, 0};
        shot_view views[3] = {view_at(here), view_at(there), view_at(far)};
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"finish\":{\"paper\":\"drawing\",\"grain_size\":4,\"motion\":\"%s\"},"
                 "\"rules\":[{\"surface\":{\"technique\":\"flat\","
                 "\"colour\":\"#bbbbbb\"}}]}",
                 motions[m]);
        if (!shot_of_shape(&first, &model, "round.glb", look, NULL, &views[0]))
            return;
        if (shot_of_shape(&round, &model, "round.glb", look, NULL, &views[1])) {
            check_at_most("P28", halftone_difference(&first, &round), 0.01,
                          "%s: difference of the page where the turn closes", motions[m]);
            shot_release(&round);
        }
        if (shot_of_shape(&round, &model, "round.glb", look, NULL, &views[2])) {
            check_at_least("P28", halftone_difference(&first, &round), 0.02, "difference from another side");
            shot_release(&round);
        }
        if (shot_of_shape(&again, &model, "round.glb", look, NULL, &views[0])) {
            check_that("P28", same_pixels(&first, &again, 0, HIGH), "the same view again gives the same bytes");
            shot_release(&again);
        }
        shot_release(&first);
    }
    shape_release(&model);
}

/* All around in steps of a degree there is no jump. */
static void paper_never_jumps(void)
{
    static const char *const motions[] = {"following", "zooming"};
    shape                    model = {0};
    shape_sphere(&model, "ball", dvec_of(0, 0, 0), 1, 24, 48, true);
    for (int m = 0; m < 2; m++) {
        shot   before = {0}, now;
        char   look[400];
        double most = 0, sum = 0;
        int    at = 0;
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"finish\":{\"paper\":\"drawing\",\"grain_size\":8,\"motion\":\"%s\"},"
                 "\"rules\":[{\"surface\":{\"technique\":\"flat\","
                 "\"colour\":\"#bbbbbb\"}}]}",
                 motions[m]);
        for (int i = 0; i <= 360; i++) {
            shot_view view = view_at((stand){i, 10, 5, 0, 0});
            view.width = view.height = 96;
            view.without_maps = true;
            if (!shot_of_shape(&now, &model, "around.glb", look, NULL, &view))
                break;
            if (i) {
                double step = halftone_difference(&before, &now);
                at = step > most ? i : at;
                most = fmax(most, step);
                sum += step / 360;
                shot_release(&before);
            }
            before = now;
        }
        shot_release(&before);
        check_at_most("P28", most, 2.5 * sum,
                      "%s: the largest change in a degree (at %d) against the mean one of all around", motions[m], at);
    }
    shape_release(&model);
}

/* Mean size of steps from pixel to pixel on the model: how fine the grain is. */
static double steps_of(const shot *s)
{
    double sum = 0;
    int    count = 0;
    for (int y = HIGH / 2 - 40; y < HIGH / 2 + 40; y++)
        for (int x = WIDE / 2 - 40; x < WIDE / 2 + 40; x++, count++)
            sum += abs(s->picture[4 * (y * WIDE + x)] - s->picture[4 * (y * WIDE + x + 1)]);
    return sum / count;
}

static void grain_stays_as_fine_when_nearer(void)
{
    shape model = {0};
    shape_quad(&model, "wall", 4, 0);
    double least = INFINITY, most = 0, change = 0, spread[2] = {INFINITY, 0};
    shot   before = {0}, now;
    for (int i = 0; i <= 40; i++) {
        shot_view view = {.width = WIDE,
                          .height = HIGH,
                          .eye = {0, 0, 12 * pow(2, -i / 16.0)},
                          .up = {0, 1, 0},
                          .fov_deg = 30,
                          .without_maps = true};
        if (!shot_of_shape(&now, &model, "near.glb",
                           "{\"version\":1,\"name\":\"t\",\"finish\":{\"paper\":\"drawing\",\"pressure\":1,\"grain_"
                           "size\":3,\"motion\":\"zooming\"},\"rules\":[{\"surface\":{\"technique\":\"flat\","
                           "\"colour\":\"#bbbbbb\"}}]}",
                           NULL, &view))
            break;
        double steps = steps_of(&now), mean = halftone_mean(&now, WIDE / 2 - 40, HIGH / 2 - 40, 80, 80);
        least = fmin(least, steps);
        most = fmax(most, steps);
        spread[0] = fmin(spread[0], mean);
        spread[1] = fmax(spread[1], mean);
        if (before.picture)
            change = fmax(change, fabs(steps_of(&before) - steps));
        if (before.picture)
            shot_release(&before);
        before = now;
    }
    if (before.picture)
        shot_release(&before);
    check_at_most("P28", most / least, 1.6, "zooming: the coarsest grain against the finest over 2.5 octaves");
    check_at_most("P28", change / least, 0.15, "the largest change of it in a sixteenth of an octave");
    check_at_most("P28", spread[1] - spread[0], 0.03, "how much the tone changes");
    shape_release(&model);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"hills", ink_stays_on_hills},
                                       {"bare", bare_paper_is_its_ground},
                                       {"grainless", no_grain_is_no_paper},
                                       {"tones", tones_stay},
                                       {"hue", ink_keeps_its_hue},
                                       {"strongest", hills_get_no_more_than_the_pencil_has},
                                       {"more", more_ink_gives_more},
                                       {"samples", samples_and_size_do_not_matter},
                                       {"transparent", transparent_pages_keep_their_ink},
                                       {"relief", relief_shows_on_bare_paper},
                                       {"motion", paper_goes_with_the_model},
                                       {"round", paper_depends_on_the_view_alone},
                                       {"jumps", paper_never_jumps},
                                       {"zoom", grain_stays_as_fine_when_nearer}};
    halftone_begin_kept("paper");
    int status = check_main(argc, argv, "paper", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
