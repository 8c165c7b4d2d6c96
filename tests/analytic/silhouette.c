/* Which edges are lines, decided on the GPU, against all edges of the mesh in double precision: thousands of views,
 * with and without perspective, of closed, open, turned, stretched and mirrored parts. Each edge gets a block of
 * two by two pixels whose corners are the corners of its quad, so that corners that do not agree show. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "gpu/gpu.h"
#include "lines/stroke/strokes.h"
#include "scenes.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 512, EDGES_MAX = SIDE / 2 * (SIDE / 2), VIEWS = 260, WANT_CONTOUR = 32, ALL = 127 };

static const char vertex_stage[] = "#include \"lines/stroke/decide.glsl\"\n"
                                   "uniform int u_side;\n"
                                   "out float v_line;\n"
                                   "void main()\n"
                                   "{\n"
                                   "    int edge = gl_VertexID >> 2;\n"
                                   "    vec2 corner = vec2(float(2 * (edge % (u_side / 2)) + 2 * (gl_VertexID & 1)), "
                                   "float(2 * (edge / (u_side / 2)) + (gl_VertexID & 2)));\n"
                                   "    v_line = float(line_of_edge());\n"
                                   "    gl_Position = vec4(2.0 * corner / float(u_side) - 1.0, 0.0, 1.0);\n"
                                   "}\n";
static const char fragment_stage[] =
    "in float v_line;\nlayout(location = 0) out vec4 out_0;\nvoid main() { out_0 = vec4(v_line, 1.0, 0.0, 1.0); }\n";

/* An edge of the shape as the reference knows it. */
typedef struct truth_edge {
    dvec   ends[2];
    dvec   normals[2]; /* not of unit length */
    int    faces;
    double height; /* how far the second face rises above the first, fraction of its reach; below 0: convex */
} truth_edge;

typedef struct truth_mesh {
    truth_edge *edges;
    size_t      count;
    bool        closed;
    double      volume; /* below 0: inside out */
} truth_mesh;

static dvec corner_of(const shape_part *p, uint32_t i)
{
    return dvec_from(p->positions[p->indices[i]]);
}

static bool same_position(dvec a, dvec b)
{
    return a.x == b.x && a.y == b.y && a.z == b.z;
}

static int compare_positions(dvec a, dvec b)
{
    return a.x != b.x   ? (a.x < b.x ? -1 : 1)
           : a.y != b.y ? (a.y < b.y ? -1 : 1)
           : a.z != b.z ? (a.z < b.z ? -1 : 1)
                        : 0;
}

typedef struct half {
    dvec low, high, beyond, normal;
} half;

static int compare_halves(const void *a, const void *b)
{
    const half *p = a, *q = b;
    int         first = compare_positions(p->low, q->low);
    return first ? first : compare_positions(p->high, q->high);
}

/* All edges of a part with one or two faces. */
static void truth_make(truth_mesh *out, const shape_part *p)
{
    half  *halves = check_alloc(p->index_count, sizeof *halves);
    size_t count = 0;
    for (uint32_t i = 0; i < p->index_count; i += 3) {
        dvec c[3] = {corner_of(p, i), corner_of(p, i + 1), corner_of(p, i + 2)};
        dvec normal = dvec_cross(dvec_sub(c[1], c[0]), dvec_sub(c[2], c[0]));
        if (dvec_dot(normal, normal) == 0)
            continue;
        for (int k = 0; k < 3; k++) {
            dvec a = c[k], b = c[(k + 1) % 3];
            bool turned = compare_positions(a, b) > 0;
            halves[count++] = (half){turned ? b : a, turned ? a : b, c[(k + 2) % 3], normal};
        }
    }
    qsort(halves, count, sizeof *halves, compare_halves);
    *out = (truth_mesh){check_alloc(count, sizeof *out->edges), 0, true, 0};
    for (uint32_t i = 0; i < p->index_count; i += 3)
        out->volume += dvec_dot(corner_of(p, i), dvec_cross(corner_of(p, i + 1), corner_of(p, i + 2)));
    for (size_t i = 0, next; i < count; i = next) {
        for (next = i + 1; next < count && same_position(halves[next].low, halves[i].low) &&
                           same_position(halves[next].high, halves[i].high);)
            next++;
        truth_edge e = {
            .ends = {halves[i].low, halves[i].high}, .faces = (int)(next - i), .normals = {halves[i].normal}};
        if (e.faces == 2) {
            dvec reach = dvec_sub(halves[i + 1].beyond, halves[i].low);
            e.normals[1] = halves[i + 1].normal;
            e.height =
                dvec_dot(reach, e.normals[0]) / sqrt(dvec_dot(reach, reach) * dvec_dot(e.normals[0], e.normals[0]));
        }
        out->closed = out->closed && e.faces == 2;
        out->edges[out->count++] = e;
    }
    free(halves);
}

/* The scene's mesh as the engine takes it. */
static bool mesh_of(mesh *m, primitive *out, const shape_part *p)
{
    memset(m, 0, sizeof *m);
    memset(out, 0, sizeof *out);
    out->vertex_count = p->vertex_count;
    out->positions = (vec3 *)(void *)p->positions;
    out->index_count = p->index_count;
    out->indices = p->indices;
    out->material = NONE;
    m->primitives = out;
    m->primitive_count = 1;
    return p->index_count > 0;
}

/* --- the GPU -------------------------------------------------------------------------------------------- */

static void write_stage(const char *name, const char *text)
{
    FILE *file = fopen(check_path("%s", name), "w");
    if (!file)
        return;
    fputs(text, file);
    fclose(file);
}

static gpu *open_gpu(bool es)
{
    lmn_error error = {0};
    gpu      *g = NULL;
    write_stage("decisions.vert", vertex_stage);
    write_stage("decisions.frag", fragment_stage);
    setenv("LIMNER_SHADER_DIR", check_path("."), 1);
    check_that("OE-07", gpu_create(&g, es, true, &error) == LMN_OK, "a context: %s", error.message);
    return g;
}

/* Decisions of all edges, 4 values each; `viewer` in the mesh's axes. */
static void ask(gpu *g, gpu_texture *picture, gpu_marks *marks, const double viewer[4], bool inside, float *out)
{
    gpu_program *program = gpu_program_of(g, GPU_FLOOR, "decisions.vert", "decisions.frag", "");
    gpu_pass_begin(g, &(gpu_pass){.colours = {picture}, .colour_count = 1, .clear = true});
    gpu_use(g, program, (gpu_state){0});
    gpu_set_int(g, "u_side", SIDE);
    gpu_set_int(g, "u_wanted", ALL);
    gpu_set_int(g, "u_inside", inside);
    gpu_set_vec4(g, "u_viewer", (float[]){(float)viewer[0], (float)viewer[1], (float)viewer[2], (float)viewer[3]});
    gpu_draw_marks(g, marks);
    gpu_read(g, picture, out);
}

/* --- the comparison ------------------------------------------------------------------------------------- */

typedef struct tally {
    long edges, outlines, wrong, ties, torn, lost;
} tally;

static double facing(dvec normal, dvec position, const double viewer[4])
{
    dvec to = dvec_of(viewer[0] - viewer[3] * position.x, viewer[1] - viewer[3] * position.y,
                      viewer[2] - viewer[3] * position.z);
    return dvec_dot(normal, to) / sqrt(dvec_dot(normal, normal) * fmax(dvec_dot(to, to), 1e-300));
}

/* Is an edge between a face that is seen from the front and one that is not: 1 yes, 0 no, −1 too close to tell in
 * single precision. Both ends are asked: they must agree. */
static int is_outline(const truth_edge *e, const double viewer[4])
{
    if (e->faces != 2)
        return 0;
    double f[2][2];
    for (int end = 0; end < 2; end++)
        for (int k = 0; k < 2; k++) {
            f[end][k] = facing(e->normals[k], e->ends[end], viewer);
            if (fabs(f[end][k]) < 2e-6)
                return -1;
        }
    return (f[0][0] > 0) != (f[0][1] > 0);
}

/* The record of an edge: its number, or −1. Edges and records have both been sorted by position. */
typedef struct keyed {
    dvec low, high;
    int  number;
} keyed;

static int compare_keys(const void *a, const void *b)
{
    const keyed *p = a, *q = b;
    int          first = compare_positions(p->low, q->low);
    return first ? first : compare_positions(p->high, q->high);
}

static keyed *sort_records(const float *records, size_t count)
{
    keyed *keys = check_alloc(count, sizeof *keys);
    for (size_t i = 0; i < count; i++) {
        dvec a = dvec_from(&records[EDGE_RECORD_FLOATS * i]), b = dvec_from(&records[EDGE_RECORD_FLOATS * i + 4]);
        bool turned = compare_positions(a, b) > 0;
        keys[i] = (keyed){turned ? b : a, turned ? a : b, (int)i};
    }
    qsort(keys, count, sizeof *keys, compare_keys);
    return keys;
}

static int find_record(const keyed *keys, size_t count, const truth_edge *e)
{
    keyed wanted = {e->ends[0], e->ends[1], 0}, *found = bsearch(&wanted, keys, count, sizeof *keys, compare_keys);
    return found ? found->number : -1;
}

static void compare(tally *t, const truth_mesh *truth, const keyed *keys, size_t record_count, const float *records,
                    const float *picture, const double viewer[4])
{
    for (size_t i = 0; i < truth->count; i++) {
        const truth_edge *e = &truth->edges[i];
        int               outline = is_outline(e, viewer), record = find_record(keys, record_count, e);
        bool              concave = truth->closed && (truth->volume < 0 ? -e->height : e->height) >= -2e-6;
        t->edges++;
        t->ties += outline < 0;
        t->outlines += outline > 0;
        if (record < 0) { /* never an outline that can be seen */
            t->lost += outline > 0 && !concave;
            continue;
        }
        int          x = 2 * (record % (SIDE / 2)), y = 2 * (record / (SIDE / 2));
        const float *low = &picture[4 * (y * SIDE + x)], *high = low + 4 * SIDE;
        float        line = low[0];
        t->torn += low[4] != line || high[0] != line || high[4] != line || low[1] != 1;
        bool always = ((int)records[EDGE_RECORD_FLOATS * record + 3] & RECORD_BORDER) != 0;
        if (outline >= 0)
            t->wrong += (line == 0) != (always || outline > 0);
    }
}

/* Views from all around, also from near and inside; every second one without perspective. */
static void random_viewer(uint32_t *state, double out[4], bool parallel)
{
    double z = scene_between(state, -1, 1), turn = scene_between(state, 0, 2 * 3.14159265358979), r = sqrt(1 - z * z);
    double distance = parallel ? 1 : scene_between(state, 0.4, 6);
    out[0] = distance * r * cos(turn);
    out[1] = distance * r * sin(turn);
    out[2] = distance * z;
    out[3] = parallel ? 0 : 1;
}

static void check_part(gpu *g, gpu_texture *picture, const shape_part *p, const char *what)
{
    mesh       m;
    primitive  only;
    edge_mesh  edges;
    lmn_error  error = {0};
    truth_mesh truth;
    truth_make(&truth, p);
    bool good =
        mesh_of(&m, &only, p) && edge_mesh_create(&edges, &m, NULL, 30 * 3.14159265358979 / 180, &error) == LMN_OK;
    check_that("OE-06", good && edges.edge_count <= EDGES_MAX, "%s: %zu edges, %u records", what, truth.count,
               good ? edges.edge_count : 0);
    float *records = good ? strokes_edge_records(&edges) : NULL, *read = check_alloc(SIDE * SIDE * 4, sizeof *read);
    if (records && edges.edge_count <= EDGES_MAX) {
        gpu_marks *marks = gpu_marks_create(g, EDGE_RECORD_VECTORS, records, edges.edge_count);
        keyed     *keys = sort_records(records, edges.edge_count);
        tally      t = {0};
        uint32_t   state = 77;
        for (int i = 0; i < VIEWS; i++) {
            double viewer[4];
            random_viewer(&state, viewer, i % 2);
            /* Where the eye is among the parts nothing is left out; that closed parts hide what is seen from behind
             * is no question of outlines. */
            ask(g, picture, marks, viewer, i % 3 == 0, read);
            compare(&t, &truth, keys, edges.edge_count, records, read, viewer);
        }
        check_note("%s: %d views, %ld decisions, %ld outlines, %ld ties", what, VIEWS, t.edges, t.outlines, t.ties);
        check_at_least("OE-07", (double)t.outlines, VIEWS, "%s: outlines there are", what);
        check_at_most("OE-07", (double)t.wrong, 0, "%s: decisions unlike those in double precision", what);
        check_at_most("OE-07", (double)t.torn, 0, "%s: edges whose corners do not agree", what);
        check_at_most("OE-03", (double)t.lost, 0, "%s: outlines that can be seen and have no record", what);
        free(keys);
        gpu_marks_destroy(g, &marks);
    }
    check_that("OE-07", gpu_check(g, &error) == LMN_OK, "no error: %s", error.message);
    if (good)
        edge_mesh_release(&edges);
    free(records);
    free(read);
    free(truth.edges);
}

/* Moves, stretches and mirrors the places themselves, so that faces are of any shape. */
static void distort(shape_part *p, const double m[9])
{
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        float *v = p->positions[i], x = v[0], y = v[1], z = v[2];
        for (int k = 0; k < 3; k++)
            v[k] = (float)(m[k] * x + m[3 + k] * y + m[6 + k] * z);
    }
}

static void decisions_on(bool es)
{
    gpu *g = open_gpu(es);
    if (!g)
        return;
    gpu_texture *picture = gpu_target_acquire(g, SIDE, SIDE, GPU_RGBA32F);
    shape        s = {0};
    shape_sphere(&s, "sphere", dvec_of(0.1, -0.2, 0), 1, 40, 80, false);
    check_part(g, picture, &s.parts[0], "sphere");
    shape_torus(&s, "ring", 0.8, 0.3, 72, 40);
    check_part(g, picture, &s.parts[1], "ring");
    distort(&s.parts[1], (double[]){1.3, 0.2, 0.1, -0.3, 0.5, 0.1, 0, 0.4, -0.9});
    check_part(g, picture, &s.parts[1], "stretched and mirrored ring");
    shape_terrain(&s, "hills", 1.4, 0.5, 40, 5);
    check_part(g, picture, &s.parts[2], "hills");
    shape_box(&s, "box", dvec_of(-0.6, -0.3, -0.7), dvec_of(0.5, 0.4, 0.6));
    check_part(g, picture, &s.parts[3], "box");
    shape_release(&s);
    gpu_target_release(g, picture);
    gpu_destroy(&g);
}

static void desktop(void)
{
    decisions_on(false);
}

static void embedded(void)
{
    decisions_on(true);
}

/* --- row OE-10: what the search for outlines of refined meshes takes ------------------------------------------ */

static json_t *search_of(const char *report)
{
    json_t *root = report ? json_loads(report, 0, NULL) : NULL, *search = json_object_get(root, "outline_search");
    json_incref(search);
    json_decref(root);
    return search;
}

/* Levels of up to 16,384 faces are searched whole, the finer one near their outline alone, in pictures and sheets. */
static void search_is_told(void)
{
    enum { FACES = 2 * 60 * 40, ALL = FACES * (1 + 4 + 16), WHOLE = FACES };
    static const char look_text[] =
        "{\"version\":1,\"name\":\"t\",\"rules\":[{\"select\":\"*\",\"surface\":\"flat\",\"lines\":{"
        "\"technique\":\"strokes\",\"visibility\":\"exact\",\"refine\":%d}}]}";
    for (int refine = 2; refine >= 0; refine -= 2) {
        char      look[256];
        shape     s = {0};
        shot      drawn;
        shot_view view = {.width = 160, .height = 160, .eye = {3, 4, 5}, .up = {0, 1, 0}, .without_maps = true};
        snprintf(look, sizeof look, look_text, refine);
        shape_torus(&s, "ring", 1, 0.4, 60, 40);
        if (shot_of_shape(&drawn, &s, "search.glb", look, NULL, &view)) {
            json_t *search = search_of(drawn.report);
            double  faces = (double)json_integer_value(json_object_get(search, "faces")),
                   tested = (double)json_integer_value(json_object_get(search, "tested"));
            check_near("OE-10", faces, refine ? ALL : 0, 0, "faces of all levels, refined %d times", refine);
            check_at_least("OE-10", tested, refine ? WHOLE + 1 : 0, "  of them tested, the first level's and more");
            check_at_most("OE-10", tested, refine ? 0.5 * ALL : 0, "  but few");
            json_decref(search);
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"desktop", desktop}, {"es", embedded}, {"search", search_is_told}};
    int                     status = check_main(argc, argv, "silhouette", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
