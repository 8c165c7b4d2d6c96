#include "hold.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

#include <cmocka.h>

#include "surface/surface.h"

enum { TERM_SIZE = 96 };

void hold_key(char key[HOLD_KEY_SIZE], const kind *k, const char *param_key)
{
    snprintf(key, HOLD_KEY_SIZE, "%s%s.%s", k->look_wide ? "" : "0:", k->name, param_key);
}

static void value_that_holds(char *value, size_t size, const param *p, const char *sign)
{
    if (*sign == '=')
        snprintf(value, size, "%.*s", (int)strcspn(sign + 1, ","), sign + 1);
    else if (p->type == PARAM_BOOL)
        snprintf(value, size, "true");
    else if (p->type == PARAM_TEXT)
        snprintf(value, size, "%s", p->example);
    else if (p->type == PARAM_ENUM)
        snprintf(value, size, "%s", p->names[1]);
    else
        snprintf(value, size, "%.6g", *sign == '<' ? p->min : p->soft_max != 0 ? p->soft_max : p->max);
}

static void hold_term(lmn_look *look, const kind *k, const technique *t, const char *term)
{
    char      key[TERM_SIZE], path[HOLD_KEY_SIZE], value[TERM_SIZE];
    size_t    length = strcspn(term, "=<>");
    lmn_error error = {0};
    snprintf(key, sizeof key, "%.*s", (int)length, term);
    const param *p = kind_find_param(k, t, key);
    if (!p)
        fail_msg("%s.%s: a condition names the unknown '%s'", k->name, t->name, key);
    value_that_holds(value, sizeof value, p, term + length);
    hold_key(path, k, key);
    if (lmn_look_set(look, path, value, &error) != LMN_OK)
        fail_msg("%s.%s: '%s' cannot be made to hold: %s", k->name, t->name, term, error.message);
}

void hold_condition(lmn_look *look, const kind *k, const technique *t, const char *condition)
{
    for (const char *at = condition; at;) {
        char term[TERM_SIZE];
        snprintf(term, sizeof term, "%.*s", (int)strcspn(at, "&"), at);
        hold_term(look, k, t, term);
        at = strchr(at, '&');
        at = at ? at + 1 : NULL;
    }
}

uint32_t hold_lighter(lmn_look *look, const kind *k, const technique *t, const char *param_key)
{
    /* Many strokes are drawn short: long ones have many neighbours to be kept away from. */
    static const struct {
        const technique *technique;
        const char      *key, *value;
        bool             without; /* for all parameters but the one that is named next; else for it alone */
        const char      *param_key;
    } lighter[] = {{&surface_strokes, "count", "1500", true, "count"},
                   {&surface_strokes, "length", "0.0005", false, "count"}};
    uint32_t held = 0;
    for (size_t i = 0; i < PARAM_COUNT(lighter); i++) {
        char path[HOLD_KEY_SIZE];
        bool named = strcmp(lighter[i].param_key, param_key) == 0;
        if (lighter[i].technique != t || named == lighter[i].without)
            continue;
        hold_key(path, k, lighter[i].key);
        if (lmn_look_set(look, path, lighter[i].value, NULL) != LMN_OK)
            fail_msg("%s cannot be set to %s", path, lighter[i].value);
        held |= 1u << i;
    }
    return held;
}
