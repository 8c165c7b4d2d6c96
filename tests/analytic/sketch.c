/* Figures drawn with uncertainty against a CPU twin: which place each pixel shows, how lines and fill part, and
 * what lies before what. */
#include <limner/draw.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"
#include "scenes.h"
#include "sketch_twin.h"

#define LOOK(RULES)            "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ece4d2\"},\"rules\":[" RULES "]}"
#define OWN_COLOUR             "\"surface\":{\"technique\":\"flat\",\"model_colour\":1}"
#define BLUE_FILL              "\"surface\":{\"technique\":\"flat\",\"colour\":\"#3060c0\"}"
#define LINES                  "\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#000000\"}"
#define SHADES(XX, XY, YX, YY) "\"shades_xx\":" #XX ",\"shades_xy\":" #XY ",\"shades_yx\":" #YX ",\"shades_yy\":" #YY
#define EDGES(XX, XY, YX, YY)  "\"edges_xx\":" #XX ",\"edges_xy\":" #XY ",\"edges_yx\":" #YX ",\"edges_yy\":" #YY

static const uint8_t ground_bytes[3] = {0xec, 0xe4, 0xd2}, black_bytes[3] = {0, 0, 0},
                     blue_bytes[3] = {0x30, 0x60, 0xc0};

/* Parallel rays that meet flat plates at right angles; 70 px a unit at 300 px. */
static const shot_view front = {.width = 300, .height = 300, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true};
static const shot_view slanted = {.width = 320, .height = 256, .eye = {4, 3, 5}, .up = {0, 1, 0}};

/* A look with one rule for everything and this perturbation (an object's JSON, or NULL); valid until the next call
 * but seven. */
static const char *look_of(const char *rule, const char *perturb)
{
    static char texts[8][1024];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 8;
    snprintf(text, sizeof texts[0], LOOK("{\"select\":\"*\",%s%s%s}"), rule, perturb ? ",\"perturb\":" : "",
             perturb ? perturb : "");
    return text;
}

static sketch_style style_of(double amount)
{
    return (sketch_style){.amount = amount,
                          .edges = sketch_scaled(1),
                          .shades = sketch_scaled(-0.75),
                          .ink = sketch_colour(black_bytes, 1),
                          .fallback = sketch_colour(ground_bytes, 1),
                          .ground = sketch_colour(ground_bytes, 1)};
}

/* Less of a pixel need not be seen. */
static const double faintest = 0.02;

static bool is_ground(const shot *s, int x, int y)
{
    return sketch_levels_off(sketch_pixel(s, x, y), sketch_colour(ground_bytes, 1)) < 2;
}

/* A turned plate and a ring, both seen from the front. */
static void plates(shape *s)
{
    shape_quad(s, "plate", 0.8, 0);
    shape_place(s, dvec_of(0, 0, 1), 17, dvec_of(-0.6, 0.4, 0));
    shape_torus(s, "ring", 0.6, 0.25, 64, 24);
    shape_place(s, dvec_of(1, 0, 0), 90, dvec_of(0.8, -0.7, 0.3));
    scene_colour(s);
}

/* --- nothing is perturbed without degree ---------------------------------------------------------------- */

static size_t differing(const shot *a, const shot *b)
{
    size_t count = 0;
    for (int i = 0; i < a->width * a->height; i++)
        count += memcmp(&a->picture[4 * i], &b->picture[4 * i], 4) != 0;
    return count;
}

static void zero(void)
{
    static const struct {
        const char *what, *rule;
    } rules[] = {
        {"lit with lines", "\"surface\":\"lit\"," LINES},
        {"flat", OWN_COLOUR},
        {"four-tap lines", OWN_COLOUR ",\"lines\":{\"operator\":\"four-tap\",\"gain\":20}"},
        {"several lines", "\"surface\":\"lit\",\"lines\":[{\"operator\":\"four-tap\",\"colour\":\"#802020\",\"gain\":"
                          "20},{\"operator\":\"discontinuity\",\"width\":4}]"},
        {"dashes", "\"surface\":\"lit\",\"lines\":{\"operator\":\"discontinuity\",\"dash\":9,\"gap\":5}"},
        {"double contrast", "\"surface\":\"lit\",\"lines\":{\"operator\":\"discontinuity\",\"contrast\":\"double\"}"},
        {"adaptive contrast",
         "\"surface\":\"lit\",\"lines\":{\"operator\":\"discontinuity\",\"contrast\":\"adaptive\"}"},
        {"blueprint", "\"surface\":\"flat\",\"layers\":\"peel\"," LINES ",\"compose\":\"blueprint\""},
        {"wire", "\"surface\":\"flat\",\"layers\":\"peel\"," LINES ",\"compose\":\"wire\""},
        {"xray", OWN_COLOUR ",\"layers\":\"peel\"," LINES ",\"compose\":\"xray\""},
    };
    static const char *const degrees[] = {
        "{\"technique\":\"uncertainty\",\"amount\":0%s}",
        "{\"technique\":\"uncertainty\",\"amount\":5," EDGES(0, 0, 0, 0) "," SHADES(0, 0, 0, 0) ",\"rough\":0%s}",
    };
    shape s = {0};
    scene_make(&s, SCENE_CLOSED, 31);
    for (size_t r = 0; r < sizeof rules / sizeof *rules; r++)
        for (int samples = 1; samples <= 4; samples += 3) {
            shot_view view = {.width = 144,
                              .height = 112,
                              .eye = {4, 3, 5},
                              .up = {0, 1, 0},
                              .samples = samples,
                              .without_maps = true};
            shot      exact, drawn;
            size_t    count = 0;
            int       compared = 0;
            bool      taken = shot_of_shape(&exact, &s, "zero.glb", look_of(rules[r].rule, NULL), NULL, &view);
            for (int d = 0; d < 4 && taken; d++) {
                char perturb[256];
                snprintf(perturb, sizeof perturb, degrees[d / 2], d % 2 ? ",\"lock\":\"screen\"" : "");
                if (shot_of_shape(&drawn, &s, "zero.glb", look_of(rules[r].rule, perturb), NULL, &view)) {
                    count += differing(&exact, &drawn);
                    compared++;
                }
                shot_release(&drawn);
            }
            check_near("S03", compared, 4, 0, "%s, samples %d: drawings without amount or degrees", rules[r].what,
                       samples);
            check_at_most("S03", (double)count, 0, "  their pixels that differ from the drawing without perturbation");
            shot_release(&exact);
        }
    shape_release(&s);
}

/* --- displacement --------------------------------------------------------------------------------------- */

/* Without lines the fill is where its position is inside. */
static void fill_masks(void)
{
    static const struct {
        const char   *perturb;
        double        amount;
        sketch_degree shades;
    } cases[] = {
        {"{\"technique\":\"uncertainty\",\"amount\":6}", 6, {-0.75, 0, 0, -0.75}},
        {"{\"technique\":\"uncertainty\",\"amount\":10,\"lock\":\"screen\",\"scale\":40}", 10, {-0.75, 0, 0, -0.75}},
        {"{\"technique\":\"uncertainty\",\"amount\":8,\"lock\":\"screen\"," SHADES(1, 0, 0, 0) "}", 8, {1, 0, 0, 0}},
        {"{\"technique\":\"uncertainty\",\"amount\":8," SHADES(0, 0, 0, 1) "}", 8, {0, 0, 0, 1}},
        {"{\"technique\":\"uncertainty\",\"amount\":7,\"field\":\"turbulence\"," SHADES(0.5, -1.2, 0.8, 0.3) "}",
         7,
         {0.5, -1.2, 0.8, 0.3}},
        {"{\"technique\":\"uncertainty\",\"amount\":9,\"lock\":\"screen\",\"octaves\":4," SHADES(0.8660254, -0.5, 0.5,
                                                                                                 0.8660254) "}",
         9,
         {0.8660254, -0.5, 0.5, 0.8660254}},
    };
    shape s = {0};
    plates(&s);
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        shot drawn;
        int  right = 0, moved = 0;
        if (!shot_of_shape(&drawn, &s, "plates.glb", look_of(OWN_COLOUR, cases[c].perturb), NULL, &front))
            continue;
        sketch_maps m = sketch_maps_of(&drawn);
        if (check_that("C13", m.uncertainty != NULL, "the drawing has its field of uncertainty"))
            for (int y = 0; y < m.height; y++)
                for (int x = 0; x < m.width; x++) {
                    sketch_position f = sketch_moved(&m, x, y, cases[c].amount, cases[c].shades);
                    bool            inside = isfinite(sketch_depth(&m, f)), ground = is_ground(&drawn, x, y);
                    double          fill = sketch_shade(&m, f).a; /* at borders a fraction */
                    right += fill > faintest ? !ground : fill > 0 || ground;
                    moved += inside != isfinite(sketch_depth(&m, (sketch_position){x, y}));
                }
        check_at_least("C13", (double)right / (m.width * m.height), 0.999,
                       "fraction of pixels with fill where predicted, %s", cases[c].perturb);
        check_at_least("C13", moved, 300, "  pixels that the perturbation gives fill or takes it");
        shot_release(&drawn);
    }
    shape_release(&s);
}

/* Ink over fill over ground, everywhere. */
static void whole_pictures(void)
{
    static const struct {
        const char   *perturb;
        double        amount;
        sketch_degree edges, shades;
    } cases[] = {
        {"{\"technique\":\"uncertainty\"}", 4, {1, 0, 0, 1}, {-0.75, 0, 0, -0.75}},
        {"{\"technique\":\"uncertainty\",\"amount\":12,\"lock\":\"screen\"}", 12, {1, 0, 0, 1}, {-0.75, 0, 0, -0.75}},
        {"{\"technique\":\"uncertainty\",\"amount\":8,\"field\":\"turbulence\",\"octaves\":3,\"scale\":45," EDGES(
             1, 0, 0, 0) "," SHADES(-1, 0, 0, 0) "}",
         8,
         {1, 0, 0, 0},
         {-1, 0, 0, 0}},
        {"{\"technique\":\"uncertainty\",\"amount\":7," EDGES(0.4, 1.1, -0.7, 0.6) "," SHADES(-0.3, 0.9, 1.2, -0.5) "}",
         7,
         {0.4, 1.1, -0.7, 0.6},
         {-0.3, 0.9, 1.2, -0.5}},
        {"{\"technique\":\"uncertainty\",\"amount\":6,\"by\":\"normal\",\"seed\":5}",
         6,
         {1, 0, 0, 1},
         {-0.75, 0, 0, -0.75}},
        {"{\"technique\":\"uncertainty\",\"amount\":6,\"outward\":\"enlarged\",\"seed\":6}",
         6,
         {1, 0, 0, 1},
         {-0.75, 0, 0, -0.75}},
    };
    static const uint8_t ink_bytes[3] = {0x10, 0x20, 0x80}, odd_bytes[3] = {0xff, 0x00, 0xff};
    for (size_t c = 0; c < sizeof cases / sizeof *cases; c++) {
        char         perturb[384];
        shape        s = {0};
        shot         drawn;
        sketch_style style = style_of(cases[c].amount);
        shot_view    view = slanted;
        view.orthographic = c % 3 == 1;
        style.edges = cases[c].edges;
        style.shades = cases[c].shades;
        style.ink = sketch_colour(ink_bytes, 0xc0 / 255.0);
        style.fallback = sketch_colour(odd_bytes, 1);
        scene_make(&s, c % 2 ? SCENE_CROSSING : SCENE_CLOSED, 40 + (uint32_t)c);
        scene_colour(&s);
        snprintf(perturb, sizeof perturb, "%.*s,\"fallback\":\"#ff00ff\"}", (int)strlen(cases[c].perturb) - 1,
                 cases[c].perturb);
        if (shot_of_shape(
                &drawn, &s, "whole.glb",
                look_of(OWN_COLOUR ",\"lines\":{\"operator\":\"discontinuity\",\"colour\":\"#102080c0\"}", perturb),
                NULL, &view))
            sketch_check_opaque("S03", &drawn, &style, 3, 0.995, cases[c].perturb);
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* Where a line that runs upwards has its middle in row y: the mean of its ink from `low` to `high`; NAN without
 * ink. */
static double line_middle(const shot *s, int y, int low, int high)
{
    double sum = 0, weight = 0;
    for (int x = low; x <= high; x++) {
        double ink = 255 - sketch_pixel(s, x, y)[1];
        sum += ink * x;
        weight += ink;
    }
    return weight > 100 ? sum / weight : NAN;
}

/* Where fill begins in row y, between `low`, which is outside, and `high`, to a fraction of a pixel by its partial
 * colour. */
static double fill_begin(const shot *s, int y, int low, int high)
{
    double sum = 0;
    for (int x = low; x <= high; x++)
        sum += (255 - sketch_pixel(s, x, y)[1]) / 255.0;
    return high + 0.5 - sum;
}

/* The position x in row y that an exact edge at `edge` is moved to: x + amount·degree·n(x) = edge. The field is so
 * slow that there is one. */
static double moved_edge(const sketch_maps *m, double edge, int y, double amount, double degree)
{
    double low = edge - 2 * amount, high = edge + 2 * amount;
    for (int i = 0; i < 60; i++) {
        double middle = (low + high) / 2;
        if (middle + amount * degree * sketch_field(m, middle, y, 0) < edge)
            low = middle;
        else
            high = middle;
    }
    return low;
}

static const char bare_white[] = "\"surface\":{\"technique\":\"flat\",\"colour\":\"none\"},\"lines\":{\"operator\":"
                                 "\"discontinuity\",\"colour\":\"#000000\"}";
static const char bare_fill[] = "\"surface\":{\"technique\":\"flat\",\"colour\":\"#000000\"}";

/* Along the left side of a plate, once drawn as lines alone and once as fill alone. */
static void contrary(void)
{
    const struct {
        const char *lock;
        double      shades;
        int         seed;
    } cases[] = {
        {"object", -0.75, 0}, {"object", -0.75, 1}, {"object", -0.75, 2}, {"screen", -0.75, 3}, {"screen", -1.5, 4}};
    int over = 0, under = 0;
    for (int c = 0; c < 5; c++) {
        char  perturb[256];
        shape s = {0};
        shot  line, fill, exact_line, exact_fill;
        snprintf(perturb, sizeof perturb,
                 "{\"technique\":\"uncertainty\",\"amount\":5,\"scale\":110,\"octaves\":1,\"seed\":%d,\"lock\":\"%s\","
                 "\"shades_xx\":%g,\"shades_yy\":0,\"edges_yy\":0}",
                 cases[c].seed, cases[c].lock, cases[c].shades);
        const char *change[] = {"finish.ground", "#ffffff", NULL};
        shot_view   view = front;
        view.width = view.height = 400;
        shape_quad(&s, "plate", 1.6, 0);
        bool ok = shot_of_shape(&line, &s, "side.glb", look_of(bare_white, perturb), change, &view);
        ok = shot_of_shape(&fill, &s, "side.glb", look_of(bare_fill, perturb), change, &view) && ok;
        ok = shot_of_shape(&exact_line, &s, "side.glb", look_of(bare_white, NULL), change, &view) && ok;
        ok = shot_of_shape(&exact_fill, &s, "side.glb", look_of(bare_fill, NULL), change, &view) && ok;
        if (ok &&
            check_that("S04", line.uncertainty && fill.uncertainty, "the drawings have their fields of uncertainty")) {
            dvec        corner = shot_project(&exact_line, dvec_of(-1.6, 0, 0));
            int         x0 = (int)corner.x, rows = 0, contrary_rows = 0, judged = 0;
            double      worst_line = 0, worst_fill = 0, ll = 0, lf = 0, ff = 0;
            sketch_maps m = sketch_maps_of(&line);
            for (int y = 75; y < 325; y++) {
                double edge = line_middle(&exact_line, y, x0 - 20, x0 + 20),
                       border = fill_begin(&exact_fill, y, x0 - 20, x0 + 20);
                double l = line_middle(&line, y, x0 - 20, x0 + 20) - edge,
                       f = fill_begin(&fill, y, x0 - 20, x0 + 20) - border;
                rows++;
                worst_line = fmax(worst_line, fabs(l + edge - moved_edge(&m, edge, y, 5, 1)));
                /* fill begins half a pixel before the first filled centre */
                worst_fill = fmax(worst_fill, fabs(f + border - moved_edge(&m, border, y, 5, cases[c].shades)));
                ll += l * l;
                lf += l * f;
                ff += f * f;
                judged += fabs(l) > 0.6;
                contrary_rows += fabs(l) > 0.6 && l * f < 0;
                over += f < l - 1;
                under += f > l + 1;
            }
            check_at_most("C13", worst_line, 0.5,
                          "%s: px between the line's middle and its predicted place, worst of %d rows", cases[c].lock,
                          rows);
            check_at_most("C13", worst_fill, 1, "%s: px between the fill's border and its predicted place",
                          cases[c].lock);
            check_at_least("S04", judged, 80, "rows in which the line moved by more than 0.6 px");
            check_at_least("S04", judged ? (double)contrary_rows / judged : 0, 0.95,
                           "of them, share in which the fill moved the other way");
            check_near("C14", lf / ll, cases[c].shades, 0.25,
                       "how far the fill moves for each px of the line (correlation %.3f)", lf / sqrt(ll * ff));
        }
        shot_release(&line);
        shot_release(&fill);
        shot_release(&exact_line);
        shot_release(&exact_fill);
        shape_release(&s);
    }
    check_at_least("C14", over, 100, "rows in which the fill outgrows the line by more than a pixel");
    check_at_least("C14", under, 100, "rows in which it falls short by more than a pixel");
}

/* With a degree for one direction alone, borders that run that way stay where they are. */
static void one_direction(void)
{
    for (int up = 0; up < 2; up++) {
        const char *perturb = up ? "{\"technique\":\"uncertainty\",\"amount\":10,\"lock\":\"screen\"," EDGES(
                                       0, 0, 0, 1) "," SHADES(0, 0, 0, 1) "}"
                                 : "{\"technique\":\"uncertainty\",\"amount\":10,\"lock\":\"screen\"," EDGES(
                                       1, 0, 0, 0) "," SHADES(1, 0, 0, 0) "}";
        shape       s = {0};
        shot        drawn, exact;
        int         along = 0, across = 0;
        shape_quad(&s, "plate", 1, 0);
        bool ok = shot_of_shape(&exact, &s, "straight.glb", look_of(BLUE_FILL "," LINES, NULL), NULL, &front);
        if (shot_of_shape(&drawn, &s, "straight.glb", look_of(BLUE_FILL "," LINES, perturb), NULL, &front) && ok)
            for (int side = 0; side < 2; side++)
                for (int k = 110; k < 190; k++)
                    for (int d = -12; d <= 12; d++) {
                        int    at = (side ? 80 : 220) + d;
                        size_t top = 4 * (size_t)(at * 300 + k), left = 4 * (size_t)(k * 300 + at);
                        bool   of_top = memcmp(&drawn.picture[top], &exact.picture[top], 4) != 0,
                             of_left = memcmp(&drawn.picture[left], &exact.picture[left], 4) != 0;
                        along += up ? of_left : of_top;
                        across += up ? of_top : of_left;
                    }
        check_at_most("C15", along, 0, "pixels that differ at sides along which everything moves, degree %s alone",
                      up ? "yy" : "xx");
        check_at_least("C15", across, 500, "  and at the sides that move");
        shot_release(&drawn);
        shot_release(&exact);
        shape_release(&s);
    }
}

/* --- interior and exterior ------------------------------------------------------------------------------ */

/* Connected pieces (by sides) of the pixels with the flag; the largest has *largest pixels. */
static int pieces_of(const bool *flag, int width, int height, int *largest)
{
    int   count = width * height, pieces = 0;
    int  *stack = check_alloc((size_t)count, sizeof *stack);
    bool *seen = check_alloc((size_t)count, sizeof *seen);
    *largest = 0;
    for (int start = 0; start < count; start++) {
        int size = 0, top = 0;
        if (!flag[start] || seen[start])
            continue;
        seen[start] = true;
        stack[top++] = start;
        while (top > 0) {
            int i = stack[--top], x = i % width;
            int next[4] = {x > 0 ? i - 1 : -1, x + 1 < width ? i + 1 : -1, i - width,
                           i + width < count ? i + width : -1};
            size++;
            for (int k = 0; k < 4; k++)
                if (next[k] >= 0 && flag[next[k]] && !seen[next[k]]) {
                    seen[next[k]] = true;
                    stack[top++] = next[k];
                }
        }
        pieces++;
        *largest = size > *largest ? size : *largest;
    }
    free(stack);
    free(seen);
    return pieces;
}

static void exchange(void)
{
    static const struct {
        const char *perturb;
        int         spots;
    } cases[] = {{"{\"technique\":\"uncertainty\",\"amount\":12,\"lock\":\"screen\"}", 0},
                 {"{\"technique\":\"uncertainty\",\"amount\":40,\"scale\":40,\"octaves\":3,\"lock\":\"screen\"," SHADES(
                      -1.5, 0, 0, -1.5) "}",
                  3}};
    for (int c = 0; c < 2; c++) {
        shape     s = {0};
        shot      drawn;
        shot_view view = front;
        view.width = view.height = 512;
        shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
        if (shot_of_shape(&drawn, &s, "ball.glb", look_of(BLUE_FILL, cases[c].perturb), NULL, &view)) {
            int         outside = 0, holes = 0, largest, largest_hole;
            bool       *filled = check_alloc(512 * 512, sizeof *filled), *bare = check_alloc(512 * 512, sizeof *bare);
            sketch_maps m = sketch_maps_of(&drawn);
            for (int i = 0; i < 512 * 512; i++) {
                bool was = isfinite(m.depth[i]);
                filled[i] = !is_ground(&drawn, i % 512, 511 - i / 512);
                bare[i] = !filled[i];
                outside += filled[i] && !was;
                holes += !filled[i] && was;
            }
            int spots = pieces_of(filled, 512, 512, &largest) - 1,
                islands = pieces_of(bare, 512, 512, &largest_hole) - 1;
            check_at_least("S05", outside, 300, "pixels with fill outside the silhouette, %s", cases[c].perturb);
            check_at_least("S05", holes, 300, "  and without it inside");
            check_at_least("S05", spots, cases[c].spots,
                           "  spots of fill apart from the largest, which has %d px; holes: %d", largest, islands);
            free(filled);
            free(bare);
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* --- depth ---------------------------------------------------------------------------------------------- */

static const uint8_t green_bytes[3] = {0x20, 0xb0, 0x40}, odd_bytes[3] = {0xff, 0x00, 0xff};

#define FIGURE(SELECT, COLOUR, REST)                                                                                   \
    "{\"select\":\"" SELECT                                                                                            \
    "\",\"layers\":{\"complement\":false},\"surface\":{\"technique\":\"flat\",\"colour\":\"" COLOUR "\"}" REST "}"
#define ANCHOR   FIGURE("anchor", "#808080", "") ","
#define ID_LINES ",\"lines\":{\"operator\":\"id\",\"colour\":\"#000000\"}"
#define WAVES    ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":9,\"scale\":50,\"fallback\":\"#ff00ff\"}"
#define THRICE                                                                                                         \
    ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":9,\"scale\":50,\"repeat\":3,\"repeat_degree\":0.8,"        \
    "\"repeat_colours\":[\"#000000\"]}"
#define SCREEN_WAVES                                                                                                   \
    ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":12,\"scale\":70,\"lock\":\"screen\",\"fallback\":\"#"      \
    "ff00ff\"," EDGES(0, 1, -1, 0) "," SHADES(0.6, 0.4, 0, -1) "}"

/* A ball half inside a tilted box. The field is measured from the middle of what is drawn: an anchor outside the
 * picture keeps it where it is when one part is left out. */
static void half_inside(shape *s)
{
    shape_sphere(s, "ball", dvec_of(-0.3, 0.1, 0.1), 1, 48, 96, true);
    shape_box(s, "sharp", dvec_of(-0.7, -0.6, -0.9), dvec_of(0.8, 0.7, 0.9));
    shape_place(s, dvec_of(1, 2, 0.5), 28, dvec_of(0.6, -0.2, 0));
    scene_anchor(s, "anchor", dvec_of(-9, -4, 9), dvec_of(9, 4, -9));
}

/* Draws both parts and each alone, and predicts by each one's own maps which of them is seen. */
static void against_each(const char *what, const char *look, const sketch_style *ball, const sketch_style *sharp,
                         const shot_view *view)
{
    shape s = {0};
    shot  both, alone[2];
    half_inside(&s);
    bool ok = shot_of_shape(&both, &s, "half.glb", look, NULL, view);
    for (int k = 0; k < 2; k++) {
        shot_view own = *view;
        own.select = k ? "sharp,anchor" : "ball,anchor";
        ok = shot_of_shape(&alone[k], &s, "half.glb", look, NULL, &own) && ok;
    }
    if (ok) {
        sketch_maps  m[2] = {sketch_maps_of(&alone[0]), sketch_maps_of(&alone[1])};
        sketch_tally t = {0};
        int          together = 0, changed = 0;
        for (int y = 0; y < both.height; y++)
            for (int x = 0; x < both.width; x++) {
                double depth[2], own = sketch_depth(&m[0], (sketch_position){x, y}),
                                 other = sketch_depth(&m[1], (sketch_position){x, y});
                sketch_paint p[2], ground = ball->ground;
                p[0] = sketch_opaque(&m[0], ball, x, y, &depth[0]);
                if (sharp)
                    p[1] = sketch_opaque(&m[1], sharp, x, y, &depth[1]);
                else {
                    depth[1] = other;
                    p[1] = sketch_colour(green_bytes, isfinite(other) ? 1 : 0);
                }
                int first = depth[1] < depth[0];
                together += isfinite(depth[0]) && isfinite(depth[1]) && p[0].a > 0;
                changed += (own < other) != (depth[0] < depth[1]) && p[0].a > 0;
                /* What is drawn later and lies in front is blended over what is behind it. */
                sketch_judge(&t, &both, x, y,
                             sketch_over(p[first], p[first].a < 1 ? sketch_over(p[1 - first], ground) : ground), 3);
            }
        sketch_check("S06", &t, &both, 0.998, what);
        int least = ball->without_fill ? 8 : 1; /* lines alone are few pixels */
        check_at_least("C18", together, 1500 / least, "  pixels at which both have something");
        check_at_least("C18", changed, 80 / least, "  pixels at which the perturbation turns which one is seen");
    }
    shot_release(&both);
    shot_release(&alone[0]);
    shot_release(&alone[1]);
    shape_release(&s);
}

static void depths(void)
{
    sketch_style waves = style_of(9), screen = style_of(12), bare = style_of(9);
    waves.fallback = screen.fallback = sketch_colour(odd_bytes, 1);
    screen.edges = (sketch_degree){0, 1, -1, 0};
    screen.shades = (sketch_degree){0.6, 0.4, 0, -1};
    bare.without_lines = true;
    bare.fallback = waves.fallback;
    against_each("a sketched ball half in a sharp box",
                 LOOK(ANCHOR FIGURE("ball", "#d03020", ID_LINES WAVES) "," FIGURE("sharp", "#20b040", "")), &waves,
                 NULL, &slanted);
    against_each("the same with a field on the sheet",
                 LOOK(ANCHOR FIGURE("ball", "#d03020", ID_LINES SCREEN_WAVES) "," FIGURE("sharp", "#20b040", "")),
                 &screen, NULL, &slanted);
    against_each("the sharp part drawn first",
                 LOOK(ANCHOR FIGURE("sharp", "#20b040", "") "," FIGURE("ball", "#d03020", ID_LINES WAVES)), &waves,
                 NULL, &slanted);
    against_each("without lines", LOOK(ANCHOR FIGURE("ball", "#d03020", WAVES) "," FIGURE("sharp", "#20b040", "")),
                 &bare, NULL, &slanted);
    against_each(
        "two sketched parts, each in its way",
        LOOK(ANCHOR FIGURE("ball", "#d03020", ID_LINES WAVES) "," FIGURE("sharp", "#20b040", ID_LINES SCREEN_WAVES)),
        &waves, &screen, &slanted);
    sketch_style thrice = waves;
    thrice.repeat = 3;
    thrice.repeat_degree = 0.8;
    thrice.repeat_inks[0] = thrice.repeat_inks[1] = sketch_colour(black_bytes, 1);
    thrice.without_fill = true;
    against_each("lines drawn three times, without fill",
                 LOOK(ANCHOR "{\"select\":\"ball\",\"layers\":{\"complement\":false},\"surface\":{\"technique\":"
                             "\"flat\",\"colour\":\"none\"}" ID_LINES THRICE "}," FIGURE("sharp", "#20b040", "")),
                 &thrice, NULL, &slanted);
    shot_view parallel = slanted;
    parallel.orthographic = true;
    against_each(
        "two sketched parts, parallel rays",
        LOOK(ANCHOR FIGURE("ball", "#d03020", ID_LINES SCREEN_WAVES) "," FIGURE("sharp", "#20b040", ID_LINES WAVES)),
        &screen, &waves, &parallel);
}

/* Something is drawn exactly where one of the two lookups is inside, or ink lies beside the boundary. */
static void mask_identity(void)
{
    static const char look[] = LOOK(FIGURE("*", "#d03020", ID_LINES SCREEN_WAVES));
    sketch_style      style = style_of(12);
    style.edges = (sketch_degree){0, 1, -1, 0};
    style.shades = (sketch_degree){0.6, 0.4, 0, -1};
    shape s = {0};
    shot  drawn;
    plates(&s);
    if (shot_of_shape(&drawn, &s, "mask.glb", look, NULL, &front)) {
        sketch_maps m = sketch_maps_of(&drawn);
        int missing = 0, more = 0, beside = 0, odd = 0, odd_elsewhere = 0, odd_missing = 0, fill_only = 0, cut_off = 0;
        for (int y = 0; y < drawn.height; y++)
            for (int x = 0; x < drawn.width; x++) {
                sketch_position e = sketch_moved(&m, x, y, 12, style.edges),
                                f = sketch_moved(&m, x, y, 12, style.shades);
                double share = sketch_shade(&m, f).a; /* at borders a fraction */
                bool   line = isfinite(sketch_depth(&m, e)), fill = share > 0, there = !is_ground(&drawn, x, y);
                double edge[4];
                sketch_edge(&m, e, edge);
                double         ink = sketch_ink(edge, style.ink).a;
                const uint8_t *p = sketch_pixel(&drawn, x, y);
                bool           is_odd = p[0] > 240 && p[1] < 20 && p[2] > 240;
                beside += !line && !fill && ink > 0;
                cut_off += !line && !fill && ink > 0.2 && !there;
                missing += (line || share > faintest) && !there;
                more += !line && !fill && ink <= 0 && there;
                odd += line && !fill && ink < 0.01;
                odd_missing += line && !fill && ink < 0.01 && !is_odd;
                odd_elsewhere += is_odd && (!line || share > 0.1);
                fill_only += fill && !line;
            }
        check_note("of %d pixels with ink beside the boundary, %d lose more than a fifth of it because no surface is "
                   "within the line's reach",
                   beside, cut_off);
        check_at_most("C17", missing, 0, "pixels with a lookup inside where nothing is drawn");
        check_at_most("C17", more, 0,
                      "pixels where something is drawn without a lookup inside or ink (beside the boundary: %d)",
                      beside);
        check_at_least("S07", odd, 300, "pixels where only the line's lookup is inside (where only the fill's is: %d)",
                       fill_only);
        check_at_most("S07", odd_missing, 0, "  of them, those without the fallback's colour");
        check_at_most("S07", odd_elsewhere, 0, "  pixels elsewhere that have it");
    }
    shot_release(&drawn);
    shape_release(&s);
}

/* --- fill ----------------------------------------------------------------------------------------------- */

/* Patches of one colour stay patches of one colour, lit or not. */
static void patches(void)
{
    for (int lit = 0; lit < 2; lit++) {
        const char *rule = lit ? "\"surface\":{\"technique\":\"lit\",\"specular\":0}," LINES : OWN_COLOUR "," LINES;
        shape       s = {0};
        shot        drawn, exact;
        shape_box(&s, "box", dvec_of(-1, -1, -1), dvec_of(1, 1, 1));
        scene_colour(&s);
        shot_view view = slanted;
        view.orthographic = true;
        bool ok = shot_of_shape(&exact, &s, "patch.glb", look_of(rule, NULL), NULL, &view);
        if (shot_of_shape(&drawn, &s, "patch.glb", look_of(rule, "{\"technique\":\"uncertainty\",\"amount\":8}"), NULL,
                          &view) &&
            ok) {
            int judged = 0, wrong = 0, tones[256] = {0}, count = 0;
            for (int y = 30; y < drawn.height - 30; y++)
                for (int x = 30; x < drawn.width - 30; x++) {
                    bool constant = true;
                    for (int k = 0; k < 8 && constant; k++) {
                        static const int direction[8][2] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                                            {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};
                        for (int r = 1; r <= 10; r++)
                            constant =
                                constant &&
                                memcmp(sketch_pixel(&exact, x, y),
                                       sketch_pixel(&exact, x + r * direction[k][0], y + r * direction[k][1]), 4) == 0;
                    }
                    if (!constant || is_ground(&exact, x, y))
                        continue;
                    judged++;
                    tones[sketch_pixel(&exact, x, y)[1]]++;
                    wrong += abs(sketch_pixel(&drawn, x, y)[1] - sketch_pixel(&exact, x, y)[1]) > 1;
                }
            for (int k = 0; k < 256; k++)
                count += tones[k] > 50;
            check_at_least("S01", judged, 3000, "%s: pixels amid patches of one colour", lit ? "lit" : "flat");
            check_near("S01", count, lit ? 3 : 1, 0, "  different tones of the box's faces");
            check_at_most("S01", wrong, judged * 0.001, "  pixels that differ from their patch");
        }
        shot_release(&drawn);
        shot_release(&exact);
        shape_release(&s);
    }
}

/* Black ink over fill is the product of the two maps. */
static void product(void)
{
    shape s = {0};
    shot  drawn;
    scene_make(&s, SCENE_CLOSED, 51);
    scene_colour(&s);
    if (shot_of_shape(
            &drawn, &s, "product.glb",
            look_of("\"surface\":\"lit\",\"lines\":{\"operator\":\"four-tap\",\"gain\":4,\"colour\":\"#000000\"}",
                    "{\"technique\":\"uncertainty\",\"amount\":6}"),
            NULL, &slanted)) {
        sketch_maps m = sketch_maps_of(&drawn);
        int         judged = 0, inked = 0, wrong = 0;
        double      worst = 0;
        for (int y = 0; y < drawn.height; y++)
            for (int x = 0; x < drawn.width; x++) {
                sketch_position e = sketch_moved(&m, x, y, 6, sketch_scaled(1)),
                                f = sketch_moved(&m, x, y, 6, sketch_scaled(-0.75));
                if (!isfinite(sketch_depth(&m, e)) || !isfinite(sketch_depth(&m, f)))
                    continue;
                double edge[4];
                sketch_edge(&m, e, edge);
                sketch_paint shade = sketch_shade(&m, f);
                if (shade.a < 1)
                    continue;
                double intensity = edge[0] * edge[1] * edge[3],
                       error = fabs(picture_shown(sketch_pixel(&drawn, x, y)[0]) - intensity * shade.r);
                error = fmax(error, fabs(picture_shown(sketch_pixel(&drawn, x, y)[1]) - intensity * shade.g));
                judged++;
                inked += intensity > 0.1 && intensity < 0.9;
                wrong += error > 1 / 255.0 + 0.0045; /* half a level of the brightest sRGB byte, once in the shade map
                                                        and once in the picture */
                worst = fmax(worst, error);
            }
        check_at_least("C16", judged, 5000, "pixels amid the figure (with half ink: %d)", inked);
        check_at_most("C16", (double)wrong / judged, 0.001,
                      "fraction of them that are not the product of the two texels within 1/255 (worst %.4f)", worst);
    }
    shot_release(&drawn);
    shape_release(&s);
}

/* --- styles --------------------------------------------------------------------------------------------- */

static int transitions(const shot *s)
{
    int count = 0;
    for (int y = 0; y + 1 < s->height; y++)
        for (int x = 0; x + 1 < s->width; x++) {
            bool own = is_ground(s, x, y);
            count += (own != is_ground(s, x + 1, y)) + (own != is_ground(s, x, y + 1));
        }
    return count;
}

static void frayed(void)
{
    static const char *const perturbs[] = {"{\"technique\":\"uncertainty\",\"amount\":4}",
                                           "{\"technique\":\"uncertainty\",\"amount\":4,\"rough\":4}",
                                           "{\"technique\":\"uncertainty\",\"amount\":4,\"rough\":4}",
                                           "{\"technique\":\"uncertainty\",\"amount\":4,\"rough\":4,\"grain\":4}",
                                           "{\"technique\":\"uncertainty\",\"amount\":4,\"rough\":4,\"seed\":9}"};
    shape                    s = {0};
    shot                     drawn[5];
    int                      steps[5] = {0};
    bool                     ok = true;
    shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 48, 96, true);
    for (int k = 0; k < 5; k++) {
        ok = shot_of_shape(&drawn[k], &s, "rough.glb", look_of(BLUE_FILL, perturbs[k]), NULL, &front) && ok;
        steps[k] = ok ? transitions(&drawn[k]) : 0;
    }
    if (ok) {
        check_at_least("S08", (double)steps[1] / steps[0], 2.5,
                       "how much longer a frayed border is (%d and %d transitions)", steps[1], steps[0]);
        check_at_least("S08", (double)steps[3] / steps[0], 1.2, "and one with grains of 4 px");
        check_at_most("S08", (double)steps[3] / steps[1], 0.7, "  which are coarser than those of 1 px");
        check_at_most("S08", (double)differing(&drawn[1], &drawn[2]), 0, "pixels that differ when it is drawn again");
        check_at_least("S08", (double)differing(&drawn[1], &drawn[4]), 200, "pixels that differ with another seed");
    }
    for (int k = 0; k < 5; k++)
        shot_release(&drawn[k]);
    shape_release(&s);
}

/* The same grains move lines: by up to `rough` either way, evenly, so that ink lies by 1/sqrt 3 of it off its line. */
static void frayed_lines(void)
{
    static const char *const rough[] = {"0", "3", "6"};
    double                   before = 0;
    for (int k = 0; k < 3; k++) {
        char  perturb[256];
        shape s = {0};
        shot  drawn;
        snprintf(
            perturb, sizeof perturb,
            "{\"technique\":\"uncertainty\",\"amount\":4," EDGES(0, 0, 0, 0) "," SHADES(0, 0, 0, 0) ",\"rough\":%s}",
            rough[k]);
        shape_sphere(&s, "ball", dvec_of(0, 0, 0), 1, 96, 192, true);
        if (shot_of_shape(&drawn, &s, "frayed.glb",
                          look_of("\"surface\":{\"technique\":\"flat\",\"colour\":\"#ece4d2\"}," LINES, perturb), NULL,
                          &front)) {
            double sum = 0, mean = 0, squares = 0, middle[2];
            shot_on_page(&drawn, dvec_of(0, 0, 0), middle);
            for (int i = 0; i < drawn.width * drawn.height; i++) {
                double ink = 1 - drawn.picture[4 * i] / 236.0,
                       r = hypot(i % drawn.width + 0.5 - middle[0], floor(i / (double)drawn.width) + 0.5 - middle[1]);
                sum += ink;
                mean += ink * r;
                squares += ink * r * r;
            }
            mean /= sum;
            double spread = sqrt(squares / sum - mean * mean), own = atof(rough[k]) / sqrt(3);
            if (k == 0)
                before = spread;
            check_near("S08", spread, sqrt(before * before + own * own), 0.15,
                       "rough %s: how far ink lies off a line, px", rough[k]);
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* A plate whose colour says where its pixels come from: red by x, green by y. */
static void ramp(shape *s)
{
    shape_quad(s, "ramp", 1.8, 0);
    s->parts[0].texture_size = 256;
    s->parts[0].texture = check_alloc(256 * 256, 4);
    for (int i = 0; i < 256 * 256; i++)
        memcpy(&s->parts[0].texture[4 * i], (uint8_t[]){(uint8_t)(i % 256), (uint8_t)(255 - i / 256), 128, 255}, 4);
}

/* How far grains displace, read off the ramp: neighbours know nothing of each other. */
static void grains(void)
{
    static const char rule[] = "\"surface\":{\"technique\":\"textured\",\"light\":0}";
    static const int  sizes[] = {1, 4};
    for (int g = 0; g < 2; g++) {
        char  perturb[256];
        shape s = {0};
        shot  drawn, exact;
        ramp(&s);
        snprintf(perturb, sizeof perturb, "{\"technique\":\"uncertainty\",\"amount\":0.01,\"rough\":5,\"grain\":%d}",
                 sizes[g]);
        bool ok = shot_of_shape(&exact, &s, "ramp.glb", look_of(rule, NULL), NULL, &front);
        if (shot_of_shape(&drawn, &s, "ramp.glb", look_of(rule, perturb), NULL, &front) && ok) {
            double sum = 0, squares = 0, near = 0, far = 0, most = 0,
                   per_pixel = (sketch_pixel(&exact, 220, 150)[0] - sketch_pixel(&exact, 80, 150)[0]) / 140.0;
            int count = 0;
            for (int y = 50; y < 250; y++)
                for (int x = 50; x < 245; x++) {
                    double d[3];
                    for (int k = 0; k < 3; k++) {
                        int at = x + (k == 1 ? 1 : k == 2 ? sizes[g] : 0);
                        d[k] = (sketch_pixel(&drawn, at, y)[0] - sketch_pixel(&exact, at, y)[0]) / per_pixel;
                    }
                    sum += d[0];
                    squares += d[0] * d[0];
                    near += d[0] * d[1];
                    far += d[0] * d[2];
                    most = fmax(most, fabs(d[0]));
                    count++;
                }
            check_at_most("S08", fabs(sum / count), 0.15, "grains of %d px, rough 5: mean displacement, px", sizes[g]);
            check_near("S08", most, 5, 1, "  the largest");
            check_at_least("S08", sqrt(squares / count), 1.5, "  root of the mean square");
            check_near("S08", near / squares, g ? 0.75 : 0, 0.08, "  correlation of neighbouring pixels");
            check_at_most("S08", fabs(far / squares), 0.08, "  of neighbouring grains");
        }
        shot_release(&drawn);
        shot_release(&exact);
        shape_release(&s);
    }
}

/* Three outlines in three colours, each at its own position, and no fill; and their depth beside an exact part. */
static void repeated(void)
{
    static const uint8_t colours[2][3] = {{0xd0, 0x20, 0x20}, {0x20, 0x40, 0xd0}};
    static const char    rule[] = "\"surface\":{\"technique\":\"flat\",\"colour\":\"none\"},\"lines\":{\"operator\":"
                                  "\"discontinuity\",\"colour\":\"#000000\"}";
    static const double  degrees[] = {1, 1.3, 0.7}, forces[] = {0, 0, 0.6};
    for (int c = 0; c < 3; c++) {
        char         perturb[320];
        shape        s = {0};
        shot         drawn;
        sketch_style style = style_of(9);
        snprintf(perturb, sizeof perturb,
                 "{\"technique\":\"uncertainty\",\"amount\":9,\"repeat\":3,\"repeat_degree\":%g,\"pressure\":%g,"
                 "\"repeat_colours\":[\"#"
                 "d02020\",\"#2040d0\"]," EDGES(1, 0.2, -0.1, 0.9) ",\"fallback\":\"#ff00ff\"}",
                 degrees[c], forces[c]);
        style.pressure = forces[c];
        style.edges = (sketch_degree){1, 0.2, -0.1, 0.9};
        style.without_fill = true;
        style.repeat = 3;
        style.repeat_degree = degrees[c];
        for (int i = 0; i < 2; i++)
            style.repeat_inks[i] = sketch_colour(colours[i], 1);
        plates(&s);
        if (shot_of_shape(&drawn, &s, "repeat.glb", look_of(rule, perturb), NULL, &front)) {
            sketch_maps m = sketch_maps_of(&drawn);
            int         seen[3] = {0};
            for (int i = 0; i < drawn.width * drawn.height; i++) {
                int    x = i % drawn.width, y = i / drawn.width, alone = -1, inked = 0;
                double depth;
                for (int k = 0; k < 3; k++) {
                    double alpha = sketch_copy_ink(&m, &style, k, x, y, &depth).a;
                    alone = alpha > 0.95 ? k : alone;
                    inked += alpha > 0.02;
                }
                if (inked == 1 && alone >= 0)
                    seen[alone] += sketch_levels_off(sketch_pixel(&drawn, x, y),
                                                     alone ? style.repeat_inks[alone - 1] : style.ink) < 20;
            }
            sketch_check_opaque("S09", &drawn, &style, 3, 0.999,
                                c == 2 ? "three outlines, each less far, by a hand that presses"
                                : c    ? "three outlines, each farther than the one before"
                                       : "three outlines");
            for (int i = 0; i < 3 && c < 2; i++)
                check_at_least("S09", seen[i], 15,
                               "  pixels where outline %d is alone, covers all of them and has its colour", i);
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* Lines of all techniques of a rule waver as lines do, not with the fill. */
static void several(void)
{
    static const char        perturb[] = "{\"technique\":\"uncertainty\",\"amount\":8," SHADES(0, 0, 0, 0) "}";
    static const char *const rules[] = {
        BLUE_FILL ",\"lines\":[{\"operator\":\"discontinuity\",\"colour\":\"#000000\"}]",
        BLUE_FILL ",\"lines\":[{\"operator\":\"discontinuity\",\"colour\":\"#000000\"},{\"operator\":\"discontinuity\","
                  "\"profile_weight\":0,\"inner_weight\":0,\"id_weight\":0}]"};
    shape s = {0};
    plates(&s);
    for (int k = 0; k < 2; k++) {
        shot         drawn;
        sketch_style style = style_of(8);
        style.shades = sketch_scaled(0);
        if (shot_of_shape(&drawn, &s, "several.glb", look_of(rules[k], perturb), NULL, &front))
            sketch_check_opaque("S03", &drawn, &style, 3, 0.995,
                                k ? "black lines, and invisible ones after them" : "black lines alone");
        shot_release(&drawn);
    }
    shape_release(&s);
}

/* Grains that fill leaves bare: the given fraction of them, of one grain's size, and half as many of lines. */
static void tooth(void)
{
    static const double fractions[] = {0.2, 0.5};
    const char         *change[] = {"finish.ground", "#ffffff", NULL};
    for (int k = 0; k < 4; k++) {
        char   perturb[160];
        shape  s = {0};
        shot   drawn;
        double bare = 0, count = 0;
        /* A wall of black fill, or one of lines alone: a plate's broad outline. */
        const char *rule = k < 2 ? bare_fill
                                 : "\"surface\":{\"technique\":\"flat\",\"colour\":\"none\"},\"lines\":{\"operator\":"
                                   "\"discontinuity\",\"colour\":\"#000000\",\"width\":32}";
        snprintf(perturb, sizeof perturb,
                 "{\"technique\":\"uncertainty\",\"amount\":0.5,\"lock\":\"screen\",\"tooth\":%g}", fractions[k % 2]);
        shape_quad(&s, "plate", 1.2, 0);
        if (shot_of_shape(&drawn, &s, "tooth.glb", look_of(rule, perturb), change, &front))
            for (int y = 90; y < 210; y++)
                for (int x = k < 2 ? 90 : 62; x < (k < 2 ? 210 : 71); x++) {
                    bare += sketch_pixel(&drawn, x, y)[1] > 2;
                    count++;
                }
        check_near("S08", count > 0 ? bare / count : -1, fractions[k % 2] * (k < 2 ? 1 : 0.5), 0.04,
                   "tooth %.1f: fraction of grains whose ground shows through the %s", fractions[k % 2],
                   k < 2 ? "fill" : "lines");
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* With pressure, the weight of a line follows the field's third value; without it is the same everywhere. */
static void pressure(void)
{
    static const double pressures[] = {0, 0.7};
    const char         *change[] = {"finish.ground", "#ffffff", NULL};
    for (int k = 0; k < 2; k++) {
        char      perturb[200];
        double    n = 0, w = 0, z = 0, ww = 0, zz = 0, wz = 0;
        shot_view view = front;
        view.width = view.height = 400;
        for (int seed = 0; seed < 4; seed++) {
            shape s = {0};
            shot  drawn;
            snprintf(
                perturb, sizeof perturb,
                "{\"technique\":\"uncertainty\",\"amount\":1,\"lock\":\"screen\",\"seed\":%d,\"pressure\":%g," EDGES(
                    0, 0, 0, 0) "}",
                seed, pressures[k]);
            shape_quad(&s, "plate", 1.6, 0);
            if (shot_of_shape(&drawn, &s, "pressure.glb", look_of(bare_white, perturb), change, &view) &&
                drawn.uncertainty)
                for (int y = 80; y < 320; y++) {
                    double ink = 0, value = 0;
                    for (int x = 36; x < 66; x++) {
                        double own = (255 - sketch_pixel(&drawn, x, y)[1]) / 255.0;
                        ink += own;
                        value += own * (double)drawn.uncertainty[(399 - y) * 400 + x][2];
                    }
                    value = ink > 0 ? value / ink : 0;
                    n += 1;
                    w += ink;
                    z += value;
                    ww += ink * ink;
                    zz += value * value;
                    wz += ink * value;
                }
            shot_release(&drawn);
            shape_release(&s);
        }
        double spread = sqrt(fmax(0, ww / n - w / n * w / n)),
               link = (wz / n - w / n * z / n) / (spread * sqrt(zz / n - z / n * z / n) + 1e-9);
        if (k == 0)
            check_at_most("S03", spread, 0.02, "pressure 0: how much the width of a line varies, px (mean %.2f)",
                          w / n);
        else {
            check_at_least("S03", spread, 0.15, "pressure %.1f: how much the width of a line varies, px (mean %.2f)",
                           pressures[k], w / n);
            check_at_least("S03", fabs(link), 0.6, "  correlation of its weight with the field's third value (%.3f)",
                           link);
        }
    }
}

/* --- the picture's border, samples, ES ------------------------------------------------------------------ */

static void borders(void)
{
    static const char *const locks[] = {"object", "screen"};
    for (int c = 0; c < 4; c++) {
        char      perturb[256];
        shape     s = {0};
        shot      drawn;
        shot_view view = slanted;
        snprintf(perturb, sizeof perturb, "{\"technique\":\"uncertainty\",\"amount\":12,\"lock\":\"%s\"%s}",
                 locks[c % 2], c < 2 ? "" : ",\"repeat\":2");
        scene_make(&s, SCENE_CLOSED, 61);
        scene_colour(&s);
        view.eye = dvec_of(1.6, 1.2, 2); /* so close that the model fills the picture */
        sketch_style style = style_of(12);
        if (shot_of_shape(&drawn, &s, "close.glb", look_of(OWN_COLOUR "," LINES, perturb), NULL, &view)) {
            sketch_maps  m = sketch_maps_of(&drawn);
            sketch_tally t = {0};
            int          left = 0, wide = 0;
            for (int y = 0; y < m.height; y++)
                for (int x = 0; x < m.width; x++) {
                    double depth;
                    for (int k = 0; k < 3; k++)
                        left += !sketch_inside(&m, sketch_moved(&m, x, y, 12,
                                                                k == 0   ? style.edges
                                                                : k == 1 ? style.shades
                                                                         : sketch_turn(180)));
                    wide += hypot((double)drawn.uncertainty[y * m.width + x][0],
                                  (double)drawn.uncertainty[y * m.width + x][1]) > 0.3;
                    if (c < 2 && (x < 12 || y < 12 || x >= m.width - 12 || y >= m.height - 12))
                        sketch_judge(&t, &drawn, x, y,
                                     sketch_over(sketch_opaque(&m, &style, x, y, &depth), style.ground), 3);
                }
            check_at_most("C25", left, 0, "lookups that leave the picture, %s", perturb);
            check_at_least("C25", wide, m.width * m.height * 0.2, "  pixels with much uncertainty");
            if (c < 2)
                sketch_check("C25", &t, &drawn, 0.995, "  the outermost 12 px");
        }
        shot_release(&drawn);
        shape_release(&s);
    }
}

/* A wall that fills the picture has no hole, whatever is perturbed. */
static void wall(void)
{
    static const char *const perturbs[] = {
        "{\"technique\":\"uncertainty\",\"amount\":12}",
        "{\"technique\":\"uncertainty\",\"amount\":30,\"scale\":40,\"lock\":\"screen\",\"rough\":6}",
        "{\"technique\":\"uncertainty\",\"amount\":20,\"outward\":\"enlarged\"}"};
    shape s = {0};
    shape_quad(&s, "wall", 6, 0);
    for (int k = 0; k < 3; k++) {
        shot drawn;
        int  wrong = 0;
        if (shot_of_shape(&drawn, &s, "wall.glb", look_of(BLUE_FILL "," LINES, perturbs[k]), NULL, &front))
            for (int i = 0; i < drawn.width * drawn.height; i++)
                wrong += sketch_levels_off(&drawn.picture[4 * i], sketch_colour(blue_bytes, 1)) > 1;
        check_that("C25", drawn.picture != NULL, "a wall is drawn");
        check_at_most("C25", wrong, 0, "pixels of a wall that fills the picture with another colour, %s", perturbs[k]);
        shot_release(&drawn);
    }
    shape_release(&s);
}

/* With more samples a pixel the wobble is the same, and borders are smooth. */
static void samples(void)
{
    static const char *const perturbs[] = {
        "{\"technique\":\"uncertainty\",\"amount\":9}",
        "{\"technique\":\"uncertainty\",\"amount\":9,\"lock\":\"screen\"}",
        "{\"technique\":\"uncertainty\",\"amount\":9,\"outward\":\"enlarged\"}",
        "{\"technique\":\"uncertainty\",\"amount\":9,\"lock\":\"screen\",\"tile\":100}",
        "{\"technique\":\"uncertainty\",\"amount\":0.5,\"rough\":8,\"grain\":4}"};
    shape s = {0};
    plates(&s);
    for (int k = 0; k < 5; k++) {
        shot      one, sixteen, exact;
        shot_view view = front, fine = front;
        fine.samples = 16;
        bool ok = shot_of_shape(&one, &s, "samples.glb", look_of(BLUE_FILL, perturbs[k]), NULL, &view);
        ok = shot_of_shape(&sixteen, &s, "samples.glb", look_of(BLUE_FILL, perturbs[k]), NULL, &fine) && ok;
        ok = shot_of_shape(&exact, &s, "samples.glb", look_of(BLUE_FILL, NULL), NULL, &view) && ok;
        if (ok) {
            int apart = 0, moved = 0;
            for (int i = 0; i < one.width * one.height; i++) {
                apart += abs(one.picture[4 * i] - sixteen.picture[4 * i]) > 130;
                moved += abs(one.picture[4 * i] - exact.picture[4 * i]) > 130;
            }
            check_at_least("S03", moved, 300, "pixels that are perturbed, %s", perturbs[k]);
            check_at_most("S03", (double)apart / moved, 0.1,
                          "  as a fraction of them, pixels that sixteen samples turn (%d)", apart);
        }
        shot_release(&one);
        shot_release(&sixteen);
        shot_release(&exact);
    }
    shape_release(&s);
}

static void dialects(void)
{
    static const char *const rules[] = {OWN_COLOUR "," LINES, "\"surface\":\"lit\"," LINES,
                                        "\"surface\":\"flat\",\"layers\":\"peel\"," LINES ",\"compose\":\"blueprint\""};
    static const char *const perturbs[] = {
        "{\"technique\":\"uncertainty\",\"amount\":8}",
        "{\"technique\":\"uncertainty\",\"amount\":8,\"lock\":\"screen\",\"rough\":2,\"repeat\":2}",
        "{\"technique\":\"uncertainty\",\"amount\":8,\"outward\":\"enlarged\",\"by\":\"normal\",\"pressure\":0.5}"};
    shape s = {0};
    scene_make(&s, SCENE_CLOSED, 71);
    scene_colour(&s);
    for (int k = 0; k < 3; k++) {
        shot      desktop, es;
        shot_view view = slanted;
        bool      ok = shot_of_shape(&desktop, &s, "dialect.glb", look_of(rules[k], perturbs[k]), NULL, &view);
        view.es = true;
        if (shot_of_shape(&es, &s, "dialect.glb", look_of(rules[k], perturbs[k]), NULL, &view) && ok &&
            check_that("S03", desktop.uncertainty && es.uncertainty, "both have a field")) {
            int    wrong = 0, count = es.width * es.height;
            double worst = 0;
            for (int i = 0; i < count; i++) {
                int most = 0;
                for (int c = 0; c < 4; c++)
                    most = abs(es.picture[4 * i + c] - desktop.picture[4 * i + c]) > most
                               ? abs(es.picture[4 * i + c] - desktop.picture[4 * i + c])
                               : most;
                wrong += most > 2;
                for (int c = 0; c < 3; c++)
                    worst = fmax(worst, fabs((double)es.uncertainty[i][c] - (double)desktop.uncertainty[i][c]));
            }
            check_at_most("S03", worst, 0.002, "the field in ES and in desktop GL, %s", perturbs[k]);
            check_at_most("S03", (double)wrong / count, 0.0005, "  fraction of pixels that differ");
        }
        shot_release(&desktop);
        shot_release(&es);
    }
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"zero", zero},         {"masks", fill_masks},        {"whole", whole_pictures},
        {"contrary", contrary}, {"direction", one_direction}, {"exchange", exchange},
        {"depths", depths},     {"identity", mask_identity},  {"patches", patches},
        {"product", product},   {"frayed", frayed},           {"frayed-lines", frayed_lines},
        {"grains", grains},     {"repeated", repeated},       {"several", several},
        {"tooth", tooth},       {"pressure", pressure},       {"borders", borders},
        {"wall", wall},         {"samples", samples},         {"dialects", dialects},
    };
    int status = check_main(argc, argv, "sketch", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
