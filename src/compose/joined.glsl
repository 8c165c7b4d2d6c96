/* What perturbations need that join the copies of a line: what is to be averaged at a copy's position, and the ink that an average stands for. */
#if defined(MEAN_OF_INK) || (CONTRAST > 0 && CONTRAST != 2) || defined(HAS_DASH)
vec4 averaged_at(vec2 position, int i)
{
#ifdef MEAN_OF_INK
    return stacked_ink(position, i);
#else
    return ink_at(position);
#endif
}

vec4 ink_of_mean(vec4 mean)
{
    return mean;
}

bool is_outline(vec4 averaged)
{
    return averaged.a > 0.0;
}
#else
/* What of the pixel profile, id and inner lines have, those before on top: means of it are means of ink, and cost less. */
vec4 averaged_at(vec2 position, int i)
{
    vec4 edge = edge_at(position);
    vec3 ink = clamp((1.0 - edge.rag) * vec3(u_line_profile_weight, u_line_id_weight, u_line_inner_weight), 0.0, 1.0) *
               vec3(u_line_colour.a, u_line_id_colour.a, u_line_inner_colour.a);
    float id = ink.y * (1.0 - ink.x);
    return vec4(ink.x, id, ink.z * (1.0 - ink.x - id), 0.0);
}

vec4 ink_of_mean(vec4 mean)
{
    return vec4(u_line_colour.rgb, 1.0) * mean.x + vec4(u_line_id_colour.rgb, 1.0) * mean.y + vec4(u_line_inner_colour.rgb, 1.0) * mean.z;
}

/* Inner lines lie on surfaces. */
bool is_outline(vec4 averaged)
{
    return averaged.x + averaged.y > 0.0;
}
#endif

/* The depth of ink at a position: that of the surface it is found on, or surrounds. */
float depth_of_ink(vec2 position)
{
    ivec2 at = pixel_at(position);
    float depth = own_depth(at);
    int search = depth >= 1.0 ? 1 : 0;
    for (int once = 0; once < search; once++)
        depth = neighbour_depth(at);
    return depth;
}

/* All copies. `depth` of the fill becomes that of one with ink where there is no fill; on surfaces ink is as deep as they are. */
vec4 ink_of_copies(inout float depth)
{
    float fill_depth = depth;
    int inked = 0;
#ifdef HAS_MEETING
    float met_at = 1.0;
#endif
    for (int i = 0; i < LINE_COPIES; i++) {
        vec4 own = averaged_at(line_position(i), i);
        inked = is_outline(own) ? i : inked;
#ifdef HAS_MEETING
        int met = max(max(own.x, own.y), max(own.z, own.w)) > 0.0 ? 1 : 0;
        for (int once = 0; once < met; once++)
            met_at = min(met_at, met_depth(line_position(i), own_depth(pixel_at(line_position(i)))));
#endif
        join_copy(own, i);
    }
    vec4 ink = joined_ink();
#if CONTRAST == 2 && !defined(MEAN_OF_INK) && !defined(HAS_DASH)
    /* Once for all copies: the ground is blurred, so that they lie on the same. */
    int contrasts = ink.a > 0.0 ? 1 : 0;
    for (int once = 0; once < contrasts; once++)
        ink = contrasting(ink, ivec2(gl_FragCoord.xy));
#endif
#ifdef HAS_FOCUS
    int drawn = ink.a > 0.0 ? 1 : 0;
#else
    int drawn = ink.a > 0.0 && fill_depth >= 1.0 ? 1 : 0;
#endif
    for (int once = 0; once < drawn; once++) {
        float nearest = depth_of_ink(line_position(inked));
#ifdef HAS_FOCUS
        ink *= in_focus_of_window(nearest < 1.0 ? nearest : fill_depth);
#endif
        depth = min(depth, nearest);
    }
#ifdef HAS_MEETING
    depth = ink.a > 0.0 ? min(depth, met_at) : depth;
#endif
    return ink;
}
