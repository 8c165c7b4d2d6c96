/* OpenSCAD's evaluated files (.csg): one solid, a tree of set operations over the leaves' meshes. */
#include "import/csg.h"

#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"

/* The first object marked with ! is the whole model; else the file is. */
static int32_t root_of(const csg_tree *t)
{
    for (int32_t i = 0; i < (int32_t)t->node_count; i++)
        if ((t->nodes[i].modifiers & CSG_ROOT) && !(t->nodes[i].modifiers & (CSG_BACKGROUND | CSG_DISABLED)))
            return i;
    return 0;
}

static lmn_status evaluate(csg_reader *r, int32_t *shape)
{
    int32_t root = root_of(&r->tree);
    *shape = NONE;
    if (r->tree.nodes[root].dimension == 0)
        return LMN_OK;
    return r->tree.nodes[root].dimension == 2 ? csg_plate_of(r, root, shape) : csg_shape_of(r, root, shape);
}

/* --- into the scene ------------------------------------------------------------------------------------- */

typedef struct emission {
    csg_reader *reader;
    solid      *solid;
    size_t      operands;
} emission;

static lmn_status set_mesh(emission *e, int32_t target, int32_t index)
{
    csg_mesh *m = &e->reader->meshes[index];
    if (++e->operands > SOLID_OPERANDS_MAX)
        return error_in_file(e->reader->error, LMN_LIMIT, e->reader->job->path, 0,
                             "the model has more than %d operands", SOLID_OPERANDS_MAX);
    if (m->scene_mesh == NONE)
        m->scene_mesh = polyhedron_into_scene(e->reader->job->scene, &m->polyhedron);
    e->solid->nodes[target].mesh = m->scene_mesh;
    return m->scene_mesh == NONE ? error_memory(e->reader->error) : LMN_OK;
}

static lmn_status emit(emission *e, int32_t parent, int32_t shape);

/* Gives a node of the solid what the shape has, children too. */
static lmn_status fill(emission *e, int32_t target, int32_t shape)
{
    csg_reader      *r = e->reader;
    const csg_shape *s = &r->shapes[shape];
    solid_node      *n = &e->solid->nodes[target];
    n->matrix = s->matrix;
    n->has_colour = s->has_colour;
    n->colour = s->colour;
    n->line = r->evaluated || s->node == 0 ? 0 : r->tree.nodes[s->node].line;
    n->name = s->node == 0 ? NULL : mem_copy_text(csg_word(&r->tree, s->node));
    if (s->node != 0 && !n->name)
        return error_memory(r->error);
    lmn_status status = s->kind == SOLID_OPERAND ? set_mesh(e, target, s->mesh) : LMN_OK;
    for (int32_t c = s->first_child; c != NONE && status == LMN_OK; c = r->shapes[c].next)
        status = emit(e, target, c);
    return status;
}

static lmn_status emit(emission *e, int32_t parent, int32_t shape)
{
    int32_t index = solid_append(e->solid, parent, e->reader->shapes[shape].kind);
    return index == NONE ? error_memory(e->reader->error) : fill(e, index, shape);
}

/* The root is a union, that of the shape or one around it. What it takes away is kept beside it, for looks that
 * show that. */
static lmn_status fill_scene(csg_reader *r, int32_t shape)
{
    lmn_scene *scene = r->job->scene;
    int32_t    index = (int32_t)scene->node_count;
    node      *n = scene_append_node(scene);
    solid     *s = scene_append_solid(scene, SOLID_UNION);
    if (!n || !s)
        return error_memory(r->error);
    n->solid = (int32_t)scene->solid_count - 1;
    emission   e = {.reader = r, .solid = s};
    lmn_status status = r->shapes[shape].kind == SOLID_UNION ? fill(&e, 0, shape) : emit(&e, 0, shape);
    return status != LMN_OK || scene_append_removed(scene, index) ? status : error_memory(r->error);
}

static void release_reader(csg_reader *r)
{
    for (size_t i = 0; i < r->mesh_count; i++)
        polyhedron_release(&r->meshes[i].polyhedron);
    mem_free(r->meshes);
    mem_free(r->slots);
    mem_free(r->shapes);
    csg_release(&r->tree);
}

/* A file may be whole and draw nothing: what is in it may all be background or echo() alone. */
lmn_status csg_read(const import_job *job, bool evaluated, lmn_error *error)
{
    lmn_error  own = {0};
    csg_reader r = {.job = job, .evaluated = evaluated, .error = &own};
    int32_t    shape = NONE;
    job->scene->may_be_empty = true;
    lmn_status status = csg_parse(&r.tree, job, &own);
    if (status == LMN_OK) {
        csg_set_dimensions(&r);
        status = evaluate(&r, &shape);
    }
    if (status == LMN_OK && shape >= 0)
        status = fill_scene(&r, shape);
    release_reader(&r);
    if (status != LMN_OK && error)
        *error = own;
    return status;
}

static lmn_status read_csg(const import_job *job, lmn_error *error)
{
    return csg_read(job, false, error);
}

const import_format import_csg = {"OpenSCAD CSG", ".csg", 'z', false, NULL, read_csg};
