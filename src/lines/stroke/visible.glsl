/* Is a place of a line seen? It is compared with the surfaces around its axis, not around the pixel, so that lines are as wide as they are wherever surfaces bend away (row
 * EX-14). Window depth is affine on planes: a surface is carried on from the middle of its pixel to the axis. Where one of the nine pixels around shows nothing that is
 * nearer, the line is seen: an outline lies beside the pixels of its surface as often as in them. */
uniform vec2 u_far_corner; /* the last pixel */

/* What surfaces and lines may differ by on the same plane: rounding, and a share of how steep the surface is in a pixel. */
const float ROUNDING = 4e-6, SLOPE = 0.25;

float smaller(float a, float b)
{
    return abs(a) < abs(b) ? a : b;
}

float depth_at(vec2 pixel)
{
    return texelFetch(t_depth, ivec2(clamp(pixel, vec2(0.0), u_far_corner)), 0).r;
}

bool is_visible(vec3 axis)
{
    const vec2 X = vec2(1.0, 0.0), Y = vec2(0.0, 1.0);
    vec2 middle = floor(axis.xy);
    bool seen = false;
    for (int i = 0; i < 9 && !seen; i++) {
        int turn = (i + 4) % 9; /* the middle first */
        vec2 pixel = middle + vec2(float(turn % 3) - 1.0, float(turn / 3) - 1.0), off = axis.xy - pixel - 0.5;
        float depth = depth_at(pixel);
        vec2 slope = vec2(smaller(depth_at(pixel + X) - depth, depth - depth_at(pixel - X)),
                          smaller(depth_at(pixel + Y) - depth, depth - depth_at(pixel - Y)));
        float nearer = axis.z - depth - dot(slope, off);
        seen = depth >= 1.0 || nearer <= ROUNDING + SLOPE * (abs(slope.x) + abs(slope.y));
    }
    return seen;
}
