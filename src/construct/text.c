/* Outlines of letters: text_fonts.c finds their fonts; behind the fence, HarfBuzz says which glyphs stand where and
 * FreeType has their curves. Both take memory past base/memory.h and give it back. */
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_OUTLINE_H
#include <hb-ft.h>
#include <math.h>
#include <string.h>

#include "base/file.h"
#include "base/limits.h"
#include "base/memory.h"
#include "construct/construct_private.h"
#include "construct/text_fonts.h"
#include "fence/fence.h"

/* OpenSCAD sets every font at this size, in 64ths of a point, at 100 dots an inch, and scales the outlines from
 * there. */
#define FONT_SIZE       100000
#define FONT_RESOLUTION 100
/* What lies between glyphs comes out a little smaller than the glyphs themselves: 1000 by 1024. So it is there. */
#define POSITION_SCALE (1.0 / 102400)
#define PIXEL          64

typedef struct lettering {
    FT_Library     library;
    FT_Face        face;
    hb_font_t     *font;
    hb_buffer_t   *buffer;
    double         size, spacing;
    int            segments; /* of one curve */
    double         x, y;     /* where the glyph begins */
    point2         last;     /* where the curve begins, in the font's units */
    region_builder outline;  /* of one glyph */
    size_t         points;   /* of all glyphs so far */
} lettering;

/* --- the font ------------------------------------------------------------------------------------------- */

static lmn_status open_font(lettering *l, const void *bytes, size_t size, int index, lmn_error *error)
{
    bool opened = FT_Init_FreeType(&l->library) == 0 &&
                  FT_New_Memory_Face(l->library, bytes, (FT_Long)size, index, &l->face) == 0 &&
                  FT_Set_Char_Size(l->face, 0, FONT_SIZE, FONT_RESOLUTION, FONT_RESOLUTION) == 0;
    return opened ? LMN_OK : error_set(error, LMN_UNSUPPORTED, "text: the font cannot be read");
}

/* --- from letters to glyphs ----------------------------------------------------------------------------- */

/* Script and direction that are not given come from the text. */
static lmn_status shape(lettering *l, const char *utf8, const text_style *style, lmn_error *error)
{
    l->font = hb_ft_font_create(l->face, NULL);
    l->buffer = hb_buffer_create();
    hb_buffer_add_utf8(l->buffer, utf8, -1, 0, -1);
    if (style->direction && *style->direction)
        hb_buffer_set_direction(l->buffer, hb_direction_from_string(style->direction, -1));
    if (style->script && *style->script)
        hb_buffer_set_script(l->buffer, hb_script_from_string(style->script, -1));
    hb_buffer_set_language(l->buffer,
                           hb_language_from_string(style->language && *style->language ? style->language : "en", -1));
    hb_buffer_guess_segment_properties(l->buffer);
    hb_shape(l->font, l->buffer, NULL, 0);
    return hb_buffer_allocation_successful(l->buffer) ? LMN_OK : error_memory(error);
}

/* --- where the text stands ------------------------------------------------------------------------------ */

/* All in units of the font. */
typedef struct extent {
    double advance_x, advance_y;   /* with spacing */
    double width, ascent, descent; /* of the glyphs' boxes in whole pixels */
} extent;

static extent measure(const lettering *l)
{
    unsigned             count;
    hb_glyph_info_t     *glyphs = hb_buffer_get_glyph_infos(l->buffer, &count);
    hb_glyph_position_t *positions = hb_buffer_get_glyph_positions(l->buffer, &count);
    extent               e = {0};
    for (unsigned i = 0; i < count; i++) {
        FT_BBox  box;
        FT_Glyph glyph;
        e.advance_x += positions[i].x_advance * l->spacing;
        e.advance_y += positions[i].y_advance * l->spacing;
        if (FT_Load_Glyph(l->face, glyphs[i].codepoint, FT_LOAD_DEFAULT) != 0 ||
            FT_Get_Glyph(l->face->glyph, &glyph) != 0)
            continue;
        FT_Glyph_Get_CBox(glyph, FT_GLYPH_BBOX_PIXELS, &box);
        FT_Done_Glyph(glyph);
        e.width = fmax(e.width, (double)(box.xMax - box.xMin) * PIXEL);
        e.ascent = fmax(e.ascent, (double)box.yMax * PIXEL);
        e.descent = fmin(e.descent, (double)box.yMin * PIXEL);
    }
    return e;
}

static bool is(const char *word, const char *name)
{
    return word && strcmp(word, name) == 0;
}

/* Of text that runs down, the top is where OpenSCAD has it: below the last glyph. */
static void align(lettering *l, const text_style *style)
{
    extent e = measure(l);
    bool   vertical = HB_DIRECTION_IS_VERTICAL(hb_buffer_get_direction(l->buffer));
    double width = vertical ? e.width : e.advance_x, top = vertical ? e.advance_y : e.ascent,
           bottom = vertical ? 0 : e.descent;
    l->x = is(style->halign, "right") ? -width : is(style->halign, "center") ? -width / 2 : 0;
    if (is(style->valign, "top"))
        l->y = -top;
    else if (is(style->valign, "center"))
        l->y = -(top + bottom) / 2;
    else if (is(style->valign, "bottom"))
        l->y = -bottom;
}

/* --- from glyphs to outlines ---------------------------------------------------------------------------- */

static void add_point(lettering *l, double x, double y)
{
    if (l->points++ < LIMIT_SHAPE_POINTS)
        builder_set_position(&l->outline, (x / FONT_SIZE + l->x * POSITION_SCALE) * l->size,
                             (y / FONT_SIZE + l->y * POSITION_SCALE) * l->size);
    l->last = (point2){x, y};
}

static int on_move(const FT_Vector *to, void *user)
{
    lettering *l = user;
    if (l->outline.count > 0)
        builder_end_contour(&l->outline);
    builder_contour(&l->outline);
    add_point(l, (double)to->x, (double)to->y);
    return l->outline.failed;
}

static int on_line(const FT_Vector *to, void *user)
{
    lettering *l = user;
    add_point(l, (double)to->x, (double)to->y);
    return l->outline.failed;
}

static int on_conic(const FT_Vector *middle, const FT_Vector *to, void *user)
{
    lettering *l = user;
    point2     from = l->last;
    for (int i = 1; i <= l->segments && l->points < LIMIT_SHAPE_POINTS; i++) {
        double t = (double)i / l->segments, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
        add_point(l, a * from.x + b * (double)middle->x + c * (double)to->x,
                  a * from.y + b * (double)middle->y + c * (double)to->y);
    }
    return l->outline.failed;
}

static int on_cubic(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to, void *user)
{
    lettering *l = user;
    point2     from = l->last;
    for (int i = 1; i <= l->segments && l->points < LIMIT_SHAPE_POINTS; i++) {
        double t = (double)i / l->segments, s = 1 - t, a = s * s * s, b = 3 * s * s * t, c = 3 * s * t * t,
               d = t * t * t;
        add_point(l, a * from.x + b * (double)first->x + c * (double)second->x + d * (double)to->x,
                  a * from.y + b * (double)first->y + c * (double)second->y + d * (double)to->y);
    }
    return l->outline.failed;
}

/* The glyph's contours where it stands: how many, and each with its points. */
static lmn_status put_glyph(lettering *l, unsigned glyph, const hb_glyph_position_t *position, fence_bytes *answer,
                            lmn_error *error)
{
    static const FT_Outline_Funcs functions = {on_move, on_line, on_conic, on_cubic, 0, 0};
    l->x += position->x_offset;
    l->y += position->y_offset;
    if (FT_Load_Glyph(l->face, glyph, FT_LOAD_DEFAULT) == 0 && l->face->glyph->format == FT_GLYPH_FORMAT_OUTLINE)
        FT_Outline_Decompose(&l->face->glyph->outline, &functions, l);
    l->x += position->x_advance * l->spacing - position->x_offset;
    l->y += position->y_advance * l->spacing - position->y_offset;
    if (l->outline.count > 0)
        builder_end_contour(&l->outline);
    fence_put_u32(answer, (uint32_t)l->outline.count);
    for (size_t i = 0; i < l->outline.count; i++) {
        fence_put_u32(answer, (uint32_t)l->outline.contours[i].count);
        fence_put(answer, l->outline.contours[i].points, l->outline.contours[i].count * sizeof(point2));
    }
    bool failed = l->outline.failed;
    region_builder_release(&l->outline);
    return failed ? error_memory(error) : check_point_count("text", (double)l->points, error);
}

static lmn_status put_glyphs(lettering *l, fence_bytes *answer, lmn_error *error)
{
    unsigned             count;
    hb_glyph_info_t     *glyphs = hb_buffer_get_glyph_infos(l->buffer, &count);
    hb_glyph_position_t *positions = hb_buffer_get_glyph_positions(l->buffer, &count);
    lmn_status           status = LMN_OK;
    fence_put_u32(answer, count);
    for (unsigned i = 0; status == LMN_OK && i < count; i++)
        status = put_glyph(l, glyphs[i].codepoint, &positions[i], answer, error);
    return status;
}

static void font_release(lettering *l)
{
    hb_buffer_destroy(l->buffer);
    hb_font_destroy(l->font);
    if (l->face)
        FT_Done_Face(l->face);
    if (l->library)
        FT_Done_FreeType(l->library);
    l->buffer = NULL;
    l->font = NULL;
    l->face = NULL;
    l->library = NULL;
}

/* --- behind the fence and before it --------------------------------------------------------------------- */

/* What stands first in a request. Then: the texts of the style, and runs: each its face, its text, its font. */
typedef struct text_numbers {
    double  size, spacing;
    int32_t segments, runs;
} text_numbers;

enum { STYLE_TEXTS = 5 };

static lmn_status shape_run(lettering *l, fence_reader *r, const text_style *style, bool alone, fence_bytes *answer,
                            lmn_error *error)
{
    const uint32_t face = fence_take_u32(r);
    char          *words = fence_take_text(r);
    const uint32_t size = fence_take_u32(r);
    const void    *font = fence_take(r, size);
    lmn_status     status = words && font ? open_font(l, font, size, (int)face, error) : error_memory(error);
    if (status == LMN_OK)
        status = shape(l, words, style, error);
    if (status == LMN_OK && alone)
        align(l, style);
    if (status == LMN_OK)
        status = put_glyphs(l, answer, error);
    font_release(l);
    mem_free(words);
    return status;
}

static lmn_status shape_text(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    fence_reader r = fence_read(request, size);
    text_numbers n = {0};
    const void  *at = fence_take(&r, sizeof n);
    if (at)
        memcpy(&n, at, sizeof n);
    char *texts[STYLE_TEXTS];
    bool  good = true;
    for (int i = 0; i < STYLE_TEXTS; i++)
        good = (texts[i] = fence_take_text(&r)) && good;
    const text_style style = {
        .direction = texts[0], .language = texts[1], .script = texts[2], .halign = texts[3], .valign = texts[4]};
    lettering  l = {.size = n.size, .spacing = n.spacing, .segments = n.segments};
    lmn_status status = good ? LMN_OK : error_memory(error);
    fence_put_u32(answer, (uint32_t)n.runs);
    for (int32_t i = 0; i < n.runs && status == LMN_OK; i++)
        status = shape_run(&l, &r, &style, n.runs == 1, answer, error);
    region_builder_release(&l.outline);
    for (int i = 0; i < STYLE_TEXTS; i++)
        mem_free(texts[i]);
    return status;
}

/* One glyph of the answer, by the even-odd rule. */
static lmn_status take_glyph(region *out, fence_reader *r, lmn_error *error)
{
    region_builder outline = {0};
    for (uint32_t i = 0, count = fence_take_u32(r); i < count && !r->ended && !outline.failed; i++) {
        uint32_t             points = fence_take_u32(r);
        const unsigned char *at = fence_take(r, (size_t)points * sizeof(point2));
        builder_contour(&outline);
        for (uint32_t k = 0; at && k < points; k++) {
            point2 p;
            memcpy(&p, at + k * sizeof p, sizeof p);
            builder_set_position(&outline, p.x, p.y);
        }
        builder_end_contour(&outline);
    }
    region     whole;
    lmn_status status = region_builder_finish(&outline, &whole, error);
    if (status == LMN_OK)
        status = check_region("text", &whole, error);
    if (status == LMN_OK)
        status = region_cover(out, &whole, 1, COVER_ODD, error);
    region_release(&whole);
    region_builder_release(&outline);
    return status;
}

/* All glyphs of one run. */
static lmn_status take_run(region **glyphs, size_t *made, size_t *capacity, fence_reader *r, size_t limit,
                           lmn_error *error)
{
    const size_t count = fence_take_u32(r);
    lmn_status   status = LMN_OK;
    /* A glyph takes four bytes at least. */
    if (count > limit / 4)
        return error_set(error, LMN_FORMAT, "text: the font's reader gave a wrong answer");
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        if (!mem_grow((void **)glyphs, capacity, *made + 1, sizeof **glyphs))
            return error_memory(error);
        status = take_glyph(&(*glyphs)[*made], r, error);
        *made += status == LMN_OK;
    }
    return status;
}

/* Are all glyphs beside each other? Each is compared with those before it by their boxes. */
static bool are_apart(const region *glyphs, size_t count)
{
    double right = -INFINITY; /* of all so far */
    bool   apart = true;
    for (size_t i = 0; i < count && apart; i++) {
        double low[2], high[2];
        if (!region_bounds(&glyphs[i], low, high))
            continue;
        apart = low[0] > right;
        right = fmax(right, high[0]);
    }
    return apart;
}

/* Takes the contours of all, which are left empty. */
static lmn_status put_beside(region *out, region *glyphs, size_t count, lmn_error *error)
{
    size_t contours = 0;
    for (size_t i = 0; i < count; i++)
        contours += glyphs[i].count;
    out->contours = mem_calloc(contours + 1, sizeof *out->contours);
    if (!out->contours)
        return error_memory(error);
    for (size_t i = 0; i < count; i++) {
        if (glyphs[i].count)
            memcpy(out->contours + out->count, glyphs[i].contours, glyphs[i].count * sizeof *out->contours);
        out->count += glyphs[i].count;
        glyphs[i].count = 0;
    }
    return LMN_OK;
}

/* `beside`: where no union is needed there is none, which takes a quarter of the time; contours are then in the order
 * of the letters. */
static lmn_status join_glyphs(region *out, const fence_bytes *answer, bool beside, lmn_error *error)
{
    fence_reader r = fence_read(answer->bytes, answer->size);
    size_t       runs = fence_take_u32(&r), made = 0, capacity = 0;
    region      *glyphs = NULL;
    lmn_status   status = LMN_OK;
    for (size_t i = 0; i < runs && status == LMN_OK && !r.ended; i++)
        status = take_run(&glyphs, &made, &capacity, &r, answer->size, error);
    if (status == LMN_OK && r.ended)
        status = error_set(error, LMN_FORMAT, "text: the font's reader gave a wrong answer");
    if (status == LMN_OK)
        status = beside && are_apart(glyphs, made) ? put_beside(out, glyphs, made, error)
                                                   : region_combine(out, glyphs, made, REGION_UNION, error);
    for (size_t i = 0; i < made; i++)
        region_release(&glyphs[i]);
    mem_free(glyphs);
    return status;
}

static lmn_status put_run(fence_bytes *request, const text_run *run, lmn_error *error)
{
    file_data  font = {0};
    lmn_status status = file_load(&font, run->file, error);
    if (status == LMN_OK && font.size > UINT32_MAX)
        status = error_set(error, LMN_UNSUPPORTED, "text: the font cannot be read");
    if (status == LMN_OK) {
        fence_put_u32(request, (uint32_t)run->face);
        fence_put_text(request, run->words);
        fence_put_u32(request, (uint32_t)font.size);
        fence_put(request, font.data, font.size);
    }
    file_data_release(&font);
    return status;
}

lmn_status construct_text(region *out, const char *utf8, const text_style *style, facets f, bool *missing,
                          lmn_error *error)
{
    *out = (region){0};
    *missing = false;
    lmn_status status = check_numbers("text", (double[]){style->size, style->spacing}, 2, error);
    if (status == LMN_OK)
        status = check_point_count("text", (double)strlen(utf8), error);
    if (status != LMN_OK || style->size == 0 || !*utf8)
        return status;
    /* A curve has an eighth of a circle's facets. */
    text_numbers n = {
        .size = style->size, .spacing = style->spacing, .segments = facets_of_circle(style->size, f) / 8 + 1};
    n.segments = n.segments < 2 ? 2 : n.segments;
    text_runs   runs = {0};
    fence_bytes request = {0}, answer = {0};
    status = style->fallback ? text_runs_find(&runs, utf8, style->font, error)
                             : text_runs_whole(&runs, utf8, style->font, missing, error);
    if (status == LMN_OK) {
        n.runs = (int32_t)runs.count;
        const char *texts[] = {style->direction, style->language, style->script, style->halign, style->valign};
        fence_put(&request, &n, sizeof n);
        for (size_t i = 0; i < sizeof texts / sizeof *texts; i++)
            fence_put_text(&request, texts[i]);
        for (size_t i = 0; i < runs.count && status == LMN_OK; i++)
            status = put_run(&request, &runs.items[i], error);
    }
    if (status == LMN_OK)
        status = fence_call(&answer, shape_text, "the reader of fonts", &request, error);
    if (status == LMN_OK)
        status = join_glyphs(out, &answer, style->fallback, error);
    text_runs_release(&runs);
    mem_free(request.bytes);
    mem_free(answer.bytes);
    return status;
}

lmn_status construct_text_check(const char *utf8, const char *font, lmn_error *error)
{
    text_runs  runs = {0};
    lmn_status status = text_runs_find(&runs, utf8, font, error);
    text_runs_release(&runs);
    return status;
}
