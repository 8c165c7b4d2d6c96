#include "picking.h"

typedef struct pick_job {
    artist_job  job;
    GObject    *owner;
    pick_answer answer;
    scene_ref  *scene;
    view_state *state;
    pick_wish   wish;
    lmn_pick    pick;
} pick_job;

static lmn_status pick(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    pick_job     *j = (pick_job *)base;
    lmn_draw_desc desc;
    char         *selector = state_selector(j->state, j->scene);
    state_describe(j->state, j->scene, selector, j->wish.width, j->wish.height, &desc);
    desc.samples = 1;
    desc.lenient = true;
    desc.progress = artist_goes_on;
    desc.progress_user = base;
    const lmn_look *look;
    lmn_look       *own;
    lmn_status      status = scene_ref_prepare(j->scene, j->state, &desc, &look, &own, error);
    if (status == LMN_OK)
        status = lmn_draw_pick(renderer, j->scene->scene, look, &desc, j->wish.x, j->wish.y, &j->pick, error);
    lmn_look_destroy(&own);
    if (status == LMN_OK && j->pick.part > j->scene->info.parts)
        j->pick.part = 0; /* a sign */
    g_free(selector);
    return status;
}

static void picked(artist_job *base, lmn_status status, const lmn_error *error)
{
    pick_job *j = (pick_job *)base;
    (void)error;
    if (status == LMN_OK)
        j->answer(j->owner, &j->wish, &j->pick);
}

static void release(artist_job *base)
{
    pick_job *j = (pick_job *)base;
    look_ref_drop(j->wish.dropped);
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_object_unref(j->owner);
    g_free(j);
}

void pick_ask(artist *a, const document *d, const pick_wish *wish, int slot, GObject *owner, pick_answer answer)
{
    pick_job *j = g_new0(pick_job, 1);
    j->job = (artist_job){ARTIST_ASK, slot, pick, picked, release};
    j->owner = g_object_ref(owner);
    j->answer = answer;
    j->scene = scene_ref_take((scene_ref *)document_scene(d));
    j->state = state_copy(document_state(d));
    j->wish = *wish;
    artist_ask(a, &j->job);
}
