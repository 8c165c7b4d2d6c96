/* The scene as it will be with its glyphs, without changing it: arrays of its own, all else lent. */
#include "depict/preview.h"

#include <string.h>

#include "base/error.h"
#include "base/memory.h"

static bool take_arrays(preview *out, const lmn_scene *s, size_t glyphs)
{
    const size_t parts = s->part_count + s->ghost_count;
    out->scene = *s;
    out->scene.nodes = mem_alloc((s->node_count + glyphs + 1) * sizeof *s->nodes);
    out->scene.meshes = mem_alloc((s->mesh_count + glyphs + 1) * sizeof *s->meshes);
    out->scene.parts = mem_alloc((parts + glyphs + 1) * sizeof *s->parts);
    out->primitives = mem_calloc(glyphs + 1, sizeof *out->primitives);
    out->places = mem_calloc(glyphs + 1, sizeof *out->places);
    if (!out->scene.nodes || !out->scene.meshes || !out->scene.parts || !out->primitives || !out->places)
        return false;
    memcpy(out->scene.nodes, s->nodes, s->node_count * sizeof *s->nodes);
    if (s->mesh_count)
        memcpy(out->scene.meshes, s->meshes, s->mesh_count * sizeof *s->meshes);
    if (parts) {
        memcpy(out->scene.parts, s->parts, s->part_count * sizeof *s->parts);
        memcpy(out->scene.parts + s->part_count + glyphs, s->parts + s->part_count, s->ghost_count * sizeof *s->parts);
    }
    return true;
}

static void put_glyph(preview *out, const glyph *g, size_t i)
{
    lmn_scene *s = &out->scene;
    primitive *p = &out->primitives[i];
    *p = (primitive){.vertex_count = (uint32_t)g->mesh.position_count,
                     .index_count = (uint32_t)g->mesh.index_count,
                     .positions = g->mesh.positions,
                     .indices = g->mesh.indices,
                     .lines = g->mesh.lines,
                     .line_count = (uint32_t)g->mesh.line_count / 2,
                     .material = NONE,
                     .bounds = box3_empty()};
    for (uint32_t k = 0; k < p->vertex_count; k++)
        p->bounds = box3_with_point(p->bounds, p->positions[k]);
    s->meshes[s->mesh_count] = (mesh){.primitives = p, .primitive_count = 1};
    out->places[i] = (node_place){.matrix = g->world, .rotation = {0, 0, 0, 1}, .scale = {1, 1, 1}};
    s->nodes[s->node_count] = (node){.parent = NONE,
                                     .first_child = NONE,
                                     .next_sibling = NONE,
                                     .last_child = NONE,
                                     .has_matrix = g->shape != 0,
                                     .place = &out->places[i],
                                     .mesh = (int32_t)s->mesh_count++,
                                     .skin = NONE,
                                     .camera = NONE,
                                     .light = NONE,
                                     .solid = NONE,
                                     .attributes = &out->mark,
                                     .attribute_count = 1};
    s->parts[s->part_count++] = (part){.node = (int32_t)s->node_count++, .bounds = p->bounds};
}

lmn_status preview_open(preview *out, const depict_job *j, const expression_list *expressions, lmn_error *error)
{
    size_t count = 0; /* of those that the viewer steps back for */
    memset(out, 0, sizeof *out);
    for (size_t i = 0; i < j->glyph_count; i++)
        count += !j->glyphs[i].label.overlay;
    if (!take_arrays(out, j->scene, count))
        return error_memory(error);
    memcpy(out->key, NODE_GLYPH, sizeof NODE_GLYPH);
    out->mark = (attribute){out->key, out->key};
    for (size_t i = 0, put = 0; i < j->glyph_count; i++)
        if (!j->glyphs[i].label.overlay)
            put_glyph(out, &j->glyphs[i], put++);
    for (size_t i = 0; i < expressions->count; i++)
        if (expressions->items[i].row->hides_target)
            out->scene.nodes[expressions->items[i].target].hidden = true;
    return LMN_OK;
}

void preview_release(preview *p)
{
    mem_free(p->scene.nodes);
    mem_free(p->scene.meshes);
    mem_free(p->scene.parts);
    mem_free(p->primitives);
    mem_free(p->places);
    memset(p, 0, sizeof *p);
}
