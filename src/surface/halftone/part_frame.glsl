/* The frame of what a part moves with, for what comes after the geometry: from eye space to it. src/stage/upload.h */

struct part_frame {
    mat3 turn;   /* from world axes */
    vec3 shift;
    vec3 upward; /* which way is up */
    vec3 level;  /* an axis of the part that is not */
};

part_frame frame_of_part(uint part)
{
    int index = max(int(part) - 1, 0);
    ivec2 texel = ivec2(5 * (index & 1023), index >> 10);
    vec4 first = texelFetch(t_part_frames, texel, 0), second = texelFetch(t_part_frames, texel + ivec2(1, 0), 0), third = texelFetch(t_part_frames, texel + ivec2(2, 0), 0);
    return part_frame(transpose(mat3(first.xyz, second.xyz, third.xyz)), vec3(first.w, second.w, third.w), texelFetch(t_part_frames, texel + ivec2(3, 0), 0).yzw,
                      texelFetch(t_part_frames, texel + ivec2(4, 0), 0).xyz);
}
