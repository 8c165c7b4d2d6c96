/* Controls: five numbers from -1 to 1 that change a look as people ask for it (heavier, darker, looser). The look file
 * says what each does: maps onto parameters. 0 is the look as its parameters are. */
#ifndef LIMNER_LOOK_CONTROL_H
#define LIMNER_LOOK_CONTROL_H

#include <stdbool.h>
#include <stddef.h>

#include "base/error.h"

enum { CONTROL_COUNT = 5 };

/* One parameter that a control changes: multiplied (`times`, so that the way between is geometric) or moved. */
typedef struct control_map {
    char  *key; /* as lmn_look_set takes it */
    bool   times;
    double low, high; /* the factor, or what is added, at -1 and at 1 */
} control_map;

typedef struct control {
    double       value;
    control_map *maps;
    size_t       map_count; /* 0: the look has no such control */
} control;

typedef struct control_row {
    const char *name, *doc;
} control_row;
extern const control_row control_rows[CONTROL_COUNT];

struct lmn_look;

/* The index of a control's name. Errors: LMN_USAGE with the nearest. */
lmn_status control_find(size_t *out, const char *name, lmn_error *error);

/* Errors: LMN_USAGE (the look does not have it, or the value is out of range). */
lmn_status look_set_control(struct lmn_look *look, size_t index, double value, lmn_error *error);

struct lmn_control_map;
/* Exchanges what a control does. Errors: as lmn_look_set_control_maps. */
lmn_status look_set_control_maps(struct lmn_look *look, size_t index, const struct lmn_control_map *maps, size_t count,
                                 lmn_error *error);

/* Is this key the address of a number? Errors: LMN_USAGE. */
lmn_status control_check_key(const struct lmn_look *look, const char *key, lmn_error *error);

bool look_controls_are_set(const struct lmn_look *look);
bool look_controls_are_alike(const struct lmn_look *a, const struct lmn_look *b);

/* Changes the parameters as the controls ask, within their ranges; "auto" stays. Lengths are in points. */
void look_apply_controls(struct lmn_look *look);

/* False when memory is gone; what was copied is then ended by controls_release. */
bool controls_copy(control out[CONTROL_COUNT], const control from[CONTROL_COUNT]);
void controls_release(control controls[CONTROL_COUNT]);

#endif
