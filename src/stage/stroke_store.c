#include "stage/stroke_store.h"

#include <string.h>

#include "base/memory.h"

static void release_found(stroke_found *f)
{
    stroke_set_release(&f->lines);
    mem_free(f->parts);
    *f = (stroke_found){.parts = NULL};
}

static void release_lines(stroke_store *s)
{
    for (int i = 0; i < STROKES_FOUND_MOST; i++)
        release_found(&s->found[i]);
}

static void release_view(stroke_store *s)
{
    release_lines(s);
    if (s->view)
        stroke_view_destroy(&s->view);
    s->view = NULL;
}

/* All but what another moment has in common with it. */
static void empty_store(stroke_store *s, gpu *g)
{
    stroke_topologies topologies = s->topologies;
    release_view(s);
    for (size_t i = 0; i < s->scene.mesh_count && s->edges; i++)
        gpu_marks_destroy(g, &s->edges[i]);
    for (size_t i = 0; i < s->scene.item_count && s->crossings; i++)
        gpu_marks_destroy(g, &s->crossings[i]);
    for (size_t i = 0; i < s->scene.item_count && s->seen; i++)
        gpu_marks_destroy(g, &s->seen[i].edges);
    stroke_scene_release(&s->scene);
    mem_free(s->seen);
    mem_free(s->edges);
    mem_free(s->turns);
    mem_free(s->crossings);
    mem_free(s->parts);
    *s = (stroke_store){.topologies = topologies};
}

void stroke_store_destroy(stroke_store **store, gpu *g)
{
    stroke_store *s = *store;
    if (!s)
        return;
    empty_store(s, g);
    stroke_topologies_release(&s->topologies);
    mem_free(s);
    *store = NULL;
}

static bool is_as_wished(const stroke_store *s, const stroke_store_options *w)
{
    return s->revision == w->pose->revision && moment_equal(&s->when, &w->pose->when) &&
           s->part_count == w->part_count && s->refine == w->refine &&
           memcmp(s->parts, w->hides, w->part_count * sizeof *s->parts) == 0;
}

static lmn_status fill_store(stroke_store *s, const stroke_store_options *w, lmn_error *error)
{
    s->refine = w->refine;
    s->part_count = w->part_count;
    s->when = w->pose->when;
    s->revision = w->pose->revision;
    s->parts = mem_copy(w->hides, w->part_count * sizeof *s->parts);
    lmn_status status = s->parts ? LMN_OK : error_memory(error);
    if (status == LMN_OK)
        status = stroke_scene_create_keeping(&s->scene, w->pose, s->parts, w->crease_angle, w->refine, &s->topologies,
                                             w->section, error);
    if (status != LMN_OK)
        return status;
    s->edges = mem_calloc(s->scene.mesh_count, sizeof(gpu_marks *));
    s->turns = mem_calloc(s->scene.mesh_count, sizeof *s->turns);
    s->crossings = mem_calloc(s->scene.item_count, sizeof(gpu_marks *));
    s->seen = mem_calloc(s->scene.item_count, sizeof *s->seen);
    return s->edges && s->turns && s->crossings && s->seen ? LMN_OK : error_memory(error);
}

stroke_store *stroke_store_find(stroke_store **slot, gpu *g, const stroke_store_options *options)
{
    if (*slot && is_as_wished(*slot, options))
        return *slot;
    lmn_error     error = {0};
    stroke_store *s = *slot ? *slot : mem_calloc(1, sizeof *s);
    if (*slot)
        empty_store(s, g);
    lmn_status status = s ? fill_store(s, options, &error) : error_memory(&error);
    if (status != LMN_OK) {
        stroke_store_destroy(&s, g);
        gpu_fail(g, status, "%s", error.message);
    }
    *slot = s;
    return s;
}

/* What was made of crossings goes when others are asked for. */
static lmn_status cross(stroke_store *s, gpu *g, const bool *parts, lmn_error *error)
{
    if (stroke_scene_has_crossings(&s->scene, parts, s->part_count))
        return LMN_OK;
    release_lines(s);
    for (size_t i = 0; i < s->scene.item_count; i++)
        gpu_marks_destroy(g, &s->crossings[i]);
    return stroke_scene_cross(&s->scene, parts, s->part_count, NULL, NULL, error);
}

void stroke_store_fix(stroke_store *s, gpu *g, const bool *crossings, bool bends)
{
    lmn_error  error = {0};
    lmn_status status = crossings ? cross(s, g, crossings, &error) : LMN_OK;
    if (status == LMN_OK && bends)
        status = stroke_scene_bend(&s->scene, NULL, NULL, &error);
    if (status != LMN_OK)
        gpu_fail(g, status, "%s", error.message);
}

lmn_status stroke_store_look(stroke_store *s, const stroke_camera *camera, lmn_error *error)
{
    if (s->view && memcmp(&s->camera, camera, sizeof *camera) == 0)
        return LMN_OK;
    release_view(s);
    s->camera = *camera;
    lmn_status status = stroke_scene_calm(&s->scene, error);
    if (status != LMN_OK)
        return status;
    return stroke_view_create(&s->view, &s->scene, camera, NULL, NULL, error);
}

/* What was found for the same wish, or the place of what was not asked for longest. */
static stroke_found *find_found(stroke_store *s, const stroke_options *options, const bool *parts)
{
    stroke_found *oldest = &s->found[0];
    for (int i = 0; i < STROKES_FOUND_MOST; i++) {
        stroke_found *f = &s->found[i];
        if (f->parts && memcmp(&f->options, options, sizeof *options) == 0 &&
            memcmp(f->parts, parts, s->part_count * sizeof *parts) == 0)
            return f;
        oldest = f->asked < oldest->asked ? f : oldest;
    }
    release_found(oldest);
    return oldest;
}

lmn_status stroke_store_lines(stroke_store *s, const stroke_set **out, const stroke_options *options, const bool *parts,
                              lmn_error *error)
{
    stroke_found *f = find_found(s, options, parts);
    *out = &f->lines;
    f->asked = ++s->asked;
    if (f->parts)
        return LMN_OK;
    f->options = *options;
    f->parts = mem_copy(parts, s->part_count * sizeof *parts);
    lmn_status status = f->parts ? LMN_OK : error_memory(error);
    if (status == LMN_OK)
        status = stroke_find(&f->lines, s->view, options, parts, NULL, NULL, error);
    if (status != LMN_OK)
        release_found(f);
    return status;
}
