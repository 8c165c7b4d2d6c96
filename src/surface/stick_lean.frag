/* Faces that look to the right have their strokes turned one way, those that look to the left the other way: neighbours tell apart, and either way runs with the
 * lines that recede there. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec4 own = texelFetch(t_direction, texel, 0);
    vec3 normal = texelFetch(t_normal_depth, min(texel * DIRECTION_APART + DIRECTION_APART / 2, ivec2(u_size) - 1), 0).xyz;
    float turn = -2.0 * u_lean * 0.017453293 * clamp(2.0 * normal.x, -1.0, 1.0);
    vec2 way = vec2(cos(turn), sin(turn));
    out_0 = vec4(own.x * way.x - own.y * way.y, own.x * way.y + own.y * way.x, own.zw);
}
