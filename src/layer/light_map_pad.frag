/* Carries light across the borders of islands, so that lookups near them find some. */
uniform sampler2D t_light_map;
layout(location = 0) out vec4 out_light;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy), last = textureSize(t_light_map, 0) - 1;
    vec4 own = texelFetch(t_light_map, at, 0), sum = vec4(0.0);
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++) {
            vec4 near = texelFetch(t_light_map, clamp(at + ivec2(x, y), ivec2(0), last), 0);
            sum += vec4(near.rgb, 1.0) * step(0.5, near.a);
        }
    out_light = own.a > 0.5 ? own : sum.a > 0.0 ? vec4(sum.rgb / sum.a, 1.0) : vec4(0.0);
}
