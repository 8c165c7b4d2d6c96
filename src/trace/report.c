/* Traces in reports and warnings. */
#include "trace/trace.h"

json_t *trace_facts_json(const trace_facts *facts)
{
    const trace_measures *m = &facts->measures;
    json_t *out = json_pack("{s:I, s:I, s:f, s:f, s:I, s:f, s:f, s:f, s:f}", "bodies", (json_int_t)facts->bodies,
                            "contours", (json_int_t)facts->contours, "A1", m->extent, "A2", m->salient, "A3",
                            (json_int_t)m->lines, "A4", m->uneven, "A5", m->crowded, "A6", m->inside, "A7", m->length);
    if (facts->telling.count)
        json_object_set_new(out, "moments", telling_json(&facts->telling));
    return out;
}

void trace_warn(const trace_facts *facts, warnings *warnings)
{
    if (facts->bodies == 0 && facts->shaking == 0 && facts->leaps == 0)
        warnings_add(warnings, WARNING_UNUSED,
                     "motion 'traces': nothing moves on the page at this time, so nothing is drawn; --time and "
                     "motion.exposure say when and for how long");
    if (facts->shakes_wanted && !facts->shaking)
        warnings_add(warnings, WARNING_UNUSED,
                     "motion.vibration: nothing swings to and fro on the page within motion.exposure");
    if (facts->towards)
        warnings_add(warnings, WARNING_APPROXIMATE,
                     "motion 'traces': %zu things come nearer or go away: their lines are rays", facts->towards);
    telling_warn(&facts->telling, warnings);
    if (facts->bones_missing)
        warnings_add(warnings, WARNING_NO_MATCH,
                     "motion 'traces': nothing that moves has bones that motion.bones names");
    if (facts->lines_missing)
        warnings_add(
            warnings, WARNING_UNUSED,
            "motion 'traces': no speed line is seen: all would lie on what moves or behind something, or be too short");
    if (facts->leaps)
        warnings_add(warnings, WARNING_APPROXIMATE,
                     "motion 'traces': %zu things jump from one place to another at this time and have no lines",
                     facts->leaps);
    if (facts->jumps)
        warnings_add(warnings, WARNING_APPROXIMATE,
                     "motion 'traces': %zu lines end where something jumps from one place to another", facts->jumps);
}
