#include "light/light.glsl"

vec4 surface_colour(surface_point p)
{
    float light = p.unlit ? 1.0 : wrapped_light(p);
    int tone = int(floor((light + 0.5 * u_bias) * float(u_palette_count)));
    vec3 colour = u_palette[clamp(tone, 0, u_palette_count - 1)].rgb;
    return vec4(shown(colour * mix(vec3(1.0), p.albedo.rgb, u_tint)), 1.0);
}
