#include "cameras.h"

#include <math.h>

enum { CAMERAS_MAX = 64 };

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
    char       *name;
    double      view[16], projection[16];
} camera_job;

/* Only drawing tells where a camera is at a moment: one pixel suffices. */
static lmn_status ask_camera(artist_job *base, lmn_renderer *renderer, lmn_error *error)
{
    camera_job   *j = (camera_job *)base;
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc;
    state_describe(j->state, j->scene, NULL, 1, 1, &desc);
    desc.eye_given = desc.orthographic = false;
    desc.camera = j->name;
    desc.fov_deg = 30;
    desc.samples = 1;
    desc.lenient = desc.draft = true;
    desc.progress = artist_goes_on;
    desc.progress_user = base;
    lmn_status status = lmn_draw(&drawing, renderer, j->scene->scene, j->state->look->look, &desc, error);
    if (status == LMN_OK)
        lmn_drawing_camera(drawing, j->view, j->projection);
    lmn_drawing_destroy(&drawing);
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
    document_end_step(d);
    document_set_view(d, &o, "Camera");
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
    artist_ask(a, &j->job);
}
