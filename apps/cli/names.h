/* Names of outputs: {name} is the input's stem, {frame} the frame's number in four digits. */
#ifndef LIMNER_CLI_NAMES_H
#define LIMNER_CLI_NAMES_H

#include <stdbool.h>

#define NAME_PLACEHOLDER  "{name}"
#define FRAME_PLACEHOLDER "{frame}"

bool name_has_name(const char *pattern);
bool name_has_frame(const char *pattern);

/* The first {word} of a name that is none of its positions: `*length` characters, braces too; NULL: there is none. */
const char *name_unknown_placeholder(const char *pattern, int *length);

/* The path's last part without its ending; free() it. NULL when memory is gone. */
char *name_stem(const char *path);

/* The pattern with its positions filled, for one input and frame; free() it. NULL when memory is gone. */
char *name_expand(const char *pattern, const char *input, long frame);

/* Do two of the paths have the same stem? Gives the second's index, 0 when none. */
unsigned long name_find_same_stem(const char *const *paths, unsigned long count);

#endif
