/* The mean motion around each texel, of what is nearest there: what strokes take their direction from, so that it changes slowly along the page. */
layout(location = 0) out vec4 out_cells;

const int TAPS = 7;

void main()
{
    ivec2 texel = ivec2(gl_FragCoord.xy), last = textureSize(t_nearest, 0) - 1;
    float apart = u_patch / float(DIRECTION_APART * TAPS);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < TAPS * TAPS; i++) {
        vec2 at = apart * vec2(i % TAPS - TAPS / 2, i / TAPS - TAPS / 2);
        vec4 near = texelFetch(t_nearest, clamp(texel + ivec2(round(at)), ivec2(0), last), 0);
        sum += near.w > 0.0 ? vec4(near.xy, 0.0, 1.0) : vec4(0.0);
    }
    out_cells = sum / max(sum.w, 1.0);
}
