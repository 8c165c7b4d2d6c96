/* Numbers without a pattern. */
uint hash_of(uvec3 v, uint seed)
{
    uint hash = v.x * 0x9e3779b1u ^ v.y * 0x85ebca77u ^ v.z * 0xc2b2ae3du ^ seed;
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash = (hash ^ (hash >> 12u)) * 0x297a2d39u;
    return hash ^ (hash >> 15u);
}

/* Two independent values −1 … 1 of a number whose low bits are mixed already. By way of signed numbers: software drivers turn these into floats in one step. */
vec2 corner_noise(uint hash)
{
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash ^= hash >> 13u;
    return vec2(ivec2(int(hash & 0xFFFFu), int(hash >> 16u))) * (2.0 / 65535.0) - 1.0;
}
