/* Where a composition looks the figure's maps up: at the pixel itself, unless a technique of the kind "perturb" says otherwise; its file
 * then comes first and has these functions. Integer positions are the centres of pixels. */
#ifdef HAS_FOCUS
#include "light/focus.glsl"
#endif

#ifndef PERTURBED
#define LINE_COPIES 1
vec2 s_position;

void find_positions(ivec2 pixel)
{
    s_position = vec2(pixel);
}

vec2 fill_position()
{
    return s_position;
}

vec2 line_position(int i)
{
    return s_position;
}

vec4 copy_ink(vec4 ink, int i)
{
    return ink;
}

float fill_fraction()
{
    return 1.0;
}
#endif

/* The pixel at a position. */
ivec2 pixel_at(vec2 position)
{
#ifdef PERTURBED
    return clamp(ivec2(floor(position + 0.5)), ivec2(0), ivec2(u_size) - 1);
#else
    return ivec2(position);
#endif
}

/* The fill's colour at a position of the figure. */
#ifdef HAS_SHADE
vec4 shade_at(vec2 position)
{
#if defined(PERTURBED) && !defined(FILL_STAYS)
    return textureLod(t_shade, (position + 0.5) / u_size, 0.0);
#else
    return texelFetch(t_shade, ivec2(position), 0);
#endif
}
#endif
