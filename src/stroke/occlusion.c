/* Pieces of surface of which nothing is seen. Where there are very many small ones, most lie behind others: that is
 * found out before their lines are looked for, and these are neither found, nor compared, nor joined. What is found is
 * certain (conservative occlusion culling): the page is divided into cells, each of which knows how deep the nearest
 * triangle is that covers all of it. A piece is hidden when all cells that it touches are covered in front of it. After
 * Greene, Kass and Miller 1993 (a pyramid of depths), here with two levels, tile after tile, the nearest first. */
#include "stroke/stroke_private.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "base/work.h"

enum { TILE = 256, BLOCK = 8, BLOCKS = TILE / BLOCK }; /* cells of a tile, and of its blocks, a side */
/* Fewer pieces are not worth the search. */
enum { PIECES_LEAST = 4096 };
/* A triangle of mean size has so many cells a side; these are so large at least and at most, units of paper. */
#define CELLS_A_SIDE 28
#define CELL_LEAST   (1.0 / 16)
#define CELL_MOST    1.0
/* A line is looked for a little beside where it is, too (visibility.c); units of paper. */
#define BESIDE 0.02
/* Cells grow until triangles lie in this many tiles on average, or fewer. */
enum { TILES_A_TRIANGLE = 4 };

typedef struct occlusion {
    const stroke_view *v;
    double             lift; /* what lies no farther in front may not count, file units */
    atomic_uchar      *seen; /* per piece: a part of it may be; or it is not asked for */
    size_t             asked, triangles;
    double             area;         /* of all triangles of the pieces that are asked for, window units² */
    int32_t            low_x, low_y; /* of the first tile */
    int32_t            cell, columns, rows;
    uint32_t          *order, *starts, *entries; /* triangles, the nearest first; of each tile likewise */
    atomic_bool        failed;
} occlusion;

/* Where a triangle lies, from the corner of a tile, and the plane that it is in: depth at that corner, and by how much
 * it grows. */
typedef struct flat_triangle {
    double x[3], y[3], low_y, high_y, near_z, far_z;
    double z, along_x, along_y, middle; /* middle: in the middle of the page */
    double margin;                      /* what is behind it is farther behind it than this */
} flat_triangle;

typedef struct tile {
    const occlusion *o;
    int32_t          x, y; /* its corner */
    float           *depths;
    float            blocks[BLOCKS * BLOCKS]; /* the largest of each block */
    uint8_t          stale[BLOCKS * BLOCKS];
} tile;

typedef struct cell_range {
    int first, end;
} cell_range;

/* --- which pieces are asked for ------------------------------------------------------------------------- */

/* Of what an item's lines are, and of what they are told apart from, some may be seen behind what covers it. */
static bool may_be_asked(const stroke_view *v, size_t item)
{
    const uint32_t   mesh = v->scene->items[item].mesh;
    const edge_mesh *m = &v->scene->meshes[mesh];
    return !m->solid && !m->refinement && m->line_count == 0 && !has_calm_outline(v->scene, mesh);
}

/* Where a piece lies on the page. */
typedef struct piece_extent {
    int32_t  low_x, low_y, high_x, high_y;
    uint32_t faces;   /* that are in no triangle */
    bool     unknown; /* it leaves the window, or has faces that are seen from the edge */
} piece_extent;

static void widen(piece_extent *e, const window_box *b)
{
    e->low_x = b->low_x < e->low_x ? b->low_x : e->low_x;
    e->low_y = b->low_y < e->low_y ? b->low_y : e->low_y;
    e->high_x = b->high_x > e->high_x ? b->high_x : e->high_x;
    e->high_y = b->high_y > e->high_y ? b->high_y : e->high_y;
}

static void count_faces(const stroke_view *v, size_t item, piece_extent *extents)
{
    const edge_mesh    *m = &v->scene->meshes[v->scene->items[item].mesh];
    const uint8_t      *outside = v->outside + v->items[item].first_point;
    const window_point *points = v->points + v->items[item].first_point;
    for (uint32_t f = 0; f < m->face_count; f++) {
        const uint32_t *corners = m->faces[f];
        piece_extent   *e = &extents[v->items[item].first_piece + m->pieces[f]];
        e->faces++;
        e->unknown = e->unknown || (outside[corners[0]] | outside[corners[1]] | outside[corners[2]]) != 0 ||
                     window_side(points[corners[0]], points[corners[1]], points[corners[2]]) == 0;
    }
}

/* NULL: out of memory. */
static piece_extent *find_extents(const stroke_view *v)
{
    piece_extent *out = mem_alloc(((size_t)v->piece_count + 1) * sizeof *out);
    for (size_t i = 0; i < v->piece_count && out; i++)
        out[i] = (piece_extent){INT32_MAX, INT32_MAX, INT32_MIN, INT32_MIN, 0, false};
    for (size_t i = 0; i < v->scene->item_count && out; i++)
        count_faces(v, i, out);
    for (size_t i = 0; i < v->triangle_count && out; i++) {
        piece_extent *e = &out[v->face_pieces[v->triangles[i].face]];
        widen(e, &v->boxes[i]);
        e->faces -= e->faces > 0;
    }
    return out;
}

/* Flags pieces that are smaller than `least`. Of a closed body nothing is seen behind its front: its other faces are in
 * no triangle and need not be. NULL: out of memory. */
static uint8_t *find_small(const stroke_view *v, double least)
{
    piece_extent *extents = find_extents(v);
    uint8_t      *out = extents ? mem_calloc((size_t)v->piece_count + 1, 1) : NULL;
    for (size_t i = 0; i < v->scene->item_count && out; i++) {
        const edge_mesh *m = &v->scene->meshes[v->scene->items[i].mesh];
        for (uint32_t k = 0; k < m->piece_count; k++) {
            const piece_extent *e = &extents[v->items[i].first_piece + k];
            out[v->items[i].first_piece + k] =
                !m->solid && !e->unknown && e->low_x <= e->high_x && (m->closed[k] || e->faces == 0) &&
                hypot((double)e->high_x - e->low_x, (double)e->high_y - e->low_y) < least * v->units;
        }
    }
    mem_free(extents);
    return out;
}

/* Asks for the pieces that are smaller than `least` on the page. */
static bool choose_pieces(occlusion *o, double least)
{
    const stroke_view *v = o->v;
    uint8_t           *small = find_small(v, least);
    o->seen = small ? mem_alloc(((size_t)v->piece_count + 1) * sizeof *o->seen) : NULL;
    for (size_t i = 0; i < v->scene->item_count && o->seen; i++) {
        const bool asked = may_be_asked(v, i);
        for (uint32_t k = v->items[i].first_piece; k < v->items[i + 1].first_piece; k++) {
            atomic_init(&o->seen[k], (unsigned char)!(asked && small[k]));
            o->asked += asked && small[k];
        }
    }
    mem_free(small);
    return o->seen != NULL;
}

/* --- pieces that hang together -------------------------------------------------------------------------- */

static uint32_t first_of(uint32_t *sets, uint32_t i)
{
    while (sets[i] != i)
        i = sets[i] = sets[sets[i]];
    return i;
}

/* Unites the pieces of a mesh that share vertices. `pieces`: per vertex, one that it is of. */
static void unite_at_vertices(const edge_mesh *m, uint32_t *sets, uint32_t *pieces)
{
    memset(pieces, 0xFF, (size_t)m->vertex_count * sizeof *pieces);
    for (uint32_t k = 0; k < m->piece_count; k++)
        sets[k] = k;
    for (uint32_t f = 0; f < m->face_count; f++)
        for (int k = 0; k < 3; k++) {
            uint32_t *piece = &pieces[m->faces[f][k]];
            if (*piece == UINT32_MAX)
                *piece = m->pieces[f];
            else if (*piece != m->pieces[f])
                sets[first_of(sets, *piece)] = first_of(sets, m->pieces[f]);
        }
}

/* Lines go on from one piece to another where they share a vertex: all of these are kept that hang together with one
 * that is. `kept`: a flag per piece; `lengths` (may be NULL): of the lines of each, and then of all that hang together.
 * False: out of memory. */
static bool keep_whole(uint8_t *kept, float *lengths, const stroke_view *v)
{
    bool good = true;
    for (size_t i = 0; i < v->scene->item_count && good; i++) {
        const edge_mesh *m = &v->scene->meshes[v->scene->items[i].mesh];
        uint8_t         *own = kept + v->items[i].first_piece;
        float           *all = lengths ? lengths + v->items[i].first_piece : NULL;
        if (m->piece_count < 2)
            continue;
        uint32_t *sets = mem_alloc(m->piece_count * sizeof *sets),
                 *pieces = mem_alloc(((size_t)m->vertex_count + 1) * sizeof *pieces);
        good = sets && pieces;
        if (good)
            unite_at_vertices(m, sets, pieces);
        for (uint32_t k = 0; k < m->piece_count && good; k++) {
            const uint32_t first = first_of(sets, k);
            own[first] |= own[k];
            if (all && first != k)
                all[first] += all[k];
        }
        for (uint32_t k = 0; k < m->piece_count && good; k++) {
            own[k] = own[first_of(sets, k)];
            if (all)
                all[k] = all[first_of(sets, k)];
        }
        mem_free(sets);
        mem_free(pieces);
    }
    return good;
}

/* --- tiles ---------------------------------------------------------------------------------------------- */

/* Numbers in the order of what single precision says. */
static uint32_t key_of(float z)
{
    uint32_t bits;
    memcpy(&bits, &z, sizeof bits);
    return bits ^ (bits >> 31 ? UINT32_MAX : UINT32_C(1) << 31);
}

enum { RADIX = 2048 };

/* The triangles that may hide something, the nearest first. */
static bool order_triangles(occlusion *o)
{
    const stroke_view *v = o->v;
    uint32_t          *other = mem_alloc((v->triangle_count + 1) * sizeof *other);
    o->order = mem_alloc((v->triangle_count + 1) * sizeof *o->order);
    for (size_t i = 0; i < v->triangle_count && o->order; i++)
        if (!view_solid(v, v->triangles[i].face))
            o->order[o->triangles++] = (uint32_t)i;
    for (unsigned shift = 0; shift < 32 && o->order && other; shift += 11) {
        size_t starts[RADIX + 1] = {0};
        for (size_t i = 0; i < o->triangles; i++)
            starts[(key_of(v->boxes[o->order[i]].near_z) >> shift & (RADIX - 1)) + 1]++;
        for (int k = 0; k < RADIX; k++)
            starts[k + 1] += starts[k];
        for (size_t i = 0; i < o->triangles; i++)
            other[starts[key_of(v->boxes[o->order[i]].near_z) >> shift & (RADIX - 1)]++] = o->order[i];
        uint32_t *sorted = other;
        other = o->order;
        o->order = sorted;
    }
    bool good = o->order && other;
    mem_free(other);
    return good;
}

static void measure_area(occlusion *o)
{
    const stroke_view *v = o->v;
    size_t             count = 0;
    for (size_t i = 0; i < v->triangle_count; i++) {
        const window_triangle *t = &v->triangles[i];
        if (atomic_load_explicit(&o->seen[v->face_pieces[t->face]], memory_order_relaxed))
            continue;
        o->area += 0.5 * fabs(window_side(v->points[t->v[0]], v->points[t->v[1]], v->points[t->v[2]]));
        count++;
    }
    o->area /= count ? (double)count : 1;
}

/* A page of tiles with a little around it. */
static void lay_tiles(occlusion *o, double cell)
{
    const stroke_view *v = o->v;
    const double       x = (0.5 * v->camera.width + 1) * v->units, y = (0.5 * v->camera.height + 1) * v->units;
    o->cell = (int32_t)cell;
    o->low_x = (int32_t)-x;
    o->low_y = (int32_t)-y;
    o->columns = (int32_t)(2 * x / (cell * TILE)) + 1;
    o->rows = (int32_t)(2 * y / (cell * TILE)) + 1;
}

/* The tiles that a box lies in, and a little around it. */
static void tiles_of(const occlusion *o, const window_box *b, cell_range *columns, cell_range *rows)
{
    const double side = (double)o->cell * TILE, around = BESIDE * o->v->units;
    const double low[2] = {floor((b->low_x - around - o->low_x) / side), floor((b->low_y - around - o->low_y) / side)};
    const double high[2] = {floor((b->high_x + around - o->low_x) / side),
                            floor((b->high_y + around - o->low_y) / side)};
    columns->first = low[0] > 0 ? (int)fmin(low[0], o->columns) : 0;
    rows->first = low[1] > 0 ? (int)fmin(low[1], o->rows) : 0;
    columns->end = high[0] < 0 ? 0 : (int)fmin(high[0] + 1, o->columns);
    rows->end = high[1] < 0 ? 0 : (int)fmin(high[1] + 1, o->rows);
}

static size_t count_entries(const occlusion *o)
{
    size_t     count = 0;
    cell_range columns, rows;
    for (size_t i = 0; i < o->triangles; i++) {
        tiles_of(o, &o->v->boxes[o->order[i]], &columns, &rows);
        if (columns.end > columns.first && rows.end > rows.first)
            count += (size_t)(columns.end - columns.first) * (size_t)(rows.end - rows.first);
    }
    return count;
}

/* Sorts triangles into tiles; `place` false: counts them. */
static void enter_triangles(occlusion *o, bool place)
{
    cell_range columns, rows;
    for (size_t i = 0; i < o->triangles; i++) {
        tiles_of(o, &o->v->boxes[o->order[i]], &columns, &rows);
        for (int r = rows.first; r < rows.end; r++)
            for (int c = columns.first; c < columns.end; c++) {
                const size_t number = (size_t)r * (size_t)o->columns + (size_t)c;
                if (place)
                    o->entries[o->starts[number + 1]++] = o->order[i];
                else
                    o->starts[number + 2]++;
            }
    }
}

static bool fill_tiles(occlusion *o)
{
    const double units = o->v->units, least = CELL_LEAST * units, most = CELL_MOST * units;
    double       cell = fmin(fmax(sqrt(o->area) / CELLS_A_SIDE, least), most);
    lay_tiles(o, fmax(floor(cell), 1));
    while (count_entries(o) > TILES_A_TRIANGLE * o->triangles && o->columns * o->rows > 1)
        lay_tiles(o, 2 * (double)o->cell);
    const size_t tiles = (size_t)o->columns * (size_t)o->rows;
    o->starts = mem_calloc(tiles + 2, sizeof *o->starts);
    o->entries = mem_alloc((count_entries(o) + 1) * sizeof *o->entries);
    if (!o->starts || !o->entries)
        return false;
    enter_triangles(o, false);
    for (size_t i = 2; i < tiles + 2; i++)
        o->starts[i] += o->starts[i - 1];
    enter_triangles(o, true);
    return true;
}

/* --- one triangle in a tile ----------------------------------------------------------------------------- */

/* What is nearer than this may count as being at the triangle: rounding, pieces that nearly coincide. */
static double margin_of(const occlusion *o, const flat_triangle *t, const window_box *box)
{
    const stroke_view   *v = o->v;
    const stroke_camera *c = &v->camera;
    const double         focal = 0.5 * c->height * fabs(c->projection.m[5]) * v->units;
    const double         steep = focal * focal * (t->along_x * t->along_x + t->along_y * t->along_y);
    const double         same = view_tolerance(v, v->same, t->near_z) + (4 + BESIDE * v->units) * (double)box->slope;
    if (c->orthographic)
        return same + o->lift * sqrt(1 + steep);
    return same + o->lift * fabs(t->near_z) * sqrt(steep + t->middle * t->middle);
}

static flat_triangle flatten(const tile *t, uint32_t number)
{
    const stroke_view     *v = t->o->v;
    const window_triangle *from = &v->triangles[number];
    const window_box      *box = &v->boxes[number];
    flat_triangle          out;
    double                 z[3];
    for (int k = 0; k < 3; k++) {
        const window_point *p = &v->points[from->v[k]];
        out.x[k] = (double)p->x - t->x;
        out.y[k] = (double)p->y - t->y;
        z[k] = p->z;
    }
    const double bx = out.x[1] - out.x[0], by = out.y[1] - out.y[0], cx = out.x[2] - out.x[0], cy = out.y[2] - out.y[0],
                 area = bx * cy - by * cx;
    out.along_x = ((z[1] - z[0]) * cy - (z[2] - z[0]) * by) / area;
    out.along_y = ((z[2] - z[0]) * bx - (z[1] - z[0]) * cx) / area;
    out.z = z[0] - out.along_x * out.x[0] - out.along_y * out.y[0];
    out.middle = out.z - out.along_x * t->x - out.along_y * t->y;
    out.low_y = (double)box->low_y - t->y;
    out.high_y = (double)box->high_y - t->y;
    out.near_z = fmin(z[0], fmin(z[1], z[2]));
    out.far_z = fmax(z[0], fmax(z[1], z[2]));
    out.margin = margin_of(t->o, &out, box);
    return out;
}

/* From where to where a level line passes the triangle; nowhere: from the larger to the smaller. */
static void span_at(const flat_triangle *f, double y, double out[2])
{
    out[0] = INFINITY;
    out[1] = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const int    n = k == 2 ? 0 : k + 1;
        const double low = f->y[k] < f->y[n] ? f->y[k] : f->y[n], high = f->y[k] < f->y[n] ? f->y[n] : f->y[k];
        if (y < low || y > high || low == high)
            continue;
        const double x = f->x[k] + (y - f->y[k]) / (f->y[n] - f->y[k]) * (f->x[n] - f->x[k]);
        out[0] = x < out[0] ? x : out[0];
        out[1] = x > out[1] ? x : out[1];
    }
}

static int clamp_cell(double at)
{
    return at < 0 ? 0 : at > TILE ? TILE : (int)at;
}

/* The cells of a row that lie in the triangle with all that they are, `around` being 0, or that it touches, so far
 * around. */
static cell_range cells_within(const flat_triangle *f, double y, double side)
{
    double above[2], below[2];
    span_at(f, y, above);
    span_at(f, y + side, below);
    const double low = (above[0] > below[0] ? above[0] : below[0]) + 1,
                 high = (above[1] < below[1] ? above[1] : below[1]) - 1;
    return (cell_range){clamp_cell(ceil(low / side)), clamp_cell(floor(high / side))};
}

static cell_range cells_touched(const flat_triangle *f, double y, double side, double around)
{
    double above[2], below[2];
    span_at(f, y - around, above);
    span_at(f, y + side + around, below);
    double low = above[0] < below[0] ? above[0] : below[0], high = above[1] > below[1] ? above[1] : below[1];
    for (int k = 0; k < 3; k++)
        if (f->y[k] >= y - around && f->y[k] <= y + side + around) {
            low = f->x[k] < low ? f->x[k] : low;
            high = f->x[k] > high ? f->x[k] : high;
        }
    return high < low
               ? (cell_range){0, 0}
               : (cell_range){clamp_cell(floor((low - around) / side)), clamp_cell(floor((high + around) / side) + 1)};
}

static void cover_row(tile *t, const flat_triangle *f, int row, cell_range cells)
{
    const double side = t->o->cell, slack = 0.5 * side * (fabs(f->along_x) + fabs(f->along_y)) + f->margin;
    const double first = f->z + f->along_y * (row + 0.5) * side + 0.5 * f->along_x * side + slack;
    const float  most = nextafterf((float)(f->far_z + f->margin), INFINITY), step = (float)(f->along_x * side);
    /* what is rounded in single precision, twice */
    const float from = (float)(first + f->along_x * side * cells.first),
                more = 4e-7f * (fabsf(from) + fabsf(step) * TILE);
    float *depths = t->depths + (size_t)row * TILE + cells.first;
    for (int i = 0; i < cells.end - cells.first; i++) {
        float z = from + step * (float)i + more;
        z = z < most ? z : most;
        depths[i] = depths[i] < z ? depths[i] : z;
    }
    for (int b = cells.first / BLOCK; b <= (cells.end - 1) / BLOCK; b++)
        t->stale[row / BLOCK * BLOCKS + b] = 1;
}

/* What the triangle hides. */
static void cover(tile *t, const flat_triangle *f)
{
    const double side = t->o->cell;
    const int    first = clamp_cell(ceil((f->low_y + 1) / side)), end = clamp_cell(floor((f->high_y - 1) / side));
    for (int row = first; row < end; row++) {
        const cell_range cells = cells_within(f, row * side, side);
        if (cells.first < cells.end)
            cover_row(t, f, row, cells);
    }
}

static float block_depth(tile *t, int row, int column)
{
    const int    number = row * BLOCKS + column;
    const float *depths = t->depths + (size_t)row * BLOCK * TILE + column * BLOCK;
    float        most = -INFINITY;
    if (!t->stale[number])
        return t->blocks[number];
    for (int r = 0; r < BLOCK; r++)
        for (int c = 0; c < BLOCK; c++)
            most = depths[r * TILE + c] > most ? depths[r * TILE + c] : most;
    t->stale[number] = 0;
    t->blocks[number] = most;
    return most;
}

static bool is_row_behind(const tile *t, const flat_triangle *f, int row, cell_range cells)
{
    const double side = t->o->cell, slack = (0.5 * side + 4) * (fabs(f->along_x) + fabs(f->along_y));
    const double first = f->z + f->along_y * (row + 0.5) * side + 0.5 * f->along_x * side - slack;
    const float  least = nextafterf((float)f->near_z, -INFINITY), step = (float)(f->along_x * side);
    const float  from = (float)(first + f->along_x * side * cells.first),
                less = 4e-7f * (fabsf(from) + fabsf(step) * TILE);
    const float *depths = t->depths + (size_t)row * TILE + cells.first;
    for (int i = 0; i < cells.end - cells.first; i++) {
        float z = from + step * (float)i - less;
        z = z > least ? z : least;
        if (!(depths[i] < z))
            return false;
    }
    return true;
}

/* Is all of some blocks so deep? */
static bool are_blocks_behind(tile *t, int row, cell_range cells, float least)
{
    for (int b = cells.first / BLOCK; b * BLOCK < cells.end; b++)
        if (!(block_depth(t, row, b) < least))
            return false;
    return true;
}

static cell_range cells_around(double low, double high, double side)
{
    return (cell_range){clamp_cell(floor(low / side)), clamp_cell(floor(high / side) + 1)};
}

/* A first look, by the box alone: most of what is hidden lies deep behind. */
static bool is_box_behind(tile *t, const window_box *b)
{
    const double     side = t->o->cell, around = BESIDE * t->o->v->units;
    const cell_range rows = cells_around(b->low_y - around - t->y, b->high_y + around - t->y, side),
                     columns = cells_around(b->low_x - around - t->x, b->high_x + around - t->x, side);
    for (int row = rows.first / BLOCK; row * BLOCK < rows.end; row++)
        if (!are_blocks_behind(t, row, columns, b->near_z))
            return false;
    return true;
}

/* Is it hidden wherever it lies in the tile, as far as that is certain? */
static bool is_behind(tile *t, const flat_triangle *f, const window_box *box)
{
    const double     side = t->o->cell, around = BESIDE * t->o->v->units;
    const cell_range rows = cells_around(f->low_y - around, f->high_y + around, side),
                     columns = cells_around(box->low_x - around - t->x, box->high_x + around - t->x, side);
    for (int row = rows.first; row < rows.end;) {
        const int next = (row / BLOCK + 1) * BLOCK, last = next < rows.end ? next : rows.end;
        bool      deep = are_blocks_behind(t, row / BLOCK, columns, box->near_z);
        for (; row < last && !deep; row++)
            if (!is_row_behind(t, f, row, cells_touched(f, row * side, side, around)))
                return false;
        row = last;
    }
    return true;
}

/* The nearest first. What is hidden hides nothing that is not hidden by what hides it. */
static void look_through(tile *t, const uint32_t *entries, size_t count)
{
    const stroke_view *v = t->o->v;
    for (size_t i = 0; i < TILE * TILE; i++)
        t->depths[i] = INFINITY;
    for (size_t i = 0; i < BLOCKS * BLOCKS; i++)
        t->blocks[i] = INFINITY;
    memset(t->stale, 0, sizeof t->stale);
    for (size_t i = 0; i < count; i++) {
        if (is_box_behind(t, &v->boxes[entries[i]]))
            continue;
        const flat_triangle f = flatten(t, entries[i]);
        if (is_behind(t, &f, &v->boxes[entries[i]]))
            continue;
        atomic_store_explicit(&t->o->seen[v->face_pieces[v->triangles[entries[i]].face]], 1, memory_order_relaxed);
        if (isfinite(f.margin))
            cover(t, &f);
    }
}

static void look_through_tiles(size_t begin, size_t end, void *user)
{
    occlusion *o = user;
    tile      *t = mem_alloc(sizeof *t);
    float     *depths = mem_alloc(TILE * TILE * sizeof *depths);
    if (!t || !depths)
        atomic_store(&o->failed, true);
    for (size_t i = begin; i < end && t && depths && !work_stopped(); i++) {
        t->o = o;
        t->depths = depths;
        t->x = o->low_x + (int32_t)(i % (size_t)o->columns) * o->cell * TILE;
        t->y = o->low_y + (int32_t)(i / (size_t)o->columns) * o->cell * TILE;
        if (o->starts[i + 1] > o->starts[i])
            look_through(t, o->entries + o->starts[i], o->starts[i + 1] - o->starts[i]);
    }
    mem_free(t);
    mem_free(depths);
}

/* --- all ------------------------------------------------------------------------------------------------ */

/* Pieces that are smaller, and hidden, are not drawn. */
static double least_of(const stroke_options *options)
{
    return options->hidden ? (double)options->island : INFINITY;
}

static bool take_hidden(uint8_t **out, const occlusion *o)
{
    const uint32_t count = o->v->piece_count;
    *out = mem_alloc((size_t)count + 1);
    for (uint32_t i = 0; i < count && *out; i++)
        (*out)[i] = atomic_load_explicit(&o->seen[i], memory_order_relaxed);
    const bool good = *out && keep_whole(*out, NULL, o->v);
    for (uint32_t i = 0; i < count && good; i++)
        (*out)[i] = !(*out)[i];
    if (good)
        return true;
    mem_free(*out);
    *out = NULL;
    return false;
}

lmn_status occlusion_find(uint8_t **hidden, const stroke_view *v, const stroke_options *options, lmn_error *error)
{
    *hidden = NULL;
    if (!(least_of(options) > 0) || v->piece_count < PIECES_LEAST)
        return LMN_OK;
    occlusion o = {.v = v, .lift = BESIDE_LIFT * v->scene->extent};
    bool      good = choose_pieces(&o, least_of(options));
    if (good && o.asked >= PIECES_LEAST) {
        measure_area(&o);
        good = order_triangles(&o) && fill_tiles(&o);
        if (good)
            threads_for((size_t)o.columns * (size_t)o.rows, 4, look_through_tiles, &o);
        good = good && !atomic_load(&o.failed) && !work_stopped() && take_hidden(hidden, &o);
    }
    mem_free(o.seen);
    mem_free(o.order);
    mem_free(o.starts);
    mem_free(o.entries);
    return good ? LMN_OK : error_memory(error);
}

/* Flags pieces on which a line is seen, and adds up how much of their lines is hidden, units of paper. */
static void look_at_lines(uint8_t *seen, float *lengths, const stroke_view *v, const view_lines *lines,
                          const visibility *by)
{
    for (size_t i = 0; i < lines->count; i++) {
        const window_segment *s = &lines->segments[i];
        const double          whole = hypot((double)s->b.x - s->a.x, (double)s->b.y - s->a.y) / v->units;
        float                 hidden = 0;
        bool                  visible = false;
        for (uint32_t k = by->starts[i]; k < by->starts[i + 1]; k++) {
            const float to = k + 1 < by->starts[i + 1] ? by->spans[k + 1].from : 1;
            visible = visible || by->spans[k].count == 0;
            hidden += by->spans[k].count ? (to - by->spans[k].from) * (float)whole : 0;
        }
        for (int k = 0; k < 2; k++) {
            const uint32_t piece = s->faces[k] == EDGE_NO_FACE ? v->piece_count : v->face_pieces[s->faces[k]];
            seen[piece] |= visible;
            lengths[piece] += hidden;
        }
    }
}

static bool is_on_seen(const uint8_t *seen, const stroke_view *v, const window_segment *s)
{
    bool any = s->faces[0] == EDGE_NO_FACE && s->faces[1] == EDGE_NO_FACE;
    for (int k = 0; k < 2; k++)
        any = any || (s->faces[k] != EDGE_NO_FACE && seen[v->face_pieces[s->faces[k]]]);
    return any;
}

/* Leaves only the lines that are on a piece that is kept. */
static void keep_lines(view_lines *lines, visibility *by, const stroke_view *v, const uint8_t *seen)
{
    uint32_t kept = 0, spans = 0;
    for (size_t i = 0; i < lines->count; i++) {
        const uint32_t first = by->starts[i], end = by->starts[i + 1];
        if (!is_on_seen(seen, v, &lines->segments[i]))
            continue;
        memmove(by->spans + spans, by->spans + first, (end - first) * sizeof *by->spans);
        by->starts[kept] = spans;
        spans += end - first;
        lines->lines[kept] = lines->lines[i];
        lines->segments[kept++] = lines->segments[i];
    }
    by->starts[kept] = spans;
    lines->count = kept;
}

bool occlusion_drop(view_lines *lines, visibility *by, const stroke_view *v, const stroke_options *options)
{
    uint8_t *seen = find_small(v, least_of(options));
    float   *lengths = mem_calloc((size_t)v->piece_count + 1, sizeof *lengths);
    bool     good = seen && lengths;
    for (size_t i = 0; i < v->piece_count && good; i++) { /* what is large stays */
        lengths[i] = seen[i] ? 0 : INFINITY;
        seen[i] = !seen[i];
    }
    if (good)
        look_at_lines(seen, lengths, v, lines, by);
    good = good && keep_whole(seen, lengths, v);
    if (good)
        keep_lines(lines, by, v, seen);
    for (size_t i = 0; i < v->piece_count && good; i++)
        seen[i] = lengths[i] < options->figure;
    if (good && options->hidden)
        lines->bare = seen;
    else
        mem_free(seen);
    mem_free(lengths);
    return good;
}
