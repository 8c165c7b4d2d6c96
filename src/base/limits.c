/* The limits that callers set, as rows: defaults, text and lists come from them. */
#include "base/limit_rows.h"

#include <string.h>

#define KIB       1024.0
#define MIB       (KIB * KIB)
#define GIB       (KIB * MIB)
#define AT(field) offsetof(lmn_limits, field)

const limit_row limit_rows[] = {
    {"time", LIMIT_SECONDS, AT(time_s), 600, 30, "Time by the clock to read one file, and to draw one picture."},
    {"memory", LIMIT_BYTES, AT(memory), 0, 2 * GIB,
     "Memory that reading or drawing may take, and each child process; none: three quarters of the machine's. The "
     "driver's is not counted."},
    {"triangles", LIMIT_COUNT, AT(triangles), 1e9, 2e7, "Triangles of a scene, instances counted."},
    {"pixels", LIMIT_COUNT, AT(pixels), 4e9, 7e7, "Pixels of a picture, samples counted."},
    {"textures", LIMIT_BYTES, AT(textures), 512 * MIB, 128 * MIB,
     "Bytes of all textures of a scene when decoded; beyond it the largest are halved until all fit."},
};
const size_t limit_row_count = sizeof limit_rows / sizeof *limit_rows;

void limit_put(lmn_limits *limits, const limit_row *row, double value)
{
    char *at = (char *)limits + row->at;
    if (row->kind == LIMIT_SECONDS)
        memcpy(at, &value, sizeof value);
    else
        memcpy(at, &(uint64_t){(uint64_t)value}, sizeof(uint64_t));
}

lmn_limits lmn_limits_standard(void)
{
    lmn_limits limits = {.struct_size = sizeof limits};
    for (size_t i = 0; i < limit_row_count; i++)
        limit_put(&limits, &limit_rows[i], limit_rows[i].standard);
    return limits;
}

lmn_limits lmn_limits_safe(void)
{
    lmn_limits limits = {.struct_size = sizeof limits};
    for (size_t i = 0; i < limit_row_count; i++)
        limit_put(&limits, &limit_rows[i], limit_rows[i].safe);
    return limits;
}
