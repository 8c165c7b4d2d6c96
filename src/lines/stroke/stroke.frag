/* Strokes into the edge map. Outlines and borders are profile lines, creases inner ones, intersections and materials those between parts; hidden lines are in the channel of
 * all lines alone. */
#include "lines/stroke/piece.glsl"
#ifdef SAMPLED
#include "lines/stroke/visible.glsl"
#else
#include "lines/stroke/brush.glsl"
#endif
layout(location = 0) out vec4 out_edge;

const int PROFILE = 0, INNER = 1, ID = 3;

void main()
{
    piece_position p = position_in_piece();
#ifdef SAMPLED
    bool open = p.fraction > 0.0 && v_look.w == 0.0;
    float ink = is_visible(p.axis.xyz, open) || !open ? p.fraction : 0.0;
#else
    float ink = brush_ink(p) * mix(v_look.x, v_look.y, p.at);
#endif
    if (ink <= 0.0)
        discard;
    gl_FragDepth = p.axis.z;
    int channel = int(v_look.z);
    float paper = 1.0 - ink;
    out_edge = vec4(channel == PROFILE ? paper : 1.0, channel == INNER ? paper : 1.0, channel == ID ? 1.0 : paper, channel == ID ? paper : 1.0);
}
