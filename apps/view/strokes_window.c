#include "strokes_window.h"

#include <math.h>

#include "stroke_sheet.h"
#include "trace.h"
#include "words.h"

enum { SIDE = 520 };
static const double PIECE = 0.012, REACH = 0.03; /* of the square: shortest piece of a curve, how near is picked */

typedef struct strokes_window {
    GtkWidget    *window, *area, *layer, *light, *distance, *edit, *said;
    stroke_sheet *sheet;
    double        begin_u, begin_v, last_u, last_v;
    int           held; /* the stroke whose end is moved; −1: none */
    bool          second;
    int           marked; /* −1: none */
    uint32_t      seed;
} strokes_window;

/* --- drawing --------------------------------------------------------------------------------------------- */

static void trace_stroke(cairo_t *cr, const lmn_stroke *k, double side)
{
    /* It goes on at the opposite side. */
    for (int i = -1; i <= 1; i++)
        for (int j = -1; j <= 1; j++) {
            cairo_move_to(cr, ((double)k->u0 + i) * side, (1 - (double)k->v0 + j) * side);
            cairo_line_to(cr, ((double)k->u1 + i) * side, (1 - (double)k->v1 + j) * side);
        }
}

static void draw_sheet(GtkDrawingArea *area, cairo_t *cr, int width, int height, gpointer user)
{
    (void)area;
    strokes_window *w = user;
    double          side = MIN(width, height), light = gtk_range_get_value(GTK_RANGE(w->light));
    double          distance = gtk_range_get_value(GTK_RANGE(w->distance));
    cairo_rectangle(cr, 0, 0, side, side);
    cairo_clip_preserve(cr);
    cairo_set_source_rgb(cr, 0.98, 0.97, 0.94);
    cairo_fill(cr);
    cairo_set_line_cap(cr, CAIRO_LINE_CAP_ROUND);
    cairo_set_line_width(cr, side / 170);
    cairo_set_source_rgb(cr, 0.1, 0.1, 0.12);
    for (guint i = 0; i < w->sheet->strokes->len; i++) {
        const lmn_stroke *k = &g_array_index(w->sheet->strokes, lmn_stroke, i);
        if (stroke_is_seen(k, light, distance))
            trace_stroke(cr, k, side);
    }
    cairo_stroke(cr);
    if (w->marked >= 0 && (guint)w->marked < w->sheet->strokes->len) {
        cairo_set_source_rgb(cr, 0.85, 0.2, 0.15);
        trace_stroke(cr, &g_array_index(w->sheet->strokes, lmn_stroke, (guint)w->marked), side);
        cairo_stroke(cr);
    }
}

static void changed(strokes_window *w)
{
    char *text =
        g_strdup_printf(g_dngettext(NULL, "%u stroke", "%u strokes", w->sheet->strokes->len), w->sheet->strokes->len);
    gtk_label_set_text(GTK_LABEL(w->said), text);
    trace_event("strokes count=%u", w->sheet->strokes->len);
    gtk_widget_queue_draw(w->area);
    g_free(text);
}

static void say_error(strokes_window *w, const lmn_error *error)
{
    gtk_label_set_text(GTK_LABEL(w->said), error->message);
}

/* --- pointer --------------------------------------------------------------------------------------------- */

static void to_square(const strokes_window *w, double x, double y, double *u, double *v)
{
    double side = MAX(1, MIN(gtk_widget_get_width(w->area), gtk_widget_get_height(w->area)));
    *u = x / side;
    *v = 1 - y / side;
}

static bool edits(const strokes_window *w)
{
    return gtk_toggle_button_get_active(GTK_TOGGLE_BUTTON(w->edit));
}

static void drag_begin(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    (void)gesture;
    strokes_window *w = user;
    to_square(w, x, y, &w->begin_u, &w->begin_v);
    w->last_u = w->begin_u;
    w->last_v = w->begin_v;
    w->held = -1;
    stroke_sheet_step(w->sheet);
    if (!edits(w))
        return;
    w->held = w->marked = stroke_sheet_pick(w->sheet, w->begin_u, w->begin_v, REACH, &w->second);
    if (w->marked >= 0)
        gtk_spin_button_set_value(GTK_SPIN_BUTTON(w->layer),
                                  g_array_index(w->sheet->strokes, lmn_stroke, (guint)w->marked).layer);
    changed(w);
}

static void drag_update(GtkGestureDrag *gesture, double dx, double dy, gpointer user)
{
    strokes_window *w = user;
    double          x, y, u, v;
    if (!gtk_gesture_drag_get_start_point(gesture, &x, &y))
        return;
    to_square(w, x + dx, y + dy, &u, &v);
    if (edits(w)) {
        if (w->held >= 0)
            stroke_sheet_move_end(w->sheet, w->held, w->second, u, v);
    } else if (hypot(u - w->last_u, v - w->last_v) >= PIECE) {
        stroke_sheet_add(w->sheet, w->last_u, w->last_v, u, v,
                         gtk_spin_button_get_value_as_int(GTK_SPIN_BUTTON(w->layer)));
        w->last_u = u;
        w->last_v = v;
    }
    changed(w);
}

/* --- buttons --------------------------------------------------------------------------------------------- */

static void layer_changed(GtkSpinButton *spin, gpointer user)
{
    strokes_window *w = user;
    if (!edits(w) || w->marked < 0 || (guint)w->marked >= w->sheet->strokes->len)
        return;
    stroke_sheet_set_layer(w->sheet, w->marked, gtk_spin_button_get_value_as_int(spin));
    changed(w);
}

static void undo_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    strokes_window *w = user;
    w->marked = -1;
    stroke_sheet_undo(w->sheet);
    changed(w);
}

static void remove_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    strokes_window *w = user;
    if (w->marked < 0 || (guint)w->marked >= w->sheet->strokes->len)
        return;
    stroke_sheet_step(w->sheet);
    stroke_sheet_remove(w->sheet, w->marked);
    w->marked = -1;
    changed(w);
}

static void shuffle_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    strokes_window *w = user;
    lmn_error       error = {0};
    stroke_sheet_step(w->sheet);
    if (stroke_sheet_order(w->sheet, LMN_ORDER_SHUFFLED, LMN_PERSPECTIVE_RANDOM, ++w->seed, &error) == LMN_OK)
        changed(w);
    else
        say_error(w, &error);
}

static void slid(GtkRange *range, gpointer user)
{
    (void)range;
    gtk_widget_queue_draw(((strokes_window *)user)->area);
}

static void file_done(GtkNativeDialog *dialog, int response, gpointer user)
{
    strokes_window *w = user;
    bool            saves = gtk_file_chooser_get_action(GTK_FILE_CHOOSER(dialog)) == GTK_FILE_CHOOSER_ACTION_SAVE;
    if (response == GTK_RESPONSE_ACCEPT) {
        lmn_error error = {0};
        GFile    *file = gtk_file_chooser_get_file(GTK_FILE_CHOOSER(dialog));
        char     *path = g_file_get_path(file);
        if (!saves)
            stroke_sheet_step(w->sheet);
        lmn_status status =
            saves ? stroke_sheet_save(w->sheet, path, &error) : stroke_sheet_load(w->sheet, path, &error);
        if (status == LMN_OK)
            changed(w);
        else
            say_error(w, &error);
        g_free(path);
        g_object_unref(file);
    }
    g_object_unref(dialog);
    g_object_unref(w->window);
}

static void choose(strokes_window *w, const char *title, GtkFileChooserAction action, const char *accept)
{
    GtkFileChooserNative *dialog =
        gtk_file_chooser_native_new(title, GTK_WINDOW(w->window), action, accept, _("_Cancel"));
    if (action == GTK_FILE_CHOOSER_ACTION_SAVE)
        gtk_file_chooser_set_current_name(GTK_FILE_CHOOSER(dialog), "strokes.stx");
    g_object_ref(w->window);
    g_signal_connect(dialog, "response", G_CALLBACK(file_done), w);
    gtk_native_dialog_show(GTK_NATIVE_DIALOG(dialog));
}

static void save_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    choose(user, _("Save strokes"), GTK_FILE_CHOOSER_ACTION_SAVE, _("_Save"));
}

static void open_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    choose(user, _("Open strokes"), GTK_FILE_CHOOSER_ACTION_OPEN, _("_Open"));
}

/* --- the window ------------------------------------------------------------------------------------------ */

static void add_button(GtkWidget *box, const char *label, GCallback clicked, strokes_window *w)
{
    GtkWidget *out = gtk_button_new_with_label(label);
    g_signal_connect(out, "clicked", clicked, w);
    gtk_box_append(GTK_BOX(box), out);
}

static GtkWidget *add_slider(GtkWidget *box, const char *label, strokes_window *w)
{
    GtkWidget *row = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6), *name = gtk_label_new(label);
    GtkWidget *out = gtk_scale_new_with_range(GTK_ORIENTATION_HORIZONTAL, 0, 1, 0.01);
    gtk_label_set_width_chars(GTK_LABEL(name), 12);
    gtk_label_set_xalign(GTK_LABEL(name), 0);
    gtk_widget_set_hexpand(out, TRUE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(out), GTK_ACCESSIBLE_PROPERTY_LABEL, label, -1);
    g_signal_connect(out, "value-changed", G_CALLBACK(slid), w);
    gtk_box_append(GTK_BOX(row), name);
    gtk_box_append(GTK_BOX(row), out);
    gtk_box_append(GTK_BOX(box), row);
    return out;
}

static GtkWidget *make_tools(strokes_window *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 6);
    w->edit = gtk_toggle_button_new_with_label(_("Edit"));
    gtk_widget_set_tooltip_text(w->edit, _("Move the ends of strokes instead of drawing"));
    w->layer = gtk_spin_button_new_with_range(0, 65535, 1);
    gtk_widget_set_tooltip_text(w->layer, _("Layer; 0 is the most important one"));
    gtk_accessible_update_property(GTK_ACCESSIBLE(w->layer), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Layer"), -1);
    g_signal_connect(w->layer, "value-changed", G_CALLBACK(layer_changed), w);
    gtk_box_append(GTK_BOX(box), w->edit);
    gtk_box_append(GTK_BOX(box), w->layer);
    add_button(box, _("Undo"), G_CALLBACK(undo_clicked), w);
    add_button(box, _("Remove"), G_CALLBACK(remove_clicked), w);
    add_button(box, _("Shuffle order"), G_CALLBACK(shuffle_clicked), w);
    add_button(box, _("Open"), G_CALLBACK(open_clicked), w);
    add_button(box, _("Save"), G_CALLBACK(save_clicked), w);
    return box;
}

static void strokes_window_free(void *data)
{
    strokes_window *w = data;
    stroke_sheet_free(w->sheet);
    g_free(w);
}

void strokes_window_open(ViewWindow *owner)
{
    strokes_window *w = g_new0(strokes_window, 1);
    w->sheet = stroke_sheet_make();
    w->held = w->marked = -1;
    w->window = adw_window_new();
    gtk_window_set_title(GTK_WINDOW(w->window), _("Draw strokes"));
    gtk_window_set_transient_for(GTK_WINDOW(w->window), GTK_WINDOW(owner));
    GtkWidget *outer = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0), *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 8);
    w->area = gtk_drawing_area_new();
    gtk_drawing_area_set_content_width(GTK_DRAWING_AREA(w->area), SIDE);
    gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(w->area), SIDE);
    gtk_accessible_update_property(GTK_ACCESSIBLE(w->area), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Square of strokes"), -1);
    gtk_box_append(GTK_BOX(outer), adw_header_bar_new());
    gtk_box_append(GTK_BOX(outer), box);
    gtk_widget_set_margin_top(box, 8);
    gtk_widget_set_margin_bottom(box, 8);
    gtk_widget_set_margin_start(box, 8);
    gtk_widget_set_margin_end(box, 8);
    gtk_box_append(GTK_BOX(box), make_tools(w));
    gtk_box_append(GTK_BOX(box), w->area);
    w->light = add_slider(box, _("Light"), w);
    w->distance = add_slider(box, _("Distance"), w);
    w->said = gtk_label_new(_("Draw with the pointer; what leaves the square comes in on the other side."));
    gtk_box_append(GTK_BOX(box), w->said);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(w->area), draw_sheet, w, NULL);
    GtkGesture *drag = gtk_gesture_drag_new();
    g_signal_connect(drag, "drag-begin", G_CALLBACK(drag_begin), w);
    g_signal_connect(drag, "drag-update", G_CALLBACK(drag_update), w);
    gtk_widget_add_controller(w->area, GTK_EVENT_CONTROLLER(drag));
    g_object_set_data_full(G_OBJECT(w->window), "strokes", w, strokes_window_free);
    adw_window_set_content(ADW_WINDOW(w->window), outer);
    gtk_window_present(GTK_WINDOW(w->window));
}
