#include "tour.h"

enum { FRAME_MS = 33, LOOK_MS = 6000, RESUME_MS = 10000 };
static const double TURN_S = 0.35; /* radians a second */

struct tour {
    document *document;
    guint     timer, resume;
    bool      runs;
    gint64    last, look_at;
    size_t    look;
};

/* Its steps are not a person's: they would fill the history. One step stands for all. */
static const char *const what = "Presentation";

static void next_look(tour *t)
{
    lmn_error error = {0};
    look_ref *look = look_ref_load(lmn_look_name_at(t->look++ % lmn_look_count()), &error);
    if (look)
        document_set_look(t->document, look, what);
}

static gboolean advance(gpointer user)
{
    tour  *t = user;
    gint64 now = g_get_monotonic_time();
    orbit  o = document_state(t->document)->view;
    o.yaw += TURN_S * (double)(now - t->last) / 1e6;
    t->last = now;
    document_set_view(t->document, &o, what);
    if (now - t->look_at > LOOK_MS * G_GINT64_CONSTANT(1000)) {
        t->look_at = now;
        next_look(t);
    }
    return G_SOURCE_CONTINUE;
}

static void begin(tour *t)
{
    g_clear_handle_id(&t->resume, g_source_remove);
    if (t->timer)
        return;
    t->last = t->look_at = g_get_monotonic_time();
    document_end_step(t->document);
    t->timer = g_timeout_add(FRAME_MS, advance, t);
}

static gboolean go_on(gpointer user)
{
    tour *t = user;
    t->resume = 0;
    begin(t);
    return G_SOURCE_REMOVE;
}

void tour_interrupt(tour *t)
{
    if (!t->runs)
        return;
    g_clear_handle_id(&t->timer, g_source_remove);
    g_clear_handle_id(&t->resume, g_source_remove);
    t->resume = g_timeout_add(RESUME_MS, go_on, t);
}

void tour_run(tour *t, bool runs)
{
    t->runs = runs;
    g_clear_handle_id(&t->timer, g_source_remove);
    g_clear_handle_id(&t->resume, g_source_remove);
    if (runs)
        begin(t);
}

tour *tour_make(document *d)
{
    tour *t = g_new0(tour, 1);
    t->document = d;
    return t;
}

void tour_free(tour *t)
{
    if (!t)
        return;
    tour_run(t, false);
    g_free(t);
}
