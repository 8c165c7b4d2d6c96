/* Looks by calls: rules, techniques and single parameters. What limner/rules.h promises, behind its checks for NULL. */
#ifndef LIMNER_LOOK_LOOK_EDIT_H
#define LIMNER_LOOK_LOOK_EDIT_H

#include "look/look.h"

/* The techniques of a kind in a rule, or with LMN_WHOLE_LOOK in the look. */
typedef struct use_list {
    const kind    *kind;
    rule          *rule; /* NULL: the whole look */
    technique_use *uses;
    size_t         count;
} use_list;

/* Errors: LMN_USAGE. The list is as constant as the look is. */
lmn_status look_find_uses(use_list *out, const lmn_look *look, size_t rule_index, const char *kind_name,
                          lmn_error *error);

/* One parameter of one technique; `param` NULL: key was NULL. */
typedef struct param_place {
    const kind    *kind;
    technique_use *use;
    const param   *param;
} param_place;
lmn_status look_find_param(param_place *out, const lmn_look *look, size_t rule_index, const char *kind_name,
                           size_t index, const char *key, lmn_error *error);

/* Calls `visit` with each of the look's parameters that a key ("lines.width", as look_set takes it) means. A key that
 * means none is none. */
typedef void (*param_visitor)(const param *p, void *values, void *user);
void look_visit_params(lmn_look *look, const char *key, param_visitor visit, void *user);

/* The row of the parameter that a key means: the look's, or else the first technique's of the kind that has one.
 * Errors: LMN_USAGE. */
lmn_status look_param_of_key(const param **out, const lmn_look *look, const char *key, lmn_error *error);

/* Gives a parameter the value that this text says, or its default (NULL; of all parameters where `param` is NULL). The
 * error names its kind. */
lmn_status look_change_param(lmn_look *look, const param_place *place, const char *value, lmn_error *error);

/* Error messages of rows begin with their key: puts the kind before it. Returns the error's status. */
lmn_status error_name_kind(const kind *k, lmn_status status, lmn_error *error);

lmn_status look_add_rule(lmn_look *look, const char *selector, size_t before, size_t *index, lmn_error *error);
lmn_status look_remove_rule(lmn_look *look, size_t index, lmn_error *error);
lmn_status look_move_rule(lmn_look *look, size_t index, size_t to, lmn_error *error);
lmn_status look_select(lmn_look *look, size_t index, const char *selector, lmn_error *error);
/* Exchanges one of the look's own texts; NULL: none. */
lmn_status look_set_words(lmn_look *look, char **words, const char *value, lmn_error *error);
lmn_status look_check_rule(const lmn_look *look, size_t index, lmn_error *error);

lmn_status look_set_technique(lmn_look *look, const use_list *uses, size_t index, const char *name, lmn_error *error);
lmn_status look_add_technique(lmn_look *look, const use_list *uses, const char *name, size_t before, lmn_error *error);
lmn_status look_remove_technique(lmn_look *look, const use_list *uses, size_t index, lmn_error *error);
lmn_status look_move_technique(lmn_look *look, const use_list *uses, size_t index, size_t to, lmn_error *error);

#endif
