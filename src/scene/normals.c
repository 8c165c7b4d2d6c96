/* Normals by crease angle. Corners are grouped by position; each group is independent, so groups are shared out to
 * threads, and only the vertices that must be split are then numbered, in order, by one. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "scene/mesh.h"

enum {
    GROUP_STACK = 64,     /* faces of one position that are handled without allocation */
    GROUP_EXACT = 2048,   /* above, faces are first summed by direction, as all pairs would take too long */
    DIRECTION_CELLS = 16, /* per side of the octahedron that is used for that */
    GROUPS_PER_THREAD = 16384
};

typedef struct corner_face {
    vec3     unit, area; /* the face's direction, and the same times its area */
    uint32_t corner;
} corner_face;

typedef struct triangle_face {
    vec3 unit, area; /* as above */
} triangle_face;

typedef struct normals_job {
    const primitive     *primitive;
    const uint32_t      *starts, *corners; /* of corner_groups */
    const triangle_face *triangles;
    float                cos_crease, cos_half;
    vec3                *vertex_normals; /* per vertex: the group's one normal, or left 0 */
    vec3                *corner_normals; /* per corner, only in groups that are split */
    unsigned char       *split;          /* per group */
    unsigned char       *failed;         /* per group: memory was gone */
} normals_job;

static vec3 unit_or(vec3 v, vec3 otherwise)
{
    /* Tiny models have squared areas below what a float holds. */
    double length = sqrt((double)v.x * v.x + (double)v.y * v.y + (double)v.z * v.z);
    if (!(length > 0) || !isfinite(length))
        return otherwise;
    return (vec3){(float)(v.x / length), (float)(v.y / length), (float)(v.z / length)};
}

static float dot(vec3 a, vec3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static vec3 add(vec3 a, vec3 b)
{
    return (vec3){a.x + b.x, a.y + b.y, a.z + b.z};
}

/* A face without area (a morph may open it) has no direction of its own and goes along with any. */
static bool within(const corner_face *a, const corner_face *b, float cos_crease)
{
    return dot(a->unit, b->unit) >= cos_crease || dot(a->unit, a->unit) == 0 || dot(b->unit, b->unit) == 0;
}

/* `normal` is the mean. Faces that all lie within half the angle of it lie within the angle of each other: a few
 * comparisons instead of all pairs. */
static bool all_within(const corner_face *faces, size_t count, vec3 normal, float cos_crease, float cos_half)
{
    const float NARROW = 0.05f, HAIR = 1e-5f; /* half of nearly 180 degrees says nothing: rounding would decide */
    bool        near = cos_half > NARROW;
    for (size_t i = 0; i < count && near; i++)
        near = dot(faces[i].unit, normal) >= cos_half + HAIR || dot(faces[i].unit, faces[i].unit) == 0;
    if (near)
        return true;
    for (size_t i = 0; i < count; i++)
        for (size_t k = i + 1; k < count; k++)
            if (!within(&faces[i], &faces[k], cos_crease))
                return false;
    return true;
}

static void split_exact(normals_job *job, const corner_face *faces, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        vec3 sum = {0, 0, 0};
        for (size_t k = 0; k < count; k++)
            if (k == i || within(&faces[i], &faces[k], job->cos_crease))
                sum = add(sum, faces[k].area);
        job->corner_normals[faces[i].corner] = unit_or(sum, unit_or(faces[i].unit, (vec3){0, 0, 1}));
    }
}

/* The cell of a direction on an unfolded octahedron. */
static int direction_cell(vec3 n)
{
    float size = fabsf(n.x) + fabsf(n.y) + fabsf(n.z);
    float u = size > 0 ? n.x / size : 0, v = size > 0 ? n.y / size : 0;
    if (n.z < 0) {
        float folded = (1 - fabsf(v)) * (u < 0 ? -1.0f : 1.0f);
        v = (1 - fabsf(u)) * (v < 0 ? -1.0f : 1.0f);
        u = folded;
    }
    int i = (int)((u * 0.5f + 0.5f) * DIRECTION_CELLS), k = (int)((v * 0.5f + 0.5f) * DIRECTION_CELLS);
    i = i < 0 ? 0 : i >= DIRECTION_CELLS ? DIRECTION_CELLS - 1 : i;
    k = k < 0 ? 0 : k >= DIRECTION_CELLS ? DIRECTION_CELLS - 1 : k;
    return k * DIRECTION_CELLS + i;
}

/* For the tip of a fan with thousands of faces: compares with the mean direction of each cell instead of each face. */
static void split_by_cells(normals_job *job, const corner_face *faces, size_t count)
{
    vec3 sums[DIRECTION_CELLS * DIRECTION_CELLS] = {{0, 0, 0}}, units[DIRECTION_CELLS * DIRECTION_CELLS];
    for (size_t i = 0; i < count; i++) {
        int cell = direction_cell(faces[i].unit);
        sums[cell] = add(sums[cell], faces[i].area);
    }
    for (int c = 0; c < DIRECTION_CELLS * DIRECTION_CELLS; c++)
        units[c] = unit_or(sums[c], (vec3){0, 0, 0});
    for (size_t i = 0; i < count; i++) {
        vec3 sum = {0, 0, 0};
        int  own = direction_cell(faces[i].unit);
        for (int c = 0; c < DIRECTION_CELLS * DIRECTION_CELLS; c++)
            if (c == own || dot(faces[i].unit, units[c]) >= job->cos_crease)
                sum = add(sum, sums[c]);
        job->corner_normals[faces[i].corner] = unit_or(sum, unit_or(faces[i].unit, (vec3){0, 0, 1}));
    }
}

static void do_group(normals_job *job, size_t group, corner_face *faces, size_t count)
{
    vec3 sum = {0, 0, 0};
    for (size_t i = 0; i < count; i++) {
        uint32_t corner = job->corners[job->starts[group] + i];
        faces[i] = (corner_face){job->triangles[corner / 3].unit, job->triangles[corner / 3].area, corner};
        sum = add(sum, faces[i].area);
    }
    bool crowd = count > GROUP_EXACT;
    vec3 normal = unit_or(sum, unit_or(faces[0].area, (vec3){0, 0, 1}));
    if (job->cos_crease <= -1 || (!crowd && all_within(faces, count, normal, job->cos_crease, job->cos_half))) {
        for (size_t i = 0; i < count; i++)
            job->vertex_normals[job->primitive->indices[faces[i].corner]] = normal;
        return;
    }
    job->split[group] = 1;
    if (crowd)
        split_by_cells(job, faces, count);
    else
        split_exact(job, faces, count);
}

static void do_groups(size_t begin, size_t end, void *user)
{
    normals_job *job = user;
    corner_face  on_stack[GROUP_STACK];
    for (size_t g = begin; g < end; g++) {
        size_t count = job->starts[g + 1] - job->starts[g];
        if (count == 0)
            continue;
        corner_face *faces = count <= GROUP_STACK ? on_stack : mem_alloc(count * sizeof *faces);
        if (!faces) {
            job->failed[g] = 1;
            continue;
        }
        do_group(job, g, faces, count);
        if (faces != on_stack)
            mem_free(faces);
    }
}

typedef struct triangles_job {
    const primitive *primitive;
    triangle_face   *triangles;
} triangles_job;

static void do_triangles(size_t begin, size_t end, void *user)
{
    triangles_job   *job = user;
    const primitive *p = job->primitive;
    for (size_t t = begin; t < end; t++) {
        vec3 a = p->positions[p->indices[3 * t]], b = p->positions[p->indices[3 * t + 1]];
        vec3 c = p->positions[p->indices[3 * t + 2]];
        vec3 u = {b.x - a.x, b.y - a.y, b.z - a.z}, v = {c.x - a.x, c.y - a.y, c.z - a.z};
        vec3 area = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
        job->triangles[t] = (triangle_face){unit_or(area, (vec3){0, 0, 0}), area};
    }
}

/* Sorts the corners by position, keeping their order within one. */
static void group_corners(const primitive *p, const uint32_t *ids, uint32_t *starts, uint32_t *corners)
{
    /* Counting one position further on leaves starts[g] at the group's first corner after the filling below. */
    for (uint32_t c = 0; c < p->index_count; c++)
        starts[ids[p->indices[c]] + 2]++;
    for (uint32_t v = 0; v < p->vertex_count; v++)
        starts[v + 2] += starts[v + 1];
    for (uint32_t c = 0; c < p->index_count; c++)
        corners[starts[ids[p->indices[c]] + 1]++] = c;
}

typedef struct splitter {
    normals_job     *job;
    render_vertices *out;
    size_t           normal_capacity, source_capacity;
    uint32_t        *latest; /* per vertex: its newest render vertex, or UINT32_MAX */
    uint32_t        *older;  /* per render vertex: the one before it of the same vertex */
    size_t           older_capacity;
} splitter;

static bool same_normal(vec3 a, vec3 b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

/* The render vertex of `vertex` with this normal, made when there is none; UINT32_MAX when memory is gone. */
static uint32_t render_vertex(splitter *s, uint32_t vertex, vec3 normal)
{
    render_vertices *out = s->out;
    uint32_t         r = s->latest[vertex];
    if (r == UINT32_MAX) {
        s->latest[vertex] = vertex;
        out->normals[vertex] = normal;
        s->older[vertex] = UINT32_MAX;
        return vertex;
    }
    for (int tries = 0; r != UINT32_MAX && tries < GROUP_STACK; tries++, r = s->older[r])
        if (same_normal(out->normals[r], normal))
            return r;
    size_t count = (size_t)out->vertex_count + 1;
    if (count >= UINT32_MAX || !mem_grow((void **)&out->normals, &s->normal_capacity, count, sizeof *out->normals) ||
        !mem_grow((void **)&out->source, &s->source_capacity, count, sizeof *out->source) ||
        !mem_grow((void **)&s->older, &s->older_capacity, count, sizeof *s->older))
        return UINT32_MAX;
    r = out->vertex_count++;
    out->normals[r] = normal;
    out->source[r] = vertex;
    s->older[r] = s->latest[vertex];
    s->latest[vertex] = r;
    return r;
}

static bool split_groups(splitter *s)
{
    normals_job     *job = s->job;
    const primitive *p = job->primitive;
    for (size_t g = 0; g < p->vertex_count; g++) {
        if (!job->split[g])
            continue;
        for (uint32_t i = job->starts[g]; i < job->starts[g + 1]; i++) {
            uint32_t corner = job->corners[i];
            uint32_t r = render_vertex(s, p->indices[corner], job->corner_normals[corner]);
            if (r == UINT32_MAX)
                return false;
            s->out->indices[corner] = r;
        }
    }
    return true;
}

static bool make_splits(render_vertices *out, normals_job *job)
{
    const primitive *p = job->primitive;
    if (!memchr(job->split, 1, p->vertex_count))
        return true;
    splitter s = {.job = job,
                  .out = out,
                  .normal_capacity = p->vertex_count,
                  .source_capacity = p->vertex_count,
                  .older_capacity = p->vertex_count};
    out->source = mem_alloc((size_t)p->vertex_count * sizeof *out->source);
    out->indices = mem_copy(p->indices, (size_t)p->index_count * sizeof *out->indices);
    s.latest = mem_alloc((size_t)p->vertex_count * sizeof *s.latest);
    s.older = mem_alloc((size_t)p->vertex_count * sizeof *s.older);
    bool good = out->source && out->indices && s.latest && s.older;
    if (good) {
        memset(s.latest, 0xFF, (size_t)p->vertex_count * sizeof *s.latest);
        for (uint32_t v = 0; v < p->vertex_count; v++)
            out->source[v] = v;
        good = split_groups(&s);
    }
    mem_free(s.latest);
    mem_free(s.older);
    return good;
}

lmn_status corner_groups_make(corner_groups *out, const primitive *p, lmn_error *error)
{
    out->ids = mesh_position_ids(p);
    out->starts = mem_calloc((size_t)p->vertex_count + 2, sizeof *out->starts);
    out->corners = mem_alloc((size_t)p->index_count * sizeof *out->corners);
    if (!out->ids || !out->starts || !out->corners) {
        corner_groups_release(out);
        return error_memory(error);
    }
    group_corners(p, out->ids, out->starts, out->corners);
    return LMN_OK;
}

void corner_groups_release(corner_groups *g)
{
    mem_free(g->ids);
    mem_free(g->starts);
    mem_free(g->corners);
    memset(g, 0, sizeof *g);
}

bool corner_groups_hold(const corner_groups *g, const primitive *p)
{
    bool holds = true;
    for (uint32_t i = 0; i < p->vertex_count && holds; i++) {
        vec3 a = p->positions[i], b = p->positions[g->ids[i]];
        holds = a.x == b.x && a.y == b.y && a.z == b.z;
    }
    return holds;
}

static bool make_normals(render_vertices *out, normals_job *job, triangle_face *triangles)
{
    const primitive *p = job->primitive;
    triangles_job    faces = {p, triangles};
    threads_for(p->index_count / 3, GROUPS_PER_THREAD, do_triangles, &faces);
    job->triangles = triangles;
    threads_for(p->vertex_count, GROUPS_PER_THREAD, do_groups, job);
    return !memchr(job->failed, 1, p->vertex_count) && make_splits(out, job);
}

lmn_status mesh_make_normals(render_vertices *out, const primitive *p, double crease_angle, lmn_error *error)
{
    corner_groups groups;
    *out = (render_vertices){.vertex_count = p->vertex_count, .index_count = p->index_count};
    lmn_status status = corner_groups_make(&groups, p, error);
    if (status == LMN_OK)
        status = mesh_make_normals_in(out, p, &groups, crease_angle, error);
    corner_groups_release(&groups);
    return status;
}

lmn_status mesh_make_normals_in(render_vertices *out, const primitive *p, const corner_groups *groups,
                                double crease_angle, lmn_error *error)
{
    *out = (render_vertices){.vertex_count = p->vertex_count, .index_count = p->index_count};
    size_t         vertices = p->vertex_count, corner_count = p->index_count;
    triangle_face *triangles = mem_alloc(corner_count / 3 * sizeof *triangles);
    normals_job    job = {.primitive = p, .starts = groups->starts, .corners = groups->corners};
    /* A hair wider than asked, so that faces exactly at the angle are joined whatever the rounding. */
    job.cos_crease = crease_angle >= 3.14159 ? -1.0f : (float)cos(crease_angle) - 1e-6f;
    job.cos_half = (float)cos(crease_angle / 2);
    job.corner_normals = mem_alloc(corner_count * sizeof *job.corner_normals);
    job.split = mem_calloc(vertices, 1);
    job.failed = mem_calloc(vertices, 1);
    job.vertex_normals = out->normals = mem_calloc(vertices, sizeof *out->normals);
    bool good = triangles && job.corner_normals && job.split && job.failed && out->normals &&
                make_normals(out, &job, triangles);
    mem_free(triangles);
    mem_free(job.corner_normals);
    mem_free(job.split);
    mem_free(job.failed);
    if (good)
        return LMN_OK;
    render_vertices_release(out);
    return error_memory(error);
}

void render_vertices_release(render_vertices *v)
{
    mem_free(v->source);
    mem_free(v->normals);
    mem_free(v->indices);
    memset(v, 0, sizeof *v);
}
