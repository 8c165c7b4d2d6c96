#include "cameras.h"

#include <math.h>

enum { CAMERAS_MAX = 64 };
/* Of the artist's jobs, beside those of the picture. */
enum { SLOT_FIT = 4 };

GMenu *cameras_menu(const scene_ref *scene)
{
    GMenu *out = g_menu_new();
    for (size_t i = 0; scene && scene->cameras[i] && i < CAMERAS_MAX; i++) {
        GMenuItem *item = g_menu_item_new(scene->cameras[i], NULL);
        g_menu_item_set_action_and_target(item, "win.camera", "s", scene->cameras[i]);
        g_menu_append_item(out, item);
        g_object_unref(item);
    }
    return out;
}

typedef struct camera_job {
    artist_job job;
    GObject   *owner;
    document *(*document_of)(GObject *owner);
    scene_ref  *scene;
    view_state *state;
    char       *name;          /* NULL: fits */
    bool        best;          /* from where most is seen, instead of from the same side */
    int         width, height; /* of a small picture */
    const char *what;
    double      view[16], projection[16];
} camera_job;

/* Only drawing tells where a camera is at a moment: one pixel suffices. */
static lmn_status ask_camera(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    camera_job   *j = (camera_job *)base;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc;
    char         *selector = state_selector(j->state, j->scene);
    state_describe(j->state, j->scene, selector, j->width, j->height, &desc);
    desc.fit_direction = !j->name;
    if (j->name) {
        desc.eye_given = desc.orthographic = false;
        desc.camera = j->name;
        desc.fov_deg = 30;
    }
    desc.samples = 1;
    desc.lenient = desc.draft = true;
    desc.progress = artist_goes_on;
    desc.progress_user = base;
    lmn_status status = scene_ref_edit(j->scene, j->state->edits, error);
    if (status == LMN_OK && j->best)
        status = lmn_scene_best_view(j->scene->scene, &desc, error);
    if (status == LMN_OK)
        status = lmn_draw(&drawing, renderer, j->scene->scene, j->state->look->look, &desc, error);
    if (status == LMN_OK)
        lmn_drawing_camera(drawing, j->view, j->projection);
    lmn_drawing_destroy(&drawing);
    g_free(selector);
    return status;
}

static void camera_told(artist_job *base, lmn_status status, const lmn_error *error)
{
    camera_job *j = (camera_job *)base;
    document   *d = j->document_of(j->owner);
    (void)error;
    if (!d || status != LMN_OK || document_scene(d) != j->scene)
        return;
    orbit         o = document_state(d)->view;
    const double *m = j->view;
    double        eye[3], target[3], middle[3], along = 0;
    o.orthographic = j->projection[15] == 1;
    for (int k = 0; k < 3; k++) {
        eye[k] = -(m[4 * k] * m[12] + m[4 * k + 1] * m[13] + m[4 * k + 2] * m[14]);
        middle[k] = (j->scene->info.bounds_min[k] + j->scene->info.bounds_max[k]) / 2;
        along -= (middle[k] - eye[k]) * m[4 * k + 2];
    }
    /* It turns around what lies in the model's depth. */
    if (!(along > 0))
        along = 1;
    for (int k = 0; k < 3; k++)
        target[k] = eye[k] - along * m[4 * k + 2];
    if (o.orthographic)
        o.fov_deg = 360 / G_PI * atan(1 / (j->projection[5] * along));
    else
        o.fov_deg = 360 / G_PI * atan(1 / j->projection[5]);
    orbit_place(&o, eye, target);
    if (!j->what) {
        document_fit_view(d, &j->state->view, &o);
        return;
    }
    if (j->name || j->best)
        document_end_step(d);
    document_set_view(d, &o, j->what);
}

static void camera_release(artist_job *base)
{
    camera_job *j = (camera_job *)base;
    scene_ref_drop(j->scene);
    state_free(j->state);
    g_free(j->name);
    g_object_unref(j->owner);
    g_free(j);
}

void cameras_go(GObject *owner, document *(*document_of)(GObject *owner), artist *a, scene_ref *scene,
                const view_state *state, const char *name)
{
    camera_job *j = g_new0(camera_job, 1);
    j->job = (artist_job){ARTIST_ASK, 0, ask_camera, camera_told, camera_release};
    j->owner = g_object_ref(owner);
    j->document_of = document_of;
    j->scene = scene_ref_take(scene);
    j->state = state_copy(state);
    j->name = g_strdup(name);
    j->width = j->height = 1;
    j->what = "Camera";
    artist_ask(a, &j->job);
}

/* Asks for the camera of a picture of this size that is filled by what is drawn. */
static void ask_fit(GObject *owner, document *(*document_of)(GObject *owner), artist *a, scene_ref *scene,
                    const view_state *state, int width, int height, bool best, const char *what)
{
    enum { SIDE = 256 }; /* its shape matters, not its size */
    camera_job *j = g_new0(camera_job, 1);
    int         longer = MAX(1, MAX(width, height));
    j->job = (artist_job){ARTIST_ASK, SLOT_FIT, ask_camera, camera_told, camera_release};
    j->owner = g_object_ref(owner);
    j->document_of = document_of;
    j->scene = scene_ref_take(scene);
    j->state = state_copy(state);
    j->width = MAX(1, SIDE * width / longer);
    j->height = MAX(1, SIDE * height / longer);
    j->best = best;
    j->what = what;
    artist_ask(a, &j->job);
}

void cameras_fit(GObject *owner, document *(*document_of)(GObject *owner), artist *a, scene_ref *scene,
                 const view_state *state, int width, int height, const char *what)
{
    ask_fit(owner, document_of, a, scene, state, width, height, false, what);
}

void cameras_best(GObject *owner, document *(*document_of)(GObject *owner), artist *a, scene_ref *scene,
                  const view_state *state, int width, int height)
{
    ask_fit(owner, document_of, a, scene, state, width, height, true, "View");
}
