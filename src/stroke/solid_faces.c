/* A solid's operands as faces in one place, and the edges that they have by themselves. */
#include "stroke/solid_private.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "base/work.h"

/* As in edges.c: a face lies in its neighbour's plane when the corner that they do not share is no farther from it than
 * this fraction of its distance, or of its largest coordinate. */
#define FLAT    1e-6
#define ROUNDED 3e-7

/* --- one operand ---------------------------------------------------------------------------------------- */

typedef struct operand_edge {
    uint32_t low, high, corner; /* corner: 3 · face + number of the corner that it begins at */
} operand_edge;

static int compare_edges(const void *a, const void *b)
{
    const operand_edge *p = a, *q = b;
    if (p->low != q->low)
        return p->low < q->low ? -1 : 1;
    if (p->high != q->high)
        return p->high < q->high ? -1 : 1;
    return (p->corner > q->corner) - (p->corner < q->corner);
}

static int compare_known(const void *a, const void *b)
{
    const mesh_edge *p = a, *q = b;
    for (int k = 0; k < 2; k++)
        if (p->vertex[k] != q->vertex[k])
            return p->vertex[k] < q->vertex[k] ? -1 : 1;
    return 0;
}

/* The edges that the mesh by itself has flags for, by their vertices in ascending order. */
static void sort_known(edge_mesh *own)
{
    for (uint32_t i = 0; i < own->edge_count; i++) {
        uint32_t *v = own->edges[i].vertex;
        if (v[0] > v[1]) {
            uint32_t other = v[0];
            v[0] = v[1];
            v[1] = other;
        }
    }
    if (own->edge_count)
        qsort(own->edges, own->edge_count, sizeof *own->edges, compare_known);
}

static double3 wide(vec3 p)
{
    return (double3){(double)p.x, (double)p.y, (double)p.z};
}

/* How far a face's corner that is not on the edge lies above the other face; 0 in its plane. */
static double height_above(const solid_face *of, const solid_face *free_face, int corner)
{
    double3 free = free_face->p[(corner + 2) % 3], from_edge = double3_minus(free, free_face->p[corner]);
    double  height = double3_dot(from_edge, of->normal),
           rounding = ROUNDED * fmax(fmax(fabs(free.x), fabs(free.y)), fabs(free.z));
    return fabs(height) <= FLAT * double3_length(from_edge) || fabs(height) <= rounding ? 0 : height;
}

static bool put_edge(solid_builder *b, const operand_edge *group, size_t count, const mesh_edge *known)
{
    const solid_face *f = &b->faces[group[0].corner / 3], *g = count == 2 ? &b->faces[group[1].corner / 3] : NULL;
    int               corner = (int)(group[0].corner % 3);
    uint32_t          flags = g && known ? known->flags & (EDGE_CREASE | EDGE_ROUNDED | EDGE_QUIET) : 0;
    if (g) {
        double height = height_above(g, f, corner) == 0 ? 0 : height_above(f, g, (int)(group[1].corner % 3));
        if (height == 0 && !flags && double3_dot(f->normal, g->normal) > 0)
            return true;
    }
    for (size_t i = 0; i < count; i++)
        b->lined[group[i].corner / 3] |= (uint8_t)(1u << group[i].corner % 3);
    if (!mem_grow((void **)&b->candidates, &b->candidate_capacity, b->candidate_count + 1, sizeof *b->candidates))
        return false;
    const uint32_t *v = b->mesh->faces[group[0].corner / 3];
    b->candidates[b->candidate_count++] =
        (solid_candidate){{f->p[corner], f->p[(corner + 1) % 3]},
                          {group[0].corner / 3, g ? group[1].corner / 3 : EDGE_NO_FACE},
                          flags,
                          g && known ? known->turn : 0,
                          {v[corner], v[(corner + 1) % 3]}};
    return true;
}

/* --- is it closed? --- */

/* Edges with an odd number of faces, as their faces run along them. */
typedef struct odd_edges {
    double3 (*ends)[2];
    size_t count, capacity;
} odd_edges;

/* So many are looked at: a mesh with more is open. */
enum { ODD_MOST = 4000 };

static bool put_odd(odd_edges *odd, const solid_builder *b, const operand_edge *group, size_t count)
{
    int     upwards = 0; /* faces that pass it from its lower vertex on, less the others */
    double3 ends[2];
    for (size_t i = 0; i < count; i++) {
        int               corner = (int)(group[i].corner % 3);
        const solid_face *f = &b->faces[group[i].corner / 3];
        const uint32_t   *v = b->mesh->faces[group[i].corner / 3];
        bool              up = v[corner] == group[i].low;
        upwards += up ? 1 : -1;
        ends[!up] = f->p[corner];
        ends[up] = f->p[(corner + 1) % 3];
    }
    if (!mem_grow((void **)&odd->ends, &odd->capacity, odd->count + 1, sizeof *odd->ends))
        return false;
    odd->ends[odd->count][0] = ends[upwards < 0];
    odd->ends[odd->count++][1] = ends[upwards > 0];
    return true;
}

/* How an edge runs past a position: 1, −1 the other way round, 0 not at all. */
static int runs_past(const double3 ends[2], double3 at, double3 along, double near)
{
    double3 way = double3_minus(ends[1], ends[0]), r = double3_minus(at, ends[0]);
    double  length = double3_length(way), share = length > 0 ? double3_dot(r, way) / (length * length) : -1;
    if (share <= 0 || share >= 1 || double3_length(double3_plus(r, way, -share)) > near)
        return 0;
    return double3_dot(way, along) > 0 ? 1 : -1;
}

/* Faces without area were left out: what they joined lies on each other all the same. An edge is open where those that
 * run past its middle do not cancel. */
static bool has_open(const odd_edges *odd, double near)
{
    if (odd->count > ODD_MOST)
        return true;
    for (size_t i = 0; i < odd->count; i++) {
        const double3 *e = odd->ends[i];
        double3        along = double3_minus(e[1], e[0]), middle = double3_plus(e[0], along, 0.4871);
        int            sum = 0;
        for (size_t k = 0; k < odd->count; k++)
            sum += runs_past(odd->ends[k], middle, along, near);
        if (sum != 0)
            return true;
    }
    return false;
}

/* All edges of an operand that are not flat. Closed is what has two faces at each that pass it in opposite directions.
 */
static bool take_edges(solid_builder *b, solid_part *part, const edge_mesh *own, uint32_t first_vertex)
{
    size_t        count = 3 * (size_t)part->face_count, known = 0;
    odd_edges     odd = {NULL};
    operand_edge *edges = mem_alloc((count + 1) * sizeof *edges);
    for (size_t i = 0; i < count && edges; i++) {
        size_t          corner = 3 * (size_t)part->first_face + i;
        const uint32_t *v = b->mesh->faces[corner / 3];
        uint32_t        p = v[corner % 3], q = v[(corner + 1) % 3];
        edges[i] = (operand_edge){p < q ? p : q, p < q ? q : p, (uint32_t)corner};
    }
    if (edges)
        qsort(edges, count, sizeof *edges, compare_edges);
    bool good = edges != NULL;
    for (size_t i = 0, end; i < count && good; i = end) {
        for (end = i; end < count && edges[end].low == edges[i].low && edges[end].high == edges[i].high;)
            end++;
        mesh_edge key = {.vertex = {edges[i].low - first_vertex, edges[i].high - first_vertex}};
        while (known < own->edge_count && compare_known(&own->edges[known], &key) < 0)
            known++;
        bool is_known = known < own->edge_count && compare_known(&own->edges[known], &key) == 0;
        bool pairs =
            end - i == 2 && (b->mesh->faces[edges[i].corner / 3][edges[i].corner % 3] == edges[i].low) !=
                                (b->mesh->faces[edges[i + 1].corner / 3][edges[i + 1].corner % 3] == edges[i].low);
        good = (end - i) % 2 == 0 || put_odd(&odd, b, &edges[i], end - i);
        part->crossed = part->crossed || !pairs; /* what is inside is asked of a ray */
        good = good && put_edge(b, edges + i, end - i, is_known ? &own->edges[known] : NULL);
    }
    part->open = good && has_open(&odd, 2 * b->near);
    mem_free(odd.ends);
    mem_free(edges);
    return good;
}

/* Is there more outside than inside, by the volume that faces close off? */
static bool is_inside_out(const edge_mesh *m)
{
    double sum = 0;
    for (uint32_t f = 0; f < m->face_count; f++) {
        double3 o = wide(m->positions[m->faces[0][0]]), p = double3_minus(wide(m->positions[m->faces[f][0]]), o),
                q = double3_minus(wide(m->positions[m->faces[f][1]]), o),
                r = double3_minus(wide(m->positions[m->faces[f][2]]), o);
        sum += double3_dot(p, double3_cross(q, r));
    }
    return sum < 0;
}

static box3 widened(box3 box, double by)
{
    float margin = (float)by;
    return (box3){{box.min.x - margin, box.min.y - margin, box.min.z - margin},
                  {box.max.x + margin, box.max.y + margin, box.max.z + margin}};
}

static bool make_room(solid_builder *b, const edge_mesh *own)
{
    edge_mesh *m = b->mesh;
    size_t     vertices = (size_t)m->vertex_count + own->vertex_count, faces = (size_t)m->face_count + own->face_count;
    size_t     normals = b->face_capacity, solid_faces = b->face_capacity, planes = b->face_capacity,
           boxes = b->face_capacity, lined = b->face_capacity, operands = b->face_capacity,
           materials = b->face_capacity;
    return mem_grow((void **)&m->positions, &b->vertex_capacity, vertices, sizeof *m->positions) &&
           mem_grow((void **)&m->normals, &normals, faces, sizeof *m->normals) &&
           mem_grow((void **)&m->materials, &materials, faces, sizeof *m->materials) &&
           mem_grow((void **)&b->faces, &solid_faces, faces, sizeof *b->faces) &&
           mem_grow((void **)&b->boxes, &boxes, faces, sizeof *b->boxes) &&
           mem_grow((void **)&b->lined, &lined, faces, sizeof *b->lined) &&
           mem_grow((void **)&b->solid->operands, &operands, faces, sizeof *b->solid->operands) &&
           mem_grow((void **)&b->solid->planes, &planes, faces, sizeof *b->solid->planes) &&
           mem_grow((void **)&m->faces, &b->face_capacity, faces, sizeof *m->faces);
}

static double longest_side(const solid_face *f)
{
    double longest = 0;
    for (int k = 0; k < 3; k++)
        longest = fmax(longest, double3_length(double3_minus(f->p[(k + 1) % 3], f->p[k])));
    return longest;
}

/* Faces turned so that they look out of the solid: outwards, of what is taken away inwards. */
static void put_faces(solid_builder *b, const edge_mesh *own, uint32_t number, bool flips)
{
    edge_mesh  *m = b->mesh;
    solid_part *part = &b->parts[number];
    part->first_face = m->face_count;
    part->face_count = own->face_count;
    part->box = box3_empty();
    memcpy(m->positions + m->vertex_count, own->positions, own->vertex_count * sizeof *own->positions);
    for (uint32_t f = 0; f < own->face_count; f++) {
        uint32_t    at = m->face_count++;
        solid_face *face = &b->faces[at];
        box3        box = box3_empty();
        for (int k = 0; k < 3; k++) {
            uint32_t vertex = own->faces[f][flips ? 2 - k : k];
            m->faces[at][k] = m->vertex_count + vertex;
            face->p[k] = wide(own->positions[vertex]);
            box = box3_with_point(box, own->positions[vertex]);
        }
        double3 n = double3_cross(double3_minus(face->p[1], face->p[0]), double3_minus(face->p[2], face->p[0]));
        double  length = double3_length(n);
        face->normal = length > 0 ? (double3){n.x / length, n.y / length, n.z / length} : (double3){0, 0, 0};
        m->normals[at] = (vec3){(float)face->normal.x, (float)face->normal.y, (float)face->normal.z};
        b->boxes[at] = widened(box, b->near);
        b->lined[at] = length <= 2 * b->near * longest_side(face) ? SOLID_THIN : 0;
        b->solid->operands[at] = number;
        b->solid->planes[at] = 0;
        part->box = box3_union(part->box, b->boxes[at]);
    }
    m->vertex_count += own->vertex_count;
}

/* --- all ------------------------------------------------------------------------------------------------ */

static vec3 *place(const mesh *m, const mat4 *matrix)
{
    size_t count = 0, at = 0;
    for (size_t i = 0; i < m->primitive_count; i++)
        count += m->primitives[i].vertex_count;
    vec3 *out = mem_alloc((count + 1) * sizeof *out);
    for (size_t i = 0; i < m->primitive_count && out; i++)
        for (uint32_t k = 0; k < m->primitives[i].vertex_count; k++)
            out[at++] = mat4_transform_point(matrix, m->primitives[i].positions[k]);
    return out;
}

/* Operands of one colour have one material; cut faces have their own. */
static int32_t material_of(const solid_builder *b, const solid_form *form, const int32_t *used, size_t number)
{
    const solid_operand *own = &form->operands[used[number]];
    if (b->caps[number] != NONE)
        return EDGE_CAP_MATERIAL(b->caps[number]);
    for (size_t i = 0; i < number; i++) {
        const solid_operand *o = &form->operands[used[i]];
        if (b->caps[i] == NONE && o->has_colour == own->has_colour &&
            (!own->has_colour || memcmp(&o->colour, &own->colour, sizeof own->colour) == 0))
            return (int32_t)i;
    }
    return (int32_t)number;
}

static lmn_status load_operand(solid_builder *b, const mesh *m, const solid_operand *o, uint32_t number,
                               int32_t material, lmn_error *error)
{
    vec3      *positions = place(m, &o->matrix);
    edge_mesh  own = {0};
    lmn_status status = positions ? edge_mesh_create_whole(&own, m, positions, b->crease, error) : error_memory(error);
    mem_free(positions);
    if (status != LMN_OK)
        return status;
    solid_part *part = &b->parts[number];
    uint32_t    first_vertex = b->mesh->vertex_count, first_face = b->mesh->face_count;
    part->taken_away = b->solid->program.taken_away[number];
    if ((uint64_t)first_face + own.face_count >= UINT32_MAX / 8)
        status =
            error_set(error, LMN_LIMIT, "a solid has more than %u triangles, too many for strokes", UINT32_MAX / 8);
    else if (!make_room(b, &own))
        status = error_memory(error);
    if (status == LMN_OK) {
        put_faces(b, &own, number, is_inside_out(&own) != part->taken_away);
        for (uint32_t f = first_face; f < b->mesh->face_count; f++)
            b->mesh->materials[f] = material;
        sort_known(&own);
        status = take_edges(b, part, &own, first_vertex) ? LMN_OK : error_memory(error);
        b->solid->open_operands += part->open;
    }
    edge_mesh_release(&own);
    return status;
}

/* Would the operand bound the solid if no other one were there? */
static bool find_alone(solid_builder *b, size_t count)
{
    solid_state s;
    bool        good = solid_state_open(&s, &b->solid->program);
    for (uint32_t i = 0; i < count && good; i++) {
        solid_state_pass(&s, i);
        b->parts[i].alone = s.value;
        solid_state_pass(&s, i);
    }
    solid_state_release(&s);
    return good;
}

typedef struct meet_search {
    solid_builder *b;
    uint32_t (*pairs)[2];
    size_t count, capacity;
    bool   failed;
} meet_search;

static bool put_meeting(void *user, uint32_t a, uint32_t b)
{
    meet_search *s = user;
    s->failed = !mem_grow((void **)&s->pairs, &s->capacity, s->count + 1, sizeof *s->pairs);
    if (s->failed)
        return false;
    s->pairs[s->count][0] = a;
    s->pairs[s->count++][1] = b;
    s->b->parts[a].meet_count++;
    s->b->parts[b].meet_count++;
    return true;
}

/* Which operands are near which: their boxes meet. */
static lmn_status find_meetings(solid_builder *b, uint32_t count, lmn_error *error)
{
    meet_search s = {.b = b};
    hierarchy   tree = {NULL};
    box3       *boxes = mem_alloc(((size_t)count + 1) * sizeof *boxes);
    lmn_status  status = boxes ? LMN_OK : error_memory(error);
    size_t      at = 0;
    for (uint32_t i = 0; i < count && boxes; i++)
        boxes[i] = b->parts[i].box;
    if (status == LMN_OK)
        status = hierarchy_build(&tree, boxes, (hierarchy_kin){{NULL}}, count, error);
    if (status == LMN_OK)
        hierarchy_pairs(&tree, boxes, (hierarchy_kin){{NULL}}, put_meeting, &s);
    b->meets = s.failed ? NULL : mem_alloc((2 * s.count + 1) * sizeof *b->meets);
    for (uint32_t i = 0; i < count && b->meets; i++) {
        b->parts[i].first_meet = at;
        at += b->parts[i].meet_count;
        b->parts[i].meet_count = 0;
    }
    for (size_t i = 0; i < s.count && b->meets; i++)
        for (int k = 0; k < 2; k++) {
            solid_part *part = &b->parts[s.pairs[i][k]];
            b->meets[part->first_meet + part->meet_count++] = s.pairs[i][1 - k];
        }
    hierarchy_release(&tree);
    mem_free(boxes);
    mem_free(s.pairs);
    return status == LMN_OK && !b->meets ? error_memory(error) : status;
}

lmn_status solid_load(solid_builder *b, const lmn_scene *scene, const solid_form *form, const int32_t *used,
                      size_t count, lmn_error *error)
{
    mesh      half_space;
    primitive box;
    solid_half_space(&half_space, &box);
    b->parts = mem_calloc(count + 1, sizeof *b->parts);
    lmn_status status = b->parts && csg_program_add(&b->solid->program, form) ? LMN_OK : error_memory(error);
    for (uint32_t i = 0; i < count && status == LMN_OK; i++) {
        const solid_operand *o = &form->operands[used[i]];
        const mesh          *m = (size_t)o->mesh < scene->mesh_count ? &scene->meshes[o->mesh] : &half_space;
        status = work_stopped() ? error_memory(error) : load_operand(b, m, o, i, material_of(b, form, used, i), error);
    }
    if (status == LMN_OK && !find_alone(b, count))
        status = error_memory(error);
    return status == LMN_OK ? find_meetings(b, (uint32_t)count, error) : status;
}
