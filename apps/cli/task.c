#include "task.h"

int task_begin(lmn_task **out, const task_values *v, progress *p)
{
    lmn_error     error = {0};
    lmn_task_desc desc = lmn_task_desc_standard();
    *out = NULL;
    if (v->safe && v->allow_any)
        return message_usage("--allow-path DIR adds one folder", "--safe and --allow-any exclude each other");
    if (v->safe && v->in_process)
        return message_usage("leave one of them out", "--safe and --in-process exclude each other");
    if (v->safe)
        desc.limits = lmn_limits_safe();
    for (size_t i = 0; i < v->limits.count; i++)
        if (lmn_limits_set(&desc.limits, v->limits.items[i], &error) != LMN_OK)
            return message_error(&error);
    desc.progress = progress_poll;
    desc.progress_user = p;
    desc.files = v->allow_any ? LMN_FILES_ANY : v->safe ? LMN_FILES_FOLDER : LMN_FILES_NEAR;
    desc.allow_paths = v->allow_paths.items;
    desc.allow_path_count = v->allow_paths.count;
    desc.in_process = v->in_process;
    return lmn_task_begin(out, &desc, &error) == LMN_OK ? EXIT_DONE : message_error(&error);
}
