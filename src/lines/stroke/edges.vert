/* Edges of a mesh as quads. Those that are no lines are moved out of sight, which costs least (row EX-13). */
#include "lines/stroke/decide.glsl"
#include "lines/stroke/quad.glsl"
#include "lines/stroke/visible.glsl"
uniform mat4  u_clip; /* from the mesh's axes to clip space */
uniform vec2  u_half_widths; /* of outlines, of all others */

/* An edge no longer than SHORT, in pixels, is seen as a whole or not at all. Of others some position must be seen, STEP apart, so that those wholly hidden cost no fragments; it
 * would take too long for those longer than LONG. */
const float SHORT = 2.5, STEP = 2.0, LONG = 240.0;
const float SEEN = 1.0; /* in the place of the bits */
/* How far a surface is before a line along the view, of how far it is at right angles. */
const float AS_SEEN = 2.0;

/* Pixels and window depth. */
vec3 on_page(vec4 clip)
{
    vec3 position = 0.5 * clip.xyz / clip.w + 0.5;
    return vec3(position.xy * u_size, position.z);
}

/* Lines that files bring are held before the surface that they lie on. */
vec4 end_on_page(vec4 end)
{
    vec3 to_eye = u_viewer.xyz - u_viewer.w * end.xyz;
    return u_clip * vec4(end.xyz + (a_end.w > 0.0 ? AS_SEEN * a_end.w * normalize(to_eye) : vec3(0.0)), 1.0);
}

/* The quad's corner, of what lies beyond the near plane. */
vec4 place_edge(int line)
{
    vec4 begin = end_on_page(a_begin), end = end_on_page(a_end);
    float first = begin.z + begin.w, second = end.z + end.w;
    if (first <= 0.0 && second <= 0.0)
        return NOWHERE;
    if (first <= 0.0)
        begin = mix(end, begin, second / (second - first));
    else if (second <= 0.0)
        end = mix(begin, end, first / (first - second));
    float half_width = line == PROFILE ? u_half_widths.x : u_half_widths.y;
    v_begin = vec4(on_page(begin), half_width);
    v_end = vec4(on_page(end), half_width);
    v_look = vec4(1.0, 1.0, float(line), distance(v_begin.xy, v_end.xy) <= SHORT ? SEEN : 0.0);
    return corner_of(v_begin, v_end);
}

void main()
{
    int line = line_of_edge();
    gl_Position = NOWHERE;
    v_begin = v_end = v_look = vec4(0.0);
    if (line != NO_LINE)
        gl_Position = place_edge(line);
    float size = distance(v_begin.xy, v_end.xy);
    int   positions = line == NO_LINE || size > LONG ? 0 : v_look.w == SEEN ? 1 : int(ceil(size / STEP)), left = positions;
    bool  seen = false;
    for (int i = 0; i < left; i++) {
        seen = is_visible(mix(v_begin.xyz, v_end.xyz, (float(i) + 0.5) / float(positions)), true);
        left = seen ? 0 : left;
    }
    if (positions > 0 && !seen)
        gl_Position = NOWHERE;
}
