#include "plan/refuse.h"

#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "base/error.h"

const char *refuse_file(const lmn_scene *scene)
{
    return scene->file_count ? scene->files[0] : NULL;
}

void refuse_in_file(lmn_error *error, const lmn_scene *scene)
{
    const char *file = refuse_file(scene);
    bool        model =
        error && (error->status == LMN_FORMAT || error->status == LMN_LIMIT || error->status == LMN_UNSUPPORTED);
    if (model && file && !error->file[0])
        snprintf(error->file, sizeof error->file, "%s", file);
}

lmn_status refuse(const refusal *r, lmn_status status, warning_code code, const char *instead, const char *format, ...)
{
    char    text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (r->lenient) {
        if (r->warnings)
            warnings_add(r->warnings, code, "%s", text);
        return LMN_OK;
    }
    error_in_file(r->error, status, refuse_file(r->scene), 0, "%s", text);
    error_hint(r->error, "%s%s--lenient draws what can be drawn", instead ? instead : "", instead ? "; " : "");
    return status;
}

/* --- time ----------------------------------------------------------------------------------------------- */

static bool use_moves(kind_id id, const technique_use *use)
{
    for (size_t i = 0; i < kind_param_count(kinds[id], use->technique); i++) {
        const param *p = kind_param_at(kinds[id], use->technique, i);
        float        rate = 0;
        if (!p->a_second)
            continue;
        memcpy(&rate, param_field(p, use->values), sizeof rate);
        if (rate > 0)
            return true;
    }
    return false;
}

static bool look_moves(const lmn_look *look)
{
    for (size_t i = 0; i < look->rule_count; i++)
        for (int k = 0; k < KIND_COUNT; k++)
            for (size_t u = 0; u < look->rules[i].use_counts[k]; u++)
                if (use_moves((kind_id)k, &look->rules[i].uses[k][u]))
                    return true;
    return false;
}

lmn_status refuse_time(const refusal *r, const lmn_look *look, double time_s, bool moves)
{
    if (time_s == 0)
        return LMN_OK;
    if (r->scene->animation_count || (moves && look_moves(look)))
        return LMN_OK;
    return refuse(r, LMN_USAGE, WARNING_UNUSED,
                  moves ? "leave the time out, or take a look that changes with it (perturb.boil, surface.change)"
                        : "leave the time out",
                  "the model has no animation: it is drawn the same at any time");
}
