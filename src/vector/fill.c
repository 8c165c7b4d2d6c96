/* Areas of parts: what is seen of each, in one colour. Parts run through each other and lie before and behind each
 * other at once, so that no order of painting is right; visibility is worked out in a picture of part numbers
 * several times as fine as the page's pixels, and its borders are traced and straightened. They are off by about a
 * third of a pixel, below lines that are wider; on large pages by more. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/solid.h"
#include "vector/vector_private.h"

static const double cells_a_pixel = 3, cells_most = 1e7;
static const double nearest_w = 1e-9;
static const float  straight_within = 0.75f; /* cells that a border may be moved by */

/* A piece of border between two cells: from a corner of the grid of cells to the next one, its own part on its
 * left. */
typedef struct crack {
    uint32_t from, to, part;
} crack;

typedef struct fill_job {
    const vector_ink   *ink;
    const vector_view  *view;
    const stroke_scene *strokes;
    int                 columns, rows;
    uint32_t           *parts; /* of each cell, id; 0: nothing */
    float              *depths;
    crack              *cracks;
    size_t              crack_count, crack_capacity;
    uint32_t           *heads, *next; /* cracks that leave a corner, + 1 */
    float (*loop)[2], (*kept)[2];
    size_t             loop_count, loop_capacity, kept_capacity;
    bool              *stays;
    size_t             stays_capacity;
    struct solid_rows *solid; /* NULL: each face is a surface */
} fill_job;

typedef struct corner {
    double x, y, z; /* cells; depth that is affine on the page */
} corner;

/* A face of a solid's operand on the page. */
typedef struct solid_triangle {
    corner   p[3];
    uint32_t face; /* of its mesh */
    uint32_t next; /* that begins in the same row, + 1 */
} solid_triangle;

typedef struct row_hit {
    solid_hit hit;
    uint32_t  next; /* in the same cell, + 1 */
} row_hit;

/* A solid that is found cell by cell, row after row. */
typedef struct solid_rows {
    const edge_solid *solid;
    solid_state       state;
    uint32_t          face; /* that is put in */
    solid_triangle   *triangles;
    size_t            triangle_count, triangle_capacity;
    uint32_t         *tops; /* per row: the first triangle that begins there, + 1 */
    uint32_t         *active;
    size_t            active_count, active_capacity;
    row_hit          *hits;
    size_t            hit_count, hit_capacity;
    uint32_t         *cells; /* per column: the first hit, + 1 */
    solid_hit        *line;  /* hits of one cell */
    size_t            line_capacity;
    bool              failed;
} solid_rows;

/* --- the picture ---------------------------------------------------------------------------------------- */

static corner corner_of(const fill_job *j, const double clip[4])
{
    return (corner){(clip[0] / clip[3] + 1) / 2 * j->columns, (1 - clip[1] / clip[3]) / 2 * j->rows, clip[2] / clip[3]};
}

static void draw_row(fill_job *j, int row, double from, double to, double z, double slope, uint32_t part)
{
    int first = (int)fmax(ceil(from - 0.5), 0), last = (int)fmin(ceil(to - 0.5) - 1, j->columns - 1);
    for (int x = first; x <= last; x++) {
        size_t cell = (size_t)row * (size_t)j->columns + (size_t)x;
        float  depth = (float)(z + slope * (x + 0.5));
        if (depth < j->depths[cell]) {
            j->depths[cell] = depth;
            j->parts[cell] = part;
        }
    }
}

/* What a triangle covers of a row; its depth there is z + slope · x. */
typedef struct row_span {
    double from, to, z, slope;
} row_span;

static bool find_span(const fill_job *j, const corner p[3], int row, row_span *out)
{
    double area = (p[1].x - p[0].x) * (p[2].y - p[0].y) - (p[2].x - p[0].x) * (p[1].y - p[0].y);
    if (!(fabs(area) > 1e-12) || !isfinite(area))
        return false;
    double dx = ((p[1].z - p[0].z) * (p[2].y - p[0].y) - (p[2].z - p[0].z) * (p[1].y - p[0].y)) / area;
    double dy = ((p[2].z - p[0].z) * (p[1].x - p[0].x) - (p[1].z - p[0].z) * (p[2].x - p[0].x)) / area;
    double y = row + 0.5, from = INFINITY, to = -INFINITY;
    for (int k = 0; k < 3; k++) {
        const corner *a = &p[k], *b = &p[(k + 1) % 3];
        if ((a->y <= y) == (b->y <= y))
            continue;
        double x = a->x + (y - a->y) / (b->y - a->y) * (b->x - a->x);
        from = fmin(from, x);
        to = fmax(to, x);
    }
    *out = (row_span){fmax(from, -1), fmin(to, j->columns + 1.0), p[0].z + dy * (y - p[0].y) - dx * p[0].x, dx};
    return from < to;
}

static void find_rows(const fill_job *j, const corner p[3], int out[2])
{
    double top = fmin(p[0].y, fmin(p[1].y, p[2].y)), bottom = fmax(p[0].y, fmax(p[1].y, p[2].y));
    out[0] = (int)fmin(fmax(ceil(top - 0.5), 0), j->rows);
    out[1] = (int)fmax(fmin(ceil(bottom - 0.5) - 1, j->rows - 1), -1);
}

static void put_solid_triangle(fill_job *j, const corner p[3])
{
    solid_rows *s = j->solid;
    int         rows[2];
    find_rows(j, p, rows);
    if (rows[0] > rows[1])
        return;
    if (!mem_grow((void **)&s->triangles, &s->triangle_capacity, s->triangle_count + 1, sizeof *s->triangles)) {
        s->failed = true;
        return;
    }
    s->triangles[s->triangle_count] = (solid_triangle){{p[0], p[1], p[2]}, s->face, s->tops[rows[0]]};
    s->tops[rows[0]] = (uint32_t)++s->triangle_count;
}

static void draw_triangle(fill_job *j, const corner p[3], uint32_t part)
{
    int      rows[2];
    row_span span;
    if (j->solid) {
        put_solid_triangle(j, p);
        return;
    }
    find_rows(j, p, rows);
    for (int row = rows[0]; row <= rows[1]; row++)
        if (find_span(j, p, row, &span))
            draw_row(j, row, span.from, span.to, span.z, span.slope, part);
}

/* Draws what of a triangle lies before the eye. */
static void draw_clipped(fill_job *j, const double clip[3][4], uint32_t part)
{
    corner kept[4];
    int    count = 0;
    for (int k = 0; k < 3; k++) {
        const double *a = clip[k], *b = clip[(k + 1) % 3];
        bool          a_in = a[3] > nearest_w && a[2] >= -a[3], b_in = b[3] > nearest_w && b[2] >= -b[3];
        if (a_in)
            kept[count++] = corner_of(j, a);
        if (a_in == b_in)
            continue;
        double cut[4], a_off = a[2] + a[3], b_off = b[2] + b[3], t = a_off / (a_off - b_off);
        for (int n = 0; n < 4; n++)
            cut[n] = a[n] + t * (b[n] - a[n]);
        if (cut[3] > nearest_w)
            kept[count++] = corner_of(j, cut);
    }
    for (int k = 2; k < count; k++)
        draw_triangle(j, (const corner[3]){kept[0], kept[k - 1], kept[k]}, part);
}

static void draw_faces(fill_job *j, const stroke_item *item)
{
    const edge_mesh *m = &j->strokes->meshes[item->mesh];
    mat4             both = mat4_multiply(&j->view->camera.projection, &j->view->camera.view),
         all = mat4_multiply(&both, &item->world);
    for (uint32_t f = 0; f < m->face_count; f++) {
        double clip[3][4] = {{0}};
        if (j->solid)
            j->solid->face = f;
        for (int k = 0; k < 3; k++) {
            vec3         v = m->positions[m->faces[f][k]];
            const double from[4] = {(double)v.x, (double)v.y, (double)v.z, 1};
            for (int n = 0; n < 16; n++)
                clip[k][n % 4] += all.m[n] * from[n / 4];
        }
        draw_clipped(j, (const double(*)[4])clip, item->part_index + 1);
    }
}

/* --- solids --------------------------------------------------------------------------------------------- */

static bool put_hits(fill_job *j, const solid_triangle *t, int row)
{
    solid_rows *s = j->solid;
    row_span    span;
    if (!find_span(j, t->p, row, &span))
        return true;
    int first = (int)fmax(ceil(span.from - 0.5), 0), last = (int)fmin(ceil(span.to - 0.5) - 1, j->columns - 1);
    for (int x = first; x <= last; x++) {
        if (!mem_grow((void **)&s->hits, &s->hit_capacity, s->hit_count + 1, sizeof *s->hits))
            return false;
        s->hits[s->hit_count] =
            (row_hit){{span.z + span.slope * (x + 0.5), s->solid->operands[t->face], s->solid->planes[t->face], true},
                      s->cells[x]};
        s->cells[x] = (uint32_t)++s->hit_count;
    }
    return true;
}

/* Where the solid is seen at a cell. What is met an odd number of times is around the eye. */
static bool draw_cell(fill_job *j, int row, int x, uint32_t part)
{
    solid_rows *s = j->solid;
    size_t      count = 0;
    double      at;
    for (uint32_t i = s->cells[x]; i; i = s->hits[i - 1].next) {
        if (!mem_grow((void **)&s->line, &s->line_capacity, count + 1, sizeof *s->line))
            return false;
        s->line[count++] = s->hits[i - 1].hit;
    }
    s->cells[x] = 0;
    for (size_t i = 0; i < count; i++)
        solid_state_pass(&s->state, s->line[i].operand);
    if (solid_first_entry(&s->state, s->line, count, &at))
        draw_row(j, row, x, x + 1, at, 0, part);
    for (size_t i = 0; i < count; i++)
        solid_state_pass(&s->state, s->line[i].operand);
    return true;
}

static bool draw_solid_row(fill_job *j, int row, uint32_t part)
{
    solid_rows *s = j->solid;
    size_t      kept = 0;
    bool        good = true;
    for (uint32_t i = s->tops[row]; i && good; i = s->triangles[i - 1].next) {
        good = mem_grow((void **)&s->active, &s->active_capacity, s->active_count + 1, sizeof *s->active);
        if (good)
            s->active[s->active_count++] = i - 1;
    }
    s->hit_count = 0;
    for (size_t i = 0; i < s->active_count && good; i++) {
        const solid_triangle *t = &s->triangles[s->active[i]];
        int                   rows[2];
        find_rows(j, t->p, rows);
        if (rows[1] < row)
            continue;
        s->active[kept++] = s->active[i];
        good = put_hits(j, t, row);
    }
    s->active_count = kept;
    for (int x = 0; x < j->columns && good; x++)
        good = !s->cells[x] || draw_cell(j, row, x, part);
    return good;
}

static bool draw_solid(fill_job *j, const stroke_item *item)
{
    solid_rows s = {.solid = j->strokes->meshes[item->mesh].solid};
    s.tops = mem_calloc((size_t)j->rows + 1, sizeof *s.tops);
    s.cells = mem_calloc((size_t)j->columns + 1, sizeof *s.cells);
    bool good = solid_state_open(&s.state, &s.solid->program) && s.tops && s.cells;
    j->solid = &s;
    if (good)
        draw_faces(j, item);
    for (int row = 0; row < j->rows && good; row++)
        good = !s.failed && draw_solid_row(j, row, item->part_index + 1);
    j->solid = NULL;
    solid_state_release(&s.state);
    mem_free(s.triangles);
    mem_free(s.tops);
    mem_free(s.active);
    mem_free(s.hits);
    mem_free(s.cells);
    mem_free(s.line);
    return good;
}

static bool draw_item(fill_job *j, const stroke_item *item)
{
    if (j->strokes->meshes[item->mesh].solid)
        return draw_solid(j, item);
    draw_faces(j, item);
    return true;
}

static bool draw_parts(fill_job *j)
{
    double finer = fmin(cells_a_pixel, sqrt(cells_most / j->view->width / j->view->height));
    j->columns = (int)fmax(j->view->width * finer, 1);
    j->rows = (int)fmax(j->view->height * finer, 1);
    size_t count = (size_t)j->columns * (size_t)j->rows;
    j->parts = mem_calloc(count, sizeof *j->parts);
    j->depths = mem_alloc(count * sizeof *j->depths);
    if (!j->parts || !j->depths)
        return false;
    for (size_t i = 0; i < count; i++)
        j->depths[i] = INFINITY;
    bool good = true;
    for (size_t i = 0; i < j->strokes->item_count && good; i++)
        good = draw_item(j, &j->strokes->items[i]);
    return good;
}

/* --- borders -------------------------------------------------------------------------------------------- */

static uint32_t part_at(const fill_job *j, int x, int y)
{
    return x >= 0 && y >= 0 && x < j->columns && y < j->rows ? j->parts[(size_t)y * (size_t)j->columns + (size_t)x] : 0;
}

static bool add_crack(fill_job *j, int x0, int y0, int x1, int y1, uint32_t part)
{
    size_t across = (size_t)j->columns + 1;
    if (!mem_grow((void **)&j->cracks, &j->crack_capacity, j->crack_count + 1, sizeof *j->cracks))
        return false;
    j->cracks[j->crack_count++] =
        (crack){(uint32_t)((size_t)y0 * across + (size_t)x0), (uint32_t)((size_t)y1 * across + (size_t)x1), part};
    return true;
}

/* The border around each cell that is another part than its neighbour: anticlockwise as it is seen. */
static bool find_cracks(fill_job *j)
{
    bool good = true;
    for (int y = 0; y < j->rows && good; y++)
        for (int x = 0; x < j->columns && good; x++) {
            uint32_t own = part_at(j, x, y);
            if (!own)
                continue;
            if (part_at(j, x, y - 1) != own)
                good = good && add_crack(j, x + 1, y, x, y, own);
            if (part_at(j, x - 1, y) != own)
                good = good && add_crack(j, x, y, x, y + 1, own);
            if (part_at(j, x, y + 1) != own)
                good = good && add_crack(j, x, y + 1, x + 1, y + 1, own);
            if (part_at(j, x + 1, y) != own)
                good = good && add_crack(j, x + 1, y + 1, x + 1, y, own);
        }
    return good;
}

static int compare_cracks(const void *a, const void *b)
{
    const crack *one = a, *other = b;
    if (one->part != other->part)
        return one->part < other->part ? -1 : 1;
    return one->from < other->from ? -1 : one->from > other->from;
}

/* Marks the points that are farthest from the straight way between `from` and `to`, until all others are near it. */
static void keep_bends(fill_job *j, size_t from, size_t to)
{
    while (to - from > 1) {
        const float *a = j->loop[from], *b = j->loop[to % j->loop_count];
        float        dx = b[0] - a[0], dy = b[1] - a[1], length = hypotf(dx, dy), most = -1;
        size_t       farthest = from;
        for (size_t i = from + 1; i < to; i++) {
            const float *p = j->loop[i];
            float        off =
                length > 0 ? fabsf(dx * (p[1] - a[1]) - dy * (p[0] - a[0])) / length : hypotf(p[0] - a[0], p[1] - a[1]);
            if (off > most) {
                most = off;
                farthest = i;
            }
        }
        if (most <= straight_within)
            return;
        j->stays[farthest] = true;
        /* The shorter half by another call, so that these lie few within each other. */
        if (farthest - from < to - farthest) {
            keep_bends(j, from, farthest);
            from = farthest;
        } else {
            keep_bends(j, farthest, to);
            to = farthest;
        }
    }
}

/* The loop that begins at a crack, through the middles of cracks, onto the sheet. */
static bool put_loop(fill_job *j, sheet *s, uint32_t corner_index)
{
    size_t across = (size_t)j->columns + 1, count = 0;
    j->loop_count = 0;
    while (j->heads[corner_index]) {
        const crack *c = &j->cracks[j->heads[corner_index] - 1];
        if (!mem_grow((void **)&j->loop, &j->loop_capacity, j->loop_count + 1, sizeof *j->loop))
            return false;
        j->loop[j->loop_count][0] = (float)(c->from % across + c->to % across) / 2;
        j->loop[j->loop_count++][1] = (float)(c->from / across + c->to / across) / 2;
        j->heads[corner_index] = j->next[j->heads[corner_index] - 1];
        corner_index = c->to;
    }
    if (!mem_grow((void **)&j->stays, &j->stays_capacity, j->loop_count, sizeof *j->stays) ||
        !mem_grow((void **)&j->kept, &j->kept_capacity, j->loop_count, sizeof *j->kept))
        return false;
    memset(j->stays, 0, j->loop_count * sizeof *j->stays);
    j->stays[0] = true;
    keep_bends(j, 0, j->loop_count);
    for (size_t i = 0; i < j->loop_count; i++)
        if (j->stays[i]) {
            j->kept[count][0] = (float)(j->ink->origin[0] + (double)j->loop[i][0] / j->columns * j->view->box[2]);
            j->kept[count++][1] = (float)(j->ink->origin[1] + (double)j->loop[i][1] / j->rows * j->view->box[3]);
        }
    sheet_add_path(s, &(sheet_path){.closed = true, .filled = true}, (const float(*)[2])j->kept, count);
    return true;
}

/* All loops of the cracks first … end−1, which are of one part. */
static bool put_part(fill_job *j, sheet *s, size_t first, size_t end)
{
    for (size_t i = end; i-- > first;) {
        j->next[i] = j->heads[j->cracks[i].from];
        j->heads[j->cracks[i].from] = (uint32_t)i + 1;
    }
    for (size_t i = first; i < end; i++)
        while (j->heads[j->cracks[i].from])
            if (!put_loop(j, s, j->cracks[i].from))
                return false;
    return true;
}

static bool put_parts(fill_job *j, sheet *s, uint32_t group, const plan *plan)
{
    const lmn_scene *scene = j->ink->scene;
    j->heads = mem_calloc(((size_t)j->columns + 1) * ((size_t)j->rows + 1), sizeof *j->heads);
    j->next = mem_calloc(j->crack_count, sizeof *j->next);
    if (!j->heads || !j->next)
        return false;
    if (j->crack_count)
        qsort(j->cracks, j->crack_count, sizeof *j->cracks, compare_cracks);
    for (size_t first = 0, end; first < j->crack_count; first = end) {
        uint32_t part = j->cracks[first].part;
        for (end = first + 1; end < j->crack_count && j->cracks[end].part == part;)
            end++;
        uint32_t own = sheet_add_group(s, (int32_t)group, scene->parts[part - 1].name, "part fill", part);
        sheet_add_item(
            s, SHEET_PATH, own,
            vector_fill_colour(plan_rule(plan, part - 1), scene, part - 1, plan_datum_colour(plan, part - 1)), 0);
        if (!put_part(j, s, first, end))
            return false;
    }
    return true;
}

lmn_status vector_put_fills(sheet *s, const vector_ink *ink, const vector_view *view, const stroke_scene *strokes,
                            const plan *plan, lmn_progress_fn progress, void *user, lmn_error *error)
{
    fill_job j = {.ink = ink, .view = view, .strokes = strokes};
    uint32_t group = sheet_add_group(s, (int32_t)ink->group, "fills", "fills", 0);
    bool     good = draw_parts(&j), goes_on = !progress || progress(0, "filling", user);
    if (good && goes_on)
        good = find_cracks(&j) && put_parts(&j, s, group, plan);
    mem_free(j.parts);
    mem_free(j.depths);
    mem_free(j.cracks);
    mem_free(j.heads);
    mem_free(j.next);
    mem_free(j.loop);
    mem_free(j.kept);
    mem_free(j.stays);
    if (!good)
        return error_memory(error);
    return goes_on ? LMN_OK : error_set(error, LMN_CANCELLED, "cancelled");
}
