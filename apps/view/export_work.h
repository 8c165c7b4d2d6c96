/* Drawing into files: what a wish asks for, with what a state shows, as the command would. No window. */
#ifndef LIMNER_VIEW_EXPORT_WORK_H
#define LIMNER_VIEW_EXPORT_WORK_H

#include "command.h"

/* The kinds of files there are: ".png" …; films only where what makes them is installed. Free with g_strfreev. */
GStrv export_endings(void);
bool  export_is_film(const char *path);

/* Draws and writes; any thread, with a renderer that nobody else uses meanwhile, or NULL: one is made where it is
 * needed. Solids are drawn as the scene has them now (scene_ref_edit). `progress` may cancel. The file appears whole
 * or not at all. Errors: those of lmn_draw, lmn_draw_sheet, lmn_film_open and of writing. */
lmn_status export_draw(const scene_ref *scene, const view_state *s, const export_wish *wish, lmn_renderer *renderer,
                       lmn_progress_fn progress, void *user, lmn_error *error);

/* The same without a file, as a picture whatever the wish's path. */
lmn_status export_picture(lmn_drawing **out, const scene_ref *scene, const view_state *s, export_wish wish,
                          lmn_renderer *renderer, lmn_progress_fn progress, void *user, lmn_error *error);

#endif
