/* Looks: style sheets that say how parts are drawn. */
#ifndef LIMNER_LOOK_H
#define LIMNER_LOOK_H

#include "limner/error.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_look lmn_look;

/* Loads a look: the name of one that ships (see lmn_look_count) or a path to a JSON file (it contains '/' or ends
 * in .json). End it with lmn_look_destroy. Errors: LMN_USAGE (unknown name; the hint names the nearest), LMN_READ,
 * LMN_FORMAT (with line and column), LMN_MEMORY. */
LMN_API lmn_status lmn_look_load(lmn_look **out, const char *name_or_path, lmn_error *error);

/* Parses a look from JSON text. `name` stands in messages. Errors: LMN_FORMAT, LMN_MEMORY. */
LMN_API lmn_status lmn_look_parse(lmn_look **out, const char *json, const char *name, lmn_error *error);

/* Frees a look and sets the handle to NULL; NULL and a pointer to NULL are accepted. */
LMN_API void lmn_look_destroy(lmn_look **look);

/* Sets one parameter from text: key is "KIND.PARAM", "KIND[i].PARAM" or "RULE:KIND.PARAM"; without RULE all rules are
 * set. A control's name alone ("weight") sets the control. `KIND.technique` exchanges the technique. Errors: LMN_USAGE
 * (unknown key: nearest in the hint; bad value: the message names the range). */
LMN_API lmn_status lmn_look_set(lmn_look *look, const char *key, const char *value, lmn_error *error);

/* The look as JSON, only what differs from the defaults. Free with lmn_text_free. NULL when memory is gone. */
LMN_API char *lmn_look_json(const lmn_look *look);

/* The look's name; borrowed. */
LMN_API const char *lmn_look_name(const lmn_look *look);

/* The looks that ship, sorted by name: how many, and the name of one (NULL when out of range; static). */
LMN_API size_t      lmn_look_count(void);
LMN_API const char *lmn_look_name_at(size_t index);

/* The full reference of a look (NULL: of every kind and technique) as JSON: techniques and their parameters with type,
 * range, unit, default and doc. Free with lmn_text_free. Errors: LMN_USAGE, LMN_FORMAT, LMN_MEMORY. */
LMN_API lmn_status lmn_look_reference_json(char **out, const char *name_or_path, lmn_error *error);

#ifdef __cplusplus
}
#endif
#endif
