/* Maps on the GPU: what is there so far, and over it the pixels of a figure where they are the nearest; ink outside the figure's boundary darkens what is empty. */
uniform sampler2D t_depth, t_normal, t_edge, t_shade; /* so far */
uniform usampler2D t_id;
uniform sampler2D t_own_normal_depth, t_own_shade; /* the figure's */
uniform usampler2D t_own_id;
#ifdef HAS_EDGES
uniform sampler2D t_own_edge;
#endif
#ifdef HAS_VELOCITY
uniform sampler2D t_velocity;
layout(location = 5) out vec4 out_velocity;
#endif
#ifdef HAS_OWN_VELOCITY
uniform sampler2D t_own_velocity;
#endif
#ifdef SHARED
uniform int u_index; /* of the figure among those that share their layers */
#endif
layout(location = 0) out vec4 out_depth;
layout(location = 1) out vec4 out_normal;
layout(location = 2) out uvec4 out_id;
layout(location = 3) out vec4 out_edge;
layout(location = 4) out vec4 out_shade;

/* Does the pixel belong to this figure, and not to another one that is there for its edges or shares the layers? */
bool is_own(uvec2 id)
{
    if (id.x == 0u || (id.y & SURFACE_COMPLEMENT) != 0u)
        return false;
#ifdef SHARED
    return int((id.y >> SURFACE_INDEX_BITS) & SURFACE_FIGURE_MASK) == u_index;
#else
    return true;
#endif
}

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec2 own_id = texelFetch(t_own_id, at, 0).xy;
    vec4 normal_depth = texelFetch(t_own_normal_depth, at, 0);
    vec4 edge = vec4(1.0);
#ifdef HAS_EDGES
    edge = texelFetch(t_own_edge, at, 0);
#endif
    bool own = is_own(own_id);
    out_depth = vec4(texelFetch(t_depth, at, 0).r, 0.0, 0.0, 0.0);
    out_normal = texelFetch(t_normal, at, 0);
    out_id = uvec4(texelFetch(t_id, at, 0).r, 0u, 0u, 0u);
    out_edge = texelFetch(t_edge, at, 0);
    out_shade = texelFetch(t_shade, at, 0);
#ifdef HAS_VELOCITY
    out_velocity = texelFetch(t_velocity, at, 0);
#endif
    if (own && normal_depth.a <= out_depth.r) {
        out_depth.r = normal_depth.a;
        out_normal = vec4(normal_depth.xyz, 0.0);
        out_id.r = own_id.x;
        out_edge = edge;
        out_shade = texelFetch(t_own_shade, at, 0);
#ifdef HAS_OWN_VELOCITY
        out_velocity = vec4(texelFetch(t_own_velocity, at, 0).xy, 0.0, 0.0);
#endif
    } else if (!own && out_id.r == 0u) {
        out_edge = min(out_edge, edge);
    }
}
