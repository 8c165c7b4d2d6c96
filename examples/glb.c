/* The container of a .glb file. */
#include "glb.h"

#include <stdio.h>

static void put_word(FILE *file, size_t word)
{
    for (int k = 0; k < 4; k++)
        fputc((int)(word >> (8 * k) & 255), file);
}

bool glb_write(const char *path, const char *json, size_t json_size, const char *bytes, size_t byte_count)
{
    FILE *file = fopen(path, "wb");
    if (!file)
        return false;
    size_t padding = (4 - json_size % 4) % 4;
    fwrite("glTF", 1, 4, file);
    put_word(file, 2);
    put_word(file, 12 + 8 + json_size + padding + 8 + byte_count);
    put_word(file, json_size + padding);
    fwrite("JSON", 1, 4, file);
    fwrite(json, 1, json_size, file);
    fwrite("   ", 1, padding, file);
    put_word(file, byte_count);
    fwrite("BIN\0", 1, 4, file);
    fwrite(bytes, 1, byte_count, file);
    bool good = !ferror(file);
    return fclose(file) == 0 && good;
}
