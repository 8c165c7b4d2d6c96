/* Glyphs into the scene: meshes, nodes and materials. */
#include <stdio.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "depict/depict_private.h"
#include "scene/content.h"

lmn_status glyph_put(depict_job *j, glyph_mesh *m, const glyph_label *label, lmn_error *error)
{
    const mat4 here = mat4_identity();
    return glyph_put_placed(j, m, &here, 0, label, error);
}

vec3 glyph_position(const glyph *g, size_t vertex)
{
    return g->shape ? mat4_transform_point(&g->world, g->mesh.positions[vertex]) : g->mesh.positions[vertex];
}

lmn_status glyph_put_placed(depict_job *j, glyph_mesh *m, const mat4 *world, uint64_t shape, const glyph_label *label,
                            lmn_error *error)
{
    if (m->failed || !mem_grow((void **)&j->glyphs, &j->glyph_capacity, j->glyph_count + 1, sizeof *j->glyphs))
        return error_memory(error);
    if (m->index_count == 0 && m->line_count == 0) {
        glyph_mesh_release(m);
        return LMN_OK;
    }
    j->glyphs[j->glyph_count++] = (glyph){*m, *label, *world, shape};
    memset(m, 0, sizeof *m);
    return LMN_OK;
}

void glyphs_release(depict_job *j)
{
    for (size_t i = 0; i < j->glyph_count; i++)
        glyph_mesh_release(&j->glyphs[i].mesh);
    mem_free(j->glyphs);
    j->glyphs = NULL;
    j->glyph_count = j->glyph_capacity = 0;
}

/* The material of a colour: one for all glyphs that have it. NONE: out of memory. */
static int32_t material_for(lmn_scene *s, colour tint)
{
    const vec4 wanted = {colour_to_linear(tint.r), colour_to_linear(tint.g), colour_to_linear(tint.b), 1};
    for (size_t i = 0; i < s->material_count; i++)
        if (s->materials[i].name && strcmp(s->materials[i].name, "glyph") == 0 &&
            memcmp(&s->materials[i].base_colour, &wanted, sizeof wanted) == 0)
            return (int32_t)i;
    char     *name = mem_copy_text("glyph");
    material *m = name ? scene_append_material(s) : NULL;
    if (!m) {
        mem_free(name);
        return NONE;
    }
    m->name = name;
    m->base_colour = wanted;
    m->double_sided = true;
    return (int32_t)s->material_count - 1;
}

/* The node's name says what it is and of what: "arrow of ball". */
static lmn_status add_node(lmn_scene *s, int32_t root, int32_t mesh, const glyph *g, lmn_error *error)
{
    const glyph_label       *label = &g->label;
    static const char *const tenses[] = {"past", "present", "future"};
    const char              *of = s->nodes[label->of].name;
    char                     name[160];
    snprintf(name, sizeof name, "%s of %.120s", label->glyph, of ? of : "it");
    node       wanted = {.name = mem_copy_text(name),
                         .parent = root,
                         .first_child = NONE,
                         .next_sibling = NONE,
                         .last_child = NONE,
                         .mesh = mesh,
                         .skin = NONE,
                         .camera = NONE,
                         .light = NONE,
                         .solid = NONE};
    bool       good = wanted.name && (!g->shape || node_set_matrix(&wanted, &g->world));
    lmn_status status = good ? scene_add_node(s, &wanted, error) : error_memory(error);
    if (status != LMN_OK) {
        mem_free(wanted.place);
        mem_free(wanted.name);
        return status;
    }
    int32_t added = (int32_t)s->node_count - 1;
    status = scene_set_attribute(s, added, NODE_GLYPH, label->glyph, error);
    if (status == LMN_OK && s->nodes[label->of].name)
        status = scene_set_attribute(s, added, "of", s->nodes[label->of].name, error);
    if (status == LMN_OK && label->sketchy)
        status = scene_set_attribute(s, added, "sketchy", "true", error);
    if (label->pale > 0) {
        char own[10];
        colour_print(label->own, own);
        if (status == LMN_OK)
            status = scene_set_attribute(s, added, NODE_PALE, (const char[]){(char)('0' + label->pale), '\0'}, error);
        if (status == LMN_OK)
            status = scene_set_attribute(s, added, NODE_TINT, own, error);
    }
    /* The image of now stands in the scene. */
    snprintf(name, sizeof name, "%u", label->image);
    if (status == LMN_OK && (strcmp(label->glyph, "still") != 0 || label->when != GLYPH_PRESENT))
        status = scene_set_attribute(s, added, NODE_SHADOWLESS, name, error);
    if (status == LMN_OK && label->overlay)
        status = scene_set_attribute(s, added, NODE_OVERLAY, "true", error);
    return status == LMN_OK ? scene_set_attribute(s, added, "when", tenses[label->when], error) : status;
}

/* Arrows are bands that turn with their way, and are meant as flat: they have the normals of what faces the viewer, so
 * that no crease is seen where they bend. NULL: others have none, or out of memory. */
static vec3 *flat_normals(const depict_job *j, const glyph *g, bool *failed)
{
    const glyph_mesh *m = &g->mesh;
    if (!strstr(g->label.glyph, "arrow"))
        return NULL;
    vec3 *normals = mem_alloc((m->position_count + 1) * sizeof *normals);
    *failed = !normals;
    for (size_t i = 0; normals && i < m->position_count; i++) {
        const double at[3] = {(double)m->positions[i].x, (double)m->positions[i].y, (double)m->positions[i].z};
        double       to_eye[3];
        depict_to_eye(j, at, to_eye);
        normals[i] = (vec3){(float)to_eye[0], (float)to_eye[1], (float)to_eye[2]};
    }
    return normals;
}

static lmn_status add_mesh(lmn_scene *s, const depict_job *j, glyph *g, lmn_error *error)
{
    glyph_mesh  *m = &g->mesh;
    bool         failed = false;
    vec3        *normals = flat_normals(j, g, &failed);
    const colour tint = g->label.tint;
    primitive    p = {.vertex_count = (uint32_t)m->position_count,
                      .index_count = (uint32_t)m->index_count,
                      .positions = m->positions,
                      .normals = normals,
                      .indices = m->indices,
                      .lines = m->lines,
                      .line_count = (uint32_t)m->line_count / 2,
                      .material = material_for(s, tint)};
    lmn_status   status = p.material == NONE || failed ? error_memory(error) : scene_check_mesh(s, NONE, &p, error);
    mesh        *added = status == LMN_OK ? scene_append_mesh(s) : NULL;
    if (status == LMN_OK && !added)
        status = error_memory(error);
    if (status != LMN_OK) {
        mem_free(normals);
        return status;
    }
    added->revision = added->topology = scene_next_revision();
    status = scene_exchange_mesh(s, (int32_t)s->mesh_count - 1, &p, error);
    if (status == LMN_OK) {
        memset(m, 0, sizeof *m);
    } else {
        s->mesh_count--;
        mem_free(normals);
    }
    return status;
}

/* An earlier glyph's mesh that has the same shape, and the same colour as well or not; NONE: there is none. */
static int32_t find_like(const depict_job *j, size_t i, const int32_t *meshes, bool colour_too)
{
    const glyph *g = &j->glyphs[i];
    for (size_t k = 0; k < i && g->shape; k++)
        if (j->glyphs[k].shape == g->shape &&
            (!colour_too || memcmp(&j->glyphs[k].label.tint, &g->label.tint, sizeof g->label.tint) == 0))
            return meshes[k];
    return NONE;
}

static lmn_status put_mesh(lmn_scene *s, depict_job *j, size_t i, int32_t *meshes, lmn_error *error)
{
    glyph *g = &j->glyphs[i];
    meshes[i] = find_like(j, i, meshes, true);
    if (meshes[i] != NONE)
        return LMN_OK;
    const int32_t twin = find_like(j, i, meshes, false);
    lmn_status    status = add_mesh(s, j, g, error);
    meshes[i] = (int32_t)s->mesh_count - 1;
    if (status == LMN_OK && twin != NONE) {
        s->meshes[meshes[i]].revision = s->meshes[twin].revision;
        s->meshes[meshes[i]].topology = s->meshes[twin].topology;
        s->meshes[meshes[i]].twin = (size_t)twin + 1;
    }
    return status;
}

lmn_status glyphs_into_scene(lmn_scene *s, depict_job *j, int32_t root, lmn_error *error)
{
    int32_t   *meshes = mem_alloc((j->glyph_count + 1) * sizeof *meshes);
    lmn_status status = meshes ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < j->glyph_count && status == LMN_OK; i++) {
        status = put_mesh(s, j, i, meshes, error);
        if (status == LMN_OK)
            status = add_node(s, root, meshes[i], &j->glyphs[i], error);
    }
    mem_free(meshes);
    return status;
}
