#include "stage/mark_sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/store.h"
#include "stage/mark_ground.h"
#include "surface/marks.h"

enum { SETS_MAX = 8, DOT_VECTORS = 2, LINE_VECTORS = 5 };

struct mark_sets {
    mark_set sets[SETS_MAX];
    uint64_t clock;
};

static void set_release(mark_set *s, gpu *g)
{
    gpu_marks_destroy(g, &s->marks);
    mem_free(s->ranks);
    *s = (mark_set){.key = 0};
}

void mark_sets_release(mark_sets **all, gpu *g)
{
    for (size_t i = 0; *all && i < SETS_MAX; i++)
        set_release(&(*all)->sets[i], g);
    mem_free(*all);
    *all = NULL;
}

/* What decides which marks a figure has, beside the scene that the upload belongs to. */
static uint64_t key_of(gpu *g, const mark_set_options *w)
{
    text t = {0};
    w->surface->technique->surface->marks->describe(&t, w->surface->values);
    text_append(&t, " %.17g %d ", w->crease_angle, w->points);
    for (size_t i = 0; i < w->part_count; i++)
        text_append(&t, "%c", w->parts[i] ? 'x' : '.');
    char    *words = text_take(&t);
    uint64_t key = words ? store_hash(words, strlen(words)) : 0;
    if (!words)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    mem_free(words);
    return key;
}

static gpu_marks *upload_dots(gpu *g, const marks *m, bool points)
{
    float(*records)[4] = mem_alloc(m->dot_count * DOT_VECTORS * sizeof *records);
    for (size_t i = 0; records && i < m->dot_count; i++) {
        const mark_dot *d = &m->dots[i];
        memcpy(records[DOT_VECTORS * i], (float[]){d->position.x, d->position.y, d->position.z, d->priority},
               sizeof *records);
        memcpy(records[DOT_VECTORS * i + 1], (float[]){d->normal.x, d->normal.y, d->normal.z, d->bright},
               sizeof *records);
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
static void upload_lines(gpu *g, const marks *m, mark_set *out)
{
    float(*records)[4] = mem_alloc(m->line_count * LINE_VECTORS * sizeof *records);
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

static void make_set(gpu *g, const mark_set_options *w, mark_set *out)
{
    mark_ground ground;
    marks       made = {.dots = NULL};
    lmn_error   error;
    lmn_status  status = mark_ground_create(&ground, w->pose, w->parts, w->part_count, w->crease_angle, &error);
    if (status == LMN_OK) {
        status = mark_ground_marks(&made, &ground, w->surface, &error);
        memcpy(out->origin, ground.origin, sizeof out->origin);
        mark_ground_release(&ground);
    }
    if (status != LMN_OK) {
        gpu_fail(g, status, "%s", error.message);
        return;
    }
    out->count = made.dot_count ? made.dot_count : made.line_count;
    if (made.dot_count) {
        out->density = (double)made.dot_count / made.area;
        out->marks = upload_dots(g, &made, w->points);
    } else if (made.line_count) {
        upload_lines(g, &made, out);
    }
    surface_marks_release(&made);
}

mark_set *mark_sets_find(mark_sets **slot, gpu *g, const mark_set_options *w)
{
    if (!*slot && !(*slot = mem_calloc(1, sizeof **slot))) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return NULL;
    }
    mark_sets *all = *slot;
    uint64_t   key = key_of(g, w);
    mark_set  *oldest = &all->sets[0];
    for (size_t i = 0; i < SETS_MAX; i++) {
        mark_set *s = &all->sets[i];
        if (s->used && s->key == key) {
            s->used = ++all->clock;
            return s;
        }
        if (s->used < oldest->used)
            oldest = s;
    }
    set_release(oldest, g);
    oldest->key = key;
    make_set(g, w, oldest);
    oldest->used = gpu_failed(g) ? 0 : ++all->clock;
    return gpu_failed(g) ? NULL : oldest;
}
