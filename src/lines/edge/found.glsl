/* Which edges part a pixel from its four neighbours, of pairs of pixels (lines/edge/pairs.frag), less what records have drawn. */
#include "lines/edge/edge.glsl"

#include "light/piece.glsl"

#if defined(HAS_BARE) && defined(HAS_ID) && PARTS
/* Surfaces that turn less against each other are one where they meet: cosine. */
const float ONE_SURFACE = 0.9976;

/* 1 where a border between parts may be drawn, for the four neighbours. Shells that nearly coincide change places from pixel to pixel, so where surfaces go on smoothly, borders
 * are where records say. What has no records is left alone: solids and cut faces. */
vec4 apart(vec4 steps, vec3 normal, uvec2 id)
{
    const vec2 sides[4] = vec2[4](vec2(1.0, 0.0), vec2(-1.0, 0.0), vec2(0.0, 1.0), vec2(0.0, -1.0));
    vec4 found = vec4(1.0);
    for (int k = 0; k < 4; k++) {
        uint kinds = id.g | textureLod(t_id, (gl_FragCoord.xy + sides[k]) * u_texel, 0.0).g;
        bool one = abs(dot(normal, neighbour(t_normal_depth, sides[k]).xyz)) > ONE_SURFACE && steps[k] == 0.0;
        found[k] = one && (kinds & (SURFACE_OPERAND | SURFACE_CUT)) == 0u ? 0.0 : 1.0;
    }
    return found;
}
#endif

vec4 pairs_at(ivec2 off)
{
    ivec2 at = ivec2(gl_FragCoord.xy) + off;
    return min(at.x, at.y) < 0 ? vec4(0.0) : texelFetch(t_pairs, at, 0);
}

/* Ink of the pixel. To the right, left, up and down: what of it is due to each neighbour. */
struct found_edges {
    float profile;
    vec2 inks; /* of creases, of borders */
    vec4 steps, creases, borders;
};

found_edges find_edges()
{
    vec4 own = pairs_at(ivec2(0)), left = pairs_at(ivec2(-1, 0)), down = pairs_at(ivec2(0, -1));
    vec4 steps = vec4(own.x, left.x, own.y, down.y), both = vec4(own.z, left.z, own.w, down.w);
    vec4 borders = step(2.0, both), creases = both - 2.0 * borders;
#ifdef HAS_BARE
    /* What steps beside a crease is the foot of a face too narrow for pixels, and would be drawn in some of them: the surface goes on, or another one is where it ends, as
     * at kerbs. Outlines there have records of their own. */
    steps *= texelFetch(t_bare, ivec2(gl_FragCoord.xy), 0).b;
#endif
    float profile = max(max(steps.x, steps.y), max(steps.z, steps.w));
#if defined(HAS_BARE) && defined(HAS_ID) && PARTS
    int bordered = borders != vec4(0.0) ? 1 : 0;
    for (int once = 0; once < bordered; once++)
        borders *= apart(steps, neighbour(t_normal_depth, vec2(0.0)).xyz, texelFetch(t_id, ivec2(gl_FragCoord.xy), 0).rg);
#endif
#ifdef HAS_MEETING
    int creased = creases != vec4(0.0) ? 1 : 0;
    bool met = false;
    for (int once = 0; once < creased; once++)
        met = meets(vec2(1.0, 0.0)) || meets(vec2(-1.0, 0.0)) || meets(vec2(0.0, 1.0)) || meets(vec2(0.0, -1.0));
#endif
    vec2 inks = vec2(max(max(creases.x, creases.y), max(creases.z, creases.w)), max(max(borders.x, borders.y), max(borders.z, borders.w)));
#ifdef HAS_BARE
    /* Records have drawn it already. */
    vec2 bare = texelFetch(t_bare, ivec2(gl_FragCoord.xy), 0).rg;
    profile *= bare.x;
    inks *= bare.y;
#ifdef HAS_MEETING
    /* No record has where others' surfaces come through, however near to an edge. */
    inks.x = met ? 1.0 : inks.x;
#endif
#endif
    return found_edges(profile, inks, steps, creases, borders);
}
