/* Edges sorted into those that are always lines, those that may be outlines and those that never are. Rows OE-01 to
 * OE-03, OE-05; glTF's EXT_mesh_primitive_edge_visibility. */
#include "field_shapes.h"

#include "stroke/stroke_private.h"

static const double degree = 3.14159265358979323846 / 180;

static edge_mesh sort(const primitive *p, size_t count, double crease)
{
    mesh      m = {.primitives = (primitive *)p, .primitive_count = count};
    edge_mesh e;
    assert_int_equal(edge_mesh_create(&e, &m, NULL, crease, NULL), LMN_OK);
    return e;
}

static uint32_t count_flag(const edge_mesh *e, uint32_t flag)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < e->edge_count; i++)
        count += (e->edges[i].flags & flag) != 0;
    return count;
}

static uint32_t flags_between(const edge_mesh *e, vec3 a, vec3 b)
{
    for (uint32_t i = 0; i < e->edge_count; i++) {
        vec3 p = e->positions[e->edges[i].vertex[0]], q = e->positions[e->edges[i].vertex[1]];
        bool same = p.x == a.x && p.y == a.y && p.z == a.z && q.x == b.x && q.y == b.y && q.z == b.z;
        bool turned = p.x == b.x && p.y == b.y && p.z == b.z && q.x == a.x && q.y == a.y && q.z == a.z;
        if (same || turned)
            return e->edges[i].flags;
    }
    return 0;
}

static primitive of_faces(const vec3 *positions, uint32_t position_count, const uint32_t *corners,
                          uint32_t corner_count)
{
    primitive p = empty_primitive(position_count, corner_count);
    memcpy(p.positions, positions, position_count * sizeof *positions);
    memcpy(p.indices, corners, corner_count * sizeof *corners);
    return p;
}

/* Caps are fans without a middle vertex, as in the seed's figure 7.1. */
static primitive prism(uint32_t sides)
{
    primitive p = empty_primitive(2 * sides, 3 * (2 * sides + 2 * (sides - 2)));
    uint32_t  at = 0;
    for (uint32_t i = 0; i < 2 * sides; i++) {
        double turn = 2 * field_pi * (i % sides) / sides;
        p.positions[i] = (vec3){(float)cos(turn), (float)sin(turn), i < sides ? 0.0f : 2.0f};
    }
    for (uint32_t i = 0; i < sides; i++) {
        uint32_t       j = (i + 1) % sides;
        const uint32_t quad[6] = {i, j, sides + j, i, sides + j, sides + i};
        memcpy(p.indices + at, quad, sizeof quad);
        at += 6;
    }
    for (uint32_t i = 1; i + 1 < sides; i++) {
        const uint32_t caps[6] = {0, i + 1, i, sides, sides + i, sides + i + 1};
        memcpy(p.indices + at, caps, sizeof caps);
        at += 6;
    }
    return p;
}

static void the_octagonal_prism(void **state)
{
    (void)state;
    primitive p = prism(8);
    assert_int_equal(p.index_count, 3 * 28);
    static const double creases[] = {46, 60, 89};
    for (int i = 0; i < 3; i++) {
        edge_mesh e = sort(&p, 1, creases[i] * degree);
        assert_int_equal(e.all_edges, 42);
        assert_int_equal(e.loose_edges, 0);
        assert_int_equal(count_flag(&e, EDGE_CREASE), 16);
        assert_int_equal(count_flag(&e, EDGE_CANDIDATE), 8);
        assert_int_equal(e.edge_count, 24); /* the other 18 are never lines */
        assert_int_equal(count_flag(&e, EDGE_BORDER | EDGE_MATERIAL | EDGE_TWISTED), 0);
        bool     winged[28] = {false};
        uint32_t tested = 0;
        for (uint32_t k = 0; k < e.edge_count; k++)
            if (e.edges[k].flags & EDGE_CANDIDATE)
                for (int w = 0; w < 2; w++) {
                    tested += !winged[e.edges[k].face[w]];
                    winged[e.edges[k].face[w]] = true;
                }
        assert_int_equal(tested, 16); /* of 28 faces */
        assert_int_equal(e.piece_count, 1);
        assert_true(e.closed[0] && !e.inward[0]);
        edge_mesh_release(&e);
    }
    edge_mesh e = sort(&p, 1, 44 * degree); /* now the upright ones are sharp */
    assert_int_equal(count_flag(&e, EDGE_CREASE), 24);
    assert_int_equal(count_flag(&e, EDGE_CANDIDATE), 0);
    edge_mesh_release(&e);
    primitive_release(&p);
}

static void a_cube_has_no_candidates(void **state)
{
    (void)state;
    primitive p = shared_cube();
    edge_mesh e = sort(&p, 1, 30 * degree);
    assert_int_equal(e.all_edges, 18);
    assert_int_equal(count_flag(&e, EDGE_CREASE), 12);
    assert_int_equal(count_flag(&e, EDGE_CANDIDATE), 0);
    assert_int_equal(e.edge_count, 12);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* Each edge's faces and direction: face[0] passes it from vertex[0] to vertex[1], face[1] the other way. */
static void faces_lie_where_they_should(void **state)
{
    (void)state;
    primitive p = ball(6, 0.4, (place3){1, 1, 1});
    edge_mesh e = sort(&p, 1, 60 * degree);
    assert_int_equal(e.all_edges, e.face_count * 3 / 2);
    assert_int_equal(e.vertex_count - e.all_edges + e.face_count, 2);
    for (uint32_t i = 0; i < e.edge_count; i++)
        for (int w = 0; w < 2; w++) {
            const uint32_t *c = e.faces[e.edges[i].face[w]];
            uint32_t        from = e.edges[i].vertex[w], to = e.edges[i].vertex[1 - w];
            assert_true((c[0] == from && c[1] == to) || (c[1] == from && c[2] == to) || (c[2] == from && c[0] == to));
        }
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* Two triangles that meet at the y axis, the second one lifted by `height` at x = 1. */
static uint32_t hinge(double height, double scale, double away, bool closed_below)
{
    float          s = (float)scale, h = (float)(scale * height), a = (float)away;
    const vec3     positions[5] = {{a, a, a}, {a, a + s, a}, {a - s, a, a}, {a + s, a, a + h}, {a, a, a - 3 * s}};
    const uint32_t corners[18] = {0, 1, 2, 1, 0, 3, 0, 2, 4, 3, 0, 4, 1, 3, 4, 2, 1, 4};
    primitive      p = of_faces(positions, 5, corners, closed_below ? 18 : 6);
    edge_mesh      e = sort(&p, 1, 80 * degree);
    uint32_t       flags = flags_between(&e, e.positions[0], e.positions[1]);
    if (closed_below)
        assert_true(e.closed[0] && !e.inward[0]);
    edge_mesh_release(&e);
    primitive_release(&p);
    return flags;
}

static void convex_edges_of_bodies_are_candidates(void **state)
{
    (void)state;
    for (int i = 1; i <= 5; i++) {
        assert_int_equal(hinge(-0.1 * i, 1, 0, true), EDGE_CANDIDATE);
        assert_int_equal(hinge(0.1 * i, 1, 0, true), EDGE_CANDIDATE | EDGE_HOLLOW);
        assert_int_equal(hinge(-0.1 * i, 1, 0, false), EDGE_CANDIDATE); /* a sheet has outlines either way */
        assert_int_equal(hinge(0.1 * i, 1, 0, false), EDGE_CANDIDATE);
    }
    for (int i = -12; i <= 12; i += 4) { /* any size */
        assert_int_equal(hinge(-0.1, pow(10, i), 0, true), EDGE_CANDIDATE);
        assert_int_equal(hinge(0.1, pow(10, i), 0, true), EDGE_CANDIDATE | EDGE_HOLLOW);
        assert_int_equal(hinge(0, pow(10, i), 0, true), 0);
    }
}

/* A plane divided into triangles, turned and far away: its positions are rounded, it is flat all the same. */
static void flat_faces_have_no_candidates(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < 40; i++) {
        primitive p = grid_surface(plane_at, 20, 20, false, false, 0.6);
        double    away = i < 10 ? 0 : pow(10, i % 6);
        for (uint32_t v = 0; v < p.vertex_count; v++) {
            place3 q = turned_by((place3){p.positions[v].x, p.positions[v].y, p.positions[v].z}, 0.37 * i);
            p.positions[v] = (vec3){(float)(q.x + away), (float)(q.y - away), (float)(q.z + 0.3 * away)};
        }
        edge_mesh e = sort(&p, 1, 30 * degree);
        uint32_t  candidates = count_flag(&e, EDGE_CANDIDATE);
        if (candidates)
            printf("plane %u, %.0f away: %u of %u edges are candidates\n", i, away, candidates, e.all_edges);
        assert_int_equal(candidates, 0);
        edge_mesh_release(&e);
        primitive_release(&p);
    }
}

static void borders_are_borders(void **state)
{
    (void)state;
    static const vec3     positions[6] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0, 0}, {1, -2, 0}};
    static const uint32_t corners[12] = {
        0, 1, 2, 0, 2, 3, /* and below it two that meet it at the middle of its side */ 0, 5, 4, 4, 5, 1};
    primitive p = of_faces(positions, 6, corners, 12);
    edge_mesh e = sort(&p, 1, 30 * degree);
    assert_int_equal(e.all_edges, 5 + 5);
    assert_int_equal(e.loose_edges, 4 + 4);
    assert_int_equal(count_flag(&e, EDGE_BORDER), 8); /* a vertex in the middle of an edge joins nothing */
    assert_int_equal(e.edge_count, 8);
    assert_int_equal(e.piece_count, 2);
    assert_false(e.closed[0] || e.closed[1]);
    for (uint32_t i = 0; i < e.edge_count; i++)
        assert_int_equal(e.edges[i].face[1], EDGE_NO_FACE);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* Faces that are there twice count once, whichever way round, also where nothing else is. */
static void faces_that_are_there_twice_count_once(void **state)
{
    (void)state;
    static const vec3     positions[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    static const uint32_t alike[12] = {0, 1, 2, 0, 2, 3, 1, 2, 0, 0, 2, 3},
                          flipped[12] = {0, 1, 2, 0, 2, 3, 2, 1, 0, 3, 2, 0}, lone[6] = {0, 1, 2, 2, 1, 0},
                          twice[6] = {0, 1, 2, 1, 2, 0};
    const uint32_t *corners[4] = {alike, flipped, lone, twice}, counts[4] = {12, 12, 6, 6}, faces[4] = {2, 2, 1, 1};
    for (int i = 0; i < 4; i++) {
        primitive p = of_faces(positions, 4, corners[i], counts[i]);
        edge_mesh e = sort(&p, 1, 30 * degree);
        assert_int_equal(e.face_count, faces[i]);
        assert_int_equal(count_flag(&e, EDGE_BORDER), faces[i] == 2 ? 4 : 3);
        assert_int_equal(e.edge_count, faces[i] == 2 ? 4 : 3);
        assert_false(e.closed[0]);
        edge_mesh_release(&e);
        primitive_release(&p);
    }
}

/* One face the wrong way round: its edges are told apart, the angle is that between the faces as they lie. */
static void faces_inside_out_are_told(void **state)
{
    (void)state;
    primitive p = shared_cube();
    uint32_t  other = p.indices[1];
    p.indices[1] = p.indices[2];
    p.indices[2] = other;
    edge_mesh e = sort(&p, 1, 30 * degree);
    assert_int_equal(count_flag(&e, EDGE_CREASE), 12);
    assert_int_equal(count_flag(&e, EDGE_TWISTED), 2); /* that to its flat neighbour is no line */
    assert_int_equal(e.edge_count, 12);
    assert_false(e.closed[0]);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* Three fins at one edge. */
static void edges_of_three_faces_are_borders(void **state)
{
    (void)state;
    static const vec3     positions[5] = {{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}};
    static const uint32_t corners[9] = {0, 1, 2, 0, 1, 3, 0, 1, 4};
    primitive             p = of_faces(positions, 5, corners, 9);
    edge_mesh             e = sort(&p, 1, 30 * degree);
    assert_int_equal(e.all_edges, 7);
    assert_int_equal(e.loose_edges, 7);
    assert_int_equal(count_flag(&e, EDGE_BORDER), 7);
    edge_mesh_release(&e);
    primitive_release(&p);
}

static void materials_part_faces(void **state)
{
    (void)state;
    static const vec3     positions[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    static const uint32_t first[3] = {0, 1, 2}, second[3] = {0, 2, 3};
    primitive             p[2] = {of_faces(positions, 4, first, 3), of_faces(positions, 4, second, 3)};
    for (int same = 0; same < 2; same++) {
        p[1].material = same ? NONE : 0;
        edge_mesh e = sort(p, 2, 30 * degree);
        assert_int_equal(e.vertex_count, 4); /* of two primitives, welded */
        assert_int_equal(count_flag(&e, EDGE_MATERIAL), !same);
        assert_int_equal(flags_between(&e, positions[0], positions[2]), same ? 0 : EDGE_MATERIAL);
        assert_int_equal(count_flag(&e, EDGE_BORDER), 4);
        assert_int_equal(e.piece_count, 1);
        edge_mesh_release(&e);
    }
    primitive_release(&p[0]);
    primitive_release(&p[1]);
}

/* Vertices at one position are one, whatever sign their zeros have; edges without length and faces without area
 * vanish. */
static void vertices_at_one_position_are_one(void **state)
{
    (void)state;
    static const vec3     positions[8] = {{0, 0, 0}, {1, 0, 0},  {0, 1, 0}, {-0.0f, 0, -0.0f},
                                          {0, 1, 0}, {-1, 0, 0}, {0, 1, 0}, {0.5f, 0, 0}};
    static const uint32_t corners[12] = {0, 1, 2, 3, 4, 5, /* an edge without length; three in a line */ 2,
                                         6, 1, 0, 7, 1};
    primitive             p = of_faces(positions, 8, corners, 12);
    edge_mesh             e = sort(&p, 1, 30 * degree);
    assert_int_equal(e.face_count, 2);
    assert_int_equal(e.all_edges, 5);
    assert_int_equal(count_flag(&e, EDGE_BORDER), 4);
    assert_int_equal(e.edge_count, 4);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* A ball whose pole is another vertex for each meridian, since sines of 180 degrees are 1e-16 and not 0: it is closed.
 * Vertices that are as far apart as one sees stay two. */
static void what_was_rounded_is_one_vertex(void **state)
{
    enum { ROWS = 8, COLUMNS = 12, ACROSS = COLUMNS + 1 };
    (void)state;
    for (int k = 0; k < 2; k++) {
        double    off = k ? 1e-3 : 1e-17;
        primitive p = empty_primitive((ROWS + 1) * ACROSS, 6 * ROWS * COLUMNS);
        uint32_t  at = 0;
        for (uint32_t i = 0; i < p.vertex_count; i++) {
            double down = field_pi * (i / ACROSS) / ROWS, turn = 2 * field_pi * (i % ACROSS) / COLUMNS;
            double out = i / ACROSS % ROWS == 0 ? off : sin(down);
            p.positions[i] = (vec3){(float)(out * cos(turn)), (float)(out * sin(turn)), (float)cos(down)};
        }
        for (uint32_t r = 0; r < ROWS; r++)
            for (uint32_t c = 0; c < COLUMNS; c++) {
                uint32_t       a = r * ACROSS + c, b = a + ACROSS;
                const uint32_t quad[6] = {a, b, b + 1, a, b + 1, a + 1};
                memcpy(p.indices + at, quad, sizeof quad);
                at += 6;
            }
        edge_mesh e = sort(&p, 1, 60 * degree);
        assert_int_equal(count_flag(&e, EDGE_BORDER), k ? 2 * COLUMNS : 0);
        assert_int_equal(e.closed[0], !k);
        edge_mesh_release(&e);
        primitive_release(&p);
    }
}

/* A square of two triangles, and half of it once more, divided the other way, as exporters leave it: its diagonal is no
 * border. Where it folds out of the plane it is one. */
static void halves_of_squares_are_covered(void **state)
{
    (void)state;
    for (int folded = 0; folded < 2; folded++) {
        const vec3     corners[4] = {{0, 0, 0}, {1, 0, 0}, {1, 1, folded ? 0.5f : 0}, {0, 1, 0}};
        const uint32_t faces[9] = {0, 1, 2, 0, 2, 3, 0, 1, 3};
        primitive      p = of_faces(corners, 4, faces, 9);
        edge_mesh      e = sort(&p, 1, 30 * degree);
        assert_int_equal((flags_between(&e, corners[1], corners[3]) & EDGE_BORDER) != 0, folded);
        assert_int_equal(e.face_count, folded ? 3 : 2);
        edge_mesh_release(&e);
        primitive_release(&p);
    }
}

static void inside_out_bodies_are_told(void **state)
{
    (void)state;
    primitive p = prism(8);
    for (uint32_t i = 0; i < p.index_count; i += 3) {
        uint32_t other = p.indices[i + 1];
        p.indices[i + 1] = p.indices[i + 2];
        p.indices[i + 2] = other;
    }
    edge_mesh e = sort(&p, 1, 60 * degree);
    assert_true(e.closed[0] && e.inward[0]);
    assert_int_equal(count_flag(&e, EDGE_CANDIDATE), 8); /* convex seen from outside */
    assert_int_equal(count_flag(&e, EDGE_CREASE), 16);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* Is the far corner of the face beyond a half-edge below the face? In double precision. */
static bool is_convex(const primitive *p, uint32_t h, uint32_t beyond)
{
    vec3 a = p->positions[p->indices[h / 3 * 3]], b = p->positions[p->indices[h / 3 * 3 + 1]],
         c = p->positions[p->indices[h / 3 * 3 + 2]];
    vec3   d = p->positions[p->indices[beyond / 3 * 3 + (beyond + 2) % 3]];
    double ux = (double)b.x - a.x, uy = (double)b.y - a.y, uz = (double)b.z - a.z, vx = (double)c.x - a.x,
           vy = (double)c.y - a.y, vz = (double)c.z - a.z;
    return ((double)d.x - a.x) * (uy * vz - uz * vy) + ((double)d.y - a.y) * (uz * vx - ux * vz) +
               ((double)d.z - a.z) * (ux * vy - uy * vx) <
           0;
}

/* Of all convex edges, those between front and back are found, in any view, and no others: that they were sorted
 * before loses nothing. */
static void nothing_that_is_an_outline_was_dropped(void **state)
{
    (void)state;
    primitive p = ball(7, 0.5, (place3){3, 1, 2});
    edge_mesh e = sort(&p, 1, 100 * degree);
    uint32_t *opposite = mesh_adjacency(&p), outlines = 0;
    for (uint32_t view = 0; view < 1000; view++) {
        double       z = 2 * hashed(3 * view) - 1, a = 2 * field_pi * hashed(3 * view + 1), s = sqrt(1 - z * z);
        const double d[3] = {s * cos(a), s * sin(a), z};
        uint32_t     wanted = 0, got = 0, hollow = 0, always_hidden = 0;
        for (uint32_t h = 0; h < p.index_count; h++) {
            vec3 m = e.normals[h / 3], n = e.normals[opposite[h] / 3];
            bool outline = (m.x * d[0] + m.y * d[1] + m.z * d[2] > 0) != (n.x * d[0] + n.y * d[1] + n.z * d[2] > 0);
            wanted += h < opposite[h] && outline && is_convex(&p, h, opposite[h]);
            hollow += h < opposite[h] && outline && !is_convex(&p, h, opposite[h]);
        }
        for (uint32_t i = 0; i < e.edge_count; i++) {
            vec3 m = e.normals[e.edges[i].face[0]], n = e.normals[e.edges[i].face[1]];
            bool outline = (m.x * d[0] + m.y * d[1] + m.z * d[2] > 0) != (n.x * d[0] + n.y * d[1] + n.z * d[2] > 0);
            got += outline && e.edges[i].flags & EDGE_CANDIDATE && !(e.edges[i].flags & EDGE_HOLLOW);
            always_hidden += outline && e.edges[i].flags & EDGE_HOLLOW;
        }
        assert_int_equal(got, wanted);
        assert_int_equal(always_hidden, hollow);
        outlines += wanted;
    }
    assert_true(outlines > 1000 * 20);
    mem_free(opposite);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* --- what files say ------------------------------------------------------------------------------------- */

/* The cube again, with all edges said to be something. */
static edge_mesh said_cube(uint8_t word)
{
    primitive p = shared_cube();
    p.edges.values = mem_alloc(36);
    memset(p.edges.values, word, 36);
    edge_mesh e = sort(&p, 1, 30 * degree);
    primitive_release(&p);
    return e;
}

static void files_have_the_last_word(void **state)
{
    (void)state;
    static const uint32_t edges[4] = {0, 18, 18, 18}, candidates[4] = {0, 18, 0, 0}, creases[4] = {0, 0, 18, 18};
    for (uint8_t word = 0; word < 4; word++) {
        edge_mesh e = said_cube(word);
        assert_int_equal(e.all_edges, 18);
        if (word == SAID_SILHOUETTE) { /* flat ones stay, as the file wants it; none is hollow */
            assert_true(count_flag(&e, EDGE_CANDIDATE) >= 12 && count_flag(&e, EDGE_CANDIDATE) <= candidates[word]);
            assert_int_equal(count_flag(&e, EDGE_CREASE), 0);
        } else {
            assert_int_equal(e.edge_count, edges[word]);
            assert_int_equal(count_flag(&e, EDGE_CANDIDATE), candidates[word]);
            assert_int_equal(count_flag(&e, EDGE_CREASE), creases[word]);
        }
        edge_mesh_release(&e);
    }
}

/* An edge with one face, said to be an outline: it is a rim, and nothing asks for a face that is not there. */
static void rims_that_are_said_to_be_outlines(void **state)
{
    (void)state;
    static const vec3     positions[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 1}};
    static const uint32_t corners[6] = {0, 1, 2, 0, 2, 3};
    static const uint8_t  words[6] = {SAID_SILHOUETTE, SAID_HARD,   SAID_HARD,
                                      SAID_REPEATED,   SAID_HIDDEN, SAID_SILHOUETTE};
    primitive             p = of_faces(positions, 4, corners, 6);
    p.edges.values = mem_copy(words, sizeof words);
    edge_mesh e = sort(&p, 1, 30 * degree);
    assert_int_equal(flags_between(&e, positions[0], positions[1]), EDGE_BORDER);
    assert_int_equal(flags_between(&e, positions[1], positions[2]), EDGE_BORDER | EDGE_CREASE);
    assert_int_equal(flags_between(&e, positions[0], positions[2]),
                     EDGE_CREASE); /* hard on one side, repeated on the other */
    assert_int_equal(flags_between(&e, positions[2], positions[3]), 0);
    assert_int_equal(flags_between(&e, positions[3], positions[0]), EDGE_BORDER);
    for (uint32_t i = 0; i < e.edge_count; i++)
        assert_true(e.edges[i].face[1] != EDGE_NO_FACE || e.edges[i].flags & EDGE_BORDER);
    edge_mesh_release(&e);
    primitive_release(&p);
}

/* A file of two triangles that lie flat: only because it says so, the edge between them is a line. */
static void a_file_is_obeyed(void **state)
{
    (void)state;
    static const float    positions[12] = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};
    static const uint16_t corners[6] = {0, 1, 2, 0, 2, 3};
    const uint8_t         packed[2] = {SAID_HIDDEN | SAID_SILHOUETTE << 2 | SAID_HARD << 4 | SAID_REPEATED << 6,
                                       SAID_HARD | SAID_HIDDEN << 2};
    static glb            g;
    g.bin_size = 0;
    size_t at = glb_put(&g, positions, sizeof positions), b = glb_put(&g, corners, sizeof corners),
           c = glb_put(&g, packed, sizeof packed);
    snprintf(g.json, sizeof g.json,
             "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0}],\"scenes\":[{\"nodes\":[0]}],\"buffers\":[{"
             "\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,\"byteOffset\":%zu,"
             "\"byteLength\":48},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":12},{\"buffer\":0,\"byteOffset\":%zu,"
             "\"byteLength\":2}],\"accessors\":["
             "{\"bufferView\":0,\"count\":4,\"componentType\":5126,\"type\":\"VEC3\",\"min\":[0,0,0],\"max\":[2,2,0]},{"
             "\"bufferView\":1,\"count\":6,\"componentType\":5123,\"type\":\"SCALAR\"},"
             "{\"bufferView\":2,\"count\":2,\"componentType\":5121,\"type\":\"SCALAR\"}],\"extensionsUsed\":[\"EXT_"
             "mesh_primitive_edge_visibility\"],\"meshes\":[{\"primitives\":[{\"indices\":1,"
             "\"attributes\":{\"POSITION\":0},\"extensions\":{\"EXT_mesh_primitive_edge_visibility\":{\"visibility\":2}"
             "}}]}]}",
             g.bin_size, at, b, c);
    lmn_scene *s = load_or_fail(glb_file(&g, "said.glb"));
    edge_mesh  e;
    assert_int_equal(edge_mesh_create(&e, &s->meshes[0], NULL, 30 * degree, NULL), LMN_OK);
    const vec3 p[4] = {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}};
    assert_int_equal(flags_between(&e, p[0], p[1]), 0);
    assert_int_equal(flags_between(&e, p[1], p[2]), EDGE_BORDER);
    assert_int_equal(flags_between(&e, p[0], p[2]), EDGE_CREASE);
    assert_int_equal(flags_between(&e, p[2], p[3]), EDGE_BORDER | EDGE_CREASE);
    assert_int_equal(flags_between(&e, p[3], p[0]), 0);
    edge_mesh_release(&e);
    lmn_scene_destroy(&s);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    primitive  p = ball(3, 0, (place3){1, 1, 1});
    mesh       m = {.primitives = &p, .primitive_count = 1};
    lmn_status status = LMN_MEMORY;
    long       n = 1;
    for (; status != LMN_OK && n < 200; n++) {
        edge_mesh e;
        mem_fail_at(n);
        status = edge_mesh_create(&e, &m, NULL, 1, NULL);
        mem_fail_at(0);
        assert_true(status == LMN_OK || (status == LMN_MEMORY && e.positions == NULL));
        if (status == LMN_OK)
            edge_mesh_release(&e);
    }
    assert_true(n > 8 && status == LMN_OK);
    primitive_release(&p);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(the_octagonal_prism),
        cmocka_unit_test(a_cube_has_no_candidates),
        cmocka_unit_test(faces_lie_where_they_should),
        cmocka_unit_test(convex_edges_of_bodies_are_candidates),
        cmocka_unit_test(flat_faces_have_no_candidates),
        cmocka_unit_test(borders_are_borders),
        cmocka_unit_test(faces_that_are_there_twice_count_once),
        cmocka_unit_test(faces_inside_out_are_told),
        cmocka_unit_test(edges_of_three_faces_are_borders),
        cmocka_unit_test(materials_part_faces),
        cmocka_unit_test(vertices_at_one_position_are_one),
        cmocka_unit_test(what_was_rounded_is_one_vertex),
        cmocka_unit_test(halves_of_squares_are_covered),
        cmocka_unit_test(inside_out_bodies_are_told),
        cmocka_unit_test(nothing_that_is_an_outline_was_dropped),
        cmocka_unit_test(files_have_the_last_word),
        cmocka_unit_test(rims_that_are_said_to_be_outlines),
        cmocka_unit_test(a_file_is_obeyed),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
