/* Every fragment of the operands into a list of its pixel: next, depth, key, normal. Nodes are numbered from 1, 0 ends (layer/lists.glsl
 * says why). */
#include "csg/operand.glsl"

layout(std430, binding = 3) buffer heads_block { uint heads[]; };
layout(std430, binding = 4) buffer nodes_block { uvec4 nodes[]; };
layout(std430, binding = 5) buffer count_block { uint node_count; };

uniform uint u_node_limit;
uniform vec4 u_list_box;

void main()
{
    uint i = atomicAdd(node_count, 1u);
    if (i >= u_node_limit)
        return;
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(u_list_box.xy);
    uint next = atomicExchange(heads[pixel.y * int(u_list_box.z) + pixel.x], i + 1u);
    nodes[i] = uvec4(next, stored_at(fragment_depth()), fragment_key(), packed_normal());
}
