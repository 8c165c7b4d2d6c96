/* Sheets by cairo; texts through pango, so that every script finds a font. */
#include "export/cairo_sheet.h"

#include <math.h>
#include <pango/pangocairo.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"

typedef struct painter {
    const sheet *s;
    cairo_t     *context;
    bool         failed; /* memory is gone */
} painter;

typedef struct png_reader {
    const unsigned char *data;
    size_t               left;
} png_reader;

static cairo_status_t give_bytes(void *user, unsigned char *to, unsigned int size)
{
    png_reader *r = user;
    if (size > r->left)
        return CAIRO_STATUS_READ_ERROR;
    memcpy(to, r->data, size);
    r->data += size;
    r->left -= size;
    return CAIRO_STATUS_SUCCESS;
}

static void set_ink(cairo_t *c, colour ink)
{
    double alpha = ink.a < 1 ? fmax((double)ink.a, 0) : 1;
    cairo_set_source_rgba(c, (double)ink.r, (double)ink.g, (double)ink.b, alpha);
}

char *cairo_clean_text(const char *words)
{
    char *valid = g_utf8_make_valid(words, -1), *copy = mem_copy_text(valid);
    g_free(valid);
    for (char *at = copy; at && *at; at++)
        if ((unsigned char)*at < 0x20 || *at == 0x7F)
            *at = ' ';
    return copy;
}

/* By how much a cubic is off the arc that it stands for, of its radius. */
static double error_of_cubic(double sweep)
{
    double sine = sin(sweep / 4), cosine = cos(sweep / 4);
    return 2.0 / 27 * pow(sine, 6) / (cosine * cosine);
}

int cairo_arc_cubics(const sheet_piece *arc, double out[CAIRO_CUBICS_MOST][6])
{
    static const double widest = 2.2; /* radians */
    double              size = fabs(arc->sweep), radius = fmax(arc->radii[0], arc->radii[1]);
    int                 pieces = (int)fmin(fmax(ceil(size / widest), 1), CAIRO_CUBICS_MOST);
    while (pieces < CAIRO_CUBICS_MOST && radius * error_of_cubic(size / pieces) > CAIRO_ARC_ERROR)
        pieces++;
    double step = arc->sweep / pieces, handle = 4.0 / 3 * tan(step / 4);
    for (int i = 0; i < pieces; i++) {
        double begin = arc->from + i * step, end = begin + step;
        double unit[3][2] = {{cos(begin) - handle * sin(begin), sin(begin) + handle * cos(begin)},
                             {cos(end) + handle * sin(end), sin(end) - handle * cos(end)},
                             {cos(end), sin(end)}};
        for (int k = 0; k < 3; k++) {
            double x = arc->radii[0] * unit[k][0], y = arc->radii[1] * unit[k][1];
            out[i][2 * k] = arc->centre[0] + cos(arc->turn) * x - sin(arc->turn) * y;
            out[i][2 * k + 1] = arc->centre[1] + sin(arc->turn) * x + cos(arc->turn) * y;
        }
    }
    memcpy(out[pieces - 1] + 4, arc->end, sizeof arc->end);
    return pieces;
}

static void add_arc(cairo_t *c, const sheet_piece *arc)
{
    double cubics[CAIRO_CUBICS_MOST][6];
    for (int i = 0, count = cairo_arc_cubics(arc, cubics); i < count; i++)
        cairo_curve_to(c, cubics[i][0], cubics[i][1], cubics[i][2], cubics[i][3], cubics[i][4], cubics[i][5]);
}

static void add_pieces(painter *w, const sheet_path *path)
{
    cairo_t     *c = w->context;
    const float *from = w->s->points[path->first];
    cairo_move_to(c, (double)from[0], (double)from[1]);
    for (uint32_t i = 0; i < path->piece_count; i++) {
        const sheet_piece *p = &w->s->pieces[path->first_piece + i];
        switch (p->kind) {
        case SHEET_LINE: cairo_line_to(c, p->end[0], p->end[1]); break;
        case SHEET_ARC: add_arc(c, p); break;
        case SHEET_CUBIC:
            cairo_curve_to(c, p->controls[0][0], p->controls[0][1], p->controls[1][0], p->controls[1][1], p->end[0],
                           p->end[1]);
            break;
        }
    }
    if (path->closed || path->filled)
        cairo_close_path(c);
}

static void add_path(painter *w, const sheet_path *path, bool dots)
{
    cairo_t *c = w->context;
    if (path->piece_count && !dots) {
        add_pieces(w, path);
        return;
    }
    for (uint32_t i = 0; i < path->count; i++) {
        const float *p = w->s->points[path->first + i];
        if (i == 0 || dots)
            cairo_move_to(c, (double)p[0], (double)p[1]);
        if (i > 0 || dots)
            cairo_line_to(c, (double)p[0], (double)p[1]);
    }
    if (path->closed && !dots)
        cairo_close_path(c);
}

bool cairo_same_pen(const sheet_path *a, const sheet_path *b)
{
    return a == b ||
           (a->filled == b->filled && a->width == b->width && a->cap == b->cap && !a->dash_count && !b->dash_count);
}

static void set_dashes(painter *w, const sheet_path *path)
{
    double few[64], *lengths = path->dash_count > 64 ? mem_alloc(path->dash_count * sizeof *lengths) : few;
    w->failed = w->failed || !lengths;
    for (uint32_t i = 0; lengths && i < path->dash_count; i++)
        lengths[i] = (double)w->s->dashes[path->first_dash + i];
    cairo_set_dash(w->context, lengths, lengths ? (int)path->dash_count : 0, (double)path->phase);
    if (lengths != few)
        mem_free(lengths);
}

/* The lines over what the path encloses, and no farther. */
static void draw_hatch(cairo_t *c, const sheet_hatch *h)
{
    double box[4], along[2] = {cos(h->angle), sin(h->angle)}, low = INFINITY, high = -INFINITY, reach = 0;
    cairo_path_extents(c, &box[0], &box[1], &box[2], &box[3]);
    for (int k = 0; k < 4; k++) {
        double x = box[k & 1 ? 2 : 0] - h->origin[0], y = box[k & 2 ? 3 : 1] - h->origin[1],
               across = along[0] * y - along[1] * x;
        low = fmin(low, across);
        high = fmax(high, across);
        reach = fmax(reach, hypot(x, y));
    }
    cairo_save(c);
    cairo_clip(c);
    for (double at = ceil(low / h->apart) * h->apart; at <= high; at += h->apart)
        for (int k = -1; k <= 1; k += 2)
            (k < 0 ? cairo_move_to : cairo_line_to)(c, h->origin[0] - at * along[1] + k * reach * along[0],
                                                    h->origin[1] + at * along[0] + k * reach * along[1]);
    cairo_set_dash(c, NULL, 0, 0);
    cairo_set_line_width(c, h->width);
    cairo_stroke(c);
    cairo_restore(c);
}

static void draw_paths(painter *w, const sheet_item *item)
{
    cairo_t *c = w->context;
    bool     dots = item->kind == SHEET_DOTS;
    set_ink(c, item->ink);
    for (uint32_t k = 0; k < item->count;) {
        const sheet_path *first = &w->s->paths[item->first + k];
        for (; k < item->count && cairo_same_pen(first, &w->s->paths[item->first + k]); k++)
            add_path(w, &w->s->paths[item->first + k], dots);
        if (first->filled && !dots) {
            if (item->hatch.apart > 0)
                draw_hatch(c, &item->hatch);
            else
                cairo_fill(c);
            continue;
        }
        set_dashes(w, first);
        cairo_set_line_cap(c, dots || first->cap == SHEET_CAP_ROUND ? CAIRO_LINE_CAP_ROUND : CAIRO_LINE_CAP_BUTT);
        cairo_set_line_width(c, (double)first->width);
        cairo_stroke(c);
    }
}

static void draw_image(painter *w, const sheet_item *item)
{
    cairo_t         *c = w->context;
    cairo_surface_t *image =
        cairo_image_surface_create_from_png_stream(give_bytes, &(png_reader){item->png, item->png_size});
    if (cairo_surface_status(image) == CAIRO_STATUS_SUCCESS) {
        cairo_save(c);
        cairo_translate(c, item->box[0], item->box[1]);
        cairo_scale(c, item->box[2] / cairo_image_surface_get_width(image),
                    item->box[3] / cairo_image_surface_get_height(image));
        cairo_set_source_surface(c, image, 0, 0);
        cairo_paint(c);
        cairo_restore(c);
    }
    cairo_surface_destroy(image);
}

/* Letters stand where the font has them, not on whole units: these are millimetres. */
static void set_true_metrics(PangoLayout *layout)
{
    PangoContext         *context = pango_layout_get_context(layout);
    cairo_font_options_t *options = cairo_font_options_create();
    cairo_font_options_set_hint_style(options, CAIRO_HINT_STYLE_NONE);
    cairo_font_options_set_hint_metrics(options, CAIRO_HINT_METRICS_OFF);
    pango_cairo_context_set_font_options(context, options);
    pango_context_set_round_glyph_positions(context, FALSE);
    cairo_font_options_destroy(options);
    pango_layout_context_changed(layout);
}

/* One line of this size; the caller's. */
static PangoLayout *layout_of(cairo_t *c, const char *words, double size)
{
    PangoLayout *layout = pango_cairo_create_layout(c);
    set_true_metrics(layout);
    PangoFontDescription *font = pango_font_description_from_string("Liberation Sans, Arial, Helvetica, sans-serif");
    pango_font_description_set_absolute_size(font, size * PANGO_SCALE);
    pango_layout_set_font_description(layout, font);
    pango_layout_set_text(layout, words, -1);
    pango_font_description_free(font);
    return layout;
}

/* What stands between blanks. */
static bool find_words(cairo_letters *out, PangoLayout *layout, const char *words, double finer)
{
    for (size_t i = 0, end; words[i]; i = end) {
        size_t own = strcspn(words + i, " "), blank = strspn(words + i, " ");
        end = i + (own ? own : blank);
        if (!own)
            continue;
        if (!mem_grow((void **)&out->words, &out->word_capacity, out->word_count + 1, sizeof *out->words))
            return false;
        cairo_word *w = &out->words[out->word_count++];
        *w = (cairo_word){i, own, INFINITY, -INFINITY};
        for (int k = 0; k < 2; k++) { /* of scripts that run the other way the end is to the left */
            PangoRectangle place;
            pango_layout_index_to_pos(layout, (int)(k ? end : i), &place);
            w->left = fmin(w->left, (double)place.x / PANGO_SCALE / finer);
            w->right = fmax(w->right, (double)place.x / PANGO_SCALE / finer);
        }
    }
    return true;
}

void cairo_letters_release(cairo_letters *l)
{
    mem_free(l->steps);
    mem_free(l->words);
    *l = (cairo_letters){0};
}

bool cairo_find_letters(cairo_letters *out, const char *words, double size)
{
    static const double finer = 64; /* cairo keeps positions as multiples of 1/256 */
    static const char   kinds[] = {'m', 'l', 'c', 'h'};
    static const int    numbers[] = {2, 2, 6, 0};
    /* Without bounds: far beyond those of a surface cairo leaves letters out. */
    cairo_surface_t *surface = cairo_recording_surface_create(CAIRO_CONTENT_ALPHA, NULL);
    cairo_t         *context = cairo_create(surface);
    PangoLayout     *layout = layout_of(context, words, finer * size);
    int              width, height;
    pango_layout_get_size(layout, &width, &height);
    *out = (cairo_letters){.width = (double)width / PANGO_SCALE / finer};
    cairo_move_to(context, 0, -(double)pango_layout_get_baseline(layout) / PANGO_SCALE);
    pango_cairo_layout_path(context, layout);
    cairo_path_t *path = cairo_copy_path(context);
    bool          good = path->status == CAIRO_STATUS_SUCCESS && find_words(out, layout, words, finer);
    for (int i = 0; good && i < path->num_data; i += path->data[i].header.length) {
        const cairo_path_data_t *data = &path->data[i];
        good = mem_grow((void **)&out->steps, &out->capacity, out->count + 1, sizeof *out->steps);
        if (!good)
            break;
        cairo_step *step = &out->steps[out->count++];
        step->kind = kinds[data->header.type];
        for (int k = 0; k < numbers[data->header.type]; k++)
            step->at[k] = (k % 2 ? data[1 + k / 2].point.y : data[1 + k / 2].point.x) / finer;
    }
    cairo_path_destroy(path);
    g_object_unref(layout);
    cairo_destroy(context);
    cairo_surface_destroy(surface);
    return good;
}

static void draw_text(painter *w, const sheet_item *item)
{
    cairo_t *c = w->context;
    char    *words = cairo_clean_text(item->text);
    if (!words) {
        w->failed = true;
        return;
    }
    PangoLayout *layout = layout_of(c, words, item->box[3]);
    int          width, height;
    pango_layout_get_size(layout, &width, &height);
    double fraction = item->anchor < 0 ? 0 : item->anchor == 0 ? 0.5 : 1;
    set_ink(c, item->ink);
    cairo_move_to(c, item->box[0] - fraction * width / PANGO_SCALE,
                  item->box[1] - (double)pango_layout_get_baseline(layout) / PANGO_SCALE);
    pango_cairo_show_layout(c, layout);
    g_object_unref(layout);
    mem_free(words);
}

static void clip_to_groups(painter *w, uint32_t group)
{
    if (group >= w->s->group_count)
        return;
    for (int32_t at = (int32_t)group; at >= 0; at = w->s->groups[at].parent) {
        const double *clip = w->s->groups[at].clip;
        if (!(clip[2] > 0))
            continue;
        cairo_rectangle(w->context, clip[0], clip[1], clip[2], clip[3]);
        cairo_clip(w->context);
    }
}

static void draw_item(painter *w, const sheet_item *item)
{
    cairo_save(w->context);
    clip_to_groups(w, item->group);
    switch (item->kind) {
    case SHEET_PATH:
    case SHEET_DOTS: draw_paths(w, item); break;
    case SHEET_IMAGE: draw_image(w, item); break;
    case SHEET_TEXT: draw_text(w, item); break;
    }
    cairo_restore(w->context);
}

bool cairo_sheet_draw(cairo_t *context, const sheet *s)
{
    painter w = {.s = s, .context = context, .failed = s->failed};
    cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
    if (s->ground.a > 0) {
        set_ink(context, s->ground);
        cairo_paint(context);
    }
    for (size_t i = 0;
         i < s->item_count && !w.failed && !work_stopped() && cairo_status(context) == CAIRO_STATUS_SUCCESS; i++)
        draw_item(&w, &s->items[i]);
    return !w.failed && !work_stopped();
}

lmn_status export_text_width(double *out, const char *utf8, double size, lmn_error *error)
{
    char *words = cairo_clean_text(utf8);
    if (!words)
        return error_memory(error);
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_A8, 1, 1);
    cairo_t         *context = cairo_create(surface);
    PangoLayout     *layout = layout_of(context, words, size);
    int              width, height;
    pango_layout_get_size(layout, &width, &height);
    *out = (double)width / PANGO_SCALE;
    g_object_unref(layout);
    cairo_destroy(context);
    cairo_surface_destroy(surface);
    mem_free(words);
    return LMN_OK;
}

/* Over 8-bit pixels with straight alpha, from what cairo has: blue first in memory, premultiplied. */
static void lay_over(uint8_t *rgba, int width, int height, const unsigned char *argb, int stride)
{
    for (int y = 0; y < height; y++)
        for (int x = 0; x < width; x++) {
            uint32_t pixel;
            memcpy(&pixel, argb + (size_t)y * (size_t)stride + 4 * (size_t)x, sizeof pixel);
            uint32_t over = pixel >> 24;
            if (!over)
                continue;
            uint8_t *to = rgba + 4 * ((size_t)y * (size_t)width + (size_t)x);
            uint32_t under = (uint32_t)to[3] * (255 - over), alpha = over * 255 + under; /* of 255² */
            for (int k = 0; k < 3; k++) {
                uint32_t ink = pixel >> (16 - 8 * k) & 255;
                to[k] = (uint8_t)((ink * 65025u + to[k] * under + alpha / 2) / alpha);
            }
            to[3] = (uint8_t)((alpha + 127) / 255);
        }
}

lmn_status export_paint(uint8_t *rgba, const int part[4], int width, int height, const sheet *s, lmn_error *error)
{
    cairo_surface_t *surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, part[2], part[3]);
    cairo_surface_set_device_offset(surface, -part[0], -part[1]);
    cairo_t *context = cairo_create(surface);
    cairo_scale(context, width / s->width, height / s->height);
    bool done = cairo_sheet_draw(context, s) && cairo_status(context) == CAIRO_STATUS_SUCCESS;
    cairo_surface_flush(surface);
    if (done)
        lay_over(rgba, part[2], part[3], cairo_image_surface_get_data(surface),
                 cairo_image_surface_get_stride(surface));
    cairo_destroy(context);
    cairo_surface_destroy(surface);
    return done ? LMN_OK : error_memory(error);
}
