/* What is left of a mover, and its strokes: of each pixel what is nearer over the other, both only where nothing that stands still hides them. Großmann 2011, sections 6.4.4 and
 * 6.5.2. */
#include "motion/mover.glsl"
layout(location = 0) out vec4 out_0;

#ifdef WITH_FRONT
/* 0 at the edge that goes ahead, 1 as far behind it as is kept: what dissolves does so from behind. */
float behind_front(ivec2 pixel, vec2 moved)
{
    vec2 ahead = moved / max(length(moved), 1e-3) * u_front;
    float on = 0.0;
    for (int i = 1; i <= 3; i++) {
        ivec2 at = clamp(pixel + ivec2(round(ahead * (float(i) / 3.0))), ivec2(u_around.xy), ivec2(u_around.zw) - 1);
        on += step(1e-3, texelFetch(t_mover, at, 0).a);
    }
    return smoothstep(0.0, 1.0, on / 3.0);
}
#endif

#ifdef WITH_FADE
float faded(ivec2 pixel)
{
    vec2 moved = velocity_near(pixel).xy;
    float speed = length(moved);
#if PATH != 0
    /* The way there and back counts, as it does for strokes. */
#if PATH == 1
    vec4 between = texelFetch(t_past_1, pixel, 0);
#else
    vec4 between = texelFetch(t_past_2, pixel, 0);
#endif
    speed = max(speed, between.w > 0.0 ? length(between.xy) + distance(moved, between.xy) : 0.0);
#endif
    float fast = u_fade_full > u_fade_begin ? clamp((speed - u_fade_begin) / (u_fade_full - u_fade_begin), 0.0, 1.0) : float(speed > u_fade_begin);
#ifdef WITH_FRONT
    fast *= behind_front(pixel, moved);
#endif
    return 1.0 - u_fade * fast;
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 object = texelFetch(t_mover, pixel, 0), strokes = texelFetch(t_streaks, pixel, 0);
    if (max(object.a, strokes.a) <= 0.0)
        discard;
    float scene = texelFetch(t_scene_depth, pixel, 0).r;
    float object_depth = mover_depth_at(pixel), strokes_depth = texelFetch(t_streaks_depth, pixel, 0).r;
#ifdef WITH_FADE
    object *= faded(pixel);
#endif
    object *= object_depth > scene ? 0.0 : 1.0;
#if PLACE == 0
    bool over = strokes_depth <= object_depth;
#else
    bool over = PLACE == 2;
#endif
    vec4 near = over ? strokes : object, far = over ? object : strokes;
    out_0 = near + far * (1.0 - near.a);
    if (out_0.a <= 0.0)
        discard;
    gl_FragDepth = min(object.a > 0.0 ? object_depth : 1.0, strokes.a > 0.0 ? strokes_depth : 1.0);
}
