/* A line technique's edge map, of which the darkest stays by blending. */
uniform sampler2D t_edge;
layout(location = 0) out vec4 out_0;

void main()
{
    out_0 = texelFetch(t_edge, ivec2(gl_FragCoord.xy), 0);
}
