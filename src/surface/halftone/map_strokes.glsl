#ifndef STROKE_SIZE
#define STROKE_SIZE 1.0
#endif
/* Ink of the strokes on a plane. On the page they are as large as they were made; on surfaces two sizes hand over to each other as one comes nearer. */
float strokes_at(stroke_plane s, float darkness, vec2 start)
{
#if defined(HAS_FORM) || COORDINATES == 2
    return map_ink(s.at * page_unit() / (u_tones_facts.x * (u_scale * STROKE_SIZE)) + start, 0.0, darkness);
#else
    float level = screen_level(s, u_tones_facts.x, (u_scale * STROKE_SIZE)), bare = 1.0;
    for (int k = 0; k < 2; k++) {
        screen_octave o = octave_of(s, level, k, -1e9, false);
        int used = o.weight > 0.01 ? 1 : 0;
        for (int once = 0; once < used; once++)
            bare *= 1.0 - map_ink(s.at * o.scale + start, o.level, darkness_of_fraction(darkness, o.weight));
    }
    return 1.0 - bare;
#endif
}
