#include "light/light.glsl"
#ifdef HAS_WALLS
#include "surface/facade.glsl"
#elif defined(HAS_DETAIL)
vec4 surface_detail()
{
    return texelFetch(t_detail, ivec2(gl_FragCoord.xy), 0);
}
#endif

vec4 surface_colour(surface_point p)
{
    float light = p.unlit ? 1.0 : wrapped_light(p);
    int tone = int(floor((light + 0.5 * u_bias) * float(u_palette_count)));
    vec3 colour = u_palette[clamp(tone, 0, u_palette_count - 1)].rgb;
    vec3 wall = shown(colour * mix(vec3(1.0), p.albedo.rgb, u_tint));
#if defined(HAS_WALLS) || defined(HAS_DETAIL)
    /* Glass is as dark as the wall's tone is; light behind it is not. */
    vec4 share = surface_detail();
    vec3 glass = shown(u_glass.rgb * (colour / max(u_palette[u_palette_count - 1].rgb, vec3(1e-3))));
    wall = wall * (1.0 - share.x - share.y - share.z) + u_frame_colour.rgb * share.x + glass * share.y + u_lit.rgb * share.z;
#endif
    return vec4(wall, 1.0);
}
