/* Marks on a surface that has moved and bent: each stays where it is on its triangle. */
#include "marks/d3.h"
#include "marks/marks.h"

#include <math.h>

static vec3 narrow(d3 v)
{
    return (vec3){(float)v.x, (float)v.y, (float)v.z};
}

static d3 plus(d3 a, d3 b, double times)
{
    return (d3){a.x + times * b.x, a.y + times * b.y, a.z + times * b.z};
}

static d3 unit(d3 v)
{
    double length = sqrt(dot(v, v));
    return length > 0 ? (d3){v.x / length, v.y / length, v.z / length} : v;
}

/* A triangle: its first corner, two edges and the unit normal. */
typedef struct frame {
    d3 corner, right, up, normal;
} frame;

static frame frame_of(const mark_surface *s, uint32_t triangle)
{
    const uint32_t *c = &s->indices[3 * (size_t)triangle];
    frame           f = {.corner = of(s->positions[c[0]])};
    f.right = minus(of(s->positions[c[1]]), f.corner);
    f.up = minus(of(s->positions[c[2]]), f.corner);
    f.normal = unit(cross(f.right, f.up));
    return f;
}

/* How much of both edges a point of the triangle's plane has, and how far above it is. */
static d3 coordinates(const frame *f, d3 p)
{
    d3     from = minus(p, f->corner), across = cross(f->right, f->up);
    double area = dot(across, across);
    if (!(area > 0))
        return (d3){0, 0, 0};
    return (d3){dot(cross(from, f->up), across) / area, dot(cross(f->right, from), across) / area,
                dot(from, f->normal)};
}

static d3 point_at(const frame *f, d3 c)
{
    return plus(plus(plus(f->corner, f->right, c.x), f->up, c.y), f->normal, c.z);
}

static d3 normal_at(const mark_surface *s, uint32_t triangle, double b, double c)
{
    const uint32_t *v = &s->indices[3 * (size_t)triangle];
    d3              sum = plus(plus(plus((d3){0, 0, 0}, of(s->normals[v[0]]), 1 - b - c), of(s->normals[v[1]]), b),
                               of(s->normals[v[2]]), c);
    return unit(sum);
}

static void carry_dots(marks *m, const mark_surface *now)
{
    for (size_t i = 0; i < m->dot_count; i++) {
        mark_dot *d = &m->dots[i];
        frame     f = frame_of(now, d->triangle);
        double    b = (double)d->fraction[0], c = (double)d->fraction[1];
        d->position = narrow(point_at(&f, (d3){b, c, 0}));
        d->normal = narrow(normal_at(now, d->triangle, b, c));
    }
}

static void carry_line(mark_line *l, const mark_surface *before, const mark_surface *now)
{
    frame from = frame_of(before, l->triangle), to = frame_of(now, l->triangle);
    d3    a = coordinates(&from, of(l->a)), b = coordinates(&from, of(l->b));
    l->a = narrow(point_at(&to, a));
    l->b = narrow(point_at(&to, b));
    double x = fmin(fmax((a.x + b.x) / 2, 0), 1), y = fmin(fmax((a.y + b.y) / 2, 0), 1 - x);
    l->normal = narrow(normal_at(now, l->triangle, x, y));
    for (int end = 0; end < 2; end++) {
        const d3 *at = end ? &b : &a;
        double    u = fmin(fmax(at->x, 0), 1), v = fmin(fmax(at->y, 0), 1 - u);
        l->ends[end].normal = narrow(normal_at(now, l->triangle, u, v));
    }
}

static bool same_point(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The middle of a stroke lies on the piece that has half of its length before it. */
static void set_middle(mark_line *pieces, size_t count)
{
    const mark_line *p = &pieces[mark_stroke_middle(pieces, count)];
    double           span = (double)p->to - (double)p->from, half = (double)p->length / 2 - (double)p->from,
           t = span > 0 ? fmin(fmax(half / span, 0), 1) : 0.5;
    vec3 at = narrow(plus(of(p->a), minus(of(p->b), of(p->a)), t)), normal = p->normal;
    for (size_t i = 0; i < count; i++) {
        pieces[i].middle = at;
        pieces[i].middle_normal = normal;
    }
}

/* Pieces may lie over several small triangles, which bend apart: what was one point stays one. */
static void carry_stroke(mark_line *pieces, size_t count, const mark_surface *before, const mark_surface *now)
{
    bool joined = false;
    for (size_t i = 0; i < count; i++) {
        bool joins = i + 1 < count && same_point(pieces[i].b, pieces[i + 1].a);
        carry_line(&pieces[i], before, now);
        if (joined) {
            vec3 *end = &pieces[i - 1].b, *begin = &pieces[i].a;
            *end = *begin = narrow(plus(of(*end), minus(of(*begin), of(*end)), 0.5));
        }
        joined = joins;
    }
    set_middle(pieces, count);
}

void marks_carry(marks *m, const mark_surface *before, const mark_surface *now)
{
    carry_dots(m, now);
    for (size_t i = 0, next; i < m->line_count; i = next) {
        for (next = i + 1; next < m->line_count && m->lines[next].stroke == m->lines[i].stroke;)
            next++;
        carry_stroke(&m->lines[i], next - i, before, now);
    }
    m->area = mark_surface_area(now);
}
