/* Positions and faces of a G-buffer's pixels, for shading from it. */
vec3 eye_of(vec2 pixel, float depth)
{
    return vec3((2.0 * pixel / u_size - 1.0) * u_unproject * (u_perspective > 0.5 ? depth : 1.0), -depth);
}

#if defined(LIT_WITH_SHADOW) && !defined(HAS_SOFT_SHADOW)
/* From here to the next pixel of the surface along one axis: on the side where it runs on as its normal says. */
vec3 along_surface(vec3 eye, vec3 normal, ivec2 pixel, ivec2 axis)
{
    ivec2 last = textureSize(t_normal_depth, 0) - 1;
    vec3 before = eye - eye_of(vec2(pixel - axis) + 0.5, texelFetch(t_normal_depth, clamp(pixel - axis, ivec2(0), last), 0).w);
    vec3 behind = eye_of(vec2(pixel + axis) + 0.5, texelFetch(t_normal_depth, clamp(pixel + axis, ivec2(0), last), 0).w) - eye;
    return abs(dot(normal, before)) * length(behind) < abs(dot(normal, behind)) * length(before) ? before : behind;
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
