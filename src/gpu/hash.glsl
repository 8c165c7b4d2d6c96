/* Numbers without a pattern. */
uint hash_of(uvec3 v, uint seed)
{
    uint hash = v.x * 0x9e3779b1u ^ v.y * 0x85ebca77u ^ v.z * 0xc2b2ae3du ^ seed;
    hash = (hash ^ (hash >> 15u)) * 0x2c1b3c6du;
    hash = (hash ^ (hash >> 12u)) * 0x297a2d39u;
    return hash ^ (hash >> 15u);
}
