#include "handles.h"

#include <math.h>
#include <string.h>

#include "trace.h"
#include "words.h"

enum { HANDLES_MAX = SECTION_HANDLES + 6, RADIUS = 9, ARM = 64, RING = 48, RING_POINTS = 16 };

static orbit view_of(const handles *h)
{
    return document_state(h->document)->view;
}

/* --- where they are --------------------------------------------------------------------------------------- */

/* Where a point beside another one is on the picture, and the pixels per unit of that way; false when it cannot be
 * told. `by` should be short. */
static bool project_step(const orbit *o, const double from[3], const double way[3], double by, int width, int height,
                         double at[2], double step[2])
{
    double beside[3], there[2];
    for (int k = 0; k < 3; k++)
        beside[k] = from[k] + way[k] * by;
    if (!orbit_project(o, from, width, height, at) || !orbit_project(o, beside, width, height, there))
        return false;
    for (int i = 0; i < 2; i++)
        step[i] = (there[i] - at[i]) / by;
    return true;
}

static int move_handles(const orbit *o, const double middle[3], int width, int height, handle out[3])
{
    int count = 0;
    for (int k = 0; k < 3; k++) {
        handle h = {HANDLE_MOVE, {.axis = k}};
        double way[3] = {k == 0, k == 1, k == 2}, at[2];
        if (!project_step(o, middle, way, o->distance / 100, width, height, at, h.place.step))
            continue;
        double length = hypot(h.place.step[0], h.place.step[1]);
        for (int i = 0; i < 2; i++)
            h.place.at[i] = at[i] + (length > 0 ? h.place.step[i] / length * ARM : 0);
        out[count++] = h;
    }
    return count;
}

/* The radius in space of rings that look RING pixels large; 0: it cannot be told. */
static double ring_radius(const orbit *o, const double middle[3], int width, int height)
{
    double right[3], up[3], forward[3], at[2], step[2];
    orbit_axes(o, right, up, forward);
    if (!project_step(o, middle, right, o->distance / 100, width, height, at, step))
        return 0;
    double length = hypot(step[0], step[1]);
    return length > 0 ? RING / length : 0;
}

/* A point of the ring around an axis: at 0 on the next axis, at π / 2 on the one after it. */
static void ring_point(const double middle[3], int axis, double radius, double angle, double out[3])
{
    memcpy(out, middle, 3 * sizeof *out);
    out[(axis + 1) % 3] += radius * cos(angle);
    out[(axis + 2) % 3] += radius * sin(angle);
}

/* In the middle of each ring's quarter. What is turned away so far that it cannot be dragged is left out. */
static int turn_handles(const orbit *o, const double middle[3], int width, int height, handle out[3])
{
    enum { LEAST_STEP = 12 };
    double radius = ring_radius(o, middle, width, height);
    int    count = 0;
    for (int k = 0; k < 3 && radius > 0; k++) {
        handle h = {HANDLE_TURN, {.axis = k}};
        double from[3], way[3] = {0, 0, 0};
        ring_point(middle, k, radius, G_PI_4, from);
        way[(k + 1) % 3] = -radius * G_SQRT2 / 2;
        way[(k + 2) % 3] = radius * G_SQRT2 / 2;
        if (project_step(o, from, way, 0.05, width, height, h.place.at, h.place.step) &&
            hypot(h.place.step[0], h.place.step[1]) >= LEAST_STEP)
            out[count++] = h;
    }
    return count;
}

static int find_handles(const handles *h, int width, int height, handle out[HANDLES_MAX])
{
    const scene_ref   *scene = document_scene(h->document);
    const node_handle *node = document_handle(h->document);
    section_handle     places[SECTION_HANDLES];
    double             box_min[3], box_max[3];
    int                count = 0;
    if (!scene || width <= 0 || height <= 0)
        return 0;
    orbit o = view_of(h);
    if (h->section.kind != SECTION_NONE) {
        state_bounds(document_state(h->document), scene, box_min, box_max);
        count = section_handles(&h->section, box_min, box_max, &o, width, height, places);
        for (int i = 0; i < count; i++)
            out[i] = (handle){HANDLE_SECTION, places[i]};
    }
    if (node->edit.node && !node->edit.hidden) {
        count += turn_handles(&o, node->at, width, height, out + count);
        count += move_handles(&o, node->at, width, height, out + count);
    }
    return count;
}

/* What lies above is found first. */
static handle handle_at(const handles *h, double x, double y, int width, int height)
{
    handle all[HANDLES_MAX];
    int    count = find_handles(h, width, height, all);
    while (count-- > 0)
        if (hypot(all[count].place.at[0] - x, all[count].place.at[1] - y) <= RADIUS + 3)
            return all[count];
    return (handle){HANDLE_NONE};
}

bool handles_is_at(const handles *h, double x, double y, int width, int height)
{
    return handle_at(h, x, y, width, height).kind != HANDLE_NONE;
}

/* --- dragging --------------------------------------------------------------------------------------------- */

bool handles_take(handles *h, double x, double y, int width, int height)
{
    h->held = handle_at(h, x, y, width, height);
    h->section_begin = h->section;
    h->node_begin = *document_handle(h->document);
    return h->held.kind != HANDLE_NONE;
}

static void drag_section(handles *h, double dx, double dy)
{
    section   s = h->section;
    char      text[SECTION_TEXT_MAX];
    lmn_error error = {0};
    section_drag(&s, &h->held.place, &h->section_begin, dx, dy);
    section_write(&s, text);
    lmn_look *look = document_copy_look(h->document, &error);
    if (look && lmn_look_set(look, "scene.cut", text, &error) == LMN_OK)
        document_put_look(h->document, look, _("Section"));
    else
        lmn_look_destroy(&look);
}

static void drag_node(handles *h, double amount, bool steps)
{
    const node_handle *begin = &h->node_begin;
    solid_edit         edit = begin->edit;
    if (h->held.kind == HANDLE_MOVE) {
        double shift[3] = {0, 0, 0};
        shift[h->held.place.axis] = amount;
        solid_shift(begin->edit.matrix, begin->above, shift, edit.matrix);
    } else {
        const double step = G_PI / 12;
        double       angle = steps ? round(amount / step) * step : amount;
        solid_turn(begin->edit.matrix, begin->above, begin->at, h->held.place.axis, angle, edit.matrix);
    }
    document_edit_solid(h->document, &edit, h->held.kind == HANDLE_MOVE ? _("Move solid") : _("Turn solid"));
}

void handles_drag(handles *h, double dx, double dy, bool steps)
{
    const double *step = h->held.place.step;
    double        squared = step[0] * step[0] + step[1] * step[1];
    if (h->held.kind == HANDLE_SECTION)
        drag_section(h, dx, dy);
    else if (h->held.kind != HANDLE_NONE && squared > 0)
        drag_node(h, (dx * step[0] + dy * step[1]) / squared, steps);
}

void handles_read_look(handles *h)
{
    char      text[LMN_VALUE_TEXT_MAX] = "";
    lmn_error error = {0};
    lmn_look_get_text(document_state(h->document)->look->look, LMN_WHOLE_LOOK, "scene", 0, "cut", text, sizeof text,
                      &error);
    h->section = section_parse(text);
}

/* --- on the picture --------------------------------------------------------------------------------------- */

static void trace_ring(cairo_t *cr, const orbit *o, const double middle[3], int axis, int width, int height)
{
    double radius = ring_radius(o, middle, width, height), point[3], at[2];
    cairo_new_sub_path(cr);
    for (int i = 0; i <= RING_POINTS; i++) {
        ring_point(middle, axis, radius, G_PI_2 * i / RING_POINTS, point);
        if (orbit_project(o, point, width, height, at))
            cairo_line_to(cr, at[0], at[1]);
    }
}

/* From the node's middle to where it is moved, and the quarters on which it is turned. */
static void snapshot_lines(const handles *h, GtkSnapshot *snapshot, const handle *all, int count, int width, int height)
{
    orbit         o = view_of(h);
    const double *middle = document_handle(h->document)->at;
    double        at[2];
    if (!orbit_project(&o, middle, width, height, at))
        return;
    cairo_t *cr = gtk_snapshot_append_cairo(snapshot, &GRAPHENE_RECT_INIT(0, 0, (float)width, (float)height));
    for (int round = 0; round < 2; round++) {
        cairo_set_line_width(cr, round ? 2 : 4);
        cairo_set_source_rgba(cr, round ? 0.2 : 1, round ? 0.2 : 1, round ? 0.2 : 1, 0.9);
        for (int i = 0; i < count; i++) {
            if (all[i].kind == HANDLE_TURN)
                trace_ring(cr, &o, middle, all[i].place.axis, width, height);
            if (all[i].kind != HANDLE_MOVE)
                continue;
            cairo_move_to(cr, at[0], at[1]);
            cairo_line_to(cr, all[i].place.at[0], all[i].place.at[1]);
        }
        cairo_stroke(cr);
    }
    cairo_destroy(cr);
}

/* Squares move a node, discs turn it or move the section. */
static void snapshot_handle(const handle *h, GtkSnapshot *snapshot)
{
    static const GdkRGBA colours[3] = {{0.85f, 0.2f, 0.2f, 1}, {0.15f, 0.6f, 0.2f, 1}, {0.15f, 0.4f, 0.9f, 1}};
    const GdkRGBA        white = {1, 1, 1, 1}, rims[4] = {white, white, white, white};
    const float          widths[4] = {2, 2, 2, 2}, r = h->kind == HANDLE_TURN ? RADIUS - 2 : RADIUS;
    graphene_rect_t      box = GRAPHENE_RECT_INIT((float)h->place.at[0] - r, (float)h->place.at[1] - r, 2 * r, 2 * r);
    GskRoundedRect       round;
    gsk_rounded_rect_init_from_rect(&round, &box, h->kind == HANDLE_MOVE ? 3 : r);
    gtk_snapshot_push_rounded_clip(snapshot, &round);
    gtk_snapshot_append_color(snapshot, &colours[h->place.axis], &box);
    gtk_snapshot_pop(snapshot);
    gtk_snapshot_append_border(snapshot, &round, widths, rims);
    trace_event("handle kind=%d axis=%d x=%.0f y=%.0f", h->kind, h->place.axis, h->place.at[0], h->place.at[1]);
}

void handles_snapshot(const handles *h, GtkSnapshot *snapshot, int width, int height)
{
    handle all[HANDLES_MAX];
    int    count = h->document ? find_handles(h, width, height, all) : 0;
    if (count && all[count - 1].kind == HANDLE_MOVE)
        snapshot_lines(h, snapshot, all, count, width, height);
    for (int i = 0; i < count; i++)
        snapshot_handle(&all[i], snapshot);
}
