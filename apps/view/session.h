/* What is there again after the viewer was closed: files, look, view, the window's size. Kept in the user's state
 * folder; what cannot be read is left as it is by default. */
#ifndef LIMNER_VIEW_SESSION_H
#define LIMNER_VIEW_SESSION_H

#include "document.h"

typedef struct session {
    GStrv paths; /* NULL: there were none */
    char *look;  /* as JSON; NULL: none */
    orbit view;
    bool  has_view;
    int   width, height; /* of the window; 0: by default */
    bool  maximized, lists, panel;
} session;

session session_read(void);
void    session_write(const session *s);
void    session_clear(session *s);

#endif
