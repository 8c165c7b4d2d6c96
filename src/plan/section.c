#include "plan/section.h"

#include <string.h>

#include "base/memory.h"
#include "light/light.h"

/* The parts that a selector matches; NULL text or an empty one: `otherwise`. Ghosts go with their parts. */
static lmn_status match_parts(bool **out, const lmn_scene *scene, const char *text, bool otherwise, lmn_error *error)
{
    selector  *wanted = NULL;
    lmn_status status = text && text[0] ? selector_parse(&wanted, text, error) : LMN_OK;
    *out = status == LMN_OK ? mem_calloc(scene->part_count + scene->ghost_count, sizeof **out) : NULL;
    if (status == LMN_OK && !*out)
        status = error_memory(error);
    for (size_t i = 0; i < scene->part_count && *out; i++)
        (*out)[i] = wanted ? selector_matches(wanted, scene, i) : otherwise;
    for (size_t i = scene->part_count; i < scene->part_count + scene->ghost_count && *out; i++) {
        size_t owner = scene_part_of_ghost(scene, i);
        (*out)[i] = (wanted && selector_matches(wanted, scene, i)) || (owner != SIZE_MAX && (*out)[owner]);
    }
    selector_destroy(&wanted);
    return status;
}

lmn_status section_find(section *out, const pose *pose, const lmn_look *look, const char *select, lmn_error *error)
{
    const scene_values *v = look->wide[KIND_SCENE].values;
    return section_find_cut(out, v->cut.text, pose, look, select, error);
}

lmn_status section_find_cut(section *out, const char *text, const pose *pose, const lmn_look *look, const char *select,
                            lmn_error *error)
{
    const lmn_scene    *scene = pose->scene;
    const scene_values *v = look->wide[KIND_SCENE].values;
    *out = (section){.spared = NULL};
    memset(&out->cut, 0, sizeof out->cut);
    if (!text[0])
        return LMN_OK;
    bool      *selected;
    box3       box = box3_empty();
    lmn_status status = match_parts(&selected, scene, select, true, error);
    for (size_t i = 0; i < scene->part_count && status == LMN_OK; i++)
        if (selected[i])
            box = box3_union(box, pose->fit_boxes[i]);
    mem_free(selected);
    if (status == LMN_OK)
        status = cut_parse(&out->cut, text, box, error);
    if (status == LMN_OK)
        status = match_parts(&out->spared, scene, v->cut_keep.text, false, error);
    return status;
}

lmn_status section_spare(section *s, const lmn_scene *scene, const char *selector, lmn_error *error)
{
    mem_free(s->spared);
    s->spared = NULL;
    return match_parts(&s->spared, scene, selector, false, error);
}

void section_release(section *s)
{
    mem_free(s->spared);
    *s = (section){.spared = NULL};
}

bool section_copy(section *out, const section *from, size_t part_count)
{
    memcpy(&out->cut, &from->cut, sizeof out->cut); /* with its padding: sections are compared byte by byte */
    out->spared = from->spared ? mem_copy(from->spared, part_count * sizeof *from->spared) : NULL;
    return out->spared || !from->spared;
}

bool section_equal(const section *a, const section *b, size_t part_count)
{
    return memcmp(&a->cut, &b->cut, sizeof a->cut) == 0 && !a->spared == !b->spared &&
           (!a->spared || memcmp(a->spared, b->spared, part_count * sizeof *a->spared) == 0);
}
