/* Flat signs on the page. */
#include "depict/page.h"

double page_depth_of(const depict_job *j, const double at[3])
{
    const double *v = j->camera.view.m;
    return -(v[2] * at[0] + v[6] * at[1] + v[10] * at[2] + v[14]);
}

bool page_seen_at(const depict_job *j, const double at[3], double out[2])
{
    const double *v = j->camera.view.m, depth = page_depth_of(j, at);
    const double  half = j->camera.orthographic ? j->camera.half_height : depth * tan(j->camera.fov_y / 2);
    for (int k = 0; k < 2; k++)
        out[k] = (v[k] * at[0] + v[4 + k] * at[1] + v[8 + k] * at[2] + v[12 + k]) / half;
    return half > 0;
}

void page_position(const depict_job *j, const double page[2], double depth, double out[3])
{
    const double *v = j->camera.view.m;
    const double  half = j->camera.orthographic ? j->camera.half_height : depth * tan(j->camera.fov_y / 2);
    const double  own[3] = {page[0] * half - v[12], page[1] * half - v[13], -depth - v[14]};
    for (int k = 0; k < 3; k++)
        out[k] = v[4 * k] * own[0] + v[4 * k + 1] * own[1] + v[4 * k + 2] * own[2];
}

double page_height(const depict_job *j, const double at[3])
{
    return 2 * (j->camera.orthographic ? j->camera.half_height : page_depth_of(j, at) * tan(j->camera.fov_y / 2));
}

double page_keep_inside(const depict_job *j, double middle[2], const double half[2])
{
    const double rim = 0.03, limit[2] = {j->camera.aspect - rim, 1 - rim};
    double       moved[2] = {0, 0};
    for (int k = 0; k < 2 && j->fixed_view; k++) {
        const double room = fmax(limit[k] - half[k], 0), wanted = fmin(fmax(middle[k], -room), room);
        moved[k] = wanted - middle[k];
        middle[k] = wanted;
    }
    return hypot(moved[0], moved[1]);
}

void page_place_at(page_place *out, const depict_job *j, const double at[3], double lift)
{
    vector3_copy(out->at, at);
    depict_lift(j, out->at, lift);
    depict_page_axes(j, out->right, out->up);
    const double far = vector3_distance(j->camera.eye, at);
    out->scale = j->camera.orthographic || !(far > 0) ? 1 : vector3_distance(j->camera.eye, out->at) / far;
}

void page_turn(page_place *p, double radians)
{
    double right[3], up[3];
    for (int k = 0; k < 3; k++) {
        right[k] = cos(radians) * p->right[k] + sin(radians) * p->up[k];
        up[k] = cos(radians) * p->up[k] - sin(radians) * p->right[k];
    }
    vector3_copy(p->right, right);
    vector3_copy(p->up, up);
}

void page_point(const page_place *p, double x, double y, double out[3])
{
    vector3_add(out, p->at, x * p->scale, p->right);
    vector3_add(out, out, y * p->scale, p->up);
}

void page_offset(const page_place *p, const double at[3], double out[2])
{
    double d[3];
    vector3_add(d, at, -1, p->at);
    out[0] = vector3_dot(d, p->right) / p->scale;
    out[1] = vector3_dot(d, p->up) / p->scale;
}

void glyph_put_polygon(glyph_mesh *m, const page_place *p, const double (*points)[2], size_t count)
{
    uint32_t middle = glyph_vertex(m, p->at), first = 0, last = 0;
    for (size_t i = 0; i < count; i++) {
        double at[3];
        page_point(p, points[i][0], points[i][1], at);
        uint32_t v = glyph_vertex(m, at);
        if (i > 0)
            glyph_triangle(m, middle, last, v);
        first = i == 0 ? v : first;
        last = v;
    }
    if (count > 2)
        glyph_triangle(m, middle, last, first);
}

enum { SPIKES_MOST = 64, CLOUD_POINTS = 240 };
static const double full_turn = 6.283185307179586;

void glyph_put_star(glyph_mesh *m, const depict_job *j, const expression *e, const page_place *p, uint32_t which,
                    const star *s)
{
    double    points[2 * SPIKES_MOST][2];
    const int spikes = s->spikes < SPIKES_MOST ? s->spikes : SPIKES_MOST;
    for (int i = 0; i < 2 * spikes; i++) {
        const uint32_t what = which * 2 * SPIKES_MOST + (uint32_t)i;
        const double   length = s->radius * s->share *
                              (i % 2 ? 0.46 + 0.12 * depict_random(j, e, what, 0)
                                     : 0.8 + 0.4 * depict_random(j, e, what, 1)),
                     angle = full_turn / (2 * spikes) * (i + 0.5 * (depict_random(j, e, what, 2) - 0.5));
        points[i][0] = length * cos(angle);
        points[i][1] = length * sin(angle);
    }
    glyph_put_polygon(m, p, (const double(*)[2])points, (size_t)(2 * spikes));
}

void glyph_put_cloud(glyph_mesh *m, const page_place *p, double half_width, double half_height, int lobes)
{
    double points[CLOUD_POINTS][2];
    for (int i = 0; i < CLOUD_POINTS; i++) {
        const double turn = full_turn * i / CLOUD_POINTS, lobe = fabs(sin(turn * lobes / 2)),
                     far = 0.9 + 0.17 * sqrt(lobe) * (1 + 0.35 * sin(3 * turn + 1));
        points[i][0] = half_width * far * cos(turn);
        points[i][1] = half_height * far * sin(turn);
    }
    glyph_put_polygon(m, p, (const double(*)[2])points, CLOUD_POINTS);
}
