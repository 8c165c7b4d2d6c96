/* Glyphs as they lie in the world. */
#ifndef LIMNER_TESTS_PLACED_GLYPH_H
#define LIMNER_TESTS_PLACED_GLYPH_H

#include "import_support.h"

#include "scene/scene.h"

/* A glyph's mesh where its node puts it. Lent until 64 others were asked for. */
static inline const primitive *placed_glyph(const lmn_scene *s, const node *n)
{
    enum { KEPT = 64, VERTICES = 4096 };
    static primitive kept[KEPT];
    static vec3      positions[KEPT][VERTICES];
    static size_t    next;
    const primitive *p = &s->meshes[n->mesh].primitives[0];
    if (!n->has_matrix)
        return p;
    assert_true(p->vertex_count <= VERTICES);
    const size_t at = next++ % KEPT;
    for (uint32_t i = 0; i < p->vertex_count; i++)
        positions[at][i] = mat4_transform_point(&n->place->matrix, p->positions[i]);
    kept[at] = *p;
    kept[at].positions = positions[at];
    return &kept[at];
}

#endif
