/* Ink outside a figure's boundary belongs to the surface it surrounds: the nearest one within the line's reach. Where a line runs on,
 * it does so in space. */
bool is_own(ivec2 at);
float own_depth(ivec2 at);

#ifdef HAS_MEETING
float other_depth(ivec2 at)
{
    return texelFetch(t_meeting, at, 0).r;
}

/* A slope along one axis: the gentler one to either side. */
float gentler(float before, float here, float behind)
{
    return abs(here - before) < abs(behind - here) ? here - before : behind - here;
}

/* Do both surfaces cross beyond this place? */
bool crosses_at(vec2 place, bool in_front)
{
    ivec2 at = clamp(ivec2(floor(place + 0.5)), ivec2(0), ivec2(u_size) - 1);
    float own = own_depth(at), other = other_depth(at);
    return max(own, other) < 1.0 && (own <= other) != in_front;
}

/* The depth of ink at a position: where the figure's surface and another rule's cross within the line's reach, ink lies on both, and a perturbation moves it along the other one. Outlines are none of
 * that. */
float met_depth(vec2 position, float depth)
{
    ivec2 at = pixel_at(position);
    vec4 edge = edge_at(position);
    float own = own_depth(at), other = other_depth(at), apart = own - other;
    ivec2 first = max(at - 1, ivec2(0)), last = min(at + 1, ivec2(u_size) - 1), left = ivec2(first.x, at.y), right = ivec2(last.x, at.y), down = ivec2(at.x, first.y), up = ivec2(at.x, last.y);
    vec2 slope = vec2(gentler(other_depth(left), other, other_depth(right)), gentler(other_depth(down), other, other_depth(up)));
    vec2 bend = vec2(gentler(own_depth(left), own, own_depth(right)), gentler(own_depth(down), own, own_depth(up))) - slope;
    float size = max(length(bend), 1e-20), away = apart / size;
    float extent = 0.5 * u_line_width + 0.7; /* the rim */
#ifdef PERTURBED
    extent += 0.7; /* and what lies between pixels */
#endif
    bool near = max(own, other) < 1.0 && abs(away) <= extent && min(edge.g, edge.a) <= edge.r;
    near = near && crosses_at(vec2(at) - bend / size * (away + sign(away) * 1.5), apart <= 0.0);
    float moved = 1.0;
#ifdef PERTURBED
    moved += 2.0 * u_reach;
#endif
    return near ? min(own, other) - moved * length(slope) : depth;
}
#endif

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
