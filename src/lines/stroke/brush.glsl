/* What a stroke is drawn with: a function of the position along the stroke and across it. Ends keep their length, what is between is stretched with the stroke. */
#include "gpu/hash.glsl"
flat in vec4 v_along;
uniform float u_pixel; /* pixels of this picture to one that is seen */

const int PEN = 0, BRUSH = 1, PENCIL = 2, CHARCOAL = 3;

/* Smooth noise, 0 … 1, of places a unit apart. */
float grain_of(vec2 position, uint seed)
{
    vec2 low = floor(position), inside = position - low, weight = inside * inside * (3.0 - 2.0 * inside);
    ivec2 first = ivec2(low);
    vec4 values;
    for (int i = 0; i < 4; i++)
        values[i] = float(hash_of(uvec3(first + ivec2(i & 1, i >> 1), 7), seed) >> 8u) * (1.0 / 16777216.0);
    return mix(mix(values.x, values.y, weight.x), mix(values.z, values.w, weight.x), weight.y);
}

/* Position along the stroke as its pattern has it: both ends `end` pixels long, from 0 and up to 3; between them 1 … 2. */
float pattern_of(float along, float whole, float end)
{
    end = max(min(end, whole / 3.0), 1e-3);
    float from_behind = whole - along;
    return along < end ? along / end : from_behind < end ? 3.0 - from_behind / end : 1.0 + (along - end) / max(whole - 2.0 * end, 1e-3);
}

/* Bristles: dry where the brush leaves the paper, wet where it came down. */
float brush_dryness(float pattern, float across, uint seed)
{
    float bristle = grain_of(vec2(across * 5.0 + 20.0, pattern * 2.0), seed);
    float dry = smoothstep(1.7, 3.0, pattern) * 0.95;
    return clamp((bristle - dry * 0.9 + 0.12) * 6.0, 0.0, 1.0);
}

/* THE_BRUSH: all strokes have this one. Software drivers run what each brush does for all pixels, unless they know that. */
float brush_ink(piece_position p)
{
#ifdef THE_BRUSH
    const int brush = THE_BRUSH;
#else
    int brush = int(v_look.w) >> BRUSH_SHIFT;
#endif
    if (brush == PEN)
        return p.fraction;
    uint seed = uint(v_along.w);
    float along = mix(v_along.x, v_along.y, p.at), across = p.aside / max(p.axis.w, 0.5);
    float scale = max(p.axis.w, 0.5);
    if (brush == BRUSH)
        return p.fraction * brush_dryness(pattern_of(along, v_along.z, 12.0 * scale), across, seed);
    /* Grains belong to the paper, the rim to the stroke. */
    vec2 paper = gl_FragCoord.xy / u_pixel;
    if (brush == PENCIL) {
        float grain = grain_of(paper * 0.8, 11u), soft = 1.0 - 0.45 * across * across;
        return p.fraction * clamp(0.35 + soft * 1.1 * grain + 0.15, 0.0, 1.0);
    }
    float coarse = 0.65 * grain_of(paper * 0.42, 23u) + 0.35 * grain_of(paper * 0.9, 29u);
    float worn = grain_of(vec2(along / (3.0 * u_pixel), across * 1.5 + 10.0), seed);
    return p.fraction * smoothstep(0.3, 0.55, coarse + 0.25 * worn + 0.28 - 0.5 * abs(across) * abs(across));
}
