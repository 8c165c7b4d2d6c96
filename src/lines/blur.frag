/* Gaussian blur, across in the first round and up in the second. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    ivec2 along = u_iteration == 0 ? ivec2(1, 0) : ivec2(0, 1);
    int reach = int(ceil(u_line_blur));
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int i = -reach; i <= reach; i++) {
        float w = exp(-2.0 * float(i * i) / (u_line_blur * u_line_blur));
        sum += w * texelFetch(t_ground, clamp(pixel + i * along, ivec2(0), last), 0);
        weights += w;
    }
    out_0 = sum / weights;
}
