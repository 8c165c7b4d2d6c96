/* What the files that draw a frame share: profile.c, lighting.c, bind.c, raster.c, passes.c, mirror.c, collect.c and frame.c. */
#ifndef LIMNER_DRAW_FRAME_PRIVATE_H
#define LIMNER_DRAW_FRAME_PRIVATE_H

#include "draw/frame.h"
#include "draw/uniforms.h"

/* A figure while it is drawn: its pictures and its range of depth. */
typedef struct figure_state {
    const figure *figure;
    gpu_texture  *targets[TARGET_COUNT];
    gpu_texture  *geometry;  /* the normal-depth buffer as it was drawn; techniques may filter a copy of it */
    float        *edges;     /* for maps: darkest of all line techniques' edge maps, 4 a pixel */
    int           pixels[4]; /* where the figure and its lines can be: scissor */
    int           around[4]; /* what passes there can look at: cleared */
    double        near, far;
} figure_state;

/* --- profile.c: times of passes --- */
typedef struct stopwatch {
    double   start;
    uint64_t draws;
} stopwatch;
stopwatch watch_start(frame *f);
void      watch_stop(frame *f, stopwatch w, const char *group, const char *name);

/* --- lighting.c: the scene's lights --- */
void lights_declare(text *prelude, const frame *f);
void lights_set(frame *f);

/* --- bind.c: what programs of all passes get --- */
gpu_texture         *frame_acquire(frame *f, target t);
void                 frame_set_common(frame *f, const figure_state *s);
/* The program of these files with this prelude, which is used up; NULL after an error. */
gpu_program         *program_of(frame *f, const char *vertex, const char *fragment, text *prelude);
param_set            use_own_set(kind_id id, const technique_use *use);
param_set            use_common_set(kind_id id, const technique_use *use);
const technique_use *rule_inked_lines(const rule *r); /* the line technique that a composition inks, or NULL */
const pass          *rule_merged_detection(const rule *r); /* the pass that the composition does itself, or NULL */
/* Declares, or sets, the pictures that these passes read and that are there; either pass may be NULL. */
void                 reads_declare(text *prelude, const frame *f, const figure_state *s, const pass *a, const pass *b);
void                 reads_set(frame *f, const figure_state *s, const pass *a, const pass *b);
bool                 pass_applies(kind_id id, const pass *p, const technique_use *use);
gpu_texture         *target_of(const frame *f, const figure_state *s, target t);

/* --- raster.c: the geometry pass --- */
void raster_figure(frame *f, figure_state *s);  /* G-buffer, and shade unless deferred */
void raster_direct(frame *f, figure_state *s);  /* straight onto the page */
void raster_inked(frame *f, figure_state *s, const pass *inking); /* onto the page, shaded and inked */
void raster_shade_deferred(frame *f, figure_state *s);

/* --- passes.c: declared passes --- */
void passes_run_kind(frame *f, figure_state *s, kind_id id);

/* --- mirror.c --- */
/* Makes a frame of what the mirror's plane shows, without pictures to draw into; false when the part has no plane. */
bool mirror_prepare(const frame *f, const figure *mirror, frame *inner);

/* --- collect.c: maps --- */
void collect_edges(frame *f, figure_state *s);
void collect_figure(frame *f, figure_state *s);

#endif
