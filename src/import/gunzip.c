#include "import/gunzip.h"

#include <limits.h>
#include <string.h>
#include <zlib.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"

/* How large it may become. Text of models is packed to a tenth; a hundredth would say the same all the time. */
static size_t most_of(size_t packed)
{
    size_t most = packed < LIMIT_FILE_BYTES / LIMIT_GZIP_RATIO ? packed * LIMIT_GZIP_RATIO : LIMIT_FILE_BYTES;
    return most < LIMIT_GZIP_BYTES ? LIMIT_GZIP_BYTES : most;
}

enum { STEP = 1 << 22, GZIP_WINDOW = 15 + 16 };

typedef struct unpacking {
    z_stream       stream;
    unsigned char *bytes;
    size_t         size, capacity, first, most; /* `first`: what is asked for at the beginning */
} unpacking;

static lmn_status grow(unpacking *u, lmn_error *error)
{
    if (u->size == u->most) {
        error_set(error, LMN_LIMIT, "unpacked it has more than %zu MiB", u->most >> 20);
        error_hint(error, "no model is packed so well; if it is one, unpack it with gunzip");
        return LMN_LIMIT;
    }
    size_t wanted = u->capacity ? u->capacity * 2 : u->first;
    wanted = wanted < u->most ? wanted : u->most;
    unsigned char *grown = mem_realloc(u->bytes, wanted + 1);
    if (!grown)
        return error_memory(error);
    u->bytes = grown;
    u->capacity = wanted;
    return LMN_OK;
}

/* Until the last member ends. What stands behind it and begins no other is left out, as gunzip does. */
static lmn_status unpack(unpacking *u, lmn_error *error)
{
    for (;;) {
        if (work_stopped())
            return work_check(error);
        lmn_status status = u->size == u->capacity ? grow(u, error) : LMN_OK;
        if (status != LMN_OK)
            return status;
        size_t room = u->capacity - u->size < STEP ? u->capacity - u->size : STEP;
        u->stream.next_out = u->bytes + u->size;
        u->stream.avail_out = (uInt)room;
        int result = inflate(&u->stream, Z_NO_FLUSH);
        u->size += room - u->stream.avail_out;
        if (result == Z_STREAM_END) {
            if (u->stream.avail_in < 2 || u->stream.next_in[0] != 0x1f || u->stream.next_in[1] != 0x8b)
                return LMN_OK;
            result = inflateReset(&u->stream);
        }
        if (result == Z_BUF_ERROR && u->stream.avail_in == 0)
            return error_set(error, LMN_FORMAT, "the packed file (gzip) is cut off");
        if (result == Z_MEM_ERROR)
            return error_memory(error);
        if (result != Z_OK && result != Z_BUF_ERROR)
            return error_set(error, LMN_FORMAT, "the packed file (gzip) is damaged: %s",
                             u->stream.msg ? u->stream.msg : "it ends in a wrong way");
    }
}

lmn_status gunzip(file_data *file, const char *path, lmn_error *error)
{
    if (file->size < 2 || file->data[0] != 0x1f || file->data[1] != 0x8b)
        return LMN_OK;
    unpacking  u = {.first = file->size * 8 + 4096, .most = most_of(file->size)};
    lmn_status status = LMN_OK;
    if (file->size > UINT_MAX)
        status = error_set(error, LMN_LIMIT, "a packed file has at most 4 GiB");
    u.stream.next_in = (Bytef *)(uintptr_t)file->data;
    u.stream.avail_in = (uInt)file->size;
    if (status == LMN_OK && inflateInit2(&u.stream, GZIP_WINDOW) != Z_OK)
        status = error_memory(error);
    else if (status == LMN_OK) {
        status = unpack(&u, error);
        inflateEnd(&u.stream);
    }
    file_data_release(file);
    if (status != LMN_OK) {
        mem_free(u.bytes);
        error_file(error, path);
        return status;
    }
    u.bytes[u.size] = '\0';
    *file = (file_data){.data = u.bytes, .size = u.size};
    return LMN_OK;
}

void gunzip_ending(const char *path, char *out, size_t size)
{
    char inner[1024];
    file_ending(path, out, size);
    size_t length = strlen(path);
    if (strcmp(out, ".gz") != 0 || length - 3 >= sizeof inner)
        return;
    memcpy(inner, path, length - 3);
    inner[length - 3] = '\0';
    file_ending(inner, out, size);
}
