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

/* Depths along one axis: before this pixel, here, at its neighbour and behind that. */
struct depth_row {
    float before, here, next, behind;
};

/* Does depth go on evenly over this pixel and its neighbour? Faces may be only two pixels wide: then as it does on a plane, from there on or before. */
bool continues(depth_row row)
{
    vec3 slopes = vec3(row.here, row.next, row.behind) - vec3(row.before, row.here, row.next);
    bool both = even(slopes.x, slopes.y, EVEN) && even(slopes.y, slopes.z, EVEN) && even(slopes.x, slopes.z, EVEN);
    return both || even(slopes.x, slopes.y, PLANE) || even(slopes.y, slopes.z, PLANE);
}

/* x: inner ink, y: id ink between this pixel and the neighbour at `side`, whose normal is `other`. `turned`: the normal was turned to the viewer. */
vec2 inner_and_id(vec2 side, vec3 normal, vec3 other, bool turned, vec3 ray, uvec2 id, depth_row row)
{
    bool other_turned = dot(other, ray) > 0.0;
    float cosine = dot(normal, other) * (other_turned ? -1.0 : 1.0);
    /* Interpolated normals may pass the rim of what is seen within a face: turned to the viewer, neighbours are opposite there. */
    cosine *= turned != other_turned && cosine < -GOES_ON && continues(row) ? -1.0 : 1.0;
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

/* Profile ink between this pixel and its neighbour at `side`. Where one of the two is empty there is nothing but a profile, and `inks` is cleared. */
float profile_ink(vec2 side, depth_row row, vec4 own, vec4 other, float tolerance, inout vec2 inks)
{
    bool rim = (row.here >= 1.0) != (row.next >= 1.0);
    float across = row.next - row.here;
    /* At the rim of the figure the last face may be a pixel wide: its normal tells how steep it is. */
    bool from_own = row.before >= 1.0, by_normal = from_own || row.behind >= 1.0;
    float steep = dot(slope_of(from_own ? own : other, gl_FragCoord.xy + (from_own ? vec2(0.0) : side)), side);
    float slope_before = from_own ? steep : row.here - row.before, slope_behind = by_normal && row.behind >= 1.0 ? steep : row.behind - row.next;
    float excess = unexplained(slope_before, across, slope_behind);
    /* Where a crease is drawn anyway, a small step more is its own slope, not a second surface behind it: without this, lines
     * along such creases change class from pixel to pixel. */
    excess -= inks.x * 0.5 * max(abs(slope_before), abs(slope_behind));
    inks = rim ? vec2(0.0) : inks;
    return rim ? 1.0 : smoothstep(0.5, 1.0, excess / tolerance);
}

float depth_at(float x, float y)
{
    return neighbour(t_depth, vec2(x, y)).r;
}

/* Of the pairs that this pixel makes with its neighbours to the right and above: each pair is looked at once, and everything that is asked of its surroundings is fetched once: software
 * drivers run all of it for all pixels, whatever branches and loops say. */
void main()
{
    depth_row across = depth_row(depth_at(-1.0, 0.0), depth_at(0.0, 0.0), depth_at(1.0, 0.0), depth_at(2.0, 0.0));
    depth_row upwards = depth_row(depth_at(0.0, -1.0), across.here, depth_at(0.0, 1.0), depth_at(0.0, 2.0));
    vec4 own = neighbour(t_normal_depth, vec2(0.0)), right = neighbour(t_normal_depth, vec2(1.0, 0.0)), up = neighbour(t_normal_depth, vec2(0.0, 1.0));
    /* Normals count as turned to the viewer, so that models of mixed winding show no lines where only the winding changes. */
    vec3 ray = vec3((2.0 * gl_FragCoord.xy * u_texel - 1.0) * u_unproject * u_perspective, -1.0);
    bool turned = dot(own.xyz, ray) > 0.0;
    vec3 normal = own.xyz * (turned ? -1.0 : 1.0);
    float z = own.w, tolerance = max(u_line_step * (u_perspective > 0.5 ? u_near * u_far / (z * z) : 1.0), DEPTH_NOISE);
    uvec2 id = uvec2(0u);
#ifdef HAS_ID
    id = textureLod(t_id, gl_FragCoord.xy * u_texel, 0.0).rg;
#endif
    vec2 to_right = inner_and_id(vec2(1.0, 0.0), normal, right.xyz, turned, ray, id, across);
    vec2 to_up = inner_and_id(vec2(0.0, 1.0), normal, up.xyz, turned, ray, id, upwards);
#ifdef HAS_MEETING
    to_right.x = meets(vec2(1.0, 0.0)) ? 1.0 : to_right.x;
    to_up.x = meets(vec2(0.0, 1.0)) ? 1.0 : to_up.x;
#endif
    /* A step exceeds the slope before it by the bend of depth at most: where depth hardly bends there is no profile. */
    float bend = max(abs(across.before + across.next - 2.0 * across.here), abs(upwards.before + upwards.next - 2.0 * upwards.here));
    bool bent = bend > 0.5 * tolerance || max(across.here, max(across.next, upwards.next)) >= 1.0;
    vec2 right_inks = to_right, up_inks = to_up;
    vec2 steps = vec2(profile_ink(vec2(1.0, 0.0), across, own, right, tolerance, right_inks), profile_ink(vec2(0.0, 1.0), upwards, own, up, tolerance, up_inks));
    steps = bent ? steps : vec2(0.0);
    to_right = bent ? right_inks : to_right;
    to_up = bent ? up_inks : to_up;
    bool busy = min(across.here, min(across.next, upwards.next)) < 1.0;
    out_edge = busy ? vec4(steps, to_right.x + 2.0 * to_right.y, to_up.x + 2.0 * to_up.y) : vec4(0.0);
}
