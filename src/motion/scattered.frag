/* What the object shows where it was at this moment, at those pixels alone whose moment it is. Its colour is that of where it is now. */
#include "gpu/hash.glsl"
layout(location = 0) out vec4 out_scattered;
in vec4 v_now;
uniform uint u_moment; /* of MOMENTS */
uniform uint u_sample;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint own = hash_of(uvec3(uvec2(pixel), u_sample), u_seed) % uint(MOMENTS);
    vec2 at = 0.5 * (v_now.xy / v_now.w + 1.0);
    vec4 colour = textureLod(t_mover, at, 0.0);
    if (own != u_moment || v_now.w <= 0.0 || colour.a <= 0.0)
        discard;
    out_scattered = colour;
}
