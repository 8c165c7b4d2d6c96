#include "plan/pale.h"

#include <string.h>

#include "base/memory.h"
#include "compose/compose.h"
#include "lines/lines.h"
#include "plan/paper_look.h"

/* A rule that selects by [glyph] knows itself how ghost images look. */
static bool speaks_of_signs(const rule *r)
{
    return r->select && strstr(r->select, "[" NODE_GLYPH);
}

/* Thinner lines; what a composition shades again goes straight onto the page, so that it is composed as usual. */
static bool make_paler(rule *r, float pale)
{
    const double thinner = 0.4;
    r->pale = pale;
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        ((lines_common *)r->uses[KIND_LINES][i].values)->width *= (float)(1 - thinner * (double)pale);
    technique_use *compose = r->use_counts[KIND_COMPOSE] ? &r->uses[KIND_COMPOSE][0] : NULL, usual;
    for (size_t i = 0; compose && i < compose->technique->pass_count; i++)
        if (compose->technique->passes[i].geometry) {
            if (!use_create(&usual, kinds[KIND_COMPOSE], kinds[KIND_COMPOSE]->standard))
                return false;
            use_release(compose);
            *compose = usual;
            break;
        }
    return true;
}

bool pale_add_rules(lmn_look *look, const lmn_scene *scene)
{
    bool         there[PALE_MOST + 1] = {false};
    const size_t own = look->rule_count;
    size_t       kinds_of = 0;
    for (size_t i = 0; i < scene->part_count; i++)
        there[node_paleness(&scene->nodes[scene->parts[i].node])] = true;
    for (int k = 1; k <= PALE_MOST; k++)
        kinds_of += there[k];
    rule *grown = kinds_of ? mem_realloc(look->rules, own * (kinds_of + 1) * sizeof *grown) : look->rules;
    if (!grown)
        return false;
    look->rules = grown;
    for (int k = 1; k <= PALE_MOST; k++)
        for (size_t i = 0; i < own && there[k]; i++) {
            if (speaks_of_signs(&look->rules[i]))
                continue;
            rule *r = &look->rules[look->rule_count++];
            if (!paper_rule_create(r, &look->rules[i]) || !make_paler(r, (float)k / PALE_MOST))
                return false;
            r->paler_of = i;
        }
    return true;
}

size_t pale_find_rule(const lmn_look *look, size_t index, int paleness)
{
    for (size_t i = index + 1; i < look->rule_count && paleness; i++)
        if (look->rules[i].paler_of == index && look->rules[i].pale * PALE_MOST == (float)paleness)
            return i;
    return index;
}
