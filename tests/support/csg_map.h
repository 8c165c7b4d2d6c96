/* The surfaces of a solid behind each pixel, by rays, and a drawing's layers against them. */
#ifndef TRUTH_CSG_MAP_H
#define TRUTH_CSG_MAP_H

#include "csg_truth.h"

/* The surfaces between the clip planes on the ray through a position of the picture. */
size_t csg_trace_pixel(csg_rays *r, const shot *view, double x, double y, csg_hit out[CSG_HITS_MAX],
                       csg_passage *passage);

/* The surfaces of all pixel centres. A pixel is sharp when rays a hundredth of a pixel around its centre cross the
 * same leaves and meet the same surfaces in the same order and nothing is close: elsewhere a rasteriser may be
 * right with another answer. */
typedef struct csg_map {
    int      width, height;
    size_t  *first; /* hits of pixel i: hits[first[i]] … hits[first[i + 1] − 1] */
    csg_hit *hits;
    bool    *sharp;
    size_t   sharp_count, most, most_sharp;
} csg_map;

void csg_map_make(csg_map *out, csg_rays *r, const shot *view);
/* Only the centres: no pixel is called sharp. */
void csg_map_quickly(csg_map *out, csg_rays *r, const shot *view);
void csg_map_release(csg_map *m);

static inline size_t csg_count(const csg_map *m, int pixel)
{
    return m->first[pixel + 1] - m->first[pixel];
}

static inline const csg_hit *csg_at(const csg_map *m, int pixel)
{
    return m->hits + m->first[pixel];
}

/* Is there within the 3x3 pixels around this one another number of surfaces, another owner, or a step of depth?
 * `layers`: only of so many surfaces (0: all). */
bool csg_map_border(const csg_map *m, int x, int y, size_t layers);

/* A drawing's layers against the truth. */
typedef enum csg_verdict {
    CSG_RIGHT,
    CSG_COUNT,
    CSG_OWNER,
    CSG_DEPTH,
    CSG_NORMAL,
    CSG_FACING,
    CSG_HOLE,
    CSG_VERDICTS
} csg_verdict;

extern const char *const csg_verdict_names[CSG_VERDICTS];

typedef struct csg_score {
    size_t pixels, sharp; /* of the picture, and those whose answer is sure */
    size_t right, right_sharp;
    size_t inner, right_inner;  /* pixels that are no border */
    size_t wrong[CSG_VERDICTS]; /* sharp pixels, by the first thing that is wrong */
    size_t outline_wrong; /* pixels that are drawn and should not be, or the other way, of those farther than a pixel
                             from it */
    double depth_error, normal_error; /* largest of the sharp pixels that are right: share, degrees */
    int    first[CSG_VERDICTS][2];    /* the first sharp pixel of each: x, y */
} csg_score;

/* `layers`: how many the drawing has at most (0: all). Without layer maps, its only maps are those of layer 0.
 * `owners`: are its shades the leaves' colours? */
csg_score csg_compare(const csg_map *m, csg_rays *r, const shot *s, size_t layers, bool owners);

/* What the truth and the drawing have at a pixel, as notes. */
void csg_explain(const csg_map *m, csg_rays *r, const shot *s, int x, int y);

#endif
