/* Outlines of letters: Fontconfig finds the font, HarfBuzz says which glyphs stand where, FreeType has their curves. The three take
 * memory past base/memory.h and give it back, but for what Fontconfig keeps about the installed fonts. */
#include <fontconfig/fontconfig.h>
#include <ft2build.h>
#include FT_FREETYPE_H
#include FT_GLYPH_H
#include FT_OUTLINE_H
#include <hb-ft.h>
#include <math.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "construct/construct_private.h"

/* OpenSCAD sets every font at this size, in 64ths of a point, at 100 dots an inch, and scales the outlines from there. */
#define FONT_SIZE       100000
#define FONT_RESOLUTION 100
/* What lies between glyphs comes out a little smaller than the glyphs themselves: 1000 by 1024. So it is there. */
#define PLACE_SCALE (1.0 / 102400)
#define PIXEL       64

typedef struct lettering {
    FT_Library       library;
    FT_Face          face;
    hb_font_t       *font;
    hb_buffer_t     *buffer;
    double           size, spacing;
    int              segments; /* of one curve */
    double           x, y;     /* where the glyph begins */
    point2           last;     /* where the curve begins, in the font's units */
    region_builder   outline;  /* of one glyph */
    size_t           points;   /* of all glyphs so far */
    region          *glyphs;
    size_t           glyph_count;
} lettering;

/* --- the font -------------------------------------------------------------------------------------------------------- */

/* Is one of the wanted families that of the match? A pattern without a family has no wish. */
static bool family_matches(FcPattern *wanted, FcPattern *match)
{
    FcChar8 *name, *found;
    if (FcPatternGetString(wanted, FC_FAMILY, 0, &name) != FcResultMatch)
        return true;
    for (int i = 0; FcPatternGetString(wanted, FC_FAMILY, i, &name) == FcResultMatch; i++)
        for (int k = 0; FcPatternGetString(match, FC_FAMILY, k, &found) == FcResultMatch; k++)
            if (FcStrCmpIgnoreCase(name, found) == 0)
                return true;
    return false;
}

/* The best font for the pattern; NULL when there is none at all. */
static FcPattern *match_font(const char *name, bool *missing)
{
    FcPattern *wanted = FcNameParse((const FcChar8 *)(name && *name ? name : "Liberation Sans"));
    FcPattern *asked = wanted ? FcPatternDuplicate(wanted) : NULL, *match = NULL;
    FcResult result;
    if (asked && FcPatternAddBool(asked, FC_SCALABLE, FcTrue) && FcConfigSubstitute(NULL, asked, FcMatchPattern)) {
        FcDefaultSubstitute(asked);
        match = FcFontMatch(NULL, asked, &result);
    }
    *missing = match && !family_matches(wanted, match);
    if (asked)
        FcPatternDestroy(asked);
    if (wanted)
        FcPatternDestroy(wanted);
    return match;
}

static lmn_status open_font(lettering *l, const char *name, bool *missing, lmn_error *error)
{
    FcChar8 *file;
    int index = 0;
    FcPattern *match = match_font(name, missing);
    if (!match || FcPatternGetString(match, FC_FILE, 0, &file) != FcResultMatch) {
        if (match)
            FcPatternDestroy(match);
        error_set(error, LMN_UNSUPPORTED, "text: no font is installed");
        error_hint(error, "install one, such as the Liberation fonts");
        return LMN_UNSUPPORTED;
    }
    FcPatternGetInteger(match, FC_INDEX, 0, &index);
    bool opened = FT_Init_FreeType(&l->library) == 0 && FT_New_Face(l->library, (const char *)file, index, &l->face) == 0 &&
                  FT_Set_Char_Size(l->face, 0, FONT_SIZE, FONT_RESOLUTION, FONT_RESOLUTION) == 0;
    lmn_status status = LMN_OK;
    if (!opened)
        status = error_in_file(error, LMN_UNSUPPORTED, (const char *)file, 0, "text: the font cannot be read");
    FcPatternDestroy(match);
    return status;
}

/* --- from letters to glyphs -------------------------------------------------------------------------------------------- */

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
    hb_buffer_set_language(l->buffer, hb_language_from_string(style->language && *style->language ? style->language : "en", -1));
    hb_buffer_guess_segment_properties(l->buffer);
    hb_shape(l->font, l->buffer, NULL, 0);
    return hb_buffer_allocation_successful(l->buffer) ? LMN_OK : error_memory(error);
}

/* --- where the text stands ------------------------------------------------------------------------------------------- */

/* All in units of the font. */
typedef struct extent {
    double advance_x, advance_y; /* with spacing */
    double width, ascent, descent; /* of the glyphs' boxes in whole pixels */
} extent;

static extent measure(const lettering *l)
{
    unsigned count;
    hb_glyph_info_t *glyphs = hb_buffer_get_glyph_infos(l->buffer, &count);
    hb_glyph_position_t *places = hb_buffer_get_glyph_positions(l->buffer, &count);
    extent e = {0};
    for (unsigned i = 0; i < count; i++) {
        FT_BBox box;
        FT_Glyph glyph;
        e.advance_x += places[i].x_advance * l->spacing;
        e.advance_y += places[i].y_advance * l->spacing;
        if (FT_Load_Glyph(l->face, glyphs[i].codepoint, FT_LOAD_DEFAULT) != 0 || FT_Get_Glyph(l->face->glyph, &glyph) != 0)
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
    bool vertical = HB_DIRECTION_IS_VERTICAL(hb_buffer_get_direction(l->buffer));
    double width = vertical ? e.width : e.advance_x, top = vertical ? e.advance_y : e.ascent, bottom = vertical ? 0 : e.descent;
    l->x = is(style->halign, "right") ? -width : is(style->halign, "center") ? -width / 2 : 0;
    if (is(style->valign, "top"))
        l->y = -top;
    else if (is(style->valign, "center"))
        l->y = -(top + bottom) / 2;
    else if (is(style->valign, "bottom"))
        l->y = -bottom;
}

/* --- from glyphs to outlines ------------------------------------------------------------------------------------------- */

static void add_point(lettering *l, double x, double y)
{
    if (l->points++ < LIMIT_SHAPE_POINTS)
        builder_place(&l->outline, (x / FONT_SIZE + l->x * PLACE_SCALE) * l->size, (y / FONT_SIZE + l->y * PLACE_SCALE) * l->size);
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
    point2 from = l->last;
    for (int i = 1; i <= l->segments && l->points < LIMIT_SHAPE_POINTS; i++) {
        double t = (double)i / l->segments, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
        add_point(l, a * from.x + b * (double)middle->x + c * (double)to->x, a * from.y + b * (double)middle->y + c * (double)to->y);
    }
    return l->outline.failed;
}

static int on_cubic(const FT_Vector *first, const FT_Vector *second, const FT_Vector *to, void *user)
{
    lettering *l = user;
    point2 from = l->last;
    for (int i = 1; i <= l->segments && l->points < LIMIT_SHAPE_POINTS; i++) {
        double t = (double)i / l->segments, s = 1 - t, a = s * s * s, b = 3 * s * s * t, c = 3 * s * t * t, d = t * t * t;
        add_point(l, a * from.x + b * (double)first->x + c * (double)second->x + d * (double)to->x,
                  a * from.y + b * (double)first->y + c * (double)second->y + d * (double)to->y);
    }
    return l->outline.failed;
}

/* The glyph's outline where it stands, by the even-odd rule. */
static lmn_status add_glyph(lettering *l, unsigned glyph, const hb_glyph_position_t *place, lmn_error *error)
{
    static const FT_Outline_Funcs functions = {on_move, on_line, on_conic, on_cubic, 0, 0};
    l->x += place->x_offset;
    l->y += place->y_offset;
    if (FT_Load_Glyph(l->face, glyph, FT_LOAD_DEFAULT) == 0 && l->face->glyph->format == FT_GLYPH_FORMAT_OUTLINE)
        FT_Outline_Decompose(&l->face->glyph->outline, &functions, l);
    l->x += place->x_advance * l->spacing - place->x_offset;
    l->y += place->y_advance * l->spacing - place->y_offset;
    if (l->outline.count > 0)
        builder_end_contour(&l->outline);
    region outline;
    lmn_status status = region_builder_finish(&l->outline, &outline, error);
    if (status == LMN_OK)
        status = check_point_count("text", (double)l->points, error);
    if (status == LMN_OK)
        status = region_cover(&l->glyphs[l->glyph_count], &outline, 1, COVER_ODD, error);
    l->glyph_count += status == LMN_OK;
    region_release(&outline);
    return status;
}

static lmn_status add_glyphs(lettering *l, lmn_error *error)
{
    unsigned count;
    hb_glyph_info_t *glyphs = hb_buffer_get_glyph_infos(l->buffer, &count);
    hb_glyph_position_t *places = hb_buffer_get_glyph_positions(l->buffer, &count);
    l->glyphs = mem_calloc(count, sizeof *l->glyphs);
    if (!l->glyphs)
        return error_memory(error);
    lmn_status status = LMN_OK;
    for (unsigned i = 0; status == LMN_OK && i < count; i++)
        status = add_glyph(l, glyphs[i].codepoint, &places[i], error);
    return status;
}

static void lettering_release(lettering *l)
{
    for (size_t i = 0; i < l->glyph_count; i++)
        region_release(&l->glyphs[i]);
    mem_free(l->glyphs);
    region_builder_release(&l->outline);
    hb_buffer_destroy(l->buffer);
    hb_font_destroy(l->font);
    if (l->face)
        FT_Done_Face(l->face);
    if (l->library)
        FT_Done_FreeType(l->library);
}

lmn_status construct_text(region *out, const char *utf8, const text_style *style, facets f, bool *missing, lmn_error *error)
{
    *out = (region){0};
    *missing = false;
    lmn_status status = check_numbers("text", (double[]){style->size, style->spacing}, 2, error);
    if (status == LMN_OK)
        status = check_point_count("text", (double)strlen(utf8), error);
    if (status != LMN_OK || style->size == 0 || !*utf8)
        return status;
    /* A curve has an eighth of a circle's facets. */
    lettering l = {.size = style->size, .spacing = style->spacing, .segments = facets_of_circle(style->size, f) / 8 + 1};
    l.segments = l.segments < 2 ? 2 : l.segments;
    status = open_font(&l, style->font, missing, error);
    if (status == LMN_OK)
        status = shape(&l, utf8, style, error);
    if (status == LMN_OK) {
        align(&l, style);
        status = add_glyphs(&l, error);
    }
    if (status == LMN_OK)
        status = region_combine(out, l.glyphs, l.glyph_count, REGION_UNION, error);
    lettering_release(&l);
    return status;
}
