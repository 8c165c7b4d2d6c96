/* Depths of solids: eye depth behind the near plane, which is as fine wherever that plane is; not negative, so that its bits sort as a whole
 * number. */
uniform vec4  u_solid_depth; /* window depth from z of the eye: (x z + y) / (z' z + w) */
uniform float u_solid_near;

/* Of an eye depth. */
float window_depth_at(float depth)
{
    return (u_solid_depth.y - u_solid_depth.x * depth) / (u_solid_depth.w - u_solid_depth.z * depth) * 0.5 + 0.5;
}

uint stored_at(float depth)
{
    return floatBitsToUint(max(depth - u_solid_near, 0.0));
}

float eye_depth_of(uint stored)
{
    return uintBitsToFloat(stored) + u_solid_near;
}
