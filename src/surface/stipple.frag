/* A dot, cut off where another surface begins. */

flat in vec4 v_dot;
flat in vec2 v_at;

layout(location = 0) out vec4 out_shade;

void main()
{
    float depth = texelFetch(t_normal_depth, ivec2(gl_FragCoord.xy), 0).w;
    float cover = clamp(v_dot.x + 0.5 - length(gl_FragCoord.xy - v_at), 0.0, 1.0) * v_dot.y;
    cover *= step(v_dot.z, depth) * step(depth, v_dot.w);
    out_shade = vec4(u_ink.rgb, 1.0) * (u_ink.a * cover);
}
