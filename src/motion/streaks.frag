/* A stroke's texture over its colour. Großmann 2011, sections 6.2.4 and 6.4.3: caps lie within the stroke and keep their shape. With DEPTH_ALONE its depth only. */
#include "light/shown.glsl"
#ifndef DEPTH_ALONE
layout(location = 0) out vec4 out_0;
#endif
in vec2 v_stroke;
in vec2 v_direction;
flat in vec3 v_shape;
flat in vec4 v_colour;

bool on_object(vec2 position)
{
    /* Beyond the page it may be; on the page it is nowhere outside its pictures. */
    bool page = all(greaterThanEqual(position, vec2(0.0))) && all(lessThan(position, u_size));
    bool inside = all(greaterThanEqual(position, u_around.xy)) && all(lessThan(position, u_around.zw));
    vec2 at = clamp(position, u_around.xy + 0.5, u_around.zw - 0.5);
    return !page || (inside && texelFetch(t_velocity, ivec2(at), 0).w > 0.0);
}

/* Is there nothing of the object before this part of the stroke? Then it would stand out ahead: heads are wider than where they begin. */
bool ahead()
{
    vec2 here = gl_FragCoord.xy;
    if (v_stroke.x > 4.0 * v_shape.y || on_object(here))
        return false;
    float back = v_stroke.x + v_shape.y * max(u_shift_width, 1.0);
    return !on_object(here + v_direction * back) && !on_object(here + v_direction * (0.66 * back)) && !on_object(here + v_direction * (0.33 * back));
}

/* Along the texture: its head and tail are as long as half the stroke is wide. */
float texture_along()
{
    float at = v_stroke.x, whole = v_shape.x, cap = max(min(v_shape.y, 0.5 * whole), 1e-4);
    if (at < cap)
        return 1.0 - u_head * at / cap;
    if (at > whole - cap)
        return u_tail * (whole - at) / cap;
    return mix(1.0 - u_head, u_tail, (at - cap) / max(whole - 2.0 * cap, 1e-4));
}

#ifdef WITH_ROUND
/* Light on a half-cylinder, by that on a flat stroke. */
float roundness(float across)
{
    across = clamp(across, -1.0, 1.0);
    vec3 normal = vec3(across * vec2(-v_direction.y, v_direction.x), sqrt(1.0 - across * across));
    float flat_light = 0.3 + 0.7 * max(u_first_light.z, 0.0);
    return (0.3 + 0.7 * max(dot(normal, u_first_light), 0.0)) / flat_light;
}
#endif

void main()
{
    float half_width = max(v_shape.y * (1.0 - u_taper * v_stroke.x / max(v_shape.x, 1e-4)), 0.05);
    vec2 at = vec2(texture_along(), 0.5 + 0.5 * v_stroke.y / half_width);
    /* Levels by the width on the page: derivatives jump where caps begin. */
    float level = log2(max(float(textureSize(t_stroke, 0).y) / (2.0 * half_width), 1.0));
    vec2 texel = textureLod(t_stroke, vec3(at, 0.0), level).rg;
    float covered = clamp(half_width + 0.5 - abs(v_stroke.y), 0.0, 1.0); /* of the pixel */
    float alpha = texel.y * covered * v_shape.z;
#ifdef INTO_SHADOW
    if (alpha < 0.5)
        discard;
#else
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (alpha < 0.004 || gl_FragCoord.z > texelFetch(t_scene_depth, pixel, 0).r || ahead())
        discard;
#ifndef DEPTH_ALONE
    vec3 colour = v_colour.rgb * texel.x;
#ifdef WITH_ROUND
    colour = shown(light_shown_as(colour) * mix(1.0, roundness(v_stroke.y / half_width), u_round));
#endif
    out_0 = vec4(colour, 1.0) * alpha;
#endif
#endif
}
