/* Gradient noise (Perlin's): three independent values at once. Nienhaus 2005, section 6.2. */
#include "gpu/hash.glsl"

vec3 fade_of(vec3 t)
{
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

/* What the gradients of one corner of the lattice give at `offset` from it. Three bits a component: 512 directions are enough. */
vec3 corner_of(uvec3 corner, uint seed, vec3 offset)
{
    uvec3 bits = uvec3(hash_of(corner, seed)) >> uvec3(0u, 9u, 18u);
    vec3 along = vec3(bits & 7u) * offset.x + vec3((bits >> 3u) & 7u) * offset.y + vec3((bits >> 6u) & 7u) * offset.z;
    return along * (2.0 / 7.0) - (offset.x + offset.y + offset.z);
}

/* Side of the lattice over the length of the waves that come out of it. */
const float LATTICE = 0.69;

/* Noise is 0 at the corners of its lattice: this keeps those of all octaves from falling together in the middle of a model. */
const vec3 LATTICE_SHIFT = vec3(0.4331, 0.2719, 0.6173);

/* In the plane; the lattice repeats after `period` positions unless that is 0. */
vec3 noise_of(vec2 position, int period, uint seed)
{
    position += LATTICE_SHIFT.xy * float(1u + (seed & 7u));
    vec2 low = floor(position), inside = position - low;
    vec3 fraction = fade_of(vec3(inside, 0.0));
    ivec2 first = ivec2(low), second = first + 1;
    if (period > 0) {
        first = ((first % period) + period) % period;
        second = (first + 1) % period;
    }
    vec3 a = corner_of(uvec3(first, 0), seed, vec3(inside, 0.0));
    vec3 b = corner_of(uvec3(second.x, first.y, 0), seed, vec3(inside - vec2(1.0, 0.0), 0.0));
    vec3 c = corner_of(uvec3(first.x, second.y, 0), seed, vec3(inside - vec2(0.0, 1.0), 0.0));
    vec3 d = corner_of(uvec3(second, 0), seed, vec3(inside - 1.0, 0.0));
    return mix(mix(a, b, fraction.x), mix(c, d, fraction.x), fraction.y);
}

/* In space. */
vec3 noise_of(vec3 position, uint seed)
{
    position += LATTICE_SHIFT * float(1u + (seed & 7u));
    vec3 low = floor(position), inside = position - low, fraction = fade_of(inside);
    uvec3 first = uvec3(ivec3(low));
    vec3 sum = vec3(0.0);
    for (int z = 0; z < 2; z++)
        for (int y = 0; y < 2; y++)
            for (int x = 0; x < 2; x++) {
                uvec3 step = uvec3(x, y, z);
                vec3 part = mix(1.0 - fraction, fraction, vec3(step));
                sum += part.x * part.y * part.z * corner_of(first + step, seed, inside - vec3(step));
            }
    return sum;
}

/* A sum of octaves as an uncertainty, −1 … 1 with a root mean square around 0.4; `weights` and `squares`: sums of the octaves' weights. */
vec3 uncertainty_of(vec3 sum, float weights, float squares)
{
#if FIELD == 1
    /* Of one octave's absolute values the mean is 0.157. */
    sum = 1.6 * (sum - 0.157 * weights);
#endif
    sum *= NOISE_GAIN * inversesqrt(squares);
    return sum * inversesqrt(1.0 + sum * sum);
}

vec3 octave_of(vec3 noise)
{
#if FIELD == 1
    return abs(noise);
#else
    return noise;
#endif
}
