/* What reports say of what was drawn, however it was drawn. */
#ifndef LIMNER_PLAN_FACTS_H
#define LIMNER_PLAN_FACTS_H

#include <jansson.h>

#include "look/look.h"
#include "pose/pose.h"

typedef struct report_facts {
    char    *look;
    uint32_t seed;
    size_t   part_count;
    char   **part_names;
    uint64_t triangles; /* instances counted */
    box3     bounds;    /* of what is selected */
    double   load_ms;
    json_t  *time;
    json_t  *city; /* which; NULL: at rest */
} report_facts;

/* The bounds and triangles are the caller's to set. Errors: LMN_MEMORY. Release it also after one. */
lmn_status facts_take(report_facts *out, const pose *pose, const lmn_look *look, size_t part_count, uint32_t seed,
                      lmn_error *error);
void       facts_release(report_facts *f);

/* The first entries of a report: program, look, size, seed. */
json_t *facts_begin_json(const report_facts *f, int width, int height);
/* "scene": parts, triangles and bounds. */
json_t *facts_scene_json(const report_facts *f);

#endif
