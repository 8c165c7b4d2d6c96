/* Asks what is seen at a pixel of a document's picture; the answer comes on the window's thread. */
#ifndef LIMNER_VIEW_PICKING_H
#define LIMNER_VIEW_PICKING_H

#include <glib-object.h>

#include "artist.h"
#include "document.h"

typedef enum pick_use { PICK_SELECT, PICK_CENTRE, PICK_MENU, PICK_DROP } pick_use;

/* What is asked, and what for. */
typedef struct pick_wish {
    int       width, height, x, y; /* of the picture, in its pixels */
    pick_use  use;
    look_ref *dropped; /* PICK_DROP: the look; else NULL */
} pick_wish;

/* Not called when the question was overtaken by another one, or could not be answered. */
typedef void (*pick_answer)(GObject *owner, const pick_wish *wish, const lmn_pick *pick);

/* Holds `owner` until then; takes `wish->dropped`. */
void pick_ask(artist *a, const document *d, const pick_wish *wish, int slot, GObject *owner, pick_answer answer);

#endif
