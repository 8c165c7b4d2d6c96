/* Units of length by what files are. */
#include "plan/unit.h"

#include <string.h>

#include "base/file.h"

lmn_status unit_find(const char *text, const lmn_scene *scene, double *mm, const char **name, bool *stated,
                     lmn_error *error)
{
    static const struct {
        const char *name;
        double      mm;
    } units[] = {{"mm", 1}, {"cm", 10}, {"m", 1000}, {"in", 25.4}};
    char ending[16] = "";
    if (!text && scene->file_count)
        file_ending(scene->files[0], ending, sizeof ending);
    static const char *const in_metres[] = {".gltf", ".glb", ".json", ".jsonl", ".gml", ".citygml", ".ifc"};
    static const char *const in_millimetres[] = {".stl", ".csg",  ".scad", ".step", ".stp",
                                                 ".p21", ".iges", ".igs",  ".3mf"};
    bool                     metres = false, millimetres = false;
    for (size_t i = 0; i < sizeof in_metres / sizeof *in_metres; i++)
        metres = metres || strcmp(ending, in_metres[i]) == 0;
    for (size_t i = 0; i < sizeof in_millimetres / sizeof *in_millimetres; i++)
        millimetres = millimetres || strcmp(ending, in_millimetres[i]) == 0;
    *stated = text || metres || millimetres;
    const char *wanted = text ? text : metres ? "m" : "mm";
    for (size_t i = 0; i < sizeof units / sizeof *units; i++)
        if (strcmp(units[i].name, wanted) == 0) {
            *mm = units[i].mm;
            *name = units[i].name;
            return LMN_OK;
        }
    return error_set(error, LMN_USAGE, "the unit is '%.40s'; allowed is mm, cm, m or in", wanted);
}
