/* Writes the example model of a torus knot: make_knot OUT.glb
 *
 * The (3,2) knot of the torus, a trefoil, as Escher drew it: a closed tube, broader than it is high, that winds three
 * times through the torus's hole and twice around its axis. Texture coordinates run along the tube (u) and around it
 * (v), both once from 0 to 1. Numbers are stored in 16 bits (KHR_mesh_quantization), normals from the surface's own
 * derivatives. */
#include "glb.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#define PI 3.14159265358979323846

enum { ALONG = 560, AROUND = 32, COLUMNS = AROUND + 1, VERTICES = (ALONG + 1) * COLUMNS, INDICES = 6 * ALONG * AROUND };
enum { THROUGH = 3, ABOUT = 2 };

static const double torus_radius = 1.0, torus_thickness = 0.42;
static const double half_breadth = 0.215, half_height = 0.2; /* of the tube's section, along the torus and out of it */
static const double extent = 1.75;                           /* what the largest 16-bit number stands for */

typedef struct triple {
    double x, y, z;
} triple;

static triple minus(triple a, triple b)
{
    return (triple){a.x - b.x, a.y - b.y, a.z - b.z};
}

static triple cross(triple a, triple b)
{
    return (triple){a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

static triple unit(triple a)
{
    double length = sqrt(a.x * a.x + a.y * a.y + a.z * a.z);
    return (triple){a.x / length, a.y / length, a.z / length};
}

/* The torus lies in the plane z = 0; lobes point up and down and to the sides. */
static triple middle_at(double u)
{
    double about = 2 * PI * ABOUT * u + PI / 2, through = 2 * PI * THROUGH * u;
    double out = torus_radius + torus_thickness * cos(through);
    return (triple){out * cos(about), out * sin(about), -torus_thickness * sin(through)};
}

/* What points out of the torus there, which makes the section come round to itself without a twist. */
static triple outward_at(double u)
{
    double about = 2 * PI * ABOUT * u + PI / 2, through = 2 * PI * THROUGH * u;
    return (triple){cos(through) * cos(about), cos(through) * sin(about), -sin(through)};
}

static triple surface_at(double u, double v)
{
    const double step = 1e-5;
    triple       middle = middle_at(u), outward = outward_at(u);
    triple       beside = unit(cross(minus(middle_at(u + step), middle_at(u - step)), outward));
    double       across = half_breadth * cos(2 * PI * v), up = half_height * sin(2 * PI * v);
    return (triple){middle.x + across * beside.x + up * outward.x, middle.y + across * beside.y + up * outward.y,
                    middle.z + across * beside.z + up * outward.z};
}

static triple normal_at(double u, double v)
{
    const double step = 1e-4;
    return unit(cross(minus(surface_at(u + step, v), surface_at(u - step, v)),
                      minus(surface_at(u, v + step), surface_at(u, v - step))));
}

static char *put_short(char *to, long value)
{
    to[0] = (char)(value & 255);
    to[1] = (char)(value >> 8 & 255);
    return to + 2;
}

static char *put_triple(char *to, triple t, double scale)
{
    to = put_short(to, lround(t.x * scale));
    to = put_short(to, lround(t.y * scale));
    return put_short(put_short(to, lround(t.z * scale)), 0);
}

enum { VERTEX_SIZE = 8 + 8 + 4, BYTES = VERTICES * VERTEX_SIZE + 2 * INDICES };

/* Positions, normals, texture coordinates, indices. The last row and column are the first ones again, at 1 instead
 * of 0. */
static void fill(char *bytes)
{
    char *positions = bytes, *normals = bytes + 8 * VERTICES, *uvs = bytes + 16 * VERTICES,
         *indices = bytes + 20 * VERTICES;
    for (int i = 0; i <= ALONG; i++)
        for (int j = 0; j <= AROUND; j++) {
            double u = (double)(i % ALONG) / ALONG, v = (double)(j % AROUND) / AROUND;
            positions = put_triple(positions, surface_at(u, v), 32767 / extent);
            normals = put_triple(normals, normal_at(u, v), 32767);
            uvs = put_short(put_short(uvs, lround(65535.0 * i / ALONG)), lround(65535.0 * j / AROUND));
        }
    for (int i = 0; i < ALONG; i++)
        for (int j = 0; j < AROUND; j++) {
            const int a = i * COLUMNS + j, b = a + COLUMNS, corners[6] = {a, b, b + 1, a, b + 1, a + 1};
            for (int k = 0; k < 6; k++)
                indices = put_short(indices, corners[k]);
        }
}

static int describe(char *out, size_t size, const char *bytes)
{
    int low[3] = {32767, 32767, 32767}, high[3] = {-32767, -32767, -32767};
    for (int i = 0; i < VERTICES; i++)
        for (int k = 0; k < 3; k++) {
            const unsigned char *at = (const unsigned char *)bytes + 8 * i + 2 * k;
            int                  value = (int16_t)(at[0] | at[1] << 8);
            low[k] = value < low[k] ? value : low[k];
            high[k] = value > high[k] ? value : high[k];
        }
    return snprintf(
        out, size,
        "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Limner make_knot\",\"copyright\":\"CC0-1.0\"},"
        "\"extensionsUsed\":[\"KHR_mesh_quantization\"],\"extensionsRequired\":[\"KHR_mesh_quantization\"],"
        "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"name\":\"knot\",\"mesh\":0,\"scale\":[%.9g,%.9g,%.9g]}]"
        ","
        "\"materials\":[{\"name\":\"Clay\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[0.720,0.640,0.540,1],"
        "\"metallicFactor\":0,\"roughnessFactor\":0.7}}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2},\"indices\":3,"
        "\"material\":0}]}],"
        "\"accessors\":[{\"bufferView\":0,\"componentType\":5122,\"normalized\":true,\"count\":%d,\"type\":\"VEC3\","
        "\"min\":[%d,%d,%d],\"max\":[%d,%d,%d]},"
        "{\"bufferView\":1,\"componentType\":5122,\"normalized\":true,\"count\":%d,\"type\":\"VEC3\"},"
        "{\"bufferView\":2,\"componentType\":5123,\"normalized\":true,\"count\":%d,\"type\":\"VEC2\"},"
        "{\"bufferView\":3,\"componentType\":5123,\"count\":%d,\"type\":\"SCALAR\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteOffset\":0,\"byteLength\":%d,\"byteStride\":8,\"target\":34962},"
        "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d,\"byteStride\":8,\"target\":34962},"
        "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d,\"byteStride\":4,\"target\":34962},"
        "{\"buffer\":0,\"byteOffset\":%d,\"byteLength\":%d,\"target\":34963}],\"buffers\":[{\"byteLength\":%d}]}",
        extent, extent, extent, VERTICES, low[0], low[1], low[2], high[0], high[1], high[2], VERTICES, VERTICES,
        INDICES, 8 * VERTICES, 8 * VERTICES, 8 * VERTICES, 16 * VERTICES, 4 * VERTICES, 20 * VERTICES, 2 * INDICES,
        BYTES);
}

int main(int count, char **arguments)
{
    enum { JSON_SIZE = 4096 };
    static char bytes[BYTES], json[JSON_SIZE];
    if (count != 2)
        return EXIT_FAILURE;
    fill(bytes);
    int size = describe(json, sizeof json, bytes);
    if (size <= 0 || size >= JSON_SIZE)
        return EXIT_FAILURE;
    return glb_write(arguments[1], json, (size_t)size, bytes, BYTES) ? EXIT_SUCCESS : EXIT_FAILURE;
}
