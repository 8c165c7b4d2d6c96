/* One layer out of the lists, as the geometry pass would have drawn it. */
layout(std430, binding = 1) readonly buffer nodes_block { uvec4 nodes[]; };

uniform usampler2D t_nodes;
uniform int u_slot;
#ifdef AT_NORMAL_DEPTH
layout(location = AT_NORMAL_DEPTH) out vec4 out_normal_depth;
#endif
#ifdef AT_ID
layout(location = AT_ID) out uvec2 out_id;
#endif
#ifdef AT_ALBEDO
layout(location = AT_ALBEDO) out vec4 out_albedo;
#endif
#ifdef AT_SHADE
layout(location = AT_SHADE) out vec4 out_shade;
#endif

void main()
{
    uint index = texelFetch(t_nodes, ivec2(gl_FragCoord.xy), 0)[u_slot];
    gl_FragDepth = 1.0;
#ifdef AT_NORMAL_DEPTH
    out_normal_depth = vec4(0.0, 0.0, 1.0, u_far);
#endif
#ifdef AT_ID
    out_id = uvec2(0u);
#endif
#ifdef AT_ALBEDO
    out_albedo = vec4(1.0, 1.0, 1.0, 0.0);
#endif
#ifdef AT_SHADE
    out_shade = vec4(0.0);
#endif
    int some = index != 0u ? 1 : 0;
    for (int once = 0; once < some; once++) {
        uint node = (index - 1u) * uint(NODE_VECTORS);
        uvec4 position = nodes[node];
        gl_FragDepth = uintBitsToFloat(position.y);
#if defined(AT_NORMAL_DEPTH) || defined(AT_ID)
        uvec4 surface = nodes[node + 1u];
#endif
#ifdef AT_NORMAL_DEPTH
        vec2 flat_normal = uintBitsToFloat(surface.zw);
        vec3 normal = vec3(flat_normal, 1.0 - abs(flat_normal.x) - abs(flat_normal.y));
        float under = max(-normal.z, 0.0);
        normal.x += normal.x < 0.0 ? under : -under;
        normal.y += normal.y < 0.0 ? under : -under;
        out_normal_depth = vec4(normalize(normal), uintBitsToFloat(surface.y));
#endif
#ifdef AT_ID
        out_id = uvec2(position.w, surface.x);
#endif
#if defined(AT_SHADE) || defined(AT_ALBEDO)
        uvec4 colours = nodes[node + 2u];
#endif
#ifdef AT_ALBEDO
        out_albedo = vec4(unpackHalf2x16(colours.z), unpackHalf2x16(colours.w));
#endif
#ifdef AT_SHADE
        out_shade = vec4(unpackHalf2x16(colours.x), unpackHalf2x16(colours.y));
#endif
    }
}
