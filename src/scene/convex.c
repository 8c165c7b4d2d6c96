/* Is a mesh convex? Faces are compared with all points; it must be closed too. */
#include <math.h>
#include <stdint.h>

#include "base/memory.h"
#include "scene/mesh.h"

/* Of the extent: what single precision leaves of flat faces that were divided into triangles. */
static const double FLAT = 2e-6;
enum { PAIRS_MAX = 4000000 };

static bool is_closed(const primitive *p)
{
    uint32_t *twins = mesh_adjacency(p);
    bool      closed = twins != NULL;
    for (uint32_t i = 0; i < p->index_count && closed; i++)
        closed = twins[i] != UINT32_MAX;
    mem_free(twins);
    return closed;
}

/* Are all points on or behind the triangle, seen from the side to which `outward` (1 or −1) says it faces? */
static bool is_in_front(const primitive *p, uint32_t triangle, double outward, double tolerance)
{
    double c[3][3], n[3], length = 0;
    for (uint32_t k = 0; k < 3; k++) {
        vec3 v = p->positions[p->indices[3 * triangle + k]];
        c[k][0] = (double)v.x;
        c[k][1] = (double)v.y;
        c[k][2] = (double)v.z;
    }
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        n[k] = (c[1][i] - c[0][i]) * (c[2][j] - c[0][j]) - (c[1][j] - c[0][j]) * (c[2][i] - c[0][i]);
        length += n[k] * n[k];
    }
    length = sqrt(length);
    if (!(length > 0))
        return true;
    for (uint32_t i = 0; i < p->vertex_count; i++) {
        vec3   v = p->positions[i];
        double d = n[0] * ((double)v.x - c[0][0]) + n[1] * ((double)v.y - c[0][1]) + n[2] * ((double)v.z - c[0][2]);
        if (outward * d > tolerance * length)
            return false;
    }
    return true;
}

bool mesh_is_convex(const mesh *m)
{
    if (m->primitive_count != 1)
        return false;
    const primitive *p = &m->primitives[0];
    if (p->index_count < 12 || (double)p->vertex_count * (p->index_count / 3) > PAIRS_MAX || !is_closed(p))
        return false;
    double x = (double)p->bounds.max.x - (double)p->bounds.min.x, y = (double)p->bounds.max.y - (double)p->bounds.min.y,
           z = (double)p->bounds.max.z - (double)p->bounds.min.z, extent = sqrt(x * x + y * y + z * z);
    for (int side = 0; side < 2; side++) {
        bool convex = true;
        for (uint32_t i = 0; i < p->index_count / 3 && convex; i++)
            convex = is_in_front(p, i, side ? -1 : 1, FLAT * extent);
        if (convex)
            return true;
    }
    return false;
}
