/* Geometry to eye space. */
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_uv0;
layout(location = 3) in vec2 a_uv1;
layout(location = 4) in vec4 a_colour;

uniform mat4 u_model_view;
uniform mat3 u_normal_matrix;
uniform mat4 u_projection;
#ifdef CUT_FACE
uniform float u_nearer; /* in clip space */
#endif
#ifdef ENLARGED
/* Seed 000, section 6.7, "enlarging the geometry": as wide on the page at any distance. */
uniform float u_enlarge; /* length at distance 1 */
uniform float u_perspective;
#endif

#ifdef LAYERED
/* Every pass must find the same depth: layers are told apart by it. */
invariant gl_Position;
#endif

out vec3 v_eye;
out vec3 v_normal;
#ifdef HAS_UV
out vec2 v_uv0;
out vec2 v_uv1;
#endif
#ifdef HAS_COLOURS
out vec4 v_colour;
#endif

void main()
{
    vec4 eye = u_model_view * vec4(a_position, 1.0);
    v_normal = u_normal_matrix * a_normal;
#ifdef ENLARGED
    eye.xyz += normalize(v_normal + vec3(0.0, 0.0, 1e-12)) * (u_enlarge * mix(1.0, -eye.z, u_perspective));
#endif
    v_eye = eye.xyz;
#ifdef HAS_UV
    v_uv0 = a_uv0;
    v_uv1 = a_uv1;
#endif
#ifdef HAS_COLOURS
    v_colour = a_colour;
#endif
    gl_Position = u_projection * eye;
#ifdef CUT_FACE
    gl_Position.z -= u_nearer * gl_Position.w;
#endif
}
