#include "import/build.h"

#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "import/access.h"

int32_t build_plain_material(lmn_scene *scene, bool has_colours)
{
    material *m = scene_append_material(scene);
    if (!m)
        return NONE;
    m->name = mem_copy_text("default");
    if (!m->name)
        return NONE;
    if (!has_colours)
        m->base_colour = (vec4){BUILD_PLAIN_GREY, BUILD_PLAIN_GREY, BUILD_PLAIN_GREY, 1};
    return (int32_t)scene->material_count - 1;
}

lmn_status build_part(lmn_scene *scene, primitive *p, const char *name, lmn_error *error)
{
    mesh *m = scene_append_mesh(scene);
    if (!m || !mesh_set_primitives(m, p, 1)) {
        primitive_release(p);
        return error_memory(error);
    }
    memset(p, 0, sizeof *p);
    node *n = scene_append_node(scene);
    if (!n)
        return error_memory(error);
    n->mesh = (int32_t)scene->mesh_count - 1;
    n->name = mem_copy_text(name);
    return !name || n->name ? LMN_OK : error_memory(error);
}

bool build_attribute(node *n, const char *key, const char *value)
{
    attribute *grown = node_own_facts(n) ? mem_realloc(n->attributes, (n->attribute_count + 1) * sizeof *grown) : NULL;
    if (!grown)
        return false;
    n->attributes = grown;
    bool good = attribute_make(&grown[n->attribute_count], key, value);
    n->attribute_count += good;
    return good;
}

int build_line(const char *from, const char *at)
{
    int line = 1;
    for (; from < at; from++)
        line += *from == '\n';
    return line;
}

lmn_status build_side_file(const import_job *job, const char *what, const char *name, file_data *out, lmn_error *error)
{
    *out = (file_data){0};
    char *path = file_beside(job->path, name);
    if (!path)
        return error_memory(error);
    lmn_error  problem = {0};
    bool       refused;
    lmn_status status = access_read(job, what, path, out, &refused, &problem);
    mem_free(path);
    if (status == LMN_MEMORY)
        return error_memory(error);
    if (refused)
        warnings_add(&job->scene->warnings, WARNING_REFUSED_FILE, "%s; %s", problem.message, problem.hint);
    else if (status != LMN_OK)
        warnings_add(&job->scene->warnings, WARNING_MISSING_FILE, "%s \"%s\": %s", what, name, problem.message);
    return LMN_OK;
}

bool build_has_file(const import_job *job, const char *name)
{
    char *path = file_beside(job->path, name);
    bool  there = path && access_has(job, path);
    mem_free(path);
    return there;
}
