/* A look in memory: rules that give sets of parts their techniques. */
#ifndef LIMNER_LOOK_LOOK_H
#define LIMNER_LOOK_LOOK_H

#include "limner/look.h"
#include "look/selector.h"
#include "technique/technique.h"

typedef struct rule {
    char          *name;   /* may be NULL */
    char          *select; /* as written */
    selector      *selector;
    technique_use *uses[KIND_COUNT]; /* empty for look-wide kinds */
    size_t         use_counts[KIND_COUNT];
} rule;

struct lmn_look {
    char         *name, *doc;
    technique_use wide[KIND_COUNT]; /* technique NULL for kinds that are not look-wide */
    rule         *rules;
    size_t        rule_count;
};

/* All kinds in drawing order, KIND_COUNT of them, index = kind_id. */
extern const kind *const kinds[KIND_COUNT];

/* The parameter with this key of a technique of a kind (its own or a common one); NULL when there is none. */
const param *kind_find_param(const kind *k, const technique *t, const char *key);
const technique *kind_find_technique(const kind *k, const char *name);

#endif
