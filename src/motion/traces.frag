/* Ink of traces over the page, which is premultiplied and holds what is shown. */
uniform sampler2D t_ink; /* an edge map: 1 where there is none */
uniform vec4 u_ink;
layout(location = 0) out vec4 out_0;

void main()
{
    float ink = (1.0 - texelFetch(t_ink, ivec2(gl_FragCoord.xy), 0).r) * u_ink.a;
    out_0 = vec4(u_ink.rgb * ink, ink);
}
