/* Lengths that the passes of haloed lines share. */

/* How far from an outline's pixel its own ink goes, and farther lines are taken away: growing makes both wider afterwards. */
float own_reach()
{
    return clamp(u_line_width - 1.0, 0.0, 1.0);
}

float halo_reach()
{
    return u_line_halo + own_reach() + max(u_line_width - 2.0, 0.0);
}
