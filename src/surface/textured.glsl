#include "light/light.glsl"

vec4 surface_colour(surface_point p)
{
    if (p.unlit)
        return vec4(shown(p.albedo.rgb), 1.0);
    vec3 light = min(0.25 + 0.75 * diffuse_light(p), vec3(1.0));
    return vec4(shown(p.albedo.rgb * mix(vec3(1.0), light, u_light)), 1.0);
}
