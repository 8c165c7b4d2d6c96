#include "contact/contact.h"

#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/vector3.h"
#include "contact/surface.h"
#include "scene/content.h"

static bool is_below(const lmn_scene *s, int32_t node_index, int32_t above)
{
    while (node_index != NONE && node_index != above)
        node_index = s->nodes[node_index].parent;
    return node_index != NONE;
}

lmn_status contact_sides_find(contact_sides *out, const lmn_scene *s, int32_t node_index, lmn_error *error)
{
    box3 box = box3_empty();
    *out =
        (contact_sides){mem_calloc(s->part_count + 1, sizeof(bool)), mem_calloc(s->part_count + 1, sizeof(bool)), 0, 0};
    mat4 *worlds = scene_world_matrices(s, NULL);
    if (!out->own || !out->others || !worlds) {
        mem_free(worlds);
        return error_memory(error);
    }
    for (size_t i = 0; i < s->part_count; i++) {
        int32_t own = s->parts[i].node;
        out->own[i] = is_below(s, own, node_index);
        out->others[i] = !out->own[i] && !scene_is_hidden(s, own);
        if (out->own[i])
            box = box3_union(box, part_bounds(s, worlds, i));
    }
    mem_free(worlds);
    out->radius = box3_is_empty(box) ? 0 : box3_diagonal(box) / (2 * sqrt(3));
    out->reach = 0.1 * out->radius;
    return LMN_OK;
}

void contact_sides_release(contact_sides *s)
{
    mem_free(s->own);
    mem_free(s->others);
    memset(s, 0, sizeof *s);
}

/* A contact of what has been found in the motion. */
static lmn_status meet(contact *c, const contact_sides *sides, pose *posed, const moment *clips, const lmn_scene *scene,
                       bool *is_posed, lmn_error *error)
{
    moment     when = *clips;
    bool       found = false;
    lmn_status status;
    when.seconds = fmin(fmax(c->hit.seconds, 0), moment_duration(&when, scene));
    status = *is_posed ? pose_move(posed, &when, error) : pose_create(posed, scene, &when, error);
    *is_posed = true;
    if (status == LMN_OK)
        status = surface_outermost(c->hit.place, &found, posed, sides->own, c->hit.normal, 1e-5 * sides->radius, error);
    surface_place there;
    bool          met = false;
    if (status == LMN_OK && found)
        status = surface_nearest(&there, &met, posed, sides->others, c->hit.place, sides->reach, error);
    if (status == LMN_OK && met) {
        c->other = scene->parts[there.part].node;
        c->distance = there.distance;
    }
    return status;
}

lmn_status contacts_find(contact **out, size_t *count, const schedule *s, const moment *clips, int32_t node_index,
                         double from, double to, double least, lmn_error *error)
{
    impact       *hits = NULL;
    contact_sides sides = {NULL};
    pose          posed;
    bool          is_posed = false;
    size_t        kept = 0;
    *out = NULL;
    *count = 0;
    lmn_status status = impacts_find(&hits, count, s, node_index, from, to, least, error);
    if (status == LMN_OK && *count > 0) {
        *out = mem_calloc(*count, sizeof **out);
        status = *out ? contact_sides_find(&sides, s->scene, node_index, error) : error_memory(error);
    }
    for (size_t i = 0; i < *count && status == LMN_OK; i++) {
        contact *c = &(*out)[kept];
        *c = (contact){hits[i], NONE, 0};
        status = meet(c, &sides, &posed, clips, s->scene, &is_posed, error);
        kept += c->other != NONE || !(hits[i].sets_off || hits[i].stops);
    }
    *count = kept;
    if (is_posed)
        pose_release(&posed);
    contact_sides_release(&sides);
    mem_free(hits);
    if (status != LMN_OK) {
        mem_free(*out);
        *out = NULL;
        *count = 0;
    }
    return status;
}

lmn_status schedule_of_moment(schedule *out, moment *clips, const lmn_scene *scene, const char *names, lmn_error *error)
{
    const struct behaviour *b = scene->behaviour;
    const bool              behaves = !names && b && b->root_count && b->written != NONE;
    *out = (schedule){.scene = scene};
    *clips = moment_at_rest();
    if (behaves)
        clips->clips[clips->clip_count++] = (uint32_t)b->written;
    lmn_status status = behaves ? LMN_OK : moment_find(clips, scene, names, 0, NULL, error);
    if (status != LMN_OK)
        return status;
    return behaves ? schedule_create(out, scene, error)
                   : schedule_of_clips(out, scene, clips->clips, clips->clip_count, error);
}
