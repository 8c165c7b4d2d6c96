#include "document.h"

#include "expressions.h"

#include <jansson.h>
#include <math.h>
#include <string.h>

enum { STEPS_MAX = 500 };
/* Changes of one kind within this time are one step. */
static const gint64 STEP_US = 700000;

typedef struct step {
    view_state *state;
    const char *what; /* led to it */
    gint64      at;
} step;

typedef struct listener {
    document_listener call;
    void             *user;
} listener;

struct document {
    scene_ref  *scene;
    GPtrArray  *steps; /* of step */
    guint       now;
    GArray     *listeners;
    uint32_t    selected;
    node_handle handle;
    bool        step_ended;
};

/* --- references ------------------------------------------------------------------------------------------ */

static void scene_clear(void *data)
{
    scene_ref *s = data;
    lmn_scene_destroy(&s->scene);
    g_strfreev(s->paths);
    g_array_unref(s->clips);
    g_strfreev(s->cameras);
    g_array_unref(s->boxes);
    g_clear_pointer(&s->edited, g_array_unref);
    g_clear_pointer(&s->script_told, g_ref_string_release);
    g_clear_pointer(&s->signs, g_free);
    g_mutex_clear(&s->lock);
}

void scene_ref_lock(const scene_ref *s)
{
    g_mutex_lock(&((scene_ref *)s)->lock);
}

void scene_ref_unlock(const scene_ref *s)
{
    g_mutex_unlock(&((scene_ref *)s)->lock);
}

static void clip_clear(void *clip)
{
    g_free(((clip_info *)clip)->name);
}

static void read_lists(scene_ref *s)
{
    char         *text = lmn_scene_info_json(s->scene);
    json_t       *info = text ? json_loads(text, 0, NULL) : NULL;
    GStrvBuilder *cameras = g_strv_builder_new();
    const json_t *entry;
    size_t        i;
    s->clips = g_array_new(FALSE, FALSE, sizeof(clip_info));
    g_array_set_clear_func(s->clips, clip_clear);
    json_array_foreach(json_object_get(info, "animations"), i, entry)
    {
        const char *name = json_string_value(json_object_get(entry, "name"));
        clip_info   clip = {g_strdup(name ? name : ""), json_number_value(json_object_get(entry, "duration"))};
        g_array_append_val(s->clips, clip);
    }
    json_array_foreach(json_object_get(info, "cameras"), i, entry)
    {
        const char *name = json_string_value(json_object_get(entry, "name"));
        if (name)
            g_strv_builder_add(cameras, name);
    }
    s->cameras = g_strv_builder_end(cameras);
    g_strv_builder_unref(cameras);
    json_decref(info);
    lmn_text_free(text);
}

scene_ref *scene_ref_make(lmn_scene *scene, const char *const *paths)
{
    scene_ref *s = g_atomic_rc_box_new0(scene_ref);
    s->scene = scene;
    s->paths = g_strdupv((char **)paths);
    s->info = lmn_scene_info_of(scene);
    g_mutex_init(&s->lock);
    s->script_time = -1;
    for (size_t i = 0; paths[i] && !s->script_told; i++)
        s->script_told = expressions_of_file(paths[i], &s->script_time);
    read_lists(s);
    s->boxes = g_array_new(FALSE, FALSE, sizeof(double[6]));
    lmn_part_info part;
    for (size_t i = 0; lmn_scene_part_at(scene, i, &part); i++) {
        double box[6];
        memcpy(box, part.bounds_min, sizeof part.bounds_min);
        memcpy(box + 3, part.bounds_max, sizeof part.bounds_max);
        g_array_append_val(s->boxes, box);
    }
    return s;
}

lmn_status scene_ref_edit(scene_ref *s, const GArray *edits, lmn_error *error)
{
    if (s->edited == edits)
        return LMN_OK;
    lmn_status status = solid_edits_apply(s->scene, s->edited, edits, error);
    g_clear_pointer(&s->edited, g_array_unref);
    s->edited = edits ? g_array_ref((GArray *)edits) : NULL;
    return status;
}

/* What signs depend on: what is told, when, and of whom they are seen. */
static char *signs_of(const view_state *state, const lmn_draw_desc *d)
{
    return g_strdup_printf("%s|%d %a %s|%a %a %a|%a %a %a|%a %a %a|%d %a %a|%d %d|%d|%u", state->told, d->time_given,
                           d->time_s, d->clip ? d->clip : "", d->eye[0], d->eye[1], d->eye[2], d->target[0],
                           d->target[1], d->target[2], d->up[0], d->up[1], d->up[2], d->orthographic, d->fov_deg,
                           d->fit, d->width, d->height, d->fit_direction, d->seed);
}

static lmn_status put_signs(scene_ref *s, const view_state *state, const lmn_draw_desc *desc, lmn_error *error)
{
    char *wanted = state->told ? signs_of(state, desc) : NULL;
    if (g_strcmp0(wanted, s->signs) == 0) {
        g_free(wanted);
        return LMN_OK;
    }
    lmn_depict_desc how = LMN_DEPICT_DESC_INIT;
    how.expressions = state->told;
    g_mutex_lock(&s->lock);
    lmn_status status = wanted ? lmn_depict(s->scene, desc, &how, NULL, error) : lmn_depict_clear(s->scene, error);
    g_mutex_unlock(&s->lock);
    g_free(s->signs);
    s->signs = status == LMN_OK ? wanted : NULL;
    if (status != LMN_OK)
        g_free(wanted);
    return status;
}

lmn_status scene_ref_prepare(scene_ref *s, const view_state *state, const lmn_draw_desc *desc, const lmn_look **look,
                             lmn_look **own, lmn_error *error)
{
    *own = NULL;
    *look = state->look->look;
    lmn_status status = scene_ref_edit(s, state->edits, error);
    if (status == LMN_OK)
        status = put_signs(s, state, desc, error);
    if (status == LMN_OK && state->told)
        status = lmn_look_copy(own, state->look->look, error);
    if (status == LMN_OK && state->told)
        status = lmn_look_add_sign_rules(*own, error);
    *look = *own ? *own : *look;
    return status;
}

scene_ref *scene_ref_take(scene_ref *s)
{
    return g_atomic_rc_box_acquire(s);
}

void scene_ref_drop(scene_ref *s)
{
    if (s)
        g_atomic_rc_box_release_full(s, scene_clear);
}

static void look_clear(void *data)
{
    look_ref *l = data;
    lmn_look_destroy(&l->look);
    g_free(l->origin);
}

look_ref *look_ref_make(lmn_look *look, const char *origin)
{
    look_ref *l = g_atomic_rc_box_new0(look_ref);
    l->look = look;
    l->origin = g_strdup(origin);
    return l;
}

look_ref *look_ref_load(const char *name_or_path, lmn_error *error)
{
    lmn_look *look = NULL;
    /* A file is called by all of its path, so that it is found from anywhere: by commands that are copied, too. */
    bool      is_file = strchr(name_or_path, '/') || g_str_has_suffix(name_or_path, ".json");
    char     *origin = is_file ? g_canonicalize_filename(name_or_path, NULL) : g_strdup(name_or_path);
    look_ref *out = lmn_look_load(&look, origin, error) == LMN_OK ? look_ref_make(look, origin) : NULL;
    g_free(origin);
    return out;
}

look_ref *look_ref_take(look_ref *l)
{
    return g_atomic_rc_box_acquire(l);
}

void look_ref_drop(look_ref *l)
{
    if (l)
        g_atomic_rc_box_release_full(l, look_clear);
}

/* --- states ---------------------------------------------------------------------------------------------- */

view_state *state_copy(const view_state *s)
{
    view_state *out = g_new(view_state, 1);
    *out = *s;
    if (s->look)
        look_ref_take(s->look);
    if (s->hidden)
        g_array_ref(s->hidden);
    if (s->edits)
        g_array_ref(s->edits);
    if (s->told)
        g_ref_string_acquire(s->told);
    out->clip = g_strdup(s->clip);
    return out;
}

void state_free(view_state *s)
{
    if (!s)
        return;
    look_ref_drop(s->look);
    if (s->hidden)
        g_array_unref(s->hidden);
    if (s->edits)
        g_array_unref(s->edits);
    g_clear_pointer(&s->told, g_ref_string_release);
    g_free(s->clip);
    g_free(s);
}

/* Whichever is shorter: which parts are shown, or which are not. */
char *state_selector(const view_state *s, const scene_ref *scene)
{
    size_t hidden = s->hidden ? s->hidden->len : 0;
    if (hidden == 0 || !scene)
        return NULL;
    GString *out = g_string_new(NULL);
    bool     name_shown = scene->info.parts - hidden < hidden;
    size_t   next = 0;
    for (uint32_t part = 1; part <= scene->info.parts; part++) {
        bool is_hidden = next < hidden && g_array_index(s->hidden, uint32_t, next) == part;
        next += is_hidden;
        if (is_hidden == name_shown)
            continue;
        const char *join = out->len == 0 ? "" : name_shown ? ", " : " ";
        g_string_append_printf(out, "%s%s[id=%u]", join, name_shown ? "" : "!", part);
    }
    if (name_shown && s->told)
        g_string_append_printf(out, "%s[glyph]", out->len ? ", " : "");
    /* Nothing is left to see: a selector that no part has. */
    if (out->len == 0)
        g_string_append(out, "!*");
    return g_string_free(out, FALSE);
}

void state_bounds(const view_state *s, const scene_ref *scene, double box_min[3], double box_max[3])
{
    guint next = 0;
    bool  any = false;
    memcpy(box_min, scene->info.bounds_min, 3 * sizeof *box_min);
    memcpy(box_max, scene->info.bounds_max, 3 * sizeof *box_max);
    for (guint i = 0; s->hidden && i < scene->boxes->len; i++) {
        const double *box = (const double *)(const void *)scene->boxes->data + 6 * i;
        if (next < s->hidden->len && g_array_index(s->hidden, uint32_t, next) == i + 1) {
            next++;
            continue;
        }
        for (int k = 0; k < 3; k++) {
            box_min[k] = any ? MIN(box_min[k], box[k]) : box[k];
            box_max[k] = any ? MAX(box_max[k], box[3 + k]) : box[3 + k];
        }
        any = true;
    }
}

/* Clips go by number, from 1 on. */
static bool has_clip(const view_state *s, const scene_ref *scene)
{
    guint64 clip = s->clip ? g_ascii_strtoull(s->clip, NULL, 10) : 0;
    return scene->clips->len > 0 && clip <= scene->clips->len;
}

void state_describe(const view_state *s, const scene_ref *scene, const char *selector, int width, int height,
                    lmn_draw_desc *desc)
{
    bool timed = s->timed && has_clip(s, scene);
    *desc = (lmn_draw_desc)LMN_DRAW_DESC_INIT;
    desc->width = width;
    desc->height = height;
    orbit_describe(&s->view, desc);
    desc->select = selector;
    desc->time_given = timed;
    desc->time_s = timed ? s->time_s : 0;
    desc->clip = timed ? s->clip : NULL;
    desc->seed = s->seed;
}

/* --- history --------------------------------------------------------------------------------------------- */

static void step_free(void *data)
{
    step *s = data;
    state_free(s->state);
    g_free(s);
}

static step *step_at(const document *d, guint index)
{
    return g_ptr_array_index(d->steps, index);
}

static void tell(document *d, unsigned changes)
{
    for (guint i = 0; i < d->listeners->len; i++) {
        const listener *l = &g_array_index(d->listeners, listener, i);
        l->call(d, changes, l->user);
    }
}

static void add_step(document *d, view_state *state, const char *what)
{
    step *s = g_new(step, 1);
    *s = (step){state, what, g_get_monotonic_time()};
    g_ptr_array_add(d->steps, s);
    d->now = d->steps->len - 1;
}

/* Makes `state` the one that is shown; takes it. */
static void change(document *d, view_state *state, const char *what, unsigned changes)
{
    step  *now = step_at(d, d->now);
    gint64 time = g_get_monotonic_time();
    bool   goes_on =
        !d->step_ended && d->now > 0 && d->now == d->steps->len - 1 && now->what == what && time - now->at < STEP_US;
    if (goes_on) {
        state_free(now->state);
        now->state = state;
        now->at = time;
    } else {
        if (d->now + 1 < d->steps->len)
            g_ptr_array_remove_range(d->steps, d->now + 1, d->steps->len - d->now - 1);
        if (d->steps->len >= STEPS_MAX)
            g_ptr_array_remove_index(d->steps, 0);
        add_step(d, state, what);
        changes |= DOCUMENT_HISTORY;
    }
    d->step_ended = false;
    tell(d, changes);
}

static unsigned difference(const view_state *a, const view_state *b)
{
    unsigned out = DOCUMENT_HISTORY;
    out |= a->look != b->look ? DOCUMENT_LOOK : 0;
    out |= memcmp(&a->view, &b->view, sizeof a->view) != 0 ? DOCUMENT_VIEW : 0;
    out |= a->hidden != b->hidden ? DOCUMENT_PARTS : 0;
    out |= a->edits != b->edits ? DOCUMENT_SOLIDS : 0;
    out |= a->told != b->told ? DOCUMENT_TOLD : 0;
    out |= a->timed != b->timed || a->time_s != b->time_s || g_strcmp0(a->clip, b->clip) != 0 ? DOCUMENT_TIME : 0;
    return out;
}

static bool go_to(document *d, guint index)
{
    unsigned changes = difference(step_at(d, d->now)->state, step_at(d, index)->state);
    d->now = index;
    d->step_ended = true;
    tell(d, changes);
    return true;
}

bool document_undo(document *d)
{
    return d->now > 0 && go_to(d, d->now - 1);
}

bool document_redo(document *d)
{
    return d->now + 1 < d->steps->len && go_to(d, d->now + 1);
}

const char *document_undo_name(const document *d)
{
    return d->now > 0 ? step_at(d, d->now)->what : NULL;
}

const char *document_redo_name(const document *d)
{
    return d->now + 1 < d->steps->len ? step_at(d, d->now + 1)->what : NULL;
}

void document_end_step(document *d)
{
    d->step_ended = true;
}

/* --- the document ---------------------------------------------------------------------------------------- */

document *document_make(void)
{
    lmn_error error = {0};
    look_ref *look = look_ref_load("edges", &error);
    if (!look)
        return NULL;
    document *d = g_new0(document, 1);
    d->steps = g_ptr_array_new_with_free_func(step_free);
    d->listeners = g_array_new(FALSE, FALSE, sizeof(listener));
    view_state *first = g_new0(view_state, 1);
    first->look = look;
    first->view = orbit_make('y');
    add_step(d, first, NULL);
    return d;
}

void document_free(document *d)
{
    if (!d)
        return;
    g_ptr_array_unref(d->steps);
    g_array_unref(d->listeners);
    scene_ref_drop(d->scene);
    g_free(d);
}

void document_listen(document *d, document_listener call, void *user)
{
    const listener l = {call, user};
    g_array_append_val(d->listeners, l);
}

const view_state *document_state(const document *d)
{
    return step_at(d, d->now)->state;
}

const scene_ref *document_scene(const document *d)
{
    return d->scene;
}

/* What belongs to the files that were shown goes with them. */
static void forget_files(document *d, const scene_ref *scene, int width, int height)
{
    view_state *s = state_copy(document_state(d));
    s->view = orbit_make(scene->info.up);
    s->fitted = true;
    orbit_fit(&s->view, scene->info.bounds_min, scene->info.bounds_max, width, height);
    g_clear_pointer(&s->hidden, g_array_unref);
    g_clear_pointer(&s->edits, g_array_unref);
    g_clear_pointer(&s->clip, g_free);
    s->timed = false;
    s->time_s = 0;
    g_clear_pointer(&s->told, g_ref_string_release);
    if (scene->script_told) {
        const double end = scene->clips->len ? g_array_index(scene->clips, clip_info, 0).end_s : 0;
        s->told = g_ref_string_acquire(scene->script_told);
        s->timed = end > 0;
        s->time_s = scene->script_time >= 0 ? scene->script_time : 0.6 * end; /* as the command has it */
    }
    g_ptr_array_set_size(d->steps, 0);
    add_step(d, s, NULL);
}

void document_set_scene(document *d, scene_ref *scene, bool fit, int width, int height)
{
    bool other_parts = !d->scene || d->scene->info.parts != scene->info.parts;
    scene_ref_drop(d->scene);
    d->scene = scene;
    if (fit)
        forget_files(d, scene, width, height);
    if (other_parts)
        d->selected = 0;
    tell(d, ~0U);
}

void document_set_view(document *d, const orbit *view, const char *what)
{
    if (memcmp(view, &document_state(d)->view, sizeof *view) == 0)
        return;
    view_state *s = state_copy(document_state(d));
    s->view = *view;
    s->fitted = false;
    change(d, s, what, DOCUMENT_VIEW);
}

void document_fit_view(document *d, const orbit *before, const orbit *view)
{
    step        *now = step_at(d, d->now);
    const orbit *view_now = &now->state->view;
    const double NEAR = 1e-6; /* a camera that was read back is turned by less */
    if (!now->state->fitted || !(fabs(view_now->yaw - before->yaw) < NEAR) ||
        !(fabs(view_now->pitch - before->pitch) < NEAR) || view_now->orthographic != before->orthographic)
        return;
    view_state *s = state_copy(now->state);
    s->view = *view;
    s->fitted = true;
    state_free(now->state);
    now->state = s;
    tell(d, DOCUMENT_VIEW);
}

void document_set_time(document *d, bool timed, double time_s, const char *clip)
{
    const view_state *now = document_state(d);
    if (now->timed == timed && now->time_s == time_s && g_strcmp0(now->clip, clip) == 0)
        return;
    view_state *s = state_copy(now);
    s->timed = timed;
    s->time_s = time_s;
    char *copy = g_strdup(clip);
    g_free(s->clip);
    s->clip = copy;
    change(d, s, "Time", DOCUMENT_TIME);
}

void document_set_look(document *d, look_ref *look, const char *what)
{
    view_state *s = state_copy(document_state(d));
    look_ref_drop(s->look);
    s->look = look;
    change(d, s, what, DOCUMENT_LOOK);
}

lmn_look *document_copy_look(const document *d, lmn_error *error)
{
    lmn_look *out = NULL;
    return lmn_look_copy(&out, document_state(d)->look->look, error) == LMN_OK ? out : NULL;
}

void document_put_look(document *d, lmn_look *look, const char *what)
{
    const look_ref *before = document_state(d)->look;
    document_set_look(d, look_ref_make(look, before->origin), what);
}

/* --- parts ----------------------------------------------------------------------------------------------- */

bool document_is_hidden(const document *d, uint32_t part)
{
    const GArray *hidden = document_state(d)->hidden;
    for (guint i = 0; hidden && i < hidden->len; i++)
        if (g_array_index(hidden, uint32_t, i) == part)
            return true;
    return false;
}

/* One byte a part, 1: hidden; index 0 is not used. */
static GByteArray *hidden_map(const document *d, uint8_t fill)
{
    GByteArray   *map = g_byte_array_new();
    const GArray *hidden = document_state(d)->hidden;
    g_byte_array_set_size(map, d->scene ? (guint)d->scene->info.parts + 1 : 1);
    memset(map->data, fill, map->len);
    for (guint i = 0; !fill && hidden && i < hidden->len; i++) {
        uint32_t part = g_array_index(hidden, uint32_t, i);
        if (part < map->len)
            map->data[part] = 1;
    }
    return map;
}

/* Takes the map. */
static void set_hidden(document *d, GByteArray *map, const char *what)
{
    view_state *s = state_copy(document_state(d));
    g_clear_pointer(&s->hidden, g_array_unref);
    s->hidden = g_array_new(FALSE, FALSE, sizeof(uint32_t));
    for (uint32_t part = 1; part < map->len; part++)
        if (map->data[part])
            g_array_append_val(s->hidden, part);
    g_byte_array_unref(map);
    change(d, s, what, DOCUMENT_PARTS);
    document_end_step(d);
}

static void mark_parts(GByteArray *map, const uint32_t *parts, size_t count, uint8_t value)
{
    for (size_t i = 0; i < count; i++)
        if (parts[i] < map->len)
            map->data[parts[i]] = value;
}

void document_show_parts(document *d, const uint32_t *parts, size_t count, bool shown)
{
    GByteArray *map = hidden_map(d, 0);
    mark_parts(map, parts, count, !shown);
    set_hidden(d, map, shown ? "Show part" : "Hide part");
}

void document_show_alone(document *d, const uint32_t *parts, size_t count)
{
    GByteArray *map = hidden_map(d, 1);
    mark_parts(map, parts, count, 0);
    set_hidden(d, map, "Show alone");
}

void document_show_all(document *d)
{
    const GArray *hidden = document_state(d)->hidden;
    if (hidden && hidden->len)
        document_show_parts(d, (const uint32_t *)(const void *)hidden->data, hidden->len, true);
}

void document_select(document *d, uint32_t part)
{
    if (d->selected == part)
        return;
    d->selected = part;
    tell(d, DOCUMENT_SELECTED);
}

uint32_t document_selected(const document *d)
{
    return d->selected;
}

/* --- solids ---------------------------------------------------------------------------------------------- */

void document_set_handle(document *d, const node_handle *handle)
{
    if (memcmp(&d->handle, handle, sizeof *handle) == 0)
        return;
    d->handle = *handle;
    tell(d, DOCUMENT_SELECTED);
}

const node_handle *document_handle(const document *d)
{
    return &d->handle;
}

void document_set_told(document *d, char *told, const char *what)
{
    view_state *s = state_copy(document_state(d));
    g_clear_pointer(&s->told, g_ref_string_release);
    s->told = told;
    change(d, s, what, DOCUMENT_TOLD);
}

void document_edit_solid(document *d, const solid_edit *edit, const char *what)
{
    view_state *s = state_copy(document_state(d));
    GArray     *edits = solid_edits_with(s->edits, edit);
    g_clear_pointer(&s->edits, g_array_unref);
    s->edits = edits;
    change(d, s, what, DOCUMENT_SOLIDS);
}
