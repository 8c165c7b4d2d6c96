#include "look/selector.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "scene/city.h"
#include "scene/content.h"

typedef enum condition_type {
    CONDITION_NAME,
    CONDITION_PATH,
    CONDITION_ATTRIBUTE,
    CONDITION_REMOVED,
    CONDITION_SOLID
} condition_type;

/* How an attribute is compared: by its text, or as a number. */
typedef enum comparison {
    COMPARE_IS,
    COMPARE_IS_NOT,
    COMPARE_BELOW,
    COMPARE_AT_MOST,
    COMPARE_ABOVE,
    COMPARE_AT_LEAST
} comparison;

/* One condition. Those of one alternative follow each other; all of them must hold. */
typedef struct condition {
    condition_type type;
    bool           negated;
    bool           starts_alternative;
    comparison     comparison;
    char          *key;     /* of an attribute */
    char          *pattern; /* NULL: any value */
    bool           numeric; /* the pattern is a number, which is */
    double         number;
} condition;

struct selector {
    condition *items;
    size_t     count, capacity;
};

typedef struct reader {
    const char *text, *at;
    lmn_error  *error;
} reader;

static lmn_status wrong(const reader *r, const char *what)
{
    return error_set(r->error, LMN_USAGE, "selector '%.120s' is wrong at character %d: %s", r->text,
                     (int)(r->at - r->text) + 1, what);
}

static void skip_blanks(reader *r)
{
    while (*r->at == ' ' || *r->at == '\t')
        r->at++;
}

/* Reads a word up to one of `ends` (or the text's end). Quotes keep everything between them. */
static lmn_status read_word(reader *r, const char *ends, char **out)
{
    text word = {0};
    while (*r->at && !strchr(ends, *r->at)) {
        if (*r->at == '"' || *r->at == '\'') {
            const char *close = strchr(r->at + 1, *r->at);
            if (!close) {
                text_release(&word);
                return wrong(r, "the quote is not closed");
            }
            text_append_bytes(&word, r->at + 1, (size_t)(close - r->at) - 1);
            r->at = close + 1;
        } else {
            text_append_bytes(&word, r->at++, 1);
        }
    }
    *out = text_take(&word);
    return *out ? LMN_OK : error_memory(r->error);
}

/* What an attribute or a pattern is as a number: "12", "12.5 m", or a date, "1898-05" or "1898-05-02", which is its
 * year and the fraction of it that has passed. */
static bool as_number(const char *value, double *out)
{
    const char *end = value + strlen(value);
    while (*value == ' ')
        value++;
    const char *behind = text_parse_double(value, end, out);
    if (!behind || !isfinite(*out))
        return false;
    long long month = 0, day = 1;
    if (behind - value == 4 && *behind == '-' && text_parse_int(behind + 1, end, &month) == behind + 3 && month >= 1 &&
        month <= 12) {
        if (behind[3] == '-' && (text_parse_int(behind + 4, end, &day) != behind + 6 || day < 1 || day > 31))
            return false;
        *out += ((double)(month - 1) + (double)(day - 1) / 31) / 12;
        return behind[3] == '-' || behind[3] == '\0';
    }
    return *behind == '\0' || *behind == ' ';
}

/* The operator between key and value; false when there is none. */
static bool read_comparison(reader *r, comparison *out)
{
    static const struct {
        const char *text;
        comparison  is;
    } operators[] = {{"!=", COMPARE_IS_NOT}, {"<=", COMPARE_AT_MOST}, {">=", COMPARE_AT_LEAST},
                     {"=", COMPARE_IS},      {"<", COMPARE_BELOW},    {">", COMPARE_ABOVE}};
    for (size_t i = 0; i < sizeof operators / sizeof *operators; i++) {
        size_t length = strlen(operators[i].text);
        if (strncmp(r->at, operators[i].text, length) == 0) {
            *out = operators[i].is;
            r->at += length;
            return true;
        }
    }
    return false;
}

static lmn_status read_value(reader *r, condition *c)
{
    const char *start = r->at;
    lmn_status  status = read_word(r, "]", &c->pattern);
    if (status != LMN_OK)
        return status;
    c->numeric = as_number(c->pattern, &c->number);
    if (c->comparison <= COMPARE_IS_NOT || c->numeric)
        return LMN_OK;
    r->at = start;
    return wrong(r, "'<', '<=', '>' and '>=' need a number, or a date such as 1950-01-31, behind them");
}

static lmn_status read_attribute(reader *r, condition *c)
{
    c->type = CONDITION_ATTRIBUTE;
    r->at++;
    lmn_status status = read_word(r, "=<>!]", &c->key);
    if (status != LMN_OK)
        return status;
    if (c->key[0] == '\0')
        return wrong(r, "the attribute's name is missing");
    if (read_comparison(r, &c->comparison)) {
        status = read_value(r, c);
        if (status != LMN_OK)
            return status;
    } else if (*r->at == '!') {
        return wrong(r, "'!' within '[' has to be '!='; put names that hold '!' into quotes");
    }
    if (*r->at != ']')
        return wrong(r, "']' is missing");
    r->at++;
    return LMN_OK;
}

/* A word behind '@' that says what a surface of a city is. */
static bool read_surface(condition *c)
{
    for (size_t i = 0; city_words[i]; i++)
        if (strcmp(city_words[i], c->pattern + 1) == 0) {
            c->type = CONDITION_ATTRIBUTE;
            c->key = mem_copy_text(CITY_SURFACE_KEY);
            memmove(c->pattern, c->pattern + 1, strlen(c->pattern));
            return true;
        }
    return false;
}

static lmn_status read_keyword(reader *r, condition *c, const char *start)
{
    if (read_surface(c))
        return c->key ? LMN_OK : error_memory(r->error);
    c->type = strcmp(c->pattern, "@solid") == 0 ? CONDITION_SOLID : CONDITION_REMOVED;
    if (c->type == CONDITION_SOLID || strcmp(c->pattern, "@removed") == 0)
        return LMN_OK;
    r->at = start;
    const char *nearest = text_nearest(c->pattern + 1, city_words, city_word_count);
    wrong(r, "after '@' 'removed', 'solid' and surfaces of cities ('roof', 'wall' ...) are known; put names that begin "
             "with '@' into quotes");
    if (nearest && r->error)
        error_hint(r->error, "perhaps @%s", nearest);
    return LMN_USAGE;
}

static lmn_status read_condition(reader *r, condition *c)
{
    while (*r->at == '!') {
        c->negated = !c->negated;
        r->at++;
        skip_blanks(r);
    }
    if (*r->at == '[')
        return read_attribute(r, c);
    if (*r->at == ']')
        return wrong(r, "']' without '['");
    const char *start = r->at;
    lmn_status  status = read_word(r, " \t,[", &c->pattern);
    if (status == LMN_OK && r->at == start)
        return wrong(r, "a name, a path or [attribute] is missing");
    if (status == LMN_OK && *start == '@') /* in quotes it is a name */
        return read_keyword(r, c, start);
    if (status == LMN_OK)
        c->type = strchr(c->pattern, '/') ? CONDITION_PATH : CONDITION_NAME;
    return status;
}

static lmn_status read_all(reader *r, selector *s)
{
    bool starts = true;
    for (skip_blanks(r); *r->at || starts; skip_blanks(r)) {
        if (*r->at == ',') {
            if (starts)
                return wrong(r, "nothing stands before ','");
            r->at++;
            starts = true;
            continue;
        }
        if (!mem_grow((void **)&s->items, &s->capacity, s->count + 1, sizeof *s->items))
            return error_memory(r->error);
        condition *c = &s->items[s->count++];
        *c = (condition){.starts_alternative = starts};
        lmn_status status = read_condition(r, c);
        if (status != LMN_OK)
            return status;
        starts = false;
    }
    return LMN_OK;
}

lmn_status selector_parse(selector **out, const char *written, lmn_error *error)
{
    reader r = {written, written, error};
    *out = NULL;
    selector *s = mem_calloc(1, sizeof *s);
    if (!s)
        return error_memory(error);
    lmn_status status = read_all(&r, s);
    if (status != LMN_OK) {
        selector_destroy(&s);
        if (error && status == LMN_USAGE && !error->hint[0])
            error_hint(error,
                       "for example: *   Wheel*   \"Front Axle\"   Truck/*   [material=Glass]   [height>30]   !Ground");
    }
    *out = s;
    return status;
}

void selector_destroy(selector **s)
{
    if (!s || !*s)
        return;
    for (size_t i = 0; i < (*s)->count; i++) {
        mem_free((*s)->items[i].key);
        mem_free((*s)->items[i].pattern);
    }
    mem_free((*s)->items);
    mem_free(*s);
    *s = NULL;
}

/* Numbers compare as numbers, so that 30.0 is 30; all else by its text. */
static bool value_matches(const condition *c, const char *value)
{
    double     number = 0;
    bool       numbers = c->numeric && as_number(value, &number);
    comparison how = c->comparison;
    if (how <= COMPARE_IS_NOT)
        return ((numbers && number == c->number) || text_glob(c->pattern, value)) == (how == COMPARE_IS);
    if (!numbers)
        return false;
    return how == COMPARE_BELOW     ? number < c->number
           : how == COMPARE_AT_MOST ? number <= c->number
           : how == COMPARE_ABOVE   ? number > c->number
                                    : number >= c->number;
}

static bool material_matches(const condition *c, const lmn_scene *scene, const node *n)
{
    if (n->mesh < 0 || (size_t)n->mesh >= scene->mesh_count)
        return false;
    const mesh *m = &scene->meshes[n->mesh];
    for (size_t i = 0; i < m->primitive_count; i++) {
        int32_t index = m->primitives[i].material;
        if (index < 0 || (size_t)index >= scene->material_count)
            continue;
        const char *name = scene->materials[index].name;
        if (!c->pattern || value_matches(c, name ? name : ""))
            return true;
    }
    return false;
}

static bool attribute_matches(const condition *c, const lmn_scene *scene, int32_t at)
{
    const char *value = scene_attribute_of(scene, at, c->key);
    return value && (!c->pattern || value_matches(c, value));
}

static bool condition_holds(const condition *c, const lmn_scene *scene, size_t part_index)
{
    const part *p = &scene->parts[part_index];
    char        id[24];
    switch (c->type) {
    case CONDITION_NAME: return text_glob(c->pattern, p->name ? p->name : "");
    case CONDITION_PATH: return text_glob(c->pattern, p->path ? p->path : "");
    case CONDITION_REMOVED: return p->ghost;
    case CONDITION_SOLID: return scene->nodes[p->node].solid >= 0;
    case CONDITION_ATTRIBUTE: break;
    }
    if (strcmp(c->key, "id") == 0) {
        snprintf(id, sizeof id, "%zu", part_index + 1);
        return !c->pattern || value_matches(c, id);
    }
    if (strcmp(c->key, "material") == 0)
        return material_matches(c, scene, &scene->nodes[p->node]);
    return attribute_matches(c, scene, p->node);
}

static bool asks_for_removed(const condition *c)
{
    return c->type == CONDITION_REMOVED && !c->negated;
}

bool selector_names_removed(const selector *s)
{
    for (size_t i = 0; i < s->count; i++)
        if (asks_for_removed(&s->items[i]))
            return true;
    return false;
}

bool selector_matches(const selector *s, const lmn_scene *scene, size_t part_index)
{
    if (part_index >= scene->part_count + scene->ghost_count)
        return false;
    bool ghost = scene->parts[part_index].ghost;
    for (size_t i = 0; i < s->count;) {
        bool all = true, asked = false;
        do {
            all = all && condition_holds(&s->items[i], scene, part_index) != s->items[i].negated;
            asked = asked || asks_for_removed(&s->items[i]);
        } while (++i < s->count && !s->items[i].starts_alternative);
        if (all && (asked || !ghost))
            return true;
    }
    return false;
}
