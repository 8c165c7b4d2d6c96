/* What an activity may be by itself. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>

#include "base/error.h"
#include "behaviour/map.h"

lmn_status behaviour_refuse(const behaviour_node *n, size_t index, lmn_status status, lmn_error *error,
                            const char *format, ...)
{
    static const char *const kinds[] = {"sequence", "simultaneity", "table", "reverse", "repeat",
                                        "creep",    "constraint",   "clip",  "event"};
    char                     what[320];
    va_list                  arguments;
    va_start(arguments, format);
    vsnprintf(what, sizeof what, format, arguments);
    va_end(arguments);
    if (n->name)
        error_set(error, status, "the %s '%.100s' %s", kinds[n->kind], n->name, what);
    else
        error_set(error, status, "activity %zu, a %s, %s", index + 1, kinds[n->kind], what);
    if (error) {
        error->line = (int)n->line;
        error->column = (int)n->column;
    }
    return status;
}

const char *behaviour_duration_fault(double seconds)
{
    return seconds > 0 && seconds <= BEHAVIOUR_SECONDS_MAX ? NULL : "a duration has to be above 0 s and at most 1e9 s";
}

const char *behaviour_start_fault(double seconds)
{
    return seconds >= 0 && seconds <= BEHAVIOUR_SECONDS_MAX ? NULL
                                                            : "a start must not be below 0 s, and is at most 1e9 s";
}

static const char *clip_fault(const lmn_scene *scene, const struct behaviour *graph, const behaviour_node *n)
{
    if (n->clip < 0 || (size_t)n->clip >= scene->animation_count)
        return "is none of the scene";
    if (n->clip == graph->written)
        return "is what the behaviour itself is written into";
    return n->duration >= 0 || scene->animations[n->clip].duration > 0 ? NULL : "lasts no time";
}

static const char *constraint_fault(const lmn_scene *scene, const behaviour_node *n)
{
    const char *fault = map_fault(scene, n);
    double      own = fault || n->duration >= 0 ? n->duration : map_requirement(&n->map);
    if (!fault && own < 0)
        fault =
            n->map.kind == MAP_BOUNCE && n->map.restitution < 1
                ? "bounces more than hundreds of times: it has to be told its duration, or a restitution of at most "
                  "0.99"
                : "has to be told its duration";
    return !fault && !(own > 0) ? "lasts no time" : fault;
}

static const char *group_fault(const struct behaviour *graph, const behaviour_node *n)
{
    if (n->kind >= BEHAVIOUR_REVERSE && n->child_count != 1)
        return "needs one activity";
    if (n->child_count == 0)
        return "is empty";
    for (size_t i = 0; i < n->child_count; i++) {
        const behaviour_child *c = &n->children[i];
        if (c->node < 0 || (size_t)c->node >= graph->node_count)
            return "has in it what is no activity";
        if (n->kind == BEHAVIOUR_TABLE && (behaviour_start_fault(c->start) || c->duration == 0 || isnan(c->duration) ||
                                           c->duration > BEHAVIOUR_SECONDS_MAX))
            return "has a start or duration that is negative, empty or not finite";
    }
    return NULL;
}

lmn_status behaviour_check(const lmn_scene *scene, const struct behaviour *graph, int32_t index, lmn_error *error)
{
    const behaviour_node *n = &graph->nodes[index];
    const char           *fault = NULL;
    if (isnan(n->duration) || n->duration > BEHAVIOUR_SECONDS_MAX)
        return behaviour_refuse(n, (size_t)index, LMN_FORMAT, error, "lasts %g s, and at most 1e9 are allowed",
                                n->duration);
    if (n->kind == BEHAVIOUR_REPEAT && (n->times < 1 || n->times > BEHAVIOUR_TIMES_MAX))
        return behaviour_refuse(n, (size_t)index, LMN_FORMAT, error, "repeats %u times, and 1 to %d are allowed",
                                (unsigned)n->times, BEHAVIOUR_TIMES_MAX);
    if (n->kind == BEHAVIOUR_CREEP && !(n->exponent >= 1 && n->exponent <= 64))
        return behaviour_refuse(n, (size_t)index, LMN_FORMAT, error, "has the exponent %g, and 1 to 64 are allowed",
                                n->exponent);
    if (n->kind == BEHAVIOUR_EVENT)
        fault = n->duration > 0 ? "has a duration, and events have none" : NULL;
    else if (n->kind == BEHAVIOUR_CLIP)
        fault = clip_fault(scene, graph, n);
    else if (n->kind == BEHAVIOUR_CONSTRAINT)
        fault = constraint_fault(scene, n);
    else
        fault = group_fault(graph, n);
    if (!fault && n->duration == 0)
        fault = "lasts no time";
    return fault ? behaviour_refuse(n, (size_t)index, LMN_FORMAT, error, "%s", fault) : LMN_OK;
}
