#include "info/city_info.h"

#include <math.h>

static json_t *real(double value)
{
    return json_real(isfinite(value) ? value : 0);
}

json_t *city_info_json(const lmn_scene *scene)
{
    const city_facts *f = &scene->city;
    if (!f->known && f->count_count == 0)
        return json_null();
    json_t *root = json_object(), *crs = f->crs ? json_string(f->crs) : NULL;
    json_object_set_new(root, "crs", crs ? crs : json_null());
    json_object_set_new(root, "geographic", json_boolean(f->geographic));
    json_object_set_new(root, "origin",
                        f->known ? json_pack("[o,o,o]", real(f->origin[0]), real(f->origin[1]), real(f->origin[2]))
                                 : json_null());
    for (int g = 0; g < CITY_GROUPS; g++) {
        json_t *group = json_object();
        for (size_t i = 0; i < f->count_count; i++)
            if (f->counts[i].group == (city_group)g)
                json_object_set_new(group, f->counts[i].name, json_integer((json_int_t)f->counts[i].count));
        json_object_set_new(root, city_group_name((city_group)g), group);
    }
    return root;
}
