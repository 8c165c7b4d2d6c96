/* A solid as a union of partial products: each an intersection of operands, minus others. Goldfeather's normal
 * form, found by carrying negations down and multiplying out, with products and subtractions left out whose boxes
 * do not touch. Nienhaus et al. 2006, section 2; rows K01, C2. */
#ifndef LIMNER_CSG_TREE_PRODUCTS_H
#define LIMNER_CSG_TREE_PRODUCTS_H

#include "csg_tree/form.h"

/* One product: the first `kept` of its operands are intersected, the others taken away; both in the order of the
 * tree. */
typedef struct product {
    int32_t *operands; /* in the form's operands */
    size_t   kept, count;
    box3     box; /* of what is kept, solid's space */
} product;

typedef struct product_list {
    product *items;
    size_t   count, capacity;
    bool     too_many; /* there would be more than the limit; the list is empty then */
} product_list;

enum { PRODUCTS_MAX = 4096, PRODUCT_OPERANDS_MAX = 1 << 18 };

/* Of the whole form, or of one of its terms. Errors: LMN_MEMORY. */
lmn_status solid_products_create(product_list *out, const solid_form *form, int32_t term, bool prune, lmn_error *error);
void       solid_products_release(product_list *l);

#endif
