/* Rectangles of pixels. */
layout(location = 0) in vec2 a_corner;
uniform vec2 u_target; /* size of what is drawn into */

void main()
{
    gl_Position = vec4(2.0 * a_corner / u_target - 1.0, 0.0, 1.0);
}
