/* What edge operators share. Edge map: R profile, G inner, B both, A id; 1 = no edge. */
#ifdef MERGED
vec4 out_edge;
#else
layout(location = 0) out vec4 out_edge;
#endif

/* Normalised linear depth, 0 at the figure's near plane, 1 at its far plane and where nothing is. */
float normalised(float depth)
{
    return clamp((depth - u_near) / (u_far - u_near), 0.0, 1.0);
}

/* An intensity after threshold and gain; at threshold 0 and gain 1 only clamped. */
float emphasised(float intensity)
{
    return 1.0 - clamp((1.0 - intensity - u_line_threshold) * u_line_gain, 0.0, 1.0);
}

/* Ink of operators that find lines two pixels wide, of narrower ones. */
float narrowed(float intensity)
{
#ifdef OWN_WIDTH
    return intensity;
#else
    return 1.0 - (1.0 - intensity) * min(0.5 * u_line_width, 1.0);
#endif
}

#include "lines/meeting.glsl"

#if defined(FINDS_MEETINGS) && defined(HAS_MEETING)
/* Intensity of the two pixels that a surface crosses another between, as wide as operators find lines. */
float met_intensity()
{
    bool met = meets(vec2(1.0, 0.0)) || meets(vec2(-1.0, 0.0)) || meets(vec2(0.0, 1.0)) || meets(vec2(0.0, -1.0));
    return met ? 1.0 - min(0.5 * u_line_width, 1.0) : 1.0;
}
#else
#define met_intensity() 1.0
#endif

void write_edges(float profile, float inner, float id)
{
    profile = narrowed(emphasised(profile));
    inner = narrowed(emphasised(inner));
    id = narrowed(emphasised(id));
#ifdef MEETINGS_ARE_BORDERS
    id = min(id, met_intensity());
#else
    inner = min(inner, met_intensity());
#endif
    out_edge = vec4(profile, inner, profile * inner, id);
}

/* The texel `off` pixels from this one, clamped at the border by the sampler, which costs less than fetching by index. */
vec4 neighbour(sampler2D map, vec2 off)
{
    return textureLod(map, (gl_FragCoord.xy + off) * u_texel, 0.0);
}

vec4 texel(sampler2D map, ivec2 at)
{
    return texelFetch(map, clamp(at, ivec2(0), ivec2(u_size) - 1), 0);
}

/* Bilinear sample by hand: 32-bit float pictures have no filter on every driver. `at` in pixels, centres at .5. */
vec4 bilinear(sampler2D map, vec2 at)
{
    vec2 corner = floor(at - 0.5);
    vec2 f = at - 0.5 - corner;
    ivec2 i = ivec2(corner);
    return mix(mix(texel(map, i), texel(map, i + ivec2(1, 0)), f.x),
               mix(texel(map, i + ivec2(0, 1)), texel(map, i + ivec2(1, 1)), f.x), f.y);
}
