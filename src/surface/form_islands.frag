/* What normals over a length on paper begin with: those of a texel's pixel, and the light that a hard shadow leaves. Dents and bosses that are small on paper in both directions
 * have no tone of their own: where something turned otherwise lies near all around, and most of it belongs to the same part, its normal is taken. */
#include "light/light.glsl"
#include "light/face.glsl"

layout(location = 0) out vec4 out_form;

const float LARGEST = 14.0; /* of an island, 1/96 inch */
const int   WAYS = 12, STEPS = 4;

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy), pixel = 2 * texel, last = ivec2(u_size) - 1;
    uvec2 id = texelFetch(t_id, pixel, 0).rg;
    vec4  found = texelFetch(t_normal_depth, pixel, 0);
    vec3  plane = (id.g & SURFACE_TURNED) != 0u ? -found.xyz : found.xyz, eye = eye_of(vec2(pixel) + 0.5, found.w), around = vec3(0.0);
    float largest = min(LARGEST * page_unit(), u_smoothing), beside = 0.0, open = id.r == 0u ? 1.0 : 0.0;
    for (int way = 0; way < WAYS && open < 0.5; way++) {
        float angle = 6.2831853 * float(way) / float(WAYS), ended = 0.0;
        vec2  towards = largest * vec2(cos(angle), sin(angle));
        for (int k = 1; k <= STEPS && ended < 0.5; k++) {
            ivec2 at = pixel + ivec2(towards * (float(k) / float(STEPS)));
            ivec2 inside = clamp(at, ivec2(0), last);
            uvec2 other = texelFetch(t_id, inside, 0).rg;
            vec3  normal = texelFetch(t_normal_depth, inside, 0).xyz;
            normal = (other.g & SURFACE_TURNED) != 0u ? -normal : normal;
            bool  same = other.r == id.r && inside == at;
            ended = !same || dot(normal, plane) < 0.85 ? 1.0 : 0.0;
            beside += same ? ended : 0.0;
            around += same ? ended * normal : vec3(0.0);
        }
        open += 1.0 - ended;
    }
    bool island = open < 0.5 && beside > 0.7 * float(WAYS) && length(around) > 0.5 * beside;
    out_form = id.r == 0u ? vec4(0.0, 0.0, 1.0, 0.0) : vec4(island ? normalize(around) : plane, unshadowed(surface_point(eye, plane, face_of(eye, plane, pixel), vec4(1.0), false, id.r)));
}
