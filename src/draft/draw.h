/* Lines that draughtsmen add to a view: what all of them share. Kinds of lines and their parts are those of ISO 128-2,
 * in widths of the line. */
#ifndef LIMNER_DRAFT_DRAW_H
#define LIMNER_DRAFT_DRAW_H

#include "plan/camera.h"
#include "sheet/sheet.h"

/* A view in parallel projection on a sheet. Lent. */
typedef struct draft_view {
    sheet             *page;
    uint32_t           group; /* of what is drawn */
    const view_camera *camera;
    double             box[4]; /* x, y, width, height, mm */
    colour             ink;
    double             narrow, wide; /* lines, mm */
} draft_view;

/* A line of the groups of ISO 128-2 whose wide lines are so wide: 0.25, 0.35, 0.5 or 0.7 mm. */
#define DRAFT_GROUP_USUAL 0.5
bool draft_group_is_known(double wide);

/* Dash and gap of hidden lines (02.1), in widths of the line. */
#define DRAFT_HIDDEN_DASH 12.0
#define DRAFT_HIDDEN_GAP  3.0

/* Where a position of the world is on the sheet, mm. */
void draft_project(const draft_view *v, const double world[3], double out[2]);
/* How long a length of the world is on the sheet, mm. */
double draft_scale(const draft_view *v);
/* A direction of the world: across and up on the sheet (y down), and towards the eye. */
void draft_turn(const draft_view *v, const double world[3], double out[3]);

/* A long-dashed dotted line (04): begins and ends with a dash; too short for that, it is unbroken. `middle`: it has a
 * dash in its middle, where it crosses another one. */
void draft_chain_line(const draft_view *v, const double (*points)[2], size_t count, double width, bool middle);
/* The same around a whole circle. */
void draft_chain_circle(const draft_view *v, const double centre[2], double radius, double width);
void draft_line(const draft_view *v, const double a[2], const double b[2], double width);
/* The same through several places, at most 193; dashed as hidden lines are, if it is long enough. */
void draft_polyline(const draft_view *v, const double (*points)[2], size_t count, double width, bool hidden);
/* Part of a circle, angles from x to y of the sheet. */
void draft_arc(const draft_view *v, const double centre[2], double radius, double from, double sweep, double width);
/* A filled arrowhead of 15 degrees (ISO 129-1) with its tip at a place, pointing along a unit direction. */
void draft_arrow(const draft_view *v, const double tip[2], const double along[2], double length);

#endif
