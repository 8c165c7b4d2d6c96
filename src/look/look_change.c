#include "look/look_change.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "light/light.h"
#include "lines/lines.h"
#include "lines/stroke/strokes.h"
#include "scene/scene.h"

/* --- revisions ------------------------------------------------------------------------------------------ */

/* Scenes and looks share one clock: all that must hold is that no number comes twice. */
void look_mark_changed(lmn_look *look, unsigned changes)
{
    if (!changes)
        return;
    look->revision = scene_next_revision();
    for (int bit = 0; bit < LOOK_CHANGE_BITS; bit++)
        if (changes & (1u << bit))
            look->changed[bit] = look->revision;
}

unsigned look_changes(const lmn_look *look, uint64_t since)
{
    unsigned changes = 0;
    for (int bit = 0; bit < LOOK_CHANGE_BITS; bit++)
        changes |= look->changed[bit] > since ? 1u << bit : 0;
    return changes;
}

/* --- values --------------------------------------------------------------------------------------------- */

static bool same_field(const param *p, const void *a, const void *b)
{
    return memcmp(param_field(p, a), param_field(p, b), param_size(p->type)) == 0;
}

static bool same_text(const char *a, const char *b)
{
    return !a || !b ? a == b : strcmp(a, b) == 0;
}

/* Numbers that something is left out for: "auto", and for some 0. */
static int class_of_number(float value, bool left_out_at_0)
{
    return isnan(value) ? 2 : left_out_at_0 && value != 0;
}

static int class_of_colour(colour c)
{
    return isnan(c.r) ? 3 : c.a <= 0 ? 0 : c.a < 1 ? 1 : 2;
}

bool param_compiles(const param *p)
{
    return p->variant || p->toggles || p->type == PARAM_ENUM || p->type == PARAM_BOOL ||
           (p->type == PARAM_TEXT && !p->is_selector);
}

/* Does a change from one to the other mean other work, not only other numbers? What C code makes of values cannot be
 * told from a row: whatever looks like a switch is one. */
static bool switches(const kind *k, const param *p, const void *a, const void *b)
{
    bool        left_out = p->toggles || p->cpu_only || k->id == KIND_SCENE; /* where it is 0 */
    const void *one = param_field(p, a), *other = param_field(p, b);
    if (same_field(p, a, b))
        return false;
    if (param_compiles(p) && p->type != PARAM_FLOAT)
        return true;
    switch (p->type) {
    case PARAM_INT: return !*(const int32_t *)one != !*(const int32_t *)other;
    case PARAM_FLOAT:
        return class_of_number(*(const float *)one, left_out) != class_of_number(*(const float *)other, left_out);
    case PARAM_COLOUR: return class_of_colour(*(const colour *)one) != class_of_colour(*(const colour *)other);
    case PARAM_DIRECTION: return param_is_auto(p, a) != param_is_auto(p, b);
    case PARAM_TEXT: return true;
    case PARAM_ENUM:
    case PARAM_BOOL:
    case PARAM_PALETTE: return false;
    }
    return true;
}

/* Conditions that compare with other numbers than 0. Both tables are asked: a condition is on either. */
static bool condition_differs(const char *condition, const kind *k, const technique *t, const void *a, const void *b)
{
    return params_condition(condition, t->params, t->param_count, a) !=
               params_condition(condition, t->params, t->param_count, b) ||
           params_condition(condition, k->common, k->common_count, a) !=
               params_condition(condition, k->common, k->common_count, b);
}

/* Does the condition compare a length that is different? What it is compared with are pixels of a drawing. */
static bool compares_length(const char *condition, const param *p)
{
    size_t length = strlen(p->key);
    for (const char *at = condition; p->unit == UNIT_PT && at && *at; at += strcspn(at, "&"), at += *at == '&') {
        const char *key = at + (*at == '!');
        if (strncmp(key, p->key, length) == 0 && (key[length] == '>' || key[length] == '<'))
            return true;
    }
    return false;
}

static bool length_decides(const char *condition, const kind *k, const technique *t, const void *a, const void *b)
{
    for (size_t i = 0; i < kind_param_count(k, t); i++) {
        const param *p = kind_param_at(k, t, i);
        if (compares_length(condition, p) && !same_field(p, a, b))
            return true;
    }
    return false;
}

static bool conditions_differ(const kind *k, const technique *t, const void *a, const void *b)
{
    for (size_t i = 0; i < t->pass_count; i++)
        if (condition_differs(t->passes[i].when, k, t, a, b) || length_decides(t->passes[i].when, k, t, a, b))
            return true;
    if (t->surface && (condition_differs(t->surface->light_map_when, k, t, a, b) ||
                       condition_differs(t->surface->forward_when, k, t, a, b) ||
                       condition_differs(t->surface->deferred_when, k, t, a, b)))
        return true;
    if (t->compose && condition_differs(t->compose->map_when, k, t, a, b))
        return true;
    const kind *compose = kinds[KIND_COMPOSE];
    for (size_t i = 0; k->id == KIND_LINES && i < compose->technique_count; i++)
        if (condition_differs(compose->techniques[i]->compose->merges_when, k, t, a, b))
            return true;
    return t->perturbs && t->perturbs->active && t->perturbs->active(a) != t->perturbs->active(b);
}

static bool motion_differs(const motion_row *m, const void *a, const void *b)
{
    return (m->times && m->times(a) != m->times(b)) || (m->steps && m->steps(a) != m->steps(b)) ||
           (m->moved && m->moved(a) != m->moved(b));
}

/* --- what is made from values --------------------------------------------------------------------------- */

typedef void (*describe_fn)(text *out, const void *values);

static bool described_alike(describe_fn describe, const void *a, const void *b)
{
    text one = {0}, other = {0};
    describe(&one, a);
    describe(&other, b);
    bool alike = !one.failed && !other.failed && one.size == other.size &&
                 (one.size == 0 || memcmp(one.data, other.data, one.size) == 0);
    text_release(&one);
    text_release(&other);
    return alike;
}

static unsigned made_differently(const technique *t, const void *a, const void *b)
{
    unsigned changes = 0;
    for (size_t i = 0; i < t->texture_count; i++) {
        const texture_source *source = &t->textures[i];
        bool                  now = params_condition(source->when, t->params, t->param_count, b);
        if (now != params_condition(source->when, t->params, t->param_count, a))
            changes |= LMN_CHANGE_TEXTURES | LMN_CHANGE_PROGRAMS;
        else if (now && !described_alike(source->describe, a, b))
            changes |= LMN_CHANGE_TEXTURES;
    }
    if (t->surface && t->surface->marks && !described_alike(t->surface->marks->describe, a, b))
        changes |= LMN_CHANGE_MESHES;
    return changes;
}

/* Files are read to describe what is in them: they are left out here, where a change of their names says it all. */
static unsigned made_changes(const kind *k, const technique_use *before, const technique_use *after)
{
    const technique *t = after->technique;
    technique_use    a, b;
    if (!t->texture_count && !(t->surface && t->surface->marks))
        return 0;
    bool     whole = use_copy(&a, k, before);
    bool     both = use_copy(&b, k, after) && whole;
    unsigned changes = both ? 0 : LOOK_CHANGE_ALL;
    for (size_t i = 0; both && i < kind_param_count(k, t); i++) {
        const param *p = kind_param_at(k, t, i);
        if (!p->is_file)
            continue;
        if (!same_field(p, a.values, b.values))
            changes |= LMN_CHANGE_TEXTURES | LMN_CHANGE_PROGRAMS | LMN_CHANGE_MESHES;
        params_set_defaults(p, 1, a.values);
        params_set_defaults(p, 1, b.values);
    }
    if (both)
        changes |= made_differently(t, a.values, b.values);
    use_release(&a);
    use_release(&b);
    return changes;
}

static bool draws_strokes(const technique *t)
{
    for (size_t i = 0; i < t->pass_count; i++)
        if (t->passes[i].strokes)
            return true;
    return false;
}

static bool mesh_needs_differ(const surface_row *s, const void *a, const void *b)
{
    if (!s->needs)
        return false;
    mesh_needs one = s->needs(a), other = s->needs(b);
    return one.field != other.field || one.patch != other.patch || one.rest != other.rest || one.walls != other.walls ||
           one.glue != other.glue;
}

/* Are other shapes made from those of the scene? */
static bool shapes_differ(const kind *k, const technique *t, const void *a, const void *b)
{
    if (k->id == KIND_SCENE) {
        const scene_values *one = a, *other = b;
        return one->crease_angle != other->crease_angle || one->round != other->round ||
               strcmp(one->cut.text, other->cut.text) != 0 || strcmp(one->cut_keep.text, other->cut_keep.text) != 0;
    }
    if (k->id == KIND_LINES && draws_strokes(t)) {
        /* How lines are drawn is no shape; which there are is. */
        const strokes_values *one = a, *other = b;
        return memcmp(&one->options, &other->options, sizeof one->options) != 0;
    }
    return t->surface && mesh_needs_differ(t->surface, a, b);
}

unsigned use_changes(const kind *k, const technique_use *before, const technique_use *after)
{
    const technique *t = after->technique;
    const void      *a = before->values, *b = after->values;
    unsigned         changes = 0;
    if (before->technique != t)
        return LOOK_CHANGE_ALL;
    for (size_t i = 0; t && i < kind_param_count(k, t); i++) {
        const param *p = kind_param_at(k, t, i);
        if (same_field(p, a, b))
            continue;
        changes |= LMN_CHANGE_VALUES;
        if (p->is_selector)
            changes |= LMN_CHANGE_PLAN | LMN_CHANGE_PROGRAMS;
        if (switches(k, p, a, b))
            changes |= LMN_CHANGE_PLAN | LMN_CHANGE_PROGRAMS;
    }
    if (!changes)
        return 0;
    if (conditions_differ(k, t, a, b))
        changes |= LMN_CHANGE_PLAN | LMN_CHANGE_PROGRAMS;
    if (t->motion && motion_differs(t->motion, a, b))
        changes |= LMN_CHANGE_PLAN | LMN_CHANGE_PROGRAMS | LMN_CHANGE_MESHES;
    if (shapes_differ(k, t, a, b))
        changes |= LMN_CHANGE_MESHES;
    return changes | made_changes(k, before, after);
}

/* --- looks ---------------------------------------------------------------------------------------------- */

/* Of a rule that stays at its place. */
static unsigned rule_changes(const rule *a, const rule *b)
{
    unsigned changes = same_text(a->name, b->name) ? 0 : LMN_CHANGE_VALUES;
    if (!same_text(a->select, b->select))
        return LOOK_CHANGE_ALL;
    for (size_t k = 0; k < KIND_COUNT; k++) {
        if (a->use_counts[k] != b->use_counts[k])
            return LOOK_CHANGE_ALL;
        for (size_t i = 0; i < a->use_counts[k]; i++)
            changes |= use_changes(kinds[k], &a->uses[k][i], &b->uses[k][i]);
    }
    return changes;
}

static unsigned content_difference(const lmn_look *a, const lmn_look *b)
{
    if (a->rule_count != b->rule_count)
        return LOOK_CHANGE_ALL;
    unsigned changes = same_text(a->name, b->name) && same_text(a->doc, b->doc) ? 0 : LMN_CHANGE_VALUES;
    for (size_t k = 0; k < KIND_COUNT; k++)
        changes |= use_changes(kinds[k], &a->wide[k], &b->wide[k]);
    for (size_t i = 0; i < a->rule_count; i++)
        changes |= rule_changes(&a->rules[i], &b->rules[i]);
    return changes;
}

/* A look whose parameters are what its controls make of them; NULL when memory is gone. */
static lmn_look *controlled(const lmn_look *look)
{
    lmn_look *out = NULL;
    if (look_copy(&out, look, NULL) == LMN_OK)
        look_apply_controls(out);
    return out;
}

/* What is drawn decides, so parameters are compared behind the controls. */
static unsigned difference(const lmn_look *a, const lmn_look *b)
{
    unsigned changes = look_controls_are_alike(a, b) ? 0 : LMN_CHANGE_VALUES;
    if (!look_controls_are_set(a) && !look_controls_are_set(b))
        return changes | content_difference(a, b);
    lmn_look *one = controlled(a), *other = controlled(b);
    changes |= one && other ? content_difference(one, other) : LOOK_CHANGE_ALL;
    look_destroy(&one);
    look_destroy(&other);
    return changes;
}

lmn_status look_edit_begin(lmn_look **before, const lmn_look *look, lmn_error *error)
{
    lmn_status status = look_copy(before, look, error);
    if (status == LMN_OK) { /* it may become the look again */
        (*before)->revision = look->revision;
        memcpy((*before)->changed, look->changed, sizeof look->changed);
    }
    return status;
}

lmn_status look_edit_end(lmn_look *look, lmn_look **before, lmn_status status)
{
    if (status == LMN_OK) {
        look_mark_changed(look, difference(*before, look));
    } else {
        lmn_look changed = *look;
        *look = **before;
        **before = changed;
    }
    look_destroy(before);
    return status;
}
