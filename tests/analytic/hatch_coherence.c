/* hatch from frame to frame, from path to path and on unusual models: strokes stay on the surface, nothing pops,
 * all ways of drawing give one picture. Seed 001, rows EX-09, IM-06, IM-26, IM-27. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "hatch_truth.h"
#include "picture.h"

static const double pi = 3.14159265358979323846;

#define WIDE "\"scale\":12,\"width\":3"

static bool model_shot(shot *out, const char *look, const shot_view *view)
{
    shape s = {0};
    hatch_model(&s);
    bool ok = shot_of_shape(out, &s, "model.glb", look, NULL, view);
    shape_release(&s);
    return ok;
}

static shot_view view_at(double degrees, double distance)
{
    double angle = degrees * pi / 180;
    return (shot_view){.width = 240,
                       .height = 192,
                       .eye = {distance * sin(angle), 0.35 * distance, distance * cos(angle)},
                       .up = {0, 1, 0}};
}

/* --- frames --------------------------------------------------------------------------------------------- */

typedef struct motion {
    const char *what;
    double      turn, approach, light; /* degrees, share, degrees a frame */
} motion;

static const motion motions[] = {
    {"turning by 0.5 degrees", 0.5, 0, 0}, {"approaching by 1 %", 0, 0.01, 0}, {"light turning by 1 degree", 0, 0, 1}};

/* Lights are given as the viewer sees them; this one stays where it is. */
static dvec seen_from(const shot_view *view, dvec direction)
{
    dvec back = dvec_unit(dvec_sub(view->eye, view->target)), right = dvec_unit(dvec_cross(view->up, back)),
         up = dvec_cross(back, right);
    return dvec_of(dvec_dot(right, direction), dvec_dot(up, direction), dvec_dot(back, direction));
}

static hatch_change largest_change(const motion *m, const char *settings, int frames)
{
    hatch_change most = {.correlation = 1};
    shot         before, now = {0};
    for (int k = 0; k < frames; k++) {
        char      light[96];
        shot_view view = view_at(30 + m->turn * k, 7 * pow(1 - m->approach, k));
        double    angle = (20 + m->light * k) * pi / 180;
        dvec      to_light = seen_from(&view, dvec_of(sin(angle), 0.6, cos(angle)));
        snprintf(light, sizeof light, "%.9f,%.9f,%.9f", to_light.x, to_light.y, to_light.z);
        before = now;
        memset(&now, 0, sizeof now);
        if (model_shot(&now, hatch_look(light, "", "%s", settings), &view) && before.picture) {
            hatch_change c = hatch_compare(&now, &before);
            most.changed = fmax(most.changed, c.changed);
            most.mean = fmax(most.mean, c.mean);
            most.block = fmax(most.block, c.block);
            most.correlation = fmin(most.correlation, c.correlation);
            most.pixels += c.pixels;
        }
        shot_release(&before);
    }
    shot_release(&now);
    return most;
}

/* Smoothed, a pixel changes by more than a quarter where an edge moves by about as much of a pixel. When the viewer
 * turns by half a degree or comes nearer by a hundredth, rates on the page change by a hundredth or two, and lines
 * of 3 px get wider or thinner by 3 px · ln 2 · 0.02 = 0.04 px: only tips, and places where planes hand over, may
 * change as much: 0.3 % of what is seen, and twice that where patches have borders. With the light, darkness
 * changes by 0.0175 at most, which is all the ink there is to change pixels by a quarter with: 7 % if it were all
 * in new lines, and a tenth of that when lines only grow. */
static void frames(void)
{
    static const struct {
        const char *what, *settings;
        int         frames;
        double      limit;
    } rows[] = {
        {"by number, endless", "\"length\":0,\"wobble\":0,\"uneven\":0,\"loose\":0,\"series\":1," WIDE, 2, 0.003},
        {"by width, endless",
         "\"length\":0,\"wobble\":0,\"uneven\":0,\"loose\":0,\"series\":1,\"tone_by\":\"width\",\"scale\":12", 2,
         0.003},
        {"by number, strokes", WIDE, 2, 0.003},
        {"by number, strokes, curvature", "\"coordinates\":\"curvature\"," WIDE, 2, 0.006},
        {"by number, strokes, lapped", "\"coordinates\":\"lapped\"," WIDE, 2, 0.006},
        {"by width, strokes", "\"tone_by\":\"width\",\"scale\":12", 2, 0.003},
    };
    for (size_t r = 0; r < sizeof rows / sizeof *rows; r++)
        for (int m = 0; m < (rows[r].limit > 0.003 ? 2 : 3); m++) {
            hatch_change c = largest_change(&motions[m], rows[r].settings, rows[r].frames);
            check_at_most("EX-09", c.changed, m == 2 ? 0.007 : rows[r].limit,
                          "%s, %s: fraction of pixels that change by more than a quarter", rows[r].what,
                          motions[m].what);
            check_at_most("EX-09", c.block, 0.06,
                          "  largest change of the ink of 16 x 16 px (correlation %.3f, %d pixels)", c.correlation,
                          c.pixels);
        }
}

/* Larger steps, against lines that are fixed to the picture (the shower door). */
static void shower_door(void)
{
    static const motion      far[] = {{"turning by 3 degrees", 3, 0, 0}, {"approaching by 6 %", 0, 0.06, 0}};
    static const char *const coordinates[] = {"axes", "triplanar", "curvature"};
    for (int m = 0; m < 2; m++) {
        hatch_change door = largest_change(&far[m], "\"coordinates\":\"screen\"," WIDE, 2);
        for (int k = 0; k < 3; k++) {
            char settings[160];
            snprintf(settings, sizeof settings, "\"coordinates\":\"%s\"," WIDE, coordinates[k]);
            hatch_change c = largest_change(&far[m], settings, 2);
            check_at_most("EX-09", c.changed, 0.25 * door.changed,
                          "%s, %s: fraction of pixels that change, against a quarter of that on the screen",
                          coordinates[k], far[m].what);
            check_at_least("EX-09", c.correlation, 0.9, "  correlation of the frames (on the screen %.3f)",
                           door.correlation);
        }
    }
}

/* A wall that grows on the page by an octave, one frame at a time: lines and strokes get their names and their
 * positions from the octave that brought them, and keep them. Nothing changes all at once where one octave takes over
 * from another. */
static void octaves(void)
{
    enum { STEPS = 28 };
    static const struct {
        const char *what, *settings;
    } rows[] = {
        {"by number, strokes", "\"series\":1,\"loose\":0.5,\"scale\":12,\"width\":3,\"length\":50,\"wobble\":0.2"},
        {"by width, strokes",
         "\"series\":1,\"loose\":0.5,\"tone_by\":\"width\",\"scale\":12,\"length\":50,\"wobble\":0.2"},
    };
    for (int r = 0; r < 2; r++) {
        double most = 0, mean = 0, block = 0, sum = 0;
        shot   before, now = {0};
        for (int k = 0; k <= STEPS; k++) {
            shape     s = {0};
            shot_view view = hatch_front(160, 1.9 * pow(2, -(double)k / STEPS));
            view.without_maps = false;
            hatch_wall(&s, 3, 0);
            before = now;
            memset(&now, 0, sizeof now);
            if (shot_of_shape(&now, &s, "wall.glb",
                              hatch_look("0,0,1", "", "\"shadow\":0.7,\"light\":0.7,%s", rows[r].settings), NULL,
                              &view) &&
                before.picture) {
                hatch_change c = hatch_compare(&now, &before);
                most = fmax(most, c.changed);
                mean = fmax(mean, c.mean);
                block = fmax(block, c.block);
                sum += c.mean / STEPS;
            }
            shot_release(&before);
            shape_release(&s);
        }
        shot_release(&now);
        check_at_most(
            "EX-09", most, 0.02,
            "%s, an octave in %d steps of 2.5 %%: largest fraction of pixels that change by more than a quarter",
            rows[r].what, STEPS);
        check_at_most("EX-09", mean, 3 * sum, "  largest mean change, against three times that of all steps");
        check_at_most("EX-09", block, 0.15, "  largest change of the ink of 16 x 16 px, 0.06 a per cent");
    }
}

/* What wavers and what is uneven goes with the object: seen in parallel, from a position that is a whole number of
 * pixels aside, the model's picture is the same, moved. */
static void fixed(void)
{
    static const char *const settings[] = {
        "\"wobble\":0.6,\"uneven\":0,\"length\":0,\"series\":1,\"tone_by\":\"width\"",
        "\"wobble\":0,\"uneven\":0.8,\"length\":0,\"series\":1,\"tone_by\":\"width\"",
        "\"wobble\":0.6,\"uneven\":0.8",
        "\"wobble\":0.6,\"uneven\":0.8,\"coordinates\":\"triplanar\"",
        "\"wobble\":0.6,\"uneven\":0.8,\"coordinates\":\"lapped\"",
        "\"wobble\":0.6,\"uneven\":0.8,\"coordinates\":\"screen\""};
    enum { SIDE = 192, ASIDE = 24 };
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
        shot_view view = hatch_front(SIDE, 2), moved;
        shot      a, b;
        int       apart = 0, inside = 0;
        view.without_maps = false;
        moved = view;
        moved.eye.x = moved.target.x = ASIDE * 4.0 / SIDE;
        const char *look = hatch_look("0.5,0.6,0.6", "", "%s", settings[k]);
        bool        ok = model_shot(&a, look, &view);
        if (model_shot(&b, look, &moved) && ok)
            for (int y = 0; y < SIDE; y++)
                for (int x = 0; x + ASIDE < SIDE; x++) {
                    int then = y * SIDE + x + ASIDE, now = y * SIDE + x;
                    if (isinf(a.depth[then]) || isinf(b.depth[now]))
                        continue;
                    inside++;
                    apart += abs(a.picture[4 * then] - b.picture[4 * now]) > 16;
                }
        double fraction = inside ? (double)apart / inside : 1;
        if (strstr(settings[k], "screen"))
            check_at_least("IM-27", fraction, 0.05,
                           "%s: fraction of pixels that are others when the viewer moves aside", settings[k]);
        else
            check_at_most("IM-27", fraction, 0.005, "%s: the same", settings[k]);
        shot_release(&a);
        shot_release(&b);
    }
}

/* --- paths ---------------------------------------------------------------------------------------------- */

static double fraction_apart(const shot *a, const shot *b, int tolerance)
{
    int apart = 0, inside = 0;
    for (int i = 0; i < a->width * a->height; i++) {
        if (isinf(a->depth[i]))
            continue;
        inside++;
        apart += abs(a->picture[4 * i] - b->picture[4 * i]) > tolerance;
    }
    return inside ? (double)apart / inside : 1;
}

static void paths(void)
{
    static const char *const settings[] = {"\"tone_by\":\"number\"",        "\"tone_by\":\"width\",\"length\":0",
                                           "\"coordinates\":\"triplanar\"", "\"coordinates\":\"screen\"",
                                           "\"coordinates\":\"lapped\"",    "\"inks\":\"cmyk\",\"texture\":1"};
    shot_view                view = view_at(30, 7), es = view;
    es.es = true;
    for (size_t k = 0; k < sizeof settings / sizeof *settings; k++) {
        const char *forward = hatch_look("0.5,0.6,0.6", "\"layers\":{\"technique\":\"front\",\"shading\":\"forward\"},",
                                         "%s", settings[k]);
        const char *deferred = hatch_look(
            "0.5,0.6,0.6", "\"layers\":{\"technique\":\"front\",\"shading\":\"deferred\"},", "%s", settings[k]);
        shot first, later, other, again;
        bool ok = model_shot(&first, forward, &view);
        ok = model_shot(&other, forward, &es) && ok;
        ok = model_shot(&later, deferred, &view) && ok;
        if (model_shot(&again, forward, &view) && ok) {
            check_at_most("deferred", fraction_apart(&first, &later, 8), 0.003,
                          "%s, forward against deferred: fraction of pixels more than 8 levels apart", settings[k]);
            check_at_most("ES", fraction_apart(&first, &other, 8), 0.003, "  GL against ES: the same");
            check_at_most("same", shot_differing(&first, &again, 0), 0, "  twice: values that differ");
        }
        shot_release(&first);
        shot_release(&later);
        shot_release(&other);
        shot_release(&again);
    }
}

/* Lines are as far apart and as wide whatever the number of samples. */
static void samples(void)
{
    static const int         counts[] = {1, 4, 16};
    static const char *const settings[] = {
        "\"length\":0,\"wobble\":0,\"uneven\":0,\"loose\":0,\"series\":1,\"scale\":12,\"tone_by\":\"width\"",
        "\"length\":0,\"wobble\":0,\"uneven\":0,\"loose\":0,\"series\":1,\"scale\":8,\"width\":2.5",
        "\"length\":0,\"wobble\":0,\"uneven\":0,\"loose\":0,\"series\":1,\"scale\":12,\"tone_by\":\"width\","
        "\"coordinates\":\"screen\",\"angle\":20",
        "\"length\":60,\"series\":2"};
    for (int k = 0; k < 4; k++) {
        hatch_count n[3];
        for (int i = 0; i < 3; i++) {
            shape     s = {0};
            shot      drawing;
            shot_view view = hatch_front(192, 1);
            view.samples = counts[i];
            hatch_wall(&s, 1.5, 0);
            if (shot_of_shape(&drawing, &s, "wall.glb",
                              hatch_look("0,0,1", "", "\"shadow\":0.7,\"light\":0.7,%s", settings[k]), NULL, &view))
                n[i] = hatch_count_lines(&drawing);
            shot_release(&drawing);
            shape_release(&s);
        }
        for (int i = 1; i < 3; i++) {
            if (k < 3)
                check_near("IM-06", n[i].period / n[0].period, 1, 0.03,
                           "%.60s, %d samples: distance of lines over that with one", settings[k], counts[i]);
            if (k < 3)
                check_near("IM-06", n[i].width, n[0].width, 0.15, "  their width");
            check_near("IM-06", n[i].mean / n[0].mean, 1, 0.02, "  ink over that with one");
        }
    }
}

/* --- parts ---------------------------------------------------------------------------------------------- */

/* Mean of the ink less what the light asks for, over all pixels of the model but its rims. */
static double tone_error(const shot *s, dvec light, double *wanted)
{
    double got = 0, want = 0;
    int    count = 0;
    for (int i = 0; i < s->width * s->height; i++) {
        if (isinf(s->depth[i]) || s->normal[i][2] < 0.3f)
            continue;
        dvec to = dvec_unit(light);
        want += 1 - fmax(0, fmin(1, 0.3 + 0.6 * fmax(0, dvec_dot(to, dvec_from(s->normal[i])))));
        got += hatch_ink(s, i % s->width, i / s->width);
        count++;
    }
    *wanted = count ? want / count : 0;
    return count ? (got - want) / count : 1;
}

static void check_tone(const char *what, const shape *s, const char *settings, const shot_view *view, double limit)
{
    shot drawing;
    if (shot_of_shape(&drawing, s, "parts.glb",
                      hatch_look("0.3,0.5,0.8", "", "\"shadow\":0.3,\"light\":0.9,%s", settings), NULL, view)) {
        double wanted, error = tone_error(&drawing, dvec_of(0.3, 0.5, 0.8), &wanted);
        check_at_most("parts", fabs(error) / wanted, limit, "%s: share that the ink is off (%.3f was asked for)", what,
                      wanted);
        check_at_most("parts", hatch_odd_pixels(&drawing), 0, "  pixels that are not grey or not solid");
    }
    shot_release(&drawing);
}

typedef enum oddity {
    ODD_NONE,
    ODD_MIRRORED,
    ODD_STRETCHED,
    ODD_TURNED,
    ODD_TINY,
    ODD_HUGE,
    ODD_FAR,
    ODD_FLAT,
    ODD_COUNT
} oddity;

static const char *const oddity_names[ODD_COUNT] = {
    "as it is",    "mirrored",        "stretched",           "turned",
    "a millionth", "a million times", "far from the middle", "with a part of no size"};

static void make_odd(shape *s, oddity kind)
{
    hatch_model(s);
    for (size_t i = 0; i < s->count; i++) {
        shape_part *p = &s->parts[i];
        double      scale = kind == ODD_TINY ? 1e-6 : kind == ODD_HUGE ? 1e6 : 1;
        if (!p->has_matrix)
            for (int k = 0; k < 16; k++)
                p->matrix[k] = k % 5 == 0;
        p->has_matrix = true;
        for (int k = 0; k < 16; k++)
            if (k % 4 < 3)
                p->matrix[k] *= scale * (k % 4 == 0 && kind == ODD_MIRRORED    ? -1
                                         : k % 4 == 1 && kind == ODD_STRETCHED ? 0.6
                                                                               : 1);
        if (kind == ODD_FAR)
            p->matrix[12] += 300;
        if (kind == ODD_FLAT && i == 2)
            for (int k = 0; k < 12; k++)
                p->matrix[k] = 0;
    }
    if (kind == ODD_TURNED)
        for (size_t i = 0; i < s->count; i++)
            for (int c = 0; c < 4; c++) {
                double *m = &s->parts[i].matrix[4 * c], x = m[0], z = m[2];
                m[0] = x * cos(0.7) + z * sin(0.7);
                m[2] = z * cos(0.7) - x * sin(0.7);
            }
}

static void parts(void)
{
    static const char *const settings[] = {
        "\"length\":0,\"tone_by\":\"width\",\"scale\":5", "\"length\":110",
        "\"coordinates\":\"curvature\",\"length\":0,\"tone_by\":\"width\",\"scale\":5",
        "\"coordinates\":\"lapped\",\"length\":0,\"tone_by\":\"width\",\"scale\":5",
        "\"coordinates\":\"triplanar\",\"length\":0,\"tone_by\":\"width\",\"scale\":5"};
    for (int kind = 0; kind < ODD_COUNT; kind++)
        for (int k = 0; k < 5; k++) {
            double    size = kind == ODD_TINY ? 1e-6 : kind == ODD_HUGE ? 1e6 : 1;
            shot_view view = view_at(30, 7 * size);
            shape     s = {0};
            char      what[120];
            if (kind > 0 && k > 1 && kind != ODD_MIRRORED && kind != ODD_FLAT)
                continue;
            view.width = view.height = 176;
            if (kind == ODD_FAR) {
                view.eye.x += 300;
                view.target.x = 300;
            }
            make_odd(&s, (oddity)kind);
            snprintf(what, sizeof what, "%s, %.40s", oddity_names[kind], settings[k]);
            check_tone(what, &s, settings[k], &view, k == 1 ? 0.1 : 0.06); /* few strokes fit */
            shape_release(&s);
        }
}

/* Within a closed shape surfaces are seen from behind. */
static void check_inside(const char *what, const shape *s, const char *settings, const shot_view *view)
{
    shot drawing;
    if (shot_of_shape(&drawing, s, "inside.glb", hatch_look("0,0,1", "", "\"shadow\":0.6,\"light\":0.6,%s", settings),
                      NULL, view)) {
        int seen = 0;
        for (int i = 0; i < drawing.width * drawing.height; i++)
            seen += !isinf(drawing.depth[i]);
        check_at_least("parts", seen, 10000, "%s: pixels of the surface", what);
        check_near("parts", hatch_mean_inside(&drawing), 0.4, 0.024, "  ink");
        check_at_most("parts", hatch_odd_pixels(&drawing), 0, "  pixels that are not grey or not solid");
    }
    shot_release(&drawing);
}

/* Open, closed and broken meshes, seen from without and within. */
static void meshes(void)
{
    static const char *const coordinates[] = {"axes", "triplanar", "uv", "curvature", "lapped"};
    for (int c = 0; c < 5; c++)
        for (int kind = 0; kind < 5; kind++) {
            static const char *const names[] = {"ball", "hills", "sheet", "broken", "eye inside"};
            shot_view                view = {.width = 192, .height = 192, .eye = {1.2, 2.4, 2.8}, .up = {0, 1, 0}};
            shape                    s = {0};
            char                     settings[160], what[80];
            if (kind == 0)
                shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
            else if (kind == 1)
                shape_terrain(&s, "hills", 1.2, 0.3, 48, 3);
            else if (kind == 2)
                shape_quad(&s, "sheet", 1, 0);
            else
                shape_torus(&s, "ring", kind == 4 ? 2 : 0.9, kind == 4 ? 0.8 : 0.35, 64, 32);
            if (kind == 3) /* triangles without area, and holes */
                for (uint32_t i = 0; i + 2 < s.parts[0].index_count; i += 3)
                    if (i % 7 == 0)
                        s.parts[0].indices[i + 1] = s.parts[0].indices[i];
            if (kind == 4) {
                view.eye = dvec_of(2, 0, 0);
                view.target = dvec_of(1.6, 0.1, -1);
            }
            snprintf(settings, sizeof settings,
                     "\"coordinates\":\"%s\",\"length\":0,\"wobble\":0,\"uneven\":0,\"loose\":0,\"tone_by\":\"width\","
                     "\"scale\":5",
                     coordinates[c]);
            snprintf(what, sizeof what, "%s, %s", names[kind], coordinates[c]);
            if (kind < 4)
                check_tone(what, &s, settings, &view, 0.06);
            else
                check_inside(what, &s, settings, &view);
            shape_release(&s);
        }
}

/* One mesh at two nodes, one of them mirrored and turned, and a node without size. */
static void instances(void)
{
    static const char *const text = "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0,1,2,3]}],"
                                    "\"nodes\":[{\"mesh\":0},{\"mesh\":0,\"translation\":[2.5,0,0],\"scale\":[-1,1,1]},"
                                    "{\"mesh\":0,\"translation\":[0,2.5,0],\"rotation\":[0,0,0.3826834,0.9238795],"
                                    "\"scale\":[1,0.5,1]},{\"mesh\":0,\"scale\":[0,0,0]}],"
                                    "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{"
                                    "\"bufferView\":0,\"componentType\":5126,\"count\":6,\"type\":\"VEC3\","
                                    "\"min\":[-1,-1,0],\"max\":[1,1,0]}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":"
                                    "72}],\"buffers\":[{\"byteLength\":72,\"uri\":\"two.bin\"}]}";
    static const float       corners[6][3] = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, -1, 0}, {1, 1, 0}, {-1, 1, 0}};
    char                     path[512];
    FILE                    *file = fopen(check_path("two.bin"), "wb");
    fwrite(corners, sizeof corners, 1, file);
    fclose(file);
    snprintf(path, sizeof path, "%s", check_path("two.gltf"));
    file = fopen(path, "wb");
    fputs(text, file);
    fclose(file);
    shot_view view = {.width = 256, .height = 256, .eye = {1.2, 1.2, 12}, .target = {1.2, 1.2, 0}, .up = {0, 1, 0}};
    static const char *const coordinates[] = {"axes", "triplanar", "uv", "curvature", "lapped"};
    for (int c = 0; c < 5; c++) {
        shot s;
        if (shot_take(&s, path,
                      hatch_look("0,0,1", "",
                                 "\"shadow\":0.6,\"light\":0.6,\"coordinates\":\"%s\",\"length\":0,\"series\":1,\"tone_"
                                 "by\":\"width\",\"scale\":4,\"wobble\":0,\"uneven\":0",
                                 coordinates[c]),
                      NULL, &view))
            check_near("parts", hatch_mean_inside(&s), 0.4, 0.024, "instances, %s: ink", coordinates[c]);
        shot_release(&s);
    }
}

/* Pictures of a torus whose patches are drawn on red paper. */
static bool patches_of(shot *out, const char *coordinates, const shot_view *view)
{
    char  look[400];
    shape s = {0};
    snprintf(
        look, sizeof look,
        "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\",\"surface\":{"
        "\"technique\":\"hatch\",\"coordinates\":\"%s\",\"shadow\":1,\"light\":1,\"paper\":\"#ff0000\"}}]}",
        coordinates);
    shape_torus(&s, "torus", 1, 0.45, 60, 30);
    bool ok = shot_of_shape(out, &s, "patches.ply", look, NULL, view);
    shape_release(&s);
    return ok;
}

/* Patches are cut off at their torn outlines, which are those that were laid until all was covered: no pixel is left
 * open, as it would be by outlines of another shape. */
static void patches_leave_no_holes(void)
{
    shot_view view = {.width = 400, .height = 400, .eye = {1, 2, 3.5}, .up = {0, 1, 0}};
    shot      whole, lapped;
    if (!patches_of(&whole, "axes", &view))
        return;
    if (patches_of(&lapped, "lapped", &view)) {
        int holes = 0, body = 0;
        for (int i = 0; i < view.width * view.height; i++) {
            body += whole.picture[4 * i + 1] < 128;
            holes += whole.picture[4 * i + 1] < 128 && lapped.picture[4 * i + 1] >= 128;
        }
        check_at_least("lapped", body, 20000, "pixels of a torus");
        check_at_most("lapped", holes, 0, "pixels of it that no patch covers");
        shot_release(&lapped);
    }
    shot_release(&whole);
}

/* The way of strokes in a square of pixels, from how its tones change; false: there are too few strokes. */
static bool way_of_strokes(const shot *s, int left, int top, int side, double *angle)
{
    double xx = 0, xy = 0, yy = 0;
    for (int y = top; y < top + side; y++)
        for (int x = left; x < left + side; x++) {
            const uint8_t *p = &s->picture[4 * (y * s->width + x)];
            if (isinf(s->depth[y * s->width + x]) || isinf(s->depth[y * s->width + x + 1]))
                return false;
            const double across = p[4] - p[0], down = p[4 * s->width] - p[0];
            xx += across * across;
            xy += across * down;
            yy += down * down;
        }
    *angle = 0.5 * atan2(2 * xy, xx - yy);
    return xx + yy > 2e4 && hypot(xx - yy, 2 * xy) > 0.4 * (xx + yy);
}

/* Strokes along the way in which surfaces bend lie on a body that its node turns as on one whose corners are turned. */
static void turned_by_node_or_corner(void)
{
    static const char look[] = "{\"version\":1,\"name\":\"t\",\"rules\":[{\"surface\":{\"technique\":\"tonal-art-map\","
                               "\"coordinates\":\"curvature\"}}]}";
    enum { SIDE = 20 };
    const shot_view view = {.width = 360, .height = 360, .eye = {2, 1.5, 4}, .up = {0, 1, 0}};
    shot            shots[2];
    bool            drawn = true;
    for (int baked = 0; baked < 2; baked++) {
        shape s = {0};
        shape_torus(&s, "ring", 1, 0.4, 96, 48);
        shape_place(&s, dvec_of(1, 0.4, 0.2), 70, dvec_of(0.1, 0, 0));
        shape_part *p = &s.parts[0];
        for (uint32_t v = 0; v < p->vertex_count && baked; v++) {
            const dvec   at = shape_point(p, v), normal = p->normals ? shape_normal(p, v) : at;
            const double values[6] = {at.x, at.y, at.z, normal.x, normal.y, normal.z};
            for (int a = 0; a < 3; a++) {
                p->positions[v][a] = (float)values[a];
                if (p->normals)
                    p->normals[v][a] = (float)values[3 + a];
            }
        }
        p->has_matrix = p->has_matrix && !baked;
        drawn = shot_of_shape(&shots[baked], &s, "ring.glb", look, NULL, &view) && drawn;
        shape_release(&s);
    }
    double sum = 0;
    int    count = 0;
    for (int y = 0; y + SIDE < view.height - 1 && drawn; y += SIDE / 2)
        for (int x = 0; x + SIDE < view.width - 1; x += SIDE / 2) {
            double a, b;
            if (!way_of_strokes(&shots[0], x, y, SIDE, &a) || !way_of_strokes(&shots[1], x, y, SIDE, &b))
                continue;
            const double off = fabs(remainder(a - b, 3.14159265358979323846));
            sum += off * (180 / 3.14159265358979323846);
            count++;
        }
    check_at_least("IM-22", count, 30, "squares of a ring with strokes that follow it");
    check_at_most("IM-22", sum / (count ? count : 1), 12,
                  "degrees by which they lie otherwise where the node turns it, mean");
    for (int k = 0; k < 2; k++)
        shot_release(&shots[k]);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"frames", frames},
        {"door", shower_door},
        {"octaves", octaves},
        {"fixed", fixed},
        {"paths", paths},
        {"samples", samples},
        {"parts", parts},
        {"meshes", meshes},
        {"instances", instances},
        {"patches", patches_leave_no_holes},
        {"turned", turned_by_node_or_corner},
    };
    int status = check_main(argc, argv, "hatch_coherence", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
