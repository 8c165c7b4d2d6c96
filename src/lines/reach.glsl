/* How far from a pixel that is beside an edge its line's ink goes, in pixels; and from which width on neighbours do not tell all that is to be known. */
const float BROAD = 3.0;

int line_reach()
{
    return int(ceil(0.5 * u_line_width + 0.75));
}

/* Of the farthest of the floods' steps, as a power of two: the first one below the reach. */
int flood_exponent()
{
    int exponent = 0, reach = line_reach();
    for (int i = 1; i < 16; i++)
        exponent = (1 << i) < reach ? i : exponent;
    return exponent;
}
