/* Cut faces: a flat colour, and the lines that hatch it. */
#include "light/shown.glsl"

uniform vec4  u_cut_lines;  /* distance and width in pixels, angle in radians */
uniform vec4  u_cut_colour; /* of the lines, straight alpha */
uniform vec4  u_cut_fill;   /* w below 0: from the part's own colour */

/* How much of the pixel the hatch covers, 0 where the id is no cut face's. As draughtsmen do, each part and body turns its lines,
 * and what has the same angle has another distance; planes that meet in a corner differ as well. */
float cut_hatch(ivec2 pixel, uvec2 id)
{
    if ((id.g & SURFACE_CUT) == 0u || u_cut_lines.x <= 0.0)
        return 0.0;
    const float turns[6] = float[6](0.0, 90.0, -15.0, 105.0, 15.0, 75.0);
    const float axes[4] = float[4](0.0, 90.0, 50.0, 0.0);
    const float scales[3] = float[3](1.0, 0.8, 1.25);
    uint index = id.r + ((id.g >> 8) & 0xFFFu) - 1u;
    float angle = u_cut_lines.z + radians(turns[index % 6u] + axes[(id.g >> 6) & 3u]);
    float apart = u_cut_lines.x * scales[(index / 2u) % 3u];
    float across = dot(vec2(pixel) + 0.5, vec2(-sin(angle), cos(angle))) + 0.37 * float(index);
    float off = abs(mod(across, apart) - 0.5 * apart);
    return clamp(0.5 * u_cut_lines.y + 0.5 - off, 0.0, 1.0);
}

/* The cut face's colour, opaque and unlit. */
vec4 cut_colour(ivec2 pixel, uvec2 id, vec3 albedo)
{
    vec3 fill = u_cut_fill.w < 0.0 ? shown(mix(albedo, vec3(1.0), 0.72)) : mix(vec3(1.0), u_cut_fill.rgb, u_cut_fill.w);
    return vec4(mix(fill, u_cut_colour.rgb, cut_hatch(pixel, id) * u_cut_colour.a), 1.0);
}
