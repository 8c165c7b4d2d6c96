/* Strokes of a tonal art map along the motion, as dark as what crosses the pixel covers it. Großmann 2011, section 5.2.3. Each patch of the page has one direction, so that
 * strokes are straight; where patches meet, one's strokes take over from the other's. */
#include "motion/along.glsl"
#define MIXES_TONES 1
#include "surface/halftone/tones.glsl"
layout(location = 0) out vec4 out_0;

const float DIRECTIONS = 128.0; /* of half a turn: at most 0.7 degrees off, and neighbours that move alike share one */
const float HALF_TURN = 3.14159265;

/* The number of the direction in a patch. */
float direction_in(ivec2 patch_index)
{
    vec2 middle = (vec2(patch_index) + 0.5) * u_patch;
    ivec2 last = textureSize(t_cells, 0) - 1;
    vec2 moved = texelFetch(t_cells, clamp(ivec2(middle) / DIRECTION_APART, ivec2(0), last), 0).xy;
    float angle = dot(moved, moved) > 0.0 ? atan(moved.y, moved.x) : 0.0;
    return mod(round(angle * DIRECTIONS / HALF_TURN), DIRECTIONS);
}

/* Ink of the strokes of one direction. */
float strokes_along(float number, float darkness)
{
    float angle = number * HALF_TURN / DIRECTIONS;
    vec2 along = vec2(cos(angle), sin(angle)), at = gl_FragCoord.xy - 0.5 * u_size;
    vec2 texel = vec2(dot(at, along), dot(at, vec2(-along.y, along.x))) / (u_scale * u_tones_facts.x);
    return map_ink(texel, max(-log2(u_scale), 0.0), darkness);
}

float strokes_of(float darkness)
{
    vec2 place = gl_FragCoord.xy / u_patch - 0.5, part = smoothstep(0.0, 1.0, fract(place));
    ivec2 low = ivec2(floor(place));
    float numbers[4], bare = 1.0;
    for (int i = 0; i < 4; i++)
        numbers[i] = direction_in(low + ivec2(i & 1, i >> 1));
    for (int i = 0; i < 4; i++) {
        float whole = 0.0, first = 1.0;
        for (int k = 0; k < 4; k++) {
            float same = numbers[k] == numbers[i] ? 1.0 : 0.0;
            first *= k < i ? 1.0 - same : 1.0;
            whole += same * ((k & 1) == 1 ? part.x : 1.0 - part.x) * (k > 1 ? part.y : 1.0 - part.y);
        }
        bare *= 1.0 - first * strokes_along(numbers[i], 1.0 - pow(1.0 - darkness, whole));
    }
    return 1.0 - bare;
}

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    crossing c = crossing_of(pixel);
    int count = c.depth <= texelFetch(t_scene_depth, pixel, 0).r ? samples_of(c, u_samples) : 0;
    vec4 sum = vec4(0.0);
    for (int i = 0; i < count; i++)
        sum += mover_ago(c, count > 1 ? (float(i) + 0.5) / float(count) : 0.0);
    float cover = sum.a / float(max(count, 1));
    vec3 own = sum.rgb / max(sum.a, 1e-4);
    /* What is always covered is whole: strokes close where no tone is as dark. */
    float ink = mix(strokes_of(min(cover, u_tones_facts.w)), 1.0, smoothstep(u_tones_facts.w, 1.0, cover)) * step(1e-3, cover);
    vec4 colour = vec4(mix(u_ink.rgb, own, u_ink_tint), 1.0) * ink;
#if OVER
    vec4 whole = c.there ? texelFetch(t_mover, pixel, 0) : vec4(0.0);
    colour = whole + (1.0 - whole.a) * colour;
#endif
    if (count == 0 || colour.a < 1.0 / 1024.0)
        discard;
    out_0 = colour;
    gl_FragDepth = c.depth;
}
