/* Glyphs as meshes. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/random.h"
#include "depict/depict_private.h"

void depict_to_eye(const depict_job *j, const double at[3], double out[3])
{
    vector3_add(out, j->camera.orthographic ? j->camera.target : at, 0, at);
    for (int k = 0; k < 3; k++)
        out[k] = j->camera.eye[k] - (j->camera.orthographic ? j->camera.target[k] : at[k]);
    if (!vector3_normalise(out))
        vector3_set(out, 0, 0, 1);
}

void depict_lift(const depict_job *j, double at[3], double distance)
{
    double to_eye[3];
    depict_to_eye(j, at, to_eye);
    if (!j->camera.orthographic) {
        /* Never at the eye, and of two distances the farther one stays before the other. */
        const double far = vector3_distance(j->camera.eye, at), free = 0.7 * far, rest = 0.2 * far,
                     over = rest > 0 ? fmax(distance - free, 0) / rest : 0;
        distance = fmin(distance, free) + rest * over / (1 + over);
    }
    vector3_add(at, at, distance, to_eye);
}

double depict_front(const depict_job *j, const double at[3])
{
    const double ends[2][3] = {{(double)j->box.min.x, (double)j->box.min.y, (double)j->box.min.z},
                               {(double)j->box.max.x, (double)j->box.max.y, (double)j->box.max.z}};
    double       to_eye[3], most = 0;
    depict_to_eye(j, at, to_eye);
    for (int i = 0; i < 8 && !box3_is_empty(j->box); i++) {
        double corner[3] = {ends[i & 1][0], ends[i >> 1 & 1][1], ends[i >> 2][2]};
        vector3_add(corner, corner, -1, at);
        most = fmax(most, vector3_dot(corner, to_eye));
    }
    return most + 0.02 * j->size;
}

double depict_random(const depict_job *j, const expression *e, uint32_t which, uint32_t what)
{
    random_source r = random_start(j->seed ^ (e->number * 0x9E3779B9u), which * 64 + what);
    return random_unit(&r);
}

/* --- meshes ------------------------------------------------------------------------------------------------------- */

uint32_t glyph_vertex(glyph_mesh *m, const double at[3])
{
    if (m->failed ||
        !mem_grow((void **)&m->positions, &m->position_capacity, m->position_count + 1, sizeof *m->positions)) {
        m->failed = true;
        return 0;
    }
    m->positions[m->position_count] = (vec3){(float)at[0], (float)at[1], (float)at[2]};
    return (uint32_t)m->position_count++;
}

void glyph_triangle(glyph_mesh *m, uint32_t a, uint32_t b, uint32_t c)
{
    if (m->failed || !mem_grow((void **)&m->indices, &m->index_capacity, m->index_count + 3, sizeof *m->indices)) {
        m->failed = true;
        return;
    }
    m->indices[m->index_count++] = a;
    m->indices[m->index_count++] = b;
    m->indices[m->index_count++] = c;
}

void glyph_line(glyph_mesh *m, uint32_t a, uint32_t b)
{
    if (m->failed || !mem_grow((void **)&m->lines, &m->line_capacity, m->line_count + 2, sizeof *m->lines)) {
        m->failed = true;
        return;
    }
    m->lines[m->line_count++] = a;
    m->lines[m->line_count++] = b;
}

void glyph_mesh_release(glyph_mesh *m)
{
    mem_free(m->positions);
    mem_free(m->indices);
    mem_free(m->lines);
    memset(m, 0, sizeof *m);
}

/* --- flat things that face the viewer ----------------------------------------------------------------------------- */

/* Across the way and the line of sight; what it was before where the two are one. */
static void ribbon_side(const depict_job *j, const glyph_ribbon *r, size_t i, double side[3])
{
    double       along[3], to_eye[3], wanted[3];
    const size_t before = i > 0 ? i - 1 : 0, after = i + 1 < r->count ? i + 1 : i;
    double       a[3], b[3];
    vector3_add(a, r->points[i], -1, r->points[before]);
    vector3_add(b, r->points[after], -1, r->points[i]);
    bool has_a = vector3_normalise(a), has_b = vector3_normalise(b);
    for (int k = 0; k < 3; k++)
        along[k] = (has_a ? a[k] : 0) + (has_b ? b[k] : 0);
    depict_to_eye(j, r->points[i], to_eye);
    vector3_cross(wanted, to_eye, along);
    if (vector3_length(wanted) > 0.02 && vector3_normalise(wanted)) {
        /* At a corner the breadth stays what it is. */
        double across[3];
        vector3_cross(across, to_eye, has_b ? b : a);
        double slant = vector3_normalise(across) ? fabs(vector3_dot(across, wanted)) : 1;
        vector3_copy(side, wanted);
        for (int k = 0; k < 3; k++)
            side[k] /= fmax(slant, 0.5);
    }
}

/* Does a triangle look to the viewer, as a ribbon's do that goes on, instead of back over itself? */
static bool goes_on(const depict_job *j, const glyph_mesh *m, uint32_t a, uint32_t b, const double c[3])
{
    const vec3 *p = &m->positions[a], *q = &m->positions[b];
    double      first[3], second[3], normal[3], to_eye[3];
    vector3_set(first, (double)q->x - (double)p->x, (double)q->y - (double)p->y, (double)q->z - (double)p->z);
    vector3_set(second, c[0] - (double)p->x, c[1] - (double)p->y, c[2] - (double)p->z);
    vector3_cross(normal, first, second);
    depict_to_eye(j, c, to_eye);
    return vector3_dot(normal, to_eye) > 0;
}

static void copy_vertex(const glyph_mesh *m, uint32_t i, double out[3])
{
    vector3_set(out, (double)m->positions[i].x, (double)m->positions[i].y, (double)m->positions[i].z);
}

void glyph_put_ribbon(glyph_mesh *m, const depict_job *j, const glyph_ribbon *r)
{
    double   side[3];
    uint32_t last[2] = {0, 0};
    vector3_copy(side, j->camera.up);
    for (size_t i = 0; i < r->count && r->count > 1 && !m->failed; i++) {
        double left[3], right[3];
        ribbon_side(j, r, i, side);
        vector3_add(left, r->points[i], r->widths[i] / 2, side);
        vector3_add(right, r->points[i], -r->widths[i] / 2, side);
        const bool pointed = !(r->widths[i] > 0), between = i > 0 && !pointed && last[0] != last[1];
        /* In a bend sharper than it is broad the inner side stays where it is. */
        const bool left_on = !between || goes_on(j, m, last[0], last[1], left);
        if (!left_on)
            copy_vertex(m, last[0], left);
        uint32_t   a = glyph_vertex(m, left);
        const bool right_on = m->failed || !between || goes_on(j, m, a, last[1], right);
        if (!right_on)
            copy_vertex(m, last[1], right);
        uint32_t b = pointed ? a : glyph_vertex(m, right);
        if (i > 0 && last[0] != last[1] && left_on)
            glyph_triangle(m, last[0], last[1], a);
        if (i > 0 && a != b && right_on)
            glyph_triangle(m, a, last[1], b);
        last[0] = a;
        last[1] = b;
    }
}

void depict_page_axes(const depict_job *j, double right[3], double up[3])
{
    const double *v = j->camera.view.m;
    for (int k = 0; k < 3; k++) {
        right[k] = v[4 * k];
        up[k] = v[4 * k + 1];
    }
}
