/* Which stretches of lines bound a solid. A line is cut wherever it meets a face. Around the middle of a stretch stand
 * the faces that hold it, as half-planes sorted by angle; which operands hold between them says the tree, and where its
 * value changes there is a face of the solid. No change: no line. Two, in one plane: none either. Else it is an edge of
 * the solid, whatever it came from. */
#include "stroke/solid_private.h"

#include <math.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/threads.h"
#include "base/work.h"

static const double pi = 3.14159265358979323846;
/* An angle between operands is no accident of facets: from this one on it is a line, as in pictures
 * (lines.meet). */
static const double MEET = 10 * 3.14159265358979323846 / 180;
/* Half-planes of one shared plane are not farther apart than rounding of narrow faces makes of it. */
static const double ONE_PLANE = 0.05;
/* A face holds a line that is no farther from it, times what is one place. */
static const double HOLDS = 1.5;
enum { BLOCK = 256, STACK = 128, ASIDE = 20 };

/* A half-plane that begins at the line. */
typedef struct half_plane {
    double   angle; /* around the line, 0 … 2 π */
    double   reach; /* so far its face goes */
    uint32_t face, operand;
    bool     begins; /* going round, its operand begins there, by which way the face looks */
} half_plane;

/* Half-planes that are as good as one. */
typedef struct fan {
    size_t first, count;
} fan;

/* Where the solid begins or ends, going round. */
typedef struct change {
    double   angle, reach;
    uint32_t face;
    bool     begins;
    size_t   fan;
} change;

typedef struct near_face {
    uint32_t face;
    double   from, to; /* along the line */
} near_face;

typedef struct arounder {
    const solid_builder *b;
    solid_state          state;
    near_face           *near;
    size_t               near_count, near_capacity;
    double              *breaks;
    size_t               break_count, break_capacity;
    half_plane          *halves;
    size_t               half_count, half_capacity;
    fan                 *fans;
    size_t               fan_count, fan_capacity;
    change              *changes;
    size_t               change_count, change_capacity;
    uint32_t            *parity; /* operands that a ray met, over and over */
    size_t               parity_count, parity_capacity;
    bool                *odd, *settled; /* per operand */
    uint32_t            *holding;       /* operands that hold before the first fan */
    size_t               holding_count, holding_capacity;
    uint32_t            *incident; /* per operand: half-planes at the stretch */
    solid_stretches     *out;
    bool                 failed;
    double3              along, side, up; /* of the line: unit, right-handed */
} arounder;

static void release(arounder *w)
{
    solid_state_release(&w->state);
    mem_free(w->near);
    mem_free(w->breaks);
    mem_free(w->halves);
    mem_free(w->fans);
    mem_free(w->changes);
    mem_free(w->parity);
    mem_free(w->odd);
    mem_free(w->settled);
    mem_free(w->holding);
    mem_free(w->incident);
}

static bool open_arounder(arounder *w, const solid_builder *b)
{
    size_t operands = b->solid->program.operand_count;
    w->b = b;
    w->odd = mem_calloc(operands + 1, sizeof *w->odd);
    w->settled = mem_calloc(operands + 1, sizeof *w->settled);
    w->incident = mem_calloc(operands + 1, sizeof *w->incident);
    return solid_state_open(&w->state, &b->solid->program) && w->odd && w->settled && w->incident;
}

/* --- rays ----------------------------------------------------------------------------------------------- */

/* A stretch of a line from a position on, made ready for boxes: 1 / its direction. */
typedef struct box_line {
    double at[3], slow[3], length;
} box_line;

static box_line line_to_boxes(double3 from, double3 along, double length)
{
    const double way[3] = {along.x, along.y, along.z};
    box_line     out = {{from.x, from.y, from.z}, {0, 0, 0}, length};
    for (int k = 0; k < 3; k++) /* finite, so that 0 times it is no trouble */
        out.slow[k] = fabs(way[k]) > 1e-150 ? 1 / way[k] : 1e150;
    return out;
}

/* fmin and fmax are calls. */
static bool meets_box(const box_line *l, const box3 *box)
{
    const double low[3] = {box->min.x, box->min.y, box->min.z}, high[3] = {box->max.x, box->max.y, box->max.z};
    double       enter = 0, leave = l->length;
    for (int k = 0; k < 3; k++) {
        double a = (low[k] - l->at[k]) * l->slow[k], b = (high[k] - l->at[k]) * l->slow[k];
        double first = a < b ? a : b, last = a < b ? b : a;
        enter = enter > first ? enter : first;
        leave = leave < last ? leave : last;
    }
    return enter <= leave;
}

/* By the signs of volumes, which are exactly opposite for the two faces of an edge. */
static bool ray_meets_face(const solid_face *f, double3 from, double3 along)
{
    double3 p[3];
    for (int k = 0; k < 3; k++)
        p[k] = double3_minus(f->p[k], from);
    double a = double3_dot(along, double3_cross(p[0], p[1])), b = double3_dot(along, double3_cross(p[1], p[2])),
           c = double3_dot(along, double3_cross(p[2], p[0]));
    if (!((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0)))
        return false;
    double3 n = double3_cross(double3_minus(p[1], p[0]), double3_minus(p[2], p[0]));
    double  height = double3_dot(p[0], n), speed = double3_dot(along, n);
    return speed != 0 && height / speed > 0;
}

/* Which operands hold at a position, by how often a ray meets their faces: sets `odd`, undone by keep_holding. */
static void find_parity(arounder *w, double3 at)
{
    static const double3 along = {0.5412378, 0.6127751, 0.5758921};
    const solid_builder *b = w->b;
    const box_line       line = line_to_boxes(at, along, INFINITY);
    uint32_t             stack[STACK], depth = 0;
    if (b->tree.node_count)
        stack[depth++] = 0;
    while (depth > 0) {
        const hierarchy_node *n = &b->tree.nodes[stack[--depth]];
        if (!meets_box(&line, &n->box))
            continue;
        for (uint32_t i = 0; i < n->count; i++) {
            uint32_t face = b->tree.members[n->first + i], operand = b->solid->operands[face];
            if (!ray_meets_face(&b->faces[face], at, along))
                continue;
            if (!mem_grow((void **)&w->parity, &w->parity_capacity, w->parity_count + 1, sizeof *w->parity)) {
                w->failed = true;
                return;
            }
            w->parity[w->parity_count++] = operand;
            w->odd[operand] = !w->odd[operand];
        }
        if (n->count == 0 && depth + 2 <= STACK) {
            stack[depth++] = n->first;
            stack[depth++] = n->first + 1;
        }
    }
}

/* --- where a line is cut -------------------------------------------------------------------------------- */

static bool put_break(arounder *w, double at)
{
    if (!mem_grow((void **)&w->breaks, &w->break_capacity, w->break_count + 1, sizeof *w->breaks))
        return false;
    w->breaks[w->break_count++] = at;
    return true;
}

/* Is a position of a face's plane in the face, or as good as? */
static bool is_in_face(const solid_builder *b, const solid_face *f, double3 at)
{
    for (int k = 0; k < 3; k++) {
        double3 edge = double3_minus(f->p[(k + 1) % 3], f->p[k]),
                out = double3_cross(edge, f->normal); /* away from the face */
        double length = double3_length(out);
        if (double3_dot(double3_minus(at, f->p[k]), out) > b->near * length)
            return false;
    }
    return true;
}

/* Where the line passes the edges of a face whose plane holds it. */
static bool break_in_plane(arounder *w, const solid_face *f, double3 from, double length)
{
    double3 across = double3_cross(f->normal, w->along);
    double  sides[3], places[3];
    for (int k = 0; k < 3; k++) {
        double3 r = double3_minus(f->p[k], from);
        sides[k] = double3_dot(r, across);
        places[k] = double3_dot(r, w->along);
    }
    for (int k = 0; k < 3; k++) {
        int    next = (k + 1) % 3;
        double at = places[k];
        bool   on = fabs(sides[k]) <= w->b->near;
        if (!on && fabs(sides[next]) > w->b->near && (sides[k] < 0) != (sides[next] < 0)) {
            at += sides[k] / (sides[k] - sides[next]) * (places[next] - places[k]);
            on = true;
        }
        if (on && at > w->b->near && at < length - w->b->near && !put_break(w, at))
            return false;
    }
    return true;
}

static bool break_at_face(arounder *w, uint32_t face, double3 from, double length)
{
    const solid_face *f = &w->b->faces[face];
    double            near = w->b->near, low = double3_dot(double3_minus(from, f->p[0]), f->normal),
           high = low + length * double3_dot(w->along, f->normal);
    if (fabs(low) <= near && fabs(high) <= near)
        return break_in_plane(w, f, from, length);
    if ((low > near && high > near) || (low < -near && high < -near) || low == high)
        return true;
    double at = low / (low - high) * length;
    if (at <= near || at >= length - near || !is_in_face(w->b, f, double3_plus(from, w->along, at)))
        return true;
    return put_break(w, at);
}

static bool put_near(arounder *w, uint32_t face, double3 from, double length)
{
    const solid_face *f = &w->b->faces[face];
    double            low = double3_dot(double3_minus(from, f->p[0]), f->normal),
           high = low + length * double3_dot(w->along, f->normal), reach = HOLDS * w->b->near;
    if ((low > reach && high > reach) || (low < -reach && high < -reach))
        return true;
    if (!mem_grow((void **)&w->near, &w->near_capacity, w->near_count + 1, sizeof *w->near))
        return false;
    low = INFINITY;
    high = -INFINITY;
    for (int k = 0; k < 3; k++) {
        double at = double3_dot(double3_minus(f->p[k], from), w->along);
        low = low < at ? low : at;
        high = high > at ? high : at;
    }
    w->near[w->near_count++] = (near_face){face, low - w->b->near, high + w->b->near};
    return break_at_face(w, face, from, length);
}

static bool find_near(arounder *w, double3 from, double length)
{
    const solid_builder *b = w->b;
    const box_line       line = line_to_boxes(from, w->along, length);
    uint32_t             stack[STACK], depth = 0;
    w->near_count = w->break_count = 0;
    if (b->tree.node_count)
        stack[depth++] = 0;
    while (depth > 0) {
        const hierarchy_node *n = &b->tree.nodes[stack[--depth]];
        if (!meets_box(&line, &n->box))
            continue;
        for (uint32_t i = 0; i < n->count; i++) {
            uint32_t face = b->tree.members[n->first + i];
            if (meets_box(&line, &b->boxes[face]) && !put_near(w, face, from, length))
                return false;
        }
        if (n->count == 0 && depth + 2 <= STACK) {
            stack[depth++] = n->first;
            stack[depth++] = n->first + 1;
        }
    }
    return true;
}

static int compare_doubles(const void *a, const void *b)
{
    const double *p = a, *q = b;
    return (*p > *q) - (*p < *q);
}

/* --- what stands around a stretch ------------------------------------------------------------------------- */

static bool put_half(arounder *w, uint32_t face, double x, double y, double reach)
{
    if (!mem_grow((void **)&w->halves, &w->half_capacity, w->half_count + 1, sizeof *w->halves))
        return false;
    const solid_builder *b = w->b;
    double               angle = atan2(y, x), turns = cos(angle) * double3_dot(b->faces[face].normal, w->up) -
                                        sin(angle) * double3_dot(b->faces[face].normal, w->side);
    uint32_t operand = b->solid->operands[face];
    w->halves[w->half_count++] = (half_plane){angle < 0 ? angle + 2 * pi : angle, reach, face, operand,
                                              (turns < 0) != b->parts[operand].taken_away};
    w->incident[operand]++;
    return true;
}

/* Does a face hold the stretch? Its two half-planes, or the one that it has where the stretch is on its edge. */
static bool take_face(arounder *w, uint32_t face, double3 p, double3 q, double3 middle)
{
    const solid_face *f = &w->b->faces[face];
    double            near = HOLDS * w->b->near;
    if (fabs(double3_dot(double3_minus(middle, f->p[0]), f->normal)) > near ||
        fabs(double3_dot(double3_minus(p, f->p[0]), f->normal)) > near ||
        fabs(double3_dot(double3_minus(q, f->p[0]), f->normal)) > near || !is_in_face(w->b, f, middle))
        return true;
    double x[3], y[3], most = 0;
    int    farthest = 0;
    for (int k = 0; k < 3; k++) {
        double3 r = double3_minus(f->p[k], middle);
        x[k] = double3_dot(r, w->side);
        y[k] = double3_dot(r, w->up);
        if (x[k] * x[k] + y[k] * y[k] > most) {
            most = x[k] * x[k] + y[k] * y[k];
            farthest = k;
        }
    }
    double reach = sqrt(most), beyond = 0;
    int    other = farthest;
    if (reach <= 2 * w->b->near)
        return true;
    for (int k = 0; k < 3; k++) {
        double back = -(x[k] * x[farthest] + y[k] * y[farthest]) / reach;
        if (back > beyond) {
            beyond = back;
            other = k;
        }
    }
    return put_half(w, face, x[farthest], y[farthest], reach) &&
           (beyond <= HOLDS * w->b->near || put_half(w, face, x[other], y[other], beyond));
}

static int compare_halves(const void *a, const void *b)
{
    const half_plane *p = a, *q = b;
    if (p->angle != q->angle)
        return p->angle < q->angle ? -1 : 1;
    if (p->operand != q->operand)
        return p->operand < q->operand ? -1 : 1;
    return (p->face > q->face) - (p->face < q->face);
}

static bool are_one(const arounder *w, const half_plane *p, const half_plane *q)
{
    double   apart = fabs(q->angle - p->angle);
    uint16_t plane = w->b->solid->planes[p->face];
    apart = fmin(apart, 2 * pi - apart);
    return apart * fmin(p->reach, q->reach) <= 2 * w->b->near || apart < 1e-9 ||
           (plane && plane == w->b->solid->planes[q->face] && apart < ONE_PLANE);
}

/* Sorts half-planes, from behind the widest gap on, and gathers them. */
static bool make_fans(arounder *w)
{
    size_t count = w->half_count, first = 0;
    double widest = -1;
    if (count)
        qsort(w->halves, count, sizeof *w->halves, compare_halves);
    if (!mem_grow((void **)&w->halves, &w->half_capacity, 2 * count, sizeof *w->halves) ||
        !mem_grow((void **)&w->fans, &w->fan_capacity, count, sizeof *w->fans))
        return false;
    for (size_t i = 0; i < count; i++) {
        double gap = w->halves[i].angle - (i ? w->halves[i - 1].angle : w->halves[count - 1].angle - 2 * pi);
        if (gap > widest) {
            widest = gap;
            first = i;
        }
    }
    for (size_t i = 0; i < first; i++) {
        w->halves[count + i] = w->halves[i];
        w->halves[count + i].angle += 2 * pi;
    }
    memmove(w->halves, w->halves + first, count * sizeof *w->halves);
    w->fan_count = 0;
    for (size_t i = 0; i < count; i++) {
        if (w->fan_count && are_one(w, &w->halves[w->fans[w->fan_count - 1].first], &w->halves[i]))
            w->fans[w->fan_count - 1].count++;
        else
            w->fans[w->fan_count++] = (fan){i, 1};
    }
    return true;
}

/* Does the operand hold before the first fan? 1 yes, 0 no, −1: its half-planes do not say. */
static int holds_before(const arounder *w, uint32_t operand)
{
    int    before = -1;
    size_t all = 0;
    for (size_t i = 0; i < w->fan_count; i++) {
        size_t own = 0;
        bool   begins = false;
        for (size_t k = w->fans[i].first; k < w->fans[i].first + w->fans[i].count; k++)
            if (w->halves[k].operand == operand) {
                own++;
                begins = w->halves[k].begins;
            }
        all += own;
        if (own == 1 && before < 0)
            before = !begins;
    }
    return all % 2 ? -1 : before;
}

/* Do other operands than those that stand around reach to a position? All that do meet these. */
static bool has_others(const arounder *w, double3 at)
{
    const solid_part *part = &w->b->parts[w->halves[0].operand];
    vec3              p = {(float)at.x, (float)at.y, (float)at.z};
    for (size_t i = 0; i < part->meet_count; i++) {
        uint32_t other = w->b->meets[part->first_meet + i];
        if (!w->incident[other] && boxes_meet(&w->b->parts[other].box, &(box3){p, p}))
            return true;
    }
    return false;
}

static void put_holding(arounder *w, uint32_t operand)
{
    if (mem_grow((void **)&w->holding, &w->holding_capacity, w->holding_count + 1, sizeof *w->holding))
        w->holding[w->holding_count++] = operand;
    else
        w->failed = true;
}

/* The operands that hold before the first fan, each once: of those that stand around what their half-planes say, of
 * others those of which the ray met an odd number of faces. */
static void keep_holding(arounder *w)
{
    w->holding_count = 0;
    for (size_t i = 0; i < w->half_count; i++) {
        uint32_t operand = w->halves[i].operand;
        int      before = w->b->parts[operand].crossed ? -1 : holds_before(w, operand);
        if (!w->settled[operand] && (before >= 0 ? before != 0 : w->odd[operand]))
            put_holding(w, operand);
        w->settled[operand] = true;
    }
    for (size_t i = 0; i < w->parity_count; i++) {
        uint32_t operand = w->parity[i];
        if (!w->settled[operand] && w->odd[operand])
            put_holding(w, operand);
        w->settled[operand] = true;
    }
    for (size_t i = 0; i < w->half_count; i++)
        w->settled[w->halves[i].operand] = false;
    for (size_t i = 0; i < w->parity_count; i++)
        w->settled[w->parity[i]] = w->odd[w->parity[i]] = false;
    w->parity_count = 0;
}

/* Sets the state before the first fan. `stack`: operands that were passed, to be passed again at the end. */
static void begin_state(arounder *w, double3 middle)
{
    const solid_builder *b = w->b;
    bool                 doubtful = false, others = false;
    for (size_t i = 0; i < w->half_count; i++) {
        uint32_t operand = w->halves[i].operand;
        doubtful = doubtful || b->parts[operand].crossed || holds_before(w, operand) < 0;
    }
    others = has_others(w, middle);
    if (doubtful) { /* asked a little beside, in the widest gap */
        double angle = (w->halves[w->half_count - 1].angle - 2 * pi + w->halves[0].angle) / 2;
        middle = double3_plus(double3_plus(middle, w->side, ASIDE * b->near * cos(angle)), w->up,
                              ASIDE * b->near * sin(angle));
    }
    if (others || doubtful)
        find_parity(w, middle);
    keep_holding(w);
    for (size_t i = 0; i < w->holding_count; i++)
        solid_state_pass(&w->state, w->holding[i]);
}

static void pass_fan(arounder *w, const fan *f)
{
    for (size_t i = f->first; i < f->first + f->count; i++)
        solid_state_pass(&w->state, w->halves[i].operand);
}

/* Order of what lies in one plane, as of fragments (csg/csg.h), from the outside inwards: ends before beginnings; among
 * beginnings what is taken away before what is kept, among ends the other way round. `forward`: inwards is the way that
 * angles grow. */
static uint32_t key_of(const arounder *w, const half_plane *h, bool forward)
{
    bool taken = w->b->parts[h->operand].taken_away, enters = h->begins == forward, begins = enters != taken;
    return (begins ? 2u : 0) + (begins != taken ? 1u : 0);
}

/* The face of a fan that people see: where the value changes last, going from the outside inwards. The state is that
 * outside, and is left as it is inside. */
static const half_plane *find_owner(arounder *w, const fan *f, bool forward)
{
    const half_plane *owner = &w->halves[f->first];
    for (uint32_t key = 0; key < 4; key++)
        for (size_t i = f->first; i < f->first + f->count; i++) {
            bool before = w->state.value;
            if (key_of(w, &w->halves[i], forward) != key)
                continue;
            solid_state_pass(&w->state, w->halves[i].operand);
            if (w->state.value != before)
                owner = &w->halves[i];
        }
    return owner;
}

static bool find_changes(arounder *w, double3 middle)
{
    w->change_count = 0;
    begin_state(w, middle);
    if (w->failed || !mem_grow((void **)&w->changes, &w->change_capacity, w->fan_count, sizeof *w->changes))
        return false;
    for (size_t i = 0; i < w->fan_count; i++) {
        const fan *f = &w->fans[i];
        bool       before = w->state.value;
        pass_fan(w, f);
        if (w->state.value == before)
            continue;
        const half_plane *owner = &w->halves[f->first];
        if (f->count > 1 && !before) {
            pass_fan(w, f);
            owner = find_owner(w, f, true);
        } else if (f->count > 1) {
            owner = find_owner(w, f, false);
            pass_fan(w, f);
        }
        w->changes[w->change_count++] = (change){owner->angle, owner->reach, owner->face, !before, i};
    }
    /* Back to nothing. */
    for (size_t i = 0; i < w->fan_count; i++)
        pass_fan(w, &w->fans[i]);
    for (size_t i = 0; i < w->holding_count; i++)
        solid_state_pass(&w->state, w->holding[i]);
    return true;
}

/* --- stretches ------------------------------------------------------------------------------------------ */

static bool put_stretch(arounder *w, const solid_candidate *c, double3 p, double3 q, const uint32_t faces[2],
                        uint32_t flags)
{
    const edge_mesh *m = w->b->mesh;
    if (faces[0] != EDGE_NO_FACE && faces[1] != EDGE_NO_FACE && m->materials[faces[0]] != m->materials[faces[1]])
        flags |= EDGE_MATERIAL;
    if (!flags)
        return true;
    if (!mem_grow((void **)&w->out->items, &w->out->capacity, w->out->count + 1, sizeof *w->out->items))
        return false;
    solid_stretch *s = &w->out->items[w->out->count++];
    *s =
        (solid_stretch){{p, q}, {faces[0], faces[1]}, flags, flags & EDGE_CREASE ? c->turn : 0, {NO_VERTEX, NO_VERTEX}};
    const double3 at[2] = {p, q};
    for (int k = 0; k < 2; k++)
        if (memcmp(&at[k], &c->ends[k], sizeof at[k]) == 0)
            s->vertex[k] = c->vertex[k];
    return true;
}

/* What an edge of an operand is by itself. */
static bool is_own(const solid_candidate *c, const uint32_t faces[2])
{
    return c->vertex[0] != NO_VERTEX && ((c->faces[0] == faces[0] && c->faces[1] == faces[1]) ||
                                         (c->faces[0] == faces[1] && c->faces[1] == faces[0]));
}

/* An edge with two faces: what it is. Smooth ones may be outlines; 0: it is flat. */
static uint32_t judge(const arounder *w, const solid_candidate *c, const change *begin, const change *end)
{
    double inside = end->angle - begin->angle, turn;
    inside = inside < 0 ? inside + 2 * pi : inside;
    turn = fabs(pi - inside);
    const uint32_t faces[2] = {begin->face, end->face};
    uint32_t       outline = inside < pi ? EDGE_CANDIDATE : EDGE_CANDIDATE | EDGE_HOLLOW;
    if (is_own(c, faces))
        return c->flags & EDGE_CREASE ? c->flags : c->flags | outline;
    uint16_t plane = w->b->solid->planes[begin->face];
    if (turn * fmin(begin->reach, end->reach) <= 2 * w->b->near ||
        (plane && plane == w->b->solid->planes[end->face] && turn < ONE_PLANE))
        return 0;
    bool one = w->b->solid->operands[begin->face] == w->b->solid->operands[end->face];
    return turn >= (one ? w->b->crease : fmin(w->b->crease, MEET)) ? EDGE_CREASE : outline;
}

/* What stands around a stretch of a line that begins at `from`, and where the solid begins and ends there. */
static bool look_around(arounder *w, double3 from, double3 p, double3 q)
{
    double3 middle = {(p.x + q.x) / 2, (p.y + q.y) / 2, (p.z + q.z) / 2};
    double  at = double3_dot(double3_minus(middle, from), w->along);
    w->half_count = w->change_count = 0;
    for (size_t i = 0; i < w->near_count; i++)
        if (w->near[i].from <= at && at <= w->near[i].to && !take_face(w, w->near[i].face, p, q, middle))
            return false;
    bool good = w->half_count == 0 || (make_fans(w) && find_changes(w, middle));
    for (size_t i = 0; i < w->half_count; i++)
        w->incident[w->halves[i].operand] = 0;
    return good;
}

/* Going round the line, the solid begins at its right-hand face and ends at the other. */
static bool take_stretch(arounder *w, const solid_candidate *c, double3 p, double3 q)
{
    bool good = look_around(w, c->ends[0], p, q);
    if (!good || w->change_count == 0)
        return good;
    const change *a = &w->changes[0], *b = &w->changes[1];
    if (w->change_count == 1) /* an operand that is not closed */
        return put_stretch(w, c, p, q, (const uint32_t[2]){a->face, EDGE_NO_FACE}, EDGE_BORDER);
    const change *begin = a->begins ? a : b, *end = a->begins ? b : a;
    /* The winding of the face at which the solid ends has the line in this order. */
    const uint32_t faces[2] = {end->face, begin->face};
    if (w->change_count > 2)
        return put_stretch(w, c, p, q, faces, EDGE_BORDER);
    return put_stretch(w, c, p, q, faces, judge(w, c, begin, end));
}

/* Is no other operand near? Then the edge bounds the solid, or it does not, as a whole. */
static bool is_alone(const arounder *w, const solid_candidate *c)
{
    const solid_builder *b = w->b;
    if (c->vertex[0] == NO_VERTEX || c->faces[1] == EDGE_NO_FACE)
        return false;
    uint32_t own = b->solid->operands[c->faces[0]];
    if (b->parts[own].crossed || (b->lined[c->faces[0]] | b->lined[c->faces[1]]) & SOLID_THIN)
        return false;
    box3 box = box3_empty();
    for (int k = 0; k < 2; k++)
        box = box3_with_point(box, b->mesh->positions[c->vertex[k]]);
    for (size_t i = 0; i < b->parts[own].meet_count; i++)
        if (boxes_meet(&b->parts[b->meets[b->parts[own].first_meet + i]].box, &box))
            return false;
    return true;
}

static bool take_alone(arounder *w, const solid_candidate *c)
{
    const solid_builder *b = w->b;
    if (!b->parts[b->solid->operands[c->faces[0]]].alone)
        return true;
    const solid_face *f = &b->faces[c->faces[0]], *g = &b->faces[c->faces[1]];
    double3           across = double3_cross(f->normal, g->normal);
    uint32_t          outline = double3_dot(across, w->along) > 0 ? EDGE_CANDIDATE : EDGE_CANDIDATE | EDGE_HOLLOW;
    return put_stretch(w, c, c->ends[0], c->ends[1], c->faces, c->flags & EDGE_CREASE ? c->flags : c->flags | outline);
}

/* Makes ready for a line; false where it has no length. */
static bool set_line(arounder *w, double3 from, double3 to, double *length)
{
    double3 way = double3_minus(to, from);
    *length = double3_length(way);
    if (!(*length > 0))
        return false;
    w->along = (double3){way.x / *length, way.y / *length, way.z / *length};
    double3 least = fabs(w->along.x) < 0.6 ? (double3){1, 0, 0} : (double3){0, 1, 0},
            side = double3_cross(w->along, least);
    double wide = double3_length(side);
    w->side = (double3){side.x / wide, side.y / wide, side.z / wide};
    w->up = double3_cross(w->along, w->side);
    return true;
}

/* Where the next stretch ends, `*next` being the break to look at first. */
static double end_of_stretch(const arounder *w, double done, double length, size_t *next)
{
    while (*next < w->break_count && w->breaks[*next] - done <= w->b->near)
        ++*next;
    return *next < w->break_count ? w->breaks[(*next)++] : length;
}

static bool take_candidate(arounder *w, const solid_candidate *c)
{
    double length, done = 0;
    if (!set_line(w, c->ends[0], c->ends[1], &length))
        return true;
    if (is_alone(w, c))
        return take_alone(w, c);
    if (!find_near(w, c->ends[0], length))
        return false;
    if (w->break_count)
        qsort(w->breaks, w->break_count, sizeof *w->breaks, compare_doubles);
    double3 p = c->ends[0];
    for (size_t next = 0; done < length;) {
        double  at = end_of_stretch(w, done, length, &next);
        double3 q = at == length ? c->ends[1] : double3_plus(c->ends[0], w->along, at);
        if (!take_stretch(w, c, p, q))
            return false;
        p = q;
        done = at;
    }
    return true;
}

/* --- lines in one face ---------------------------------------------------------------------------------- */

struct solid_trimmer {
    arounder     w;
    solid_share *shares;
    size_t       count, capacity;
};

solid_trimmer *solid_trimmer_create(const edge_solid *s)
{
    solid_trimmer *t = mem_calloc(1, sizeof *t);
    if (t && !open_arounder(&t->w, s->ground))
        solid_trimmer_destroy(&t);
    return t;
}

void solid_trimmer_destroy(solid_trimmer **t)
{
    if (!*t)
        return;
    release(&(*t)->w);
    mem_free((*t)->shares);
    mem_free(*t);
    *t = NULL;
}

/* Does the solid begin or end with the face, on either side of the line? Of several faces in one plane it is the one
 * that people see. */
static bool bounds_here(const arounder *w, uint32_t face)
{
    const uint32_t *operands = w->b->solid->operands;
    for (size_t i = 0; i < w->change_count; i++)
        for (size_t k = 0; k < w->fans[w->changes[i].fan].count; k++)
            if (w->halves[w->fans[w->changes[i].fan].first + k].face == face &&
                operands[w->changes[i].face] == operands[face])
                return true;
    return false;
}

static bool put_share(solid_trimmer *t, double from, double to)
{
    if (t->count && t->shares[t->count - 1].to == from) {
        t->shares[t->count - 1].to = to;
        return true;
    }
    if (!mem_grow((void **)&t->shares, &t->capacity, t->count + 1, sizeof *t->shares))
        return false;
    t->shares[t->count++] = (solid_share){from, to};
    return true;
}

bool solid_trim(solid_trimmer *t, uint32_t face, const double from[3], const double to[3], const solid_share **out,
                size_t *count)
{
    arounder *w = &t->w;
    double3   a = {from[0], from[1], from[2]}, b = {to[0], to[1], to[2]}, p = a;
    double    length, done = 0;
    t->count = 0;
    *out = NULL;
    *count = 0;
    if (!set_line(w, a, b, &length))
        return true;
    if (!find_near(w, a, length))
        return false;
    if (w->break_count)
        qsort(w->breaks, w->break_count, sizeof *w->breaks, compare_doubles);
    for (size_t next = 0; done < length;) {
        double  at = end_of_stretch(w, done, length, &next);
        double3 q = at == length ? b : double3_plus(a, w->along, at);
        if (!look_around(w, a, p, q) || w->failed ||
            (bounds_here(w, face) && !put_share(t, done / length, at / length)))
            return false;
        p = q;
        done = at;
    }
    *out = t->shares;
    *count = t->count;
    return true;
}

/* --- all ------------------------------------------------------------------------------------------------ */

typedef struct around_job {
    const solid_builder *b;
    solid_stretches     *blocks;
    atomic_bool          failed;
} around_job;

static void take_blocks(size_t begin, size_t end, void *user)
{
    around_job *job = user;
    arounder    w = {.b = NULL};
    bool        good = open_arounder(&w, job->b);
    for (size_t k = begin; k < end && good; k++) {
        size_t last = (k + 1) * BLOCK < job->b->candidate_count ? (k + 1) * BLOCK : job->b->candidate_count;
        w.out = &job->blocks[k];
        for (size_t i = k * BLOCK; i < last && good; i++)
            good = take_candidate(&w, &job->b->candidates[i]) && !w.failed;
        good = good && !work_stopped();
    }
    if (!good)
        atomic_store(&job->failed, true);
    release(&w);
}

lmn_status solid_bound(const solid_builder *b, solid_stretches *out, lmn_error *error)
{
    size_t     count = (b->candidate_count + BLOCK - 1) / BLOCK, total = 0, at = 0;
    around_job job = {.b = b, .blocks = mem_calloc(count + 1, sizeof *job.blocks)};
    memset(out, 0, sizeof *out);
    if (job.blocks)
        threads_for(count, 1, take_blocks, &job);
    bool good = job.blocks && !atomic_load(&job.failed);
    for (size_t i = 0; i < count && good; i++)
        total += job.blocks[i].count;
    out->items = good ? mem_alloc((total + 1) * sizeof *out->items) : NULL;
    for (size_t i = 0; i < count && job.blocks; at += job.blocks[i++].count) {
        if (out->items && job.blocks[i].count)
            memcpy(out->items + at, job.blocks[i].items, job.blocks[i].count * sizeof *out->items);
        mem_free(job.blocks[i].items);
    }
    out->count = out->items ? total : 0;
    mem_free(job.blocks);
    return out->items ? LMN_OK : error_memory(error);
}
