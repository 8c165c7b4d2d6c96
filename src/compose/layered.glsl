/* One layer of a figure, put under those in front of it: fill, and ink over it. The composition's own file says what the fill is
 * and what becomes of the ink. */
#include "compose/positions.glsl"
#ifdef HAS_LINES
#include "lines/ink.glsl"
#endif
layout(location = 0) out vec4 out_0;

/* Several figures share their layers, so that they interleave; each draws its own pixels. */
bool is_own(ivec2 at)
{
#ifdef SHARED_LAYERS
    return int((texelFetch(t_id, at, 0).g >> SURFACE_INDEX_BITS) & SURFACE_FIGURE_MASK) == u_figure;
#else
    return true;
#endif
}

#ifdef HAS_CUT
#include "light/cut.glsl"
#endif

vec4 layer_fill(vec2 position);

#ifdef HAS_LINES
#include "compose/reach.glsl"

vec4 layer_ink(vec4 ink);

#if defined(HAS_EDGE_BEFORE) && ONCE
float ink_before(ivec2 at)
{
    vec4 edge = texelFetch(t_edge_before, clamp(at, ivec2(0), ivec2(u_size) - 1), 0);
    return 1.0 - min(edge.b, edge.a);
}
#endif

#ifdef HAS_CUT
float hatch_of(ivec2 pixel)
{
    return is_own(pixel) ? cut_hatch(pixel, texelFetch(t_id, pixel, 0).rg) : 0.0;
}
#endif

/* Ink of this layer's i-th repetition as its position in the stack leaves it. */
vec4 stacked_ink(vec2 position, int i)
{
    ivec2 pixel = pixel_at(position);
    vec4 ink = layer_ink(ink_at(position));
#ifdef HAS_CUT
    /* Cut faces are hatched in the ink of the lines, but once, and where the fill is looked up. */
    if (i == 0)
        ink = over(ink, vec4(u_line_colour.rgb, 1.0) * (u_line_colour.a * hatch_of(pixel_at(fill_position()))));
#endif
    int hidden = u_layer > 0 && ink.a > 0.0 ? 1 : 0;
    for (int once = 0; once < hidden; once++) {
        ink *= u_hidden_opacity * pow(u_fade, float(u_layer - 1));
        /* Outlines and borders of parts carry the shape, creases the detail: those go first. */
        vec4 edge = edge_at(position);
        float important = max(1.0 - edge.r, 1.0 - edge.a);
        ink *= pow(1.0 - u_clutter * mix(0.5, 0.15, important), float(u_layer));
#if defined(HAS_EDGE_BEFORE) && ONCE
        /* A line lies on either side of its edge; the same edge in front is within half its width. */
        float before = ink_before(pixel);
        int reach = max(int(ceil(0.5 * u_line_width)), 1);
        for (int k = 1; k <= reach; k++)
            before = max(before, max(max(ink_before(pixel + ivec2(k, 0)), ink_before(pixel - ivec2(k, 0))),
                                     max(ink_before(pixel + ivec2(0, k)), ink_before(pixel - ivec2(0, k)))));
        /* Of the same edge it has as much of the pixel. */
        ink *= clamp(1.0 - before / max(1.0 - min(edge.b, edge.a), 1e-3), 0.0, 1.0);
#endif
#ifdef HAS_NEARER
        vec4 nearer = texelFetch(t_nearer, pixel, 0);
        ink *= 1.0 - nearer.r;
        ink *= 1.0 - u_clutter * smoothstep(0.03, 0.3, nearer.g) * mix(1.0, 0.5, important);
#endif
    }
    return ink;
}
#endif

float own_depth(ivec2 at)
{
    float depth = texelFetch(t_depth, at, 0).r;
    return is_own(at) ? depth : 1.0;
}

#if defined(HAS_LINES) && defined(JOINS_INK)
#define MEAN_OF_INK
#include "compose/joined.glsl"
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    find_positions(pixel);
    float surface = own_depth(pixel_at(fill_position())), depth = surface;
    vec4 fill = depth < 1.0 && u_filled ? layer_fill(fill_position()) : vec4(0.0), ink = vec4(0.0);
#ifdef HAS_LINES
#ifdef MERGED
    detect_edges();
#endif
#ifdef JOINS_INK
    ink = ink_of_copies(depth);
#else
    for (int i = LINE_COPIES - 1; i >= 0; i--) {
        vec2 position = line_position(i);
        float line_depth = own_depth(pixel_at(position));
        vec4 own_ink = copy_ink(stacked_ink(position, i), i);
        int search = line_depth >= 1.0 && own_ink.a > 0.0 ? 1 : 0;
        for (int once = 0; once < search; once++)
            line_depth = neighbour_depth(pixel_at(position));
#ifdef HAS_MEETING
        int inked = own_ink.a > 0.0 ? 1 : 0;
        for (int once = 0; once < inked; once++)
            line_depth = met_depth(position, line_depth);
#endif
#ifdef HAS_FOCUS
        own_ink *= in_focus_of_window(line_depth);
#endif
        depth = min(depth, line_depth);
        ink = over(own_ink, ink);
    }
#endif
#endif
#if defined(HAS_MEETING) && defined(HAS_LINES)
    /* Ink alone lies on the other surface, too. */
    fill = surface > other_depth(pixel) && depth < surface ? vec4(0.0) : fill;
#endif
    vec4 colour = ink + fill * (fill_fraction() * (1.0 - ink.a));
#ifdef SEEN_DEPTH
    /* A surface is there, too, where its fill shows nothing. */
    colour.a = surface < 1.0 ? 1.0 : colour.a;
#endif
    if (colour.a <= 0.0 || depth >= 1.0)
        discard;
    out_0 = colour * (u_rear * (1.0 - u_ghost.a));
    gl_FragDepth = max(depth - u_forward, 0.0);
}
