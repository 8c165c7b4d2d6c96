/* Lines that are drawn several times, against equations 4 and 5 and the blend modes of seed 004, section 2.3,
 * worked out pixel by pixel on the CPU from the exact edge map. Notes: seed-pencil-city P7 to P11, P29, P33 to P35,
 * P38. */
#include <jansson.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "halftone/graphite.h"
#include "look/look.h"
#include "plan/paper_look.h"
#include "shape.h"
#include "shot.h"

enum { COPIES = 32 };

/* One copy, as equations 4 and 5 have it. */
typedef struct copy {
    double omega_x, phase_x, omega_y, phase_y, jitter_x, jitter_y, sway;
} copy;

typedef struct setting {
    int    dark, light, width, height, seed;
    double sketch, darkest, texture, pressure;
    copy   copies[COPIES];
} setting;

/* --- the reference -------------------------------------------------------------------------------------- */

static const char *pencil_look(const char *keys)
{
    static char text[1024];
    snprintf(text, sizeof text,
             "{\"version\":1,\"name\":\"p\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":"
             "\"*\",\"surface\":{\"technique\":\"flat\","
             "\"colour\":\"#ffffff\"},\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#000000\"},\"perturb\":{"
             "\"technique\":\"pencil\"%s%s}}]}",
             *keys ? "," : "", keys);
    return text;
}

/* The numbers that were drawn for the copies: random, but told. */
static bool draw_numbers(setting *out, const char *keys, int dark, int light)
{
    lmn_look *look = NULL;
    lmn_error error = {0};
    float     numbers[NUMBERS_MAX][4];
    if (!check_that("P11", lmn_look_parse(&look, pencil_look(keys), "look", &error) == LMN_OK,
                    "the look can be read: %s", error.message))
        return false;
    lmn_look *on_page = paper_look_create(look, 96.0 / 72); /* its lengths in pixels */
    if (!check_that("P11", on_page, "the look fits into memory"))
        return false;
    const technique_use *use = &on_page->rules[0].uses[KIND_PERTURB][0];
    size_t count = use->technique->numbers(use->values, (uint32_t)out->seed, out->width, out->height, numbers);
    check_near("P11", (double)count, 2 * (dark + light) + 1, 0, "vectors of numbers");
    out->dark = dark;
    out->light = light;
    for (int i = 0; i < dark + light; i++) {
        const float *wave = numbers[2 * i], *rest = numbers[2 * i + 1];
        out->copies[i] = (copy){(double)wave[0], (double)wave[1], (double)wave[2], (double)wave[3],
                                (double)rest[0], (double)rest[1], (double)rest[2]};
    }
    out->darkest = (double)numbers[count - 1][0];
    paper_look_destroy(&on_page);
    lmn_look_destroy(&look);
    return true;
}

/* Where a copy looks, in pixels from the bottom left, centres whole. */
static void transform(const setting *s, const copy *c, double x, double y, double *to_x, double *to_y)
{
    double fraction_x = (x + 0.5) / s->width, fraction_y = (y + 0.5) / s->height;
    *to_x = x + c->sway * sin(c->omega_x * fraction_y + c->phase_x) - c->jitter_x;
    *to_y = y + c->sway * cos(c->omega_y * fraction_x + c->phase_y) - c->jitter_y;
}

/* 1 - ink of a class: profile, inner, id. */
static double paper_of_pixel(const shot *exact, int x, int y, int channel)
{
    x = x < 0 ? 0 : x >= exact->width ? exact->width - 1 : x;
    y = y < 0 ? 0 : y >= exact->height ? exact->height - 1 : y;
    return exact->edge[4 * ((size_t)(exact->height - 1 - y) * (size_t)exact->width + (size_t)x) + (size_t)channel] /
           255.0;
}

static const int classes[3] = {0, 1, 3};

static double ink_of_pixel(const shot *exact, int x, int y)
{
    return 1 - paper_of_pixel(exact, x, y, 0) * paper_of_pixel(exact, x, y, 1) * paper_of_pixel(exact, x, y, 3);
}

/* The map is looked up between pixels, class by class. */
static double ink_between(const shot *exact, double x, double y)
{
    int    left = (int)floor(x), low = (int)floor(y);
    double right = x - left, up = y - low, paper = 1;
    for (int k = 0; k < 3; k++) {
        double below = paper_of_pixel(exact, left, low, classes[k]) * (1 - right) +
                       paper_of_pixel(exact, left + 1, low, classes[k]) * right;
        double above = paper_of_pixel(exact, left, low + 1, classes[k]) * (1 - right) +
                       paper_of_pixel(exact, left + 1, low + 1, classes[k]) * right;
        paper *= below * (1 - up) + above * up;
    }
    return 1 - paper;
}

/* Noise, one texel a pixel; the texel's middle is a pixel's corner, so four are mixed. */
static double grain_between(const mip_chain *grain, int channel, int x, int y)
{
    const uint8_t *bytes = mip_layer(grain, 0, 0);
    double         sum = 0;
    for (int k = 0; k < 4; k++)
        sum += 0.25 *
               bytes[2 * (((y - 1 + (k >> 1)) & (GRAPHITE_SIDE - 1)) * GRAPHITE_SIDE +
                          ((x - 1 + (k & 1)) & (GRAPHITE_SIDE - 1))) +
                     channel] /
               255.0;
    return sum;
}

/* Grey 0 … 1 that is shown. */
static double expected(const setting *s, const shot *exact, const mip_chain *grain, int x, int y)
{
    double dark = 0, light = 0;
    for (int i = 0; i < s->dark + s->light; i++) {
        double to_x, to_y;
        transform(s, &s->copies[i], x, y, &to_x, &to_y);
        double ink = ink_between(exact, to_x, to_y);
        dark += i < s->dark ? ink / s->dark : 0;
        light += i < s->dark ? 0 : ink / s->light;
    }
    double p = grain_between(grain, 0, x, y), intensity_light = 1 - light * s->sketch * (1 - p),
           intensity_dark = 1 - dark;
    /* Row P29: streaks take from both groups, the weight of the hand changes final lines alone. */
    double force = 1 - s->texture * (1 - grain_between(grain, 1, x, y));
    force *= intensity_dark <= intensity_light ? 1 - s->pressure * (1 - p) : 1;
    return 1 - (1 - fmin(intensity_light, intensity_dark)) * s->darkest * force;
}

static double shown(const shot *s, int x, int y)
{
    return s->picture[4 * ((size_t)(s->height - 1 - y) * (size_t)s->width + (size_t)x) + 1] / 255.0;
}

/* A plate, a ball in front of it and a ring: borders in all directions. */
static void scene_of_lines(shape *s)
{
    shape_box(s, "plate", dvec_of(-1.4, -1.1, -0.6), dvec_of(1.4, 1.1, -0.4));
    shape_sphere(s, "ball", dvec_of(-0.4, 0.2, 0.4), 0.6, 40, 80, true);
    shape_box(s, "bar", dvec_of(0.5, -1.5, 0.2), dvec_of(0.8, 1.3, 0.5));
}

static const shot_view view_of_lines = {
    .width = 360, .height = 300, .eye = {0.8, 0.9, 6}, .up = {0, 1, 0}, .fov_deg = 34};

static void equations(void)
{
    static const struct {
        const char *keys;
        int         dark, light, seed;
        double      sketch, texture, pressure;
    } rows[] = {{"", 4, 3, 0, 0.6, 0, 0},
                {"\"dark\":1,\"light\":0", 1, 0, 0, 0.6, 0, 0},
                {"\"dark\":0,\"light\":1", 0, 1, 3, 0.6, 0, 0},
                {"\"dark\":0,\"light\":5,\"light_sway\":9,\"sketch\":0.9", 0, 5, 0, 0.9, 0, 0},
                {"\"dark\":9,\"light\":7,\"dark_sway\":5,\"jitter\":3,\"sketch\":0.3", 9, 7, 11, 0.3, 0, 0},
                {"\"dark\":2,\"light\":2,\"dark_sway\":0,\"light_sway\":0,\"jitter\":0,\"sketch\":1", 2, 2, 0, 1, 0, 0},
                {"\"dark\":16,\"light\":16,\"lead\":\"HB\"", 16, 16, 0, 0.6, 0, 0},
                {"\"texture\":0.5", 4, 3, 0, 0.6, 0.5, 0},
                {"\"pressure\":0.7,\"sketch\":0.9", 4, 3, 0, 0.9, 0, 0.7}};
    shape     scene = {0};
    mip_chain grain;
    lmn_error error = {0};
    scene_of_lines(&scene);
    if (!check_that("P10", graphite_grain(&grain, 1, &error) == LMN_OK, "noise can be made"))
        return;
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++) {
        setting   s = {.width = view_of_lines.width,
                       .height = view_of_lines.height,
                       .seed = rows[r].seed,
                       .sketch = rows[r].sketch,
                       .texture = rows[r].texture,
                       .pressure = rows[r].pressure};
        shot      exact, drawn;
        shot_view bare = view_of_lines;
        bare.without_maps = true;
        bare.seed = (uint32_t)rows[r].seed;
        if (draw_numbers(&s, rows[r].keys, rows[r].dark, rows[r].light) &&
            shot_of_shape(&exact, &scene, "lines.glb", pencil_look(rows[r].keys), NULL, &view_of_lines)) {
            if (shot_of_shape(&drawn, &scene, "lines.glb", pencil_look(rows[r].keys), NULL, &bare)) {
                double worst = 0;
                int    off = 0, inked = 0;
                for (int y = 0; y < s.height; y++)
                    for (int x = 0; x < s.width; x++) {
                        double wanted = expected(&s, &exact, &grain, x, y),
                               far = fabs(shown(&drawn, x, y) - wanted) * 255;
                        worst = fmax(worst, far);
                        off += far > 1.5;
                        inked += wanted < 0.99;
                    }
                check_at_least("P8", inked, 1000, "%d dark and %d light copies: pixels with ink", s.dark, s.light);
                check_at_most("P10", off, inked / 500,
                              "pixels more than 1.5/255 from equations 4 and 5, Screen and Darken (worst %.1f)", worst);
                shot_release(&drawn);
            }
            shot_release(&exact);
        }
    }
    mip_chain_release(&grain);
    shape_release(&scene);
}

/* --- single rows ---------------------------------------------------------------------------------------- */

/* Waves never fold the picture: the map from positions to where they look keeps its sense. */
static void no_folds(void)
{
    static const int sizes[][2] = {{16, 16}, {64, 48}, {128, 500}, {1024, 1024}, {4096, 300}};
    for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
        setting s = {.width = sizes[k][0], .height = sizes[k][1]};
        double  least = 1, largest = 0;
        for (s.seed = 0; s.seed < 6; s.seed++) {
            if (!draw_numbers(&s, "\"dark\":16,\"light\":16,\"dark_sway\":16", 16, 16))
                return;
            for (int i = 0; i < 32; i++)
                for (int n = 0; n < 400; n++) {
                    double      fraction_y = (n % 20) / 20.0, fraction_x = (n / 20) / 20.0;
                    const copy *c = &s.copies[i];
                    double      a = c->sway * c->omega_x / s.height * cos(c->omega_x * fraction_y + c->phase_x),
                           b = -c->sway * c->omega_y / s.width * sin(c->omega_y * fraction_x + c->phase_y);
                    least = fmin(least, 1 - a * b);
                    largest = fmax(largest, c->sway);
                }
        }
        check_at_least("P7", least, 0.05, "%d x %d: determinant of the copies' maps, least (sway at most %.2f px)",
                       s.width, s.height, largest);
    }
}

static void numbers_in_their_ranges(void)
{
    setting s = {.width = 1000, .height = 1000};
    double  least[2] = {1e9, 1e9}, most[2] = {0, 0}, jitter = 0, apart = 1e9;
    for (s.seed = 0; s.seed < 40; s.seed++) {
        if (!draw_numbers(&s, "", 4, 3))
            return;
        for (int i = 0; i < 7; i++) {
            int light = i >= 4;
            least[light] = fmin(least[light], fmin(s.copies[i].omega_x, s.copies[i].omega_y));
            most[light] = fmax(most[light], fmax(s.copies[i].omega_x, s.copies[i].omega_y));
            jitter = fmax(jitter, fmax(fabs(s.copies[i].jitter_x), fabs(s.copies[i].jitter_y)));
            for (int k = 0; k < i; k++)
                apart = fmin(apart, fabs(s.copies[i].phase_x - s.copies[k].phase_x) +
                                        fabs(s.copies[i].omega_x - s.copies[k].omega_x));
        }
    }
    check_at_least("P11", least[0], 7.9, "radians of dark waves across the page, least");
    check_at_most("P11", most[0], 64.2, "most");
    check_at_least("P11", most[0] - least[0], 50, "and they fill that range");
    check_at_least("P11", least[1], 3.9, "of light ones, least");
    check_at_most("P11", most[1], 8.1, "most");
    check_at_most("P11", jitter, 1, "jitter in pixels, most");
    check_at_least("P11", jitter, 0.9, "and it is used");
    check_at_least("P11", apart, 1e-6, "no two copies have the same numbers");
}

/* The left border of a plate, one copy: its ink's middle in each row. */
static void displacement(void)
{
    shape scene = {0};
    shot  exact, drawn;
    shape_quad(&scene, "plate", 1.2, 0);
    for (int group = 0; group < 2; group++) {
        const char     *keys = group ? "\"dark\":0,\"light\":1,\"sketch\":1" : "\"dark\":1,\"light\":0,\"dark_sway\":6";
        const shot_view view = {.width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
        setting         s = {.width = 400, .height = 400};
        if (draw_numbers(&s, keys, !group, group) &&
            shot_of_shape(&exact, &scene, "plate.glb", pencil_look(keys), NULL, &view) &&
            shot_of_shape(&drawn, &scene, "plate.glb", pencil_look(keys), NULL, &view)) {
            double worst = 0, beyond = 0;
            int    rows = 0;
            int    side = (int)floor(shot_project(&exact, dvec_of(-1.2, 0, 0)).x),
                first = (int)floor(shot_project(&exact, dvec_of(0, -1.2, 0)).y);
            for (int y = s.height - 1 - first + 40; y < first - 40; y++) {
                double own = 0, own_at = 0, got = 0, got_at = 0;
                for (int x = side - 30; x < side + 30; x++) {
                    double a = ink_of_pixel(&exact, x, y), b = 1 - shown(&drawn, x, y);
                    own += a;
                    own_at += a * x;
                    got += b;
                    got_at += b * x;
                    beyond = b > 0.02 ? fmax(beyond, side - x) : beyond;
                }
                if (own <= 0 || got < 0.05)
                    continue; /* a light line may have faded */
                /* What is looked up at x' is drawn at x: x' is the border there. The wave depends on the row alone. */
                double fraction = (y + 0.5) / s.height,
                       offset = s.copies[0].sway * sin(s.copies[0].omega_x * fraction + s.copies[0].phase_x) -
                                s.copies[0].jitter_x;
                worst = fmax(worst, fabs(got_at / got - (own_at / own - offset)));
                rows++;
            }
            check_at_least("P7", rows, 140, "rows with a line, %s group", group ? "light" : "dark");
            check_at_most("P7", worst, 0.5, "px that it lies off the predicted place");
            if (group)
                check_at_most("P9", beyond, 18.5,
                              "px that light lines reach beyond the border, whose own line is half outside");
            if (group)
                check_at_least("P9", beyond, 12, "and they do reach far");
        }
        shot_release(&exact);
        shot_release(&drawn);
    }
    shape_release(&scene);
}

static double ink_sum(const shot *s)
{
    double sum = 0;
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++)
            sum += 1 - shown(s, x, y);
    return sum;
}

/* Separate lines in a row of pixels: runs of at least this much ink. */
static int runs_in_row(const shot *s, int y, int from, int to, double least)
{
    int runs = 0, inside = 0;
    for (int x = from; x < to; x++) {
        int now = 1 - shown(s, x, y) >= least;
        runs += now && !inside;
        inside = now;
    }
    return runs;
}

static void copies_share_the_ink(void)
{
    shape scene = {0};
    shape_quad(&scene, "plate", 1.2, 0);
    const shot_view view = {
        .width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .without_maps = true};
    double first = 0;
    int    most = 0, separate = 0;
    for (int n = 1; n <= 12; n++) {
        char keys[128];
        shot drawn;
        snprintf(keys, sizeof keys, "\"dark\":%d,\"light\":0,\"dark_sway\":9,\"jitter\":4", n);
        if (!shot_of_shape(&drawn, &scene, "plate.glb", pencil_look(keys), NULL, &view))
            continue;
        double sum = ink_sum(&drawn);
        first = n == 1 ? sum : first;
        check_near("P8", sum / first, 1, 0.02, "%d copies: ink over that of one", n);
        for (int y = 100; y < 300 && n == 4; y++) {
            /* Each copy alone has at least a quarter of the lead's darkness where it is a whole pixel wide. */
            int runs = runs_in_row(&drawn, y, 10, 150, 0.2);
            most = runs > most ? runs : most;
            separate += runs > 1;
        }
        shot_release(&drawn);
    }
    check_at_most("P8", most, 4, "separate lines of four copies in a row, most");
    check_at_least("P8", separate, 60, "of 200 rows with several");
    shape_release(&scene);
}

static void light_group(void)
{
    shape scene = {0};
    shot  drawn;
    scene_of_lines(&scene);
    shot_view view = view_of_lines;
    view.without_maps = true;
    if (shot_of_shape(&drawn, &scene, "lines.glb", pencil_look("\"dark\":0,\"light\":3"), NULL, &view)) {
        double most = 0;
        for (int y = 0; y < drawn.height; y++)
            for (int x = 0; x < drawn.width; x++)
                most = fmax(most, 1 - shown(&drawn, x, y));
        check_at_most("P9", most, 0.6, "darkest ink of light lines");
        check_at_least("P9", most, 0.2, "which are there");
    }
    shot_release(&drawn);
    shape_release(&scene);
}

static void frames_are_the_same(void)
{
    shape scene = {0};
    shot  a, b, c;
    scene_of_lines(&scene);
    shot_view view = view_of_lines;
    view.without_maps = true;
    shot_view later = view, other = view;
    later.time_s = 3.7;
    other.seed = 5;
    if (shot_of_shape(&a, &scene, "lines.glb", pencil_look(""), NULL, &view) &&
        shot_of_shape(&b, &scene, "lines.glb", pencil_look(""), NULL, &later) &&
        shot_of_shape(&c, &scene, "lines.glb", pencil_look(""), NULL, &other)) {
        check_at_most("P11", shot_differing(&a, &b, 0), 0, "values that differ in a later frame of the same view");
        check_at_least("P11", shot_differing(&a, &c, 10), 1000, "values that another seed changes");
    }
    shot_release(&a);
    shot_release(&b);
    shot_release(&c);
    shape_release(&scene);
}

/* What the report lists as passes, those that find the edges as one. */
static int passes_of(const shot *s)
{
    json_t *report = json_loads(s->report, 0, NULL), *passes = json_object_get(report, "passes");
    int     count = 1;
    for (size_t i = 0; i < json_array_size(passes); i++) {
        const char *name = json_string_value(json_object_get(json_array_get(passes, i), "name"));
        count += !name || strncmp(name, "lines: ", 7) != 0;
    }
    json_decref(report);
    return count;
}

/* How often a pass draws; 0: there is none. */
static int draws_of(const shot *s, const char *name)
{
    json_t *report = json_loads(s->report, 0, NULL), *passes = json_object_get(report, "passes"), *pass;
    size_t  i;
    int     draws = 0;
    json_array_foreach(passes, i, pass)
    {
        const char *own = json_string_value(json_object_get(pass, "name"));
        draws += own && strcmp(own, name) == 0 ? (int)json_integer_value(json_object_get(pass, "draws")) : 0;
    }
    json_decref(report);
    return draws;
}

/* Row P38: one pass of the scene and one of the full screen, whatever the number of copies. Edges are found once,
 * before, and the page is encoded once, after: a copy that found its own, as Müller's do, would read the maps around it
 * again. */
static void one_pass(void)
{
    static const char *const keys[] = {"\"dark\":1,\"light\":0", "\"dark\":4,\"light\":3", "\"dark\":16,\"light\":16"};
    shape                    scene = {0};
    int                      first = 0;
    scene_of_lines(&scene);
    shot_view view = view_of_lines;
    view.without_maps = view.profile = true;
    for (int k = 0; k < 3; k++) {
        shot drawn;
        if (shot_of_shape(&drawn, &scene, "lines.glb", pencil_look(keys[k]), NULL, &view)) {
            int count = passes_of(&drawn);
            first = k ? first : count;
            check_near("P38", count, first, 0, "passes with %s, as with one copy", keys[k]);
            check_near("P38", draws_of(&drawn, "geometry"), 1, 0, "  draws of the scene");
            check_near("P38", draws_of(&drawn, "compose: sprite"), 1, 0, "  draws of the full screen for all copies");
            check_at_most("P38", count, 4, "the scene, its edges, all copies, and the page's encoding");
        }
        shot_release(&drawn);
    }
    shape_release(&scene);
}

/* --- graphite ------------------------------------------------------------------------------------------- */

/* Broad exact lines: what is inside. */
static void inside_of_lines(const char *keys, double *mean, double *variance)
{
    shape scene = {0};
    shot  drawn;
    char  look[1024];
    shape_quad(&scene, "plate", 1.2, 0);
    snprintf(look, sizeof look,
             "{\"version\":1,\"name\":\"p\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":"
             "\"*\",\"surface\":{\"technique\":\"flat\",\"colour\":"
             "\"#ffffff\"},\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":12},\"perturb\":{"
             "\"technique\":\"pencil\",\"dark\":1,\"light\":0,\"dark_sway\":0,"
             "\"jitter\":0,%s}}]}",
             keys);
    const shot_view view = {.width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
    *mean = *variance = 0;
    if (shot_of_shape(&drawn, &scene, "broad.glb", look, NULL, &view)) {
        double sum = 0, squares = 0;
        int    count = 0;
        for (int y = 0; y < 400; y++)
            for (int x = 0; x < 400; x++)
                if (ink_of_pixel(&drawn, x, y) > 0.99 && ink_of_pixel(&drawn, x - 2, y) > 0.99 &&
                    ink_of_pixel(&drawn, x + 2, y) > 0.99) {
                    double ink = 1 - shown(&drawn, x, y);
                    sum += ink;
                    squares += ink * ink;
                    count++;
                }
        *mean = count ? sum / count : 0;
        *variance = count ? squares / count - *mean * *mean : 0;
        check_at_least("P29", count, 4000, "pixels inside lines");
    }
    shot_release(&drawn);
    shape_release(&scene);
}

static void graphite(void)
{
    double mean, variance, before = 0;
    inside_of_lines("\"texture\":0", &mean, &variance);
    check_at_most("P29", sqrt(fmax(variance, 0)), 0.004, "spread of ink inside lines without texture");
    inside_of_lines("\"texture\":0.6", &mean, &variance);
    check_at_least("P29", sqrt(variance), 0.05, "with texture (mean %.3f)", mean);
    inside_of_lines("\"pressure\":0.8", &mean, &variance);
    check_at_least("P29", sqrt(variance), 0.05, "under changing pressure (mean %.3f)", mean);
    for (int k = 0; k < LEAD_COUNT; k++) {
        char keys[64];
        snprintf(keys, sizeof keys, "\"lead\":\"%s\"", lead_grade_names[k]);
        inside_of_lines(keys, &mean, &variance);
        check_at_least("P33", mean - before, 0.005, "%s: darkness %.3f, above that of the harder one by",
                       lead_grade_names[k], mean);
        check_near("P33", mean, (double)lead_darkest((lead_grade)k), 0.006, "and it is the lead's");
        before = mean;
    }
}

/* Where a red and a blue copy lie over each other, only what both let through is left. */
static void coloured(void)
{
    shape scene = {0};
    shot  drawn;
    shape_quad(&scene, "plate", 1.2, 0);
    const shot_view view = {
        .width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .without_maps = true};
    const char *look = "{\"version\":1,\"name\":\"p\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{"
                       "\"select\":\"*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},"
                       "\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"width\":14},\"perturb\":{"
                       "\"technique\":\"pencil\",\"dark\":2,\"light\":0,\"dark_sway\":9,"
                       "\"colours\":[\"#ff4040\",\"#40ffff\"]}}]}";
    int         red = 0, blue = 0, both = 0;
    if (shot_of_shape(&drawn, &scene, "coloured.glb", look, NULL, &view))
        for (int i = 0; i < 400 * 400; i++) {
            const uint8_t *p = &drawn.picture[4 * i];
            red += p[0] > 240 && p[1] < 110 && p[2] < 110;
            blue += p[0] < 110 && p[1] > 240 && p[2] > 240;
            both += p[0] < 110 && p[1] < 110 && p[2] < 110;
        }
    check_at_least("P34", red, 300, "pixels of the first pencil alone");
    check_at_least("P34", blue, 300, "of the second");
    check_at_least("P34", both, 2000, "of both, which let nothing through in common");
    shot_release(&drawn);
    shape_release(&scene);
}

/* A grey plate's fill beyond its borders. */
static void overrun(void)
{
    static const double lengths[] = {0, 6, 12};
    shape               scene = {0};
    shape_quad(&scene, "plate", 1.2, 0);
    const shot_view view = {.width = 400, .height = 400, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
    for (int k = 0; k < 3; k++) {
        char look[1024];
        shot drawn;
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"p\",\"doc\":\"x.\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{"
                 "\"select\":\"*\",\"surface\":{\"technique\":\"flat\",\"colour\":"
                 "\"#808080\"},\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"none\"},\"perturb\":{"
                 "\"technique\":\"pencil\",\"overrun\":%g,\"overrun_angle\":0}}]}",
                 lengths[k]);
        if (shot_of_shape(&drawn, &scene, "plate.glb", look, NULL, &view)) {
            int side = (int)floor(shot_project(&drawn, dvec_of(1.2, 0, 0)).x), beyond = 0, short_of = 0, before = 0,
                even = 0;
            for (int y = 100; y < 300; y++) {
                int last = 0;
                for (int x = side - 40; x < side + 40 && x < 400; x++)
                    last = shown(&drawn, x, y) < 0.9 ? x : last;
                beyond = last - side > beyond ? last - side : beyond;
                short_of = side - last > short_of ? side - last : short_of;
                even += y > 100 && last == before;
                before = last;
            }
            /* Strokes of a band end together, and bands pass into one another. */
            check_at_least("P35", even, k ? 60 : 199, "rows of 200 that end where the one before does");
            check_at_most("P35", even, k ? 150 : 199, "and not all of a band");
            check_near("P35", beyond, lengths[k], 1.6, "overrun %g: px that strokes run past the contour at most",
                       lengths[k]);
            check_near("P35", short_of, lengths[k], 2.1, "and fall short of it");
        }
        shot_release(&drawn);
    }
    shape_release(&scene);
}

static const check_case cases[] = {
    {"equations", equations},
    {"no_folds", no_folds},
    {"numbers_in_their_ranges", numbers_in_their_ranges},
    {"displacement", displacement},
    {"copies_share_the_ink", copies_share_the_ink},
    {"light_group", light_group},
    {"frames_are_the_same", frames_are_the_same},
    {"one_pass", one_pass},
    {"graphite", graphite},
    {"coloured", coloured},
    {"overrun", overrun},
};

int main(int argc, char **argv)
{
    int status = check_main(argc, argv, "pencil_lines", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
