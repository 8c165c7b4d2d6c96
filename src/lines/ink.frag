/* Inks one of several line techniques onto the shade map; the last one is inked by the composition itself. */
#include "lines/ink.glsl"
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    out_0 = over(ink_at(vec2(pixel)), texelFetch(t_shade, pixel, 0));
}
