#include "export.h"

#include <string.h>
#include <unistd.h>

#include "aside.h"
#include "export_preview.h"
#include "export_work.h"
#include "trace.h"
#include "words.h"

static const int    SAMPLES[] = {0, 1, 4, 9, 16};
static const double RESOLUTIONS[] = {0, 72, 96, 150, 300, 600};

/* Sizes that are asked for often; width 0: the window's, times `height`. */
typedef struct preset {
    const char *name;
    int         width, height;
    double      dpi;
} preset;
static const preset presets[] = {
    {N_("As the window"), 0, 1, 0},       {N_("Twice the window"), 0, 2, 0},    {"1024 × 1024", 1024, 1024, 0},
    {"2048 × 2048", 2048, 2048, 0},       {"4096 × 4096", 4096, 4096, 0},       {"Full HD, 1920 × 1080", 1920, 1080, 0},
    {"4K, 3840 × 2160", 3840, 2160, 0},   {N_("A4, upright"), 2480, 3508, 300}, {N_("A4, across"), 3508, 2480, 300},
    {N_("A3, upright"), 3508, 4961, 300}, {N_("A3, across"), 4961, 3508, 300},  {N_("Other"), -1, 0, 0},
};

/* The dialog of a window. It outlives its widgets until the work that it began has ended. */
typedef struct dialog {
    int         holders;
    ViewWindow *owner; /* NULL when it is closed, and the widgets with it */
    GtkWidget  *window, *preview, *path, *format, *size, *width, *height, *resolution, *samples, *transparent;
    GtkWidget  *samples_row, *transparent_row, *film, *first, *last, *rate, *bar, *start, *said, *extent;
    GStrv       endings;
    aside      *work; /* NULL: none */
    char       *written;
    bool        follows; /* rows are set by each other, not by a person */
} dialog;

static dialog *hold(dialog *d)
{
    d->holders++;
    return d;
}

static void let_go(void *data)
{
    dialog *d = data;
    if (--d->holders > 0)
        return;
    g_strfreev(d->endings);
    g_free(d->written);
    g_free(d);
}

static const char *path_of(const dialog *d)
{
    return gtk_editable_get_text(GTK_EDITABLE(d->path));
}

static int number_of(GtkWidget *spin)
{
    return gtk_spin_button_get_value_as_int(GTK_SPIN_BUTTON(spin));
}

static export_wish wish_of(const dialog *d)
{
    int width, height;
    view_window_picture_size(d->owner, &width, &height);
    return (export_wish){.path = path_of(d),
                         .width = number_of(d->width),
                         .height = number_of(d->height),
                         .dpi = RESOLUTIONS[gtk_drop_down_get_selected(GTK_DROP_DOWN(d->resolution))],
                         .samples = SAMPLES[gtk_drop_down_get_selected(GTK_DROP_DOWN(d->samples))],
                         .transparent = gtk_switch_get_active(GTK_SWITCH(d->transparent)),
                         .first = gtk_spin_button_get_value(GTK_SPIN_BUTTON(d->first)),
                         .last = gtk_spin_button_get_value(GTK_SPIN_BUTTON(d->last)),
                         .rate = gtk_spin_button_get_value(GTK_SPIN_BUTTON(d->rate)),
                         .shown = (double)width / height};
}

/* --- work ------------------------------------------------------------------------------------------------ */

typedef struct export_job {
    dialog     *dialog;
    export_wish wish;
} export_job;

static lmn_status work(const scene_ref *scene, const view_state *state, lmn_renderer *renderer,
                       lmn_progress_fn progress, void *progress_user, void *user, lmn_error *error)
{
    const export_job *j = user;
    return export_draw(scene, state, &j->wish, renderer, progress, progress_user, error);
}

static void say(dialog *d, const char *text, bool is_error)
{
    gtk_label_set_text(GTK_LABEL(d->said), text);
    (is_error ? gtk_widget_add_css_class : gtk_widget_remove_css_class)(d->said, "error");
}

static void show_working(dialog *d)
{
    bool working = d->work != NULL;
    gtk_button_set_label(GTK_BUTTON(d->start), working ? _("Cancel") : _("Export"));
    (working ? gtk_widget_remove_css_class : gtk_widget_add_css_class)(d->start, "suggested-action");
    gtk_widget_set_sensitive(d->start, TRUE);
    gtk_widget_set_visible(d->bar, working);
    if (working)
        gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(d->bar), 0);
}

static void show_progress(double fraction, void *user)
{
    const dialog *d = ((export_job *)user)->dialog;
    if (d->owner)
        gtk_progress_bar_set_fraction(GTK_PROGRESS_BAR(d->bar), fraction);
}

static void tell(dialog *d, const char *path, lmn_status status, const lmn_error *error)
{
    show_working(d);
    if (status == LMN_OK) {
        char *text = g_strdup_printf(_("Written: %s"), path);
        view_window_say(d->owner, text);
        say(d, text, false);
        g_free(text);
    } else if (status == LMN_CANCELLED) {
        say(d, _("Cancelled; nothing was written"), false);
    } else {
        char *text = g_strdup_printf("%s%s%s%s%s", error->file, *error->file ? ": " : "", error->message,
                                     *error->hint ? "\n" : "", error->hint);
        say(d, text, true);
        g_free(text);
    }
}

static void worked(lmn_status status, const lmn_error *error, void *user)
{
    export_job *j = user;
    dialog     *d = j->dialog;
    d->work = NULL;
    if (status == LMN_OK)
        trace_event("exported %s", j->wish.path);
    else if (status == LMN_CANCELLED)
        trace_event("export-cancelled");
    else
        trace_event("not-exported %s", error->message);
    if (status == LMN_OK) {
        g_free(d->written);
        d->written = g_strdup(j->wish.path);
    }
    if (d->owner)
        tell(d, j->wish.path, status, error);
    g_free((char *)j->wish.path);
    let_go(d);
    g_free(j);
    g_application_release(g_application_get_default());
}

static void start(dialog *d)
{
    document   *doc = view_window_document(d->owner);
    export_job *j = g_new0(export_job, 1);
    j->dialog = hold(d);
    j->wish = wish_of(d);
    j->wish.path = g_strdup(j->wish.path);
    /* The program does not end before the file is whole or gone. */
    g_application_hold(g_application_get_default());
    say(d, "", false);
    d->work = aside_begin(&(aside_desc){view_window_artist(d->owner), document_scene(doc), document_state(doc), work,
                                        show_progress, worked, j});
    show_working(d);
}

static void start_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    dialog *d = user;
    if (d->work) {
        aside_cancel(d->work);
        gtk_button_set_label(GTK_BUTTON(d->start), _("Cancelling…"));
        gtk_widget_set_sensitive(d->start, FALSE);
    } else if (document_scene(view_window_document(d->owner))) {
        start(d);
    }
}

/* --- rows that follow each other ------------------------------------------------------------------------- */

/* What is told below the preview: how large it is on paper. */
static void show_extent(dialog *d)
{
    export_wish wish = wish_of(d);
    double      longer = MAX(wish.width, wish.height), by = wish.dpi > 0 ? 25.4 / wish.dpi : 25.4 * 1024 / 96 / longer;
    char *text = g_strdup_printf(_("%d × %d pixels, on paper %.0f × %.0f mm"), wish.width, wish.height, wish.width * by,
                                 wish.height * by);
    gtk_label_set_text(GTK_LABEL(d->extent), text);
    g_free(text);
}

static void show_preview(dialog *d)
{
    export_wish wish = wish_of(d);
    show_extent(d);
    export_preview_ask(d->preview, d->owner, &wish);
}

/* Which rows the format has a use for, and whether it is one. */
static void show_rows(dialog *d)
{
    lmn_format_info format = {0};
    wish_kind       kind = wish_kind_of(path_of(d), &format);
    const lmn_look *look = document_state(view_window_document(d->owner))->look->look;
    bool            known = false, pixels = kind != WISH_SHEET || (format.pictures && lmn_look_needs_pixels(look));
    for (guint i = 0; d->endings[i]; i++) {
        bool same = g_str_has_suffix(path_of(d), d->endings[i]);
        known = known || same;
        if (same)
            gtk_drop_down_set_selected(GTK_DROP_DOWN(d->format), i);
    }
    gtk_widget_set_sensitive(d->start, d->work || known);
    gtk_widget_set_visible(d->film, kind == WISH_FILM);
    gtk_widget_set_visible(d->samples_row, pixels);
    gtk_widget_set_visible(d->transparent_row, kind == WISH_UNKNOWN || format.ground);
    char *list = g_strjoinv(" ", d->endings), *text = g_strdup_printf(_("The ending says the format: %s"), list);
    bool  there = known && g_strcmp0(path_of(d), d->written) != 0 && g_file_test(path_of(d), G_FILE_TEST_EXISTS);
    if (!d->work)
        say(d, !known ? text : there ? _("The file is there already and will be replaced") : "", !known);
    g_free(list);
    g_free(text);
}

static void path_changed(GtkEditable *entry, gpointer user)
{
    (void)entry;
    dialog *d = user;
    bool    before = d->follows;
    d->follows = true;
    show_rows(d);
    d->follows = before;
    show_preview(d);
}

/* The name gets the ending. */
static void format_chosen(GObject *list, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    dialog *d = user;
    if (d->follows)
        return;
    const char *ending = d->endings[gtk_drop_down_get_selected(GTK_DROP_DOWN(list))];
    char       *path = g_strdup(path_of(d)), *slash = strrchr(path, '/'), *dot = strrchr(slash ? slash : path, '.');
    if (dot && dot > (slash ? slash + 1 : path))
        *dot = 0;
    char *whole = g_strconcat(path, ending, NULL);
    gtk_editable_set_text(GTK_EDITABLE(d->path), whole);
    g_free(path);
    g_free(whole);
}

static void preset_chosen(GObject *list, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    dialog       *d = user;
    const preset *p = &presets[gtk_drop_down_get_selected(GTK_DROP_DOWN(list))];
    int           width, height;
    if (d->follows || p->width < 0)
        return;
    view_window_picture_size(d->owner, &width, &height);
    width = p->width ? p->width : width * p->height;
    height = p->width ? p->height : height * p->height;
    d->follows = true;
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(d->width), width);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(d->height), height);
    for (guint i = 0; i < G_N_ELEMENTS(RESOLUTIONS); i++)
        if (RESOLUTIONS[i] == p->dpi)
            gtk_drop_down_set_selected(GTK_DROP_DOWN(d->resolution), i);
    d->follows = false;
    show_preview(d);
}

static void size_changed(GtkSpinButton *spin, gpointer user)
{
    (void)spin;
    dialog *d = user;
    if (d->follows)
        return;
    gtk_drop_down_set_selected(GTK_DROP_DOWN(d->size), G_N_ELEMENTS(presets) - 1);
    show_preview(d);
}

static void looks_different(GObject *object, GParamSpec *pspec, gpointer user)
{
    (void)object;
    (void)pspec;
    dialog *d = user;
    if (!d->follows)
        show_preview(d);
}

/* What the window shows may have changed meanwhile. */
static void became_active(GObject *window, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    if (gtk_window_is_active(GTK_WINDOW(window)) && ((dialog *)user)->owner)
        path_changed(NULL, user);
}

/* --- the file -------------------------------------------------------------------------------------------- */

static void file_chosen(GtkNativeDialog *native, int response, gpointer user)
{
    dialog *d = user;
    if (response == GTK_RESPONSE_ACCEPT && d->owner) {
        GFile *file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(native));
        char  *path = g_file_get_path(file);
        gtk_editable_set_text(GTK_EDITABLE(d->path), path ? path : "");
        g_free(path);
        g_object_unref(file);
    }
    g_object_unref(native);
    let_go(d);
}

static void choose_file(GtkButton *button, gpointer user)
{
    (void)button;
    dialog               *d = user;
    GtkFileChooserNative *native = gtk_file_chooser_native_new(_("Export"), GTK_WINDOW(d->window),
                                                               GTK_FILE_CHOOSER_ACTION_SAVE, _("_Save"), _("_Cancel"));
    char                 *name = g_path_get_basename(path_of(d)), *folder = g_path_get_dirname(path_of(d));
    GFile                *file = g_file_new_for_path(folder);
    gtk_file_chooser_set_current_folder(GTK_FILE_CHOOSER(native), file, NULL);
    gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(native), name);
    g_object_unref(file);
    g_free(name);
    g_free(folder);
    g_signal_connect(native, "response", G_CALLBACK(file_chosen), hold(d));
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(native));
}

/* Beside what one works on, or at home when nothing can be written there. */
static char *first_path(const scene_ref *scene)
{
    char *here = g_get_current_dir(), *base = g_path_get_basename(scene->paths[0]), *dot = strrchr(base, '.');
    if (dot && dot > base)
        *dot = 0;
    char *name = g_strdup_printf("%s.png", base);
    char *out =
        g_build_filename(access(here, W_OK) == 0 && strcmp(here, "/") != 0 ? here : g_get_home_dir(), name, NULL);
    g_free(here);
    g_free(base);
    g_free(name);
    return out;
}

/* --- the window ------------------------------------------------------------------------------------------ */

static void name_it(GtkWidget *widget, const char *name)
{
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
}

static GtkWidget *add_row(GtkWidget *group, const char *title, GtkWidget *widget, GtkWidget *second)
{
    GtkWidget *row = adw_action_row_new();
    adw_preferences_row_set_title(ADW_PREFERENCES_ROW(row), title);
    GtkWidget *both[] = {widget, second};
    for (size_t i = 0; i < 2 && both[i]; i++) {
        gtk_widget_set_valign(both[i], GTK_ALIGN_CENTER);
        adw_action_row_add_suffix(ADW_ACTION_ROW(row), both[i]);
    }
    adw_preferences_group_add(ADW_PREFERENCES_GROUP(group), row);
    return row;
}

static GtkWidget *spin(const char *name, double low, double high, double step, double value, guint digits)
{
    GtkWidget *out = gtk_spin_button_new_with_range(low, high, step);
    gtk_spin_button_set_digits(GTK_SPIN_BUTTON(out), digits);
    gtk_spin_button_set_value(GTK_SPIN_BUTTON(out), value);
    gtk_widget_set_tooltip_text(out, name);
    name_it(out, name);
    return out;
}

static GtkWidget *list(const char *name, const char *const *texts)
{
    GtkWidget *out = gtk_drop_down_new_from_strings(texts);
    name_it(out, name);
    return out;
}

static void add_file(dialog *d, GtkWidget *group)
{
    char      *path = first_path(document_scene(view_window_document(d->owner)));
    GtkWidget *choose = gtk_button_new_from_icon_name("folder-open-symbolic");
    GPtrArray *names = g_ptr_array_new_with_free_func(g_free);
    for (guint i = 0; d->endings[i]; i++)
        g_ptr_array_add(names, g_ascii_strup(d->endings[i] + 1, -1));
    g_ptr_array_add(names, NULL);
    d->path = gtk_entry_new();
    gtk_widget_set_hexpand(d->path, TRUE);
    gtk_editable_set_text(GTK_EDITABLE(d->path), path);
    gtk_editable_set_position(GTK_EDITABLE(d->path), -1);
    name_it(d->path, _("File"));
    gtk_widget_add_css_class(choose, "flat");
    gtk_widget_set_tooltip_text(choose, _("Choose where"));
    name_it(choose, _("Choose where"));
    add_row(group, _("File"), d->path, choose);
    d->format = list(_("Format"), (const char *const *)names->pdata);
    add_row(group, _("Format"), d->format, NULL);
    g_signal_connect(choose, "clicked", G_CALLBACK(choose_file), d);
    g_signal_connect(d->path, "changed", G_CALLBACK(path_changed), d);
    g_signal_connect(d->format, "notify::selected", G_CALLBACK(format_chosen), d);
    g_ptr_array_unref(names);
    g_free(path);
}

static void add_size(dialog *d, GtkWidget *group)
{
    const char *names[G_N_ELEMENTS(presets) + 1] = {NULL};
    const char *resolutions[] = {_("as suits"), "72", "96", "150", "300", "600", NULL};
    int         width, height;
    for (size_t i = 0; i < G_N_ELEMENTS(presets); i++)
        names[i] = _(presets[i].name);
    view_window_picture_size(d->owner, &width, &height);
    d->size = list(_("Size"), names);
    d->width = spin(_("Width"), 1, 16384, 1, width, 0);
    d->height = spin(_("Height"), 1, 16384, 1, height, 0);
    d->resolution = list(_("Pixels an inch"), resolutions);
    add_row(group, _("Size"), d->size, NULL);
    add_row(group, _("Width and height"), d->width, d->height);
    GtkWidget *row = add_row(group, _("Pixels an inch"), d->resolution, NULL);
    adw_action_row_set_subtitle(ADW_ACTION_ROW(row), _("Lengths of looks are on paper"));
    g_signal_connect(d->size, "notify::selected", G_CALLBACK(preset_chosen), d);
    g_signal_connect(d->width, "value-changed", G_CALLBACK(size_changed), d);
    g_signal_connect(d->height, "value-changed", G_CALLBACK(size_changed), d);
    g_signal_connect(d->resolution, "notify::selected", G_CALLBACK(looks_different), d);
}

static void add_picture(dialog *d, GtkWidget *group)
{
    const char *samples[] = {_("as suits"), "1", "4", "9", "16", NULL};
    d->samples = list(_("Samples a pixel"), samples);
    d->transparent = gtk_switch_new();
    name_it(d->transparent, _("Transparent ground"));
    d->samples_row = add_row(group, _("Samples a pixel"), d->samples, NULL);
    d->transparent_row = add_row(group, _("Transparent ground"), d->transparent, NULL);
    g_signal_connect(d->transparent, "notify::active", G_CALLBACK(looks_different), d);
}

/* Where the state's clip ends, or the first one; without any, some time. */
static double length_of(document *doc)
{
    enum { SOME_TIME = 2 };
    const GArray *clips = document_scene(doc)->clips;
    const char   *chosen = document_state(doc)->clip;
    guint64       number = chosen ? g_ascii_strtoull(chosen, NULL, 10) : 1;
    double        end = clips->len ? g_array_index(clips, clip_info, 0).end_s : 0;
    for (guint i = 0; i < clips->len; i++)
        if (chosen && (i + 1 == number || g_strcmp0(g_array_index(clips, clip_info, i).name, chosen) == 0))
            end = g_array_index(clips, clip_info, i).end_s;
    return end > 0 ? end : SOME_TIME;
}

static void add_film(dialog *d, GtkWidget *box)
{
    d->film = adw_preferences_group_new();
    adw_preferences_group_set_title(ADW_PREFERENCES_GROUP(d->film), _("Film"));
    d->first = spin(_("From, seconds"), 0, 1e5, 0.1, 0, 2);
    d->last = spin(_("To, seconds"), 0, 1e5, 0.1, length_of(view_window_document(d->owner)), 2);
    d->rate = spin(_("Frames a second"), 1, 120, 1, 24, 0);
    add_row(d->film, _("From, seconds"), d->first, NULL);
    add_row(d->film, _("To, seconds"), d->last, NULL);
    add_row(d->film, _("Frames a second"), d->rate, NULL);
    gtk_box_append(GTK_BOX(box), d->film);
}

static GtkWidget *make_rows(dialog *d)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 18), *scrolled = gtk_scrolled_window_new();
    GtkWidget *groups[3];
    for (size_t i = 0; i < G_N_ELEMENTS(groups); i++) {
        groups[i] = adw_preferences_group_new();
        gtk_box_append(GTK_BOX(box), groups[i]);
    }
    add_file(d, groups[0]);
    add_size(d, groups[1]);
    add_picture(d, groups[2]);
    add_film(d, box);
    gtk_widget_set_margin_top(box, 12);
    gtk_widget_set_margin_bottom(box, 12);
    gtk_widget_set_margin_end(box, 12);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scrolled), box);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_NEVER, GTK_POLICY_AUTOMATIC);
    gtk_widget_set_size_request(scrolled, 440, -1);
    gtk_widget_set_hexpand(scrolled, TRUE);
    return scrolled;
}

/* The preview, and below it what happens. */
static GtkWidget *make_side(dialog *d)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 12);
    d->preview = export_preview_new();
    d->extent = gtk_label_new("");
    gtk_widget_add_css_class(d->extent, "dim-label");
    d->said = gtk_label_new("");
    gtk_label_set_wrap(GTK_LABEL(d->said), TRUE);
    gtk_label_set_wrap_mode(GTK_LABEL(d->said), PANGO_WRAP_WORD_CHAR);
    gtk_label_set_max_width_chars(GTK_LABEL(d->said), 36);
    gtk_widget_set_vexpand(d->said, TRUE);
    gtk_widget_set_valign(d->said, GTK_ALIGN_END);
    d->bar = gtk_progress_bar_new();
    gtk_progress_bar_set_show_text(GTK_PROGRESS_BAR(d->bar), TRUE);
    name_it(d->bar, _("Exporting"));
    d->start = gtk_button_new_with_label(_("Export"));
    gtk_widget_add_css_class(d->start, "pill");
    gtk_widget_set_halign(d->start, GTK_ALIGN_CENTER);
    g_signal_connect(d->start, "clicked", G_CALLBACK(start_clicked), d);
    GtkWidget *all[] = {d->preview, d->extent, d->said, d->bar, d->start};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        gtk_box_append(GTK_BOX(box), all[i]);
    gtk_widget_set_margin_top(box, 12);
    gtk_widget_set_margin_bottom(box, 18);
    gtk_widget_set_margin_start(box, 12);
    gtk_widget_set_size_request(box, EXPORT_PREVIEW_SIDE, -1);
    return box;
}

/* It is closed, by itself or with its owner, whose end it must not hold up; its work may take a moment to notice. */
static void closed(GtkWidget *window, gpointer user)
{
    (void)window;
    dialog *d = user;
    if (d->work)
        aside_cancel(d->work);
    export_preview_end(d->preview);
    g_object_set_data(G_OBJECT(d->owner), "export-dialog", NULL);
    d->owner = NULL;
}

static gboolean key_pressed(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys;
    (void)code;
    (void)state;
    if (key != GDK_KEY_Escape)
        return FALSE;
    gtk_window_close(GTK_WINDOW(((dialog *)user)->window));
    return TRUE;
}

static void make_window(dialog *d)
{
    GtkWidget *outer = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0), *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 18);
    GtkEventController *keys = gtk_event_controller_key_new();
    d->window = adw_window_new();
    gtk_window_set_title(GTK_WINDOW(d->window), _("Export"));
    gtk_window_set_transient_for(GTK_WINDOW(d->window), GTK_WINDOW(d->owner));
    gtk_window_set_destroy_with_parent(GTK_WINDOW(d->window), TRUE);
    gtk_window_set_default_size(GTK_WINDOW(d->window), 820, 600);
    g_object_set_data_full(G_OBJECT(d->window), "dialog", hold(d), let_go);
    d->follows = true;
    gtk_box_append(GTK_BOX(outer), adw_header_bar_new());
    gtk_box_append(GTK_BOX(outer), box);
    gtk_box_append(GTK_BOX(box), make_side(d));
    gtk_box_append(GTK_BOX(box), make_rows(d));
    gtk_widget_set_vexpand(box, TRUE);
    adw_window_set_content(ADW_WINDOW(d->window), outer);
    gtk_widget_add_controller(d->window, keys);
    gtk_window_set_default_widget(GTK_WINDOW(d->window), d->start);
    gtk_entry_set_activates_default(GTK_ENTRY(d->path), TRUE);
    d->follows = false;
    g_signal_connect(keys, "key-pressed", G_CALLBACK(key_pressed), d);
    g_signal_connect(d->window, "unmap", G_CALLBACK(closed), d);
    g_signal_connect(d->window, "notify::is-active", G_CALLBACK(became_active), d);
}

void export_open(ViewWindow *w)
{
    GtkWidget *open = g_object_get_data(G_OBJECT(w), "export-dialog");
    if (open) {
        gtk_window_present(GTK_WINDOW(open));
        return;
    }
    if (!document_scene(view_window_document(w)))
        return;
    dialog *d = g_new0(dialog, 1);
    d->owner = w;
    d->endings = export_endings();
    make_window(d);
    g_object_set_data(G_OBJECT(w), "export-dialog", d->window);
    show_working(d);
    path_changed(NULL, d);
    gtk_window_present(GTK_WINDOW(d->window));
}
