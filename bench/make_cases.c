/* Writes models that a search over pairs would take too long for: make_cases CASE COUNT OUT
 * bench/growth draws each at three sizes. All but `split` make their own triangles; `split IN.stl OUT.stl` cuts each
 * triangle of a binary STL into nine. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define TURN 6.283185307179586

typedef struct place {
    double x, y, z;
} place;

typedef struct writer {
    FILE    *file;
    uint32_t count;
} writer;

static void put(writer *w, place a, place b, place c)
{
    const float corners[12] = {0,          0,          0,          (float)a.x, (float)a.y, (float)a.z,
                               (float)b.x, (float)b.y, (float)b.z, (float)c.x, (float)c.y, (float)c.z};
    const char  attribute[2] = {0};
    fwrite(corners, sizeof corners, 1, w->file);
    fwrite(attribute, sizeof attribute, 1, w->file);
    w->count++;
}

/* Numbers from 0 to 1, the same each time. */
static double next(uint64_t *state)
{
    *state = *state * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
    return (double)(*state >> 33) / 2147483648.0;
}

/* Thin triangles from the middle of a plane to a circle: all their boxes overlap in quarters. */
static void star(writer *w, long count)
{
    for (long i = 0; i < count; i++) {
        double from = TURN * (double)i / (double)count, to = from + 0.5 * TURN / (double)count;
        put(w, (place){0, 0, 0}, (place){cos(from), sin(from), 0}, (place){cos(to), sin(to), 0});
    }
}

/* Triangles anywhere in a cube, the smaller the more there are: each runs through about as many others. */
static void soup(writer *w, long count)
{
    uint64_t state = 1;
    double   size = 2 / cbrt((double)count);
    for (long i = 0; i < count; i++) {
        place p[3], middle = {next(&state), next(&state), next(&state)};
        for (int k = 0; k < 3; k++) {
            p[k].x = middle.x + size * (next(&state) - 0.5);
            p[k].y = middle.y + size * (next(&state) - 0.5);
            p[k].z = middle.z + size * (next(&state) - 0.5);
        }
        put(w, p[0], p[1], p[2]);
    }
}

static place torus_place(double u, double v, double ring, double tube, place middle, int upright)
{
    double r = ring + tube * cos(TURN * v), x = r * cos(TURN * u), y = r * sin(TURN * u), z = tube * sin(TURN * v);
    return upright ? (place){middle.x + x, middle.y + z, middle.z + y}
                   : (place){middle.x + x, middle.y + y, middle.z + z};
}

static void torus(writer *w, place middle, double ring, double tube, int upright)
{
    enum { ALONG = 24, ACROSS = 12 };
    for (int i = 0; i < ALONG; i++)
        for (int k = 0; k < ACROSS; k++) {
            double u = (double)i / ALONG, n = (double)((i + 1) % ALONG) / ALONG, v = (double)k / ACROSS,
                   m = (double)((k + 1) % ACROSS) / ACROSS;
            place a = torus_place(u, v, ring, tube, middle, upright),
                  b = torus_place(n, v, ring, tube, middle, upright),
                  c = torus_place(n, m, ring, tube, middle, upright),
                  d = torus_place(u, m, ring, tube, middle, upright);
            put(w, a, b, c);
            put(w, a, c, d);
        }
}

/* Rings anywhere in a cube that grows with their number: each runs through some neighbours. */
static void tori(writer *w, long count)
{
    uint64_t state = 1;
    double   side = cbrt((double)count);
    for (long i = 0; i < count; i++) {
        place middle = {side * next(&state), side * next(&state), side * next(&state)};
        torus(w, middle, 0.8, 0.15, (int)(i % 2));
    }
}

/* A plane of quads, of which every second row is cut once more: so its rim has a T-junction at each quad. */
static void junctions(writer *w, long count)
{
    long side = lround(sqrt((double)count / 5));
    for (long r = 0; r < 2 * side; r++)
        for (long c = 0; c < side; c++) {
            double y = 0.5 * (double)r, z = 0.2 * sin(0.37 * (double)r) * 0.5;
            double up = 0.2 * sin(0.37 * (double)(r + 1)) * 0.5;
            place  a = {(double)c, y, z}, b = {(double)c + 1, y, z}, d = {(double)c, y + 0.5, up},
                  e = {(double)c + 1, y + 0.5, up}, m = {(double)c + 0.5, y, z}, n = {(double)c + 0.5, y + 0.5, up};
            if (r % 2) {
                put(w, a, b, e);
                put(w, a, e, d);
            } else {
                put(w, a, m, n);
                put(w, m, b, n);
                put(w, b, e, n);
                put(w, a, n, d);
            }
        }
}

/* Small triangles that are all in one pixel, and one that is as large as the page. */
static void speck(writer *w, long count)
{
    uint64_t state = 1;
    double   size = 1 / cbrt((double)count);
    put(w, (place){1, 0, 0}, (place){0, 1, 0}, (place){0, 0, 1});
    for (long i = 1; i < count; i++) {
        place p[3], middle = {next(&state), next(&state), next(&state)};
        for (int k = 0; k < 3; k++) {
            p[k].x = 1e-3 * (middle.x + size * next(&state));
            p[k].y = 1e-3 * (middle.y + size * next(&state));
            p[k].z = 1e-3 * (middle.z + size * next(&state));
        }
        put(w, p[0], p[1], p[2]);
    }
}

/* Spheres in each other, of 528 triangles each: as many surfaces lie in front of the middle. */
static void spheres(writer *w, long count)
{
    enum { ROUND = 24, UP = 12 };
    for (long n = 0; n < count; n++)
        for (int i = 0; i < ROUND; i++)
            for (int k = 0; k < UP; k++) {
                place  p[4];
                double size = 1 + (double)n / (double)count;
                for (int c = 0; c < 4; c++) {
                    double turn = TURN * (i + (c == 1 || c == 2)) / ROUND,
                           rise = TURN * ((k + (c > 1)) / 2.0 / UP - 0.25);
                    p[c] = (place){size * cos(rise) * cos(turn), size * cos(rise) * sin(turn), size * sin(rise)};
                }
                if (k > 0)
                    put(w, p[0], p[1], p[2]);
                if (k < UP - 1)
                    put(w, p[0], p[2], p[3]);
            }
}

/* Narrow triangles from one place in all directions: a star that is not flat. */
static void spikes(writer *w, long count)
{
    uint64_t state = 7;
    for (long i = 0; i < count; i++) {
        double turn = TURN * next(&state), up = 2 * next(&state) - 1, wide = sqrt(1 - up * up);
        place  tip = {wide * cos(turn), wide * sin(turn), up};
        place  beside = {tip.x + 4e-3 * (next(&state) - 0.5), tip.y + 4e-3 * (next(&state) - 0.5),
                         tip.z + 4e-3 * (next(&state) - 0.5)};
        put(w, (place){0, 0, 0}, tip, beside);
    }
}

/* Flat stars in four planes through one place. */
static void fans(writer *w, long count)
{
    const double tilts[4][2] = {{0, 0}, {1.1, 0}, {-1.1, 0.7}, {0.5, 1.3}};
    for (long i = 0; i < count; i++) {
        double turn[2] = {TURN * (double)(i / 4) / (double)(count / 4), 0};
        place  p[3] = {{0, 0, 0}, {0, 0, 0}, {0, 0, 0}};
        turn[1] = turn[0] + 0.5 * TURN / (double)(count / 4);
        for (int k = 0; k < 2; k++) {
            double x = cos(turn[k]), y = sin(turn[k]) * cos(tilts[i % 4][0]), z = sin(turn[k]) * sin(tilts[i % 4][0]);
            p[1 + k].x = x * cos(tilts[i % 4][1]) - z * sin(tilts[i % 4][1]);
            p[1 + k].y = y;
            p[1 + k].z = x * sin(tilts[i % 4][1]) + z * cos(tilts[i % 4][1]);
        }
        put(w, p[0], p[1], p[2]);
    }
}

/* Boxes on a grid, in groups of their own: parts. */
static void parts(FILE *file, long count)
{
    long side = lround(sqrt((double)count));
    for (long i = 0; i < count; i++) {
        double x = (double)(i % side), y = (double)(i / side), h = 0.3 + 0.7 * (double)(i * 7919 % 100) / 100;
        fprintf(file, "o part%ld\n", i);
        for (int k = 0; k < 8; k++)
            fprintf(file, "v %g %g %g\n", x + (k & 1 ? 0.7 : 0), y + (k & 2 ? 0.7 : 0), k & 4 ? h : 0);
        static const int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                        {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
        for (int q = 0; q < 6; q++)
            fprintf(file, "f %ld %ld %ld %ld\n", 8 * i + 1 + quads[q][0], 8 * i + 1 + quads[q][1],
                    8 * i + 1 + quads[q][2], 8 * i + 1 + quads[q][3]);
    }
}

static place weighted(const float *p, const int weights[3])
{
    double at[3];
    for (int k = 0; k < 3; k++)
        at[k] = ((double)p[k] * weights[0] + (double)p[3 + k] * weights[1] + (double)p[6 + k] * weights[2]) / 3;
    return (place){at[0], at[1], at[2]};
}

/* Each triangle of a binary STL as nine. */
static int split(writer *w, const char *path)
{
    FILE    *in = fopen(path, "rb");
    char     header[80];
    uint32_t count;
    if (!in || fread(header, sizeof header, 1, in) != 1 || fread(&count, 4, 1, in) != 1)
        return 0;
    for (uint32_t i = 0; i < count; i++) {
        unsigned char record[50];
        float         p[9];
        if (fread(record, sizeof record, 1, in) != 1)
            return 0;
        memcpy(p, record + 12, sizeof p);
        for (int r = 0; r < 3; r++)
            for (int c = 0; c + r < 3; c++) {
                place a = weighted(p, (int[]){3 - r - c, c, r}), b = weighted(p, (int[]){2 - r - c, c + 1, r}),
                      d = weighted(p, (int[]){2 - r - c, c, r + 1});
                put(w, a, b, d);
                if (c + r < 2)
                    put(w, b, weighted(p, (int[]){1 - r - c, c + 1, r + 1}), d);
            }
    }
    return fclose(in) == 0;
}

int main(int argc, char **argv)
{
    static const struct {
        const char *name;
        void (*make)(writer *w, long count);
    } cases[] = {{"star", star},   {"soup", soup},       {"tori", tori},     {"junctions", junctions},
                 {"speck", speck}, {"spheres", spheres}, {"spikes", spikes}, {"fans", fans}};
    if (argc != 4)
        return fprintf(stderr,
                       "usage: make_cases star|soup|tori|junctions|speck|spheres|spikes|fans|parts COUNT OUT, or "
                       "split IN.stl OUT.stl\n"),
               1;
    writer w = {fopen(argv[3], "wb"), 0};
    int    good = w.file != NULL;
    if (good && strcmp(argv[1], "parts") == 0) {
        parts(w.file, strtol(argv[2], NULL, 10));
        return fclose(w.file) != 0;
    }
    char header[84] = "case";
    good = good && fwrite(header, sizeof header, 1, w.file) == 1;
    if (good && strcmp(argv[1], "split") == 0)
        good = split(&w, argv[2]);
    for (size_t i = 0; good && i < sizeof cases / sizeof *cases; i++)
        if (strcmp(argv[1], cases[i].name) == 0)
            cases[i].make(&w, strtol(argv[2], NULL, 10));
    good = good && w.count > 0 && fseek(w.file, 80, SEEK_SET) == 0 && fwrite(&w.count, 4, 1, w.file) == 1;
    return !good || fclose(w.file) != 0;
}
