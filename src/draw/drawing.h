/* Drawings: the finished picture with its report, and the bench. */
#ifndef LIMNER_DRAW_DRAWING_H
#define LIMNER_DRAW_DRAWING_H

#include "draw/session.h"
#include "plan/facts.h"
#include "sheet/sheet.h"

struct lmn_drawing {
    int            width, height;
    uint8_t       *pixels;      /* RGBA, row 0 on top; NULL: kept on the GPU and not read back */
    sheet          annotations; /* laid over the picture when it is read back */
    frame_maps     maps;        /* all NULL unless asked for */
    kept_textures *kept;        /* NULL: none */
    warnings       warnings;
    /* for the report */
    report_facts   facts;
    view_camera    camera;
    char          *vendor, *renderer, *version;
    uint64_t      *part_pixels; /* per part; NULL unless profiled */
    double         frame_ms;
    gpu_profile    profile;
    outline_search search;
    mark_facts     marks;
    uint64_t       strokes[STROKE_CLASS_COUNT]; /* drawn, where they were chained */
    trace_facts    traces;
    bool           has_traces; /* some rule wants them */
    int            layers;
    const char    *producer; /* of layers, a name that lasts; NULL: nothing is seen through */
    size_t         programs; /* compiled by the renderer so far */
};

lmn_status renderer_draw(lmn_drawing **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                         const draw_options *options, lmn_error *error);
/* Refuses what the look cannot draw of what is in the session, or with desc->lenient warns of it. Errors:
 * LMN_UNSUPPORTED, LMN_USAGE. */
lmn_status drawing_refuse(const session *s, const lmn_scene *scene, const lmn_look *look, const lmn_draw_desc *desc,
                          warnings *warnings, lmn_error *error);
/* Of a drawing whose textures are there. */
lmn_status drawing_read_back(lmn_drawing *d, lmn_error *error);
char      *renderer_json(const lmn_renderer *r);
char      *drawing_report_json(const lmn_drawing *d);
void       drawing_destroy(lmn_drawing **d);

lmn_status bench_json(char **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *const *looks, size_t count,
                      const lmn_look *plain, const lmn_draw_desc *desc, int repeat, lmn_error *error);

#endif
