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
    size_t had = *text ? strlen(*text) : 0, more = strlen(piece);
    *text = realloc(*text, had + more + 1);
    memcpy(*text + had, piece, more + 1);
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

static int add_node(moving_scene *m, double x, double y, double z)
{
    m->nodes = realloc(m->nodes, (size_t)(m->node_count + 1) * sizeof *m->nodes);
    moving_node *node = &m->nodes[m->node_count];
    *node = (moving_node){.parent = -1};
    snprintf(node->name, sizeof node->name, "node%d", m->node_count);
    add(&node->text, "\"translation\": [%.17g, %.17g, %.17g]", x, y, z);
    return m->node_count++;
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
    int node = add_node(m, x, y, z);
    add(&m->nodes[node].text, ", \"mesh\": %d", m->mesh_count++);
    return node;
}

void moving_scene_begin(moving_scene *m)
{
    *m = (moving_scene){.nodes = NULL};
}

/* The last `faces` of a box's six. */
static int add_box(moving_scene *m, const double at[3], const double half[3], const double colour[3], int faces)
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
    return add_mesh(m, at[0], at[1], at[2], (const float(*)[3])positions, (const float(*)[3])normals, 24,
                    indices + 36 - 6 * faces, 6 * faces, reach, colour);
}

int moving_scene_box(moving_scene *m, double x, double y, double z, const double half[3], const double colour[3])
{
    return add_box(m, (const double[]){x, y, z}, half, colour, 6);
}

int moving_scene_plate(moving_scene *m, double x, double y, double z, const double half[3], const double colour[3])
{
    return add_box(m, (const double[]){x, y, z}, half, colour, 1);
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
            /* At the poles one of the two has no area. */
            int from = row == 0 ? 3 : 0, count = row == 0 || row == ROWS - 1 ? 3 : 6;
            memcpy(&indices[n], &order[from], (size_t)count * sizeof *order);
            n += count;
        }
    return add_mesh(m, x, y, z, (const float(*)[3])positions, (const float(*)[3])normals, VERTICES, indices, n, radius,
                    colour);
}

typedef struct round_mesh {
    float    positions[320][3], normals[320][3];
    unsigned indices[1200];
    int      vertices, index_count;
} round_mesh;

static int add_vertex(round_mesh *r, double x, double y, double z, double nx, double ny, double nz)
{
    const double p[3] = {x, y, z}, n[3] = {nx, ny, nz};
    for (int k = 0; k < 3; k++) {
        r->positions[r->vertices][k] = (float)p[k];
        r->normals[r->vertices][k] = (float)n[k];
    }
    return r->vertices++;
}

static void add_triangle(round_mesh *r, int a, int b, int c)
{
    const int corners[3] = {a, b, c};
    for (int k = 0; k < 3; k++)
        r->indices[r->index_count++] = (unsigned)corners[k];
}

int moving_scene_cylinder(moving_scene *m, double x, double y, double z, double radius, double half_length,
                          const double colour[3])
{
    enum { COLUMNS = 64 };
    static round_mesh r;
    r.vertices = r.index_count = 0;
    int back = add_vertex(&r, 0, 0, -half_length, 0, 0, -1), front = add_vertex(&r, 0, 0, half_length, 0, 0, 1);
    for (int i = 0; i <= COLUMNS; i++) {
        double phi = 2 * 3.141592653589793 * i / COLUMNS, c = cos(phi), s = sin(phi);
        int    a = add_vertex(&r, radius * c, radius * s, -half_length, 0, 0, -1);
        add_vertex(&r, radius * c, radius * s, -half_length, c, s, 0);
        add_vertex(&r, radius * c, radius * s, half_length, c, s, 0);
        add_vertex(&r, radius * c, radius * s, half_length, 0, 0, 1);
        if (i == COLUMNS)
            continue;
        add_triangle(&r, back, a + 4, a);
        add_triangle(&r, a + 1, a + 5, a + 6);
        add_triangle(&r, a + 1, a + 6, a + 2);
        add_triangle(&r, front, a + 3, a + 7);
    }
    return add_mesh(m, x, y, z, (const float(*)[3])r.positions, (const float(*)[3])r.normals, r.vertices, r.indices,
                    r.index_count, fmax(radius, half_length), colour);
}

int moving_scene_joint(moving_scene *m, double x, double y, double z)
{
    return add_node(m, x, y, z);
}

void moving_scene_put_in(moving_scene *m, int node, int parent)
{
    m->nodes[node].parent = parent;
}

void moving_scene_name(moving_scene *m, int node, const char *name)
{
    snprintf(m->nodes[node].name, sizeof m->nodes[node].name, "%s", name);
}

static void add_keys(moving_scene *m, int node, const char *path, bool cubic, int count, const double *times,
                     const double *values)
{
    int    numbers = strcmp(path, "rotation") == 0 ? 4 : 3, all = cubic ? 3 * count : count;
    float *t = malloc((size_t)count * sizeof *t), *v = malloc((size_t)(all * numbers) * sizeof *v);
    char   bounds[80];
    for (int i = 0; i < count; i++)
        t[i] = (float)times[i];
    for (int i = 0; i < all * numbers; i++)
        v[i] = (float)values[i];
    snprintf(bounds, sizeof bounds, ", \"min\": [%.9g], \"max\": [%.9g]", (double)t[0], (double)t[count - 1]);
    int at = add_data(m, t, (size_t)count * sizeof *t, count, "SCALAR", false, bounds);
    int to = add_data(m, v, (size_t)(all * numbers) * sizeof *v, all, numbers == 4 ? "VEC4" : "VEC3", false, "");
    add(&m->samplers, "%s{\"input\": %d, \"output\": %d%s}", comma(m->channel_count), at, to,
        cubic ? ", \"interpolation\": \"CUBICSPLINE\"" : "");
    add(&m->channels, "%s{\"sampler\": %d, \"target\": {\"node\": %d, \"path\": \"%s\"}}", comma(m->channel_count),
        m->channel_count, node, path);
    m->channel_count++;
    free(t);
    free(v);
}

void moving_scene_keys(moving_scene *m, int node, const char *path, int count, const double *times,
                       const double *values)
{
    add_keys(m, node, path, false, count, times, values);
}

void moving_scene_cubic_keys(moving_scene *m, int node, const char *path, int count, const double *times,
                             const double *values)
{
    add_keys(m, node, path, true, count, times, values);
}

int moving_scene_camera(moving_scene *m, double x, double y, double z, bool orthographic, double size)
{
    int node = add_node(m, x, y, z);
    moving_scene_name(m, node, "eye");
    add(&m->nodes[node].text, ", \"camera\": 0");
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
    return node;
}

/* The nodes as JSON, and those that lie in none. */
static char *put_nodes(moving_scene *m, char **roots)
{
    char *all = NULL;
    for (int i = 0; i < m->node_count; i++) {
        add(&all, "%s{\"name\": \"%s\", %s", comma(i), m->nodes[i].name, m->nodes[i].text);
        int children = 0;
        for (int k = 0; k < m->node_count; k++)
            if (m->nodes[k].parent == i)
                add(&all, "%s%d", children++ ? ", " : ", \"children\": [", k);
        add(&all, children ? "]}" : "}");
        if (m->nodes[i].parent < 0)
            add(roots, "%s%d", comma(*roots != NULL), i);
        free(m->nodes[i].text);
    }
    return all;
}

void moving_scene_write(moving_scene *m, const char *path)
{
    char             *json = NULL, *roots = NULL, *nodes = put_nodes(m, &roots);
    const char *const format[] = {"{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"KHR_materials_unlit\"], ",
                                  "\"scene\": 0, \"scenes\": [{\"nodes\": ["};
    size_t            room = 4096 + strlen(nodes) + strlen(m->meshes) + strlen(m->materials) + strlen(m->accessors) +
                  strlen(m->views) + (m->channels ? strlen(m->channels) + strlen(m->samplers) : 0) + strlen(roots);
    json = malloc(room);
    int size = snprintf(json, room,
                        "%s%s%s%s]}], \"nodes\": [%s], \"meshes\": [%s], \"materials\": [%s], \"accessors\": [%s], "
                        "\"bufferViews\": [%s], \"buffers\": [{\"byteLength\": %zu}]%s%s%s%s%s}",
                        format[0], m->cameras ? m->cameras : "", format[1], roots, nodes, m->meshes, m->materials,
                        m->accessors, m->views, m->byte_count, m->channels ? ", \"animations\": [{\"channels\": [" : "",
                        m->channels ? m->channels : "", m->channels ? "], \"samplers\": [" : "",
                        m->channels ? m->samplers : "", m->channels ? "]}]" : "");
    if (!glb_write(path, json, (size_t)size, m->bytes, m->byte_count)) {
        fprintf(stderr, "cannot write %s\n", path);
        abort();
    }
    char *owned[] = {nodes,       m->meshes,  m->materials, m->accessors, m->views, m->channels,
                     m->samplers, m->cameras, m->bytes,     roots,        json};
    free(m->nodes);
    for (size_t i = 0; i < sizeof owned / sizeof *owned; i++)
        free(owned[i]);
    *m = (moving_scene){.nodes = NULL};
}
