/* How much of a pixel of the ground lies in the first light's shadow, and whether what throws it is near the ground (g); and that over a length on paper (CALMED, one round:
 * surface/form.frag), of which the half is the border (SHARPENED). */
#include "light/ground_plane.glsl"
#include "light/shadow.glsl"

uniform sampler2D t_ground_dark; /* so far */
uniform vec3      u_shadow_light;
uniform float     u_shadow_depth; /* of the map, file units */
uniform float     u_contact;      /* how near, file units */
uniform float     u_smoothing;    /* pixels */
layout(location = 0) out vec4 out_dark;

vec4 dark_at(ivec2 pixel)
{
    return texelFetch(t_ground_dark, clamp(pixel, ivec2(0), ivec2(u_size) - 1), 0);
}

/* Pixels further away from round to round and then nearer again. */
vec4 calmed(ivec2 pixel)
{
    float widest = max(ceil(log2(max(0.44 * u_smoothing, 1e-6)) * 0.7564708), 1.0) - 1.0;
    int   apart = int(max(floor(0.44 * u_smoothing * pow(2.5, -abs(float(u_iteration) - widest)) + 0.5), 1.0));
    ivec2 first = float(u_iteration) <= widest ? ivec2(apart, apart) : ivec2(apart, 0), second = ivec2(-first.y, first.x);
    return (dark_at(pixel) * 2.0 + dark_at(pixel + first) + dark_at(pixel - first) + dark_at(pixel + second) + dark_at(pixel - second)) / 6.0;
}

/* The border is where it is half dark, and a pixel wide. */
vec4 sharpened(ivec2 pixel)
{
    vec4 own = dark_at(pixel);
    vec2 slope = 0.5 * vec2(dark_at(pixel + ivec2(1, 0)).r - dark_at(pixel - ivec2(1, 0)).r, dark_at(pixel + ivec2(0, 1)).r - dark_at(pixel - ivec2(0, 1)).r);
    return vec4(clamp((own.r - 0.5) / max(length(slope), 0.01) + 0.5, 0.0, 1.0), step(0.5, own.g), 0.0, 1.0);
}

vec4 cast_on(vec4 eye)
{
    vec3  at = (u_shadow_from_eye * vec4(eye.xyz, 1.0)).xyz;
    float nearest = texelFetch(t_shadow, clamp(ivec2(at.xy / u_shadow_texel.x), ivec2(0), textureSize(t_shadow, 0) - 1), 0).r;
    float dark = eye.w > 0.0 ? 1.0 - lit_fraction(eye.xyz, u_ground_plane.xyz, u_ground_plane.xyz, u_shadow_light) : 0.0;
    return vec4(dark, dark > 0.5 && nearest < at.z && (at.z - nearest) * u_shadow_depth < u_contact ? 1.0 : 0.0, 0.0, 1.0);
}

void main()
{
#if defined(CALMED)
    out_dark = calmed(ivec2(gl_FragCoord.xy));
#elif defined(SHARPENED)
    out_dark = sharpened(ivec2(gl_FragCoord.xy));
#else
    out_dark = cast_on(on_ground(gl_FragCoord.xy));
#endif
}
