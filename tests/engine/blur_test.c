/* Techniques of motion along the way of what moves: blur, streak-map, stretched, on boxes whose coverage is known.
 * Großmann 2011, acceptance scenes S7 and S8; rows 40, 44 to 48, 50, 52 to 57. */
#include "checked.h"

#include <dirent.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "../support/boxes.h"

enum { SIDE = 200, PIXELS = SIDE * SIDE, UNIT = SIDE / 20 };

typedef struct fixture {
    char          folder[64];
    lmn_renderer *renderer;
    lmn_scene    *fox, *morph;
} fixture;

static lmn_scene *load(const char *path)
{
    lmn_scene *s = NULL;
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_file(s, path, NULL, &error));
    return s;
}

static int set_up(void **state)
{
    static fixture    f = {.folder = "/tmp/limner-blur-XXXXXX"};
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    DO(lmn_renderer_create(&f.renderer, &desc, &error));
    f.fox = load(EXAMPLES "/fox.glb");
    f.morph = load(EXAMPLES "/morph-cube.glb");
    *state = &f;
    return mkdtemp(f.folder) ? 0 : -1;
}

/* Ends a folder of files, and of folders of files. */
static void remove_folder(const char *path)
{
    DIR *folder = opendir(path);
    for (struct dirent *entry; folder && (entry = readdir(folder));) {
        char below[512];
        if (strcmp(entry->d_name, ".") == 0 || strcmp(entry->d_name, "..") == 0)
            continue;
        snprintf(below, sizeof below, "%s/%s", path, entry->d_name);
        if (unlink(below) != 0)
            remove_folder(below);
    }
    if (folder)
        closedir(folder);
    rmdir(path);
}

static int tear_down(void **state)
{
    fixture *f = *state;
    lmn_scene_destroy(&f->fox);
    lmn_scene_destroy(&f->morph);
    lmn_renderer_destroy(&f->renderer);
    remove_folder(f->folder);
    return 0;
}

static lmn_scene *boxes(const fixture *f, const moving_box *b, int count)
{
    char path[128];
    snprintf(path, sizeof path, "%s/boxes.glb", f->folder);
    boxes_write(path, b, count);
    return load(path);
}

#define PLAIN "\"surface\": \"lit\", \"lines\": []"
#define BLUR  "\"motion\": {\"technique\": \"blur\", \"exposure\": 1}"

/* On nothing, unless the description says otherwise. */
static void draw_with(lmn_renderer *r, const lmn_scene *s, const char *rules, const lmn_draw_desc *desc, uint8_t *out)
{
    char         json[1024];
    lmn_look    *look = NULL;
    lmn_drawing *drawing = NULL;
    snprintf(json, sizeof json, "{\"version\": 1, \"rules\": [%s]}", rules);
    DO(lmn_look_parse(&look, json, "test", &error));
    DO(lmn_draw(&drawing, r, s, look, desc, &error));
    memcpy(out, lmn_drawing_pixels(drawing, NULL, NULL), 4 * (size_t)desc->width * (size_t)desc->height);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
}

static lmn_draw_desc view_at(double seconds)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    boxes_view(&desc, SIDE);
    desc.background = "none";
    desc.time_s = seconds;
    desc.time_given = true;
    return desc;
}

static void draw(const fixture *f, const lmn_scene *s, const char *rules, uint8_t *out)
{
    lmn_draw_desc desc = view_at(1);
    draw_with(f->renderer, s, rules, &desc, out);
}

static double alpha_at(const uint8_t *pixels, int x, int y)
{
    return pixels[4 * (y * SIDE + x) + 3] / 255.0;
}

/* A bar ±half[0] wide that has moved to its middle. */
static double bar_coverage(double x, double middle, double half, double moved)
{
    double low = fmin(x, x + moved), high = fmax(x, x + moved);
    return fmax(fmin(high, middle + half) - fmax(low, middle - half), 0) / fabs(moved);
}

/* --- blur ----------------------------------------------------------------------------------------------- */

static void coverage_is_the_time_that_a_bar_was_there(void **state)
{
    static const double moves[] = {6.4, -3.2, 12, 0.7};
    static const int    samples[] = {8, 16, 32, 64};
    const fixture      *f = *state;
    static uint8_t      pixels[4 * PIXELS];
    for (size_t m = 0; m < sizeof moves / sizeof *moves; m++) {
        moving_box bar = {"bar", {1, 0, 0}, {2, 6, 0.01}, {0.2, 0.4, 0.8}, {moves[m], 0, 0}, 0, -1, false};
        lmn_scene *s = boxes(f, &bar, 1);
        for (size_t k = 0; k < sizeof samples / sizeof *samples; k++) {
            char   rules[256];
            double worst = 0, wrong_colour = 0;
            snprintf(rules, sizeof rules,
                     "{" PLAIN ", \"motion\": {\"technique\": \"blur\", \"exposure\": 1, \"samples\": %d}}",
                     samples[k]);
            draw(f, s, rules, pixels);
            for (int x = 0; x < SIDE; x++) {
                double at = (x + 0.5) / UNIT - 10, covered = bar_coverage(at, 1, 2, moves[m]);
                worst = fmax(worst, fabs(alpha_at(pixels, x, SIDE / 2) - covered));
                if (alpha_at(pixels, x, SIDE / 2) > 0.2) /* of less, 8 bits know too little */
                    wrong_colour = fmax(wrong_colour, abs(pixels[4 * (SIDE / 2 * SIDE + x) + 2] - 231));
            }
            if (worst > 1.0 / samples[k] + 1.0 / 255 || wrong_colour > 3)
                fail_msg("moved by %g, %d samples: coverage off by %g, colour by %g", moves[m], samples[k], worst,
                         wrong_colour);
        }
        lmn_scene_destroy(&s);
    }
}

/* Mean of differences of alpha and colour over the pixels that either picture has something at. */
static double mean_difference(const uint8_t *a, const uint8_t *b, int *missing)
{
    double sum = 0;
    int    count = 0;
    *missing = 0;
    for (int i = 0; i < PIXELS; i++) {
        if (!a[4 * i + 3] && !b[4 * i + 3])
            continue;
        for (int k = 0; k < 4; k++) {
            double weight_a = k < 3 ? a[4 * i + 3] / 255.0 : 1, weight_b = k < 3 ? b[4 * i + 3] / 255.0 : 1;
            sum += fabs(a[4 * i + k] * weight_a - b[4 * i + k] * weight_b) / 4;
        }
        count++;
        *missing += a[4 * i + 3] < 4 && b[4 * i + 3] > 24;
    }
    return count ? sum / count : 0;
}

static void it_is_like_the_mean_of_many_pictures(void **state)
{
    const fixture *f = *state;
    static uint8_t blurred[4 * PIXELS], mean[4 * PIXELS];
    const struct {
        const lmn_scene *scene;
        const char      *clip;
        double           time, exposure, most;
    } rows[] = {{f->fox, "Run", 0.4, 0.04, 8}, {f->fox, "Run", 0.4, 0.1, 14}, {f->morph, NULL, 0.9, 0.2, 8}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        char          rules[256];
        int           missing;
        lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
        desc.width = desc.height = SIDE;
        desc.dpi = 96;
        desc.background = "none";
        desc.clip = rows[i].clip;
        desc.time_s = rows[i].time;
        desc.fit_time = desc.time_given = true;
        snprintf(rules, sizeof rules, "{" PLAIN ", \"motion\": {\"technique\": \"blur\", \"exposure\": %g}}",
                 rows[i].exposure);
        draw_with(f->renderer, rows[i].scene, rules, &desc, blurred);
        snprintf(rules, sizeof rules,
                 "{" PLAIN ", \"motion\": {\"technique\": \"accumulate\", \"times\": 64, \"exposure\": %g}}",
                 rows[i].exposure);
        draw_with(f->renderer, rows[i].scene, rules, &desc, mean);
        double off = mean_difference(blurred, mean, &missing);
        printf("blur against 64 pictures, row %zu: %.2f of 255, %d pixels missing\n", i, off, missing);
        if (off > rows[i].most || missing > 60)
            fail_msg("row %zu: blur and mean differ by %g of 255, %d pixels are missing", i, off, missing);
    }
}

static void a_bar_is_like_the_mean_of_many_pictures(void **state)
{
    const fixture   *f = *state;
    static uint8_t   blurred[4 * PIXELS], mean[4 * PIXELS];
    const moving_box bar = {"bar", {1, 0, 0}, {2, 6, 1}, {0.2, 0.4, 0.8}, {5, 3, 0}, 20, -1, false};
    int              missing;
    lmn_scene       *s = boxes(f, &bar, 1);
    draw(f, s, "{" PLAIN ", " BLUR "}", blurred);
    draw(f, s, "{" PLAIN ", \"motion\": {\"technique\": \"accumulate\", \"times\": 64, \"exposure\": 1}}", mean);
    double off = mean_difference(blurred, mean, &missing);
    printf("a bar against 64 pictures: %.2f of 255\n", off);
    assert_true(off < 2.5);
    assert_int_equal(missing, 0);
    lmn_scene_destroy(&s);
}

/* What stands beside and behind it shows where it is not, and never in it. */
static void nothing_else_is_smeared(void **state)
{
    const fixture   *f = *state;
    static uint8_t   pixels[4 * PIXELS], alone[4 * PIXELS];
    const moving_box scene[] = {{"bar", {1, 0, 0}, {2, 6, 0.01}, {0, 0, 1}, {6, 0, 0}, 0, -1, false},
                                {"wall", {0, 0, -3}, {9, 9, 0.01}, {1, 0, 0}, {0, 0, 0}, 0, -1, false}};
    lmn_scene       *s = boxes(f, scene, 2);
    lmn_draw_desc    desc = view_at(1);
    draw_with(f->renderer, s, "{" PLAIN ", " BLUR "}", &desc, pixels);
    desc.select = "bar";
    draw_with(f->renderer, s, "{" PLAIN ", " BLUR "}", &desc, alone);
    for (int x = 12; x < SIDE - 12; x++) {
        const uint8_t *p = &pixels[4 * (SIDE / 2 * SIDE + x)];
        double         covered = alpha_at(alone, x, SIDE / 2);
        assert_true(fabs(p[0] / 255.0 - (1 - covered)) < 0.01);
        assert_true(fabs(p[2] / 255.0 - covered) < 0.01);
    }
    lmn_scene_destroy(&s);
}

/* The nearer one is over the other, and both are what they are alone. */
static void crossing_movers_have_their_own_directions(void **state)
{
    const fixture *f = *state;
    static uint8_t both[4 * PIXELS], level[4 * PIXELS], upright[4 * PIXELS];
    const char    *rules = "{" PLAIN ", " BLUR "}";
    /* Of one object whose whole also moves, and of two. */
    for (int whole = 0; whole < 2; whole++) {
        const moving_box scene[] = {
            {"root", {0, 0, -9}, {0.2, 0.2, 0.01}, {1, 1, 1}, {0.05, 0, 0}, 0, -1, false},
            {"level", {1, 0, whole ? 11 : 2}, {2, 1, 0.01}, {0, 1, 0}, {6, 0, 0}, 0, whole ? 0 : -1, false},
            {"upright", {-1, 2, whole ? 9 : 0}, {1, 2, 0.01}, {0, 0, 1}, {0, 6, 0}, 0, whole ? 0 : -1, false}};
        lmn_scene    *s = boxes(f, scene, 3);
        lmn_draw_desc desc = view_at(1);
        double        off = 0;
        int           darker = 0, count = 0;
        desc.select = "level, upright";
        draw_with(f->renderer, s, rules, &desc, both);
        desc.select = "level";
        draw_with(f->renderer, s, rules, &desc, level);
        desc.select = "upright";
        draw_with(f->renderer, s, rules, &desc, upright);
        for (int i = 0; i < PIXELS; i++) {
            double a = level[4 * i + 3] / 255.0, b = upright[4 * i + 3] / 255.0, c = both[4 * i + 3] / 255.0;
            darker += c < fmax(a, b) - 0.04;
            off += a + b > 0 ? fabs(c - (a + b - a * b)) : 0;
            count += a + b > 0;
        }
        printf("crossing movers of %s: %.4f off, %d of %d pixels darker\n", whole ? "one object" : "two", off / count,
               darker, count);
        /* Of one object, what a nearer part hides now is not known to have been anywhere. */
        assert_true(darker <= (whole ? count / 5 : 0));
        assert_true(off / count < (whole ? 0.06 : 0.01));
        lmn_scene_destroy(&s);
    }
}

static void what_rests_keeps_every_bit(void **state)
{
    static const char *const techniques[] = {"blur", "streak-map", "stretched"};
    const fixture           *f = *state;
    static uint8_t           with[4 * PIXELS], without[4 * PIXELS];
    const moving_box         scene[] = {{"still", {2, 1, 0}, {3, 2, 1}, {0.3, 0.5, 0.1}, {0, 0, 0}, 30, -1, false},
                                        {"moves", {-6, -6, 0}, {1, 1, 1}, {0.8, 0.5, 0.1}, {2, 0, 0}, 0, -1, false}};
    lmn_scene               *s = boxes(f, scene, 2);
    lmn_draw_desc            desc = view_at(0); /* before the clip begins nothing has moved */
    const char              *lines = "\"surface\": \"lit\", \"lines\": \"discontinuity\"";
    for (size_t i = 0; i < sizeof techniques / sizeof *techniques; i++) {
        char rules[256], plain[128];
        snprintf(rules, sizeof rules, "{%s, \"motion\": {\"technique\": \"%s\", \"exposure\": 1}}", lines,
                 techniques[i]);
        snprintf(plain, sizeof plain, "{%s}", lines);
        desc.time_s = 0;
        draw_with(f->renderer, s, rules, &desc, with);
        draw_with(f->renderer, s, plain, &desc, without);
        assert_memory_equal(with, without, sizeof with);
        desc.time_s = 1;
        draw_with(f->renderer, s, rules, &desc, with);
        draw_with(f->renderer, s, plain, &desc, without);
        assert_memory_equal(with, without, 4 * PIXELS / 2); /* the upper half; below, one moves */
        assert_memory_not_equal(with, without, sizeof with);
    }
    lmn_scene_destroy(&s);
}

/* In front of a wall, behind it, and through a slit. */
static void walls_hide_what_is_behind(void **state)
{
    const fixture   *f = *state;
    static uint8_t   pixels[4 * PIXELS], alone[4 * PIXELS];
    const moving_box scene[] = {{"bar", {2, 0, 0}, {2, 6, 0.5}, {0, 0, 1}, {8, 0, 0}, 0, -1, false},
                                {"left", {-6, 0, 3}, {4, 8, 0.1}, {1, 0, 0}, {0, 0, 0}, 0, -1, false},
                                {"right", {6, 0, 3}, {6, 8, 0.1}, {1, 0, 0}, {0, 0, 0}, 0, -1, false}};
    lmn_scene       *s = boxes(f, scene, 3);
    lmn_draw_desc    desc = view_at(1);
    draw_with(f->renderer, s, "{" PLAIN ", " BLUR "}", &desc, pixels);
    desc.select = "bar";
    draw_with(f->renderer, s, "{" PLAIN ", " BLUR "}", &desc, alone);
    for (int x = 0; x < SIDE; x++) {
        const uint8_t *p = &pixels[4 * (SIDE / 2 * SIDE + x)];
        if (x > 2 && x < SIDE - 2 && (x < 77 || x > 103))
            assert_true(p[0] == 255 && p[2] == 0);
        if (x > 83 && x < 97)
            assert_true(fabs(alpha_at(pixels, x, SIDE / 2) - alpha_at(alone, x, SIDE / 2)) < 0.01);
    }
    lmn_scene_destroy(&s);
}

/* A bright spot on a dark bar: where it went, the bar is brighter when glints stay. */
static void glints_stay_along_the_way(void **state)
{
    const fixture   *f = *state;
    static uint8_t   none[4 * PIXELS], some[4 * PIXELS], all[4 * PIXELS];
    const moving_box scene[] = {{"bar", {2, 0, 0}, {6, 2, 0.1}, {0.05, 0.05, 0.05}, {4, 0, 0}, 0, -1, false},
                                {"glint", {2, 0, 0.2}, {0.3, 0.3, 0.01}, {1, 1, 1}, {0, 0, 0}, 0, 0, false}};
    lmn_scene       *s = boxes(f, scene, 2);
    draw(f, s, "{" PLAIN ", " BLUR "}", none);
    draw(f, s, "{" PLAIN ", \"motion\": {\"technique\": \"blur\", \"exposure\": 1, \"glints\": 0.4}}", some);
    draw(f, s, "{" PLAIN ", \"motion\": {\"technique\": \"blur\", \"exposure\": 1, \"glints\": 1}}", all);
    for (int x = 106; x < 136; x++) { /* where it went over the bar; it is at 140 now */
        size_t at = 4 * (size_t)(SIDE / 2 * SIDE + x);
        assert_true(some[at] > none[at] + 10 && all[at] > some[at] + 10 && all[at] > 225);
        assert_int_equal(all[at + 3], none[at + 3]);
    }
    size_t beside = 4 * (size_t)((SIDE / 2 - 12) * SIDE + 120);
    assert_true(abs(all[beside] - none[beside]) <= 1);
    lmn_scene_destroy(&s);
}

/* --- the stretched surface ------------------------------------------------------------------------------ */

/* A folder of shaders like the engine's, but for one. */
static void link_entries(const char *from, const char *to, const char *but)
{
    char path[1024], linked[1024];
    DIR *source = opendir(from);
    assert_non_null(source);
    assert_int_equal(mkdir(to, 0700), 0);
    for (struct dirent *entry; (entry = readdir(source));) {
        snprintf(path, sizeof path, "%s/%s", to, entry->d_name);
        snprintf(linked, sizeof linked, "%s/%s", from, entry->d_name);
        if (entry->d_name[0] != '.' && strcmp(entry->d_name, but) != 0)
            assert_int_equal(symlink(linked, path), 0);
    }
    closedir(source);
}

static void shaders_with(const char *folder, const char *room, const char *name, const char *content)
{
    char path[512], from[512];
    link_entries(LIMNER_SOURCE_DIR "/src", folder, room);
    snprintf(path, sizeof path, "%s/%s", folder, room);
    snprintf(from, sizeof from, LIMNER_SOURCE_DIR "/src/%s", room);
    link_entries(from, path, name);
    snprintf(path, sizeof path, "%s/%s/%s", folder, room, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(content, file);
    assert_int_equal(fclose(file), 0);
}

/* Where the stretched surface is, and nothing else that finds where things were. */
static const char *const area_shader = "layout(location = 0) out vec4 out_0;\n"
                                       "void main()\n"
                                       "{\n"
                                       "    vec4 swept = texelFetch(t_stretched, ivec2(gl_FragCoord.xy), 0);\n"
                                       "    if (swept.w <= 0.0)\n"
                                       "        discard;\n"
                                       "    out_0 = vec4(1.0);\n"
                                       "    gl_FragDepth = swept.z;\n"
                                       "}\n";

/* S8: it is exactly where the cube was at any time, as far as pixels can say. */
static void the_stretched_cube_has_no_holes(void **state)
{
    const fixture    *f = *state;
    static uint8_t    area[4 * PIXELS], one[4 * PIXELS];
    static bool       was[PIXELS];
    char              folder[128];
    lmn_renderer     *r = NULL;
    lmn_renderer_desc rd = LMN_RENDERER_DESC_INIT;
    snprintf(folder, sizeof folder, "%s/shaders", f->folder);
    shaders_with(folder, "motion", "blur.frag", area_shader);
    const char *before = getenv("LIMNER_SHADER_DIR");
    char       *kept = before ? strdup(before) : NULL;
    setenv("LIMNER_SHADER_DIR", folder, 1);
    DO(lmn_renderer_create(&r, &rd, &error));
    for (int i = 0; i < 3; i++) {
        const moving_box cube = {"cube", {2, 2, 0}, {2, 2, 2}, {0.5, 0.5, 0.5}, {6, 6 - 4 * i, i}, 25.0 * i, -1, false};
        lmn_scene       *s = boxes(f, &cube, 1);
        lmn_draw_desc    desc = view_at(1);
        int              holes = 0, beyond = 0, count = 0;
        desc.eye[0] = 600; /* three sides are seen */
        desc.eye[1] = 500;
        draw_with(r, s, "{" PLAIN ", " BLUR "}", &desc, area);
        memset(was, 0, sizeof was);
        for (int k = 0; k <= 64; k++) {
            desc.time_s = k / 64.0;
            draw_with(f->renderer, s, "{" PLAIN "}", &desc, one);
            for (int p = 0; p < PIXELS; p++)
                was[p] = was[p] || one[4 * p + 3];
        }
        for (int p = 0; p < PIXELS; p++) {
            holes += was[p] && !area[4 * p + 3];
            beyond += !was[p] && area[4 * p + 3];
            count += was[p];
        }
        printf("stretched cube %d: %d pixels, %d missing, %d too many\n", i, count, holes, beyond);
        assert_true(count > 2000 && holes <= 4 && beyond <= count / 50);
        lmn_scene_destroy(&s);
    }
    lmn_renderer_destroy(&r);
    if (kept)
        setenv("LIMNER_SHADER_DIR", kept, 1);
    else
        unsetenv("LIMNER_SHADER_DIR");
    free(kept);
}

/* A sheet has a border that no patch closes: its pixels are found by where it is now. It moves along itself, and then
 * also a little towards the viewer, and away. */
static void open_surfaces_have_no_holes(void **state)
{
    static const double towards[] = {0, 20, -20};
    const fixture      *f = *state;
    static uint8_t      pixels[4 * PIXELS];
    for (size_t i = 0; i < sizeof towards / sizeof *towards; i++) {
        const moving_box sheet = {"sheet", {2, 0, 0}, {1, 4, 0.01}, {0.5, 0.5, 0.5}, {8, 0, towards[i]}, 0, -1, true};
        lmn_scene       *s = boxes(f, &sheet, 1);
        double           worst = 0;
        draw(f, s, "{" PLAIN ", " BLUR "}", pixels);
        for (int x = 0; x < SIDE; x++)
            for (int y = SIDE / 2 - 30; y < SIDE / 2 + 30; y++)
                worst = fmax(worst, fabs(alpha_at(pixels, x, y) - bar_coverage((x + 0.5) / UNIT - 10, 2, 1, 8)));
        printf("a sheet that comes nearer by %g: coverage off by %.3f\n", towards[i], worst);
        assert_true(worst < 1.0 / 32 + (towards[i] != 0 ? 0.02 : 1.0 / 255));
        lmn_scene_destroy(&s);
    }
}

/* Writes a file with the text; its path is lent. */
static const char *written(const fixture *f, const char *name, const char *content)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", f->folder, name);
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(content, file);
    assert_int_equal(fclose(file), 0);
    return path;
}

/* A camera 1000 in front that moves to the right by 8 within a second; base64 of 0, 1, (−8, 0, 1000), (0, 0, 1000). */
static const char *const camera_file =
    "{\"asset\": {\"version\": \"2.0\"}, \"buffers\": [{\"byteLength\": 32, \"uri\": "
    "\"data:application/octet-stream;base64,AAAAAAAAgD8AAADBAAAAAAAAekQAAAAAAAAAAAAAekQ=\"}],\n"
    "\"bufferViews\": [{\"buffer\": 0, \"byteLength\": 32}], \"accessors\": [{\"bufferView\": 0, \"componentType\": "
    "5126, \"count\": 2, \"type\": \"SCALAR\", \"min\": [0], \"max\": [1]}, {\"bufferView\": 0, \"byteOffset\": 8, "
    "\"componentType\": 5126, \"count\": 2, \"type\": \"VEC3\"}],\n"
    "\"cameras\": [{\"type\": \"perspective\", \"perspective\": {\"yfov\": 0.019999333373, \"znear\": 1}}],\n"
    "\"nodes\": [{\"name\": \"eye\", \"camera\": 0, \"translation\": [0, 0, 1000]}], \"scenes\": [{\"nodes\": [0]}], "
    "\"scene\": 0,\n"
    "\"animations\": [{\"name\": \"pan\", \"samplers\": [{\"input\": 0, \"output\": 1}], \"channels\": [{\"sampler\": "
    "0, \"target\": {\"node\": 0, \"path\": \"translation\"}}]}]}\n";

/* Everything moves to the left then: a mesh, and a solid, which has no vertices. */
static void cameras_move_everything(void **state)
{
    const fixture   *f = *state;
    static uint8_t   pixels[4 * PIXELS];
    const moving_box bar = {"bar", {1, 0, 0}, {2, 6, 1}, {0.2, 0.4, 0.8}, {0, 0, 0}, 0, -1, false};
    for (int solid = 0; solid < 2; solid++) {
        lmn_scene *s = NULL;
        if (solid) {
            s = load(
                written(f, "bar.csg",
                        "difference() { multmatrix([[1,0,0,1],[0,1,0,0],[0,0,1,0],[0,0,0,1]]) { cube(size = [4, 12, "
                        "2], center = true); } multmatrix([[1,0,0,0],[0,1,0,5],[0,0,1,0],[0,0,0,1]]) { cube(size "
                        "= [1, 1, 9], center = true); } }"));
        } else {
            s = boxes(f, &bar, 1);
        }
        DO(lmn_scene_add_file(s, written(f, "camera.gltf", camera_file), NULL, &error));
        lmn_draw_desc desc = view_at(1);
        double        worst = 0;
        desc.eye_given = false;
        desc.camera = "eye";
        desc.clip = "pan";
        draw_with(f->renderer, s, "{" PLAIN ", " BLUR "}", &desc, pixels);
        for (int x = 0; x < SIDE; x++)
            worst = fmax(worst, fabs(alpha_at(pixels, x, SIDE / 2) - bar_coverage((x + 0.5) / UNIT - 10, 1, 2, -8)));
        printf("a camera that moves, %s: coverage off by %.3f\n", solid ? "a solid" : "a mesh", worst);
        assert_true(worst < 1.0 / 32 + 0.02); /* the sides of the bar are seen a little */
        lmn_scene_destroy(&s);
    }
}

/* --- streak-map ----------------------------------------------------------------------------------------- */

/* The direction along which a picture changes least, degrees. */
static double direction_of(const uint8_t *pixels, int low_x, int high_x, int low_y, int high_y)
{
    double xx = 0, yy = 0, xy = 0;
    for (int y = low_y; y < high_y; y++)
        for (int x = low_x; x < high_x; x++) {
            double dx = alpha_at(pixels, x + 1, y) - alpha_at(pixels, x - 1, y),
                   dy = alpha_at(pixels, x, y - 1) - alpha_at(pixels, x, y + 1);
            xx += dx * dx;
            yy += dy * dy;
            xy += dx * dy;
        }
    return 0.5 * atan2(2 * xy, xx - yy) * (180 / 3.14159265358979323846) + 90;
}

static void strokes_lie_along_the_motion(void **state)
{
    static const double angles[] = {0, 20, 37, 75, 120};
    const fixture      *f = *state;
    static uint8_t      pixels[4 * PIXELS];
    for (size_t i = 0; i < sizeof angles / sizeof *angles; i++) {
        double     c = cos(angles[i] * 3.14159265358979323846 / 180), d = sin(angles[i] * 3.14159265358979323846 / 180);
        moving_box bar = {"bar", {6 * c, 6 * d, 0}, {1.5, 8, 0.01}, {0, 0, 0}, {14 * c, 14 * d, 0}, angles[i], -1,
                          false};
        lmn_scene *s = boxes(f, &bar, 1);
        draw(f, s,
             "{" PLAIN ", \"motion\": {\"technique\": \"streak-map\", \"exposure\": 1, \"length\": 1, \"scale\": 2.5, "
             "\"width\": 3}}",
             pixels);
        double off = remainder(direction_of(pixels, 70, 120, 70, 120) - angles[i], 180);
        printf("strokes of a motion at %g degrees: %.2f degrees off\n", angles[i], off);
        assert_true(fabs(off) < 2);
        lmn_scene_destroy(&s);
    }
}

/* Another rule's technique that reads four steps of the past changes nothing for one that reads the whole. */
static void other_rules_steps_change_nothing(void **state)
{
    const fixture *f = *state;
    static uint8_t alone[4 * PIXELS], beside[4 * PIXELS];
    lmn_draw_desc  desc = LMN_DRAW_DESC_INIT;
    const char    *rule = "{" PLAIN ", \"motion\": {\"technique\": \"blur\", \"exposure\": 0.1}}";
    char           rules[512];
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    desc.background = "none";
    desc.clip = "Run";
    desc.time_s = 0.4;
    desc.fit_time = true;
    draw_with(f->renderer, f->fox, rule, &desc, alone);
    snprintf(rules, sizeof rules,
             "%s, {\"select\": \"nothing\", " PLAIN ", \"motion\": {\"technique\": \"streaks\", \"path\": "
             "\"winding\", \"exposure\": 0.1}}",
             rule);
    draw_with(f->renderer, f->fox, rules, &desc, beside);
    assert_memory_equal(alone, beside, sizeof alone);
}

/* Of each column, how much is inked. */
static void inks_of(const uint8_t *pixels, double out[SIDE])
{
    for (int x = 0; x < SIDE; x++) {
        out[x] = 0;
        for (int y = 30; y < SIDE - 30; y++)
            out[x] += alpha_at(pixels, x, y) / (SIDE - 60);
    }
}

static void tone_is_the_coverage(void **state)
{
    static const int samples[] = {8, 16, 32, 64};
    const fixture   *f = *state;
    static uint8_t   pixels[4 * PIXELS];
    static double    ink[4][SIDE];
    const moving_box bar = {"bar", {4, 0, 0}, {2, 9, 0.01}, {0, 0, 0}, {12, 0, 0}, 0, -1, false};
    lmn_scene       *s = boxes(f, &bar, 1);
    double           worst[3] = {0, 0, 0}, off = 0;
    int              count = 0;
    for (int k = 0; k < 4; k++) {
        char rules[256];
        snprintf(rules, sizeof rules,
                 "{" PLAIN ", \"motion\": {\"technique\": \"streak-map\", \"exposure\": 1, \"tones\": 6, \"samples\": "
                 "%d}}",
                 samples[k]);
        draw(f, s, rules, pixels);
        inks_of(pixels, ink[k]);
    }
    for (int x = 0; x < SIDE; x++) {
        double covered = bar_coverage((x + 0.5) / UNIT - 10, 4, 2, 12);
        off += covered > 0 ? fabs(ink[2][x] - covered) : 0;
        count += covered > 0;
        for (int k = 0; k < 3; k++)
            worst[k] = fmax(worst[k], fabs(ink[k][x] - ink[3][x]));
    }
    printf("ink off by %.3f; steps of 8, 16, 32 samples: %.3f %.3f %.3f\n", off / count, worst[0], worst[1], worst[2]);
    assert_true(off / count < 0.05);
    assert_true(worst[0] > 0.04 && worst[1] < worst[0] && worst[2] < 0.025);
    lmn_scene_destroy(&s);
}

static void over_leaves_objects_whole(void **state)
{
    const fixture   *f = *state;
    static uint8_t   with[4 * PIXELS], without[4 * PIXELS];
    const moving_box bar = {"bar", {4, 0, 0}, {2, 6, 1}, {0.2, 0.4, 0.8}, {9, 2, 0}, 10, -1, false};
    lmn_scene       *s = boxes(f, &bar, 1);
    int              behind = 0;
    draw(f, s, "{" PLAIN ", \"motion\": {\"technique\": \"streak-map\", \"exposure\": 1, \"over\": true}}", with);
    draw(f, s, "{" PLAIN "}", without);
    for (int i = 0; i < PIXELS; i++) {
        if (without[4 * i + 3] == 255)
            assert_memory_equal(&with[4 * i], &without[4 * i], 4);
        behind += !without[4 * i + 3] && with[4 * i + 3] > 128;
    }
    assert_true(behind > 300);
    lmn_scene_destroy(&s);
}

/* --- stretched ------------------------------------------------------------------------------------------ */

static void trails_fade_into_the_past(void **state)
{
    static const double fades[] = {0.8, 1, 3};
    const fixture      *f = *state;
    static uint8_t      pixels[4 * PIXELS], without[4 * PIXELS];
    const moving_box    bar = {"bar", {4, 0, 0}, {2, 6, 0.01}, {0.2, 0.4, 0.8}, {10, 0, 0}, 0, -1, false};
    lmn_scene          *s = boxes(f, &bar, 1);
    draw(f, s, "{" PLAIN "}", without);
    for (size_t i = 0; i < sizeof fades / sizeof *fades; i++) {
        char   rules[256];
        double worst = 0;
        snprintf(rules, sizeof rules,
                 "{" PLAIN ", \"motion\": {\"technique\": \"stretched\", \"exposure\": 1, \"opacity\": 0.8, \"fade\": "
                 "%g}}",
                 fades[i]);
        draw(f, s, rules, pixels);
        for (int x = 0; x < SIDE; x++) {
            double at = (x + 0.5) / UNIT - 10, ago = (2 - at) / 10; /* when it was here last */
            if (at > 2)
                assert_memory_equal(&pixels[4 * (SIDE / 2 * SIDE + x)], &without[4 * (SIDE / 2 * SIDE + x)], 4);
            else if (ago < 1)
                worst = fmax(worst, fabs(alpha_at(pixels, x, SIDE / 2) - 0.8 * pow(1 - ago, fades[i])));
            if (at < 2 && x > 0)
                assert_true(alpha_at(pixels, x, SIDE / 2) >= alpha_at(pixels, x - 1, SIDE / 2));
        }
        printf("a trail with fade %g: off by %.3f\n", fades[i], worst);
        assert_true(worst < 0.05);
    }
    lmn_scene_destroy(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(coverage_is_the_time_that_a_bar_was_there),
        cmocka_unit_test(a_bar_is_like_the_mean_of_many_pictures),
        cmocka_unit_test(it_is_like_the_mean_of_many_pictures),
        cmocka_unit_test(nothing_else_is_smeared),
        cmocka_unit_test(crossing_movers_have_their_own_directions),
        cmocka_unit_test(what_rests_keeps_every_bit),
        cmocka_unit_test(walls_hide_what_is_behind),
        cmocka_unit_test(glints_stay_along_the_way),
        cmocka_unit_test(the_stretched_cube_has_no_holes),
        cmocka_unit_test(open_surfaces_have_no_holes),
        cmocka_unit_test(cameras_move_everything),
        cmocka_unit_test(strokes_lie_along_the_motion),
        cmocka_unit_test(other_rules_steps_change_nothing),
        cmocka_unit_test(tone_is_the_coverage),
        cmocka_unit_test(over_leaves_objects_whole),
        cmocka_unit_test(trails_fade_into_the_past),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
