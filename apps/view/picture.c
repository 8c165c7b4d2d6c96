#include "picture.h"

#include <math.h>
#include <string.h>

#include "handles.h"
#include "pace.h"
#include "part_look.h"
#include "picking.h"
#include "trace.h"
#include "words.h"

enum { SLOT_VIEW = 1, SLOT_COMPARED, SLOT_PICK };
enum { REST_MS = 150, COMPARE_HANDLE = 8, CLICK_SLACK = 4 };
/* Samples of the last picture, when nothing moves. */
enum { REST_SAMPLES = 4 };

/* One of the two drawings that a picture shows. */
typedef struct shown {
    GdkTexture *texture; /* NULL: none yet */
    bool        whole;   /* as good as it becomes, of the state as it is */
} shown;

struct _Picture {
    GtkWidget widget;
    document *document; /* NULL after picture_close */
    artist   *artist;
    shown     now, compared;
    look_ref *other;   /* on the left of the divider; NULL: no comparison */
    double    divider; /* 0 … 1 */
    bool      divider_held;
    handles   handles;
    pace      pace;
    guint     rest; /* the timer until the whole picture */
    double    last_x, last_y, hover_x, hover_y;
    bool      pans;  /* the drag moves instead of turning */
    bool      moved; /* by this drag: its end is no click */
    bool      walking;
    gint64    input_at; /* of the oldest input that no picture shows yet; 0: none */
    uint64_t  revision;
    int       width, height; /* when it was told last */
    gint64    moved_at;      /* when the last picture of something moving came */
    double    per_second;    /* such pictures, smoothed; 0: nothing moves */
};
G_DEFINE_TYPE(Picture, picture, GTK_TYPE_WIDGET)

enum { SIGNAL_STATUS, SIGNAL_MENU, SIGNAL_RESIZED, SIGNALS };
static guint signals[SIGNALS];

/* --- jobs ------------------------------------------------------------------------------------------------ */

typedef struct view_job {
    artist_job   job;
    Picture     *picture; /* held */
    scene_ref   *scene;
    view_state  *state;
    int          width, height, samples;
    bool         whole;
    bool         compared;
    gint64       input_at;
    uint64_t     revision;
    double       ms;
    lmn_drawing *drawing;
} view_job;

static lmn_status draw_view(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    view_job     *j = (view_job *)base;
    lmn_draw_desc desc;
    char         *selector = state_selector(j->state, j->scene);
    state_describe(j->state, j->scene, selector, j->width, j->height, &desc);
    desc.samples = j->samples;
    desc.draft = j->job.urgency == ARTIST_MOVING;
    desc.lenient = true;
    desc.progress = artist_goes_on;
    desc.progress_user = base;
    const lmn_look *look;
    lmn_look       *own;
    gint64          from = g_get_monotonic_time();
    lmn_status      status = scene_ref_prepare(j->scene, j->state, &desc, &look, &own, error);
    if (status == LMN_OK)
        status = lmn_draw(&j->drawing, renderer, j->scene->scene, look, &desc, error);
    lmn_look_destroy(&own);
    j->ms = (double)(g_get_monotonic_time() - from) / 1e3;
    g_free(selector);
    return status;
}

static void drawing_free(void *data)
{
    lmn_drawing *drawing = data;
    lmn_drawing_destroy(&drawing);
}

/* The texture owns the drawing whose pixels it shows. */
static GdkTexture *texture_of(view_job *j)
{
    int            width, height;
    const uint8_t *pixels = lmn_drawing_pixels(j->drawing, &width, &height);
    GBytes *bytes = g_bytes_new_with_free_func(pixels, (gsize)width * (gsize)height * 4, drawing_free, j->drawing);
    j->drawing = NULL;
    GdkTexture *out = gdk_memory_texture_new(width, height, GDK_MEMORY_R8G8B8A8, bytes, (gsize)width * 4);
    g_bytes_unref(bytes);
    return out;
}

static void say(Picture *p, const char *text)
{
    g_signal_emit(p, signals[SIGNAL_STATUS], 0, text);
}

static void say_failure(Picture *p, const lmn_error *error)
{
    char *text = g_strdup_printf("%s%s%s", error->message, *error->hint ? " – " : "", error->hint);
    say(p, text);
    g_free(text);
    trace_event("failed %s", error->message);
}

static void ask_next(Picture *p, bool compared);

/* Pictures a second while they follow one another. */
static void count_pictures(Picture *p, bool moving)
{
    const double SMOOTH = 0.2;
    gint64       now = g_get_monotonic_time(), by = now - p->moved_at;
    bool         follows = moving && by > 0 && by < G_USEC_PER_SEC / 2;
    double       rate = follows ? G_USEC_PER_SEC / (double)by : 0;
    p->per_second = follows && p->per_second > 0 ? p->per_second + SMOOTH * (rate - p->per_second) : rate;
    p->moved_at = moving ? now : p->moved_at;
}

static char *picture_text(const Picture *p, const view_job *j)
{
    char *size = g_strdup_printf("%d × %d, %.0f ms", j->width, j->height, j->ms);
    if (p->per_second <= 0)
        return size;
    char *out = g_strdup_printf(_("%s, %.0f pictures a second"), size, p->per_second);
    g_free(size);
    return out;
}

static void view_drawn(artist_job *base, lmn_status status, const lmn_error *error)
{
    view_job *j = (view_job *)base;
    Picture  *p = j->picture;
    shown    *s = j->compared ? &p->compared : &p->now;
    if (!p->document || (j->compared && !p->other))
        return;
    if (status != LMN_OK) {
        say_failure(p, error);
        return;
    }
    if (!j->whole && !j->compared)
        pace_told(&p->pace, j->ms);
    if (!j->compared)
        count_pictures(p, !j->whole);
    char *text = picture_text(p, j);
    g_clear_object(&s->texture);
    s->texture = texture_of(j);
    s->whole = j->whole && j->revision == p->revision;
    say(p, text);
    g_free(text);
    trace_event("drawn revision=%llu width=%d height=%d whole=%d compared=%d ms=%.1f latency=%.1f",
                (unsigned long long)j->revision, j->width, j->height, j->whole, j->compared, j->ms,
                j->input_at ? (double)(g_get_monotonic_time() - j->input_at) / 1e3 : 0.0);
    gtk_widget_queue_draw(GTK_WIDGET(p));
    if (j->revision == p->revision && j->whole && j->samples != REST_SAMPLES)
        ask_next(p, j->compared);
}

static void view_release(artist_job *base)
{
    view_job *j = (view_job *)base;
    lmn_drawing_destroy(&j->drawing);
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_object_unref(j->picture);
    g_free(j);
}

document *picture_document(const Picture *p)
{
    return p->document;
}

void picture_size(const Picture *p, int *width, int *height)
{
    GtkWidget *w = GTK_WIDGET((Picture *)p);
    int        scale = gtk_widget_get_scale_factor(w);
    *width = MAX(1, MIN(16384, gtk_widget_get_width(w) * scale));
    *height = MAX(1, MIN(16384, gtk_widget_get_height(w) * scale));
}

static void ask(Picture *p, bool compared, artist_urgency urgency, double scale, int samples)
{
    const scene_ref *scene = document_scene(p->document);
    int              width, height;
    if (!scene || !p->document)
        return;
    picture_size(p, &width, &height);
    view_job *j = g_new0(view_job, 1);
    j->job = (artist_job){urgency, compared ? SLOT_COMPARED : SLOT_VIEW, draw_view, view_drawn, view_release};
    j->picture = g_object_ref(p);
    j->scene = scene_ref_take((scene_ref *)scene);
    j->state = state_copy(document_state(p->document));
    if (compared) {
        look_ref_drop(j->state->look);
        j->state->look = look_ref_take(p->other);
    }
    j->width = MAX(1, (int)lrint(width * scale));
    j->height = MAX(1, (int)lrint(height * scale));
    j->samples = samples;
    j->whole = scale == 1 && urgency == ARTIST_REST;
    j->compared = compared;
    j->revision = p->revision;
    j->input_at = urgency == ARTIST_MOVING ? p->input_at : 0;
    artist_ask(p->artist, &j->job);
}

static void ask_next(Picture *p, bool compared)
{
    ask(p, compared, ARTIST_REST, 1, REST_SAMPLES);
}

static gboolean at_rest(gpointer data)
{
    Picture *p = data;
    p->rest = 0;
    ask(p, false, ARTIST_REST, 1, 1);
    if (p->other)
        ask(p, true, ARTIST_REST, 1, 1);
    return G_SOURCE_REMOVE;
}

/* Something is different: a picture soon, the whole one when nothing has come for a while. */
static void refresh(Picture *p)
{
    if (!p->document || !document_scene(p->document) || !gtk_widget_get_mapped(GTK_WIDGET(p)) ||
        gtk_widget_get_width(GTK_WIDGET(p)) == 0)
        return;
    p->revision++;
    if (!p->input_at)
        p->input_at = g_get_monotonic_time();
    ask(p, false, ARTIST_MOVING, pace_scale(&p->pace), 1);
    if (p->other)
        ask(p, true, ARTIST_MOVING, pace_scale(&p->pace), 1);
    p->input_at = 0;
    g_clear_handle_id(&p->rest, g_source_remove);
    p->rest = g_timeout_add(REST_MS, at_rest, p);
}

static void document_changed(document *d, unsigned changes, void *user)
{
    (void)d;
    Picture *p = user;
    if (changes & DOCUMENT_SELECTED)
        gtk_widget_queue_draw(GTK_WIDGET(p));
    if (changes & DOCUMENT_LOOK) {
        handles_read_look(&p->handles);
        gtk_widget_queue_draw(GTK_WIDGET(p));
    }
    if (changes & DOCUMENT_LOOK)
        p->pace = (pace){p->pace.level, 0, false};
    if (changes & (DOCUMENT_SCENE | DOCUMENT_LOOK | DOCUMENT_VIEW | DOCUMENT_PARTS | DOCUMENT_TIME | DOCUMENT_SOLIDS |
                   DOCUMENT_TOLD))
        refresh(p);
}

static orbit view_of(const Picture *p)
{
    return document_state(p->document)->view;
}

static bool has_view(const Picture *p)
{
    return p->document && document_scene(p->document);
}

static void note_input(Picture *p)
{
    if (!p->input_at)
        p->input_at = g_get_monotonic_time();
}

static bool near_divider(const Picture *p, double x)
{
    return p->other && fabs(x - p->divider * gtk_widget_get_width(GTK_WIDGET(p))) < COMPARE_HANDLE;
}

/* --- pointer --------------------------------------------------------------------------------------------- */

static void drag_begin(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    Picture        *p = user;
    GdkModifierType keys = gtk_event_controller_get_current_event_state(GTK_EVENT_CONTROLLER(gesture));
    guint           button = gtk_gesture_single_get_current_button(GTK_GESTURE_SINGLE(gesture));
    p->pans = button == GDK_BUTTON_MIDDLE || button == GDK_BUTTON_SECONDARY || (keys & GDK_SHIFT_MASK);
    p->handles.held.kind = HANDLE_NONE;
    if (button == GDK_BUTTON_PRIMARY)
        handles_take(&p->handles, x, y, gtk_widget_get_width(GTK_WIDGET(p)), gtk_widget_get_height(GTK_WIDGET(p)));
    p->divider_held = button == GDK_BUTTON_PRIMARY && near_divider(p, x);
    p->last_x = 0;
    p->last_y = 0;
    p->moved = false;
    gtk_widget_grab_focus(GTK_WIDGET(p));
    document_end_step(p->document);
}

static void drag_update(GtkGestureDrag *gesture, double x, double y, gpointer user)
{
    Picture *p = user;
    double   dx = x - p->last_x, dy = y - p->last_y, start_x, start_y;
    int      width = gtk_widget_get_width(GTK_WIDGET(p)), height = MAX(1, gtk_widget_get_height(GTK_WIDGET(p)));
    p->moved = p->moved || fabs(x) + fabs(y) > CLICK_SLACK;
    p->last_x = x;
    p->last_y = y;
    if (!has_view(p) || (dx == 0 && dy == 0))
        return;
    if (p->divider_held && gtk_gesture_drag_get_start_point(gesture, &start_x, &start_y)) {
        p->divider = CLAMP((start_x + x) / MAX(1, width), 0.02, 0.98);
        gtk_widget_queue_draw(GTK_WIDGET(p));
        return;
    }
    note_input(p);
    if (p->handles.held.kind != HANDLE_NONE) {
        GdkModifierType keys = gtk_event_controller_get_current_event_state(GTK_EVENT_CONTROLLER(gesture));
        handles_drag(&p->handles, x, y, keys & GDK_CONTROL_MASK);
        return;
    }
    orbit o = view_of(p);
    if (p->pans)
        orbit_pan(&o, dx, dy, height);
    else if (p->walking)
        orbit_look(&o, dx, dy, height);
    else
        orbit_turn(&o, dx, dy, height);
    document_set_view(p->document, &o, p->pans ? "Move" : "Turn");
}

static void zoom_at(Picture *p, double factor, double x, double y)
{
    if (!has_view(p))
        return;
    note_input(p);
    orbit o = view_of(p);
    orbit_zoom(&o, factor, x, y, MAX(1, gtk_widget_get_width(GTK_WIDGET(p))),
               MAX(1, gtk_widget_get_height(GTK_WIDGET(p))));
    document_set_view(p->document, &o, "Zoom");
}

/* A wheel's notch comes nearer; fingers on a trackpad move with Shift. */
static gboolean scrolled(GtkEventControllerScroll *scroll, double dx, double dy, gpointer user)
{
    Picture        *p = user;
    GdkModifierType keys = gtk_event_controller_get_current_event_state(GTK_EVENT_CONTROLLER(scroll));
    if (keys & GDK_SHIFT_MASK || dx != 0) {
        const double STEP = 24;
        if (!has_view(p))
            return FALSE;
        note_input(p);
        orbit o = view_of(p);
        orbit_pan(&o, -(dx != 0 ? dx : dy) * STEP, dx != 0 ? -dy * STEP : 0,
                  MAX(1, gtk_widget_get_height(GTK_WIDGET(p))));
        document_set_view(p->document, &o, "Move");
    } else {
        zoom_at(p, pow(1.1, dy), p->hover_x, p->hover_y);
    }
    return TRUE;
}

static void hovered(GtkEventControllerMotion *motion, double x, double y, gpointer user)
{
    (void)motion;
    Picture *p = user;
    p->hover_x = x;
    p->hover_y = y;
    int         width = gtk_widget_get_width(GTK_WIDGET(p)), height = gtk_widget_get_height(GTK_WIDGET(p));
    const char *cursor = handles_is_at(&p->handles, x, y, width, height) ? "grab" : NULL;
    gtk_widget_set_cursor_from_name(GTK_WIDGET(p), near_divider(p, x) ? "col-resize" : cursor);
}

static void pinched(GtkGestureZoom *zoom, double scale, gpointer user)
{
    Picture *p = user;
    double   x, y, before = p->last_x > 0 ? p->last_x : 1;
    if (scale <= 0 || !gtk_gesture_get_bounding_box_center(GTK_GESTURE(zoom), &x, &y))
        return;
    zoom_at(p, before / scale, x, y);
    p->last_x = scale;
}

static void pinch_begin(GtkGesture *gesture, GdkEventSequence *sequence, gpointer user)
{
    (void)gesture;
    (void)sequence;
    ((Picture *)user)->last_x = 1;
}

/* --- what is seen at a pixel ------------------------------------------------------------------------------ */

/* Beside all parts a look is that of the whole. */
static void put_look(Picture *p, uint32_t part, look_ref *dropped)
{
    lmn_error error = {0};
    if (!part) {
        document_set_look(p->document, look_ref_take(dropped), _("Look"));
        return;
    }
    lmn_look *look = document_copy_look(p->document, &error);
    document_end_step(p->document);
    if (look && part_look_put(look, part, dropped->look, &error) == LMN_OK) {
        document_put_look(p->document, look, _("Look of a part"));
        trace_event("dropped look=%s part=%u", dropped->origin, part);
    } else {
        lmn_look_destroy(&look);
        say_failure(p, &error);
    }
}

static void centre_on(Picture *p, const double position[3])
{
    orbit o = view_of(p);
    memcpy(o.target, position, sizeof o.target);
    document_set_view(p->document, &o, "Centre");
}

static void picked(GObject *owner, const pick_wish *wish, const lmn_pick *pick)
{
    Picture *p = LIMNER_PICTURE(owner);
    if (!p->document)
        return;
    trace_event("picked part=%u", pick->part);
    if (wish->use == PICK_DROP) {
        put_look(p, pick->part, wish->dropped);
    } else if (wish->use == PICK_CENTRE && pick->part) {
        centre_on(p, pick->position);
    } else {
        document_select(p->document, pick->part);
        if (wish->use == PICK_MENU) {
            double scale = gtk_widget_get_scale_factor(GTK_WIDGET(p));
            g_signal_emit(p, signals[SIGNAL_MENU], 0, wish->x / scale, wish->y / scale, (guint)pick->part);
        }
    }
}

/* Takes `dropped`. */
static void ask_pick(Picture *p, double x, double y, pick_use use, look_ref *dropped)
{
    int       scale = gtk_widget_get_scale_factor(GTK_WIDGET(p));
    pick_wish wish = {.x = (int)(x * scale), .y = (int)(y * scale), .use = use, .dropped = dropped};
    picture_size(p, &wish.width, &wish.height);
    if (has_view(p))
        pick_ask(p->artist, p->document, &wish, SLOT_PICK, G_OBJECT(p), picked);
    else
        look_ref_drop(dropped);
}

static void clicked(GtkGestureClick *click, int presses, double x, double y, gpointer user)
{
    Picture *p = user;
    guint    button = gtk_gesture_single_get_current_button(GTK_GESTURE_SINGLE(click));
    if (p->moved)
        return;
    if (button == GDK_BUTTON_PRIMARY && !near_divider(p, x))
        ask_pick(p, x, y, presses == 2 ? PICK_CENTRE : PICK_SELECT, NULL);
    else if (button == GDK_BUTTON_SECONDARY)
        ask_pick(p, x, y, PICK_MENU, NULL);
}

/* "look:NAME", from the gallery. */
static gboolean look_dropped(GtkDropTarget *target, const GValue *value, double x, double y, gpointer user)
{
    (void)target;
    const char *text = g_value_get_string(value);
    lmn_error   error = {0};
    if (!text || !g_str_has_prefix(text, "look:"))
        return FALSE;
    look_ref *look = look_ref_load(text + strlen("look:"), &error);
    if (look)
        ask_pick(user, x, y, PICK_DROP, look);
    else
        say_failure(user, &error);
    return look != NULL;
}

/* --- keys ------------------------------------------------------------------------------------------------ */

static bool walk_key(Picture *p, guint key, orbit *o)
{
    double step = o->distance * 0.05;
    switch (gdk_keyval_to_lower(key)) {
    case GDK_KEY_w: orbit_walk(o, step, 0, 0); return true;
    case GDK_KEY_s: orbit_walk(o, -step, 0, 0); return true;
    case GDK_KEY_a: orbit_walk(o, 0, -step, 0); return true;
    case GDK_KEY_d: orbit_walk(o, 0, step, 0); return true;
    case GDK_KEY_q: orbit_walk(o, 0, 0, -step); return true;
    case GDK_KEY_e: orbit_walk(o, 0, 0, step); return true;
    default: (void)p; return false;
    }
}

static bool turn_key(guint key, bool moves, orbit *o, int height)
{
    const double STEP = height / 24.0; /* 7.5° */
    double       dx = key == GDK_KEY_Left ? -STEP : key == GDK_KEY_Right ? STEP : 0;
    double       dy = key == GDK_KEY_Up ? -STEP : key == GDK_KEY_Down ? STEP : 0;
    if (dx == 0 && dy == 0)
        return false;
    if (moves)
        orbit_pan(o, dx, dy, height);
    else
        orbit_turn(o, dx, dy, height);
    return true;
}

static gboolean key_pressed(GtkEventControllerKey *keys, guint key, guint code, GdkModifierType state, gpointer user)
{
    (void)keys;
    (void)code;
    Picture *p = user;
    if (!has_view(p) || state & (GDK_CONTROL_MASK | GDK_ALT_MASK))
        return FALSE;
    orbit o = view_of(p);
    int   width = gtk_widget_get_width(GTK_WIDGET(p)), height = MAX(1, gtk_widget_get_height(GTK_WIDGET(p)));
    note_input(p);
    if (turn_key(key, state & GDK_SHIFT_MASK, &o, height) || (p->walking && walk_key(p, key, &o))) {
        document_set_view(p->document, &o, "Turn");
        return TRUE;
    }
    if (key == GDK_KEY_plus || key == GDK_KEY_KP_Add || key == GDK_KEY_minus || key == GDK_KEY_KP_Subtract) {
        bool nearer = key == GDK_KEY_plus || key == GDK_KEY_KP_Add;
        zoom_at(p, nearer ? 1 / 1.2 : 1.2, width / 2.0, height / 2.0);
        return TRUE;
    }
    return FALSE;
}

/* --- the widget ------------------------------------------------------------------------------------------ */

static void snapshot_divider(Picture *p, GtkSnapshot *snapshot, float x, float height)
{
    GdkRGBA     dark = {0, 0, 0, 0.7f}, light = {1, 1, 1, 0.9f};
    const float half = 1;
    (void)p;
    gtk_snapshot_append_color(snapshot, &light, &GRAPHENE_RECT_INIT(x - 2 * half, 0, 4 * half, height));
    gtk_snapshot_append_color(snapshot, &dark, &GRAPHENE_RECT_INIT(x - half, 0, 2 * half, height));
}

static void picture_snapshot(GtkWidget *widget, GtkSnapshot *snapshot)
{
    Picture *p = LIMNER_PICTURE(widget);
    float    width = (float)gtk_widget_get_width(widget), height = (float)gtk_widget_get_height(widget);
    if (p->now.texture)
        gtk_snapshot_append_texture(snapshot, p->now.texture, &GRAPHENE_RECT_INIT(0, 0, width, height));
    handles_snapshot(&p->handles, snapshot, (int)width, (int)height);
    if (!p->other || !p->compared.texture)
        return;
    float x = (float)p->divider * width;
    gtk_snapshot_push_clip(snapshot, &GRAPHENE_RECT_INIT(0, 0, x, height));
    gtk_snapshot_append_texture(snapshot, p->compared.texture, &GRAPHENE_RECT_INIT(0, 0, width, height));
    gtk_snapshot_pop(snapshot);
    snapshot_divider(p, snapshot, x, height);
}

static void picture_size_allocate(GtkWidget *widget, int width, int height, int baseline)
{
    (void)baseline;
    Picture *p = LIMNER_PICTURE(widget);
    if (width != p->width || height != p->height) {
        p->width = width;
        p->height = height;
        g_signal_emit(widget, signals[SIGNAL_RESIZED], 0);
    }
    refresh(p);
}

static void picture_map(GtkWidget *widget)
{
    GTK_WIDGET_CLASS(picture_parent_class)->map(widget);
    refresh(LIMNER_PICTURE(widget));
}

static void picture_measure(GtkWidget *widget, GtkOrientation orientation, int for_size, int *minimum, int *natural,
                            int *minimum_baseline, int *natural_baseline)
{
    (void)widget;
    (void)for_size;
    *minimum = 1;
    *natural = orientation == GTK_ORIENTATION_HORIZONTAL ? 800 : 600;
    *minimum_baseline = *natural_baseline = -1;
}

void picture_compare(Picture *p, look_ref *look)
{
    look_ref_drop(p->other);
    p->other = look;
    g_clear_object(&p->compared.texture);
    if (!look)
        artist_drop(p->artist, SLOT_COMPARED);
    refresh(p);
    gtk_widget_queue_draw(GTK_WIDGET(p));
}

GdkTexture *picture_texture(const Picture *p)
{
    return p->now.texture;
}

void picture_set_walking(Picture *p, bool walking)
{
    p->walking = walking;
}

void picture_close(Picture *p)
{
    g_clear_handle_id(&p->rest, g_source_remove);
    p->document = p->handles.document = NULL;
    p->artist = NULL;
}

static void picture_dispose(GObject *object)
{
    Picture *p = LIMNER_PICTURE(object);
    g_clear_handle_id(&p->rest, g_source_remove);
    g_clear_object(&p->now.texture);
    g_clear_object(&p->compared.texture);
    g_clear_pointer(&p->other, look_ref_drop);
    G_OBJECT_CLASS(picture_parent_class)->dispose(object);
}

static void picture_class_init(PictureClass *class)
{
    GtkWidgetClass *widget = GTK_WIDGET_CLASS(class);
    G_OBJECT_CLASS(class)->dispose = picture_dispose;
    widget->snapshot = picture_snapshot;
    widget->size_allocate = picture_size_allocate;
    widget->map = picture_map;
    widget->measure = picture_measure;
    gtk_widget_class_set_css_name(widget, "picture");
    gtk_widget_class_set_accessible_role(widget, GTK_ACCESSIBLE_ROLE_IMG);
    signals[SIGNAL_STATUS] =
        g_signal_new("status", PICTURE_TYPE, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 1, G_TYPE_STRING);
    signals[SIGNAL_RESIZED] =
        g_signal_new("resized", PICTURE_TYPE, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 0);
    signals[SIGNAL_MENU] = g_signal_new("menu", PICTURE_TYPE, G_SIGNAL_RUN_LAST, 0, NULL, NULL, NULL, G_TYPE_NONE, 3,
                                        G_TYPE_DOUBLE, G_TYPE_DOUBLE, G_TYPE_UINT);
}

static void add_controllers(Picture *p)
{
    GtkGesture         *drag = gtk_gesture_drag_new(), *click = gtk_gesture_click_new(), *zoom = gtk_gesture_zoom_new();
    GtkEventController *scroll = gtk_event_controller_scroll_new(GTK_EVENT_CONTROLLER_SCROLL_BOTH_AXES);
    GtkEventController *motion = gtk_event_controller_motion_new(), *keys = gtk_event_controller_key_new();
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(drag), 0);
    gtk_gesture_single_set_button(GTK_GESTURE_SINGLE(click), 0);
    g_signal_connect(drag, "drag-begin", G_CALLBACK(drag_begin), p);
    g_signal_connect(drag, "drag-update", G_CALLBACK(drag_update), p);
    g_signal_connect(click, "released", G_CALLBACK(clicked), p);
    g_signal_connect(zoom, "begin", G_CALLBACK(pinch_begin), p);
    g_signal_connect(zoom, "scale-changed", G_CALLBACK(pinched), p);
    g_signal_connect(scroll, "scroll", G_CALLBACK(scrolled), p);
    g_signal_connect(motion, "motion", G_CALLBACK(hovered), p);
    g_signal_connect(keys, "key-pressed", G_CALLBACK(key_pressed), p);
    GtkDropTarget *drop = gtk_drop_target_new(G_TYPE_STRING, GDK_ACTION_COPY);
    g_signal_connect(drop, "drop", G_CALLBACK(look_dropped), p);
    gtk_widget_add_controller(GTK_WIDGET(p), GTK_EVENT_CONTROLLER(drop));
    GtkEventController *all[] = {
        GTK_EVENT_CONTROLLER(drag), GTK_EVENT_CONTROLLER(click), GTK_EVENT_CONTROLLER(zoom), scroll, motion, keys};
    for (size_t i = 0; i < G_N_ELEMENTS(all); i++)
        gtk_widget_add_controller(GTK_WIDGET(p), all[i]);
}

static void picture_init(Picture *p)
{
    p->divider = 0.5;
    p->pace.level = 1;
    gtk_widget_set_focusable(GTK_WIDGET(p), TRUE);
    gtk_widget_set_hexpand(GTK_WIDGET(p), TRUE);
    gtk_widget_set_vexpand(GTK_WIDGET(p), TRUE);
    gtk_widget_set_overflow(GTK_WIDGET(p), GTK_OVERFLOW_HIDDEN);
    gtk_accessible_update_property(GTK_ACCESSIBLE(p), GTK_ACCESSIBLE_PROPERTY_LABEL, _("Drawing"), -1);
    add_controllers(p);
}

GtkWidget *picture_new(document *d, artist *a)
{
    Picture *p = g_object_new(PICTURE_TYPE, NULL);
    p->document = p->handles.document = d;
    p->artist = a;
    document_listen(d, document_changed, p);
    return GTK_WIDGET(p);
}
