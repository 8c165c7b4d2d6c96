/* Looks as files: saved where a person says, and loaded from there. */
#ifndef LIMNER_VIEW_LOOK_FILES_H
#define LIMNER_VIEW_LOOK_FILES_H

#include "window.h"

void look_files_save(ViewWindow *w);
void look_files_load(ViewWindow *w);

/* From now on a look that comes from a file is read again when the file changes. Once a window. */
void look_files_watch(ViewWindow *w);

/* The user's looks, which the gallery shows, too; made when it is missing. g_free. */
char *look_files_folder(void);

#endif
