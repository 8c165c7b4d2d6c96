/* A layer's ink, widened across by the halo. */
uniform vec2 u_texel;
layout(location = 0) out vec4 out_0;

void main()
{
    int reach = int(ceil(u_halo));
    float ink = 0.0;
    for (int x = -reach; x <= reach; x++) {
        vec4 edge = textureLod(t_edge, (gl_FragCoord.xy + vec2(float(x), 0.0)) * u_texel, 0.0);
        ink = max(ink, 1.0 - min(edge.b, edge.a));
    }
    out_0 = vec4(ink);
}
