#include "csg_truth.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

static const double pi = 3.14159265358979323846;

/* Fractions of the extent: crossings in one plane are one event up to the first; others that are closer than the
 * second may have either order in floats; twice the same edge of one leaf. */
static const double coplanar_fraction = 1e-6, close_fraction = 1e-5, twice_fraction = 1e-10;

enum { CROSSINGS_MAX = 1024 };

/* --- trees ---------------------------------------------------------------------------------------------- */

int csg_add(csg *c, int parent, csg_kind kind)
{
    csg_node *grown = check_alloc((size_t)c->count + 1, sizeof *grown);
    if (c->count)
        memcpy(grown, c->nodes, (size_t)c->count * sizeof *grown);
    free(c->nodes);
    c->nodes = grown;
    csg_node *n = &grown[c->count];
    n->kind = kind;
    n->parent = parent;
    for (int k = 0; k < 16; k++)
        n->matrix[k] = k % 5 == 0;
    return c->count++;
}

void csg_release(csg *c)
{
    for (int i = 0; i < c->count; i++) {
        free(c->nodes[i].mesh.points);
        free(c->nodes[i].mesh.faces);
    }
    free(c->nodes);
    *c = (csg){0};
}

int csg_leaf_count(const csg *c)
{
    int count = 0;
    for (int i = 0; i < c->count; i++)
        count += c->nodes[i].kind == CSG_LEAF;
    return count;
}

int csg_copy(csg *c, int parent, const csg *from, int node)
{
    csg_node  source = from->nodes[node];
    int       own = csg_add(c, parent, source.kind);
    csg_node *n = &c->nodes[own];
    memcpy(n->matrix, source.matrix, sizeof n->matrix);
    n->has_colour = source.has_colour;
    memcpy(n->colour, source.colour, sizeof n->colour);
    if (source.kind == CSG_LEAF) {
        n->mesh = source.mesh;
        n->mesh.points = check_alloc(source.mesh.point_count, sizeof *n->mesh.points);
        n->mesh.faces = check_alloc(source.mesh.face_count, 3 * sizeof *n->mesh.faces);
        memcpy(n->mesh.points, source.mesh.points, source.mesh.point_count * sizeof *n->mesh.points);
        memcpy(n->mesh.faces, source.mesh.faces, source.mesh.face_count * 3 * sizeof *n->mesh.faces);
    }
    int count = from->count; /* `from` may be the same tree */
    for (int i = node + 1; i < count; i++)
        if (from->nodes[i].parent == node)
            csg_copy(c, own, from, i);
    return own;
}

/* OpenSCAD lists corners clockwise seen from outside. */
static void write_leaf(FILE *file, const csg_mesh *m)
{
    fprintf(file, "polyhedron(points = [");
    for (size_t i = 0; i < m->point_count; i++)
        fprintf(file, "%s[%.17g, %.17g, %.17g]", i ? ", " : "", m->points[i].x, m->points[i].y, m->points[i].z);
    fprintf(file, "], faces = [");
    for (size_t i = 0; i < m->face_count; i++)
        fprintf(file, "%s[%u, %u, %u]", i ? ", " : "", m->faces[3 * i], m->faces[3 * i + 2], m->faces[3 * i + 1]);
    fprintf(file, "], convexity = 10);\n");
}

static bool is_identity(const double m[16])
{
    for (int k = 0; k < 16; k++)
        if (fabs(m[k] - (k % 5 == 0)) > 0)
            return false;
    return true;
}

static void write_node(FILE *file, const csg *c, int node, int depth)
{
    static const char *const names[] = {"", "union() {", "intersection() {", "difference() {"};
    const csg_node          *n = &c->nodes[node];
    bool                     placed = !is_identity(n->matrix);
    fprintf(file, "%*s", 2 * depth, "");
    if (placed) {
        fprintf(file, "multmatrix([");
        for (int row = 0; row < 4; row++)
            fprintf(file, "%s[%.17g, %.17g, %.17g, %.17g]", row ? ", " : "", n->matrix[row], n->matrix[4 + row],
                    n->matrix[8 + row], n->matrix[12 + row]);
        fprintf(file, "]) {\n%*s", 2 * depth, "");
    }
    if (n->has_colour)
        fprintf(file, "color([%.17g, %.17g, %.17g, 1]) {\n%*s", n->colour[0] / 255.0, n->colour[1] / 255.0,
                n->colour[2] / 255.0, 2 * depth, "");
    if (n->kind == CSG_LEAF) {
        write_leaf(file, &n->mesh);
    } else {
        fprintf(file, "%s\n", names[n->kind]);
        for (int i = node + 1; i < c->count; i++)
            if (c->nodes[i].parent == node)
                write_node(file, c, i, depth + 1);
        fprintf(file, "%*s}\n", 2 * depth, "");
    }
    for (int k = 0; k < n->has_colour + placed; k++)
        fprintf(file, "%*s}\n", 2 * depth, "");
}

bool csg_write(const csg *c, const char *path)
{
    FILE *file = fopen(path, "w");
    if (!file)
        return check_that("files", false, "%s cannot be written", path);
    if (c->count)
        write_node(file, c, 0, 0);
    return fclose(file) == 0;
}

/* --- leaves in the scene's axes ------------------------------------------------------------------------- */

typedef struct leaf {
    int     node;
    bool    taken_away; /* by an odd number of differences */
    uint8_t colour[3];
    size_t  first, count; /* triangles */
} leaf;

struct csg_rays {
    csg    *tree; /* kinds and parents only */
    leaf   *leaves;
    size_t  leaf_count;
    tracer *tracer;
    dvec    low, high;
    double  extent;
    int    *order; /* of a node among its siblings */
    int    *trues; /* children of a node that hold now; of a difference without its first */
    int    *children;
    bool   *first, *value;
};

static void multiply(const double a[16], const double b[16], double out[16])
{
    double m[16];
    for (int c = 0; c < 4; c++)
        for (int r = 0; r < 4; r++) {
            m[4 * c + r] = 0;
            for (int k = 0; k < 4; k++)
                m[4 * c + r] += a[4 * k + r] * b[4 * c + k];
        }
    memcpy(out, m, sizeof m);
}

/* Rows of the inverse's transpose, but for a factor: what turns normals. */
static dvec turn_normal(const double m[16], dvec n)
{
    dvec   x = {m[0], m[1], m[2]}, y = {m[4], m[5], m[6]}, z = {m[8], m[9], m[10]};
    double sign = dvec_dot(x, dvec_cross(y, z)) < 0 ? -1 : 1;
    dvec   sum = dvec_add(dvec_scale(dvec_cross(y, z), n.x),
                          dvec_add(dvec_scale(dvec_cross(z, x), n.y), dvec_scale(dvec_cross(x, y), n.z)));
    return dvec_unit(dvec_scale(sum, sign));
}

static dvec face_area(const csg_mesh *m, size_t face)
{
    dvec a = m->points[m->faces[3 * face]], b = m->points[m->faces[3 * face + 1]],
         c = m->points[m->faces[3 * face + 2]];
    return dvec_cross(dvec_sub(b, a), dvec_sub(c, a));
}

/* At each corner the area-weighted mean of the faces at its point that meet its own face at less than the crease
 * angle. */
static void corner_normals(const csg_mesh *m, double crease, dvec *out)
{
    size_t    corners = 3 * m->face_count;
    uint32_t *starts = check_alloc(m->point_count + 2, sizeof *starts), *faces = check_alloc(corners, sizeof *faces);
    double    limit = cos(crease * pi / 180) - 1e-6;
    for (size_t k = 0; k < corners; k++)
        starts[m->faces[k] + 2]++;
    for (size_t i = 2; i < m->point_count + 2; i++)
        starts[i] += starts[i - 1];
    for (size_t k = 0; k < corners; k++)
        faces[starts[m->faces[k] + 1]++] = (uint32_t)(k / 3);
    for (size_t k = 0; k < corners; k++) {
        dvec own = dvec_unit(face_area(m, k / 3)), sum = {0, 0, 0};
        for (uint32_t i = starts[m->faces[k]]; i < starts[m->faces[k] + 1]; i++) {
            dvec other = face_area(m, faces[i]);
            if (dvec_dot(own, dvec_unit(other)) >= limit)
                sum = dvec_add(sum, other);
        }
        out[k] = dvec_unit(sum);
    }
    free(starts);
    free(faces);
}

static void place_leaf(csg_rays *r, const csg *c, const leaf *l, uint32_t index, double crease, trace_triangle *out)
{
    const csg_mesh *m = &c->nodes[l->node].mesh;
    dvec           *normals = check_alloc(3 * m->face_count, sizeof *normals);
    double          world[16];
    memcpy(world, c->nodes[l->node].matrix, sizeof world);
    for (int n = c->nodes[l->node].parent; n >= 0; n = c->nodes[n].parent)
        multiply(c->nodes[n].matrix, world, world);
    corner_normals(m, crease, normals);
    for (size_t f = 0; f < m->face_count; f++) {
        trace_triangle *t = &out[f];
        t->part = index;
        for (size_t k = 0; k < 3; k++) {
            t->p[k] = dmat_apply(world, m->points[m->faces[3 * f + k]], 1, NULL);
            t->n[k] = turn_normal(world, normals[3 * f + k]);
            r->low = dvec_of(fmin(r->low.x, t->p[k].x), fmin(r->low.y, t->p[k].y), fmin(r->low.z, t->p[k].z));
            r->high = dvec_of(fmax(r->high.x, t->p[k].x), fmax(r->high.y, t->p[k].y), fmax(r->high.z, t->p[k].z));
        }
        t->flat = turn_normal(world, dvec_unit(face_area(m, f)));
    }
    free(normals);
}

/* The outermost colour decides. */
static void inherit(const csg *c, leaf *l, const int *order)
{
    memset(l->colour, 255, sizeof l->colour);
    for (int n = l->node; n >= 0; n = c->nodes[n].parent) {
        int parent = c->nodes[n].parent;
        if (c->nodes[n].has_colour)
            memcpy(l->colour, c->nodes[n].colour, sizeof l->colour);
        if (parent >= 0 && c->nodes[parent].kind == CSG_DIFFERENCE && order[n] > 0)
            l->taken_away = !l->taken_away;
    }
}

static void collect_leaves(const csg *c, int node, csg_rays *r)
{
    if (c->nodes[node].kind == CSG_LEAF)
        r->leaves[r->leaf_count++].node = node;
    for (int i = node + 1; i < c->count; i++)
        if (c->nodes[i].parent == node)
            collect_leaves(c, i, r);
}

/* The value of every node when the ray is in no leaf: an intersection of nothing is nothing, too. */
static void prepare_values(csg_rays *r)
{
    size_t count = (size_t)r->tree->count;
    r->trues = check_alloc(count, sizeof *r->trues);
    r->first = check_alloc(count, sizeof *r->first);
    r->value = check_alloc(count, sizeof *r->value);
}

csg_rays *csg_rays_create(const csg *c, double crease)
{
    csg_rays *r = check_alloc(1, sizeof *r);
    size_t    count = (size_t)c->count, triangles = 0;
    r->tree = check_alloc(1, sizeof *r->tree);
    r->order = check_alloc(count, sizeof *r->order);
    r->children = check_alloc(count, sizeof *r->children);
    r->leaves = check_alloc(count, sizeof *r->leaves);
    r->low = dvec_of(INFINITY, INFINITY, INFINITY);
    r->high = dvec_of(-INFINITY, -INFINITY, -INFINITY);
    for (int i = 0; i < c->count; i++) {
        csg_add(r->tree, c->nodes[i].parent, c->nodes[i].kind);
        if (c->nodes[i].parent >= 0)
            r->order[i] = r->children[c->nodes[i].parent]++;
        triangles += c->nodes[i].mesh.face_count;
    }
    if (c->count)
        collect_leaves(c, 0, r);
    trace_triangle *all = check_alloc(triangles, sizeof *all);
    size_t          at = 0;
    for (size_t k = 0; k < r->leaf_count; k++) {
        leaf *l = &r->leaves[k];
        inherit(c, l, r->order);
        place_leaf(r, c, l, (uint32_t)k, crease, all + at);
        l->first = at;
        l->count = c->nodes[l->node].mesh.face_count;
        at += l->count;
    }
    r->extent = dvec_length(dvec_sub(r->high, r->low));
    r->tracer = tracer_of_triangles(all, triangles);
    prepare_values(r);
    return r;
}

void csg_rays_destroy(csg_rays *r)
{
    if (!r)
        return;
    tracer_destroy(r->tracer);
    csg_release(r->tree);
    free(r->tree);
    free(r->leaves);
    free(r->order);
    free(r->children);
    free(r->trues);
    free(r->first);
    free(r->value);
    free(r);
}

double csg_rays_extent(const csg_rays *r)
{
    return r->extent;
}

void csg_rays_box(const csg_rays *r, dvec *low, dvec *high)
{
    *low = r->low;
    *high = r->high;
}

size_t csg_rays_leaves(const csg_rays *r)
{
    return r->leaf_count;
}

const uint8_t *csg_rays_colour(const csg_rays *r, int index)
{
    return r->leaves[index].colour;
}

/* --- the tree along a ray ------------------------------------------------------------------------------- */

static bool holds(const csg_rays *r, int node)
{
    switch (r->tree->nodes[node].kind) {
    case CSG_UNION: return r->trues[node] > 0 || r->first[node];
    case CSG_INTERSECTION: return r->children[node] > 0 && r->trues[node] + r->first[node] == r->children[node];
    case CSG_DIFFERENCE: return r->first[node] && r->trues[node] == 0;
    default: return r->value[node];
    }
}

static void reset(csg_rays *r)
{
    size_t count = (size_t)r->tree->count;
    memset(r->trues, 0, count * sizeof *r->trues);
    memset(r->first, 0, count * sizeof *r->first);
    memset(r->value, 0, count * sizeof *r->value);
}

/* The ray crosses a leaf's surface: what it is in follows up the tree as far as anything changes. */
static void toggle(csg_rays *r, int leaf_index)
{
    int node = r->leaves[leaf_index].node;
    r->value[node] = !r->value[node];
    for (int parent = r->tree->nodes[node].parent; parent >= 0; node = parent, parent = r->tree->nodes[node].parent) {
        if (r->order[node] == 0)
            r->first[parent] = r->value[node];
        else
            r->trues[parent] += r->value[node] ? 1 : -1;
        bool now = holds(r, parent);
        if (now == r->value[parent])
            return;
        r->value[parent] = now;
    }
}

typedef struct crossing {
    trace_hit hit;
    int       leaf, event;
} crossing;

static bool in_one_plane(const csg_rays *r, const trace_triangle *a, const trace_triangle *b)
{
    for (int k = 0; k < 3; k++)
        if (fabs(dvec_dot(a->flat, dvec_sub(b->p[k], a->p[0]))) > coplanar_fraction * r->extent ||
            fabs(dvec_dot(b->flat, dvec_sub(a->p[k], b->p[0]))) > coplanar_fraction * r->extent)
            return false;
    return true;
}

/* An edge between two facets is hit twice. Two crossings of one leaf are the same where their triangles face the
 * same way. */
static bool is_twice(const csg_rays *r, const trace_triangle *f, dvec direction, const crossing *c, size_t count,
                     const trace_hit *hit)
{
    double length = dvec_length(direction);
    for (size_t k = count; k-- > 0 && (hit->t - c[k].hit.t) * length <= twice_fraction * r->extent;)
        if (c[k].leaf == (int)f[hit->triangle].part &&
            (dvec_dot(f[c[k].hit.triangle].flat, direction) < 0) == (dvec_dot(f[hit->triangle].flat, direction) < 0))
            return true;
    return false;
}

/* Gives crossings of one plane the same event; events are numbered by their first crossing. */
static void find_events(const csg_rays *r, const trace_triangle *f, double length, crossing *c, size_t count)
{
    for (size_t k = 0; k < count; k++)
        c[k].event = -1;
    for (size_t k = 0; k < count; k++) {
        if (c[k].event >= 0)
            continue;
        c[k].event = (int)k;
        for (size_t j = k + 1; j < count && (c[j].hit.t - c[k].hit.t) * length <= 100 * coplanar_fraction * r->extent;
             j++)
            if (c[j].event < 0 && c[j].leaf != c[k].leaf &&
                in_one_plane(r, &f[c[k].hit.triangle], &f[c[j].hit.triangle]))
                c[j].event = (int)k;
    }
}

static void toggle_event(csg_rays *r, const crossing *c, size_t count, int event)
{
    for (size_t k = (size_t)event; k < count; k++)
        if (c[k].event == event)
            toggle(r, c[k].leaf);
}

/* Does it matter in which order these two come, the tree being in the state before both? */
static bool order_matters(csg_rays *r, const crossing *c, size_t count, int one, int other)
{
    bool before = r->value[0];
    toggle_event(r, c, count, one);
    bool after_one = r->value[0];
    toggle_event(r, c, count, other);
    bool both = r->value[0];
    toggle_event(r, c, count, one);
    bool after_other = r->value[0];
    toggle_event(r, c, count, other);
    bool one_idle = before == after_one && after_other == both, other_idle = before == after_other && after_one == both;
    bool all_idle = before == after_one && before == after_other && before == both;
    return !(one_idle || other_idle || all_idle);
}

/* When a crossing's turn comes among those of its event: ends of the solid before beginnings; among ends what is
 * kept first, among beginnings what is taken away; then the order of the tree. */
static int turn_of(const csg_rays *r, const crossing *c)
{
    const leaf *l = &r->leaves[c->leaf];
    bool        entered = !r->value[l->node], begins = entered != l->taken_away;
    return ((begins ? 2 : 0) + (entered ? 1 : 0)) * 65536 + c->leaf;
}

/* Goes through the crossings of an event and returns the one at which the solid last changed. Its own crossing goes
 * the way of the solid, for no leaf occurs twice in a tree. */
static const crossing *go_through(csg_rays *r, const crossing *c, size_t count, int event)
{
    const crossing *owner = NULL;
    int             turns[CROSSINGS_MAX];
    for (size_t k = (size_t)event; k < count; k++)
        turns[k] = c[k].event == event ? turn_of(r, &c[k]) : -1;
    for (;;) {
        size_t next = count;
        for (size_t k = (size_t)event; k < count; k++)
            if (turns[k] >= 0 && (next == count || turns[k] < turns[next]))
                next = k;
        if (next == count)
            return owner;
        bool before = r->value[0];
        toggle(r, c[next].leaf);
        owner = r->value[0] != before ? &c[next] : owner;
        turns[next] = -1;
    }
}

static csg_hit hit_of(const trace_triangle *f, const crossing *c, dvec direction, bool entering)
{
    const trace_triangle *t = &f[c->hit.triangle];
    double                u = c->hit.u, v = c->hit.v;
    dvec   n = dvec_add(dvec_scale(t->n[0], 1 - u - v), dvec_add(dvec_scale(t->n[1], u), dvec_scale(t->n[2], v)));
    double sign = (dvec_dot(t->flat, direction) < 0) == entering ? 1 : -1;
    return (csg_hit){.t = c->hit.t,
                     .normal = dvec_scale(dvec_unit(n), sign),
                     .flat = dvec_scale(t->flat, sign),
                     .leaf = c->leaf,
                     .front = entering};
}

/* Crossings of the whole line with their events, sorted. */
static size_t find_crossings(csg_rays *r, dvec origin, dvec direction, crossing out[CROSSINGS_MAX])
{
    trace_hit raw[CROSSINGS_MAX];
    size_t    triangles, count = 0,
                      found = tracer_hits(r->tracer, origin, direction, -INFINITY, INFINITY, raw, CROSSINGS_MAX);
    const trace_triangle *f = tracer_triangles(r->tracer, &triangles);
    if (found > CROSSINGS_MAX)
        check_that("self", false, "%zu crossings on a ray: more than the tests have room for", found);
    for (size_t k = 0; k < found && k < CROSSINGS_MAX; k++)
        if (!is_twice(r, f, direction, out, count, &raw[k]))
            out[count++] = (crossing){.hit = raw[k], .leaf = (int)f[raw[k].triangle].part};
    find_events(r, f, dvec_length(direction), out, count);
    return count;
}

static bool any_close(csg_rays *r, const crossing *c, size_t count, size_t k, double length)
{
    for (size_t j = k + 1; j < count && (c[j].hit.t - c[k].hit.t) * length <= close_fraction * r->extent; j++)
        if (c[j].event == (int)j && order_matters(r, c, count, (int)k, (int)j))
            return true;
    return false;
}

size_t csg_trace(csg_rays *r, dvec origin, dvec direction, csg_hit *out, size_t capacity, csg_passage *passage)
{
    crossing              c[CROSSINGS_MAX];
    size_t                triangles, count = find_crossings(r, origin, direction, c), kept = 0;
    double                length = dvec_length(direction);
    const trace_triangle *f = tracer_triangles(r->tracer, &triangles);
    *passage = (csg_passage){0};
    reset(r);
    for (size_t k = 0; k < count; k++) {
        if (c[k].event != (int)k)
            continue;
        passage->close = passage->close || any_close(r, c, count, k, length);
        bool     before = r->value[0], shared = false;
        uint64_t together = 0; /* in no order */
        for (size_t j = k; j < count; j++)
            if (c[j].event == (int)k) {
                together += ((uint64_t)c[j].leaf + 1) * 0x9E3779B97F4A7C15u;
                shared = shared || j > k;
            }
        passage->crossings = passage->crossings * 0xD1342543DE82EF95u + (together ^ together >> 29);
        const crossing *owner = go_through(r, c, count, (int)k);
        if (r->value[0] == before)
            continue;
        if (kept < capacity) {
            out[kept] = hit_of(f, owner, direction, !before);
            out[kept].coplanar = shared;
        }
        kept++;
    }
    if (kept > capacity)
        check_that("self", false, "%zu surfaces on a ray: more than the tests have room for", kept);
    return kept < capacity ? kept : capacity;
}

bool csg_inside(csg_rays *r, dvec point)
{
    csg_hit     hits[CSG_HITS_MAX];
    csg_passage passage;
    bool        inside = false;
    size_t      count = csg_trace(r, point, dvec_of(0.5377, 0.2113, 0.8163), hits, CSG_HITS_MAX, &passage);
    for (size_t k = 0; k < count && hits[k].t < 0; k++)
        inside = hits[k].front;
    return inside;
}

bool csg_inside_leaf(csg_rays *r, int index, dvec point)
{
    crossing c[CROSSINGS_MAX];
    size_t   count = find_crossings(r, point, dvec_of(0.5377, 0.2113, 0.8163), c);
    bool     inside = false;
    for (size_t k = 0; k < count && c[k].hit.t < 0; k++)
        inside ^= c[k].leaf == index;
    return inside;
}

double csg_volume(csg_rays *r, int axis, int cells)
{
    double low[3] = {r->low.x, r->low.y, r->low.z},
           size[3] = {r->high.x - low[0], r->high.y - low[1], r->high.z - low[2]};
    double length = 0, d[3] = {0, 0, 0};
    int    a = (axis + 1) % 3, b = (axis + 2) % 3;
    d[axis] = 1;
    for (int i = 0; i < cells * cells; i++) {
        csg_hit     hits[CSG_HITS_MAX];
        csg_passage passage;
        double      o[3];
        o[axis] = low[axis] - 1;
        o[a] = low[a] + size[a] * (i % cells + 0.5) / cells;
        o[b] = low[b] + size[b] * (i / cells + 0.5) / cells;
        size_t count = csg_trace(r, dvec_of(o[0], o[1], o[2]), dvec_of(d[0], d[1], d[2]), hits, CSG_HITS_MAX, &passage);
        for (size_t k = 0; k < count; k++)
            length += hits[k].front ? -hits[k].t : hits[k].t;
    }
    return length * size[a] * size[b] / (cells * cells);
}
