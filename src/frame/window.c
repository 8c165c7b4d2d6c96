/* Windows: a part of the page that is drawn as the whole page has it. All coordinates stay the page's, and so do
 * camera, strokes, paper and grain; only the boxes in which pixels are drawn get smaller. What lies in the window
 * depends on no pixel farther away than the margin, or the figure is drawn whole. */
#include <string.h>

#include "frame/frame_private.h"

void window_around(const frame *f, int margin, int out[4])
{
    const int limits[2] = {f->width, f->height};
    for (int k = 0; k < 2; k++) {
        bool whole = f->window[2] <= 0;
        int  low = whole ? 0 : f->window[k] - margin,
            high = whole ? limits[k] : f->window[k] + f->window[2 + k] + margin;
        low = low > 0 ? low : 0;
        high = high < limits[k] ? high : limits[k];
        out[k] = low;
        out[2 + k] = high - low;
    }
}

void window_clip(const frame *f, int margin, int box[4])
{
    int around[4];
    window_around(f, margin, around);
    for (int k = 0; k < 2 && f->window[2] > 0; k++) {
        int low = box[k] > around[k] ? box[k] : around[k], end = box[k] + box[2 + k], limit = around[k] + around[2 + k];
        box[k] = low;
        box[2 + k] = (end < limit ? end : limit) - low;
        box[2 + k] = box[2 + k] > 0 ? box[2 + k] : 0;
    }
}

/* Chains of lines run through the whole page; so do counts of what is covered, and what moves. */
static bool depends_on_page(const figure *fig)
{
    return fig->mover || rule_traces_lines(fig->rule) || (fig->hidden && rule_traces_lines(fig->hidden)) ||
           (fig->layered && (fig->layering.fraction > 0 || fig->focus || figure_has_marks(fig)));
}

static int margin_of(const figure *fig)
{
    return WINDOW_MARGIN + 2 * figure_reach(fig);
}

/* Edges of meshes are judged by how much of each is seen, however far it runs; so are marks. */
static bool looks_along_edges(const figure *fig)
{
    const rule *r = fig->rule;
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++) {
        const technique *t = r->uses[KIND_LINES][i].technique;
        for (size_t k = 0; k < t->pass_count; k++)
            if (t->passes[k].strokes || t->passes[k].records)
                return true;
    }
    return figure_has_marks(fig);
}

void window_figure(const frame *f, figure_state *s)
{
    if (f->window[2] <= 0 || depends_on_page(s->figure))
        return;
    window_clip(f, margin_of(s->figure), s->pixels);
    window_clip(f, margin_of(s->figure) + figure_reach(s->figure) + 2, s->around);
    if (looks_along_edges(s->figure))
        return;
    memcpy(s->drawn[0], s->pixels, sizeof s->drawn[0]);
    memcpy(s->drawn[1], s->around, sizeof s->drawn[1]);
}

int window_margin(const frame *f)
{
    int most = WINDOW_MARGIN;
    for (size_t i = 0; i < f->plan->figure_count; i++) {
        int margin = margin_of(&f->plan->figures[i]);
        most = margin > most ? margin : most;
    }
    return most;
}
