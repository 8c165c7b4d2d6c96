#include "window_private.h"

#include "controls.h"
#include "cube.h"
#include "gallery.h"
#include "look_files.h"
#include "parts.h"
#include "picture.h"
#include "signs.h"
#include "solids.h"
#include "timeline.h"
#include "trace.h"
#include "words.h"

G_DEFINE_TYPE(ViewWindow, view_window, ADW_TYPE_APPLICATION_WINDOW)

document *view_window_document(ViewWindow *w)
{
    return w->document;
}

artist *view_window_artist(ViewWindow *w)
{
    return w->artist;
}

void view_window_picture_size(ViewWindow *w, int *width, int *height)
{
    /* Before a model is there the picture has no room of its own yet, but that of the page it will take. */
    picture_size(LIMNER_PICTURE(w->picture), width, height);
    if (gtk_widget_get_width(w->picture) == 0 && gtk_widget_get_width(w->pages) > 0) {
        int scale = gtk_widget_get_scale_factor(w->pages);
        *width = gtk_widget_get_width(w->pages) * scale;
        *height = MAX(1, gtk_widget_get_height(w->pages) * scale);
    }
}

void view_window_say(ViewWindow *w, const char *text)
{
    char *escaped = g_markup_escape_text(text, -1);
    adw_toast_overlay_add_toast(ADW_TOAST_OVERLAY(w->toasts), adw_toast_new(escaped));
    g_free(escaped);
    trace_event("said %s", text);
}

void view_window_say_error(ViewWindow *w, const lmn_error *error)
{
    char *text = g_strdup_printf("%s%s%s%s%s", error->file, *error->file ? ": " : "", error->message,
                                 *error->hint ? " – " : "", error->hint);
    view_window_say(w, text);
    g_free(text);
}

/* --- the window ------------------------------------------------------------------------------------------ */

static void name_it(GtkWidget *widget, const char *name)
{
    gtk_widget_set_tooltip_text(widget, name);
    gtk_accessible_update_property(GTK_ACCESSIBLE(widget), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
}

static GtkWidget *button(const char *icon, const char *name, const char *action)
{
    GtkWidget *out = gtk_button_new_from_icon_name(icon);
    name_it(out, name);
    gtk_actionable_set_detailed_action_name(GTK_ACTIONABLE(out), action);
    return out;
}

static GMenuModel *make_menu(ViewWindow *w)
{
    GMenu *menu = g_menu_new(), *views = g_menu_new(), *look = g_menu_new(), *copy = g_menu_new(), *end = g_menu_new();
    GMenu *section = g_menu_new();
    static const char *const names[][2] = {
        {N_("Front"), "win.view('front')"},   {N_("Back"), "win.view('back')"},
        {N_("Left"), "win.view('left')"},     {N_("Right"), "win.view('right')"},
        {N_("Top"), "win.view('top')"},       {N_("Bottom"), "win.view('bottom')"},
        {N_("Isometric"), "win.view('iso')"}, {N_("Where most is seen"), "win.view('best')"}};
    for (size_t i = 0; i < G_N_ELEMENTS(names); i++)
        g_menu_append(views, _(names[i][0]), names[i][1]);
    static const char *const cuts[][2] = {
        {N_("Across X"), "win.section('x')"}, {N_("Across Y"), "win.section('y')"},
        {N_("Across Z"), "win.section('z')"}, {N_("Other side"), "win.section('flip')"},
        {N_("Box"), "win.section('box')"},    {N_("None"), "win.section('none')"}};
    for (size_t i = 0; i < G_N_ELEMENTS(cuts); i++)
        g_menu_append(section, _(cuts[i][0]), cuts[i][1]);
    g_menu_append_submenu(look, _("View from"), G_MENU_MODEL(views));
    g_menu_append_submenu(look, _("Section"), G_MENU_MODEL(section));
    g_menu_append_submenu(look, _("Cameras"), G_MENU_MODEL(w->cameras));
    g_menu_append_submenu(look, _("Recent files"), G_MENU_MODEL(w->recent));
    g_menu_append(look, _("Fit"), "win.fit");
    g_menu_append(look, _("Parallel projection"), "win.parallel");
    g_menu_append(look, _("Walk"), "win.walk");
    g_menu_append(look, _("Turntable"), "win.turntable");
    g_menu_append(look, _("Presentation"), "win.tour");
    g_menu_append(look, _("Compare looks"), "win.compare");
    g_menu_append(look, _("Show all parts"), "win.show-all");
    g_menu_append(copy, _("Draw strokes"), "win.strokes");
    g_menu_append(copy, _("Save the look"), "win.save-look");
    g_menu_append(copy, _("Load a look"), "win.load-look");
    g_menu_append(copy, _("Print"), "win.print");
    g_menu_append(copy, _("Copy the picture"), "win.copy-picture");
    g_menu_append(copy, _("Copy as command"), "win.copy-command");
    g_menu_append(copy, _("Copy as C"), "win.copy-c");
    g_menu_append(end, _("Keys"), "win.keys");
    g_menu_append(end, _("New window"), "app.new");
    g_menu_append(end, _("Quit"), "app.quit");
    g_menu_append_section(menu, NULL, G_MENU_MODEL(look));
    g_menu_append_section(menu, NULL, G_MENU_MODEL(copy));
    g_menu_append_section(menu, NULL, G_MENU_MODEL(end));
    GMenu *all[] = {views, section, look, copy, end};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        g_object_unref(all[i]);
    return G_MENU_MODEL(menu);
}

static GtkWidget *make_header(ViewWindow *w, GtkWidget *left, GtkWidget *right)
{
    GtkWidget *bar = adw_header_bar_new(), *menu = gtk_menu_button_new();
    GtkWidget *parts = gtk_toggle_button_new(), *panel = gtk_toggle_button_new();
    w->title = adw_window_title_new("Limner", NULL);
    adw_header_bar_set_title_widget(ADW_HEADER_BAR(bar), w->title);
    gtk_menu_button_set_icon_name(GTK_MENU_BUTTON(menu), "open-menu-symbolic");
    name_it(menu, _("Main menu"));
    GMenuModel *model = make_menu(w);
    gtk_menu_button_set_menu_model(GTK_MENU_BUTTON(menu), model);
    g_object_unref(model);
    gtk_button_set_icon_name(GTK_BUTTON(parts), "sidebar-show-symbolic");
    name_it(parts, _("Parts"));
    gtk_button_set_icon_name(GTK_BUTTON(panel), "applications-graphics-symbolic");
    name_it(panel, _("Looks and controls"));
    g_object_bind_property(left, "reveal-flap", parts, "active", G_BINDING_BIDIRECTIONAL | G_BINDING_SYNC_CREATE);
    g_object_bind_property(right, "reveal-flap", panel, "active", G_BINDING_BIDIRECTIONAL | G_BINDING_SYNC_CREATE);
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), button("document-open-symbolic", _("Open"), "win.open"));
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), parts);
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), button("edit-undo-symbolic", _("Undo"), "win.undo"));
    adw_header_bar_pack_start(ADW_HEADER_BAR(bar), button("edit-redo-symbolic", _("Redo"), "win.redo"));
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), menu);
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), panel);
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), button("document-save-symbolic", _("Export"), "win.export"));
    adw_header_bar_pack_end(ADW_HEADER_BAR(bar), button("zoom-fit-best-symbolic", _("Fit"), "win.fit"));
    return bar;
}

static GtkWidget *make_panel(ViewWindow *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0), *stack = adw_view_stack_new();
    GtkWidget *bar = adw_view_switcher_bar_new(), *controls = controls_new(w->document);
    w->gallery = gallery_new(w->document, w->artist);
    adw_view_stack_add_titled(ADW_VIEW_STACK(stack), w->gallery, "looks", _("Looks"));
    adw_view_stack_add_titled(ADW_VIEW_STACK(stack), controls, "controls", _("Controls"));
    adw_view_stack_page_set_icon_name(adw_view_stack_get_page(ADW_VIEW_STACK(stack), w->gallery), "view-grid-symbolic");
    adw_view_stack_page_set_icon_name(adw_view_stack_get_page(ADW_VIEW_STACK(stack), controls),
                                      "preferences-other-symbolic");
    w->signs = signs_new(w->document, w->artist);
    adw_view_stack_add_titled(ADW_VIEW_STACK(stack), w->signs, "signs", _("Signs"));
    adw_view_stack_page_set_icon_name(adw_view_stack_get_page(ADW_VIEW_STACK(stack), w->signs), "starred-symbolic");
    adw_view_stack_set_hhomogeneous(ADW_VIEW_STACK(stack), FALSE);
    adw_view_switcher_bar_set_stack(ADW_VIEW_SWITCHER_BAR(bar), ADW_VIEW_STACK(stack));
    adw_view_switcher_bar_set_reveal(ADW_VIEW_SWITCHER_BAR(bar), TRUE);
    gtk_widget_set_vexpand(stack, TRUE);
    gtk_box_append(GTK_BOX(box), stack);
    gtk_box_append(GTK_BOX(box), bar);
    gtk_widget_set_size_request(box, 348, -1);
    gtk_widget_set_hexpand(box, FALSE); /* whatever is in it: the room is the picture's */
    return box;
}

static gboolean drop_menu(gpointer popover)
{
    gtk_widget_unparent(popover);
    return G_SOURCE_REMOVE;
}

/* Its action runs after it has closed. */
static void menu_closed(GtkPopover *popover, gpointer user)
{
    (void)user;
    g_idle_add(drop_menu, popover);
}

/* What filled the picture goes on to fill it. */
static void picture_resized(Picture *picture, gpointer user)
{
    (void)picture;
    ViewWindow *w = user;
    if (w->document && document_scene(w->document) && document_state(w->document)->fitted)
        view_window_fit(w, NULL);
}

static void picture_said(Picture *p, const char *text, gpointer user)
{
    (void)p;
    gtk_label_set_text(GTK_LABEL(LIMNER_VIEW_WINDOW(user)->status), text);
}

/* What can be done with the part below the pointer. */
static void picture_menu(Picture *p, double x, double y, guint part, gpointer user)
{
    (void)user;
    GMenu *menu = g_menu_new();
    if (part) {
        g_menu_append(menu, _("Hide"), "win.hide");
        g_menu_append(menu, _("Show alone"), "win.alone");
    }
    g_menu_append(menu, _("Show all parts"), "win.show-all");
    g_menu_append(menu, _("Fit"), "win.fit");
    GtkWidget *popover = gtk_popover_menu_new_from_model(G_MENU_MODEL(menu));
    gtk_widget_set_parent(popover, GTK_WIDGET(p));
    gtk_popover_set_pointing_to(GTK_POPOVER(popover), &(GdkRectangle){(int)x, (int)y, 1, 1});
    gtk_popover_set_has_arrow(GTK_POPOVER(popover), FALSE);
    g_signal_connect(popover, "closed", G_CALLBACK(menu_closed), NULL);
    gtk_popover_popup(GTK_POPOVER(popover));
    g_object_unref(menu);
}

static GtkWidget *make_middle(ViewWindow *w)
{
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0), *overlay = gtk_overlay_new();
    GtkWidget *empty = adw_status_page_new();
    adw_status_page_set_title(ADW_STATUS_PAGE(empty), _("Open a model"));
    adw_status_page_set_description(ADW_STATUS_PAGE(empty), _("Drop a file here, or press Ctrl+O"));
    adw_status_page_set_icon_name(ADW_STATUS_PAGE(empty), "document-open-symbolic");
    w->picture = picture_new(w->document, w->artist);
    g_signal_connect_object(w->picture, "status", G_CALLBACK(picture_said), w, 0);
    g_signal_connect_object(w->picture, "resized", G_CALLBACK(picture_resized), w, 0);
    g_signal_connect_object(w->picture, "menu", G_CALLBACK(picture_menu), w, 0);
    w->pages = gtk_stack_new();
    gtk_stack_add_named(GTK_STACK(w->pages), empty, "empty");
    gtk_stack_add_named(GTK_STACK(w->pages), w->picture, "picture");
    w->progress = gtk_progress_bar_new();
    gtk_widget_add_css_class(w->progress, "osd");
    gtk_widget_set_valign(w->progress, GTK_ALIGN_START);
    gtk_widget_set_visible(w->progress, FALSE);
    name_it(w->progress, _("Reading the model"));
    gtk_overlay_set_child(GTK_OVERLAY(overlay), w->pages);
    gtk_overlay_add_overlay(GTK_OVERLAY(overlay), w->progress);
    gtk_overlay_add_overlay(GTK_OVERLAY(overlay), cube_new(w->document));
    w->status = gtk_label_new("");
    gtk_label_set_xalign(GTK_LABEL(w->status), 0);
    gtk_label_set_ellipsize(GTK_LABEL(w->status), PANGO_ELLIPSIZE_END);
    gtk_widget_add_css_class(w->status, "dim-label");
    gtk_widget_set_margin_start(w->status, 6);
    gtk_box_append(GTK_BOX(box), overlay);
    w->timeline = timeline_new(w->document);
    gtk_box_append(GTK_BOX(box), w->timeline);
    gtk_box_append(GTK_BOX(box), w->status);
    return box;
}

static GtkWidget *make_flap(GtkWidget *flap, GtkWidget *content, GtkPackType side)
{
    GtkWidget *out = adw_flap_new();
    adw_flap_set_flap(ADW_FLAP(out), flap);
    adw_flap_set_content(ADW_FLAP(out), content);
    adw_flap_set_flap_position(ADW_FLAP(out), side);
    adw_flap_set_separator(ADW_FLAP(out), gtk_separator_new(GTK_ORIENTATION_VERTICAL));
    adw_flap_set_swipe_to_open(ADW_FLAP(out), FALSE);
    adw_flap_set_swipe_to_close(ADW_FLAP(out), FALSE);
    return out;
}

static void view_window_dispose(GObject *object)
{
    ViewWindow *w = LIMNER_VIEW_WINDOW(object);
    g_clear_handle_id(&w->reload, g_source_remove);
    g_clear_handle_id(&w->turntable, g_source_remove);
    g_clear_pointer(&w->tour, tour_free);
    g_clear_pointer(&w->watches, g_ptr_array_unref);
    g_clear_object(&w->cameras);
    g_clear_object(&w->recent);
    if (w->loading)
        g_cancellable_cancel(w->loading);
    g_clear_pointer(&w->loading_paths, g_strfreev);
    session_clear(&w->restored);
    if (w->picture)
        picture_close(LIMNER_PICTURE(w->picture));
    if (w->gallery)
        gallery_close(w->gallery);
    if (w->signs)
        signs_close(w->signs);
    w->picture = w->gallery = w->signs = NULL;
    g_clear_pointer(&w->artist, artist_end);
    G_OBJECT_CLASS(view_window_parent_class)->dispose(object);
    g_clear_pointer(&w->document, document_free);
}

static void view_window_class_init(ViewWindowClass *class)
{
    G_OBJECT_CLASS(class)->dispose = view_window_dispose;
}

static void view_window_init(ViewWindow *w)
{
    w->document = document_make();
    w->artist = artist_start();
    if (!w->document || !w->artist)
        g_error("limner: there is no memory for a window");
    w->tour = tour_make(w->document);
    w->cameras = g_menu_new();
    w->recent = g_menu_new();
    w->watches = g_ptr_array_new_with_free_func(window_stop_watch);
    window_add_actions(w);
    GtkWidget *middle = make_middle(w);
    GtkWidget *right = make_flap(make_panel(w), middle, GTK_PACK_END);
    GtkWidget *lists = gtk_paned_new(GTK_ORIENTATION_VERTICAL);
    gtk_paned_set_start_child(GTK_PANED(lists), parts_new(w->document));
    gtk_paned_set_end_child(GTK_PANED(lists), solids_new(w->document));
    GtkWidget *left = make_flap(lists, right, GTK_PACK_START);
    w->toasts = adw_toast_overlay_new();
    adw_toast_overlay_set_child(ADW_TOAST_OVERLAY(w->toasts), left);
    gtk_widget_set_vexpand(w->toasts, TRUE);
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    gtk_box_append(GTK_BOX(box), make_header(w, left, right));
    gtk_box_append(GTK_BOX(box), w->toasts);
    adw_application_window_set_content(ADW_APPLICATION_WINDOW(w), box);
    w->left = left;
    w->right = right;
    w->restored = session_read();
    adw_flap_set_reveal_flap(ADW_FLAP(left), w->restored.lists);
    adw_flap_set_reveal_flap(ADW_FLAP(right), w->restored.panel);
    gtk_window_set_default_size(GTK_WINDOW(w), w->restored.width > 0 ? w->restored.width : 1280,
                                w->restored.height > 0 ? w->restored.height : 900);
    if (w->restored.maximized)
        gtk_window_maximize(GTK_WINDOW(w));
    g_signal_connect(w, "close-request", G_CALLBACK(window_closing), NULL);
    window_list_recent(w);
    GtkEventController *events = gtk_event_controller_legacy_new();
    gtk_event_controller_set_propagation_phase(events, GTK_PHASE_CAPTURE);
    g_signal_connect(events, "event", G_CALLBACK(window_somebody_acts), w);
    gtk_widget_add_controller(GTK_WIDGET(w), events);
    GtkDropTarget *drop = gtk_drop_target_new(GDK_TYPE_FILE_LIST, GDK_ACTION_COPY);
    g_signal_connect(drop, "drop", G_CALLBACK(window_dropped), w);
    gtk_widget_add_controller(GTK_WIDGET(w), GTK_EVENT_CONTROLLER(drop));
    document_listen(w->document, window_document_changed, w);
    look_files_watch(w);
    window_document_changed(w->document, 0, w);
}

ViewWindow *view_window_new(AdwApplication *application)
{
    return g_object_new(VIEW_WINDOW_TYPE, "application", application, NULL);
}
