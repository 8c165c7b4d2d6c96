/* Directions averaged with those around on the same surface, farther in the second round; sure ones count for more. Müller, section 4.1, step 5, in the picture. */
layout(location = 0) out vec4 out_0;

ivec2 pixel_of(ivec2 texel)
{
    return min(texel * DIRECTION_APART + DIRECTION_APART / 2, ivec2(u_size) - 1);
}

vec4 weighed(ivec2 texel, vec3 normal, float weight)
{
    ivec2 at = clamp(texel, ivec2(0), textureSize(t_direction, 0) - 1);
    vec3 other = texelFetch(t_normal_depth, pixel_of(at), 0).xyz;
    return texelFetch(t_direction, at, 0) * (weight * step(0.8, dot(normal, other)));
}

vec4 smoothed(ivec2 texel, vec4 own)
{
    vec3 normal = texelFetch(t_normal_depth, pixel_of(texel), 0).xyz;
    vec4 sum = own * 2.0;
    int far = max(int(float(1 + 2 * u_iteration) * page_unit() + 0.5), 1);
    sum += weighed(texel + far * ivec2(1, 0), normal, 1.0) + weighed(texel - far * ivec2(1, 0), normal, 1.0);
    sum += weighed(texel + far * ivec2(0, 1), normal, 1.0) + weighed(texel - far * ivec2(0, 1), normal, 1.0);
    sum += weighed(texel + far * ivec2(2, -2), normal, 0.5) + weighed(texel - far * ivec2(2, -2), normal, 0.5);
    sum += weighed(texel + far * ivec2(2, 2), normal, 0.5) + weighed(texel - far * ivec2(2, 2), normal, 0.5);
    return vec4(sum.xy / sum.a, 0.0, 1.0);
}

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(t_direction, texel, 0);
    out_0 = vec4(0.0);
    int there = own.a > 0.0 ? 1 : 0;
    for (int once = 0; once < there; once++)
        out_0 = smoothed(texel, own);
}
