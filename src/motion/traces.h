/* What the technique `traces` and who draws it share. */
#ifndef LIMNER_MOTION_TRACES_H
#define LIMNER_MOTION_TRACES_H

#include "base/colour.h"
#include "motion/motion.h"

/* Where lines begin. */
typedef enum traces_origin {
    TRACES_OUTLINE,  /* rearmost position of the outline, at heights that are spread unevenly */
    TRACES_VERTICES, /* the rearmost vertex of each of equal strips (Hanl) */
    TRACES_CIRCLE    /* of what comes nearer or goes away, a circle around it (Song) */
} traces_origin;

/* How lines end: what their width and opacity do from the mover backwards. */
typedef enum traces_ends { TRACES_FADING, TRACES_HEAVY, TRACES_WEDGES } traces_ends;

/* Where flow lines go. */
typedef enum traces_flow { TRACES_PARALLEL, TRACES_CONVERGING } traces_flow;

/* When contours of the past are taken. */
typedef enum traces_moments { TRACES_AT_TIMES, TRACES_AT_LENGTHS, TRACES_TELLING, TRACES_AUTO } traces_moments;

/* What is drawn at those times. */
typedef enum traces_figures {
    TRACES_OUTLINES,
    TRACES_BONES,
    TRACES_POINTS,
    TRACES_SOLIDS,
    TRACES_SWEPT
} traces_figures;

/* Lengths in pixels of the picture, as all of a plan's look. */
typedef struct traces_values {
    motion_common common;
    colour        colour; /* NaN red: that of the rule's lines */
    float         width;
    int32_t       lines, origin, ends; /* lines: for each picture of a mover's figure */
    float         length, uneven, begin;
    int32_t       groups;
    float         group_apart, probability;
    int32_t       flow, flow_way;
    float         flow_length;
    int32_t       contours, moments, figures;
    param_words   bones;
    float         cover, fade, contour_width, contour_dash;
    int32_t       contour_brush; /* 0: that of the rule's lines; else a stroke_brush, from 1 on */
    bool          trailing, creases, in_front;
    int32_t       vibration;
    float         vibration_apart;
} traces_values;

#endif
