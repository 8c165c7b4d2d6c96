#include "light/light.glsl"

/* Pixels between contour lines: below the first there is none, from the second on all are there. */
const float CROWDED = 3.0, APART = 6.0;
const float BOLDER = 1.8; /* each fifth line */
const float FEWEST = 10.0; /* contour lines that are chosen by themselves */

/* How fast height changes from pixel to pixel: of what is drawn now, as it does; later, on the plane of its normal. */
vec2 height_slope(surface_point p, float height)
{
#ifndef SHADED_LATER
    return vec2(dFdx(height), dFdy(height));
#else
    vec3 up = u_height.xyz, ray = u_perspective > 0.5 ? p.eye / -p.eye.z : vec3(0.0, 0.0, -1.0);
    float facing = dot(p.normal, ray), away = u_perspective > 0.5 ? -p.eye.z : 1.0;
    facing = facing < 0.0 ? min(facing, -1e-4) : max(facing, 1e-4);
    vec2 pixel = 2.0 * u_unproject * u_texel * away;
    return pixel * (up.xy - dot(up, ray) * p.normal.xy / facing);
#endif
}

/* The round number of which FEWEST or a few more fit: 1, 2 or 5 times a power of ten. */
float round_interval()
{
    float wanted = u_height_range.y / FEWEST, power = pow(10.0, floor(log2(wanted) * 0.30103 + 1e-4)), share = wanted / power;
    return power * (share >= 5.0 ? 5.0 : share >= 2.0 ? 2.0 : 1.0);
}

/* How much of a pixel the nearest line at multiples of an interval covers. */
float contours_at(float height, float slope, float interval, float half_width, float noise)
{
    float off = abs(fract(height / interval + 0.5) - 0.5) * interval, apart = interval / max(slope, 1e-9);
    /* Level ground at a line's own height is not all line. */
    float there = slope > 2.0 * noise ? 1.0 : 0.0;
    return there * clamp((apart - CROWDED) / (APART - CROWDED), 0.0, 1.0) * clamp(half_width + 0.5 - off / max(slope, 1e-9), 0.0, min(2.0 * half_width, 1.0));
}

vec3 tint_at(float share)
{
    float at = clamp(share, 0.0, 1.0) * float(u_palette_count - 1);
    int first = clamp(int(at), 0, max(u_palette_count - 2, 0));
    return mix(u_palette[first].rgb, u_palette[min(first + 1, u_palette_count - 1)].rgb, at - float(first));
}

vec4 surface_colour(surface_point p)
{
    float above = dot(u_height, vec4(p.eye, 1.0));
    vec3 colour = mix(shown(p.albedo.rgb), tint_at(above / u_height_range.y), u_tint);
    /* Level ground keeps its tint. */
    float level = max(dot(u_height.xyz, u_first_light), 0.05), lit = max(dot(p.normal, u_first_light), 0.0) * unshadowed(p);
    float change = p.unlit ? 0.0 : clamp(lit / level - 1.0, -1.0, 1.0);
    colour = change < 0.0 ? colour * (1.0 + 0.75 * u_shade * change) : mix(colour, vec3(1.0), 0.5 * u_shade * change);
    float height = u_height_range.x + above, slope = length(height_slope(p, above)), interval = u_interval > 0.0 ? u_interval : round_interval();
    /* What rounding leaves of level ground that is far away. */
    float noise = 1e-3 + 1e-6 * length(p.eye);
    bool sea = abs(height) < noise && slope < 2.0 * noise;
    colour = sea ? mix(colour, u_sea.rgb, u_sea.a) : colour;
    float fine = contours_at(height, slope, interval, 0.5 * u_contour, noise), bold = contours_at(height, slope, 5.0 * interval, 0.5 * BOLDER * u_contour, noise);
    return vec4(mix(colour, u_contour_colour.rgb, max(fine, bold) * u_contour_colour.a), 1.0);
}
