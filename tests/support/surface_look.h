/* A look of one surface technique on white, and the view straight on to what it fills. */
#ifndef TRUTH_SURFACE_LOOK_H
#define TRUTH_SURFACE_LOOK_H

#include <stdio.h>

#include "shot.h"

static const shot_view front = {
    .width = 256, .height = 256, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = true, .fov_deg = 18};

/* JSON that stays until the next call. */
static inline const char *surface_look(const char *surface, const char *light, double fill)
{
    static char text[1024];
    snprintf(text, sizeof text,
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"scene\":{\"light_direction\":\"%s\","
             "\"fill\":%g},"
             "\"rules\":[{\"surface\":%s}]}",
             light, fill, surface);
    return text;
}

#endif
