/* K09: what is edited is drawn like what was built that way. Random edits, each followed by a drawing that must
 * equal, byte for byte, that of a fresh scene in the same state, which another renderer draws. */
#include <limner/limner.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"

enum { ITEMS_MAX = 400, CHILDREN_MAX = 64, ROOTS_MAX = 64, SIDE = 72, SHAPES_MAX = 24 };

/* What a solid should be like: a tree of our own. */
typedef struct item {
    lmn_operation operation;
    lmn_shape     shape;
    double        matrix[16];
    bool          has_colour, hidden;
    float         colour[4];
    int           parent, children[CHILDREN_MAX], count;
    uint32_t      id;
} item;

/* What a scene should hold, in the order in which it came: solids by their roots, files. */
typedef struct root {
    int      item; /* −1: a file; −2: a solid that was removed */
    uint32_t solid;
} root;

typedef struct twin {
    lmn_scene  *scene;
    item        items[ITEMS_MAX];
    int         item_count;
    root        roots[ROOTS_MAX];
    int         root_count;
    uint32_t    random;
    const char *last; /* edit */
} twin;

static lmn_renderer *edited_renderer, *fresh_renderer;

static uint32_t roll(twin *t, uint32_t sides)
{
    t->random = t->random * 1664525u + 1013904223u;
    return (t->random >> 8) % sides;
}

static double between(twin *t, double low, double high)
{
    return low + (high - low) * roll(t, 1 << 16) / (1 << 16);
}

static void good(lmn_status status, const lmn_error *error, const char *what)
{
    if (status != LMN_OK) {
        check_that("K09", false, "%s: %s %s", what, error->message, error->hint);
        exit(1);
    }
}

#define DO(call) good((call), &error, #call)

static const double   corner[6][2] = {{0, 0}, {1.2, 0}, {1.2, 0.5}, {0.5, 0.5}, {0.5, 1.2}, {0, 1.2}};
static const double   ring[4][2] = {{0.5, -0.3}, {1, -0.3}, {1, 0.3}, {0.5, 0.3}};
static const double   tetrahedron[4][3] = {{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
static const uint32_t faces[12] = {0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2}, threes[4] = {3, 3, 3, 3};

static lmn_shape random_shape(twin *t)
{
    lmn_shape shape;
    switch (roll(t, 6)) {
    case 0:
        shape = lmn_shape_box(between(t, 0.5, 2), between(t, 0.5, 2), between(t, 0.5, 2));
        shape.centred = roll(t, 2);
        return shape;
    case 1:
        shape = lmn_shape_sphere(between(t, 0.4, 1.2));
        shape.facets.fn = 8 + roll(t, 8);
        return shape;
    case 2:
        shape = lmn_shape_cylinder(between(t, 0.5, 3), between(t, 0.2, 1), roll(t, 3) ? between(t, 0.2, 1) : 0);
        shape.facets.fn = 6 + roll(t, 12);
        shape.centred = roll(t, 2);
        return shape;
    case 3: return lmn_shape_extrusion(corner, 6, between(t, 0.4, 1.5));
    case 4:
        shape = lmn_shape_revolution(ring, 4, roll(t, 2) ? 360 : 250);
        shape.facets.fn = 16;
        return shape;
    default: return lmn_shape_polyhedron(tetrahedron, 4, faces, threes, 4);
    }
}

/* Steps that repeat, so that faces fall into common planes; turns; now and then a mirror. */
static void random_matrix(twin *t, double m[16])
{
    double       angle = roll(t, 3) ? 0 : between(t, 0, 6), c = cos(angle), s = sin(angle), flip = roll(t, 8) ? 1 : -1;
    const double own[16] = {
        c, s, 0, 0, -s, c, 0, 0, 0, 0, flip, 0, roll(t, 5) * 0.5 - 1, roll(t, 5) * 0.5 - 1, roll(t, 5) * 0.5 - 1, 1};
    memcpy(m, own, sizeof own);
}

/* --- our tree ------------------------------------------------------------------------------------------- */

static int new_item(twin *t, lmn_operation operation, int parent, uint32_t id)
{
    if (t->item_count == ITEMS_MAX)
        return -1;
    int at = t->item_count++;
    t->items[at] = (item){
        .operation = operation, .parent = parent, .id = id, .matrix = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}};
    if (parent >= 0)
        t->items[parent].children[t->items[parent].count++] = at;
    return at;
}

static int place_among(const item *parent, int child)
{
    for (int i = 0; i < parent->count; i++)
        if (parent->children[i] == child)
            return i;
    return -1;
}

static void take_out(twin *t, int child)
{
    item *parent = &t->items[t->items[child].parent];
    int   at = place_among(parent, child);
    memmove(&parent->children[at], &parent->children[at + 1], (size_t)(--parent->count - at) * sizeof(int));
}

static int shapes_below(const twin *t, int at)
{
    int count = t->items[at].operation == LMN_SHAPE;
    for (int i = 0; i < t->items[at].count; i++)
        count += shapes_below(t, t->items[at].children[i]);
    return count;
}

static int shown_below(const twin *t, int at)
{
    const item *i = &t->items[at];
    int         count = !i->hidden && i->operation == LMN_SHAPE;
    for (int k = 0; k < i->count && !i->hidden; k++)
        count += shown_below(t, i->children[k]);
    return count;
}

/* With nothing shown at all a solid is a part still, which a fresh one is not. */
static bool is_comparable(const twin *t)
{
    for (int i = 0; i < t->root_count; i++)
        if (t->roots[i].item >= 0 && shapes_below(t, t->roots[i].item) && !shown_below(t, t->roots[i].item))
            return false;
    return true;
}

static bool hides_shapes(const twin *t)
{
    bool hides = false;
    for (int i = 0; i < t->root_count && !hides; i++)
        hides = t->roots[i].item >= 0 && shown_below(t, t->roots[i].item) < shapes_below(t, t->roots[i].item);
    return hides;
}

static bool is_below(const twin *t, int at, int top)
{
    while (at >= 0 && at != top)
        at = t->items[at].parent;
    return at == top;
}

/* The n-th node of a tree, depth first; *n counts down. */
static int nth(const twin *t, int at, int *n)
{
    if ((*n)-- == 0)
        return at;
    for (int i = 0; i < t->items[at].count; i++) {
        int found = nth(t, t->items[at].children[i], n);
        if (found >= 0)
            return found;
    }
    return -1;
}

static int size_of(const twin *t, int at)
{
    int count = 1;
    for (int i = 0; i < t->items[at].count; i++)
        count += size_of(t, t->items[at].children[i]);
    return count;
}

static int any(twin *t, int root_item)
{
    int n = (int)roll(t, (uint32_t)size_of(t, root_item));
    return nth(t, root_item, &n);
}

static int any_operation(twin *t, int root_item)
{
    int at = any(t, root_item);
    return t->items[at].operation == LMN_SHAPE ? t->items[at].parent : at;
}

/* --- fresh scenes, and what both must show -------------------------------------------------------------- */

static const char *model_file(void)
{
    static char       path[512];
    static const char text[] = "v -3 -2 -2\nv 3 -2 -2\nv 0 -2 3\nv 0 1 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
    if (!path[0]) {
        snprintf(path, sizeof path, "%s", check_path("edit.obj"));
        FILE *f = fopen(path, "w");
        if (!f || fputs(text, f) < 0 || fclose(f) != 0)
            abort();
    }
    return path;
}

static void build(const twin *t, lmn_scene *scene, uint32_t solid, int at, uint32_t parent)
{
    const item *i = &t->items[at];
    lmn_error   error;
    uint32_t    id = LMN_SOLID_ROOT;
    if (i->operation == LMN_SHAPE)
        DO(lmn_solid_add_shape(scene, solid, parent, &i->shape, &id, &error));
    else if (parent)
        DO(lmn_solid_add_operation(scene, solid, parent, i->operation, &id, &error));
    DO(lmn_solid_set_matrix(scene, solid, id, i->matrix, &error));
    if (i->has_colour)
        DO(lmn_solid_set_colour(scene, solid, id, i->colour, &error));
    for (int k = 0; k < i->count; k++)
        if (!t->items[i->children[k]].hidden)
            build(t, scene, solid, i->children[k], id);
}

static lmn_scene *build_fresh(const twin *t)
{
    lmn_scene *scene = NULL;
    lmn_error  error;
    DO(lmn_scene_create(&scene, &error));
    for (int i = 0; i < t->root_count; i++) {
        uint32_t solid;
        if (i == 0 && t->roots[0].item == -2) { /* what came first decided about the up axis */
            DO(lmn_scene_add_solid(scene, NULL, LMN_UNION, &solid, &error));
            DO(lmn_solid_remove(scene, solid, LMN_SOLID_ROOT, &error));
        }
        if (t->roots[i].item == -1)
            DO(lmn_scene_add_file(scene, model_file(), NULL, &error));
        if (t->roots[i].item < 0)
            continue;
        DO(lmn_scene_add_solid(scene, "solid", t->items[t->roots[i].item].operation, &solid, &error));
        build(t, scene, solid, t->roots[i].item, 0);
    }
    return scene;
}

static bool same_tree(const twin *t, uint32_t solid, int at)
{
    const item    *i = &t->items[at];
    lmn_solid_info info;
    if (!lmn_solid_info_of(t->scene, solid, i->id, &info) || info.operation != i->operation ||
        info.child_count != (size_t)i->count || memcmp(info.matrix, i->matrix, sizeof info.matrix) != 0 ||
        info.has_colour != i->has_colour || lmn_solid_is_shown(t->scene, solid, i->id) == i->hidden)
        return false;
    uint32_t child = info.first_child;
    for (int k = 0; k < i->count; k++) {
        if (child != t->items[i->children[k]].id || !same_tree(t, solid, i->children[k]))
            return false;
        lmn_solid_info_of(t->scene, solid, child, &info);
        child = info.next_sibling;
    }
    return child == 0;
}

/* Triangles count even when they are hidden, and a fresh scene is without them. */
static bool same_facts(const lmn_scene *a, const lmn_scene *b, bool hides)
{
    lmn_scene_info i = lmn_scene_info_of(a), k = lmn_scene_info_of(b);
    bool           same = i.parts == k.parts && (hides || i.triangles == k.triangles) &&
                memcmp(i.bounds_min, k.bounds_min, sizeof i.bounds_min) == 0 &&
                memcmp(i.bounds_max, k.bounds_max, sizeof i.bounds_max) == 0;
    for (size_t p = 0; p < i.parts && same; p++) {
        lmn_part_info x, y;
        same = lmn_scene_part_at(a, p, &x) && lmn_scene_part_at(b, p, &y) && strcmp(x.path, y.path) == 0 &&
               (hides || x.triangles == y.triangles);
    }
    return same;
}

#define LOOK(RULE)                                                                                                     \
    "{\"version\":1,\"name\":\"t\",\"finish\":{\"ground\":\"#ffffff\"},\"rules\":[{\"select\":\"*\"," RULE "}]}"
#define FLAT "\"surface\":{\"technique\":\"flat\",\"model_colour\":1}"

static const char *const looks[] = {
    LOOK(FLAT),
    LOOK(FLAT ",\"layers\":{\"technique\":\"peel\",\"count\":0},\"compose\":{\"technique\":\"xray\",\"opacity\":0.5}"),
    "edges",
    "blueprint",
    "gooch",
};
enum { LOOKS = sizeof looks / sizeof *looks };

/* Other meshes are needed for another crease angle, and others again for what a section leaves. */
static const char *const changes[LOOKS][2] = {
    {"scene.cut", "z"}, {NULL, NULL}, {NULL, NULL}, {NULL, NULL}, {"scene.crease_angle", "5"}};

static lmn_look *look_of(int index)
{
    static lmn_look *loaded[LOOKS];
    lmn_error        error;
    for (int i = 0; i < LOOKS && index < 0; i++)
        lmn_look_destroy(&loaded[i]);
    if (index >= 0 && !loaded[index])
        DO(looks[index][0] == '{' ? lmn_look_parse(&loaded[index], looks[index], "look", &error)
                                  : lmn_look_load(&loaded[index], looks[index], &error));
    else
        return index < 0 ? NULL : loaded[index];
    if (changes[index][0])
        DO(lmn_look_set(loaded[index], changes[index][0], changes[index][1], &error));
    return loaded[index];
}

static lmn_renderer *renderer_of(lmn_renderer **r)
{
    lmn_renderer_desc desc = LMN_RENDERER_DESC_INIT;
    lmn_error         error;
    if (!*r)
        DO(lmn_renderer_create(r, &desc, &error));
    return *r;
}

/* NULL: there is nothing to draw. */
static lmn_drawing *draw(lmn_renderer **r, const lmn_scene *scene, const lmn_look *look)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    lmn_drawing  *out = NULL;
    lmn_error     error;
    desc.width = desc.height = SIDE;
    desc.dpi = 96;
    if (lmn_scene_info_of(scene).parts > 0)
        DO(lmn_draw(&out, renderer_of(r), scene, look, &desc, &error));
    return out;
}

static int pixels_that_differ(const lmn_drawing *a, const lmn_drawing *b)
{
    if (!a || !b)
        return a == b ? 0 : SIDE * SIDE;
    const uint8_t *p = lmn_drawing_pixels(a, NULL, NULL), *q = lmn_drawing_pixels(b, NULL, NULL);
    int            count = 0;
    for (int i = 0; i < SIDE * SIDE; i++)
        count += memcmp(p + 4 * i, q + 4 * i, 4) != 0;
    return count;
}

/* Returns pixels of the drawing that are not ground. */
static int compare(const twin *t, int look, int step)
{
    lmn_scene   *fresh = build_fresh(t);
    lmn_drawing *a = draw(&edited_renderer, t->scene, look_of(look)), *b = draw(&fresh_renderer, fresh, look_of(look));
    int          differ = pixels_that_differ(a, b), full = 0;
    bool         same = same_facts(t->scene, fresh, hides_shapes(t));
    for (int i = 0; i < t->root_count; i++)
        same = same && (t->roots[i].item < 0 || same_tree(t, t->roots[i].solid, t->roots[i].item));
    if (differ || !same)
        check_that("K09", false, "step %d (%s), look %d: %d pixels differ from the fresh scene; trees and parts are %s",
                   step, t->last, look, differ, same ? "the same" : "not");
    for (int i = 0; a && i < SIDE * SIDE; i++)
        full += memcmp(lmn_drawing_pixels(a, NULL, NULL) + 4 * i, lmn_drawing_pixels(a, NULL, NULL), 4) != 0;
    lmn_drawing_destroy(&a);
    lmn_drawing_destroy(&b);
    lmn_scene_destroy(&fresh);
    return differ || !same ? -1 : full;
}

/* --- edits ---------------------------------------------------------------------------------------------- */

static void begin_solid(twin *t)
{
    lmn_error     error;
    lmn_operation operation = (lmn_operation)(1 + roll(t, 3));
    root          r = {.item = new_item(t, operation, -1, LMN_SOLID_ROOT)};
    DO(lmn_scene_add_solid(t->scene, "solid", operation, &r.solid, &error));
    t->roots[t->root_count++] = r;
}

static void add_file(twin *t)
{
    lmn_error error;
    DO(lmn_scene_add_file(t->scene, model_file(), NULL, &error));
    t->roots[t->root_count++] = (root){.item = -1};
}

static bool has_capacity(const twin *t, root r, int parent, int more)
{
    return t->items[parent].count + 1 < CHILDREN_MAX && t->item_count + more < ITEMS_MAX &&
           shapes_below(t, r.item) + more <= SHAPES_MAX;
}

static void set_matrix(twin *t, root r, int at)
{
    lmn_error error;
    t->last = "matrix";
    random_matrix(t, t->items[at].matrix);
    DO(lmn_solid_set_matrix(t->scene, r.solid, t->items[at].id, t->items[at].matrix, &error));
}

static void add_shape(twin *t, root r)
{
    lmn_error error;
    int       parent = any_operation(t, r.item);
    uint32_t  id;
    t->last = "add";
    if (!has_capacity(t, r, parent, 1))
        return;
    lmn_shape shape = random_shape(t);
    DO(lmn_solid_add_shape(t->scene, r.solid, t->items[parent].id, &shape, &id, &error));
    int at = new_item(t, LMN_SHAPE, parent, id);
    t->items[at].shape = shape;
    set_matrix(t, r, at);
    t->last = "add and matrix";
}

static void add_operation(twin *t, root r)
{
    lmn_error     error;
    int           parent = any_operation(t, r.item);
    uint32_t      id;
    lmn_operation operation = (lmn_operation)(1 + roll(t, 3));
    t->last = "add operation";
    if (!has_capacity(t, r, parent, 1))
        return;
    DO(lmn_solid_add_operation(t->scene, r.solid, t->items[parent].id, operation, &id, &error));
    new_item(t, operation, parent, id);
}

/* Our tree gets what the copy is made of, ids from reading the solid's. */
static void clone(twin *t, root r, int source, int parent, uint32_t id)
{
    lmn_solid_info info;
    int            at = new_item(t, t->items[source].operation, parent, id), count = t->items[source].count;
    const item    *from = &t->items[source];
    t->items[at].shape = from->shape;
    memcpy(t->items[at].matrix, from->matrix, sizeof from->matrix);
    t->items[at].has_colour = from->has_colour;
    t->items[at].hidden = from->hidden;
    memcpy(t->items[at].colour, from->colour, sizeof from->colour);
    if (!lmn_solid_info_of(t->scene, r.solid, id, &info))
        abort();
    uint32_t child = info.first_child;
    for (int i = 0; i < count; i++) {
        clone(t, r, t->items[source].children[i], at, child);
        lmn_solid_info_of(t->scene, r.solid, child, &info);
        child = info.next_sibling;
    }
}

static void copy(twin *t, root r)
{
    lmn_error error;
    int       source = any(t, r.item), parent = any_operation(t, r.item);
    uint32_t  id;
    t->last = "copy";
    if (is_below(t, parent, source) || !has_capacity(t, r, parent, size_of(t, source)))
        return;
    DO(lmn_solid_add_copy(t->scene, r.solid, t->items[parent].id, t->items[source].id, &id, &error));
    clone(t, r, source, parent, id);
}

static void set_colour(twin *t, root r)
{
    lmn_error error;
    item     *i = &t->items[any(t, r.item)];
    t->last = "colour";
    i->has_colour = roll(t, 4) > 0;
    for (int k = 0; k < 4; k++)
        i->colour[k] = k == 3 ? 1 : (float)between(t, 0, 1);
    DO(lmn_solid_set_colour(t->scene, r.solid, i->id, i->has_colour ? i->colour : NULL, &error));
}

static void set_shown(twin *t, root r)
{
    lmn_error error;
    int       at = any(t, r.item);
    t->last = "shown";
    if (at == r.item)
        return;
    t->items[at].hidden = !t->items[at].hidden;
    DO(lmn_solid_set_shown(t->scene, r.solid, t->items[at].id, !t->items[at].hidden, &error));
}

static void set_operation(twin *t, root r)
{
    lmn_error error;
    item     *i = &t->items[any_operation(t, r.item)];
    t->last = "operation";
    i->operation = (lmn_operation)(1 + roll(t, 3));
    DO(lmn_solid_set_operation(t->scene, r.solid, i->id, i->operation, &error));
}

static void set_shape(twin *t, root r)
{
    lmn_error error;
    item     *i = &t->items[any(t, r.item)];
    t->last = "shape";
    if (i->operation != LMN_SHAPE)
        return;
    i->shape = random_shape(t);
    DO(lmn_solid_set_shape(t->scene, r.solid, i->id, &i->shape, &error));
}

static void move(twin *t, root r)
{
    lmn_error error;
    int       at = any(t, r.item), parent = any_operation(t, r.item);
    t->last = "move";
    if (at == r.item || is_below(t, parent, at) || t->items[parent].count + 1 >= CHILDREN_MAX)
        return;
    take_out(t, at);
    item    *p = &t->items[parent];
    int      position = (int)roll(t, (uint32_t)p->count + 1);
    uint32_t before = position < p->count ? t->items[p->children[position]].id : 0;
    memmove(&p->children[position + 1], &p->children[position], (size_t)(p->count++ - position) * sizeof(int));
    p->children[position] = at;
    t->items[at].parent = parent;
    DO(lmn_solid_move(t->scene, r.solid, t->items[at].id, p->id, before, &error));
}

static void remove_item(twin *t, root r, int at)
{
    lmn_error error;
    t->last = "remove";
    if (at == r.item)
        return;
    take_out(t, at);
    DO(lmn_solid_remove(t->scene, r.solid, t->items[at].id, &error));
}

static void empty(twin *t, root r)
{
    while (t->items[r.item].count)
        remove_item(t, r, t->items[r.item].children[0]);
    t->last = "empty";
}

static void edit(twin *t, root *r)
{
    lmn_error error;
    if (shapes_below(t, r->item) < 3 && roll(t, 4)) {
        add_shape(t, *r);
        return;
    }
    switch (roll(t, 27)) {
    case 0: empty(t, *r); return;
    case 1:
        if (t->root_count + 1 < ROOTS_MAX && roll(t, 2)) {
            DO(lmn_solid_remove(t->scene, r->solid, LMN_SOLID_ROOT, &error));
            r->item = -2;
            begin_solid(t);
            t->last = "remove solid and begin another";
        }
        return;
    case 2:
    case 3: add_operation(t, *r); return;
    case 4:
    case 5: copy(t, *r); return;
    case 6:
    case 7: set_colour(t, *r); return;
    case 8:
    case 9: set_operation(t, *r); return;
    case 10:
    case 11: set_shape(t, *r); return;
    case 12:
    case 13: move(t, *r); return;
    case 14:
    case 15: remove_item(t, *r, any(t, r->item)); return;
    case 16:
    case 17:
    case 18: set_matrix(t, *r, any(t, r->item)); return;
    case 19:
    case 20:
    case 21: set_shown(t, *r); return;
    default: add_shape(t, *r);
    }
}

static root *any_solid(twin *t)
{
    for (;;) {
        root *r = &t->roots[roll(t, (uint32_t)t->root_count)];
        if (r->item >= 0)
            return r;
    }
}

static void sequence(const char *title, uint32_t seed, int solids, int file_at, int steps)
{
    static twin t;
    lmn_error   error;
    int         shown = 0, wrong = 0, made = 0, compared_hidden = 0;
    t = (twin){.random = seed * 2654435761u, .last = "begin"};
    DO(lmn_scene_create(&t.scene, &error));
    for (int i = 0; i < solids; i++) {
        if (i == file_at)
            add_file(&t);
        begin_solid(&t);
        for (int k = 0; k < 4; k++)
            add_shape(&t, t.roots[t.root_count - 1]);
    }
    for (int step = 0; step < steps && t.item_count < ITEMS_MAX - CHILDREN_MAX; step++, made++) {
        if (step == file_at * 10)
            add_file(&t);
        for (uint32_t k = 0, edits = roll(&t, 6) ? 1 : 3; k < edits; k++)
            edit(&t, any_solid(&t));
        if (!is_comparable(&t))
            continue;
        compared_hidden += hides_shapes(&t);
        int full = compare(&t, step / 3 % LOOKS, step);
        wrong += full < 0;
        shown += full > 100;
    }
    check_at_most("K09", wrong, 0, "%s %u: drawings after %d edits that differ from those of fresh scenes", title, seed,
                  made);
    check_at_least("self", shown, 0.25 * made, "  drawings that show something");
    check_at_least("self", compared_hidden, 0.1 * made, "  drawings of what has hidden operands");
    lmn_scene_destroy(&t.scene);
}

static void one_solid(void)
{
    for (uint32_t seed = 1; seed <= 4; seed++)
        sequence("one solid", seed, 1, -1, 60);
}

static void several_solids(void)
{
    for (uint32_t seed = 1; seed <= 3; seed++)
        sequence("three solids", seed, 3, -1, 60);
}

/* The file comes before some of the solids, or between edits. */
static void with_a_mesh(void)
{
    for (uint32_t seed = 1; seed <= 3; seed++)
        sequence("two solids and meshes", seed, 2, 1, 60);
}

/* --- K09 by hand ---------------------------------------------------------------------------------------- */

/* A box minus a ball: each edit changes the picture at once. */
static void each_edit_shows(void)
{
    lmn_error    error;
    lmn_scene   *s = NULL;
    uint32_t     solid, cube, ball;
    lmn_shape    box = lmn_shape_box(2, 2, 2), round = lmn_shape_sphere(1.3), small = lmn_shape_sphere(0.8);
    const double aside[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0.5, 0.2, 0.4, 1};
    lmn_drawing *now[6] = {NULL};
    box.centred = true;
    round.facets.fn = small.facets.fn = 32;
    DO(lmn_scene_create(&s, &error));
    DO(lmn_scene_add_solid(s, "s", LMN_DIFFERENCE, &solid, &error));
    DO(lmn_solid_add_shape(s, solid, LMN_SOLID_ROOT, &box, &cube, &error));
    DO(lmn_solid_add_shape(s, solid, LMN_SOLID_ROOT, &round, &ball, &error));
    now[0] = draw(&edited_renderer, s, look_of(2));
    DO(lmn_solid_set_operation(s, solid, LMN_SOLID_ROOT, LMN_INTERSECTION, &error));
    now[1] = draw(&edited_renderer, s, look_of(2));
    DO(lmn_solid_set_operation(s, solid, LMN_SOLID_ROOT, LMN_UNION, &error));
    now[2] = draw(&edited_renderer, s, look_of(2));
    DO(lmn_solid_set_operation(s, solid, LMN_SOLID_ROOT, LMN_DIFFERENCE, &error));
    DO(lmn_solid_set_shape(s, solid, ball, &small, &error));
    now[3] = draw(&edited_renderer, s, look_of(2));
    DO(lmn_solid_set_matrix(s, solid, ball, aside, &error));
    now[4] = draw(&edited_renderer, s, look_of(2));
    DO(lmn_solid_remove(s, solid, ball, &error));
    now[5] = draw(&edited_renderer, s, look_of(2));
    for (int i = 0; i < 6; i++)
        for (int k = i + 1; k < 6; k++)
            if (!(i == 3 && k == 5)) /* a ball inside the box is not seen */
                check_at_least("K09", pixels_that_differ(now[i], now[k]), 20,
                               "pixels in which drawings %d and %d differ", i, k);
    check_at_most("K09", pixels_that_differ(now[3], now[5]), 0, "pixels that a hidden hollow changes");
    for (int i = 0; i < 6; i++)
        lmn_drawing_destroy(&now[i]);
    lmn_scene_destroy(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"shows", each_edit_shows}, {"one", one_solid}, {"several", several_solids}, {"mesh", with_a_mesh}};
    int status = check_main(argc, argv, "solid_edit", cases, sizeof cases / sizeof *cases);
    look_of(-1);
    lmn_renderer_destroy(&edited_renderer);
    lmn_renderer_destroy(&fresh_renderer);
    return status;
}
