#include "picture_out.h"

#include <math.h>

#include "artist.h"
#include "aside.h"
#include "export_work.h"
#include "trace.h"
#include "words.h"

/* --- to the clipboard ------------------------------------------------------------------------------------ */

enum { SLOT_COPY = 901, COPY_SAMPLES = 4, PRINT_DPI = 300, SIDE_MOST = 16384 };

typedef struct copy_job {
    artist_job   job;
    ViewWindow  *window; /* held */
    scene_ref   *scene;
    view_state  *state;
    int          width, height;
    lmn_drawing *drawing;
} copy_job;

static lmn_status draw_copy(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    copy_job     *j = (copy_job *)base;
    lmn_draw_desc desc;
    char         *selector = state_selector(j->state, j->scene);
    state_describe(j->state, j->scene, selector, j->width, j->height, &desc);
    desc.samples = COPY_SAMPLES;
    desc.lenient = true;
    desc.progress = artist_goes_on;
    desc.progress_user = base;
    const lmn_look *look;
    lmn_look       *own;
    lmn_status      status = scene_ref_prepare(j->scene, j->state, &desc, &look, &own, error);
    if (status == LMN_OK)
        status = lmn_draw(&j->drawing, renderer, j->scene->scene, look, &desc, error);
    lmn_look_destroy(&own);
    g_free(selector);
    return status;
}

static void copied(artist_job *base, lmn_status status, const lmn_error *error)
{
    copy_job *j = (copy_job *)base;
    int       width, height;
    if (!view_window_document(j->window))
        return;
    if (status != LMN_OK) {
        view_window_say_error(j->window, error);
        return;
    }
    const uint8_t *pixels = lmn_drawing_pixels(j->drawing, &width, &height);
    GBytes        *bytes = g_bytes_new(pixels, (gsize)width * (gsize)height * 4);
    GdkTexture    *texture = gdk_memory_texture_new(width, height, GDK_MEMORY_R8G8B8A8, bytes, (gsize)width * 4);
    gdk_clipboard_set_texture(gtk_widget_get_clipboard(GTK_WIDGET(j->window)), texture);
    view_window_say(j->window, _("Picture copied"));
    trace_event("copied-picture width=%d height=%d", width, height);
    g_object_unref(texture);
    g_bytes_unref(bytes);
}

static void release_copy(artist_job *base)
{
    copy_job *j = (copy_job *)base;
    lmn_drawing_destroy(&j->drawing);
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_object_unref(j->window);
    g_free(j);
}

void picture_out_copy(ViewWindow *w)
{
    document        *d = view_window_document(w);
    const scene_ref *scene = document_scene(d);
    if (!scene)
        return;
    copy_job *j = g_new0(copy_job, 1);
    j->job = (artist_job){ARTIST_ASK, SLOT_COPY, draw_copy, copied, release_copy};
    j->window = g_object_ref(w);
    j->scene = scene_ref_take((scene_ref *)scene);
    j->state = state_copy(document_state(d));
    view_window_picture_size(w, &j->width, &j->height);
    artist_ask(view_window_artist(w), &j->job);
}

/* --- onto paper ------------------------------------------------------------------------------------------ */

/* A page that is drawn; it lasts as long as the printing. */
typedef struct page {
    ViewWindow        *window; /* held */
    GtkPrintOperation *printing;
    GtkPrintContext   *context; /* held */
    scene_ref         *scene;   /* what was shown when printing was asked for */
    view_state        *state;
    double             shown; /* its width : height in the window */
    export_wish        wish;
    lmn_drawing       *drawing;
    aside             *work; /* NULL: none */
} page;

static lmn_status draw_page(const scene_ref *scene, const view_state *state, lmn_renderer *renderer,
                            lmn_progress_fn progress, void *progress_user, void *user, lmn_error *error)
{
    page *p = user;
    return export_picture(&p->drawing, scene, state, p->wish, renderer, progress, progress_user, error);
}

/* Cairo's numbers: blue, green, red, alpha on this side of the world, multiplied by alpha. */
static cairo_surface_t *surface_of(const lmn_drawing *drawing)
{
    int              width, height;
    const uint8_t   *from = lmn_drawing_pixels(drawing, &width, &height);
    cairo_surface_t *out = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, width, height);
    if (cairo_surface_status(out) != CAIRO_STATUS_SUCCESS)
        return out;
    uint8_t *to = cairo_image_surface_get_data(out);
    gsize    stride = (gsize)cairo_image_surface_get_stride(out);
    for (int y = 0; y < height; y++) {
        guint32 *row = (guint32 *)(void *)(to + (gsize)y * stride);
        for (int x = 0; x < width; x++, from += 4) {
            guint32 a = from[3], c[3];
            for (int k = 0; k < 3; k++)
                c[k] = (from[k] * a + 127) / 255;
            row[x] = a << 24 | c[0] << 16 | c[1] << 8 | c[2];
        }
    }
    cairo_surface_mark_dirty(out);
    return out;
}

static void paint_page(page *p)
{
    cairo_t         *cairo = gtk_print_context_get_cairo_context(p->context);
    cairo_surface_t *surface = surface_of(p->drawing);
    double           by = 72.0 / p->wish.dpi;
    cairo_scale(cairo, by, by);
    cairo_set_source_surface(cairo, surface, 0, 0);
    cairo_paint(cairo);
    cairo_surface_destroy(surface);
}

static void page_drawn(lmn_status status, const lmn_error *error, void *user)
{
    page *p = user;
    p->work = NULL;
    if (status == LMN_OK) {
        paint_page(p);
        trace_event("printed width=%d height=%d", p->wish.width, p->wish.height);
    } else {
        if (status != LMN_CANCELLED && view_window_document(p->window))
            view_window_say_error(p->window, error);
        trace_event("not-printed %s", error->message);
        gtk_print_operation_cancel(p->printing);
    }
    lmn_drawing_destroy(&p->drawing);
    g_clear_object(&p->context);
    GtkPrintOperation *printing = g_object_ref(p->printing); /* the page goes with the end of it */
    gtk_print_operation_draw_page_finish(printing);
    g_object_unref(printing);
}

static void begin_page(GtkPrintOperation *printing, GtkPrintContext *context, int number, gpointer user)
{
    (void)number;
    page  *p = user;
    double width = gtk_print_context_get_width(context), height = gtk_print_context_get_height(context);
    double dpi = fmin(PRINT_DPI, SIDE_MOST * 72 / fmax(width, height));
    p->wish = (export_wish){.width = MAX(1, (int)floor(width / 72 * dpi)),
                            .height = MAX(1, (int)floor(height / 72 * dpi)),
                            .dpi = dpi,
                            .shown = p->shown};
    p->context = g_object_ref(context);
    gtk_print_operation_set_defer_drawing(printing);
    p->work =
        aside_begin(&(aside_desc){view_window_artist(p->window), p->scene, p->state, draw_page, NULL, page_drawn, p});
}

static void ended(GtkPrintOperation *printing, GtkPrintOperationResult result, gpointer user)
{
    page *p = user;
    if (result == GTK_PRINT_OPERATION_RESULT_ERROR && view_window_document(p->window)) {
        GError *wrong = NULL;
        gtk_print_operation_get_error(printing, &wrong);
        view_window_say(p->window, wrong ? wrong->message : _("Printing failed"));
        g_clear_error(&wrong);
    }
    g_application_release(g_application_get_default());
}

static void page_free(gpointer data, GClosure *closure)
{
    (void)closure;
    page *p = data;
    scene_ref_drop(p->scene);
    state_free(p->state);
    g_clear_object(&p->context);
    g_object_unref(p->window);
    g_free(p);
}

void picture_out_print(ViewWindow *w)
{
    document        *d = view_window_document(w);
    const scene_ref *scene = document_scene(d);
    int              width, height;
    if (!scene)
        return;
    page              *p = g_new0(page, 1);
    GtkPrintOperation *printing = gtk_print_operation_new();
    GtkPageSetup      *setup = gtk_page_setup_new();
    view_window_picture_size(w, &width, &height);
    gtk_page_setup_set_orientation(setup,
                                   width > height ? GTK_PAGE_ORIENTATION_LANDSCAPE : GTK_PAGE_ORIENTATION_PORTRAIT);
    p->window = g_object_ref(w);
    p->printing = printing;
    p->shown = (double)width / height;
    p->scene = scene_ref_take((scene_ref *)scene);
    p->state = state_copy(document_state(d));
    gtk_print_operation_set_default_page_setup(printing, setup);
    gtk_print_operation_set_embed_page_setup(printing, TRUE);
    gtk_print_operation_set_n_pages(printing, 1);
    gtk_print_operation_set_unit(printing, GTK_UNIT_POINTS);
    gtk_print_operation_set_allow_async(printing, TRUE);
    gtk_print_operation_set_job_name(printing, gtk_window_get_title(GTK_WINDOW(w)));
    g_signal_connect(printing, "draw-page", G_CALLBACK(begin_page), p);
    g_signal_connect_data(printing, "done", G_CALLBACK(ended), p, page_free, 0);
    g_application_hold(g_application_get_default()); /* until it is printed, also without the window */
    gtk_print_operation_run(printing, GTK_PRINT_OPERATION_ACTION_PRINT_DIALOG, GTK_WINDOW(w), NULL);
    g_object_unref(setup);
    g_object_unref(printing);
}
