/* Loads files and says what came of it: `load [-t] [-j] FILE…`. -t times each load and making normals, -j prints
 * the info. */
#include <stdio.h>
#include <string.h>
#include <time.h>

#include "limner/scene.h"
#include "scene/mesh.h"

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec * 1e-6;
}

static void time_meshes(const lmn_scene *s)
{
    double   start = now_ms();
    uint32_t vertices = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++) {
            render_vertices r;
            if (mesh_make_normals(&r, &s->meshes[i].primitives[k], 0.7, NULL) == LMN_OK)
                vertices += r.vertex_count;
            render_vertices_release(&r);
        }
    double middle = now_ms();
    for (size_t i = 0; i < s->mesh_count; i++)
        for (size_t k = 0; k < s->meshes[i].primitive_count; k++) {
            uint32_t *adjacent = mesh_adjacency(&s->meshes[i].primitives[k]);
            lmn_text_free((char *)adjacent);
        }
    printf("    normals %.1f ms (%u vertices), adjacency %.1f ms\n", middle - start, vertices, now_ms() - middle);
}

static int load(const char *path, bool timed, bool json)
{
    lmn_scene *scene = NULL;
    lmn_error  error = {0};
    double     start = now_ms();
    lmn_status status = lmn_scene_create(&scene, &error);
    if (status == LMN_OK)
        status = lmn_scene_add_file(scene, path, NULL, &error);
    double         ms = now_ms() - start;
    lmn_scene_info info = lmn_scene_info_of(scene);
    if (status == LMN_OK)
        printf("ok    %s: %zu parts, %llu triangles, %zu materials, %zu textures, %zu animations, %zu skins\n", path,
               info.parts, (unsigned long long)info.triangles, info.materials, info.textures, info.animations,
               info.skins);
    else
        printf("FAIL  %s: [%s] %s:%d: %s (%s)\n", path, lmn_status_text(status), error.file, error.line, error.message,
               error.hint);
    if (status == LMN_OK && timed) {
        printf("    load %.1f ms\n", ms);
        time_meshes(scene);
    }
    if (status == LMN_OK)
        for (size_t i = 0; i < scene->warnings.count; i++)
            printf("    warning: %s (%zu)\n", scene->warnings.items[i].text, scene->warnings.items[i].count);
    if (status == LMN_OK && json) {
        char *text = lmn_scene_info_json(scene);
        puts(text);
        lmn_text_free(text);
    }
    lmn_scene_destroy(&scene);
    return status != LMN_OK;
}

int main(int count, char **arguments)
{
    bool timed = false, json = false;
    int  failed = 0;
    for (int i = 1; i < count; i++) {
        if (strcmp(arguments[i], "-t") == 0)
            timed = true;
        else if (strcmp(arguments[i], "-j") == 0)
            json = true;
        else
            failed += load(arguments[i], timed, json);
    }
    return failed ? 2 : 0;
}
