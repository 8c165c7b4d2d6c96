/* For each texel, DIRECTION_APART pixels apart, the nearest pixel where a mover is, and how that moves: jump flooding (Rong and Tan 2006). What stands beside
 * surfaces, as lines do, what has no vertices to be stretched, and open surfaces are found by it. xy: pixels moved; zw: where, pixels; w 0: none is near. */
layout(location = 0) out vec4 out_nearest;

const int REACH = 32; /* texels, of the first jump */

vec4 found_at(ivec2 pixel)
{
    vec4 own = texelFetch(t_velocity, pixel, 0);
    return own.w > 0.0 ? vec4(own.xy, vec2(pixel) + 0.5) : vec4(0.0);
}

#ifdef HAS_NEAREST
void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy), last = textureSize(t_nearest, 0) - 1;
    vec2 here = (vec2(texel) + 0.5) * float(DIRECTION_APART);
    int jump = REACH >> (u_iteration - 1);
    vec4 best = vec4(0.0);
    float least = 1e12;
    for (int i = 0; i < 9; i++) {
        vec4 other = texelFetch(t_nearest, clamp(texel + jump * ivec2(i % 3 - 1, i / 3 - 1), ivec2(0), last), 0);
        float far = dot(other.zw - here, other.zw - here) + (other.w > 0.0 ? 0.0 : 1e12);
        best = far < least ? other : best;
        least = min(far, least);
    }
    out_nearest = best;
}
#else
void main()
{
    ivec2 begin = ivec2(u_around.xy), last = ivec2(u_around.zw) - 1, first = ivec2(gl_FragCoord.xy) * DIRECTION_APART;
    vec4 found = vec4(0.0);
    for (int i = 0; i < 4; i++) {
        vec4 other = found_at(clamp(first + ivec2(1 + 2 * (i & 1), 1 + (i & 2)), begin, last));
        found = found.w > 0.0 ? found : other;
    }
    out_nearest = found;
}
#endif
