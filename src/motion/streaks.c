/* streaks: strokes along what the exposure saw move, in the object's own colours, into which it dissolves. Großmann
 * 2011, chapters 6 and 7; rows 58 to 76h. Strokes are built on the page: as wide at any depth and in any direction,
 * with caps of their own shape. */
#include <math.h>

#include "base/memory.h"
#include "base/random.h"
#include "motion/motion.h"
#include "motion/seeds.h"
#include "motion/streak_texture.h"

typedef enum streak_path { PATH_STRAIGHT, PATH_BENT, PATH_WINDING } streak_path;

typedef enum streak_where { WHERE_ALL, WHERE_TRAILING, WHERE_LEADING } streak_where;

typedef struct streaks_values {
    motion_common common;
    int32_t       count, seeds, jittered, path, place, ink, where;
    float margin, jitter, jitter_rate, width, taper, uneven, shift_width, shift_length, begin, full, fade, fade_begin,
        fade_full, front, opacity, head, tail, round;
    bool        scaled, shadows;
    colour      colour;
    param_words texture, mask;
} streaks_values;

static const char *const sequence_names[] = {"random", "hammersley", "halton", NULL};
static const char *const jitter_names[] = {"none", "all", "each", "drift", NULL};
static const char *const path_names[] = {"straight", "bent", "winding", NULL};
static const char *const place_names[] = {"depth", "behind", "front", NULL};
static const char *const where_names[] = {"all", "trailing", "leading", NULL};
static const char *const ink_names[] = {"drawing", "colour", NULL};

static const param params[] = {
    PARAM_INT_ROW(streaks_values, count, .def = 10000, .min = 1, .max = 200000, .soft_min = 500, .soft_max = 30000,
                  .unit = UNIT_COUNT, .cpu_only = true,
                  .doc = "Seed points, spread over the picture and its margin; each that meets the object becomes a "
                         "stroke."),
    PARAM_ENUM_ROW(streaks_values, seeds, .names = sequence_names, .def = SEEDS_HALTON, .cpu_only = true,
                   .doc = "How seeds are spread: halton looks random and leaves no gaps; hammersley is regular; random "
                          "leaves gaps."),
    PARAM_FLOAT_ROW(streaks_values, margin, .def = 0.1, .min = 0, .max = 0.5, .unit = UNIT_FRACTION, .cpu_only = true,
                    .doc = "How far beyond the picture seeds lie, fraction of its sides, so that strokes come in at "
                           "the border as densely as inside."),
    PARAM_ENUM_ROW(streaks_values, jittered, .names = jitter_names, .def = JITTER_NONE, .cpu_only = true,
                   .doc = "Seeds that leave their positions with time: all alike, each by itself, or each in a calm "
                          "drift."),
    PARAM_FLOAT_ROW(streaks_values, jitter, .def = 3, .min = 0, .max = 750, .soft_max = 30, .unit = UNIT_PT,
                    .along = true, .cpu_only = true, .only_if = "jittered", .doc = "How far they leave them."),
    PARAM_FLOAT_ROW(streaks_values, jitter_rate, .def = 6, .min = 0, .max = 120, .soft_max = 24, .a_second = true,
                    .cpu_only = true, .only_if = "jittered", .doc = "How often a second they change."),
    PARAM_ENUM_ROW(streaks_values, where, .names = where_names, .def = WHERE_ALL, .variant = true,
                   .doc =
                       "On which surfaces strokes begin: all, only those that look back along the motion (trailing), "
                       "or only those that look ahead."),
    PARAM_TEXT_ROW(streaks_values, mask, .is_file = true, .example = "checker", .check = streak_mask_check,
                   .doc =
                       "A picture laid over the page (.png, .jpg, .webp): where it is black no stroke begins. checker "
                       "is one of squares. Empty: strokes begin anywhere."),
    PARAM_ENUM_ROW(streaks_values, path, .names = path_names, .def = PATH_BENT, .variant = true,
                   .doc = "straight: from where the surface is to where it was; bent: through one position between; "
                          "winding: through three."),
    PARAM_FLOAT_ROW(streaks_values, width, .def = 3.75, .min = 0.375, .max = 150, .soft_max = 18, .unit = UNIT_PT,
                    .doc = "Width of strokes, the same at any distance."),
    PARAM_FLOAT_ROW(streaks_values, taper, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much narrower strokes become towards their tails."),
    PARAM_FLOAT_ROW(streaks_values, uneven, .def = 0.3, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much shorter than the way that was gone strokes may be, each by itself, as by hand."),
    PARAM_BOOL_ROW(streaks_values, scaled, .def = 0,
                   .doc = "Strokes are smaller with distance, and as many more; the width is that at the nearest."),
    PARAM_FLOAT_ROW(streaks_values, shift_width, .def = 1, .min = 0, .max = 16, .soft_max = 4,
                    .doc = "How far behind their seeds strokes begin, in halves of their width; so that none stands "
                           "out ahead. The larger of the two shifts counts."),
    PARAM_FLOAT_ROW(streaks_values, shift_length, .def = 0, .min = 0, .max = 0.9, .unit = UNIT_FRACTION,
                    .doc = "The same, as a fraction of their length."),
    PARAM_FLOAT_ROW(streaks_values, begin, .def = 6, .min = 0, .max = 750, .soft_max = 75, .unit = UNIT_PT,
                    .along = true,
                    .doc = "Shorter strokes are not drawn; a stroke that is drawn is at least as long as it is wide."),
    PARAM_FLOAT_ROW(streaks_values, full, .def = 18, .min = 0, .max = 1500, .soft_max = 150, .unit = UNIT_PT,
                    .along = true, .doc = "Strokes of this length are whole; between, they fade in."),
    PARAM_FLOAT_ROW(streaks_values, fade, .toggles = true, .def = 0.85, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far what moves fast fades behind its strokes; 0 leaves the object whole and adds speed "
                           "lines alone."),
    PARAM_FLOAT_ROW(streaks_values, fade_begin, .def = 18, .min = 0, .max = 1500, .soft_max = 150, .unit = UNIT_PT,
                    .along = true, .only_if = "fade>0", .doc = "What moves less far in the exposure does not fade."),
    PARAM_FLOAT_ROW(streaks_values, fade_full, .def = 60, .min = 0, .max = 3000, .soft_max = 300, .unit = UNIT_PT,
                    .along = true, .only_if = "fade>0", .doc = "What moves this far is gone."),
    PARAM_FLOAT_ROW(streaks_values, front, .toggles = true, .def = 13.5, .min = 0, .max = 750, .soft_max = 75,
                    .unit = UNIT_PT, .along = true, .only_if = "fade>0",
                    .doc = "How much of what goes ahead is kept: the object dissolves from behind."),
    PARAM_TEXT_ROW(streaks_values, texture, .is_file = true, .example = "clear-border", .check = streak_texture_check,
                   .doc = "How strokes look: solid, clear or gradient, each with -border for a dark rim, or a picture "
                          "(.png, .jpg, .webp) from tail to head, whose lightness and opacity they take. Empty: "
                          "gradient."),
    PARAM_FLOAT_ROW(streaks_values, head, .def = 0.15, .min = 0.01, .max = 0.49, .unit = UNIT_FRACTION,
                    .doc = "How much of the texture is the head, which keeps its shape however long the stroke is."),
    PARAM_FLOAT_ROW(streaks_values, tail, .def = 0.15, .min = 0.01, .max = 0.49, .unit = UNIT_FRACTION,
                    .doc = "How much of it is the tail."),
    PARAM_FLOAT_ROW(streaks_values, opacity, .def = 1, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Opacity of strokes."),
    PARAM_FLOAT_ROW(streaks_values, round, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How far the first light shades strokes as if they were round."),
    PARAM_BOOL_ROW(streaks_values, shadows, .def = 0, .cpu_only = true,
                   .doc = "Strokes throw shadows, where the look has some (scene.shadows)."),
    PARAM_ENUM_ROW(streaks_values, ink, .names = ink_names, .def = 0, .variant = true,
                   .doc = "drawing: each stroke has the colour of the object where it begins; colour: all have one."),
    PARAM_COLOUR_ROW(streaks_values, colour, .def_colour = {0.1f, 0.1f, 0.1f, 1}, .only_if = "ink=colour",
                     .doc = "Colour of strokes."),
    PARAM_ENUM_ROW(streaks_values, place, .names = place_names, .def = 0, .variant = true,
                   .doc = "depth: strokes and object hide each other as they lie; behind: no stroke cuts its object; "
                          "front: strokes lie over it."),
};

static unsigned channels_of(const void *values)
{
    return ((const streaks_values *)values)->where == WHERE_ALL ? 0 : CHANNEL_NORMAL_DEPTH;
}

static int steps_of(const void *values)
{
    static const int steps[] = {1, 2, 4};
    return steps[((const streaks_values *)values)->path];
}

/* --- seeds ---------------------------------------------------------------------------------------------- */

/* Two vertices at each end of each of its segments. */
static int strip_vertices(const void *values)
{
    static const int segments[] = {1, 5, 16};
    return 2 * (segments[((const streaks_values *)values)->path] + 1);
}

static double within(double x, double low, double high)
{
    return x < low ? low : x > high ? high : x;
}

/* Does the seed read a pixel of the object's box? Beyond the border it reads the border's. */
static bool meets(const strip_view *view, double x, double y)
{
    double column = within(x, 0, view->width - 1), row = within(y, 0, view->height - 1);
    return column >= view->box[0] - 1 && column <= view->box[0] + view->box[2] && row >= view->box[1] - 1 &&
           row <= view->box[1] + view->box[3];
}

static float *make_strips(size_t *count, const void *values, const strip_view *view)
{
    const streaks_values *v = values;
    size_t                all = (size_t)v->count;
    double(*places)[3] = mem_alloc(all * sizeof *places), ticks = view->time_s * (double)v->jitter_rate;
    float *records = mem_alloc(all * 4 * sizeof *records);
    *count = 0;
    if (places && records)
        seeds_place((seed_sequence)v->seeds, all, view->seed, places);
    for (size_t i = 0; places && records && i < all; i++) {
        double wide = 1 + 2 * (double)v->margin, off[2];
        seed_offset((seed_jitter)v->jittered, i, view->seed, ticks, off);
        double x = (places[i][0] * wide - (double)v->margin) * view->width + off[0] * (double)v->jitter;
        double y = (places[i][1] * wide - (double)v->margin) * view->height + off[1] * (double)v->jitter;
        if (!meets(view, x, y))
            continue;
        float *record = &records[4 * (*count)++];
        record[0] = (float)x;
        record[1] = (float)y;
        record[2] = (float)places[i][2];
        record[3] = (float)i;
    }
    mem_free(places);
    return records;
}

static void describe_texture(text *out, const void *values)
{
    text_append(out, "streak %s", ((const streaks_values *)values)->texture.text);
}

static lmn_status make_texture(mip_chain *out, const void *values, lmn_error *error)
{
    return streak_texture_make(out, ((const streaks_values *)values)->texture.text, error);
}

static void describe_mask(text *out, const void *values)
{
    text_append(out, "streak mask %s", ((const streaks_values *)values)->mask.text);
}

static lmn_status make_mask(mip_chain *out, const void *values, lmn_error *error)
{
    return streak_mask_make(out, ((const streaks_values *)values)->mask.text, error);
}

static const strip_source strips = {"motion/streaks.vert", strip_vertices, make_strips};

enum { STREAKS = TARGET_COUNT, STREAKS_DEPTH };

static const target_row targets[] = {
    {"t_streaks", TEXEL_RGBA16F},
    {"t_streaks_depth", TEXEL_DEPTH32F},
};

#define STREAK_READS                                                                                                   \
    {                                                                                                                  \
        TARGET_VELOCITY, TARGET_PAST_1, TARGET_PAST_2, TARGET_PAST_3, TARGET_DEPTH, TARGET_MOVER, TARGET_SCENE_DEPTH,  \
            TARGET_NORMAL_DEPTH                                                                                        \
    }

/* The nearest depth of all strokes and the colour of the last one: as an artist paints over (section 6.5.1). */
static const pass passes[] = {
    {.name = "depths",
     .shader = "motion/streaks.frag",
     .reads = STREAK_READS,
     .writes = (target)STREAKS_DEPTH,
     .strips = &strips},
    {.name = "strokes",
     .shader = "motion/streaks.frag",
     .reads = STREAK_READS,
     .writes = (target)STREAKS,
     .blend = BLEND_OVER,
     .strips = &strips},
    {.name = "shadows",
     .when = "shadows",
     .shader = "motion/streaks.frag",
     .reads = STREAK_READS,
     .writes = TARGET_SHADOW,
     .strips = &strips},
    {.name = "streaks",
     .shader = "motion/streaked.frag",
     .reads = {TARGET_MOVER, TARGET_MOVER_DEPTH, TARGET_DEPTH, TARGET_VELOCITY, TARGET_PAST_1, TARGET_PAST_2,
               TARGET_SCENE_DEPTH, (target)STREAKS, (target)STREAKS_DEPTH},
     .writes = TARGET_PAGE,
     .blend = BLEND_OVER,
     .depth = true},
};

static const texture_source textures[] = {
    {.name = "stroke", .describe = describe_texture, .make = make_texture},
    {.name = "mask", .when = "mask", .describe = describe_mask, .make = make_mask},
};

const technique motion_streaks = {
    .name = "streaks",
    .doc = "Strokes along the motion, in the object's colours; it dissolves in them where it is fast.",
    .example = "{\"motion\": {\"technique\": \"streaks\", \"ink\": \"colour\", \"exposure\": 0.3}, \"surface\": "
               "\"toon\", \"lines\": "
               "\"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(streaks_values),
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .targets = targets,
    .target_count = PARAM_COUNT(targets),
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
    .motion = &(const motion_row){.steps = steps_of, .moved = channels_of},
};
