#include "sets.h"

#include "cli.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Ways to tell of motion that have a name of their own: what they set, before --set. */
typedef struct motion_way {
    const char *name;
    const char *sets[6];
} motion_way;
static const motion_way motion_ways[] = {
    {"speed-lines", {"motion.technique=traces", "motion.exposure=0.3"}},
    {"ghosts", {"motion.technique=traces", "motion.exposure=0.5", "motion.lines=0", "motion.contours=5"}},
    {"echoes",
     {"motion.technique=traces", "motion.exposure=0.5", "motion.lines=0", "motion.contours=8", "motion.trailing=true"}},
    {"plate",
     {"motion.technique=accumulate", "motion.exposure=1", "motion.times=6", "motion.weights=plate",
      "motion.decay=0.8"}},
    {"comic", {"motion.technique=traces", "motion.exposure=0.3", "motion.contours=2", "motion.ends=wedges"}},
    {"manga",
     {"motion.technique=traces", "motion.exposure=0.3", "motion.lines=48", "motion.ends=wedges", "motion.flow=70",
      "motion.flow_way=converging"}},
    {"chrono",
     {"motion.technique=accumulate", "motion.exposure=1", "motion.times=8", "motion.weights=plate",
      "motion.decay=0.85"}},
    {"vibration", {"motion.technique=traces", "motion.exposure=0.5", "motion.lines=0", "motion.vibration=3"}},
    {"squash", {"motion.technique=deform", "motion.stretch=0.5", "motion.squash=0.5"}},
    {"slit", {"motion.technique=deform", "motion.slit=0.1", "motion.pan=0.5"}},
    {"lean", {"motion.technique=deform", "motion.lean=25", "motion.inertia=20"}},
};

static int set_one(lmn_look *look, const char *assignment)
{
    lmn_error   error = {0};
    const char *equals = strchr(assignment, '=');
    char        key[256];
    if (!equals || equals == assignment || (size_t)(equals - assignment) >= sizeof key)
        return message_usage("for example --set lines.width=3px", "--set is '%.120s'; allowed is KIND.PARAM=VALUE",
                             assignment);
    snprintf(key, sizeof key, "%.*s", (int)(equals - assignment), assignment);
    if (lmn_look_set(look, key, equals + 1, &error) == LMN_OK)
        return EXIT_DONE;
    return message_error(&error);
}

static bool sets_same_key(const char *a, const char *b)
{
    size_t length = strcspn(a, "=");
    return length == strcspn(b, "=") && strncmp(a, b, length) == 0;
}

/* Of two values for one key, one would be dropped in silence. */
static int check_set_once(const word_list *sets, size_t index, bool has_cut)
{
    const char *own = sets->items[index];
    if (has_cut && sets_same_key(own, "scene.cut="))
        return message_usage(NULL, "--cut and --set scene.cut exclude each other");
    for (size_t i = 0; i < index; i++)
        if (sets_same_key(own, sets->items[i]))
            return message_usage(NULL, "--set %.*s is given twice; it holds one value", (int)strcspn(own, "="), own);
    return EXIT_DONE;
}

/* "motion.technique=…", "lines.operator=…": which technique's parameters there are to set. */
static bool names_technique(const char *assignment)
{
    size_t            length = strcspn(assignment, "=");
    const char *const endings[] = {".technique", ".operator"};
    for (size_t i = 0; i < 2; i++)
        if (length > strlen(endings[i]) &&
            strncmp(assignment + length - strlen(endings[i]), endings[i], strlen(endings[i])) == 0)
            return true;
    return false;
}

/* Techniques before their parameters, whichever was written first. */
int set_all(lmn_look *look, const word_list *sets, bool has_cut)
{
    int status = EXIT_DONE;
    for (int round = 0; round < 2; round++)
        for (size_t i = 0; i < sets->count && status == EXIT_DONE; i++) {
            status = check_set_once(sets, i, has_cut);
            if (status == EXIT_DONE && names_technique(sets->items[i]) == (round == 0))
                status = set_one(look, sets->items[i]);
        }
    return status;
}

/* Of a way without a name of its own, the technique. */
static int set_way(lmn_look *look, const char *name)
{
    char assignment[256];
    for (size_t i = 0; i < sizeof motion_ways / sizeof *motion_ways; i++) {
        int status = EXIT_DONE;
        if (strcmp(motion_ways[i].name, name) != 0)
            continue;
        for (size_t k = 0; k < 6 && motion_ways[i].sets[k] && status == EXIT_DONE; k++)
            status = set_one(look, motion_ways[i].sets[k]);
        return status;
    }
    snprintf(assignment, sizeof assignment, "motion.technique=%.200s", name);
    return set_one(look, assignment);
}

static bool draws_traces(const char *way)
{
    for (size_t i = 0; i < sizeof motion_ways / sizeof *motion_ways; i++)
        if (strcmp(motion_ways[i].name, way) == 0)
            return strcmp(motion_ways[i].sets[0], "motion.technique=traces") == 0;
    return strcmp(way, "traces") == 0;
}

/* Of the whole motion up to the time that is drawn. */
static int set_poses(lmn_look *look, const char *poses, bool traces)
{
    enum { POSES_LEAST = 2, POSES_MOST = 64, AUTO_MOST = 8 };
    char *end;
    bool  automatic = strcmp(poses, "auto") == 0;
    long  count = automatic ? AUTO_MOST : strtol(poses, &end, 10);
    if (!automatic && (end == poses || *end || count < POSES_LEAST || count > POSES_MOST))
        return message_usage("for example --poses 5", "--poses is '%.40s'; allowed are %d to %d, or auto", poses,
                             POSES_LEAST, POSES_MOST);
    char number[48], moments[48];
    snprintf(number, sizeof number, "motion.%s=%ld", traces ? "contours" : "times",
             traces && !automatic ? count - 1 : count);
    snprintf(moments, sizeof moments, "motion.moments=%s", automatic ? "auto" : "telling");
    const char *const plate[] = {"motion.technique=accumulate", "motion.weights=plate", "motion.decay=1"};
    int               status = EXIT_DONE;
    for (size_t i = 0; i < 3 && !traces && status == EXIT_DONE; i++)
        status = set_one(look, plate[i]);
    const char *const both[] = {"motion.exposure=3600", number, moments};
    for (size_t i = 0; i < 3 && status == EXIT_DONE; i++)
        status = set_one(look, both[i]);
    return status;
}

int set_motion(lmn_look *look, const char *way, const char *poses)
{
    bool traces = way && draws_traces(way);
    int  status = way ? set_way(look, way) : EXIT_DONE;
    if (poses && way && !traces && strcmp(way, "plate") != 0 && strcmp(way, "chrono") != 0)
        return message_usage(
            NULL, "--poses goes with --motion plate, ghosts, echoes, comic and speed-lines, not with %.60s", way);
    return status == EXIT_DONE && poses ? set_poses(look, poses, traces) : status;
}

/* --- clips ---------------------------------------------------------------------------------------------------- */

/* Is the clip one of those that are separated by commas? */
static bool is_named(const char *clips, const char *name, size_t number)
{
    for (const char *at = clips; *at; at += strcspn(at, ",") + (at[strcspn(at, ",")] == ',')) {
        size_t size = strcspn(at, ",");
        char   digits[24];
        int    length = snprintf(digits, sizeof digits, "%zu", number);
        if ((strlen(name) == size && strncmp(at, name, size) == 0) ||
            ((size_t)length == size && strncmp(at, digits, size) == 0))
            return true;
    }
    return strcmp(clips, name) == 0;
}

double clip_end(const lmn_scene *scene, const char *clips)
{
    json_t       *root = parse_and_free(lmn_scene_info_json(scene));
    const json_t *item;
    double        end = 0;
    size_t        i;
    json_array_foreach(json_object_get(root, "animations"), i, item)
    {
        const char *name = json_string_value(json_object_get(item, "name"));
        if (clips ? is_named(clips, name ? name : "", i + 1) : i == 0)
            end = fmax(end, json_number_value(json_object_get(item, "duration")));
    }
    json_decref(root);
    return end;
}
