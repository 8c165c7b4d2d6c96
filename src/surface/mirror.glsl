#include "light/light.glsl"

/* The mirrored scene was drawn with the same projection, so it is looked up at the same pixel. A mirror seen in a mirror, or
 * through, reflects nothing. */
vec4 surface_colour(surface_point p)
{
#ifdef HAS_REFLECTION
    vec4 seen = texture(t_reflection, gl_FragCoord.xy / u_size);
#else
    vec4 seen = vec4(0.0);
#endif
    vec3 reflected = seen.rgb + u_tint.rgb * (1.0 - seen.a);
    return vec4(mix(shown(light_shown_as(u_tint.rgb) * p.albedo.rgb), reflected, u_reflectivity), 1.0);
}
