/* Shells: a rim of the line's width outside what is seen, and nothing else. The reference is the distance of every
 * pixel from the body, counted pixel by pixel. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "shape.h"
#include "shot.h"

enum { SIDE = 240 };

static const double widths[] = {1, 2, 3, 5, 8};

static const char *look_of(double width)
{
    static char texts[4][200];
    static int  next;
    char        lines[80], *text = texts[next++ % 4];
    snprintf(lines, sizeof lines, "{\"operator\":\"shell\",\"colour\":\"#000000\",\"width\":%g}", width);
    snprintf(text, sizeof texts[0], "%s", shot_line_look(lines));
    return text;
}

static bool is_inked(const shot *s, int x, int y)
{
    return picture_shown(s->picture[4 * (y * s->width + x)]) < 0.5;
}

/* How far the nearest pixel is that is nearer to the eye by more than `step`; INFINITY beyond `reach`. */
static double distance_to_nearer(const shot *s, int x, int y, int reach, double step)
{
    double nearest = INFINITY, own = (double)s->depth[y * s->width + x];
    for (int v = -reach; v <= reach; v++)
        for (int u = -reach; u <= reach; u++) {
            if (x + u < 0 || y + v < 0 || x + u >= s->width || y + v >= s->height)
                continue;
            double other = (double)s->depth[(y + v) * s->width + x + u];
            if (other < own - step && hypot(u, v) < nearest)
                nearest = hypot(u, v);
        }
    return nearest;
}

/* What one picture shows. Distances are between middles of pixels: a line of width w has those up to w, give or
 * take half a pixel at either side. */
typedef struct tally {
    int ink, inside, far, missing,
        whole; /* inside: on the body; far: beyond the width; missing: of `whole` pixels that must be inked */
} tally;

/* `step`: what is nearer by less belongs to one surface. */
static tally count_rim(const shot *s, double width, double step)
{
    tally t = {0};
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            bool   inked = is_inked(s, x, y), empty = s->id[y * s->width + x] == 0;
            double d = distance_to_nearer(s, x, y, (int)width + 3, step);
            t.ink += inked;
            t.inside += inked && !empty;
            t.far += inked && d > width + 1;
            if (!empty || !(d <= width))
                continue;
            t.whole += d <= width - 1 || d <= 1;
            t.missing += (d <= width - 1 || d <= 1) && !inked;
        }
    return t;
}

static void sphere_scene(shape *s)
{
    shape_sphere(s, "ball", dvec_of(0, 0, 0), 1.3, 64, 128, true);
}

static void ring_scene(shape *s)
{
    shape_torus(s, "ring", 1.1, 0.4, 128, 64);
}

static void cube_scene(shape *s)
{
    shape_box(s, "cube", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
}

/* Smooth bodies of which no piece is in front of another. */
static void smooth_rims(void)
{
    static const struct {
        const char *name;
        void (*make)(shape *);
        dvec eye;
    } rows[] = {{"sphere", sphere_scene, {3, 4, 5}},
                {"sphere aside", sphere_scene, {-6, 1, 2}},
                {"ring", ring_scene, {0.3, 8, 0.2}},
                {"ring below", ring_scene, {0.5, -7, 0.7}}};
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        shape s = {0};
        rows[i].make(&s);
        double before = 0;
        for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
            shot_view view = {
                .width = SIDE, .height = SIDE, .eye = rows[i].eye, .up = {0.3, 0.2, 1}, .orthographic = w % 2};
            shot t;
            if (shot_of_shape(&t, &s, "smooth.glb", look_of(widths[w]), NULL, &view)) {
                tally n = count_rim(&t, widths[w], 1e9);
                check_at_most("2.5.4", n.inside, 0, "%s, width %g: ink on the body", rows[i].name, widths[w]);
                check_at_most("2.5.4", n.far, 0, "%s: ink farther away than width and a pixel", rows[i].name);
                check_at_least("2.5.4", n.whole, 300, "%s: pixels within the width less a pixel", rows[i].name);
                check_at_most("2.5.4", n.missing, 0, "%s: of which without ink", rows[i].name);
                check_at_least("2.5.4", n.ink - before, 200, "%s: more ink than with the width before", rows[i].name);
                before = n.ink;
            }
            shot_release(&t);
        }
        shape_release(&s);
    }
}

/* A ring across the page hides pieces of itself, and a ball in front of a wall does: rims are on what lies behind,
 * beside what is in front. */
static void rims_before_surfaces(void)
{
    for (int i = 0; i < 2; i++) {
        shape s = {0};
        if (i == 0) {
            ring_scene(&s);
        } else {
            shape_sphere(&s, "ball", dvec_of(0, 0, 0), 0.8, 64, 128, true);
            shape_quad(&s, "wall", 2, -1.5);
        }
        for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
            shot_view view = {.width = SIDE,
                              .height = SIDE,
                              .eye = {i ? 1 : 0, i ? 1 : 2.6, 6},
                              .up = {0, 1, 0},
                              .orthographic = w % 2};
            shot      t;
            if (shot_of_shape(&t, &s, "before.glb", look_of(widths[w]), NULL, &view)) {
                tally n = count_rim(&t, widths[w], 0.1);
                check_at_least("2.5.4", n.inside, 30 * widths[w], "%s, width %g: ink on what is behind",
                               i ? "ball" : "ring", widths[w]);
                check_at_most("2.5.4", n.far, 0, "of which far from all that is in front");
            }
            shot_release(&t);
        }
        shape_release(&s);
    }
}

/* Ink across the middle of a side of the cube's picture. */
static int ink_in_row(const shot *s, int from, int to)
{
    int count = 0;
    for (int x = from; x < to; x++)
        count += is_inked(s, x, s->height / 2);
    return count;
}

static void cubes(void)
{
    shape s = {0};
    cube_scene(&s);
    for (size_t w = 0; w < sizeof widths / sizeof *widths; w++) {
        shot      t;
        shot_view view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 7}, .up = {0, 1, 0}};
        if (shot_of_shape(&t, &s, "cube.glb", look_of(widths[w]), NULL, &view)) {
            tally n = count_rim(&t, widths[w], 1e9);
            check_at_most("2.5.4", n.inside, 0, "cube from the front, width %g: ink on its face", widths[w]);
            check_at_most("2.5.4", n.far, 0, "ink farther away than width and a pixel");
            check_near("2.5.4", ink_in_row(&t, 0, SIDE / 2), widths[w], 1, "width on the left");
            check_near("2.5.4", ink_in_row(&t, SIDE / 2, SIDE), widths[w], 1, "width on the right");
        }
        shot_release(&t);
        for (int k = 0; k < 6; k++) { /* from everywhere */
            view = (shot_view){.width = SIDE,
                               .height = SIDE,
                               .eye = {5 * cos(k), 1 + k, 5 * sin(k)},
                               .up = {0, 1, 0},
                               .orthographic = k % 2};
            if (shot_of_shape(&t, &s, "cube.glb", look_of(widths[w]), NULL, &view)) {
                tally n = count_rim(&t, widths[w], 1e9);
                check_at_most("2.5.4", n.inside, 0, "cube, view %d, width %g: ink on flat faces", k, widths[w]);
                check_at_most("2.5.4", n.far, 0, "cube: ink farther away than width and a pixel");
                check_at_least("2.5.4", n.ink, 200 * widths[w], "cube: ink");
            }
            shot_release(&t);
        }
    }
    shape_release(&s);
}

/* A sheet of two coincident sides: the far one lies as deep as the near one. Seen from aside and with a wide angle,
 * too. */
static void sheets(void)
{
    shape s = {0};
    shape_quad(&s, "near", 1, 0);
    shape_quad(&s, "far", 1, 0);
    shape_place(&s, dvec_of(0, 1, 0), 180, dvec_of(0, 0, 0));
    for (int k = 0; k < 8; k++) {
        shot_view view = {.width = SIDE,
                          .height = SIDE,
                          .eye = {0.7 * k, 0.1 * k * k, 6},
                          .up = {0, 1, 0},
                          .orthographic = k % 2,
                          .fov_deg = 30 + 8 * k};
        shot      t;
        if (shot_of_shape(&t, &s, "sheet.glb", look_of(6), NULL, &view)) {
            tally n = count_rim(&t, 6, 1e9);
            check_at_most("2.5.4", n.inside, 0, "sheet, view %d: ink on it", k);
        }
        shot_release(&t);
    }
    shape_release(&s);
}

/* A mirrored part is a body like any other, whichever way round its corners are. */
static void mirrored(void)
{
    shape s = {0};
    sphere_scene(&s);
    shape_place(&s, dvec_of(0, 1, 0), 0, dvec_of(0, 0, 0));
    s.parts[0].matrix[0] = -1;
    shot_view view = {.width = SIDE, .height = SIDE, .eye = {3, 4, 5}, .up = {0, 1, 0}};
    shot      t;
    if (shot_of_shape(&t, &s, "mirrored.glb", look_of(4), NULL, &view)) {
        tally n = count_rim(&t, 4, 1e9);
        check_at_most("2.5.4", n.inside, 0, "mirrored sphere: ink on the body");
        check_at_least("2.5.4", n.whole, 300, "mirrored sphere: pixels within the width less a pixel");
        check_at_most("2.5.4", n.missing, 0, "mirrored sphere: of which without ink");
    }
    shot_release(&t);
    shape_release(&s);
}

/* Half behind a plate of another rule that has no lines, half in front of another. */
static void figures(void)
{
    static const char look[] = "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{"
                               "\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"}},"
                               "{\"select\":\"ball\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},"
                               "\"lines\":{\"operator\":\"shell\",\"colour\":\"#000000\",\"width\":8}}]}";
    shape             s = {0};
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 64, 128, true);
    shape_box(&s, "plate", dvec_of(-2, -2, 1.2), dvec_of(0, 2, 1.3));
    shape_box(&s, "back", dvec_of(-0.2, -2, -1.5), dvec_of(2, 2, -1.3));
    shot_view view = {.width = SIDE, .height = SIDE, .eye = {0, 0, 12}, .up = {0, 1, 0}, .orthographic = true};
    shot      t;
    if (shot_of_shape(&t, &s, "figures.glb", look, NULL, &view)) {
        int left = (int)shot_project(&t, dvec_of(0, 0, 1.2)).x - 1, covered = 0;
        for (int y = 0; y < t.height; y++)
            for (int x = 0; x < left; x++)
                covered += is_inked(&t, x, y);
        check_at_most("2.5.4", covered, 0, "ink on a plate of another rule in front");
        check_near("2.5.4", ink_in_row(&t, SIDE / 2, SIDE), 8, 1, "width in front of a plate of another rule");
    }
    shot_release(&t);
    shape_release(&s);
}

/* How often a file has a text; below 0: there is no file. */
static int occurrences(const char *path, const char *wanted)
{
    static char line[1 << 16];
    FILE       *file = fopen(path, "r");
    int         count = 0;
    while (file && fgets(line, sizeof line, file))
        count += strstr(line, wanted) != NULL;
    if (!file)
        return -1;
    fclose(file);
    return count;
}

/* As strokes, a shell is its outlines. */
static void as_strokes(void)
{
    static const char *const operators[] = {"shell", "discontinuity"};
    for (int i = 0; i < 2; i++) {
        char  look[200], command[2048], path[400];
        FILE *file = fopen(check_path("%s.json", operators[i]), "w");
        snprintf(look, sizeof look,
                 "{\"version\":1,\"name\":\"t\",\"rules\":[{\"surface\":\"flat\",\"lines\":\"%s\"}]}", operators[i]);
        if (file) {
            fputs(look, file);
            fclose(file);
        }
        snprintf(path, sizeof path, "%s", check_path("%s.svg", operators[i]));
        snprintf(command, sizeof command, "%s draw %s/gearbox.stl -o %s --look %s --quiet", LIMNER_COMMAND,
                 LIMNER_EXAMPLES, path, check_path("%s.json", operators[i]));
        check_that("2.5.4", system(command) == 0, "%s as strokes", operators[i]);
        check_at_least("2.5.4", occurrences(path, "visible contour"), 1, "%s: groups of outlines", operators[i]);
        if (i == 0)
            check_at_most("2.5.4", occurrences(path, "visible crease"), 0, "%s: groups of creases", operators[i]);
        else
            check_at_least("2.5.4", occurrences(path, "visible crease"), 1, "%s: groups of creases", operators[i]);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"smooth", smooth_rims}, {"before", rims_before_surfaces}, {"cubes", cubes},
                                       {"sheets", sheets},      {"mirrored", mirrored},           {"figures", figures},
                                       {"strokes", as_strokes}};
    int                     status = check_main(argc, argv, "shell", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
