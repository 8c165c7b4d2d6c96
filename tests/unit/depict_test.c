/* Glyphs against the motion that they tell, which is known in closed form: a ball that falls and bounces. Nienhaus
 * 2005, sections 7.6 to 7.8; rows D08 to D11 and D13 to D16. */
#include "depict_support.h"

#include "../support/moving_scene.h"
#include "depict/depict.h"
#include "depict/depict_private.h"
#include "limner/content.h"
#include "limner/depict.h"

static const double red[3] = {0.8, 0.1, 0.1}, grey[3] = {0.5, 0.5, 0.5}, gravity = 9.81, radius = 0.5, height = 4,
                    forward = 2;

/* --- the ball --------------------------------------------------------------------------------------------------- */

static double contact_time(void)
{
    return sqrt(2 * (height - radius) / gravity);
}

enum { LOSS = 80 }; /* of the speed, a hundred times what is left */

static double rise_time(void)
{
    return 2 * contact_time() * LOSS / 100;
}

/* Its middle. */
static void ball_at(double t, double out[3])
{
    double down = contact_time(), up = gravity * down * LOSS / 100, s = t - down;
    out[0] = forward * t;
    out[1] = t < down ? height - gravity / 2 * t * t : radius + up * s - gravity / 2 * s * s;
    out[2] = 0;
}

static lmn_scene *ball_scene(const char *name, bool moves)
{
    moving_scene m;
    char         path[256];
    const double half[3] = {8, 0.1, 2}, down = contact_time(), end = down + rise_time(), hit = gravity * down,
                 off = hit * LOSS / 100;
    moving_scene_begin(&m);
    int ground = moving_scene_box(&m, 4, -0.1, 0, half, grey),
        ball = moving_scene_sphere(&m, 0, height, 0, radius, red);
    moving_scene_name(&m, ground, "ground");
    moving_scene_name(&m, ball, "ball");
    const double times[3] = {0, down, end};
    const double values[27] = {forward, 0,    0,       0,
                               height,  0,    forward, 0,
                               0, /* falls */
                               forward, -hit, 0,       forward * down,
                               radius,  0,    forward, off,
                               0, /* bounces */
                               forward, -off, 0,       forward * end,
                               radius,  0,    forward, -off,
                               0};
    const double still[6] = {0, height, 0, 0, height, 0};
    if (moves)
        moving_scene_cubic_keys(&m, ball, "translation", 3, times, values);
    else
        moving_scene_keys(&m, ball, "translation", 2, times, still);
    snprintf(path, sizeof path, "%s/%s", temp_folder(), name);
    moving_scene_write(&m, path);
    return load_or_fail(path);
}

static lmn_status tell(lmn_scene *scene, const char *expressions, double seconds, char **json, lmn_error *error)
{
    lmn_draw_desc   draw = seen_at(seconds);
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    desc.expressions = expressions;
    return lmn_depict(scene, &draw, &desc, json, error);
}

static void tell_or_fail(lmn_scene *scene, const char *expressions, double seconds, char **json)
{
    lmn_error error = {0};
    if (tell(scene, expressions, seconds, json, &error) != LMN_OK)
        fail_msg("%s: %s", expressions, error.message);
}

/* --- what was put into the scene --------------------------------------------------------------------------------- */

static void middle_of(const primitive *p, double out[3])
{
    double low[3] = {INFINITY, INFINITY, INFINITY}, high[3] = {-INFINITY, -INFINITY, -INFINITY}, at[3];
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        position(p, i, at);
        for (int k = 0; k < 3; k++) {
            low[k] = fmin(low[k], at[k]);
            high[k] = fmax(high[k], at[k]);
        }
    }
    vector3_mix(out, low, high, 0.5);
}

static double volume_of(const primitive *p)
{
    double volume = 0, a[3], b[3], c[3], n[3];
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        position(p, p->indices[i], a);
        position(p, p->indices[i + 1], b);
        position(p, p->indices[i + 2], c);
        vector3_cross(n, b, c);
        volume += vector3_dot(a, n) / 6;
    }
    return volume;
}

/* A sum that another shape of any glyph changes. */
static uint64_t glyphs_hash(const lmn_scene *s)
{
    uint64_t hash = 1469598103934665603u;
    for (size_t i = 0; i < s->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        if (n->mesh == NONE || !*value_of(n, "glyph"))
            continue;
        const primitive     *p = placed_glyph(s, n);
        const unsigned char *bytes = (const unsigned char *)p->positions;
        for (size_t k = 0; k < p->vertex_count * sizeof *p->positions; k++)
            hash = (hash ^ bytes[k]) * 1099511628211u;
        bytes = (const unsigned char *)&s->materials[p->material].base_colour;
        for (size_t k = 0; k < sizeof(vec4); k++)
            hash = (hash ^ bytes[k]) * 1099511628211u;
        hash = (hash ^ (unsigned char)*value_of(n, "sketchy")) * 1099511628211u;
    }
    return hash;
}

/* Pieces of a mesh that share no vertices. */
static size_t pieces_of(const primitive *p)
{
    uint32_t *root = malloc(p->vertex_count * sizeof *root);
    size_t    pieces = 0;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        root[i] = i;
    for (int round = 0; round < 64; round++)
        for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
            uint32_t least = root[p->indices[i]];
            for (int k = 1; k < 3; k++)
                least = root[p->indices[i + (uint32_t)k]] < least ? root[p->indices[i + (uint32_t)k]] : least;
            for (int k = 0; k < 3; k++)
                root[p->indices[i + (uint32_t)k]] = least;
        }
    for (uint32_t i = 0; i < p->vertex_count; i++)
        pieces += root[i] == i;
    free(root);
    return pieces;
}

/* --- tests ---------------------------------------------------------------------------------------------------------
 */

static void trajectories_are_the_motion(void **state)
{
    (void)state;
    lmn_scene *scene = ball_scene("way.glb", true);
    moment     when = moment_at_rest();
    lmn_error  error;
    way        w;
    trajectory t;
    double     at[3], velocity[3], local[3] = {0, 0, 0};
    when.clips[when.clip_count++] = 0;
    assert_int_equal(way_open(&w, scene, depict_find_node(scene, "ball"), &when, &error), LMN_OK);
    assert_int_equal(way_trajectory(&t, &w, local, 0, contact_time() + rise_time(), 0.002, &error), LMN_OK);
    bool bounced = false;
    for (size_t i = 0; i < t.count; i++) {
        ball_at(t.samples[i].seconds, at);
        assert_near(vector3_distance(at, t.samples[i].position), 0, 2e-5);
        bounced = bounced || fabs(t.samples[i].seconds - contact_time()) < 1e-6;
    }
    assert_true(bounced); /* keys are samples */
    for (size_t i = 1; i < t.count; i++) {
        double middle[3], chord[3];
        ball_at((t.samples[i - 1].seconds + t.samples[i].seconds) / 2, middle);
        vector3_mix(chord, t.samples[i - 1].position, t.samples[i].position, 0.5);
        assert_near(vector3_distance(middle, chord), 0, 0.004);
    }
    way_velocity(&w, local, 0.4, 0.01, velocity);
    assert_near(velocity[0], forward, 1e-4);
    assert_near(velocity[1], -gravity * 0.4, 1e-3);
    trajectory_release(&t);
    way_release(&w);
    lmn_scene_destroy(&scene);
}

static void impacts_are_found_where_they_are(void **state)
{
    (void)state;
    lmn_scene    *scene = ball_scene("impact.glb", true);
    depict_poses  poses = {.count = 0};
    depict_job    job = {.scene = scene, .poses = &poses, .size = 10};
    lmn_error     error;
    depict_target t;
    depict_impact found[4];
    size_t        count;
    double        contact[3];
    job.when.clips[job.when.clip_count++] = 0;
    assert_int_equal(target_open(&t, &job, depict_find_node(scene, "ball"), &error), LMN_OK);
    assert_int_equal(target_impacts(found, 4, &count, &t, 0, contact_time() + rise_time(), &error), LMN_OK);
    assert_int_equal(count, 1); /* tops of parabolas are none */
    assert_near(found[0].time, contact_time(), 1e-6);
    assert_near(found[0].change[1], gravity * contact_time() * (1 + LOSS / 100.0), 0.05);
    assert_int_equal(impact_contact(contact, &job, &t, &found[0], &error), LMN_OK);
    assert_near(contact[0], forward * contact_time(), 1e-4);
    assert_near(contact[1], 0, 1e-4);
    target_release(&t);
    depict_poses_release(&poses);
    lmn_scene_destroy(&scene);
}

/* Both sides of a ribbon are as far from the way as half of its breadth says. */
static void check_arrow(const primitive *p, double from, double to, double breadth)
{
    assert_non_null(p);
    double farthest = 0, along = INFINITY, last = -INFINITY;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        double at[3], best = INFINITY, when = 0, way[3];
        position(p, i, at);
        for (int k = 0; k <= 4000; k++) {
            double t = from + (to - from) * k / 4000;
            ball_at(t, way);
            if (vector3_distance(at, way) < best) {
                best = vector3_distance(at, way);
                when = t;
            }
        }
        farthest = fmax(farthest, best);
        along = fmin(along, when);
        last = fmax(last, when);
    }
    /* The head is 2.6 times as broad; corners are mitred. */
    assert_true(farthest <= breadth * 1.4);
    assert_near(along, from, 0.02);
    assert_true(last > to - 0.35 * (to - from));
}

static void arrows_follow_the_way(void **state)
{
    (void)state;
    const double now = 1.2, end = contact_time() + rise_time(), breadth = 0.25 * radius;
    lmn_scene   *scene = ball_scene("arrow.glb", true);
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"path\"}]", now, NULL);
    const primitive *past = glyph_at(scene, "arrow", "past", 0), *future = glyph_at(scene, "arrow", "future", 0);
    check_arrow(past, 0, now, breadth);
    check_arrow(future, now, end, breadth);
    /* Dashes are of the future alone: a piece each, and the head. */
    assert_int_equal(pieces_of(past), 1);
    assert_true(pieces_of(future) >= 4);
    assert_null(glyph_at(scene, "arrow", "present", 0));
    /* Middles of the past ribbon lie on the way, within a hundredth of the radius. */
    for (uint32_t i = 0; i + 1 < past->vertex_count; i += 2) {
        double a[3], b[3], middle[3], best = INFINITY, way[3];
        position(past, i, a);
        position(past, i + 1, b);
        vector3_mix(middle, a, b, 0.5);
        for (int k = 0; k <= 8000; k++) {
            ball_at(now * k / 8000, way);
            best = fmin(best, vector3_distance(middle, way));
        }
        /* Where it hits the ground the way has a corner, and the arrow a turn that its breadth can go round. */
        ball_at(contact_time(), way);
        if (vector3_distance(middle, way) > 3 * breadth)
            assert_near(best, 0, 0.012 * radius);
        else
            assert_near(best, 0, 1.2 * breadth);
    }
    /* All future: no past arrow. */
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"path\", \"now\": 0}]", now, NULL);
    assert_null(glyph_at(scene, "arrow", "past", 0));
    lmn_scene_destroy(&scene);
}

/* A viewer who looks askance, and where a page of 1024 pixels shows a place: written anew here. */
static const double eye[3] = {9, 7, 11}, seen[3] = {2, 1, 0}, page = 1024, fov = 30;

static void on_page(const double at[3], double out[2])
{
    double forwards[3], right[3], up[3], to[3];
    vector3_add(forwards, seen, -1, eye);
    vector3_normalise(forwards);
    vector3_cross(right, forwards, (double[3]){0, 1, 0});
    vector3_normalise(right);
    vector3_cross(up, right, forwards);
    vector3_add(to, at, -1, eye);
    const double scale = page / 2 / (vector3_dot(to, forwards) * tan(fov / 2 * acos(-1) / 180));
    out[0] = vector3_dot(to, right) * scale;
    out[1] = vector3_dot(to, up) * scale;
}

/* How far a place of the page is from the way between two times, as it is seen, in pixels. */
static double off_way(const double at[2], double from, double to)
{
    enum { STEPS = 2000 };
    double best = INFINITY, last[2] = {0, 0};
    for (int i = 0; i <= STEPS; i++) {
        double way[3], now[2];
        ball_at(from + (to - from) * i / STEPS, way);
        on_page(way, now);
        if (i > 0) {
            const double x = now[0] - last[0], y = now[1] - last[1], length = x * x + y * y,
                         f = ((at[0] - last[0]) * x + (at[1] - last[1]) * y) / length, g = fmin(fmax(f, 0), 1);
            best = fmin(best, hypot(at[0] - last[0] - g * x, at[1] - last[1] - g * y));
        }
        last[0] = now[0];
        last[1] = now[1];
    }
    return best;
}

/* How far a place of the page is from the corner that the way has where the ball hits the ground, in the arrow's
 * breadths there. */
static double from_contact(const double at[2])
{
    double way[3], there[2], beside[2], right[3], to[3];
    ball_at(contact_time(), way);
    on_page(way, there);
    vector3_add(to, seen, -1, eye);
    vector3_cross(right, to, (double[3]){0, 1, 0});
    vector3_normalise(right);
    vector3_add(way, way, 0.25 * radius, right);
    on_page(way, beside);
    return hypot(at[0] - there[0], at[1] - there[1]) / hypot(beside[0] - there[0], beside[1] - there[1]);
}

/* The middle of the ribbon that is seen lies within a pixel of the way that is seen, between its vertices, too, up to
 * the impact; and so does one that is lifted before all. */
static void arrows_lie_on_the_way_that_is_seen(void **state)
{
    (void)state;
    const double  now = 1.2, end = contact_time() + rise_time();
    lmn_scene    *scene = ball_scene("page.glb", true);
    lmn_draw_desc draw = LMN_DRAW_DESC_INIT;
    draw.eye_given = true;
    draw.fov_deg = fov;
    draw.time_given = true;
    draw.time_s = now;
    draw.width = draw.height = (uint32_t)page;
    memcpy(draw.eye, eye, sizeof eye);
    memcpy(draw.target, seen, sizeof seen);
    vector3_set(draw.up, 0, 1, 0);
    for (int before = 0; before < 2; before++) {
        size_t checked = 0;
        double nearest = INFINITY;
        tell_as(scene, &draw,
                before ? "[{\"target\": \"ball\", \"depict\": \"path\", \"before\": true}]"
                       : "[{\"target\": \"ball\", \"depict\": \"path\"}]",
                NULL);
        for (int tense = 0; tense < 2; tense++) {
            const primitive *p = glyph_at(scene, "arrow", tense ? "future" : "past", 0);
            double           last[2] = {0, 0}, middle[3], at[2];
            assert_non_null(p);
            for (uint32_t i = 0; 2 * i + 1 < p->vertex_count; i++) {
                ribbon_point(p, i, middle);
                on_page(middle, at);
                const double halfway[2] = {(at[0] + last[0]) / 2, (at[1] + last[1]) / 2};
                /* Heads are straight; pieces are near each other, and dashes are not. */
                const bool is_head = tense && i + 2 >= p->vertex_count / 2,
                           joined = i > 0 && hypot(at[0] - last[0], at[1] - last[1]) < 12;
                const double corner = from_contact(at);
                nearest = fmin(nearest, corner);
                if (!is_head && off_way(at, 0, end) > 1)
                    fail_msg("%s %u: %.3g pixels off, %.3g breadths from the impact", tense ? "future" : "past", i,
                             off_way(at, 0, end), corner);
                if (!is_head && joined && off_way(halfway, 0, end) > 1)
                    fail_msg("%s behind %u: %.3g pixels off, %.3g breadths from the impact", tense ? "future" : "past",
                             i, off_way(halfway, 0, end), corner);
                memcpy(last, at, sizeof last);
                checked++;
            }
        }
        assert_true(checked > 20);
        /* It goes to within 3 breadths of the impact, where the ways there and back have room beside each other. */
        if (nearest > 3)
            fail_msg("it comes no nearer to the impact than %.3g breadths", nearest);
    }
    lmn_scene_destroy(&scene);
}

static void ghosts_are_where_they_were(void **state)
{
    (void)state;
    lmn_scene *scene = ball_scene("ghost.glb", true);
    double     at[3], middle[3], rest = 4 * 3.14159265 / 3 * radius * radius * radius;
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"still\", \"count\": 4}]", 0.5, NULL);
    ball_at(0.5, at);
    middle_of(glyph_at(scene, "still", "present", 0), middle);
    assert_near(vector3_distance(at, middle), 0, 1e-4);
    ball_at(0, at);
    middle_of(glyph_at(scene, "still", "past", 0), middle);
    assert_near(vector3_distance(at, middle), 0, 1e-4);
    /* Of the future the end, and where it meets the ground. */
    bool met = false;
    for (size_t i = 0; glyph_at(scene, "still", "future", i); i++) {
        middle_of(glyph_at(scene, "still", "future", i), middle);
        ball_at(contact_time(), at);
        met = met || vector3_distance(at, middle) < 1e-4;
    }
    assert_true(met);
    double round = volume_of(glyph_at(scene, "still", "present", 0));
    assert_near(round / rest, 1, 0.05); /* a ball of facets */
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"still\", \"count\": 4, \"stretch\": 1}]", 0.5, NULL);
    size_t flat = 0, seen = 0;
    for (; glyph_at(scene, "still", NULL, seen); seen++) {
        const primitive *p = glyph_at(scene, "still", NULL, seen);
        double           low = INFINITY, high = -INFINITY, v[3];
        assert_near(volume_of(p) / round, 1, 1e-3);
        for (uint32_t i = 0; i < p->vertex_count; i++) {
            position(p, i, v);
            low = fmin(low, v[1]);
            high = fmax(high, v[1]);
        }
        /* On the ground it is flat, and stays on it. */
        if (high - low < 1.6 * radius) {
            flat++;
            assert_near(low, 0, 0.02 * radius);
        }
    }
    assert_int_equal(seen, 4);
    assert_int_equal(flat, 1);
    lmn_scene_destroy(&scene);
}

/* Split at equal times: of what falls from rest the pieces grow by odd numbers. */
static void split_ways_grow_with_speed(void **state)
{
    (void)state;
    enum { PIECES = 4 };
    lmn_scene *scene = ball_scene("split.glb", true);
    char       text[256];
    double     last = 0;
    snprintf(text, sizeof text,
             "[{\"target\": \"ball\", \"depict\": \"path\", \"from\": 0, \"to\": %.9f, \"now\": 2, \"pieces\": %d}]",
             contact_time(), PIECES);
    tell_or_fail(scene, text, 2, NULL);
    for (size_t i = 0; i < PIECES; i++) {
        const primitive *p = glyph_at(scene, "arrow", "past", i);
        double           low = INFINITY, high = -INFINITY, v[3], from[3], to[3];
        assert_non_null(p);
        for (uint32_t k = 0; k < p->vertex_count; k++) {
            position(p, k, v);
            low = fmin(low, v[1]);
            high = fmax(high, v[1]);
        }
        ball_at(contact_time() * (double)i / PIECES, from);
        ball_at(contact_time() * (double)(i + 1) / PIECES, to);
        assert_near(low, to[1], 0.25 * radius);
        assert_near(high, from[1], 0.25 * radius);
        assert_true(high - low > last);
        last = high - low;
    }
    assert_null(glyph_at(scene, "arrow", "past", PIECES));
    lmn_scene_destroy(&scene);
}

/* A ball that skims over a ground, which it touches at (4, 0, 0) after a second: 8 forward and 2 down a second, and up.
 */
static lmn_scene *skimming_scene(void)
{
    moving_scene m;
    char         path[256];
    moving_scene_begin(&m);
    const int ground = moving_scene_box(&m, 4, -0.1, 0, (double[]){12, 0.1, 2}, grey),
              ball = moving_scene_sphere(&m, -4, 2.5, 0, radius, red);
    moving_scene_name(&m, ground, "ground");
    moving_scene_name(&m, ball, "ball");
    moving_scene_keys(&m, ball, "translation", 3, (double[]){0, 1, 2}, (double[]){-4, 2.5, 0, 4, 0.5, 0, 12, 2.5, 0});
    snprintf(path, sizeof path, "%s/skims.glb", temp_folder());
    moving_scene_write(&m, path);
    return load_or_fail(path);
}

/* Joined with the star where it hit the ground, lines begin there; else they go on through it. */
static void lines_end_at_the_impact_that_is_told(void **state)
{
    (void)state;
    lmn_scene *scene = skimming_scene();
    double     low[2] = {INFINITY, INFINITY}, p[3];
    for (int joined = 0; joined < 2; joined++) {
        tell_or_fail(scene,
                     joined ? "[{\"target\": \"ball\", \"depict\": \"motion\", \"seconds\": 0.6}, {\"target\": "
                              "\"ball\", \"depict\": \"collision\"}]"
                            : "[{\"target\": \"ball\", \"depict\": \"motion\", \"seconds\": 0.6}]",
                     1.2, NULL);
        const primitive *lines = glyph_at(scene, "motion-lines", NULL, 0);
        assert_non_null(lines);
        for (uint32_t i = 0; i < lines->vertex_count; i++) {
            position(lines, i, p);
            low[joined] = fmin(low[joined], p[0]);
        }
    }
    assert_true(low[0] < 8 * (1.2 - 0.6 + 0.1) - 4); /* 0.6 s back, and a bit less for some */
    assert_true(low[1] > 4 - 1.1 * radius);
    lmn_scene_destroy(&scene);
}

static void lines_trail_behind(void **state)
{
    (void)state;
    lmn_scene   *scene = ball_scene("lines.glb", true);
    const double now = 0.5;
    double       at[3], way[3] = {forward, -gravity * now, 0}, p[3];
    vector3_normalise(way);
    ball_at(now, at);
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"motion\"}]", now, NULL);
    const primitive *lines = glyph_at(scene, "motion-lines", NULL, 0);
    assert_non_null(lines);
    for (uint32_t i = 0; i < lines->vertex_count; i++) {
        position(lines, i, p);
        vector3_add(p, p, -1, at);
        assert_true(vector3_dot(p, way) < 0.1 * radius); /* none ahead of the middle */
    }
    assert_true(pieces_of(lines) >= 12);
    /* At the very beginning it has come from nowhere. */
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"motion\", \"now\": 0}]", now, NULL);
    assert_null(glyph_at(scene, "motion-lines", NULL, 0));
    lmn_scene_destroy(&scene);
}

/* The vertex behind those of the piece that begins at one: pieces lie one behind the other. */
static uint32_t piece_end(const primitive *p, uint32_t first)
{
    uint32_t end = first + 1;
    for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
        bool     own = false;
        uint32_t high = 0;
        for (uint32_t k = i; k < i + 3; k++) {
            own = own || (p->indices[k] >= first && p->indices[k] < end);
            high = p->indices[k] > high ? p->indices[k] : high;
        }
        end = own && high + 1 > end ? high + 1 : end;
    }
    return end;
}

/* Lines begin at the outermost places: of a ball that is looked at from the side, on its circle, at the rear, spread
 * over all of its breadth; more strokes lie beside them, each time elsewhere. */
static void lines_begin_at_the_rear_of_the_outline(void **state)
{
    (void)state;
    enum { LINES = 7 };
    lmn_scene   *scene = ball_scene("rear.glb", true);
    const double now = 0.5;
    double       at[3], way[3] = {forward, -gravity * now, 0}, low = INFINITY, high = -INFINITY;
    vector3_normalise(way);
    ball_at(now, at);
    tell_or_fail(
        scene,
        "[{\"target\": \"ball\", \"depict\": \"motion\", \"count\": 7, \"gap\": 0, \"strokes\": 0, \"jitter\": "
        "0}]",
        now, NULL);
    const primitive *lines = glyph_at(scene, "motion-lines", NULL, 0);
    assert_non_null(lines);
    assert_int_equal(pieces_of(lines), LINES);
    for (uint32_t i = 0, next = 0; i < lines->vertex_count; i++) {
        double p[3], q[3];
        if (i != next)
            continue;
        next = piece_end(lines, i);
        position(lines, i, p);
        position(lines, i + 1, q);
        vector3_mix(p, p, q, 0.5);
        vector3_add(p, p, -1, at);
        const double along = vector3_dot(p, way), aside = p[1] * way[0] - p[0] * way[1];
        assert_near(vector3_length(p), radius, 0.03 * radius);
        assert_near(along, -sqrt(fmax(radius * radius - aside * aside, 0)), 0.2 * radius);
        low = fmin(low, aside);
        high = fmax(high, aside);
    }
    assert_true(low < -0.6 * radius && high > 0.6 * radius);
    tell_or_fail(
        scene,
        "[{\"target\": \"ball\", \"depict\": \"motion\", \"count\": 7, \"gap\": 0, \"strokes\": 2, \"jitter\": "
        "0.5}]",
        now, NULL);
    lines = glyph_at(scene, "motion-lines", NULL, 0);
    assert_int_equal(pieces_of(lines), 3 * LINES);
    for (uint32_t i = 0; i < lines->vertex_count; i = piece_end(lines, i)) {
        double p[3], q[3];
        position(lines, i, p);
        position(lines, i + 1, q);
        vector3_mix(p, p, q, 0.5);
        assert_true(vector3_distance(p, at) < radius * (1 + 0.5 * 0.4 * sqrt(3)));
    }
    lmn_scene_destroy(&scene);
}

/* Corners of a square, again and again, or farther out with each lap. */
static lmn_scene *laps_scene(int laps, double outward)
{
    enum { LAPS_MOST = 400 };
    static double times[4 * LAPS_MOST + 1], values[3 * (4 * LAPS_MOST + 1)];
    moving_scene  m;
    moving_scene_begin(&m);
    int ball = moving_scene_sphere(&m, 0, 0, 0, 0.2, red);
    moving_scene_name(&m, ball, "ball");
    for (int i = 0; i <= 4 * laps; i++) {
        const double far = 2 + outward * i / 4;
        times[i] = i / 4.0;
        values[3 * i] = i % 4 == 1 || i % 4 == 2 ? far : -far;
        values[3 * i + 1] = i % 4 >= 2 ? far : -far;
        values[3 * i + 2] = 0;
    }
    moving_scene_keys(&m, ball, "translation", 4 * laps + 1, times, values);
    char path[256];
    snprintf(path, sizeof path, "%s/laps.glb", temp_folder());
    moving_scene_write(&m, path);
    return load_or_fail(path);
}

/* Where ways lie on each other there is one arrow: the last lap up to now, and the next one. */
static void laps_are_told_once(void **state)
{
    (void)state;
    static const char text[] = "[{\"target\": \"ball\", \"depict\": \"path\", \"short_of\": 0}]";
    uint32_t          vertices[2];
    for (int i = 0; i < 2; i++) {
        lmn_scene *scene = laps_scene(i ? 400 : 4, 0);
        tell_at(scene, i ? 201.3 : 2.3, text);
        const primitive *past = sign_at(scene, "arrow", 0), *future = sign_at(scene, "arrow", 1);
        assert_true(past && future);
        vertices[i] = past->vertex_count + future->vertex_count;
        for (int k = 0; k < 2; k++) { /* all four sides are there */
            double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY}, at[3];
            for (uint32_t v = 0; v < (k ? future : past)->vertex_count; v++) {
                position(k ? future : past, v, at);
                for (int a = 0; a < 2; a++) {
                    low[a] = fmin(low[a], at[a]);
                    high[a] = fmax(high[a], at[a]);
                }
            }
            for (int a = 0; a < 2; a++)
                assert_true(low[a] < -1.9 && high[a] > 1.9);
        }
        lmn_scene_destroy(&scene);
    }
    assert_int_equal(vertices[0], vertices[1]);
    lmn_scene *spiral = laps_scene(4, 0.5);
    double     at[3], far = 0;
    tell_at(spiral, 2.3, text);
    const primitive *past = sign_at(spiral, "arrow", 0);
    for (uint32_t v = 0; v < past->vertex_count; v++) {
        position(past, v, at);
        far = fmax(far, hypot(at[0] + 2, at[1] + 2) < 0.1);
    }
    assert_true(far > 0); /* from its very beginning: each lap goes elsewhere */
    lmn_scene_destroy(&spiral);
}

static void targets_are_hidden_for_their_ghosts(void **state)
{
    (void)state;
    lmn_scene    *scene = ball_scene("hidden.glb", true);
    const int32_t ball = depict_find_node(scene, "ball");
    const size_t  parts = scene->part_count;
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"path\"}]", 1, NULL);
    assert_false(scene->nodes[ball].hidden); /* an arrow stands for nothing */
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"still\"}]", 1, NULL);
    assert_true(scene->nodes[ball].hidden);
    assert_null(glyph_at(scene, "arrow", NULL, 0)); /* of the call before */
    assert_int_equal(lmn_depict_clear(scene, NULL), LMN_OK);
    assert_false(scene->nodes[ball].hidden);
    assert_int_equal(scene->part_count, parts);
    /* What somebody else has hidden stays so. */
    scene->nodes[ball].hidden = true;
    tell_or_fail(scene, "[{\"target\": \"ball\", \"depict\": \"still\"}]", 1, NULL);
    assert_int_equal(lmn_depict_clear(scene, NULL), LMN_OK);
    assert_true(scene->nodes[ball].hidden);
    lmn_scene_destroy(&scene);
}

/* Another value than the default. */
static void other_value(const param *p, char *out, size_t size)
{
    double most = p->soft_max != 0 ? p->soft_max : p->max;
    if (p->type == PARAM_BOOL)
        snprintf(out, size, "%s", p->def != 0 ? "false" : "true");
    else if (p->type == PARAM_COLOUR)
        snprintf(out, size, "\"#123456\"");
    else
        snprintf(out, size, p->type == PARAM_INT ? "%.0f" : "%g", p->def == most ? p->min : most);
}

static void every_option_changes_the_glyphs(void **state)
{
    (void)state;
    lmn_scene *scene = ball_scene("options.glb", true);
    int        options = 0;
    for (size_t d = 0; depictions[d]; d++) {
        const depiction *row = depictions[d];
        if (row->semantics || (strcmp(row->characteristic, "path") != 0 && strcmp(row->characteristic, "still") != 0 &&
                               strcmp(row->characteristic, "motion") != 0))
            continue; /* others have tests of their own */
        for (size_t k = 0; k < row->param_count; k++) {
            char plain[256], set[320], value[64];
            if (strcmp(row->params[k].key, "least") == 0)
                continue; /* of a thing without limbs all goes as far: depict_drawn_test has it */
            other_value(&row->params[k], value, sizeof value);
            const char *more = strcmp(row->characteristic, "still") == 0 ? ", \"stretch\": 0.3" : "";
            if (strcmp(row->params[k].key, "stretch") == 0 || strcmp(row->params[k].key, "count") == 0)
                more = "";
            snprintf(plain, sizeof plain, "[{\"target\": \"ball\", \"depict\": \"%s\"%s%s}]", row->characteristic, more,
                     strcmp(row->characteristic, "still") == 0 && strcmp(row->params[k].key, "count") != 0
                         ? ", \"count\": 3"
                         : "");
            tell_or_fail(scene, plain, 1, NULL);
            uint64_t before = glyphs_hash(scene);
            snprintf(set, sizeof set, "%.*s, \"%s\": %s}]", (int)strlen(plain) - 2, plain, row->params[k].key, value);
            tell_or_fail(scene, set, 1, NULL);
            if (glyphs_hash(scene) == before)
                fail_msg("%s.%s changes nothing", row->characteristic, row->params[k].key);
            options++;
        }
    }
    assert_true(options > 12);
    lmn_scene_destroy(&scene);
}

static void expressions_come_back_as_they_were(void **state)
{
    (void)state;
    lmn_scene *scene = ball_scene("round.glb", true);
    char      *first = NULL, *second = NULL;
    tell_or_fail(
        scene,
        "[{\"target\": \"ball\", \"depict\": \"path\", \"from\": 0.25, \"to\": 1.5, \"now\": 0.75, \"width\": 0.5, "
        "\"colour\": \"#102030\"}, {\"target\": \"ball\", \"depict\": \"still\", \"count\": 3, \"sketchy\": true}]",
        1, &first);
    uint64_t hash = glyphs_hash(scene);
    json_t  *root = json_loads(first, 0, NULL);
    assert_int_equal(json_array_size(json_object_get(root, "expressions")), 2);
    char *array = json_dumps(json_object_get(root, "expressions"), JSON_REAL_PRECISION(17));
    tell_or_fail(scene, array, 1, &second);
    assert_string_equal(first, second);
    assert_int_equal(glyphs_hash(scene), hash);
    free(array);
    json_decref(root);
    lmn_text_free(first);
    lmn_text_free(second);
    lmn_scene_destroy(&scene);
}

static void proposals_follow_from_the_motion(void **state)
{
    (void)state;
    lmn_scene *scene = ball_scene("proposed.glb", true), *still = ball_scene("rest.glb", false);
    char      *json = NULL;
    tell_or_fail(scene, NULL, 1, &json);
    assert_non_null(strstr(json, "\"path\""));
    assert_non_null(strstr(json, "\"still\""));
    assert_null(strstr(json, "\"target\": \"ground\"")); /* it does not move */
    assert_non_null(strstr(json, "\"partner\": \"ground\""));
    assert_null(strstr(json, "turnaround"));
    lmn_text_free(json);
    tell_or_fail(still, NULL, 0.5, &json);
    json_t *root = json_loads(json, 0, NULL);
    assert_int_equal(json_array_size(json_object_get(root, "expressions")), 0);
    json_decref(root);
    lmn_text_free(json);
    lmn_scene_destroy(&scene);
    lmn_scene_destroy(&still);
}

static void mistakes_are_said(void **state)
{
    (void)state;
    static const struct {
        const char *text, *said;
        int         line, column;
    } rows[] = {
        {"[", "expressions: ", 1, 1},
        {"{}", "no expressions", 1, 1},
        {"[1]", "expression 1: an expression is an object", 1, 2},
        {"[{}]", "\"target\"", 1, 2},
        {"[{\"target\": \"nobody\", \"depict\": \"path\"}]", "nobody", 1, 3},
        {"[{\"target\": \"#99\", \"depict\": \"path\"}]", "#99", 1, 3},
        {"[{\"target\": \"ball\"}]", "\"depict\"", 1, 2},
        {"[{\"target\": \"ball\", \"depict\": \"paht\"}]", "paht", 1, 21},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"from\": 2, \"to\": 1}]", "interval", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"from\": 1, \"to\": 1}]", "interval is empty", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"to\": 0}]", "interval is empty", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"from\": 50, \"to\": 60}]", "behind the end", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"from\": -1}]", "from", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"from\": \"now\"}]", "from", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"width\": \"wide\"}]", "width", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"width\": 1e9}]", "width", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"breadth\": 1}]", "breadth", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"partner\": \"nobody\"}]", "nobody", 1, 39},
        {"[{\"target\": \"ball\", \"depict\": \"path\"},\n {\"target\": \"ball\", \"depict\": \"cause\"}]",
         "expression 2, 'cause' of 'ball': ", 2, 2},
        {"{\"a\": 1,\n\"expressions\": [{\"target\": \"ball\",\n \"depict\": \"path\", \"gap\": -1}]}",
         "expression 1: gap", 3, 20},
        {"[{\"target\": \"ball\", \"depict\": \"speech\", \"text\": \"a\\u0085\"}]", "control characters", 1, 41},
        {"[{\"target\": \"ball\", \"depict\": \"speech\", \"text\": \"a\\u202eb\"}]", "control characters", 1, 41},
        {"[{\"target\": \"ball\", \"depict\": \"speech\", \"text\": \"\\ufeff\"}]", "control characters", 1, 41},
        {"[{\"target\": \"ball\", \"depict\": \"speech\", \"text\": \"   \"}]", "nothing of the text can be seen", 1,
         2},
        {"[{\"target\": \"ball\", \"depict\": \"thought\", \"text\": \"\"}]", "nothing of the text can be seen", 1, 2},
    };
    lmn_scene *scene = ball_scene("bad.glb", true);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_error error = {0};
        assert_int_equal(tell(scene, rows[i].text, 1, NULL, &error), LMN_FORMAT);
        if (!strstr(error.message, rows[i].said) || error.line != rows[i].line || error.column != rows[i].column)
            fail_msg("%s: %d:%d: %s", rows[i].text, error.line, error.column, error.message);
        assert_null(glyph_at(scene, "arrow", NULL, 0));
    }
    lmn_scene_destroy(&scene);
}

/* An editor finds the parameters of all ways to depict, with what they are set to where nobody says it. */
static void parameters_are_listed(void **state)
{
    (void)state;
    lmn_depiction_info way;
    lmn_param_info     p;
    for (size_t i = 0; lmn_depiction_at(i, &way); i++) {
        for (size_t k = 0; k < way.param_count; k++) {
            assert_true(lmn_depiction_param_at(i, k, &p));
            assert_string_equal(p.key, depictions[i]->params[k].key);
            assert_true(p.doc[0] && (p.type == LMN_PARAM_TEXT || p.default_text[0]));
        }
        assert_false(lmn_depiction_param_at(i, way.param_count, &p));
    }
    assert_false(lmn_depiction_param_at(1000, 0, &p));
}

/* What is asked for and has no sign is said, with why. */
static void expressions_without_signs_are_said(void **state)
{
    (void)state;
    static const struct {
        const char *text, *said;
    } rows[] = {
        {"[]", "there are no expressions: nothing is told"},
        {"[{\"target\": \"ball\", \"depict\": \"expand\"}]",
         "expression 1, 'expand' of 'ball', has no sign: it is as large"},
        {"[{\"target\": \"ball\", \"depict\": \"collapse\"}]", "has no sign: it is as large"},
        {"[{\"target\": \"ball\", \"depict\": \"explode\"}]", "has no sign: there are no two things below it"},
        {"[{\"target\": \"ball\", \"depict\": \"path\"}, {\"target\": \"ball\", \"depict\": \"split-path\"}]",
         "expression 2, 'split-path' of 'ball', has no sign"},
        {"[{\"target\": \"ball\", \"depict\": \"path\", \"width\": 0.001, \"dash\": 0.1, \"gap\": 0.1}]",
         "dashes; it has 2000, which are longer"},
    };
    lmn_scene *scene = ball_scene("unsaid.glb", true);
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_error error = {0};
        char     *json = NULL;
        assert_int_equal(tell(scene, rows[i].text, 1, &json, &error), LMN_OK);
        if (!strstr(json, rows[i].said))
            fail_msg("%s: %s", rows[i].text, json);
        lmn_text_free(json);
    }
    lmn_scene_destroy(&scene);
}

static void missing_memory_is_said(void **state)
{
    (void)state;
    lmn_scene *scene = ball_scene("memory.glb", true);
    lmn_status status = LMN_MEMORY;
    long       n = 1;
    for (; status != LMN_OK && n < 20000; n++) {
        lmn_error error = {0};
        mem_fail_at(n);
        status = tell(scene, n % 2 ? NULL : "[{\"target\": \"ball\", \"depict\": \"motion\"}]", 1, NULL, &error);
        mem_fail_at(0);
        if (status != LMN_OK && status != LMN_MEMORY)
            fail_msg("allocation %ld: %d, %s", n, (int)status, error.message);
        if (scene->changes_open) /* those of the call before were being taken out */
            assert_int_equal(lmn_scene_end_changes(scene, NULL), LMN_OK);
        assert_false(status != LMN_OK && scene->nodes[depict_find_node(scene, "ball")].hidden);
    }
    assert_true(n > 100 && status == LMN_OK);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(trajectories_are_the_motion),
        cmocka_unit_test(impacts_are_found_where_they_are),
        cmocka_unit_test(arrows_follow_the_way),
        cmocka_unit_test(arrows_lie_on_the_way_that_is_seen),
        cmocka_unit_test(ghosts_are_where_they_were),
        cmocka_unit_test(split_ways_grow_with_speed),
        cmocka_unit_test(lines_end_at_the_impact_that_is_told),
        cmocka_unit_test(lines_trail_behind),
        cmocka_unit_test(lines_begin_at_the_rear_of_the_outline),
        cmocka_unit_test(laps_are_told_once),
        cmocka_unit_test(targets_are_hidden_for_their_ghosts),
        cmocka_unit_test(every_option_changes_the_glyphs),
        cmocka_unit_test(expressions_come_back_as_they_were),
        cmocka_unit_test(proposals_follow_from_the_motion),
        cmocka_unit_test(mistakes_are_said),
        cmocka_unit_test(expressions_without_signs_are_said),
        cmocka_unit_test(parameters_are_listed),
        cmocka_unit_test(missing_memory_is_said),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
