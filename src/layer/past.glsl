/* Where vertices were at the PAST_STEPS steps of the past, in clip space. What is bent has its vertices then; all else moves as a whole. */
#ifdef HAS_PAST
layout(location = PAST_1_LOCATION) in vec3 a_past_1;
#if PAST_STEPS > 1
layout(location = PAST_2_LOCATION) in vec3 a_past_2;
#endif
#if PAST_STEPS > 2
layout(location = PAST_3_LOCATION) in vec3 a_past_3;
#endif
#if PAST_STEPS > 3
layout(location = PAST_4_LOCATION) in vec3 a_past_4;
#endif
#else
#define a_past_1 a_position
#define a_past_2 a_position
#define a_past_3 a_position
#define a_past_4 a_position
#endif
out vec4 v_past_1;
#if PAST_STEPS > 1
out vec4 v_past_2;
#endif
#if PAST_STEPS > 2
out vec4 v_past_3;
#endif
#if PAST_STEPS > 3
out vec4 v_past_4;
#endif

void find_past()
{
    v_past_1 = u_past_1 * vec4(a_past_1, 1.0);
#if PAST_STEPS > 1
    v_past_2 = u_past_2 * vec4(a_past_2, 1.0);
#endif
#if PAST_STEPS > 2
    v_past_3 = u_past_3 * vec4(a_past_3, 1.0);
#endif
#if PAST_STEPS > 3
    v_past_4 = u_past_4 * vec4(a_past_4, 1.0);
#endif
}
