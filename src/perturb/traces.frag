/* What the surfaces behind a texel of the coarse picture say about uncertainty, and how sure that is: a surface close behind another one's
 * border leaves the say to the nearer one, so that its lines and what runs over them move together.
 * Seed 000, section 6.7: noise as a function of a property of the surface. */
#include "light/point.glsl"

uniform vec2  u_size;
uniform vec2  u_texel;
uniform float u_cell;
uniform uint  u_seed;
uniform float u_empty; /* depth where nothing is drawn */
uniform mat4  u_rest_from_eye;
layout(location = 0) out vec4 out_0;
#define NOISE_GAIN 3.0
#define TURBULENCE_MEAN 0.16
#include "perturb/noise.glsl"

/* A surface's normal and eye depth; depth 0 where there is none. */
vec4 surface_at(ivec2 pixel)
{
#if OUTWARD == 1
    return texelFetch(t_enlarged, pixel, 0);
#else
    vec4 found = texelFetch(t_normal_depth, pixel, 0);
    return vec4(found.xyz, found.w < u_empty ? found.w : 0.0);
#endif
}

vec3 ray_of(vec2 pixel)
{
    return vec3((2.0 * (pixel + 0.5) * u_texel - 1.0) * u_unproject, -1.0);
}

/* Eye-space place of a pixel's surface. */
vec3 place_of(vec2 pixel, float depth)
{
    vec3 ray = ray_of(pixel);
    return vec3(ray.xy * mix(1.0, depth, u_perspective), -depth);
}

float pixel_size(float depth)
{
    return 2.0 * u_unproject.y * u_texel.y * mix(1.0, depth, u_perspective);
}

#if BY == 0
/* Waves of a fixed length on the sheet: the ladder of octaves goes with the size of a pixel on the surface, and each fades in and out
 * as it enters and leaves. */
vec3 noise_at(vec3 place, float depth)
{
    float level = log2(u_perturb_scale * pixel_size(depth)), top = floor(level) + 1.0;
    vec3 sum = vec3(0.0);
    float squares = 0.0;
    for (int i = 0; i <= OCTAVES; i++) {
        float octave = top - float(i), above = octave - level;
        float weight = exp2(min(above, 0.0)) * clamp(1.0 - above, 0.0, 1.0) * clamp(above + float(OCTAVES), 0.0, 1.0);
        sum += weight * octave_of(noise_of(place * exp2(-octave), u_seed + uint(int(octave) + 64) * 0x51ed270bu));
        squares += weight * weight;
    }
    return uncertainty_of(sum * inversesqrt(squares));
}
#else
vec3 noise_at(vec3 place, float ignored)
{
    vec3 sum = vec3(0.0);
    float weight = 1.0, squares = 0.0;
    for (int i = 0; i < OCTAVES; i++) {
        sum += weight * octave_of(noise_of(place, u_seed + uint(i) * 0x51ed270bu));
        squares += weight * weight;
        weight *= 0.5;
        place *= 2.0;
    }
    return uncertainty_of(sum * inversesqrt(squares));
}
#endif

vec3 trace_of(ivec2 pixel, vec4 surface)
{
    mat3 turn = mat3(u_rest_from_eye);
#if BY == 0
    vec3 eye = place_of(vec2(pixel), surface.w);
    return noise_at((u_rest_from_eye * vec4(eye, 1.0)).xyz, surface.w);
#elif BY == 1
    return noise_at(2.0 * (turn * surface.xyz), 0.0);
#else
    /* How much the normal turns over a twelfth of a wave. */
    int way = max(int(u_perturb_scale / 24.0 + 0.5), 1);
    ivec2 last = ivec2(u_size) - 1;
    float bend = surface_at(clamp(pixel + ivec2(way, 0), ivec2(0), last)).x - surface_at(clamp(pixel - ivec2(way, 0), ivec2(0), last)).x +
                 surface_at(clamp(pixel + ivec2(0, way), ivec2(0), last)).y - surface_at(clamp(pixel - ivec2(0, way), ivec2(0), last)).y;
    return noise_at(vec3(4.0 * bend, 0.37, 0.61), 0.0);
#endif
}

#if OUTWARD == 0
/* How much a surface has to say about its surroundings, 0 … 1: beside a nearer one nothing up to a texel away and all from three on; on its own
 * border less and less, so that nothing jumps as the border passes over texels; and less where it is seen at a grazing angle, since
 * waves crowd there. A step of depth counts by the length of the waves: across smaller ones noise in space hardly changes. */
float say_of(ivec2 pixel, vec4 surface)
{
    ivec2 last = ivec2(u_size) - 1;
    vec3 own = place_of(vec2(pixel), surface.w), ray = normalize(mix(vec3(0.0, 0.0, -1.0), own, u_perspective));
    vec3 facing = surface.xyz * (dot(surface.xyz, ray) > 0.0 ? -1.0 : 1.0);
    float wave = u_perturb_scale * pixel_size(surface.w), yielded = 1.0, inside = 0.0;
    for (int i = 0; i < 16; i++) {
        float angle = 0.7853982 * float(i), away = i < 8 ? 1.2 : 2.4;
        ivec2 at = clamp(pixel + ivec2(floor(away * u_cell * vec2(cos(angle), sin(angle)) + 0.5)), ivec2(0), last);
        vec4 other = surface_at(at);
        /* How far the neighbour lies in front of this surface's plane, or behind it. */
        float front = dot(facing, place_of(vec2(at), other.w) - own) / wave;
        float step = min(front, (surface.w - other.w) / wave);
        float nearer = other.w > 0.0 ? smoothstep(0.1, 0.5, step) : 0.0;
        yielded = min(yielded, mix(1.0, i < 8 ? 0.0 : 0.5, nearer));
        inside += i < 8 ? (other.w > 0.0 ? 1.0 - smoothstep(0.1, 0.5, (other.w - surface.w) / wave + min(front, 0.0)) : 0.0) : 0.0;
    }
    return yielded * (inside / 8.0) * smoothstep(0.0, 0.4, -dot(facing, ray));
}
#endif

void main()
{
    ivec2 pixel = min(ivec2(gl_FragCoord.xy * u_cell), ivec2(u_size) - 1);
    vec4 surface = surface_at(pixel);
    out_0 = vec4(0.0);
    int some = surface.w > 0.0 ? 1 : 0;
    for (int once = 0; once < some; once++) {
        float say = 1.0;
#if OUTWARD == 0
        /* A surface without a say still counts where there is no other. */
        say = max(say_of(pixel, surface), 0.002);
#endif
        out_0 = vec4(trace_of(pixel, surface) * say, say);
    }
}
