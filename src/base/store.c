/* Kept textures: one file each, named by a hash of what it was made from, with that text inside to be sure, and a
 * checksum at the end. */
#include "base/store.h"

#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/file.h"
#include "base/file_store.h"
#include "base/memory.h"
#include "base/text.h"

enum { VERSION = 2, SIDE_MOST = 4096, LAYERS_MOST = 256, HEX_DIGITS = 16, PATH_CAPACITY = 4096 };

static const uint64_t KEPT_MOST = (uint64_t)256 << 20; /* bytes in the folder */
static const char     ENDING[] = ".texture";

/* As it lies in the file, in the machine's byte order, which the magic number tells. The description follows, the
 * levels, and the checksum. */
typedef struct header {
    uint32_t magic, version;
    uint64_t description_size;
    uint32_t width, height, layers, levels, format, clamped, nearest, stepped, similar;
    float    fact;
} header;

static const uint32_t MAGIC = 0x4c6d4e74;

uint64_t store_hash(const void *bytes, size_t size)
{
    const unsigned char *at = bytes;
    uint64_t             hash = UINT64_C(0xcbf29ce484222325);
    for (size_t i = 0; i < size; i++)
        hash = (hash ^ at[i]) * UINT64_C(0x100000001b3);
    return hash;
}

uint64_t store_hash_of_file(const char *path)
{
    file_data file;
    if (file_load(&file, path, NULL) != LMN_OK)
        return 0;
    uint64_t hash = store_hash(file.data, file.size);
    file_data_release(&file);
    return hash;
}

/* --- positions --------------------------------------------------------------------------------------------- */

/* The folder; false when nothing is to be kept. */
static bool find_folder(char *out, size_t capacity)
{
    const char *own = getenv("LIMNER_CACHE"), *shared = getenv("XDG_CACHE_HOME"), *home = getenv("HOME");
    int         length = 0;
    if (own)
        length = snprintf(out, capacity, "%s", own);
    else if (shared && shared[0] == '/') /* relative ones are to be ignored, says their specification */
        length = snprintf(out, capacity, "%s/limner", shared);
    else if (home && home[0])
        length = snprintf(out, capacity, "%s/.cache/limner", home);
    return length > 0 && (size_t)length < capacity;
}

static bool find_path(char *out, size_t capacity, const char *folder, const char *description)
{
    unsigned long long hash = store_hash(description, strlen(description));
    int                length = snprintf(out, capacity, "%s/%016llx%s", folder, hash, ENDING);
    return length > 0 && (size_t)length < capacity;
}

/* Is a file one of ours, or a half-written one that an earlier version left behind? Other files in the folder are
 * never touched. */
static bool is_ours(const char *name)
{
    size_t digits = strspn(name, "0123456789abcdef");
    return digits == HEX_DIGITS && strncmp(name + digits, ENDING, sizeof ENDING - 1) == 0;
}

/* --- reading -------------------------------------------------------------------------------------------- */

static bool is_sensible(const header *h)
{
    return h->magic == MAGIC && h->version == VERSION && h->width >= 1 && h->width <= SIDE_MOST && h->height >= 1 &&
           h->height <= SIDE_MOST && h->layers >= 1 && h->layers <= LAYERS_MOST && h->levels >= 1 &&
           h->levels <= MIP_LEVELS_MAX && h->format <= MIP_RG16F && h->clamped <= 1 && h->nearest <= 1 &&
           h->stepped <= 1 && h->similar <= 1 && isfinite(h->fact);
}

/* What the levels take, all together. */
static uint64_t content_size(const header *h)
{
    mip_chain shape = {
        .width = (int)h->width, .height = (int)h->height, .layers = (int)h->layers, .format = (mip_format)h->format};
    uint64_t sum = 0;
    for (uint32_t k = 0; k < h->levels; k++)
        sum += mip_level_bytes(&shape, (int)k);
    return sum;
}

static bool read_levels(mip_chain *out, const header *h, const unsigned char *at)
{
    if (mip_chain_create(out, (int)h->width, (int)h->height, (int)h->layers, (int)h->levels, (mip_format)h->format,
                         NULL) != LMN_OK)
        return false;
    if (out->levels != (int)h->levels) { /* more levels than the sides have */
        mip_chain_release(out);
        return false;
    }
    out->clamped = h->clamped;
    out->nearest = h->nearest;
    out->stepped = h->stepped;
    out->similar = h->similar;
    out->fact = h->fact;
    for (int k = 0; k < out->levels; k++) {
        memcpy(out->data[k], at, mip_level_bytes(out, k));
        at += mip_level_bytes(out, k);
    }
    return true;
}

/* Nothing is allocated before all sizes are known to be those of the file. */
static bool read_chain(mip_chain *out, const unsigned char *data, size_t size, const char *description)
{
    header   h;
    uint64_t sum;
    size_t   told = strlen(description);
    if (size < sizeof h + sizeof sum)
        return false;
    memcpy(&h, data, sizeof h);
    if (!is_sensible(&h) || h.description_size != told || size != sizeof h + told + content_size(&h) + sizeof sum)
        return false;
    memcpy(&sum, data + size - sizeof sum, sizeof sum);
    if (memcmp(data + sizeof h, description, told) != 0 || sum != store_hash(data, size - sizeof sum))
        return false;
    return read_levels(out, &h, data + sizeof h + told);
}

/* The bytes of a regular file of this user, which a link or a pipe with its name is not; the caller frees them.
 * Read, not mapped: another writer may cut it while it is looked at. NULL: there is none. */
static unsigned char *read_own(const char *path, size_t *size)
{
    struct stat    facts;
    unsigned char *bytes = NULL;
    int            descriptor = open(path, O_RDONLY | O_NOFOLLOW | O_NONBLOCK | O_NOCTTY | O_CLOEXEC);
    bool own = descriptor >= 0 && fstat(descriptor, &facts) == 0 && S_ISREG(facts.st_mode) && facts.st_uid == geteuid();
    if (own && facts.st_size > 0 && (uint64_t)facts.st_size <= KEPT_MOST)
        bytes = mem_alloc((size_t)facts.st_size);
    *size = 0;
    for (ssize_t got = 1; bytes && got != 0 && *size<(size_t)facts.st_size; *size += got> 0 ? (size_t)got : 0) {
        got = read(descriptor, bytes + *size, (size_t)facts.st_size - *size);
        if (got < 0 && errno != EINTR)
            break;
    }
    if (descriptor >= 0)
        close(descriptor);
    return bytes;
}

bool store_find(mip_chain *out, const char *description)
{
    char   folder[PATH_CAPACITY], path[PATH_CAPACITY];
    size_t size;
    memset(out, 0, sizeof *out);
    if (!find_folder(folder, sizeof folder) || !find_path(path, sizeof path, folder, description))
        return false;
    unsigned char *bytes = read_own(path, &size);
    bool           found = bytes && read_chain(out, bytes, size, description);
    mem_free(bytes);
    return found;
}

/* --- keeping -------------------------------------------------------------------------------------------- */

typedef struct kept_file {
    char            name[64];
    uint64_t        size;
    struct timespec changed;
} kept_file;

static int by_age(const void *a, const void *b)
{
    const kept_file *left = a, *right = b;
    if (left->changed.tv_sec != right->changed.tv_sec)
        return left->changed.tv_sec < right->changed.tv_sec ? -1 : 1;
    if (left->changed.tv_nsec != right->changed.tv_nsec)
        return left->changed.tv_nsec < right->changed.tv_nsec ? -1 : 1;
    return strcmp(left->name, right->name);
}

static kept_file *list_files(const char *folder, size_t *count)
{
    kept_file *files = NULL;
    size_t     capacity = 0;
    DIR       *open = opendir(folder);
    *count = 0;
    for (struct dirent *entry; open && (entry = readdir(open)) != NULL;) {
        char        path[PATH_CAPACITY];
        struct stat facts;
        kept_file   file;
        size_t      length = strlen(entry->d_name);
        if (!is_ours(entry->d_name) || length >= sizeof file.name ||
            (size_t)snprintf(path, sizeof path, "%s/%s", folder, entry->d_name) >= sizeof path ||
            lstat(path, &facts) != 0 || !S_ISREG(facts.st_mode))
            continue;
        if (!mem_grow((void **)&files, &capacity, *count + 1, sizeof *files))
            break;
        memcpy(file.name, entry->d_name, length + 1);
        file.size = (uint64_t)facts.st_size;
        file.changed = facts.st_mtim;
        files[(*count)++] = file;
    }
    if (open)
        closedir(open);
    return files;
}

/* The oldest files go until the rest has room. */
static void make_room(const char *folder)
{
    size_t     count;
    kept_file *files = list_files(folder, &count);
    uint64_t   sum = 0;
    for (size_t i = 0; i < count; i++)
        sum += files[i].size;
    if (sum > KEPT_MOST)
        qsort(files, count, sizeof *files, by_age);
    for (size_t i = 0; i < count && sum > KEPT_MOST; i++) {
        char path[PATH_CAPACITY];
        if ((size_t)snprintf(path, sizeof path, "%s/%s", folder, files[i].name) < sizeof path && unlink(path) == 0)
            sum -= files[i].size;
    }
    mem_free(files);
}

static void write_chain(text *out, const mip_chain *chain, const char *description)
{
    header h = {MAGIC,
                VERSION,
                strlen(description),
                (uint32_t)chain->width,
                (uint32_t)chain->height,
                (uint32_t)chain->layers,
                (uint32_t)chain->levels,
                (uint32_t)chain->format,
                chain->clamped,
                chain->nearest,
                chain->stepped,
                chain->similar,
                chain->fact};
    text_append_bytes(out, (const char *)&h, sizeof h);
    text_append_bytes(out, description, strlen(description));
    for (int k = 0; k < chain->levels; k++)
        text_append_bytes(out, chain->data[k], mip_level_bytes(chain, k));
    uint64_t sum = store_hash(out->data, out->size);
    text_append_bytes(out, (const char *)&sum, sizeof sum);
}

void store_keep(const mip_chain *chain, const char *description)
{
    char folder[PATH_CAPACITY], path[PATH_CAPACITY];
    text bytes = {0};
    if (!find_folder(folder, sizeof folder) || !find_path(path, sizeof path, folder, description) ||
        file_make_folder(folder, NULL) != LMN_OK)
        return;
    write_chain(&bytes, chain, description);
    if (!bytes.failed && bytes.size <= KEPT_MOST && file_replace(path, bytes.data, bytes.size, NULL) == LMN_OK)
        make_room(folder);
    text_release(&bytes);
}
