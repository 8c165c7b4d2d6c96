/* STEP files against what OpenCASCADE knows of them without triangles: sizes, volumes, edges, names, colours, units,
 * places; and what becomes of files that are damaged. */
#include "import_support.h"

#include <math.h>

#include "base/colour.h"
#include "base/work.h"
#include "import/step.h"
#include "import/step_module.h"
#include "plan/unit.h"

/* A file that was written before anything could be read, small and without curves. */
#define EMPTY                                                                                                          \
    "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\n"                    \
    "FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"

/* --- answers that lie ------------------------------------------------------------------------------------ */

typedef struct answer {
    unsigned char bytes[1024];
    size_t        size;
} answer;

static void add(answer *a, const void *bytes, size_t size)
{
    assert_true(a->size + size <= sizeof a->bytes);
    memcpy(a->bytes + a->size, bytes, size);
    a->size += size;
}

static void add_u32(answer *a, uint32_t value)
{
    add(a, &value, sizeof value);
}

typedef struct answer_numbers {
    uint32_t index, edge, line, mesh, parent;
} answer_numbers;

/* One triangle, one line, one node. */
static answer make_answer(answer_numbers n)
{
    answer            a = {.size = 0};
    const step_losses none = {0, 0, 0, 0, 0};
    const float       one = 1, colour[4] = {1, 0, 0, 1}, at[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const float       up[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    const double      identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    add_u32(&a, 2), add(&a, "MM", 2);
    add_u32(&a, 1), add(&a, "t", 1), add_u32(&a, 0), add_u32(&a, 0), add_u32(&a, 0);
    add(&a, &one, 4), add(&a, &none, sizeof none);
    add_u32(&a, 1), add_u32(&a, 1), add(&a, "m", 1), add_u32(&a, 1);
    add_u32(&a, 1), add(&a, colour, sizeof colour), add_u32(&a, 3), add_u32(&a, 3);
    add(&a, at, sizeof at), add(&a, up, sizeof up);
    add_u32(&a, 0), add_u32(&a, 1), add_u32(&a, n.index);
    const unsigned char edges[3] = {1, 2, (unsigned char)n.edge};
    add(&a, edges, 3);
    add_u32(&a, 2), add_u32(&a, 1), add_u32(&a, 1), add(&a, at, 6 * sizeof(float)), add_u32(&a, 0), add_u32(&a, n.line);
    add_u32(&a, 1), add_u32(&a, n.parent), add_u32(&a, 1), add(&a, "n", 1), add(&a, identity, sizeof identity);
    add_u32(&a, n.mesh);
    return a;
}

static lmn_status read_answer(const unsigned char *bytes, size_t size)
{
    lmn_error           error = {0};
    lmn_scene          *scene = scene_new();
    const lmn_load_desc standard = LMN_LOAD_DESC_INIT;
    import_job          job = {.path = "x.step", .model = "x.step", .scene = scene, .desc = &standard};
    lmn_status          status = step_answer_read(&job, STEP_KIND_STEP, bytes, size, &error);
    if (status == LMN_OK)
        status = scene_finish(scene, "x.step", &error);
    scene_free(scene);
    return status;
}

static lmn_status read_numbers(answer_numbers n)
{
    answer a = make_answer(n);
    return read_answer(a.bytes, a.size);
}

static void answers_are_not_believed(void **state)
{
    (void)state;
    const answer_numbers good = {2, 1, 1, 0, STEP_NONE};
    assert_int_equal(read_numbers(good), LMN_OK);
    assert_int_equal(read_numbers((answer_numbers){3, 1, 1, 0, STEP_NONE}), LMN_FORMAT);
    assert_int_equal(read_numbers((answer_numbers){2, 7, 1, 0, STEP_NONE}), LMN_FORMAT);
    assert_int_equal(read_numbers((answer_numbers){2, 1, 2, 0, STEP_NONE}), LMN_FORMAT);
    assert_int_equal(read_numbers((answer_numbers){2, 1, 1, 1, STEP_NONE}), LMN_FORMAT);
    assert_int_equal(read_numbers((answer_numbers){2, 1, 1, 0, 0}), LMN_FORMAT);
    answer a = make_answer(good);
    for (size_t size = 0; size < a.size; size++)
        assert_int_equal(read_answer(a.bytes, size), LMN_FORMAT);
    a.bytes[a.size] = 0;
    assert_int_equal(read_answer(a.bytes, a.size + 1), LMN_FORMAT);
}

/* Whatever is changed in one, it is read as something or refused; reading out of bounds is seen by the sanitizers. */
static void answers_may_be_anything(void **state)
{
    (void)state;
    const answer good = make_answer((answer_numbers){2, 1, 1, 0, STEP_NONE});
    uint32_t     seed = 3;
    int          refused = 0;
    for (int i = 0; i < 20000; i++) {
        answer a = good;
        for (int k = 0; k <= i % 3; k++) {
            seed = seed * 1664525u + 1013904223u;
            a.bytes[(seed >> 8) % a.size] = (unsigned char)((seed >> 24) % 3 == 0 ? 255 : seed >> 24);
        }
        lmn_status status = read_answer(a.bytes, a.size);
        assert_true(status == LMN_OK || status == LMN_FORMAT || status == LMN_LIMIT);
        refused += status != LMN_OK;
    }
    assert_true(refused > 2000 && refused < 18000);
}

static void ifc_is_not_taken_for_step(void **state)
{
    (void)state;
    const char *ifc = "ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('IFC2X3'));\nENDSEC;\n", *step = "\n" EMPTY;
    file_data   a = {.data = (unsigned char *)ifc, .size = strlen(ifc)};
    file_data   b = {.data = (unsigned char *)step, .size = strlen(step)};
    assert_false(import_step.recognises(&a));
    assert_true(import_step.recognises(&b));
    b.size = 8;
    assert_false(import_step.recognises(&b));
}

#ifndef LIMNER_HAVE_STEP

static void without_the_library_it_says_so(void **state)
{
    (void)state;
    lmn_error error;
    assert_int_equal(load_status(temp_file("empty.step", EMPTY, strlen(EMPTY)), &error), LMN_UNSUPPORTED);
    assert_non_null(strstr(error.message, "OpenCASCADE"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(answers_are_not_believed), cmocka_unit_test(answers_may_be_anything),
        cmocka_unit_test(ifc_is_not_taken_for_step), cmocka_unit_test(without_the_library_it_says_so)};
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}

#else

#include "step_write.h"

static step_truth bracket;
static char       bracket_path[256], stand_path[256], loose_path[256];

static void path_of(char *out, const char *name)
{
    snprintf(out, 256, "%s/%s", temp_folder(), name);
}

static int write_files(void **state)
{
    (void)state;
    path_of(bracket_path, "bracket.step");
    path_of(stand_path, "stand.stp");
    path_of(loose_path, "loose.step");
    return !step_write_bracket(bracket_path, &bracket) || !step_write_assembly(stand_path) ||
           !step_write_loose(loose_path);
}

static lmn_scene *load_finely(const char *path, double deflection)
{
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    lmn_scene    *scene = NULL;
    lmn_error     error = {0};
    desc.deflection = deflection;
    assert_int_equal(lmn_scene_create(&scene, NULL), LMN_OK);
    if (lmn_scene_add_file(scene, path, &desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return scene;
}

static const mesh *mesh_at(const lmn_scene *s, size_t part)
{
    assert_true(part < s->part_count);
    return &s->meshes[s->nodes[s->parts[part].node].mesh];
}

/* --- shapes ---------------------------------------------------------------------------------------------- */

static double volume_of(const mesh *m)
{
    double sum = 0;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (size_t k = 0; k + 2 < p->index_count; k += 3) {
            const vec3 a = p->positions[p->indices[k]], b = p->positions[p->indices[k + 1]],
                       c = p->positions[p->indices[k + 2]];
            sum += (a.x * ((double)b.y * c.z - (double)b.z * c.y) + a.y * ((double)b.z * c.x - (double)b.x * c.z) +
                    a.z * ((double)b.x * c.y - (double)b.y * c.x)) /
                   6;
        }
    }
    return sum;
}

static double from_segment(const double p[3], vec3 a, vec3 b)
{
    const double d[3] = {b.x - a.x, b.y - a.y, b.z - a.z}, f[3] = {p[0] - a.x, p[1] - a.y, p[2] - a.z};
    double       along = d[0] * f[0] + d[1] * f[1] + d[2] * f[2], length = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    double       t = length > 0 ? fmin(fmax(along / length, 0), 1) : 0, sum = 0;
    for (int k = 0; k < 3; k++)
        sum += (f[k] - t * d[k]) * (f[k] - t * d[k]);
    return sqrt(sum);
}

static double from_lines(const mesh *m, const double p[3])
{
    double least = HUGE_VAL;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *l = &m->primitives[i];
        for (uint32_t k = 0; k < l->line_count; k++)
            least = fmin(least, from_segment(p, l->positions[l->lines[2 * k]], l->positions[l->lines[2 * k + 1]]));
    }
    return least;
}

/* Within the deflection that was asked for, whatever it is; and it makes a difference. */
static void solids_are_as_large_as_they_are(void **state)
{
    (void)state;
    static const double deflections[] = {0.5, 0.05, 0.005};
    double              errors[3];
    uint64_t            triangles[3];
    for (int i = 0; i < 3; i++) {
        lmn_scene *s = load_finely(bracket_path, deflections[i]);
        errors[i] = fabs(volume_of(mesh_at(s, 0)) - bracket.volume);
        triangles[i] = s->parts[0].triangles;
        assert_int_equal(s->part_count, 1);
        assert_true(errors[i] <= bracket.area * deflections[i]);
        const float *low = &s->parts[0].bounds.min.x, *high = &s->parts[0].bounds.max.x;
        for (int k = 0; k < 3; k++) {
            assert_true(fabs(low[k] - bracket.low[k]) <= deflections[i] + 1e-4);
            assert_true(fabs(high[k] - bracket.high[k]) <= deflections[i] + 1e-4);
        }
        lmn_scene_destroy(&s);
    }
    print_message("volume %.3f, wrong by %.3f %.4f %.5f with %d %d %d triangles\n", bracket.volume, errors[0],
                  errors[1], errors[2], (int)triangles[0], (int)triangles[1], (int)triangles[2]);
    assert_true(errors[2] < errors[1] / 4);
    assert_true(triangles[2] > triangles[1] && triangles[1] >= triangles[0]);
}

/* Each edge of the solid, as its curves are, has a line; and there are none besides: seams are no edges. */
static void every_edge_is_a_line(void **state)
{
    (void)state;
    const double deflection = 0.02;
    lmn_scene   *s = load_finely(bracket_path, deflection);
    const mesh  *m = mesh_at(s, 0);
    double       worst = 0, stray = 0;
    for (size_t i = 0; i < bracket.point_count; i++)
        worst = fmax(worst, from_lines(m, &bracket.points[3 * i]));
    for (size_t i = 0; i < m->primitive_count; i++)
        for (uint32_t k = 0; k < 2 * m->primitives[i].line_count; k++) {
            const vec3   p = m->primitives[i].positions[m->primitives[i].lines[k]];
            const double at[3] = {p.x, p.y, p.z};
            double       least = HUGE_VAL;
            for (size_t j = 0; j + 1 < bracket.point_count; j++) {
                const double *a = &bracket.points[3 * j], *b = a + 3;
                least = fmin(least, from_segment(at, (vec3){(float)a[0], (float)a[1], (float)a[2]},
                                                 (vec3){(float)b[0], (float)b[1], (float)b[2]}));
            }
            stray = fmax(stray, least);
        }
    print_message("%d edges, farthest from a line %.4f, of lines from an edge %.4f\n", (int)bracket.edges, worst,
                  stray);
    assert_true(bracket.edges >= 20);
    assert_true(worst <= deflection + 1e-4);
    assert_true(stray <= 0.01); /* the chords of the points that are compared with: 6 mm · (1 - cos 1.8°) */
    lmn_scene_destroy(&s);
}

/* Faces that are one surface cut in two, as writers make of cylinders, have no line between them, but round their ends.
 */
static void halves_are_one_surface(void **state)
{
    (void)state;
    char   path[256];
    double length = 0;
    path_of(path, "halves.step");
    assert_true(step_write_halves(path, 30));
    lmn_scene       *s = load_finely(path, 0.01);
    const mesh      *m = mesh_at(s, 0);
    const primitive *l = &m->primitives[m->primitive_count - 1];
    for (uint32_t k = 0; k < l->line_count; k++) {
        const vec3 a = l->positions[l->lines[2 * k]], b = l->positions[l->lines[2 * k + 1]];
        length += sqrt(pow((double)a.x - b.x, 2) + pow((double)a.y - b.y, 2) + pow((double)a.z - b.z, 2));
        assert_true(fabs((double)a.z - b.z) < 1e-4);
    }
    assert_true(fabs(length - 2 * 2 * 3.14159265 * 5) < 0.1);
    lmn_scene_destroy(&s);
}

/* Lines lie on edges of triangles: these say so, and the others are inside of faces. */
static void triangles_know_their_edges(void **state)
{
    (void)state;
    lmn_scene  *s = load_finely(bracket_path, 0.05);
    const mesh *m = mesh_at(s, 0);
    size_t      sharp = 0, inside = 0;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (size_t k = 0; k < p->index_count; k++) {
            const vec3   a = p->positions[p->indices[k]], b = p->positions[p->indices[k % 3 == 2 ? k - 2 : k + 1]];
            const double middle[3] = {((double)a.x + b.x) / 2, ((double)a.y + b.y) / 2, ((double)a.z + b.z) / 2};
            const bool   on = from_lines(m, middle) < 1e-4;
            if (p->edges.values[k] == STEP_SHARP) {
                sharp++;
                assert_true(on);
            } else {
                inside++;
            }
        }
    }
    assert_true(sharp > 100 && inside > 100);
    lmn_scene_destroy(&s);
}

/* From the surface, not from its chords: as exact as numbers are. */
static void normals_are_those_of_surfaces(void **state)
{
    (void)state;
    lmn_scene  *s = load_finely(bracket_path, 0.5);
    const mesh *m = mesh_at(s, 0);
    size_t      seen = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        for (uint32_t k = 0; k < m->primitives[i].vertex_count && m->primitives[i].normals; k++) {
            const vec3   p = m->primitives[i].positions[k], n = m->primitives[i].normals[k];
            const double x = STEP_WRITE_HOLE_X - p.x, y = STEP_WRITE_HOLE_Y - p.y;
            if (fabs(hypot(x, y) - STEP_WRITE_HOLE_RADIUS) > 1e-3 || fabsf(n.z) > 0.5f)
                continue;
            seen++;
            /* Away from the material, to the axis. */
            assert_true(fabs(n.x - x / STEP_WRITE_HOLE_RADIUS) < 1e-4);
            assert_true(fabs(n.y - y / STEP_WRITE_HOLE_RADIUS) < 1e-4);
        }
    assert_true(seen >= 16);
    lmn_scene_destroy(&s);
}

/* --- names, colours, places ------------------------------------------------------------------------------ */

static vec4 colour_of(const lmn_scene *s, const primitive *p)
{
    assert_true(p->material != NONE);
    return s->materials[p->material].base_colour;
}

static void assert_colour(vec4 is, float r, float g, float b)
{
    assert_true(fabsf(is.x - colour_to_linear(r)) < 2e-3f && fabsf(is.y - colour_to_linear(g)) < 2e-3f &&
                fabsf(is.z - colour_to_linear(b)) < 2e-3f);
}

static size_t find_part(const lmn_scene *s, const char *path)
{
    for (size_t i = 0; i < s->part_count; i++)
        if (strcmp(s->parts[i].path, path) == 0)
            return i;
    for (size_t i = 0; i < s->part_count; i++)
        print_error("part %s\n", s->parts[i].path);
    fail_msg("no part %s", path);
    return 0;
}

static void assert_box(box3 b, const double low[3], const double high[3])
{
    for (int k = 0; k < 3; k++) {
        assert_true(fabs((&b.min.x)[k] - 25.4 * low[k]) < 0.02);
        assert_true(fabs((&b.max.x)[k] - 25.4 * high[k]) < 0.02);
    }
}

/* A face's own colour, and the plain one of the others. */
static void faces_have_their_colours(void **state)
{
    (void)state;
    lmn_scene  *s = load_or_fail(bracket_path);
    const mesh *m = mesh_at(s, 0);
    assert_string_equal(s->parts[0].name, "bracket");
    assert_int_equal(m->primitive_count, 3); /* two colours, and the lines */
    int red = 0;
    for (int i = 0; i < 2; i++) {
        const primitive *p = &m->primitives[i];
        const vec4       c = colour_of(s, p);
        if (c.x < 0.9f)
            continue;
        red++;
        assert_colour(c, 1, 0, 0);
        for (uint32_t k = 0; k < p->vertex_count; k++)
            assert_true(fabsf(p->positions[k].z) < 1e-4f);
    }
    assert_int_equal(red, 1);
    lmn_scene_destroy(&s);
}

static void assemblies_keep_their_tree(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(stand_path);
    assert_int_equal(s->part_count, 4);
    /* The third instance has no name in the file, and has that of what it is. */
    const size_t plate = find_part(s, "stand/stand/plate"), left = find_part(s, "stand/stand/left pin"),
                 right = find_part(s, "stand/stand/right pin"), third = find_part(s, "stand/stand/inner/pin");
    assert_colour(colour_of(s, &mesh_at(s, plate)->primitives[0]), 0.5f, 0.5f, 0.5f);
    assert_colour(colour_of(s, &mesh_at(s, left)->primitives[0]), 0, 0, 1);
    assert_colour(colour_of(s, &mesh_at(s, right)->primitives[0]), 1, 0, 0);
    assert_colour(colour_of(s, &mesh_at(s, third)->primitives[0]), 0, 0, 1);
    /* What is there twice in one colour is one mesh. */
    assert_ptr_equal(mesh_at(s, left), mesh_at(s, third));
    assert_int_equal(s->mesh_count, 3);
    assert_string_equal(mesh_at(s, left)->name, "pin");
    /* In millimetres, though the file has inches. */
    assert_box(s->parts[plate].bounds, (double[]){0, 0, 0}, (double[]){2, 2, 0.25});
    assert_box(s->parts[left].bounds, (double[]){0.25, 0.75, 0.25}, (double[]){0.75, 1.25, 1.25});
    assert_box(s->parts[right].bounds, (double[]){1.25, 0, 0}, (double[]){1.75, 1, 0.5});
    assert_box(s->parts[third].bounds, (double[]){-0.25, -0.25, 2}, (double[]){0.25, 0.25, 3});
    const node *n = &s->nodes[s->parts[plate].node];
    assert_int_equal(n->attribute_count, 1);
    assert_string_equal(n->attributes[0].key, "file-unit");
    assert_string_equal(n->attributes[0].value, "INCH");
    assert_int_equal(s->up, 'z');
    double      mm;
    const char *unit_name;
    bool        stated;
    assert_int_equal(unit_find(NULL, s, &mm, &unit_name, &stated, NULL), LMN_OK);
    assert_true(stated && mm == 1);
    assert_int_equal(s->warnings.count, 0);
    lmn_scene_destroy(&s);
}

/* The same numbers in another unit; a prefix that is none is no prefix. */
static void units_are_obeyed(void **state)
{
    (void)state;
    static const struct {
        const char *unit;
        double      times;
    } rows[] = {{".CENTI.", 10}, {".MICRO.", 1e-3}, {".WRONG.", 1000}, {"$      ", 1000}};
    file_data f = {0};
    assert_int_equal(file_load(&f, bracket_path, NULL), LMN_OK);
    char *text = malloc(f.size + 1), *at;
    memcpy(text, f.data, f.size);
    text[f.size] = '\0';
    assert_non_null(at = strstr(text, ".MILLI.,.METRE."));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        memcpy(at, rows[i].unit, 7);
        lmn_scene *s = load_or_fail(temp_file("units.step", text, f.size));
        assert_true(fabs(s->parts[0].bounds.max.x - bracket.high[0] * rows[i].times) < 1e-3 * rows[i].times);
        lmn_scene_destroy(&s);
    }
    free(text);
    file_data_release(&f);
}

/* A unit that makes the model smaller or larger than anything that can be drawn is what is wrong, and is told. */
static void units_that_are_none_are_told(void **state)
{
    (void)state;
    static const char *const rows[][3] = {
        {".PICO.", "picometre, which makes the model less than 4.1e-07 mm", "smaller"},
        {".NANO.", "nanometre, which makes the model 6.4", "smaller"},
        {".PETA.", "petametre, which makes the model 6.4e+19 mm", "larger"},
        {".EXA. ", "exametre, which makes the model 6.4e+22 mm", "larger"}};
    file_data f = {0};
    assert_int_equal(file_load(&f, bracket_path, NULL), LMN_OK);
    char *text = malloc(f.size + 1), *at;
    memcpy(text, f.data, f.size);
    text[f.size] = '\0';
    assert_non_null(at = strstr(text, ".MILLI.,.METRE."));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_error error = {0};
        memcpy(at, "       ", 7);
        memcpy(at, rows[i][0], 6);
        assert_int_equal(load_status(temp_file("units.step", text, f.size), &error), LMN_FORMAT);
        if (!strstr(error.message, rows[i][1]) || !strstr(error.message, rows[i][2]) || !strstr(error.hint, "unit"))
            fail_msg("'%s' (%s)", error.message, error.hint);
    }
    free(text);
    file_data_release(&f);
}

/* Each solid of a part is a part; a wire is lines without triangles. */
static void solids_and_wires_are_parts(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(loose_path);
    size_t     solids = 0, wires = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        solids += s->parts[i].triangles == 12 && s->parts[i].lines == 12 && s->parts[i].edge_lines;
        wires += s->parts[i].triangles == 0 && s->parts[i].lines >= 24 && !s->parts[i].edge_lines;
    }
    assert_int_equal(s->part_count, 3);
    assert_int_equal(solids, 2);
    assert_int_equal(wires, 1);
    lmn_scene_destroy(&s);
}

/* --- bad files ------------------------------------------------------------------------------------------- */

static file_data read_whole(const char *path)
{
    file_data f = {0};
    assert_int_equal(file_load(&f, path, NULL), LMN_OK);
    return f;
}

static lmn_status load_within(const char *path, lmn_limits limits, lmn_error *error)
{
    lmn_task_desc desc = lmn_task_desc_standard();
    lmn_task     *task = NULL;
    desc.limits = limits;
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    lmn_status status = load_status(path, error);
    lmn_task_end(&task);
    return status;
}

/* Whatever is cut off or overwritten: an error with words, or a model; a crash would end this process. */
static void damaged_files_are_errors(void **state)
{
    (void)state;
    file_data f = read_whole(stand_path);
    lmn_error error;
    int       refused = 0, slow = 0;
    /* Some of them take the library for ever. */
    lmn_limits limits = lmn_limits_standard();
    limits.time_s = 2;
    for (int i = 0; i < 6; i++) {
        lmn_status status = load_status(temp_file("cut.step", f.data, f.size * (size_t)i / 6 + 20), &error);
        assert_true(status == LMN_FORMAT || status == LMN_LIMIT);
    }
    unsigned char *copy = malloc(f.size);
    uint32_t       seed = 7;
    for (int i = 0; i < 12 && slow < 2; i++) {
        memcpy(copy, f.data, f.size);
        for (int k = 0; k < 6; k++) {
            seed = seed * 1664525u + 1013904223u;
            copy[600 + seed % (f.size - 600)] = (unsigned char)("0123456789#,$()"[(seed >> 8) % 15]);
        }
        lmn_status status = load_within(temp_file("overwritten.step", copy, f.size), limits, &error);
        assert_true(status == LMN_OK || status == LMN_FORMAT || status == LMN_LIMIT);
        refused += status == LMN_FORMAT;
        slow += status == LMN_LIMIT;
    }
    print_message("of 12 overwritten files %d are refused, %d take too long\n", refused, slow);
    for (size_t i = 20; i < f.size; i++)
        copy[i] = (unsigned char)((seed = seed * 1664525u + 1013904223u) >> 24);
    memcpy(copy, "ISO-10303-21;\nDATA;\n", 20);
    assert_int_equal(load_status(temp_file("noise.step", copy, f.size), &error), LMN_FORMAT);
    assert_int_equal(load_status(temp_file("empty.step", EMPTY, strlen(EMPTY)), &error), LMN_FORMAT);
    assert_int_equal(load_status(temp_file("none.step", copy, 0), &error), LMN_FORMAT);
    free(copy);
    file_data_release(&f);
}

/* Every "#12" that names a surface is one that is not there. */
static void missing_references_are_no_crash(void **state)
{
    (void)state;
    file_data  f = read_whole(stand_path);
    lmn_error  error;
    char      *text = malloc(f.size + 1);
    lmn_limits limits = lmn_limits_standard();
    limits.time_s = 2;
    memcpy(text, f.data, f.size);
    text[f.size] = '\0';
    int changed = 0;
    for (char *at = text; (at = strstr(at, "ADVANCED_FACE('',(#")); at++) {
        char *digit = at + strlen("ADVANCED_FACE('',(#");
        while (*digit >= '0' && *digit <= '9')
            *digit++ = '9';
        changed++;
    }
    assert_true(changed >= 9);
    lmn_status status = load_within(temp_file("missing.step", text, f.size), limits, &error);
    assert_true(status == LMN_FORMAT || status == LMN_OK);
    free(text);
    file_data_release(&f);
}

/* What a warning of the scene says; "" when none has these words. */
static const char *warning_with(const lmn_scene *s, const char *words)
{
    for (size_t i = 0; i < s->warnings.count; i++)
        if (strstr(s->warnings.items[i].text, words))
            return s->warnings.items[i].text;
    return "";
}

/* The reference whose number begins at `at` leads to #9999 instead. */
static void lead_nowhere(char *at)
{
    while (*at >= '0' && *at <= '9')
        *at++ = '9';
}

static lmn_scene *load_changed(char *text, size_t size, const char *name)
{
    const char *path = temp_file(name, text, size);
    return load_finely(path, 0.5);
}

/* OpenCASCADE draws what is left; what is not is told, by the file's own numbers. */
static void losses_are_told(void **state)
{
    (void)state;
    file_data f = read_whole(bracket_path);
    char     *text = malloc(f.size + 1);
    memcpy(text, f.data, f.size);
    text[f.size] = '\0';
    lmn_scene *scene = load_changed(text, f.size, "whole.step");
    assert_string_equal(warning_with(scene, "#"), "");
    size_t triangles = mesh_at(scene, 0)->primitives[0].index_count;
    lmn_scene_destroy(&scene);

    /* A shell that names a face too many: everything else is there. */
    char *face = strstr(text, "CLOSED_SHELL('',(#");
    assert_non_null(face);
    char *shell = face;
    while (shell[-1] != '\n')
        shell--;
    lead_nowhere(face + strlen("CLOSED_SHELL('',(#"));
    char say[64];
    snprintf(say, sizeof say, "the first: #%d", (int)strtol(shell + 1, NULL, 10));
    scene = load_changed(text, f.size, "shell.step");
    assert_non_null(strstr(warning_with(scene, "1 entities are damaged"), say));
    assert_string_equal(warning_with(scene, "could not be made"), "");
    assert_true(mesh_at(scene, 0)->primitives[0].index_count < triangles);
    lmn_scene_destroy(&scene);

    /* A face without a surface. */
    memcpy(text, f.data, f.size);
    char *surface = strstr(text, "= ADVANCED_FACE('',(#");
    assert_non_null(surface);
    char *entity = surface;
    while (entity[-1] != '\n')
        entity--;
    snprintf(say, sizeof say, "the first: #%d", (int)strtol(entity + 1, NULL, 10));
    lead_nowhere(strstr(surface, "),#") + 3);
    scene = load_changed(text, f.size, "face.step");
    assert_non_null(strstr(warning_with(scene, "1 of 10 faces could not be made"), say));
    assert_non_null(strstr(warning_with(scene, "1 entities are damaged"), say));
    lmn_scene_destroy(&scene);
    free(text);
    file_data_release(&f);
}

static bool stop(double fraction, const char *stage, void *user)
{
    (void)fraction, (void)stage;
    return ++*(int *)user < 6;
}

static void reading_can_be_stopped(void **state)
{
    (void)state;
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    lmn_scene    *scene = NULL;
    lmn_error     error = {0};
    int           calls = 0;
    char          path[256];
    path_of(path, "many.step");
    assert_true(step_write_many(path, 300));
    desc.progress = stop;
    desc.progress_user = &calls;
    assert_int_equal(lmn_scene_create(&scene, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_file(scene, path, &desc, &error), LMN_CANCELLED);
    assert_int_equal(scene->part_count, 0);
    lmn_scene_destroy(&scene);
}

static void limits_hold(void **state)
{
    (void)state;
    lmn_error  error;
    lmn_limits limits = lmn_limits_standard();
    limits.triangles = 100;
    assert_int_equal(load_within(bracket_path, limits, &error), LMN_LIMIT);
    assert_non_null(strstr(error.message, "100 triangles"));
    limits = lmn_limits_standard();
    limits.time_s = 0.01;
    assert_int_equal(load_within(bracket_path, limits, &error), LMN_LIMIT);
}

/* A deflection that is far too fine is told, and that of a file without curved surfaces is refused. */
static void deflections_are_checked(void **state)
{
    (void)state;
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    lmn_error     error = {0};
    lmn_scene    *s = load_finely(stand_path, 1e-7);
    assert_true(has_warning(s, WARNING_BAD_VALUE));
    lmn_scene_destroy(&s);
    const char *stl = "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n"
                      "endfacet\nendsolid a\n";
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    desc.deflection = 1;
    assert_int_equal(lmn_scene_add_file(s, temp_file("a.stl", stl, strlen(stl)), &desc, &error), LMN_USAGE);
    desc.deflection = NAN;
    assert_int_equal(lmn_scene_add_file(s, bracket_path, &desc, &error), LMN_USAGE);
    desc.deflection = -1;
    assert_int_equal(lmn_scene_add_file(s, bracket_path, &desc, &error), LMN_USAGE);
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(answers_are_not_believed),
                                       cmocka_unit_test(answers_may_be_anything),
                                       cmocka_unit_test(ifc_is_not_taken_for_step),
                                       cmocka_unit_test(solids_are_as_large_as_they_are),
                                       cmocka_unit_test(every_edge_is_a_line),
                                       cmocka_unit_test(halves_are_one_surface),
                                       cmocka_unit_test(triangles_know_their_edges),
                                       cmocka_unit_test(normals_are_those_of_surfaces),
                                       cmocka_unit_test(faces_have_their_colours),
                                       cmocka_unit_test(assemblies_keep_their_tree),
                                       cmocka_unit_test(units_are_obeyed),
                                       cmocka_unit_test(units_that_are_none_are_told),
                                       cmocka_unit_test(solids_and_wires_are_parts),
                                       cmocka_unit_test(damaged_files_are_errors),
                                       cmocka_unit_test(missing_references_are_no_crash),
                                       cmocka_unit_test(losses_are_told),
                                       cmocka_unit_test(reading_can_be_stopped),
                                       cmocka_unit_test(limits_hold),
                                       cmocka_unit_test(deflections_are_checked)};
    return cmocka_run_group_tests(tests, write_files, remove_temp_folder);
}

#endif
