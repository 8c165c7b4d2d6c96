/* One slab of the shadow on the ground: what stands around one height, as a mean over squares of u_side texels; and below it all that stands higher, which has been
 * spread already. Heights are in reaches; those between two slabs are shared so that the variance of their spread is right. */
uniform sampler2D t_below;   /* the model's depth from below, */
uniform sampler2D t_above;   /* and from above, upside down */
uniform int       u_side;    /* 2^level */
uniform vec4      u_slab; /* lowest = x + y depth; highest = z - y depth */
uniform vec3      u_slabs;   /* heights of the slab before, this one, and the next one */
uniform vec2      u_ends;    /* 1 where there is no slab before, or behind */
#ifdef HAS_HIGHER
uniform sampler2D t_higher;
#endif
layout(location = 0) out vec4 out_shade;

/* Of what stands at a height between two, the share of the higher one: spread grows with height. */
float share(float height, float low, float high)
{
    return clamp((height * height - low * low) / (high * high - low * low), 0.0, 1.0);
}

float middle(float lowest, float highest, float low, float high)
{
    return 0.5 * (clamp(lowest, low, high) + clamp(highest, low, high));
}

/* `left`: of the light at the slab before, this one and the next one. What heights between two take is what is left at one less what is left at the other. */
float slab_of(float lowest, float highest, vec3 left)
{
    float before = u_slabs.x, own = u_slabs.y, next = u_slabs.z, sum = 0.0, low = u_ends.x > 0.5 ? 0.0 : before;
    float from = exp(-lowest), to = exp(-highest), first = u_ends.x > 0.5 ? 1.0 : left.x;
    sum += (clamp(from, left.y, first) - clamp(to, left.y, first)) * (u_ends.x > 0.5 ? 1.0 : share(middle(lowest, highest, low, own), before, own));
    sum += (clamp(from, left.z, left.y) - clamp(to, left.z, left.y)) * (u_ends.y > 0.5 ? 1.0 : 1.0 - share(middle(lowest, highest, own, next), own, next));
    float there = lowest <= own ? (u_ends.x > 0.5 ? 1.0 : share(lowest, before, own)) : (u_ends.y > 0.5 ? 1.0 : 1.0 - share(lowest, own, next));
    return sum + to * there;
}

void main()
{
    /* Four by four are enough of what is spread widely. */
    int apart = max(u_side / 4, 1), count = u_side / apart;
    ivec2 first = ivec2(gl_FragCoord.xy) * u_side + apart / 2;
    int last = textureSize(t_below, 0).y - 1;
    float sum = 0.0;
    vec3 left = exp(-u_slabs);
    for (int y = 0; y < count; y++)
        for (int x = 0; x < count; x++) {
            ivec2 at = first + apart * ivec2(x, y);
            float depth = texelFetch(t_below, at, 0).r, lowest = max(u_slab.x + u_slab.y * depth, 0.0);
            /* Most places have nothing above them: a loop is left, where a condition is computed both ways. */
            int stands = depth < 1.0 ? 1 : 0;
            for (int once = 0; once < stands; once++) {
                float highest = max(u_slab.z - u_slab.y * texelFetch(t_above, ivec2(at.x, last - at.y), 0).r, lowest);
                sum += slab_of(lowest, highest, left);
            }
        }
    sum /= float(count * count);
#ifdef HAS_HIGHER
    sum += texture(t_higher, gl_FragCoord.xy / (2.0 * vec2(textureSize(t_higher, 0)))).r;
#endif
    out_shade = vec4(sum, 0.0, 0.0, 1.0);
}
