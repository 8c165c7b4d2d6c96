/* All kinds, in the order in which a figure goes through them. */
#include "compose/compose.h"
#include "finish/finish.h"
#include "layer/layer.h"
#include "light/light.h"
#include "lines/lines.h"
#include "look/look.h"
#include "motion/motion.h"
#include "perturb/perturb.h"
#include "surface/surface.h"

const kind *const kinds[KIND_COUNT] = {
    [KIND_SCENE] = &kind_scene,     [KIND_LAYERS] = &kind_layers,   [KIND_LINES] = &kind_lines,
    [KIND_SURFACE] = &kind_surface, [KIND_PERTURB] = &kind_perturb, [KIND_COMPOSE] = &kind_compose,
    [KIND_MOTION] = &kind_motion,   [KIND_FINISH] = &kind_finish,
};
