#include "light/light.glsl"
#include "surface/halftone/noise.glsl"
#ifdef SHADED_LATER
#include "light/face.glsl"
#endif
#ifndef ON_GROUND
#include "surface/surroundings.glsl"
#endif

/* How the water flowed here, two numbers −1 … 1, about 0. They go with the model's middle over the page. */
vec2 flow_at(vec2 pixel, float size, uint seed)
{
    vec2 at = (pixel - u_anchor) / size;
    return 0.7 * plane_noise(at, seed) + 0.45 * plane_noise(2.3 * at, seed + 1u).yx;
}

float luminance_of(vec3 colour)
{
    return dot(colour, vec3(0.2126, 0.7152, 0.0722));
}

float least_of(vec3 colour)
{
    return min(colour.r, min(colour.g, colour.b));
}

const float DRIFT = 0.3; /* how far pigments part where the water flowed, for all the unevenness there is */

/* How much pigment lies here for each that does without unevenness: the water ran, and where more of it came back into what was drying it pushed pigment before it, to a ragged border. */
float uneven_at(vec2 pixel, float flow)
{
    const float WIDE = 2.4, FINE = 0.26, BACK = 0.12, RIM = 0.9, RAGGED = 0.07, MOVED = 0.112; /* of flow_size; of the noise; what all of it loses in the mean */
    vec2 at = (pixel - u_anchor) / u_flow_size;
    float back = plane_noise(at / WIDE, 71u).x + RAGGED * plane_noise(at / FINE, 72u).x + 0.4 * RAGGED * plane_noise(2.7 * at / FINE, 73u).x - BACK;
    float run = MOVED + (back > 0.0 ? RIM * exp(-back / 0.055) - 0.6 * (1.0 - exp(-back / 0.12)) : 0.0);
    return max(1.0 + u_flow * (flow + run), 0.0);
}

/* How much of it settles here: the deeper the paper, the more, and in the pits rather than along the furrows, which two sheets across each other do not share. Contacts are even, so that the mean is 1. */
float settled_at(vec2 pixel)
{
#ifdef WITH_GRANULATION
    const float GRAIN = 1.4, OTHER = 1.37; /* 1/96 inch; times that */
    vec2 at = (pixel - u_anchor) / (u_valleys_facts.x * GRAIN * 0.25 * page_unit());
    vec2 deep = 1.0 - vec2(textureLod(t_valleys, vec3(at, 0.0), 0.0).r, textureLod(t_valleys, vec3(vec2(-at.y, at.x) / OTHER + 0.41, 0.0), 0.0).r);
    return 1.0 + u_granulation * (4.0 * deep.x * deep.y - 1.0);
#else
    return 1.0;
#endif
}

#ifdef ON_GROUND
/* A shadow that is thrown: one wash, with a rim where it ends on dry paper and none where it runs out. */
vec4 surface_colour(surface_point p)
{
    const int ROUND = 12;
    float shade = 1.0 - p.albedo.a, inside = 0.0;
    for (int i = 0; i < 2 * ROUND; i++) {
        float angle = 6.2831853 * (float(i) + 0.5) / float(ROUND), radius = i < ROUND ? 2.4 * u_pool : u_pool;
        ivec2 pixel = ivec2(clamp(floor(gl_FragCoord.xy + radius * vec2(cos(angle), sin(angle))), vec2(0.0), u_size - 1.0));
        float there = texelFetch(t_id, pixel, 0).r == p.part ? 1.0 - texelFetch(t_albedo, pixel, 0).a : 0.0;
        inside += min(there / max(shade, 1e-3), 1.0) / float(2 * ROUND);
    }
    vec2 flow = flow_at(gl_FragCoord.xy, u_flow_size, 35u);
    float rim = pow(1.0 - smoothstep(0.45, 1.0, inside), 1.6) * clamp(0.8 + 1.6 * flow_at(gl_FragCoord.xy, 0.4 * u_flow_size, 37u).x, 0.2, 1.5); /* more of it stood here, less there */
    float pigment = (1.0 + 0.5 * u_pooling * rim) * uneven_at(gl_FragCoord.xy, flow.x) * settled_at(gl_FragCoord.xy);
    vec3 parted = 1.0 + DRIFT * u_flow * flow.y * vec3(1.0, 0.1, -1.0);
    float most = min(shade * pigment, 1.0);
    return vec4(pow(clamp(p.albedo.rgb, 0.0001, 1.0), parted), 1.0) * most;
}
#else
const float WET = 0.3;   /* of the further washes, what goes over gradually from where more to where less of them lies: it ran before it was dry */
const float LOST = 20.0; /* how wide ends get where the paper was wet, 1/96 inch */

/* How many of the further washes lie here, each with what its end has carried to it, where the paper was dry; `slope`: how fast the light changes, by a pixel; `wet`: 0 … 1. Ends are
 * found on dry paper and lost on wet. */
float washes_at(float light, float slope, float wet)
{
    float sum = 0.0, steep = max(slope, 1e-5), width = mix(max(u_softness, 1.0), max(u_softness, LOST * page_unit()), wet);
    for (int k = 1; k < u_washes; k++) {
        float inside = (float(u_washes - k) / float(u_washes) - light) / steep; /* pixels */
        float cover = clamp(inside / width + 0.5, 0.0, 1.0);
        cover *= cover * (3.0 - 2.0 * cover);
        sum += cover * (1.0 + (1.0 - wet) * u_pooling * exp(-max(inside, 0.0) / u_pool) * step(1e-4, slope));
    }
    return mix(sum, float(u_washes - 1) * (1.0 - light), WET);
}

vec4 surface_colour(surface_point p)
{
    float border = 0.0, slope, first = unshadowed(p);
#ifdef SHADED_LATER
    surroundings around = surroundings_of(p, true);
    surface_point right = p, above = p;
    first = around.light;
    p.normal = around.normal;
    p.albedo.rgb = around.albedo;
    right.normal = normalize(around.normal + around.across);
    above.normal = normalize(around.normal + around.up);
    /* Half of the disc is beyond a straight border; what is left of it says how far that is. */
    float away = u_smoothing * max(2.0 * around.own - 1.0, 0.0);
    border = exp(-away / u_pool) * (1.0 - smoothstep(0.9, 0.98, around.own));
#endif
    float light = min(luminance_of(diffuse_light_of(p, 1.0)), 1.0), dark = min(luminance_of(diffuse_light_of(p, 0.0)), 1.0);
#ifdef SHADED_LATER
    slope = length(vec2(luminance_of(diffuse_light_of(right, 1.0)), luminance_of(diffuse_light_of(above, 1.0))) - light);
#else
    slope = fwidth(light);
#endif
    float wander = u_wander * min(slope, 0.05) * flow_at(gl_FragCoord.xy, 30.0 * page_unit(), 21u).x;
    float wet = u_flow > 0.0 ? smoothstep(-0.1, 0.35, plane_noise((gl_FragCoord.xy - u_anchor) / (90.0 * page_unit()), 49u).x) : 0.0;
    float further = mix(washes_at(dark + wander, slope, wet), washes_at(light + wander, slope, wet), first) / max(float(u_washes - 1), 1.0);
    float kept = u_reserve > 0.0 ? clamp((1.0 - u_reserve - light - wander) / max(slope, 1e-4) + 0.5, 0.0, 1.0) : 1.0;
    vec2  flow = flow_at(gl_FragCoord.xy, u_flow_size, 35u);
    float uneven = uneven_at(gl_FragCoord.xy, flow.x) * settled_at(gl_FragCoord.xy);
    kept = mix(1.0, kept, smoothstep(0.3, 0.75, least_of(shown(p.albedo.rgb)))); /* colours are not left out */
    float pigment = (u_pale * (1.0 + u_pooling * border) + (u_deep - u_pale) * further) * uneven * kept;

    float grey = luminance_of(p.albedo.rgb);
    vec3 own = clamp(shown(max(mix(vec3(grey), p.albedo.rgb, u_saturation), vec3(0.0))), 0.02, 1.0);
    vec3 parted = 1.0 + DRIFT * u_flow * flow.y * vec3(1.0, 0.1, -1.0);
    vec3 glaze = pow(clamp(u_shade.rgb, 0.02, 1.0), further * uneven * kept * (2.0 * parted - 1.0));
    return vec4(mix(vec3(1.0), u_paper.rgb, u_paper.a) * pow(own, pigment * parted) * glaze, 1.0); /* light goes through as much pigment as there is, Beer's law; what is transparent will lie on white */
}
#endif
