/* The geometry pass: writes those channels of the G-buffer that the figure needs, each where the prelude places it. */
#include "light/point.glsl"
#ifdef SOLID
#include "csg/surface.glsl"
#define IS_FRONT surface_front
#define WINDOW_DEPTH surface_depth
#define DEPTH_ROUNDING 1e-6 /* computed, not interpolated */
#else
#include "layer/material.glsl"
#define IS_FRONT gl_FrontFacing
#define WINDOW_DEPTH gl_FragCoord.z
#define DEPTH_ROUNDING 0.0
#endif
#if (defined(CUT_FACE) || (defined(SOLID) && defined(HAS_CUT))) && defined(AT_SHADE)
#include "light/cut.glsl"
#endif

#ifdef AT_NORMAL_DEPTH
layout(location = AT_NORMAL_DEPTH) out vec4 out_normal_depth;
#endif
#if defined(AT_ID) || defined(INTO_LISTS) || defined(CUT_FACE) || defined(ENLARGED) || defined(SOLID)
#ifdef HAS_FACTS
#define u_part_id v_own.x
#else
uniform uint u_part_id;
#endif
uniform uint u_surface_id;
#endif
#ifdef AT_ID
layout(location = AT_ID) out uvec2 out_id;
#endif
#ifdef AT_DETAIL
layout(location = AT_DETAIL) out vec4 out_detail;
#endif
#ifdef AT_ALBEDO
#ifdef INTO_LISTS
vec4 out_albedo;
#else
layout(location = AT_ALBEDO) out vec4 out_albedo;
#endif
#endif
#ifdef AT_REST
layout(location = AT_REST) out vec4 out_rest;
#endif
#ifdef AT_VELOCITY
layout(location = AT_VELOCITY) out vec4 out_velocity;
#include "layer/moved.glsl"
#endif
#ifdef AT_SHADE
#ifdef INTO_LISTS
vec4 out_shade;
#else
layout(location = AT_SHADE) out vec4 out_shade;
#endif
#endif
#if defined(AT_SHADE) || defined(AT_ALBEDO)
uniform int u_unlit;
#endif
#ifdef PEELED
uniform sampler2D  t_before_depth; /* of the layer in front, with its ids */
uniform usampler2D t_before_id;
#endif
#ifdef INTO_LISTS
#include "layer/lists.glsl"
#endif
#ifdef CLIPPED
uniform vec4 u_clip_plane; /* eye space; what lies below is left out */
#endif

#ifdef LAYERED
/* The depth buffer's: at the near plane, rounding gives numbers below 0. */
float stored_depth()
{
    return clamp(WINDOW_DEPTH, 0.0, 1.0);
}

#include "layer/order.glsl"
#endif

#ifdef HAS_PATCHES
#include "layer/patch.glsl"

/* Is the position outside its patch's outline? src/field/lapped.h; the number of a patch is the same at all its corners. */
bool outside_patch()
{
    float outline = patch_outline(atan(v_patch.y, v_patch.x), floor(v_patch.w + 0.5));
    return v_patch.z < 0.5 && length(v_patch.xy) > outline * u_patch_radius;
}
#endif

#if defined(AT_SHADE) && defined(HAS_DEPTH_CUE)
#include "light/depth_cue.glsl"
#endif
#if defined(INKED) && defined(HAS_FOCUS)
#include "light/focus.glsl"
#endif

/* Where a fragment has left, its neighbours' derivatives are undefined, and with them the textures they read: so it stays to the end. Lanes of some software drivers stay
 * anyway, and there leaving at once saves work. */
#ifdef LANES_STAY
#define LEAVE_IF(condition) if (condition) discard
#else
bool leaves = false;
#define LEAVE_IF(condition) leaves = (condition) || leaves
#endif

void main()
{
#ifdef HAS_PATCHES
    LEAVE_IF(outside_patch());
#endif
#ifdef SOLID
    LEAVE_IF(!fetch_surface(u_part_id));
    gl_FragDepth = surface_depth;
    uint surface_id = (u_surface_id & ~SURFACE_INDEX_MASK) | surface_operand;
#elif defined(AT_ID) || defined(INTO_LISTS) || defined(CUT_FACE) || defined(LAYERED)
    uint surface_id = u_surface_id;
#endif
#ifdef LAYERED
    uvec2 id = uvec2(u_part_id, surface_id | (IS_FRONT ? 0u : SURFACE_BACK));
#endif
#ifdef PEELED
    ivec2 at = ivec2(gl_FragCoord.xy);
    float before = texelFetch(t_before_depth, at, 0).r;
    float depth = stored_depth();
    LEAVE_IF(depth < before);
    int same = depth == before ? 1 : 0;
    bool had = false;
    for (int once = 0; once < same; once++)
        had = order_of(id) <= order_of(texelFetch(t_before_id, at, 0).rg);
    LEAVE_IF(had);
#endif
#ifdef CLIPPED
    LEAVE_IF(dot(u_clip_plane.xyz, v_eye) + u_clip_plane.w < 0.0);
#endif
#ifdef MERGED
    /* Early z reject by hand: only what the first pass left visible goes through edge detection. */
    LEAVE_IF(WINDOW_DEPTH > texelFetch(t_depth, ivec2(gl_FragCoord.xy), 0).r + DEPTH_ROUNDING);
#endif
    vec4 albedo = model_colour();
#ifdef CUT_OUT
    LEAVE_IF(albedo.a < u_alpha_cutoff);
#endif
#ifdef CUT_FACE
    float alpha = 1.0;
#else
    float alpha = albedo.a;
#endif
    albedo.a = 1.0;
    vec3 normal = model_normal();
#if defined(AT_SHADE) || defined(DEFERRED)
    /* Lit from the side that is seen: the flat normal decides which that is, so that rims of smooth shapes never flip. */
#ifdef SOLID
    bool turned = !surface_front;
#else
    vec3 facing = cross(dFdx(v_eye), dFdy(v_eye));
    facing *= sign(-dot(facing, u_perspective > 0.5 ? v_eye : vec3(0.0, 0.0, -1.0)));
    bool turned = dot(facing, normal) < 0.0;
#endif
#endif
#ifdef SHELL
    /* By normals and not by the way round of corners, which differs between files. */
    LEAVE_IF(!turned);
#endif
#ifdef AT_NORMAL_DEPTH
#ifdef ENLARGED
    out_normal_depth = vec4(normal.xy, float(u_part_id), -v_eye.z);
#else
    out_normal_depth = vec4(normal, -v_eye.z);
#endif
#endif
#ifdef AT_ID
#ifdef LAYERED
    out_id = id;
#else
    out_id = uvec2(u_part_id, surface_id);
#endif
#ifdef DEFERRED
    if (turned)
        out_id.g |= SURFACE_TURNED;
#endif
#endif
#ifdef AT_ALBEDO
    out_albedo = vec4(albedo.rgb, u_unlit != 0 ? ALBEDO_UNLIT : albedo.a);
#endif
#ifdef AT_DETAIL
#ifdef HAS_WALLS
    out_detail = surface_detail();
#else
    out_detail = vec4(0.0);
#endif
#endif
#ifdef AT_VELOCITY
    write_moved(v_eye);
#endif
#ifdef AT_REST
#ifdef HAS_REST
    out_rest = vec4(v_rest, 1.0);
#else
    out_rest = vec4(0.0);
#endif
#endif
#ifdef AT_SHADE
#ifdef CUT_FACE
    out_shade = cut_colour(ivec2(gl_FragCoord.xy), uvec2(u_part_id, surface_id), albedo.rgb);
#else
#ifdef HAS_UV
#ifdef HAS_BASE_TEXTURE
    s_uv = moved_uv(u_base_matrix, u_base_offset);
#else
    s_uv = v_uv0;
#endif
#ifdef HAS_UV1
    s_uv_unique = v_uv1;
#else
    s_uv_unique = v_uv0;
#endif
#endif
#ifdef SOLID
    vec3 face = turned ? -normal : normal;
#else
    vec3 face = normalize(facing);
#endif
    out_shade = surface_colour(surface_point(v_eye, turned ? -normal : normal, face, albedo, u_unlit != 0, 0u));
#ifdef HAS_DEPTH_CUE
    out_shade = depth_cued(out_shade, -v_eye.z);
#endif
#if defined(SOLID) && defined(HAS_CUT)
    if (surface_is_cut)
        out_shade = cut_colour(ivec2(gl_FragCoord.xy), uvec2(u_part_id, surface_id), albedo.rgb);
#endif
#endif
#ifdef MERGED
    detect_edges();
#endif
#ifdef INKED
    vec4 ink = ink_at(floor(gl_FragCoord.xy));
#ifdef HAS_FOCUS
    ink *= in_focus(-v_eye.z);
#endif
    out_shade = over(ink, out_shade);
#endif
#ifdef LAYERED
    out_shade *= alpha;
#endif
#endif
#ifndef LANES_STAY
    if (leaves)
        discard;
#endif
#ifdef INTO_LISTS
    vec4 shade = vec4(0.0), unlit = vec4(0.0);
#ifdef AT_SHADE
    shade = out_shade;
#endif
#ifdef AT_ALBEDO
    unlit = out_albedo;
#endif
    list_add(id, stored_depth(), -v_eye.z, normal, shade, unlit);
#endif
}
