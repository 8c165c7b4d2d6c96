/* What is asked for and cannot be drawn is refused; lenient drawings leave it out and warn. */
#ifndef LIMNER_PLAN_REFUSE_H
#define LIMNER_PLAN_REFUSE_H

#include "limner/draw.h"
#include "look/look.h"
#include "scene/scene.h"

/* The first file that the scene was read from; NULL: none. For messages. */
const char *refuse_file(const lmn_scene *scene);

/* Names the file in an error that names none and whose cause is the model. */
void refuse_in_file(lmn_error *error, const lmn_scene *scene);

/* Where a drawing's refusals go. */
typedef struct refusal {
    const lmn_scene *scene;
    bool             lenient;
    warnings        *warnings;
    lmn_error       *error;
} refusal;

/* Warns and returns LMN_OK in lenient drawings; else the status, with what to do instead (NULL: nothing but being
 * lenient). */
lmn_status refuse(const refusal *r, lmn_status status, warning_code code, const char *instead, const char *format, ...)
    __attribute__((format(printf, 5, 6)));

/* A time other than 0 that changes nothing. `moves`: the look's own changes are drawn (not in vectors). */
lmn_status refuse_time(const refusal *r, const lmn_look *look, double time_s, bool moves);

#endif
