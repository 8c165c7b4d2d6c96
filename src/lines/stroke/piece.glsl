/* A piece of a line at a pixel: how much of the pixel it covers, and the position of its axis that the pixel belongs to. Pieces that follow each other overlap in round
 * joins; the darker one counts, so that nothing shows where they do. */
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

/* How much of a pixel at this distance from the middle of a band lies in it. */
float fraction_of(float distance, float half_width)
{
    return clamp(min(distance + 0.5, half_width) - max(distance - 0.5, -half_width), 0.0, 1.0);
}

piece_position position_in_piece()
{
    piece_position p;
    vec2 along = v_end.xy - v_begin.xy, from = gl_FragCoord.xy - v_begin.xy;
    float size = length(along), ahead = size > 0.0 ? dot(from, along) / size : 0.0;
    p.at = size > 0.0 ? clamp(ahead / size, 0.0, 1.0) : 0.0;
    p.axis = mix(v_begin, v_end, p.at);
    float distance = length(gl_FragCoord.xy - p.axis.xy);
    p.aside = size > 0.0 ? (along.x * from.y - along.y * from.x) / size : 0.0;
    p.fraction = fraction_of(distance, p.axis.w);
#ifndef SAMPLED
    int bits = int(v_look.w);
    if ((bits & BUTT_BEGIN) != 0)
        p.fraction *= clamp(ahead + 0.5, 0.0, 1.0);
    if ((bits & BUTT_END) != 0)
        p.fraction *= clamp(size - ahead + 0.5, 0.0, 1.0);
#endif
    return p;
}
