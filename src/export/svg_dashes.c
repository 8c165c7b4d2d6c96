/* Dashes in SVG. Hundredths of a millimetre are written where that moves no dash by more than DASH_MOVED, else
 * thousandths: lengths are differences of rounded positions along the pattern, so that of a list nothing drifts, and
 * of a pattern that is repeated what its end is off by, once for each time. Hidden lines are short, and many are
 * dashed alike but for what is not seen. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "export/svg_private.h"

#define DASH_MOVED 0.02 /* mm */
/* With fewer uses the class takes more room than what it stands for. */
enum { USES_LEAST = 3 };

long long svg_thousandths(double value)
{
    return isfinite(value) ? llround(value * 1000) : 0;
}

size_t svg_print_thousandths(char *to, long long value)
{
    char               digits[24];
    size_t             count = 0, at = 0;
    unsigned long long left = value < 0 ? (unsigned long long)-value : (unsigned long long)value, whole = left / 1000,
                       part = left % 1000;
    if (value < 0)
        to[at++] = '-';
    for (; whole; whole /= 10)
        digits[count++] = (char)('0' + whole % 10);
    while (count)
        to[at++] = digits[--count];
    if (part) {
        to[at++] = '.';
        for (unsigned long long unit = 100; part; unit /= 10) {
            to[at++] = (char)('0' + part / unit);
            part %= unit;
        }
    }
    if (left == 0)
        to[at++] = '0';
    return at;
}

static double length_of(const sheet *s, const sheet_path *path)
{
    const float(*points)[2] = (const float(*)[2])s->points + path->first;
    double sum = 0;
    for (uint32_t i = 1; i < path->count; i++)
        sum += (double)hypotf(points[i][0] - points[i - 1][0], points[i][1] - points[i - 1][1]);
    return sum;
}

/* How many lengths say it all: of a line that ends with its second dash, and whose second dash is no longer than the
 * first, the first dash and its gap. */
static uint32_t count_of(const sheet *s, const sheet_path *path)
{
    const float *lengths = s->dashes + path->first_dash;
    bool         two = path->dash_count == 4 && path->phase == 0 && lengths[2] <= lengths[0] && !path->closed;
    return two && length_of(s, path) < (double)(lengths[0] + lengths[1] + lengths[2]) + 0.01 ? 2 : path->dash_count;
}

/* The unit that lengths are whole multiples of, thousandths. */
static long long unit_of(const sheet *s, const sheet_path *path)
{
    const float *lengths = s->dashes + path->first_dash;
    double       period = 0;
    for (uint32_t i = 0; i < path->dash_count; i++) {
        period += (double)lengths[i];
        if (lengths[i] > 0 && lengths[i] < 0.1f)
            return 1; /* dots are all ink that there is */
    }
    double drift = fabs(period - round(100 * period) / 100) * floor(length_of(s, path) / period);
    return period > 0 && drift + 0.005 <= DASH_MOVED ? 10 : 1;
}

long long svg_dash_offset(const sheet *s, const sheet_path *path)
{
    long long unit = unit_of(s, path), offset = svg_thousandths((double)path->phase);
    return unit == 1 ? offset : unit * llround((double)offset / (double)unit);
}

static char *print_lengths(const sheet *s, const sheet_path *path)
{
    text      out = {0};
    double    sum = 0;
    long long before = 0, unit = unit_of(s, path);
    for (uint32_t i = 0, count = count_of(s, path); i < count; i++) {
        char digits[32] = " ";
        sum += (double)s->dashes[path->first_dash + i];
        long long at = unit * llround((double)svg_thousandths(sum) / (double)unit);
        size_t    size = svg_print_thousandths(digits + 1, at - before);
        text_append_bytes(&out, i ? digits : digits + 1, i ? size + 1 : size);
        before = at;
    }
    return text_take(&out);
}

static uint64_t hash_of(const char *words)
{
    uint64_t hash = UINT64_C(0xCBF29CE484222325);
    for (; *words; words++)
        hash = (hash ^ (unsigned char)*words) * UINT64_C(0x100000001B3);
    return hash ^ hash >> 29;
}

/* The slot of a pattern, or a free one. */
static size_t slot_of(const svg_dashes *d, const char *lengths)
{
    size_t at = hash_of(lengths) & (d->slot_count - 1);
    while (d->slots[at] && strcmp(d->patterns[d->slots[at] - 1].lengths, lengths) != 0)
        at = (at + 1) & (d->slot_count - 1);
    return at;
}

static bool grow_slots(svg_dashes *d)
{
    size_t    count = d->slot_count ? 4 * d->slot_count : 64;
    uint32_t *slots = mem_calloc(count, sizeof *slots);
    if (!slots)
        return false;
    mem_free(d->slots);
    d->slots = slots;
    d->slot_count = count;
    for (size_t i = 0; i < d->count; i++)
        d->slots[slot_of(d, d->patterns[i].lengths)] = (uint32_t)i + 1;
    return true;
}

bool svg_dashes_note(svg_dashes *d, const sheet *s, const sheet_path *path)
{
    char *lengths = print_lengths(s, path);
    bool  good = lengths && (2 * d->count < d->slot_count || grow_slots(d));
    if (good && d->slots[slot_of(d, lengths)]) {
        d->patterns[d->slots[slot_of(d, lengths)] - 1].uses++;
        mem_free(lengths);
        return true;
    }
    if (!good || !mem_grow((void **)&d->patterns, &d->capacity, d->count + 1, sizeof *d->patterns)) {
        mem_free(lengths);
        return false;
    }
    d->slots[slot_of(d, lengths)] = (uint32_t)d->count + 1;
    d->patterns[d->count++] = (svg_dash_pattern){lengths, 1, -1};
    return true;
}

void svg_dashes_name(svg_dashes *d)
{
    int32_t names = 0;
    for (size_t i = 0; i < d->count; i++)
        if (d->patterns[i].uses >= USES_LEAST)
            d->patterns[i].name = names++;
}

const svg_dash_pattern *svg_dashes_find(const svg_dashes *d, const sheet *s, const sheet_path *path)
{
    char  *lengths = print_lengths(s, path);
    size_t found = lengths && d->slot_count ? d->slots[slot_of(d, lengths)] : 0;
    mem_free(lengths);
    return found ? &d->patterns[found - 1] : NULL;
}

void svg_dashes_release(svg_dashes *d)
{
    for (size_t i = 0; i < d->count; i++)
        mem_free(d->patterns[i].lengths);
    mem_free(d->patterns);
    mem_free(d->slots);
    *d = (svg_dashes){.patterns = NULL};
}
