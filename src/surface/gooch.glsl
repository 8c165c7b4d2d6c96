#include "light/light.glsl"

/* The key light alone gives the tone, as in listing 3-2 of Nienhaus 2005. */
vec4 surface_colour(surface_point p)
{
    float tone = 0.5 * dot(p.normal, towards_light(0, p.eye)) + 0.5;
    vec3 cool = min(u_cool.rgb + u_cool_fraction * p.albedo.rgb, vec3(1.0));
    vec3 warm = min(u_warm.rgb + u_warm_fraction * p.albedo.rgb, vec3(1.0));
    vec3 colour = mix(cool, warm, tone) + u_specular * highlight(p, u_shininess);
    return vec4(shown(min(colour, vec3(1.0))), 1.0);
}
