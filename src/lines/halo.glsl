/* What the passes of haloed lines share. An outline is ink at a step of depth, and lies on the nearer side of it. Window depth is affine in
 * screen space on any plane. */
#include "lines/halo_reach.glsl"

uniform float u_near; /* of the figure, eye depth */
uniform float u_far;
uniform vec4  u_window_depth; /* of the projection: what makes window depth of eye depth */

/* Ink of less than this is shading; see lines.c. */
const float LINE_INK = 0.15;
/* A step that separates objects, as a share of the figure's depth range; and what rounding can add up to. */
const float CLEARLY = 0.003;
const float DEPTH_NOISE = 16.0 * 5.96e-8;

float depth_at(vec2 off)
{
    return textureLod(t_depth, (gl_FragCoord.xy + off) * u_texel, 0.0).r;
}

/* How depth grows to one side of a place: the smaller of the differences on either side, as the larger one may lead onto another surface;
 * none where both sides are deeper. */
float slope_of(vec3 place, vec2 side)
{
    float ahead = depth_at(place.xy + side) - place.z, behind = place.z - depth_at(place.xy - side);
    float smaller = abs(ahead) < abs(behind) ? ahead : behind;
    return ahead >= 0.0 && behind <= 0.0 ? 0.0 : smaller;
}

vec2 slope_at(vec3 place)
{
    return vec2(slope_of(place, vec2(1.0, 0.0)), slope_of(place, vec2(0.0, 1.0)));
}

/* A clear step of eye depth, as one of window depth at this one. */
float clear_step(float window)
{
    vec4 m = u_window_depth;
    float at = 2.0 * window - 1.0, depth = (m.y - m.w * at) / (m.x - m.z * at), scale = m.w - m.z * depth;
    return max(0.5 * abs(m.z * m.y - m.x * m.w) / (scale * scale) * CLEARLY * (u_far - u_near), DEPTH_NOISE);
}
