/* The nearest of a pixel's fragments, in order: their nodes. Of fragments of one part at the same depth that face the same way the
 * first drawn stays. With FOLLOWS, those behind the last node of the round before. */
layout(std430, binding = 0) readonly buffer heads_block { uint heads[]; };
layout(std430, binding = 1) readonly buffer nodes_block { uint nodes[]; };

uniform vec4 u_list_box;
#ifdef FOLLOWS
uniform usampler2D t_last; /* of the round before */
#endif
layout(location = 0) out uvec4 out_nodes;
#if KEPT > 4
layout(location = 1) out uvec4 out_more;
#endif

const uint NONE = 0xFFFFFFFFu;

uint order_at(uint node)
{
    return nodes[node + 3u] << 1 | (nodes[node + 4u] >> 28 & 1u);
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(u_list_box.xy);
    uint depths[KEPT], orders[KEPT], kept[KEPT];
    for (int k = 0; k < KEPT; k++) {
        depths[k] = NONE;
        orders[k] = NONE;
        kept[k] = NONE;
    }
    uint i = heads[pixel.y * int(u_list_box.z) + pixel.x];
    uint least_depth = 0u, least_order = 0u;
#ifdef FOLLOWS
    uint last = texelFetch(t_last, ivec2(gl_FragCoord.xy), 0).LAST;
    if (last == NONE) {
        i = NONE;
    } else {
        least_depth = nodes[last * uint(NODE_WORDS) + 1u];
        least_order = order_at(last * uint(NODE_WORDS)) + 1u;
    }
#endif
    /* The bound is never reached; without one, the software driver takes several times as long. */
    for (int guard = 0; guard < 65536 && i != NONE; guard++) {
        uint node = i * uint(NODE_WORDS), depth = nodes[node + 1u], order = order_at(node), mine = i;
        bool behind = depth > least_depth || (depth == least_depth && order >= least_order);
        depth = behind ? depth : NONE;
        for (int k = 0; k < KEPT; k++) {
            bool same = depth == depths[k] && order == orders[k];
            int twins = same && depth != NONE ? 1 : 0;
            for (int once = 0; once < twins; once++) {
                if (nodes[mine * uint(NODE_WORDS) + 2u] < nodes[kept[k] * uint(NODE_WORDS) + 2u])
                    kept[k] = mine;
                depth = NONE;
            }
            bool nearer = depth < depths[k] || (depth == depths[k] && order < orders[k] && depth != NONE);
            uint d = depths[k], o = orders[k], n = kept[k];
            depths[k] = nearer ? depth : d;
            orders[k] = nearer ? order : o;
            kept[k] = nearer ? mine : n;
            depth = nearer ? d : depth;
            order = nearer ? o : order;
            mine = nearer ? n : mine;
        }
        i = nodes[node];
    }
    out_nodes = uvec4(kept[0], kept[1], kept[2], kept[3]);
#if KEPT > 4
    out_more = uvec4(kept[4], KEPT > 5 ? kept[KEPT > 5 ? 5 : 0] : NONE, KEPT > 6 ? kept[KEPT > 6 ? 6 : 0] : NONE,
                     KEPT > 7 ? kept[KEPT > 7 ? 7 : 0] : NONE);
#endif
}
