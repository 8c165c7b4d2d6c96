/* limner strokes: textures of strokes from patterns and drawings, and a look at what stays of them in light and at
 * a distance. */
#include "cli.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "names.h"

typedef struct strokes_values {
    const char   *output, *format;
    option_number count, length, uneven, seed, size, width, light, distance;
    int           order, fraction, perspective;
} strokes_values;

#define AT(field) offsetof(strokes_values, field)

/* In the order of the library's names. */
static const char *const order_choices[] = {"drawn", "shuffled", "even", NULL};
static const char *const fraction_choices[] = {"count", "length", "area", NULL};
static const char *const perspective_choices[] = {"tied", "random", "even", "layers", NULL};

static const option options[] = {
    {"output", 'o', OPTION_TEXT, AT(output), "OUT",
     "File to write; its ending is the format: .stx, .svg or .png; - is standard output. Default: the pattern's or the "
     "file's name and .png."},
    {"format", 0, OPTION_TEXT, AT(format), "FORMAT", "Format whatever the ending: stx, svg or png."},
    {"count", 0, OPTION_WHOLE, AT(count), "N", "Strokes of a pattern, about. Default: what suits it.", 1, 500000},
    {"length", 0, OPTION_NUMBER, AT(length), "L",
     "Mean length of a pattern's strokes; the square is 1. Default: what suits it.", 0.001, 4},
    {"uneven", 0, OPTION_NUMBER, AT(uneven), "U", "Pattern: from 0, regular, to 1, very irregular. Default: 0.5.", 0,
     1},
    {"seed", 0, OPTION_WHOLE, AT(seed), "N", "What chance begins with. Default: 0.", 0, 4294967295.0},
    {"order", 0, OPTION_CHOICE, AT(order), "drawn|shuffled|even",
     "Order of priorities within a layer. Default: even for patterns, drawn for files.", .choices = order_choices},
    {"fraction", 0, OPTION_CHOICE, AT(fraction), "count|length|area",
     "What a stroke's step in priority follows; area makes tone follow light on a straight line at --width. Default: "
     "length.",
     .choices = fraction_choices},
    {"perspective", 0, OPTION_CHOICE, AT(perspective), "tied|random|even|layers",
     "Priorities for distance: as for light, by chance, evenly spread, or late layers go first. Default: even for "
     "patterns; files keep theirs.",
     .choices = perspective_choices},
    {"size", 0, OPTION_WHOLE, AT(size), "PX", "Pixels a side of a .png. Default: 512.", 1, 8192},
    {"width", 0, OPTION_NUMBER, AT(width), "W", "Pixels that a stroke is wide in a .png. Default: 1/170 of the size.",
     0.05, 256},
    {"light", 0, OPTION_NUMBER, AT(light), "T",
     "Only strokes that stay at this light are in a .png, 0 dark to 1. Default: 0.", -1e6, 1e6},
    {"distance", 0, OPTION_NUMBER, AT(distance), "T",
     "Only strokes that stay at this distance are in a .png: 0.5 twice as far, 0.75 four times. Default: 0.", -1e6,
     1e6},
};

static const char *pattern_at(size_t index, const void *user)
{
    (void)user;
    return lmn_stroke_pattern_name((int)index);
}

static int find_pattern(const char *name)
{
    for (int i = 0; lmn_stroke_pattern_name(i); i++)
        if (strcmp(lmn_stroke_pattern_name(i), name) == 0)
            return i;
    return -1;
}

static int unknown_pattern(const char *name)
{
    char        hint[128] = "a pattern is one of";
    const char *near = options_nearest(name, pattern_at, NULL);
    for (int i = 0; lmn_stroke_pattern_name(i) && !near; i++) {
        size_t length = strlen(hint);
        snprintf(hint + length, sizeof hint - length, "%s %s", i ? "," : "", lmn_stroke_pattern_name(i));
    }
    if (near)
        snprintf(hint, sizeof hint, "did you mean '%s'?", near);
    return message_usage(hint, "there is no pattern '%.80s'", name);
}

static double given_or(const option_number *number, double otherwise)
{
    return number->given ? number->value : otherwise;
}

static double width_in_square(const strokes_values *v)
{
    double size = given_or(&v->size, 512);
    return fmin(1, given_or(&v->width, size / 170) / size);
}

static bool is_format(const char *ending)
{
    return strcmp(ending, ".stx") == 0 || strcmp(ending, ".svg") == 0 || strcmp(ending, ".png") == 0;
}

static int check(const strokes_values *v, bool is_pattern, char format[16])
{
    const char *dot = v->output ? strrchr(v->output, '.') : ".png";
    if (!is_pattern && (v->count.given || v->length.given || v->uneven.given))
        return message_usage(NULL, "--%s goes with a pattern, not with a file",
                             v->count.given    ? "count"
                             : v->length.given ? "length"
                                               : "uneven");
    snprintf(format, 16, "%s", dot ? dot : "");
    if (v->format)
        snprintf(format, 16, "%s%s", *v->format == '.' ? "" : ".", v->format);
    else if (v->output && strcmp(v->output, "-") == 0)
        snprintf(format, 16, ".png");
    for (char *at = format; *at; at++)
        *at = *at >= 'A' && *at <= 'Z' ? (char)(*at - 'A' + 'a') : *at;
    if (is_format(format))
        return EXIT_DONE;
    if (v->format)
        return message_usage("formats are stx, svg and png", "--format is '%s'; there is no such format", v->format);
    return message_usage("the ending says the format: .stx, .svg or .png; --format says it whatever the ending",
                         "%s: cannot tell the format from '%s'", v->output, *format ? format : v->output);
}

static lmn_status make_strokes(lmn_strokes **out, const char *input, int pattern, const strokes_values *v,
                               lmn_error *error)
{
    lmn_pattern_desc desc = LMN_PATTERN_DESC_INIT;
    if (pattern < 0)
        return lmn_strokes_load(out, input, error);
    desc.pattern = (lmn_stroke_pattern)pattern;
    desc.count = (size_t)given_or(&v->count, 0);
    desc.length = given_or(&v->length, 0);
    desc.uneven = given_or(&v->uneven, 0.5);
    desc.seed = (uint32_t)given_or(&v->seed, 0);
    return lmn_strokes_create(out, &desc, error);
}

static lmn_status set_priorities(lmn_strokes *s, bool is_pattern, const strokes_values *v, lmn_error *error)
{
    lmn_status status = LMN_OK;
    uint32_t   seed = (uint32_t)given_or(&v->seed, 0);
    int        order = v->order >= 0 ? v->order : is_pattern ? LMN_ORDER_EVEN : LMN_ORDER_DRAWN;
    int        fraction = v->fraction >= 0 ? v->fraction : LMN_FRACTION_LENGTH;
    if (v->order >= 0 || v->fraction >= 0)
        status = lmn_strokes_set_light(s, (lmn_stroke_order)order, (lmn_stroke_fraction)fraction, width_in_square(v),
                                       seed, error);
    if (status == LMN_OK && v->perspective >= 0)
        status = lmn_strokes_set_perspective(s, (lmn_stroke_perspective)v->perspective, seed, error);
    return status;
}

static lmn_status write_strokes(const lmn_strokes *s, const char *path, const char *format, const strokes_values *v,
                                lmn_error *error)
{
    lmn_strokes_view view = LMN_STROKES_VIEW_INIT;
    view.size = (int)given_or(&v->size, 512);
    view.width = given_or(&v->width, 0);
    view.light = given_or(&v->light, 0);
    view.distance = given_or(&v->distance, 0);
    return lmn_strokes_write(s, path, format, &view, error);
}

static int run(const word_list *inputs, const void *values)
{
    const strokes_values *v = values;
    const char           *input = inputs->items[0];
    int                   pattern = find_pattern(input);
    lmn_strokes          *s = NULL;
    lmn_error             error = {0};
    char                  format[16], *path = NULL;
    if (pattern < 0 && !strpbrk(input, "./"))
        return unknown_pattern(input);
    int status = check(v, pattern >= 0, format);
    if (status != EXIT_DONE)
        return status;
    path = name_expand(v->output ? v->output : NAME_PLACEHOLDER ".png", input, 0);
    if (!path)
        return message_out_of_memory();
    if (make_strokes(&s, input, pattern, v, &error) != LMN_OK || set_priorities(s, pattern >= 0, v, &error) != LMN_OK ||
        write_strokes(s, path, format, v, &error) != LMN_OK)
        status = message_error(&error);
    lmn_strokes_destroy(&s);
    free(path);
    return status;
}

const command command_strokes = {
    .name = "strokes",
    .inputs = "PATTERN|FILE",
    .summary = "Make textures of strokes for hatching, and see what stays of them.",
    .detail = "A PATTERN is parallel, cross, contour, brick, stipple, scribble or random; a FILE is a stroke texture "
              "(.stx) or a drawing (.svg).\n"
              "docs/reference/strokes.md tells more.",
    .options = options,
    .option_count = OPTION_COUNT(options),
    .values_size = sizeof(strokes_values),
    .inputs_min = 1,
    .inputs_max = 1,
    .run = run,
};
