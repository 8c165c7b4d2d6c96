/* The mean of what a pixel has seen of the object, where nothing that stands still hides it. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 colour = texelFetch(t_scattered, pixel, 0);
    float depth = texelFetch(t_scattered_depth, pixel, 0).r;
    if (colour.a <= 0.0 || depth > texelFetch(t_scene_depth, pixel, 0).r)
        discard;
    out_0 = colour;
    gl_FragDepth = depth;
}
