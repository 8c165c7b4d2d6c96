/* Labels: flags on upright leaders over what they name, where that is seen. The most important come first; each takes
 * the lowest place over its pin at which neither the flag nor the leader touches what is there already, and is left out
 * where there is none. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "annotate/annotate_private.h"
#include "annotate/seen.h"
#include "base/memory.h"
#include "export/export.h"
#include "scene/content.h"

enum { HEIGHTS = 24, SIDES = 3 };

typedef struct label {
    const char *text; /* lent */
    int32_t     node; /* that states it */
    box3        box;  /* of all parts that it holds for */
    double      weight, at[2];
    double      seen, sum[2]; /* pixels of the map, and their places */
    double      wanted[2];    /* where its pin would be best, pixels */
    double      best, pin[2]; /* the pixel of its own that is nearest to that, and how far it is */
    bool        unmapped;     /* of parts that no map shows */
} label;

typedef struct label_list {
    label   *items;
    size_t   count;
    int32_t *of_node; /* per node of the scene: its label; NONE: none yet */
    int32_t *of_part; /* per part: its label; NONE: none */
} label_list;

/* Blanks alone would be an empty flag. */
static bool has_letters(const char *text)
{
    return text && text[strspn(text, " \t\r\n")];
}

static const char *stated_by(const node *n, const char *key)
{
    for (size_t i = 0; i < n->attribute_count; i++)
        if (strcmp(n->attributes[i].key, key) == 0 && has_letters(n->attributes[i].value))
            return n->attributes[i].value;
    return NULL;
}

/* The nearest node on the way to the root that states the text; without a stated name, what nodes are called by their
 * file. */
static bool find_owner(const lmn_scene *scene, int32_t from, const char *key, int32_t *index, const char **text)
{
    bool names = strcmp(key, "name") == 0;
    for (int called = 0; called < (names ? 2 : 1); called++)
        for (int32_t at = from; at >= 0 && (size_t)at < scene->node_count; at = scene->nodes[at].parent) {
            const node *n = &scene->nodes[at];
            *index = at;
            *text = !called                                                       ? stated_by(n, key)
                    : !node_is_surface(n) && !n->numbered && has_letters(n->name) ? n->name
                                                                                  : NULL;
            if (*text)
                return true;
        }
    return false;
}

/* Of triangles, which the map shows. */
static bool is_mapped(const lmn_scene *scene, size_t part)
{
    return scene->nodes[scene->parts[part].node].mesh != NONE && scene->parts[part].triangles > 0;
}

/* Several parts below one node that states the text share its label. */
static void collect(const annotation *a, label_list *list)
{
    const plan *p = a->view->plan;
    for (size_t i = 0; i < p->part_count && i < p->pose->part_count; i++) {
        int32_t     index = NONE;
        const char *text = NULL;
        bool        mapped = is_mapped(p->scene, i);
        uint64_t    seen = mapped || !a->view->visible ? 1 : a->view->visible[i];
        if (!p->selected[i] || !seen || box3_is_empty(p->pose->part_boxes[i]) ||
            !find_owner(p->scene, p->scene->parts[i].node, a->how->labels.text, &index, &text))
            continue;
        if (list->of_node[index] == NONE) {
            list->of_node[index] = (int32_t)list->count;
            list->items[list->count++] =
                (label){.text = text, .node = index, .box = box3_empty(), .best = INFINITY, .unmapped = true};
        }
        label *l = &list->items[list->of_node[index]];
        l->box = box3_union(l->box, p->pose->part_boxes[i]);
        l->unmapped = l->unmapped && !mapped;
        list->of_part[i] = mapped ? list->of_node[index] : NONE;
    }
}

/* --- pins ----------------------------------------------------------------------------------------------- */

static label *label_at(const label_list *list, const seen_map *map, int x, int y)
{
    if (x < 0 || y < 0 || x >= map->width || y >= map->height)
        return NULL;
    int32_t part = map->parts[(size_t)y * (size_t)map->width + (size_t)x];
    return part == NONE || list->of_part[part] == NONE ? NULL : &list->items[list->of_part[part]];
}

/* The middle of its top, on the sheet; false where that is behind the viewer. */
static bool find_top(const annotation *a, const label *l, double out[2])
{
    int    up = a->view->plan->scene->up == 'z' ? 2 : 1;
    double top[3];
    box3_middle(l->box, top);
    top[up] = up == 2 ? (double)l->box.max.z : (double)l->box.max.y;
    return annotation_project(a, top, out);
}

/* The middle of its top where that is seen, else the middle of what is seen of it. */
static void want_pins(const annotation *a, label_list *list, const seen_map *map)
{
    const double *page = a->view->box, per_mm = map->width / page[2];
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            label *l = label_at(list, map, x, y);
            if (!l)
                continue;
            l->seen++;
            l->sum[0] += x;
            l->sum[1] += y;
        }
    for (size_t i = 0; i < list->count; i++) {
        label *l = &list->items[i];
        double top[2];
        for (int k = 0; k < 2; k++)
            l->wanted[k] = l->seen > 0 ? l->sum[k] / l->seen : 0;
        if (!find_top(a, l, top))
            continue;
        for (int k = 0; k < 2; k++)
            top[k] = floor(fmin(fmax((top[k] - page[k]) * per_mm, -1), 1e6));
        if (label_at(list, map, (int)top[0], (int)top[1]) == l)
            memcpy(l->wanted, top, sizeof top);
    }
}

/* The nearest pixel of its own, before all one that has only such around it. */
static void find_pins(label_list *list, const seen_map *map)
{
    enum { ALONE = 100000000 };
    for (int y = 0; y < map->height; y++)
        for (int x = 0; x < map->width; x++) {
            label *l = label_at(list, map, x, y);
            if (!l)
                continue;
            double across = x - l->wanted[0], down = y - l->wanted[1], far = across * across + down * down;
            if (far >= l->best)
                continue;
            for (int k = 0; k < 9 && far < ALONE; k++)
                far += label_at(list, map, x + k % 3 - 1, y + k / 3 - 1) == l ? 0 : ALONE;
            if (far >= l->best)
                continue;
            l->best = far;
            l->pin[0] = x + 0.5;
            l->pin[1] = y + 0.5;
        }
}

/* False where nothing of it is seen. Where no number says how important it is, what shows most comes first. */
static bool place(const annotation *a, label *l, const seen_map *map)
{
    const lmn_scene *scene = a->view->plan->scene;
    const double    *page = a->view->box;
    const char      *by = a->how->labels_by.text[0] ? scene_attribute_of(scene, l->node, a->how->labels_by.text) : NULL;
    l->weight = a->how->labels_by.text[0] ? (by ? strtod(by, NULL) : -INFINITY)
                : l->unmapped             ? camera_size_of(a->view->camera, l->box, 1000)
                                          : l->seen;
    for (int k = 0; k < 2; k++)
        l->at[k] = page[k] + l->pin[k] * page[2 + k] / (k ? map->height : map->width);
    if (!l->unmapped)
        return l->seen > 0;
    return find_top(a, l, l->at) && l->at[0] > page[0] && l->at[0] < page[0] + page[2] && l->at[1] > page[1] &&
           l->at[1] < page[1] + page[3];
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

static lmn_status put(annotation *a, label_list *list, const seen_map *map, lmn_error *error)
{
    size_t kept = 0, placed = 0;
    for (size_t i = 0; i < list->count; i++)
        if (place(a, &list->items[i], map))
            list->items[kept++] = list->items[i];
    if (kept)
        qsort(list->items, kept, sizeof *list->items, by_weight);
    for (size_t i = 0; i < kept && placed < (size_t)a->how->labels_most; i++) {
        double     width;
        lmn_status status = export_text_width(&width, list->items[i].text, a->letter, error);
        if (status != LMN_OK)
            return status;
        placed += raise(a, &list->items[i], width);
    }
    if (kept == 0)
        warnings_add(a->warnings, WARNING_NO_MATCH, "no part that is seen has '%s' (finish.labels)",
                     a->how->labels.text);
    return LMN_OK;
}

lmn_status annotate_labels(annotation *a, lmn_error *error)
{
    const plan *p = a->view->plan;
    seen_map    map = {.parts = NULL};
    label_list  list = {.items = mem_calloc(p->part_count, sizeof *list.items),
                        .of_node = mem_alloc((p->scene->node_count + 1) * sizeof *list.of_node),
                        .of_part = mem_alloc((p->part_count + 1) * sizeof *list.of_part)};
    lmn_status  status = list.items && list.of_node && list.of_part ? LMN_OK : error_memory(error);
    for (size_t i = 0; status == LMN_OK && i < p->scene->node_count; i++)
        list.of_node[i] = NONE;
    for (size_t i = 0; status == LMN_OK && i < p->part_count; i++)
        list.of_part[i] = NONE;
    if (status == LMN_OK)
        status = seen_make(&map, a->view, error);
    if (status == LMN_OK) {
        collect(a, &list);
        want_pins(a, &list, &map);
        find_pins(&list, &map);
        status = put(a, &list, &map, error);
    }
    seen_release(&map);
    mem_free(list.items);
    mem_free(list.of_node);
    mem_free(list.of_part);
    return status;
}
