/* Is a position of a line seen? It is compared with the surfaces around its axis, not around the pixel, so that lines are as wide as they are wherever surfaces bend away (row
 * EX-14). Window depth is affine on planes: a surface is carried on from the middle of its pixel to the axis. Where one of the nine pixels around shows nothing that is
 * nearer, the line is seen: an outline lies beside the pixels of its surface as often as in them. */
uniform vec2 u_far_corner; /* the last pixel */

/* What surfaces and lines may differ by on the same plane: rounding, and a fraction of how steep the surface is in a pixel. */
const float ROUNDING = 2e-6, SLOPE = 0.35;
/* So much deeper than a pixel at the bottom of a valley may it be in truth, steps of the lesser wall. */
const float VALLEY = 1.0;
/* So much of what is around a position shows nothing nearer. */
const float ENOUGH = 0.1;

float depth_at(vec2 pixel)
{
    return texelFetch(t_depth, ivec2(clamp(pixel, vec2(0.0), u_far_corner)), 0).r;
}

#ifdef HAS_NORMAL_DEPTH
#include "lines/plane.glsl"

/* So much deeper than its pixel's own plane may a position be. */
const float OFF_PLANE = 0.1;

/* How much nearer than the position the plane of the pixel's normal is, less what is allowed. Faces about a pixel high and what lies at their feet have no neighbours that tell
 * how steep they are. */
float before_plane(vec2 pixel, vec2 off, float here, float depth)
{
    vec2 slope = slope_of(texelFetch(t_normal_depth, ivec2(clamp(pixel, vec2(0.0), u_far_corner)), 0), pixel + 0.5);
    return depth - here - dot(slope, off) - OFF_PLANE * (abs(slope.x) + abs(slope.y)) - ROUNDING;
}
#endif

float smaller(float a, float b)
{
    return abs(a) < abs(b) ? a : b;
}

/* At the bottom of a valley along one axis of the picture, how steep the lesser of its walls is from pixel to pixel; 0 elsewhere. The bottom lies between pixels, so that these are
 * less deep. */
float least_wall(float here, float before, float behind, vec2 pixel, vec2 way)
{
    return max(0.0, min(max(here - before, before - depth_at(pixel - 2.0 * way)), max(here - behind, behind - depth_at(pixel + 2.0 * way))));
}

/* What a pixel near the position says of it. x: it shows nothing that is nearer; y: the position is hidden, whatever other pixels say. */
bvec2 seen_beside(vec2 pixel, vec3 axis)
{
    const vec2 X = vec2(1.0, 0.0), Y = vec2(0.0, 1.0);
    vec2 off = axis.xy - pixel - 0.5;
#ifdef GL_ARB_texture_gather
    vec2 corner = clamp(pixel, vec2(0.0), u_far_corner), texel = 1.0 / (u_far_corner + 1.0);
    vec4 ahead = textureGather(t_depth, (corner + 1.0) * texel), before = textureGather(t_depth, corner * texel);
    float here = ahead.w, left = before.x, right = ahead.z, below = before.z, above = ahead.x;
#else
    float here = depth_at(pixel), left = depth_at(pixel - X), right = depth_at(pixel + X), below = depth_at(pixel - Y), above = depth_at(pixel + Y);
#endif
    vec2 slope = vec2(smaller(right - here, here - left), smaller(above - here, here - below));
    float nearer = axis.z - here - dot(slope, off);
    bool seen = here >= 1.0 || nearer <= ROUNDING + SLOPE * (abs(slope.x) + abs(slope.y));
    /* What lies farther behind than any of these reach is hidden. */
    float far = max(max(max(left, right), max(below, above)), here), near = min(min(min(left, right), min(below, above)), here);
    bool hidden = axis.z > far + 4.0 * (far - near) + ROUNDING;
    int valley = seen || hidden ? 0 : 1;
    for (int once = 0; once < valley; once++) {
        float bottom = max(least_wall(here, left, right, pixel, X), least_wall(here, below, above, pixel, Y));
        seen = nearer <= ROUNDING + VALLEY * bottom;
#ifdef HAS_NORMAL_DEPTH
        int steep = seen ? 0 : 1;
        for (int again = 0; again < steep; again++)
            seen = before_plane(pixel, off, here, axis.z) <= 0.0;
#endif
    }
    return bvec2(seen, hidden && !seen);
}

/* One pixel a turn, the middle one first, so that most positions are decided after one; software drivers run the first turn in any case. `wanted`: whether the answer
 * matters. */
bool is_visible(vec3 axis, bool wanted)
{
    vec2 middle = floor(axis.xy), beside = vec2(0.0), next = vec2(1.0, 0.0);
    bool seen = false;
    int turns = wanted ? 9 : 0;
    for (int i = 0; i < turns; i++) {
        bvec2 found = seen_beside(middle + beside, axis);
        seen = found.x;
        turns = seen || found.y ? 0 : turns;
        beside = next;
        next = vec2(sign(next.x - next.y), sign(next.x + next.y));
    }
    return seen;
}

/* How much of what is around a position shows nothing nearer: the four pixels whose middles are around it, each with the weight that a bilinear sample gives it, until there is
 * `enough`. */
float seen_weight(vec3 axis, float enough, bool wanted)
{
    vec2 middle = floor(axis.xy), to = axis.xy - middle - 0.5, towards = vec2(to.x < 0.0 ? -1.0 : 1.0, to.y < 0.0 ? -1.0 : 1.0), fraction = abs(to);
    float weight = 0.0, left = 1.0;
    int turns = wanted ? 4 : 0;
    for (int i = 0; i < turns; i++) {
        vec2 aside = vec2(float(i % 2), float(i / 2)), weights = mix(1.0 - fraction, fraction, aside);
        bvec2 found = seen_beside(middle + towards * aside, axis);
        weight += found.x ? weights.x * weights.y : 0.0;
        left = found.y ? 0.0 : left - weights.x * weights.y;
        turns = weight >= enough || weight + left < min(enough, ENOUGH) ? 0 : turns;
    }
    return weight;
}

/* What is hidden less than a pixel beside the rim of what hides it, or just beneath a surface that it runs into, is not seen here and there as pixels have their middles. */
bool is_mostly_visible(vec3 axis, bool wanted)
{
    return seen_weight(axis, ENOUGH, wanted) >= ENOUGH;
}
