#include "import/access.h"

#include <limits.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"

/* --- paths ---------------------------------------------------------------------------------------------- */

static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    size_t      length = !slash ? 1 : slash == path ? 1 : (size_t)(slash - path);
    char       *folder = mem_copy(slash ? path : ".", length + 1);
    if (folder)
        folder[length] = '\0';
    return folder;
}

/* The path without links, "." and ".."; what does not exist counts as if it did. NULL without memory. */
static char *resolve(const char *path)
{
    char *real = realpath(path, NULL), *own = NULL;
    if (real) {
        own = mem_copy_text(real);
        free(real);
        return own;
    }
    char       *folder = folder_of(path), *above = NULL;
    const char *slash = strrchr(path, '/'), *last = slash ? slash + 1 : path;
    if (folder && strcmp(folder, path) != 0)
        above = resolve(folder);
    size_t length = above ? strlen(above) : 0;
    if (above && strcmp(last, "..") == 0) {
        own = folder_of(above);
    } else if (above) {
        own = mem_alloc(length + strlen(last) + 2);
        if (own) {
            memcpy(own, above, length);
            own[length] = '/';
            memcpy(own + length + (length > 0 && above[length - 1] != '/'), last, strlen(last) + 1);
        }
    } else if (folder) {
        own = mem_copy_text("/");
    }
    mem_free(folder);
    mem_free(above);
    return own;
}

/* Is the resolved path the folder or below it? */
static bool lies_in(const char *path, const char *folder)
{
    size_t length = strlen(folder);
    return strncmp(path, folder, length) == 0 &&
           (path[length] == '/' || path[length] == '\0' || strcmp(folder, "/") == 0);
}

/* Is something hidden on the way from the folder to the path in it? The folder itself is not. */
static bool has_hidden_part(const char *path, const char *folder)
{
    return strstr(path + strlen(folder), "/.") != NULL;
}

/* --- what is allowed ------------------------------------------------------------------------------------ */

typedef enum verdict { ALLOWED, REFUSED, NO_MEMORY } verdict;

/* In one of the folders that the caller allows? */
static verdict lies_in_allowed(const char *path, const lmn_task_desc *conditions)
{
    verdict found = REFUSED;
    for (size_t i = 0; conditions && found == REFUSED && i < conditions->allow_path_count; i++) {
        char *folder = resolve(conditions->allow_paths[i]);
        found = !folder ? NO_MEMORY : lies_in(path, folder) ? ALLOWED : REFUSED;
        mem_free(folder);
    }
    return found;
}

/* In the model's folder; or in the one above it, where that is not the root of the file system, and what is reached
 * is not hidden: programs keep keys in such positions. */
static verdict lies_near(const char *path, const char *model, lmn_file_access access)
{
    char   *own = folder_of(model), *folder = own ? resolve(own) : NULL, *above = folder ? folder_of(folder) : NULL;
    verdict near = above ? REFUSED : NO_MEMORY;
    if (above && strcmp(folder, "/") != 0 && lies_in(path, folder))
        near = ALLOWED;
    else if (above && access == LMN_FILES_NEAR && strcmp(above, "/") != 0 && lies_in(path, above) &&
             !has_hidden_part(path, above))
        near = ALLOWED;
    mem_free(own);
    mem_free(folder);
    mem_free(above);
    return near;
}

static lmn_status refuse(lmn_error *error, const char *what, const char *path, bool folder_alone)
{
    error_set(error, LMN_READ, "the %s \"%.300s\" lies outside of the folders that a model may name files in", what,
              path);
    error_hint(error, "allowed are the model's folder%s; --allow-path DIR adds a folder, --allow-any allows all",
               folder_alone ? "" : " and the one above it");
    return LMN_READ;
}

static bool reads_itself(void)
{
    const lmn_task_desc *conditions = work_conditions();
    return conditions && conditions->read_file;
}

lmn_status access_check(const import_job *job, const char *what, const char *path, lmn_error *error)
{
    const lmn_task_desc *conditions = work_conditions();
    lmn_file_access      access = conditions ? conditions->files : LMN_FILES_NEAR;
    if (reads_itself() || access == LMN_FILES_ANY)
        return LMN_OK;
    /* No system opens it, and resolving it would take long. */
    if (strlen(path) >= PATH_MAX)
        return error_set(error, LMN_READ, "the path of the %s has %zu bytes, more than a path can have", what,
                         strlen(path));
    char *resolved = resolve(path);
    if (!resolved)
        return error_memory(error);
    const char *model = job->model ? job->model : job->path;
    verdict     found = lies_in_allowed(resolved, conditions);
    if (found == REFUSED)
        found = lies_near(resolved, model, access);
    mem_free(resolved);
    return found == ALLOWED     ? LMN_OK
           : found == NO_MEMORY ? error_memory(error)
                                : refuse(error, what, path, access == LMN_FILES_FOLDER);
}

/* --- reading -------------------------------------------------------------------------------------------- */

static lmn_status read_by_callback(const char *what, const char *path, file_data *out, lmn_error *error)
{
    const lmn_task_desc *conditions = work_conditions();
    void                *bytes = NULL;
    size_t               size = 0;
    if (!conditions->read_file(path, what, &bytes, &size, conditions->read_user) || !bytes)
        return error_in_file(error, LMN_READ, path, 0, "the host program gives no such file");
    /* Readers rely on the NUL byte behind a file. */
    unsigned char *own = mem_realloc(bytes, size + 1);
    if (!own) {
        mem_free(bytes);
        return error_memory(error);
    }
    own[size] = '\0';
    *out = (file_data){.data = own, .size = size};
    return LMN_OK;
}

lmn_status access_read(const import_job *job, const char *what, const char *path, file_data *out, bool *refused,
                       lmn_error *error)
{
    *out = (file_data){0};
    lmn_status status = job ? access_check(job, what, path, error) : LMN_OK;
    if (refused)
        *refused = status == LMN_READ;
    if (status != LMN_OK)
        return status;
    return reads_itself() ? read_by_callback(what, path, out, error) : file_load(out, path, error);
}

bool access_has(const import_job *job, const char *path)
{
    return !reads_itself() && access_check(job, "file", path, NULL) == LMN_OK && access(path, R_OK) == 0;
}
