/* Dots at the corners of a square grid, of one half as wide, and so on, as many as the picture has room for. */
#include "surface/dot_area.glsl"
#include "surface/halftone/position.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/noise.glsl"

surface_point s_point;
rest_position    s_rest;

/* Fraction of the pixel that a dot of this radius covers whose middle is this far away. */
float dot_cover(float radius, float away)
{
    return clamp(radius + 0.5 - away, 0.0, 1.0) * min(1.0, 4.0 * radius * radius);
}

/* Pixels from the position to the nearest corner of the grid that is shifted by `shift`. */
float to_corner(vec2 cell, vec2 shift, mat2 pixels)
{
    vec2 offset = cell - shift;
    return length(pixels * (offset - floor(offset + 0.5)));
}

float dots_at(stroke_plane s, float darkness, uint set)
{
    float area = max(abs(s.right.x * s.up.y - s.right.y * s.up.x), 1e-30); /* of a pixel */
    float rate = sqrt(area);
    /* Pixels between corners of the grid, that are wanted. */
#if TONE_BY == 0
    float apart = u_diameter * sqrt(0.7854 / max(darkness, 1e-4));
#else
    float apart = u_scale;
#endif
    float octave = log2(1.0 / (apart * rate));
    float low = floor(octave), cells = exp2(low);
    /* Of the three corners between old ones, how many are there yet. */
    float come = exp2(2.0 * (octave - low)) - 1.0;
    vec2 at = s.at;
#ifdef WITH_WOBBLE
    at += u_wobble * 0.7 * (TONE_BY == 0 ? 8.0 : apart) * rate * living_noise(s.at, 1.0 / (rate * 18.0), set, u_change);
#endif
    vec2 cell = at * cells;
    /* From cells to pixels. */
    float sign_of = s.right.x * s.up.y - s.right.y * s.up.x < 0.0 ? -1.0 : 1.0;
    mat2 pixels = mat2(s.up.y, -s.right.y, -s.up.x, s.right.x) * (sign_of / (area * cells));
    float size = 1.0 / (cells * cells * area); /* pixels of a cell */
    /* Area of a dot that is there. Dots that touch cover less than they have, and where all is dark they must cover everything. */
#if TONE_BY == 0
    float area_of_dots = darkness * (1.0 + 0.5708 * pow(darkness, 6.0));
#else
    float area_of_dots = area_that_covers(darkness);
#endif
    float whole = size / (1.0 + come) * area_of_dots;
    vec4 ink = vec4(1.0, clamp(come, 0.0, 1.0), clamp(come - 1.0, 0.0, 1.0), clamp(come - 2.0, 0.0, 1.0)) * whole;
    vec4 radius = sqrt(ink / 3.14159);
    float bare = 1.0 - dot_cover(radius.x, to_corner(cell, vec2(0.0), pixels));
    bare *= 1.0 - dot_cover(radius.y, to_corner(cell, vec2(0.5), pixels));
    bare *= 1.0 - dot_cover(radius.z, to_corner(cell, vec2(0.5, 0.0), pixels));
    bare *= 1.0 - dot_cover(radius.w, to_corner(cell, vec2(0.0, 0.5), pixels));
    return 1.0 - bare;
}

float cover_of(float darkness, int ink)
{
    float bare = 1.0;
    for (int i = 0; i < PLANES; i++) {
        stroke_plane s = plane_of(s_point, s_rest, i, turns_added(u_angle, turn_of_ink(ink)));
        float part = darkness_of_fraction(darkness, s.weight);
#ifdef WITH_UNEVEN
        part *= 1.0 + 4.0 * u_uneven * living_noise(s.at, 1.0 / (sqrt(length(s.right) * length(s.up)) * 40.0 + 1e-30), 9u, u_change).x;
#endif
        int wanted = part > 0.002 ? 1 : 0;
        for (int once = 0; once < wanted; once++)
            bare *= 1.0 - dots_at(s, min(part, 1.0), s.key + 16u);
    }
    return 1.0 - bare;
}

#include "surface/halftone/inks.glsl"

vec4 surface_colour(surface_point p)
{
    s_point = p;
    s_rest = position_at_rest(p);
    return inked(p, tone_of_light(p, light_of(p)));
}
