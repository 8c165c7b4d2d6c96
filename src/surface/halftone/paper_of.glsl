/* Paper under ink: one colour, in part the model's own, lit or flat. */
#include "light/light.glsl"

#ifdef WITH_PAPER_STROKES
#include "surface/broad_pen.glsl"
#endif

vec4 paper_of(surface_point p)
{
    vec4 paper = vec4(u_paper.rgb * u_paper.a, u_paper.a);
#ifdef WITH_PAPER_TINT
    vec3 own = p.albedo.rgb;
    if (!p.unlit && u_paper_light > 0.0)
        own *= mix(vec3(1.0), min(0.25 + 0.75 * diffuse_light(p), vec3(1.0)), u_paper_light);
#ifdef WITH_PAPER_STROKES
    /* What is light and grey is paper in the light: a coloured pen has nothing to lay there. */
    vec3 seen = shown(p.albedo.rgb);
    float most = max(seen.r, max(seen.g, seen.b)), plain = (1.0 - smoothstep(0.03, 0.12, most - min(seen.r, min(seen.g, seen.b)))) * smoothstep(0.4, 0.6, most);
    float laid = u_paper_tint * broad_strokes(1.0 - min(dot(diffuse_light(p), vec3(0.2126, 0.7152, 0.0722)), 1.0) - UNTINTED * plain);
#else
    float laid = u_paper_tint;
#endif
    paper = mix(paper, vec4(shown(own), 1.0), laid);
#endif
    return paper;
}
