/* How much light arrives at each position of a small picture: of the first light, which is a disc, and of the sky. The pattern of samples turns from
 * pixel to pixel; light/visibility_blur.frag averages over exactly its period, four by four. */
#include "light/visibility.glsl"

uniform sampler2D t_depth;        /* of the whole scene */
uniform vec4      u_depth_terms;  /* eye depth = (x + y z) / (z + w z) */
uniform vec2      u_slope;        /* from steps of depth between pixels to the normal */
layout(location = 0) out vec4 out_fraction;  /* of the light; of the sky; eye depth; radius of the penumbra in pixels */
layout(location = 1) out vec4 out_normal;

const float NOTHING = 1.0; /* the depth of what is empty */
ivec2 last;                /* pixel */

float depth_at(ivec2 pixel)
{
    return texelFetch(t_depth, clamp(pixel, ivec2(0), last), 0).r;
}

vec3 eye_at(ivec2 pixel, float depth)
{
    return on_ray(ray_of(vec2(pixel) + 0.5), (u_depth_terms.x + u_depth_terms.y * depth) / (u_depth_terms.z + u_depth_terms.w * depth));
}

/* The step of depth to the next pixel along one axis, from the side where the surface runs on: depth is linear in the picture. */
float depth_step(ivec2 pixel, ivec2 axis, float own, bool only_before, bool only_behind)
{
    float before = depth_at(pixel - axis), behind = depth_at(pixel + axis);
    float bent_before = abs(2.0 * before - depth_at(pixel - 2 * axis) - own), bent_behind = abs(2.0 * behind - depth_at(pixel + 2 * axis) - own);
    return only_before || (bent_before < bent_behind && !only_behind) ? own - before : behind - own;
}

/* Of the flat surface, towards the viewer. */
vec3 normal_at(ivec2 pixel, float own, vec3 eye)
{
    vec2 steps = vec2(depth_step(pixel, ivec2(1, 0), own, pixel.x > last.x - 1, pixel.x < 1),
                      depth_step(pixel, ivec2(0, 1), own, pixel.y > last.y - 1, pixel.y < 1)) * u_slope;
    return normalize(vec3(-steps, u_perspective > 0.5 ? -1.0 / eye.z - dot(steps, eye.xy) / -eye.z : 1.0));
}

#ifdef HAS_SOFT_SHADOW
uniform mat4  u_shadow_from_eye;
uniform vec2  u_shadow_texel;   /* side of a texel: of the map, and in eye space */
uniform float u_shadow_depth;   /* what the map's depth 0 … 1 is in eye space */
uniform float u_shadow_nearest; /* nothing is nearer to the light */
uniform float u_cone;           /* half the light's width at distance 1; both in the map's units */

const int SEARCHED = 12, COMPARED = 16;
const mat2 GOLDEN = mat2(-0.7373688, 0.6754903, -0.6754903, -0.7373688); /* by the angle that leaves no gaps */

vec2 turned_by(float turns)
{
    return vec2(cos(6.2831853 * turns), sin(6.2831853 * turns));
}

/* The texel of the map at an offset: 1 when it is before the surface's own plane; how far to the side; how far before the position. */
vec3 in_the_way(vec3 position, vec2 offset, vec2 rise, float bias, float lean)
{
    ivec2 texel = clamp(ivec2((position.xy + offset) / u_shadow_texel.x), ivec2(0), textureSize(t_shadow, 0) - 1);
    vec2 off = (vec2(texel) + 0.5) * u_shadow_texel.x - position.xy;
    float above = position.z - texelFetch(t_shadow, texel, 0).r, aside = length(off);
    return vec3(above + dot(rise, off) > bias + lean * aside ? 1.0 : 0.0, aside, above);
}

/* Fraction of the light's disc that is seen, and the radius of the penumbra in eye space; 0: nothing is in the way. */
vec2 light_fraction(vec3 eye, vec3 normal, float turns, float jitter)
{
    vec3 position = (u_shadow_from_eye * vec4(eye, 1.0)).xyz;
    vec3 across = mat3(u_shadow_from_eye) * normal;
    float width = u_shadow_texel.y / u_shadow_texel.x, ratio = width / u_shadow_depth;
    /* The surface's own plane, as depth over the map: only what is before it is in the way. */
    float facing = across.z * u_shadow_depth;
    vec2 rise = -across.xy * width / (abs(facing) > 0.03 ? facing : facing < 0.0 ? -0.03 : 0.03) * ratio;
    float steep = dot(rise, rise) / (ratio * ratio);
    float bias = u_shadow_texel.x * ratio * (0.6 + 0.3 * sqrt(steep)), lean = ratio * 0.002 * (1.0 + steep);
    float reach = clamp((position.z - u_shadow_nearest) * u_cone, 0.0, 0.25);
    vec2 direction = turned_by(turns);
    float found = 0.0, sum = 0.0;
    for (int i = 0; i < SEARCHED; i++) {
        /* Densest in the middle, where what is near and thin is. */
        float fraction = (float(i) + jitter) / float(SEARCHED), radius = i > 0 ? reach * fraction * fraction : 0.0;
        vec3 here = in_the_way(position, direction * radius, rise, bias, lean);
        float hides = here.x * (here.y <= here.z * u_cone + 0.75 * u_shadow_texel.x ? fraction * fraction * fraction + 1e-3 : 0.0);
        found += hides;
        sum += hides * here.z;
        direction = GOLDEN * direction;
    }
    float between = sum / max(found, 1e-12);
    float radius = max(between * u_cone, 0.7 * u_shadow_texel.x), lit = float(COMPARED);
    /* What the average over pixels adds to the width is left out here. */
    float added = pixel_size(-eye.z) / width, compared_in = radius * sqrt(max(1.0 - 1.2 * added * added / (radius * radius), 0.4));
    int compared = found > 0.0 ? COMPARED : 0;
    for (int i = 0; i < compared; i++) {
        vec3 here = in_the_way(position, direction * (compared_in * sqrt((float(i) + jitter) / float(COMPARED))), rise, bias, lean);
        lit -= here.x * (here.y <= 2.0 * here.z * u_cone + 1.5 * u_shadow_texel.x ? 1.0 : 0.0);
        direction = GOLDEN * direction;
    }
    return vec2(lit / float(COMPARED), found > 0.0 ? radius * width : 0.0);
}
#endif

#ifdef HAS_OCCLUSION
uniform float u_radius; /* what stands farther off hides nothing; eye space */

const int STEPS = 4;

/* Polynomial: exact within 1e-4. */
float angle_of(float cosine)
{
    float x = abs(cosine);
    float angle = sqrt(max(1.0 - x, 0.0)) * (1.5707288 + x * (-0.2121144 + x * (0.0742610 - 0.0187293 * x)));
    return cosine < 0.0 ? 3.14159265 - angle : angle;
}

/* Light of the sky between the view direction and an angle from it, in a slice through it; the sky counts by the cosine to the normal. `normal`:
 * of the normal in the slice, along the view direction and across. */
float sky_below(float cosine, vec2 normal)
{
    float sine2 = max(1.0 - cosine * cosine, 0.0);
    return 0.5 * (normal.x * sine2 + normal.y * (angle_of(cosine) - cosine * sqrt(sine2)));
}

/* What stands before the sky to one side of a slice: outwards, each thing hides what those before left. */
float hidden_sky(ivec2 pixel, ivec2 direction, vec3 eye, vec3 viewer, vec2 normal, float most, float jitter)
{
    float cosine = -normal.y * inversesqrt(max(dot(normal, normal), 1e-12));
    float seen = sky_below(cosine, normal), hidden = 0.0, narrow = 1.0 / (u_radius * u_radius), before = 0.0;
    for (int i = 0; i < STEPS; i++) {
        float fraction = (float(i) + jitter) / float(STEPS);
        ivec2 at = pixel + direction * int(max(fraction * (0.3 + 0.7 * fraction) * most + 0.5, 1.0));
        float depth = depth_at(at);
        vec3 off = eye_at(at, depth) - eye;
        /* What hides a part of the sky begins somewhere between the last sample and this one. */
        float far = dot(off, off), near = max(1.0 - 0.5 * (far + before) * narrow, 0.0);
        bool counts = depth < NOTHING && far * narrow < 1.0 && clamp(at, ivec2(0), last) == at;
        cosine = counts ? max(cosine, dot(off, viewer) * inversesqrt(max(far, 1e-30))) : cosine;
        float left = sky_below(cosine, normal);
        hidden += near * near * (seen - left);
        seen = left;
        before = counts ? far : before;
    }
    return hidden;
}

float hidden_slice(ivec2 pixel, ivec2 direction, vec3 eye, vec3 viewer, vec3 normal, float jitter)
{
    vec3 along = vec3(vec2(direction) * u_pixel, 0.0);
    along = normalize(along - viewer * dot(along, viewer));
    vec2 in_slice = vec2(dot(normal, viewer), dot(normal, along));
    float most = min(u_radius / (pixel_size(-eye.z) * length(vec2(direction))), 0.5 * float(last.y));
    return hidden_sky(pixel, direction, eye, viewer, in_slice, most, jitter) + hidden_sky(pixel, -direction, eye, viewer, vec2(in_slice.x, -in_slice.y), most, jitter);
}

/* Fraction of the sky that is seen. Slices run along whole pixels, so that samples of a plane lie on it exactly; there are four pairs of slices at right
 * angles, and each counts by the angle that is nearest to it. */
float sky_fraction(ivec2 pixel, vec3 eye, vec3 normal)
{
    vec3 viewer = u_perspective > 0.5 ? -normalize(eye) : vec3(0.0, 0.0, 1.0);
    int which = (pixel.x + 2 * pixel.y) & 3;
    float jitter = (float(pixel.y & 3) + 0.5) * 0.25, weight = which == 0 ? 1.1808 : which == 2 ? 0.8192 : 1.0;
    ivec2 direction = ivec2(which == 3 ? 1 : which == 1 ? 2 : 1, which == 0 ? 0 : which == 3 ? 2 : 1);
    float hidden = hidden_slice(pixel, direction, eye, viewer, normal, jitter) + hidden_slice(pixel, ivec2(-direction.y, direction.x), eye, viewer, normal, jitter);
    return clamp(1.0 - 0.5 * weight * hidden, 0.0, 1.0);
}
#endif

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    last = textureSize(t_depth, 0) - 1;
    float depth = depth_at(pixel);
    out_fraction = vec4(1.0, 1.0, EMPTY, 1e3);
    out_normal = vec4(0.0, 0.0, 1.0, 0.0);
    int full = depth < NOTHING ? 1 : 0;
    for (int once = 0; once < full; once++) {
        vec3 eye = eye_at(pixel, depth), normal = normal_at(pixel, depth, eye);
        out_normal = vec4(normal, 0.0);
        out_fraction.z = -eye.z;
#ifdef HAS_SOFT_SHADOW
        vec2 light = light_fraction(eye, normal, (float((pixel.x & 3) * 4 + (pixel.y & 3)) + 0.5) * (1.0 / 16.0), (float((pixel.x + 2 * pixel.y) & 3) + 0.5) * 0.25);
        out_fraction.x = light.x;
        out_fraction.w = light.y > 0.0 ? light.y / pixel_size(-eye.z) : 1e3;
#endif
#ifdef HAS_OCCLUSION
        out_fraction.y = sky_fraction(pixel, eye, normal);
#endif
    }
}
