#include "light/light.glsl"
#ifdef HAS_WALLS
#include "surface/facade.glsl"
#endif

vec4 surface_colour(surface_point p)
{
    float light = p.unlit ? 1.0 : wrapped_light(p);
    int tone = int(floor((light + 0.5 * u_bias) * float(u_palette_count)));
    vec3 colour = u_palette[clamp(tone, 0, u_palette_count - 1)].rgb;
    vec3 wall = colour * mix(vec3(1.0), p.albedo.rgb, u_tint);
#ifdef HAS_WALLS
    return vec4(with_facade(shown(wall), colour / max(u_palette[u_palette_count - 1].rgb, vec3(1e-3))), 1.0);
#endif
    return vec4(shown(wall), 1.0);
}
