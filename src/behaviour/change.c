#include "behaviour/change.h"

#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "behaviour/clip.h"

lmn_status behaviour_put(lmn_scene *scene, int32_t index, const behaviour_node *wanted, int32_t *out, lmn_error *error)
{
    bool    added = index == NONE;
    int32_t at = added ? behaviour_append(scene, wanted->kind) : index;
    if (at == NONE)
        return error_memory(error);
    struct behaviour    *b = scene->behaviour;
    const behaviour_node before = b->nodes[at];
    b->nodes[at] = *wanted;
    lmn_status status = behaviour_check(scene, b, at, error);
    /* Nothing leads to what is new. */
    if (status == LMN_OK && !added && b->root_count > 0)
        status = behaviour_write_clip(scene, b->written, error);
    if (status != LMN_OK) {
        scene->behaviour->nodes[at] = before;
        if (added)
            behaviour_take_back(scene);
        return status;
    }
    behaviour_node old = before;
    behaviour_node_release(&old);
    scene->revision = scene_next_revision();
    if (out)
        *out = at;
    return LMN_OK;
}

/* The animation to be written, made where there is none; NONE when memory is gone. */
static int32_t find_clip(lmn_scene *scene)
{
    if (scene->behaviour->written != NONE)
        return scene->behaviour->written;
    char      *name = mem_copy_text("behaviour");
    animation *a = name ? scene_append_animation(scene) : NULL;
    if (!a) {
        mem_free(name);
        return NONE;
    }
    a->name = name;
    return (int32_t)scene->animation_count - 1;
}

lmn_status behaviour_play(lmn_scene *scene, const int32_t *roots, size_t count, lmn_error *error)
{
    struct behaviour *b = scene->behaviour;
    int32_t          *wanted = mem_copy(roots, count * sizeof *roots), *before = b->roots;
    const size_t      count_before = b->root_count, capacity_before = b->root_capacity;
    const int32_t     clip = wanted ? find_clip(scene) : NONE;
    if (clip == NONE) {
        mem_free(wanted);
        return error_memory(error);
    }
    const bool made = b->written == NONE;
    b->roots = wanted;
    b->root_count = b->root_capacity = count;
    lmn_status status = behaviour_write_clip(scene, clip, error);
    if (status == LMN_OK) {
        mem_free(before);
        scene->revision = scene_next_revision();
        return LMN_OK;
    }
    mem_free(wanted);
    b->roots = before;
    b->root_count = count_before;
    b->root_capacity = capacity_before;
    if (made) {
        mem_free(scene->animations[clip].name);
        scene->animation_count--;
    }
    return status;
}

void behaviour_stop(lmn_scene *scene)
{
    struct behaviour *b = scene->behaviour;
    if (!b || b->written == NONE)
        return;
    const size_t written = (size_t)b->written;
    scene_remove_animation(scene, written);
    for (size_t i = 0; i < b->node_count; i++)
        b->nodes[i].clip -= b->nodes[i].clip != NONE && (size_t)b->nodes[i].clip > written;
    b->written = NONE;
    b->root_count = 0;
    scene->revision = scene_next_revision();
}
