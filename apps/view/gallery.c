#include "gallery.h"

#include <string.h>

#include "look_files.h"
#include "trace.h"
#include "words.h"

enum { THUMB_WIDTH = 138, THUMB_HEIGHT = 104, SLOT_FIRST = 1000, AFTER_MS = 900 };

/* A look that can be chosen. */
typedef struct choice {
    look_ref  *look;
    GtkWidget *button, *picture;
} choice;

typedef struct gallery {
    GtkWidget *box, *flow, *search;
    document  *document; /* NULL after gallery_close */
    artist    *artist;
    GPtrArray *choices; /* of choice */
    guint      timer;
    uint64_t   round; /* of thumbnails; older ones are not shown */
    bool       stale; /* thumbnails are asked for as soon as somebody sees them */
} gallery;

/* --- thumbnails ------------------------------------------------------------------------------------------ */

typedef struct thumb_job {
    artist_job   job;
    GtkWidget   *box; /* holds the gallery */
    gallery     *gallery;
    choice      *choice;
    scene_ref   *scene;
    view_state  *state;
    uint64_t     round;
    int          scale;
    lmn_drawing *drawing;
} thumb_job;

static lmn_status draw_thumb(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    thumb_job    *j = (thumb_job *)base;
    lmn_draw_desc desc;
    char         *selector = state_selector(j->state, j->scene);
    state_describe(j->state, j->scene, selector, THUMB_WIDTH * j->scale, THUMB_HEIGHT * j->scale, &desc);
    desc.fit_direction = true;
    desc.lenient = true;
    /* Lines of a small drawing instead of a large drawing made small: they are to be told apart. */
    desc.dpi = 60.0 * j->scale;
    desc.samples = 4;
    desc.progress = artist_goes_on;
    desc.progress_user = base;
    lmn_status status = scene_ref_edit(j->scene, j->state->edits, error);
    if (status == LMN_OK)
        status = lmn_draw(&j->drawing, renderer, j->scene->scene, j->state->look->look, &desc, error);
    g_free(selector);
    return status;
}

static void drawing_free(void *data)
{
    lmn_drawing *drawing = data;
    lmn_drawing_destroy(&drawing);
}

static void thumb_drawn(artist_job *base, lmn_status status, const lmn_error *error)
{
    thumb_job *j = (thumb_job *)base;
    if (!j->gallery->document || j->round != j->gallery->round)
        return;
    if (status != LMN_OK) {
        gtk_widget_set_tooltip_text(j->choice->button, error->message);
        return;
    }
    int            width, height;
    const uint8_t *pixels = lmn_drawing_pixels(j->drawing, &width, &height);
    GBytes *bytes = g_bytes_new_with_free_func(pixels, (gsize)width * (gsize)height * 4, drawing_free, j->drawing);
    j->drawing = NULL;
    GdkTexture *texture = gdk_memory_texture_new(width, height, GDK_MEMORY_R8G8B8A8, bytes, (gsize)width * 4);
    gtk_picture_set_paintable(GTK_PICTURE(j->choice->picture), GDK_PAINTABLE(texture));
    g_object_unref(texture);
    g_bytes_unref(bytes);
    trace_event("thumbnail look=%s", j->choice->look->origin);
}

static void thumb_release(artist_job *base)
{
    thumb_job *j = (thumb_job *)base;
    lmn_drawing_destroy(&j->drawing);
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_object_unref(j->box);
    g_free(j);
}

static void ask_thumb(gallery *g, guint index)
{
    thumb_job *j = g_new0(thumb_job, 1);
    j->job = (artist_job){ARTIST_ASIDE, SLOT_FIRST + (int)index, draw_thumb, thumb_drawn, thumb_release};
    j->gallery = g;
    j->box = g_object_ref(g->box);
    j->choice = g_ptr_array_index(g->choices, index);
    j->scene = scene_ref_take((scene_ref *)document_scene(g->document));
    j->state = state_copy(document_state(g->document));
    /* The whole model from the same side, whatever part of it the picture shows. */
    double box_min[3], box_max[3];
    state_bounds(j->state, j->scene, box_min, box_max);
    orbit_fit(&j->state->view, box_min, box_max, THUMB_WIDTH, THUMB_HEIGHT);
    look_ref_drop(j->state->look);
    j->state->look = look_ref_take(j->choice->look);
    j->round = g->round;
    j->scale = gtk_widget_get_scale_factor(g->box);
    artist_ask(g->artist, &j->job);
}

static gboolean ask_all(gpointer user)
{
    gallery *g = user;
    g->timer = 0;
    if (!g->document || !document_scene(g->document))
        return G_SOURCE_REMOVE;
    g->stale = !gtk_widget_get_mapped(g->box);
    if (g->stale)
        return G_SOURCE_REMOVE;
    g->round++;
    for (guint i = 0; i < g->choices->len; i++)
        ask_thumb(g, i);
    return G_SOURCE_REMOVE;
}

static void ask_soon(gallery *g)
{
    g_clear_handle_id(&g->timer, g_source_remove);
    g->timer = g_timeout_add(AFTER_MS, ask_all, g);
}

static void mapped(GtkWidget *box, gpointer user)
{
    (void)box;
    gallery *g = user;
    if (g->stale)
        ask_soon(g);
}

/* --- choosing -------------------------------------------------------------------------------------------- */

static void mark(gallery *g)
{
    const char *origin = document_state(g->document)->look->origin;
    /* A frame around the look that the present one comes from. */
    for (guint i = 0; i < g->choices->len; i++) {
        const choice *c = g_ptr_array_index(g->choices, i);
        bool          is_it = g_strcmp0(c->look->origin, origin) == 0;
        gtk_button_set_has_frame(GTK_BUTTON(c->button), is_it);
    }
}

static void chosen(GtkButton *button, gpointer user)
{
    gallery *g = user;
    choice  *c = g_object_get_data(G_OBJECT(button), "choice");
    document_end_step(g->document);
    document_set_look(g->document, look_ref_take(c->look), _("Look"));
    trace_event("chosen look=%s", c->look->origin);
}

static gboolean is_found(GtkFlowBoxChild *child, gpointer user)
{
    gallery    *g = user;
    const char *wanted = gtk_editable_get_text(GTK_EDITABLE(g->search));
    choice     *c = g_object_get_data(G_OBJECT(gtk_flow_box_child_get_child(child)), "choice");
    const char *doc = lmn_look_doc(c->look->look);
    char       *text = g_strdup_printf("%s %s", lmn_look_name(c->look->look), doc ? doc : "");
    bool        found = !*wanted || g_str_match_string(wanted, text, TRUE) || strstr(text, wanted);
    g_free(text);
    return found;
}

static void searched(GtkSearchEntry *entry, gpointer user)
{
    (void)entry;
    gtk_flow_box_invalidate_filter(GTK_FLOW_BOX(((gallery *)user)->flow));
}

static void document_changed(document *d, unsigned changes, void *user)
{
    (void)d;
    gallery *g = user;
    if (!g->document)
        return;
    if (changes & (DOCUMENT_SCENE | DOCUMENT_VIEW | DOCUMENT_PARTS | DOCUMENT_SOLIDS))
        ask_soon(g);
    if (changes & (DOCUMENT_LOOK | DOCUMENT_SCENE))
        mark(g);
}

/* A look is dragged onto a part as text, "look:NAME". */
static GdkContentProvider *prepare_drag(GtkDragSource *source, double x, double y, gpointer user)
{
    (void)source;
    (void)x;
    (void)y;
    choice             *c = user;
    char               *text = g_strdup_printf("look:%s", c->look->origin);
    GdkContentProvider *out = gdk_content_provider_new_typed(G_TYPE_STRING, text);
    g_free(text);
    return out;
}

static void choice_free(void *data)
{
    choice *c = data;
    look_ref_drop(c->look);
    g_free(c);
}

/* Takes the look. */
static void add_choice(gallery *g, look_ref *look)
{
    choice *c = g_new0(choice, 1);
    c->look = look;
    const char *name = lmn_look_name(look->look);
    GtkWidget  *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 2), *label = gtk_label_new(name);
    c->picture = gtk_picture_new();
    gtk_picture_set_can_shrink(GTK_PICTURE(c->picture), TRUE);
    gtk_widget_set_size_request(c->picture, THUMB_WIDTH, THUMB_HEIGHT);
    gtk_label_set_ellipsize(GTK_LABEL(label), PANGO_ELLIPSIZE_END);
    gtk_box_append(GTK_BOX(box), c->picture);
    gtk_box_append(GTK_BOX(box), label);
    c->button = gtk_button_new();
    gtk_button_set_child(GTK_BUTTON(c->button), box);
    gtk_button_set_has_frame(GTK_BUTTON(c->button), FALSE);
    gtk_widget_set_tooltip_text(c->button, lmn_look_doc(look->look));
    gtk_accessible_update_property(GTK_ACCESSIBLE(c->button), GTK_ACCESSIBLE_PROPERTY_LABEL, name, -1);
    g_object_set_data(G_OBJECT(c->button), "choice", c);
    g_signal_connect(c->button, "clicked", G_CALLBACK(chosen), g);
    GtkDragSource *drag = gtk_drag_source_new();
    g_signal_connect(drag, "prepare", G_CALLBACK(prepare_drag), c);
    gtk_widget_add_controller(c->button, GTK_EVENT_CONTROLLER(drag));
    g_ptr_array_add(g->choices, c);
    gtk_flow_box_insert(GTK_FLOW_BOX(g->flow), c->button, -1);
}

static void add_file(gallery *g, const char *path)
{
    lmn_error error = {0};
    look_ref *look = look_ref_load(path, &error);
    if (look)
        add_choice(g, look);
}

/* Those that ship, then the user's. */
static void add_looks(gallery *g)
{
    for (size_t i = 0; i < lmn_look_count(); i++)
        add_file(g, lmn_look_name_at(i));
    char       *folder = look_files_folder();
    GDir       *dir = g_dir_open(folder, 0, NULL);
    const char *name;
    while (dir && (name = g_dir_read_name(dir))) {
        char *path = g_build_filename(folder, name, NULL);
        if (g_str_has_suffix(name, ".json"))
            add_file(g, path);
        g_free(path);
    }
    if (dir)
        g_dir_close(dir);
    g_free(folder);
}

static void gallery_free(void *data)
{
    gallery *g = data;
    g_clear_handle_id(&g->timer, g_source_remove);
    g_ptr_array_unref(g->choices);
    g_free(g);
}

void gallery_close(GtkWidget *box)
{
    gallery *g = g_object_get_data(G_OBJECT(box), "gallery");
    g_clear_handle_id(&g->timer, g_source_remove);
    g->document = NULL;
    g->artist = NULL;
}

GtkWidget *gallery_new(document *d, artist *a)
{
    gallery *g = g_new0(gallery, 1);
    g->document = d;
    g->artist = a;
    g->choices = g_ptr_array_new_with_free_func(choice_free);
    g->flow = gtk_flow_box_new();
    gtk_flow_box_set_selection_mode(GTK_FLOW_BOX(g->flow), GTK_SELECTION_NONE);
    gtk_flow_box_set_homogeneous(GTK_FLOW_BOX(g->flow), TRUE);
    gtk_flow_box_set_min_children_per_line(GTK_FLOW_BOX(g->flow), 2);
    gtk_flow_box_set_max_children_per_line(GTK_FLOW_BOX(g->flow), 2);
    g->search = gtk_search_entry_new();
    gtk_widget_set_tooltip_text(g->search, _("Search looks"));
    gtk_accessible_update_property(GTK_ACCESSIBLE(g->search), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Search looks"), -1);
    add_looks(g);
    gtk_flow_box_set_filter_func(GTK_FLOW_BOX(g->flow), is_found, g, NULL);
    g_signal_connect(g->search, "search-changed", G_CALLBACK(searched), g);
    GtkWidget *scrolled = gtk_scrolled_window_new();
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scrolled), g->flow);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_EXTERNAL, GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(scrolled, TRUE);
    gtk_widget_set_valign(g->flow, GTK_ALIGN_START);
    g->box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 6);
    gtk_widget_set_margin_top(g->search, 6);
    gtk_widget_set_margin_start(g->search, 6);
    gtk_widget_set_margin_end(g->search, 6);
    gtk_box_append(GTK_BOX(g->box), g->search);
    gtk_box_append(GTK_BOX(g->box), scrolled);
    g_signal_connect(g->box, "map", G_CALLBACK(mapped), g);
    g_object_set_data_full(G_OBJECT(g->box), "gallery", g, gallery_free);
    document_listen(d, document_changed, g);
    return g->box;
}
