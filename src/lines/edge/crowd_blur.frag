/* The length of lines around a position: Gaussian blur, across in the first round and up in the second, as wide as lines keep apart. */
layout(location = 0) out vec4 out_0;

/* Standard deviation in widths of lines: the peak beside one line alone is that of a stretch of 5 widths, so that three that meet are no crowd. */
const float DEVIATION = 2.0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = textureSize(t_crowd, 0) - 1, along = u_iteration == 0 ? ivec2(1, 0) : ivec2(0, 1);
    float deviation = max(DEVIATION * u_line_width / float(DIRECTION_APART), 0.5), sum = 0.0, weights = 0.0;
    int reach = int(ceil(2.5 * deviation));
    for (int i = -reach; i <= reach; i++) {
        float weight = exp(-0.5 * float(i * i) / (deviation * deviation));
        sum += weight * texelFetch(t_crowd, clamp(pixel + i * along, ivec2(0), last), 0).r;
        weights += weight;
    }
    out_0 = vec4(sum / weights);
}
