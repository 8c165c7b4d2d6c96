/* One step of spreading the shadow on the ground: 1 2 1 both ways, of variance ½, as four means of four. */
uniform sampler2D t_slab;
layout(location = 0) out vec4 out_shade;

void main()
{
    vec2 texel = 1.0 / vec2(textureSize(t_slab, 0)), low = (gl_FragCoord.xy - 0.5) * texel, high = (gl_FragCoord.xy + 0.5) * texel;
    vec2 sum = texture(t_slab, low).rg + texture(t_slab, vec2(high.x, low.y)).rg + texture(t_slab, vec2(low.x, high.y)).rg + texture(t_slab, high).rg;
    out_shade = vec4(0.25 * sum, 0.0, 1.0);
}
