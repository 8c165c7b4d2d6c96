/* Fragments in lists, one a pixel. A node is two or, with colours, three vectors: next, window depth, age, part id; surface id, eye depth,
 * normal as an octahedron's two coordinates; shade and albedo as half floats. Depth bits of numbers that are not negative sort as whole
 * numbers. Nodes are numbered from 1 and 0 ends a list: software drivers run uncovered pixels of a block along, whose loads give
 * 0, and any other end would let them walk on for ever. */
layout(std430, binding = 0) buffer heads_block { uint heads[]; };
layout(std430, binding = 1) buffer nodes_block { uvec4 nodes[]; };
layout(std430, binding = 2) buffer count_block { uint node_count; };

uniform uint u_node_limit;
uniform uint u_order;           /* triangles drawn before: of what coincides in every respect the first stays, as in peeling */
uniform uint u_first_primitive;
uniform vec4 u_list_box;

void list_add(uvec2 id, float depth, float eye_depth, vec3 normal, vec4 shade, vec4 albedo)
{
    uint i = atomicAdd(node_count, 1u);
    if (i >= u_node_limit)
        return;
    vec2 flat_normal = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    if (normal.z < 0.0)
        flat_normal = (1.0 - abs(flat_normal.yx)) * vec2(flat_normal.x < 0.0 ? -1.0 : 1.0, flat_normal.y < 0.0 ? -1.0 : 1.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(u_list_box.xy);
    uint next = atomicExchange(heads[pixel.y * int(u_list_box.z) + pixel.x], i + 1u);
    uint at = i * uint(NODE_VECTORS);
    nodes[at] = uvec4(next, floatBitsToUint(depth), u_order + u_first_primitive + uint(gl_PrimitiveID), id.r);
    nodes[at + 1u] = uvec4(id.g, floatBitsToUint(eye_depth), floatBitsToUint(flat_normal.x), floatBitsToUint(flat_normal.y));
#if NODE_VECTORS > 2
    nodes[at + 2u] = uvec4(packHalf2x16(shade.rg), packHalf2x16(shade.ba), packHalf2x16(albedo.rg), packHalf2x16(albedo.ba));
#endif
}
