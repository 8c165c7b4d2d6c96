#include "solid_edits.h"

#include <math.h>
#include <string.h>

const solid_edit *solid_edits_find(const GArray *edits, uint32_t solid, uint32_t node)
{
    for (guint i = 0; edits && i < edits->len; i++) {
        const solid_edit *e = &g_array_index(edits, solid_edit, i);
        if (e->solid == solid && e->node == node)
            return e;
    }
    return NULL;
}

GArray *solid_edits_with(const GArray *edits, const solid_edit *edit)
{
    GArray *out = g_array_new(FALSE, FALSE, sizeof *edit);
    for (guint i = 0; edits && i < edits->len; i++) {
        const solid_edit *e = &g_array_index(edits, solid_edit, i);
        if (e->solid != edit->solid || e->node != edit->node)
            g_array_append_val(out, *e);
    }
    if (edit->hidden || memcmp(edit->matrix, edit->original, sizeof edit->matrix) != 0)
        g_array_append_val(out, *edit);
    return out;
}

static lmn_status bring(lmn_scene *scene, const solid_edit *node, const double from[16], const double to[16],
                        bool was_hidden, bool hidden, lmn_error *error)
{
    lmn_status     status = LMN_OK;
    lmn_solid_info info;
    if (!lmn_solid_info_of(scene, node->solid, node->node, &info))
        return LMN_OK; /* the file was read again and has no such node any more */
    if (memcmp(from, to, 16 * sizeof *to) != 0)
        status = lmn_solid_set_matrix(scene, node->solid, node->node, to, error);
    if (status == LMN_OK && was_hidden != hidden)
        status = lmn_solid_set_shown(scene, node->solid, node->node, !hidden, error);
    return status;
}

lmn_status solid_edits_apply(lmn_scene *scene, const GArray *applied, const GArray *wanted, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (guint i = 0; applied && i < applied->len && status == LMN_OK; i++) {
        const solid_edit *e = &g_array_index(applied, solid_edit, i);
        if (!solid_edits_find(wanted, e->solid, e->node))
            status = bring(scene, e, e->matrix, e->original, e->hidden, false, error);
    }
    for (guint i = 0; wanted && i < wanted->len && status == LMN_OK; i++) {
        const solid_edit *e = &g_array_index(wanted, solid_edit, i),
                         *before = solid_edits_find(applied, e->solid, e->node);
        status = bring(scene, e, before ? before->matrix : e->original, e->matrix, before && before->hidden, e->hidden,
                       error);
    }
    return status;
}

void matrix_multiply(const double a[16], const double b[16], double out[16])
{
    for (int column = 0; column < 4; column++)
        for (int row = 0; row < 4; row++) {
            double sum = 0;
            for (int k = 0; k < 4; k++)
                sum += a[4 * k + row] * b[4 * column + k];
            out[4 * column + row] = sum;
        }
}

void matrix_move_point(const double m[16], const double p[3], double out[3])
{
    for (int row = 0; row < 3; row++)
        out[row] = m[row] * p[0] + m[4 + row] * p[1] + m[8 + row] * p[2] + m[12 + row];
}

/* Solves m · out = v for the upper left 3 × 3, by Cramer's rule; false when it is flat. */
static bool solve(const double m[16], const double v[3], double out[3])
{
    const double *a = m, *b = m + 4, *c = m + 8;
    double        bc[3], determinant = 0;
    for (int k = 0; k < 3; k++)
        bc[k] = b[(k + 1) % 3] * c[(k + 2) % 3] - b[(k + 2) % 3] * c[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        determinant += a[k] * bc[k];
    if (!(fabs(determinant) > 0))
        return false;
    out[0] = out[1] = out[2] = 0;
    for (int k = 0; k < 3; k++) {
        int i = (k + 1) % 3, j = (k + 2) % 3;
        out[0] += v[k] * bc[k];
        out[1] += v[k] * (c[i] * a[j] - c[j] * a[i]);
        out[2] += v[k] * (a[i] * b[j] - a[j] * b[i]);
    }
    for (int k = 0; k < 3; k++)
        out[k] /= determinant;
    return true;
}

bool matrix_solve_point(const double m[16], const double p[3], double out[3])
{
    const double v[3] = {p[0] - m[12], p[1] - m[13], p[2] - m[14]};
    return solve(m, v, out);
}

void solid_shift(const double matrix[16], const double above[16], const double shift[3], double out[16])
{
    double local[3];
    memcpy(out, matrix, 16 * sizeof *out);
    if (!solve(above, shift, local))
        return;
    for (int k = 0; k < 3; k++)
        out[12 + k] += local[k];
}

void solid_turn(const double matrix[16], const double above[16], const double point[3], int axis, double angle,
                double out[16])
{
    int    i = (axis + 1) % 3, j = (axis + 2) % 3;
    double all[16], turned[16];
    matrix_multiply(above, matrix, all);
    memcpy(turned, all, sizeof turned);
    for (int column = 0; column < 4; column++) {
        double from_i = column == 3 ? point[i] : 0, from_j = column == 3 ? point[j] : 0;
        double u = all[4 * column + i] - from_i, v = all[4 * column + j] - from_j;
        turned[4 * column + i] = u * cos(angle) - v * sin(angle) + from_i;
        turned[4 * column + j] = u * sin(angle) + v * cos(angle) + from_j;
    }
    memcpy(out, matrix, 16 * sizeof *out);
    for (int column = 0; column < 3; column++)
        if (!solve(above, turned + 4 * column, out + 4 * column))
            return;
    matrix_solve_point(above, turned + 12, out + 12);
}
