/* Techniques from outside of the library: rows and a shader text, made into what tables of the library hold. */
#ifndef LIMNER_LOOK_TECHNIQUE_SET_H
#define LIMNER_LOOK_TECHNIQUE_SET_H

#include "limner/techniques.h"
#include "technique/technique.h"

/* Counted: the handle and each look with it hold it. */
lmn_status techniques_create(lmn_techniques **out, lmn_error *error);
/* NULL is accepted, and given back. */
lmn_techniques *techniques_hold(lmn_techniques *set);
void            techniques_release(lmn_techniques *set);

/* `desc` and `rows`, param_count of them, are whole. */
lmn_status techniques_add(lmn_techniques *set, const lmn_technique_desc *desc, const lmn_param_desc *rows,
                          lmn_error *error);

/* Those of a kind, of which the set may be NULL: how many, and one of them. */
size_t           techniques_count(const lmn_techniques *set, const kind *k);
const technique *techniques_at(const lmn_techniques *set, const kind *k, size_t index);
/* The technique of this name among the kind's and the set's. */
const technique *techniques_find(const lmn_techniques *set, const kind *k, const char *name);

#endif
