#include "plan/time.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "motion/motion.h"

lmn_status time_moment(moment *out, const lmn_scene *scene, const lmn_draw_desc *desc, warnings *warnings,
                       lmn_error *error)
{
    lmn_status status = LMN_OK;
    *out = moment_at_rest();
    if (desc->clip || desc->time_given || desc->time_s != 0)
        status = moment_find(out, scene, desc->clip, desc->time_s, warnings, error);
    if (status == LMN_OK && desc->fit_time && !out->clip_count && warnings)
        warnings_add(warnings, WARNING_UNUSED, "nothing is fitted to the time of clips: %s",
                     scene->animation_count ? "the model is drawn at rest" : "the model has no animation");
    return status;
}

lmn_status time_check(const lmn_look *look, lmn_error *error)
{
    const motion_common *first = NULL;
    for (size_t i = 0; i < look->rule_count; i++) {
        const motion_common *own =
            look->rules[i].use_counts[KIND_MOTION] ? look->rules[i].uses[KIND_MOTION][0].values : NULL;
        if (first && own && own->exposure != first->exposure) {
            error_set(error, LMN_USAGE, "two rules of the look ask for different motion: exposures of %g s and %g s",
                      (double)first->exposure, (double)own->exposure);
            error_hint(error, "a picture has one exposure: give them the same motion.exposure");
            return LMN_USAGE;
        }
        if (first && own && own->response != first->response) {
            error_set(error, LMN_USAGE, "two rules of the look ask for different motion: responses of %g s and %g s",
                      (double)first->response, (double)own->response);
            error_hint(error, "give them the same motion.response");
            return LMN_USAGE;
        }
        first = own ? own : first;
    }
    return LMN_OK;
}

double time_exposure(const lmn_look *look)
{
    for (size_t i = 0; i < look->rule_count; i++)
        if (look->rules[i].use_counts[KIND_MOTION])
            return (double)((const motion_common *)look->rules[i].uses[KIND_MOTION][0].values)->exposure;
    return kind_motion.common[0].def;
}

void time_warn_of_rest(const lmn_look *look, const pose *p, warnings *warnings)
{
    bool tells = false;
    for (size_t i = 0; i < look->rule_count; i++)
        tells = tells || look->rules[i].use_counts[KIND_MOTION];
    if (tells && !p->at_rest)
        warnings_add(warnings, WARNING_UNUSED, "motion: nothing moves without a time of an animation");
}

const rule *time_rule(const lmn_look *look, const lmn_scene *scene, size_t part)
{
    for (size_t r = look->rule_count; r-- > 0;)
        if (!look->rules[r].selector || selector_matches(look->rules[r].selector, scene, part))
            return &look->rules[r];
    return NULL;
}

void swept_boxes_release(swept_boxes *s)
{
    mem_free(s->boxes);
    memset(s, 0, sizeof *s);
}

lmn_status swept_boxes_fit(swept_boxes *s, pose *p, lmn_error *error)
{
    moment clips = p->when;
    clips.seconds = 0;
    if (!clips.clip_count)
        return LMN_OK;
    if (!s->boxes || s->revision != p->scene->revision || !moment_equal(&s->clips, &clips)) {
        swept_boxes_release(s);
        lmn_status status = pose_swept_boxes(&s->boxes, p->scene, &clips, error);
        if (status != LMN_OK)
            return status;
        s->revision = p->scene->revision;
        s->clips = clips;
    }
    p->fit_boxes = s->boxes;
    return LMN_OK;
}

/* --- plates ----------------------------------------------------------------------------------------------- */

static const technique_use *plate_of(const lmn_look *look, const lmn_scene *scene, size_t part)
{
    const rule          *r = time_rule(look, scene, part);
    const technique_use *use = r && r->use_counts[KIND_MOTION] ? &r->uses[KIND_MOTION][0] : NULL;
    const motion_row    *row = use ? use->technique->motion : NULL;
    return row && row->plate && row->plate(use->values) ? use : NULL;
}

/* Those at equal distances are known. The telling ones are some in between, and are found on the page later: evenly
 * spread ones stand for them. Returns how many. */
static int plate_times(double **out, const technique_use *use, double now)
{
    enum { SPREAD = 64 };
    const motion_row *row = use->technique->motion;
    int               wished, times = row->times(use->values);
    double            cover, seconds = (double)((const motion_common *)use->values)->exposure;
    bool              chosen = row->chooses && row->chooses(use->values, &wished, &cover);
    int               count = chosen ? SPREAD + 1 : times;
    *out = mem_alloc((size_t)count * sizeof **out);
    for (int i = 0; *out && i < count; i++)
        (*out)[i] = fmax(now - (chosen ? fmin(seconds, now) * i / SPREAD : seconds * i / times), 0);
    return count;
}

lmn_status plate_boxes_fit(swept_boxes *s, pose *p, const lmn_look *look, lmn_error *error)
{
    const technique_use *use = NULL;
    double              *times = NULL;
    size_t               all = p->part_count + p->ghost_count;
    for (size_t i = 0; i < all && !use; i++)
        use = plate_of(look, p->scene, i);
    if (!use || !p->when.clip_count)
        return LMN_OK;
    int        count = plate_times(&times, use, p->when.seconds);
    lmn_status status =
        times ? pose_boxes_at(&s->boxes, p->scene, &p->when, times, (size_t)count, error) : error_memory(error);
    mem_free(times);
    if (status != LMN_OK)
        return status;
    for (size_t i = 0; i < all; i++)
        s->boxes[i] = plate_of(look, p->scene, i) ? box3_union(s->boxes[i], p->part_boxes[i]) : p->part_boxes[i];
    p->fit_boxes = s->boxes;
    return LMN_OK;
}
