/* Signs for what happens in a scene. */
#ifndef LIMNER_CLI_DEPICT_H
#define LIMNER_CLI_DEPICT_H

#include <stdbool.h>

#include "limner/limner.h"
#include "options.h"

/* Options of `limner depict` that `limner draw` has not; they stand behind all others. */
enum { DEPICT_OPTION_COUNT = 3 };
#define DEPICT_OPTIONS(VALUES)                                                                                         \
    {"expressions",                                                                                                    \
     0,                                                                                                                \
     OPTION_TEXT,                                                                                                      \
     offsetof(VALUES, expressions),                                                                                    \
     "FILE",                                                                                                           \
     "What to depict and how: JSON, an array of expressions or an object that has one as \"expressions\". Default: "   \
     "those of a script among the INPUTs, else what moves decides."},                                                  \
        {"interval",  0,                                                                                               \
         OPTION_TEXT, offsetof(VALUES, interval),                                                                      \
         "FROM:TO",   "Seconds that are told of, where what moves decides. Default: all of the animation."},           \
    {                                                                                                                  \
        "explain", 0, OPTION_FLAG, offsetof(VALUES, explain), NULL,                                                    \
            "Print what was depicted and why, as JSON that --expressions takes."                                       \
    }

/* What a script says of its still ("depiction"), and whether it has expressions. Freed with depiction_release. */
typedef struct depiction {
    char         *look, *camera, *view; /* NULL: nothing is said */
    option_number time;
    bool          has_expressions;
} depiction;
/* Nothing is said where the file is no script. Prints what is wrong; exit status. Release it also after one. */
int  depiction_read(depiction *out, const char *path);
void depiction_release(depiction *d);

/* Puts signs into a scene and brings the description to a time that tells something, unless it has one. Prints what
 * goes wrong and, unless it is to be quiet, what could not be told; exit status. */
int depict_scene(lmn_scene *scene, lmn_draw_desc *desc, const char *expressions, const char *interval, bool explain,
                 bool quiet);

#endif
