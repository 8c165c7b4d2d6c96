/* Hatching of cut faces on the sheet: each line on its own, in groups of their parts. */
#include "stroke/hatch.h"

#include "base/memory.h"
#include "vector/vector_private.h"

lmn_status vector_put_hatch(const vector_ink *ink, const stroke_view *view, const scene_values *v, const bool *parts,
                            const colour *colours, uint64_t *count, stroke_check *check, lmn_error *error)
{
    hatch_lines lines;
    lmn_status  status = hatch_find(&lines, view, (double)v->cut_hatch,
                                    (double)v->cut_angle * (3.14159265358979323846 / 180), parts, error);
    int32_t     all = -1;
    uint32_t    own = 0, part = 0;
    for (size_t i = 0; i < lines.count && status == LMN_OK; i++) {
        const hatch_line *l = &lines.items[i];
        double            ends[2][2];
        if (all < 0)
            all = (int32_t)sheet_add_group(ink->page, (int32_t)ink->group, "hatch", "hatch", 0);
        if (l->part != part) {
            part = l->part;
            own = sheet_add_group(ink->page, all, ink->scene->parts[part - 1].name, "hatch", part);
        }
        for (int k = 0; k < 4; k++)
            ends[k / 2][k % 2] = ink->origin[k % 2] + (double)l->ends[k / 2][k % 2] / VECTOR_PIXELS_PER_MM;
        sheet_add_line(ink->page, own, colours[part - 1], ends[0], ends[1],
                       (double)v->cut_width / VECTOR_PIXELS_PER_MM);
    }
    *count += lines.count;
    if (status == LMN_OK && check && lines.count)
        status = hatch_verify(check, &lines, view, VECTOR_VERIFY_APART, error);
    mem_free(lines.items);
    return status;
}
