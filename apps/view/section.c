#include "section.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* A number with '%' behind it; the text after it, or NULL. */
static const char *read_percentage(const char *text, double *out)
{
    char *end;
    *out = strtod(text, &end);
    return end != text && *end == '%' && isfinite(*out) ? end + 1 : NULL;
}

static const char *read_corner(const char *text, double out[3])
{
    for (int k = 0; k < 3 && text; k++) {
        if (k > 0 && *text++ != ',')
            return NULL;
        text = read_percentage(text, &out[k]);
    }
    return text;
}

static bool read_box(const char *text, section *s)
{
    if (strncmp(text, "box=", 4) != 0)
        return false;
    text = read_corner(text + 4, s->low);
    if (!text || *text != ':')
        return false;
    text = read_corner(text + 1, s->high);
    return text && !*text;
}

static bool read_plane(const char *text, section *s)
{
    s->flipped = *text == '-';
    text += s->flipped;
    if (*text < 'x' || *text > 'z')
        return false;
    s->axis = *text++ - 'x';
    s->high[s->axis] = 50;
    if (!*text)
        return true;
    if (*text != '=')
        return false;
    text = read_percentage(text + 1, &s->high[s->axis]);
    return text && !*text;
}

section section_parse(const char *cut)
{
    section s = {SECTION_NONE, 0, false, {0, 0, 0}, {100, 100, 100}};
    if (!cut || !*cut || strcmp(cut, "none") == 0)
        return s;
    s.kind = read_box(cut, &s) ? SECTION_BOX : read_plane(cut, &s) ? SECTION_PLANE : SECTION_OTHER;
    return s;
}

void section_write(const section *s, char out[SECTION_TEXT_MAX])
{
    *out = 0;
    if (s->kind == SECTION_PLANE)
        snprintf(out, SECTION_TEXT_MAX, "%s%c=%.4g%%", s->flipped ? "-" : "", 'x' + s->axis, s->high[s->axis]);
    else if (s->kind == SECTION_BOX)
        snprintf(out, SECTION_TEXT_MAX, "box=%.4g%%,%.4g%%,%.4g%%:%.4g%%,%.4g%%,%.4g%%", s->low[0], s->low[1],
                 s->low[2], s->high[0], s->high[1], s->high[2]);
}

/* The middle of the face that the handle holds. */
static void face(const section *s, int axis, bool is_low, const double box_min[3], const double box_max[3],
                 double out[3])
{
    for (int k = 0; k < 3; k++) {
        double middle = s->kind == SECTION_PLANE ? 50 : (s->low[k] + s->high[k]) / 2;
        double at = k != axis ? middle : is_low ? s->low[k] : s->high[k];
        out[k] = box_min[k] + at / 100 * (box_max[k] - box_min[k]);
    }
}

static bool place_handle(section_handle *h, const section *s, const double box_min[3], const double box_max[3],
                         const orbit *view, int width, int height)
{
    double point[3], beside[2], by = (box_max[h->axis] - box_min[h->axis]) / 100;
    face(s, h->axis, h->is_low, box_min, box_max, point);
    if (!orbit_project(view, point, width, height, h->at))
        return false;
    point[h->axis] += by;
    if (!orbit_project(view, point, width, height, beside))
        return false;
    h->step[0] = beside[0] - h->at[0];
    h->step[1] = beside[1] - h->at[1];
    return true;
}

int section_handles(const section *s, const double box_min[3], const double box_max[3], const orbit *view, int width,
                    int height, section_handle out[SECTION_HANDLES])
{
    int count = 0;
    for (int i = 0; i < 6 && s->kind != SECTION_NONE && s->kind != SECTION_OTHER; i++) {
        section_handle h = {.axis = i / 2, .is_low = i % 2};
        bool           wanted = s->kind == SECTION_BOX || (h.axis == s->axis && !h.is_low);
        if (wanted && place_handle(&h, s, box_min, box_max, view, width, height))
            out[count++] = h;
    }
    return count;
}

void section_drag(section *s, const section_handle *handle, const section *begin, double dx, double dy)
{
    double squared = handle->step[0] * handle->step[0] + handle->step[1] * handle->step[1];
    /* Seen along its axis a handle does not move on the picture: then up is more. */
    double by = squared > 1e-4 ? (dx * handle->step[0] + dy * handle->step[1]) / squared : -dy;
    int    k = handle->axis;
    if (handle->is_low)
        s->low[k] = fmin(fmax(begin->low[k] + by, 0), s->high[k] - 0.5);
    else
        s->high[k] = fmin(fmax(begin->high[k] + by, s->kind == SECTION_BOX ? s->low[k] + 0.5 : 0.1), 100);
}
