#include "look/motion_way.h"

#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "look/look_change.h"
#include "look/look_edit.h"
#include "motion/motion.h"

enum { SETS = 5 };

typedef struct motion_set {
    const char *key, *value;
} motion_set;

typedef struct motion_way {
    const char *name, *doc, *technique;
    bool        poses; /* its pictures or contours can be those of telling moments */
    motion_set  sets[SETS + 1];
} motion_way;

static const motion_way ways[] = {
    {"speed-lines", "lines behind what moves", "traces", true, {{"exposure", "0.3"}}},
    {"ghosts", "contours where it has been", "traces", true, {{"exposure", "0.5"}, {"lines", "0"}, {"contours", "5"}}},
    {"echoes",
     "their trailing side",
     "traces",
     true,
     {{"exposure", "0.5"}, {"lines", "0"}, {"contours", "8"}, {"trailing", "true"}}},
    {"comic", "lines and contours", "traces", true, {{"exposure", "0.3"}, {"contours", "2"}, {"ends", "wedges"}}},
    {"manga",
     "many lines, also ahead to one point",
     "traces",
     true,
     {{"exposure", "0.3"}, {"lines", "48"}, {"ends", "wedges"}, {"flow", "70"}, {"flow_way", "converging"}}},
    {"plate",
     "the model at six times on one plate",
     "accumulate",
     true,
     {{"exposure", "1"}, {"times", "6"}, {"weights", "plate"}, {"decay", "0.8"}}},
    {"chrono",
     "at eight times, older ones fainter",
     "accumulate",
     true,
     {{"exposure", "1"}, {"times", "8"}, {"weights", "plate"}, {"decay", "0.85"}}},
    {"vibration", "arcs beside what shakes", "traces", true, {{"exposure", "0.5"}, {"lines", "0"}, {"vibration", "3"}}},
    {"squash",
     "stretched along its way and flattened where it is stopped",
     "deform",
     false,
     {{"stretch", "0.5"}, {"squash", "0.5"}}},
    {"slit", "as by a slit shutter", "deform", false, {{"slit", "0.1"}, {"pan", "0.5"}}},
    {"lean",
     "leaning forward by its speed, back by its acceleration",
     "deform",
     false,
     {{"lean", "25"}, {"inertia", "20"}}},
};
static const size_t way_count = sizeof ways / sizeof *ways;

bool motion_way_at(size_t index, lmn_motion_way_info *out)
{
    if (index >= way_count || !out)
        return false;
    *out = (lmn_motion_way_info){ways[index].name, ways[index].doc, ways[index].technique, ways[index].poses};
    return true;
}

static const motion_way *way_named(const char *name)
{
    for (size_t i = 0; i < way_count; i++)
        if (strcmp(ways[i].name, name) == 0)
            return &ways[i];
    return NULL;
}

static lmn_status set(lmn_look *look, const char *key, const char *value, lmn_error *error)
{
    char whole[64];
    snprintf(whole, sizeof whole, "%s.%s", kind_motion.name, key);
    return look_set(look, whole, value, error);
}

/* What other ways with this technique set gets its default, so that ways can be exchanged for each other. */
static lmn_status reset_others(lmn_look *look, const motion_way *way, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < way_count; i++)
        for (const motion_set *s = ways[i].sets; s->key && strcmp(ways[i].technique, way->technique) == 0; s++)
            for (size_t r = 0; r < look->rule_count && status == LMN_OK; r++) {
                param_place place;
                if (!look->rules[r].use_counts[KIND_MOTION])
                    continue;
                status = look_find_param(&place, look, r, kind_motion.name, 0, s->key, error);
                if (status == LMN_OK)
                    status = look_change_param(look, &place, NULL, error);
            }
    return status;
}

static lmn_status set_way(lmn_look *look, const char *name, lmn_error *error)
{
    const motion_way *way = way_named(name);
    lmn_status        status = set(look, "technique", way ? way->technique : name, error);
    if (status == LMN_OK && way)
        status = reset_others(look, way, error);
    for (const motion_set *s = way ? way->sets : NULL; s && s->key && status == LMN_OK; s++)
        status = set(look, s->key, s->value, error);
    return status;
}

lmn_status look_set_motion_way(lmn_look *look, const char *name, lmn_error *error)
{
    lmn_look  *before;
    lmn_status status = look_edit_begin(&before, look, error);
    return status == LMN_OK ? look_edit_end(look, &before, set_way(look, name, error)) : status;
}

/* Of several that fit, the one that says most. How long the exposure is makes no other way. */
const char *look_motion_way(const lmn_look *look)
{
    const technique_use *use = NULL;
    const char          *found = NULL;
    size_t               most = 0;
    for (size_t r = 0; r < look->rule_count && !use; r++)
        use = look->rules[r].use_counts[KIND_MOTION] ? look->rules[r].uses[KIND_MOTION] : NULL;
    for (size_t i = 0; i < way_count && use; i++) {
        bool   fits = strcmp(ways[i].technique, use->technique->name) == 0;
        size_t count = 1;
        for (const motion_set *s = ways[i].sets; s->key && fits; s++) {
            char         own[LMN_VALUE_TEXT_MAX];
            const param *p = kind_find_param(&kind_motion, use->technique, s->key);
            if (p)
                param_print(p, use->values, own, sizeof own);
            fits = strcmp(s->key, "exposure") == 0 || (p && strcmp(own, s->value) == 0);
            count += fits;
        }
        if (fits && count > most) {
            found = ways[i].name;
            most = count;
        }
    }
    return found;
}
