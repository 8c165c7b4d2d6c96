/* A depth picture as numbers, for drivers that do not read depth back. */
uniform sampler2D t_depth;
layout(location = 0) out vec4 out_0;

void main()
{
    out_0 = vec4(texelFetch(t_depth, ivec2(gl_FragCoord.xy), 0).r);
}
