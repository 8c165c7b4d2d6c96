/* Ridges and valleys: where the greatest curvature is greatest along its own direction (Ohtake, Belyaev, Seidel
 * 2004). Apparent ridges (Judd, Durand, Adelson 2007): the same for curvature as it is seen, which grows where the
 * surface turns away. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/form_view.h"

/* Curvature times FORM_UNIT from which lines of strength 1 are drawn; it goes with the square of the strength. */
#define RIDGE_LIMIT    10.0
#define APPARENT_LIMIT 20.0
/* What turns away further than this is not seen to bend more: cosine. */
#define STEEPEST 0.05
/* Towards the outline ridges fade, so as not to run beside it: between this cosine and twice of it. */
#define RIM 0.12

/* At a knot: what is greatest on the line, along which way, and how it changes that way. */
typedef struct crest {
    double3 direction; /* its sign has no meaning, but that of the change goes with it */
    double  height, change;
    double  edge; /* by how much more it bends this way than across; on a ball no way is better than another */
} crest;

typedef struct crest_finder {
    form_view   *f;
    stroke_class kind;
    crest       *crests; /* per knot */
    double       unit, limit;
} crest_finder;

static double dot(double3 a, double3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static double3 cross(double3 a, double3 b)
{
    return (double3){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static double3 sum(double3 a, double s, double3 b)
{
    return (double3){a.x + s * b.x, a.y + s * b.y, a.z + s * b.z};
}

static double3 of_floats(vec3 p)
{
    return (double3){p.x, p.y, p.z};
}

/* --- ridges and valleys --------------------------------------------------------------------------------- */

/* `hollow`: of the surface seen from the other side, where valleys are ridges. */
static crest crest_of(const form_surface *s, uint32_t knot, bool hollow)
{
    const surface_bend *b = &s->bends[knot];
    double3             d = of_floats(b->direction);
    if (!hollow)
        return (crest){d, b->greater, b->change[0], b->greater - fabsf(b->lesser)};
    return (crest){cross(of_floats(s->normals[knot]), d), -b->lesser, -b->change[3], -b->lesser - fabsf(b->greater)};
}

/* --- apparent ridges ------------------------------------------------------------------------------------ */

/* What the normal turns by, at most, over a step on the page: in the direction towards the eye, steps on the
 * surface are longer than on the page. */
static crest apparent_at(const form_view *f, uint32_t knot)
{
    const surface_bend *b = &f->s->bends[knot];
    double3             n = of_floats(f->s->normals[knot]), d = of_floats(b->direction), e = cross(n, d);
    double3 to = form_direction(f, of_floats(f->m->positions[f->s->vertices[knot]])), w = sum(to, -f->facing[knot], n);
    double  length = sqrt(dot(w, w)), stretch = 1 / fmax(fabs(f->facing[knot]), STEEPEST);
    double3 a = length > 1e-3 ? (double3){w.x / length, w.y / length, w.z / length} : d, c = cross(n, a);
    double  ad = dot(a, d), ae = dot(a, e), cd = dot(c, d), ce = dot(c, e);
    double  aa = b->greater * ad * ad + b->lesser * ae * ae, ac = b->greater * ad * cd + b->lesser * ae * ce,
           cc = b->greater * cd * cd + b->lesser * ce * ce;
    double xx = (aa * aa + ac * ac) * stretch * stretch, xy = ac * (aa + cc) * stretch, yy = ac * ac + cc * cc;
    double angle = 0.5 * atan2(2 * xy, xx - yy), spread = sqrt((xx - yy) * (xx - yy) + 4 * xy * xy),
           most = sqrt(0.5 * (xx + yy + spread)), least = sqrt(fmax(0.5 * (xx + yy - spread), 0));
    double3 direction = {0, 0, 0};
    direction = sum(direction, cos(angle) * stretch, a);
    return (crest){sum(direction, sin(angle), c), most, 0, most - least};
}

/* How the height changes along its way, from its slopes over the faces around. */
static bool find_changes(crest_finder *w)
{
    const form_view *f = w->f;
    double3         *slopes = mem_calloc((size_t)f->s->knot_count + 1, sizeof *slopes);
    double          *weights = mem_calloc((size_t)f->s->knot_count + 1, sizeof *weights);
    for (uint32_t face = 0; face < f->s->face_count && slopes && weights; face++) {
        const uint32_t *knots = f->s->corners[face];
        double3         p = form_position(f, face, 0), u = sum(form_position(f, face, 1), -1, p),
                v = sum(form_position(f, face, 2), -1, p), n = cross(u, v);
        double square = dot(n, n), du = w->crests[knots[1]].height - w->crests[knots[0]].height,
               dv = w->crests[knots[2]].height - w->crests[knots[0]].height;
        if (!(square > 0))
            continue;
        double3 slope = {0, 0, 0}; /* times the square of the area, of which one root is the weight */
        slope = sum(slope, du, cross(v, n));
        slope = sum(slope, dv, cross(n, u));
        double area = sqrt(square);
        for (int k = 0; k < 3; k++) {
            slopes[knots[k]] = sum(slopes[knots[k]], 1 / area, slope);
            weights[knots[k]] += area;
        }
    }
    bool good = slopes && weights;
    for (uint32_t i = 0; i < f->s->knot_count && good; i++)
        w->crests[i].change = weights[i] > 0 ? dot(slopes[i], w->crests[i].direction) / weights[i] : 0;
    mem_free(slopes);
    mem_free(weights);
    return good;
}

/* --- lines ---------------------------------------------------------------------------------------------- */

/* Where the change passes through 0 over a face: is the height greatest there, not least? Then the change falls
 * along its way. */
static bool is_greatest(const form_view *f, uint32_t face, const crest c[3])
{
    double3 p = form_position(f, face, 0), u = sum(form_position(f, face, 1), -1, p),
            v = sum(form_position(f, face, 2), -1, p), n = cross(u, v), slope = {0, 0, 0};
    slope = sum(slope, c[1].change - c[0].change, cross(v, n));
    slope = sum(slope, c[2].change - c[0].change, cross(n, u));
    return dot(slope, c[0].direction) + dot(slope, c[1].direction) + dot(slope, c[2].direction) < 0;
}

/* An end where the crest crosses a side of a face. */
static bool find_end(crest_finder *w, uint32_t half, const crest *a, const crest *b, int side, form_end *out)
{
    form_view *f = w->f;
    if ((a->change >= 0) == (b->change >= 0))
        return false;
    double fraction;
    *out = form_cross(f, half, a->change, b->change, &fraction);
    double p = f->facing[f->s->corners[half / 3][half % 3]], q = f->facing[f->s->corners[half / 3][(half + 1) % 3]];
    double rim = (side * (p + fraction * (q - p)) - RIM) / RIM,
           edge = (a->edge + fraction * (b->edge - a->edge)) * w->unit;
    float weight = form_fade(edge, w->limit);
    out->weight = weight < 0 || rim > 1 ? weight : rim < 0 ? (float)rim : weight * (float)rim;
    return true;
}

static bool take_face(crest_finder *w, uint32_t face, int side)
{
    form_view *f = w->f;
    crest      c[3];
    form_end   ends[3];
    int        count = 0;
    for (int k = 0; k < 3; k++) {
        uint32_t knot = f->s->corners[face][k];
        c[k] = w->kind == STROKE_APPARENT ? w->crests[knot]
                                          : crest_of(f->s, knot, (w->kind == STROKE_VALLEY) == (side > 0));
        if (c[k].edge <= 0)
            return true;
        if (k > 0 && dot(c[k].direction, c[0].direction) < 0)
            c[k] = (crest){
                {-c[k].direction.x, -c[k].direction.y, -c[k].direction.z}, c[k].height, -c[k].change, c[k].edge};
    }
    for (uint32_t k = 0; k < 3; k++)
        count += find_end(w, 3 * face + k, &c[k], &c[(k + 1) % 3], side, &ends[count]);
    return count < 2 || !is_greatest(f, face, c) || form_put(f, w->kind, face, ends[0], ends[1], false);
}

bool ridges_collect(form_view *f, stroke_class kind, double strength)
{
    crest_finder w = {.f = f,
                      .kind = kind,
                      .unit = FORM_UNIT * f->s->size,
                      .limit = (kind == STROKE_APPARENT ? APPARENT_LIMIT : RIDGE_LIMIT) * strength * strength};
    bool         good = true;
    if (kind == STROKE_APPARENT) {
        w.crests = mem_alloc(((size_t)f->s->knot_count + 1) * sizeof *w.crests);
        good = w.crests != NULL;
        for (uint32_t i = 0; i < f->s->knot_count && good; i++)
            w.crests[i] = apparent_at(f, i);
        good = good && find_changes(&w);
    }
    for (uint32_t face = 0; face < f->s->face_count && good; face++) {
        int side = form_side(f, face);
        good = !side || take_face(&w, face, side);
    }
    mem_free(w.crests);
    return good;
}
