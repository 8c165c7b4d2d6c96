/* What an edge of a mesh may be as a line: 0 nothing; RECORDED_OUTLINE: of what is smooth, an outline where depth steps; up to 1 more: of what is a crease, too; RECORDED_BORDER;
 * below 0 a crease of that strength; RECORDED_QUIET: judged to be no crease, so that pixels there show none. */
const float RECORDED_OUTLINE = 1.0, RECORDED_BORDER = 3.0, RECORDED_QUIET = 4.0;
/* Both pixels between which an edge runs are within 1 of it. */
const float RECORD_REACH = 1.25;
/* Edges up to so many pixels long are asked once which positions are seen; longer ones at each pixel. OPEN_BODIES: all of them are. */
#ifdef OPEN_BODIES
const float LONGEST_SHORT = -1.0;
#else
const float LONGEST_SHORT = 192.0;
#endif
