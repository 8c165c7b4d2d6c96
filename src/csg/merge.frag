/* The depth of one batch of products among that of those before. */
uniform sampler2D t_depth;

void main()
{
    gl_FragDepth = texelFetch(t_depth, ivec2(gl_FragCoord.xy), 0).r;
}
