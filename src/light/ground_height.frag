/* How near the ground that is what keeps the first light off: e^(-height); and 1, or both 0 where nothing does. Heights are in reaches. */
uniform sampler2D t_below;  /* the model's depth from below */
uniform vec4      u_heights; /* x + y depth; z: of what is highest; w: a texel */
uniform vec2      u_rising;  /* over the map, for each reach that the way to the light rises */
layout(location = 0) out vec4 out_near;

const int STEPS = 48; /* the lower, the finer */

void main()
{
    ivec2 size = textureSize(t_below, 0);
    vec2 at = gl_FragCoord.xy * u_heights.w, found = vec2(0.0);
    for (int i = STEPS - 1; i >= 0; i--) {
        float part = (float(i) + 0.5) / float(STEPS), height = u_heights.z * part * part;
        vec2  place = at + u_rising * height;
        float depth = texelFetch(t_below, clamp(ivec2(place * vec2(size)), ivec2(0), size - 1), 0).r;
        bool  stands = depth < 1.0 && u_heights.x + u_heights.y * depth <= height + 0.5 * u_heights.z / float(STEPS);
        found = stands && max(abs(place.x - 0.5), abs(place.y - 0.5)) < 0.5 ? vec2(height, 1.0) : found;
    }
    out_near = vec4(exp(-found.x) * found.y, found.y, 0.0, 1.0);
}
