/* Jump flooding, Rong and Tan 2006: each pixel takes the nearest of what nine pixels know, a step apart; steps of one pixel first, which leaves about as few errors as a second
 * round at the end (1+JFA), then half as long each time. How long it takes depends on the width's logarithm alone. */
#include "lines/reach.glsl"
#include "lines/seed.glsl"
layout(location = 0) out uvec4 out_0;

void nearer(inout uint best, inout int least, uint word, ivec2 off)
{
    ivec2 there = off + seed_of(word);
    int square = there.x * there.x + there.y * there.y;
    bool better = word != NO_SEED && square < least;
    best = better ? packed_seed(there) : best;
    least = better ? square : least;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    int stride = u_iteration == 0 ? 1 : 1 << (flood_exponent() + 1 - u_iteration);
    uvec3 best = uvec3(NO_SEED);
    ivec3 least = ivec3(0x3FFFFFFF);
    int busy = texelFetch(t_tiles, pixel / TILE_PIXELS, 0).r > 0.0 ? 3 : 0;
    for (int y = 0; y < busy; y++)
        for (int x = 0; x < 3; x++) {
            ivec2 off = (ivec2(x, y) - 1) * stride, at = pixel + off;
            uvec3 words = texelFetch(t_seeds, clamp(at, ivec2(0), last), 0).xyz;
            words = clamp(at, ivec2(0), last) == at ? words : uvec3(NO_SEED);
            nearer(best.x, least.x, words.x, off);
            nearer(best.y, least.y, words.y, off);
            nearer(best.z, least.z, words.z, off);
        }
    out_0 = uvec4(best, 0u);
}
