/* Shades a figure from its G-buffer. Nienhaus 2005, section 3.6; row E04. */
#include "light/point.glsl"
#ifdef HAS_CUT
#include "light/cut.glsl"
#endif

#ifdef HAS_DEPTH_CUE
#include "light/depth_cue.glsl"
#endif

layout(location = 0) out vec4 out_shade;

#include "light/face.glsl"

vec4 shade_of(ivec2 pixel, uvec2 id)
{
    vec4 normal_depth = texelFetch(t_normal_depth, pixel, 0);
    vec3 eye = eye_of(gl_FragCoord.xy, normal_depth.w);
    vec3 normal = (id.g & SURFACE_TURNED) != 0u ? -normal_depth.xyz : normal_depth.xyz; /* the geometry pass knows the side */
    vec4 albedo = texelFetch(t_albedo, pixel, 0);
#ifdef ON_GROUND
    vec4 shade = surface_colour(surface_point(eye, normal, face_of(eye, normal, pixel), albedo, false, id.r));
#else
    vec4 shade = surface_colour(surface_point(eye, normal, face_of(eye, normal, pixel), vec4(albedo.rgb, 1.0), albedo.a == ALBEDO_UNLIT, id.r));
#ifdef HAS_DEPTH_CUE
    shade = depth_cued(shade, normal_depth.w);
#endif
#endif
#ifdef HAS_CUT
    if ((id.g & SURFACE_CUT) != 0u)
        shade = cut_colour(pixel, id, albedo.rgb);
#endif
    return shade;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 id = texelFetch(t_id, pixel, 0).rg;
    bool other = (id.g & SURFACE_COMPLEMENT) != 0u;
#ifdef SHARED_LAYERS
    other = other || int((id.g >> SURFACE_INDEX_BITS) & SURFACE_FIGURE_MASK) != u_figure;
#endif
    /* Without a loop that skips what is empty: on software drivers whatever stands in a loop takes half as long again. */
    out_shade = id.r == 0u || other ? vec4(0.0) : shade_of(pixel, id);
}
