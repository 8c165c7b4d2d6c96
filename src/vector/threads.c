/* Threads of a drawing: made smooth before anything else is done, and marked on each view. */
#include "draft/thread_marks.h"

#include <math.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "light/light.h"
#include "vector/vector_job.h"

lmn_status vector_smooth_threads(vector_job *j, lmn_error *error)
{
    const scene_values *v = j->look->wide[KIND_SCENE].values;
    section             matched = {.spared = NULL};
    if (!j->wanted->threads || !j->wanted->threads[0])
        return LMN_OK;
    lmn_status status = section_spare(&matched, j->scene, j->wanted->threads, error);
    j->threaded = matched.spared;
    bool any = false;
    for (size_t i = 0; status == LMN_OK && i < j->scene->part_count; i++)
        any = any || j->threaded[i];
    if (status == LMN_OK && !any) {
        status = error_set(error, LMN_USAGE, "the selection '%s' of threads matches none of %zu parts",
                           j->wanted->threads, j->scene->part_count);
        error_hint(error, "`limner info` lists the parts with their names and paths");
    }
    if (status == LMN_OK)
        status = draft_threads_smooth(&j->scene, &j->smooth, j->scene, j->threaded,
                                      (double)v->crease_angle * (3.14159265358979323846 / 180), error);
    return status;
}

lmn_status vector_find_threads(vector_job *j, const stroke_scene *scene, lmn_error *error)
{
    lmn_status status = draft_threads_place(&j->threads, &j->smooth.threads, scene, error);
    return status == LMN_OK ? draft_threads_named(&j->threads, &j->cylinders, j->scene, j->threaded, j->unit_mm, error)
                            : status;
}

/* What is seen of the view at hand. */
typedef struct view_sight {
    const stroke_view *view;
    const cut         *cut; /* NULL: the part is whole */
} view_sight;

static void count_in_view(const void *user, const double (*places)[3], size_t count, uint32_t *out)
{
    stroke_view_count(((const view_sight *)user)->view, places, count, out);
}

static bool is_away(const void *user, const double place[3])
{
    const view_sight *s = user;
    return s->cut && vector_is_cut_away(s->cut, place);
}

/* Is a shaft screwed into a bore's thread? It comes first, wherever both would be drawn (ISO 6410-1). */
static bool is_filled(const vector_job *j, const draft_thread *bore)
{
    bool filled = false;
    for (size_t i = 0; i < j->threads.count && bore->hollow; i++) {
        const draft_thread *t = &j->threads.items[i];
        double              to[3], way, radial[3];
        if (t->hollow || fabs(vector3_dot(t->axis, bore->axis)) < 0.9999)
            continue;
        vector3_mix(to, bore->ends[0], bore->ends[1], 0.5);
        vector3_add(to, to, -1, t->ends[0]);
        way = vector3_dot(to, t->axis);
        vector3_add(radial, to, -way, t->axis);
        filled = filled ||
                 (way > 0 && way < vector3_distance(t->ends[0], t->ends[1]) &&
                  vector3_length(radial) < 0.05 * bore->root && t->crest > bore->crest && t->crest < 1.05 * bore->root);
    }
    return filled;
}

lmn_status vector_put_threads(vector_job *j, const vector_view *v, const stroke_view *view, const cut *cut,
                              uint32_t group, lmn_error *error)
{
    if (!j->threads.count || !v->camera.orthographic)
        return LMN_OK;
    draft_view d = vector_drafting_view(j, v, sheet_add_group(&j->out->page, (int32_t)group, "threads", "thread", 0));
    for (size_t i = 0; i < j->threads.count; i++) {
        const draft_thread *t = &j->threads.items[i];
        bool                whole = j->spared && t->part > 0 && j->spared[t->part - 1];
        view_sight          seen = {view, whole ? NULL : cut};
        draft_sight         sight = {count_in_view, is_away, &seen,
                                     !j->cut_open && vector_draws_hidden(j, t->part) && !is_filled(j, t)};
        draft_thread_marks(&d, t, &sight, &j->out->threads);
    }
    return j->out->page.failed ? error_memory(error) : LMN_OK;
}
