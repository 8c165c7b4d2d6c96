/* What the passes of haloed lines share. An outline is ink at a step of depth, and lies on the nearer side of it. Window depth is affine in
 * screen space on any plane. */
#include "lines/halo_reach.glsl"

/* Ink of less than this is shading; see lines.c. */
const float LINE_INK = 0.15;
/* A step that separates objects, as a fraction of the figure's depth range; and what rounding can add up to. */
const float CLEARLY = 0.005;
/* Slopes of what bends count up to this, in pixels. */
const float STEEP = 24.0;
const float DEPTH_NOISE = 16.0 * 5.96e-8;

float depth_at(vec2 off)
{
    return textureLod(t_depth, (gl_FragCoord.xy + off) * u_texel, 0.0).r;
}

/* Eye depth of a window depth, and how much window depth a unit of eye depth is there. */
vec2 eye_of(float window)
{
    vec4 m = u_window_depth;
    float depth = eye_depth_at_window(min(window, 0.9999999)), scale = m.w - m.z * depth;
    return vec2(depth, 0.5 * abs(m.z * m.y - m.x * m.w) / (scale * scale));
}

/* A clear step of eye depth, as one of window depth at this one. */
float clear_step(float window)
{
    return max(eye_of(window).y * CLEARLY * (u_far - u_near), DEPTH_NOISE);
}

/* How depth grows to one side of a place where it does so evenly on this side or the other: a flat face, whose slope that is exactly. y: to
 * which side, 1 or −1, and 0 where it does not. */
vec2 even_slope(vec3 position, vec2 side)
{
    float right = depth_at(position.xy + side), left = depth_at(position.xy - side);
    float ahead = right - position.z, behind = position.z - left;
    bool ahead_even = abs(depth_at(position.xy + 2.0 * side) - right - ahead) <= 0.002 * abs(ahead) + DEPTH_NOISE;
    bool behind_even = abs(left - depth_at(position.xy - 2.0 * side) - behind) <= 0.002 * abs(behind) + DEPTH_NOISE;
    bool to_right = ahead_even && (!behind_even || abs(ahead) < abs(behind));
    return vec2(to_right ? ahead : behind, to_right ? 1.0 : behind_even ? -1.0 : 0.0);
}

/* How depth grows from pixel to pixel on the plane of what is seen at a position: x, y. z: how far that may be wrong, as what bends can be as
 * steep as it likes at its outline; on flat faces it is exact. */
vec3 plane_at(vec3 position)
{
    vec2 across = even_slope(position, vec2(1.0, 0.0)), up = even_slope(position, vec2(0.0, 1.0));
    vec3 plane = vec3(across.x, up.x, 0.0);
    /* Both may be even, but on two faces: then the corner between them is not in their plane. */
    float corner = depth_at(position.xy + vec2(across.y, up.y)) - position.z, expected = across.x * across.y + up.x * up.y;
    bool even = across.y * up.y != 0.0 && abs(corner - expected) <= 0.004 * (abs(across.x) + abs(up.x)) + DEPTH_NOISE;
    int bent = even ? 0 : 1;
    for (int once = 0; once < bent; once++) {
        vec3 normal = textureLod(t_normal_depth, (gl_FragCoord.xy + position.xy) * u_texel, 0.0).xyz;
        vec3 ray = vec3((2.0 * (gl_FragCoord.xy + position.xy) * u_texel - 1.0) * u_unproject * u_perspective, -1.0);
        vec2 eye = eye_of(position.z), pixel = 2.0 * u_unproject * u_texel * mix(1.0, eye.x, u_perspective);
        float facing = dot(normal, ray), steepest = STEEP * pixel.y * eye.y;
        vec2 slope = -normal.xy * pixel * eye.y / (abs(facing) < 1e-4 ? 1e-4 : facing);
        slope *= min(1.0, steepest / max(length(slope), 1e-20));
        plane = vec3(slope, abs(slope.x) + abs(slope.y) + min(abs(across.x) + abs(up.x), steepest));
    }
    return plane;
}
