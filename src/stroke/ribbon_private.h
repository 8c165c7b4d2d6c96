/* What the files of ribbons share: where along its chain a stroke is inked. Arcs are lengths along the chain,
 * units of the page. */
#ifndef LIMNER_STROKE_RIBBON_PRIVATE_H
#define LIMNER_STROKE_RIBBON_PRIVATE_H

#include "stroke/ribbon.h"

typedef struct span {
    float from, to;
} span;

/* Spans in order, apart from each other. Zero-initialise; the first failure sticks. */
typedef struct span_list {
    span  *items;
    size_t count, capacity;
    bool   failed;
} span_list;
void span_list_add(span_list *list, float from, float to);
void span_list_release(span_list *list);
/* What is in both lists; `out` is emptied first. */
void span_list_intersect(span_list *out, const span_list *a, const span_list *b);

/* A stretch of a stroke that is not drawn. */
typedef struct stroke_gap {
    uint32_t stroke;
    float    from, to;
} stroke_gap;
typedef struct gap_list {
    stroke_gap *items;
    size_t      count, capacity;
    bool        failed;
} gap_list;
void gap_list_add(gap_list *list, uint32_t stroke, float from, float to);
void gap_list_release(gap_list *list);
/* By stroke, then by position. */
void gap_list_sort(gap_list *list);

/* A chain: its strokes follow each other. */
typedef struct chain_facts {
    uint32_t first, count; /* strokes */
    bool     closed;
    float    length;
    size_t   first_corner, corner_count; /* in the job's */
} chain_facts;

/* How much of the page is inked around each position. Zero-initialise. */
typedef struct line_room {
    float *ink;             /* fraction, of cells; NULL: lines do not yield */
    float  left, top, cell; /* pixels */
    int    columns, rows;
    float  cover; /* the most of it */
} line_room;

typedef struct ribbon_job {
    const stroke_set      *strokes;
    const stroke_style    *style;
    uint32_t               seed;
    chain_facts           *chains;
    size_t                 chain_count;
    uint32_t              *chain_of; /* of each stroke */
    bool                  *drawn;    /* of each stroke: the style wants it */
    struct stroke_meeting *meetings; /* of both ends of each stroke */
    float                 *corners;  /* of chains that are dashed: arcs at which they turn */
    size_t                 corner_count, corner_capacity;
    line_room              room;
} ribbon_job;

/* What an end of a stroke comes to. */
typedef struct stroke_meeting {
    bool  meets;  /* another line is there; else it is free */
    float onward; /* from there to the other line's axis */
    float half;   /* of the widest line there, if that is narrower and goes on the same way: what this one thins out to;
                     else 0 */
} stroke_meeting;

/* Width of a stroke's line where nothing varies it. */
float ribbon_width(const ribbon_job *job, const stroke *s);

/* Strokes with those stretches in one that have nothing but what is thinner than the pen between them. Release strokes
 * and points with stroke_set_release. False: out of memory. */
bool ribbon_make_whole(stroke_set *out, const ribbon_job *job);

/* --- what lies where: the segments of visible strokes --- */
typedef struct ribbon_segment {
    uint32_t stroke, point;
} ribbon_segment;

typedef struct segment_grid {
    float           left, top, cell, depth_range;
    int             columns, rows;
    uint32_t       *starts; /* of each cell in `items`, one more at the end */
    ribbon_segment *items;  /* NULL: there is nothing */
} segment_grid;
bool segment_grid_build(segment_grid *g, const ribbon_job *job); /* false: out of memory */
void segment_grid_release(segment_grid *g);
/* The cells that a segment's box covers: first column, first row, last column, last row. False: it is nowhere. */
bool segment_grid_box(const segment_grid *g, const stroke_point *a, const stroke_point *b, float margin, int out[4]);
/* Long segments cover many cells of their box that they do not cross: a cell counts when its circle meets the line. */
bool segment_grid_meets(const segment_grid *g, const stroke_point *a, const stroke_point *b, float margin, int column,
                        int row);

/* Fills the job's meetings; they belong to the caller. False: out of memory. */
bool ribbon_find_meetings(ribbon_job *job, const segment_grid *grid);

/* Where a stroke passes behind a visible one. */
void ribbon_find_halos(gap_list *out, const ribbon_job *job, const segment_grid *grid);

/* Where hidden strokes are left out because more important lines are too near. */
void ribbon_find_crowds(gap_list *out, const ribbon_job *job);

/* What is left of the width of lines at a position: 0 … 1. */
float line_room_at(const line_room *room, float x, float y);
/* The same for a line of one width: of a few pens the one that half of the stroke has room for. */
float line_room_pen(const line_room *room, const stroke_set *set, const stroke *s);
bool  line_room_find(line_room *room, const ribbon_job *job); /* false: out of memory */
void  line_room_release(line_room *room);

/* Finds the corners of all chains, if dashes are wanted. False: out of memory. */
bool ribbon_find_corners(ribbon_job *job);

/* The cosine by which a stroke turns at a point, from what lies `reach` before it to what lies so far behind; 1 where
 * there is less. */
float ribbon_turn(const stroke_point *points, uint32_t count, uint32_t at, float reach);

/* --- how a hand draws strokes (ribbon_hand.c) --- */

/* From corner to corner: what a hand draws before it stops. */
typedef struct hand_pull {
    uint32_t first, count; /* points of hand_pulls */
    bool     cut[2];       /* it begins, ends at a corner of the stroke */
} hand_pull;

/* The pulls of one stroke. Zero-initialise. */
typedef struct hand_pulls {
    stroke_point *points; /* the stroke's; of closed ones three times round, arcs going on */
    hand_pull    *items;
    size_t        point_count, point_capacity, count, capacity;
    float         loop;  /* length of a closed stroke; 0: open */
    bool          round; /* closed and without corners: one pull, and where it begins is the hand's choice */
    bool          failed;
} hand_pulls;
void hand_pulls_find(hand_pulls *out, const stroke_set *set, const stroke *s);
void hand_pulls_release(hand_pulls *p);

enum { HAND_ROUNDS = 3, HAND_PIECES_MOST = 64 };

/* Does the style ask for a hand that draws pull by pull? */
bool hand_draws(const stroke_style *style);
/* How often it draws a pull of this length, where `pen` is left of the width. */
int hand_copies(const stroke_style *style, float length, float pen);
/* How much room there is beside a line, for its copies and for ends that run on: 0 where others run alongside, 1 where
 * none does. */
typedef struct hand_space {
    float copies, beyond;
} hand_space;
hand_space hand_space_beside(const ribbon_job *job, const segment_grid *grid, uint32_t own, const stroke_point *points,
                             uint32_t count);
/* How it draws where there is so much: nearer to the true line, fewer times, not far beyond corners. */
stroke_style hand_style_in(const stroke_style *style, hand_space space);

/* A pull, or where curves are long a piece of one, as it is drawn once. */
typedef struct hand_piece {
    float from, to;           /* arcs, without what it runs on */
    bool  inside[2];          /* goes on as the piece before, the next one */
    float lean[2][2], bow[2]; /* how far it lies off at both ends, and in the middle besides */
    float weight, opacity;    /* of the width; of the ink */
} hand_piece;
/* How many pieces a pull has. */
int hand_piece_count(const stroke_style *style, const hand_pulls *p, const hand_pull *pull, uint64_t key);
/* One of them; `key`: of the pull, `copy`: the how manieth time it is drawn. */
hand_piece hand_piece_of(const stroke_style *style, const hand_pulls *p, const hand_pull *pull, uint64_t key, int copy,
                         int index, int count);
/* How far a piece runs on at an end, or ends before it; straight ends run on. */
float hand_run_on(const stroke_style *style, const hand_piece *piece, bool at_end, bool straight, uint64_t key,
                  int copy);

/* −1 … 1, of a position in a row of random numbers. */
float ribbon_random(uint64_t key, int64_t position);

/* How long a dash of a stroke is, before it is fitted: never so short that it would be a dot. */
float ribbon_dash_length(const ribbon_job *job, const stroke *s);
/* The dashes of a stroke from arc `from` to `to`. */
void ribbon_dash(span_list *out, const ribbon_job *job, const stroke *s, const chain_facts *chain, float from,
                 float to);

/* Depth between two depths, at a fraction of the way on the page. */
float ribbon_depth_between(const ribbon_job *job, float a, float b, float fraction);

#endif
