/* Under which conditions a command runs: limits, and where files may come from. Options that all commands share
 * which read models. */
#ifndef LIMNER_CLI_TASK_H
#define LIMNER_CLI_TASK_H

#include "limner/limner.h"
#include "message.h"
#include "options.h"

typedef struct task_values {
    word_list limits, allow_paths;
    bool      safe, allow_any, in_process;
} task_values;

/* Rows for a command whose values have a `task_values task`. */
#define TASK_OPTIONS(values)                                                                                           \
    {"limit",                                                                                                          \
     0,                                                                                                                \
     OPTION_LIST,                                                                                                      \
     offsetof(values, task.limits),                                                                                    \
     "NAME=VALUE,…",                                                                                                   \
     "Limits for each file and picture, for example time=30s,memory=2G,triangles=5M,pixels=100M,textures=256M. "       \
     "`limner doctor` lists "                                                                                          \
     "them."},                                                                                                         \
        {"safe",      0,                                                                                               \
         OPTION_FLAG, offsetof(values, task.safe),                                                                     \
         NULL,        "For files from strangers: strict limits, and side files from the model's folder alone."},       \
        {"allow-path",                                                                                                 \
         0,                                                                                                            \
         OPTION_LIST,                                                                                                  \
         offsetof(values, task.allow_paths),                                                                           \
         "DIR",                                                                                                        \
         "Models may name files in this folder, too. May be repeated. Without it: in their own folder and the one "    \
         "above."},                                                                                                    \
        {"allow-any", 0, OPTION_FLAG, offsetof(values, task.allow_any), NULL, "Models may name any file."},            \
    {                                                                                                                  \
        "in-process", 0, OPTION_FLAG, offsetof(values, task.in_process), NULL,                                         \
            "Run decoders of pictures, packed meshes and fonts without their fenced process: a little faster, and "    \
            "not for files from strangers."                                                                            \
    }

/* Begins the task of the command; prints what is wrong with its options. Exit status. */
int task_begin(lmn_task **out, const task_values *values, progress *p);

#endif
