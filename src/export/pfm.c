/* PFM: floats with a three-line header; a negative scale says little-endian. */
#include "export/export.h"

#include <stdio.h>
#include <string.h>

#include "base/memory.h"

lmn_status export_pfm(export_bytes *out, const float *values, int channels, int width, int height, lmn_error *error)
{
    char   header[64];
    int    length = snprintf(header, sizeof header, "%s\n%d %d\n-1.0\n", channels == 3 ? "PF" : "Pf", width, height);
    size_t size = (size_t)width * (size_t)height * (size_t)channels * sizeof(float);
    out->data = mem_alloc((size_t)length + size);
    if (!out->data)
        return error_memory(error);
    memcpy(out->data, header, (size_t)length);
    memcpy(out->data + length, values, size);
    out->size = (size_t)length + size;
    return LMN_OK;
}
