/* Ghost images: the target where it was, is and will be; stretched along its velocity and flattened where it is
 * stopped, volume kept; of paper planes with wings bent by what pushes them across. Nienhaus 2005, sections 7.6, 7.9.
 */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "depict/depict_private.h"

typedef struct still_values {
    int32_t count;
    float   stretch, fade, bend, least;
    bool    sketchy;
    colour  colour;
} still_values;

static const param still_params[] = {
    PARAM_INT_ROW(still_values, count, .def = 1, .min = 1, .max = 64, .soft_max = 12, .unit = UNIT_COUNT,
                  .doc = "How many: now, then where the interval begins and ends, where it meets something, and evenly "
                         "along the way."),
    PARAM_FLOAT_ROW(still_values, stretch, .def = 0, .min = 0, .max = 2, .soft_max = 1,
                    .doc = "How far speed stretches it and impacts flatten it, volume kept; 0: rigid."),
    PARAM_FLOAT_ROW(still_values, fade, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much paler than the target those farthest from now are."),
    PARAM_FLOAT_ROW(still_values, least, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc =
                        "Limbs that have gone less far than this part of what goes farthest have no image of past and "
                        "future: of a figure that sways, those that swing are shown. A limb is what a joint leads, or "
                        "what keeps its form."),
    PARAM_BOOL_ROW(still_values, sketchy, .def = 0, .doc = "Attribute [sketchy] for looks: drawn loosely."),
    PARAM_COLOUR_ROW(still_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of those of past and future; none: the target's own."),
};

static const param plane_params[] = {
    PARAM_INT_ROW(still_values, count, .def = 1, .min = 1, .max = 64, .soft_max = 12, .unit = UNIT_COUNT,
                  .doc = "How many: now, then where the interval begins and ends, where it meets something, and evenly "
                         "along the way."),
    PARAM_FLOAT_ROW(still_values, bend, .def = 0.5, .min = 0, .max = 5, .soft_max = 1,
                    .doc = "How far wing tips lag behind the acceleration across the way, in radii at the strongest."),
    PARAM_FLOAT_ROW(still_values, fade, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much paler than the target those farthest from now are."),
    PARAM_FLOAT_ROW(still_values, least, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc =
                        "Limbs that have gone less far than this part of what goes farthest have no image of past and "
                        "future: of a figure that sways, those that swing are shown. A limb is what a joint leads, or "
                        "what keeps its form."),
    PARAM_BOOL_ROW(still_values, sketchy, .def = 0, .doc = "Attribute [sketchy] for looks: drawn loosely."),
    PARAM_COLOUR_ROW(still_values, colour, .def_colour = {0, 0, 0, 0},
                     .doc = "Of those of past and future; none: the target's own."),
};

/* --- deformation -----------------------------------------------------------------------------------------------------
 */

/* Of positions in the world, around a middle. */
typedef struct shape_change {
    double middle[3], axis[3], along, across; /* factors */
    double shift[3];
    double pull[3], reach; /* wings: displacement at a distance of `reach` from the way's axis */
} shape_change;

static vec3 change_apply(const shape_change *c, vec3 at)
{
    double p[3] = {(double)at.x, (double)at.y, (double)at.z}, d[3];
    vector3_add(d, p, -1, c->middle);
    double along = vector3_dot(d, c->axis);
    vector3_add(d, d, -along, c->axis);
    double far = c->reach > 0 ? vector3_length(d) / c->reach : 0;
    for (int k = 0; k < 3; k++)
        p[k] = c->middle[k] + c->shift[k] + along * c->along * c->axis[k] + d[k] * c->across + far * far * c->pull[k];
    return (vec3){(float)p[0], (float)p[1], (float)p[2]};
}

/* Fast things are long, stopped ones flat: s along, 1/√s across, so that the volume stays. */
static lmn_status change_find(shape_change *c, const expression *e, const depict_target *t, double seconds,
                              double usual, lmn_error *error)
{
    const still_values *v = e->values;
    depict_impact       impact;
    size_t              impacts = 0;
    double              velocity[3], span = fmin(1.0 / 60, (e->to - e->from) / 60);
    memset(c, 0, sizeof *c);
    c->along = c->across = 1;
    way_point(&t->way, t->centre, seconds, c->middle);
    way_velocity(&t->way, t->centre, seconds, span, velocity);
    vector3_copy(c->axis, velocity);
    if (!vector3_normalise(c->axis))
        vector3_set(c->axis, 0, 1, 0);
    lmn_status status = LMN_OK;
    if (v->stretch > 0 && usual > 0) {
        status = target_impacts(&impact, 1, &impacts, t, fmax(seconds - 2 * span, e->from),
                                fmin(seconds + 2 * span, e->to), error);
        double factor = 1 + (double)v->stretch * 0.5 * vector3_length(velocity) / usual;
        if (impacts && fabs(impact.time - seconds) < span && vector3_length(impact.change) > usual * 0.5) {
            vector3_copy(c->axis, impact.change);
            vector3_normalise(c->axis);
            factor = 1 / (1 + (double)v->stretch * 0.5 * vector3_length(impact.change) / (2 * usual));
            /* What it meets stays where it is. */
            vector3_add(c->shift, c->shift, -t->radius * (1 - factor), c->axis);
        }
        c->along = factor;
        c->across = 1 / sqrt(factor);
    }
    return status;
}

/* What pushes something at a time, units a second and second; where its way begins or ends, just inside: nothing is
 * known of what was before, and it has not been stopped by the end of a clip. */
static void push_at(const depict_target *t, double seconds, double out[3])
{
    const double span = fmin(1.0 / 15, t->way.end / 4), inside = fmin(fmax(seconds, span), t->way.end - span);
    double       a[3];
    vector3_set(out, 0, 0, 0);
    if (!(span > 0))
        return;
    way_velocity(&t->way, t->centre, inside - span / 2, span, a);
    way_velocity(&t->way, t->centre, inside + span / 2, span, out);
    for (int k = 0; k < 3; k++)
        out[k] = (out[k] - a[k]) / span;
}

/* What pushes a plane across its way, and how far its wings lag behind. */
static void bend_find(shape_change *c, const expression *e, const depict_target *t, double seconds, double most)
{
    const still_values *v = e->values;
    double              across[3], to[3];
    push_at(t, seconds, across);
    vector3_add(across, across, -vector3_dot(across, c->axis), c->axis);
    vector3_copy(to, across);
    if (!(most > 0) || !vector3_normalise(to))
        return;
    c->reach = t->radius;
    for (int k = 0; k < 3; k++)
        c->pull[k] = -(double)v->bend * t->radius * vector3_length(across) / most * to[k];
}

/* --- copies ----------------------------------------------------------------------------------------------------------
 */

/* That of the material; of those of past and future another one where somebody gave it. */
static colour own_colour(const lmn_scene *s, const primitive *p, const still_values *v, bool other_time)
{
    if (v->colour.a > 0 && other_time)
        return v->colour;
    if (p->material == NONE)
        return (colour){0.75f, 0.75f, 0.75f, 1};
    const vec4 *own = &s->materials[p->material].base_colour;
    return (colour){colour_from_linear(own->x), colour_from_linear(own->y), colour_from_linear(own->z), 1};
}

static colour paler(colour c, double fade)
{
    c.r += (1 - c.r) * (float)fade;
    c.g += (1 - c.g) * (float)fade;
    c.b += (1 - c.b) * (float)fade;
    return c;
}

/* Where a primitive's vertices are in a pose. */
static void place_vertices(vec3 *out, const pose *p, size_t part, size_t instance, const primitive *from,
                           const shape_change *change)
{
    const mat4 world = pose_instance(p, part, instance);
    pose_vertices(&p->parts[part], from, NULL, NULL, from->vertex_count, out, NULL);
    for (uint32_t i = 0; i < from->vertex_count; i++)
        out[i] = change_apply(change, mat4_transform_point(&world, out[i]));
}

static bool is_near(const vec3 *a, const vec3 *b, float within)
{
    return fabsf(a->x - b->x) <= within && fabsf(a->y - b->y) <= within && fabsf(a->z - b->z) <= within;
}

/* Right behind what is seen now, on the same lines of sight. */
static void step_back(const depict_job *j, glyph_mesh *m)
{
    for (size_t i = 0; i < m->position_count; i++) {
        double at[3] = {(double)m->positions[i].x, (double)m->positions[i].y, (double)m->positions[i].z};
        depict_lift(j, at, -5e-4 * j->size);
        m->positions[i] = (vec3){(float)at[0], (float)at[1], (float)at[2]};
    }
}

/* Takes out what is where it is now, as it is seen there already; was there any? */
static bool leave_moved(glyph_mesh *m, const vec3 *now, float within)
{
    const size_t index_count = m->index_count, line_count = m->line_count;
    size_t       kept = 0;
    for (size_t i = 0; i + 2 < m->index_count; i += 3) {
        bool moved = false;
        for (size_t k = i; k < i + 3; k++)
            moved = moved || !is_near(&m->positions[m->indices[k]], &now[m->indices[k]], within);
        for (size_t k = i; moved && k < i + 3; k++)
            m->indices[kept++] = m->indices[k];
    }
    m->index_count = kept;
    kept = 0;
    for (size_t i = 0; i + 1 < m->line_count; i += 2)
        if (!is_near(&m->positions[m->lines[i]], &now[m->lines[i]], within) ||
            !is_near(&m->positions[m->lines[i + 1]], &now[m->lines[i + 1]], within)) {
            m->lines[kept++] = m->lines[i];
            m->lines[kept++] = m->lines[i + 1];
        }
    m->line_count = kept;
    return m->index_count < index_count || m->line_count < line_count;
}

/* The target as it is now, beside which others are seen. */
typedef struct present {
    const pose  *posed; /* NULL: it is not seen */
    shape_change change;
    float        within; /* what is nearer to it is the same */
    float        least;  /* what has gone less is not told */
} present;

static float away(const vec3 *a, const vec3 *b)
{
    return fmaxf(fmaxf(fabsf(a->x - b->x), fabsf(a->y - b->y)), fabsf(a->z - b->z));
}

/* The joint that leads a vertex most; 0: there are none, and all goes as one. */
static uint16_t joint_of(const primitive *from, uint32_t vertex)
{
    const size_t first = (size_t)vertex * from->influences;
    uint32_t     best = 0;
    for (uint32_t i = 1; i < from->influences; i++)
        best = from->weights[first + i] > from->weights[first + best] ? i : best;
    return from->influences ? from->joints[first + best] : 0;
}

/* Vertices of limbs that have gone less far than is told are where they are now, then: they are not told. A limb is
 * what one joint leads, or all that keeps its form: it has gone as far as its end, and none of it is torn off. False:
 * out of memory. */
static bool settle_limbs(const glyph_mesh *m, vec3 *there, const primitive *from, float least)
{
    float *gone = mem_calloc((size_t)UINT16_MAX + 1, sizeof *gone); /* the farthest of each joint */
    for (uint32_t i = 0; i < from->vertex_count && gone; i++) {
        float *of_joint = &gone[joint_of(from, i)];
        *of_joint = fmaxf(*of_joint, away(&m->positions[i], &there[i]));
    }
    for (uint32_t i = 0; i < from->vertex_count && gone; i++)
        if (gone[joint_of(from, i)] < least)
            there[i] = m->positions[i];
    mem_free(gone);
    return gone != NULL;
}

/* Where a primitive is put that keeps its form, but for what is linear in the change; false: it does not. */
static bool find_place(mat4 *out, const pose *p, size_t part, size_t instance, const shape_change *c)
{
    if (pose_part_deforms(&p->parts[part]) || vector3_length(c->pull) > 0)
        return false;
    const mat4 world = pose_instance(p, part, instance);
    mat4       change = mat4_identity();
    for (int row = 0; row < 3; row++) {
        double moved = c->middle[row] + c->shift[row];
        for (int column = 0; column < 3; column++) {
            const double e = (row == column ? c->across : 0) + (c->along - c->across) * c->axis[row] * c->axis[column];
            change.m[4 * column + row] = e;
            moved -= e * c->middle[column];
        }
        change.m[12 + row] = moved;
    }
    *out = mat4_multiply(&change, &world);
    return true;
}

/* What all ghost images of a primitive have, as it is in its mesh. */
static bool copy_lists(glyph_mesh *m, const primitive *from)
{
    m->indices = from->index_count ? mem_copy(from->indices, from->index_count * sizeof *m->indices) : NULL;
    m->lines = from->line_count ? mem_copy(from->lines, 2 * (size_t)from->line_count * sizeof *m->lines) : NULL;
    m->position_count = from->vertex_count;
    m->index_count = from->index_count;
    m->line_count = 2 * (size_t)from->line_count;
    return !((from->index_count && !m->indices) || (from->line_count && !m->lines));
}

static void turn_triangles(glyph_mesh *m)
{
    for (size_t i = 0; i + 2 < m->index_count; i += 3) {
        const uint32_t kept = m->indices[i];
        m->indices[i] = m->indices[i + 1];
        m->indices[i + 1] = kept;
    }
}

/* A primitive as it is in a pose. */
static lmn_status put_primitive(depict_job *j, const pose *p, size_t part, size_t instance, size_t number,
                                const shape_change *change, const present *now, const glyph_label *label,
                                lmn_error *error)
{
    const int32_t    mesh_index = j->scene->nodes[j->scene->parts[part].node].mesh;
    const primitive *from = &j->scene->meshes[mesh_index].primitives[number];
    glyph_mesh       m = {0};
    mat4             world = pose_instance(p, part, instance);
    const bool       mirrored = mat4_cofactors(&world, (double[9]){0}) < 0;
    uint64_t         shape = 0;
    vec3            *there = now->posed ? mem_alloc((from->vertex_count + 1) * sizeof *there) : NULL;
    m.positions = mem_alloc((from->vertex_count + 1) * sizeof *m.positions);
    m.failed = !copy_lists(&m, from) || !m.positions || (now->posed && !there);
    if (!m.failed)
        place_vertices(m.positions, p, part, instance, from, change);
    if (!m.failed && there)
        place_vertices(there, now->posed, part, instance, from, &now->change);
    if (!m.failed && there && now->least > now->within)
        m.failed = !settle_limbs(&m, there, from, now->least);
    if (!m.failed && there && leave_moved(&m, there, now->within)) {
        step_back(j, &m); /* what is left may lie in faces that are seen now */
    } else if (!m.failed && find_place(&world, p, part, instance, change)) {
        memcpy(m.positions, from->positions, from->vertex_count * sizeof *m.positions);
        shape = ((uint64_t)mesh_index + 1) << 32 | number;
    }
    if (mirrored && !shape && !m.failed)
        turn_triangles(&m);
    mem_free(there);
    lmn_status status = glyph_put_placed(j, &m, &world, shape, label, error);
    glyph_mesh_release(&m);
    return status;
}

/* How far the target's vertex that goes farthest is from where it is now. */
static lmn_status find_farthest(float *out, const depict_job *j, const depict_target *t, const pose *p,
                                const shape_change *change, const present *now, lmn_error *error)
{
    *out = 0;
    for (size_t i = 0; i < t->part_count; i++) {
        const node *n = &j->scene->nodes[j->scene->parts[i].node];
        const mesh *m = t->parts[i] && n->mesh != NONE ? &j->scene->meshes[n->mesh] : NULL;
        for (size_t k = 0; m && k < m->primitive_count; k++) {
            const primitive *from = &m->primitives[k];
            vec3            *then = mem_alloc((from->vertex_count + 1) * sizeof *then),
                 *there = mem_alloc((from->vertex_count + 1) * sizeof *there);
            const bool good = then && there;
            if (good) {
                place_vertices(then, p, i, 0, from, change);
                place_vertices(there, now->posed, i, 0, from, &now->change);
            }
            for (uint32_t v = 0; v < from->vertex_count && good; v++)
                *out = fmaxf(*out, fmaxf(fabsf(then[v].x - there[v].x),
                                         fmaxf(fabsf(then[v].y - there[v].y), fabsf(then[v].z - there[v].z))));
            mem_free(then);
            mem_free(there);
            if (!good)
                return error_memory(error);
        }
    }
    return LMN_OK;
}

static lmn_status put_still(depict_job *j, const expression *e, const depict_target *t, double seconds,
                            const shape_change *change, present *now, lmn_error *error)
{
    const still_values *v = e->values;
    const pose         *p = NULL;
    const double        apart = fmax(e->to - e->now, e->now - e->from);
    const double        fade = apart > 0 ? (double)v->fade * (0.4 + 0.6 * fabs(seconds - e->now) / apart) : 0;
    const bool          is_now = fabs(seconds - e->now) < 1e-9;
    glyph_label         label = {"still",
                                 e->target,
                         is_now             ? GLYPH_PRESENT
                                 : seconds < e->now ? GLYPH_PAST
                                                    : GLYPH_FUTURE,
                                 {0}};
    /* By looks in ink the nearest ones, too, are to be told from it. */
    const double pale = apart > 0 ? (double)v->fade * (0.55 + 0.6 * fabs(seconds - e->now) / apart) : 0;
    label.image = 2 + (uint32_t)j->glyph_count;
    label.pale = is_now ? 0 : (int)fmin(fmax(round(pale * PALE_MOST), pale > 0), PALE_MOST);
    lmn_status status = depict_pose(&p, j, seconds, error);
    now->posed = NULL;
    if (status == LMN_OK && !is_now)
        status = depict_pose(&now->posed, j, e->now, error);
    now->least = 0;
    if (status == LMN_OK && now->posed && v->least > 0) {
        float farthest;
        status = find_farthest(&farthest, j, t, p, change, now, error);
        now->least = v->least * farthest;
    }
    for (size_t i = 0; i < t->part_count && status == LMN_OK; i++) {
        const node   *n = &j->scene->nodes[j->scene->parts[i].node];
        const int32_t mesh_index = n->mesh;
        const size_t  draws = node_draw_count(n),
                     pieces = mesh_index == NONE ? 0 : j->scene->meshes[mesh_index].primitive_count;
        for (size_t k = 0; t->parts[i] && k < pieces * draws && status == LMN_OK; k++) {
            const primitive *from = &j->scene->meshes[mesh_index].primitives[k / draws];
            label.sketchy = v->sketchy;
            label.own = own_colour(j->scene, from, v, !is_now);
            label.tint = is_now ? label.own : paler(label.own, fade);
            status = put_primitive(j, p, i, k % draws, k / draws, change, now, &label, error);
        }
    }
    return status;
}

static double usual_speed(const expression *e, const depict_target *t)
{
    enum { STEPS = 64 };
    double length = 0, last[3], now[3];
    way_point(&t->way, t->centre, e->from, last);
    for (int i = 1; i <= STEPS; i++) {
        way_point(&t->way, t->centre, e->from + (e->to - e->from) * i / STEPS, now);
        length += vector3_distance(last, now);
        vector3_copy(last, now);
    }
    return e->to > e->from ? length / (e->to - e->from) : 0;
}

static double strongest_push(const expression *e, const depict_target *t)
{
    enum { STEPS = 64 };
    const double span = 1.0 / 15;
    double       most = 0;
    for (int i = 0; i <= STEPS; i++) {
        double seconds = e->from + (e->to - e->from) * i / STEPS, along[3], push[3];
        push_at(t, seconds, push);
        way_velocity(&t->way, t->centre, seconds, span, along);
        if (vector3_normalise(along))
            vector3_add(push, push, -vector3_dot(push, along), along);
        most = fmax(most, vector3_length(push));
    }
    return most;
}

/* --- when -------------------------------------------------------------------------------------------------------- */

enum { STILLS_MOST = 64 };

typedef struct still_times {
    double at[STILLS_MOST];
    int    count, wanted;
} still_times;

static void add_time(still_times *t, double seconds, double apart)
{
    for (int i = 0; i < t->count; i++)
        if (fabs(t->at[i] - seconds) <= apart)
            return;
    if (t->count < t->wanted)
        t->at[t->count++] = seconds;
}

static double length_at(const trajectory *way, const double *lengths, double seconds)
{
    size_t i = 1;
    while (i + 1 < way->count && way->samples[i].seconds < seconds)
        i++;
    double span = way->samples[i].seconds - way->samples[i - 1].seconds;
    double f = span > 0 ? (seconds - way->samples[i - 1].seconds) / span : 0;
    return lengths[i - 1] + fmin(fmax(f, 0), 1) * (lengths[i] - lengths[i - 1]);
}

static double time_at(const trajectory *way, const double *lengths, double length)
{
    size_t i = 1;
    while (i + 1 < way->count && lengths[i] < length)
        i++;
    double piece = lengths[i] - lengths[i - 1], f = piece > 0 ? (length - lengths[i - 1]) / piece : 0;
    return way->samples[i - 1].seconds + fmin(fmax(f, 0), 1) * (way->samples[i].seconds - way->samples[i - 1].seconds);
}

/* In the middle of the longest piece of way between two that are there; false when nothing lies between them. */
static bool fill_gap(still_times *t, const trajectory *way, const double *lengths, double apart)
{
    double longest = 0, middle = 0;
    for (int i = 0; i < t->count; i++) {
        double from = length_at(way, lengths, t->at[i]), next = INFINITY;
        for (int k = 0; k < t->count; k++) {
            double to = length_at(way, lengths, t->at[k]);
            next = to > from && to < next ? to : next;
        }
        if (isfinite(next) && next - from > longest) {
            longest = next - from;
            middle = (from + next) / 2;
        }
    }
    int before = t->count;
    if (longest > 0)
        add_time(t, time_at(way, lengths, middle), apart);
    return t->count > before;
}

/* Now, the interval's ends, where it meets something, then evenly along the way. */
static lmn_status times_find(still_times *out, const expression *e, const depict_target *t, lmn_error *error)
{
    const still_values *v = e->values;
    depict_impact       impacts[STILLS_MOST];
    trajectory          way = {0};
    double             *lengths = NULL, apart = (e->to - e->from) * 1e-6;
    size_t              impact_count = 0;
    *out = (still_times){.wanted = v->count};
    add_time(out, e->now, apart);
    add_time(out, e->from, apart);
    add_time(out, e->to, apart);
    lmn_status status = out->count < out->wanted ? target_impacts(impacts, (size_t)(out->wanted - out->count),
                                                                  &impact_count, t, e->from, e->to, error)
                                                 : LMN_OK;
    for (size_t i = 0; i < impact_count && status == LMN_OK; i++)
        add_time(out, impacts[i].time, apart);
    if (status == LMN_OK && out->count < out->wanted) {
        status = way_trajectory(&way, &t->way, t->centre, e->from, e->to, t->radius * 0.05, error);
        lengths = status == LMN_OK ? trajectory_lengths(&way) : NULL;
        if (status == LMN_OK && !lengths)
            status = error_memory(error);
    }
    while (status == LMN_OK && out->count < out->wanted && fill_gap(out, &way, lengths, apart))
        ;
    mem_free(lengths);
    trajectory_release(&way);
    return status;
}

static lmn_status stills(depict_job *j, const expression *e, bool bends, lmn_error *error)
{
    depict_target t;
    still_times   times = {0};
    lmn_status    status = target_open(&t, j, e->target, error);
    const double  usual = status == LMN_OK ? usual_speed(e, &t) : 0;
    const double  push = status == LMN_OK && bends ? strongest_push(e, &t) : 0;
    if (status == LMN_OK)
        status = times_find(&times, e, &t, error);
    present now = {.within = (float)(0.04 * t.radius)};
    for (int i = 0; i < times.count && status == LMN_OK; i++) { /* now is the first one */
        shape_change change;
        status = change_find(&change, e, &t, times.at[i], usual, error);
        if (bends && status == LMN_OK)
            bend_find(&change, e, &t, times.at[i], push);
        if (status == LMN_OK)
            status = put_still(j, e, &t, times.at[i], &change, &now, error);
        now.change = i == 0 ? change : now.change;
    }
    target_release(&t);
    return status;
}

static lmn_status still_depict(depict_job *j, const expression *e, lmn_error *error)
{
    return stills(j, e, false, error);
}

static lmn_status plane_depict(depict_job *j, const expression *e, lmn_error *error)
{
    return stills(j, e, true, error);
}

const depiction depiction_still = {
    "still",
    NULL,
    "Ghost images: the target at several times.",
    still_params,
    PARAM_COUNT(still_params),
    sizeof(still_values),
    true,
    still_depict,
};

const depiction depiction_still_plane = {
    "still",
    "paper-plane",
    "Ghost images of a paper plane, whose wings bend with the acceleration across its way.",
    plane_params,
    PARAM_COUNT(plane_params),
    sizeof(still_values),
    true,
    plane_depict,
};
