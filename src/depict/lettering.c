/* Lettering in the page's plane, in lines. */
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "construct/construct.h"
#include "depict/page.h"

enum { LINES_MOST = 24, LINES_KEPT = 512 };

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
static lmn_status flatten(lettering_line *out, const region *letters, lmn_error *error)
{
    polyhedron             block = {0};
    const linear_extrusion how = {.height = 1, .scale = {1, 1}, .facets = {.fn = 12}};
    lmn_status             status = construct_linear_extrude(&block, letters, &how, error);
    out->points = status == LMN_OK ? mem_alloc((block.point_count + 1) * sizeof *out->points) : NULL;
    out->triangles = status == LMN_OK ? mem_alloc((3 * block.triangle_count + 1) * sizeof *out->triangles) : NULL;
    if (status == LMN_OK && (!out->points || !out->triangles))
        status = error_memory(error);
    for (size_t i = 0; i < block.point_count && status == LMN_OK; i++) {
        out->points[i][0] = block.points[i].x;
        out->points[i][1] = block.points[i].y;
    }
    out->point_count = block.point_count;
    for (size_t i = 0; i < block.triangle_count && status == LMN_OK; i++) {
        const uint32_t *t = &block.triangles[3 * i];
        if (block.points[t[0]].z > 0.5 && block.points[t[1]].z > 0.5 && block.points[t[2]].z > 0.5)
            memcpy(&out->triangles[3 * out->triangle_count++], t, 3 * sizeof *t);
    }
    polyhedron_release(&block);
    return status;
}

static lmn_status set_line(lettering_line *out, const char *text, lmn_error *error)
{
    const text_style font = {.size = 1, .spacing = 1, .font = LETTERING_FONT, .fallback = true};
    region           letters = {0};
    bool             missing;
    *out = (lettering_line){.text = mem_copy_text(text)};
    lmn_status status =
        out->text ? construct_text(&letters, text, &font, (facets){.fn = 12}, &missing, error) : error_memory(error);
    out->seen = status == LMN_OK && region_bounds(&letters, out->low, out->high);
    if (out->seen)
        status = flatten(out, &letters, error);
    region_release(&letters);
    return status;
}

/* The index of a line that is there, or is set now. */
static lmn_status find_line(int *out, letterings *kept, const char *text, lmn_error *error)
{
    lettering_line line;
    *out = letterings_find(kept, text);
    if (*out != LETTERING_NONE)
        return LMN_OK;
    lmn_status status = set_line(&line, text, error);
    if (status == LMN_OK) {
        *out = letterings_add(kept, &line);
        status = *out == LETTERING_NONE ? error_memory(error) : LMN_OK;
    }
    if (status != LMN_OK)
        lettering_line_release(&line);
    return status;
}

static void put_line(glyph_mesh *m, const page_place *p, const lettering_line *line, double up, double scale)
{
    const uint32_t first = (uint32_t)m->position_count;
    for (size_t i = 0; i < line->point_count; i++) {
        double at[3], x = line->points[i][0] - (line->low[0] + line->high[0]) / 2;
        page_point(p, x * scale, line->points[i][1] * scale + up, at);
        glyph_vertex(m, at);
    }
    for (size_t i = 0; i < line->triangle_count; i++) {
        const uint32_t *t = &line->triangles[3 * i];
        glyph_triangle(m, first + t[0], first + t[1], first + t[2]);
    }
}

lmn_status glyph_put_lettering(glyph_mesh *m, const depict_job *j, const page_place *p, const lettering_style *style,
                               double size[2], lmn_error *error)
{
    const double leading = 1.5;
    int          lines[LINES_MOST];
    size_t       count = 0;
    lmn_status   status = LMN_OK;
    double       widest = 0, scale = style->height;
    if (j->letterings->count + LINES_MOST > LINES_KEPT) /* who writes so much writes something new all the time */
        letterings_release(j->letterings);
    for (const char *rest = style->text; *rest && count < LINES_MOST && status == LMN_OK; count += status == LMN_OK) {
        char text[PARAM_TEXT_MAX];
        rest = take_line(rest, style->most, text);
        status = find_line(&lines[count], j->letterings, text, error);
        const lettering_line *line = status == LMN_OK ? &j->letterings->lines[lines[count]] : NULL;
        if (line && line->seen)
            widest = fmax(widest, line->high[0] - line->low[0]);
    }
    if (status == LMN_OK && !(widest > 0))
        return error_set(error, LMN_USAGE, "nothing of the text can be seen");
    if (style->width > 0 && widest * scale > style->width)
        scale = style->width / widest;
    size[0] = widest * scale;
    size[1] = count ? scale * (1 + leading * (double)(count - 1)) : 0;
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        const lettering_line *line = &j->letterings->lines[lines[i]];
        if (line->seen)
            put_line(m, p, line, size[1] / 2 - scale * (1 + leading * (double)i), scale);
    }
    return status;
}
