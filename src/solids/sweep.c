/* Surfaces of solids on every GL: the operands are peeled fragment by fragment, front faces and back faces, and
 * after each one the normal form says at each pixel whether the solid begins or ends there. One pass over the
 * geometry and one over the picture for each fragment of the deepest pixel; 128 bytes a pixel. Needs no storage
 * blocks, no limit on how operands are shaped, and gives every layer. Nienhaus et al. 2006, 5.1: the CSG
 * calculation is done for each layer, for what faces to the camera and what faces away; rows K01, K03, C2, C5, C6. */
#include "solids/solids_private.h"

#include <string.h>

#include "base/memory.h"

enum { BITS_MAX = 256, FACTS_A_ROW = 256, PRODUCTS_A_ROW = 64, TEXELS_A_PRODUCT = 4, STEPS_MAX = 65536, PICTURES = 4 };

/* Operands by what they do and how they are seen: in the order in which coincident ones come. */
static const struct {
    bool     taken_away;
    gpu_cull cull;
} classes[] = {{false, GPU_CULL_FRONT}, {true, GPU_CULL_BACK}, {true, GPU_CULL_FRONT}, {false, GPU_CULL_BACK}};

typedef struct sweep {
    const solid_view *v;
    solid_layers     *solids;
    const bool       *wanted;
    bool              rest_only;  /* what no product of convex operands has */
    bool              around_eye; /* only what holds around the eye is being found out */
    gpu_texture      *facts, *products;
    gpu_texture      *fragment, *depth;
    gpu_texture      *now[PICTURES], *next[PICTURES]; /* state, bits, more bits, surfaces found */
    uint32_t (*runs)[2];
} sweep;

static bool takes_part(const sweep *s, const upload_solid *solid, size_t operand)
{
    return !s->rest_only || !solid->in_products[operand];
}

/* --- tables --------------------------------------------------------------------------------------------- */

typedef struct tables {
    uint32_t (*facts)[4];
    size_t fact_rows, bits;
    uint32_t (*products)[4];
    size_t product_count, product_rows;
} tables;

static void add_products(tables *t, const product_list *l, size_t first_bit, const size_t *bits)
{
    for (size_t i = 0; i < l->count; i++) {
        uint32_t(*texels)[4] = &t->products[TEXELS_A_PRODUCT * t->product_count++];
        for (size_t k = 0; k < l->items[i].count; k++) {
            size_t bit = first_bit + bits[l->items[i].operands[k]], half = bit / 128 + (k < l->items[i].kept ? 0 : 2);
            texels[half][bit % 128 / 32] |= 1u << bit % 32;
        }
    }
}

static bool capacity_for(const sweep *s, tables *t)
{
    const upload *u = s->v->up;
    size_t        operands = 0, products = 0, bits = 0;
    for (size_t i = 0; i < u->item_count; i++) {
        if (!s->wanted[i])
            continue;
        const upload_solid *solid = &u->solids[u->items[i].solid];
        if (solid->rest.too_many)
            return false;
        operands =
            u->items[i].first_operand + solid->count > operands ? u->items[i].first_operand + solid->count : operands;
        products += solid->rest.count + (s->rest_only ? 0 : solid->products.count);
        for (size_t k = 0; k < solid->count; k++)
            bits += takes_part(s, solid, k);
    }
    t->fact_rows = operands / FACTS_A_ROW + 1;
    t->product_rows = products / PRODUCTS_A_ROW + 1;
    return bits <= BITS_MAX;
}

/* Numbers of the bits that an item's operands have; returns how many. */
static size_t number_bits(const sweep *s, const upload_solid *solid, size_t *bits)
{
    size_t count = 0;
    for (size_t k = 0; k < solid->count; k++)
        bits[k] = takes_part(s, solid, k) ? count++ : 0;
    return count;
}

static void add_item(const sweep *s, tables *t, size_t index, size_t *bits)
{
    const draw_item    *item = &s->v->up->items[index];
    const upload_solid *solid = &s->v->up->solids[item->solid];
    size_t              first = t->product_count, count = number_bits(s, solid, bits);
    if (!s->rest_only)
        add_products(t, &solid->products, t->bits, bits);
    add_products(t, &solid->rest, t->bits, bits);
    for (size_t k = 0; k < solid->count; k++)
        memcpy(t->facts[item->first_operand + k],
               (uint32_t[]){(uint32_t)(t->bits + bits[k]), (uint32_t)first, (uint32_t)(t->product_count - first),
                            (uint32_t)index},
               sizeof t->facts[0]);
    t->bits += count;
}

/* False when the products or their operands are too many. */
static bool make_tables(sweep *s)
{
    tables            t = {.bits = 0};
    const solid_view *v = s->v;
    if (!capacity_for(s, &t))
        return false;
    size_t *bits = mem_calloc(CSG_OPERANDS_MAX, sizeof *bits);
    t.facts = mem_calloc(t.fact_rows * FACTS_A_ROW, sizeof *t.facts);
    t.products = mem_calloc(t.product_rows * PRODUCTS_A_ROW * TEXELS_A_PRODUCT, sizeof *t.products);
    s->runs = mem_calloc(CSG_OPERANDS_MAX, sizeof *s->runs);
    if (bits && t.facts && t.products && s->runs) {
        for (size_t i = 0; i < v->up->item_count; i++)
            if (s->wanted[i])
                add_item(s, &t, i, bits);
        s->facts = gpu_target_acquire(v->g, FACTS_A_ROW, (int)t.fact_rows, GPU_RGBA32UI);
        s->products = gpu_target_acquire(v->g, PRODUCTS_A_ROW * TEXELS_A_PRODUCT, (int)t.product_rows, GPU_RGBA32UI);
        gpu_target_write(v->g, s->facts, (int[]){0, 0, FACTS_A_ROW, (int)t.fact_rows}, t.facts);
        gpu_target_write(v->g, s->products, (int[]){0, 0, PRODUCTS_A_ROW * TEXELS_A_PRODUCT, (int)t.product_rows},
                         t.products);
    } else {
        gpu_fail(v->g, LMN_MEMORY, "out of memory");
    }
    mem_free(bits);
    mem_free(t.facts);
    mem_free(t.products);
    return true;
}

/* --- one fragment a pixel ------------------------------------------------------------------------------- */

static gpu_pass pass_in(const sweep *s)
{
    gpu_pass pass = {.clear = false};
    memcpy(pass.scissor, s->solids->box, sizeof pass.scissor);
    memcpy(pass.clear_box, s->solids->box, sizeof pass.clear_box);
    return pass;
}

static void draw_class(sweep *s, size_t item_index, size_t which)
{
    const solid_view   *v = s->v;
    const draw_item    *item = &v->up->items[item_index];
    const upload_solid *solid = &v->up->solids[item->solid];
    size_t              count = 0;
    for (size_t k = 0; k < solid->count; k++)
        if (solid->taken_away[k] == classes[which].taken_away && takes_part(s, solid, k))
            memcpy(s->runs[count++], solid->runs[k], sizeof s->runs[0]);
    gpu_cull_faces(v->g, classes[which].cull);
    solids_set_operands(v, s->solids, item);
    gpu_draw_mesh_runs(v->g, item->mesh, s->runs, count);
}

/* The next fragment of each pixel that does not wait. Was there any? */
static bool draw_next(sweep *s)
{
    const solid_view *v = s->v;
    text              prelude = {0};
    text_append(&prelude, "#define SHARED_PLANES\n%s", s->around_eye ? "#define AROUND_EYE\n" : "");
    gpu_program *p = view_program(v->g, GPU_FLOOR, "csg/operand.vert", "csg/sweep.frag", &prelude);
    if (!p || gpu_failed(v->g))
        return false;
    gpu_pass pass = pass_in(s);
    pass.colours[0] = s->fragment;
    pass.colour_count = 1;
    pass.depth = s->depth;
    pass.clear = true;
    gpu_pass_begin(v->g, &pass);
    gpu_use(v->g, p,
            (gpu_state){.depth_test = true, .depth_write = true, .depth_compare = GPU_LESS, .depth_clamp = true});
    gpu_set_texture(v->g, "t_state", s->now[0], false);
    gpu_set_texture(v->g, "t_found", s->now[3], false);
    gpu_set_float(v->g, "u_solid_range", (float)(v->camera->far - s->solids->near));
    gpu_query_begin(v->g, 0);
    /* Of what lies at the same depth the first that is drawn stays. */
    for (size_t c = 0; c < sizeof classes / sizeof *classes; c++)
        for (size_t i = 0; i < v->up->item_count && !gpu_failed(v->g); i++)
            if (s->wanted[i])
                draw_class(s, i, c);
    gpu_query_end(v->g);
    gpu_cull_faces(v->g, GPU_CULL_NONE);
    return gpu_query_any(v->g, 0);
}

static void take_fragment(sweep *s)
{
    static const char *const names[PICTURES] = {"t_state", "t_inside", "t_inside_more", "t_found"};
    const solid_view        *v = s->v;
    text                     prelude = {0};
    text_append(&prelude, "%s", s->around_eye ? "#define AROUND_EYE\n" : "");
    gpu_program *p = view_program(v->g, GPU_FLOOR, "gpu/screen.vert", "csg/sweep_step.frag", &prelude);
    if (!p || gpu_failed(v->g))
        return;
    gpu_pass pass = pass_in(s);
    pass.colour_count = PICTURES;
    memcpy(pass.colours, s->next, sizeof s->next);
    gpu_pass_begin(v->g, &pass);
    gpu_use(v->g, p, (gpu_state){0});
    gpu_set_texture(v->g, "t_fragment", s->fragment, false);
    for (int i = 0; i < PICTURES; i++)
        gpu_set_texture(v->g, names[i], s->now[i], false);
    gpu_set_texture(v->g, "t_facts", s->facts, false);
    gpu_set_texture(v->g, "t_products", s->products, false);
    gpu_set_float(v->g, "u_solid_range", (float)(v->camera->far - s->solids->near));
    solids_set_depth(v, s->solids);
    gpu_draw_screen(v->g);
    gpu_texture *swap[PICTURES];
    memcpy(swap, s->now, sizeof swap);
    memcpy(s->now, s->next, sizeof swap);
    memcpy(s->next, swap, sizeof swap);
}

/* Draws a picture of surfaces with a depth test; or, without one, asks whether it has any. */
static bool put_among(sweep *s, gpu_texture *surfaces, gpu_texture *into, gpu_texture *depth)
{
    const solid_view *v = s->v;
    text              prelude = {0};
    text_append(&prelude, "%s", into ? "" : "#define COUNTED\n");
    gpu_program *p = view_program(v->g, GPU_FLOOR, "gpu/screen.vert", "csg/among.frag", &prelude);
    if (!p || gpu_failed(v->g))
        return false;
    gpu_pass pass = pass_in(s);
    pass.colours[0] = into;
    pass.colour_count = into != NULL;
    pass.depth = depth;
    gpu_pass_begin(v->g, &pass);
    gpu_use(v->g, p, (gpu_state){.depth_test = into != NULL, .depth_write = into != NULL, .depth_compare = GPU_LESS});
    gpu_set_texture(v->g, "t_surfaces", surfaces, false);
    solids_set_depth(v, s->solids);
    gpu_query_begin(v->g, 0);
    gpu_draw_screen(v->g);
    gpu_query_end(v->g);
    return gpu_query_any(v->g, 0);
}

/* --- layers --------------------------------------------------------------------------------------------- */

static void sweep_open(sweep *s)
{
    const solid_view *v = s->v;
    s->fragment = gpu_target_acquire(v->g, v->width, v->height, GPU_RGBA32UI);
    s->depth = gpu_target_acquire(v->g, v->width, v->height, GPU_DEPTH32F);
    for (int i = 0; i < PICTURES; i++) {
        s->now[i] = gpu_target_acquire(v->g, v->width, v->height, GPU_RGBA32UI);
        s->next[i] = gpu_target_acquire(v->g, v->width, v->height, GPU_RGBA32UI);
    }
    gpu_pass pass = {.clear = true, .colour_count = PICTURES};
    memcpy(pass.colours, s->now, sizeof s->now);
    if (!gpu_failed(v->g))
        gpu_pass_begin(v->g, &pass);
}

static void sweep_close(sweep *s)
{
    gpu *g = s->v->g;
    gpu_target_release(g, s->facts);
    gpu_target_release(g, s->products);
    gpu_target_release(g, s->fragment);
    gpu_target_release(g, s->depth);
    for (int i = 0; i < PICTURES; i++) {
        gpu_target_release(g, s->now[i]);
        gpu_target_release(g, s->next[i]);
    }
    mem_free(s->runs);
}

/* Until every pixel has found its next surface or nothing is left. */
static void find_layer(sweep *s)
{
    bool more = true;
    for (int step = 0; more && step < STEPS_MAX && !gpu_failed(s->v->g); step++) {
        more = draw_next(s);
        take_fragment(s);
    }
}

/* All fragments once, for what holds where the eye is; then from the beginning again. */
static void look_around(sweep *s)
{
    s->around_eye = true;
    find_layer(s);
    s->around_eye = false;
    gpu_pass pass = pass_in(s);
    pass.colours[0] = s->now[0];
    pass.colour_count = 1;
    pass.clear = true;
    if (!gpu_failed(s->v->g))
        gpu_pass_begin(s->v->g, &pass);
}

/* Keeps the layer that was found and makes a blank one for the next. */
static bool keep_layer(sweep *s)
{
    const solid_view *v = s->v;
    solid_layers     *l = s->solids;
    gpu_texture     **grown = mem_realloc(l->kept, (size_t)(l->count + 1) * sizeof *grown);
    if (!grown) {
        gpu_fail(v->g, LMN_MEMORY, "out of memory");
        return false;
    }
    l->kept = grown;
    l->kept[l->count++] = s->now[3];
    s->now[3] = gpu_target_acquire(v->g, v->width, v->height, GPU_RGBA32UI);
    if (!gpu_failed(v->g))
        gpu_pass_begin(v->g, &(gpu_pass){.colours = {s->now[3]}, .colour_count = 1, .clear = true});
    return !gpu_failed(v->g);
}

bool solids_sweep(const solid_view *v, solid_layers *l, const bool *wanted, bool inside, int layers)
{
    sweep s = {.v = v, .solids = l, .wanted = wanted, .rest_only = l->depth != NULL};
    if (!make_tables(&s))
        return false;
    sweep_open(&s);
    if (inside)
        look_around(&s);
    if (l->first_only) {
        find_layer(&s);
        if (l->depth) {
            put_among(&s, s.now[3], l->surfaces, l->depth);
        } else {
            gpu_texture *swap = l->surfaces;
            l->nearest = l->surfaces = s.now[3];
            s.now[3] = swap;
        }
    }
    if (!l->first_only) { /* they are all kept */
        gpu_target_release(v->g, l->nearest);
        l->nearest = l->surfaces = NULL;
    }
    for (int layer = 0; !l->first_only && layer < layers && !gpu_failed(v->g); layer++) {
        find_layer(&s);
        if (!put_among(&s, s.now[3], NULL, s.depth) || !keep_layer(&s))
            break;
    }
    if (l->kept)
        l->surfaces = l->kept[0];
    sweep_close(&s);
    return true;
}
