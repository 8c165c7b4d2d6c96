/* Ink where the shell is nearer than the figure; of several layers the first has it. */
#define OWN_WIDTH
#include "lines/edge/edge.glsl"

/* Of window depth: what two ways to the same position may differ by. */
const float ROUNDING = 2e-6;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float shell = texelFetch(t_strokes, pixel, 0).r, own = texelFetch(t_depth, pixel, 0).r;
    write_edges(shell < own - ROUNDING && u_layer == 0 ? 0.0 : 1.0, 1.0, 1.0);
}
