#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/work.h"

/* Between two of these a reader may be stopped. */
enum { READ_AT_ONCE = 1 << 24 };

static lmn_status refuse(int descriptor, lmn_error *error, const char *path, lmn_status status, const char *what)
{
    if (descriptor >= 0)
        close(descriptor);
    return error_in_file(error, status, path, 0, "%s", what);
}

static lmn_status read_all(file_data *out, int descriptor, size_t size, const char *path, lmn_error *error)
{
    unsigned char *bytes = mem_alloc(size + 1);
    if (!bytes) {
        close(descriptor);
        return error_memory(error);
    }
    size_t done = 0;
    while (done < size) {
        size_t  wanted = size - done < READ_AT_ONCE ? size - done : READ_AT_ONCE;
        ssize_t got = work_check(NULL) == LMN_OK ? read(descriptor, bytes + done, wanted) : 0;
        if (got < 0 && errno == EINTR)
            continue;
        if (got <= 0)
            break;
        done += (size_t)got;
    }
    if (done < size) {
        mem_free(bytes);
        return refuse(descriptor, error, path, LMN_READ, "the file ended or failed while it was read");
    }
    close(descriptor);
    bytes[size] = '\0';
    out->data = bytes;
    out->size = size;
    return LMN_OK;
}

lmn_status file_load(file_data *out, const char *path, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    int descriptor = open(path, O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0) {
        lmn_status status = error_in_file(error, LMN_READ, path, 0, "cannot open the file: %s", strerror(errno));
        if (errno == ENOENT)
            error_hint(error, "check the path; it is taken relative to the working directory");
        return status;
    }
    struct stat facts;
    if (fstat(descriptor, &facts) != 0)
        return refuse(descriptor, error, path, LMN_READ, strerror(errno));
    if (S_ISDIR(facts.st_mode))
        return refuse(descriptor, error, path, LMN_READ, "this is a folder, not a file");
    if (!S_ISREG(facts.st_mode))
        return refuse(descriptor, error, path, LMN_READ, "this is not a regular file");
    size_t size = (size_t)facts.st_size;
    if (size > LIMIT_FILE_BYTES)
        return refuse(descriptor, error, path, LMN_LIMIT, "the file is larger than 4 GiB");
    return read_all(out, descriptor, size, path, error);
}

void file_data_release(file_data *data)
{
    mem_free((void *)data->data);
    memset(data, 0, sizeof *data);
}

void file_data_cut(file_data *data, size_t size)
{
    unsigned char *kept = size < data->size ? mem_realloc((void *)data->data, size + 1) : NULL;
    if (!kept)
        return;
    kept[size] = '\0';
    *data = (file_data){kept, size};
}

void file_ending(const char *path, char *out, size_t size)
{
    out[0] = '\0';
    const char *name = strrchr(path, '/');
    const char *dot = strrchr(name ? name : path, '.');
    if (!dot || strlen(dot) >= size)
        return;
    size_t i = 0;
    for (; dot[i]; i++)
        out[i] = dot[i] >= 'A' && dot[i] <= 'Z' ? (char)(dot[i] - 'A' + 'a') : dot[i];
    out[i] = '\0';
}

char *file_beside(const char *path, const char *name)
{
    const char *slash = strrchr(path, '/');
    if (name[0] == '/' || !slash)
        return mem_copy_text(name);
    size_t folder = (size_t)(slash - path) + 1;
    size_t length = strlen(name);
    char  *joined = mem_alloc(folder + length + 1);
    if (!joined)
        return NULL;
    memcpy(joined, path, folder);
    memcpy(joined + folder, name, length + 1);
    return joined;
}
