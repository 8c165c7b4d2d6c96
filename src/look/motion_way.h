/* Ways to tell of motion that have a name: a technique with values. What limner/rules.h promises. */
#ifndef LIMNER_LOOK_MOTION_WAY_H
#define LIMNER_LOOK_MOTION_WAY_H

#include "look/look.h"

bool        motion_way_at(size_t index, lmn_motion_way_info *out);
lmn_status  look_set_motion_way(lmn_look *look, const char *name, lmn_error *error);
const char *look_motion_way(const lmn_look *look);

#endif
