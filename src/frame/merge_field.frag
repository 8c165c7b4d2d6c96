/* A figure's field, where no figure before has one. */
uniform sampler2D t_before, t_field;
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    vec3 before = texelFetch(t_before, at, 0).xyz;
    out_0 = vec4(before == vec3(0.0) ? texelFetch(t_field, at, 0).xyz : before, 0.0);
}
