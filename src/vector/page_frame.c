/* Frame and title block of a sheet. Widths of lines and sizes of letters are those of ISO 128, 3098 and 5457, as
 * far as small pages leave room. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vector/vector_private.h"

typedef struct block_sizes {
    double margin, height, width, letter; /* mm */
} block_sizes;

static block_sizes sizes_of(double width, double height)
{
    double side = fmin(width, height), fraction = fmin(side / 210, 1);
    return (block_sizes){fmax(10 * fraction, 1), fmax(16 * fraction, 2), fmin(width * 0.8, 130 * fraction),
                         fmax(5 * fraction, 0.6)};
}

void vector_inside_frame(const lmn_sheet_desc *wanted, double width, double height, double out[4])
{
    block_sizes b = sizes_of(width, height);
    bool        titled = wanted->title && *wanted->title;
    double      margin = wanted->frame ? b.margin : 0, foot = wanted->frame ? b.height : titled ? 3 * b.letter : 0;
    out[0] = out[1] = margin;
    out[2] = fmax(width - 2 * margin, 1);
    out[3] = fmax(height - 2 * margin - foot, 1);
}

static void put_line(sheet *s, uint32_t group, colour ink, double x0, double y0, double x1, double y1, double width)
{
    sheet_add_line(s, group, ink, (const double[2]){x0, y0}, (const double[2]){x1, y1}, width);
}

/* The symbol of the projection: a cone's front and side view as the projection places them. */
static void put_symbol(sheet *s, uint32_t group, colour ink, double x, double y, double size, bool first)
{
    double circle_x = first ? x + size * 0.8 : x - size * 0.8, cone_x = first ? x - size * 0.8 : x + size * 0.8,
           large = size * 0.5, small = size * 0.25, line = size / 18;
    float ring[64][2], cone[4][2];
    for (int k = 0; k < 2; k++) {
        for (int i = 0; i < 64; i++) {
            ring[i][0] = (float)(circle_x + (k ? small : large) * cos(i * 6.283185307179586 / 64));
            ring[i][1] = (float)(y + (k ? small : large) * sin(i * 6.283185307179586 / 64));
        }
        sheet_add_item(s, SHEET_PATH, group, ink, 0);
        sheet_add_path(s, &(sheet_path){.closed = true, .width = (float)line}, (const float(*)[2])ring, 64);
    }
    /* The narrow end is on the left, where the circles are seen from. */
    const double ends[4][2] = {{-0.6, small}, {0.6, large}, {0.6, -large}, {-0.6, -small}};
    for (int i = 0; i < 4; i++) {
        cone[i][0] = (float)(cone_x + ends[i][0] * size);
        cone[i][1] = (float)(y + ends[i][1]);
    }
    sheet_add_item(s, SHEET_PATH, group, ink, 0);
    sheet_add_path(s, &(sheet_path){.closed = true, .width = (float)line}, (const float(*)[2])cone, 4);
}

/* A cell of the title block: a small heading and what it says. */
static void put_cell(sheet *s, uint32_t group, colour ink, const char *heading, const char *words, double x, double y,
                     const block_sizes *b)
{
    double inset = b->letter * 0.4;
    sheet_add_text(s, group, ink, heading, x + inset, y + inset + b->letter * 0.45, b->letter * 0.5, -1);
    sheet_add_text(s, group, ink, words, x + inset, y + b->height - inset * 1.6, b->letter * 0.9, -1);
}

static void put_block(sheet *s, const lmn_sheet_desc *wanted, const lmn_sheet *facts, uint32_t group, colour ink,
                      const block_sizes *b)
{
    double right = s->width - b->margin, bottom = s->height - b->margin, left = right - b->width,
           top = bottom - b->height, line = b->letter * 0.07;
    /* The last cell is the symbol's. */
    const double fractions[4] = {0, facts->view_count > 1 ? 0.54 : 0.66, facts->view_count > 1 ? 0.7 : 0.86, 0.82};
    const char  *headings[3] = {"Title", "Scale", "Unit"};
    const char  *words[3] = {wanted->title ? wanted->title : "", *facts->scale_text ? facts->scale_text : "–",
                            facts->unit};
    put_line(s, group, ink, left, top, right, top, line * 2);
    put_line(s, group, ink, left, top, left, bottom, line * 2);
    for (int i = 0; i < 3; i++) {
        double x = left + fractions[i] * b->width;
        if (i > 0)
            put_line(s, group, ink, x, top, x, bottom, line);
        put_cell(s, group, ink, headings[i], words[i], x, top, b);
    }
    if (facts->view_count < 2)
        return;
    put_line(s, group, ink, left + fractions[3] * b->width, top, left + fractions[3] * b->width, bottom, line);
    put_symbol(s, group, ink, left + (fractions[3] + 1) / 2 * b->width, (top + bottom) / 2, b->height * 0.42,
               wanted->angle == LMN_FIRST_ANGLE);
}

void vector_put_frame(lmn_sheet *facts, const lmn_sheet_desc *wanted, colour ink)
{
    sheet      *s = &facts->page;
    block_sizes b = sizes_of(s->width, s->height);
    bool        titled = wanted->title && *wanted->title;
    if (!wanted->frame && !titled)
        return;
    uint32_t group = sheet_add_group(s, -1, "frame", "frame", 0);
    if (wanted->frame) {
        sheet_add_rectangle(s, group, ink, b.margin, b.margin, s->width - 2 * b.margin, s->height - 2 * b.margin,
                            b.letter * 0.14);
        put_block(s, wanted, facts, group, ink, &b);
    } else {
        sheet_add_text(s, group, ink, wanted->title, s->width / 2, s->height - 1.2 * b.letter, b.letter, 0);
    }
}
