/* Neutral output: what lies on a sheet of paper, in the order in which it is drawn. Everything that writes vectors
 * sees only this. Origin at the top left, x to the right, y down, in millimetres. Arrays belong to the sheet. */
#ifndef LIMNER_SHEET_SHEET_H
#define LIMNER_SHEET_SHEET_H

#include "base/colour.h"
#include "base/error.h"

typedef enum sheet_kind { SHEET_PATH, SHEET_DOTS, SHEET_IMAGE, SHEET_TEXT } sheet_kind;
typedef enum sheet_cap { SHEET_CAP_ROUND, SHEET_CAP_BUTT } sheet_cap;

/* A piece of a curve, from where the one before ends. */
typedef enum sheet_piece_kind { SHEET_LINE, SHEET_ARC, SHEET_CUBIC } sheet_piece_kind;
typedef struct sheet_piece {
    sheet_piece_kind kind;
    double           end[2];
    double           controls[2][2]; /* of cubics */
    /* Of arcs: at an angle t lies centre + turned by `turn` (radii[0] cos t, radii[1] sin t); from `from` to from +
     * sweep, radians, growing from x to y. Circles have equal radii and no turn. */
    double centre[2], radii[2], turn, from, sweep;
} sheet_piece;

/* A run of points: lines between them, or dots at them. */
typedef struct sheet_path {
    uint32_t first, count; /* in the sheet's points */
    bool closed, filled; /* filled: the area that it and the other paths of its item run around (holes run the other way
                            round); else a line */
    bool      curved;    /* it stands for a curve, which sheet_fit may put in its place */
    float     width;     /* of a line, or diameter of dots, mm */
    sheet_cap cap;
    uint32_t  first_dash, dash_count;   /* of the sheet's dashes; 0: unbroken */
    float     phase;                    /* arc at which the pattern is where the path begins, mm */
    uint32_t  first_piece, piece_count; /* of the sheet's pieces, instead of lines between the points; the first begins
                                           at the first point, the last of a closed path ends there */
} sheet_path;

/* Lines that fill an area instead of ink: all over it at multiples of `apart` from one through `origin`, along an angle
 * (radians, from x to y). mm. */
typedef struct sheet_hatch {
    double apart, angle, origin[2], width; /* apart 0: ink */
} sheet_hatch;

typedef struct sheet_item {
    sheet_kind  kind;
    uint32_t    group;        /* in the sheet's groups */
    colour      ink;          /* sRGB, straight alpha */
    uint64_t    id;           /* 0: none; it names the item */
    uint32_t    first, count; /* paths */
    sheet_hatch hatch;        /* of areas */
    /* images: PNG bytes, owned; position and size */
    unsigned char *png;
    size_t         png_size;
    double         box[4]; /* x, y, width, height */
    /* text, owned; box[0], box[1] is where its baseline begins, box[3] its size */
    char   *text;
    int32_t anchor; /* −1 begins there, 0 is centred, 1 ends there */
} sheet_item;

/* What belongs together: a view, a part in it, a class of lines of that part. Groups form a tree; a group comes
 * behind its parent. */
typedef struct sheet_group {
    int32_t  parent;    /* −1: none */
    char    *name;      /* "view-front", the part's name, "contour"; owned */
    char    *css_class; /* NULL or names of classes, owned */
    uint32_t part;      /* id; 0: none */
    double   clip[4];   /* x, y, width, height; width 0: not cut */
} sheet_group;

typedef struct sheet {
    double       width, height;       /* mm */
    double       pixels_per_mm;       /* of the page that the drawing was made for */
    colour       ground;              /* alpha 0: none */
    char        *title, *description; /* owned; NULL: none */
    sheet_group *groups;
    size_t       group_count, group_capacity;
    sheet_item  *items;
    size_t       item_count, item_capacity;
    sheet_path  *paths;
    size_t       path_count, path_capacity;
    float (*points)[2];
    size_t       point_count, point_capacity;
    float       *dashes; /* mm: ink, gap, ink …, again and again along the path */
    size_t       dash_count, dash_capacity;
    sheet_piece *pieces;
    size_t       piece_count, piece_capacity;
    bool         failed; /* memory was gone: later calls did nothing, and the sheet is not whole */
} sheet;

/* An empty sheet. What is not finite, or not above 0, becomes 1 mm. */
void sheet_begin(sheet *s, double width, double height, double pixels_per_mm);
void sheet_release(sheet *s);

/* --- building: groups first, then items, then what is in the last item. The first failure sticks in `failed`. Texts
 * are copied --- */

void sheet_set_title(sheet *s, const char *title, const char *description);
/* Returns the group's number. `css_class` may be NULL. Parents come first; a parent that is not there is none. */
uint32_t sheet_add_group(sheet *s, int32_t parent, const char *name, const char *css_class, uint32_t part);
/* Cuts the group to a rectangle. */
void sheet_clip_group(sheet *s, uint32_t group, double x, double y, double width, double height);

/* Begins an item of paths or dots. */
void sheet_add_item(sheet *s, sheet_kind kind, uint32_t group, colour ink, uint64_t id);
/* Begins an item of areas that are hatched. What says nothing (distance or width not above 0, not finite) is ink. */
void sheet_add_hatch(sheet *s, uint32_t group, colour ink, const sheet_hatch *hatch);
/* Adds a path to the last item, drawn as `style` says (what it has of the sheet's arrays does not matter). Where points
 * are not finite it is broken. Lines of one point are left out; dots are not. */
void sheet_add_path(sheet *s, const sheet_path *style, const float (*points)[2], size_t count);
/* Breaks the line that was added last into dashes: `lengths` of ink and gap in turn, an even number of them, none below
 * 0 and some of each above it; else it stays unbroken. */
void sheet_dash_path(sheet *s, const float *lengths, size_t count, float phase);
/* PNG bytes of one picture. */
void sheet_add_image(sheet *s, uint32_t group, const unsigned char *png, size_t size, double x, double y, double width,
                     double height);
/* One line of text of this size (the height of its letters from baseline to baseline), its baseline beginning at
 * (x, y). */
void sheet_add_text(sheet *s, uint32_t group, colour ink, const char *utf8, double x, double y, double size,
                    int anchor);

/* A rectangle as a closed line, and a line from a to b: what frames are made of. */
void sheet_add_rectangle(sheet *s, uint32_t group, colour ink, double x, double y, double width, double height,
                         double line_width);
void sheet_add_line(sheet *s, uint32_t group, colour ink, const double a[2], const double b[2], double line_width);

/* Cuts lines, areas and dots at a box: what lies outside is gone. Pictures and texts stay. True when there was
 * anything outside. */
bool sheet_clip(sheet *s, double x, double y, double width, double height);

/* The same at a circle, of what was added from an item on; pictures stay, and areas are cut at a polygon. */
bool sheet_clip_circle(sheet *s, size_t first_item, const double centre[2], double radius);

#endif
