/* How far what sweeps this pixel moves, wherever on its path the pixel lies. Divided here: positions on the page do not change evenly along a surface. */
layout(location = 0) out vec4 out_stretched;
in vec4 v_now;
in vec4 v_past;
uniform uint u_part_id;

void main()
{
    bool seen = v_now.w > 0.0 && v_past.w > 0.0;
    vec2 moved = seen ? 0.5 * u_size * (v_now.xy / v_now.w - v_past.xy / v_past.w) : vec2(0.0);
    out_stretched = vec4(moved, gl_FragCoord.z, float(u_part_id));
}
