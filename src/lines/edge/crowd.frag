/* How long the lines in a square of pixels are: pixels in a square pixel. An edge that is drawn parts pairs of pixels, 4/π for each pixel of its length, the mean of all directions. */
layout(location = 0) out vec4 out_0;

const float LENGTH_OF_PAIR = 0.7854, PIXELS = float(DIRECTION_APART * DIRECTION_APART);
/* Shells that nearly coincide change places from pixel to pixel; borders as dense as that, of each pixel, are no lines. */
const float CARPET = 0.7;

void main()
{
    ivec2 first = ivec2(gl_FragCoord.xy) * DIRECTION_APART, end = min(first + DIRECTION_APART, ivec2(u_size));
    vec2 lines = vec2(0.0), borders = vec2(0.0);
    for (int y = first.y; y < end.y; y++)
        for (int x = first.x; x < end.x; x++) {
            vec4 own = texelFetch(t_pairs, ivec2(x, y), 0);
            vec2 border = step(2.0, own.zw), line = max(own.xy, own.zw - 2.0 * border);
            lines += line;
            borders += max(border - line, 0.0);
        }
    float plain = lines.x + lines.y, between = borders.x + borders.y;
    out_0 = vec4((plain + (between < CARPET * PIXELS ? between : 0.0)) * LENGTH_OF_PAIR / PIXELS);
}
