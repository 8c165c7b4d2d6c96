/* Stroke textures on surfaces: copies of the strokes over all texture coordinates, cut at every triangle, lifted by
 * barycentric coordinates. Freudenberg 2003, sections 5.3.1, 5.3.4 and 5.3.5; rows EX-26 to EX-28 and EX-33. A grid
 * on texture coordinates finds what a triangle can have. */
#include "marks/marks.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/random.h"
#include "stroke_texture/strokes.h"

enum { GRID = 32 };                       /* cells along the side of the square */
static const double SQUARES_MOST = 1e6;   /* away from 0 */
static const double CELLS_MOST = 1 << 24; /* that one triangle may lie in */

/* A stroke in a cell; the copy that lies there belongs to the square that is this far away. */
typedef struct grid_entry {
    uint32_t stroke;
    int32_t  square[2];
} grid_entry;

/* A piece as it is found: numbered and measured when all are there. */
typedef struct piece {
    mark_line line;
    int32_t   square[2];
    uint32_t  source;   /* stroke of the texture */
    double    from, to; /* fraction of that stroke */
} piece;

typedef struct tiling {
    const mark_surface *surface;
    const strokes      *texture;
    const tile_options *options;
    double              turn[2]; /* cosine and sine */
    int32_t (*boxes)[4];         /* per stroke: cells, low and high */
    uint32_t   *starts;          /* per cell; one more */
    grid_entry *entries;
    double      total; /* length of all strokes */
    piece      *pieces;
    size_t      count, capacity;
    bool        full; /* memory is gone */
    bool        wide; /* a triangle lies in too many squares */
} tiling;

/* --- plane geometry ------------------------------------------------------------------------------------- */

static double side_of(const double a[2], const double b[2], const double p[2])
{
    return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

/* Of what lies exactly along an edge, one of the two triangles beside it has it. */
static bool owns_edge(const double a[2], const double b[2])
{
    return b[1] > a[1] || (b[1] == a[1] && b[0] < a[0]);
}

bool mark_clip_line(const double a[2], const double b[2], const double corners[3][2], double out[2])
{
    double low = 0, high = 1, area = side_of(corners[0], corners[1], corners[2]);
    if (area == 0)
        return false;
    for (int i = 0; i < 3; i++) {
        int           next = area > 0 ? (i + 1) % 3 : (i + 2) % 3; /* leftwards around */
        const double *p = corners[i], *q = corners[next];
        double        from = side_of(p, q, a), to = side_of(p, q, b);
        if (from == 0 && to == 0 && !owns_edge(p, q))
            return false;
        if (from < 0 && to < 0)
            return false;
        if (from < 0)
            low = fmax(low, from / (from - to));
        else if (to < 0)
            high = fmin(high, from / (from - to));
    }
    out[0] = low;
    out[1] = high;
    return high > low;
}

bool mark_barycentrics(const double p[2], const double corners[3][2], double out[3])
{
    double area = side_of(corners[0], corners[1], corners[2]);
    if (area == 0)
        return false;
    out[0] = side_of(corners[1], corners[2], p) / area;
    out[1] = side_of(corners[2], corners[0], p) / area;
    out[2] = 1 - out[0] - out[1];
    return true;
}

/* --- strokes in a grid ---------------------------------------------------------------------------------- */

static int32_t cell_of(double x)
{
    return (int32_t)floor(x * GRID);
}

static int32_t square_of(int32_t cell)
{
    return cell >= 0 ? cell / GRID : -((GRID - 1 - cell) / GRID);
}

/* Writes entries, or counts them where there are none yet. */
static void put_stroke(tiling *t, uint32_t k, uint32_t *fill)
{
    const int32_t *box = t->boxes[k];
    for (int32_t y = box[1]; y <= box[3]; y++)
        for (int32_t x = box[0]; x <= box[2]; x++) {
            int32_t square[2] = {square_of(x), square_of(y)};
            size_t  cell = (size_t)((y - square[1] * GRID) * GRID + x - square[0] * GRID);
            if (t->entries)
                t->entries[fill[cell]] = (grid_entry){k, {square[0], square[1]}};
            fill[cell]++;
        }
}

static bool grid_open(tiling *t)
{
    size_t    count = t->texture->count;
    double    reach = (double)t->options->jitter;
    uint32_t *fill = mem_calloc(GRID * GRID, sizeof *fill);
    t->boxes = mem_alloc(count * sizeof *t->boxes);
    t->starts = mem_calloc(GRID * GRID + 1, sizeof *t->starts);
    bool done = fill && t->boxes && t->starts;
    for (size_t k = 0; done && k < count; k++) {
        const texture_stroke *s = &t->texture->items[k];
        double                u0 = (double)s->u0, u1 = (double)s->u1, v0 = (double)s->v0, v1 = (double)s->v1;
        const int32_t         box[4] = {cell_of(fmin(u0, u1) - reach), cell_of(fmin(v0, v1) - reach),
                                        cell_of(fmax(u0, u1) + reach), cell_of(fmax(v0, v1) + reach)};
        memcpy(t->boxes[k], box, sizeof box);
        put_stroke(t, (uint32_t)k, fill);
        t->total += stroke_length(s);
    }
    for (size_t c = 0; done && c < GRID * GRID; c++)
        t->starts[c + 1] = t->starts[c] + fill[c];
    if (done) {
        t->entries = mem_alloc(t->starts[GRID * GRID] * sizeof *t->entries);
        memcpy(fill, t->starts, GRID * GRID * sizeof *fill);
        done = t->entries;
        for (size_t k = 0; done && k < count; k++)
            put_stroke(t, (uint32_t)k, fill);
    }
    mem_free(fill);
    return done;
}

/* Where this copy of a stroke lies. */
static void copy_ends(const tiling *t, uint32_t k, const int32_t square[2], double a[2], double b[2])
{
    const texture_stroke *s = &t->texture->items[k];
    double                shift[2] = {square[0], square[1]};
    if (t->options->jitter > 0) {
        random_source r =
            random_start(t->options->seed ^ (uint32_t)square[0] * 2654435761u ^ (uint32_t)square[1] * 2246822519u, k);
        shift[0] += (double)t->options->jitter * random_signed(&r);
        shift[1] += (double)t->options->jitter * random_signed(&r);
    }
    a[0] = (double)s->u0 + shift[0];
    a[1] = (double)s->v0 + shift[1];
    b[0] = (double)s->u1 + shift[0];
    b[1] = (double)s->v1 + shift[1];
}

/* --- pieces --------------------------------------------------------------------------------------------- */

/* From texture coordinates to squares. */
static void to_squares(const tiling *t, vec2 uv, double out[2])
{
    double u = (double)uv.x * (double)t->options->repeat, v = (double)uv.y * (double)t->options->repeat;
    out[0] = t->turn[0] * u + t->turn[1] * v;
    out[1] = t->turn[0] * v - t->turn[1] * u;
}

static vec3 lifted(const vec3 *values, const uint32_t *corner, const double fraction[3])
{
    double out[3] = {0, 0, 0};
    for (int i = 0; i < 3; i++) {
        const vec3 *v = &values[corner[i]];
        out[0] += fraction[i] * (double)v->x;
        out[1] += fraction[i] * (double)v->y;
        out[2] += fraction[i] * (double)v->z;
    }
    return (vec3){(float)out[0], (float)out[1], (float)out[2]};
}

static vec3 unit(vec3 v)
{
    float length = sqrtf(v.x * v.x + v.y * v.y + v.z * v.z);
    return length > 0 ? (vec3){v.x / length, v.y / length, v.z / length} : (vec3){0, 0, 1};
}

/* Grey of the indication map where the middle of a stroke's copy is. */
static float indicated(const tiling *t, const double a[2], const double b[2])
{
    const tile_options *w = t->options;
    if (!w->indication)
        return 0.5f;
    double x = (a[0] + b[0]) / 2, y = (a[1] + b[1]) / 2, repeat = (double)w->repeat; /* turned back */
    double u = (t->turn[0] * x - t->turn[1] * y) / repeat, v = (t->turn[1] * x + t->turn[0] * y) / repeat;
    int    column = (int)floor((u - floor(u)) * w->indication_width),
        row = (int)floor((v - floor(v)) * w->indication_height);
    column = column < w->indication_width ? column : w->indication_width - 1;
    row = row < w->indication_height ? row : w->indication_height - 1;
    return w->indication[(size_t)row * (size_t)w->indication_width + (size_t)column];
}

/* Fraction of a stroke. What a corner of a triangle cuts off it by a hair would be a dot of its own, since it begins
 * where the next piece begins. */
static const double SHORTEST = 1e-6;

static void add_piece(tiling *t, uint32_t triangle, const double corners[3][2], double density, const grid_entry *e,
                      const int32_t square[2])
{
    double a[2], b[2], part[2], fraction[2][3], middle[3];
    copy_ends(t, e->stroke, square, a, b);
    if (!mark_clip_line(a, b, corners, part) || part[1] - part[0] < SHORTEST)
        return;
    for (int i = 0; i < 2; i++) {
        double at[2] = {a[0] + part[i] * (b[0] - a[0]), a[1] + part[i] * (b[1] - a[1])};
        mark_barycentrics(at, corners, fraction[i]);
    }
    for (int i = 0; i < 3; i++)
        middle[i] = 0.5 * (fraction[0][i] + fraction[1][i]);
    if (!mem_grow((void **)&t->pieces, &t->capacity, t->count + 1, sizeof *t->pieces)) {
        t->full = true;
        return;
    }
    const mark_surface   *s = t->surface;
    const uint32_t       *corner = &s->indices[3 * (size_t)triangle];
    const texture_stroke *source = &t->texture->items[e->stroke];
    piece                *p = &t->pieces[t->count++];
    *p = (piece){.square = {square[0], square[1]}, .source = e->stroke, .from = part[0], .to = part[1]};
    p->line = (mark_line){.a = lifted(s->positions, corner, fraction[0]),
                          .b = lifted(s->positions, corner, fraction[1]),
                          .normal = unit(lifted(s->normals, corner, middle)),
                          .perspective = source->perspective,
                          .density = (float)density,
                          .bright = 1,
                          .triangle = triangle};
    p->line.light = source->light + t->options->indication_strength * (0.5f - indicated(t, a, b));
}

/* Length of strokes to a unit of area, where texture coordinates stretch alike both ways. */
static double density_of(const tiling *t, uint32_t triangle, const double corners[3][2])
{
    const uint32_t *i = &t->surface->indices[3 * (size_t)triangle];
    mark_surface    one = *t->surface;
    one.indices = i;
    one.triangle_count = 1;
    double area = mark_surface_area(&one), squares = 0.5 * fabs(side_of(corners[0], corners[1], corners[2]));
    return area > 0 ? t->total * sqrt(squares / area) : 0;
}

static void tile_triangle(tiling *t, uint32_t triangle)
{
    double corners[3][2];
    for (int i = 0; i < 3; i++)
        to_squares(t, t->surface->uvs[t->surface->indices[3 * (size_t)triangle + (size_t)i]], corners[i]);
    double  density = density_of(t, triangle, (const double(*)[2])corners);
    int32_t low[2], high[2];
    double  cells = 1;
    for (int k = 0; k < 2; k++) {
        double least = fmin(corners[0][k], fmin(corners[1][k], corners[2][k])),
               most = fmax(corners[0][k], fmax(corners[1][k], corners[2][k]));
        cells *= (most - least) * GRID + 1;
        t->wide = t->wide || !(fmax(fabs(least), fabs(most)) < SQUARES_MOST) || !(cells < CELLS_MOST);
    }
    for (int k = 0; k < 2 && !t->wide; k++) {
        low[k] = cell_of(fmin(corners[0][k], fmin(corners[1][k], corners[2][k])));
        high[k] = cell_of(fmax(corners[0][k], fmax(corners[1][k], corners[2][k])));
    }
    if (t->wide || !(density > 0))
        return;
    for (int32_t y = low[1]; y <= high[1] && !t->full; y++)
        for (int32_t x = low[0]; x <= high[0]; x++) {
            const int32_t own[2] = {square_of(x), square_of(y)};
            size_t        cell = (size_t)((y - own[1] * GRID) * GRID + x - own[0] * GRID);
            for (uint32_t i = t->starts[cell]; i < t->starts[cell + 1]; i++) {
                const grid_entry *e = &t->entries[i];
                const int32_t     square[2] = {own[0] - e->square[0], own[1] - e->square[1]};
                /* Each copy once: in the first of its cells that is looked at. */
                int32_t first_x = t->boxes[e->stroke][0] + square[0] * GRID,
                        first_y = t->boxes[e->stroke][1] + square[1] * GRID;
                if (x == (first_x > low[0] ? first_x : low[0]) && y == (first_y > low[1] ? first_y : low[1]))
                    add_piece(t, triangle, (const double(*)[2])corners, density, e, square);
            }
        }
}

/* --- strokes of pieces ---------------------------------------------------------------------------------- */

static int by_stroke(const void *left, const void *right)
{
    const piece *a = left, *b = right;
    if (a->square[1] != b->square[1])
        return a->square[1] < b->square[1] ? -1 : 1;
    if (a->square[0] != b->square[0])
        return a->square[0] < b->square[0] ? -1 : 1;
    if (a->source != b->source)
        return a->source < b->source ? -1 : 1;
    if (a->from != b->from)
        return a->from < b->from ? -1 : 1;
    return a->line.triangle < b->line.triangle ? -1 : a->line.triangle > b->line.triangle;
}

static bool same_copy(const piece *a, const piece *b)
{
    return a->square[0] == b->square[0] && a->square[1] == b->square[1] && a->source == b->source;
}

static double between(vec3 a, vec3 b)
{
    double x = (double)a.x - (double)b.x, y = (double)a.y - (double)b.y, z = (double)a.z - (double)b.z;
    return sqrt(x * x + y * y + z * z);
}

/* Does a piece go on where another ends? Where the same texture coordinates are used twice, copies lie in several
 * places. */
static bool goes_on(const piece *a, const piece *b)
{
    double gap = between(a->line.b, b->line.a), size = between(a->line.a, a->line.b) + between(b->line.a, b->line.b);
    return fabs(b->from - a->to) < 1e-5 && gap <= 1e-4 * size + 1e-12;
}

/* What the pieces first … last − 1 (indices) of one stroke have in common. */
static void close_stroke(mark_line *lines, size_t count, uint32_t number)
{
    double length = 0, before = 0;
    for (size_t i = 0; i < count; i++)
        length += between(lines[i].a, lines[i].b);
    for (size_t i = 0; i < count; i++) {
        double own = between(lines[i].a, lines[i].b);
        lines[i].stroke = number;
        lines[i].length = (float)length;
        lines[i].from = (float)before;
        lines[i].to = (float)(before + own);
        before += own;
    }
    const mark_line *m = &lines[mark_stroke_middle(lines, count)];
    float            own = m->to - m->from, s = own > 0 ? fminf((0.5f * m->length - m->from) / own, 1) : 0.5f;
    vec3 at = {m->a.x + s * (m->b.x - m->a.x), m->a.y + s * (m->b.y - m->a.y), m->a.z + s * (m->b.z - m->a.z)};
    for (size_t i = 0; i < count; i++) {
        lines[i].middle = at;
        lines[i].middle_normal = m->normal;
        lines[i].density = m->density;
    }
}

/* Chains the pieces of one copy, first … last − 1, which are sorted by where they begin. */
static void chain(marks *out, piece *pieces, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        if (pieces[i].source == UINT32_MAX)
            continue;
        size_t first = out->line_count, last = i;
        out->lines[out->line_count++] = pieces[i].line;
        for (size_t k = i + 1; k < count; k++)
            if (pieces[k].source != UINT32_MAX && goes_on(&pieces[last], &pieces[k])) {
                out->lines[out->line_count++] = pieces[k].line;
                if (last != i)
                    pieces[last].source = UINT32_MAX;
                last = k;
            }
        pieces[last].source = UINT32_MAX;
        pieces[i].source = UINT32_MAX;
        close_stroke(&out->lines[first], out->line_count - first, (uint32_t)out->stroke_count++);
    }
}

static lmn_status join(marks *out, tiling *t, lmn_error *error)
{
    if (t->full)
        return error_memory(error);
    if (t->wide)
        return error_set(error, LMN_LIMIT, "texture coordinates are too large to lay strokes over them");
    if (t->count > LIMIT_MARKS)
        return error_set(error, LMN_LIMIT,
                         "the strokes of this texture, laid over the model, have %zu pieces, which is more than %d",
                         t->count, LIMIT_MARKS);
    out->lines = mem_alloc(t->count * sizeof *out->lines);
    if (!out->lines)
        return error_memory(error);
    out->line_capacity = t->count;
    if (t->count > 0)
        qsort(t->pieces, t->count, sizeof *t->pieces, by_stroke);
    for (size_t first = 0, end; first < t->count; first = end) {
        for (end = first + 1; end < t->count && same_copy(&t->pieces[first], &t->pieces[end]); end++)
            ;
        chain(out, &t->pieces[first], end - first);
    }
    for (size_t i = 0; i < out->line_count; i++)
        out->line_length += between(out->lines[i].a, out->lines[i].b);
    return LMN_OK;
}

lmn_status marks_tile(marks *out, const mark_surface *s, const strokes *texture, const tile_options *options,
                      lmn_error *error)
{
    memset(out, 0, sizeof *out);
    out->area = mark_surface_area(s);
    if (!s->uvs)
        return error_set(error, LMN_USAGE, "strokes of a texture need texture coordinates, and this surface has none");
    tiling t = {.surface = s,
                .texture = texture,
                .options = options,
                .turn = {cos((double)options->turn), sin((double)options->turn)}};
    bool   opened = grid_open(&t);
    for (uint32_t i = 0;
         opened && i < s->triangle_count && texture->count > 0 && !t.full && !t.wide && t.count <= LIMIT_MARKS; i++)
        tile_triangle(&t, i);
    lmn_status status = opened ? join(out, &t, error) : error_memory(error);
    mem_free(t.boxes);
    mem_free(t.starts);
    mem_free(t.entries);
    mem_free(t.pieces);
    if (status != LMN_OK)
        surface_marks_release(out);
    return status;
}
