/* Noise on the plane that strokes lie on, as fine on the page at any zoom. Freudenberg 2003, sections 6.7.6 and 6.8. */
#include "gpu/hash.glsl"

/* A positive number as a power of two times 1 … 2, from its bits: logarithms and powers are what takes longest on software drivers. */
float power_below(float x)
{
    return intBitsToFloat(floatBitsToInt(x) & 0x7F800000);
}

/* log2(1 + y) and 2^y for y in 0 … 1, within 0.00015 and 0.00017, both exact at the ends. */
float log_of_rest(float y)
{
    return y + y * (1.0 - y) * (0.43807 + y * (-0.23669 + y * 0.08031));
}

float power_of_rest(float y)
{
    return 1.0 + y + y * (1.0 - y) * (-0.30407 - 0.07913 * y);
}

float number_of(uint hash)
{
    return float(int(hash >> 8u)) * (1.0 / 16777215.0);
}

/* Smooth noise in the plane, −1 … 1. */
vec2 plane_noise(vec2 at, uint seed)
{
    const uint RIGHT = 0x9e3779b1u, UP = 0x85ebca77u;
    vec2 low = floor(at), t = at - low;
    t = t * t * (3.0 - 2.0 * t);
    uint left = uint(int(low.x)) * RIGHT ^ seed, down = uint(int(low.y)) * UP;
    uint right = (uint(int(low.x)) * RIGHT + RIGHT) ^ seed, up = down + UP;
    return mix(mix(corner_noise(left ^ down), corner_noise(right ^ down), t.x), mix(corner_noise(left ^ up), corner_noise(right ^ up), t.x), t.y);
}

/* Noise of as many waves on the page at any zoom, `waves` to a unit, about: two octaves that hand over to each other. */
vec2 zoomed_noise(vec2 at, float waves, uint seed)
{
    float scale = power_below(waves), fraction = log_of_rest(waves / scale - 1.0);
    return mix(plane_noise(at * scale, seed), plane_noise(at * (2.0 * scale), seed), fraction);
}

/* The same, which changes so many times a second, smoothly. */
vec2 living_noise(vec2 at, float waves, uint seed, float change)
{
#ifdef WITH_CHANGE
    float step = floor(u_time * change), fraction = u_time * change - step;
    return mix(zoomed_noise(at, waves, seed + 0x9e37u * uint(step)), zoomed_noise(at, waves, seed + 0x9e37u * uint(step + 1.0)), fraction);
#else
    return zoomed_noise(at, waves, seed);
#endif
}
