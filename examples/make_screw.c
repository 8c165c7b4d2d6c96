/* Writes the example model of a screw and its nut, M10, with modelled threads: make_screw OUT.obj
 *
 * Millimetres, y up along the axis. The thread of the screw has the basic profile of ISO 68-1 with roots as ISO 965 has
 * them at the deepest (0.61343 of the pitch), the nut's ends at the core (0.54127). Along the axis each angle has the
 * profile's corners, so that crests and roots are edges of the mesh. */
#include <math.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

enum { AROUND = 36, CORNERS = 4, COLUMN_MOST = 128 };

static const double pitch = 1.5, radius = 5;
static const double thread_length = 22, shank_length = 34, head_height = 6.4, head_width = 16, tip = 3.9; /* radius */
static const double nut_height = 8.4, nut_at = 5;

typedef struct corner {
    double z, radius, phase; /* phase: along the helix that it lies on */
} corner;

typedef struct profile {
    double at[CORNERS], radius[CORNERS], from, to;
    bool   chamfered; /* below, at 45 degrees from the radius of the tip on */
} profile;

typedef struct rim {
    int    vertices[AROUND];
    double radii[AROUND];
} rim;

typedef struct model {
    FILE *file;
    int   vertices;
} model;

static int put_vertex(model *m, int i, double r, double z)
{
    double angle = 2 * PI * i / AROUND;
    fprintf(m->file, "v %.5g %.5g %.5g\n", r * cos(angle), z, -r * sin(angle));
    return ++m->vertices;
}

static void put_face(model *m, int a, int b, int c, bool turned)
{
    if (a != b && b != c && c != a)
        fprintf(m->file, "f %d %d %d\n", a, turned ? c : b, turned ? b : c);
}

static double radius_at(const profile *p, double phase)
{
    double at = phase - pitch * floor(phase / pitch);
    for (int k = 0; k < CORNERS; k++) {
        double next = k + 1 < CORNERS ? p->at[k + 1] : pitch;
        if (at <= next)
            return p->radius[k] + (p->radius[(k + 1) % CORNERS] - p->radius[k]) * (at - p->at[k]) / (next - p->at[k]);
    }
    return p->radius[0];
}

static int compare(const void *a, const void *b)
{
    const corner *p = a, *q = b;
    return (p->z > q->z) - (p->z < q->z);
}

static double chamfer(const profile *p, double z)
{
    return p->chamfered ? tip + z - p->from : 1e9;
}

/* The profile at one angle, from below; where a chamfer cuts it there is a corner. */
static int column(const profile *p, int i, corner *out)
{
    double off = pitch * i / AROUND;
    int    count = 0;
    out[count++] = (corner){p->from, radius_at(p, p->from - off), 0};
    for (int turn = -2; turn * pitch < p->to + pitch; turn++)
        for (int k = 0; k < CORNERS; k++) {
            double z = p->at[k] + turn * pitch + off;
            if (z > p->from + 1e-3 && z < p->to - 1e-3)
                out[count++] = (corner){z, p->radius[k], 0};
        }
    out[count++] = (corner){p->to, radius_at(p, p->to - off), 0};
    qsort(out, (size_t)count, sizeof *out, compare);
    for (int k = 0, all = count; k + 1 < all; k++) {
        double before = out[k].radius - chamfer(p, out[k].z), after = out[k + 1].radius - chamfer(p, out[k + 1].z);
        double f = before / (before - after);
        if ((before > 0) != (after > 0) && f > 0.02 && f < 0.98)
            out[count++] = (corner){out[k].z + f * (out[k + 1].z - out[k].z),
                                    out[k].radius + f * (out[k + 1].radius - out[k].radius), 0};
    }
    qsort(out, (size_t)count, sizeof *out, compare);
    for (int k = 0; k < count; k++) {
        out[k].radius = fmin(out[k].radius, chamfer(p, out[k].z));
        out[k].phase = out[k].z - off;
    }
    return count;
}

static void put_thread(model *m, const profile *p, bool hollow, rim *low, rim *high)
{
    static corner columns[AROUND + 1][COLUMN_MOST];
    static int    numbers[AROUND + 1][COLUMN_MOST];
    int           counts[AROUND + 1];
    for (int i = 0; i <= AROUND; i++) {
        counts[i] = column(p, i, columns[i]);
        for (int k = 0; k < counts[i] && i < AROUND; k++)
            numbers[i][k] = put_vertex(m, i, columns[i][k].radius, columns[i][k].z);
    }
    for (int k = 0; k < counts[AROUND]; k++) /* the first one again, a turn later */
        numbers[AROUND][k] = numbers[0][k];
    for (int i = 0; i < AROUND; i++) {
        const corner *a = columns[i], *b = columns[i + 1];
        const int    *left = numbers[i], *right = numbers[i + 1];
        low->vertices[i] = left[0];
        high->vertices[i] = left[counts[i] - 1];
        high->radii[i] = a[counts[i] - 1].radius;
        for (int j = 0, k = 0; j + 1 < counts[i] || k + 1 < counts[i + 1];)
            if (k + 1 == counts[i + 1] || (j + 1 < counts[i] && a[j + 1].phase <= b[k + 1].phase + 1e-9)) {
                put_face(m, left[j], right[k], left[j + 1], hollow);
                j++;
            } else {
                put_face(m, left[j], right[k], right[k + 1], hollow);
                k++;
            }
    }
}

/* Around, or of six sides as wide as `hexagon`. */
static rim put_rim(model *m, double r, double hexagon, double z)
{
    rim out;
    for (int i = 0; i < AROUND; i++) {
        double side = fmod(2 * PI * i / AROUND, PI / 3) - PI / 6;
        out.vertices[i] = put_vertex(m, i, hexagon > 0 ? hexagon / 2 / cos(side) : r, z);
    }
    return out;
}

static void put_band(model *m, const rim *a, const rim *b, bool turned)
{
    for (int i = 0; i < AROUND; i++) {
        int k = (i + 1) % AROUND;
        put_face(m, a->vertices[i], a->vertices[k], b->vertices[k], turned);
        put_face(m, a->vertices[i], b->vertices[k], b->vertices[i], turned);
    }
}

static void put_disc(model *m, const rim *a, double z, bool up)
{
    int middle = put_vertex(m, 0, 0, z);
    for (int i = 0; i < AROUND; i++)
        put_face(m, middle, a->vertices[i], a->vertices[(i + 1) % AROUND], !up);
}

static void put_screw(model *m)
{
    const double  depth = 0.61343 * pitch, flank = pitch * 5 / 16;
    const profile p = {.at = {0, pitch / 8, pitch / 8 + flank, pitch * 3 / 8 + flank},
                       .radius = {radius, radius, radius - depth, radius - depth},
                       .to = thread_length,
                       .chamfered = true};
    rim           low, high, rims[4];
    fprintf(m->file, "o Screw\n");
    put_thread(m, &p, false, &low, &high);
    rims[0] = put_rim(m, radius, 0, thread_length);
    for (int i = 0; i < AROUND; i++) /* where the crest runs out */
        rims[0].vertices[i] = high.radii[i] == radius ? high.vertices[i] : rims[0].vertices[i];
    rims[1] = put_rim(m, radius, 0, shank_length);
    rims[2] = put_rim(m, 0, head_width, shank_length);
    rims[3] = put_rim(m, 0, head_width, shank_length + head_height);
    put_disc(m, &low, 0, false);
    put_band(m, &high, &rims[0], false);
    for (int k = 0; k < 3; k++)
        put_band(m, &rims[k], &rims[k + 1], false);
    put_disc(m, &rims[3], shank_length + head_height, true);
}

static void put_nut(model *m)
{
    const double  core = radius - 0.54127 * pitch, flank = pitch * 5 / 16;
    const profile p = {.at = {0, pitch / 4, pitch / 4 + flank, pitch * 3 / 8 + flank},
                       .radius = {core, core, radius, radius},
                       .from = nut_at,
                       .to = nut_at + nut_height};
    rim           low, high, rims[2];
    fprintf(m->file, "o Nut\n");
    put_thread(m, &p, true, &low, &high);
    rims[0] = put_rim(m, 0, head_width, p.from);
    rims[1] = put_rim(m, 0, head_width, p.to);
    put_band(m, &low, &rims[0], true);
    put_band(m, &rims[0], &rims[1], false);
    put_band(m, &rims[1], &high, false);
}

int main(int argc, char **argv)
{
    model m = {argc == 2 ? fopen(argv[1], "w") : NULL, 0};
    if (!m.file) {
        fprintf(stderr, "make_screw OUT.obj\n");
        return 2;
    }
    put_screw(&m);
    put_nut(&m);
    return fclose(m.file) == 0 ? 0 : 1;
}
