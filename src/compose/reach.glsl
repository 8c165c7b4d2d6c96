/* Ink outside a figure's boundary belongs to the surface it surrounds: the nearest one within the line's reach. Where a line runs on,
 * it does so in space. */
bool is_own(ivec2 at);

#ifdef HAS_OVERSHOOT
float overshoot_depth(ivec2 pixel)
{
    uint bits = texelFetch(t_overshoot, pixel, 0).g;
    float depth = uintBitsToFloat(bits);
    return bits == 0u ? 1.0 : clamp(window_depth_at_eye(depth), 0.0, 1.0);
}
#endif

float neighbour_depth(ivec2 pixel)
{
    ivec2 last = ivec2(u_size) - 1;
    float extent = 0.5 * u_line_width + 1.7; /* rims are soft, and edges up to a pixel off what has depth */
#if CONTRAST == 1
    extent += max(abs(u_line_offset_x), abs(u_line_offset_y));
#elif CONTRAST >= 3
    extent += max(u_line_width, 1.0);
#endif
#ifdef PERTURBED
    extent += 1.0; /* between pixels, ink reaches one farther */
#ifdef BROAD_LINES
    extent += most_broadening();
#endif
#endif
    int reach = max(int(ceil(extent)), 1);
    float least = 1.0;
#ifdef HAS_STROKES
    least = texelFetch(t_strokes, pixel, 0).r;
    reach = least < 1.0 ? -1 : reach;
#endif
#ifdef HAS_OVERSHOOT
    least = overshoot_depth(pixel);
#endif
#if defined(GL_ARB_texture_gather) && !defined(HAS_COMPLEMENT)
    /* Four at a time; the last overlap those before. */
    for (int y = -reach; y <= reach; y += 2)
        for (int x = -reach; x <= reach; x += 2) {
            vec2 corner = vec2(pixel + min(ivec2(x, y), reach - 1) + 1);
            vec4 four = textureGather(t_depth, corner / u_size);
            least = min(least, min(min(four.x, four.y), min(four.z, four.w)));
        }
#else
    for (int y = -reach; y <= reach; y++)
        for (int x = -reach; x <= reach; x++) {
            ivec2 at = clamp(pixel + ivec2(x, y), ivec2(0), last);
            if (is_own(at))
                least = min(least, texelFetch(t_depth, at, 0).r);
        }
#endif
    return least;
}
