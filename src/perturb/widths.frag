/* How far the parts behind a texel of the coarse picture may move anything, as a fraction of the most: no farther than u_perturb_narrow of
 * their width on the page, which is the least of the chords through a pixel in four directions. */
layout(location = 0) out vec4 out_0;

const float STEP_GROWTH = 1.3; /* from step to step along a chord: lengths are as exact, for their size */

/* 0: no surface here. */
uint part_at(vec2 pixel)
{
    ivec2 at = ivec2(clamp(pixel, vec2(0.0), u_size - 1.0));
#ifdef HAS_ID
    return texelFetch(t_id, at, 0).r;
#else
    return texelFetch(t_normal_depth, at, 0).w < u_empty ? 1u : 0u;
#endif
}

/* Pixels from here to where the part ends, at most `most`. */
float way_to_end(vec2 pixel, vec2 direction, uint part, float most)
{
    float way = 0.0, next = 1.0;
    while (next < most) {
        if (part_at(floor(pixel + next * direction + 0.5)) != part)
            return way;
        way = next;
        next = max(next + 1.0, next * STEP_GROWTH);
    }
    return most;
}

float width_at(vec2 pixel, uint part, float most)
{
    const vec2 directions[4] = vec2[4](vec2(1.0, 0.0), vec2(0.0, 1.0), vec2(0.7071, 0.7071), vec2(0.7071, -0.7071));
    float width = most;
    for (int i = 0; i < 4; i++)
        width = min(width, way_to_end(pixel, directions[i], part, most) + way_to_end(pixel, -directions[i], part, most) + 1.0);
    return width;
}

void main()
{
    float most = u_reach / u_perturb_narrow, least = most;
    for (int i = 0; i < 4; i++) {
        vec2 pixel = floor((floor(gl_FragCoord.xy) + 0.25 + 0.5 * vec2(i & 1, i >> 1)) * u_cell);
        pixel = min(pixel, u_size - 1.0);
        uint part = part_at(pixel);
        if (part != 0u)
            least = min(least, width_at(pixel, part, most));
    }
    out_0 = vec4(least / most, 0.0, 0.0, 1.0);
}
