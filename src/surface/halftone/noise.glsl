/* Noise on the plane that strokes lie on, as fine on the page at any zoom. Seed 001, sections 6.7.6 and 6.8. */
#include "gpu/hash.glsl"

uniform float u_time; /* seconds */

float number_of(uint hash)
{
    return float(int(hash >> 8u)) * (1.0 / 16777215.0);
}

/* Smooth noise in the plane, two independent values −1 … 1: a table of numbers, mixed by the texture unit at places that are bent so that there are no kinks. It
 * repeats after as many waves as the table has numbers a side. */
vec2 plane_noise(vec2 at, uint seed)
{
    vec2 low = floor(at), t = at - low;
    t = t * t * (3.0 - 2.0 * t);
    vec2 shift = vec2(ivec2(int(seed * 37u & 127u), int(seed * 101u >> 2u & 127u)));
    return textureLod(t_noise, vec3((low + t + shift + 0.5) / u_noise_facts.x, 0.0), 0.0).rg * (510.0 / 255.0) - 1.0;
}

/* Noise of as many waves on the page at any zoom: two octaves that hand over to each other. */
vec2 zoomed_noise(vec2 at, float octave, uint seed)
{
    float low = floor(octave), share = octave - low;
    float scale = exp2(low);
    return mix(plane_noise(at * scale, seed), plane_noise(at * scale * 2.0, seed), share);
}

/* The same, which changes so many times a second, smoothly. */
vec2 living_noise(vec2 at, float octave, uint seed, float change)
{
    float step = floor(u_time * change), share = u_time * change - step;
    vec2 noise = zoomed_noise(at, octave, seed + 0x9e37u * uint(step));
    int moves = share > 0.0 ? 1 : 0;
    for (int once = 0; once < moves; once++)
        noise = mix(noise, zoomed_noise(at, octave, seed + 0x9e37u * uint(step + 1.0)), share);
    return noise;
}
