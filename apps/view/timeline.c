#include "timeline.h"

#include <math.h>
#include <string.h>

#include "trace.h"
#include "words.h"

enum { FRAME_MS = 33, CLIP_LIMIT = 200 };
static const double FRAME_S = 1.0 / 24;

typedef struct timeline {
    document        *document;
    const scene_ref *shown; /* whose clips are listed; compared only */
    GtkWidget       *bar, *play, *scale, *time, *clips, *rest, *motion, *exposure;
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

/* --- motion ---------------------------------------------------------------------------------------------- */

/* Puts a look that has been changed; what was refused stays as it was. */
static void put_motion(timeline *t, lmn_look *look, lmn_status status, const lmn_error *error, const char *what)
{
    if (look && status == LMN_OK) {
        document_put_look(t->document, look, what);
    } else {
        trace_event("refused %s", error->message);
        lmn_look_destroy(&look);
    }
}

/* Names in the order of the list behind "no motion": ways, then techniques. NULL: there are no more. */
static const char *motion_name(guint index)
{
    lmn_motion_way_info way;
    lmn_technique_info  technique;
    guint               ways = 0;
    while (lmn_motion_way_at(ways, &way))
        if (ways++ == index)
            return way.name;
    return lmn_technique_at("motion", index - ways, &technique) ? technique.name : NULL;
}

/* What only deforms tells no more when another way is chosen. */
static lmn_status exchange_motion(lmn_look *look, const char *name, lmn_error *error)
{
    const char *now = lmn_look_technique_count(look, 0, "motion") ? lmn_look_technique(look, 0, "motion", 0) : "";
    lmn_status  status = LMN_OK;
    if (strcmp(now, "deform") == 0)
        status = lmn_look_set_motion_way(look, "none", error);
    return status == LMN_OK ? lmn_look_set_motion_way(look, name, error) : status;
}

static void motion_chosen(GObject *motion, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    timeline   *t = user;
    lmn_error   error = {0};
    guint       chosen = gtk_drop_down_get_selected(GTK_DROP_DOWN(motion));
    const char *name = chosen > 0 && chosen != GTK_INVALID_LIST_POSITION ? motion_name(chosen - 1) : NULL;
    if (t->follows || chosen == GTK_INVALID_LIST_POSITION)
        return;
    document_end_step(t->document);
    lmn_look *look = document_copy_look(t->document, &error);
    put_motion(t, look, look ? exchange_motion(look, name ? name : "none", &error) : LMN_MEMORY, &error, _("Motion"));
}

static void exposure_changed(GtkSpinButton *exposure, gpointer user)
{
    timeline *t = user;
    char      text[G_ASCII_DTOSTR_BUF_SIZE];
    if (t->follows)
        return;
    g_ascii_formatd(text, sizeof text, "%.3f", gtk_spin_button_get_value(exposure));
    lmn_error error = {0};
    lmn_look *look = document_copy_look(t->document, &error);
    put_motion(t, look, look ? lmn_look_set(look, "motion.exposure", text, &error) : LMN_MEMORY, &error, _("Exposure"));
}

/* What the first rule has; rules of a look have one exposure. */
static void follow_motion(timeline *t)
{
    const lmn_look *look = document_state(t->document)->look->look;
    char            value[LMN_VALUE_TEXT_MAX] = "";
    lmn_error       error = {0};
    guint           chosen = 0;
    const char     *way = lmn_look_motion_way(look);
    const char     *now = lmn_look_technique_count(look, 0, "motion") ? lmn_look_technique(look, 0, "motion", 0) : NULL;
    for (guint i = 0; now && motion_name(i) && !chosen; i++)
        chosen = strcmp(motion_name(i), way ? way : now) == 0 ? i + 1 : 0;
    bool has = now && lmn_look_get_text(look, 0, "motion", 0, "exposure", value, sizeof value, &error) == LMN_OK;
    t->follows = true;
    gtk_drop_down_set_selected(GTK_DROP_DOWN(t->motion), chosen);
    if (has)
        gtk_spin_button_set_value(GTK_SPIN_BUTTON(t->exposure), g_ascii_strtod(value, NULL));
    gtk_widget_set_visible(t->exposure, has);
    t->follows = false;
}

static void add_motion(timeline *t)
{
    GtkStringList *names = gtk_string_list_new(NULL);
    gtk_string_list_append(names, _("no motion"));
    for (guint i = 0; motion_name(i); i++)
        gtk_string_list_append(names, motion_name(i));
    t->motion = gtk_drop_down_new(G_LIST_MODEL(names), NULL);
    gtk_widget_set_tooltip_text(t->motion, _("How motion is drawn"));
    gtk_accessible_update_property(GTK_ACCESSIBLE(t->motion), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Motion"), -1);
    g_signal_connect(t->motion, "notify::selected", G_CALLBACK(motion_chosen), t);
    gtk_box_append(GTK_BOX(t->bar), t->motion);
    t->exposure = gtk_spin_button_new_with_range(0, 10, 0.01);
    gtk_spin_button_set_digits(GTK_SPIN_BUTTON(t->exposure), 3);
    gtk_widget_set_tooltip_text(t->exposure, _("How long the shutter is open, in seconds"));
    gtk_accessible_update_property(GTK_ACCESSIBLE(t->exposure), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Exposure"), -1);
    g_signal_connect(t->exposure, "value-changed", G_CALLBACK(exposure_changed), t);
    gtk_box_append(GTK_BOX(t->bar), t->exposure);
}

/* --- the bar --------------------------------------------------------------------------------------------- */

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
    if (changes & DOCUMENT_LOOK)
        follow_motion(t);
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
    add_motion(t);
    t->rest = button(t, "media-playback-stop-symbolic", _("At rest"), G_CALLBACK(rest_clicked), 0);
    gtk_widget_set_visible(t->bar, FALSE);
    g_object_set_data_full(G_OBJECT(t->bar), "timeline", t, timeline_free);
    document_listen(d, document_changed, t);
    return t->bar;
}
