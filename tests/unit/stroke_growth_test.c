/* What would take a search over all pairs too long: four times as much of it takes four times as long, or little more.
 * And the lines are all there. */
#include "stroke_shapes.h"

#include "stroke/stroke_private.h"

#include <time.h>

static const double origin[3] = {0, 0, 0};

enum { RUNS = 2 };

typedef void (*maker)(lmn_scene *s, uint32_t count);

typedef struct outcome {
    double   seconds, visible, hidden; /* lengths, of all lines */
    uint64_t pairs, entries, ends;     /* that were compared, or looked at */
    uint64_t lines;                    /* whose visibility was asked for */
    size_t   strokes;
} outcome;

static double now(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

static void find(const pose *p, const stroke_camera *c, const stroke_options *w, outcome *out)
{
    stroke_scene scene;
    stroke_view *view;
    stroke_set   set;
    lmn_error    error = {0};
    double       begin = now();
    assert_int_equal(stroke_scene_create(&scene, p, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_view_create(&view, &scene, c, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_find(&set, view, w, NULL, NULL, NULL, &error), LMN_OK);
    out->seconds = fmin(out->seconds, now() - begin);
    out->visible = out->hidden = 0;
    out->pairs = set.pairs;
    out->entries = set.entries;
    out->ends = set.ends_compared;
    out->lines = set.lines;
    out->strokes = set.stroke_count;
    for (size_t i = 0; i < set.stroke_count; i++)
        for (uint32_t k = 1; k < set.strokes[i].count; k++) {
            const stroke_point *q = &set.points[set.strokes[i].first + k];
            *(set.strokes[i].hidden_by ? &out->hidden : &out->visible) +=
                hypot((double)q->x - q[-1].x, (double)q->y - q[-1].y);
        }
    stroke_set_release(&set);
    stroke_view_destroy(&view);
    stroke_scene_release(&scene);
}

static stroke_options all_lines(void)
{
    stroke_options w = STROKE_OPTIONS_INIT;
    w.hidden = 1;
    w.crowd = 0;
    return w;
}

static stroke_camera from_afar(void)
{
    return look_along(-1, -0.7, -1.2, origin, 20, 1.25, true, 1000, 1000);
}

static outcome run_with(maker make, uint32_t count, const stroke_camera *c, const stroke_options *w)
{
    outcome    out = {.seconds = INFINITY};
    lmn_error  error = {0};
    pose       at_rest;
    lmn_scene *s = stroke_scene_begin();
    make(s, count);
    assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    find(&at_rest, c, w, &out);
    pose_release(&at_rest);
    scene_free(s);
    return out;
}

static outcome run(maker make, uint32_t count)
{
    const stroke_options w = all_lines();
    const stroke_camera  c = from_afar();
    return run_with(make, count, &c, &w);
}

/* Least CPU seconds of some runs. */
static double seconds_of(maker make, uint32_t count)
{
    double least = INFINITY;
    for (int k = 0; k < RUNS; k++)
        least = fmin(least, run(make, count).seconds);
    return least;
}

/* Thin triangles from one place to a circle around it, in the plane that the camera looks at straight on. */
static void make_star(lmn_scene *s, uint32_t count)
{
    const double n[3] = {1, 0.7, 1.2};
    const double u[3] = {0.7, -1, 0},
                 v[3] = {n[1] * u[2] - n[2] * u[1], n[2] * u[0] - n[0] * u[2], n[0] * u[1] - n[1] * u[0]};
    const double lengths[2] = {sqrt(u[0] * u[0] + u[1] * u[1]), sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])};
    vec3        *positions = mem_alloc((2 * (size_t)count + 1) * sizeof *positions);
    uint32_t    *corners = mem_alloc(3 * (size_t)count * sizeof *corners);
    positions[0] = (vec3){0, 0, 0};
    for (uint32_t i = 0; i < 2 * count; i++) {
        double turn = stroke_pi * i / count, x = cos(turn) / lengths[0], y = sin(turn) / lengths[1];
        positions[1 + i] =
            (vec3){(float)(x * u[0] + y * v[0]), (float)(x * u[1] + y * v[1]), (float)(x * u[2] + y * v[2])};
        if (i % 2 == 0)
            memcpy(corners + 3 * (i / 2), (const uint32_t[]){0, 1 + i, 2 + i}, 3 * sizeof *corners);
    }
    add_part(s, positions, 2 * count + 1, corners, 3 * count);
    mem_free(positions);
    mem_free(corners);
}

/* Each spoke has two long sides of 400 px and a short one. Four times as many: sixteen times as long before. */
static void stars_grow_as_their_spokes(void **state)
{
    (void)state;
    outcome few = run(make_star, 1500), many = run(make_star, 6000);
    double  wanted = 400 * 6000 * (2 + 2 * sin(stroke_pi / 12000));
    if (!(many.entries < 8 * few.entries))
        fail_msg("of 1500 spokes %g entries are looked at, of 6000 %g", (double)few.entries, (double)many.entries);
    if (!(many.pairs < 8 * few.pairs + 6000) || !(fabs(many.visible - wanted) < 1e-3 * wanted) ||
        many.hidden > 1e-3 * wanted)
        fail_msg("%g pairs, then %g; %g px are seen and %g hidden, not %g", (double)few.pairs, (double)many.pairs,
                 many.visible, many.hidden, wanted);
}

/* All spokes have two ends in one place: each is held against those that lead straight on, and not against all. */
static void ends_in_one_place_are_not_all_compared(void **state)
{
    (void)state;
    outcome many = run(make_star, 1600);
    if (!(many.ends > many.strokes) || many.ends > 16 * many.strokes)
        fail_msg("%zu strokes: %g pairs of ends are compared", many.strokes, (double)many.ends);
}

/* Narrow triangles from one place in all directions, as wide as is asked for. */
static void put_spikes(lmn_scene *s, uint32_t first, uint32_t count, double width)
{
    vec3     *positions = mem_alloc((2 * (size_t)count + 1) * sizeof *positions);
    uint32_t *corners = mem_alloc(3 * (size_t)count * sizeof *corners);
    positions[0] = (vec3){0, 0, 0};
    for (uint32_t i = 0; i < count; i++) {
        uint32_t seed = 5 * (first + i);
        double   turn = stroke_pi * stroke_random(seed), up = stroke_random(seed + 1), wide = sqrt(1 - up * up);
        double   tip[3] = {wide * cos(turn), wide * sin(turn), up}, beside[3];
        for (uint32_t k = 0; k < 3; k++)
            beside[k] = tip[k] + width * stroke_random(seed + 2 + k);
        positions[1 + 2 * i] = (vec3){(float)tip[0], (float)tip[1], (float)tip[2]};
        positions[2 + 2 * i] = (vec3){(float)beside[0], (float)beside[1], (float)beside[2]};
        memcpy(corners + 3 * i, (const uint32_t[]){0, 1 + 2 * i, 2 + 2 * i}, 3 * sizeof *corners);
    }
    add_part(s, positions, 2 * count + 1, corners, 3 * count);
    mem_free(positions);
    mem_free(corners);
}

/* Where spikes cross: how many pairs of the first `counted` ones, or of all, with a sum that tells which, and how many
 * pairs were compared. */
static void cross_spikes(uint32_t count, double width, uint32_t counted, size_t *found, double *sum, uint64_t *compared)
{
    lmn_error     error = {0};
    pose          at_rest;
    stroke_scene  scene;
    crossing_list list;
    lmn_scene    *s = stroke_scene_begin();
    put_spikes(s, 0, count, width);
    assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(&scene, &at_rest, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    assert_int_equal(crossings_find(&list, &scene, NULL, NULL, NULL, NULL, &error), LMN_OK);
    *found = 0;
    *sum = 0;
    *compared = list.compared;
    for (size_t i = 0; i < list.count; i++) {
        const face_crossing *c = &list.crossings[i];
        if (c->faces[0] >= counted || c->faces[1] >= counted)
            continue;
        double3 way = double3_minus(c->ends[1], c->ends[0]);
        ++*found;
        *sum += sqrt(double3_dot(way, way)) * (1 + c->faces[0] + c->faces[1]);
    }
    crossings_release(&list);
    stroke_scene_release(&scene);
    pose_release(&at_rest);
    scene_free(s);
}

/* Boxes of all of them overlap where they meet. */
static void spikes_are_compared_by_directions(void **state)
{
    (void)state;
    size_t   found[2];
    double   sums[2];
    uint64_t few, many;
    cross_spikes(500, 4e-3, 500, &found[0], &sums[0], &few);
    cross_spikes(2000, 4e-3, 2000, &found[1], &sums[1], &many);
    if (many > 32 * 2000)
        fail_msg("of 500 spikes %g pairs are compared, of 2000 %g", (double)few, (double)many);
}

/* Sixty are too few for a place of their own, 240 are not; what the first sixty have with each other stays. */
static void spikes_cross_as_they_did(void **state)
{
    (void)state;
    size_t   alone, among;
    double   alone_sum, among_sum;
    uint64_t compared;
    cross_spikes(60, 2, 60, &alone, &alone_sum, &compared);
    cross_spikes(240, 2, 60, &among, &among_sum, &compared);
    if (alone < 20 || among != alone || !(fabs(among_sum - alone_sum) < 1e-6 * alone_sum))
        fail_msg("60 spikes cross in %zu lines (%g), among others in %zu (%g)", alone, alone_sum, among, among_sum);
}

/* The narrower the more, so that as many lines cross. */
static void make_spikes(lmn_scene *s, uint32_t count)
{
    put_spikes(s, 0, count, 4.0 / count);
}

static void make_wide_spikes(lmn_scene *s, uint32_t count)
{
    put_spikes(s, 0, count, 0.2);
}

/* The same in parts, which share no vertex. */
static void make_parts_of_spikes(lmn_scene *s, uint32_t count)
{
    for (uint32_t first = 0; first < count; first += count / 4)
        put_spikes(s, first, count / 4, 0.2);
}

/* Lines from the middle are held against what lies in their direction, and cells of the grid that have much else on
 * their way are passed by. */
static void spikes_hide_by_directions(void **state)
{
    (void)state;
    outcome many = run(make_spikes, 4000);
    if (many.entries > (uint64_t)4000 * 8000)
        fail_msg("of 4000 spikes %g entries are looked at", (double)many.entries);
}

/* What hides does so whether it is one wheel or several pieces that are too small for any. */
static void spikes_hide_what_their_parts_do(void **state)
{
    (void)state;
    outcome whole = run(make_wide_spikes, 400), parts = run(make_parts_of_spikes, 400);
    if (!(fabs(whole.visible - parts.visible) < 1e-3 * parts.visible) || !(whole.hidden > whole.visible) ||
        !(fabs(whole.hidden - parts.hidden) < 1e-3 * parts.hidden))
        fail_msg("%g px are seen and %g hidden, in parts %g and %g", whole.visible, whole.hidden, parts.visible,
                 parts.hidden);
}

/* Small triangles, one behind the other, that are one pixel large, all of them, and one that is not. */
static void make_speck(lmn_scene *s, uint32_t count)
{
    vec3     *positions = mem_alloc((3 * (size_t)count + 3) * sizeof *positions);
    uint32_t *corners = mem_alloc((3 * (size_t)count + 3) * sizeof *corners);
    for (uint32_t i = 0; i < 3 * count; i++) {
        double middle[3], at[3];
        for (uint32_t k = 0; k < 3; k++) {
            middle[k] = 1e-3 * stroke_random(9 * (i / 3) + k);
            at[k] = middle[k] + 3e-5 * stroke_random(7 * i + k + 1000003);
        }
        positions[i] = (vec3){(float)at[0], (float)at[1], (float)at[2]};
    }
    positions[3 * count] = (vec3){1, 0, 0};
    positions[3 * count + 1] = (vec3){0, 1, 0};
    positions[3 * count + 2] = (vec3){0, 0, 1};
    for (uint32_t i = 0; i < 3 * count + 3; i++)
        corners[i] = i;
    add_part(s, positions, 3 * count + 3, corners, 3 * count + 3);
    mem_free(positions);
    mem_free(corners);
}

static void specks_grow_as_they_are_full(void **state)
{
    (void)state;
    const double few = seconds_of(make_speck, 2500), many = seconds_of(make_speck, 10000);
    if (!(many < 8 * few))
        fail_msg("2500 triangles in a pixel take %g s, 10000 %g s", few, many);
}

/* Sheets one behind the other, all of them larger than the cells of a grid. */
static void make_sheets(lmn_scene *s, uint32_t count)
{
    const double n[3] = {1, 0.7, 1.2}, u[3] = {0.7, -1, 0}, v[3] = {1.2, 0.84, -1.49};
    vec3        *positions = mem_alloc(3 * (size_t)count * sizeof *positions);
    uint32_t    *corners = mem_alloc(3 * (size_t)count * sizeof *corners);
    for (uint32_t i = 0; i < 3 * count; i++) {
        double along = i % 3 == 1 ? 3 : -2, up = i % 3 == 2 ? 3 : -2, deep = 1e-3 * (i / 3);
        corners[i] = i;
        positions[i] =
            (vec3){(float)(along * u[0] + up * v[0] + deep * n[0]), (float)(along * u[1] + up * v[1] + deep * n[1]),
                   (float)(along * u[2] + up * v[2] + deep * n[2])};
    }
    add_part(s, positions, 3 * count, corners, 3 * count);
    mem_free(positions);
    mem_free(corners);
}

/* Entries that a view's grids have. */
static size_t entries_of(maker make, uint32_t count)
{
    lmn_error     error = {0};
    pose          at_rest;
    stroke_scene  scene;
    stroke_view  *view;
    lmn_scene    *s = stroke_scene_begin();
    stroke_camera c = look_along(-1, -0.7, -1.2, origin, 20, 1.25, true, 1000, 1000);
    make(s, count);
    assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(&scene, &at_rest, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_view_create(&view, &scene, &c, NULL, NULL, &error), LMN_OK);
    size_t out = view->grid.entry_count + view->grid.sub_entry_count;
    stroke_view_destroy(&view);
    stroke_scene_release(&scene);
    pose_release(&at_rest);
    scene_free(s);
    return out;
}

/* Where surfaces lie one behind the other, cells stay crowded however fine they are, and are not divided in vain. */
static void surfaces_in_front_do_not_fill_the_grid(void **state)
{
    (void)state;
    size_t few = entries_of(make_sheets, 400), many = entries_of(make_sheets, 1600);
    if (many > 8 * few || many > 400 * 1600)
        fail_msg("400 sheets have %zu entries, 1600 %zu", few, many);
}

/* Triangles anywhere in a cube, which share nothing, the smaller the more there are. */
static void make_soup(lmn_scene *s, uint32_t count)
{
    const double size = 1.6 / cbrt(count);
    vec3        *positions = mem_alloc(3 * (size_t)count * sizeof *positions);
    uint32_t    *corners = mem_alloc(3 * (size_t)count * sizeof *corners);
    for (uint32_t i = 0; i < 3 * count; i++) {
        double at[3];
        for (uint32_t k = 0; k < 3; k++)
            at[k] = 0.6 * stroke_random(3 * (i / 3) + k) + size * stroke_random(3 * i + k + 7000001);
        positions[i] = (vec3){(float)at[0], (float)at[1], (float)at[2]};
        corners[i] = i;
    }
    add_part(s, positions, 3 * count, corners, 3 * count);
    mem_free(positions);
    mem_free(corners);
}

/* Small things that are hidden have no lines, and most of a soup is: what lies in front grows as the surface of a cube
 * does, and not as its volume. */
static void hidden_pieces_are_not_looked_for(void **state)
{
    (void)state;
    stroke_options      w = all_lines();
    const stroke_camera c = from_afar();
    w.island = 400;
    outcome few = run_with(make_soup, 6000, &c, &w), many = run_with(make_soup, 48000, &c, &w);
    if (!(few.lines > 6000) || !(many.lines < 5 * few.lines) || !(many.pairs < 6 * few.pairs))
        fail_msg("of 6000 triangles %g lines are looked for in %g pairs, of 48000 %g in %g", (double)few.lines,
                 (double)few.pairs, (double)many.lines, (double)many.pairs);
}

/* Closed bodies, some of which lie in others, or as good as on them. */
static void make_boxes(lmn_scene *s, uint32_t count)
{
    enum { CORNERS = 8, EDGES = 36 };
    static const uint32_t sides[EDGES] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                          2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
    vec3                 *positions = mem_alloc(CORNERS * (size_t)count * sizeof *positions);
    uint32_t             *corners = mem_alloc(EDGES * (size_t)count * sizeof *corners);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t seed = 6 * (i % 5 == 4 ? i - 1 : i);
        for (uint32_t k = 0; k < CORNERS; k++)
            positions[CORNERS * i + k] =
                (vec3){(float)(0.6 * stroke_random(seed) + (k & 1 ? 0.06 * stroke_random(seed + 3) + 0.01 : 0)),
                       (float)(0.6 * stroke_random(seed + 1) + (k & 2 ? 0.06 * stroke_random(seed + 4) + 0.01 : 0)),
                       (float)(0.6 * stroke_random(seed + 2) + (k & 4 ? 0.06 * stroke_random(seed + 5) + 0.01 : 0)) +
                           (i % 5 == 4 ? 1e-4f : 0)};
        for (uint32_t k = 0; k < EDGES; k++)
            corners[EDGES * i + k] = CORNERS * i + sides[k];
    }
    add_part(s, positions, CORNERS * count, corners, EDGES * count);
    mem_free(positions);
    mem_free(corners);
}

/* What is seen does not depend on it, whether what is hidden of the rest is drawn or not. */
static void check_what_is_seen(maker make, uint32_t count, const stroke_camera *c, const char *what)
{
    stroke_options w = all_lines();
    w.shortest = 0; /* of whole lines, with what is hidden of them */
    w.detail = 1;
    outcome all = run_with(make, count, c, &w);
    w.island = 400;
    outcome islands = run_with(make, count, c, &w);
    w.figure = 4000;
    outcome figures = run_with(make, count, c, &w);
    w.hidden = 0;
    outcome seen = run_with(make, count, c, &w);
    if (!(islands.lines < all.lines) || !(islands.hidden < 0.8 * all.hidden) ||
        !(figures.hidden < 0.5 * islands.hidden) || seen.hidden > 0)
        fail_msg("%s: %g px are hidden, %g of what is seen in part, %g of long lines", what, all.hidden, islands.hidden,
                 figures.hidden);
    if (!(all.visible > 1000) || fabs(islands.visible - all.visible) > 1e-4 * all.visible ||
        fabs(figures.visible - all.visible) > 1e-4 * all.visible ||
        fabs(seen.visible - all.visible) > 1e-4 * all.visible)
        fail_msg("%s: %g px are seen, without islands %g, without short figures %g, alone %g", what, all.visible,
                 islands.visible, figures.visible, seen.visible);
}

static void what_is_seen_stays(void **state)
{
    (void)state;
    const double        middle[3] = {0.3, 0.3, 0.3};
    const stroke_camera afar = from_afar(), near = look_along(-1, -0.7, -1.2, middle, 1.6, 0.6, false, 1000, 1000);
    check_what_is_seen(make_soup, 8000, &afar, "soup");
    check_what_is_seen(make_soup, 8000, &near, "soup from nearby");
    check_what_is_seen(make_boxes, 4500, &afar, "boxes");
    check_what_is_seen(make_boxes, 4500, &near, "boxes from nearby");
}

/* Pairs of triangles that share a corner under a plate, from under which one of each reaches out. */
static void make_pairs(lmn_scene *s, uint32_t count)
{
    vec3     *positions = mem_alloc(5 * (size_t)count * sizeof *positions);
    uint32_t *corners = mem_alloc(6 * (size_t)count * sizeof *corners);
    for (uint32_t i = 0; i < count; i++) {
        const float    x = (float)i / (float)count, step = 0.8f / (float)count;
        const uint32_t pair[6] = {0, 1, 2, 2, 3, 4};
        const vec3     own[5] = {{x, -0.1f, 0}, {x + step, -0.1f, 0}, {x, 0, 0}, {x + step, 0.1f, 0}, {x, 0.1f, 0}};
        memcpy(positions + 5 * i, own, sizeof own);
        for (uint32_t k = 0; k < 6; k++)
            corners[6 * i + k] = 5 * i + pair[k];
    }
    add_part(s, positions, 5 * count, corners, 6 * count);
    add_plate(s, -1, -0.05, 2, 1, 0.2);
    mem_free(positions);
    mem_free(corners);
}

/* Lines go on from one to the other. */
static void what_hangs_together_is_hidden_together(void **state)
{
    (void)state;
    const double        middle[3] = {0.5, 0, 0};
    const stroke_camera above = look_along(0, 0, -1, middle, 20, 0.6, true, 1000, 1000);
    stroke_options      w = all_lines();
    outcome             all = run_with(make_pairs, 2500, &above, &w);
    w.island = 400;
    outcome islands = run_with(make_pairs, 2500, &above, &w);
    if (!(all.hidden > 1000) || fabs(islands.hidden - all.hidden) > 1e-4 * all.hidden)
        fail_msg("%g px are hidden, without islands %g", all.hidden, islands.hidden);
}

/* With every allocation that fails in turn, nothing is lost and nothing is made up. */
static void search_of_the_hidden_copes_without_memory(void **state)
{
    (void)state;
    lmn_error            error = {0};
    pose                 at_rest;
    stroke_scene         scene;
    stroke_view         *view;
    const stroke_camera  c = from_afar();
    const stroke_options w = {.island = 400, .hidden = 1};
    lmn_scene           *s = stroke_scene_begin();
    lmn_status           status = LMN_MEMORY;
    uint8_t             *hidden = NULL;
    make_soup(s, 6000);
    assert_int_equal(scene_finish(s, "test", &error), LMN_OK);
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(&scene, &at_rest, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_view_create(&view, &scene, &c, NULL, NULL, &error), LMN_OK);
    for (long n = 1; status != LMN_OK && n < 64; n++) {
        mem_fail_at(n);
        status = occlusion_find(&hidden, view, &w, &error);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && !hidden));
    }
    assert_int_equal(status, LMN_OK);
    assert_non_null(hidden);
    assert_non_null(memchr(hidden, 1, view->piece_count));
    assert_non_null(memchr(hidden, 0, view->piece_count));
    mem_free(hidden);
    stroke_view_destroy(&view);
    stroke_scene_release(&scene);
    pose_release(&at_rest);
    scene_free(s);
}

/* Rows of quads of which every second one is cut once more: a T-junction at each quad. */
static void make_junctions(lmn_scene *s, uint32_t count)
{
    const uint32_t side = (uint32_t)lround(sqrt(count)), quads = side * side;
    vec3          *positions = mem_alloc(6 * (size_t)quads * sizeof *positions);
    uint32_t      *corners = mem_alloc(12 * (size_t)quads * sizeof *corners), used = 0;
    for (uint32_t i = 0; i < quads; i++) {
        const double x = (double)(i % side) / side, y = (double)(i / side) / side, step = 1.0 / side;
        for (uint32_t k = 0; k < 6; k++) /* left, middle and right, below and above */
            positions[6 * i + k] = (vec3){(float)(x + 0.5 * step * (k % 3) - 0.5), (float)(y + step * (k / 3) - 0.5),
                                          (float)(0.3 * sin(9 * (y + step * (k / 3))))};
        const uint32_t whole[6] = {0, 2, 5, 0, 5, 3}, halves[12] = {0, 1, 4, 0, 4, 3, 1, 2, 5, 1, 5, 4};
        const bool     cut = i / side % 2;
        for (uint32_t k = 0; k < (cut ? 12 : 6); k++)
            corners[used++] = 6 * i + (cut ? halves[k] : whole[k]);
    }
    add_part(s, positions, 6 * quads, corners, used);
    mem_free(positions);
    mem_free(corners);
}

static void junctions_grow_as_their_number(void **state)
{
    (void)state;
    outcome few = run(make_junctions, 2500), many = run(make_junctions, 10000);
    if (!(few.strokes > 50) || !(many.ends < 5 * few.ends + 1000) || !(many.pairs < 6 * few.pairs) ||
        many.ends > 64 * many.strokes)
        fail_msg("2500 quads: %zu strokes, %g pairs of ends, %g of lines and triangles; 10000: %zu, %g, %g",
                 few.strokes, (double)few.ends, (double)few.pairs, many.strokes, (double)many.ends, (double)many.pairs);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(stars_grow_as_their_spokes),
        cmocka_unit_test(ends_in_one_place_are_not_all_compared),
        cmocka_unit_test(spikes_are_compared_by_directions),
        cmocka_unit_test(spikes_cross_as_they_did),
        cmocka_unit_test(spikes_hide_by_directions),
        cmocka_unit_test(spikes_hide_what_their_parts_do),
        cmocka_unit_test(specks_grow_as_they_are_full),
        cmocka_unit_test(surfaces_in_front_do_not_fill_the_grid),
        cmocka_unit_test(hidden_pieces_are_not_looked_for),
        cmocka_unit_test(what_is_seen_stays),
        cmocka_unit_test(junctions_grow_as_their_number),
        cmocka_unit_test(search_of_the_hidden_copes_without_memory),
        cmocka_unit_test(what_hangs_together_is_hidden_together),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
