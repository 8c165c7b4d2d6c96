/* I0 = 1/8 (|A+2B+C−F−2G−H| + |C+2E+H−A−2D−F|), I1 = 1/3 (8X − A − … − H), on normalised linear depth; 1 − |I| is the map.
 * The pencil weights are equation 3 of Müller: sums of absolute differences to the centre. */
#define FINDS_MEETINGS
#include "lines/edge/edge.glsl"

float depth_at(int x, int y)
{
    return normalised(texel(t_normal_depth, ivec2(gl_FragCoord.xy) + ivec2(x, y)).w);
}

void detect_edges()
{
    float a = depth_at(-1, 1), b = depth_at(0, 1), c = depth_at(1, 1);
    float d = depth_at(-1, 0), x = depth_at(0, 0), e = depth_at(1, 0);
    float f = depth_at(-1, -1), g = depth_at(0, -1), h = depth_at(1, -1);
#if WEIGHTS == 0
    float profile = 0.125 * (abs(a + 2.0 * b + c - f - 2.0 * g - h) + abs(c + 2.0 * e + h - a - 2.0 * d - f));
#else
    float corners = abs(a - x) + abs(c - x) + abs(f - x) + abs(h - x);
    float sides = abs(b - x) + abs(d - x) + abs(e - x) + abs(g - x);
    float profile = (WEIGHTS == 1 ? 1.0 : 4.0) * (0.125 * corners + 0.25 * sides);
#endif
    float inner = (8.0 * x - a - b - c - d - e - f - g - h) / 3.0;
    write_edges(1.0 - profile, 1.0 - abs(inner), 1.0);
}
