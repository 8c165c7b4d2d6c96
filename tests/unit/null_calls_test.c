/* Bad input to all of the public functions: NULL for each pointer by itself and for all at once, descriptions of every
 * size, arrays that are not there, and objects whose makers have ended. Each call answers with LMN_USAGE or with what
 * its header says; none crashes. A function that a header declares and the table lacks makes this fail. */
#include <glob.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

#include <cmocka.h>

#include "limner/limner.h"

#define FOLDER "null_calls_files"
#define MODEL  LIMNER_SOURCE_DIR "/examples/box.glb"

enum { SIDE = 16 };

/* What calls are made with. */
typedef struct world {
    unsigned      null;    /* bit k: pointer k of the call is NULL */
    void         *desc[2]; /* descriptions that the row asks for */
    lmn_error     error;
    lmn_renderer *renderer; /* these four are made once */
    lmn_look     *look;
    lmn_drawing  *drawing;
    lmn_sheet    *sheet;
    lmn_scene    *scene; /* these are made for each call */
    lmn_strokes  *strokes;
    uint32_t      mesh, node, solid, box;
} world;

/* --- what is valid -------------------------------------------------------------------------------------- */

static const float         corners[] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
static const double        identity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
static const uint8_t       pixels[SIDE * SIDE * 4] = {255};
static const uint32_t      one[] = {1};
static const char *const   texts[] = {"line"};
static const lmn_mesh_desc mesh_desc = {
    sizeof(lmn_mesh_desc), "triangle", corners, NULL, NULL, NULL, NULL, NULL, 3, NULL, 0, NULL, 0, 0};
static const lmn_material_desc   material_desc = LMN_MATERIAL_DESC_INIT;
static const lmn_camera_desc     camera_desc = LMN_CAMERA_DESC_INIT;
static const lmn_light_desc      light_desc = LMN_LIGHT_DESC_INIT;
static const lmn_node_desc       node_desc = LMN_NODE_DESC_INIT;
static const lmn_load_desc       load_desc = LMN_LOAD_DESC_INIT;
static const lmn_renderer_desc   renderer_desc = LMN_RENDERER_DESC_INIT;
static const lmn_sheet_desc      sheet_desc = LMN_SHEET_DESC_INIT;
static const lmn_depict_desc     depict_desc = LMN_DEPICT_DESC_INIT;
static const lmn_pattern_desc    pattern_desc = LMN_PATTERN_DESC_INIT;
static const lmn_strokes_view    strokes_view = {sizeof(lmn_strokes_view), SIDE, 0, 0, 0};
static const lmn_film_desc       film_desc = {sizeof(lmn_film_desc), SIDE, SIDE, 24, 0, NULL, NULL, NULL};
static const lmn_target          target = {sizeof(lmn_target), 0, 0, 0, SIDE, SIDE, LMN_TARGET_DEPTH_IGNORE};
static const lmn_projection_desc projection_desc = LMN_PROJECTION_DESC_INIT;
static lmn_draw_desc             draw_desc = LMN_DRAW_DESC_INIT; /* the rest is filled in by set_up */
static lmn_limits                limits;
static lmn_task_desc             task_desc;
static lmn_shape                 shape;

/* --- calls ---------------------------------------------------------------------------------------------- */

/* Pointer k of the call. */
#define P(k, pointer) (w->null >> (k)&1 ? NULL : (pointer))
/* A call of the table: its name, and what it answers; LMN_USAGE stands for neutral answers, too. */
#define CALL(name) static lmn_status call_##name(world *w)

static lmn_status neutral(bool is_neutral)
{
    return is_neutral ? LMN_USAGE : LMN_OK;
}

static lmn_status freed(char *text)
{
    bool none = !text;
    lmn_text_free(text);
    return neutral(none);
}

#define NUMBER uint32_t number = 0

CALL(lmn_scene_add_mesh)
{
    NUMBER;
    return lmn_scene_add_mesh(P(0, w->scene), P(1, w->desc[0]), P(2, &number), P(3, &w->error));
}
CALL(lmn_scene_set_mesh)
{
    return lmn_scene_set_mesh(P(0, w->scene), w->mesh, P(1, w->desc[0]), P(2, &w->error));
}
CALL(lmn_scene_set_positions)
{
    static const float up[9] = {0, 0, 1, 0, 0, 1, 0, 0, 1};
    return lmn_scene_set_positions(P(0, w->scene), w->mesh, P(1, corners), P(2, up), 3, P(3, &w->error));
}
CALL(lmn_scene_add_texture)
{
    NUMBER;
    return lmn_scene_add_texture(P(0, w->scene), P(1, "t"), SIDE, SIDE, P(2, pixels), P(3, &number), P(4, &w->error));
}
CALL(lmn_scene_add_material)
{
    NUMBER;
    return lmn_scene_add_material(P(0, w->scene), P(1, w->desc[0]), P(2, &number), P(3, &w->error));
}
CALL(lmn_scene_set_material)
{
    lmn_scene_add_material(w->scene, &material_desc, NULL, NULL);
    return lmn_scene_set_material(P(0, w->scene), 1, P(1, w->desc[0]), P(2, &w->error));
}
CALL(lmn_scene_add_camera)
{
    NUMBER;
    return lmn_scene_add_camera(P(0, w->scene), P(1, w->desc[0]), P(2, &number), P(3, &w->error));
}
CALL(lmn_scene_add_light)
{
    NUMBER;
    return lmn_scene_add_light(P(0, w->scene), P(1, w->desc[0]), P(2, &number), P(3, &w->error));
}
CALL(lmn_scene_add_skin)
{
    NUMBER;
    return lmn_scene_add_skin(P(0, w->scene), P(1, one), P(2, identity), 1, P(3, &number), P(4, &w->error));
}
CALL(lmn_scene_add_node)
{
    NUMBER;
    return lmn_scene_add_node(P(0, w->scene), P(1, w->desc[0]), P(2, &number), P(3, &w->error));
}
CALL(lmn_scene_node_of_part)
{
    return neutral(lmn_scene_node_of_part(P(0, w->scene), 1) == 0);
}
CALL(lmn_scene_set_matrix)
{
    return lmn_scene_set_matrix(P(0, w->scene), w->node, P(1, identity), P(2, &w->error));
}
CALL(lmn_scene_set_instances)
{
    return lmn_scene_set_instances(P(0, w->scene), w->node, P(1, identity), 1, P(2, &w->error));
}
CALL(lmn_scene_set_visible)
{
    return lmn_scene_set_visible(P(0, w->scene), w->node, false, P(1, &w->error));
}
CALL(lmn_scene_set_attribute)
{
    return lmn_scene_set_attribute(P(0, w->scene), w->node, P(1, "kind"), P(2, "bolt"), P(3, &w->error));
}
CALL(lmn_scene_remove_node)
{
    return lmn_scene_remove_node(P(0, w->scene), w->node, P(1, &w->error));
}
CALL(lmn_scene_set_up)
{
    lmn_scene *empty = NULL;
    lmn_scene_create(&empty, NULL);
    lmn_status status = lmn_scene_set_up(P(0, empty), LMN_UP_Z, P(1, &w->error));
    lmn_scene_destroy(&empty);
    return status;
}
CALL(lmn_scene_begin_changes)
{
    return lmn_scene_begin_changes(P(0, w->scene), P(1, &w->error));
}
CALL(lmn_scene_end_changes)
{
    lmn_scene_begin_changes(w->scene, NULL);
    return lmn_scene_end_changes(P(0, w->scene), P(1, &w->error));
}
CALL(lmn_renderer_create)
{
    lmn_renderer *made = NULL;
    lmn_status    status = lmn_renderer_create(P(0, &made), P(1, w->desc[0]), P(2, &w->error));
    lmn_renderer_destroy(&made);
    return status;
}
CALL(lmn_renderer_destroy)
{
    lmn_renderer *none = NULL;
    lmn_renderer_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_renderer_json)
{
    return freed(lmn_renderer_json(P(0, w->renderer)));
}
CALL(lmn_draw_check)
{
    return lmn_draw_check(P(0, w->scene), P(1, w->look), P(2, w->desc[0]), false, P(3, &w->error));
}
CALL(lmn_scene_best_view)
{
    return lmn_scene_best_view(P(0, w->scene), P(1, w->desc[0]), P(2, &w->error));
}
CALL(lmn_draw)
{
    lmn_drawing *made = NULL;
    lmn_status   status =
        lmn_draw(P(0, &made), P(1, w->renderer), P(2, w->scene), P(3, w->look), P(4, w->desc[0]), P(5, &w->error));
    lmn_drawing_destroy(&made);
    return status;
}
CALL(lmn_scene_project)
{
    lmn_scene    *made = NULL;
    lmn_draw_desc desc = draw_desc;
    lmn_status status = lmn_scene_project(P(0, &made), P(1, w->scene), P(2, &desc), P(3, w->desc[0]), P(4, &w->error));
    lmn_scene_destroy(&made);
    return status;
}
CALL(lmn_projection_name)
{
    return neutral(w->null != 0 || !lmn_projection_name(0) || lmn_projection_name(-1));
}
CALL(lmn_drawing_destroy)
{
    lmn_drawing *none = NULL;
    lmn_drawing_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_drawing_pixels)
{
    int width, height;
    return neutral(!lmn_drawing_pixels(P(0, w->drawing), P(1, &width), P(2, &height)));
}
CALL(lmn_drawing_write)
{
    uint64_t bytes;
    return lmn_drawing_write(P(0, w->drawing), P(1, FOLDER "/out.png"), P(2, ".png"), P(3, &bytes), P(4, &w->error));
}
CALL(lmn_drawing_write_maps)
{
    return lmn_drawing_write_maps(P(0, w->drawing), P(1, FOLDER "/maps"), P(2, &w->error));
}
CALL(lmn_drawing_report_json)
{
    return freed(lmn_drawing_report_json(P(0, w->drawing)));
}
CALL(lmn_drawing_warning_count)
{
    return neutral(lmn_drawing_warning_count(P(0, w->drawing)) == 0);
}
CALL(lmn_drawing_warning_at)
{
    const char *code;
    size_t      count;
    return neutral(!lmn_drawing_warning_at(P(0, w->drawing), 0, P(1, &code), P(2, &count)));
}
CALL(lmn_bench_json)
{
    char      *out = NULL;
    lmn_status status = lmn_bench_json(P(0, &out), P(1, w->renderer), P(2, w->scene), P(3, texts), 1, P(4, w->desc[0]),
                                       1, P(5, &w->error));
    lmn_text_free(out);
    return status;
}
CALL(lmn_status_text)
{
    return neutral(w->null != 0 || lmn_status_text((lmn_status)-1) == NULL || lmn_status_text((lmn_status)99) == NULL);
}
CALL(lmn_film_format_at)
{
    lmn_film_format_info info;
    return neutral(!lmn_film_format_at(0, P(0, &info)));
}

/* The first format of films that can be made here; ".webp" when there is none. */
static const char *film_path(void)
{
    static const char *const paths[] = {FOLDER "/f.webp", FOLDER "/f.gif", FOLDER "/f.mp4"};
    for (int i = 0; i < 3; i++)
        if (lmn_film_check(paths[i], &film_desc, NULL) == LMN_OK)
            return paths[i];
    return paths[0];
}

static lmn_film *open_film(void)
{
    lmn_film *made = NULL;
    lmn_film_open(&made, film_path(), &film_desc, NULL);
    return made;
}

CALL(lmn_film_check)
{
    return lmn_film_check(P(0, film_path()), P(1, w->desc[0]), P(2, &w->error));
}
CALL(lmn_film_open)
{
    lmn_film  *made = NULL;
    lmn_status status = lmn_film_open(P(0, &made), P(1, film_path()), P(2, w->desc[0]), P(3, &w->error));
    lmn_film_destroy(&made);
    return status;
}
CALL(lmn_film_add)
{
    lmn_film  *made = open_film();
    lmn_status status = lmn_film_add(P(0, made), P(1, pixels), P(2, &w->error));
    lmn_film_destroy(&made);
    return status;
}
CALL(lmn_film_close)
{
    lmn_film *made = open_film();
    uint64_t  bytes;
    lmn_film_add(made, pixels, NULL);
    lmn_status status = lmn_film_close(P(0, &made), P(1, &bytes), P(2, &w->error));
    lmn_film_destroy(&made);
    return status;
}
CALL(lmn_film_destroy)
{
    lmn_film *none = NULL;
    lmn_film_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_film_warning_count)
{
    lmn_film *made = open_film();
    size_t    count = lmn_film_warning_count(P(0, made));
    lmn_film_destroy(&made);
    return neutral(count == 0);
}
CALL(lmn_film_warning_at)
{
    lmn_film   *made = open_film();
    const char *code, *text;
    size_t      count;
    text = lmn_film_warning_at(P(0, made), 0, P(1, &code), P(2, &count));
    lmn_film_destroy(&made);
    return neutral(!text);
}
CALL(lmn_picture_is_whole)
{
    return neutral(!lmn_picture_is_whole(P(0, FOLDER "/absent.png"), 1, 1));
}
CALL(lmn_draw_into)
{
    return lmn_draw_into(P(0, w->renderer), P(1, w->scene), P(2, w->look), P(3, w->desc[0]), P(4, w->desc[1]),
                         P(5, &w->error));
}
CALL(lmn_limits_standard)
{
    return neutral(w->null != 0 || lmn_limits_standard().struct_size != sizeof(lmn_limits));
}
CALL(lmn_limits_safe)
{
    return neutral(w->null != 0 || lmn_limits_safe().struct_size != sizeof(lmn_limits));
}
CALL(lmn_limits_set)
{
    return lmn_limits_set(P(0, w->desc[0]), P(1, "time=3s"), P(2, &w->error));
}
CALL(lmn_limit_at)
{
    lmn_limit_info info;
    return neutral(!lmn_limit_at(0, P(0, &info)));
}
CALL(lmn_look_load)
{
    lmn_look  *made = NULL;
    lmn_status status = lmn_look_load(P(0, &made), P(1, "line"), P(2, &w->error));
    lmn_look_destroy(&made);
    return status;
}
CALL(lmn_look_parse)
{
    lmn_look  *made = NULL;
    char      *json = lmn_look_json(w->look);
    lmn_status status = lmn_look_parse(P(0, &made), P(1, json), P(2, "mine"), P(3, &w->error));
    lmn_text_free(json);
    lmn_look_destroy(&made);
    return status;
}
CALL(lmn_look_destroy)
{
    lmn_look *none = NULL;
    lmn_look_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_look_set)
{
    return lmn_look_set(P(0, w->look), P(1, "lines.width"), P(2, "2px"), P(3, &w->error));
}
CALL(lmn_look_json)
{
    return freed(lmn_look_json(P(0, w->look)));
}
CALL(lmn_look_name)
{
    return neutral(!lmn_look_name(P(0, w->look)));
}
CALL(lmn_look_count)
{
    return neutral(w->null != 0 || lmn_look_count() == 0);
}
CALL(lmn_look_name_at)
{
    return neutral(w->null != 0 || !lmn_look_name_at(0) || lmn_look_name_at(SIZE_MAX));
}
#include "null_calls_behaviour.h"
#include "null_calls_host.h"
#include "null_calls_rules.h"
CALL(lmn_look_reference_json)
{
    char      *out = NULL;
    lmn_status status = lmn_look_reference_json(P(0, &out), P(1, "line"), P(2, &w->error));
    lmn_text_free(out);
    return status;
}
CALL(lmn_map_components)
{
    return neutral(w->null != 0 || lmn_map_components((lmn_map)-1) != 0 || lmn_map_components((lmn_map)99) != 0);
}
CALL(lmn_drawing_copy_map)
{
    float out[SIDE * SIDE];
    return lmn_drawing_copy_map(P(0, w->drawing), LMN_MAP_DEPTH, P(1, out), (size_t)SIDE * SIDE, P(2, &w->error));
}
CALL(lmn_drawing_pick)
{
    lmn_pick out;
    return lmn_drawing_pick(P(0, w->drawing), 0, 0, P(1, &out), P(2, &w->error));
}
CALL(lmn_drawing_pick_parts)
{
    uint32_t parts[4];
    size_t   count;
    return lmn_drawing_pick_parts(P(0, w->drawing), 0, 0, SIDE, SIDE, P(1, parts), 4, P(2, &count), P(3, &w->error));
}
CALL(lmn_drawing_project)
{
    double pixel[2], depth;
    return neutral(!lmn_drawing_project(P(0, w->drawing), P(1, identity), P(2, pixel), P(3, &depth)));
}
CALL(lmn_drawing_unproject)
{
    double point[3] = {7e77, 0, 0};
    lmn_drawing_unproject(P(0, w->drawing), P(1, identity), 1, P(2, point));
    return neutral(point[0] == 7e77);
}
CALL(lmn_drawing_camera)
{
    double view[16] = {7e77}, projection[16] = {7e77};
    lmn_drawing_camera(P(0, w->drawing), P(1, view), P(2, projection));
    return neutral(view[0] == 7e77 && projection[0] == 7e77);
}
CALL(lmn_scene_create)
{
    lmn_scene *made = NULL;
    lmn_status status = lmn_scene_create(P(0, &made), P(1, &w->error));
    lmn_scene_destroy(&made);
    return status;
}
CALL(lmn_scene_destroy)
{
    lmn_scene *none = NULL;
    lmn_scene_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_scene_add_file)
{
    return lmn_scene_add_file(P(0, w->scene), P(1, MODEL), P(2, w->desc[0]), P(3, &w->error));
}
CALL(lmn_scene_info_of)
{
    return neutral(lmn_scene_info_of(P(0, w->scene)).parts == 0);
}
CALL(lmn_scene_part_at)
{
    lmn_part_info out;
    return neutral(!lmn_scene_part_at(P(0, w->scene), 0, P(1, &out)));
}
CALL(lmn_scene_info_json)
{
    return freed(lmn_scene_info_json(P(0, w->scene)));
}
CALL(lmn_step_version)
{
    lmn_text_free(lmn_step_version()); /* NULL where OpenCASCADE is not */
    return neutral(w->null != 0);
}
CALL(lmn_scene_dynamics_json)
{
    return freed(lmn_scene_dynamics_json(P(0, w->scene)));
}
CALL(lmn_text_free)
{
    char *text = lmn_look_json(w->look);
    lmn_text_free(P(0, text));
    if (w->null)
        lmn_text_free(text);
    return neutral(true);
}
CALL(lmn_text_write)
{
    return lmn_text_write(P(0, "text"), P(1, FOLDER "/out.txt"), P(2, &w->error));
}
CALL(lmn_look_needs_pixels)
{
    return neutral(!lmn_look_needs_pixels(P(0, w->look)));
}
CALL(lmn_page_size)
{
    double width, height;
    return lmn_page_size(P(0, "A4"), P(1, &width), P(2, &height), P(3, &w->error));
}
CALL(lmn_draw_sheet)
{
    lmn_sheet *made = NULL;
    lmn_status status = lmn_draw_sheet(P(0, &made), P(1, w->renderer), P(2, w->scene), P(3, w->look), P(4, w->desc[0]),
                                       P(5, w->desc[1]), P(6, &w->error));
    lmn_sheet_destroy(&made);
    return status;
}
CALL(lmn_depict)
{
    char      *json = NULL;
    lmn_status status = lmn_depict(P(0, w->scene), P(1, w->desc[0]), P(2, w->desc[1]), P(3, &json), P(4, &w->error));
    lmn_text_free(json);
    lmn_depict_clear(w->scene, NULL);
    return status;
}
CALL(lmn_depict_clear)
{
    return lmn_depict_clear(P(0, w->scene), P(1, &w->error));
}
CALL(lmn_look_add_sign_rules)
{
    return lmn_look_add_sign_rules(P(0, w->look), P(1, &w->error));
}
CALL(lmn_depiction_at)
{
    lmn_depiction_info info;
    return neutral(!lmn_depiction_at(0, P(0, &info)));
}
CALL(lmn_depiction_param_at)
{
    lmn_param_info info;
    return neutral(!lmn_depiction_param_at(0, 0, P(0, &info)));
}
CALL(lmn_depiction_reference)
{
    return freed(w->null ? NULL : lmn_depiction_reference());
}
CALL(lmn_sheet_write)
{
    uint64_t bytes;
    return lmn_sheet_write(P(0, w->sheet), P(1, FOLDER "/out.svg"), P(2, "svg"), P(3, &bytes), P(4, &w->error));
}
CALL(lmn_format_at)
{
    lmn_format_info info;
    return neutral(!lmn_format_at(0, P(0, &info)));
}
CALL(lmn_sheet_report_json)
{
    return freed(lmn_sheet_report_json(P(0, w->sheet)));
}
CALL(lmn_sheet_warning_count)
{
    return neutral(lmn_sheet_warning_count(P(0, w->sheet)) == 0);
}
CALL(lmn_sheet_warning_at)
{
    const char *code;
    size_t      count;
    return neutral(!lmn_sheet_warning_at(P(0, w->sheet), 0, P(1, &code), P(2, &count)));
}
CALL(lmn_sheet_destroy)
{
    lmn_sheet *none = NULL;
    lmn_sheet_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_scene_add_solid)
{
    NUMBER;
    return lmn_scene_add_solid(P(0, w->scene), P(1, "s"), LMN_UNION, P(2, &number), P(3, &w->error));
}
CALL(lmn_solid_add_operation)
{
    NUMBER;
    return lmn_solid_add_operation(P(0, w->scene), w->solid, LMN_SOLID_ROOT, LMN_UNION, P(1, &number), P(2, &w->error));
}
CALL(lmn_solid_add_shape)
{
    NUMBER;
    return lmn_solid_add_shape(P(0, w->scene), w->solid, LMN_SOLID_ROOT, P(1, w->desc[0]), P(2, &number),
                               P(3, &w->error));
}
CALL(lmn_solid_add_file)
{
    NUMBER;
    return lmn_solid_add_file(P(0, w->scene), w->solid, LMN_SOLID_ROOT, P(1, MODEL), P(2, w->desc[0]), P(3, &number),
                              P(4, &w->error));
}
CALL(lmn_solid_add_copy)
{
    NUMBER;
    return lmn_solid_add_copy(P(0, w->scene), w->solid, LMN_SOLID_ROOT, w->box, P(1, &number), P(2, &w->error));
}
CALL(lmn_solid_set_matrix)
{
    return lmn_solid_set_matrix(P(0, w->scene), w->solid, w->box, P(1, identity), P(2, &w->error));
}
CALL(lmn_solid_set_colour)
{
    static const float red[4] = {1, 0, 0, 1};
    return lmn_solid_set_colour(P(0, w->scene), w->solid, w->box, P(1, red), P(2, &w->error));
}
CALL(lmn_solid_set_operation)
{
    return lmn_solid_set_operation(P(0, w->scene), w->solid, LMN_SOLID_ROOT, LMN_DIFFERENCE, P(1, &w->error));
}
CALL(lmn_solid_set_shape)
{
    return lmn_solid_set_shape(P(0, w->scene), w->solid, w->box, P(1, w->desc[0]), P(2, &w->error));
}
CALL(lmn_solid_set_shown)
{
    return lmn_solid_set_shown(P(0, w->scene), w->solid, w->box, false, P(1, &w->error));
}

CALL(lmn_solid_set_name)
{
    return lmn_solid_set_name(P(0, w->scene), w->solid, w->box, P(1, "b"), P(2, &w->error));
}
CALL(lmn_solid_remove)
{
    return lmn_solid_remove(P(0, w->scene), w->solid, w->box, P(1, &w->error));
}
CALL(lmn_solid_move)
{
    return lmn_solid_move(P(0, w->scene), w->solid, w->box, LMN_SOLID_ROOT, 0, P(1, &w->error));
}
CALL(lmn_scene_solid_count)
{
    return neutral(lmn_scene_solid_count(P(0, w->scene)) == 0);
}
CALL(lmn_scene_solid_at)
{
    return neutral(lmn_scene_solid_at(P(0, w->scene), 0) == 0);
}
CALL(lmn_solid_is_shown)
{
    return neutral(!lmn_solid_is_shown(P(0, w->scene), w->solid, w->box));
}
CALL(lmn_solid_info_of)
{
    lmn_solid_info out;
    return neutral(!lmn_solid_info_of(P(0, w->scene), w->solid, w->box, P(1, &out)));
}
CALL(lmn_strokes_create)
{
    lmn_strokes *made = NULL;
    lmn_status   status = lmn_strokes_create(P(0, &made), P(1, w->desc[0]), P(2, &w->error));
    lmn_strokes_destroy(&made);
    return status;
}
CALL(lmn_strokes_load)
{
    lmn_strokes *made = NULL;
    lmn_status status = lmn_strokes_load(P(0, &made), P(1, LIMNER_SOURCE_DIR "/examples/windows.stx"), P(2, &w->error));
    lmn_strokes_destroy(&made);
    return status;
}
CALL(lmn_strokes_destroy)
{
    lmn_strokes *none = NULL;
    lmn_strokes_destroy(P(0, &none));
    return neutral(!none);
}
CALL(lmn_stroke_pattern_name)
{
    return neutral(w->null != 0 || lmn_stroke_pattern_name(-1) || lmn_stroke_pattern_name(99));
}
CALL(lmn_strokes_count)
{
    return neutral(lmn_strokes_count(P(0, w->strokes)) == 0);
}
CALL(lmn_strokes_get)
{
    lmn_stroke out;
    return lmn_strokes_get(P(0, w->strokes), 0, P(1, &out), P(2, &w->error));
}
CALL(lmn_strokes_set)
{
    static const lmn_stroke stroke = {0, 0, 1, 1, 1, 1, 0};
    return lmn_strokes_set(P(0, w->strokes), 0, P(1, &stroke), P(2, &w->error));
}
CALL(lmn_strokes_set_light)
{
    return lmn_strokes_set_light(P(0, w->strokes), LMN_ORDER_DRAWN, LMN_FRACTION_COUNT, 0, 0, P(1, &w->error));
}
CALL(lmn_strokes_set_perspective)
{
    return lmn_strokes_set_perspective(P(0, w->strokes), LMN_PERSPECTIVE_TIED, 0, P(1, &w->error));
}
CALL(lmn_strokes_write)
{
    return lmn_strokes_write(P(0, w->strokes), P(1, FOLDER "/out.png"), P(2, ".png"), P(3, w->desc[0]),
                             P(4, &w->error));
}
CALL(lmn_task_desc_standard)
{
    return neutral(w->null != 0 || lmn_task_desc_standard().struct_size != sizeof(lmn_task_desc));
}
CALL(lmn_task_begin)
{
    lmn_task  *made = NULL;
    lmn_status status = lmn_task_begin(P(0, &made), P(1, w->desc[0]), P(2, &w->error));
    lmn_task_end(&made);
    return status;
}
CALL(lmn_task_end)
{
    lmn_task *none = NULL;
    lmn_task_end(P(0, &none));
    return neutral(!none);
}
CALL(lmn_fence_kind)
{
    return neutral(w->null != 0 || !lmn_fence_kind());
}
CALL(lmn_file_alloc)
{
    return freed(w->null ? NULL : lmn_file_alloc(1)); /* both are freed by the same function */
}
CALL(lmn_version)
{
    return neutral(w->null != 0 || strcmp(lmn_version(), LMN_VERSION) != 0);
}

/* --- the table ------------------------------------------------------------------------------------------ */

typedef enum answer {
    STATUS = 0, /* LMN_OK when all is given, LMN_USAGE with a message when something is missing */
    VALUE,      /* the same without a message: the function has no lmn_error */
    NEUTRAL,    /* neutral also when all is given */
    REFUSED,    /* LMN_USAGE also when all is given */
    FILM        /* as STATUS; LMN_UNSUPPORTED where no format of films can be made */
} answer;

typedef struct row {
    const char *name;
    lmn_status (*call)(world *w);
    int      pointers;
    unsigned optional; /* bit k: pointer k may be NULL */
    answer   answer;
    struct {
        const void *standard;
        size_t      size;
    } descs[2];
} row;

#define ROW(name, ...)                                                                                                 \
    {                                                                                                                  \
#name, call_##name, __VA_ARGS__                                                                                \
    }
#define DESC(d)                                                                                                        \
    {                                                                                                                  \
        &d, sizeof d                                                                                                   \
    }
enum { A = 1, B = 2, C = 4, D = 8, E = 16, F = 32, G = 64 }; /* the first pointer, the second … */

static const row rows[] = {
#include "null_calls_rows.h"
};
enum { ROWS = sizeof rows / sizeof *rows };

/* --- the table is whole --------------------------------------------------------------------------------- */

static bool has_row(const char *name, size_t length)
{
    for (size_t i = 0; i < ROWS; i++)
        if (strlen(rows[i].name) == length && strncmp(rows[i].name, name, length) == 0)
            return true;
    return false;
}

/* How many functions a header declares; each must have a row. */
static size_t check_header(const char *path)
{
    static char text[1 << 20];
    FILE       *file = fopen(path, "rb");
    size_t      count = 0;
    assert_non_null(file);
    text[fread(text, 1, sizeof text - 1, file)] = 0;
    fclose(file);
    for (const char *at = text; (at = strstr(at, "\nLMN_API ")) != NULL; at++, count++) {
        const char *name = strstr(at, "lmn_"), *open = strchr(at, '(');
        for (const char *next = name; next && open && next < open; next = strstr(next + 1, "lmn_"))
            name = next;
        assert_non_null(open);
        if (!has_row(name, (size_t)(open - name)))
            fail_msg("%s declares %.*s, which has no row in this test", path, (int)(open - name), name);
    }
    return count;
}

static void every_function_has_a_row(void **state)
{
    glob_t found;
    size_t count = 0;
    (void)state;
    assert_int_equal(glob(LIMNER_SOURCE_DIR "/include/limner/*.h", 0, NULL, &found), 0);
    for (size_t i = 0; i < found.gl_pathc; i++)
        count += check_header(found.gl_pathv[i]);
    globfree(&found);
    assert_int_equal(count, ROWS);
}

/* --- running it ----------------------------------------------------------------------------------------- */

static lmn_scene *make_scene(world *w)
{
    lmn_scene    *s = NULL;
    lmn_node_desc node = node_desc;
    assert_int_equal(lmn_scene_create(&s, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_mesh(s, &mesh_desc, &w->mesh, NULL), LMN_OK);
    node.mesh = w->mesh;
    assert_int_equal(lmn_scene_add_node(s, &node, &w->node, NULL), LMN_OK);
    assert_int_equal(lmn_scene_add_solid(s, NULL, LMN_UNION, &w->solid, NULL), LMN_OK);
    assert_int_equal(lmn_solid_add_shape(s, w->solid, LMN_SOLID_ROOT, &shape, &w->box, NULL), LMN_OK);
    return s;
}

static int set_up(void **state)
{
    static const char *const meshes_only =
        "{\"version\":2,\"doc\":\"Meshes.\",\"controls\":{\"weight\":{\"maps\":[{"
        "\"param\":\"lines.width\",\"times\":[0.5,2]}]}},"
        "\"rules\":[{\"select\":\"*\",\"surface\":\"flat\",\"lines\":{\"operator\":\"strokes\",\"ridges\":0.5}}]}";
    static world w;
    mkdir(FOLDER, 0777);
    draw_desc.width = draw_desc.height = SIDE;
    draw_desc.samples = 1;
    draw_desc.maps = draw_desc.lenient = true; /* ridges leave the solid out, with a warning */
    limits = lmn_limits_standard();
    task_desc = lmn_task_desc_standard();
    shape = lmn_shape_box(1, 1, 1);
    w.scene = make_scene(&w);
    if (lmn_renderer_create(&w.renderer, NULL, &w.error) != LMN_OK ||
        lmn_look_parse(&w.look, meshes_only, "meshes", &w.error) != LMN_OK ||
        lmn_draw(&w.drawing, w.renderer, w.scene, w.look, &draw_desc, &w.error) != LMN_OK ||
        lmn_draw_sheet(&w.sheet, NULL, w.scene, w.look, &draw_desc, NULL, &w.error) != LMN_OK)
        fail_msg("%s", w.error.message);
    lmn_scene_destroy(&w.scene); /* drawings and sheets do not need it */
    *state = &w;
    return 0;
}

static int tear_down(void **state)
{
    world *w = *state;
    if (!w)
        return 0;
    lmn_renderer_destroy(&w->renderer);
    lmn_look_destroy(&w->look);
    lmn_drawing_destroy(&w->drawing);
    lmn_sheet_destroy(&w->sheet);
    return 0;
}

/* A description of this struct_size, in memory of just that many bytes, so that sanitizers see who reads further. */
static void *describe(const void *standard, size_t size, size_t struct_size)
{
    size_t least = struct_size < sizeof struct_size ? sizeof struct_size : struct_size;
    char  *made = calloc(1, least);
    assert_non_null(made);
    memcpy(made, standard, size < least ? size : least);
    memcpy(made, &struct_size, sizeof struct_size);
    return made;
}

/* The call with these pointers NULL and, of description `which`, this size. */
static lmn_status run(world *w, const row *r, unsigned null, int which, size_t struct_size)
{
    const lmn_pattern_desc dots = pattern_desc;
    for (int i = 0; i < 2; i++)
        w->desc[i] = r->descs[i].size
                         ? describe(r->descs[i].standard, r->descs[i].size, i == which ? struct_size : r->descs[i].size)
                         : NULL;
    w->scene = make_scene(w);
    assert_int_equal(lmn_strokes_create(&w->strokes, &dots, NULL), LMN_OK);
    w->null = null;
    memset(&w->error, 0, sizeof w->error);
    lmn_status status = r->call(w);
    lmn_strokes_destroy(&w->strokes);
    lmn_scene_destroy(&w->scene);
    free(w->desc[0]);
    free(w->desc[1]);
    return status;
}

static void expect(world *w, const row *r, unsigned null, lmn_status status)
{
    bool       whole = (null & ~r->optional) == 0, refused = r->answer == NEUTRAL || r->answer == REFUSED;
    lmn_status expected = whole && !refused ? LMN_OK : LMN_USAGE;
    bool       tells = r->answer != VALUE && r->answer != NEUTRAL && !(null >> (r->pointers - 1) & 1);
    if (r->answer == FILM && status == LMN_UNSUPPORTED)
        return;
    if (r->answer == VALUE && whole && null && status == LMN_USAGE)
        return; /* nothing was asked for */
    if (status != expected)
        fail_msg("%s with NULL for %#x gives %d (%s) '%s', not %d", r->name, null, (int)status, lmn_status_text(status),
                 w->error.message, (int)expected);
    if (expected != LMN_OK && tells && !w->error.message[0])
        fail_msg("%s with NULL for %#x gives no message", r->name, null);
}

static void null_for_each_pointer(void **state)
{
    world *w = *state;
    for (const row *r = rows; r < rows + ROWS; r++) {
        unsigned all = (1u << r->pointers) - 1;
        expect(w, r, 0, run(w, r, 0, -1, 0));
        for (int k = 0; k < r->pointers; k++)
            expect(w, r, 1u << k, run(w, r, 1u << k, -1, 0));
        expect(w, r, all, run(w, r, all, -1, 0));
    }
}

static void descriptions_of_every_size(void **state)
{
    world *w = *state;
    size_t count = 0;
    for (const row *r = rows; r < rows + ROWS; r++)
        for (int i = 0; i < 2 && r->descs[i].size; i++, count++) {
            const size_t full = r->descs[i].size, sizes[] = {0, 1, sizeof(size_t), full - 1, full + 1, full + 64};
            for (size_t k = 0; k < sizeof sizes / sizeof *sizes; k++) {
                lmn_status status = run(w, r, 0, i, sizes[k]);
                bool       wrong = sizes[k] < sizeof(size_t) || sizes[k] > full;
                /* What a short description lacks keeps its standard, with which the scene may be refused. */
                if (status != LMN_USAGE && (wrong || status == LMN_INTERNAL) && r->answer != FILM)
                    fail_msg("%s with struct_size %zu gives %d '%s'", r->name, sizes[k], (int)status, w->error.message);
                if (status != LMN_OK && !w->error.message[0])
                    fail_msg("%s with struct_size %zu gives no message", r->name, sizes[k]);
            }
        }
    assert_true(count >= 20);
}

/* --- arrays that are not there -------------------------------------------------------------------------- */

static void missing_arrays(void **state)
{
    world            *w = *state;
    const char *const none[] = {NULL};
    lmn_load_desc     load = load_desc;
    lmn_task_desc     conditions = task_desc;
    lmn_task         *task = NULL;
    char             *json = NULL;
    w->scene = make_scene(w);
    for (int i = 0; i < 2; i++) {
        const char *const *texts_given = i ? none : NULL;
        load.defines = texts_given;
        load.define_count = 1;
        assert_int_equal(lmn_scene_add_file(w->scene, LIMNER_SOURCE_DIR "/examples/csg/widget.scad", &load, NULL),
                         LMN_USAGE);
        assert_int_equal(
            lmn_solid_add_file(w->scene, w->solid, 1, LIMNER_SOURCE_DIR "/examples/csg/widget.scad", &load, NULL, NULL),
            LMN_USAGE);
        conditions.allow_paths = texts_given;
        conditions.allow_path_count = 1;
        assert_int_equal(lmn_task_begin(&task, &conditions, &w->error), LMN_USAGE);
        assert_null(task);
        assert_int_equal(lmn_bench_json(&json, w->renderer, w->scene, texts_given, 1, &draw_desc, 1, NULL), LMN_USAGE);
        assert_null(json);
    }
    conditions = task_desc;
    conditions.limits.struct_size = 1;
    assert_int_equal(lmn_task_begin(&task, &conditions, NULL), LMN_USAGE);
    assert_int_equal(lmn_drawing_pick_parts(w->drawing, 0, 0, 4, 4, NULL, 0, &(size_t){0}, NULL), LMN_OK);
    assert_int_equal(lmn_scene_set_instances(w->scene, w->node, NULL, 0, NULL), LMN_OK);
    lmn_scene_destroy(&w->scene);
}

static void missing_arrays_of_meshes_and_shapes(void **state)
{
    static const lmn_shape_kind kinds[] = {LMN_SHAPE_POLYHEDRON, LMN_SHAPE_EXTRUSION, LMN_SHAPE_REVOLUTION};
    world                      *w = *state;
    lmn_mesh_desc               mesh = LMN_MESH_DESC_INIT;
    w->scene = make_scene(w);
    for (int i = 0; i < 3; i++) {
        lmn_shape s = lmn_shape_of(kinds[i]);
        s.height = s.angle = 1;
        s.profile_count = s.contour_count = s.point_count = s.face_count = 4;
        assert_int_equal(lmn_solid_add_shape(w->scene, w->solid, 1, &s, NULL, NULL), LMN_USAGE);
    }
    mesh.vertex_count = 3;
    assert_int_equal(lmn_scene_add_mesh(w->scene, &mesh, NULL, NULL), LMN_USAGE);
    mesh.positions = corners;
    mesh.index_count = 3;
    assert_int_equal(lmn_scene_add_mesh(w->scene, &mesh, NULL, NULL), LMN_USAGE);
    mesh.index_count = 0;
    mesh.line_index_count = 2;
    assert_int_equal(lmn_scene_add_mesh(w->scene, &mesh, NULL, NULL), LMN_USAGE);
    mesh.line_index_count = 0;
    mesh.weights = corners;
    assert_int_equal(lmn_scene_add_mesh(w->scene, &mesh, NULL, NULL), LMN_USAGE);
    lmn_scene_destroy(&w->scene);
}

/* --- makers that have ended ----------------------------------------------------------------------------- */

static void read_drawing(const lmn_drawing *d, const lmn_sheet *s)
{
    float    depth[SIDE * SIDE];
    lmn_pick pick;
    char    *report = lmn_drawing_report_json(d), *sheet_report = lmn_sheet_report_json(s);
    assert_non_null(report);
    assert_non_null(sheet_report);
    lmn_text_free(report);
    lmn_text_free(sheet_report);
    assert_int_equal(lmn_drawing_copy_map(d, LMN_MAP_DEPTH, depth, (size_t)SIDE * SIDE, NULL), LMN_OK);
    assert_int_equal(lmn_drawing_pick(d, SIDE / 2, SIDE / 2, &pick, NULL), LMN_OK);
    assert_int_equal(pick.part, 1);
    for (size_t i = 0; i < lmn_drawing_warning_count(d); i++)
        assert_non_null(lmn_drawing_warning_at(d, i, NULL, NULL));
    assert_int_equal(lmn_drawing_write(d, FOLDER "/orphan.png", NULL, NULL, NULL), LMN_OK);
    assert_int_equal(lmn_drawing_write_maps(d, FOLDER "/orphan", NULL), LMN_OK);
    assert_int_equal(lmn_sheet_write(s, FOLDER "/orphan.svg", NULL, NULL, NULL), LMN_OK);
}

/* Scene, look and renderer end in each order before drawing and sheet are read. */
static void drawings_outlive_their_makers(void **state)
{
    (void)state;
    for (int order = 0; order < 3; order++) {
        lmn_scene    *scene = NULL;
        lmn_look     *look = NULL;
        lmn_renderer *renderer = NULL;
        lmn_drawing  *drawing = NULL;
        lmn_sheet    *sheet = NULL;
        assert_int_equal(lmn_renderer_create(&renderer, NULL, NULL), LMN_OK);
        assert_int_equal(lmn_scene_create(&scene, NULL), LMN_OK);
        assert_int_equal(lmn_scene_add_file(scene, MODEL, NULL, NULL), LMN_OK);
        assert_int_equal(lmn_look_load(&look, "technical", NULL), LMN_OK);
        assert_int_equal(lmn_draw(&drawing, renderer, scene, look, &draw_desc, NULL), LMN_OK);
        assert_int_equal(lmn_draw_sheet(&sheet, renderer, scene, look, &draw_desc, NULL, NULL), LMN_OK);
        for (int i = 0; i < 3; i++) {
            if ((order + i) % 3 == 0)
                lmn_scene_destroy(&scene);
            if ((order + i) % 3 == 1)
                lmn_look_destroy(&look);
            if ((order + i) % 3 == 2)
                lmn_renderer_destroy(&renderer);
            read_drawing(drawing, sheet);
        }
        lmn_drawing_destroy(&drawing);
        lmn_sheet_destroy(&sheet);
    }
}

/* A renderer keeps what it has made of a scene: that must not be found by the next scene, wherever that lies. */
static void renderers_outlive_their_scenes(void **state)
{
    world   *w = *state;
    uint8_t *first = NULL;
    for (int i = 0; i < 3; i++) {
        lmn_drawing *d = NULL;
        w->scene = make_scene(w);
        if (i == 1) /* not MODEL, which is the box that is there */
            assert_int_equal(lmn_scene_add_file(w->scene, LIMNER_SOURCE_DIR "/examples/knot.glb", NULL, NULL), LMN_OK);
        assert_int_equal(lmn_draw(&d, w->renderer, w->scene, w->look, &draw_desc, NULL), LMN_OK);
        lmn_scene_destroy(&w->scene);
        if (i == 0) {
            first = malloc(sizeof pixels);
            assert_non_null(first);
            memcpy(first, lmn_drawing_pixels(d, NULL, NULL), sizeof pixels);
        } else if (i == 1)
            assert_memory_not_equal(first, lmn_drawing_pixels(d, NULL, NULL), sizeof pixels);
        else
            assert_memory_equal(first, lmn_drawing_pixels(d, NULL, NULL), sizeof pixels);
        lmn_drawing_destroy(&d);
    }
    free(first);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(every_function_has_a_row),
        cmocka_unit_test(null_for_each_pointer),
        cmocka_unit_test(descriptions_of_every_size),
        cmocka_unit_test(missing_arrays),
        cmocka_unit_test(missing_arrays_of_meshes_and_shapes),
        cmocka_unit_test(drawings_outlive_their_makers),
        cmocka_unit_test(renderers_outlive_their_scenes),
    };
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
