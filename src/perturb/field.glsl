/* The field of uncertainty at a pixel, out of its coarse picture. */

/* Shrinks displacements towards the page's border so that none leaves it. */
float border_fraction(ivec2 pixel)
{
    vec2 margin = min(vec2(pixel), u_size - 1.0 - vec2(pixel));
    return clamp(min(margin.x, margin.y) / (2.0 * u_reach), 0.0, 1.0);
}

vec3 uncertainty_at(ivec2 pixel)
{
    vec2 position = vec2(pixel) + 0.5;
#if LOCK == 1
    if (u_perturb_tile > 0.0)
        position = mod(position, u_perturb_tile);
#endif
    return textureLod(t_uncertainty, position / (u_cell * u_grid), 0.0).xyz * border_fraction(pixel);
}
