/* Threads that are not modelled: what a part is called says that it has one, and its cylinders where. */
#include "draft/threads.h"

#include <ctype.h>
#include <math.h>
#include <stdlib.h>

#include "base/memory.h"
#include "base/vector3.h"

/* ISO 261, coarse series: diameter and pitch, mm. */
static const double coarse[][2] = {{1, 0.25}, {1.2, 0.25}, {1.6, 0.35}, {2, 0.4},  {2.5, 0.45}, {3, 0.5},   {3.5, 0.6},
                                   {4, 0.7},  {5, 0.8},    {6, 1},      {8, 1.25}, {10, 1.5},   {12, 1.75}, {14, 2},
                                   {16, 2},   {18, 2.5},   {20, 2.5},   {22, 2.5}, {24, 3},     {27, 3},    {30, 3.5},
                                   {33, 3.5}, {36, 4},     {39, 4},     {42, 4.5}, {45, 4.5},   {48, 5},    {52, 5},
                                   {56, 5.5}, {60, 5.5},   {64, 6}};
/* Of the pitch: how deep threads of shafts are cut, and the core of nuts is below the diameter (ISO 724). */
static const double root_of_shaft = 0.61343, core_of_nut = 0.54127;
static const double exact = 0.01;        /* of a radius */
static const double drill_larger = 0.06; /* drills for cores may be larger by so much of the depth of two flanks */

/* "M8", "m 8", "M10x1", "M 8 × 30": diameter and pitch, mm. What stands behind the × is a pitch if it is no larger than
 * the coarse one, else a length. */
static bool parse_name(const char *name, double *diameter, double *pitch)
{
    for (const char *c = name; *c; c++) {
        char *end;
        if ((*c != 'M' && *c != 'm') || (c > name && isalnum((unsigned char)c[-1])))
            continue;
        const char *number = c + 1;
        if (*number == ' ' || *number == '_')
            number++;
        if (!isdigit((unsigned char)*number))
            continue;
        *diameter = strtod(number, &end);
        *pitch = 0;
        for (size_t i = 0; i < sizeof coarse / sizeof *coarse; i++)
            if (fabs(coarse[i][0] - *diameter) < 1e-9)
                *pitch = coarse[i][1];
        if (!(*pitch > 0) || (isalpha((unsigned char)*end) && *end != 'x' && *end != 'X'))
            continue;
        if ((*end == 'x' || *end == 'X') && isdigit((unsigned char)end[1])) {
            double second = strtod(end + 1, NULL);
            *pitch = second > 0 && second <= *pitch ? second : *pitch;
        }
        return true;
    }
    return false;
}

static bool matches(const draft_cylinder *c, double diameter, double pitch, double mm)
{
    double radius = c->radius * mm, core = diameter / 2 - core_of_nut * pitch;
    if (c->cone)
        return false;
    if (!c->hollow)
        return fabs(radius - diameter / 2) < exact * diameter / 2;
    return radius > core * (1 - exact) && radius < core + drill_larger * diameter;
}

lmn_status draft_threads_named(draft_threads *out, const draft_cylinders *cylinders, const lmn_scene *scene,
                               const bool *parts, double mm, lmn_error *error)
{
    const size_t modelled = out->count;
    for (size_t i = 0; i < cylinders->count; i++) {
        const draft_cylinder *c = &cylinders->items[i];
        double                diameter, pitch;
        bool                  has = false;
        if (c->part == 0 || c->part > scene->part_count || !parts[c->part - 1])
            continue;
        for (size_t k = 0; k < modelled; k++)
            has = has || out->items[k].part == c->part;
        const char *name = scene->nodes[scene->parts[c->part - 1].node].name;
        if (has || !name || !parse_name(name, &diameter, &pitch) || !matches(c, diameter, pitch, mm))
            continue;
        draft_thread t = {.hollow = c->hollow, .crest = c->radius, .lead = pitch / mm, .part = c->part};
        t.root = (c->hollow ? diameter / 2 : diameter / 2 - root_of_shaft * pitch) / mm;
        vector3_copy(t.axis, c->axis);
        for (int k = 0; k < 2; k++) {
            vector3_copy(t.ends[k], c->ends[k]);
            t.tip[k] = t.crest;
        }
        t.flat[1] = vector3_distance(t.ends[0], t.ends[1]);
        if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
            return error_memory(error);
        out->items[out->count++] = t;
    }
    return LMN_OK;
}
