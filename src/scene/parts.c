#include "scene/parts.h"
#include "scene/solid.h"

#include <stdatomic.h>
#include <stdio.h>
#include <string.h>

#include "base/limits.h"
#include "base/memory.h"
#include "base/text.h"
#include "base/threads.h"

/* A path is cut here, so that a deep tree of long names does not grow without bounds. */
enum { PATH_BYTES_MAX = 1024, PATH_DEPTH_MAX = 1100 };

/* Paths seen so far, open addressing, by the number of the part that has it, from 1; `repeats` counts how often a path
 * was asked for. */
typedef struct path_entry {
    uint32_t part, repeats; /* 0: nothing */
} path_entry;

typedef struct path_set {
    path_entry *entries;
    size_t      capacity; /* a power of two */
} path_set;

typedef struct listing {
    const lmn_scene *scene;
    const char      *prefix;
    uint32_t         first_id;
    mat4            *worlds; /* of all nodes, for joints may be anywhere; NULL: there are no skins */
    const mat4      *position;
    part            *parts;
    size_t           count;
    path_set         seen;
    atomic_bool      failed;
} listing;

static uint64_t hash_text(const char *t)
{
    uint64_t h = UINT64_C(14695981039346656037);
    for (; *t; t++)
        h = (h ^ (unsigned char)*t) * UINT64_C(1099511628211);
    return h ^ (h >> 29);
}

static path_entry *find_path(const listing *l, const char *path)
{
    const path_set *set = &l->seen;
    size_t          slot = hash_text(path) & (set->capacity - 1);
    while (set->entries[slot].part && strcmp(l->parts[set->entries[slot].part - 1].path, path) != 0)
        slot = (slot + 1) & (set->capacity - 1);
    return &set->entries[slot];
}

static const char *own_name(const lmn_scene *s, int32_t index)
{
    const node *n = &s->nodes[index];
    if (n->name && n->name[0])
        return n->name;
    const char *mesh_name = n->mesh != NONE ? s->meshes[n->mesh].name : NULL;
    return mesh_name && mesh_name[0] ? mesh_name : NULL;
}

static void append_cut(text *t, const char *step)
{
    size_t length = strlen(step);
    size_t capacity = t->size < PATH_BYTES_MAX ? PATH_BYTES_MAX - t->size : 0;
    if (length > capacity) {
        length = capacity;
        /* Never cut inside a UTF-8 character. */
        while (length > 0 && ((unsigned char)step[length] & 0xC0) == 0x80)
            length--;
    }
    text_append_bytes(t, step, length);
}

/* Names from the root joined by '/'; nodes without a name in between are left out. */
static char *make_path(const listing *l, int32_t index, const char *name)
{
    int32_t chain[PATH_DEPTH_MAX];
    int     depth = 0;
    for (int32_t n = l->scene->nodes[index].parent; n != NONE && depth < PATH_DEPTH_MAX; n = l->scene->nodes[n].parent)
        chain[depth++] = n;
    text t = {0};
    if (l->prefix) {
        append_cut(&t, l->prefix);
        append_cut(&t, "/");
    }
    while (depth-- > 0) {
        const char *step = own_name(l->scene, chain[depth]);
        if (!step)
            continue;
        append_cut(&t, step);
        append_cut(&t, "/");
    }
    append_cut(&t, name);
    return text_take(&t);
}

/* Where a part before has its path, "#2", "#3" … is put behind it. False: memory is gone. */
static bool make_unique(listing *l, size_t number)
{
    char       *path = l->parts[number].path;
    path_entry *entry = find_path(l, path);
    if (!entry->part) {
        *entry = (path_entry){(uint32_t)number + 1, 1};
        return true;
    }
    for (;;) {
        text t = {0};
        text_append(&t, "%s#%u", path, (unsigned)++entry->repeats);
        char *changed = text_take(&t);
        if (!changed)
            return false;
        path_entry *other = find_path(l, changed);
        if (!other->part) {
            *other = (path_entry){(uint32_t)number + 1, 1};
            mem_free(path);
            l->parts[number].path = changed;
            return true;
        }
        mem_free(changed);
    }
}

static bool is_part(const lmn_scene *s, int32_t index, bool ghost)
{
    const node *n = &s->nodes[index];
    bool        lines = n->solid == NONE && n->mesh != NONE;
    return n->ghost == ghost && (node_triangle_count(s, n) > 0 || (lines && mesh_line_count(&s->meshes[n->mesh]) > 0));
}

/* Where a node is whose scene has no skins. */
static mat4 world_of(const listing *l, int32_t index)
{
    int32_t chain[PATH_DEPTH_MAX];
    int     depth = 0;
    for (int32_t n = index; n != NONE && depth < PATH_DEPTH_MAX; n = l->scene->nodes[n].parent)
        chain[depth++] = n;
    mat4 out = l->position ? *l->position : mat4_identity();
    for (bool first = !l->position; depth-- > 0; first = false) {
        mat4 local = node_local_matrix(&l->scene->nodes[chain[depth]]);
        out = first ? local : mat4_multiply(&out, &local);
    }
    return out;
}

/* All of a part but that its path is unique. False: memory is gone. */
static bool fill_part(listing *l, size_t number)
{
    char        fallback[32];
    part       *p = &l->parts[number];
    const node *n = &l->scene->nodes[p->node];
    const char *name = own_name(l->scene, p->node);
    if (!name) {
        snprintf(fallback, sizeof fallback, "part-%u", (unsigned)(l->first_id + number + 1));
        name = fallback;
    }
    p->name = mem_copy_text(name);
    p->path = p->name ? make_path(l, p->node, name) : NULL;
    if (!p->path)
        return false;
    p->triangles = node_triangle_count(l->scene, n);
    p->lines = n->solid == NONE && n->mesh != NONE ? mesh_line_count(&l->scene->meshes[n->mesh]) : 0;
    p->edge_lines = p->lines > 0;
    for (size_t i = 0; p->lines && i < l->scene->meshes[n->mesh].primitive_count; i++) {
        const primitive *of = &l->scene->meshes[n->mesh].primitives[i];
        p->edge_lines = p->edge_lines && (!of->line_count || of->edge_lines);
    }
    if (l->worlds) {
        p->bounds = node_bounds(l->scene, l->worlds, p->node, NULL, NULL);
    } else {
        mat4 world = world_of(l, p->node);
        p->bounds = node_bounds_unskinned(l->scene, &world, p->node);
    }
    return true;
}

static void fill_some(size_t begin, size_t end, void *user)
{
    listing *l = user;
    bool     good = true;
    for (size_t i = begin; i < end && good; i++)
        good = fill_part(l, i);
    if (!good)
        atomic_store(&l->failed, true);
}

static void add_trees(listing *l, bool ghosts)
{
    for (size_t i = 0; i < l->scene->node_count; i++)
        for (int32_t root = (int32_t)i, n = l->scene->nodes[i].parent == NONE ? root : NONE; n != NONE;
             n = scene_next_node(l->scene, root, n))
            if (is_part(l->scene, n, ghosts))
                l->parts[l->count++] = (part){.node = n, .ghost = l->scene->nodes[n].ghost};
}

static bool make_paths_unique(listing *l)
{
    bool good = true;
    for (size_t i = 0; i < l->count && good; i++)
        good = make_unique(l, i);
    return good;
}

bool parts_list(const lmn_scene *s, const char *prefix, uint32_t first_id, const mat4 *position, part_list *out)
{
    size_t count = 0, ghosts = 0;
    for (size_t i = 0; i < s->node_count; i++) {
        bool found = is_part(s, (int32_t)i, s->nodes[i].ghost);
        count += found;
        ghosts += found && s->nodes[i].ghost;
    }
    listing l = {.scene = s, .prefix = prefix, .first_id = first_id};
    l.seen.capacity = 16;
    while (l.seen.capacity < count * 2)
        l.seen.capacity *= 2;
    l.seen.entries = mem_calloc(l.seen.capacity, sizeof *l.seen.entries);
    l.parts = mem_calloc(count, sizeof *l.parts);
    l.position = position;
    if (s->skin_count)
        l.worlds = scene_world_matrices(s, NULL);
    bool good = l.seen.entries && l.parts && (l.worlds || !s->skin_count);
    for (size_t i = 0; good && l.worlds && position && i < s->node_count; i++)
        l.worlds[i] = mat4_multiply(position, &l.worlds[i]);
    enum { LEAST_OF_THREAD = 4096 };
    if (good) {
        add_trees(&l, false);
        if (ghosts)
            add_trees(&l, true);
        threads_for(l.count, LEAST_OF_THREAD, fill_some, &l);
        good = !l.failed && make_paths_unique(&l);
    }
    mem_free(l.seen.entries);
    mem_free(l.worlds);
    if (!good) {
        parts_release(l.parts, l.count);
        return false;
    }
    *out = (part_list){l.parts, l.count - ghosts, ghosts};
    return true;
}

bool parts_fit(const part_list *list, const char *prefix)
{
    size_t length = strlen(prefix) + 1;
    bool   fits = true;
    for (size_t i = 0; i < list->part_count + list->ghost_count && fits; i++)
        fits = length + strlen(list->parts[i].path) < PATH_BYTES_MAX;
    return fits;
}

bool parts_put_below(part_list *list, const char *prefix)
{
    size_t length = strlen(prefix);
    for (size_t i = 0; i < list->part_count + list->ghost_count; i++) {
        size_t size = strlen(list->parts[i].path) + 1;
        char  *path = mem_realloc(list->parts[i].path, length + 1 + size);
        if (!path)
            return false;
        memmove(path + length + 1, path, size);
        memcpy(path, prefix, length);
        path[length] = '/';
        list->parts[i].path = path;
    }
    return true;
}

size_t scene_plain_node_count(const lmn_scene *s)
{
    size_t count = 0;
    for (size_t i = 0; i < s->node_count; i++)
        count += !s->nodes[i].ghost && !s->nodes[i].removed;
    return count;
}

size_t scene_part_of_ghost(const lmn_scene *s, size_t ghost_index)
{
    int32_t above = s->parts[ghost_index].ghost ? s->nodes[s->parts[ghost_index].node].parent : NONE;
    for (size_t i = 0; above != NONE && i < s->part_count; i++)
        if (s->parts[i].node == above)
            return i;
    return SIZE_MAX;
}
