/* Lines of tiles where so many crowd that each is finer than half a pixel: as ink of the two pixels that an edge parts. Where exactly between them it runs is not to be seen there, and costs
 * most of what lines cost. */
#define OWN_WIDTH
#include "lines/edge/found.glsl"
#include "lines/room.glsl"

/* Half a line's ink is each pixel's; and as much again as their ends, which are round, add where all lines are short. Measured on towns. */
const float INK = 0.8;

void main()
{
    found_edges found = find_edges();
    float share = INK * line_width_at(gl_FragCoord.xy);
    write_edges(1.0 - found.profile, 1.0 - found.inks.x, 1.0 - found.inks.y);
    vec3 left = 1.0 - (1.0 - out_edge.rga) * min(share * vec3(1.0, u_line_crease_width, u_line_crease_width), 1.0);
    out_edge = vec4(left.x, left.y, left.x * left.y, left.z);
}
