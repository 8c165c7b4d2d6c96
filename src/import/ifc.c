/* IFC: assimp makes the shapes, in metres and with openings taken out of what they are in; names, classes and what is
 * missing come from the file's own words (ifc_text.h). */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "base/text.h"
#include "import/assimp_stream.h"
#include "import/build.h"
#include "import/exchange_file.h"
#include "import/ifc_text.h"
#include "import/stitch.h"

static const double near = 2e-6; /* of a mesh's size: what is one place, after mm have become m in single precision */

static bool recognises(const file_data *file)
{
    return exchange_file_kind(file) == EXCHANGE_IFC;
}

/* --- names ---------------------------------------------------------------------------------------------- */

/* "IFCWALLSTANDARDCASE" as "IfcWallStandardCase", which the node's name begins with. */
static bool put_class(node *n, const ifc_thing *thing)
{
    char   name[64];
    size_t length = strcspn(n->name, "_");
    if (length >= sizeof name || strncasecmp(n->name, thing->type, length) != 0)
        return build_attribute(n, "ifc-class", thing->type);
    memcpy(name, n->name, length);
    name[length] = '\0';
    return build_attribute(n, "ifc-class", name);
}

/* Nodes are called by class, name and identity: "IfcWall_Southwall_2O2Fr$t4X7Zf8NOew3FNr2"; those between them by a
 * relation, "$RelAggregates". */
static bool name_node(node *n, const ifc_text *text)
{
    const ifc_thing *thing = ifc_text_find(text, n->name);
    if (n->name && n->name[0] == '$') {
        mem_free(n->name);
        n->name = NULL;
    }
    if (!thing)
        return true;
    char guid[IFC_GUID + 1];
    memcpy(guid, thing->guid, IFC_GUID);
    guid[IFC_GUID] = '\0';
    bool  good = put_class(n, thing) && build_attribute(n, "ifc-guid", guid);
    char *name = mem_copy_text(thing->name ? thing->name : thing->type);
    if (!name)
        return false;
    mem_free(n->name);
    n->name = name;
    return good;
}

/* --- what is missing ------------------------------------------------------------------------------------ */

static bool has_mesh(const lmn_scene *scene, int32_t root)
{
    for (int32_t n = root; n != NONE; n = scene_next_node(scene, root, n))
        if (scene->nodes[n].mesh != NONE)
            return true;
    return false;
}

/* Of things with a shape, those that nothing was made for. `drawn`: per thing. */
static void tell_missing(const import_job *job, const ifc_text *text, const bool *drawn)
{
    size_t           shaped = 0, missing = 0;
    const ifc_thing *first = NULL;
    for (size_t i = 0; i < text->count; i++) {
        const ifc_thing *thing = &text->things[i];
        shaped += thing->shaped;
        if (!thing->shaped || drawn[i])
            continue;
        missing++;
        first = !first || thing->number < first->number ? thing : first;
    }
    if (first)
        warnings_add(
            &job->scene->warnings, WARNING_BAD_GEOMETRY,
            "%zu of %zu things have shapes that cannot be read and are missing, the first: #%llu, %.40s '%.60s'",
            missing, shaped, (unsigned long long)first->number, first->type, first->name ? first->name : "");
}

/* --- shapes --------------------------------------------------------------------------------------------- */

/* assimp turns the building from z up, as the file has it, to y up, with the errors of single precision. */
static bool stand_up(lmn_scene *scene)
{
    if (!scene->node_count)
        return true;
    mat4   m = node_local_matrix(&scene->nodes[0]);
    double most = 0;
    for (int column = 0; column < 4; column++) {
        double y = m.m[4 * column + 1];
        m.m[4 * column + 1] = -m.m[4 * column + 2];
        m.m[4 * column + 2] = y;
    }
    for (int i = 0; i < 12; i++)
        most = fmax(most, fabs(m.m[i]));
    for (int i = 0; i < 12; i++)
        m.m[i] = fabs(m.m[i]) < 1e-6 * most ? 0 : m.m[i];
    return node_set_matrix(&scene->nodes[0], &m);
}

static bool stitch_all(lmn_scene *scene)
{
    for (size_t i = 0; i < scene->mesh_count; i++)
        for (size_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            primitive *p = &scene->meshes[i].primitives[k];
            double     size = 0;
            for (uint32_t v = 0; v < p->vertex_count; v++)
                for (int axis = 0; axis < 3; axis++)
                    size = fmax(size, fabs((double)(&p->positions[v].x)[axis]));
            if (!p->normals && p->index_count && size > 0 && !(stitch(p, near * size) && stitch_holes(p, near * size)))
                return false;
        }
    return true;
}

/* --- the whole ------------------------------------------------------------------------------------------ */

static lmn_status put_words(const import_job *job, const ifc_text *text, lmn_error *error)
{
    static const char *const keys[IFC_FACTS] = {"file-title", "file-author", "file-organisation", "file-date"};
    lmn_scene               *scene = job->scene;
    bool                    *drawn = mem_calloc(text->count + 1, sizeof *drawn);
    bool                     good = drawn != NULL;
    for (size_t i = 0; i < scene->node_count && good; i++) {
        const ifc_thing *thing = ifc_text_find(text, scene->nodes[i].name);
        if (thing && has_mesh(scene, (int32_t)i))
            drawn[thing - text->things] = true;
        good = name_node(&scene->nodes[i], text);
    }
    for (int i = 0; i < IFC_FACTS && good && scene->node_count; i++)
        good = !text->facts[i] || build_attribute(&scene->nodes[0], keys[i], text->facts[i]);
    if (good)
        tell_missing(job, text, drawn);
    mem_free(drawn);
    return good ? LMN_OK : error_memory(error);
}

static lmn_status read_ifc(const import_job *job, lmn_error *error)
{
    ifc_text   text;
    lmn_status status = assimp_load(job, error);
    if (status != LMN_OK)
        return status;
    status = ifc_text_read(&text, (const char *)job->file->data, job->file->size, error);
    if (status == LMN_OK)
        status = put_words(job, &text, error);
    ifc_text_release(&text);
    return status == LMN_OK && !(stitch_all(job->scene) && stand_up(job->scene)) ? error_memory(error) : status;
}

const import_format import_ifc = {
    .name = "IFC",
    .endings = ".ifc",
    .up = 'z',
    .recognises = recognises,
    .read = read_ifc,
};
