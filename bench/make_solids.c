/* Writes sets of solids for bench/solids as .csg files: make_solids SET N > FILE. They lie between −1 and 1.
 *   holes  a plate minus N cylinders                 balls  a box minus N spheres that run into each other
 *   inter  the intersection of N spheres             pairs  the union of N boxes, each minus a cylinder
 *   tori   a box minus N rings, which are not convex
 * Each ball and ring is 32 × 16 facets, each cylinder 32. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { AROUND = 32, ALONG = 16 };

static const float pi = 3.14159265f;
static uint32_t    state = 12345;

static float next(void)
{
    state = state * 1664525u + 1013904223u;
    return (float)(state >> 8) / 16777216.0f;
}

static void box(void)
{
    printf("cube(size = [2, 2, 2], center = true);");
}

static void cylinder(void)
{
    printf("cylinder($fn = %d, h = 2, r1 = 1, r2 = 1, center = true);", AROUND);
}

/* A half circle that is turned, or a whole one beside the axis. */
static void turned(int ring)
{
    printf("rotate_extrude(convexity = 2, $fn = %d) { polygon(points = [", AROUND);
    for (int i = 0; i < ALONG + !ring; i++) {
        double angle = ring ? 2 * (double)pi * i / ALONG : (double)pi * i / ALONG - (double)pi / 2;
        double x = ring                   ? 0.7 + 0.3 * cos(angle)
                   : i == 0 || i == ALONG ? 0
                                          : cos(angle),
               y = ring ? 0.3 * sin(angle) : sin(angle);
        printf("%s[%.7f, %.7f]", i ? ", " : "", x, y);
    }
    printf("], paths = undef, convexity = 1); }");
}

static void ball(void)
{
    turned(0);
}

static void ring(void)
{
    turned(1);
}

/* A leaf at a position, with half sizes and a colour by chance. */
static void leaf(void (*shape)(void), float x, float y, float z, const float half[3])
{
    float r = 0.3f + 0.6f * next(), g = 0.3f + 0.6f * next(), b = 0.3f + 0.6f * next();
    printf("  color([%.3f, %.3f, %.3f, 1]) { multmatrix([[%.7g, 0, 0, %.7g], [0, %.7g, 0, %.7g], [0, 0, %.7g, %.7g], "
           "[0, 0, 0, 1]]) { ",
           (double)r, (double)g, (double)b, (double)half[0], (double)x, (double)half[1], (double)y, (double)half[2],
           (double)z);
    shape();
    printf(" } }\n");
}

static void holes(int n, int side, float cell)
{
    leaf(box, 0, 0, 0, (float[]){1, 1, 0.2f});
    for (int i = 0; i < n; i++)
        leaf(cylinder, -1 + cell * ((float)(i % side) + 0.5f), -1 + cell * ((float)(i / side) + 0.5f), 0,
             (float[]){cell * 0.35f, cell * 0.35f, 0.3f});
}

static void scattered(int n, void (*shape)(void))
{
    float r = 0.9f * (float)pow(8.0 / n, 1 / 3.0);
    r = r > 0.6f ? 0.6f : r;
    leaf(box, 0, 0, 0, (float[]){1, 1, 1});
    for (int i = 0; i < n; i++) {
        float x = 2 * next() - 1, y = 2 * next() - 1, z = 2 * next() - 1;
        leaf(shape, x, y, z, (float[]){r, r, r});
    }
}

static void intersected(int n)
{
    for (int i = 0; i < n; i++) {
        float angle = 2 * pi * (float)i / (float)n, z = 0.25f * (2 * next() - 1);
        leaf(ball, 0.25f * cosf(angle), 0.25f * sinf(angle), z, (float[]){1, 1, 1});
    }
}

static void pairs(int n, int side, float cell)
{
    for (int i = 0; i < n; i++) {
        float x = -1 + cell * ((float)(i % side) + 0.5f), y = -1 + cell * ((float)(i / side) + 0.5f), r = cell * 0.45f;
        printf(" difference() {\n");
        leaf(box, x, y, 0, (float[]){r, r, 0.4f});
        leaf(cylinder, x, y, 0.1f, (float[]){r * 0.7f, r * 0.7f, 0.4f});
        printf(" }\n");
    }
}

int main(int count, char **arguments)
{
    int n = count > 2 ? atoi(arguments[2]) : 0, side = (int)ceil(sqrt((double)n));
    if (n < 1)
        return 1;
    const char *set = arguments[1];
    float       cell = 2.0f / (float)side;
    printf("%s() {\n", strcmp(set, "inter") == 0 ? "intersection" : strcmp(set, "pairs") == 0 ? "union" : "difference");
    if (strcmp(set, "holes") == 0)
        holes(n, side, cell);
    else if (strcmp(set, "balls") == 0)
        scattered(n, ball);
    else if (strcmp(set, "tori") == 0)
        scattered(n, ring);
    else if (strcmp(set, "inter") == 0)
        intersected(n);
    else if (strcmp(set, "pairs") == 0)
        pairs(n, side, cell);
    else
        return 1;
    printf("}\n");
    return 0;
}
