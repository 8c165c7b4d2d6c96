#include "model.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "picture.h"

static void point_of(const shape_part *p, uint32_t vertex, float out[3])
{
    dvec v = shape_point(p, vertex);
    out[0] = (float)v.x;
    out[1] = (float)v.y;
    out[2] = (float)v.z;
}

static void ply_vertices(FILE *file, const shape *s, bool normals)
{
    for (size_t i = 0; i < s->count; i++)
        for (uint32_t v = 0; v < s->parts[i].vertex_count; v++) {
            float values[6];
            point_of(&s->parts[i], v, values);
            if (normals) {
                dvec n = shape_normal(&s->parts[i], v);
                values[3] = (float)n.x;
                values[4] = (float)n.y;
                values[5] = (float)n.z;
            }
            fwrite(values, sizeof(float), normals ? 6 : 3, file);
        }
}

static void ply_faces(FILE *file, const shape *s)
{
    uint32_t base = 0;
    for (size_t i = 0; i < s->count; i++) {
        const shape_part *p = &s->parts[i];
        for (uint32_t k = 0; k < p->index_count; k += 3) {
            uint32_t corner[3] = {base + p->indices[k], base + p->indices[k + 1], base + p->indices[k + 2]};
            fputc(3, file);
            fwrite(corner, sizeof *corner, 3, file);
        }
        base += p->vertex_count;
    }
}

bool model_write_ply(const char *path, const shape *s)
{
    uint32_t vertices = 0, indices = 0;
    bool     normals = true;
    for (size_t i = 0; i < s->count; i++) {
        vertices += s->parts[i].vertex_count;
        indices += s->parts[i].index_count;
        normals = normals && s->parts[i].normals;
    }
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    fprintf(file,
            "ply\nformat binary_little_endian 1.0\nelement vertex %u\nproperty float x\nproperty float y\nproperty "
            "float z\n",
            vertices);
    if (normals)
        fprintf(file, "property float nx\nproperty float ny\nproperty float nz\n");
    fprintf(file, "element face %u\nproperty list uchar int vertex_indices\nend_header\n", indices / 3);
    ply_vertices(file, s, normals);
    ply_faces(file, s);
    return fclose(file) == 0;
}

bool model_write_stl(const char *path, const shape *s)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    char     header[80] = "binary";
    uint32_t count = 0;
    for (size_t i = 0; i < s->count; i++)
        count += s->parts[i].index_count / 3;
    fwrite(header, 1, sizeof header, file);
    fwrite(&count, sizeof count, 1, file);
    for (size_t i = 0; i < s->count; i++)
        for (uint32_t k = 0; k < s->parts[i].index_count; k += 3) {
            float    facet[12] = {0};
            uint16_t attribute = 0;
            for (uint32_t c = 0; c < 3; c++)
                point_of(&s->parts[i], s->parts[i].indices[k + c], facet + 3 + 3 * c);
            fwrite(facet, sizeof *facet, 12, file);
            fwrite(&attribute, sizeof attribute, 1, file);
        }
    return fclose(file) == 0;
}

/* --- GLB ------------------------------------------------------------------------------------------------ */

/* JSON pieces in one stream each, and the binary chunk. */
typedef struct glb {
    FILE  *views, *accessors, *meshes, *nodes, *materials, *images, *textures, *bin;
    char  *text[8];
    size_t size[8];
    int    view_count, accessor_count, image_count;
} glb;

static void separate(FILE *list)
{
    if (ftell(list) > 0)
        fputc(',', list);
}

static int put_view(glb *g, const void *data, size_t size)
{
    static const char zeros[4];
    long              at = ftell(g->bin);
    fwrite(data, 1, size, g->bin);
    fwrite(zeros, 1, (4 - size % 4) % 4, g->bin);
    separate(g->views);
    fprintf(g->views, "{\"buffer\":0,\"byteOffset\":%ld,\"byteLength\":%zu}", at, size);
    return g->view_count++;
}

static int put_floats(glb *g, const float *values, uint32_t count, int components)
{
    int   view = put_view(g, values, (size_t)count * (size_t)components * sizeof *values);
    float low[3], high[3];
    for (int k = 0; k < components; k++) {
        low[k] = high[k] = values[k];
        for (uint32_t i = 0; i < count; i++) {
            float v = values[i * (uint32_t)components + (uint32_t)k];
            low[k] = v < low[k] ? v : low[k];
            high[k] = v > high[k] ? v : high[k];
        }
    }
    separate(g->accessors);
    fprintf(g->accessors, "{\"bufferView\":%d,\"componentType\":5126,\"count\":%u,\"type\":\"VEC%d\",\"min\":[", view,
            count, components);
    for (int k = 0; k < components; k++)
        fprintf(g->accessors, "%s%.9g", k ? "," : "", (double)low[k]);
    fprintf(g->accessors, "],\"max\":[");
    for (int k = 0; k < components; k++)
        fprintf(g->accessors, "%s%.9g", k ? "," : "", (double)high[k]);
    fprintf(g->accessors, "]}");
    return g->accessor_count++;
}

static int put_image(glb *g, const uint8_t *pixels, int side)
{
    size_t   size = 0;
    uint8_t *png = picture_encode_rgba(pixels, side, side, &size);
    int      view = put_view(g, png, size);
    free(png);
    separate(g->images);
    separate(g->textures);
    fprintf(g->images, "{\"bufferView\":%d,\"mimeType\":\"image/png\"}", view);
    fprintf(g->textures, "{\"source\":%d}", g->image_count);
    return g->image_count++;
}

static void put_material(glb *g, const shape_part *p)
{
    int texture = p->texture ? put_image(g, p->texture, p->texture_size) : -1;
    int bumps = p->normal_map ? put_image(g, p->normal_map, p->texture_size) : -1;
    separate(g->materials);
    fprintf(g->materials, "{\"pbrMetallicRoughness\":{\"baseColorFactor\":[%.9g,%.9g,%.9g,%.9g]", (double)p->colour[0],
            (double)p->colour[1], (double)p->colour[2], (double)p->colour[3]);
    if (texture >= 0)
        fprintf(g->materials, ",\"baseColorTexture\":{\"index\":%d}", texture);
    fprintf(g->materials, "}%s", p->colour[3] < 1 ? ",\"alphaMode\":\"BLEND\"" : "");
    if (bumps >= 0)
        fprintf(g->materials, ",\"normalTexture\":{\"index\":%d}", bumps);
    fprintf(g->materials, "}");
}

static void put_part(glb *g, const shape_part *p, size_t index)
{
    int positions = put_floats(g, p->positions[0], p->vertex_count, 3);
    int normals = p->normals ? put_floats(g, p->normals[0], p->vertex_count, 3) : -1;
    int uvs = p->uvs ? put_floats(g, p->uvs[0], p->vertex_count, 2) : -1;
    int view = put_view(g, p->indices, p->index_count * sizeof *p->indices);
    separate(g->accessors);
    fprintf(g->accessors, "{\"bufferView\":%d,\"componentType\":5125,\"count\":%u,\"type\":\"SCALAR\"}", view,
            p->index_count);
    int indices = g->accessor_count++;
    separate(g->meshes);
    fprintf(g->meshes, "{\"primitives\":[{\"attributes\":{\"POSITION\":%d", positions);
    if (normals >= 0)
        fprintf(g->meshes, ",\"NORMAL\":%d", normals);
    if (uvs >= 0)
        fprintf(g->meshes, ",\"TEXCOORD_0\":%d", uvs);
    fprintf(g->meshes, "},\"indices\":%d,\"material\":%zu}]}", indices, index);
    separate(g->nodes);
    fprintf(g->nodes, "{\"name\":\"%s\",\"mesh\":%zu", p->name, index);
    if (p->has_matrix)
        for (int k = 0; k < 16; k++)
            fprintf(g->nodes, "%s%.17g%s", k ? "," : ",\"matrix\":[", p->matrix[k], k == 15 ? "]" : "");
    fprintf(g->nodes, "}");
    put_material(g, p);
}

static bool glb_save(const char *path, const char *json, size_t json_size, const char *bin, size_t bin_size)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    uint32_t pad = (4 - (uint32_t)json_size % 4) % 4, json_total = (uint32_t)json_size + pad;
    uint32_t head[5] = {0x46546C67u, 2, 12 + 8 + json_total + 8 + (uint32_t)bin_size, json_total, 0x4E4F534Au};
    uint32_t middle[2] = {(uint32_t)bin_size, 0x004E4942u};
    fwrite(head, sizeof *head, 5, file);
    fwrite(json, 1, json_size, file);
    fwrite("   ", 1, pad, file);
    fwrite(middle, sizeof *middle, 2, file);
    fwrite(bin, 1, bin_size, file);
    return fclose(file) == 0;
}

bool model_write_glb(const char *path, const shape *s)
{
    glb    g = {0};
    FILE **lists[8] = {&g.views, &g.accessors, &g.meshes, &g.nodes, &g.materials, &g.images, &g.textures, &g.bin};
    for (int i = 0; i < 8; i++)
        *lists[i] = open_memstream(&g.text[i], &g.size[i]);
    for (size_t i = 0; i < s->count; i++)
        put_part(&g, &s->parts[i], i);
    for (int i = 0; i < 8; i++)
        fclose(*lists[i]);
    char  *json = NULL;
    size_t size = 0;
    FILE  *out = open_memstream(&json, &size);
    fprintf(out, "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[");
    for (size_t i = 0; i < s->count; i++)
        fprintf(out, "%s%zu", i ? "," : "", i);
    fprintf(out, "]}],\"nodes\":[%s],\"meshes\":[%s],\"materials\":[%s],\"accessors\":[%s],\"bufferViews\":[%s],",
            g.text[3], g.text[2], g.text[4], g.text[1], g.text[0]);
    if (g.image_count)
        fprintf(out, "\"images\":[%s],\"textures\":[%s],", g.text[5], g.text[6]);
    fprintf(out, "\"buffers\":[{\"byteLength\":%zu}]}", g.size[7]);
    fclose(out);
    bool saved = glb_save(path, json, size, g.text[7], g.size[7]);
    for (int i = 0; i < 8; i++)
        free(g.text[i]);
    free(json);
    return saved;
}

bool model_write(const char *path, const shape *s)
{
    const char *ending = strrchr(path, '.');
    if (ending && strcmp(ending, ".glb") == 0)
        return model_write_glb(path, s);
    return ending && strcmp(ending, ".stl") == 0 ? model_write_stl(path, s) : model_write_ply(path, s);
}
