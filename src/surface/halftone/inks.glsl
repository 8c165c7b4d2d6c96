/* Ink on paper. A technique has `float cover_of(float darkness, int ink)`: the fraction of the pixel that strokes of this darkness 0 … 1 cover, with an angle of
 * its own for each ink. */
#include "surface/halftone/tone.glsl"
#include "surface/halftone/paper_of.glsl"

vec4 laid_over(vec4 paper, vec4 ink, float cover)
{
    return mix(paper, ink, cover);
}

#if INKS == 2
const vec3 PRINTED[3] = vec3[3](vec3(0.0, 0.68, 0.92), vec3(0.91, 0.0, 0.58), vec3(1.0, 0.93, 0.0)); /* cyan, magenta, yellow */

/* The fraction of the page that each ink covers, black last, for a colour that is to be seen. Inks let through what they should take away from others, so that
 * each gives way to what the two others take already: with screens at angles of their own, what is left of a channel is the product of what each ink leaves
 * (Neugebauer 1937, Demichel 1924). Black stands for what the three have in common: all of it in greys, whose dots are one screen's, and less in colours, which
 * it would dirty. What no cover gives is as near as the inks come. */
vec4 separated(vec3 wanted)
{
    vec3 taken = 1.0 - wanted;
    float most = max(taken.r, max(taken.g, taken.b)), common_part = min(taken.r, min(taken.g, taken.b));
    float black = common_part * mix(1.0, 0.7 * common_part, smoothstep(0.0, 0.35, (most - common_part) / max(most, 1e-3)));
    vec3 darkest = 1.0 - u_ink.a * (1.0 - u_ink.rgb); /* stands for black: no tone is darker */
    vec3 left = min(mix(darkest, vec3(1.0), wanted) / max(mix(vec3(1.0), darkest, black), 1e-3), 1.0), cover = 1.0 - left;
    for (int i = 0; i < 5; i++) {
        vec3 c = mix(vec3(1.0), PRINTED[0], cover.r), m = mix(vec3(1.0), PRINTED[1], cover.g), y = mix(vec3(1.0), PRINTED[2], cover.b);
        vec3 by_others = max(vec3(m.r * y.r, c.g * y.g, c.b * m.b), 1e-3);
        cover = clamp(1.0 - left / by_others, 0.0, 1.0);
    }
    return vec4(cover, black);
}
#endif

vec4 inked(surface_point p, float tone)
{
    vec4 paper = paper_of(p);
#if INKS == 2
    float light = tone / max(mix(1.0, seen_brightness(p.albedo.rgb), u_texture), 0.01);
    vec3 wanted = clamp(mix(vec3(1.0), shown(p.albedo.rgb), u_texture) * max(light, 0.0), 0.0, 1.0);
    vec4 colour = paper, cover = separated(wanted);
    for (int i = 0; i < 3; i++)
        colour.rgb *= mix(vec3(1.0), PRINTED[i], cover_of(focused(p, cover[i]), (i + 1) % 3));
    return laid_over(colour, vec4(u_ink.rgb, 1.0) * u_ink.a, cover_of(focused(p, cover.a), 3));
#else
    vec4 ink = vec4(mix(u_ink.rgb, shown(p.albedo.rgb), u_ink_tint), 1.0) * u_ink.a;
    float darkness = focused(p, clamp(darkness_of(tone), 0.0, 1.0));
#if INKS == 1
    vec4 second = vec4(u_second_ink.rgb, 1.0) * u_second_ink.a;
    paper = laid_over(paper, second, cover_of(min(2.0 * darkness, 1.0), 3));
    darkness = max(2.0 * darkness - 1.0, 0.0);
#endif
    return laid_over(paper, ink, cover_of(darkness, 0));
#endif
}
