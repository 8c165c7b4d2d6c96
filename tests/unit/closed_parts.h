/* What the tests of our own models share: their parts are closed. */
#ifndef TESTS_CLOSED_PARTS_H
#define TESTS_CLOSED_PARTS_H

#include "import_support.h"

static inline int compare_edges(const void *a, const void *b)
{
    const uint64_t *x = a, *y = b;
    return (*x > *y) - (*x < *y);
}

/* Every edge is used once, and once in the other direction. */
static inline void assert_closed(const lmn_scene *scene)
{
    for (size_t i = 0; i < scene->mesh_count; i++) {
        assert_int_equal(scene->meshes[i].primitive_count, 1);
        const primitive *p = scene->meshes[i].primitives;
        uint64_t        *edges = mem_alloc(2 * p->index_count * sizeof *edges), *back = edges + p->index_count;
        assert_non_null(edges);
        for (uint32_t k = 0; k < p->index_count; k++) {
            uint64_t from = p->indices[k], to = p->indices[k % 3 == 2 ? k - 2 : k + 1];
            edges[k] = from << 32 | to;
            back[k] = to << 32 | from;
        }
        qsort(edges, p->index_count, sizeof *edges, compare_edges);
        qsort(back, p->index_count, sizeof *back, compare_edges);
        for (uint32_t k = 0; k < p->index_count; k++) {
            assert_true(k == 0 || edges[k] != edges[k - 1]);
            assert_int_equal(edges[k], back[k]);
        }
        mem_free(edges);
    }
}

/* Fails unless exactly one part has this name. */
static inline void assert_one_part(const lmn_scene *scene, const char *name)
{
    size_t found = 0;
    for (size_t i = 0; i < scene->part_count; i++)
        found += strcmp(scene->parts[i].name, name) == 0;
    if (found != 1)
        print_error("%s: %zu parts\n", name, found);
    assert_int_equal(found, 1);
}

#endif
