/* Two kinds of lines on complementary parts: strokes on some, lines found in the picture on the others. Each part
 * has its own kind alone, whoever is in front hides the other's lines, and as a vector drawing both are strokes,
 * each with its rule's colour. Seed 000, chapter 4; row C11. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "shot.h"

enum { NONE_KIND, STROKES, FOUND, KINDS, SIDE = 900, REACH = 3 };

/* Red strokes, blue lines of the picture. `%s`: the parts with strokes, what else the strokes have, and the
 * operator of the others. */
static const char look_text[] =
    "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":["
    "{\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},\"lines\":{\"operator\":\"%s\",\"width\":2,"
    "\"colour\":\"#0000ff\"}},"
    "{\"select\":\"%s\",\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"},\"lines\":{\"operator\":"
    "\"strokes\",\"width\":2,\"colour\":\"#ff0000\",\"visibility\":\"%s\"}}]}";

typedef struct subject {
    const char *model, *select; /* whose parts have strokes */
    const char *marks[4];       /* a name with one of these is such a part's */
} subject;

static const subject subjects[] = {
    {"pump.glb", "*Bolt*, Cover, Coupling*, *shaft, Seal", {"Bolt", "Cover", "Coupling", "shaft"}},
    {"blocks.glb", "tower*", {"tower"}},
};

/* Which kind of lines each part has, by its number; from the report, which names what is seen. */
typedef struct part_kinds {
    int    of[2048];
    size_t seen[KINDS];
} part_kinds;

static bool is_marked(const subject *s, const char *name, size_t length)
{
    char copy[256];
    snprintf(copy, sizeof copy, "%.*s", (int)(length < 255 ? length : 255), name);
    const char *last = strrchr(copy, '/');
    last = last ? last + 1 : copy;
    if (strcmp(last, "Seal") == 0)
        return strcmp(s->model, "pump.glb") == 0;
    for (int i = 0; i < 4 && s->marks[i]; i++)
        if (strstr(last, s->marks[i]))
            return true;
    return false;
}

static void find_kinds(part_kinds *out, const subject *s, const char *report)
{
    memset(out, 0, sizeof *out);
    for (const char *at = strstr(report, "\"parts_visible\""); at && (at = strstr(at, "\"id\""));) {
        int         id = (int)strtol(strchr(at, ':') + 1, NULL, 10);
        const char *name = strstr(at, "\"name\""), *begin = name ? strchr(strchr(name, ':'), '"') : NULL,
                   *end = begin ? strchr(begin + 1, '"') : NULL;
        if (!end)
            return;
        if (id > 0 && id < 2048) {
            out->of[id] = is_marked(s, begin + 1, (size_t)(end - begin - 1)) ? STROKES : FOUND;
            out->seen[out->of[id]]++;
        }
        at = end;
    }
}

static int kind_at(const shot *s, const part_kinds *k, int x, int y)
{
    if (x < 0 || y < 0 || x >= s->width || y >= s->height)
        return NONE_KIND;
    int id = s->id[y * s->width + x];
    return id < 2048 ? k->of[id] : NONE_KIND;
}

/* The kinds of ink in a pixel, one bit each: red takes green and blue away from white, blue takes red and green. */
static unsigned ink_at(const shot *s, int x, int y)
{
    const uint8_t *p = &s->picture[4 * (y * s->width + x)];
    return (p[2] < 128 ? 1u << STROKES : 0) | (p[0] < 128 ? 1u << FOUND : 0);
}

static unsigned ink_around(const shot *s, int x, int y)
{
    unsigned bits = 0;
    for (int v = -2; v <= 2; v++)
        for (int u = -2; u <= 2; u++)
            if (x + u >= 0 && y + v >= 0 && x + u < s->width && y + v < s->height)
                bits |= ink_at(s, x + u, y + v);
    return bits;
}

typedef struct tally {
    long ink[KINDS], alien[KINDS]; /* alien: amid parts of the other kind, or of none */
    long rims[KINDS],
        inked[KINDS]; /* pixels of a kind's outline against what is farther, and those with that kind's ink near */
} tally;

/* Kinds around a pixel, as far as a line can reach. */
static unsigned kinds_around(const shot *s, const part_kinds *k, int x, int y)
{
    unsigned bits = 0;
    for (int v = -REACH; v <= REACH; v++)
        for (int u = -REACH; u <= REACH; u++)
            bits |= 1u << kind_at(s, k, x + u, y + v);
    return bits;
}

/* Is the pixel at the rim of its part, against another kind or nothing that lies farther by `step`? */
static bool is_rim(const shot *s, const part_kinds *k, int x, int y, double step)
{
    static const int beside[4][2] = {{1, 0}, {-1, 0}, {0, 1}, {0, -1}};
    double           own = (double)s->depth[y * s->width + x];
    for (int i = 0; i < 4; i++) {
        int u = x + beside[i][0], v = y + beside[i][1];
        if (kind_at(s, k, u, v) != kind_at(s, k, x, y) && u >= 0 && v >= 0 && u < s->width && v < s->height &&
            (double)s->depth[v * s->width + u] > own + step)
            return true;
    }
    return false;
}

static tally count_lines(const shot *s, const part_kinds *k, double step)
{
    tally t = {0};
    for (int y = 0; y < s->height; y++)
        for (int x = 0; x < s->width; x++) {
            unsigned ink = ink_at(s, x, y), around = ink ? kinds_around(s, k, x, y) : 0;
            int      own = kind_at(s, k, x, y);
            for (int kind = STROKES; kind <= FOUND; kind++) {
                t.ink[kind] += (ink >> kind) & 1;
                t.alien[kind] += (ink >> kind & 1) && !(around >> kind & 1);
            }
            if (own != NONE_KIND && is_rim(s, k, x, y, step)) {
                t.rims[own]++;
                t.inked[own] += (ink_around(s, x, y) >> own) & 1;
            }
        }
    return t;
}

static const char *look_of(const subject *s, const char *found, const char *visibility)
{
    static char texts[4][1200];
    static int  next;
    char       *text = texts[next++ % 4];
    snprintf(text, sizeof texts[0], look_text, found, s->select, visibility);
    return text;
}

static void in_the_window(void)
{
    static const char *const names[KINDS] = {"", "strokes", "lines of the picture"}, *const modes[] = {"exact",
                                                                                                       "sampled"};
    for (int i = 0; i < 2; i++)
        for (int mode = 0; mode < 2; mode++) {
            const subject *s = &subjects[i];
            char           model[512];
            snprintf(model, sizeof model, "%s/%s", LIMNER_EXAMPLES, s->model);
            shot_view view = {.width = SIDE, .height = SIDE, .bare = true};
            shot      t;
            if (shot_take(&t, model, look_of(s, "discontinuity", modes[mode]), NULL, &view)) {
                part_kinds k;
                find_kinds(&k, s, t.report);
                tally n = count_lines(&t, &k, 0.01 * (t.far_depth - t.near_depth));
                for (int kind = STROKES; kind <= FOUND; kind++) {
                    check_at_least("C11", (double)k.seen[kind], 3, "%s, %s: parts with %s that are seen", s->model,
                                   modes[mode], names[kind]);
                    check_at_least("C11", (double)n.ink[kind], 2000, "%s: pixels of %s", s->model, names[kind]);
                    check_at_most("C11", (double)n.alien[kind], 0, "%s: of which away from their parts", s->model);
                    check_at_least("C11", (double)n.rims[kind], 400, "%s: pixels of outlines of parts with %s",
                                   s->model, names[kind]);
                    check_at_least("C11", (double)n.inked[kind] / (double)n.rims[kind], 0.99,
                                   "%s: fraction of them with ink of that kind", s->model);
                }
            }
            shot_release(&t);
        }
}

/* --- as a vector drawing -------------------------------------------------------------------------------- */

enum { STYLES_MAX = 64 };

/* The style that an element is of class of, −1: of none. */
static int style_of(const char *element)
{
    const char *at = strstr(element, "class=\""), *end = at ? strchr(at + 7, '"') : NULL;
    for (at = at ? at + 7 : NULL; at && at < end; at += strcspn(at, " \"") + 1)
        if (at[0] == 's' && at[1] >= '0' && at[1] <= '9')
            return (int)strtol(at + 1, NULL, 10);
    return -1;
}

/* Reads a line of the drawing's file: which styles are of which kind, whose part follows, and what its lines are
 * drawn with: `*open` is the style of the group around them. */
static void read_line(const subject *s, const char *line, int styles[STYLES_MAX], int *open, int *kind, tally *out)
{
    int         style;
    char        colour[8] = "";
    const char *part = strstr(line, "data-name=\"");
    bool path = strncmp(line, "<path", 5) == 0 || strncmp(line, "<circle", 7) == 0 || strncmp(line, "<ellipse", 8) == 0;
    if (sscanf(line, ".s%d{stroke:%7[#0-9a-f]", &style, colour) == 2 && style < STYLES_MAX)
        styles[style] = strcmp(colour, "#ff0000") == 0 ? STROKES : strcmp(colour, "#0000ff") == 0 ? FOUND : NONE_KIND;
    if (strncmp(line, "<g", 2) == 0)
        *open = style_of(line);
    if (part) {
        part += strlen("data-name=\"");
        *kind = is_marked(s, part, strcspn(part, "\""));
        *kind = *kind ? STROKES : FOUND;
    }
    if (path && *kind != NONE_KIND) {
        style = style_of(line);
        style = style < 0 ? *open : style;
        out->ink[*kind]++;
        out->alien[*kind] += style < 0 || style >= STYLES_MAX || styles[style] != *kind;
    }
}

static bool write_look(const char *path, const char *look)
{
    FILE *file = fopen(path, "w");
    bool  good = file && fputs(look, file) >= 0;
    if (file)
        fclose(file);
    return good;
}

/* How many of the samples along the lines are not where they should be: what the drawing's report says. */
static void read_verdict(const char *path, double *samples, double *wrong)
{
    static char text[1 << 20];
    FILE       *file = fopen(path, "r");
    size_t      size = file ? fread(text, 1, sizeof text - 1, file) : 0;
    text[size] = '\0';
    if (file)
        fclose(file);
    const char *verify = strstr(text, "\"verify\""), *of = verify ? strstr(verify, "\"samples\"") : NULL,
               *bad = verify ? strstr(verify, "\"wrong\"") : NULL;
    *samples = of ? atof(strchr(of, ':') + 1) : 0;
    *wrong = bad ? atof(strchr(bad, ':') + 1) : INFINITY;
}

static void as_strokes(void)
{
    static char line[1 << 20];
    for (int i = 0; i < 2; i++) {
        const subject *s = &subjects[i];
        char           command[3000], look[400], drawing[400], report[400];
        snprintf(look, sizeof look, "%s", check_path("hybrid.json"));
        snprintf(drawing, sizeof drawing, "%s", check_path("hybrid.svg"));
        snprintf(report, sizeof report, "%s", check_path("hybrid-report.json"));
        snprintf(command, sizeof command, "%s draw %s/%s -o %s --look %s --report %s --verify --quiet", LIMNER_COMMAND,
                 LIMNER_EXAMPLES, s->model, drawing, look, report);
        bool  good = write_look(look, look_of(s, "discontinuity", "auto")) && system(command) == 0;
        FILE *file = good ? fopen(drawing, "r") : NULL;
        int   styles[STYLES_MAX] = {0}, kind = NONE_KIND, open = -1;
        tally t = {0};
        while (file && fgets(line, sizeof line, file))
            read_line(s, line, styles, &open, &kind, &t);
        check_that("C11", file != NULL, "%s as a vector drawing", s->model);
        if (file)
            fclose(file);
        for (kind = STROKES; kind <= FOUND; kind++) {
            check_at_least("C11", (double)t.ink[kind], 20, "%s: lines of parts with %s", s->model,
                           kind == STROKES ? "strokes" : "lines of the picture");
            check_at_most("C11", (double)t.alien[kind], 0, "%s: of which drawn as the other rule says", s->model);
        }
        double samples, wrong;
        read_verdict(report, &samples, &wrong);
        check_at_least("C11", samples, 1000, "%s: places along lines of both", s->model);
        check_at_most("C11", wrong / samples, 0.001, "%s: share that is hidden and drawn, or seen and not", s->model);
    }
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {{"window", in_the_window}, {"strokes", as_strokes}};
    int                     status = check_main(argc, argv, "strokes_hybrid", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
