/* Vertices as they were at a moment: on the way between two positions in clip space, which is straight in space. */
layout(location = 0) in vec3 a_position;
#ifdef HAS_PAST
layout(location = PAST_LOCATION) in vec3 a_past;
#else
#define a_past a_position
#endif
uniform float u_ago; /* fraction of the exposure */
out vec4 v_now;      /* clip space */

void main()
{
    v_now = u_projection * u_model_view * vec4(a_position, 1.0);
    gl_Position = mix(v_now, u_past_1 * vec4(a_past, 1.0), u_ago);
}
