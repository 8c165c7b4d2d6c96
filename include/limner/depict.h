/* Depiction: signs that tell what happens in a scene, as arrows for ways, ghost images, motion lines, stars where
 * things meet. They are put into the scene as content, so that lmn_draw and lmn_draw_sheet draw them with any look.
 * Nienhaus 2005, chapter 7. No GL context needed. A scene is changed by one thread at a time and never while it is
 * drawn. All since 0.1. */
#ifndef LIMNER_DEPICT_H
#define LIMNER_DEPICT_H

#include "limner/draw.h"
#include "limner/rules.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What is told. Initialise with LMN_DEPICT_DESC_INIT. */
typedef struct lmn_depict_desc {
    size_t struct_size;
    /* JSON: an array of expressions (docs/DEPICTION.md), each with its "target", what is to be depicted of it and how,
     * or an object, as a whole script, that has them as "expressions". NULL: chosen from what moves in the scene. */
    const char *expressions;
    bool        interval_given; /* else the whole of the clips */
    double      from_s, to_s;   /* where nothing else is said; seconds */
} lmn_depict_desc;
#define LMN_DEPICT_DESC_INIT                                                                                           \
    {                                                                                                                  \
        sizeof(lmn_depict_desc), NULL, false, 0, 0                                                                     \
    }

/* Puts signs into the scene, in place of those of an earlier call: nodes below one called "glyphs", which looks select
 * by [glyph=arrow], [of=NAME] and [when=past]. They turn to the viewer that `draw` places, and tell past and future of
 * its time. Things for which ghost images stand are hidden. `json` (may be NULL) gets
 * {"expressions", "reasons", "warnings"}: what was told, where it was chosen why, and what could not be told and why
 * not; free it with lmn_text_free. Its expressions put the same signs there again, to the byte. Errors: LMN_USAGE (the
 * description), LMN_FORMAT (no JSON, an expression that is wrong or cannot be told; with line and column),
 * LMN_UNSUPPORTED (letters that no font has), LMN_LIMIT, LMN_MEMORY, LMN_CANCELLED; then the scene has no signs. Where
 * memory is missing while those of an earlier call are taken out, changes stay open: lmn_scene_end_changes. */
LMN_API lmn_status lmn_depict(lmn_scene *scene, const lmn_draw_desc *draw, const lmn_depict_desc *desc, char **json,
                              lmn_error *error);

/* Takes all signs out of the scene and shows what was hidden for them. Errors: LMN_USAGE, LMN_MEMORY (then changes stay
 * open: lmn_scene_end_changes). */
LMN_API lmn_status lmn_depict_clear(lmn_scene *scene, lmn_error *error);

/* Adds rules behind all others for signs that have to be read: letters in ink, balloons and the like of plain paper
 * where the look hatches or leaves colour out. A look that selects signs by itself ("[glyph=…]") stays as it is.
 * Errors: LMN_USAGE, LMN_MEMORY. */
LMN_API lmn_status lmn_look_add_sign_rules(lmn_look *look, lmn_error *error);

/* The ways to depict something, one after the other. */
typedef struct lmn_depiction_info {
    const char *name;      /* as expressions call it; static, as all text here */
    const char *semantics; /* of which things alone; NULL: any */
    const char *doc;
    size_t      param_count;
} lmn_depiction_info;
LMN_API bool lmn_depiction_at(size_t index, lmn_depiction_info *out);

/* The parameters of one of them, as expressions have them; false when there is no such way or parameter. */
LMN_API bool lmn_depiction_param_at(size_t index, size_t param_index, lmn_param_info *out);

/* All of them with their parameters as a page of Markdown (docs/reference/depictions.md). Free with lmn_text_free.
 * NULL when memory is gone. */
LMN_API char *lmn_depiction_reference(void);

#ifdef __cplusplus
}
#endif
#endif
