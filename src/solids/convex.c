/* The nearest surface of products of convex operands, by depth and stencil tests alone: a depth buffer is moved
 * backwards until no operand that is taken away holds it. Operands are taken away in the order of their distance,
 * so that what is seen through several holes is mostly found in one round; rounds go on until nothing moves
 * (sequenced convex subtraction, Stewart et al. 1998). Products that do not meet on the page are done at the same
 * time, and so are operands that do not. No shader runs before the last pass, which asks whose surface lies at the
 * depth that was found. Nienhaus et al. 2006, section 2; rows K02, C3. */
#include "solids/solids_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"

enum { FACES_FRONT, FACES_BACK, ROUNDS_MAX = 4096, COUNT_MAX = 255 };

/* An operand of a product of an item, with the pixels that it can cover. */
typedef struct literal {
    const draw_item *item;
    uint32_t         run[2];
    int              pixels[4];
    double           distance; /* of its middle */
    bool             meets;
    int              level; /* literals of a lower level that meet it on the page come first */
} literal;

typedef struct convex_product {
    literal *literals; /* kept ones first */
    size_t   kept, count;
    int      pixels[4]; /* of all literals */
    int      batch;
} convex_product;

typedef struct convex_job {
    const solid_view *v;
    solid_layers     *solids;
    gpu_texture      *depth;  /* with stencil */
    gpu_texture      *before; /* depth of the batches before, while surfaces are identified; NULL: none */
    bool              cleared;
    literal          *literals; /* of all products */
    convex_product   *products;
    size_t            product_count;
    const literal   **chosen; /* room for all of one draw */
    uint32_t (*runs)[2];
} convex_job;

static bool overlap(const int a[4], const int b[4])
{
    return a[0] < b[0] + b[2] && b[0] < a[0] + a[2] && a[1] < b[1] + b[3] && b[1] < a[1] + a[3];
}

bool solids_have_convex(const solid_view *v, const bool *wanted, bool *all)
{
    bool any = false;
    *all = true;
    for (size_t i = 0; i < v->up->item_count; i++) {
        if (!wanted[i])
            continue;
        const upload_solid *s = &v->up->solids[v->up->items[i].solid];
        any = any || s->products.count > 0;
        *all = *all && s->all_convex;
    }
    return any;
}

/* --- what there is to do -------------------------------------------------------------------------------- */

static literal make_literal(const solid_view *v, const draw_item *item, const upload_solid *s, int32_t operand)
{
    box3    box = box3_transform(s->boxes[operand], &item->world);
    literal l = {.item = item, .run = {s->runs[operand][0], s->runs[operand][1]}, .meets = s->meets[operand]};
    camera_pixels(v->camera, box, v->width, v->height, 1, l.pixels);
    double nearest = INFINITY, farthest = -INFINITY;
    camera_depth_range(v->camera, box, &nearest, &farthest);
    l.distance = nearest + farthest;
    return l;
}

static int by_distance(const void *a, const void *b)
{
    const literal *x = a, *y = b;
    if (x->distance != y->distance)
        return x->distance < y->distance ? -1 : 1;
    return (x->run[0] > y->run[0]) - (x->run[0] < y->run[0]);
}

/* Subtractions that meet on the page follow each other, from near to far; the others go together. */
static void set_levels(convex_product *p)
{
    literal *taken = p->literals + p->kept;
    size_t   count = p->count - p->kept;
    qsort(taken, count, sizeof *taken, by_distance);
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < i; k++)
            if (taken[k].level >= taken[i].level && overlap(taken[k].pixels, taken[i].pixels))
                taken[i].level = taken[k].level + 1;
}

static void add_product(convex_job *job, const draw_item *item, const upload_solid *s, const product *p, literal **next)
{
    convex_product *out = &job->products[job->product_count++];
    *out = (convex_product){.literals = *next, .kept = p->kept, .count = p->count};
    for (size_t i = 0; i < p->count; i++) {
        out->literals[i] = make_literal(job->v, item, s, p->operands[i]);
        if (i == 0)
            memcpy(out->pixels, out->literals[0].pixels, sizeof out->pixels);
        camera_widen_pixels(out->pixels, out->literals[i].pixels);
    }
    *next += p->count;
    set_levels(out);
}

static bool one_batch(const convex_product *a, const convex_product *b)
{
    bool plain = a->count == 1;
    return plain == (b->count == 1) && (plain || a->kept == b->kept);
}

/* Products of one batch keep apart on the page and intersect the same number of operands; those of one operand
 * alone need not keep apart. Where surfaces may coincide, products that meet keep their order, since the first of
 * them then has the surface. Returns how many batches there are. */
static int make_batches(convex_job *job, bool ordered)
{
    int                    batches = 0;
    const convex_product **first = mem_calloc(job->product_count + 1, sizeof *first); /* of each batch */
    if (!first) {
        gpu_fail(job->v->g, LMN_MEMORY, "out of memory");
        return 0;
    }
    for (size_t i = 0; i < job->product_count; i++) {
        convex_product *p = &job->products[i];
        for (bool settled = false; !settled;) {
            settled = true;
            while (p->batch < batches && !one_batch(first[p->batch], p))
                p->batch++;
            for (size_t k = 0; k < i; k++) {
                const convex_product *other = &job->products[k];
                bool                  stands_in_way = ordered ? other->batch >= p->batch : other->batch == p->batch;
                bool                  may_share = other->batch == p->batch && p->count == 1 && other->count == 1;
                if (stands_in_way && !may_share && overlap(other->pixels, p->pixels)) {
                    p->batch = ordered ? other->batch + 1 : p->batch + 1;
                    settled = false;
                }
            }
        }
        if (p->batch >= batches)
            batches = p->batch + 1;
        if (!first[p->batch])
            first[p->batch] = p;
    }
    mem_free(first);
    return batches;
}

static bool job_open(convex_job *job, const bool *wanted)
{
    const upload *u = job->v->up;
    size_t        literals = 1, products = 1;
    for (size_t i = 0; i < u->item_count; i++) {
        const product_list *l = wanted[i] ? &u->solids[u->items[i].solid].products : NULL;
        products += l ? l->count : 0;
        for (size_t k = 0; l && k < l->count; k++)
            literals += l->items[k].count;
    }
    job->literals = mem_calloc(literals, sizeof *job->literals);
    job->products = mem_calloc(products, sizeof *job->products);
    job->chosen = mem_calloc(literals + products, sizeof *job->chosen);
    job->runs = mem_calloc(literals + products, sizeof *job->runs);
    if (!job->literals || !job->products || !job->chosen || !job->runs) {
        gpu_fail(job->v->g, LMN_MEMORY, "out of memory");
        return false;
    }
    literal *next = job->literals;
    for (size_t i = 0; i < u->item_count; i++)
        for (size_t k = 0; wanted[i] && k < u->solids[u->items[i].solid].products.count; k++)
            add_product(job, &u->items[i], &u->solids[u->items[i].solid],
                        &u->solids[u->items[i].solid].products.items[k], &next);
    return true;
}

static void job_close(convex_job *job)
{
    gpu_target_release(job->v->g, job->depth);
    mem_free(job->literals);
    mem_free(job->products);
    mem_free(job->chosen);
    mem_free(job->runs);
}

/* --- drawing -------------------------------------------------------------------------------------------- */

/* Faces of the first `count` chosen literals, item by item. */
static void draw_chosen(convex_job *job, size_t count, int faces, const char *fragment, gpu_state state)
{
    const solid_view *v = job->v;
    for (size_t first = 0, end; first < count && !gpu_failed(v->g); first = end) {
        const draw_item *item = job->chosen[first]->item;
        for (end = first; end < count && job->chosen[end]->item == item; end++)
            memcpy(job->runs[end - first], job->chosen[end]->run, sizeof job->runs[0]);
        text prelude = {0};
        text_append(&prelude, "%s%s", item->plane_count ? "#define SHARED_PLANES\n" : "",
                    job->before ? "#define AMONG_OTHERS\n" : "");
        gpu_program *p = view_program(v->g, GPU_FLOOR, "csg/operand.vert", fragment, &prelude);
        state.depth_clamp = true;
        gpu_use(v->g, p, state);
        gpu_cull_faces(v->g, faces == FACES_FRONT ? GPU_CULL_BACK : GPU_CULL_FRONT);
        solids_set_operands(v, job->solids, item);
        if (job->before)
            gpu_set_texture(v->g, "t_before", job->before, false);
        gpu_draw_mesh_runs(v->g, item->mesh, job->runs, end - first);
    }
}

/* The rectangles of a batch's products. */
static void draw_rectangles(convex_job *job, int batch, float depth, gpu_state state)
{
    const solid_view *v = job->v;
    text              prelude = {0};
    gpu_program      *p = view_program(v->g, GPU_FLOOR, "csg/flat.vert", "csg/depth.frag", &prelude);
    int(*boxes)[4] = mem_alloc((job->product_count + 1) * sizeof *boxes);
    size_t count = 0;
    for (size_t i = 0; boxes && i < job->product_count; i++)
        if (job->products[i].batch == batch)
            memcpy(boxes[count++], job->products[i].pixels, sizeof *boxes);
    if (!boxes)
        gpu_fail(v->g, LMN_MEMORY, "out of memory");
    if (p && !gpu_failed(v->g)) {
        gpu_use(v->g, p, state);
        gpu_cull_faces(v->g, GPU_CULL_NONE);
        gpu_set_vec2(v->g, "u_target", (float)v->width, (float)v->height);
        gpu_set_float(v->g, "u_flat_depth", depth);
        gpu_draw_boxes(v->g, boxes, count);
    }
    mem_free(boxes);
}

/* Chooses what operands of a batch's products have in common. Returns how many. */
static size_t choose_kept(convex_job *job, int batch, size_t which)
{
    size_t count = 0;
    for (size_t i = 0; i < job->product_count; i++)
        if (job->products[i].batch == batch && which < job->products[i].kept)
            job->chosen[count++] = &job->products[i].literals[which];
    return count;
}

static size_t choose_level(convex_job *job, int batch, int level, bool meeting_only)
{
    size_t count = 0;
    for (size_t i = 0; i < job->product_count; i++) {
        const convex_product *p = &job->products[i];
        for (size_t k = p->kept; p->batch == batch && k < p->count; k++)
            if (p->literals[k].level == level && (p->literals[k].meets || !meeting_only))
                job->chosen[count++] = &p->literals[k];
    }
    return count;
}

static const gpu_state write_depth = {.depth_test = true, .depth_write = true, .depth_compare = GPU_ALWAYS};

/* The farthest front of what is intersected. */
static void intersect(convex_job *job, int batch, size_t kept)
{
    gpu_state state = {.depth_test = true, .depth_write = true, .depth_compare = GPU_LESS_EQUAL};
    for (size_t i = 0; i < kept; i++) {
        draw_chosen(job, choose_kept(job, batch, i), FACES_FRONT, "csg/depth.frag", state);
        state.depth_compare = GPU_GREATER;
    }
}

/* Where the depth lies inside an operand, it moves to that operand's back. */
static void take_away(convex_job *job, int batch, int level, bool again)
{
    gpu_state mark = {.depth_test = true,
                      .depth_compare = GPU_LESS_EQUAL,
                      .stencil = {true, GPU_ALWAYS, 1, GPU_STENCIL_KEEP, GPU_STENCIL_KEEP, GPU_STENCIL_REPLACE}};
    gpu_state move = {.depth_test = true,
                      .depth_write = true,
                      .depth_compare = GPU_GREATER,
                      .stencil = {true, GPU_EQUAL, 1, GPU_STENCIL_ZERO, GPU_STENCIL_ZERO, GPU_STENCIL_ZERO}};
    size_t    count = choose_level(job, batch, level, again);
    draw_chosen(job, count, FACES_FRONT, "csg/depth.frag", mark);
    if (again)
        gpu_query_begin(job->v->g, level % GPU_QUERIES);
    draw_chosen(job, count, FACES_BACK, "csg/depth.frag", move);
    if (again)
        gpu_query_end(job->v->g);
}

/* Once more, for those that meet others. Did anything move? */
static bool take_away_again(convex_job *job, int batch, int levels)
{
    bool moved = false;
    for (int first = 0; first < levels; first += GPU_QUERIES) {
        int end = first + GPU_QUERIES < levels ? first + GPU_QUERIES : levels;
        for (int level = first; level < end; level++)
            take_away(job, batch, level, true);
        for (int level = first; level < end; level++)
            moved = gpu_query_any(job->v->g, level % GPU_QUERIES) || moved;
    }
    return moved;
}

static void take_all_away(convex_job *job, int batch)
{
    int  levels = 0;
    bool meets = false;
    for (size_t i = 0; i < job->product_count; i++)
        for (size_t k = job->products[i].kept; job->products[i].batch == batch && k < job->products[i].count; k++) {
            const literal *l = &job->products[i].literals[k];
            levels = l->level >= levels ? l->level + 1 : levels;
            meets = meets || l->meets;
        }
    for (int level = 0; level < levels; level++)
        take_away(job, batch, level, false);
    for (int round = 1; meets && round < ROUNDS_MAX && !gpu_failed(job->v->g); round++)
        meets = take_away_again(job, batch, levels);
}

/* Only where the backs of all that is intersected lie behind is there anything. */
static void clip(convex_job *job, int batch, size_t kept)
{
    gpu_state count = {.depth_test = true,
                       .depth_compare = GPU_GREATER,
                       .stencil = {true, GPU_ALWAYS, 0, GPU_STENCIL_KEEP, GPU_STENCIL_KEEP, GPU_STENCIL_COUNT}};
    for (size_t i = 0, counted = 0; i < kept; i++) {
        draw_chosen(job, choose_kept(job, batch, i), FACES_BACK, "csg/depth.frag", count);
        counted++;
        if (counted < COUNT_MAX && i + 1 < kept)
            continue;
        gpu_state drop = write_depth, forget = {.depth_test = true, .depth_compare = GPU_ALWAYS};
        drop.stencil =
            (gpu_stencil){true, GPU_NOT_EQUAL, (int)counted, GPU_STENCIL_KEEP, GPU_STENCIL_KEEP, GPU_STENCIL_KEEP};
        forget.stencil = (gpu_stencil){true, GPU_ALWAYS, 0, GPU_STENCIL_ZERO, GPU_STENCIL_ZERO, GPU_STENCIL_ZERO};
        draw_rectangles(job, batch, 1, drop);
        draw_rectangles(job, batch, 1, forget);
        counted = 0;
    }
}

/* The batch's depth into that of all. */
static void merge(convex_job *job, int batch, gpu_texture *into)
{
    const solid_view *v = job->v;
    int(*boxes)[4] = mem_alloc((job->product_count + 1) * sizeof *boxes);
    size_t       count = 0;
    text         prelude = {0};
    gpu_program *p = view_program(v->g, GPU_FLOOR, "gpu/boxes.vert", "csg/merge.frag", &prelude);
    for (size_t i = 0; boxes && i < job->product_count; i++)
        if (job->products[i].batch == batch)
            memcpy(boxes[count++], job->products[i].pixels, sizeof *boxes);
    if (p && boxes) {
        gpu_pass_begin(v->g, &(gpu_pass){.depth = into});
        gpu_use(v->g, p, (gpu_state){.depth_test = true, .depth_write = true, .depth_compare = GPU_LESS});
        gpu_set_texture(v->g, "t_depth", job->depth, false);
        gpu_set_vec2(v->g, "u_target", (float)v->width, (float)v->height);
        gpu_draw_boxes(v->g, boxes, count);
    }
    mem_free(boxes);
}

static void draw_batch(convex_job *job, int batch)
{
    size_t kept = 0;
    gpu_pass_begin(job->v->g, &(gpu_pass){.depth = job->depth, .clear = !job->cleared});
    if (job->cleared)
        draw_rectangles(job, batch, 1, write_depth);
    job->cleared = true;
    for (size_t i = 0; i < job->product_count; i++)
        if (job->products[i].batch == batch)
            kept = job->products[i].kept;
    intersect(job, batch, kept);
    take_all_away(job, batch);
    clip(job, batch, kept);
}

/* Whose surfaces they are: of each product what is taken away first, then what is kept; of what coincides the last
 * stays. */
static void identify(convex_job *job, int batch, gpu_texture *depth, gpu_texture *before)
{
    job->before = before;
    gpu_pass_begin(job->v->g, &(gpu_pass){.colours = {job->solids->surfaces}, .colour_count = 1, .depth = depth});
    for (int kept = 0; kept < 2; kept++) {
        size_t count = 0;
        for (size_t i = 0; i < job->product_count; i++) {
            const convex_product *p = &job->products[i];
            for (size_t k = kept ? 0 : p->kept; p->batch == batch && k < (kept ? p->kept : p->count); k++)
                job->chosen[count++] = &p->literals[k];
        }
        draw_chosen(job, count, kept ? FACES_FRONT : FACES_BACK, "csg/identify.frag",
                    (gpu_state){.depth_test = true, .depth_compare = GPU_EQUAL});
    }
    job->before = NULL;
}

/* Of operands that are products by themselves the nearest front is seen. */
static void draw_plain(convex_job *job, int batch, gpu_texture *depth)
{
    gpu_pass_begin(job->v->g, &(gpu_pass){.colours = {job->solids->surfaces}, .colour_count = 1, .depth = depth});
    draw_chosen(job, choose_kept(job, batch, 0), FACES_FRONT, "csg/identify.frag",
                (gpu_state){.depth_test = true, .depth_write = true, .depth_compare = GPU_LESS});
}

static void draw_batches(convex_job *job, int batches, gpu_texture *all)
{
    bool alone = all == job->depth;
    if (!alone)
        gpu_pass_begin(job->v->g, &(gpu_pass){.depth = all, .clear = true});
    for (int batch = 0; batch < batches && !gpu_failed(job->v->g); batch++) {
        bool plain = false;
        for (size_t i = 0; i < job->product_count; i++)
            plain = plain || (job->products[i].batch == batch && job->products[i].count == 1);
        if (plain) {
            draw_plain(job, batch, all);
            continue;
        }
        draw_batch(job, batch);
        identify(job, batch, job->depth, alone ? NULL : all);
        if (!alone)
            merge(job, batch, all);
    }
}

gpu_texture *solids_draw_convex(const solid_view *v, solid_layers *s, const bool *wanted)
{
    convex_job   job = {.v = v, .solids = s};
    gpu_texture *all = NULL;
    if (job_open(&job, wanted)) {
        bool planes = false, plain = false;
        for (size_t i = 0; i < job.product_count; i++) {
            planes = planes || job.products[i].literals[0].item->plane_count > 0;
            plain = plain || job.products[i].count == 1;
        }
        int batches = make_batches(&job, planes);
        job.depth = gpu_target_acquire(v->g, v->width, v->height, GPU_DEPTH32F_STENCIL8);
        all = batches == 1 && !plain ? job.depth : gpu_target_acquire(v->g, v->width, v->height, GPU_DEPTH32F);
        if (!gpu_failed(v->g))
            draw_batches(&job, batches, all);
        gpu_cull_faces(v->g, GPU_CULL_NONE);
        if (all == job.depth)
            job.depth = NULL;
    }
    job_close(&job);
    return all;
}
