/* Stars and clouds of dust, with what they sound like. */
#include "depict/page.h"

static lmn_status put_shape(depict_job *j, const expression *e, const double at[3], double lift, uint32_t which,
                            const burst_style *style, double share, colour tint, glyph_tense when, lmn_error *error)
{
    glyph_mesh m = {0};
    page_place place;
    page_place_at(&place, j, at, lift);
    if (style->cloud)
        glyph_put_cloud(&m, &place, style->radius * share, style->radius * share * 0.8, 9);
    else
        glyph_put_star(&m, j, e, &place, which, &(star){style->radius, share, style->spikes});
    lmn_status status = glyph_put(j, &m, &(glyph_label){style->cloud ? "cloud" : "star", e->target, when, tint}, error);
    glyph_mesh_release(&m);
    return status;
}

lmn_status glyph_put_burst(depict_job *j, const expression *e, const double at[3], double lift, uint32_t which,
                           const burst_style *style, glyph_tense when, lmn_error *error)
{
    const double layer = style->radius * 0.08;
    lmn_status   status = put_shape(j, e, at, lift, which, style, 1, style->rim, when, error);
    if (status == LMN_OK)
        status =
            put_shape(j, e, at, lift + layer, which, style, style->cloud ? 0.88 : 0.74, style->colour, when, error);
    if (status == LMN_OK && style->text[0]) {
        glyph_mesh m = {0};
        page_place place;
        double     size[2];
        page_place_at(&place, j, at, lift + 2 * layer);
        page_turn(&place, 0.16);
        status = glyph_put_lettering(&m, j, &place,
                                     &(lettering_style){style->text, 12, style->radius * 0.42, style->radius * 1.15},
                                     size, error);
        if (status == LMN_OK)
            status = glyph_put(j, &m, &(glyph_label){"noise", e->target, when, style->letters}, error);
        glyph_mesh_release(&m);
    }
    return status;
}
