/* Behaviour: lifetimes against a simulator that steps through the graph, maps against formulas, the clip that is made
 * of it against the exact values. */
#include <math.h>

#include "base/random.h"
#include "behaviour/clip.h"
#include "behaviour/evaluate.h"
#include "behaviour/inspect.h"
#include "behaviour/map.h"
#include "import_support.h"
#include "scene/channel.h"

static lmn_scene *scene_of_nodes(size_t count)
{
    lmn_scene *s = scene_new();
    for (size_t i = 0; i < count; i++)
        assert_non_null(scene_append_node(s));
    assert_non_null(scene_append_animation(s));
    return s;
}

static behaviour_node *at(lmn_scene *s, int32_t index)
{
    return &s->behaviour->nodes[index];
}

static int32_t add_constraint(lmn_scene *s, int32_t target, animation_path path, map_kind kind, const double *values,
                              size_t count, size_t components, double duration)
{
    int32_t         index = behaviour_append(s, BEHAVIOUR_CONSTRAINT);
    behaviour_node *n = at(s, index);
    n->target = target;
    n->path = path;
    n->duration = duration;
    n->map.kind = kind;
    n->map.components = components;
    n->map.value_count = count;
    n->map.values = values ? mem_copy(values, count * components * sizeof *values) : NULL;
    return index;
}

static int32_t add_group(lmn_scene *s, behaviour_kind kind, const int32_t *children, size_t count)
{
    int32_t index = behaviour_append(s, kind);
    for (size_t i = 0; i < count; i++)
        assert_true(behaviour_append_child(s, index, children[i], 0, -1));
    return index;
}

/* --- the simulator of Nienhaus 2005, section 7.3 (time events that groups pass on) ----------------------- */

static double needs(const lmn_scene *s, int32_t index);

static double needs_inside(const lmn_scene *s, int32_t index)
{
    const behaviour_node *n = &s->behaviour->nodes[index];
    double                sum = 0;
    for (size_t i = 0; i < n->child_count; i++) {
        double one = needs(s, n->children[i].node);
        if (n->kind == BEHAVIOUR_TABLE)
            one = n->children[i].start + (n->children[i].duration >= 0 ? n->children[i].duration : one);
        const bool shortest = n->kind == BEHAVIOUR_SIMULTANEITY && n->fit == FIT_SHRINK && one > 0 && sum > 0;
        sum = n->kind == BEHAVIOUR_SEQUENCE ? sum + one : shortest ? fmin(sum, one) : fmax(sum, one);
    }
    if (n->kind == BEHAVIOUR_REPEAT)
        sum *= n->times;
    return n->child_count ? sum : n->kind == BEHAVIOUR_EVENT ? 0 : n->duration;
}

static double needs(const lmn_scene *s, int32_t index)
{
    const behaviour_node *n = &s->behaviour->nodes[index];
    return n->duration >= 0 ? n->duration : needs_inside(s, index);
}

typedef struct active {
    int32_t node;
    double  local;
} active;
typedef struct active_list {
    active items[4096];
    size_t count;
} active_list;

/* Node `index` was given `given` seconds and `t` of them are over. */
static void simulate(const lmn_scene *s, int32_t index, double t, double given, active_list *out)
{
    const behaviour_node *n = &s->behaviour->nodes[index];
    double                own = needs_inside(s, index), now = given > 0 ? t * own / given : 0, begin = 0;
    if (n->kind == BEHAVIOUR_EVENT || now < 0 || now > own)
        return; /* random instants meet no event */
    if (n->kind == BEHAVIOUR_CONSTRAINT) {
        out->items[out->count++] = (active){index, now};
        return;
    }
    if (n->kind == BEHAVIOUR_REVERSE) {
        simulate(s, n->children[0].node, own - now, own, out);
        return;
    }
    if (n->kind == BEHAVIOUR_CREEP) {
        simulate(s, n->children[0].node, own * pow(now / own, n->exponent), own, out);
        return;
    }
    if (n->kind == BEHAVIOUR_REPEAT) {
        double one = needs(s, n->children[0].node);
        double round = fmin(floor(now / one), n->times - 1.0);
        simulate(s, n->children[0].node, fmin(now - round * one, one), one, out);
        return;
    }
    for (size_t i = 0; i < n->child_count; i++) {
        int32_t child = n->children[i].node;
        double  one = needs(s, child);
        if (n->kind == BEHAVIOUR_TABLE) {
            begin = n->children[i].start;
            one = n->children[i].duration >= 0 ? n->children[i].duration : one;
        } else if (n->kind == BEHAVIOUR_SIMULTANEITY) {
            one = (n->fit == FIT_STRETCH || n->fit == FIT_SHRINK) && one > 0 ? own : one;
            begin = n->fit == FIT_CENTRE ? (own - one) / 2 : n->fit == FIT_END ? own - one : 0;
        }
        bool last = n->kind != BEHAVIOUR_SEQUENCE || begin + one >= own * (1 - 1e-12); /* it has its end */
        if (now >= begin && (now < begin + one || (last && now <= (begin + one) * (1 + 1e-12))))
            simulate(s, child, fmin(now - begin, one), one, out);
        if (n->kind == BEHAVIOUR_SEQUENCE)
            begin += one;
    }
}

/* --- random graphs --------------------------------------------------------------------------------------- */

static const double FIVE[] = {5, 0, 0};

static int32_t random_graph(lmn_scene *s, random_source *r, int depth)
{
    if (depth == 0 || random_below(r, 4) == 0) {
        if (random_below(r, 8) == 0)
            return behaviour_append(s, BEHAVIOUR_EVENT);
        return add_constraint(s, (int32_t)random_below(r, s->node_count), PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3,
                              0.1 + random_unit(r) * 3);
    }
    behaviour_kind kind = (behaviour_kind)random_below(r, BEHAVIOUR_CONSTRAINT);
    size_t         count = kind >= BEHAVIOUR_REVERSE ? 1 : 1 + random_below(r, 3);
    int32_t        children[4];
    for (size_t i = 0; i < count; i++)
        children[i] = i > 0 && random_below(r, 4) == 0 ? children[0] : random_graph(s, r, depth - 1); /* shared */
    int32_t index = add_group(s, kind, children, count);
    at(s, index)->fit = (behaviour_fit)random_below(r, 5);
    at(s, index)->times = 1 + (uint32_t)random_below(r, 3);
    at(s, index)->exponent = kind == BEHAVIOUR_CREEP ? 1 + 2 * random_unit(r) : 1;
    for (size_t i = 0; i < count && kind == BEHAVIOUR_TABLE; i++) {
        at(s, index)->children[i].start = random_unit(r) * 2;
        if (needs(s, children[i]) > 0 && random_below(r, 2))
            at(s, index)->children[i].duration = 0.2 + random_unit(r);
    }
    if (needs_inside(s, index) > 0 && random_below(r, 4) == 0)
        at(s, index)->duration = 0.3 + 4 * random_unit(r);
    return index;
}

/* Both lists hold the same activities at the same times of their own, in the order of the graph. */
static void compare_active(const schedule *c, double t, const active_list *simulated)
{
    size_t found = 0;
    for (size_t i = 0; i < c->span_count; i++) {
        const behaviour_span *span = &c->spans[i];
        if (c->nodes[span->node].kind == BEHAVIOUR_EVENT || !span_is_alive(span, t))
            continue;
        if (found >= simulated->count)
            fail_msg("at %.17g: span %zu of node %d, %.17g to %.17g", t, i, span->node, span->from, span->to);
        assert_int_equal(span->node, simulated->items[found].node);
        assert_true(fabs(span_local(c, span, t) - simulated->items[found].local) < 1e-8);
        found++;
    }
    assert_int_equal(found, simulated->count);
}

static void test_lifetimes_are_those_of_the_simulator(void **state)
{
    (void)state;
    static active_list simulated;
    size_t             compared = 0;
    for (uint32_t seed = 0; seed < 1000; seed++) {
        random_source r = random_start(seed, 1);
        lmn_scene    *s = scene_of_nodes(5);
        int32_t       root = random_graph(s, &r, 5);
        schedule      c;
        lmn_error     error = {0};
        assert_true(behaviour_append_root(s, root));
        if (schedule_create(&c, s, &error) != LMN_OK)
            fail_msg("seed %u: %s", seed, error.message);
        assert_true(fabs(c.duration - needs(s, root)) <= 1e-12 * c.duration);
        for (int i = 0; i < 40 && c.duration > 0; i++) {
            double t = c.duration * random_unit(&r);
            bool   near = false; /* an end that both round otherwise */
            for (size_t k = 0; k < c.span_count; k++)
                near = near || fabs(c.spans[k].from - t) < 1e-9 || fabs(c.spans[k].to - t) < 1e-9;
            simulated.count = 0;
            if (near)
                continue;
            simulate(s, root, t, needs(s, root), &simulated);
            compare_active(&c, t, &simulated);
            compared += simulated.count;
        }
        schedule_release(&c);
        scene_free(s);
    }
    assert_true(compared > 20000);
}

/* By the words of the rule: the latest of the graph among those alive; else what was alive last; else rest. */
static int32_t driver_by_rule(const schedule *c, size_t property, double t)
{
    int32_t best = NONE;
    double  ended = -1;
    for (size_t i = 0; i < c->span_count; i++)
        if (c->spans[i].property == (int32_t)property && span_is_alive(&c->spans[i], t))
            best = (int32_t)i;
    for (size_t i = 0; best == NONE && i < c->span_count; i++)
        if (c->spans[i].property == (int32_t)property &&
            (c->spans[i].to < t || (c->spans[i].to == t && c->spans[i].open_to)))
            ended = fmax(ended, c->spans[i].to);
    for (size_t i = 0; ended >= 0 && i < c->span_count; i++) {
        const behaviour_span *span = &c->spans[i];
        if (span->property == (int32_t)property && span->to == ended &&
            (best == NONE || !span->open_to || c->spans[best].open_to))
            best = (int32_t)i;
    }
    return best;
}

static void test_drivers_are_those_of_the_rule(void **state)
{
    (void)state;
    size_t owned = 0;
    for (uint32_t seed = 0; seed < 300; seed++) {
        random_source r = random_start(seed, 2);
        lmn_scene    *s = scene_of_nodes(3);
        schedule      c;
        assert_true(behaviour_append_root(s, random_graph(s, &r, 4)));
        assert_true(behaviour_append_root(s, random_graph(s, &r, 4)));
        assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
        for (size_t p = 0; p < c.property_count; p++)
            for (int i = 0; i < 30; i++) {
                double t = (c.duration + 1) * random_unit(&r) - 0.2;
                assert_int_equal(schedule_driver(&c, &c.properties[p], t, SIDE_AT), driver_by_rule(&c, p, t));
            }
        /* And where one ends as the next begins, which of them owns that instant. */
        for (size_t i = 0; i < 2 * c.span_count; i++) {
            const behaviour_span *span = &c.spans[i / 2];
            const double          t = i % 2 ? span->to : span->from;
            if (span->property == NONE)
                continue;
            const size_t p = (size_t)span->property;
            assert_int_equal(schedule_driver(&c, &c.properties[p], t, SIDE_AT), driver_by_rule(&c, p, t));
            owned += span->open_to && t == span->to;
        }
        schedule_release(&c);
        scene_free(s);
    }
    assert_true(owned > 100);
}

static void test_shared_ends_have_one_owner(void **state)
{
    (void)state;
    lmn_scene    *s = scene_of_nodes(1);
    const int32_t two[] = {add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, 1),
                           add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, 2)};
    int32_t       once = add_group(s, BEHAVIOUR_SEQUENCE, two, 2);
    int32_t       back = add_group(s, BEHAVIOUR_REVERSE, &once, 1);
    int32_t       root = add_group(s, BEHAVIOUR_REPEAT, &back, 1);
    at(s, root)->times = 3;
    assert_true(behaviour_append_root(s, root));
    schedule c;
    assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
    const double ends[] = {0, 2, 3, 5, 6, 8, 9};
    for (size_t i = 0; i < 7; i++) {
        int alive = 0;
        for (size_t k = 0; k < c.span_count; k++)
            alive += span_is_alive(&c.spans[k], ends[i]);
        assert_int_equal(alive, 1);
    }
    schedule_release(&c);
    scene_free(s);
}

/* --- maps ------------------------------------------------------------------------------------------------ */

static void test_bounce_is_what_steps_give(void **state)
{
    (void)state;
    behaviour_map m = {.kind = MAP_BOUNCE,
                       .components = 3,
                       .start = {0, 3, 0},
                       .velocity = {1, 2, 0},
                       .gravity = {0, -9.81, 0},
                       .floor = 0.5,
                       .restitution = 0.7};
    double        y = 3, v = 2, worst = 0, h = 1e-6;
    for (long i = 1; i <= 3000000; i++) { /* exact between impacts, impacts within a step */
        y += v * h - 9.81 * h * h / 2;
        v -= 9.81 * h;
        if (y < 0.5 && v < 0) {
            y = 0.5;
            v *= -0.7;
        }
        if (i % 1000 == 0) {
            double out[3];
            bounce_at(&m, (double)i * h, out);
            worst = fmax(worst, fmax(fabs(out[1] - y), fabs(out[0] - (double)i * h)));
        }
    }
    assert_true(worst < 1e-3); /* the stepper's own: its impacts are late by up to a step */
    assert_true(fabs(bounce_rest(&m) - bounce_impact(&m, 200)) < 1e-9);
}

static void test_maps_give_their_formulas(void **state)
{
    (void)state;
    lmn_scene   *s = scene_of_nodes(1);
    const double line[] = {0, 0, 0, 2, 4, 6, 3, 3, 3}, points[] = {0, 0, 0, 1, 0, 0, 2, 0, 0, 9, 0, 0};
    double       out[4];
    int32_t      i = add_constraint(s, 0, PATH_TRANSLATION, MAP_LINEAR, line, 3, 3, 4);
    map_value(at(s, i), NULL, 1, 4, out);
    assert_true(fabs(out[0] - 1) < 1e-12 && fabs(out[2] - 3) < 1e-12);
    i = add_constraint(s, 0, PATH_TRANSLATION, MAP_CURVE, points, 4, 3, 1);
    at(s, i)->map.curve = CURVE_CATMULL_ROM;
    curve_at(&at(s, i)->map, 1.0 / 3, out, NULL);
    assert_true(fabs(out[0] - 1) < 1e-12); /* goes through its points */
    curve_table table = {NULL, 0};
    assert_true(curve_measure(&table, &at(s, i)->map));
    assert_true(fabs(table.lengths[table.count] - 9) < 1e-6);
    for (double share = 0; share < 1; share += 0.05) { /* a straight one: length is the coordinate */
        curve_at(&at(s, i)->map, curve_parameter(&table, &at(s, i)->map, share), out, NULL);
        assert_true(fabs(out[0] - 9 * share) < 1e-6);
    }
    mem_free(table.lengths);
    scene_free(s);
}

/* --- the clip -------------------------------------------------------------------------------------------- */

static void check_clip(lmn_scene *s)
{
    lmn_error error = {0};
    if (behaviour_write_clip(s, 0, &error) != LMN_OK)
        fail_msg("%s", error.message);
    schedule c;
    assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
    const animation *a = &s->animations[0];
    assert_int_equal(a->channel_count, c.property_count);
    for (size_t i = 0; i < a->channel_count; i++) {
        const animation_channel  *channel = &a->channels[i];
        const behaviour_property *p = &c.properties[i];
        for (size_t k = 1; k < channel->key_count; k++)
            assert_true(channel->times[k] > channel->times[k - 1]);
        for (int step = 0; step <= 1000; step++) {
            double t = c.duration * step / 1000, made[4], exact[4], same = 0;
            bool   jump = false;
            for (size_t k = 0; k < p->time_count; k++)
                jump = jump || fabs(p->times[k] - t) < 4e-7 * (1 + t);
            if (jump)
                continue;
            animation_channel_at(channel, t, made);
            schedule_value(&c, p, t, SIDE_AT, exact);
            for (size_t k = 0; k < p->components; k++)
                same += made[k] * exact[k];
            for (size_t k = 0; k < p->components; k++) {
                double sign = p->path == PATH_ROTATION && same < 0 ? -1 : 1;
                if (!(fabs(sign * made[k] - exact[k]) < 4e-6 * fmax(1, fabs(exact[k]))))
                    fail_msg("channel %zu at %g: %g for %g", i, t, made[k], exact[k]);
            }
        }
    }
    schedule_release(&c);
}

static void test_clip_is_the_exact_behaviour(void **state)
{
    (void)state;
    lmn_scene     *s = scene_of_nodes(4);
    int32_t        bounce = add_constraint(s, 0, PATH_TRANSLATION, MAP_BOUNCE, NULL, 0, 3, 4);
    behaviour_map *m = &at(s, bounce)->map;
    memcpy(m->start, (double[3]){0, 3, 0}, sizeof m->start);
    memcpy(m->velocity, (double[3]){1, 0, 0}, sizeof m->velocity);
    memcpy(m->gravity, (double[3]){0, -9.81, 0}, sizeof m->gravity);
    m->restitution = 0.8;
    int32_t spin = add_constraint(s, 1, PATH_ROTATION, MAP_SPIN, NULL, 0, 4, 3);
    at(s, spin)->map.axis[1] = 1;
    at(s, spin)->map.rate = 9;
    int32_t      creep = add_group(s, BEHAVIOUR_CREEP, &spin, 1);
    const double loop[] = {0, 0, 0, 4, 0, 0, 4, 0, 4, 0, 1, 4}, door[] = {0, 2};
    int32_t      path = add_constraint(s, 2, PATH_TRANSLATION, MAP_CURVE, loop, 4, 3, 5);
    int32_t      turn = add_constraint(s, 2, PATH_ROTATION, MAP_TANGENT, loop, 4, 3, 5);
    for (int k = 0; k < 2; k++) {
        behaviour_map *map = &at(s, k ? turn : path)->map;
        map->curve = CURVE_CATMULL_ROM;
        map->closed = true;
        map->forward[2] = map->up[1] = 1;
    }
    int32_t swing = add_constraint(s, 3, PATH_ROTATION, MAP_LINEAR, door, 2, 1, 0.7);
    at(s, swing)->about = true;
    at(s, swing)->axis[1] = 1;
    int32_t twice = add_group(s, BEHAVIOUR_REPEAT, &swing, 1); /* jumps back */
    at(s, twice)->times = 3;
    at(s, creep)->exponent = 2;
    int32_t       table = behaviour_append(s, BEHAVIOUR_TABLE);
    const int32_t all[] = {bounce, creep, path, turn, twice};
    for (int i = 0; i < 5; i++)
        assert_true(behaviour_append_child(s, table, all[i], 0.3 * i, -1));
    assert_true(behaviour_append_root(s, table));
    check_clip(s);
    assert_true(s->animations[0].channels[0].key_count < 100); /* parabolas take two keys each */
    scene_free(s);
}

static void test_follower_is_where_the_other_was(void **state)
{
    (void)state;
    lmn_scene   *s = scene_of_nodes(3);
    const double line[] = {0, 0, 0, 4, 0, 0};
    scene_link_child(s, 2, 1);
    node_own_place(&s->nodes[2])->translation[1] = 7;
    int32_t leader = add_constraint(s, 0, PATH_TRANSLATION, MAP_LINEAR, line, 2, 3, 4);
    int32_t follower = add_constraint(s, 1, PATH_TRANSLATION, MAP_FOLLOW, NULL, 0, 3, 4);
    at(s, follower)->map.other = 0;
    at(s, follower)->map.delay = 1;
    at(s, follower)->map.offset[2] = 1;
    assert_true(behaviour_append_root(s, leader) && behaviour_append_root(s, follower));
    schedule c;
    assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
    mat4 world = schedule_world(&c, 1, 3, SIDE_AT);
    assert_true(fabs(world.m[12] - 2) < 1e-12 && fabs(world.m[13]) < 1e-12 && fabs(world.m[14] - 1) < 1e-12);
    schedule_release(&c);
    at(s, leader)->map.kind = MAP_FOLLOW;
    at(s, leader)->map.other = 1;
    lmn_error error;
    assert_int_equal(behaviour_write_clip(s, 0, &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "follow itself"));
    scene_free(s);
}

/* --- inspection ------------------------------------------------------------------------------------------ */

/* D of a node and an interval against the words of its definition, all spans asked one by one. */
static size_t check_sets(const lmn_scene *s, const schedule *c, int32_t target, double from, double to)
{
    dynamics d;
    size_t   found = 0, depth = 0;
    assert_int_equal(dynamics_create(&d, c, target, from, to, NULL), LMN_OK);
    for (int32_t k = target; k != NONE; k = s->nodes[k].parent)
        depth++;
    assert_int_equal(d.path_count, depth);
    for (int32_t k = target; k != NONE; k = s->nodes[k].parent)
        assert_int_equal(d.path[--depth], k);
    for (size_t i = 0; i < c->span_count; i++) {
        bool above = false, meets = c->spans[i].from <= to && from <= c->spans[i].to;
        for (int32_t k = target; k != NONE; k = s->nodes[k].parent)
            above = above || c->nodes[c->spans[i].node].target == k;
        if (above && meets)
            assert_int_equal(d.spans[found++], i); /* random ends meet no owned instant */
    }
    assert_int_equal(d.span_count, found);
    dynamics_release(&d);
    return found;
}

/* P, C, C at a time and C in an interval of 1,000 graphs over random trees of nodes. */
static void test_dynamics_are_the_brute_force_sets(void **state)
{
    (void)state;
    size_t all = 0, now = 0, within = 0;
    for (uint32_t seed = 0; seed < 1000; seed++) {
        random_source r = random_start(seed, 3);
        lmn_scene    *s = scene_of_nodes(5);
        schedule      c;
        for (int32_t i = 1; i < 5; i++)
            scene_link_child(s, (int32_t)random_below(&r, (size_t)i), i);
        assert_true(behaviour_append_root(s, random_graph(s, &r, 4)));
        assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
        const double  from = c.duration * random_unit(&r), to = from + c.duration * random_unit(&r) / 4;
        const int32_t target = (int32_t)random_below(&r, 5);
        all += check_sets(s, &c, target, -INFINITY, INFINITY);
        now += check_sets(s, &c, target, from, from);
        within += check_sets(s, &c, target, from, to);
        schedule_release(&c);
        scene_free(s);
    }
    if (!(now > 400 && within > now && all > within))
        fail_msg("%zu, %zu, %zu", now, within, all);
}

static void test_trajectory_is_the_parabola(void **state)
{
    (void)state;
    lmn_scene     *s = scene_of_nodes(1);
    int32_t        bounce = add_constraint(s, 0, PATH_TRANSLATION, MAP_BOUNCE, NULL, 0, 3, 2);
    behaviour_map *m = &at(s, bounce)->map;
    memcpy(m->start, (double[3]){0, 3, 0}, sizeof m->start);
    memcpy(m->velocity, (double[3]){2, 1, 0}, sizeof m->velocity);
    memcpy(m->gravity, (double[3]){0, -9.81, 0}, sizeof m->gravity);
    m->restitution = 0.5;
    assert_true(behaviour_append_root(s, bounce));
    schedule   c;
    trajectory t;
    double     first = bounce_impact(m, 0), before = 0, behind = 0;
    assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
    assert_int_equal(schedule_trajectory(&t, &c, 0, NULL, 0, 2, 0.01, NULL), LMN_OK);
    assert_true(t.count > 8 && t.count < 200);
    for (size_t i = 0; i < t.count; i++) {
        const trajectory_sample *p = &t.samples[i];
        if (p->seconds < first) {
            assert_true(fabs(p->position[1] - (3 + p->seconds - 9.81 * p->seconds * p->seconds / 2)) < 1e-9);
            assert_true(fabs(p->velocity[1] - (1 - 9.81 * p->seconds)) < 1e-6);
            assert_true(fabs(p->velocity[0] - 2) < 1e-6 && fabs(p->acceleration[1] + 9.81) < 1e-4);
        }
        if (fabs(p->seconds - first) < 1e-9)
            *(p->velocity[1] < 0 ? &before : &behind) = p->velocity[1];
    }
    /* The corner is there: what arrives leaves with half of it. */
    assert_true(before < -1 && fabs(behind + 0.5 * before) < 1e-5);
    trajectory_release(&t);
    /* Of a part of the time it begins and ends with that, wherever nothing breaks. */
    assert_int_equal(schedule_trajectory(&t, &c, 0, NULL, 0.3, 0.6, 0.01, NULL), LMN_OK);
    assert_true(t.count >= 2 && t.samples[0].seconds == 0.3 && t.samples[t.count - 1].seconds == 0.6);
    for (size_t i = 0; i < t.count; i++) {
        const double since = t.samples[i].seconds;
        assert_true(i == 0 || since > t.samples[i - 1].seconds);
        assert_true(fabs(t.samples[i].position[1] - (3 + since - 9.81 * since * since / 2)) < 1e-9);
    }
    trajectory_release(&t);
    schedule_release(&c);
    scene_free(s);
}

static void test_impacts_are_those_of_the_ball(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(LIMNER_SOURCE_DIR "/examples/scripts/balls.json");
    schedule   c;
    impact    *found;
    size_t     count = 0;
    assert_int_equal(schedule_create(&c, s, NULL), LMN_OK);
    for (size_t i = 0; i < s->node_count; i++) {
        if (!s->nodes[i].name || strcmp(s->nodes[i].name, "green") != 0)
            continue;
        assert_int_equal(impacts_find(&found, &count, &c, (int32_t)i, NULL, 0, 4, 1, NULL), LMN_OK);
        double falls = sqrt(2 * 3.5 / 9.81), arrives = 9.81 * falls;
        assert_true(count >= 3);
        assert_true(fabs(found[0].seconds - falls) < 1e-9 && fabs(found[0].speed - 1.7 * arrives) < 1e-4);
        assert_true(fabs(found[0].normal[1] - 1) < 1e-6);
        assert_true(fabs(found[0].place[1] - 0.5) < 1e-9 && fabs(found[0].place[0] - 2 * falls) < 1e-9);
        assert_true(fabs(found[1].seconds - falls - 1.4 * arrives / 9.81) < 1e-9);
        assert_true(found[0].thrown_back && !found[0].sets_off && !found[0].stops);
        assert_true(fabs(found[0].since - falls) < 1e-9); /* smoothly from the beginning to the next impact */
        assert_true(fabs(found[0].until - (found[1].seconds - found[0].seconds)) < 1e-9);
        assert_true(fabs(found[1].since - found[0].until) < 1e-9);
        mem_free(found);
    }
    assert_true(count > 0);
    schedule_release(&c);
    lmn_scene_destroy(&s);
}

/* --- what is wrong --------------------------------------------------------------------------------------- */

static void expect(lmn_scene *s, lmn_status status, const char *words)
{
    lmn_error error = {0};
    schedule  c;
    assert_int_equal(schedule_create(&c, s, &error), status);
    if (!strstr(error.message, words))
        fail_msg("'%s' does not say '%s'", error.message, words);
    schedule_release(&c);
    scene_free(s);
}

static void test_wrong_graphs_are_refused(void **state)
{
    (void)state;
    lmn_scene *s = scene_of_nodes(1);
    int32_t    a = behaviour_append(s, BEHAVIOUR_SEQUENCE), b = add_group(s, BEHAVIOUR_REVERSE, &a, 1);
    assert_true(behaviour_append_child(s, a, b, 0, -1) && behaviour_append_root(s, a));
    expect(s, LMN_FORMAT, "contains itself");
    s = scene_of_nodes(1);
    assert_true(behaviour_append_root(s, add_constraint(s, 9, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, 1)));
    expect(s, LMN_FORMAT, "does not have");
    s = scene_of_nodes(1);
    assert_true(behaviour_append_root(s, add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, 0)));
    expect(s, LMN_FORMAT, "lasts no time");
    s = scene_of_nodes(1);
    assert_true(behaviour_append_root(s, add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, NAN)));
    expect(s, LMN_FORMAT, "lasts");
    s = scene_of_nodes(1);
    const double wrong[] = {NAN, 0, 0};
    assert_true(behaviour_append_root(s, add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, wrong, 1, 3, 1)));
    expect(s, LMN_FORMAT, "not finite");
    s = scene_of_nodes(1);
    a = add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, 1);
    for (int i = 0; i < 1000; i++)
        a = add_group(s, BEHAVIOUR_REVERSE, &a, 1);
    assert_true(behaviour_append_root(s, a));
    expect(s, LMN_LIMIT, "deeper");
    s = scene_of_nodes(1);
    a = add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, 1);
    for (int i = 0; i < 60; i++) { /* 2^60 by sharing */
        const int32_t pair[] = {a, a};
        a = add_group(s, BEHAVIOUR_SEQUENCE, pair, 2);
    }
    assert_true(behaviour_append_root(s, a));
    expect(s, LMN_LIMIT, "repeats counted");
}

static void test_ten_thousand_activities_are_laid_out(void **state)
{
    (void)state;
    lmn_scene *s = scene_of_nodes(1);
    int32_t    group = behaviour_append(s, BEHAVIOUR_SEQUENCE);
    for (int i = 0; i < 10000; i++) {
        int32_t one = add_constraint(s, 0, PATH_TRANSLATION, MAP_CONSTANT, FIVE, 1, 3, 0.01);
        assert_true(behaviour_append_child(s, group, one, 0, -1));
    }
    assert_true(behaviour_append_root(s, group));
    assert_int_equal(behaviour_write_clip(s, 0, NULL), LMN_OK);
    scene_free(s);
}

static void test_memory_may_end_anywhere(void **state)
{
    (void)state;
    lmn_scene   *s = scene_of_nodes(2);
    const double loop[] = {0, 0, 0, 4, 0, 0, 4, 0, 4, 0, 1, 4};
    int32_t      path = add_constraint(s, 0, PATH_TRANSLATION, MAP_CURVE, loop, 4, 3, 2);
    at(s, path)->map.by_length = true;
    int32_t twice = add_group(s, BEHAVIOUR_REPEAT, &path, 1);
    at(s, twice)->times = 2;
    assert_true(behaviour_append_root(s, twice));
    lmn_status status = LMN_MEMORY;
    for (long n = 1; status != LMN_OK; n++) {
        lmn_error error = {0};
        assert_true(n < 10000);
        mem_fail_at(n);
        status = behaviour_write_clip(s, 0, &error);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        assert_true(status == LMN_OK || s->animations[0].channel_count == 0);
    }
    scene_free(s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_lifetimes_are_those_of_the_simulator),
        cmocka_unit_test(test_drivers_are_those_of_the_rule),
        cmocka_unit_test(test_shared_ends_have_one_owner),
        cmocka_unit_test(test_bounce_is_what_steps_give),
        cmocka_unit_test(test_maps_give_their_formulas),
        cmocka_unit_test(test_clip_is_the_exact_behaviour),
        cmocka_unit_test(test_follower_is_where_the_other_was),
        cmocka_unit_test(test_dynamics_are_the_brute_force_sets),
        cmocka_unit_test(test_trajectory_is_the_parabola),
        cmocka_unit_test(test_impacts_are_those_of_the_ball),
        cmocka_unit_test(test_wrong_graphs_are_refused),
        cmocka_unit_test(test_ten_thousand_activities_are_laid_out),
        cmocka_unit_test(test_memory_may_end_anywhere),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
