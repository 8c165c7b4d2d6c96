/* The kind "layers": which surfaces of a figure are seen. */
#ifndef LIMNER_LAYER_LAYER_H
#define LIMNER_LAYER_LAYER_H

#include "technique/technique.h"

extern const kind kind_layers;

extern const technique layers_front, layers_peel;

/* How the surfaces of solids are found. */
typedef enum layer_evaluation { EVALUATION_AUTO, EVALUATION_LISTS, EVALUATION_PRODUCTS } layer_evaluation;
extern const char *const layer_evaluations[];

typedef enum layer_producer { PRODUCER_AUTO, PRODUCER_PEELING, PRODUCER_LISTS } layer_producer;

/* Layers that are drawn at most, however deep the model is. */
enum { LAYERS_MAX = 256 };

/* Bits of the surface id in the id buffer; every program gets them by the same names. */
enum { SURFACE_INDEX_BITS = 20, SURFACE_FIGURE_BITS = 8, FIGURES_TOGETHER_MAX = (1 << SURFACE_FIGURE_BITS) - 1 };
#define SURFACE_COMPLEMENT 0x80000000u /* a part that another figure draws */
#define SURFACE_TURNED     0x40000000u /* seen from inside: the normal points away */
#define SURFACE_CUT        0x20000000u /* a cut face */
#define SURFACE_BACK       0x10000000u /* back-facing by winding */
#define SURFACE_OPERAND    0x00080000u /* of a solid: what is below this bit is the operand's number */

/* Alpha of the albedo where the file asks for no light; elsewhere it is the material's. */
enum { ALBEDO_UNLIT = 2 };

/* What a technique says of a figure's surfaces; those of figures that are not composed layer by layer are asked for
 * the first line alone. */
typedef struct layering {
    bool        deferred, complement; /* shaded from the G-buffer; other figures' parts take part in edge detection */
    int32_t     evaluation;           /* of solids: layer_evaluation */
    bool        several;              /* surfaces behind the visible one, too */
    bool        settle_ties;          /* parts that coincide within rounding come in their order */
    int32_t     count;                /* of layers at most; 0: all there are */
    int32_t     producer, memory;     /* layer_producer; MiB for lists */
    float       fraction;             /* of the picture: ends with a layer that covers less */
    const char *focus;                /* selector of what is to be uncovered; empty: nothing */
    float       focus_fraction, rear; /* of it; opacity of what lies behind that */
    colour      focus_colour;
} layering;

/* Of a rule's use, NULL: of the visible surface. */
layering layering_of(const technique_use *layers);

#endif
