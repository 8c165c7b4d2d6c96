/* The thread that draws. It owns the renderer; the interface asks it for work and never waits. Of waiting jobs the most
 * urgent is drawn first, and one that is drawn gives way to a more urgent one. */
#ifndef LIMNER_VIEW_ARTIST_H
#define LIMNER_VIEW_ARTIST_H

#include <glib.h>

#include "limner/limner.h"

typedef struct artist     artist;
typedef struct artist_job artist_job;

/* How urgent a job is: edits of the scene before all, pictures while something moves before those of rest. */
typedef enum artist_urgency {
    ARTIST_EDIT = 0,
    ARTIST_ASK,    /* what is seen at a pixel */
    ARTIST_MOVING, /* a picture that the next one will replace soon */
    ARTIST_REST,   /* the picture as it stays */
    ARTIST_ASIDE   /* thumbnails */
} artist_urgency;

/* What can be asked for; embedded as the first member of a larger one. All of it belongs to the artist from
 * artist_ask until `release`. */
struct artist_job {
    artist_urgency urgency;
    int            slot; /* a newer job of the same slot takes the place of one that waits; 0: none does */
    /* On the artist's thread. Passes artist_goes_on with the job as user to what takes a progress callback. */
    lmn_status (*draw)(artist_job *job, lmn_renderer *renderer, lmn_error *error);
    /* On the main thread, when it was drawn or failed; not when it was replaced or cancelled. */
    void (*done)(artist_job *job, lmn_status status, const lmn_error *error);
    void (*release)(artist_job *job); /* on the main thread, after `done` or instead of it */

    /* The artist's own. */
    artist    *of;
    lmn_status status;
    lmn_error  error;
    gint       dropped;
};

/* Starts the thread. NULL when it cannot be started. */
artist *artist_start(void);

/* Cancels everything, waits for the thread to end (a cancelled picture takes a moment) and releases the jobs. */
void artist_end(artist *a);

/* Asks for a job. Main thread. */
void artist_ask(artist *a, artist_job *job);

/* Drops the jobs of a slot, also one that is being drawn. */
void artist_drop(artist *a, int slot);

/* For lmn_draw_desc.progress: whether the job should go on. */
bool artist_goes_on(double fraction, const char *stage, void *job);

#endif
