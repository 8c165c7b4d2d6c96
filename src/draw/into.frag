/* A finished drawing into a host's framebuffer: over what is there, with the depth of the page as the host's projection has it. */
uniform sampler2D t_out;   /* sRGB, straight alpha */
uniform ivec2 u_origin;    /* of the drawing in the framebuffer */
#ifdef WITH_DEPTH
uniform sampler2D t_depth; /* of the page, supersamples counted */
#ifdef HAS_SEEN
uniform sampler2D t_seen;  /* of what is seen through, which the page's leaves out */
#endif
#ifdef HAS_MOVED
uniform sampler2D t_moved; /* of what is seen through, as perturbed as it was drawn */
#endif
uniform int u_samples;     /* a side */
uniform int u_beside;       /* how far ink lies beside what has depth, samples */
uniform vec3 u_depth_line; /* the host's depth: factor, summand; and of where nothing is */
#endif
layout(location = 0) out vec4 out_0;

#ifdef WITH_DEPTH
float depth_of(ivec2 at)
{
    float depth = texelFetch(t_depth, at, 0).r;
#ifdef HAS_SEEN
    depth = min(depth, texelFetch(t_seen, at, 0).r);
#endif
#ifdef HAS_MOVED
    depth = min(depth, texelFetch(t_moved, at, 0).r);
#endif
    return depth;
}

float nearest_within(ivec2 first, ivec2 last)
{
    float nearest = 1.0;
    ivec2 low = max(first, ivec2(0)), high = min(last, textureSize(t_depth, 0) - 1);
    for (int y = low.y; y <= high.y; y++)
        for (int x = low.x; x <= high.x; x++)
            nearest = min(nearest, depth_of(ivec2(x, y)));
    return nearest;
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - u_origin;
    vec4 colour = texelFetch(t_out, pixel, 0);
    if (colour.a <= 0.0)
        discard;
#ifdef DECODES
    colour.rgb = mix(pow((colour.rgb + 0.055) / 1.055, vec3(2.4)), colour.rgb / 12.92, vec3(lessThanEqual(colour.rgb, vec3(0.04045))));
#endif
    out_0 = vec4(colour.rgb * colour.a, colour.a);
#ifdef WITH_DEPTH
    ivec2 corner = pixel * u_samples;
    float depth = nearest_within(corner, corner + u_samples - 1);
    if (depth >= 1.0 && u_beside > 0)
        depth = nearest_within(corner - u_beside, corner + u_samples - 1 + u_beside);
    gl_FragDepth = depth < 1.0 ? clamp(depth * u_depth_line.x + u_depth_line.y, 0.0, 1.0) : u_depth_line.z;
#endif
}
