/* Writes a binary STL of a knobbly torus with about so many triangles: make_model TRIANGLES OUT.stl
 * The same shape at every count, so that series over triangles change nothing else. */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

static void point(double u, double v, float out[3])
{
    const double turn = 6.283185307179586;
    double       bump = 1 + 0.18 * sin(9 * turn * u) * cos(5 * turn * v);
    double       tube = 0.42 * bump, ring = 1 + tube * cos(turn * v);
    out[0] = (float)(ring * cos(turn * u));
    out[1] = (float)(ring * sin(turn * u));
    out[2] = (float)(tube * sin(turn * v));
}

static int put_triangle(FILE *file, double u0, double v0, double u1, double v1, double u2, double v2)
{
    float         data[12] = {0};
    unsigned char record[50] = {0};
    point(u0, v0, data + 3);
    point(u1, v1, data + 6);
    point(u2, v2, data + 9);
    for (int i = 0; i < 48; i++)
        record[i] = ((unsigned char *)data)[i];
    return fwrite(record, sizeof record, 1, file) == 1;
}

int main(int argc, char **argv)
{
    if (argc != 3)
        return fprintf(stderr, "usage: make_model TRIANGLES OUT.stl\n"), 1;
    long  wanted = strtol(argv[1], NULL, 10), across = lround(sqrt((double)wanted / 4)), along = 2 * across;
    FILE *file = fopen(argv[2], "wb");
    if (!file || wanted < 8)
        return 1;
    unsigned char header[80] = "knobbly torus";
    uint32_t      count = (uint32_t)(2 * across * along);
    int           good = fwrite(header, sizeof header, 1, file) == 1 && fwrite(&count, 4, 1, file) == 1;
    for (long i = 0; i < along && good; i++)
        for (long j = 0; j < across && good; j++) {
            /* Wrapped indices, so that the seam's vertices are bit for bit the same. */
            double u0 = (double)i / (double)along, u1 = (double)((i + 1) % along) / (double)along;
            double v0 = (double)j / (double)across, v1 = (double)((j + 1) % across) / (double)across;
            good = put_triangle(file, u0, v0, u1, v0, u1, v1) && put_triangle(file, u0, v0, u1, v1, u0, v1);
        }
    return fclose(file) == 0 && good ? 0 : 1;
}
