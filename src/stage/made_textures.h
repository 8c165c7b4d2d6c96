/* Textures that techniques make from their parameters: made once, found again as long as what decides their content
 * stays the same. */
#ifndef LIMNER_STAGE_MADE_TEXTURES_H
#define LIMNER_STAGE_MADE_TEXTURES_H

#include "gpu/gpu.h"
#include "technique/technique.h"

enum { MADE_TEXTURES_MAX = 6 }; /* of one technique */

typedef struct made_texture {
    char        *description;
    gpu_texture *texture;
    float        facts[4];         /* longer side, layers, levels, the chain's own */
    bool         similar, nearest; /* as the chain's */
    bool         blank;            /* of bytes, all of them 255: nothing will be drawn with it */
    uint64_t     used;             /* when, by the store's clock */
} made_texture;

/* Belongs to a renderer. */
typedef struct made_textures {
    made_texture *items;
    size_t        count, capacity;
    uint64_t      clock;
} made_textures;

/* The textures of one use, in the order of the technique's table; not `there` where its condition does not hold. */
typedef struct used_textures {
    gpu_texture *textures[MADE_TEXTURES_MAX];
    float        facts[MADE_TEXTURES_MAX][4];
    bool         similar[MADE_TEXTURES_MAX], nearest[MADE_TEXTURES_MAX], blank[MADE_TEXTURES_MAX];
} used_textures;

/* Finds or makes them. Errors: those of `make`, and the GPU's. */
lmn_status made_textures_find(made_textures *all, gpu *g, const technique_use *use, used_textures *out,
                              lmn_error *error);
/* Lets go of what was not used in the last drawings. */
void made_textures_trim(made_textures *all, gpu *g);
void made_textures_release(made_textures *all, gpu *g);

/* HAS_NAME and the declarations; the values. */
void used_textures_declare(text *prelude, const technique_use *use, const used_textures *used);
void used_textures_set(gpu *g, const technique_use *use, const used_textures *used);

#endif
