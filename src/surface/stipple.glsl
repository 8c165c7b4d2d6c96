/* What lies between dots: paper. On the ground are no dots that go with a surface: there they are worked out for each pixel, as even and as large. */
#include "gpu/hash.glsl"
#include "surface/halftone/paper_of.glsl"
#ifndef ON_GROUND
#include "surface/marks_paper.glsl"
#else
#include "surface/marks_law.glsl"

const float CELL = 1.0;     /* diameters: a cell has one dot at most, */
const float SHIFTED = 0.42; /* cells that it lies off the middle at most */

/* Multiples of two numbers, so that cells next to each other come at unlike tones and those of one tone are spread evenly. */
float rank_of(vec2 cell)
{
    return fract(dot(cell, vec2(0.7548777, 0.5698403)));
}

/* What the dot of a cell covers of the pixel; as dark as the shadow is at its middle, so that it is round. */
float dot_in(vec2 cell, vec2 at, float side)
{
    vec2  middle = (cell + 0.5 + SHIFTED * corner_noise(hash_of(uvec3(ivec3(cell, 0)), 3u))) * side;
    ivec2 pixel = clamp(ivec2(middle + u_anchor), ivec2(0), ivec2(u_size) - 1);
    float there = texelFetch(t_id, pixel, 0).r == 0u ? 0.0 : 1.0 - texelFetch(t_albedo, pixel, 0).a;
    float fraction = ink_of_cover(there, u_diameter) * side * side / (0.78539816 * u_diameter * u_diameter);
    float ink = ink_of_rank(rank_of(cell), fraction, u_grow * u_grow, u_fade);
    float square = 0.25 * u_diameter * u_diameter * ink, drawn = sqrt(max(square - 1.0 / 12.0, 0.25));
    return ink > 0.0 ? clamp(drawn + 0.5 - length(at - middle), 0.0, 1.0) * min(1.0, 3.0 * square) : 0.0;
}

vec4 surface_colour(surface_point p)
{
    float side = CELL * u_diameter, bare = 1.0;
    vec2  at = gl_FragCoord.xy - u_anchor, cell = floor(at / side);
    for (int i = 0; i < 9; i++)
        bare *= 1.0 - dot_in(cell + vec2(i % 3 - 1, i / 3 - 1), at, side);
    return mix(paper_of(p), vec4(u_ink.rgb, 1.0), u_ink.a * (1.0 - bare));
}
#endif
