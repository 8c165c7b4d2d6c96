/* Shades a figure from its G-buffer. Nienhaus 2005, section 3.6; row E04. */
#include "light/point.glsl"
#ifdef HAS_CUT
#include "light/cut.glsl"
#endif

#ifdef HAS_DEPTH_CUE
#include "light/depth_cue.glsl"
#endif

layout(location = 0) out vec4 out_shade;

vec3 eye_of(vec2 pixel, float depth)
{
    return vec3((2.0 * pixel / u_size - 1.0) * u_unproject * (u_perspective > 0.5 ? depth : 1.0), -depth);
}

#if defined(LIT_WITH_SHADOW) && !defined(HAS_SOFT_SHADOW)
/* From here to the next pixel of the surface along one axis: on the side where it runs on as its normal says. */
vec3 along_surface(vec3 eye, vec3 normal, ivec2 pixel, ivec2 axis)
{
    ivec2 last = textureSize(t_normal_depth, 0) - 1;
    vec3 before = eye - eye_of(vec2(pixel - axis) + 0.5, texelFetch(t_normal_depth, clamp(pixel - axis, ivec2(0), last), 0).w);
    vec3 behind = eye_of(vec2(pixel + axis) + 0.5, texelFetch(t_normal_depth, clamp(pixel + axis, ivec2(0), last), 0).w) - eye;
    return abs(dot(normal, before)) * length(behind) < abs(dot(normal, behind)) * length(before) ? before : behind;
}

/* Of the flat surface that was drawn; the normal itself where what lies around is another one. */
vec3 face_of(vec3 eye, vec3 normal, ivec2 pixel)
{
    vec3 face = cross(along_surface(eye, normal, pixel, ivec2(1, 0)), along_surface(eye, normal, pixel, ivec2(0, 1)));
    face /= max(length(face), 1e-30);
    return dot(face, normal) > 0.5 ? face : normal;
}
#else
vec3 face_of(vec3 eye, vec3 normal, ivec2 pixel)
{
    return normal;
}
#endif

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
