/* Fragments in lists, one a pixel. A node: next, window depth, order, part id, surface id, eye depth, normal as an octahedron's
 * two coordinates, and with 10 words the shade.
 * Nodes are numbered from 1 and 0 ends a list: software drivers run uncovered pixels of a block along, whose loads give 0, and
 * any other end would let them walk on for ever. Depth bits of numbers that are not negative sort as whole numbers. */
layout(std430, binding = 0) buffer heads_block { uint heads[]; };
layout(std430, binding = 1) buffer nodes_block { uint nodes[]; };
layout(std430, binding = 2) buffer count_block { uint node_count; };

uniform uint u_node_limit;
uniform uint u_order;           /* triangles drawn before: of what coincides in every respect the first stays, as in peeling */
uniform uint u_first_primitive;
uniform vec4 u_list_box;

void list_add(uvec2 id, float depth, float eye_depth, vec3 normal, vec4 shade)
{
    uint i = atomicAdd(node_count, 1u);
    if (i >= u_node_limit)
        return;
    vec2 flat_normal = normal.xy / (abs(normal.x) + abs(normal.y) + abs(normal.z));
    if (normal.z < 0.0)
        flat_normal = (1.0 - abs(flat_normal.yx)) * vec2(flat_normal.x < 0.0 ? -1.0 : 1.0, flat_normal.y < 0.0 ? -1.0 : 1.0);
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(u_list_box.xy);
    uint at = i * uint(NODE_WORDS);
    nodes[at + 1u] = floatBitsToUint(depth);
    nodes[at + 2u] = u_order + u_first_primitive + uint(gl_PrimitiveID);
    nodes[at + 3u] = id.r;
    nodes[at + 4u] = id.g;
    nodes[at + 5u] = floatBitsToUint(eye_depth);
    nodes[at + 6u] = floatBitsToUint(flat_normal.x);
    nodes[at + 7u] = floatBitsToUint(flat_normal.y);
#if NODE_WORDS > 8
    nodes[at + 8u] = packHalf2x16(shade.rg);
    nodes[at + 9u] = packHalf2x16(shade.ba);
#endif
    nodes[at] = atomicExchange(heads[pixel.y * int(u_list_box.z) + pixel.x], i + 1u);
}
