/* Where geometry of a solid comes from: a picture of the surface that the evaluation found, instead of triangles. */
uniform usampler2D t_surfaces; /* (any), depth, key, normal; all 0 where there is none */
uniform sampler2D  t_operands; /* two texels each: colour; part */
uniform vec4 u_solid_depth;    /* what u_window_depth is elsewhere */
uniform vec2 u_solid_size;     /* of the page */
#ifdef ENLARGED
uniform mat4 u_projection;
#endif
uniform vec4 u_highlight;      /* colour instead of the operands', where alpha is not 0 */

vec3 v_eye;
vec3 v_normal;
bool surface_front;
float surface_depth;
vec4 surface_albedo;
uint surface_operand; /* bits of the surface id */

/* False where this part has no surface. */
bool fetch_surface(uint part)
{
    uvec4 surface = texelFetch(t_surfaces, ivec2(gl_FragCoord.xy), 0);
    if (surface.z == 0u)
        return false;
    int operand = int(surface.z >> 16 & 0x7FFFu) - 1;
    ivec2 place = ivec2(2 * (operand & 511), operand >> 9);
    vec4 facts = texelFetch(t_operands, place + ivec2(1, 0), 0);
    if (uint(facts.x) != part)
        return false;
    surface_albedo = u_highlight.a > 0.0 ? u_highlight : texelFetch(t_operands, place, 0);
    surface_operand = SURFACE_OPERAND | (surface.z >> 16 & 0x7FFFu);
    surface_depth = uintBitsToFloat(surface.y);
    bool taken_away = (surface.z & 0x80000000u) == 0u;
    surface_front = ((surface.z & 1u) == 0u) != taken_away;
    vec2 flat_normal = vec2(surface.w & 0xFFFFu, surface.w >> 16) / 32767.0 - 1.0;
    v_normal = vec3(flat_normal, 1.0 - abs(flat_normal.x) - abs(flat_normal.y));
    float under = max(-v_normal.z, 0.0);
    v_normal.x += v_normal.x < 0.0 ? under : -under;
    v_normal.y += v_normal.y < 0.0 ? under : -under;
    v_normal = normalize(v_normal) * (taken_away ? -1.0 : 1.0);
    float ndc = 2.0 * surface_depth - 1.0;
    /* z of the eye from (x z + y) / (z' z + w) */
    float z = (u_solid_depth.w * ndc - u_solid_depth.y) / (u_solid_depth.x - u_solid_depth.z * ndc);
    vec2 across = (2.0 * gl_FragCoord.xy / u_solid_size - 1.0) * u_unproject;
    v_eye = vec3(across * (u_perspective > 0.5 ? -z : 1.0), z);
#ifdef ENLARGED
    /* Drawn with wider clip planes than it was found with. */
    vec4 clip = u_projection * vec4(v_eye, 1.0);
    surface_depth = clip.z / clip.w * 0.5 + 0.5;
#endif
    return true;
}

vec4 model_colour()
{
    return surface_albedo;
}

vec3 model_normal()
{
    return v_normal;
}
