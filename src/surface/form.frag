/* Normals over a length on paper at each pixel, from those of the four texels around that see the same of the same part; what none of these sees has its own. */
#include "light/light.glsl"
#include "light/face.glsl"

layout(location = 0) out vec4 out_form;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = (ivec2(u_size) - 1) / 2, low = pixel / 2;
    uvec2 id = texelFetch(t_id, pixel, 0).rg;
    vec4  found = texelFetch(t_normal_depth, pixel, 0), sum = vec4(0.0);
    vec3  plane = found.xyz, eye = eye_of(gl_FragCoord.xy, found.w);
    vec2  part = 0.5 * vec2(pixel & 1);
    float known = 0.0;
    for (int k = 0; k < 4; k++) {
        ivec2 step = ivec2(k & 1, k >> 1), texel = min(low + step, last);
        uvec2 other = texelFetch(t_id, 2 * texel, 0).rg;
        vec4  seen = texelFetch(t_normal_depth, 2 * texel, 0);
        vec3  away = eye_of(2.0 * vec2(texel) + 0.5, seen.w) - eye;
        vec2  share = mix(1.0 - part, part, vec2(step));
        float aside = dot(plane, away), far = dot(away, away);
        float alike = smoothstep(0.8, 0.9, dot(seen.xyz, plane)) * (1.0 - smoothstep(0.42, 0.81, aside * aside / max(far, 1e-24)));
        alike *= other.r == id.r ? share.x * share.y + 1e-3 : 0.0;
        sum += alike * texelFetch(t_form_half, texel, 0);
        known += alike;
    }
    /* A loop is left, where a condition would be computed both ways. */
    int alone = id.r != 0u && known < 1e-4 ? 1 : 0;
    for (int once = 0; once < alone; once++) {
        plane = (id.g & SURFACE_TURNED) != 0u ? -plane : plane;
        sum = vec4(plane, unshadowed(surface_point(eye, plane, face_of(eye, plane, pixel), vec4(1.0), false, id.r)));
        known = 1.0;
    }
    out_form = id.r == 0u ? vec4(0.0, 0.0, 1.0, 0.0) : vec4(normalize(sum.xyz), sum.w / known);
}
