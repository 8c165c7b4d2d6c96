/* Of each class of ink the nearest pixel that has any: x = profile, y = inner, z = id; two signed halves of a word, how far right and up. */
const int NOWHERE = -16384;

uint packed_seed(ivec2 off)
{
    return uint(off.x & 0xFFFF) | uint(off.y) << 16;
}

ivec2 seed_of(uint word)
{
    return ivec2(int(word << 16) >> 16, int(word) >> 16);
}

const uint NO_SEED = 0xC000u | 0xC000u << 16;
