/* How far a patch's torn outline is from its middle, in radii: field/lapped_outline.c. `number`: of the patch, a whole one. */
float patch_outline(float angle, float number)
{
    return 0.7 + 0.2 * sin(3.0 * angle + 2.4 * number) + 0.1 * sin(7.0 * angle + 1.7 * number);
}
