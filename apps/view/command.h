/* What a state is as a command line and as a program in C: what a person copies, and what an export does. */
#ifndef LIMNER_VIEW_COMMAND_H
#define LIMNER_VIEW_COMMAND_H

#include "document.h"

/* A parameter of a look that is not as in the look it comes from. Free with g_free each text, then the array. */
typedef struct look_setting {
    char *key, *value; /* as --set and lmn_look_set take them */
} look_setting;

/* How `look` differs from its origin, as settings that make the one of the other, techniques first. NULL where none
 * do: rules were added, taken away or moved; then the look needs a file. Free with g_array_unref. */
GArray *look_settings(const look_ref *look);

/* The look as a file among the user's data, written when it is not there yet; NULL when that fails. g_free. */
char *look_keep(const look_ref *look, lmn_error *error);

/* What is drawn into which file. */
typedef struct export_wish {
    const char *path;
    int         width, height;
    double      dpi;     /* pixels an inch; 0: as suits, the longer side is 271 mm */
    int         samples; /* 0: as many as suit */
    bool        transparent;
    double      first, last, rate; /* of films: seconds, and frames a second */
    double      shown;             /* width : height of what is to be seen in any case; 0: as high as the state says */
} export_wish;

/* The ending says what a file becomes; `format` is that of its pages or frames. */
typedef enum wish_kind { WISH_UNKNOWN = 0, WISH_PICTURE, WISH_SHEET, WISH_FILM } wish_kind;
wish_kind wish_kind_of(const char *path, lmn_format_info *format);

/* Of a film, the numbers of its frames; frame i is at i/rate seconds. */
void wish_frames(const export_wish *wish, long *first, long *last);

/* As the command describes it; borrows from the state and from `selector`. What is narrower than `shown` is seen with a
 * wider angle. Of films the time is still missing. */
void wish_describe(const view_state *s, const scene_ref *scene, const export_wish *wish, const char *selector,
                   lmn_draw_desc *desc);

/* The words of `limner draw …` that makes the same bytes; NULL with an error. Free with g_strfreev. */
GStrv command_words(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error);

/* The words as a line for a shell. g_free. */
char *command_line(const char *const *words);

/* The same as a program in C. g_free; NULL with an error. */
char *command_in_c(const view_state *s, const scene_ref *scene, const export_wish *wish, lmn_error *error);

#endif
