#include "moving_scene.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../../examples/glb.h"

static void add(char **text, const char *format, ...)
{
    va_list arguments;
    char    piece[1024];
    va_start(arguments, format);
    vsnprintf(piece, sizeof piece, format, arguments);
    va_end(arguments);
    size_t had = *text ? strlen(*text) : 0;
    *text = realloc(*text, had + strlen(piece) + 1);
    memcpy(*text + had, piece, strlen(piece) + 1);
}

static const char *comma(int count)
{
    return count ? ", " : "";
}

/* Returns the accessor. `type`: "SCALAR", "VEC3" or "VEC4" of floats, or indices. */
static int add_data(moving_scene *m, const void *data, size_t bytes, int count, const char *type, bool indices,
                    const char *bounds)
{
    m->bytes = realloc(m->bytes, m->byte_count + bytes);
    memcpy(m->bytes + m->byte_count, data, bytes);
    add(&m->views, "%s{\"buffer\": 0, \"byteOffset\": %zu, \"byteLength\": %zu}", comma(m->accessor_count),
        m->byte_count, bytes);
    add(&m->accessors, "%s{\"bufferView\": %d, \"componentType\": %d, \"count\": %d, \"type\": \"%s\"%s}",
        comma(m->accessor_count), m->accessor_count, indices ? 5125 : 5126, count, type, bounds);
    m->byte_count += bytes;
    return m->accessor_count++;
}

static int add_mesh(moving_scene *m, double x, double y, double z, const float (*positions)[3],
                    const float (*normals)[3], int vertices, const unsigned *indices, int index_count, double reach,
                    const double colour[3])
{
    char bounds[160];
    snprintf(bounds, sizeof bounds, ", \"min\": [%.9g, %.9g, %.9g], \"max\": [%.9g, %.9g, %.9g]", -reach, -reach,
             -reach, reach, reach, reach);
    int at = add_data(m, positions, sizeof(float[3]) * (size_t)vertices, vertices, "VEC3", false, bounds);
    int up = add_data(m, normals, sizeof(float[3]) * (size_t)vertices, vertices, "VEC3", false, "");
    int which = add_data(m, indices, sizeof *indices * (size_t)index_count, index_count, "SCALAR", true, "");
    add(&m->materials, "%s{\"pbrMetallicRoughness\": {\"baseColorFactor\": [%.9g, %.9g, %.9g, 1]}%s}",
        comma(m->mesh_count), colour[0], colour[1], colour[2],
        m->lit ? "" : ", \"extensions\": {\"KHR_materials_unlit\": {}}");
    add(&m->meshes,
        "%s{\"primitives\": [{\"attributes\": {\"POSITION\": %d, \"NORMAL\": %d}, \"indices\": %d, \"material\": %d}]}",
        comma(m->mesh_count), at, up, which, m->mesh_count);
    add(&m->nodes, "%s{\"name\": \"node%d\", \"mesh\": %d, \"translation\": [%.17g, %.17g, %.17g]}",
        comma(m->node_count), m->node_count, m->mesh_count, x, y, z);
    m->mesh_count++;
    return m->node_count++;
}

void moving_scene_begin(moving_scene *m)
{
    *m = (moving_scene){.nodes = NULL};
}

int moving_scene_box(moving_scene *m, double x, double y, double z, const double half[3], const double colour[3])
{
    float    positions[24][3], normals[24][3];
    unsigned indices[36];
    int      v = 0, n = 0;
    for (int axis = 0; axis < 3; axis++)
        for (int side = -1; side <= 1; side += 2) {
            static const int corners[2][4][2] = {{{-1, -1}, {-1, 1}, {1, 1}, {1, -1}},
                                                 {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}};
            for (int k = 0; k < 4; k++, v++) {
                int b = (axis + 1) % 3, c = (axis + 2) % 3;
                positions[v][axis] = (float)(side * half[axis]);
                positions[v][b] = (float)(corners[side > 0][k][0] * half[b]);
                positions[v][c] = (float)(corners[side > 0][k][1] * half[c]);
                normals[v][axis] = (float)side;
                normals[v][b] = normals[v][c] = 0;
            }
            unsigned first = (unsigned)v - 4, order[6] = {first, first + 1, first + 2, first, first + 2, first + 3};
            memcpy(&indices[n], order, sizeof order);
            n += 6;
        }
    double reach = fmax(half[0], fmax(half[1], half[2]));
    return add_mesh(m, x, y, z, (const float(*)[3])positions, (const float(*)[3])normals, 24, indices, 36, reach,
                    colour);
}

int moving_scene_sphere(moving_scene *m, double x, double y, double z, double radius, const double colour[3])
{
    enum { ROWS = 32, COLUMNS = 64, VERTICES = (ROWS + 1) * (COLUMNS + 1) };
    static float    positions[VERTICES][3], normals[VERTICES][3];
    static unsigned indices[ROWS * COLUMNS * 6];
    int             n = 0;
    for (int row = 0; row <= ROWS; row++)
        for (int column = 0; column <= COLUMNS; column++) {
            int    v = row * (COLUMNS + 1) + column;
            double theta = 3.141592653589793 * row / ROWS, phi = 2 * 3.141592653589793 * column / COLUMNS;
            double p[3] = {sin(theta) * cos(phi), cos(theta), -sin(theta) * sin(phi)};
            for (int k = 0; k < 3; k++) {
                normals[v][k] = (float)p[k];
                positions[v][k] = (float)(radius * p[k]);
            }
            if (row == ROWS || column == COLUMNS)
                continue;
            unsigned a = (unsigned)v, b = a + COLUMNS + 1, order[6] = {a, b, a + 1, a + 1, b, b + 1};
            memcpy(&indices[n], order, sizeof order);
            n += 6;
        }
    return add_mesh(m, x, y, z, (const float(*)[3])positions, (const float(*)[3])normals, VERTICES, indices, n, radius,
                    colour);
}

void moving_scene_keys(moving_scene *m, int node, const char *path, int count, const double *times,
                       const double *values)
{
    int    numbers = strcmp(path, "rotation") == 0 ? 4 : 3;
    float *t = malloc((size_t)count * sizeof *t), *v = malloc((size_t)(count * numbers) * sizeof *v);
    char   bounds[80];
    for (int i = 0; i < count; i++)
        t[i] = (float)times[i];
    for (int i = 0; i < count * numbers; i++)
        v[i] = (float)values[i];
    snprintf(bounds, sizeof bounds, ", \"min\": [%.9g], \"max\": [%.9g]", (double)t[0], (double)t[count - 1]);
    int at = add_data(m, t, (size_t)count * sizeof *t, count, "SCALAR", false, bounds);
    int to = add_data(m, v, (size_t)(count * numbers) * sizeof *v, count, numbers == 4 ? "VEC4" : "VEC3", false, "");
    add(&m->samplers, "%s{\"input\": %d, \"output\": %d}", comma(m->channel_count), at, to);
    add(&m->channels, "%s{\"sampler\": %d, \"target\": {\"node\": %d, \"path\": \"%s\"}}", comma(m->channel_count),
        m->channel_count, node, path);
    m->channel_count++;
    free(t);
    free(v);
}

int moving_scene_camera(moving_scene *m, double x, double y, double z, bool orthographic, double size)
{
    add(&m->nodes, "%s{\"name\": \"eye\", \"camera\": 0, \"translation\": [%.17g, %.17g, %.17g]}", comma(m->node_count),
        x, y, z);
    char *cameras = NULL;
    if (orthographic)
        add(&cameras,
            "\"cameras\": [{\"name\": \"eye\", \"type\": \"orthographic\", \"orthographic\": {\"xmag\": %.9g, "
            "\"ymag\": "
            "%.9g, \"znear\": 0.01, \"zfar\": 1000}}], ",
            size, size);
    else
        add(&cameras,
            "\"cameras\": [{\"name\": \"eye\", \"type\": \"perspective\", \"perspective\": {\"yfov\": %.9g, \"znear\": "
            "0.01}}], ",
            size * 3.141592653589793 / 180);
    m->cameras = cameras;
    return m->node_count++;
}

void moving_scene_write(moving_scene *m, const char *path)
{
    char *json = NULL, *roots = NULL;
    for (int i = 0; i < m->node_count; i++)
        add(&roots, "%s%d", comma(i), i);
    const char *const format[] = {"{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"KHR_materials_unlit\"], ",
                                  "\"scene\": 0, \"scenes\": [{\"nodes\": ["};
    size_t            room = 4096 + strlen(m->nodes) + strlen(m->meshes) + strlen(m->materials) + strlen(m->accessors) +
                  strlen(m->views) + (m->channels ? strlen(m->channels) + strlen(m->samplers) : 0) + strlen(roots);
    json = malloc(room);
    int size = snprintf(json, room,
                        "%s%s%s%s]}], \"nodes\": [%s], \"meshes\": [%s], \"materials\": [%s], \"accessors\": [%s], "
                        "\"bufferViews\": [%s], \"buffers\": [{\"byteLength\": %zu}]%s%s%s%s%s}",
                        format[0], m->cameras ? m->cameras : "", format[1], roots, m->nodes, m->meshes, m->materials,
                        m->accessors, m->views, m->byte_count, m->channels ? ", \"animations\": [{\"channels\": [" : "",
                        m->channels ? m->channels : "", m->channels ? "], \"samplers\": [" : "",
                        m->channels ? m->samplers : "", m->channels ? "]}]" : "");
    if (!glb_write(path, json, (size_t)size, m->bytes, m->byte_count)) {
        fprintf(stderr, "cannot write %s\n", path);
        abort();
    }
    char *owned[] = {m->nodes,    m->meshes,  m->materials, m->accessors, m->views, m->channels,
                     m->samplers, m->cameras, m->bytes,     roots,        json};
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
        free(owned[i]);
    *m = (moving_scene){.nodes = NULL};
}
