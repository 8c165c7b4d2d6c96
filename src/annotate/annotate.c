/* In which order: what has one place first, labels around it. */
#include "annotate/annotate_private.h"

static const sheet_values *values_of(const lmn_look *look)
{
    return look->wide[KIND_FINISH].values;
}

bool annotate_wants_visible(const lmn_look *look, const lmn_scene *scene)
{
    bool mapped = true;
    for (size_t i = 0; i < scene->part_count && mapped; i++)
        mapped = scene->parts[i].triangles > 0 && scene->nodes[scene->parts[i].node].mesh != NONE;
    return values_of(look)->labels.text[0] && !mapped;
}

bool annotate_wanted(const lmn_look *look)
{
    const sheet_values *v = values_of(look);
    return v->labels.text[0] || v->legend || v->north_arrow || v->scale_bar;
}

bool annotation_project(const annotation *a, const double point[3], double out[2])
{
    const double *m = a->view->camera->view.m, *p = a->view->camera->projection.m, *box = a->view->box;
    double        eye[3];
    for (int k = 0; k < 3; k++)
        eye[k] = m[k] * point[0] + m[4 + k] * point[1] + m[8 + k] * point[2] + m[12 + k];
    double depth = a->view->camera->orthographic ? 1 : -eye[2];
    if (!(depth > 0))
        return false;
    out[0] = box[0] + (p[0] * eye[0] / depth + 1) / 2 * box[2];
    out[1] = box[1] + (1 - p[5] * eye[1] / depth) / 2 * box[3];
    return true;
}

bool annotation_is_free(const annotation *a, const double box[4])
{
    const double *page = a->view->box, margin = 0.3 * a->letter;
    if (box[0] < page[0] + margin || box[1] < page[1] + margin || box[2] > page[0] + page[2] - margin ||
        box[3] > page[1] + page[3] - margin)
        return false;
    for (size_t i = 0; i < a->taken_count; i++) {
        const double *other = a->taken[i].at;
        if (box[0] < other[2] + margin && other[0] < box[2] + margin && box[1] < other[3] + margin &&
            other[1] < box[3] + margin)
            return false;
    }
    return a->taken_count + 2 <= TAKEN_MOST;
}

void annotation_take(annotation *a, const double box[4])
{
    if (a->taken_count < TAKEN_MOST)
        a->taken[a->taken_count++] = (taken_box){{box[0], box[1], box[2], box[3]}};
}

void annotation_fill(annotation *a, colour c, double left, double top, double right, double bottom)
{
    const float corners[4][2] = {{(float)left, (float)top},
                                 {(float)right, (float)top},
                                 {(float)right, (float)bottom},
                                 {(float)left, (float)bottom}};
    sheet_add_item(a->page, SHEET_PATH, a->group, c, 0);
    sheet_add_path(a->page, &(sheet_path){.closed = true, .filled = true}, corners, 4);
}

/* Letters are as dark as the page is light. */
static void choose_colours(annotation *a)
{
    colour g = a->view->ground;
    float  light = 0.2126f * g.r + 0.7152f * g.g + 0.0722f * g.b;
    bool   dark = g.a > 0 && light < 0.4f;
    a->paper = g.a > 0 ? g : (colour){1, 1, 1, 1};
    a->paper.a = 0.92f;
    a->ink = dark ? (colour){0.95f, 0.95f, 0.93f, 1} : (colour){0.12f, 0.12f, 0.14f, 1};
}

lmn_status annotate(sheet *page, int32_t parent, const annotated_view *view, warnings *warnings, lmn_error *error)
{
    const sheet_values *how = values_of(view->plan->look);
    annotation          a = {.page = page, .view = view, .how = how, .warnings = warnings};
    /* The look of a plan has its lengths in pixels of the drawing. */
    a.letter = (double)how->label_size / view->plan->pixels_per_mm;
    a.group = sheet_add_group(page, parent, "annotations", "annotations", 0);
    choose_colours(&a);
    if (how->north_arrow)
        annotate_north(&a);
    if (how->scale_bar)
        annotate_scale_bar(&a);
    lmn_status status = how->legend ? annotate_legend(&a, error) : LMN_OK;
    if (status == LMN_OK && how->labels.text[0])
        status = annotate_labels(&a, error);
    return status == LMN_OK && page->failed ? error_memory(error) : status;
}
