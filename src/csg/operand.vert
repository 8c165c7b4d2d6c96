/* Triangles of operands to eye space. */
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 5) in uint a_key;

uniform uint u_first_operand;
uniform uint u_first_plane;

/* Every pass must find the same depth. */
invariant gl_Position;

out vec3 v_normal;
out float v_depth; /* of the eye */
flat out uint v_key; /* kept, operand, plane: src/csg/csg.h */

void main()
{
    v_normal = u_normal_matrix * a_normal;
    uint plane = a_key & 0xFFFFu;
    v_key = (a_key & 0xFFFF0000u) + (u_first_operand << 16) + (plane != 0u ? plane + u_first_plane : 0u);
    vec4 eye = u_model_view * vec4(a_position, 1.0);
    v_depth = -eye.z;
    gl_Position = u_projection * eye;
}
