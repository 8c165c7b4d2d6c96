/* A guess which way is up. Things are made to stand: their feet, or a base, or the open rim that a bust was cut off at,
 * lie in a plane below their centre; and they are alike to the left and to the right. Features of the kind that Fu et
 * al. 2008 learn from; here they are weighed by hand, and turn nothing that is not clearly better. */
#include "import/up_axis.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"
#include "scene/mesh.h"

enum { DIRECTIONS = 6, AROUND = 32, GRID = 20, BORDERS_MOST = 1500000 };

static const char   names[DIRECTIONS] = {'x', 'y', 'z', 'X', 'Y', 'Z'};
static const double NEAR_GROUND = 0.01;  /* what it stands on lies within this fraction of the diagonal */
static const double FLAT = 0.005;        /* the same for flat faces */
static const double INSIDE = 0.02;       /* the centre is this fraction of the footprint inside */
static const double THICK = 0.05;        /* what is lower is a sheet, of which nothing is known */
static const double ALIKE = 0.9;         /* fraction of cells that have a mirror image */
static const double RIM = 0.8;           /* fraction of all borders that lies in one plane */
static const double BETTER = 0.4;        /* than the usual axis, to be taken instead: of y and z */
static const double SOME_SUPPORT = 0.05; /* of the footprint: a base */
static const double MUCH_BETTER = 0.7;   /* and of the others, which files hardly use */

/* One direction while it is measured. */
typedef struct up_side {
    int    axis, sign;
    double ground;        /* along the direction */
    double reach[AROUND]; /* of what stands there, in directions around the centre */
    double flat, rim, border;
} up_side;

typedef struct up_model {
    box3     box;
    double   diagonal, centre[3], area, border;
    up_side  sides[DIRECTIONS];
    uint8_t *cells; /* GRID³ */
    bool     failed;
} up_model;

static double at(vec3 p, int axis)
{
    return (double)(axis == 0 ? p.x : axis == 1 ? p.y : p.z);
}

static double along(const up_side *s, vec3 p)
{
    return s->sign * at(p, s->axis);
}

/* Area, and what the normal is along each axis. */
static double area_of(const vec3 v[3], double normal[3])
{
    double a[3], b[3], length = 0;
    for (int k = 0; k < 3; k++) {
        a[k] = at(v[1], k) - at(v[0], k);
        b[k] = at(v[2], k) - at(v[0], k);
    }
    for (int k = 0; k < 3; k++) {
        normal[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
        length += normal[k] * normal[k];
    }
    length = sqrt(length);
    for (int k = 0; k < 3; k++)
        normal[k] /= fmax(length, 1e-300);
    return length / 2;
}

static void add_to_centre(up_model *m, const vec3 v[3])
{
    double normal[3], area = area_of(v, normal);
    m->area += area;
    for (int k = 0; k < 3; k++)
        m->centre[k] += area * (at(v[0], k) + at(v[1], k) + at(v[2], k)) / 3;
}

static void mark_cell(up_model *m, vec3 p)
{
    const double low[3] = {(double)m->box.min.x, (double)m->box.min.y, (double)m->box.min.z},
                 high[3] = {(double)m->box.max.x, (double)m->box.max.y, (double)m->box.max.z};
    size_t index = 0;
    for (int k = 0; k < 3; k++) {
        double fraction = (at(p, k) - low[k]) / fmax(high[k] - low[k], 1e-300);
        index = index * GRID + (size_t)fmin(fmax(fraction * GRID, 0), GRID - 1);
    }
    m->cells[index] = 1;
}

static void add_point(up_model *m, vec3 p)
{
    mark_cell(m, p);
    for (int d = 0; d < DIRECTIONS; d++) {
        up_side *s = &m->sides[d];
        if (along(s, p) > s->ground + NEAR_GROUND * m->diagonal)
            continue;
        int first = (s->axis + 1) % 3, second = (s->axis + 2) % 3;
        for (int k = 0; k < AROUND; k++) {
            double angle = 6.283185307179586 * k / AROUND;
            s->reach[k] = fmax(s->reach[k], cos(angle) * (at(p, first) - m->centre[first]) +
                                                sin(angle) * (at(p, second) - m->centre[second]));
        }
    }
}

static void add_flat(up_model *m, const vec3 v[3])
{
    double normal[3], area = area_of(v, normal);
    for (int d = 0; d < DIRECTIONS; d++) {
        up_side *s = &m->sides[d];
        double   highest = fmax(along(s, v[0]), fmax(along(s, v[1]), along(s, v[2])));
        if (highest <= s->ground + FLAT * m->diagonal && fabs(normal[s->axis]) > 0.9)
            s->flat += area;
    }
}

/* An edge that only one triangle has. */
static void add_border(up_model *m, vec3 a, vec3 b)
{
    double length = 0;
    for (int k = 0; k < 3; k++)
        length += (at(b, k) - at(a, k)) * (at(b, k) - at(a, k));
    m->border += sqrt(length);
    for (int d = 0; d < DIRECTIONS; d++) {
        up_side *s = &m->sides[d];
        if (fmax(along(s, a), along(s, b)) > s->ground + NEAR_GROUND * m->diagonal)
            continue;
        int    first = (s->axis + 1) % 3, second = (s->axis + 2) % 3;
        double ax = at(a, first) - m->centre[first], ay = at(a, second) - m->centre[second];
        double bx = at(b, first) - m->centre[first], by = at(b, second) - m->centre[second];
        s->border += sqrt(length);
        s->rim += (ax * by - ay * bx) / 2;
    }
}

static void triangle_of(const primitive *p, const mat4 *world, uint32_t first, vec3 out[3])
{
    for (uint32_t k = 0; k < 3; k++)
        out[k] = mat4_transform_point(world, p->positions[p->indices[first + k]]);
}

typedef void (*primitive_fn)(up_model *m, const primitive *p, const mat4 *world);

static void centre_primitive(up_model *m, const primitive *p, const mat4 *world)
{
    vec3 v[3];
    for (uint32_t i = 0; i + 2 < p->index_count && !work_stopped(); i += 3) {
        triangle_of(p, world, i, v);
        add_to_centre(m, v);
    }
}

static void ground_primitive(up_model *m, const primitive *p, const mat4 *world)
{
    vec3 v[3];
    for (uint32_t i = 0; i < p->vertex_count && !work_stopped(); i++)
        add_point(m, mat4_transform_point(world, p->positions[i]));
    for (uint32_t i = 0; i + 2 < p->index_count && !work_stopped(); i += 3) {
        triangle_of(p, world, i, v);
        add_flat(m, v);
    }
    uint32_t *others = p->index_count && p->index_count <= BORDERS_MOST ? mesh_adjacency(p) : NULL;
    m->failed = m->failed || (!others && p->index_count && p->index_count <= BORDERS_MOST);
    for (uint32_t h = 0; others && h < p->index_count; h++) {
        uint32_t next = h % 3 == 2 ? h - 2 : h + 1;
        if (others[h] == UINT32_MAX)
            add_border(m, mat4_transform_point(world, p->positions[p->indices[h]]),
                       mat4_transform_point(world, p->positions[p->indices[next]]));
    }
    mem_free(others);
}

static void for_primitives(up_model *m, const lmn_scene *scene, primitive_fn call)
{
    for (size_t i = 0; i < scene->part_count; i++) {
        const node *n = &scene->nodes[scene->parts[i].node];
        const mat4  world = scene_world_matrix(scene, scene->parts[i].node);
        for (size_t k = 0; n->mesh != NONE && k < scene->meshes[n->mesh].primitive_count; k++)
            call(m, &scene->meshes[n->mesh].primitives[k], &world);
    }
}

/* Is the model alike on both sides of its middle along an axis? */
static bool is_alike(const up_model *m, int axis)
{
    static const size_t strides[3] = {GRID * GRID, GRID, 1};
    size_t              there = 0, both = 0;
    for (size_t i = 0; i < GRID * GRID * GRID; i++) {
        size_t own = i / strides[axis] % GRID;
        there += m->cells[i];
        both += m->cells[i] && m->cells[i - own * strides[axis] + (GRID - 1 - own) * strides[axis]];
    }
    return there && (double)both >= ALIKE * (double)there;
}

static up_measure judge(const up_model *m, const up_side *s)
{
    int    first = (s->axis + 1) % 3, second = (s->axis + 2) % 3;
    double sides[2] = {at(m->box.max, first) - at(m->box.min, first), at(m->box.max, second) - at(m->box.min, second)};
    double least = INFINITY, footprint = fmax(sides[0] * sides[1], 1e-300);
    up_measure out = {.symmetric = is_alike(m, first) || is_alike(m, second)};
    for (int k = 0; k < AROUND; k++)
        least = fmin(least, s->reach[k]);
    double height = at(m->box.max, s->axis) - at(m->box.min, s->axis);
    out.stands = height > THICK * m->diagonal && least > INSIDE * fmin(sides[0], sides[1]);
    bool rimmed = m->border > 0 && s->border >= RIM * m->border;
    out.support = (s->flat + (rimmed ? fabs(s->rim) : 0)) / footprint;
    out.score = (out.stands ? 0.5 + fmin(2 * out.support, 1) : 0) + (out.symmetric ? 0.25 : 0);
    return out;
}

static void begin(up_model *m)
{
    const double low[3] = {(double)m->box.min.x, (double)m->box.min.y, (double)m->box.min.z},
                 high[3] = {(double)m->box.max.x, (double)m->box.max.y, (double)m->box.max.z};
    m->diagonal = box3_diagonal(m->box);
    for (int k = 0; k < 3; k++)
        m->centre[k] /= m->area;
    for (int d = 0; d < DIRECTIONS; d++) {
        up_side *s = &m->sides[d];
        s->axis = d % 3;
        s->sign = d < 3 ? 1 : -1;
        s->ground = d < 3 ? low[s->axis] : -high[s->axis];
        for (int k = 0; k < AROUND; k++)
            s->reach[k] = -INFINITY;
    }
}

lmn_status up_axis_measure(up_measure out[6], const lmn_scene *scene, lmn_error *error)
{
    up_model m = {.box = box3_empty(), .cells = mem_calloc(GRID * GRID * GRID, 1)};
    memset(out, 0, 6 * sizeof *out);
    if (!m.cells)
        return error_memory(error);
    for (size_t i = 0; i < scene->part_count; i++)
        m.box = box3_union(m.box, scene->parts[i].bounds);
    for_primitives(&m, scene, centre_primitive);
    if (m.area > 0 && isfinite(m.area) && !box3_is_empty(m.box)) {
        begin(&m);
        for_primitives(&m, scene, ground_primitive);
        for (int d = 0; d < DIRECTIONS; d++)
            out[d] = judge(&m, &m.sides[d]);
    }
    mem_free(m.cells);
    lmn_status status = work_check(error);
    return status == LMN_OK && m.failed ? error_memory(error) : status;
}

static const char *reason(const up_measure *is)
{
    return is->support > 0.05 ? "stands flat on its base" : "stands on its feet";
}

/* Of another direction than the usual one, on which the model does not stand. */
static bool is_better(const up_measure *is, const up_measure *own, bool common)
{
    bool firmer = own->support < SOME_SUPPORT || is->support > own->support;
    return is->stands && firmer && is->score >= own->score + (common ? BETTER : MUCH_BETTER);
}

lmn_status up_axis_guess(char *out, lmn_scene *scene, char usual, const char *format, lmn_error *error)
{
    up_measure found[DIRECTIONS];
    int        own = usual == 'y' ? 1 : 2, best = own;
    lmn_status status = up_axis_measure(found, scene, error);
    *out = usual;
    if (status != LMN_OK || found[own].stands)
        return status;
    for (int d = 0; d < DIRECTIONS; d++) {
        double more = d == 1 || d == 2 ? 0 : 0.25; /* than the best so far */
        if (is_better(&found[d], &found[own], d == 1 || d == 2) &&
            (best == own || found[d].score > found[best].score + more))
            best = d;
    }
    if (best == own)
        return LMN_OK;
    warnings_add(&scene->warnings, WARNING_UP_AXIS,
                 "%s does not say which way is up, and +%c is usual; %c%c is taken instead, as the model then %s "
                 "(--up-axis %c overrides)",
                 format, usual == 'y' ? 'Y' : 'Z', best < 3 ? '+' : '-', "XYZ"[best % 3], reason(&found[best]), usual);
    *out = names[best];
    return LMN_OK;
}
