#include "house.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "glb.h"

static const struct {
    const char *name;
    int         material;
} part_facts[PART_COUNT] = {
    [GROUND] = {"ground", GRASS},
    [PATH] = {"path", STONE},
    [STEPS] = {"steps", STONE},
    [PLINTH] = {"plinth", STONE},
    [WALLS] = {"walls", BRICK},
    [GABLES] = {"gables", WOOD},
    [ROOF] = {"roof", TILES},
    [RIDGE] = {"ridge", TILES},
    [BEAMS] = {"beams", WOOD},
    [STONES] = {"stones", STONE},
    [FRAMES] = {"frames", PAINT},
    [SHUTTERS] = {"shutters", WOOD},
    [DOOR] = {"door", WOOD},
    [GLASS_PART] = {"windows", GLASS},
    [IRON_PART] = {"iron", IRON},
    [CHIMNEY] = {"chimney", BRICK},
    [POTS] = {"chimney pots", TILES},
    [TOWER] = {"tower", BRICK},
    [TOWER_STONES] = {"tower stones", STONE},
    [TOWER_ROOF] = {"tower roof", TILES},
    [GARDEN_WALL] = {"garden wall", STONE},
    [COPING] = {"coping", STONE},
    [CAPACITY] = {"room", PAINT},
    [FLOOR] = {"floor", WOOD},
    [JOISTS] = {"joists", WOOD},
    [HEARTH] = {"hearth", BRICK},
    [FURNITURE] = {"furniture", WOOD},
    [CROCKERY] = {"crockery", PAINT},
};
static const struct {
    const char *name, *picture;
    double      colour[3];
} material_facts[MATERIAL_COUNT] = {
    [BRICK] = {"brick", "brick", {1, 1, 1}}, [TILES] = {"tiles", "tiles", {1, 1, 1}},
    [WOOD] = {"wood", "wood", {1, 1, 1}},    [STONE] = {"stone", "stone", {1, 1, 1}},
    [GRASS] = {"grass", "grass", {1, 1, 1}}, [GLASS] = {"glass", "glass", {1, 1, 1}},
    [PAINT] = {"paint", "paint", {1, 1, 1}}, [IRON] = {"iron", NULL, {0.05, 0.05, 0.06}},
};

void give_up(void)
{
    fputs("make_house: no memory, or too much of something\n", stderr);
    exit(EXIT_FAILURE);
}

static int compare_numbers(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

void sort_numbers(double *numbers, int count)
{
    qsort(numbers, (size_t)count, sizeof *numbers, compare_numbers);
}

/* --- faces ---------------------------------------------------------------------------------------------- */

int add_chart(house *h, double width, double height, double density)
{
    if (h->chart_count == CHARTS_MAX)
        give_up();
    h->charts[h->chart_count] = (chart){.width = width, .height = height, .density = density};
    return h->chart_count++;
}

void outline_chart(house *h, int index, const double (*points)[2], int count, double weight)
{
    chart *c = &h->charts[index];
    for (int i = 0; i < count; i++) {
        if (c->edge_count == EDGES_MAX)
            give_up();
        const double *a = points[i], *b = points[(i + 1) % count];
        memcpy(c->edges[c->edge_count++], (const double[5]){a[0], a[1], b[0], b[1], weight}, sizeof c->edges[0]);
    }
}

static uint32_t put_vertex(part_mesh *m, vertex v)
{
    if (m->vertex_count == m->space) {
        m->space = m->space ? 2 * m->space : 256;
        m->vertices = realloc(m->vertices, m->space * sizeof *m->vertices);
        if (!m->vertices)
            give_up();
    }
    m->vertices[m->vertex_count] = v;
    return m->vertex_count++;
}

static void put_index(part_mesh *m, uint32_t index)
{
    if (m->index_count == m->index_space) {
        m->index_space = m->index_space ? 2 * m->index_space : 512;
        m->indices = realloc(m->indices, m->index_space * sizeof *m->indices);
        if (!m->indices)
            give_up();
    }
    m->indices[m->index_count++] = index;
}

void put_polygon(house *h, const face *f, const double (*points)[2], int count)
{
    part_mesh *m = &h->parts[f->part];
    double     tile = metres_a_tile[part_facts[f->part].material];
    uint32_t   first = m->vertex_count;
    for (int i = 0; i < count; i++) {
        double u = points[i][0], v = points[i][1];
        vertex p = {
            .metres = {(f->turned ? v : u) / tile, (f->turned ? -u : v) / tile}, .unique = {u, v}, .chart = f->chart};
        for (int k = 0; k < 3; k++) {
            p.at[k] = f->at[k] + u * f->u[k] + v * f->v[k];
            p.normal[k] = f->u[(k + 1) % 3] * f->v[(k + 2) % 3] - f->u[(k + 2) % 3] * f->v[(k + 1) % 3];
        }
        put_vertex(m, p);
    }
    for (int i = 2; i < count; i++) {
        put_index(m, first);
        put_index(m, first + (uint32_t)i - 1);
        put_index(m, first + (uint32_t)i);
    }
}

void put_rectangle(house *h, const face *f, double left, double bottom, double right, double top)
{
    put_polygon(h, f, (const double[][2]){{left, bottom}, {right, bottom}, {right, top}, {left, top}}, 4);
}

static double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* A side of a box: its corner and its edges. */
static void put_side(house *h, int part, const double at[3], const double u[3], const double v[3])
{
    double width = length_of(u), height = length_of(v);
    face   f = {.part = part, .at = {at[0], at[1], at[2]}};
    for (int k = 0; k < 3; k++) {
        f.u[k] = u[k] / width;
        f.v[k] = v[k] / height;
    }
    f.chart = add_chart(h, width, height, part == GROUND ? 0.35 : part == PATH ? 0.5 : 1);
    double weight = width < 0.6 || height < 0.6 ? 0.4 : 1;
    outline_chart(h, f.chart, (const double[][2]){{0, 0}, {width, 0}, {width, height}, {0, height}}, 4,
                  part == GROUND ? 0 : weight);
    f.turned = part_facts[part].material == WOOD && width > 1.5 * height; /* boards lie along */
    put_rectangle(h, &f, 0, 0, width, height);
}

void slanted_box(house *h, int part, const double at[3], const double u[3], const double v[3], const double w[3])
{
    double far[3], minus_u[3], minus_w[3], from[3];
    for (int k = 0; k < 3; k++) {
        minus_u[k] = -u[k];
        minus_w[k] = -w[k];
        far[k] = at[k] + u[k] + w[k];
        from[k] = at[k] + w[k];
    }
    put_side(h, part, from, u, v);      /* front */
    put_side(h, part, far, minus_w, v); /* right */
    put_side(h, part, at, w, v);        /* left */
    for (int k = 0; k < 3; k++)
        from[k] = at[k] + u[k];
    put_side(h, part, from, minus_u, v); /* back */
    put_side(h, part, at, u, w);         /* bottom */
    for (int k = 0; k < 3; k++)
        from[k] = at[k] + v[k] + w[k];
    put_side(h, part, from, u, minus_w); /* top */
}

void box_at(house *h, int part, double left, double bottom, double back, double right, double top, double front)
{
    slanted_box(h, part, (const double[3]){left, bottom, back}, (const double[3]){right - left, 0, 0},
                (const double[3]){0, top - bottom, 0}, (const double[3]){0, 0, front - back});
}

/* --- tubes ---------------------------------------------------------------------------------------------- */

static vertex on_tube(const double at[3], direction along, double angle, double t, double radius, double lean)
{
    double s = sin(angle), c = cos(angle), slope = sqrt(1 + lean * lean);
    vertex p = {0};
    if (along == UP_DIRECTION)
        p = (vertex){.at = {at[0] + radius * s, at[1] + t, at[2] + radius * c},
                     .normal = {s / slope, lean / slope, c / slope}};
    else
        p = (vertex){.at = {at[0] + t, at[1] + radius * c, at[2] + radius * s},
                     .normal = {lean / slope, c / slope, s / slope}};
    return p;
}

static void tube_end(house *h, int part, const double at[3], direction along, double t, double radius, int segments,
                     bool far)
{
    part_mesh *m = &h->parts[part];
    double     tile = metres_a_tile[part_facts[part].material];
    int        index = add_chart(h, 2 * radius, 2 * radius, 0.4);
    uint32_t   first = m->vertex_count;
    for (int i = 0; i < segments; i++) {
        double angle = 2 * PI * i / segments;
        vertex p = on_tube(at, along, angle, t, radius, 0);
        double out[3] = {0};
        out[along == UP_DIRECTION ? 1 : 0] = far ? 1 : -1;
        memcpy(p.normal, out, sizeof out);
        p.chart = index;
        p.unique[0] = radius + radius * sin(angle);
        p.unique[1] = radius + radius * cos(angle);
        p.metres[0] = p.unique[0] / tile;
        p.metres[1] = p.unique[1] / tile;
        put_vertex(m, p);
    }
    for (int i = 2; i < segments; i++) {
        put_index(m, first);
        put_index(m, first + (uint32_t)(far ? i - 1 : i));
        put_index(m, first + (uint32_t)(far ? i : i - 1));
    }
}

void tube(house *h, int part, const double at[3], direction along, double length, double from_radius, double to_radius,
          int segments)
{
    enum { BANDS = 6 };
    part_mesh *m = &h->parts[part];
    double tile = metres_a_tile[part_facts[part].material], wide = fmax(from_radius, to_radius), around = 2 * PI * wide;
    double lean = (from_radius - to_radius) / length, slant = length * sqrt(1 + lean * lean);
    int    index = add_chart(h, around, slant, 1), bands = fabs(lean) > 0.02 ? BANDS : 1;
    double wraps = fmax(1, floor(around / tile + 0.5));
    double weight = slant < 0.6 || wide < 0.3 ? 0.4 : 1;
    outline_chart(h, index, (const double[][2]){{0, 0}, {around, 0}}, 2, weight);
    outline_chart(h, index, (const double[][2]){{0, slant}, {around, slant}}, 2, weight);
    for (int b = 0; b < bands; b++) {
        double   low = (double)b / bands, high = (double)(b + 1) / bands;
        uint32_t first = m->vertex_count;
        for (int i = 0; i <= segments; i++)
            for (int end = 0; end < 2; end++) {
                double fraction = end ? high : low, angle = 2 * PI * i / segments;
                vertex p = on_tube(at, along, angle, length * fraction,
                                   from_radius + (to_radius - from_radius) * fraction, lean);
                p.chart = index;
                p.unique[0] = around * i / segments;
                p.unique[1] = slant * fraction;
                p.metres[0] = wraps * i / segments;
                p.metres[1] = slant * fraction / tile;
                put_vertex(m, p);
            }
        for (uint32_t i = first; i < first + 2 * (uint32_t)segments; i += 2) {
            const uint32_t two[6] = {i, i + 2, i + 3, i, i + 3, i + 1};
            const uint32_t back[6] = {i, i + 3, i + 2, i, i + 1, i + 3};
            for (int k = 0; k < 6; k++)
                put_index(m, along == UP_DIRECTION ? two[k] : back[k]);
        }
    }
    tube_end(h, part, at, along, 0, from_radius, segments, false);
    tube_end(h, part, at, along, length, to_radius, segments, true);
}

/* --- the atlas ------------------------------------------------------------------------------------------ */

static const house *sorted_house;

static int taller(const void *a, const void *b)
{
    const int    i = *(const int *)a, j = *(const int *)b;
    const chart *c = &sorted_house->charts[i], *d = &sorted_house->charts[j];
    return c->down != d->down ? (c->down < d->down) - (c->down > d->down) : (i > j) - (i < j);
}

/* Charts in shelves, the tall ones first. */
static bool pack(house *h, double texels_per_metre)
{
    static int order[CHARTS_MAX];
    for (int i = 0; i < h->chart_count; i++) {
        chart *c = &h->charts[i];
        c->across = (int)ceil(c->width * c->density * texels_per_metre) + 1;
        c->down = (int)ceil(c->height * c->density * texels_per_metre) + 1;
        order[i] = i;
    }
    sorted_house = h;
    qsort(order, (size_t)h->chart_count, sizeof *order, taller);
    int x = 0, y = 0, shelf = 0;
    for (int i = 0; i < h->chart_count; i++) {
        chart *c = &h->charts[order[i]];
        if (x + c->across > ATLAS_SIDE) {
            y += shelf;
            x = shelf = 0;
        }
        if (c->across > ATLAS_SIDE || y + c->down > ATLAS_SIDE)
            return false;
        shelf = c->down > shelf ? c->down : shelf;
        c->x = x;
        c->y = y;
        x += c->across;
    }
    h->texels_per_metre = texels_per_metre;
    return true;
}

/* --- the file ------------------------------------------------------------------------------------------- */

typedef struct chunk {
    char  *bytes;
    size_t size;
    FILE  *stream;
} chunk;

static void put_float(FILE *file, double value)
{
    union {
        float    number;
        uint32_t bits;
    } word = {.number = (float)(floor(value * 1e5 + 0.5) / 1e5)};
    for (int k = 0; k < 4; k++)
        fputc((int)(word.bits >> (8 * k) & 255), file);
}

static void unique_of(const house *h, const vertex *v, double out[2])
{
    const chart *c = &h->charts[v->chart];
    for (int k = 0; k < 2; k++)
        out[k] = ((k ? c->y : c->x) + 0.5 + v->unique[k] * c->density * h->texels_per_metre) / ATLAS_SIDE;
}

static void put_accessor(FILE *json, int *count, size_t offset, size_t size, uint32_t values, const char *type,
                         chunk *views, const double *bounds)
{
    fprintf(views->stream, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu,\"target\":%d}", *count ? "," : "",
            offset, size, strcmp(type, "SCALAR") == 0 ? 34963 : 34962);
    fprintf(json, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"", *count ? "," : "", *count,
            strcmp(type, "SCALAR") == 0 ? 5123 : 5126, values, type);
    if (bounds)
        fprintf(json, ",\"min\":[%.6g,%.6g,%.6g],\"max\":[%.6g,%.6g,%.6g]", bounds[0], bounds[1], bounds[2], bounds[3],
                bounds[4], bounds[5]);
    fprintf(json, "}");
    ++*count;
}

/* Positions, normals, both sets of texture coordinates, indices. */
static void put_part(const house *h, const part_mesh *m, chunk *bytes, chunk *views, FILE *accessors, int *count)
{
    double bounds[6] = {1e9, 1e9, 1e9, -1e9, -1e9, -1e9};
    for (int set = 0; set < 4; set++) {
        size_t from = (size_t)ftell(bytes->stream);
        for (uint32_t i = 0; i < m->vertex_count; i++) {
            const vertex *v = &m->vertices[i];
            double        two[2];
            unique_of(h, v, two);
            const double *values = set == 0 ? v->at : set == 1 ? v->normal : set == 2 ? v->metres : two;
            for (int k = 0; k < (set < 2 ? 3 : 2); k++) {
                put_float(bytes->stream, set == 2 && k == 1 ? -values[k] : values[k]);
                if (set == 0) {
                    float rounded = (float)(floor(values[k] * 1e5 + 0.5) / 1e5);
                    bounds[k] = fmin(bounds[k], (double)rounded);
                    bounds[3 + k] = fmax(bounds[3 + k], (double)rounded);
                }
            }
        }
        put_accessor(accessors, count, from, (size_t)ftell(bytes->stream) - from, m->vertex_count,
                     set < 2 ? "VEC3" : "VEC2", views, set ? NULL : bounds);
    }
    size_t from = (size_t)ftell(bytes->stream);
    for (uint32_t i = 0; i < m->index_count; i++) {
        fputc((int)(m->indices[i] & 255), bytes->stream);
        fputc((int)(m->indices[i] >> 8), bytes->stream);
    }
    put_accessor(accessors, count, from, (size_t)ftell(bytes->stream) - from, m->index_count, "SCALAR", views, NULL);
    while (ftell(bytes->stream) % 4)
        fputc(0, bytes->stream);
}

static void put_materials(FILE *json, const char *folder)
{
    fputs("\"materials\":[", json);
    for (int i = 0, pictures = 0; i < MATERIAL_COUNT; i++) {
        const double *c = material_facts[i].colour;
        fprintf(json,
                "%s{\"name\":\"%s\",\"pbrMetallicRoughness\":{\"baseColorFactor\":[%g,%g,%g,1],\"metallicFactor\":0,"
                "\"roughnessFactor\":0.8",
                i ? "," : "", material_facts[i].name, c[0], c[1], c[2]);
        if (material_facts[i].picture)
            fprintf(json, ",\"baseColorTexture\":{\"index\":%d}", pictures++);
        fputs("}}", json);
    }
    fputs("],\"images\":[", json);
    int count = 0;
    for (int i = 0; i < MATERIAL_COUNT; i++)
        if (material_facts[i].picture)
            fprintf(json, "%s{\"uri\":\"%s/%s.png\"}", count++ ? "," : "", folder, material_facts[i].picture);
    fputs("],\"textures\":[", json);
    for (int i = 0; i < count; i++)
        fprintf(json, "%s{\"source\":%d}", i ? "," : "", i);
    fputs("],", json);
}

static void put_nodes(FILE *json)
{
    fputs("\"nodes\":[{\"name\":\"House\",\"children\":[", json);
    for (int i = 0; i < PART_COUNT; i++)
        fprintf(json, "%s%d", i ? "," : "", i + 1);
    fputs("]}", json);
    for (int i = 0; i < PART_COUNT; i++)
        fprintf(json, ",{\"name\":\"%s\",\"mesh\":%d}", part_facts[i].name, i);
    fputs("],\"meshes\":[", json);
    for (int i = 0; i < PART_COUNT; i++)
        fprintf(json,
                "%s{\"primitives\":[{\"attributes\":{\"POSITION\":%d,\"NORMAL\":%d,\"TEXCOORD_0\":%d,\"TEXCOORD_1\":%d}"
                ",\"indices\":%d,\"material\":%d}]}",
                i ? "," : "", 5 * i, 5 * i + 1, 5 * i + 2, 5 * i + 3, 5 * i + 4, part_facts[i].material);
    fputs("],", json);
}

bool house_write(house *h, const char *path, const char *folder)
{
    double density = 40;
    while (!pack(h, density))
        density -= 0.25;
    const char *slash = strrchr(folder, '/');
    chunk chunks[4] = {{0}}, *json = &chunks[0], *bytes = &chunks[1], *views = &chunks[2], *accessors = &chunks[3];
    int   count = 0;
    for (int k = 0; k < 4; k++)
        if (!(chunks[k].stream = open_memstream(&chunks[k].bytes, &chunks[k].size)))
            give_up();
    for (int i = 0; i < PART_COUNT; i++)
        put_part(h, &h->parts[i], bytes, views, accessors->stream, &count);
    for (int k = 1; k < 4; k++)
        fclose(chunks[k].stream);
    fputs("{\"asset\":{\"version\":\"2.0\",\"generator\":\"Limner "
          "make_house\",\"copyright\":\"CC0-1.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],",
          json->stream);
    put_nodes(json->stream);
    put_materials(json->stream, slash ? slash + 1 : folder);
    fprintf(json->stream, "\"accessors\":[%s],\"bufferViews\":[%s],\"buffers\":[{\"byteLength\":%zu}]}",
            accessors->bytes, views->bytes, bytes->size);
    fclose(json->stream);
    bool saved = glb_write(path, json->bytes, json->size, bytes->bytes, bytes->size) && paint_materials(folder) &&
                 paint_indication(h, folder);
    for (int k = 0; k < 4; k++)
        free(chunks[k].bytes);
    for (int i = 0; i < PART_COUNT; i++) {
        free(h->parts[i].vertices);
        free(h->parts[i].indices);
    }
    return saved;
}
