/* Pencil strokes on paper. Müller, section 4.4: the map is looked up along quantised directions, gone over several times with a little variation. */
#include "surface/halftone/position.glsl"
#include "surface/halftone/tone.glsl"
#include "surface/halftone/screen.glsl"

uniform vec4 u_numbers[1]; /* x: fraction of the paper's light that the lead takes at most */

surface_point s_point;
rest_position    s_rest;

#define MIXES_TONES SHADING
#include "surface/halftone/tones.glsl"

/* Cosine and sine of some degrees, for angles up to a right one; the rest is far below what a hand does. */
vec2 turn_of_degrees(float degrees)
{
    float angle = degrees * 0.017453293, square = angle * angle;
    float cosine = 1.0 - square * (0.5 - square * (1.0 / 24.0 - square / 720.0)), sine = angle * (1.0 - square * (1.0 / 6.0 - square * (1.0 / 120.0 - square / 5040.0)));
    return vec2(cosine, sine);
}

#include "surface/halftone/map_strokes.glsl"

/* Fraction of the paper that one time over covers. Row P36: each turns and starts elsewhere, so that what is seen of one's seams others cover. */
float cover_of(float darkness, int overlay)
{
    float fraction = OVERLAYS > 1 ? float(overlay) / float(OVERLAYS) : 0.0;
#ifdef HAS_FORM
    s_between = fraction;
#endif
    vec2 turn = turns_added(u_angle, turn_of_degrees(u_vary * (OVERLAYS > 1 ? 2.0 * float(overlay) / float(OVERLAYS - 1) - 1.0 : 0.0)));
    float bare = 1.0;
    for (int i = 0; i < PLANES; i++) {
        stroke_plane s = plane_of(s_point, s_rest, i, turn);
        int there = s.weight > 0.01 ? 1 : 0;
        for (int once = 0; once < there; once++)
            bare *= 1.0 - strokes_at(s, darkness_of_fraction(min(darkness, u_tones_facts.w), s.weight), vec2(0.37, 0.61) * float(overlay + OVERLAYS * int(s.key & 15u)));
    }
    return 1.0 - bare;
}

#define INKS 0
#include "surface/halftone/inks.glsl"

/* Parts' own colours stand for light on dark paper; on light paper also those that are lighter than it stand for shade. */
float darkness_in(vec3 ink, float tone)
{
    float paper = dot(mix(vec3(1.0), u_paper.rgb, u_paper.a), LUMINANCE);
    bool light = paper < 0.48 && dot(ink, LUMINANCE) > paper;
    return u_ink_tint < 0.5 ? darkness_of(tone) : light ? tone : 1.0 - tone;
}

vec4 surface_colour(surface_point p)
{
    s_point = p;
    s_rest = position_at_rest(p);
    float tone = tone_of_light(p, light_of(p));
#ifdef WITH_GLOSS
    tone += u_gloss * highlight(p, 24.0);
#endif
#ifdef ON_GROUND
    vec3 own = u_ink.rgb; /* the ground has no colour of its own */
#else
    vec3 own = mix(u_ink.rgb, shown(p.albedo.rgb), u_ink_tint);
#endif
    float darkness = focused(p, clamp(darkness_in(own, tone), 0.0, 1.0));
    /* The map ends before paper is covered whole: darkness is counted to there, so that the last tones do not fall together. */
    darkness *= 1.0 - pow(1.0 - u_tones_facts.w, float(OVERLAYS));
    /* Every time over has its part, so that together they are as dark as wanted. */
    float part = darkness_of_fraction(darkness, 1.0 / float(OVERLAYS));
    vec4 paper = paper_of(p);
    vec3 left = vec3(1.0);
    float bare = 1.0;
    for (int i = 0; i < OVERLAYS; i++) {
        float cover = cover_of(part, i);
        vec4 pencil = u_pencils[i % max(u_pencils_count, 1)];
        left *= 1.0 - cover * pencil.a * (1.0 - pencil.rgb);
        bare *= 1.0 - cover;
    }
    /* Row P32: graphite and wax cover what is not covered yet, up to what the lead can do; on dark paper, too. */
    if (u_pencils_count < 2)
        return laid_over(paper, vec4(own, 1.0), (1.0 - bare) * u_numbers[0].x * u_ink.a);
    /* Row P34: coloured pencils each take their colours away. Where there is no paper, ink gets as thin as it can be and be the same on white. */
    vec3 rest = 1.0 - (1.0 - left) * u_numbers[0].x;
    float clear = min(rest.r, min(rest.g, rest.b));
    return vec4(paper.rgb * rest, paper.a) + (1.0 - paper.a) * vec4(rest - clear, 1.0 - clear);
}
