#include "aside.h"

#include <sys/resource.h>
#include <sys/syscall.h>
#include <unistd.h>

enum { TELL_MS = 100, NICENESS = 5 };

struct aside {
    artist_job  job; /* with solids or signs */
    aside_desc  desc;
    scene_ref  *scene;
    view_state *state;
    GThread    *thread;
    guint       timer;
    gint        cancelled, permille; /* between threads */
    lmn_status  status;
    lmn_error   error;
};

static bool goes_on(double fraction, const char *stage, void *user)
{
    aside *a = user;
    g_atomic_int_set(&a->permille, (gint)(fraction * 1000));
    return !g_atomic_int_get(&a->cancelled) && (!a->job.of || artist_goes_on(fraction, stage, &a->job));
}

static lmn_status work(aside *a, lmn_renderer *renderer, lmn_error *error)
{
    return a->desc.work(a->scene, a->state, renderer, goes_on, a, a->desc.user, error);
}

/* On the main thread, at the end of all ways. */
static void end(aside *a)
{
    g_clear_handle_id(&a->timer, g_source_remove);
    a->desc.done(a->status, &a->error, a->desc.user);
    scene_ref_drop(a->scene);
    state_free(a->state);
    g_free(a);
}

static gboolean tell(gpointer data)
{
    aside *a = data;
    a->desc.tell(g_atomic_int_get(&a->permille) / 1000.0, a->desc.user);
    return G_SOURCE_CONTINUE;
}

/* --- in a thread ----------------------------------------------------------------------------------------- */

static gboolean joined(gpointer data)
{
    aside *a = data;
    g_thread_join(a->thread);
    end(a);
    return G_SOURCE_REMOVE;
}

/* The picture in the window comes first: without a GPU both share the processor. */
static gpointer run(gpointer data)
{
    aside *a = data;
    (void)setpriority(PRIO_PROCESS, (id_t)syscall(SYS_gettid), NICENESS);
    a->status = work(a, NULL, &a->error);
    g_idle_add_full(G_PRIORITY_DEFAULT, joined, a, NULL);
    return NULL;
}

/* --- by the artist --------------------------------------------------------------------------------------- */

static lmn_status draw(artist_job *job, lmn_renderer *renderer, lmn_error *error)
{
    aside     *a = (aside *)job;
    lmn_status status = scene_ref_edit(a->scene, a->state->edits, error);
    if (status == LMN_OK)
        status = work(a, renderer, error);
    /* The artist begins anew what gave way; this does not, and was cancelled for good. */
    a->status = status;
    a->error = *error;
    return status == LMN_CANCELLED ? LMN_OK : status;
}

static void drawn(artist_job *job, lmn_status status, const lmn_error *error)
{
    aside *a = (aside *)job;
    if (status != LMN_OK) { /* also without a renderer */
        a->status = status;
        a->error = *error;
    }
}

static void release(artist_job *job)
{
    end((aside *)job);
}

/* --- both ------------------------------------------------------------------------------------------------ */

aside *aside_begin(const aside_desc *desc)
{
    aside *a = g_new0(aside, 1);
    a->desc = *desc;
    a->scene = scene_ref_take((scene_ref *)desc->scene);
    a->state = state_copy(desc->state);
    a->status = LMN_CANCELLED;
    if (desc->tell)
        a->timer = g_timeout_add(TELL_MS, tell, a);
    if (lmn_scene_solid_count(a->scene->scene) == 0 && !a->state->told)
        a->thread = g_thread_try_new("aside", run, a, NULL);
    if (a->thread)
        return a;
    /* Nothing is more urgent: what was begun anew again and again would never end. */
    a->job = (artist_job){ARTIST_EDIT, 0, draw, drawn, release};
    artist_ask(desc->artist, &a->job);
    return a;
}

void aside_cancel(aside *a)
{
    g_atomic_int_set(&a->cancelled, 1);
}
