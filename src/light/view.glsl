/* How the viewer's rays run. */
uniform float u_perspective; /* 1, or 0 for parallel rays */
uniform vec2  u_unproject;   /* eye xy of a pixel = ndc · this · (depth, or 1 for parallel rays) */
