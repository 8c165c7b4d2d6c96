/* The maps as files: depth.pfm, normal.pfm, id.png, edge.png, shade.png, uncertainty.pfm where something is
 * perturbed, direction.pfm where strokes follow the form on the page, velocity.pfm where the model moves, and the same
 * for each layer; where something is perturbed also what compositions find, perturbed.*. PNG rows run from the top, PFM
 * rows from the bottom. */
#include "draw/maps.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/colour.h"
#include "base/file_store.h"
#include "base/memory.h"
#include "base/text.h"
#include "export/export.h"

enum { IDS_IN_16_BITS = 65535 };

static lmn_status store(const char *directory, const char *name, export_bytes *bytes, lmn_error *error)
{
    text path = {0};
    text_append(&path, "%s/%s", directory, name);
    char      *finished = text_take(&path);
    lmn_status status = finished ? file_store(finished, bytes->data, bytes->size, error) : error_memory(error);
    mem_free(finished);
    mem_free(bytes->data);
    bytes->data = NULL;
    return status;
}

static uint8_t byte_of(float v)
{
    return v > 0 ? v < 1 ? (uint8_t)lroundf(v * 255) : 255 : 0;
}

/* Part ids of a map, or of one of its layers when that is not NULL. */
static lmn_status write_ids(const frame_maps *m, const layer_map *layer, size_t part_count, const char *directory,
                            const char *name, lmn_error *error)
{
    size_t         count = (size_t)m->width * (size_t)m->height;
    bool           wide = part_count > IDS_IN_16_BITS;
    unsigned char *pixels = mem_calloc(count, 4);
    if (!pixels)
        return error_memory(error);
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            size_t   from = (size_t)(m->height - 1 - y) * (size_t)m->width + (size_t)x;
            uint32_t id = layer ? layer[from].id : m->id[from];
            size_t   at = (size_t)y * (size_t)m->width + (size_t)x;
            if (wide)
                memcpy(pixels + 4 * at,
                       (unsigned char[]){(unsigned char)id, (unsigned char)(id >> 8), (unsigned char)(id >> 16), 255},
                       4);
            else
                memcpy(pixels + 2 * at, &(uint16_t){(uint16_t)id}, 2);
        }
    export_bytes bytes;
    lmn_status   status =
        wide ? export_png(&bytes, pixels, m->width, m->height, error)
               : export_png_grey16(&bytes, (const uint16_t *)(const void *)pixels, m->width, m->height, error);
    mem_free(pixels);
    return status == LMN_OK ? store(directory, name, &bytes, error) : status;
}

typedef void texel_fn(const void *source, size_t index, uint8_t out[4]);

static void raw_texel(const void *source, size_t index, uint8_t out[4])
{
    for (size_t k = 0; k < 4; k++)
        out[k] = byte_of(((const float *)source)[4 * index + k]);
}

/* Premultiplied colour, with straight alpha. */
static void colour_texel(const void *source, size_t index, uint8_t out[4])
{
    const float *v = &((const float *)source)[4 * index];
    for (size_t k = 0; k < 3; k++)
        out[k] = byte_of(v[3] > 0 ? v[k] / v[3] : 0);
    out[3] = byte_of(v[3]);
}

static void layer_edge_texel(const void *source, size_t index, uint8_t out[4])
{
    memcpy(out, ((const layer_map *)source)[index].edge, 4);
}

static void layer_shade_texel(const void *source, size_t index, uint8_t out[4])
{
    memcpy(out, ((const layer_map *)source)[index].shade, 4);
}

/* An RGBA picture, row 0 on top, of a source whose row 0 is at the bottom. */
static lmn_status write_picture(const frame_maps *m, texel_fn *texel, const void *source, const char *directory,
                                const char *name, lmn_error *error)
{
    size_t   width = (size_t)m->width, height = (size_t)m->height;
    uint8_t *pixels = mem_alloc(width * height * 4);
    if (!pixels)
        return error_memory(error);
    for (size_t y = 0; y < height; y++)
        for (size_t x = 0; x < width; x++)
            texel(source, (height - 1 - y) * width + x, &pixels[4 * (y * width + x)]);
    export_bytes bytes;
    lmn_status   status = export_png_raw(&bytes, pixels, m->width, m->height, error);
    mem_free(pixels);
    return status == LMN_OK ? store(directory, name, &bytes, error) : status;
}

static lmn_status write_layer_floats(const frame_maps *m, const layer_map *layer, int channels, const char *directory,
                                     const char *name, lmn_error *error)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    float *values = mem_alloc(count * (size_t)channels * sizeof *values);
    if (!values)
        return error_memory(error);
    for (size_t i = 0; i < count; i++)
        memcpy(&values[i * (size_t)channels], channels == 1 ? &layer[i].depth : layer[i].normal,
               (size_t)channels * sizeof *values);
    export_bytes bytes;
    lmn_status   status = export_pfm(&bytes, values, channels, m->width, m->height, error);
    mem_free(values);
    return status == LMN_OK ? store(directory, name, &bytes, error) : status;
}

/* layerK.depth.pfm, .normal.pfm, .id.png, .edge.png, .shade.png */
static lmn_status write_layer(const frame_maps *m, size_t index, size_t part_count, const char *directory,
                              lmn_error *error)
{
    const layer_map *layer = m->layers.items[index];
    char             name[48];
    snprintf(name, sizeof name, "layer%zu.depth.pfm", index);
    lmn_status status = write_layer_floats(m, layer, 1, directory, name, error);
    snprintf(name, sizeof name, "layer%zu.normal.pfm", index);
    if (status == LMN_OK)
        status = write_layer_floats(m, layer, 3, directory, name, error);
    snprintf(name, sizeof name, "layer%zu.id.png", index);
    if (status == LMN_OK)
        status = write_ids(m, layer, part_count, directory, name, error);
    snprintf(name, sizeof name, "layer%zu.edge.png", index);
    if (status == LMN_OK)
        status = write_picture(m, layer_edge_texel, layer, directory, name, error);
    snprintf(name, sizeof name, "layer%zu.shade.png", index);
    return status == LMN_OK ? write_picture(m, layer_shade_texel, layer, directory, name, error) : status;
}

/* PREFIXperturbed.depth.pfm, .edge.png, .shade.png: what compositions find. */
static lmn_status write_perturbed(const frame_maps *m, const layer_map *layer, const char *prefix,
                                  const char *directory, lmn_error *error)
{
    char name[64];
    snprintf(name, sizeof name, "%sperturbed.depth.pfm", prefix);
    lmn_status status = write_layer_floats(m, layer, 1, directory, name, error);
    snprintf(name, sizeof name, "%sperturbed.edge.png", prefix);
    if (status == LMN_OK)
        status = write_picture(m, layer_edge_texel, layer, directory, name, error);
    snprintf(name, sizeof name, "%sperturbed.shade.png", prefix);
    return status == LMN_OK ? write_picture(m, layer_shade_texel, layer, directory, name, error) : status;
}

lmn_status maps_write(const frame_maps *m, size_t part_count, const char *directory, lmn_error *error)
{
    lmn_status   status = file_make_folder(directory, error);
    export_bytes bytes;
    if (status == LMN_OK)
        status = export_pfm(&bytes, m->depth, 1, m->width, m->height, error);
    if (status == LMN_OK)
        status = store(directory, "depth.pfm", &bytes, error);
    if (status == LMN_OK)
        status = export_pfm(&bytes, m->normal, 3, m->width, m->height, error);
    if (status == LMN_OK)
        status = store(directory, "normal.pfm", &bytes, error);
    if (status == LMN_OK)
        status = write_ids(m, NULL, part_count, directory, "id.png", error);
    if (status == LMN_OK)
        status = write_picture(m, raw_texel, m->edge, directory, "edge.png", error);
    if (status == LMN_OK)
        status = write_picture(m, colour_texel, m->shade, directory, "shade.png", error);
    if (status == LMN_OK && m->uncertainty) {
        status = export_pfm(&bytes, m->uncertainty, 3, m->width, m->height, error);
        if (status == LMN_OK)
            status = store(directory, "uncertainty.pfm", &bytes, error);
    }
    if (status == LMN_OK && m->direction) {
        status = export_pfm(&bytes, m->direction, 3, m->width, m->height, error);
        if (status == LMN_OK)
            status = store(directory, "direction.pfm", &bytes, error);
    }
    if (status == LMN_OK && m->velocity) {
        status = export_pfm(&bytes, m->velocity, 3, m->width, m->height, error);
        if (status == LMN_OK)
            status = store(directory, "velocity.pfm", &bytes, error);
    }
    for (size_t i = 0; i < m->layers.count && status == LMN_OK; i++)
        status = write_layer(m, i, part_count, directory, error);
    if (m->perturbed.count && status == LMN_OK)
        status = write_perturbed(m, m->perturbed.items[0], "", directory, error);
    for (size_t i = 0; i < m->perturbed_layers.count && status == LMN_OK; i++) {
        char prefix[32];
        snprintf(prefix, sizeof prefix, "layer%zu.", i);
        status = write_perturbed(m, m->perturbed_layers.items[i], prefix, directory, error);
    }
    return status;
}
