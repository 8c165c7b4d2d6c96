/* The quad around a piece of a line on the page, with room for its round ends and its soft rim. Row EX-12. */
flat out vec4 v_begin; /* pixels from the bottom left; window depth; half the width */
flat out vec4 v_end;
flat out vec4 v_look;  /* opacity at both ends; channel of the edge map; bits */

const vec4 NOWHERE = vec4(0.0, 0.0, 2.0, 1.0);

vec4 corner_of(vec4 begin, vec4 end)
{
    vec2 along = end.xy - begin.xy;
    float size = length(along), margin = max(begin.w, end.w) + 0.75; /* half a pixel's diagonal, and a little */
    along = size > 0.0 ? along / size : vec2(1.0, 0.0);
    bool at_end = (gl_VertexID & 1) != 0, left = (gl_VertexID & 2) != 0;
    vec2 position = (at_end ? end.xy + margin * along : begin.xy - margin * along) + vec2(-along.y, along.x) * (left ? margin : -margin);
    return vec4(2.0 * position / u_size - 1.0, 0.0, 1.0);
}
