/* Sections as they are drawn: depth and normals against what a ray through the solid meets, cut faces unlit and in
 * their colour, as much hatch as its width and distance say, and all of it the same in both dialects. */
#include <limner/limner.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "model.h"
#include "shot.h"

static const char plain_look[] =
    "{\"version\": 1, \"rules\": [{\"surface\": \"lit\"}], \"finish\": {\"ground\": \"#ffffff\"}}";
static const char lined_look[] = "{\"version\": 1, \"rules\": [{\"surface\": \"lit\", \"lines\": \"discontinuity\"}]}";

/* What a viewer far in front (+z) sees of the ball of radius 1 without its half z > 0.25. */
static void a_ball_has_a_disc(void)
{
    const shot_view   view = {.width = 240, .height = 240, .eye = {0, 0, 6}, .up = {0, 1, 0}, .orthographic = true};
    const char *const changes[] = {"scene.cut", "z=0.25", "scene.cut_hatch", "0px", "scene.cut_fill", "#3060c0", NULL};
    shape             s = {0};
    shot              cut;
    int               disc = 0, off = 0, turned = 0, coloured = 0;
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 96, 192, true);
    if (shot_of_shape(&cut, &s, "ball.glb", plain_look, changes, &view)) {
        for (int y = 0; y < cut.height; y++)
            for (int x = 0; x < cut.width; x++) {
                dvec from, along;
                shot_ray(&cut, x + 0.5, y + 0.5, &from, &along);
                double r2 = from.x * from.x + from.y * from.y;
                int    i = y * cut.width + x;
                if (r2 > 0.95 * 0.95 * (1 - 0.0625))
                    continue;
                disc++;
                off += !(fabs(cut.depth[i] - (6 - 0.25)) < 1e-4);
                turned += !(cut.normal[i][2] > 0.9999f);
                coloured +=
                    cut.picture[4 * i] == 0x30 && cut.picture[4 * i + 1] == 0x60 && cut.picture[4 * i + 2] == 0xC0;
            }
        check_at_least("cut", disc, 1000, "pixels inside the cut face");
        check_at_most("cut", off, 0, "of them not at the plane's depth");
        check_at_most("cut", turned, 0, "whose normal is not the plane's");
        check_near("cut", coloured, disc, 0, "in exactly the colour that was asked for");
    }
    shot_release(&cut);
    shape_release(&s);
}

/* The box takes the corner towards the viewer out of a cube: rays meet its three inner faces. */
static void a_corner_is_open(void)
{
    const shot_view   view = {.width = 240, .height = 240, .eye = {5, 4, 6}, .up = {0, 1, 0}};
    const char *const changes[] = {"scene.cut", "box=50%,50%,50%:100%,100%,100%", NULL};
    shape             s = {0};
    shot              cut;
    shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    if (shot_of_shape(&cut, &s, "cube.glb", plain_look, changes, &view)) {
        int inside = 0, wrong = 0;
        for (int y = 0; y < cut.height; y++)
            for (int x = 0; x < cut.width; x++) {
                dvec from, along;
                shot_ray(&cut, x + 0.5, y + 0.5, &from, &along);
                /* Where the ray enters the three half-spaces below 0: last of all it must be in the corner's octant
                 * before. */
                const double *o = &from.x, *d = &along.x;
                double        t = INFINITY;
                for (int k = 0; k < 3; k++)
                    t = fmin(t, d[k] < 0 ? -o[k] / d[k] : INFINITY);
                bool hits = t < INFINITY, near_edge = false;
                for (int k = 0; k < 3; k++) {
                    double at = o[k] + t * d[k];
                    hits = hits && at < 1 && at > -1e-9;
                    near_edge = near_edge || fabs(at - 1) < 0.02;
                }
                if (!hits || near_edge)
                    continue;
                dvec eye = shot_to_eye(&cut, dvec_of(o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]), 1);
                inside++;
                wrong += !(fabs(cut.depth[y * cut.width + x] + eye.z) < 2e-3);
            }
        check_at_least("cut", inside, 3000, "pixels that look into the corner");
        check_at_most("cut", wrong, 0, "of them at another depth");
    }
    shot_release(&cut);
    shape_release(&s);
}

/* Fraction of the middle that is ink. */
static double darkness(const shot *s)
{
    double sum = 0, count = 0;
    for (int y = s->height / 4; y < s->height * 3 / 4; y++)
        for (int x = s->width / 4; x < s->width * 3 / 4; x++) {
            sum += 1 - s->picture[4 * (y * s->width + x)] / 255.0;
            count++;
        }
    return sum / count;
}

/* A face from the front: half the picture's middle is cut face. Part 1 has the look's own distance and angle. */
static void hatch_covers_its_fraction(void)
{
    static const struct {
        const char *apart, *width;
        double      fraction;
        int         samples;
    } rows[] = {{"10px", "2px", 0.2, 1}, {"20px", "5px", 0.25, 1}, {"6px", "1.5px", 0.25, 4}, {"0px", "2px", 0, 1}};
    const shot_view front = {.width = 400, .height = 400, .eye = {0, 0, 6}, .up = {0, 1, 0}, .orthographic = true};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        shape     s = {0};
        shot      cut;
        shot_view view = front;
        view.samples = rows[i].samples;
        const char *const changes[] = {"scene.cut",
                                       "z",
                                       "scene.cut_hatch",
                                       rows[i].apart,
                                       "scene.cut_width",
                                       rows[i].width,
                                       "scene.cut_angle",
                                       "30",
                                       "scene.cut_fill",
                                       "#ffffff",
                                       "scene.cut_colour",
                                       "#000000",
                                       NULL};
        shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        if (shot_of_shape(&cut, &s, "hatch.glb", plain_look, changes, &view))
            check_near("cut", darkness(&cut), rows[i].fraction, 0.02, "dark share at distance %s, width %s",
                       rows[i].apart, rows[i].width);
        shot_release(&cut);
        shape_release(&s);
    }
}

/* The outline of a section is a line even where the wall behind it goes on as smoothly as the face. */
static void outlines_are_lines(void)
{
    const shot_view   view = {.width = 300, .height = 300, .eye = {0, 0, 6}, .up = {0, 1, 0}, .orthographic = true};
    const char *const changes[] = {"scene.cut", "z=0;0,0.05,1@0,0,0", "scene.cut_hatch", "0px", NULL};
    shape             s = {0};
    shot              cut;
    shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    if (shot_of_shape(&cut, &s, "outline.glb", lined_look, changes, &view)) {
        int lines = 0; /* two cut faces that differ by 3 degrees meet in the middle */
        for (int x = cut.width / 3; x < cut.width * 2 / 3; x++) {
            bool ink = false;
            for (int y = cut.height / 2 - 4; y < cut.height / 2 + 4; y++)
                ink = ink || shot_ink(&cut, x, y) <= 127;
            lines += ink;
        }
        check_at_least("cut", lines, cut.width / 3, "columns with a line between two cut faces");
    }
    shot_release(&cut);
    shape_release(&s);
}

/* Only lists settle ties, and not every dialect has them. */
#define BLUEPRINT_UNSETTLED                                                                                            \
    "{\"version\":2,\"rules\":[{\"select\":\"*\",\"surface\":\"lit\",\"lines\":{\"operator\":"                         \
    "\"discontinuity\",\"colour\":\"#12356b\"},\"layers\":{\"technique\":\"peel\",\"count\":5},\"compose\":{"          \
    "\"technique\":\"blueprint\",\"tint\":\"#5b8fd0\",\"hidden_colour\":\"#2f63a8\",\"hidden_width\":0.75,"            \
    "\"fade\":0.8}}]}"

static void dialects_agree(void)
{
    shot_view                view = {.width = 200, .height = 200, .eye = {4, 3, 5}, .up = {0, 1, 0}};
    const char *const        changes[] = {"scene.cut", "x;box=0%,50%,50%:100%,100%,100%", NULL};
    static const char *const looks[] = {
        "edges", "gooch", BLUEPRINT_UNSETTLED,
        "{\"version\": 1, \"rules\": [{\"surface\": \"lit\", \"layers\": "
        "{\"technique\": \"front\", \"shading\": \"deferred\"}, \"lines\": \"sobel\"}]}"};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        shape s = {0};
        shot  desktop, es;
        shape_torus(&s, "ring", 0.9, 0.35, 64, 32);
        shape_sphere(&s, "ball", dvec_of(0, 0, 0), 0.7, 24, 48, true);
        view.es = false;
        bool ok = shot_of_shape(&desktop, &s, "dialect.glb", looks[i], changes, &view);
        view.es = true;
        if (shot_of_shape(&es, &s, "dialect.glb", looks[i], changes, &view) && ok) {
            int different = 0;
            for (int k = 0; k < 4 * es.width * es.height; k++)
                different += abs(es.picture[k] - desktop.picture[k]) > 8;
            check_at_most("cut", different, 40, "bytes that differ between the dialects, look %zu", i);
        }
        shot_release(&desktop);
        shot_release(&es);
        shape_release(&s);
    }
}

static void open_parts_are_told(void)
{
    const shot_view   view = {.width = 64, .height = 64, .eye = {4, 3, 5}, .up = {0, 1, 0}};
    const char *const changes[] = {"scene.cut", "x", NULL};
    shape             s = {0};
    shot              cut;
    shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
    if (shot_of_shape(&cut, &s, "closed.glb", plain_look, changes, &view))
        check_that("cut", !shot_has_warning(&cut, "cut-open"), "a cube gives no warning");
    shot_release(&cut);
    s.parts[0].index_count -= 6; /* without its last face */
    if (shot_of_shape(&cut, &s, "open.glb", plain_look, changes, &view))
        check_that("cut", shot_has_warning(&cut, "cut-open"), "without a face it does");
    shot_release(&cut);
    shape_release(&s);
}

/* Faces of a section are what it is made for: seen through, they let a fifth as much through as all else does. */
static void cut_faces_are_nearly_solid(void)
{
    static const double opacities[] = {0.2, 0.5};
    const shot_view     view = {.width = 120, .height = 120, .eye = {0, 0, 6}, .up = {0, 1, 0}, .orthographic = true};
    const char *const changes[] = {"scene.cut", "z=0.25", "scene.cut_hatch", "0px", "scene.cut_fill", "#000000", NULL};
    for (int k = 0; k < 2; k++) {
        char  look[300];
        shape s = {0};
        shot  cut;
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"x\",\"rules\":[{\"surface\":\"flat\",\"layers\":{\"technique\":\"peel\","
                 "\"count\":1},"
                 "\"compose\":{\"technique\":\"xray\",\"opacity\":%g,\"rim\":0}}],\"finish\":{\"ground\":\"#ffffff\"}}",
                 opacities[k]);
        shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        if (shot_of_shape(&cut, &s, "xray.glb", look, changes, &view))
            check_near("cut", cut.picture[4 * (60 * 120 + 60)] / 255.0, 0.2 * (1 - opacities[k]), 0.01,
                       "white behind a black cut face of an x-ray of opacity %g", opacities[k]);
        shot_release(&cut);
        shape_release(&s);
    }
}

/* Of a solid's faces those of the section alone have the section's colour. */
static void solids_are_coloured_where_they_are_cut(void)
{
    const shot_view   view = {.width = 200, .height = 200, .eye = {3, 4, 6}, .up = {0, 1, 0}, .orthographic = true};
    const char *const changes[] = {"scene.cut", "z=0.25", "scene.cut_hatch", "0px", "scene.cut_fill", "#3060c0", NULL};
    const char       *path = check_path("solid.csg");
    FILE             *file = fopen(path, "w");
    shot              cut;
    int               face = 0, others = 0, wrong = 0;
    if (!check_that("cut", file != NULL, "a file can be written"))
        return;
    fputs("difference() { cube(size = [2, 2, 2], center = true); cube(size = [1, 1, 3], center = true); }\n", file);
    fclose(file);
    if (shot_take(&cut, path, plain_look, changes, &view)) {
        for (int i = 0; i < cut.width * cut.height; i++) {
            const uint8_t *p = &cut.picture[4 * i];
            const bool     blue = p[0] == 0x30 && p[1] == 0x60 && p[2] == 0xC0;
            if (isinf(cut.depth[i]))
                continue;
            dvec from, along;
            shot_ray(&cut, i % cut.width + 0.5, i / cut.width + 0.5, &from, &along);
            const double z = from.z + along.z * (double)cut.depth[i] / fabs(shot_to_eye(&cut, along, 0).z);
            if (fabs(z - 0.25) < 0.005)
                face++;
            else
                others += z < 0.22;
            wrong += fabs(z - 0.25) < 0.005 ? !blue : z < 0.22 && blue;
        }
        check_at_least("cut", face, 1000, "pixels of a solid's cut face");
        check_at_least("cut", others, 1000, "pixels of its other faces");
        check_at_most("cut", wrong, 0.02 * (face + others), "of all these in the colour of the other kind");
    }
    shot_release(&cut);
}

/* In layers the hatch is ink, once, however often lines are repeated, and whatever else the layer shows. */
static void layers_are_hatched_once(void)
{
    static const char *const perturbs[] = {"",
                                           ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":0.01,\"repeat\":3}"};
    const shot_view   view = {.width = 400, .height = 400, .eye = {0, 0, 6}, .up = {0, 1, 0}, .orthographic = true};
    const char *const changes[] = {
        "scene.cut", "z", "scene.cut_hatch", "10px", "scene.cut_width", "2px", "scene.cut_angle", "30", NULL};
    for (int k = 0; k < 2; k++) {
        char  look[512];
        shape s = {0};
        shot  cut;
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"x\",\"rules\":[{\"surface\":\"flat\",\"layers\":{\"technique\":\"peel\","
                 "\"count\":1},"
                 "\"lines\":{\"operator\":\"four-tap\",\"colour\":\"#000000\"},\"compose\":{\"technique\":"
                 "\"blueprint\",\"tint\":"
                 "\"#00000000\"}%s}],\"finish\":{\"ground\":\"#ffffff\"}}",
                 perturbs[k]);
        shape_box(&s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        if (shot_of_shape(&cut, &s, "layers.glb", look, changes, &view))
            check_near("cut", darkness(&cut), 0.2, 0.02, "dark share of a blueprint's cut face%s",
                       k ? ", lines repeated" : "");
        shot_release(&cut);
        shape_release(&s);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"a_ball_has_a_disc", a_ball_has_a_disc},
        {"a_corner_is_open", a_corner_is_open},
        {"hatch_covers_its_fraction", hatch_covers_its_fraction},
        {"cut_faces_are_nearly_solid", cut_faces_are_nearly_solid},
        {"solids_are_coloured_where_they_are_cut", solids_are_coloured_where_they_are_cut},
        {"layers_are_hatched_once", layers_are_hatched_once},
        {"outlines_are_lines", outlines_are_lines},
        {"dialects_agree", dialects_agree},
        {"open_parts_are_told", open_parts_are_told},
    };
    int status = check_main(argc, argv, "cut", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
