/* How much of the key light reaches a position: its depth as the light sees it against what is nearest there. Nothing where there is no shadow map. */
#ifdef HAS_SHADOW
uniform mat4 u_shadow_from_eye;  /* to 0 … 1 in all three */
uniform vec2 u_shadow_texel;     /* side of a texel: of the map, and in eye space */

/* One comparison, for the few positions that nothing better is known of. */
float lit_once(vec3 eye, vec3 normal)
{
    vec3 at = (u_shadow_from_eye * vec4(eye + normal * (1.5 * u_shadow_texel.y), 1.0)).xyz;
    return step(at.z, texelFetch(t_shadow, clamp(ivec2(at.xy / u_shadow_texel.x), ivec2(0), textureSize(t_shadow, 0) - 1), 0).r);
}

/* Four comparisons, mixed as a filter would mix them: the border of a shadow is one texel wide. */
float lit_fraction(vec3 eye, vec3 normal, vec3 light)
{
    /* Off the surface by as much as a texel of it can rise. */
    float slope = sqrt(max(1.0 - dot(normal, light) * dot(normal, light), 0.0));
    vec3 at = (u_shadow_from_eye * vec4(eye + normal * (u_shadow_texel.y * (0.5 + 1.5 * slope)), 1.0)).xyz;
    vec2 texel = at.xy / u_shadow_texel.x - 0.5, low = floor(texel), fraction = texel - low;
    ivec2 position = ivec2(low), last = textureSize(t_shadow, 0) - 1;
    vec4 nearest = vec4(texelFetch(t_shadow, clamp(position, ivec2(0), last), 0).r, texelFetch(t_shadow, clamp(position + ivec2(1, 0), ivec2(0), last), 0).r,
                        texelFetch(t_shadow, clamp(position + ivec2(0, 1), ivec2(0), last), 0).r, texelFetch(t_shadow, clamp(position + 1, ivec2(0), last), 0).r);
    vec4 lit = step(vec4(min(at.z, 1.0)), nearest); /* beyond all that throws shadows, where nothing is nothing is in the way */
    return mix(mix(lit.x, lit.y, fraction.x), mix(lit.z, lit.w, fraction.x), fraction.y);
}
#endif
