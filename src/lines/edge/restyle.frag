/* Where whole lines have run on, those of their full width do so, too. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    float radius = max(0.5 * u_line_width - 1.0, 0.0);
    int reach = int(ceil(radius));
    vec3 grown = vec3(0.0);
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
            vec3 more = max(texelFetch(t_whole, at, 0).rga - texelFetch(t_styled, at, 0).rga, vec3(0.0));
            grown = max(grown, more * clamp(radius + 1.0 - length(vec2(x, y)), 0.0, 1.0));
        }
    vec3 left = 1.0 - max(1.0 - texelFetch(t_edge, pixel, 0).rga, grown);
    out_0 = vec4(left.r, left.g, left.r * left.g, left.b);
}
