/* Which edges of a mesh are lines in this view: decided in the vertex stage, from the edge's record alone, so that all corners of its quad agree. Freudenberg 2003, section 7.2;
 * rows OE-05 to OE-07. An edge is an outline where one of its faces is seen from the front and the other is not; any place of the edge lies in both planes, so its
 * middle, the same for both ends, decides exactly in perspective too. Faces seen exactly from the side count as seen from behind. */
layout(location = 0) in vec4 a_begin;  /* position; bits */
layout(location = 1) in vec4 a_end;    /* position; of lines that files bring, how far they may lie off their surface */
layout(location = 2) in vec4 a_first;  /* normals of the faces, outward where they enclose something; by how much the crease's chain turns, radians, 0: not known */
layout(location = 3) in vec4 a_second; /* its bend at the begin; see a_end for that at the end, which is below 0 there (record_bends.h) */
uniform vec4 u_viewer; /* in the mesh's axes: position of the eye, 1; or the direction towards it, 0 */
uniform int  u_wanted; /* bits of the lines that are drawn */
uniform bool u_inside; /* the eye may be among the parts: surfaces are seen from behind as well */

const int RECORD_BORDER = 1, RECORD_CREASE = 2, RECORD_MATERIAL = 4, RECORD_PAIR = 8, RECORD_CLOSED = 16, WANT_CONTOUR = 32, RECORD_CROSSING = 64, RECORD_DRAWN = 128, RECORD_ROUNDED = 256, RECORD_QUIET = 512;
const float EDGE_ON = 1e-5; /* what rounding turns */
const int NO_LINE = -1, PROFILE = 0, INNER = 1, ID = 3;

/* The edge map's channel that the edge is drawn into, or NO_LINE. */
int line_of_edge()
{
    int bits = int(a_begin.w), wanted = bits & u_wanted;
    vec3 to_eye = u_viewer.xyz - u_viewer.w * 0.5 * (a_begin.xyz + a_end.xyz);
    float towards_first = dot(a_first.xyz, to_eye), towards_second = dot(a_second.xyz, to_eye);
    bool first = towards_first > 0.0, second = towards_second > 0.0;
    if ((bits & RECORD_CLOSED) != 0 && !first && !second && !u_inside)
        return NO_LINE;
    /* Where one of two crossing surfaces looks away, the body that it encloses hides the line. Those of open surfaces are 0. */
    if ((bits & RECORD_CROSSING) != 0 && min(towards_first, towards_second) < -EDGE_ON * length(to_eye) && !u_inside)
        return NO_LINE;
    bool outline = (bits & RECORD_PAIR) != 0 && first != second && (u_wanted & WANT_CONTOUR) != 0;
    if (outline || (wanted & RECORD_BORDER) != 0)
        return PROFILE;
    return (wanted & RECORD_CREASE) != 0 ? INNER : (wanted & (RECORD_CROSSING | RECORD_MATERIAL | RECORD_DRAWN)) != 0 ? ID : NO_LINE;
}
