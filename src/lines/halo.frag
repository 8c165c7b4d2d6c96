/* Haloed lines: ink clearly behind an outline is taken away for some pixels beside it, so that objects separate. What is behind is told by the
 * surface's own plane: of two positions of a convex body neither is before the other's, so that nothing on it is taken away. At outlines of
 * round things depth runs away within a pixel, so that how steep it is there counts, too. Ink on the farther side of an outline is the
 * outline's own. */
#include "lines/halo.glsl"
layout(location = 0) out vec4 out_0;

/* The rims of lines are soft, and outlines up to a pixel off the middle of theirs: no farther than this beyond its reach an outline has ink of its own. */
const float RIM = 1.6;
float s_own = 0.0; /* fraction of the pixel that nearer outlines beside it may have inked themselves */

/* Whose line this pixel's ink is: x, y = where, from here; z = its window depth. */
vec3 owner_here()
{
    vec3 owner = vec3(0.0, 0.0, depth_at(vec2(0.0)));
    int own = int(ceil(own_reach()));
    for (int y = -own; y <= own; y++)
        for (int x = -own; x <= own; x++) {
            vec2 off = vec2(float(x), float(y));
            bool outline = length(off) < own_reach() + 0.8 && textureLod(t_outlines, (gl_FragCoord.xy + off) * u_texel, 0.0).r > 0.0;
            float depth = outline ? depth_at(off) : 1.0;
            owner = depth < owner.z ? vec3(off, depth) : owner;
        }
    return owner;
}

/* Window depth of the nearest outline in the row at `y` within reach. Rows are kept in half precision; this is never too deep. */
float nearest_in_row(float y)
{
    return 1.0 - 1.001 * textureLod(t_nearer_row, (gl_FragCoord.xy + vec2(0.0, y)) * u_texel, 0.0).r - 1e-6;
}

/* Where an outline must be to be clearly before this position. */
float before_this(vec3 owner)
{
    return owner.z - clear_step(owner.z);
}

bool has_nearer(vec3 owner)
{
    int reach = int(ceil(halo_reach()));
    float nearest = 1.0;
    for (int y = -reach; y <= reach; y++)
        nearest = min(nearest, nearest_in_row(float(y)));
    return nearest < before_this(owner);
}

/* Fraction of the ink that stays beside an outline's pixel at `off`; `plane` is that of the ink's owner. */
float kept_beside(vec2 off, float beyond, vec3 owner, vec3 plane, float clear_times)
{
    vec2 there = textureLod(t_outlines, (gl_FragCoord.xy + off) * u_texel, 0.0).rg;
    float depth = depth_at(off), apart = plane.z * (1.0 + 0.125 * length(off));
    apart += clear_step(depth) * (clear_times + (plane.z > 0.0 ? there.g : 0.0));
    bool nearer = owner.z + min(0.0, dot(plane.xy, off - owner.xy)) - depth > apart;
    nearer = nearer && there.r > 0.0;
    s_own = nearer ? max(s_own, clamp(own_reach() + RIM - length(off), 0.0, 1.0)) : s_own;
    return nearer ? clamp(beyond, 0.0, 1.0) : 1.0;
}

/* The same of all outlines around; rows that have none nearer are left out. */
float kept_of(vec3 owner, float clear_times)
{
    float limit = halo_reach(), kept = 1.0, before = before_this(owner);
    int reach = int(ceil(limit));
    vec3 plane = owner.z < 1.0 && clear_times == 1.0 ? plane_at(owner) : vec3(0.0);
    for (int y = -reach; y <= reach; y++) {
        int across = nearest_in_row(float(y)) < before ? int(sqrt(max((limit + 1.0) * (limit + 1.0) - float(y * y), 0.0))) : -1;
        for (int x = -across; x <= across; x++)
            kept = min(kept, kept_beside(vec2(float(x), float(y)), length(vec2(float(x), float(y))) - limit, owner, plane, clear_times));
    }
    return kept;
}

void main()
{
    vec4 edge = texelFetch(t_edge, ivec2(gl_FragCoord.xy), 0);
    vec3 owner = vec3(0.0, 0.0, 1.0);
    float kept = 1.0, clear_times = 1.0;
    /* Loops that run once or not at all: software drivers skip these, not branches. */
    int inked = min(edge.b, edge.a) < 1.0 ? 1 : 0;
    for (int once = 0; once < inked; once++) {
        owner = owner_here();
#ifdef HAS_OVERSHOOT
        /* A line that runs on does so in space, on no surface that tells its slope. */
        uint bits = texelFetch(t_overshoot, ivec2(gl_FragCoord.xy), 0).g;
        float eye = uintBitsToFloat(bits);
        float window = window_depth_at_eye(eye);
        clear_times = bits != 0u && window < owner.z ? 4.0 : 1.0;
        owner = bits != 0u && window < owner.z ? vec3(0.0, 0.0, window) : owner;
#endif
        int crossed = has_nearer(owner) ? 1 : 0;
        for (int again = 0; again < crossed; again++)
            kept = kept_of(owner, clear_times);
    }
    vec4 left = 1.0 - max((1.0 - edge) * kept, min(1.0 - edge, vec4(s_own)));
    out_0 = vec4(left.r, left.g, left.r * left.g, left.a);
}
