#include "cube.h"

#include <math.h>

#include "words.h"

enum { CUBE_SIZE = 92 };
/* Of the way from the middle to the rim of a face: beyond it a click means the edge or corner. */
static const double RIM = 0.55;

typedef struct cube {
    document  *document;
    GtkWidget *area;
} cube;

/* In axes with Y up: x to the right, z to the front. */
static const struct {
    const char *name;
    double      normal[3];
} faces[] = {{N_("Front"), {0, 0, 1}}, {N_("Back"), {0, 0, -1}}, {N_("Right"), {1, 0, 0}},
             {N_("Left"), {-1, 0, 0}}, {N_("Top"), {0, 1, 0}},   {N_("Bottom"), {0, -1, 0}}};

/* The cube always stands with Y up: its camera has the same angles, whatever the scene's axis. */
static orbit camera_of(const cube *c)
{
    orbit o = document_state(c->document)->view;
    o.up = 'y';
    o.orthographic = true;
    o.fov_deg = 30;
    o.target[0] = o.target[1] = o.target[2] = 0;
    o.distance = 2.0 / tan(15 * G_PI / 180); /* two units to the rim: the cube's corners are 1.73 away */
    return o;
}

/* Two axes in the face's plane. */
static void plane_of(const double n[3], double u[3], double v[3])
{
    for (int k = 0; k < 3; k++) {
        u[k] = n[1] != 0 ? k == 0 : k == 0 ? n[2] : k == 2 ? -n[0] : 0;
        v[k] = n[1] != 0 ? (k == 2 ? -n[1] : 0) : k == 1;
    }
}

static void corner(const double n[3], double across, double up, double out[3])
{
    double u[3], v[3];
    plane_of(n, u, v);
    for (int k = 0; k < 3; k++)
        out[k] = n[k] + across * u[k] + up * v[k];
}

static bool faces_viewer(const orbit *o, const double n[3])
{
    double right[3], up[3], forward[3];
    orbit_axes(o, right, up, forward);
    return n[0] * forward[0] + n[1] * forward[1] + n[2] * forward[2] < -0.01;
}

static void draw_face(cairo_t *cr, const orbit *o, size_t index, int size, PangoLayout *text)
{
    static const double turn[4][2] = {{-1, -1}, {1, -1}, {1, 1}, {-1, 1}};
    double              p[3], at[2], u[2], v[2], middle[2], right[3], up[3], forward[3];
    const double       *n = faces[index].normal;
    orbit_axes(o, right, up, forward);
    double light = 0.78 + 0.18 * fmax(0, -(n[0] * forward[0] + n[1] * forward[1] + n[2] * forward[2]));
    for (int i = 0; i < 4; i++) {
        corner(n, turn[i][0], turn[i][1], p);
        orbit_project(o, p, size, size, at);
        (i ? cairo_line_to : cairo_move_to)(cr, at[0], at[1]);
    }
    cairo_close_path(cr);
    cairo_set_source_rgba(cr, light, light, light, 0.92);
    cairo_fill_preserve(cr);
    cairo_set_source_rgba(cr, 0.15, 0.15, 0.18, 0.9);
    cairo_set_line_width(cr, 1.2);
    cairo_stroke(cr);
    /* The name lies in the face's plane. */
    orbit_project(o, n, size, size, middle);
    corner(n, 1, 0, p);
    orbit_project(o, p, size, size, u);
    corner(n, 0, 1, p);
    orbit_project(o, p, size, size, v);
    cairo_matrix_t m = {(u[0] - middle[0]) / 23,
                        (u[1] - middle[1]) / 23,
                        -(v[0] - middle[0]) / 23,
                        -(v[1] - middle[1]) / 23,
                        middle[0],
                        middle[1]};
    if (fabs(m.xx * m.yy - m.xy * m.yx) < 0.05)
        return;
    int width, height;
    pango_layout_set_text(text, _(faces[index].name), -1);
    pango_layout_get_pixel_size(text, &width, &height);
    cairo_save(cr);
    cairo_transform(cr, &m);
    double scale = fmin(0.95, 40.0 / width);
    cairo_scale(cr, scale, scale);
    cairo_move_to(cr, -width / 2.0, -height / 2.0);
    cairo_set_source_rgba(cr, 0.1, 0.1, 0.14, 1);
    pango_cairo_show_layout(cr, text);
    cairo_restore(cr);
}

static void draw_cube(GtkDrawingArea *area, cairo_t *cr, int width, int height, gpointer user)
{
    orbit        o = camera_of(user);
    PangoLayout *text = gtk_widget_create_pango_layout(GTK_WIDGET(area), NULL);
    for (size_t i = 0; i < G_N_ELEMENTS(faces); i++)
        if (faces_viewer(&o, faces[i].normal))
            draw_face(cr, &o, i, MIN(width, height), text);
    g_object_unref(text);
}

/* The direction that a click means: a face's normal, that of an edge or of a corner. */
static bool direction_at(const orbit *o, double x, double y, double out[3])
{
    double origin[3], ray[3];
    orbit_ray(o, x, y, CUBE_SIZE, CUBE_SIZE, origin, ray);
    for (size_t i = 0; i < G_N_ELEMENTS(faces); i++) {
        const double *n = faces[i].normal;
        double        along = n[0] * ray[0] + n[1] * ray[1] + n[2] * ray[2];
        if (along > -0.01)
            continue;
        double t = (1 - (n[0] * origin[0] + n[1] * origin[1] + n[2] * origin[2])) / along;
        bool   inside = true;
        for (int k = 0; k < 3; k++) {
            double at = origin[k] + t * ray[k];
            inside = inside && fabs(at) < 1.02;
            out[k] = fabs(at) > RIM ? copysign(1, at) : 0;
        }
        if (inside)
            return true;
    }
    return false;
}

static void cube_clicked(GtkGestureClick *click, int presses, double x, double y, gpointer user)
{
    (void)click;
    (void)presses;
    cube  *c = user;
    orbit  o = camera_of(c), view = document_state(c->document)->view;
    double d[3], scale = (double)gtk_widget_get_width(c->area) / CUBE_SIZE;
    if (scale <= 0 || !direction_at(&o, x / scale, y / scale, d))
        return;
    view.pitch = atan2(d[1], hypot(d[0], d[2]));
    if (d[0] != 0 || d[2] != 0)
        view.yaw = atan2(d[0], d[2]);
    document_end_step(c->document);
    document_set_view(c->document, &view, "View");
}

static void document_changed(document *d, unsigned changes, void *user)
{
    (void)d;
    cube *c = user;
    if (changes & (DOCUMENT_VIEW | DOCUMENT_SCENE))
        gtk_widget_queue_draw(c->area);
}

GtkWidget *cube_new(document *d)
{
    cube *c = g_new0(cube, 1);
    c->document = d;
    c->area = gtk_drawing_area_new();
    gtk_drawing_area_set_content_width(GTK_DRAWING_AREA(c->area), CUBE_SIZE);
    gtk_drawing_area_set_content_height(GTK_DRAWING_AREA(c->area), CUBE_SIZE);
    gtk_drawing_area_set_draw_func(GTK_DRAWING_AREA(c->area), draw_cube, c, NULL);
    gtk_widget_set_halign(c->area, GTK_ALIGN_END);
    gtk_widget_set_valign(c->area, GTK_ALIGN_START);
    gtk_widget_set_margin_top(c->area, 6);
    gtk_widget_set_margin_end(c->area, 6);
    gtk_widget_set_tooltip_text(c->area, _("Click a face, edge or corner to look from there"));
    gtk_accessible_update_property(GTK_ACCESSIBLE(c->area), GTK_ACCESSIBLE_PROPERTY_LABEL, _("View cube"), -1);
    GtkGesture *click = gtk_gesture_click_new();
    g_signal_connect(click, "released", G_CALLBACK(cube_clicked), c);
    gtk_widget_add_controller(c->area, GTK_EVENT_CONTROLLER(click));
    g_object_set_data_full(G_OBJECT(c->area), "cube", c, g_free);
    document_listen(d, document_changed, c);
    return c->area;
}
