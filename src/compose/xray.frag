#include "light/point.glsl"
#include "compose/layered.glsl"

vec4 layer_fill(vec2 position)
{
    ivec2 pixel = pixel_at(position);
    float opacity = u_opacity;
#ifdef HAS_CUT
    /* Cut faces are what the section is made for: nearly solid. */
    if ((texelFetch(t_id, pixel, 0).g & SURFACE_CUT) != 0u)
        opacity = 1.0 - 0.2 * (1.0 - opacity);
#endif
    int slanted = u_rim > 0.0 ? 1 : 0;
    for (int once = 0; once < slanted; once++) {
        vec3 ray = normalize(vec3((2.0 * (vec2(pixel) + 0.5) / u_size - 1.0) * u_unproject * u_perspective, -1.0));
        float facing = abs(dot(texelFetch(t_normal_depth, pixel, 0).xyz, ray));
        opacity = mix(opacity, 1.0, u_rim * (1.0 - facing) * (1.0 - facing));
    }
    return shade_at(position) * opacity;
}

#ifdef HAS_LINES
vec4 layer_ink(vec4 ink)
{
    return ink;
}
#endif
