/* Strokes of solids against OpenSCAD's exact meshes: dense samples along the edges of the mesh that are lines in a
 * view, with rays for what hides them, against the lines that were found without any mesh, and the other way round.
 * LIMNER_DATA names the folder of the corpora (default: shared/data beside or above the source). Arguments: names of
 * files, or parts of them; without any all are compared. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <time.h>

#include "check.h"
#include "limner/limner.h"
#include "pose/pose.h"
#include "stroke/stroke_private.h"
#include "trace.h"

enum { PAGE = 1024, CELLS = 512 };
static const double step = 0.5, near_by = 1.0; /* of samples; so far apart two lines are one: units of the page */
static const double pi = 3.14159265358979323846;

/* --- the exact mesh ------------------------------------------------------------------------------------- */

typedef struct exact_edge {
    uint32_t a, b; /* vertices, ascending */
    uint32_t face;
} exact_edge;

typedef struct exact_mesh {
    dvec       *points;
    uint32_t   *faces;
    uint32_t    point_count, face_count;
    dvec       *normals;
    double     *heights; /* per face: its least */
    exact_edge *edges;   /* three a face, sorted */
    double      extent;
    dvec        low, high;
    tracer     *rays;
} exact_mesh;

typedef struct corner {
    float    p[3];
    uint32_t at;
} corner;

static int compare_corners(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    for (int k = 0; k < 3; k++)
        if (p->p[k] != q->p[k])
            return p->p[k] < q->p[k] ? -1 : 1;
    return 0;
}

static int compare_edges(const void *a, const void *b)
{
    const exact_edge *p = a, *q = b;
    if (p->a != q->a)
        return p->a < q->a ? -1 : 1;
    if (p->b != q->b)
        return p->b < q->b ? -1 : 1;
    return (p->face > q->face) - (p->face < q->face);
}

static bool read_stl(exact_mesh *m, const char *path)
{
    uint8_t  head[84], triangle[50];
    uint32_t count = 0;
    FILE    *file = fopen(path, "rb");
    bool     ok = file && fread(head, 1, sizeof head, file) == sizeof head;
    memset(m, 0, sizeof *m);
    if (ok)
        memcpy(&count, head + 80, sizeof count);
    corner *corners = check_alloc(3 * (size_t)count + 1, sizeof *corners);
    for (uint32_t i = 0; i < count && ok; i++) {
        ok = fread(triangle, 1, sizeof triangle, file) == sizeof triangle;
        for (uint32_t k = 0; k < 3; k++) {
            memcpy(corners[3 * i + k].p, triangle + 12 + 12 * k, 12);
            for (int n = 0; n < 3; n++)
                corners[3 * i + k].p[n] += 0.0f; /* no −0 */
            corners[3 * i + k].at = 3 * i + k;
        }
    }
    if (file)
        fclose(file);
    m->face_count = count;
    m->points = check_alloc(3 * (size_t)count + 1, sizeof *m->points);
    m->faces = check_alloc(3 * (size_t)count + 1, sizeof *m->faces);
    qsort(corners, 3 * (size_t)count, sizeof *corners, compare_corners);
    m->low = dvec_of(INFINITY, INFINITY, INFINITY);
    m->high = dvec_of(-INFINITY, -INFINITY, -INFINITY);
    for (uint32_t i = 0; i < 3 * count; i++) {
        if (i == 0 || compare_corners(&corners[i], &corners[i - 1]) != 0) {
            dvec p = m->points[m->point_count++] = dvec_from(corners[i].p);
            m->low = dvec_of(fmin(m->low.x, p.x), fmin(m->low.y, p.y), fmin(m->low.z, p.z));
            m->high = dvec_of(fmax(m->high.x, p.x), fmax(m->high.y, p.y), fmax(m->high.z, p.z));
        }
        m->faces[corners[i].at] = m->point_count - 1;
    }
    free(corners);
    m->extent = dvec_length(dvec_sub(m->high, m->low));
    return ok && count > 0;
}

static void sort_exact(exact_mesh *m)
{
    m->normals = check_alloc(m->face_count, sizeof *m->normals);
    m->heights = check_alloc(m->face_count, sizeof *m->heights);
    m->edges = check_alloc(3 * (size_t)m->face_count, sizeof *m->edges);
    trace_triangle *triangles = check_alloc(m->face_count, sizeof *triangles);
    for (uint32_t f = 0; f < m->face_count; f++) {
        const uint32_t *v = &m->faces[3 * f];
        dvec            p[3] = {m->points[v[0]], m->points[v[1]], m->points[v[2]]},
             n = dvec_cross(dvec_sub(p[1], p[0]), dvec_sub(p[2], p[0]));
        double longest = 0;
        m->normals[f] = dvec_unit(n);
        triangles[f].flat = m->normals[f];
        for (int k = 0; k < 3; k++) {
            uint32_t a = v[k], b = v[(k + 1) % 3];
            longest = fmax(longest, dvec_length(dvec_sub(p[(k + 1) % 3], p[k])));
            m->edges[3 * f + (uint32_t)k] = (exact_edge){a < b ? a : b, a < b ? b : a, f};
            triangles[f].p[k] = p[k];
            triangles[f].n[k] = m->normals[f];
        }
        m->heights[f] = longest > 0 ? dvec_length(n) / longest : 0;
    }
    qsort(m->edges, 3 * (size_t)m->face_count, sizeof *m->edges, compare_edges);
    m->rays = tracer_of_triangles(triangles, m->face_count);
}

static void exact_release(exact_mesh *m)
{
    tracer_destroy(m->rays);
    free(m->points);
    free(m->faces);
    free(m->normals);
    free(m->heights);
    free(m->edges);
}

/* --- the view ------------------------------------------------------------------------------------------- */

typedef struct eye {
    dvec          at, back, right, up;
    bool          flat; /* parallel */
    double        half;
    stroke_camera camera;
} eye;

static eye eye_of(const exact_mesh *m, dvec direction, bool flat)
{
    eye  e = {.back = dvec_unit(direction), .flat = flat};
    dvec middle = dvec_mix(m->low, m->high, 0.5);
    e.right = dvec_unit(dvec_cross(dvec_of(0.01, 0, 1), e.back));
    e.up = dvec_cross(e.back, e.right);
    double distance = m->extent * 2.2;
    e.half = flat ? m->extent * 0.55 : 0.27;
    e.at = dvec_add(middle, dvec_scale(e.back, distance));
    stroke_camera *c = &e.camera;
    memset(c, 0, sizeof *c);
    c->view = mat4_identity();
    const dvec rows[3] = {e.right, e.up, e.back};
    for (int i = 0; i < 3; i++) {
        c->view.m[i] = rows[i].x;
        c->view.m[4 + i] = rows[i].y;
        c->view.m[8 + i] = rows[i].z;
        c->view.m[12 + i] = -dvec_dot(rows[i], e.at);
    }
    c->near = m->extent * 0.01;
    c->orthographic = flat;
    c->width = c->height = PAGE;
    double near = c->near, far = m->extent * 10;
    c->projection.m[0] = c->projection.m[5] = 1 / e.half;
    if (flat) {
        c->projection.m[10] = -2 / (far - near);
        c->projection.m[14] = -(far + near) / (far - near);
        c->projection.m[15] = 1;
    } else {
        c->projection.m[10] = -(far + near) / (far - near);
        c->projection.m[11] = -1;
        c->projection.m[14] = -2 * far * near / (far - near);
    }
    return e;
}

static void on_page(const eye *e, dvec p, double out[2])
{
    dvec   r = dvec_sub(p, e->at);
    double depth = e->flat ? 1 : -dvec_dot(r, e->back);
    out[0] = PAGE * (0.5 + 0.5 * dvec_dot(r, e->right) / (depth * e->half));
    out[1] = PAGE * (0.5 - 0.5 * dvec_dot(r, e->up) / (depth * e->half));
}

/* Unit, from a position to the eye. */
static dvec to_eye(const eye *e, dvec p)
{
    return e->flat ? e->back : dvec_unit(dvec_sub(e->at, p));
}

/* --- samples -------------------------------------------------------------------------------------------- */

typedef struct sample {
    float    x, y;
    bool     seen, must; /* must be there: else it may */
    uint32_t next;       /* in the same cell, + 1 */
} sample;

typedef struct samples {
    sample  *items;
    size_t   count, capacity;
    uint32_t cells[CELLS * CELLS]; /* + 1 */
} samples;

static int cell_at(double x)
{
    double at = x * CELLS / PAGE;
    return at > 0 ? at < CELLS - 1 ? (int)at : CELLS - 1 : 0;
}

static void put_sample(samples *s, double x, double y, bool seen, bool must)
{
    if (s->count == s->capacity) {
        s->capacity = 2 * s->capacity + 1024;
        s->items = realloc(s->items, s->capacity * sizeof *s->items);
        if (!s->items)
            exit(1);
    }
    uint32_t *cell = &s->cells[cell_at(y) * CELLS + cell_at(x)];
    s->items[s->count] = (sample){(float)x, (float)y, seen, must, *cell};
    *cell = (uint32_t)++s->count;
}

/* Is there one near by, seen if it has to be? */
static bool has_sample(const samples *s, double x, double y, bool seen)
{
    for (int row = cell_at(y - near_by); row <= cell_at(y + near_by); row++)
        for (int column = cell_at(x - near_by); column <= cell_at(x + near_by); column++)
            for (uint32_t i = s->cells[row * CELLS + column]; i; i = s->items[i - 1].next) {
                const sample *p = &s->items[i - 1];
                if ((p->seen || !seen) && hypot((double)p->x - x, (double)p->y - y) <= near_by)
                    return true;
            }
    return false;
}

/* Is nothing in front of a position, as far as what is nearer than `skin` does not count? */
static bool is_seen(const exact_mesh *m, const eye *e, dvec p, double skin)
{
    uint32_t last = UINT32_MAX;
    return !tracer_blocked(m->rays, p, to_eye(e, p), skin, 4 * m->extent, &last);
}

/* What an edge is in this view: 0 never a line, 1 it may be one, 2 it must be one. */
static int judge_edge(const exact_mesh *m, const eye *e, const exact_edge *group, size_t count)
{
    if (count != 2)
        return 1;
    dvec   n = m->normals[group[0].face], o = m->normals[group[1].face], p = m->points[group[0].a];
    double turn = acos(fmin(fmax(dvec_dot(n, o), -1), 1)) * 180 / pi,
           least = fmin(m->heights[group[0].face], m->heights[group[1].face]);
    dvec   way = to_eye(e, p);
    double a = dvec_dot(n, way), b = dvec_dot(o, way);
    bool   contour = (a > 0) != (b > 0) && fmin(fabs(a), fabs(b)) > 0.01;
    if (least < 2e-3 * m->extent || turn < 1)
        return turn < 0.01 ? 0 : 1;
    return contour || turn > 60 ? 2 : 1;
}

static void sample_truth(samples *out, const exact_mesh *m, const eye *e)
{
    size_t count = 3 * (size_t)m->face_count;
    for (size_t i = 0, end; i < count; i = end) {
        for (end = i; end < count && m->edges[end].a == m->edges[i].a && m->edges[end].b == m->edges[i].b;)
            end++;
        int what = judge_edge(m, e, &m->edges[i], end - i);
        if (!what)
            continue;
        dvec   p = m->points[m->edges[i].a], q = m->points[m->edges[i].b];
        double a[2], b[2];
        on_page(e, p, a);
        on_page(e, q, b);
        size_t parts = (size_t)fmax(ceil(hypot(b[0] - a[0], b[1] - a[1]) / step), 1);
        for (size_t k = 0; k < parts; k++) {
            dvec   at = dvec_mix(p, q, ((double)k + 0.5) / (double)parts);
            double page[2];
            on_page(e, at, page);
            bool seen = is_seen(m, e, at, 2e-4 * m->extent);
            /* What is hidden but for rounding may be seen, and the other way round. */
            bool sure = seen == is_seen(m, e,
                                        dvec_add(at, dvec_scale(dvec_add(m->normals[m->edges[i].face],
                                                                         m->normals[m->edges[end - 1].face]),
                                                                5e-4 * m->extent)),
                                        2e-4 * m->extent);
            put_sample(out, page[0], page[1], seen || !sure, what == 2 && sure);
        }
    }
}

/* Lines as they were found, before anything is joined, simplified or left out. */
static bool sample_lines(samples *out, const stroke_view *v, const stroke_options *options)
{
    view_lines lines;
    visibility seen;
    lmn_error  error = {0};
    if (lines_collect(&lines, v, options, NULL, NULL, NULL, NULL, &error) != LMN_OK)
        return false;
    bool good = visibility_find(&seen, v, lines.segments, lines.count, NULL, NULL, &error) == LMN_OK;
    for (size_t i = 0; i < lines.count && good; i++) {
        const window_segment *s = &lines.segments[i];
        double                ax = s->a.x / v->units + PAGE / 2.0, ay = s->a.y / v->units + PAGE / 2.0,
               bx = s->b.x / v->units + PAGE / 2.0, by = s->b.y / v->units + PAGE / 2.0;
        size_t parts = (size_t)fmax(ceil(hypot(bx - ax, by - ay) / step), 1);
        for (size_t k = 0; k < parts; k++) {
            double   t = ((double)k + 0.5) / (double)parts;
            uint32_t span = seen.starts[i];
            while (span + 1 < seen.starts[i + 1] && (double)seen.spans[span + 1].from <= t)
                span++;
            put_sample(out, ax + t * (bx - ax), ay + t * (by - ay), seen.spans[span].count == 0, true);
        }
    }
    if (good)
        visibility_release(&seen);
    lines_release(&lines);
    return good;
}

/* Per cent of the samples of `of` that have none of `among` near by; of those that are seen, or all. */
static double share_without(const samples *of, const samples *among, bool seen, const char *name, const char *what)
{
    size_t all = 0, without = 0;
    bool   told = getenv("LIMNER_SHOW") == NULL;
    for (size_t i = 0; i < of->count; i++) {
        const sample *p = &of->items[i];
        if (!p->must || (seen && !p->seen))
            continue;
        all++;
        bool here = has_sample(among, (double)p->x, (double)p->y, seen);
        without += !here;
        if (!here && !told)
            printf("    %s %s at %.1f %.1f\n", name, what, (double)p->x, (double)p->y);
    }
    return all ? 100.0 * (double)without / (double)all : 0;
}

/* --- files ---------------------------------------------------------------------------------------------- */

static double cpu_seconds(void)
{
    struct timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

typedef struct total {
    double   worst_missing, worst_false, seconds;
    int      files, over, other;
    uint64_t samples, unseen; /* of stroke_verify; those that it does not see as they were found */
} total;

/* Per cent of the operands' corners on lines that are no corners of the exact mesh: other fonts, other divisions of
 * curves, other solids. */
static double strange_corners(const exact_mesh *m, const stroke_scene *scene)
{
    size_t all = 0, strange = 0;
    for (size_t i = 0; i < scene->item_count; i++) {
        const edge_mesh *e = &scene->meshes[scene->items[i].mesh];
        uint32_t         own = 0;
        for (uint32_t f = 0; f < e->face_count; f++)
            for (int k = 0; k < 3; k++)
                own = e->faces[f][k] >= own ? e->faces[f][k] + 1 : own;
        for (uint32_t k = 0; k < e->edge_count; k++) {
            if (!(e->edges[k].flags & EDGE_CREASE) || e->edges[k].vertex[0] >= own)
                continue;
            double3 p = item_position(&scene->items[i], e->positions[e->edges[k].vertex[0]]);
            double  least = INFINITY;
            for (uint32_t v = 0; v < m->point_count; v++)
                least = fmin(least, dvec_length(dvec_sub(m->points[v], dvec_of(p.x, p.y, p.z))));
            all++;
            strange += least > 2e-4 * m->extent;
        }
    }
    return all ? 100.0 * (double)strange / (double)all : 0;
}

static void compare_view(const char *name, const exact_mesh *m, const stroke_scene *scene, dvec direction, bool flat,
                         double made, double strange, total *sum)
{
    eye            e = eye_of(m, direction, flat);
    stroke_options options = STROKE_OPTIONS_INIT;
    options.hidden = true;
    options.materials = false; /* meshes of STL files have no colours */
    options.shortest = options.crowd = 0;
    lmn_error    error = {0};
    stroke_view *v;
    stroke_set   set;
    stroke_check check = {0};
    double       begun = cpu_seconds();
    bool         good = stroke_view_create(&v, scene, &e.camera, NULL, NULL, &error) == LMN_OK &&
                stroke_find(&set, v, &options, NULL, NULL, NULL, &error) == LMN_OK;
    double took = cpu_seconds() - begun;
    if (!check_that("strokes", good, "%s: strokes", name))
        return;
    good = stroke_verify(&check, &set, v, 2, NULL, NULL, &error) == LMN_OK;
    samples *truth = check_alloc(1, sizeof *truth), *found = check_alloc(1, sizeof *found);
    memset(truth, 0, sizeof *truth);
    memset(found, 0, sizeof *found);
    sample_truth(truth, m, &e);
    good = good && sample_lines(found, v, &options);
    double missing = share_without(truth, found, true, name, "missing"),
           wrong = share_without(found, truth, true, name, "false"),
           missing_all = share_without(truth, found, false, name, "hidden missing"),
           wrong_all = share_without(found, truth, false, name, "hidden false");
    printf("%-40s %s  missing %6.3f %%  false %6.3f %%  with hidden ones %6.3f %% %6.3f %%  verify %llu of %llu  lines "
           "%.3f s, view %.3f s%s\n",
           name, flat ? "parallel   " : "perspective", missing, wrong, missing_all, wrong_all,
           (unsigned long long)check.wrong, (unsigned long long)check.samples, made, took,
           strange >= 1 ? "  another solid" : "");
    sum->worst_missing = fmax(sum->worst_missing, strange < 1 ? missing : 0);
    sum->worst_false = fmax(sum->worst_false, strange < 1 ? wrong : 0);
    sum->over += strange < 1 && (missing > 0.1 || wrong > 0.1);
    sum->other += strange >= 1;
    sum->samples += check.samples;
    sum->unseen += check.wrong;
    check_that("strokes", check.wrong == 0, "%s: %llu of %llu samples are not as rays see them", name,
               (unsigned long long)check.wrong, (unsigned long long)check.samples);
    sum->seconds += made + took;
    sum->files++;
    free(truth->items);
    free(found->items);
    free(truth);
    free(found);
    stroke_set_release(&set);
    stroke_view_destroy(&v);
    (void)good;
}

static void compare_file(const char *folder, const char *name, const char *stl, total *sum)
{
    char          path[1024];
    exact_mesh    m;
    lmn_error     error = {0};
    lmn_scene    *scene;
    pose          at_rest;
    lmn_load_desc load = LMN_LOAD_DESC_INIT;
    snprintf(path, sizeof path, "%s/%s", folder, stl);
    if (!read_stl(&m, path))
        return;
    sort_exact(&m);
    snprintf(path, sizeof path, "%s/%s", folder, name);
    stroke_scene strokes;
    bool         good = lmn_scene_create(&scene, &error) == LMN_OK &&
                lmn_scene_add_file(scene, path, &load, &error) == LMN_OK &&
                pose_create(&at_rest, scene, &(moment){.seconds = 0}, &error) == LMN_OK;
    double begun = cpu_seconds();
    good = good && stroke_scene_create(&strokes, &at_rest, NULL, 40 * pi / 180, NULL, NULL, &error) == LMN_OK;
    double made = cpu_seconds() - begun;
    if (check_that("strokes", good, "%s: %s", name, good ? "read" : error.message)) {
        double strange = strange_corners(&m, &strokes);
        compare_view(name, &m, &strokes, dvec_of(0.62, -1, 0.53), true, made, strange, sum);
        compare_view(name, &m, &strokes, dvec_of(-0.47, 0.71, 1.03), false, made, strange, sum);
        stroke_scene_release(&strokes);
        pose_release(&at_rest);
    }
    lmn_scene_destroy(&scene);
    exact_release(&m);
}

static bool find_corpus(char *folder, size_t size)
{
    static const char *const positions[] = {"../shared/data", "../../shared/data", "../../../shared/data"};
    const char              *given = getenv("LIMNER_DATA");
    struct stat              unused;
    for (int k = 0; k < 3; k++) {
        if (given)
            snprintf(folder, size, "%s/csg", given);
        else
            snprintf(folder, size, "%s/../%s/csg", LIMNER_SOURCE, positions[k]);
        if (stat(folder, &unused) == 0)
            return true;
    }
    return false;
}

int main(int argc, char **argv)
{
    char folder[512], path[640];
    if (!find_corpus(folder, sizeof folder)) {
        check_note("there is no corpus of solids here: nothing compared");
        return 0;
    }
    snprintf(path, sizeof path, "%s/ref/reference.json", folder);
    json_t     *all = json_load_file(path, 0, NULL), *entry;
    const char *name;
    total       sum = {0};
    json_object_foreach(all, name, entry)
    {
        const char *stl = json_string_value(json_object_get(entry, "stl"));
        bool        wanted = argc < 2;
        for (int i = 1; i < argc; i++)
            wanted = wanted || strstr(name, argv[i]);
        if (stl && wanted)
            compare_file(folder, name, stl, &sum);
    }
    json_decref(all);
    printf("%d views, %d of another solid, %d over the limit, worst missing %.3f %%, worst false %.3f %%, verify %llu "
           "of %llu, "
           "%.2f CPU s\n",
           sum.files, sum.other, sum.over, sum.worst_missing, sum.worst_false, (unsigned long long)sum.unseen,
           (unsigned long long)sum.samples, sum.seconds);
    return sum.over || sum.unseen ? 1 : 0;
}
