/* Borders of half coverage are traced by marching squares, in steps of equal length, and cut at corners: where straight
 * lines meet. What lies between is smoothed by a Gaussian along it, twice what that leaves less what it leaves of that
 * again, so that round things keep their size (Tukey 1977, "Exploratory data analysis": twicing). Then the area within
 * is summed up exactly, texel by texel. */
#include "light/contour.h"

#include <math.h>
#include <stddef.h>
#include <stdlib.h>

#include "base/memory.h"
#include "light/patches.h"

enum { STEPS_A_RADIUS = 12 };
static const double LEVEL = 127.5;
static const double SPREAD = 0.6; /* standard deviation, of the radius */
/* What is straight enough for an arm of a corner: so far off, texels, and by this of its length besides. */
static const double OFF = 0.35, BENT = 0.02;
static const double FOUND_AGAIN = 3; /* how far from the border as it is traced a corner may lie, texels */
/* Arms of a corner, of the radius, and how far it turns at least, radians: what turns by less may be round. */
static const double ARM = 1.25, LEAST_TURN = 0.6;

typedef struct point {
    double x, y;
} point;

/* A closed contour in steps of equal length. */
typedef struct path {
    point  *at, *smoothed, *again;
    double *turn; /* at each, where straight lines meet; else 0 */
    int    *corners;
    double *weights; /* of a Gaussian, from its middle out: `reach` more */
    int     count, corner_count, reach;
    double  step;
} path;

typedef struct tracing {
    uint8_t *texels, *seen;
    int      width, height;
    point   *found; /* the contour as it is traced */
    int      count, room;
    float   *area; /* by how much cover grows to the right */
} tracing;

static double cover(const tracing *t, int x, int y)
{
    bool inside = x >= 0 && y >= 0 && x < t->width && y < t->height;
    return inside ? t->texels[4 * ((size_t)y * (size_t)t->width + (size_t)x)] : 0;
}

/* A cell's corners are the middles of four texels from x, y on; side k lies between corners k and k + 1. */
static double at_corner(const tracing *t, int x, int y, int k)
{
    return cover(t, x + (k == 1 || k == 2), y + (k > 1));
}

static point crossing(const tracing *t, int x, int y, int side)
{
    double from = at_corner(t, x, y, side), to = at_corner(t, x, y, (side + 1) % 4);
    double part = (LEVEL - from) / (to - from);
    switch (side) {
    case 0: return (point){x + 0.5 + part, y + 0.5};
    case 1: return (point){x + 1.5, y + 0.5 + part};
    case 2: return (point){x + 1.5 - part, y + 1.5};
    default: return (point){x + 0.5, y + 1.5 - part};
    }
}

/* Which side a border that came in through `from` leaves through. What is covered lies to its left, and hangs together
 * over corners. */
static int way_out(const tracing *t, int x, int y, int from)
{
    for (int k = 1; k < 4; k++) {
        int side = (from + k) % 4;
        if ((at_corner(t, x, y, side) > LEVEL) != (at_corner(t, x, y, (side + 1) % 4) > LEVEL))
            return side;
    }
    return from;
}

static bool add_found(tracing *t, point p)
{
    if (t->count == t->room) {
        int    room = 2 * t->room + 256;
        point *found = mem_realloc(t->found, (size_t)room * sizeof *found);
        if (!found)
            return false;
        t->found = found;
        t->room = room;
    }
    t->found[t->count++] = p;
    return true;
}

static uint8_t *seen_at(tracing *t, int x, int y)
{
    return &t->seen[(size_t)(y + 1) * (size_t)(t->width + 1) + (size_t)(x + 1)];
}

/* From a cell that a border enters from below, once around. */
static bool trace(tracing *t, int x, int y)
{
    static const int across[4] = {0, 1, 0, -1}, up[4] = {-1, 0, 1, 0};
    int              from = 0;
    t->count = 0;
    for (;;) {
        if (from == 0) {
            if (*seen_at(t, x, y))
                return true;
            *seen_at(t, x, y) = 1;
        }
        if (!add_found(t, crossing(t, x, y, from)))
            return false;
        int side = way_out(t, x, y, from);
        x += across[side];
        y += up[side];
        from = (side + 2) % 4;
    }
}

static double distance(point a, point b)
{
    return hypot(b.x - a.x, b.y - a.y);
}

static void path_free(path *p)
{
    mem_free(p->at);
    mem_free(p->smoothed);
    mem_free(p->again);
    mem_free(p->turn);
    mem_free(p->corners);
    mem_free(p->weights);
}

static bool path_alloc(path *p, double radius)
{
    size_t n = (size_t)p->count;
    double deviation = SPREAD * radius / p->step;
    p->reach = (int)ceil(3 * deviation);
    p->weights = mem_alloc(((size_t)p->reach + 1) * sizeof *p->weights);
    for (int k = 0; p->weights && k <= p->reach; k++)
        p->weights[k] = exp(-0.5 * k * k / (deviation * deviation));
    p->at = mem_alloc(n * sizeof *p->at);
    p->smoothed = mem_alloc(n * sizeof *p->smoothed);
    p->again = mem_alloc(n * sizeof *p->again);
    p->turn = mem_calloc(n, sizeof *p->turn);
    p->corners = mem_alloc(n * sizeof *p->corners);
    return p->at && p->smoothed && p->again && p->turn && p->corners && p->weights;
}

static bool path_of(const tracing *t, double radius, path *out)
{
    double length = 0;
    for (int i = 0; i < t->count; i++)
        length += distance(t->found[i], t->found[(i + 1) % t->count]);
    *out = (path){.count = (int)fmax(ceil(length / fmax(radius / STEPS_A_RADIUS, 0.5)), 8)};
    out->step = length / out->count;
    if (!path_alloc(out, radius))
        return false;
    double before = 0;
    for (int i = 0, k = 0; i < out->count; i++) {
        double along = i * out->step, part = distance(t->found[k], t->found[(k + 1) % t->count]);
        while (k + 1 < t->count && before + part < along) {
            before += part;
            k++;
            part = distance(t->found[k], t->found[(k + 1) % t->count]);
        }
        point  a = t->found[k], b = t->found[(k + 1) % t->count];
        double share = part > 0 ? fmin((along - before) / part, 1) : 0;
        out->at[i] = (point){a.x + share * (b.x - a.x), a.y + share * (b.y - a.y)};
    }
    return true;
}

static point path_at(const path *p, int i)
{
    return p->at[((i % p->count) + p->count) % p->count];
}

/* How straight the border is from one place to another, and which way it goes. */
static bool is_straight(const path *p, int from, int to, point *way)
{
    point  a = path_at(p, from), b = path_at(p, to);
    double length = distance(a, b), most = OFF + BENT * length;
    int    ahead = to > from ? 1 : -1;
    if (!(length > 0.9 * fabs((to - from) * p->step)))
        return false;
    *way = (point){(b.x - a.x) / length, (b.y - a.y) / length};
    for (int i = from + ahead; i != to; i += ahead) {
        point at = path_at(p, i);
        if (fabs((at.x - a.x) * way->y - (at.y - a.y) * way->x) > most)
            return false;
    }
    return true;
}

/* By how much the border turns between two straight lines, and where these meet. */
static double turn_at(const path *p, int i, int arm, point *where)
{
    int   gap = (int)ceil(1.5 / p->step);
    point before, behind, a = path_at(p, i - gap), b = path_at(p, i + gap), own = path_at(p, i);
    if (arm < gap + 2 || 2 * arm >= p->count || !is_straight(p, i - gap, i - arm, &before) ||
        !is_straight(p, i + gap, i + arm, &behind))
        return 0;
    double sine = before.x * behind.y - before.y * behind.x, cosine = -(before.x * behind.x + before.y * behind.y);
    double turn = atan2(fabs(sine), cosine);
    *where = own;
    if (fabs(sine) < 0.05)
        return turn;
    double along = ((b.x - a.x) * behind.y - (b.y - a.y) * behind.x) / sine;
    *where = (point){a.x + along * before.x, a.y + along * before.y};
    return distance(*where, own) < FOUND_AGAIN ? turn : 0;
}

static void find_corners(path *p, double radius)
{
    int steps = (int)(ARM * radius / p->step + 0.5);
    for (int i = 0; i < p->count; i++) {
        double turn = turn_at(p, i, steps, &p->again[i]);
        p->turn[i] = turn >= LEAST_TURN ? turn : 0;
    }
    for (int i = 0; i < p->count; i++) {
        double own = p->turn[i];
        bool   most = own > 0;
        for (int k = 1; k <= steps / 2 && most; k++) {
            int before = ((i - k) % p->count + p->count) % p->count, behind = (i + k) % p->count;
            most = p->turn[before] < own && p->turn[behind] <= own;
        }
        if (most)
            p->corners[p->corner_count++] = i;
    }
    for (int c = 0; c < p->corner_count; c++)
        p->at[p->corners[c]] = p->again[p->corners[c]];
}

/* A place of a piece of `last` steps from `first` on; beyond its ends it goes on as it does within, turned by half. */
static point mirrored(const path *p, const point *from, int first, int last, int i)
{
    point  off = {0, 0};
    double sign = 1;
    while (i < 0 || i > last) {
        int   end = i < 0 ? 0 : last;
        point at = from[(first + end) % p->count];
        off.x += sign * 2 * at.x;
        off.y += sign * 2 * at.y;
        sign = -sign;
        i = 2 * end - i;
    }
    point at = from[(first + i) % p->count];
    return (point){off.x + sign * at.x, off.y + sign * at.y};
}

static void smooth_piece(const path *p, const point *from, int first, int last, point *into)
{
    for (int i = 0; i < last; i++) {
        point  sum = {0, 0};
        double weights = 0;
        for (int k = -p->reach; k <= p->reach; k++) {
            double weight = p->weights[abs(k)];
            point  at = p->corner_count ? mirrored(p, from, first, last, i + k)
                                        : from[((i + k) % p->count + p->count) % p->count];
            sum.x += weight * at.x;
            sum.y += weight * at.y;
            weights += weight;
        }
        into[(first + i) % p->count] = (point){sum.x / weights, sum.y / weights};
    }
}

static void smooth(const path *p, const point *from, point *into)
{
    if (p->corner_count == 0)
        smooth_piece(p, from, 0, p->count, into);
    for (int c = 0; c < p->corner_count; c++) {
        int first = p->corners[c], next = c + 1 < p->corner_count ? p->corners[c + 1] : p->corners[0] + p->count;
        smooth_piece(p, from, first, next - first, into);
    }
}

/* What of one row lies to the right of a piece of border, which goes `down` by that much of the row. */
static void add_to_row(tracing *t, int row, double from, double to, double down)
{
    double low = fmax(fmin(fmin(from, to), t->width), 0), high = fmax(fmin(fmax(from, to), t->width), 0);
    int    first = (int)low, last = (int)high;
    float *area = t->area + (size_t)row * (size_t)(t->width + 2);
    if (first == last) {
        double left = first + 1 - 0.5 * (low + high);
        area[first] += (float)(down * left);
        area[first + 1] += (float)(down * (1 - left));
        return;
    }
    double steep = down / (high - low), before = 0;
    for (int x = first; x <= last; x++) {
        double begins = fmax(low, x), ends = fmin(high, x + 1), part = steep * (ends - begins);
        double within = part * (x + 1 - 0.5 * (begins + ends));
        area[x] += (float)(before + within);
        before = part - within;
    }
    area[last + 1] += (float)before;
}

static void add_edge(tracing *t, point a, point b)
{
    double low = fmax(fmin(a.y, b.y), 0), high = fmin(fmax(a.y, b.y), t->height);
    for (int row = (int)low; row < high; row++) {
        double from = fmax(low, row), to = fmin(high, row + 1), slope = (b.x - a.x) / (b.y - a.y);
        if (to > from)
            add_to_row(t, row, a.x + slope * (from - a.y), a.x + slope * (to - a.y), a.y > b.y ? to - from : from - to);
    }
}

static bool calm(tracing *t, double radius)
{
    path p;
    bool good = path_of(t, radius, &p);
    if (good) {
        find_corners(&p, radius);
        smooth(&p, p.at, p.smoothed);
        smooth(&p, p.smoothed, p.again);
        for (int i = 0; i < p.count; i++)
            p.at[i] = (point){2 * p.smoothed[i].x - p.again[i].x, 2 * p.smoothed[i].y - p.again[i].y};
        for (int i = 0; i < p.count; i++)
            add_edge(t, p.at[i], path_at(&p, i + 1));
    }
    path_free(&p);
    return good;
}

static void cover_anew(tracing *t)
{
    for (int y = 0; y < t->height; y++) {
        const float *area = t->area + (size_t)y * (size_t)(t->width + 2);
        float        sum = 0;
        for (int x = 0; x < t->width; x++) {
            sum += area[x];
            t->texels[4 * ((size_t)y * (size_t)t->width + (size_t)x)] = (uint8_t)(255 * fminf(fmaxf(sum, 0), 1) + 0.5F);
        }
    }
}

bool contours_calm(uint8_t *texels, int width, int height, double radius)
{
    tracing t = {.texels = texels, .width = width, .height = height};
    t.seen = mem_calloc((size_t)(width + 1) * (size_t)(height + 1), 1);
    t.area = mem_calloc((size_t)(width + 2) * (size_t)height, sizeof *t.area);
    bool      good = t.seen && t.area;
    texel_box box = texel_box_of(texels, width, height, 0);
    for (int y = box.y - 1; y < box.y + box.height && good; y++)
        for (int x = box.x - 1; x < box.x + box.width && good; x++)
            if (!*seen_at(&t, x, y) && cover(&t, x, y) > LEVEL && !(cover(&t, x + 1, y) > LEVEL))
                good = trace(&t, x, y) && calm(&t, radius);
    if (good)
        cover_anew(&t);
    mem_free(t.seen);
    mem_free(t.area);
    mem_free(t.found);
    return good;
}
