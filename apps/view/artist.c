#include "artist.h"

#ifdef __GLIBC__
#include <malloc.h>
#endif

struct artist {
    GThread    *thread;
    GMutex      lock; /* of everything below */
    GCond       news;
    GQueue      waiting;
    artist_job *drawn; /* now; NULL: none */
    bool        ending;
};

static gboolean deliver(gpointer data)
{
    artist_job *job = data;
    if (!g_atomic_int_get(&job->dropped))
        job->done(job, job->status, &job->error);
    job->release(job);
    return G_SOURCE_REMOVE;
}

/* With the lock. The most urgent of those that wait, the oldest of these. */
static GList *most_urgent(artist *a)
{
    GList *best = NULL;
    for (GList *i = a->waiting.head; i; i = i->next)
        if (!best || ((artist_job *)i->data)->urgency < ((artist_job *)best->data)->urgency)
            best = i;
    return best;
}

bool artist_goes_on(double fraction, const char *stage, void *user)
{
    (void)fraction;
    (void)stage;
    artist_job *job = user;
    artist     *a = job->of;
    if (g_atomic_int_get(&job->dropped))
        return false;
    g_mutex_lock(&a->lock);
    GList *next = most_urgent(a);
    bool   stays = !a->ending && !(next && ((artist_job *)next->data)->urgency < job->urgency);
    g_mutex_unlock(&a->lock);
    return stays;
}

/* With the lock: takes the next job, or NULL when the artist ends. */
static artist_job *take(artist *a)
{
    while (!a->ending && g_queue_is_empty(&a->waiting))
        g_cond_wait(&a->news, &a->lock);
    if (a->ending)
        return NULL;
    GList      *link = most_urgent(a);
    artist_job *job = link->data;
    g_queue_delete_link(&a->waiting, link);
    return job;
}

/* With the lock: has a job of this slot come meanwhile? */
static bool is_replaced(artist *a, const artist_job *job)
{
    for (GList *i = a->waiting.head; i && job->slot; i = i->next)
        if (((artist_job *)i->data)->slot == job->slot)
            return true;
    return false;
}

/* With the lock: what gave way to something more urgent is drawn later; the rest is told to the interface. */
static void put_away(artist *a, artist_job *job)
{
    bool gave_way = job->status == LMN_CANCELLED && !g_atomic_int_get(&job->dropped) && !a->ending;
    if (gave_way && !is_replaced(a, job)) {
        g_queue_push_head(&a->waiting, job);
        return;
    }
    if (job->status == LMN_CANCELLED)
        g_atomic_int_set(&job->dropped, 1);
    g_idle_add_full(G_PRIORITY_DEFAULT, deliver, job, NULL);
}

/* What one thread took and another freed stays with the process otherwise: pictures go from here to the interface's. */
static void give_back_memory(void)
{
#ifdef __GLIBC__
    malloc_trim(0);
#endif
}

static void draw(artist_job *job, lmn_renderer **renderer)
{
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    job->error = (lmn_error){0};
    job->status = *renderer ? LMN_OK : lmn_renderer_create(renderer, &desc, &job->error);
    if (job->status == LMN_OK)
        job->status = job->draw(job, *renderer, &job->error);
}

/* A context that was lost can only be made anew; then the job is tried once more. What fails with a new one, too, is
 * the job's own failure. */
static void draw_or_start_anew(artist_job *job, lmn_renderer **renderer)
{
    bool was_there = *renderer != NULL;
    draw(job, renderer);
    if (job->status != LMN_GL)
        return;
    lmn_renderer_destroy(renderer);
    if (was_there)
        draw(job, renderer);
    if (job->status == LMN_GL)
        lmn_renderer_destroy(renderer);
}

static gpointer draw_jobs(gpointer data)
{
    artist       *a = data;
    lmn_renderer *renderer = NULL;
    g_mutex_lock(&a->lock);
    for (artist_job *job = take(a); job; job = take(a)) {
        a->drawn = job;
        g_mutex_unlock(&a->lock);
        draw_or_start_anew(job, &renderer);
        if (job->urgency >= ARTIST_REST)
            give_back_memory();
        g_mutex_lock(&a->lock);
        a->drawn = NULL;
        put_away(a, job);
    }
    g_mutex_unlock(&a->lock);
    lmn_renderer_destroy(&renderer);
    return NULL;
}

artist *artist_start(void)
{
    artist *a = g_new0(artist, 1);
    g_mutex_init(&a->lock);
    g_cond_init(&a->news);
    g_queue_init(&a->waiting);
    a->thread = g_thread_try_new("artist", draw_jobs, a, NULL);
    if (a->thread)
        return a;
    g_mutex_clear(&a->lock);
    g_cond_clear(&a->news);
    g_free(a);
    return NULL;
}

void artist_end(artist *a)
{
    if (!a)
        return;
    g_mutex_lock(&a->lock);
    a->ending = true;
    g_cond_signal(&a->news);
    g_mutex_unlock(&a->lock);
    g_thread_join(a->thread);
    for (artist_job *job = g_queue_pop_head(&a->waiting); job; job = g_queue_pop_head(&a->waiting))
        job->release(job);
    g_mutex_clear(&a->lock);
    g_cond_clear(&a->news);
    g_free(a);
}

/* With the lock: takes the jobs of a slot out of the queue; the caller releases them. */
static GQueue waiting_of(artist *a, int slot)
{
    GQueue out = G_QUEUE_INIT;
    for (GList *i = a->waiting.head, *next; i; i = next) {
        next = i->next;
        if (((artist_job *)i->data)->slot != slot)
            continue;
        g_queue_push_tail(&out, i->data);
        g_queue_delete_link(&a->waiting, i);
    }
    return out;
}

static void release_all(GQueue *jobs)
{
    for (artist_job *job = g_queue_pop_head(jobs); job; job = g_queue_pop_head(jobs))
        job->release(job);
}

void artist_ask(artist *a, artist_job *job)
{
    GQueue replaced = G_QUEUE_INIT;
    job->of = a;
    job->dropped = 0;
    g_mutex_lock(&a->lock);
    if (job->slot)
        replaced = waiting_of(a, job->slot);
    g_queue_push_tail(&a->waiting, job);
    g_cond_signal(&a->news);
    g_mutex_unlock(&a->lock);
    release_all(&replaced);
}

void artist_drop(artist *a, int slot)
{
    g_mutex_lock(&a->lock);
    GQueue dropped = waiting_of(a, slot);
    if (a->drawn && a->drawn->slot == slot)
        g_atomic_int_set(&a->drawn->dropped, 1);
    g_mutex_unlock(&a->lock);
    release_all(&dropped);
}
