/* Do so many lines crowd in a tile that all of them are finer than this? Pixels; of a pen that is hardly broader than a pixel, which has no form that could be lost, more. And pens no
 * broader than the last, which do not reach into other tiles. */
const float CALM_WIDTH = 0.5, CALM_WIDTH_OF_FINE = 0.75, FINE_PEN = 1.5, CALM_PEN = 2.5;

#ifdef HAS_CROWD
bool is_calm(ivec2 tile)
{
    const int SIDE = TILE_PIXELS / DIRECTION_APART;
    ivec2 first = tile * SIDE, last = textureSize(t_crowd, 0) - 1;
    float least = 1e9;
    for (int i = 0; i < SIDE * SIDE; i++)
        least = min(least, texelFetch(t_crowd, min(first + ivec2(i % SIDE, i / SIDE), last), 0).r);
    return u_line_width <= CALM_PEN && u_line_cover < (u_line_width <= FINE_PEN ? CALM_WIDTH_OF_FINE : CALM_WIDTH) * least;
}
#else
bool is_calm(ivec2 tile)
{
    return false;
}
#endif
