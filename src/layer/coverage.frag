/* Counts a block of pixels: x = covered by the layer, y = where what is to be uncovered is not behind the layer any more,
 * z = covered by what is to be uncovered. */
uniform sampler2D t_depth;
#ifdef HAS_MASK
uniform sampler2D t_mask;
#endif
uniform vec2 u_first; /* of the pixels that are counted */
uniform vec2 u_end;
uniform float u_block;
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 corner = ivec2(u_first) + ivec2(gl_FragCoord.xy) * int(u_block), end = min(corner + int(u_block), ivec2(u_end));
    vec4 sum = vec4(0.0);
    for (int y = corner.y; y < end.y; y++)
        for (int x = corner.x; x < end.x; x++) {
            float depth = texelFetch(t_depth, ivec2(x, y), 0).r;
            sum.x += depth < 1.0 ? 1.0 : 0.0;
#ifdef HAS_MASK
            float mask = texelFetch(t_mask, ivec2(x, y), 0).r;
            sum.y += mask < 1.0 && mask <= depth ? 1.0 : 0.0;
            sum.z += mask < 1.0 ? 1.0 : 0.0;
#endif
        }
    out_0 = sum;
}
