/* Ink of the edge map at a pixel, premultiplied. Nienhaus 2005, section 4.4: intensities blend between line and surface colour, each
 * class with a colour of its own. */

/* Integer positions are the centres of pixels; a perturbation looks in between. */
vec4 edge_at(vec2 position)
{
#ifdef MERGED
    return out_edge;
#elif defined(PERTURBED)
    vec4 edge = textureLod(t_edge, (position + 0.5) / u_size, 0.0);
#ifdef BROAD_LINES
    float wider = broadening();
    vec4 beside = textureLod(t_edge, (position + vec2(wider, 0.0) + 0.5) / u_size, 0.0);
    vec4 above = textureLod(t_edge, (position + vec2(0.0, wider) + 0.5) / u_size, 0.0);
    edge = wider > 0.0 ? min(edge, min(beside, above)) : max(edge, max(beside, above));
#endif
    return edge;
#else
    return texelFetch(t_edge, clamp(ivec2(position), ivec2(0), ivec2(u_size) - 1), 0);
#endif
}

/* Fraction of the lines' ink that dashes leave. */
float dash_at(vec2 position)
{
#ifdef HAS_DASH
    return texelFetch(t_dash, clamp(ivec2(floor(position + 0.5)), ivec2(0), ivec2(u_size) - 1), 0).r;
#else
    return 1.0;
#endif
}

vec4 over(vec4 front, vec4 back)
{
    return front + back * (1.0 - front.a);
}

vec4 ink_of(vec4 edge, vec4 colour, vec4 inner_colour, vec4 id_colour)
{
    float profile = clamp((1.0 - edge.r) * u_line_profile_weight, 0.0, 1.0) * colour.a;
    float inner = clamp((1.0 - edge.g) * u_line_inner_weight, 0.0, 1.0) * inner_colour.a;
    float id = clamp((1.0 - edge.a) * u_line_id_weight, 0.0, 1.0) * id_colour.a;
    vec4 ink = vec4(inner_colour.rgb, 1.0) * inner;
#if defined(HIDDEN) && HIDDEN > 0
    /* Lines behind surfaces are in the channel of all lines alone, and below the others. */
    float others = min(edge.r, edge.g), hidden = clamp(1.0 - edge.b / max(others, 1e-3), 0.0, 1.0) * u_line_hidden_colour.a;
    ink = over(ink, vec4(u_line_hidden_colour.rgb, 1.0) * hidden);
#endif
    ink = over(vec4(id_colour.rgb, 1.0) * id, ink);
    return over(vec4(colour.rgb, 1.0) * profile, ink);
}

#if CONTRAST >= 2
/* How bright the eye takes a colour, 0 … 1. */
float lightness(vec3 colour)
{
    return clamp(dot(colour, vec3(0.2126, 0.7152, 0.0722)), 0.0, 1.0);
}
#endif

#if CONTRAST >= 3
/* To which side of a contour its second line lies: section 8.6.1's open wish. */
vec2 second_side(ivec2 pixel)
{
#if CONTRAST == 3
    /* The outer one, which the gradient of depth points to. */
    ivec2 last = ivec2(u_size) - 1;
    vec2 side = vec2(texelFetch(t_depth, clamp(pixel + ivec2(2, 0), ivec2(0), last), 0).r -
                         texelFetch(t_depth, clamp(pixel - ivec2(2, 0), ivec2(0), last), 0).r,
                     texelFetch(t_depth, clamp(pixel + ivec2(0, 2), ivec2(0), last), 0).r -
                         texelFetch(t_depth, clamp(pixel - ivec2(0, 2), ivec2(0), last), 0).r);
#else
    /* The light's: the dark line is the shaded side of a ridge. From straight ahead it is taken for light from above. */
    vec2 side = length(u_first_light.xy) > 0.02 ? u_first_light.xy : vec2(0.0, 1.0);
#endif
    float size = length(side);
    return size > 1e-7 ? side / size : vec2(0.0);
}
#endif

#if CONTRAST == 2
/* Section 8.6.2: dark on light ground and light on dark, by the blurred picture. */
bool is_light_line(ivec2 pixel)
{
    float ground = lightness(texelFetch(t_ground, clamp(pixel, ivec2(0), ivec2(u_size) - 1), 0).rgb);
    return abs(lightness(u_line_light_colour.rgb) - ground) > abs(lightness(u_line_colour.rgb) - ground);
}

/* Where the picture shows the edge by itself the line may be left out. A loop, since software drivers leave out those that no pixel enters, and run all else. */
float not_suppressed(ivec2 pixel)
{
    float left = 1.0;
    int wanted = u_line_suppress > 0.0 ? 1 : 0;
    for (int once = 0; once < wanted; once++) {
        ivec2 reach = ivec2(2, 0);
        float across = lightness(texelFetch(t_shade, clamp(pixel + reach.xy, ivec2(0), ivec2(u_size) - 1), 0).rgb) -
                       lightness(texelFetch(t_shade, clamp(pixel - reach.xy, ivec2(0), ivec2(u_size) - 1), 0).rgb);
        float up = lightness(texelFetch(t_shade, clamp(pixel + reach.yx, ivec2(0), ivec2(u_size) - 1), 0).rgb) -
                   lightness(texelFetch(t_shade, clamp(pixel - reach.yx, ivec2(0), ivec2(u_size) - 1), 0).rgb);
        left = 1.0 - smoothstep(u_line_suppress, u_line_suppress + 0.1, max(abs(across), abs(up)));
    }
    return left;
}

/* Ink of the dark colour as it is where it lies. */
vec4 contrasting(vec4 ink, ivec2 pixel)
{
    return (is_light_line(pixel) ? vec4(u_line_light_colour.rgb, 1.0) * (ink.a * u_line_light_colour.a) : ink) * not_suppressed(pixel);
}
#endif

vec4 ink_at(vec2 position)
{
    vec4 edge = edge_at(position);
    vec4 ink = ink_of(edge, u_line_colour, u_line_inner_colour, u_line_id_colour) * dash_at(position);
#if CONTRAST >= 2
    ivec2 pixel = ivec2(floor(position + 0.5));
#endif
#if CONTRAST == 1
    /* Freudenberg 2003, section 8.6.1: the same contour once more in the second colour, moved; the first lies on top. */
    vec2 moved = position - floor(vec2(u_line_offset_x, -u_line_offset_y) + 0.5);
    ink = over(ink, ink_of(edge_at(moved), u_line_light_colour, u_line_light_colour, u_line_light_colour) * dash_at(moved));
#elif CONTRAST == 2
    if (is_light_line(pixel))
        ink = ink_of(edge, u_line_light_colour, u_line_light_colour, u_line_light_colour) * dash_at(position);
    ink *= not_suppressed(pixel);
#elif CONTRAST >= 3
    vec2 moved = position - floor(second_side(pixel) * max(u_line_width, 1.0) + 0.5);
    ink = over(ink, ink_of(edge_at(moved), u_line_light_colour, u_line_light_colour, u_line_light_colour) * dash_at(moved));
#endif
    return ink;
}
