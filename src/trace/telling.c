/* The choice among moments that could be taken: best first, none whose figures cover each other too much. */
#include "trace/telling.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "trace/telling_private.h"

/* Figures are compared on a page so many times smaller. */
#define SMALLER 8
/* As many as tell something: those that count at least this fraction of the best one, but no more than so many. */
#define TELLS_LEAST 0.2
enum { TELLS_MOST = 8, TRIES_A_MOMENT = 4 };
/* Of joints with a partner on the other side: at rest its mirrored place is this near, fraction of the skeleton. */
#define PARTNER_NEAR 0.05

typedef struct choice {
    const telling_options *o;
    bool                  *moves; /* per part */
    stroke_camera          small;
    page_mask              core; /* what all figures cover: it tells nothing of how they lie to each other */
    page_mask              taken[TELLING_MOST + 1];
    size_t                 taken_count;
    telling_moments       *out;
} choice;

/* --- figures ---------------------------------------------------------------------------------------------------- */

static lmn_status draw_figure(page_mask *out, const choice *c, double ago, lmn_error *error)
{
    pose       p = {.scene = NULL};
    lmn_status status = pose_before(&p, c->o->pose, ago, error);
    if (status == LMN_OK &&
        !(page_mask_open(out, &c->small) && page_mask_add_parts(out, &p, NULL, c->moves, &c->small)))
        status = error_memory(error);
    pose_release(&p);
    return status;
}

/* The core is what the figures of all moments that could be taken have in common. */
static lmn_status find_core(choice *c, const telling_candidate *list, size_t count, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        page_mask own = {NULL, 0, 0};
        status = work_stopped() ? error_memory(error) : draw_figure(&own, c, list[i].moment.ago, error);
        for (size_t k = 0; status == LMN_OK && i && k < (size_t)own.columns * (size_t)own.rows; k++)
            c->core.covered[k] = c->core.covered[k] && own.covered[k];
        if (i == 0)
            c->core = own;
        else
            page_mask_close(&own);
    }
    return status;
}

/* Which part of the smaller figure lies over the other one, beyond the core. */
static double overlap(const choice *c, const page_mask *a, const page_mask *b)
{
    size_t both = 0, first = 0, second = 0;
    for (size_t i = 0; i < (size_t)a->columns * (size_t)a->rows; i++) {
        if (c->core.covered && c->core.covered[i])
            continue;
        both += a->covered[i] && b->covered[i];
        first += a->covered[i];
        second += b->covered[i];
    }
    size_t least = first < second ? first : second;
    return least ? (double)both / (double)least : 1;
}

/* Takes a moment unless its figure covers another one too much. */
static lmn_status try_moment(choice *c, const telling_moment *m, bool *fits, lmn_error *error)
{
    page_mask  own = {NULL, 0, 0};
    lmn_status status = work_stopped() ? error_memory(error) : draw_figure(&own, c, m->ago, error);
    *fits = status == LMN_OK && c->out->count < TELLING_MOST;
    for (size_t i = 0; i < c->taken_count && *fits; i++)
        *fits = overlap(c, &own, &c->taken[i]) <= c->o->cover;
    if (!*fits) {
        page_mask_close(&own);
        return status;
    }
    c->taken[c->taken_count++] = own;
    c->out->at[c->out->count++] = *m;
    return LMN_OK;
}

/* --- how unlike the sides are ----------------------------------------------------------------------------------- */

typedef struct mirrored {
    const pose *rest;
    int32_t    *joints, root;
    vec3       *at_rest;
    uint32_t   *partners;
    size_t      count;
    int         axis; /* across which sides are mirrored: 0 x, 2 z */
    double      size;
} mirrored;

static double along_axis(vec3 v, int axis)
{
    return axis ? (double)v.z : (double)v.x;
}

static vec3 mirror(vec3 v, int axis, double middle)
{
    float *across = axis ? &v.z : &v.x;
    *across = (float)(2 * middle) - *across;
    return v;
}

static double apart(vec3 a, vec3 b)
{
    double x = (double)(a.x - b.x), y = (double)(a.y - b.y), z = (double)(a.z - b.z);
    return sqrt(x * x + y * y + z * z);
}

static double middle_of(const vec3 *at, size_t count, int axis)
{
    double sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += along_axis(at[i], axis) / (double)count;
    return sum;
}

/* The nearest of all joints to the mirrored place of each; the mean distance. */
static double find_partners(const mirrored *m, int axis, uint32_t *out)
{
    double sum = 0, middle = middle_of(m->at_rest, m->count, axis);
    for (size_t i = 0; i < m->count; i++) {
        double best = INFINITY;
        for (size_t k = 0; k < m->count; k++) {
            double d = apart(mirror(m->at_rest[i], axis, middle), m->at_rest[k]);
            if (d < best) {
                best = d;
                out[i] = (uint32_t)k;
            }
        }
        sum += best / (double)m->count;
    }
    return sum;
}

static const skin *skin_of(const telling_options *o)
{
    const lmn_scene *s = o->pose->scene;
    for (size_t i = 0; i < o->pose->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        if (o->parts[i] && n->skin != NONE && n->mesh != NONE && s->skins[n->skin].joint_count >= 4)
            return &s->skins[n->skin];
    }
    return NULL;
}

static bool open_mirrored(mirrored *m, const telling_options *o, const skin *k)
{
    enum { JOINTS_MOST = 512 };
    uint32_t *other;
    *m = (mirrored){.rest = o->pose->at_rest, .joints = k->joints, .count = k->joint_count};
    m->count = m->count < JOINTS_MOST ? m->count : JOINTS_MOST;
    m->at_rest = mem_alloc(m->count * sizeof *m->at_rest);
    m->partners = mem_alloc(m->count * sizeof *m->partners);
    other = mem_alloc(m->count * sizeof *other);
    if (m->at_rest && m->partners && other) {
        for (size_t i = 0; i < m->count; i++)
            m->at_rest[i] = mat4_transform_point(&m->rest->worlds[k->joints[i]], (vec3){0, 0, 0});
        for (size_t i = 0; i < m->count; i++)
            m->size = fmax(m->size, apart(m->at_rest[i], m->at_rest[0]));
        m->root = k->joints[0];
        double x = find_partners(m, 0, m->partners), z = find_partners(m, 2, other);
        if (z < x) {
            m->axis = 2;
            memcpy(m->partners, other, m->count * sizeof *other);
        }
        if (fmin(x, z) > PARTNER_NEAR * m->size)
            m->count = 0; /* its sides are unlike at rest already */
    }
    bool good = m->at_rest && m->partners && other;
    mem_free(other);
    return good;
}

/* Mean distance of joints from the mirrored places of their partners, with the root as at rest. */
static double asymmetry_at(const mirrored *m, const pose *p)
{
    mat4   back = mat4_inverse(&p->worlds[m->root]), home = mat4_multiply(&m->rest->worlds[m->root], &back);
    double middle = middle_of(m->at_rest, m->count, m->axis), sum = 0;
    for (size_t i = 0; i < m->count; i++) {
        mat4 a = mat4_multiply(&home, &p->worlds[m->joints[i]]),
             b = mat4_multiply(&home, &p->worlds[m->joints[m->partners[i]]]);
        sum += apart(mirror(mat4_transform_point(&a, (vec3){0, 0, 0}), m->axis, middle),
                     mat4_transform_point(&b, (vec3){0, 0, 0}));
    }
    return m->count && m->size > 0 ? sum / (double)m->count / m->size : 0;
}

/* Poses whose sides differ most stand up to half as high again. */
static lmn_status weigh_asymmetry(telling_candidate *list, size_t count, const telling_options *o, lmn_error *error)
{
    const skin *k = skin_of(o);
    mirrored    m = {.rest = NULL};
    lmn_status  status = !k || open_mirrored(&m, o, k) ? LMN_OK : error_memory(error);
    double      most = 0;
    for (size_t i = 0; k && m.count && i < count && status == LMN_OK; i++) {
        pose p = {.scene = NULL};
        status = pose_before(&p, o->pose, list[i].moment.ago, error);
        if (status == LMN_OK)
            most = fmax(most, list[i].moment.asymmetry = asymmetry_at(&m, &p));
        pose_release(&p);
    }
    for (size_t i = 0; i < count && most > 0; i++)
        list[i].score *= 1 + 0.5 * list[i].moment.asymmetry / most;
    mem_free(m.at_rest);
    mem_free(m.partners);
    return status;
}

/* --- choice ------------------------------------------------------------------------------------------------------- */

static int by_score(const void *a, const void *b)
{
    const telling_candidate *p = a, *q = b;
    return p->score != q->score ? (p->score < q->score) - (p->score > q->score)
                                : (p->moment.ago > q->moment.ago) - (p->moment.ago < q->moment.ago);
}

static int by_time(const void *a, const void *b)
{
    const telling_moment *p = a, *q = b;
    return (p->ago > q->ago) - (p->ago < q->ago);
}

static int by_number(const void *a, const void *b)
{
    double p = *(const double *)a, q = *(const double *)b;
    return (p > q) - (p < q);
}

static lmn_status take_best(choice *c, const telling_candidate *list, size_t count, size_t most, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < count && c->out->count < most && status == LMN_OK; i++) {
        bool fits;
        if (c->o->count || list[i].score >= TELLS_LEAST * list[0].score)
            status = try_moment(c, &list[i].moment, &fits, error);
    }
    return status;
}

/* The middle of the largest gap again and again, taken or not. */
static lmn_status fill_gaps(choice *c, double seconds, size_t most, lmn_error *error)
{
    double     bounds[2 + TELLING_MOST * (1 + TRIES_A_MOMENT)] = {0, seconds};
    size_t     count = 2, tries = TRIES_A_MOMENT * most;
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < c->out->count; i++)
        bounds[count++] = c->out->at[i].ago;
    while (c->out->count < most && tries-- > 0 && status == LMN_OK) {
        size_t widest = 0;
        bool   fits;
        qsort(bounds, count, sizeof *bounds, by_number);
        for (size_t i = 1; i + 1 < count; i++)
            if (bounds[i + 1] - bounds[i] > bounds[widest + 1] - bounds[widest])
                widest = i;
        bounds[count] = 0.5 * (bounds[widest] + bounds[widest + 1]);
        status = try_moment(c, &(telling_moment){bounds[count], TELLING_BETWEEN, 0}, &fits, error);
        count++;
    }
    return status;
}

static lmn_status choose(choice *c, telling_candidate *list, size_t count, lmn_error *error)
{
    const telling_options *o = c->o;
    size_t                 most = o->count ? (size_t)fmin(o->count, TELLING_MOST) : TELLS_MOST;
    double                 seconds = fmin(o->seconds, o->pose->when.seconds);
    lmn_status             status = weigh_asymmetry(list, count, o, error);
    qsort(list, count, sizeof *list, by_score);
    if (status == LMN_OK)
        status = find_core(c, list, count, error);
    if (status == LMN_OK && o->beside_now)
        status = draw_figure(&c->taken[c->taken_count++], c, 0, error);
    if (status == LMN_OK)
        status = take_best(c, list, count, most, error);
    if (status == LMN_OK && o->count && count)
        status = fill_gaps(c, seconds, most, error);
    qsort(c->out->at, c->out->count, sizeof *c->out->at, by_time);
    return status;
}

lmn_status telling_find(telling_moments *out, const telling_options *options, lmn_error *error)
{
    telling_candidate list[TELLING_MOST];
    size_t            count = 0;
    choice            c = {.o = options, .out = out, .small = options->camera};
    memset(out, 0, sizeof *out);
    out->now = options->pose->when.seconds;
    out->wanted = (size_t)options->count;
    c.small.width = (int)fmax(options->camera.width / SMALLER, 1);
    c.small.height = (int)fmax(options->camera.height / SMALLER, 1);
    c.moves = mem_calloc(options->pose->part_count + 1, sizeof *c.moves);
    lmn_status status = c.moves ? telling_candidates(list, &count, c.moves, options, error) : error_memory(error);
    if (status == LMN_OK)
        status = choose(&c, list, count, error);
    for (size_t i = 0; i < c.taken_count; i++)
        page_mask_close(&c.taken[i]);
    page_mask_close(&c.core);
    mem_free(c.moves);
    return status;
}

json_t *telling_json(const telling_moments *m)
{
    static const char *const names[] = {"contact", "turn", "end", "between"};
    json_t                  *list = json_array();
    for (size_t i = m->count; i-- > 0;)
        json_array_append_new(list, json_pack("{s:f, s:s, s:f}", "time", m->now - m->at[i].ago, "reason",
                                              names[m->at[i].reason], "asymmetry", m->at[i].asymmetry));
    return list;
}

void telling_warn(const telling_moments *m, warnings *warnings)
{
    if (m->count == 1 && !m->wanted)
        warnings_add(warnings, WARNING_APPROXIMATE,
                     "one moment is drawn: the figures at all others would cover it by more than motion.cover");
    if (m->count < m->wanted)
        warnings_add(warnings, WARNING_APPROXIMATE,
                     "%zu of %zu moments are drawn: more would cover each other by more than motion.cover, or nothing "
                     "moves",
                     m->count, m->wanted);
}
