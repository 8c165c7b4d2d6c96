/* Which ends of lines go together: the cheapest pair of all first, each end once. */
#ifndef LIMNER_STROKE_JOIN_PAIRS_H
#define LIMNER_STROKE_JOIN_PAIRS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Of no group: the end is paired with none. */
#define END_OF_NONE UINT32_MAX

/* Only ends of one group may be a pair. */
typedef struct end_place {
    float    x, y, angle; /* angle: where the line would go on, −π … π; NAN: anywhere */
    uint32_t group;
} end_place;

typedef struct end_search end_search;

/* What pairs are made of. The cost of two ends, a < b, is below 0 where they are no pair. It is no less than
 * gap / reach + 4 (1 − cos ½ turn), the turn being what is missing to opposite angles, and pairs are no farther apart
 * than `reach` and cost less than `most`; but for those that `others` offers itself. */
typedef struct end_rules {
    float reach, most;
    float (*cost)(void *user, uint32_t a, uint32_t b);
    void (*others)(void *user, uint32_t end, end_search *search);
    void *user;
} end_rules;

/* Holds an end against the one that is looked at. */
void end_search_offer(end_search *s, uint32_t other);

/* partners[end]: the other one of its pair, END_OF_NONE where there is none. *compared: how many costs were asked for,
 * which is what the work was. False when memory is gone. */
bool ends_pair(uint32_t *partners, const end_place *places, size_t count, const end_rules *rules, uint64_t *compared);

#endif
