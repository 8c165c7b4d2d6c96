/* Which marks are drawn, on the CPU, for files of vectors: the same decisions as surface/marks.glsl and
 * surface/stipple.vert make on the GPU (EX-07), hidden ones dropped by whoever knows what hides them. */
#include "marks/marks.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

static const double BRIGHTEST = 1.15; /* tone: what is nearly white is paper where it is lit */
static const float  THINNEST = 0.03f; /* pixels: what flows thinner is not seen */

typedef struct position_on_page {
    double eye[3], normal[3]; /* towards the viewer's side */
    float  x, y;              /* pixels, y down */
    double facing;            /* cosine between normal and view; below 0 it turns away */
    bool   inside;            /* in front of the eye */
} position_on_page;

typedef struct pager {
    const mark_view  *view;
    const mark_style *style;
    double            focal;
    double            cofactors[9], determinant; /* of model_view, the latter without its sign */
    bool              backs;                     /* what turns away is left to who knows what hides it */
} pager;

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void move_point(const mat4 *m, vec3 p, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * (double)p.x + m->m[4 + k] * (double)p.y + m->m[8 + k] * (double)p.z + m->m[12 + k];
}

static void move_direction(const mat4 *m, vec3 p, double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = m->m[k] * (double)p.x + m->m[4 + k] * (double)p.y + m->m[8 + k] * (double)p.z;
}

static bool on_page(const pager *g, const double eye[3], float *x, float *y)
{
    const double *p = g->view->projection.m;
    double        w = p[3] * eye[0] + p[7] * eye[1] + p[11] * eye[2] + p[15];
    if (!(w > 0))
        return false;
    double cx = (p[0] * eye[0] + p[4] * eye[1] + p[8] * eye[2] + p[12]) / w,
           cy = (p[1] * eye[0] + p[5] * eye[1] + p[9] * eye[2] + p[13]) / w;
    *x = (float)((0.5 + 0.5 * cx) * g->view->width);
    *y = (float)((0.5 - 0.5 * cy) * g->view->height);
    return true;
}

/* `area`: how much larger the surface is there than in the model's own axes. */
static position_on_page find_position(const pager *g, vec3 position, vec3 normal, double *area)
{
    position_on_page p = {.inside = true};
    move_point(&g->view->model_view, position, p.eye);
    const double n[3] = {(double)normal.x, (double)normal.y, (double)normal.z};
    for (int k = 0; k < 3; k++)
        p.normal[k] = g->cofactors[k] * n[0] + g->cofactors[3 + k] * n[1] + g->cofactors[6 + k] * n[2];
    *area = fmax(sqrt(dot(p.normal, p.normal)), 1e-300);
    for (int k = 0; k < 3; k++)
        p.normal[k] /= *area;
    p.facing = g->view->orthographic ? p.normal[2] : -dot(p.eye, p.normal) / fmax(sqrt(dot(p.eye, p.eye)), 1e-300);
    p.inside = on_page(g, p.eye, &p.x, &p.y);
    return p;
}

/* How dark a position shall be, 0 … 1: light/light.glsl and surface/halftone/tone.glsl in doubles. */
static float darkness_at(const pager *g, const position_on_page *p, float bright)
{
    const double     luminance[3] = {0.2126, 0.7152, 0.0722};
    const mark_view *v = g->view;
    double           sum = 0, side = p->facing < 0 ? -1 : 1;
    for (int i = 0; i < v->light_count; i++) {
        double to[3], strength = 0, length = 1;
        for (int k = 0; k < 3; k++) {
            to[k] = (double)v->lights[i][k] - (v->lights[i][3] > 0.5f ? p->eye[k] : 0);
            strength += luminance[k] * (double)v->colours[i][k];
        }
        if (v->lights[i][3] > 0.5f)
            length = fmax(sqrt(dot(to, to)), 1e-300);
        sum += strength * fmax(side * dot(p->normal, to) / length, 0);
    }
    double bent = pow(fmin(fmax(sum, 0), 1), (double)g->style->contrast);
    double tone = (double)g->style->shadow + ((double)g->style->light - (double)g->style->shadow) * bent;
    /* More light than paper has is no reason to lose what is dark by itself: surface/marks.glsl. */
    tone = fmin(tone, BRIGHTEST) * (1 + (pow(fmin(fmax((double)bright, 0), 1), 1 / 2.2) - 1) *
                                            (double)g->style->texture); /* brightness as the eye counts it */
    double darkness = g->style->white ? tone : 1 - tone;
    return (float)fmin(fmax(darkness, 0), 1);
}

/* --- dots ----------------------------------------------------------------------------------------------- */

static uint32_t part_of(const marks *m, uint32_t triangle)
{
    return m->parts ? m->parts[triangle] + 1 : 0;
}

static bool add_dot(marks_page *out, marks_page_point dot)
{
    if (!mem_grow((void **)&out->dots, &out->dot_capacity, out->dot_count + 1, sizeof *out->dots))
        return false;
    out->dots[out->dot_count++] = dot;
    return true;
}

/* The diameter of a dot in this view; 0: it is not drawn. */
static float dot_size(const pager *g, const marks *m, const mark_dot *d, float *x, float *y)
{
    double           stretch;
    position_on_page p = find_position(g, d->position, d->normal, &stretch);
    float            margin = g->style->diameter;
    if (!p.inside || (p.facing <= 0 && !g->backs) || p.x < -margin || p.y < -margin ||
        p.x > (float)g->view->width + margin || p.y > (float)g->view->height + margin)
        return 0;
    *x = p.x;
    *y = p.y;
    /* Dots to a pixel when all are drawn, against what this darkness needs. */
    double pixels = mark_page_area(p.eye, p.normal, g->focal, g->view->orthographic) * stretch;
    double all = (double)m->dot_count / m->area / fmax(pixels, 1e-300);
    float  rim = g->style->pixels ? 1 / (g->style->diameter * g->style->diameter) : 0;
    double needed = (double)mark_ink_of_cover(darkness_at(g, &p, d->bright), rim) /
                    (0.78539816 * (double)g->style->diameter * (double)g->style->diameter);
    float ink = mark_dot_ink(d->priority, (float)(needed / all), g->style->fade, g->style->most);
    return g->style->diameter * sqrtf(ink);
}

/* --- rims of dots: a disc ends where its surface does, so one that mostly hangs over is left out, as the GPU cuts it
 * off --- */

enum { RIM = 6 };

static void to_model(const pager *g, const double eye[3], double out[3])
{
    const double *shift = &g->view->model_view.m[12];
    for (int k = 0; k < 3; k++)
        out[k] = (g->cofactors[3 * k] * (eye[0] - shift[0]) + g->cofactors[3 * k + 1] * (eye[1] - shift[1]) +
                  g->cofactors[3 * k + 2] * (eye[2] - shift[2])) /
                 g->determinant;
}

/* Positions around a dot on its plane: RIM a little above the surface, then as many a little below. */
static void find_rim(const pager *g, const mark_dot *d, float size, double (*out)[3])
{
    double           stretch, direction[3] = {0, 0, -1};
    position_on_page p = find_position(g, d->position, d->normal, &stretch);
    double           pixel = (g->view->orthographic ? 1 : -p.eye[2]) / g->focal, radius = 0.5 * (double)size,
           c = fmin(fabs(p.facing), 1);
    double steep = fmin(sqrt(1 - c * c) / fmax(c, 0.05), 8), reach = pixel * (radius + 1) * (1 + 2 * steep);
    for (int i = 0; i < RIM; i++) {
        double angle = 2 * 3.14159265358979323846 * i / RIM,
               at[3] = {radius * pixel * cos(angle), radius * pixel * sin(angle), 0};
        double off = dot(p.normal, at), length = 1;
        for (int k = 0; k < 3; k++)
            at[k] += p.eye[k];
        if (!g->view->orthographic) {
            length = fmax(sqrt(dot(at, at)), 1e-300);
            for (int k = 0; k < 3; k++)
                direction[k] = at[k] / length;
        }
        double along = dot(p.normal, direction), most = 8 * radius * pixel;
        double t = fabs(along) > 1e-6 ? fmin(fmax(-off / along, -most), most) : 0;
        for (int side = 0; side < 2; side++) {
            double eye[3];
            for (int k = 0; k < 3; k++)
                eye[k] = at[k] + (t + (side ? reach : -reach)) * direction[k];
            to_model(g, eye, out[side * RIM + i]);
        }
    }
}

/* Does at least half of a disc lie on what is seen of its surface? There, nothing is in front a little above, and
 * something a little below. What is outside the page counts. */
static bool lies_on_surface(const pager *g, const mark_dot *d, float size, mark_hidden_fn hidden, void *user)
{
    double   positions[2 * RIM][3];
    uint32_t front[2 * RIM];
    int      own = 0;
    find_rim(g, d, size, positions);
    hidden(user, (const double(*)[3])positions, 2 * RIM, front);
    for (int i = 0; i < RIM; i++)
        own += front[i] == UINT32_MAX || (front[i] == 0 && front[RIM + i] > 0);
    return 2 * own >= RIM;
}

static lmn_status dots_visible(marks_page *out, const pager *g, const marks *m, mark_hidden_fn hidden, void *user,
                               lmn_error *error)
{
    size_t first = out->dot_count, count = 0;
    double(*positions)[3] = mem_alloc(m->dot_count * sizeof *positions);
    uint32_t *numbers = mem_alloc(m->dot_count * sizeof *numbers);
    uint32_t *behind = mem_calloc(m->dot_count, sizeof *behind);
    bool      done = positions && behind && numbers;
    for (size_t i = 0; done && i < m->dot_count; i++) {
        float x = 0, y = 0, size = dot_size(g, m, &m->dots[i], &x, &y);
        if (!(size > 0))
            continue;
        const vec3  *at = &m->dots[i].position;
        const double position[3] = {(double)at->x, (double)at->y, (double)at->z};
        numbers[count] = (uint32_t)i;
        memcpy(positions[count++], position, sizeof position);
        done = add_dot(out, (marks_page_point){x, y, size, part_of(m, m->dots[i].triangle)});
    }
    if (done && hidden && count > 0) {
        hidden(user, (const double(*)[3])positions, count, behind);
        out->dot_count = first;
        for (size_t i = 0; i < count; i++)
            if (behind[i] == 0 && lies_on_surface(g, &m->dots[numbers[i]], out->dots[first + i].width, hidden, user))
                out->dots[out->dot_count++] = out->dots[first + i];
    }
    mem_free(positions);
    mem_free(numbers);
    mem_free(behind);
    return done ? LMN_OK : error_memory(error);
}

/* --- strokes -------------------------------------------------------------------------------------------- */

/* Width of a stroke, fraction of the style's, decided at its middle. */
static float stroke_ink(const pager *g, const mark_line *l)
{
    double           stretch, direction[3];
    position_on_page p = find_position(g, l->middle, l->middle_normal, &stretch);
    if (!p.inside || (p.facing <= 0 && !g->backs))
        return 0;
    move_direction(&g->view->model_view, l->middle_direction, direction);
    double length = fmax(sqrt(dot(direction, direction)), 1e-300);
    for (int k = 0; k < 3; k++)
        direction[k] /= length;
    /* Ink where it is darkest, and what all strokes would have, of lines side by side. */
    double darkest = (double)g->style->diameter * (1 - (double)g->style->taper) / (double)g->style->scale;
    double d = g->focal * stretch / length / fmax((double)l->density * (double)g->style->scale, 1e-300);
    double fraction = mark_fraction((mark_law)g->style->law, p.eye, p.normal, direction, d, g->view->orthographic);
    float  darkness = darkness_at(g, &p, l->bright);
    bool   equalised = !g->style->by_priority || l->span > 0;
    double ink = equalised ? (double)mark_ink_of_strokes(darkness, (float)darkest, l->span, g->style->crowded) / darkest
                           : (double)darkness;
    return mark_line_ink(l, (float)fmin(ink, 1), (float)fraction, g->style->fade);
}

/* Pixels to a unit across a line that flows, at an end of a piece. `along`: the piece's direction in eye axes. */
static double across_at(const pager *g, const mark_line *l, const position_on_page *p, double along[3])
{
    move_direction(&g->view->model_view, (vec3){l->b.x - l->a.x, l->b.y - l->a.y, l->b.z - l->a.z}, along);
    double length = fmax(sqrt(dot(along, along)), 1e-300);
    for (int k = 0; k < 3; k++)
        along[k] /= length;
    return mark_fraction(MARK_LAW_LINE, p->eye, p->normal, along, g->focal, g->view->orthographic);
}

/* Where the hand puts an end: beside the line, on the page by so many distances as in surface/marks_lines.vert. */
static vec3 strayed(const pager *g, const mark_line *l, int end)
{
    const flow_end *e = &l->ends[end];
    vec3            at = end ? l->b : l->a;
    double          stretch, along[3], by = (double)g->style->stray * (double)e->shift * (double)g->style->scale;
    if (by == 0)
        return at;
    position_on_page p = find_position(g, at, e->normal, &stretch);
    /* At a grazing angle less than distances on the page. */
    double across =
        fmax(across_at(g, l, &p, along), 0.5 * g->focal / (g->view->orthographic ? 1 : fmax(-p.eye[2], 1e-20)));
    double d[3] = {(double)l->b.x - (double)l->a.x, (double)l->b.y - (double)l->a.y, (double)l->b.z - (double)l->a.z};
    double n[3] = {(double)e->normal.x, (double)e->normal.y, (double)e->normal.z};
    double aside[3] = {n[1] * d[2] - n[2] * d[1], n[2] * d[0] - n[0] * d[2], n[0] * d[1] - n[1] * d[0]};
    by /= fmax(across, 1e-20) * fmax(sqrt(dot(aside, aside)), 1e-300);
    return (vec3){at.x + (float)(by * aside[0]), at.y + (float)(by * aside[1]), at.z + (float)(by * aside[2])};
}

/* Is a face without room for lines black where lines shall cover so much? */
static bool is_black(const mark_style *style, double cover)
{
    return (style->white ? 1 - cover : cover) >= (double)style->black;
}

/* What is left of a cover on a face of so many distances: the first set fills one that has no room for it; further
 * ones, which need more, are only left out. */
static double in_room(const mark_style *style, double cover, double dark, double distances, int set)
{
    double roomy = mark_flow_room(distances, (double)style->room * (1 + set));
    bool   filled = set == 0 && style->black > 0 && is_black(style, dark) != style->white;
    return roomy * cover + (filled ? (1 - roomy) * FLOW_FILLED : 0);
}

/* How wide a line that flows is at an end of a piece, pixels: surface/marks_lines.vert in doubles. */
static float flow_width(const pager *g, const marks *m, const mark_line *l, int end)
{
    const flow_end  *e = &l->ends[end];
    double           stretch, direction[3];
    position_on_page p = find_position(g, end ? l->b : l->a, e->normal, &stretch);
    if (!p.inside || (p.facing <= 0 && !g->backs))
        return 0;
    double least = (double)g->style->least;
    double across = across_at(g, l, &p, direction), scale = (double)g->style->scale,
           level = log2(fmax(m->apart * across / scale, 1e-6));
    double dark =
        mark_flow_gradient((double)darkness_at(g, &p, e->bright), e, (double)g->style->gradient, g->style->white);
    double cover = mark_cover_of_set(dark, (double)g->style->crossed, l->set, g->style->series, g->style->steady) *
                   mark_flow_swell(l, (double)g->style->swell) *
                   mark_flow_hand(l, e, (double)g->style->pressure, (double)g->style->patchy);
    double sparse = g->style->sparse > 0 && l->set == 0
                        ? mark_flow_sparse(l, (double)e->to_edge * across / scale, (double)g->style->sparse, least)
                        : 0;
    cover = g->style->white ? fmin(cover, 1 - sparse) : fmax(cover, sparse);
    cover = in_room(g->style, cover, dark, (double)e->room * across / scale, l->set);
    double low = least / (1 + 5 * (double)g->style->fade),
           thin = least > 0 ? fmin(fmax((cover - low) / (least - low), 0), 1) : 1;
    double to_end = (double)e->to_end * across / scale;
    cover *= thin * thin * (3 - 2 * thin);
    cover *= mark_flow_grazing(p.facing, dark);
    double width = mark_flow_width(l, e->spaces, m->apart, m->levels, level, cover) * across;
    double most = g->style->widest < FLOW_ANY_WIDTH ? (double)g->style->widest * scale : INFINITY;
    most = g->style->black > 0 && !g->style->white ? fmin(most, (double)e->room * across) : most;
    return (float)(fmin(width, most) * mark_flow_tip(to_end, (double)g->style->taper, (double)g->style->tip, cover,
                                                     (double)g->style->join));
}

/* What ends leave of the width. */
static float taper_at(const pager *g, const mark_line *l, float along)
{
    float run = g->style->taper * l->length, to_end = fminf(along, l->length - along);
    if (g->style->stands > 0)
        to_end = 0.5f * (l->length - along);
    return run > 0 ? fminf(fmaxf(to_end / run, 0), 1) : 1;
}

typedef struct stretch_walk {
    marks_page    *out;
    const pager   *g;
    const marks   *marks;
    bool           open; /* a line of the page is being continued */
    mark_hidden_fn hidden;
    void          *user;
} stretch_walk;

static bool add_point(stretch_walk *w, const mark_line *l, float x, float y, float width)
{
    marks_page *out = w->out;
    if (!mem_grow((void **)&out->points, &out->point_capacity, out->point_count + 1, sizeof *out->points))
        return false;
    if (!w->open) {
        if (!mem_grow((void **)&out->lines, &out->line_capacity, out->line_count + 1, sizeof *out->lines))
            return false;
        out->lines[out->line_count++] = (marks_page_line){
            .first = (uint32_t)out->point_count, .stroke = l->stroke, .part = part_of(w->marks, l->triangle)};
        w->open = true;
    }
    out->points[out->point_count++] = (marks_page_point){x, y, width, 0};
    out->lines[out->line_count - 1].count++;
    return true;
}

/* Lines of one point are none; nor are, of lines that flow, stubs that look out from behind an outline. */
static bool is_line(const stretch_walk *w, const marks_page_line *l)
{
    const marks_page_point *p = &w->out->points[l->first];
    float                   length = 0, widest = p->width;
    for (uint32_t i = 1; i < l->count; i++) {
        length += hypotf(p[i].x - p[i - 1].x, p[i].y - p[i - 1].y);
        widest = fmaxf(widest, p[i].width);
    }
    return l->count >= 2 && (!w->marks->flow || length > 1.5f * widest);
}

static void close_line(stretch_walk *w)
{
    marks_page *out = w->out;
    if (w->open && !is_line(w, &out->lines[out->line_count - 1])) {
        out->point_count -= out->lines[out->line_count - 1].count;
        out->line_count--;
    }
    w->open = false;
}

/* From a piece to above the surface that it is a chord of, on the viewer's side: its own surface hides no stroke.
 * Twice as far as chords may leave it, since strokes run over folds of up to 60 degrees, of which the chord has one
 * side's normal. */
static void find_lift(const pager *g, const marks *m, const mark_line *l, double out[3])
{
    double stretch, lift = m->sag > 0 ? 2 * m->sag : 2 * MARK_SAG * (double)l->length;
    if (find_position(g, l->a, l->normal, &stretch).facing < 0)
        lift = -lift;
    out[0] = lift * (double)l->normal.x;
    out[1] = lift * (double)l->normal.y;
    out[2] = lift * (double)l->normal.z;
}

enum { SAMPLES_MAX = 64 };

/* Where a hand strays over an edge there is no surface: none a little below, as on the GPU none is seen in that depth.
 * `positions`: lifted. */
static void leave_out_strayed(const stretch_walk *w, const double (*positions)[3], const double lift[3], size_t count,
                              uint32_t *behind)
{
    const double BELOW = 2; /* pixels */
    double       below[SAMPLES_MAX + 1][3];
    uint32_t     front[SAMPLES_MAX + 1] = {0};
    double       length = fmax(sqrt(dot(lift, lift)), 1e-300);
    for (size_t i = 0; i < count; i++) {
        double eye[3];
        move_point(&w->g->view->model_view,
                   (vec3){(float)positions[i][0], (float)positions[i][1], (float)positions[i][2]}, eye);
        double down = BELOW * (w->g->view->orthographic ? 1 : fmax(-eye[2], 0)) / w->g->focal;
        for (int k = 0; k < 3; k++)
            below[i][k] = positions[i][k] - (1 + down / length) * lift[k];
    }
    w->hidden(w->user, (const double(*)[3])below, count, front);
    for (size_t i = 0; i < count; i++)
        if (front[i] == 0 && behind[i] == 0)
            behind[i] = 1;
}

/* One piece, in samples of about two pixels: those that something hides interrupt the line. `widths`: at both ends. */
static bool add_piece(stretch_walk *w, const mark_line *l, const float widths[2])
{
    double   positions[SAMPLES_MAX + 1][3], eye[3], lift[3];
    float    at[SAMPLES_MAX + 1][2];
    uint32_t behind[SAMPLES_MAX + 1] = {0};
    bool     there[SAMPLES_MAX + 1], hides = w->hidden != NULL;
    float    ends[2][2] = {{0, 0}, {0, 0}};
    find_lift(w->g, w->marks, l, lift);
    vec3 a = w->marks->flow ? strayed(w->g, l, 0) : l->a, b = w->marks->flow ? strayed(w->g, l, 1) : l->b;
    move_point(&w->g->view->model_view, a, eye);
    bool seen = on_page(w->g, eye, &ends[0][0], &ends[0][1]);
    move_point(&w->g->view->model_view, b, eye);
    seen = on_page(w->g, eye, &ends[1][0], &ends[1][1]) && seen;
    double apart =
        seen ? hypot((double)ends[1][0] - (double)ends[0][0], (double)ends[1][1] - (double)ends[0][1]) : SAMPLES_MAX;
    bool tapers = w->g->style->taper > 0 && !w->marks->flow;
    int  count = hides || tapers || !seen ? (int)fmin(fmax(ceil(apart / 2), 1), SAMPLES_MAX) : 1;
    for (int i = 0; i <= count; i++) {
        float s = (float)i / (float)count;
        vec3  p = {a.x + s * (b.x - a.x), a.y + s * (b.y - a.y), a.z + s * (b.z - a.z)};
        positions[i][0] = (double)p.x + lift[0];
        positions[i][1] = (double)p.y + lift[1];
        positions[i][2] = (double)p.z + lift[2];
        move_point(&w->g->view->model_view, p, eye);
        there[i] = on_page(w->g, eye, &at[i][0], &at[i][1]);
    }
    if (hides)
        w->hidden(w->user, (const double(*)[3])positions, (size_t)count + 1, behind);
    /* What is lifted over the nearest plane of all that is drawn is outside: asked again where it lies. */
    for (int i = 0; i <= count && hides; i++)
        if (behind[i] == UINT32_MAX) {
            const double own[1][3] = {
                {positions[i][0] - lift[0], positions[i][1] - lift[1], positions[i][2] - lift[2]}};
            w->hidden(w->user, own, 1, &behind[i]);
        }
    if (hides && w->marks->flow && w->g->style->stray > 0)
        leave_out_strayed(w, (const double(*)[3])positions, lift, (size_t)count + 1, behind);
    for (int i = w->open ? 1 : 0; i <= count; i++) {
        float part = (float)i / (float)count, along = l->from + part * (l->to - l->from),
              width = widths[0] + part * (widths[1] - widths[0]);
        if (!there[i] || behind[i] > 0)
            close_line(w);
        else if (!add_point(w, l, at[i][0], at[i][1], tapers ? width * taper_at(w->g, l, along) : width))
            return false;
    }
    return true;
}

/* Does a stroke turn away at its middle, with something in front of that? Then it is on the far side, and what
 * comes round from there is not drawn, as on the GPU. */
static bool is_far_side(const stretch_walk *w, const mark_line *l)
{
    double       stretch;
    const double middle[1][3] = {{(double)l->middle.x, (double)l->middle.y, (double)l->middle.z}};
    uint32_t     front = 0;
    if (!w->hidden || find_position(w->g, l->middle, l->middle_normal, &stretch).facing >= 0)
        return false;
    w->hidden(w->user, middle, 1, &front);
    return front > 0 && front != UINT32_MAX;
}

static void find_widths(const pager *g, const marks *m, const mark_line *l, float out[2])
{
    for (int end = 0; end < 2; end++)
        out[end] = m->flow ? flow_width(g, m, l, end) : end ? out[0] : g->style->diameter * stroke_ink(g, l);
    for (int end = 0; end < 2 && m->flow; end++)
        out[end] = out[end] < THINNEST ? 0 : out[end];
}

static lmn_status lines_visible(marks_page *out, const pager *g, const marks *m, mark_hidden_fn hidden, void *user,
                                lmn_error *error)
{
    stretch_walk w = {out, g, m, false, hidden, user};
    bool         done = true;
    for (size_t i = 0; i < m->line_count && done; i++) {
        const mark_line *l = &m->lines[i];
        if (i > 0 && l->stroke != m->lines[i - 1].stroke)
            close_line(&w);
        float widths[2];
        find_widths(g, m, l, widths);
        if (fmaxf(widths[0], widths[1]) > 0 && (m->flow || g->style->stands > 0 || !is_far_side(&w, l)))
            done = add_piece(&w, l, widths);
        else
            close_line(&w);
    }
    close_line(&w);
    return done ? LMN_OK : error_memory(error);
}

lmn_status marks_visible(marks_page *out, const marks *m, const mark_view *view, const mark_style *style,
                         mark_hidden_fn hidden, void *user, lmn_error *error)
{
    pager g = {
        .view = view, .style = style, .focal = view->projection.m[5] * view->height / 2, .backs = hidden != NULL};
    double determinant = mat4_cofactors(&view->model_view, g.cofactors);
    g.determinant = fmax(fabs(determinant), 1e-300);
    for (int k = 0; k < 9 && determinant < 0; k++)
        g.cofactors[k] = -g.cofactors[k];
    out->ink = style->ink;
    lmn_status status = LMN_OK;
    if (m->dot_count > 0)
        status = dots_visible(out, &g, m, hidden, user, error);
    if (m->line_count > 0 && status == LMN_OK)
        status = lines_visible(out, &g, m, hidden, user, error);
    return status;
}

void marks_page_release(marks_page *p)
{
    mem_free(p->dots);
    mem_free(p->lines);
    mem_free(p->points);
    memset(p, 0, sizeof *p);
}
