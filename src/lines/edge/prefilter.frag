/* Sharpens (or, negative, blurs) the normal-depth buffer: centre 1 + 8s, each neighbour −s. Müller, section 2.2, says "a simple
 * sharpen kernel with factor about −0.1" and that lines become softer and stronger: that holds when −0.1 is the weight of each
 * neighbour, which is s = 0.1 here; s = −0.1 makes the lines of creases wider, but paler. Row P6. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    vec4 sum = vec4(0.0);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            if (x != 0 || y != 0)
                sum += texelFetch(t_normal_depth, clamp(pixel + ivec2(x, y), ivec2(0), last), 0);
    vec4 centre = texelFetch(t_normal_depth, pixel, 0);
    out_0 = centre * (1.0 + 8.0 * u_line_sharpen) - u_line_sharpen * sum;
}
