#include "timeline.h"

#include <math.h>

#include "words.h"

enum { FRAME_MS = 33, CLIP_LIMIT = 200 };
static const double FRAME_S = 1.0 / 24;

typedef struct timeline {
    document        *document;
    const scene_ref *shown; /* whose clips are listed; compared only */
    GtkWidget       *bar, *play, *scale, *time, *clips, *rest;
    GArray          *ends; /* of double: where each clip ends, seconds */
    bool             follows;
    guint            timer;
    gint64           last;
} timeline;

/* Where the chosen clip ends. */
static double end_of(const timeline *t)
{
    guint at = gtk_drop_down_get_selected(GTK_DROP_DOWN(t->clips));
    return at < t->ends->len ? g_array_index(t->ends, double, at) : 1;
}

/* Clips are named by number: several may share a name. */
static char *clip_of(const timeline *t)
{
    return g_strdup_printf("%u", gtk_drop_down_get_selected(GTK_DROP_DOWN(t->clips)) + 1);
}

static void go_to(timeline *t, double time)
{
    char *clip = clip_of(t);
    document_set_time(t->document, true, fmin(fmax(time, 0), end_of(t)), clip);
    g_free(clip);
}

static void stop(timeline *t)
{
    g_clear_handle_id(&t->timer, g_source_remove);
    gtk_button_set_icon_name(GTK_BUTTON(t->play), "media-playback-start-symbolic");
}

static gboolean advance(gpointer user)
{
    timeline *t = user;
    gint64    now = g_get_monotonic_time();
    double    by = (double)(now - t->last) / 1e6, end = end_of(t);
    t->last = now;
    double time = document_state(t->document)->time_s + by;
    go_to(t, end > 0 ? fmod(time, end) : 0);
    return G_SOURCE_CONTINUE;
}

static void play_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    timeline *t = user;
    if (t->timer) {
        stop(t);
        return;
    }
    document_end_step(t->document);
    t->last = g_get_monotonic_time();
    t->timer = g_timeout_add(FRAME_MS, advance, t);
    gtk_button_set_icon_name(GTK_BUTTON(t->play), "media-playback-pause-symbolic");
}

void timeline_play(GtkWidget *bar)
{
    timeline *t = g_object_get_data(G_OBJECT(bar), "timeline");
    if (t->ends->len)
        play_clicked(NULL, t);
}

static void step_clicked(GtkButton *button, gpointer user)
{
    timeline *t = user;
    double    by = GPOINTER_TO_INT(g_object_get_data(G_OBJECT(button), "step")) * FRAME_S;
    stop(t);
    go_to(t, (round(document_state(t->document)->time_s / FRAME_S) * FRAME_S) + by);
}

static void rest_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    timeline *t = user;
    stop(t);
    document_set_time(t->document, false, 0, NULL);
}

static void scrubbed(GtkRange *range, gpointer user)
{
    timeline *t = user;
    if (t->follows)
        return;
    stop(t);
    go_to(t, gtk_range_get_value(range));
}

static void clip_chosen(GObject *clips, GParamSpec *pspec, gpointer user)
{
    (void)clips;
    (void)pspec;
    timeline *t = user;
    if (t->follows)
        return;
    gtk_range_set_range(GTK_RANGE(t->scale), 0, fmax(end_of(t), 0.001));
    go_to(t, 0);
}

static void follow(timeline *t)
{
    const view_state *s = document_state(t->document);
    char             *text = s->timed ? g_strdup_printf("%.2f s", s->time_s) : g_strdup(_("at rest"));
    t->follows = true;
    guint64 clip = s->timed && s->clip ? g_ascii_strtoull(s->clip, NULL, 10) : 0;
    if (clip > 0)
        gtk_drop_down_set_selected(GTK_DROP_DOWN(t->clips), (guint)clip - 1);
    gtk_range_set_range(GTK_RANGE(t->scale), 0, fmax(end_of(t), 0.001));
    gtk_range_set_value(GTK_RANGE(t->scale), s->timed ? s->time_s : 0);
    gtk_label_set_text(GTK_LABEL(t->time), text);
    t->follows = false;
    g_free(text);
}

static void list_clips(timeline *t)
{
    const scene_ref *scene = document_scene(t->document);
    GtkStringList   *names = gtk_string_list_new(NULL);
    t->shown = scene;
    stop(t);
    g_array_set_size(t->ends, 0);
    for (guint i = 0; scene && i < scene->clips->len && i < CLIP_LIMIT; i++) {
        const clip_info *clip = &g_array_index(scene->clips, clip_info, i);
        char            *text = *clip->name ? g_strdup(clip->name) : g_strdup_printf(_("Clip %u"), i + 1);
        gtk_string_list_append(names, text);
        g_array_append_val(t->ends, clip->end_s);
        g_free(text);
    }
    t->follows = true;
    gtk_drop_down_set_model(GTK_DROP_DOWN(t->clips), G_LIST_MODEL(names));
    t->follows = false;
    g_object_unref(names);
    gtk_widget_set_visible(t->bar, t->ends->len > 0);
}

static void document_changed(document *d, unsigned changes, void *user)
{
    timeline *t = user;
    if (changes & DOCUMENT_SCENE && document_scene(d) != t->shown)
        list_clips(t);
    if (changes & (DOCUMENT_TIME | DOCUMENT_SCENE))
        follow(t);
}

static GtkWidget *button(timeline *t, const char *icon, const char *name, GCallback clicked, int step)
{
    GtkWidget *out = gtk_button_new_from_icon_name(icon);
    gtk_widget_set_tooltip_text(out, name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(out), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
    gtk_widget_add_css_class(out, "flat");
    g_object_set_data(G_OBJECT(out), "step", GINT_TO_POINTER(step));
    g_signal_connect(out, "clicked", clicked, t);
    gtk_box_append(GTK_BOX(t->bar), out);
    return out;
}

static void timeline_free(void *data)
{
    timeline *t = data;
    g_clear_handle_id(&t->timer, g_source_remove);
    g_array_unref(t->ends);
    g_free(t);
}

GtkWidget *timeline_new(document *d)
{
    timeline *t = g_new0(timeline, 1);
    t->document = d;
    t->ends = g_array_new(FALSE, FALSE, sizeof(double));
    t->bar = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 2);
    button(t, "media-skip-backward-symbolic", _("One frame back"), G_CALLBACK(step_clicked), -1);
    t->play = button(t, "media-playback-start-symbolic", _("Play"), G_CALLBACK(play_clicked), 0);
    button(t, "media-skip-forward-symbolic", _("One frame on"), G_CALLBACK(step_clicked), 1);
    t->scale = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, 0, 1, FRAME_S);
    gtk_widget_set_hexpand(t->scale, TRUE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(t->scale), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Time"), -1);
    g_signal_connect(t->scale, "value-changed", G_CALLBACK(scrubbed), t);
    gtk_box_append(GTK_BOX(t->bar), t->scale);
    t->time = gtk_label_new("");
    gtk_label_set_width_chars(GTK_LABEL(t->time), 9);
    gtk_box_append(GTK_BOX(t->bar), t->time);
    t->clips = gtk_drop_down_new(NULL, NULL);
    gtk_accessible_update_property(GTK_ACCESSIBLE(t->clips), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Clip"), -1);
    g_signal_connect(t->clips, "notify::selected", G_CALLBACK(clip_chosen), t);
    gtk_box_append(GTK_BOX(t->bar), t->clips);
    t->rest = button(t, "media-playback-stop-symbolic", _("At rest"), G_CALLBACK(rest_clicked), 0);
    gtk_widget_set_visible(t->bar, FALSE);
    g_object_set_data_full(G_OBJECT(t->bar), "timeline", t, timeline_free);
    document_listen(d, document_changed, t);
    return t->bar;
}
