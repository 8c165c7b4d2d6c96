/* Ink where the light on one surface differs across the pixel. Both ends must face the light and lie in one surface: where a shape turns away from the light,
 * or another begins, is a matter for other operators. */
#define OWN_WIDTH
#include "lines/edge/edge.glsl"
#include "light/shadow.glsl"

uniform vec3 u_shadow_light; /* towards the light, eye space */

const float UNKNOWN = -1.0;

struct shadow_position {
    vec3 eye, normal;
};

shadow_position position_at(ivec2 at)
{
    vec4 normal_depth = texel(t_normal_depth, at);
    vec3 eye = vec3((2.0 * (vec2(at) + 0.5) / u_size - 1.0) * u_unproject * (u_perspective > 0.5 ? normal_depth.w : 1.0), -normal_depth.w);
    vec3 viewer = u_perspective > 0.5 ? -normalize(eye) : vec3(0.0, 0.0, 1.0);
    /* Sheets seen from behind turn around; rims of smooth shapes, where normals tip a little too far, do not. */
    return shadow_position(eye, normal_depth.xyz * (dot(normal_depth.xyz, viewer) < -0.25 ? -1.0 : 1.0));
}

/* 1: faces the light well; 0: hardly or not, or nothing is there. Near the terminator a coarse shape shadows itself. */
float facing_light(shadow_position p)
{
    return -p.eye.z < u_far ? smoothstep(0.05, 0.2, dot(p.normal, u_shadow_light)) : 0.0;
}

#ifdef HAS_SHADOW
/* The light at a pixel beside, UNKNOWN where that is another surface. */
float lit_beside(shadow_position own, vec2 off)
{
    shadow_position other = position_at(ivec2(gl_FragCoord.xy) + ivec2(floor(off + 0.5)));
    vec3 apart = other.eye - own.eye;
    float most = 0.35 * length(apart) + 1e-6 * abs(own.eye.z);
    bool same = dot(own.normal, other.normal) > 0.8 && abs(dot(own.normal, apart)) < most && abs(dot(other.normal, apart)) < most;
    return same && dot(other.normal, u_shadow_light) > 0.05 ? lit_fraction(other.eye, other.normal, other.normal, u_shadow_light) : UNKNOWN;
}

float step_between(float a, float b)
{
    return a == UNKNOWN || b == UNKNOWN ? 0.0 : abs(a - b);
}
#endif

void detect_edges()
{
    float ink = 0.0;
#ifdef HAS_SHADOW
    shadow_position own = position_at(ivec2(gl_FragCoord.xy));
    float off = 0.5 * min(u_line_width, 2.0);
    ink = max(step_between(lit_beside(own, vec2(-off, off)), lit_beside(own, vec2(off, -off))),
              step_between(lit_beside(own, vec2(off, off)), lit_beside(own, vec2(-off, -off)))) * facing_light(own);
#endif
    write_edges(1.0, 1.0 - ink, 1.0);
}
