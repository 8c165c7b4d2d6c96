/* A figure's pictures as its composition finds them, for maps: the darkest of all copies of its lines, the fill, and the nearer of what both
 * show. Nienhaus et al. 2006, figures 3 and 4; row csg C20. */
#include "compose/positions.glsl"
layout(location = 0) out vec4 out_0; /* WRITES_TOO: the edge map; else the eye depth, 0 where nothing is */
#ifdef WRITES_TOO
layout(location = 1) out vec4 out_1; /* the fill */
#endif

bool is_own(ivec2 at)
{
#if defined(SHARED_LAYERS)
    return int((texelFetch(t_id, at, 0).g >> SURFACE_INDEX_BITS) & SURFACE_FIGURE_MASK) == u_figure;
#elif defined(HAS_COMPLEMENT)
    return (texelFetch(t_id, at, 0).g & SURFACE_COMPLEMENT) == 0u;
#else
    return true;
#endif
}

float own_depth(ivec2 at)
{
    return is_own(at) ? texelFetch(t_depth, at, 0).r : 1.0;
}

void main()
{
    find_positions(ivec2(gl_FragCoord.xy));
    float fill_depth = own_depth(pixel_at(fill_position()));
#ifdef WRITES_TOO
    out_0 = vec4(1.0);
#ifdef HAS_EDGE
    for (int i = 0; i < LINE_COPIES; i++)
        out_0 = min(out_0, textureLod(t_edge, (line_position(i) + 0.5) / u_size, 0.0));
#endif
#ifdef HAS_SHADE
    out_1 = fill_depth < 1.0 ? shade_at(fill_position()) : vec4(0.0);
#else
    out_1 = vec4(0.0);
#endif
#else
    float depth = fill_depth;
    for (int i = 0; i < LINE_COPIES; i++)
        depth = min(depth, own_depth(pixel_at(line_position(i))));
    out_0 = vec4(depth < 1.0 ? eye_depth_at_window(depth) : 0.0);
#endif
}
