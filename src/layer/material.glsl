/* The model's own colour and normal at a fragment. */
in vec3 v_eye;
in vec3 v_normal;
#ifdef HAS_UV
in vec2 v_uv0;
in vec2 v_uv1;
#endif
#ifdef HAS_COLOURS
in vec4 v_colour;
#endif

#ifdef HAS_FACTS
#define u_base_colour v_own_colour
#else
uniform vec4  u_base_colour;
#endif
uniform float u_alpha_cutoff; /* fragments below are left out */
#ifdef HAS_BASE_TEXTURE
uniform sampler2D t_base;
uniform vec4 u_base_matrix;   /* columns of the 2x2 part */
uniform vec4 u_base_offset;   /* xy offset, z uv set */
#endif
#ifdef HAS_NORMAL_TEXTURE
uniform sampler2D t_normal;
uniform vec4  u_normal_uv_matrix;
uniform vec4  u_normal_uv_offset; /* w: strength */
#endif

#ifdef HAS_UV
vec2 moved_uv(vec4 matrix, vec4 offset)
{
    vec2 uv = offset.z > 0.5 ? v_uv1 : v_uv0;
    return matrix.xy * uv.x + matrix.zw * uv.y + offset.xy;
}
#endif

vec4 model_colour()
{
    vec4 colour = u_base_colour;
#ifdef HAS_COLOURS
    colour *= v_colour;
#endif
#ifdef HAS_BASE_TEXTURE
    colour *= texture(t_base, moved_uv(u_base_matrix, u_base_offset));
#endif
    return colour;
}

/* The surface's normal as it is: outward, unit length. With a normal map the tangent frame comes from the picture's own
 * derivatives, so that no tangents need to be stored. */
vec3 model_normal()
{
    vec3 normal = normalize(v_normal);
#ifdef HAS_NORMAL_TEXTURE
    vec2 uv = moved_uv(u_normal_uv_matrix, u_normal_uv_offset);
    vec3 texel = texture(t_normal, uv).xyz * 2.0 - 1.0;
    texel.xy *= u_normal_uv_offset.w;
    vec3 across = dFdx(v_eye), up = dFdy(v_eye);
    vec2 uv_across = dFdx(uv), uv_up = dFdy(uv);
    vec3 up_normal = cross(up, normal), normal_across = cross(normal, across);
    vec3 tangent = up_normal * uv_across.x + normal_across * uv_up.x;
    vec3 bitangent = up_normal * uv_across.y + normal_across * uv_up.y;
    /* Seen from behind, the picture shows the surface mirrored. */
    float scale = (dot(across, up_normal) < 0.0 ? -1.0 : 1.0) * inversesqrt(max(max(dot(tangent, tangent), dot(bitangent, bitangent)), 1e-30));
    /* glTF's v runs down the picture, so the bitangent of its maps is minus the direction of growing v. */
    normal = normalize(tangent * scale * texel.x - bitangent * scale * texel.y + normal * texel.z);
#endif
    return normal;
}
