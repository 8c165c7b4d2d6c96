#include "light/point.glsl"

vec4 surface_colour(surface_point p)
{
    vec3 colour = mix(u_colour.rgb, shown(p.albedo.rgb), u_model_colour);
    return vec4(colour, 1.0) * u_colour.a;
}
