/* What techniques of motion read of a mover. */

/* How deep it is, 1 where it is not: its sprite lies where its lines are, too; what is seen through has none and is as deep as its front. */
float mover_depth_at(ivec2 pixel)
{
    return min(texelFetch(t_mover_depth, pixel, 0).r, texelFetch(t_depth, pixel, 0).r);
}

/* How it moves there, w = 0 where it is not. Lines stand beside surfaces: they move as the nearest surface within a few pixels does. */
vec4 velocity_near(ivec2 pixel)
{
    vec4 found = texelFetch(t_velocity, pixel, 0);
    int reach = found.w > 0.0 ? 0 : 4;
    for (int r = 1; r <= reach && found.w <= 0.0; r++)
        for (int i = 0; i < 8 && found.w <= 0.0; i++) {
            ivec2 beside = pixel + r * ivec2(round(vec2(cos(0.785398 * float(i)), sin(0.785398 * float(i)))));
            found = texelFetch(t_velocity, clamp(beside, ivec2(0), ivec2(u_size) - 1), 0);
        }
    return found;
}
