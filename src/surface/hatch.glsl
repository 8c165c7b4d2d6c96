/* Lines at every half, quarter, eighth … of a coordinate, as many of them as the picture has room for. */
#include "surface/halftone/place.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/noise.glsl"

surface_point s_point;
rest_place    s_rest;

/* What a line keeps at any zoom: where it is as a fraction without common factors, and the octave that brings it. */
uint line_key(float index, float octave, uint set)
{
    int at = int(index), low = at & -at;
    int birth = int(octave);
    if (low != 0) {
        birth -= int(log2(float(abs(low))) + 0.5);
        at /= low;
    } else {
        birth = 0;
    }
    return hash_of(uvec3(uint(at), uint(birth), set), 0x51ed27u);
}

/* Share of a stroke's width that is left at this place along its line: strokes end in tips, and are cut in two when they get too long. `along`: pixels a
 * unit; `grown`: share of its length that a stroke has yet. */
float stroke_share(float at, float along, uint key, float grown)
{
    float scale = 0.7 + 0.6 * number_of(key ^ 0x5bd1e995u);
    float pixels = along / scale;
    /* Cut in two at places that are even over the octave, strokes are shorter than this by 1.75 in the mean. */
    float octave = log2(pixels / (1.75 * u_length)) + number_of(key * 2654435761u);
    float low = floor(octave), share = octave - low, cells = exp2(low);
    /* A shift that halves of strokes inherit: its binary digits repeat after 32 octaves. */
    int turns = int(low) & 31;
    uint digits = key << turns | key >> (32 - turns & 31);
    float inside = fract(at * scale * cells + number_of(digits)), size = pixels / cells;
    float to_old = min(inside, 1.0 - inside) * size, to_new = abs(inside - 0.5) * size;
    float to_end = min(to_old - 0.5 * u_gap, mix(size, to_new - 0.5 * u_gap, smoothstep(0.0, 0.5, share)));
    to_end -= (1.0 - grown) * size * mix(0.5, 0.25, share);
    return clamp(to_end / max(u_taper, 0.75), 0.0, 1.0);
}

/* Share of the ink that gaps and tips leave. */
float stroke_ink()
{
    return u_length > 0.0 ? max(1.0 - (u_gap + u_taper) / u_length, 0.25) : 1.0;
}

/* Share of the pixel that a line of this width covers whose middle is this far away. */
float covered(float width, float away)
{
    return clamp(0.5 * width + 0.5 - away, 0.0, min(width, 1.0));
}

/* The share of the pixel that a line covers. `grown`: share of their length that its strokes have yet. */
float line_cover(float width, float grown, float away, uint key, float at, float along)
{
    width *= 1.0 + u_loose * (number_of(key) - 0.5);
    if (u_length > 0.0)
        width *= stroke_share(at, along, key, grown) / max(grown, 1e-3); /* strokes that come grow both ways, in length and in width */
    return covered(width, away);
}

/* The lines of one set around a place, of this darkness. */
float lines_at(stroke_plane s, float darkness, uint set)
{
    vec2 rate = vec2(s.right.y, s.up.y);
    float g = max(length(rate), 1e-20);
    /* Pixels along the line for a unit of x. */
    float along = g / max(abs(s.right.x * s.up.y - s.up.x * s.right.y), 1e-20);
    float basis = log2(1.0 / (u_scale * g));
    vec2 noise = u_wobble + u_uneven > 0.0 ? living_noise(s.at * vec2(0.07, 0.13), basis, set, u_change) : vec2(0.0);
    darkness = min(darkness * (1.0 + u_uneven * noise.y) / stroke_ink(), 1.0);
#if TONE_BY == 0
    float octave = log2(darkness / (u_width * g));
#else
    float octave = basis + 0.5;
#endif
    float low = floor(octave), share = octave - low;
    float cells = exp2(low), period = 1.0 / (cells * g); /* pixels between old lines */
    float cell = (s.at.y + noise.x * u_wobble * u_scale * g) * cells;
#if TONE_BY == 0
    float old_part = exp2(-share);
#else
    float old_part = 1.0 / (1.0 + share);
#endif
    float old_width = darkness * period * old_part, new_width = darkness * period * (1.0 - old_part);
    float grown = sqrt(new_width / max(old_width, 1e-6)), apart = 0.5 * period;
    float nearest = floor(cell * 2.0 + 0.5), side = cell * 2.0 < nearest ? -1.0 : 1.0;
    bool  coming = fract(nearest * 0.5) > 0.25;
    float cover = line_cover(coming ? new_width : old_width, coming ? grown : 1.0, abs(cell * 2.0 - nearest) * apart, line_key(nearest, low + 1.0, set), s.at.x, along);
    /* Where lines come close, those beyond the nearest one as well, as far as they reach into the pixel. */
    float reach = max(old_width, new_width) * (1.0 + 0.5 * u_loose) + 1.0;
    int   count = reach <= apart ? 1 : reach <= 2.0 * apart ? 2 : 4;
    for (int i = 1; i < count; i++) {
        float index = nearest + side * (i == 1 ? 1.0 : i == 2 ? -1.0 : 2.0);
        coming = fract(index * 0.5) > 0.25;
        cover += line_cover(coming ? new_width : old_width, coming ? grown : 1.0, abs(cell * 2.0 - index) * apart, line_key(index, low + 1.0, set), s.at.x, along);
    }
    /* Lines that are closer than pixels are an even tone. */
    return mix(darkness * stroke_ink(), min(cover, 1.0), clamp(2.0 * period - 1.0, 0.0, 1.0));
}

/* Sets of lines share what is dark: each as far as its own lines may come together, and beyond that all alike. */
float set_darkness(float darkness, int set)
{
#if TONE_BY == 0
    float most = min(u_width / u_scale, 0.9);
#else
    float most = SERIES > 1 ? 0.5 : 1.0;
#endif
    float left = 1.0 - darkness;
    if (left <= pow(1.0 - most, float(SERIES)))
        return 1.0 - pow(max(left, 0.0), 1.0 / float(SERIES));
    float before = set > 0 ? pow(1.0 - most, float(set)) : 1.0; /* 0 to the power of 0 is anything */
    return clamp(1.0 - left / before, 0.0, most);
}

const float LIGHTEST = 0.002; /* below, no line is drawn */

float plane_cover(stroke_plane s, int set, float part)
{
    return lines_at(s, part, s.key + 16u * uint(set));
}

/* What a set of lines leaves bare. The first plane goes without a loop and the others in one that mostly runs not at all: on software drivers loops cost more than
 * what is in them, and sets are written out where they are called, with constants. */
float bare_of_set(float darkness, int set, vec2 turn)
{
    float whole = set_darkness(darkness, set);
    stroke_plane s = plane_of(s_point, s_rest, 0, turn);
    float part = darkness_of_share(whole, s.weight);
    float bare = 1.0 - plane_cover(s, set, max(part, LIGHTEST)) * step(LIGHTEST, part);
    int planes = whole > LIGHTEST ? planes_at(s_rest, turn) : 1;
    for (int i = 1; i < planes; i++) {
        s = plane_of(s_point, s_rest, i, turn);
        part = darkness_of_share(whole, s.weight);
        int wanted = part > LIGHTEST ? 1 : 0;
        for (int once = 0; once < wanted; once++)
            bare *= 1.0 - plane_cover(s, set, part);
    }
    return bare;
}

float cover_of(float darkness, int ink)
{
    vec2 turn = turns_added(u_angle, turn_of_ink(ink));
    float bare = bare_of_set(darkness, 0, turn);
#if SERIES > 1
    turn = turns_added(turn, u_turn);
    bare *= bare_of_set(darkness, 1, turn);
#endif
#if SERIES > 2
    turn = turns_added(turn, u_turn);
    bare *= bare_of_set(darkness, 2, turn);
#endif
#if SERIES > 3
    turn = turns_added(turn, u_turn);
    bare *= bare_of_set(darkness, 3, turn);
#endif
    return 1.0 - bare;
}

#include "surface/halftone/inks.glsl"

vec4 surface_colour(surface_point p)
{
    s_point = p;
    s_rest = place_at_rest(p);
    float tone = tone_of_light(p, light_of(p));
    return inked(p, tone);
}
