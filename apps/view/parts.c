#include "parts.h"

#include <string.h>

#include "eye_row.h"
#include "words.h"

/* --- rows: a part, or what several paths begin with ------------------------------------------------------- */

#define PART_ROW_TYPE (part_row_get_type())
G_DECLARE_FINAL_TYPE(PartRow, part_row, LIMNER, PART_ROW, GObject)

struct _PartRow {
    GObject     parent;
    char       *name, *folded; /* folded: as search compares it */
    uint32_t    part;          /* 0: a group */
    GListStore *children;      /* NULL: none */
};
G_DEFINE_TYPE(PartRow, part_row, G_TYPE_OBJECT)

static void part_row_finalize(GObject *object)
{
    PartRow *r = LIMNER_PART_ROW(object);
    g_free(r->name);
    g_free(r->folded);
    g_clear_object(&r->children);
    G_OBJECT_CLASS(part_row_parent_class)->finalize(object);
}

static void part_row_class_init(PartRowClass *class)
{
    G_OBJECT_CLASS(class)->finalize = part_row_finalize;
}

static void part_row_init(PartRow *r)
{
    (void)r;
}

static PartRow *row_new(const char *name, uint32_t part)
{
    PartRow *r = g_object_new(PART_ROW_TYPE, NULL);
    r->name = g_strdup(name);
    r->folded = g_utf8_casefold(name, -1);
    r->part = part;
    return r;
}

/* --- the panel ------------------------------------------------------------------------------------------- */

typedef struct parts {
    document           *document;
    const scene_ref    *shown; /* of which scene the rows are; compared only */
    GtkWidget          *list, *search, *count;
    GListStore         *roots, *flat;
    GtkSingleSelection *selection;
    GtkCustomFilter    *filter;
    char               *wanted;  /* folded text of the search; "" all */
    bool                follows; /* the selection follows the document, not the other way */
} parts;

/* The group's row below `list`, made when it is not there. Paths come sorted by tree, so it can only be the last. */
static GListStore *group_of(GListStore *list, const char *name)
{
    guint    count = g_list_model_get_n_items(G_LIST_MODEL(list));
    PartRow *last = count ? g_list_model_get_item(G_LIST_MODEL(list), count - 1) : NULL;
    if (!last || last->part || strcmp(last->name, name) != 0) {
        g_clear_object(&last);
        last = row_new(name, 0);
        last->children = g_list_store_new(PART_ROW_TYPE);
        g_list_store_append(list, last);
    }
    GListStore *out = last->children;
    g_object_unref(last);
    return out;
}

static void add_part(parts *p, GPtrArray *flat, const lmn_part_info *info)
{
    GListStore *list = p->roots;
    GStrv       names = g_strsplit(info->path, "/", 0);
    guint       depth = g_strv_length(names);
    for (guint i = 0; i + 1 < depth; i++)
        list = group_of(list, names[i]);
    PartRow *row = row_new(info->name, info->id), *found = row_new(info->path, info->id);
    g_list_store_append(list, row);
    g_ptr_array_add(flat, found);
    g_object_unref(row);
    g_strfreev(names);
}

static GListModel *children_of(gpointer item, gpointer user)
{
    (void)user;
    PartRow *r = item;
    return r->children ? g_object_ref(G_LIST_MODEL(r->children)) : NULL;
}

static void show_model(parts *p)
{
    GListModel *model;
    if (*p->wanted)
        model = G_LIST_MODEL(
            gtk_filter_list_model_new(g_object_ref(G_LIST_MODEL(p->flat)), g_object_ref(GTK_FILTER(p->filter))));
    else
        model = G_LIST_MODEL(gtk_tree_list_model_new(g_object_ref(G_LIST_MODEL(p->roots)), FALSE,
                                                     p->flat && g_list_model_get_n_items(G_LIST_MODEL(p->flat)) < 200,
                                                     children_of, NULL, NULL));
    p->follows = true;
    gtk_single_selection_set_model(p->selection, model);
    p->follows = false;
    g_object_unref(model);
}

static void show_count(parts *p)
{
    const scene_ref *scene = document_scene(p->document);
    const GArray    *hidden = document_state(p->document)->hidden;
    guint            away = hidden ? hidden->len : 0;
    char            *text =
        !scene ? g_strdup("")
                   : away ? g_strdup_printf(_("%zu parts, %u hidden"), scene->info.parts, away)
                          : g_strdup_printf(g_dngettext(NULL, "%zu part", "%zu parts", scene->info.parts), scene->info.parts);
    gtk_label_set_text(GTK_LABEL(p->count), text);
    g_free(text);
}

static void fill(parts *p)
{
    const scene_ref *scene = document_scene(p->document);
    p->shown = scene;
    /* New lists instead of emptied ones: nothing is told row by row. */
    g_clear_object(&p->roots);
    g_clear_object(&p->flat);
    p->roots = g_list_store_new(PART_ROW_TYPE);
    p->flat = g_list_store_new(PART_ROW_TYPE);
    lmn_part_info info;
    GPtrArray    *flat = g_ptr_array_new_with_free_func(g_object_unref);
    if (scene)
        scene_ref_lock(scene);
    /* Signs come behind the parts of the files. */
    for (size_t i = 0; scene && i < scene->info.parts && lmn_scene_part_at(scene->scene, i, &info); i++)
        add_part(p, flat, &info);
    if (scene)
        scene_ref_unlock(scene);
    g_list_store_splice(p->flat, 0, 0, flat->pdata, flat->len);
    g_ptr_array_unref(flat);
    show_model(p);
}

static PartRow *row_of(gpointer item)
{
    if (GTK_IS_TREE_LIST_ROW(item))
        return gtk_tree_list_row_get_item(item);
    return item ? g_object_ref(item) : NULL;
}

/* Marks the row of the document's part, if it is among those shown. */
static void follow_selection(parts *p)
{
    uint32_t wanted = document_selected(p->document);
    guint    count = g_list_model_get_n_items(G_LIST_MODEL(p->selection)), at = GTK_INVALID_LIST_POSITION;
    for (guint i = 0; wanted && i < count && at == GTK_INVALID_LIST_POSITION; i++) {
        gpointer item = g_list_model_get_item(G_LIST_MODEL(p->selection), i);
        PartRow *row = row_of(item);
        if (row && row->part == wanted)
            at = i;
        g_clear_object(&row);
        g_object_unref(item);
    }
    p->follows = true;
    gtk_single_selection_set_selected(p->selection, at);
    if (at != GTK_INVALID_LIST_POSITION)
        gtk_widget_activate_action(p->list, "list.scroll-to-item", "u", at);
    p->follows = false;
}

static void selected(GObject *selection, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    parts *p = user;
    if (p->follows)
        return;
    PartRow *row = row_of(gtk_single_selection_get_selected_item(GTK_SINGLE_SELECTION(selection)));
    document_select(p->document, row ? row->part : 0);
    g_clear_object(&row);
}

/* --- rows as widgets ------------------------------------------------------------------------------------- */

static void collect(PartRow *row, GArray *out)
{
    if (row->part)
        g_array_append_val(out, row->part);
    for (guint i = 0; row->children && i < g_list_model_get_n_items(G_LIST_MODEL(row->children)); i++) {
        PartRow *child = g_list_model_get_item(G_LIST_MODEL(row->children), i);
        collect(child, out);
        g_object_unref(child);
    }
}

static bool row_is_hidden(const document *d, PartRow *row)
{
    GArray *all = g_array_new(FALSE, FALSE, sizeof(uint32_t));
    collect(row, all);
    bool hidden = all->len > 0 && document_is_hidden(d, g_array_index(all, uint32_t, 0));
    g_array_unref(all);
    return hidden;
}

static void eye_clicked(GtkToggleButton *eye, gpointer user)
{
    parts   *p = user;
    PartRow *row = eye_row_clicked(eye);
    if (!row)
        return;
    GArray *all = g_array_new(FALSE, FALSE, sizeof(uint32_t));
    collect(row, all);
    document_show_parts(p->document, (const uint32_t *)(const void *)all->data, all->len,
                        gtk_toggle_button_get_active(eye));
    g_array_unref(all);
}

static void show_eye(gpointer user, GtkWidget *eye, gpointer of)
{
    const parts *p = user;
    PartRow     *row = of;
    eye_row_show(eye, row->name, !row_is_hidden(p->document, row));
}

static void row_setup(GtkSignalListItemFactory *factory, GtkListItem *item, gpointer user)
{
    (void)factory;
    eye_row_setup(item, PANGO_ELLIPSIZE_MIDDLE, G_CALLBACK(eye_clicked), user);
}

static void row_bind(GtkSignalListItemFactory *factory, GtkListItem *item, gpointer user)
{
    (void)factory;
    gpointer what = gtk_list_item_get_item(item);
    PartRow *row = row_of(what);
    show_eye(user, eye_row_bind(item, GTK_IS_TREE_LIST_ROW(what) ? what : NULL, row->name, row), row);
}

static void document_changed(document *d, unsigned changes, void *user)
{
    parts *p = user;
    if (changes & DOCUMENT_SCENE && document_scene(d) != p->shown)
        fill(p);
    if (changes & (DOCUMENT_PARTS | DOCUMENT_SCENE)) {
        eye_row_each(p->list, show_eye, p);
        show_count(p);
    }
    if (changes & (DOCUMENT_SELECTED | DOCUMENT_SCENE))
        follow_selection(p);
}

/* --- search ---------------------------------------------------------------------------------------------- */

static gboolean is_found(gpointer item, gpointer user)
{
    return strstr(((PartRow *)item)->folded, ((parts *)user)->wanted) != NULL;
}

static void searched(GtkSearchEntry *entry, gpointer user)
{
    parts *p = user;
    bool   before = *p->wanted != 0;
    g_free(p->wanted);
    p->wanted = g_utf8_casefold(gtk_editable_get_text(GTK_EDITABLE(entry)), -1);
    if (before && *p->wanted)
        gtk_filter_changed(GTK_FILTER(p->filter), GTK_FILTER_CHANGE_DIFFERENT);
    else
        show_model(p);
    follow_selection(p);
}

/* --- menu of a row --------------------------------------------------------------------------------------- */

static void parts_free(void *data)
{
    parts *p = data;
    g_clear_object(&p->roots);
    g_clear_object(&p->flat);
    g_clear_object(&p->filter);
    g_clear_object(&p->selection);
    g_free(p->wanted);
    g_free(p);
}

static GtkWidget *make_buttons(void)
{
    static const char *const rows[][2] = {
        {N_("Hide"), "win.hide"}, {N_("Alone"), "win.alone"}, {N_("All"), "win.show-all"}};
    GtkWidget *box = gtk_box_new(GTK_ORIENTATION_HORIZONTAL, 0);
    gtk_widget_add_css_class(box, "linked");
    gtk_widget_set_margin_top(box, 6);
    gtk_widget_set_margin_bottom(box, 6);
    gtk_widget_set_halign(box, GTK_ALIGN_CENTER);
    for (size_t i = 0; i < G_N_ELEMENTS(rows); i++) {
        GtkWidget *b = gtk_button_new_with_label(_(rows[i][0]));
        gtk_actionable_set_action_name(GTK_ACTIONABLE(b), rows[i][1]);
        gtk_box_append(GTK_BOX(box), b);
    }
    return box;
}

GtkWidget *parts_new(document *d)
{
    parts *p = g_new0(parts, 1);
    p->document = d;
    p->wanted = g_strdup("");
    p->filter = gtk_custom_filter_new(is_found, p, NULL);
    p->selection = gtk_single_selection_new(NULL);
    gtk_single_selection_set_autoselect(p->selection, FALSE);
    gtk_single_selection_set_can_unselect(p->selection, TRUE);
    g_signal_connect(p->selection, "notify::selected", G_CALLBACK(selected), p);
    GtkListItemFactory *factory = gtk_signal_list_item_factory_new();
    g_signal_connect(factory, "setup", G_CALLBACK(row_setup), p);
    g_signal_connect(factory, "bind", G_CALLBACK(row_bind), p);
    p->list = gtk_list_view_new(g_object_ref(GTK_SELECTION_MODEL(p->selection)), factory);
    gtk_widget_add_css_class(p->list, "navigation-sidebar");
    gtk_accessible_update_property(GTK_ACCESSIBLE(p->list), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Parts"), -1);
    p->search = gtk_search_entry_new();
    gtk_accessible_update_property(GTK_ACCESSIBLE(p->search), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Search parts"), -1);
    gtk_widget_set_tooltip_text(p->search, _("Search parts"));
    g_signal_connect(p->search, "search-changed", G_CALLBACK(searched), p);
    p->count = gtk_label_new("");
    gtk_widget_add_css_class(p->count, "dim-label");
    GtkWidget *scrolled = gtk_scrolled_window_new(), *box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 0);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scrolled), p->list);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_NEVER, GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(scrolled, TRUE);
    gtk_widget_set_margin_start(p->search, 6);
    gtk_widget_set_margin_end(p->search, 6);
    gtk_widget_set_margin_top(p->search, 6);
    gtk_box_append(GTK_BOX(box), p->search);
    gtk_box_append(GTK_BOX(box), scrolled);
    gtk_box_append(GTK_BOX(box), p->count);
    gtk_box_append(GTK_BOX(box), make_buttons());
    gtk_widget_set_size_request(box, 220, -1);
    gtk_widget_set_hexpand(box, FALSE);
    g_object_set_data_full(G_OBJECT(box), "parts", p, parts_free);
    document_listen(d, document_changed, p);
    fill(p);
    return box;
}
