/* The edge map's ink as wide as the line: pixels beside an edge know where it is (t_feet), and lines cover as much of each pixel as a band around it does. Ink of which nobody
 * knows more than the pixel, of other operators, is two pixels wide as it is, and grows by what is missing. Of broad lines the pixels beside the edge are far; floods found the
 * nearest. */
#include "lines/reach.glsl"
#include "lines/cover.glsl"
#ifdef HAS_SEEDS
#include "lines/seed.glsl"
#endif
layout(location = 0) out vec4 out_0;

/* An edge goes on as a straight line for this long beside the pixel that knows it. */
const float STRAIGHT = 0.75;

/* How much of this pixel the line of the edge covers that the pixel at `off` knows. */
float cover_of(vec4 foot, vec2 off)
{
    float half_width = 0.5 * u_line_width;
    if (foot.w == 0.0)
        return clamp(max(half_width, 1.0) - length(off), 0.0, 1.0);
    float across = dot(foot.xy, off) + foot.z, along = dot(vec2(-foot.y, foot.x), off);
    vec2 beyond = vec2(across, max(abs(along) - STRAIGHT, 0.0));
    float d = length(beyond);
    vec2 normal = beyond.y > 0.0 ? (across * foot.xy + (off - dot(foot.xy, off) * foot.xy) * (beyond.y / max(abs(along), 1e-4))) / max(d, 1e-4) : foot.xy;
    return line_cover(d, normal, half_width);
}

/* Ink of the nine pixels around one at `middle` from here. */
vec3 ink_around(ivec2 pixel, ivec2 middle, vec3 classes)
{
    ivec2 last = ivec2(u_size) - 1;
    vec3 ink = vec3(0.0);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            ivec2 off = middle + ivec2(x, y), at = clamp(pixel + off, ivec2(0), last);
            vec3 there = (1.0 - texelFetch(t_edge, at, 0).rga) * classes;
            int inked = max(there.x, max(there.y, there.z)) > 0.0 ? 1 : 0;
            for (int once = 0; once < inked; once++) {
                vec4 foot = vec4(0.0);
#ifdef HAS_FEET
                foot = texelFetch(t_feet, at, 0);
#endif
                ink = max(ink, there * cover_of(foot, vec2(off)));
            }
        }
    return ink;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 ink = vec3(0.0);
    int busy = texelFetch(t_tiles, pixel / TILE_PIXELS, 0).r > 0.0 ? 1 : 0;
    for (int once = 0; once < busy; once++) {
#ifdef HAS_SEEDS
        uvec3 words = texelFetch(t_seeds, pixel, 0).xyz;
        for (int k = 0; k < 3; k++) {
            int found = words[k] != NO_SEED ? 1 : 0;
            for (int again = 0; again < found; again++)
                ink = max(ink, ink_around(pixel, seed_of(words[k]), vec3(k == 0, k == 1, k == 2)));
        }
#else
        ink = ink_around(pixel, ivec2(0), vec3(1.0));
#endif
    }
    vec3 left = 1.0 - ink;
    out_0 = vec4(left.r, left.g, left.r * left.g, left.b);
}
