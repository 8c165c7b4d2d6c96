/* Lengths that the passes of haloed lines share. */

/* How far from an outline's pixel its own ink goes, and from where on farther lines are there again. */
float own_reach()
{
    return 0.5 * u_line_width;
}

float halo_reach()
{
    /* And what soft rims take away, of broad lines on either side. */
    return u_line_halo + own_reach() + (own_reach() < 1.0 ? 0.15 : 0.3 + 0.2 * min(own_reach(), 2.0));
}
