/* How far what is at this pixel has moved on the page since the PAST_STEPS steps of the past. The last one is the whole exposure's. */
#if PAST_STEPS > 1
layout(location = AT_PAST_1) out vec4 out_past_1;
#endif
#if PAST_STEPS > 2
layout(location = AT_PAST_2) out vec4 out_past_2;
#endif
#if PAST_STEPS > 3
layout(location = AT_PAST_3) out vec4 out_past_3;
#endif
#ifndef SOLID
in vec4 v_past_1;
#if PAST_STEPS > 1
in vec4 v_past_2;
#endif
#if PAST_STEPS > 2
in vec4 v_past_3;
#endif
#if PAST_STEPS > 3
in vec4 v_past_4;
#endif
#endif

/* Pixels right and up, window depth then, 1. Divided here: positions on the page do not change evenly along a surface. */
vec4 moved_from(vec4 clip)
{
    vec3 window = 0.5 * (clip.xyz / clip.w + 1.0);
    return clip.w > 0.0 ? vec4(gl_FragCoord.xy - window.xy * u_size, window.z, 1.0) : vec4(0.0, 0.0, gl_FragCoord.z, 1.0);
}

void write_moved(vec3 eye)
{
#ifdef SOLID
    vec4 v_past_1 = u_past_1 * vec4(eye, 1.0);
#if PAST_STEPS > 1
    vec4 v_past_2 = u_past_2 * vec4(eye, 1.0);
#endif
#if PAST_STEPS > 2
    vec4 v_past_3 = u_past_3 * vec4(eye, 1.0);
#endif
#if PAST_STEPS > 3
    vec4 v_past_4 = u_past_4 * vec4(eye, 1.0);
#endif
#endif
#if PAST_STEPS == 1
    out_velocity = moved_from(v_past_1);
#elif PAST_STEPS == 2
    out_past_1 = moved_from(v_past_1);
    out_velocity = moved_from(v_past_2);
#elif PAST_STEPS == 3
    out_past_1 = moved_from(v_past_1);
    out_past_2 = moved_from(v_past_2);
    out_velocity = moved_from(v_past_3);
#else
    out_past_1 = moved_from(v_past_1);
    out_past_2 = moved_from(v_past_2);
    out_past_3 = moved_from(v_past_3);
    out_velocity = moved_from(v_past_4);
#endif
}
