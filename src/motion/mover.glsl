/* What techniques of motion read of a mover. */

/* How deep it is, 1 where it is not: its sprite lies where its lines are, too; what is seen through has none and is as deep as its front. */
float mover_depth_at(ivec2 pixel)
{
    float depth = texelFetch(t_mover_depth, pixel, 0).r;
#ifdef SEEN_THROUGH
    depth = min(depth, texelFetch(t_depth, pixel, 0).r);
#endif
    return depth;
}

const ivec2 around[8] = ivec2[](ivec2(1, 0), ivec2(-1, 0), ivec2(0, 1), ivec2(0, -1), ivec2(1, 1), ivec2(-1, -1), ivec2(1, -1), ivec2(-1, 1));

/* How it moves there, w = 0 where it is not. Lines stand beside surfaces: they move as the nearest surface within a few pixels does. */
vec4 velocity_near(ivec2 pixel)
{
    vec4 found = texelFetch(t_velocity, pixel, 0);
    int last = found.w > 0.0 ? 0 : 32;
    for (int i = 0; i < last; i++) { /* rings of eight */
        ivec2 beside = pixel + ((i >> 3) + 1) * around[i & 7];
        found = texelFetch(t_velocity, clamp(beside, ivec2(u_around.xy), ivec2(u_around.zw) - 1), 0);
        last = found.w > 0.0 ? 0 : last;
    }
    return found;
}
