/* What the tests of signs share: scenes seen from the front at a time, and reading the signs that were put into them.
 */
#ifndef TESTS_DEPICT_SUPPORT_H
#define TESTS_DEPICT_SUPPORT_H

#include "placed_glyph.h"
#include <math.h>

#include "base/vector3.h"
#include "import_support.h"
#include "limner/depict.h"

#define assert_near(VALUE, EXPECTED, OFF) near_or_fail(VALUE, EXPECTED, OFF, #VALUE, __LINE__)

static inline void near_or_fail(double value, double expected, double off, const char *what, int line)
{
    if (!(fabs(value - expected) <= off))
        fail_msg("line %d: %s is %.8g instead of %.8g", line, what, value, expected);
}

static inline lmn_draw_desc seen_at(double seconds)
{
    lmn_draw_desc d = LMN_DRAW_DESC_INIT;
    d.view = LMN_VIEW_FRONT;
    d.orthographic = true;
    d.time_s = seconds;
    d.time_given = true;
    return d;
}

static inline void tell_as(lmn_scene *scene, const lmn_draw_desc *draw, const char *expressions, char **json)
{
    lmn_error       error = {0};
    lmn_depict_desc desc = LMN_DEPICT_DESC_INIT;
    desc.expressions = expressions;
    if (lmn_depict(scene, draw, &desc, json, &error) != LMN_OK)
        fail_msg("%s: %s", expressions ? expressions : "proposed", error.message);
}

static inline void tell_at(lmn_scene *scene, double seconds, const char *expressions)
{
    lmn_draw_desc draw = seen_at(seconds);
    tell_as(scene, &draw, expressions, NULL);
}

/* --- what was put into the scene ---------------------------------------------------------------------------------- */

static inline const char *value_of(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0)
            return n->attributes[i].value;
    return "";
}

/* The k-th glyph of a kind and tense (NULL: any); NULL when there are fewer. */
static inline const primitive *glyph_at(const lmn_scene *s, const char *glyph, const char *when, size_t k)
{
    for (size_t i = 0; i < s->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        if (n->mesh != NONE && strcmp(value_of(n, "glyph"), glyph) == 0 &&
            (!when || strcmp(value_of(n, "when"), when) == 0) && k-- == 0)
            return placed_glyph(s, n);
    }
    return NULL;
}

static inline const primitive *sign_at(const lmn_scene *s, const char *glyph, size_t k)
{
    return glyph_at(s, glyph, NULL, k);
}

static inline size_t count_of(const lmn_scene *s, const char *glyph)
{
    size_t count = 0;
    while (sign_at(s, glyph, count))
        count++;
    return count;
}

static inline void position(const primitive *p, uint32_t i, double out[3])
{
    vector3_set(out, (double)p->positions[i].x, (double)p->positions[i].y, (double)p->positions[i].z);
}

/* In the middle of a ribbon's breadth, at its k-th pair of vertices. */
static inline void ribbon_point(const primitive *p, uint32_t k, double out[3])
{
    double a[3], b[3];
    position(p, 2 * k, a);
    position(p, 2 * k + 1, b);
    vector3_mix(out, a, b, 0.5);
}

#endif
