/* What the rooms of annotation share. */
#ifndef LIMNER_ANNOTATE_PRIVATE_H
#define LIMNER_ANNOTATE_PRIVATE_H

#include "annotate/annotate.h"
#include "finish/finish.h"

enum { TAKEN_MOST = 512 };

/* Rectangles and leaders that nothing may lie over: left, top, right, bottom; leaders are upright lines. */
typedef struct taken_box {
    double at[4];
} taken_box;

typedef struct annotation {
    sheet                *page;
    const annotated_view *view;
    const sheet_values   *how;
    colour                ink, paper; /* letters and lines; what lies below them */
    double                letter;     /* size of letters, mm */
    uint32_t              group;
    taken_box             taken[TAKEN_MOST];
    size_t                taken_count;
    warnings             *warnings;
} annotation;

/* Where a point of the scene is on the sheet, mm; false behind the viewer. */
bool annotation_project(const annotation *a, const double point[3], double out[2]);
bool annotation_is_free(const annotation *a, const double box[4]);
void annotation_take(annotation *a, const double box[4]);
/* A filled rectangle. */
void annotation_fill(annotation *a, colour c, double left, double top, double right, double bottom);

/* labels.c, legend.c, bearings.c. Errors: LMN_MEMORY. */
lmn_status annotate_labels(annotation *a, lmn_error *error);
lmn_status annotate_legend(annotation *a, lmn_error *error);
void       annotate_north(annotation *a);
void       annotate_scale_bar(annotation *a);

#endif
