/* What a look cuts away. */
#ifndef LIMNER_PLAN_SECTION_H
#define LIMNER_PLAN_SECTION_H

#include "look/look.h"
#include "pose/pose.h"
#include "cut/cut.h"

/* What is cut away, and which parts stay whole all the same. */
typedef struct section {
    cut   cut;    /* no cells: nothing is */
    bool *spared; /* per part and ghost; NULL: none. Owned. */
} section;

/* Percentages of a cut count along the bounds of what is selected (NULL: all). Errors: LMN_USAGE, LMN_MEMORY.
 * Release it also after one. */
lmn_status section_find(section *out, const pose *pose, const lmn_look *look, const char *select, lmn_error *error);
/* The same with another cut than the look's, in the words of scene.cut. */
lmn_status section_find_cut(section *out, const char *text, const pose *pose, const lmn_look *look, const char *select,
                            lmn_error *error);
/* Sets which parts stay whole, by a selector. Errors: LMN_USAGE, LMN_MEMORY. */
lmn_status section_spare(section *s, const lmn_scene *scene, const char *selector, lmn_error *error);
void       section_release(section *s);
/* Of a scene with so many parts and ghosts; false when memory is gone. */
bool section_copy(section *out, const section *from, size_t part_count);
/* Of the same scene. */
bool section_equal(const section *a, const section *b, size_t part_count);

#endif
