/* Dots and strokes of surfaces on sheets: which are there against rays cast at all triangles, what lies behind a
 * body, their groups, files, plotters, and what stops a drawing. */
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
#include "plan/paper_look.h"
#include "stage/mark_ground.h"
#include "vector/vector.h"
#include "limner/limner.h"

enum { ROWS = 24, COLUMNS = 36, SIDE = 400 };
static const double RADIUS = 1, WALL = 2.5, WALL_Z = -1.5;

static const char stipple[] = "{\"version\":1,\"rules\":[{\"select\":\"*\",\"surface\":{\"technique\":\"stipple\","
                              "\"count\":6000,\"shadow\":0.2,\"light\":0.9}}]}";
static const char quill[] =
    "{\"version\":1,\"rules\":[{\"select\":\"*\",\"surface\":{\"technique\":\"strokes\",\"count\":600}}]}";

typedef struct fixture {
    lmn_scene *scene; /* a ball before a wall */
    lmn_look  *stipple, *quill;
} fixture;

static void print_ball(FILE *f)
{
    fprintf(f, "o ball\n");
    for (int r = 0; r <= ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            double up = 3.14159265358979 * r / ROWS, around = 2 * 3.14159265358979 * c / COLUMNS;
            fprintf(f, "v %.9g %.9g %.9g\n", RADIUS * sin(up) * sin(around), RADIUS * cos(up),
                    RADIUS * sin(up) * cos(around));
        }
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            int a = r * COLUMNS + c + 1, b = r * COLUMNS + (c + 1) % COLUMNS + 1;
            if (r + 1 < ROWS)
                fprintf(f, "f %d %d %d\n", a, a + COLUMNS, b + COLUMNS);
            if (r > 0)
                fprintf(f, "f %d %d %d\n", a, b + COLUMNS, b);
        }
}

static lmn_look *look_of(const char *words)
{
    lmn_look *look = NULL;
    lmn_error error = {0};
    char      path[] = "/tmp/limner-marks-XXXXXX.json";
    int       descriptor = mkstemps(path, 5);
    assert_true(descriptor >= 0 && write(descriptor, words, strlen(words)) == (ssize_t)strlen(words));
    close(descriptor);
    if (lmn_look_load(&look, path, &error) != LMN_OK)
        fail_msg("%s", error.message);
    unlink(path);
    return look;
}

static int set_up(void **state)
{
    static fixture f;
    lmn_load_desc  load = LMN_LOAD_DESC_INIT;
    lmn_error      error = {0};
    char           path[] = "/tmp/limner-marks-XXXXXX.obj";
    int            descriptor = mkstemps(path, 4);
    FILE          *file = descriptor >= 0 ? fdopen(descriptor, "w") : NULL;
    if (!file)
        return -1;
    setenv("LIMNER_CACHE", "", 1);
    print_ball(file);
    fprintf(file, "o wall\nv %g %g %g\nv %g %g %g\nv %g %g %g\nv %g %g %g\nf -4 -3 -2 -1\n", -WALL, -WALL, WALL_Z, WALL,
            -WALL, WALL_Z, WALL, WALL, WALL_Z, -WALL, WALL, WALL_Z);
    fclose(file);
    f = (fixture){.stipple = look_of(stipple), .quill = look_of(quill)};
    load.up_axis = LMN_UP_Y; /* else the wall would be a floor */
    lmn_status status = lmn_scene_create(&f.scene, &error);
    if (status == LMN_OK)
        status = lmn_scene_add_file(f.scene, path, &load, &error);
    unlink(path);
    *state = &f;
    return status == LMN_OK ? 0 : -1;
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_look_destroy(&f->stipple);
    lmn_look_destroy(&f->quill);
    lmn_scene_destroy(&f->scene);
    return 0;
}

static lmn_draw_desc front(void)
{
    lmn_draw_desc how = LMN_DRAW_DESC_INIT;
    how.width = how.height = SIDE;
    how.dpi = 96;
    how.view = LMN_VIEW_FRONT;
    how.orthographic = true;
    return how;
}

static lmn_sheet *draw(const fixture *f, const lmn_look *look, const lmn_draw_desc *how, const lmn_sheet_desc *desc)
{
    lmn_sheet *s = NULL;
    lmn_error  error = {0};
    if (lmn_draw_sheet(&s, NULL, f->scene, look, how, desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return s;
}

static double report_number(const lmn_sheet *s, const char *key)
{
    char   *text = lmn_sheet_report_json(s);
    json_t *root = json_loads(text, 0, NULL);
    double  value = json_number_value(json_object_get(json_object_get(root, "strokes"), key));
    json_decref(root);
    lmn_text_free(text);
    return value;
}

/* Visits all dots of the sheet, in pixels of its one view. */
typedef void (*visit_fn)(void *user, uint32_t part, double x, double y, double diameter);
static size_t visit_dots(const lmn_sheet *s, visit_fn visit, void *user)
{
    const sheet *page = &s->page;
    size_t       count = 0;
    for (size_t i = 0; i < page->item_count; i++)
        for (uint32_t k = 0; page->items[i].kind == SHEET_DOTS && k < page->items[i].count; k++) {
            const sheet_path *path = &page->paths[page->items[i].first + k];
            for (uint32_t n = 0; n < path->count; n++, count++) {
                const float *p = page->points[path->first + n];
                double       scale = page->pixels_per_mm;
                if (visit)
                    visit(user, page->groups[page->items[i].group].part, ((double)p[0] - s->views[0].box[0]) * scale,
                          ((double)p[1] - s->views[0].box[1]) * scale, (double)path->width * scale);
            }
        }
    return count;
}

/* --- which dots there are ------------------------------------------------------------------------------- */

/* A triangle's first corner and the two sides from there. */
typedef struct corner {
    double at[3], sides[2][3];
} corner;

typedef struct rays {
    const mark_ground *ground;
    const view_camera *camera;
    corner            *corners; /* a triangle each */
} rays;

static void subtract(double out[3], const double a[3], const double b[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[k] - b[k];
}

static void cross(double out[3], const double a[3], const double b[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static corner *corners_of(const mark_ground *ground)
{
    corner *corners = calloc(ground->surface.triangle_count, sizeof *corners);
    assert_non_null(corners);
    for (uint32_t t = 0; t < ground->surface.triangle_count; t++) {
        double c[3][3];
        for (uint32_t i = 0; i < 3; i++) {
            const vec3  *v = &ground->positions[ground->indices[3 * (size_t)t + i]];
            const double position[3] = {(double)v->x + ground->origin[0], (double)v->y + ground->origin[1],
                                        (double)v->z + ground->origin[2]};
            memcpy(c[i], position, sizeof position);
        }
        memcpy(corners[t].at, c[0], sizeof c[0]);
        subtract(corners[t].sides[0], c[1], c[0]);
        subtract(corners[t].sides[1], c[2], c[0]);
    }
    return corners;
}

static bool is_hit(const corner *c, const double from[3], const double direction[3])
{
    double p[3], to[3], q[3];
    cross(p, direction, c->sides[1]);
    double whole = dot(c->sides[0], p);
    if (fabs(whole) < 1e-14)
        return false;
    subtract(to, from, c->at);
    double u = dot(to, p) / whole;
    if (u < 0 || u > 1)
        return false;
    cross(q, to, c->sides[0]);
    double v = dot(direction, q) / whole;
    return v >= 0 && u + v <= 1 && dot(c->sides[1], q) / whole > 1e-5;
}

/* Surfaces between positions and the eye, by all triangles. */
static void cast(void *user, const double (*positions)[3], size_t count, uint32_t *out)
{
    const rays   *r = user;
    const double *m = r->camera->view.m;
    for (size_t i = 0; i < count; i++) {
        double direction[3] = {m[2], m[6], m[10]};
        if (!r->camera->orthographic)
            subtract(direction, r->camera->eye, positions[i]);
        out[i] = 0;
        for (uint32_t t = 0; t < r->ground->surface.triangle_count; t++)
            out[i] += is_hit(&r->corners[t], positions[i], direction);
    }
}

typedef struct search {
    const marks_page *page;
    bool             *found;
    size_t            unknown;
} search;

static void find_dot(void *user, uint32_t part, double x, double y, double diameter)
{
    search *s = user;
    for (size_t i = 0; i < s->page->dot_count; i++) {
        const marks_page_point *d = &s->page->dots[i];
        if (!s->found[i] && d->part == part && fabs((double)d->x - x) + fabs((double)d->y - y) < 2e-3 &&
            fabs((double)d->width - diameter) <= 0.0251) {
            s->found[i] = true;
            return;
        }
    }
    s->unknown++;
}

static void assert_same_dots(const fixture *f, const lmn_draw_desc *how)
{
    lmn_sheet   *s = draw(f, f->stipple, how, NULL);
    pose         at_rest;
    mark_ground  ground;
    marks_page   page = {.dots = NULL};
    lmn_error    error = {0};
    const double crease = 30 * 3.14159265358979 / 180;
    assert_int_equal(pose_create(&at_rest, f->scene, &(moment){.seconds = 0}, &error), LMN_OK);
    assert_int_equal(mark_ground_create(&ground, &at_rest, NULL, f->scene->part_count, crease, &error), LMN_OK);
    lmn_look *on_page = paper_look_create(f->stipple, 96.0 / 72); /* its lengths in units of the sheet */
    assert_non_null(on_page);
    rays r = {&ground, &s->views[0].camera};
    r.corners = corners_of(&ground);
    mark_page_options options = {.pose = &at_rest,
                                 .look = on_page,
                                 .part_count = f->scene->part_count,
                                 .crease_angle = crease,
                                 .surface = on_page->rules[0].uses[KIND_SURFACE],
                                 .camera = r.camera,
                                 .width = SIDE,
                                 .height = SIDE,
                                 .hidden = cast,
                                 .user = &r};
    assert_int_equal(marks_on_page(&page, &options, &error), LMN_OK);
    paper_look_destroy(&on_page);
    search look_for = {&page, calloc(page.dot_count, 1), 0};
    size_t drawn = visit_dots(s, find_dot, &look_for), outside = 0, missing = 0;
    for (size_t i = 0; i < page.dot_count; i++) {
        bool out = page.dots[i].x < 0 || page.dots[i].y < 0 || page.dots[i].x > SIDE || page.dots[i].y > SIDE;
        outside += out;
        missing += !out && !look_for.found[i];
    }
    print_message("%zu dots drawn, %zu by rays, %zu missing, %zu too many\n", drawn, page.dot_count - outside, missing,
                  look_for.unknown);
    assert_true(drawn > 1000);
    assert_int_equal(missing, 0);
    assert_int_equal(look_for.unknown, 0);
    assert_int_equal((size_t)report_number(s, "dots"), drawn);
    free(look_for.found);
    free(r.corners);
    marks_page_release(&page);
    mark_ground_release(&ground);
    pose_release(&at_rest);
    lmn_sheet_destroy(&s);
}

static void test_same_dots(void **state)
{
    lmn_draw_desc how = front();
    assert_same_dots(*state, &how);
    how.view = LMN_VIEW_ISO;
    how.orthographic = false;
    assert_same_dots(*state, &how);
}

/* --- what lies behind ----------------------------------------------------------------------------------- */

typedef struct sides {
    double pixels; /* to a unit */
    size_t wall, ball, through, strayed;
} sides;

static void sort_dot(void *user, uint32_t part, double x, double y, double diameter)
{
    (void)diameter;
    sides *s = user;
    double away = hypot(x - SIDE / 2.0, y - SIDE / 2.0) / s->pixels;
    double inner = RADIUS * cos(3.14159265358979 / ROWS); /* of the ball's outline, which has corners */
    s->wall += part == 2;
    s->ball += part == 1;
    s->through += part == 2 && away < inner;
    s->strayed += part == 1 && away > RADIUS;
}

static sides sides_of(const lmn_sheet *s)
{
    return (sides){.pixels = SIDE / (2 * s->views[0].camera.half_height)};
}

static void test_behind(void **state)
{
    const fixture *f = *state;
    lmn_draw_desc  how = front();
    lmn_sheet     *s = draw(f, f->stipple, &how, NULL);
    sides          dots = sides_of(s);
    visit_dots(s, sort_dot, &dots);
    print_message("dots: %zu of the wall, %zu of the ball\n", dots.wall, dots.ball);
    assert_true(dots.wall > 300 && dots.ball > 100);
    assert_int_equal(dots.through, 0);
    assert_int_equal(dots.strayed, 0);
    lmn_sheet_destroy(&s);
    /* Strokes: corners of their outlines lie within half a width of their positions. */
    s = draw(f, f->quill, &how, NULL);
    sides strokes = sides_of(s);
    strokes.pixels *= 1 + 2 / (RADIUS * strokes.pixels);
    size_t paths = 0;
    for (size_t i = 0; i < s->page.item_count; i++) {
        const sheet_item *item = &s->page.items[i];
        uint32_t          part = s->page.groups[item->group].part;
        paths += part ? item->count : 0;
        for (uint32_t k = 0; part && k < item->count; k++)
            for (uint32_t n = 0; n < s->page.paths[item->first + k].count; n++) {
                const float *p = s->page.points[s->page.paths[item->first + k].first + n];
                double       away = hypot((double)p[0] * s->page.pixels_per_mm - SIDE / 2.0,
                                          (double)p[1] * s->page.pixels_per_mm - SIDE / 2.0);
                double       rim = RADIUS * SIDE / (2 * s->views[0].camera.half_height);
                assert_true(part == 1 ? away < rim + 2 : away > rim * cos(3.14159265358979 / ROWS) - 2);
            }
    }
    print_message("%zu strokes\n", paths);
    assert_true(paths > 100 && (size_t)report_number(s, "marks") == paths);
    lmn_sheet_destroy(&s);
}

/* --- files ---------------------------------------------------------------------------------------------- */

static file_data written(const lmn_sheet *s, const char *format)
{
    char      path[] = "/tmp/limner-marks-XXXXXX";
    int       descriptor = mkstemp(path);
    file_data file;
    lmn_error error = {0};
    assert_true(descriptor >= 0);
    close(descriptor);
    assert_int_equal(lmn_sheet_write(s, path, format, NULL, &error), LMN_OK);
    assert_int_equal(file_load(&file, path, &error), LMN_OK);
    unlink(path);
    return file;
}

static size_t count_words(const file_data *file, const char *word)
{
    size_t count = 0;
    for (const char *at = (const char *)file->data; (at = strstr(at, word)); at += strlen(word))
        count++;
    return count;
}

static void test_files(void **state)
{
    const fixture *f = *state;
    lmn_draw_desc  how = front();
    for (int i = 0; i < 2; i++) {
        lmn_sheet *s = draw(f, i ? f->quill : f->stipple, &how, NULL),
                  *again = draw(f, i ? f->quill : f->stipple, &how, NULL);
        file_data svg = written(s, "svg"), same = written(again, "svg"), dxf = written(s, "dxf");
        assert_int_equal(svg.size, same.size);
        assert_memory_equal(svg.data, same.data, svg.size);
        assert_int_equal(count_words(&svg, i ? "class=\"marks" : "class=\"dots"), 2); /* parts */
        assert_int_equal(count_words(&svg, "data-name=\"wall\""), 1);
        assert_int_equal(count_words(&svg, "<image"), 0);
        if (i == 0) {
            assert_int_equal(count_words(&svg, "h0"), (size_t)report_number(s, "dots"));
            assert_int_equal(count_words(&dxf, "\n0\nCIRCLE\n"), (size_t)report_number(s, "dots"));
            assert_int_equal(count_words(&dxf, "\n8\nDOTS - "), (size_t)report_number(s, "dots"));
        } else {
            assert_int_equal(count_words(&dxf, "\n8\nMARKS - "), (size_t)report_number(s, "marks"));
        }
        file_data_release(&svg);
        file_data_release(&same);
        file_data_release(&dxf);
        lmn_sheet_destroy(&s);
        lmn_sheet_destroy(&again);
    }
}

static void one_width(void *user, uint32_t part, double x, double y, double diameter)
{
    (void)part, (void)x, (void)y;
    assert_true(fabs(diameter - *(double *)user) < 1e-3);
}

/* A plotter has one pen for them, and puts each dot on its own. */
static void test_plotter(void **state)
{
    const fixture *f = *state;
    lmn_draw_desc  how = front();
    lmn_sheet_desc desc = LMN_SHEET_DESC_INIT;
    double         wide = 2.2;
    desc.plotter = true;
    lmn_sheet *s = draw(f, f->stipple, &how, &desc);
    assert_true(visit_dots(s, one_width, &wide) > 500);
    assert_int_equal(s->page.path_count, s->page.item_count);
    lmn_sheet_destroy(&s);
    s = draw(f, f->quill, &how, &desc);
    assert_true(s->page.path_count > 100);
    for (size_t i = 0; i < s->page.path_count; i++)
        assert_true(!s->page.paths[i].filled &&
                    fabs((double)s->page.paths[i].width * s->page.pixels_per_mm - 1.3) < 1e-3);
    lmn_sheet_destroy(&s);
}

/* --- paper ---------------------------------------------------------------------------------------------- */

static void test_paper(void **state)
{
    (void)state;
    static const struct {
        const char *key, *value;
        bool        pixels;
    } rows[] = {{"surface.paper_tint", "0.5", true}, {"surface.paper_tint", "0", false},
                {"surface.paper", "#ffeecc", true},  {"finish.ground", "#ffeecc", false},
                {"surface.paper", "auto", false},    {"surface.paper", "none", false},
                {"surface.technique", "toon", true}};
    lmn_look *look = look_of(stipple);
    lmn_error error = {0};
    assert_false(lmn_look_needs_pixels(look));
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        if (lmn_look_set(look, rows[i].key, rows[i].value, &error) != LMN_OK)
            fail_msg("%s", error.message);
        if (lmn_look_needs_pixels(look) != rows[i].pixels)
            fail_msg("%s = %s", rows[i].key, rows[i].value);
    }
    lmn_look_destroy(&look);
}

/* As bright as paper everywhere: nothing is drawn, and no group says otherwise. */
static void test_none(void **state)
{
    const fixture *f = *state;
    lmn_draw_desc  how = front();
    lmn_look      *look = look_of(stipple);
    lmn_error      error = {0};
    how.lenient = true; /* the page stays empty */
    assert_int_equal(lmn_look_set(look, "surface.shadow", "1", &error), LMN_OK);
    assert_int_equal(lmn_look_set(look, "surface.light", "1", &error), LMN_OK);
    assert_int_equal(lmn_look_set(look, "surface.texture", "0", &error), LMN_OK);
    lmn_sheet *s = draw(f, look, &how, NULL);
    assert_int_equal(visit_dots(s, NULL, NULL), 0);
    assert_true(report_number(s, "dots") == 0);
    assert_int_equal(s->page.group_count, 1);
    lmn_sheet_destroy(&s);
    lmn_look_destroy(&look);
}

/* A strip thinner than dots has none, for each would hang over both its sides; finer ones it has. */
static void test_rims(void **state)
{
    (void)state;
    lmn_load_desc load = LMN_LOAD_DESC_INIT;
    lmn_error     error = {0};
    char          path[] = "/tmp/limner-marks-XXXXXX.obj";
    const char   *words = "v -1 -0.005 0\nv 1 -0.005 0\nv 1 0.005 0\nv -1 0.005 0\nf 1 2 3 4\n";
    int           descriptor = mkstemps(path, 4);
    assert_true(descriptor >= 0 && write(descriptor, words, strlen(words)) == (ssize_t)strlen(words));
    close(descriptor);
    fixture f = {NULL, look_of(stipple), NULL};
    assert_int_equal(lmn_scene_create(&f.scene, &error), LMN_OK);
    assert_int_equal(lmn_scene_add_file(f.scene, path, &load, &error), LMN_OK);
    unlink(path);
    for (int fine = 0; fine < 2; fine++) {
        lmn_draw_desc how = front();
        how.lenient = !fine; /* the page stays empty */
        assert_int_equal(lmn_look_set(f.stipple, "surface.diameter", fine ? "0.5px" : "12px", &error), LMN_OK);
        lmn_sheet *s = draw(&f, f.stipple, &how, NULL);
        size_t     count = visit_dots(s, NULL, NULL);
        print_message("%zu dots on a strip\n", count);
        assert_true(fine ? count > 50 : count == 0);
        lmn_sheet_destroy(&s);
    }
    lmn_look_destroy(&f.stipple);
    lmn_scene_destroy(&f.scene);
}

/* --- what stops a drawing ------------------------------------------------------------------------------- */

static bool stop_at(double fraction, const char *stage, void *user)
{
    (void)fraction, (void)stage;
    return (*(int *)user)-- > 0;
}

static void test_cancelled(void **state)
{
    const fixture *f = *state;
    lmn_status     status = LMN_CANCELLED;
    int            calls = 0;
    for (; status != LMN_OK && calls < 10000; calls++) {
        lmn_draw_desc how = front();
        lmn_sheet    *s = NULL;
        lmn_error     error = {0};
        int           left = calls;
        how.progress = stop_at;
        how.progress_user = &left;
        status = lmn_draw_sheet(&s, NULL, f->scene, f->quill, &how, NULL, &error);
        assert_true(status == LMN_OK ? s != NULL : status == LMN_CANCELLED && s == NULL);
        lmn_sheet_destroy(&s);
    }
    assert_in_range(calls, 3, 9999);
}

static void test_out_of_memory(void **state)
{
    const fixture *f = *state;
    for (int i = 0; i < 2; i++) {
        lmn_look  *look = look_of(i ? quill : stipple);
        lmn_error  error = {0};
        lmn_status status = LMN_MEMORY;
        long       n = 1;
        assert_int_equal(lmn_look_set(look, "surface.count", "60", &error), LMN_OK);
        /* Those along the form run out of memory in streamlines_test. */
        if (i)
            assert_int_equal(lmn_look_set(look, "surface.placed", "planes", &error), LMN_OK);
        for (; status != LMN_OK && n < 10000; n++) {
            lmn_draw_desc how = front();
            lmn_sheet    *s = NULL;
            mem_fail_at(n);
            status = lmn_draw_sheet(&s, NULL, f->scene, look, &how, NULL, &error);
            mem_fail_at(0);
            if (!(status == LMN_OK ? s != NULL : status == LMN_MEMORY && s == NULL))
                fail_msg("allocation %ld: status %d, %s", n, (int)status, error.message);
            lmn_sheet_destroy(&s);
        }
        assert_in_range(n, 50, 9999);
        lmn_look_destroy(&look);
    }
}

/* The area of what is filled of a part, mm². */
static double ink_of_part(const lmn_sheet *s, uint32_t part)
{
    const sheet *page = &s->page;
    double       sum = 0;
    for (size_t i = 0; i < page->item_count; i++)
        for (uint32_t k = 0; page->items[i].kind == SHEET_PATH && page->groups[page->items[i].group].part == part &&
                             k < page->items[i].count;
             k++) {
            const sheet_path *path = &page->paths[page->items[i].first + k];
            double            area = 0;
            for (uint32_t n = 0; n < path->count; n++) {
                const float *a = page->points[path->first + n], *b = page->points[path->first + (n + 1) % path->count];
                area += 0.5 * ((double)a[0] * (double)b[1] - (double)a[1] * (double)b[0]);
            }
            sum += fabs(area);
        }
    return sum;
}

/* Marks are those of what a section leaves: before the wall stands a half ball, whose cut face has none; what is spared
 * keeps its own. */
static void test_section(void **state)
{
    const fixture *f = *state;
    lmn_draw_desc  how = front();
    for (int i = 0; i < 2; i++) {
        lmn_look *look = look_of(i ? quill : stipple);
        lmn_error error = {0};
        uint64_t  ball[3], wall[3];
        double    ink[3];
        for (int k = 0; k < 3; k++) {
            assert_int_equal(lmn_look_set(look, "scene.cut", k ? "z=-0.1" : "", &error), LMN_OK);
            assert_int_equal(lmn_look_set(look, "scene.cut_keep", k == 2 ? "ball" : "", &error), LMN_OK);
            lmn_sheet *s = draw(f, look, &how, NULL);
            ball[k] = s->part_marks[0];
            wall[k] = s->part_marks[1];
            ink[k] = ink_of_part(s, 2);
            lmn_sheet_destroy(&s);
        }
        print_message("ink of the wall %.3f %.3f\n", ink[0], ink[1]);
        print_message("ball %d %d %d, wall %d %d %d\n", (int)ball[0], (int)ball[1], (int)ball[2], (int)wall[0],
                      (int)wall[1], (int)wall[2]);
        assert_true(ball[0] > 50 && wall[0] > 50);
        assert_int_equal(ball[1], 0);
        assert_true(ball[2] == ball[0] && wall[2] == wall[0]);
        assert_true(i ? ink[1] > ink[0] && ink[0] > 1
                      : wall[1] >= wall[0]); /* what hides a stroke may make two of it */
        lmn_look_destroy(&look);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_dots),     cmocka_unit_test(test_behind),  cmocka_unit_test(test_section),
        cmocka_unit_test(test_files),         cmocka_unit_test(test_plotter), cmocka_unit_test(test_paper),
        cmocka_unit_test(test_none),          cmocka_unit_test(test_rims),    cmocka_unit_test(test_cancelled),
        cmocka_unit_test(test_out_of_memory),
    };
    return cmocka_run_group_tests_name("vector_marks", tests, set_up, tear_down);
}
