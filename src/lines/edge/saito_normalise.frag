/* The non-linear normalisation that Nienhaus 2005 (4.1) names without a formula: with the neighbourhood's least and greatest gradient
 * the profile becomes max·(1 − min/max)-like: a large jump saturates at one line instead of growing with its height, and inner
 * lines are left out where a jump of the gradient is a profile already, which is what doubles lines. */
#define FINDS_MEETINGS
#include "lines/edge/edge.glsl"

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float least = 1e9, greatest = 0.0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            float g = texel(t_gradient, pixel + ivec2(x, y)).r;
            least = min(least, g);
            greatest = max(greatest, g);
        }
    vec2 own = texel(t_gradient, pixel).rg;
    float rise = greatest - least;
    float profile = greatest > u_line_floor ? (rise / greatest) * min(greatest / u_line_jump, 1.0) : 0.0;
    float inner = greatest >= u_line_jump ? 0.0 : clamp(abs(own.y) / max(u_line_jump, 1e-6), 0.0, 1.0);
    write_edges(1.0 - profile, 1.0 - inner, 1.0);
}
