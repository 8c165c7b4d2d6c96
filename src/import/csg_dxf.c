/* DXF drawings as OpenSCAD reads them: lines, arcs, circles, ellipses and polylines of one layer (or all), blocks
 * put in place, joined into paths. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/error.h"
#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "import/csg.h"

static const double RADIANS = 0.017453292519943295, JOINS = 0.001;
enum { NAME_SIZE = 64, LINES_MAX = 4000000 };

typedef struct line2 {
    point2 ends[2];
} line2;

typedef struct line_list {
    line2 *items;
    size_t count, capacity;
} line_list;

typedef struct block {
    char   name[NAME_SIZE];
    size_t first, count; /* of the block lines */
} block;

/* What the groups of one entity say, by their codes. */
typedef struct entity {
    char    type[NAME_SIZE], name[NAME_SIZE], layer[NAME_SIZE];
    double  x[2], y[2], radius, ratio[2] /* 41, 42 */, angles[2] /* 50, 51 */;
    int     flags;
    point2 *vertices;
    size_t  vertex_count, vertex_capacity;
} entity;

typedef struct drawing {
    const char        *at, *end;
    int                line, code;
    char               value[256];
    const csg_drawing *how;
    char               section[NAME_SIZE];
    entity             entity;
    line_list          lines, block_lines; /* in the drawing's unit */
    block             *blocks;
    size_t             block_count, block_capacity;
    bool               in_block, in_polyline, polyline_closed;
    lmn_error         *error;
} drawing;

/* --- groups --------------------------------------------------------------------------------------------- */

static void take_line(drawing *d, char *out, size_t size)
{
    const char *newline = memchr(d->at, '\n', (size_t)(d->end - d->at)), *stop = newline ? newline : d->end;
    const char *from = d->at, *to = stop;
    while (from < to && (*from == ' ' || *from == '\t'))
        from++;
    while (to > from && (to[-1] == '\r' || to[-1] == ' ' || to[-1] == '\t'))
        to--;
    size_t length = (size_t)(to - from) < size - 1 ? (size_t)(to - from) : size - 1;
    memcpy(out, from, length);
    out[length] = '\0';
    d->at = newline ? newline + 1 : d->end;
    d->line++;
}

/* A group is a line with its code and one with its value. *more becomes false at the end. */
static lmn_status take_group(drawing *d, bool *more)
{
    char      code[32];
    long long number;
    *more = d->at < d->end;
    if (!*more)
        return LMN_OK;
    take_line(d, code, sizeof code);
    if (*code == '\0' && d->at >= d->end) {
        *more = false;
        return LMN_OK;
    }
    if (!text_is_int(code, &number) || number < -10000 || number > 10000)
        return error_set(d->error, LMN_FORMAT, "DXF line %d: a group code is expected", d->line);
    d->code = (int)number;
    take_line(d, d->value, sizeof d->value);
    return LMN_OK;
}

static void copy_name(char out[NAME_SIZE], const char *value)
{
    size_t length = strnlen(value, NAME_SIZE - 1);
    memmove(out, value, length);
    out[length] = '\0';
}

static double number_of(const drawing *d)
{
    double value = 0;
    return text_parse_double(d->value, d->value + strlen(d->value), &value) && fabs(value) < 1e15 ? value : 0;
}

static lmn_status keep_group(drawing *d)
{
    entity *e = &d->entity;
    switch (d->code) {
    case 2: copy_name(e->name, d->value); break;
    case 8: copy_name(e->layer, d->value); break;
    case 10:
        e->x[0] = number_of(d);
        if (!mem_grow((void **)&e->vertices, &e->vertex_capacity, e->vertex_count + 1, sizeof *e->vertices))
            return error_memory(d->error);
        e->vertices[e->vertex_count++] = (point2){e->x[0], 0};
        break;
    case 11: e->x[1] = number_of(d); break;
    case 20:
        e->y[0] = number_of(d);
        if (e->vertex_count > 0)
            e->vertices[e->vertex_count - 1].y = e->y[0];
        break;
    case 21: e->y[1] = number_of(d); break;
    case 40: e->radius = number_of(d); break;
    case 41:
    case 42: e->ratio[d->code - 41] = number_of(d); break;
    case 50:
    case 51: e->angles[d->code - 50] = number_of(d); break;
    case 70: e->flags = (int)fmin(fmax(number_of(d), 0), 65535); break; /* bits of a 16-bit number */
    default: break;
    }
    return LMN_OK;
}

/* --- entities ------------------------------------------------------------------------------------------- */

static lmn_status add_line(drawing *d, point2 a, point2 b)
{
    bool shown =
        strcmp(d->section, "ENTITIES") == 0 && (!*d->how->layer || strcmp(d->how->layer, d->entity.layer) == 0);
    bool       kept = strcmp(d->section, "BLOCKS") == 0 && d->in_block;
    line_list *l = kept ? &d->block_lines : &d->lines;
    if (!shown && !kept)
        return LMN_OK;
    if (l->count >= LINES_MAX)
        return error_set(d->error, LMN_LIMIT, "the drawing has more than %d lines", LINES_MAX);
    if (!mem_grow((void **)&l->items, &l->capacity, l->count + 1, sizeof *l->items))
        return error_memory(d->error);
    l->items[l->count++] = (line2){{a, b}};
    if (kept)
        d->blocks[d->block_count - 1].count++;
    return LMN_OK;
}

/* An arc of an ellipse: radii along its axes, which are turned by `turn`; angles in degrees. */
static lmn_status add_arc(drawing *d, point2 centre, const double radii[2], double turn, double from, double to)
{
    int        whole = facets_of_circle(fmax(radii[0], radii[1]), d->how->facets);
    double     fraction = (to - from) / 360;
    int        pieces = (int)ceil(whole * fraction - 1e-9);
    point2     last = {0, 0};
    lmn_status status = LMN_OK;
    for (int i = 0; i <= pieces && pieces > 0 && status == LMN_OK; i++) {
        double angle = (from + (to - from) * i / pieces) * RADIANS;
        double x = radii[0] * cos(angle), y = radii[1] * sin(angle);
        point2 p = {centre.x + x * cos(turn) - y * sin(turn), centre.y + x * sin(turn) + y * cos(turn)};
        if (i > 0)
            status = add_line(d, last, p);
        last = p;
    }
    return status;
}

static lmn_status add_vertices(drawing *d, bool closed)
{
    const entity *e = &d->entity;
    lmn_status    status = LMN_OK;
    for (size_t i = 1; i < e->vertex_count && status == LMN_OK; i++)
        status = add_line(d, e->vertices[i - 1], e->vertices[i]);
    if (status == LMN_OK && closed && e->vertex_count > 2)
        status = add_line(d, e->vertices[e->vertex_count - 1], e->vertices[0]);
    return status;
}

static lmn_status add_block(drawing *d)
{
    const entity *e = &d->entity;
    const block  *found = NULL;
    for (size_t i = 0; i < d->block_count && !found; i++)
        if (strcmp(d->blocks[i].name, e->name) == 0)
            found = &d->blocks[i];
    double     c = cos(e->angles[0] * RADIANS), s = sin(e->angles[0] * RADIANS);
    double     sx = e->ratio[0] != 0 ? e->ratio[0] : 1, sy = e->ratio[1] != 0 ? e->ratio[1] : 1;
    lmn_status status = LMN_OK;
    for (size_t i = 0; found && i < found->count && status == LMN_OK; i++) {
        line2 l = d->block_lines.items[found->first + i];
        for (int k = 0; k < 2; k++) {
            double x = l.ends[k].x * sx, y = l.ends[k].y * sy;
            l.ends[k] = (point2){c * x - s * y + e->x[0], s * x + c * y + e->y[0]};
        }
        /* Blocks within blocks are not followed. */
        if (strcmp(d->section, "ENTITIES") == 0)
            status = add_line(d, l.ends[0], l.ends[1]);
    }
    return status;
}

static lmn_status add_round(drawing *d)
{
    const entity *e = &d->entity;
    point2        centre = {e->x[0], e->y[0]};
    double        radii[2] = {e->radius, e->radius}, from = 0, to = 360, turn = 0;
    if (strcmp(e->type, "ARC") == 0) {
        from = e->angles[0];
        to = e->angles[1];
    } else if (strcmp(e->type, "ELLIPSE") == 0) {
        radii[0] = hypot(e->x[1], e->y[1]);
        radii[1] = radii[0] * e->radius;
        turn = atan2(e->y[1], e->x[1]);
        if (e->ratio[1] != 0) {
            from = e->ratio[0] / RADIANS;
            to = e->ratio[1] / RADIANS;
        }
    }
    from = fmod(from, 360);
    to = fmod(to, 360);
    if (to <= from + 1e-9)
        to += 360;
    return add_arc(d, centre, radii, turn, from, to);
}

static lmn_status begin_block(drawing *d)
{
    if (!mem_grow((void **)&d->blocks, &d->block_capacity, d->block_count + 1, sizeof *d->blocks))
        return error_memory(d->error);
    block *b = &d->blocks[d->block_count++];
    *b = (block){.first = d->block_lines.count};
    copy_name(b->name, d->entity.name);
    d->in_block = true;
    return LMN_OK;
}

/* Returns whether the entity's vertices go on with the next one. */
static lmn_status end_entity(drawing *d, bool *goes_on)
{
    entity     *e = &d->entity;
    const char *type = e->type;
    *goes_on = false;
    if (strcmp(type, "SECTION") == 0)
        copy_name(d->section, e->name);
    else if (strcmp(type, "BLOCK") == 0)
        return begin_block(d);
    else if (strcmp(type, "ENDBLK") == 0)
        d->in_block = false;
    else if (strcmp(type, "LINE") == 0)
        return add_line(d, (point2){e->x[0], e->y[0]}, (point2){e->x[1], e->y[1]});
    else if (strcmp(type, "ARC") == 0 || strcmp(type, "CIRCLE") == 0 || strcmp(type, "ELLIPSE") == 0)
        return add_round(d);
    else if (strcmp(type, "LWPOLYLINE") == 0)
        return add_vertices(d, e->flags & 1);
    else if (strcmp(type, "INSERT") == 0)
        return add_block(d);
    else if (strcmp(type, "POLYLINE") == 0) {
        /* Its own point is none of its vertices. */
        d->in_polyline = *goes_on = true;
        d->polyline_closed = e->flags & 1;
        e->vertex_count = 0;
    } else if (strcmp(type, "VERTEX") == 0) {
        *goes_on = d->in_polyline;
    } else if (strcmp(type, "SEQEND") == 0 && d->in_polyline) {
        d->in_polyline = false;
        return add_vertices(d, d->polyline_closed);
    }
    return LMN_OK;
}

static lmn_status read_groups(drawing *d)
{
    bool more = true, goes_on = false;
    for (;;) {
        lmn_status status = take_group(d, &more);
        if (status == LMN_OK && (!more || d->code == 0))
            status = end_entity(d, &goes_on);
        if (status != LMN_OK || !more)
            return status;
        if (d->code != 0) {
            status = keep_group(d);
            if (status != LMN_OK)
                return status;
            continue;
        }
        entity *e = &d->entity;
        point2 *vertices = e->vertices;
        size_t  count = goes_on ? e->vertex_count : 0, capacity = e->vertex_capacity;
        char    layer[NAME_SIZE];
        copy_name(layer, goes_on ? e->layer : "");
        *e = (entity){.vertices = vertices, .vertex_count = count, .vertex_capacity = capacity};
        copy_name(e->type, d->value);
        copy_name(e->layer, layer);
    }
}

/* --- paths ---------------------------------------------------------------------------------------------- */

/* Ends that lie within JOINS of each other are one point: a hash table of cells as wide. */
typedef struct joints {
    point2   *points;
    size_t    count;
    uint32_t *next, *slots; /* points of a slot are chained */
    size_t    slot_count;
    uint32_t (*ends)[2]; /* of the lines */
} joints;

static size_t slot_of(const joints *j, double x, double y)
{
    /* Cells that no integer counts share a slot. */
    int64_t  column = fabs(x) < 9e18 ? (int64_t)x : 0, row = fabs(y) < 9e18 ? (int64_t)y : 0;
    uint64_t h = (uint64_t)column * 0x9E3779B97F4A7C15u ^ (uint64_t)row * 0xC2B2AE3D27D4EB4Fu;
    return (size_t)(h ^ h >> 29) & (j->slot_count - 1);
}

static uint32_t joint_at(joints *j, point2 p)
{
    double x = floor(p.x / JOINS), y = floor(p.y / JOINS);
    for (int dx = -1; dx <= 1; dx++)
        for (int dy = -1; dy <= 1; dy++)
            for (uint32_t i = j->slots[slot_of(j, x + dx, y + dy)]; i != UINT32_MAX; i = j->next[i])
                if (hypot(j->points[i].x - p.x, j->points[i].y - p.y) <= JOINS)
                    return i;
    uint32_t made = (uint32_t)j->count++;
    size_t   slot = slot_of(j, x, y);
    j->points[made] = p;
    j->next[made] = j->slots[slot];
    j->slots[slot] = made;
    return made;
}

static bool join(joints *j, const line_list *lines, const csg_drawing *how)
{
    size_t ends = 2 * lines->count;
    for (j->slot_count = 64; j->slot_count < ends;)
        j->slot_count *= 2;
    j->points = mem_alloc(ends * sizeof *j->points);
    j->next = mem_alloc(ends * sizeof *j->next);
    j->slots = mem_alloc(j->slot_count * sizeof *j->slots);
    j->ends = mem_alloc(lines->count * sizeof *j->ends);
    if (!j->points || !j->next || !j->slots || !j->ends)
        return false;
    memset(j->slots, 0xFF, j->slot_count * sizeof *j->slots);
    for (size_t i = 0; i < lines->count; i++)
        for (int k = 0; k < 2; k++) {
            point2 p = lines->items[i].ends[k];
            j->ends[i][k] =
                joint_at(j, (point2){(p.x - how->origin[0]) * how->scale, (p.y - how->origin[1]) * how->scale});
        }
    return true;
}

/* The lines at each point, one after the other: those of point p are lines[first[p]] … lines[first[p + 1] − 1]. */
typedef struct incidence {
    size_t   *first;
    uint32_t *lines;
    bool     *used;
} incidence;

static bool list_lines(incidence *in, const joints *j, size_t line_count)
{
    in->first = mem_calloc(j->count + 2, sizeof *in->first);
    in->lines = mem_alloc(2 * line_count * sizeof *in->lines);
    in->used = mem_calloc(line_count, sizeof *in->used);
    if (!in->first || !in->lines || !in->used)
        return false;
    for (size_t i = 0; i < line_count; i++) {
        in->used[i] = j->ends[i][0] == j->ends[i][1];
        for (int k = 0; k < 2 && !in->used[i]; k++)
            in->first[j->ends[i][k] + 2]++;
    }
    for (size_t p = 2; p < j->count + 2; p++)
        in->first[p] += in->first[p - 1];
    for (size_t i = 0; i < line_count; i++)
        for (int k = 0; k < 2 && !in->used[i]; k++)
            in->lines[in->first[j->ends[i][k] + 1]++] = (uint32_t)i;
    return true;
}

/* Walks from a point along unused lines as far as there are some or until it is back. Returns how many points were
 * written; the last one of an open path is among them, since OpenSCAD closes such paths by a line. */
static size_t walk(incidence *in, const joints *j, uint32_t start, uint32_t *corners)
{
    size_t   count = 0;
    uint32_t at = start;
    for (;;) {
        uint32_t line = UINT32_MAX;
        for (size_t i = in->first[at]; i < in->first[at + 1] && line == UINT32_MAX; i++)
            if (!in->used[in->lines[i]])
                line = in->lines[i];
        if (line == UINT32_MAX) {
            if (count > 0)
                corners[count++] = at;
            return count;
        }
        in->used[line] = true;
        corners[count++] = at;
        at = j->ends[line][0] == at ? j->ends[line][1] : j->ends[line][0];
        if (at == start)
            return count;
    }
}

/* Open paths first, from the points where a line ends alone; what is left then are loops. */
static lmn_status trace(const joints *j, incidence *in, size_t line_count, region *out, lmn_error *error)
{
    /* An open path has one point more than lines, and there are as many such paths as lines at most. */
    uint32_t *corners = mem_alloc((2 * line_count + 1) * sizeof *corners),
             *sizes = mem_alloc((line_count + 1) * sizeof *sizes);
    size_t corner_count = 0, path_count = 0, count;
    for (int pass = 0; pass < 2 && corners && sizes; pass++)
        for (uint32_t p = 0; p < j->count; p++)
            while ((pass == 1 || in->first[p + 1] - in->first[p] == 1) &&
                   (count = walk(in, j, p, corners + corner_count)) > 0) {
                corner_count += count;
                sizes[path_count++] = (uint32_t)count;
            }
    lmn_status status = corners && sizes
                            ? construct_polygon(out, j->points, j->count, corners, sizes, path_count, error)
                            : error_memory(error);
    mem_free(corners);
    mem_free(sizes);
    return status;
}

static lmn_status make_paths(drawing *d, region *out)
{
    joints     j = {0};
    incidence  in = {0};
    lmn_status status = LMN_OK;
    if (!join(&j, &d->lines, d->how) || !list_lines(&in, &j, d->lines.count))
        status = error_memory(d->error);
    else
        status = trace(&j, &in, d->lines.count, out, d->error);
    mem_free(j.points);
    mem_free(j.next);
    mem_free(j.slots);
    mem_free(j.ends);
    mem_free(in.first);
    mem_free(in.lines);
    mem_free(in.used);
    return status;
}

lmn_status csg_dxf(const char *bytes, size_t size, const csg_drawing *how, region *out, lmn_error *error)
{
    drawing    d = {.at = bytes, .end = bytes + size, .how = how, .error = error};
    lmn_status status = read_groups(&d);
    if (status == LMN_OK && d.lines.count > 0)
        status = make_paths(&d, out);
    mem_free(d.entity.vertices);
    mem_free(d.lines.items);
    mem_free(d.block_lines.items);
    mem_free(d.blocks);
    return status;
}
