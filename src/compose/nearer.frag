/* The same upwards, and the nearer layers' added. */
layout(location = 0) out vec4 out_0;

vec2 row_at(float y)
{
    return textureLod(t_nearer_row, (gl_FragCoord.xy + vec2(0.0, y)) * u_texel, 0.0).rg;
}

void main()
{
    int reach = int(ceil(u_halo));
    vec2 before = vec2(0.0);
#ifdef HAS_NEARER
    before = texelFetch(t_nearer, ivec2(gl_FragCoord.xy), 0).rg;
#endif
    float most = before.r, sum = 0.0;
    for (int y = -reach; y <= reach; y++)
        most = max(most, row_at(float(y)).r);
    int crowded = u_clutter > 0.0 ? 12 : -1;
    for (int y = -crowded; y <= crowded; y++)
        sum += row_at(2.0 * float(y)).g;
    out_0 = vec4(most, before.g + sum / 25.0, 0.0, 0.0);
}
