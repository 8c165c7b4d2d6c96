/* Is a PNG whole? All of its parts are there, in their order and unharmed. */
#include <string.h>
#include <zlib.h>

#include "base/file.h"
#include "film/film.h"

enum { SIGNATURE = 8, AROUND = 12, HEADER = 13 };

static uint32_t be32(const unsigned char *at)
{
    return (uint32_t)at[0] << 24 | (uint32_t)at[1] << 16 | (uint32_t)at[2] << 8 | at[3];
}

/* The part at this place: length, type, content, checksum. False when it runs over the end or is harmed. */
static bool read_part(const unsigned char *at, size_t left, size_t *size)
{
    if (left < AROUND)
        return false;
    *size = be32(at);
    return *size <= left - AROUND && crc32(0, at + 4, (uInt)(*size + 4)) == be32(at + 8 + *size);
}

static bool is_header(const unsigned char *at, size_t size, int width, int height)
{
    return size == HEADER && memcmp(at + 4, "IHDR", 4) == 0 && be32(at + 8) == (uint32_t)width &&
           be32(at + 12) == (uint32_t)height;
}

static bool is_whole(const unsigned char *bytes, size_t size, int width, int height)
{
    static const unsigned char signature[SIGNATURE] = {0x89, 'P', 'N', 'G', 0x0D, 0x0A, 0x1A, 0x0A};
    if (size < SIGNATURE || memcmp(bytes, signature, SIGNATURE) != 0)
        return false;
    bool pixels = false;
    for (size_t at = SIGNATURE, part; read_part(bytes + at, size - at, &part); at += part + AROUND) {
        if (at == SIGNATURE && !is_header(bytes + at, part, width, height))
            return false;
        pixels = pixels || memcmp(bytes + at + 4, "IDAT", 4) == 0;
        if (memcmp(bytes + at + 4, "IEND", 4) == 0)
            return pixels && at + part + AROUND == size;
    }
    return false;
}

bool film_picture_is_whole(const char *path, int width, int height)
{
    file_data file = {0};
    if (file_load(&file, path, NULL) != LMN_OK)
        return false;
    bool whole = is_whole(file.data, file.size, width, height);
    file_data_release(&file);
    return whole;
}
