/* Solids: which surface lies at which pixel. One geometry pass puts every fragment of the operands into lists, one
 * a pixel (GL 4.3 storage blocks), and one pass over the picture sorts them and runs the trees: 16 bytes a
 * fragment, 4 more where all layers are wanted, and 20 a pixel. Where the lists have no room for all of the
 * picture, it is done in bands. */
#include "solids/solids_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"

enum { KEPT = 8, NODE_BYTES = 16, PLANES_A_ROW = 256, BANDS_MAX = 4096 };

/* A plane in eye space: the inverse transpose of the way there, from the cofactors of its rotation part. */
static void eye_plane(const mat4 *to_eye, const csg_plane *p, float out[4])
{
    const double *m = to_eye->m;
    double        c[9], n[3], position[3], length = 0, distance = 0;
    mat4_cofactors(to_eye, c);
    for (int k = 0; k < 3; k++) {
        n[k] = c[k] * p->normal[0] + c[3 + k] * p->normal[1] + c[6 + k] * p->normal[2];
        position[k] = m[12 + k];
        for (int j = 0; j < 3; j++)
            position[k] += m[4 * j + k] * p->normal[j] * p->distance;
        length += n[k] * n[k];
    }
    length = length > 0 ? sqrt(length) : 1;
    for (int k = 0; k < 3; k++) {
        distance += n[k] / length * position[k];
        out[k] = (float)(n[k] / length);
    }
    out[3] = (float)distance;
}

/* The shared planes of the wanted items, one after the other. */
static void open_planes(const solid_view *v, solid_layers *s, const bool *wanted)
{
    const upload *u = v->up;
    size_t        count = 1;
    for (size_t i = 0; i < u->item_count; i++)
        count += wanted[i] ? u->items[i].plane_count : 0;
    count = count < CSG_PLANES_MAX ? count : CSG_PLANES_MAX;
    int rows = (int)((count + PLANES_A_ROW - 1) / PLANES_A_ROW);
    float(*values)[4] = mem_calloc((size_t)rows * PLANES_A_ROW, sizeof *values);
    s->first_planes = mem_calloc(u->item_count, sizeof *s->first_planes);
    if (!values || !s->first_planes) {
        mem_free(values);
        gpu_fail(v->g, LMN_MEMORY, "out of memory");
        return;
    }
    size_t made = 0;
    for (size_t i = 0; i < u->item_count; i++) {
        if (!wanted[i])
            continue;
        if (made + u->items[i].plane_count > CSG_PLANES_MAX) {
            gpu_fail(v->g, LMN_LIMIT,
                     "instances of solids have more than %d planes in which faces of several operands lie",
                     CSG_PLANES_MAX);
            break;
        }
        s->first_planes[i] = (uint32_t)made;
        mat4 to_eye = mat4_multiply(&v->camera->view, &u->items[i].world);
        for (size_t k = 0; k < u->items[i].plane_count && made < count; k++)
            eye_plane(&to_eye, &u->planes[u->items[i].first_plane + k], values[made++]);
    }
    s->planes = gpu_target_acquire(v->g, PLANES_A_ROW, rows, GPU_RGBA32F);
    gpu_target_write(v->g, s->planes, (int[]){0, 0, PLANES_A_ROW, rows}, values);
    mem_free(values);
}

/* Where solids can be, and whether the eye may be in one of their operands. */
static bool find_box(const solid_view *v, const bool *wanted, int box[4])
{
    const upload           *u = v->up;
    const gpu_capabilities *facts = gpu_capabilities_of(v->g);
    bool                    any = false, inside = false;
    for (size_t i = 0; i < u->item_count; i++) {
        if (!wanted[i])
            continue;
        int    own[4];
        double nearest = INFINITY, farthest = -INFINITY;
        camera_depth_range(v->camera, u->items[i].reach, &nearest, &farthest);
        inside = inside || nearest <= (facts->depth_clamp ? 0 : v->camera->near);
        camera_pixels(v->camera, u->pose->part_boxes[u->items[i].part_index], v->width, v->height, 2, own);
        if (own[2] <= 0 || own[3] <= 0)
            continue;
        if (!any)
            memcpy(box, own, sizeof own);
        camera_widen_pixels(box, own);
        any = true;
    }
    if (!any)
        memset(box, 0, 4 * sizeof *box);
    return inside;
}

static void set_list_box(const solid_view *v, const int box[4])
{
    gpu_set_vec4(v->g, "u_list_box", (float[]){(float)box[0], (float)box[1], (float)box[2], (float)box[3]});
}

static void bind_buffers(const solid_view *v, const solid_layers *s)
{
    /* 0 to 2 are the layers' lists. */
    gpu_buffer_bind(v->g, s->heads, 3);
    gpu_buffer_bind(v->g, s->nodes, 4);
    gpu_buffer_bind(v->g, s->counter, 5);
    gpu_buffer_bind(v->g, v->up->program_buffer, 6);
    gpu_buffer_bind(v->g, s->chain, 7);
}

/* What the lists are to hold of an item: all of it, or what no product of convex operands has. */
static void draw_operands(const solid_view *v, const draw_item *item, bool products_done)
{
    const upload_solid *s = &v->up->solids[item->solid];
    if (!products_done || !s->products.count) {
        gpu_draw_mesh(v->g, item->mesh);
        return;
    }
    uint32_t(*runs)[2] = mem_alloc(s->count * sizeof *runs);
    size_t count = 0;
    for (size_t i = 0; runs && i < s->count; i++)
        if (!s->in_products[i])
            memcpy(runs[count++], s->runs[i], sizeof *runs);
    if (!runs)
        gpu_fail(v->g, LMN_MEMORY, "out of memory");
    gpu_draw_mesh_runs(v->g, item->mesh, runs, count);
    mem_free(runs);
}

/* Gathers a box's fragments; returns how many times the room is needed. */
static unsigned gather(const solid_view *v, solid_layers *s, const bool *wanted, const int box[4], unsigned limit)
{
    gpu_buffer_fill(v->g, s->heads, 0, (size_t)box[2] * (size_t)box[3] * sizeof(uint32_t));
    gpu_buffer_fill(v->g, s->counter, 0, 64);
    bind_buffers(v, s);
    /* Nothing is written but the lists; a framebuffer needs a picture all the same. */
    gpu_pass pass = {.depth = v->page_depth};
    memcpy(pass.scissor, box, sizeof pass.scissor);
    gpu_pass_begin(v->g, &pass);
    for (size_t i = 0; i < v->up->item_count && !gpu_failed(v->g); i++) {
        if (!wanted[i])
            continue;
        text prelude = {0};
        text_append(&prelude, "%s", v->up->items[i].plane_count ? "#define SHARED_PLANES\n" : "");
        gpu_use(v->g, view_program(v->g, GPU_FAST, "csg/operand.vert", "csg/gather.frag", &prelude),
                (gpu_state){.depth_clamp = true});
        set_list_box(v, box);
        gpu_set_uint(v->g, "u_node_limit", limit);
        solids_set_operands(v, s, &v->up->items[i]);
        draw_operands(v, &v->up->items[i], s->depth != NULL);
    }
    gpu_buffer_barrier(v->g);
    uint32_t made = 0;
    gpu_buffer_read(v->g, s->counter, sizeof made, &made);
    return made / limit + 1;
}

/* A number that is not negative, as shaders compare it. */
static uint32_t bits_of(float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

static size_t power_of_two(size_t n)
{
    size_t p = 1;
    while (p < n)
        p *= 2;
    return p;
}

/* Runs the trees over a box; its nearest surfaces go into the current picture. */
static void resolve(const solid_view *v, solid_layers *s, const int box[4], bool inside)
{
    const csg_program *c = &v->up->program;
    text               prelude = {0};
    text_append(&prelude, "#define KEPT %d\n#define OPERAND_WORDS %zu\n#define TERMS %zu\n%s%s%s", KEPT,
                power_of_two(c->operand_count / 32 + 1), c->term_count ? power_of_two(c->term_count) : 0,
                s->first_only ? "#define FIRST_ONLY\n" : "", inside ? "#define EYE_MAY_BE_INSIDE\n" : "",
                s->depth ? "#define DEPTH_TESTED\n" : "");
    gpu_program *p = view_program(v->g, GPU_FAST, "gpu/screen.vert", "csg/resolve.frag", &prelude);
    if (!p || gpu_failed(v->g))
        return;
    gpu_pass pass = {.colours = {s->surfaces}, .colour_count = 1, .depth = s->depth};
    memcpy(pass.scissor, box, sizeof pass.scissor);
    gpu_pass_begin(v->g, &pass);
    gpu_use(v->g, p,
            (gpu_state){.depth_test = s->depth != NULL, .depth_write = s->depth != NULL, .depth_compare = GPU_LESS});
    set_list_box(v, box);
    solids_set_depth(v, s);
    gpu_set_uint(v->g, "u_beyond", bits_of((float)(v->camera->far - s->near)));
    gpu_set_uint(v->g, "u_operand_count", (unsigned)c->operand_count);
    bind_buffers(v, s);
    gpu_draw_screen(v->g);
    gpu_buffer_barrier(v->g);
}

/* The surfaces behind those of one picture into another. */
static void step(const solid_view *v, solid_layers *s, gpu_texture *from, gpu_texture *to, const int box[4])
{
    text         prelude = {0};
    gpu_program *p = view_program(v->g, GPU_FAST, "gpu/screen.vert", "csg/next.frag", &prelude);
    if (!p || gpu_failed(v->g))
        return;
    gpu_pass pass = {.colours = {to}, .colour_count = 1};
    memcpy(pass.scissor, box, sizeof pass.scissor);
    gpu_pass_begin(v->g, &pass);
    gpu_use(v->g, p, (gpu_state){0});
    gpu_set_texture(v->g, "t_surfaces", from, false);
    bind_buffers(v, s);
    gpu_draw_screen(v->g);
}

static gpu_texture *blank_picture(const solid_view *v)
{
    gpu_texture *t = gpu_target_acquire(v->g, v->width, v->height, GPU_RGBA32UI);
    if (t)
        gpu_pass_begin(v->g, &(gpu_pass){.colours = {t}, .colour_count = 1, .clear = true});
    return t;
}

/* Layers that the pixels of a band have, at most: counted while the trees ran. */
static int layers_of_band(const solid_view *v, solid_layers *s)
{
    uint32_t words[2] = {0};
    gpu_buffer_read(v->g, s->counter, sizeof words, words);
    return (int)words[1];
}

/* Keeps all layers of a band, since its lists are about to go. */
static bool keep_layers(const solid_view *v, solid_layers *s, const int box[4], int count)
{
    if (count > s->count) {
        gpu_texture **grown = mem_realloc(s->kept, (size_t)count * sizeof *grown);
        if (!grown) {
            gpu_fail(v->g, LMN_MEMORY, "out of memory");
            return false;
        }
        s->kept = grown;
        for (; s->count < count; s->count++)
            s->kept[s->count] = s->count == 0 ? s->surfaces : blank_picture(v);
    }
    for (int i = 1; i < count; i++)
        step(v, s, s->kept[i - 1], s->kept[i], box);
    return true;
}

/* Bands of rows, as many as the fullest band turned out to need. */
static void evaluate(const solid_view *v, solid_layers *s, const bool *wanted, bool inside, unsigned limit)
{
    int rows = s->box[3];
    for (int row = 0; row < s->box[3] && !gpu_failed(v->g);) {
        int       left = s->box[3] - row, band[4] = {s->box[0], s->box[1] + row, s->box[2], rows < left ? rows : left};
        stopwatch w = watch_start(v->profile);
        unsigned  times = gather(v, s, wanted, band, limit);
        watch_stop(v->profile, w, "solids", "gather");
        if (times > 1 && band[3] > 1) {
            rows = band[3] / (int)(times < (unsigned)band[3] ? times : (unsigned)band[3]);
            continue;
        }
        if (times > 1)
            gpu_fail(v->g, LMN_LIMIT,
                     "a row of the picture has more surfaces of operands than fit into the driver's storage block");
        w = watch_start(v->profile);
        resolve(v, s, band, inside);
        watch_stop(v->profile, w, "solids", "resolve");
        bool whole = band[3] == s->box[3];
        if (!s->first_only && !gpu_failed(v->g)) {
            int count = layers_of_band(v, s);
            if (whole)
                s->count = count;
            else if (!keep_layers(v, s, band, count))
                return;
        }
        row += band[3];
    }
}

/* By lists; errors stick to the GPU. */
static void open_lists(const solid_view *v, solid_layers *s, const bool *wanted, bool inside)
{
    enum { CAPACITY = 128 << 20 };
    size_t block = (size_t)gpu_capabilities_of(v->g)->max_storage_mib << 20,
           pixels = (size_t)s->box[2] * (size_t)s->box[3];
    size_t   capacity = block < CAPACITY ? block : CAPACITY;
    unsigned limit = (unsigned)(capacity / NODE_BYTES);
    s->heads = gpu_buffer_acquire(v->g, pixels * sizeof(uint32_t));
    s->nodes = gpu_buffer_acquire(v->g, capacity);
    s->counter = gpu_buffer_acquire(v->g, 64);
    if (!s->first_only)
        s->chain = gpu_buffer_acquire(v->g, limit * sizeof(uint32_t));
    if (!gpu_failed(v->g))
        evaluate(v, s, wanted, inside, limit);
}

void solids_open(const solid_view *v, solid_layers *s, const bool *wanted, const solid_options *options)
{
    if (s->ready || gpu_failed(v->g))
        return;
    s->ready = true;
    s->first_only = options->first_only;
    s->near = v->camera->near;
    bool inside = find_box(v, wanted, s->box), all_convex = false, lists = gpu_has_lists(v->g);
    if (s->box[2] <= 0)
        return;
    open_planes(v, s, wanted);
    s->nearest = s->surfaces = blank_picture(v);
    s->count = s->first_only ? 1 : 0;
    bool convex = s->first_only && !inside && options->evaluation != EVALUATION_LISTS &&
                  solids_have_convex(v, wanted, &all_convex);
    stopwatch w = watch_start(v->profile);
    if (convex && !gpu_failed(v->g))
        s->depth = solids_draw_convex(v, s, wanted);
    if (convex)
        watch_stop(v->profile, w, "solids", "products");
    if (all_convex || gpu_failed(v->g))
        return;
    w = watch_start(v->profile);
    bool swept =
        (!lists || options->evaluation == EVALUATION_PRODUCTS) && solids_sweep(v, s, wanted, inside, options->layers);
    if (swept)
        watch_stop(v->profile, w, "solids", "sweep");
    else if (lists)
        open_lists(v, s, wanted, inside);
    else
        gpu_fail(v->g, LMN_UNSUPPORTED,
                 "solids of more than 256 operands, or of a normal form of more than 4096 products, need OpenGL 4.3");
}

void solids_select(const solid_view *v, solid_layers *s, int index)
{
    if (s->kept || index == 0) {
        if (!s->kept && s->surfaces != s->nearest)
            gpu_target_release(v->g, s->surfaces);
        s->surfaces = s->kept ? s->kept[index] : s->nearest;
        s->index = index;
        return;
    }
    gpu_texture *behind = blank_picture(v);
    step(v, s, s->surfaces, behind, s->box);
    if (s->surfaces != s->nearest)
        gpu_target_release(v->g, s->surfaces);
    s->surfaces = behind;
    s->index = index;
}

void solids_release(gpu *g, solid_layers *s)
{
    if (s->kept) {
        for (int i = 0; i < s->count; i++)
            gpu_target_release(g, s->kept[i]);
    } else {
        if (s->surfaces != s->nearest)
            gpu_target_release(g, s->surfaces);
        gpu_target_release(g, s->nearest);
    }
    mem_free(s->kept);
    mem_free(s->first_planes);
    gpu_target_release(g, s->depth);
    gpu_target_release(g, s->planes);
    gpu_buffer_release(g, s->heads);
    gpu_buffer_release(g, s->nodes);
    gpu_buffer_release(g, s->chain);
    gpu_buffer_release(g, s->counter);
    memset(s, 0, sizeof *s);
}
