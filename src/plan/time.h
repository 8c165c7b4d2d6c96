/* The time that a drawing is of. */
#ifndef LIMNER_PLAN_TIME_H
#define LIMNER_PLAN_TIME_H

#include "limner/draw.h"
#include "look/look.h"
#include "pose/pose.h"

/* The moment that the description asks for: rest, unless it names a clip or a time. Errors: LMN_USAGE. */
lmn_status time_moment(moment *out, const lmn_scene *scene, const lmn_draw_desc *desc, warnings *warnings,
                       lmn_error *error);

/* Do all of the look's rules for motion have one exposure? Errors: LMN_USAGE. */
lmn_status time_check(const lmn_look *look, lmn_error *error);

/* How long the shutter is open: as the look's rules for motion say, which agree; else as the kind does. Seconds. */
double time_exposure(const lmn_look *look);

/* The last rule that selects a part, as a plan shares them; NULL: none does. */
const rule *time_rule(const lmn_look *look, const lmn_scene *scene, size_t part);

/* Says that rules tell of motion where there is none: once, however many they are. */
void time_warn_of_rest(const lmn_look *look, const pose *p, warnings *warnings);

/* Boxes of parts over the whole of their clips, kept from drawing to drawing. Zero-initialise. */
typedef struct swept_boxes {
    uint64_t revision; /* of the scene */
    moment   clips;    /* at 0 */
    box3    *boxes;    /* NULL: none */
} swept_boxes;

/* Makes the pose say that pictures are fitted to the whole of its clips. The boxes are lent to it. Errors: LMN_MEMORY,
 * LMN_CANCELLED. */
lmn_status swept_boxes_fit(swept_boxes *s, pose *p, lmn_error *error);
void       swept_boxes_release(swept_boxes *s);

/* Where a rule exposes one plate several times, makes the pose say that pictures are fitted to its parts at all of
 * these; of parts of other rules, to where they are. The boxes, of which there are none yet, are lent to the pose;
 * without such a rule they stay NULL, and the pose stays. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status plate_boxes_fit(swept_boxes *s, pose *p, const lmn_look *look, lmn_error *error);

#endif
