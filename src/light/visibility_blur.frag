/* One row or column of the average over the pattern's period; the two outermost of five samples are a period apart and share one weight. Only samples of
 * the surface count, and for shadows only those inside the penumbra, so that what is sharp stays so. */
#include "light/visibility.glsl"

uniform sampler2D t_fraction;
uniform sampler2D t_normals;
uniform vec2      u_along; /* (1, 0) or (0, 1) */
layout(location = 0) out vec4 out_fraction;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), direction = ivec2(u_along), last = textureSize(t_fraction, 0) - 1;
    vec4 own = texelFetch(t_fraction, pixel, 0);
    out_fraction = own;
    int full = own.z > 0.0 ? 1 : 0;
    for (int once = 0; once < full; once++) {
        vec3 normal = texelFetch(t_normals, pixel, 0).xyz;
        float level = dot(normal, on_ray(ray_of(gl_FragCoord.xy), own.z)), narrow = 1.0 / pixel_size(own.z);
        vec2 sum = own.xy, weights = vec2(1.0);
        for (int i = -2; i <= 2; i++) {
            if (i == 0)
                continue;
            ivec2 at = pixel + direction * i;
            vec4 other = texelFetch(t_fraction, clamp(at, ivec2(0), last), 0);
            float off = abs(dot(normal, on_ray(ray_of(vec2(at) + 0.5), other.z)) - level) * narrow;
            float weight = clamp(at, ivec2(0), last) == at ? clamp(1.5 - 2.0 * off, 0.0, 1.0) * (abs(i) == 2 ? 0.5 : 1.0) : 0.0;
            float inside = clamp(0.4 * min(own.w, other.w) + 1.0 - float(abs(i)), 0.0, 1.0);
            vec2 both = weight * vec2(inside, 1.0);
            sum += other.xy * both;
            weights += both;
        }
        out_fraction = vec4(sum / weights, own.zw);
    }
}
