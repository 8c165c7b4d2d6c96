#include "light/light.glsl"

vec4 surface_colour(surface_point p)
{
    if (p.unlit)
        return vec4(shown(p.albedo.rgb), 1.0);
    return vec4(shown(p.albedo.rgb * min(u_ambient + (1.0 - u_ambient) * diffuse_light(p), vec3(1.0))), 1.0);
}
