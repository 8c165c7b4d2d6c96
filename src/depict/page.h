/* Flat signs on the page: stars, clouds, balloons, lettering. */
#ifndef LIMNER_DEPICT_PAGE_H
#define LIMNER_DEPICT_PAGE_H

#include "depict/depict_private.h"

/* A place in the world from which a sign extends across and up the page. */
typedef struct page_place {
    double at[3], right[3], up[3];
    double scale; /* units of the world there that show as one where it was lifted from */
} page_place;
/* The place that is seen where `at` is, `lift` units nearer to the viewer. */
void page_place_at(page_place *out, const depict_job *j, const double at[3], double lift);
void page_turn(page_place *p, double radians); /* counterclockwise */
void page_point(const page_place *p, double x, double y, double out[3]);
/* From the place to a position: across and up the page. */
void page_offset(const page_place *p, const double at[3], double out[2]);

/* Where on the page a position is seen, in half heights from its middle; false: behind the viewer. */
bool page_seen_at(const depict_job *j, const double at[3], double out[2]);
/* How deep before the viewer a position lies. */
double page_depth_of(const depict_job *j, const double at[3]);
/* What the page's height is there, units. */
double page_height(const depict_job *j, const double at[3]);
/* The position that is seen at a place of the page, so deep. */
void page_position(const depict_job *j, const double page[2], double depth, double out[3]);
/* Moves a rectangle on the page, in half heights, into it: nothing where the viewer steps back for signs. The distance
 * that it was moved. */
double page_keep_inside(const depict_job *j, double middle[2], const double half[2]);

/* A polygon that is star-shaped around (0, 0) of its place. */
void glyph_put_polygon(glyph_mesh *m, const page_place *p, const double (*points)[2], size_t count);
/* A star of spikes of seeded lengths, around `radius` long; `share` of each is drawn. */
typedef struct star {
    double radius, share;
    int    spikes;
} star;
void glyph_put_star(glyph_mesh *m, const depict_job *j, const expression *e, const page_place *p, uint32_t which,
                    const star *s);
/* A cloud with a rim of lobes. */
void glyph_put_cloud(glyph_mesh *m, const page_place *p, double half_width, double half_height, int lobes);

/* --- lettering.c -------------------------------------------------------------------------------------------------- */

#define LETTERING_FONT "sans:bold"

/* Lines of text, each around the middle, all around the place. */
typedef struct lettering_style {
    const char *text;   /* "|" begins a line */
    int         most;   /* letters in a line; longer ones are broken between words */
    double      height; /* of a capital */
    double      width;  /* it shrinks until it is no wider; 0: as wide as it is */
} lettering_style;
/* `size` gets its breadth and height. Lines that were set before are kept in the job's letterings. Errors: LMN_MEMORY,
 * and those of construct_text. */
lmn_status glyph_put_lettering(glyph_mesh *m, const depict_job *j, const page_place *p, const lettering_style *style,
                               double size[2], lmn_error *error);

/* --- burst.c: what bangs --------------------------------------------------------------------------------------------
 */

typedef struct burst_style {
    double      radius;
    int         spikes;
    bool        cloud; /* of dust, instead of a star */
    const char *text;  /* empty: none */
    colour      rim, colour, letters;
} burst_style;
/* A star or cloud seen where `at` is, `lift` units before it, with what it sounds like. */
lmn_status glyph_put_burst(depict_job *j, const expression *e, const double at[3], double lift, uint32_t which,
                           const burst_style *style, glyph_tense when, lmn_error *error);

#endif
