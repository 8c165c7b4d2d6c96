/* One drawing as vectors: strokes of all figures on a sheet, with a picture below them where surfaces need pixels. Needs no GPU otherwise. */
#ifndef LIMNER_DRAW_VECTOR_H
#define LIMNER_DRAW_VECTOR_H

#include "draw/drawing.h"
#include "limner/sheet.h"
#include "sheet/sheet.h"
#include "stroke/ribbon.h"

enum { VIEWS_MOST = 7 };

/* One view of the scene on the sheet. */
typedef struct vector_view {
    const char *name;       /* "front", "iso" …, "view" when the drawing says where the eye is; lasts */
    lmn_view    direction;  /* where it is one of these */
    double      box[4];     /* on the sheet: x, y, width, height, mm */
    int         width, height; /* the same in pixels */
    view_camera camera;
} vector_view;

struct lmn_sheet {
    sheet       page;
    warnings    warnings;
    /* for the report */
    char       *look;
    uint32_t    seed;
    vector_view views[VIEWS_MOST];
    size_t      view_count;
    double      scale;      /* millimetres of paper for one of the model; 0: perspective */
    char        scale_text[32]; /* "1:20"; empty: perspective */
    const char *unit;       /* lasts */
    size_t      part_count;
    char      **part_names;
    uint64_t   *part_strokes; /* visible ones of each part */
    uint64_t    triangles;
    box3        bounds;
    double      load_ms, frame_ms;
    uint64_t    counts[STROKE_CLASS_COUNT], hidden;
    bool        verified;
    stroke_check check;
};

/* Do the surfaces of the look need pixels? */
bool vector_needs_pixels(const lmn_look *look);

/* See limner/sheet.h; arguments are checked but for what they say. */
lmn_status vector_draw(lmn_sheet **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc, const lmn_sheet_desc *wanted,
                       lmn_error *error);
char      *vector_report_json(const lmn_sheet *s);
void       vector_destroy(lmn_sheet **s);

#endif
