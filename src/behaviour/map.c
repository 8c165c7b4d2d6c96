#include "behaviour/map.h"

#include <math.h>
#include <string.h>

#include "base/vector3.h"
#include "scene/channel.h"

static const double TURN = 6.283185307179586;

void map_defaults(behaviour_map *m, const lmn_scene *scene)
{
    bool up_z = scene->up == 'z';
    vector3_set(m->gravity, 0, up_z ? 0 : -9.81, up_z ? -9.81 : 0);
    vector3_set(m->axis, 0, !up_z, up_z);
    vector3_set(m->up, 0, !up_z, up_z);
    vector3_set(m->forward, 0, up_z ? -1 : 0, !up_z);
    m->restitution = 0.7;
    m->frequency = 1;
    m->rate = TURN;
}

/* Of what comes to rest by itself. */
static const double RESTITUTION_MOST = 0.99;

double map_requirement(const behaviour_map *m)
{
    if (m->kind == MAP_LINEAR && m->times)
        return m->times[m->value_count - 1];
    if (m->kind == MAP_BOUNCE) {
        /* What bounces hundreds of times has to be told for how long. */
        double rest = m->restitution <= RESTITUTION_MOST ? bounce_rest(m) : -1;
        return isfinite(rest) && rest > 0 ? rest : -1;
    }
    return -1;
}

/* --- what a property can have --------------------------------------------------------------------------- */

static bool all_finite(const double *values, size_t count)
{
    for (size_t i = 0; values && i < count; i++)
        if (!isfinite(values[i]) || fabs(values[i]) > 1e18)
            return false;
    return true;
}

static const char *points_fault(const behaviour_map *m)
{
    bool tangent = m->kind == MAP_TANGENT;
    if (m->value_count < (m->kind == MAP_CONSTANT ? 1U : 2U))
        return m->kind == MAP_CONSTANT ? "has no value" : "needs two values or more";
    if (m->kind == MAP_CURVE || tangent) {
        if (m->by_length && m->components > 4)
            return "is a curve by length in more than four numbers";
        if (m->curve == CURVE_BEZIER && (m->value_count < 4 || m->value_count % 3 != 1))
            return "is a Bezier curve, which needs 4, 7, 10 … points";
        if (m->curve == CURVE_CATMULL_ROM && m->closed && m->value_count < 3)
            return "is a closed curve, which needs three points or more";
    }
    for (size_t i = 0; m->times && i < m->value_count; i++)
        if (m->times[i] < 0 || (i == 0 ? m->times[i] != 0 : m->times[i] <= m->times[i - 1]))
            return "has times that do not begin at 0 and increase";
    return NULL;
}

static const char *function_fault(const behaviour_map *m)
{
    double length = 0;
    for (int k = 0; k < 3; k++)
        length +=
            (m->kind == MAP_SPIN ? m->axis[k] : m->gravity[k]) * (m->kind == MAP_SPIN ? m->axis[k] : m->gravity[k]);
    if (m->kind == MAP_SPIN && !(length > 0))
        return "spins about an axis without length";
    if (m->kind == MAP_BOUNCE && !(length > 0))
        return "bounces without gravity";
    if (m->kind == MAP_BOUNCE && !(m->restitution >= 0 && m->restitution <= 1))
        return "has a restitution outside 0 to 1";
    if (m->kind == MAP_CALLBACK && !m->function)
        return "has no function";
    return NULL;
}

static size_t components_of(const behaviour_node *n)
{
    switch (n->map.kind) {
    case MAP_FALL:
    case MAP_BOUNCE:
    case MAP_FOLLOW: return 3;
    case MAP_SPIN:
    case MAP_TANGENT: return 4;
    default: return n->map.components;
    }
}

const char *map_fault(const lmn_scene *scene, const behaviour_node *n)
{
    const behaviour_map *m = &n->map;
    if (!behaviour_target_exists(scene, n->path, n->target))
        return "drives something that the scene does not have";
    size_t wanted = n->about ? 1 : behaviour_components(scene, n->path, n->target), has = components_of(n);
    if (wanted == 0)
        return "drives morph weights of a node that has none";
    if (has != wanted || (m->kind == MAP_TANGENT && m->components != 3))
        return "has values of another size than the property";
    if (n->about && n->path != PATH_ROTATION)
        return "turns about an axis something that is no rotation";
    if (n->about && !(n->axis[0] * n->axis[0] + n->axis[1] * n->axis[1] + n->axis[2] * n->axis[2] > 0))
        return "turns about an axis without length";
    if ((m->kind == MAP_SPIN || m->kind == MAP_TANGENT) && (n->path != PATH_ROTATION || n->about))
        return "gives rotations to a property that is none";
    if (m->kind == MAP_FOLLOW && (n->path != PATH_TRANSLATION || m->other < 0 || (size_t)m->other >= scene->node_count))
        return "follows a node that the scene does not have, or with something else than its translation";
    if (m->kind == MAP_OSCILLATE && m->components > 3)
        return "oscillates in more than three numbers";
    const double numbers[] = {m->floor, m->restitution, m->frequency, m->phase, m->rate, m->delay};
    if (!all_finite(m->values, m->value_count * m->components) ||
        !all_finite(m->times, m->times ? m->value_count : 0) || !all_finite(m->start, 3) ||
        !all_finite(m->velocity, 3) || !all_finite(m->gravity, 3) || !all_finite(m->offset, 3) ||
        !all_finite(m->axis, 3) || !all_finite(n->axis, 3) || !all_finite(numbers, sizeof numbers / sizeof *numbers))
        return "has a number that is not finite, or beyond 1e18";
    if (m->kind <= MAP_TANGENT)
        return points_fault(m);
    return function_fault(m);
}

/* --- values --------------------------------------------------------------------------------------------- */

static void linear_at(const behaviour_node *n, double local, double length, double *out)
{
    const behaviour_map *m = &n->map;
    size_t               last = m->value_count - 1, low = 0, high = last;
    double               within;
    if (m->times) {
        double t = m->times[last] > 0 ? local / length * m->times[last] : 0;
        while (high - low > 1) {
            size_t middle = low + (high - low) / 2;
            *(m->times[middle] <= t ? &low : &high) = middle;
        }
        within = (t - m->times[low]) / (m->times[low + 1] - m->times[low]);
    } else {
        double at = local / length * (double)last;
        low = at >= (double)last ? last - 1 : (size_t)fmax(at, 0);
        within = at - (double)low;
    }
    within = fmin(fmax(within, 0), 1);
    const double *a = m->values + low * m->components, *b = a + m->components;
    if (n->path == PATH_ROTATION && !n->about) {
        double from[4], to[4];
        memcpy(from, a, sizeof from);
        memcpy(to, b, sizeof to);
        quaternion_normalise(from);
        quaternion_normalise(to);
        quaternion_slerp(from, to, within, out);
        return;
    }
    for (size_t k = 0; k < m->components; k++)
        out[k] = a[k] + within * (b[k] - a[k]);
}

static void about_axis(const double axis[3], double angle, double out[4])
{
    double length = sqrt(axis[0] * axis[0] + axis[1] * axis[1] + axis[2] * axis[2]), s = sin(angle / 2) / length;
    for (int k = 0; k < 3; k++)
        out[k] = axis[k] * s;
    out[3] = cos(angle / 2);
}

/* Columns: across, up and along; an orthonormal frame even where up and along are one. */
static void frame_of(const double along[3], const double up[3], double out[3][3])
{
    memcpy(out[2], along, sizeof out[2]);
    if (!vector3_normalise_sure(out[2]))
        memcpy(out[2], (double[3]){0, 0, 1}, sizeof out[2]);
    vector3_cross(out[0], up, out[2]);
    if (!vector3_normalise_sure(out[0])) {
        vector3_cross(out[0], (double[3]){fabs(out[2][0]) < 0.9, fabs(out[2][0]) >= 0.9, 0}, out[2]);
        vector3_normalise_sure(out[0]);
    }
    vector3_cross(out[1], out[2], out[0]);
}

/* Shepperd's choice of the largest component keeps it accurate everywhere. */
static void quaternion_of(const double m[3][3], double q[4])
{
    double four[4] = {1 + m[0][0] - m[1][1] - m[2][2], 1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2],
                      1 + m[0][0] + m[1][1] + m[2][2]};
    int    most = 0;
    for (int k = 1; k < 4; k++)
        most = four[k] > four[most] ? k : most;
    const double twice[3] = {m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]};
    for (int k = 0; k < 4; k++)
        if (k == most)
            q[k] = four[k];
        else if (k == 3 || most == 3)
            q[k] = twice[k == 3 ? most : k];
        else
            q[k] = m[k][most] + m[most][k];
    quaternion_normalise(q);
}

static void tangent_at(const behaviour_map *m, double parameter, double out[4])
{
    double along[3], to[3][3], from[3][3], turn[3][3];
    curve_at(m, parameter, NULL, along);
    if (fabs(along[0]) + fabs(along[1]) + fabs(along[2]) <= 1e-12) /* control points in one place: a little beside */
        curve_at(m, parameter < 0.5 ? parameter + 1e-4 : parameter - 1e-4, NULL, along);
    frame_of(along, m->up, to);
    frame_of(m->forward, m->up, from);
    for (int row = 0; row < 3; row++)
        for (int column = 0; column < 3; column++) {
            turn[row][column] = 0;
            for (int k = 0; k < 3; k++)
                turn[row][column] += to[k][row] * from[k][column];
        }
    quaternion_of((const double(*)[3])turn, out);
}

static void value_at(const behaviour_node *n, const curve_table *table, double local, double length, double *out)
{
    const behaviour_map *m = &n->map;
    double               share = length > 0 ? local / length : 0;
    switch (m->kind) {
    case MAP_CONSTANT: memcpy(out, m->values, m->components * sizeof *out); break;
    case MAP_LINEAR: linear_at(n, local, length, out); break;
    case MAP_CURVE: curve_at(m, m->by_length ? curve_parameter(table, m, share) : share, out, NULL); break;
    case MAP_TANGENT: tangent_at(m, m->by_length ? curve_parameter(table, m, share) : share, out); break;
    case MAP_FALL:
        for (int k = 0; k < 3; k++)
            out[k] = m->start[k] + m->velocity[k] * local + m->gravity[k] * local * local / 2;
        break;
    case MAP_BOUNCE: bounce_at(m, local, out); break;
    case MAP_OSCILLATE:
        for (size_t k = 0; k < m->components; k++)
            out[k] = m->start[k] + m->velocity[k] * sin(TURN * (m->frequency * local + m->phase));
        break;
    case MAP_SPIN: about_axis(m->axis, m->phase + m->rate * local, out); break;
    case MAP_CALLBACK: m->function(local, out, m->user); break;
    case MAP_FOLLOW: memcpy(out, m->offset, sizeof m->offset); break;
    }
}

void map_value(const behaviour_node *n, const curve_table *table, double local, double length, double *out)
{
    if (n->about) {
        double angle = 0;
        value_at(n, table, local, length, &angle);
        about_axis(n->axis, angle, out);
        return;
    }
    value_at(n, table, local, length, out);
    if (n->path == PATH_ROTATION)
        quaternion_normalise(out);
}

/* --- where it may jump ---------------------------------------------------------------------------------- */

/* Multiples of a step, within the activity. */
static void even_breaks(double step, double length, bool (*found)(double, void *), void *user)
{
    for (size_t i = 1; step > 0 && (double)i * step < length; i++)
        if (!found((double)i * step, user))
            return;
}

/* Flights that are shorter than a millionth of a second cannot be told from rest. */
enum { IMPACTS_MAX = 100000 };

static void point_breaks(const behaviour_map *m, const curve_table *table, double length, bool (*found)(double, void *),
                         void *user)
{
    bool   curve = m->kind != MAP_LINEAR;
    size_t pieces = curve ? curve_pieces(m) : m->value_count - 1;
    for (size_t i = 1; i < pieces; i++) {
        double share = (double)i / (double)pieces;
        if (curve && m->by_length && table->lengths[table->count] > 0)
            share = table->lengths[i * (table->count / pieces)] / table->lengths[table->count];
        else if (m->times && !curve)
            share = m->times[i] / m->times[pieces];
        if (!found(share * length, user))
            return;
    }
}

void map_breaks(const behaviour_node *n, const curve_table *table, double length, bool (*found)(double, void *),
                void *user)
{
    const behaviour_map *m = &n->map;
    switch (m->kind) {
    case MAP_LINEAR:
    case MAP_CURVE:
    case MAP_TANGENT: point_breaks(m, table, length, found, user); break;
    case MAP_OSCILLATE: even_breaks(m->frequency != 0 ? fabs(0.25 / m->frequency) : 0, length, found, user); break;
    case MAP_SPIN: even_breaks(m->rate != 0 ? fabs(TURN / 4 / m->rate) : 0, length, found, user); break;
    case MAP_CALLBACK:
    case MAP_FOLLOW: even_breaks(length / 16, length, found, user); break;
    case MAP_BOUNCE:
        for (int i = 0; i < IMPACTS_MAX; i++) {
            double t = bounce_impact(m, i);
            if (!(t < length) || (i > 0 && t - bounce_impact(m, i - 1) < 1e-6) || !found(t, user))
                break;
        }
        if (bounce_rest(m) < length)
            found(bounce_rest(m), user);
        break;
    default: break;
    }
}
