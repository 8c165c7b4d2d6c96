/* Where a mesh's edge is, at the pixels beside it. The nearest has the pixel, outlines before creases. */
#include "lines/stroke/visible.glsl"
#include "lines/record.glsl"
flat in vec4 v_begin;
flat in vec4 v_end;
flat in vec4 v_look;
flat in vec2 v_normal;
layout(location = 0) out vec4 out_0;

#ifdef SEEN_THROUGH
/* Layers have lines behind surfaces, and each its own: those that lie on it. */
bool is_on_layer(vec3 axis, bool wanted)
{
    const vec2 X = vec2(1.0, 0.0), Y = vec2(0.0, 1.0);
    bool on = false;
    int turns = wanted ? 9 : 0;
    for (int i = 0; i < turns; i++) {
        turns = on ? 0 : turns;
        vec2 pixel = floor(axis.xy) + vec2(float(i % 3) - 1.0, float(i / 3) - 1.0), off = axis.xy - pixel - 0.5;
        float here = depth_at(pixel);
        vec2 slope = vec2(smaller(depth_at(pixel + X) - here, here - depth_at(pixel - X)), smaller(depth_at(pixel + Y) - here, here - depth_at(pixel - Y)));
        on = on || (here < 1.0 && abs(axis.z - here - dot(slope, off)) <= ROUNDING + (abs(slope.x) + abs(slope.y)));
    }
    return on;
}
#endif

void main()
{
    vec2 along = v_end.xy - v_begin.xy, from = gl_FragCoord.xy - v_begin.xy;
    float size = length(along);
    along = size > 0.0 ? along / size : vec2(1.0, 0.0);
    float ahead = dot(from, along);
    vec2 normal = v_normal != vec2(0.0) ? v_normal : vec2(-along.y, along.x);
    vec4 axis = mix(v_begin, v_end, size > 0.0 ? clamp(ahead / size, 0.0, 1.0) : 0.5);
    float off = dot(normal, (v_normal != vec2(0.0) ? axis.xy : v_begin.xy) - gl_FragCoord.xy);
    bool beside = abs(off) <= RECORD_REACH && ahead >= -0.5 && ahead <= size + 0.5;
#ifdef SEEN_THROUGH
    bool seen = is_on_layer(axis.xyz, beside);
#else
    bool seen = is_visible(axis.xyz, beside);
#endif
    if (!beside || !seen)
        discard;
    float nearness = abs(off) / RECORD_REACH + max(max(-ahead, ahead - size), 0.0);
    gl_FragDepth = 0.25 * min(nearness, 1.9) + (v_look.x < 0.0 ? 0.5 : 0.0);
    out_0 = vec4(normal, off, v_look.x);
}
