/* limner/sheet.h: arguments that are refused, drawings without a renderer, cancelling, memory that runs out, and
 * that nothing of it depends on chance. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>
#include <jansson.h>

#include "base/file.h"
#include "base/memory.h"
#include "limner/limner.h"

typedef struct fixture {
    lmn_scene *scene;
    lmn_look  *look;
} fixture;

static int set_up(void **state)
{
    static fixture f;
    lmn_load_desc  load = LMN_LOAD_DESC_INIT;
    lmn_error      error = {0};
    f = (fixture){NULL, NULL};
    if (lmn_scene_create(&f.scene, &error) != LMN_OK ||
        lmn_scene_add_file(f.scene, LIMNER_SOURCE_DIR "/examples/box.glb", &load, &error) != LMN_OK ||
        lmn_look_load(&f.look, "technical", &error) != LMN_OK)
        return -1;
    *state = &f;
    return 0;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_look_destroy(&f->look);
    lmn_scene_destroy(&f->scene);
    return 0;
}

static lmn_sheet *draw(const fixture *f, const lmn_sheet_desc *desc)
{
    lmn_draw_desc how = LMN_DRAW_DESC_INIT;
    lmn_sheet    *s = NULL;
    lmn_error     error = {0};
    if (lmn_draw_sheet(&s, NULL, f->scene, f->look, &how, desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return s;
}

static void refuse(const fixture *f, const lmn_draw_desc *how, const lmn_sheet_desc *desc, const char *message)
{
    lmn_sheet *s = (lmn_sheet *)&message;
    lmn_error  error = {0};
    assert_int_equal(lmn_draw_sheet(&s, NULL, f->scene, f->look, how, desc, &error), LMN_USAGE);
    assert_null(s);
    if (!strstr(error.message, message))
        fail_msg("'%s' lacks '%s'", error.message, message);
}

static void test_refused(void **state)
{
    const fixture       *f = *state;
    const lmn_draw_desc  how = LMN_DRAW_DESC_INIT;
    const lmn_sheet_desc good = LMN_SHEET_DESC_INIT;
    lmn_sheet_desc       desc = good;
    lmn_draw_desc        other = how;
    lmn_error            error = {0};
    lmn_sheet           *s = NULL;
    desc.struct_size = 0;
    refuse(f, &how, &desc, "struct_size is 0");
    desc = good, desc.angle = (lmn_angle)5;
    refuse(f, &how, &desc, "there is no angle 5");
    desc = good, desc.page = "B5";
    refuse(f, &how, &desc, "the page is 'B5'");
    desc = good, desc.scale = "1";
    refuse(f, &how, &desc, "the scale is '1'");
    desc = good, desc.views = "front,font";
    refuse(f, &how, &desc, "the views are 'front,font'");
    desc = good, desc.unit = "ell";
    refuse(f, &how, &desc, "the unit is 'ell'");
    other.struct_size = 1;
    refuse(f, &other, &good, "LMN_DRAW_DESC_INIT");
    other = how, other.background = "blu";
    refuse(f, &other, &good, "'blu' is not a colour");
    other = how, other.select = "nothing";
    refuse(f, &other, &good, "matches none of 1 parts");
    assert_int_equal(lmn_draw_sheet(NULL, NULL, f->scene, f->look, &how, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_draw_sheet(&s, NULL, NULL, f->look, &how, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_draw_sheet(&s, NULL, f->scene, NULL, &how, NULL, &error), LMN_USAGE);
    assert_int_equal(lmn_sheet_write(NULL, "x.svg", NULL, NULL, &error), LMN_USAGE);
    s = draw(f, NULL);
    error.file[0] = '\0';
    assert_int_equal(lmn_sheet_write(s, "x.gif", NULL, NULL, &error), LMN_USAGE);
    assert_string_equal(error.file, "x.gif");
    assert_int_equal(lmn_sheet_write(s, "x.svgg", NULL, NULL, &error), LMN_USAGE);
    assert_string_equal(error.hint, "did you mean '.svg'?");
    assert_int_equal(lmn_sheet_write(s, "/nosuch/x.svg", NULL, NULL, &error), LMN_WRITE);
    assert_string_equal(error.file, "/nosuch/x.svg");
    assert_null(lmn_sheet_warning_at(s, 0, NULL, NULL));
    lmn_sheet_destroy(&s);
    assert_null(s);
    lmn_sheet_destroy(&s);
    lmn_sheet_destroy(NULL);
    assert_null(lmn_sheet_report_json(NULL));
    assert_int_equal(lmn_sheet_warning_count(NULL), 0);
}

static double number_in(const json_t *root, const char *group, const char *key)
{
    return json_number_value(json_object_get(group ? json_object_get(root, group) : root, key));
}

/* A box from the corner: 9 visible edges, 3 hidden ones. */
static void test_report(void **state)
{
    lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
    desc.verify = true;
    lmn_sheet *s = draw(*state, &desc);
    char      *text = lmn_sheet_report_json(s);
    json_t    *root = json_loads(text, 0, NULL);
    assert_non_null(root);
    assert_true(number_in(root, "strokes", "contour") >= 1 && number_in(root, "strokes", "crease") >= 3);
    assert_true(number_in(root, NULL, "hidden_strokes") >= 3);
    assert_true(number_in(root, "verify", "samples") > 100);
    assert_true(number_in(root, "verify", "wrong") == 0);
    assert_true(fabs(number_in(root, "sheet", "width_mm") - 1024 * 25.4 / 96) < 1e-9);
    assert_true(json_is_null(json_object_get(json_object_get(root, "sheet"), "scale")));
    json_decref(root);
    lmn_text_free(text);
    lmn_sheet_destroy(&s);
}

/* At a scale, what is drawn has the size that the model's bounds say, in metres as the format has it. */
static void test_scale(void **state)
{
    const fixture *f = *state;
    lmn_scene_info info = lmn_scene_info_of(f->scene);
    lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
    char           path[] = "/tmp/limner-sheet-XXXXXX", *at;
    lmn_error      error = {0};
    file_data      file;
    double         low = INFINITY, high = -INFINITY, x = 0;
    int            descriptor = mkstemp(path), code;
    assert_true(descriptor >= 0);
    close(descriptor);
    desc.views = "front";
    desc.scale = "1:20";
    desc.page = "A2";
    desc.lines_only = true;
    lmn_sheet *s = draw(f, &desc);
    assert_int_equal(lmn_sheet_write(s, path, "dxf", NULL, &error), LMN_OK);
    assert_int_equal(file_load(&file, path, &error), LMN_OK);
    unlink(path);
    at = strstr((const char *)file.data, "ENTITIES");
    assert_non_null(at);
    for (at = strchr(at, '\n') + 1; sscanf(at, "%d", &code) == 1; at = strchr(strchr(at, '\n') + 1, '\n') + 1) {
        const char *value = strchr(at, '\n') + 1;
        if ((code == 10 || code == 11) && sscanf(value, "%lf", &x) == 1) {
            low = fmin(low, x);
            high = fmax(high, x);
        }
        if (strncmp(value, "EOF", 3) == 0)
            break;
    }
    double wanted = (info.bounds_max[0] - info.bounds_min[0]) * 1000 / 20; /* metres */
    print_message("%.4f mm wide, wanted %.4f mm\n", high - low, wanted);
    assert_true(fabs(high - low - wanted) < 0.02);
    assert_true(fabs((low + high) / 2 - 297) < 0.2); /* in the middle of the page */
    file_data_release(&file);
    lmn_sheet_destroy(&s);
}

static void test_without_renderer(void **state)
{
    fixture     f = *(const fixture *)*state;
    lmn_error   error = {0};
    const char *code = NULL;
    lmn_look   *toon = NULL;
    assert_false(lmn_look_needs_pixels(f.look));
    assert_false(lmn_look_needs_pixels(NULL));
    assert_int_equal(lmn_look_load(&toon, "toon", &error), LMN_OK);
    assert_true(lmn_look_needs_pixels(toon));
    f.look = toon;
    lmn_sheet *s = draw(&f, NULL);
    assert_int_equal(lmn_sheet_warning_count(s), 1);
    assert_non_null(lmn_sheet_warning_at(s, 0, &code, NULL));
    assert_string_equal(code, "no-strokes");
    lmn_sheet_destroy(&s);
    lmn_sheet_desc alone = LMN_SHEET_DESC_INIT;
    alone.lines_only = true;
    s = draw(&f, &alone);
    assert_int_equal(lmn_sheet_warning_count(s), 1); /* the shadow on the ground is left out */
    assert_non_null(lmn_sheet_warning_at(s, 0, &code, NULL));
    assert_string_equal(code, "unused");
    lmn_sheet_destroy(&s);
    assert_int_equal(lmn_look_set(toon, "surface.technique", "flat", &error), LMN_OK);
    assert_true(lmn_look_needs_pixels(toon)); /* for its ground */
    assert_int_equal(lmn_look_set(toon, "scene.ground", "none", &error), LMN_OK);
    assert_false(lmn_look_needs_pixels(toon)); /* white as the page */
    assert_int_equal(lmn_look_set(toon, "surface.colour", "#ffeecc", &error), LMN_OK);
    assert_true(lmn_look_needs_pixels(toon));
    assert_int_equal(lmn_look_set(toon, "finish.ground", "#ffeecc", &error), LMN_OK);
    assert_false(lmn_look_needs_pixels(toon));
    lmn_look_destroy(&toon);
}

/* What cannot be drawn is refused by name, and by lenient drawings left out with a warning of this code. */
static void refuse_or_warn(const fixture *f, lmn_draw_desc how, const lmn_sheet_desc *desc, lmn_status wanted,
                           const char *code)
{
    lmn_sheet  *s = NULL;
    lmn_error   error = {0};
    const char *got = NULL;
    bool        found = false;
    how.lenient = false;
    assert_int_equal(lmn_draw_sheet(&s, NULL, f->scene, f->look, &how, desc, &error), wanted);
    assert_null(s);
    assert_non_null(strstr(error.file, "examples/"));
    assert_non_null(strstr(error.hint, "--lenient"));
    how.lenient = true;
    assert_int_equal(lmn_draw_sheet(&s, NULL, f->scene, f->look, &how, desc, &error), LMN_OK);
    for (size_t i = 0; i < lmn_sheet_warning_count(s); i++)
        found = found || (lmn_sheet_warning_at(s, i, &got, NULL) && strcmp(got, code) == 0);
    assert_true(found);
    lmn_sheet_destroy(&s);
}

static void test_not_drawn(void **state)
{
    fixture              f = *(const fixture *)*state;
    const lmn_draw_desc  plain = LMN_DRAW_DESC_INIT;
    const lmn_sheet_desc good = LMN_SHEET_DESC_INIT;
    lmn_draw_desc        how = plain;
    lmn_sheet_desc       desc = good;
    lmn_error            error = {0};
    how.time_s = 1;
    refuse_or_warn(&f, how, &good, LMN_USAGE, "unused");
    assert_int_equal(lmn_draw_check(f.scene, f.look, &how, true, &error), LMN_USAGE);
    assert_int_equal(lmn_draw_check(f.scene, f.look, &how, false, &error), LMN_USAGE);
    how.lenient = true;
    assert_int_equal(lmn_draw_check(f.scene, f.look, &how, true, &error), LMN_OK);
    assert_int_equal(lmn_draw_check(f.scene, f.look, &plain, true, &error), LMN_OK);
    desc.views = "front";
    for (int i = 0; i < 3; i++) {
        static const char *const scales[] = {"1:1000000000", "1000000:1", "1:10000000"};
        desc.scale = scales[i];
        refuse_or_warn(&f, plain, &desc, LMN_USAGE, "page");
    }
    assert_int_equal(lmn_look_load(&f.look, "sketch", &error), LMN_OK);
    assert_int_equal(lmn_look_set(f.look, "perturb.boil", "12", &error), LMN_OK);
    how.lenient = false;
    assert_int_equal(lmn_draw_check(f.scene, f.look, &how, false, &error), LMN_OK);   /* it boils */
    assert_int_equal(lmn_draw_check(f.scene, f.look, &how, true, &error), LMN_USAGE); /* lines of vectors do not */
    lmn_look_destroy(&f.look);
    assert_int_equal(lmn_look_load(&f.look, "technical", &error), LMN_OK);
    lmn_look_destroy(&f.look);
    f.scene = NULL;
    assert_int_equal(lmn_scene_create(&f.scene, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_file(f.scene, LIMNER_SOURCE_DIR "/examples/csg/widget.csg", NULL, &error), LMN_OK);
    for (int i = 0; i < 3; i++) { /* marks, lines of form, and lines of what is not there */
        static const char *const looks[] = {"stipple", "technical", "ghost"};
        assert_int_equal(lmn_look_load(&f.look, looks[i], &error), LMN_OK);
        if (i == 1)
            assert_int_equal(lmn_look_set(f.look, "lines.ridges", "0.5", &error), LMN_OK);
        refuse_or_warn(&f, plain, &good, LMN_UNSUPPORTED, "no-strokes");
        lmn_look_destroy(&f.look);
    }
    lmn_scene_destroy(&f.scene);
}

/* Solids and sections have lines like everything else, and hatching where they are cut. */
static void test_solids_and_sections(void **state)
{
    fixture        f = *(const fixture *)*state;
    lmn_error      error = {0};
    lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
    desc.verify = true;
    for (int i = 0; i < 4; i++) {
        f.scene = NULL;
        assert_int_equal(lmn_scene_create(&f.scene, &error), LMN_OK);
        assert_int_equal(lmn_scene_add_file(f.scene, LIMNER_SOURCE_DIR "/examples/csg/widget.csg", NULL, &error),
                         LMN_OK);
        assert_int_equal(lmn_look_load(&f.look, "technical", &error), LMN_OK);
        if (i & 1)
            assert_int_equal(lmn_look_set(f.look, "scene.cut", "x", &error), LMN_OK);
        if (i & 2)
            assert_int_equal(lmn_look_set(f.look, "scene.cut_hatch", "0pt", &error), LMN_OK);
        lmn_sheet *s = draw(&f, &desc);
        char      *report = lmn_sheet_report_json(s);
        assert_non_null(strstr(report, "\"wrong\": 0\n"));
        assert_int_equal(strstr(report, "\"hatch_lines\"") != NULL, i == 1);
        assert_int_equal(lmn_sheet_warning_count(s), 0);
        lmn_text_free(report);
        lmn_sheet_destroy(&s);
        lmn_look_destroy(&f.look);
        lmn_scene_destroy(&f.scene);
    }
}

/* --- what stops a drawing ------------------------------------------------------------------------------- */

typedef struct progress_state {
    int    left;
    double before;
} progress_state;

static bool stop_at(double fraction, const char *stage, void *user)
{
    progress_state *state = user;
    assert_true(fraction >= state->before && fraction <= 1 && stage && *stage);
    state->before = fraction;
    return state->left-- > 0;
}

static void test_cancelled(void **state)
{
    const fixture *f = *state;
    lmn_status     status = LMN_CANCELLED;
    int            calls = 0;
    for (; status != LMN_OK && calls < 100000; calls++) {
        lmn_draw_desc  how = LMN_DRAW_DESC_INIT;
        lmn_sheet     *s = NULL;
        lmn_error      error = {0};
        progress_state told = {calls, 0};
        how.progress = stop_at;
        how.progress_user = &told;
        status = lmn_draw_sheet(&s, NULL, f->scene, f->look, &how, NULL, &error);
        assert_true(status == LMN_OK ? s != NULL : status == LMN_CANCELLED && s == NULL);
        lmn_sheet_destroy(&s);
    }
    assert_in_range(calls, 3, 99999);
}

static void test_out_of_memory(void **state)
{
    const fixture *f = *state;
    lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
    lmn_status     status = LMN_MEMORY;
    long           n = 1;
    desc.views = "front,iso";
    desc.frame = desc.fill = desc.verify = true;
    desc.title = "box";
    for (; status != LMN_OK && n < 100000; n++) {
        lmn_draw_desc how = LMN_DRAW_DESC_INIT;
        lmn_sheet    *s = NULL;
        lmn_error     error = {0};
        mem_fail_at(n);
        status = lmn_draw_sheet(&s, NULL, f->scene, f->look, &how, &desc, &error);
        mem_fail_at(0);
        if (!(status == LMN_OK ? s != NULL : status == LMN_MEMORY && s == NULL))
            fail_msg("allocation %ld: status %d, %s", n, (int)status, error.message);
        lmn_sheet_destroy(&s);
    }
    assert_in_range(n, 50, 99999);
}

static void test_same_again(void **state)
{
    char           paths[2][32] = {"/tmp/limner-sheet-XXXXXX", "/tmp/limner-sheet-XXXXXX"};
    lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
    file_data      files[2];
    lmn_error      error = {0};
    desc.views = "front,top,right,iso";
    desc.frame = true;
    desc.fill = true;
    for (int i = 0; i < 2; i++) {
        uint64_t   bytes = 0;
        lmn_sheet *s = draw(*state, &desc);
        int        descriptor = mkstemp(paths[i]);
        assert_true(descriptor >= 0);
        close(descriptor);
        assert_int_equal(lmn_sheet_write(s, paths[i], ".pdf", &bytes, &error), LMN_OK);
        assert_int_equal(file_load(&files[i], paths[i], &error), LMN_OK);
        assert_int_equal(files[i].size, bytes);
        unlink(paths[i]);
        lmn_sheet_destroy(&s);
    }
    assert_int_equal(files[0].size, files[1].size);
    assert_memory_equal(files[0].data, files[1].data, files[0].size);
    for (int i = 0; i < 2; i++)
        file_data_release(&files[i]);
}

/* What the table of formats says, the reference says in the same words. */
static void see_documented(const char *page, const lmn_format_info *f)
{
    static const char *const cells[] = {"", " yes"};
    char                     line[256];
    snprintf(line, sizeof line, "| `%s` | %s |%s |%s |%s |%s |\n", f->ending, f->doc, cells[f->ground],
             cells[f->pictures], cells[f->areas], cells[f->title]);
    if (!strstr(page, line))
        fail_msg("docs/reference/draw.md lacks: %s", line);
}

/* What memory gets is what the file has. */
static void see_encoded(const lmn_sheet *s, const char *path, const lmn_format_info *f)
{
    lmn_error error = {0};
    uint8_t  *bytes = NULL;
    size_t    size = 0;
    file_data file;
    assert_int_equal(lmn_sheet_encode(s, f->ending, &bytes, &size, &error), f->vectors ? LMN_OK : LMN_USAGE);
    if (!f->vectors) {
        assert_true(!bytes && error.message[0]);
        return;
    }
    assert_int_equal(file_load(&file, path, &error), LMN_OK);
    assert_int_equal(size, file.size);
    assert_memory_equal(bytes, file.data, size);
    file_data_release(&file);
    lmn_bytes_free(bytes);
}

/* A sheet can be written in each format of vectors and in no other; the format's own name is not refused with
 * another one's. */
static void see_written(const lmn_sheet *s, const lmn_format_info *f)
{
    char      path[] = "/tmp/limner-sheet-XXXXXX";
    lmn_error error = {0};
    uint64_t  bytes = 0;
    int       descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    lmn_status status = lmn_sheet_write(s, path, f->ending, &bytes, &error);
    assert_int_equal(status, f->vectors ? LMN_OK : LMN_USAGE);
    assert_true(!f->vectors || bytes > 100);
    assert_int_equal(lmn_sheet_write(s, path, f->ending + 1, &bytes, &error), status);
    see_encoded(s, path, f);
    unlink(path);
}

static void test_formats(void **state)
{
    lmn_sheet_desc  desc = LMN_SHEET_DESC_INIT;
    lmn_sheet      *s = draw(*state, &desc);
    file_data       page;
    lmn_format_info f, other;
    lmn_error       error = {0};
    size_t          count = 0, vectors = 0;
    assert_int_equal(file_load(&page, LIMNER_SOURCE_DIR "/docs/reference/draw.md", &error), LMN_OK);
    for (; lmn_format_at(count, &f); count++) {
        assert_true(f.ending[0] == '.' && f.ending[1] && f.doc[strlen(f.doc) - 1] == '.');
        for (size_t i = 0; i < count && lmn_format_at(i, &other); i++)
            assert_string_not_equal(other.ending, f.ending);
        vectors += f.vectors;
        see_documented((const char *)page.data, &f);
        see_written(s, &f);
    }
    assert_true(count > vectors && vectors > 0);
    assert_false(lmn_format_at(count, &f));
    assert_false(lmn_format_at(0, NULL));
    assert_int_equal(lmn_sheet_write(s, "x.drawing", NULL, NULL, &error), LMN_USAGE);
    assert_string_equal(error.hint, "sheets are written as .svg, .pdf or .dxf");
    file_data_release(&page);
    lmn_sheet_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refused),       cmocka_unit_test(test_report),
        cmocka_unit_test(test_scale),         cmocka_unit_test(test_without_renderer),
        cmocka_unit_test(test_not_drawn),     cmocka_unit_test(test_solids_and_sections),
        cmocka_unit_test(test_formats),       cmocka_unit_test(test_cancelled),
        cmocka_unit_test(test_out_of_memory), cmocka_unit_test(test_same_again),
    };
    return cmocka_run_group_tests_name("sheet_api", tests, set_up, tear_down);
}
