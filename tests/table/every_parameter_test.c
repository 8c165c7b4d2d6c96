/* Every technique draws with the extremes of each of its parameters, and every parameter changes the picture for some
 * value: a row that nothing reads is a promise that is not kept. Usage: every_parameter_test EXAMPLES
 * [briefly|variants] [KIND[.TECHNIQUE]…]
 *
 * Only the kinds and techniques that are named are drawn; none: all. Of one technique alone, parameters of the whole
 * kind are drawn but need not mean anything.
 *
 * Variants: only what decides which shaders are built. For the other dialect of the shaders, whose uniforms are the
 * same lines of text.
 *
 * Briefly: a number that is a mere uniform is drawn with one value that changes the picture, a usual one, not with both
 * of its extremes. What decides which shaders are built is still drawn with all. For the paths of drawing that share
 * most of their code with the usual one, which is not drawn briefly. */
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

#include <cmocka.h>

#include "hold.h"
#include "limner/limner.h"
#include "look/look.h"

enum { SIDE = 160, VALUES_MAX = 24, TEXT_SIZE = 96 };

/* What a technique draws before anything is set: the same for all parameters that ask for the same. */
typedef struct plain_picture {
    const technique *technique;
    const lmn_scene *scene;
    const char      *only_if;    /* NULL: nothing */
    uint32_t         made_light; /* see hold_lighter */
    uint8_t         *pixels;
} plain_picture;

enum { PLAIN_MAX = 1024 };

typedef struct fixture {
    lmn_scene    *scene;
    lmn_scene    *solid;  /* for parameters that only solids know */
    lmn_scene    *simple; /* for parameters whose extremes take long with many triangles */
    lmn_scene    *moving; /* for what tells of motion */
    lmn_renderer *renderer;
    const char   *examples;
    bool          brief, variants;
    char        **wanted; /* "KIND" or "KIND.TECHNIQUE"; none: all */
    int           wanted_count;
    int           mistakes, drawn;
    plain_picture plain[PLAIN_MAX];
    size_t        plain_count;
} fixture;

/* Parameters that cannot change this picture, with the reason. */
static const struct {
    const char *kind, *key, *reason;
} exceptions[] = {
    {"layers", "shading", "both ways give the same picture"},
    {"layers", "producer", "both ways give the same layers"},
    {"layers", "memory", "less memory gives the same layers"},
    {"layers", "settle_ties", "no parts lie on one another here; analytic.layers has some that do"},
    {"surface", "cull", "what is left out is not seen; analytic.stipple compares the pictures"},
    {"surface", "layout", "all lie in memory in other ways and give the same picture"},
    {"surface", "hiding", "all ways leave the same strokes out"},
    {"layers", "evaluation", "all ways give the same surfaces"},
    {"lines", "taps", "both ways give the same gradient, from fewer or more samples"},
    {"scene", "lights", "the scene has no lights of its own"},
    {"lines", "taps", "both forms are the same sums"},
    {"motion", "squash", "the fox is not stopped while it runs; unit.deform_test has a ball that is"},
    {"motion", "vibration", "no limb swings to and fro within the exposure; analytic.traces has a ball that does"},
    {"motion", "vibration_apart", "likewise"},
    {"surface", "frame", "windows are too small here to have frames; analytic.city has some that do"},
    {"surface", "frame_colour", "likewise"},
    {"surface", "bars", "likewise"},
    {"surface", "sea", "nothing here lies level at height 0"},
    {"surface", "spotted", "nothing here is dark and without a colour; analytic.surfaces has a ball and a slot"},
    {"scene", "ground_edge", "the parts do not stand on one level; analytic.ground has a block that does"},
    {"scene", "ground_hatch", "the parts do not stand on one level; analytic.ground has a block that does"},
    {"scene", "ground_fade", "the parts do not stand on one level; analytic.ground has a block that does"},
    {"scene", "ground_smoothing", "the parts do not stand on one level; analytic.ground has a block that does"},
    {"scene", "ground_angle", "the parts do not stand on one level; analytic.ground has a block that does"},
    {"scene", "datum_other", "every part has a height; analytic.city has one without a value"},
    {"finish", "label_size", "nothing is written here; unit.annotate_test has labels"},
    {"finish", "legend", "no datum is shown here; unit.annotate_test has one"},
    {"finish", "scale_bar", "it needs a parallel projection; unit.annotate_test has one"},
    {"surface", "accent", "the looks here have no occlusion; analytic.sticks has some"},
    {"motion", "shadows", "the looks here have no shadows; engine.streaks_test has some"},
};

/* Two ends of a range: what is drawn with an end beyond the other one is refused, so the other one gives way. */
static const struct {
    const char *kind, *lower, *upper;
} ranges[] = {{"scene", "datum_from", "datum_to"}};

/* Parameters that change nothing but solids. They are drawn alone, of convex operands, which every path of drawing
 * can. */
static const struct {
    const char *kind, *key;
} of_solids[] = {{"lines", "meet"}};

/* Parameters that say how meshes are taken apart, by several techniques in the same way. */
static const struct {
    const char *kind, *key;
} of_meshes[] = {{"surface", "patch"}};

static bool is_of_solids(const kind *k, const param *p)
{
    for (size_t i = 0; i < PARAM_COUNT(of_solids); i++)
        if (strcmp(of_solids[i].kind, k->name) == 0 && strcmp(of_solids[i].key, p->key) == 0)
            return true;
    return false;
}

static bool is_of_meshes(const kind *k, const param *p)
{
    for (size_t i = 0; i < PARAM_COUNT(of_meshes); i++)
        if (strcmp(of_meshes[i].kind, k->name) == 0 && strcmp(of_meshes[i].key, p->key) == 0)
            return true;
    return false;
}

static const lmn_scene *scene_for(const fixture *f, const kind *k, const param *p)
{
    if (k->id == KIND_MOTION)
        return f->moving;
    return is_of_solids(k, p) ? f->solid : is_of_meshes(k, p) ? f->simple : f->scene;
}

static bool is_exception(const kind *k, const param *p)
{
    for (size_t i = 0; i < PARAM_COUNT(exceptions); i++)
        if (strcmp(exceptions[i].kind, k->name) == 0 && strcmp(exceptions[i].key, p->key) == 0)
            return true;
    return false;
}

/* A coloured ball without normals that cuts into the gearbox, so that there are several parts, hues, texture
 * coordinates and intersections. */
static void write_ball(FILE *file, double x)
{
    enum { ROWS = 10, COLUMNS = 16 };
    fprintf(file,
            "ply\nformat ascii 1.0\nelement vertex %d\nproperty float x\nproperty float y\nproperty float z\n"
            "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float s\nproperty float "
            "t\nelement face %d\n"
            "property list uchar int vertex_indices\nend_header\n",
            (ROWS + 1) * COLUMNS, ROWS * COLUMNS);
    for (int r = 0; r <= ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            double polar = 3.14159265 * r / ROWS, around = 2 * 3.14159265 * c / COLUMNS;
            fprintf(file, "%.4f %.4f %.4f %d %d %d %.4f %.4f\n", 45 * sin(polar) * cos(around) + x,
                    45 * cos(polar) + 45, 45 * sin(polar) * sin(around) + 20, 200 - 15 * r, 60 + 8 * c, 60,
                    2.0 * c / COLUMNS, 1.0 * r / ROWS);
        }
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            int next = (c + 1) % COLUMNS;
            fprintf(file, "4 %d %d %d %d\n", r * COLUMNS + c, (r + 1) * COLUMNS + c, (r + 1) * COLUMNS + next,
                    r * COLUMNS + next);
        }
}

/* A small body of five bulges, fine enough to have no creases: ridges, valleys, and where the eye moves a little,
 * outlines. */
static void write_flower(FILE *file, double x)
{
    enum { ROWS = 24, COLUMNS = 200 };
    for (int r = 0; r <= ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            double polar = 3.14159265 * r / ROWS, around = 2 * 3.14159265 * c / COLUMNS,
                   radius = 24 * (1 + 0.25 * cos(5 * around) * sin(polar));
            fprintf(file, "v %.4f %.4f %.4f\n", radius * sin(polar) * cos(around) + x,
                    radius * sin(polar) * sin(around) + 100, radius * cos(polar) + 20);
        }
    for (int r = 0; r < ROWS; r++)
        for (int c = 0; c < COLUMNS; c++) {
            int a = r * COLUMNS + c + 1, b = r * COLUMNS + (c + 1) % COLUMNS + 1;
            fprintf(file, "f %d %d %d %d\n", a, a + COLUMNS, b + COLUMNS, b);
        }
}

static lmn_look *look_of(const technique *t, char *json, size_t size)
{
    lmn_look *look = NULL;
    lmn_error error = {0};
    snprintf(json, size,
             "{\"version\": 1, \"rules\": [%s, {\"select\": \"other*\", \"surface\": \"lit\"}], "
             "\"finish\": {\"ground\": \"#7080a0\"}}",
             t->example);
    if (lmn_look_parse(&look, json, t->name, &error) != LMN_OK)
        fail_msg("example of %s: %s", t->name, error.message);
    return look;
}

static lmn_drawing *draw(fixture *f, const lmn_scene *scene, const lmn_look *look, const char *what)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.time_s = 0.5; /* some parameters count by the second; with the others a time changes nothing */
    desc.clip = scene == f->moving ? "Run" : NULL;
    desc.lenient = true;
    lmn_drawing *drawing = NULL;
    lmn_error    error = {0};
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    f->drawn++;
    if (lmn_draw(&drawing, f->renderer, scene, look, &desc, &error) == LMN_OK)
        return drawing;
    print_error("%s: cannot be drawn: %s\n", what, error.message);
    f->mistakes++;
    return NULL;
}

static bool are_equal(const uint8_t *pixels, const lmn_drawing *drawing)
{
    int width, height;
    return memcmp(pixels, lmn_drawing_pixels(drawing, &width, &height), (size_t)SIDE * SIDE * 4) == 0;
}

/* Lent; NULL when it cannot be drawn. `look` has what the parameter asks for, and nothing else. */
static const uint8_t *plain_of(fixture *f, const lmn_scene *scene, const technique *t, const param *p,
                               uint32_t made_light, const lmn_look *look, const char *what)
{
    for (size_t i = 0; i < f->plain_count; i++) {
        const plain_picture *known = &f->plain[i];
        bool                 same =
            known->only_if && p->only_if ? strcmp(known->only_if, p->only_if) == 0 : known->only_if == p->only_if;
        if (same && known->technique == t && known->scene == scene && known->made_light == made_light)
            return known->pixels;
    }
    lmn_drawing *drawing = f->plain_count < PLAIN_MAX ? draw(f, scene, look, what) : NULL;
    uint8_t     *pixels = drawing ? malloc((size_t)SIDE * SIDE * 4) : NULL;
    int          width, height;
    if (pixels) {
        memcpy(pixels, lmn_drawing_pixels(drawing, &width, &height), (size_t)SIDE * SIDE * 4);
        f->plain[f->plain_count++] = (plain_picture){t, scene, p->only_if, made_light, pixels};
    } else
        f->mistakes++;
    lmn_drawing_destroy(&drawing);
    return pixels;
}

enum { SOFT_MAX = 3 /* where the greatest of a number's usual values stands */ };

/* Values worth trying; a number's extremes come first. */
static size_t values_of(const param *p, char values[VALUES_MAX][TEXT_SIZE])
{
    size_t                   count = 0;
    double                   soft_min = p->soft_min != 0 || p->soft_max != 0 ? p->soft_min : p->min;
    double                   soft_max = p->soft_min != 0 || p->soft_max != 0 ? p->soft_max : p->max;
    const double             numbers[] = {p->min,     p->max,          soft_min, soft_max, (soft_min + soft_max) / 2,
                                          p->def * 2, p->def / 2 + 0.3};
    static const char *const colours[] = {"#ff00ff", "#00ff00", "none"}, *const axes[] = {"1,0,0", "0,0,1",
                                                                                          "-1,-1,0.2"};
    static const char *const palettes[] = {"#000000", "#ff0000,#00ff00,#0000ff,#ffffff"};
    switch (p->type) {
    case PARAM_INT:
    case PARAM_FLOAT:
        for (size_t i = 0; i < PARAM_COUNT(numbers); i++)
            snprintf(values[count++], TEXT_SIZE, p->type == PARAM_INT ? "%.0f" : "%.6f", numbers[i]);
        break;
    case PARAM_BOOL: snprintf(values[count++], TEXT_SIZE, "%s", p->def != 0 ? "false" : "true"); break;
    case PARAM_ENUM:
        for (; p->names[count] && count < VALUES_MAX; count++)
            snprintf(values[count], TEXT_SIZE, "%s", p->names[count]);
        break;
    case PARAM_COLOUR:
    case PARAM_DIRECTION:
        for (size_t i = 0; i < 3; i++)
            snprintf(values[count++], TEXT_SIZE, "%s", p->type == PARAM_COLOUR ? colours[i] : axes[i]);
        break;
    case PARAM_TEXT: snprintf(values[count++], TEXT_SIZE, "%s", p->example); break;
    case PARAM_PALETTE:
        for (size_t i = 0; i < 2; i++)
            snprintf(values[count++], TEXT_SIZE, "%s", palettes[i]);
        break;
    }
    return count;
}

static void set_other_end(lmn_look *look, const kind *k, const param *p, const char *value)
{
    char   path[HOLD_KEY_SIZE];
    double number = atof(value);
    for (size_t i = 0; i < PARAM_COUNT(ranges); i++) {
        bool is_lower = strcmp(ranges[i].lower, p->key) == 0;
        if (strcmp(ranges[i].kind, k->name) != 0 || !(is_lower || strcmp(ranges[i].upper, p->key) == 0))
            continue;
        hold_key(path, k, is_lower ? ranges[i].upper : ranges[i].lower);
        lmn_look_set(look, path, (number > 0) == is_lower ? value : "0", NULL);
    }
}

/* Does the parameter change the picture? */
static bool check_param(fixture *f, const kind *k, const technique *t, const param *p)
{
    if (f->variants && !p->variant && !p->toggles)
        return true;
    char      json[2048], path[HOLD_KEY_SIZE], what[TEXT_SIZE * 3], values[VALUES_MAX][TEXT_SIZE];
    lmn_look *look = look_of(t, json, sizeof json);
    hold_key(path, k, p->key);
    if (k->id == KIND_LAYERS)
        lmn_look_set(look, "0:lines.operator", "discontinuity", NULL);
    if (k->id == KIND_LINES) /* white lines show only on something darker */
        lmn_look_set(look, "0:surface.technique", "lit", NULL);
    uint32_t made_light = hold_lighter(look, k, t, p->key);
    hold_condition(look, k, t, p->only_if);
    const lmn_scene *scene = scene_for(f, k, p);
    const uint8_t   *before = plain_of(f, scene, t, p, made_light, look, path);
    size_t           count = values_of(p, values);
    bool             changed = false, briefly = f->brief && !p->variant && !p->toggles;
    size_t           first = briefly && count > SOFT_MAX ? SOFT_MAX : 0;
    for (size_t i = 0; i < count && before; i++) {
        if (changed && (briefly || i >= 2)) /* the two extremes are drawn in any case */
            break;
        const char *value = values[(first + i) % count];
        if (lmn_look_set(look, path, value, NULL) != LMN_OK)
            continue;
        set_other_end(look, k, p, value);
        snprintf(what, sizeof what, "%.60s: %.90s=%.90s", t->name, path, value);
        lmn_drawing *after = draw(f, scene, look, what);
        changed = changed || (after && !are_equal(before, after));
        lmn_drawing_destroy(&after);
    }
    lmn_look_destroy(&look);
    return changed;
}

static void complain(fixture *f, const kind *k, const char *technique_name, const param *p)
{
    if (is_exception(k, p))
        return;
    print_error("%s: %s.%s changes nothing\n", technique_name, k->name, p->key);
    f->mistakes++;
}

/* Is this technique to be drawn; of NULL, all of the kind? */
static bool is_wanted(const fixture *f, const kind *k, const technique *t)
{
    char both[TEXT_SIZE];
    snprintf(both, sizeof both, "%s.%s", k->name, t ? t->name : "");
    for (int i = 0; i < f->wanted_count; i++)
        if (strcmp(f->wanted[i], k->name) == 0 || strcmp(f->wanted[i], both) == 0)
            return true;
    return f->wanted_count == 0;
}

/* A parameter of the whole kind may mean nothing to some of its techniques, but it must to one. */
static void check_common(fixture *f, const kind *k, const param *p)
{
    bool changed = false;
    for (size_t n = 0; n < k->technique_count; n++)
        if (is_wanted(f, k, k->techniques[n]))
            changed = check_param(f, k, k->techniques[n], p) || changed;
    if (!changed && is_wanted(f, k, NULL))
        complain(f, k, "all techniques", p);
}

static void check_technique(fixture *f, const kind *k, const technique *t)
{
    int     drawn = f->drawn;
    clock_t begin = clock();
    for (size_t i = 0; i < t->param_count; i++)
        if (!check_param(f, k, t, &t->params[i]))
            complain(f, k, t->name, &t->params[i]);
    print_message("%s.%s: %d pictures, %.1f s of work\n", k->name, t->name, f->drawn - drawn,
                  (double)(clock() - begin) / CLOCKS_PER_SEC);
}

static void test_every_parameter(void **state)
{
    fixture *f = *state;
    for (size_t i = 0; i < KIND_COUNT; i++) {
        const kind *k = kinds[i];
        for (size_t c = 0; c < k->common_count; c++)
            check_common(f, k, &k->common[c]);
        for (size_t n = 0; n < k->technique_count; n++)
            if (is_wanted(f, k, k->techniques[n]))
                check_technique(f, k, k->techniques[n]);
    }
    print_message("%d pictures\n", f->drawn);
    assert_true(f->drawn > 0);
    assert_int_equal(f->mistakes, 0);
}

/* One part of two materials: two surfaces; above them a line. */
static void write_plate(FILE *file, double x)
{
    fprintf(file, "v %g 60 60\nv %g 60 60\nv %g 60 60\nv %g 60 90\nv %g 60 90\nv %g 60 90\n", x, x + 30, x + 60, x,
            x + 30, x + 60);
    fprintf(file, "o plate\nusemtl left\nf 4 5 2 1\nusemtl right\nf 5 6 3 2\n");
    fprintf(file, "v %g 85 60\nv %g 75 60\nl 7 8\n", x, x + 60);
}

/* A block with a round hole, on it a ball cut by a plane: operands that meet at an angle. */
static void write_solid(FILE *file, double x)
{
    fprintf(file,
            "multmatrix([[1, 0, 0, %g], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]) {\n"
            " difference() { cube(size = [40, 40, 20], center = true); cylinder($fn = 24, h = 30, r1 = 9, r2 = 12, "
            "center = true); }\n"
            " intersection() { sphere($fn = 24, r = 18); cube(size = [36, 20, 60], center = true); }\n}\n",
            x);
}

static bool add_file(lmn_scene *scene, const char *folder, const char *name, void (*write)(FILE *, double), double x,
                     lmn_error *error)
{
    char          path[128];
    lmn_load_desc load = LMN_LOAD_DESC_INIT;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    FILE *file = fopen(path, "w");
    if (!file)
        return false;
    write(file, x);
    fclose(file);
    bool done = lmn_scene_add_file(scene, path, &load, error) == LMN_OK;
    remove(path);
    return done;
}

static bool add_example(lmn_scene *scene, const char *folder, const char *name, lmn_error *error)
{
    char path[1024];
    snprintf(path, sizeof path, "%s/%s", folder, name);
    return lmn_scene_add_file(scene, path, NULL, error) == LMN_OK;
}

static int make_fixture(void **state)
{
    fixture          *f = *state;
    char              path[1024], folder[] = "/tmp/limner-XXXXXX";
    lmn_error         error = {0};
    lmn_load_desc     load = LMN_LOAD_DESC_INIT;
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    if (!mkdtemp(folder))
        return 1;
    snprintf(path, sizeof path, "%s/gearbox.stl", f->examples);
    bool done =
        lmn_scene_create(&f->scene, &error) == LMN_OK && lmn_scene_add_file(f->scene, path, &load, &error) == LMN_OK &&
        add_file(f->scene, folder, "ball.ply", write_ball, 10, &error) &&
        add_file(f->scene, folder, "other.ply", write_ball, 70, &error) &&
        add_file(f->scene, folder, "flower.obj", write_flower, -20, &error) &&
        add_file(f->scene, folder, "plate.obj", write_plate, -60, &error) &&
        lmn_scene_create(&f->solid, &error) == LMN_OK &&
        add_file(f->solid, folder, "solid.csg", write_solid, 0, &error) &&
        lmn_scene_create(&f->moving, &error) == LMN_OK && add_example(f->moving, f->examples, "fox.glb", &error) &&
        lmn_scene_create(&f->simple, &error) == LMN_OK &&
        add_file(f->simple, folder, "ball.ply", write_ball, 10, &error) &&
        add_file(f->simple, folder, "other.ply", write_ball, 70, &error) &&
        lmn_renderer_create(&f->renderer, &desc, &error) == LMN_OK;
    if (!done)
        print_error("%s: %s\n", error.file, error.message);
    rmdir(folder);
    return !done;
}

static int end_fixture(void **state)
{
    fixture *f = *state;
    lmn_scene_destroy(&f->scene);
    lmn_scene_destroy(&f->solid);
    lmn_scene_destroy(&f->simple);
    lmn_scene_destroy(&f->moving);
    lmn_renderer_destroy(&f->renderer);
    for (size_t i = 0; i < f->plain_count; i++)
        free(f->plain[i].pixels);
    return 0;
}

int main(int count, char **arguments)
{
    static fixture f;
    f.examples = count > 1 ? arguments[1] : "examples";
    f.brief = count > 2 && strcmp(arguments[2], "briefly") == 0;
    f.variants = count > 2 && strcmp(arguments[2], "variants") == 0;
    f.brief = f.brief || f.variants;
    f.wanted_count = count > 2 + f.brief ? count - 2 - f.brief : 0;
    f.wanted = arguments + count - f.wanted_count;
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_prestate_setup_teardown(test_every_parameter, make_fixture, end_fixture, &f)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
