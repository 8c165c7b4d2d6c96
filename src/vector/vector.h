/* One drawing as vectors: strokes of all figures on a sheet, with a picture below them where surfaces need pixels.
 * Needs no GPU otherwise. */
#ifndef LIMNER_VECTOR_VECTOR_H
#define LIMNER_VECTOR_VECTOR_H

#include "base/warnings.h"
#include "draft/extras.h"
#include "limner/draw.h"
#include "limner/sheet.h"
#include "look/look.h"
#include "plan/camera.h"
#include "plan/facts.h"
#include "sheet/sheet.h"
#include "stroke/ribbon.h"
#include "trace/trace.h"

enum { VIEWS_MOST = 7, SHEET_VIEWS_MOST = VIEWS_MOST + DRAFT_EXTRAS_MOST };

/* One view of the scene on the sheet. */
typedef struct vector_view {
    char               name[24];  /* "front", "iso" …, "view" when the drawing says where the eye is, "section-A" */
    lmn_view           direction; /* where it is one of these */
    double             box[4];    /* on the sheet: x, y, width, height, mm */
    int                width, height; /* the same in pixels */
    view_camera        camera;
    const draft_extra *extra; /* what it is else; NULL: an ordinary view. Of the sheet */
    bool               apart; /* it lies beside those that are in line */
    double             scale; /* of details: millimetres of paper for one of the model; 0: the sheet's */
} vector_view;

struct lmn_sheet {
    sheet    page;
    warnings warnings;
    /* for the report */
    report_facts   facts;
    vector_view    views[SHEET_VIEWS_MOST];
    draft_extras   extras;
    size_t         view_count;
    double         scale;          /* millimetres of paper for one of the model; 0: perspective */
    char           scale_text[32]; /* "1:20"; empty: perspective */
    const char    *unit;           /* lasts */
    uint64_t      *part_strokes;   /* visible ones of each part */
    uint64_t      *part_marks;     /* dots and strokes on its surface */
    double         frame_ms;
    trace_facts    traces;
    bool           has_traces; /* some rule wants them */
    outline_search search;
    uint64_t       counts[STROKE_CLASS_COUNT], hidden;
    uint64_t       dots, marks; /* that lie on surfaces: dots, strokes */
    uint64_t       hatches;     /* lines on cut faces */
    uint64_t       centres;     /* centre lines and pitch circles */
    uint64_t       threads;     /* lines of their symbols */
    bool           verified;
    stroke_check   check;
};

/* Do the surfaces of the look need pixels? */
bool vector_needs_pixels(const lmn_look *look);

/* Draws the surfaces of the scene and look alone, without what vectors draw themselves: RGBA, row 0 on top,
 * desc->width times desc->height. `cut` (NULL: as the look says) is what is cut away, in the words of scene.cut. *out
 * is the caller's to free with mem_free. */
typedef lmn_status (*surfaces_fn)(uint8_t **out, const lmn_draw_desc *desc, const char *cut, void *user,
                                  lmn_error *error);

/* See limner/sheet.h; `draw_surfaces` (NULL: there is no renderer) is asked for the pixels below the lines;
 * arguments are checked but for what they say. */
lmn_status vector_draw(lmn_sheet **out, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                       const lmn_sheet_desc *wanted, surfaces_fn draw_surfaces, void *user, lmn_error *error);
char      *vector_report_json(const lmn_sheet *s);
void       vector_destroy(lmn_sheet **s);

/* A page, its orientation or its size in mm. Errors: LMN_USAGE. */
lmn_status vector_parse_page(const char *text, double out[2], lmn_error *error);

#endif
