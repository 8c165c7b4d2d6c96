/* What a node of a .csg file is told, by name or position, with OpenSCAD's way of falling back to defaults. */
#include <math.h>
#include <string.h>

#include "import/csg_tree.h"

int32_t csg_argument_value(const csg_tree *t, int32_t node, const char *name, int position)
{
    const csg_node *n = &t->nodes[node];
    int32_t         found = NONE;
    int             unnamed = 0;
    for (int32_t i = n->first_argument; i < n->first_argument + n->argument_count; i++) {
        const csg_argument *a = &t->arguments[i];
        if (a->name != 0 ? strcmp(t->text + a->name, name) == 0 : unnamed++ == position)
            found = a->value;
    }
    return found == NONE || t->values[found].kind == CSG_UNDEF ? NONE : found;
}

double csg_number(const csg_tree *t, int32_t node, const char *name, int position, double otherwise)
{
    int32_t v = csg_argument_value(t, node, name, position);
    return v != NONE && t->values[v].kind == CSG_NUMBER ? t->values[v].as.number : otherwise;
}

bool csg_bool(const csg_tree *t, int32_t node, const char *name, int position, bool otherwise)
{
    int32_t v = csg_argument_value(t, node, name, position);
    if (v != NONE && t->values[v].kind == CSG_NUMBER)
        return t->values[v].as.number != 0;
    return v != NONE && t->values[v].kind == CSG_BOOL ? t->values[v].as.truth : otherwise;
}

const char *csg_string(const csg_tree *t, int32_t node, const char *name, int position, const char *otherwise)
{
    int32_t v = csg_argument_value(t, node, name, position);
    return v != NONE && t->values[v].kind == CSG_STRING ? t->text + t->values[v].as.string : otherwise;
}

void csg_vector_numbers(const csg_tree *t, int32_t value, double *out, uint32_t count)
{
    int32_t element = value + 1;
    for (uint32_t i = 0; i < t->values[value].count && i < count; i++, element = t->values[element].after)
        if (t->values[element].kind == CSG_NUMBER)
            out[i] = t->values[element].as.number;
}

uint32_t csg_numbers(const csg_tree *t, int32_t node, const char *name, int position, double *out, uint32_t count,
                     bool spread)
{
    int32_t v = csg_argument_value(t, node, name, position);
    if (v == NONE)
        return 0;
    if (t->values[v].kind == CSG_VECTOR) {
        csg_vector_numbers(t, v, out, count);
        return t->values[v].count;
    }
    if (t->values[v].kind != CSG_NUMBER || !spread)
        return 0;
    for (uint32_t i = 0; i < count; i++)
        out[i] = t->values[v].as.number;
    return count;
}

bool csg_all_finite(const csg_tree *t, int32_t node)
{
    const csg_node *n = &t->nodes[node];
    for (int32_t i = n->first_value; i < n->first_value + n->value_count; i++)
        if (t->values[i].kind == CSG_NUMBER && !isfinite(t->values[i].as.number))
            return false;
    return true;
}
