/* What the files that make one vector drawing share. */
#ifndef LIMNER_VECTOR_VECTOR_JOB_H
#define LIMNER_VECTOR_VECTOR_JOB_H

#include "draft/centres.h"
#include "draft/cylinder_fit.h"
#include "draft/threads.h"
#include "plan/round_scene.h"
#include "plan/deformation.h"
#include "plan/round_scene.h"
#include "plan/section.h"
#include "plan/time.h"
#include "vector/vector_private.h"

/* What one drawing needs while it is made. */
typedef struct vector_job {
    lmn_sheet            *out;
    surfaces_fn           draw_surfaces; /* NULL: nobody can */
    void                 *user;
    pose                  pose;
    pose_deformation      deformation; /* that the pose's moment asks for */
    swept_boxes           swept;
    plan                  plan;
    const lmn_scene      *scene;
    round_scene           round; /* what `scene` is where the look wants it so */
    const lmn_look       *look;
    const lmn_draw_desc  *desc;
    const lmn_sheet_desc *wanted;
    lmn_sheet_desc        filled; /* that, with what the files' headers say, of which the next two are */
    char                 *fields;
    char                  title[128];
    bool                  lines_only, pixels, usual_scale;
    double                scale; /* 0: as large as fits */
    double                unit_mm;
    bool                  unit_stated;
    bool                 *stroked; /* per part: drawn by some rule */
    section               section;
    stroke_scene          strokes;
    const stroke_scene   *shown;     /* the one of the view at hand: a section has its own */
    const draft_extra    *cut_open;  /* the section at hand; NULL: none */
    const bool           *spared;    /* per part: what the section at hand leaves whole; NULL: none */
    draft_cylinders       cylinders; /* of all that is drawn, uncut; with centre lines */
    draft_pitches         pitches;
    draft_thread_scene    smooth;   /* what `scene` is where threads are drawn by their symbol */
    draft_threads         threads;  /* these, in the world */
    bool                 *threaded; /* per part: its threads are drawn so; NULL: none */
    stroke_scene          as_is;    /* the same where `strokes` is refined and marks lie on what is not; else empty */
    double                begun, fraction, reported; /* progress: of the stage at hand, and the most that was told */
} vector_job;

/* --- views.c --- */
/* The description that a view's camera is placed by. */
lmn_draw_desc vector_view_desc(const vector_job *j, const vector_view *v);
/* Width and height of the model as a view shows it, its unit. */
lmn_status vector_measure_view(const vector_job *j, const vector_view *v, double out[2], lmn_error *error);
/* Says which views there are, and where they lie. */
lmn_status vector_place_all(vector_job *j, lmn_error *error);
/* The largest usual scale at which all views lie on the page; 0: there is none. */
double vector_scale_that_fits(const vector_job *j, lmn_error *error);

/* --- drafting.c --- */
enum { VECTOR_CUT_TEXT_SIZE = 2 * DRAFT_CUT_SIZE };
/* What a look cuts away and a section besides, in words. */
void vector_cut_text(const vector_job *j, const draft_extra *extra, char *out, size_t size);
/* The same as it is cut. Errors: LMN_USAGE, LMN_MEMORY. */
lmn_status vector_section(section *out, const vector_job *j, const draft_extra *extra, lmn_error *error);
/* Where a section turns there is no edge: lines of cut faces that are seen from the side are none. */
void vector_hide_turns(stroke_scene *scene, const draft_extra *extra);
/* Rims of cut faces are borders where what is cut is seen exactly from the side, all along: else they would be outlines
 * and creases by turns, as rounding has it. */
void vector_settle_rims(stroke_scene *scene, const draft_extra *extra);
/* Where the face nearest to a position looks. Errors: LMN_USAGE (there are none), LMN_MEMORY. */
lmn_status vector_face_normal(const vector_job *j, const double at[3], double out[3], lmn_error *error);
/* Puts what the headers of the files say into a title block, where the caller says nothing. Errors: LMN_MEMORY. */
lmn_status vector_take_header(vector_job *j, lmn_error *error);
/* Finds cylinders when centre lines are wanted. Errors: LMN_MEMORY, LMN_CANCELLED. */
lmn_status vector_find_axes(vector_job *j, lmn_error *error);
/* Centre lines of a view. `cut`: what is not there in it. Errors: LMN_MEMORY. */
lmn_status vector_put_centres(vector_job *j, const vector_view *v, const stroke_view *view, const cut *cut,
                              uint32_t group, lmn_error *error);
/* Makes the threads smooth that are drawn by their symbol. Errors: LMN_USAGE (selector), LMN_MEMORY, LMN_CANCELLED. */
lmn_status vector_smooth_threads(vector_job *j, lmn_error *error);
/* Where threads are, once cylinders are known. `scene`: uncut. Errors: LMN_MEMORY. */
lmn_status vector_find_threads(vector_job *j, const stroke_scene *scene, lmn_error *error);
/* Their symbols on a view. `cut`: what is not there in it. Errors: LMN_MEMORY. */
lmn_status vector_put_threads(vector_job *j, const vector_view *v, const stroke_view *view, const cut *cut,
                              uint32_t group, lmn_error *error);
/* Does the rule of a part draw hidden lines? `part`: id. */
bool vector_draws_hidden(const vector_job *j, uint32_t part);
/* Sections that lie turned in a view. Errors: LMN_USAGE, LMN_MEMORY, LMN_CANCELLED. */
lmn_status vector_put_revolved(vector_job *j, const vector_view *v, uint32_t group, lmn_error *error);
/* Once all views are drawn: cutting planes, circles around details, arrows, letters. */
void vector_put_marks_of_views(vector_job *j);
/* A view of the sheet as those who draw on it see it. */
draft_view vector_drafting_view(const vector_job *j, const vector_view *v, uint32_t group);
/* Widths of lines: wide and narrow ones, mm. */
double vector_wide(const vector_job *j);
double vector_narrow(const vector_job *j);

#endif
