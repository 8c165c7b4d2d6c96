/* Export: pictures to bytes. One file a format; export.c holds the table. */
#ifndef LIMNER_EXPORT_EXPORT_H
#define LIMNER_EXPORT_EXPORT_H

#include "base/error.h"
#include "sheet/sheet.h"

/* Bytes in memory, owned by the caller (mem_free). */
typedef struct export_bytes {
    unsigned char *data;
    size_t         size;
} export_bytes;

/* PNG of 8-bit RGBA pixels, row 0 on top, straight alpha; written as RGB when everything is opaque. Errors:
 * LMN_MEMORY. */
lmn_status export_png(export_bytes *out, const uint8_t *rgba, int width, int height, lmn_error *error);
/* PNG of one 16-bit grey channel (native byte order). */
lmn_status export_png_grey16(export_bytes *out, const uint16_t *grey, int width, int height, lmn_error *error);
/* PNG of 8-bit RGBA that keeps all four channels as they are. */
lmn_status export_png_raw(export_bytes *out, const uint8_t *rgba, int width, int height, lmn_error *error);
/* PFM of 1 or 3 floats a pixel, row 0 at the bottom. */
lmn_status export_pfm(export_bytes *out, const float *values, int channels, int width, int height, lmn_error *error);

/* A sheet as SVG, PDF or DXF (release 2000, ASCII). The same sheet, the same bytes. Errors: LMN_MEMORY, also where the
 * sheet is not whole; LMN_INTERNAL when the PDF library fails. */
lmn_status export_svg(export_bytes *out, const sheet *s, lmn_error *error);
lmn_status export_pdf(export_bytes *out, const sheet *s, lmn_error *error);
lmn_status export_dxf(export_bytes *out, const sheet *s, lmn_error *error);

/* Lays a sheet over a picture of 8-bit RGBA pixels, row 0 on top, straight alpha, which it covers whole. The pixels are
 * those of a part of the picture: x and y of its upper left corner, width, height. Errors: LMN_MEMORY. */
lmn_status export_paint(uint8_t *rgba, const int part[4], int width, int height, const sheet *s, lmn_error *error);
/* How long one line of text of this size is, as sheet_add_text has it, in the unit of the size. Errors: LMN_MEMORY. */
lmn_status export_text_width(double *out, const char *utf8, double size, lmn_error *error);

/* A format of drawings: of pixels or of sheets, whichever writer it has. */
typedef struct export_format {
    const char *ending;                         /* ".svg" */
    const char *doc;                            /* what it is: one line that ends in a full stop */
    bool        ground, pictures, areas, title; /* lmn_format_info */
    lmn_status (*write_pixels)(export_bytes *out, const uint8_t *rgba, int width, int height, lmn_error *error);
    lmn_status (*write_sheet)(export_bytes *out, const sheet *s, lmn_error *error);
} export_format;

extern const export_format export_formats[];
extern const size_t        export_format_count;

/* Chooses a format of sheets, or of pixels: `format` with or without the dot, or the path's ending where that is
 * NULL, the first one for the path "-". Errors: LMN_USAGE. */
lmn_status export_choose(const export_format **out, const char *path, const char *format, bool sheets,
                         lmn_error *error);

#endif
