/* Ink on paper. A technique has `float cover_of(float darkness, int ink)`: the fraction of the pixel that strokes of this darkness 0 … 1 cover, with an angle of
 * its own for each ink. */
#include "surface/halftone/tone.glsl"
#include "surface/halftone/paper_of.glsl"

vec4 laid_over(vec4 paper, vec4 ink, float cover)
{
    return mix(paper, ink, cover);
}

vec4 inked(surface_point p, float tone)
{
    vec4 paper = paper_of(p);
#if INKS == 2
    /* What each ink must take away from white; black takes what the others have in common. */
    float light = tone / max(mix(1.0, seen_brightness(p.albedo.rgb), u_texture), 0.01);
    vec3 wanted = clamp(mix(vec3(1.0), shown(p.albedo.rgb), u_texture) * max(light, 0.0), 0.0, 1.0);
    vec3 taken = 1.0 - wanted;
    float black = min(taken.r, min(taken.g, taken.b));
    vec3 rest = black < 1.0 ? (taken - black) / (1.0 - black) : vec3(0.0);
    const vec3 inks[3] = vec3[3](vec3(0.0, 0.68, 0.92), vec3(0.91, 0.0, 0.58), vec3(1.0, 0.93, 0.0));
    vec4 colour = paper;
    for (int i = 0; i < 3; i++)
        colour.rgb *= mix(vec3(1.0), inks[i], cover_of(focused(p, rest[i]), i));
    return laid_over(colour, vec4(u_ink.rgb, 1.0) * u_ink.a, cover_of(focused(p, black), 3));
#else
    vec4 ink = vec4(mix(u_ink.rgb, shown(p.albedo.rgb), u_ink_tint), 1.0) * u_ink.a;
    float darkness = focused(p, clamp(darkness_of(tone), 0.0, 1.0));
#if INKS == 1
    vec4 second = vec4(u_second_ink.rgb, 1.0) * u_second_ink.a;
    paper = laid_over(paper, second, cover_of(min(2.0 * darkness, 1.0), 1));
    darkness = max(2.0 * darkness - 1.0, 0.0);
#endif
    return laid_over(paper, ink, cover_of(darkness, 0));
#endif
}
