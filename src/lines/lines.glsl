/* The edge map that passes over whole lines read: lines two pixels wide, as far as they have been changed already. */
#if defined(HAS_STYLED)
#define t_lines t_styled
#elif defined(HAS_WHOLE)
#define t_lines t_whole
#else
#define t_lines t_edge
#endif
