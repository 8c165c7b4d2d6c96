/* How much of a pixel of the ground lies in the first light's shadow, and whether what throws it is near the ground (g); b: how much with a border that may be softer. */
#include "light/ground_plane.glsl"
#include "light/shadow.glsl"

uniform vec3  u_shadow_light;
uniform float u_shadow_depth; /* of the map, file units */
uniform float u_contact;      /* how near, file units */
layout(location = 0) out vec4 out_dark;

void main()
{
    vec4  eye = on_ground(gl_FragCoord.xy);
    vec3  at = (u_shadow_from_eye * vec4(eye.xyz, 1.0)).xyz;
    float nearest = texelFetch(t_shadow, clamp(ivec2(at.xy / u_shadow_texel.x), ivec2(0), textureSize(t_shadow, 0) - 1), 0).r;
    float dark = eye.w > 0.0 ? 1.0 - lit_fraction(eye.xyz, u_ground_plane.xyz, u_ground_plane.xyz, u_shadow_light) : 0.0;
    out_dark = vec4(dark, dark > 0.5 && nearest < at.z && (at.z - nearest) * u_shadow_depth < u_contact ? 1.0 : 0.0, dark, 1.0);
}
