/* How far the field spreads beside surfaces, texels: less than half a wave. */
const int SPREAD_REACH = 8;
