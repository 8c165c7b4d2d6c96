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

/* The mean of comparisons over three texels by three, of which a pixel of the page has four by four: the border of a shadow has no steps on the page,
 * and what is finer than a pixel is a tone. */
float lit_fraction(vec3 eye, vec3 normal, vec3 light)
{
    /* Off the surface by as much as it can rise as far away as is looked. */
    float slope = sqrt(max(1.0 - dot(normal, light) * dot(normal, light), 0.0));
    vec3 at = (u_shadow_from_eye * vec4(eye + normal * (u_shadow_texel.y * (0.5 + 2.5 * slope)), 1.0)).xyz;
    vec2 texel = at.xy / u_shadow_texel.x - 0.5, low = floor(texel), fraction = texel - low;
    ivec2 position = ivec2(low) - 1, last = textureSize(t_shadow, 0) - 1;
    float depth = min(at.z, 1.0), sum = 0.0; /* beyond all that throws shadows, where nothing is nothing is in the way */
    vec4 across = vec4(1.0 - fraction.x, 1.0, 1.0, fraction.x), along = vec4(1.0 - fraction.y, 1.0, 1.0, fraction.y);
    for (int row = 0; row < 4; row++) {
        vec4 nearest;
        for (int column = 0; column < 4; column++)
            nearest[column] = texelFetch(t_shadow, clamp(position + ivec2(column, row), ivec2(0), last), 0).r;
        sum += along[row] * dot(step(vec4(depth), nearest), across);
    }
    return sum / 9.0;
}
#endif
