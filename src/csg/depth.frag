/* Depth and stencil alone. */
#ifdef SHARED_PLANES
#include "csg/operand.glsl"
#endif

void main()
{
#ifdef SHARED_PLANES
    gl_FragDepth = fragment_depth();
#endif
}
