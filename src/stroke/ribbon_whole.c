/* Strokes as the pen has them: stretches of a chain with nothing between them but what is thinner than the pen are one
 * stroke. Strokes themselves keep saying what is hidden; only what is drawn is bridged. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/ribbon_private.h"

static const float bridged_widths = 1.5f; /* hidden stretches shorter than this many widths are drawn over */
static const float bridged_least = 1;     /* the same on paper: pieces that were linked */

static const stroke_point *first_of(const stroke_set *set, const stroke *s)
{
    return &set->points[s->first];
}

static const stroke_point *last_of(const stroke_set *set, const stroke *s)
{
    return &set->points[s->first + s->count - 1];
}

/* Up to which gap two stretches are one. With halos, what passes in front shall be seen to do so. */
static float bridged_by(const ribbon_job *job, const stroke *s)
{
    float least = bridged_least;
    return job->style->halo > 0 ? least : fmaxf(least, bridged_widths * ribbon_width(job, s));
}

/* The next stroke of the chain that this one goes on as; 0: none. Hidden ones between them are drawn over. */
static size_t next_of(const ribbon_job *job, size_t index)
{
    const stroke_set *set = job->strokes;
    const stroke     *s = &set->strokes[index];
    if (s->hidden_by > 0 || s->count < 2 || s->closed)
        return 0;
    for (size_t i = index + 1; i < set->stroke_count && set->strokes[i].chain == s->chain; i++) {
        const stroke *t = &set->strokes[i];
        float         gap = t->count ? first_of(set, t)->arc - last_of(set, s)->arc : INFINITY;
        if (!(gap >= 0 && gap <= bridged_by(job, s)))
            return 0;
        if (t->hidden_by == 0 && t->kind == s->kind && t->count > 1 && !t->closed)
            return i;
    }
    return 0;
}

static void append(stroke_set *out, const stroke_set *from, const stroke *s)
{
    memcpy(out->points + out->point_count, from->points + s->first, s->count * sizeof *out->points);
    out->point_count += s->count;
}

bool ribbon_make_whole(stroke_set *out, const ribbon_job *job)
{
    const stroke_set *set = job->strokes;
    size_t            points = 0;
    for (size_t i = 0; i < set->stroke_count; i++)
        points += set->strokes[i].count;
    *out = *set;
    out->marks = NULL;
    out->fine = NULL; /* points go on referring to those of the set */
    out->stroke_count = out->point_count = out->mark_count = out->fine_count = 0;
    out->strokes = mem_alloc((set->stroke_count + 1) * sizeof *out->strokes);
    out->points = mem_alloc((points + 1) * sizeof *out->points);
    if (!out->strokes || !out->points)
        return false;
    for (size_t i = 0; i < set->stroke_count; i++) {
        stroke s = set->strokes[i];
        s.first = (uint32_t)out->point_count;
        append(out, set, &set->strokes[i]);
        for (size_t next; (next = next_of(job, i)) != 0; i = next)
            append(out, set, &set->strokes[next]);
        s.count = (uint32_t)(out->point_count - s.first);
        out->strokes[out->stroke_count++] = s;
    }
    return true;
}
