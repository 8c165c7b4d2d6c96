/* How layers meet the page, against colours blended on the CPU: sorted 'over' of all surfaces that rays find, lines
 * over each. */
#include <limner/draw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "paint.h"
#include "scenes.h"
#include "stack.h"

#define LOOK(RULES) "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ece4d2\"},\"rules\":[" RULES "]}"
#define OWN_COLOUR  "\"surface\":{\"technique\":\"flat\",\"model_colour\":1}"
#define ALL_LAYERS  "\"layers\":{\"technique\":\"peel\",\"count\":0}"
#define LINES                                                                                                          \
    "\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#000000\",\"cover\":1}" /* whole ink is counted            \
                                                                                     */

static const uint8_t ground[3] = {0xec, 0xe4, 0xd2};

static const shot_view views[] = {
    {.width = 160, .height = 128, .eye = {4, 3, 5}, .up = {0, 1, 0}},
    {.width = 128, .height = 144, .eye = {-2, 3, -4}, .up = {0, 1, 0}, .orthographic = true},
    {.width = 141, .height = 133, .eye = {1, -2.5, 3.5}, .target = {0.2, 0.1, 0}, .up = {0.2, 1, 0}, .fov_deg = 55},
};

static const uint8_t *pixel(const shot *s, int x, int y)
{
    return &s->picture[4 * (y * s->width + x)];
}

/* --- blending ------------------------------------------------------------------------------------------- */

static paint part_paint(const shape *s, uint16_t id, double opacity)
{
    const float *c = s->parts[id - 1].colour;
    return (paint){picture_srgb((double)c[0]) / 255, picture_srgb((double)c[1]) / 255, picture_srgb((double)c[2]) / 255,
                   (double)c[3] * opacity};
}

/* Surfaces of different parts that a rasteriser may order either way. */
static bool has_open_order(const stack_map *m, int i)
{
    const stack_hit *hits = stack_at(m, i);
    for (size_t k = 1; k < stack_count(m, i); k++)
        if (hits[k].tied && hits[k].id != hits[k - 1].id)
            return true;
    return false;
}

typedef struct tally {
    int pixels, right, sure, right_sure, worst, x, y;
} tally;

static void judge(tally *t, const shot *s, int i, bool sure, paint wanted)
{
    int off = levels_off(&s->picture[4 * i], wanted);
    t->pixels++;
    t->right += off <= 2;
    t->sure += sure;
    t->right_sure += sure && off <= 2;
    if (sure && off > t->worst) {
        t->worst = off;
        t->x = i % s->width;
        t->y = i / s->width;
    }
}

static void check_tally(const char *row, const tally *t, const shot *s, int least, const char *what)
{
    check_at_least(row, t->sure, least, "%s: pixels whose answer is sure, of %d", what, t->pixels);
    if (!check_at_least(row, (double)t->right_sure / (t->sure ? t->sure : 1), 0.999,
                        "%s: fraction of them within 2 levels of the blended colour (of all: %.5f)", what,
                        (double)t->right / (t->pixels ? t->pixels : 1)) &&
        s->picture)
        check_note("worst at %d, %d: %d levels, drawn %d %d %d", t->x, t->y, t->worst, pixel(s, t->x, t->y)[0],
                   pixel(s, t->x, t->y)[1], pixel(s, t->x, t->y)[2]);
}

/* --- sorted transparency -------------------------------------------------------------------------------- */

static void against_sorted(scene_kind kind, uint32_t seed, double opacity, const char *producer, const shot_view *view)
{
    char  look[512], what[96];
    shape s = {0};
    shot  drawing;
    tally t = {0};
    scene_make(&s, kind, seed);
    for (size_t i = 0; i < s.count; i += 2)
        s.parts[i].colour[3] = 0.5f; /* the material's own */
    snprintf(look, sizeof look,
             LOOK("{\"select\":\"*\"," OWN_COLOUR
                  ",\"layers\":{\"technique\":\"peel\",\"count\":0,\"producer\":\"%s\"},"
                  "\"compose\":{\"technique\":\"xray\",\"opacity\":%g}}"),
             producer, opacity);
    snprintf(what, sizeof what, "%s %u, opacity %g, %s%s", scene_names[kind], seed, opacity, producer,
             view->es ? ", ES" : "");
    if (shot_of_shape(&drawing, &s, "sorted.glb", look, NULL, view)) {
        tracer   *rays = tracer_create(&s);
        stack_map map;
        stack_map_make(&map, rays, &drawing);
        for (int i = 0; i < drawing.width * drawing.height; i++) {
            paint wanted = paint_of(ground, 1);
            for (size_t k = stack_count(&map, i); k-- > 0;)
                put_over(&wanted, part_paint(&s, stack_at(&map, i)[k].id, opacity));
            judge(&t, &drawing, i, map.sharp[i] && !has_open_order(&map, i), wanted);
        }
        stack_map_release(&map);
        tracer_destroy(rays);
    }
    check_tally("B07", &t, &drawing, 9000, what);
    shot_release(&drawing);
    shape_release(&s);
}

static void sorted(void)
{
    against_sorted(SCENE_CLOSED, 1, 0.3, "peeling", &views[0]);
    against_sorted(SCENE_CLOSED, 2, 0.6, "lists", &views[1]);
    against_sorted(SCENE_OPEN, 3, 0.3, "lists", &views[2]);
    against_sorted(SCENE_OPEN, 4, 0.9, "peeling", &views[0]);
    against_sorted(SCENE_CROSSING, 5, 0.3, "peeling", &views[1]);
    against_sorted(SCENE_CROSSING, 6, 0.12, "lists", &views[2]);
    against_sorted(SCENE_COINCIDENT, 7, 0.3, "lists", &views[0]);
    shot_view es = views[0];
    es.es = true;
    against_sorted(SCENE_CLOSED, 8, 0.3, "auto", &es);
}

/* The order of the parts in the file says nothing about the picture. */
static void any_order(void)
{
    static const size_t orders[][7] = {{6, 5, 4, 3, 2, 1, 0}, {2, 0, 5, 1, 6, 4, 3}};
    static const char   look[] =
        LOOK("{\"select\":\"*\"," OWN_COLOUR "," ALL_LAYERS ",\"compose\":{\"technique\":\"xray\",\"opacity\":0.4}}");
    shape s = {0};
    shot  first, other;
    scene_make(&s, SCENE_CROSSING, 9);
    if (shot_of_shape(&first, &s, "order.glb", look, NULL, &views[0])) {
        tracer   *rays = tracer_create(&s);
        stack_map map;
        stack_map_make(&map, rays, &first);
        for (size_t o = 0; o < 2; o++) {
            shape moved = {0};
            int   sure = 0, everywhere = 0;
            scene_reorder(&moved, &s, orders[o]);
            if (shot_of_shape(&other, &moved, "order.glb", look, NULL, &views[0]))
                for (int i = 0; i < first.width * first.height; i++) {
                    bool differs = memcmp(&first.picture[4 * i], &other.picture[4 * i], 4) != 0;
                    everywhere += differs;
                    sure += differs && !has_open_order(&map, i) && map.sharp[i];
                }
            check_that("B07", other.picture != NULL && s.count == 7, "seven parts in another order are drawn");
            check_at_most("B07", sure, 0, "pixels that the order of the parts changes (of all pixels: %d)", everywhere);
            shot_release(&other);
            shape_release(&moved);
        }
        stack_map_release(&map);
        tracer_destroy(rays);
    }
    shot_release(&first);
    shape_release(&s);
}

/* Two rules, each transparent in its own way: their surfaces interleave along each ray. */
static void two_figures(void)
{
    static const char look[] = LOOK(
        "{\"select\":\"*\"," OWN_COLOUR "," ALL_LAYERS ",\"compose\":{\"technique\":\"xray\",\"opacity\":0.5}},"
        "{\"select\":\"cross0,cross3,cross6\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"}," ALL_LAYERS
        ",\"compose\":{\"technique\":\"xray\",\"opacity\":0.2}}");
    static const uint8_t red[3] = {255, 0, 0};
    shape                s = {0};
    shot                 drawing;
    tally                t = {0};
    scene_make(&s, SCENE_CROSSING, 12);
    if (shot_of_shape(&drawing, &s, "figures.glb", look, NULL, &views[2])) {
        tracer   *rays = tracer_create(&s);
        stack_map map;
        stack_map_make(&map, rays, &drawing);
        for (int i = 0; i < drawing.width * drawing.height; i++) {
            paint wanted = paint_of(ground, 1);
            for (size_t k = stack_count(&map, i); k-- > 0;) {
                uint16_t id = stack_at(&map, i)[k].id;
                put_over(&wanted, id % 3 == 1 ? paint_of(red, 0.2) : part_paint(&s, id, 0.5));
            }
            judge(&t, &drawing, i, map.sharp[i] && !has_open_order(&map, i), wanted);
        }
        stack_map_release(&map);
        tracer_destroy(rays);
    }
    check_tally("B07", &t, &drawing, 9000, "two transparent figures");
    shot_release(&drawing);
    shape_release(&s);
}

/* --- lines over layers ---------------------------------------------------------------------------------- */

/* Is there ink of any layer within the square around the pixel? */
static bool ink_around(const shot *s, int i, int radius)
{
    for (int y = i / s->width - radius; y <= i / s->width + radius; y++)
        for (int x = i % s->width - radius; x <= i % s->width + radius; x++)
            if (x >= 0 && y >= 0 && x < s->width && y < s->height && largest_ink(s, y * s->width + x) > 0)
                return true;
    return false;
}

/* Per layer the fill, then its ink, nearest last: from the layers' own maps, whose ink is all or nothing here, so
 * that their 8 bits are exact. `strength` of layer k's lines is hidden·fade^(k − 1). */
static void lines_over_layers(void)
{
    static const struct {
        const char *style;
        double      hidden, fade;
    } styles[] = {{"", 1, 1}, {",\"hidden_opacity\":0.5", 0.5, 1}, {",\"hidden_opacity\":0.8,\"fade\":0.6", 0.8, 0.6}};
    for (size_t v = 0; v < 3; v++) {
        char  look[512];
        shape s = {0};
        shot  drawing;
        tally t = {0}, inked = {0};
        scene_make(&s, v % 2 ? SCENE_CROSSING : SCENE_CLOSED, 13 + (uint32_t)v);
        snprintf(look, sizeof look,
                 LOOK("{\"select\":\"*\"," OWN_COLOUR "," ALL_LAYERS
                      ",\"lines\":{\"operator\":\"discontinuity\",\"gain\":1000,\"colour\":\"#102080c0\"},"
                      "\"compose\":{\"technique\":\"xray\",\"opacity\":0.3,\"once\":false%s}}"),
                 styles[v].style);
        if (shot_of_shape(&drawing, &s, "inked.glb", look, NULL, &views[v]))
            for (int i = 0; i < drawing.width * drawing.height; i++) {
                static const uint8_t blue[3] = {0x10, 0x20, 0x80};
                paint                wanted = paint_of(ground, 1);
                double               ink = 0;
                for (int k = drawing.layer_count; k-- > 0;) {
                    const uint8_t *e = &drawing.layers[k].edge[4 * i];
                    double         strength = k ? styles[v].hidden * pow(styles[v].fade, k - 1) : 1, a = 0xc0 / 255.0;
                    double         clear =
                        (1 - a * (1 - e[0] / 255.0)) * (1 - a * (1 - e[1] / 255.0)) * (1 - a * (1 - e[3] / 255.0));
                    if (drawing.layers[k].id[i])
                        put_over(&wanted, part_paint(&s, drawing.layers[k].id[i], 0.3));
                    put_over(&wanted, paint_of(blue, (1 - clear) * strength));
                    ink = fmax(ink, 1 - clear);
                }
                judge(ink > 0 ? &inked : &t, &drawing, i, true, wanted);
            }
        check_tally("B07", &t, &drawing, 5000, "layers between lines");
        check_tally("B07", &inked, &drawing, 1500, *styles[v].style ? styles[v].style + 1 : "lines over their layers");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* --- blueprint ------------------------------------------------------------------------------------------ */

static void tint_adds_up(void)
{
    static const uint8_t     tint[3] = {0x20, 0x50, 0xc0};
    static const char *const producers[] = {"peeling", "lists"};
    for (int p = 0; p < 2; p++) {
        char   look[512];
        shape  s = {0};
        shot   drawing;
        tally  t = {0};
        double sum[STACK_MAX] = {0}, count[STACK_MAX] = {0};
        int    steps = 0, wrong = 0;
        scene_make(&s, p ? SCENE_CROSSING : SCENE_CLOSED, 16);
        snprintf(look, sizeof look,
                 LOOK("{\"select\":\"*\",\"surface\":\"flat\",\"layers\":{\"technique\":\"peel\",\"count\":0,"
                      "\"producer\":\"%s\"},"
                      "\"compose\":{\"technique\":\"blueprint\",\"tint\":\"#2050c0\",\"tint_opacity\":0.2}}"),
                 producers[p]);
        if (shot_of_shape(&drawing, &s, "tint.glb", look, NULL, &views[p])) {
            tracer   *rays = tracer_create(&s);
            stack_map map;
            stack_map_make(&map, rays, &drawing);
            for (int i = 0; i < drawing.width * drawing.height; i++) {
                paint  wanted = paint_of(ground, 1);
                size_t n = stack_count(&map, i);
                for (size_t k = 0; k < n; k++)
                    put_over(&wanted, paint_of(tint, 0.2));
                judge(&t, &drawing, i, map.sharp[i], wanted);
                sum[n] += map.sharp[i] ? drawing.picture[4 * i] : 0;
                count[n] += map.sharp[i];
            }
            for (size_t n = 0, last = 0; n <= map.most_sharp; n++) {
                if (count[n] < 5)
                    continue;
                if (n > 0 && n <= 10) {
                    steps++;
                    wrong += sum[n] / count[n] >= sum[last] / count[last] - 0.5;
                }
                last = n;
            }
            stack_map_release(&map);
            tracer_destroy(rays);
        }
        check_tally("B04", &t, &drawing, 9000, "tint of one layer after the other");
        check_at_least("B04", steps, 4, "different depths up to ten layers");
        check_at_most("B04", wrong, 0, "of them, those that are not darker than the one before");
        shot_release(&drawing);
        shape_release(&s);
    }
}

static bool dark_near(const shot *s, dvec position, int radius, int below)
{
    for (int y = (int)floor(position.y) - radius; y <= (int)floor(position.y) + radius; y++)
        for (int x = (int)floor(position.x) - radius; x <= (int)floor(position.x) + radius; x++)
            if (x >= 0 && y >= 0 && x < s->width && y < s->height && pixel(s, x, y)[0] < below &&
                pixel(s, x, y)[1] < below)
                return true;
    return false;
}

/* The twelve edges of a box's part. */
static void box_edges(const shape_part *p, dvec edges[12][2])
{
    int at = 0;
    for (uint32_t i = 0; i < 8; i++)
        for (uint32_t axis = 1; axis < 8; axis *= 2)
            if (!(i & axis)) {
                edges[at][0] = shape_point(p, i);
                edges[at++][1] = shape_point(p, i | axis);
            }
}

/* How far a position of the picture is from the nearest of a box's edges. */
static double distance_to_edges(const shot *s, const shape_part *box, double x, double y)
{
    dvec   edges[12][2];
    double least = INFINITY;
    box_edges(box, edges);
    for (int e = 0; e < 12; e++) {
        dvec   a = shot_project(s, edges[e][0]), b = shot_project(s, edges[e][1]);
        double ex = b.x - a.x, ey = b.y - a.y, length = ex * ex + ey * ey;
        double k = length > 0 ? fmin(1, fmax(0, ((x - a.x) * ex + (y - a.y) * ey) / length)) : 0;
        least = fmin(least, hypot(x - a.x - k * ex, y - a.y - k * ey));
    }
    return least;
}

/* The fraction of a box's edges with a dark pixel beside them, where the edges of `apart` (NULL: none) are not near. */
static double edges_seen(const shot *s, const shape_part *box, const shape_part *apart)
{
    dvec edges[12][2];
    int  found = 0, samples = 0;
    box_edges(box, edges);
    for (int e = 0; e < 12; e++)
        for (int k = 0; k <= 50; k++) {
            dvec p = shot_project(s, dvec_mix(edges[e][0], edges[e][1], k / 50.0));
            if (apart && distance_to_edges(s, apart, p.x, p.y) < 4)
                continue;
            samples++;
            found += dark_near(s, p, 1, 110);
        }
    return samples ? (double)found / samples : 0;
}

static void hidden_edges(void)
{
    static const char deep[] = LOOK("{\"select\":\"*\",\"surface\":\"flat\"," ALL_LAYERS "," LINES
                                    ",\"compose\":{\"technique\":\"blueprint\",\"tint_opacity\":0.1}}");
    static const char flat[] = LOOK("{\"select\":\"*\",\"surface\":\"flat\"," LINES "}");
    for (int v = 0; v < 3; v++) {
        shape s = {0};
        shot  blueprint, front;
        shape_box(&s, "outer", dvec_of(-1, -0.9, -1), dvec_of(1, 1, 1));
        shape_box(&s, "inner", dvec_of(-0.45, -0.3, -0.5), dvec_of(0.5, 0.4, 0.35));
        shape_place(&s, dvec_of(1, 2, 1), 25, dvec_of(0, 0, 0));
        shot_view view = views[v];
        view.eye = dvec_scale(view.eye, v == 1 ? 1.5 : 1); /* parallel rays show more from farther away */
        bool drawn = shot_of_shape(&blueprint, &s, "boxes.glb", deep, NULL, &view);
        if (shot_of_shape(&front, &s, "boxes.glb", flat, NULL, &view) && drawn) {
            check_at_least("B04", edges_seen(&blueprint, &s.parts[0], NULL), 0.99,
                           "fraction of the outer box's edges with a line in the blueprint");
            check_at_least("B04", edges_seen(&blueprint, &s.parts[1], NULL), 0.99, "fraction of the hidden box's");
            check_at_most("B04", edges_seen(&front, &s.parts[1], &s.parts[0]), 0,
                          "and in a drawing of the front alone");
        }
        shot_release(&blueprint);
        shot_release(&front);
        shape_release(&s);
    }
}

/* Parts with the prefix are opaque and have this colour; all others are layers with one fill each. Judges the
 * pixels where no line is near: layers before the opaque part tint it, those behind it do not show. */
/* Is where the part ends no farther than its outline is wide, with soft rims? */
static bool is_outline_of(const trace_map *m, const shot *s, int i)
{
    for (int y = i / s->width - 2; y <= i / s->width + 2; y++)
        for (int x = i % s->width - 2; x <= i % s->width + 2; x++)
            if (x >= 0 && y >= 0 && x < s->width && y < s->height && !m->id[y * s->width + x] != !m->id[i])
                return true;
    return false;
}

static void against_opaque(const char *row, const char *what, const shape *s, const shot *drawing, const char *prefix,
                           paint opaque, int layers, paint (*fill)(const shape *, uint16_t))
{
    tracer   *rest = tracer_of_parts(s, prefix, false), *named = tracer_of_parts(s, prefix, true);
    stack_map map;
    trace_map front;
    tally     t = {0}, beside = {0};
    int       tinted = 0, hiding = 0;
    stack_map_make(&map, rest, drawing);
    trace_map_make(&front, named, drawing);
    for (int i = 0; i < drawing->width * drawing->height; i++) {
        const stack_hit *hits = stack_at(&map, i);
        paint            wanted = paint_of(ground, 1);
        bool             sure = map.sharp[i] && !has_open_order(&map, i) && !ink_around(drawing, i, 2) &&
                    !trace_map_border(&front, i % drawing->width, i / drawing->width, 1) &&
                    !is_outline_of(&front, drawing, i);
        size_t count = stack_count(&map, i), before = 0;
        count = layers && count > (size_t)layers ? (size_t)layers : count;
        while (before < count && hits[before].depth < front.depth[i]) {
            sure = sure && fabs(hits[before].depth - front.depth[i]) > 1e-3;
            before++;
        }
        sure = sure && (before == count || hits[before].depth - front.depth[i] > 1e-3);
        if (front.id[i])
            put_over(&wanted, opaque);
        tinted += front.id[i] && before > 0;
        hiding += front.id[i] && before < count;
        for (size_t k = before; k-- > 0;)
            put_over(&wanted, fill(s, hits[k].id));
        judge(front.id[i] ? &t : &beside, drawing, i, sure, wanted);
    }
    check_tally(row, &t, drawing, 250, what);
    check_tally(row, &beside, drawing, 3000, "  beside it");
    check_at_least(row, tinted, 30, "  its pixels with layers before them");
    check_at_least(row, hiding, 300, "  and with layers behind them");
    stack_map_release(&map);
    trace_map_release(&front);
    tracer_destroy(rest);
    tracer_destroy(named);
}

static paint blue_fill(const shape *s, uint16_t id)
{
    static const uint8_t tint[3] = {0x20, 0x50, 0xc0};
    (void)s;
    (void)id;
    return paint_of(tint, 0.2);
}

static paint own_fill(const shape *s, uint16_t id)
{
    return part_paint(s, id, 0.3);
}

#define BLUE_RULE(REST)                                                                                                \
    "{\"select\":\"*\",\"surface\":\"flat\"," ALL_LAYERS REST                                                          \
    ",\"compose\":{\"technique\":\"blueprint\",\"tint\":\"#2050c0\",\"tint_opacity\":0.2}}"

/* An opaque part amid the layers hides what is behind it and is tinted by what is before it. */
static void opaque_amid_layers(void)
{
    static const uint8_t red[3] = {255, 0x20, 0x10};
    for (int v = 0; v < 3; v++)
        for (int m = 0; m < 2; m++) {
            shape s = {0};
            shot  drawing;
            scene_make(&s, SCENE_CLOSED, 17 + (uint32_t)v);
            shape_sphere(&s, "core", dvec_of(0.1, 0, 0.05), 0.5, 24, 48, true);
            const char *changes[] = {"0:layers.producer", m ? "lists" : "peeling", NULL};
            if (shot_of_shape(&drawing, &s, "core.glb",
                              LOOK(BLUE_RULE() ",{\"select\":\"core\",\"surface\":{\"technique\":\"flat\",\"colour\":"
                                               "\"#ff2010\"}}"),
                              changes, &views[v]))
                against_opaque("B04", m ? "an opaque part amid layers, lists" : "an opaque part amid layers, peeling",
                               &s, &drawing, "core", paint_of(red, 1), 0, blue_fill);
            shot_release(&drawing);
            shape_release(&s);
        }
}

/* A box and two arrows inside a blueprint. */
static void glyphs(void)
{
    static const uint8_t red[3] = {255, 0x20, 0x10};
    for (int v = 0; v < 2; v++) {
        shape     s = {0};
        shot      drawing;
        shot_view view = views[v];
        view.width = view.height = 300;
        shape_box(&s, "hall", dvec_of(-1.2, -0.8, -1), dvec_of(1.2, 0.8, 1));
        shape_box(&s, "room", dvec_of(-0.9, -0.7, -0.8), dvec_of(-0.1, 0.3, 0.7));
        shape_torus(&s, "ring", 0.5, 0.15, 48, 24);
        shape_place(&s, dvec_of(1, 0.3, 0), 60, dvec_of(0.5, 0, 0));
        shape_box(&s, "glyph box", dvec_of(-0.7, -0.5, -0.3), dvec_of(-0.3, 0, 0.2));
        shape_box(&s, "glyph shaft", dvec_of(-0.9, 0.38, 0.35), dvec_of(0.4, 0.5, 0.5));
        shape_sphere(&s, "glyph head", dvec_of(0.5, 0.44, 0.42), 0.25, 2, 12, false);
        shape_box(&s, "glyph rod", dvec_of(-0.05, -0.9, -0.05), dvec_of(0.05, 0.4, 0.05));
        shape_place(&s, dvec_of(0, 0, 1), -40, dvec_of(0.4, 0, 0));
        if (shot_of_shape(
                &drawing, &s, "glyphs.glb",
                LOOK(BLUE_RULE(
                    "," LINES) ",{\"select\":\"glyph*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff2010\"}}"),
                NULL, &view))
            against_opaque("B12", "a box and arrows inside a blueprint", &s, &drawing, "glyph", paint_of(red, 1), 0,
                           blue_fill);
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* The designated part lies at its depth: tinted by the layers that are left before it, and hiding those behind. */
static void focus(void)
{
    static const uint8_t green[3] = {0x20, 0xc0, 0x40};
#define FOCUS_RULE(LINES)                                                                                              \
    "{\"select\":\"*\"," OWN_COLOUR LINES ",\"layers\":{\"technique\":\"peel\",\"count\":0,\"focus\":\"closed1\","     \
    "\"focus_colour\":\"#20c040\",\"focus_fraction\":0.8},\"compose\":{\"technique\":\"xray\",\"opacity\":0.3}}"
    /* With lines, what is seen through must not hide the part in its own figure's edge detection. */
    static const char *const looks[] = {LOOK(FOCUS_RULE("")), LOOK(FOCUS_RULE("," LINES)), LOOK(FOCUS_RULE(""))};
    for (int v = 0; v < 3; v++) {
        shape s = {0};
        shot  drawing;
        scene_make(&s, SCENE_CLOSED, 21 + (uint32_t)v);
        if (shot_of_shape(&drawing, &s, "focus.glb", looks[v], NULL, &views[v]))
            against_opaque("B10", "a designated part amid layers", &s, &drawing, "closed1", paint_of(green, 1),
                           drawing.layers_drawn, own_fill);
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* --- wire ----------------------------------------------------------------------------------------------- */

/* Ink above the threshold is a line, and everything else the ground, untouched. `covered_only`: judges ink on the
 * layer itself; operators that look farther than a line is wide find more beside it than any composition keeps. */
static void check_wire(scene_kind kind, const char *lines, const char *value, bool covered_only, const shot_view *view)
{
    char   look[512];
    shape  s = {0};
    shot   drawing;
    double threshold = atof(value);
    int    ink = 0, bare = 0, wrong_ink = 0, wrong_ground = 0, x = 0, y = 0;
    scene_make(&s, kind, 31);
    snprintf(look, sizeof look,
             LOOK("{\"select\":\"*\"," OWN_COLOUR "," ALL_LAYERS ",\"lines\":{\"operator\":%s,\"colour\":\"#102080\"},"
                  "\"compose\":{\"technique\":\"wire\",\"once\":false,\"softness\":0,\"threshold\":%s}}"),
             lines, value);
    if (shot_of_shape(&drawing, &s, "wire.glb", look, NULL, view))
        for (int i = 0; i < drawing.width * drawing.height; i++) {
            const uint8_t *p = &drawing.picture[4 * i];
            double         on_layer = 0, most = largest_ink(&drawing, i);
            for (int k = 0; k < drawing.layer_count; k++)
                if (drawing.layers[k].id[i] || !covered_only)
                    on_layer = fmax(on_layer, ink_of(&drawing.layers[k].edge[4 * i]));
            if (most < threshold - 0.01) {
                bare++;
                wrong_ground += memcmp(p, ground, 3) != 0;
            } else if (on_layer > threshold + 0.01) {
                bool wrong = abs(p[0] - 0x10) > 1 || abs(p[1] - 0x20) > 1 || abs(p[2] - 0x80) > 1;
                ink++;
                wrong_ink += wrong;
                x = wrong ? i % drawing.width : x;
                y = wrong ? i / drawing.width : y;
            }
        }
    check_at_least("B06", ink, 1000, "%s, threshold %s: pixels with a layer's ink above it", lines, value);
    check_at_least("B06", bare, 4000, "  and without");
    if (!check_at_most("B06", wrong_ink, 0, "  pixels of ink that are not in the line's colour"))
        check_note("the last at %d, %d", x, y);
    check_at_most("B06", wrong_ground, 0, "  pixels beside them that are not the ground");
    shot_release(&drawing);
    shape_release(&s);
}

static void wire(void)
{
    check_wire(SCENE_CLOSED, "\"discontinuity\"", "0.5", false, &views[0]);
    check_wire(SCENE_OPEN, "\"four-tap\",\"gain\":10", "0.2", false, &views[1]);
    check_wire(SCENE_CROSSING, "\"four-tap\",\"gain\":10", "0.9", false, &views[2]);
    check_wire(SCENE_CLOSED, "\"sobel\",\"gain\":4", "0.5", true, &views[0]);
    check_wire(SCENE_COINCIDENT, "\"id\"", "0.5", false, &views[1]);
}

/* --- hidden lines --------------------------------------------------------------------------------------- */

static const shot_view straight = {
    .width = 192, .height = 192, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};

#define WIRE_LOOK(STYLE)                                                                                               \
    LOOK("{\"select\":\"*\",\"surface\":\"flat\"," ALL_LAYERS "," LINES ",\"compose\":{\"technique\":\"wire\"" STYLE   \
         "}}")

static void box_in_box(shape *s)
{
    shape_box(s, "outer", dvec_of(-1.6, -1.6, -1), dvec_of(1.6, 1.6, 1));
    shape_box(s, "inner", dvec_of(-1, -0.9, -0.5), dvec_of(1.1, 0.8, 0.5));
}

/* Along the inner box's upper and lower edge: is there ink across it, in a pixel column? */
static bool column_has_ink(const shot *s, double y, int x, int radius, const uint8_t colour[3])
{
    for (int j = (int)floor(y) - radius; j <= (int)floor(y) + radius; j++)
        if (abs(pixel(s, x, j)[0] - colour[0]) + abs(pixel(s, x, j)[1] - colour[1]) +
                abs(pixel(s, x, j)[2] - colour[2]) <
            30)
            return true;
    return false;
}

static void hidden_colour_and_dashes(void)
{
    static const uint8_t black[3] = {0, 0, 0}, red[3] = {255, 0, 0};
    shape                s = {0};
    shot                 drawing;
    int                  runs = 0, wrong_on = 0, wrong_off = 0, open = 0, samples = 0;
    box_in_box(&s);
    if (shot_of_shape(&drawing, &s, "dashes.glb",
                      WIRE_LOOK(",\"hidden_colour\":\"#ff0000\",\"hidden_dash\":9,\"hidden_gap\":6"), NULL,
                      &straight)) {
        for (int side = 0; side < 2; side++) {
            dvec a = shot_project(&drawing, dvec_of(-1, side ? 0.8 : -0.9, 0.5)),
                 b = shot_project(&drawing, dvec_of(1.1, side ? 0.8 : -0.9, 0.5));
            dvec c = shot_project(&drawing, dvec_of(-1.6, side ? 1.6 : -1.6, 1)),
                 d = shot_project(&drawing, dvec_of(1.6, side ? 1.6 : -1.6, 1));
            int  length = 0, whole = 0;
            bool last = false;
            for (int x = (int)a.x + 3; x < (int)b.x - 3; x++) {
                bool on = column_has_ink(&drawing, a.y, x, 1, red);
                if (length && on != last) {
                    if (whole++) { /* the first may have begun before */
                        runs++;
                        wrong_on += last && abs(length - 9) > 2;
                        wrong_off += !last && abs(length - 6) > 2;
                    }
                    length = 0;
                }
                last = on;
                length++;
            }
            for (int x = (int)c.x + 2; x < (int)d.x - 2; x++) {
                samples++;
                open += !column_has_ink(&drawing, c.y, x, 1, black);
            }
        }
        check_at_least("hidden", runs, 20, "dashes and gaps along two hidden edges, in the hidden colour");
        check_at_most("hidden", wrong_on, 0, "dashes that are not 9 +- 2 px long");
        check_at_most("hidden", wrong_off, 0, "gaps that are not 6 +- 2 px long");
        check_at_most("hidden", open, 0, "of %d places along visible edges, those without an unbroken line", samples);
    }
    shot_release(&drawing);
    shape_release(&s);
}

static double ink_across(const shot *s, dvec position)
{
    double sum = 0;
    for (int x = -8; x < 8; x++)
        for (int y = (int)position.y - 5; y < (int)position.y + 5; y++)
            sum += (1 - picture_shown(pixel(s, (int)position.x + x, y)[0]) / picture_shown(ground[0])) / 16;
    return sum;
}

static void hidden_width(void)
{
    static const char *const widths[] = {"1px", "2px", "4px", "7px"};
    for (int w = 0; w < 4; w++) {
        const char *changes[] = {"compose.hidden_width", widths[w], NULL};
        shape       s = {0};
        shot        drawing;
        box_in_box(&s);
        if (shot_of_shape(&drawing, &s, "width.glb", WIRE_LOOK(""), changes, &straight)) {
            check_near("hidden", ink_across(&drawing, shot_project(&drawing, dvec_of(0, 0.8, 0.5))), atof(widths[w]),
                       atof(widths[w]) <= 2 ? 0.55 : 1, "width of a hidden line of width %s", widths[w]);
            check_near("hidden", ink_across(&drawing, shot_project(&drawing, dvec_of(0, 1.6, 1))), 2, 0.5,
                       "  and of a visible one");
        }
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* An edge that two layers in turn have is inked once; a half-transparent ink would show it twice. */
static void repeated_once(void)
{
    static const uint8_t black[3] = {0, 0, 0};
    for (int once = 0; once < 2; once++) {
        const char *changes[] = {"compose.once", once ? "true" : "false", NULL};
        shape       s = {0};
        shot        drawing;
        int         both = 0, wrong = 0;
        shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        if (shot_of_shape(&drawing, &s, "once.glb",
                          LOOK("{\"select\":\"*\",\"surface\":\"flat\"," ALL_LAYERS
                               ",\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#00000080\"},"
                               "\"compose\":{\"technique\":\"blueprint\",\"tint_opacity\":0}}"),
                          changes, &views[0]))
            for (int i = 0; i < drawing.width * drawing.height && drawing.layer_count == 2; i++) {
                const uint8_t *e = &drawing.layers[0].edge[4 * i], *f = &drawing.layers[1].edge[4 * i];
                if (e[0] || f[0] || e[1] < 255 || f[1] < 255 || e[3] < 255 || f[3] < 255)
                    continue;
                paint wanted = paint_of(ground, 1);
                for (int k = once; k < 2; k++)
                    put_over(&wanted, paint_of(black, 128 / 255.0));
                both++;
                wrong += levels_off(&drawing.picture[4 * i], wanted) > 2;
            }
        check_at_least("B13", both, 200, "pixels whose ink two layers have");
        check_at_most("B13", wrong, 0, "of them, those not inked %s", once ? "once" : "twice");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* Behind a plate's outline, the lines of a bar that runs on behind it keep a distance. */
static void halo(void)
{
    for (int width = 0; width <= 8; width += 4) {
        char        value[16];
        const char *changes[] = {"compose.halo", value, NULL};
        shape       s = {0};
        shot        drawing;
        int         near = 0, near_ink = 0, far = 0, far_ink = 0;
        snprintf(value, sizeof value, "%dpx", width);
        shape_quad(&s, "plate", 1, 0.5);
        shape_box(&s, "bar", dvec_of(-1.8, -0.2, -0.5), dvec_of(1.8, 0.25, -0.3));
        if (shot_of_shape(&drawing, &s, "halo.glb", WIRE_LOOK(""), changes, &straight)) {
            dvec left = shot_project(&drawing, dvec_of(-1, 0.25, 0)),
                 right = shot_project(&drawing, dvec_of(1, 0.25, 0));
            for (int x = (int)left.x; x <= (int)right.x; x++) {
                double inside = fmin(x + 0.5 - left.x, right.x - x - 0.5);
                bool   on = column_has_ink(&drawing, left.y, x, 1, (uint8_t[3]){0, 0, 0});
                if (inside > 2 && inside < width - 0.5) {
                    near++;
                    near_ink += on;
                } else if (inside > width + 3) {
                    far++;
                    far_ink += on;
                }
            }
            check_at_most("hidden", near_ink, 0, "halo of %d px: places within it with a line, of %d", width, near);
            check_near("hidden", far_ink, far, 0, "  places farther away with a line");
        }
        shot_release(&drawing);
        shape_release(&s);
    }
}

static void clutter(void)
{
    static const char *const amounts[] = {"0", "0.5", "1"};
    double                   last = INFINITY;
    for (int a = 0; a < 3; a++) {
        const char *changes[] = {"compose.clutter", amounts[a], NULL};
        shape       s = {0};
        shot        drawing;
        double      sum = 0;
        int         inked = 0, gone = 0;
        scene_make(&s, SCENE_CROSSING, 33);
        if (shot_of_shape(&drawing, &s, "clutter.glb",
                          LOOK("{\"select\":\"*\",\"surface\":\"flat\"," ALL_LAYERS "," LINES
                               ",\"compose\":{\"technique\":\"blueprint\",\"tint_opacity\":0,\"once\":false}}"),
                          changes, &views[0]))
            for (int i = 0; i < drawing.width * drawing.height; i++) {
                double ink = drawing.layer_count > 1 ? ink_of(&drawing.layers[1].edge[4 * i]) : 0;
                sum += 1 - picture_shown(drawing.picture[4 * i]) / picture_shown(ground[0]);
                if (ink > 0.95 && drawing.layers[1].edge[4 * i] < 10) { /* an outline of the first hidden layer */
                    inked++;
                    gone += drawing.picture[4 * i] > ground[0] - 8;
                }
            }
        check_at_most("hidden", sum, a ? 0.97 * last : INFINITY, "ink with clutter %s", amounts[a]);
        check_at_least("hidden", inked, 500, "  pixels of the second layer's outlines");
        check_at_most("hidden", gone, 0, "  of them, those that are cut off");
        last = sum;
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* Ink of a layer at a pixel, all lines together; the picture's last row and column go on beyond it. */
static double layer_ink_at(const shot *s, int layer, int x, int y)
{
    x = x < 0 ? 0 : x >= s->width ? s->width - 1 : x;
    y = y < 0 ? 0 : y >= s->height ? s->height - 1 : y;
    const uint8_t *e = &s->layers[layer].edge[4 * (y * s->width + x)];
    return 1 - fmin(e[2], e[3]) / 255.0;
}

/* What clutter leaves of the first hidden layer's lines: less of creases than of outlines, and less where the lines in
 * front crowd, by how much ink they have in 25 x 25 places, two pixels apart. */
static void crowded(void)
{
    const double             clutter = 0.8;
    static const char *const changes[] = {"compose.clutter", "0.8", NULL};
    static const char        look[] = LOOK("{\"select\":\"*\",\"surface\":\"flat\"," ALL_LAYERS "," LINES
                                           ",\"compose\":{\"technique\":\"blueprint\",\"tint_opacity\":0,\"once\":false}}");
    shape                    s = {0};
    shot                     plain, drawn;
    box_in_box(&s);
    shape_torus(&s, "ring", 1.2, 0.3, 12, 8);
    bool ok = shot_of_shape(&plain, &s, "clutter.glb", look, NULL, &views[0]);
    if (shot_of_shape(&drawn, &s, "clutter.glb", look, changes, &views[0]) && ok) {
        int    count = 0, creases = 0, busy = 0;
        double worst = 0;
        for (int y = 0; y < plain.height; y++)
            for (int x = 0; x < plain.width; x++) {
                size_t i = 4 * (size_t)(y * plain.width + x);
                double before = ground[0] - plain.picture[i], others = 0, sum = 0;
                for (int k = 0; k < plain.layer_count; k++)
                    others += k == 1 ? 0 : layer_ink_at(&plain, k, x, y);
                if (before < 30 || others > 0)
                    continue;
                for (int j = -12; j <= 12; j++)
                    for (int k = -12; k <= 12; k++)
                        sum += layer_ink_at(&plain, 0, x + 2 * k, y + 2 * j) / 625;
                const uint8_t *e = &plain.layers[1].edge[i];
                double important = fmax(1 - e[0] / 255.0, 1 - e[3] / 255.0), t = fmin(fmax((sum - 0.03) / 0.27, 0), 1);
                double wanted = (1 - clutter * (0.5 - 0.35 * important)) *
                                (1 - clutter * t * t * (3 - 2 * t) * (1 - 0.5 * important));
                worst = fmax(worst, fabs((ground[0] - drawn.picture[i]) / before - wanted));
                count++;
                creases += important < 0.1;
                busy += t > 0.1;
            }
        check_at_least("hidden", count, 300, "pixels that the first hidden layer alone inks");
        check_at_least("hidden", creases, 30, "  of creases");
        check_at_least("hidden", busy, 100, "  where lines in front crowd");
        check_at_most("hidden", worst, 0.04, "  ink that clutter leaves of them, off by");
        shot_release(&drawn);
    }
    if (ok)
        shot_release(&plain);
    shape_release(&s);
}

/* --- textures ------------------------------------------------------------------------------------------- */

enum { TEXELS = 64, FIELD = 16 };

static void checkered(shape_part *p)
{
    p->texture_size = TEXELS;
    p->texture = check_alloc((size_t)TEXELS * TEXELS, 4);
    for (int i = 0; i < TEXELS * TEXELS; i++) {
        bool dark = (i % TEXELS / FIELD + i / TEXELS / FIELD) % 2;
        memcpy(&p->texture[4 * i], dark ? (uint8_t[4]){200, 30, 30, 255} : (uint8_t[4]){40, 200, 220, 255}, 4);
    }
}

/* A textured plate behind both sides of a box, and another behind it: the pattern shows through. */
static void textures_through_layers(void)
{
    static const char look[] = LOOK("{\"select\":\"*\",\"surface\":{\"technique\":\"textured\",\"light\":0}," ALL_LAYERS
                                    ",\"compose\":{\"technique\":\"xray\",\"opacity\":0.4}}");
    shape             s = {0};
    shot              drawing;
    tally             t = {0};
    int               dark = 0, bright = 0;
    shape_box(&s, "box", dvec_of(-0.9, -0.9, 0.5), dvec_of(0.8, 0.8, 1));
    shape_quad(&s, "pattern", 1.2, 0);
    shape_quad(&s, "behind", 1.5, -1);
    scene_colour(&s);
    for (int k = 0; k < 3; k++)
        s.parts[1].colour[k] = 1;
    checkered(&s.parts[1]);
    if (shot_of_shape(&drawing, &s, "texture.glb", look, NULL, &straight)) {
        tracer   *rays = tracer_create(&s);
        stack_map map;
        stack_map_make(&map, rays, &drawing);
        for (int i = 0; i < drawing.width * drawing.height; i++) {
            paint wanted = paint_of(ground, 1);
            bool  sure = map.sharp[i], pattern = false;
            for (size_t k = stack_count(&map, i); k-- > 0;) {
                uint16_t id = stack_at(&map, i)[k].id;
                paint    p = part_paint(&s, id, 0.4);
                if (id == 2) {
                    dvec origin, direction;
                    shot_ray(&drawing, i % drawing.width + 0.5, i / drawing.width + 0.5, &origin, &direction);
                    double u = (0.5 + origin.x / 2.4) * TEXELS, v = (0.5 - origin.y / 2.4) * TEXELS;
                    double in_u = fmod(u, FIELD), in_v = fmod(v, FIELD);
                    int    field = ((int)u / FIELD + (int)v / FIELD) % 2;
                    sure = sure && fmin(fmin(in_u, FIELD - in_u), fmin(in_v, FIELD - in_v)) > 1.2;
                    p = paint_of(&s.parts[1].texture[field ? 4 * FIELD : 0], 0.4);
                    pattern = true;
                    dark += field && stack_at(&map, i)[0].id == 1;
                    bright += !field && stack_at(&map, i)[0].id == 1;
                }
                put_over(&wanted, p);
            }
            judge(&t, &drawing, i, sure && pattern, wanted);
        }
        stack_map_release(&map);
        tracer_destroy(rays);
    }
    check_at_least("B08", dark < bright ? dark : bright, 1000, "pixels of either field behind the box");
    check_tally("B08", &t, &drawing, 5000, "a texture behind layers and before others");
    shot_release(&drawing);
    shape_release(&s);
}

/* --- plan views ----------------------------------------------------------------------------------------- */

/* Chambers under a roof, seen from the named side. */
static void plan_view(int named, const char *what)
{
    static const char deep[] = LOOK("{\"select\":\"*\",\"surface\":\"flat\"," ALL_LAYERS "," LINES
                                    ",\"compose\":{\"technique\":\"blueprint\",\"tint_opacity\":0.05}}");
    static const char flat[] = LOOK("{\"select\":\"*\",\"surface\":\"flat\"," LINES "}");
    const shot_view   view = {.width = 256, .height = 256, .bare = true, .named = named, .orthographic = true};
    shape             s = {0};
    shot              blueprint, front;
    shape_box(&s, "house", dvec_of(-2, 0, -1.5), dvec_of(2, 1.2, 1.5));
    shape_box(&s, "wall one", dvec_of(-0.6, 0.05, -1.3), dvec_of(-0.45, 1, 0.6));
    shape_box(&s, "wall two", dvec_of(-0.45, 0.05, 0.1), dvec_of(1.3, 0.9, 0.25));
    shape_box(&s, "pillar", dvec_of(-1.4, 0.05, -0.4), dvec_of(-1.1, 1.1, -0.1));
    shape_box(&s, "statue", dvec_of(0.5, 0.05, -0.9), dvec_of(0.9, 0.7, -0.5));
    bool drawn = shot_of_shape(&blueprint, &s, "plan.glb", deep, NULL, &view);
    if (shot_of_shape(&front, &s, "plan.glb", flat, NULL, &view) && drawn) {
        int stray = 0, judged = 0;
        for (size_t part = 0; part < s.count; part++) {
            double seen = edges_seen(&blueprint, &s.parts[part], NULL);
            check_at_least("B11", seen, 0.99, "%s: fraction of the edges of %s with a line", what, s.parts[part].name);
            if (part > 0)
                check_at_most("B11", edges_seen(&front, &s.parts[part], &s.parts[0]), 0,
                              "  and in a drawing of the front alone");
        }
        for (int y = 2; y < 254; y++)
            for (int x = 2; x < 254; x++) {
                double least = INFINITY;
                for (size_t part = 0; part < s.count; part++)
                    least = fmin(least, distance_to_edges(&blueprint, &s.parts[part], x + 0.5, y + 0.5));
                judged += least > 2.5;
                stray += least > 2.5 && pixel(&blueprint, x, y)[0] < 110;
            }
        check_at_most("B11", stray, 0, "%s: dark pixels farther than 2.5 px from every edge, of %d", what, judged);
    }
    shot_release(&blueprint);
    shot_release(&front);
    shape_release(&s);
}

static void plan_views(void)
{
    plan_view(LMN_VIEW_TOP, "from above");
    plan_view(LMN_VIEW_FRONT, "from the front");
    plan_view(LMN_VIEW_RIGHT, "from the right");
}

/* Lines of a beam that runs over the page are at its borders what they are in its middle, behind others, too. */
static void borders_of_the_page(void)
{
    static const char look[] =
        LOOK("{\"surface\":{\"technique\":\"flat\"},\"lines\":{\"operator\":\"four-tap\",\"width\":\"2px\",\"colour\":"
             "\"#000000\"}," ALL_LAYERS ",\"compose\":{\"technique\":\"blueprint\",\"tint\":\"#00000000\"}}");
    for (int upright = 0; upright < 2; upright++) {
        const shot_view view = {.width = 96,
                                .height = 96,
                                .eye = upright ? dvec_of(2, 0, 5) : dvec_of(0, 2, 5),
                                .up = {0, 1, 0},
                                .orthographic = true,
                                .fov_deg = 40};
        shape           s = {0};
        shot            drawing;
        int             least = 1000000, most = 0, columns[4] = {0, 1, 94, 95};
        shape_box(&s, "beam", dvec_of(upright ? -0.3 : -20, upright ? -20 : -0.3, -0.5),
                  dvec_of(upright ? 0.3 : 20, upright ? 20 : 0.3, 0.5));
        shape_box(&s, "stud", dvec_of(-0.1, -0.1, -0.1), dvec_of(0.1, 0.1, 0.1));
        if (shot_of_shape(&drawing, &s, "beam.glb", look, NULL, &view))
            for (int i = 0; i < 5; i++) {
                int sum = 0, column = i < 4 ? columns[i] : 30;
                for (int k = 0; k < 96; k++)
                    sum += ground[1] - pixel(&drawing, upright ? k : column, upright ? column : k)[1];
                least = sum < least ? sum : least;
                most = sum > most ? sum : most;
            }
        check_at_least("B02", least, 10 * ground[1], "%s beam: ink of six lines across it, at the least place",
                       upright ? "upright" : "level");
        check_at_most("B02", most - least, 64, "  less than at the most");
        shot_release(&drawing);
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"borders", borders_of_the_page},
        {"sorted", sorted},
        {"order", any_order},
        {"figures", two_figures},
        {"inked", lines_over_layers},
        {"tint", tint_adds_up},
        {"edges", hidden_edges},
        {"opaque", opaque_amid_layers},
        {"glyphs", glyphs},
        {"focus", focus},
        {"wire", wire},
        {"dashes", hidden_colour_and_dashes},
        {"width", hidden_width},
        {"once", repeated_once},
        {"halo", halo},
        {"clutter", clutter},
        {"crowded", crowded},
        {"texture", textures_through_layers},
        {"plan", plan_views},
    };
    int status = check_main(argc, argv, "layers_compose", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
