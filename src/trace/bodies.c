/* What moves as one. Of rigid parts that is the uppermost node that moves with all below it; a skin moves limb by limb,
 * and limbs that move alike are one. How a body moves on the page is the least-squares fit of a shift, a turn and a
 * growth to the displacements of its faces, weighted by their areas. */
#include "trace/trace_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut.h"

/* Limbs whose motions differ by less than this fraction of the faster one's are one body; those that are smaller than
 * the second fraction of all belong to the next one. */
#define ALIKE 0.4
#define SMALL 0.02
/* What moves less far during the exposure, units, is at rest. */
#define LEAST_WAY 1.0
/* Slower than the first of these fractions of what is fastest, bodies have no lines. */
#define LEAST_SPEED 0.3
static const double pi = 3.14159265358979323846;

/* Sums over faces of what moves by one key. */
typedef struct fit {
    double area, x, y, vx, vy;             /* weighted by area */
    double square, turn, growth, farthest; /* around the middle */
    double energy;                         /* squares of displacements, weighted by area */
} fit;

typedef struct finder {
    trace_bodies        *out;
    const pose          *now, *before;
    const stroke_camera *camera;
    double               fraction;
    double (*was)[3];            /* per vertex, before */
    int32_t             *keys;   /* per triangle: a node */
    int32_t             *owners; /* per node: the key whose body it is in */
    fit                 *fits;   /* per node */
    const bodies_wanted *wanted;
    size_t               mesh_capacity, vertex_capacity, was_capacity, triangle_capacity, key_capacity, body_capacity;
} finder;

/* --- positions -------------------------------------------------------------------------------------------- */

vec3 *trace_positions(const pose *p, const trace_mesh *m)
{
    const part_pose *own = &p->parts[m->part];
    vec3            *out = mem_alloc(((size_t)m->primitive->vertex_count + 1) * sizeof *out);
    if (!out)
        return NULL;
    mat4 world = pose_instance(p, m->part, m->instance);
    if (pose_deforms(own, m->primitive))
        pose_vertices(own, m->primitive, NULL, NULL, m->primitive->vertex_count, out, NULL);
    else
        memcpy(out, m->primitive->positions, m->primitive->vertex_count * sizeof *out);
    for (uint32_t i = 0; i < m->primitive->vertex_count; i++)
        out[i] = mat4_transform_point(&world, out[i]);
    return out;
}

static bool put_positions(const finder *f, const pose *p, const trace_mesh *m, double (*to)[3])
{
    vec3 *world = trace_positions(p, m);
    for (uint32_t i = 0; world && i < m->primitive->vertex_count; i++)
        if (!page_project(f->camera, world[i], to[m->first + i]))
            to[m->first + i][0] = to[m->first + i][1] = to[m->first + i][2] = NAN;
    mem_free(world);
    return world != NULL;
}

/* --- keys --------------------------------------------------------------------------------------------------- */

/* The uppermost node above one that is elsewhere than it was; NONE: none is. */
static int32_t moved_node(const finder *f, int32_t node_index)
{
    const lmn_scene *s = f->now->scene;
    int32_t          found = NONE;
    for (int32_t i = node_index; i != NONE; i = s->nodes[i].parent)
        if (memcmp(&f->now->worlds[i], &f->before->worlds[i], sizeof *f->now->worlds) != 0)
            found = i;
    return found;
}

int32_t trace_joint_of(const lmn_scene *s, const node *n, const primitive *p, uint32_t vertex)
{
    const skin *k = &s->skins[n->skin];
    uint32_t    best = 0;
    for (uint32_t i = 1; i < p->influences; i++)
        if (p->weights[vertex * p->influences + i] > p->weights[vertex * p->influences + best])
            best = i;
    uint16_t joint = p->joints[vertex * p->influences + best];
    return joint < k->joint_count ? k->joints[joint] : k->joints[0];
}

/* Morphed vertices belong to their node, which need not move. */
static int32_t key_of(const finder *f, const trace_mesh *m, uint32_t vertex, int32_t rigid)
{
    const lmn_scene *s = f->now->scene;
    int32_t          own = s->parts[m->part].node;
    const node      *n = &s->nodes[own];
    if (n->skin != NONE && m->primitive->influences > 0 && s->skins[n->skin].joint_count > 0)
        return trace_joint_of(s, n, m->primitive, vertex);
    return rigid != NONE ? rigid : own;
}

/* Does a section take all of a triangle away? */
static bool is_taken(const finder *f, const trace_mesh *m, const uint32_t *corners)
{
    const stroke_section *s = &f->wanted->section;
    box3                  box = box3_empty();
    if (!s->cut || s->cut->cell_count == 0 || (s->spared && s->spared[m->part]))
        return false;
    for (int k = 0; k < 3; k++) {
        double at[3];
        page_unproject(f->camera, f->out->now[m->first + corners[k]], at);
        const vec3 point = {(float)at[0], (float)at[1], (float)at[2]};
        box = box3_union(box, (box3){point, point});
    }
    return cut_judge_box(s->cut, box) == CUT_GONE;
}

static bool add_triangles(finder *f, const trace_mesh *m)
{
    trace_bodies    *b = f->out;
    const primitive *p = m->primitive;
    int32_t          rigid = moved_node(f, f->now->scene->parts[m->part].node);
    size_t           count = p->index_count / 3;
    if (!mem_grow((void **)&b->triangles, &f->triangle_capacity, b->triangle_count + count + 1, sizeof *b->triangles) ||
        !mem_grow((void **)&f->keys, &f->key_capacity, b->triangle_count + count + 1, sizeof *f->keys))
        return false;
    for (size_t i = 0; i < count; i++) {
        const uint32_t *corners = &p->indices[3 * i];
        bool            seen = true;
        for (int k = 0; k < 3; k++)
            seen = seen && corners[k] < p->vertex_count && isfinite(b->now[m->first + corners[k]][0]) &&
                   isfinite(f->was[m->first + corners[k]][0]);
        if (!seen || is_taken(f, m, corners))
            continue;
        for (int k = 0; k < 3; k++)
            b->triangles[b->triangle_count][k] = m->first + corners[k];
        f->keys[b->triangle_count++] = key_of(f, m, corners[0], rigid);
    }
    return true;
}

static bool add_primitive(finder *f, uint32_t part, uint32_t instance, const primitive *p)
{
    trace_bodies *b = f->out;
    if (!mem_grow((void **)&b->meshes, &f->mesh_capacity, b->mesh_count + 1, sizeof *b->meshes))
        return false;
    size_t vertices = b->vertex_count + p->vertex_count;
    if (!mem_grow((void **)&b->now, &f->vertex_capacity, vertices + 1, sizeof *b->now) ||
        !mem_grow((void **)&f->was, &f->was_capacity, vertices + 1, sizeof *f->was))
        return false;
    b->meshes[b->mesh_count] = (trace_mesh){part, instance, (uint32_t)b->vertex_count, p};
    const trace_mesh *m = &b->meshes[b->mesh_count++];
    b->vertex_count = vertices;
    return put_positions(f, f->now, m, b->now) && put_positions(f, f->before, m, f->was) && add_triangles(f, m);
}

static bool part_moves(const finder *f, size_t part)
{
    const part_pose *a = &f->now->parts[part], *b = &f->before->parts[part];
    int32_t          own = f->now->scene->parts[part].node;
    if (memcmp(&f->now->worlds[own], &f->before->worlds[own], sizeof(mat4)) != 0)
        return true;
    if (a->joint_count && memcmp(a->joints, b->joints, a->joint_count * sizeof *a->joints) != 0)
        return true;
    return a->weight_count && memcmp(a->weights, b->weights, a->weight_count * sizeof *a->weights) != 0;
}

static bool add_parts(finder *f, const bool *parts)
{
    const lmn_scene *s = f->now->scene;
    for (size_t part = 0; part < f->now->part_count; part++) {
        const node *n = &s->nodes[s->parts[part].node];
        if (!parts[part] || n->mesh == NONE || !part_moves(f, part))
            continue;
        for (uint32_t i = 0; i < node_draw_count(n); i++)
            for (size_t k = 0; k < s->meshes[n->mesh].primitive_count; k++)
                if (!add_primitive(f, (uint32_t)part, i, &s->meshes[n->mesh].primitives[k]))
                    return false;
    }
    return true;
}

/* --- fits ----------------------------------------------------------------------------------------------------- */

static void middle_of(const finder *f, size_t triangle, double at[2], double moved[2], double *area)
{
    const uint32_t *t = f->out->triangles[triangle];
    const double   *a = f->out->now[t[0]], *b = f->out->now[t[1]], *c = f->out->now[t[2]];
    *area = 0.5 * fabs((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])) + 1e-9;
    for (int k = 0; k < 2; k++) {
        at[k] = (a[k] + b[k] + c[k]) / 3;
        moved[k] = at[k] - (f->was[t[0]][k] + f->was[t[1]][k] + f->was[t[2]][k]) / 3;
    }
}

/* Means of all faces of each key, or of each key's owner. */
static void sum_means(finder *f)
{
    for (size_t i = 0; i < f->out->triangle_count; i++) {
        double at[2], moved[2], area;
        fit   *s = &f->fits[f->owners[f->keys[i]]];
        middle_of(f, i, at, moved, &area);
        s->area += area;
        s->x += area * at[0];
        s->y += area * at[1];
        s->vx += area * moved[0];
        s->vy += area * moved[1];
    }
    for (size_t k = 0; k < f->now->scene->node_count; k++)
        if (f->fits[k].area > 0) {
            f->fits[k].x /= f->fits[k].area;
            f->fits[k].y /= f->fits[k].area;
            f->fits[k].vx /= f->fits[k].area;
            f->fits[k].vy /= f->fits[k].area;
        }
}

static void sum_turns(finder *f)
{
    for (size_t i = 0; i < f->out->triangle_count; i++) {
        double at[2], moved[2], area;
        fit   *s = &f->fits[f->owners[f->keys[i]]];
        middle_of(f, i, at, moved, &area);
        double x = at[0] - s->x, y = at[1] - s->y, vx = moved[0] - s->vx, vy = moved[1] - s->vy;
        s->square += area * (x * x + y * y);
        s->turn += area * (x * vy - y * vx);
        s->growth += area * (x * vx + y * vy);
        s->energy += area * (moved[0] * moved[0] + moved[1] * moved[1]);
        s->farthest = fmax(s->farthest, hypot(moved[0], moved[1]));
    }
}

static int32_t find_owner(int32_t *owners, int32_t key)
{
    while (owners[key] != key)
        key = owners[key] = owners[owners[key]];
    return key;
}

/* The nearest node above that is a key, too; NONE: there is none. */
static int32_t key_above(const finder *f, int32_t key)
{
    int32_t i = f->now->scene->nodes[key].parent;
    while (i != NONE && !(f->fits[i].area > 0))
        i = f->now->scene->nodes[i].parent;
    return i;
}

static void merge_limbs(finder *f)
{
    size_t count = f->now->scene->node_count;
    double whole = 0;
    for (size_t k = 0; k < count; k++)
        whole += f->fits[k].area;
    for (size_t k = 0; k < count; k++) {
        const fit *own = &f->fits[k];
        int32_t    above = own->area > 0 ? key_above(f, (int32_t)k) : NONE;
        if (above == NONE)
            continue;
        const fit *other = &f->fits[above];
        double     apart = hypot(own->vx - other->vx, own->vy - other->vy),
               faster = fmax(hypot(own->vx, own->vy), hypot(other->vx, other->vy));
        if (apart < ALIKE * faster || own->area < SMALL * whole)
            f->owners[find_owner(f->owners, (int32_t)k)] = find_owner(f->owners, above);
    }
    for (size_t k = 0; k < count; k++)
        f->owners[k] = find_owner(f->owners, (int32_t)k);
}

/* --- bodies ----------------------------------------------------------------------------------------------------- */

static double angle_within(double angle)
{
    return angle - 2 * pi * floor((angle + pi) / (2 * pi));
}

void body_coordinates(const trace_body *b, const double page[3], double *along, double *across)
{
    double x = page[0] - b->centre[0], y = page[1] - b->centre[1];
    if (b->motion == MOVES_ALONG) {
        *along = x * b->way[0] + y * b->way[1];
        *across = x * -b->way[1] + y * b->way[0];
    } else if (b->motion == MOVES_AROUND) {
        *along = b->sense * angle_within(atan2(y, x) - b->zero);
        *across = hypot(x, y);
    } else { /* what comes nearer grows: its rear is its rim, where rays begin */
        *along = -hypot(x, y);
        *across = atan2(y, x);
    }
}

void body_way(const trace_body *b, double x, double y, double out[2])
{
    double rx = x - b->centre[0], ry = y - b->centre[1], r = hypot(rx, ry);
    out[0] = b->way[0];
    out[1] = b->way[1];
    if (b->motion == MOVES_ALONG)
        return;
    double towards = b->motion == MOVES_TOWARDS ? 1 : 0, around = 1 - towards;
    out[0] = r > 0 ? b->sense * (towards * rx - around * ry) / r : 0;
    out[1] = r > 0 ? b->sense * (towards * ry + around * rx) / r : 0;
}

static void settle_motion(trace_body *b, const fit *s, double fraction)
{
    double radius = sqrt(s->square / s->area), turn = s->turn / fmax(s->square, 1e-12),
           growth = s->growth / fmax(s->square, 1e-12), shift = hypot(s->vx, s->vy);
    b->centre[0] = s->x;
    b->centre[1] = s->y;
    b->sense = 1;
    b->speed = sqrt(s->energy / s->area) / fraction;
    b->motion = MOVES_ALONG;
    if (fabs(turn) * radius > fmax(shift, fabs(growth) * radius)) {
        /* v + turn · J (c − middle) = 0, J (x, y) = (−y, x). */
        b->motion = MOVES_AROUND;
        b->sense = turn < 0 ? -1 : 1;
        b->centre[0] = s->x - s->vy / turn;
        b->centre[1] = s->y + s->vx / turn;
        b->zero = atan2(s->y - b->centre[1], s->x - b->centre[0]);
    } else if (fabs(growth) * radius > shift) {
        b->motion = MOVES_TOWARDS;
        b->sense = growth < 0 ? -1 : 1;
    }
    if (shift > 0) {
        b->way[0] = s->vx / shift;
        b->way[1] = s->vy / shift;
    }
}

static void measure_across(const trace_bodies *t, trace_body *b)
{
    b->across[0] = INFINITY;
    b->across[1] = -INFINITY;
    for (uint32_t i = b->first; i < b->first + b->count; i++)
        for (int k = 0; k < 3; k++) {
            double along, across;
            body_coordinates(b, t->now[t->triangles[i][k]], &along, &across);
            b->across[0] = fmin(b->across[0], across);
            b->across[1] = fmax(b->across[1], across);
        }
}

/* Sorts triangles by their bodies, those without last. False: out of memory. */
static bool sort_triangles(finder *f, const int32_t *numbers, size_t body_count)
{
    trace_bodies *t = f->out;
    uint32_t     *starts = mem_calloc(body_count + 2, sizeof *starts);
    uint32_t(*sorted)[3] = mem_alloc((t->triangle_count + 1) * sizeof *sorted);
    if (starts && sorted) {
        for (size_t i = 0; i < t->triangle_count; i++) {
            int32_t n = numbers[f->owners[f->keys[i]]];
            starts[(n < 0 ? body_count : (size_t)n) + 1]++;
        }
        for (size_t k = 0; k < body_count; k++) {
            t->bodies[k].first = starts[k];
            t->bodies[k].count = starts[k + 1];
            starts[k + 1] += starts[k];
        }
        for (size_t i = 0; i < t->triangle_count; i++) {
            int32_t n = numbers[f->owners[f->keys[i]]];
            memcpy(sorted[starts[n < 0 ? body_count : (size_t)n]++], t->triangles[i], sizeof *sorted);
        }
        if (t->triangle_count)
            memcpy(t->triangles, sorted, t->triangle_count * sizeof *sorted);
    }
    bool good = starts && sorted;
    mem_free(starts);
    mem_free(sorted);
    return good;
}

/* What moves at all, and not by a jump. */
static bool is_body(const finder *f, size_t key)
{
    return f->fits[key].area > 0 && f->fits[key].farthest / f->fraction >= LEAST_WAY &&
           !(f->wanted->jumping && f->wanted->jumping[key]);
}

static double fastest_of(const finder *f)
{
    double fastest = 0;
    for (size_t k = 0; k < f->now->scene->node_count; k++)
        if (is_body(f, k))
            fastest = fmax(fastest, sqrt(f->fits[k].energy / f->fits[k].area));
    return fastest;
}

static bool make_bodies(finder *f)
{
    trace_bodies *t = f->out;
    size_t        count = f->now->scene->node_count;
    double        fastest = fastest_of(f);
    int32_t      *numbers = mem_alloc((count + 1) * sizeof *numbers);
    bool          good = numbers != NULL;
    for (size_t k = 0; good && k < count; k++) {
        trace_body b = {.first = 0};
        numbers[k] = -1;
        if (!is_body(f, k))
            continue;
        settle_motion(&b, &f->fits[k], f->fraction);
        b.node = memcmp(&f->now->worlds[k], &f->before->worlds[k], sizeof *f->now->worlds) != 0 ? (int32_t)k : NONE;
        if (b.speed * f->fraction < LEAST_SPEED * fastest)
            continue;
        good = mem_grow((void **)&t->bodies, &f->body_capacity, t->body_count + 1, sizeof *t->bodies);
        if (good) {
            numbers[k] = (int32_t)t->body_count;
            t->bodies[t->body_count++] = b;
        }
    }
    good = good && sort_triangles(f, numbers, t->body_count);
    for (size_t k = 0; good && k < t->body_count; k++) {
        trace_body *b = &t->bodies[k];
        b->round = b->node != NONE && body_turns(b, t, f->now, f->before, f->fraction, f->camera);
        measure_across(t, b);
    }
    mem_free(numbers);
    return good;
}

lmn_status bodies_find(trace_bodies *out, const pose *now, const pose *before, double fraction,
                       const bodies_wanted *wanted, lmn_error *error)
{
    finder f = {
        .out = out, .now = now, .before = before, .camera = wanted->camera, .fraction = fraction, .wanted = wanted};
    size_t count = now->scene->node_count;
    memset(out, 0, sizeof *out);
    f.owners = mem_alloc((count + 1) * sizeof *f.owners);
    f.fits = mem_calloc(count + 1, sizeof *f.fits);
    bool good = f.owners && f.fits && add_parts(&f, wanted->parts);
    for (size_t k = 0; good && k < count; k++)
        f.owners[k] = (int32_t)k;
    if (good) {
        sum_means(&f);
        merge_limbs(&f);
        memset(f.fits, 0, (count + 1) * sizeof *f.fits);
        sum_means(&f);
        sum_turns(&f);
        good = make_bodies(&f);
    }
    mem_free(f.was);
    mem_free(f.keys);
    mem_free(f.owners);
    mem_free(f.fits);
    if (!good)
        bodies_release(out);
    return good ? LMN_OK : error_memory(error);
}

void bodies_release(trace_bodies *b)
{
    mem_free(b->meshes);
    mem_free(b->now);
    mem_free(b->triangles);
    mem_free(b->bodies);
    memset(b, 0, sizeof *b);
}

uint32_t trace_mesh_of(const trace_bodies *t, uint32_t vertex)
{
    uint32_t low = 0, high = (uint32_t)t->mesh_count - 1;
    while (low < high) {
        uint32_t middle = (low + high + 1) / 2;
        if (t->meshes[middle].first <= vertex)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}
