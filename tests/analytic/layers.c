/* Depth layers against all surfaces that rays find: order, completeness, where they end, what their edge maps are
 * made of. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "feature.h"
#include "picture.h"
#include "scenes.h"
#include "stack.h"
#include "twin.h"

static const char edge_lines[] = "{\"operator\":\"discontinuity\"}";

static const shot_view views[] = {
    {.width = 160, .height = 128, .eye = {4, 3, 5}, .up = {0, 1, 0}},
    {.width = 128, .height = 144, .eye = {-2, 3, -4}, .up = {0, 1, 0}, .orthographic = true},
    {.width = 141, .height = 133, .eye = {1, -2.5, 3.5}, .target = {0.2, 0.1, 0}, .up = {0.2, 1, 0}, .fov_deg = 55},
};

/* One rule for everything: the model's own colours, these layers (what follows the technique), and lines or NULL. */
static const char *layered_look(const char *layers, const char *lines)
{
    static char texts[4][1024];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 4;
    snprintf(text, sizeof texts[0],
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\","
             "\"surface\":{\"technique\":\"flat\",\"model_colour\":1},\"layers\":{\"technique\":\"peel\",%s},"
             "\"compose\":{\"technique\":\"xray\",\"opacity\":0.5}%s%s}]}",
             layers, lines ? ",\"lines\":" : "", lines ? lines : "");
    return text;
}

/* --- against rays --------------------------------------------------------------------------------------- */

/* Layers follow each other: none begins behind an empty one, none lies before the last. */
static void check_order(const char *title, const shot *s)
{
    int    holes = 0, turned = 0, inconsistent = 0, at = 0, layer = 0;
    double back = 0;
    for (int k = 0; k < s->layer_count; k++)
        for (int i = 0; i < s->width * s->height; i++) {
            double depth = (double)s->layers[k].depth[i], before = k ? (double)s->layers[k - 1].depth[i] : 0;
            bool   full = !isinf(depth);
            inconsistent += full != (s->layers[k].id[i] != 0) || isnan(depth) ||
                            full != (dvec_length(dvec_from(s->layers[k].normal[i])) > 0.5);
            holes += k && full && isinf(before);
            turned += k && full && !isinf(before) && depth < before;
            if (k && full && (before - depth) / before > back) {
                back = (before - depth) / before;
                at = i;
                layer = k;
            }
        }
    check_at_most("B01", holes, 0, "%s: pixels of a layer behind an empty one", title);
    /* Layers are ordered by window depth; eye depth is written beside it with roundings of its own. */
    if (!check_at_most("B01", back, 1e-6, "%s: how far a layer lies before the last, as a fraction (%d pixels)", title,
                       turned))
        check_note("worst at %d, %d: layer %d has part %d at %.9g, layer %d part %d at %.9g", at % s->width,
                   at / s->width, layer - 1, s->layers[layer - 1].id[at], (double)s->layers[layer - 1].depth[at], layer,
                   s->layers[layer].id[at], (double)s->layers[layer].depth[at]);
    check_at_most("B01", inconsistent, 0, "%s: pixels whose maps do not agree about whether anything is there", title);
}

static void check_score(const char *title, const stack_score *c)
{
    double all = (double)c->right / (double)c->pixels,
           sharp = (double)c->right_sharp / (double)(c->sharp ? c->sharp : 1);
    check_at_least("B01", (double)c->sharp / (double)c->pixels, 0.9, "%s: fraction of pixels whose answer is sure",
                   title);
    if (!check_at_least(
            "B01", sharp, 0.999,
            "%s: fraction of them at which every layer is the surface that the ray finds (of all pixels: %.5f)", title,
            all))
        check_note("first wrong pixel %d, %d in layer %d", c->x, c->y, c->layer);
    if (c->right_sharp < c->sharp)
        check_note("%zu wrong: %zu count, %zu id, %zu depth, %zu normal, %zu holes; first %d, %d in layer %d",
                   c->sharp - c->right_sharp, c->wrong_count, c->wrong_id, c->wrong_depth, c->wrong_normal, c->holes,
                   c->x, c->y, c->layer);
    check_at_most("B01", fabs((double)c->drawn - (double)c->hits) / (double)(c->hits ? c->hits : 1), 0.001,
                  "%s: surfaces skipped or drawn twice, of %zu", title, c->hits);
    check_note("largest errors: depth %.3g, normal %.3g", c->depth_error, c->normal_error);
}

static size_t differing_layers(const shot *a, const shot *b)
{
    size_t count = (size_t)(a->width * a->height), differ = 0;
    int    layers = a->layer_count < b->layer_count ? a->layer_count : b->layer_count;
    for (int k = 0; k < layers; k++)
        for (size_t i = 0; i < count; i++) {
            if (memcmp(&a->layers[k].depth[i], &b->layers[k].depth[i], sizeof(float)) == 0 &&
                a->layers[k].id[i] == b->layers[k].id[i])
                continue;
            if (++differ <= 3)
                check_note("layer %d at %d, %d: part %d at %.9g by %s, part %d at %.9g by %s", k, (int)i % a->width,
                           (int)i / a->width, a->layers[k].id[i], (double)a->layers[k].depth[i], a->layer_producer,
                           b->layers[k].id[i], (double)b->layers[k].depth[i], b->layer_producer);
        }
    return differ;
}

/* Lists may keep normals and colours in less than floats: the largest differences of normals, of edges and shades
 * in levels. */
static void differ_beside(const shot *a, const shot *b, double out[3], size_t *edges)
{
    int layers = a->layer_count < b->layer_count ? a->layer_count : b->layer_count;
    memset(out, 0, 3 * sizeof *out);
    *edges = 0;
    for (int k = 0; k < layers; k++)
        for (int i = 0; i < a->width * a->height; i++) {
            int edge = 0;
            out[0] = fmax(out[0],
                          dvec_length(dvec_sub(dvec_from(a->layers[k].normal[i]), dvec_from(b->layers[k].normal[i]))));
            for (int c = 4 * i; c < 4 * i + 4; c++) {
                edge = abs(a->layers[k].edge[c] - b->layers[k].edge[c]) > edge
                           ? abs(a->layers[k].edge[c] - b->layers[k].edge[c])
                           : edge;
                out[2] = fmax(out[2], abs(a->layers[k].shade[c] - b->layers[k].shade[c]));
            }
            out[1] = fmax(out[1], edge);
            *edges += edge > 1;
        }
}

static void compare_producers(const char *title, const shot *peeled, const shot *listed)
{
    check_that("B01", strcmp(peeled->layer_producer, "peeling") == 0, "%s: made by peeling when asked for (%s)", title,
               peeled->layer_producer);
    if (strcmp(listed->layer_producer, "lists") != 0) {
        check_note("%s: no lists here, drawn by %s", title, listed->layer_producer);
        return;
    }
    check_near("B01", listed->layer_count, peeled->layer_count, 0, "%s: layers by lists and by peeling", title);
    check_at_most("B01", (double)differing_layers(peeled, listed), 0,
                  "%s: values of depth and id that differ between the producers", title);
    double largest[3];
    size_t edges;
    differ_beside(peeled, listed, largest, &edges);
    check_at_most("B01", largest[0], 1e-3, "%s: largest difference of normals", title);
    check_at_most("B01", largest[2], 1, "%s: largest difference of shades, in levels", title);
    check_note("%zu pixels of all layers differ in their edges, by up to %g levels", edges, largest[1]);
    int pictures = 0, worst = 0;
    for (int i = 0; i < 4 * peeled->width * peeled->height; i++) {
        int difference = abs(peeled->picture[i] - listed->picture[i]);
        pictures += difference > 2;
        worst = difference > worst ? difference : worst;
    }
    check_at_most("B01", pictures / (4.0 * peeled->width * peeled->height), 0.001,
                  "%s: fraction of bytes of the picture that differ by more than 2 (at most by %d)", title, worst);
}

/* Without an end, there are as many layers as the deepest pixel has surfaces. */
static void check_end(const char *title, const shot *s, const stack_map *m)
{
    check_that("B03", s->layers_drawn >= (int)m->most_sharp && s->layers_drawn <= (int)m->most,
               "%s: %d layers drawn; the deepest pixel has %zu surfaces (%zu where it is sure)", title, s->layers_drawn,
               m->most, m->most_sharp);
    check_near("B03", s->layer_count, s->layers_drawn, 0, "%s: layers with maps", title);
    check_that("B03", !shot_has_warning(s, "layer-memory"), "%s: nothing was too large", title);
}

static void draw_and_compare(scene_kind kind, uint32_t seed, const shot_view *view)
{
    static const char *const producers[] = {"peeling", "lists"};
    shape                    s = {0};
    shot                     drawn[2] = {{0}, {0}};
    char                     title[64], layers[64];
    bool                     ok = true;
    scene_make(&s, kind, seed);
    tracer   *t = tracer_create(&s);
    stack_map map = {0};
    for (int p = 0; p < (view->es ? 1 : 2) && ok; p++) {
        snprintf(layers, sizeof layers, "\"count\":0,\"producer\":\"%s\"", view->es ? "auto" : producers[p]);
        snprintf(title, sizeof title, "%s %u%s%s, %s", scene_names[kind], seed, view->orthographic ? " parallel" : "",
                 view->es ? " ES" : "", view->es ? "auto" : producers[p]);
        ok = shot_of_shape(&drawn[p], &s, "layers.glb", layered_look(layers, edge_lines), NULL, view);
        if (!ok)
            break;
        if (p == 0)
            stack_map_make(&map, t, &drawn[0]);
        stack_score score = stack_compare(&map, t, &drawn[p], 0);
        check_score(title, &score);
        check_order(title, &drawn[p]);
        check_end(title, &drawn[p], &map);
    }
    if (ok && !view->es)
        compare_producers(title, &drawn[0], &drawn[1]);
    stack_map_release(&map);
    tracer_destroy(t);
    shot_release(&drawn[0]);
    shot_release(&drawn[1]);
    shape_release(&s);
}

static void against_rays(void)
{
    for (int kind = 0; kind < SCENE_KINDS; kind++)
        for (uint32_t seed = 1; seed <= 3; seed++)
            draw_and_compare((scene_kind)kind, seed, &views[((uint32_t)kind + seed) % 3]);
}

static void dialects(void)
{
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        shot_view view = views[kind % 2];
        view.es = true;
        draw_and_compare((scene_kind)kind, 7, &view);
    }
}

/* --- what coincides ------------------------------------------------------------------------------------- */

static const shot_view straight = {.width = 96,
                                   .height = 96,
                                   .eye = {0.013, 0.007, 8},
                                   .target = {0.013, 0.007, 0},
                                   .up = {0, 1, 0},
                                   .orthographic = true};

static void coincident_case(const char *title, const shape *s, const char *producer, int layers, const int *ids,
                            const int *facing)
{
    shot drawing;
    char text[64];
    int  wrong = 0, judged = 0, wrong_facing = 0;
    snprintf(text, sizeof text, "\"count\":0,\"producer\":\"%s\"", producer);
    if (!shot_of_shape(&drawing, s, "coincident.glb", layered_look(text, NULL), NULL, &straight))
        return;
    check_near("B01", drawing.layers_drawn, layers, 0, "%s: layers by %s", title, producer);
    for (int i = 0; i < 96 * 96 && drawing.layer_count == layers; i++) {
        if (isinf(drawing.layers[0].depth[i]))
            continue;
        judged++;
        for (int k = 0; k < layers; k++) {
            wrong += drawing.layers[k].id[i] != ids[k];
            wrong_facing += (double)drawing.layers[k].normal[i][2] * facing[k] < 0.99;
        }
    }
    check_at_least("B01", judged, 500, "%s: pixels judged", title);
    check_at_most("B01", wrong, 0, "%s: wrong parts", title);
    check_at_most("B01", wrong_facing, 0, "%s: surfaces that face the wrong way", title);
    shot_release(&drawing);
}

/* Planes across the view have one depth to the last bit, so that the order by part and facing is the whole answer. */
static void what_coincides(void)
{
    static const char *const producers[] = {"peeling", "lists"};
    for (int p = 0; p < 2; p++) {
        shape s = {0};
        shape_quad(&s, "sheet", 1, 0);
        coincident_case("one sheet", &s, producers[p], 1, (int[]){1}, (int[]){1});
        scene_double(&s, false);
        coincident_case("a sheet that lies there twice", &s, producers[p], 1, (int[]){1}, (int[]){1});
        shape_release(&s);
        shape_quad(&s, "sheet", 1, 0);
        scene_double(&s, true);
        coincident_case("a sheet with two sides", &s, producers[p], 2, (int[]){1, 1}, (int[]){1, -1});
        scene_copy(&s, 0, "again");
        coincident_case("two of them", &s, producers[p], 4, (int[]){1, 1, 2, 2}, (int[]){1, -1, 1, -1});
        scene_copy(&s, 1, "a third");
        coincident_case("three of them", &s, producers[p], 6, (int[]){1, 1, 2, 2, 3, 3}, (int[]){1, -1, 1, -1, 1, -1});
        shape_release(&s);
        shape_box(&s, "behind", dvec_of(-1, -1, -1), dvec_of(1, 1, 0));
        shape_box(&s, "before", dvec_of(-1, -1, 0), dvec_of(1, 1, 1));
        coincident_case("boxes that share a face", &s, producers[p], 4, (int[]){2, 1, 2, 1}, (int[]){1, 1, -1, -1});
        shape_release(&s);
    }
}

/* Pixels at which the second and the third layer coincide, and no other does, and at how many of these the parts are
 * not these two. */
static void count_specks(const shot *s, const int parts[2], int *judged, int *specks)
{
    for (int i = 0; i < s->width * s->height && s->layer_count > 2; i++) {
        double first = s->layers[0].depth[i], second = s->layers[1].depth[i], third = s->layers[2].depth[i];
        if (isinf(second) || isinf(third) || !(fabs(third - second) < 3e-5) || second - first < 1e-3)
            continue;
        ++*judged;
        *specks += s->layers[1].id[i] != parts[0] || s->layers[2].id[i] != parts[1];
    }
}

/* A box stands on a floor whose triangles are others, so that rounding puts now one, now the other in front. Lists know
 * both as one place: the order is that of the parts at every pixel, though they be the last that are wanted. */
static void what_stands_on_another(void)
{
    static const char *const counts[] = {"5", "3"};
    for (int c = 0; c < 2; c++) {
        shape s = {0};
        int   judged = 0, specks = 0;
        char  layers[80];
        snprintf(layers, sizeof layers, "\"count\":%s,\"producer\":\"lists\",\"settle_ties\":true", counts[c]);
        shape_box(&s, "floor", dvec_of(-2.9, -3.1, -0.2), dvec_of(3.3, 2.7, 0));
        shape_box(&s, "block", dvec_of(-0.9, -0.7, 0), dvec_of(1.1, 0.8, 0.5));
        for (int angle = 0; angle < 12; angle++) {
            double    turn = 0.137 + 0.5236 * angle;
            shot_view view = {.width = 160,
                              .height = 160,
                              .eye = {5 * cos(turn), 5 * sin(turn), 4.3},
                              .target = {0, 0, 0},
                              .up = {0, 0, 1},
                              .orthographic = angle % 2 == 1};
            shot      drawing;
            if (!shot_of_shape(&drawing, &s, "stands.glb", layered_look(layers, NULL), NULL, &view))
                break;
            count_specks(&drawing, (const int[]){1, 2}, &judged, &specks);
            shot_release(&drawing);
        }
        check_at_least("B01", judged, 10000, "a box on a floor, %s layers: pixels judged", counts[c]);
        check_at_most("B01", specks, 0, "a box on a floor: specks");
        shape_release(&s);
    }
}

/* The same of three: of a pad in the floor, too. */
static void three_in_one_plane(void)
{
    shape s = {0};
    int   judged = 0, specks = 0;
    shape_box(&s, "floor", dvec_of(-2.9, -3.1, -0.4), dvec_of(3.3, 2.7, 0));
    shape_box(&s, "block", dvec_of(-0.9, -0.7, 0), dvec_of(1.1, 0.8, 0.5));
    shape_box(&s, "pad", dvec_of(-1.7, -1.5, -0.2), dvec_of(1.6, 1.9, 0));
    for (int angle = 0; angle < 6; angle++) {
        double    turn = 0.137 + 1.0472 * angle;
        shot_view view = {.width = 160,
                          .height = 160,
                          .eye = {5 * cos(turn), 5 * sin(turn), 4.3},
                          .up = {0, 0, 1},
                          .orthographic = angle % 2 == 1};
        shot      drawing;
        if (!shot_of_shape(&drawing, &s, "pad.glb",
                           layered_look("\"count\":8,\"producer\":\"lists\",\"settle_ties\":true", NULL), NULL, &view))
            break;
        for (int i = 0; i < 160 * 160 && drawing.layer_count > 3; i++) {
            const double first = drawing.layers[1].depth[i], last = drawing.layers[3].depth[i];
            if (isinf(last) || !(fabs(last - first) < 3e-5) || first - (double)drawing.layers[0].depth[i] < 1e-3)
                continue;
            judged++;
            for (int k = 0; k < 3; k++)
                specks += drawing.layers[1 + k].id[i] != k + 1;
        }
        shot_release(&drawing);
    }
    check_at_least("B01", judged, 5000, "three parts in one plane: pixels judged");
    check_at_most("B01", specks, 0, "three parts in one plane: specks");
    shape_release(&s);
}

/* What coincides where one round of sorting ends and the next begins comes once all the same. */
static void rounds_repeat_nothing(void)
{
    shape s = {0};
    int   judged = 0, wrong = 0;
    shape_box(&s, "floor", dvec_of(-2.9, -3.1, -0.4), dvec_of(3.3, 2.7, 0));
    shape_box(&s, "pad", dvec_of(-1.7, -1.5, -0.2), dvec_of(1.6, 1.9, 0));
    for (int k = 0; k < 3; k++)
        shape_box(&s, "plate", dvec_of(-4, -4, 0.5 + 0.4 * k), dvec_of(4, 4, 0.6 + 0.4 * k));
    for (int angle = 0; angle < 6; angle++) {
        double    turn = 0.137 + 1.0472 * angle;
        shot_view view = {.width = 120, .height = 120, .eye = {3 * cos(turn), 3 * sin(turn), 6.3}, .up = {0, 0, 1}};
        shot      drawing;
        if (!shot_of_shape(&drawing, &s, "rounds.glb",
                           layered_look("\"count\":12,\"producer\":\"lists\",\"settle_ties\":true", NULL), NULL, &view))
            break;
        for (int i = 0; i < 120 * 120 && drawing.layer_count > 9; i++) {
            int    of_part[6] = {0};
            double sixth = drawing.layers[6].depth[i], seventh = drawing.layers[7].depth[i];
            if (isinf(sixth) || isinf(seventh) || !(fabs(seventh - sixth) < 3e-5) || drawing.layers[5].id[i] != 3)
                continue;
            for (int k = 0; k < drawing.layer_count; k++)
                of_part[drawing.layers[k].id[i]] += !isinf(drawing.layers[k].depth[i]);
            judged++;
            wrong += of_part[1] != 2 || of_part[2] != 2;
        }
        shot_release(&drawing);
    }
    check_at_least("B01", judged, 3000, "ten layers in two rounds: pixels judged");
    check_at_most("B01", wrong, 0, "ten layers in two rounds: pixels that have one twice, or lack one");
    shape_release(&s);
}

/* --- where it ends -------------------------------------------------------------------------------------- */

static int first_differing(const shot *few, const shot *all)
{
    size_t count = (size_t)(few->width * few->height);
    for (int k = 0; k < few->layer_count; k++)
        if (k >= all->layer_count || memcmp(few->layers[k].depth, all->layers[k].depth, count * sizeof(float)) != 0 ||
            memcmp(few->layers[k].id, all->layers[k].id, count * sizeof(uint16_t)) != 0)
            return k;
    return -1;
}

static void counts(void)
{
    for (int producer = 0; producer < 2; producer++) {
        const char *name = producer ? "lists" : "peeling";
        shape       s = {0};
        shot        all, few;
        char        layers[64];
        scene_make(&s, SCENE_CROSSING, 4);
        snprintf(layers, sizeof layers, "\"count\":0,\"producer\":\"%s\"", name);
        if (shot_of_shape(&all, &s, "counts.glb", layered_look(layers, NULL), NULL, &views[0])) {
            for (int wanted = 1; wanted <= all.layers_drawn + 1; wanted += wanted < 3 ? 1
                                                                           : all.layers_drawn - 3 > 2
                                                                               ? (all.layers_drawn - 2) / 2
                                                                               : 1) {
                snprintf(layers, sizeof layers, "\"count\":%d,\"producer\":\"%s\"", wanted, name);
                if (!shot_of_shape(&few, &s, "counts.glb", layered_look(layers, NULL), NULL, &views[0]))
                    continue;
                check_near("B03", few.layers_drawn, wanted < all.layers_drawn ? wanted : all.layers_drawn, 0,
                           "layers with count %d of %d, %s", wanted, all.layers_drawn, name);
                check_near("B03", first_differing(&few, &all), -1, 0,
                           "  first layer that is not the one without a limit");
                shot_release(&few);
            }
        }
        shot_release(&all);
        shape_release(&s);
    }
}

static double mean_difference(const shot *a, const shot *b, double *fraction)
{
    double sum = 0;
    int    count = a->width * a->height, differ = 0;
    for (int i = 0; i < count; i++) {
        double worst = 0;
        for (int k = 0; k < 3; k++)
            worst = fmax(worst, fabs(picture_linear(a->picture[4 * i + k]) - picture_linear(b->picture[4 * i + k])));
        differ += worst > 0;
        sum += worst;
    }
    *fraction = (double)differ / count;
    return sum / count;
}

/* The layers that a fraction leaves: up to and with the first that covers less of the picture. 0: too close to
 * call. */
static int layers_of_fraction(const stack_map *m, double fraction)
{
    double pixels = (double)m->width * m->height;
    for (size_t k = 0; k < m->most; k++) {
        double covered = (double)stack_covered(m, k) / pixels;
        if (fabs(covered - fraction) < 0.002)
            return 0;
        if (covered < fraction)
            return (int)k + 1;
    }
    return (int)m->most;
}

static void fractions(void)
{
    static const double tried[] = {0.01, 0.03, 0.06, 0.1, 0.15, 0.2, 0.3, 0.5, 1};
    for (int kind = 0; kind < 3; kind++) {
        shape s = {0};
        shot  all, some;
        int   judged = 0;
        scene_make(&s, (scene_kind)kind, 11);
        tracer   *t = tracer_create(&s);
        stack_map map = {0};
        if (shot_of_shape(
                &all, &s, "fraction.glb",
                layered_look(kind % 2 ? "\"count\":0,\"producer\":\"lists\"" : "\"count\":0,\"producer\":\"peeling\"",
                             NULL),
                NULL, &views[kind])) {
            stack_map_make(&map, t, &all);
            for (size_t f = 0; f < sizeof tried / sizeof *tried; f++) {
                char   layers[80];
                int    wanted = layers_of_fraction(&map, tried[f]);
                double fraction;
                snprintf(layers, sizeof layers, "\"count\":0,\"producer\":\"%s\",\"fraction\":%g",
                         kind % 2 ? "lists" : "peeling", tried[f]);
                if (!wanted ||
                    !shot_of_shape(&some, &s, "fraction.glb", layered_look(layers, NULL), NULL, &views[kind]))
                    continue;
                judged++;
                check_near("B05", some.layers_drawn, wanted, 0, "%s, fraction %g: layers drawn of %zu",
                           scene_names[kind], tried[f], map.most);
                double mean = mean_difference(&all, &some, &fraction);
                check_at_most("B05", fraction, tried[f],
                              "  fraction of pixels that differ from the picture of all layers");
                check_at_most("B05", mean, tried[f] * pow(0.5, some.layers_drawn) + 0.004,
                              "  mean difference of linear colour");
                shot_release(&some);
            }
        }
        check_at_least("B05", judged, 4, "%s: fractions whose answer is sure", scene_names[kind]);
        stack_map_release(&map);
        tracer_destroy(t);
        shot_release(&all);
        shape_release(&s);
    }
}

/* --- depth mask ----------------------------------------------------------------------------------------- */

/* Of the mask's pixels, the fraction at which layer k − 1 does not hide it. */
static double uncovered_by(const trace_map *mask, const stack_map *rest, size_t k)
{
    size_t own = 0, open = 0;
    for (int i = 0; i < mask->width * mask->height; i++) {
        if (isinf(mask->depth[i]))
            continue;
        own++;
        open += stack_count(rest, i) < k || mask->depth[i] <= stack_at(rest, i)[k - 1].depth;
    }
    return own ? (double)open / (double)own : 1;
}

/* 0 when a few pixels could change the answer. */
static int layers_to_uncover(const trace_map *mask, const stack_map *rest, double fraction)
{
    for (size_t k = 1;; k++) {
        double open = uncovered_by(mask, rest, k);
        if (fabs(open - fraction) < 0.004)
            return 0;
        if (open >= fraction)
            return (int)(k < rest->most ? k : rest->most);
    }
}

static void uncover(scene_kind kind, uint32_t seed, const char *prefix, const shot_view *view, int *judged)
{
    static const double fractions[] = {0.2, 0.4, 0.6, 0.7, 0.8, 0.9, 0.95, 0.99};
    shape               s = {0};
    shot                drawing;
    scene_make(&s, kind, seed);
    tracer   *rest = tracer_of_parts(&s, prefix, false), *named = tracer_of_parts(&s, prefix, true);
    stack_map map = {0};
    trace_map mask = {0};
    int       last = 0;
    for (size_t i = 0; i < sizeof fractions / sizeof *fractions; i++) {
        char layers[128], title[64];
        int  wanted = map.first ? layers_to_uncover(&mask, &map, fractions[i]) : -1;
        if (wanted == 0 || wanted == last)
            continue;
        snprintf(layers, sizeof layers, "\"count\":0,\"producer\":\"%s\",\"focus\":\"%s*\",\"focus_fraction\":%g",
                 i % 2 ? "lists" : "peeling", prefix, fractions[i]);
        snprintf(title, sizeof title, "%s %u, %s to %g", scene_names[kind], seed, prefix, fractions[i]);
        if (!shot_of_shape(&drawing, &s, "mask.glb", layered_look(layers, NULL), NULL, view))
            break;
        if (!map.first) {
            stack_map_make(&map, rest, &drawing);
            trace_map_make(&mask, named, &drawing);
            wanted = layers_to_uncover(&mask, &map, fractions[i]);
        }
        if (wanted > 0) {
            (*judged)++;
            check_near("B09", drawing.layers_drawn, wanted, 0, "%s: layers drawn; they uncover %.3f, one less %.3f",
                       title, uncovered_by(&mask, &map, (size_t)wanted),
                       wanted > 1 ? uncovered_by(&mask, &map, (size_t)wanted - 1) : 0);
            stack_score score = stack_compare(&map, rest, &drawing, (size_t)wanted);
            check_at_least("B09", (double)score.right_sharp / (double)score.sharp, 0.999,
                           "%s: fraction of pixels with the right layers, without the focus", title);
            last = wanted;
        }
        shot_release(&drawing);
    }
    stack_map_release(&map);
    trace_map_release(&mask);
    tracer_destroy(rest);
    tracer_destroy(named);
    shape_release(&s);
}

static void masks(void)
{
    int judged = 0;
    uncover(SCENE_CLOSED, 21, "closed1", &views[0], &judged);
    uncover(SCENE_CLOSED, 22, "closed0", &views[1], &judged);
    uncover(SCENE_CLOSED, 23, "closed2", &views[2], &judged);
    uncover(SCENE_OPEN, 24, "inner", &views[0], &judged);
    uncover(SCENE_CROSSING, 25, "cross6", &views[1], &judged);
    uncover(SCENE_CROSSING, 26, "cross", &views[2], &judged); /* everything: nothing is left to peel */
    check_at_least("B09", judged, 8, "masks whose answer is sure");
}

/* --- edges of each layer -------------------------------------------------------------------------------- */

typedef twin_value (*twin_function)(const twin_map *m, int x, int y);

static twin_value four_tap(const twin_map *m, int x, int y)
{
    return twin_four_tap(m, x, y, 1, true);
}

static twin_value denormal(const twin_map *m, int x, int y)
{
    return twin_denormal(m, x, y, 0, false);
}

/* Each layer's edge map is what the operator makes of that layer's own maps. */
static void edges_against_twins(void)
{
    static const struct {
        const char   *lines;
        twin_function twin;
        double        levels;
    } cases[] = {{"{\"operator\":\"four-tap\",\"width\":2}", four_tap, 1.5},
                 {"{\"operator\":\"sobel\",\"width\":2,\"taps\":\"five\"}", twin_sobel_nine, 1.5},
                 {"{\"operator\":\"saito\",\"width\":2}", twin_saito, 1.5},
                 {"{\"operator\":\"denormal\",\"width\":2}", denormal, 4.5}};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++)
        for (int producer = 0; producer < 2; producer++) {
            shape  s = {0};
            shot   drawing;
            double worst = 0;
            int    off = 0, ink = 0, at[3] = {0, 0, 0};
            scene_make(&s, c % 2 ? SCENE_OPEN : SCENE_CROSSING, 31 + (uint32_t)c);
            if (shot_of_shape(&drawing, &s, "twins.glb",
                              layered_look(producer ? "\"count\":5,\"producer\":\"lists\""
                                                    : "\"count\":5,\"producer\":\"peeling\"",
                                           cases[c].lines),
                              NULL, &views[c % 3]))
                for (int k = 0; k < drawing.layer_count; k++) {
                    shot     layer = drawing;
                    twin_map map;
                    layer.depth = drawing.layers[k].depth;
                    layer.normal = drawing.layers[k].normal;
                    twin_map_make(&map, &layer);
                    for (int i = 0; i < map.width * map.height; i++) {
                        twin_value v = cases[c].twin(&map, i % map.width, i / map.width);
                        double     wanted[2] = {twin_byte(v.profile), twin_byte(v.inner)};
                        ink += wanted[0] < 128 || wanted[1] < 128;
                        for (int e = 0; e < 2 && !v.doubtful; e++) {
                            double error = fabs(drawing.layers[k].edge[4 * i + e] - wanted[e]);
                            off += error > cases[c].levels;
                            if (error > worst)
                                memcpy(at, (int[]){i % map.width, i / map.width, k}, sizeof at);
                            worst = fmax(worst, error);
                        }
                    }
                    twin_map_release(&map);
                }
            check_at_least("B02", drawing.layer_count, 5, "%s: layers", cases[c].lines);
            check_at_least("B02", ink, 500, "  pixels of ink in them");
            if (!check_at_most("B02", worst, cases[c].levels,
                               "  levels between the layers' edge maps and the operator's twin on their own maps, %s",
                               producer ? "lists" : "peeling"))
                check_note("worst at %d, %d in layer %d; %d values are off", at[0], at[1], at[2], off);
            shot_release(&drawing);
            shape_release(&s);
        }
}

/* Plate number k of a staple that grows towards the viewer: each layer is a plate, and nothing else. */
static void add_plate(shape *s, int k)
{
    static const double half[] = {1.2, 0.9, 0.65, 0.4}, depth[] = {1.2, 0.4, -0.5, -1.3};
    char                name[24];
    snprintf(name, sizeof name, "plate%d", k);
    if (k % 2) {
        shape_terrain(s, name, half[k], 0.3, 32, 40 + (uint32_t)k);
        shape_place(s, dvec_of(1, 0.04 * k, 0.1), 90, dvec_of(0.02 * k, 0, depth[k]));
    } else {
        shape_quad(s, name, half[k], 0);
        shape_place(s, dvec_of(1, 1 - k, 0.3), 11, dvec_of(0, 0.03 * k, depth[k]));
    }
}

static size_t differing_edges(const uint8_t *a, const uint8_t *b, int count)
{
    size_t differ = 0;
    for (int i = 0; i < count; i++) {
        int worst = 0;
        for (int k = 0; k < 4; k++)
            worst = abs(a[4 * i + k] - b[4 * i + k]) > worst ? abs(a[4 * i + k] - b[4 * i + k]) : worst;
        differ += worst > 1;
    }
    return differ;
}

static const char *const layer_lines[] = {"{\"operator\":\"discontinuity\"}", "{\"operator\":\"four-tap\",\"gain\":20}",
                                          "{\"operator\":\"sobel\",\"gain\":5}", "{\"operator\":\"saito-normalised\"}",
                                          "{\"operator\":\"id\"}"};

/* A layer against the first one of a model that is only this layer: of models that are not seen through, edges of
 * meshes tell more exactly where lines are. */
static void against_own_model(const char *title, const shot *all, int k, const shape *alone, const char *lines,
                              const shot_view *view)
{
    shot single;
    int  ink = 0, count = all->width * all->height;
    if (!shot_of_shape(&single, alone, "alone.glb", layered_look("\"count\":0", lines), NULL, view))
        return;
    check_near("B02", single.far_depth - single.near_depth, all->far_depth - all->near_depth, 1e-9,
               "%s: the same depth range", title);
    for (int i = 0; i < count; i++)
        ink += single.layers[0].edge[4 * i + 2] < 128 || single.layers[0].edge[4 * i + 3] < 128;
    check_at_least("B02", ink, 100, "%s: ink in the drawing of layer %d alone, %s", title, k, lines);
    if (k < all->layer_count)
        check_at_most("B02", (double)differing_edges(single.layers[0].edge, all->layers[k].edge, count), 0,
                      "  pixels of the layer's edge map that differ from it");
    shot_release(&single);
}

static void edges_of_own_models(void)
{
    for (size_t l = 0; l < sizeof layer_lines / sizeof *layer_lines; l++) {
        const shot_view view = {.width = 144, .height = 144, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = l % 2};
        shape           s = {0};
        shot            all;
        for (int k = 0; k < 4; k++)
            add_plate(&s, k);
        scene_anchor(&s, "anchor", dvec_of(-7, -7, -2), dvec_of(7, 7, 2));
        if (shot_of_shape(&all, &s, "plates.glb", layered_look("\"count\":0", layer_lines[l]), NULL, &view)) {
            check_near("B02", all.layers_drawn, 4, 0, "layers of a staple of four plates");
            for (int k = 0; k < 4; k++) {
                shape alone = {0};
                add_plate(&alone, k);
                scene_anchor(&alone, "anchor", dvec_of(-7, -7, -2), dvec_of(7, 7, 2));
                against_own_model("plates", &all, k, &alone, layer_lines[l], &view);
                shape_release(&alone);
            }
        }
        shot_release(&all);
        shape_release(&s);
    }
}

static void nested_boxes(shape *s)
{
    shape_box(s, "outer", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    shape_box(s, "inner", dvec_of(-0.4, -0.3, -0.5), dvec_of(0.5, 0.4, 0.3));
    shape_place(s, dvec_of(1, 2, 1), 25, dvec_of(0, 0, 0));
}

/* Behind the front of the outer box lie its back and the whole of the inner one. */
static void edges_of_nested_boxes(void)
{
    for (size_t l = 0; l < sizeof layer_lines / sizeof *layer_lines; l++) {
        shape s = {0}, back = {0};
        shot  all;
        nested_boxes(&s);
        nested_boxes(&back);
        uint32_t *indices = back.parts[0].indices;
        for (uint32_t f = 0; f < 3; f++) /* every other face is at a low end, and so on the far side */
            memmove(&indices[6 * f], &indices[12 * f], 6 * sizeof *indices);
        back.parts[0].index_count = 18;
        if (shot_of_shape(&all, &s, "nested.glb", layered_look("\"count\":0", layer_lines[l]), NULL, &views[0])) {
            check_near("B02", all.layers_drawn, 4, 0, "layers of a box in a box");
            against_own_model("nested boxes", &all, 0, &s, layer_lines[l], &views[0]);
            against_own_model("nested boxes", &all, 1, &back, layer_lines[l], &views[0]);
        }
        shot_release(&all);
        shape_release(&s);
        shape_release(&back);
    }
}

/* --- repeated edges ------------------------------------------------------------------------------------- */

static bool layer_ink_near(const shot *s, int layer, double x, double y, int radius)
{
    for (int j = (int)y - radius; j <= (int)y + radius; j++)
        for (int i = (int)x - radius; i <= (int)x + radius; i++) {
            if (i < 0 || j < 0 || i >= s->width || j >= s->height)
                continue;
            const uint8_t *e = &s->layers[layer].edge[4 * (j * s->width + i)];
            if (e[2] < 128 || e[3] < 128)
                return true;
        }
    return false;
}

/* Along an edge that two layers share: both have it, and where one has ink the other has some within a pixel. */
static void check_repeated(const char *title, const shot *s, const dvec (*edges)[2], int count)
{
    int samples = 0, found[2] = {0, 0}, ink = 0, apart = 0;
    for (int e = 0; e < count; e++)
        for (int k = 0; k <= 100; k++) {
            dvec p = shot_project(s, dvec_mix(edges[e][0], edges[e][1], 0.2 + 0.6 * k / 100));
            samples++;
            for (int layer = 0; layer < 2; layer++) {
                found[layer] += layer_ink_near(s, layer, p.x, p.y, 1);
                for (int n = 0; n < 25; n++) {
                    double x = floor(p.x) + n % 5 - 2, y = floor(p.y) + n / 5 - 2;
                    if (!layer_ink_near(s, layer, x, y, 0))
                        continue;
                    ink++;
                    apart += !layer_ink_near(s, 1 - layer, x, y, 1);
                }
            }
        }
    check_at_least("B13", (double)found[0] / samples, 1, "%s: fraction of the edge with a line in layer 0", title);
    check_at_least("B13", (double)found[1] / samples, 1, "%s: and in layer 1", title);
    check_at_most("B13", apart, 0, "%s: of %d pixels of ink, those farther than a pixel from ink of the other layer",
                  title, ink);
}

static void repeated_edges(void)
{
    static const dvec outline[6][2] = {{{1, 1, -1}, {1, -1, -1}}, {{1, -1, -1}, {1, -1, 1}}, {{1, -1, 1}, {-1, -1, 1}},
                                       {{-1, -1, 1}, {-1, 1, 1}}, {{-1, 1, 1}, {-1, 1, -1}}, {{-1, 1, -1}, {1, 1, -1}}};
    /* On its own, four-tap has little ink for a step between far surfaces and nothing. */
    static const char *const lines[] = {"{\"operator\":\"discontinuity\"}", "{\"operator\":\"four-tap\"}"};
    static const char *const plate_lines[] = {"{\"operator\":\"discontinuity\"}",
                                              "{\"operator\":\"four-tap\",\"gain\":20}"};
    for (int l = 0; l < 2; l++)
        for (int v = 0; v < 2; v++) {
            shape     s = {0};
            shot      drawing;
            shot_view view = {.width = 200, .height = 160, .eye = {4, 3, 5}, .up = {0, 1, 0}, .orthographic = v};
            shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
            if (shot_of_shape(&drawing, &s, "box.glb", layered_look("\"count\":0", lines[l]), NULL, &view)) {
                check_near("B13", drawing.layer_count, 2, 0, "layers of a box");
                if (drawing.layer_count == 2)
                    check_repeated("two faces that share an edge, one before the other", &drawing, outline, 6);
            }
            shot_release(&drawing);
            shape_release(&s);
            shape_quad(&s, "large", 1.3, 0);
            shape_place(&s, dvec_of(0, 1, 0.2), 30, dvec_of(0, 0, -0.5));
            shape_quad(&s, "small", 0.5, 0);
            shape_place(&s, dvec_of(1, 0.5, 0.3), 20, dvec_of(0.2, 0.1, 0.9));
            dvec rim[4][2];
            for (uint32_t k = 0; k < 4; k++) {
                rim[k][0] = shape_point(&s.parts[1], k);
                rim[k][1] = shape_point(&s.parts[1], (k + 1) % 4);
            }
            view.eye = dvec_of(0.5, 0.4, 8);
            if (shot_of_shape(&drawing, &s, "quads.glb", layered_look("\"count\":0", plate_lines[l]), NULL, &view)) {
                check_near("B13", drawing.layer_count, 2, 0, "layers of a plate before a plate");
                if (drawing.layer_count == 2)
                    check_repeated("a plate that partly hides another", &drawing, (const dvec(*)[2])rim, 4);
            }
            shot_release(&drawing);
            shape_release(&s);
        }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"rays", against_rays},
        {"dialects", dialects},
        {"coincident", what_coincides},
        {"stands", what_stands_on_another},
        {"rounds", rounds_repeat_nothing},
        {"three", three_in_one_plane},
        {"counts", counts},
        {"fractions", fractions},
        {"masks", masks},
        {"twins", edges_against_twins},
        {"own", edges_of_own_models},
        {"nested", edges_of_nested_boxes},
        {"repeated", repeated_edges},
    };
    int status = check_main(argc, argv, "layers", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
