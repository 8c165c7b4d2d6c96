/* A layer's ink across: r the most within the halo, g the mean around. */
layout(location = 0) out vec4 out_0;

float ink_at(float x)
{
    vec4 edge = textureLod(t_edge, (gl_FragCoord.xy + vec2(x, 0.0)) * u_texel, 0.0);
    return 1.0 - min(edge.b, edge.a);
}

void main()
{
    int reach = int(ceil(u_halo));
    float most = 0.0, sum = 0.0;
    for (int x = -reach; x <= reach; x++)
        most = max(most, ink_at(float(x)));
    int crowded = u_clutter > 0.0 ? 12 : -1;
    for (int x = -crowded; x <= crowded; x++)
        sum += ink_at(2.0 * float(x));
    out_0 = vec4(u_halo > 0.0 ? most : 0.0, sum / 25.0, 0.0, 0.0);
}
