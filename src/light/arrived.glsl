/* What the small picture says about a position: light/visibility.frag. */
#include "light/visibility.glsl"

uniform sampler2D t_visibility; /* fraction of the first light, fraction of the sky, eye depth */
uniform float     u_occlusion;  /* how much of what the sky does not give is missed */

struct arrived_light {
    float light, sky;
    bool  known;
};

/* The four samples around the position, those most that lie in the plane of its surface. Where none does, as on what is thinner than the samples' distance, and in
 * layers behind the first, nothing is known. */
arrived_light light_at(surface_point p)
{
    float depth = -p.eye.z, size = pixel_size(depth);
    vec2 at = (p.eye.xy / (u_perspective > 0.5 ? depth : 1.0) + u_unproject) / u_pixel - 0.5, low = floor(at), fraction = at - low;
    ivec2 position = ivec2(low), last = textureSize(t_visibility, 0) - 1;
    vec4 a = texelFetch(t_visibility, clamp(position, ivec2(0), last), 0), b = texelFetch(t_visibility, clamp(position + ivec2(1, 0), ivec2(0), last), 0);
    vec4 c = texelFetch(t_visibility, clamp(position + ivec2(0, 1), ivec2(0), last), 0), d = texelFetch(t_visibility, clamp(position + 1, ivec2(0), last), 0);
    vec4 depths = vec4(a.z, b.z, c.z, d.z);
    vec2 ray = ray_of(low + 0.5);
    /* Distances from the surface's plane, in pixels. */
    vec4 across = dot(p.normal.xy, ray) + vec4(0.0, p.normal.x * u_pixel.x, p.normal.y * u_pixel.y, dot(p.normal.xy, u_pixel));
    vec4 off = ((u_perspective > 0.5 ? across * depths : across) - p.normal.z * depths - dot(p.normal, p.eye)) / size;
    vec2 back = 1.0 - fraction;
    vec4 weights = (vec4(back.x * back.y, fraction.x * back.y, back.x * fraction.y, fraction.x * fraction.y) + 0.002) / (0.05 + off * off) * step(abs(off), vec4(3.0));
    float sum = dot(weights, vec4(1.0));
    weights /= max(sum, 1e-6);
    bool known = sum > 1e-5;
    return arrived_light(dot(weights, vec4(a.x, b.x, c.x, d.x)), known ? mix(1.0, dot(weights, vec4(a.y, b.y, c.y, d.y)), u_occlusion) : 1.0, known);
}
