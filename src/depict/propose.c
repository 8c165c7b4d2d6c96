/* What is worth telling where nobody says what: movers are found in the scene, and what characterises each decides
 * how it is told. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "depict/meeting.h"
#include "depict/depict_private.h"
#include "depict/groups.h"

enum { MOVERS_TOLD = 6, IMPACTS_TOLD = 3, STILLS_MOST = 5, LIMBS_LEAST = 4 };

/* Something that moves by itself: nothing above it does. */
typedef struct mover {
    int32_t node;
    bool    camera;
    bool    figure; /* has limbs: a skin, or joints that move by themselves */
    double  length; /* of its middle's way */
    double  radius;
    double  turned; /* radians, all in all */
    double  scaled; /* largest by smallest size */
    double  grows;  /* last by first */
    size_t  impacts;
    double  origin;   /* way of its own origin, about which it turns */
    bool    spins;    /* about its way */
    bool    followed; /* by a camera */
    bool    grouped;  /* told with others */
    double  weight;   /* how much it matters */
} mover;

typedef struct proposal {
    depict_job       job;
    expression_list *out;
    json_t         **reasons;
    double           from, to, now;
} proposal;

/* --- who moves
 * --------------------------------------------------------------------------------------------------------- */

static bool *find_moved(const lmn_scene *s, const moment *when)
{
    bool *moved = mem_calloc(s->node_count + 1, sizeof *moved);
    for (size_t k = 0; moved && k < when->clip_count; k++) {
        const animation *a = &s->animations[when->clips[k]];
        for (size_t c = 0; c < a->channel_count; c++)
            if (animation_thing_of(a->channels[c].path) == ANIMATED_NODE)
                moved[a->channels[c].target] = true;
    }
    return moved;
}

static bool is_below_any(const lmn_scene *s, int32_t node, const bool *set)
{
    for (int32_t n = s->nodes[node].parent; n != NONE; n = s->nodes[n].parent)
        if (set[n])
            return true;
    return false;
}

static bool has_camera(const lmn_scene *s, int32_t node)
{
    for (int32_t n = node; n != NONE; n = scene_next_node(s, node, n))
        if (s->nodes[n].camera != NONE)
            return true;
    return false;
}

/* Angle between two orientations, radians. */
static double angle_between(const mat4 *a, const mat4 *b)
{
    double trace = 0;
    for (int c = 0; c < 3; c++) {
        double la = vector3_length(&a->m[4 * c]), lb = vector3_length(&b->m[4 * c]);
        trace += la > 0 && lb > 0 ? vector3_dot(&a->m[4 * c], &b->m[4 * c]) / (la * lb) : 1;
    }
    return acos(fmin(fmax((trace - 1) / 2, -1), 1));
}

/* Of the changes of velocity those where it touches something. */
static lmn_status count_touches(mover *m, const proposal *p, const depict_target *t, const depict_impact *impacts,
                                lmn_error *error)
{
    lmn_status status = LMN_OK;
    size_t     touches = 0, told = m->impacts < IMPACTS_TOLD ? m->impacts : IMPACTS_TOLD;
    for (size_t i = 0; i < told && status == LMN_OK; i++) {
        bool touched = false;
        status = meeting_touches(&touched, &p->job, t, &impacts[i], error);
        touches += touched;
    }
    m->impacts = touches;
    return status;
}

static lmn_status measure(mover *m, const proposal *p, lmn_error *error)
{
    enum { STEPS = 48 };
    depict_target t;
    depict_impact impacts[IMPACTS_TOLD];
    lmn_status    status = target_open(&t, &p->job, m->node, error);
    if (status == LMN_OK) {
        double low = INFINITY, high = 0, first = 0, last_scale = 0, last_at[3], at[3], own[3];
        mat4   last = way_world(&t.way, p->from);
        way_point(&t.way, t.centre, p->from, last_at);
        for (int i = 0; i <= STEPS; i++) {
            mat4 now = way_world(&t.way, p->from + (p->to - p->from) * i / STEPS);
            way_point(&t.way, t.centre, p->from + (p->to - p->from) * i / STEPS, at);
            m->length += vector3_distance(last_at, at);
            m->turned += angle_between(&last, &now);
            vector3_add(own, &now.m[12], -1, &last.m[12]);
            m->origin += vector3_length(own);
            last_scale = cbrt(fabs(mat4_cofactors(&now, (double[9]){0})));
            first = i == 0 ? last_scale : first;
            low = fmin(low, last_scale);
            high = fmax(high, last_scale);
            vector3_copy(last_at, at);
            last = now;
        }
        m->radius = t.radius;
        m->scaled = low > 0 ? high / low : 1;
        m->grows = first > 0 ? last_scale / first : 1;
        for (size_t i = 0; i < t.part_count; i++)
            m->figure = m->figure || (t.parts[i] && p->job.scene->nodes[p->job.scene->parts[i].node].skin != NONE);
        status = target_impacts(impacts, IMPACTS_TOLD, &m->impacts, &t, p->from, p->to, error);
        if (status == LMN_OK)
            status = count_touches(m, p, &t, impacts, error);
        m->weight = m->length + m->radius * (fmin(m->turned, 6) + fabs(log(m->scaled)) + (m->figure ? 1 : 0));
    }
    target_release(&t);
    return status;
}

static int compare_movers(const void *a, const void *b)
{
    const mover *x = a, *y = b;
    if (x->weight != y->weight)
        return x->weight < y->weight ? 1 : -1;
    return (x->node > y->node) - (x->node < y->node);
}

static lmn_status find_movers(mover **out, size_t *count, const proposal *p, lmn_error *error)
{
    const lmn_scene *s = p->job.scene;
    bool            *moved = find_moved(s, &p->job.when);
    size_t           capacity = 0;
    lmn_status       status = moved ? LMN_OK : error_memory(error);
    /* What skins carry moves with their joints. */
    for (size_t i = 0; i < s->part_count && status == LMN_OK; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        for (size_t k = 0; n->skin != NONE && k < s->skins[n->skin].joint_count; k++)
            if (moved[s->skins[n->skin].joints[k]]) {
                moved[s->parts[i].node] = true;
                break;
            }
    }
    for (size_t i = 0; i < s->node_count && status == LMN_OK; i++) {
        bool   has_part = false;
        size_t joints = 0;
        if (!moved[i] || is_below_any(s, (int32_t)i, moved))
            continue;
        mover m = {.node = (int32_t)i, .camera = has_camera(s, (int32_t)i)};
        for (size_t k = 0; k < s->part_count && !has_part; k++)
            for (int32_t n = s->parts[k].node; n != NONE && !has_part; n = s->nodes[n].parent)
                has_part = n == (int32_t)i;
        if (!has_part && !m.camera)
            continue;
        for (int32_t n = (int32_t)i; n != NONE; n = scene_next_node(s, (int32_t)i, n))
            joints += moved[n];
        m.figure = joints > LIMBS_LEAST;
        status = measure(&m, p, error);
        if (status == LMN_OK && !mem_grow((void **)out, &capacity, *count + 1, sizeof **out))
            status = error_memory(error);
        if (status == LMN_OK)
            (*out)[(*count)++] = m;
    }
    mem_free(moved);
    if (*count > 1)
        qsort(*out, *count, sizeof **out, compare_movers);
    return status;
}

/* --- what is told
 * ------------------------------------------------------------------------------------------------------- */

static expression *propose(const proposal *p, const mover *m, const char *characteristic, const char *why,
                           double measure)
{
    const lmn_scene *s = p->job.scene;
    char             numbered[DEPICT_NAME_SIZE];
    const depiction *row = depiction_find(characteristic, depict_semantics(s, m->node));
    expression      *e = row ? expression_add(p->out, row, m->node, p->from, p->to, p->now) : NULL;
    if (e && p->reasons)
        json_array_append_new(*p->reasons,
                              json_pack("{s:s,s:s,s:s,s:f}", "target", depict_name_of(s, m->node, numbered), "depict",
                                        characteristic, "because", why, "measure", measure));
    return e;
}

static void set_number(expression *e, const char *key, double number)
{
    char text[48];
    for (size_t i = 0; e && i < e->row->param_count; i++)
        if (strcmp(e->row->params[i].key, key) == 0) {
            snprintf(text, sizeof text, e->row->params[i].type == PARAM_INT ? "%.0f" : "%g", number);
            param_set_text(&e->row->params[i], e->values, text, NULL);
        }
}

/* Patterns of several things, and what needs a closer look than measures give. */
static lmn_status find_patterns(mover *movers, size_t count, const proposal *p, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        mover *m = &movers[i];
        if (m->camera || m->figure || m->length < m->radius)
            continue;
        if (m->turned > 6)
            status = spins_along(&m->spins, &p->job, m->node, p->from, p->to, error);
        for (size_t k = 0; k < count && status == LMN_OK && !m->followed; k++)
            if (movers[k].camera) {
                status = goes_with(&m->followed, &p->job, m->node, movers[k].node, p->from, p->to, error);
                movers[k].grouped = movers[k].grouped || m->followed;
            }
    }
    return status;
}

/* What many do that lie in one node is told of that node. */
static lmn_status tell_groups(mover *movers, size_t count, const proposal *p, lmn_error *error)
{
    const lmn_scene *s = p->job.scene;
    lmn_status       status = LMN_OK;
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        mover parent = {.node = s->nodes[movers[i].node].parent};
        group g;
        if (parent.node == NONE || movers[i].grouped || movers[i].camera)
            continue;
        status = group_find(&g, &p->job, parent.node, p->from, p->to, error);
        if (status != LMN_OK || g.kind == GROUP_NONE)
            continue;
        for (size_t k = 0; k < count; k++)
            movers[k].grouped = movers[k].grouped || s->nodes[movers[k].node].parent == parent.node;
        if (g.kind == GROUP_BURSTS)
            propose(p, &parent, "explode", "many things part at once, to all sides; things", (double)g.things);
        else
            propose(p, &parent, "split-path", "things go together, then part; things", (double)g.things);
    }
    return status;
}

/* What goes on: as it was and will be, and along which way. */
static void tell_way(const proposal *p, const mover *m, double ways)
{
    if (m->followed) {
        propose(p, m, "travelling", "a camera follows it; radii", ways);
        return;
    }
    expression *e = propose(p, m, "still", "it moves farther than its own size; radii", ways);
    set_number(e, "count", fmin(fmax(floor(ways / 3) + 2, 3), STILLS_MOST));
    if (!m->figure)
        set_number(e, "stretch", m->spins ? 0 : 0.5);
    if (m->spins) {
        propose(p, m, "tailspin", "it turns about its way; radians", m->turned);
        return;
    }
    e = propose(p, m, "path", "its middle has a way; radii", ways);
    if (m->figure) {
        set_number(e, "width", 0.12);
        set_number(e, "short_of", 0.4);
    }
    propose(p, m, "motion", "it moves now; radii", ways);
}

/* Of what stays where it is, the limb that goes farthest about now; NONE: none goes far. */
static lmn_status find_limb(int32_t *out, double *length, const proposal *p, const mover *m, double from, double to,
                            lmn_error *error)
{
    enum { STEPS = 16 };
    const lmn_scene *s = p->job.scene;
    bool            *moved = find_moved(s, &p->job.when);
    lmn_status       status = moved ? LMN_OK : error_memory(error);
    *out = NONE;
    *length = 0.5 * m->radius;
    for (size_t i = 0; i < s->node_count && status == LMN_OK && to > from; i++) {
        way          w;
        const double local[3] = {0, 0, 0};
        double       last[3], at[3], gone = 0;
        if (!moved[i])
            continue;
        status = way_open(&w, s, (int32_t)i, &p->job.when, error);
        if (status == LMN_OK)
            way_point(&w, local, from, last);
        for (int k = 1; k <= STEPS && status == LMN_OK; k++) {
            way_point(&w, local, from + (to - from) * k / STEPS, at);
            gone += vector3_distance(last, at);
            vector3_copy(last, at);
        }
        way_release(&w);
        if (status == LMN_OK && gone > *length) {
            *length = gone;
            *out = (int32_t)i;
        }
    }
    mem_free(moved);
    return status;
}

/* What has limbs and stays: as it is now, and the way of the limb that goes farthest. */
static lmn_status tell_figure(const proposal *p, const mover *m, double ways, lmn_error *error)
{
    const double around = fmin(0.4, (p->to - p->from) / 4), from = fmax(p->now - around, p->from),
                 to = fmin(p->now + around, p->to);
    int32_t limb;
    double  length;
    set_number(propose(p, m, "still", "its limbs move, it does not", ways), "count", 1);
    lmn_status status = find_limb(&limb, &length, p, m, from, to, error);
    if (status != LMN_OK || limb == NONE)
        return status;
    mover       other = {.node = limb};
    expression *e = propose(p, &other, "path", "of all limbs it goes farthest now; units", length);
    if (e) {
        e->from = from;
        e->to = to;
        set_number(e, "width", 0.8);
        set_number(e, "short_of", 0);
    }
    return LMN_OK;
}

static lmn_status tell(const proposal *p, const mover *m, lmn_error *error)
{
    lmn_status   status = LMN_OK;
    const bool   on_the_spot = m->origin < 0.1 * m->length || m->length <= m->radius;
    const double ways = m->radius > 0 ? m->length / m->radius : 0;
    if (m->camera && ways > 0) {
        propose(p, m, "camera-path", "a camera moves; units", m->length);
        return LMN_OK;
    }
    const bool turns = !m->figure && on_the_spot && m->turned > 0.35;
    if (ways > 1 && !turns)
        tell_way(p, m, ways);
    else if (m->figure)
        status = tell_figure(p, m, ways, error);
    if (m->impacts && !m->figure && !turns)
        propose(p, m, "collision", "it touches something and its velocity changes at once; times", (double)m->impacts);
    if (turns)
        propose(p, m, "turnaround", "it turns on the spot; radians", m->turned);
    if (m->scaled > 1.15)
        propose(p, m, m->grows >= 1 ? "expand" : "collapse", "its size changes; largest by smallest", m->scaled);
    return status;
}

lmn_status depict_propose(expression_list *out, json_t **reasons, const lmn_scene *scene, const moment *when,
                          double from, double to, lmn_error *error)
{
    depict_poses poses = {.count = 0};
    proposal     p = {.job = {.scene = scene, .when = *when, .poses = &poses, .size = 1},
                      .out = out,
                      .reasons = reasons,
                      .from = from,
                      .to = to,
                      .now = when->seconds};
    mover       *movers = NULL;
    size_t       count = 0;
    lmn_status   status = find_movers(&movers, &count, &p, error);
    if (reasons)
        *reasons = json_array();
    if (status == LMN_OK)
        status = find_patterns(movers, count, &p, error);
    if (status == LMN_OK)
        status = tell_groups(movers, count, &p, error);
    size_t told = 0;
    for (size_t i = 0; i < count && told < MOVERS_TOLD && status == LMN_OK; i++)
        if (!movers[i].grouped) {
            status = tell(&p, &movers[i], error);
            told++;
        }
    mem_free(movers);
    depict_poses_release(&poses);
    return status == LMN_OK ? work_check(error) : status;
}
