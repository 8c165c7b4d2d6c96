/* Lines of letters that signs have been written with: setting one takes a child process, and signs are made again and
 * again while they are edited. Kept by who owns the scene, for as long as it lives. */
#ifndef LIMNER_SCENE_LETTERINGS_H
#define LIMNER_SCENE_LETTERINGS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* One line, a capital's height about 1; owned. */
typedef struct lettering_line {
    char *text;
    double (*points)[2];
    uint32_t *triangles; /* 3 each */
    size_t    point_count, triangle_count;
    double    low[2], high[2]; /* its box */
    bool      seen;            /* else it has no ink */
} lettering_line;

/* Zero-initialise. */
typedef struct letterings {
    lettering_line *lines;
    size_t          count, capacity;
} letterings;

/* Indices stay until letterings_release. */
enum { LETTERING_NONE = -1 };
/* LETTERING_NONE: it is not there. */
int letterings_find(const letterings *l, const char *text);
/* Takes a line over, and its index; LETTERING_NONE, and it is the caller's, when memory is gone. */
int  letterings_add(letterings *l, const lettering_line *line);
void lettering_line_release(lettering_line *line);
void letterings_release(letterings *l);

#endif
