/* What the viewer does without a window: cameras, states and their history, sections, edits of solids, sliders, the
 * thread that draws, and that the command a person copies draws what an export writes, byte for byte. */
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <setjmp.h>
#include <cmocka.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "artist.h"
#include "aside.h"
#include "command.h"
#include "controls_value.h"
#include "document.h"
#include "export_work.h"
#include "pace.h"
#include "part_look.h"
#include "section.h"
#include "solid_edits.h"
#include "stroke_sheet.h"
#include "tour.h"

static lmn_error error;

#define DO(call)                                                                                                       \
    do {                                                                                                               \
        if ((call) != LMN_OK)                                                                                          \
            fail_msg("%s: %s", #call, error.message);                                                                  \
    } while (0)

static void assert_close(double a, double b, double tolerance)
{
    if (!(fabs(a - b) <= tolerance))
        fail_msg("%.12g is not %.12g", a, b);
}

static scene_ref *load(const char *name)
{
    lmn_scene  *scene = NULL;
    char       *path = g_build_filename(EXAMPLES, name, NULL);
    const char *paths[] = {path, NULL};
    DO(lmn_scene_create(&scene, &error));
    DO(lmn_scene_add_file(scene, path, NULL, &error));
    scene_ref *out = scene_ref_make(scene, paths);
    g_free(path);
    return out;
}

/* --- cameras --------------------------------------------------------------------------------------------- */

/* The named views look along the same directions as those of the library, with Y and with Z up. */
static void named_views_are_the_library_s(void **state)
{
    (void)state;
    static const char *const files[] = {"pump.glb", "csg/widget.csg"};
    lmn_renderer            *renderer = NULL;
    lmn_look                *look = NULL;
    lmn_renderer_desc        rd = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&renderer, &rd, &error));
    DO(lmn_look_load(&look, "plain", &error));
    for (int f = 0; f < 2; f++) {
        scene_ref *scene = load(files[f]);
        for (int v = LMN_VIEW_ISO; v <= LMN_VIEW_BOTTOM; v++) {
            lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
            lmn_drawing  *drawing = NULL;
            double        view[16], projection[16], right[3], up[3], forward[3];
            orbit         o = orbit_make(scene->info.up);
            desc.width = desc.height = 16;
            desc.view = (lmn_view)v;
            DO(lmn_draw(&drawing, renderer, scene->scene, look, &desc, &error));
            lmn_drawing_camera(drawing, view, projection);
            lmn_drawing_destroy(&drawing);
            orbit_turn_to(&o, (lmn_view)v);
            orbit_axes(&o, right, up, forward);
            for (int k = 0; k < 3; k++) {
                assert_close(right[k], view[4 * k], 1e-9);
                assert_close(up[k], view[4 * k + 1], 1e-9);
                assert_close(forward[k], -view[4 * k + 2], 1e-9);
            }
        }
        scene_ref_drop(scene);
    }
    lmn_look_destroy(&look);
    lmn_renderer_destroy(&renderer);
}

static orbit turned(bool orthographic)
{
    orbit        o = orbit_make('z');
    const double low[3] = {-1, -2, 0}, high[3] = {3, 1, 2};
    o.orthographic = orthographic;
    orbit_turn(&o, 130, -40, 600);
    orbit_fit(&o, low, high, 800, 600);
    return o;
}

/* All of the box is on the picture, and it fills nine tenths of it one way. */
static void fitting_fills_the_picture(void **state)
{
    (void)state;
    for (int flat = 0; flat < 2; flat++) {
        orbit  o = turned(flat);
        double reach = 0;
        for (int i = 0; i < 8; i++) {
            const double corner[3] = {i & 1 ? 3 : -1, i & 2 ? 1 : -2, i & 4 ? 2 : 0};
            double       at[2];
            assert_true(orbit_project(&o, corner, 800, 600, at));
            reach = fmax(reach, fmax(fabs(at[0] / 400 - 1), fabs(at[1] / 300 - 1)));
        }
        assert_close(reach, 0.9, 1e-9);
    }
}

/* What is below the pointer stays there: rays of a pixel before and after meet in the target's depth. */
static void zoom_and_pan_follow_the_pointer(void **state)
{
    (void)state;
    for (int flat = 0; flat < 2; flat++) {
        orbit  o = turned(flat);
        double origin[3], ray[3], point[3], at[2];
        orbit_ray(&o, 650, 130, 800, 600, origin, ray);
        for (int k = 0; k < 3; k++)
            point[k] = origin[k] + ray[k] * o.distance;
        assert_true(orbit_project(&o, point, 800, 600, at));
        assert_close(at[0], 650, 1e-6);
        assert_close(at[1], 130, 1e-6);
        orbit_zoom(&o, 0.6, 650, 130, 800, 600);
        assert_true(orbit_project(&o, point, 800, 600, at));
        assert_close(at[0], 650, 1e-6);
        assert_close(at[1], 130, 1e-6);
        orbit_pan(&o, -90, 45, 600);
        assert_true(orbit_project(&o, point, 800, 600, at));
        assert_close(at[0], 560, 1e-6);
        assert_close(at[1], 175, 1e-6);
    }
}

static void looking_around_keeps_the_eye(void **state)
{
    (void)state;
    orbit  o = turned(false), placed = orbit_make('z');
    double before[3], after[3];
    orbit_eye(&o, before);
    orbit_look(&o, 75, 20, 600);
    orbit_eye(&o, after);
    for (int k = 0; k < 3; k++)
        assert_close(after[k], before[k], 1e-9);
    orbit_place(&placed, after, o.target);
    assert_close(placed.yaw, o.yaw, 1e-9);
    assert_close(placed.pitch, o.pitch, 1e-9);
    assert_close(placed.distance, o.distance, 1e-9);
}

/* --- states ---------------------------------------------------------------------------------------------- */

static void count_change(document *d, unsigned changes, void *user)
{
    (void)d;
    *(unsigned *)user |= changes;
}

static void everything_is_undone_and_redone(void **state)
{
    (void)state;
    document *d = document_make();
    unsigned  told = 0;
    document_listen(d, count_change, &told);
    document_set_scene(d, load("pump.glb"), true, 640, 480);
    assert_null(document_undo_name(d));
    orbit begin = document_state(d)->view, o = begin;
    for (int i = 0; i < 5; i++) { /* one drag */
        orbit_turn(&o, 10, 0, 480);
        document_set_view(d, &o, "Turn");
    }
    const uint32_t parts[] = {2, 5};
    document_show_parts(d, parts, 2, false);
    assert_true(document_is_hidden(d, 5));
    lmn_look *look = document_copy_look(d, &error);
    DO(lmn_look_set(look, "lines.width", "4", &error));
    document_put_look(d, look, "lines.width");
    told = 0;
    assert_true(document_undo(d));
    assert_true(told & DOCUMENT_LOOK && !(told & DOCUMENT_VIEW));
    assert_true(document_undo(d));
    assert_false(document_is_hidden(d, 5));
    assert_true(document_undo(d));
    assert_memory_equal(&document_state(d)->view, &begin, sizeof begin);
    assert_false(document_undo(d));
    for (int i = 0; i < 3; i++)
        assert_true(document_redo(d));
    assert_false(document_redo(d));
    assert_true(document_is_hidden(d, 2));
    double width = 0;
    DO(lmn_look_get_number(document_state(d)->look->look, 0, "lines", 0, "width", &width, &error));
    assert_close(width, 4, 1e-6);
    /* A change after going back: what was undone is gone. */
    document_undo(d);
    document_show_all(d);
    assert_null(document_redo_name(d));
    document_free(d);
}

static void selectors_say_what_is_shown(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_scene(d, load("pump.glb"), true, 640, 480);
    assert_null(state_selector(document_state(d), document_scene(d)));
    const uint32_t parts[] = {3, 7};
    document_show_parts(d, parts, 2, false);
    char *text = state_selector(document_state(d), document_scene(d));
    assert_string_equal(text, "![id=3] ![id=7]");
    g_free(text);
    document_show_alone(d, parts, 2);
    text = state_selector(document_state(d), document_scene(d));
    assert_string_equal(text, "[id=3], [id=7]");
    g_free(text);
    double low[3], high[3];
    state_bounds(document_state(d), document_scene(d), low, high);
    const double *box = (const double *)(const void *)document_scene(d)->boxes->data + 6 * 2;
    for (int k = 0; k < 3; k++)
        assert_true(low[k] <= box[k] && high[k] >= box[3 + k] && low[k] >= document_scene(d)->info.bounds_min[k]);
    document_free(d);
}

/* --- sections, solids, sliders, pace --------------------------------------------------------------------- */

static void sections_are_read_and_written(void **state)
{
    (void)state;
    static const char *const texts[] = {"x=30%", "-z=62.5%", "box=10%,20%,30%:40%,50%,60%"};
    char                     out[SECTION_TEXT_MAX];
    for (int i = 0; i < 3; i++) {
        section s = section_parse(texts[i]);
        section_write(&s, out);
        assert_string_equal(out, texts[i]);
    }
    assert_int_equal(section_parse("").kind, SECTION_NONE);
    assert_int_equal(section_parse("1,1,0@0,0,5").kind, SECTION_OTHER);
    assert_int_equal(section_parse("x;y").kind, SECTION_OTHER);
    /* A handle that is dragged to where the plane would be at 80 % says so. */
    section        s = section_parse("x=50%"), begin = s;
    section_handle handles[SECTION_HANDLES];
    orbit          o = turned(false);
    const double   low[3] = {-1, -2, 0}, high[3] = {3, 1, 2}, wanted[3] = {-1 + 4 * 0.8, -0.5, 1};
    double         at[2];
    assert_int_equal(section_handles(&s, low, high, &o, 800, 600, handles), 1);
    assert_true(orbit_project(&o, wanted, 800, 600, at));
    section_drag(&s, &handles[0], &begin, at[0] - handles[0].at[0], at[1] - handles[0].at[1]);
    assert_close(s.high[0], 80, 8); /* a perspective; steps are those at 50 % */
    s = section_parse(texts[2]);
    assert_int_equal(section_handles(&s, low, high, &o, 800, 600, handles), 6);
}

/* A node below turned and scaled ones moves by as much of the scene as it is told. */
static void nodes_move_in_the_scene_s_axes(void **state)
{
    (void)state;
    const double above[16] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1.5, 0, 7, 8, 9, 1};
    const double own[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}, shift[3] = {0.5, -1, 2};
    double       moved[16], a[16], b[16];
    solid_shift(own, above, shift, moved);
    matrix_multiply(above, own, a);
    matrix_multiply(above, moved, b);
    for (int k = 0; k < 3; k++)
        assert_close(b[12 + k] - a[12 + k], shift[k], 1e-12);
    const double p[3] = {1, 2, 3};
    double       q[3], back[3];
    matrix_move_point(above, p, q);
    assert_true(matrix_solve_point(above, q, back));
    for (int k = 0; k < 3; k++)
        assert_close(back[k], p[k], 1e-12);
}

/* A quarter turn around an axis of the scene through a point: the point stays, what lies beside it goes around. */
static void nodes_turn_around_the_scene_s_axes(void **state)
{
    (void)state;
    const double above[16] = {0, 2, 0, 0, -3, 0, 0, 0, 0, 0, 1.5, 0, 7, 8, 9, 1};
    const double own[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 4, 5, 6, 1}, around[3] = {1, -2, 3};
    const double p[3] = {0.5, -1, 2};
    double       all[16], turned[16], before[3], after[3];
    matrix_multiply(above, own, all);
    matrix_move_point(all, p, before);
    for (int axis = 0; axis < 3; axis++) {
        int i = (axis + 1) % 3, j = (axis + 2) % 3;
        solid_turn(own, above, around, axis, G_PI_2, turned);
        matrix_multiply(above, turned, all);
        matrix_move_point(all, p, after);
        assert_close(after[axis], before[axis], 1e-12);
        assert_close(after[i] - around[i], -(before[j] - around[j]), 1e-12);
        assert_close(after[j] - around[j], before[i] - around[i], 1e-12);
    }
}

static void hidden_operands_come_back(void **state)
{
    (void)state;
    scene_ref     *scene = load("csg/widget.csg");
    uint32_t       solid = lmn_scene_solid_at(scene->scene, 0);
    lmn_solid_info root;
    assert_true(lmn_solid_info_of(scene->scene, solid, LMN_SOLID_ROOT, &root));
    solid_edit     edit = {.solid = solid, .node = root.first_child, .hidden = true};
    lmn_solid_info info;
    assert_true(lmn_solid_info_of(scene->scene, solid, edit.node, &info));
    memcpy(edit.original, info.matrix, sizeof edit.original);
    memcpy(edit.matrix, info.matrix, sizeof edit.matrix);
    GArray *hidden = solid_edits_with(NULL, &edit);
    DO(scene_ref_edit(scene, hidden, &error));
    assert_false(lmn_solid_is_shown(scene->scene, solid, edit.node));
    edit.hidden = false;
    GArray *none = solid_edits_with(hidden, &edit);
    assert_int_equal(none->len, 0); /* as the file has it: commands can say so again */
    DO(scene_ref_edit(scene, none, &error));
    assert_true(lmn_solid_is_shown(scene->scene, solid, edit.node));
    g_array_unref(hidden);
    g_array_unref(none);
    scene_ref_drop(scene);
}

/* Fitting is no step of undo, and leaves a view alone that somebody has moved meanwhile. */
static void views_are_fitted_until_they_are_moved(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_scene(d, load("box.glb"), true, 100, 100);
    orbit first = document_state(d)->view, better = first, moved = first;
    better.distance *= 0.9;
    moved.yaw += 1;
    assert_true(document_state(d)->fitted);
    document_fit_view(d, &first, &better);
    assert_true(document_state(d)->fitted && document_state(d)->view.distance == better.distance);
    assert_null(document_undo_name(d));
    document_set_view(d, &moved, "Turn");
    assert_false(document_state(d)->fitted);
    document_fit_view(d, &better, &first);
    assert_true(document_state(d)->view.yaw == moved.yaw);
    assert_true(document_undo(d) && document_state(d)->fitted);
    document_free(d);
}

/* A file that is read again may have lost what a state says of it. */
static void states_outlive_what_files_lose(void **state)
{
    (void)state;
    scene_ref    *moving = load("pump.glb"), *still = load("box.glb");
    view_state    s = {.timed = true, .time_s = 0.5, .clip = (char *)"1"};
    lmn_draw_desc desc;
    state_describe(&s, moving, NULL, 10, 10, &desc);
    assert_true(desc.time_given && desc.time_s == 0.5 && strcmp(desc.clip, "1") == 0);
    state_describe(&s, still, NULL, 10, 10, &desc);
    assert_true(!desc.time_given && desc.time_s == 0 && !desc.clip);
    solid_edit edit = {.solid = 1, .node = 7, .hidden = true};
    GArray    *edits = solid_edits_with(NULL, &edit);
    DO(scene_ref_edit(still, edits, &error));
    g_array_unref(edits);
    scene_ref_drop(moving);
    scene_ref_drop(still);
}

static void edits_of_solids_are_taken_back(void **state)
{
    (void)state;
    scene_ref     *scene = load("csg/widget.csg");
    uint32_t       solid = lmn_scene_solid_at(scene->scene, 0);
    lmn_solid_info before, now;
    assert_true(lmn_solid_info_of(scene->scene, solid, LMN_SOLID_ROOT, &before));
    solid_edit edit = {.solid = solid, .node = LMN_SOLID_ROOT};
    memcpy(edit.original, before.matrix, sizeof edit.original);
    memcpy(edit.matrix, before.matrix, sizeof edit.matrix);
    edit.matrix[12] += 3;
    GArray *edits = solid_edits_with(NULL, &edit);
    DO(scene_ref_edit(scene, edits, &error));
    assert_true(lmn_solid_info_of(scene->scene, solid, LMN_SOLID_ROOT, &now));
    assert_close(now.matrix[12], before.matrix[12] + 3, 1e-12);
    DO(scene_ref_edit(scene, NULL, &error));
    assert_true(lmn_solid_info_of(scene->scene, solid, LMN_SOLID_ROOT, &now));
    assert_close(now.matrix[12], before.matrix[12], 1e-12);
    g_array_unref(edits);
    scene_ref_drop(scene);
}

static void sliders_go_there_and_back(void **state)
{
    (void)state;
    lmn_kind_info      kind;
    lmn_technique_info technique;
    lmn_param_info     param;
    int                logarithmic = 0;
    for (size_t k = 0; lmn_kind_at(k, &kind); k++)
        for (size_t t = 0; lmn_technique_at(kind.name, t, &technique); t++)
            for (size_t p = 0; lmn_param_at(kind.name, technique.name, p, &param); p++) {
                if (param.type != LMN_PARAM_FLOAT || !(param.soft_max > param.soft_min))
                    continue;
                logarithmic += param.logarithmic;
                assert_close(slider_value(&param, 0), param.soft_min, 0);
                assert_close(slider_value(&param, 1), param.soft_max, 0);
                for (double at = 0.1; at < 1; at += 0.2) {
                    double value = slider_value(&param, at);
                    assert_true(value >= param.min && value <= param.max);
                    assert_close(slider_position(&param, value), at, 0.02);
                }
            }
    assert_true(logarithmic > 3);
}

static void slow_pictures_become_smaller_and_fast_ones_larger(void **state)
{
    (void)state;
    pace   p = {0};
    double at_first = pace_scale(&p);
    pace_told(&p, 900); /* compiles */
    assert_close(pace_scale(&p), at_first, 0);
    for (int i = 0; i < 12; i++)
        pace_told(&p, 90 * pace_scale(&p) * pace_scale(&p));
    assert_true(90 * pace_scale(&p) * pace_scale(&p) <= 44 && pace_scale(&p) > 0.45);
    for (int i = 0; i < 40; i++)
        pace_told(&p, 8 * pace_scale(&p) * pace_scale(&p));
    assert_close(pace_scale(&p), 1, 0);
}

/* --- the thread that draws ------------------------------------------------------------------------------- */

typedef struct test_job {
    artist_job job;
    int        number;
} test_job;

static GString *drawn;
static gint     entered, let_go;

static lmn_status note_job(artist_job *base, lmn_renderer *renderer, lmn_error *e)
{
    (void)e;
    test_job *j = (test_job *)base;
    if (!renderer)
        return LMN_GL;
    if (j->number == 0) { /* long work: until it is told to stop, or let go */
        g_atomic_int_set(&entered, 1);
        while (!g_atomic_int_get(&let_go)) {
            if (!artist_goes_on(0.5, "", base))
                return LMN_CANCELLED;
            g_usleep(1000);
        }
    }
    return LMN_OK;
}

static void note_done(artist_job *base, lmn_status status, const lmn_error *e)
{
    (void)e;
    g_string_append_printf(drawn, "%d%s ", ((test_job *)base)->number, status == LMN_OK ? "" : "!");
}

static void free_job(artist_job *base)
{
    g_free(base);
}

static void ask_number(artist *a, artist_urgency urgency, int slot, int number)
{
    test_job *j = g_new0(test_job, 1);
    j->job = (artist_job){urgency, slot, note_job, note_done, free_job};
    j->number = number;
    artist_ask(a, &j->job);
}

static void wait_for(const char *wanted)
{
    gint64 until = g_get_monotonic_time() + 20 * G_TIME_SPAN_SECOND;
    while (strcmp(drawn->str, wanted) != 0 && g_get_monotonic_time() < until)
        g_main_context_iteration(NULL, FALSE);
    assert_string_equal(drawn->str, wanted);
}

static void urgent_jobs_come_first_and_new_ones_replace_old(void **state)
{
    (void)state;
    artist *a = artist_start();
    drawn = g_string_new(NULL);
    ask_number(a, ARTIST_REST, 1, 0);
    while (!g_atomic_int_get(&entered))
        g_usleep(1000);
    ask_number(a, ARTIST_ASIDE, 7, 5);
    ask_number(a, ARTIST_ASIDE, 7, 6);  /* instead of 5 */
    ask_number(a, ARTIST_MOVING, 0, 1); /* 0 gives way, and goes on afterwards */
    wait_for("1 ");
    g_atomic_int_set(&let_go, 1);
    wait_for("1 0 6 ");
    artist_end(a);
    g_string_free(drawn, TRUE);
}

/* A job whose context is lost while it is drawn, once or each time, is tried once more with another renderer. */
static int           losses, tries;
static lmn_renderer *lost_with;

static lmn_status lose_context(artist_job *base, lmn_renderer *renderer, lmn_error *e)
{
    (void)e;
    test_job *j = (test_job *)base;
    if (j->number != 2)
        return LMN_OK;
    tries++;
    lost_with = renderer;
    return tries <= losses ? LMN_GL : LMN_OK;
}

static void ask_to_lose(artist *a, int number)
{
    test_job *j = g_new0(test_job, 1);
    j->job = (artist_job){ARTIST_REST, 0, lose_context, note_done, free_job};
    j->number = number;
    artist_ask(a, &j->job);
}

static void lost_contexts_are_made_anew(void **state)
{
    (void)state;
    const char *const told[] = {"1 2 3 ", "1 2! 3 "};
    for (losses = 1; losses <= 2; losses++) {
        artist *a = artist_start();
        drawn = g_string_new(NULL);
        tries = 0;
        ask_to_lose(a, 1);
        ask_to_lose(a, 2);
        ask_to_lose(a, 3);
        wait_for(told[losses - 1]);
        assert_int_equal(tries, 2);
        assert_non_null(lost_with);
        artist_end(a);
        g_string_free(drawn, TRUE);
    }
}

/* --- commands and exports -------------------------------------------------------------------------------- */

static char *folder;

static void check_same_file(const char *one, const char *other)
{
    char *a = NULL, *b = NULL;
    gsize a_size = 0, b_size = 0;
    assert_true(g_file_get_contents(one, &a, &a_size, NULL) && g_file_get_contents(other, &b, &b_size, NULL));
    assert_true(a_size > 200 && a_size == b_size && memcmp(a, b, a_size) == 0);
    g_free(a);
    g_free(b);
}

/* The state as a program: it is compiled without a warning and draws this file, too. */
static void check_program(document *d, export_wish wish, const char *wanted)
{
    char *name = g_path_get_basename(wanted), *path = g_strdup_printf("%s/program-%s", folder, name);
    char *source = g_build_filename(folder, "program.c", NULL), *program = g_build_filename(folder, "program", NULL);
    wish.path = path;
    char *text = command_in_c(document_state(d), document_scene(d), &wish, &error);
    if (!text)
        fail_msg("%s", error.message);
    assert_true(g_file_set_contents(source, text, -1, NULL));
    char *compile = g_strdup_printf("%s -std=gnu11 -Wall -Wextra -Werror -I'%s' '%s' -o '%s' '%s' -Wl,-rpath,'%s'",
                                    COMPILER, INCLUDE, source, program, LIBRARY, LIBRARY_FOLDER);
    assert_int_equal(system(compile), 0);
    assert_int_equal(system(program), 0);
    check_same_file(wanted, path);
    char *all[] = {name, path, source, program, text, compile};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        g_free(all[i]);
}

/* What is exported, what the copied command draws and what the copied program draws are the same bytes. */
static void check_export_of(document *d, const char *name, export_wish wish)
{
    char *ours = g_build_filename(folder, name, NULL), *theirs = g_strdup_printf("%s/command-%s", folder, name);
    wish.path = theirs;
    wish.width = 200;
    wish.height = 150;
    GStrv words = command_words(document_state(d), document_scene(d), &wish, &error);
    if (!words)
        fail_msg("%s", error.message);
    /* Through a shell, as a person pastes it. */
    char *line = command_line((const char *const *)words + 1), *whole = g_strdup_printf("%s %s -q", COMMAND, line);
    assert_int_equal(system(whole), 0);
    wish.path = ours;
    DO(export_draw(document_scene(d), document_state(d), &wish, NULL, NULL, NULL, &error));
    check_same_file(ours, theirs);
    check_program(d, wish, ours);
    unlink(ours);
    unlink(theirs);
    g_free(ours);
    g_free(theirs);
    g_free(line);
    g_free(whole);
    g_strfreev(words);
}

static void check_export(document *d, const char *name, int samples, bool transparent)
{
    check_export_of(d, name, (export_wish){.samples = samples, .transparent = transparent});
}

static void set_look(document *d, const char *key, const char *value)
{
    lmn_look *look = document_copy_look(d, &error);
    DO(lmn_look_set(look, key, value, &error));
    document_put_look(d, look, g_intern_string(key));
}

static void copied_commands_draw_what_is_exported(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_scene(d, load("pump.glb"), true, 200, 150);
    check_export(d, "first.png", 0, false);
    orbit o = document_state(d)->view;
    orbit_turn(&o, 33, -7, 150);
    orbit_zoom(&o, 0.7, 40, 90, 200, 150);
    document_set_view(d, &o, "Turn");
    set_look(d, "lines.width", "2.5");
    set_look(d, "scene.cut", "box=50%,45%,0%:100%,100%,100%");
    check_export(d, "section.png", 4, true);
    o.orthographic = true;
    o.fov_deg = 50;
    document_set_view(d, &o, "Projection");
    const uint32_t parts[] = {2, 4};
    document_show_parts(d, parts, 2, false);
    check_export(d, "parallel.png", 1, false);
    /* A rule more: no --set says that, so the look is kept as a file. */
    size_t    rule = 0;
    lmn_look *look = document_copy_look(d, &error);
    DO(lmn_look_set(look, "scene.cut", "", &error));
    DO(lmn_look_add_rule(look, "[id=5]", LMN_AT_END, &rule, &error));
    DO(lmn_look_set_technique(look, rule, "surface", 0, "toon", &error));
    document_put_look(d, look, "Add rule");
    assert_null(look_settings(document_state(d)->look));
    check_export(d, "rule.png", 1, false);
    document_set_look(d, look_ref_load("line", &error), "Look");
    check_export(d, "drawing.svg", 0, false);
    /* Neither samples nor a ground: the command has to be spared what its formats have no room for. */
    check_export(d, "lines.dxf", 4, true);
    document_set_look(d, look_ref_load("technical", &error), "Look");
    check_export_of(d, "A sheet of 'paper'.pdf", (export_wish){.dpi = 72.5, .samples = 4});
    document_free(d);
    d = document_make();
    document_set_scene(d, load("fox.glb"), true, 200, 150);
    document_set_time(d, true, 0.31, "3");
    check_export(d, "moment.png", 1, false);
    /* Of a film the clip counts also while the window shows the model at rest. */
    export_wish   wish = {.path = "film.webp", .width = 10, .height = 10, .rate = 5};
    lmn_draw_desc desc;
    document_set_time(d, false, 0, "2");
    wish_describe(document_state(d), document_scene(d), &wish, NULL, &desc);
    assert_true(desc.time_given && desc.fit_time);
    assert_string_equal(desc.clip, "2");
    check_export_of(d, "film.webp", (export_wish){.samples = 1, .first = 0.1, .last = 0.26, .rate = 12.5});
    document_free(d);
}

static void check_settings(document *d, const char *const *wanted)
{
    GArray *settings = look_settings(document_state(d)->look);
    size_t  count = 0;
    assert_non_null(settings);
    for (; wanted[2 * count]; count++) {
        assert_true(count < settings->len);
        const look_setting *s = &g_array_index(settings, look_setting, count);
        assert_string_equal(s->key, wanted[2 * count]);
        assert_string_equal(s->value, wanted[2 * count + 1]);
    }
    assert_int_equal(settings->len, count);
    g_array_unref(settings);
}

static void exchanged_techniques_are_settings(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_look(d, look_ref_load("pencil", &error), "Look");
    check_settings(d, (const char *const[]){NULL});
    const char *before = lmn_look_technique(document_state(d)->look->look, 0, "surface", 0);
    const char *other = g_strcmp0(before, "toon") == 0 ? "gooch" : "toon";
    set_look(d, "lines.width", "3.25");
    set_look(d, "surface.technique", other);
    check_settings(d, (const char *const[]){"surface.technique", other, "lines.width", "3.25", NULL});
    /* With several rules each is named. */
    size_t    rule = 0;
    lmn_look *look = document_copy_look(d, &error);
    DO(lmn_look_add_rule(look, "[id=5]", LMN_AT_END, &rule, &error));
    DO(lmn_look_set_rule_name(look, 0, "all the rest", &error));
    document_put_look(d, look, "Add rule");
    char *kept = look_keep(document_state(d)->look, &error);
    assert_non_null(kept);
    document_set_look(d, look_ref_load(kept, &error), "Look");
    set_look(d, "all the rest:lines.width", "2");
    set_look(d, "1:surface.technique", "flat");
    /* A kind that the one rule had not, and one that the other had. */
    const char *lines = lmn_look_technique(document_state(d)->look->look, 0, "lines", 0);
    set_look(d, "1:lines.technique", lines);
    set_look(d, "1:lines.width", "7");
    check_settings(d, (const char *const[]){"1:surface.technique", "flat", "1:lines.technique", lines,
                                            "all the rest:lines.width", "2", "1:lines.width", "7", NULL});
    set_look(d, "all the rest:lines.technique", "none");
    check_settings(d, (const char *const[]){"1:surface.technique", "flat", "all the rest:lines.technique", "none",
                                            "1:lines.technique", lines, "1:lines.width", "7", NULL});
    g_free(kept);
    document_free(d);
}

/* Whatever shape a page has: what the window shows is on it. */
static void narrow_pages_show_all_of_a_window(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_scene(d, load("box.glb"), true, 400, 200);
    for (int parallel = 0; parallel < 2; parallel++) {
        orbit         o = document_state(d)->view, narrow;
        export_wish   wish = {.path = "x.png", .width = 300, .height = 900, .shown = 2};
        lmn_draw_desc desc, wide;
        double        right[3], up[3], forward[3], corner[3], inside[2];
        o.orthographic = parallel;
        document_set_view(d, &o, "Projection");
        wish_describe(document_state(d), document_scene(d), &wish, NULL, &desc);
        narrow = o;
        narrow.fov_deg = atan(tan(o.fov_deg * G_PI / 360) * 6) * 360 / G_PI; /* 2 : 1 in 1 : 3 */
        orbit_axes(&o, right, up, forward);
        for (int k = 0; k < 3; k++) /* at the window's right border */
            corner[k] = o.target[k] + right[k] * o.distance * tan(o.fov_deg * G_PI / 360) * 2;
        assert_true(orbit_project(&narrow, corner, 300, 900, inside));
        assert_close(inside[0], 300, 1e-6);
        orbit_describe(&narrow, &wide);
        assert_close(desc.fov_deg, wide.fov_deg, 1e-9);
        for (int k = 0; k < 3; k++)
            assert_close(desc.eye[k], wide.eye[k], 1e-9);
        wish.width = 900; /* wide ones are as high as the window */
        wish.height = 300;
        wish_describe(document_state(d), document_scene(d), &wish, NULL, &desc);
        orbit_describe(&o, &wide);
        assert_true(desc.fov_deg == wide.fov_deg && desc.eye[0] == wide.eye[0]);
    }
    document_free(d);
}

static void names_with_braces_are_no_command(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_scene(d, load("box.glb"), true, 200, 150);
    export_wish wish = {.path = "x{name}.png", .width = 10, .height = 10};
    error = (lmn_error){0};
    assert_null(command_words(document_state(d), document_scene(d), &wish, &error));
    assert_true(error.status == LMN_UNSUPPORTED && *error.hint);
    document_free(d);
}

/* --- work aside ------------------------------------------------------------------------------------------ */

typedef struct aside_test {
    export_wish wish;
    int         ended;
    lmn_status  status;
    bool        own; /* renderer */
} aside_test;

static lmn_status draw_aside(const scene_ref *scene, const view_state *s, lmn_renderer *renderer,
                             lmn_progress_fn progress, void *progress_user, void *user, lmn_error *e)
{
    aside_test *t = user;
    t->own = !renderer;
    return export_draw(scene, s, &t->wish, renderer, progress, progress_user, e);
}

static void aside_ended(lmn_status status, const lmn_error *e, void *user)
{
    (void)e;
    aside_test *t = user;
    t->ended++;
    t->status = status;
}

static void wait_until_ended(const aside_test *tests, int count)
{
    gint64 until = g_get_monotonic_time() + 60 * G_TIME_SPAN_SECOND;
    int    ended = 0;
    while (ended < count && g_get_monotonic_time() < until) {
        g_main_context_iteration(NULL, FALSE);
        ended = 0;
        for (int i = 0; i < count; i++)
            ended += tests[i].ended;
    }
    assert_int_equal(ended, count);
}

static void exports_are_drawn_beside_each_other(void **state)
{
    (void)state;
    document  *d = document_make();
    artist    *a = artist_start();
    aside_test tests[3] = {0};
    char      *paths[3];
    aside_desc desc = {.artist = a, .work = draw_aside, .done = aside_ended};
    document_set_scene(d, load("pump.glb"), true, 200, 150);
    desc.scene = document_scene(d);
    desc.state = document_state(d);
    for (int i = 0; i < 3; i++) {
        paths[i] = g_strdup_printf("%s/aside-%d.png", folder, i);
        tests[i].wish = (export_wish){.path = paths[i], .width = 300, .height = 200};
        desc.user = &tests[i];
        (void)aside_begin(&desc);
    }
    wait_until_ended(tests, 3);
    for (int i = 0; i < 3; i++) {
        assert_true(tests[i].status == LMN_OK && tests[i].own);
        check_same_file(paths[0], paths[i]);
    }
    for (int i = 0; i < 3; i++) {
        unlink(paths[i]);
        g_free(paths[i]);
    }
    artist_end(a);
    document_free(d);
}

static void cancelled_exports_leave_nothing(void **state)
{
    (void)state;
    static const char *const files[] = {"pump.glb", "csg/widget.csg"};
    artist                  *a = artist_start();
    char                    *path = g_build_filename(folder, "cancelled.png", NULL);
    for (int solid = 0; solid < 2; solid++) {
        document  *d = document_make();
        aside_test t = {.wish = {.path = path, .width = 3000, .height = 3000, .samples = 1}};
        document_set_scene(d, load(files[solid]), true, 200, 150);
        aside_desc desc = {a, document_scene(d), document_state(d), draw_aside, NULL, aside_ended, &t};
        aside_cancel(aside_begin(&desc));
        wait_until_ended(&t, 1);
        assert_int_equal(t.status, LMN_CANCELLED);
        assert_false(g_file_test(path, G_FILE_TEST_EXISTS));
        assert_true(t.own == !solid); /* solids are the artist's */
        document_free(d);
    }
    /* The artist goes before it has begun. */
    document  *d = document_make();
    aside_test t = {.wish = {.path = path, .width = 3000, .height = 3000, .samples = 1}};
    document_set_scene(d, load("csg/widget.csg"), true, 200, 150);
    aside_desc desc = {a, document_scene(d), document_state(d), draw_aside, NULL, aside_ended, &t};
    (void)aside_begin(&desc);
    artist_end(a);
    wait_until_ended(&t, 1);
    assert_int_equal(t.status, LMN_CANCELLED);
    assert_false(g_file_test(path, G_FILE_TEST_EXISTS));
    document_free(d);
    g_free(path);
}

static void moved_solids_are_no_command(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_scene(d, load("csg/widget.csg"), true, 200, 150);
    solid_edit  edit = {.solid = 1, .node = LMN_SOLID_ROOT, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}};
    export_wish wish = {.path = "x.png", .width = 10, .height = 10};
    document_edit_solid(d, &edit, "Move solid");
    error = (lmn_error){0};
    assert_null(command_words(document_state(d), document_scene(d), &wish, &error));
    assert_true(error.status == LMN_UNSUPPORTED && *error.message && *error.hint);
    document_free(d);
}

/* A part that is given a look is drawn as that look draws it; given another one, it has that and no rule more. */
static void parts_get_looks_of_their_own(void **state)
{
    (void)state;
    static const char *const names[] = {"toon", "pencil", "technical"};
    for (int i = 0; i < 3; i++) {
        look_ref *look = look_ref_load("edges", &error), *first = look_ref_load("hatch", &error);
        look_ref *from = look_ref_load(names[i], &error);
        DO(part_look_put(look->look, 4, first->look, &error));
        DO(part_look_put(look->look, 4, from->look, &error));
        assert_int_equal(lmn_look_rule_count(look->look), 2);
        assert_string_equal(lmn_look_rule_selector(look->look, 1), "[id=4]");
        lmn_kind_info kind;
        size_t        compared = 0;
        for (size_t k = 0; lmn_kind_at(k, &kind); k++)
            for (size_t t = 0; !kind.whole_look && t < lmn_look_technique_count(from->look, 0, kind.name); t++) {
                lmn_param_info param;
                const char    *technique = lmn_look_technique(from->look, 0, kind.name, t);
                assert_string_equal(lmn_look_technique(look->look, 1, kind.name, t), technique);
                for (size_t p = 0; lmn_param_at(kind.name, technique, p, &param); p++, compared++) {
                    char text[2][LMN_VALUE_TEXT_MAX];
                    DO(lmn_look_get_text(from->look, 0, kind.name, t, param.key, text[0], sizeof *text, &error));
                    DO(lmn_look_get_text(look->look, 1, kind.name, t, param.key, text[1], sizeof *text, &error));
                    assert_string_equal(text[0], text[1]);
                }
            }
        assert_true(compared > 20);
        look_ref_drop(look);
        look_ref_drop(first);
        look_ref_drop(from);
    }
}

/* --- strokes drawn by hand ------------------------------------------------------------------------------- */

static stroke_sheet *drawn_sheet(void)
{
    stroke_sheet *s = stroke_sheet_make();
    for (int i = 0; i < 24; i++)
        stroke_sheet_add(s, 0.04 * i, 0.1 + 0.03 * i, 0.04 * i + 0.3, 0.2, i % 3);
    return s;
}

static void strokes_are_read_as_they_were_saved(void **state)
{
    (void)state;
    char         *path = g_build_filename(folder, "drawn.stx", NULL);
    stroke_sheet *s = drawn_sheet(), *again = stroke_sheet_make();
    DO(stroke_sheet_order(s, LMN_ORDER_SHUFFLED, LMN_PERSPECTIVE_RANDOM, 7, &error));
    DO(stroke_sheet_save(s, path, &error));
    DO(stroke_sheet_load(again, path, &error));
    assert_int_equal(again->strokes->len, 24);
    assert_memory_equal(again->strokes->data, s->strokes->data, 24 * sizeof(lmn_stroke));
    stroke_sheet_free(s);
    stroke_sheet_free(again);
    g_free(path);
}

static void ends_are_picked_and_moved(void **state)
{
    (void)state;
    stroke_sheet *s = stroke_sheet_make();
    bool          second = false;
    stroke_sheet_add(s, 0.9, 0.5, 1.1, 0.5, 0); /* leaves the square on the right */
    stroke_sheet_add(s, 0.2, 0.2, 0.4, 0.2, 1);
    stroke_sheet_step(s);
    assert_int_equal(stroke_sheet_pick(s, 0.1, 0.51, 0.03, &second), 0); /* comes in on the left */
    assert_true(second);
    stroke_sheet_move_end(s, 0, true, 0.15, 0.6);
    const lmn_stroke *k = &g_array_index(s->strokes, lmn_stroke, 0);
    assert_close((double)k->u1, 1.15, 1e-6);
    assert_close((double)k->v1, 0.6, 1e-6);
    assert_int_equal(stroke_sheet_pick(s, 0.7, 0.8, 0.03, &second), -1);
    stroke_sheet_set_layer(s, 1, 9);
    assert_true(stroke_sheet_undo(s));
    assert_int_equal(g_array_index(s->strokes, lmn_stroke, 1).layer, 1);
    assert_close((double)g_array_index(s->strokes, lmn_stroke, 0).u1, 1.1, 1e-6);
    assert_false(stroke_sheet_undo(s));
    stroke_sheet_free(s);
}

static char *picture_of(const stroke_sheet *s, double light, double distance, gsize *size)
{
    char            *stx = g_build_filename(folder, "p.stx", NULL), *png = g_build_filename(folder, "p.png", NULL);
    char            *bytes = NULL;
    lmn_strokes     *strokes = NULL;
    lmn_strokes_view view = LMN_STROKES_VIEW_INIT;
    view.size = 128;
    view.light = light;
    view.distance = distance;
    DO(stroke_sheet_save(s, stx, &error));
    DO(lmn_strokes_load(&strokes, stx, &error));
    DO(lmn_strokes_write(strokes, png, NULL, &view, &error));
    lmn_strokes_destroy(&strokes);
    assert_true(g_file_get_contents(png, &bytes, size, NULL));
    g_free(stx);
    g_free(png);
    return bytes;
}

/* What the window shows at two thresholds is what the library draws at them. */
static void thresholds_are_the_library_s(void **state)
{
    (void)state;
    static const double wanted[][2] = {{0.3, 0}, {0, 0.6}, {0.4, 0.4}, {0.9, 0.2}};
    stroke_sheet       *s = drawn_sheet();
    DO(stroke_sheet_order(s, LMN_ORDER_SHUFFLED, LMN_PERSPECTIVE_RANDOM, 7, &error));
    for (int i = 0; i < 4; i++) {
        stroke_sheet *seen = stroke_sheet_make();
        gsize         sizes[2];
        for (guint k = 0; k < s->strokes->len; k++)
            if (stroke_is_seen(&g_array_index(s->strokes, lmn_stroke, k), wanted[i][0], wanted[i][1]))
                g_array_append_val(seen->strokes, g_array_index(s->strokes, lmn_stroke, k));
        assert_true(seen->strokes->len > 0 && seen->strokes->len < s->strokes->len);
        char *theirs = picture_of(s, wanted[i][0], wanted[i][1], &sizes[0]), *ours = picture_of(seen, 0, 0, &sizes[1]);
        assert_int_equal(sizes[0], sizes[1]);
        assert_memory_equal(theirs, ours, sizes[0]);
        g_free(theirs);
        g_free(ours);
        stroke_sheet_free(seen);
    }
    stroke_sheet_free(s);
}

/* --- presentation ---------------------------------------------------------------------------------------- */

static void turn_for(gint64 ms)
{
    for (gint64 until = g_get_monotonic_time() + ms * 1000; g_get_monotonic_time() < until; g_usleep(2000))
        g_main_context_iteration(NULL, FALSE);
}

static void a_presentation_stands_still_for_people(void **state)
{
    (void)state;
    document *d = document_make();
    document_set_scene(d, load("box.glb"), true, 100, 100);
    double begin = document_state(d)->view.yaw;
    tour  *t = tour_make(d);
    tour_run(t, true);
    turn_for(200);
    double then = document_state(d)->view.yaw;
    assert_true(then > begin + 0.02);
    tour_interrupt(t);
    turn_for(100);
    assert_close(document_state(d)->view.yaw, then, 0);
    /* All of it is one step. */
    assert_true(document_undo(d));
    assert_close(document_state(d)->view.yaw, begin, 0);
    tour_free(t);
    document_free(d);
}

static int set_up(void **state)
{
    (void)state;
    folder = g_dir_make_tmp("limner-view-XXXXXX", NULL);
    return folder && g_setenv("XDG_DATA_HOME", folder, TRUE) ? 0 : -1;
}

static int tear_down(void **state)
{
    (void)state;
    char *command = g_strdup_printf("rm -r '%s'", folder);
    int   status = system(command);
    g_free(command);
    g_free(folder);
    return status;
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(named_views_are_the_library_s),
        cmocka_unit_test(fitting_fills_the_picture),
        cmocka_unit_test(zoom_and_pan_follow_the_pointer),
        cmocka_unit_test(looking_around_keeps_the_eye),
        cmocka_unit_test(everything_is_undone_and_redone),
        cmocka_unit_test(selectors_say_what_is_shown),
        cmocka_unit_test(sections_are_read_and_written),
        cmocka_unit_test(nodes_move_in_the_scene_s_axes),
        cmocka_unit_test(nodes_turn_around_the_scene_s_axes),
        cmocka_unit_test(hidden_operands_come_back),
        cmocka_unit_test(views_are_fitted_until_they_are_moved),
        cmocka_unit_test(states_outlive_what_files_lose),
        cmocka_unit_test(edits_of_solids_are_taken_back),
        cmocka_unit_test(lost_contexts_are_made_anew),
        cmocka_unit_test(sliders_go_there_and_back),
        cmocka_unit_test(slow_pictures_become_smaller_and_fast_ones_larger),
        cmocka_unit_test(urgent_jobs_come_first_and_new_ones_replace_old),
        cmocka_unit_test(copied_commands_draw_what_is_exported),
        cmocka_unit_test(exchanged_techniques_are_settings),
        cmocka_unit_test(narrow_pages_show_all_of_a_window),
        cmocka_unit_test(names_with_braces_are_no_command),
        cmocka_unit_test(exports_are_drawn_beside_each_other),
        cmocka_unit_test(cancelled_exports_leave_nothing),
        cmocka_unit_test(moved_solids_are_no_command),
        cmocka_unit_test(parts_get_looks_of_their_own),
        cmocka_unit_test(strokes_are_read_as_they_were_saved),
        cmocka_unit_test(ends_are_picked_and_moved),
        cmocka_unit_test(thresholds_are_the_library_s),
        cmocka_unit_test(a_presentation_stands_still_for_people),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
