/* A sphere that meets something: where its own axes make it the unit sphere, the nearest place of the other thing is
 * where both touch, since touching stays what it is under any matrix. */
#include "base/error.h"
#include "base/vector3.h"
#include "base/work.h"
#include "contact/surface.h"
#include "contact/touch_private.h"

typedef struct round_search {
    const touch_pair *pair;
    bool              flips;
    double            back[3][3]; /* rows: from the world to the unit sphere's axes */
} round_search;

/* Rows of the inverse of the matrix that has these columns; false: it is flat. */
static bool inverse_rows(const double columns[3][3], double rows[3][3])
{
    for (int k = 0; k < 3; k++)
        vector3_cross(rows[k], columns[(k + 1) % 3], columns[(k + 2) % 3]);
    const double volume = vector3_dot(columns[0], rows[0]);
    for (int k = 0; k < 3; k++)
        vector3_set(rows[k], rows[k][0] / volume, rows[k][1] / volume, rows[k][2] / volume);
    return isfinite(1 / volume);
}

/* Is it a sphere in the world, too? */
static bool is_even(const touch_piece *p)
{
    const double size = vector3_dot(p->radii[0], p->radii[0]);
    bool         even = p->is_sphere;
    for (int i = 0; i < 3; i++)
        for (int k = i; k < 3; k++)
            even = even && fabs(vector3_dot(p->radii[i], p->radii[k]) - (i == k ? size : 0)) < 1e-5 * size;
    return even;
}

static lmn_status keep(touch_places *all, const round_search *r, const double outward[3], const double on_sphere[3],
                       double gap, lmn_error *error)
{
    touch_place  place = {.gap = gap, .of_face = true};
    const double sense = r->flips ? 1 : -1;
    for (int k = 0; k < 3; k++) {
        place.normal[k] = sense * outward[k];
        place.own[k] = on_sphere[k] + (r->flips ? gap * outward[k] : 0);
    }
    const double steep = -vector3_dot(place.normal, r->pair->along);
    if (steep < TOUCH_STEEP || fabs(gap) > r->pair->within)
        return LMN_OK;
    return touch_keep(all, &place, gap / steep, r->pair->tie, error);
}

static lmn_status meet_even(touch_places *all, const round_search *r, lmn_error *error)
{
    const touch_piece *a = r->pair->own, *b = r->pair->other;
    const double       own = vector3_length(a->radii[0]);
    double             outward[3], on_sphere[3];
    vector3_add(outward, b->centre, -1, a->centre);
    const double apart = vector3_length(outward);
    if (!vector3_normalise(outward))
        return LMN_OK;
    vector3_add(on_sphere, a->centre, own, outward);
    return keep(all, r, outward, on_sphere, apart - own - vector3_length(b->radii[0]), error);
}

/* The place of triangle `i` that is nearest to a point, in the unit sphere's axes. */
static double nearest_of(const round_search *r, uint32_t i, const double to[3], double out[3])
{
    const touch_piece *own = r->pair->own, *other = r->pair->other;
    double             c[3][3], normal[3];
    for (int k = 0; k < 3; k++) {
        double from[3];
        vector3_add(from, other->vertices[other->indices[i + (uint32_t)k]], -1, own->centre);
        for (int a = 0; a < 3; a++)
            c[k][a] = vector3_dot(r->back[a], from);
    }
    surface_nearest_on_triangle(to, (const double *const[3]){c[0], c[1], c[2]}, out, normal);
    return vector3_distance(out, to);
}

/* Where the sphere's surface faces a place of its axes: outward there, in the world, and how far off that is. */
static double face(const round_search *r, const double place[3], double outward[3], double on_sphere[3])
{
    const touch_piece *own = r->pair->own;
    double             unit[3], off[3] = {0, 0, 0};
    const double       far = vector3_length(place);
    vector3_copy(unit, place);
    vector3_set(outward, 0, 0, 0);
    vector3_copy(on_sphere, own->centre);
    if (!vector3_normalise(unit))
        return INFINITY;
    for (int k = 0; k < 3; k++) {
        vector3_add(outward, outward, unit[k], r->back[k]);
        vector3_add(on_sphere, on_sphere, unit[k], own->radii[k]);
        vector3_add(off, off, (far - 1) * unit[k], own->radii[k]);
    }
    vector3_normalise(outward);
    return vector3_dot(off, outward);
}

/* Does a closed surface turn triangle `i` away from the sphere's middle? That leaves it, or was inside. */
static bool is_turned_away(const round_search *r, uint32_t i)
{
    const touch_piece *other = r->pair->other;
    const double      *c[3];
    double             a[3], b[3], normal[3], to[3];
    for (uint32_t k = 0; k < 3; k++)
        c[k] = other->vertices[other->indices[i + k]];
    vector3_add(a, c[1], -1, c[0]);
    vector3_add(b, c[2], -1, c[0]);
    vector3_cross(normal, a, b);
    vector3_add(to, r->pair->own->centre, -1, c[0]);
    return other->outward * vector3_dot(normal, to) < 0;
}

/* Is there no way along the other's surface, from a place of it, that comes nearer? An edge within a plane is none. */
static bool is_nearest_around(const round_search *r, const double place[3])
{
    static const double middle[3] = {0, 0, 0};
    const double        far = vector3_length(place);
    for (uint32_t i = 0; i + 2 < r->pair->other->index_count; i += 3) {
        double at[3];
        if (nearest_of(r, i, place, at) < 1e-6 && nearest_of(r, i, middle, at) < far - 1e-6)
            return false;
    }
    return true;
}

/* Of all places near the sphere that it comes on to, the nearest. */
static lmn_status meet_mesh(touch_places *all, const round_search *r, lmn_error *error)
{
    enum { TRIES = 16 };
    static const double middle[3] = {0, 0, 0};
    double              behind = 0; /* those that are nearer have been looked at */
    for (int tries = 0; tries < TRIES; tries++) {
        double nearest = INFINITY, place[3], outward[3], on_sphere[3], gap = 0;
        for (uint32_t i = 0; i + 2 < r->pair->other->index_count && !work_stopped(); i += 3) {
            double       at[3], to[3], on[3];
            const double far = nearest_of(r, i, middle, at), off = face(r, at, to, on),
                         along = vector3_dot(to, r->pair->along) * (r->flips ? -1 : 1);
            if (far > behind && far < nearest && !is_turned_away(r, i) && fabs(off) <= r->pair->within &&
                along >= TOUCH_STEEP) {
                nearest = far;
                gap = off;
                vector3_copy(place, at);
                vector3_copy(outward, to);
                vector3_copy(on_sphere, on);
            }
        }
        if (!isfinite(nearest) || work_stopped())
            return work_check(error);
        if (is_nearest_around(r, place))
            return keep(all, r, outward, on_sphere, gap, error);
        behind = nearest;
    }
    return LMN_OK;
}

lmn_status touch_round(touch_places *all, const touch_pair *pair, bool flips, lmn_error *error)
{
    round_search r = {.pair = pair, .flips = flips};
    if (!inverse_rows(pair->own->radii, r.back))
        return LMN_OK;
    return is_even(pair->own) && is_even(pair->other) ? meet_even(all, &r, error) : meet_mesh(all, &r, error);
}
