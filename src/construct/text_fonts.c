/* Which installed fonts a text is set in: Fontconfig knows what each has. It takes memory past base/memory.h and gives
 * it back, but for what it keeps about the installed fonts. */
#include "construct/text_fonts.h"

#include <fontconfig/fontconfig.h>
#include <hb.h>
#include <stdio.h>
#include <string.h>

#include "base/memory.h"

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
    FcResult   result;
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

/* The name comes from the model: Fontconfig's parser of names sees no more than NAME_LONGEST of it. */
static lmn_status check_name(const char *name, lmn_error *error)
{
    enum { NAME_LONGEST = 256 };
    if (name && strlen(name) > NAME_LONGEST)
        return error_set(error, LMN_FORMAT, "text: the name of the font has %zu letters; allowed are %d", strlen(name),
                         NAME_LONGEST);
    return LMN_OK;
}

static lmn_status no_font(lmn_error *error)
{
    error_set(error, LMN_UNSUPPORTED, "text: no font is installed");
    error_hint(error, "install one, such as the Liberation fonts");
    return LMN_UNSUPPORTED;
}

static lmn_status add_run(text_runs *out, const char *words, size_t size, const FcPattern *font, lmn_error *error)
{
    FcChar8 *file;
    if (FcPatternGetString(font, FC_FILE, 0, &file) != FcResultMatch)
        return no_font(error);
    if (!mem_grow((void **)&out->items, &out->capacity, out->count + 1, sizeof *out->items))
        return error_memory(error);
    text_run *run = &out->items[out->count];
    *run = (text_run){.words = mem_alloc(size + 1), .file = mem_copy_text((const char *)file)};
    FcPatternGetInteger(font, FC_INDEX, 0, &run->face);
    out->count++;
    if (!run->words || !run->file)
        return error_memory(error);
    memcpy(run->words, words, size);
    run->words[size] = '\0';
    return LMN_OK;
}

void text_runs_release(text_runs *r)
{
    for (size_t i = 0; i < r->count; i++) {
        mem_free(r->items[i].words);
        mem_free(r->items[i].file);
    }
    mem_free(r->items);
    memset(r, 0, sizeof *r);
}

lmn_status text_runs_whole(text_runs *out, const char *utf8, const char *font, bool *missing, lmn_error *error)
{
    lmn_status status = check_name(font, error);
    if (status != LMN_OK)
        return status;
    FcPattern *match = match_font(font, missing);
    status = match ? add_run(out, utf8, strlen(utf8), match, error) : no_font(error);
    if (match)
        FcPatternDestroy(match);
    return status;
}

/* --- several fonts -------------------------------------------------------------------------------------- */

/* All fonts, the nearest to the wanted one first. */
static FcFontSet *sorted_fonts(const char *name)
{
    FcPattern *wanted = FcNameParse((const FcChar8 *)(name && *name ? name : "Liberation Sans"));
    FcFontSet *fonts = NULL;
    FcResult   result;
    if (wanted && FcPatternAddBool(wanted, FC_SCALABLE, FcTrue) && FcConfigSubstitute(NULL, wanted, FcMatchPattern)) {
        FcDefaultSubstitute(wanted);
        fonts = FcFontSort(NULL, wanted, FcTrue, NULL, &result);
    }
    if (wanted)
        FcPatternDestroy(wanted);
    return fonts;
}

/* Fonts of coloured pictures have no outlines. */
static bool font_has(const FcPattern *font, FcChar32 letter)
{
    FcCharSet *has;
    FcBool     coloured = FcFalse;
    if (FcPatternGetBool(font, FC_COLOR, 0, &coloured) == FcResultMatch && coloured)
        return false;
    return FcPatternGetCharSet(font, FC_CHARSET, 0, &has) == FcResultMatch && FcCharSetHasChar(has, letter);
}

typedef struct run_place {
    size_t from, to; /* bytes */
    int    font;     /* NONE_YET: of neutral characters alone */
    int    sense;    /* 1: to the right, −1: to the left, 0: not known yet */
} run_place;

enum { RUNS_MOST = 256, NONE_YET = -1 };

static int sense_of(hb_codepoint_t letter)
{
    const hb_script_t script = hb_unicode_script(hb_unicode_funcs_get_default(), letter);
    if (script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED || script == HB_SCRIPT_UNKNOWN)
        return 0;
    return hb_script_get_horizontal_direction(script) == HB_DIRECTION_RTL ? -1 : 1;
}

/* The first font that has it; of what belongs to no script, the one before it if that has it. NONE_YET: there is none.
 */
static int font_for(const FcFontSet *fonts, FcChar32 letter, int before)
{
    const hb_script_t script = hb_unicode_script(hb_unicode_funcs_get_default(), letter);
    if (before >= 0 && (script == HB_SCRIPT_COMMON || script == HB_SCRIPT_INHERITED) &&
        font_has(fonts->fonts[before], letter))
        return before;
    for (int i = 0; i < fonts->nfont; i++)
        if (font_has(fonts->fonts[i], letter))
            return i;
    return NONE_YET;
}

static lmn_status refuse_letters(const char *missing, lmn_error *error)
{
    error_set(error, LMN_UNSUPPORTED, "text: no installed font has%s", missing);
    error_hint(error, "install a font that has them, such as one of the Noto fonts, or write other words");
    return LMN_UNSUPPORTED;
}

/* Splits a text where font or direction change; what has no direction goes with what it follows. *count gets how many;
 * more than RUNS_MOST end in the last one. */
static lmn_status split(run_place *runs, size_t *count, const FcFontSet *fonts, const char *utf8, lmn_error *error)
{
    char   missing[200] = "";
    size_t at = 0, named = 0, size = strlen(utf8);
    *count = 0;
    while (at < size) {
        FcChar32  letter;
        const int bytes = FcUtf8ToUcs4((const FcChar8 *)utf8 + at, &letter, (int)(size - at));
        if (bytes <= 0)
            return error_set(error, LMN_FORMAT, "text: byte %zu is no UTF-8", at);
        run_place *last = *count ? &runs[*count - 1] : NULL;
        const int  sense = sense_of(letter), font = font_for(fonts, letter, last ? last->font : NONE_YET);
        if (font == NONE_YET && named < sizeof missing - 32)
            named += (size_t)snprintf(missing + named, sizeof missing - named, "%s %.*s (U+%04X)", named ? "," : "",
                                      bytes, utf8 + at, (unsigned)letter);
        if (!last || ((font != last->font || (sense && last->sense && sense != last->sense)) && *count < RUNS_MOST))
            runs[(*count)++] = (run_place){at, at, font, sense};
        last = &runs[*count - 1];
        last->sense = last->sense ? last->sense : sense;
        at += (size_t)bytes;
        last->to = at;
    }
    return named ? refuse_letters(missing, error) : LMN_OK;
}

/* The order in which runs stand from left to right: neighbours of one direction go together; the whole begins at the
 * side from which its first one runs. */
static void order_runs(const run_place *runs, size_t count, size_t order[RUNS_MOST])
{
    int    sense = 0;
    size_t put = 0;
    for (size_t i = 0; i < count && sense == 0; i++)
        sense = runs[i].sense;
    for (size_t k = 0; k < count;) {
        /* Groups from the front, or from the end. */
        const size_t first = sense < 0 ? count - 1 - k : k;
        size_t       size = 1;
        while (k + size < count) {
            const size_t next = sense < 0 ? first - size : first + size;
            if ((runs[next].sense < 0) != (runs[first].sense < 0))
                break;
            size++;
        }
        const size_t lowest = sense < 0 ? first - size + 1 : first;
        for (size_t i = 0; i < size; i++)
            order[put++] = runs[first].sense < 0 ? lowest + size - 1 - i : lowest + i;
        k += size;
    }
}

lmn_status text_runs_find(text_runs *out, const char *utf8, const char *font, lmn_error *error)
{
    run_place  runs[RUNS_MOST];
    size_t     count = 0, order[RUNS_MOST];
    lmn_status status = check_name(font, error);
    if (status != LMN_OK)
        return status;
    FcFontSet *fonts = sorted_fonts(font);
    status = fonts && fonts->nfont > 0 ? split(runs, &count, fonts, utf8, error) : no_font(error);
    order_runs(runs, count, order);
    for (size_t i = 0; i < count && status == LMN_OK; i++) {
        const run_place *r = &runs[order[i]];
        status = add_run(out, utf8 + r->from, r->to - r->from, fonts->fonts[r->font], error);
    }
    if (fonts)
        FcFontSetDestroy(fonts);
    return status;
}
