/* Sum of the texels on a line through this one, farther ones with less weight. */
const int   SPREAD_REACH = 8;     /* texels: less than half a wave */
const float SPREAD_FALLOFF = 0.6; /* of the weight's logarithm, a texel: what is nearest counts, smoothed over a few texels */

vec4 spread_along(sampler2D traces, ivec2 at, ivec2 way)
{
    ivec2 last = textureSize(traces, 0) - 1;
    vec4 sum = vec4(0.0);
    for (int i = -SPREAD_REACH; i <= SPREAD_REACH; i++) {
        ivec2 from = at + i * way;
        bool inside = all(greaterThanEqual(from, ivec2(0))) && all(lessThanEqual(from, last));
        sum += texelFetch(traces, clamp(from, ivec2(0), last), 0) * (inside ? exp(-SPREAD_FALLOFF * abs(float(i))) : 0.0);
    }
    return sum * 0.291; /* the weights add up to 1 */
}
