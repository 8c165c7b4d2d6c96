#include "load.h"

#include <string.h>

typedef struct load_job {
    GStrv         paths;
    load_progress progress;
    void         *user;
    gint          permille; /* told by the reading thread, read by the interface's */
    guint         timer;
    lmn_error     error;
} load_job;

static void job_free(void *data)
{
    load_job *j = data;
    g_strfreev(j->paths);
    g_free(j);
}

static bool goes_on(double fraction, const char *stage, void *user)
{
    (void)stage;
    GTask    *task = user;
    load_job *j = g_task_get_task_data(task);
    g_atomic_int_set(&j->permille, (gint)(fraction * 1000));
    GCancellable *cancel = g_task_get_cancellable(task);
    return !cancel || !g_cancellable_is_cancelled(cancel);
}

static void read_files(GTask *task, gpointer source, gpointer data, GCancellable *cancel)
{
    (void)source;
    (void)cancel;
    load_job     *j = data;
    lmn_scene    *scene = NULL;
    lmn_load_desc desc = LMN_LOAD_DESC_INIT;
    desc.progress = goes_on;
    desc.progress_user = task;
    lmn_status status = lmn_scene_create(&scene, &j->error);
    for (size_t i = 0; j->paths[i] && status == LMN_OK; i++)
        status = lmn_scene_add_file(scene, j->paths[i], &desc, &j->error);
    if (status == LMN_OK) {
        g_task_return_pointer(task, scene_ref_make(scene, (const char *const *)j->paths),
                              (GDestroyNotify)scene_ref_drop);
        return;
    }
    lmn_scene_destroy(&scene);
    j->error.status = status;
    g_task_return_pointer(task, NULL, NULL);
}

static gboolean tell_progress(gpointer data)
{
    load_job *j = data;
    j->progress(g_atomic_int_get(&j->permille) / 1000.0, j->user);
    return G_SOURCE_CONTINUE;
}

void load_begin(const char *const *paths, GCancellable *cancel, load_progress progress, GAsyncReadyCallback done,
                void *user)
{
    load_job *j = g_new0(load_job, 1);
    j->paths = g_strdupv((char **)paths);
    j->progress = progress;
    j->user = user;
    GTask *task = g_task_new(NULL, cancel, done, user);
    g_task_set_task_data(task, j, job_free);
    /* The result says what happened, also when it was cancelled. */
    g_task_set_check_cancellable(task, FALSE);
    if (progress)
        j->timer = g_timeout_add(100, tell_progress, j);
    g_task_run_in_thread(task, read_files);
    g_object_unref(task);
}

scene_ref *load_finish(GAsyncResult *result, lmn_error *error)
{
    load_job *j = g_task_get_task_data(G_TASK(result));
    g_clear_handle_id(&j->timer, g_source_remove);
    scene_ref *scene = g_task_propagate_pointer(G_TASK(result), NULL);
    *error = j->error;
    return scene;
}
