/* Looking a darkness up in a stack of tones t_tones, each of which holds the strokes of those before: row P20. MIXES_TONES: two tones may mix. */
#include "gpu/hash.glsl"

/* Ink of a tone: 0 is paper, then the pictures of the map. */
float tone_ink(vec2 at, float level, float tone)
{
    return tone < 0.5 ? 0.0 : 1.0 - textureLod(t_tones, vec3(at, tone - 1.0), level).r;
}

/* The ink of a darkness at a position. Hatching has one of the tones everywhere, since new strokes find no room between two; gradation mixes two. */
float map_ink(vec2 at, float level, float darkness)
{
    float count = u_tones_facts.y, wanted = clamp(darkness / u_tones_facts.w, 0.0, 1.0) * count;
#if MIXES_TONES
    float low = min(floor(wanted), count - 1.0);
    return mix(tone_ink(at, level, low), tone_ink(at, level, low + 1.0), wanted - low);
#else
#ifdef WITH_RAGGED
    /* Each band as wide as a stroke or two has a border of its own. */
    float own = corner_noise(uint(int(floor(at.y * u_tones_facts.x * 0.4))) * 0x9e3779b1u).y;
    wanted = wanted > 0.0 ? clamp(wanted + 0.5 * u_ragged * own, 0.0, count) : 0.0;
#endif
    return tone_ink(at, level, floor(wanted + 0.5));
#endif
}
