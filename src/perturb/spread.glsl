/* Sum of the texels on a line through this one, farther ones with less weight. */
const int   SPREAD_REACH = 8; /* texels; uncertainty.c counts on them */
const float SPREAD_FALLOFF = 0.6; /* of the weight's logarithm, a texel: what is nearest counts, smoothed over a few texels */

vec4 spread_along(sampler2D traces, vec2 at, vec2 direction)
{
    vec2 texel = 1.0 / u_grid;
    vec4 sum = vec4(0.0);
    for (int i = -SPREAD_REACH; i <= SPREAD_REACH; i++)
        sum += textureLod(traces, (at + float(i) * direction) * texel, 0.0) * exp(-SPREAD_FALLOFF * abs(float(i)));
    return sum * 0.291; /* the weights add up to 1 */
}
