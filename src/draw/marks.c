/* Marks of figures on the GPU: kept with the upload as long as what they are made from stays the same, and drawn over the figure's shade, each frame anew decided which. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "draw/frame_private.h"
#include "draw/marks.h"
#include "halftone/store.h"

enum { SETS_MAX = 8, DOT_VECTORS = 2, LINE_VECTORS = 5 };

/* The marks of one figure. */
struct mark_set {
    uint64_t   key, used; /* of what they are made from; when they were drawn last */
    gpu_marks *marks;     /* NULL: there are none */
    double     origin[3], density; /* dots to a unit of area */
};

struct mark_sets {
    struct mark_set sets[SETS_MAX];
    uint64_t        clock;
};

void mark_sets_release(mark_sets **all, gpu *g)
{
    for (size_t i = 0; *all && i < SETS_MAX; i++)
        gpu_marks_destroy(g, &(*all)->sets[i].marks);
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

static gpu_marks *upload_lines(gpu *g, const marks *m)
{
    float (*records)[4] = mem_alloc(m->line_count * LINE_VECTORS * sizeof *records);
    for (size_t i = 0; records && i < m->line_count; i++) {
        const mark_line *l = &m->lines[i];
        float (*r)[4] = &records[LINE_VECTORS * i];
        memcpy(r[0], (float[]){l->a.x, l->a.y, l->a.z, l->light}, sizeof *r);
        memcpy(r[1], (float[]){l->b.x, l->b.y, l->b.z, l->perspective}, sizeof *r);
        memcpy(r[2], (float[]){l->middle.x, l->middle.y, l->middle.z, l->bright}, sizeof *r);
        memcpy(r[3], (float[]){l->middle_normal.x, l->middle_normal.y, l->middle_normal.z, l->density}, sizeof *r);
        memcpy(r[4], (float[]){l->from, l->to, l->length, l->span}, sizeof *r);
    }
    gpu_marks *out = records ? gpu_marks_create(g, LINE_VECTORS, records[0], m->line_count) : NULL;
    if (!records)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    mem_free(records);
    return out;
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
    out->density = made.area > 0 ? (double)made.dot_count / made.area : 0;
    out->marks = made.dot_count ? upload_dots(f->g, &made, points) : made.line_count ? upload_lines(f->g, &made) : NULL;
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
    gpu_marks_destroy(f->g, &oldest->marks);
    *oldest = (struct mark_set){.key = key};
    make_set(f, fig, surface, points, oldest);
    oldest->used = gpu_failed(f->g) ? 0 : ++all->clock;
    return gpu_failed(f->g) ? NULL : oldest;
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
        gpu_set_texture(f->g, "t_normal_depth", s->targets[TARGET_NORMAL_DEPTH], false);
        gpu_draw_marks(f->g, set->marks);
    }
    if (!p) {
        char *unused = text_take(&prelude);
        mem_free(unused);
    }
    watch_stop(f, w, "surface", "marks");
}
