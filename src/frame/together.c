/* Figures whose lines look at each other's surfaces share one geometry pass: each would draw all that the others have,
 * once more. In the shared G-buffer a surface's id tells its figure, as in layers (layered.c). */
#include "frame/frame_private.h"

#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"
#include "lines/lines.h"

/* Does a technique change pictures of the geometry pass that others read? What it makes for itself alone is its own. */
static bool changes_geometry(kind_id id, const technique_use *use, bool deferred)
{
    for (size_t i = 0; i < use->technique->pass_count; i++) {
        const pass  *p = &use->technique->passes[i];
        const target written[] = {p->writes, p->writes_too};
        for (int k = 0; k < 2 && pass_applies(id, p, use); k++)
            if (written[k] && written[k] < TARGET_COUNT && target_rows[written[k]].owner == OWNER_LAYER &&
                written[k] != TARGET_NORMAL_DEPTH && !(deferred && written[k] == TARGET_SHADE))
                return true;
    }
    return false;
}

static bool reads_contrast(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        if (((const lines_common *)r->uses[KIND_LINES][i].values)->contrast > 0)
            return true;
    return false;
}

/* A figure that is drawn from its G-buffer alone, whoever filled it. */
static bool may_share(const frame *f, const figure *fig)
{
    const rule *r = fig->rule;
    if (!fig->complement || fig->layered || fig->mover || fig->direct || fig->reflects || f->maps || f->mirror)
        return false;
    for (int k = 0; k < KIND_COUNT; k++)
        for (size_t i = 0; i < r->use_counts[k]; i++)
            if (changes_geometry((kind_id)k, &r->uses[k][i], fig->deferred))
                return false;
    /* Of several line techniques the ink of each is folded into the fill. */
    return fig->deferred || (r->use_counts[KIND_LINES] == 1 && !figure_has_marks(fig) && !reads_contrast(r));
}

size_t together_count(const frame *f, const figure *figures, size_t count)
{
    size_t n = 0;
    while (n < count && n < FIGURES_TOGETHER_MAX && figures[n].deferred == figures[0].deferred &&
           may_share(f, &figures[n]))
        n++;
    return n;
}

/* The pictures of the shared geometry pass that the figure asked for, as if it had drawn them. */
static void lend(figure_state *s, gpu_texture *const *lent)
{
    static const struct {
        unsigned channel;
        target   picture;
    } rows[] = {{CHANNEL_NORMAL_DEPTH, TARGET_NORMAL_DEPTH},
                {CHANNEL_ID, TARGET_ID},
                {CHANNEL_ALBEDO, TARGET_ALBEDO},
                {CHANNEL_SHADE, TARGET_SHADE},
                {CHANNEL_REST, TARGET_REST}};
    s->targets[TARGET_DEPTH] = lent[TARGET_DEPTH];
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++)
        if (s->figure->channels & rows[i].channel)
            s->targets[rows[i].picture] = lent[rows[i].picture];
}

static void take_back(figure_state *s, gpu_texture *const *lent)
{
    for (int t = 0; t < TARGET_COUNT; t++)
        if (s->targets[t] == lent[t])
            s->targets[t] = NULL;
}

/* Is the figure its fill with lines of geometry on it? Then all fills can be drawn at once, before the lines, which are
 * in few places. */
static bool may_stand_apart(const figure *fig)
{
    const technique_use *compose = rule_use(fig->rule, KIND_COMPOSE);
    const pass          *p = compose ? compose->technique->passes : NULL;
    return !fig->deferred && compose && compose->technique->pass_count == 1 && !p->geometry &&
           p->writes == TARGET_PAGE && p->blend == BLEND_OVER && !rule_merged_detection(fig->rule) &&
           technique_draws_strokes(fig->rule->uses[KIND_LINES][0].technique);
}

static bool stand_apart(const figure_state *states, int count)
{
    bool apart = count > 1;
    for (int i = 0; i < count; i++)
        apart = apart && may_stand_apart(states[i].figure);
    return apart;
}

/* One figure's fill alone. */
static void draw_fill(frame *f, const figure_state *from, gpu_texture *const *lent)
{
    rule         bare = *from->figure->rule;
    figure       fill = *from->figure;
    figure_state s = *from;
    bare.use_counts[KIND_LINES] = 0;
    fill.rule = &bare;
    s.figure = &fill;
    s.filled = true;
    lend(&s, lent);
    figure_find_boxes(f, &s);
    passes_run_kind(f, &s, KIND_COMPOSE);
    take_back(&s, lent);
    mem_free(s.boxes);
}

/* Are all fills composed alike? Those of ghost images are paler. */
static bool fill_alike(const figure_state *states, int count)
{
    bool alike = true;
    for (int i = 1; i < count; i++)
        alike = alike && states[i].figure->rule->pale == states[0].figure->rule->pale;
    return alike;
}

/* The fills of all figures as one figure without lines. */
static void draw_all_fills(frame *f, figure_state *states, int count, gpu_texture *const *lent)
{
    const plan  *p = f->plan;
    rule         bare = *states[0].figure->rule;
    figure       all = *states[0].figure;
    figure_state s = states[0];
    bool        *designated = mem_calloc(p->part_count + 1, sizeof *designated);
    if (!designated) {
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
        return;
    }
    bare.use_counts[KIND_LINES] = 0;
    all.rule = &bare;
    all.designated = designated;
    all.complement = false;
    all.part_count = 0;
    for (size_t i = 0; i < p->part_count; i++) {
        for (int k = 0; k < count; k++)
            designated[i] = designated[i] || states[k].figure->designated[i];
        all.part_count += designated[i];
        all.complement = all.complement || (p->opaque[i] && !designated[i]);
    }
    s.figure = &all;
    s.shared = false;
    s.filled = true;
    for (int k = 1; k < count; k++) {
        camera_widen_pixels(s.pixels, states[k].pixels);
        camera_widen_pixels(s.around, states[k].around);
    }
    lend(&s, lent);
    figure_find_boxes(f, &s);
    passes_run_kind(f, &s, KIND_COMPOSE);
    take_back(&s, lent);
    mem_free(s.boxes);
    mem_free(designated);
}

static void draw_fills(frame *f, figure_state *states, int count, gpu_texture *const *lent)
{
    if (fill_alike(states, count))
        draw_all_fills(f, states, count, lent);
    else
        for (int i = 0; i < count; i++)
            draw_fill(f, &states[i], lent);
}

void together_draw(frame *f, const figure *figures, size_t count)
{
    figure_state *states = mem_calloc(count, sizeof *states);
    gpu_texture  *lent[TARGET_COUNT] = {NULL};
    int           opened = 0;
    if (!states)
        gpu_fail(f->g, LMN_MEMORY, "out of memory");
    for (size_t i = 0; i < count && states; i++)
        if (figure_open(f, &states[opened], &figures[i])) {
            states[opened].index = opened;
            states[opened].shared = true;
            opened++;
        }
    if (opened)
        raster_together(f, states, opened, lent);
    const bool apart = stand_apart(states, opened);
    if (apart && !gpu_failed(f->g))
        draw_fills(f, states, opened, lent);
    for (int i = 0; i < opened; i++) {
        states[i].apart = apart;
        lend(&states[i], lent);
        figure_finish(f, &states[i]);
        take_back(&states[i], lent);
        figure_release(f, &states[i]);
    }
    for (int t = 0; t < TARGET_COUNT; t++)
        gpu_target_release(f->g, lent[t]);
    mem_free(states);
}
