#include "stroke/form_view.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

/* Brings the eye to the model's axes. False when the model has no thickness there. */
static bool bring_eye(form_view *f)
{
    mat4   whole = mat4_multiply(&f->v->camera.view, &f->item->world);
    double cofactors[9], whole_volume = mat4_cofactors(&whole, cofactors), out[3];
    f->mirrored = whole_volume < 0;
    double from[3] = {-whole.m[12], -whole.m[13], -whole.m[14]};
    if (f->v->camera.orthographic) {
        from[0] = from[1] = 0;
        from[2] = 1;
    }
    if (!(fabs(whole_volume) > 0))
        return false;
    for (int k = 0; k < 3; k++)
        out[k] = (cofactors[3 * k] * from[0] + cofactors[3 * k + 1] * from[1] + cofactors[3 * k + 2] * from[2]) /
                 whole_volume;
    f->eye = (double3){out[0], out[1], out[2]};
    return isfinite(out[0]) && isfinite(out[1]) && isfinite(out[2]);
}

bool form_view_open(form_view *f, view_lines *out, const stroke_view *v, uint32_t item, const form_surface *s,
                    bool *seen)
{
    *f = (form_view){.out = out, .v = v, .item = &v->scene->items[item], .s = s, .index = item};
    f->m = &v->scene->meshes[f->item->mesh];
    *seen = bring_eye(f);
    if (!*seen)
        return true;
    f->facing = mem_alloc(((size_t)s->knot_count + 1) * sizeof *f->facing);
    f->numbers = mem_alloc(((size_t)s->face_count * 3 + 1) * sizeof *f->numbers);
    if (!f->facing || !f->numbers)
        return false;
    memset(f->numbers, 0xFF, (size_t)s->face_count * 3 * sizeof *f->numbers);
    for (uint32_t i = 0; i < s->knot_count; i++) {
        vec3    p = f->m->positions[s->vertices[i]], n = s->normals[i];
        double3 d = form_direction(f, (double3){p.x, p.y, p.z});
        f->facing[i] = n.x * d.x + n.y * d.y + n.z * d.z;
    }
    return true;
}

void form_view_close(form_view *f)
{
    mem_free(f->facing);
    mem_free(f->numbers);
    memset(f, 0, sizeof *f);
}

double3 form_direction(const form_view *f, double3 position)
{
    bool    parallel = f->v->camera.orthographic;
    double3 d = parallel ? f->eye : (double3){f->eye.x - position.x, f->eye.y - position.y, f->eye.z - position.z};
    double  length = sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    return length > 0 ? (double3){d.x / length, d.y / length, d.z / length} : (double3){0, 0, 0};
}

double3 form_position(const form_view *f, uint32_t face, uint32_t corner)
{
    vec3 p = f->m->positions[f->m->faces[face][corner % 3]];
    return (double3){p.x, p.y, p.z};
}

int form_side(const form_view *f, uint32_t face)
{
    uint32_t piece = f->m->pieces[face];
    vec3     n = f->m->normals[face];
    double3  d = form_direction(f, form_position(f, face, 0));
    double   towards = n.x * d.x + n.y * d.y + n.z * d.z;
    if (!f->m->closed[piece])
        return (towards > 0) - (towards < 0);
    return (f->m->inward[piece] ? -towards : towards) > 0;
}

form_end form_cross(form_view *f, uint32_t half, double begin, double end, double *fraction)
{
    uint32_t opposite = f->s->opposite[half], own = opposite < half ? opposite : half; /* NO_HALF is above all */
    double   first = own == half ? begin : end, last = own == half ? end : begin,
           at = first == last ? 0.5 : first / (first - last);
    double3 a = form_position(f, own / 3, own % 3), b = form_position(f, own / 3, own % 3 + 1);
    if (f->numbers[own] == NO_VERTEX)
        f->numbers[own] = f->out->end_count++;
    *fraction = own == half ? at : 1 - at;
    return (form_end){{a.x + at * (b.x - a.x), a.y + at * (b.y - a.y), a.z + at * (b.z - a.z)}, f->numbers[own], 1};
}

double3 form_to_world(const form_view *f, double3 p)
{
    const double *m = f->item->world.m;
    return (double3){m[0] * p.x + m[4] * p.y + m[8] * p.z + m[12], m[1] * p.x + m[5] * p.y + m[9] * p.z + m[13],
                     m[2] * p.x + m[6] * p.y + m[10] * p.z + m[14]};
}

/* What is left of an end whose weight is below 0: where it reaches 0. */
static form_end cut_end(form_view *f, form_end gone, form_end other)
{
    double  fraction = gone.weight / (gone.weight - other.weight);
    double3 p = gone.position, q = other.position;
    return (form_end){{p.x + fraction * (q.x - p.x), p.y + fraction * (q.y - p.y), p.z + fraction * (q.z - p.z)},
                      f->out->end_count++,
                      0};
}

bool form_put(form_view *f, stroke_class kind, uint32_t face, form_end a, form_end b, bool turned)
{
    if (a.weight <= 0 && b.weight <= 0)
        return true;
    if (a.weight < 0)
        a = cut_end(f, a, b);
    else if (b.weight < 0)
        b = cut_end(f, b, a);
    uint32_t       number = f->v->items[f->index].first_face + face;
    const uint32_t faces[2] = {number, EDGE_NO_FACE};
    view_line      line = {
             kind,
             f->index,
             {a.number, b.number},
             line_id((uint64_t)f->index << 32 | f->item->part_index, (uint64_t)kind << 40 | UINT64_C(1) << 56 | face),
             {fminf(a.weight, 1), fminf(b.weight, 1)},
             false,
             turned};
    return lines_put(f->out, f->v, line, form_to_world(f, a.position), form_to_world(f, b.position), faces);
}

float form_fade(double measure, double limit)
{
    return (float)fmin((measure - limit) / limit, 1);
}
