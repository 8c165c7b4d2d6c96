/* Area of a disc, in cells of a square lattice with one on each corner, so that all together cover this much of a cell: above 0.7854 they overlap, and at √2 times the
 * radius at which they touch they cover everything. A power between both ends, within 0.011 of the cover. */
float area_that_covers(float darkness)
{
    float grown = 0.5 + 0.2071 * (1.0 - pow(clamp((1.0 - darkness) / 0.2146, 0.0, 1.0), 0.385));
    return darkness < 0.7854 ? darkness : 3.14159 * grown * grown;
}
