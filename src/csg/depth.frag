/* Depth and stencil alone. */
#ifdef SHARED_PLANES
#include "csg/operand.glsl"
#include "csg/window.glsl"
#endif

void main()
{
#ifdef SHARED_PLANES
    gl_FragDepth = window_depth();
#endif
}
