/* A piece of a line at a pixel: how much of the pixel it covers, and the position of its axis that the pixel belongs to. Pieces that follow each other overlap in round
 * joins; the darker one counts, so that nothing shows where they do. */
#include "lines/stroke/coverage.glsl"
flat in vec4 v_begin;
flat in vec4 v_end;
flat in vec4 v_look;

const int BUTT_BEGIN = 1, BUTT_END = 2, BRUSH_SHIFT = 2;

struct piece_position {
    float at;      /* 0 … 1 along the piece */
    vec4  axis;    /* pixels, window depth, half the width */
    float aside;   /* distance from the line on which the axis lies, pixels; left is above 0 */
    float fraction;   /* of the pixel */
};

piece_position position_in_piece()
{
    piece_position p;
    vec2 along = v_end.xy - v_begin.xy, from = gl_FragCoord.xy - v_begin.xy;
    float size = length(along), ahead = size > 0.0 ? dot(from, along) / size : 0.0;
    p.at = size > 0.0 ? clamp(ahead / size, 0.0, 1.0) : 0.0;
    p.axis = mix(v_begin, v_end, p.at);
    vec2 away = gl_FragCoord.xy - p.axis.xy, direction = size > 0.0 ? along / size : vec2(1.0, 0.0);
    float distance = length(away);
    p.aside = size > 0.0 ? (along.x * from.y - along.y * from.x) / size : 0.0;
    p.fraction = band_fraction(distance, p.axis.w, distance > 1e-4 ? away / distance : vec2(-direction.y, direction.x));
#ifndef SAMPLED
    int bits = int(v_look.w);
    if ((bits & BUTT_BEGIN) != 0)
        p.fraction *= half_plane_fraction(ahead, direction);
    if ((bits & BUTT_END) != 0)
        p.fraction *= half_plane_fraction(size - ahead, direction);
#endif
    return p;
}
