/* Orders what lies at the same depth: by part, then front faces before back faces. */
uint order_of(uvec2 id)
{
    return id.r << 1 | ((id.g & SURFACE_BACK) != 0u ? 1u : 0u);
}
