#include "light/light.glsl"

vec4 surface_colour(surface_point p)
{
    vec3 own = mix(vec3(1.0), p.albedo.rgb, u_model_colour);
    if (p.unlit)
        return vec4(shown(own), 1.0);
    vec3 light = min(u_ambient + (1.0 - u_ambient) * diffuse_light(p), vec3(1.0));
    vec3 colour = mix(own, vec3(1.0), u_lightness) * light + u_specular * highlight(p, u_shininess);
    return vec4(shown(min(colour, vec3(1.0))), 1.0);
}
