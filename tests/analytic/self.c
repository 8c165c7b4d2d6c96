/* The references among themselves: each is held against something simpler, so that a wrong reference is not taken
 * for truth. */
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "feature.h"
#include "scenes.h"
#include "stack.h"
#include "twin.h"

static const double pi = 3.14159265358979323846;

static shot_view iso(int size)
{
    return (shot_view){.width = size, .height = size, .eye = {4, 3, 5}, .target = {0, 0, 0}, .up = {0, 1, 0}};
}

static double volume_of(const shape *s)
{
    tracer               *t = tracer_create(s);
    size_t                count;
    const trace_triangle *f = tracer_triangles(t, &count);
    double                volume = 0;
    for (size_t i = 0; i < count; i++)
        volume += dvec_dot(f[i].p[0], dvec_cross(f[i].p[1], f[i].p[2])) / 6;
    tracer_destroy(t);
    return volume;
}

static void shapes_are_solid(void)
{
    const double edges[] = {0, 1, 2, 3}, heights[] = {0.5, 1.5, 1};
    shape        s = {0};
    shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    check_near("self", volume_of(&s), 8, 1e-9, "volume of the box");
    shape_release(&s);
    shape_steps(&s, "steps", edges, heights, 3, 2);
    check_near("self", volume_of(&s), 6, 1e-9, "volume of the stepped block");
    shape_release(&s);
    shape_sphere(&s, "sphere", dvec_of(0, 0, 0), 1, 64, 128, true);
    check_near("self", volume_of(&s), 4 * pi / 3, 0.01, "volume of the sphere");
    shape_release(&s);
    shape_torus(&s, "torus", 1, 0.4, 96, 48);
    check_near("self", volume_of(&s), 2 * pi * pi * 0.16, 0.02, "volume of the torus");
    shape_release(&s);
    shape_sphere(&s, "200", dvec_of(0, 0, 0), 1, 11, 10, false);
    check_near("self", s.parts[0].index_count / 3, 200, 0, "faces of the coarse sphere");
    shape_release(&s);
}

static void caster_sees_a_sphere(void)
{
    shape     s = {0};
    shot      view;
    shot_view how = iso(96);
    shape_sphere(&s, "sphere", dvec_of(0, 0, 0), 1, 256, 512, true);
    tracer   *t = tracer_create(&s);
    trace_map map;
    double    worst = 0, worst_normal = 0, eye = sqrt(50.0);
    int       wrong = 0;
    shot_blank(&view, &how, eye - 1, eye + 1);
    trace_map_make(&map, t, &view);
    for (int i = 0; i < 96 * 96; i++) {
        dvec origin, direction;
        shot_ray(&view, i % 96 + 0.5, i / 96 + 0.5, &origin, &direction);
        double b = dvec_dot(origin, direction), a = dvec_dot(direction, direction), c = dvec_dot(origin, origin) - 1;
        double root = b * b - a * c, t0 = (-b - sqrt(fmax(root, 0))) / a;
        wrong += isinf(map.depth[i]) != (root < 0);
        if (root <= 0.02 || isinf(map.depth[i]))
            continue;
        dvec p = dvec_add(origin, dvec_scale(direction, t0));
        worst = fmax(worst, fabs(map.depth[i] + shot_to_eye(&view, p, 1).z));
        worst_normal = fmax(worst_normal, dvec_length(dvec_sub(shot_to_eye(&view, p, 0), map.normal[i])));
    }
    check_at_most("self", wrong, 4, "pixels that see a sphere and should not, or the other way round");
    check_at_most("self", worst, 2e-3, "depth of a sphere against the closed form");
    check_at_most("self", worst_normal, 5e-3, "normal of a sphere against the closed form");
    trace_map_release(&map);
    shot_release(&view);
    tracer_destroy(t);
    shape_release(&s);
}

/* The tree against a plain loop over all triangles. */
static void caster_equals_brute_force(void)
{
    shape s = {0};
    shape_torus(&s, "torus", 1, 0.4, 40, 20);
    shape_box(&s, "box", dvec_of(-0.5, -0.5, -0.5), dvec_of(0.5, 0.6, 0.5));
    shape_place(&s, dvec_of(1, 2, 3), 33, dvec_of(0.3, 0.2, 0.1));
    tracer               *t = tracer_create(&s);
    shot                  view;
    shot_view             how = iso(48);
    int                   differ = 0;
    size_t                count;
    const trace_triangle *f = tracer_triangles(t, &count);
    shot_blank(&view, &how, 5, 9);
    for (int i = 0; i < 48 * 48; i++) {
        dvec      origin, direction;
        trace_hit hit = {.t = INFINITY};
        double    best = INFINITY;
        shot_ray(&view, i % 48 + 0.5, i / 48 + 0.5, &origin, &direction);
        for (size_t k = 0; k < count; k++) {
            double d = dvec_dot(f[k].flat, direction), at = dvec_dot(f[k].flat, dvec_sub(f[k].p[0], origin)) / d;
            dvec   p = dvec_add(origin, dvec_scale(direction, at));
            bool   inside = true;
            for (int c = 0; c < 3; c++)
                inside = inside && dvec_dot(f[k].flat, dvec_cross(dvec_sub(f[k].p[(c + 1) % 3], f[k].p[c]),
                                                                  dvec_sub(p, f[k].p[c]))) >= 0;
            if (inside && at > 0 && at < best)
                best = at;
        }
        bool found = tracer_hit(t, origin, direction, 0, INFINITY, NULL, &hit);
        differ += found != !isinf(best) || (found && fabs(hit.t - best) > 1e-9);
    }
    check_at_most("self", differ, 0, "rays on which the tree and a plain loop differ");
    shot_release(&view);
    tracer_destroy(t);
    shape_release(&s);
}

static feature_lines lines_of(const shape *s, const shot_view *how, shot *view)
{
    feature_lines lines;
    tracer       *t = tracer_create(s);
    shot_blank(view, how, 1, 20);
    feature_find(&lines, s, t, view, 45);
    tracer_destroy(t);
    return lines;
}

static void cube_has_nine_edges(void)
{
    shape     s = {0};
    shot      view;
    shot_view how = iso(256);
    shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    for (int parallel = 0; parallel < 2; parallel++) {
        how.orthographic = parallel;
        feature_lines f = lines_of(&s, &how, &view);
        double        length = 0;
        for (size_t i = 0; i < f.edge_count; i++) {
            dvec a = shot_project(&view, f.edges[i].a), b = shot_project(&view, f.edges[i].b);
            length += f.edges[i].kind == FEATURE_SILHOUETTE ? hypot(a.x - b.x, a.y - b.y) : 0;
        }
        size_t silhouettes = 0;
        for (size_t i = 0; i < f.sample_count; i++)
            silhouettes += f.samples[i].kind == FEATURE_SILHOUETTE;
        check_near("self", (double)f.visible_edges, 9, 0, "visible edges of a cube (%s)",
                   parallel ? "parallel" : "central");
        check_near("self", 0.2 * (double)silhouettes, length, 0.01 * length, "length of its outline by samples");
        feature_release(&f);
        shot_release(&view);
    }
    shape_release(&s);
}

/* A small box pokes half out of a big one's top: a square of four intersection lines, two of which lie behind the
 * small box. */
static void boxes_cut_in_four_lines(void)
{
    for (int joined = 0; joined < 2; joined++) {
        shape     s = {0}, one = {0};
        shot      view;
        shot_view how = iso(256);
        shape_box(&s, "big", dvec_of(-1, -1, -1), dvec_of(1, 0, 1));
        shape_box(&s, "small", dvec_of(-0.3, -0.4, -0.3), dvec_of(0.3, 0.4, 0.3));
        shape_join(&one, "both", &s);
        feature_lines f = lines_of(joined ? &one : &s, &how, &view);
        double        length = 0, visible = 0;
        for (size_t i = 0; i < f.edge_count; i++)
            if (f.edges[i].kind == FEATURE_INTERSECTION)
                length += dvec_length(dvec_sub(f.edges[i].a, f.edges[i].b));
        for (size_t i = 0; i < f.sample_count; i++)
            visible += f.samples[i].kind == FEATURE_INTERSECTION;
        dvec   corner[3] = {{0.3, 0, -0.3}, {0.3, 0, 0.3}, {-0.3, 0, 0.3}};
        double wanted = 0;
        for (int i = 0; i < 2; i++) {
            dvec a = shot_project(&view, corner[i]), b = shot_project(&view, corner[i + 1]);
            wanted += hypot(a.x - b.x, a.y - b.y);
        }
        check_near("self", length, 2.4, 1e-6, "length of the cut of two boxes%s", joined ? " in one mesh" : "");
        check_near("self", 0.2 * visible, wanted, 0.02 * wanted, "its visible length on the picture");
        feature_release(&f);
        shot_release(&view);
        shape_release(&s);
        shape_release(&one);
    }
}

/* A drawn map made from the samples themselves scores full; moved by four pixels or without ink it must not. */
static void score_can_fail(void)
{
    shape     s = {0};
    shot      view;
    shot_view how = iso(256);
    shape_torus(&s, "torus", 1, 0.4, 96, 48);
    feature_lines f = lines_of(&s, &how, &view);
    for (int moved = 0; moved <= 8; moved += 4) {
        memset(view.edge, 255, 256 * 256 * 4);
        for (size_t i = 0; i < f.sample_count; i++) {
            int x = (int)f.samples[i].x + moved, y = (int)f.samples[i].y;
            if (x >= 0 && y >= 0 && x < 256 && y < 256)
                view.edge[4 * (y * 256 + x) + 2] = 0;
        }
        feature_score score = feature_compare(&f, &view, NULL);
        if (moved == 0) {
            check_near("self", score.recall, 1, 0, "recall of a perfect map");
            check_near("self", score.false_ink, 0, 0, "false ink of a perfect map");
        } else {
            check_at_most("self", score.recall, 0.7, "recall of a map moved by %d px", moved);
            check_at_least("self", score.false_ink, 0.2, "false ink of a map moved by %d px", moved);
        }
    }
    memset(view.edge, 255, 256 * 256 * 4);
    check_near("self", feature_compare(&f, &view, NULL).recall, 0, 0, "recall of an empty map");
    feature_release(&f);
    shot_release(&view);
    shape_release(&s);
}

/* --- stacks --------------------------------------------------------------------------------------------- */

/* Rays through a ball leave it where the closed form says, on its far side. */
static void stacks_of_a_sphere(void)
{
    shape     s = {0};
    shot      view;
    stack_map map;
    double    worst = 0;
    int       wrong = 0, through = 0;
    for (int parallel = 0; parallel < 2; parallel++) {
        shot_view how = iso(96);
        how.orthographic = parallel;
        shape_sphere(&s, "sphere", dvec_of(0, 0, 0), 1, 256, 512, true);
        tracer *t = tracer_create(&s);
        shot_blank(&view, &how, 5, 10);
        stack_map_make(&map, t, &view);
        for (int i = 0; i < 96 * 96; i++) {
            dvec origin, direction;
            shot_ray(&view, i % 96 + 0.5, i / 96 + 0.5, &origin, &direction);
            double a = dvec_dot(direction, direction), b = dvec_dot(origin, direction),
                   root = b * b - a * (dvec_dot(origin, origin) - 1);
            if (root < 0.02)
                continue;
            const stack_hit *hit = stack_at(&map, i);
            through++;
            wrong += stack_count(&map, i) != 2 || !hit[0].front || hit[1].front;
            for (int k = 0; k < 2 && stack_count(&map, i) == 2; k++) {
                dvec p = dvec_add(origin, dvec_scale(direction, (-b + (k ? 1 : -1) * sqrt(root)) / a));
                worst = fmax(worst, fabs(hit[k].depth + shot_to_eye(&view, p, 1).z));
                worst = fmax(worst, dvec_length(dvec_sub(hit[k].normal, shot_to_eye(&view, p, 0))));
            }
        }
        stack_map_release(&map);
        shot_release(&view);
        tracer_destroy(t);
        shape_release(&s);
    }
    check_at_least("self", through, 1000, "rays through a ball");
    check_at_most("self", wrong, 0, "of them without one front and one back");
    check_at_most("self", worst, 5e-3, "depth and normal of both against the closed form");
}

/* All hits of the tree against a plain loop, sorted by hand. */
static void stacks_equal_brute_force(void)
{
    for (int kind = 0; kind < SCENE_KINDS; kind++) {
        shape     s = {0};
        shot      view;
        shot_view how = iso(40);
        int       differ = 0, uneven = 0;
        size_t    count, most = 0;
        scene_make(&s, (scene_kind)kind, 3);
        tracer               *t = tracer_create(&s);
        const trace_triangle *f = tracer_triangles(t, &count);
        shot_blank(&view, &how, 1, 20);
        for (int i = 0; i < 40 * 40; i++) {
            dvec      origin, direction;
            trace_hit hits[STACK_MAX];
            stack_hit stack[STACK_MAX];
            size_t    found = 0;
            double    sum = 0, other = 0;
            shot_ray(&view, i % 40 + 0.5, i / 40 + 0.5, &origin, &direction);
            for (size_t k = 0; k < count; k++) {
                double d = dvec_dot(f[k].flat, direction), at = dvec_dot(f[k].flat, dvec_sub(f[k].p[0], origin)) / d;
                dvec   p = dvec_add(origin, dvec_scale(direction, at));
                bool   inside = at > 0;
                for (int c = 0; c < 3; c++)
                    inside = inside && dvec_dot(f[k].flat, dvec_cross(dvec_sub(f[k].p[(c + 1) % 3], f[k].p[c]),
                                                                      dvec_sub(p, f[k].p[c]))) >= 0;
                found += inside;
                sum += inside ? at : 0;
            }
            size_t all = tracer_hits(t, origin, direction, 0, INFINITY, hits, STACK_MAX);
            for (size_t k = 0; k < all; k++)
                other += hits[k].t;
            differ += all != found || fabs(sum - other) > 1e-9 * (1 + sum);
            size_t settled = stack_trace(t, &view, i % 40 + 0.5, i / 40 + 0.5, stack);
            uneven += kind != SCENE_OPEN && kind != SCENE_COINCIDENT && settled % 2;
            most = settled > most ? settled : most;
        }
        check_at_most("self", differ, 0, "rays whose hits differ from a plain loop's, scene %s", scene_names[kind]);
        check_at_most("self", uneven, 0, "rays that leave solids less often than they enter them");
        check_at_least("self", (double)most, 6, "most surfaces on a ray");
        shot_release(&view);
        tracer_destroy(t);
        shape_release(&s);
    }
}

static size_t middle_stack(const shape *s, stack_hit out[STACK_MAX])
{
    shot      view;
    shot_view how = {.width = 64,
                     .height = 64,
                     .eye = {0.13, 0.07, 9},
                     .target = {0.13, 0.07, 0},
                     .up = {0, 1, 0},
                     .orthographic = true};
    tracer   *t = tracer_create(s);
    shot_blank(&view, &how, 1, 20);
    size_t count = stack_trace(t, &view, 32.3, 31.6, out);
    shot_release(&view);
    tracer_destroy(t);
    return count;
}

/* What coincides: sorted by part, then front before back; once when part and facing are the same. */
static void stacks_of_coincident_faces(void)
{
    shape     s = {0};
    stack_hit hit[STACK_MAX];
    shape_box(&s, "behind", dvec_of(-1, -1, -1), dvec_of(1, 1, 0));
    shape_box(&s, "before", dvec_of(-1, -1, 0), dvec_of(1, 1, 1));
    bool four = middle_stack(&s, hit) == 4;
    check_that("self",
               four && hit[0].id == 2 && hit[1].id == 1 && hit[1].front && hit[2].id == 2 && !hit[2].front &&
                   hit[3].id == 1,
               "two boxes that share a face are four surfaces, the shared ones by part");
    check_that("self", four && !hit[1].tied && hit[2].tied && !hit[3].tied, "and only the shared ones are tied");
    shape_release(&s);
    shape_box(&s, "once", dvec_of(-1, -1, -1), dvec_of(1, 1, 0));
    scene_copy(&s, 0, "again");
    check_that("self",
               middle_stack(&s, hit) == 4 && hit[0].id == 1 && hit[1].id == 2 && hit[2].id == 1 && hit[3].id == 2,
               "a part twice at one place counts twice");
    shape_release(&s);
    shape_quad(&s, "sheet", 1, 0);
    scene_double(&s, true);
    check_that("self",
               middle_stack(&s, hit) == 2 && hit[0].front && !hit[1].front && hit[0].normal.z > 0 &&
                   hit[1].normal.z < 0,
               "a sheet with two sides is two surfaces, the front first");
    shape_release(&s);
    shape_quad(&s, "sheet", 1, 0);
    scene_double(&s, false);
    check_that("self", middle_stack(&s, hit) == 1, "a sheet that lies there twice is one surface");
    shape_release(&s);
    scene_holed_sphere(&s, "holed", 1, 24, 36, 35);
    check_that("self", middle_stack(&s, hit) <= 2, "a sphere with holes has at most two surfaces on a ray");
    shape_release(&s);
}

/* Layers made from the stacks score full, and one changed value in them does not go unseen. */
static void stacks_score_can_fail(void)
{
    shape     s = {0};
    shot      view;
    shot_view how = iso(64);
    stack_map map;
    scene_make(&s, SCENE_CLOSED, 5);
    tracer *t = tracer_create(&s);
    shot_blank(&view, &how, 1, 20);
    stack_map_make(&map, t, &view);
    view.layers = check_alloc(map.most, sizeof *view.layers);
    view.layer_count = (int)map.most;
    int at = -1;
    for (size_t k = 0; k < map.most; k++) {
        shot_layer *l = &view.layers[k];
        l->depth = check_alloc(64 * 64, sizeof *l->depth);
        l->normal = check_alloc(64 * 64, sizeof *l->normal);
        l->id = check_alloc(64 * 64, sizeof *l->id);
        for (int i = 0; i < 64 * 64; i++) {
            bool             full = stack_count(&map, i) > k;
            const stack_hit *hit = full ? stack_at(&map, i) + k : NULL;
            l->depth[i] = full ? (float)hit->depth : INFINITY;
            l->id[i] = full ? hit->id : 0;
            for (int c = 0; full && c < 3; c++)
                l->normal[i][c] = (float)(c == 0 ? hit->normal.x : c == 1 ? hit->normal.y : hit->normal.z);
            if (map.sharp[i] && stack_count(&map, i) > 4)
                at = i;
        }
    }
    stack_score score = stack_compare(&map, t, &view, 0);
    check_at_least("self", (double)score.sharp / (double)score.pixels, 0.9, "fraction of sharp pixels");
    check_near("self", (double)score.right_sharp, (double)score.sharp, 0, "right pixels of layers that are the stacks");
    check_near("self", (double)score.drawn, (double)score.hits, 0, "surfaces in them");
    for (int what = 0; what < 5 && at >= 0; what++) {
        shot_layer *l = &view.layers[2], before = {0};
        float       depth = l->depth[at], x = l->normal[at][0];
        uint16_t    id = l->id[at];
        before = view.layers[3];
        l->depth[at] *= what == 0 ? 1.002f : 1;
        l->id[at] = (uint16_t)(id + (what == 1));
        l->normal[at][0] += what == 2 ? 0.01f : 0;
        view.layers[3] = what == 3 ? view.layers[2] : before;
        if (what == 4)
            l->depth[at] = INFINITY;
        score = stack_compare(&map, t, &view, 0);
        check_at_most("self", (double)score.right_sharp, (double)score.sharp - 1, "right pixels after change %d", what);
        view.layers[3] = before;
        l->depth[at] = depth;
        l->id[at] = id;
        l->normal[at][0] = x;
    }
    stack_map_release(&map);
    shot_release(&view);
    tracer_destroy(t);
    shape_release(&s);
}

/* --- operators on made-up maps -------------------------------------------------------------------------- */

static twin_map blank_map(void)
{
    twin_map m = {
        .width = 16, .height = 16, .normal = check_alloc(256, sizeof(dvec)), .depth = check_alloc(256, sizeof(double))};
    for (int i = 0; i < 256; i++)
        m.normal[i] = dvec_of(0, 0, 1);
    return m;
}

static twin_map step_map(double step, double degrees)
{
    twin_map m = blank_map();
    for (int i = 0; i < 256; i++)
        if (i % 16 >= 8) {
            m.depth[i] = step;
            m.normal[i] = dvec_of(sin(degrees * pi / 180), 0, cos(degrees * pi / 180));
        }
    return m;
}

static void tables_of_the_operators(void)
{
    static const double steps[][3] = {{1 / 255.0, 0.992, 0.996}, {0.01, 0.980, 0.990}, {0.05, 0.904, 0.951},
                                      {0.1, 0.815, 0.903},       {0.3, 0.522, 0.723},  {0.5, 0.316, 0.563},
                                      {1.0, 0.0625, 0.25}};
    static const double angles[][2] = {{10, 0.992}, {20, 0.970}, {30, 0.933}, {45, 0.854}, {60, 0.75}, {90, 0.5}};
    for (size_t i = 0; i < sizeof steps / sizeof *steps; i++) {
        twin_map m = step_map(steps[i][0], 0);
        check_near("E06", twin_four_tap(&m, 8, 8, 1, true).profile, steps[i][1], 6e-4, "I_Z of a step of %.4g",
                   steps[i][0]);
        check_near("E06", twin_four_tap(&m, 8, 8, 1, false).profile, steps[i][2], 6e-4, "I_Z without squares");
        check_near("P4", twin_pencil(&m, 8, 8, 1).profile, 1 - 0.5 * steps[i][0], 1e-12,
                   "equation 3 gives 1 - step / 2");
        check_near("P4", twin_pencil(&m, 8, 8, 4).profile, 1 - 2 * steps[i][0], 1e-12,
                   "the shader's weights give 1 - 2 step");
        check_near("E24", twin_saito(&m, 8, 8).profile, 1 - 0.5 * steps[i][0], 1e-12, "I0 of an axis-aligned step");
        check_near("E24", twin_saito(&m, 8, 8).inner, 1 - steps[i][0], 1e-12, "I1 of an axis-aligned step");
        twin_map_release(&m);
    }
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        twin_map m = step_map(0, angles[i][0]);
        double   n = 1 - (1 - twin_denormal(&m, 7, 8, 0, false).inner) / 4;
        check_near("OI-06", n, angles[i][1], 6e-4, "squared length at a crease of %g degrees", angles[i][0]);
        check_near("P3", twin_four_tap(&m, 8, 8, 1, true).inner, cos(angles[i][0] * pi / 180), 1e-12,
                   "I_N of that crease");
        twin_map_release(&m);
    }
}

static void few_taps_equal_many(void)
{
    twin_map m = blank_map();
    double   worst = 0;
    uint32_t random = 1;
    for (int i = 0; i < 256; i++) {
        double v[4];
        for (int k = 0; k < 4; k++) {
            random = random * 1664525u + 1013904223u;
            v[k] = random / 4294967296.0;
        }
        m.depth[i] = v[3];
        m.normal[i] = dvec_unit(dvec_of(v[0] - 0.5, v[1] - 0.5, v[2]));
    }
    for (int i = 0; i < 256; i++) {
        twin_value nine = twin_sobel_nine(&m, i % 16, i / 16), five = twin_sobel_five(&m, i % 16, i / 16);
        twin_value eight = twin_sobel_eight(&m, i % 16, i / 16);
        worst = fmax(worst, fmax(fabs(nine.profile - five.profile), fabs(nine.inner - five.inner)));
        worst = fmax(worst, fmax(fabs(nine.profile - eight.profile), fabs(nine.inner - eight.inner)));
    }
    check_at_most("OI-04", worst, 1e-12, "bilinear Sobel against the 3x3 kernels on noise");
    twin_map_release(&m);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"shapes", shapes_are_solid},
        {"sphere", caster_sees_a_sphere},
        {"brute", caster_equals_brute_force},
        {"cube", cube_has_nine_edges},
        {"boxes", boxes_cut_in_four_lines},
        {"score", score_can_fail},
        {"stacks", stacks_of_a_sphere},
        {"all", stacks_equal_brute_force},
        {"coincident", stacks_of_coincident_faces},
        {"layers", stacks_score_can_fail},
        {"tables", tables_of_the_operators},
        {"taps", few_taps_equal_many},
    };
    return check_main(argc, argv, "self", cases, sizeof cases / sizeof *cases);
}
