/* The reference of all ways to depict, made from their tables. */
#include "base/text.h"
#include "depict/depict.h"

static void put_param(text *out, const param *p)
{
    param_value values; /* a field at a time, wherever it stands in its own struct */
    char        value[PARAM_TEXT_MAX] = "", range[128] = "";
    param       alone = *p;
    alone.offset = 0;
    params_set_defaults(&alone, 1, &values);
    param_print(&alone, &values, value, sizeof value);
    if (p->type == PARAM_FLOAT || p->type == PARAM_INT)
        param_print_range(p, range, sizeof range);
    text_append(out, "| `%s` | %s | %s | %s |\n", p->key, value, *range ? range : param_type_text(p->type), p->doc);
}

char *depict_reference(void)
{
    text out = {0};
    text_append(&out, "<!-- Made by `limner looks --depictions`. -->\n# Ways to depict\n\n"
                      "Characteristics that expressions name as \"depict\", and what can be set in them; "
                      "[DEPICTION.md](../DEPICTION.md) tells how they are used.\n");
    for (size_t i = 0; depictions[i]; i++) {
        const depiction *d = depictions[i];
        text_append(&out, "\n## %s%s%s%s\n\n%s%s\n", d->characteristic, d->semantics ? " (" : "",
                    d->semantics ? d->semantics : "", d->semantics ? ")" : "", d->doc,
                    d->hides_target ? " The target itself is hidden." : "");
        if (d->param_count)
            text_append(&out, "\n| parameter | default | allowed | |\n|---|---|---|---|\n");
        for (size_t k = 0; k < d->param_count; k++)
            put_param(&out, &d->params[k]);
    }
    return text_take(&out);
}
