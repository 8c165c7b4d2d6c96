/* What the files of vector drawings share. */
#ifndef LIMNER_VECTOR_VECTOR_PRIVATE_H
#define LIMNER_VECTOR_VECTOR_PRIVATE_H

#include "base/paper.h"
#include "stage/mark_ground.h"
#include "plan/plan.h"
#include "light/light.h"
#include "vector/vector.h"

/* --- page.c: what descriptions say in words ------------------------------------------------------ */

#define VECTOR_PIXELS_PER_MM (PX_PER_INCH / MM_PER_INCH)
enum { PAGE_SIDE_MOST = 4000 };  /* mm */
#define VECTOR_VERIFY_APART 2.0f /* pixels between samples */

/* "1:20": paper over model. Errors: LMN_USAGE. */
lmn_status vector_parse_scale(const char *text, double *out, lmn_error *error);
/* Names separated by commas, none twice. Errors: LMN_USAGE. */
lmn_status  vector_parse_views(const char *text, vector_view out[VIEWS_MOST], size_t *count, lmn_error *error);
const char *vector_view_name(lmn_view view);
/* The largest scale of ISO 5455 that is no larger. */
double vector_usual_scale(double scale);
/* "1:20", "2:1", "1:3.7". */
void vector_print_scale(char out[32], double scale);

/* --- layout.c: where views lie ------------------------------------------------------------------- */

/* What is asked of the layout. Lengths in mm, of the paper or of the model. */
typedef struct vector_layout {
    double    area[4]; /* on the sheet, x, y, width, height */
    double    gap;     /* between views */
    lmn_angle angle;
    double    scale; /* 0: as large as fits */
    bool      usual; /* one of the usual scales then */
    double    fit;   /* fraction of the area that is filled then */
} vector_layout;

/* Places views of these sizes (width, height of each, model mm) around the front view, and what lies apart beside or
 * below them. Sets their boxes, which have half a gap around the model, and the scales of details, and returns the
 * scale. */
double vector_place_views(const vector_layout *how, vector_view *views, size_t count, const double (*sizes)[2]);

/* --- style.c: looks as strokes ------------------------------------------------------------------- */

/* How the lines of a rule are drawn as strokes; false: it has none. */
bool vector_rule_strokes(const rule *r, stroke_options *options, stroke_style *style);
/* The same in widths of ISO 128-2: outlines and edges wide, `wide` mm, all else half as wide, hidden lines in its
 * dashes; without a hand's unevenness. */
void vector_style_in_group(stroke_style *style, double wide);
bool vector_rule_needs_pixels(const rule *r, colour ground);
/* The colour that fills a part's area: the surface's own, that of what is known about it (`datum`, may be NULL), the
 * material's else. sRGB. */
colour vector_fill_colour(const rule *r, const lmn_scene *scene, size_t part_index, const colour *datum);

/* --- ink.c: ribbons on the sheet ----------------------------------------------------------------- */

/* Puts ribbons into groups for what is hidden and what is visible, in these for each part and class. `sets` are
 * those of all rules of the view. */
typedef struct vector_ink {
    sheet           *page;
    const lmn_scene *scene;
    uint32_t         group;     /* of the view */
    double           origin[2]; /* of the view on the sheet, mm */
    bool             lines_only;
} vector_ink;
lmn_status vector_put_ribbons(const vector_ink *ink, const ribbon_set *sets, size_t set_count, lmn_error *error);

/* Draws one line after another: an even one by its axis with a width, another by its outline. `points` is the
 * caller's to free with mem_free. */
typedef struct vector_pen {
    const vector_ink *how;
    float (*points)[2];
    float *dashes;
    size_t count, capacity, dash_capacity;
    bool   failed;
} vector_pen;
void vector_pen_even(vector_pen *w, const ribbon_point *points, size_t count, const sheet_path *style);
void vector_pen_uneven(vector_pen *w, const ribbon_point *points, size_t count, ribbon_end end);

/* --- marks.c: dots and strokes that lie on surfaces ---------------------------------------------- */

/* The surface of a rule whose marks are drawn; NULL: it has none. */
const technique_use *vector_rule_marks(const rule *r);
/* Puts what is drawn of a rule's marks into groups of their own, one for each part. `options` says what and in
 * which view; its surface may leave the paper to the ground, and who hides what is `view`. */
typedef struct vector_marks {
    mark_page_options  options;
    const stroke_view *view;
    const struct cut  *cut;         /* what lies in it has none; NULL: nothing is cut away */
    colour             ground;      /* of the page, sRGB */
    bool               one_pen;     /* for plotters: all as wide as the look says, each on its own */
    uint64_t           dots, lines; /* out: how many */
    uint64_t          *part_marks;  /* out: added up for each part */
} vector_marks;
lmn_status vector_put_marks(const vector_ink *ink, vector_marks *m, lmn_error *error);
/* Does a position, world axes, lie in what is cut away, or at its border? */
bool vector_is_cut_away(const struct cut *c, const double p[3]);

/* --- hatch.c ------------------------------------------------------------------------------------- */

/* Hatches the cut faces of these parts as the look says, each in its colour, `loose` by one line after the other alone;
 * adds up how many lines these are, and says what rays make of them (`check`, may be NULL). Errors: LMN_MEMORY,
 * LMN_CANCELLED. */
lmn_status vector_put_hatch(const vector_ink *ink, const stroke_view *view, const scene_values *v, const bool *parts,
                            const colour *colours, bool loose, uint64_t *count, stroke_check *check, lmn_error *error);

/* --- order.c: for plotters ----------------------------------------------------------------------- */

/* Orders all lines of the sheet by pen, and those of a pen so that the way between them is short. Errors:
 * LMN_MEMORY. */
lmn_status vector_order_for_plotter(sheet *page, lmn_error *error);

/* --- page_frame.c ------------------------------------------------------------------------------------- */

/* Leaves room for frame and title: what is left of the page. */
/* Are there only fields that are known? Errors: LMN_USAGE. */
lmn_status vector_check_fields(const lmn_sheet_desc *wanted, lmn_error *error);
void       vector_inside_frame(const lmn_sheet_desc *wanted, double width, double height, double out[4]);
/* Lines of frames: as dark as the page is light. */
colour vector_frame_ink(colour ground);
void   vector_put_frame(lmn_sheet *facts, const lmn_sheet_desc *wanted, colour ink);

/* --- fill.c -------------------------------------------------------------------------------------- */

/* What is seen of each part, as areas. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status vector_put_fills(sheet *s, const vector_ink *ink, const vector_view *view, const stroke_scene *strokes,
                            const plan *plan, lmn_progress_fn progress, void *user, lmn_error *error);

#endif
