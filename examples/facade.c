#include "facade.h"

#include "pieces.h"

#include <math.h>
#include <stddef.h>

void facade_wall(mesh *m, const facade *f)
{
    outline o = rectangle(f->left, f->bottom, f->right, f->top), holes[HOLES_MAX];
    for (int k = 0; k < f->count; k++) {
        const opening *a = &f->openings[k];
        holes[k] = round_headed(a->x, a->sill, a->springing, a->radius, WINDOW_ROUND);
    }
    elevation(m, &o, holes, f->count, f->back, f->front);
}

void facade_frames(mesh *m, const facade *f)
{
    for (int k = 0; k < f->count; k++) {
        const opening *a = &f->openings[k];
        double  width = a->filling == DOOR ? 0.22 : fmin(0.16, a->radius * 0.4), deep = a->filling == DOOR ? 0.3 : 0.16;
        outline o = round_headed_frame(a->x, a->sill, a->springing, a->radius - 0.015, width, WINDOW_ROUND);
        elevation(m, &o, NULL, 0, f->front - deep, f->front + 0.05);
        if (a->filling != DOOR)
            box(m, a->x - a->radius - width - 0.05, a->sill - 0.12, f->front - 0.25, a->x + a->radius + width + 0.05,
                a->sill + 0.02, f->front + 0.09);
    }
}

void facade_outer_frames(mesh *m, const facade *f)
{
    for (int k = 0; k < f->count; k++) {
        const opening *a = &f->openings[k];
        outline        o = round_headed_frame(a->x, a->sill, a->springing, a->radius - 0.015, 0.18, WINDOW_ROUND);
        elevation(m, &o, NULL, 0, f->back - 0.06, f->back + 0.2);
        box(m, a->x - a->radius - 0.25, a->sill - 0.14, f->back - 0.12, a->x + a->radius + 0.25, a->sill + 0.02,
            f->back + 0.3);
    }
}

/* A door's boards with gaps between them, and its hinges. */
static void door_leaf(mesh *m, const opening *a, double back)
{
    enum { BOARDS = 6 };
    outline o = round_headed(a->x, a->sill - 0.02, a->springing, a->radius + 0.02, WINDOW_ROUND);
    elevation(m, &o, NULL, 0, back, back + 0.06);
    for (int k = 0; k < BOARDS; k++) {
        double left = a->x - a->radius + 2 * a->radius * k / BOARDS + 0.02,
               right = left + 2 * a->radius / BOARDS - 0.04;
        double far = fmax(fabs(left - a->x), fabs(right - a->x));
        double top = a->springing + sqrt(fmax(0, a->radius * a->radius - far * far)) - 0.02;
        box(m, left, a->sill + 0.02, back + 0.04, right, top, back + 0.1);
    }
    for (int k = 0; k < 2; k++) {
        double height = a->sill + 0.35 + k * (a->springing - a->sill - 0.5);
        box(m, a->x - a->radius + 0.03, height, back + 0.07, a->x + a->radius * 0.6, height + 0.09, back + 0.13);
    }
}

void facade_doors(mesh *m, const facade *f)
{
    for (int k = 0; k < f->count; k++)
        if (f->openings[k].filling == DOOR)
            door_leaf(m, &f->openings[k], f->front - 0.42);
}

/* Panes with their bars. */
void facade_panes(mesh *m, const facade *f)
{
    for (int k = 0; k < f->count; k++) {
        const opening *a = &f->openings[k];
        double         z = f->front - 0.3, radius = a->radius + 0.02;
        if (a->filling != PANE)
            continue;
        outline o = round_headed(a->x, a->sill - 0.02, a->springing, radius, WINDOW_ROUND);
        elevation(m, &o, NULL, 0, z - 0.03, z);
        box(m, a->x - 0.025, a->sill - 0.02, z - 0.05, a->x + 0.025, a->springing + radius - 0.03, z + 0.03);
        int rows = (int)((a->springing - a->sill) / 0.5) + 1;
        for (int i = 1; i <= rows; i++) {
            double y = a->sill + (a->springing - a->sill) * i / rows;
            box(m, a->x - radius + 0.01, y - 0.02, z - 0.045, a->x + radius - 0.01, y + 0.02, z + 0.025);
        }
    }
}

static bool at_opening(const facade *f, double left, double bottom, double right, double top)
{
    bool met = false;
    for (int k = 0; k < f->count; k++) {
        const opening *a = &f->openings[k];
        double         far = a->radius + 0.35;
        met = met || (left < a->x + far && right > a->x - far && bottom < a->springing + far && top > a->sill - 0.3);
    }
    return met;
}

void facade_stones(mesh *m, const facade *f, bool front, double from, double to, int clusters, uint32_t seed)
{
    const double course = 0.34, length = 0.72, joint = 0.02, out = 0.015;
    for (int c = 0; c < clusters; c++) {
        int row = (int)((from + (to - from) * chance(&seed)) / course);
        int column = (int)floor((f->left + 0.3 + (f->right - f->left - 2.4) * chance(&seed)) / length) + 1;
        for (int k = 0; k < 5; k++) {
            int    up = k < 2 ? 0 : k < 4 ? 1 : 2;
            bool   keeps = chance(&seed) < 0.72;
            double left = (column + (k % 2 || up == 2) + ((row + up) % 2) * 0.5) * length, bottom = (row + up) * course;
            double right = left + length - joint, top = bottom + course - joint;
            if (!keeps || bottom < from || top > to || left < f->left + 0.1 || right > f->right - 0.1 ||
                at_opening(f, left, bottom, right, top))
                continue;
            box(m, left, bottom, front ? f->front - 0.07 : f->back - out, right, top,
                front ? f->front + out : f->back + 0.07);
        }
    }
}

void quoins(mesh *m, double x, double z, int toward_x, int toward_z, double from, double to)
{
    const double course = 0.46, out = 0.03;
    int          rows = (int)((to - from) / course);
    for (int k = 0; k < rows; k++) {
        double wide = k % 2 ? 0.95 : 0.5, deep = k % 2 ? 0.5 : 0.95, low = from + k * course;
        double x0 = x - toward_x * out, x1 = x + toward_x * wide, z0 = z - toward_z * out, z1 = z + toward_z * deep;
        box(m, fmin(x0, x1), low, fmin(z0, z1), fmax(x0, x1), low + course - 0.015, fmax(z0, z1));
    }
}
