/* What the files of SVG share: numbers, and patterns of dashes that many lines have. */
#ifndef LIMNER_EXPORT_SVG_PRIVATE_H
#define LIMNER_EXPORT_SVG_PRIVATE_H

#include "base/text.h"
#include "sheet/sheet.h"

/* Three decimals at most, as whole thousandths. What is not finite is 0. */
long long svg_thousandths(double value);
/* Thousandths as a decimal number without what is not needed: "-.5", "12", "0". Returns how many characters. */
size_t svg_print_thousandths(char *to, long long value);

/* A pattern that lines are dashed by. */
typedef struct svg_dash_pattern {
    char   *lengths; /* as they are written; owned */
    size_t  uses;
    int32_t name; /* of its class; −1: each line says its own */
} svg_dash_pattern;

typedef struct svg_dashes {
    svg_dash_pattern *patterns;
    size_t            count, capacity;
    uint32_t         *slots; /* hash of lengths: pattern + 1 */
    size_t            slot_count;
} svg_dashes;

/* Counts the pattern of a dashed path. False: memory is gone. */
bool svg_dashes_note(svg_dashes *d, const sheet *s, const sheet_path *path);
/* Names patterns that so many lines have that a class is shorter, in the order in which they came. */
void svg_dashes_name(svg_dashes *d);
/* The pattern of a path that was noted; NULL: memory is gone. */
const svg_dash_pattern *svg_dashes_find(const svg_dashes *d, const sheet *s, const sheet_path *path);
void                    svg_dashes_release(svg_dashes *d);
/* Where the pattern is when the path begins, as fine as its lengths are written. */
long long svg_dash_offset(const sheet *s, const sheet_path *path);

#endif
