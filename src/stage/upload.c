#include "stage/upload_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"

static lmn_status write_vertices(upload *u, gpu *g, const upload_part_job *job, size_t i, upload_vertices *v,
                                 lmn_error *error)
{
    vec3 *rest_positions =
        v->at_rest ? upload_rest_positions(u, job->part_index, v->at_rest, v->now->vertex_count) : NULL;
    lmn_status status = v->at_rest && !rest_positions ? error_memory(error) : LMN_OK;
    v->rest_positions = rest_positions;
    upload_walls walls = {.indices = NULL};
    if (status == LMN_OK && u->needs.walls && !v->at_rest && !v->past[0]) {
        status = upload_find_walls(&walls, u, job, v, error);
        v->now = &walls.data;
        v->walls = (const float *)walls.numbers;
    }
    if (status == LMN_OK && u->needs.field) {
        status = upload_with_field(u, g, job, i, v, error);
    } else if (status == LMN_OK) {
        gpu_mesh_data with = upload_data_over_time(v);
        status = upload_glue(u, &with, error);
        if (status == LMN_OK && upload_packs(u, job, &with))
            status = upload_pack_add(u, g, &job->meshes[i], &with, error);
        else if (status == LMN_OK)
            job->meshes[i] = upload_mesh_make(g, job, i, &with);
        mem_free((void *)(uintptr_t)with.glue);
    }
    mem_free(rest_positions);
    upload_walls_release(&walls);
    return status == LMN_OK ? gpu_check(g, error) : status;
}

/* Groups of a mesh whose vertices were elsewhere: those of primitives in which other ones lie at one position now are
 * dropped. False when memory is gone. */
static bool fit_corners(upload_corners *c, const mesh *m)
{
    bool good = true;
    for (size_t i = 0; i < c->count && good; i++) {
        const primitive *p = &m->primitives[i];
        if (!c->groups[i].ids)
            continue;
        uint32_t *ids = mesh_position_ids(p);
        good = ids != NULL;
        if (good && memcmp(ids, c->groups[i].ids, p->vertex_count * sizeof *ids) != 0)
            corner_groups_release(&c->groups[i]);
        mem_free(ids);
    }
    c->revision = good ? m->revision : c->revision;
    return good;
}

/* Where the groups of a primitive's corners are kept. */
static lmn_status find_corners(upload *u, const upload_part_job *job, size_t i, corner_groups **out, lmn_error *error)
{
    const lmn_scene *scene = u->pose->scene;
    upload_corners  *c = &u->corners[scene->nodes[scene->parts[job->part_index].node].mesh];
    if (c->groups && c->revision != job->mesh->revision && !fit_corners(c, job->mesh))
        return error_memory(error);
    if (!c->groups) {
        c->groups = mem_calloc(job->mesh->primitive_count, sizeof *c->groups);
        c->count = job->mesh->primitive_count;
        c->revision = job->mesh->revision;
        c->topology = job->mesh->topology;
    }
    *out = c->groups ? &c->groups[i] : NULL;
    return c->groups ? LMN_OK : error_memory(error);
}

static lmn_status upload_primitive(upload *u, gpu *g, const upload_part_job *job, size_t i, lmn_error *error)
{
    const primitive *p = &job->mesh->primitives[i];
    const pose      *at_rest = u->pose->at_rest;
    posed_mesh       now = {.positions = NULL};
    vec3            *rest = NULL, *past[POSE_PAST_MAX] = {NULL};
    bool deforms = at_rest && pose_deforms(job->pose, p), moved = deforms && (u->needs.rest || u->needs.field);
    corner_groups *kept = NULL;
    bool           again = deforms || job->mesh->moved; /* asked for in the next picture, too */
    lmn_status     status = again && !p->normals ? find_corners(u, job, i, &kept, error) : LMN_OK;
    if (status == LMN_OK)
        status = posed_make_keeping(&now, p, u->crease_angle, job->pose, kept, error);
    if (status == LMN_OK && moved)
        rest = posed_positions(p, &at_rest->parts[job->part_index], &now.split);
    if (status == LMN_OK && moved && !rest)
        status = error_memory(error);
    for (int k = 0; k < u->past_count && deforms && status == LMN_OK; k++) {
        past[k] = posed_positions(p, &u->pose->past[k]->parts[job->part_index], &now.split);
        status = past[k] ? LMN_OK : error_memory(error);
    }
    vec3 *straight = p->straight && now.split.source && status == LMN_OK
                         ? posed_gather(p->straight, now.split.source, now.split.vertex_count, sizeof *straight)
                         : NULL;
    if (status == LMN_OK && p->straight && now.split.source && !straight)
        status = error_memory(error);
    upload_vertices v = {.now = &now.data, .straight = straight ? straight : p->straight, .at_rest = rest};
    for (int k = 0; k < POSE_PAST_MAX; k++)
        v.past[k] = past[k];
    if (status == LMN_OK)
        status = write_vertices(u, g, job, i, &v, error);
    posed_release(&now);
    mem_free(straight);
    mem_free(rest);
    for (int k = 0; k < POSE_PAST_MAX; k++)
        mem_free(past[k]);
    return status;
}

void upload_set_past(const upload *u, draw_item *item, size_t instance)
{
    for (int k = 0; k < u->past_count; k++)
        item->past[k] = pose_instance(u->pose->past[k], item->part_index, instance);
}

static lmn_status add_whole(upload *u, gpu *g, upload_part_job *job, size_t i, const mat4 *world, lmn_error *error)
{
    const primitive *p = &job->mesh->primitives[i];
    lmn_status       status = LMN_OK;
    if (p->index_count == 0)
        return LMN_OK;
    if (!job->meshes[i])
        status = upload_primitive(u, g, job, i, error);
    draw_item item = upload_item(job, i);
    if (u->needs.walls)
        item.building = building_facts_of(u->pose->scene, u->pose->scene->parts[job->part_index].node);
    item.mesh = job->meshes[i];
    item.has_key = job->mesh_uses == 1 && gpu_mesh_key(item.mesh, &item.key);
    item.lapped = job->lapped[i];
    item.patch_radius = upload_patch_radius(u, p->bounds);
    item.world = *world;
    upload_set_past(u, &item, job->instance);
    u->triangles += p->index_count / 3;
    if (status == LMN_OK && !upload_add_item(u, &item))
        status = error_memory(error);
    return status;
}

static lmn_status add_instances(upload *u, gpu *g, upload_part_job *job, lmn_error *error)
{
    const lmn_scene *scene = u->pose->scene;
    const node      *n = &scene->nodes[scene->parts[job->part_index].node];
    lmn_status       status = LMN_OK;
    for (size_t k = 0; k < node_draw_count(n) && status == LMN_OK; k++) {
        mat4        world = pose_instance(u->pose, job->part_index, k);
        cut_verdict verdict = CUT_WHOLE;
        job->instance = k;
        status = upload_cut(u, g, job, &world, &verdict, error);
        for (size_t i = 0; i < job->mesh->primitive_count && status == LMN_OK && verdict == CUT_WHOLE; i++)
            status = add_whole(u, g, job, i, &world, error);
    }
    return status;
}

/* Where parts overlap, their cut faces lie in the same position: the smaller part's is seen, as within a part. Steps
 * are a few times what interpolated depth is off. */
static float nearer_of(const upload *u, size_t part_index)
{
    double fraction = u->extent > 0 ? box3_diagonal(u->pose->part_boxes[part_index]) / u->extent : 1;
    int    level = (int)(6 * (1 - sqrt(fmin(fmax(fraction, 0), 1))));
    return (float)(8 * level + (int)(part_index % 8)) * 3e-7f;
}

static bool make_room(upload_mesh *m, const mesh *source)
{
    if (!m->primitives) {
        m->primitives = mem_calloc(source->primitive_count, sizeof *m->primitives);
        m->lapped = mem_calloc(source->primitive_count, sizeof *m->lapped);
        m->count = source->primitive_count;
        m->revision = source->revision;
        m->topology = source->topology;
    }
    return m->primitives && m->lapped;
}

static lmn_status upload_part(upload *u, gpu *g, size_t part_index, lmn_error *error)
{
    const lmn_scene *scene = u->pose->scene;
    const node      *n = &scene->nodes[scene->parts[part_index].node];
    const part_pose *pose = &u->pose->parts[part_index];
    upload_part_job  job = {.part_index = part_index,
                            .mesh = &scene->meshes[n->mesh],
                            .mesh_uses = u->mesh_uses[n->mesh],
                            .pose = pose,
                            .nearer = nearer_of(u, part_index)};
    upload_mesh     *made = pose_part_deforms(pose) ? &u->posed[scene->parts[part_index].node] : &u->meshes[n->mesh];
    lmn_status       status = LMN_OK;
    if (make_room(made, job.mesh)) {
        job.meshes = made->primitives;
        job.lapped = made->lapped;
        job.former = made->former;
        status = add_instances(u, g, &job, error);
    } else {
        status = error_memory(error);
    }
    upload_part_close(&job);
    return status;
}

/* --- all parts ------------------------------------------------------------------------------------------ */

static lmn_status open_upload(upload *out, const pose *pose, const upload_desc *desc, lmn_error *error)
{
    const lmn_scene *scene = pose->scene;
    memset(out, 0, sizeof *out);
    out->revision = scene->revision;
    out->identity = scene->identity;
    out->crease_angle = desc->crease_angle;
    out->needs = desc->needs;
    out->pose = pose;
    out->when = pose->when;
    out->past_count = pose->past_count;
    out->past_seconds = pose->past_count ? pose->past_seconds : 0;
    out->has_removed = desc->removed;
    out->part_count = scene->part_count + (desc->removed ? scene->ghost_count : 0);
    out->texture_count = scene->image_count * 2;
    out->textures = mem_calloc(out->texture_count, sizeof(gpu_texture *));
    out->meshes = mem_calloc(scene->mesh_count, sizeof *out->meshes);
    out->posed = mem_calloc(scene->node_count, sizeof *out->posed);
    out->shapes = mem_calloc(scene->mesh_count + 1, sizeof *out->shapes);
    out->corners = mem_calloc(scene->mesh_count, sizeof *out->corners);
    out->mesh_uses = upload_count_uses(scene);
    if (!out->textures || !out->meshes || !out->posed || !out->shapes || !out->corners || !out->mesh_uses)
        return error_memory(error);
    out->mesh_count = scene->mesh_count;
    out->node_count = scene->node_count;
    if (!section_copy(&out->section, desc->section, pose->part_count + pose->ghost_count))
        return error_memory(error);
    out->extent = box3_is_empty(pose->box) ? 0 : box3_diagonal(pose->box);
    return LMN_OK;
}

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

static void release_mesh(upload_mesh *m, gpu *g)
{
    gpu_mesh ***lists[] = {&m->primitives, &m->lapped, &m->former};
    for (size_t i = 0; i < 3; i++) {
        for (size_t k = 0; *lists[i] && k < m->count; k++)
            gpu_mesh_destroy(g, &(*lists[i])[k]);
        mem_free(*lists[i]);
        *lists[i] = NULL;
    }
}

/* The buffers of a mesh whose vertices are elsewhere now. */
static void take_buffers(upload_mesh *to, upload_mesh *from, const mesh *m)
{
    if (!from->primitives || from->topology != m->topology)
        return;
    to->former = from->primitives;
    to->count = from->count;
    from->primitives = NULL;
}

/* What is deformed still holds at the same moment; at another one its buffers serve. */
static void take_posed(upload *u, upload *earlier, const lmn_scene *scene)
{
    bool same = moment_equal(&u->when, &earlier->when) && u->past_seconds == earlier->past_seconds &&
                u->past_count == earlier->past_count;
    for (size_t i = 0; i < smaller(u->node_count, earlier->node_count); i++) {
        upload_mesh *from = &earlier->posed[i], *to = &u->posed[i];
        int32_t      m = scene->nodes[i].mesh;
        if (same) {
            *to = *from;
            *from = (upload_mesh){.primitives = NULL};
        } else if (m != NONE) {
            take_buffers(to, from, &scene->meshes[m]);
        }
    }
}

/* Moves what still holds. A scene never takes anything out of its arrays, and what is at a position there and has the
 * same revision is the same; nodes and images do not change at all. */
static void take_over(upload *u, upload *earlier, const lmn_scene *scene)
{
    for (size_t i = 0; i < smaller(u->texture_count, earlier->texture_count); i++) {
        u->textures[i] = earlier->textures[i];
        earlier->textures[i] = NULL;
    }
    if (u->revision == earlier->revision && u->has_removed == earlier->has_removed) {
        u->marks = earlier->marks; /* these know which pose they are in */
        earlier->marks = NULL;
    }
    bool cut_alike = u->revision == earlier->revision
                         ? section_equal(&u->section, &earlier->section, scene->part_count + scene->ghost_count)
                         : u->section.cut.cell_count == 0 && earlier->section.cut.cell_count == 0;
    for (int i = 0; i < STROKE_STORES && cut_alike; i++) {
        u->strokes[i] = earlier->strokes[i]; /* these know of which moment and content they are */
        earlier->strokes[i] = NULL;
    }
    u->key_count = earlier->key_count; /* meshes that are taken over have theirs */
    take_posed(u, earlier, scene);
    for (size_t i = 0; i < smaller(u->mesh_count, earlier->mesh_count); i++) {
        if (earlier->meshes[i].revision == scene->meshes[i].revision) {
            u->meshes[i] = earlier->meshes[i];
            earlier->meshes[i] = (upload_mesh){.primitives = NULL};
        } else {
            take_buffers(&u->meshes[i], &earlier->meshes[i], &scene->meshes[i]);
        }
        if (earlier->corners[i].topology == scene->meshes[i].topology) {
            u->corners[i] = earlier->corners[i];
            earlier->corners[i] = (upload_corners){.groups = NULL};
        }
        if (earlier->shapes[i].revision == scene->meshes[i].revision) {
            u->shapes[i] = earlier->shapes[i];
            earlier->shapes[i] = (upload_shape){.vertices = NULL};
        }
    }
}

/* Buffers that fitted nothing. */
static void drop_former(upload_mesh *meshes, size_t count, gpu *g)
{
    for (size_t i = 0; i < count && meshes; i++) {
        for (size_t k = 0; meshes[i].former && k < meshes[i].count; k++)
            gpu_mesh_destroy(g, &meshes[i].former[k]);
        mem_free(meshes[i].former);
        meshes[i].former = NULL;
    }
}

lmn_status upload_create(upload *out, gpu *g, const pose *pose, const upload_desc *desc, upload *earlier,
                         lmn_progress_fn progress, void *user, lmn_error *error)
{
    const lmn_scene *scene = pose->scene;
    lmn_status       status = open_upload(out, pose, desc, error);
    if (status == LMN_OK && earlier)
        take_over(out, earlier, scene);
    for (size_t i = 0; i < out->part_count && status == LMN_OK; i++) {
        if (progress && !progress((double)i / (double)out->part_count, "preparing", user))
            status = error_set(error, LMN_CANCELLED, "cancelled");
        if (status == LMN_OK && scene->nodes[scene->parts[i].node].solid != NONE)
            status = upload_solid_part(out, g, i, earlier, error);
        else if (status == LMN_OK)
            status = upload_part(out, g, i, error);
    }
    upload_packs_close(out, g);
    if (status == LMN_OK)
        status = gpu_check(g, error);
    drop_former(out->posed, out->node_count, g);
    drop_former(out->meshes, out->mesh_count, g);
    if (status == LMN_OK)
        status = upload_solids_close(out, g, error);
    return status;
}

static void release_meshes(upload_mesh *meshes, size_t count, gpu *g)
{
    for (size_t i = 0; i < count && meshes; i++)
        release_mesh(&meshes[i], g);
    mem_free(meshes);
}

static void release_corners(upload *u)
{
    for (size_t i = 0; i < u->mesh_count && u->corners; i++) {
        for (size_t k = 0; u->corners[i].groups && k < u->corners[i].count; k++)
            corner_groups_release(&u->corners[i].groups[k]);
        mem_free(u->corners[i].groups);
    }
    mem_free(u->corners);
}

void upload_release(upload *u, gpu *g)
{
    for (size_t i = 0; i < u->piece_count; i++)
        gpu_mesh_destroy(g, &u->pieces[i]);
    for (size_t i = 0; i < u->texture_count && u->textures; i++)
        gpu_texture_destroy(g, &u->textures[i]);
    release_meshes(u->meshes, u->mesh_count, g);
    release_meshes(u->posed, u->node_count, g);
    for (size_t i = 0; i <= u->mesh_count && u->shapes; i++)
        upload_shape_release(&u->shapes[i]);
    mark_sets_release(&u->marks, g);
    gpu_target_release(g, u->part_frames);
    for (int i = 0; i < STROKE_STORES; i++)
        stroke_store_destroy(&u->strokes[i], g);
    gpu_target_release(g, u->lit.depth);
    mem_free(u->lit.parts);
    mem_free(u->ground_shadow.fallen);
    mem_free(u->ground_shadow.calmed);
    mem_free(u->part_frame_values);
    mem_free(u->rest_frame_values);
    gpu_target_release(g, u->operand_table);
    gpu_buffer_release(g, u->program_buffer);
    upload_solids_release(u, g);
    csg_program_release(&u->program);
    release_corners(u);
    mem_free(u->mesh_uses);
    mem_free(u->shapes);
    mem_free(u->planes);
    mem_free(u->operands);
    mem_free(u->pieces);
    mem_free(u->textures);
    mem_free(u->items);
    section_release(&u->section);
    memset(u, 0, sizeof *u);
}

static gpu_wrap wrap_of(wrap_mode wrap)
{
    return wrap == WRAP_REPEAT ? GPU_REPEAT : wrap == WRAP_MIRROR ? GPU_MIRROR : GPU_CLAMP;
}

gpu_texture *upload_texture(upload *u, gpu *g, const texture_use *use, bool linear)
{
    const lmn_scene *scene = u->pose->scene;
    if (use->image < 0 || !scene->images[use->image].pixels)
        return NULL;
    gpu_texture **slot = &u->textures[2 * (size_t)use->image + linear];
    const image  *i = &scene->images[use->image];
    if (!*slot)
        *slot = gpu_texture_create(g, (int)i->width, (int)i->height, linear ? GPU_RGBA8 : GPU_SRGB8, i->pixels,
                                   use->nearest, wrap_of(use->wrap_u), wrap_of(use->wrap_v));
    return *slot;
}
