#include "api/check_content.h"

#include <string.h>

#include "base/error.h"

lmn_status content_check_scene(const lmn_scene *scene, const char *caller, lmn_error *error)
{
    return scene ? LMN_OK : error_set(error, LMN_USAGE, "%s: `scene` is NULL", caller);
}

lmn_status content_check_range(double value, double least, double most, const char *what, const char *caller,
                               lmn_error *error)
{
    if (value >= least && value <= most)
        return LMN_OK;
    return error_set(error, LMN_USAGE, "%s: %s is %g, not %g to %g", caller, what, value, least, most);
}

lmn_status content_check_number(uint32_t number, size_t count, const char *what, const char *caller, lmn_error *error)
{
    if (number <= count)
        return LMN_OK;
    return error_set(error, LMN_USAGE, "%s: the scene has no %s %u", caller, what, (unsigned)number);
}

lmn_status content_check_node(const lmn_scene *scene, uint32_t number, const char *caller, lmn_error *error)
{
    lmn_status status = content_check_scene(scene, caller, error);
    if (status != LMN_OK || (number > 0 && number <= scene->node_count && !scene->nodes[number - 1].removed &&
                             !scene->nodes[number - 1].ghost))
        return status;
    error_set(error, LMN_USAGE, "%s: the scene has no node %u", caller, (unsigned)number);
    error_hint(error,
               "take numbers from lmn_scene_add_node or lmn_scene_node_of_part; those of removed nodes are gone");
    return LMN_USAGE;
}

int32_t content_index(uint32_t number)
{
    return number ? (int32_t)number - 1 : NONE;
}

bool content_copy_name(char **out, const char *name)
{
    *out = name && name[0] ? scene_clean_name(name, strlen(name)) : NULL;
    return *out || !name || !name[0];
}
