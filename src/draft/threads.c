/* A flank of a thread is carried into itself by one screw motion, so that all its normals lie in one linear complex:
 * n · (c̄ + c × x) = 0 for the motion's c and c̄ (H. Pottmann, T. Randrup: Rotational and Helical Surface Approximation
 * for Reverse Engineering, Computing 60, 1998). For each stretch of faces without creases the motion is the least
 * eigenvector; those of one motion are one thread. Springs have such surfaces, too, but look both ways; a thread's look
 * away from the axis, or all towards it. */
#include "draft/threads.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/vector3.h"
#include "draft/cylinder_fit.h"
#include "draft/eigenvectors.h"
#include "draft/faces.h"

enum { UNKNOWNS = 6, JACOBI_ROUNDS = 24, FACES_LEAST = 24, FITS = 5 };
static const double pi = 3.14159265358979323846;
static const double off_most = 0.05;       /* radians, in the mean: what normals may lean out of the complex */
static const double off_typical = 0.04;    /* faces that lean more count for less than half */
static const double of_it_least = 0.2;     /* of weights: others are of something else, as of a face that cuts it off */
static const double share_least = 0.6;     /* of the area is of it */
static const double better_least = 1.5;    /* so many times nearer than any rotation around the axis */
static const double turns_least = 1.4;     /* of a thread; less is a groove */
static const double lead_most = 0.36;      /* tangent of 20°: steeper ones are worms, drills and gears */
static const double root_least = 0.6;      /* of the outer radius: deeper ones are augers */
static const double depth_least = 0.004;   /* of the outer radius */
static const double depth_most = 0.95;     /* of the lead */
static const double outwards_least = 0.97; /* of the area looks to one side */
static const double round_least = 0.995;   /* cosine to the radius */
static const double same_axis = 0.02;      /* radians */
static const double same_centre =
    0.1;                             /* of the radius: flanks that are nearly across the axis hardly say where it is */
static const double same_lead = 0.1; /* facets of flanks that look up and down lean to either side */

typedef struct winding {
    double axis[3], centre[3], pitch; /* along the axis for a radian */
    double low, high, inner, outer;   /* along the axis from the centre; from it */
    double least, most;               /* from the axis, where chamfers cut it, too */
    double area;
    bool   hollow;
    size_t component, thread; /* thread: 1 + the first winding of it; 0: of none yet */
} winding;

typedef struct finder {
    const edge_mesh *mesh;
    draft_faces      faces;
    uint32_t        *component; /* per face */
    double          *weights;   /* per face: how sure it is of its stretch's motion */
    size_t          *starts;    /* per component: in `order` */
    uint32_t        *order;     /* faces by component */
    size_t           count;
    winding         *windings;
    size_t           winding_count, winding_capacity;
} finder;

static void corner_of(const finder *f, uint32_t face, int k, double out[3])
{
    vec3 p = f->mesh->positions[f->mesh->faces[face][k]];
    vector3_set(out, (double)p.x, (double)p.y, (double)p.z);
}

static double measure_face(const finder *f, uint32_t face, double middle[3])
{
    double p[3][3], a[3], b[3], n[3];
    vector3_set(middle, 0, 0, 0);
    for (int k = 0; k < 3; k++) {
        corner_of(f, face, k, p[k]);
        vector3_add(middle, middle, 1.0 / 3, p[k]);
    }
    vector3_add(a, p[1], -1, p[0]);
    vector3_add(b, p[2], -1, p[0]);
    vector3_cross(n, a, b);
    return vector3_length(n) / 2;
}

/* --- stretches without creases -------------------------------------------------------------------------- */

static bool find_components(finder *f)
{
    const uint32_t count = f->mesh->face_count;
    f->component = mem_alloc(((size_t)count + 1) * sizeof *f->component);
    f->weights = mem_alloc(((size_t)count + 1) * sizeof *f->weights);
    f->order = mem_alloc(((size_t)count + 1) * sizeof *f->order);
    f->starts = mem_alloc(((size_t)count + 2) * sizeof *f->starts);
    if (!f->component || !f->order || !f->starts || !f->weights)
        return false;
    for (uint32_t i = 0; i < count; i++)
        f->component[i] = UINT32_MAX;
    size_t end = 0;
    for (uint32_t seed = 0; seed < count; seed++) {
        if (f->component[seed] != UINT32_MAX)
            continue;
        f->starts[f->count] = end;
        f->component[seed] = (uint32_t)f->count;
        f->order[end++] = seed;
        for (size_t i = f->starts[f->count]; i < end; i++)
            for (int k = 0; k < 3; k++) {
                uint32_t other = draft_faces_beside(&f->faces, f->order[i], k);
                if (other == EDGE_NO_FACE || f->component[other] != UINT32_MAX)
                    continue;
                f->component[other] = (uint32_t)f->count;
                f->order[end++] = other;
            }
        f->count++;
    }
    f->starts[f->count] = end;
    return true;
}

/* --- the motion ----------------------------------------------------------------------------------------- */

static void place_around(const winding *w, const double p[3], double *along, double radius[3], double *away)
{
    double d[3];
    vector3_add(d, p, -1, w->centre);
    *along = vector3_dot(d, w->axis);
    vector3_add(radius, d, -*along, w->axis);
    *away = vector3_length(radius);
    for (int k = 0; k < 3 && *away > 0; k++)
        radius[k] /= *away;
}

/* The screw motion of faces; false: they have none that tells. */
static bool fit_motion(const finder *f, size_t component, winding *w)
{
    double middle[3] = {0}, size = 0, area = 0, m[UNKNOWNS][UNKNOWNS] = {{0}}, axes[UNKNOWNS][UNKNOWNS];
    for (int round = 0; round < 3; round++)
        for (size_t i = f->starts[component]; i < f->starts[component + 1]; i++) {
            double        p[3], d[3], row[UNKNOWNS], own = measure_face(f, f->order[i], p) * f->weights[f->order[i]];
            const double *n = f->faces.normals[f->order[i]];
            vector3_add(d, p, -1, middle);
            if (round == 0) {
                vector3_add(middle, middle, own, p);
                area += own;
            } else if (round == 1) {
                size += own * vector3_dot(d, d);
            } else {
                for (int k = 0; k < 3; k++)
                    d[k] /= size;
                vector3_copy(row, n);
                vector3_cross(row + 3, d, n);
                for (int a = 0; a < UNKNOWNS; a++)
                    for (int b = 0; b < UNKNOWNS; b++)
                        m[a][b] += own * row[a] * row[b];
            }
            if (round < 2 && i + 1 == f->starts[component + 1]) {
                if (!(area > 0))
                    return false;
                for (int k = 0; k < 3 && round == 0; k++)
                    middle[k] /= area;
                size = round ? sqrt(size / area) : 0;
                if (round && !(size > 0))
                    return false;
            }
        }
    eigenvectors_find(&axes[0][0], &m[0][0], UNKNOWNS, JACOBI_ROUNDS);
    int least = 0;
    for (int k = 1; k < UNKNOWNS; k++)
        least = m[k][k] < m[least][least] ? k : least;
    double moved[3], turned[3], across[3];
    for (int k = 0; k < 3; k++) {
        moved[k] = axes[k][least];
        turned[k] = axes[3 + k][least];
    }
    double square = vector3_dot(turned, turned);
    if (!(square > 1e-6))
        return false;
    vector3_cross(across, turned, moved);
    vector3_add(w->centre, middle, size / square, across);
    w->pitch = size * vector3_dot(turned, moved) / square;
    vector3_copy(w->axis, turned);
    w->area = area;
    w->component = component;
    return vector3_normalise(w->axis);
}

/* By how much a face's normal leans out of a motion's complex, radians. */
static double leaning_of(const winding *w, const double n[3], const double radius[3], double away)
{
    double way[3], speed = hypot(away, w->pitch);
    vector3_cross(way, w->axis, radius);
    return speed > 0 ? (away * vector3_dot(n, way) + w->pitch * vector3_dot(n, w->axis)) / speed : 1;
}

/* The motion of most of them, as others cut in: faces that lean count for less each time. */
static bool settle_motion(finder *f, size_t component, winding *w)
{
    for (size_t i = f->starts[component]; i < f->starts[component + 1]; i++)
        f->weights[f->order[i]] = 1;
    for (int round = 0; round < FITS; round++) {
        if (!fit_motion(f, component, w))
            return false;
        for (size_t i = f->starts[component]; i < f->starts[component + 1]; i++) {
            double p[3], radius[3], along, away;
            measure_face(f, f->order[i], p);
            place_around(w, p, &along, radius, &away);
            double off = leaning_of(w, f->faces.normals[f->order[i]], radius, away) / off_typical;
            f->weights[f->order[i]] = 1 / (1 + off * off);
        }
    }
    return true;
}

/* What is round around the axis is carried into itself by any motion along it, and says nothing. */
static bool tells_motion(const finder *f, const winding *w, uint32_t face)
{
    double p[3], radius[3], along, away;
    measure_face(f, face, p);
    place_around(w, p, &along, radius, &away);
    return f->weights[face] >= of_it_least && fabs(vector3_dot(f->faces.normals[face], radius)) < round_least;
}

/* Is it a flank, as seen from its axis? */
static bool measure_winding(const finder *f, winding *w)
{
    double leant = 0, turned = 0, outwards = 0, inwards = 0, area = 0, whole = 0;
    w->low = w->inner = INFINITY;
    w->high = -INFINITY;
    w->outer = 0;
    for (size_t i = f->starts[w->component]; i < f->starts[w->component + 1]; i++) {
        uint32_t      face = f->order[i];
        double        p[3], radius[3], way[3], along, away, own = measure_face(f, face, p);
        const double *n = f->faces.normals[face];
        place_around(w, p, &along, radius, &away);
        whole += fabs(vector3_dot(n, radius)) < round_least ? own : 0;
        if (!tells_motion(f, w, face))
            continue;
        vector3_cross(way, w->axis, radius);
        double around = vector3_dot(n, way), off = leaning_of(w, n, radius, away), out = vector3_dot(n, radius);
        leant += own * off * off;
        turned += own * around * around;
        area += own;
        outwards += out > -0.02 ? own : 0;
        inwards += out < 0.02 ? own : 0;
        for (int k = 0; k < 3; k++) {
            corner_of(f, face, k, p);
            place_around(w, p, &along, radius, &away);
            w->low = fmin(w->low, along);
            w->high = fmax(w->high, along);
            w->inner = fmin(w->inner, away);
            w->outer = fmax(w->outer, away);
        }
    }
    if (!(area > share_least * whole))
        return false;
    leant = sqrt(leant / area);
    turned = sqrt(turned / area);
    w->hollow = inwards > outwards;
    double lead = 2 * pi * fabs(w->pitch);
    return leant < off_most && turned > better_least * leant && fmax(inwards, outwards) > outwards_least * area &&
           lead > 0 && (w->high - w->low) > turns_least * lead && fabs(w->pitch) < lead_most * w->outer &&
           w->inner > root_least * w->outer && w->outer - w->inner > depth_least * w->outer;
}

static bool find_windings(finder *f)
{
    for (size_t i = 0; i < f->count; i++) {
        winding w = {.area = 0};
        if (f->starts[i + 1] - f->starts[i] < FACES_LEAST || !settle_motion(f, i, &w) || !measure_winding(f, &w))
            continue;
        if (!mem_grow((void **)&f->windings, &f->winding_capacity, f->winding_count + 1, sizeof *f->windings))
            return false;
        f->windings[f->winding_count++] = w;
    }
    return true;
}

/* --- threads -------------------------------------------------------------------------------------------- */

static bool are_one(const winding *a, const winding *b)
{
    double radius[3], along, away;
    place_around(a, b->centre, &along, radius, &away);
    double way = vector3_dot(a->axis, b->axis) < 0 ? -1 : 1, low = along + (way > 0 ? b->low : -b->high),
           high = along + (way > 0 ? b->high : -b->low);
    return a->hollow == b->hollow && fabs(vector3_dot(a->axis, b->axis)) > cos(same_axis) &&
           away < same_centre * a->outer && fabs(a->pitch - b->pitch) < same_lead * fabs(a->pitch) &&
           fabs(a->outer - b->outer) < 0.2 * a->outer && low < a->high && high > a->low;
}

/* The axis that the crests, or else the roots, lie around. */
static void refine_axis(const finder *f, winding *w)
{
    const uint32_t count = f->mesh->vertex_count;
    double(*points)[3] = mem_alloc(((size_t)count + 1) * sizeof *points);
    for (int round = 0; round < 2 && points; round++) {
        size_t       found = 0;
        const double near = (round ? 0.02 : 0.1) * (w->outer - w->inner), lead = 2 * pi * fabs(w->pitch),
                     within = w->high - w->low > 2.5 * lead ? lead : 0;
        for (uint32_t i = 0; i < count; i++) {
            vec3   v = f->mesh->positions[i];
            double p[3] = {(double)v.x, (double)v.y, (double)v.z}, radius[3], along, away;
            place_around(w, p, &along, radius, &away);
            if (along > w->low + within && along < w->high - within &&
                fabs(away - (w->hollow ? w->inner : w->outer)) < near)
                vector3_copy(points[found++], p);
        }
        cylinder_fit fit = {.radius = w->hollow ? w->inner : w->outer};
        vector3_copy(fit.axis, w->axis);
        vector3_copy(fit.centre, w->centre);
        cylinder_frame(&fit);
        if (found < 16 || !cylinder_refine(&fit, (const double(*)[3])points, found) ||
            fabs(vector3_dot(fit.axis, w->axis)) < cos(same_axis))
            break;
        vector3_copy(w->axis, fit.axis);
        vector3_copy(w->centre, fit.centre);
        *(w->hollow ? &w->inner : &w->outer) = fit.radius;
    }
    mem_free(points);
}

static void reach_around(const finder *f, winding *w, size_t component, const double within[2])
{
    for (size_t i = f->starts[component]; i < f->starts[component + 1]; i++)
        for (int k = 0; k < 3 && tells_motion(f, w, f->order[i]); k++) {
            double p[3], radius[3], along, away;
            corner_of(f, f->order[i], k, p);
            place_around(w, p, &along, radius, &away);
            w->low = fmin(w->low, along);
            w->high = fmax(w->high, along);
            w->least = fmin(w->least, away);
            w->most = fmax(w->most, away);
            if ((along < within[0] || along > within[1]))
                continue;
            w->inner = fmin(w->inner, away);
            w->outer = fmax(w->outer, away);
        }
}

/* Strips of crests and roots lie between the flanks: whatever lies within the thread as a whole is of it. */
static bool lies_within(const finder *f, const winding *w, uint32_t face, double near)
{
    for (int k = 0; k < 3; k++) {
        double p[3], radius[3], along, away;
        corner_of(f, face, k, p);
        place_around(w, p, &along, radius, &away);
        if (along < w->low - near || along > w->high + near || away < w->least - near || away > w->most + near)
            return false;
    }
    return true;
}

/* Does a surface go on beyond an end that is round and as large, or nearly so? */
static bool goes_on_beyond(const finder *f, const winding *w, const uint32_t *region, uint32_t own, bool high)
{
    const double near = 0.5 * (w->outer - w->inner), end = high ? w->high : w->low;
    for (uint32_t i = 0; i < f->mesh->face_count; i++) {
        double   p[3], radius[3], along, away, beyond = 0;
        uint32_t shared = 0;
        for (int k = 0; k < 3; k++) {
            shared += region[f->mesh->faces[i][k]] == own;
            corner_of(f, i, k, p);
            place_around(w, p, &along, radius, &away);
            beyond = fmax(beyond, high ? along - end : end - along);
        }
        if (!shared || shared == 3 || !(beyond > near))
            continue;
        measure_face(f, i, p);
        place_around(w, p, &along, radius, &away);
        double out = vector3_dot(f->faces.normals[i], radius);
        if ((w->hollow ? -out : out) > 0.97 && away > w->inner - near && away < w->outer + near)
            return true;
    }
    return false;
}

static lmn_status put_thread(draft_threads *out, const finder *f, winding *w, uint32_t *region, lmn_error *error)
{
    if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
        return error_memory(error);
    const double   near = 1e-3 * w->outer;
    const uint32_t own = (uint32_t)out->count + 1;
    for (uint32_t i = 0; i < f->mesh->face_count; i++)
        for (int k = 0; k < 3 && lies_within(f, w, i, near); k++)
            region[f->mesh->faces[i][k]] = own;
    draft_thread *t = &out->items[out->count++];
    *t = (draft_thread){.crest = w->hollow ? w->inner : w->outer,
                        .root = w->hollow ? w->outer : w->inner,
                        .flat = {0, w->high - w->low},
                        .hollow = w->hollow,
                        .lead = 2 * pi * fabs(w->pitch)};
    vector3_copy(t->axis, w->axis);
    for (int k = 0; k < 2; k++) {
        t->tip[k] = t->crest;
        vector3_add(t->ends[k], w->centre, k ? w->high : w->low, w->axis);
        t->goes_on[k] = goes_on_beyond(f, w, region, own, k);
    }
    return LMN_OK;
}

static void begin_reach(winding *w)
{
    w->low = w->inner = w->least = INFINITY;
    w->high = -INFINITY;
    w->outer = w->most = 0;
}

/* How far all that are one with a winding reach. What is crest and root is said where chamfers and ends do not reach,
 * if the thread is long enough for that. */
static void gather_reach(finder *f, winding *whole, size_t first)
{
    for (size_t k = first; k < f->winding_count; k++)
        if (!f->windings[k].thread && (k == first || are_one(&f->windings[first], &f->windings[k])))
            f->windings[k].thread = first + 1;
    double lead = 2 * pi * fabs(whole->pitch), within[2] = {-INFINITY, INFINITY};
    for (int round = 0; round < 2; round++) {
        if (round && whole->high - whole->low > 2.5 * lead) {
            within[0] = whole->low + lead;
            within[1] = whole->high - lead;
        }
        begin_reach(whole);
        for (size_t k = first; k < f->winding_count; k++)
            if (f->windings[k].thread == first + 1)
                reach_around(f, whole, f->windings[k].component, within);
    }
}

static lmn_status take_threads(draft_threads *out, finder *f, uint32_t *region, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < f->winding_count && status == LMN_OK; i++) {
        winding whole = f->windings[i];
        if (f->windings[i].thread)
            continue;
        for (int round = 0; round < 2; round++) { /* with the axis that all have in common, once more */
            gather_reach(f, &whole, i);
            if (round == 0)
                refine_axis(f, &whole);
        }
        if (whole.outer - whole.inner < depth_most * 2 * pi * fabs(whole.pitch))
            status = put_thread(out, f, &whole, region, error);
    }
    return status;
}

lmn_status draft_threads_find(draft_threads *out, uint32_t *region, const edge_mesh *m, lmn_error *error)
{
    finder f = {.mesh = m};
    memset(region, 0, m->vertex_count * sizeof *region);
    lmn_status status = draft_faces_make(&f.faces, m, error);
    if (status == LMN_OK && (!find_components(&f) || !find_windings(&f)))
        status = error_memory(error);
    if (status == LMN_OK)
        status = take_threads(out, &f, region, error);
    draft_faces_release(&f.faces);
    mem_free(f.component);
    mem_free(f.weights);
    mem_free(f.starts);
    mem_free(f.order);
    mem_free(f.windings);
    return status;
}

void draft_threads_release(draft_threads *t)
{
    mem_free(t->items);
    *t = (draft_threads){NULL, 0, 0};
}
