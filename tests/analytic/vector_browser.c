/* Vector drawings as others show them: a page in a browser (headless Chromium) and a PDF page (pdftoppm) beside the
 * picture that Limner itself draws of the same view with the same look. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check.h"
#include "picture.h"

enum { SIDE = 1024, NEAR = 110 }; /* ink differs from the ground by this much in the sum of its channels */

static bool has_program(const char *name)
{
    char command[128];
    snprintf(command, sizeof command, "command -v %s >/dev/null 2>&1", name);
    return system(command) == 0;
}

static bool run(const char *command)
{
    return system(command) == 0;
}

static bool draw(const char *model, const char *look, const char *options, const char *out)
{
    char command[1024];
    snprintf(command, sizeof command, "%s draw %s/%s --look %s %s --quiet -o %s 2>/dev/null", LIMNER_COMMAND,
             LIMNER_EXAMPLES, model, look, options, out);
    return run(command);
}

/* Pixels that differ from the ground at the corner; the picture is cut to SIDE by SIDE. NULL when it cannot be
 * read. */
static bool *read_ink(const char *path)
{
    int      width, height;
    uint8_t *p = picture_read_rgba(path, &width, &height);
    if (!p || width < SIDE || height < SIDE) {
        free(p);
        return NULL;
    }
    bool *ink = check_alloc(SIDE * SIDE, sizeof *ink);
    for (int y = 0; y < SIDE; y++)
        for (int x = 0; x < SIDE; x++) {
            const uint8_t *q = p + 4 * ((size_t)y * (size_t)width + (size_t)x);
            ink[y * SIDE + x] = abs(q[0] - p[0]) + abs(q[1] - p[1]) + abs(q[2] - p[2]) > NEAR;
        }
    free(p);
    return ink;
}

/* The fraction of one picture's ink that has some of the other's within 1.5 pixels. */
static double fraction_near(const bool *a, const bool *b)
{
    size_t all = 0, near = 0;
    for (int y = 1; y < SIDE - 1; y++)
        for (int x = 1; x < SIDE - 1; x++) {
            if (!a[y * SIDE + x])
                continue;
            bool found = false;
            for (int j = -1; j <= 1 && !found; j++)
                for (int i = -1; i <= 1 && !found; i++)
                    found = b[(y + j) * SIDE + x + i];
            all++;
            near += found;
        }
    return all ? (double)near / (double)all : 0;
}

/* One drawing: a model, a look and what else there is to say. */
typedef struct drawn {
    const char *model, *look, *options;
} drawn;

static void compare(const char *what, const drawn *d, const char *path, const bool *own)
{
    bool *other = read_ink(path);
    if (!check_that("8", other != NULL, "%s shows %s as %s %s", what, d->model, d->look, d->options))
        return;
    check_at_least("8", fraction_near(other, own), 0.99, "%s of %s, %s %s: ink that the picture has within 1.5 px",
                   what, d->model, d->look, d->options);
    check_at_least("8", fraction_near(own, other), 0.99,
                   "%s of %s, %s %s: ink of the picture that it has within 1.5 px", what, d->model, d->look,
                   d->options);
    free(other);
}

static void show_in_browser(const drawn *d, const char *svg, const bool *own)
{
    char        folder[512], command[2400]; /* browsers want the whole path */
    const char *shot = check_path("shot");
    if (!getcwd(folder, sizeof folder))
        folder[0] = 0;
    /* As high as the window is, the page ends before it: some versions take bars off the window's height. */
    snprintf(command, sizeof command,
             "timeout 120 chromium --headless --no-sandbox --disable-gpu --hide-scrollbars "
             "--force-device-scale-factor=1 --user-data-dir=%s.profile --window-size=%d,%d "
             "--screenshot=%s.png file://%s/%s >/dev/null 2>&1",
             shot, SIDE, SIDE + 200, shot, svg[0] == '/' ? "" : folder, svg);
    if (check_that("8", run(command), "chromium runs"))
        compare("the browser", d, check_path("shot.png"), own);
}

static void show_as_pdf(const drawn *d, const char *pdf, const bool *own)
{
    char        command[2400];
    const char *shot = check_path("shot");
    snprintf(command, sizeof command, "pdftoppm -r 96 -singlefile -png %s %s.pdf >/dev/null 2>&1", pdf, shot);
    if (check_that("8", run(command), "pdftoppm runs"))
        compare("the PDF page", d, check_path("shot.pdf.png"), own);
}

static void show(const drawn *list, size_t count)
{
    bool browser = has_program("chromium"), poppler = has_program("pdftoppm");
    if (!browser)
        check_note("chromium is not installed: pages are not shown in a browser");
    if (!poppler)
        check_note("pdftoppm is not installed: PDF pages are not drawn");
    for (size_t i = 0; i < count; i++) {
        char png[256], svg[256], pdf[256], smooth[256];
        snprintf(png, sizeof png, "%s", check_path("own.png"));
        snprintf(svg, sizeof svg, "%s", check_path("page.svg"));
        snprintf(pdf, sizeof pdf, "%s", check_path("page.pdf"));
        snprintf(smooth, sizeof smooth, "%s --samples 4", list[i].options);
        check_that("8",
                   draw(list[i].model, list[i].look, smooth, png) &&
                       draw(list[i].model, list[i].look, list[i].options, svg) &&
                       draw(list[i].model, list[i].look, list[i].options, pdf),
                   "%s is drawn as %s %s", list[i].model, list[i].look, list[i].options);
        bool *own = read_ink(png);
        if (!check_that("8", own != NULL, "the picture can be read"))
            continue;
        if (browser)
            show_in_browser(&list[i], svg, own);
        if (poppler)
            show_as_pdf(&list[i], pdf, own);
        free(own);
    }
}

static void vectors_look_like_pictures(void)
{
    static const drawn list[] = {{"pump.glb", "technical", ""},    {"pump.glb", "line", ""},
                                 {"crank.glb", "technical", ""},   {"crank.glb", "line", ""},
                                 {"gearbox.stl", "technical", ""}, {"gearbox.stl", "line", ""}};
    show(list, sizeof list / sizeof *list);
}

/* Ways to tell of motion that vectors have. */
static void motion_looks_like_pictures(void)
{
    static const drawn list[] = {
        {"buggy.glb", "speed-lines", "--time 1.2 --camera with"},
        {"arm.glb", "ghosts", "--time 0.9 --set motion.colour=#000000 --set motion.fade=1"},
        {"walker.bvh", "line", "--poses auto --motion ghosts --view right --set motion.fade=1"},
        {"fox.glb", "line", "--clip Run --time 0.4 --motion ghosts --set motion.figures=solids --set motion.fade=1"},
        {"walker.bvh", "line",
         "--time 1 --view right --fit-time --set motion.technique=traces --set motion.exposure=0.3 --set "
         "motion.flow=40"}};
    show(list, sizeof list / sizeof *list);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"vectors look like pictures", vectors_look_like_pictures},
                                       {"motion looks like pictures", motion_looks_like_pictures}};
    return check_main(argc, argv, "vector_browser", cases, 2);
}
