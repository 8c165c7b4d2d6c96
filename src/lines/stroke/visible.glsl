/* Is a place of a line seen? It is compared with the surfaces around its axis, not around the pixel, so that lines are as wide as they are wherever surfaces bend away (row
 * EX-14). Window depth is affine on planes: a surface is carried on from the middle of its pixel to the axis. Where one of the nine pixels around shows nothing that is
 * nearer, the line is seen: an outline lies beside the pixels of its surface as often as in them. */
uniform vec2 u_far_corner; /* the last pixel */

/* What surfaces and lines may differ by on the same plane: rounding, and a share of how steep the surface is in a pixel. */
const float ROUNDING = 4e-6, SLOPE = 0.25;

float depth_at(vec2 pixel)
{
    return texelFetch(t_depth, ivec2(clamp(pixel, vec2(0.0), u_far_corner)), 0).r;
}

/* Three pixels in a row, the middle one at `pixel`. */
vec3 depths_at(vec2 pixel)
{
    return vec3(depth_at(pixel - vec2(1.0, 0.0)), depth_at(pixel), depth_at(pixel + vec2(1.0, 0.0)));
}

float smaller(float a, float b)
{
    return abs(a) < abs(b) ? a : b;
}

vec3 smaller(vec3 a, vec3 b)
{
    return mix(b, a, vec3(lessThan(abs(a), abs(b))));
}

float largest(vec3 v)
{
    return max(max(v.x, v.y), v.z);
}

float smallest(vec3 v)
{
    return min(min(v.x, v.y), v.z);
}

/* Is one of a row's surfaces not nearer? `slope`: along y; `off`: from the row's middle to the axis. */
bool is_before(float depth, vec3 row, vec3 across, vec3 slope, vec2 off)
{
    vec3 nearer = depth - row - across * vec3(off.x + 1.0, off.x, off.x - 1.0) - slope * off.y;
    return any(lessThanEqual(nearer, ROUNDING + SLOPE * (abs(across) + abs(slope)))) || any(greaterThanEqual(row, vec3(1.0)));
}

/* The same with each pixel's own steepness, which takes the pixels around. */
bool is_before_exactly(float depth, vec2 pixel, vec3 before, vec3 row, vec3 behind, vec2 off)
{
    float left = depth_at(pixel - vec2(2.0, 0.0)), right = depth_at(pixel + vec2(2.0, 0.0));
    vec3 across = smaller(vec3(row.yz, right) - row, row - vec3(left, row.xy));
    return is_before(depth, row, across, smaller(behind - row, row - before), off);
}

bool is_visible(vec3 axis)
{
    const vec2 UP = vec2(0.0, 1.0);
    vec2 middle = floor(axis.xy), off = axis.xy - middle - 0.5;
    vec3 below = depths_at(middle - UP), here = depths_at(middle), above = depths_at(middle + UP);
    vec3 slope = smaller(above - here, here - below);
    float across = smaller(here.z - here.y, here.y - here.x);
    bool seen = is_before(axis.z, here, vec3(across), slope, off) || is_before(axis.z, below, vec3(across), slope, off + UP) ||
                is_before(axis.z, above, vec3(across), slope, off - UP);
    /* In a groove surfaces are nearer on both sides, each with a steepness of its own. What lies farther behind than any of these reach is hidden. */
    float far = largest(max(max(below, here), above)), near = smallest(min(min(below, here), above));
    bool is_hidden = axis.z > far + 0.75 * (far - near) + ROUNDING;
    for (int once = seen || is_hidden ? 1 : 0; once < 1; once++) {
        vec3 lowest = depths_at(middle - 2.0 * UP), highest = depths_at(middle + 2.0 * UP);
        seen = is_before_exactly(axis.z, middle, below, here, above, off) ||
               is_before_exactly(axis.z, middle - UP, lowest, below, here, off + UP) ||
               is_before_exactly(axis.z, middle + UP, here, above, highest, off - UP);
    }
    return seen;
}
