/* Tiles of the page as quads; those that have nothing are moved out of sight, which costs least. */
layout(location = 0) in vec4 a_tile;

void main()
{
    vec2 corner = a_tile.xy + vec2(float(gl_VertexID & 1), float(gl_VertexID >> 1 & 1));
    vec2 position = 2.0 * min(corner * float(TILE_PIXELS), u_size) * u_texel - 1.0;
    gl_Position = texelFetch(TILES, ivec2(a_tile.xy), 0).r > 0.0 ? vec4(position, 0.0, 1.0) : vec4(0.0, 0.0, 2.0, 1.0);
}
