/* Which tiles have ink within reach of one pixel's neighbours: passes over lines leave out the rest. */
layout(location = 0) out vec4 out_0;

const int BESIDE = 2;

void main()
{
    ivec2 corner = ivec2(gl_FragCoord.xy) * TILE_PIXELS, last = ivec2(u_size) - 1;
    float least = 1.0;
    for (int y = -BESIDE; y < TILE_PIXELS + BESIDE; y++)
        for (int x = -BESIDE; x < TILE_PIXELS + BESIDE; x++) {
            vec2 edge = texelFetch(t_edge, clamp(corner + ivec2(x, y), ivec2(0), last), 0).ba;
            least = min(least, min(edge.x, edge.y));
        }
    out_0 = vec4(least < 1.0 ? 1.0 : 0.0);
}
