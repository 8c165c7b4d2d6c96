/* Solids on the GPU: the triangles of all operands as one mesh, each with its operand's number and its plane, and
 * the trees as a program. What the set operations leave of them is found when they are drawn. */
#include "stage/upload_private.h"

#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "layer/layer.h"
#include "csg_tree/form.h"
#include "stroke/solid_section.h"

/* Light grey, sRGB 0.8, as formats without colours have it. */
static const vec4 plain_grey = {0.6038f, 0.6038f, 0.6038f, 1};
/* Of what is taken away, where the file says no colour: a warm red, sRGB 0.85 0.26 0.16. */
static const vec4 removed_red = {0.693f, 0.055f, 0.022f, 1};

/* One solid while it is put together. */
typedef struct baker {
    const lmn_scene *scene;
    double           crease_angle;
    upload_shape    *shapes; /* per mesh; the upload's, as other solids may ask the same */
    bool             has_lists;
    mesh             half_space; /* what sections take away, numbered behind the scene's meshes */
    vec3            *positions, *normals;
    uint32_t        *keys, *indices, *owners;
    size_t           vertex_count, vertex_capacity, normal_capacity, index_count, index_capacity, owner_capacity;
} baker;

static const mesh *mesh_of(const baker *b, int32_t index)
{
    return (size_t)index < b->scene->mesh_count ? &b->scene->meshes[index] : &b->half_space;
}

static void baker_release(baker *b)
{
    mem_free(b->positions);
    mem_free(b->normals);
    mem_free(b->keys);
    mem_free(b->indices);
    mem_free(b->owners);
}

void upload_shape_release(upload_shape *s)
{
    for (size_t i = 0; i < s->count; i++)
        render_vertices_release(&s->vertices[i]);
    mem_free(s->vertices);
}

/* The vertices of a mesh's primitives, split at creases. NULL after an error. */
static const render_vertices *vertices_of(baker *b, int32_t mesh_index, lmn_error *error)
{
    const mesh   *m = mesh_of(b, mesh_index);
    upload_shape *s = &b->shapes[mesh_index];
    if (s->vertices)
        return s->vertices;
    s->vertices = mem_calloc(m->primitive_count, sizeof *s->vertices);
    if (!s->vertices) {
        error_memory(error);
        return NULL;
    }
    s->count = m->primitive_count;
    s->revision = m->revision;
    for (size_t i = 0; i < m->primitive_count; i++) {
        s->vertices[i] = (render_vertices){.vertex_count = m->primitives[i].vertex_count,
                                           .index_count = m->primitives[i].index_count};
        if (!m->primitives[i].normals &&
            mesh_make_normals(&s->vertices[i], &m->primitives[i], b->crease_angle, error) != LMN_OK)
            return NULL;
    }
    return s->vertices;
}

/* Six times the volume inside, positive when triangles run anticlockwise seen from outside. */
static double signed_volume(const mesh *m)
{
    double sum = 0;
    for (size_t k = 0; k < m->primitive_count; k++) {
        const primitive *p = &m->primitives[k];
        vec3             o = p->positions[0];
        for (uint32_t i = 0; i + 2 < p->index_count; i += 3) {
            double c[3][3];
            for (uint32_t j = 0; j < 3; j++) {
                vec3 v = p->positions[p->indices[i + j]];
                c[j][0] = (double)v.x - (double)o.x;
                c[j][1] = (double)v.y - (double)o.y;
                c[j][2] = (double)v.z - (double)o.z;
            }
            sum += c[0][0] * (c[1][1] * c[2][2] - c[1][2] * c[2][1]) +
                   c[0][1] * (c[1][2] * c[2][0] - c[1][0] * c[2][2]) +
                   c[0][2] * (c[1][0] * c[2][1] - c[1][1] * c[2][0]);
        }
    }
    return sum;
}

/* Asked once a mesh. Points and faces are few or the answer is no: beyond, looking costs more than it saves. */
static bool is_convex(baker *b, int32_t mesh_index)
{
    if (b->shapes[mesh_index].convex == 0)
        b->shapes[mesh_index].convex = mesh_is_convex(mesh_of(b, mesh_index)) ? 1 : -1;
    return b->shapes[mesh_index].convex > 0;
}

static bool is_inside_out(baker *b, int32_t mesh_index)
{
    if (b->shapes[mesh_index].inside_out == 0)
        b->shapes[mesh_index].inside_out = signed_volume(mesh_of(b, mesh_index)) < 0 ? 1 : -1;
    return b->shapes[mesh_index].inside_out > 0;
}

/* Transforms normals: the inverse transpose up to a positive scale, turned when the mesh is. */
typedef struct turning {
    double cofactor[9];
    bool   flips; /* triangles change their way round */
} turning;

static turning turning_of(const mat4 *matrix, bool inside_out)
{
    turning t;
    double  determinant = mat4_cofactors(matrix, t.cofactor);
    t.flips = (determinant < 0) != inside_out;
    if (t.flips)
        for (int i = 0; i < 9; i++)
            t.cofactor[i] = -t.cofactor[i];
    return t;
}

static vec3 turned_normal(const turning *t, vec3 n)
{
    const double *c = t->cofactor;
    double        x = c[0] * (double)n.x + c[3] * (double)n.y + c[6] * (double)n.z,
           y = c[1] * (double)n.x + c[4] * (double)n.y + c[7] * (double)n.z,
           z = c[2] * (double)n.x + c[5] * (double)n.y + c[8] * (double)n.z, length = sqrt(x * x + y * y + z * z);
    if (!(length > 0))
        return (vec3){0, 0, 1};
    return (vec3){(float)(x / length), (float)(y / length), (float)(z / length)};
}

static bool make_room(baker *b, size_t vertices, size_t indices)
{
    size_t keys = b->vertex_capacity;
    return mem_grow((void **)&b->positions, &b->vertex_capacity, b->vertex_count + vertices, sizeof *b->positions) &&
           mem_grow((void **)&b->keys, &keys, b->vertex_count + vertices, sizeof *b->keys) &&
           mem_grow((void **)&b->normals, &b->normal_capacity, b->vertex_count + vertices, sizeof *b->normals) &&
           mem_grow((void **)&b->indices, &b->index_capacity, b->index_count + indices, sizeof *b->indices) &&
           mem_grow((void **)&b->owners, &b->owner_capacity, (b->index_count + indices) / 3, sizeof *b->owners);
}

static void bake_primitive(baker *b, const primitive *p, const render_vertices *v, const mat4 *matrix, const turning *t,
                           uint32_t number, bool taken_away)
{
    const vec3     *normals = v->normals ? v->normals : p->normals;
    const uint32_t *indices = v->indices ? v->indices : p->indices;
    uint32_t        first = (uint32_t)b->vertex_count;
    for (uint32_t i = 0; i < v->vertex_count; i++) {
        size_t at = b->vertex_count++;
        b->positions[at] = mat4_transform_point(matrix, p->positions[v->source ? v->source[i] : i]);
        b->normals[at] = turned_normal(t, normals[i]);
        b->keys[at] = number << CSG_KEY_OPERAND_SHIFT | (taken_away ? 0 : CSG_KEY_KEPT);
    }
    for (uint32_t i = 0; i < v->index_count; i += 3) {
        b->owners[b->index_count / 3] = number;
        for (uint32_t k = 0; k < 3; k++)
            b->indices[b->index_count++] = first + indices[i + (t->flips ? 2 - k : k)];
    }
}

static lmn_status bake_operand(baker *b, const solid_operand *o, uint32_t number, bool taken_away, lmn_error *error)
{
    const mesh            *m = mesh_of(b, o->mesh);
    const render_vertices *v = vertices_of(b, o->mesh, error);
    if (!v)
        return LMN_MEMORY;
    turning t = turning_of(&o->matrix, is_inside_out(b, o->mesh));
    for (size_t i = 0; i < m->primitive_count; i++) {
        if (!make_room(b, v[i].vertex_count, v[i].index_count))
            return error_memory(error);
        bake_primitive(b, &m->primitives[i], &v[i], &o->matrix, &t, number, taken_away);
    }
    return LMN_OK;
}

/* A triangle in a plane that others share gets a last corner of its own, which carries the plane's number. */
static lmn_status mark_planes(baker *b, const uint16_t *numbers, lmn_error *error)
{
    size_t marked = 0;
    for (size_t i = 0; i < b->index_count / 3; i++)
        marked += numbers[i] != 0;
    if (!make_room(b, marked, 0))
        return error_memory(error);
    for (size_t i = 0; i < b->index_count / 3; i++) {
        if (!numbers[i])
            continue;
        uint32_t *last = &b->indices[3 * i + 2];
        size_t    own = b->vertex_count++;
        b->positions[own] = b->positions[*last];
        b->normals[own] = b->normals[*last];
        b->keys[own] = b->keys[*last] | numbers[i];
        *last = (uint32_t)own;
    }
    return LMN_OK;
}

/* All solids together have CSG_PLANES_MAX. */
static size_t plane_capacity(const upload *u)
{
    return CSG_PLANES_MAX - u->plane_count;
}

/* Of what can be left of the solid: cutters may be far longer. */
static double extent_of(const upload_solid *s)
{
    box3   box = s->form.root == NONE ? box3_empty() : s->form.terms[s->form.root].box;
    double x = (double)box.max.x - (double)box.min.x, y = (double)box.max.y - (double)box.min.y,
           z = (double)box.max.z - (double)box.min.z;
    return box3_is_empty(box) ? 0 : sqrt(x * x + y * y + z * z);
}

static lmn_status find_planes(upload_solid *s, baker *b, size_t capacity, lmn_error *error)
{
    csg_soup  soup = {b->positions, b->indices, b->owners, b->index_count / 3, extent_of(s)};
    uint16_t *numbers = NULL;
    if (!csg_find_planes(&soup, &numbers, &s->planes, &s->planes_found))
        return error_memory(error);
    for (size_t i = 0; s->planes_found > capacity && i < soup.triangle_count; i++)
        numbers[i] = numbers[i] > capacity ? 0 : numbers[i];
    s->plane_count = s->planes_found < capacity ? s->planes_found : capacity;
    lmn_status status = mark_planes(b, numbers, error);
    mem_free(numbers);
    return status;
}

static bool add_planes(upload *u, const upload_solid *s)
{
    if (!mem_grow((void **)&u->planes, &u->plane_capacity, u->plane_count + s->plane_count, sizeof *u->planes))
        return false;
    if (s->plane_count)
        memcpy(u->planes + u->plane_count, s->planes, s->plane_count * sizeof *s->planes);
    u->plane_count += s->plane_count;
    return true;
}

/* Colours and part of the operands, and the tree. */
static lmn_status add_program(upload *u, const upload_solid *s, size_t part_index, lmn_error *error)
{
    size_t first = u->program.operand_count, count = s->count;
    if (first + count > CSG_OPERANDS_MAX)
        return error_set(error, LMN_LIMIT, "the solids of the scene have more than %d operands in all",
                         CSG_OPERANDS_MAX);
    if (!csg_program_add(&u->program, &s->form) ||
        !mem_grow((void **)&u->operands, &u->operand_capacity, first + count, sizeof *u->operands))
        return error_memory(error);
    for (size_t i = 0; i < count; i++) {
        const solid_operand *o = &s->form.operands[s->used[i]];
        /* Cut faces have the colour of what the solid begins with. */
        if (s->cut_bits[s->used[i]])
            o = &s->form.operands[s->used[0]];
        vec4     c = o->has_colour ? o->colour : s->ghost ? removed_red : plain_grey;
        uint32_t bits = s->ghost ? 0 : s->cut_bits[s->used[i]]; /* nothing is hatched that is not there */
        memcpy(u->operands[first + i],
               (float[]){c.x, c.y, c.z, c.w, (float)part_index + 1, (float)(bits & ~SURFACE_CUT), bits ? 1 : 0, 0},
               sizeof u->operands[0]);
    }
    return LMN_OK;
}

/* Marks what is taken away from where something else is taken away too. Returns how many there are. */
static size_t find_meetings(upload_solid *s, const product *p)
{
    size_t count = 0;
    for (size_t a = p->kept; a < p->count; a++)
        for (size_t b = p->kept; b < p->count && !s->meets[p->operands[a]]; b++)
            s->meets[p->operands[a]] = a != b && box3_overlap(s->boxes[p->operands[a]], s->boxes[p->operands[b]]);
    for (size_t a = p->kept; a < p->count; a++)
        count += s->meets[p->operands[a]];
    return count;
}

/* Convex operands alone; and, since lists are faster where there are any, few that have to be taken away again and
 * again, and not many times more in products than in the tree. */
static bool suits(upload_solid *s, baker *b, const product_list *own)
{
    enum { MEETINGS_MAX = 64, REPEATED_MAX = 4 };
    size_t together = 0;
    for (size_t i = 0; i < own->count; i++) {
        const product *p = &own->items[i];
        together += p->count;
        for (size_t k = 0; k < p->count; k++)
            if (!is_convex(b, s->form.operands[s->used[p->operands[k]]].mesh))
                return false;
        if (find_meetings(s, p) > MEETINGS_MAX && b->has_lists)
            return false;
    }
    return !b->has_lists || together <= REPEATED_MAX * s->count + MEETINGS_MAX;
}

/* Sorts the products of one branch: where they suit, or among the rest. `numbers`: from the form's operands to the
 * solid's. */
static lmn_status take_branch(upload_solid *s, baker *b, int32_t term_index, const int32_t *numbers, lmn_error *error)
{
    product_list own;
    lmn_status   status = solid_products_create(&own, &s->form, term_index, true, error);
    for (size_t i = 0; i < own.count; i++)
        for (size_t k = 0; k < own.items[i].count; k++)
            own.items[i].operands[k] = numbers[own.items[i].operands[k]];
    bool          convex = !own.too_many && suits(s, b, &own);
    product_list *into = convex ? &s->products : &s->rest;
    s->rest.too_many = s->rest.too_many || own.too_many;
    if (status == LMN_OK &&
        !mem_grow((void **)&into->items, &into->capacity, into->count + own.count, sizeof *own.items))
        status = error_memory(error);
    for (size_t i = 0; i < own.count && status == LMN_OK; i++) {
        for (size_t k = 0; k < own.items[i].count; k++)
            s->in_products[own.items[i].operands[k]] = convex;
        into->items[into->count++] = own.items[i];
        own.items[i] = (product){.operands = NULL};
    }
    solid_products_release(&own);
    s->all_convex = s->all_convex && convex;
    return status;
}

/* Which branches of the tree's union are given by products of convex operands. */
static lmn_status find_products(upload_solid *s, baker *b, lmn_error *error)
{
    int32_t *numbers = mem_alloc((s->form.operand_count + 1) * sizeof *numbers);
    if (!numbers)
        return error_memory(error);
    for (size_t i = 0; i < s->count; i++)
        numbers[s->used[i]] = (int32_t)i;
    const term *root = &s->form.terms[s->form.root];
    lmn_status  status = LMN_OK;
    s->all_convex = true;
    if (root->kind != TERM_OR) {
        status = take_branch(s, b, s->form.root, numbers, error);
    } else {
        for (int32_t c = root->first; c != NONE && status == LMN_OK; c = s->form.terms[c].next)
            status = take_branch(s, b, c, numbers, error);
    }
    mem_free(numbers);
    return status;
}

static void solid_release_upload(upload_solid *s, gpu *g)
{
    gpu_mesh_destroy(g, &s->mesh);
    mem_free(s->planes);
    solid_form_release(&s->form);
    solid_products_release(&s->products);
    solid_products_release(&s->rest);
    mem_free(s->used);
    mem_free(s->cut_bits);
    mem_free(s->runs);
    mem_free(s->boxes);
    mem_free(s->taken_away);
    mem_free(s->in_products);
    mem_free(s->meets);
}

void upload_solids_release(upload *u, gpu *g)
{
    for (size_t i = 0; i < u->solid_count; i++)
        solid_release_upload(&u->solids[i], g);
    mem_free(u->solids);
}

/* The operands' triangles, and what is known of each. */
static lmn_status bake(upload_solid *s, baker *b, lmn_error *error)
{
    csg_program program = {.operands = NULL};
    size_t      capacity = s->count ? s->count : 1;
    s->runs = mem_calloc(capacity, sizeof *s->runs);
    s->boxes = mem_calloc(capacity, sizeof *s->boxes);
    s->taken_away = mem_calloc(capacity, sizeof *s->taken_away);
    s->in_products = mem_calloc(capacity, sizeof *s->in_products);
    s->meets = mem_calloc(capacity, sizeof *s->meets);
    bool good =
        s->runs && s->boxes && s->taken_away && s->in_products && s->meets && csg_program_add(&program, &s->form);
    lmn_status status = good ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < s->count && status == LMN_OK; i++) {
        s->runs[i][0] = (uint32_t)b->index_count;
        s->boxes[i] = s->form.operands[s->used[i]].box;
        s->taken_away[i] = program.taken_away[i];
        status = bake_operand(b, &s->form.operands[s->used[i]], (uint32_t)i + 1, program.taken_away[i], error);
        s->runs[i][1] = (uint32_t)b->index_count - s->runs[i][0];
    }
    csg_program_release(&program);
    return status;
}

static box3 reach_of(const upload_solid *s, const mat4 *world)
{
    box3 reach = box3_empty();
    for (size_t i = 0; i < s->count; i++)
        reach = box3_union(reach, box3_transform(s->boxes[i], world));
    return reach;
}

static lmn_status add_items(upload *u, size_t part_index, size_t solid_index, const mat4 *worlds, size_t count,
                            lmn_error *error)
{
    upload_solid *s = &u->solids[solid_index];
    draw_item     item = {.is_solid = true,
                          .part_index = part_index,
                          .part_id = (uint32_t)part_index + 1,
                          .surface_id = 1,
                          .material = NONE,
                          .solid = solid_index,
                          .operand_count = (uint32_t)s->count,
                          .first_plane = (uint32_t)u->plane_count,
                          .plane_count = (uint32_t)s->plane_count,
                          .mesh = s->mesh};
    lmn_status    status = add_planes(u, s) ? LMN_OK : error_memory(error);
    for (size_t k = 0; k < count && status == LMN_OK; k++) {
        item.world = worlds[k];
        upload_set_past(u, &item, k);
        item.first_operand = (uint32_t)u->program.operand_count;
        item.reach = reach_of(s, &item.world);
        status = add_program(u, s, part_index, error);
        u->triangles += s->triangles;
        if (status == LMN_OK && !upload_add_item(u, &item))
            status = error_memory(error);
    }
    return status;
}

static lmn_status send(upload_solid *s, gpu *g, const baker *b, lmn_error *error)
{
    gpu_mesh_data data = {.vertex_count = (uint32_t)b->vertex_count,
                          .index_count = (uint32_t)b->index_count,
                          .indices = b->indices,
                          .positions = (const float *)b->positions,
                          .normals = (const float *)b->normals,
                          .keys = b->keys};
    s->mesh = gpu_mesh_create(g, &data);
    s->triangles = b->index_count / 3;
    return gpu_check(g, error);
}

/* What the section takes away, and how cut faces are marked. */
static lmn_status cut_solid(upload *u, upload_solid *s, size_t part_index, const mat4 *world, int32_t half_space_mesh,
                            lmn_error *error)
{
    const cut    *c = &u->section.cut;
    bool          spared = u->section.spared && u->section.spared[part_index];
    solid_cutter *cutters = NULL;
    lmn_status    status = solid_form_cut(&s->form, c, spared, world, half_space_mesh, &cutters, error);
    s->cut_bits = mem_calloc(s->form.operand_count + 1, sizeof *s->cut_bits);
    if (status == LMN_OK && !s->cut_bits)
        status = error_memory(error);
    for (size_t k = 0; k < s->form.operand_count && status == LMN_OK; k++)
        if (cutters[k].plane != NONE)
            s->cut_bits[k] = cut_face_bits(c, cutters[k].plane, 0, cutters[k].positive);
    mem_free(cutters);
    return status;
}

static lmn_status make_solid(upload *u, upload_solid *s, gpu *g, const lmn_scene *scene, size_t part_index,
                             const mat4 *world, lmn_error *error)
{
    s->ghost = scene->parts[part_index].ghost;
    primitive half_space;
    baker     b = {.scene = scene,
                   .crease_angle = u->crease_angle,
                   .shapes = u->shapes,
                   .has_lists = gpu_capabilities_of(g)->lists};
    solid_half_space(&b.half_space, &half_space);
    lmn_status status = solid_form_create(&s->form, &scene->solids[s->source], true, error);
    if (status == LMN_OK)
        status = cut_solid(u, s, part_index, world, (int32_t)scene->mesh_count, error);
    s->used = mem_alloc((s->form.operand_count + 1) * sizeof *s->used);
    if (status == LMN_OK && !s->used)
        status = error_memory(error);
    if (status == LMN_OK) {
        s->count = solid_form_used(&s->form, s->used);
        status = bake(s, &b, error);
    }
    if (status == LMN_OK && b.index_count) {
        status = find_products(s, &b, error);
        if (status == LMN_OK)
            status = find_planes(s, &b, plane_capacity(u), error);
        if (status == LMN_OK)
            status = send(s, g, &b, error);
    }
    baker_release(&b);
    return status;
}

/* Takes a solid that has not changed from an earlier upload, unless it would have more or fewer planes here.
 * Sections change it too. */
static bool take_solid(upload *u, upload_solid *s, upload *earlier)
{
    if (!earlier || u->section.cut.cell_count || earlier->section.cut.cell_count)
        return false;
    for (size_t i = 0; i < earlier->solid_count; i++) {
        upload_solid *old = &earlier->solids[i];
        size_t capacity = plane_capacity(u), planes = old->planes_found < capacity ? old->planes_found : capacity;
        if (old->source != s->source || old->revision != s->revision || old->plane_count != planes)
            continue;
        *s = *old;
        memset(old, 0, sizeof *old);
        return true;
    }
    return false;
}

/* Instances that share one solid; with a section, which cuts each elsewhere, there is one only. */
static lmn_status upload_instances(upload *u, gpu *g, const lmn_scene *scene, size_t part_index, upload *earlier,
                                   const mat4 *worlds, size_t count, lmn_error *error)
{
    if (!mem_grow((void **)&u->solids, &u->solid_capacity, u->solid_count + 1, sizeof *u->solids))
        return error_memory(error);
    upload_solid *s = &u->solids[u->solid_count];
    size_t        index = u->solid_count++;
    int32_t       source = scene->nodes[scene->parts[part_index].node].solid;
    memset(s, 0, sizeof *s);
    s->source = source;
    s->revision = scene->solids[source].revision;
    lmn_status status = take_solid(u, s, earlier) ? LMN_OK : make_solid(u, s, g, scene, part_index, &worlds[0], error);
    return status == LMN_OK && s->mesh ? add_items(u, part_index, index, worlds, count, error) : status;
}

lmn_status upload_solid_part(upload *u, gpu *g, size_t part_index, upload *earlier, lmn_error *error)
{
    const lmn_scene *scene = u->pose->scene;
    size_t           count = node_draw_count(&scene->nodes[scene->parts[part_index].node]),
           together = u->section.cut.cell_count ? 1 : count;
    mat4      *worlds = mem_alloc(count * sizeof *worlds);
    lmn_status status = worlds ? LMN_OK : error_memory(error);
    for (size_t k = 0; k < count && status == LMN_OK; k++)
        worlds[k] = pose_instance(u->pose, part_index, k);
    for (size_t first = 0; first < count && status == LMN_OK; first += together)
        status = upload_instances(u, g, scene, part_index, earlier, worlds + first, together, error);
    mem_free(worlds);
    return status;
}

lmn_status upload_solids_close(upload *u, gpu *g, lmn_error *error)
{
    enum { OPERANDS_A_ROW = 512 };
    size_t count = u->program.operand_count, terms = u->program.term_count;
    if (!count)
        return LMN_OK;
    int        rows = (int)((count + OPERANDS_A_ROW - 1) / OPERANDS_A_ROW);
    float     *values = mem_calloc((size_t)rows * OPERANDS_A_ROW, sizeof *u->operands);
    uint32_t  *links = mem_alloc((count + terms) * sizeof *u->program.operands);
    lmn_status status = values && links ? LMN_OK : error_memory(error);
    if (status == LMN_OK) {
        memcpy(values, u->operands, count * sizeof *u->operands);
        u->operand_table = gpu_target_acquire(g, 2 * OPERANDS_A_ROW, rows, GPU_RGBA32F);
        gpu_target_write(g, u->operand_table, (int[]){0, 0, 2 * OPERANDS_A_ROW, rows}, values);
        memcpy(links, u->program.operands, count * sizeof *u->program.operands);
        if (terms)
            memcpy(links + 2 * count, u->program.terms, terms * sizeof *u->program.terms);
        if (gpu_capabilities_of(g)->lists) {
            size_t bytes = (count + terms) * sizeof *u->program.operands;
            u->program_buffer = gpu_buffer_acquire(g, bytes);
            gpu_buffer_write(g, u->program_buffer, links, bytes);
        }
        status = gpu_check(g, error);
    }
    mem_free(values);
    mem_free(links);
    return status;
}
