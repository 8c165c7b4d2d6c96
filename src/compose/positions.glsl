/* Where a composition looks the figure's maps up: at the pixel itself, unless a technique of the kind "perturb" says otherwise; its file
 * then comes first and has these functions. Integer places are the centres of pixels. */
#ifdef HAS_FOCUS
#include "light/focus.glsl"
#endif

#ifndef PERTURBED
#define LINE_COPIES 1
vec2 s_place;

void find_places(ivec2 pixel)
{
    s_place = vec2(pixel);
}

vec2 fill_place()
{
    return s_place;
}

vec2 line_place(int i)
{
    return s_place;
}

vec4 copy_ink(vec4 ink, int i)
{
    return ink;
}

float fill_share()
{
    return 1.0;
}
#endif

/* The pixel at a place. */
ivec2 pixel_at(vec2 place)
{
#ifdef PERTURBED
    return clamp(ivec2(floor(place + 0.5)), ivec2(0), ivec2(u_size) - 1);
#else
    return ivec2(place);
#endif
}

/* The fill's colour at a place of the figure. */
#ifdef HAS_SHADE
vec4 shade_at(vec2 place)
{
#if defined(PERTURBED) && !defined(FILL_STAYS)
    return textureLod(t_shade, (place + 0.5) / u_size, 0.0);
#else
    return texelFetch(t_shade, ivec2(place), 0);
#endif
}
#endif
