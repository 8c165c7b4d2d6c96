/* Where a figure's surface runs through those of other rules. Its own pictures know nothing of these, so that it can be looked up beside the pixel, or layer after layer; their window depth lies in a picture
 * of its own. A surface runs through another one where it is in front of it at a pixel and behind it at the next, and both go on from one to the other. */
#ifdef HAS_MEETING
/* As in pairs.frag: what rounding can add up to. */
const float MEETING_NOISE = 16.0 * 5.96e-8;

/* x: of the figure; y: of the others. */
vec2 meeting_depths(vec2 off)
{
    vec2 at = (gl_FragCoord.xy + off) * u_texel;
    return vec2(textureLod(t_depth, at, 0.0).r, textureLod(t_meeting, at, 0.0).r);
}

/* Is a step from pixel to pixel no more than the slopes beside it lead to expect? At the rim of a figure these are not known: the last face may be a pixel wide. */
bool goes_on(float before, float here, float next, float behind)
{
    float across = next - here;
    vec2 slopes = vec2(here - before, behind - next), sizes = abs(slopes);
    float excess = max(min(slopes.x, slopes.y) - across, across - max(slopes.x, slopes.y));
    return max(before, behind) >= 1.0 || excess <= max(min(sizes.x, sizes.y), MEETING_NOISE);
}

/* Between this pixel and the next one to this side? Where a surface ends between them, it counts as far as it would have gone on: who stands in a wall may not reach far into it. */
bool meets(vec2 side)
{
    vec2 here = meeting_depths(vec2(0.0)), next = meeting_depths(side), before = meeting_depths(-side), behind = meeting_depths(2.0 * side);
    bvec2 on = bvec2(goes_on(before.x, here.x, next.x, behind.x), goes_on(before.y, here.y, next.y, behind.y));
    vec2 ahead = mix(2.0 * here - before, next, vec2(on)), back = mix(2.0 * next - behind, here, vec2(on));
    bool turns = (here.x <= here.y) != (ahead.x <= ahead.y) || (back.x <= back.y) != (next.x <= next.y);
    bool there = max(max(here.x, here.y), max(next.x, next.y)) < 1.0;
    return turns && there && abs(here.x - here.y) + abs(next.x - next.y) > MEETING_NOISE;
}

/* The others' slope here: the gentler one to either side, since beyond the other there may be another surface. */
vec2 meeting_slope()
{
    float here = meeting_depths(vec2(0.0)).y;
    vec2 before = here - vec2(meeting_depths(vec2(-1.0, 0.0)).y, meeting_depths(vec2(0.0, -1.0)).y);
    vec2 behind = vec2(meeting_depths(vec2(1.0, 0.0)).y, meeting_depths(vec2(0.0, 1.0)).y) - here;
    return mix(behind, before, vec2(lessThan(abs(before), abs(behind))));
}
#endif
