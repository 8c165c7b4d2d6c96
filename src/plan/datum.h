/* A datum of parts shown as their colour: an attribute that files or programs state about them, as a ramp for numbers,
 * as one colour each for words. Nienhaus 2005, section 4.8 (thematic information mapped to visible attributes); row
 * C10. */
#ifndef LIMNER_PLAN_DATUM_H
#define LIMNER_PLAN_DATUM_H

#include "base/colour.h"
#include "base/warnings.h"
#include "light/light.h"
#include "pose/pose.h"

enum { DATUM_ENTRIES_MAX = 16, DATUM_TEXT_MAX = 64 };

/* What a legend lists: the least and the most of a ramp and what lies evenly between them, or the words. */
typedef struct datum_entry {
    char   text[DATUM_TEXT_MAX];
    colour colour;
    size_t part_count; /* of words and classes: how many have it; of ramps 0 */
} datum_entry;

typedef struct datum {
    colour     *colours; /* per part; alpha 0: its own. NULL: no datum is shown */
    const char *name;    /* of the attribute; lent by the look */
    colour      other;   /* of parts without a value; alpha 0: their own */
    bool        is_ramp;
    datum_entry entries[DATUM_ENTRIES_MAX];
    size_t      entry_count, other_count; /* parts without a value */
    size_t      beyond_count;             /* parts with a value that has no entry; their colour is `other`, too */
} datum;

/* Of the parts that are drawn. Heights ("height", "measuredHeight") that nobody states are those of the parts' tops
 * over the lowest place of all, before a projection bent them. Warns where none of them has the attribute. Errors:
 * LMN_MEMORY, LMN_USAGE (a ramp from more to less). Release it also after one. */
lmn_status datum_make(datum *out, const pose *posed, const scene_values *values, const bool *selected,
                      size_t part_count, warnings *warnings, lmn_error *error);
void       datum_release(datum *d);

#endif
