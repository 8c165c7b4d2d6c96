/* The stage: the room that what is told of takes, wherever it goes. Of a ground that is a hundred times as large
 * pictures show what lies in it. */
#include "depict/staging.h"

#include "base/error.h"

double staging_moment(const depict_job *j, int which)
{
    return moment_duration(&j->when, j->scene) * which / (STAGING_MOMENTS - 1);
}

static box3 box_grown(box3 b, double by)
{
    const float f = (float)by;
    b.min = (vec3){b.min.x - f, b.min.y - f, b.min.z - f};
    b.max = (vec3){b.max.x + f, b.max.y + f, b.max.z + f};
    return b;
}

/* Its middle's way, as wide as it is. */
static box3 swept_way(const depict_target *t, const expression *e)
{
    box3 box = box3_empty();
    for (int i = 0; i < STAGING_MOMENTS; i++) {
        double at[3];
        way_point(&t->way, t->centre, e->from + (e->to - e->from) * i / (STAGING_MOMENTS - 1), at);
        box = box3_with_point(box, (vec3){(float)at[0], (float)at[1], (float)at[2]});
    }
    return box_grown(box, t->reach);
}

/* What of it is seen within the interval: it may grow, and limbs reach out. */
static lmn_status swept_parts(box3 *out, const depict_job *j, const depict_target *t, const expression *e,
                              lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (int i = 0; i < STAGING_MOMENTS && status == LMN_OK; i++) {
        const double seconds = staging_moment(j, i);
        const pose  *p = NULL;
        if (seconds < e->from || seconds > e->to)
            continue;
        status = depict_pose(&p, j, seconds, error);
        for (size_t k = 0; k < t->part_count && status == LMN_OK; k++)
            if (t->parts[k])
                *out = box3_union(*out, p->part_boxes[k]);
    }
    return status;
}

/* What goes on shows itself by its way; of what stays it says little without what is around it. */
static lmn_status add_target(box3 *stage, bool *seen, const depict_job *j, const expression *e, lmn_error *error)
{
    const double  around_way = 0.15, around_spot = 2;
    depict_target t;
    lmn_status    status = target_open(&t, j, e->target, error);
    if (status == LMN_OK) {
        bool has_parts = false;
        for (size_t i = 0; i < t.part_count; i++)
            has_parts = has_parts || t.parts[i];
        box3 box = swept_way(&t, e);
        status = swept_parts(&box, j, &t, e, error);
        const double own = 2 * 1.7320508 * t.radius, swept = box3_diagonal(box);
        *stage = box3_union(*stage, box_grown(box, swept > 1.5 * own ? around_way * swept : around_spot * own));
        *seen = *seen || has_parts;
    }
    target_release(&t);
    return status;
}

/* Several things are told of one thing, one behind the other. */
static bool is_as_before(const expression_list *l, size_t i)
{
    const expression *e = &l->items[i], *before = i > 0 ? e - 1 : NULL;
    return before && before->target == e->target && before->from == e->from && before->to == e->to;
}

lmn_status staging_find(box3 *out, const depict_job *j, const expression_list *expressions, lmn_error *error)
{
    bool       seen = false;
    lmn_status status = LMN_OK;
    *out = box3_empty();
    for (size_t i = 0; i < expressions->count && status == LMN_OK; i++) {
        const node *n = &j->scene->nodes[expressions->items[i].target];
        if (n->camera != NONE || n->light != NONE) { /* what they see, or shine on, may be anywhere */
            *out = box3_empty();
            return LMN_OK;
        }
        if (!is_as_before(expressions, i))
            status = add_target(out, &seen, j, &expressions->items[i], error);
    }
    if (!seen)
        *out = box3_empty();
    return status;
}
