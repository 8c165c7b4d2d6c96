/* Bodies on footprints: closed, manifold, looking outwards, of plane faces, and as large as the roof that they should
 * have is by another way of computing, on a thousand footprints of all kinds. */
#include "field_shapes.h"

#include "construct/construct.h"
#include "import/footprint.h"
#include "import/skeleton.h"

#define COUNT(array) (sizeof(array) / sizeof *(array))

enum { FOOTPRINTS = 1000, CORNERS = 160, RINGS = 8, LARGER = 64 };

typedef struct plan {
    double p[CORNERS][2];
    size_t counts[RINGS], rings, total;
} plan;

static uint32_t next_random = 1;
static double   chance(double low, double high)
{
    next_random = next_random * 1664525u + 1013904223u;
    return low + (high - low) * (next_random >> 8) / 16777216.0;
}

/* --- footprints ----------------------------------------------------------------------------------------- */

static void add(plan *f, double x, double y)
{
    f->p[f->total][0] = x;
    f->p[f->total++][1] = y;
    f->counts[f->rings - 1]++;
}

static void turn_and_move(plan *f)
{
    double angle = chance(0, 1) < 0.4 ? 0 : chance(0, 6), c = cos(angle), s = sin(angle), x = chance(-500, 500);
    for (size_t i = 0; i < f->total; i++) {
        double a = f->p[i][0], b = f->p[i][1];
        f->p[i][0] = c * a - s * b + x;
        f->p[i][1] = s * a + c * b;
    }
}

/* Around 0, with deep notches; maybe with a hole like it. */
static void star(plan *f)
{
    for (size_t k = 0, rings = chance(0, 1) < 0.3 ? 2 : 1; k < rings; k++) {
        f->rings++;
        size_t count = (size_t)chance(k == 0 && rings == 2 ? 5 : 3, k ? 8.99 : 24.99);
        for (size_t i = 0; i < count; i++) {
            double angle = (k ? -1 : 1) * 2 * field_pi * ((double)i + chance(0, 0.7)) / (double)count;
            double radius = k ? chance(1, 2) : chance(5, 20);
            add(f, radius * cos(angle), radius * sin(angle));
        }
    }
}

/* Boxes side by side, some higher above and some deeper below: L, T, U, Z and the like. Steps of one, so that much
 * happens at once. */
static void boxes(plan *f)
{
    int    count = (int)chance(1, 5.99);
    double low[6], high[6], x[7] = {0};
    for (int i = 0; i < count; i++) {
        low[i] = -floor(chance(0, 6)) - 1;
        high[i] = floor(chance(0, 9)) + 1;
        x[i + 1] = x[i] + floor(chance(2, 9));
    }
    f->rings = 1;
    for (int i = 0; i < count; i++) {
        if (i == 0 || low[i] != low[i - 1])
            add(f, x[i], low[i]);
        if (i + 1 == count || low[i] != low[i + 1])
            add(f, x[i + 1], low[i]);
    }
    for (int i = count; i-- > 0;) {
        if (i + 1 == count || high[i] != high[i + 1])
            add(f, x[i + 1], high[i]);
        if (i == 0 || high[i] != high[i - 1])
            add(f, x[i], high[i]);
    }
}

/* A block around courtyards. */
static void block(plan *f)
{
    double wide = floor(chance(20, 40)), deep = floor(chance(12, 30));
    int    yards = (int)chance(1, 3.99);
    f->rings = 1;
    add(f, 0, 0);
    add(f, wide, 0);
    if (chance(0, 1) < 0.5)
        add(f, wide, deep);
    else {
        add(f, wide, deep - 3);
        add(f, wide - 3, deep);
    }
    add(f, 0, deep);
    for (int i = 0; i < yards; i++) {
        double from = wide * (i + 0.2) / yards, to = wide * (i + 0.8) / yards, in = floor(chance(3, 5));
        f->rings++;
        add(f, from, in);
        add(f, from, deep - in);
        add(f, to, deep - in);
        add(f, to, in);
    }
}

/* As many sides as slopes that meet in one point. */
static void regular(plan *f)
{
    size_t count = (size_t)chance(3, 20.99);
    f->rings = 1;
    for (size_t i = 0; i < count; i++) {
        double angle = 2 * field_pi * (double)i / (double)count, radius = i % 2 && chance(0, 1) < 0.1 ? 9.99 : 10;
        add(f, radius * cos(angle), radius * sin(angle));
    }
}

/* Corners that hardly are some, edges of a few millimetres, sides that are nearly parallel. */
static void nearly(plan *f)
{
    double a = chance(-0.003, 0.003), b = chance(0.002, 0.02), c = chance(-1e-4, 1e-4);
    f->rings = 1;
    add(f, 0, 0);
    add(f, 7, a);
    add(f, 14, 0);
    add(f, 14, 5);
    add(f, 14 - b, 5);
    add(f, 14 - b, 9 + c);
    add(f, 6, 9);
    add(f, 6 - b / 2, 9 + b);
    add(f, 0, 9 + a);
}

static void make_plan(plan *f, int number)
{
    static void (*const makers[])(plan *) = {star, boxes, boxes, block, nearly, regular, star};
    memset(f, 0, sizeof *f);
    makers[(size_t)number % COUNT(makers)](f);
    turn_and_move(f);
}

/* --- truths --------------------------------------------------------------------------------------------- */

static int compare_edges(const void *a, const void *b)
{
    return memcmp(a, b, 2 * sizeof(uint32_t));
}

/* Each edge of a face is one of just one other face, the other way round: closed, manifold, all faces alike. */
static bool is_closed(const city_shape *s)
{
    static uint32_t edges[16384][2], backs[16384][2];
    size_t          count = 0, first = 0;
    assert_true(s->corner_count <= COUNT(edges));
    for (size_t ring = 0; ring < s->ring_count; first = s->rings[ring++])
        for (size_t i = first; i < s->rings[ring]; i++, count++) {
            edges[count][0] = backs[count][1] = s->corners[i];
            edges[count][1] = backs[count][0] = s->corners[i + 1 < s->rings[ring] ? i + 1 : first];
        }
    qsort(edges, count, sizeof *edges, compare_edges);
    qsort(backs, count, sizeof *backs, compare_edges);
    for (size_t i = 0; i < count; i++)
        if (memcmp(edges[i], backs[i], sizeof *edges) != 0 || (i && memcmp(edges[i - 1], edges[i], sizeof *edges) == 0))
            return false;
    return count > 0;
}

static double volume_of(const city_shape *s, const vec3 *points)
{
    double volume = 0;
    size_t first = 0;
    vec3   o = points[0];
    for (size_t ring = 0; ring < s->ring_count; first = s->rings[ring++])
        for (size_t i = first + 1; i + 1 < s->rings[ring]; i++) {
            vec3   p = points[s->corners[first]], q = points[s->corners[i]], r = points[s->corners[i + 1]];
            double a[3] = {p.x - o.x, p.y - o.y, p.z - o.z}, b[3] = {q.x - o.x, q.y - o.y, q.z - o.z},
                   c[3] = {r.x - o.x, r.y - o.y, r.z - o.z};
            volume += (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                       a[2] * (b[0] * c[1] - b[1] * c[0])) /
                      6;
        }
    return volume;
}

/* How far the corners of a face are from its plane, at most. */
static double unevenness(const city_shape *s, const vec3 *points, size_t face)
{
    double n[3], worst = 0;
    city_normal(points, s, face, n);
    double length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    size_t ring = city_first_ring(s, face), first = city_first_corner(s, ring);
    vec3   middle = {0, 0, 0};
    double count = (double)(s->rings[ring] - first);
    for (size_t i = first; i < s->rings[ring]; i++) {
        vec3 p = points[s->corners[i]];
        middle =
            (vec3){middle.x + (float)(p.x / count), middle.y + (float)(p.y / count), middle.z + (float)(p.z / count)};
    }
    for (size_t i = first; i < s->rings[ring] && length > 0.02; i++) {
        vec3 p = points[s->corners[i]];
        worst =
            fmax(worst, fabs((n[0] * (p.x - middle.x) + n[1] * (p.y - middle.y) + n[2] * (p.z - middle.z)) / length));
    }
    return worst;
}

typedef struct crossing {
    double x, z;
} crossing;

static int compare_crossings(const void *a, const void *b)
{
    double x = ((const crossing *)a)->x, y = ((const crossing *)b)->x;
    return (x > y) - (x < y);
}

/* What one face covers of the line with this y: length, and the area below it down to z = 0. */
static void cut_row(const city_shape *s, const vec3 *points, size_t face, double y, double *length, double *area)
{
    crossing at[CORNERS * 2];
    size_t   count = 0;
    for (size_t ring = city_first_ring(s, face); ring < s->faces[face].ring_end; ring++)
        for (size_t first = city_first_corner(s, ring), i = first; i < s->rings[ring]; i++) {
            vec3 a = points[s->corners[i]], b = points[s->corners[i + 1 < s->rings[ring] ? i + 1 : first]];
            if ((a.y > y) == (b.y > y))
                continue;
            double t = (y - a.y) / (b.y - a.y);
            at[count++] = (crossing){a.x + t * (b.x - a.x), a.z + t * (b.z - a.z)};
        }
    qsort(at, count, sizeof *at, compare_crossings);
    for (size_t i = 0; i + 1 < count; i += 2) {
        *length += at[i + 1].x - at[i].x;
        *area += (at[i + 1].x - at[i].x) * (at[i].z + at[i + 1].z) / 2;
    }
}

/* Row by row: roofs cover what the ground covers, once, and what lies between is the volume. */
static void rows_fit(const city_shape *s, const vec3 *points, size_t count, double volume, const char *name)
{
    enum { ROWS = 160 };
    double low = INFINITY, high = -INFINITY, between = 0, covered[2] = {0, 0};
    for (size_t i = 0; i < count; i++) {
        low = fmin(low, points[i].y);
        high = fmax(high, points[i].y);
    }
    for (int row = 0; row < ROWS; row++) {
        double y = low + (high - low) * (row + 0.4999) / ROWS, length[2] = {0, 0}, area[2] = {0, 0};
        for (size_t f = 0; f < s->face_count; f++) {
            uint8_t word = s->faces[f].word;
            if (word == city_word_of_class("RoofSurface", 11))
                cut_row(s, points, f, y, &length[1], &area[1]);
            else if (word == city_word_of_class("GroundSurface", 13))
                cut_row(s, points, f, y, &length[0], &area[0]);
        }
        if (fabs(length[0] - length[1]) > 0.01 + 0.002 * length[0])
            fail_msg("%s: a roof covers %g of %g", name, length[1], length[0]);
        covered[0] += length[0];
        covered[1] += length[1];
        between += (area[1] - area[0]) * (high - low) / ROWS;
    }
    if (fabs(between - volume) > 0.01 * volume)
        fail_msg("%s: %g between roof and ground, volume %g", name, between, volume);
}

/* --- another way to the height of a hipped roof: moving the outline in, step by step -------------------- */

static double region_area(const region *r)
{
    double area = 0;
    for (size_t k = 0; k < r->count; k++)
        for (size_t i = 0; i < r->contours[k].count; i++) {
            point2 a = r->contours[k].points[i], b = r->contours[k].points[(i + 1) % r->contours[k].count];
            area += (a.x * b.y - b.x * a.y) / 2;
        }
    return area;
}

/* Areas of the outline moved in by step, 2 step …, until none is left; returns how many. As large as it is computed,
 * the grid that regions lie on is fine enough. */
static size_t shrinking_areas(const plan *f, double step, double *areas, size_t most)
{
    contour contours[RINGS];
    region  r = {contours, f->rings}, next;
    size_t  first = 0, count = 0;
    bool    own = false;
    for (size_t k = 0; k < f->rings; first += f->counts[k++]) {
        contours[k] = (contour){mem_calloc(f->counts[k], sizeof(point2)), f->counts[k]};
        for (size_t i = 0; i < f->counts[k]; i++)
            contours[k].points[i] =
                (point2){LARGER * (f->p[first + i][0] - f->p[0][0]), LARGER * (f->p[first + i][1] - f->p[0][1])};
    }
    for (double area = region_area(&r); area > 0 && count < most; area = region_area(&r)) {
        areas[count++] = area / LARGER / LARGER;
        assert_int_equal(region_offset(&next, &r, -step * LARGER, false, false, (facets){0}, NULL), LMN_OK);
        if (own)
            region_release(&r);
        r = next;
        own = true;
    }
    if (own)
        region_release(&r);
    for (size_t k = 0; k < f->rings; k++)
        mem_free(contours[k].points);
    return count;
}

/* The integral of a roof of slope one up to a time, from areas at steps. */
static double integral(const double *areas, size_t count, double step)
{
    double sum = 0;
    for (size_t i = 0; i + 1 < count; i++)
        sum += (areas[i] + areas[i + 1]) / 2 * step;
    return sum + areas[count - 1] * step / 3;
}

/* --- tests ---------------------------------------------------------------------------------------------- */

static void bodies_are_closed(void **state)
{
    (void)state;
    city_shape       shape = {0};
    footprint_points points = {0};
    int              counts[ROOF_FORMS][3] = {{0}};
    next_random = 1;
    for (int n = 0; n < FOOTPRINTS; n++) {
        plan f;
        make_plan(&f, n);
        footprint how = {ROOF_FLAT, chance(0, 5), chance(6, 20), 0};
        how.ridge = how.eaves + chance(1, 6);
        for (int form = 0; form < ROOF_FORMS; form++) {
            roof_made made;
            char      name[64];
            how.roof = (roof_form)form;
            snprintf(name, sizeof name, "footprint %d, roof %d", n, form);
            city_shape_clear(&shape);
            points.count = 0;
            assert_true(footprint_raise(&shape, &points, &how, (const double(*)[2])f.p, f.counts, f.rings, &made));
            if (!is_closed(&shape))
                fail_msg("%s is not closed", name);
            double volume = volume_of(&shape, points.items);
            assert_true(volume > 0);
            for (size_t i = 0; i < shape.face_count; i++)
                if (unevenness(&shape, points.items, i) > 5e-3)
                    fail_msg("%s: face %zu is uneven by %g", name, i, unevenness(&shape, points.items, i));
            if (form != ROOF_ONION && (form >= 1 || n % 4 == 0)) /* onions reach out over their walls */
                rows_fit(&shape, points.items, points.count, volume, name);
            counts[form][made]++;
        }
    }
    for (int form = 0; form < ROOF_FORMS; form++)
        assert_int_equal(counts[form][ROOF_MADE_FLAT], 0);
    assert_true(counts[ROOF_GABLED][ROOF_AS_ASKED] > FOOTPRINTS / 4);
    city_shape_release(&shape);
    mem_free(points.items);
}

static double volume_of_skeleton(const skeleton *s)
{
    double volume = 0;
    for (uint32_t e = 0; e < s->corner_count; e++)
        for (uint32_t first = skeleton_face_first(s, e), i = first; i < s->face_ends[e]; i++) {
            const skeleton_node *a = &s->nodes[e], *b = &s->nodes[i > first ? s->face_nodes[i - 1] : s->ends[e]],
                                *c = &s->nodes[s->face_nodes[i]];
            volume += ((b->x - a->x) * (c->y - a->y) - (b->y - a->y) * (c->x - a->x)) / 2 * (b->time + c->time) / 3;
        }
    return volume;
}

/* A hipped roof of slope one holds the integral of what is left of the outline while its edges move in. Where steps
 * are longer than what they pass over, they have to be shorter. */
static void hips_are_as_high_as_they_should(void **state)
{
    (void)state;
    enum { FEWEST = 30, MOST = 480 };
    static double areas[2 * MOST];
    next_random = 7;
    for (int n = 0; n < FOOTPRINTS / 4; n++) {
        plan     f;
        skeleton s;
        bool     agrees = false;
        double   other = 0;
        make_plan(&f, n);
        assert_int_equal(skeleton_make(&s, (const double(*)[2])f.p, f.counts, f.rings), SKELETON_MADE);
        double volume = volume_of_skeleton(&s);
        for (int steps = FEWEST; steps <= MOST && !agrees; steps *= 2) {
            size_t count = shrinking_areas(&f, s.top / steps, areas, COUNT(areas));
            other = integral(areas, count, s.top / steps);
            agrees = fabs((double)count - steps) <= 1 + 0.01 * steps && fabs(volume - other) < 0.003 * volume;
        }
        if (!agrees)
            fail_msg("footprint %d: volume %g instead of %g", n, volume, other);
        skeleton_release(&s);
    }
}

static void boxes_have_known_roofs(void **state)
{
    (void)state;
    const double box[4][2] = {{0, 0}, {10, 0}, {10, 6}, {0, 6}}, turned[4][2] = {{0, 0}, {6, 0}, {6, 10}, {0, 10}};
    const double high = 3, below = 60 * 5, k = 0.31, r = 3 * k; /* the knee goes round no node */
    /* What is left of the box at the knee, and the frustum below it: 60 − 32 t + 4 t². */
    const double top = (10 - 2 * r) * (6 - 2 * r), under = 60 - 16 * r + 4 * r * r / 3;
    const double in = 6 - 2 * r, hip = in * in / 3 + (10 - 6) * in / 2, lean = 10 * in / 2;
    const double over[] = {60 * high,
                           60 * high / 2,
                           high * (6 * 4 / 2.0 + 6 * 6 / 3.0),
                           60 * high / 3,
                           0.7 * high * under + 0.3 * high * hip,
                           high * under,
                           0.7 * high * (60 - 10 * r) + 0.3 * high * lean,
                           60 * high / 2,
                           60 * high * 2 / 3,   /* of a round one; facets leave out a hundredth */
                           60 * high * 0.6246}; /* frusta between the steps of its profile */
    (void)top;
    city_shape       shape = {0};
    footprint_points points = {0};
    for (int form = 0; form < ROOF_FORMS; form++)
        for (int t = 0; t < 2; t++) {
            const size_t    count = 4;
            const footprint how = {.roof = (roof_form)form, .base = 1, .eaves = 6, .ridge = 9};
            roof_made       made;
            city_shape_clear(&shape);
            points.count = 0;
            assert_true(footprint_raise(&shape, &points, &how, t ? turned : box, &count, 1, &made));
            assert_int_equal(made, ROOF_AS_ASKED);
            if (fabs(volume_of(&shape, points.items) - below - over[form]) > 0.02 * over[form])
                fail_msg("roof %d holds %g instead of %g", form, volume_of(&shape, points.items) - below, over[form]);
        }
    city_shape_release(&shape);
    mem_free(points.items);
}

/* Outlines of which there is no skeleton have flat roofs, and say so. */
static void bad_outlines_are_flat(void **state)
{
    (void)state;
    static const double bow[4][2] = {{0, 0}, {10, 10}, {10, 0}, {0, 12}};
    static const double spike[5][2] = {{0, 0}, {10, 0}, {20, 0}, {10, 0}, {5, 9}};
    static const double touch[8][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 4}, {4, 6}, {6, 5}, {4, 3}};
    static const double outside[7][2] = {{0, 0}, {10, 0}, {10, 10}, {0, 10}, {20, 0}, {20, 5}, {25, 0}};
    static const struct {
        const double (*p)[2];
        size_t counts[2], rings;
    } rows[] = {{bow, {4, 0}, 1}, {spike, {5, 0}, 1}, {touch, {4, 4}, 2}, {outside, {4, 3}, 2}};
    city_shape       shape = {0};
    footprint_points points = {0};
    for (size_t i = 0; i < COUNT(rows); i++) {
        const footprint how = {.roof = ROOF_HIPPED, .base = 0, .eaves = 5, .ridge = 8};
        roof_made       made;
        city_shape_clear(&shape);
        points.count = 0;
        assert_true(footprint_raise(&shape, &points, &how, rows[i].p, rows[i].counts, rows[i].rings, &made));
        if (made != ROOF_MADE_FLAT || !is_closed(&shape))
            fail_msg("outline %zu has a roof", i);
    }
    city_shape_release(&shape);
    mem_free(points.items);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    const double box[8][2] = {{0, 0}, {10, 0}, {10, 6}, {0, 6}, {2, 2}, {2, 4}, {7, 4}, {7, 2}};
    const size_t counts[2] = {4, 4};
    for (int form = 0; form < ROOF_FORMS; form++) {
        const footprint how = {.roof = (roof_form)form, .base = 0, .eaves = 5, .ridge = 8};
        long            n = 1;
        for (; n < 400; n++) {
            city_shape       shape = {0};
            footprint_points points = {0};
            roof_made        made;
            mem_fail_at(n);
            bool done = footprint_raise(&shape, &points, &how, box, counts, 2, &made);
            mem_fail_at(0);
            city_shape_release(&shape);
            mem_free(points.items);
            if (done)
                break;
        }
        assert_true(n > 3 && n < 400);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(bodies_are_closed),      cmocka_unit_test(hips_are_as_high_as_they_should),
        cmocka_unit_test(boxes_have_known_roofs), cmocka_unit_test(bad_outlines_are_flat),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
