#include "export_preview.h"

#include <math.h>

#include "artist.h"
#include "export_work.h"
#include "trace.h"
#include "words.h"

enum { SLOT_PREVIEW = 900, AFTER_MS = 200 };

typedef struct preview {
    GtkWidget  *picture;
    ViewWindow *owner; /* NULL: nothing is asked for */
    export_wish wish;
    guint       timer;
} preview;

typedef struct preview_job {
    artist_job   job;
    GtkWidget   *picture; /* held */
    scene_ref   *scene;
    view_state  *state;
    export_wish  wish;
    lmn_drawing *drawing;
} preview_job;

static lmn_status draw(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    preview_job *j = (preview_job *)base;
    lmn_status   status = scene_ref_edit(j->scene, j->state->edits, error);
    return status == LMN_OK
               ? export_picture(&j->drawing, j->scene, j->state, j->wish, renderer, artist_goes_on, base, error)
               : status;
}

static void show(artist_job *base, lmn_status status, const lmn_error *error)
{
    (void)error;
    preview_job *j = (preview_job *)base;
    int          width, height;
    if (status != LMN_OK) {
        gtk_picture_set_paintable(GTK_PICTURE(j->picture), NULL); /* exporting says why */
        return;
    }
    const uint8_t *pixels = lmn_drawing_pixels(j->drawing, &width, &height);
    GBytes        *bytes = g_bytes_new(pixels, (gsize)width * (gsize)height * 4);
    GdkTexture    *texture = gdk_memory_texture_new(width, height, GDK_MEMORY_R8G8B8A8, bytes, (gsize)width * 4);
    int            scale = gtk_widget_get_scale_factor(j->picture);
    gtk_picture_set_paintable(GTK_PICTURE(j->picture), GDK_PAINTABLE(texture));
    gtk_widget_set_size_request(j->picture, MAX(1, width / scale), MAX(1, height / scale));
    trace_event("preview width=%d height=%d", width, height);
    g_bytes_unref(bytes);
    g_object_unref(texture);
}

static void release(artist_job *base)
{
    preview_job *j = (preview_job *)base;
    lmn_drawing_destroy(&j->drawing);
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_object_unref(j->picture);
    g_free(j);
}

/* As large as there is space, with the wish's proportions and its widths of lines. */
static export_wish small_wish(const export_wish *wish, int scale)
{
    export_wish out = *wish;
    double      by = fmin(1, EXPORT_PREVIEW_SIDE * (double)scale / MAX(wish->width, wish->height));
    out.path = NULL;
    out.width = MAX(1, (int)lrint(wish->width * by));
    out.height = MAX(1, (int)lrint(wish->height * by));
    out.dpi = wish->dpi > 0 ? fmax(1, wish->dpi * by) : 0;
    out.samples = 4;
    return out;
}

static gboolean ask(gpointer user)
{
    preview         *p = user;
    document        *d = view_window_document(p->owner);
    const scene_ref *scene = document_scene(d);
    p->timer = 0;
    if (!scene)
        return G_SOURCE_REMOVE;
    preview_job *j = g_new0(preview_job, 1);
    j->job = (artist_job){ARTIST_REST, SLOT_PREVIEW, draw, show, release};
    j->picture = g_object_ref(p->picture);
    j->scene = scene_ref_take((scene_ref *)scene);
    j->state = state_copy(document_state(d));
    j->wish = small_wish(&p->wish, gtk_widget_get_scale_factor(p->picture));
    artist_ask(view_window_artist(p->owner), &j->job);
    return G_SOURCE_REMOVE;
}

static preview *of(GtkWidget *picture)
{
    return g_object_get_data(G_OBJECT(picture), "preview");
}

void export_preview_ask(GtkWidget *picture, ViewWindow *w, const export_wish *wish)
{
    preview *p = of(picture);
    p->owner = w;
    p->wish = *wish;
    p->wish.path = NULL;
    if (!p->timer)
        p->timer = g_timeout_add(AFTER_MS, ask, p);
}

void export_preview_end(GtkWidget *picture)
{
    preview *p = of(picture);
    g_clear_handle_id(&p->timer, g_source_remove);
    if (p->owner && view_window_artist(p->owner)) /* it ends before its window */
        artist_drop(view_window_artist(p->owner), SLOT_PREVIEW);
    p->owner = NULL;
}

static void preview_free(void *data)
{
    preview *p = data;
    g_clear_handle_id(&p->timer, g_source_remove);
    g_free(p);
}

/* What shows through a transparent ground. */
static void add_style(void)
{
    static const char css[] =
        ".export-preview { background-color: #fff; background-image: linear-gradient(45deg, #ccc 25%, transparent 25%, "
        "transparent 75%, #ccc 75%), linear-gradient(45deg, #ccc 25%, transparent 25%, transparent 75%, #ccc 75%); "
        "background-size: 16px 16px; background-position: 0 0, 8px 8px; }";
    GtkCssProvider *provider = gtk_css_provider_new();
    gtk_css_provider_load_from_data(provider, css, -1);
    gtk_style_context_add_provider_for_display(gdk_display_get_default(), GTK_STYLE_PROVIDER(provider),
                                               GTK_STYLE_PROVIDER_PRIORITY_APPLICATION);
    g_object_unref(provider);
}

GtkWidget *export_preview_new(void)
{
    preview *p = g_new0(preview, 1);
    add_style();
    p->picture = gtk_picture_new();
    gtk_picture_set_can_shrink(GTK_PICTURE(p->picture), TRUE);
    gtk_widget_set_halign(p->picture, GTK_ALIGN_CENTER);
    gtk_widget_set_valign(p->picture, GTK_ALIGN_CENTER);
    gtk_widget_add_css_class(p->picture, "export-preview");
    gtk_accessible_update_property(GTK_ACCESSIBLE(p->picture), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Preview"), -1);
    g_object_set_data_full(G_OBJECT(p->picture), "preview", p, preview_free);
    return p->picture;
}
