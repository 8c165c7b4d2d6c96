/* What marks lie on has a brightness of its own at each place, not at the corners of its triangles alone: a wall of two
 * triangles may have a picture of a house on it. */
#include <math.h>
#include <string.h>

#include "base/colour.h"
#include "base/memory.h"
#include "stage/mark_brightness.h"

static const double WHOLE = 65535;
/* Whoever draws leaves out most of the grey that a thing has all over, and keeps what differs on it. */
static const double PLAIN = 0.5;

static double luminance(double r, double g, double b)
{
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
}

void mark_brightness_release(mark_brightness *b)
{
    for (size_t i = 0; b->pictures && i < b->picture_count; i++)
        for (int k = 0; k < BRIGHTNESS_LEVELS; k++)
            mem_free(b->pictures[i].levels[k]);
    mem_free(b->pictures);
    memset(b, 0, sizeof *b);
}

/* --- pictures ------------------------------------------------------------------------------------------- */

static bool read_picture(brightness_picture *p, const image *i)
{
    double linear[256];
    size_t count = (size_t)i->width * i->height;
    for (int k = 0; k < 256; k++)
        linear[k] = (double)colour_to_linear((float)k / 255);
    p->levels[0] = mem_alloc(count * sizeof *p->levels[0]);
    if (!p->levels[0])
        return false;
    p->widths[0] = i->width;
    p->heights[0] = i->height;
    p->count = 1;
    for (size_t k = 0; k < count; k++) {
        const uint8_t *rgba = &i->pixels[4 * k];
        p->levels[0][k] = (uint16_t)lrint(WHOLE * luminance(linear[rgba[0]], linear[rgba[1]], linear[rgba[2]]));
    }
    return true;
}

/* Half as large, each texel the mean of those below it; of odd sides the last one is left out. */
static bool add_half(brightness_picture *p)
{
    int             last = p->count - 1;
    uint32_t        before = p->widths[last], w = before > 1 ? before / 2 : 1, h = p->heights[last];
    uint32_t        across = before > 1 ? 1 : 0, down = h > 1 ? before : 0;
    const uint16_t *from = p->levels[last];
    h = h > 1 ? h / 2 : 1;
    uint16_t *to = mem_alloc((size_t)w * h * sizeof *to);
    if (!to)
        return false;
    for (uint32_t y = 0; y < h; y++)
        for (uint32_t x = 0; x < w; x++) {
            const uint16_t *t = &from[(size_t)y * 2 * down + (size_t)x * 2 * across];
            to[(size_t)y * w + x] =
                (uint16_t)(((uint32_t)t[0] + t[across] + t[down] + t[(size_t)down + across] + 2) / 4);
        }
    p->levels[p->count] = to;
    p->widths[p->count] = w;
    p->heights[p->count++] = h;
    return true;
}

static const texture_use *picture_of(const mark_ground *g, uint32_t triangle)
{
    int32_t m = g->pictured[triangle];
    return m >= 0 && g->scene->materials[m].base_texture.image >= 0 ? &g->scene->materials[m].base_texture : NULL;
}

lmn_status mark_brightness_make(mark_brightness *out, const mark_ground *g, lmn_error *error)
{
    *out = (mark_brightness){.ground = g, .picture_count = g->scene ? g->scene->image_count : 0};
    out->pictures = mem_calloc(out->picture_count + 1, sizeof *out->pictures);
    bool done = out->pictures != NULL;
    for (uint32_t t = 0; t < g->surface.triangle_count && done; t++) {
        const texture_use  *use = picture_of(g, t);
        const image        *i = use ? &g->scene->images[use->image] : NULL;
        brightness_picture *p = use ? &out->pictures[use->image] : NULL;
        if (!i || !i->pixels || !i->width || !i->height || p->count)
            continue;
        done = read_picture(p, i);
        while (done && p->count < BRIGHTNESS_LEVELS && (p->widths[p->count - 1] > 1 || p->heights[p->count - 1] > 1))
            done = add_half(p);
    }
    return done ? LMN_OK : error_memory(error);
}

static uint32_t wrapped(double at, uint32_t size, wrap_mode mode)
{
    double whole = (double)size;
    if (mode == WRAP_CLAMP)
        return (uint32_t)fmin(fmax(at, 0), whole - 1);
    double in = mode == WRAP_MIRROR ? fmod(at, 2 * whole) : fmod(at, whole);
    in += in < 0 ? (mode == WRAP_MIRROR ? 2 * whole : whole) : 0;
    if (in >= whole)
        in = mode == WRAP_MIRROR ? 2 * whole - 1 - in : 0;
    return (uint32_t)fmin(fmax(in, 0), whole - 1);
}

/* At a level, between its texels. */
static double texel_at(const brightness_picture *p, int level, const texture_use *use, double u, double v)
{
    uint32_t        w = p->widths[level], h = p->heights[level];
    const uint16_t *texels = p->levels[level];
    double          x = u * w - 0.5, y = v * h - 0.5, left = floor(x), top = floor(y), sum = 0;
    for (int k = 0; k < 4; k++) {
        double   part = ((k & 1) ? x - left : left + 1 - x) * ((k & 2) ? y - top : top + 1 - y);
        uint32_t column = wrapped(left + (k & 1), w, use->wrap_u), row = wrapped(top + (k >> 1), h, use->wrap_v);
        sum += part * texels[(size_t)row * w + column];
    }
    return sum / WHOLE;
}

/* --- places --------------------------------------------------------------------------------------------- */

typedef struct place_on_triangle {
    double part[3]; /* of its corners */
    double area;
} place_on_triangle;

static void from_to(const vec3 *a, const vec3 *b, double out[3])
{
    out[0] = (double)b->x - (double)a->x;
    out[1] = (double)b->y - (double)a->y;
    out[2] = (double)b->z - (double)a->z;
}

static double product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* The place of a triangle that is next to a position, about: no corner counts for less than nothing. */
static place_on_triangle find_place(const vec3 *corners[3], vec3 at)
{
    double u[3], v[3], to[3];
    from_to(corners[0], corners[1], u);
    from_to(corners[0], corners[2], v);
    from_to(corners[0], &at, to);
    double            uu = product(u, u), uv = product(u, v), vv = product(v, v), whole = uu * vv - uv * uv;
    double            ut = product(u, to), vt = product(v, to);
    double            b = whole > 0 ? (vv * ut - uv * vt) / whole : 0, c = whole > 0 ? (uu * vt - uv * ut) / whole : 0;
    place_on_triangle p = {.part = {fmax(1 - b - c, 0), fmax(b, 0), fmax(c, 0)}, .area = 0.5 * sqrt(fmax(whole, 0))};
    double            sum = p.part[0] + p.part[1] + p.part[2];
    for (int k = 0; k < 3; k++)
        p.part[k] = whole > 0 ? p.part[k] / sum : 1.0 / 3;
    return p;
}

/* Of the picture, where so much of the triangle is around it. */
static double picture_at(const mark_brightness *b, const texture_use *use, const vec2 *uvs[3],
                         const place_on_triangle *place, double around)
{
    const brightness_picture *p = &b->pictures[use->image];
    double c = cos((double)use->rotation), s = sin((double)use->rotation), sx = (double)use->scale[0],
           sy = (double)use->scale[1], u = 0, v = 0;
    if (!p->count)
        return 1;
    for (int k = 0; k < 3; k++) {
        u += place->part[k] * (double)uvs[k]->x;
        v += place->part[k] * (double)uvs[k]->y;
    }
    double x = c * sx * u + s * sy * v + (double)use->offset[0], y = c * sy * v - s * sx * u + (double)use->offset[1];
    double ux = (double)uvs[1]->x - (double)uvs[0]->x, uy = (double)uvs[1]->y - (double)uvs[0]->y,
           vx = (double)uvs[2]->x - (double)uvs[0]->x, vy = (double)uvs[2]->y - (double)uvs[0]->y;
    double texels = 0.5 * fabs((ux * vy - uy * vx) * sx * sy) * p->widths[0] * p->heights[0];
    double wide = place->area > 0 ? around * sqrt(texels / place->area) : 1;
    if (!isfinite(x) || !isfinite(y) || !isfinite(wide))
        return 1;
    double level = fmin(fmax(log2(fmax(wide, 1)), 0), p->count - 1), low = floor(level), over = level - low;
    int    first = (int)low;
    double own = texel_at(p, first, use, x, y);
    return over > 0 ? own + over * (texel_at(p, first + 1, use, x, y) - own) : own;
}

double mark_brightness_at(const void *brightness, uint32_t triangle, vec3 at, double around)
{
    const mark_brightness *b = brightness;
    const mark_ground     *g = b->ground;
    const uint32_t        *i = &g->indices[3 * (size_t)triangle];
    const vec3            *corners[3] = {&g->positions[i[0]], &g->positions[i[1]], &g->positions[i[2]]};
    const texture_use     *use = picture_of(g, triangle);
    double                 tint = 0;
    place_on_triangle      place = find_place(corners, at);
    for (int k = 0; k < 3; k++)
        tint += place.part[k] * (double)g->tints[i[k]];
    tint = pow(fmax(tint, 0), PLAIN);
    if (use) {
        const vec2 *uvs[3] = {&g->picture_uvs[i[0]], &g->picture_uvs[i[1]], &g->picture_uvs[i[2]]};
        tint *= picture_at(b, use, uvs, &place, around);
    }
    return fmin(fmax(tint, 0), 1);
}
