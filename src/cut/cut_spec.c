/* The words of a cut: "x", "-z=40%", "1,1,0@0,0,5", "box=50%,0%,50%:100%,100%,100%", several separated by ';'. */
#include <math.h>
#include <string.h>

#include "base/text.h"
#include "cut/cut.h"

#define VALUE_MAX 1e18

typedef struct reader {
    const char *at, *end, *spec;
    box3        bounds;
    lmn_error  *error;
} reader;

static const char hint[] =
    "for example x, -z=40%, y=12.5, 1,1,0@0,0,5 or box=50%,0%,50%:100%,100%,100%; several separated by ';'";

static lmn_status wrong(const reader *r, const char *what)
{
    lmn_status status = error_set(r->error, LMN_USAGE, "cut is '%.60s': %s", r->spec, what);
    error_hint(r->error, "%s", hint);
    return status;
}

static void skip_blanks(reader *r)
{
    while (r->at < r->end && *r->at == ' ')
        r->at++;
}

static bool take(reader *r, char wanted)
{
    skip_blanks(r);
    if (r->at >= r->end || *r->at != wanted)
        return false;
    r->at++;
    return true;
}

static bool read_number(reader *r, double *out)
{
    skip_blanks(r);
    const char *start = r->at < r->end && *r->at == '+' ? r->at + 1 : r->at;
    const char *end = text_parse_double(start, r->end, out);
    if (!end || !(fabs(*out) <= VALUE_MAX))
        return false;
    r->at = end;
    return true;
}

/* A number in file units, or a percentage of the bounds along the axis. */
static bool read_position(reader *r, int axis, double *out)
{
    if (!read_number(r, out))
        return false;
    if (take(r, '%')) {
        const float *low = &r->bounds.min.x + axis, *high = &r->bounds.max.x + axis;
        *out = box3_is_empty(r->bounds) ? 0 : *low + ((double)*high - *low) * (*out / 100);
    }
    return true;
}

/* The plane's number, and which of its sides `normal` points to; the same plane is kept once. −1: too many. */
static int find_plane(cut *c, const double normal[3], double offset, bool *positive)
{
    double tolerance = 1e-12 * fmax(1, fabs(offset));
    for (int i = 0; i < c->plane_count; i++)
        for (int sign = 1; sign >= -1; sign -= 2) {
            const cut_plane *p = &c->planes[i];
            double           apart = fabs(p->offset - sign * offset);
            for (int k = 0; k < 3; k++)
                apart = fmax(apart, fabs(p->normal[k] - sign * normal[k]) * fmax(1, fabs(offset)));
            if (apart <= tolerance) {
                *positive = sign > 0;
                return i;
            }
        }
    if (c->plane_count == CUT_PLANES_MAX)
        return -1;
    memcpy(c->planes[c->plane_count].normal, normal, 3 * sizeof(double));
    c->planes[c->plane_count].offset = offset;
    *positive = true;
    return c->plane_count++;
}

/* The cell lies where `normal` points to. */
static bool add_face(cut *c, cut_cell *cell, const double normal[3], double offset)
{
    bool positive;
    int  plane = find_plane(c, normal, offset, &positive);
    if (plane < 0)
        return false;
    cell->faces[cell->count].plane = plane;
    cell->faces[cell->count++].positive = positive;
    return true;
}

static lmn_status read_axis_plane(reader *r, cut *c, cut_cell *cell)
{
    double sign = take(r, '-') ? -1 : 1, position;
    take(r, '+');
    int axis = *r->at++ - 'x';
    if (take(r, '=')) {
        if (!read_position(r, axis, &position))
            return wrong(r, "behind '=' stands a number or a percentage of the bounds");
    } else {
        const float *low = &r->bounds.min.x + axis, *high = &r->bounds.max.x + axis;
        position = box3_is_empty(r->bounds) ? 0 : ((double)*low + *high) / 2;
    }
    double normal[3] = {0, 0, 0};
    normal[axis] = sign;
    return add_face(c, cell, normal, sign * position) ? LMN_OK : wrong(r, "too many planes; 32 are allowed");
}

static lmn_status read_plane(reader *r, cut *c, cut_cell *cell)
{
    static const char form[] = "a plane is x, y or z, signed, with =VALUE or =N%; or NX,NY,NZ@PX,PY,PZ";
    double            n[3], p[3], length;
    for (int k = 0; k < 3; k++)
        if ((k && !take(r, ',')) || !read_number(r, &n[k]))
            return wrong(r, form);
    if (!take(r, '@'))
        return wrong(r, form);
    for (int k = 0; k < 3; k++)
        if ((k && !take(r, ',')) || !read_position(r, k, &p[k]))
            return wrong(r, form);
    length = sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2]);
    if (!(length > 1e-100))
        return wrong(r, "a plane's normal must not be 0,0,0");
    for (int k = 0; k < 3; k++)
        n[k] /= length;
    return add_face(c, cell, n, n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) ? LMN_OK
                                                                         : wrong(r, "too many planes; 32 are allowed");
}

static lmn_status read_box(reader *r, cut *c, cut_cell *cell)
{
    double corners[2][3];
    r->at += strlen("box");
    for (int i = 0; i < 2; i++)
        for (int k = 0; k < 3; k++)
            if (!take(r, k ? ',' : i ? ':' : '=') || !read_position(r, k, &corners[i][k]))
                return wrong(r, "a box is box=X0,Y0,Z0:X1,Y1,Z1, numbers or percentages of the bounds");
    for (int k = 0; k < 3; k++) {
        double low = fmin(corners[0][k], corners[1][k]), high = fmax(corners[0][k], corners[1][k]),
               normal[3] = {0, 0, 0};
        normal[k] = 1;
        bool added = add_face(c, cell, normal, low);
        normal[k] = -1;
        if (!added || !add_face(c, cell, normal, -high))
            return wrong(r, "too many planes; 32 are allowed");
    }
    return LMN_OK;
}

static lmn_status read_cell(reader *r, cut *c)
{
    if (c->cell_count == CUT_CELLS_MAX)
        return wrong(r, "too many planes and boxes; 8 are allowed");
    cut_cell *cell = &c->cells[c->cell_count++];
    skip_blanks(r);
    const char *name = r->at < r->end && (*r->at == '-' || *r->at == '+') ? r->at + 1 : r->at;
    lmn_status  status;
    if (r->end - r->at > 3 && strncmp(r->at, "box", 3) == 0)
        status = read_box(r, c, cell);
    else if (name < r->end && *name >= 'x' && *name <= 'z')
        status = read_axis_plane(r, c, cell);
    else
        status = read_plane(r, c, cell);
    skip_blanks(r);
    if (status == LMN_OK && r->at < r->end && *r->at != ';')
        return wrong(r, "planes and boxes are separated by ';'");
    return status;
}

lmn_status cut_parse(cut *out, const char *spec, box3 bounds, lmn_error *error)
{
    memset(out, 0, sizeof *out);
    reader r = {spec, spec + strlen(spec), spec, bounds, error};
    for (skip_blanks(&r); r.at < r.end; skip_blanks(&r)) {
        lmn_status status = read_cell(&r, out);
        if (status != LMN_OK)
            return status;
        take(&r, ';');
    }
    if (!box3_is_empty(bounds)) {
        double       largest = 0;
        const float *numbers = &bounds.min.x, *high = &bounds.max.x;
        for (int k = 0; k < 3; k++)
            largest = fmax(largest, fmax(fabs((double)numbers[k]), fabs((double)high[k])));
        /* A few steps of a float there: what turning a flat face by its node's matrix may bring. */
        out->snap = 4e-7 * largest;
    }
    return LMN_OK;
}
