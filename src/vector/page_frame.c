/* Frame and title block of a sheet. Widths of lines and sizes of letters are those of ISO 128, 3098 and 5457, as
 * far as small pages leave room. */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "vector/vector_private.h"

typedef struct block_sizes {
    double margin, height, width, letter; /* mm */
    double filing;                        /* the margin on the left */
    double unit;                          /* of a block with all fields: 1 where it is as large as ISO 7200 has it */
} block_sizes;

/* Where the fields of ISO 7200 stand, mm in a block of 180 by 36, in rows of 9. */
static const struct {
    const char *key, *heading;
    double      x, width;
    int         row, rows;
} cells[] = {
    {"department", "Responsible dept.", 0, 45, 0, 1},
    {"reference", "Technical reference", 45, 45, 0, 1},
    {"type", "Document type", 90, 45, 0, 1},
    {"status", "Document status", 135, 45, 0, 1},
    {"creator", "Created by", 0, 45, 1, 1},
    {"title", "Title, supplementary title", 45, 90, 1, 2},
    {"number", "Identification number", 135, 45, 1, 1},
    {"approver", "Approved by", 0, 45, 2, 1},
    {"revision", "Rev.", 135, 10, 2, 1},
    {"date", "Date of issue", 145, 20, 2, 1},
    {"language", "Lang.", 165, 7, 2, 1},
    {"sheet", "Sheet", 172, 8, 2, 1},
    {"owner", "Legal owner", 0, 90, 3, 1},
    {"scale", "Scale", 90, 20, 3, 1},
    {"unit", "Unit", 110, 14, 3, 1},
    {"projection", "Projection", 124, 32, 3, 1},
    {"page", "Size", 156, 24, 3, 1},
};
enum { CELL_COUNT = sizeof cells / sizeof *cells, FIELD_SIZE = 128 };
static const double block_width = 180, row_height = 9, block_rows = 4;

static bool has_fields(const lmn_sheet_desc *wanted)
{
    return wanted->frame && wanted->fields && *wanted->fields;
}

/* Margins are those of ISO 5457 on sheets with widths of ISO 128 or all fields. */
static block_sizes sizes_of(const lmn_sheet_desc *wanted, double width, double height)
{
    double      side = fmin(width, height), fraction = fmin(side / 210, 1);
    block_sizes b = {fmax(10 * fraction, 1),
                     fmax(16 * fraction, 2),
                     fmin(width * 0.8, 130 * fraction),
                     fmax(5 * fraction, 0.6),
                     0,
                     0};
    b.filing = has_fields(wanted) || wanted->line_group > 0 ? 2 * b.margin : b.margin;
    if (has_fields(wanted)) {
        b.unit = fmin((width - b.margin - b.filing) / block_width, 1);
        b.width = block_width * b.unit;
        b.height = row_height * block_rows * b.unit;
    }
    return b;
}

/* --- what fields say ------------------------------------------------------------------------------------ */

static bool is_own(const char *key)
{
    return strcmp(key, "scale") == 0 || strcmp(key, "unit") == 0 || strcmp(key, "projection") == 0 ||
           strcmp(key, "page") == 0 || strcmp(key, "title") == 0;
}

/* What a field says; false: nothing. */
static bool field_of(const char *fields, const char *key, char out[FIELD_SIZE])
{
    size_t length = strlen(key);
    out[0] = '\0';
    for (const char *at = fields; at && *at; at += strcspn(at, ";"), at += *at == ';')
        if (strncmp(at, key, length) == 0 && at[length] == '=') {
            size_t size = strcspn(at + length + 1, ";");
            size = size < FIELD_SIZE - 1 ? size : FIELD_SIZE - 1;
            memcpy(out, at + length + 1, size);
            out[size] = '\0';
            return true;
        }
    return false;
}

lmn_status vector_check_fields(const lmn_sheet_desc *wanted, lmn_error *error)
{
    const char *fields = wanted->fields;
    if (fields && *fields && !wanted->frame)
        return error_set(error, LMN_USAGE, "fields stand in the title block of a frame (`frame`, --frame)");
    for (const char *at = fields; at && *at; at += strcspn(at, ";"), at += *at == ';') {
        size_t length = strcspn(at, "=;");
        bool   known = strncmp(at, "supplement", length) == 0 && length == strlen("supplement");
        for (size_t i = 0; i < CELL_COUNT; i++)
            known = known ||
                    (!is_own(cells[i].key) && strlen(cells[i].key) == length && strncmp(at, cells[i].key, length) == 0);
        if (known && at[length] == '=')
            continue;
        error_set(error, LMN_USAGE, "there is no field '%.*s' in the title block", (int)(length > 40 ? 40 : length),
                  at);
        error_hint(error,
                   "KEY=VALUE; keys are owner, number, date, sheet, creator, approver, type, department, reference, "
                   "status, revision, language, supplement; the title is told apart (`title`, --title)");
        return LMN_USAGE;
    }
    return LMN_OK;
}

void vector_inside_frame(const lmn_sheet_desc *wanted, double width, double height, double out[4])
{
    block_sizes b = sizes_of(wanted, width, height);
    bool        titled = wanted->title && *wanted->title;
    double      margin = wanted->frame ? b.margin : 0, foot = wanted->frame ? b.height : titled ? 3 * b.letter : 0;
    double      filing = wanted->frame ? b.filing : 0;
    out[0] = filing;
    out[1] = margin;
    out[2] = fmax(width - margin - filing, 1);
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

/* --- the block of ISO 7200 ------------------------------------------------------------------------------ */

/* Words as large as they may be in the room that they have. */
static void put_words(sheet *s, uint32_t group, colour ink, const char *words, double x, double y, double room,
                      double size)
{
    size_t letters = 0;
    for (const char *at = words; *at; at++)
        letters += ((unsigned char)*at & 0xC0) != 0x80;
    double width = 0.58 * size * (double)letters;
    sheet_add_text(s, group, ink, words, x, y, width > room ? size * room / width : size, -1);
}

static void put_value(const lmn_sheet *facts, const lmn_sheet_desc *wanted, size_t index, char out[FIELD_SIZE])
{
    const char *key = cells[index].key;
    if (strcmp(key, "title") == 0)
        snprintf(out, FIELD_SIZE, "%s", wanted->title ? wanted->title : facts->page.title ? facts->page.title : "");
    else if (strcmp(key, "scale") == 0)
        snprintf(out, FIELD_SIZE, "%s", *facts->scale_text ? facts->scale_text : "\xE2\x80\x93");
    else if (strcmp(key, "unit") == 0)
        snprintf(out, FIELD_SIZE, "%s", facts->unit);
    else if (strcmp(key, "page") == 0 && wanted->page && wanted->page[0] >= 'A')
        snprintf(out, FIELD_SIZE, "%.*s", (int)strcspn(wanted->page, "-"), wanted->page);
    else if (strcmp(key, "page") == 0)
        snprintf(out, FIELD_SIZE, "%.0f \xC3\x97 %.0f", facts->page.width, facts->page.height);
    else
        field_of(wanted->fields, key, out);
}

static void put_all_fields(sheet *s, const lmn_sheet_desc *wanted, const lmn_sheet *facts, uint32_t group, colour ink,
                           const block_sizes *b)
{
    double left = s->width - b->margin - b->width, top = s->height - b->margin - b->height;
    sheet_add_rectangle(s, group, ink, left, top, b->width, b->height, 0.7 * b->unit);
    for (size_t i = 0; i < CELL_COUNT; i++) {
        char   words[FIELD_SIZE] = "", more[FIELD_SIZE];
        double x = left + cells[i].x * b->unit, y = top + cells[i].row * row_height * b->unit,
               width = cells[i].width * b->unit, height = cells[i].rows * row_height * b->unit, inset = 1.2 * b->unit;
        sheet_add_rectangle(s, group, ink, x, y, width, height, 0.25 * b->unit);
        sheet_add_text(s, group, ink, cells[i].heading, x + inset, y + 2.7 * b->unit, 2.2 * b->unit, -1);
        if (strcmp(cells[i].key, "projection") == 0) {
            put_symbol(s, group, ink, x + width * 0.62, y + height * 0.54, height * 0.6,
                       wanted->angle == LMN_FIRST_ANGLE);
            continue;
        }
        put_value(facts, wanted, i, words);
        put_words(s, group, ink, words, x + inset, y + (cells[i].rows > 1 ? 8.8 : 7.4) * b->unit, width - 2 * inset,
                  (cells[i].rows > 1 ? 5.5 : 4) * b->unit);
        if (cells[i].rows > 1 && field_of(wanted->fields, "supplement", more))
            put_words(s, group, ink, more, x + inset, y + 15 * b->unit, width - 2 * inset, 4 * b->unit);
    }
}

/* --- the borders of ISO 5457 ---------------------------------------------------------------------------- */

/* Marks at the ends of both axes of symmetry of the paper, from its edge into the frame. */
static void put_centring_marks(sheet *s, uint32_t group, colour ink, const block_sizes *b)
{
    double inside = 0.5 * b->margin, width = 0.07 * b->margin, x = s->width / 2, y = s->height / 2;
    put_line(s, group, ink, x, 0, x, b->margin + inside, width);
    put_line(s, group, ink, x, s->height - b->margin, x, s->height, width);
    put_line(s, group, ink, 0, y, b->filing + inside, y, width);
    put_line(s, group, ink, s->width - b->margin - inside, y, s->width, y, width);
}

static const double field_length = 50, border_width = 5, border_line = 0.35, border_letter = 3.5; /* mm */

/* Fields on either side of the middle: what is left over is the last one's. */
static int fields_of(double length)
{
    int half = (int)round(length / 2 / field_length);
    return half > 0 ? half : 1;
}

/* The name of a field: letters without I and O, twice where they are used up, or numbers from 1 on. */
static void name_field(char out[16], int index, bool letter)
{
    static const char letters[] = "ABCDEFGHJKLMNPQRSTUVWXYZ";
    const int         known = (int)sizeof letters - 1;
    if (letter) {
        memset(out, 0, 16);
        memset(out, letters[index % known], (size_t)(index < 15 * known ? index / known + 1 : 15));
    } else {
        snprintf(out, 16, "%d", index + 1);
    }
}

/* Fields along one side, of the paper's width or height; `inner` and `outer`: of the border, from the paper's edge;
 * `ends`: of the frame along it. */
static void put_fields(sheet *s, uint32_t group, colour ink, bool upright, double inner, double outer,
                       const double ends[2])
{
    double length = upright ? s->height : s->width, middle = (inner + outer) / 2;
    int    half = fields_of(length);
    for (int i = 0; i < 2 * half; i++) {
        double from = i == 0 ? ends[0] : length / 2 + field_length * (i - half),
               to = i + 1 == 2 * half ? ends[1] : length / 2 + field_length * (i + 1 - half), at = (from + to) / 2;
        char name[16];
        name_field(name, i, upright);
        sheet_add_text(s, group, ink, name, upright ? middle : at, (upright ? at : middle) + 0.36 * border_letter,
                       border_letter, 0);
        if (i == 0 || i == half) /* a centring mark is there */
            continue;
        if (upright)
            put_line(s, group, ink, inner, from, outer, from, border_line);
        else
            put_line(s, group, ink, from, inner, from, outer, border_line);
    }
}

/* The grid reference border: fields of 50 mm from the middle of the paper on, capitals from the top down and numbers
 * from left to right, on all sides, of A4 above and on the right alone. */
static void put_grid(sheet *s, uint32_t group, colour ink, const block_sizes *b)
{
    double left = b->filing, top = b->margin, right = s->width - b->margin, bottom = s->height - b->margin;
    bool   small = fmax(s->width, s->height) < 300;
    sheet_add_rectangle(s, group, ink, left - border_width, top - border_width, right - left + 2 * border_width,
                        bottom - top + 2 * border_width, border_line);
    put_fields(s, group, ink, false, top, top - border_width, (const double[2]){left, right});
    put_fields(s, group, ink, true, right, right + border_width, (const double[2]){top, bottom});
    if (small)
        return;
    put_fields(s, group, ink, false, bottom, bottom + border_width, (const double[2]){left, right});
    put_fields(s, group, ink, true, left, left - border_width, (const double[2]){top, bottom});
}

void vector_put_frame(lmn_sheet *facts, const lmn_sheet_desc *wanted, colour ink)
{
    sheet      *s = &facts->page;
    block_sizes b = sizes_of(wanted, s->width, s->height);
    bool        titled = wanted->title && *wanted->title;
    if (!wanted->frame && !titled)
        return;
    uint32_t group = sheet_add_group(s, -1, "frame", "frame", 0);
    if (wanted->frame) {
        sheet_add_rectangle(s, group, ink, b.filing, b.margin, s->width - b.margin - b.filing, s->height - 2 * b.margin,
                            b.letter * 0.14);
        if (b.filing > b.margin)
            put_centring_marks(s, group, ink, &b);
        if (b.filing > b.margin && fmin(s->width, s->height) >= 209.5)
            put_grid(s, group, ink, &b);
        if (b.unit > 0)
            put_all_fields(s, wanted, facts, group, ink, &b);
        else
            put_block(s, wanted, facts, group, ink, &b);
    } else {
        sheet_add_text(s, group, ink, wanted->title, s->width / 2, s->height - 1.2 * b.letter, b.letter, 0);
    }
}
