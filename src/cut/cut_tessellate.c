/* Outlines to triangles, by GLU's tessellator. It takes memory past base/memory.h and gives all of it back. */
#include <GL/glu.h>
#include <math.h>

#include "base/memory.h"
#include "cut/cut_private.h"

/* Positions are parts of the part's extent; beyond this something is wrong with them. */
#define POSITION_MAX 1e3

typedef struct filling {
    cut_job       *job;
    cut_triangles *out;
    int            plane;
    bool           refused;
} filling;

/* Vertices travel through GLU as their number + 1. */
static void *as_pointer(uint32_t vertex)
{
    return (void *)((uintptr_t)vertex + 1);
}

static uint32_t as_vertex(const void *pointer)
{
    return (uint32_t)((uintptr_t)pointer - 1);
}

static void GLAPIENTRY on_vertex(void *vertex, void *user)
{
    filling       *f = user;
    cut_triangles *t = f->out;
    if (!vertex || !mem_grow((void **)&t->corners, &t->capacity, t->count + 1, sizeof *t->corners)) {
        f->job->failed = f->job->failed || vertex;
        f->refused = true;
        return;
    }
    t->corners[t->count++] = as_vertex(vertex);
}

/* Being there makes GLU give single triangles instead of fans and strips. */
static void GLAPIENTRY on_edge_flag(GLboolean flag, void *user)
{
    (void)flag;
    (void)user;
}

static void GLAPIENTRY on_error(GLenum error, void *user)
{
    filling *f = user;
    f->refused = true;
    f->job->failed = f->job->failed || error == GLU_OUT_OF_MEMORY;
}

/* A new vertex where edges meet, or one of two at the same position. */
static void GLAPIENTRY on_combine(GLdouble at[3], void *data[4], GLfloat fractions[4], void **out, void *user)
{
    filling *f = user;
    uint32_t from[4];
    double   weights[4], sum = 0;
    int      count = 0;
    (void)at;
    for (int i = 0; i < 4; i++)
        if (data[i] && fractions[i] > 0) {
            from[count] = as_vertex(data[i]);
            weights[count++] = (double)fractions[i];
            sum += (double)fractions[i];
        }
    *out = data[0];
    if (count == 0 || !(sum > 0))
        return;
    bool same = true;
    for (int i = 0; i < count; i++) {
        weights[i] /= sum;
        for (int k = 0; k < 3; k++)
            same = same && f->job->vertices[from[i]].world[k] == f->job->vertices[from[0]].world[k];
    }
    *out = same ? as_pointer(from[0]) : as_pointer(job_blend(f->job, from, weights, count, f->plane));
}

void contour_position(const cut_job *j, double axes[2][3], uint32_t vertex, double out[2])
{
    const double *at = j->vertices[vertex].world;
    for (int i = 0; i < 2; i++) {
        out[i] = 0;
        for (int k = 0; k < 3; k++)
            out[i] += axes[i][k] * (at[k] - j->centre[k]) * j->scale;
    }
}

static void give_contour(filling *f, GLUtesselator *t, double axes[2][3], const cut_contour *c)
{
    gluTessBeginContour(t);
    for (size_t i = 0; i < c->count; i++) {
        uint32_t vertex = c->points[c->reversed ? c->count - 1 - i : i];
        GLdouble at[3] = {0, 0, 0};
        contour_position(f->job, axes, vertex, at);
        if (!(fabs(at[0]) < POSITION_MAX && fabs(at[1]) < POSITION_MAX))
            f->refused = true;
        else
            gluTessVertex(t, at, as_pointer(vertex));
    }
    gluTessEndContour(t);
}

bool contours_fill(cut_triangles *out, cut_job *j, int plane, double axes[2][3], const cut_contour *contours,
                   size_t count, cut_rule rule)
{
    static const double windings[] = {GLU_TESS_WINDING_NONZERO, GLU_TESS_WINDING_POSITIVE, GLU_TESS_WINDING_ODD};
    filling             f = {.job = j, .out = out, .plane = plane};
    GLUtesselator      *t = gluNewTess();
    out->count = 0;
    if (!t) {
        j->failed = true;
        return false;
    }
    gluTessCallback(t, GLU_TESS_VERTEX_DATA, (_GLUfuncptr)on_vertex);
    gluTessCallback(t, GLU_TESS_EDGE_FLAG_DATA, (_GLUfuncptr)on_edge_flag);
    gluTessCallback(t, GLU_TESS_COMBINE_DATA, (_GLUfuncptr)on_combine);
    gluTessCallback(t, GLU_TESS_ERROR_DATA, (_GLUfuncptr)on_error);
    gluTessProperty(t, GLU_TESS_WINDING_RULE, windings[rule]);
    gluTessNormal(t, 0, 0, 1);
    gluTessBeginPolygon(t, &f);
    for (size_t i = 0; i < count; i++)
        give_contour(&f, t, axes, &contours[i]);
    gluTessEndPolygon(t);
    gluDeleteTess(t);
    out->count -= out->count % 3;
    return !f.refused && !j->failed;
}
