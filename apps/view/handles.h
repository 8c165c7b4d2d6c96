/* Handles that lie over the picture and are dragged: of the look's section, and of the marked node of a solid, which
 * they move along the axes of the scene and turn around them. Positions in the widget's pixels. */
#ifndef LIMNER_VIEW_HANDLES_H
#define LIMNER_VIEW_HANDLES_H

#include <gtk/gtk.h>

#include "document.h"
#include "section.h"

typedef enum handle_kind { HANDLE_NONE = 0, HANDLE_SECTION, HANDLE_MOVE, HANDLE_TURN } handle_kind;

/* `place.step`: by how many pixels a percentage, a length of one or a radian more moves it. */
typedef struct handle {
    handle_kind    kind;
    section_handle place;
} handle;

typedef struct handles {
    document   *document; /* borrowed */
    section     section;  /* the look's */
    handle      held;     /* kind HANDLE_NONE: none is */
    section     section_begin;
    node_handle node_begin; /* both as they were when the drag began */
} handles;

/* After the look has changed. */
void handles_read_look(handles *h);

/* Is one there, on a picture of this size? */
bool handles_is_at(const handles *h, double x, double y, int width, int height);

/* Holds the one that is there; false: none. */
bool handles_take(handles *h, double x, double y, int width, int height);

/* What is held is so far from where it was taken. `steps`: turns go by 15 degrees. */
void handles_drag(handles *h, double dx, double dy, bool steps);

void handles_snapshot(const handles *h, GtkSnapshot *snapshot, int width, int height);

#endif
