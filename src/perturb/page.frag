/* The field that stays on the sheet. */
layout(location = 0) out vec4 out_0;
#define NOISE_GAIN 2.6
#include "perturb/noise.glsl"

void main()
{
    vec2 position = gl_FragCoord.xy * u_cell;
    float side = LATTICE * u_perturb_scale;
    int period = 0;
    if (u_perturb_tile > 0.0) {
        period = max(int(u_perturb_tile / side + 0.5), 1);
        side = u_perturb_tile / float(period);
    }
    vec3 sum = vec3(0.0);
    float weight = 1.0, weights = 0.0, squares = 0.0;
    for (int i = 0; i < OCTAVES; i++) {
        sum += weight * octave_of(noise_of(position / side, period, u_seed + uint(i) * 0x51ed270bu));
        weights += weight;
        squares += weight * weight;
        weight *= 0.5;
        side *= 0.5;
        period *= 2;
    }
    out_0 = vec4(uncertainty_of(sum, weights, squares), 1.0);
}
