/* One form of all that something covers on its way, as the sculptors of motion made it (Boccioni): what it covers at
 * times that are close to each other and on the straight ways in between, and the smoothed outline of that. Großmann
 * 2011, section 2.1.5; row 77g. */
#include "trace/trace_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"

/* From one time to the next the fastest comes on by so many units; between them its way is straight. */
#define STEP 4.0
enum { STEPS_LEAST = 16, STEPS_MOST = 240 };
/* Positions so far apart along the outline, samples, become one; each is the mean of those so far beside it. */
enum { TAKEN = 4, BESIDE = 6 };
/* Shorter outlines are left out, samples. */
enum { SHORTEST = 160 };

typedef struct outline {
    int (*at)[2]; /* corners of samples, the first is not there once more */
    size_t count, capacity;
} outline;

static bool has(const page_mask *m, int x, int y)
{
    return x >= 0 && y >= 0 && x < m->columns && y < m->rows && m->covered[(size_t)y * (size_t)m->columns + (size_t)x];
}

/* Goes once around, with what is covered to the right, from the left side of a covered sample upwards. */
static bool go_around(outline *o, const page_mask *m, uint8_t *passed, int column, int row)
{
    static const int way[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    int              x = column, y = row + 1, heading = 3;
    o->count = 0;
    do {
        if (heading == 3)
            passed[(size_t)(y - 1) * (size_t)m->columns + (size_t)x] = 1;
        if (!mem_grow((void **)&o->at, &o->capacity, o->count + 1, sizeof *o->at))
            return false;
        memcpy(o->at[o->count++], (int[]){x, y}, sizeof *o->at);
        x += way[heading][0];
        y += way[heading][1];
        /* The samples ahead, beside the line that goes on. */
        const int *on = way[heading], *right = way[(heading + 1) % 4];
        int        right_x = x + (on[0] + right[0] - 1) / 2, right_y = y + (on[1] + right[1] - 1) / 2,
            left_x = x + (on[0] - right[0] - 1) / 2, left_y = y + (on[1] - right[1] - 1) / 2;
        if (!has(m, right_x, right_y))
            heading = (heading + 1) % 4;
        else if (has(m, left_x, left_y))
            heading = (heading + 3) % 4;
    } while (x != column || y != row + 1 || heading != 3);
    return true;
}

/* The smoothed outline in units of the page, closed. */
static bool smooth(double (**out)[3], size_t *count, const outline *o, const page_mask *m, const stroke_camera *c,
                   double depth)
{
    size_t taken = o->count / TAKEN;
    double across = (double)c->width / m->columns, down = (double)c->height / m->rows;
    *out = mem_alloc((taken + 1) * sizeof **out);
    *count = taken + 1;
    for (size_t i = 0; *out && i < taken; i++) {
        double x = 0, y = 0, weights = 0;
        for (int k = -BESIDE; k <= BESIDE; k++) {
            const int *p = o->at[(i * TAKEN + o->count + (size_t)(k + BESIDE) - BESIDE) % o->count];
            double     weight = BESIDE + 1 - abs(k);
            x += weight * p[0];
            y += weight * p[1];
            weights += weight;
        }
        memcpy((*out)[i], (double[]){x / weights * across, y / weights * down, depth}, sizeof **out);
    }
    if (*out)
        memcpy((*out)[taken], (*out)[0], sizeof **out);
    return *out != NULL;
}

static bool put_outlines(trace_job *j, const page_mask *m, double depth, past_line_fn put, void *user)
{
    outline  o = {NULL, 0, 0};
    uint8_t *passed = mem_calloc((size_t)m->columns * (size_t)m->rows + 1, 1);
    bool     good = passed != NULL;
    for (int y = 0; y < m->rows && good; y++)
        for (int x = 0; x < m->columns && good; x++) {
            if (!has(m, x, y) || has(m, x - 1, y) || passed[(size_t)y * (size_t)m->columns + (size_t)x])
                continue;
            double(*points)[3] = NULL;
            size_t count = 0;
            good = go_around(&o, m, passed, x, y);
            if (good && o.count >= SHORTEST)
                good = smooth(&points, &count, &o, m, &j->o->camera, depth) &&
                       put(user, (const double(*)[3])points, count);
            mem_free(points);
        }
    mem_free(o.at);
    mem_free(passed);
    return good;
}

/* The mean depth of what moves now. */
static double depth_of(const trace_bodies *b)
{
    double sum = 0;
    for (size_t i = 0; i < b->triangle_count; i++)
        sum += b->now[b->triangles[i][0]][2] / (double)b->triangle_count;
    return sum;
}

lmn_status swept_put(trace_job *j, past_line_fn put, void *user, lmn_error *error)
{
    const traces_options *o = j->o;
    page_mask             all = {NULL, 0, 0};
    double                fastest = 0;
    for (size_t i = 0; i < j->bodies.body_count; i++)
        fastest = fmax(fastest, j->bodies.bodies[i].speed);
    int        steps = (int)fmin(fmax(ceil(fastest / STEP), STEPS_LEAST), STEPS_MOST);
    lmn_status status = page_mask_open(&all, &o->camera) ? LMN_OK : error_memory(error);
    pose       earlier = {.scene = NULL};
    for (int k = 0; k <= steps && status == LMN_OK; k++) {
        pose then = {.scene = NULL};
        status = work_stopped() ? error_memory(error) : pose_ago(&then, o, (double)k / steps, error);
        if (status == LMN_OK && !page_mask_add_parts(&all, &then, k ? &earlier : NULL, j->moves, &o->camera))
            status = error_memory(error);
        pose_release(&earlier);
        earlier = then;
    }
    pose_release(&earlier);
    if (status == LMN_OK && !put_outlines(j, &all, depth_of(&j->bodies), put, user))
        status = error_memory(error);
    page_mask_close(&all);
    return status;
}
