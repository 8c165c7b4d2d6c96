#include "solids.h"

#include <string.h>

#include "eye_row.h"
#include "trace.h"
#include "words.h"

/* --- rows ------------------------------------------------------------------------------------------------ */

#define SOLID_ROW_TYPE (solid_row_get_type())
G_DECLARE_FINAL_TYPE(SolidRow, solid_row, LIMNER, SOLID_ROW, GObject)

struct _SolidRow {
    GObject     parent_instance;
    SolidRow   *parent; /* NULL: a root; lives longer than this */
    uint32_t    solid, node;
    char       *name;
    double      original[16]; /* matrix as it was read */
    double      middle[3];    /* of its box, in its own axes */
    GListStore *children;     /* NULL: none */
};
G_DEFINE_TYPE(SolidRow, solid_row, G_TYPE_OBJECT)

static void solid_row_finalize(GObject *object)
{
    SolidRow *r = LIMNER_SOLID_ROW(object);
    g_free(r->name);
    g_clear_object(&r->children);
    G_OBJECT_CLASS(solid_row_parent_class)->finalize(object);
}

static void solid_row_class_init(SolidRowClass *class)
{
    G_OBJECT_CLASS(class)->finalize = solid_row_finalize;
}

static void solid_row_init(SolidRow *r)
{
    (void)r;
}

typedef struct solids {
    document           *document;
    const scene_ref    *shown; /* whose trees the rows are; compared only */
    GtkWidget          *box, *list;
    GListStore         *roots;
    GtkSingleSelection *selection;
    SolidRow           *marked; /* NULL: none */
} solids;

static const char *name_of(const lmn_solid_info *info)
{
    static const char *const operations[] = {NULL, N_("Union"), N_("Intersection"), N_("Difference")};
    if (info->name && *info->name)
        return info->name;
    return info->operation == LMN_SHAPE ? _("Shape") : _(operations[info->operation]);
}

/* The matrices above a row, and its own, as they were read or as the state has them now. */
static void chain(const SolidRow *r, const GArray *edits, bool now, bool own, double out[16])
{
    static const double identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    memcpy(out, identity, sizeof identity);
    for (const SolidRow *i = own ? r : r->parent; i; i = i->parent) {
        const solid_edit *edit = now ? solid_edits_find(edits, i->solid, i->node) : NULL;
        double            product[16];
        matrix_multiply(edit ? edit->matrix : i->original, out, product);
        memcpy(out, product, sizeof product);
    }
}

static SolidRow *add_row(GListStore *list, const scene_ref *scene, SolidRow *parent, uint32_t solid, uint32_t node)
{
    lmn_solid_info info;
    if (!lmn_solid_info_of(scene->scene, solid, node, &info))
        return NULL;
    SolidRow *r = g_object_new(SOLID_ROW_TYPE, NULL);
    double    above[16], middle[3];
    r->parent = parent;
    r->solid = solid;
    r->node = node;
    r->name = g_strdup(name_of(&info));
    memcpy(r->original, info.matrix, sizeof r->original);
    for (int k = 0; k < 3; k++)
        middle[k] = (info.bounds_min[k] + info.bounds_max[k]) / 2;
    chain(r, NULL, false, true, above);
    if (!matrix_solve_point(above, middle, r->middle))
        memcpy(r->middle, middle, sizeof r->middle);
    if (info.first_child)
        r->children = g_list_store_new(SOLID_ROW_TYPE);
    for (uint32_t child = info.first_child; child;) {
        lmn_solid_info next;
        add_row(r->children, scene, r, solid, child);
        child = lmn_solid_info_of(scene->scene, solid, child, &next) ? next.next_sibling : 0;
    }
    g_list_store_append(list, r);
    g_object_unref(r);
    return r;
}

/* --- what is marked -------------------------------------------------------------------------------------- */

static void put_handle(solids *s)
{
    node_handle h = {0};
    if (s->marked) {
        const GArray     *edits = document_state(s->document)->edits;
        const solid_edit *edit = solid_edits_find(edits, s->marked->solid, s->marked->node);
        double            all[16];
        h.edit = (solid_edit){.solid = s->marked->solid, .node = s->marked->node};
        memcpy(h.edit.original, s->marked->original, sizeof h.edit.original);
        memcpy(h.edit.matrix, edit ? edit->matrix : s->marked->original, sizeof h.edit.matrix);
        h.edit.hidden = edit && edit->hidden;
        chain(s->marked, edits, true, false, h.above);
        chain(s->marked, edits, true, true, all);
        matrix_move_point(all, s->marked->middle, h.at);
    }
    document_set_handle(s->document, &h);
}

static void selected(GObject *selection, GParamSpec *pspec, gpointer user)
{
    (void)pspec;
    solids         *s = user;
    GtkTreeListRow *item = gtk_single_selection_get_selected_item(GTK_SINGLE_SELECTION(selection));
    SolidRow       *row = item ? gtk_tree_list_row_get_item(item) : NULL;
    s->marked = row; /* the list holds it */
    g_clear_object(&row);
    put_handle(s);
}

static void reset_clicked(GtkButton *button, gpointer user)
{
    (void)button;
    solids *s = user;
    if (!s->marked)
        return;
    solid_edit edit = {.solid = s->marked->solid, .node = s->marked->node};
    memcpy(edit.original, s->marked->original, sizeof edit.original);
    memcpy(edit.matrix, s->marked->original, sizeof edit.matrix);
    document_end_step(s->document);
    document_edit_solid(s->document, &edit, "Put back");
}

/* --- eyes ------------------------------------------------------------------------------------------------ */

static const solid_edit *edit_of(const solids *s, const SolidRow *row)
{
    return solid_edits_find(document_state(s->document)->edits, row->solid, row->node);
}

static void eye_clicked(GtkToggleButton *eye, gpointer user)
{
    solids   *s = user;
    SolidRow *row = eye_row_clicked(eye);
    if (!row)
        return;
    const solid_edit *now = edit_of(s, row);
    solid_edit        edit = {.solid = row->solid, .node = row->node};
    memcpy(edit.original, row->original, sizeof edit.original);
    memcpy(edit.matrix, now ? now->matrix : row->original, sizeof edit.matrix);
    edit.hidden = !gtk_toggle_button_get_active(eye);
    document_end_step(s->document);
    document_edit_solid(s->document, &edit, edit.hidden ? _("Hide solid") : _("Show solid"));
    trace_event("solid node=%u hidden=%d", row->node, edit.hidden);
}

static void show_eye(gpointer user, GtkWidget *eye, gpointer of)
{
    const solids     *s = user;
    const SolidRow   *row = of;
    const solid_edit *edit = edit_of(s, row);
    eye_row_show(eye, row->name, !edit || !edit->hidden);
}

/* --- the panel ------------------------------------------------------------------------------------------- */

static GListModel *children_of(gpointer item, gpointer user)
{
    (void)user;
    SolidRow *r = item;
    return r->children ? g_object_ref(G_LIST_MODEL(r->children)) : NULL;
}

static void fill(solids *s)
{
    const scene_ref *scene = document_scene(s->document);
    size_t           count = scene ? lmn_scene_solid_count(scene->scene) : 0;
    s->shown = scene;
    s->marked = NULL;
    GListStore *roots = g_list_store_new(SOLID_ROW_TYPE);
    if (scene)
        scene_ref_lock(scene);
    for (size_t i = 0; i < count; i++)
        add_row(roots, scene, NULL, lmn_scene_solid_at(scene->scene, i), LMN_SOLID_ROOT);
    if (scene)
        scene_ref_unlock(scene);
    GListModel *tree = G_LIST_MODEL(
        gtk_tree_list_model_new(g_object_ref(G_LIST_MODEL(roots)), FALSE, count < 20, children_of, NULL, NULL));
    gtk_single_selection_set_model(s->selection, tree);
    g_object_unref(tree);
    g_clear_object(&s->roots);
    s->roots = roots;
    gtk_widget_set_visible(s->box, count > 0);
    put_handle(s);
}

static void row_setup(GtkSignalListItemFactory *factory, GtkListItem *item, gpointer user)
{
    (void)factory;
    eye_row_setup(item, PANGO_ELLIPSIZE_END, G_CALLBACK(eye_clicked), user);
}

static void row_bind(GtkSignalListItemFactory *factory, GtkListItem *item, gpointer user)
{
    (void)factory;
    GtkTreeListRow *row = gtk_list_item_get_item(item);
    SolidRow       *solid = gtk_tree_list_row_get_item(row);
    show_eye(user, eye_row_bind(item, row, solid->name, solid), solid);
}

static void document_changed(document *d, unsigned changes, void *user)
{
    solids *s = user;
    if (changes & DOCUMENT_SCENE && document_scene(d) != s->shown) {
        fill(s);
    } else if (changes & DOCUMENT_SOLIDS) {
        put_handle(s);
        eye_row_each(s->list, show_eye, s);
    }
}

static void solids_free(void *data)
{
    solids *s = data;
    g_clear_object(&s->selection);
    g_clear_object(&s->roots);
    g_free(s);
}

GtkWidget *solids_new(document *d)
{
    solids *s = g_new0(solids, 1);
    s->document = d;
    s->selection = gtk_single_selection_new(NULL);
    gtk_single_selection_set_autoselect(s->selection, FALSE);
    gtk_single_selection_set_can_unselect(s->selection, TRUE);
    g_signal_connect(s->selection, "notify::selected", G_CALLBACK(selected), s);
    GtkListItemFactory *factory = gtk_signal_list_item_factory_new();
    g_signal_connect(factory, "setup", G_CALLBACK(row_setup), s);
    g_signal_connect(factory, "bind", G_CALLBACK(row_bind), s);
    s->list = gtk_list_view_new(g_object_ref(GTK_SELECTION_MODEL(s->selection)), factory);
    gtk_widget_add_css_class(s->list, "navigation-sidebar");
    gtk_accessible_update_property(GTK_ACCESSIBLE(s->list), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Solids"), -1);
    GtkWidget *scrolled = gtk_scrolled_window_new(), *head = gtk_label_new(_("Solids")),
              *back = gtk_button_new_with_label(_("Put back"));
    gtk_widget_set_tooltip_text(back, _("The marked operand is shown and goes where the file has it"));
    g_signal_connect(back, "clicked", G_CALLBACK(reset_clicked), s);
    gtk_widget_add_css_class(head, "heading");
    gtk_widget_set_margin_top(head, 6);
    gtk_scrolled_window_set_child(GTK_SCROLLED_WINDOW(scrolled), s->list);
    gtk_scrolled_window_set_policy(GTK_SCROLLED_WINDOW(scrolled), GTK_POLICY_NEVER, GTK_POLICY_AUTOMATIC);
    gtk_widget_set_vexpand(scrolled, TRUE);
    s->box = gtk_box_new(GTK_ORIENTATION_VERTICAL, 4);
    gtk_box_append(GTK_BOX(s->box), head);
    gtk_box_append(GTK_BOX(s->box), scrolled);
    gtk_widget_set_halign(back, GTK_ALIGN_CENTER);
    gtk_widget_set_margin_bottom(back, 6);
    gtk_box_append(GTK_BOX(s->box), back);
    g_object_set_data_full(G_OBJECT(s->box), "solids", s, solids_free);
    gtk_widget_set_visible(s->box, FALSE);
    document_listen(d, document_changed, s);
    return s->box;
}
