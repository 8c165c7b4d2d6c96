/* A figure as a depth sprite. */
#ifdef HAS_LINES
#include "lines/ink.glsl"
#endif
layout(location = 0) out vec4 out_0;

/* Parts that other figures draw are here for their edges alone. */
bool is_own(ivec2 at)
{
#ifdef HAS_COMPLEMENT
    return (texelFetch(t_id, at, 0).g & SURFACE_COMPLEMENT) == 0u;
#else
    return true;
#endif
}

#ifdef HAS_LINES
#include "compose/reach.glsl"
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(t_depth, pixel, 0).r;
    vec4 colour = texelFetch(t_shade, pixel, 0);
    if (!is_own(pixel)) {
        depth = 1.0;
        colour = vec4(0.0);
    }
#ifdef HAS_LINES
#ifdef MERGED
    detect_edges();
#endif
    vec4 ink = ink_at(pixel);
    colour = over(ink, colour);
    int search = depth >= 1.0 && colour.a > 0.0 ? 1 : 0;
    for (int once = 0; once < search; once++)
        depth = neighbour_depth(pixel);
#endif
    if (colour.a <= 0.0 || depth >= 1.0)
        discard;
    out_0 = colour;
    gl_FragDepth = depth;
}
