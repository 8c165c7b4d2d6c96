/* Pieces of ribbons as quads. */
#include "lines/stroke/quad.glsl"
layout(location = 0) in vec4 a_begin;
layout(location = 1) in vec4 a_end;
layout(location = 2) in vec4 a_look;
layout(location = 3) in vec4 a_along;
flat out vec4 v_along; /* lengths from where the ribbon begins up to both ends, of all of it; a number of its own */

void main()
{
    v_begin = a_begin;
    v_end = a_end;
    v_look = a_look;
    v_along = a_along;
    gl_Position = corner_of(a_begin, a_end);
}
