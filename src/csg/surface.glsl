/* Where geometry of a solid comes from: a picture of the surface that the evaluation found, instead of triangles. */
#include "csg/depth.glsl"

uniform usampler2D t_surfaces; /* (any), depth, key, normal; all 0 where there is none */
uniform sampler2D  t_operands; /* two texels each: colour; part, index of a cut face, whether it is one */
uniform vec2 u_solid_size;     /* of the page */
uniform vec4 u_solid_highlight;      /* colour instead of the operands', where alpha is not 0 */

vec3 v_eye;
vec3 v_normal;
bool surface_front;
float surface_depth;
vec4 surface_albedo;
bool surface_is_cut;
uint surface_operand; /* bits of the surface id */

/* False where this part has no surface. */
bool fetch_surface(uint part)
{
    uvec4 surface = texelFetch(t_surfaces, ivec2(gl_FragCoord.xy), 0);
    if (surface.z == 0u)
        return false;
    int operand = int(surface.z >> 16 & 0x3FFFu) - 1;
    ivec2 position = ivec2(2 * (operand & 511), operand >> 9);
    vec4 facts = texelFetch(t_operands, position + ivec2(1, 0), 0);
    if (uint(facts.x) != part)
        return false;
    surface_albedo = u_solid_highlight.a > 0.0 ? u_solid_highlight : texelFetch(t_operands, position, 0);
    surface_is_cut = facts.z > 0.5;
    surface_operand = surface_is_cut ? SURFACE_CUT | uint(facts.y) : SURFACE_OPERAND | (surface.z >> 16 & 0x3FFFu);
    float depth = eye_depth_of(surface.y);
    surface_depth = clamp(window_depth_at(depth), 0.0, 1.0);
    surface_front = (surface.z & 0x80000000u) != 0u;
    bool taken_away = surface_front != ((surface.z & 0x40000000u) != 0u);
    vec2 flat_normal = vec2(surface.w & 0xFFFFu, surface.w >> 16) / 32767.0 - 1.0;
    v_normal = vec3(flat_normal, 1.0 - abs(flat_normal.x) - abs(flat_normal.y));
    float under = max(-v_normal.z, 0.0);
    v_normal.x += v_normal.x < 0.0 ? under : -under;
    v_normal.y += v_normal.y < 0.0 ? under : -under;
    v_normal = normalize(v_normal) * (taken_away ? -1.0 : 1.0);
    vec2 across = (2.0 * gl_FragCoord.xy / u_solid_size - 1.0) * u_unproject;
    v_eye = vec3(across * (u_perspective > 0.5 ? depth : 1.0), -depth);
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
