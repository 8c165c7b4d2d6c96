/* Vertices: a long list of three numbers each, and where the scene's origin is among them. */
#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "import/city_crs.h"
#include "import/cityjson.h"

typedef struct point_list {
    double (*items)[3];
    size_t count, capacity;
} point_list;

/* The most common form, "[12,-3,456]" without blanks, read at once; NULL: it is another one. */
static const char *quick_point(const char *at, double out[3])
{
    if (*at++ != '[')
        return NULL;
    for (int k = 0; k < 3; k++) {
        bool        minus = *at == '-';
        uint64_t    whole = 0; /* which may wrap round; then there are too many digits */
        const char *digits = at += minus;
        while (*at >= '0' && *at <= '9')
            whole = whole * 10 + (uint64_t)(*at++ - '0');
        if (at == digits || at - digits > 17 || *at++ != (k < 2 ? ',' : ']'))
            return NULL;
        out[k] = minus ? -(double)whole : (double)whole;
    }
    return at;
}

static bool slow_point(json_scan *s, double out[3])
{
    int k = 0;
    for (bool more = scan_open(s, '['); more; more = scan_next(s, ']'), k++) {
        double ignored;
        if (!scan_number(s, k < 3 ? &out[k] : &ignored))
            return false;
    }
    if (k < 3 && !s->wrong)
        scan_fail(s, "a vertex has three coordinates");
    return !s->wrong;
}

static void read_list(cityjson_reader *r, json_span span, point_list *list)
{
    if (!span.at)
        return;
    json_scan s = scan_of(span);
    for (bool more = scan_open(&s, '['); more; more = scan_next(&s, ']')) {
        if (list->count == list->capacity &&
            !mem_grow((void **)&list->items, &list->capacity, list->count + 1, sizeof *list->items)) {
            cityjson_no_memory(r);
            return;
        }
        double     *p = list->items[list->count];
        const char *behind = scan_peek(&s) == '[' && s.end - s.at > 64 ? quick_point(s.at, p) : NULL;
        if (behind)
            s.at = behind;
        else if (!slow_point(&s, p))
            break;
        if (++list->count > LIMIT_VERTICES) {
            cityjson_fail(r, LMN_LIMIT, s.at, "more than %zu vertices", LIMIT_VERTICES);
            return;
        }
    }
    cityjson_good(r, &s);
}

/* --- where it lies -------------------------------------------------------------------------------------- */

static bool read_extent(json_span metadata, double low[3], double high[3])
{
    bool found = false;
    if (!metadata.at)
        return false;
    json_scan s = scan_of(metadata);
    for (bool more = scan_open(&s, '{'); more; more = scan_next(&s, '}')) {
        json_span key = scan_key(&s);
        if (!span_is(key, "geographicalExtent")) {
            scan_skip(&s);
            continue;
        }
        int k = 0;
        for (bool next = scan_open(&s, '['); next; next = scan_next(&s, ']'), k++) {
            double value = 0;
            scan_number(&s, &value);
            if (k < 6)
                (k < 3 ? low : high)[k % 3] = value;
        }
        found = k == 6 && !s.wrong;
    }
    for (int k = 0; k < 3; k++)
        found = found && isfinite(low[k]) && isfinite(high[k]) && low[k] <= high[k];
    return found;
}

static void place(cityjson_reader *r, const point_list *list, json_span metadata)
{
    city_facts *facts = &r->scene->city;
    double      low[3], high[3];
    if (list->count == 0 && !read_extent(metadata, low, high))
        return;
    if (list->count)
        city_extent(list->items, list->count, low, high);
    city_crs_understand(facts, facts->crs, low, high, &r->latitude_first);
    city_choose_origin(facts, low, high);
    r->placed = true;
}

/* --- doubles to the scene's floats ---------------------------------------------------------------------- */

/* In the same block, from its beginning: a point takes half the room. */
static vec3 *shrink(point_list *list)
{
    vec3 *smaller = list->count ? mem_realloc(list->items, list->count * sizeof *smaller) : NULL;
    vec3 *out = smaller ? smaller : (vec3 *)(void *)list->items;
    list->items = NULL;
    return out;
}

void cityjson_read_plain_points(cityjson_reader *r, json_span vertices, vec3 **out, size_t *count)
{
    point_list list = {0};
    read_list(r, vertices, &list);
    for (size_t i = 0; i < list.count; i++) {
        double p[3];
        memcpy(p, list.items[i], sizeof p);
        vec3 small = {(float)p[0], (float)p[1], (float)p[2]};
        memcpy((char *)list.items + i * sizeof small, &small, sizeof small);
    }
    *count = list.count;
    *out = shrink(&list);
}

void cityjson_read_points(cityjson_reader *r, json_span vertices, json_span metadata)
{
    point_list list = {0};
    read_list(r, vertices, &list);
    for (size_t i = 0; i < list.count; i++)
        for (int k = 0; k < 3; k++)
            list.items[i][k] = list.items[i][k] * r->scale[k] + r->translate[k];
    if (!r->placed && r->status == LMN_OK)
        place(r, &list, metadata);
    const city_facts *facts = &r->scene->city;
    for (size_t i = 0; i < list.count; i++) {
        double p[3];
        memcpy(p, list.items[i], sizeof p);
        city_crs_local(facts, r->latitude_first, p);
        vec3 small = {(float)p[0], (float)p[1], (float)p[2]};
        memcpy((char *)list.items + i * sizeof small, &small, sizeof small);
    }
    mem_free(r->points);
    r->point_count = list.count;
    r->points = shrink(&list);
}
