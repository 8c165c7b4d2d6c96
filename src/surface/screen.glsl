#include "surface/halftone/position.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/noise.glsl"
#include "surface/halftone/screen.glsl"

surface_point s_point;
rest_position    s_rest;

float texel_of()
{
    return u_scale / u_screen_facts.w;
}

stroke_plane screen_plane(int i, int ink)
{
    stroke_plane s = plane_of(s_point, s_rest, i, turns_added(u_angle, turn_of_ink(ink)));
#if COORDINATES == 3 && defined(HAS_UV)
    s.at *= u_repeat;
    s.right *= u_repeat;
    s.up *= u_repeat;
#endif
    return s;
}

/* Texture coordinates are laid by people: the screen repeats in them, but is never enlarged. */
float least_octave()
{
#if COORDINATES == 3 && defined(HAS_UV)
    return 0.0;
#else
    return -1e9;
#endif
}

/* Where the plane is looked up: strokes waver (IM-30). */
vec2 wavered(stroke_plane s)
{
#ifndef WITH_WOBBLE
    return s.at;
#else
    float rate = sqrt(max(length(s.right) * length(s.up), 1e-30));
    return s.at + u_wobble * rate * living_noise(s.at, 1.0 / (rate * 60.0 * page_unit()), 3u, u_change);
#endif
}

#ifdef SIMILAR_SCREEN
#define SIZES 1
#else
#define SIZES 2
#endif

/* The screen's value on a level: frames follow each other, each fading into the next. */
float level_value(vec2 at, float level)
{
    float frame = u_time * u_change;
    float first = mod(floor(frame), u_screen_facts.y);
    float value = textureLod(t_screen, vec3(at, first), level).r;
#ifdef WITH_CHANGE
    value = mix(value, textureLod(t_screen, vec3(at, mod(first + 1.0, u_screen_facts.y)), level).r, fract(frame));
#endif
    return value;
}

/* Fraction of ink by the scheme; a value is inked where it is less than the darkness, but 255 is paper whatever the darkness. */
float ink_of(float value, float darkness)
{
#if SCHEME == 0
    return value <= darkness && darkness > 0.0 && value < 0.999 ? 1.0 : 0.0;
#elif SCHEME == 1
    /* Where a plane or a size of the screen has no share there is none of its ink. */
    return clamp((u_centred ? 0.5 : 0.0) + u_gain * (darkness - value), 0.0, 1.0) * smoothstep(0.0, 0.02, darkness);
#elif SCHEME == 2 && defined(NEAREST_SCREEN)
    return value < darkness ? 1.0 : 0.0; /* texels are dots: they are there or not */
#elif SCHEME == 2
    float ramp = clamp(length(vec2(dFdx(value - darkness), dFdy(value - darkness))), 1.0 / 128.0, 0.75);
    return clamp(0.5 + (darkness - value) / ramp, 0.0, 1.0) * smoothstep(0.0, 0.02, darkness) * clamp(255.0 * (1.0 - value), 0.0, 1.0);
#else
    return 1.0 - value;
#endif
}

/* On the page a screen has one size, and each ink's rows of dots their own angle to the pixels. */
#if COORDINATES == 2 && defined(SIMILAR_SCREEN) && !defined(NEAREST_SCREEN) && SCHEME == 2
#include "lines/stroke/coverage.glsl"
#define ONE_SIZE

/* Fraction of a pixel that is inked, by the screen's values at its corners: how far the contour is from its middle, and how it lies. `right`, `up`: from pixel to pixel. */
float ink_of_pixel(vec2 at, vec2 right, vec2 up, float darkness)
{
    float a = level_value(at - 0.5 * (right + up), 0.0), b = level_value(at + 0.5 * (right - up), 0.0);
    float c = level_value(at - 0.5 * (right - up), 0.0), d = level_value(at + 0.5 * (right + up), 0.0);
    vec2 slope = 0.5 * vec2(b - a + d - c, c - a + d - b);
    float steep = max(length(slope), 1.0 / 128.0), value = 0.25 * (a + b + c + d);
    return half_plane_fraction((darkness - value) / steep, slope / steep) * smoothstep(0.0, 0.02, darkness) * clamp(255.0 * (1.0 - value), 0.0, 1.0);
}
#endif

/* Ink at a position between two levels, whose values mix as a texture unit mixes them. Values that were mixed are no longer even: the curve says which one as many are
 * below as shall be inked. */
float ink_between(vec2 at, float level, float darkness)
{
#ifdef NEAREST_SCREEN
    return ink_of(level_value(at, floor(level + 0.5)), darkness);
#else
    float low = floor(level), fraction = level - low;
#ifdef HAS_CURVE
    darkness = textureLod(t_curve, vec3((darkness * 63.0 + 0.5) / 64.0, (fraction * 16.0 + 0.5) / 17.0, 0.0), 0.0).r;
#endif
    return ink_of(mix(level_value(at, low), level_value(at, low + 1.0), fraction), darkness);
#endif
}

#if defined(HAS_WARP) && defined(HAS_UV) && defined(HAS_LIGHT_MAP)
uniform sampler2D t_light_map;

/* How much darker it is at the middle of the stroke that owns a position of the screen than at this position. Freudenberg 2003, section 6.6; rows IM-18 to IM-20: the way to the
 * middle is relative, so that the screen may repeat, and is taken from the screen's coordinates to those of the light map. */
float darker_at_middle(stroke_plane s, screen_octave o, vec2 at, float own)
{
    vec2 offset = textureLod(t_warp, vec3(at * o.scale, 0.0), floor(o.level + 0.5)).rg / o.scale;
    vec2 right = dFdx(s_uv_unique), up = dFdy(s_uv_unique);
    float area = s.right.x * s.up.y - s.right.y * s.up.x;
    vec2 pixels = vec2(offset.x * s.up.y - offset.y * s.up.x, offset.y * s.right.x - offset.x * s.right.y) / (abs(area) > 1e-20 ? area : 1e-20);
    vec4 light = texture(t_light_map, s_uv_unique + right * pixels.x + up * pixels.y);
    return light.a > 0.5 ? darkness_of(tone_of_light(s_point, light.r)) - own : 0.0;
}
#endif

float s_darkness; /* of the place itself */

float cover_of(float darkness, int ink)
{
    float bare = 1.0;
    for (int i = 0; i < PLANES; i++) {
        stroke_plane s = screen_plane(i, ink);
        vec2 at = wavered(s);
        float level = screen_level(s, u_screen_facts.x, texel_of());
#ifdef ONE_SIZE
        float scale = exp2(-level), wanted = darkness;
#ifdef HAS_CURVE
        wanted = textureLod(t_curve, vec3((darkness * 63.0 + 0.5) / 64.0, (float(ink) + 0.5) / 17.0, 0.0), 0.0).r;
#endif
        bare *= 1.0 - ink_of_pixel(at * scale, s.right * scale, s.up * scale, wanted);
#else
        for (int k = 0; k < SIZES; k++) {
            screen_octave o = octave_of(s, level, k, least_octave(), SIZES == 1);
            float fraction = s.weight * o.weight, wanted = darkness;
#if SCHEME == 3
            bare -= fraction * ink_between(at * o.scale, o.level, 1.0);
#else
#if defined(HAS_WARP) && defined(HAS_UV) && defined(HAS_LIGHT_MAP)
            wanted = clamp(wanted + darker_at_middle(s, o, at, s_darkness), 0.0, 1.0);
#endif
            bare *= 1.0 - ink_between(at * o.scale, o.level, darkness_of_fraction(wanted, fraction));
#endif
        }
#endif
    }
    return 1.0 - bare;
}

#include "surface/halftone/inks.glsl"

/* The plane that a position has most of: others may stand edge on. */
stroke_plane main_plane()
{
    stroke_plane most = screen_plane(0, 0);
    for (int i = 1; i < PLANES; i++) {
        stroke_plane s = screen_plane(i, 0);
        if (s.weight > most.weight)
            most = s;
    }
    return most;
}

/* Unevenness of the tone makes strokes swell and thin (IM-26, IM-29). */
float uneven_tone()
{
#ifndef WITH_UNEVEN
    return 0.0;
#else
    stroke_plane s = main_plane();
    float rate = sqrt(max(length(s.right) * length(s.up), 1e-30));
    return u_uneven * living_noise(s.at, 1.0 / (rate * 40.0 * page_unit()), 5u, u_change).x;
#endif
}

#ifdef HAS_RELIEF
/* The normal of the stroke here: those of the relief lean along the plane's axes. */
vec3 relieved_normal()
{
    stroke_plane s = main_plane();
    float level = screen_level(s, u_screen_facts.x, texel_of());
    screen_octave o = octave_of(s, level, 0, least_octave(), SIZES == 1);
    vec2 lean = textureLod(t_relief, vec3(wavered(s) * o.scale, 0.0), o.level).rg * 2.0 - 256.0 / 255.0;
    float area = s.right.x * s.up.y - s.right.y * s.up.x;
    area = abs(area) > 1e-20 ? area : 1e-20;
    vec2 pixel = 2.0 * u_unproject / u_size;
    vec3 right = rate_of(s_point.eye, s_point.normal, vec3(pixel.x, 0.0, 0.0)), up = rate_of(s_point.eye, s_point.normal, vec3(0.0, pixel.y, 0.0));
    vec3 along = (right * s.up.y - up * s.right.y) / area, across = (up * s.right.x - right * s.up.x) / area;
    float rest = sqrt(max(1.0 - dot(lean, lean), 0.0));
    return normalize(normalize(along) * lean.x + normalize(across) * lean.y + s_point.normal * rest);
}
#endif

vec4 surface_colour(surface_point p)
{
    s_point = p;
    s_rest = position_at_rest(p);
#ifdef HAS_RELIEF
    p.normal = relieved_normal();
#endif
    float tone = tone_of_light(p, light_of(p));
#if defined(HAS_INDICATION) && defined(HAS_UV)
    float wanted = texture(t_indication, vec3(s_uv_unique, 0.0)).r;
#if INDICATE == 0
    tone += u_indication_strength * (wanted - 128.0 / 255.0);
#else
    tone = min(tone, mix(1.0, wanted, clamp(u_indication_strength, 0.0, 1.0)));
#endif
#endif
    tone += uneven_tone();
    s_darkness = clamp(darkness_of(tone), 0.0, 1.0);
    return inked(p, tone);
}
