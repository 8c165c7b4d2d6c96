/* How much room each face has for lines: a face is what hangs together between creases. On narrow ones lines side by
 * side are no tone but a blot, so whoever draws leaves them bare. */
#include <math.h>

#include "base/groups.h"
#include "base/memory.h"
#include "marks/streamlines.h"

static const double CREASE = 0.766; /* cosine of 40 degrees, as directions have it */

/* Sums over the triangles of a face. */
typedef struct face_sums {
    double area, perimeter, first[3], second[6]; /* moments of its area: xx yy zz xy yz zx */
} face_sums;

static void add_triangle(face_sums *s, const flow_surface *f, uint32_t t)
{
    static const int rows[6] = {0, 1, 2, 0, 1, 2}, columns[6] = {0, 1, 2, 1, 2, 0};
    const uint32_t  *i = &f->surface->indices[3 * (size_t)t];
    const vec3      *p = f->surface->positions;
    d3               c[3] = {of(p[i[0]]), of(p[i[1]]), of(p[i[2]])};
    double           area = 0.5 * d3_length(cross(minus(c[1], c[0]), minus(c[2], c[0])));
    s->area += area;
    /* A triangle has the moments of a third of its area at the middle of each side. */
    for (int k = 0; k < 3; k++) {
        d3           m = d3_along(c[k], minus(c[(k + 1) % 3], c[k]), 0.5);
        const double at[3] = {m.x, m.y, m.z};
        for (int n = 0; n < 3; n++)
            s->first[n] += area / 3 * at[n];
        for (int n = 0; n < 6; n++)
            s->second[n] += area / 3 * at[rows[n]] * at[columns[n]];
    }
}

/* The middle one of three eigenvalues of a symmetric matrix. */
static double middle_eigenvalue(const double m[6])
{
    double mean = (m[0] + m[1] + m[2]) / 3, a = m[0] - mean, b = m[1] - mean, c = m[2] - mean;
    double spread = sqrt((a * a + b * b + c * c + 2 * (m[3] * m[3] + m[4] * m[4] + m[5] * m[5])) / 6);
    if (!(spread > 0))
        return mean;
    double determinant = a * (b * c - m[4] * m[4]) - m[3] * (m[3] * c - m[4] * m[5]) + m[5] * (m[3] * m[4] - b * m[5]);
    double half = fmin(fmax(determinant / (2 * spread * spread * spread), -1), 1);
    return mean + 2 * spread * cos(acos(half) / 3 - 2.0943951023931953);
}

/* The narrower of how broad it is as a whole, and of how far its edges are from each other. */
static double room_of(const face_sums *s)
{
    static const int rows[6] = {0, 1, 2, 0, 1, 2}, columns[6] = {0, 1, 2, 1, 2, 0};
    double           spread[6];
    if (!(s->area > 0))
        return 0;
    for (int n = 0; n < 6; n++)
        spread[n] = s->second[n] / s->area - s->first[rows[n]] * s->first[columns[n]] / (s->area * s->area);
    double broad = sqrt(12 * fmax(middle_eigenvalue(spread), 0));
    return s->perimeter > 0 ? fmin(broad, 4 * s->area / s->perimeter) : broad;
}

static bool is_crease(const flow_surface *f, uint32_t half)
{
    return f->across[half] == UINT32_MAX ||
           dot(flow_face_normal(f, half / 3), flow_face_normal(f, f->across[half] / 3)) < CREASE;
}

bool flow_rooms_make(flow_surface *f)
{
    uint32_t   count = f->surface->triangle_count;
    uint32_t  *faces = mem_alloc((size_t)count * sizeof *faces);
    face_sums *sums = mem_calloc(count, sizeof *sums);
    f->rooms = mem_alloc((size_t)count * sizeof *f->rooms);
    bool done = faces && sums && f->rooms;
    for (uint32_t t = 0; t < count && done; t++)
        faces[t] = t;
    for (uint32_t h = 0; h < 3 * count && done; h++)
        if (!is_crease(f, h))
            group_join(faces, h / 3, f->across[h] / 3);
    for (uint32_t h = 0; h < 3 * count && done; h++) {
        face_sums      *s = &sums[group_root(faces, h / 3)];
        const uint32_t *i = &f->surface->indices[3 * (size_t)(h / 3)];
        if (h % 3 == 0)
            add_triangle(s, f, h / 3);
        if (is_crease(f, h))
            s->perimeter +=
                d3_length(minus(of(f->surface->positions[i[(h + 1) % 3]]), of(f->surface->positions[i[h % 3]])));
    }
    for (uint32_t t = 0; t < count && done; t++)
        f->rooms[t] = (float)room_of(&sums[group_root(faces, t)]);
    mem_free(faces);
    mem_free(sums);
    return done;
}
