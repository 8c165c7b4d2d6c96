/* What the house's materials look like: a picture and strokes for each, and where strokes are wanted. */
#include "house.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double metres_a_tile[MATERIAL_COUNT] = {
    [BRICK] = 1.6, [TILES] = 1.5, [WOOD] = 1.5, [STONE] = 2, [GRASS] = 2.4, [GLASS] = 1, [PAINT] = 1, [IRON] = 1,
};

static uint32_t seed;

static double chance(void)
{
    seed = seed * 1664525u + 1013904223u;
    return (seed >> 8) / 16777216.0;
}

static double about(double middle, double spread)
{
    return middle + (2 * chance() - 1) * spread;
}

/* A number from 0 to 1 for a cell. */
static double hash(int x, int y)
{
    uint32_t h = (uint32_t)x * 374761393u + (uint32_t)y * 668265263u;
    h = (h ^ (h >> 13)) * 1274126177u;
    return ((h ^ (h >> 16)) & 0xffff) / 65535.0;
}

/* Smooth noise that repeats after `period` cells. */
static double noise(double x, double y, int period)
{
    int    i = (int)floor(x), k = (int)floor(y);
    double fx = x - i, fy = y - k, value = 0;
    fx = fx * fx * (3 - 2 * fx);
    fy = fy * fy * (3 - 2 * fy);
    for (int a = 0; a < 2; a++)
        for (int b = 0; b < 2; b++)
            value += (a ? fx : 1 - fx) * (b ? fy : 1 - fy) * hash((i + a + period) % period, (k + b + period) % period);
    return value;
}

/* --- strokes -------------------------------------------------------------------------------------------- */

/* y grows upwards. `together`: strokes of one thing come and go one after the other. */
typedef struct mark {
    double at[4];
    int    layer, index;
    double order;
} mark;

enum { MARKS_MAX = 4096 };
static mark marks[MARKS_MAX];
static int  mark_count;

static void draw(int layer, double together, double x0, double y0, double x1, double y1)
{
    if (mark_count == MARKS_MAX)
        give_up();
    marks[mark_count] = (mark){{x0, y0, x1, y1}, layer, mark_count, together};
    mark_count++;
}

/* Parallel strokes within a box; `turn` in degrees. `together` below 0: each comes and goes by itself. */
static void hatch(int layer, double together, double left, double bottom, double right, double top, double turn,
                  double distance)
{
    double c = cos(turn * PI / 180), s = sin(turn * PI / 180), x = (left + right) / 2, y = (bottom + top) / 2;
    double half_x = (right - left) / 2, half_y = (top - bottom) / 2, reach = half_x * fabs(s) + half_y * fabs(c);
    for (double d = -reach + distance * chance(); d < reach; d += distance * about(1, 0.2)) {
        double from = -9, to = 9;
        for (int k = 0; k < 2; k++) { /* clip the line at d to the box */
            double direction = k ? s : c, off = k ? d * c : -d * s, half = k ? half_y : half_x;
            if (fabs(direction) < 1e-9)
                continue;
            from = fmax(from, fmin((-half - off) / direction, (half - off) / direction));
            to = fmin(to, fmax((-half - off) / direction, (half - off) / direction));
        }
        if (to - from < distance * 0.7)
            continue;
        from += about(0.06, 0.06) * (to - from);
        to -= about(0.06, 0.06) * (to - from);
        draw(layer, together < 0 ? chance() : together, x + from * c - d * s, y + from * s + d * c, x + to * c - d * s,
             y + to * s + d * c);
    }
}

static void draw_brick(void)
{
    enum { COURSES = 10, BRICKS = 4 };
    const double high = 1.0 / COURSES, wide = 1.0 / BRICKS;
    for (int k = 0; k < COURSES; k++)
        for (int i = 0; i < BRICKS; i++) {
            double left = (i + 0.5 * (k & 1)) * wide, bottom = k * high, own = hash(i + 7, k), shade = hash(i, k + 31);
            draw(0, own, left + about(0.012, 0.01), bottom + about(0, 0.006), left + wide - about(0.012, 0.01),
                 bottom + about(0, 0.006));
            draw(0, own + 0.1, left + about(0, 0.005), bottom + 0.012, left + about(0, 0.005), bottom + high - 0.014);
            if (shade < 0.24)
                hatch(1, shade, left + 0.02, bottom + 0.018, left + wide - 0.02, bottom + high - 0.018, 55, 0.022);
            hatch(2, own, left + 0.015, bottom + 0.014, left + wide - 0.015, bottom + high - 0.014, 38, 0.03);
            hatch(3, shade, left + 0.01, bottom + 0.01, left + wide - 0.01, bottom + high - 0.01, -32, 0.034);
        }
}

static void draw_tiles(void)
{
    enum { ROWS = 6, ACROSS = 6, CHORDS = 4 };
    const double high = 1.0 / ROWS, wide = 1.0 / ACROSS;
    for (int k = 0; k < ROWS; k++)
        for (int i = 0; i < ACROSS; i++) {
            double left = (i + 0.5 * (k & 1)) * wide + about(0, 0.006), bottom = k * high + about(0, 0.008),
                   own = hash(i + 3, k + 11), before[2] = {0};
            for (int c = 0; c <= CHORDS; c++) { /* its rounded lower edge */
                double t = (double)c / CHORDS, x = left + t * wide,
                       y = bottom + high * 0.42 * pow(fabs(2 * t - 1), 2.4);
                if (c)
                    draw(0, own, before[0], before[1], x, y);
                before[0] = x, before[1] = y;
            }
            draw(1, own, left + about(0, 0.004), bottom + high * 0.45, left + about(0, 0.004), bottom + high * 0.95);
            for (int j = 1; j < 6; j++) { /* the shade of the tile above */
                double x = left + wide * (j + about(0, 0.3)) / 6,
                       top = bottom + high * (0.96 + 0.3 * fabs(j - 3.0) / 3);
                draw(2, own, x, top, x + about(0, 0.004), top - high * about(0.34, 0.1));
            }
            hatch(3, hash(i, k), left + 0.01, bottom + high * 0.15, left + wide - 0.01, bottom + high, 62, 0.03);
        }
}

static void draw_wood(void)
{
    enum { PLANKS = 6, PIECES = 5 };
    const double wide = 1.0 / PLANKS;
    for (int i = 0; i < PLANKS; i++) {
        for (int k = 0; k < PIECES; k++) {
            double y = (k + hash(i, 91)) / PIECES, x = i * wide;
            draw(0, hash(i, k), x + about(0, 0.004), y, x + about(0, 0.004), y + 1.0 / PIECES - 0.01);
            for (int j = 1; j < 4; j++) {
                double g = x + wide * (j + about(0, 0.25)) / 4, from = about(k, 0.5) / PIECES;
                draw(1, hash(i + 5, k + 17 * j), g, from, g + about(0, 0.01), from + about(0.13, 0.05));
            }
        }
        double x = (i + about(0.5, 0.15)) * wide, y = chance(); /* a knot */
        for (int c = 0; c < 6; c++)
            draw(1, 0.1, x + 0.022 * cos(c * PI / 3), y + 0.035 * sin(c * PI / 3), x + 0.022 * cos((c + 1) * PI / 3),
                 y + 0.035 * sin((c + 1) * PI / 3));
        hatch(2, 0.5 * hash(i, 3), i * wide + 0.012, 0, i * wide + wide - 0.012, 0.5, 28, 0.034);
        hatch(2, 0.5 + 0.5 * hash(i, 4), i * wide + 0.012, 0.5, i * wide + wide - 0.012, 1, 28, 0.034);
        hatch(3, hash(i, 8), i * wide, 0, i * wide + wide, 0.5, 90, 0.033);
        hatch(3, hash(i, 9), i * wide, 0.5, i * wide + wide, 1, 90, 0.033);
    }
}

static const double courses[] = {0, 0.17, 0.31, 0.5, 0.64, 0.83, 1};

static int stone_ends(int course, double ends[8])
{
    int count = 4 + course % 2;
    for (int i = 0; i <= count; i++)
        ends[i] = (i + 0.4 * hash(i % count, course) + 0.37 * course) / count;
    return count;
}

static void draw_stone(void)
{
    for (int k = 0; k < 6; k++) {
        double ends[8];
        int    count = stone_ends(k, ends);
        for (int i = 0; i < count; i++) {
            double l = ends[i] + 0.012, r = ends[i + 1] - 0.012, b = courses[k] + 0.01, t = courses[k + 1] - 0.01,
                   own = hash(i + 40, k), cut = 0.02;
            draw(0, own, l + cut, b, (l + r) / 2, b + about(0, 0.006));
            draw(0, own, (l + r) / 2, b + about(0, 0.006), r - cut, b + 0.004);
            draw(0, own, r, b + cut, r + about(0, 0.008), t - cut);
            draw(1, own, l, t - cut, l + about(0, 0.006), b + cut);
            draw(1, own, r - cut, t, l + cut, t + about(0, 0.006));
            for (int j = 0; j < 4; j++) {
                double x = about((l + r) / 2, (r - l) * 0.35), y = about((b + t) / 2, (t - b) * 0.35);
                draw(1, own, x, y, x + about(0, 0.015), y - about(0.012, 0.006));
            }
            if (own < 0.35)
                hatch(2, own, l, b, r, t, 50, 0.026);
            hatch(3, own, l, b, r, t, 35, 0.03);
            hatch(4, hash(i, k + 50), l, b, r, t, -40, 0.032);
        }
    }
}

static void draw_grass(void)
{
    for (int k = 0; k < 34; k++) { /* tufts, evenly enough */
        double x = fmod(k * 0.618034, 1) + about(0, 0.03), y = (k + 0.5) / 34, own = hash(k, 77), size = about(1, 0.3);
        for (int j = -2; j <= 2; j++)
            draw(0, own, x + 0.007 * j, y + 0.004 * j * j, x + size * (0.02 * j + about(0, 0.006)),
                 y + size * (about(0.11, 0.02) - 0.008 * j * j));
    }
    for (int k = 0; k < 150; k++) {
        double x = fmod(k * 0.754878, 1), y = fmod(k * 0.569840, 1);
        draw(1, hash(k, 5), x, y, x + about(0.01, 0.014), y + about(0.08, 0.02));
    }
    for (int k = 0; k < 330; k++) {
        double x = fmod(k * 0.754878 + 0.3, 1), y = fmod(k * 0.569840 + 0.6, 1);
        draw(2 + k % 2, hash(k, 6), x, y, x + about(0.02, 0.02), y + about(0.09, 0.03));
    }
}

static void draw_glass(void)
{
    for (int layer = 0; layer < 3; layer++)
        for (int k = 0; k < 16; k++)
            hatch(layer, -1, k % 4 * 0.25 - 0.02, k / 4 * 0.25 - 0.02, k % 4 * 0.25 + 0.27, k / 4 * 0.25 + 0.27,
                  layer == 0   ? 60
                  : layer == 1 ? 52
                               : -35,
                  0.04);
}

static void draw_paint(void)
{
    for (int layer = 0; layer < 3; layer++)
        for (int k = 0; k < 16; k++)
            hatch(layer, -1, k % 4 * 0.25 - 0.02, k / 4 * 0.25 - 0.02, k % 4 * 0.25 + 0.27, k / 4 * 0.25 + 0.27,
                  layer == 0   ? 45
                  : layer == 1 ? -45
                               : 0,
                  0.05);
}

static int first_of(const void *a, const void *b)
{
    const mark *m = a, *n = b;
    int         order = m->layer != n->layer ? m->layer - n->layer : (m->order > n->order) - (m->order < n->order);
    return order ? order : m->index - n->index;
}

/* Layers follow each other, in light as in the distance: joints stay longest. Chords of a curve keep their order in
 * the list. */
static bool write_strokes(const char *folder, const char *name)
{
    FILE *file = NULL;
    if (!file_of(folder, name, ".stx", &file))
        return false;
    qsort(marks, (size_t)mark_count, sizeof *marks, first_of);
    fprintf(file, "# Limner make_house: u0 v0 u1 v1 light perspective layer\n");
    double stays = 1;
    for (int i = 0; i < mark_count; i++) {
        const double *m = marks[i].at, *before = i ? marks[i - 1].at : NULL;
        if (!before || m[0] != before[2] || m[1] != before[3])
            stays = 1 - (i + 0.5) / mark_count;
        double u = floor(m[0]), v = floor(m[1]);
        fprintf(file, "%.4f %.4f %.4f %.4f %.4f %.4f %d\n", m[0] - u, m[1] - v, m[2] - u, m[3] - v, stays, stays,
                marks[i].layer);
    }
    return fclose(file) == 0;
}

/* --- pictures ------------------------------------------------------------------------------------------- */

/* Greys, of which a palette makes colours. x and y from 0 to 1, y upwards. */
static double brick_at(double x, double y)
{
    int    k = (int)(y * 10), i = (int)floor(x * 4 - 0.5 * (k & 1) + 4) % 4;
    double u = x * 4 - 0.5 * (k & 1) - floor(x * 4 - 0.5 * (k & 1)), v = y * 10 - k;
    if (u < 0.03 || u > 0.97 || v < 0.09 || v > 0.93)
        return 0.9 + 0.1 * noise(x * 64, y * 64, 64);
    return 0.25 + 0.3 * hash(i, k + 31) + 0.22 * noise(x * 48, y * 48, 48);
}

static double tiles_at(double x, double y)
{
    double v = y * 6, u = x * 6;
    int    k = (int)v;
    for (int row = k; row >= k - 1; row--) { /* a tile hangs over the one below */
        double along = u - 0.5 * (row & 1) + 6, t = along - floor(along), low = row + 0.42 * pow(fabs(2 * t - 1), 2.4);
        if (v >= low && v < low + 1)
            return 0.22 + 0.35 * hash((int)along % 6, (row + 6) % 6) + 0.12 * noise(x * 48, y * 48, 48) +
                   (v - low < 0.07 ? -0.15 : 0) - 0.2 * fmax(0, v - low - 0.7);
    }
    return 0.3;
}

static double wood_at(double x, double y)
{
    int    plank = (int)(x * 6);
    double u = x * 6 - plank;
    if (u < 0.05)
        return 0.05;
    return 0.35 + 0.2 * hash(plank, 2) + 0.22 * noise(x * 64, y * 8, 64) +
           0.1 * sin(40 * u + 5 * noise(x * 8, y * 8, 8));
}

static double stone_at(double x, double y)
{
    int k = 0;
    while (y >= courses[k + 1])
        k++;
    double ends[8], edge = fmin(y - courses[k], courses[k + 1] - y);
    int    count = stone_ends(k, ends), own = 0;
    for (int i = 0; i <= count; i++)
        for (int wrap = -1; wrap <= 1; wrap++) {
            edge = fmin(edge, fabs(x - ends[i] + wrap));
            own = x >= ends[i] + wrap && x < ends[(i + 1)] + wrap && i < count ? i : own;
        }
    return edge < 0.012 ? 0.25 : 0.5 + 0.25 * hash(own, k) + 0.2 * noise(x * 32, y * 32, 32);
}

static double grass_at(double x, double y)
{
    return 0.3 + 0.3 * noise(x * 64, y * 16, 64) + 0.25 * noise(x * 8, y * 8, 8);
}

static double glass_at(double x, double y)
{
    return 0.15 + 0.25 * noise(x * 4, y * 4, 4);
}

static double paint_at(double x, double y)
{
    return 0.8 + 0.15 * noise(x * 32, y * 8, 32);
}

/* --- PNG files: eight bits a pixel, not compressed ------------------------------------------------------ */

static uint32_t crc_of(const unsigned char *bytes, size_t size)
{
    uint32_t crc = 0xffffffffu;
    for (size_t i = 0; i < size; i++) {
        crc ^= bytes[i];
        for (int k = 0; k < 8; k++)
            crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0);
    }
    return ~crc;
}

static unsigned char *put_big(unsigned char *to, uint32_t word)
{
    for (int k = 0; k < 4; k++)
        to[k] = (unsigned char)(word >> (24 - 8 * k));
    return to + 4;
}

static void put_chunk(FILE *file, const char *name, const unsigned char *bytes, size_t size)
{
    unsigned char *whole = malloc(size + 4), word[4];
    if (!whole)
        give_up();
    memcpy(whole, name, 4);
    if (size)
        memcpy(whole + 4, bytes, size);
    put_big(word, (uint32_t)size);
    fwrite(word, 1, 4, file);
    fwrite(whole, 1, size + 4, file);
    put_big(word, crc_of(whole, size + 4));
    fwrite(word, 1, 4, file);
    free(whole);
}

/* `palette`: 256 colours, or NULL for greys. */
static bool write_png(FILE *file, const unsigned char *pixels, int side, const unsigned char *palette)
{
    size_t        row = (size_t)side + 1, total = row * (size_t)side;
    unsigned char head[13] = {0}, *data = malloc(total + 16 + 5 * (size_t)side), *to = data;
    if (!data)
        give_up();
    put_big(put_big(head, (uint32_t)side), (uint32_t)side);
    head[8] = 8;
    head[9] = palette ? 3 : 0;
    *to++ = 0x78, *to++ = 0x01;
    uint32_t a = 1, b = 0;
    for (int y = 0; y < side; y++) { /* a block a row, each with the filter 0 */
        const unsigned char block[6] = {
            y == side - 1, row & 255, (unsigned char)(row >> 8), ~row & 255, (unsigned char)(~row >> 8), 0};
        memcpy(to, block, 6);
        memcpy(to + 6, pixels + (size_t)y * (size_t)side, (size_t)side);
        for (size_t i = 5; i < 5 + row; i++) {
            a = (a + to[i]) % 65521;
            b = (b + a) % 65521;
        }
        to += 5 + row;
    }
    to = put_big(to, b << 16 | a);
    fwrite("\x89PNG\r\n\x1a\n", 1, 8, file);
    put_chunk(file, "IHDR", head, sizeof head);
    if (palette)
        put_chunk(file, "PLTE", palette, 768);
    put_chunk(file, "IDAT", data, (size_t)(to - data));
    put_chunk(file, "IEND", NULL, 0);
    free(data);
    return fclose(file) == 0;
}

bool file_of(const char *folder, const char *name, const char *ending, FILE **out)
{
    char path[1024];
    int  size = snprintf(path, sizeof path, "%s/%s%s", folder, name, ending);
    *out = size > 0 && size < (int)sizeof path ? fopen(path, "wb") : NULL;
    return *out;
}

static const struct {
    const char *name;
    double (*at)(double x, double y);
    void (*strokes)(void);
    double colours[3][3]; /* of grey 0, ½ and 1, sRGB */
} paintings[] = {
    [BRICK] = {"brick", brick_at, draw_brick, {{84, 34, 24}, {176, 92, 66}, {214, 204, 188}}},
    [TILES] = {"tiles", tiles_at, draw_tiles, {{66, 30, 24}, {168, 84, 58}, {222, 150, 112}}},
    [WOOD] = {"wood", wood_at, draw_wood, {{48, 32, 20}, {136, 100, 66}, {206, 172, 130}}},
    [STONE] = {"stone", stone_at, draw_stone, {{58, 56, 52}, {158, 152, 138}, {226, 220, 204}}},
    [GRASS] = {"grass", grass_at, draw_grass, {{50, 66, 28}, {112, 134, 60}, {182, 190, 106}}},
    [GLASS] = {"glass", glass_at, draw_glass, {{20, 26, 34}, {64, 84, 102}, {190, 208, 220}}},
    [PAINT] = {"paint", paint_at, draw_paint, {{60, 60, 56}, {170, 168, 160}, {244, 242, 234}}},
};

static void make_palette(unsigned char *out, const double colours[3][3])
{
    for (int i = 0; i < 256; i++)
        for (int k = 0; k < 3; k++) {
            double t = i / 127.5, value = t < 1 ? colours[0][k] + t * (colours[1][k] - colours[0][k])
                                                : colours[1][k] + (t - 1) * (colours[2][k] - colours[1][k]);
            out[3 * i + k] = (unsigned char)floor(value + 0.5);
        }
}

bool paint_materials(const char *folder)
{
    enum { SIDE = 192 };
    static unsigned char pixels[SIDE * SIDE], palette[768];
    for (int i = 0; i < (int)(sizeof paintings / sizeof *paintings); i++) {
        for (int y = 0; y < SIDE; y++)
            for (int x = 0; x < SIDE; x++)
                pixels[y * SIDE + x] = (unsigned char)floor(
                    255 * fmin(1, fmax(0, paintings[i].at((x + 0.5) / SIDE, 1 - (y + 0.5) / SIDE))) + 0.5);
        make_palette(palette, paintings[i].colours);
        FILE *file = NULL;
        mark_count = 0;
        seed = (uint32_t)(7 + i);
        paintings[i].strokes();
        if (!file_of(folder, paintings[i].name, ".png", &file) || !write_png(file, pixels, SIDE, palette) ||
            !write_strokes(folder, paintings[i].name))
            return false;
    }
    return true;
}

/* --- the indication ------------------------------------------------------------------------------------- */

static double distance_to(const double edge[5], double x, double y)
{
    double u = edge[2] - edge[0], v = edge[3] - edge[1], t = ((x - edge[0]) * u + (y - edge[1]) * v) / (u * u + v * v);
    t = fmin(1, fmax(0, t));
    return hypot(x - edge[0] - t * u, y - edge[1] - t * v);
}

/* Dark along edges, by a width that varies, and here and there a patch amid a wall; light elsewhere. */
static double indication_at(const chart *c, double x, double y, int own)
{
    double wanted = 0, patch = noise(x * 1.1 + own * 3.7 + 40, y * 1.3 + own * 1.9 + 40, 4096),
           ragged = 0.55 + 0.9 * noise(x * 2.3 + 11 * own, y * 2.3 + 70, 4096);
    for (int i = 0; i < c->edge_count; i++)
        wanted = fmax(wanted,
                      c->edges[i][4] *
                          (c->edges[i][4] > 0 ? exp(-pow(distance_to(c->edges[i], x, y) / (0.38 * ragged), 1.5)) : 0));
    wanted = fmax(wanted, 0.75 * fmin(1, fmax(0, (patch - 0.66) / 0.14)));
    return 0.84 - 0.56 * wanted;
}

bool paint_indication(const house *h, const char *folder)
{
    static unsigned char pixels[ATLAS_SIDE * ATLAS_SIDE];
    memset(pixels, 128, sizeof pixels);
    for (int i = 0; i < h->chart_count; i++) {
        const chart *c = &h->charts[i];
        bool         big = c->width > 0.6 && c->height > 0.6;
        for (int y = 0; y < c->down; y++)
            for (int x = 0; x < c->across; x++) {
                double scale = 1 / (c->density * h->texels_per_metre),
                       wanted = big ? indication_at(c, x * scale, y * scale, i) : 0.5;
                pixels[(c->y + y) * ATLAS_SIDE + c->x + x] = (unsigned char)floor(255 * wanted + 0.5);
            }
    }
    FILE *file = NULL;
    return file_of(folder, "indication", ".png", &file) && write_png(file, pixels, ATLAS_SIDE, NULL);
}
