/* A fragment of an operand: its key and its depth. Fragments that lie in a plane which several operands share
 * get that plane's depth at the pixel, by the same arithmetic whichever triangle they come from: what is coincident is equal. */
#include "csg/depth.glsl"

in vec3 v_normal;
in float v_depth;
flat in uint v_key;

#ifdef SHARED_PLANES
uniform sampler2D t_planes; /* eye space, 256 a row */
uniform float u_solid_step; /* planes of different solids never coincide: each lies a rounding farther than the one before */
#endif

/* Does the solid begin here, seen from the front, operand, plane: src/csg/csg.h. */
uint fragment_key()
{
    bool kept = (v_key & 0x80000000u) != 0u;
    return (v_key & 0x3FFFFFFFu) | (gl_FrontFacing == kept ? 0x80000000u : 0u) | (gl_FrontFacing ? 0x40000000u : 0u);
}

#ifdef SHARED_PLANES
float depth_on(vec4 plane, float otherwise)
{
    vec2 ndc = 2.0 * gl_FragCoord.xy / u_size - 1.0;
    vec3 across = vec3(ndc * u_unproject, 0.0), along = vec3(across.xy * u_perspective, -1.0), from = across * (1.0 - u_perspective);
    float slope = dot(plane.xyz, along);
    /* Nearly along the ray there is no telling; such fragments are few and thin. */
    return abs(slope) > 1e-4 * length(along) ? (plane.w - dot(plane.xyz, from)) / slope : otherwise;
}

#endif

/* Of the eye. */
float fragment_depth()
{
    float depth = v_depth;
#ifdef SHARED_PLANES
    uint plane = v_key & 0xFFFFu;
    int shared_plane = plane != 0u ? 1 : 0;
    for (int once = 0; once < shared_plane; once++)
        depth = depth_on(texelFetch(t_planes, ivec2(int(plane - 1u) & 255, int(plane - 1u) >> 8), 0), depth) * u_solid_step;
#endif
    return depth;
}

/* Octahedron coordinates in 16 bits each. */
uint packed_normal()
{
    vec3 n = v_normal / max(abs(v_normal.x) + abs(v_normal.y) + abs(v_normal.z), 1e-30);
    vec2 flat_normal = n.z < 0.0 ? (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0) : n.xy;
    uvec2 steps = uvec2(clamp(flat_normal * 0.5 + 0.5, 0.0, 1.0) * 65534.0 + 0.5);
    return steps.x | steps.y << 16;
}
