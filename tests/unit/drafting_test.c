/* Sheets as draughtsmen make them: widths of lines, centre lines, sections, details and auxiliary views, against what
 * is known of the models. */
#define _GNU_SOURCE /* memmem */
#include <math.h>

#include "csg_support.h"

#include "export/export.h"
#include "limner/limner.h"
#include "vector/vector_private.h"

/* A plate of 80 by 60 by 10 with a sleeve of 15 and a bore of 8 in its middle, six bores of 3 around it at 22, and one
 * of 4 in a corner, not through. Millimetres. */
#define AT(x, y, z)      "multmatrix([[1,0,0," #x "],[0,1,0," #y "],[0,0,1," #z "],[0,0,0,1]]) "
#define BORE(x, y, z, r) AT(x, y, z) "{ cylinder($fn=48, h=50, r1=" #r ", r2=" #r "); }\n"
static const char plate[] =
    "difference() { union() { " AT(-40, -30, 0) "{ cube(size=[80,60,10], center=false); }\n"
                                                "cylinder($fn=96, h=30, r1=15, r2=15); }\n" BORE(0, 0, -1, 8)
                                                    BORE(22, 0, -1, 3) BORE(-22, 0, -1, 3) BORE(11, 19.05255888, -1, 3)
                                                        BORE(-11, 19.05255888, -1, 3) BORE(11, -19.05255888, -1, 3)
                                                            BORE(-11, -19.05255888, -1, 3) BORE(34, 24, 6, 4) "}\n";

typedef struct fixture {
    lmn_scene *scene;
    lmn_look  *look;
} fixture;

static fixture f;

static int set_up(void **state)
{
    lmn_error error = {0};
    (void)state;
    f.scene = load_text(plate);
    return lmn_look_load(&f.look, "technical", &error) != LMN_OK;
}

static int tear_down(void **state)
{
    lmn_look_destroy(&f.look);
    lmn_scene_destroy(&f.scene);
    return remove_temp_folder(state);
}

static lmn_sheet_desc usual(void)
{
    lmn_sheet_desc d = LMN_SHEET_DESC_INIT;
    d.views = "front,top";
    d.page = "A3";
    d.scale = "1:1";
    d.line_group = 0.5;
    d.smooth = 0;
    return d;
}

static lmn_sheet *draw(const lmn_sheet_desc *desc)
{
    lmn_draw_desc how = LMN_DRAW_DESC_INIT;
    lmn_sheet    *s = NULL;
    lmn_error     error = {0};
    if (lmn_draw_sheet(&s, NULL, f.scene, f.look, &how, desc, &error) != LMN_OK)
        fail_msg("%s", error.message);
    return s;
}

/* Is an item in a group with this name, or of this class, or in one of those in it? */
static bool is_in(const sheet *s, const sheet_item *item, const char *name)
{
    for (int32_t at = (int32_t)item->group; at >= 0; at = s->groups[at].parent)
        if ((s->groups[at].name && strcmp(s->groups[at].name, name) == 0) ||
            (s->groups[at].css_class && strstr(s->groups[at].css_class, name)))
            return true;
    return false;
}

static const vector_view *view_named(const lmn_sheet *s, const char *name)
{
    for (size_t i = 0; i < s->view_count; i++)
        if (strcmp(s->views[i].name, name) == 0)
            return &s->views[i];
    fail_msg("no view %s", name);
    return NULL;
}

/* Where a position of the model is on the sheet, by the camera alone. */
static void project(const vector_view *v, double x, double y, double z, double out[2])
{
    const mat4  *m = &v->camera.view;
    const double scale = v->box[3] / (2 * v->camera.half_height);
    for (int k = 0; k < 2; k++) {
        double eye = m->m[k] * x + m->m[4 + k] * y + m->m[8 + k] * z + m->m[12 + k];
        out[k] = v->box[k] + v->box[2 + k] / 2 + (k ? -scale : scale) * eye;
    }
}

typedef void (*visit_fn)(const sheet *s, const sheet_item *item, const sheet_path *path, void *user);

static size_t each_path(const lmn_sheet *s, const char *in, const char *also, visit_fn visit, void *user)
{
    size_t count = 0;
    for (size_t i = 0; i < s->page.item_count; i++) {
        const sheet_item *item = &s->page.items[i];
        if (item->kind != SHEET_PATH || !is_in(&s->page, item, in) || (also && !is_in(&s->page, item, also)))
            continue;
        for (uint32_t k = 0; k < item->count; k++, count++)
            if (visit)
                visit(&s->page, item, &s->page.paths[item->first + k], user);
    }
    return count;
}

/* --- widths --------------------------------------------------------------------------------------------- */

static void check_width(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    const double wide = *(const double *)user;
    bool         is_wide = is_in(s, item, "visible") && !is_in(s, item, "material") && !is_in(s, item, "drawn");
    if (path->filled)
        return;
    if (fabs((double)path->width - (is_wide ? wide : wide / 2)) > 1e-6)
        fail_msg("%s is %g mm wide in the group of %g", s->groups[item->group].name, (double)path->width, wide);
    if (is_in(s, item, "hidden") && path->dash_count == 2) { /* 12 and 3 widths, stretched to end at corners */
        const float *dash = s->dashes + path->first_dash;
        assert_true(fabs((double)(dash[0] / dash[1]) - 4) < 0.2);
    }
}

static size_t count_text(const export_bytes *b, const char *words)
{
    size_t count = 0, length = strlen(words);
    for (size_t i = 0; i + length <= b->size; i++)
        count += memcmp(b->data + i, words, length) == 0;
    return count;
}

/* What the files say. */
static void check_files(const lmn_sheet *s, double wide)
{
    export_bytes svg, dxf;
    lmn_error    error = {0};
    char         words[64];
    assert_int_equal(export_svg(&svg, &s->page, &error), LMN_OK);
    assert_int_equal(export_dxf(&dxf, &s->page, &error), LMN_OK);
    size_t all = count_text(&svg, "stroke-width:"), known = 0;
    for (int k = 1; k <= 2; k++) {
        snprintf(words, sizeof words, "%g", wide / k);
        char style[80];
        snprintf(style, sizeof style, "stroke-width:%s", words + (words[0] == '0'));
        for (int ends = 0; ends < 2; ends++) {
            char whole[96];
            snprintf(whole, sizeof whole, "%s%c", style, ends ? ';' : '}');
            known += count_text(&svg, whole);
        }
        snprintf(words, sizeof words, "370\n%.0f\n", floor(wide / k * 100 + 0.5));
        assert_true(count_text(&dxf, words) > 0);
    }
    assert_true(all > 0 && known == all);
    mem_free(svg.data);
    mem_free(dxf.data);
}

static void test_widths(void **state)
{
    static const double groups[] = {0.25, 0.35, 0.5, 0.7};
    (void)state;
    for (size_t i = 0; i < 4; i++) {
        lmn_sheet_desc d = usual();
        d.line_group = groups[i];
        d.centre_lines = true;
        d.sections = "front";
        lmn_sheet *s = draw(&d);
        double     wide = groups[i];
        assert_true(each_path(s, "view-front", "hidden", check_width, &wide) >= 1);
        size_t count = each_path(s, "view-top", NULL, check_width, &wide);
        count += each_path(s, "view-section-A", NULL, check_width, &wide);
        print_message("%g mm: %zu lines\n", wide, count);
        assert_true(count > 30);
        check_files(s, wide);
        lmn_sheet_destroy(&s);
    }
}

#ifdef LIMNER_HAVE_STEP
/* Edges of a file over which faces go on smoothly are narrow. */
static void test_tangent_edges(void **state)
{
    lmn_scene *kept = f.scene;
    double     wide = 0.5;
    (void)state;
    f.scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/bracket.step");
    lmn_sheet_desc d = usual();
    lmn_sheet     *s = draw(&d);
    assert_true(each_path(s, "view-top", "drawn", check_width, &wide) >= 1);
    assert_true(each_path(s, "view-top", NULL, check_width, &wide) >= 3);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&f.scene);
    f.scene = kept;
}
#endif

#ifdef LIMNER_HAVE_STEP
typedef struct near_line {
    double at[2], least;
} near_line;

static void measure_line(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    near_line *n = user;
    (void)item;
    for (uint32_t i = 0; i + (path->closed ? 0 : 1) < path->count; i++) {
        const float *p = s->points[path->first + i], *q = s->points[path->first + (i + 1) % path->count];
        double       x = (double)q[0] - (double)p[0], y = (double)q[1] - (double)p[1], square = x * x + y * y;
        double       t = square > 0 ? ((n->at[0] - (double)p[0]) * x + (n->at[1] - (double)p[1]) * y) / square : 0;
        t = fmin(fmax(t, 0), 1);
        n->least = fmin(n->least, hypot((double)p[0] + t * x - n->at[0], (double)p[1] + t * y - n->at[1]));
    }
}

/* The rim of a cut face goes on along a fillet, whose faces are seen exactly from the side. */
static void test_rims_are_whole(void **state)
{
    lmn_scene *kept = f.scene;
    (void)state;
    f.scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/bracket.step");
    for (int scale = 1; scale <= 5; scale += 2) {
        lmn_sheet_desc d = usual();
        char           text[16];
        snprintf(text, sizeof text, "%d:1", scale);
        d.scale = text;
        d.sections = "front";
        d.views = "front,right";
        lmn_sheet *s = draw(&d);
        double     worst = 0;
        for (int i = 0; i <= 400; i++) {
            near_line n = {.least = INFINITY};
            double    angle = 3.14159265358979323846 * (1 + i / 800.0);
            project(view_named(s, "section-A"), 12 + 4 * cos(angle), 15, 12 + 4 * sin(angle), n.at);
            each_path(s, "view-section-A", "visible", measure_line, &n);
            worst = fmax(worst, n.least);
        }
        print_message("%s: %.3f mm\n", text, worst);
        assert_true(worst < 0.05 * scale);
        lmn_sheet_destroy(&s);
    }
    lmn_scene_destroy(&f.scene);
    f.scene = kept;
}

/* Sections lie beside views, whatever fits by little only. */
static void test_two_sections_beside(void **state)
{
    lmn_scene     *kept = f.scene;
    lmn_sheet_desc d = usual();
    (void)state;
    f.scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/bracket.step");
    d.scale = NULL;
    d.page = "A4-landscape";
    d.sections = "front;right";
    d.views = "front,right";
    lmn_sheet *s = draw(&d);
    for (size_t i = 0; i < s->view_count; i++)
        for (size_t k = 0; k < i; k++) {
            const double *a = s->views[i].box, *b = s->views[k].box;
            assert_false(a[0] < b[0] + b[2] - 0.1 && b[0] < a[0] + a[2] - 0.1 && a[1] < b[1] + b[3] - 0.1 &&
                         b[1] < a[1] + a[3] - 0.1);
        }
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&f.scene);
    f.scene = kept;
}
#endif

/* --- centre lines --------------------------------------------------------------------------------------- */

typedef struct wanted_line {
    double ends[2][2];
    size_t found;
} wanted_line;

static void match_line(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    wanted_line *w = user;
    (void)item;
    const float *a = s->points[path->first], *b = s->points[path->first + path->count - 1];
    for (int turned = 0; turned < 2; turned++) {
        const double *p = w->ends[turned], *q = w->ends[1 - turned];
        double        off =
            fmax(hypot((double)a[0] - p[0], (double)a[1] - p[1]), hypot((double)b[0] - q[0], (double)b[1] - q[1]));
        w->found += off < 2e-3;
    }
}

/* One centre line from one position of the model to another, run on by ten widths. */
static void assert_centre(const lmn_sheet *s, const vector_view *v, const char *group, const double from[3],
                          const double to[3])
{
    wanted_line w = {.found = 0};
    double      a[2], b[2];
    project(v, from[0], from[1], from[2], a);
    project(v, to[0], to[1], to[2], b);
    double length = hypot(b[0] - a[0], b[1] - a[1]);
    for (int k = 0; k < 2; k++) {
        w.ends[0][k] = a[k] - 2.5 * (b[k] - a[k]) / length;
        w.ends[1][k] = b[k] + 2.5 * (b[k] - a[k]) / length;
    }
    each_path(s, group, "centre", match_line, &w);
    if (w.found != 1)
        fail_msg("%zu centre lines from %g %g %g to %g %g %g", w.found, from[0], from[1], from[2], to[0], to[1], to[2]);
}

static void find_circle(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    double *c = user; /* x, y, radius; how many; how far facets may be off */
    double  most = 0;
    (void)item;
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = s->points[path->first + i];
        most = fmax(most, fabs(hypot((double)p[0] - c[0], (double)p[1] - c[1]) - c[2]));
    }
    c[3] += path->closed && path->count > 8 && most < c[4];
}

static void test_centre_lines(void **state)
{
    lmn_sheet_desc d = usual();
    (void)state;
    d.centre_lines = true;
    lmn_sheet         *s = draw(&d);
    const vector_view *top = view_named(s, "top"), *front = view_named(s, "front");
    double             circle[5] = {0, 0, 22, 0, 1e-3};
    /* The cross of the sleeve, which is one with the marks of the two bores beside it on the same line. */
    assert_centre(s, top, "view-top", (double[]){0, -15, 0}, (double[]){0, 15, 0});
    assert_centre(s, top, "view-top", (double[]){-25, 0, 0}, (double[]){25, 0, 0});
    assert_centre(s, top, "view-top", (double[]){30, 24, 0}, (double[]){38, 24, 0});
    assert_centre(s, top, "view-top", (double[]){34, 20, 0}, (double[]){34, 28, 0});
    for (int i = 0; i < 6; i++) { /* across the pitch circle */
        double angle = i * 3.14159265358979323846 / 3, x = cos(angle), y = sin(angle);
        if (i % 3)
            assert_centre(s, top, "view-top", (double[]){19 * x, 19 * y, 0}, (double[]){25 * x, 25 * y, 0});
    }
    project(top, 0, 0, 0, circle);
    each_path(s, "view-top", "centre", find_circle, circle);
    assert_int_equal((int)circle[3], 1);
    assert_int_equal(each_path(s, "view-top", "centre", NULL, NULL), 2 + 2 + 4 + 1);
    /* From the front: axes at −22, −11, 0, 11, 22, and the blind one as deep as it is. */
    for (int i = -2; i <= 2; i++)
        assert_centre(s, front, "view-front", (double[]){11 * i, 0, 0}, (double[]){11 * i, 0, i ? 10 : 30});
    assert_centre(s, front, "view-front", (double[]){34, 0, 6}, (double[]){34, 0, 10});
    assert_int_equal(each_path(s, "view-front", "centre", NULL, NULL), 6);
    lmn_sheet_destroy(&s);
    d.centre_lines = false;
    s = draw(&d);
    assert_int_equal(each_path(s, "view-top", "centre", NULL, NULL), 0);
    lmn_sheet_destroy(&s);
}

/* --- sections ------------------------------------------------------------------------------------------- */

typedef struct reach {
    double low[2], high[2];
    double upright_at; /* lines along this x of the sheet */
    double length;     /* of them */
} reach;

static void measure(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    reach *r = user;
    (void)item;
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = s->points[path->first + i];
        for (int k = 0; k < 2; k++) {
            r->low[k] = fmin(r->low[k], (double)p[k]);
            r->high[k] = fmax(r->high[k], (double)p[k]);
        }
        if (i && fabs((double)p[0] - r->upright_at) < 0.01 && fabs((double)p[-2] - r->upright_at) < 0.01)
            r->length += fabs((double)p[1] - (double)p[-1]);
    }
}

/* The same of lines from left to right. */
static void measure_lying(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    reach *r = user;
    (void)item;
    for (uint32_t i = 1; i < path->count; i++) {
        const float *p = s->points[path->first + i];
        if (fabs((double)p[1] - r->upright_at) < 0.01 && fabs((double)p[-1] - r->upright_at) < 0.01)
            r->length += fabs((double)p[0] - (double)p[-2]);
    }
}

static reach reach_of(const lmn_sheet *s, const char *in, const char *also, double upright_at)
{
    reach r = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, upright_at, 0};
    each_path(s, in, also, measure, &r);
    return r;
}

/* The trace on the view from above: the path of this many points. */
static void find_trace(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    const sheet_path **out = user;
    (void)s;
    (void)item;
    if (path->dash_count == 4)
        *out = path;
}

static void test_section_in_steps(void **state)
{
    const sheet_path *trace = NULL;
    double            at[2], corner[2];
    lmn_sheet_desc    d = usual();
    (void)state;
    d.views = "top";
    d.sections = "front@0,28,24"; /* through the middle, then through the bore in the corner */
    lmn_sheet         *s = draw(&d);
    const vector_view *top = view_named(s, "top"), *section = view_named(s, "section-A");
    assert_false(section->apart); /* it takes the place of the front view: in line with the top view */
    assert_true(fabs(section->box[0] + section->box[2] / 2 - top->box[0] - top->box[2] / 2) < 0.2);
    each_path(s, "marks of views", NULL, find_trace, &trace);
    assert_non_null(trace);
    assert_int_equal(trace->count, 4);
    static const double corners[4][2] = {{0, 0}, {28, 0}, {28, 24}, {0, 24}};
    for (uint32_t i = 0; i < 4; i++) {
        const float *p = s->page.points[trace->first + i];
        project(top, corners[i][0], corners[i][1], 0, at);
        assert_true(fabs((double)p[1] - at[1]) < 1e-3 && (i == 0 || i == 3 || fabs((double)p[0] - at[0]) < 1e-3));
    }
    /* Hatched is what is cut: not the bores, and the floor below the blind one. */
    project(section, -40, 0, 0, corner);
    reach all = reach_of(s, "view-section-A", "hatch", 0);
    assert_true(fabs(all.low[0] - corner[0]) < 0.5 && fabs(all.high[0] - corner[0] - 80) < 0.5);
    project(section, 34, 0, 8, at); /* in the middle of the blind bore */
    for (size_t i = 0; i < s->page.item_count; i++) {
        const sheet_item *item = &s->page.items[i];
        for (uint32_t k = 0; k < item->count && item->kind == SHEET_PATH && is_in(&s->page, item, "hatch"); k++) {
            const sheet_path *path = &s->page.paths[item->first + k];
            for (int n = 0; n <= 20; n++) {
                const float *a = s->page.points[path->first], *b = s->page.points[path->first + 1];
                double       x = (double)(a[0] + (b[0] - a[0]) * (float)n / 20),
                       y = (double)(a[1] + (b[1] - a[1]) * (float)n / 20);
                assert_false(fabs(x - at[0]) < 3.8 && fabs(y - at[1]) < 1.8);
            }
        }
    }
    /* No edge where the plane turns, and the edges that are there are drawn. */
    project(section, 28, 0, 0, at);
    reach turn = reach_of(s, "view-section-A", "visible", at[0]);
    project(section, 38, 0, 0, at);
    reach wall = reach_of(s, "view-section-A", "visible", at[0]);
    print_message("at the turn %g mm, at the wall of the bore %g mm\n", turn.length, wall.length);
    assert_true(turn.length == 0 && fabs(wall.length - 4) < 0.05);
    lmn_sheet_destroy(&s);
}

/* Entities of DXF on layers whose names begin so, that have a line type of their own; how many of them have one whose
 * name begins so. */
static void count_line_types(const char *dxf, const char *layer, const char *name, size_t out[2])
{
    static const char head[] = "\nAcDbEntity\n8\n";
    for (const char *at = dxf; (at = strstr(at, head)) != NULL;) {
        at += sizeof head - 1;
        const char *type = strchr(at, '\n');
        if (strncmp(at, layer, strlen(layer)) != 0 || strncmp(type, "\n6\n", 3) != 0)
            continue;
        out[0]++;
        out[1] += strncmp(type + 3, name, strlen(name)) == 0;
    }
}

/* Centre lines and the traces of cutting planes are long-dashed and dotted in DXF, too: 24, 3, 0.5 and 3 widths, and
 * hidden lines are dashed beside them. */
static void test_chain_lines_in_dxf(void **state)
{
    export_bytes   bytes;
    lmn_error      error = {0};
    lmn_sheet_desc d = usual();
    size_t         centres[2] = {0}, traces[2] = {0};
    bool           hidden;
    (void)state;
    d.centre_lines = true;
    d.sections = "front@-19.05255888,-5.5,0,16.5,19.05255888";
    lmn_sheet *s = draw(&d);
    assert_int_equal(export_dxf(&bytes, &s->page, &error), LMN_OK);
    const char *dxf = (const char *)bytes.data;
    count_line_types(dxf, "CENTRE", "CENTER", centres);
    count_line_types(dxf, "VIEW-MARK", "CENTER", traces);
    hidden = strstr(dxf, "\n6\nDASHEDTINY\n") != NULL;
    print_message("%zu of %zu centre lines, %zu of %zu traces, hidden lines dashed: %d\n", centres[1], centres[0],
                  traces[1], traces[0], hidden);
    assert_true(centres[0] > 0 && centres[1] == centres[0]);
    assert_true(traces[0] > 0 && traces[1] == traces[0] && hidden);
    const char *type = strstr(dxf, "\n2\nCENTERTINY\n");
    double      lengths[4], period;
    assert_non_null(type);
    assert_int_equal(sscanf(strstr(type, "\n73\n"),
                            "\n73\n4\n40\n%lf\n49\n%lf\n74\n0\n49\n%lf\n74\n0\n49\n%lf\n74\n0\n49\n%lf", &period,
                            &lengths[0], &lengths[1], &lengths[2], &lengths[3]),
                     5);
    assert_true(fabs(lengths[1] / lengths[0] + 3 / 24.0) < 1e-3 && fabs(lengths[2] / lengths[0] - 0.5 / 24) < 1e-3);
    assert_true(fabs(lengths[3] - lengths[1]) < 1e-3);
    assert_true(fabs(period - lengths[0] + lengths[1] - lengths[2] + lengths[3]) < 1e-3);
    mem_free(bytes.data);
    lmn_sheet_destroy(&s);
}

static void test_half_section(void **state)
{
    double         at[2];
    lmn_sheet_desc d = usual();
    (void)state;
    d.views = "top";
    d.sections = "front@half";
    lmn_sheet         *s = draw(&d);
    const vector_view *section = view_named(s, "section-A");
    project(section, 0, 0, 0, at);
    reach hatch = reach_of(s, "view-section-A", "hatch", 0), middle = reach_of(s, "view-section-A", "visible", at[0]);
    assert_true(hatch.low[0] > at[0] + 7.5 && hatch.high[0] < at[0] + 40.5); /* right of the bore alone */
    assert_true(middle.length == 0);
    lmn_sheet_destroy(&s);
}

/* Of many bodies whose cut faces have other corners than what they cut: no line where the plane turns, either. */
static void test_half_assembly(void **state)
{
    double         at[2];
    lmn_sheet_desc d = usual();
    lmn_scene     *kept = f.scene;
    (void)state;
    f.scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/pump.glb");
    d.views = "top";
    d.sections = "front@half";
    lmn_sheet *s = draw(&d);
    project(view_named(s, "section-A"), 0, 0, 0, at);
    reach middle = reach_of(s, "view-section-A", "visible", at[0]);
    print_message("where the plane turns there are %.2f mm of lines\n", middle.length);
    assert_true(middle.length < 0.5);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&f.scene);
    f.scene = kept;
}

/* Where lines are farthest to the left of a position, in rows of half a millimetre. */
enum { ROWS = 240 };
typedef struct left_rim {
    double origin[2];
    double at[ROWS];
} left_rim;

static void find_rim(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    left_rim *rim = user;
    (void)item;
    for (uint32_t i = 1; i < path->count; i++)
        for (int row = 0; row < ROWS; row++) {
            const float *a = s->points[path->first + i - 1], *b = a + 2;
            double       y = rim->origin[1] + 0.5 * (row - ROWS / 2) + 0.123, rise = (double)(b[1] - a[1]);
            if (((double)a[1] > y) == ((double)b[1] > y))
                continue;
            double x = (double)a[0] + (y - (double)a[1]) / rise * (double)(b[0] - a[0]) - rim->origin[0];
            rim->at[row] = fmin(rim->at[row], x);
        }
}

static left_rim rim_of(const lmn_sheet *s, const char *view)
{
    left_rim    rim;
    const char *group = strcmp(view, "front") == 0 ? "view-front" : "view-section-A";
    project(view_named(s, view), 0, 0, 0, rim.origin);
    for (int row = 0; row < ROWS; row++)
        rim.at[row] = INFINITY;
    each_path(s, group, "visible", find_rim, &rim);
    return rim;
}

/* The half of a section that is seen from outside has the outline that the view has, without a gap. */
static void test_half_has_its_outline(void **state)
{
    lmn_sheet_desc d = usual();
    lmn_scene     *kept = f.scene;
    int            rows = 0, gaps = 0;
    (void)state;
    f.scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/pump.glb");
    d.views = "front";
    d.sections = "front@half";
    lmn_sheet *s = draw(&d);
    left_rim   view = rim_of(s, "front"), section = rim_of(s, "section-A");
    for (int row = 0; row < ROWS; row++) {
        rows += isfinite(view.at[row]);
        gaps += isfinite(view.at[row]) && !(fabs(view.at[row] - section.at[row]) < 0.05);
    }
    print_message("%d of %d rows have another outline\n", gaps, rows);
    assert_true(rows > 200 && gaps == 0);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&f.scene);
    f.scene = kept;
}

/* The middle of the line of text that says this in the frame, for the n-th time; false: it does not. */
static bool find_words(const sheet *s, const char *words, size_t n, double out[2])
{
    for (size_t i = 0; i < s->item_count; i++) {
        const sheet_item *item = &s->items[i];
        if (item->kind != SHEET_TEXT || !is_in(s, item, "frame") || strcmp(item->text, words) != 0 || n-- > 0)
            continue;
        out[0] = item->box[0];
        out[1] = item->box[1] - 0.36 * item->box[3];
        return true;
    }
    return false;
}

/* ISO 5457: A3 has 8 fields by 6 and A4 has 6 by 4, on all sides and on two; 50 mm long from the middle of the paper
 * on. */
static void test_grid_reference(void **state)
{
    static const char *const pages[2] = {"A3", "A4"};
    static const double      sizes[2][2] = {{420, 297}, {210, 297}};
    static const int         fields[2][2] = {{8, 6}, {4, 6}};
    (void)state;
    for (int page = 0; page < 2; page++) {
        lmn_sheet_desc d = usual();
        double         at[2], next[2];
        char           words[2][3] = {"", ""};
        d.page = pages[page];
        d.frame = true;
        d.scale = page ? "1:2" : "1:1";
        lmn_sheet *s = draw(&d);
        for (int side = 0; side < 2; side++) {
            for (int i = 0; i < fields[page][side]; i++) {
                snprintf(words[side], 3, "%c", side ? 'A' + i : '1' + i);
                for (size_t n = 0; n < (page ? 1 : 2); n++)
                    assert_true(find_words(&s->page, words[side], n, at));
                if (page)
                    assert_false(find_words(&s->page, words[side], 1, at));
            }
            snprintf(words[side], 3, "%c", side ? 'A' + fields[page][side] : '1' + fields[page][side]);
            assert_false(find_words(&s->page, words[side], 0, at));
            /* The fields around the middle of the paper are 25 mm beside it. */
            snprintf(words[side], 3, "%c", (side ? 'A' : '1') + fields[page][side] / 2 - 1);
            assert_true(find_words(&s->page, words[side], 0, at));
            snprintf(words[side], 3, "%c", (side ? 'A' : '1') + fields[page][side] / 2);
            assert_true(find_words(&s->page, words[side], 0, next));
            assert_true(fabs(at[side] - (sizes[page][side] / 2 - 25)) < 1e-3);
            assert_true(fabs(next[side] - (sizes[page][side] / 2 + 25)) < 1e-3);
            assert_true(fabs(at[!side] - (side ? sizes[page][0] - 7.5 : 7.5)) < 1e-3); /* within the border of 5 mm */
        }
        lmn_sheet_destroy(&s);
    }
}

/* What ISO 128-2 draws where two kinds of lines lie on each other is the one of the cutting plane. */
static void test_axis_in_cutting_plane(void **state)
{
    double         at[2];
    lmn_sheet_desc d = usual();
    (void)state;
    d.sections = "front";
    d.centre_lines = true;
    lmn_sheet *s = draw(&d);
    project(view_named(s, "top"), 0, 0, 0, at);
    reach lying = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, at[1], 0}, standing = lying;
    standing.upright_at = at[0];
    each_path(s, "view-top", "centre", measure_lying, &lying);
    each_path(s, "view-top", "centre", measure, &standing);
    print_message("in the cutting plane %.2f mm of centre lines, across it %.2f\n", lying.length, standing.length);
    assert_true(lying.length == 0 && standing.length > 30);
    lmn_sheet_destroy(&s);
    d.sections = NULL;
    s = draw(&d);
    project(view_named(s, "top"), 0, 0, 0, at);
    lying.length = 0;
    lying.upright_at = at[1];
    each_path(s, "view-top", "centre", measure_lying, &lying);
    assert_true(lying.length > 30);
    lmn_sheet_destroy(&s);
}

static void measure_closed(const sheet *s, const sheet_item *item, const sheet_path *path, void *user)
{
    if (path->closed)
        measure(s, item, path, user);
}

/* Turned in its place: as wide as the plate is deep, its middle where the plane is. */
static void test_revolved(void **state)
{
    double         at[2];
    lmn_sheet_desc d = usual();
    (void)state;
    d.sections = "front@revolved,35";
    lmn_sheet *s = draw(&d);
    reach      hatch = reach_of(s, "view-front", "hatch", 0), r = {{INFINITY, INFINITY}, {-INFINITY, -INFINITY}, 0, 0};
    each_path(s, "view-front", "revolved", measure_closed, &r);
    assert_true(hatch.low[0] > r.low[0] - 1e-3 && hatch.high[0] < r.high[0] + 1e-3 && hatch.low[1] > r.low[1] - 1e-3 &&
                hatch.high[1] < r.high[1] + 1e-3 && hatch.high[0] - hatch.low[0] > 55);
    project(view_named(s, "front"), 35, 0, 5, at);
    print_message("%.4f by %.4f mm, off by %.1e, %.1e\n", r.high[0] - r.low[0], r.high[1] - r.low[1],
                  (r.high[0] + r.low[0]) / 2 - at[0], (r.high[1] + r.low[1]) / 2 - at[1]);
    assert_true(fabs(r.high[0] - r.low[0] - 60) < 1e-3 && fabs(r.high[1] - r.low[1] - 10) < 1e-3);
    assert_true(fabs((r.high[0] + r.low[0]) / 2 - at[0]) < 1e-3 && fabs((r.high[1] + r.low[1]) / 2 - at[1]) < 1e-3);
    assert_int_equal(s->view_count, 2);
    lmn_sheet_destroy(&s);
}

static void test_apart(void **state)
{
    lmn_sheet_desc d = usual();
    (void)state;
    d.sections = "front@25%"; /* the front view is there, too */
    lmn_sheet         *s = draw(&d);
    const vector_view *front = view_named(s, "front"), *section = view_named(s, "section-A");
    assert_true(section->apart);
    assert_true(section->box[0] >= front->box[0] + front->box[2] || section->box[1] >= front->box[1] + front->box[3]);
    assert_int_equal(lmn_sheet_warning_count(s), 0);
    assert_true(each_path(s, "view-section-A", "hatch", NULL, NULL) > 10); /* what is behind the plane is there */
    lmn_sheet_destroy(&s);
    d.views = "iso"; /* none shows where it is */
    s = draw(&d);
    assert_int_equal(lmn_sheet_warning_count(s), 1);
    lmn_sheet_destroy(&s);
}

/* --- details and auxiliary views ------------------------------------------------------------------------ */

static void test_detail(void **state)
{
    double         middle[2], most = 0;
    lmn_sheet_desc d = usual();
    (void)state;
    d.details = "top@34,24,10/7/5:1";
    lmn_sheet         *s = draw(&d);
    const vector_view *v = view_named(s, "detail-A"), *top = view_named(s, "top");
    project(v, 34, 24, 10, middle);
    for (size_t i = 0; i < s->page.item_count; i++) {
        const sheet_item *item = &s->page.items[i];
        for (uint32_t k = 0; k < item->count && item->kind == SHEET_PATH && is_in(&s->page, item, "view-detail-A"); k++)
            for (uint32_t n = 0; n < s->page.paths[item->first + k].count; n++) {
                const float *p = s->page.points[s->page.paths[item->first + k].first + n];
                most = fmax(most, hypot((double)p[0] - middle[0], (double)p[1] - middle[1]));
            }
    }
    print_message("the detail reaches %.6f mm\n", most);
    assert_true(fabs(most - 35) < 1e-3); /* the plate's edges reach its rim, and nothing goes beyond */
    double rim[5] = {0, 0, 20, 0, 0.05}, around[5] = {0, 0, 7, 0, 1e-3};
    project(v, 34, 24, 10, rim);
    each_path(s, "view-detail-A", "visible", find_circle, rim);
    project(top, 34, 24, 10, around);
    each_path(s, "marks of views", NULL, find_circle, around);
    assert_true(rim[3] >= 1 && (int)around[3] == 1); /* 4 mm five times as large, and the circle around it */
    bool said = false;
    for (size_t i = 0; i < s->page.item_count; i++)
        said = said || (s->page.items[i].text && strcmp(s->page.items[i].text, "A (5:1)") == 0);
    assert_true(said);
    lmn_sheet_destroy(&s);
}

/* A block that leans by 30 degrees: its bore is round where the view is along it, and nowhere else. */
static void test_auxiliary(void **state)
{
    lmn_scene *kept = f.scene;
    double     at[5] = {0, 0, 6, 0, 0.01}, off[5] = {0, 0, 6, 0, 0.01};
    (void)state;
    f.scene = load_text(
        "multmatrix([[0.8660254037844387,0,0.5,0],[0,1,0,0],[-0.5,0,0.8660254037844387,0],[0,0,0,1]]) {\n"
        "difference() { cube(size=[40,30,20], center=true); cylinder($fn=64, h=60, r1=6, r2=6, center=true); } }\n");
    lmn_sheet_desc d = usual();
    d.auxiliary = "0.5,0,0.8660254037844387;face@7,10,7";
    lmn_sheet *s = draw(&d);
    for (int i = 0; i < 12; i++) /* straight at the top, by a place on it: the same view */
        assert_true(fabs(view_named(s, "auxiliary-B")->camera.view.m[i] -
                         view_named(s, "auxiliary-A")->camera.view.m[i]) < 1e-6);
    project(view_named(s, "auxiliary-A"), 0, 0, 0, at);
    each_path(s, "view-auxiliary-A", NULL, find_circle, at);
    project(view_named(s, "top"), 0, 0, 0, off);
    each_path(s, "view-top", NULL, find_circle, off);
    assert_true(at[3] >= 1 && off[3] == 0);
    assert_int_equal(lmn_sheet_warning_count(s), 0); /* the front view has the arrow */
    assert_true(each_path(s, "marks of views", NULL, NULL, NULL) == 4);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&f.scene);
    f.scene = kept;
}

/* --- words ---------------------------------------------------------------------------------------------- */

static void test_title_block(void **state)
{
    static const char *const wanted[] = {"A. Writer", "4711", "Works", "Plate",     "in steel",
                                         "1:1",       "mm",   "A3",    "Created by"};
    lmn_sheet_desc           d = usual();
    (void)state;
    d.frame = true;
    d.title = "Plate";
    d.fields = "creator=A. Writer;number=4711;owner=Works;supplement=in steel";
    lmn_sheet *s = draw(&d);
    for (size_t i = 0; i < sizeof wanted / sizeof *wanted; i++) {
        size_t count = 0;
        for (size_t k = 0; k < s->page.item_count; k++) {
            const sheet_item *item = &s->page.items[k];
            if (!item->text || strcmp(item->text, wanted[i]) != 0)
                continue;
            count++;
            assert_true(item->box[0] > 420 - 10 - 180 && item->box[0] < 410 && item->box[1] > 297 - 10 - 36);
        }
        assert_int_equal(count, 1);
    }
    lmn_sheet_destroy(&s);
}

static size_t count_texts(const lmn_sheet *s, const char *words)
{
    size_t count = 0;
    for (size_t k = 0; k < s->page.item_count; k++)
        count += s->page.items[k].text && strcmp(s->page.items[k].text, words) == 0;
    return count;
}

/* A STEP file whose header says who made it: that stands in the block where the caller says nothing. */
static void test_header(void **state)
{
    (void)state;
#ifndef LIMNER_HAVE_STEP
    print_message("skipped: built without OpenCASCADE\n");
    skip();
#else
    char       path[256];
    file_data  file = {0};
    lmn_scene *kept = f.scene;
    assert_int_equal(file_load(&file, LIMNER_SOURCE_DIR "/examples/bracket.step", NULL), LMN_OK);
    const char *old = memmem(file.data, file.size, "FILE_NAME(", 10),
               *behind = memmem(file.data, file.size, "FILE_SCHEMA", 11);
    snprintf(path, sizeof path, "%s/header.step", temp_folder());
    FILE *out = fopen(path, "wb");
    fwrite(file.data, 1, (size_t)((const unsigned char *)old - file.data), out);
    fputs("FILE_NAME('C:\\\\parts\\\\Angle 7.stp','2026-03-04T05:06:07',('Zo\\X2\\00EB\\X0\\ M; "
          "N.'),('Works'),'','','');\n",
          out);
    fwrite(behind, 1, file.size - (size_t)((const unsigned char *)behind - file.data), out);
    fclose(out);
    f.scene = load_or_fail(path);
    lmn_sheet_desc d = usual();
    d.frame = true;
    lmn_sheet *s = draw(&d);
    assert_int_equal(count_texts(s, "Angle 7"), 1);
    assert_int_equal(count_texts(s, "Zo\xC3\xAB M, N."), 1);
    assert_int_equal(count_texts(s, "Works"), 1);
    assert_int_equal(count_texts(s, "2026-03-04"), 1);
    lmn_sheet_destroy(&s);
    d.fields = "creator=A. Writer;date=today";
    d.title = "Plate";
    s = draw(&d);
    assert_int_equal(count_texts(s, "Plate") + count_texts(s, "A. Writer") + count_texts(s, "today"), 3);
    assert_int_equal(count_texts(s, "Works"), 1);
    assert_int_equal(count_texts(s, "Angle 7") + count_texts(s, "Zo\xC3\xAB M, N.") + count_texts(s, "2026-03-04"), 0);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&f.scene);
    /* What a writer puts when nobody has told it anything says nothing. */
    f.scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/bracket.step");
    d = usual();
    d.frame = true;
    s = draw(&d);
    assert_int_equal(count_texts(s, "Author") + count_texts(s, "Open CASCADE Shape Model"), 0);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&f.scene);
    file_data_release(&file);
    f.scene = kept;
#endif
}

/* A drawing that nobody has named is called as its file is, in either of the two blocks. */
static void test_title_of_file(void **state)
{
    static const double groups[] = {0, 0.5};
    (void)state;
    for (size_t i = 0; i < 2; i++) {
        lmn_sheet_desc d = usual();
        d.frame = true;
        d.line_group = groups[i];
        lmn_sheet *s = draw(&d);
        assert_int_equal(count_texts(s, "model"), 1); /* model.csg */
        assert_string_equal(s->page.title, "model");
        lmn_sheet_destroy(&s);
        d.title = "Plate";
        s = draw(&d);
        assert_int_equal(count_texts(s, "Plate"), 1);
        assert_int_equal(count_texts(s, "model"), 0);
        lmn_sheet_destroy(&s);
    }
}

static void refuse(const lmn_sheet_desc *d, lmn_status status, const char *words)
{
    lmn_draw_desc how = LMN_DRAW_DESC_INIT;
    lmn_sheet    *s = NULL;
    lmn_error     error = {0};
    assert_int_equal(lmn_draw_sheet(&s, NULL, f.scene, f.look, &how, d, &error), status);
    if (!strstr(error.message, words) && !strstr(error.hint, words))
        fail_msg("'%s' (%s) lacks '%s'", error.message, error.hint, words);
}

static void test_refused(void **state)
{
    static const char *const sections[] = {"iso",
                                           "fron",
                                           "front@",
                                           "front@x",
                                           "front@1,2",
                                           "front@1,2,3,4",
                                           "front@1,half,2",
                                           "front@1,30,2,20,3",
                                           "front@half,half",
                                           "front 3",
                                           "front@revolved,",
                                           "front@revolved,1,2"};
    static const char *const details[] = {"front",         "front@1,2/3",     "front@1,2,3",
                                          "front@1,2,3/0", "front@1,2,3/4/5", "front@1,2,3/4/5:0"};
    static const char *const directions[] = {"0,0,0", "1,2", "1,2,3,4", "up", "face@1,2"};
    (void)state;
    for (size_t i = 0; i < sizeof sections / sizeof *sections; i++) {
        lmn_sheet_desc d = usual();
        d.sections = sections[i];
        refuse(&d, LMN_USAGE, "the section is '");
    }
    for (size_t i = 0; i < sizeof details / sizeof *details; i++) {
        lmn_sheet_desc d = usual();
        d.details = details[i];
        refuse(&d, LMN_USAGE, "the detail is '");
    }
    for (size_t i = 0; i < sizeof directions / sizeof *directions; i++) {
        lmn_sheet_desc d = usual();
        d.auxiliary = directions[i];
        refuse(&d, LMN_USAGE, "the auxiliary view is '");
    }
    /* What lies beside the model: x from -40 to 40, y from -30 to 30, z from 0 to 30. */
    static const char *const beside[][2] = {{"front@1e9", "nothing is cut by the plane y = 1e+09"},
                                            {"top@-1", "nothing is cut by the plane z = -1"},
                                            {"front@100%", "nothing is cut by the plane y = 30"},
                                            {"front@-5,0,31", "nothing is cut by the plane y = 31"},
                                            {"front@-5,41,5", "x = 41"},
                                            {"front@40,half", "nothing is cut by the plane y = 40"},
                                            {"front@revolved,41", "nothing is cut by the plane x = 41"}};
    for (size_t i = 0; i < sizeof beside / sizeof *beside; i++) {
        lmn_sheet_desc d = usual();
        d.sections = beside[i][0];
        refuse(&d, LMN_USAGE, beside[i][1]);
        refuse(&d, LMN_USAGE,
               strchr(beside[i][1], 'z')     ? "from 0 to 30"
               : strstr(beside[i][1], "x =") ? "from -40 to 40"
                                             : "from -30 to 30");
    }
    static const char *const apart_details[] = {"front@900,0,0/1", "top@42,0,0/1.9", "front@41,0,31/1.2"};
    for (size_t i = 0; i < sizeof apart_details / sizeof *apart_details; i++) {
        lmn_sheet_desc d = usual();
        d.details = apart_details[i];
        refuse(&d, LMN_USAGE, "nothing of the model lies in the circle");
        refuse(&d, LMN_USAGE, "x from -40 to 40");
    }
    lmn_sheet_desc d = usual();
    d.sections = "front;front;front;front;front;front;front;front;front;front;front;front;front";
    refuse(&d, LMN_USAGE, "12 sections");
    d = usual(), d.views = NULL, d.sections = "front";
    refuse(&d, LMN_USAGE, "stand beside other views");
    d = usual(), d.line_group = 0.4;
    refuse(&d, LMN_USAGE, "line_group is 0.4 mm");
    d = usual(), d.fields = "creator=A";
    refuse(&d, LMN_USAGE, "title block of a frame");
    d = usual(), d.frame = true, d.fields = "author=A";
    refuse(&d, LMN_USAGE, "no field 'author'");
}

/* Every allocation fails once. */
static void test_out_of_memory(void **state)
{
    lmn_sheet_desc d = usual();
    lmn_draw_desc  how = LMN_DRAW_DESC_INIT;
    lmn_status     status = LMN_MEMORY;
    long           n = 1;
    (void)state;
    d.views = "top";
    d.sections = "front@half";
    d.centre_lines = true;
    for (; status != LMN_OK && n < 100000; n += n < 200 ? 1 : 37) {
        lmn_sheet *s = NULL;
        lmn_error  error = {0};
        mem_fail_at(n);
        status = lmn_draw_sheet(&s, NULL, f.scene, f.look, &how, &d, &error);
        mem_fail_at(0);
        assert_true(status == LMN_OK || status == LMN_MEMORY);
        lmn_sheet_destroy(&s);
    }
    assert_true(n > 200 && n < 100000);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_widths),
#ifdef LIMNER_HAVE_STEP
                                       cmocka_unit_test(test_tangent_edges),
#endif
#ifdef LIMNER_HAVE_STEP
                                       cmocka_unit_test(test_rims_are_whole),
                                       cmocka_unit_test(test_two_sections_beside),
#endif
                                       cmocka_unit_test(test_centre_lines),
                                       cmocka_unit_test(test_section_in_steps),
                                       cmocka_unit_test(test_chain_lines_in_dxf),
                                       cmocka_unit_test(test_half_section),
                                       cmocka_unit_test(test_revolved),
                                       cmocka_unit_test(test_apart),
                                       cmocka_unit_test(test_detail),
                                       cmocka_unit_test(test_auxiliary),
                                       cmocka_unit_test(test_half_assembly),
                                       cmocka_unit_test(test_half_has_its_outline),
                                       cmocka_unit_test(test_grid_reference),
                                       cmocka_unit_test(test_axis_in_cutting_plane),
                                       cmocka_unit_test(test_title_block),
                                       cmocka_unit_test(test_header),
                                       cmocka_unit_test(test_title_of_file),
                                       cmocka_unit_test(test_refused),
                                       cmocka_unit_test(test_out_of_memory)};
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
