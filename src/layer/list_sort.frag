/* The nearest of a pixel's fragments, in order: their nodes. Of fragments of one part at the same depth that face the same way the
 * first drawn stays. With SETTLES_TIES, parts that lie on one another come in their order, whichever of them rounding puts
 * in front at a pixel. With FOLLOWS, those behind the last node of the round before. */
layout(std430, binding = 0) readonly buffer heads_block { uint heads[]; };
layout(std430, binding = 1) readonly buffer nodes_block { uvec4 nodes[]; };

uniform vec4 u_list_box;
#ifdef FOLLOWS
uniform usampler2D t_last; /* of the round before */
#endif
layout(location = 0) out uvec4 out_nodes;
#if KEPT > 4
layout(location = 1) out uvec4 out_more;
#endif

const uint NONE = 0xFFFFFFFFu; /* deeper than any depth */

#ifdef SETTLES_TIES
/* Depths that differ by less, in the window and as a fraction of the way to the eye, are those of surfaces that coincide:
 * they are interpolated over different triangles. */
const float COINCIDENT = 4e-6, COINCIDENT_EYE = 8e-6;
#endif

#include "layer/order.glsl"

/* First round only: is what the list has nearest told apart by depth alone? Then nothing else of the nodes is read. */
bool sort_by_depth(uint head, out uint kept[KEPT])
{
    uint depths[KEPT];
    bool ties = false;
    for (int k = 0; k < KEPT; k++) {
        depths[k] = NONE;
        kept[k] = 0u;
    }
    uint i = head;
    while (i != 0u) {
        uvec2 node = nodes[(i - 1u) * uint(NODE_VECTORS)].xy;
        uint depth = node.y, mine = i;
        for (int k = 0; k < KEPT; k++) {
            ties = ties || (depth == depths[k] && depth != NONE);
            bool nearer = depth < depths[k];
            uint d = depths[k], n = kept[k];
            depths[k] = nearer ? depth : d;
            kept[k] = nearer ? mine : n;
            depth = nearer ? d : depth;
            mine = nearer ? n : mine;
        }
        i = node.x;
    }
#ifdef SETTLES_TIES
    for (int k = 0; k + 1 < KEPT; k++)
        ties = ties || (depths[k + 1] != NONE && uintBitsToFloat(depths[k + 1]) - uintBitsToFloat(depths[k]) < COINCIDENT);
#endif
    return !ties;
}

#ifdef SETTLES_TIES
/* Parts that coincide, in their order; the surfaces of one stay as they are, for at its rim front and back are as near. The
 * last one stays the farthest: the next round goes on behind it. */
void order_coincident(uint depths[KEPT], uint orders[KEPT], inout uint kept[KEPT])
{
    float eyes[KEPT];
    for (int k = 0; k < KEPT; k++)
        eyes[k] = uintBitsToFloat(nodes[(max(kept[k], 1u) - 1u) * uint(NODE_VECTORS) + 1u].y);
    for (int end = KEPT - 2; end > 0; end--)
        for (int k = 0; k < end; k++) {
            float apart = abs(uintBitsToFloat(depths[k + 1]) - uintBitsToFloat(depths[k]));
            bool turned = depths[k + 1] != NONE && orders[k] >> 1 > orders[k + 1] >> 1 && apart < COINCIDENT &&
                          abs(eyes[k + 1] - eyes[k]) < COINCIDENT_EYE * abs(eyes[k]);
            uint d = depths[k], o = orders[k], n = kept[k];
            float e = eyes[k];
            depths[k] = turned ? depths[k + 1] : d;
            orders[k] = turned ? orders[k + 1] : o;
            kept[k] = turned ? kept[k + 1] : n;
            eyes[k] = turned ? eyes[k + 1] : e;
            depths[k + 1] = turned ? d : depths[k + 1];
            orders[k + 1] = turned ? o : orders[k + 1];
            kept[k + 1] = turned ? n : kept[k + 1];
            eyes[k + 1] = turned ? e : eyes[k + 1];
        }
}
#endif

/* The full order, behind (least_depth, least_order). */
void sort_fully(uint head, uint least_depth, uint least_order, out uint kept[KEPT])
{
    uint depths[KEPT], orders[KEPT], ages[KEPT];
    for (int k = 0; k < KEPT; k++) {
        depths[k] = NONE;
        orders[k] = NONE;
        ages[k] = NONE;
        kept[k] = 0u;
    }
    uint i = head;
    while (i != 0u) {
        uint at = (i - 1u) * uint(NODE_VECTORS);
        uvec4 node = nodes[at];
        uint depth = node.y, age = node.z, order = order_of(uvec2(node.w, nodes[at + 1u].x)), mine = i;
        bool behind = depth > least_depth || (depth == least_depth && order >= least_order);
        depth = behind ? depth : NONE;
        for (int k = 0; k < KEPT; k++) {
            bool twin = depth == depths[k] && order == orders[k];
            bool older = twin && age < ages[k];
            ages[k] = older ? age : ages[k];
            kept[k] = older ? mine : kept[k];
            depth = twin ? NONE : depth;
            bool nearer = depth < depths[k] || (depth == depths[k] && order < orders[k] && depth != NONE);
            uint d = depths[k], o = orders[k], g = ages[k], n = kept[k];
            depths[k] = nearer ? depth : d;
            orders[k] = nearer ? order : o;
            ages[k] = nearer ? age : g;
            kept[k] = nearer ? mine : n;
            depth = nearer ? d : depth;
            order = nearer ? o : order;
            age = nearer ? g : age;
            mine = nearer ? n : mine;
        }
        i = node.x;
    }
#ifdef SETTLES_TIES
    order_coincident(depths, orders, kept);
#endif
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(u_list_box.xy);
    uint head = heads[pixel.y * int(u_list_box.z) + pixel.x];
    uint kept[KEPT];
#ifdef FOLLOWS
    uint last = texelFetch(t_last, ivec2(gl_FragCoord.xy), 0).LAST, least_depth = 0u, least_order = 0u;
    int some = last != 0u ? 1 : 0;
    for (int once = 0; once < some; once++) {
        uint at = (last - 1u) * uint(NODE_VECTORS);
        uvec4 node = nodes[at];
        least_depth = node.y;
        least_order = order_of(uvec2(node.w, nodes[at + 1u].x)) + 1u;
    }
    sort_fully(some == 1 ? head : 0u, least_depth, least_order, kept);
#else
    int unsettled = sort_by_depth(head, kept) ? 0 : 1;
    for (int once = 0; once < unsettled; once++)
        sort_fully(head, 0u, 0u, kept);
#endif
    out_nodes = uvec4(kept[0], KEPT > 1 ? kept[KEPT > 1 ? 1 : 0] : 0u, KEPT > 2 ? kept[KEPT > 2 ? 2 : 0] : 0u,
                      KEPT > 3 ? kept[KEPT > 3 ? 3 : 0] : 0u);
#if KEPT > 4
    out_more = uvec4(kept[4], KEPT > 5 ? kept[KEPT > 5 ? 5 : 0] : 0u, KEPT > 6 ? kept[KEPT > 6 ? 6 : 0] : 0u,
                     KEPT > 7 ? kept[KEPT > 7 ? 7 : 0] : 0u);
#endif
}
