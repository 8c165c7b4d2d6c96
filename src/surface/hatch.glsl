/* Lines at every half, quarter, eighth … of a coordinate, as many of them as the picture has room for. */
#include "surface/halftone/position.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/noise.glsl"
#include "surface/stroke_cut.glsl"

surface_point s_point;
rest_position    s_rest;

/* What a line keeps at any zoom: where it is as a fraction without common factors, and the octave that brings it. */
uint line_key(float index, float octave, uint set)
{
    int at = int(index);
    float low = abs(float(at & -at)); /* the largest power of two in it, which divides it in floats as exactly as in whole numbers and much faster */
    int birth = low > 0.0 ? int(octave) - (floatBitsToInt(low) >> 23) + 127 : 0;
    return hash_of(uvec3(uint(int(index / max(low, 1.0))), uint(birth), set), 0x51ed27u);
}

/* Fraction of the ink that gaps and tips leave. */
float stroke_ink()
{
#ifdef WITH_LENGTH
    return max(1.0 - (u_gap + u_taper) / u_length, 0.25);
#else
    return 1.0;
#endif
}

/* Fraction of the pixel that a line of this width covers whose middle is this far away. */
float covered(float width, float away)
{
    return clamp(0.5 * width + 0.5 - away, 0.0, min(width, 1.0));
}

/* The fraction of the pixel that a line covers. `grown`: fraction of their length that its strokes have yet. */
float line_cover(float width, float grown, float away, uint key, float at, float along)
{
#ifdef WITH_LOOSE
    width *= 1.0 + u_loose * (number_of(key) - 0.5);
#endif
#ifdef WITH_LENGTH
    width *= stroke_fraction(at, along, key, grown) / max(grown, 1e-3); /* strokes that come grow both ways, in length and in width */
#endif
    return covered(width, away);
}

/* By number, lines come no closer than this: what is darker still has wider ones. */
const float CLOSEST_MM = 0.79375; /* 1/32 in */

/* The lines of one set around a position, of this darkness. */
float lines_at(stroke_plane s, float darkness, uint set)
{
    vec2 rate = vec2(s.right.y, s.up.y);
    float g = max(length(rate), 1e-20);
    /* Pixels along the line for a unit of x. */
    float along = g / max(abs(s.right.x * s.up.y - s.up.x * s.right.y), 1e-20);
    float apart_units = u_scale * g;
#if defined(WITH_WOBBLE) || defined(WITH_UNEVEN)
    vec2 noise = living_noise(s.at * vec2(0.07, 0.13), 1.0 / apart_units, set, u_change);
#else
    const vec2 noise = vec2(0.0);
#endif
    darkness = min(darkness * (1.0 + u_uneven * noise.y) / stroke_ink(), 1.0);
    /* Lines to a unit, and those of them that are there however many are wanted. */
#if TONE_BY == 0
    float wanted = min(darkness, u_width / (CLOSEST_MM * u_pixels_per_mm)) / (u_width * g);
#else
    float wanted = 1.4142136 / apart_units;
#endif
    wanted = max(wanted, 1e-30);
    float cells = power_below(wanted), more = wanted / cells; /* 1 … 2 */
    float period = 1.0 / (cells * g); /* pixels between old lines */
    float cell = (s.at.y + noise.x * u_wobble * apart_units) * cells;
#if TONE_BY == 0
    float old_part = 1.0 / more;
#else
    float old_part = 1.0 / (1.0 + log_of_rest(more - 1.0));
#endif
    float old_width = darkness * period * old_part, new_width = darkness * period * (1.0 - old_part);
    float grown = sqrt(new_width / max(old_width, 1e-6)), apart = 0.5 * period;
    float nearest = floor(cell * 2.0 + 0.5), side = cell * 2.0 < nearest ? -1.0 : 1.0;
    bool  coming = fract(nearest * 0.5) > 0.25;
    float octave = float((floatBitsToInt(cells) >> 23) - 126); /* of new lines */
    float cover = line_cover(coming ? new_width : old_width, coming ? grown : 1.0, abs(cell * 2.0 - nearest) * apart, line_key(nearest, octave, set), s.at.x, along);
    /* The next one reaches into the pixel only where lines are wide. By number it is taken without gaps: where lines touch, gaps of one are filled by the other. */
    float next = nearest + side, width = coming ? old_width : new_width;
#if TONE_BY == 0
    cover += covered(width, abs(cell * 2.0 - next) * apart);
#else
    cover += line_cover(width, coming ? 1.0 : grown, abs(cell * 2.0 - next) * apart, line_key(next, octave, set), s.at.x, along);
#endif
    /* And the one on the other side where that in the middle is hardly there yet. */
    cover += covered(width, abs(cell * 2.0 - nearest + side) * apart);
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
    /* Powers by products: SERIES and sets are known when this is compiled. */
    float left = max(1.0 - darkness, 0.0), rest = 1.0 - most;
    float before = set == 0 ? 1.0 : set == 1 ? rest : set == 2 ? rest * rest : rest * rest * rest;
    float whole = SERIES == 1 ? rest : SERIES == 2 ? rest * rest : SERIES == 3 ? rest * rest * rest : rest * rest * rest * rest;
    float alike = SERIES == 1 ? left : SERIES == 2 ? sqrt(left) : SERIES == 3 ? pow(left, 1.0 / 3.0) : sqrt(sqrt(left));
    return left <= whole ? 1.0 - alike : clamp(1.0 - left / before, 0.0, most);
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
    float part = darkness_of_fraction(whole, s.weight);
    float bare = 1.0 - plane_cover(s, set, max(part, LIGHTEST)) * step(LIGHTEST, part);
    int planes = whole > LIGHTEST ? planes_at(s_rest, turn) : 1;
    for (int i = 1; i < planes; i++) {
        s = plane_of(s_point, s_rest, i, turn);
        part = darkness_of_fraction(whole, s.weight);
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
    s_rest = position_at_rest(p);
    float tone = tone_of_light(p, light_of(p));
    return inked(p, tone);
}
