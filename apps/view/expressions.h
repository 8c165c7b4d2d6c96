/* What is told of a scene by signs: a list of expressions (docs/DEPICTION.md) as JSON text. A list never changes once
 * it is there; states share it (g_ref_string_…). NULL is a list, too: nobody tells anything. No window. */
#ifndef LIMNER_VIEW_EXPRESSIONS_H
#define LIMNER_VIEW_EXPRESSIONS_H

#include <glib.h>

#include "limner/limner.h"

/* Those that a script has, and the time of its still, seconds; below 0: it says none. NULL: no script, or none in it.
 */
char *expressions_of_file(const char *path, double *time_s);
/* Is a file a script? */
bool expressions_is_script(const char *path);
/* Those in what lmn_depict says; at the time that is shown, whichever that is. */
char *expressions_told(const char *json);

guint expressions_count(const char *list);
/* A member of an expression as text ("0.5", "true", "#102030"); NULL: it has none. g_free. */
char *expressions_get(const char *list, guint index, const char *key);

/* The same of a list that is read once, for who asks much. */
typedef struct json_t expressions_read;
expressions_read     *expressions_open(const char *list);
char                 *expressions_member(const expressions_read *r, guint index, const char *key);
void                  expressions_close(expressions_read *r);

/* Other lists, the caller's. A member is set from text, of the type that it has in expressions; NULL takes it out. NULL
 * with an error when the text is no such value. */
char *expressions_set(const char *list, guint index, const char *key, lmn_param_type type, const char *value,
                      lmn_error *error);
char *expressions_added(const char *list, const char *target, const char *depict);
char *expressions_removed(const char *list, guint index);

/* The index of the way to depict that an expression names; false: there is none of that name. */
bool expressions_depiction(const char *list, guint index, size_t *out);

/* Into a script, whose other bytes stay as they are (all of them, where it has these), or a file that has these alone.
 */
bool expressions_save(const char *list, const char *path, lmn_error *error);

#endif
