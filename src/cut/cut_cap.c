/* Cut faces. The outline of the material in a plane is filled once, whatever else is cut, then divided by the other
 * planes; what borders on a cell from outside stays. Bodies that share a plane but not their material are filled
 * one by one, so that each can be hatched in its own way. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut_private.h"

/* Above, bodies are no longer told apart: it takes comparing each with each. */
enum { BODIES_MAX = 1024 };

/* The loops of one connected piece. */
typedef struct body {
    uint32_t shell;
    double   area; /* twice, hollows negative */
    double   low[2], high[2];
    size_t   first, count; /* in `order` */
    int32_t  within;       /* a hollow's body, −1: it is one */
} body;

typedef struct section {
    cut_job      *job;
    int           plane;
    bool          positive;
    double        axes[2][3]; /* with the cap's normal a right-handed system */
    cut_loops     loops;
    size_t       *order;    /* loops, those of a body together */
    uint32_t     *shell_of; /* per loop */
    body         *bodies;
    size_t        body_count;
    bool          turned;   /* all outlines run the wrong way around */
    cut_contour  *contours; /* room for what is filled at once */
    cut_triangles triangles;
} section;

/* --- the outline ---------------------------------------------------------------------------------------- */

static bool lies_in(const cut_job *j, uint32_t vertex, uint32_t bit)
{
    return !((j->vertices[vertex].positive | j->vertices[vertex].negative) & bit);
}

/* Edges in the plane of pieces with material on the side that stays. */
static bool collect(section *s)
{
    cut_job     *j = s->job;
    uint32_t     bit = UINT32_C(1) << s->plane;
    cut_segment *segments = NULL;
    size_t       count = 0, capacity = 0;
    bool         done = true;
    for (size_t i = 0; i < j->surface_pieces && done; i++) {
        const cut_piece *p = &j->pieces[i];
        if (!p->count || !((s->positive ? p->negative : p->positive) & bit))
            continue;
        for (uint32_t k = 0; k < p->count && done; k++) {
            uint32_t a = j->points[p->first + k].vertex, b = j->points[p->first + (k + 1) % p->count].vertex;
            if (!lies_in(j, a, bit) || !lies_in(j, b, bit))
                continue;
            done = mem_grow((void **)&segments, &capacity, count + 1, sizeof *segments);
            if (done) /* the face runs against its neighbours */
                segments[count++] =
                    j->inside_out ? (cut_segment){a, b, p->primitive} : (cut_segment){b, a, p->primitive};
        }
    }
    done = done && outline_chain(&s->loops, j, segments, count);
    mem_free(segments);
    return done;
}

static void set_axes(section *s)
{
    const double *n = s->job->cut->planes[s->plane].normal;
    int    least = fabs(n[0]) <= fabs(n[1]) ? (fabs(n[0]) <= fabs(n[2]) ? 0 : 2) : (fabs(n[1]) <= fabs(n[2]) ? 1 : 2);
    double axis[3] = {0, 0, 0}, u[3], length = 0, sign = s->positive ? 1 : -1;
    axis[least] = 1;
    for (int k = 0; k < 3; k++) {
        u[k] = n[(k + 1) % 3] * axis[(k + 2) % 3] - n[(k + 2) % 3] * axis[(k + 1) % 3];
        length += u[k] * u[k];
    }
    for (int k = 0; k < 3; k++)
        s->axes[0][k] = u[k] / sqrt(length);
    for (int k = 0; k < 3; k++)
        s->axes[1][k] = sign * (n[(k + 1) % 3] * s->axes[0][(k + 2) % 3] - n[(k + 2) % 3] * s->axes[0][(k + 1) % 3]);
}

/* --- bodies --------------------------------------------------------------------------------------------- */

static uint32_t root(uint32_t *parents, uint32_t i)
{
    while (parents[i] != i)
        i = parents[i] = parents[parents[i]];
    return i;
}

/* Loops that run over several shells (a mesh whose triangles are not joined) make them one. */
static bool name_loops(section *s)
{
    const cut_loops *l = &s->loops;
    uint32_t        *parents = mem_alloc((s->job->shell_count + 1) * sizeof *parents);
    s->shell_of = mem_alloc((l->count + 1) * sizeof *s->shell_of);
    s->order = mem_alloc((l->count + 1) * sizeof *s->order);
    s->contours = mem_alloc((2 * l->count + 1) * sizeof *s->contours);
    bool done = parents && s->shell_of && s->order && s->contours;
    for (uint32_t i = 0; i < s->job->shell_count && done; i++)
        parents[i] = i;
    for (size_t i = 0; i < l->directed && done; i++)
        for (size_t k = l->starts[i]; k < l->starts[i + 1]; k++) {
            uint32_t a = root(parents, s->job->vertices[l->points[k]].shell);
            uint32_t b = root(parents, s->job->vertices[l->points[l->starts[i]]].shell);
            parents[a > b ? a : b] = a > b ? b : a;
        }
    for (size_t i = 0; i < l->count && done; i++) {
        s->shell_of[i] = root(parents, s->job->vertices[l->points[l->starts[i]]].shell);
        s->order[i] = i;
    }
    mem_free(parents);
    return done;
}

/* Orders loops by shell without a sort's comparison needing the section: pairs of both. */
typedef struct named_loop {
    uint32_t shell;
    size_t   loop;
} named_loop;

static int compare_loops(const void *a, const void *b)
{
    const named_loop *s = a, *t = b;
    int               shells = (s->shell > t->shell) - (s->shell < t->shell);
    return shells ? shells : (s->loop > t->loop) - (s->loop < t->loop);
}

static double measure_loop(section *s, size_t loop, body *b)
{
    const cut_loops *l = &s->loops;
    double           area = 0, before[2];
    contour_position(s->job, s->axes, l->points[l->starts[loop + 1] - 1], before);
    for (size_t k = l->starts[loop]; k < l->starts[loop + 1]; k++) {
        double at[2];
        contour_position(s->job, s->axes, l->points[k], at);
        area += before[0] * at[1] - before[1] * at[0];
        for (int i = 0; i < 2; i++) {
            b->low[i] = fmin(b->low[i], at[i]);
            b->high[i] = fmax(b->high[i], at[i]);
            before[i] = at[i];
        }
    }
    return area;
}

static bool find_bodies(section *s)
{
    size_t      count = s->loops.directed;
    named_loop *named = mem_alloc((count + 1) * sizeof *named);
    s->bodies = mem_alloc((count + 1) * sizeof *s->bodies);
    if (!named || !s->bodies) {
        mem_free(named);
        return false;
    }
    for (size_t i = 0; i < count; i++)
        named[i] = (named_loop){s->shell_of[i], i};
    qsort(named, count, sizeof *named, compare_loops);
    double total = 0;
    for (size_t i = 0; i < count; i++) {
        if (i == 0 || named[i].shell != named[i - 1].shell)
            s->bodies[s->body_count++] =
                (body){named[i].shell, 0, {INFINITY, INFINITY}, {-INFINITY, -INFINITY}, i, 0, -1};
        body *b = &s->bodies[s->body_count - 1];
        s->order[i] = named[i].loop;
        b->count++;
        double area = measure_loop(s, named[i].loop, b);
        b->area += area;
        total += area;
    }
    s->turned = total < 0;
    for (size_t i = 0; i < s->body_count && s->turned; i++)
        s->bodies[i].area = -s->bodies[i].area;
    mem_free(named);
    return true;
}

/* How often the body's outline goes around the position. */
static int winding(section *s, const body *b, const double at[2])
{
    const cut_loops *l = &s->loops;
    int              around = 0;
    for (size_t i = b->first; i < b->first + b->count; i++) {
        size_t loop = s->order[i];
        double p[2], q[2];
        contour_position(s->job, s->axes, l->points[l->starts[loop + 1] - 1], p);
        for (size_t k = l->starts[loop]; k < l->starts[loop + 1]; k++) {
            contour_position(s->job, s->axes, l->points[k], q);
            double side = (q[0] - p[0]) * (at[1] - p[1]) - (q[1] - p[1]) * (at[0] - p[0]);
            if (p[1] <= at[1] && q[1] > at[1] && side > 0)
                around++;
            else if (p[1] > at[1] && q[1] <= at[1] && side < 0)
                around--;
            memcpy(p, q, sizeof p);
        }
    }
    return around;
}

static bool boxes_meet(const body *a, const body *b)
{
    return a->low[0] <= b->high[0] && b->low[0] <= a->high[0] && a->low[1] <= b->high[1] && b->low[1] <= a->high[1];
}

/* Gives hollows to the smallest body around them. */
static void place_hollows(section *s)
{
    for (size_t i = 0; i < s->body_count; i++) {
        body *hollow = &s->bodies[i];
        if (hollow->area >= 0)
            continue;
        double at[2];
        contour_position(s->job, s->axes, s->loops.points[s->loops.starts[s->order[hollow->first]]], at);
        for (size_t k = 0; k < s->body_count; k++) {
            const body *b = &s->bodies[k];
            bool        better = b->area > 0 && (hollow->within < 0 || b->area < s->bodies[hollow->within].area);
            if (better && boxes_meet(hollow, b) && winding(s, b, at) != 0)
                hollow->within = (int32_t)k;
        }
    }
}

/* --- filling -------------------------------------------------------------------------------------------- */

/* Adds its outline, running so that it counts as material or as its absence. */
static size_t add_body(section *s, size_t count, const body *b, bool material)
{
    const cut_loops *l = &s->loops;
    bool             reversed = ((b->area >= 0) != material) != s->turned;
    for (size_t i = b->first; i < b->first + b->count; i++) {
        size_t loop = s->order[i];
        s->contours[count++] =
            (cut_contour){l->points + l->starts[loop], l->starts[loop + 1] - l->starts[loop], reversed};
    }
    return count;
}

/* The body with its hollows, without smaller bodies that share its position: a shaft runs through its gear. */
static bool fill_body(section *s, size_t index)
{
    const body *b = &s->bodies[index];
    size_t      count = add_body(s, 0, b, true), own;
    for (size_t i = 0; i < s->body_count; i++)
        if (s->bodies[i].within == (int32_t)index)
            count = add_body(s, count, &s->bodies[i], false);
    own = count;
    for (size_t i = 0; i < s->body_count; i++) {
        const body *other = &s->bodies[i];
        double      smaller = fabs(other->area) - fabs(b->area);
        if (i != index && other->within < 0 && boxes_meet(b, other) && (smaller < 0 || (smaller == 0 && i < index)))
            count = add_body(s, count, other, false);
    }
    return contours_fill(&s->triangles, s->job, s->plane, s->axes, s->contours, count,
                         count > own ? CUT_RULE_POSITIVE : CUT_RULE_NONZERO);
}

/* Loops from `first` on at once. */
static bool fill_loops(section *s, size_t first, size_t end, cut_rule rule)
{
    const cut_loops *l = &s->loops;
    for (size_t i = first; i < end; i++)
        s->contours[i - first] = (cut_contour){l->points + l->starts[i], l->starts[i + 1] - l->starts[i], false};
    return contours_fill(&s->triangles, s->job, s->plane, s->axes, s->contours, end - first, rule);
}

/* --- the faces ------------------------------------------------------------------------------------------ */

static vec3 normal_before(const section *s)
{
    const double *n = s->job->cut->planes[s->plane].normal, *m = s->job->world->m;
    double        out[3], length = 0;
    for (int k = 0; k < 3; k++) {
        out[k] = (m[4 * k] * n[0] + m[4 * k + 1] * n[1] + m[4 * k + 2] * n[2]) * (s->positive ? 1 : -1);
        length += out[k] * out[k];
    }
    length = length > 0 ? sqrt(length) : 1;
    return (vec3){(float)(out[0] / length), (float)(out[1] / length), (float)(out[2] / length)};
}

/* What was filled last becomes a cut face, as far as it borders on what was cut away. */
static void make_cap(section *s, uint32_t number, size_t loop)
{
    cut_job    *j = s->job;
    cut_result *r = j->out;
    size_t      first = j->piece_count;
    for (size_t i = 0; i < s->triangles.count && !j->failed; i += 3) {
        const uint32_t *c = &s->triangles.corners[i];
        job_add_piece(j, (cut_point[]){{c[0], {0}}, {c[1], {0}}, {c[2], {0}}}, 3, 0, 0);
    }
    for (int k = 0; k < j->cut->plane_count && j->cut->plane_count > 1; k++)
        if (k != s->plane)
            job_slice(j, first, k);
    uint32_t bit = UINT32_C(1) << s->plane, here = s->positive ? bit : 0, there = s->positive ? 0 : bit;
    for (size_t i = first; i < j->piece_count && !j->failed; i++) {
        cut_piece *p = &j->pieces[i];
        p->kept = p->count && cut_is_inside(j->cut, p->positive | here, p->negative | there) &&
                  !cut_is_inside(j->cut, p->positive | there, p->negative | here);
        p->cap = (int32_t)r->cap_count;
    }
    if (!mem_grow((void **)&r->caps, &r->cap_capacity, r->cap_count + 1, sizeof *r->caps)) {
        j->failed = true;
        return;
    }
    r->caps[r->cap_count++] = (cut_cap){.plane = s->plane,
                                        .positive = s->positive,
                                        .body = number,
                                        .primitive = s->loops.primitives[loop],
                                        .normal = normal_before(s)};
}

static void fill_all(section *s)
{
    cut_job         *j = s->job;
    const cut_loops *l = &s->loops;
    bool             together = s->body_count > BODIES_MAX;
    if (together) {
        if (fill_loops(s, 0, l->directed, CUT_RULE_NONZERO))
            make_cap(s, 0, 0);
        else
            j->out->open = true;
    }
    for (size_t i = 0; i < s->body_count && !together && !j->failed; i++) {
        if (s->bodies[i].within >= 0)
            continue;
        if (fill_body(s, i))
            make_cap(s, s->bodies[i].shell, s->order[s->bodies[i].first]);
        else
            j->out->open = true;
    }
    if (l->count > l->directed && !j->failed) {
        if (fill_loops(s, l->directed, l->count, CUT_RULE_ODD))
            make_cap(s, s->shell_of[l->directed], l->directed);
        else
            j->out->open = true;
    }
}

void job_cap(cut_job *j, int plane, bool positive)
{
    section s = {.job = j, .plane = plane, .positive = positive};
    set_axes(&s);
    bool done = collect(&s) && name_loops(&s) && find_bodies(&s);
    j->failed = j->failed || !done;
    if (done) {
        j->out->open = j->out->open || s.loops.open;
        if (s.body_count <= BODIES_MAX)
            place_hollows(&s);
        fill_all(&s);
    }
    outline_release(&s.loops);
    mem_free(s.order);
    mem_free(s.shell_of);
    mem_free(s.bodies);
    mem_free(s.contours);
    mem_free(s.triangles.corners);
}
