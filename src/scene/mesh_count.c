/* How large a mesh is. */
#include "scene/scene.h"

uint64_t mesh_triangle_count(const mesh *m)
{
    uint64_t count = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        count += m->primitives[i].index_count / 3;
    return count;
}

uint64_t mesh_line_count(const mesh *m)
{
    uint64_t count = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        count += m->primitives[i].line_count;
    return count;
}
