/* Directions on surfaces and on the page. A direction without sign is (cos 2θ, sin 2θ), which may be averaged. Müller, sections 4 and 5; rows P23 to P27. */

/* Two unit tangents that make a right-handed frame with the normal. */
mat3 frame_around(vec3 normal)
{
    vec3 right = normalize(abs(normal.y) < 0.9 ? vec3(normal.z, 0.0, -normal.x) : vec3(0.0, normal.z, -normal.y));
    return mat3(right, cross(normal, right), normal);
}

/* The tangent at the angle θ, given its double angle, in a frame's first two axes. */
vec3 tangent_of(vec2 doubled, mat3 frame)
{
    float along = sqrt(max(0.5 + 0.5 * doubled.x, 0.0));
    float across = along > 1e-3 ? 0.5 * doubled.y / along : 1.0;
    return frame[0] * along + frame[1] * across;
}

/* A tangent as it is seen, as double angle; zero where it points to the eye. */
vec2 on_page(vec3 eye, vec3 tangent)
{
    vec2 seen = u_perspective > 0.5 ? tangent.xy * -eye.z + eye.xy * tangent.z : tangent.xy;
    float square = dot(seen, seen);
    return square > 0.0 ? vec2(seen.x * seen.x - seen.y * seen.y, 2.0 * seen.x * seen.y) / square : vec2(0.0);
}

/* Where nothing bends, or all directions alike, strokes run up walls and slopes, and along an axis of the part on what is level: row P27. All in one frame. */
vec3 plain_tangent(vec3 normal, vec3 upward, vec3 level)
{
    vec3 wanted = mix(upward, level, smoothstep(0.9, 0.97, abs(dot(normal, upward))));
    return normalize(wanted - normal * dot(wanted, normal) + 1e-6 * frame_around(normal)[0]);
}
