/* Perturbed layers against a CPU twin: one field moves all of them, so that they keep their order and their shared
 * edges. */
#include <limner/draw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "csg_scenes.h"
#include "picture.h"
#include "scenes.h"
#include "sketch_twin.h"

#define LOOK(RULES) "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ece4d2\"},\"rules\":[" RULES "]}"
#define INK         "\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#102080c0\"}"
#define ALL_LAYERS  "\"layers\":{\"technique\":\"peel\",\"count\":0}"

static const uint8_t ground_bytes[3] = {0xec, 0xe4, 0xd2}, ink_bytes[3] = {0x10, 0x20, 0x80},
                     tint_bytes[3] = {0x20, 0x50, 0xc0}, red_bytes[3] = {255, 0x20, 0x10};

static const shot_view views[] = {
    {.width = 200, .height = 160, .eye = {4, 3, 5}, .up = {0, 1, 0}},
    {.width = 176, .height = 192, .eye = {-3, 4, -5.5}, .up = {0, 1, 0}, .orthographic = true},
    {.width = 189, .height = 181, .eye = {1.2, -3, 4.4}, .target = {0.2, 0.1, 0}, .up = {0.2, 1, 0}, .fov_deg = 50},
};

typedef enum fill_kind { FILL_TINT, FILL_SHADE, FILL_NONE } fill_kind;

/* How a layered rule draws, for its twin. */
typedef struct stack_style {
    double        amount;
    sketch_degree edges, shades;
    fill_kind     fill;
    double        opacity; /* of the tint or the shade */
    double        hidden;  /* opacity of hidden lines */
    int           repeat;  /* 0 is 1; further copies are red */
} stack_style;

/* A layer's colour and depth at a pixel; alpha 0 where it has nothing. */
static sketch_paint layer_at(const sketch_maps *m, const stack_style *style, int k, int x, int y, double *depth)
{
    sketch_style    lines = {.amount = style->amount,
                             .edges = style->edges,
                             .ink = sketch_colour(ink_bytes, 0xc0 / 255.0),
                             .repeat = style->repeat,
                             .repeat_degree = 1};
    sketch_position s = sketch_moved(m, x, y, style->amount, style->shades);
    sketch_paint    fill = {0, 0, 0, 0}, all = {0, 0, 0, 0};
    double          line_depth;
    *depth = sketch_depth(m, s);
    if (isfinite(*depth) && style->fill == FILL_TINT)
        fill = sketch_colour(tint_bytes, style->opacity);
    else if (isfinite(*depth) && style->fill == FILL_SHADE)
        fill = sketch_fraction(sketch_shade(m, s), style->opacity);
    for (int i = 0; i < 7; i++) /* copies have a colour of their own and the strength of the first */
        lines.repeat_inks[i] = sketch_colour(red_bytes, 0xc0 / 255.0);
    for (int i = style->repeat > 1 ? style->repeat - 1 : 0; i >= 0; i--) {
        sketch_paint ink = sketch_copy_ink(m, &lines, i, x, y, &line_depth);
        if (style->fill == FILL_NONE) /* a threshold leaves lines whole or out */
            ink = ink.a >= 0.5 ? sketch_fraction(ink, 1 / ink.a) : (sketch_paint){0, 0, 0, 0};
        all = sketch_over(sketch_fraction(ink, k ? style->hidden : 1), all);
        *depth = fmin(*depth, line_depth);
    }
    return isfinite(*depth) ? sketch_over(all, fill) : (sketch_paint){0, 0, 0, 0};
}

/* Every pixel of a drawing whose layers' maps are at hand. `other`: the field that odd layers take instead of the
 * drawing's own, or NULL. */
static sketch_tally against_layers(const shot *s, const stack_style *style, const shot *other)
{
    sketch_tally t = {0};
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            sketch_paint sum = sketch_colour(ground_bytes, 1);
            for (int k = s->layer_count; k-- > 0;) {
                double      depth;
                sketch_maps m = sketch_maps_of_layer(s, k);
                if (other && k % 2)
                    m.uncertainty = (const float(*)[3])other->uncertainty;
                sum = sketch_over(layer_at(&m, style, k, x, y, &depth), sum);
            }
            sketch_judge(&t, s, x, y, sum, 3);
        }
    return t;
}

/* --- whole pictures ------------------------------------------------------------------------------------- */

typedef struct layered_case {
    const char *compose, *perturb;
    stack_style style;
    double      fraction;
} layered_case;

static const layered_case cases[] = {
    {"{\"technique\":\"blueprint\",\"tint\":\"#2050c0\",\"tint_opacity\":0.2,\"once\":false}",
     "{\"technique\":\"uncertainty\",\"amount\":6}",
     {6, {1, 0, 0, 1}, {-0.75, 0, 0, -0.75}, FILL_TINT, 0.2, 1},
     0.995},
    {"{\"technique\":\"blueprint\",\"tint\":\"#2050c0\",\"tint_opacity\":0.3,\"once\":false,\"hidden_opacity\":0.5}",
     "{\"technique\":\"uncertainty\",\"amount\":9,\"lock\":\"screen\",\"edges_xy\":0.7,\"edges_yx\":-0.4,\"shades_xx\":"
     "0.2,\"shades_xy\":1.1}",
     {9, {1, 0.7, -0.4, 1}, {0.2, 1.1, 0, -0.75}, FILL_TINT, 0.3, 0.5},
     0.995},
    {"{\"technique\":\"xray\",\"opacity\":0.4,\"once\":false}",
     "{\"technique\":\"uncertainty\",\"amount\":7,\"scale\":45}",
     {7, {1, 0, 0, 1}, {-0.75, 0, 0, -0.75}, FILL_SHADE, 0.4, 1},
     0.995},
    {"{\"technique\":\"wire\",\"once\":false,\"softness\":0}",
     "{\"technique\":\"uncertainty\",\"amount\":7,\"field\":\"turbulence\"}",
     {7, {1, 0, 0, 1}, {-0.75, 0, 0, -0.75}, FILL_NONE, 0, 1},
     0.99},
    {"{\"technique\":\"blueprint\",\"tint\":\"#2050c0\",\"tint_opacity\":0.2,\"once\":false,\"hidden_opacity\":0.6}",
     "{\"technique\":\"uncertainty\",\"amount\":7,\"repeat\":3,\"repeat_colours\":[\"#ff2010\"]}",
     {7, {1, 0, 0, 1}, {-0.75, 0, 0, -0.75}, FILL_TINT, 0.2, 0.6, 3},
     0.995},
};

enum { CASES = sizeof cases / sizeof *cases };

static const char *look_of(const layered_case *c, const char *producer, const char *perturb)
{
    static char texts[4][1024];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 4;
    snprintf(
        text, sizeof texts[0],
        LOOK("{\"select\":\"*\",\"surface\":{\"technique\":\"flat\",\"model_colour\":1}," INK
             ",\"layers\":{\"technique\":\"peel\",\"count\":0,\"producer\":\"%s\"},\"compose\":%s,\"perturb\":%s}"),
        producer, c->compose, perturb ? perturb : c->perturb);
    return text;
}

/* Is a field tied to one seed the field of all layers? A drawing, and one of another seed for its field. */
static bool take_pair(shot *drawn, shot *other, const layered_case *c, scene_kind kind, uint32_t seed,
                      const char *producer, const shot_view *view)
{
    shape     s = {0};
    shot_view reseeded = *view;
    reseeded.seed = 77;
    scene_make(&s, kind, seed);
    scene_colour(&s);
    bool ok = shot_of_shape(drawn, &s, "layers.glb", look_of(c, producer, NULL), NULL, view);
    ok = shot_of_shape(other, &s, "layers.glb", look_of(c, producer, NULL), NULL, &reseeded) && ok;
    shape_release(&s);
    return ok &&
           check_that("S10", drawn->uncertainty && other->uncertainty, "the drawings have their fields of uncertainty");
}

/* Row C21: every layer is looked up by the same field, so that they keep their order. */
static void whole_pictures(void)
{
    for (size_t c = 0; c < CASES; c++)
        for (int v = 0; v < 3; v++) {
            char title[160];
            shot drawn, other;
            snprintf(title, sizeof title, "%.*s, view %d, %s", 40, cases[c].compose, v, v % 2 ? "lists" : "peeling");
            if (take_pair(&drawn, &other, &cases[c], (scene_kind)((c + (size_t)v) % 3), 80 + (uint32_t)v,
                          v % 2 ? "lists" : "peeling", &views[v])) {
                sketch_tally t = against_layers(&drawn, &cases[c].style, NULL),
                             apart = against_layers(&drawn, &cases[c].style, &other);
                check_at_least("S10", drawn.layer_count, 4, "layers");
                sketch_check("C20", &t, &drawn, cases[c].fraction, title);
                check_at_least("C21", apart.pixels - apart.right - (t.pixels - t.right), 500,
                               "  more pixels that are wrong when every other layer is given another field");
            }
            shot_release(&drawn);
            shot_release(&other);
        }
}

/* --- what compositions find ------------------------------------------------------------------------------- */

typedef struct found_tally {
    int    there, wrong_depth, before, edges, wrong_edges, moved_edges, fill, wrong_fill, moved_fill;
    double worst_depth;
} found_tally;

/* The largest difference of a texel's channels. */
static int texel_off(const uint8_t *a, const double b[4])
{
    double off = 0;
    for (int k = 0; k < 4; k++)
        off = fmax(off, fabs(a[k] - b[k]));
    return (int)ceil(off - 0.5);
}

/* One pixel of a layer's maps against the exact maps and the field, straight from the formulas. */
static void judge_found(found_tally *t, const shot *s, const stack_style *style, int k, int x, int y)
{
    const shot_layer *l = &s->layers[k];
    sketch_maps       m = sketch_maps_of_layer(s, k);
    size_t            i = (size_t)(s->height - 1 - y) * (size_t)s->width + (size_t)x;
    sketch_position   e = sketch_moved(&m, x, y, style->amount, style->edges),
                    f = sketch_moved(&m, x, y, style->amount, style->shades);
    double       fill_depth = sketch_depth(&m, f), depth = fmin(sketch_depth(&m, e), fill_depth), edge[4];
    sketch_paint fill = isfinite(fill_depth) ? sketch_shade(&m, f) : (sketch_paint){0, 0, 0, 0};
    double       straight[4] = {0, 0, 0, fill.a * 255};
    double       found = (double)l->found_depth[i], exact = (double)l->depth[i];
    t->there += isfinite(depth);
    t->wrong_depth += isfinite(depth) != isfinite(found) || (isfinite(depth) && fabs(found - depth) > 1e-3 * depth);
    t->before += k > 0 && (double)s->layers[k - 1].found_depth[i] > found;
    sketch_edge(&m, e, edge);
    for (int c = 0; c < 4; c++)
        edge[c] *= 255;
    t->edges += edge[2] < 250;
    t->wrong_edges += texel_off(&l->found_edge[4 * i], edge) > 3;
    t->moved_edges += texel_off(&l->edge[4 * i], edge) > 64;
    if (fill.a > 0.02) {
        straight[0] = picture_level(fill.r / fill.a);
        straight[1] = picture_level(fill.g / fill.a);
        straight[2] = picture_level(fill.b / fill.a);
    }
    t->fill += fill.a > 0.5;
    t->wrong_fill += (fill.a > 0.5 || l->found_shade[4 * i + 3] > 0) && texel_off(&l->found_shade[4 * i], straight) > 4;
    t->moved_fill += fill.a > 0.5 && !isfinite(exact);
}

/* Figure 4, b to d: of each layer the depth, the edges and the fill are to be had as they are composed. */
static void maps_of_layers(void)
{
    for (size_t c = 0; c < 3; c++) {
        shape       s = {0};
        shot        drawn;
        found_tally t = {0};
        scene_make(&s, SCENE_CLOSED, 90 + (uint32_t)c);
        scene_colour(&s);
        if (shot_of_shape(&drawn, &s, "found.glb", look_of(&cases[c], c % 2 ? "lists" : "peeling", NULL), NULL,
                          &views[c])) {
            bool all = drawn.layer_count > 0;
            for (int k = 0; k < drawn.layer_count; k++)
                all = all && drawn.layers[k].found_depth;
            check_that("C20", all && drawn.layer_count == drawn.layers_drawn, "each of %d layers has perturbed maps",
                       drawn.layers_drawn);
            for (int k = 0; k < drawn.layer_count && all; k++)
                for (int i = 0; i < drawn.width * drawn.height; i++)
                    judge_found(&t, &drawn, &cases[c].style, k, i % drawn.width, i / drawn.width);
            check_at_least("C20", t.moved_edges, 1000, "  pixels where edges are not where they were");
            check_at_least("C20", t.moved_fill, 300, "  pixels where fill has left its surface");
            check_at_most("C20", t.wrong_depth, t.there / 200, "  of %d depths, those that are not the nearer lookup's",
                          t.there);
            check_at_most("C20", t.wrong_edges, t.edges / 200, "  of %d edges, those that are not as looked up",
                          t.edges);
            check_at_most("C20", t.wrong_fill, t.fill / 200, "  of %d fills, those that are not as looked up", t.fill);
            check_at_most("C21", t.before, 0, "  places where a layer lies before the one in front of it");
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* Solids, whose surfaces are in no mesh, are sketched as meshes are: a spanner, and trees made from seeds. */
static void sketched_solids(void)
{
    for (int k = 0; k < 3; k++) {
        csg                 c = {0};
        shot                drawn;
        char                path[512];
        const layered_case *style = &cases[k];
        if (k == 0)
            csg_spanner(&c);
        else
            csg_random(&c, CSG_CONVEX, 40 + (uint32_t)k);
        csg_colour(&c);
        snprintf(path, sizeof path, "%s", check_path("sketched.csg"));
        if (csg_write(&c, path) && shot_take(&drawn, path, look_of(style, "auto", NULL), NULL, &views[k])) {
            sketch_tally t = against_layers(&drawn, &style->style, NULL);
            check_at_least("S10", drawn.layer_count, 2, "layers of a solid");
            sketch_check("S10", &t, &drawn, style->fraction, "  sketched");
            shot_release(&drawn);
        }
        csg_release(&c);
    }
}

/* What is displaced far gets into parts of the page where the layer itself is not: none of them may be left out. */
static void far_away(void)
{
    static const char *const  producers[] = {"peeling", "lists"};
    static const layered_case c = {
        "{\"technique\":\"blueprint\",\"tint\":\"#2050c0\",\"tint_opacity\":0.2,\"once\":false}",
        "{\"technique\":\"uncertainty\",\"amount\":45,\"scale\":120,\"lock\":\"screen\"}",
        {45, {1, 0, 0, 1}, {-0.75, 0, 0, -0.75}, FILL_TINT, 0.2, 1},
        0.995};
    for (int p = 0; p < 2; p++) {
        shape     s = {0};
        shot      drawn;
        shot_view view = {.width = 400, .height = 360, .eye = {0, 0, 10}, .up = {0, 1, 0}, .orthographic = true};
        shape_quad(&s, "large", 1, -0.5);
        shape_place(&s, dvec_of(0, 0, 1), 20, dvec_of(-0.3, 0, 0));
        shape_quad(&s, "small", 0.15, 0.5);
        shape_place(&s, dvec_of(0, 0, 1), 45, dvec_of(1.2, 0.6, 0));
        shape_quad(&s, "over", 0.12, 0.6);
        shape_place(&s, dvec_of(0, 0, 1), 30, dvec_of(-0.3, 0.2, 0));
        if (shot_of_shape(&drawn, &s, "far.glb", look_of(&c, producers[p], NULL), NULL, &view)) {
            sketch_tally t = against_layers(&drawn, &c.style, NULL);
            check_near("S10", drawn.layer_count, 2, 0, "layers, %s", producers[p]);
            sketch_check("C20", &t, &drawn, 0.999, "  small layers displaced far");
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* Lists that do not fit are drawn in pieces; perturbed drawings look beyond any piece. */
static void pieces(void)
{
    const char *change[] = {"layers.memory", "1", NULL};
    shape       s = {0};
    shot        whole, parts;
    shot_view   view = views[0];
    int         differ = 0;
    view.width = view.height = 400;
    scene_make(&s, SCENE_CROSSING, 130);
    bool ok = shot_of_shape(&whole, &s, "pieces.glb", look_of(&cases[1], "lists", NULL), NULL, &view);
    if (shot_of_shape(&parts, &s, "pieces.glb", look_of(&cases[1], "lists", NULL), change, &view) && ok) {
        for (int i = 0; i < 400 * 400; i++)
            for (int k = 0; k < 4; k++)
                differ += abs(whole.picture[4 * i + k] - parts.picture[4 * i + k]) > 1;
        check_note("with 1 MiB the layers come from %s%s", parts.layer_producer,
                   shot_has_warning(&parts, "layer-memory") ? ", with a warning" : "");
        check_at_most("S10", differ, 0, "values that differ when lists may take 1 MiB alone");
    }
    shot_release(&whole);
    shot_release(&parts);
    shape_release(&s);
}

/* --- with others ---------------------------------------------------------------------------------------- */

/* An exact opaque part amid perturbed layers: those whose nearer lookup lies before it are seen before it, no
 * others. */
static void opaque_amid(void)
{
    for (int v = 0; v < 3; v++) {
        const layered_case *c = &cases[v % 2];
        char                look[1024];
        shape               s = {0};
        shot                both, layers, core;
        snprintf(look, sizeof look,
                 LOOK("{\"select\":\"closed*\",\"surface\":\"flat\"," INK
                      ",\"layers\":{\"technique\":\"peel\",\"count\":0,\"complement\":false}"
                      ",\"compose\":%s,\"perturb\":%s},"
                      "{\"select\":\"core\",\"layers\":{\"complement\":false},\"surface\":{\"technique\":\"flat\","
                      "\"colour\":\"#ff2010\"}}"),
                 c->compose, c->perturb);
        scene_make(&s, SCENE_CLOSED, 17 + (uint32_t)v);
        shape_sphere(&s, "core", dvec_of(0.1, 0, 0.05), 0.5, 24, 48, true);
        shot_view of_layers = views[v], of_core = views[v];
        of_layers.select = "closed*"; /* the core lies within their bounds, so that nothing else changes */
        of_core.select = "core";
        bool ok = shot_of_shape(&both, &s, "core.glb", look, NULL, &views[v]);
        ok = shot_of_shape(&layers, &s, "core.glb", look, NULL, &of_layers) && ok;
        ok = shot_of_shape(&core, &s, "core.glb", look, NULL, &of_core) && ok;
        if (ok) {
            sketch_tally t = {0};
            int          hidden = 0, tinted = 0;
            for (int y = 0; y < both.height; y++)
                for (int x = 0; x < both.width; x++) {
                    sketch_maps  of = sketch_maps_of(&core);
                    double       own = sketch_depth(&of, (sketch_position){x, y}), depth;
                    sketch_paint sum = isfinite(own) ? sketch_colour(red_bytes, 1) : sketch_colour(ground_bytes, 1);
                    for (int k = layers.layer_count; k-- > 0;) {
                        sketch_maps  m = sketch_maps_of_layer(&layers, k);
                        sketch_paint p = layer_at(&m, &c->style, k, x, y, &depth);
                        hidden += isfinite(own) && p.a > 0 && depth >= own;
                        tinted += isfinite(own) && p.a > 0 && depth < own;
                        sum = depth < own ? sketch_over(p, sum) : sum;
                    }
                    sketch_judge(&t, &both, x, y, sum, 3);
                }
            sketch_check("S10", &t, &both, 0.995, "an exact part amid perturbed layers");
            check_at_least("S10", hidden, 500, "  places of layers that it hides");
            check_at_least("S10", tinted, 200, "  and that lie before it");
        }
        shot_release(&both);
        shot_release(&layers);
        shot_release(&core);
        shape_release(&s);
    }
}

/* --- shared edges --------------------------------------------------------------------------------------- */

#define WIRE(COLOUR, HIDDEN, COUNT, REST)                                                                              \
    LOOK("{\"select\":\"*\",\"surface\":\"flat\",\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"" COLOUR       \
         "\"},"                                                                                                        \
         "\"layers\":{\"technique\":\"peel\",\"count\":" #COUNT                                                        \
         "},\"compose\":{\"technique\":\"xray\",\"opacity\":0,\"once\":false,\"hidden_colour\":\"" HIDDEN "\"}" REST   \
         "}")
#define WAVES ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":9,\"scale\":40}"

static double ink_at(const shot *s, int x, int y)
{
    return x < 0 || y < 0 || x >= s->width || y >= s->height ? 0
                                                             : (0xec - fmin(0xec, sketch_pixel(s, x, y)[0])) / 236.0;
}

/* How alike the ink of two drawings is when one is moved. */
static double likeness(const shot *a, const shot *b, int dx, int dy)
{
    double ab = 0, aa = 0, bb = 0;
    for (int y = 0; y < a->height; y++)
        for (int x = 0; x < a->width; x++) {
            double p = ink_at(a, x, y), q = ink_at(b, x + dx, y + dy);
            ab += p * q;
            aa += p * p;
            bb += q * q;
        }
    return aa > 0 && bb > 0 ? ab / sqrt(aa * bb) : 0;
}

/* The outline of a box belongs to its front and to its back: two layers. */
static void shared_edges(void)
{
    static const char front[] = WIRE("#000000", "#000000", 1, WAVES), back[] = WIRE("none", "#000000", 2, WAVES),
                      exact[] = WIRE("#000000", "#000000", 1, "");
    for (int v = 0; v < 2; v++) {
        shot_view view = {.width = 240, .height = 220, .eye = {4, 3, 5}, .up = {0, 1, 0}, .orthographic = v},
                  reseeded = view;
        shape s = {0};
        shot  a, b, unlike, still;
        reseeded.seed = 5;
        shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        bool ok = shot_of_shape(&a, &s, "box.glb", front, NULL, &view);
        ok = shot_of_shape(&b, &s, "box.glb", back, NULL, &view) && ok;
        ok = shot_of_shape(&unlike, &s, "box.glb", back, NULL, &reseeded) && ok;
        ok = shot_of_shape(&still, &s, "box.glb", exact, NULL, &view) && ok;
        if (ok) {
            double best = -1, other_best = -1, at_zero = likeness(&a, &b, 0, 0);
            int    best_x = 9, best_y = 9;
            for (int dy = -6; dy <= 6; dy++)
                for (int dx = -6; dx <= 6; dx++) {
                    double own = likeness(&a, &b, dx, dy);
                    other_best = fmax(other_best, likeness(&a, &unlike, dx, dy));
                    if (own > best) {
                        best = own;
                        best_x = dx;
                        best_y = dy;
                    }
                }
            check_near("C22", hypot(best_x, best_y), 0, 0,
                       "px between the places of an outline in two layers, where they are most alike");
            check_at_least("C22", at_zero, 0.55,
                           "  how alike they are there: the outline is some two thirds of the ink");
            check_at_most("C22", other_best / at_zero, 0.7,
                          "  the same with another field for the hidden layer, at its best, over that");
            check_at_most("C22", likeness(&a, &still, 0, 0), 0.6, "  with the exact drawing");
        }
        shot_release(&a);
        shot_release(&b);
        shot_release(&unlike);
        shot_release(&still);
        shape_release(&s);
    }
}

/* An edge that repeats in the next layer is inked once, perturbed or not: with half-transparent ink it would be
 * darker otherwise. */
static void inked_once(void)
{
    static const char *const perturbs[] = {
        "", ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":8}",
        ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":8,\"lock\":\"screen\"}"};
    int   dark[3] = {0}, twice[3] = {0};
    shape s = {0};
    shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    for (int k = 0; k < 6; k++) {
        char look[768];
        shot drawn;
        snprintf(look, sizeof look,
                 LOOK("{\"select\":\"*\",\"surface\":\"flat\",\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#"
                      "00000080\"}," ALL_LAYERS ",\"compose\":{\"technique\":\"xray\",\"opacity\":0,\"once\":%s}%s}"),
                 k < 3 ? "true" : "false", perturbs[k % 3]);
        if (shot_of_shape(&drawn, &s, "once.glb", look, NULL, &views[0]))
            for (int i = 0; i < drawn.width * drawn.height; i++)
                *(k < 3 ? &dark[k] : &twice[k - 3]) += drawn.picture[4 * i] < 95; /* one layer of ink: 127 */
        shot_release(&drawn);
    }
    for (int k = 0; k < 3; k++) {
        check_at_least("C22", twice[k], 150, "%s: pixels that are inked twice when repeated edges are kept",
                       *perturbs[k] ? perturbs[k] + 11 : "exact");
        check_at_most("C22", (double)dark[k] / twice[k], 0.2,
                      "  fraction of them (and of crossings) that stay without repeated edges");
    }
    shape_release(&s);
}

/* A cut face's hatching is drawn once, with the lines, whatever moves the fill. */
static void hatched(void)
{
    static const char *const composes[] = {"\"compose\":\"blueprint\"",
                                           "\"compose\":{\"technique\":\"xray\",\"opacity\":0.5}"};
    for (int c = 0; c < 2; c++) {
        int   dark[2] = {0};
        shape s = {0};
        shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        for (int k = 0; k < 2; k++) {
            char      look[640];
            shot      drawn;
            shot_view view = {.width = 240, .height = 240, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
            snprintf(look, sizeof look,
                     "{\"version\":1,\"name\":\"t\",\"scene\":{\"cut\":\"z\",\"cut_width\":2,\"cut_colour\":\"#"
                     "000000\"},\"rules\":[{\"select\":\"*\","
                     "\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},\"lines\":{\"operator\":"
                     "\"discontinuity\",\"colour\":\"#000000\"}," ALL_LAYERS ",%s%s}]}",
                     composes[c], k ? ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":8}" : "");
            if (shot_of_shape(&drawn, &s, "hatched.glb", look, NULL, &view))
                for (int y = 80; y < 160; y++)
                    for (int x = 80; x < 160; x++)
                        dark[k] += sketch_pixel(&drawn, x, y)[0] < 200;
            shot_release(&drawn);
        }
        check_at_least("S10", dark[0], 500, "pixels of hatching, exact, %s", composes[c]);
        check_near("S10", dark[0] ? (double)dark[1] / dark[0] : 0, 1, 0.25,
                   "  how many of them there are when perturbed");
        shape_release(&s);
    }
}

/* --- alike ---------------------------------------------------------------------------------------------- */

static void producers(void)
{
    for (size_t c = 0; c < CASES; c++) {
        shape s = {0};
        shot  peeled, listed;
        int   worst = 0, differ = 0;
        scene_make(&s, c % 2 ? SCENE_CROSSING : SCENE_OPEN, 110 + (uint32_t)c);
        scene_colour(&s);
        bool ok = shot_of_shape(&peeled, &s, "alike.glb", look_of(&cases[c], "peeling", NULL), NULL, &views[c % 3]);
        if (shot_of_shape(&listed, &s, "alike.glb", look_of(&cases[c], "lists", NULL), NULL, &views[c % 3]) && ok) {
            double field = 0;
            for (int i = 0; i < peeled.width * peeled.height; i++) {
                int most = 0;
                for (int k = 0; k < 4; k++)
                    most = abs(peeled.picture[4 * i + k] - listed.picture[4 * i + k]) > most
                               ? abs(peeled.picture[4 * i + k] - listed.picture[4 * i + k])
                               : most;
                worst = most > worst ? most : worst;
                differ += most > 1;
                for (int k = 0; k < 3; k++)
                    field = fmax(field, fabs((double)peeled.uncertainty[i][k] - (double)listed.uncertainty[i][k]));
            }
            check_that("S10",
                       strcmp(peeled.layer_producer, "peeling") == 0 && strcmp(listed.layer_producer, "lists") == 0,
                       "both producers are used");
            check_at_most("S10", differ, 0, "  pixels that differ between them (most: %d levels), %.40s", worst,
                          cases[c].compose);
            check_at_most("S10", field, 5e-4, "  their fields");
        }
        shot_release(&peeled);
        shot_release(&listed);
        shape_release(&s);
    }
}

/* Can a lookup that starts at the pixel get onto the figure? Where none can, the field may be left out. */
static bool near_figure(const shot *s, int pixel)
{
    sketch_maps m = sketch_maps_of(s);
    return isfinite(sketch_reach(&m, (sketch_position){pixel % s->width, s->height - 1 - pixel / s->width}, 7));
}

/* The field is that of what is seen: the same for the figure drawn opaque, for one layer and for all. */
static void field_of_front(void)
{
    static const char *const rules[] = {"\"compose\":\"opaque\"",
                                        "\"layers\":{\"technique\":\"peel\",\"count\":1},\"compose\":\"blueprint\"",
                                        ALL_LAYERS ",\"compose\":\"blueprint\"", ALL_LAYERS ",\"compose\":\"wire\""};
    shape                    s = {0};
    shot                     drawn[4];
    bool                     ok = true;
    scene_make(&s, SCENE_CLOSED, 120);
    for (int k = 0; k < 4; k++) {
        char look[512];
        snprintf(look, sizeof look,
                 LOOK("{\"select\":\"*\",\"surface\":\"flat\"," INK
                      ",%s,\"perturb\":{\"technique\":\"uncertainty\",\"amount\":6}}"),
                 rules[k]);
        ok = shot_of_shape(&drawn[k], &s, "front.glb", look, NULL, &views[0]) && drawn[k].uncertainty && ok;
    }
    for (int k = 1; k < 4 && ok; k++) {
        double worst = 0;
        int    at = 0;
        for (int i = 0; i < drawn[0].width * drawn[0].height; i++)
            for (int c = 0; c < 3 && near_figure(&drawn[0], i); c++) {
                double error = fabs((double)drawn[0].uncertainty[i][c] - (double)drawn[k].uncertainty[i][c]);
                at = error > worst ? i : at;
                worst = fmax(worst, error);
            }
        if (!check_at_most("S10", worst, 1e-3, "the field of an opaque figure and that with %s", rules[k]))
            check_note("worst at %d, %d from the upper left", at % drawn[0].width, at / drawn[0].width);
    }
    check_that("S10", ok, "four drawings have their fields");
    for (int k = 0; k < 4; k++)
        shot_release(&drawn[k]);
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case all[] = {
        {"whole", whole_pictures}, {"maps", maps_of_layers}, {"solids", sketched_solids}, {"far", far_away},
        {"pieces", pieces},        {"opaque", opaque_amid},  {"shared", shared_edges},    {"once", inked_once},
        {"hatched", hatched},      {"producers", producers}, {"field", field_of_front},
    };
    int status = check_main(argc, argv, "sketch_layers", all, sizeof all / sizeof *all);
    shot_end();
    return status;
}
