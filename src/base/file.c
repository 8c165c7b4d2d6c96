#include "base/file.h"

#include <errno.h>
#include <fcntl.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/limits.h"
#include "base/memory.h"

enum { MAP_FROM_BYTES = 1 << 16 };

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
        ssize_t got = read(descriptor, bytes + done, size - done);
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
    long page = sysconf(_SC_PAGESIZE);
    /* A mapping whose last page has room left ends in a NUL byte by itself; otherwise the file is read. */
    if (size >= MAP_FROM_BYTES && page > 0 && size % (size_t)page != 0) {
        void *mapping = mmap(NULL, size, PROT_READ, MAP_PRIVATE, descriptor, 0);
        if (mapping != MAP_FAILED) {
            close(descriptor);
            *out = (file_data){.data = mapping, .size = size, .mapping = mapping, .mapping_size = size};
            return LMN_OK;
        }
    }
    return read_all(out, descriptor, size, path, error);
}

void file_data_release(file_data *data)
{
    if (data->mapping)
        munmap(data->mapping, data->mapping_size);
    else
        mem_free((void *)data->data);
    memset(data, 0, sizeof *data);
}

static bool write_all(int descriptor, const unsigned char *bytes, size_t size)
{
    while (size > 0) {
        ssize_t put = write(descriptor, bytes, size);
        if (put < 0 && errno == EINTR)
            continue;
        if (put <= 0)
            return false;
        bytes += put;
        size -= (size_t)put;
    }
    return true;
}

static lmn_status refuse_write(lmn_error *error, const char *path, int problem)
{
    return error_in_file(error, LMN_WRITE, path, 0, "cannot write: %s", strerror(problem));
}

/* Devices and pipes cannot be replaced by a rename; they are written straight. So is what /dev/stdout and the like lead
 * to: it belongs to whoever opened it. */
static lmn_status store_straight(const char *path, const void *data, size_t size, lmn_error *error)
{
    int descriptor = open(path, O_WRONLY | O_TRUNC | O_CLOEXEC);
    if (descriptor < 0)
        return refuse_write(error, path, errno);
    bool good = write_all(descriptor, data, size);
    int problem = errno;
    if (close(descriptor) != 0 && good) {
        good = false;
        problem = errno;
    }
    return good ? LMN_OK : refuse_write(error, path, problem);
}

static lmn_status store_beside(const char *path, const void *data, size_t size, mode_t mode, lmn_error *error)
{
    size_t room = strlen(path) + 16;
    char *beside = mem_alloc(room);
    if (!beside)
        return error_memory(error);
    snprintf(beside, room, "%s.XXXXXX", path);
    int descriptor = mkstemp(beside);
    if (descriptor < 0) {
        lmn_status status = refuse_write(error, path, errno);
        error_hint(error, "give a path in a folder that exists and may be written");
        mem_free(beside);
        return status;
    }
    bool good = write_all(descriptor, data, size) && fchmod(descriptor, mode) == 0;
    int problem = errno;
    if (close(descriptor) != 0 && good) {
        good = false;
        problem = errno;
    }
    if (good && rename(beside, path) != 0) {
        good = false;
        problem = errno;
    }
    if (!good)
        unlink(beside);
    mem_free(beside);
    return good ? LMN_OK : refuse_write(error, path, problem);
}

lmn_status file_store(const char *path, const void *data, size_t size, lmn_error *error)
{
    if (strcmp(path, "-") == 0) {
        if (!write_all(STDOUT_FILENO, data, size))
            return refuse_write(error, "standard output", errno);
        return LMN_OK;
    }
    struct stat facts;
    bool exists = stat(path, &facts) == 0;
    if (exists && S_ISDIR(facts.st_mode))
        return error_in_file(error, LMN_WRITE, path, 0, "cannot write: this is a folder");
    if (exists && (!S_ISREG(facts.st_mode) || strncmp(path, "/dev/", 5) == 0))
        return store_straight(path, data, size, error);
    mode_t mask = umask(0);
    umask(mask);
    /* A link stays a link: the file that it names is the one that is replaced. */
    char *named = exists ? realpath(path, NULL) : NULL;
    lmn_status status = store_beside(named ? named : path, data, size, exists ? facts.st_mode & 0777 : 0666 & ~mask, error);
    free(named);
    return status;
}

lmn_status file_make_folder(const char *path, lmn_error *error)
{
    char *part = mem_copy_text(path);
    if (!part)
        return error_memory(error);
    for (char *at = part + 1;; at++) {
        if (*at != '/' && *at != '\0')
            continue;
        char kept = *at;
        *at = '\0';
        if (mkdir(part, 0777) != 0 && errno != EEXIST) {
            lmn_status status = error_in_file(error, LMN_WRITE, part, 0, "cannot make the folder: %s", strerror(errno));
            mem_free(part);
            return status;
        }
        *at = kept;
        if (kept == '\0')
            break;
    }
    mem_free(part);
    struct stat facts;
    if (stat(path, &facts) != 0 || !S_ISDIR(facts.st_mode))
        return error_in_file(error, LMN_WRITE, path, 0, "this is not a folder");
    return LMN_OK;
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
    char *joined = mem_alloc(folder + length + 1);
    if (!joined)
        return NULL;
    memcpy(joined, path, folder);
    memcpy(joined + folder, name, length + 1);
    return joined;
}
