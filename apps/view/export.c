#include "export.h"

#include <math.h>
#include <string.h>

#include "artist.h"
#include "export_work.h"
#include "trace.h"
#include "words.h"

/* The dialog. It lives as long as its window and the work that it began. */
typedef struct dialog {
    ViewWindow *owner; /* held */
    GtkWidget *window, *path, *width, *height, *samples, *transparent, *first, *last, *rate, *film, *bar, *start, *said;
    int        working;
    gint       cancelled, permille; /* between threads */
    guint      timer;
} dialog;

typedef struct export_job {
    artist_job  job;
    dialog     *dialog;
    scene_ref  *scene;
    view_state *state;
    export_wish wish;
} export_job;

static dialog *dialog_of(GtkWidget *window)
{
    return g_object_get_data(G_OBJECT(window), "dialog");
}

static bool goes_on(double fraction, const char *stage, void *user)
{
    export_job *j = user;
    g_atomic_int_set(&j->dialog->permille, (gint)(fraction * 1000));
    return !g_atomic_int_get(&j->dialog->cancelled) && artist_goes_on(fraction, stage, &j->job);
}

static lmn_status export_now(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    export_job *j = (export_job *)base;
    lmn_status  status = scene_ref_edit(j->scene, j->state->edits, error);
    if (status == LMN_OK)
        status = export_draw(j->scene, j->state, &j->wish, renderer, goes_on, j, error);
    /* Cancelled by a person: it is over, and not to be drawn again later. */
    if (status == LMN_CANCELLED && g_atomic_int_get(&j->dialog->cancelled))
        return LMN_WRITE;
    return status;
}

static void set_working(dialog *d, bool working)
{
    d->working = working;
    gtk_button_set_label(GTK_BUTTON(d->start), working ? _("Cancel") : _("Export"));
    gtk_widget_set_visible(d->bar, working);
    if (!working)
        g_clear_handle_id(&d->timer, g_source_remove);
}

static void exported(artist_job *base, lmn_status status, const lmn_error *error)
{
    export_job *j = (export_job *)base;
    dialog     *d = j->dialog;
    set_working(d, false);
    if (status == LMN_OK) {
        char *text = g_strdup_printf(_("Written: %s"), j->wish.path);
        trace_event("exported %s", j->wish.path);
        view_window_say(d->owner, text);
        gtk_label_set_text(GTK_LABEL(d->said), text);
        g_free(text);
    } else if (g_atomic_int_get(&d->cancelled)) {
        gtk_label_set_text(GTK_LABEL(d->said), _("Cancelled; nothing was written"));
        trace_event("export-cancelled");
    } else {
        char *text = g_strdup_printf("%s%s%s", error->message, *error->hint ? "\n" : "", error->hint);
        gtk_label_set_text(GTK_LABEL(d->said), text);
        trace_event("not-exported %s", error->message);
        g_free(text);
    }
}

static void export_release(artist_job *base)
{
    export_job *j = (export_job *)base;
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_free((char *)j->wish.path);
    g_object_unref(j->dialog->window);
    g_free(j);
}

static gboolean show_progress(gpointer user)
{
    dialog *d = user;
    gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(d->bar), g_atomic_int_get(&d->permille) / 1000.0);
    return G_SOURCE_CONTINUE;
}

static int number_of(GtkWidget *spin)
{
    return gtk_spin_button_get_value_as_int(GTK_SPIN_BUTTON(spin));
}

static export_wish wish_of(const dialog *d)
{
    static const int samples[] = {0, 1, 4, 9, 16};
    const char      *path = gtk_editable_get_text(GTK_EDITABLE(d->path));
    bool             film = export_is_film(path);
    return (export_wish){.path = path,
                         .width = number_of(d->width),
                         .height = number_of(d->height),
                         .samples = samples[gtk_drop_down_get_selected(GTK_DROP_DOWN(d->samples))],
                         .transparent = gtk_switch_get_active(GTK_SWITCH(d->transparent)),
                         .first = gtk_spin_button_get_value(GTK_SPIN_BUTTON(d->first)),
                         .last = gtk_spin_button_get_value(GTK_SPIN_BUTTON(d->last)),
                         .rate = film ? gtk_spin_button_get_value(GTK_SPIN_BUTTON(d->rate)) : 0};
}

static void started(GtkButton *button, gpointer user)
{
    (void)button;
    dialog *d = user;
    if (d->working) {
        g_atomic_int_set(&d->cancelled, 1);
        return;
    }
    document   *doc = view_window_document(d->owner);
    export_job *j = g_new0(export_job, 1);
    /* The picture in the window waits for it: both are drawn by one thread, and begun anew it would never end. */
    j->job = (artist_job){ARTIST_EDIT, 0, export_now, exported, export_release};
    j->dialog = d;
    g_object_ref(d->window);
    j->scene = scene_ref_take((scene_ref *)document_scene(doc));
    j->state = state_copy(document_state(doc));
    j->wish = wish_of(d);
    j->wish.path = g_strdup(j->wish.path);
    g_atomic_int_set(&d->cancelled, 0);
    g_atomic_int_set(&d->permille, 0);
    gtk_label_set_text(GTK_LABEL(d->said), "");
    set_working(d, true);
    d->timer = g_timeout_add(100, show_progress, d);
    artist_ask(view_window_artist(d->owner), &j->job);
}

/* --- the file -------------------------------------------------------------------------------------------- */

static void file_chosen(GtkNativeDialog *native, int response, gpointer user)
{
    dialog *d = user;
    if (response == GTK_RESPONSE_ACCEPT) {
        GFile *file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(native));
        char  *path = g_file_get_path(file);
        gtk_editable_set_text(GTK_EDITABLE(d->path), path ? path : "");
        g_free(path);
        g_object_unref(file);
    }
    g_object_unref(native);
    g_object_unref(d->window);
}

static void choose_file(GtkButton *button, gpointer user)
{
    (void)button;
    dialog               *d = user;
    GtkFileChooserNative *native = gtk_file_chooser_native_new(_("Export"), GTK_WINDOW(d->window),
                                                               GTK_FILE_CHOOSER_ACTION_SAVE, _("_Save"), _("_Cancel"));
    char                 *name = g_path_get_basename(gtk_editable_get_text(GTK_EDITABLE(d->path)));
    gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(native), name);
    g_free(name);
    g_object_ref(d->window);
    g_signal_connect(native, "response", G_CALLBACK(file_chosen), d);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(native));
}

static void path_changed(GtkEditable *entry, gpointer user)
{
    dialog     *d = user;
    const char *path = gtk_editable_get_text(entry);
    GStrv       endings = export_endings();
    bool        known = false;
    for (size_t i = 0; endings[i]; i++)
        known = known || (strlen(path) > strlen(endings[i]) &&
                          g_ascii_strcasecmp(path + strlen(path) - strlen(endings[i]), endings[i]) == 0);
    gtk_widget_set_sensitive(d->start, known);
    gtk_widget_set_visible(d->film, export_is_film(path));
    if (!known) {
        char *list = g_strjoinv(" ", endings), *text = g_strdup_printf(_("The ending says the format: %s"), list);
        gtk_label_set_text(GTK_LABEL(d->said), text);
        g_free(list);
        g_free(text);
    } else if (!d->working) {
        gtk_label_set_text(GTK_LABEL(d->said), "");
    }
    g_strfreev(endings);
}

/* --- the window ------------------------------------------------------------------------------------------ */

static GtkWidget *add_row(GtkWidget *group, const char *title, GtkWidget *widget)
{
    GtkWidget *row = adw_action_row_new();
    adw_preferences_row_set_title(ADW_PREFERENCES_ROW(row), title);
    gtk_widget_set_valign(widget, GTK_ALIGN_CENTER);
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, title, -1);
    adw_action_row_add_suffix(ADW_ACTION_ROW(row), widget);
    adw_preferences_group_add(ADW_PREFERENCES_GROUP(group), row);
    return widget;
}

static GtkWidget *spin(double low, double high, double step, double value, guint digits)
{
    GtkWidget *out = gtk_spin_button_new_with_range(low, high, step);
    gtk_spin_button_set_digits(GTK_SPIN_BUTTON(out), digits);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(out), value);
    return out;
}

static void add_file_row(dialog *d, GtkWidget *group, const scene_ref *scene)
{
    char *base = g_path_get_basename(scene->paths[0]), *dot = strrchr(base, '.');
    if (dot)
        *dot = 0;
    char *name = g_strdup_printf("%s.png", base), *path = g_build_filename(g_get_current_dir(), name, NULL);
    d->path = gtk_entry_new();
    gtk_editable_set_width_chars(GTK_EDITABLE(d->path), 30);
    gtk_editable_set_text(GTK_EDITABLE(d->path), path);
    add_row(group, _("File"), d->path);
    GtkWidget *choose = gtk_button_new_from_icon_name("document-open-symbolic");
    gtk_widget_set_tooltip_text(choose, _("Choose where"));
    g_signal_connect(choose, "clicked", G_CALLBACK(choose_file), d);
    add_row(group, _("Choose where"), choose);
    g_signal_connect(d->path, "changed", G_CALLBACK(path_changed), d);
    g_free(base);
    g_free(name);
    g_free(path);
}

static void add_rows(dialog *d, GtkWidget *box, const scene_ref *scene)
{
    static const char *const samples[] = {"as suits", "1", "4", "9", "16", NULL};
    GtkWidget               *group = adw_preferences_group_new();
    int                      width, height;
    view_window_picture_size(d->owner, &width, &height);
    add_file_row(d, group, scene);
    d->width = add_row(group, _("Width"), spin(1, 16384, 1, width, 0));
    d->height = add_row(group, _("Height"), spin(1, 16384, 1, height, 0));
    d->samples = add_row(group, _("Samples a pixel"), gtk_drop_down_new_from_strings(samples));
    d->transparent = add_row(group, _("Transparent ground"), gtk_switch_new());
    d->film = adw_preferences_group_new();
    adw_preferences_group_set_title(ADW_PREFERENCES_GROUP(d->film), _("Film"));
    d->first = add_row(d->film, _("From, seconds"), spin(0, 1e5, 0.1, 0, 2));
    d->last = add_row(d->film, _("To, seconds"), spin(0, 1e5, 0.1, 2, 2));
    d->rate = add_row(d->film, _("Frames a second"), spin(1, 120, 1, 24, 0));
    gtk_widget_set_visible(d->film, FALSE);
    gtk_box_append(GTK_BOX(box), group);
    gtk_box_append(GTK_BOX(box), d->film);
}

static void dialog_free(void *data)
{
    dialog *d = data;
    g_clear_handle_id(&d->timer, g_source_remove);
    g_object_unref(d->owner);
    g_free(d);
}

static gboolean closing(GtkWindow *window, gpointer user)
{
    (void)user;
    dialog *d = dialog_of(GTK_WIDGET(window));
    g_atomic_int_set(&d->cancelled, d->working);
    return FALSE;
}

void export_open(ViewWindow *w)
{
    const scene_ref *scene = document_scene(view_window_document(w));
    if (!scene)
        return;
    dialog *d = g_new0(dialog, 1);
    d->owner = g_object_ref(w);
    d->window = adw_window_new();
    gtk_window_set_title(GTK_WINDOW(d->window), _("Export"));
    gtk_window_set_transient_for(GTK_WINDOW(d->window), GTK_WINDOW(w));
    gtk_window_set_modal(GTK_WINDOW(d->window), TRUE);
    gtk_window_set_default_size(GTK_WINDOW(d->window), 520, -1);
    g_object_set_data_full(G_OBJECT(d->window), "dialog", d, dialog_free);
    g_signal_connect(d->window, "close-request", G_CALLBACK(closing), NULL);
    GtkWidget *outer = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0), *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 12);
    gtk_box_append(GTK_BOX(outer), adw_header_bar_new());
    gtk_box_append(GTK_BOX(outer), box);
    gtk_widget_set_margin_top(box, 12);
    gtk_widget_set_margin_bottom(box, 12);
    gtk_widget_set_margin_start(box, 12);
    gtk_widget_set_margin_end(box, 12);
    d->said = gtk_label_new("");
    gtk_label_set_wrap(GTK_LABEL(d->said), TRUE);
    d->bar = gtk_progress_bar_new();
    gtk_accessible_update_property(GTK_ACCESSIBLE(d->bar), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Exporting"), -1);
    d->start = gtk_button_new_with_label(_("Export"));
    gtk_widget_add_css_class(d->start, "suggested-action");
    gtk_widget_set_halign(d->start, GTK_ALIGN_CENTER);
    add_rows(d, box, scene);
    g_signal_connect(d->start, "clicked", G_CALLBACK(started), d);
    gtk_box_append(GTK_BOX(box), d->bar);
    gtk_box_append(GTK_BOX(box), d->said);
    gtk_box_append(GTK_BOX(box), d->start);
    set_working(d, false);
    adw_window_set_content(ADW_WINDOW(d->window), outer);
    gtk_window_present(GTK_WINDOW(d->window));
}
