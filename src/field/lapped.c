/* Covering a surface: patches from triangles in shuffled order as long as these are not covered yet, then, below
 * all, what is left. */
#include <string.h>

#include "base/memory.h"
#include "field/lapped_private.h"

enum {
    MOST_TIMES = 14, /* so many times the triangles in patches; what is left comes once more */
    ENOUGH = 60000,  /* triangles in patches that are no worry, however few the surface has */
    MOST_ROWS = 8, /* of parts of a large triangle, as many as bits: outlines of several patches together may have it */
    LEFT_OVER_RADII = 16,
    STRETCH_CELLS = 4096
};

static const double feature = 1.0471975511965976;

/* Triangles laid flat, one patch behind the other. */
typedef struct sheet {
    uint32_t *source, *indices;
    float (*positions)[4];
    size_t vertex_count, index_count, source_capacity, position_capacity, index_capacity;
} sheet;

typedef struct lapping {
    const primitive *primitive;
    field_surface    surface;
    patch_ground     ground;
    double           radius;   /* as the surface is scaled */
    uint32_t        *order;    /* triangles shuffled */
    outline          outline;  /* of the patch at hand */
    uint64_t        *cells;    /* per triangle: which parts some outline has */
    bool            *hopeless; /* per triangle: its parts are too large for an outline */
    uint32_t        *copies;   /* per triangle of the primitive: the next copy, NOWHERE */
    uint32_t *numbers, *rounds; /* per vertex of the primitive: its number in the patch that was made in that round … */
    uint32_t
        *elements; /* … as part of this element: around the end of a feature edge a patch may have both sides of it */
    uint32_t round, patch_count;
    sheet    base, patches;
    uint64_t stretches[STRETCH_CELLS], triangles;
} lapping;

static uint32_t mix_bits(uint32_t n)
{
    n = (n ^ n >> 16) * 0x7FEB352Du;
    n = (n ^ n >> 15) * 0x846CA68Bu;
    return n ^ n >> 16;
}

static void shuffle(uint32_t *order, uint32_t count, uint32_t seed)
{
    for (uint32_t i = 0; i < count; i++)
        order[i] = i;
    for (uint32_t i = count; i > 1; i--) {
        uint32_t k = mix_bits(mix_bits(seed + 0x9E3779B9u) + i) % i, other = order[k];
        order[k] = order[i - 1];
        order[i - 1] = other;
    }
}

static void list_copies(lapping *l)
{
    uint32_t count = l->primitive->index_count / 3;
    memset(l->copies, 0xFF, count * sizeof *l->copies);
    for (uint32_t t = count; t-- > 0;) {
        uint32_t kept = l->surface.kept[t], first = kept == NOWHERE ? t : l->surface.triangles[kept];
        if (first == t)
            continue;
        l->copies[t] = l->copies[first];
        l->copies[first] = t;
    }
}

/* Directions of elements from tensors of corners. */
static bool find_axes(lapping *l, const direction_field *field)
{
    const field_surface *s = &l->surface;
    tensor              *sums = mem_calloc(s->element_count, sizeof *sums);
    if (!sums)
        return false;
    for (uint32_t e = 0; e < s->element_count; e++) {
        point3   u, v;
        double   a, b;
        uint32_t count = s->starts[e + 1] - s->starts[e];
        for (uint32_t i = s->starts[e]; i < s->starts[e + 1]; i++) {
            const float *t =
                direction_field_at(field, l->primitive, 3 * s->triangles[s->around[i] / 3] + s->around[i] % 3);
            for (int k = 0; k < 6; k++)
                sums[e].v[k] += t[k] / (float)count;
        }
        tangents(s->normals[e], &u, &v);
        tensor_traceless(&sums[e], u, v, &a, &b);
        double angle = atan2(b, a) / 2;
        l->ground.axes[e] = point_add(point_scale(u, cos(angle)), point_scale(v, sin(angle)));
        l->ground.sure[e] = (float)smooth_step(0.02, 0.2, hypot(a, b));
    }
    mem_free(sums);
    return true;
}

static bool add_vertex(lapping *l, sheet *to, uint32_t vertex, uint32_t element, float ignore, uint32_t patch)
{
    flat_position position = l->ground.vertices[l->ground.local[element]].position;
    if (!mem_grow((void **)&to->source, &to->source_capacity, to->vertex_count + 1, sizeof *to->source) ||
        !mem_grow((void **)&to->positions, &to->position_capacity, to->vertex_count + 1, sizeof *to->positions))
        return false;
    l->rounds[vertex] = l->round;
    l->elements[vertex] = element;
    l->numbers[vertex] = (uint32_t)to->vertex_count;
    to->source[to->vertex_count] = vertex;
    float *out = to->positions[to->vertex_count++];
    out[0] = (float)(position.x * l->surface.size);
    out[1] = (float)(position.y * l->surface.size);
    out[2] = ignore;
    out[3] = (float)patch;
    return true;
}

/* A triangle of the patch at hand with all its copies. */
static bool add_triangle(lapping *l, sheet *to, uint32_t triangle, float ignore, uint32_t patch)
{
    const primitive *p = l->primitive;
    double           cell = (patch_stretch(&l->ground, triangle) - 1) / (STRETCH_MAX - 1) * STRETCH_CELLS;
    l->stretches[cell < STRETCH_CELLS ? (size_t)fmax(cell, 0) : STRETCH_CELLS - 1]++;
    l->triangles++;
    for (uint32_t own = l->surface.triangles[triangle]; own != NOWHERE; own = l->copies[own]) {
        if (!mem_grow((void **)&to->indices, &to->index_capacity, to->index_count + 3, sizeof *to->indices))
            return false;
        for (uint32_t k = 0; k < 3; k++) {
            uint32_t v = p->indices[3 * own + k], element = field_surface_element(&l->surface, p, 3 * own + k);
            bool     known = l->rounds[v] == l->round && l->elements[v] == element;
            if (!known && !add_vertex(l, to, v, element, ignore, patch))
                return false;
            to->indices[to->index_count++] = l->numbers[v];
        }
    }
    return true;
}

static double longest_edge(const field_surface *s, uint32_t triangle)
{
    double longest = 0;
    for (uint32_t k = 0; k < 3; k++) {
        point3 a = s->positions[s->corners[3 * triangle + k]], b = s->positions[s->corners[3 * triangle + (k + 1) % 3]];
        longest = fmax(longest, point_length(point_sub(b, a)));
    }
    return longest;
}

/* Small triangles are covered whole or not: taking them apart would only take time. */
static int cell_rows(const lapping *l, uint32_t triangle)
{
    double length = longest_edge(&l->surface, triangle) / l->radius;
    return length < 0.15 ? 1 : length < 0.6 ? 4 : MOST_ROWS;
}

static uint64_t all_cells(int rows)
{
    return UINT64_MAX >> (64 - rows * rows);
}

/* The corners of a part, as fractions of the second and third corner. With 8 rows these have 15, 13 … 1 parts, every
 * other one upside down. */
static void cell_corners(int cell, int rows, flat_position fractions[3])
{
    int row = 0, row_size = 2 * rows - 1;
    for (; cell >= row_size; row_size -= 2, row++)
        cell -= row_size;
    int column = cell / 2, upside_down = cell % 2;
    for (int k = 0; k < 3; k++) {
        int x = column + (upside_down ? k != 1 : k == 1), y = row + (upside_down ? k != 0 : k == 2);
        fractions[k] = (flat_position){(double)x / rows, (double)y / rows};
    }
}

static bool holds_cell(const lapping *l, const flat_position positions[3], int cell, int rows)
{
    flat_position fractions[3], corners[3];
    cell_corners(cell, rows, fractions);
    for (int k = 0; k < 3; k++) {
        double b = fractions[k].x, c = fractions[k].y, a = 1 - b - c;
        corners[k] = (flat_position){a * positions[0].x + b * positions[1].x + c * positions[2].x,
                                     a * positions[0].y + b * positions[1].y + c * positions[2].y};
    }
    return outline_holds(&l->outline, corners);
}

static void cover_triangle(lapping *l, uint32_t triangle, const flat_position positions[3])
{
    uint64_t *cells = &l->cells[triangle];
    if (l->ground.covered[triangle])
        return;
    int rows = cell_rows(l, triangle);
    if (outline_holds(&l->outline, positions))
        *cells = all_cells(rows);
    else if (rows > 1)
        for (int k = 0; k < rows * rows; k++)
            if (!(*cells >> k & 1) && holds_cell(l, positions, k, rows))
                *cells |= UINT64_C(1) << k;
    l->ground.covered[triangle] = *cells == all_cells(rows);
}

/* Where in a triangle a patch is to have its middle: in a part that is not covered. */
static flat_position bare_position(const lapping *l, uint32_t triangle, int *cell)
{
    flat_position fractions[3];
    int           rows = cell_rows(l, triangle), count = rows * rows;
    *cell = (int)(mix_bits(triangle + l->patch_count) % (uint32_t)count);
    while (l->cells[triangle] >> *cell & 1)
        *cell = (*cell + 1) % count;
    cell_corners(*cell, rows, fractions);
    return (flat_position){(fractions[0].x + fractions[1].x + fractions[2].x) / 3,
                           (fractions[0].y + fractions[1].y + fractions[2].y) / 3};
}

/* Takes the grown patch if its outline has the part around its middle, and there is room for it. */
static bool take_patch(lapping *l, uint32_t seed, int cell, bool *full)
{
    patch_ground *g = &l->ground;
    flat_position positions[3];
    size_t        kept = 0, most = (size_t)MOST_TIMES * l->surface.triangle_count;
    l->outline = outline_of(l->patch_count, l->radius);
    patch_positions(g, seed, positions);
    l->hopeless[seed] = !holds_cell(l, positions, cell, cell_rows(l, seed));
    if (l->hopeless[seed])
        return true;
    for (size_t i = 0; i < g->triangle_count; i++) {
        patch_positions(g, g->triangles[i], positions);
        if (outline_touches(&l->outline, positions))
            g->triangles[kept++] = g->triangles[i];
    }
    g->triangle_count = kept;
    *full = l->triangles + kept > (most > ENOUGH ? most : ENOUGH);
    if (*full)
        return true;
    l->round++;
    for (size_t i = 0; i < g->triangle_count; i++) {
        uint32_t t = g->triangles[i];
        patch_positions(g, t, positions);
        cover_triangle(l, t, positions);
        if (!add_triangle(l, &l->patches, t, 0, l->patch_count))
            return false;
    }
    l->patch_count++;
    return true;
}

/* Large triangles take many patches. Each gets one in turn, so that none is left without if there come to be too
 * many. */
static bool cover_with_patches(lapping *l)
{
    bool full = false, good = true, more = true;
    while (more) {
        more = false;
        for (uint32_t i = 0; good && !full && i < l->surface.triangle_count; i++) {
            uint32_t seed = l->order[i];
            int      cell;
            if (l->ground.covered[seed] || l->hopeless[seed])
                continue;
            flat_position middle = bare_position(l, seed, &cell);
            /* A part that is longer than twice the radius has no room in any outline. */
            l->hopeless[seed] = longest_edge(&l->surface, seed) > 2 * MOST_ROWS * l->radius;
            if (l->hopeless[seed])
                continue;
            good = patch_grow(&l->ground, seed, middle, l->radius) && take_patch(l, seed, cell, &full);
            patch_clear(&l->ground);
            more = good && !full;
        }
    }
    return good;
}

static bool cover_the_rest(lapping *l)
{
    patch_ground *g = &l->ground;
    bool          good = true;
    g->only_uncovered = true;
    for (uint32_t seed = 0; good && seed < l->surface.triangle_count; seed++) {
        if (g->covered[seed])
            continue;
        good = patch_grow(g, seed, (flat_position){1.0 / 3, 1.0 / 3}, LEFT_OVER_RADII * l->radius);
        l->round++;
        for (size_t i = 0; good && i < g->triangle_count; i++) {
            g->covered[g->triangles[i]] = true;
            good = add_triangle(l, &l->base, g->triangles[i], 1, l->patch_count);
        }
        l->patch_count++;
        patch_clear(g);
    }
    return good;
}

static lmn_status put_together(lapped_mesh *out, const lapping *l, lmn_error *error)
{
    const sheet *a = &l->base, *b = &l->patches;
    size_t       vertices = a->vertex_count + b->vertex_count, indices = a->index_count + b->index_count;
    if (vertices >= UINT32_MAX || indices >= UINT32_MAX)
        return error_set(
            error, LMN_LIMIT,
            "the patches of a lapped surface have %zu vertices and %zu indices; at most 4 thousand million are allowed",
            vertices, indices);
    out->source = mem_alloc(vertices * sizeof *out->source);
    out->positions = mem_alloc(vertices * sizeof *out->positions);
    out->indices = mem_alloc(indices * sizeof *out->indices);
    if (!out->source || !out->positions || !out->indices)
        return error_memory(error);
    const sheet *const sheets[2] = {a, b};
    for (int i = 0; i < 2; i++) {
        const sheet *from = sheets[i];
        for (size_t v = 0; v < from->vertex_count; v++) {
            out->source[out->vertex_count + v] = from->source[v];
            memcpy(out->positions[out->vertex_count + v], from->positions[v], sizeof *out->positions);
        }
        for (size_t k = 0; k < from->index_count; k++)
            out->indices[out->index_count + k] = from->indices[k] + out->vertex_count;
        out->vertex_count += (uint32_t)from->vertex_count;
        out->index_count += (uint32_t)from->index_count;
    }
    out->patch_count = l->patch_count;
    uint64_t seen = 0;
    size_t   cell = 0;
    while (cell < STRETCH_CELLS && (seen += l->stretches[cell]) < l->triangles * 95 / 100)
        cell++;
    out->stretch = 1 + (STRETCH_MAX - 1) * (double)cell / STRETCH_CELLS;
    return LMN_OK;
}

static bool make_ready(lapping *l, const direction_field *field, uint32_t seed)
{
    const field_surface *s = &l->surface;
    patch_ground        *g = &l->ground;
    size_t               vertices = l->primitive->vertex_count;
    g->surface = s;
    g->axes = mem_alloc(s->element_count * sizeof *g->axes);
    g->sure = mem_alloc(s->element_count * sizeof *g->sure);
    g->local = mem_alloc(s->element_count * sizeof *g->local);
    g->covered = mem_calloc(s->triangle_count, sizeof *g->covered);
    g->stamps = mem_calloc(s->triangle_count, sizeof *g->stamps);
    l->order = mem_alloc(s->triangle_count * sizeof *l->order);
    l->cells = mem_calloc(s->triangle_count, sizeof *l->cells);
    l->hopeless = mem_calloc(s->triangle_count, sizeof *l->hopeless);
    l->copies = mem_alloc(l->primitive->index_count / 3 * sizeof *l->copies);
    l->numbers = mem_alloc(vertices * sizeof *l->numbers);
    l->rounds = mem_calloc(vertices, sizeof *l->rounds);
    l->elements = mem_alloc(vertices * sizeof *l->elements);
    if (!g->axes || !g->sure || !g->local || !g->covered || !g->stamps || !l->order || !l->cells || !l->hopeless ||
        !l->copies || !l->numbers || !l->rounds || !l->elements)
        return false;
    memset(g->local, 0xFF, s->element_count * sizeof *g->local);
    shuffle(l->order, s->triangle_count, seed);
    list_copies(l);
    return find_axes(l, field);
}

static void release(lapping *l)
{
    patch_ground *g = &l->ground;
    void *const   blocks[] = {g->axes,           g->sure,
                              g->local,          g->covered,
                              g->stamps,         g->vertices,
                              g->edges,          g->triangles,
                              g->kept,           g->near.items,
                              l->order,          l->cells,
                              l->hopeless,       l->copies,
                              l->numbers,        l->rounds,
                              l->elements,       l->base.source,
                              l->base.positions, l->base.indices,
                              l->patches.source, l->patches.positions,
                              l->patches.indices};
    for (size_t i = 0; i < sizeof blocks / sizeof *blocks; i++)
        mem_free(blocks[i]);
    field_surface_release(&l->surface);
    mem_free(l);
}

lmn_status lapped_make(lapped_mesh *out, const primitive *p, const direction_field *field, double radius, uint32_t seed,
                       lmn_error *error)
{
    memset(out, 0, sizeof *out);
    lapping *l = mem_calloc(1, sizeof *l);
    if (!l)
        return error_memory(error);
    l->primitive = p;
    lmn_status status = field_surface_make(&l->surface, p, feature, error);
    if (status == LMN_OK) {
        l->radius = radius > 0 && isfinite(radius) ? radius / l->surface.size : 0.125;
        bool good = make_ready(l, field, seed) && cover_with_patches(l) && cover_the_rest(l);
        status = good ? put_together(out, l, error) : error_memory(error);
    }
    release(l);
    if (status != LMN_OK)
        lapped_release(out);
    return status;
}

void lapped_release(lapped_mesh *m)
{
    mem_free(m->source);
    mem_free(m->positions);
    mem_free(m->indices);
    memset(m, 0, sizeof *m);
}
