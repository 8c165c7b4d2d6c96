/* A figure on the page: its range of depth and the pixels that it and its lines can reach. */
#include "frame/frame_private.h"

#include <math.h>
#include <string.h>

/* The sum of the lengths that matter with these values. */
static float lengths_of(const param *params, size_t count, const void *values)
{
    float sum = 0;
    for (size_t i = 0; i < count; i++) {
        const param *p = &params[i];
        bool         widens = p->unit == UNIT_PT && p->type == PARAM_FLOAT && !p->along && !param_is_auto(p, values);
        if (widens && params_condition(p->only_if, params, count, values))
            sum += fabsf(*(const float *)param_field(p, values)) * (p->reach > 0 ? p->reach : 1);
    }
    return sum;
}

int figure_reach(const figure *fig)
{
    const rule *r = fig->rule;
    float       widest = 0;
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const technique_use *use = &r->uses[KIND_LINES][i];
        widest += lengths_of(kinds[KIND_LINES]->common, kinds[KIND_LINES]->common_count, use->values);
        widest += lengths_of(use->technique->params, use->technique->param_count, use->values);
    }
    const technique_use *compose = rule_use(r, KIND_COMPOSE);
    if (compose && fig->layered)
        widest += lengths_of(compose->technique->params, compose->technique->param_count, compose->values);
    const technique_use *perturb = rule_use(r, KIND_PERTURB);
    if (perturb)
        widest += perturb->technique->perturbs->reach(perturb->values);
    return (int)ceilf(widest) + 2;
}

/* Leaves the part of its pixels that is in the box which maps are of; empty where there is none. */
static void keep_box(const frame_maps *m, figure_state *s)
{
    const int box[4] = {m->x, m->y, m->width, m->height};
    for (int k = 0; k < 2; k++) {
        int low = s->pixels[k] > box[k] ? s->pixels[k] : box[k];
        int high = s->pixels[k] + s->pixels[2 + k], end = box[k] + box[2 + k];
        s->pixels[k] = low;
        s->pixels[2 + k] = (high < end ? high : end) - low;
        s->around[k] = box[k];
        s->around[2 + k] = box[2 + k];
    }
}

bool figure_open(frame *f, figure_state *s, const figure *fig)
{
    *s = (figure_state){.figure = fig, .near = f->camera.near, .far = f->camera.far};
    double nearest = INFINITY, farthest = -INFINITY;
    box3   box = fig->complement ? f->plan->box : fig->box;
    camera_depth_range(&f->camera, box, &nearest, &farthest);
    double margin = fmax((farthest - nearest) * 1e-3, farthest * 1e-6);
    s->near = fmax(nearest - margin, f->camera.near);
    s->far = fmin(farthest + margin, f->camera.far);
    if (!(s->far > s->near))
        s->far = s->near + 1;
    camera_pixels(&f->camera, fig->box, f->width, f->height, figure_reach(fig), s->pixels);
    if (f->maps && f->maps->part)
        keep_box(f->maps, s);
    else if (!f->maps) /* maps are read back whole */
        camera_pixels(&f->camera, fig->box, f->width, f->height, 2 * figure_reach(fig) + 2, s->around);
    memcpy(s->drawn[0], s->pixels, sizeof s->drawn[0]);
    memcpy(s->drawn[1], s->around, sizeof s->drawn[1]);
    if (!f->maps)
        window_figure(f, s);
    return s->pixels[2] > 0 && s->pixels[3] > 0 && !gpu_failed(f->g);
}
