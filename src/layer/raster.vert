/* Geometry to eye space. */
layout(location = 0) in vec3 a_position;
layout(location = 1) in vec3 a_normal;
layout(location = 2) in vec2 a_uv0;
layout(location = 3) in vec2 a_uv1;
layout(location = 4) in vec4 a_colour;
#ifdef HAS_FIELD
layout(location = 6) in vec3 a_field_diagonal; /* a symmetric tensor: xx, yy, zz */
layout(location = 7) in vec3 a_field_sides;    /* xy, yz, zx */
out vec3 v_field_diagonal; /* eye space */
out vec3 v_field_sides;
#endif
#ifdef HAS_PATCHES
layout(location = 8) in vec4 a_patch; /* src/field/lapped.h */
out vec4 v_patch;
#endif

#ifdef HAS_WALLS
layout(location = 8) in vec4 a_wall; /* src/stage/upload_walls.c */
out vec4 v_wall;
#endif

#ifdef HAS_FACTS
/* What is known of the part, by its mesh's key: src/frame/facts.c. */
layout(location = 5) in uint a_key;
uniform sampler2D t_facts;
flat out vec4  v_own_colour;
flat out uvec3 v_own; /* part, storeys, use */
#endif

#ifdef HAS_REST
layout(location = 9) in vec3 a_rest;
out vec3 v_rest;
#endif

#ifdef PAST_STEPS
#include "layer/past.glsl"
#endif

#ifdef CUT_FACE
uniform float u_nearer; /* in clip space */
#endif
#ifdef ENLARGED
/* Nienhaus 2005, section 6.7, "enlarging the geometry": as wide on the page at any distance. */
uniform float u_enlarge; /* length at distance 1 */
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
#ifdef SHELL
    v_eye = eye.xyz;
    /* Across the page alone, whatever the normal's slant: lines are as wide as they are, and a face that looks away only comes to lie farther behind. */
    eye.xy += v_normal.xy / max(length(v_normal.xy), 1e-12) * (u_enlarge * mix(1.0, -eye.z, u_perspective));
#else
#ifdef ENLARGED
    eye.xyz += normalize(v_normal + vec3(0.0, 0.0, 1e-12)) * (u_enlarge * mix(1.0, -eye.z, u_perspective));
#endif
    v_eye = eye.xyz;
#endif
#ifdef HAS_UV
    v_uv0 = a_uv0;
    v_uv1 = a_uv1;
#endif
#ifdef HAS_COLOURS
    v_colour = a_colour;
#endif
#ifdef HAS_FIELD
    mat3 turn = mat3(u_model_view);
    mat3 field = mat3(a_field_diagonal.x, a_field_sides.x, a_field_sides.z, a_field_sides.x, a_field_diagonal.y, a_field_sides.y,
                      a_field_sides.z, a_field_sides.y, a_field_diagonal.z);
    field = turn * field * transpose(turn) / pow(abs(determinant(turn)) + 1e-30, 2.0 / 3.0);
    v_field_diagonal = vec3(field[0].x, field[1].y, field[2].z);
    v_field_sides = vec3(field[0].y, field[1].z, field[2].x);
#endif
#ifdef HAS_PATCHES
    v_patch = a_patch;
#endif
#ifdef HAS_WALLS
    v_wall = a_wall;
#endif
#ifdef HAS_REST
    v_rest = a_rest;
#endif
#ifdef HAS_FACTS
    ivec2 at = ivec2(int(a_key & 1023u) * 2, int(a_key >> 10));
    v_own_colour = texelFetch(t_facts, at, 0);
    v_own = uvec3(texelFetch(t_facts, at + ivec2(1, 0), 0).xyz);
#endif
    gl_Position = u_projection * eye;
#ifdef PAST_STEPS
    find_past();
#endif
#ifdef UNWRAPPED
#ifdef HAS_UV1
    gl_Position = vec4(2.0 * a_uv1 - 1.0, 0.0, 1.0);
#else
    gl_Position = vec4(2.0 * a_uv0 - 1.0, 0.0, 1.0);
#endif
#endif
#ifdef CUT_FACE
    gl_Position.z -= u_nearer * gl_Position.w;
#endif
}
