/* The shadow that the first light throws on the ground, as a tone or as strokes; and a line along its border. Nienhaus 2005, section 4.8: shadows with their edges. */
#include "light/ground_plane.glsl"
#include "light/shadow.glsl"

uniform float u_ground_strength;
uniform vec4  u_ground_colour;
uniform float u_ground_edge;    /* width of the line, pixels */
uniform vec3  u_shadow_light;   /* towards it, eye space */
uniform float u_shadow_nearest; /* nothing is nearer to the light */
uniform float u_cone;           /* half the light's width at distance 1; both in the map's units */
#ifdef SHADED
/* As light/ground_buffer.frag: for a technique that draws it. */
uniform uint u_ground_part;
layout(location = 0) out vec4  out_normal_depth;
layout(location = 1) out uvec4 out_id;
layout(location = 2) out vec4  out_albedo;
const float FAINTEST = 0.03; /* as there */
#else
layout(location = 0) out vec4 out_0;
#endif

#ifdef SOFT
const int  SEARCHED = 24, COMPARED = 48;
const mat2 GOLDEN = mat2(-0.7373688, 0.6754903, -0.6754903, -0.7373688); /* by the angle that leaves no gaps */

/* How far before a place of the map something is; 0: nothing is. */
float before(vec3 position, vec2 offset)
{
    ivec2 texel = clamp(ivec2((position.xy + offset) / u_shadow_texel.x), ivec2(0), textureSize(t_shadow, 0) - 1);
    float nearest = texelFetch(t_shadow, texel, 0).r;
    return nearest < 1.0 ? max(position.z - nearest, 0.0) : 0.0;
}

/* What is in the way within the cone to the light says how wide the border is (Fernando 2005); then how much of that width is free. */
float lit_at(vec3 eye)
{
    vec3 at = (u_shadow_from_eye * vec4(eye, 1.0)).xyz;
    float reach = clamp((at.z - u_shadow_nearest) * u_cone, 0.0, 0.25), found = 0.0, sum = 0.0, lit = float(COMPARED);
    vec2 direction = vec2(1.0, 0.0);
    for (int i = 0; i < SEARCHED; i++) {
        float above = before(at, direction * (reach * sqrt((float(i) + 0.5) / float(SEARCHED))));
        found += above > 1e-5 ? 1.0 : 0.0;
        sum += above;
        direction = GOLDEN * direction;
    }
    float radius = max(sum / max(found, 1.0) * u_cone, 0.7 * u_shadow_texel.x);
    int compared = found > 0.0 ? COMPARED : 0;
    for (int i = 0; i < compared; i++) {
        lit -= before(at, direction * (radius * sqrt((float(i) + 0.5) / float(COMPARED)))) > 1e-5 ? 1.0 : 0.0;
        direction = GOLDEN * direction;
    }
    return lit / float(COMPARED);
}
/* How much of the light is kept off. */
float dark_at(vec2 pixel)
{
    vec4 eye = on_ground(pixel);
    return eye.w > 0.0 ? 1.0 - lit_at(eye.xyz) : 0.0;
}
#else
uniform sampler2D t_ground_dark; /* light/ground_dark.frag */

float dark_at(vec2 pixel)
{
    vec2 at = pixel - 0.5, low = floor(at), part = at - low;
    ivec2 first = ivec2(low), last = ivec2(u_size) - 1;
    float a = texelFetch(t_ground_dark, clamp(first, ivec2(0), last), 0).r, b = texelFetch(t_ground_dark, clamp(first + ivec2(1, 0), ivec2(0), last), 0).r;
    float c = texelFetch(t_ground_dark, clamp(first + ivec2(0, 1), ivec2(0), last), 0).r, d = texelFetch(t_ground_dark, clamp(first + 1, ivec2(0), last), 0).r;
    return mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
}
#endif

#ifdef FADING
uniform sampler2D t_ground_height; /* light/ground_height.frag, spread */
uniform mat4      u_ground_from_eye;
uniform float     u_ground_fade;

float near_at(vec2 pixel)
{
    vec2 found = textureLod(t_ground_height, (u_ground_from_eye * vec4(on_ground(pixel).xyz, 1.0)).xy, 0.0).rg;
    return found.r / max(found.g, 1e-3);
}

/* What of the shadow is left, by the height of what throws it. */
float left_at(vec2 pixel)
{
    float near = near_at(pixel);
#ifdef FLAT
    vec2 slope = vec2(near_at(pixel + vec2(1.0, 0.0)), near_at(pixel + vec2(0.0, 1.0))) - near;
    near = clamp((near - 0.5) / max(length(slope), 1e-5) + 0.5, 0.0, 1.0);
#endif
    return mix(1.0, near, u_ground_fade);
}

#if !defined(FLAT) && !defined(SOFT)
bool may_be_dark(float dark)
{
    return dark > 0.0 || texelFetch(t_ground_dark, clamp(ivec2(gl_FragCoord.xy), ivec2(0), ivec2(u_size) - 1), 0).b > 0.0;
}

/* The farther what throws it, the softer its border. */
float softened(float dark, float left)
{
    float spread = texelFetch(t_ground_dark, clamp(ivec2(gl_FragCoord.xy), ivec2(0), ivec2(u_size) - 1), 0).b;
    return mix(dark, spread, clamp(1.6 * (1.0 - left), 0.0, 1.0));
}
#else
#define HARD
#endif
#else
#define HARD
float left_at(vec2 pixel)
{
    return 1.0;
}
#endif

#ifdef HARD
bool may_be_dark(float dark)
{
    return dark > 0.0;
}

float softened(float dark, float left)
{
    return dark;
}
#endif

/* How much of the pixel the line along the border covers. The share of a ring around it that is lit tells how far the border is. */
float edge_at(vec2 pixel)
{
    const int ROUND = 16;
    float radius = 0.5 * u_ground_edge + 1.0, lit = 0.0;
    for (int i = 0; i < ROUND; i++) {
        float angle = 6.2831853 * (float(i) + 0.5) / float(ROUND);
        lit += 1.0 - dark_at(pixel + radius * vec2(cos(angle), sin(angle)));
    }
    float off = abs(radius * cos(3.14159265 * lit / float(ROUND)));
    bool border = lit > 0.02 * float(ROUND) && lit < 0.98 * float(ROUND);
    return border ? clamp(0.5 * u_ground_edge - off + 0.5, 0.0, 1.0) : 0.0;
}

#ifdef HATCHED
#include "gpu/hash.glsl"

uniform float u_ground_hatch; /* distance of the strokes, pixels */
uniform vec2  u_ground_along; /* which way they run on the page */

/* A number −1 … 1 of one stroke. */
float of_stroke(int stroke, int which)
{
    return corner_noise(hash_of(uvec3(uint(stroke + 0x8000), uint(which + 0x8000), 0u), 7u)).x;
}

/* The same, going over into others along the stroke. */
float along_stroke(int stroke, float along)
{
    int   last = int(floor(along));
    float part = along - floor(along);
    return mix(of_stroke(stroke, last), of_stroke(stroke, last + 1), part * part * (3.0 - 2.0 * part));
}

#ifndef SOFT
/* That of the pixel alone. */
float dark_once(vec2 pixel)
{
    return texelFetch(t_ground_dark, clamp(ivec2(pixel), ivec2(0), ivec2(u_size) - 1), 0).r;
}
#endif

/* How much of the shadow there is along the stroke around here, of which `dark` is there: strokes taper where it ends. */
float fullness_at(vec2 pixel, float dark)
{
#ifdef SOFT
    return dark;
#else
    const int STEPS = 4;
    float sum = dark;
    for (int i = 1; i <= STEPS; i++) {
        vec2 off = u_ground_along * (3.0 * u_ground_hatch * float(i) / float(STEPS));
        sum += dark_once(pixel + off) + dark_once(pixel - off);
    }
    return clamp(2.0 * sum / float(2 * STEPS + 1) - 1.0, 0.0, 1.0);
#endif
}

/* Where the shadow fades strokes end, one after the other, each by itself and together with those beside it. */
float runs_out(int stroke, float along, float left)
{
#ifdef FADING
    float group = along_stroke(0x5000, float(stroke) / 5.0), own = of_stroke(stroke, 0x7003);
    float bound = 0.5 + 0.3 * own + 0.12 * group + 0.08 * along_stroke(stroke + 0x2000, 0.3 * along);
    return smoothstep(-0.16, 0.1, left - bound);
#else
    return 1.0;
#endif
}

/* Strokes whose breadth is the shadow's darkness, which nothing but a hand makes uneven; where it is full they leave nothing between. */
float strokes_at(vec2 pixel)
{
#ifndef SOFT
    if (dark_once(pixel) <= 0.0) /* cheap, and most of the page; what is lost is half a pixel at the border of a stroke */
        return 0.0;
#endif
    float dark = dark_at(pixel);
    vec2 from = pixel - u_anchor;
    float along = dot(from, u_ground_along) / u_ground_hatch, across = dot(from, vec2(-u_ground_along.y, u_ground_along.x)) / u_ground_hatch;
    float free = 1.0 - u_ground_strength, covered = 0.0, fullness = fullness_at(pixel, dark), left = left_at(pixel);
    int middle = int(floor(across));
    for (int stroke = middle - 1; stroke <= middle + 1 && fullness > 0.0; stroke++) {
        float sway = free * (0.32 * of_stroke(stroke, 0x7000) + 0.3 * along_stroke(stroke, 0.05 * along));
        float ends = 1.5 + 0.5 * of_stroke(stroke, 0x7001); /* some run out sooner than others */
        float breadth = u_ground_strength * clamp(fullness * ends - (ends - 1.0) * free, 0.0, 1.0);
        breadth *= 1.0 + free * (0.35 * of_stroke(stroke, 0x7002) + 0.45 * along_stroke(stroke + 0x1000, 0.08 * along));
        breadth *= runs_out(stroke, along, left);
        float inside = 0.5 * breadth - abs(across - float(stroke) - 0.5 - sway);
        covered += clamp(inside * u_ground_hatch + 0.5, 0.0, min(breadth * u_ground_hatch, 1.0));
    }
    return min(covered, 1.0);
}
#endif

void main()
{
#ifdef HATCHED
    float shade = strokes_at(gl_FragCoord.xy);
#else
    float dark = dark_at(gl_FragCoord.xy), shade = 0.0;
    int   there = may_be_dark(dark) ? 1 : 0;
    for (int once = 0; once < there; once++) { /* a loop is left, where a condition would be computed both ways */
        float left = left_at(gl_FragCoord.xy);
        shade = u_ground_strength * softened(dark, left) * left;
    }
#endif
#ifdef EDGED
    shade = max(shade, edge_at(gl_FragCoord.xy));
#endif
#ifdef STROKED
    shade = max(shade - FAINTEST, 0.0) / (1.0 - FAINTEST);
#endif
#ifdef SHADED
    if (shade <= 0.0)
        discard;
    out_normal_depth = vec4(u_ground_plane.xyz, -on_ground(gl_FragCoord.xy).z);
    out_id = uvec4(u_ground_part, 0u, 0u, 0u);
    out_albedo = vec4(u_ground_colour.rgb, 1.0 - u_ground_colour.a * shade);
#else
    out_0 = vec4(u_ground_colour.rgb, 1.0) * (u_ground_colour.a * shade);
#endif
}
