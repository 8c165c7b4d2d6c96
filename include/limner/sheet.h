/* Sheets: drawings as vectors. Lines with geometry, exact visibility and groups to edit, for the screen, for print,
 * for CAD and for plotters. */
#ifndef LIMNER_SHEET_H
#define LIMNER_SHEET_H

#include "limner/draw.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_sheet lmn_sheet;

/* How views are laid out around the front view: as the model turned away from the viewer (third angle, the top view
 * above), or as it rolls over the paper (first angle, the top view below). */
typedef enum lmn_angle { LMN_THIRD_ANGLE = 0, LMN_FIRST_ANGLE } lmn_angle;

/* What lies on the sheet. Initialise with LMN_SHEET_DESC_INIT. */
typedef struct lmn_sheet_desc {
    size_t      struct_size;
    const char *page;  /* "A4", "A3-landscape", "A5-portrait", "letter", "120x80mm"; NULL: the picture's size
                          at its resolution */
    const char *scale; /* "1:20", "2:1"; NULL: as large as fits. With a scale projection is parallel */
    const char *unit;  /* of the scene: "mm", "cm", "m", "in"; NULL: as the first file's format has it (glTF metres, all
                          others millimetres) */
    const char *views; /* "front,top,right,iso": a sheet of views in parallel projection, at one scale, aligned; NULL:
                          the drawing's own view */
    lmn_angle   angle;
    const char *title;   /* in a frame's title block, NULL: the file's name; without a frame below, NULL: none */
    bool        frame;   /* a frame and a title block with the scale */
    bool        plotter; /* lines alone, by pen, in an order that makes the pen's way short */
    bool
        lines_only; /* lines alone, by their middle: no pictures, no outlines of strokes. For DXF; plotter implies it */
    bool   fill;    /* the area of each part in its colour, below the lines */
    bool   verify;  /* check visibility of all strokes by casting rays; the report has the result */
    double smooth;  /* mm: lines are drawn as straight lines, arcs and cubics that are nowhere farther from them than
                       this, 0 to 10; 0: as polylines. Since 0.1 */
    /* Drafting (docs/DRAFTING.md), since 0.1: */
    double line_group; /* mm: widths of ISO 128-2, outlines and edges so wide, all else half of it: 0.25, 0.35, 0.5,
                          0.7; 0: those of the look */
    bool        centre_lines; /* of cylinders, and pitch circles */
    const char *sections;     /* "front@40%;top@half": views cut open, separated by ';'; NULL: none */
    const char *details;      /* "front@10,0,25/4/5:1": enlarged parts of views; NULL: none */
    const char *auxiliary;    /* "1,0,1;face@10,5,8": views along directions, or straight at a face; NULL: none */
    const char *fields;       /* "creator=A. Smith;number=4711": of the title block; NULL: none */
    bool        loose_hatch;  /* hatching of cut faces as one line after the other, for programs that know no patterns;
                                 else faces that are seen as a whole have a pattern. Plotters have lines. Since 0.1 */
    const char *threads; /* parts whose threads are drawn by their symbol (ISO 6410-1), a selector, "*": all; modelled
                            ones, and of parts called "M8" and the like those cylinders; matching no part is LMN_USAGE;
                            NULL: none. Since 0.1 */
} lmn_sheet_desc;
#define LMN_SHEET_DESC_INIT                                                                                            \
    {                                                                                                                  \
        sizeof(lmn_sheet_desc), NULL, NULL, NULL, NULL, LMN_THIRD_ANGLE, NULL, false, false, false, false, false,      \
            0.02, 0, false, NULL, NULL, NULL, NULL, false, NULL                                                        \
    }

/* Do the look's surfaces need pixels, which lie below the lines as a picture? When not, lmn_draw_sheet needs no
 * renderer. */
LMN_API bool lmn_look_needs_pixels(const lmn_look *look);

/* Width and height of a page in mm, by the names that lmn_sheet_desc.page takes. Errors: LMN_USAGE. Any thread. */
LMN_API lmn_status lmn_page_size(const char *page, double *width_mm, double *height_mm, lmn_error *error);

/* Draws a sheet. `renderer` may be NULL; then
 * surfaces that need pixels are left out, with a warning. `maps`, `profile` do not matter; `samples` does for
 * pictures below the lines. End it with lmn_sheet_destroy. Errors: LMN_USAGE (descriptions, selector, sections, a
 * time, a scale that leaves the page empty), LMN_UNSUPPORTED (solids), LMN_FORMAT (nothing to draw), LMN_LIMIT
 * (size), LMN_GL, LMN_MEMORY, LMN_CANCELLED. */
LMN_API lmn_status lmn_draw_sheet(lmn_sheet **out, lmn_renderer *renderer, const lmn_scene *scene, const lmn_look *look,
                                  const lmn_draw_desc *desc, const lmn_sheet_desc *sheet, lmn_error *error);

/* Writes a sheet. The format comes from `format` (".svg", ".pdf", ".dxf", with or without the dot) or, when that is
 * NULL, from the path's ending; path "-" is standard output, SVG unless `format` says otherwise. A file appears
 * whole or not at all; the same sheet gives the same bytes. `bytes` (may be NULL) gets the size. Errors: LMN_USAGE
 * (unknown format), LMN_WRITE, LMN_MEMORY. */
LMN_API lmn_status lmn_sheet_write(const lmn_sheet *sheet, const char *path, const char *format, uint64_t *bytes,
                                   lmn_error *error);

/* The same bytes in memory instead of a file: *bytes gets them, *size how many. `format` is as for lmn_sheet_write and
 * not NULL. Free them with lmn_bytes_free. Errors: LMN_USAGE (unknown format), LMN_MEMORY. Since 0.1. */
LMN_API lmn_status lmn_sheet_encode(const lmn_sheet *sheet, const char *format, uint8_t **bytes, size_t *size,
                                    lmn_error *error);

/* A format of drawings, and what it has room for. Texts last. */
typedef struct lmn_format_info {
    const char *ending;   /* ".svg" */
    const char *doc;      /* what it is, in a line */
    bool        vectors;  /* of sheets: lmn_sheet_write; else of pixels: lmn_drawing_write */
    bool        ground;   /* a background */
    bool        pictures; /* surfaces as pixels; a sheet for a format without them has `lines_only` */
    bool        areas;    /* of vectors: areas, as `fill` wants them */
    bool        title;    /* of vectors: a title, whether or not there is a frame */
} lmn_format_info;
/* One format by index from 0, for lists. False when out of range. Any thread. */
LMN_API bool lmn_format_at(size_t index, lmn_format_info *out);

/* The report as JSON (docs/reference/report.md). Free with lmn_text_free. NULL when memory is gone. */
LMN_API char *lmn_sheet_report_json(const lmn_sheet *sheet);

/* How many warnings the sheet has, and one of them as text (borrowed; NULL when out of range). */
LMN_API size_t      lmn_sheet_warning_count(const lmn_sheet *sheet);
LMN_API const char *lmn_sheet_warning_at(const lmn_sheet *sheet, size_t index, const char **code, size_t *count);

/* Frees a sheet and sets the handle to NULL; NULL and a pointer to NULL are accepted. */
LMN_API void lmn_sheet_destroy(lmn_sheet **sheet);

#ifdef __cplusplus
}
#endif
#endif
