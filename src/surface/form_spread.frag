/* One round of smoothing normals: of a texel and four others, which lie further away from round to round (Dammertz et al. 2010, "Edge-avoiding à-trous wavelet transform"), at the corners
 * of a square, and then nearer again, to the next, at its sides, so that nothing leaves echoes. All rounds together spread as far as a disc of u_smoothing pixels with weights 1 − d²: variances add up.
 * With them goes the light that a hard shadow leaves, over a shorter way: the half of it is the shadow's border without scraps. A texel stands for two pixels each way. */
#include "light/light.glsl"
#include "light/face.glsl"

layout(location = 0) out vec4 out_form;

const float LIGHT = 0.2; /* how far the light is taken at most in one round, of u_smoothing */

/* What is looked at in a round: a texel, and what there is of its neighbours so far. */
struct round_sum {
    vec4  own, sum;
    vec3  eye, plane;
    uint  part;
    float weights, level;
};

/* Of one part, not across creases and steps of depth. */
void look_at(inout round_sum r, ivec2 at)
{
    ivec2 inside = clamp(at, ivec2(0), (ivec2(u_size) - 1) / 2);
    uvec2 other = texelFetch(t_id, 2 * inside, 0).rg;
    vec4  found = texelFetch(t_normal_depth, 2 * inside, 0);
    found.xyz = (other.g & SURFACE_TURNED) != 0u ? -found.xyz : found.xyz;
#ifdef HAS_FORM_HALF
    vec4 form = texelFetch(t_form_half, inside, 0);
#else
    vec4 form = vec4(found.xyz, 1.0);
#endif
    vec3 away = eye_of(2.0 * vec2(inside) + 0.5, found.w) - r.eye, turned = found.xyz - r.plane;
    float aside = dot(r.own.xyz, away), far = dot(away, away);
    float weight = 0.5 * smoothstep(0.62, 0.8, dot(form.xyz, r.own.xyz)) * (1.0 - smoothstep(0.42, 0.81, aside * aside / max(far, 1e-24)));
    weight = other.r == r.part && inside == at ? weight : 0.0;
    r.sum += weight * form;
    r.weights += weight;
    r.level += dot(turned, turned) < 1e-6 ? weight : 0.0;
}

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy), pixel = 2 * texel;
    uvec2 id = texelFetch(t_id, pixel, 0).rg;
    vec4  found = texelFetch(t_normal_depth, pixel, 0);
    vec3  plane = (id.g & SURFACE_TURNED) != 0u ? -found.xyz : found.xyz, eye = eye_of(vec2(pixel) + 0.5, found.w);
#ifdef HAS_FORM_HALF
    vec4 own = texelFetch(t_form_half, texel, 0);
#else
    vec4 own = vec4(plane, 1.0);
#endif
    float radius = 0.22 * u_smoothing, widest = max(ceil(log2(max(radius, 1e-6)) * 0.6309298), 1.0) - 1.0; /* form_rounds */
    int   apart = int(max(floor(radius * pow(3.0, -abs(float(u_iteration) - widest)) + 0.5), 1.0));
    ivec2 first = float(u_iteration) <= widest ? ivec2(apart, apart) : ivec2(apart, 0), second = ivec2(-first.y, first.x);
    round_sum r = round_sum(own, own, eye, plane, id.r, 1.0, 1.0);
    /* A loop is left where nothing is, where a condition would be computed both ways. */
    int shaded = id.r != 0u ? 1 : 0;
    for (int once = 0; once < shaded; once++) {
        look_at(r, texel + first);
        look_at(r, texel + second);
        look_at(r, texel - first);
        look_at(r, texel - second);
    }
    r.sum /= r.weights;
#ifdef HAS_FORM_HALF
    float light = 2.0 * float(apart) > max(LIGHT * u_smoothing, 2.0) ? own.w : r.sum.w;
#else
    float light = unshadowed(surface_point(eye, plane, face_of(eye, plane, pixel), vec4(1.0), false, id.r));
#endif
    /* A face that is flat stays so up to its edges: what lies beyond does not lean into it. */
    out_form = id.r == 0u ? vec4(0.0, 0.0, 1.0, 0.0) : vec4(normalize(mix(r.sum.xyz, own.xyz, smoothstep(0.36, 0.5, r.level / r.weights))), light);
}
