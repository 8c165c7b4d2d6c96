/* IGES files against what OpenCASCADE knows of the same shapes before it writes them: sizes, edges, colours, units;
 * that loose faces become bodies; and what becomes of files that are damaged. */
#include "import_support.h"

#include <math.h>

#include "base/colour.h"
#include "import/step.h"
#include "plan/unit.h"

static file_data as_file(const char *text)
{
    return (file_data){.data = (unsigned char *)text, .size = strlen(text)};
}

#define START "made by hand                                                            S      1\n"

/* By its 73rd letter, whatever its lines say. */
static void it_is_known_by_its_lines(void **state)
{
    (void)state;
    file_data good = as_file(START START), windows = as_file("made by hand                                            "
                                                             "                S0000001\r\n" START);
    file_data step = as_file("ISO-10303-21;\n" START), other = as_file("Made by hand                                   "
                                                                       "                         T      1\n" START);
    file_data late =
        as_file("made by hand                                                            S      2\n" START);
    file_data short_one = as_file("S      1\n");
    assert_true(import_iges.recognises(&good));
    assert_true(import_iges.recognises(&windows));
    assert_false(import_iges.recognises(&step));
    assert_false(import_iges.recognises(&other));
    assert_false(import_iges.recognises(&late));
    assert_false(import_iges.recognises(&short_one));
    assert_false(import_step.recognises(&good));
}

#ifndef LIMNER_HAVE_STEP

static void without_the_library_it_says_so(void **state)
{
    (void)state;
    lmn_error error;
    assert_int_equal(load_status(temp_file("empty.iges", START START, strlen(START START)), &error), LMN_UNSUPPORTED);
    assert_non_null(strstr(error.message, "OpenCASCADE"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_known_by_its_lines),
                                       cmocka_unit_test(without_the_library_it_says_so)};
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}

#else

#include "step_write.h"

static step_truth bracket;
static char       solid_path[256], faces_path[256], loose_path[256], open_path[256];

static void path_of(char *out, const char *name)
{
    snprintf(out, 256, "%s/%s", temp_folder(), name);
}

static int write_files(void **state)
{
    (void)state;
    path_of(solid_path, "solid.iges");
    path_of(faces_path, "faces.igs");
    path_of(loose_path, "loose.igs");
    path_of(open_path, "open.igs");
    return !iges_write_bracket(solid_path, "INCH", true, &bracket) ||
           !iges_write_bracket(faces_path, "MM", false, &bracket) || !iges_write_loose(loose_path, false) ||
           !iges_write_loose(open_path, true);
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

static double volume_of(const mesh *m)
{
    double sum = 0;
    for (size_t i = 0; i < m->primitive_count; i++) {
        const primitive *p = &m->primitives[i];
        for (size_t k = 0; k + 2 < p->index_count; k += 3) {
            const vec3 a = p->positions[p->indices[k]], b = p->positions[p->indices[k + 1]],
                       c = p->positions[p->indices[k + 2]];
            sum += ((double)a.x * ((double)b.y * c.z - (double)b.z * c.y) +
                    (double)a.y * ((double)b.z * c.x - (double)b.x * c.z) +
                    (double)a.z * ((double)b.x * c.y - (double)b.y * c.x)) /
                   6;
        }
    }
    return sum;
}

static double from_segment(const double p[3], vec3 a, vec3 b)
{
    const double d[3] = {(double)b.x - (double)a.x, (double)b.y - (double)a.y, (double)b.z - (double)a.z},
                 f[3] = {p[0] - (double)a.x, p[1] - (double)a.y, p[2] - (double)a.z};
    double along = d[0] * f[0] + d[1] * f[1] + d[2] * f[2], length = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
    double t = length > 0 ? fmin(fmax(along / length, 0), 1) : 0, sum = 0;
    for (int k = 0; k < 3; k++)
        sum += (f[k] - t * d[k]) * (f[k] - t * d[k]);
    return sqrt(sum);
}

/* Both ways to write it: in millimetres whatever the file has, closed, looking outwards, within the deflection. */
static void solids_are_as_large_as_they_are(void **state)
{
    (void)state;
    const char *paths[2] = {solid_path, faces_path}, *units[2] = {"INCH", "MM"};
    for (int i = 0; i < 2; i++) {
        lmn_scene *s = load_finely(paths[i], 0.005);
        double     error = fabs(volume_of(mesh_at(s, 0)) - bracket.volume);
        print_message("%s: volume %.3f, wrong by %.5f\n", paths[i], bracket.volume, error);
        assert_int_equal(s->part_count, 1);
        assert_true(error <= bracket.area * 0.005);
        const float *low = &s->parts[0].bounds.min.x, *high = &s->parts[0].bounds.max.x;
        for (int k = 0; k < 3; k++) {
            assert_true(fabs((double)low[k] - bracket.low[k]) <= 0.006);
            assert_true(fabs((double)high[k] - bracket.high[k]) <= 0.006);
        }
        const node *n = &s->nodes[s->parts[0].node];
        assert_string_equal(n->attributes[0].key, "file-unit");
        assert_string_equal(n->attributes[0].value, units[i]);
        double      mm;
        const char *unit_name;
        bool        stated;
        assert_int_equal(unit_find(NULL, s, &mm, &unit_name, &stated, NULL), LMN_OK);
        assert_true(stated && mm == 1);
        assert_int_equal(s->up, 'z');
        assert_int_equal(s->warnings.count, 0);
        lmn_scene_destroy(&s);
    }
}

/* Each edge of the solid has a line, and once: faces that know nothing of each other have all of theirs sewn. */
static void edges_are_sewn(void **state)
{
    (void)state;
    const char *paths[2] = {solid_path, faces_path};
    double      truth = 0;
    for (size_t i = 0; i + 1 < bracket.point_count; i++) {
        const double *a = &bracket.points[3 * i], *b = a + 3;
        if ((i + 1) % 101) /* to the next edge */
            truth += sqrt(pow(a[0] - b[0], 2) + pow(a[1] - b[1], 2) + pow(a[2] - b[2], 2));
    }
    for (int i = 0; i < 2; i++) {
        lmn_scene  *s = load_finely(paths[i], 0.01);
        const mesh *m = mesh_at(s, 0);
        double      worst = 0, length = 0;
        for (size_t k = 0; k < bracket.point_count; k++) {
            double least = HUGE_VAL;
            for (size_t j = 0; j < m->primitive_count; j++)
                for (uint32_t l = 0; l < m->primitives[j].line_count; l++)
                    least = fmin(least, from_segment(&bracket.points[3 * k],
                                                     m->primitives[j].positions[m->primitives[j].lines[2 * l]],
                                                     m->primitives[j].positions[m->primitives[j].lines[2 * l + 1]]));
            worst = fmax(worst, least);
        }
        for (size_t j = 0; j < m->primitive_count; j++)
            for (uint32_t l = 0; l < m->primitives[j].line_count; l++) {
                const vec3 a = m->primitives[j].positions[m->primitives[j].lines[2 * l]],
                           b = m->primitives[j].positions[m->primitives[j].lines[2 * l + 1]];
                length += sqrt(pow((double)a.x - (double)b.x, 2) + pow((double)a.y - (double)b.y, 2) +
                               pow((double)a.z - (double)b.z, 2));
            }
        print_message("farthest from a line %.4f; lines of %.2f mm, edges of %.2f\n", worst, length, truth);
        assert_true(worst <= 0.0101);
        assert_true(fabs(length - truth) < 0.002 * truth);
        lmn_scene_destroy(&s);
    }
}

static bool is_colour(const lmn_scene *s, const primitive *p, float r, float g, float b)
{
    const vec4 c = p->material == NONE ? (vec4){9, 9, 9, 9} : s->materials[p->material].base_colour;
    return fabsf(c.x - colour_to_linear(r)) < 4e-3f && fabsf(c.y - colour_to_linear(g)) < 4e-3f &&
           fabsf(c.z - colour_to_linear(b)) < 4e-3f;
}

static void faces_have_their_colours(void **state)
{
    (void)state;
    const char *paths[2] = {solid_path, faces_path};
    for (int i = 0; i < 2; i++) {
        lmn_scene  *s = load_or_fail(paths[i]);
        const mesh *m = mesh_at(s, 0);
        int         red = 0;
        for (size_t k = 0; k < m->primitive_count; k++) {
            const primitive *p = &m->primitives[k];
            if (p->line_count || !is_colour(s, p, 1, 0, 0))
                continue;
            red++;
            for (uint32_t v = 0; v < p->vertex_count; v++)
                assert_true(fabsf(p->positions[v].z) < 1e-4f);
        }
        assert_int_equal(red, 1);
        lmn_scene_destroy(&s);
    }
}

/* What hangs together is a part, in its colour; wires are one. */
static void loose_faces_become_bodies(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(loose_path);
    size_t     solids = 0, wires = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        const mesh *m = mesh_at(s, i);
        bool        far = s->parts[i].bounds.min.x > 30;
        wires += s->parts[i].triangles == 0 && s->parts[i].lines >= 24;
        if (s->parts[i].triangles != 12 || s->parts[i].lines != 12)
            continue;
        solids++;
        assert_true(fabs(volume_of(m) - 6000) < 1e-2);
        assert_true(is_colour(s, &m->primitives[0], 0, far ? 0 : 1, far ? 1 : 0));
    }
    assert_int_equal(s->part_count, 3);
    assert_int_equal(solids, 2);
    assert_int_equal(wires, 1);
    lmn_scene_destroy(&s);

    s = load_or_fail(open_path);
    assert_int_equal(s->part_count, 3);
    for (size_t i = 0; i < s->part_count; i++)
        assert_true(s->parts[i].bounds.min.x < 30 || (s->parts[i].triangles == 10 && s->parts[i].lines == 12));
    lmn_scene_destroy(&s);
}

static void headers_are_attributes(void **state)
{
    (void)state;
    lmn_scene *s = load_or_fail(solid_path);
    int        seen = 0;
    for (size_t i = 0; i < s->node_count; i++)
        for (uint32_t k = 0; k < s->nodes[i].attribute_count; k++) {
            const attribute *a = &s->nodes[i].attributes[k];
            seen += strcmp(a->key, "file-author") == 0 && strcmp(a->value, "A. Writer") == 0;
            seen += strcmp(a->key, "file-organisation") == 0 && strcmp(a->value, "Works") == 0;
        }
    assert_int_equal(seen, 2);
    lmn_scene_destroy(&s);
}

/* Whatever is cut off or overwritten: an error with words, or a model; a crash would end this process. */
static void damaged_files_are_errors(void **state)
{
    (void)state;
    file_data f = {0};
    lmn_error error;
    int       refused = 0, read = 0;
    assert_int_equal(file_load(&f, faces_path, NULL), LMN_OK);
    for (int i = 0; i < 8; i++) {
        lmn_status status = load_status(temp_file("cut.igs", f.data, 200 + (f.size - 200) * (size_t)i / 8), &error);
        assert_true(status == LMN_OK || status == LMN_FORMAT || status == LMN_LIMIT);
        if (status != LMN_OK)
            assert_true(error.message[0] != '\0');
        refused += status != LMN_OK;
    }
    assert_true(refused >= 6);
    unsigned char *copy = malloc(f.size);
    uint32_t       seed = 11;
    refused = 0;
    for (int i = 0; i < 16; i++) {
        memcpy(copy, f.data, f.size);
        for (int k = 0; k < 8; k++) {
            seed = seed * 1664525u + 1013904223u;
            copy[600 + seed % (f.size - 600)] = (unsigned char)("0123456789,;.-DPG "[(seed >> 8) % 18]);
        }
        lmn_status status = load_status(temp_file("overwritten.igs", copy, f.size), &error);
        assert_true(status == LMN_OK || status == LMN_FORMAT || status == LMN_LIMIT);
        refused += status != LMN_OK;
        read += status == LMN_OK;
    }
    print_message("of 16 overwritten files %d are refused, %d are read\n", refused, read);
    for (size_t i = 81; i < f.size; i++)
        copy[i] = (unsigned char)((seed = seed * 1664525u + 1013904223u) >> 24);
    assert_int_equal(load_status(temp_file("noise.igs", copy, f.size), &error), LMN_FORMAT);
    assert_int_equal(load_status(temp_file("empty.igs", START START, strlen(START START)), &error), LMN_FORMAT);
    free(copy);
    file_data_release(&f);
}

/* The first face is led to its border for its surface. */
static void broken_faces_are_told(void **state)
{
    (void)state;
    file_data f = {0};
    assert_int_equal(file_load(&f, faces_path, NULL), LMN_OK);
    char *text = malloc(f.size + 1);
    memcpy(text, f.data, f.size);
    text[f.size] = '\0';
    int changed = 0;
    for (char *at = text; changed == 0 && (at = strstr(at, "\n144,5,1,0,7;")) != NULL; at++, changed++)
        at[5] = '7';
    assert_int_equal(changed, 1);
    const char *path = temp_file("face.igs", text, f.size);
    lmn_scene  *s = load_or_fail(path);
    assert_true(has_warning(s, WARNING_BAD_GEOMETRY));
    bool missing = false, damaged = false;
    for (size_t i = 0; i < s->warnings.count; i++) {
        missing = missing ||
                  strstr(s->warnings.items[i].text, "1 of 10 faces could not be made and are missing, the first: D3");
        damaged = damaged || strstr(s->warnings.items[i].text, "1 entities are damaged");
    }
    assert_true(missing && damaged);
    lmn_scene_destroy(&s);
    free(text);
    file_data_release(&f);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(it_is_known_by_its_lines),
                                       cmocka_unit_test(solids_are_as_large_as_they_are),
                                       cmocka_unit_test(edges_are_sewn),
                                       cmocka_unit_test(faces_have_their_colours),
                                       cmocka_unit_test(loose_faces_become_bodies),
                                       cmocka_unit_test(headers_are_attributes),
                                       cmocka_unit_test(damaged_files_are_errors),
                                       cmocka_unit_test(broken_faces_are_told)};
    return cmocka_run_group_tests(tests, write_files, remove_temp_folder);
}

#endif
