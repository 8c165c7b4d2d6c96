/* How figures meet: depth sprites against the real visibility, the other forms of drawing lines, complements,
 * mirrors, and where the lines lie on both sides of a boundary. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "feature.h"
#include "picture.h"

#define LOOK(RULES)  "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[" RULES "]}"
#define HIDDEN_LINES "\"lines\":{\"operator\":\"four-tap\",\"colour\":\"#00000000\"}"

static const shot_view views[] = {
    {.width = 320, .height = 240, .eye = {4, 3, 5}, .up = {0, 1, 0}},
    {.width = 257, .height = 240, .eye = {-2, 3, -4}, .up = {0, 1, 0}, .orthographic = true},
};

static const uint8_t *pixel(const shot *s, int x, int y)
{
    return &s->picture[4 * (y * s->width + x)];
}

static bool is_colour(const uint8_t *p, int r, int g, int b, int tolerance)
{
    return abs(p[0] - r) <= tolerance && abs(p[1] - g) <= tolerance && abs(p[2] - b) <= tolerance;
}

/* Four parts that run through each other. */
static void knot(shape *s)
{
    shape_box(s, "first", dvec_of(-1, -0.6, -0.7), dvec_of(0.7, 0.5, 0.6));
    shape_torus(s, "second", 0.9, 0.25, 96, 48);
    shape_place(s, dvec_of(1, 0.3, 0), 60, dvec_of(0.1, 0.1, 0.2));
    shape_box(s, "third", dvec_of(-0.1, -1.4, -0.1), dvec_of(0.1, 1.4, 0.1));
    shape_place(s, dvec_of(0, 0, 1), 30, dvec_of(0.3, 0, 0.53));
    shape_sphere(s, "fourth", dvec_of(-0.4, 0.4, 0.3), 0.6, 48, 96, true);
}

/* Each part is drawn in another way and has a colour of its own, so that the picture tells which part won. */
static void sprites_interleave(void)
{
    static const char look[] =
        LOOK("{\"select\":\"first\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"}},"
             "{\"select\":\"second\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#00ff00\"}," HIDDEN_LINES "},"
             "{\"select\":\"third\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#0000ff\"},\"compose\":"
             "\"superimpose\"," HIDDEN_LINES "},"
             "{\"select\":\"fourth\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffff00\"},\"compose\":"
             "\"merged\"," HIDDEN_LINES "}");
    static const int colours[5][3] = {{255, 255, 255}, {255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 0}};
    for (int v = 0; v < 4; v++) {
        shape       s = {0};
        shot        drawing;
        shot_view   view = views[v / 2];
        const char *changes[] = {"layers.complement", v % 2 ? "false" : "true", NULL};
        view.without_maps = v % 2;
        knot(&s);
        if (shot_of_shape(&drawing, &s, "knot.glb", look, changes, &view)) {
            tracer   *t = tracer_create(&s);
            trace_map map;
            int       wrong = 0, inside = 0, count = drawing.width * drawing.height;
            trace_map_make(&map, t, &drawing);
            for (int i = 0; i < count; i++) {
                const int *c = colours[map.id[i]];
                bool       differs = !is_colour(&drawing.picture[4 * i], c[0], c[1], c[2], 1);
                wrong += differs;
                inside += differs && !trace_map_border(&map, i % drawing.width, i / drawing.width, 1);
            }
            check_at_least("E03", 1 - (double)wrong / count, 0.999, "fraction of pixels that show the right part%s",
                           v % 2 ? " (without maps and complement)" : "");
            check_at_most("E03", inside, 0, "wrong pixels away from borders");
            trace_map_release(&map);
            tracer_destroy(t);
        }
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* Two plates that cross at a degree: a thousandth of depth moves the line where they change positions by many pixels.
 * Without the complement nothing but the sprite's depth decides. */
static void shallow_crossing(void)
{
    static const char *const forms[] = {"opaque", "superimpose", "merged"};
    for (int f = 0; f < 3; f++)
        for (int v = 0; v < 2; v++) {
            char      look[512];
            shape     s = {0};
            shot      drawing;
            int       wrong = 0;
            shot_view view = views[v];
            view.without_maps = true; /* else all figures are sprites, and wrong in the same way */
            snprintf(look, sizeof look,
                     LOOK("{\"select\":\"one\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"}},"
                          "{\"select\":\"two\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#0000ff\"},"
                          "\"layers\":{\"complement\":false},\"compose\":\"%s\"," HIDDEN_LINES "}"),
                     forms[f]);
            shape_quad(&s, "one", 1, 0);
            shape_quad(&s, "two", 1, 0);
            shape_place(&s, dvec_of(0, 1, 0.3), 1, dvec_of(0.002, 0.001, 0.003));
            shape_box(&s, "far", dvec_of(-0.2, -0.2, -4), dvec_of(0.2, 0.2, -3));
            if (shot_of_shape(&drawing, &s, "shallow.glb", look, NULL, &view)) {
                tracer   *t = tracer_create(&s);
                trace_map map;
                trace_map_make(&map, t, &drawing);
                for (int i = 0; i < drawing.width * drawing.height; i++)
                    if ((map.id[i] == 1 || map.id[i] == 2) &&
                        !trace_map_border(&map, i % drawing.width, i / drawing.width, 1))
                        wrong += !is_colour(&drawing.picture[4 * i], map.id[i] == 1 ? 255 : 0, 0,
                                            map.id[i] == 2 ? 255 : 0, 1);
                trace_map_release(&map);
                tracer_destroy(t);
            }
            check_at_most("E03", wrong, 0, "wrong pixels of plates that cross at a degree, %s", forms[f]);
            shot_release(&drawing);
            shape_release(&s);
        }
}

static int largest_difference(const shot *a, const shot *b, const bool *where)
{
    int worst = 0;
    for (int i = 0; i < a->width * a->height * 4; i++)
        if (!where || where[i / 4])
            worst = abs(a->picture[i] - b->picture[i]) > worst ? abs(a->picture[i] - b->picture[i]) : worst;
    return worst;
}

static void deferred_shading(void)
{
    static const char *const surfaces[] = {"lambert", "lit", "tones", "toon", "gooch", "textured", "flat"};
    for (size_t i = 0; i < sizeof surfaces / sizeof *surfaces; i++) {
        static const char *const deferred[] = {"layers.shading", "deferred", NULL};
        char                     look[256];
        shape                    s = {0};
        shot                     forward, later;
        knot(&s);
        for (size_t k = 0; k < s.count; k++)
            s.parts[k].colour[k % 3] = 0.4f;
        snprintf(look, sizeof look, LOOK("{\"surface\":\"%s\",\"lines\":{\"operator\":\"four-tap\"}}"), surfaces[i]);
        bool first = shot_of_shape(&forward, &s, "deferred.glb", look, NULL, &views[0]);
        if (shot_of_shape(&later, &s, "deferred.glb", look, deferred, &views[0]) && first)
            check_at_most("E04", largest_difference(&forward, &later, NULL), 2,
                          "levels between forward and deferred: %s", surfaces[i]);
        shot_release(&forward);
        shot_release(&later);
        shape_release(&s);
    }
}

/* The three forms of the last pass agree wherever the figure is. */
static void forms_agree(void)
{
    static const char *const operators[] = {"four-tap", "sobel", "saito", "discontinuity", "id"};
    for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
        static const char *const forms[] = {"opaque", "superimpose", "merged"};
        char                     look[256];
        shape                    s = {0};
        shot                     drawn[3];
        bool                     ok = true;
        knot(&s);
        snprintf(look, sizeof look, LOOK("{\"surface\":\"lit\",\"lines\":{\"operator\":\"%s\",\"gain\":4}}"),
                 operators[i]);
        for (int k = 0; k < 3; k++) {
            const char *changes[] = {"compose.technique", forms[k], NULL};
            shot_view   view = views[0];
            view.without_maps = k > 0;
            ok = shot_of_shape(&drawn[k], &s, "forms.glb", look, changes, &view) && ok;
        }
        if (ok) {
            bool *inside = check_alloc((size_t)(drawn[0].width * drawn[0].height), sizeof *inside);
            int   ink_outside = 0;
            for (int k = 0; k < drawn[0].width * drawn[0].height; k++) {
                inside[k] = !isinf(drawn[0].depth[k]);
                ink_outside += !inside[k] && drawn[0].picture[4 * k] < 128;
            }
            check_at_most("E15", largest_difference(&drawn[0], &drawn[1], inside), 2,
                          "levels between sprite and third pass, %s", operators[i]);
            check_at_most("E16", largest_difference(&drawn[1], &drawn[2], NULL), 1,
                          "levels between third pass and merged, %s", operators[i]);
            check_at_least("E20", ink_outside, 100, "line pixels of the sprite beyond the boundary");
            free(inside);
        }
        for (int k = 0; k < 3; k++)
            shot_release(&drawn[k]);
        shape_release(&s);
    }
}

enum { HALF_STEP = 1 }; /* of the map of 8 bits */

/* The picture is the edge map inked onto the shade map, pixel by pixel, in each class's colour. */
static void superimposed_colours(void)
{
    static const char look[] =
        LOOK("{\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},\"lines\":{\"operator\":\"discontinuity\","
             "\"colour\":\"#ff0000\",\"inner_colour\":\"#0000ff\",\"id_colour\":\"#00ff00\",\"parts\":false}}");
    static const shot_view odd[] = {
        {.width = 321, .height = 243, .eye = {4, 3, 5}, .up = {0, 1, 0}},
        {.width = 97, .height = 333, .eye = {4, 3, 5}, .target = {1, 0.5, 0}, .up = {0, 1, 0}}};
    for (int v = 0; v < 2; v++) {
        shape s = {0}, one = {0};
        shot  drawing;
        int   profile = 0, inner = 0, wrong = 0;
        knot(&s);
        shape_join(&one, "one", &s);
        if (shot_of_shape(&drawing, &one, "colours.ply", look, NULL, &odd[v]))
            for (int i = 0; i < drawing.width * drawing.height; i++) {
                const uint8_t *e = &drawing.edge[4 * i], *p = &drawing.picture[4 * i];
                if (e[0] == 0) {
                    profile++;
                    wrong += !is_colour(p, 255, 0, 0, HALF_STEP);
                } else if (e[0] == 255 && e[1] == 0) {
                    inner++;
                    wrong += !is_colour(p, 0, 0, 255, HALF_STEP);
                } else if (e[0] == 255 && e[1] == 255 && e[3] == 255) {
                    wrong += !is_colour(p, 255, 255, 255, 1);
                }
            }
        check_at_least("E09", profile, 200, "pixels in the profile's colour");
        check_at_least("E09", inner, 40, "pixels in the inner lines' colour");
        check_at_most("E08", wrong, 0, "pixels whose colour is not what the edge map says, %d x %d", odd[v].width,
                      odd[v].height);
        shot_release(&drawing);
        shape_release(&s);
        shape_release(&one);
    }
}

static int dark_near(const shot *s, dvec position, double radius)
{
    int count = 0;
    for (int y = (int)(position.y - radius); y <= (int)(position.y + radius); y++)
        for (int x = (int)(position.x - radius); x <= (int)(position.x + radius); x++)
            if (x >= 0 && y >= 0 && x < s->width && y < s->height)
                count += pixel(s, x, y)[0] < 100 && pixel(s, x, y)[1] < 100;
    return count;
}

/* Only designated parts have lines; where one meets a plain part there is a line, when the plain one is the
 * complement. */
static void per_object(void)
{
    static const char look[] =
        LOOK("{\"select\":\"plain*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#dddddd\"}},"
             "{\"select\":\"lined*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#eeeeee\"},\"lines\":{"
             "\"operator\":\"discontinuity\"}}");
    for (int complement = 1; complement >= 0; complement--) {
        const char *changes[] = {"layers.complement", complement ? "true" : "false", NULL};
        shape       s = {0};
        shot        drawing;
        int         away = 0, seam = 0, lined = 0;
        shape_box(&s, "plain block", dvec_of(-1, -1, -1), dvec_of(1, 0, 1));
        shape_box(&s, "lined post", dvec_of(-0.3, -0.5, -0.3), dvec_of(0.3, 0.8, 0.3));
        if (shot_of_shape(&drawing, &s, "objects.glb", look, changes, &views[0])) {
            for (int i = 0; i <= 50; i++) {
                double t = i / 50.0;
                away += dark_near(&drawing, shot_project(&drawing, dvec_of(-1 + 2 * t, -1, 1)), 3) > 0;
                away += dark_near(&drawing, shot_project(&drawing, dvec_of(1, -1 + 0.9 * t, 1)), 3) > 0;
                if (t > 0.1 && t < 0.9) {
                    seam += dark_near(&drawing, shot_project(&drawing, dvec_of(-0.3 + 0.6 * t, 0, 0.3)), 1.5) > 0;
                    lined += dark_near(&drawing, shot_project(&drawing, dvec_of(-0.3 + 0.6 * t, 0.8, 0.3)), 1.5) > 0;
                }
            }
        }
        check_at_most("E17", away, 0, "places along the plain block with a line");
        check_at_least("E17", lined, 39, "of 39 places along the designated post's edge with a line");
        if (complement)
            check_at_least("E18", seam, 39, "of 39 places of the intersection with a line");
        else
            check_note("without the complement: %d of 39", seam);
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* A figure drawn by ids alone is an outline; the background beside it keeps all its lines. */
static void id_only(void)
{
    static const char look[] =
        LOOK("{\"select\":\"arch\",\"surface\":\"flat\",\"lines\":{\"operator\":\"discontinuity\"}},"
             "{\"select\":\"person\",\"surface\":\"flat\",\"lines\":{\"operator\":\"id\"}}");
    shape s = {0};
    shot  drawing;
    int   inner = 0, outline = 0, open = 0, arch = 0;
    shape_box(&s, "arch", dvec_of(-1.2, -1, -1.4), dvec_of(1.2, 1, -1));
    shape_torus(&s, "person", 0.5, 0.2, 64, 32);
    shape_place(&s, dvec_of(1, 0, 0), 55, dvec_of(0, 0, 0.2));
    if (shot_of_shape(&drawing, &s, "abstract.glb", look, NULL, &views[0])) {
        for (int y = 3; y + 3 < drawing.height; y++)
            for (int x = 3; x + 3 < drawing.width; x++) {
                bool deep = true, rim = false;
                for (int k = 0; k < 49; k++)
                    deep = deep && drawing.id[(y + k / 7 - 3) * drawing.width + x + k % 7 - 3] == 2;
                for (int k = 1; k < 9; k += 2)
                    rim = rim || drawing.id[(y + k / 3 - 1) * drawing.width + x + k % 3 - 1] != 2;
                rim = rim && drawing.id[y * drawing.width + x] == 2;
                inner += deep && pixel(&drawing, x, y)[0] < 128;
                outline += rim;
                open += rim && pixel(&drawing, x, y)[0] >= 128;
            }
        for (int i = 1; i < 50; i++)
            arch += dark_near(&drawing, shot_project(&drawing, dvec_of(1.2, -1 + i / 25.0, -1)), 1.5) > 0;
    }
    check_at_most("E23", inner, 0, "dark pixels inside the figure that has id lines only");
    check_at_least("E23", outline, 100, "pixels of its outline");
    check_at_most("E23", open, 0, "of them without a line");
    check_at_least("E23", arch, 49, "of 49 places along an inner edge of the background with a line");
    shot_release(&drawing);
    shape_release(&s);
}

/* How much ink lies on each side of the upright boundary x = 0 of a plate, in pixels, row by row. */
static void measure_boundary(const shot *s, double boundary, double *outside, double *inside)
{
    *outside = *inside = 0;
    for (int y = s->height / 2 - 10; y < s->height / 2 + 10; y++)
        for (int x = (int)boundary - 24; x < (int)boundary + 24; x++) {
            double ink = 1 - picture_shown(pixel(s, x, y)[0]);
            *(x + 0.5 < boundary ? outside : inside) += ink / 20;
        }
}

/* Width and symmetry of outlines at several requested widths and sizes of picture. */
static void widths(void)
{
    static const char *const requested[] = {"1px", "2px", "3px", "4px", "6px", "9px"};
    static const char *const operators[] = {"discontinuity", "four-tap", "id"};
    for (int size = 128; size <= 512; size *= 2)
        for (int o = 0; o < 3; o++)
            for (int w = 0; w < 6; w++) {
                const char     *changes[] = {"lines.width", requested[w], "lines.colour", "#000000", NULL};
                const shot_view view = {
                    .width = size, .height = size, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
                char   lines[64];
                shape  s = {0};
                shot   drawing;
                double outside, inside, wanted = atof(requested[w]);
                shape_box(&s, "plate", dvec_of(0, -2, -1), dvec_of(2, 2, 0));
                snprintf(lines, sizeof lines, "{\"operator\":\"%s\"}", operators[o]);
                if (shot_of_shape(&drawing, &s, "plate.glb", shot_line_look(lines), changes, &view)) {
                    measure_boundary(&drawing, size / 2.0, &outside, &inside);
                    check_near("E21", outside + inside, wanted, wanted <= 2 ? 0.5 : 1,
                               "%s, width %s at %d px: ink across the outline", operators[o], requested[w], size);
                    if (wanted >= 2)
                        check_near("E20", outside, inside, 0.5, "  outside and inside");
                }
                shot_release(&drawing);
                shape_release(&s);
            }
}

/* Lines are where they are, whatever their colour: outlines lie half beyond what has a depth of its own. */
static void ink_of_any_colour(void)
{
    static const char *const colours[] = {"#000000", "#ff0000", "#00ff00", "#0000ff"};
    static const char *const looks[] = {LOOK("{\"surface\":{\"technique\":\"flat\",\"colour\":\"#808080\"},\"lines\":{"
                                             "\"operator\":\"four-tap\",\"width\":3}}"),
                                        LOOK("{\"surface\":{\"technique\":\"flat\",\"colour\":\"#808080\"},\"lines\":{"
                                             "\"operator\":\"four-tap\",\"width\":3},"
                                             "\"perturb\":{\"technique\":\"uncertainty\",\"amount\":3}}")};
    for (int l = 0; l < 2; l++) {
        int covered[4] = {0};
        for (int c = 0; c < 4; c++) {
            const char *changes[] = {"lines.colour", colours[c], NULL};
            shape       s = {0};
            shot        drawing;
            shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 32, 64, true);
            if (shot_of_shape(&drawing, &s, "coloured.glb", looks[l], changes, &views[0]))
                for (int i = 0; i < drawing.width * drawing.height; i++) {
                    const uint8_t *p = &drawing.picture[4 * i];
                    covered[c] += p[0] < 230 || p[1] < 230 || p[2] < 230;
                }
            shot_release(&drawing);
            shape_release(&s);
        }
        check_at_least("E20", covered[0], 1000, "%s: pixels of a ball and its lines", l ? "sketch" : "sprite");
        for (int c = 1; c < 4; c++)
            check_near("E20", covered[c], covered[0], 0.003 * covered[0], "  the same, lines %s", colours[c]);
    }
}

/* What other rules draw elsewhere on the page takes nothing away from outlines. */
static void outlines_beside_others(void)
{
    static const char look[] = LOOK("{\"select\":\"plate\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},"
                                    "\"lines\":{\"operator\":\"four-tap\","
                                    "\"width\":\"4px\",\"colour\":\"#000000\"}},{\"select\":\"other\",\"surface\":{"
                                    "\"technique\":\"flat\",\"colour\":\"#ffffff\"}}");
    const shot_view   view = {.width = 256, .height = 256, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
    for (int turned = 0; turned < 2; turned++) {
        shape s = {0};
        shot  drawing;
        int   outside = 0, inside = 0;
        shape_box(&s, "plate", turned ? dvec_of(-2, 0, -1) : dvec_of(0, -2, -1), dvec_of(2, 2, 0));
        shape_box(&s, "other", dvec_of(-2, -2, -1), dvec_of(-1.8, -1.8, 0));
        if (shot_of_shape(&drawing, &s, "beside.glb", look, NULL, &view)) {
            /* The plate begins in the middle of the picture. */
            const dvec origin = shot_project(&drawing, dvec_of(0, 0, 0));
            for (int k = 1; k <= 4; k++) {
                const int middle = (int)(turned ? origin.y : origin.x),
                          across = (int)(turned ? origin.x : origin.y) - 40;
                const int off[2] = {turned ? middle + k - 1 : middle - k, turned ? middle - k : middle + k - 1};
                outside += turned ? pixel(&drawing, across, off[0])[0] < 128 : pixel(&drawing, off[0], across)[0] < 128;
                inside += turned ? pixel(&drawing, across, off[1])[0] < 128 : pixel(&drawing, off[1], across)[0] < 128;
            }
        }
        check_near("E20", outside, 2, 0, "%s outline beside another rule: dark pixels outside",
                   turned ? "level" : "upright");
        check_near("E20", inside, 2, 0, "  and inside");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* A sketch's fill is as deep as the pixels that it is mixed of: between its plates others stand in front of the farther
 * one, up to the nearer one's border. */
static void fills_are_as_deep_as_their_pixels(void)
{
    static const char look[] = LOOK(
        "{\"select\":\"plate*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"},\"perturb\":{\"technique\":"
        "\"uncertainty\",\"amount\":0.002}},{\"select\":\"other\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#"
        "0000ff\"}}");
    const shot_view view = {.width = 128, .height = 128, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
    for (int side = 0; side < 4; side++) {
        const double x = side == 0 ? 1 : side == 1 ? -1 : 0, y = side == 2 ? 1 : side == 3 ? -1 : 0;
        shape        s = {0};
        shot         drawing;
        int          rows = 0;
        shape_box(&s, "plate far", dvec_of(-2, -2, -1), dvec_of(2, 2, -0.9));
        shape_box(&s, "plate near", dvec_of(fmin(0, 2 * x) - 2 * fabs(y), fmin(0, 2 * y) - 2 * fabs(x), 0.9),
                  dvec_of(fmax(0, 2 * x) + 2 * fabs(y), fmax(0, 2 * y) + 2 * fabs(x), 1));
        shape_box(&s, "other", dvec_of(-2, -2, 0), dvec_of(2, 2, 0.1));
        if (shot_of_shape(&drawing, &s, "plates.glb", look, NULL, &view)) {
            /* From the middle of the page to the side that has no near plate. */
            const dvec origin = shot_project(&drawing, dvec_of(0, 0, 0));
            for (int along = -40; along <= 40; along++) {
                int found = 0;
                for (int k = 0; k < 6; k++) {
                    const int at_x = (int)floor(origin.x - x * (k + 0.5)) + (y != 0 ? along : 0),
                              at_y = (int)floor(origin.y + y * (k + 0.5)) + (x != 0 ? along : 0);
                    found += is_colour(pixel(&drawing, at_x, at_y), 255, 0, 0, 60);
                }
                rows = found > rows ? found : rows;
            }
        }
        check_at_most("S06", rows, 1, "side %d: pixels beyond the nearer plate that are as near", side);
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* A slanted outline is antialiased when samples are asked for, and its width does not change. */
static void slanted_width(void)
{
    for (int samples = 1; samples <= 16; samples *= 4) {
        const char     *changes[] = {"lines.colour", "#000000", NULL};
        const shot_view view = {
            .width = 256, .height = 256, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .samples = samples};
        shape  s = {0};
        shot   drawing;
        double ink = 0;
        int    grey = 0;
        shape_box(&s, "plate", dvec_of(0, -6, -1), dvec_of(6, 6, 0));
        shape_place(&s, dvec_of(0, 0, 1), 20, dvec_of(0, 0, 0));
        if (shot_of_shape(&drawing, &s, "slanted.glb", shot_line_look("{\"operator\":\"discontinuity\",\"width\":2}"),
                          changes, &view))
            for (int y = 100; y < 156; y++)
                for (int x = 60; x < 196; x++) {
                    double v = 1 - picture_shown(pixel(&drawing, x, y)[0]);
                    ink += v;
                    grey += v > 0.1 && v < 0.9;
                }
        double across = ink / 56 * cos(20 / 57.29578);
        check_near("E21", across, 2, 0.6, "slanted line of width 2 with %d samples", samples);
        if (samples > 1)
            check_at_least("E21", grey, 56, "antialiased pixels along it");
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* --- mirror --------------------------------------------------------------------------------------------- */

static void add_floor(shape *s, double half)
{
    shape_quad(s, "mirror", half, 0);
    shape_place(s, dvec_of(1, 0, 0), -90, dvec_of(0, 0, 0));
}

/* The box below the floor is what the mirror shows: seen through the floor it must have the reflected box's colour
 * and edges. */
static void mirror(void)
{
    static const char look[] =
        LOOK("{\"select\":\"*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff4040\"},\"lines\":{\"operator\":"
             "\"discontinuity\",\"colour\":\"#000000\"}},"
             "{\"select\":\"mirror\",\"surface\":{\"technique\":\"mirror\",\"reflectivity\":1,\"tint\":\"#8080ff\"}}");
    const shot_view view = {.width = 320, .height = 320, .eye = {2, 3.2, 5}, .target = {0, 0.2, 0}, .up = {0, 1, 0}};
    shape           real = {0}, floor_only = {0}, image = {0};
    shot            drawing;
    shape_box(&real, "box", dvec_of(-0.5, 0.3, -0.5), dvec_of(0.5, 1.1, 0.5));
    add_floor(&real, 1.2);
    add_floor(&floor_only, 1.2);
    shape_box(&image, "image", dvec_of(-0.5, -1.1, -0.5), dvec_of(0.5, -0.3, 0.5));
    if (shot_of_shape(&drawing, &real, "mirror.glb", look, NULL, &view)) {
        tracer   *t_real = tracer_create(&real), *t_image = tracer_create(&image);
        trace_map seen, reflected;
        int       wrong = 0, inside = 0, leaked = 0;
        trace_map_make(&seen, t_real, &drawing);
        trace_map_make(&reflected, t_image, &drawing);
        for (int y = 2; y + 2 < 320; y++)
            for (int x = 2; x + 2 < 320; x++) {
                int            i = y * 320 + x;
                const uint8_t *p = pixel(&drawing, x, y);
                bool           clear = true;
                for (int k = 0; k < 25; k++)
                    clear = clear && seen.id[i + (k / 5 - 2) * 320 + k % 5 - 2] == seen.id[i];
                if (!clear)
                    continue;
                if (seen.id[i] == 2 && !trace_map_border(&reflected, x, y, 0.001)) {
                    bool is_box = is_colour(p, 255, 64, 64, 3), is_line = p[0] < 60 && p[2] < 60;
                    inside++;
                    wrong += reflected.id[i] ? !is_box && !is_line : !is_colour(p, 128, 128, 255, 3) && !is_line;
                }
                leaked += seen.id[i] == 0 && !is_colour(p, 255, 255, 255, 1);
            }
        check_at_least("E14", inside, 3000, "pixels judged inside the mirror");
        check_at_most("E14", wrong, 0.005 * inside, "of them with neither the reflection nor a line");
        check_at_most("E14", leaked, 0, "pixels of the reflection or its lines outside the mirror");
        feature_lines lines;
        feature_find(&lines, &image, t_image, &drawing, 45);
        int samples = 0, found = 0;
        for (size_t k = 0; k < lines.sample_count; k++) {
            int x = (int)lines.samples[k].x, y = (int)lines.samples[k].y;
            if (x < 3 || y < 3 || x > 316 || y > 316 || seen.id[y * 320 + x] != 2 || trace_map_border(&seen, x, y, 1))
                continue;
            samples++;
            found += dark_near(&drawing, dvec_of((double)lines.samples[k].x, (double)lines.samples[k].y, 0), 1) > 0;
        }
        check_at_least("E14", samples, 200, "samples on reflected edges");
        check_at_least("E14", samples ? (double)found / samples : 0, 0.98, "fraction of them with a line");
        feature_release(&lines);
        trace_map_release(&seen);
        trace_map_release(&reflected);
        tracer_destroy(t_real);
        tracer_destroy(t_image);
        picture_write_rgba(check_path("mirror.png"), drawing.picture, 320, 320);
    }
    shot_release(&drawing);
    shape_release(&real);
    shape_release(&image);
    shape_release(&floor_only);
}

/* What a mirror shows is lit as the scene is: by Lambert's law, which no viewer changes. */
static void mirrored_light(void)
{
    static const char look[] =
        "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{\"light_direction\":\"0.48,0.6,0."
        "64\",\"fill\":0},"
        "\"rules\":[{\"select\":\"*\",\"surface\":{\"technique\":\"lambert\",\"ambient\":0}},"
        "{\"select\":\"mirror\",\"surface\":{\"technique\":\"mirror\",\"reflectivity\":1,\"tint\":\"#ffffff\"}}]}";
    const dvec      light = dvec_of(0.48, 0.6, 0.64);
    const shot_view view = {.width = 320, .height = 320, .eye = {2, 3.2, 5}, .target = {0, 0.2, 0}, .up = {0, 1, 0}};
    shape           real = {0}, image = {0};
    shot            drawing;
    shape_box(&real, "box", dvec_of(-0.5, 0.3, -0.5), dvec_of(0.5, 1.1, 0.5));
    add_floor(&real, 1.2);
    shape_box(&image, "image", dvec_of(-0.5, -1.1, -0.5), dvec_of(0.5, -0.3, 0.5));
    if (shot_of_shape(&drawing, &real, "mirror_light.glb", look, NULL, &view)) {
        const dvec upwards = dvec_of(drawing.view[4], drawing.view[5], drawing.view[6]);
        tracer    *t_real = tracer_create(&real), *t_image = tracer_create(&image);
        trace_map  seen, reflected;
        int        judged = 0;
        double     worst = 0, lightest = 0;
        trace_map_make(&seen, t_real, &drawing);
        trace_map_make(&reflected, t_image, &drawing);
        for (int y = 2; y + 2 < 320; y++)
            for (int x = 2; x + 2 < 320; x++) {
                int  i = y * 320 + x;
                bool clear = reflected.id[i] != 0;
                for (int k = 0; k < 9; k++) {
                    int beside = i + (k / 3 - 1) * 320 + k % 3 - 1;
                    clear = clear && seen.id[beside] == 2 && reflected.id[beside] == reflected.id[i] &&
                            dvec_dot(reflected.normal[beside], reflected.normal[i]) > 0.99;
                }
                if (!clear)
                    continue;
                dvec   n = reflected.normal[i];
                double wanted = fmax(dvec_dot(dvec_add(n, dvec_scale(upwards, -2 * dvec_dot(n, upwards))), light), 0);
                worst = fmax(worst, fabs(picture_linear(pixel(&drawing, x, y)[0]) - wanted));
                lightest = fmax(lightest, wanted);
                judged++;
            }
        check_at_least("E14", judged, 1500, "pixels of a lit box in a mirror");
        check_at_least("E14", lightest, 0.3, "  light of the lightest");
        check_at_most("E14", worst, 0.02, "  light off what Lambert says of the box itself");
        trace_map_release(&seen);
        trace_map_release(&reflected);
        tracer_destroy(t_real);
        tracer_destroy(t_image);
    }
    shot_release(&drawing);
    shape_release(&real);
    shape_release(&image);
}

/* What stands behind a mirror, between the viewer's image and what is reflected, does not show in it. */
static void mirrors_clip(void)
{
    static const char look[] =
        LOOK("{\"select\":\"*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff4040\"}},"
             "{\"select\":\"below\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#00c000\"}},"
             "{\"select\":\"mirror\",\"surface\":{\"technique\":\"mirror\",\"reflectivity\":1}}");
    const shot_view view = {.width = 320, .height = 320, .eye = {2, 3.2, 5}, .target = {0, 0.2, 0}, .up = {0, 1, 0}};
    shape           real = {0};
    shot            drawing;
    int             green = 0, red = 0;
    shape_box(&real, "box", dvec_of(-0.5, 0.3, -0.5), dvec_of(0.5, 1.1, 0.5));
    add_floor(&real, 1.2);
    shape_box(&real, "below", dvec_of(-0.6, -0.5, -0.2), dvec_of(0.9, -0.1, 1));
    if (shot_of_shape(&drawing, &real, "mirror_clip.glb", look, NULL, &view))
        for (int i = 0; i < 320 * 320; i++)
            if (drawing.id[i] == 2) {
                const uint8_t *p = &drawing.picture[4 * i];
                green += p[1] > 150 && p[0] < 60;
                red += p[0] > 150 && p[1] < 120;
            }
    check_at_least("E14", red, 800, "pixels of the box in a mirror with another one behind it");
    check_at_most("E14", green, 0, "  pixels of that one");
    shot_release(&drawing);
    shape_release(&real);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"sprites", sprites_interleave},
        {"shallow", shallow_crossing},
        {"deferred", deferred_shading},
        {"forms", forms_agree},
        {"colours", superimposed_colours},
        {"objects", per_object},
        {"abstract", id_only},
        {"widths", widths},
        {"colours-of-ink", ink_of_any_colour},
        {"beside", outlines_beside_others},
        {"plates", fills_are_as_deep_as_their_pixels},
        {"slanted", slanted_width},
        {"mirror", mirror},
        {"mirror-light", mirrored_light},
        {"mirror-clip", mirrors_clip},
    };
    int status = check_main(argc, argv, "compose", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
