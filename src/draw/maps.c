/* The maps as files: depth.pfm, normal.pfm, id.png, edge.png, shade.png, and the same for each layer. PNG rows run from the top, PFM rows from the bottom. */
#include "draw/maps.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/colour.h"
#include "base/file.h"
#include "base/memory.h"
#include "base/text.h"
#include "export/export.h"

enum { IDS_IN_16_BITS = 65535 };

static lmn_status store(const char *directory, const char *name, export_bytes *bytes, lmn_error *error)
{
    text path = {0};
    text_append(&path, "%s/%s", directory, name);
    char *finished = text_take(&path);
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
static lmn_status write_ids(const frame_maps *m, const layer_map *layer, size_t part_count, const char *directory, const char *name,
                            lmn_error *error)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    bool wide = part_count > IDS_IN_16_BITS;
    unsigned char *pixels = mem_calloc(count, 4);
    if (!pixels)
        return error_memory(error);
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            size_t from = (size_t)(m->height - 1 - y) * (size_t)m->width + (size_t)x;
            uint32_t id = layer ? layer[from].id : m->id[from];
            size_t at = (size_t)y * (size_t)m->width + (size_t)x;
            if (wide)
                memcpy(pixels + 4 * at, (unsigned char[]){(unsigned char)id, (unsigned char)(id >> 8), (unsigned char)(id >> 16), 255}, 4);
            else
                memcpy(pixels + 2 * at, &(uint16_t){(uint16_t)id}, 2);
        }
    export_bytes bytes;
    lmn_status status = wide ? export_png(&bytes, pixels, m->width, m->height, error)
                             : export_png_grey16(&bytes, (const uint16_t *)(const void *)pixels, m->width, m->height, error);
    mem_free(pixels);
    return status == LMN_OK ? store(directory, name, &bytes, error) : status;
}

/* RGBA, row 0 on top; frees the pixels. */
static lmn_status store_picture(const frame_maps *m, uint8_t *pixels, const char *directory, const char *name, lmn_error *error)
{
    export_bytes bytes;
    lmn_status status = export_png_raw(&bytes, pixels, m->width, m->height, error);
    mem_free(pixels);
    return status == LMN_OK ? store(directory, name, &bytes, error) : status;
}

static lmn_status write_rgba(const frame_maps *m, const float *values, bool is_colour, const char *directory, const char *name,
                             lmn_error *error)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    uint8_t *pixels = mem_alloc(count * 4);
    if (!pixels)
        return error_memory(error);
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            const float *v = &values[4 * ((size_t)(m->height - 1 - y) * (size_t)m->width + (size_t)x)];
            uint8_t *p = &pixels[4 * ((size_t)y * (size_t)m->width + (size_t)x)];
            for (int k = 0; k < 3; k++) {
                float straight = is_colour ? (v[3] > 0 ? v[k] / v[3] : 0) : v[k];
                p[k] = byte_of(is_colour ? colour_from_linear(straight) : straight);
            }
            p[3] = byte_of(v[3]);
        }
    return store_picture(m, pixels, directory, name, error);
}

static lmn_status write_layer_floats(const frame_maps *m, const layer_map *layer, int channels, const char *directory, const char *name,
                                     lmn_error *error)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    float *values = mem_alloc(count * (size_t)channels * sizeof *values);
    if (!values)
        return error_memory(error);
    for (size_t i = 0; i < count; i++)
        memcpy(&values[i * (size_t)channels], channels == 1 ? &layer[i].depth : layer[i].normal, (size_t)channels * sizeof *values);
    export_bytes bytes;
    lmn_status status = export_pfm(&bytes, values, channels, m->width, m->height, error);
    mem_free(values);
    return status == LMN_OK ? store(directory, name, &bytes, error) : status;
}

static lmn_status write_layer_bytes(const frame_maps *m, const layer_map *layer, bool shade, const char *directory, const char *name,
                                    lmn_error *error)
{
    size_t count = (size_t)m->width * (size_t)m->height;
    uint8_t *pixels = mem_alloc(count * 4);
    if (!pixels)
        return error_memory(error);
    for (int y = 0; y < m->height; y++)
        for (int x = 0; x < m->width; x++) {
            const layer_map *from = &layer[(size_t)(m->height - 1 - y) * (size_t)m->width + (size_t)x];
            memcpy(&pixels[4 * ((size_t)y * (size_t)m->width + (size_t)x)], shade ? from->shade : from->edge, 4);
        }
    return store_picture(m, pixels, directory, name, error);
}

/* layerK.depth.pfm, .normal.pfm, .id.png, .edge.png, .shade.png */
static lmn_status write_layer(const frame_maps *m, size_t index, size_t part_count, const char *directory, lmn_error *error)
{
    const layer_map *layer = m->layers[index];
    char name[48];
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
        status = write_layer_bytes(m, layer, false, directory, name, error);
    snprintf(name, sizeof name, "layer%zu.shade.png", index);
    return status == LMN_OK ? write_layer_bytes(m, layer, true, directory, name, error) : status;
}

lmn_status maps_write(const frame_maps *m, size_t part_count, const char *directory, lmn_error *error)
{
    lmn_status status = file_make_folder(directory, error);
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
        status = write_rgba(m, m->edge, false, directory, "edge.png", error);
    if (status == LMN_OK)
        status = write_rgba(m, m->shade, true, directory, "shade.png", error);
    for (size_t i = 0; i < m->layer_count && status == LMN_OK; i++)
        status = write_layer(m, i, part_count, directory, error);
    return status;
}
