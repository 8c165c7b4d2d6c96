/* One step of spreading the shadow on the ground: 1 2 1 both ways, of variance ½. */
uniform sampler2D t_slab;
layout(location = 0) out vec4 out_shade;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(t_slab, 0) - 1;
    float sum = 0.0;
    for (int y = -1; y <= 1; y++)
        for (int x = -1; x <= 1; x++)
            sum += texelFetch(t_slab, clamp(pixel + ivec2(x, y), ivec2(0), last), 0).r * float((2 - abs(x)) * (2 - abs(y)));
    out_shade = vec4(sum / 16.0, 0.0, 0.0, 1.0);
}
