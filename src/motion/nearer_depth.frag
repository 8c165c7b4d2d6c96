/* The depth of what one sample has seen, for the nearest of all. */
uniform sampler2D t_sample_depth;

void main()
{
    float depth = texelFetch(t_sample_depth, ivec2(gl_FragCoord.xy), 0).r;
    if (depth >= 1.0)
        discard;
    gl_FragDepth = depth;
}
