/* Lines that files bring: read from glTF and OBJ, parts of their own or with surfaces, strokes of a class of their own
 * that what they lie on does not hide. */
#include "stroke_shapes.h"

#include "cut/cut.h"
#include "stroke/drawn.h"

static const double origin[3] = {0, 0, 0};

static lmn_scene *load_obj(const char *text)
{
    return load_or_fail(temp_file("lines.obj", text, strlen(text)));
}

#define FOUR "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n"

/* --- OBJ ------------------------------------------------------------------------------------------------- */

static void polylines_of_obj(void **state)
{
    (void)state;
    lmn_scene *s = load_obj(FOUR "vt 0 0\no plate\nl 1/1 2/1 3\nf 1 2 3 4\nl -4 -2\no wire\nl 4 \\\n1\n");
    assert_int_equal(s->part_count, 2);
    assert_int_equal(s->parts[0].triangles, 2);
    assert_int_equal(s->parts[0].lines, 3);
    assert_int_equal(s->parts[1].triangles, 0);
    assert_int_equal(s->parts[1].lines, 1);
    assert_string_equal(s->parts[1].name, "wire");
    lmn_part_info wire;
    assert_true(lmn_scene_part_at(s, 1, &wire) && wire.lines == 1 && wire.triangles == 0);
    assert_int_equal(lmn_scene_info_of(s).lines, 4);
    assert_true(s->parts[1].bounds.min.y == 0 && s->parts[1].bounds.max.y == 1 && s->parts[1].bounds.max.x == 0);
    const mesh *m = &s->meshes[s->nodes[s->parts[0].node].mesh];
    assert_int_equal(m->primitive_count, 2);
    assert_int_equal(m->primitives[0].index_count, 6); /* triangles first, though the file has lines first */
    const primitive *p = &m->primitives[1];
    const uint32_t   expected[6] = {0, 1, 1, 2, 0, 2};
    assert_int_equal(p->line_count, 3);
    assert_int_equal(p->vertex_count, 3);
    assert_memory_equal(p->lines, expected, sizeof expected);
    assert_true(!p->indices && !p->uvs[0] && p->positions[2].y == 1);
    assert_false(has_warning(s, WARNING_IGNORED));
    lmn_scene_destroy(&s);
}

static void wrong_polylines_of_obj(void **state)
{
    (void)state;
    static const char *const cases[] = {FOUR "l 1 5\n", FOUR "l 0 1\n", FOUR "l 1 -5\n", FOUR "l 1 2/1\n",
                                        FOUR "l 1 two\n"};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_error error;
        assert_int_equal(load_status(temp_file("wrong.obj", cases[i], strlen(cases[i])), &error), LMN_FORMAT);
        assert_int_equal(error.line, 5);
        assert_non_null(strstr(error.message, "a line has a point"));
    }
    lmn_scene *s = load_obj(FOUR "v nan 0 0\nl 1 2\nl 3\nl\nl 1 1\nl 1 5\np 1\n");
    assert_int_equal(s->parts[0].lines, 1);
    assert_int_equal(s->meshes[0].primitives[0].vertex_count, 2);
    assert_int_equal(s->warnings.count, 4); /* points; one point alone, twice; no length; not finite */
    assert_true(has_warning(s, WARNING_IGNORED) && has_warning(s, WARNING_BAD_GEOMETRY));
    lmn_scene_destroy(&s);
    lmn_error error;
    assert_int_equal(load_status(temp_file("none.obj", FOUR "l 1 1\n", strlen(FOUR) + 6), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "none of the 1 lines has a length"));
}

/* --- glTF ------------------------------------------------------------------------------------------------ */

static glb g;

/* Four points of a square, five indices, and mode and indices of the only primitive. */
static const char *lines_file(int mode, const char *indices, const uint16_t corners[5])
{
    static const float square[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    memset(&g, 0, sizeof g);
    glb_put(&g, square, sizeof square);
    size_t at = glb_put(&g, corners, 10);
    snprintf(g.json, sizeof g.json,
             "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0,\"translation\":[5,0,0]}],\"scenes\":[{\"nodes\":"
             "[0]}],\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
             "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":10}],\"accessors\":[{\"bufferView\":0,\"count\":4,"
             "\"componentType\":5126,\"type\":\"VEC3\"},{\"bufferView\":1,\"count\":5,\"componentType\":5123,"
             "\"type\":\"SCALAR\"}],\"meshes\":[{\"weights\":[1],\"primitives\":[{\"mode\":%d,%s\"attributes\":"
             "{\"POSITION\":0,\"NORMAL\":0},\"targets\":[{\"POSITION\":0}]}]}]}",
             g.bin_size, at, mode, indices);
    return glb_file(&g, "lines.glb");
}

static void assert_lines(int mode, const char *indices, const uint32_t *expected, uint32_t count)
{
    static const uint16_t corners[5] = {0, 1, 2, 3, 1};
    lmn_scene            *s = load_or_fail(lines_file(mode, indices, corners));
    const primitive      *p = &s->meshes[0].primitives[0];
    assert_int_equal(p->line_count, count);
    assert_memory_equal(p->lines, expected, 2 * count * sizeof *expected);
    assert_null(p->normals);
    assert_int_equal(p->morph_count, 1);
    assert_int_equal(s->parts[0].lines, count);
    assert_int_equal(s->parts[0].triangles, 0);
    assert_true(s->parts[0].bounds.max.x == 7); /* moved by the node, twice as large by the morph */
    lmn_scene_destroy(&s);
}

static void lines_of_gltf(void **state)
{
    (void)state;
    static const uint32_t pairs[] = {0, 1, 2, 3}, loop[] = {0, 1, 1, 2, 2, 3, 3, 0}, strip[] = {0, 1, 1, 2, 2, 3, 3, 1};
    assert_lines(1, "", pairs, 2);
    assert_lines(1, "\"indices\":1,", pairs, 2); /* the fifth is left over */
    assert_lines(2, "", loop, 4);
    assert_lines(3, "", loop, 3);
    assert_lines(3, "\"indices\":1,", strip, 4);
    static const uint16_t wrong[5] = {0, 1, 4, 2, 3};
    lmn_error             error;
    assert_int_equal(load_status(lines_file(1, "\"indices\":1,", wrong), &error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "meshes[0].primitives[0].indices[2] is 4"));
    assert_int_equal(load_status(lines_file(0, "", wrong), &error), LMN_FORMAT); /* points alone */
    assert_int_equal(load_status(lines_file(7, "", wrong), &error), LMN_FORMAT);
}

/* Lines follow morphs, joints and instances like triangles. */
static void lines_move(void **state)
{
    (void)state;
    static const float    square[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
    static const float    weights[4][4] = {{1}, {1}, {1}, {1}};
    static const uint8_t  joints[4][4] = {{0}, {1}, {1}, {0}};
    static const uint16_t corners[4] = {0, 1, 2, 3};
    memset(&g, 0, sizeof g);
    glb_put(&g, square, sizeof square);
    size_t b = glb_put(&g, weights, sizeof weights), c = glb_put(&g, joints, sizeof joints),
           d = glb_put(&g, corners, sizeof corners);
    snprintf(g.json, sizeof g.json,
             "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0,\"skin\":0},{},{\"translation\":[0,0,7]},"
             "{\"mesh\":1,\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":0}}}}],"
             "\"scenes\":[{\"nodes\":[0,1,2,3]}],\"skins\":[{\"joints\":[1,2]}],\"extensionsUsed\":["
             "\"EXT_mesh_gpu_instancing\"],\"buffers\":[{\"byteLength\":%zu}],\"bufferViews\":[{\"buffer\":0,"
             "\"byteLength\":48},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":64},{\"buffer\":0,\"byteOffset\":%zu,"
             "\"byteLength\":16},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":8}],\"accessors\":[{\"bufferView\":0,"
             "\"count\":4,\"componentType\":5126,\"type\":\"VEC3\"},{\"bufferView\":1,\"count\":4,\"componentType\":"
             "5126,\"type\":\"VEC4\"},{\"bufferView\":2,\"count\":4,\"componentType\":5121,\"type\":\"VEC4\"},"
             "{\"bufferView\":3,\"count\":4,\"componentType\":5123,\"type\":\"SCALAR\"}],\"meshes\":[{\"primitives\":["
             "{\"mode\":1,\"indices\":3,\"attributes\":{\"POSITION\":0,\"JOINTS_0\":2,\"WEIGHTS_0\":1}}]},"
             "{\"weights\":[2],\"primitives\":[{\"mode\":1,\"attributes\":{\"POSITION\":0},\"targets\":[{"
             "\"POSITION\":0}]}]}]}",
             g.bin_size, b, c, d);
    lmn_scene   *s = load_or_fail(glb_file(&g, "moved.glb"));
    pose         now;
    stroke_scene out;
    assert_int_equal(pose_create(&now, s, &(moment){.seconds = 0}, NULL), LMN_OK);
    assert_int_equal(stroke_scene_create(&out, &now, NULL, 0.5, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(s->parts[0].lines, 2);
    assert_true(s->parts[0].bounds.min.z == 0 && s->parts[0].bounds.max.z == 7);
    assert_int_equal(lmn_scene_info_of(s).lines, 2 + 4 * 2);
    assert_int_equal(out.item_count, 1 + 4);
    const edge_mesh *held = &out.meshes[out.items[0].mesh], *grown = &out.meshes[out.items[2].mesh];
    assert_int_equal(held->line_count, 2);
    assert_true(held->positions[held->lines[0].vertex[0]].z == 0 && held->positions[held->lines[0].vertex[1]].z == 7);
    assert_true(grown->positions[grown->lines[0].vertex[1]].x == 3); /* 1 + 2 · 1 */
    assert_true(out.items[2].world.m[12] == 1 && out.items[4].world.m[13] == 1);
    stroke_scene_release(&out);
    pose_release(&now);
    lmn_scene_destroy(&s);
}

static void memory_may_run_out(void **state)
{
    (void)state;
    static const uint16_t corners[5] = {0, 1, 2, 3, 1};
    char                  gltf[256], obj[256];
    snprintf(gltf, sizeof gltf, "%s", lines_file(2, "\"indices\":1,", corners));
    const char *text = FOUR "l 1 2 3 4\nf 1 2 3 4\n";
    snprintf(obj, sizeof obj, "%s", temp_file("memory.obj", text, strlen(text)));
    const char *const files[2] = {gltf, obj};
    for (int k = 0; k < 2; k++) {
        lmn_status status = LMN_MEMORY;
        long       n = 1;
        for (; status != LMN_OK && n < 400; n++) {
            lmn_scene *s = NULL;
            edge_mesh  e;
            assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
            mem_fail_at(n);
            status = lmn_scene_add_file(s, files[k], NULL, NULL);
            if (status == LMN_OK)
                status = edge_mesh_create(&e, &s->meshes[0], NULL, 0.5, NULL);
            mem_fail_at(0);
            assert_true(status == LMN_OK || status == LMN_MEMORY || status == LMN_READ);
            if (status == LMN_OK) {
                assert_int_equal(e.line_count, k ? 3 : 4); /* the loop comes back over its first line */
                edge_mesh_release(&e);
            }
            lmn_scene_destroy(&s);
        }
        assert_true(n > 20 && status == LMN_OK);
    }
}

/* --- strokes --------------------------------------------------------------------------------------------- */

/* Gives the newest part lines as a second primitive, each point with the next. */
static void add_polyline(lmn_scene *s, const vec3 *points, uint32_t count)
{
    mesh      *m = &s->meshes[s->mesh_count - 1];
    primitive *grown = mem_realloc(m->primitives, (m->primitive_count + 1) * sizeof *grown);
    assert_non_null(grown);
    primitive *p = &grown[m->primitive_count++];
    m->primitives = grown;
    *p = (primitive){.vertex_count = count, .line_count = count - 1, .material = NONE};
    p->positions = mem_copy(points, count * sizeof *points);
    p->lines = mem_alloc(2 * (size_t)count * sizeof *p->lines);
    for (uint32_t i = 0; i + 1 < count; i++) {
        p->lines[2 * i] = i;
        p->lines[2 * i + 1] = i + 1;
    }
}

/* A part that is lines alone. */
static void add_wire(lmn_scene *s, const vec3 *points, uint32_t count)
{
    assert_non_null(scene_append_mesh(s));
    node *n = scene_append_node(s);
    n->mesh = (int32_t)s->mesh_count - 1;
    add_polyline(s, points, count);
}

static void circle(vec3 *out, uint32_t count, double radius, double z, double turn)
{
    for (uint32_t i = 0; i <= count; i++) {
        double at = 2 * stroke_pi * (i % count) / count + turn;
        out[i] = (vec3){(float)(radius * cos(at)), (float)(radius * sin(at)), (float)z};
    }
}

static stroke_options drawn_lines(bool hidden)
{
    stroke_options w = STROKE_OPTIONS_INIT;
    w.hidden = hidden;
    w.crowd = 0;
    w.detail = 1;
    return w;
}

/* On a face that is seen, under one that is not, behind all, before all, and from outside to inside. */
static void lines_on_and_behind_a_cube(void **state)
{
    (void)state;
    const vec3 on[2] = {{-0.5f, -0.5f, 1}, {0.5f, 0.25f, 1}}, under[2] = {{-0.5f, 0, -1}, {0.5f, 0, -1}},
               behind[2] = {{-0.5f, 0, -3}, {0.5f, 0, -3}}, before[2] = {{-0.5f, 0.7f, 3}, {0.5f, 0.7f, 3}},
               through[2] = {{0, 0.9f, 0}, {0.9f, 0.9f, 3}};
    for (int perspective = 0; perspective < 2; perspective++)
        for (int apart = 0; apart < 2; apart++) {
            const vec3 *const all[5] = {on, under, behind, before, through};
            lmn_scene        *s = stroke_scene_begin();
            add_box(s, -1, -1, -1, 1, 1, 1);
            for (int i = 0; i < 5; i++)
                (apart ? add_wire : add_polyline)(s, all[i], 2);
            stroke_camera c = look_along(0, -0.001, -1, origin, 20, perspective ? 0.1 : 2, !perspective, 400, 400);
            stroke_shot   shot = shoot(s, c, drawn_lines(true));
            double        length;
            assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, 0, &length), 3);
            assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, 1, NULL), 3);
            if (!perspective) /* 100 pixels a unit; two thirds of the last one stick out */
                assert_true(fabs(length - (100 + 125 + 60)) < 1);
            assert_int_equal(shot.check.wrong + shot.check.miscounted, 0);
            stroke_set     set;
            stroke_options none = drawn_lines(true);
            none.drawn = false;
            assert_int_equal(stroke_find(&set, shot.view, &none, NULL, NULL, NULL, NULL), LMN_OK);
            assert_int_equal(count_strokes(&set, STROKE_DRAWN, -1, NULL), 0);
            stroke_set_release(&set);
            shot_release(&shot);
        }
}

/* Circles around a barrel, divided otherwise than it is: their chords lie below its faces and above them. They are
 * seen from the silhouette to the silhouette, in one piece. */
static void curves_on_curved_surfaces(void **state)
{
    (void)state;
    static const uint32_t divided[] = {16, 24, 36, 50};
    for (size_t i = 0; i < sizeof divided / sizeof *divided; i++) {
        vec3       points[51];
        lmn_scene *s = stroke_scene_begin();
        add_ball(s, 0, 0, 0, 1, 24, 24);
        circle(points, divided[i], 1, 0, 0.1);
        add_polyline(s, points, divided[i] + 1);
        stroke_shot shot = shoot(s, look_along(0, 1, -0.5, origin, 20, 2, true, 400, 400), drawn_lines(false));
        double      length;
        assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, 0, &length), 1);
        /* Half an ellipse of axes 100 and 44.7 pixels. */
        assert_true(length > 232 && length < 260);
        assert_int_equal(shot.check.wrong, 0);
        shot_release(&shot);
    }
}

/* Along edges that are lines anyway nothing is drawn twice, nor is what the file has twice. */
static void lines_along_edges(void **state)
{
    (void)state;
    const vec3 rim[5] = {{-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}},
               diagonal[2] = {{-1, -1, 1}, {1, 1, 1}}, back[2] = {{1, 1, 1}, {-1, -1, 1}};
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    add_polyline(s, rim, 5);
    add_polyline(s, diagonal, 2);
    add_polyline(s, back, 2);
    stroke_shot shot = shoot(s, look_along(-1, -1.1, -0.9, origin, 20, 2, true, 400, 400), drawn_lines(true));
    assert_int_equal(shot.scene->meshes[0].line_count, 5);
    assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, 0, NULL), 1);
    assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, -1, NULL), 1);
    assert_int_equal(count_strokes(&shot.set, STROKE_CREASE, 0, NULL), 3);
    stroke_set     set;
    stroke_options none = drawn_lines(true);
    none.creases = false; /* then those of the file are all there is */
    none.contours = CONTOURS_NONE;
    assert_int_equal(stroke_find(&set, shot.view, &none, NULL, NULL, NULL, NULL), LMN_OK);
    assert_true(count_strokes(&set, STROKE_DRAWN, 0, NULL) > 1);
    stroke_set_release(&set);
    shot_release(&shot);
}

/* Where polylines cross they go on, where they meet at a corner they end. */
static void crossing_polylines_go_on(void **state)
{
    (void)state;
    const vec3 across[3] = {{-1, 0, 0}, {0, 0, 0}, {1, 0.2f, 0}}, up[3] = {{0, -1, 0}, {0, 0, 0}, {0.2f, 1, 0}};
    lmn_scene *s = stroke_scene_begin();
    add_wire(s, across, 3);
    add_polyline(s, up, 3);
    stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 2, true, 400, 400), drawn_lines(false));
    assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, 0, NULL), 2);
    shot_release(&shot);
    const vec3 corner[3] = {{0.5f, -0.86f, 0}, {0, 0, 0}, {0.5f, 0.86f, 0}}, third[2] = {{-1, 0, 0}, {0, 0, 0}};
    s = stroke_scene_begin();
    add_wire(s, corner, 3);
    add_polyline(s, third, 2);
    shot = shoot(s, look_along(0, 0, -1, origin, 20, 2, true, 400, 400), drawn_lines(false));
    assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, 0, NULL), 3);
    shot_release(&shot);
}

/* The nearest that lines of a circle around the middle of the page come to it, in radii. */
static double least_radius(uint32_t corners)
{
    vec3       points[65];
    lmn_scene *s = stroke_scene_begin();
    circle(points, corners, 1, 0, 0.1);
    add_wire(s, points, corners + 1);
    stroke_options w = drawn_lines(false);
    w.round = 3;
    stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 2, true, 400, 400), w);
    double      least = INFINITY;
    for (size_t i = 0; i < shot.set.stroke_count; i++)
        for (uint32_t k = 0; k + 1 < shot.set.strokes[i].count; k++) {
            const stroke_point *p = &shot.set.points[shot.set.strokes[i].first + k];
            least = fmin(least, hypot(0.5 * (double)(p[0].x + p[1].x) - 200, 0.5 * (double)(p[0].y + p[1].y) - 200));
        }
    shot_release(&shot);
    return least / 100;
}

/* CAD programs write circles as lines: they are drawn round as circles of edges are. What turns too far for that is
 * drawn as it is written. */
static void circles_are_round(void **state)
{
    (void)state;
    static const uint32_t corners[] = {16, 24, 48};
    for (size_t i = 0; i < sizeof corners / sizeof *corners; i++)
        assert_true(fabs(least_radius(corners[i]) - 1) < 1e-3); /* chords: 0.981, 0.991, 0.998 */
    for (uint32_t i = 4; i <= 8; i += 2)
        assert_true(fabs(least_radius(i) - cos(stroke_pi / i)) < 1e-3);
}

/* A part that is lines alone has a piece, and small as it is its lines stay. */
static void wires_are_parts(void **state)
{
    (void)state;
    vec3       points[13];
    lmn_scene *s = stroke_scene_begin();
    add_box(s, -1, -1, -1, 1, 1, 1);
    circle(points, 12, 0.02, 1.5, 0);
    add_wire(s, points, 13);
    stroke_options w = drawn_lines(false);
    w.detail = 0.5f;
    stroke_shot shot = shoot(s, look_along(0, 0, -1, origin, 20, 2, true, 400, 400), w);
    assert_int_equal(s->part_count, 2);
    assert_int_equal(shot.scene->meshes[1].piece_count, 1);
    assert_true(box3_diagonal(shot.scene->meshes[1].boxes[0]) > 0.05);
    assert_int_equal(count_strokes(&shot.set, STROKE_DRAWN, 0, NULL), 1);
    for (size_t i = 0; i < shot.set.stroke_count; i++)
        if (shot.set.strokes[i].kind == STROKE_DRAWN) {
            assert_int_equal(shot.set.strokes[i].part, 2);
            assert_true(shot.set.strokes[i].closed);
        }
    shot_release(&shot);
}

/* Poses and refinements keep the lines and their numbers. */
static void poses_and_refinements_keep_lines(void **state)
{
    (void)state;
    vec3       points[13];
    lmn_scene *s = stroke_scene_begin();
    add_ball(s, 0, 0, 0, 1, 12, 12);
    circle(points, 12, 1, 0, 0);
    add_polyline(s, points, 13);
    assert_int_equal(scene_finish(s, "test", NULL), LMN_OK);
    const mesh    *m = &s->meshes[0];
    edge_topology *t = NULL;
    edge_mesh      posed, sorted;
    bool           fits;
    uint32_t       first = m->primitives[0].vertex_count, count = first + m->primitives[1].vertex_count;
    vec3          *moved = mem_alloc(count * sizeof *moved);
    memcpy(moved, m->primitives[0].positions, first * sizeof *moved);
    memcpy(moved + first, m->primitives[1].positions, (count - first) * sizeof *moved);
    for (uint32_t i = 0; i < count; i++)
        moved[i].z *= 3;
    assert_int_equal(edge_topology_create(&t, m, NULL), LMN_OK);
    assert_int_equal(edge_mesh_pose(&posed, t, moved, 0.5, &fits, NULL), LMN_OK);
    assert_int_equal(edge_mesh_create(&sorted, m, moved, 0.5, NULL), LMN_OK);
    assert_true(fits);
    assert_int_equal(posed.line_count, 12);
    assert_int_equal(posed.piece_count, 2);
    assert_memory_equal(posed.lines, sorted.lines, 12 * sizeof *posed.lines);
    assert_memory_equal(posed.boxes, sorted.boxes, 2 * sizeof *posed.boxes);
    edge_mesh_release(&posed);
    edge_mesh_release(&sorted);
    edge_topology_destroy(&t);
    mem_free(moved);
    stroke_scene refined;
    pose         at_rest;
    assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, NULL), LMN_OK);
    assert_int_equal(stroke_scene_create_refined(&refined, &at_rest, NULL, 0.5, 1, NULL, NULL, NULL), LMN_OK);
    assert_int_equal(refined.meshes[0].line_count, 12);
    for (uint32_t i = 0; i < 12; i++) {
        vec3 p = refined.meshes[0].positions[refined.meshes[0].lines[i].vertex[0]];
        assert_true(p.z == 0 && fabsf(p.x * p.x + p.y * p.y - 1) < 1e-5f);
    }
    stroke_scene_release(&refined);
    pose_release(&at_rest);
    lmn_scene_destroy(&s);
}

/* What a section takes away of lines; with surfaces, without, and where all surfaces go. */
static void sections_cut_lines(void **state)
{
    (void)state;
    static const char *const specs[] = {"x=0.25", "x=-1.5", "x=3", "box=-0.5,-9,-9:0.5,9,9"};
    static const float       left[] = {2.25f, 0.5f, 4, 3};
    for (size_t i = 0; i < 4; i++)
        for (int wire = 0; wire < 2; wire++) {
            const vec3 line[2] = {{-2, 0, 1}, {2, 0, 1}};
            lmn_scene *s = stroke_scene_begin();
            if (!wire)
                add_box(s, -1, -1, -1, 1, 1, 1);
            (wire ? add_wire : add_polyline)(s, line, 2);
            assert_int_equal(scene_finish(s, "test", NULL), LMN_OK);
            pose              at_rest;
            cut               c;
            stroke_scene      out;
            stroke_topologies kept = {NULL};
            assert_int_equal(pose_create(&at_rest, s, &(moment){.seconds = 0}, NULL), LMN_OK);
            assert_int_equal(cut_parse(&c, specs[i], (box3){{-2, -1, -1}, {2, 1, 1}}, NULL), LMN_OK);
            stroke_section section = {&c, NULL};
            assert_int_equal(stroke_scene_create_keeping(&out, &at_rest, NULL, 0.5, 0, &kept, &section, NULL), LMN_OK);
            assert_int_equal(out.item_count, 1);
            const edge_mesh *m = &out.meshes[out.items[0].mesh];
            float            length = 0;
            for (uint32_t k = 0; k < m->line_count; k++)
                length += fabsf(m->positions[m->lines[k].vertex[1]].x - m->positions[m->lines[k].vertex[0]].x);
            assert_true(fabsf(length - left[i]) < 1e-5f);
            assert_int_equal(m->line_count, i == 3 ? 2 : 1);
            assert_true((m->face_count == 0) == (wire || i == 1));
            stroke_scene_release(&out);
            stroke_topologies_release(&kept);
            pose_release(&at_rest);
            lmn_scene_destroy(&s);
        }
}

/* --- what files say of edges ------------------------------------------------------------------------------- */

/* Of a prism of six sides, a file shows its edges as it likes: hidden ones are no lines whatever their angle, hard ones
 * are lines, those of the silhouette only where they are it. */
static void edge_visibility_is_drawn(void **state)
{
    (void)state;
    static const uint8_t words[3] = {SAID_HIDDEN, SAID_SILHOUETTE, SAID_HARD};
    size_t               creases[3], contours[3];
    for (int k = 0; k < 3; k++) {
        lmn_scene *s = stroke_scene_begin();
        add_box(s, -1, -1, -1, 1, 1, 1);
        primitive *p = &s->meshes[0].primitives[0];
        p->edges.values = mem_alloc(p->index_count);
        memset(p->edges.values, words[k], p->index_count);
        stroke_shot shot = shoot(s, look_along(-1, -1.1, -0.9, origin, 20, 2, true, 400, 400), drawn_lines(false));
        creases[k] = count_strokes(&shot.set, STROKE_CREASE, 0, NULL);
        contours[k] = count_strokes(&shot.set, STROKE_CONTOUR, 0, NULL);
        shot_release(&shot);
    }
    assert_true(creases[0] == 0 && contours[0] == 0);
    assert_true(creases[1] == 0 && contours[1] == 1);
    assert_true(creases[2] == 6 && contours[2] == 1); /* the diagonals of three faces too */
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(polylines_of_obj),
        cmocka_unit_test(wrong_polylines_of_obj),
        cmocka_unit_test(lines_of_gltf),
        cmocka_unit_test(lines_move),
        cmocka_unit_test(memory_may_run_out),
        cmocka_unit_test(lines_on_and_behind_a_cube),
        cmocka_unit_test(curves_on_curved_surfaces),
        cmocka_unit_test(lines_along_edges),
        cmocka_unit_test(circles_are_round),
        cmocka_unit_test(wires_are_parts),
        cmocka_unit_test(crossing_polylines_go_on),
        cmocka_unit_test(poses_and_refinements_keep_lines),
        cmocka_unit_test(sections_cut_lines),
        cmocka_unit_test(edge_visibility_is_drawn),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
