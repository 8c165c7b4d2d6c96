/* What is worth telling where nobody says what: movers are found in the scene, and what characterises each decides
 * how it is told. What is told by nothing is said, too. */
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "construct/construct.h"
#include "depict/depict_private.h"
#include "depict/groups.h"
#include "depict/movers.h"
#include "depict/page.h"

enum { MOVERS_TOLD = 6, STILLS_MOST = 5 };

typedef struct proposal {
    depict_job       job;
    expression_list *out;
    json_t         **reasons;
    double           from, to, now;
} proposal;

/* --- what is told
 * ------------------------------------------------------------------------------------------------------- */

static void set_text(expression *e, const char *key, const char *text)
{
    for (size_t i = 0; e && i < e->row->param_count; i++)
        if (strcmp(e->row->params[i].key, key) == 0)
            param_set_text(&e->row->params[i], e->values, text, NULL);
}

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
    snprintf(text, sizeof text, "%.6g", number);
    set_text(e, key, text);
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
    bool            *asked = mem_calloc(s->node_count + 1, sizeof *asked);
    lmn_status       status = asked ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        mover parent = {.node = s->nodes[movers[i].node].parent, .hit = NONE};
        group g;
        if (parent.node == NONE || movers[i].grouped || movers[i].camera || asked[parent.node])
            continue;
        asked[parent.node] = true;
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
    mem_free(asked);
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
    /* As many as leave each other to be seen. */
    const double count = fmin(fmax(floor(m->length / (2.6 * m->reach)) + 1, 3), STILLS_MOST);
    set_number(e, "count", count);
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
    /* Else it would lie in them. */
    if (m->doubles || m->length / (count - 1) < 2.6 * m->reach)
        set_text(e, "before", "true");
    if (m->doubles)
        set_number(e, "aside", 0.6);
    propose(p, m, "motion", "it moves now; radii", ways);
}

/* Breadths of arrows are told in radii of what they belong to. */
static lmn_status radius_of(double *out, const proposal *p, int32_t node, lmn_error *error)
{
    depict_target t;
    lmn_status    status = target_open(&t, &p->job, node, error);
    *out = t.radius;
    target_release(&t);
    return status;
}

/* What has limbs and stays: as it was, is and will be, and the way of the limb whose end goes farthest, about now or
 * else within the whole. */
static lmn_status tell_figure(const proposal *p, const mover *m, double ways, lmn_error *error)
{
    const double around = fmin(0.4, (p->to - p->from) / 4);
    double       from = fmax(p->now - around, p->from), to = fmin(p->now + around, p->to), length;
    int32_t      limb;
    lmn_status   status = mover_limb(&limb, &length, &p->job, m->node, from, to, error);
    if (status == LMN_OK && length < 0.3 * m->radius) {
        from = p->from;
        to = p->to;
        status = mover_limb(&limb, &length, &p->job, m->node, from, to, error);
    }
    const bool  far = status == LMN_OK && limb != NONE && length > 0.1 * m->radius;
    expression *e = propose(p, m, "still", "its limbs move, it does not; radii that it goes", ways);
    set_number(e, "count", far ? 3 : 1);
    /* Where all of it sways, its images would hide each other: the limbs are what is told. */
    if (far)
        set_number(e, "least", ways < 0.3 ? 0.45 : 0.6);
    if (!e || !far)
        return status;
    e->from = from;
    e->to = to;
    mover other = {.node = limb};
    e = propose(p, &other, "path", "of all limbs its end goes farthest; units", length);
    if (!e)
        return status;
    e->from = from;
    e->to = to;
    set_text(e, "tip", "true");
    set_text(e, "before", "true");
    set_number(e, "short_of", 0);
    double own;
    status = radius_of(&own, p, limb, error);
    if (status == LMN_OK && own > 0)
        set_number(e, "width", fmin(0.06 * m->radius, 0.12 * length) / own);
    return status;
}

/* Of what changes its shape: what it was and will be, as far as it goes one way. */
static void tell_size(const proposal *p, const mover *m)
{
    expression *e = NULL;
    if (m->morphs && m->shaped > 0.05 * m->radius) {
        e = propose(p, m, "still", "its shape changes; radii that vertices go", m->shaped / m->radius);
        set_number(e, "count", 3);
        if (e) {
            e->from = m->grows.from;
            e->to = m->grows.to;
        }
    }
    if (m->scaled <= 1.15)
        return;
    char       why[96] = "its size changes now; behind that by before";
    const bool now = p->now >= m->grows.from && p->now <= m->grows.to;
    if (!now)
        snprintf(why, sizeof why, "its size changes from %.3g to %.3g s; behind that by before", m->grows.from,
                 m->grows.to);
    e = propose(p, m, m->growth >= 1 ? "expand" : "collapse", why, m->growth);
    if (e) {
        e->from = m->grows.from;
        e->to = m->grows.to;
    }
}

static void tell_camera(const proposal *p, const mover *m)
{
    if (m->length > 1e-6 * p->job.size)
        propose(p, m, "camera-path", "a camera moves; units", m->length);
    else if (m->turned > 0.02)
        propose(p, m, "shot-flow", "a camera turns; radians", m->turned);
    else if (m->zoomed > 1.02)
        propose(p, m, "shot-flow", "a camera zooms; largest by smallest picture", m->zoomed);
}

static void tell_light(const proposal *p, const mover *m)
{
    expression *e = m->length > 1e-6 * p->job.size ? propose(p, m, "path", "a light moves; units", m->length) : NULL;
    set_text(e, "before", "true");
    set_number(e, "short_of", 0);
}

/* Is what one mover hits another one, or of it? */
static bool is_of(const lmn_scene *s, int32_t node, const mover *m)
{
    while (node != NONE && node != m->node)
        node = s->nodes[node].parent;
    return node != NONE;
}

/* Where two things that move meet, both are hit at once: is it told of the other one? */
static bool is_told_already(const proposal *p, const mover_list *all, const mover *m, size_t hit)
{
    const double same = 1e-3 * (p->to - p->from);
    for (size_t i = 0; i < all->count; i++) {
        const mover *other = &all->items[i];
        if (!other->collides || other == m || !is_of(p->job.scene, m->hit_whom[hit], other))
            continue;
        for (size_t k = 0; k < other->hits; k++)
            if (fabs(other->hit_times[k] - m->hit_times[hit]) <= same && is_of(p->job.scene, other->hit_whom[k], m))
                return true;
    }
    return false;
}

static void tell_one_collision(const proposal *p, const mover *m, size_t hits, int32_t partner)
{
    expression *e = propose(p, m, "collision", "it hits something; times", (double)hits);
    if (e)
        e->partner = partner;
}

/* What it hits; of what is told of others already, the rest, one thing after the other. */
static void tell_hits(const proposal *p, const mover_list *all, mover *m)
{
    bool   open[MOVER_HITS];
    size_t left = 0;
    for (size_t i = 0; i < m->hits; i++) {
        open[i] = !is_told_already(p, all, m, i);
        left += open[i];
    }
    m->collides = left > 0;
    if (left == m->hits)
        tell_one_collision(p, m, m->hits, m->hit);
    for (size_t i = 0; i < m->hits && left < m->hits; i++) {
        size_t same = 0;
        for (size_t k = i; k < m->hits && open[i]; k++)
            if (open[k] && m->hit_whom[k] == m->hit_whom[i]) {
                open[k] = k == i;
                same++;
            }
        if (same)
            tell_one_collision(p, m, same, m->hit_whom[i]);
    }
}

/* The share of a box that lies in another one. */
static double share_in(const box3 *own, const box3 *other)
{
    const double both[3] = {(double)(fminf(own->max.x, other->max.x) - fmaxf(own->min.x, other->min.x)),
                            (double)(fminf(own->max.y, other->max.y) - fmaxf(own->min.y, other->min.y)),
                            (double)(fminf(own->max.z, other->max.z) - fmaxf(own->min.z, other->min.z))},
                 whole[3] = {(double)(own->max.x - own->min.x), (double)(own->max.y - own->min.y),
                             (double)(own->max.z - own->min.z)};
    double share = 1;
    for (int k = 0; k < 3; k++)
        share *= whole[k] > 0 ? fmax(both[k], 0) / whole[k] : both[k] >= 0;
    return share;
}

/* Does half of it lie within the box of one other part, as a gear in its housing? */
static lmn_status lies_inside(bool *out, const proposal *p, const mover *m, lmn_error *error)
{
    depict_target t;
    const mat4   *worlds = depict_worlds_at_rest(&p->job);
    box3          own = box3_empty();
    lmn_status    status = target_open(&t, &p->job, m->node, error);
    *out = false;
    for (size_t i = 0; i < t.part_count && status == LMN_OK && worlds; i++)
        if (t.parts[i])
            own = box3_union(own, part_bounds(p->job.scene, worlds, i));
    for (size_t i = 0; i < t.part_count && status == LMN_OK && worlds && !box3_is_empty(own); i++) {
        const box3 other = t.parts[i] ? own : part_bounds(p->job.scene, worlds, i);
        *out = *out || (!t.parts[i] && share_in(&own, &other) > 0.5);
    }
    target_release(&t);
    return status == LMN_OK && !worlds ? error_memory(error) : status;
}

static lmn_status tell_turn(const proposal *p, const mover *m, lmn_error *error)
{
    bool        inside = false;
    expression *e = propose(p, m, "turnaround", "it turns on the spot; radians", m->turned);
    lmn_status  status = e ? lies_inside(&inside, p, m, error) : LMN_OK;
    if (inside)
        set_text(e, "before", "true");
    return status;
}

static lmn_status tell(const proposal *p, const mover_list *all, mover *m, lmn_error *error)
{
    lmn_status   status = LMN_OK;
    const bool   on_the_spot = m->origin < 0.1 * m->length || m->length <= m->radius;
    const double ways = m->radius > 0 ? m->length / m->radius : 0;
    if (m->camera)
        tell_camera(p, m);
    else if (m->light)
        tell_light(p, m);
    if (m->camera || m->light)
        return LMN_OK;
    const bool turns = !m->figure && on_the_spot && m->turned > 0.35;
    if (ways > 1 && !turns)
        tell_way(p, m, ways);
    else if (m->figure)
        status = tell_figure(p, m, ways, error);
    if (m->hits && !m->figure)
        tell_hits(p, all, m);
    if (turns && status == LMN_OK)
        status = tell_turn(p, m, error);
    tell_size(p, m);
    return status;
}

/* --- what is not told --------------------------------------------------------------------------------------------- */

/* What moves and got no sign but itself. */
static void say_untold(const proposal *p, const mover *m)
{
    char         numbered[DEPICT_NAME_SIZE];
    const char  *name = depict_name_of(p->job.scene, m->node, numbered);
    const double degrees = m->turned * 180 / acos(-1.0), ways = m->radius > 0 ? m->length / m->radius : 0;
    if (m->camera || m->light)
        warnings_add(p->job.warnings, WARNING_UNTOLD, "'%s', a %s, changes without moving: there is no sign for that",
                     name, m->camera ? "camera" : "light");
    else if (m->figure)
        warnings_add(p->job.warnings, WARNING_UNTOLD,
                     "'%s' stays where it is, and none of its limbs goes far in this clip", name);
    else
        warnings_add(p->job.warnings, WARNING_UNTOLD,
                     "'%s' hardly moves: by %.2g radii, %.2g degrees, and to %.3g times its size", name, ways, degrees,
                     m->growth);
}

/* Which clips there are beside those that are told. */
static void say_clips(const proposal *p)
{
    const lmn_scene *s = p->job.scene;
    char             others[400] = "", told[120] = "nothing";
    size_t           used = 0;
    for (size_t i = 0; i < s->animation_count; i++) {
        bool        is_told = false;
        const char *name = s->animations[i].name ? s->animations[i].name : "unnamed";
        for (size_t k = 0; k < p->job.when.clip_count; k++)
            is_told = is_told || p->job.when.clips[k] == i;
        if (is_told)
            snprintf(told, sizeof told, "clip %zu, '%.80s'", i + 1, name);
        else if (used + 100 < sizeof others)
            used +=
                (size_t)snprintf(others + used, sizeof others - used, "%s%zu '%.60s'", used ? ", " : "", i + 1, name);
    }
    if (!s->animation_count)
        warnings_add(p->job.warnings, WARNING_UNTOLD, "nothing in the scene is animated");
    else if (others[0])
        warnings_add(p->job.warnings, WARNING_UNTOLD, "this is %s; there are also, with --clip: %s", told, others);
}

/* Does any expression put a sign beside the thing itself? */
static bool tells_motion(const proposal *p, size_t first)
{
    for (size_t i = first; i < p->out->count; i++) {
        const expression *e = &p->out->items[i];
        if (strcmp(e->row->characteristic, "still") != 0 || !param_is_default(&e->row->params[0], e->values))
            return true;
    }
    return false;
}

/* The noise that an expression has; NULL: it is of no kind that has any. */
static const char *noise_of(const expression *e)
{
    for (size_t i = 0; i < e->row->param_count; i++)
        if (strcmp(e->row->params[i].key, "text") == 0)
            return ((const param_words *)((const char *)e->values + e->row->params[i].offset))->text;
    return NULL;
}

/* Where several things hit something their stars are smaller, or they would hide each other. */
static void make_room_for_stars(const proposal *p)
{
    const double among_others = 1.15;
    size_t       count = 0;
    for (size_t i = 0; i < p->out->count; i++)
        count += strcmp(p->out->items[i].row->characteristic, "collision") == 0;
    for (size_t i = 0; i < p->out->count && count > 1; i++)
        if (strcmp(p->out->items[i].row->characteristic, "collision") == 0)
            set_number(&p->out->items[i], "size", among_others);
}

/* A noise that nobody wrote costs nobody the picture. */
static lmn_status leave_out_noises(const proposal *p, lmn_error *error)
{
    bool said = false;
    for (size_t i = 0; i < p->out->count; i++) {
        expression *e = &p->out->items[i];
        lmn_error   why = {0};
        const char *noise = noise_of(e);
        if (!noise || !noise[0])
            continue;
        lmn_status status = construct_text_check(noise, LETTERING_FONT, &why);
        if (status == LMN_MEMORY)
            return error_memory(error);
        if (status != LMN_OK && !said)
            warnings_add(p->job.warnings, WARNING_UNTOLD, "'%s' is left out: %s", noise, why.message);
        said = said || status != LMN_OK;
        if (status != LMN_OK)
            set_text(e, "text", "");
    }
    return LMN_OK;
}

static lmn_status tell_all(const proposal *p, mover_list *movers, lmn_error *error)
{
    lmn_status status = LMN_OK;
    size_t     told = 0, left = 0, still = 0;
    for (size_t i = 0; i < movers->count && status == LMN_OK; i++) {
        const size_t first = p->out->count;
        if (movers->items[i].grouped)
            continue;
        if (told < MOVERS_TOLD) {
            status = tell(p, movers, &movers->items[i], error);
            const bool tells = status != LMN_OK || tells_motion(p, first);
            told += tells;
            if (!tells && still++ < MOVERS_TOLD)
                say_untold(p, &movers->items[i]);
        } else
            left++;
    }
    if (left)
        warnings_add(p->job.warnings, WARNING_UNTOLD,
                     "%zu more things move; the %d that go farthest or are largest are told", left, (int)MOVERS_TOLD);
    if (still > MOVERS_TOLD)
        warnings_add(p->job.warnings, WARNING_UNTOLD, "%zu more things hardly move", still - MOVERS_TOLD);
    if (status == LMN_OK && !movers->count && p->job.when.clip_count)
        warnings_add(p->job.warnings, WARNING_UNTOLD, "the clip moves nothing that can be seen");
    if (status == LMN_OK && !tells_motion(p, 0))
        say_clips(p);
    return status;
}

lmn_status depict_propose(expression_list *out, json_t **reasons, const lmn_scene *scene, const moment *when,
                          double from, double to, warnings *warnings, lmn_error *error)
{
    depict_poses poses = {.count = 0};
    proposal     p = {.job = {.scene = scene, .when = *when, .warnings = warnings, .poses = &poses, .size = 1},
                      .out = out,
                      .reasons = reasons,
                      .from = from,
                      .to = to,
                      .now = when->seconds};
    mover_list   movers;
    if (reasons)
        *reasons = json_array();
    const mat4 *worlds = depict_worlds_at_rest(&p.job);
    const box3  box = worlds ? scene_bounds(scene, worlds) : box3_empty();
    p.job.size = box3_is_empty(box) || !(box3_diagonal(box) > 0) ? 1 : box3_diagonal(box);
    lmn_status status = movers_find(&movers, &p.job, from, to, when->seconds, error);
    if (status == LMN_OK)
        status = find_patterns(movers.items, movers.count, &p, error);
    if (status == LMN_OK)
        status = tell_groups(movers.items, movers.count, &p, error);
    if (status == LMN_OK)
        status = tell_all(&p, &movers, error);
    if (status == LMN_OK) {
        make_room_for_stars(&p);
        status = leave_out_noises(&p, error);
    }
    movers_release(&movers);
    depict_poses_release(&poses);
    return status == LMN_OK ? work_check(error) : status;
}
