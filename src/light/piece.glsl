/* What has a border of its own: a part, and each cut face of a part, so that a section's outline is as strong as the part's. */
uint piece_of(uvec2 id)
{
#ifdef HAS_CUT
    if ((id.g & SURFACE_CUT) != 0u)
        return id.r ^ ((id.g & SURFACE_INDEX_MASK) + 1u) * 2654435761u;
#endif
    return id.r;
}
