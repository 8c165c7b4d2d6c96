/* Exposures: whole pictures at several times, whose mean is encoded. Großmann 2011, section 4.2.1. */
#include "draw/exposure.h"

#include <string.h>

#include "base/memory.h"
#include "motion/motion.h"

void exposure_release(exposure *e)
{
    mem_free(e->moves);
    mem_free(e->goes);
    mem_free(e->values);
    mem_free(e->ago);
    memset(e, 0, sizeof *e);
}

/* One picture is drawn of all figures together, so their exposures are one. */
static bool agrees(const exposure *e, const technique_use *use)
{
    return e->technique == use->technique && memcmp(e->values, use->values, use->technique->params_size) == 0;
}

/* Of a figure of the plan, which ends before the last picture is drawn. */
static bool take(exposure *e, const technique_use *use)
{
    e->technique = use->technique;
    e->values = mem_copy(use->values, use->technique->params_size);
    if (!e->values)
        return false;
    e->seconds = (double)((const motion_common *)e->values)->exposure;
    e->times = use->technique->motion->times(e->values);
    return true;
}

lmn_status exposure_find(exposure *out, const plan *p, lmn_error *error)
{
    size_t all = p->scene->part_count + p->scene->ghost_count;
    *out = (exposure){.moves = mem_calloc(all, sizeof *out->moves)};
    if (!out->moves)
        return error_memory(error);
    if (!p->pose->at_rest)
        return LMN_OK;
    for (size_t i = 0; i < p->figure_count; i++) {
        const technique_use *use = rule_use(p->figures[i].rule, KIND_MOTION);
        if (!use || !use->technique->motion->times)
            continue;
        if (out->technique && !agrees(out, use)) {
            error_set(error, LMN_USAGE, "two rules of the look ask for different motion");
            error_hint(error, "a picture has one exposure: give them the same values");
            return LMN_USAGE;
        }
        if (!out->technique && !take(out, use))
            return error_memory(error);
        for (size_t k = 0; k < p->part_count; k++)
            out->moves[k] = out->moves[k] || p->figures[i].designated[k];
    }
    return LMN_OK;
}

/* The i-th picture of the exposure; the last one is of the time that is drawn. */
static lmn_status draw_one(const exposure *e, int i, session *s, lmn_renderer *r, const lmn_scene *scene,
                           const lmn_look *look, const draw_options *options, box3 anchor, gpu_texture **mean,
                           double part, bool plate, lmn_error *error)
{
    lmn_draw_desc desc = *options->desc;
    draw_options  one = *options;
    warnings      said = {0}; /* the first session has said it */
    desc.time_s -= e->ago[i];
    desc.time_given = true;
    one.desc = &desc;
    lmn_status status = session_open(s, r, scene, look, &one, &said, error);
    if (status == LMN_OK) {
        s->frame.anchor = anchor;
        s->frame.time_s = options->desc->time_s; /* what boils does so from picture to picture, not within one */
        if (plate)
            frame_draw_onto_plate(&s->frame, mean, part, e->goes);
        else
            frame_draw_into_mean(&s->frame, mean, part);
        status = gpu_check(r->g, error);
    }
    warnings_release(&said);
    return status;
}

/* Where nothing moves there is one picture. */
static lmn_status choose_moments(exposure *e, const session *s, int count, double cover, lmn_error *error)
{
    const telling_options o = {.pose = s->plan.pose,
                               .parts = e->moves,
                               .seconds = e->seconds,
                               .camera = frame_sheet_camera(&s->frame),
                               .count = count,
                               .cover = cover};
    lmn_status            status = telling_find(&e->telling, &o, error);
    e->times = e->telling.count ? (int)e->telling.count : 1;
    e->ago = status == LMN_OK ? mem_calloc((size_t)e->times, sizeof *e->ago) : NULL;
    for (size_t i = 0; e->ago && i < e->telling.count; i++)
        e->ago[e->telling.count - 1 - i] = e->telling.at[i].ago;
    return status == LMN_OK && !e->ago ? error_memory(error) : status;
}

static lmn_status settle_moments(exposure *e, const session *s, lmn_error *error)
{
    int    count;
    double cover;
    if (e->technique->motion->chooses && e->technique->motion->chooses(e->values, &count, &cover))
        return choose_moments(e, s, count, cover, error);
    e->ago = mem_alloc((size_t)e->times * sizeof *e->ago);
    for (int i = 0; e->ago && i < e->times; i++)
        e->ago[i] = e->seconds * (e->times - 1 - i) / e->times;
    return e->ago ? LMN_OK : error_memory(error);
}

static bool differs(const pose *a, const pose *b, size_t part)
{
    const part_pose *p = &a->parts[part], *q = &b->parts[part];
    int32_t          node = a->scene->parts[part].node;
    return memcmp(&a->worlds[node], &b->worlds[node], sizeof *a->worlds) != 0 ||
           (p->joint_count && memcmp(p->joints, q->joints, p->joint_count * sizeof *p->joints) != 0) ||
           (p->weight_count && memcmp(p->weights, q->weights, p->weight_count * sizeof *p->weights) != 0);
}

/* What of a plate hides what was there before it. */
static lmn_status find_what_goes(exposure *e, const pose *now, lmn_error *error)
{
    lmn_status status = LMN_OK;
    e->goes = mem_calloc(now->scene->part_count + now->scene->ghost_count + 1, sizeof *e->goes);
    if (!e->goes)
        return error_memory(error);
    for (int i = 0; i < e->times && status == LMN_OK; i++) {
        pose   then = {.scene = NULL};
        moment when = now->when;
        when.seconds = when.seconds > e->ago[i] ? when.seconds - e->ago[i] : 0;
        status = pose_create(&then, now->scene, &when, error);
        for (size_t part = 0; part < now->scene->part_count && status == LMN_OK; part++)
            e->goes[part] = e->goes[part] || (e->moves[part] && differs(now, &then, part));
        pose_release(&then);
    }
    return status;
}

static bool everything_moves(const exposure *e, const lmn_scene *scene)
{
    for (size_t i = 0; i < scene->part_count; i++)
        if (!e->moves[i])
            return false;
    return true;
}

lmn_status exposure_draw(exposure *e, session *s, const lmn_look *look, const draw_options *options,
                         exposure_finish_fn finish, void *user, lmn_error *error)
{
    const lmn_draw_desc *desc = options->desc;
    const motion_row    *row = e->technique->motion;
    lmn_renderer        *r = s->renderer;
    const lmn_scene     *scene = s->plan.scene;
    view_camera          camera = s->frame.camera;
    box3                 anchor = s->frame.anchor;
    gpu_texture         *mean = NULL;
    draw_options         one = *options;
    pose                 held;
    double               sum = 0;
    bool                 plate = row->plate && row->plate(e->values);
    lmn_status           status = settle_moments(e, s, error);
    memset(&held, 0, sizeof held);
    if (status == LMN_OK)
        status = pose_create(&held, scene, &r->pose.when, error);
    if (status == LMN_OK && plate && !row->through(e->values))
        status = find_what_goes(e, &held, error);
    one.held = &held;
    one.moves = e->moves;
    /* A camera of the file that moves is exposed too, when everything is. */
    one.camera = desc->camera && everything_moves(e, scene) ? NULL : &camera;
    session_close(s);
    for (int i = 0; i < e->times && status == LMN_OK; i++) {
        double weight = row->weight(e->values, e->times - 1 - i);
        sum += weight;
        if (desc->progress && !desc->progress(0.3 + 0.5 * i / e->times, "drawing", desc->progress_user))
            status = error_set(error, LMN_CANCELLED, "cancelled");
        if (i > 0)
            session_close(s);
        if (status == LMN_OK)
            status = draw_one(e, i, s, r, scene, look, &one, anchor, &mean,
                              plate     ? weight
                              : sum > 0 ? weight / sum
                                        : 1,
                              plate, error);
    }
    if (status == LMN_OK) {
        frame_encode_mean(&s->frame, mean, s->out);
        status = finish(s, user, error);
    }
    gpu_target_release(r->g, mean);
    pose_release(&held);
    return status;
}
