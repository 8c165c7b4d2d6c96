/* The direction in which surfaces bend most, from the picture of normals and depth alone: Müller, section 4.2 (after Yu 2007 and Kim 2008), derived anew.
 *
 * The normals of neighbours are rays. In the frame of the middle one they pass the plane z = 0 at (u, v), and from there to z = 1 they move by (σ, τ). To first order
 * (σ, τ) = S (u, v) with the shape operator S, which four neighbours give by least squares; its eigenvectors are the directions of greatest and least curvature. The printed
 * way, slits through which rays pass, is the same for two neighbours, but has no answer on planes; and its shader is wrong.
 *
 * Row P25; P27 where nothing bends. */
#include "light/point.glsl"
#include "surface/halftone/part_frame.glsl"
#include "surface/halftone/form.glsl"
layout(location = 0) out vec4 out_0;

vec3 eye_at(ivec2 pixel, float depth)
{
    vec2 ndc = 2.0 * (vec2(pixel) + 0.5) / u_size - 1.0;
    return vec3(ndc * u_unproject * (u_perspective > 0.5 ? depth : 1.0), -depth);
}

/* What neighbours say: sums of u², uv, v², uσ, vσ + uτ, vτ. */
struct ray_sums {
    vec3  positions, turns;
    float count;
};

void add_ray(inout ray_sums sums, ivec2 pixel, vec3 origin, mat3 frame)
{
    vec4 other = texelFetch(t_normal_depth, clamp(pixel, ivec2(0), ivec2(u_size) - 1), 0);
    vec3 position = (eye_at(pixel, other.w) - origin) * frame, normal = other.xyz * frame;
    /* Not across creases and borders. */
    float counts = normal.z > 0.7 && abs(position.z) < 0.6 * length(position.xy) ? 1.0 : 0.0;
    vec2 turn = normal.xy / max(normal.z, 0.7), at = position.xy - position.z * turn;
    sums.positions += counts * vec3(at.x * at.x, at.x * at.y, at.y * at.y);
    sums.count += counts;
    sums.turns += counts * vec3(at.x * turn.x, at.y * turn.x + at.x * turn.y, at.y * turn.y);
}

/* The symmetric S = (a b; b c) that fits best. */
vec3 shape_operator(ray_sums sums)
{
    vec3 p = sums.positions, t = sums.turns;
    /* Normal equations: (p.x p.y 0; p.y p.x + p.z p.y; 0 p.y p.z) (a b c) = t */
    float whole = p.x * ((p.x + p.z) * p.z - p.y * p.y) - p.y * p.y * p.z;
    float scale = p.x + p.z;
    if (whole <= 1e-6 * scale * scale * scale)
        return vec3(0.0);
    float b = (p.x * p.z * t.y - p.y * (p.z * t.x + p.x * t.z)) / whole;
    return vec3((t.x - p.y * b) / p.x, b, (t.z - p.y * b) / p.z);
}

vec2 direction_at(ivec2 pixel, uvec2 id)
{
    vec4 own = texelFetch(t_normal_depth, pixel, 0);
    vec3 origin = eye_at(pixel, own.w);
    mat3 frame = frame_around(own.xyz);
    ray_sums sums = ray_sums(vec3(0.0), vec3(0.0), 0.0);
    int far = max(int(2.0 * page_unit() + 0.5), 1);
    add_ray(sums, pixel + ivec2(far, 0), origin, frame);
    add_ray(sums, pixel - ivec2(far, 0), origin, frame);
    add_ray(sums, pixel + ivec2(0, far), origin, frame);
    add_ray(sums, pixel - ivec2(0, far), origin, frame);
    vec3 shape = shape_operator(sums);
    /* Half the difference of the curvatures, and their mean. The greater one by size has the direction. */
    vec2 doubled = 0.5 * vec2(shape.x - shape.z, 2.0 * shape.y);
    float apart = length(doubled), mean = 0.5 * (shape.x + shape.z);
    float unlike = apart / (apart + abs(mean) + 1e-20);
    float unit_length = page_unit() * 2.0 * u_unproject.y / u_size.y * (u_perspective > 0.5 ? own.w : 1.0);
    /* A normal that hardly turns on 1/96 inch of the page does not turn; one that turns very much is an edge's, which has no room for strokes of its own. */
    float turn = (apart + abs(mean)) * unit_length;
    /* Directions of curvatures that are alike are an accident of rounding, and so are those that fewer than three neighbours tell: there what lies beside, and the plain
     * way, take over. */
    float own_direction = smoothstep(0.02, 0.1, unlike) * step(2.5, sums.count);
    float sure = own_direction * unlike * smoothstep(2e-5, 2e-4, turn) * (1.0 - smoothstep(0.035, 0.08, turn)) * (0.15 + 0.85 * smoothstep(0.0, 0.006, turn));
    vec2 direction = apart > 0.0 ? doubled * ((mean < 0.0 ? -1.0 : 1.0) / apart) : vec2(1.0, 0.0);
    vec2 bent = on_page(origin, tangent_of(direction, frame));
    part_frame part = frame_of_part(id.r);
    mat3 to_part = part.turn * mat3(u_world_from_eye);
    vec2 plain = on_page(origin, plain_tangent(to_part * own.xyz, part.upward, part.level) * to_part);
    /* Hands over where curvatures differ by less than a sixth, so that it turns no strokes that have a direction of their own. */
    return bent * sure + plain * (0.03 * max(1.0 - smoothstep(0.0, 0.08, sure), 1.0 - own_direction));
}

void main()
{
    ivec2 pixel = min(ivec2(gl_FragCoord.xy) * DIRECTION_APART + DIRECTION_APART / 2, ivec2(u_size) - 1);
    uvec2 id = texelFetch(t_id, pixel, 0).rg;
    out_0 = vec4(0.0);
    int there = id.r == 0u ? 0 : 1;
    for (int once = 0; once < there; once++)
        out_0 = vec4(direction_at(pixel, id), 0.0, 1.0);
}
