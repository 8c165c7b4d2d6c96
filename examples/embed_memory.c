/* A scene from memory, as a picture and as vectors: embed_memory OUT.png OUT.svg */
#include <limner/limner.h>
#include <stdio.h>

/* A pyramid with a square base, in millimetres, +Y up. */
static const float    corners[] = {-10, 0, -10, 10, 0, -10, 10, 0, 10, -10, 0, 10, 0, 15, 0};
static const uint32_t triangles[] = {0, 1, 2, 0, 2, 3, 0, 4, 1, 1, 4, 2, 2, 4, 3, 3, 4, 0};

/* The mesh once, drawn at two positions. */
static lmn_status fill(lmn_scene *scene, lmn_error *error)
{
    lmn_material_desc material = LMN_MATERIAL_DESC_INIT;
    lmn_mesh_desc     mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc     node = LMN_NODE_DESC_INIT;
    material.colour[2] = 0.4f;
    mesh.positions = corners;
    mesh.vertex_count = 5;
    mesh.indices = triangles;
    mesh.index_count = 18;
    lmn_status status = lmn_scene_add_material(scene, &material, &mesh.material, error);
    if (status == LMN_OK)
        status = lmn_scene_add_mesh(scene, &mesh, &node.mesh, error);
    for (int i = 0; i < 2 && status == LMN_OK; i++) {
        node.name = i ? "right" : "left";
        node.matrix[12] = i ? 15 : -15; /* along x */
        status = lmn_scene_add_node(scene, &node, NULL, error);
    }
    return status;
}

int main(int count, char **arguments)
{
    lmn_error     error = {0};
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_renderer *renderer = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_sheet    *sheet = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = 320, desc.height = 240;
    lmn_status status = count == 3 ? lmn_scene_create(&scene, &error) : LMN_USAGE;
    if (status == LMN_OK && (status = fill(scene, &error)) == LMN_OK)
        status = lmn_look_load(&look, "technical", &error);
    if (status == LMN_OK && (status = lmn_renderer_create(&renderer, NULL, &error)) == LMN_OK)
        status = lmn_draw(&drawing, renderer, scene, look, &desc, &error);
    if (status == LMN_OK && (status = lmn_drawing_write(drawing, arguments[1], NULL, NULL, &error)) == LMN_OK)
        status = lmn_draw_sheet(&sheet, renderer, scene, look, &desc, NULL, &error);
    if (status == LMN_OK)
        status = lmn_sheet_write(sheet, arguments[2], NULL, NULL, &error);
    if (status != LMN_OK)
        fprintf(stderr, "%s %s\n%s\n", error.file, error.message, error.hint);
    lmn_sheet_destroy(&sheet);
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&renderer);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    return status != LMN_OK;
}
