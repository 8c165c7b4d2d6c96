#define _GNU_SOURCE
#include "base/file_temporary.h"

#include <ctype.h>
#include <dirent.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

enum { HOST_DIGITS = 8, RANDOM_DIGITS = 8, TRIES = 100, STEM_MOST = 200 };

static const char mark[] = "limner-";

/* Process numbers mean something on one host alone, and there in one container alone. */
static uint32_t host_number(void)
{
    char        text[256] = "";
    struct stat space = {0};
    size_t      length = gethostname(text, sizeof text / 2) == 0 ? strnlen(text, sizeof text / 2) : 0;
    if (stat("/proc/self/ns/pid", &space) == 0)
        snprintf(text + length, sizeof text - length, " %llu", (unsigned long long)space.st_ino);
    uint32_t hash = UINT32_C(0x811c9dc5);
    for (const char *at = text; *at; at++)
        hash = (hash ^ (unsigned char)*at) * UINT32_C(0x01000193);
    return hash;
}

void temporary_name(char out[TEMPORARY_NAME_CAPACITY], const char *stem)
{
    uint32_t number = 0;
    if (getrandom(&number, sizeof number, GRND_NONBLOCK) != (ssize_t)sizeof number)
        number = (uint32_t)(uintptr_t)out; /* names that are taken are tried again with another one */
    snprintf(out, TEMPORARY_NAME_CAPACITY, "%.*s%s%08x-%ld-%08x", STEM_MOST, stem, mark, host_number(), (long)getpid(),
             number);
}

static bool is_process_gone(long id)
{
    return id > 0 && kill((pid_t)id, 0) != 0 && errno == ESRCH;
}

/* What stands behind the mark, of a process that is gone? Anything else in a name makes it somebody else's. */
static bool is_abandoned(const char *tail)
{
    char host[HOST_DIGITS + 1], *end;
    snprintf(host, sizeof host, "%08x", host_number());
    if (strncmp(tail, host, HOST_DIGITS) != 0 || tail[HOST_DIGITS] != '-' ||
        !isdigit((unsigned char)tail[HOST_DIGITS + 1]))
        return false;
    long id = strtol(tail + HOST_DIGITS + 1, &end, 10);
    return *end == '-' && strspn(end + 1, "0123456789abcdef") == RANDOM_DIGITS && end[1 + RANDOM_DIGITS] == '\0' &&
           is_process_gone(id);
}

/* The end of the mark in a hidden file's name. */
static const char *behind_mark(const char *name)
{
    const char *found = NULL;
    if (name[0] != '.')
        return NULL;
    for (const char *at = name; (at = strstr(at, mark)) != NULL; at++)
        if (at > name && at[-1] == '.')
            found = at + sizeof mark - 1;
    return found;
}

static DIR *open_again(int folder)
{
    int  descriptor = openat(folder, ".", O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    DIR *list = descriptor >= 0 ? fdopendir(descriptor) : NULL;
    if (!list && descriptor >= 0)
        close(descriptor);
    return list;
}

void temporary_sweep(int folder)
{
    DIR *list = open_again(folder);
    for (struct dirent *entry; list && (entry = readdir(list)) != NULL;) {
        struct stat facts;
        const char *tail = behind_mark(entry->d_name);
        if (tail && is_abandoned(tail) && fstatat(folder, entry->d_name, &facts, AT_SYMLINK_NOFOLLOW) == 0 &&
            S_ISREG(facts.st_mode) && facts.st_uid == geteuid())
            unlinkat(folder, entry->d_name, 0);
    }
    if (list)
        closedir(list);
}

/* --- folders -------------------------------------------------------------------------------------------- */

static void remove_folder_in(int parent, const char *name)
{
    struct stat facts;
    int         folder = openat(parent, name, O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC);
    DIR *list = folder >= 0 && fstat(folder, &facts) == 0 && facts.st_uid == geteuid() ? open_again(folder) : NULL;
    for (struct dirent *entry; list && (entry = readdir(list)) != NULL;)
        unlinkat(folder, entry->d_name, 0); /* folders stay */
    if (list) {
        closedir(list);
        unlinkat(parent, name, AT_REMOVEDIR);
    }
    if (folder >= 0)
        close(folder);
}

static void sweep_folders(int parent)
{
    DIR *list = open_again(parent);
    for (struct dirent *entry; list && (entry = readdir(list)) != NULL;)
        if (strncmp(entry->d_name, mark, sizeof mark - 1) == 0 && is_abandoned(entry->d_name + sizeof mark - 1))
            remove_folder_in(parent, entry->d_name);
    if (list)
        closedir(list);
}

bool temporary_folder_make(char *out, size_t capacity)
{
    const char *given = getenv("TMPDIR"), *where = given && *given == '/' ? given : "/tmp";
    char        name[TEMPORARY_NAME_CAPACITY];
    int         parent = open(where, O_RDONLY | O_DIRECTORY | O_CLOEXEC), problem = errno;
    bool        made = false;
    out[0] = '\0';
    if (parent >= 0)
        sweep_folders(parent);
    for (int i = 0; i < TRIES && parent >= 0 && !made; i++) {
        temporary_name(name, "");
        made = mkdirat(parent, name, 0700) == 0;
        problem = errno;
        if (!made && problem != EEXIST)
            break;
    }
    if (made && (size_t)snprintf(out, capacity, "%s/%s", where, name) >= capacity) {
        unlinkat(parent, name, AT_REMOVEDIR);
        made = false;
        problem = ENAMETOOLONG;
        out[0] = '\0';
    }
    if (parent >= 0)
        close(parent);
    errno = problem;
    return made;
}

void temporary_folder_remove(const char *path)
{
    remove_folder_in(AT_FDCWD, path);
}
