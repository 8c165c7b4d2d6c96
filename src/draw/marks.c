/* Marks of figures on the GPU: kept with the upload as long as what they are made from stays the same, and drawn over the figure's shade, each frame anew decided which. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "draw/frame_private.h"
#include "draw/marks.h"
#include "halftone/store.h"
#include "surface/marks.h"

enum { SETS_MAX = 8, DOT_VECTORS = 2, LINE_VECTORS = 5 };

/* The marks of one figure. */
struct mark_set {
    uint64_t   key, used; /* of what they are made from; when they were drawn last */
    gpu_marks *marks;     /* NULL: there are none */
    double     origin[3];
    double     density;  /* dots to a unit of area; strokes: the least length of them to one */
    float     *ranks;    /* of strokes, in their order on the GPU; NULL: dots, in that of their priorities */
    size_t     count;
    bool       lines;
};

struct mark_sets {
    struct mark_set sets[SETS_MAX];
    uint64_t        clock;
};

static void set_release(struct mark_set *s, gpu *g)
{
    gpu_marks_destroy(g, &s->marks);
    mem_free(s->ranks);
    *s = (struct mark_set){.key = 0};
}

void mark_sets_release(mark_sets **all, gpu *g)
{
    for (size_t i = 0; *all && i < SETS_MAX; i++)
        set_release(&(*all)->sets[i], g);
    mem_free(*all);
    *all = NULL;
}

/* What decides which marks a figure has, beside the scene that the upload belongs to. */
static uint64_t key_of(const frame *f, const figure *fig, const technique_use *surface, bool points)
{
    text t = {0};
    surface->technique->marks->describe(&t, surface->values);
    text_append(&t, " %.17g %d ", f->up->crease_angle, points);
    for (size_t i = 0; i < f->plan->part_count; i++)
        text_append(&t, "%c", fig->designated[i] ? 'x' : '.');
    char *words = text_take(&t);
    uint64_t key = words ? store_hash(words, strlen(words)) : 0;
    if (!words)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    mem_free(words);
    return key;
}

static gpu_marks *upload_dots(gpu *g, const marks *m, bool points)
{
    float (*records)[4] = mem_alloc(m->dot_count * DOT_VECTORS * sizeof *records);
    for (size_t i = 0; records && i < m->dot_count; i++) {
        const mark_dot *d = &m->dots[i];
        memcpy(records[DOT_VECTORS * i], (float[]){d->place.x, d->place.y, d->place.z, d->priority}, sizeof *records);
        memcpy(records[DOT_VECTORS * i + 1], (float[]){d->normal.x, d->normal.y, d->normal.z, d->bright}, sizeof *records);
    }
    gpu_marks *(*create)(gpu *, int, const float *, size_t) = points ? gpu_marks_create_points : gpu_marks_create;
    gpu_marks *out = records ? create(g, DOT_VECTORS, records[0], m->dot_count) : NULL;
    if (!records)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    mem_free(records);
    return out;
}

static int by_perspective(const void *left, const void *right)
{
    const mark_line *a = *(const mark_line *const *)left, *b = *(const mark_line *const *)right;
    if (a->perspective != b->perspective)
        return a->perspective > b->perspective ? -1 : 1;
    return a < b ? -1 : a > b;
}

static void write_line(float (*r)[4], const mark_line *l)
{
    memcpy(r[0], (float[]){l->a.x, l->a.y, l->a.z, l->light}, sizeof *r);
    memcpy(r[1], (float[]){l->b.x, l->b.y, l->b.z, l->perspective}, sizeof *r);
    memcpy(r[2], (float[]){l->middle.x, l->middle.y, l->middle.z, l->bright}, sizeof *r);
    memcpy(r[3], (float[]){l->middle_normal.x, l->middle_normal.y, l->middle_normal.z, l->density}, sizeof *r);
    memcpy(r[4], (float[]){l->from, l->to, l->length, l->span}, sizeof *r);
}

/* Those that stay longest with distance come first, so that from far away only the first need to be looked at. */
static void upload_lines(gpu *g, const marks *m, struct mark_set *out)
{
    float (*records)[4] = mem_alloc(m->line_count * LINE_VECTORS * sizeof *records);
    const mark_line **order = mem_alloc(m->line_count * sizeof *order);
    out->ranks = mem_alloc(m->line_count * sizeof *out->ranks);
    out->lines = true;
    out->density = INFINITY;
    if (records && order && out->ranks) {
        for (size_t i = 0; i < m->line_count; i++)
            order[i] = &m->lines[i];
        qsort(order, m->line_count, sizeof *order, by_perspective);
        for (size_t i = 0; i < m->line_count; i++) {
            write_line(&records[LINE_VECTORS * i], order[i]);
            out->ranks[i] = 1 - order[i]->perspective;
            out->density = fmin(out->density, (double)order[i]->density);
        }
        out->marks = gpu_marks_create(g, LINE_VECTORS, records[0], m->line_count);
    } else {
        gpu_fail(g, LMN_MEMORY, "out of memory");
    }
    mem_free(records);
    mem_free(order);
}

static void make_set(frame *f, const figure *fig, const technique_use *surface, bool points, struct mark_set *out)
{
    mark_ground ground;
    marks made = {.dots = NULL};
    lmn_error error;
    lmn_status status = mark_ground_create(&ground, f->plan->scene, f->up->worlds, fig->designated, f->plan->part_count, f->up->crease_angle, &error);
    if (status == LMN_OK) {
        status = mark_ground_marks(&made, &ground, surface, &error);
        memcpy(out->origin, ground.origin, sizeof out->origin);
        mark_ground_release(&ground);
    }
    if (status != LMN_OK) {
        gpu_fail(f->g, status, "%s", error.message);
        return;
    }
    out->count = made.dot_count ? made.dot_count : made.line_count;
    if (made.dot_count) {
        out->density = (double)made.dot_count / made.area;
        out->marks = upload_dots(f->g, &made, points);
    } else if (made.line_count) {
        upload_lines(f->g, &made, out);
    }
    surface_marks_release(&made);
}

/* Finds or makes them; the set that was not drawn for longest goes. NULL after an error. */
static struct mark_set *set_of(frame *f, const figure *fig, const technique_use *surface, bool points)
{
    if (!f->up->marks && !(f->up->marks = mem_calloc(1, sizeof *f->up->marks))) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    mark_sets *all = f->up->marks;
    uint64_t key = key_of(f, fig, surface, points);
    struct mark_set *oldest = &all->sets[0];
    for (size_t i = 0; i < SETS_MAX; i++) {
        struct mark_set *s = &all->sets[i];
        if (s->used && s->key == key) {
            s->used = ++all->clock;
            return s;
        }
        if (s->used < oldest->used)
            oldest = s;
    }
    set_release(oldest, f->g);
    oldest->key = key;
    make_set(f, fig, surface, points, oldest);
    oldest->used = gpu_failed(f->g) ? 0 : ++all->clock;
    return gpu_failed(f->g) ? NULL : oldest;
}

/* How many of the set, in its order, can be drawn at all: what a place of the figure that is as near and as much towards the eye as can be asks for. */
static size_t count_to_draw(const frame *f, const figure *fig, const struct mark_set *set, const mark_style *style)
{
    const double *p = f->camera.projection.m, SPARE = 1.01;
    double nearest = INFINITY, farthest = -INFINITY, focal = p[5] * f->height / 2;
    camera_depth_range(&f->camera, fig->box, &nearest, &farthest);
    /* Pixels to a unit there; beside the middle of the picture things are seen larger. */
    double scale = focal;
    if (!f->camera.orthographic)
        scale = focal * sqrt(1 + 1 / (p[0] * p[0]) + 1 / (p[5] * p[5])) / fmax(nearest, f->camera.near);
    double share, size = (double)style->diameter;
    if (set->lines)
        share = scale / (set->density * (double)style->scale);
    else
        share = (double)mark_ink_of_cover(1, 1 / (style->diameter * style->diameter)) / (0.78539816 * size * size) * scale * scale / set->density;
    double most = share * (1 + (double)style->fade) * SPARE;
    if (!(most < 1))
        return set->count;
    if (!set->lines)
        return (size_t)ceil(most * (double)set->count);
    size_t low = 0, high = set->count;
    while (low < high) {
        size_t middle = low + (high - low) / 2;
        if ((double)set->ranks[middle] <= most)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

bool figure_has_marks(const figure *fig)
{
    const technique_use *surface = rule_use(fig->rule, KIND_SURFACE);
    return surface && surface->technique->marks;
}

void marks_draw(frame *f, figure_state *s, gpu_texture *onto)
{
    const technique_use *surface = rule_use(s->figure->rule, KIND_SURFACE);
    if (!figure_has_marks(s->figure) || gpu_failed(f->g))
        return;
    stopwatch w = watch_start(f);
    const mark_source *source = surface->technique->marks;
    bool points = source->point && source->point(surface->values) <= gpu_facts_of(f->g)->max_point;
    struct mark_set *set = set_of(f, s->figure, surface, points);
    text prelude = {0};
    lights_declare(&prelude, f);
    uniforms_declare(&prelude, use_own_set(KIND_SURFACE, surface));
    if (points)
        text_append(&prelude, "#define AS_POINTS\n");
    target_declare(&prelude, &target_rows[TARGET_NORMAL_DEPTH]);
    gpu_program *p = set && set->marks ? program_of(f, GPU_FLOOR, source->vertex, source->fragment, &prelude) : NULL;
    if (p && !gpu_failed(f->g)) {
        gpu_pass pass = {.colours = {onto}, .colour_count = 1};
        memcpy(pass.scissor, s->pixels, sizeof pass.scissor);
        gpu_pass_begin(f->g, &pass);
        gpu_use(f->g, p, (gpu_state){.blend = GPU_BLEND_OVER});
        frame_set_common(f, s);
        uniforms_set(f->g, use_own_set(KIND_SURFACE, surface));
        mat4 world = mat4_identity();
        memcpy(&world.m[12], set->origin, sizeof set->origin);
        frame_set_transform(f, &world);
        frame_set_projection(f);
        gpu_set_float(f->g, "u_focal", (float)(f->camera.projection.m[5] * f->height / 2));
        gpu_set_float(f->g, "u_density", (float)set->density);
        gpu_set_float(f->g, "u_near_plane", (float)f->camera.near);
        gpu_set_texture(f->g, target_rows[TARGET_NORMAL_DEPTH].name, s->targets[TARGET_NORMAL_DEPTH], false);
        mark_style style = {.diameter = 1};
        surface_mark_style(&style, surface);
        gpu_draw_first_marks(f->g, set->marks, count_to_draw(f, s->figure, set, &style));
    }
    if (!p) {
        char *unused = text_take(&prelude);
        mem_free(unused);
    }
    watch_stop(f, w, "surface", "marks");
}
