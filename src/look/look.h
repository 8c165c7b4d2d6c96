/* A look in memory: rules that give sets of parts their techniques. */
#ifndef LIMNER_LOOK_LOOK_H
#define LIMNER_LOOK_LOOK_H

#include "limner/look.h"
#include "limner/rules.h"
#include "look/control.h"
#include "look/selector.h"
#include "look/technique_set.h"
#include "technique/technique.h"

typedef struct rule {
    char          *name;   /* may be NULL */
    char          *select; /* as written */
    selector      *selector;
    technique_use *uses[KIND_COUNT]; /* empty for look-wide kinds */
    size_t         use_counts[KIND_COUNT];
    float          pale; /* 0 of a look's own rules; of what a plan adds for ghost images: how much of it is paper */
    size_t         paler_of; /* and the rule that would draw them */
} rule;

enum { LOOK_CHANGE_BITS = 5, LOOK_CHANGE_ALL = (1 << LOOK_CHANGE_BITS) - 1 };

struct lmn_look {
    char           *name, *doc;
    technique_use   wide[KIND_COUNT]; /* technique NULL for kinds that are not look-wide */
    rule           *rules;
    size_t          rule_count;
    control         controls[CONTROL_COUNT];
    lmn_techniques *techniques; /* held; NULL: none but the library's */
    uint64_t        revision;   /* changes whenever the content does; no two looks of a process share one */
    uint64_t        changed[LOOK_CHANGE_BITS]; /* the revision at which each of lmn_look_change was last so */
};

/* All kinds in drawing order, KIND_COUNT of them, index = kind_id. */
extern const kind *const kinds[KIND_COUNT];

/* The parameter with this key (or the key it had before) of a technique of a kind, its own or a common one; NULL
 * when there is none. */
const param     *kind_find_param(const kind *k, const technique *t, const char *key);
const technique *kind_find_technique(const kind *k, const char *name);
const kind      *kind_find(const char *name);
/* LMN_USAGE with the nearest name; `key` (may be NULL) makes the hint "KIND.KEY". */
lmn_status kind_unknown(const char *name, const char *key, lmn_error *error);

/* Are this kind's uses optional, so that "none" may be said? */
bool kind_may_be_none(const kind *k);

/* All parameters of a technique, common ones first; index < kind_param_count. */
size_t       kind_param_count(const kind *k, const technique *t);
const param *kind_param_at(const kind *k, const technique *t, size_t index);

/* Errors with a helpful text, all LMN_USAGE: a technique, of the kind or the set, or a parameter that does not exist.
 * The latter names the techniques of the kind that have it. */
lmn_status kind_unknown_technique(const kind *k, const lmn_techniques *set, const char *name, lmn_error *error);
lmn_status kind_missing_param(const kind *k, const technique *t, const char *key, lmn_error *error);
/* Hints at the names of the kind's techniques. */
void kind_hint_techniques(const kind *k, const lmn_techniques *set, lmn_error *error);

/* Makes a use with default values; false when memory is gone. */
bool use_create(technique_use *out, const kind *k, const technique *t);
void use_release(technique_use *use);
bool use_copy(technique_use *out, const kind *k, const technique_use *from);
/* Another technique; values that both have in common stay. False when memory is gone; then nothing changed. */
bool use_exchange(technique_use *use, const kind *k, const technique *t);

/* Gives a new rule the standard techniques of the kinds that it has none of yet. Errors: LMN_MEMORY. */
lmn_status rule_add_standards(rule *r, lmn_error *error);
void       rule_release(rule *r);

enum { LOOK_VERSION = 2 }; /* src/look/look_version.c reads older ones */

/* See limner/look.h; these are what the public functions forward to. */
lmn_status  look_load(lmn_look **out, const char *name_or_path, lmn_techniques *set, lmn_error *error);
lmn_status  look_parse(lmn_look **out, const char *json, size_t size, const char *name, lmn_techniques *set,
                       lmn_error *error);
lmn_status  look_create(lmn_look **out, lmn_techniques *set, lmn_error *error); /* of one rule for all parts */
void        look_destroy(lmn_look **look);
lmn_status  look_copy(lmn_look **out, const lmn_look *look, lmn_error *error);
lmn_status  look_set(lmn_look *look, const char *key, const char *value, lmn_error *error);
char       *look_json(const lmn_look *look);
const char *look_name_at(size_t index);
lmn_status  look_reference_json(char **out, const char *name_or_path, lmn_error *error);

#endif
