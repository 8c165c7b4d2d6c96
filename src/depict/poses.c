/* Poses of the scene, kept for as long as glyphs are made: most of them are of the same few moments. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "depict/depict_private.h"

lmn_status depict_pose(const pose **out, const depict_job *j, double seconds, lmn_error *error)
{
    depict_poses *kept = j->poses;
    for (size_t i = 0; i < kept->count; i++)
        if (kept->at[i].when.seconds == seconds) {
            *out = &kept->at[i];
            return LMN_OK;
        }
    moment when = j->when;
    when.seconds = seconds;
    pose      *place = &kept->at[kept->count < DEPICT_POSES ? kept->count : kept->next];
    const bool full = kept->count == DEPICT_POSES;
    if (full) {
        pose_release(place);
        kept->next = (kept->next + 1) % DEPICT_POSES;
    }
    lmn_status status = pose_create(place, j->scene, &when, error);
    if (status != LMN_OK) {
        pose_release(place);
        /* What is behind it takes its place. */
        if (full) {
            *place = kept->at[DEPICT_POSES - 1];
            kept->count--;
            kept->next = 0;
        }
        return status;
    }
    kept->count += !full;
    *out = place;
    return LMN_OK;
}

const mat4 *depict_worlds_at_rest(const depict_job *j)
{
    if (!j->poses->worlds)
        j->poses->worlds = scene_world_matrices(j->scene, NULL);
    return j->poses->worlds;
}

void depict_poses_release(depict_poses *kept)
{
    for (size_t i = 0; i < kept->count; i++)
        pose_release(&kept->at[i]);
    mem_free(kept->worlds);
    memset(kept, 0, sizeof *kept);
}
