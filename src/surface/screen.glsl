#include "surface/halftone/place.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/noise.glsl"
#include "surface/halftone/screen.glsl"

surface_point s_point;
rest_place    s_rest;

float texel_of()
{
    return u_scale / u_screen_facts.w;
}

stroke_plane screen_plane(int i, int ink)
{
    stroke_plane s = turned_plane(plane_of(s_point, s_rest, i, 0), radians(u_angle + 30.0 * float(ink)));
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
    if (u_wobble <= 0.0)
        return s.at;
    float rate = sqrt(max(length(s.right) * length(s.up), 1e-30));
    float octave = log2(1.0 / (rate * 60.0));
    return s.at + u_wobble * rate * vec2(living_noise(s.at, octave, 3u, u_change), living_noise(s.at, octave, 4u, u_change));
}

/* The screen's value: frames follow each other, each fading into the next. */
float screen_at(vec2 at, float level)
{
    float frame = u_time * u_change;
    float first = mod(floor(frame), u_screen_facts.y);
    float value = textureLod(t_screen, vec3(at, first), level).r;
    if (u_screen_facts.y > 1.5 && u_change > 0.0)
        value = mix(value, textureLod(t_screen, vec3(at, mod(first + 1.0, u_screen_facts.y)), level).r, fract(frame));
    return value;
}

/* Share of ink by the scheme; a value is inked where it is less than the darkness. */
float ink_of(float value, float darkness)
{
#if SCHEME == 0
    return value <= darkness && darkness > 0.0 ? 1.0 : 0.0;
#elif SCHEME == 1
    return clamp((u_centred ? 0.5 : 0.0) + u_gain * (darkness - value), 0.0, 1.0);
#elif SCHEME == 2
    float ramp = clamp(fwidth(value - darkness), 1.0 / 128.0, 0.75);
    /* Paper is never inked, and all ink is where all is dark. */
    return clamp(0.5 + (darkness - value) / ramp, 0.0, 1.0) * smoothstep(0.0, 0.02, darkness);
#else
    return 1.0 - value;
#endif
}

float cover_of(float darkness, int ink)
{
    float bare = 1.0;
    for (int i = 0; i < PLANES; i++) {
        stroke_plane s = screen_plane(i, ink);
        vec2 at = wavered(s);
        float level = screen_level(s, u_screen_facts.x, texel_of());
        for (int k = 0; k < 2; k++) {
            screen_octave o = octave_of(s, level, k, least_octave());
            float share = s.weight * o.weight;
            float value = screen_at(at * o.scale, o.level);
#if SCHEME == 3
            bare -= share * (1.0 - value);
#else
            bare *= 1.0 - ink_of(value, darkness * share);
#endif
        }
    }
    return 1.0 - bare;
}

#include "surface/halftone/inks.glsl"

vec4 surface_colour(surface_point p)
{
    s_point = p;
    s_rest = place_at_rest(p);
    float tone = tone_of_light(p, light_of(p));
#if defined(HAS_INDICATION) && defined(HAS_UV)
    float wanted = texture(t_indication, vec3(s_uv, 0.0)).r;
#if INDICATE == 0
    tone += u_indication_strength * (wanted - 128.0 / 255.0);
#else
    tone = min(tone, mix(1.0, wanted, clamp(u_indication_strength, 0.0, 1.0)));
#endif
#endif
    return inked(p, tone);
}
