/* What layers add up to, onto the page. */
layout(location = 0) out vec4 out_0;

void main()
{
    vec4 sum = texelFetch(t_layers, ivec2(gl_FragCoord.xy), 0);
    if (sum.a >= 1.0)
        discard;
    out_0 = vec4(sum.rgb, 1.0 - sum.a);
}
