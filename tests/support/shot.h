/* A drawing made through the public API, with its maps and its report. All pictures have row 0 on top. */
#ifndef TRUTH_SHOT_H
#define TRUTH_SHOT_H

#include <stdbool.h>
#include <stdint.h>

#include "vec.h"

struct shape;

typedef struct shot_view {
    int         width, height;
    dvec        eye, target, up;
    bool        orthographic;
    double      fov_deg; /* 0: the default */
    int         samples; /* 0: 1 */
    bool        without_maps;
    bool        es;
    bool        bare;    /* no eye: the named view */
    int         named;   /* with bare: an lmn_view; 0 is iso */
    bool        profile; /* the report lists passes */
    uint32_t    seed;
    double      time_s;
    double      dpi;    /* pixels to an inch of paper; 0: 96 */
    const char *select; /* draws these parts alone; NULL: all */
} shot_view;

/* The maps of one depth layer, as in shot. */
typedef struct shot_layer {
    float *depth;
    float (*normal)[3];
    uint16_t *id;
    uint8_t  *edge, *shade;
    float    *found_depth; /* as compositions find them; NULL where nothing is perturbed */
    uint8_t  *found_edge, *found_shade;
} shot_layer;

typedef struct shot {
    int      width, height;
    uint8_t *picture, *edge, *shade; /* RGBA8 */
    float   *depth;                  /* eye depth, infinite where empty */
    float (*normal)[3];
    float (*uncertainty)[3]; /* right, up, pressure; NULL when nothing is perturbed */
    float (*direction)[3]; /* s · (cos 2θ, sin 2θ) of strokes on the page, θ from the right to the top; NULL where no
                              surface asks for it */
    uint16_t   *id;
    double      view[16], projection[16], near_depth, far_depth;
    bool        orthographic;
    char       *report;
    shot_layer *layers;       /* those for which maps were written */
    int         layer_count;  /* how many */
    int         layers_drawn; /* what the report says */
    char        layer_producer[16];
} shot;

/* Draws a model file with a look (JSON text, or the name of a look that ships when it does not begin with '{').
 * False, with a failed check, when anything goes wrong. `changes` is a NULL-terminated list KEY, VALUE, KEY, VALUE
 * …, or NULL. */
bool shot_take(shot *out, const char *model, const char *look, const char *const *changes, const shot_view *view);
void shot_release(shot *s);

/* The same for a shape, which is written to `file` in the program's folder first. */
bool shot_of_shape(shot *out, const struct shape *s, const char *file, const char *look, const char *const *changes,
                   const shot_view *view);

/* A look with one flat white rule, white ground and these lines (an object's JSON, or NULL); valid until the fourth
 * next call. */
const char *shot_line_look(const char *lines);

/* A shot that nobody drew: matrices of the view, an edge map without ink, the given depth range. For trying out
 * references. */
void shot_blank(shot *out, const shot_view *view, double near_depth, double far_depth);

/* How many values of two pictures of one size are farther apart than this. */
int shot_differing(const shot *a, const shot *b, int tolerance);

/* Does the report have a warning with this code? */
bool shot_has_warning(const shot *s, const char *code);

/* Ends the renderers; call before the program ends so that leak checkers stay quiet. */
void shot_end(void);

/* Where a point of the scene is on the picture, pixels, row 0 on top. */
void shot_on_page(const shot *s, dvec point, double out[2]);

/* The ray through a pixel position (in pixels, row 0 on top): origin on the near plane, direction not normalised. */
void shot_ray(const shot *s, double x, double y, dvec *origin, dvec *direction);

/* A point on the picture in pixels; z is the clip-space w, so that z <= 0 lies behind the viewer. */
dvec shot_project(const shot *s, dvec point);

/* Eye-space vector or point (w 0 or 1). */
dvec shot_to_eye(const shot *s, dvec v, double w);

/* Where the viewer is, or for parallel rays (w 0) the direction towards the viewer. */
dvec shot_viewer(const shot *s, double *w);

/* The smallest of the combined and the id channel: what counts as ink when <= 127. */
int shot_ink(const shot *s, int x, int y);

#endif
