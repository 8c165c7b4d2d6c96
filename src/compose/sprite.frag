/* A figure as a depth sprite. */
#ifdef HAS_LINES
#include "lines/ink.glsl"
#endif
layout(location = 0) out vec4 out_0;

#ifdef HAS_LINES
/* Depth of the nearest surface within the line's reach: the outer half of an outline belongs to the surface it surrounds. */
float neighbour_depth(ivec2 pixel)
{
    ivec2 last = ivec2(u_size) - 1;
    float extent = 0.5 * u_line_width;
#if CONTRAST == 1
    extent += max(abs(u_line_offset_x), abs(u_line_offset_y));
#elif CONTRAST == 3
    extent += max(u_line_width, 1.0);
#endif
    int reach = max(int(ceil(extent)), 1);
    float least = 1.0;
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
#ifdef HAS_COMPLEMENT
            if ((texelFetch(t_id, at, 0).g & 0x80000000u) != 0u)
                continue;
#endif
            least = min(least, texelFetch(t_depth, at, 0).r);
        }
    return least;
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    float depth = texelFetch(t_depth, pixel, 0).r;
    vec4 colour = texelFetch(t_shade, pixel, 0);
#ifdef HAS_COMPLEMENT
    /* Parts that other figures draw are here for their edges alone. */
    if ((texelFetch(t_id, pixel, 0).g & 0x80000000u) != 0u) {
        depth = 1.0;
        colour = vec4(0.0);
    }
#endif
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
