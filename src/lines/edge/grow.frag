/* Lines wider than two pixels: the darkest map value within the disc that is missing to the width, its rim antialiased. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    float radius = 0.5 * (u_line_width - 2.0);
    int reach = int(ceil(radius));
    vec4 least = texelFetch(t_edge, pixel, 0);
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            float inside = clamp(radius + 1.0 - length(vec2(x, y)), 0.0, 1.0);
            vec4 value = texelFetch(t_edge, clamp(pixel + ivec2(x, y), ivec2(0), last), 0);
            least = min(least, mix(vec4(1.0), value, inside));
        }
    out_0 = least;
}
