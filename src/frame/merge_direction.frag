/* Directions of strokes, which are known for blocks of pixels, at each pixel. */
uniform sampler2D t_direction;
layout(location = 0) out vec4 out_0;

void main()
{
    vec4 direction = texelFetch(t_direction, ivec2(gl_FragCoord.xy) / DIRECTION_APART, 0);
    if (!(direction.a > 0.0))
        discard;
    out_0 = vec4(direction.xy, 0.0, 0.0);
}
