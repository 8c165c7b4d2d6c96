/* Vertices ahead of the motion where they are, all others where they were. Großmann 2011, section 4.5.5. */
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
#ifdef HAS_PAST
layout(location = PAST_LOCATION) in vec3 a_past;
#else
#define a_past a_position
#endif
out vec4 v_now; /* clip space */
out vec4 v_past;

void main()
{
    vec4 eye = u_model_view * vec4(a_position, 1.0), was = u_past_2 * vec4(a_past, 1.0);
    v_now = u_projection * eye;
    v_past = u_past_1 * vec4(a_past, 1.0);
    gl_Position = dot(u_normal_matrix * a_normal, eye.xyz - was.xyz) > 0.0 ? v_now : v_past;
}
