/* pencil: lines drawn several times, as a hand restates them: fine dark copies, and coarse light ones like those of a
 * first construction. Each copy looks the edge map up along waves of its own; all of them in the one pass that composes
 * the figure, a lookup a copy. Müller, section 2.3, equations 4 and 5, appendix B; rows P7 to P11, P29, P33, P34, P38,
 * and hatching that runs past contours (P35).
 *
 * Other than Müller: copies sample the finished edge map instead of repeating the detection; both factors of an edge
 * are clamped by the detection itself; amplitudes are held back where waves would fold the picture (Müller's do so
 * below 128 pixels); intensities are of displayed grey, as there. */
#include <math.h>

#include "halftone/graphite.h"
#include "base/random.h"
#include "perturb/perturb.h"

enum { COPIES_MAX = 16 };

typedef struct pencil {
    int32_t dark, light;
    float dark_sway, dark_waves_least, dark_waves_most, light_sway, light_waves_least, light_waves_most, jitter, sketch;
    int32_t lead;
    float   texture, pressure, grain;
    palette colours;
    float   overrun, overrun_angle, overrun_width;
    colour  fallback;
    int32_t seed;
} pencil;

#define WAVES_ROW(FIELD, DEFAULT, TEXT)                                                                                \
    PARAM_FLOAT_ROW(pencil, FIELD, .def = DEFAULT, .min = 0, .max = 100, .soft_max = 20, .cpu_only = true, .doc = TEXT)

static const param params[] = {
    PARAM_INT_ROW(
        pencil, dark, .def = 4, .min = 0, .max = COPIES_MAX, .soft_max = 8, .unit = UNIT_COUNT, .variant = true,
        .doc = "How often the final lines are drawn; a single one has its fraction of their darkness, so that "
               "it is full where all fall together. "
               "Without copies of either kind lines stay as exact and black as without a perturbation."),
    PARAM_FLOAT_ROW(pencil, dark_sway, .def = 1.5, .min = 0, .max = 48, .soft_max = 6, .unit = UNIT_PT,
                    .cpu_only = true, .doc = "How far final lines sway from the exact ones."),
    WAVES_ROW(dark_waves_least, 1.27, "Waves of final lines across the page, at least."),
    WAVES_ROW(dark_waves_most, 10.2, "Waves of final lines across the page, at most."),
    PARAM_INT_ROW(
        pencil, light, .def = 3, .min = 0, .max = COPIES_MAX, .soft_max = 8, .unit = UNIT_COUNT, .variant = true,
        .doc = "How often lines are drawn as in a first sketch, lighter, with longer waves, and faded here and there."),
    PARAM_FLOAT_ROW(pencil, light_sway, .def = 12, .min = 0, .max = 48, .soft_max = 24, .unit = UNIT_PT,
                    .cpu_only = true, .doc = "How far sketched lines sway from the exact ones."),
    WAVES_ROW(light_waves_least, 0.64, "Waves of sketched lines across the page, at least."),
    WAVES_ROW(light_waves_most, 1.27, "Waves of sketched lines across the page, at most."),
    PARAM_FLOAT_ROW(pencil, jitter, .def = 0.75, .min = 0, .max = 24, .soft_max = 3, .unit = UNIT_PT, .cpu_only = true,
                    .doc = "How far copies lie apart besides, both ways."),
    PARAM_FLOAT_ROW(pencil, sketch, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Darkness of sketched lines where they have not faded."),
    PARAM_ENUM_ROW(pencil, lead, .names = lead_grade_names, .def = LEAD_8B, .cpu_only = true,
                   .doc = "The lead, from hard and light to soft and dark."),
    PARAM_FLOAT_ROW(pencil, texture, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much streaks of graphite break lines up."),
    PARAM_FLOAT_ROW(pencil, pressure, .toggles = true, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much the weight of final lines varies along them."),
    PARAM_FLOAT_ROW(pencil, grain, .def = 0.75, .min = 0.1875, .max = 12, .soft_max = 3, .unit = UNIT_PT, .along = true,
                    .doc = "Size of a grain of streaks and of what has faded."),
    PARAM_PALETTE_ROW(pencil, colours, .def_palette = {1, {{0, 0, 0, 1}}},
                      .doc = "With several colours, final copies take them in turn and mix as coloured pencils do over "
                             "each other; with one, lines have their own."),
    PARAM_FLOAT_ROW(pencil, overrun, .toggles = true, .def = 0, .min = 0, .max = 48, .soft_max = 15, .unit = UNIT_PT,
                    .doc =
                        "How far strokes of the fill run past contours and fall short of them; 0 ends them exactly."),
    PARAM_FLOAT_ROW(pencil, overrun_angle, .def = 45, .min = -360, .max = 360, .soft_min = -90, .soft_max = 90,
                    .unit = UNIT_DEGREES, .as_turn = true, .only_if = "overrun",
                    .doc = "Direction on the page in which they do."),
    PARAM_FLOAT_ROW(pencil, overrun_width, .def = 3.75, .min = 0.75, .max = 48, .soft_max = 12, .unit = UNIT_PT,
                    .along = true, .only_if = "overrun", .doc = "Width of the strokes that do so together."),
    PARAM_COLOUR_ROW(pencil, fallback, .can_auto = true, .def_auto = true, .auto_ground = true, .only_if = "overrun",
                     .doc = "Ground inside the outline where strokes fell short; auto takes the page's."),
    PARAM_INT_ROW(pencil, seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .doc = "Another number draws other lines; counts with the drawing's own seed."),
};

static bool is_active(const void *values)
{
    const pencil *v = values;
    return v->dark + v->light > 0;
}

static float reach_of(const void *values)
{
    const pencil *v = values;
    float         dark = v->dark ? v->dark_sway : 0, light = v->light ? v->light_sway : 0;
    return fmaxf(fmaxf(dark, light) + v->jitter, v->overrun);
}

static uint32_t seed_of(const void *values, uint32_t seed, double time_s)
{
    (void)time_s; /* frames of one view are the same */
    return (seed + (uint32_t)((const pencil *)values)->seed) * 2654435761u;
}

/* Two vectors a copy, dark ones first: angular frequency and phase of the way to the right along the page's height,
 * and of the way up along its width; jitter to the right and up, sway, 0. At the end one with the lead's darkness. */
static size_t numbers_of(const void *values, uint32_t seed, int width, int height, float out[][4])
{
    const pencil *v = values;
    const double  turn = 6.283185307179586;
    double        side = width < height ? width : height;
    size_t        count = 0;
    for (int32_t i = 0; i < v->dark + v->light; i++) {
        bool          light = i >= v->dark;
        random_source r = random_start(seed_of(v, seed, 0), (uint32_t)(light ? i - v->dark + COPIES_MAX : i));
        double        least = turn * (double)(light ? v->light_waves_least : v->dark_waves_least),
               most = turn * (double)(light ? v->light_waves_most : v->dark_waves_most);
        double sway = (double)(light ? v->light_sway : v->dark_sway);
        double first = least + (most - least) * random_unit(&r), first_phase = turn * random_unit(&r);
        double second = least + (most - least) * random_unit(&r), second_phase = turn * random_unit(&r);
        double right = (double)v->jitter * random_signed(&r), up = (double)v->jitter * random_signed(&r);
        /* Positions must not fold over each other. */
        sway = fmin(sway, 0.9 * side / fmax(fmax(first, second), 1e-3));
        const float rows[2][4] = {{(float)first, (float)first_phase, (float)second, (float)second_phase},
                                  {(float)right, (float)up, (float)sway, 0}};
        for (int k = 0; k < 8; k++)
            out[count + (size_t)(k / 4)][k % 4] = rows[k / 4][k % 4];
        count += 2;
    }
    out[count][0] = lead_darkest((lead_grade)v->lead);
    out[count][1] = out[count][2] = out[count][3] = 0;
    return count + 1;
}

static void describe(text *out, const void *values)
{
    (void)values;
    text_append(out, "2");
}

static lmn_status make(mip_chain *out, const void *values, lmn_error *error)
{
    (void)values;
    return graphite_grain(out, 1, error);
}

static const texture_source textures[] = {{.name = "graphite", .describe = describe, .make = make}};

static void pencil_hand(struct stroke_style *style, const void *values)
{
    const pencil *v = values;
    hand_draw(
        style,
        &(hand){.sway = v->dark_sway, .length = 90, .pressure = v->pressure, .copies = v->dark, .jitter = v->jitter});
}

static const perturbation perturbs = {
    .positions = "perturb/pencil.glsl",
    .active = is_active,
    .reach = reach_of,
    .seed = seed_of,
    .as_hand = pencil_hand,
};

const technique perturb_pencil = {
    .name = "pencil",
    .doc = "Lines restated several times, over a faint first sketch.",
    .example = "{\"perturb\": {\"technique\": \"pencil\", \"texture\": 0.3}, \"lines\": \"discontinuity\", "
               "\"surface\": \"flat\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(pencil),
    .perturbs = &perturbs,
    .numbers = numbers_of,
    .textures = textures,
    .texture_count = PARAM_COUNT(textures),
};
