/* From attributes of parts to their colours. */
#include "plan/datum.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "scene/content.h"

typedef struct reading {
    const scene_values *how;
    const char        **values;       /* per part, lent; NULL: none is stated, or it is not drawn */
    const char        **sorted;       /* the same, equal ones behind each other */
    double             *part_numbers; /* per part; NAN: it has none */
    size_t              count, known;
    bool                numbers; /* all of them are */
    double              least, most;
} reading;

static bool read_number(const char *text, double *out)
{
    char *end;
    *out = strtod(text, &end);
    return end != text && *end == '\0' && isfinite(*out);
}

/* From where to where a part reaches up: as it was before a projection bent it. Empty: low above high. */
static void reach_of(const pose *posed, size_t part, double out[2])
{
    const node *n = &posed->scene->nodes[posed->scene->parts[part].node];
    bool        z = posed->scene->up == 'z', bent = false;
    box3        box = box3_empty();
    for (size_t k = 0; n->mesh != NONE && k < posed->scene->meshes[n->mesh].primitive_count; k++) {
        const primitive *p = &posed->scene->meshes[n->mesh].primitives[k];
        bent = bent || p->straight;
        for (uint32_t i = 0; p->straight && i < p->vertex_count; i++)
            box = box3_with_point(box, p->straight[i]);
    }
    if (!bent)
        box = posed->part_boxes[part];
    out[0] = (double)(z ? box.min.z : box.min.y);
    out[1] = (double)(z ? box.max.z : box.max.y);
}

/* How high the tops of parts lie over the lowest place of all: what there is where no height is stated. */
static void measure_heights(reading *r, const pose *posed, const bool *selected)
{
    double lowest = INFINITY, own[2];
    for (size_t i = 0; i < posed->part_count && i < r->count; i++) {
        reach_of(posed, i, own);
        lowest = own[0] <= own[1] ? fmin(lowest, own[0]) : lowest;
        r->part_numbers[i] = selected[i] && own[0] <= own[1] ? own[1] : NAN;
    }
    for (size_t i = 0; i < r->count; i++)
        r->part_numbers[i] -= lowest;
}

static void read_values(reading *r, const pose *posed, const bool *selected)
{
    const lmn_scene *scene = posed->scene;
    const char      *key = r->how->datum.text;
    bool             measures = strcmp(key, "height") == 0 || strcmp(key, "measuredHeight") == 0;
    r->numbers = r->how->datum_words.text[0] == '\0';
    r->least = INFINITY;
    r->most = -INFINITY;
    for (size_t i = 0; i < r->count; i++)
        r->part_numbers[i] = NAN;
    if (measures)
        measure_heights(r, posed, selected);
    for (size_t i = 0; i < r->count; i++) {
        const char *value = selected[i] ? scene_attribute_of(scene, scene->parts[i].node, key) : NULL;
        r->values[i] = value && value[0] ? value : NULL;
        if (r->values[i] && !read_number(r->values[i], &r->part_numbers[i])) {
            r->part_numbers[i] = NAN;
            r->numbers = false;
        }
        r->known += r->values[i] || !isnan(r->part_numbers[i]);
        r->least = fmin(r->least, r->part_numbers[i]);
        r->most = fmax(r->most, r->part_numbers[i]);
    }
    if (r->how->datum_from < r->how->datum_to) {
        r->least = (double)r->how->datum_from;
        r->most = (double)r->how->datum_to;
    }
}

/* The palette at 0 … 1, straight between its colours as they are shown. */
static colour colour_at(const palette *p, double at)
{
    double        along = fmin(fmax(at, 0), 1) * (p->count - 1);
    int           low = (int)fmin(floor(along), fmax(p->count - 2, 0)), high = low + 1 < p->count ? low + 1 : low;
    float         f = (float)(along - low);
    const colour *a = &p->colours[low], *b = &p->colours[high];
    return (colour){a->r + f * (b->r - a->r), a->g + f * (b->g - a->g), a->b + f * (b->b - a->b), 1};
}

/* `fine`: what hardly counts, so that legends have round numbers. */
static void add_number(datum *d, double value, double fine, colour c, size_t parts)
{
    value = fine > 0 ? round(value / fine) * fine : value;
    datum_entry *e = &d->entries[d->entry_count++];
    *e = (datum_entry){.colour = c, .part_count = parts};
    snprintf(e->text, sizeof e->text, "%.6g", value);
}

/* Ramps are told at five places; classes by the number that each begins with. */
static void show_numbers(datum *d, const reading *r)
{
    const palette *p = &r->how->datum_palette;
    double         range = r->most - r->least, fine = range > 0 ? pow(10, floor(log10(range)) - 2) : 0;
    int            classes = r->how->datum_classes < DATUM_ENTRIES_MAX ? r->how->datum_classes : DATUM_ENTRIES_MAX;
    d->is_ramp = classes == 0;
    for (int k = 0; k < (classes ? classes : 5); k++) {
        double at = classes ? (double)k / classes : k / 4.0;
        add_number(d, r->least + at * range, fine, colour_at(p, classes > 1 ? (double)k / (classes - 1) : at), 0);
        if (!(range > 0))
            break;
    }
    for (size_t i = 0; i < r->count; i++) {
        double value = r->part_numbers[i];
        if (isnan(value))
            continue;
        double at = range > 0 ? fmin(fmax((value - r->least) / range, 0), 1) : 0;
        if (classes) {
            int k = (int)fmin(floor(at * classes), (double)d->entry_count - 1);
            d->colours[i] = d->entries[k].colour;
            d->entries[k].part_count++;
        } else {
            d->colours[i] = colour_at(p, at);
        }
    }
}

/* Is the word one of those of the entry, which '|' separates? */
static bool has_word(const datum_entry *e, const char *word)
{
    for (const char *at = e->text;; at++) {
        size_t length = strcspn(at, "|");
        if (strlen(word) == length && strncmp(at, word, length) == 0)
            return true;
        at += length;
        if (!*at)
            /* Longer ones are kept as far as there is room. */
            return strncmp(e->text, word, DATUM_TEXT_MAX - 1) == 0;
    }
}

static datum_entry *entry_of(datum *d, const char *word)
{
    for (size_t i = 0; i < d->entry_count; i++)
        if (has_word(&d->entries[i], word))
            return &d->entries[i];
    return NULL;
}

static void add_word(datum *d, const char *word, size_t length)
{
    if (d->entry_count < DATUM_ENTRIES_MAX && length)
        snprintf(d->entries[d->entry_count++].text, DATUM_TEXT_MAX, "%.*s", (int)length, word);
}

static int by_count(const void *a, const void *b)
{
    const datum_entry *one = a, *other = b;
    return one->part_count != other->part_count ? (one->part_count < other->part_count ? 1 : -1)
                                                : strcmp(one->text, other->text);
}

static int by_text(const void *a, const void *b)
{
    return strcmp(*(const char *const *)a, *(const char *const *)b);
}

/* The words that there are, the most frequent first. Returns how many are left out. */
static size_t find_words(datum *d, reading *r)
{
    size_t known = 0, left_out = 0;
    for (size_t i = 0; i < r->count; i++)
        if (r->values[i])
            r->sorted[known++] = r->values[i];
    qsort(r->sorted, known, sizeof *r->sorted, by_text);
    for (size_t first = 0, end; first < known; first = end) {
        datum_entry *last = &d->entries[DATUM_ENTRIES_MAX - 1], now = {.part_count = 0};
        for (end = first; end < known && strcmp(r->sorted[end], r->sorted[first]) == 0;)
            end++;
        snprintf(now.text, sizeof now.text, "%s", r->sorted[first]);
        now.part_count = end - first;
        bool full = d->entry_count == DATUM_ENTRIES_MAX;
        left_out += full;
        if (full && by_count(&now, last) >= 0)
            continue;
        d->entries[full ? d->entry_count - 1 : d->entry_count++] = now;
        qsort(d->entries, d->entry_count, sizeof *d->entries, by_count);
    }
    for (size_t i = 0; i < d->entry_count; i++)
        d->entries[i].part_count = 0;
    return left_out;
}

/* The palette's colours, then the same ones darker, then lighter. */
static colour word_colour(const palette *p, size_t k)
{
    static const float shifts[][2] = {{1, 0}, {0.55f, 0}, {0.5f, 0.5f}, {0.3f, 0}, {0.25f, 0.75f}, {0.75f, 0}};
    const size_t       round = k / (size_t)p->count, rounds = sizeof shifts / sizeof *shifts;
    const float       *shift = shifts[round < rounds ? round : rounds - 1];
    colour             c = p->colours[k % (size_t)p->count];
    return (colour){shift[0] * c.r + shift[1], shift[0] * c.g + shift[1], shift[0] * c.b + shift[1], c.a};
}

/* Words in the given order; else those that there are. What is beyond the last entry has none of its own. */
static void show_words(datum *d, reading *r, warnings *warnings)
{
    const char *given = r->how->datum_words.text;
    size_t      left_out = 0;
    for (const char *at = given; *at;) {
        size_t length = strcspn(at, ",");
        add_word(d, at, length);
        at += length + (at[length] == ',');
    }
    if (!given[0] && (left_out = find_words(d, r)) > 0)
        warnings_add(warnings, WARNING_REDUCED,
                     "'%s' has %zu more values than there are colours for: they are shown as others (scene.datum)",
                     d->name, left_out);
    for (size_t k = 0; k < d->entry_count; k++)
        d->entries[k].colour = word_colour(&r->how->datum_palette, k);
    for (size_t i = 0; i < r->count; i++) {
        datum_entry *e = r->values[i] ? entry_of(d, r->values[i]) : NULL;
        d->beyond_count += r->values[i] && !e;
        if (!e)
            continue;
        e->part_count++;
        d->colours[i] = e->colour;
    }
}

lmn_status datum_make(datum *out, const pose *posed, const scene_values *values, const bool *selected,
                      size_t part_count, warnings *warnings, lmn_error *error)
{
    reading r = {.how = values, .count = part_count};
    *out = (datum){.colours = NULL};
    if (!values->datum.text[0])
        return LMN_OK;
    if (values->datum_from > values->datum_to)
        return error_set(error, LMN_USAGE, "scene.datum_from (%g) is more than scene.datum_to (%g)",
                         (double)values->datum_from, (double)values->datum_to);
    r.values = mem_calloc(part_count, sizeof *r.values);
    r.part_numbers = mem_calloc(part_count, sizeof *r.part_numbers);
    r.sorted = mem_calloc(part_count, sizeof *r.sorted);
    out->colours = mem_calloc(part_count, sizeof *out->colours);
    if (!r.values || !r.sorted || !r.part_numbers || !out->colours) {
        mem_free(r.values);
        mem_free(r.sorted);
        mem_free(r.part_numbers);
        return error_memory(error);
    }
    out->name = values->datum.text;
    out->other = values->datum_other;
    read_values(&r, posed, selected);
    /* What a surface is, files of cities say and looks for cities ask of any model. */
    if (r.known == 0 && strcmp(values->datum.text, "surface") != 0)
        warnings_add(warnings, WARNING_NO_MATCH, "no part that is drawn has the attribute '%s' (scene.datum)",
                     values->datum.text);
    else if (r.numbers)
        show_numbers(out, &r);
    else
        show_words(out, &r, warnings);
    for (size_t i = 0; i < part_count; i++)
        if (selected[i] && !(out->colours[i].a > 0)) {
            out->colours[i] = values->datum_other;
            out->other_count++;
        }
    out->other_count -= out->beyond_count;
    mem_free(r.values);
    mem_free(r.sorted);
    mem_free(r.part_numbers);
    return LMN_OK;
}

void datum_release(datum *d)
{
    mem_free(d->colours);
    *d = (datum){.colours = NULL};
}
