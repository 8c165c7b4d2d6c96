/* First step of the normalised operator: R the first-order, G the second-order difference, as they are. */
#include "lines/edge/edge.glsl"

float depth_at(int x, int y)
{
    return normalised(texel(t_normal_depth, ivec2(gl_FragCoord.xy) + ivec2(x, y)).w);
}

void main()
{
    float a = depth_at(-1, 1), b = depth_at(0, 1), c = depth_at(1, 1);
    float d = depth_at(-1, 0), x = depth_at(0, 0), e = depth_at(1, 0);
    float f = depth_at(-1, -1), g = depth_at(0, -1), h = depth_at(1, -1);
    float first = 0.125 * (abs(a + 2.0 * b + c - f - 2.0 * g - h) + abs(c + 2.0 * e + h - a - 2.0 * d - f));
    float second = (8.0 * x - a - b - c - d - e - f - g - h) / 3.0;
    out_edge = vec4(first, second, 0.0, 1.0);
}
