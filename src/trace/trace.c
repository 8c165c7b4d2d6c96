#include "trace/trace.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "cut/cut.h"
#include "trace/trace_private.h"

/* The pose before, from which it is measured how things move: fraction of the exposure. */
#define BEFORE (1.0 / 16)

bool put_ribbon(trace_job *j, stroke_class kind, uint32_t part, uint64_t id, const ribbon_point *points, size_t count)
{
    ribbon_set *out = j->out;
    if (!mem_grow((void **)&out->ribbons, &j->ribbon_capacity, out->ribbon_count + 1, sizeof *out->ribbons) ||
        !mem_grow((void **)&out->points, &j->point_capacity, out->point_count + count, sizeof *out->points))
        return false;
    out->ribbons[out->ribbon_count] = (ribbon){
        .kind = kind,
        .part = part,
        .chain = (uint32_t)out->ribbon_count,
        .id = id,
        .ink = j->o->ink,
        .brush = kind == STROKE_PAST && j->o->values->contour_brush ? j->o->values->contour_brush - 1 : j->o->brush,
        .first = (uint32_t)out->point_count,
        .count = (uint32_t)count};
    memcpy(out->points + out->point_count, points, count * sizeof *points);
    out->ribbon_count++;
    out->point_count += count;
    return true;
}

bool is_cut_away(const traces_options *o, uint32_t part, const double page[3])
{
    double at[3];
    if (!o->section.cut || o->section.cut->cell_count == 0 || (o->section.spared && o->section.spared[part]))
        return false;
    page_unproject(&o->camera, page, at);
    const vec3 point = {(float)at[0], (float)at[1], (float)at[2]};
    return cut_judge_box(o->section.cut, (box3){point, point}) == CUT_GONE;
}

bool nothing_hides(const traces_options *o, uint32_t part, const double page[3])
{
    double   world[1][3];
    uint32_t before;
    if (is_cut_away(o, part, page))
        return false;
    if (!o->camera.orthographic && page[2] < o->camera.near * 1.001)
        return true; /* before all that is there now */
    page_unproject(&o->camera, page, world[0]);
    stroke_view_count(o->seen, (const double(*)[3])world, 1, &before);
    return before == 0;
}

/* Bodies, again without those that jump: beside these, others may have been too slow. */
static lmn_status find_what_goes(trace_job *j, const pose *before, bool *jumping, lmn_error *error)
{
    const traces_options *o = j->o;
    lmn_status            status = LMN_OK;
    size_t                known = SIZE_MAX;
    while (status == LMN_OK && known != j->facts->leaps) {
        known = j->facts->leaps;
        bodies_release(&j->bodies);
        status = bodies_find(&j->bodies, o->pose, before, BEFORE,
                             &(bodies_wanted){o->parts, jumping, &o->camera, o->section}, error);
        if (status == LMN_OK)
            status = jumps_find(jumping, &j->facts->leaps, &j->bodies, o, before, BEFORE, error);
    }
    return status;
}

static lmn_status find_bodies(trace_job *j, lmn_error *error)
{
    pose       before = {.scene = NULL};
    bool      *jumping = mem_calloc(j->o->pose->scene->node_count + 1, sizeof *jumping);
    lmn_status status = jumping ? pose_ago(&before, j->o, BEFORE, error) : error_memory(error);
    if (status == LMN_OK)
        status = find_what_goes(j, &before, jumping, error);
    pose_release(&before);
    mem_free(jumping);
    j->moves = status == LMN_OK ? mem_calloc(j->o->pose->part_count + 1, sizeof *j->moves) : NULL;
    if (status == LMN_OK && (!j->moves || !page_mask_open(&j->mask, &j->o->camera)))
        status = error_memory(error);
    for (size_t i = 0; i < j->bodies.mesh_count && status == LMN_OK; i++)
        j->moves[j->bodies.meshes[i].part] = true;
    for (size_t i = 0; i < j->bodies.triangle_count && status == LMN_OK; i++) {
        const uint32_t *t = j->bodies.triangles[i];
        page_mask_add(&j->mask, j->bodies.now[t[0]], j->bodies.now[t[1]], j->bodies.now[t[2]]);
    }
    j->facts->bodies = j->bodies.body_count;
    for (size_t i = 0; i < j->bodies.body_count; i++)
        j->facts->towards += j->bodies.bodies[i].motion == MOVES_TOWARDS;
    return status;
}

lmn_status traces_make(ribbon_set *out, trace_facts *facts, const traces_options *options, lmn_error *error)
{
    trace_job j = {.o = options, .out = out, .facts = facts};
    memset(out, 0, sizeof *out);
    memset(facts, 0, sizeof *facts);
    if (!options->pose->at_rest || !(options->pose->when.seconds > 0))
        return LMN_OK;
    lmn_status status = find_bodies(&j, error);
    bool       moves = status == LMN_OK && j.bodies.body_count > 0;
    if (moves && options->values->contours > 0)
        status = past_contours_put(&j, error);
    if (status == LMN_OK && options->values->vibration > 0)
        status = shakes_put(&j, error);
    if (moves && status == LMN_OK && options->values->flow > 0)
        status = flow_lines_put(&j, error);
    if (moves && status == LMN_OK && options->values->lines > 0) {
        status = heights_find(&j.heights, &j, error);
        if (status == LMN_OK && !origins_find(&j.origins, options, &j.bodies, &j.heights))
            status = error_memory(error);
        if (status == LMN_OK)
            status = ways_follow(&j.ways, options, &j.bodies, j.origins.items, j.origins.count, error);
        if (status == LMN_OK)
            status = speed_lines_put(&j, error);
    }
    if (moves && status == LMN_OK)
        status = measures_take(&j, error);
    facts->lines_missing = moves && options->values->lines > 0 && facts->measures.lines == 0;
    page_mask_close(&j.mask);
    mem_free(j.moves);
    bones_release(&j.bones);
    heights_release(&j.heights);
    mem_free(j.origins.items);
    ways_release(&j.ways);
    bodies_release(&j.bodies);
    if (status != LMN_OK)
        ribbon_set_release(out);
    return status;
}
