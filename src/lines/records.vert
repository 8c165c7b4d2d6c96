/* Edges of meshes as narrow quads, for where they are on the page. Those that are no lines are moved out of sight. */
#include "lines/stroke/decide.glsl"
#include "lines/stroke/quad.glsl"
#include "lines/stroke/visible.glsl"
#include "lines/record.glsl"
uniform mat4 u_clip; /* from the mesh's axes to clip space */

/* Of edges longer than SHORT, in pixels, some position must be seen, STEP apart, so that those wholly hidden cost no fragments; it would take too long for those longer than LONG. */
const float SHORT = 2.5, STEP = 2.0, LONG = 240.0;
vec3 on_page(vec4 clip)
{
    vec3 position = 0.5 * clip.xyz / clip.w + 0.5;
    return vec3(position.xy * u_size, position.z);
}

/* The code of a record (lines/record.glsl); 0 where there is no line. */
float code_of(int line)
{
    int bits = int(a_begin.w);
    float cosine = dot(a_first.xyz, a_second.xyz);
    float crease = (bits & RECORD_ROUNDED) != 0 ? 1.0 : (bits & RECORD_CREASE) != 0 ? clamp((u_line_faint - cosine) / max(u_line_faint - u_line_crease, 1e-4), 0.0, 1.0) : 0.0;
    return line == INNER ? -crease : line != PROFILE ? 0.0 : (bits & RECORD_BORDER) != 0 ? RECORDED_BORDER : RECORDED_OUTLINE + crease;
}

void place_edge(float code)
{
    vec4 begin = u_clip * vec4(a_begin.xyz, 1.0), end = u_clip * vec4(a_end.xyz, 1.0);
    float first = begin.z + begin.w, second = end.z + end.w;
    if (first <= 0.0 && second <= 0.0)
        return;
    if (first <= 0.0)
        begin = mix(end, begin, second / (second - first));
    else if (second <= 0.0)
        end = mix(begin, end, first / (first - second));
    float room = max(0.5 * u_line_width + 0.75, RECORD_REACH) - 0.5; /* a quad has half a pixel more */
    v_begin = vec4(on_page(begin), room);
    v_end = vec4(on_page(end), room);
    v_look.x = code;
    gl_Position = corner_of(v_begin, v_end);
}

void main()
{
    int line = line_of_edge();
    float code = code_of(line);
    gl_Position = NOWHERE;
    v_begin = v_end = v_look = vec4(0.0);
    if (code != 0.0)
        place_edge(code);
    float size = distance(v_begin.xy, v_end.xy);
    int   positions = v_look.x == 0.0 || size > LONG ? 0 : size <= SHORT ? 1 : int(ceil(size / STEP)), left = positions;
    bool  seen = false;
    for (int i = 0; i < left; i++) {
        seen = is_visible(mix(v_begin.xyz, v_end.xyz, (float(i) + 0.5) / float(positions)), true);
        left = seen ? 0 : left;
    }
    if (positions > 0 && !seen)
        gl_Position = NOWHERE;
}
