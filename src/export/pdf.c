/* PDF of a sheet (ISO 32000-1): one page with lines, arcs as cubics, dashes and areas as the page description has them,
 * and each group of the sheet as an optional content group, which viewers and Illustrator show as a layer. Texts are
 * drawn by the outlines of their letters, so that no font need be there, and say beside them what they are. Dates are
 * fixed, so that equal sheets are equal files. Objects that are no streams, layers above all, are packed into one. */
#include <libdeflate.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "base/paper.h"
#include "base/work.h"
#include "export/cairo_sheet.h"
#include "export/pdf_private.h"
#include "sheet/fit.h"

static const double points_per_mm = POINTS_PER_INCH / MM_PER_INCH;
static const char   fixed_date[] = "D:20000101000000Z";
enum { GROUPS_MOST = 4000, /* of more, those of parts are no layers: no viewer lists as many */ COMPRESSION = 9 };

/* --- numbers and texts ---------------------------------------------------------------------------------- */

void pdf_put(text *out, const char *words)
{
    text_append_bytes(out, words, strlen(words));
}

/* Thousandths, which are as many millimetres, and a blank. */
void pdf_put_number(text *out, double value)
{
    char               digits[32];
    size_t             at = sizeof digits;
    long long          scaled = isfinite(value) ? llround(value * 1000) : 0;
    unsigned long long left = scaled < 0 ? (unsigned long long)-scaled : (unsigned long long)scaled;
    digits[--at] = ' ';
    for (int i = 0; i < 3; i++, left /= 10)
        if (left % 10 || at < sizeof digits - 1)
            digits[--at] = (char)('0' + left % 10);
    if (at < sizeof digits - 1)
        digits[--at] = '.';
    for (; left; left /= 10)
        digits[--at] = (char)('0' + left % 10);
    if (at == sizeof digits - 1)
        digits[--at] = '0';
    if (scaled < 0)
        digits[--at] = '-';
    text_append_bytes(out, digits + at, sizeof digits - at);
}

/* A text as UTF-16 with its mark, in hexadecimal. */
void pdf_put_text(text *out, const char *words)
{
    pdf_put(out, "<FEFF");
    for (const unsigned char *at = (const unsigned char *)words; *at;) {
        size_t   length = *at >= 0xF0 ? 4 : *at >= 0xE0 ? 3 : *at >= 0xC0 ? 2 : 1, seen = 1;
        uint32_t code = length == 1 ? *at : *at & (0xFFu >> (length + 1));
        for (; seen < length && (at[seen] & 0xC0) == 0x80; seen++)
            code = code << 6 | (at[seen] & 0x3F);
        if (seen < length || (length == 1 && *at >= 0x80))
            code = 0xFFFD;
        if (code > 0xFFFF)
            text_append(out, "%04X%04X", (unsigned)(0xD7C0 + (code >> 10)), (unsigned)(0xDC00 | (code & 0x3FF)));
        else
            text_append(out, "%04X", (unsigned)(code < 0x20 ? 0x20 : code));
        at += seen;
    }
    pdf_put(out, ">");
}

/* --- objects -------------------------------------------------------------------------------------------- */

static void begin_object(pdf_writer *w, size_t number)
{
    w->offsets[number] = w->out.size;
    text_append(&w->out, "%zu 0 obj\n", number);
}

/* An object that is no stream: all of these lie in one, packed together. What follows goes into `packed`. */
static void begin_packed(pdf_writer *w, size_t number)
{
    if (!mem_grow((void **)&w->packed_objects, &w->packed_capacity, w->packed_count + 1, sizeof *w->packed_objects)) {
        w->packed.failed = true;
        return;
    }
    w->packed_objects[w->packed_count++] = (pdf_packed){number, w->packed.size};
}

/* Compressed bytes as a stream; `entries`: more of its dictionary. */
static void put_stream(pdf_writer *w, const void *bytes, size_t size, const char *entries)
{
    struct libdeflate_compressor *compressor = libdeflate_alloc_compressor(COMPRESSION);
    size_t                        most = compressor ? libdeflate_zlib_compress_bound(compressor, size) : 0;
    unsigned char                *packed = compressor ? mem_alloc(most) : NULL;
    size_t                        length = packed ? libdeflate_zlib_compress(compressor, bytes, size, packed, most) : 0;
    w->out.failed = w->out.failed || !length;
    text_append(&w->out, "<</Length %zu/Filter/FlateDecode%s>>\nstream\n", length, entries);
    if (length)
        text_append_bytes(&w->out, (const char *)packed, length);
    pdf_put(&w->out, "\nendstream\nendobj\n");
    mem_free(packed);
    libdeflate_free_compressor(compressor);
}

void pdf_put_picture(pdf_writer *w, const pdf_picture *p)
{
    char entries[256];
    bool mask = p->alpha != NULL;
    for (int i = 0; i < 1 + mask; i++) {
        int size = snprintf(entries, sizeof entries,
                            "/Type/XObject/Subtype/Image/Width %d/Height %d/BitsPerComponent 8/ColorSpace/Device%s",
                            p->width, p->height, i ? "Gray" : "RGB");
        if (mask && i == 0)
            snprintf(entries + size, sizeof entries - (size_t)size, "/SMask %zu 0 R", p->object + 1);
        begin_object(w, p->object + (size_t)i);
        put_stream(w, i ? p->alpha : p->colours, (size_t)p->width * (size_t)p->height * (i ? 1 : 3), entries);
    }
}

/* A tile is so long that no line ends on the page, and has many lines, since readers round its size to their pixels.
 * Patterns are laid out on the page as it is, y up. */
static void put_pattern(pdf_writer *w, const pdf_pattern *p)
{
    static const double high = 100; /* mm, or nearly so */
    const sheet_hatch  *h = &p->hatch;
    const int           lines = (int)fmax(round(high / h->apart), 1);
    const double        wide = 2 * (hypot(w->s->width, w->s->height) + hypot(h->origin[0], h->origin[1])),
                 tall = lines * h->apart, c = points_per_mm * cos(h->angle), s = points_per_mm * sin(h->angle),
                 left = -wide / 2, top = -h->apart / 2;
    const double corner[2] = {points_per_mm * h->origin[0] + c * left - s * top,
                              points_per_mm * (w->s->height - h->origin[1]) - s * left - c * top};
    text         tile = {0}, entries = {0};
    pdf_put_number(&tile, (double)p->ink.r);
    pdf_put_number(&tile, (double)p->ink.g);
    pdf_put_number(&tile, (double)p->ink.b);
    pdf_put(&tile, "RG ");
    pdf_put_number(&tile, h->width);
    pdf_put(&tile, "w\n");
    for (int i = 0; i < lines; i++)
        text_append(&tile, "0 %.4f m %.0f %.4f l\n", (i + 0.5) * h->apart, ceil(wide), (i + 0.5) * h->apart);
    pdf_put(&tile, "S");
    text_append(&entries, "/Type/Pattern/PatternType 1/PaintType 1/TilingType 1/Resources<<>>/BBox[0 0 %.6f %.6f]",
                wide, tall);
    text_append(&entries, "/XStep %.6f/YStep %.6f/Matrix[%.9f %.9f %.9f %.9f %.6f %.6f]", wide, tall, c, -s, -s, -c,
                corner[0], corner[1]);
    begin_object(w, p->object);
    w->out.failed = w->out.failed || tile.failed || entries.failed;
    if (!w->out.failed)
        put_stream(w, tile.data, tile.size, entries.data);
    text_release(&tile);
    text_release(&entries);
}

/* --- layers --------------------------------------------------------------------------------------------- */

static bool is_layer(const pdf_writer *w, size_t group)
{
    if (w->s->group_count <= GROUPS_MOST)
        return true;
    for (int32_t at = (int32_t)group; at >= 0; at = w->s->groups[at].parent)
        if (w->s->groups[at].part)
            return false;
    return true;
}

static void put_layers(pdf_writer *w)
{
    for (size_t i = 0; i < w->s->group_count; i++) {
        const sheet_group *g = &w->s->groups[i];
        if (!w->layers[i])
            continue;
        begin_packed(w, w->layers[i]);
        pdf_put(&w->packed, "<</Type/OCG/Name");
        pdf_put_text(&w->packed, g->name && *g->name ? g->name : "group");
        pdf_put(&w->packed, ">>\n");
    }
}

/* The tree of layers as viewers show it: behind a layer stands an array of those in it. Parents come first, but not
 * their children in a row, so they are gathered by links. */
static void put_order(pdf_writer *w)
{
    size_t    count = w->s->group_count;
    uint32_t *links = mem_calloc(3 * count + 3, sizeof *links), *first = links,
             *next = links ? links + count + 1 : NULL, *stack = links ? next + count + 1 : NULL;
    w->packed.failed = w->packed.failed || !links;
    for (size_t i = count; links && i-- > 0;) {
        size_t parent = (size_t)(w->s->groups[i].parent + 1);
        if (!w->layers[i])
            continue;
        next[i] = first[parent];
        first[parent] = (uint32_t)i + 1;
    }
    size_t depth = 0;
    for (uint32_t at = links ? first[0] : 0; at || depth;) {
        if (!at) {
            pdf_put(&w->packed, "]");
            at = stack[--depth];
            continue;
        }
        text_append(&w->packed, "%zu 0 R ", w->layers[at - 1]);
        if (first[at]) {
            pdf_put(&w->packed, "[");
            stack[depth++] = next[at - 1];
            at = first[at];
        } else {
            at = next[at - 1];
        }
    }
    mem_free(links);
}

static void put_catalog(pdf_writer *w)
{
    begin_packed(w, PDF_CATALOG);
    text_append(&w->packed, "<</Type/Catalog/Pages %d 0 R", PDF_PAGES);
    if (w->layer_count) {
        pdf_put(&w->packed, "/PageMode/UseOC/OCProperties<</OCGs[");
        for (size_t i = 0; i < w->s->group_count; i++)
            if (w->layers[i])
                text_append(&w->packed, "%zu 0 R ", w->layers[i]);
        pdf_put(&w->packed, "]/D<</Order[");
        put_order(w);
        pdf_put(&w->packed, "]>>>>");
    }
    pdf_put(&w->packed, ">>\n");
}

/* --- what lies on the page ------------------------------------------------------------------------------ */

static void put_pages(pdf_writer *w)
{
    begin_packed(w, PDF_PAGES);
    text_append(&w->packed, "<</Type/Pages/Count 1/Kids[%d 0 R]>>\n", PDF_PAGE);
    begin_packed(w, PDF_PAGE);
    text_append(&w->packed, "<</Type/Page/Parent %d 0 R/Contents %d 0 R/MediaBox[0 0 ", PDF_PAGES, PDF_CONTENTS);
    pdf_put_number(&w->packed, w->s->width * points_per_mm);
    pdf_put_number(&w->packed, w->s->height * points_per_mm);
    text_append(&w->packed, "]/Group<</S/Transparency/CS/DeviceRGB>>/Resources<</Font<</F %d 0 R>>", PDF_FONT);
    pdf_put(&w->packed, "/ExtGState<<");
    for (size_t i = 0; i < w->opacity_count; i++) {
        text_append(&w->packed, "/A%zu<</CA ", i);
        pdf_put_number(&w->packed, w->opacities[i]);
        pdf_put(&w->packed, "/ca ");
        pdf_put_number(&w->packed, w->opacities[i]);
        pdf_put(&w->packed, ">>");
    }
    pdf_put(&w->packed, ">>/Properties<<");
    for (size_t i = 0; i < w->s->group_count; i++)
        if (w->layers[i])
            text_append(&w->packed, "/L%zu %zu 0 R", i, w->layers[i]);
    pdf_put(&w->packed, ">>/XObject<<");
    for (size_t i = 0; i < w->picture_count; i++)
        text_append(&w->packed, "/X%zu %zu 0 R", i, w->pictures[i].object);
    pdf_put(&w->packed, ">>/Pattern<<");
    for (size_t i = 0; i < w->pattern_count; i++)
        text_append(&w->packed, "/P%zu %zu 0 R", i, w->patterns[i].object);
    pdf_put(&w->packed, ">>>>>>\n");
    begin_packed(w, PDF_FONT);
    pdf_put(&w->packed, "<</Type/Font/Subtype/Type1/BaseFont/Helvetica>>\n");
}

static void put_info(pdf_writer *w)
{
    begin_packed(w, PDF_INFO);
    pdf_put(&w->packed, "<<");
    if (w->s->title && *w->s->title) {
        pdf_put(&w->packed, "/Title");
        pdf_put_text(&w->packed, w->s->title);
    }
    if (w->s->description && *w->s->description) {
        pdf_put(&w->packed, "/Subject");
        pdf_put_text(&w->packed, w->s->description);
    }
    text_append(&w->packed, "/Creator(Limner)/Producer(Limner)/CreationDate(%s)/ModDate(%s)>>\n", fixed_date,
                fixed_date);
}

/* Numbers and places of the packed objects stand before them. */
static void put_packed(pdf_writer *w, size_t number)
{
    text all = {0};
    char entries[96];
    for (size_t i = 0; i < w->packed_count; i++)
        text_append(&all, "%zu %zu ", w->packed_objects[i].number, w->packed_objects[i].place);
    snprintf(entries, sizeof entries, "/Type/ObjStm/N %zu/First %zu", w->packed_count, all.size);
    text_append_bytes(&all, w->packed.data ? w->packed.data : "", w->packed.size);
    begin_object(w, number);
    put_stream(w, all.data, all.size, entries);
    w->out.failed = w->out.failed || all.failed || w->packed.failed;
    text_release(&all);
}

static void put_row(unsigned char *row, unsigned kind, size_t place, size_t index)
{
    const size_t numbers[2] = {place, index};
    row[0] = (unsigned char)kind;
    for (int k = 0; k < 2; k++)
        for (int i = 0; i < PDF_PLACE_BYTES; i++)
            row[1 + PDF_PLACE_BYTES * k + i] = (unsigned char)(numbers[k] >> (8 * (PDF_PLACE_BYTES - 1 - i)));
}

/* Where all objects are, as a stream: a row of a kind (0 none, 1 in the file, 2 packed) and two numbers each. */
static void put_references(pdf_writer *w, size_t packed, size_t number)
{
    enum { ROW = 1 + 2 * PDF_PLACE_BYTES };
    size_t         at = w->out.size, count = number + 1;
    unsigned char *rows = mem_calloc(count, ROW);
    char           entries[160];
    begin_object(w, number);
    for (size_t i = 0; rows && i < count; i++)
        put_row(rows + ROW * i, i > 0, w->offsets[i], i ? 0 : 65535);
    for (size_t i = 0; rows && i < w->packed_count; i++)
        put_row(rows + ROW * w->packed_objects[i].number, 2, packed, i);
    snprintf(entries, sizeof entries, "/Type/XRef/Size %zu/W[1 %d %d]/Root %d 0 R/Info %d 0 R", count, PDF_PLACE_BYTES,
             PDF_PLACE_BYTES, PDF_CATALOG, PDF_INFO);
    put_stream(w, rows, rows ? count * ROW : 0, entries);
    w->out.failed = w->out.failed || !rows;
    mem_free(rows);
    text_append(&w->out, "startxref\n%zu\n%%%%EOF\n", at);
}

static void put_file(pdf_writer *w)
{
    const size_t packed = w->object_count++, references = w->object_count++;
    w->offsets = mem_calloc(w->object_count + 1, sizeof *w->offsets);
    w->out.failed = w->out.failed || !w->offsets;
    if (w->out.failed)
        return;
    pdf_put(&w->out, "%PDF-1.5\n%\xE2\xE3\xCF\xD3\n");
    begin_object(w, PDF_CONTENTS);
    put_stream(w, w->content.data, w->content.size, "");
    for (size_t i = 0; i < w->picture_count; i++)
        pdf_put_picture(w, &w->pictures[i]);
    for (size_t i = 0; i < w->pattern_count; i++)
        put_pattern(w, &w->patterns[i]);
    put_catalog(w);
    put_pages(w);
    put_info(w);
    put_layers(w);
    put_packed(w, packed);
    put_references(w, packed, references);
}

lmn_status export_pdf(export_bytes *out, const sheet *s, lmn_error *error)
{
    pdf_writer w = {.s = s, .object_count = PDF_OTHERS};
    *out = (export_bytes){NULL, 0};
    w.layers = mem_calloc(s->group_count + 1, sizeof *w.layers);
    w.out.failed = s->failed || !w.layers;
    for (size_t i = 0; w.layers && i < s->group_count; i++)
        if (is_layer(&w, i)) {
            w.layers[i] = w.object_count++;
            w.layer_count++;
        }
    if (!w.out.failed)
        pdf_put_content(&w, points_per_mm);
    w.out.failed = w.out.failed || w.content.failed || work_stopped();
    if (!w.out.failed)
        put_file(&w);
    for (size_t i = 0; i < w.picture_count; i++) {
        mem_free(w.pictures[i].colours);
        mem_free(w.pictures[i].alpha);
    }
    mem_free(w.pictures);
    mem_free(w.patterns);
    mem_free(w.opacities);
    mem_free(w.layers);
    mem_free(w.offsets);
    mem_free(w.packed_objects);
    text_release(&w.packed);
    text_release(&w.content);
    out->size = w.out.size;
    out->data = (unsigned char *)text_take(&w.out);
    return out->data ? LMN_OK : error_memory(error);
}
