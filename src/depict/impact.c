/* Collisions: a star where the target meets something, with the noise that it makes. Nienhaus 2005, sections 7.6, 7.7,
 * figure 7-7. */
#include "base/error.h"
#include "base/memory.h"
#include "depict/meeting.h"
#include "depict/page.h"

typedef struct impact_values {
    param_words text;
    int32_t     count, spikes;
    float       size;
    bool        all;
    colour      colour, rim, letters;
} impact_values;

static const param impact_params[] = {
    PARAM_TEXT_ROW(impact_values, text, .def_text = "POW", .example = "CRASH",
                   .doc = "The noise that it makes; \"|\" begins a line; empty: none."),
    PARAM_INT_ROW(impact_values, count, .def = 3, .min = 1, .max = 16, .unit = UNIT_COUNT,
                  .doc = "How many are told at most, the strongest ones."),
    PARAM_INT_ROW(impact_values, spikes, .def = 11, .min = 3, .max = 64, .soft_max = 24, .unit = UNIT_COUNT,
                  .doc = "Spikes of the star."),
    PARAM_FLOAT_ROW(impact_values, size, .def = 1.7, .min = 0.01, .max = 100, .soft_max = 4, .unit = UNIT_FRACTION,
                    .doc = "Radius of the strongest one's star, in radii of the target; weaker ones are smaller."),
    PARAM_BOOL_ROW(impact_values, all, .def = 0, .doc = "Those to come too; else those up to now."),
    PARAM_COLOUR_ROW(impact_values, colour, .def_colour = {1, 0.86f, 0.3f, 1}, .doc = "Of the star."),
    PARAM_COLOUR_ROW(impact_values, rim, .def_colour = {0.93f, 0.45f, 0.16f, 1}, .doc = "Around it."),
    PARAM_COLOUR_ROW(impact_values, letters, .def_colour = {0.75f, 0.12f, 0.1f, 1}, .doc = "Of the noise."),
};

enum { IMPACTS_MOST = 16 };

static lmn_status put_impact(depict_job *j, const expression *e, const depict_target *t, const depict_impact *impact,
                             double strongest, uint32_t which, lmn_error *error)
{
    const impact_values *v = e->values;
    double               at[3];
    bool                 met = true;
    lmn_status           status = meeting_place(at, &met, j, t, e->partner, impact, error);
    if (status != LMN_OK || !met)
        return status;
    const double strength = strongest > 0 ? sqrt(vector3_length(impact->change) / strongest) : 1,
                 radius = (double)v->size * t->radius * strength;
    const burst_style style = {radius, v->spikes, false, v->text.text, v->rim, v->colour, v->letters};
    const glyph_tense when = impact->time > e->now ? GLYPH_FUTURE : GLYPH_PAST;
    return glyph_put_burst(j, e, at, depict_front(j, at), which, &style, when, error);
}

/* Of what only bends at most of its keys those where it hits something; all where it never does. */
static lmn_status keep_hits(depict_impact *impacts, size_t *count, const depict_job *j, const depict_target *t,
                            lmn_error *error)
{
    bool       hits[IMPACTS_MOST] = {false};
    size_t     kept = 0;
    int32_t    whom;
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < *count && status == LMN_OK; i++)
        status = meeting_touches(&hits[i], &whom, j, t, &impacts[i], error);
    for (size_t i = 0; i < *count; i++)
        if (hits[i])
            impacts[kept++] = impacts[i];
    *count = kept ? kept : *count;
    return status;
}

static lmn_status impact_depict(depict_job *j, const expression *e, lmn_error *error)
{
    const impact_values *v = e->values;
    depict_impact        impacts[IMPACTS_MOST];
    depict_target        t;
    size_t               count = 0;
    double               strongest = 0;
    lmn_status           status = target_open(&t, j, e->target, error);
    if (status == LMN_OK)
        status = target_hits(impacts, (size_t)v->count, &count, &t, e->from, e->to, error);
    if (status == LMN_OK && e->partner == NONE)
        status = keep_hits(impacts, &count, j, &t, error);
    if (status == LMN_OK)
        depict_say_nothing(j, count ? "it meets nothing up to %g s" : "its velocity nowhere changes at once up to %g s",
                           count && !v->all ? e->now : e->to);
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        strongest = fmax(strongest, vector3_length(impacts[i].change));
    for (size_t i = 0; i < count && status == LMN_OK; i++)
        if (v->all || impacts[i].time <= e->now + 1e-6)
            status = put_impact(j, e, &t, &impacts[i], strongest, (uint32_t)i, error);
    target_release(&t);
    return status;
}

const depiction depiction_collision = {
    "collision",
    NULL,
    "A star where the target's velocity changes at once, at what it touches there (with \"partner\": where both "
    "meet), with the noise that it makes.",
    impact_params,
    PARAM_COUNT(impact_params),
    sizeof(impact_values),
    false,
    impact_depict,
};
