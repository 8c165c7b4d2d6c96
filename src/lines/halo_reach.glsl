/* Lengths that the passes of haloed lines share. */

/* How far from an outline's pixel its own ink goes as it was found, two pixels wide, and farther lines are taken away: both are as wide as they are to be afterwards. */
float own_reach()
{
    return 1.0;
}

float halo_reach()
{
    return u_line_halo + u_line_width;
}
