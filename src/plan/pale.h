/* Ghost images of what was and will be are paler than what is, by any look: a rule that does not speak of signs gets
 * paler ones beside it, of which each draws the images of one age. */
#ifndef LIMNER_PLAN_PALE_H
#define LIMNER_PLAN_PALE_H

#include "look/look.h"
#include "scene/scene.h"

/* Adds them to a look that belongs to a plan, behind its own rules. False: out of memory. */
bool pale_add_rules(lmn_look *look, const lmn_scene *scene);
/* The rule that draws a part of this paleness (eighths) instead of the look's own `index`, or that itself. */
size_t pale_find_rule(const lmn_look *look, size_t index, int paleness);

#endif
