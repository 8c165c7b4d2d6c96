/* Work for files: in a thread and with a renderer of its own, so that the window goes on meanwhile. Only scenes with
 * solids are drawn by the artist, who alone changes where these stand. */
#ifndef LIMNER_VIEW_ASIDE_H
#define LIMNER_VIEW_ASIDE_H

#include "artist.h"
#include "document.h"

typedef struct aside aside;

/* `work` runs on another thread; a renderer of NULL asks it to make its own. It passes `progress` on. `tell` and `done`
 * run on the main thread, `done` once whatever happens: LMN_CANCELLED also when the artist ended before. */
typedef struct aside_desc {
    artist           *artist;
    const scene_ref  *scene; /* both as they are now */
    const view_state *state;
    lmn_status (*work)(const scene_ref *scene, const view_state *state, lmn_renderer *renderer,
                       lmn_progress_fn progress, void *progress_user, void *user, lmn_error *error);
    void (*tell)(double fraction, void *user); /* some times a second; NULL: nobody is told */
    void (*done)(lmn_status status, const lmn_error *error, void *user);
    void *user;
} aside_desc;

/* Begins; what is returned is there until `done`. Main thread. */
aside *aside_begin(const aside_desc *desc);
void   aside_cancel(aside *a);

#endif
