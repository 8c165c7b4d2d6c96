/* The nearest outline across, within the halo's reach. */
#include "lines/halo_reach.glsl"
layout(location = 0) out vec4 out_0;

void main()
{
    int reach = int(ceil(halo_reach()));
    float nearest = 0.0;
    for (int x = -reach; x <= reach; x++)
        nearest = max(nearest, textureLod(t_outlines, (gl_FragCoord.xy + vec2(float(x), 0.0)) * u_texel, 0.0).r);
    out_0 = vec4(nearest);
}
