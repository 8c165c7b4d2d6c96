/* uncertainty: a continuous field of noise moves the places where lines, fill and depth of a figure are looked up, so
 * that lines waver, fill runs over the lines and falls short of them, and all of it still obeys the depth of its
 * neighbours. Nienhaus 2005, chapter 6, and Nienhaus et al. 2006, section 4; rows S01–S13, C13–C18, C20–C25.
 *
 * Where the sources are silent or wrong: noise is signed (unsigned values, as listing 6-1 reads them, move everything
 * one way); the two components are independent (the sources' second one, taken at (1−s, 1−t), equals the first in the
 * middle of the page); ink outside the boundary has the depth of the surface that it surrounds (its own lookup is
 * empty); towards the page's border the field shrinks, so that nothing is looked up outside. Enlarged geometry
 * (section 6.7) gives a field that jumps where depth jumps; spread from the nearest surfaces outwards ("continuous") it
 * does not. Its wave length counts pixels, not units, at any distance: octaves come and go as the viewer approaches. */
#include <math.h>

#include "perturb/perturb.h"

typedef struct uncertainty {
    float   amount;
    int32_t lock, field;
    float   scale, tile, boil;
    int32_t octaves, seed, by, outward;
    float   enlarge;
    float   edges_xx, edges_xy, edges_yx, edges_yy, shades_xx, shades_xy, shades_yx, shades_yy;
    float   rough, tooth, grain;
    int32_t repeat;
    float   repeat_degree, pressure, narrow;
    palette repeat_colours;
    colour  fallback;
} uncertainty;

static const char *const lock_names[] = {"object", "screen", NULL};
static const char *const field_names[] = {"noise", "turbulence", NULL};
static const char *const by_names[] = {"position", "normal", "curvature", NULL};
static const char *const outward_names[] = {"continuous", "enlarged", NULL};

#define DEGREE_ROW(FIELD, DEFAULT, TEXT)                                                                               \
    PARAM_FLOAT_ROW(uncertainty, FIELD, .def = DEFAULT, .min = -4, .max = 4, .soft_min = -2, .soft_max = 2, .doc = TEXT)

static const param params[] = {
    PARAM_FLOAT_ROW(
        uncertainty, amount, .def = 3, .min = 0, .max = 48, .soft_max = 12, .unit = UNIT_PT,
        .doc = "Largest displacement for a degree of uncertainty of 1; 0 draws exactly, without grain or pressure."),
    PARAM_ENUM_ROW(uncertainty, lock, .names = lock_names, .variant = true,
                   .doc = "object: the wobble moves with the model; screen: it stays on the sheet, and a moving model "
                          "swims under it."),
    PARAM_ENUM_ROW(
        uncertainty, field, .names = field_names, .variant = true,
        .doc = "noise: smooth waves; turbulence: waves with sharp turns, the sum of the octaves' absolute values."),
    PARAM_FLOAT_ROW(uncertainty, scale, .def = 67.5, .min = 1.5, .max = 750, .soft_min = 11.25, .soft_max = 300,
                    .unit = UNIT_PT, .along = true, .logarithmic = true,
                    .doc = "Length of the longest waves on the sheet, the same at any distance."),
    PARAM_INT_ROW(uncertainty, octaves, .def = 2, .min = 1, .max = 4, .unit = UNIT_COUNT, .variant = true,
                  .doc = "Waves of how many lengths; each is half as long and half as strong as the one before."),
    PARAM_FLOAT_ROW(uncertainty, tile, .def = 0, .min = 0, .max = 12288, .soft_max = 768, .unit = UNIT_PT,
                    .along = true, .only_if = "lock=screen",
                    .doc = "The field repeats after this length, both ways; 0: it does not."),
    PARAM_INT_ROW(uncertainty, seed, .def = 0, .min = 0, .max = 1000000, .soft_max = 100, .cpu_only = true,
                  .doc = "Another number draws another wobble; counts with the drawing's own seed."),
    PARAM_FLOAT_ROW(
        uncertainty, boil, .a_second = true, .def = 0, .min = 0, .max = 60, .soft_max = 24, .cpu_only = true,
        .doc = "New wobbles a second of the drawing's time: 12 is drawn on twos at 24 frames a second; 0 keeps one."),
    PARAM_ENUM_ROW(uncertainty, by, .names = by_names, .variant = true, .only_if = "lock=object",
                   .doc = "What of the surface the wobble depends on: place, direction or bend."),
    PARAM_ENUM_ROW(
        uncertainty, outward, .names = outward_names, .variant = true, .only_if = "lock=object",
        .doc = "How the field goes on beside a surface: spread from it without jumps, or that of the enlarged model."),
    PARAM_FLOAT_ROW(uncertainty, enlarge, .def = 9, .min = 0.75, .max = 150, .soft_max = 30, .unit = UNIT_PT,
                    .along = true, .only_if = "outward=enlarged", .cpu_only = true,
                    .doc = "How far the enlarged model reaches beyond the model."),
    DEGREE_ROW(edges_xx, 1, "Degree of uncertainty of lines: fraction of the first noise in the way to the right."),
    DEGREE_ROW(edges_xy, 0, "Of lines: fraction of the second noise in the way to the right."),
    DEGREE_ROW(edges_yx, 0, "Of lines: fraction of the first noise in the way up."),
    DEGREE_ROW(edges_yy, 1, "Of lines: fraction of the second noise in the way up."),
    DEGREE_ROW(
        shades_xx, -0.75,
        "Degree of uncertainty of fill: fraction of the first noise in the way to the right; of another sign than "
        "that of lines, both part."),
    DEGREE_ROW(shades_xy, 0, "Of fill: fraction of the second noise in the way to the right."),
    DEGREE_ROW(shades_yx, 0, "Of fill: fraction of the first noise in the way up."),
    DEGREE_ROW(shades_yy, -0.75, "Of fill: fraction of the second noise in the way up."),
    PARAM_FLOAT_ROW(uncertainty, rough, .def = 0, .min = 0, .max = 12, .soft_max = 4.5, .unit = UNIT_PT,
                    .doc = "Displacement of every grain of the paper by itself: borders fray as chalk's do."),
    PARAM_FLOAT_ROW(uncertainty, tooth, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "Fraction of the paper's grains that the fill leaves bare; lines, drawn with more force, "
                           "leave half as many."),
    PARAM_FLOAT_ROW(uncertainty, grain, .def = 0.75, .min = 0.75, .max = 12, .soft_max = 3, .unit = UNIT_PT,
                    .along = true, .doc = "Size of the paper's grains."),
    PARAM_INT_ROW(uncertainty, repeat, .def = 1, .min = 1, .max = 8, .soft_max = 4, .unit = UNIT_COUNT, .variant = true,
                  .doc = "How often lines are drawn, each time displaced in another direction."),
    PARAM_FLOAT_ROW(uncertainty, repeat_degree, .def = 1, .min = 0.1, .max = 2, .soft_min = 0.5, .soft_max = 1.5,
                    .only_if = "repeat>1", .doc = "How much farther each repetition is displaced than the one before."),
    PARAM_PALETTE_ROW(uncertainty, repeat_colours, .def_palette = {1, {{0.45f, 0.47f, 0.50f, 1}}},
                      .only_if = "repeat>1",
                      .doc = "Colours of the repetitions, in turn; the first time lines have their own."),
    PARAM_FLOAT_ROW(uncertainty, pressure, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .doc = "How much the weight of lines varies along them."),
    PARAM_FLOAT_ROW(uncertainty, narrow, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "lock=object",
                    .doc =
                        "Lines and fill of a narrow part are moved by no more than this fraction of its width on the "
                        "sheet, so that both stay together; 0: as far as those of wide ones."),
    PARAM_COLOUR_ROW(uncertainty, fallback, .can_auto = true, .def_auto = true, .auto_ground = true,
                     .doc = "Ground inside the outline where the fill fell short or left grains bare; auto takes the "
                            "page's, none shows what "
                            "is behind. Not in what is seen through."),
};

static bool is_active(const void *values)
{
    const uncertainty *v = values;
    bool moves = v->edges_xx != 0 || v->edges_xy != 0 || v->edges_yx != 0 || v->edges_yy != 0 || v->shades_xx != 0 ||
                 v->shades_xy != 0 || v->shades_yx != 0 || v->shades_yy != 0;
    return v->amount > 0 && (moves || v->rough > 0 || v->tooth > 0 || v->pressure > 0);
}

static float row_sum(float a, float b)
{
    return fabsf(a) + fabsf(b);
}

static float reach_of(const void *values)
{
    const uncertainty *v = values;
    float              edges = fmaxf(row_sum(v->edges_xx, v->edges_xy), row_sum(v->edges_yx, v->edges_yy));
    float              shades = fmaxf(row_sum(v->shades_xx, v->shades_xy), row_sum(v->shades_yx, v->shades_yy));
    if (v->repeat > 1) /* turned, both components together may point along one axis */
        edges *= 1.4142136f * fmaxf(1, powf(v->repeat_degree, (float)(v->repeat - 1)));
    return v->amount * fmaxf(edges, shades) + v->rough;
}

/* Texels are so small that the shortest waves of two octaves have fourteen, and so large that those to which the
 * field spreads beside a surface (perturb/spread.glsl) reach as far as anything moves; a tile has a whole number of
 * them. */
static float cell_of(const void *values)
{
    const uncertainty *v = values;
    float              cell = fmaxf(fmaxf(v->scale / 29, reach_of(values) / 7), 1);
    return v->lock == 1 && v->tile > 0 ? v->tile / ceilf(v->tile / cell) : cell;
}

static uint32_t seed_of(const void *values, uint32_t seed, double time_s)
{
    const uncertainty *v = values;
    /* A frame at the turn belongs to the new wobble, also when its time was rounded to six digits. */
    uint32_t phase = (uint32_t)(int64_t)floor(time_s * (double)v->boil + 1e-4);
    return (seed + (uint32_t)v->seed) * 2654435761u ^ phase * 2246822519u;
}

static const pass map = {
    .name = "map",
    .shader = "perturb/map.frag",
    .reads = {TARGET_UNCERTAINTY},
    .writes = TARGET_FIELD,
};

static void uncertainty_hand(struct stroke_style *style, const void *values)
{
    static const float sway_fraction = 0.4f; /* most positions move by much less than the most */
    const uncertainty *v = values;
    hand_draw(style,
              &(hand){.sway = v->amount * sway_fraction, .length = v->scale, .pressure = v->pressure, .copies = 1});
}

static const perturbation perturbs = {
    .positions = "perturb/uncertainty.glsl",
    .active = is_active,
    .reach = reach_of,
    .cell = cell_of,
    .seed = seed_of,
    .map = &map,
    .as_hand = uncertainty_hand,
};

/* The figure with all surfaces moved outwards: x and y of the normal, part id, eye depth (0: empty). */
#define ENLARGED TARGET_OWN(0)
/* Uncertainty of the surfaces, times how sure it is; a: how sure. And on the way to the next. */
#define TRACES     TARGET_OWN(1)
#define TRACES_ROW TARGET_OWN(2)
/* How far a surface may move anything, fraction of the most, by how wide its part is. */
#define WIDTHS TARGET_OWN(3)
static const target_row targets[] = {
    {"t_enlarged", TEXEL_RGBA32F},
    {"t_traces", TEXEL_RGBA32F, SCALE_CELL},
    {"t_traces_row", TEXEL_RGBA32F, SCALE_CELL},
    {"t_widths", TEXEL_RGBA32F, SCALE_CELL},
};

static const pass passes[] = {
    {.name = "noise", .shader = "perturb/page.frag", .writes = TARGET_UNCERTAINTY, .when = "lock=screen"},
    {.name = "enlarged",
     .geometry = true,
     .enlarge = "enlarge",
     .writes = ENLARGED,
     .when = "lock=object&outward=enlarged"},
    {.name = "widths",
     .shader = "perturb/widths.frag",
     .reads = {TARGET_NORMAL_DEPTH, TARGET_ID},
     .writes = WIDTHS,
     .when = "lock=object&narrow>0"},
    {.name = "traces",
     .shader = "perturb/traces.frag",
     .reads = {TARGET_NORMAL_DEPTH, TARGET_ID, TARGET_REST, ENLARGED, WIDTHS},
     .writes = TRACES,
     .when = "lock=object"},
    {.name = "spread across",
     .shader = "perturb/spread_row.frag",
     .reads = {TRACES},
     .writes = TRACES_ROW,
     .when = "lock=object&outward=continuous"},
    {.name = "spread",
     .shader = "perturb/spread.frag",
     .reads = {TRACES, TRACES_ROW},
     .writes = TARGET_UNCERTAINTY,
     .when = "lock=object"},
};

const technique perturb_uncertainty = {
    .name = "uncertainty",
    .doc = "Lines and fill waver apart, as drawn by hand.",
    .example = "{\"perturb\": {\"technique\": \"uncertainty\", \"rough\": 0.8}, \"lines\": \"discontinuity\", "
               "\"surface\": \"lit\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(uncertainty),
    .channels = CHANNEL_NORMAL_DEPTH,
    .part_channels = CHANNEL_ID,
    .passes = passes,
    .pass_count = PARAM_COUNT(passes),
    .targets = targets,
    .target_count = PARAM_COUNT(targets),
    .perturbs = &perturbs,
};
