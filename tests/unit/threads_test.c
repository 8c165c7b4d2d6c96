/* Threads and their symbol (ISO 6410-1), against the profiles that they are made of: where they are found and what is
 * none, and where the lines lie on views from the side, along the axis and in section. */
#define _GNU_SOURCE
#include <math.h>

#include "import_support.h"

#include "base/memory.h"
#include "draft/threads.h"
#include "limner/limner.h"
#include "pose/pose.h"
#include "vector/vector_private.h"

static const double pi = 3.14159265358979323846;
enum { AROUND = 48, CORNERS_MOST = 16, COLUMN_MOST = 400 };

/* --- models --------------------------------------------------------------------------------------------- */

/* How far out the corners of a profile lie, over one lead. */
typedef struct profile {
    double lead, length, at[CORNERS_MOST], radius[CORNERS_MOST];
    int    count;
    double chamfer; /* the radius is no larger than this beside the end at 0, and grows like the height */
} profile;

typedef struct corner {
    double p[3], phase;
} corner;

typedef struct model {
    FILE *file;
    int   count;
} model;

static double radius_at(const profile *f, double phase)
{
    double at = fmod(fmod(phase - f->at[0], f->lead) + f->lead, f->lead) + f->at[0];
    for (int k = 0; k < f->count; k++) {
        double next = k + 1 < f->count ? f->at[k + 1] : f->at[0] + f->lead, to = f->radius[(k + 1) % f->count];
        if (at >= f->at[k] && at <= next)
            return f->radius[k] + (to - f->radius[k]) * (at - f->at[k]) / (next - f->at[k]);
    }
    return f->radius[0];
}

static int compare_corners(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    return (p->phase > q->phase) - (p->phase < q->phase);
}

static void place(const profile *f, corner *c, int i, double z, double radius)
{
    if (f->chamfer > 0)
        radius = fmin(radius, f->chamfer + z);
    double angle = 2 * pi * (i % AROUND) / AROUND;
    c->p[0] = radius * cos(angle);
    c->p[1] = radius * sin(angle);
    c->p[2] = z;
    c->phase = z - f->lead * i / AROUND;
}

/* What is cut through along the axis at one angle, from below. */
static int column(const profile *f, int i, corner *out)
{
    double off = f->lead * i / AROUND;
    int    count = 2;
    place(f, &out[0], i, 0, radius_at(f, -off));
    place(f, &out[1], i, f->length, radius_at(f, f->length - off));
    for (int turn = -2; turn < f->length / f->lead + 2; turn++)
        for (int k = 0; k < f->count; k++) {
            double z = f->at[k] + turn * f->lead + off;
            if (z > 1e-3 && z < f->length - 1e-3)
                place(f, &out[count++], i, z, f->radius[k]);
        }
    qsort(out, (size_t)count, sizeof *out, compare_corners);
    return count;
}

/* With the axis upright, which is y in these files. */
static void put(model *m, const double a[3], const double b[3], const double c[3], bool turned)
{
    const double *corners[3] = {a, turned ? c : b, turned ? b : c};
    for (int k = 0; k < 3; k++)
        fprintf(m->file, "v %.7f %.7f %.7f\n", corners[k][0], corners[k][2], -corners[k][1]);
    fprintf(m->file, "f %d %d %d\n", m->count + 1, m->count + 2, m->count + 3);
    m->count += 3;
}

/* The surface; its rims at both ends go to `rims`. */
static void put_thread(model *m, const profile *f, bool hollow, double (*rims)[AROUND][3])
{
    static corner columns[2][COLUMN_MOST];
    int           count = column(f, 0, columns[0]);
    for (int i = 0; i < AROUND; i++) {
        const corner *a = columns[i % 2], *b = columns[(i + 1) % 2];
        int           next = column(f, i + 1, columns[(i + 1) % 2]);
        for (int k = 0; k < 3; k++) {
            rims[0][i][k] = a[0].p[k];
            rims[1][i][k] = a[count - 1].p[k];
        }
        for (int p = 0, q = 0; p + 1 < count || q + 1 < next;)
            if (q + 1 == next || (p + 1 < count && a[p + 1].phase <= b[q + 1].phase + 1e-9)) {
                put(m, a[p].p, b[q].p, a[p + 1].p, hollow);
                p++;
            } else {
                put(m, a[p].p, b[q].p, b[q + 1].p, hollow);
                q++;
            }
        count = next;
    }
}

static void ring(double (*out)[3], double radius, double z)
{
    for (int i = 0; i < AROUND; i++) {
        out[i][0] = radius * cos(2 * pi * i / AROUND);
        out[i][1] = radius * sin(2 * pi * i / AROUND);
        out[i][2] = z;
    }
}

static void put_band(model *m, double (*a)[3], double (*b)[3], bool turned)
{
    for (int i = 0; i < AROUND; i++) {
        int k = (i + 1) % AROUND;
        put(m, a[i], a[k], b[k], turned);
        put(m, a[i], b[k], b[i], turned);
    }
}

static model begin(const char *name)
{
    model m = {fopen(temp_file(name, "", 0), "w"), 0};
    assert_non_null(m.file);
    return m;
}

static lmn_scene *end(model *m, const char *name)
{
    char path[512];
    fclose(m->file);
    snprintf(path, sizeof path, "%s/%s", temp_folder(), name);
    return load_or_fail(path);
}

/* A metric thread of a shaft, the crests a flat of an eighth of the pitch, the roots of a quarter. */
static profile shaft(double diameter, double pitch, double length)
{
    double  depth = 0.61343 * pitch, flank = pitch * 5 / 16;
    profile f = {.lead = pitch,
                 .length = length,
                 .count = 4,
                 .at = {0, pitch / 8, pitch / 8 + flank, pitch * 3 / 8 + flank},
                 .radius = {diameter / 2, diameter / 2, diameter / 2 - depth, diameter / 2 - depth}};
    return f;
}

/* From 0 a thread, then a shank as thick up to 30, and a flange. */
static lmn_scene *screw(double chamfer)
{
    profile f = shaft(10, 1.5, 20);
    double  rims[2][AROUND][3], rings[4][AROUND][3], tip[AROUND][3];
    model   m = begin("screw.obj");
    f.chamfer = chamfer;
    put_thread(&m, &f, false, rims);
    ring(tip, 0, 0);
    ring(rings[0], 5, 20);
    ring(rings[1], 5, 30);
    ring(rings[2], 9, 30);
    ring(rings[3], 9, 36);
    put_band(&m, tip, rims[0], true);
    put_band(&m, rims[1], rings[0], false);
    for (int k = 0; k < 3; k++)
        put_band(&m, rings[k], rings[k + 1], false);
    ring(tip, 0, 36);
    put_band(&m, rings[3], tip, false);
    return end(&m, "screw.obj");
}

static lmn_scene *nut(void)
{
    double  core = 5 - 0.54127 * 1.5, flank = 1.5 * 5 / 16, rims[2][AROUND][3], rings[2][AROUND][3];
    profile f = {.lead = 1.5,
                 .length = 8,
                 .count = 4,
                 .at = {0, 0.375, 0.375 + flank, 0.375 + flank + 0.1875},
                 .radius = {core, core, 5, 5}};
    model   m = begin("nut.obj");
    put_thread(&m, &f, true, rims);
    ring(rings[0], 9, 0);
    ring(rings[1], 9, 8);
    put_band(&m, rims[0], rings[0], true);
    put_band(&m, rings[0], rings[1], false);
    put_band(&m, rings[1], rims[1], false);
    return end(&m, "nut.obj");
}

/* A thread between two faces. */
static lmn_scene *rod(const profile *f)
{
    double rims[2][AROUND][3], tip[AROUND][3];
    model  m = begin("rod.obj");
    put_thread(&m, f, false, rims);
    ring(tip, 0, 0);
    put_band(&m, tip, rims[0], true);
    ring(tip, 0, f->length);
    put_band(&m, rims[1], tip, false);
    return end(&m, "rod.obj");
}

static lmn_scene *spring(void)
{
    enum { TURNS = 6, WIRE = 12 };
    static double wire[TURNS * AROUND + 1][WIRE][3];
    model         m = begin("spring.obj");
    for (int i = 0; i <= TURNS * AROUND; i++)
        for (int k = 0; k < WIRE; k++) {
            double a = 2 * pi * i / AROUND, b = 2 * pi * k / WIRE, r = 8 + cos(b);
            wire[i][k][0] = r * cos(a);
            wire[i][k][1] = r * sin(a);
            wire[i][k][2] = 3.0 * i / AROUND + sin(b);
        }
    for (int i = 0; i < TURNS * AROUND; i++)
        for (int k = 0; k < WIRE; k++) {
            int n = (k + 1) % WIRE;
            put(&m, wire[i][k], wire[i + 1][n], wire[i + 1][k], false);
            put(&m, wire[i][k], wire[i][n], wire[i + 1][n], false);
        }
    return end(&m, "spring.obj");
}

/* --- what is found -------------------------------------------------------------------------------------- */

static draft_threads found_in(const lmn_scene *scene)
{
    edge_mesh     edges;
    draft_threads found = {NULL, 0, 0};
    lmn_error     error = {0};
    assert_int_equal(edge_mesh_create(&edges, &scene->meshes[0], NULL, 40 * pi / 180, &error), LMN_OK);
    uint32_t *region = mem_calloc(edges.vertex_count + 1, sizeof *region);
    assert_int_equal(draft_threads_find(&found, region, &edges, &error), LMN_OK);
    mem_free(region);
    edge_mesh_release(&edges);
    return found;
}

static void assert_thread(lmn_scene *scene, double crest, double root, double lead, double length)
{
    draft_threads found = found_in(scene);
    assert_int_equal(found.count, 1);
    const draft_thread *t = &found.items[0];
    double              along =
        hypot(hypot(t->ends[1][0] - t->ends[0][0], t->ends[1][1] - t->ends[0][1]), t->ends[1][2] - t->ends[0][2]);
    print_message("crest %.4f root %.4f lead %.4f length %.4f\n", t->crest, t->root, t->lead, along);
    assert_float_equal(t->crest, crest, 1e-3);
    assert_float_equal(t->root, root, 1e-3);
    assert_float_equal(t->lead, lead, (0.05 * lead));
    assert_float_equal(along, length, 1e-3);
    assert_int_equal(t->hollow, crest < root);
    assert_true(fabs(t->axis[1]) > 0.999999);
    draft_threads_release(&found);
    lmn_scene_destroy(&scene);
}

static void threads_are_found(void **state)
{
    const profile trapezoid = {.lead = 6, /* of two starts */
                               .length = 30,
                               .count = 8,
                               .at = {0, 1.1, 1.5, 2.6, 3, 4.1, 4.5, 5.6},
                               .radius = {8, 8, 6.5, 6.5, 8, 8, 6.5, 6.5}},
                  square = {
                      .lead = 4, .length = 30, .count = 4, .at = {0, 1.999, 2.001, 3.999}, .radius = {8, 8, 6.5, 6.5}};
    profile round = {.lead = 2, .length = 20, .count = 16};
    (void)state;
    for (int i = 0; i < 16; i++) {
        round.at[i] = i / 8.0;
        round.radius[i] = 5 - 0.35 * (1 - cos(2 * pi * i / 16));
    }
    assert_thread(screw(0), 5, 5 - 0.920145, 1.5, 20);
    assert_thread(nut(), 5 - 0.811905, 5, 1.5, 8);
    assert_thread(rod(&trapezoid), 8, 6.5, 6, 30);
    assert_thread(rod(&square), 8, 6.5, 4, 30);
    assert_thread(rod(&round), 5, 4.3, 2, 20);
}

/* Springs look both ways, drills are steep, augers deep, and what is round alone does not move along its axis. */
static void others_are_not(void **state)
{
    const profile drill = {.lead = 40, .length = 80, .count = 4, .at = {0, 20, 22, 38}, .radius = {5, 5, 4.2, 4.2}},
                  auger = {.lead = 6, .length = 30, .count = 4, .at = {0, 1, 2, 5}, .radius = {8, 8, 3, 3}};
    lmn_scene *scenes[] = {spring(), rod(&drill), rod(&auger), load_or_fail(LIMNER_SOURCE_DIR "/examples/pump.glb")};
    (void)state;
    for (size_t i = 0; i < sizeof scenes / sizeof *scenes; i++) {
        draft_threads found = found_in(scenes[i]);
        assert_int_equal(found.count, 0);
        draft_threads_release(&found);
        lmn_scene_destroy(&scenes[i]);
    }
}

/* --- lines on sheets ------------------------------------------------------------------------------------ */

static lmn_sheet *draw(const lmn_scene *scene, const char *views, const char *sections, const char *threads)
{
    lmn_sheet_desc d = LMN_SHEET_DESC_INIT;
    lmn_draw_desc  how = LMN_DRAW_DESC_INIT;
    lmn_look      *look;
    lmn_sheet     *s = NULL;
    lmn_error      error = {0};
    d.views = views;
    d.sections = sections;
    d.threads = threads;
    d.page = "A3";
    d.scale = "2:1";
    d.unit = "mm";
    d.line_group = 0.5;
    d.smooth = 0;
    d.verify = true;
    d.loose_hatch = true;
    assert_int_equal(lmn_look_load(&look, "technical", &error), LMN_OK);
    if (lmn_draw_sheet(&s, NULL, scene, look, &how, &d, &error) != LMN_OK)
        fail_msg("%s", error.message);
    lmn_look_destroy(&look);
    assert_int_equal(s->check.wrong, 0);
    return s;
}

static bool is_in(const sheet *s, const sheet_item *item, const char *name)
{
    for (int32_t at = (int32_t)item->group; at >= 0; at = s->groups[at].parent)
        if ((s->groups[at].name && strcmp(s->groups[at].name, name) == 0) ||
            (s->groups[at].css_class && strstr(s->groups[at].css_class, name)))
            return true;
    return false;
}

/* Lines of a view and class, in mm of the model from its axis and along it, as they lie on the sheet. */
typedef struct drawn_line {
    double x[2], y[2], radius[2]; /* of the ends; the least and largest distance from the axis as seen along it */
    double width;
    bool   dashed;
} drawn_line;

static size_t lines_of(const lmn_sheet *s, const char *view, const char *class, drawn_line *out, size_t most)
{
    const vector_view *v = NULL;
    size_t             count = 0;
    for (size_t i = 0; i < s->view_count; i++) {
        char name[64];
        snprintf(name, sizeof name, "view-%s", s->views[i].name);
        v = strcmp(name, view) == 0 ? &s->views[i] : v;
    }
    assert_non_null(v);
    const mat4 *m = &v->camera.view;
    for (size_t i = 0; i < s->page.item_count; i++) {
        const sheet_item *item = &s->page.items[i];
        if (item->kind != SHEET_PATH || !is_in(&s->page, item, view) || !is_in(&s->page, item, class))
            continue;
        for (uint32_t k = 0; k < item->count; k++, count++) {
            const sheet_path *path = &s->page.paths[item->first + k];
            drawn_line        line = {.width = (double)path->width, .dashed = path->dash_count > 0, .radius = {1e9, 0}};
            for (uint32_t n = 0; n < path->count; n++) {
                const float *p = s->page.points[path->first + n];
                double       x = ((double)p[0] - v->box[0] - v->box[2] / 2) / 2 - m->m[12],
                       y = -((double)p[1] - v->box[1] - v->box[3] / 2) / 2 - m->m[13];
                line.radius[0] = fmin(line.radius[0], hypot(x, y));
                line.radius[1] = fmax(line.radius[1], hypot(x, y));
                line.x[n > 0] = x;
                line.y[n > 0] = y;
            }
            if (count < most)
                out[count] = line;
        }
    }
    return count;
}

static size_t matching(const drawn_line *lines, size_t count, double x0, double y0, double x1, double y1, double width,
                       bool dashed)
{
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        for (int turned = 0; turned < 2; turned++) {
            const drawn_line *l = &lines[i];
            found += hypot(l->x[turned] - x0, l->y[turned] - y0) < 0.05 &&
                     hypot(l->x[!turned] - x1, l->y[!turned] - y1) < 0.05 && fabs(l->width - width) < 1e-6 &&
                     l->dashed == dashed;
        }
    return found;
}

/* From the side narrow lines along the roots, and a wide one where it ends on the shank; from the end three quarters
 * of a circle, above on the right open. Nothing of the helix is left. */
static void shafts_have_the_symbol(void **state)
{
    enum { MOST = 32 };
    drawn_line   l[MOST];
    const double root = 5 - 0.920145;
    lmn_scene   *scene = screw(0);
    (void)state;
    lmn_sheet *s = draw(scene, "front,bottom", NULL, "*");
    size_t     count = lines_of(s, "view-front", "thread", l, MOST);
    assert_int_equal(count, 3);
    assert_int_equal(matching(l, count, root, 0, root, 20, 0.25, false), 1);
    assert_int_equal(matching(l, count, -root, 0, -root, 20, 0.25, false), 1);
    assert_int_equal(matching(l, count, -5, 20, 5, 20, 0.5, false), 1);
    assert_true(lines_of(s, "view-front", "visible", l, MOST) < 16);
    count = lines_of(s, "view-bottom", "thread", l, MOST);
    assert_int_equal(count, 1);
    assert_float_equal(l[0].radius[0], root, 0.01);
    assert_float_equal(l[0].radius[1], root, 0.01);
    assert_true(fmin(fabs(l[0].x[0]), fabs(l[0].x[1])) < 0.3 && fmin(fabs(l[0].y[0]), fabs(l[0].y[1])) < 0.3);
    assert_true(fmax(l[0].x[0], l[0].x[1]) > 4 && fmax(l[0].y[0], l[0].y[1]) > 4);
    lmn_sheet_destroy(&s);
    s = draw(scene, "front", NULL, NULL);
    assert_int_equal(lines_of(s, "view-front", "thread", l, MOST), 0);
    assert_true(lines_of(s, "view-front", "visible", l, MOST) > 30);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&scene);
}

/* A chamfer stays; the line where it begins is one, and lines of roots end at it. */
static void chamfers_stay(void **state)
{
    enum { MOST = 32 };
    drawn_line l[MOST];
    lmn_scene *scene = screw(3.5);
    (void)state;
    lmn_sheet *s = draw(scene, "front", NULL, "*");
    size_t     count = lines_of(s, "view-front", "thread", l, MOST), across = 0, along = 0;
    for (size_t i = 0; i < count; i++) {
        const double low = fmin(l[i].y[0], l[i].y[1]);
        assert_true(fmax(l[i].y[0], l[i].y[1]) < 20.01);
        across += fabs(l[i].y[0] - l[i].y[1]) < 1e-3 && fabs(fabs(l[i].x[0]) - 5) < 0.05 && low > 1.2 && low < 1.8;
        along += fabs(l[i].x[0] - l[i].x[1]) < 1e-3 && low > 0.4 && low < 0.8;
    }
    assert_int_equal(across, 1);
    assert_int_equal(along, 2);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&scene);
}

/* Hidden in a nut seen from the side, narrow lines in its section, where hatching goes on to the crests. */
static void bores_have_the_symbol(void **state)
{
    enum { MOST = 256 };
    drawn_line   l[MOST];
    const double core = 5 - 0.811905;
    lmn_scene   *scene = nut();
    (void)state;
    lmn_sheet *s = draw(scene, "top,front,right", "front", "*");
    size_t     count = lines_of(s, "view-right", "thread", l, MOST);
    assert_int_equal(count, 2);
    assert_int_equal(matching(l, count, 5, 0, 5, 8, 0.25, true), 1);
    assert_int_equal(matching(l, count, -5, 0, -5, 8, 0.25, true), 1);
    count = lines_of(s, "view-section-A", "thread", l, MOST);
    assert_int_equal(count, 2);
    assert_int_equal(matching(l, count, 5, 0, 5, 8, 0.25, false), 1);
    assert_int_equal(matching(l, count, -5, 0, -5, 8, 0.25, false), 1);
    count = lines_of(s, "view-section-A", "hatch", l, MOST);
    double nearest = 1e9;
    for (size_t i = 0; i < count && i < MOST; i++)
        nearest = fmin(nearest, fmin(fabs(l[i].x[0]), fabs(l[i].x[1])));
    assert_true(count > 8);
    assert_float_equal(nearest, core, 0.02);
    count = lines_of(s, "view-top", "thread", l, MOST);
    assert_int_equal(count, 1);
    assert_float_equal(l[0].radius[0], 5, 0.01);
    assert_false(l[0].dashed);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&scene);
}

/* What is called M10x1 and has a cylinder of that diameter. */
static void names_tell_threads(void **state)
{
    enum { MOST = 32 };
    const struct {
        const char *name;
        double      radius, root;
    } parts[] = {{"M10.obj", 5, 5 - 0.61343 * 1.5},
                 {"Screw M10x1.obj", 5, 5 - 0.61343},
                 {"M10x40.obj", 5, 5 - 0.61343 * 1.5},
                 {"M8.obj", 5, 0},
                 {"Rim10.obj", 5, 0}};
    (void)state;
    for (size_t i = 0; i < sizeof parts / sizeof *parts; i++) {
        drawn_line l[MOST];
        double     rings[4][AROUND][3];
        model      m = begin(parts[i].name);
        fprintf(m.file, "o %.*s\n", (int)(strlen(parts[i].name) - 4), parts[i].name);
        ring(rings[0], 0, 0);
        ring(rings[1], parts[i].radius, 0);
        ring(rings[2], parts[i].radius, 20);
        ring(rings[3], 0, 20);
        put_band(&m, rings[0], rings[1], true);
        put_band(&m, rings[1], rings[2], false);
        put_band(&m, rings[2], rings[3], false);
        lmn_scene *scene = end(&m, parts[i].name);
        lmn_sheet *s = draw(scene, "front", NULL, "*");
        size_t     count = lines_of(s, "view-front", "thread", l, MOST);
        print_message("%s: %zu lines\n", parts[i].name, count);
        assert_int_equal(count, parts[i].root > 0 ? 2 : 0);
        if (count)
            assert_int_equal(matching(l, count, parts[i].root, 0, parts[i].root, 20, 0.25, false), 1);
        lmn_sheet_destroy(&s);
        lmn_scene_destroy(&scene);
    }
}

/* Of a screw in its nut what is hidden is the screw's; in the section it hides the nut's thread. */
static void screws_come_first(void **state)
{
    enum { MOST = 64 };
    drawn_line l[MOST];
    lmn_scene *scene = load_or_fail(LIMNER_SOURCE_DIR "/examples/screw.obj");
    (void)state;
    lmn_sheet *s = draw(scene, "front", NULL, "*");
    size_t     count = lines_of(s, "view-front", "thread", l, MOST), dashed = 0;
    for (size_t i = 0; i < count && i < MOST; i++) {
        dashed += l[i].dashed;
        assert_true(!l[i].dashed || fabs(fabs(l[i].x[0]) - (5 - 0.920145)) < 0.01);
    }
    assert_int_equal(dashed, 2);
    lmn_sheet_destroy(&s);
    s = draw(scene, "front", NULL, "Nut"); /* alone it has its own */
    count = lines_of(s, "view-front", "thread", l, MOST);
    assert_true(count >= 2 && l[0].dashed && fabs(fabs(l[0].x[0]) - 5) < 0.01);
    lmn_sheet_destroy(&s);
    lmn_scene_destroy(&scene);
}

static void selectors_are_checked(void **state)
{
    lmn_scene     *scene = spring();
    lmn_sheet_desc d = LMN_SHEET_DESC_INIT;
    lmn_draw_desc  how = LMN_DRAW_DESC_INIT;
    lmn_look      *look;
    lmn_sheet     *s = NULL;
    lmn_error      error = {0};
    (void)state;
    d.threads = "[";
    assert_int_equal(lmn_look_load(&look, "technical", &error), LMN_OK);
    assert_int_equal(lmn_draw_sheet(&s, NULL, scene, look, &how, &d, &error), LMN_USAGE);
    d.threads = "nobody";
    assert_int_equal(lmn_draw_sheet(&s, NULL, scene, look, &how, &d, &error), LMN_USAGE);
    assert_non_null(strstr(error.message, "'nobody' of threads matches none"));
    d.threads = "*";
    assert_int_equal(lmn_draw_sheet(&s, NULL, scene, look, &how, &d, &error), LMN_OK);
    lmn_sheet_destroy(&s);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(threads_are_found),      cmocka_unit_test(others_are_not),
        cmocka_unit_test(shafts_have_the_symbol), cmocka_unit_test(chamfers_stay),
        cmocka_unit_test(bores_have_the_symbol),  cmocka_unit_test(names_tell_threads),
        cmocka_unit_test(screws_come_first),      cmocka_unit_test(selectors_are_checked)};
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
