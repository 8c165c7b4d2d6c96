/* A piece of a stroke. Whether it is hidden is asked at its axis, so that its own surface does not cut its sides off (EX-14). */

flat in vec3 v_normal;
flat in vec4 v_ends, v_depths;
flat in vec3 v_run;
flat in float v_ink;

layout(location = 0) out vec4 out_shade;

uniform float u_depth_alone; /* 1: only where what stands on the surface lies, in depth, is drawn */

/* Pixels by which both pieces reach over where they meet: rounding must leave no gap. */
const float JOINT_SLACK = 1.0 / 512.0;
/* Fraction of a stroke up to which a piece's end is the stroke's own. */
const float TIP = 1e-4;

void main()
{
#if HIDING == 4
    if (v_ink < 0.0)
        discard;
#endif
    vec2 chord = v_ends.zw - v_ends.xy, from = gl_FragCoord.xy - v_ends.xy;
    float square = dot(chord, chord), foot = dot(from, chord) / max(square, 1e-6), along = clamp(foot, 0.0, 1.0);
    vec2 axis = v_ends.xy + along * chord;
    float depth = mix(v_depths.x, v_depths.y, along), tolerance = v_depths.z;
    if (u_perspective > 0.5) {
        depth = 1.0 / depth;
        tolerance *= depth;
    }
    vec4 seen = texelFetch(t_normal_depth, ivec2(clamp(axis, vec2(0.0), u_size - 1.0)), 0);
    float arc = mix(v_run.x, v_run.y, along);
#if PLACED == 3
    float to_end = 0.5 * (1.0 - arc); /* grass has a root */
#else
    float to_end = min(arc, 1.0 - arc);
#endif
    float half_width = v_depths.w * (v_run.z > 0.0 ? clamp(to_end * v_run.z, 0.0, 1.0) : 1.0);
#if PRIMITIVE == 1
    float cover = min(2.0 * half_width, 1.0) * v_ink; /* in the pixels that the hardware chose */
#else
    float cover = clamp(half_width + 0.5 - length(from - along * chord), 0.0, min(2.0 * half_width, 1.0)) * v_ink;
#endif
#if PLACED == 3
    if (u_depth_alone > 0.5 && cover < 0.05)
        discard;
#else
    /* Far from its own depth only what is turned as it is can be its surface. */
    float like = dot(seen.xyz, v_normal);
    cover *= step(abs(seen.w - depth), tolerance * clamp(2.0 * like, 0.15, 1.0));
#endif
#if PRIMITIVE == 0
    /* Where pieces meet, a pixel is of one of them, so that no ink is there twice (EX-26). Ends that do not run out are cut off, too. */
    float slack = JOINT_SLACK * inversesqrt(max(square, 1e-6));
    if (((v_run.x > TIP || v_run.z <= 0.0) && foot < -slack) || ((v_run.y < 1.0 - TIP || v_run.z <= 0.0) && foot > 1.0 + slack))
        cover = 0.0;
#endif
    out_shade = vec4(u_ink.rgb, 1.0) * (u_ink.a * cover);
}
