/* accumulate: the mean of pictures at several times, as a film sees them that is exposed again and again. The yardstick
 * for every other motion blur. Großmann 2011, section 4.2 (after Haeberli and Akeley 1990); rows 34, 35, 37, 38; and
 * plates that are exposed several times (section 2.1.4; row 77c). */
#include <math.h>

#include "motion/motion.h"

typedef enum accumulate_moments { MOMENTS_EQUAL, MOMENTS_TELLING, MOMENTS_AUTO } accumulate_moments;
typedef enum accumulate_weights { WEIGHTS_EQUAL, WEIGHTS_LAST, WEIGHTS_DECAY, WEIGHTS_PLATE } accumulate_weights;

typedef enum accumulate_overlap { OVERLAP_NEWEST, OVERLAP_THROUGH } accumulate_overlap;

typedef struct accumulate_values {
    motion_common common;
    int32_t       times, weights;
    float         last, decay;
    int32_t       moments;
    float         cover;
    int32_t       overlap;
} accumulate_values;

static const char *const moments_names[] = {"equal", "telling", "auto", NULL};
static const char *const overlap_names[] = {"newest", "through", NULL};
static const char *const weights_names[] = {"equal", "last", "decay", "plate", NULL};

static const param params[] = {
    PARAM_INT_ROW(accumulate_values, times, .def = 16, .min = 2, .max = 512, .soft_max = 64, .unit = UNIT_COUNT,
                  .cpu_only = true,
                  .doc = "How many pictures are averaged. Each is drawn whole, so the time it takes grows with them."),
    PARAM_ENUM_ROW(
        accumulate_values, weights, .names = weights_names, .def = WEIGHTS_EQUAL, .cpu_only = true,
        .doc =
            "How much each counts: equal, all alike; last, the newest most, so that it stands out and the "
            "direction can be told; decay, each less than the one after it; plate, no mean: all are there whole, as on "
            "one plate that is exposed again and again (Marey)."),
    PARAM_FLOAT_ROW(accumulate_values, last, .def = 6, .min = 1, .max = 512, .soft_max = 32, .cpu_only = true,
                    .only_if = "weights=last", .doc = "How many times as much as each other the newest counts."),
    PARAM_FLOAT_ROW(accumulate_values, decay, .def = 0.8, .min = 0, .max = 1, .cpu_only = true,
                    .only_if = "weights=decay,plate",
                    .doc = "How much of the one after it each counts; on a plate, how much of its ink each has."),
    PARAM_ENUM_ROW(accumulate_values, overlap, .names = overlap_names, .def = OVERLAP_NEWEST, .cpu_only = true,
                   .only_if = "weights=plate",
                   .doc = "Where figures of a plate lie over each other: newest, the newer one hides older ones; "
                          "through, each pixel keeps what differs most from the ground, as light adds up on a plate."),
    PARAM_ENUM_ROW(
        accumulate_values, moments, .names = moments_names, .def = MOMENTS_EQUAL, .cpu_only = true,
        .doc = "When pictures are taken: equal, at equal times; telling, where most of what moves turns back, rebounds "
               "or stops, and in between where there are fewer such moments; auto, only there, at most `times`."),
    PARAM_FLOAT_ROW(accumulate_values, cover, .def = 0.25, .min = 0, .max = 1, .unit = UNIT_FRACTION, .cpu_only = true,
                    .only_if = "moments=telling,auto",
                    .doc = "How much of a figure at one moment may lie over that at another one, fraction of the "
                           "smaller."),
};

static int times_of(const void *values)
{
    return ((const accumulate_values *)values)->times;
}

static double weight_of(const void *values, int newer)
{
    const accumulate_values *v = values;
    if (v->weights == WEIGHTS_LAST)
        return newer == 0 ? (double)v->last : 1;
    return v->weights == WEIGHTS_DECAY || v->weights == WEIGHTS_PLATE ? pow((double)v->decay, newer) : 1;
}

static bool chooses(const void *values, int *count, double *cover)
{
    const accumulate_values *v = values;
    *count = v->moments == MOMENTS_AUTO ? 0 : v->times;
    *cover = (double)v->cover;
    return v->moments != MOMENTS_EQUAL;
}

static bool is_plate(const void *values)
{
    return ((const accumulate_values *)values)->weights == WEIGHTS_PLATE;
}

static bool is_through(const void *values)
{
    return ((const accumulate_values *)values)->overlap == OVERLAP_THROUGH;
}

const technique motion_accumulate = {
    .name = "accumulate",
    .doc = "The mean of pictures at several times of the exposure.",
    .example = "{\"motion\": {\"technique\": \"accumulate\"}, \"surface\": \"lit\", \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(accumulate_values),
    .motion =
        &(const motion_row){
            .times = times_of, .weight = weight_of, .plate = is_plate, .through = is_through, .chooses = chooses},
};
