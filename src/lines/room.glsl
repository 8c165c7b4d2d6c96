/* How wide lines are at a position of the page, in pixels: where they crowd they cover a share of it and no more. */
float line_width_at(vec2 position)
{
#ifdef HAS_CROWD
    float length = textureLod(t_crowd, position / (vec2(textureSize(t_crowd, 0)) * float(DIRECTION_APART)), 0.0).r;
    return min(u_line_width, u_line_cover / max(length, 1e-4));
#else
    return u_line_width;
#endif
}
