/* The surface behind the current one. The first component is the surface's own node. */
layout(std430, binding = 4) readonly buffer nodes_block { uvec4 nodes[]; };
layout(std430, binding = 7) readonly buffer chain_block { uint chain[]; };

uniform usampler2D t_surfaces;
layout(location = 0) out uvec4 out_surface;

void main()
{
    uint own = texelFetch(t_surfaces, ivec2(gl_FragCoord.xy), 0).x;
    uint behind = own != 0u ? chain[own - 1u] : 0u;
    uvec4 node = behind != 0u ? nodes[behind - 1u] : uvec4(0u);
    out_surface = uvec4(behind, node.yzw);
}
