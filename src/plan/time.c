#include "plan/time.h"

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
