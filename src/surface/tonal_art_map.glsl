#include "surface/halftone/position.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/screen.glsl"

surface_point s_point;
rest_position    s_rest;

#define MIXES_TONES BLEND
#include "surface/halftone/tones.glsl"

float cover_of(float darkness, int ink)
{
    float bare = 1.0;
    for (int i = 0; i < PLANES; i++) {
        stroke_plane s = plane_of(s_point, s_rest, i, turns_added(u_angle, turn_of_ink(ink)));
#ifdef WITH_REPEAT
        float level = max(screen_level(s, u_tones_facts.x * u_repeat, u_scale), 0.0);
        bare *= 1.0 - map_ink(s.at * u_repeat, level, darkness_of_fraction(min(darkness, u_tones_facts.w), s.weight));
#else
        float level = screen_level(s, u_tones_facts.x, u_scale);
        for (int k = 0; k < 2; k++) {
            screen_octave o = octave_of(s, level, k, -1e9, false);
            bare *= 1.0 - map_ink(s.at * o.scale, o.level, darkness_of_fraction(min(darkness, u_tones_facts.w), s.weight * o.weight));
        }
#endif
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
