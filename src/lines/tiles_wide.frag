/* Tiles within reach of those that have ink. */
#include "lines/reach.glsl"
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 last = textureSize(t_tiles, 0) - 1;
    int reach = line_reach() / TILE_PIXELS + 1;
    float most = 0.0;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++)
            most = max(most, texelFetch(t_tiles, clamp(ivec2(gl_FragCoord.xy) + ivec2(x, y), ivec2(0), last), 0).r);
    out_0 = vec4(most);
}
