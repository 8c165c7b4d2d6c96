/* Sections of solids: what is cut away is one more thing to take away, so that cut faces come out of the set
 * operations like any other surface. Each half-space is a box with one face in its plane and the others far
 * outside. */
#include "stroke/solid_section.h"

#include <math.h>

#include "base/memory.h"

/* A box from 0 to 1. */
void solid_half_space(mesh *out, primitive *p)
{
    static const vec3     corners[8] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                        {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    static const uint32_t indices[36] = {0, 2, 1, 0, 3, 2, 4, 5, 6, 4, 6, 7, 0, 1, 5, 0, 5, 4,
                                         1, 2, 6, 1, 6, 5, 2, 3, 7, 2, 7, 6, 3, 0, 4, 3, 4, 7};
    *p = (primitive){.vertex_count = 8,
                     .index_count = 36,
                     .positions = (vec3 *)(uintptr_t)corners,
                     .indices = (uint32_t *)(uintptr_t)indices,
                     .material = NONE,
                     .bounds = {{0, 0, 0}, {1, 1, 1}}};
    *out = (mesh){.primitives = p, .primitive_count = 1};
}

/* From the box 0 … 1 to the half-space of a face within `reach` of a point, world axes. */
static mat4 half_space(const cut *c, const cut_face *face, const double middle[3], double reach)
{
    const cut_plane *p = &c->planes[face->plane];
    double           sign = face->positive ? 1 : -1, n[3], u[3], v[3], least = 2, away = -p->offset;
    int              axis = 0;
    for (int k = 0; k < 3; k++) {
        n[k] = p->normal[k] * sign;
        away += p->normal[k] * middle[k];
        if (fabs(n[k]) < least) {
            least = fabs(n[k]);
            axis = k;
        }
    }
    double length = sqrt(1 - n[axis] * n[axis]);
    for (int k = 0; k < 3; k++)
        u[k] = ((k == axis) - n[axis] * n[k]) / length;
    for (int k = 0; k < 3; k++)
        v[k] = n[(k + 1) % 3] * u[(k + 2) % 3] - n[(k + 2) % 3] * u[(k + 1) % 3];
    mat4 m = mat4_identity();
    for (int k = 0; k < 3; k++) {
        m.m[k] = 2 * reach * u[k];
        m.m[4 + k] = 2 * reach * v[k];
        m.m[8 + k] = 2 * reach * n[k];
        m.m[12 + k] = middle[k] - away * p->normal[k] - reach * (u[k] + v[k]);
    }
    return m;
}

static lmn_status take_cell(solid_form *form, const cut *c, const cut_cell *cell, const mat4 *world,
                            const mat4 *inverse, int32_t mesh, lmn_error *error)
{
    static const box3 unit = {{0, 0, 0}, {1, 1, 1}};
    solid_operand     operands[CUT_CELL_FACES_MAX];
    box3              box = box3_transform(form->terms[form->root].box, world);
    const double      low[3] = {(double)box.min.x, (double)box.min.y, (double)box.min.z},
                 high[3] = {(double)box.max.x, (double)box.max.y, (double)box.max.z};
    double middle[3], reach = 0;
    for (int k = 0; k < 3; k++) {
        middle[k] = (low[k] + high[k]) / 2;
        reach += (high[k] - low[k]) * (high[k] - low[k]);
    }
    reach = sqrt(reach);
    for (int32_t i = 0; i < cell->count; i++) {
        mat4 position = half_space(c, &cell->faces[i], middle, reach);
        operands[i] = (solid_operand){.node = NONE, .mesh = mesh, .matrix = mat4_multiply(inverse, &position)};
        operands[i].box = box3_transform(unit, &operands[i].matrix);
    }
    return solid_form_take_away(form, operands, (size_t)cell->count, error);
}

lmn_status solid_form_cut(solid_form *form, const cut *c, bool spared, const mat4 *world, int32_t half_space_mesh,
                          solid_cutter **cutters, lmn_error *error)
{
    const mat4 inverse = mat4_inverse(world);
    size_t     capacity = form->operand_count + CUT_CELLS_MAX * CUT_CELL_FACES_MAX;
    *cutters = mem_alloc(capacity * sizeof **cutters);
    if (!*cutters)
        return error_memory(error);
    for (size_t i = 0; i < capacity; i++)
        (*cutters)[i] = (solid_cutter){NONE, false};
    if (c->cell_count == 0 || form->root == NONE || mat4_is_flat(world))
        return LMN_OK;
    cut_verdict verdict = cut_judge_box(c, box3_transform(form->terms[form->root].box, world));
    if (verdict == CUT_CROSSED && spared)
        verdict = CUT_WHOLE;
    if (verdict == CUT_GONE)
        form->root = NONE;
    lmn_status status = LMN_OK;
    for (int32_t i = 0; i < c->cell_count && verdict == CUT_CROSSED && status == LMN_OK; i++) {
        size_t first = form->operand_count;
        status = take_cell(form, c, &c->cells[i], world, &inverse, half_space_mesh, error);
        for (size_t k = first; k < form->operand_count; k++)
            (*cutters)[k] = (solid_cutter){c->cells[i].faces[k - first].plane, c->cells[i].faces[k - first].positive};
    }
    if (status == LMN_OK)
        solid_form_prune(form);
    return status;
}
