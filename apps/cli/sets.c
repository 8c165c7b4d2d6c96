#include "sets.h"

#include "cli.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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

/* The way of this name; false: it is a technique, or nothing. */
static bool find_way(const char *name, lmn_motion_way_info *out)
{
    for (size_t i = 0; lmn_motion_way_at(i, out); i++)
        if (strcmp(out->name, name) == 0)
            return true;
    return false;
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
    lmn_error           error = {0};
    lmn_motion_way_info known;
    bool                found = way && find_way(way, &known);
    if (way && lmn_look_set_motion_way(look, way, &error) != LMN_OK)
        return message_error(&error);
    bool traces = way && strcmp(found ? known.technique : way, "traces") == 0;
    if (poses && way && !traces && !(found && known.poses))
        return message_usage(
            NULL, "--poses goes with --motion plate, ghosts, echoes, comic and speed-lines, not with %.60s", way);
    return poses ? set_poses(look, poses, traces) : EXIT_DONE;
}

void write_motion_doc(char *out, size_t size)
{
    lmn_motion_way_info way;
    size_t              used = (size_t)snprintf(out, size, "Tell that the model moves, in any look: ");
    for (size_t i = 0; lmn_motion_way_at(i, &way) && used < size; i++)
        used += (size_t)snprintf(out + used, size - used, "%s%s (%s)", i ? ", " : "", way.name, way.doc);
    if (used < size)
        snprintf(out + used, size - used, "; or a technique of `limner looks`, such as blur or streaks. Needs a time.");
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
