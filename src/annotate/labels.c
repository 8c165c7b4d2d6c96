/* Labels: flags on upright leaders over what they name. The most important come first; each takes the lowest place
 * over its part at which neither the flag nor the leader touches what is there already, and is left out where there is
 * none. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "annotate/annotate_private.h"
#include "base/memory.h"
#include "export/export.h"
#include "scene/content.h"

enum { HEIGHTS = 24, SIDES = 3 };

typedef struct label {
    const char *text; /* lent */
    int32_t     node; /* that states it */
    box3        box;  /* of all parts that it holds for */
    double      weight, at[2];
} label;

typedef struct label_list {
    label   *items;
    size_t   count;
    int32_t *of_node; /* per node of the scene: its label; NONE: none yet */
} label_list;

static const char *stated_by(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0 && n->attributes[i].value && n->attributes[i].value[0])
            return n->attributes[i].value;
    return NULL;
}

/* The nearest node on the way to the root that states the text; without a stated name, what nodes are called. */
static bool find_owner(const lmn_scene *scene, int32_t from, const char *key, int32_t *index, const char **text)
{
    bool names = strcmp(key, "name") == 0;
    for (int called = 0; called < (names ? 2 : 1); called++)
        for (int32_t at = from; at >= 0 && (size_t)at < scene->node_count; at = scene->nodes[at].parent) {
            const node *n = &scene->nodes[at];
            *index = at;
            *text = !called ? stated_by(n, key) : !node_is_surface(n) && n->name && n->name[0] ? n->name : NULL;
            if (*text)
                return true;
        }
    return false;
}

/* Several parts below one node that states the text share its label. */
static void collect(const annotation *a, label_list *list)
{
    const plan *p = a->view->plan;
    for (size_t i = 0; i < p->part_count && i < p->pose->part_count; i++) {
        int32_t     index = NONE;
        const char *text = NULL;
        uint64_t    seen = a->view->visible ? a->view->visible[i] : 1;
        if (!p->selected[i] || !seen || box3_is_empty(p->pose->part_boxes[i]) ||
            !find_owner(p->scene, p->scene->parts[i].node, a->how->labels.text, &index, &text))
            continue;
        if (list->of_node[index] == NONE) {
            list->of_node[index] = (int32_t)list->count;
            list->items[list->count++] = (label){.text = text, .node = index, .box = box3_empty()};
        }
        label *l = &list->items[list->of_node[index]];
        l->box = box3_union(l->box, p->pose->part_boxes[i]);
        l->weight += (double)seen;
    }
}

/* The middle of its top, on the sheet; false where that is not on it. Where no number says how important it is, what
 * shows most comes first. */
static bool place(const annotation *a, label *l)
{
    const lmn_scene *scene = a->view->plan->scene;
    int              up = scene->up == 'z' ? 2 : 1;
    double           top[3];
    box3_middle(l->box, top);
    top[up] = up == 2 ? (double)l->box.max.z : (double)l->box.max.y;
    const char *by = a->how->labels_by.text[0] ? scene_attribute_of(scene, l->node, a->how->labels_by.text) : NULL;
    if (a->how->labels_by.text[0])
        l->weight = by ? strtod(by, NULL) : -INFINITY;
    else if (!a->view->visible)
        l->weight = camera_size_of(a->view->camera, l->box, 1000);
    const double *page = a->view->box;
    return annotation_project(a, top, l->at) && l->at[0] > page[0] && l->at[0] < page[0] + page[2] &&
           l->at[1] > page[1] && l->at[1] < page[1] + page[3];
}

static int by_weight(const void *x, const void *y)
{
    const label *a = x, *b = y;
    return a->weight != b->weight ? (a->weight < b->weight ? 1 : -1) : (a->node > b->node) - (a->node < b->node);
}

static void draw(annotation *a, const label *l, const double box[4])
{
    sheet *s = a->page;
    double line = a->letter * 0.07, foot[2] = {l->at[0], l->at[1]}, head[2] = {l->at[0], box[3]};
    float  dot[1][2] = {{(float)foot[0], (float)foot[1]}};
    sheet_add_line(s, a->group, a->ink, head, foot, line);
    sheet_add_item(s, SHEET_DOTS, a->group, a->ink, 0);
    sheet_add_path(s, &(sheet_path){.width = (float)(a->letter * 0.3)}, (const float(*)[2])dot, 1);
    annotation_fill(a, a->paper, box[0], box[1], box[2], box[3]);
    sheet_add_rectangle(s, a->group, a->ink, box[0], box[1], box[2] - box[0], box[3] - box[1], line);
    sheet_add_text(s, a->group, a->ink, l->text, (box[0] + box[2]) / 2, box[3] - 0.45 * a->letter, a->letter, 0);
}

/* True when the label has found a place. */
static bool raise(annotation *a, const label *l, double width)
{
    static const double sides[SIDES] = {0.5, 0.12, 0.88}; /* where along the flag the leader ends */
    double              high = 1.6 * a->letter, long_side = width + 0.9 * a->letter, half = 0.12 * a->letter;
    for (int k = 0; k < HEIGHTS; k++)
        for (int i = 0; i < SIDES; i++) {
            double bottom = l->at[1] - (0.8 + 0.85 * k) * a->letter, left = l->at[0] - sides[i] * long_side;
            double box[4] = {left, bottom - high, left + long_side, bottom};
            double leader[4] = {l->at[0] - half, bottom, l->at[0] + half, l->at[1]};
            if (!annotation_is_free(a, box) || !annotation_is_free(a, leader))
                continue;
            draw(a, l, box);
            annotation_take(a, box);
            annotation_take(a, leader);
            return true;
        }
    return false;
}

static lmn_status put(annotation *a, label_list *list, lmn_error *error)
{
    size_t kept = 0, placed = 0;
    for (size_t i = 0; i < list->count; i++)
        if (place(a, &list->items[i]))
            list->items[kept++] = list->items[i];
    qsort(list->items, kept, sizeof *list->items, by_weight);
    for (size_t i = 0; i < kept && placed < (size_t)a->how->labels_most; i++) {
        double     width;
        lmn_status status = export_text_width(&width, list->items[i].text, a->letter, error);
        if (status != LMN_OK)
            return status;
        placed += raise(a, &list->items[i], width);
    }
    if (list->count == 0)
        warnings_add(a->warnings, WARNING_NO_MATCH, "no part that is seen has '%s' (finish.labels)",
                     a->how->labels.text);
    return LMN_OK;
}

lmn_status annotate_labels(annotation *a, lmn_error *error)
{
    const plan *p = a->view->plan;
    label_list  list = {.items = mem_calloc(p->part_count, sizeof *list.items),
                        .of_node = mem_alloc((p->scene->node_count + 1) * sizeof *list.of_node)};
    lmn_status  status = list.items && list.of_node ? LMN_OK : error_memory(error);
    for (size_t i = 0; status == LMN_OK && i < p->scene->node_count; i++)
        list.of_node[i] = NONE;
    if (status == LMN_OK) {
        collect(a, &list);
        status = put(a, &list, error);
    }
    mem_free(list.items);
    mem_free(list.of_node);
    return status;
}
