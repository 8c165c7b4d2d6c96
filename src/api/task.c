/* include/limner/task.h: copies the conditions and begins their work. */
#include "limner/task.h"

#include "base/error.h"
#include "base/memory.h"
#include "base/work.h"
#include "fence/fence.h"

struct lmn_task {
    work          work;
    lmn_task_desc desc; /* its own copies */
    char        **paths;
};

lmn_task_desc lmn_task_desc_standard(void)
{
    return (lmn_task_desc){.struct_size = sizeof(lmn_task_desc), .limits = lmn_limits_standard()};
}

static void release(lmn_task *t)
{
    for (size_t i = 0; t->paths && i < t->desc.allow_path_count; i++)
        mem_free(t->paths[i]);
    mem_free(t->paths);
    mem_free(t);
}

static bool copy_paths(lmn_task *t, const lmn_task_desc *desc)
{
    t->paths = mem_calloc(desc->allow_path_count, sizeof *t->paths);
    for (size_t i = 0; t->paths && i < desc->allow_path_count; i++)
        if (!(t->paths[i] = mem_copy_text(desc->allow_paths[i])))
            return false;
    t->desc.allow_paths = (const char *const *)t->paths;
    return t->paths != NULL;
}

lmn_status lmn_task_begin(lmn_task **out, const lmn_task_desc *desc, lmn_error *error)
{
    if (!out)
        return error_set(error, LMN_USAGE, "lmn_task_begin: `out` is NULL");
    *out = NULL;
    if (!desc || desc->struct_size != sizeof *desc || desc->limits.struct_size != sizeof desc->limits)
        return error_set(error, LMN_USAGE, "the task description was not initialised with lmn_task_desc_standard");
    if (desc->files != LMN_FILES_NEAR && desc->files != LMN_FILES_FOLDER && desc->files != LMN_FILES_ANY)
        return error_set(error, LMN_USAGE, "lmn_task_begin: files %d is none of NEAR, FOLDER, ANY", (int)desc->files);
    for (size_t i = 0; i < desc->allow_path_count; i++)
        if (!desc->allow_paths || !desc->allow_paths[i])
            return error_set(error, LMN_USAGE, "lmn_task_begin: `allow_paths` has a NULL among the first %zu",
                             desc->allow_path_count);
    lmn_task *t = mem_calloc(1, sizeof *t);
    if (!t)
        return error_memory(error);
    t->desc = *desc;
    if (!copy_paths(t, desc)) {
        release(t);
        return error_memory(error);
    }
    work_begin_task(&t->work, &t->desc);
    *out = t;
    return LMN_OK;
}

void lmn_task_end(lmn_task **task)
{
    if (!task || !*task)
        return;
    work_end(&(*task)->work, LMN_OK, NULL);
    release(*task);
    *task = NULL;
}

const char *lmn_fence_kind(void)
{
    return fence_kind();
}

void *lmn_file_alloc(size_t size)
{
    return mem_alloc(size);
}
