/* Lines along the form: how evenly they lie, that those of one set never cross, that finer levels leave coarser ones as
 * they are, and how wide they are drawn. */
#include "field_shapes.h"

#include "marks/streamlines.h"

typedef struct shape {
    primitive    p;
    mark_surface surface;
    vec3        *normals;
} shape;

static shape with_normals(primitive p)
{
    shape    s = {.p = p, .normals = mem_calloc(p.vertex_count, sizeof *s.normals)};
    uint32_t count = p.index_count / 3;
    for (uint32_t t = 0; t < count; t++) {
        const uint32_t *k = p.indices + 3 * t;
        vec3            a = p.positions[k[0]], b = p.positions[k[1]], c = p.positions[k[2]];
        vec3            u = {b.x - a.x, b.y - a.y, b.z - a.z}, v = {c.x - a.x, c.y - a.y, c.z - a.z};
        vec3            n = {u.y * v.z - u.z * v.y, u.z * v.x - u.x * v.z, u.x * v.y - u.y * v.x};
        for (int i = 0; i < 3; i++) {
            vec3 *to = &s.normals[k[i]];
            *to = (vec3){to->x + n.x, to->y + n.y, to->z + n.z};
        }
    }
    for (uint32_t v = 0; v < p.vertex_count; v++) {
        vec3 *n = &s.normals[v];
        float l = sqrtf(n->x * n->x + n->y * n->y + n->z * n->z);
        *n = l > 0 ? (vec3){n->x / l, n->y / l, n->z / l} : (vec3){0, 0, 1};
    }
    s.surface = (mark_surface){.positions = p.positions,
                               .normals = s.normals,
                               .indices = p.indices,
                               .vertex_count = p.vertex_count,
                               .triangle_count = count};
    return s;
}

static void release_shape(shape *s)
{
    primitive_release(&s->p);
    mem_free(s->normals);
}

static marks make_lines(const shape *s, double apart, int levels, int series)
{
    marks        m;
    flow_options options = {
        .apart = apart, .levels = levels, .series = series, .turn = 0.9f, .sag = apart / 20, .seed = 3};
    assert_int_equal(marks_streamlines(&m, &s->surface, &options, NULL), LMN_OK);
    return m;
}

static double product3(place3 a, place3 b)
{
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

static place3 from_to(vec3 a, vec3 b)
{
    return (place3){(double)b.x - a.x, (double)b.y - a.y, (double)b.z - a.z};
}

/* Does a piece lie beyond where its line runs out? Nothing is drawn of it but where lines join. */
static bool lies_beyond(const mark_line *l)
{
    return !(l->ends[0].to_end > 0) && !(l->ends[1].to_end > 0);
}

/* How far the nearest other line to one side is from the middle of a piece; straight through space. */
static double gap_beside(const marks *m, size_t own, double side, double reach)
{
    const mark_line *l = &m->lines[own];
    vec3             middle = {(l->a.x + l->b.x) / 2, (l->a.y + l->b.y) / 2, (l->a.z + l->b.z) / 2};
    place3           along = from_to(l->a, l->b), n = {l->normal.x, l->normal.y, l->normal.z};
    double           size = sqrt(product3(along, along)), best = INFINITY;
    along = (place3){along.x / size, along.y / size, along.z / size};
    place3 aside = {n.y * along.z - n.z * along.y, n.z * along.x - n.x * along.z, n.x * along.y - n.y * along.x};
    for (size_t i = 0; i < m->line_count; i++) {
        const mark_line *o = &m->lines[i];
        place3           a = from_to(middle, o->a), b = from_to(middle, o->b);
        if (o->set != l->set || o->stroke == l->stroke || lies_beyond(o) || product3(a, a) > 4 * reach * reach)
            continue;
        /* Where it crosses the plane across the piece. */
        double from = product3(a, along), to = product3(b, along);
        if ((from < 0) == (to < 0))
            continue;
        double t = from / (from - to);
        place3 at = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y), a.z + t * (b.z - a.z)};
        double off = sqrt(product3(at, at));
        if (side * product3(at, aside) > 0 && off < best && off < reach)
            best = off;
    }
    return best;
}

static int by_size(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The strips of pieces that have lines on both sides, in distances. */
static void check_spacing(const char *name, shape s, double apart, double least_share)
{
    marks   m = make_lines(&s, apart, 4, 1);
    double *strips = mem_alloc(m.line_count * sizeof *strips), sum = 0, even = 0;
    size_t  count = 0;
    for (size_t i = 0; i < m.line_count; i += 7) {
        if (lies_beyond(&m.lines[i]))
            continue;
        double left = gap_beside(&m, i, 1, 2.5 * apart), right = gap_beside(&m, i, -1, 2.5 * apart);
        if (isfinite(left) && isfinite(right))
            strips[count++] = (left + right) / 2 / apart;
    }
    assert_true(count > 200);
    qsort(strips, count, sizeof *strips, by_size);
    for (size_t i = 0; i < count; i++) {
        sum += strips[i] / (double)count;
        even += fabs(strips[i] - 1) <= 0.15 ? 1.0 / (double)count : 0;
    }
    printf("%s: %zu lines, strips of %zu pieces: mean %.3f, 5 %% %.2f, median %.2f, 95 %% %.2f; %.1f %% within 15 %%\n",
           name, m.stroke_count, count, sum, strips[count / 20], strips[count / 2], strips[count * 19 / 20],
           100 * even);
    assert_true(fabs(sum - 1) <= 0.15 && fabs(strips[count / 2] - 1) <= 0.15);
    assert_true(strips[count / 20] >= 0.6 && strips[count * 19 / 20] <= 1.6 && even >= least_share);
    mem_free(strips);
    surface_marks_release(&m);
    release_shape(&s);
}

static void lines_keep_their_distance(void **state)
{
    (void)state;
    const place3 axes = {3, 2, 1};
    check_spacing("cylinder", with_normals(grid_surface(cylinder_at, 64, 40, true, false, 0.3)), 0.08, 0.8);
    check_spacing("torus", with_normals(grid_surface(torus_at, 96, 40, true, true, 0.3)), 0.12, 0.45);
    check_spacing("ellipsoid", with_normals(ball(24, 0.3, axes)), 0.08, 0.45);
}

/* Two balls that a short, oval neck joins askew. */
static place3 neck_at(double u, double v)
{
    double angle = 2 * field_pi * u, along = 4 * v - 2, ball = fabs(along) - 1.05,
           r = sqrt(fmax(1 - fmin(ball * ball, 1), 0.16)), wide = 1 + 0.5 * exp(-9 * along * along);
    return (place3){wide * r * cos(angle), r * sin(angle) / wide, along + 0.3 * r * cos(angle)};
}

/* Where field and form leave wide gaps short lines fill them: neighbours that swelled to fill them would be bars. */
static double share_of_gaps(double apart)
{
    shape  s = with_normals(grid_surface(neck_at, 64, 64, true, false, 0.3));
    marks  m = make_lines(&s, apart, 4, 1);
    size_t wide = 0, count = 0;
    for (size_t i = 0; i < m.line_count; i += 2)
        for (int side = -1; side <= 1; side += 2) {
            double gap = lies_beyond(&m.lines[i]) ? INFINITY : gap_beside(&m, i, side, 3.5 * apart);
            count += isfinite(gap);
            wide += isfinite(gap) && gap > 2.3 * apart;
        }
    printf("neck: %zu of %zu gaps beside lines are wide\n", wide, count);
    surface_marks_release(&m);
    release_shape(&s);
    return (double)wide / (double)count;
}

static void short_lines_fill_gaps(void **state)
{
    (void)state;
    double share = 0;
    for (int k = 0; k < 3; k++)
        share += share_of_gaps(0.09 + 0.03 * k) / 3;
    assert_true(share < 0.018);
}

/* --- crossings ------------------------------------------------------------------------------------------ */

/* On a torus, by both of its angles. */
static void angles_of(vec3 p, const double near[2], double out[2])
{
    out[0] = atan2((double)p.y, (double)p.x);
    out[1] = atan2((double)p.z, hypot((double)p.x, (double)p.y) - 3);
    for (int k = 0; k < 2; k++)
        out[k] = near ? near[k] + remainder(out[k] - near[k], 2 * field_pi) : out[k];
}

static double side_of(const double a[2], const double b[2], const double c[2])
{
    return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

static bool cross_each_other(const mark_line *one, const mark_line *other)
{
    double a[2], b[2], c[2], d[2];
    angles_of(one->a, NULL, a);
    angles_of(one->b, a, b);
    angles_of(other->a, a, c);
    angles_of(other->b, c, d);
    return side_of(a, b, c) * side_of(a, b, d) < 0 && side_of(c, d, a) * side_of(c, d, b) < 0;
}

static void lines_of_a_set_never_cross(void **state)
{
    (void)state;
    shape  s = with_normals(grid_surface(torus_at, 96, 40, true, true, 0.5));
    marks  m = make_lines(&s, 0.2, 3, 2);
    size_t within = 0, between = 0;
    for (size_t i = 0; i < m.line_count; i++)
        for (size_t k = i + 1; k < m.line_count; k++) {
            const mark_line *a = &m.lines[i], *b = &m.lines[k];
            if (fabsf(a->a.x - b->a.x) > 0.5f || fabsf(a->a.y - b->a.y) > 0.5f || fabsf(a->a.z - b->a.z) > 0.5f ||
                a->stroke == b->stroke || lies_beyond(a) || lies_beyond(b) || !cross_each_other(a, b))
                continue;
            within += a->set == b->set;
            between += a->set != b->set;
        }
    printf("torus: %zu pieces, %zu crossings within sets, %zu between\n", m.line_count, within, between);
    assert_int_equal(within, 0);
    assert_true(between > 1000);
    surface_marks_release(&m);
    release_shape(&s);
}

/* --- what goes on --------------------------------------------------------------------------------------- */

/* Half a tube between two flat flanks that touch it: 2 + π + 2 long, up, round and down. */
static place3 arch_at(double u, double v)
{
    double along = u * (4 + field_pi), angle = fmin(fmax(along - 2, 0), field_pi);
    double x = -cos(angle), y = along < 2 ? along - 2 : along > 2 + field_pi ? 2 + field_pi - along : sin(angle);
    return (place3){x, y, 5 * v};
}

/* Nothing of the form ends where a flank, which has one direction for all of it, begins: no line does either. */
static void lines_go_on_from_what_bends_to_what_is_flat(void **state)
{
    (void)state;
    shape        s = with_normals(grid_surface(arch_at, 100, 40, false, false, 0.1));
    marks        m;
    flow_options options = {.apart = 0.2, .levels = 1, .series = 1, .sag = 0.002, .seed = 1};
    size_t       ends = 0, over = 0;
    assert_int_equal(marks_streamlines(&m, &s.surface, &options, NULL), LMN_OK);
    for (size_t i = 0; i < m.line_count; i++) {
        const mark_line *l = &m.lines[i];
        bool             begins = i == 0 || m.lines[i - 1].stroke != l->stroke,
             ends_here = i + 1 == m.line_count || m.lines[i + 1].stroke != l->stroke;
        ends += begins && fabsf(l->a.y) < 0.1f;
        ends += ends_here && fabsf(l->b.y) < 0.1f;
        over += (l->a.y < 0) != (l->b.y < 0);
    }
    printf("arch: %zu lines, %zu cross from bent to flat, %zu end there\n", m.stroke_count, over, ends);
    assert_true(over >= 30);
    assert_int_equal(ends, 0);
    surface_marks_release(&m);
    release_shape(&s);
}

static place3 ribbon_at(double u, double v)
{
    return (place3){40 * u, 0.5 * v, 0};
}

/* On a ribbon that is narrower than lines are apart they lie across it one beside the other, as on a chamfer. */
static void narrow_faces_have_lines(void **state)
{
    (void)state;
    shape        s = with_normals(grid_surface(ribbon_at, 40, 2, false, false, 0));
    marks        m;
    flow_options options = {.apart = 1, .levels = 1, .series = 2, .turn = 1.5707963f, .sag = 0.01, .seed = 1};
    size_t       across = 0;
    assert_int_equal(marks_streamlines(&m, &s.surface, &options, NULL), LMN_OK);
    for (size_t i = 0; i < m.line_count; i++)
        across += m.lines[i].set == 1 && (i == 0 || m.lines[i - 1].stroke != m.lines[i].stroke);
    printf("ribbon: %zu lines across\n", across);
    assert_true(across >= 34 && across <= 46);
    surface_marks_release(&m);
    release_shape(&s);
}

/* Where so much is covered that lines join they do not run out, where it is light they do. */
static void ends_run_out_where_it_is_light(void **state)
{
    (void)state;
    for (int k = 0; k <= 10; k++) {
        double away = 0.3 * k, bare = pow(fmin(away / 2.5, 1), 0.7);
        assert_true(fabs(mark_flow_tip(away, 2.5, 0.7, 0.25, 0.5) - bare) < 1e-12);
        assert_true(mark_flow_tip(away, 2.5, 0.7, 0.5, 0.5) == 1 && mark_flow_tip(away, 2.5, 0.7, 0.9, 0.5) == 1);
        double between = mark_flow_tip(away, 2.5, 0.7, 0.375, 0.5);
        assert_true(fabs(between - (1 + bare) / 2) < 1e-12);
    }
    assert_true(mark_flow_tip(0, 0, 1, 0, 1) == 0 && mark_flow_tip(1e-6, 0, 1, 0, 1) == 1);
}

/* --- ends ----------------------------------------------------------------------------------------------- */

/* On a cone lines towards its tip come together: they must end, each somewhere else. */
static place3 horn_at(double u, double v)
{
    double a = 2 * field_pi * u, r = 0.2 + 0.3 * v;
    return (place3){r * cos(a), 6 * v, r * sin(a)};
}

static void ends_do_not_line_up(void **state)
{
    (void)state;
    enum { BINS = 40 };
    shape  s = with_normals(grid_surface(horn_at, 96, 60, true, false, 0.2));
    marks  m;
    size_t ends[BINS] = {0}, most = 0, count = 0;
    /* Turned by a right angle lines run along it. */
    flow_options options = {.apart = 0.05, .levels = 1, .series = 2, .turn = 1.5707963f, .sag = 0.002, .seed = 1};
    assert_int_equal(marks_streamlines(&m, &s.surface, &options, NULL), LMN_OK);
    for (size_t i = 0; i < m.line_count; i++) {
        const mark_line *l = &m.lines[i];
        for (int end = 0; end < 2; end++) {
            bool outer = end ? i + 1 == m.line_count || m.lines[i + 1].stroke != l->stroke
                             : i == 0 || m.lines[i - 1].stroke != l->stroke;
            if (l->set != 1 || !outer || l->ends[end].to_end > 0)
                continue;
            int bin = (int)((double)(end ? l->b.y : l->a.y) / 6 * BINS);
            ends[bin < 0 ? 0 : bin >= BINS ? BINS - 1 : bin]++;
            count++;
        }
    }
    for (int i = 0; i < BINS; i++)
        most = ends[i] > most ? ends[i] : most;
    printf("horn: %zu ends, at most %zu in a %dth of its length\n", count, most, BINS);
    assert_true(count >= 10 && most <= count / 3);
    surface_marks_release(&m);
    release_shape(&s);
}

/* --- levels --------------------------------------------------------------------------------------------- */

static void levels_leave_earlier_ones_alone(void **state)
{
    (void)state;
    shape  s = with_normals(grid_surface(torus_at, 64, 32, true, true, 0.4));
    marks  coarse = make_lines(&s, 0.4, 2, 1), fine = make_lines(&s, 0.1, 4, 1);
    size_t k = 0;
    assert_true(fabs(coarse.apart - fine.apart) < 1e-12 && fine.line_length > 3 * coarse.line_length);
    /* Lines of both begin and end at the same positions; pieces differ, as finer ones are shorter. */
    for (size_t i = 0; i < coarse.line_count; i++) {
        if (i > 0 && coarse.lines[i - 1].stroke == coarse.lines[i].stroke)
            continue;
        while (k < fine.line_count && (k > 0 && fine.lines[k - 1].stroke == fine.lines[k].stroke))
            k++;
        assert_true(k < fine.line_count);
        assert_memory_equal(&coarse.lines[i].a, &fine.lines[k].a, sizeof(vec3));
        assert_int_equal(coarse.lines[i].level, fine.lines[k].level);
        assert_true(coarse.lines[i].rank == fine.lines[k].rank);
        k++;
    }
    /* What is drawn at a density is there at each higher one. */
    for (size_t i = 0; i < fine.line_count; i++) {
        bool drawn = false;
        for (double level = 0; level < 4; level += 0.1) {
            bool now =
                mark_flow_width(&fine.lines[i], fine.lines[i].ends[0].spaces, fine.apart, fine.levels, level, 0.5) > 0;
            assert_true(now || !drawn);
            drawn = now;
        }
        assert_true(drawn);
    }
    surface_marks_release(&coarse);
    surface_marks_release(&fine);
    release_shape(&s);
}

/* Lines side by side cover what they shall, however many levels of them are there, and while more come. */
static void width_keeps_the_tone(void **state)
{
    (void)state;
    enum { LEVELS = 6, LINES = 1 << (LEVELS - 1) };
    double worst = 0;
    for (double level = -1; level < LEVELS; level += 0.07) {
        double covered = 0, wanted = 0.4, shares = 0;
        for (int draw = 0; draw < 400; draw++)
            for (int i = 0; i < LINES; i++) {
                mark_line l = {.level = 0};
                int       low = i ? i & -i : LINES;
                while ((low << l.level) < LINES)
                    l.level++;
                if (l.level > 0)
                    l.rank = (float)(l.level - 0.9 + FLOW_UNEVEN * hashed((uint32_t)(draw * LINES + i)));
                const float even[FLOW_SPACES] = {1, 1, 1, 1};
                covered += mark_flow_width(&l, even, 2, LEVELS, level, wanted) / 2 / 400;
            }
        shares = covered / wanted;
        worst = fmax(worst, fabs(shares - 1));
    }
    printf("tone is within %.1f %% at any level\n", 100 * worst);
    assert_true(worst < 0.01);
    /* Sets share it. */
    for (int series = 1; series <= 4; series++)
        for (double dark = 0; dark <= 1.001; dark += 0.05) {
            double bare = 1;
            for (int set = 0; set < series; set++)
                bare *= 1 - mark_cover_of_set(dark, 0.55, set, series, false);
            assert_true(fabs(1 - bare - fmin(dark, 1)) < 1e-9);
        }
    /* Steady ones, too, one after the other. */
    for (int series = 1; series <= 4; series++)
        for (double dark = 0; dark <= 1.001; dark += 0.05) {
            double bare = 1, before = 0.3;
            for (int set = 0; set < series; set++) {
                double cover = mark_cover_of_set(dark, 0.3, set, series, true);
                assert_true(set + 1 == series || cover <= 0.3);
                assert_true(cover == 0 || before == 0.3);
                bare *= 1 - cover;
                before = cover;
            }
            assert_true(fabs(1 - bare - fmin(dark, 1)) < 1e-9);
        }
}

/* --- groups and rooms ----------------------------------------------------------------------------------- */

enum { PLANE_LENGTH = 3 };

static marks make_on_plane(const shape *s, double groups, float uneven)
{
    marks        m;
    flow_options options = {.apart = 0.02,
                            .levels = 1,
                            .series = 1,
                            .sag = 0.001,
                            .seed = 3,
                            .length = 0.5,
                            .uneven = uneven,
                            .groups = groups,
                            .overlap = 0.3};
    assert_int_equal(marks_streamlines(&m, &s->surface, &options, NULL), LMN_OK);
    return m;
}

/* Where strokes begin, but for those that begin at the plane's border. */
static size_t beginnings(const marks *m, bool grouped, vec3 *out)
{
    size_t count = 0;
    for (size_t i = 0; i < m->line_count; i++)
        for (int end = 0; end < 2; end++) {
            const mark_line *l = &m->lines[i];
            bool             begins = grouped ? l->ends[end].drawn == 0 : end == 0 && l->from == 0;
            vec3             at = end ? l->b : l->a;
            if (begins && at.x > 0.05f && at.x < PLANE_LENGTH - 0.05f && at.z > 0.05f && at.z < 0.95f)
                out[count++] = at;
        }
    return count;
}

/* How far the beginnings of strokes on the next lines are from each, along them: the median of the nearest. */
static double apart_along(const marks *m, bool grouped)
{
    vec3   *at = mem_alloc(2 * m->line_count * sizeof *at);
    double *off = mem_alloc(2 * m->line_count * sizeof *off);
    size_t  count = beginnings(m, grouped, at), kept = 0;
    place3  way = from_to(m->lines[0].a, m->lines[0].b);
    bool    along_x = fabs(way.x) > fabs(way.z);
    for (size_t i = 0; i < count; i++) {
        double best = INFINITY;
        for (size_t k = 0; k < count; k++) {
            double dx = fabs((double)at[i].x - (double)at[k].x), dz = fabs((double)at[i].z - (double)at[k].z);
            double along = along_x ? dx : dz, across = along_x ? dz : dx;
            if (across > 0.01 && across < 0.03)
                best = fmin(best, along);
        }
        if (isfinite(best))
            off[kept++] = best;
    }
    assert_true(kept > 60);
    qsort(off, kept, sizeof *off, by_size);
    double median = off[kept / 2];
    mem_free(at);
    mem_free(off);
    return median;
}

static void groups_begin_together(void **state)
{
    (void)state;
    shape  s = with_normals(grid_surface(plane_at, 60, 20, false, false, 0));
    marks  alone = make_on_plane(&s, 0, 0), grouped = make_on_plane(&s, 0.6, 0);
    double one = apart_along(&alone, false), many = apart_along(&grouped, true);
    printf("plane: strokes beside each other begin %.3f from each other, in groups %.3f\n", one, many);
    assert_true(one > 0.05 && many < 0.02);
    surface_marks_release(&alone);
    surface_marks_release(&grouped);
    release_shape(&s);
}

/* Groups share out the ink: as much as without them, though they overlap, and begin firm and fade. */
static void groups_keep_the_ink(void **state)
{
    (void)state;
    shape  s = with_normals(grid_surface(plane_at, 60, 20, false, false, 0));
    marks  made[2] = {make_on_plane(&s, 0, 0.8f), make_on_plane(&s, 0.6, 0.8f)};
    double ink[2] = {0, 0}, firm = 0, faint = 0;
    for (int k = 0; k < 2; k++)
        for (size_t i = 0; i < made[k].line_count; i++) {
            const mark_line *l = &made[k].lines[i];
            for (int end = 0; end < 2; end++) {
                const flow_end *e = &l->ends[end];
                double          hand = mark_flow_hand(l, e, 0.8, 0);
                ink[k] += 0.5 * ((double)l->to - (double)l->from) * (double)e->spaces[0] * hand;
                assert_true(e->drawn >= 0 && e->drawn <= 1 && fabsf(e->shift) <= 1.1f && fabsf(l->group) <= 1);
                firm = fmax(firm, hand);
                faint = fmin(faint, hand - 1);
            }
        }
    printf("plane: %.2f of the ink in groups\n", ink[1] / ink[0]);
    assert_true(made[1].line_length > 1.1 * made[0].line_length);
    assert_true(fabs(ink[1] / ink[0] - 1) < 0.03 && fabs(firm - 1.8) < 1e-6 && fabs(faint + 0.8) < 1e-6);
    for (int k = 0; k < 2; k++)
        surface_marks_release(&made[k]);
    release_shape(&s);
}

/* A box of 10 by 4 by 1, and a ring of radius 1 that is half as high. */
static void rooms_are_as_broad_as_faces(void **state)
{
    (void)state;
    static const double expected[6] = {4, 4, 1, 1, 1, 1};
    size_t              seen[6] = {0};
    primitive           cube = shared_cube();
    for (uint32_t v = 0; v < cube.vertex_count; v++)
        cube.positions[v] = (vec3){10 * cube.positions[v].x, 4 * cube.positions[v].y, cube.positions[v].z};
    shape box = with_normals(cube);
    marks m = make_lines(&box, 0.1, 1, 1);
    for (size_t i = 0; i < m.line_count; i++) {
        uint32_t face = m.lines[i].triangle / 2;
        seen[face]++;
        assert_true(fabs((double)m.lines[i].ends[0].room - expected[face]) < 1e-4);
    }
    for (int face = 0; face < 6; face++)
        assert_true(seen[face] > 5);
    surface_marks_release(&m);
    release_shape(&box);
    primitive tube = grid_surface(cylinder_at, 64, 4, true, false, 0);
    for (uint32_t v = 0; v < tube.vertex_count; v++)
        tube.positions[v].z *= 0.1f;
    shape ring = with_normals(tube);
    m = make_lines(&ring, 0.05, 1, 1);
    assert_true(m.line_count > 20);
    for (size_t i = 0; i < m.line_count; i++)
        assert_true(fabs((double)m.lines[i].ends[0].room - 1) < 1e-3);
    surface_marks_release(&m);
    release_shape(&ring);
    assert_true(mark_flow_room(1.9, 4) == 0 && mark_flow_room(4, 4) == 1 && mark_flow_room(0.1, 0) == 1);
    assert_true(fabs(mark_flow_room(3, 4) - 0.5) < 1e-12);
}

/* --- what always holds ---------------------------------------------------------------------------------- */

static void barely_meshes_have_lines(void **state)
{
    (void)state;
    for (uint32_t kind = 0; kind < 4; kind++) {
        primitive p = empty_primitive(20, 300);
        for (uint32_t v = 0; v < 20 && kind > 0; v++)
            p.positions[v] = (vec3){(float)rint(3 * hashed(v)), (float)rint(3 * hashed(v + 100)),
                                    kind > 1 ? (float)rint(2 * hashed(v + 200)) : 0};
        for (uint32_t i = 0; i < 300; i++)
            p.indices[i] = kind == 3 ? i % 3 : (uint32_t)(hashed(i + 1000) * 19.99);
        shape        s = with_normals(p);
        marks        m;
        flow_options options = {.apart = 0.1,
                                .levels = 3,
                                .series = 2,
                                .turn = 0.9f,
                                .sag = 0.005,
                                .length = kind * 0.2,
                                .groups = 0.7,
                                .overlap = 0.3};
        assert_int_equal(marks_streamlines(&m, &s.surface, &options, NULL), LMN_OK);
        for (size_t i = 0; i < m.line_count; i++)
            assert_true(isfinite(m.lines[i].a.x + m.lines[i].b.y + m.lines[i].ends[0].spaces[0] + m.lines[i].rank +
                                 m.lines[i].ends[0].room + m.lines[i].ends[1].shift + m.lines[i].ends[0].drawn));
        surface_marks_release(&m);
        release_shape(&s);
    }
}

static void the_same_lines_twice(void **state)
{
    (void)state;
    shape s = with_normals(grid_surface(torus_at, 48, 20, true, true, 0.4));
    marks a = make_lines(&s, 0.1, 3, 2), b = make_lines(&s, 0.1, 3, 2);
    assert_int_equal(a.line_count, b.line_count);
    for (size_t i = 0; i < a.line_count; i++) {
        assert_memory_equal(&a.lines[i].a, &b.lines[i].a, 2 * sizeof(vec3));
        assert_memory_equal(&a.lines[i].ends, &b.lines[i].ends, sizeof a.lines[i].ends);
    }
    surface_marks_release(&a);
    surface_marks_release(&b);
    release_shape(&s);
}

/* The angle between pieces of the first set and an axis, degrees, the greatest and least of those on faces whose
 * normal is along `z`. */
static void angles_on(const marks *m, bool flat, double *least, double *most)
{
    *least = 90;
    *most = 0;
    for (size_t i = 0; i < m->line_count; i++) {
        const mark_line *l = &m->lines[i];
        place3           along = from_to(l->a, l->b);
        double           size = sqrt(product3(along, along));
        if (l->set != 0 || size == 0 || (fabs((double)l->normal.z) > 0.999) != flat)
            continue;
        double angle = acos(fmin(fabs(flat ? along.x : along.z) / size, 1)) * (180 / 3.14159265358979);
        *least = fmin(*least, angle);
        *most = fmax(*most, angle);
    }
}

/* On a box they lean by the angle that is asked for, on a cylinder they lie as without it. */
static void slanted_lines_lean_on_flat_faces_alone(void **state)
{
    (void)state;
    primitive cube = shared_cube();
    for (uint32_t v = 0; v < cube.vertex_count; v++)
        cube.positions[v] = (vec3){10 * cube.positions[v].x, 4 * cube.positions[v].y, cube.positions[v].z};
    shape  box = with_normals(cube), tube = with_normals(grid_surface(cylinder_at, 64, 40, true, false, 0.3));
    double straight[2], leaning[2], round_before[2], round_after[2];
    for (int slanted = 0; slanted < 2; slanted++) {
        flow_options options = {
            .apart = 0.1, .levels = 1, .series = 1, .slant = slanted ? 0.6981317f : 0, .sag = 0.005, .seed = 3};
        marks m;
        assert_int_equal(marks_streamlines(&m, &box.surface, &options, NULL), LMN_OK);
        angles_on(&m, true, slanted ? &leaning[0] : &straight[0], slanted ? &leaning[1] : &straight[1]);
        surface_marks_release(&m);
        assert_int_equal(marks_streamlines(&m, &tube.surface, &options, NULL), LMN_OK);
        angles_on(&m, false, slanted ? &round_after[0] : &round_before[0],
                  slanted ? &round_after[1] : &round_before[1]);
        surface_marks_release(&m);
    }
    assert_true(straight[1] < 1 && leaning[0] > 39 && leaning[1] < 41); /* to the longer edges: 0, then 40 */
    assert_true(round_before[0] == round_after[0] && round_before[1] == round_after[1]);
    release_shape(&box);
    release_shape(&tube);
}

/* Flanks that go over into what is round have lines as that has, whatever the slant of flat faces is. */
static void slanted_lines_go_on_from_what_is_round(void **state)
{
    (void)state;
    shape        s = with_normals(grid_surface(arch_at, 100, 40, false, false, 0.1));
    marks        m;
    flow_options options = {.apart = 0.2, .levels = 1, .series = 1, .slant = 0.6f, .sag = 0.002, .seed = 1};
    double       aslant = 0, length = 0;
    assert_int_equal(marks_streamlines(&m, &s.surface, &options, NULL), LMN_OK);
    for (size_t i = 0; i < m.line_count; i++) {
        const mark_line *l = &m.lines[i];
        place3           along = from_to(l->a, l->b);
        double           size = sqrt(product3(along, along));
        if (l->a.y > -0.3f || l->b.y > -0.3f || size == 0)
            continue;
        aslant += fabs(along.z) > 0.2 * size ? size : 0;
        length += size;
    }
    printf("arch: %.3f of the lines on its flanks lie aslant\n", aslant / length);
    assert_true(length > 0 && aslant < 0.01 * length);
    surface_marks_release(&m);
    release_shape(&s);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    shape s = with_normals(shared_cube());
    bool  failed = true;
    long  n = 1;
    for (; failed && n < 3000; n++) {
        marks        m;
        lmn_error    error;
        flow_options options = {.apart = 0.2,
                                .levels = 2,
                                .series = 2,
                                .turn = 1,
                                .sag = 0.01,
                                .length = 0.5,
                                .groups = 0.5,
                                .overlap = 0.3};
        mem_fail_at(n);
        lmn_status status = marks_streamlines(&m, &s.surface, &options, &error);
        mem_fail_at(0);
        failed = status != LMN_OK;
        assert_true(!failed || status == LMN_MEMORY);
        surface_marks_release(&m);
    }
    assert_true(!failed && n > 30);
    release_shape(&s);
}

/* --- what flat faces are like --------------------------------------------------------------------------- */

/* A wall two wide and one high, upright, with lines along it. */
static place3 wall_at(double u, double v)
{
    return (place3){2 * u, v, 0};
}

/* Light alone leaves a wall even. Its lines are dark above and light below, as evenly as the wall is high, and no more
 * of one than of the other; on what is round none are. */
static void flat_faces_fade(void **state)
{
    (void)state;
    shape wall = with_normals(grid_surface(wall_at, 2, 2, false, false, 0));
    wall.surface.up = (vec3){0, 1, 0};
    shape  ring = with_normals(grid_surface(torus_at, 64, 32, true, true, 0));
    marks  flat = make_lines(&wall, 0.02, 3, 1), round = make_lines(&ring, 0.05, 2, 1);
    double sum = 0, length = 0, above = 0, below = 0, most = 0, high = 0, low = 0;
    for (size_t i = 0; i < flat.line_count; i++)
        for (int end = 0; end < 2; end++) {
            const mark_line *l = &flat.lines[i];
            double           own = (double)l->to - (double)l->from, shade = (double)l->ends[end].shade;
            sum += own * shade;
            length += own;
            above += (end ? l->b.y : l->a.y) > 0.75f ? own * shade : 0;
            high += (end ? l->b.y : l->a.y) > 0.75f ? own : 0;
            below += (end ? l->b.y : l->a.y) < 0.25f ? own * shade : 0;
            low += (end ? l->b.y : l->a.y) < 0.25f ? own : 0;
        }
    for (size_t i = 0; i < round.line_count; i++)
        most = fmax(most, fabs((double)round.lines[i].ends[0].shade));
    printf("wall: shade %.3f above, %.3f below, %.4f on the mean; at most %.3f on a ring\n", above / high, below / low,
           sum / length, most);
    assert_true(above / high > 0.35 && below / low < -0.35 && fabs(sum / length) < 0.02 && most == 0);
    surface_marks_release(&flat);
    surface_marks_release(&round);
    release_shape(&wall);
    release_shape(&ring);
}

/* A wall of height 1 whose upper and lower edges are rounded a little, by quarters of circles. */
static place3 rounded_wall_at(double u, double v)
{
    const double r = 0.02;
    double       low = fmin(4 * u, 1), high = fmin(4 * (1 - u), 1), middle = fmin(fmax(2 * u - 0.5, 0), 1);
    double       angle = field_pi / 2 * (low < 1 ? 1 - low : high < 1 ? 1 - high : 0);
    double       y = low < 1 ? -r * sin(angle) : high < 1 ? 1 + r * sin(angle) : middle;
    return (place3){2 * v, y, -r * (1 - cos(angle))};
}

/* Such an edge is one: the wall fades as if it were sharp. */
static void flat_faces_with_rounded_edges_fade(void **state)
{
    (void)state;
    shape wall = with_normals(grid_surface(rounded_wall_at, 24, 2, false, false, 0));
    wall.surface.up = (vec3){0, 1, 0};
    marks  m = make_lines(&wall, 0.02, 3, 1);
    double above = 0, high = 0;
    for (size_t i = 0; i < m.line_count; i++) {
        const mark_line *l = &m.lines[i];
        double           own = (double)l->to - (double)l->from;
        bool             there = l->a.y > 0.75f && l->a.y < 0.99f;
        above += there ? own * (double)l->ends[0].shade : 0;
        high += there ? own : 0;
    }
    printf("rounded wall: shade %.3f above\n", above / high);
    assert_true(above / high > 0.35);
    surface_marks_release(&m);
    release_shape(&wall);
}

/* Half of the wall is dark, up to a line that lies aslant in its triangles. */
static double two_tones(const void *of, uint32_t triangle, vec3 at, double around)
{
    (void)of, (void)triangle, (void)around;
    return at.x + 0.3f * at.y < 1.1f ? 0.04 : 0.81;
}

/* Lines know the brightness of what is below them, also within triangles that are larger by far than lines are apart.
 */
static void lines_know_what_they_lie_on(void **state)
{
    (void)state;
    shape wall = with_normals(grid_surface(wall_at, 1, 1, false, false, 0));
    wall.surface.brightness = two_tones;
    marks  m = make_lines(&wall, 0.02, 6, 1);
    double wrong = 0, length = 0;
    for (size_t i = 0; i < m.line_count; i++) {
        const mark_line *l = &m.lines[i];
        for (int k = 0; k < 8; k++) {
            float  t = ((float)k + 0.5f) / 8;
            vec3   at = {l->a.x + t * (l->b.x - l->a.x), l->a.y + t * (l->b.y - l->a.y), 0};
            double seen =
                (double)l->ends[0].bright + (double)t * ((double)l->ends[1].bright - (double)l->ends[0].bright);
            double own = ((double)l->to - (double)l->from) / 8;
            wrong += fabs(sqrt(seen) - sqrt(two_tones(NULL, 0, at, 0))) > 0.1 ? own : 0;
            length += own;
        }
    }
    printf("wall of two tones: %.4f of all lines have the wrong one\n", wrong / length);
    assert_true(wrong / length < 0.005);
    surface_marks_release(&m);
    release_shape(&wall);
}

/* A level strip, a narrow round edge, and a wall below it, without a crease: lines that lie across the edge alone have
 * no more room than they are long, though the face goes on. */
static place3 edged_at(double u, double v)
{
    const double r = 0.05, turn = 1.5707963267948966 * fmin(fmax((v - 0.4) / 0.2, 0), 1);
    double       y = v > 0.6 ? -r - (v - 0.6) * 2 : r * cos(turn) - r, z = v < 0.4 ? v * 2 - 0.8 : r * sin(turn);
    return (place3){2 * u, y, z};
}

static void short_lines_have_no_room(void **state)
{
    (void)state;
    shape  edge = with_normals(grid_surface(edged_at, 8, 40, false, false, 0));
    marks  m = make_lines(&edge, 0.01, 3, 2);
    size_t bounded = 0, tight = 0;
    for (size_t i = 0; i < m.line_count; i++) {
        const mark_line *l = &m.lines[i];
        bool             first = i == 0 || m.lines[i - 1].stroke != l->stroke;
        const mark_line *last = l;
        while (first && last + 1 < m.lines + m.line_count && last[1].stroke == l->stroke)
            last++;
        if (!first || l->ends[0].to_edge > 0 || last->ends[1].to_edge > 0)
            continue;
        bounded++;
        tight += l->length < 0.3f;
        for (const mark_line *k = l; k <= last; k++)
            assert_true(fmaxf(k->ends[0].room, k->ends[1].room) <= 0.6f * l->length * 1.0001f);
    }
    printf("round edge: %zu lines from edge to edge, %zu of them short\n", bounded, tight);
    assert_true(bounded > 20 && tight > 0);
    surface_marks_release(&m);
    release_shape(&edge);
}

/* Round an edge outwards a line has room by the edge's radius, inwards and on what is even all of it; and along the
 * edge, too. */
static void bends_have_room_by_their_radius(void **state)
{
    (void)state;
    enum { POINTS = 201 };
    flow_point  p[POINTS];
    const float r = 0.5f, step = 0.01f;
    for (int inwards = 0; inwards < 2; inwards++) {
        for (int i = 0; i < POINTS; i++) {
            float arc = step * (float)i, turn = fminf(fmaxf((arc - 0.6f) / r, 0), 1.5707963f);
            float on = arc < 0.6f ? arc : 0.6f + r * sinf(turn), down = arc < 0.6f ? 0 : r * (cosf(turn) - 1);
            float after = fmaxf(arc - 0.6f - 1.5707963f * r, 0), side = inwards ? -1 : 1;
            p[i] = (flow_point){
                .at = {on, side * (down - after), 0}, .normal = {side * sinf(turn), cosf(turn), 0}, .arc = arc};
        }
        assert_true(isinf(flow_bend_room(p, POINTS, 0.3, 0.2)) && isinf(flow_bend_room(p, POINTS, 1.8, 0.2)));
        double room = flow_bend_room(p, POINTS, 1, 0.2);
        assert_true(inwards ? isinf(room) : fabs(room / (1.15 * (double)r) - 1) < 0.01);
    }
    assert_true(isinf(flow_bend_room(p, 1, 0, 0.2)));
}

/* Edge-on there is nothing, and from three times the least cosine on all. */
static void edge_on_nothing_is_left(void **state)
{
    (void)state;
    assert_true(mark_flow_grazing(0.04, 0.5) == 0 && mark_flow_grazing(-0.15, 0.5) == 1 &&
                mark_flow_grazing(1, 0) == 1);
    assert_true(fabs(mark_flow_grazing(-0.1, 0.8) - 0.5) < 1e-9 && mark_flow_grazing(0, 1) == 1);
}

/* So many of all lines are there where light leaves the page bare, at edges most and nowhere far from them. */
static void few_lines_are_sparse(void **state)
{
    (void)state;
    enum { LINES = 2000 };
    for (double sparse = 0.1; sparse < 0.95; sparse += 0.4) {
        int    at_edge = 0, half_way = 0, beyond = 0;
        double least = 0.1;
        for (int i = 0; i < LINES; i++) {
            mark_line l = {.rank = (float)i / LINES * 3.7f, .level = (uint8_t)(i % 4)};
            at_edge += mark_flow_sparse(&l, 0, sparse, least) > least;
            half_way += mark_flow_sparse(&l, FLOW_SPARSE / 2, sparse, least) > 0;
            beyond += mark_flow_sparse(&l, FLOW_SPARSE, sparse, least) > 0;
        }
        assert_true(fabs((double)at_edge / LINES - sparse) < 0.03 && beyond == 0);
        /* Reaches grow with the square of a number that is spread evenly. */
        assert_true(fabs((double)half_way / at_edge - (1 - sqrt(0.5))) < 0.05);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(lines_keep_their_distance),
        cmocka_unit_test(short_lines_fill_gaps),
        cmocka_unit_test(lines_of_a_set_never_cross),
        cmocka_unit_test(lines_go_on_from_what_bends_to_what_is_flat),
        cmocka_unit_test(narrow_faces_have_lines),
        cmocka_unit_test(ends_run_out_where_it_is_light),
        cmocka_unit_test(ends_do_not_line_up),
        cmocka_unit_test(levels_leave_earlier_ones_alone),
        cmocka_unit_test(groups_begin_together),
        cmocka_unit_test(groups_keep_the_ink),
        cmocka_unit_test(rooms_are_as_broad_as_faces),
        cmocka_unit_test(width_keeps_the_tone),
        cmocka_unit_test(barely_meshes_have_lines),
        cmocka_unit_test(the_same_lines_twice),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(slanted_lines_lean_on_flat_faces_alone),
        cmocka_unit_test(slanted_lines_go_on_from_what_is_round),
        cmocka_unit_test(flat_faces_fade),
        cmocka_unit_test(flat_faces_with_rounded_edges_fade),
        cmocka_unit_test(lines_know_what_they_lie_on),
        cmocka_unit_test(short_lines_have_no_room),
        cmocka_unit_test(bends_have_room_by_their_radius),
        cmocka_unit_test(edge_on_nothing_is_left),
        cmocka_unit_test(few_lines_are_sparse),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
