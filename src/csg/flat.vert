/* Rectangles of pixels at one depth. */
layout(location = 0) in vec2 a_corner;
uniform vec2 u_target;
uniform float u_flat_depth; /* window depth */

void main()
{
    gl_Position = vec4(2.0 * a_corner / u_target - 1.0, 2.0 * u_flat_depth - 1.0, 1.0);
}
