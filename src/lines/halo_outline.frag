/* Where the outlines are that give farther lines a halo: r = 1 − window depth, 0 elsewhere; g = how
 * uncertain its slope is there, in clear steps. */
#include "lines/halo.glsl"
#include "lines/lines.glsl"
layout(location = 0) out vec4 out_0;

bool is_ink(vec2 off)
{
    vec4 edge = textureLod(t_lines, (gl_FragCoord.xy + off) * u_texel, 0.0);
    vec3 ink = (1.0 - edge.rga) * vec3(u_line_profile_weight, u_line_inner_weight, u_line_id_weight);
    return max(ink.x, max(ink.y, ink.z)) >= LINE_INK;
}

/* Is the neighbour at `side` deeper than the slopes before and behind it explain? */
bool steps_down(float depth, vec2 side, float clear)
{
    float next = depth_at(side), before = depth_at(-side), behind = depth_at(2.0 * side);
    float slope = max(before < 1.0 ? depth - before : 0.0, behind < 1.0 ? behind - next : 0.0);
    return next >= 1.0 || next - depth - 2.0 * max(slope, 0.0) > clear;
}

void main()
{
    float depth = depth_at(vec2(0.0)), nearness = 0.0, steep = 0.0;
    bool inked = is_ink(vec2(0.0));
    /* Loops that run once or not at all: software drivers skip loops, not branches. */
    int busy = depth < 1.0 && inked ? 1 : 0;
    for (int once = 0; once < busy; once++) {
        float clear = clear_step(depth);
        const vec2 sides[4] = vec2[4](vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0));
        for (int k = 0; k < 4; k++)
            nearness = steps_down(depth, sides[k], clear) ? max(1.0 - depth, 1e-4) : nearness;
        int found = nearness > 0.0 ? 1 : 0;
        for (int again = 0; again < found; again++)
            steep = min(plane_at(vec3(0.0, 0.0, depth)).z / clear, 60000.0);
    }
    out_0 = vec4(nearness, steep, 0.0, 0.0);
}
