/* The mean of pictures, one more taken in: where all are the same it stays what they are, bit by bit. */
layout(location = 0) out vec4 out_mean;
uniform sampler2D t_mean;
uniform sampler2D t_page;
uniform float u_part; /* of the new one in the mean of all so far */

void main()
{
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec4 page = texelFetch(t_page, pixel, 0), mean = u_part < 1.0 ? texelFetch(t_mean, pixel, 0) : page;
    out_mean = mean + (page - mean) * u_part;
}
