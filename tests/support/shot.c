#include "shot.h"

#include <jansson.h>
#include <limner/limner.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "check.h"
#include "model.h"
#include "picture.h"

static lmn_renderer *renderers[2];

void shot_end(void)
{
    for (int i = 0; i < 2; i++)
        lmn_renderer_destroy(&renderers[i]);
}

/* What tests write need not outlive a loss of power: takes the place of the C library's for the whole program, since
 * waiting for the disk, file by file, is a good part of a test's time. */
__attribute__((visibility("default"))) int fsync(int descriptor)
{
    (void)descriptor;
    return 0;
}

static bool accepted(lmn_status status, const lmn_error *error, const char *what)
{
    if (status == LMN_OK)
        return true;
    check_that("engine", false, "%s: %s %s", what, error->message, error->hint);
    return false;
}

static lmn_renderer *renderer_of(bool es)
{
    lmn_error error = {0};
    if (!renderers[es]) {
        lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
        desc.es = es;
        if (!accepted(lmn_renderer_create(&renderers[es], &desc, &error), &error, "renderer"))
            return NULL;
    }
    return renderers[es];
}

static bool load_look(lmn_look **look, const char *text, const char *const *changes)
{
    lmn_error error = {0};
    if (!accepted(text[0] == '{' ? lmn_look_parse(look, text, "look", &error) : lmn_look_load(look, text, &error),
                  &error, "look"))
        return false;
    for (; changes && changes[0]; changes += 2)
        if (!accepted(lmn_look_set(*look, changes[0], changes[1], &error), &error, changes[0]))
            return false;
    return true;
}

static lmn_draw_desc desc_of(const shot_view *view)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = view->width;
    desc.height = view->height;
    desc.eye_given = !view->bare;
    desc.view = (lmn_view)view->named;
    memcpy(desc.eye, &view->eye, sizeof desc.eye);
    memcpy(desc.target, &view->target, sizeof desc.target);
    memcpy(desc.up, &view->up, sizeof desc.up);
    desc.orthographic = view->orthographic;
    if (view->fov_deg > 0)
        desc.fov_deg = view->fov_deg;
    desc.dpi = view->dpi > 0 ? view->dpi : 96; /* lengths in px are pixels, and those of looks of version 1 */
    desc.samples = view->samples > 0 ? view->samples : 1;
    desc.maps = !view->without_maps;
    desc.profile = view->profile;
    desc.seed = view->seed;
    desc.time_s = view->time_s;
    desc.lenient = true; /* what is refused has tests of its own */
    desc.select = view->select;
    return desc;
}

static bool read_matrix(const json_t *array, double out[16])
{
    for (size_t i = 0; i < 16; i++) {
        json_t *number = json_array_get(array, i);
        if (!json_is_number(number))
            return false;
        out[i] = json_number_value(number);
    }
    return true;
}

static bool read_report(shot *out, const lmn_drawing *drawing)
{
    char   *text = lmn_drawing_report_json(drawing);
    json_t *report = text ? json_loads(text, 0, NULL) : NULL, *camera = json_object_get(report, "camera");
    bool    ok = read_matrix(json_object_get(camera, "view_matrix"), out->view) &&
              read_matrix(json_object_get(camera, "projection_matrix"), out->projection);
    out->near_depth = json_number_value(json_object_get(camera, "near"));
    out->far_depth = json_number_value(json_object_get(camera, "far"));
    const char *kind = json_string_value(json_object_get(camera, "projection"));
    out->orthographic = kind && strcmp(kind, "orthographic") == 0;
    const char *producer = json_string_value(json_object_get(report, "layer_producer"));
    snprintf(out->layer_producer, sizeof out->layer_producer, "%s", producer ? producer : "");
    out->layers_drawn = (int)json_integer_value(json_object_get(report, "layers"));
    out->report = text ? strdup(text) : NULL;
    lmn_text_free(text);
    json_decref(report);
    return ok || check_that("report", false, "the report is JSON with the camera's matrices");
}

bool shot_has_warning(const shot *s, const char *code)
{
    json_t *report = s->report ? json_loads(s->report, 0, NULL) : NULL, *warning;
    size_t  i;
    bool    found = false;
    json_array_foreach(json_object_get(report, "warnings"), i, warning)
    {
        const char *own = json_string_value(json_object_get(warning, "code"));
        found = found || (own && strcmp(own, code) == 0);
    }
    json_decref(report);
    return found;
}

static const char *const layer_maps[5] = {"depth.pfm", "normal.pfm", "id.png", "edge.png", "shade.png"};

static const char *const found_maps[3] = {"perturbed.depth.pfm", "perturbed.edge.png", "perturbed.shade.png"};

static bool file_exists(const char *path)
{
    FILE *file = fopen(path, "rb");
    return file && fclose(file) == 0;
}

/* Folders are used again: a drawing of fewer layers must not be taken for one of more, nor an exact
 * one for a perturbed one. */
static void forget_maps(const char *folder)
{
    char path[576];
    snprintf(path, sizeof path, "%s/uncertainty.pfm", folder);
    remove(path);
    snprintf(path, sizeof path, "%s/direction.pfm", folder);
    remove(path);
    for (int k = 0, found = 5; found > 0; k++) {
        found = 0;
        for (int i = 0; i < 8; i++) {
            snprintf(path, sizeof path, "%s/layer%d.%s", folder, k, i < 5 ? layer_maps[i] : found_maps[i - 5]);
            found += remove(path) == 0;
        }
    }
}

/* What compositions find, where something is perturbed. */
static bool read_found(shot *out, shot_layer *layer, const char *folder, int index)
{
    char path[3][576];
    int  w[3] = {0}, h[3] = {0};
    for (int i = 0; i < 3; i++)
        snprintf(path[i], sizeof path[i], "%s/layer%d.%s", folder, index, found_maps[i]);
    if (!file_exists(path[0]))
        return true;
    layer->found_depth = picture_read_pfm(path[0], 1, &w[0], &h[0]);
    layer->found_edge = picture_read_rgba(path[1], &w[1], &h[1]);
    layer->found_shade = picture_read_rgba(path[2], &w[2], &h[2]);
    for (int i = 0; i < 3; i++)
        if (w[i] != out->width || h[i] != out->height)
            return check_that("maps", false, "%s can be read and has the picture's size (%d x %d)", path[i], w[i],
                              h[i]);
    return true;
}

static bool read_layer(shot *out, const char *folder, int index)
{
    char       path[5][576];
    shot_layer layer = {0};
    int        w[5] = {0}, h[5] = {0};
    for (int i = 0; i < 5; i++)
        snprintf(path[i], sizeof path[i], "%s/layer%d.%s", folder, index, layer_maps[i]);
    layer.depth = picture_read_pfm(path[0], 1, &w[0], &h[0]);
    layer.normal = (float(*)[3])picture_read_pfm(path[1], 3, &w[1], &h[1]);
    layer.id = picture_read_grey16(path[2], &w[2], &h[2]);
    layer.edge = picture_read_rgba(path[3], &w[3], &h[3]);
    layer.shade = picture_read_rgba(path[4], &w[4], &h[4]);
    shot_layer *grown = realloc(out->layers, (size_t)(index + 1) * sizeof *grown);
    if (!grown)
        abort();
    out->layers = grown;
    bool ok = read_found(out, &layer, folder, index);
    out->layers[out->layer_count++] = layer;
    for (int i = 0; i < 5; i++)
        if (w[i] != out->width || h[i] != out->height)
            return check_that("maps", false, "%s can be read and has the picture's size (%d x %d)", path[i], w[i],
                              h[i]);
    return ok;
}

/* Not every drawing has it: only with something perturbed, or strokes that follow the form. */
static bool read_further(shot *out, const char *folder, const char *name, float (**map)[3])
{
    char path[576];
    int  width = 0, height = 0;
    snprintf(path, sizeof path, "%s/%s", folder, name);
    if (!file_exists(path))
        return true;
    *map = (float(*)[3])picture_read_pfm(path, 3, &width, &height);
    return (width == out->width && height == out->height) ||
           check_that("maps", false, "%s can be read and has the picture's size (%d x %d)", path, width, height);
}

static bool read_layers(shot *out, const char *folder)
{
    for (int k = 0;; k++) {
        char path[576];
        snprintf(path, sizeof path, "%s/layer%d.depth.pfm", folder, k);
        if (!file_exists(path))
            return true;
        if (!read_layer(out, folder, k))
            return false;
    }
}

static bool read_maps(shot *out, const lmn_drawing *drawing)
{
    static int  count;
    char        folder[480];
    const char *names[] = {"depth.pfm", "normal.pfm", "id.png", "edge.png", "shade.png"};
    char        path[5][512];
    lmn_error   error = {0};
    snprintf(folder, sizeof folder, "%s", check_path("maps%d", count++ % 4));
    forget_maps(folder);
    if (!accepted(lmn_drawing_write_maps(drawing, folder, &error), &error, "maps"))
        return false;
    for (int i = 0; i < 5; i++)
        snprintf(path[i], sizeof path[i], "%s/%s", folder, names[i]);
    int w[5] = {0}, h[5] = {0};
    out->depth = picture_read_pfm(path[0], 1, &w[0], &h[0]);
    out->normal = (float(*)[3])picture_read_pfm(path[1], 3, &w[1], &h[1]);
    out->id = picture_read_grey16(path[2], &w[2], &h[2]);
    out->edge = picture_read_rgba(path[3], &w[3], &h[3]);
    out->shade = picture_read_rgba(path[4], &w[4], &h[4]);
    for (int i = 0; i < 5; i++)
        if (w[i] != out->width || h[i] != out->height)
            return check_that("maps", false, "%s can be read and has the picture's size (%d x %d)", names[i], w[i],
                              h[i]);
    return read_further(out, folder, "uncertainty.pfm", &out->uncertainty) &&
           read_further(out, folder, "direction.pfm", &out->direction) && read_layers(out, folder);
}

static bool draw(shot *out, lmn_scene *scene, const lmn_look *look, const shot_view *view)
{
    lmn_error     error = {0};
    lmn_drawing  *drawing = NULL;
    lmn_draw_desc desc = desc_of(view);
    lmn_renderer *renderer = renderer_of(view->es);
    if (!renderer || !accepted(lmn_draw(&drawing, renderer, scene, look, &desc, &error), &error, "draw"))
        return false;
    const uint8_t *pixels = lmn_drawing_pixels(drawing, &out->width, &out->height);
    size_t         size = (size_t)out->width * (size_t)out->height * 4;
    out->picture = check_alloc(size, 1);
    memcpy(out->picture, pixels, size);
    bool ok = read_report(out, drawing) && (view->without_maps || read_maps(out, drawing));
    lmn_drawing_destroy(&drawing);
    return ok;
}

bool shot_take(shot *out, const char *model, const char *look_text, const char *const *changes, const shot_view *view)
{
    memset(out, 0, sizeof *out);
    lmn_error  error = {0};
    lmn_scene *scene = NULL;
    lmn_look  *look = NULL;
    bool       ok = accepted(lmn_scene_create(&scene, &error), &error, "scene") &&
              accepted(lmn_scene_add_file(scene, model, NULL, &error), &error, model) &&
              load_look(&look, look_text, changes) && draw(out, scene, look, view);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    if (!ok)
        shot_release(out);
    return ok;
}

bool shot_of_shape(shot *out, const shape *s, const char *file, const char *look, const char *const *changes,
                   const shot_view *view)
{
    char path[512];
    memset(out, 0, sizeof *out);
    snprintf(path, sizeof path, "%s", check_path("%s", file));
    if (!model_write(path, s))
        return check_that("files", false, "%s cannot be written", path);
    return shot_take(out, path, look, changes, view);
}

const char *shot_line_look(const char *lines)
{
    static char texts[4][1024];
    static int  next;
    char       *text = texts[next];
    next = (next + 1) % 4;
    snprintf(text, sizeof texts[0],
             "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\","
             "\"surface\":{\"technique\":\"flat\",\"colour\":\"#ffffff\"}%s%s}]}",
             lines ? ",\"lines\":" : "", lines ? lines : "");
    return text;
}

void shot_blank(shot *out, const shot_view *view, double near_depth, double far_depth)
{
    double n = near_depth, f = far_depth,
           t = tan((view->fov_deg > 0 ? view->fov_deg : 30) * 3.14159265358979323846 / 360);
    double aspect = (double)view->width / view->height;
    dvec   back = dvec_unit(dvec_sub(view->eye, view->target)), right = dvec_unit(dvec_cross(view->up, back));
    dvec   up = dvec_cross(back, right);
    size_t count = (size_t)view->width * (size_t)view->height;
    *out = (shot){.width = view->width,
                  .height = view->height,
                  .near_depth = n,
                  .far_depth = f,
                  .orthographic = view->orthographic,
                  .view = {right.x, up.x, back.x, 0, right.y, up.y, back.y, 0, right.z, up.z, back.z, 0,
                           -dvec_dot(right, view->eye), -dvec_dot(up, view->eye), -dvec_dot(back, view->eye), 1}};
    double half = t * dvec_length(dvec_sub(view->eye, view->target));
    double parallel[16] = {
        [0] = 1 / (half * aspect), [5] = 1 / half, [10] = -2 / (f - n), [14] = -(f + n) / (f - n), [15] = 1};
    double central[16] = {
        [0] = 1 / (t * aspect), [5] = 1 / t, [10] = -(f + n) / (f - n), [11] = -1, [14] = -2 * f * n / (f - n)};
    memcpy(out->projection, view->orthographic ? parallel : central, sizeof central);
    out->edge = check_alloc(count, 4);
    out->depth = check_alloc(count, sizeof *out->depth);
    out->normal = check_alloc(count, sizeof *out->normal);
    memset(out->edge, 255, count * 4);
}

void shot_release(shot *s)
{
    free(s->picture);
    free(s->edge);
    free(s->shade);
    free(s->depth);
    free(s->normal);
    free(s->uncertainty);
    free(s->direction);
    free(s->id);
    free(s->report);
    for (int k = 0; k < s->layer_count; k++) {
        free(s->layers[k].depth);
        free(s->layers[k].normal);
        free(s->layers[k].id);
        free(s->layers[k].edge);
        free(s->layers[k].shade);
        free(s->layers[k].found_depth);
        free(s->layers[k].found_edge);
        free(s->layers[k].found_shade);
    }
    free(s->layers);
    memset(s, 0, sizeof *s);
}

/* The projection is one of two known forms, so that its inverse is written down directly. */
void shot_ray(const shot *s, double x, double y, dvec *origin, dvec *direction)
{
    const double *p = s->projection, *v = s->view;
    double        nx = 2 * x / s->width - 1, ny = 1 - 2 * y / s->height;
    dvec          eye_origin = {0, 0, 0}, eye_direction = {0, 0, -1};
    if (s->orthographic)
        eye_origin = dvec_of((nx - p[12]) / p[0], (ny - p[13]) / p[5], 0);
    else
        eye_direction = dvec_of((nx + p[8]) / p[0], (ny + p[9]) / p[5], -1);
    dvec rows[3] = {{v[0], v[1], v[2]}, {v[4], v[5], v[6]}, {v[8], v[9], v[10]}};
    dvec moved = dvec_sub(eye_origin, dvec_of(v[12], v[13], v[14]));
    *origin = dvec_of(dvec_dot(rows[0], moved), dvec_dot(rows[1], moved), dvec_dot(rows[2], moved));
    *direction =
        dvec_of(dvec_dot(rows[0], eye_direction), dvec_dot(rows[1], eye_direction), dvec_dot(rows[2], eye_direction));
}

dvec shot_project(const shot *s, dvec point)
{
    double w, unused;
    dvec   clip = dmat_apply(s->projection, dmat_apply(s->view, point, 1, &unused), 1, &w);
    return dvec_of((clip.x / w * 0.5 + 0.5) * s->width, (0.5 - clip.y / w * 0.5) * s->height, w);
}

dvec shot_to_eye(const shot *s, dvec v, double w)
{
    return dmat_apply(s->view, v, w, NULL);
}

dvec shot_viewer(const shot *s, double *w)
{
    dvec origin, direction;
    shot_ray(s, s->width / 2.0, s->height / 2.0, &origin, &direction);
    *w = s->orthographic ? 0 : 1;
    return s->orthographic ? dvec_scale(direction, -1) : origin;
}

int shot_ink(const shot *s, int x, int y)
{
    const uint8_t *e = &s->edge[4 * ((size_t)y * (size_t)s->width + (size_t)x)];
    return e[2] < e[3] ? e[2] : e[3];
}

int shot_differing(const shot *a, const shot *b, int tolerance)
{
    int count = 0;
    for (int i = 0; i < 4 * a->width * a->height; i++)
        count += abs(a->picture[i] - b->picture[i]) > tolerance;
    return count;
}

void shot_on_page(const shot *s, dvec point, double out[2])
{
    double eye[4], clip[4];
    for (int row = 0; row < 4; row++)
        eye[row] = s->view[row] * point.x + s->view[4 + row] * point.y + s->view[8 + row] * point.z + s->view[12 + row];
    for (int row = 0; row < 4; row++) {
        clip[row] = 0;
        for (int k = 0; k < 4; k++)
            clip[row] += s->projection[4 * k + row] * eye[k];
    }
    out[0] = (clip[0] / clip[3] + 1) / 2 * s->width;
    out[1] = (1 - clip[1] / clip[3]) / 2 * s->height;
}
