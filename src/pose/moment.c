#include "pose/moment.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/text.h"
#include "scene/behaviour.h"

moment moment_at_rest(void)
{
    moment m;
    memset(&m, 0, sizeof m);
    return m;
}

bool moment_equal(const moment *a, const moment *b)
{
    return memcmp(a, b, sizeof *a) == 0;
}

double moment_duration(const moment *m, const lmn_scene *scene)
{
    double longest = 0;
    for (size_t i = 0; i < m->clip_count; i++)
        longest = fmax(longest, scene->animations[m->clips[i]].duration);
    return longest;
}

static lmn_status add_clip(moment *m, size_t index, lmn_error *error)
{
    for (size_t i = 0; i < m->clip_count; i++)
        if (m->clips[i] == index)
            return LMN_OK;
    if (m->clip_count == CLIPS_AT_ONCE)
        return error_set(error, LMN_USAGE, "more than %d clips at once", CLIPS_AT_ONCE);
    m->clips[m->clip_count++] = (uint32_t)index;
    return LMN_OK;
}

static const char *file_of(const lmn_scene *scene)
{
    return scene->file_count ? scene->files[0] : NULL;
}

static lmn_status refuse_clip(const lmn_scene *scene, const char *name, int size, lmn_error *error)
{
    enum { NAMES_MAX = 64 };
    const char *names[NAMES_MAX];
    size_t      count = 0;
    char        wanted[128];
    for (size_t i = 0; i < scene->animation_count && count < NAMES_MAX; i++)
        if (scene->animations[i].name)
            names[count++] = scene->animations[i].name;
    snprintf(wanted, sizeof wanted, "%.*s", size < 100 ? size : 100, name);
    lmn_status  status = error_in_file(error, LMN_USAGE, file_of(scene), 0, "the model has no clip '%s'", wanted);
    const char *nearest = text_nearest(wanted, names, count);
    if (nearest)
        error_hint(error, "did you mean '%s'?", nearest);
    else if (count)
        error_hint(error, "it has '%s'%s; `limner info` lists them", names[0], count > 1 ? " and others" : "");
    else
        error_hint(error, "its clips have no names: take a number from 1 to %zu", scene->animation_count);
    return status;
}

/* All clips of a name; else that of a number. */
static lmn_status add_clips(moment *m, const lmn_scene *scene, const char *name, size_t size, lmn_error *error)
{
    lmn_status status = LMN_OK;
    size_t     found = 0;
    for (size_t i = 0; i < scene->animation_count && status == LMN_OK; i++) {
        const char *own = scene->animations[i].name;
        if (!own || strlen(own) != size || memcmp(own, name, size) != 0)
            continue;
        status = add_clip(m, i, error);
        found++;
    }
    size_t number = 0;
    for (size_t i = 0; i < size && name[i] >= '0' && name[i] <= '9' && number <= scene->animation_count; i++)
        number = i + 1 <= size ? number * 10 + (size_t)(name[i] - '0') : 0;
    bool digits = size > 0 && strspn(name, "0123456789") >= size;
    if (status == LMN_OK && !found && digits && number >= 1 && number <= scene->animation_count) {
        status = add_clip(m, number - 1, error);
        found++;
    }
    return status == LMN_OK && !found ? refuse_clip(scene, name, (int)(size < 1000 ? size : 1000), error) : status;
}

/* A whole name may hold commas; else they separate. */
static lmn_status add_list(moment *m, const lmn_scene *scene, const char *clips, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < scene->animation_count; i++)
        if (scene->animations[i].name && strcmp(scene->animations[i].name, clips) == 0)
            return add_clips(m, scene, clips, strlen(clips), error);
    while (status == LMN_OK) {
        size_t size = strcspn(clips, ",");
        status = add_clips(m, scene, clips, size, error);
        if (!clips[size])
            break;
        clips += size + 1;
    }
    return status;
}

/* Times of frames are rounded: what is hardly outside is at the end. */
static void bring_within(moment *m, const lmn_scene *scene, warnings *warnings)
{
    const double HARDLY = 1e-5;
    double       end = moment_duration(m, scene), wanted = m->seconds;
    m->seconds = fmin(fmax(m->seconds, 0), end);
    if (fabs(m->seconds - wanted) > HARDLY && warnings)
        warnings_add(warnings, WARNING_BAD_VALUE, "the clip runs from 0 to %g s: %s are drawn as its %s", end,
                     wanted < 0 ? "times before" : "later times", wanted < 0 ? "begin" : "end");
    if (m->seconds == 0)
        m->seconds = 0; /* not −0, whose bytes differ */
}

/* The outermost node of what a clip moves, of its first channel that moves one; NONE. Each file has its own. */
static int32_t root_of(const lmn_scene *scene, const animation *clip)
{
    for (size_t k = 0; k < clip->channel_count; k++) {
        int32_t at = clip->channels[k].target;
        if (animation_thing_of(clip->channels[k].path) != ANIMATED_NODE)
            continue;
        while (scene->nodes[at].parent != NONE)
            at = scene->nodes[at].parent;
        return at;
    }
    return NONE;
}

/* Does the scene's behaviour move something of a file's clip? Then it has that clip as an activity, or instead of it.
 */
static bool behaviour_moves(const lmn_scene *scene, size_t clip)
{
    int32_t written = scene->behaviour ? scene->behaviour->written : NONE, root;
    if (written == NONE || (size_t)written == clip)
        return false;
    root = root_of(scene, &scene->animations[clip]);
    const animation *a = &scene->animations[written];
    for (size_t k = 0; k < a->channel_count; k++) {
        int32_t at = animation_thing_of(a->channels[k].path) == ANIMATED_NODE ? a->channels[k].target : NONE;
        while (at != NONE && scene->nodes[at].parent != NONE)
            at = scene->nodes[at].parent;
        if (at != NONE && at == root)
            return true;
    }
    return false;
}

/* The behaviour, and the first clip of each file that it leaves alone, as far as there may be so many. */
static void add_first_clips(moment *m, const lmn_scene *scene)
{
    for (size_t i = 0; i < scene->animation_count && m->clip_count < CLIPS_AT_ONCE; i++) {
        int32_t root = root_of(scene, &scene->animations[i]);
        bool    known = (i > 0 && root == NONE && !(scene->behaviour && scene->behaviour->written == (int32_t)i)) ||
                     behaviour_moves(scene, i);
        for (size_t k = 0; k < m->clip_count; k++)
            known = known || root_of(scene, &scene->animations[m->clips[k]]) == root;
        if (!known)
            m->clips[m->clip_count++] = (uint32_t)i;
    }
}

lmn_status moment_find(moment *out, const lmn_scene *scene, const char *clips, double seconds, warnings *warnings,
                       lmn_error *error)
{
    *out = moment_at_rest();
    lmn_status status = LMN_OK;
    if (clips && scene->animation_count == 0)
        return error_in_file(error, LMN_USAGE, file_of(scene), 0, "clip '%.100s': the model has no animation", clips);
    if (clips)
        status = add_list(out, scene, clips, error);
    else
        add_first_clips(out, scene);
    if (status != LMN_OK || !out->clip_count)
        return status;
    out->seconds = seconds;
    bring_within(out, scene, warnings);
    return LMN_OK;
}
