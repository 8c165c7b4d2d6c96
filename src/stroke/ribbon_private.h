/* What the files of ribbons share: where along its chain a stroke is inked. Arcs are lengths along the chain,
 * pixels. */
#ifndef LIMNER_STROKE_RIBBON_PRIVATE_H
#define LIMNER_STROKE_RIBBON_PRIVATE_H

#include "stroke/ribbon.h"

typedef struct span {
    float from, to;
} span;

/* Spans in order, apart from each other. Zero-initialise; the first failure sticks. */
typedef struct span_list {
    span  *items;
    size_t count, capacity;
    bool   failed;
} span_list;
void span_list_add(span_list *list, float from, float to);
void span_list_release(span_list *list);
/* What is in both lists; `out` is emptied first. */
void span_list_intersect(span_list *out, const span_list *a, const span_list *b);

/* A stretch of a stroke that is not drawn. */
typedef struct stroke_gap {
    uint32_t stroke;
    float    from, to;
} stroke_gap;
typedef struct gap_list {
    stroke_gap *items;
    size_t      count, capacity;
    bool        failed;
} gap_list;
void gap_list_add(gap_list *list, uint32_t stroke, float from, float to);
void gap_list_release(gap_list *list);
/* By stroke, then by position. */
void gap_list_sort(gap_list *list);

/* A chain: its strokes follow each other. */
typedef struct chain_facts {
    uint32_t first, count; /* strokes */
    bool     closed;
    float    length;
} chain_facts;

typedef struct ribbon_job {
    const stroke_set   *strokes;
    const stroke_style *style;
    uint32_t            seed;
    chain_facts        *chains;
    size_t              chain_count;
    uint32_t           *chain_of; /* of each stroke */
    bool               *drawn;    /* of each stroke: the style wants it */
} ribbon_job;

/* Width of a stroke's line where nothing varies it. */
float ribbon_width(const ribbon_job *job, const stroke *s);

/* Where a stroke passes behind a visible one. */
void ribbon_find_halos(gap_list *out, const ribbon_job *job);

/* Where hidden strokes are left out because more important lines are too near. */
void ribbon_find_crowds(gap_list *out, const ribbon_job *job);

/* The dashes of a stroke from arc `from` to `to`. */
void ribbon_dash(span_list *out, const ribbon_job *job, const stroke *s, const chain_facts *chain, float from,
                 float to);

/* Depth between two depths, at a fraction of the way on the page. */
float ribbon_depth_between(const ribbon_job *job, float a, float b, float fraction);

#endif
