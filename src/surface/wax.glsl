#include "light/light.glsl"

/* Fraction of a light that leaves a position, by colour: none is left where the light is further behind than `reach`. What falls on the place itself can be in
 * shadow; what comes from beside is not. */
vec3 wrapped(float turned, float fraction, vec3 reach)
{
    float direct = max(turned, 0.0);
    return max((turned + reach) / (1.0 + reach), 0.0) - direct * (1.0 - fraction);
}

vec4 surface_colour(surface_point p)
{
    vec3 own = mix(u_colour.rgb, p.albedo.rgb, u_model_colour);
    vec3 glow = u_glow.rgb / max(max(u_glow.r, max(u_glow.g, u_glow.b)), 0.001);
    vec3 reach = u_depth * sqrt(glow);

    vec3 light = vec3(0.0);
    float first = unshadowed(p);
    for (int i = 0; i < LIGHT_COUNT; i++)
        light += u_light_colour[i].rgb * wrapped(dot(p.normal, towards_light(i, p.eye)), i == 0 ? first : 1.0, reach);
    /* Light that has lost its way inside comes from everywhere. */
    light = mix(min(light * sky_fraction(p), vec3(1.0)), vec3(1.0), 0.4 * u_depth * glow);

    /* The way through a ball is as long as the cosine says. */
    float facing = max(dot(p.normal, towards_viewer(p.eye)), 0.0);
    float thin = u_depth > 0.0 ? u_warmth * exp(-2.0 * facing / u_depth) : 0.0;
    vec3 colour = own * light;
    colour = mix(colour, u_glow.rgb * (0.6 + 0.6 * light), thin);

    float lit = smoothstep(0.0, 0.4, dot(p.normal, towards_light(0, p.eye)));
    colour += u_shine * lit * highlight(p, 9.0);
    return vec4(shown(min(colour, vec3(1.0))), 1.0);
}
