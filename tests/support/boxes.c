#include "boxes.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { FACES = 6, VERTICES = 4 * FACES, INDICES = 6 * FACES };

static void put_face(int face, float (*positions)[3], float (*normals)[3], uint16_t *indices)
{
    int axis = face / 2, u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int k = 0; k < 4; k++) {
        float *p = positions[4 * face + k], *n = normals[4 * face + k];
        p[axis] = face & 1 ? 1 : -1;
        p[u] = (k == 1 || k == 2) == (face & 1) ? 1 : -1;
        p[v] = k > 1 ? 1 : -1;
        n[0] = n[1] = n[2] = 0;
        n[axis] = p[axis];
    }
    const int corners[6] = {0, 1, 2, 0, 2, 3};
    for (int k = 0; k < 6; k++)
        indices[6 * face + k] = (uint16_t)(4 * face + corners[k]);
}

/* A cube whose last face looks along +z, times 0 and 1, and of each box where it is then. */
static bool write_data(const char *path, const moving_box *boxes, int count)
{
    float    positions[VERTICES][3], normals[VERTICES][3], times[2] = {0, 1};
    uint16_t indices[INDICES];
    FILE    *file = fopen(path, "wb");
    bool     good = file != NULL;
    for (int face = 0; face < FACES; face++)
        put_face(face, positions, normals, indices);
    good = good && fwrite(positions, sizeof positions, 1, file) == 1 && fwrite(normals, sizeof normals, 1, file) == 1 &&
           fwrite(indices, sizeof indices, 1, file) == 1 && fwrite(times, sizeof times, 1, file) == 1;
    for (int i = 0; i < count && good; i++) {
        float ends[2][3];
        for (int k = 0; k < 3; k++) {
            ends[1][k] = (float)boxes[i].middle[k];
            ends[0][k] = (float)(boxes[i].middle[k] - boxes[i].moved[k]);
        }
        good = fwrite(ends, sizeof ends, 1, file) == 1;
    }
    return file && fclose(file) == 0 && good;
}

static void write_accessors(FILE *f, const char *data_name, int count)
{
    enum { NORMALS_AT = VERTICES * 12, INDICES_AT = 2 * NORMALS_AT, TIMES_AT = INDICES_AT + 2 * INDICES };
    fprintf(f,
            "\"buffers\": [{\"uri\": \"%s\", \"byteLength\": %d}],\n"
            "\"bufferViews\": [{\"buffer\": 0, \"byteOffset\": 0, \"byteLength\": %d}],\n\"accessors\": [\n"
            "{\"bufferView\": 0, \"byteOffset\": 0, \"componentType\": 5126, \"count\": %d, \"type\": \"VEC3\", "
            "\"min\": [-1, -1, -1], \"max\": [1, 1, 1]},\n"
            "{\"bufferView\": 0, \"byteOffset\": %d, \"componentType\": 5126, \"count\": %d, \"type\": \"VEC3\"},\n"
            "{\"bufferView\": 0, \"byteOffset\": %d, \"componentType\": 5123, \"count\": %d, \"type\": \"SCALAR\"},\n"
            "{\"bufferView\": 0, \"byteOffset\": %d, \"componentType\": 5123, \"count\": 6, \"type\": \"SCALAR\"},\n"
            "{\"bufferView\": 0, \"byteOffset\": %d, \"componentType\": 5126, \"count\": 2, \"type\": \"SCALAR\", "
            "\"min\": [0], \"max\": [1]}",
            data_name, TIMES_AT + 8 + 24 * count, TIMES_AT + 8 + 24 * count, VERTICES, NORMALS_AT, VERTICES, INDICES_AT,
            INDICES, INDICES_AT + 2 * (INDICES - 6), TIMES_AT);
    for (int i = 0; i < count; i++)
        fprintf(f,
                ",\n{\"bufferView\": 0, \"byteOffset\": %d, \"componentType\": 5126, \"count\": 2, \"type\": \"VEC3\"}",
                TIMES_AT + 8 + 24 * i);
    fprintf(f, "],\n");
}

static void write_nodes(FILE *f, const moving_box *boxes, int count)
{
    fprintf(f, "\"nodes\": [");
    for (int i = 0; i < count; i++) {
        const moving_box *b = &boxes[i];
        double            half = b->turn * (3.14159265358979323846 / 360);
        /* A node that moves, and below it the box with its size, so that children are not scaled. */
        fprintf(f, "%s{\"name\": \"%s-node\", \"translation\": [%.9g, %.9g, %.9g], \"children\": [%d", i ? ",\n" : "",
                b->name, b->middle[0], b->middle[1], b->middle[2], count + i);
        for (int k = i + 1; k < count; k++)
            if (boxes[k].parent == i)
                fprintf(f, ", %d", k);
        fprintf(f, "], \"rotation\": [0, 0, %.9g, %.9g]}", sin(half), cos(half));
    }
    for (int i = 0; i < count; i++)
        fprintf(f, ",\n{\"name\": \"%s\", \"mesh\": %d, \"scale\": [%.9g, %.9g, %.9g]}", boxes[i].name, i,
                boxes[i].half[0], boxes[i].half[1], boxes[i].half[2]);
    fprintf(f, "],\n\"scenes\": [{\"nodes\": [");
    for (int i = 0, put = 0; i < count; i++)
        if (boxes[i].parent < 0)
            fprintf(f, "%s%d", put++ ? ", " : "", i);
    fprintf(f, "]}], \"scene\": 0,\n");
}

static void write_animation(FILE *f, int count)
{
    fprintf(f, "\"animations\": [{\"samplers\": [");
    for (int i = 0; i < count; i++)
        fprintf(f, "%s{\"input\": 4, \"output\": %d}", i ? ", " : "", 5 + i);
    fprintf(f, "], \"channels\": [");
    for (int i = 0; i < count; i++)
        fprintf(f, "%s{\"sampler\": %d, \"target\": {\"node\": %d, \"path\": \"translation\"}}", i ? ", " : "", i, i);
    fprintf(f, "]}]}\n");
}

bool boxes_write(const char *path, const moving_box *boxes, int count)
{
    char        data_path[1024];
    const char *slash;
    snprintf(data_path, sizeof data_path, "%s.bin", path);
    slash = strrchr(data_path, '/');
    FILE *f = fopen(path, "w");
    if (!f || !write_data(data_path, boxes, count)) {
        if (f)
            fclose(f);
        return false;
    }
    fprintf(f, "{\"asset\": {\"version\": \"2.0\"}, \"extensionsUsed\": [\"KHR_materials_unlit\"],\n");
    write_accessors(f, slash ? slash + 1 : data_path, count);
    fprintf(f, "\"materials\": [");
    for (int i = 0; i < count; i++)
        fprintf(f,
                "%s{\"pbrMetallicRoughness\": {\"baseColorFactor\": [%.9g, %.9g, %.9g, 1]}, \"extensions\": "
                "{\"KHR_materials_unlit\": {}}}",
                i ? ",\n" : "", boxes[i].colour[0], boxes[i].colour[1], boxes[i].colour[2]);
    fprintf(f, "],\n\"meshes\": [");
    for (int i = 0; i < count; i++)
        fprintf(f,
                "%s{\"primitives\": [{\"attributes\": {\"POSITION\": 0, \"NORMAL\": 1}, \"indices\": %d, "
                "\"material\": %d}]}",
                i ? ",\n" : "", boxes[i].open ? 3 : 2, i);
    fprintf(f, "],\n");
    write_nodes(f, boxes, count);
    write_animation(f, count);
    return fclose(f) == 0;
}

void boxes_view(lmn_draw_desc *desc, int side)
{
    desc->width = desc->height = side;
    desc->eye_given = true;
    desc->eye[0] = desc->eye[1] = 0;
    desc->eye[2] = 1000;
    desc->target[0] = desc->target[1] = desc->target[2] = 0;
    desc->up[0] = desc->up[2] = 0;
    desc->up[1] = 1;
    desc->fov_deg = 2 * atan(0.01) * (180 / 3.14159265358979323846);
}
