/* See discontinuity.c: where visibility, orientation or part changes between neighbours. x, y: profile ink to the right and up; z, w: inner ink, and 2 where there is id
 * ink, the same. */
#include "lines/edge/edge.glsl"

#include "light/piece.glsl"
#include "light/point.glsl"
#include "lines/plane.glsl"

/* Sixteen steps of a float below 1: what the rasteriser's rounding can add up to over the depths that are compared. Where the
 * near plane is close to the eye (a viewer inside the model), smaller differences of window depth are noise. */
const float DEPTH_NOISE = 16.0 * 5.96e-8;

/* Normals that differ by less go on smoothly: cosine. */
const float GOES_ON = 0.5;
/* Slopes that differ by less than this fraction are those of one surface. */
const float EVEN = 0.5, PLANE = 0.02; /* … of one plane */

/* Part of the step `across` that the slopes before and behind it do not explain. */
float unexplained(float before, float across, float behind)
{
    float low = min(before, behind), high = max(before, behind);
    float excess = max(low - across, across - high);
    return excess - u_line_slope * max(abs(before), abs(behind));
}

bool even(float slope, float other, float fraction)
{
    return abs(slope - other) <= fraction * max(abs(slope), abs(other)) + DEPTH_NOISE;
}

/* Does depth go on evenly over this pixel and its neighbour? Faces may be only two pixels wide: then as it does on a plane, from there on or before. */
bool goes_on(vec2 side)
{
    vec4 along = vec4(neighbour(t_depth, -side).r, neighbour(t_depth, vec2(0.0)).r, neighbour(t_depth, side).r, neighbour(t_depth, 2.0 * side).r);
    vec3 slopes = along.yzw - along.xyz;
    bool both = even(slopes.x, slopes.y, EVEN) && even(slopes.y, slopes.z, EVEN) && even(slopes.x, slopes.z, EVEN);
    return both || even(slopes.x, slopes.y, PLANE) || even(slopes.y, slopes.z, PLANE);
}

/* x: inner ink, y: id ink between this pixel and the neighbour at `side`. `turned`: the normal was turned to the viewer. */
vec2 inner_and_id(vec2 side, vec3 normal, bool turned, vec3 ray, uvec2 id)
{
    vec3 other = neighbour(t_normal_depth, side).xyz;
    bool other_turned = dot(other, ray) > 0.0;
    float cosine = dot(normal, other) * (other_turned ? -1.0 : 1.0);
    /* Interpolated normals may pass the rim of what is seen within a face: turned to the viewer, neighbours are opposite there. */
    int opposite = turned != other_turned && cosine < -GOES_ON ? 1 : 0;
    for (int once = 0; once < opposite; once++)
        cosine *= goes_on(side) ? -1.0 : 1.0;
    float between = 0.0, faint = u_line_faint, crease = u_line_crease;
#ifdef HAS_ID
    uvec2 other_id = textureLod(t_id, (gl_FragCoord.xy + side) * u_texel, 0.0).rg;
#if PARTS
    between = piece_of(other_id) != piece_of(id) ? 1.0 : 0.0;
#endif
    bool meet = ((id.g ^ other_id.g) & SURFACE_INDEX_MASK) != 0u && (id.g & other_id.g & SURFACE_OPERAND) != 0u;
    faint = meet ? mix(1.0, u_line_meet, 0.5) : faint;
    crease = meet ? u_line_meet : crease;
#endif
    float inner = clamp((faint - cosine) / max(faint - crease, 1e-4), 0.0, 1.0);
    return vec2(inner, between);
}

/* Profile ink between this pixel and its neighbour at `side`, of depth `next`; `before` and `behind_next` lie on either side of the two. Where
 * one of the two is empty there is nothing but a profile, and `inks` is cleared. */
float profile_ink(vec2 side, float before, float depth, float next, float behind_next, float tolerance, inout vec2 inks)
{
    if ((depth >= 1.0) != (next >= 1.0)) {
        inks = vec2(0.0);
        return 1.0;
    }
    float across = next - depth;
    float slope_before = depth - before, slope_behind = behind_next - next;
    /* At the rim of the figure the last face may be a pixel wide: its normal tells how steep it is. */
    int rim = before >= 1.0 || behind_next >= 1.0 ? 1 : 0;
    for (int once = 0; once < rim; once++) {
        vec2 off = before >= 1.0 ? vec2(0.0) : side;
        float steep = dot(slope_of(neighbour(t_normal_depth, off), gl_FragCoord.xy + off), side);
        slope_before = before >= 1.0 ? steep : slope_before;
        slope_behind = behind_next >= 1.0 ? steep : slope_behind;
    }
    float excess = unexplained(slope_before, across, slope_behind);
    /* Where a crease is drawn anyway, a small step more is its own slope, not a second surface behind it: without this, lines
     * along such creases change class from pixel to pixel. */
    excess -= inks.x * 0.5 * max(abs(slope_before), abs(slope_behind));
    return smoothstep(0.5, 1.0, excess / tolerance);
}

float depth_at(float x, float y)
{
    return neighbour(t_depth, vec2(x, y)).r;
}

/* Of the pairs that this pixel makes with its neighbours to the right and above: each pair is looked at once. */
void main()
{
    float depth = depth_at(0.0, 0.0), right = depth_at(1.0, 0.0), up = depth_at(0.0, 1.0);
    vec2 steps = vec2(0.0), to_right = vec2(0.0), to_up = vec2(0.0);
    /* Loops that run once or not at all: software drivers skip loops, not branches, and most pixels are empty. */
    int busy = min(depth, min(right, up)) < 1.0 ? 1 : 0;
    for (int once = 0; once < busy; once++) {
        vec4 normal_depth = neighbour(t_normal_depth, vec2(0.0));
        /* Normals count as turned to the viewer, so that models of mixed winding show no lines where only the winding changes. */
        vec3 ray = vec3((2.0 * gl_FragCoord.xy * u_texel - 1.0) * u_unproject * u_perspective, -1.0);
        bool turned = dot(normal_depth.xyz, ray) > 0.0;
        vec3 normal = normal_depth.xyz * (turned ? -1.0 : 1.0);
        float z = normal_depth.w;
        float tolerance = u_line_step * (u_perspective > 0.5 ? u_near * u_far / (z * z) : 1.0);
        tolerance = max(tolerance, DEPTH_NOISE);
        uvec2 id = uvec2(0u);
#ifdef HAS_ID
        id = textureLod(t_id, gl_FragCoord.xy * u_texel, 0.0).rg;
#endif
        to_right = inner_and_id(vec2(1.0, 0.0), normal, turned, ray, id);
        to_up = inner_and_id(vec2(0.0, 1.0), normal, turned, ray, id);
        float left = depth_at(-1.0, 0.0), down = depth_at(0.0, -1.0);
        /* A step exceeds the slope before it by the bend of depth at most: where depth hardly bends there is no profile. */
        float bend = max(abs(left + right - 2.0 * depth), abs(up + down - 2.0 * depth));
        int bent = bend > 0.5 * tolerance || max(depth, max(right, up)) >= 1.0 ? 1 : 0;
        for (int again = 0; again < bent; again++) {
            steps.x = profile_ink(vec2(1.0, 0.0), left, depth, right, depth_at(2.0, 0.0), tolerance, to_right);
            steps.y = profile_ink(vec2(0.0, 1.0), down, depth, up, depth_at(0.0, 2.0), tolerance, to_up);
        }
    }
    out_edge = vec4(steps, to_right.x + 2.0 * to_right.y, to_up.x + 2.0 * to_up.y);
}
