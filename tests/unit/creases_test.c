/* Which edges are creases: by feature, on shapes whose features are known. */
#include "field_shapes.h"

#include "stroke/edges.h"

static const double degree = 3.14159265358979323846 / 180;

static edge_mesh sort(const primitive *p, double crease)
{
    mesh      m = {.primitives = (primitive *)p, .primitive_count = 1};
    edge_mesh e;
    assert_int_equal(edge_mesh_create(&e, &m, NULL, crease * degree, NULL), LMN_OK);
    return e;
}

typedef struct profile {
    double   at[256][2];
    uint32_t count;
} profile;

static void add(profile *p, double x, double y)
{
    p->at[p->count][0] = x;
    p->at[p->count++][1] = y;
}

/* An arc about a centre from an angle to another one, in so many steps. */
static void add_arc(profile *p, double x, double y, double radius, double from, double to, uint32_t steps)
{
    for (uint32_t i = 0; i <= steps; i++) {
        double turn = (from + (to - from) * i / steps) * degree;
        add(p, x + radius * cos(turn), y + radius * sin(turn));
    }
}

/* The walls of an extruded outline, of `rows` rows of faces, without caps. */
static primitive extrude(const profile *o, double length, uint32_t rows)
{
    primitive p = empty_primitive(o->count * (rows + 1), 6 * o->count * rows);
    uint32_t  at = 0;
    for (uint32_t r = 0; r <= rows; r++)
        for (uint32_t i = 0; i < o->count; i++)
            p.positions[r * o->count + i] = (vec3){(float)o->at[i][0], (float)o->at[i][1], (float)(length * r / rows)};
    for (uint32_t r = 0; r < rows; r++)
        for (uint32_t i = 0; i < o->count; i++) {
            uint32_t       a = r * o->count + i, b = r * o->count + (i + 1) % o->count, up = o->count;
            const uint32_t quad[6] = {a, b, up + b, a, up + b, up + a};
            memcpy(p.indices + at, quad, sizeof quad);
            at += 6;
        }
    return p;
}

/* How many lines of creases run along the walls: those in the first row. */
static uint32_t crease_lines(const primitive *p, double crease, double length, double *x, double *y)
{
    edge_mesh e = sort(p, crease);
    uint32_t  count = 0;
    for (uint32_t i = 0; i < e.edge_count; i++) {
        vec3 a = e.positions[e.edges[i].vertex[0]], b = e.positions[e.edges[i].vertex[1]];
        bool upright = a.x == b.x && a.y == b.y && fabs((double)a.z - b.z) > 0;
        if ((e.edges[i].flags & EDGE_CREASE) && upright && fmin(a.z, b.z) < 1e-6 * length) {
            count++;
            *x = a.x;
            *y = a.y;
        }
    }
    edge_mesh_release(&e);
    return count;
}

static uint32_t lines_of(const profile *o, double crease)
{
    double   length = 10, x, y;
    uint32_t counts[2];
    for (uint32_t k = 0; k < 2; k++) {
        primitive p = extrude(o, length, k ? 5 : 1);
        counts[k] = crease_lines(&p, crease, length, &x, &y);
        primitive_release(&p);
    }
    assert_int_equal(counts[0], counts[1]);
    return counts[0];
}

static void tessellated_cylinders_are_round(void **state)
{
    (void)state;
    for (uint32_t sides = 3; sides <= 60; sides++) {
        profile o = {.count = 0};
        add_arc(&o, 0, 0, 3, 0, 360.0 * (sides - 1) / sides, sides - 1);
        assert_int_equal(o.count, sides);
        assert_int_equal(lines_of(&o, 5), sides <= 9 ? sides : 0); /* up to 40 degrees they are prisms */
    }
}

/* A box with one edge that is rounded in so many steps. */
static profile rounded(double radius, uint32_t steps)
{
    profile o = {.count = 0};
    add(&o, 0, 0);
    add(&o, 8, 0);
    add_arc(&o, 8 - radius, 6 - radius, radius, 0, 90, steps);
    add(&o, 0, 6);
    return o;
}

static void fillets_are_round_and_chamfers_are_not(void **state)
{
    (void)state;
    for (int crease = 10; crease <= 30; crease += 5) {
        profile one = rounded(1, 1), two = rounded(1, 2);
        assert_int_equal(lines_of(&one, crease), 5); /* a chamfer: three sharp edges and its two */
        assert_true(lines_of(&two, crease) >= 4);
        for (uint32_t steps = 3; steps <= 12; steps++) {
            profile o = rounded(1, steps);
            assert_int_equal(lines_of(&o, crease), 3);
        }
    }
}

/* Narrower than a pen it is one line, where its middle is. */
static void narrow_fillets_are_one_line(void **state)
{
    (void)state;
    for (uint32_t steps = 4; steps <= 8; steps += 2) {
        profile   o = rounded(0.04, steps);
        double    x, y;
        primitive p = extrude(&o, 10, 1);
        edge_mesh e = sort(&p, 20);
        uint32_t  found = 0;
        for (uint32_t i = 0; i < e.edge_count; i++) {
            vec3 a = e.positions[e.edges[i].vertex[0]], b = e.positions[e.edges[i].vertex[1]];
            if (!(e.edges[i].flags & EDGE_CREASE) || a.x != b.x || a.x < 7.9f || a.y < 5.9f)
                continue;
            found++;
            x = a.x - 7.96;
            y = a.y - 5.96;
            assert_true(fabs(atan2(y, x) - 45 * degree) < 8 * degree);
        }
        assert_int_equal(found, 1);
        edge_mesh_release(&e);
        primitive_release(&p);
    }
}

/* Thin rods are narrow and round, but end in no faces: none of their edges is a line. */
static void thin_rods_have_no_creases(void **state)
{
    static const double radii[] = {0.02, 0.06, 0.1, 0.2, 0.4};
    (void)state;
    for (uint32_t k = 0; k < sizeof radii / sizeof *radii; k++)
        for (uint32_t steps = 12; steps <= 36; steps += 4) {
            profile o = {0};
            add_arc(&o, 0, 0, radii[k], 0, 360 - 360.0 / steps, steps - 1);
            assert_int_equal(lines_of(&o, 5), 0);
        }
}

/* --- scans ----------------------------------------------------------------------------------------------- */

static double jitter(uint32_t n)
{
    n = (n ^ n >> 16) * 0x7FEB352Du;
    n = (n ^ n >> 15) * 0x846CA68Bu;
    return (n ^ n >> 16) / 4294967296.0 - 0.5;
}

/* What lies at one position stays together. */
static void shake(primitive *p, double by)
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        uint32_t bits[3];
        memcpy(bits, &p->positions[i], sizeof bits);
        uint32_t n = bits[0] * 73856093u ^ bits[1] * 19349663u ^ bits[2] * 83492791u;
        p->positions[i].x += (float)(by * jitter(n));
        p->positions[i].y += (float)(by * jitter(n + 1));
        p->positions[i].z += (float)(by * jitter(n + 2));
    }
}

static double crease_length(const edge_mesh *e, double *whole)
{
    double sum = 0;
    *whole = 0;
    for (uint32_t i = 0; i < e->edge_count; i++) {
        vec3   a = e->positions[e->edges[i].vertex[0]], b = e->positions[e->edges[i].vertex[1]];
        double length = sqrt(pow(a.x - b.x, 2) + pow(a.y - b.y, 2) + pow(a.z - b.z, 2));
        sum += e->edges[i].flags & EDGE_CREASE ? length : 0;
        *whole += length;
    }
    return sum;
}

static void noise_of_scans_is_no_crease(void **state)
{
    (void)state;
    for (int k = 1; k <= 3; k++) {
        primitive p = ball(60, 0.3, (place3){1, 1, 1});
        shake(&p, 0.006 * k); /* edges are about 0.03 long */
        edge_mesh e = sort(&p, 30);
        double    whole;
        double    creases = crease_length(&e, &whole);
        if (creases > 0)
            printf("noise %d: %.4f of the edges are creases\n", k, creases / whole);
        assert_true(creases < 0.001 * whole);
        edge_mesh_release(&e);
        primitive_release(&p);
    }
}

/* A dense, uneven roof: its ridge is the one crease. */
static primitive roof(uint32_t side, double noise)
{
    primitive p = empty_primitive((side + 1) * (side + 1), 6 * side * side);
    uint32_t  at = 0;
    for (uint32_t i = 0; i < p.vertex_count; i++) {
        double x = (double)(i % (side + 1)) / side - 0.5, y = (double)(i / (side + 1)) / side;
        p.positions[i] = (vec3){(float)x, (float)y, (float)(-0.5 * fabs(x))};
    }
    for (uint32_t y = 0; y < side; y++)
        for (uint32_t x = 0; x < side; x++) {
            uint32_t       a = y * (side + 1) + x, b = a + side + 1;
            const uint32_t quad[6] = {a, a + 1, b + 1, a, b + 1, b};
            memcpy(p.indices + at, quad, sizeof quad);
            at += 6;
        }
    shake(&p, noise / side);
    return p;
}

static void edges_of_scans_stay(void **state)
{
    (void)state;
    for (int k = 1; k <= 3; k++) {
        primitive p = roof(80, 0.06 * k);
        edge_mesh e = sort(&p, 30);
        double    on = 0, off = 0;
        for (uint32_t i = 0; i < e.edge_count; i++) {
            vec3   a = e.positions[e.edges[i].vertex[0]], b = e.positions[e.edges[i].vertex[1]];
            double length = fabs((double)a.y - b.y), away = fmax(fabs(a.x), fabs(b.x));
            if (!(e.edges[i].flags & EDGE_CREASE))
                continue;
            if (away < 0.01)
                on += length;
            else
                off += length;
        }
        if (!(on > 0.9 && off < 0.02))
            printf("noise %d: %.3f of the ridge, %.3f beside it\n", k, on, off);
        assert_true(on > 0.9 && off < 0.02);
        edge_mesh_release(&e);
        primitive_release(&p);
    }
}

/* Creases at a vertex. */
static uint32_t degree_of(const edge_mesh *e, uint32_t vertex)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < e->edge_count; i++)
        count +=
            (e->edges[i].flags & EDGE_CREASE) && (e->edges[i].vertex[0] == vertex || e->edges[i].vertex[1] == vertex);
    return count;
}

/* How many edges it is from an end of a crease to where three meet, 0 where the crease has no free end. */
static uint32_t twig_length(const edge_mesh *e, uint32_t first, int end)
{
    uint32_t at = first, vertex = e->edges[first].vertex[end], count = 1;
    if (degree_of(e, vertex) != 1)
        return 0;
    for (;; count++) {
        vertex = e->edges[at].vertex[0] == vertex ? e->edges[at].vertex[1] : e->edges[at].vertex[0];
        uint32_t next = at;
        for (uint32_t i = 0; i < e->edge_count; i++)
            if (i != at && (e->edges[i].flags & EDGE_CREASE) &&
                (e->edges[i].vertex[0] == vertex || e->edges[i].vertex[1] == vertex))
                next = i;
        if (degree_of(e, vertex) != 2)
            return degree_of(e, vertex) > 2 ? count : 0;
        at = next;
    }
}

/* A modelled cow without normals: its mouth is a crease, but nothing as short as whiskers grows out of it. */
static void creases_do_not_fray(void **state)
{
    (void)state;
    lmn_scene *scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/spot.obj");
    edge_mesh  e;
    uint32_t   creases = 0, twigs = 0;
    assert_int_equal(edge_mesh_create(&e, &scene->meshes[0], NULL, 40 * degree, NULL), LMN_OK);
    for (uint32_t i = 0; i < e.edge_count; i++)
        for (int k = 0; k < 2 && e.edges[i].flags & EDGE_CREASE; k++) {
            uint32_t length = twig_length(&e, i, k);
            creases += k == 0;
            twigs += length > 0 && length < 4;
        }
    assert_true(creases > 20); /* the mouth */
    assert_int_equal(twigs, 0);
    edge_mesh_release(&e);
    lmn_scene_destroy(&scene);
}

/* --- the file's normals ---------------------------------------------------------------------------------- */

/* Four walls that turn by 50 degrees, with normals that go on smoothly over the second edge if `smooth`, over none
 * if not `any`. */
static uint32_t walls(bool smooth, bool any)
{
    static const uint32_t walls_most = 4;
    primitive             p = empty_primitive(4 * walls_most, 6 * walls_most);
    double                x = 0, y = 0;
    p.normals = mem_alloc(p.vertex_count * sizeof *p.normals);
    for (uint32_t i = 0; i < walls_most; i++) {
        double turn = 50.0 * i * degree, next_x = x + cos(turn), next_y = y + sin(turn);
        for (uint32_t k = 0; k < 4; k++) {
            bool   second = k == 1 || k == 2;
            double lean = !any ? 0 : second && i == 0 ? 25 : !second && i == 1 ? -25 : 0; /* over the first edge */
            if (smooth && ((second && i == 1) || (!second && i == 2)))
                lean = second ? 25 : -25;
            double at = turn + lean * degree;
            p.positions[4 * i + k] = (vec3){(float)(second ? next_x : x), (float)(second ? next_y : y), k > 1 ? 3 : 0};
            p.normals[4 * i + k] = (vec3){(float)sin(at), (float)-cos(at), 0};
        }
        const uint32_t quad[6] = {4 * i, 4 * i + 1, 4 * i + 2, 4 * i, 4 * i + 2, 4 * i + 3};
        memcpy(p.indices + 6 * i, quad, sizeof quad);
        x = next_x;
        y = next_y;
        if (i + 1 < walls_most) /* the next one begins at the very same position */
            x = p.positions[4 * i + 1].x, y = p.positions[4 * i + 1].y;
    }
    edge_mesh e = sort(&p, 30);
    uint32_t  count = 0;
    for (uint32_t i = 0; i < e.edge_count; i++)
        count += (e.edges[i].flags & EDGE_CREASE) != 0;
    edge_mesh_release(&e);
    primitive_release(&p);
    return count;
}

static void normals_of_files_are_believed(void **state)
{
    (void)state;
    assert_int_equal(walls(false, true), 2);
    assert_int_equal(walls(true, true), 1);
    assert_int_equal(walls(false, false), 3); /* all are split: nothing is said */
}

/* A strip of quads over these corners, with normals that are smooth everywhere. */
static uint32_t smooth_strip(const profile *o)
{
    primitive p = extrude(o, 3, 1);
    p.normals = mem_alloc(p.vertex_count * sizeof *p.normals);
    for (uint32_t i = 0; i < o->count; i++) {
        uint32_t before = (i + o->count - 1) % o->count, after = (i + 1) % o->count;
        double   along_x = o->at[after][0] - o->at[before][0], along_y = o->at[after][1] - o->at[before][1],
               length = sqrt(along_x * along_x + along_y * along_y);
        p.normals[i] = p.normals[o->count + i] = (vec3){(float)(along_y / length), (float)(-along_x / length), 0};
    }
    edge_mesh e = sort(&p, 30);
    uint32_t  count = 0;
    for (uint32_t i = 0; i < e.edge_count; i++)
        count += (e.edges[i].flags & EDGE_CREASE) != 0;
    edge_mesh_release(&e);
    primitive_release(&p);
    return count;
}

/* Where all normals are means over all faces, shape tells: what turns alone is sharp, what turns like its neighbours is
 * round. */
static void sharp_edges_stand_alone(void **state)
{
    profile tube = {0}, drop = {0};
    (void)state;
    add_arc(&tube, 0, 0, 2, 0, 360 - 360.0 / 7, 6); /* steps of 51 degrees */
    assert_int_equal(smooth_strip(&tube), 0);
    add_arc(&drop, 0, 0, 4, -65, 245, 62);
    add(&drop, 0, -4 / cos(25 * degree)); /* tangents that meet at 50 */
    assert_int_equal(smooth_strip(&drop), 1);
}

/* Where a crease runs out, it goes on to half of the angle. */
static void creases_fade_out_whole(void **state)
{
    (void)state;
    enum { LONG = 20 };
    primitive p = empty_primitive(3 * (LONG + 1), 12 * LONG);
    uint32_t  at = 0;
    for (uint32_t i = 0; i <= LONG; i++) {
        double turn = (45 - 45.0 * i / LONG) * degree;
        p.positions[3 * i] = (vec3){-1, (float)i, 0};
        p.positions[3 * i + 1] = (vec3){0, (float)i, 0};
        p.positions[3 * i + 2] = (vec3){(float)cos(turn), (float)i, (float)-sin(turn)};
    }
    for (uint32_t i = 0; i < LONG; i++)
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t       a = 3 * i + k, b = a + 3;
            const uint32_t quad[6] = {a, a + 1, b + 1, a, b + 1, b};
            memcpy(p.indices + at, quad, sizeof quad);
            at += 6;
        }
    edge_mesh e = sort(&p, 30);
    uint32_t  count = 0;
    for (uint32_t i = 0; i < e.edge_count; i++)
        count += (e.edges[i].flags & EDGE_CREASE) != 0;
    assert_in_range(count, 12, 14); /* by angle alone there were 6 */
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* A fold over a sheet begins on its rim and fades out, or with `closed` ends on the rim; one side is a plane or bent.
 */
static uint32_t fold_creases(double angle, bool bent, bool closed, float *least_turn, float *most_turn)
{
    enum { ROWS = 20, FADES = 12 };
    primitive p = empty_primitive(3 * (ROWS + 1), 12 * ROWS);
    uint32_t  at = 0, count = 0;
    for (uint32_t i = 0; i <= ROWS; i++) {
        double share = closed ? 1 : fmax(fmin((1 + FADES - (double)i) / FADES, 1), 0);
        double turn = (angle + (i % 2 ? 1 : -1)) * share * degree; /* uneven, as modelled by hand */
        p.positions[3 * i] = (vec3){-1, (float)i, bent ? (float)(i % 2) * 0.04f : 0};
        p.positions[3 * i + 1] = (vec3){0, (float)i, 0};
        p.positions[3 * i + 2] = (vec3){(float)cos(turn), (float)i, (float)-sin(turn)};
    }
    for (uint32_t i = 0; i < ROWS; i++)
        for (uint32_t k = 0; k < 2; k++) {
            uint32_t       a = 3 * i + k, b = a + 3;
            const uint32_t quad[6] = {a, a + 1, b + 1, a, b + 1, b};
            memcpy(p.indices + at, quad, sizeof quad);
            at += 6;
        }
    edge_mesh e = sort(&p, 20);
    *least_turn = INFINITY;
    *most_turn = 0;
    for (uint32_t i = 0; i < e.edge_count; i++) {
        vec3 a = e.positions[e.edges[i].vertex[0]], b = e.positions[e.edges[i].vertex[1]];
        if (!(e.edges[i].flags & EDGE_CREASE) || a.x != 0 || b.x != 0)
            continue;
        count++;
        *least_turn = fminf(*least_turn, e.edges[i].turn);
        *most_turn = fmaxf(*most_turn, e.edges[i].turn);
    }
    edge_mesh_release(&e);
    primitive_release(&p);
    return count;
}

/* A short weak crease that ends within a surface is none; a strong one is, and a weak one from rim to rim, which is as
 * strong everywhere as it is in the mean. */
static void weak_creases_end_on_lines(void **state)
{
    float least, most;
    (void)state;
    assert_int_equal(fold_creases(34, true, false, &least, &most), 0);
    assert_true(fold_creases(34, false, false, &least, &most) >= 5); /* beside a plane it is meant */
    assert_true(fold_creases(80, true, false, &least, &most) >= 5);
    assert_int_equal(fold_creases(34, true, true, &least, &most), 20);
    assert_true(least == most && fabs(least - 34 * degree) < 3 * degree);
}

/* How many creases a mesh has, and how many of their ends are free. */
static uint32_t count_creases(const primitive *p, uint32_t *free_ends)
{
    edge_mesh e = sort(p, 30);
    uint32_t  count = 0;
    *free_ends = 0;
    for (uint32_t i = 0; i < e.edge_count; i++)
        for (int k = 0; k < 2 && e.edges[i].flags & EDGE_CREASE; k++) {
            count += k == 0;
            *free_ends += degree_of(&e, e.edges[i].vertex[k]) == 1;
        }
    edge_mesh_release(&e);
    return count;
}

enum { STUDS = 12, BETWEEN = 2 * STUDS * (STUDS - 1) };

/* Rows of pyramids with smooth normals. Sides that rise by 60 degrees meet at 76, and at 120 between the pyramids,
 * sides that rise by 45 at 60 and at 90. */
static primitive pyramids(double rise)
{
    enum { SIDE = STUDS + 1 };
    primitive p = empty_primitive(SIDE * SIDE + STUDS * STUDS, 12 * STUDS * STUDS);
    uint32_t  at = 0;
    for (uint32_t j = 0; j < SIDE; j++)
        for (uint32_t i = 0; i < SIDE; i++)
            p.positions[j * SIDE + i] = (vec3){(float)i, (float)j, 0};
    for (uint32_t j = 0; j < STUDS; j++)
        for (uint32_t i = 0; i < STUDS; i++) {
            const uint32_t n = j * SIDE + i, top = SIDE * SIDE + j * STUDS + i,
                           base[4] = {n, n + 1, n + SIDE + 1, n + SIDE};
            p.positions[top] = (vec3){(float)i + 0.5f, (float)j + 0.5f, (float)(0.5 * tan(rise * degree))};
            for (uint32_t k = 0; k < 4; k++) {
                const uint32_t corners[3] = {base[k], base[(k + 1) % 4], top};
                memcpy(p.indices + at, corners, sizeof corners);
                at += 3;
            }
        }
    p.normals = mem_alloc(p.vertex_count * sizeof *p.normals);
    for (uint32_t i = 0; i < p.vertex_count; i++)
        p.normals[i] = (vec3){0, 0, 1};
    return p;
}

/* A coarse ball of uneven faces, or two bowls so high that meet in a rim of four times so many edges as `cells`, at 120
 * degrees where they are 0.4 high, at 66 where they are 0.9 high. */
static uint32_t coarse_creases(uint32_t cells, double height, uint32_t seed, bool normals, uint32_t *free_ends)
{
    primitive p = ball(cells, 0, (place3){1, 1, 1});
    p.normals = normals ? mem_alloc(p.vertex_count * sizeof *p.normals) : NULL;
    for (uint32_t i = 0; i < p.vertex_count; i++) {
        vec3 *at = &p.positions[i];
        float inwards = 1 - 0.5f * fabsf(at->z);
        if (normals)
            p.normals[i] = *at; /* one at a place, as programs give them to what is to look curved */
        if (height > 0)
            *at = (vec3){at->x * inwards, at->y * inwards, (float)height * at->z};
        at->x += (float)seed; /* shaken otherwise */
    }
    shake(&p, (height > 0 ? 0.24 : 0.48) / cells); /* edges are about 1.6 / cells long */
    uint32_t count = count_creases(&p, free_ends);
    primitive_release(&p);
    return count;
}

/* The edges of a coarse mesh turn as features do. Where it is shaded as a curved surface, lines are what turns much
 * more than all around it; where nothing says so, the edges are the shape. */
static void coarse_meshes_of_curved_surfaces_have_few_creases(void **state)
{
    enum { BALLS = 20 };
    uint32_t free_ends, scraps = 0, loose = 0, faceted = 0;
    (void)state;
    for (uint32_t seed = 0; seed < BALLS; seed++) {
        scraps += coarse_creases(4, 0, seed, true, &free_ends);
        loose += free_ends;
        assert_int_equal(coarse_creases(4, 0.4, seed, true, &free_ends), 16);
        assert_int_equal(free_ends, 0);
        assert_int_equal(coarse_creases(8, 0.9, seed, true, &free_ends), 32);
        assert_int_equal(free_ends, 0);
        faceted += coarse_creases(4, 0, seed, false, &free_ends);
    }
    printf("%d coarse balls: %u creases, %u free ends\n", BALLS, scraps, loose);
    assert_true(scraps < BALLS / 2 && loose <= 2); /* a vertex that stands out far enough is a peak */
    assert_true(faceted > 50 * BALLS);
    primitive quilt = pyramids(45);
    assert_int_equal(count_creases(&quilt, &free_ends), BETWEEN);
    primitive_release(&quilt);
}

/* What is sharp all over stays, and so does what has flat faces, though its normals are smooth. */
static void sharp_solids_keep_their_edges(void **state)
{
    uint32_t  free_ends;
    primitive box = ball(1, 0, (place3){1, 2, 3});
    (void)state;
    assert_int_equal(count_creases(&box, &free_ends), 12);
    box.normals = mem_alloc(box.vertex_count * sizeof *box.normals);
    memcpy(box.normals, box.positions, box.vertex_count * sizeof *box.normals);
    assert_int_equal(count_creases(&box, &free_ends), 12);
    primitive_release(&box);
    /* All edges of an octahedron turn by 71 degrees, but there is nothing else to compare them with. */
    primitive diamond = empty_primitive(6, 24);
    diamond.normals = mem_alloc(6 * sizeof *diamond.normals);
    for (uint32_t i = 0; i < 6; i++) {
        float at[3] = {0, 0, 0};
        at[i / 2] = i % 2 ? -1 : 1;
        diamond.positions[i] = diamond.normals[i] = (vec3){at[0], at[1], at[2]};
    }
    for (uint32_t k = 0; k < 8; k++) {
        const uint32_t x = k & 1, y = 2 + (k >> 1 & 1), z = 4 + (k >> 2 & 1), odd = (x + y + z) & 1,
                       corners[3] = {x, odd ? z : y, odd ? y : z};
        memcpy(diamond.indices + 3 * k, corners, sizeof corners);
    }
    assert_int_equal(count_creases(&diamond, &free_ends), 12);
    primitive_release(&diamond);
    const profile hexagon = {{{2, 0}, {1, 1.732}, {-1, 1.732}, {-2, 0}, {-1, -1.732}, {1, -1.732}}, 6};
    assert_int_equal(lines_of(&hexagon, 30), 6);
    primitive studs = pyramids(60);
    assert_int_equal(count_creases(&studs, &free_ends), 4 * STUDS * STUDS + BETWEEN);
    primitive_release(&studs);
}

/* A turned body: a plane at the top and the bottom, and rings between them. How many creases its ring `ring` has. */
static uint32_t ring_creases(const double (*profile)[2], uint32_t rings, uint32_t ring, double crease)
{
    enum { SIDES = 24 };
    primitive p = empty_primitive(SIDES * rings + 2, 6 * SIDES * rings);
    uint32_t  at = 0, count = 0;
    for (uint32_t i = 0; i < rings * SIDES; i++) {
        double turn = 360.0 * (i % SIDES) / SIDES * degree, radius = profile[i / SIDES][0];
        p.positions[i] = (vec3){(float)(radius * cos(turn)), (float)(radius * sin(turn)), (float)profile[i / SIDES][1]};
    }
    p.positions[rings * SIDES] = (vec3){0, 0, (float)profile[0][1]};
    p.positions[rings * SIDES + 1] = (vec3){0, 0, (float)profile[rings - 1][1]};
    for (uint32_t i = 0; i < rings * SIDES; i++) {
        uint32_t       next = i % SIDES + 1 == SIDES ? i + 1 - SIDES : i + 1, row = i / SIDES;
        const uint32_t quad[6] = {i, i + SIDES, next + SIDES, i, next + SIDES, next}, top[3] = {rings * SIDES, i, next},
                       bottom[3] = {rings * SIDES + 1, next, i};
        if (row + 1 < rings) {
            memcpy(p.indices + at, quad, sizeof quad);
            at += 6;
        }
        if (row == 0 || row + 1 == rings) {
            memcpy(p.indices + at, row ? bottom : top, sizeof top);
            at += 3;
        }
    }
    edge_mesh e = sort(&p, crease);
    for (uint32_t i = 0; i < e.edge_count; i++) {
        vec3 a = e.positions[e.edges[i].vertex[0]], b = e.positions[e.edges[i].vertex[1]];
        count += (e.edges[i].flags & EDGE_CREASE) && (double)a.z == (double)(float)profile[ring][1] && a.z == b.z;
    }
    edge_mesh_release(&e);
    primitive_release(&p);
    return count;
}

/* The flat end of a bolt is a circle, though its chamfer turns by 30 degrees only; the rings of a dome and of a
 * rounding are none. */
static void rims_of_chamfers_are_creases(void **state)
{
    const double bolt[4][2] = {{0.8, 1}, {1, 0.8845}, {1, 0}, {0.9, -0.4}},
                 round[5][2] = {{0.8, 1}, {0.9, 0.9732}, {0.9732, 0.9}, {1, 0.8}, {1, 0}},
                 two[4][2] = {{0.8, 1}, {0.9414, 0.9414}, {1, 0.8}, {1, 0}},
                 dome[5][2] = {{0.3, 0.954}, {0.6, 0.8}, {0.85, 0.527}, {1, 0}, {1, -1}};
    (void)state;
    assert_int_equal(ring_creases(bolt, 4, 0, 40), 24);
    assert_int_equal(ring_creases(bolt, 4, 1, 40), 24); /* 60 degrees */
    assert_int_equal(ring_creases(bolt, 4, 2, 40), 0);  /* 14 degrees */
    for (uint32_t i = 0; i < 4; i++)
        assert_int_equal(ring_creases(round, 5, i, 40), 0);
    assert_int_equal(ring_creases(two, 4, 0, 40) + ring_creases(two, 4, 2, 40), 0);
    for (uint32_t i = 0; i < 4; i++)
        assert_int_equal(ring_creases(dome, 5, i, 40), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(tessellated_cylinders_are_round),
                                       cmocka_unit_test(fillets_are_round_and_chamfers_are_not),
                                       cmocka_unit_test(narrow_fillets_are_one_line),
                                       cmocka_unit_test(thin_rods_have_no_creases),
                                       cmocka_unit_test(noise_of_scans_is_no_crease),
                                       cmocka_unit_test(edges_of_scans_stay),
                                       cmocka_unit_test(normals_of_files_are_believed),
                                       cmocka_unit_test(sharp_edges_stand_alone),
                                       cmocka_unit_test(creases_fade_out_whole),
                                       cmocka_unit_test(creases_do_not_fray),
                                       cmocka_unit_test(weak_creases_end_on_lines),
                                       cmocka_unit_test(rims_of_chamfers_are_creases),
                                       cmocka_unit_test(coarse_meshes_of_curved_surfaces_have_few_creases),
                                       cmocka_unit_test(sharp_solids_keep_their_edges)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
