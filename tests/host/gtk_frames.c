/* The frames in a GtkGLArea: a context that GTK shares with its own, and a framebuffer that is not the window's. */
#include <gtk/gtk.h>
#include <stdio.h>

#include "frames.h"

typedef struct window {
    frames     frames;
    int        done;
    bool       open, failed;
    GMainLoop *loop;
} window;

static gboolean render(GtkGLArea *area, GdkGLContext *context, gpointer user)
{
    window *w = user;
    GLint   framebuffer;
    (void)context;
    gtk_gl_area_attach_buffers(area);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &framebuffer);
    if (!w->open)
        frames_open(&w->frames);
    w->open = true;
    frames_step(&w->frames, (GLuint)framebuffer, w->done++);
    state_calm(); /* GTK leaves it as it is for the next frame */
    glBindFramebuffer(GL_FRAMEBUFFER, (GLuint)framebuffer);
    return TRUE;
}

static gboolean next(GtkWidget *area, GdkFrameClock *clock, gpointer user)
{
    window *w = user;
    (void)clock;
    if (gtk_gl_area_get_error(GTK_GL_AREA(area))) {
        printf("%s\n", gtk_gl_area_get_error(GTK_GL_AREA(area))->message);
        w->failed = true;
    }
    if (w->failed || w->done >= frames_wanted())
        g_main_loop_quit(w->loop);
    gtk_gl_area_queue_render(GTK_GL_AREA(area));
    return G_SOURCE_CONTINUE;
}

/* While the context still is there. */
static void unrealize(GtkGLArea *area, gpointer user)
{
    window *w = user;
    gtk_gl_area_make_current(area);
    if (w->open)
        frames_close(&w->frames);
    w->open = false;
}

int main(void)
{
    static window w;
    if (!gtk_init_check())
        return 1;
    w.loop = g_main_loop_new(NULL, FALSE);
    GtkWidget *top = gtk_window_new(), *area = gtk_gl_area_new();
    gtk_gl_area_set_has_depth_buffer(GTK_GL_AREA(area), TRUE);
    gtk_gl_area_set_has_stencil_buffer(GTK_GL_AREA(area), TRUE);
    gtk_gl_area_set_required_version(GTK_GL_AREA(area), 3, 3);
    gtk_widget_set_size_request(area, FRAME_WIDTH, FRAME_HEIGHT);
    gtk_window_set_child(GTK_WINDOW(top), area);
    g_signal_connect(area, "render", G_CALLBACK(render), &w);
    g_signal_connect(area, "unrealize", G_CALLBACK(unrealize), &w);
    gtk_widget_add_tick_callback(area, next, &w, NULL);
    gtk_window_present(GTK_WINDOW(top));
    g_main_loop_run(w.loop);
    gtk_window_destroy(GTK_WINDOW(top));
    while (g_main_context_iteration(NULL, FALSE)) {
    }
    g_main_loop_unref(w.loop);
    must_be(!w.open && !w.failed, "the area is gone with its renderer");
    printf("%d frames\n", w.done);
    return w.done < frames_wanted();
}
