/* The geometry pass: writes those channels of the G-buffer that the figure needs, each where the prelude places it. */
#include "light/point.glsl"
#include "layer/material.glsl"

#ifdef AT_NORMAL_DEPTH
layout(location = AT_NORMAL_DEPTH) out vec4 out_normal_depth;
#endif
#ifdef AT_ID
layout(location = AT_ID) out uvec2 out_id;
uniform uint u_part_id;
uniform uint u_surface_id;
#endif
#ifdef AT_ALBEDO
layout(location = AT_ALBEDO) out vec4 out_albedo;
#endif
#ifdef AT_SHADE
layout(location = AT_SHADE) out vec4 out_shade;
uniform int u_unlit;
#endif
#ifdef CLIPPED
uniform vec4 u_clip_plane; /* eye space; what lies below is left out */
#endif

void main()
{
#ifdef CLIPPED
    if (dot(u_clip_plane.xyz, v_eye) + u_clip_plane.w < 0.0)
        discard;
#endif
#ifdef MERGED
    /* Early z reject by hand: only what the first pass left visible goes through edge detection. */
    if (gl_FragCoord.z > texelFetch(t_depth, ivec2(gl_FragCoord.xy), 0).r)
        discard;
#endif
    vec4 albedo = model_colour();
#ifdef CUT_OUT
    if (albedo.a < u_alpha_cutoff)
        discard;
#endif
    albedo.a = 1.0;
    vec3 normal = model_normal();
#if defined(AT_SHADE) || defined(DEFERRED)
    /* Lit from the side that is seen: the flat normal decides which that is, so that rims of smooth shapes never flip. */
    vec3 facing = cross(dFdx(v_eye), dFdy(v_eye));
    facing *= sign(-dot(facing, u_perspective > 0.5 ? v_eye : vec3(0.0, 0.0, -1.0)));
    bool turned = dot(facing, normal) < 0.0;
#endif
#ifdef AT_NORMAL_DEPTH
    out_normal_depth = vec4(normal, -v_eye.z);
#endif
#ifdef AT_ID
    out_id = uvec2(u_part_id, u_surface_id);
#ifdef DEFERRED
    if (turned)
        out_id.g |= 0x40000000u;
#endif
#endif
#ifdef AT_ALBEDO
    out_albedo = albedo;
#endif
#ifdef AT_SHADE
    out_shade = surface_colour(surface_point(v_eye, turned ? -normal : normal, albedo, u_unlit != 0));
#ifdef MERGED
    detect_edges();
#endif
#ifdef INKED
    out_shade = over(ink_at(ivec2(gl_FragCoord.xy)), out_shade);
#endif
#endif
}
