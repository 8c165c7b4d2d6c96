#include "model.h"

#include <math.h>
#include <stdlib.h>

#include "glb.h"

typedef struct text {
    char  *bytes;
    size_t size;
    FILE  *stream;
} text;

/* The binary chunk and the JSON lists that grow while meshes are put into it. */
struct glb {
    text bytes, views, accessors, meshes;
    int  view_count, accessor_count, mesh_count;
};

static void text_start(text *t)
{
    *t = (text){0};
    t->stream = open_memstream(&t->bytes, &t->size);
    if (!t->stream)
        give_up();
}

static void text_end(text *t)
{
    if (fclose(t->stream) != 0)
        give_up();
}

/* target: 34962 for vertices, 34963 for indices, 0 for other things. */
static int put_view(glb *g, const void *bytes, size_t size, int target)
{
    static const char zeros[4];
    fprintf(g->views.stream, "%s{\"buffer\":0,\"byteOffset\":%ld,\"byteLength\":%zu", g->view_count ? "," : "",
            ftell(g->bytes.stream), size);
    fprintf(g->views.stream, target ? ",\"target\":%d}" : "}", target);
    fwrite(bytes, 1, size, g->bytes.stream);
    fwrite(zeros, 1, (4 - size % 4) % 4, g->bytes.stream);
    return g->view_count++;
}

int glb_put_floats(glb *g, const float *values, uint32_t count, int components, const char *type, int target)
{
    int view = put_view(g, values, (size_t)count * (size_t)components * sizeof *values, target);
    fprintf(g->accessors.stream, "%s{\"bufferView\":%d,\"componentType\":5126,\"count\":%u,\"type\":\"%s\"",
            g->accessor_count ? "," : "", view, count, type);
    for (int end = 0; end < 2; end++) {
        fprintf(g->accessors.stream, end ? ",\"max\":[" : ",\"min\":[");
        for (int k = 0; k < components; k++) {
            float most = values[k];
            for (uint32_t i = 1; i < count; i++) {
                float value = values[i * (uint32_t)components + (uint32_t)k];
                most = (end ? value > most : value < most) ? value : most;
            }
            fprintf(g->accessors.stream, "%s%.9g", k ? "," : "", (double)most);
        }
        fprintf(g->accessors.stream, "]");
    }
    fprintf(g->accessors.stream, "}");
    return g->accessor_count++;
}

static int put_indices(glb *g, const mesh *m)
{
    bool           small = m->point_count <= UINT16_MAX;
    size_t         size = small ? sizeof(uint16_t) : sizeof(uint32_t);
    unsigned char *bytes = malloc(m->index_count * size);
    if (!bytes)
        give_up();
    for (uint32_t i = 0; i < m->index_count; i++)
        for (size_t k = 0; k < size; k++)
            bytes[i * size + k] = (unsigned char)(m->indices[i] >> (8 * k));
    int view = put_view(g, bytes, m->index_count * size, 34963);
    free(bytes);
    fprintf(g->accessors.stream, ",{\"bufferView\":%d,\"componentType\":%d,\"count\":%u,\"type\":\"SCALAR\"}", view,
            small ? 5123 : 5125, m->index_count);
    return g->accessor_count++;
}

static void put_mesh(glb *g, const model_part *p, double units_per_metre)
{
    mesh m = {0};
    if (p->build)
        p->build(&m);
    else
        p->build_one(&m, p->number);
    drop_unused(&m);
    float *positions = malloc(m.point_count * 3 * sizeof *positions);
    if (!positions)
        give_up();
    for (uint32_t i = 0; i < m.point_count * 3; i++)
        positions[i] = (float)(m.points[i / 3].at[i % 3] / (GRID * units_per_metre));
    int vertices = glb_put_floats(g, positions, m.point_count, 3, "VEC3", 34962), indices = put_indices(g, &m);
    fprintf(g->meshes.stream, "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%d},\"indices\":%d,\"material\":%d}]}",
            g->mesh_count ? "," : "", vertices, indices, p->material);
    free(positions);
    free(m.points);
    free(m.indices);
    g->mesh_count++;
}

static bool same_mesh(const model_part *a, const model_part *b)
{
    return a->build == b->build && a->build_one == b->build_one && a->number == b->number && a->material == b->material;
}

static int *put_meshes(glb *g, const model *m)
{
    int *mesh_of = calloc((size_t)m->part_count, sizeof *mesh_of);
    if (!mesh_of)
        give_up();
    for (int i = 0; i < m->part_count; i++) {
        int like = 0;
        while (!same_mesh(&m->parts[like], &m->parts[i]))
            like++;
        mesh_of[i] = like < i ? mesh_of[like] : g->mesh_count;
        if (like == i)
            put_mesh(g, &m->parts[i], m->units_per_metre);
    }
    return mesh_of;
}

static void put_translation(FILE *json, const double at[3], double units_per_metre)
{
    if (at[0] != 0 || at[1] != 0 || at[2] != 0)
        fprintf(json, ",\"translation\":[%.7g,%.7g,%.7g]", at[0] / units_per_metre, at[1] / units_per_metre,
                at[2] / units_per_metre);
}

static void put_rotation(FILE *json, int quarter_turns)
{
    static const char *const turned[4] = {"", "0,0.70710678,0,0.70710678", "0,1,0,0", "0,-0.70710678,0,0.70710678"};
    if (quarter_turns % 4 != 0)
        fprintf(json, ",\"rotation\":[%s]", turned[quarter_turns % 4]);
}

/* Cameras look along −z; they are turned about y, then tilted. */
static void put_camera_node(FILE *json, const model *m, int index)
{
    const model_camera *c = &m->cameras[index];
    double              d[3] = {c->target[0] - c->at[0], c->target[1] - c->at[1], c->target[2] - c->at[2]};
    double              turn = atan2(-d[0], -d[2]) / 2, tilt = atan2(d[1], hypot(d[0], d[2])) / 2;
    fprintf(json, ",{\"name\":\"%s\",\"camera\":%d", c->name, index);
    put_translation(json, c->at, m->units_per_metre);
    fprintf(json, ",\"rotation\":[%.6f,%.6f,%.6f,%.6f]}", cos(turn) * sin(tilt), sin(turn) * cos(tilt),
            -sin(turn) * sin(tilt), cos(turn) * cos(tilt));
}

static const char *put_child(FILE *json, const char *before, int node)
{
    fprintf(json, "%s%d", before, node);
    return ",";
}

/* What is in group `inside` − 1: groups, parts, cameras. In none are groups alone; cameras are roots then. */
static void put_children(FILE *json, const model *m, int inside)
{
    const char *before = ",\"children\":[";
    for (int k = 0; k < m->group_count; k++)
        if (m->groups[k].inside == inside)
            before = put_child(json, before, 1 + k);
    for (int i = 0; i < m->part_count && inside; i++)
        if (1 + m->parts[i].group == inside)
            before = put_child(json, before, 1 + m->group_count + i);
    for (int i = 0; i < m->camera_count && inside; i++)
        if (m->cameras[i].inside == inside)
            before = put_child(json, before, 1 + m->group_count + m->part_count + i);
    fprintf(json, "]}");
}

/* Node 0 is the whole, then come the groups, then the parts, then the cameras. Every group has something in it. */
static void put_nodes(FILE *json, const model *m, const int *mesh_of)
{
    fprintf(json, "\"nodes\":[{\"name\":\"%s\"", m->name);
    put_children(json, m, 0);
    for (int k = 0; k < m->group_count; k++) {
        fprintf(json, ",{\"name\":\"%s\"", m->groups[k].name);
        put_translation(json, m->groups[k].at, m->units_per_metre);
        put_rotation(json, m->groups[k].quarter_turns);
        put_children(json, m, 1 + k);
    }
    for (int i = 0; i < m->part_count; i++) {
        fprintf(json, ",{\"name\":\"%s\",\"mesh\":%d", m->parts[i].name, mesh_of[i]);
        put_translation(json, m->parts[i].at, m->units_per_metre);
        fprintf(json, "}");
    }
    for (int i = 0; i < m->camera_count; i++)
        put_camera_node(json, m, i);
    fprintf(json, "],");
}

static void put_cameras(FILE *json, const model *m)
{
    for (int i = 0; i < m->camera_count; i++)
        fprintf(json, "%s{\"name\":\"%s\",\"type\":\"perspective\",\"perspective\":{\"yfov\":%.5f,\"znear\":0.1}}",
                i ? "," : "\"cameras\":[", m->cameras[i].name, m->cameras[i].fov_y * PI / 180);
    if (m->camera_count)
        fprintf(json, "],");
}

static void put_materials(FILE *json, const model *m)
{
    fprintf(json, "\"materials\":[");
    for (int k = 0; k < m->material_count; k++) {
        const model_material *one = &m->materials[k];
        fprintf(
            json,
            "%s{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.3f,%.3f,%.3f,1],\"metallicFactor\":0,"
            "\"roughnessFactor\":0.6}}",
            k ? "," : "", one->name, one->colour[0], one->colour[1], one->colour[2]);
    }
    fprintf(json, "],");
}

bool model_write(const model *m, const char *path)
{
    glb  g = {0};
    text json, *lists[] = {&g.bytes, &g.views, &g.accessors, &g.meshes, &json};
    for (int k = 0; k < 5; k++)
        text_start(lists[k]);
    fprintf(json.stream,
            "{\"asset\":{\"version\":\"2.0\",\"generator\":\"Limner %s\",\"copyright\":\"CC0-1.0\"},"
            "\"scene\":0,\"scenes\":[{\"nodes\":[0",
            m->generator);
    for (int i = 0; i < m->camera_count; i++)
        if (!m->cameras[i].inside)
            fprintf(json.stream, ",%d", 1 + m->group_count + m->part_count + i);
    fprintf(json.stream, "]}],");
    int *mesh_of = put_meshes(&g, m);
    put_nodes(json.stream, m, mesh_of);
    free(mesh_of);
    put_cameras(json.stream, m);
    if (m->animate)
        m->animate(&g, json.stream);
    put_materials(json.stream, m);
    for (int k = 0; k < 4; k++)
        text_end(lists[k]);
    fprintf(json.stream, "\"meshes\":[%s],\"accessors\":[%s],\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%zu}]}",
            g.meshes.bytes, g.accessors.bytes, g.views.bytes, g.bytes.size);
    text_end(&json);
    bool saved = glb_write(path, json.bytes, json.size, g.bytes.bytes, g.bytes.size);
    for (int k = 0; k < 5; k++)
        free(lists[k]->bytes);
    return saved;
}
