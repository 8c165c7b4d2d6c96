/* Lettering in the page's plane, in lines. */
#include <string.h>

#include "base/error.h"
#include "construct/construct.h"
#include "depict/page.h"

enum { LINES_MOST = 24 };

typedef struct text_line {
    char   text[PARAM_TEXT_MAX];
    region letters;
    double low[2], high[2];
    bool   seen;
} text_line;

/* Before these a line may end: from U+2E80 to U+D7FF, which take three bytes in UTF-8. */
static bool is_ideograph(const char *at)
{
    const unsigned char first = (unsigned char)at[0], second = first ? (unsigned char)at[1] : 0;
    return (first == 0xE2 && second >= 0xBA) || (first >= 0xE3 && first <= 0xEC) || (first == 0xED && second < 0xA0);
}

/* The next line of a text, and what comes behind it: up to "|", or the last word that has room. */
static const char *take_line(const char *text, int most, char out[PARAM_TEXT_MAX])
{
    size_t end = 0, word = 0, letters = 0;
    while (*text == ' ')
        text++;
    for (; text[end] && text[end] != '|' && end + 1 < PARAM_TEXT_MAX; end++) {
        letters += ((unsigned char)text[end] & 0xC0) != 0x80; /* UTF-8: one a letter */
        if (text[end] == ' ' || is_ideograph(text + end))
            word = end;
        if (most > 0 && letters > (size_t)most && word > 0) {
            end = word;
            break;
        }
    }
    memcpy(out, text, end);
    out[end] = '\0';
    return text + end + (text[end] == '|' || text[end] == ' ');
}

/* The upper face of a plate of letters: triangles of the region. */
static lmn_status put_line(glyph_mesh *m, const page_place *p, const text_line *line, double up, double scale,
                           lmn_error *error)
{
    polyhedron             block = {0};
    const linear_extrusion how = {.height = 1, .scale = {1, 1}, .facets = {.fn = 12}};
    lmn_status             status = construct_linear_extrude(&block, &line->letters, &how, error);
    const uint32_t         first = (uint32_t)m->position_count;
    for (size_t i = 0; i < block.point_count && status == LMN_OK; i++) {
        double at[3], x = block.points[i].x - (line->low[0] + line->high[0]) / 2;
        page_point(p, x * scale, block.points[i].y * scale + up, at);
        glyph_vertex(m, at);
    }
    for (size_t i = 0; i < block.triangle_count && status == LMN_OK; i++) {
        const uint32_t *t = &block.triangles[3 * i];
        if (block.points[t[0]].z > 0.5 && block.points[t[1]].z > 0.5 && block.points[t[2]].z > 0.5)
            glyph_triangle(m, first + t[0], first + t[1], first + t[2]);
    }
    polyhedron_release(&block);
    return status;
}

lmn_status glyph_put_lettering(glyph_mesh *m, const page_place *p, const lettering_style *style, double size[2],
                               lmn_error *error)
{
    const text_style font = {.size = 1, .spacing = 1, .font = "sans:bold", .fallback = true};
    const double     leading = 1.5;
    text_line        lines[LINES_MOST] = {0};
    size_t           count = 0;
    bool             missing;
    lmn_status       status = LMN_OK;
    double           widest = 0, scale = style->height;
    for (const char *rest = style->text; *rest && count < LINES_MOST && status == LMN_OK; count++) {
        text_line *line = &lines[count];
        rest = take_line(rest, style->most, line->text);
        status = construct_text(&line->letters, line->text, &font, (facets){.fn = 12}, &missing, error);
        line->seen = status == LMN_OK && region_bounds(&line->letters, line->low, line->high);
        if (line->seen)
            widest = fmax(widest, line->high[0] - line->low[0]);
    }
    if (style->width > 0 && widest * scale > style->width)
        scale = style->width / widest;
    size[0] = widest * scale;
    size[1] = count ? scale * (1 + leading * (double)(count - 1)) : 0;
    for (size_t i = 0; i < count; i++) {
        if (status == LMN_OK && lines[i].seen)
            status = put_line(m, p, &lines[i], size[1] / 2 - scale * (1 + leading * (double)i), scale, error);
        region_release(&lines[i].letters);
    }
    return status;
}
