/* Gaussian blur, across in the first round and up in the second. */
layout(location = 0) out vec4 out_0;

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(u_size) - 1;
    ivec2 along = u_iteration == 0 ? ivec2(1, 0) : ivec2(0, 1);
    int reach = int(ceil(u_line_blur));
    /* Weights of a Gaussian from one another: each is the one before times a factor that shrinks as evenly. */
    float square = u_line_blur * u_line_blur, factor = exp(-2.0 / square), shrinks = exp(-4.0 / square), weight = 1.0, weights = 1.0;
    vec4 sum = texelFetch(t_ground, pixel, 0);
    for (int i = 1; i <= reach; i++) {
        weight *= factor;
        factor *= shrinks;
        sum += weight * (texelFetch(t_ground, max(pixel - i * along, ivec2(0)), 0) + texelFetch(t_ground, min(pixel + i * along, last), 0));
        weights += 2.0 * weight;
    }
    out_0 = sum / weights;
}
