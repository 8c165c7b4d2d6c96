/* Lines where parts of one rule run through those of another, when they are perturbed or seen through. Their places are
 * known: of blocks and posts they are straight, and what one rule draws alone has them anyway. Row nienhaus E18. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "feature.h"

enum { STATIONS = 39 };

#define LOOK(RULES) "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[" RULES "]}"
#define LINED(OPERATOR, WIDTH)                                                                                         \
    "\"surface\":{\"technique\":\"flat\",\"colour\":\"#eeeeee\"},\"lines\":{\"operator\":\"" OPERATOR                  \
    "\",\"width\":" WIDTH "}"
#define PLAIN(REST) "{\"select\":\"plain*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#dddddd\"}" REST "},"

static const shot_view view = {.width = 320, .height = 240, .eye = {4, 3, 5}, .up = {0, 1, 0}};

typedef struct segment {
    dvec from, to;
} segment;

/* What lies across a line at places along it. */
typedef struct profile {
    int    found;          /* places with ink */
    double away[STATIONS]; /* the middle of the ink, pixels to one side of the line; NAN: there is none */
    double worst;          /* the largest of these */
    double width;          /* pixels of ink across, the mean of all places with some */
} profile;

static double ink_at(const shot *s, double x, double y)
{
    const int column = (int)floor(x), row = (int)floor(y);
    if (column < 0 || row < 0 || column >= s->width || row >= s->height)
        return 0;
    const uint8_t *p = &s->picture[4 * (row * s->width + column)];
    /* Fills are lighter than 170, tints of layers included; what is between them and ink is the rim of a line. */
    const double level = (p[0] + p[1] + p[2]) / 3.0;
    return level < 170 ? (170 - level) / 170 : 0;
}

static profile across(const shot *s, segment line, double reach)
{
    enum { STEPS = 4 }; /* a pixel */
    profile      out = {.width = 0};
    const dvec   a = shot_project(s, line.from), b = shot_project(s, line.to);
    const double length = hypot(b.x - a.x, b.y - a.y), normal[2] = {-(b.y - a.y) / length, (b.x - a.x) / length};
    const int    most = (int)(reach * STEPS);
    for (int i = 0; i < STATIONS; i++) {
        const double t = 0.12 + 0.76 * i / (STATIONS - 1.0), x = a.x + (b.x - a.x) * t, y = a.y + (b.y - a.y) * t;
        double       sum = 0, moment = 0;
        for (int k = -most; k <= most; k++) {
            const double off = k / (double)STEPS, ink = ink_at(s, x + off * normal[0], y + off * normal[1]);
            sum += ink / STEPS;
            moment += off * ink / STEPS;
        }
        out.away[i] = sum > 0.25 ? moment / sum : NAN;
        if (sum > 0.25) {
            out.found++;
            out.width += sum;
            out.worst = fmax(out.worst, fabs(out.away[i]));
        }
    }
    out.width /= out.found ? out.found : 1;
    return out;
}

static bool draw(shot *out, const char *look, const char *const *changes, dvec low, dvec high, bool through)
{
    shape s = {0};
    if (through)
        shape_box(&s, "lined block", dvec_of(-1, -0.6, -1), dvec_of(1, 0.6, 1));
    else
        shape_box(&s, "plain block", dvec_of(-1, -1, -1), dvec_of(1, 0, 1));
    shape_box(&s, through ? "plain post" : "lined post", low, high);
    const bool drawn = shot_of_shape(out, &s, "meetings.glb", look, changes, &view);
    shape_release(&s);
    return drawn;
}

static bool draw_post(shot *out, const char *look, const char *const *changes, double raised)
{
    return draw(out, look, changes, dvec_of(-0.3, -0.5 + raised, -0.3), dvec_of(0.3, 0.8 + raised, 0.3), false);
}

static const segment front = {{-0.3, 0, 0.3}, {0.3, 0, 0.3}}, side = {{0.3, 0, 0.3}, {0.3, 0, -0.3}},
                     crease = {{0.3, 0, 0.3}, {0.3, 0.8, 0.3}}; /* of the post: as broad as lines are to be */

/* Where two drawings have ink across a line: the mean way from one to the other. */
static double apart(const profile *a, const profile *b)
{
    double sum = 0;
    int    count = 0;
    for (int i = 0; i < STATIONS; i++)
        if (!isnan(a->away[i]) && !isnan(b->away[i])) {
            sum += fabs(a->away[i] - b->away[i]);
            count++;
        }
    return count ? sum / count : INFINITY;
}

/* Both parts are sketched alike: the line goes where one rule for both would have drawn it. */
static void sketches_take_it_along(void)
{
#define MOVED ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":6,\"scale\":40,\"lock\":\"screen\"}"
    static const char *const operators[][2] = {
        {LOOK(PLAIN(MOVED) "{\"select\":\"lined*\"," LINED("discontinuity", "2") MOVED "}"),
         LOOK("{\"select\":\"*\"," LINED("discontinuity", "2") MOVED "}")},
        {LOOK(PLAIN(MOVED) "{\"select\":\"lined*\"," LINED("four-tap", "2") MOVED "}"),
         LOOK("{\"select\":\"*\"," LINED("four-tap", "2") MOVED "}")},
        {LOOK(PLAIN(MOVED) "{\"select\":\"lined*\"," LINED("id", "2") MOVED "}"),
         LOOK("{\"select\":\"*\"," LINED("id", "2") MOVED "}")},
    };
    static const char *const names[] = {"discontinuity", "four-tap", "id"};
    for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
        shot both, one;
        if (draw_post(&both, operators[i][0], NULL, 0) && draw_post(&one, operators[i][1], NULL, 0)) {
            const profile lines[2] = {across(&both, front, 7), across(&both, side, 7)},
                          known[2] = {across(&one, front, 7), across(&one, side, 7)};
            check_note("%s: moved by up to %.1f pixels, %.1f wide; one rule: %.1f, %.1f", names[i], lines[0].worst,
                       lines[0].width, known[0].worst, known[0].width);
            check_at_least("E18", known[0].worst, 2, "%s: pixels by which one rule's line is moved", names[i]);
            check_at_least("E18", lines[0].found, 37, "  of 39 places of the intersection with a line");
            check_at_least("E18", lines[1].found, 37, "  the same at the other side");
            check_at_most("E18", apart(&lines[0], &known[0]), 0.6, "  mean pixels from one rule's line");
            check_at_most("E18", apart(&lines[1], &known[1]), 0.6, "  the same at the other side");
            /* One rule has two inks there, of a crease and of a border, where operators know both. */
            const double broad = i == 0 ? across(&both, crease, 7).width : known[0].width;
            check_at_most("E18", fabs(lines[0].width - broad), 0.3, "  pixels by which it is broader or finer than %s",
                          i == 0 ? "the post's creases" : "that");
        }
        shot_release(&both);
        shot_release(&one);
    }
#undef MOVED
}

/* The post alone is sketched: its line moves with it over a block that stays, and is hidden nowhere by it. */
static void sketches_stand_in_what_stays(void)
{
#define PERTURBED(WHAT) LOOK(PLAIN("") "{\"select\":\"lined*\"," LINED("discontinuity", "2") ",\"perturb\":" WHAT "}")
    static const char *const looks[] = {PERTURBED("{\"technique\":\"uncertainty\",\"amount\":2}"),
                                        PERTURBED("{\"technique\":\"uncertainty\",\"amount\":6}"),
                                        PERTURBED("{\"technique\":\"pencil\",\"dark\":1,\"light\":0}")};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        shot drawing;
        if (draw_post(&drawing, looks[i], NULL, 0)) {
            const double  reach = i ? 9 : 4;
            const profile lines[2] = {across(&drawing, front, reach), across(&drawing, side, reach)};
            check_at_least("E18", lines[0].found, 37, "sketch %zu: of 39 places with a line", i);
            check_at_least("E18", lines[1].found, 37, "  the same at the other side");
            check_at_least("E18", fmin(lines[0].width, lines[1].width), 0.65 * across(&drawing, crease, reach).width,
                           "  pixels of ink across, of two thirds of the post's creases");
        }
        shot_release(&drawing);
    }
#undef PERTURBED
}

/* What is not asked for, not there, or hidden, is not drawn. */
static void nothing_else_has_a_line(void)
{
    static const char        look[] = LOOK(PLAIN("") "{\"select\":\"lined*\"," LINED(
               "discontinuity", "2") ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":1}}");
    static const char *const off[] = {"layers.complement", "false", NULL};
    static const struct {
        const char        *what;
        const char *const *changes;
        double             raised;
    } cases[] = {{"without the complement", off, 0}, {"where the post hangs above", NULL, 2}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        shot drawing;
        if (draw_post(&drawing, look, cases[i].changes, cases[i].raised))
            check_at_most("E18", across(&drawing, front, 3).found, 4, "%s: of 39 places with a line", cases[i].what);
        shot_release(&drawing);
    }
    /* The post's lower end, inside the block. */
    shot drawing;
    if (draw_post(&drawing, look, NULL, 0)) {
        const segment within = {{-0.3, -0.5, 0.3}, {0.3, -0.5, 0.3}}, down = {{0.3, 0, 0.3}, {0.3, -0.5, 0.3}};
        check_at_most("E18", across(&drawing, within, 2).found, 0, "places with a line inside the block");
        check_at_most("E18", across(&drawing, down, 2).found, 3, "places with a line along what is inside it");
        check_that("E18", !shot_has_warning(&drawing, "unused"), "nothing is missing, and nothing says so");
    }
    shot_release(&drawing);
}

/* A block that is seen through, and an opaque post that runs through it: the nearest layer has a line at its top, the
 * next one at its bottom. */
static void layers_have_theirs(void)
{
#define LAYERED(OPERATOR, COMPOSE)                                                                                     \
    LOOK(PLAIN("") "{\"select\":\"lined*\"," LINED(OPERATOR, "2") ",\"layers\":{\"technique\":\"peel\",\"count\":0}"   \
                                                                  ",\"compose\":\"" COMPOSE "\"}")
    static const char *const looks[] = {LAYERED("discontinuity", "blueprint"), LAYERED("discontinuity", "xray"),
                                        LAYERED("four-tap", "blueprint"), LAYERED("saito", "wire")};
    static const char *const names[] = {"blueprint", "xray", "blueprint, four-tap", "wire, saito"};
    static const double      least[] = {1.3, 0.7, 1.3, 1.3}; /* pixels: through X-rayed surfaces ink is paler */
    static const char *const producers[][3] = {{"layers.producer", "peeling", NULL},
                                               {"layers.producer", "lists", NULL}};
    const segment            top = {{-0.3, 0.6, 0.3}, {0.3, 0.6, 0.3}}, bottom = {{-0.3, -0.6, 0.3}, {0.3, -0.6, 0.3}},
                  left = {{-0.3, -0.5, 0.3}, {-0.3, 0.5, 0.3}}, right = {{0.3, -0.5, -0.3}, {0.3, 0.5, -0.3}};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        shot drawing;
        if (draw(&drawing, looks[i], producers[i % 2], dvec_of(-0.3, -1.2, -0.3), dvec_of(0.3, 1.2, 0.3), true)) {
            const profile at_top = across(&drawing, top, 3), at_bottom = across(&drawing, bottom, 3);
            check_note("%s: %.2f and %.2f pixels wide", names[i], at_top.width, at_bottom.width);
            check_at_least("E18", at_top.found, STATIONS, "%s: of 39 places at the top with a line", names[i]);
            check_at_least("E18", at_bottom.found, STATIONS, "  of those at the bottom, seen through the front");
            check_at_most("E18", fmax(at_top.worst, at_bottom.worst), 0.8,
                          "  farthest from where surfaces cross, pixels");
            check_at_least("E18", fmin(at_top.width, at_bottom.width), least[i], "  pixels of ink across");
            check_at_most("E18", across(&drawing, left, 1.5).found + across(&drawing, right, 1.5).found, 14,
                          "  of 78 places along the post with a line: the block's own cross there");
        }
        shot_release(&drawing);
    }
#undef LAYERED
}

/* Surfaces of others that are in front of the figure here and behind it there do not cross it, nor does an outline that
 * is hidden in another part come out of it. */
static void outlines_are_no_meetings(void)
{
    static const char *const looks[] = {
        LOOK(PLAIN("") "{\"select\":\"lined*\"," LINED(
            "discontinuity", "3") ",\"perturb\":{\"technique\":\"uncertainty\",\"amount\":0.1}}"),
        LOOK(PLAIN("") "{\"select\":\"lined*\"," LINED("discontinuity",
                                                       "3") ",\"layers\":{\"technique\":\"peel\",\"count\":0}"
                                                            ",\"compose\":\"blueprint\"}")};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        shape s = {0};
        shot  drawing;
        shape_box(&s, "plain wall", dvec_of(-1.6, -1, -0.6), dvec_of(1.6, 1, -0.04));
        shape_box(&s, "plain beam", dvec_of(-0.3, -0.6, 0.04), dvec_of(0.3, 0.6, 0.6));
        shape_box(&s, "lined plate", dvec_of(-1.5, -0.9, -0.05), dvec_of(1.5, 0.9, 0.05));
        if (shot_of_shape(&drawing, &s, "beam.glb", looks[i], NULL, &view)) {
            const segment outline = {{-0.3, -0.5, 0.6}, {-0.3, 0.6, 0.6}}, foot = {{0.3, -0.6, 0.05}, {0.3, 0.6, 0.05}};
            check_at_most("E18", across(&drawing, outline, 2).found, 4,
                          "%s: of 39 places along a beam's outline before a plate with a line",
                          i ? "layers" : "sketch");
            check_at_least("E18", across(&drawing, foot, 2).found, 37, "  of 39 places where it stands out of it");
        }
        shot_release(&drawing);
        shape_release(&s);
    }
    shape                    s = {0};
    shot                     lined, bare, without;
    static const char *const off[] = {"layers.complement", "false", NULL};
    shape_box(&s, "plain block", dvec_of(-1, -1, -1), dvec_of(1, 0, 1));
    shape_sphere(&s, "lined ball", dvec_of(0.2, 0.1, 0.3), 0.8, 48, 96, true);
    static const char plain[] =
        LOOK(PLAIN("") "{\"select\":\"lined*\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"}}");
    if (shot_of_shape(&lined, &s, "ball.glb", looks[0], NULL, &view) &&
        shot_of_shape(&bare, &s, "ball.glb", plain, NULL, &view) &&
        shot_of_shape(&without, &s, "ball.glb", looks[0], off, &view)) {
        enum { AROUND = 5 };
        int strange = 0;
        for (int y = AROUND; y < lined.height - AROUND; y++)
            for (int x = AROUND; x < lined.width - AROUND; x++) {
                bool near = ink_at(&lined, x, y) <= ink_at(&without, x, y) + 0.05;
                for (int v = -AROUND; v <= AROUND && !near; v++)
                    for (int u = -AROUND; u <= AROUND && !near; u++)
                        near = bare.picture[4 * ((y + v) * bare.width + x + u) + 1] < 20;
                strange += !near;
            }
        check_at_most("E18", strange, 0, "pixels of ink beyond a ball that only lines with others have");
    }
    shot_release(&lined);
    shot_release(&bare);
    shot_release(&without);
    shape_release(&s);
}

static int red_pixels(const shot *s)
{
    int count = 0;
    for (int i = 0; i < s->width * s->height; i++)
        count += s->picture[4 * i] - s->picture[4 * i + 1] > 40;
    return count;
}

/* Ink lies on both surfaces; what it lets through is the surface that is seen there. */
static void ink_brings_no_fill(void)
{
#define RED                                                                                                            \
    "\"surface\":{\"technique\":\"flat\",\"colour\":\"#ff0000\"},\"lines\":{\"operator\":\"id\",\"width\":6,"          \
    "\"colour\":\""
    static const char *const looks[][2] = {
        {LOOK(PLAIN("") "{\"select\":\"lined*\"," RED
                        "#00000020\"},\"perturb\":{\"technique\":\"uncertainty\",\"amount\":0.01}}"),
         LOOK(PLAIN("") "{\"select\":\"lined*\"," RED
                        "#00000000\"},\"perturb\":{\"technique\":\"uncertainty\",\"amount\":0.01}}")},
        {LOOK(PLAIN("") "{\"select\":\"lined*\"," RED
                        "#00000020\"},\"compose\":{\"technique\":\"xray\",\"opacity\":1}}"),
         LOOK(PLAIN("") "{\"select\":\"lined*\"," RED
                        "#00000000\"},\"compose\":{\"technique\":\"xray\",\"opacity\":1}}")}};
    for (size_t i = 0; i < sizeof looks / sizeof *looks; i++) {
        shot inked, bare;
        if (draw_post(&inked, looks[i][0], NULL, 0) && draw_post(&bare, looks[i][1], NULL, 0))
            check_at_most("E18", abs(red_pixels(&inked) - red_pixels(&bare)), 6,
                          "%s: of %d pixels with fill, more or fewer with pale lines than without",
                          i ? "layers" : "sketch", red_pixels(&bare));
        shot_release(&inked);
        shot_release(&bare);
    }
#undef RED
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"together", sketches_take_it_along},   {"alone", sketches_stand_in_what_stays},
        {"nothing", nothing_else_has_a_line},   {"layers", layers_have_theirs},
        {"outlines", outlines_are_no_meetings}, {"fill", ink_brings_no_fill},
    };
    int status = check_main(argc, argv, "meetings", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
