/* Tasks: under which conditions a thread's calls run. Limits, cancelling, and where files may come from. */
#ifndef LIMNER_TASK_H
#define LIMNER_TASK_H

#include "limner/limits.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct lmn_task lmn_task;

/* Which files a model may name: buffers, textures, materials, import() of OpenSCAD. The model itself is always
 * read. SECURITY.md tells more. */
typedef enum lmn_file_access {
    LMN_FILES_NEAR = 0, /* in the model's folder, the one above it, and below these */
    LMN_FILES_FOLDER,   /* in the model's folder and below it alone */
    LMN_FILES_ANY       /* anywhere */
} lmn_file_access;

/* Reads a file for Limner instead of the file system. `path` is what the model's own path and its content make of
 * it; `what` says what for ("model", "buffer", "texture" …). True with *bytes from lmn_file_alloc, which Limner
 * frees, and *size; false when there is none. */
typedef bool (*lmn_read_fn)(const char *path, const char *what, void **bytes, size_t *size, void *user);

/* What a message is about. */
typedef enum lmn_log_kind {
    LMN_LOG_WARNING = 0, /* something was ignored, repaired or reduced; also among the warnings of what is made */
    LMN_LOG_DRIVER       /* OpenGL's driver about a shader, or, with lmn_renderer_desc.debug, about a call */
} lmn_log_kind;

/* Told of what does not fail, as it happens, on the thread that called; of the same thing perhaps more than once.
 * `code` is short and stays ("bad-texture"; of drivers "driver"), `text` for people; both are borrowed for the call.
 * Makes no calls of the library but those of text and status. */
typedef void (*lmn_log_fn)(lmn_log_kind kind, const char *code, const char *text, void *user);

/* Conditions of a task. Initialise with lmn_task_desc_standard. Texts are copied. */
typedef struct lmn_task_desc {
    size_t     struct_size;
    lmn_limits limits; /* `time_s` for each call, the rest for each call and for the task */
    lmn_progress_fn
        progress; /* asked some times a second in all calls, whether they report progress or not; NULL: never cancels */
    void              *progress_user;
    lmn_file_access    files;
    const char *const *allow_paths; /* further folders that models may name files in */
    size_t             allow_path_count;
    lmn_read_fn        read_file; /* NULL: the file system; otherwise `files` and `allow_paths` do not matter */
    void              *read_user;
    lmn_log_fn         log; /* NULL: that of the task around this one, if any */
    void              *log_user;
    bool in_process; /* run other people's decoders in this process; the standard is a fenced child process */
} lmn_task_desc;

/* Standard conditions. Any thread. */
LMN_API lmn_task_desc lmn_task_desc_standard(void);

/* Begins a task: until lmn_task_end, what this thread calls runs under these conditions. Tasks nest: an
 * outer task's cancelling stops the inner one. Without any task, each call runs under standard conditions.
 * Errors: LMN_USAGE (desc), LMN_MEMORY. */
LMN_API lmn_status lmn_task_begin(lmn_task **out, const lmn_task_desc *desc, lmn_error *error);

/* Ends the task that this thread began last, and its child process; sets the handle to NULL. */
LMN_API void lmn_task_end(lmn_task **task);

/* How the child process for decoders is fenced in this build: "seccomp and limits", or "limits". Any thread. */
LMN_API const char *lmn_fence_kind(void);

/* Memory for lmn_read_fn; NULL when there is none. */
LMN_API void *lmn_file_alloc(size_t size);

#ifdef __cplusplus
}
#endif
#endif
