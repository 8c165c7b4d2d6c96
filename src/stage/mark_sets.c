#include "stage/mark_sets.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/store.h"
#include "stage/mark_ground.h"
#include "surface/marks.h"

enum { SETS_MAX = 8, DOT_VECTORS = 2, LINE_VECTORS = 5, FLOW_VECTORS = 6 };

struct mark_sets {
    mark_set sets[SETS_MAX];
    uint64_t clock;
};

static void set_release(mark_set *s, gpu *g)
{
    gpu_marks_destroy(g, &s->marks);
    mark_clusters_release(&s->clusters);
    if (s->made)
        surface_marks_release(s->made);
    if (s->ground)
        mark_ground_release(s->ground);
    mem_free(s->made);
    mem_free(s->ground);
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

/* A normal that is longer than 1 by how far it may lean off its face's (surface/marks.glsl). */
static void put_normal(float *out, vec3 normal, float lean)
{
    float length = sqrtf(normal.x * normal.x + normal.y * normal.y + normal.z * normal.z),
          longer = length > 0 ? (1 + lean) / length : 0;
    memcpy(out, (float[]){longer * normal.x, longer * normal.y, longer * normal.z}, 3 * sizeof *out);
}

static gpu_marks *upload_dots(gpu *g, const marks *m, const mark_clusters *c, bool points)
{
    float(*records)[4] = mem_alloc(m->dot_count * DOT_VECTORS * sizeof *records);
    for (size_t i = 0; records && i < m->dot_count; i++) {
        const mark_dot *d = &m->dots[c->order[i]];
        memcpy(records[DOT_VECTORS * i], (float[]){d->position.x, d->position.y, d->position.z, d->priority},
               sizeof *records);
        put_normal(records[DOT_VECTORS * i + 1], d->normal, c->leans[i]);
        records[DOT_VECTORS * i + 1][3] = d->bright;
    }
    gpu_marks *(*create)(gpu *, int, const float *, size_t) = points ? gpu_marks_create_points : gpu_marks_create;
    gpu_marks *out = records ? create(g, DOT_VECTORS, records[0], m->dot_count) : NULL;
    if (!records)
        gpu_fail(g, LMN_MEMORY, "out of memory");
    mem_free(records);
    return out;
}

/* A unit vector's place on the octahedron, −1 … 1. */
static void fold_direction(vec3 d, float out[2])
{
    float sum = fmaxf(fabsf(d.x) + fabsf(d.y) + fabsf(d.z), 1e-20f), x = d.x / sum, y = d.y / sum;
    out[0] = d.z < 0 ? (1 - fabsf(y)) * (x < 0 ? -1.0f : 1.0f) : x;
    out[1] = d.z < 0 ? (1 - fabsf(x)) * (y < 0 ? -1.0f : 1.0f) : y;
}

/* The same as one number that floats have exactly, twelve bits each way. */
static float packed_direction(vec3 d)
{
    const float most = 2047;
    float       at[2];
    fold_direction(d, at);
    return roundf(most * at[0]) + most + 4096 * (roundf(most * at[1]) + most);
}

static void write_line(float (*r)[4], const mark_line *l, float lean)
{
    float length = fmaxf(l->length, 1e-30f);
    memcpy(r[0], (float[]){l->a.x, l->a.y, l->a.z, l->light}, sizeof *r);
    memcpy(r[1], (float[]){l->b.x, l->b.y, l->b.z, l->perspective}, sizeof *r);
    memcpy(r[2], (float[]){l->middle.x, l->middle.y, l->middle.z, l->bright}, sizeof *r);
    put_normal(r[3], l->middle_normal, lean);
    r[3][3] = l->density;
    memcpy(r[4], (float[]){l->from / length, l->to / length, packed_direction(l->middle_direction), l->span},
           sizeof *r);
}

static uint16_t unsigned_fraction(float x)
{
    return (uint16_t)roundf(fminf(fmaxf(x, 0), 1) * 65535);
}

static int16_t signed_fraction(float x)
{
    return (int16_t)roundf(fminf(fmaxf(x, -1), 1) * 32767);
}

/* The same record as that of write_line in 64 bytes: places whole, fractions and directions in 16 bits each. */
typedef struct packed_line {
    float    a[3], b[3], middle[3], light, density;
    uint16_t perspective, from, to, bright;
    int16_t  turns[4];
    uint16_t span, lean;
} packed_line;

static const gpu_mark_layout packed_layout = {.fields = {{MARK_FLOAT, 3},
                                                         {MARK_FLOAT, 3},
                                                         {MARK_FLOAT, 3},
                                                         {MARK_FLOAT, 2},
                                                         {MARK_UNORM16, 4},
                                                         {MARK_SNORM16, 4},
                                                         {MARK_UNORM16, 2}},
                                              .count = 7};

static void pack_line(packed_line *r, const mark_line *l, float lean)
{
    float length = fmaxf(l->length, 1e-30f), folded[4];
    fold_direction(l->middle_normal, folded);
    fold_direction(l->middle_direction, folded + 2);
    *r = (packed_line){.a = {l->a.x, l->a.y, l->a.z},
                       .b = {l->b.x, l->b.y, l->b.z},
                       .middle = {l->middle.x, l->middle.y, l->middle.z},
                       .light = l->light,
                       .density = l->density,
                       .perspective = unsigned_fraction(l->perspective),
                       .from = unsigned_fraction(l->from / length),
                       .to = unsigned_fraction(l->to / length),
                       .bright = unsigned_fraction(l->bright),
                       .span = unsigned_fraction(l->span),
                       .lean = unsigned_fraction(lean / 4)};
    for (int k = 0; k < 4; k++)
        r->turns[k] = signed_fraction(folded[k]);
}

/* How wide strips are, six bits each, as one number that floats have exactly. */
static float packed_spaces(const flow_end *e)
{
    uint32_t out = 0;
    for (int k = FLOW_SPACES; k-- > 0;)
        out = out << 6 | (uint32_t)fminf(fmaxf(roundf(25 * e->spaces[k]), 0), 63);
    return (float)out;
}

/* How dark a group is, in steps that floats have exactly: −31 … 31 as 0 … 62. */
static float packed_group(const mark_line *l)
{
    return roundf(31 * fminf(fmaxf(l->group, -1), 1)) + 31;
}

/* Numbers of both ends, 0 … 1: twelve bits each, as one number that floats have exactly. */
static float packed_two(float a, float b)
{
    const float most = 4095;
    return roundf(most * fminf(fmaxf(a, 0), 1)) + (most + 1) * roundf(most * fminf(fmaxf(b, 0), 1));
}

/* The same of −1 … 1; 0 stays what it is. */
static float packed_signed(float a, float b)
{
    const float half = 2047.0f / 4095;
    return packed_two(half * (1 + a), half * (1 + b));
}

/* A length, of distances of the finest lines: in 256ths of an octave. */
static float packed_distance(double length, double apart)
{
    return (float)(256 * log2(1 + length / apart) / 4095);
}

static void write_flow(float (*r)[4], const mark_line *l, float lean, double apart)
{
    const flow_end *a = &l->ends[0], *b = &l->ends[1];
    memcpy(r[0], (float[]){l->a.x, l->a.y, l->a.z, l->rank}, sizeof *r);
    memcpy(r[1], (float[]){l->b.x, l->b.y, l->b.z, (float)(l->level + 32 * l->set) + 128 * packed_group(l)}, sizeof *r);
    put_normal(r[2], a->normal, lean);
    r[2][3] = packed_spaces(a);
    memcpy(r[3], (float[]){b->normal.x, b->normal.y, b->normal.z, packed_spaces(b)}, sizeof *r);
    memcpy(r[4],
           (float[]){a->to_end, b->to_end, packed_two(sqrtf(fmaxf(a->bright, 0)), sqrtf(fmaxf(b->bright, 0))),
                     packed_two(packed_distance((double)a->room, apart), packed_distance((double)b->room, apart))},
           sizeof *r);
    memcpy(
        r[5],
        (float[]){packed_two(a->drawn, b->drawn), packed_signed(a->shift, b->shift), packed_signed(a->shade, b->shade),
                  packed_two(packed_distance((double)a->to_edge, apart), packed_distance((double)b->to_edge, apart))},
        sizeof *r);
}

static void write_records(char *out, size_t size, const marks *m, const mark_clusters *c, bool packed)
{
    for (size_t i = 0; i < m->line_count; i++) {
        const mark_line *l = &m->lines[c->order[i]];
        void            *record = out + i * size;
        if (packed)
            pack_line(record, l, c->leans[i]);
        else if (m->flow)
            write_flow(record, l, c->leans[i], ldexp(m->apart, 1 - m->levels));
        else
            write_line(record, l, c->leans[i]);
    }
}

/* Of strokes, in the layout that the technique asks for; lines that flow have one. */
static void upload_lines(gpu *g, const marks *m, const technique_use *surface, mark_set *out)
{
    mark_style      style = {.diameter = 1};
    gpu_mark_layout layout = {.count = m->flow ? FLOW_VECTORS : LINE_VECTORS};
    for (int i = 0; i < layout.count; i++)
        layout.fields[i] = (gpu_mark_field){MARK_FLOAT, 4};
    surface_mark_style(&style, surface);
    bool packed = !m->flow && style.layout != LAID_CORNERS;
    if (packed)
        layout = packed_layout;
    layout.once = packed && style.layout == LAID_ONCE;
    layout.form = style.thin ? MARK_SEGMENTS : MARK_QUADS;
    size_t size = gpu_mark_record_size(&layout);
    char  *records = mem_alloc(m->line_count * size);
    out->lines = true;
    out->levels = m->flow ? m->levels : 0;
    out->apart = m->apart;
    out->sag = m->sag;
    if (records) {
        write_records(records, size, m, &out->clusters, packed);
        out->marks = gpu_marks_create_as(g, &layout, records, m->line_count);
    } else {
        gpu_fail(g, LMN_MEMORY, "out of memory");
    }
    mem_free(records);
}

static mark_ground_options ground_options(const mark_set_options *w, const pose *pose)
{
    return (mark_ground_options){pose, w->parts, w->part_count, w->crease_angle, w->surface};
}

/* Puts marks on the GPU. */
static void upload_set(gpu *g, const mark_set_options *w, mark_set *out, const mark_ground *ground, const marks *m)
{
    gpu_marks_destroy(g, &out->marks);
    memcpy(out->origin, ground->origin, sizeof out->origin);
    out->when = w->pose->when;
    out->count = m->dot_count ? m->dot_count : m->line_count;
    if (m->dot_count) {
        out->density = (double)m->dot_count / m->area;
        out->marks = upload_dots(g, m, &out->clusters, w->points);
    } else if (m->line_count) {
        upload_lines(g, m, w->surface, out);
    }
}

/* The set in the pose, from what it is at rest. */
static void move_set(gpu *g, const mark_set_options *w, mark_set *s)
{
    mark_ground         now;
    marks               moved;
    lmn_error           error;
    mark_ground_options options = ground_options(w, w->pose);
    lmn_status          status = mark_ground_move(&now, &moved, s->ground, s->made, &options, &error);
    if (status == LMN_OK) {
        mark_clusters_measure(&s->clusters, &moved, &now.surface);
        upload_set(g, w, s, &now, &moved);
    } else {
        gpu_fail(g, status, "%s", error.message);
    }
    mark_ground_release(&now);
    surface_marks_release(&moved);
}

/* Where nothing moves the CPU needs them no more. */
static void drop_made(mark_set *s)
{
    surface_marks_release(s->made);
    mark_ground_release(s->ground);
    mem_free(s->made);
    mem_free(s->ground);
    s->made = NULL;
    s->ground = NULL;
}

static void make_set(gpu *g, const mark_set_options *w, mark_set *out)
{
    lmn_error           error;
    mark_ground_options options = ground_options(w, w->pose->at_rest ? w->pose->at_rest : w->pose);
    out->made = mem_calloc(1, sizeof *out->made);
    out->ground = mem_calloc(1, sizeof *out->ground);
    if (!out->made || !out->ground) {
        gpu_fail(g, LMN_MEMORY, "out of memory");
        return;
    }
    lmn_status status = mark_ground_posed(out->ground, out->made, &options, &error);
    if (status == LMN_OK && !mark_clusters_make(&out->clusters, out->made, &out->ground->surface))
        status = error_memory(&error);
    mark_style style = {.diameter = 1};
    surface_mark_style(&style, w->surface);
    if (status == LMN_OK && !(style.stands > 0)) /* what stands on the far side may look over it */
        out->clusters.solid = !out->ground->holed && mark_surface_is_solid(&out->ground->surface, out->ground->parts);
    if (status != LMN_OK) {
        gpu_fail(g, status, "%s", error.message);
    } else if (w->pose->at_rest) {
        move_set(g, w, out);
    } else {
        upload_set(g, w, out, out->ground, out->made);
        drop_made(out);
    }
}

/* Is it in the pose, or can it be brought there? */
static bool bring_set(gpu *g, const mark_set_options *w, mark_set *s)
{
    bool there = moment_equal(&s->when, &w->pose->when), movable = s->made && w->pose->at_rest;
    if (!there && movable)
        move_set(g, w, s);
    return there || movable;
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
        if (s->used && s->key == key && bring_set(g, w, s)) {
            s->used = gpu_failed(g) ? 0 : ++all->clock;
            return gpu_failed(g) ? NULL : s;
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
