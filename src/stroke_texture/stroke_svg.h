/* Reading SVG drawings: what its files share. */
#ifndef LIMNER_STROKE_TEXTURE_STROKE_SVG_H
#define LIMNER_STROKE_TEXTURE_STROKE_SVG_H

#include "stroke_texture/strokes_private.h"

typedef struct svg_point {
    double x, y;
} svg_point;

/* x' = a x + c y + e, y' = b x + d y + f: the order of SVG's matrix(). */
typedef struct svg_transform {
    double a, b, c, d, e, f;
} svg_transform;

static const svg_transform svg_identity = {1, 0, 0, 1, 0, 0};

svg_transform svg_combine(svg_transform outer, svg_transform inner);
svg_point     svg_apply(const svg_transform *t, svg_point p);
/* A transform attribute. False: it is wrong. */
bool svg_parse_transform(const char *text, svg_transform *out);
/* Numbers with blanks or a comma between. Returns the position behind the number, NULL where there is none. */
const char *svg_number(const char *at, double *out);
const char *svg_skip_blanks(const char *at);

/* Takes chords one after another, in the drawing's coordinates; the first failure sticks. */
typedef struct svg_pen {
    svg_transform transform;
    svg_point     at, subpath; /* before the transform */
    bool          drawn;       /* has the subpath got a line command? */
    bool          marked;      /* … and a chord that can be seen? */
    double        tolerance;   /* of curves, in the drawing's coordinates; 0: a few chords are enough */
    /* False: stop. A chord without length is a dot. */
    bool (*chord)(void *user, svg_point from, svg_point to);
    void *user;
    bool  failed;
} svg_pen;

void svg_move(svg_pen *pen, svg_point to);
void svg_line(svg_pen *pen, svg_point to);
void svg_cubic(svg_pen *pen, svg_point a, svg_point b, svg_point to);
void svg_quadratic(svg_pen *pen, svg_point a, svg_point to);
void svg_arc(svg_pen *pen, double rx, double ry, double degrees, bool large, bool sweep, svg_point to);
void svg_close(svg_pen *pen);
/* Ends what was begun: a subpath without extent becomes a dot. */
void svg_finish(svg_pen *pen);
/* The d attribute. False: it is wrong from some position on; what stands before it has been drawn, as SVG wants it. */
bool svg_path(svg_pen *pen, const char *d);

#endif
