/* How deep strokes lie: what is outside the surfaces that they belong to is hidden by what is in front of these. */
#include "lines/stroke/piece.glsl"

void main()
{
    piece_place p = place_in_piece();
    if (p.share <= 0.0)
        discard;
    gl_FragDepth = p.axis.z;
}
