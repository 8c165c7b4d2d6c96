/* What the surfaces behind a texel of the coarse picture say about uncertainty, and how sure that is: a surface close behind another one's
 * border leaves the say to the nearer one, so that its lines and what runs over them move together.
 * Nienhaus 2005, section 6.7: noise as a function of a property of the surface. */
#include "light/point.glsl"

layout(location = 0) out vec4 out_0;
#define NOISE_GAIN 3.0
#include "perturb/noise.glsl"

/* A surface's normal and eye depth; depth 0 where there is none. Beyond the page it is that of the border. */
vec4 surface_at(vec2 pixel)
{
    vec2 at = (pixel + 0.5) * u_texel;
#if OUTWARD == 1
    vec4 found = textureLod(t_enlarged, at, 0.0);
    return vec4(found.xy, sqrt(max(1.0 - dot(found.xy, found.xy), 0.0)), found.w);
#else
    vec4 found = textureLod(t_normal_depth, at, 0.0);
    return vec4(found.xyz, found.w < u_empty ? found.w : 0.0);
#endif
}

/* The part that a pixel shows, from 0. */
int part_at(vec2 pixel)
{
#if OUTWARD == 1
    return int(textureLod(t_enlarged, (pixel + 0.5) * u_texel, 0.0).z + 0.5) - 1;
#elif defined(HAS_ID)
    return int(texelFetch(t_id, ivec2(pixel), 0).r) - 1;
#else
    return u_only_part;
#endif
}

vec3 ray_of(vec2 pixel)
{
    return vec3((2.0 * (pixel + 0.5) * u_texel - 1.0) * u_unproject, -1.0);
}

/* Eye-space position of a pixel's surface. */
vec3 position_of(vec2 pixel, float depth)
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
vec3 noise_at(vec3 position, float depth, uint seed)
{
    float level = log2(LATTICE * u_perturb_scale * pixel_size(depth)), top = floor(level) + 1.0;
    vec3 sum = vec3(0.0);
    float weights = 0.0, squares = 0.0;
    for (int i = 0; i <= OCTAVES; i++) {
        float octave = top - float(i), above = octave - level;
        float weight = exp2(min(above, 0.0)) * clamp(1.0 - above, 0.0, 1.0) * clamp(above + float(OCTAVES), 0.0, 1.0);
        sum += weight * octave_of(noise_of(position * exp2(-octave), seed + uint(int(octave) + 64) * 0x51ed270bu));
        weights += weight;
        squares += weight * weight;
    }
    return uncertainty_of(sum, weights, squares);
}
#else
vec3 noise_at(vec3 position, uint seed)
{
    vec3 sum = vec3(0.0);
    float weight = 1.0, weights = 0.0, squares = 0.0;
    for (int i = 0; i < OCTAVES; i++) {
        sum += weight * octave_of(noise_of(position, seed + uint(i) * 0x51ed270bu));
        weights += weight;
        squares += weight * weight;
        weight *= 0.5;
        position *= 2.0;
    }
    return uncertainty_of(sum, weights, squares);
}
#endif

/* In the frame of what the part moves with: what is moved keeps its waves, and they run on from part to part. */
vec3 trace_of(vec2 pixel, vec4 surface)
{
    int part = part_at(pixel);
    ivec2 at = ivec2(5 * (part % 1024), part / 1024);
    mat3x4 rows = mat3x4(texelFetch(t_part_frames, at, 0), texelFetch(t_part_frames, at + ivec2(1, 0), 0),
                         texelFetch(t_part_frames, at + ivec2(2, 0), 0));
    uint seed = u_seed + uint(texelFetch(t_part_frames, at + ivec2(3, 0), 0).r) * 0x632be59bu;
#if BY == 0
    vec4 world = u_world_from_eye * vec4(position_of(pixel, surface.w), 1.0);
    vec3 position = world * rows;
#ifdef HAS_REST_POSITION
    /* What is deformed carries its waves along. */
    vec4 rest = texelFetch(t_rest_position, ivec2(pixel), 0);
    position = rest.w > 0.0 ? rest.xyz : position;
#endif
    return noise_at(position, surface.w, seed);
#elif BY == 1
    vec4 normal = u_world_from_eye * vec4(surface.xyz, 0.0);
    return noise_at(2.0 * (normal * rows), seed);
#else
    /* How much the normal turns over an eighteenth of a wave. */
    float spacing = max(floor(u_perturb_scale / 36.0 + 0.5), 1.0);
    float bend = surface_at(pixel + vec2(spacing, 0.0)).x - surface_at(pixel - vec2(spacing, 0.0)).x +
                 surface_at(pixel + vec2(0.0, spacing)).y - surface_at(pixel - vec2(0.0, spacing)).y;
    return noise_at(vec3(4.0 * bend, 0.37, 0.61), seed);
#endif
}

#if OUTWARD == 0
/* How much nearer (positive) or farther than this surface its neighbour is, beyond what the slope to the neighbour on the other side
 * explains; in lengths of the shortest wave, since noise in space hardly changes across less. 0 where one is missing. */
float step_to(float neighbour, float depth, float opposite)
{
    float step = depth - neighbour, slope = opposite > 0.0 ? opposite - depth : 0.0;
    return neighbour > 0.0 ? sign(step) * max(abs(step) - max(sign(step) * slope, 0.0), 0.0) : 0.0;
}

/* How much a surface has to say about its surroundings, 0 … 1: beside a nearer one nothing up to a texel away and all from three on; on its own
 * border less and less, so that nothing jumps as the border passes over texels; and less where it is seen at a grazing angle, since
 * waves crowd there. */
float say_of(vec2 pixel, vec4 surface)
{
    const vec2 directions[4] = vec2[4](vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(0.7071, 0.7071), vec2(0.7071, -0.7071));
    float wave = LATTICE * u_perturb_scale * pixel_size(surface.w) * exp2(1.0 - float(OCTAVES)), yielded = 1.0, inside = 0.0;
    for (int ring = 0; ring < 2; ring++)
        for (int i = 0; i < 4; i++) {
            vec2 spacing = floor((ring == 0 ? 1.2 : 2.4) * u_cell * directions[i] + 0.5);
            float ahead = surface_at(pixel + spacing).w, behind = surface_at(pixel - spacing).w;
            vec2 steps = vec2(step_to(ahead, surface.w, behind), step_to(behind, surface.w, ahead)) / wave;
            float nearer = smoothstep(0.15, 0.6, max(steps.x, steps.y));
            vec2 same = (1.0 - smoothstep(vec2(0.15), vec2(0.6), -steps)) * vec2(greaterThan(vec2(ahead, behind), vec2(0.0)));
            yielded = min(yielded, mix(1.0, ring == 0 ? 0.0 : 0.5, nearer));
            inside += ring == 0 ? same.x + same.y : 0.0;
        }
    vec3 ray = normalize(mix(vec3(0.0, 0.0, -1.0), position_of(pixel, surface.w), u_perspective));
    return yielded * (inside / 8.0) * smoothstep(0.0, 0.4, abs(dot(surface.xyz, ray)));
}
#endif

#ifdef HAS_WIDTHS
/* What the narrowest part around a texel leaves of displacements. Beyond a narrow part's border too, where its lines and its fill are looked up. */
float width_fraction()
{
    ivec2 last = textureSize(t_widths, 0) - 1;
    float least = 1.0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            least = min(least, texelFetch(t_widths, clamp(ivec2(gl_FragCoord.xy) + ivec2(x, y), ivec2(0), last), 0).r);
    return least;
}
#endif

void main()
{
    vec2 pixel = min(floor(gl_FragCoord.xy * u_cell), u_size - 1.0);
    vec4 surface = surface_at(pixel);
    out_0 = vec4(0.0);
    int some = surface.w > 0.0 ? 1 : 0;
    for (int once = 0; once < some; once++) {
        float say = 1.0;
#if OUTWARD == 0
        /* A surface without a say still counts where there is no other. */
        say = max(say_of(pixel, surface), 0.002);
#endif
        vec3 trace = trace_of(pixel, surface);
#ifdef HAS_WIDTHS
        trace.xy *= width_fraction();
#endif
        out_0 = vec4(trace * say, say);
    }
}
