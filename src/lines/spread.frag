/* The edge map's ink as wide as the line: pixels beside an edge know where it is (t_feet), and lines cover as much of each pixel as a band around it does. Ink of which nobody
 * knows more than the pixel, of other operators, is two pixels wide as it is, and grows by what is missing. Of broad lines the pixels beside the edge are far; floods found the
 * nearest. */
#include "lines/reach.glsl"
#include "lines/cover.glsl"
#include "lines/room.glsl"
#ifdef HAS_SEEDS
#include "lines/seed.glsl"
#endif
layout(location = 0) out vec4 out_0;
#ifdef HAS_THIN
#define t_found t_thin
#else
#define t_found t_edge
#endif

/* Width of what is no outline, fraction of the width, of operators that have it. */
#ifdef HAS_FEET
#define CREASE_WIDTH u_line_crease_width
#else
#define CREASE_WIDTH 1.0
#endif

/* An edge goes on as a straight line for this long beside the pixel that knows it. */
const float STRAIGHT = 0.75;

/* The nearest edge of some classes of ink: how far its axis is, across the edge and squared; the edge's normal; how much ink it has. */
struct nearest_edge {
    float square, across;
    vec2 normal, ink;
};

/* Beyond the end of an edge distance counts in all directions, so that lines end and meet in round joins. */
void look_at(inout nearest_edge found, vec4 foot, vec2 off, float across, float square, vec2 ink)
{
    /* Where all that is known is pixels, ink is of many shades, and the darkest counts. */
    bool plain = foot.w == 0.0;
    float weight = max(ink.x, ink.y), had = max(found.ink.x, found.ink.y), half_width = max(0.5 * u_line_width, 1.0);
    bool darker = weight * clamp(half_width - sqrt(square), 0.0, 1.0) > had * clamp(half_width - sqrt(found.square), 0.0, 1.0);
    bool nearer = weight > 0.0 && (plain ? darker : square < found.square);
    found.square = nearer ? square : found.square;
    found.across = nearer ? across : found.across;
    found.normal = nearer ? foot.xy : found.normal;
    found.ink = nearer ? ink : found.ink;
}

/* The edges around a pixel at `middle` from here: of outlines and id lines, and of inner lines. */
void look_around(ivec2 middle, inout nearest_edge outer, inout nearest_edge inner)
{
    for (int i = 0; i < 9; i++) {
        vec2 off = vec2(middle) + vec2(float(i % 3) - 1.0, float(i / 3) - 1.0), at = (gl_FragCoord.xy + off) * u_texel;
        vec3 ink = 1.0 - textureLod(t_found, at, 0.0).rga;
        int inked = max(ink.x, max(ink.y, ink.z)) > 0.0 ? 1 : 0;
        for (int once = 0; once < inked; once++) {
#ifdef HAS_FEET
            vec4 foot = textureLod(t_feet, at, 0.0);
#else
            vec4 foot = vec4(0.0);
#endif
            float across = dot(foot.xy, off) + foot.z, beyond = max(abs(dot(vec2(-foot.y, foot.x), off)) - STRAIGHT, 0.0);
            float square = foot.w > 0.0 ? across * across + beyond * beyond : dot(off, off);
            look_at(outer, foot, off, across, square, ink.xz);
            look_at(inner, foot, off, across, square, vec2(ink.y, 0.0));
        }
    }
}

vec2 ink_of(nearest_edge found, bool outline)
{
    float half_width = 0.5 * line_width_at(gl_FragCoord.xy) * (outline ? 1.0 : CREASE_WIDTH), d = sqrt(found.square), share = abs(found.across) / max(d, 1e-4);
    /* Beyond the end the way there is what the band is measured along. */
    vec2 along = vec2(-found.normal.y, found.normal.x), way = found.normal * share + along * sqrt(max(1.0 - share * share, 0.0));
    float cover = found.normal == vec2(0.0) ? clamp(max(half_width, 1.0) - d, 0.0, 1.0) : line_cover(d, d > 0.01 ? way : found.normal, half_width);
#ifdef HAS_FEET
    /* Of narrower ones that know no more than pixels. */
    cover *= found.normal == vec2(0.0) ? min(half_width, 1.0) : 1.0;
#endif
    return found.ink * cover;
}

void main()
{
    nearest_edge outer = nearest_edge(1e9, 0.0, vec2(0.0), vec2(0.0)), inner = outer;
    vec2 outer_ink = vec2(0.0), inner_ink = vec2(0.0);
#ifdef HAS_SEEDS
    uvec3 words = texelFetch(t_seeds, ivec2(gl_FragCoord.xy), 0).xyz;
    look_around(ivec2(0), outer, inner);
    for (int k = 0; k < 3; k++) {
        int found = words[k] != NO_SEED ? 1 : 0;
        for (int again = 0; again < found; again++)
            look_around(seed_of(words[k]), outer, inner);
    }
#else
    look_around(ivec2(0), outer, inner);
#endif
    int outlined = outer.square < 1e9 ? 1 : 0, creased = inner.square < 1e9 ? 1 : 0;
    for (int once = 0; once < outlined; once++)
        outer_ink = ink_of(outer, outer.ink.x > 0.0);
    for (int once = 0; once < creased; once++)
        inner_ink = ink_of(inner, false);
    vec3 left = 1.0 - vec3(outer_ink.x, inner_ink.x, outer_ink.y);
    out_0 = vec4(left.r, left.g, left.r * left.g, left.b);
}
