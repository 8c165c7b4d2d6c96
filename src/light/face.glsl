/* Positions and faces of a G-buffer's pixels, for shading from it. */
vec3 eye_of(vec2 pixel, float depth)
{
    return vec3((2.0 * pixel / u_size - 1.0) * u_unproject * (u_perspective > 0.5 ? depth : 1.0), -depth);
}

#ifdef LIT_WITH_SHADOW
/* From here to a neighbouring pixel, and how far off the plane that the normal says, of its length; behind an edge of the shape lies another surface. */
vec4 to_neighbour(vec3 eye, vec3 normal, ivec2 pixel)
{
    vec4 there = texelFetch(t_normal_depth, clamp(pixel, ivec2(0), textureSize(t_normal_depth, 0) - 1), 0);
    vec3 step_ = eye_of(vec2(pixel) + 0.5, there.w) - eye;
    return vec4(step_, dot(there.xyz, normal) > 0.8 ? abs(dot(normal, step_)) / max(length(step_), 1e-30) : 1.0);
}

/* From here to the next pixel of the surface along one axis: where both sides lie on one line, along it; else on the side where it runs on as its normal says, none where neither does. */
vec3 along_surface(vec3 eye, vec3 normal, ivec2 pixel, ivec2 axis)
{
    vec4 before = to_neighbour(eye, normal, pixel - axis), behind = to_neighbour(eye, normal, pixel + axis);
    vec4 nearest = before.w < behind.w ? vec4(-before.xyz, before.w) : behind;
    bool straight = max(before.w, behind.w) < 1.0 && length(before.xyz + behind.xyz) < 0.1 * length(nearest.xyz);
    return nearest.w < 0.4 || straight ? nearest.xyz : vec3(0.0);
}

/* Of the flat surface that was drawn; the normal itself where what lies around is another one. */
vec3 face_of(vec3 eye, vec3 normal, ivec2 pixel)
{
    vec3 face = cross(along_surface(eye, normal, pixel, ivec2(1, 0)), along_surface(eye, normal, pixel, ivec2(0, 1)));
    face /= max(length(face), 1e-30);
    return dot(face, normal) > 0.5 ? face : normal;
}
#else
vec3 face_of(vec3 eye, vec3 normal, ivec2 pixel)
{
    return normal;
}
#endif
