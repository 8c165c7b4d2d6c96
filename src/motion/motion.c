/* The table of techniques that tell of motion. */
#include "motion/motion.h"

static const technique *const techniques[] = {&motion_accumulate, &motion_blur,    &motion_deform,
                                              &motion_streak_map, &motion_streaks, &motion_stretched,
                                              &motion_stochastic, &motion_traces};

/* How the shape of what moves tells so, with any technique: src/pose/deform.h. */
#define SHAPE(KEY, ...) PARAM_FLOAT_ROW(motion_common, KEY, .cpu_only = true, __VA_ARGS__)

static const param common[] = {
    PARAM_FLOAT_ROW(motion_common, exposure, .def = 0.04, .min = 0.0001, .max = 3600, .soft_min = 0.005, .soft_max = 1,
                    .cpu_only = true,
                    .doc = "How long the shutter is open, seconds: motion is told of this long before the time that is "
                           "drawn. The same for all rules of a look."),
    SHAPE(stretch, .def = 0, .min = 0, .max = 4, .soft_max = 1, .unit = UNIT_FRACTION,
          .doc =
              "How much longer what moves becomes along its way at its full speed, and thinner across it; its volume "
              "stays."),
    SHAPE(squash, .def = 0, .min = 0, .max = 0.9, .unit = UNIT_FRACTION,
          .doc = "How much flatter what moves becomes where it is stopped at its full speed, as a ball that hits the "
                 "floor, and wider beside; the side that is stopped stays where it is, and the volume what it is."),
    SHAPE(lean, .def = 0, .min = 0, .max = 75, .soft_max = 45, .unit = UNIT_DEGREES,
          .doc = "How far what moves leans forward at its full speed. What it stands on stays."),
    SHAPE(inertia, .def = 0, .min = 0, .max = 75, .soft_max = 45, .unit = UNIT_DEGREES,
          .doc = "How far what moves leans back while it gets faster by motion.full_acceleration, and forward while it "
                 "gets slower."),
    SHAPE(full_speed, .def = 6, .min = 0.01, .max = 1000, .soft_min = 1, .soft_max = 30,
          .doc =
              "The full speed for motion.stretch, squash and lean, lengths of what moves a second. What is slower is "
              "deformed less in proportion, what is faster not more."),
    SHAPE(full_acceleration, .def = 12, .min = 0.01, .max = 10000, .soft_min = 1, .soft_max = 100,
          .only_if = "inertia>0",
          .doc = "The full acceleration for motion.inertia, lengths of what moves a second squared."),
    SHAPE(response, .def = 0.04, .min = 0.001, .max = 5, .soft_max = 0.5,
          .doc =
              "Speeds and accelerations are taken from so long before and after, seconds: longer is softer. The same "
              "for all rules of a look."),
    SHAPE(slit, .def = 0, .min = 0, .max = 10, .soft_max = 0.3,
          .doc = "How much later the top of the model is exposed than its bottom, seconds, as by a shutter whose slit "
                 "goes up: what moves leans forward."),
    SHAPE(pan, .def = 0, .min = 0, .max = 1, .unit = UNIT_FRACTION, .only_if = "slit>0",
          .doc =
              "How far the camera of motion.slit follows the fastest thing: at 0.5 that leans forward and what rests "
              "leans back, at 1 what rests alone."),
    SHAPE(lag, .def = 0, .min = 0, .max = 10, .soft_max = 0.5,
          .doc = "How late the rear of what moves is, seconds; of what turns about a hinge, or moves on "
                 "the spot, what is far from its middle."),
    SHAPE(drag, .def = 0, .min = 0, .max = 10, .soft_max = 0.5,
          .doc = "How long the trailing side keeps its speed while the rest gets another one, seconds, as cloth in the "
                 "wind: it is pushed against the acceleration, outwards in curves."),
    SHAPE(comb, .def = 0, .min = 0, .max = 10, .soft_max = 0.5,
          .doc =
              "How late the tips of teeth are, seconds, into which the trailing side of what moves is drawn out. They "
              "are as fine as the mesh allows."),
    PARAM_INT_ROW(motion_common, comb_teeth, .def = 6, .min = 1, .max = 200, .soft_max = 30, .unit = UNIT_COUNT,
                  .cpu_only = true, .only_if = "comb>0", .doc = "How many teeth there are."),
};

const kind kind_motion = {
    .id = KIND_MOTION,
    .name = "motion",
    .doc = "How models that move tell so. Needs a time (--time, --frames).",
    .techniques = techniques,
    .technique_count = PARAM_COUNT(techniques),
    .standard = NULL,
    .selector_key = "technique",
    .common = common,
    .common_count = PARAM_COUNT(common),
};
