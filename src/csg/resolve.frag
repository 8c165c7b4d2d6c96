/* Which fragments are surfaces of the solids: the pixel's list is walked from front to back, in rounds of the nearest few, and with each
 * fragment an operand is entered or left and the terms above it are counted. Where a whole tree's value changes, there is the surface.
 * Fragments at the same depth in one plane are one event: the state before and after them decides, so that flush unions have no
 * wall inside and flush cuts leave no skin. The one of them at which the whole changes, in the order of their keys, gives the surface. Roth 1982, per pixel; Nienhaus et al. 2006, 5.1; rows K02, K03, C3, C5, C6. */
layout(std430, binding = 3) readonly buffer heads_block { uint heads[]; };
layout(std430, binding = 4) readonly buffer nodes_block { uvec4 nodes[]; };
layout(std430, binding = 6) readonly buffer program_block { uvec2 links[]; };
#ifndef FIRST_ONLY
layout(std430, binding = 5) buffer count_block { uint node_count; uint layer_count; };
layout(std430, binding = 7) writeonly buffer chain_block { uint chain[]; }; /* per node: the next surface behind */
#endif

#include "csg/depth.glsl"

uniform vec4 u_list_box;
uniform uint u_operand_count;
layout(location = 0) out uvec4 out_surface; /* of the nearest: the next behind, depth, key, normal; all 0 where there is none */

const uint FAR = 0xFFFFFFFFu; /* deeper than any depth */
uniform uint u_beyond; /* the far plane, behind which nothing of the solids lies */

uint inside[OPERAND_WORDS];
#if TERMS > 0
int held[TERMS]; /* operands of each term that hold, more than when nothing is there */
#endif

/* Goes through the operand's surface. Returns whether the whole tree changes, to `value`. */
bool go_through(uint operand, out bool value)
{
    uint bit = 1u << (operand & 31u), word = inside[operand >> 5] ^ bit;
    inside[operand >> 5] = word;
    value = (word & bit) != 0u;
    uint link = links[operand].x;
#if TERMS > 0
    while (link != 0u) {
        uint term = (link >> 1) - 1u;
        uvec2 above = links[u_operand_count + term];
        bool more = value != ((link & 1u) != 0u);
        int before = held[term], after = before + (more ? 1 : -1), need = int(above.y);
        held[term] = after;
        value = after >= need;
        if (value == (before >= need))
            return false;
        link = above.x;
    }
#endif
    return true;
}

/* Fragments of one plane at one depth, or a single one. */
uint group_depth, group_key; /* key: plane and solid */
uint group_changes;
uint group_owner; /* the node at which the solid last changed */
bool group_fits;  /* its face looks the way the solid changed */

uint first_surface, last_surface, surface_count;

void add_surface(uint owner)
{
#ifndef FIRST_ONLY
    if (last_surface != 0u)
        chain[last_surface - 1u] = owner;
    last_surface = owner;
    surface_count++;
#endif
    if (first_surface == 0u)
        first_surface = owner;
}

/* At outlines, rounding can put the back of an operand before its front: a solid that begins with a back and ends with a front right behind
 * it is not there. */
uint odd_owner, odd_depth;
const uint ROUNDING = 64u; /* steps of a float */

void end_group()
{
    bool changed = (group_changes & 1u) != 0u && group_depth != 0u;
    bool sliver = changed && !group_fits && odd_owner != 0u && group_depth - odd_depth <= ROUNDING;
    group_changes = 0u;
    if (changed && odd_owner != 0u && !sliver)
        add_surface(odd_owner);
    odd_owner = changed && !group_fits && !sliver ? group_owner : changed ? 0u : odd_owner;
    odd_depth = group_depth;
    if (changed && group_fits)
        add_surface(group_owner);
}

void take(uint depth, uint key, uint node)
{
    uint operand = (key >> 16 & 0x3FFFu) - 1u, plane = key & 0xFFFFu;
    /* What lies before the near plane comes at once: only what holds behind it counts. */
    plane = depth == 0u ? 0xFFFFu : plane;
    uint own = links[operand].y << 16 | plane;
    if (plane == 0u || depth != group_depth || own != group_key) {
        end_group();
        group_depth = depth;
        group_key = own;
    }
    bool value;
    bool changes = go_through(operand, value);
    group_changes += changes ? 1u : 0u;
    group_owner = changes ? node : group_owner;
    bool begins = (key & 0x80000000u) != 0u;
    group_fits = changes ? begins == value : group_fits;
}

/* The nearest KEPT fragments behind (depth, key, node), in order. */
uint depths[KEPT], keys[KEPT], kept[KEPT];

void sort_nearest(uint head, uint least_depth, uint least_key, uint least_node)
{
    for (int k = 0; k < KEPT; k++) {
        depths[k] = FAR;
        keys[k] = FAR;
        kept[k] = FAR;
    }
    uint i = head;
    while (i != 0u) {
        uvec4 node = nodes[i - 1u];
        uint depth = node.y, key = node.z, mine = i;
        bool behind = depth > least_depth || (depth == least_depth && (key > least_key || (key == least_key && mine > least_node)));
        depth = behind ? depth : FAR;
        for (int k = 0; k < KEPT; k++) {
            bool nearer = depth < depths[k] || (depth == depths[k] && (key < keys[k] || (key == keys[k] && mine < kept[k])));
            uint d = depths[k], y = keys[k], n = kept[k];
            depths[k] = nearer ? depth : d;
            keys[k] = nearer ? key : y;
            kept[k] = nearer ? mine : n;
            depth = nearer ? d : depth;
            key = nearer ? y : key;
            mine = nearer ? n : mine;
        }
        i = node.x;
    }
}

#ifdef EYE_MAY_BE_INSIDE
/* What is entered and never left, or left and never entered, was around the eye already. */
void start_inside(uint head)
{
    uint i = head;
    while (i != 0u) {
        uvec4 node = nodes[i - 1u];
        bool value;
        go_through((node.z >> 16 & 0x3FFFu) - 1u, value);
        i = node.x;
    }
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy) - ivec2(u_list_box.xy);
    uint head = heads[pixel.y * int(u_list_box.z) + pixel.x];
    for (int k = 0; k < OPERAND_WORDS; k++)
        inside[k] = 0u;
#if TERMS > 0
    for (int k = 0; k < TERMS; k++)
        held[k] = 0;
#endif
    group_depth = FAR;
    group_key = 0u;
    group_changes = 0u;
    group_owner = odd_owner = odd_depth = 0u;
    group_fits = true;
    first_surface = last_surface = surface_count = 0u;
#ifdef EYE_MAY_BE_INSIDE
    start_inside(head);
#endif
    uint least_depth = 0u, least_key = 0u, least_node = 0u;
    uint open = head;
    while (open != 0u) {
        sort_nearest(open, least_depth, least_key, least_node);
        bool full = depths[KEPT - 1] < u_beyond;
        while (depths[0] < u_beyond) {
            least_depth = depths[0];
            least_key = keys[0];
            least_node = kept[0];
            for (int k = 0; k < KEPT - 1; k++) {
                depths[k] = depths[k + 1];
                keys[k] = keys[k + 1];
                kept[k] = kept[k + 1];
            }
            depths[KEPT - 1] = FAR;
            take(least_depth, least_key, least_node);
#ifdef FIRST_ONLY
            depths[0] = first_surface != 0u ? FAR : depths[0];
#endif
        }
        open = full ? head : 0u;
#ifdef FIRST_ONLY
        open = first_surface != 0u ? 0u : open;
#endif
    }
    end_group();
    if (odd_owner != 0u)
        add_surface(odd_owner);
    uvec4 surface = uvec4(0u);
    uint found = first_surface;
    while (found != 0u) {
        surface = nodes[found - 1u];
        found = 0u;
    }
#ifndef FIRST_ONLY
    surface.x = first_surface;
    if (last_surface != 0u)
        chain[last_surface - 1u] = 0u;
    if (surface_count > layer_count)
        atomicMax(layer_count, surface_count);
#endif
#ifdef DEPTH_TESTED
    gl_FragDepth = first_surface != 0u ? clamp(window_depth_at(eye_depth_of(surface.y)), 0.0, 1.0) : 1.0;
#endif
    out_surface = surface;
}
