/* A figure as a depth sprite. What is drawn lies as deep as the nearer of what the lines and the fill show. */
#include "compose/positions.glsl"
#ifdef HAS_LINES
#include "lines/ink.glsl"
#endif
layout(location = 0) out vec4 out_0;

/* Parts that other figures draw are here for their edges alone. */
bool is_own(ivec2 at)
{
#if defined(SHARED_LAYERS)
    uint surface = texelFetch(t_id, at, 0).g;
    return (surface & SURFACE_COMPLEMENT) == 0u && int((surface >> SURFACE_INDEX_BITS) & SURFACE_FIGURE_MASK) == u_figure;
#elif defined(HAS_COMPLEMENT)
    return (texelFetch(t_id, at, 0).g & SURFACE_COMPLEMENT) == 0u;
#else
    return true;
#endif
}

float own_depth(ivec2 at)
{
    float depth = texelFetch(t_depth, at, 0).r;
    return is_own(at) ? depth : 1.0;
}

#ifdef HAS_LINES
#include "compose/reach.glsl"
#endif

#if defined(HAS_LINES) && defined(JOINS_INK)
#include "compose/joined.glsl"
#endif

#ifdef PERTURBED
/* The nearest of the pixels that a position between them mixes: at the border of the fill some have none, and it is as soft as a pixel there. */
float depth_around(vec2 position)
{
    ivec2 first = ivec2(floor(position)), last = ivec2(u_size) - 1;
    float least = 1.0;
    for (int i = 0; i < 4; i++)
        least = min(least, own_depth(clamp(first + ivec2(i % 2, i / 2), ivec2(0), last)));
    return least;
}

/* Paper where the fill fell short of the outline, and under the grains that it leaves bare; not where a surface has none. What stands behind is
 * hidden by it. Nienhaus 2005, section 6.4. */
vec4 fallback_of(float alpha)
{
    return vec4(u_perturb_fallback.rgb, 1.0) * (u_perturb_fallback.a * alpha);
}
#endif

/* The figure at a pixel: its colour, and its depth, 1 where there is nothing. */
vec4 sprite_at(ivec2 pixel, out float depth)
{
    vec4 ink = vec4(0.0);
#ifdef PERTURBED
    float fill_depth = own_depth(pixel_at(fill_position()));
    depth = depth_around(fill_position());
    vec4 fill = depth < 1.0 ? shade_at(fill_position()) : vec4(0.0);
    depth = fill.a > 0.0 ? depth : 1.0;
#else
    /* Ink of further line techniques is folded into the fill, outside the boundary, too. Here all is looked up at the pixel itself, once. */
    bool own = is_own(pixel);
    float fill_depth = own ? texelFetch(t_depth, pixel, 0).r : 1.0;
    depth = fill_depth;
    vec4 fill = own ? shade_at(fill_position()) : vec4(0.0);
#endif
#ifdef HAS_LINES
#ifdef MERGED
    detect_edges();
#endif
#ifdef JOINS_INK
    ink = ink_of_copies(depth);
#else
    for (int i = LINE_COPIES - 1; i >= 0; i--) {
        vec2 position = line_position(i);
#ifdef PERTURBED
        float line_depth = own_depth(pixel_at(position));
#else
        float line_depth = fill_depth;
#endif
        vec4 own_ink = copy_ink(ink_at(position), i);
#ifdef PERTURBED
        int search = line_depth >= 1.0 && own_ink.a > 0.0 ? 1 : 0;
        int bare = line_depth < 1.0 && fill_depth >= 1.0 && i == 0 ? 1 : 0;
        for (int once = 0; once < bare; once++)
            fill = over(fill, fallback_of(texelFetch(t_shade, pixel_at(position), 0).a));
#else
        int search = line_depth >= 1.0 && max(own_ink.a, fill.a) > 0.0 ? 1 : 0;
#endif
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
#ifdef PERTURBED
#ifndef FILL_STAYS
    fill = mix(fallback_of(fill.a), fill, fill_fraction());
#endif
#endif
#if defined(HAS_MEETING) && defined(HAS_LINES)
    /* Ink alone lies on the other surface, too. */
    fill = fill_depth > other_depth(pixel) && depth < fill_depth ? vec4(0.0) : fill;
#endif
    return u_filled ? ink + fill * (1.0 - ink.a) : ink;
}

/* Lines alone are in few of the pixels of their tiles: software drivers leave out a loop that no pixel enters, and run all else. */
int may_have_any(ivec2 pixel)
{
#if defined(HAS_LINES) && !defined(PERTURBED) && !defined(MERGED) && !defined(JOINS_INK)
    return u_filled || ink_at(line_position(0)).a > 0.0 ? 1 : 0;
#else
    return 1;
#endif
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    find_positions(pixel);
    vec4 colour = vec4(0.0);
    float depth = 1.0;
    int wanted = may_have_any(pixel);
    for (int once = 0; once < wanted; once++)
        colour = sprite_at(pixel, depth);
    if (colour.a <= 0.0 || depth >= 1.0)
        discard;
    out_0 = vec4(mix(colour.rgb, u_ghost.rgb * colour.a, u_ghost.a), colour.a);
    gl_FragDepth = depth;
}
