/* What the command line sets in a look: ways to tell of motion, and single parameters. */
#ifndef LIMNER_CLI_SETS_H
#define LIMNER_CLI_SETS_H

#include <limner/look.h>
#include <limner/scene.h>

#include "options.h"

/* Parameters one after the other, techniques first. Errors are printed; the exit status. */
int set_all(lmn_look *look, const word_list *sets, bool has_cut);
/* The way to tell of motion, or the technique, of --motion (NULL: none), and of --poses (NULL: none). */
int set_motion(lmn_look *look, const char *way, const char *poses);
/* What --motion takes. */
void write_motion_doc(char *out, size_t size);
/* When the clips of --clip (NULL: the first one) end, seconds; 0: there are none. */
double clip_end(const lmn_scene *scene, const char *clips);

#endif
