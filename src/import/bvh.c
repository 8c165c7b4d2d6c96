/* BVH, motion capture as text: a hierarchy of joints, and for each frame the numbers of all channels on one line. */
#include <math.h>
#include <string.h>
#include <strings.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/build.h"
#include "import/bvh.h"

static const double NUMBER_MAX = 1e30, FRAME_SECONDS_MAX = 86400;

typedef struct bvh_reader {
    const import_job *job;
    const char       *begin, *at, *end;
    bvh_skeleton      skeleton;
    lmn_error        *error;
} bvh_reader;

/* --- words ---------------------------------------------------------------------------------------------- */

static bool is_blank(char c)
{
    return c == ' ' || c == '\t' || c == '\r' || c == '\n' || c == '\v' || c == '\f';
}

static void skip_blanks(bvh_reader *r)
{
    while (r->at < r->end && is_blank(*r->at))
        r->at++;
}

static bool ends_word(char c)
{
    return is_blank(c) || c == '{' || c == '}' || c == ':';
}

/* How long the next word is; braces and colons are words. */
static size_t word_length(const bvh_reader *r)
{
    const char *p = r->at;
    while (p < r->end && !ends_word(*p))
        p++;
    if (p == r->at && p < r->end)
        p++;
    return (size_t)(p - r->at);
}

/* Takes the word in any case. */
static bool take(bvh_reader *r, const char *word)
{
    skip_blanks(r);
    size_t length = strlen(word);
    if (word_length(r) != length || strncasecmp(r->at, word, length) != 0)
        return false;
    r->at += length;
    return true;
}

static lmn_status wrong(bvh_reader *r, const char *expected)
{
    skip_blanks(r);
    int line = build_line(r->begin, r->at);
    if (r->at == r->end) {
        error_in_file(r->error, LMN_FORMAT, r->job->path, line, "the file is cut off: expected %s", expected);
        error_hint(r->error, "copy or export the file again");
        return LMN_FORMAT;
    }
    size_t length = word_length(r);
    char  *found = scene_clean_name(r->at, length < 24 ? length : 24);
    error_in_file(r->error, LMN_FORMAT, r->job->path, line, "expected %s, found \"%s\"", expected, found ? found : "");
    mem_free(found);
    return LMN_FORMAT;
}

static lmn_status over_limit(const bvh_reader *r, const char *what, size_t limit)
{
    return error_in_file(r->error, LMN_LIMIT, r->job->path, build_line(r->begin, r->at), "more than %zu %s", limit,
                         what);
}

/* A number that is a word and that single precision holds. */
static bool take_number(bvh_reader *r, double *out)
{
    skip_blanks(r);
    const char *next = text_parse_double(r->at, r->end, out);
    if (!next || !(fabs(*out) <= NUMBER_MAX) || (next < r->end && !ends_word(*next)))
        return false;
    r->at = next;
    return true;
}

static bool take_count(bvh_reader *r, long long most, long long *out)
{
    skip_blanks(r);
    const char *next = text_parse_int(r->at, r->end, out);
    if (!next || *out < 0 || *out > most || (next < r->end && !ends_word(*next)))
        return false;
    r->at = next;
    return true;
}

/* --- hierarchy ------------------------------------------------------------------------------------------ */

/* What is left of the line, up to a brace: names may hold blanks. NULL in *out when there is nothing. */
static lmn_status read_name(bvh_reader *r, char **out)
{
    const char *from = r->at, *to;
    *out = NULL;
    while (r->at < r->end && *r->at != '\n' && *r->at != '\r' && *r->at != '{')
        r->at++;
    for (to = r->at; to > from && is_blank(to[-1]);)
        to--;
    while (from < to && is_blank(*from))
        from++;
    if (from == to)
        return LMN_OK;
    *out = scene_clean_name(from, (size_t)(to - from));
    return *out ? LMN_OK : error_memory(r->error);
}

/* "OFFSET x y z", and of joints "CHANNELS n word…", behind the brace. */
static lmn_status read_offset(bvh_reader *r, bvh_joint *j)
{
    if (!take(r, "{"))
        return wrong(r, "\"{\"");
    if (!take(r, "OFFSET"))
        return wrong(r, "\"OFFSET\"");
    for (int i = 0; i < 3; i++)
        if (!take_number(r, &j->offset[i]))
            return wrong(r, "three numbers after \"OFFSET\"");
    return LMN_OK;
}

static bool take_channel(bvh_reader *r, unsigned char *out)
{
    static const char *const names[] = {"Xposition", "Yposition", "Zposition", "Xrotation", "Yrotation", "Zrotation"};
    for (unsigned char i = 0; i < 6; i++)
        if (take(r, names[i])) {
            *out = i;
            return true;
        }
    return false;
}

/* A position may stand once for each axis; rotations are done one after the other, whatever their axes. */
static bool is_position_twice(const bvh_joint *j, int count)
{
    for (int i = 0; i < count; i++)
        if (j->channels[i] < BVH_X_ROTATION && j->channels[i] == j->channels[count])
            return true;
    return false;
}

static lmn_status read_channels(bvh_reader *r, bvh_joint *j)
{
    long long count = 0;
    if (!take(r, "CHANNELS"))
        return LMN_OK;
    if (!take_count(r, BVH_CHANNELS_MAX, &count))
        return wrong(r, "a number of channels from 0 to 6");
    for (int i = 0; i < (int)count; i++) {
        if (!take_channel(r, &j->channels[i]))
            return wrong(r, "a channel (Xposition … Zrotation)");
        if (is_position_twice(j, i))
            return error_in_file(r->error, LMN_FORMAT, r->job->path, build_line(r->begin, r->at),
                                 "a joint has a position channel twice");
    }
    j->channel_count = (int)count;
    r->skeleton.channel_count += (size_t)count;
    return LMN_OK;
}

static lmn_status read_joint(bvh_reader *r, int32_t parent, bool is_end)
{
    bvh_skeleton *s = &r->skeleton;
    /* Each joint takes two nodes, its own and that of a bone. */
    if (s->count >= LIMIT_NODES / 2)
        return over_limit(r, "joints", LIMIT_NODES / 2);
    if (!mem_grow((void **)&s->joints, &s->capacity, s->count + 1, sizeof *s->joints))
        return error_memory(r->error);
    bvh_joint *j = &s->joints[s->count++];
    *j = (bvh_joint){.parent = parent, .is_end = is_end, .node = NONE};
    lmn_status status = read_name(r, &j->name);
    if (status == LMN_OK && is_end) {
        mem_free(j->name);
        j->name = NULL;
    }
    if (status == LMN_OK)
        status = read_offset(r, j);
    return status == LMN_OK && !is_end ? read_channels(r, j) : status;
}

/* One root with all that is in its braces. */
static lmn_status read_root(bvh_reader *r)
{
    lmn_status status = read_joint(r, NONE, false);
    int32_t    current = (int32_t)r->skeleton.count - 1;
    int        depth = 1;
    while (status == LMN_OK && current != NONE) {
        if (take(r, "}")) {
            current = r->skeleton.joints[current].parent;
            depth--;
            continue;
        }
        bool is_end = !take(r, "JOINT");
        if (r->skeleton.joints[current].is_end || (is_end && !take(r, "End")))
            return wrong(r, r->skeleton.joints[current].is_end ? "\"}\"" : "\"JOINT\", \"End Site\" or \"}\"");
        /* Below the deepest joint there is room for a bone and, when the file is merged, above the root for one. */
        if (++depth > LIMIT_NODE_DEPTH - 2)
            return over_limit(r, "joints below each other", LIMIT_NODE_DEPTH - 2);
        status = read_joint(r, current, is_end);
        current = (int32_t)r->skeleton.count - 1;
    }
    return status;
}

static lmn_status read_hierarchy(bvh_reader *r)
{
    if (!take(r, "HIERARCHY"))
        return wrong(r, "\"HIERARCHY\"");
    if (!take(r, "ROOT"))
        return wrong(r, "\"ROOT\"");
    lmn_status status = read_root(r);
    while (status == LMN_OK && take(r, "ROOT"))
        status = read_root(r);
    return status;
}

/* --- motion --------------------------------------------------------------------------------------------- */

/* "Frames: 60" and "Frame Time: 0.0333". A single frame needs no length. */
static lmn_status read_motion_head(bvh_reader *r, long long *frames, double *frame_time)
{
    if (!take(r, "Frames") || !take(r, ":"))
        return wrong(r, "\"Frames:\"");
    if (!take_count(r, INT32_MAX, frames))
        return wrong(r, "how many frames there are");
    if (!take(r, "Frame") || !take(r, "Time") || !take(r, ":"))
        return wrong(r, "\"Frame Time:\"");
    const char *number = r->at;
    if (take_number(r, frame_time) && *frame_time <= FRAME_SECONDS_MAX &&
        (*frame_time > 0 || (*frame_time == 0 && *frames <= 1)))
        return LMN_OK;
    r->at = number;
    return wrong(r, "the seconds of a frame, above 0 and not above a day");
}

/* A number and the blank behind it take two bytes at least: what a file promises and cannot hold is not allocated. */
static lmn_status check_promise(bvh_reader *r, size_t frames)
{
    size_t numbers, have = ((size_t)(r->end - r->at) + 1) / 2;
    if (size_mul(frames, r->skeleton.channel_count, &numbers) && numbers <= have)
        return LMN_OK;
    error_in_file(r->error, LMN_FORMAT, r->job->path, build_line(r->begin, r->at),
                  "the file is cut off: %zu frames of %zu numbers do not fit what is left of it", frames,
                  r->skeleton.channel_count);
    error_hint(r->error, "copy or export the file again");
    return LMN_FORMAT;
}

static bool at_line_end(bvh_reader *r)
{
    while (r->at < r->end && is_blank(*r->at) && *r->at != '\n')
        r->at++;
    return r->at == r->end || *r->at == '\n';
}

/* A frame is a line: otherwise one number too many would shift all that follow. */
static lmn_status read_frame(bvh_reader *r, size_t frame, double *numbers)
{
    size_t count = r->skeleton.channel_count;
    skip_blanks(r);
    if (r->at == r->end)
        return wrong(r, "another frame");
    for (size_t i = 0; i < count; i++) {
        if (at_line_end(r))
            return error_in_file(r->error, LMN_FORMAT, r->job->path, build_line(r->begin, r->at),
                                 "frame %zu has %zu numbers, the channels are %zu", frame, i, count);
        if (!take_number(r, &numbers[i]))
            return wrong(r, "a number");
    }
    return at_line_end(r) ? LMN_OK
                          : error_in_file(r->error, LMN_FORMAT, r->job->path, build_line(r->begin, r->at),
                                          "frame %zu has more numbers than the %zu channels", frame, count);
}

static lmn_status read_frames(bvh_reader *r, animation *motion, size_t frames)
{
    enum { FRAMES_A_PIECE = 64 };
    double    *numbers = mem_alloc(r->skeleton.channel_count * sizeof *numbers);
    lmn_status status = numbers ? LMN_OK : error_memory(r->error);
    for (size_t i = 0; i < frames && status == LMN_OK; i++) {
        status = read_frame(r, i, numbers);
        if (status == LMN_OK)
            bvh_put_frame(motion, &r->skeleton, i, numbers);
        if (status == LMN_OK && i % FRAMES_A_PIECE == 0)
            status = import_progress(r->job, 0.9 * (double)i / (double)frames, "reading", r->error);
    }
    mem_free(numbers);
    return status;
}

static lmn_status read_motion(bvh_reader *r)
{
    long long   frames = 0;
    double      frame_time = 0;
    lmn_status  status = read_motion_head(r, &frames, &frame_time);
    lmn_scene  *s = r->job->scene;
    const char *still = frames == 0 ? "no frames" : r->skeleton.channel_count == 0 ? "no channels" : NULL;
    if (status != LMN_OK)
        return status;
    if (still) {
        warnings_add(&s->warnings, WARNING_IGNORED, "the motion has %s", still);
        return LMN_OK;
    }
    status = check_promise(r, (size_t)frames);
    if (status != LMN_OK)
        return status;
    animation *motion = bvh_add_motion(s, &r->skeleton, (size_t)frames, frame_time);
    if (!motion)
        return error_memory(r->error);
    motion->name = scene_name_of_file(r->job->path);
    if (!motion->name)
        return error_memory(r->error);
    status = read_frames(r, motion, (size_t)frames);
    skip_blanks(r);
    if (status == LMN_OK && r->at < r->end)
        warnings_add(&s->warnings, WARNING_IGNORED, "%zu bytes behind the last frame", (size_t)(r->end - r->at));
    return status;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

static void skip_byte_order_mark(bvh_reader *r)
{
    if (r->end - r->at >= 3 && memcmp(r->at, "\xEF\xBB\xBF", 3) == 0)
        r->at += 3;
}

static bool recognises(const file_data *file)
{
    const char *begin = (const char *)file->data;
    bvh_reader  r = {.begin = begin, .at = begin, .end = begin + file->size};
    skip_byte_order_mark(&r);
    return take(&r, "HIERARCHY") && take(&r, "ROOT");
}

static lmn_status read_bvh(const import_job *job, lmn_error *error)
{
    const char *begin = (const char *)job->file->data;
    bvh_reader  r = {.job = job, .begin = begin, .at = begin, .end = begin + job->file->size, .error = error};
    skip_byte_order_mark(&r);
    /* A skeleton without length is drawn as nothing, and still moves a model (import/retarget.h). */
    job->scene->may_be_empty = job->scene->is_motion = true;
    lmn_status status = read_hierarchy(&r);
    if (status == LMN_OK)
        status = bvh_build_skeleton(job->scene, &r.skeleton, error);
    if (status == LMN_OK && take(&r, "MOTION"))
        status = read_motion(&r);
    else if (status == LMN_OK && (skip_blanks(&r), r.at < r.end))
        status = wrong(&r, "\"ROOT\" or \"MOTION\"");
    else if (status == LMN_OK)
        warnings_add(&job->scene->warnings, WARNING_IGNORED, "the file has a skeleton and no motion");
    for (size_t i = 0; i < r.skeleton.count; i++)
        mem_free(r.skeleton.joints[i].name);
    mem_free(r.skeleton.joints);
    return status;
}

const import_format import_bvh = {"BVH", ".bvh", 'y', false, recognises, read_bvh};
