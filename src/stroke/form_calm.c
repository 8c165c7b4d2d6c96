/* Outlines of samplings: where the normal of the surface that is sampled, means over a few edges around, is at right
 * angles to the view. The mesh itself is too rough there to say what it hides: many small folds stand one behind the
 * other. So outlines are looked for a little outside, where noise does not reach. */
#include "stroke/form_view.h"

#include <math.h>

#include "base/memory.h"

/* How far outside: mean edges, and more with the noise, whose folds are as high as they turn. */
#define LIFT       0.1
#define LIFT_NOISE 0.6

/* By how much the item's world lengthens what lies on it: the mean over its axes. */
static double growth_of(const stroke_item *item)
{
    double cofactors[9];
    return cbrt(fabs(mat4_cofactors(&item->world, cofactors)));
}

static double3 lifted(const form_view *f, double3 p, double3 normal, double by)
{
    return form_to_world(f, (double3){p.x + by * normal.x, p.y + by * normal.y, p.z + by * normal.z});
}

static double3 normal_around(const form_view *f, uint32_t face)
{
    double3 sum = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        vec3 n = f->s->calm_normals[f->s->corners[face][k]];
        sum = (double3){sum.x + n.x, sum.y + n.y, sum.z + n.z};
    }
    double length = sqrt(double3_dot(sum, sum));
    return length > 0 ? (double3){sum.x / length, sum.y / length, sum.z / length} : sum;
}

/* What closes nothing has an outline to the side that it is convex on. */
static bool put_lift(form_view *f, uint32_t face, size_t line, form_end a, form_end b)
{
    view_lines          *out = f->out;
    const edge_sampling *e = &f->m->sampling;
    double3              n = normal_around(f, face);
    double               by = e->mean_edge * (LIFT + LIFT_NOISE * e->noise);
    view_lift            lift = {.line = (uint32_t)line, .edge = e->mean_edge * growth_of(f->item)};
    if (!f->m->closed[f->m->pieces[face]] && form_is_hollow(f, face, a.position))
        by = -by;
    lift.ends[0] = lifted(f, a.position, n, by);
    lift.ends[1] = lifted(f, b.position, n, by);
    if (!view_position(f->v, lift.ends[0], &lift.a) || !view_position(f->v, lift.ends[1], &lift.b))
        return true;
    if (out->lines[line].ends[0] != a.number || out->lines[line].ends[1] != b.number) /* cut off */
        return true;
    if (!mem_grow((void **)&out->lifts, &out->lift_capacity, out->lift_count + 1, sizeof *out->lifts))
        return false;
    out->lifts[out->lift_count++] = lift;
    return true;
}

/* Lists the face as what does not hide the line, which says of it that it lies beside the mesh's own outline. */
static bool put_ignored(form_view *f, size_t line, uint32_t face, size_t *count, size_t *capacity)
{
    if (!mem_grow((void **)&f->out->ignored, capacity, *count + 1, sizeof *f->out->ignored))
        return false;
    f->out->ignored[(*count)++] = f->v->items[f->index].first_face + face;
    f->out->segments[line].ignored_count = 1;
    return true;
}

typedef struct calm_lists {
    size_t ignored, capacity;
} calm_lists;

static bool put_piece(form_view *f, calm_lists *lists, uint32_t face, form_end a, form_end b)
{
    size_t   before = f->out->count;
    uint32_t piece = f->m->pieces[face];
    if (!form_put(f, STROKE_CONTOUR, face, a, b, f->mirrored != (f->m->closed[piece] && f->m->inward[piece])))
        return false;
    return f->out->count == before ||
           (put_ignored(f, before, face, &lists->ignored, &lists->capacity) && put_lift(f, face, before, a, b));
}

static void find_facing(form_view *f, const vec3 *normals)
{
    for (uint32_t i = 0; i < f->s->knot_count; i++) {
        vec3    p = f->m->positions[f->s->vertices[i]], n = normals[i];
        double3 d = form_direction(f, (double3){p.x, p.y, p.z});
        f->facing[i] = n.x * d.x + n.y * d.y + n.z * d.z;
    }
}

bool calm_collect(form_view *f)
{
    bool       good = true;
    calm_lists lists = {0, 0};
    for (size_t i = 0; i < f->out->count; i++)
        lists.ignored += f->out->segments[i].ignored_count;
    lists.capacity = lists.ignored;
    find_facing(f, f->s->calm_normals);
    for (uint32_t face = 0; face < f->s->face_count && good; face++) {
        form_end ends[2];
        good = !form_outline(f, face, ends) || put_piece(f, &lists, face, ends[0], ends[1]);
    }
    find_facing(f, f->s->normals); /* as lines of form have it */
    return good;
}
