/* Surfaces in front of lines are counted where they begin and end. Held against a search that compares each line with
 * every triangle, for itself, and against rays: scenes of closed bodies, open ones and loose triangles, which run
 * through each other, at random. */
#include "stroke_shapes.h"

#include "stroke/line_filter.h"

enum { PAGE = 400, FREE_LINES = 400 };

typedef struct chance {
    uint32_t at;
} chance;

static double between(chance *c, double low, double high)
{
    return low + (high - low) * stroke_random(c->at++);
}

/* A rough sphere, some of whose faces may be missing, so that both sides of it are seen. */
static void add_lump(lmn_scene *s, chance *c, double missing)
{
    enum { COLUMNS = 24, RINGS = 14, MOST = COLUMNS * RINGS * 6 };
    static uint32_t corners[MOST];
    static vec3     positions[COLUMNS * (RINGS + 1)];
    const double    radius = between(c, 0.2, 0.7), x = between(c, -0.5, 0.5), y = between(c, -0.5, 0.5),
                 z = between(c, -0.5, 0.5);
    uint32_t count = 0;
    for (uint32_t r = 0; r <= RINGS; r++)
        for (uint32_t k = 0; k < COLUMNS; k++) {
            const double polar = stroke_pi * (r / (double)RINGS - 0.5), turn = 2 * stroke_pi * k / COLUMNS;
            const double own = radius * (r == 0 || r == RINGS ? 1 : between(c, 0.9, 1.1));
            positions[r * COLUMNS + k] =
                (vec3){(float)(x + own * cos(polar) * cos(turn)), (float)(y + own * cos(polar) * sin(turn)),
                       (float)(z + own * sin(polar))};
        }
    for (uint32_t r = 0; r < RINGS; r++)
        for (uint32_t k = 0; k < COLUMNS; k++) {
            const uint32_t a = r * COLUMNS + k, b = r * COLUMNS + (k + 1) % COLUMNS;
            const uint32_t quad[6] = {a, b, b + COLUMNS, a, b + COLUMNS, a + COLUMNS};
            if (between(c, 0, 1) < missing)
                continue;
            memcpy(corners + count, quad, sizeof quad);
            count += 6;
        }
    add_part(s, positions, COLUMNS * (RINGS + 1), corners, count);
}

static void add_loose(lmn_scene *s, chance *c, uint32_t count)
{
    vec3     *positions = mem_alloc(3 * count * sizeof *positions);
    uint32_t *corners = mem_alloc(3 * count * sizeof *corners);
    for (uint32_t i = 0; i < 3 * count; i++) {
        const double reach = i % 3 ? 0.3 : 1; /* the second and third corner lie near the first */
        const vec3   from = i % 3 ? positions[i - i % 3] : (vec3){0, 0, 0};
        positions[i] = (vec3){from.x + (float)between(c, -reach, reach), from.y + (float)between(c, -reach, reach),
                              from.z + (float)between(c, -reach, reach)};
        corners[i] = i;
    }
    add_part(s, positions, 3 * count, corners, 3 * count);
    mem_free(positions);
    mem_free(corners);
}

typedef struct hidden_scene {
    lmn_scene     *source;
    pose           at_rest;
    stroke_scene   scene;
    stroke_view   *view;
    view_lines     lines; /* of the scene */
    double         ends[FREE_LINES][2][3];
    window_segment free[FREE_LINES]; /* anywhere */
    size_t         free_count;
} hidden_scene;

static void open_scene(hidden_scene *h, uint32_t seed, bool orthographic)
{
    static const double origin[3] = {0, 0, 0};
    chance              c = {1000000 * seed};
    lmn_error           error = {0};
    stroke_options      w = STROKE_OPTIONS_INIT;
    w.hidden = true;
    memset(h, 0, sizeof *h);
    h->source = stroke_scene_begin();
    for (uint32_t i = 0; i < 4; i++)
        add_lump(h->source, &c, i & 1 ? 0.15 : 0);
    add_box(h->source, -0.6, -0.4, -0.5, 0.3, 0.5, between(&c, -0.4, 0.6));
    add_loose(h->source, &c, 60);
    /* Half of the scenes reach beyond the page, or behind the eye. */
    const double        half = seed & 1 ? 0.8 : 1.6, distance = seed & 2 && !orthographic ? 1.1 : 4;
    const stroke_camera camera = look_along(between(&c, -1, 1), between(&c, -1, 1), between(&c, -1, 1), origin,
                                            distance, orthographic ? half : half / 3, orthographic, PAGE, PAGE);
    assert_int_equal(scene_finish(h->source, "test", &error), LMN_OK);
    assert_int_equal(pose_create(&h->at_rest, h->source, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(&h->scene, &h->at_rest, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_view_create(&h->view, &h->scene, &camera, NULL, NULL, &error), LMN_OK);
    assert_int_equal(lines_collect(&h->lines, h->view, &w, NULL, NULL, NULL, NULL, &error), LMN_OK);
    for (size_t i = 0; i < FREE_LINES; i++) {
        window_segment *s = &h->free[h->free_count];
        double3         p[2];
        for (int k = 0; k < 2; k++) {
            p[k] = (double3){between(&c, -1, 1), between(&c, -1, 1), between(&c, -1, 1)};
            memcpy(h->ends[h->free_count][k], &p[k], sizeof p[k]);
        }
        *s = (window_segment){.ends = {NO_VERTEX, NO_VERTEX}, .faces = {EDGE_NO_FACE, EDGE_NO_FACE}};
        h->free_count += view_position(h->view, p[0], &s->a) && view_position(h->view, p[1], &s->b);
    }
    assert_true(h->free_count > FREE_LINES / 8 && h->lines.count > 1000);
}

static void close_scene(hidden_scene *h)
{
    lines_release(&h->lines);
    stroke_view_destroy(&h->view);
    stroke_scene_release(&h->scene);
    pose_release(&h->at_rest);
    scene_free(h->source);
}

static visibility find(const hidden_scene *h, const window_segment *segments, size_t count)
{
    visibility out;
    lmn_error  error = {0};
    assert_int_equal(visibility_find(&out, h->view, segments, count, NULL, NULL, &error), LMN_OK);
    return out;
}

/* Each line is compared with each triangle that it meets. */
static visibility search_all(hidden_scene *h, const window_segment *segments, size_t count)
{
    window_box *kept = mem_copy(h->view->boxes, h->view->triangle_count * sizeof *kept), *own = h->view->boxes;
    uint32_t(*beyond)[3] = h->view->beyond;
    h->view->beyond = mem_alloc(h->view->triangle_count * sizeof *h->view->beyond);
    memset(h->view->beyond, 0xFF, h->view->triangle_count * sizeof *h->view->beyond);
    for (size_t i = 0; i < h->view->triangle_count; i++)
        kept[i].far_z = kept[i].inner_z = INFINITY;
    h->view->boxes = kept;
    const visibility out = find(h, segments, count);
    mem_free(h->view->beyond);
    h->view->beyond = beyond;
    h->view->boxes = own;
    mem_free(kept);
    return out;
}

/* Both ways say the same of all lines; returns how many fewer pairs are compared. */
static double hold_against_all(hidden_scene *h, uint32_t seed, const window_segment *segments, size_t count)
{
    visibility quick = find(h, segments, count), whole = search_all(h, segments, count);
    uint64_t   hidden = 0;
    for (size_t i = 0; i < count; i++) {
        const visibility_span *p = quick.spans + quick.starts[i], *q = whole.spans + whole.starts[i];
        const size_t           spans = quick.starts[i + 1] - quick.starts[i];
        if (spans != whole.starts[i + 1] - whole.starts[i])
            fail_msg("scene %u, line %zu: %zu stretches, not %u", seed, i, spans,
                     whole.starts[i + 1] - whole.starts[i]);
        for (size_t k = 0; k < spans; k++) {
            if (p[k].count != q[k].count || memcmp(&p[k].from, &q[k].from, sizeof p[k].from) != 0)
                fail_msg("scene %u, line %zu: %u in front from %g, not %u from %g", seed, i, p[k].count,
                         (double)p[k].from, q[k].count, (double)q[k].from);
            hidden += p[k].count > 0;
        }
    }
    assert_true(hidden > count / 8); /* else nothing was tried */
    const double share = (double)quick.pairs / (double)whole.pairs;
    visibility_release(&quick);
    visibility_release(&whole);
    return share;
}

static void all_ways_count_the_same(void **state)
{
    (void)state;
    for (uint32_t seed = 1; seed <= 16; seed++) {
        hidden_scene h;
        open_scene(&h, seed, seed % 3 != 0);
        hold_against_all(&h, seed, h.lines.segments, h.lines.count);
        hold_against_all(&h, seed, h.lines.segments, 24); /* few: their triangles' corners are not put together */
        hold_against_all(&h, seed, h.free, h.free_count);
        close_scene(&h);
    }
}

/* In parallel projection a line of the world is one of the page at the same fractions. */
static void rays_count_the_same(void **state)
{
    (void)state;
    size_t asked = 0, wrong = 0;
    for (uint32_t seed = 1; seed <= 8; seed++) {
        hidden_scene h;
        open_scene(&h, seed, true);
        visibility seen = find(&h, h.free, h.free_count);
        for (size_t i = 0; i < h.free_count; i++)
            for (uint32_t k = seen.starts[i]; k < seen.starts[i + 1]; k++) {
                const double from = seen.spans[k].from, to = k + 1 < seen.starts[i + 1] ? seen.spans[k + 1].from : 1,
                             at = 0.5 * (from + to);
                double   p[3];
                uint32_t count;
                if (to - from < 0.01)
                    continue;
                for (int c = 0; c < 3; c++)
                    p[c] = h.ends[i][0][c] + at * (h.ends[i][1][c] - h.ends[i][0][c]);
                stroke_view_count(h.view, (const double(*)[3])p, 1, &count);
                wrong += count != UINT32_MAX && count != seen.spans[k].count;
                asked++;
            }
        visibility_release(&seen);
        close_scene(&h);
    }
    if (asked < 2000 || wrong > 0)
        fail_msg("%zu of %zu stretches are not as a ray says", wrong, asked);
}

/* Lines behind a surface are compared with what is at its rim, and not with all of it. */
static void the_inside_of_surfaces_is_passed_by(void **state)
{
    (void)state;
    static const double origin[3] = {0, 0, 0};
    lmn_error           error = {0};
    hidden_scene        h = {.source = stroke_scene_begin()};
    const stroke_camera camera = look_along(0, 1, 0, origin, 8, 1.5, true, PAGE, PAGE);
    add_ball(h.source, 0, -2, 0, 1, 200, 100);
    assert_int_equal(scene_finish(h.source, "test", &error), LMN_OK);
    assert_int_equal(pose_create(&h.at_rest, h.source, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(stroke_scene_create(&h.scene, &h.at_rest, NULL, 0.5, NULL, NULL, &error), LMN_OK);
    assert_int_equal(stroke_view_create(&h.view, &h.scene, &camera, NULL, NULL, &error), LMN_OK);
    for (size_t i = 0; i < FREE_LINES; i++) {
        const double    up = 2.0 * (double)i / FREE_LINES - 1;
        window_segment *s = &h.free[h.free_count++];
        *s = (window_segment){.ends = {NO_VERTEX, NO_VERTEX}, .faces = {EDGE_NO_FACE, EDGE_NO_FACE}};
        assert_true(view_position(h.view, (double3){-1.2, 2, 0.9 * up}, &s->a) &&
                    view_position(h.view, (double3){1.2, 2, 0.9 * up + 0.01}, &s->b));
    }
    const double share = hold_against_all(&h, 0, h.free, h.free_count);
    if (share > 0.1)
        fail_msg("%g of all pairs are compared", share);
    close_scene(&h);
}

/* What the filter finds depends on no processor. */
static void wide_registers_find_the_same(void **state)
{
    (void)state;
    enum { RUN = 200 };
    hidden_scene h;
    grid_corners corners;
    size_t       found = 0;
    open_scene(&h, 1, true);
    assert_true(grid_corners_make(&corners, h.view));
    const size_t count = h.view->grid.entry_count + h.view->grid.sub_entry_count;
    for (size_t i = 0; i < h.free_count && line_filter_is_wide(); i++) {
        const line_test test = line_test_of(&h.free[i], h.view->units);
        for (size_t begin = 0; begin < count; begin += RUN) {
            uint16_t     plain[RUN], wide[RUN];
            const size_t run = count - begin < RUN ? count - begin : RUN,
                         n = line_filter(&corners, &test, false, begin, run, plain);
            assert_int_equal(line_filter(&corners, &test, true, begin, run, wide), n);
            assert_memory_equal(plain, wide, n * sizeof *plain);
            found += n;
        }
    }
    assert_true(found > 0 || !line_filter_is_wide());
    grid_corners_release(&corners);
    close_scene(&h);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(all_ways_count_the_same),
        cmocka_unit_test(rays_count_the_same),
        cmocka_unit_test(the_inside_of_surfaces_is_passed_by),
        cmocka_unit_test(wide_registers_find_the_same),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
