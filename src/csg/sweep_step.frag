/* Takes one fragment at each pixel: its operand is entered or left, and the products say whether the solid changes. What lies at one depth
 * in one plane is one event, as in csg/resolve.frag. Which operands hold is kept in bits, 128 a picture. */
#include "csg/depth.glsl"

uniform usampler2D t_fragment; /* depth share, key, normal; 0: none left, or the pixel waits */
uniform usampler2D t_state;
uniform usampler2D t_found;
uniform usampler2D t_inside;
uniform usampler2D t_inside_more;
uniform usampler2D t_facts;    /* per operand: bit, first product, products, solid; 256 a row */
uniform usampler2D t_products; /* per product: kept and taken away, two texels each; 64 products a row */
uniform float u_solid_range;
layout(location = 0) out uvec4 out_state; /* depth share and key of the last fragment; key and normal of the owner. The owner's plane bits: 1 there is
                                           * one, 2 the solid held before the group */
layout(location = 1) out uvec4 out_inside;
layout(location = 2) out uvec4 out_inside_more;
layout(location = 3) out uvec4 out_found; /* 1, eye depth, key, normal */

const uint OWNED = 1u, HELD = 2u;

uvec4 facts_of(uint key)
{
    int operand = int(key >> 16 & 0x3FFFu) - 1;
    return texelFetch(t_facts, ivec2(operand & 255, operand >> 8), 0);
}

/* Does the solid hold where these operands do? */
bool solid_at(uvec4 facts, uvec4 low, uvec4 high)
{
    bool value = false;
    int product = int(facts.y), end = int(facts.y + facts.z);
    while (product < end) {
        ivec2 at = ivec2(4 * (product & 63), product >> 6);
        uvec4 kept = texelFetch(t_products, at, 0), kept_more = texelFetch(t_products, at + ivec2(1, 0), 0);
        uvec4 taken = texelFetch(t_products, at + ivec2(2, 0), 0), taken_more = texelFetch(t_products, at + ivec2(3, 0), 0);
        uvec4 wrong = (kept & ~low) | (taken & low) | (kept_more & ~high) | (taken_more & high);
        value = value || wrong == uvec4(0u);
        product++;
    }
    return value;
}

void go_through(uvec4 facts, inout uvec4 low, inout uvec4 high)
{
    uint bit = facts.x & 127u;
    uvec4 mask = uvec4(equal(uvec4(bit >> 5), uvec4(0u, 1u, 2u, 3u))) * (1u << (bit & 31u));
    low ^= facts.x < 128u ? mask : uvec4(0u);
    high ^= facts.x < 128u ? uvec4(0u) : mask;
}

#ifdef AROUND_EYE
void toggle_only()
{
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec4 fragment = texelFetch(t_fragment, at, 0), low = texelFetch(t_inside, at, 0), high = texelFetch(t_inside_more, at, 0);
    bool some = fragment.z != 0u;
    if (some)
        go_through(facts_of(fragment.z), low, high);
    out_state = some ? uvec4(fragment.yz, 0u, 0u) : texelFetch(t_state, at, 0);
    out_inside = low;
    out_inside_more = high;
    out_found = uvec4(0u);
}
#endif

void main()
{
#ifdef AROUND_EYE
    /* What is gone through an odd number of times was around the eye: only the bits are wanted. */
    toggle_only();
    return;
#endif
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec4 fragment = texelFetch(t_fragment, at, 0), state = texelFetch(t_state, at, 0), found = texelFetch(t_found, at, 0);
    uvec4 low = texelFetch(t_inside, at, 0), high = texelFetch(t_inside_more, at, 0);
    bool waits = found.z != 0u, some = fragment.z != 0u;
    uvec4 own = facts_of(some ? fragment.z : 0x10000u), last = facts_of(state.y != 0u ? state.y : 0x10000u);
    uint plane = fragment.y == 0u ? 0xFFFFu : fragment.z & 0xFFFFu, last_plane = state.x == 0u ? 0xFFFFu : state.y & 0xFFFFu;
    bool same = some && state.y != 0u && plane != 0u && plane == last_plane && fragment.y == state.x && own.w == last.w;
    if (!waits && !same) {
        bool now = state.y != 0u && solid_at(last, low, high);
        bool changed = now != ((state.z & HELD) != 0u) && (state.z & OWNED) != 0u && state.x != 0u;
        if (changed && ((state.z & 0x80000000u) != 0u) == now)
            found = uvec4(1u, floatBitsToUint(uintBitsToFloat(state.x) * u_solid_range), (state.z & 0xFFFF0000u) | (state.y & 0xFFFFu), state.w);
        state.zw = uvec2(now ? HELD : 0u, 0u);
        waits = found.z != 0u;
        if (some && !waits)
            state.z = solid_at(own, low, high) ? HELD : 0u;
    }
    if (!waits && some) {
        bool before = solid_at(own, low, high);
        go_through(own, low, high);
        if (solid_at(own, low, high) != before)
            state.zw = uvec2((fragment.z & 0xFFFF0000u) | OWNED | (state.z & HELD), fragment.w);
        state.xy = fragment.yz;
    }
    out_state = state;
    out_inside = low;
    out_inside_more = high;
    out_found = found;
}
