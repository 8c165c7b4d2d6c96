/* The field of uncertainty at each pixel. */
#include "perturb/field.glsl"
layout(location = 0) out vec4 out_0;

void main()
{
    out_0 = vec4(uncertainty_at(ivec2(gl_FragCoord.xy)), 1.0);
}
