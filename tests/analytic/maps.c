/* The G-buffer as the AOVs show it, against rays through the pixel centres: depth, normal, id, and what is made of
 * them. */
#include <jansson.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "check.h"
#include "model.h"
#include "trace.h"

static const char four_tap_lines[] = "{\"operator\":\"four-tap\",\"gain\":1,\"width\":2}";
static const char denormal_lines[] = "{\"operator\":\"denormal\",\"gain\":1,\"width\":2}";

/* Judges all three maps. Borders are known to a fraction of a pixel only: a pixel counts as inside when nothing
 * changes around it in either map. */
static void compare(const char *title, const shot *s, const shape *truth, double border, bool ids)
{
    tracer   *t = tracer_create(truth);
    trace_map map;
    size_t    covered = 0, inside = 0, wrong_cover = 0, wrong_id = 0, not_finite = 0;
    double    depth_error = 0, normal_error = 0, length_error = 0;
    trace_map_make(&map, t, s);
    for (int i = 0; i < s->width * s->height; i++) {
        double depth = (double)s->depth[i];
        dvec   normal = dvec_from(s->normal[i]);
        bool   full = !isinf(depth), edge = trace_map_border(&map, i % s->width, i / s->width, border);
        not_finite += isnan(depth) || isnan(normal.x + normal.y + normal.z) || (!full && dvec_length(normal) > 0);
        covered += full;
        if (full)
            length_error = fmax(length_error, fabs(dvec_length(normal) - 1));
        if (edge)
            continue;
        wrong_cover += full != (map.id[i] != 0);
        wrong_id += s->id[i] != (ids ? map.id[i] : map.id[i] != 0);
        if (!full || !map.id[i])
            continue;
        inside++;
        depth_error = fmax(depth_error, fabs(depth - map.depth[i]) / map.depth[i]);
        normal_error = fmax(normal_error, trace_normal_error(t, s, i % s->width, i / s->width, normal));
    }
    check_at_least("maps", (double)inside, 0.5 * (double)covered, "%s: pixels judged, of %zu covered", title, covered);
    check_at_most("maps", (double)wrong_cover, 0, "%s: pixels covered in one only", title);
    check_at_most("P2", (double)not_finite, 0, "%s: NaN pixels, or normals where nothing is", title);
    check_at_most("OI-02", (double)wrong_id, 0, "%s: wrong ids", title);
    check_at_most("P1", depth_error, 1e-4, "%s: relative depth error", title);
    check_at_most("P1", normal_error, 1e-3, "%s: normal error", title);
    check_at_most("OI-07", length_error, 1e-4, "%s: normals that are not unit", title);
    trace_map_release(&map);
    tracer_destroy(t);
}

static const shot_view views[] = {
    {.width = 320, .height = 240, .eye = {4, 3, 5}, .up = {0, 1, 0}},
    {.width = 240, .height = 240, .eye = {-2, 3, -4}, .up = {0, 1, 0}, .orthographic = true},
    {.width = 333, .height = 257, .eye = {1, -2.5, 3.5}, .target = {0.2, 0.1, 0}, .up = {0.2, 1, 0}, .fov_deg = 55},
};

static void smooth_shapes(void)
{
    char title[64];
    for (size_t i = 0; i < 3; i++) {
        shape torus = {0}, hills = {0};
        shot  s;
        shape_torus(&torus, "torus", 1, 0.4, 96, 48);
        shape_terrain(&hills, "terrain", 2, 0.5, 64, 3);
        snprintf(title, sizeof title, "torus %zu", i);
        if (shot_of_shape(&s, &torus, i == 1 ? "torus.glb" : "torus.ply", shot_line_look(NULL), NULL, &views[i]))
            compare(title, &s, &torus, 0.02, true);
        shot_release(&s);
        snprintf(title, sizeof title, "terrain %zu", i);
        if (shot_of_shape(&s, &hills, "terrain.ply", shot_line_look(four_tap_lines), NULL, &views[i]))
            compare(title, &s, &hills, 0.02, true);
        shot_release(&s);
        shape_release(&torus);
        shape_release(&hills);
    }
}

static void parts_and_placements(void)
{
    char title[64];
    for (size_t i = 0; i < 3; i++) {
        shape s3 = {0}, one = {0};
        shot  s;
        shape_box(&s3, "base", dvec_of(-1, -0.6, -0.7), dvec_of(0.7, 0.5, 0.6));
        shape_sphere(&s3, "ball", dvec_of(0, 0, 0), 0.6, 40, 80, true);
        shape_place(&s3, dvec_of(1, 1, 0), 50, dvec_of(0.5, 0.5, 0.4));
        shape_box(&s3, "rod", dvec_of(-0.1, -1.4, -0.1), dvec_of(0.1, 1.4, 0.1));
        shape_place(&s3, dvec_of(0, 0, 1), 20, dvec_of(-0.4, 0, 0.2));
        snprintf(title, sizeof title, "three parts %zu", i);
        if (shot_of_shape(&s, &s3, "parts.glb", shot_line_look(NULL), NULL, &views[i]))
            compare(title, &s, &s3, 0.02, true);
        shot_release(&s);
        shape_box(&one, "base", dvec_of(-1, -0.6, -0.7), dvec_of(0.7, 0.5, 0.6));
        snprintf(title, sizeof title, "STL %zu", i);
        if (shot_of_shape(&s, &one, "box.stl", shot_line_look(NULL), NULL, &views[i]))
            compare(title, &s, &one, 0.02, true);
        shot_release(&s);
        shape_release(&s3);
        shape_release(&one);
    }
}

/* Missing normals are made by the crease angle. */
static void made_normals(void)
{
    static const struct {
        const char *angle;
        double      degrees;
    } angles[] = {{"1", 1}, {"33", 33}, {"37", 37}, {"60", 60}};
    char title[64];
    for (size_t i = 0; i < 4; i++) {
        shape s = {0};
        shot  drawing;
        shape_sphere(&s, "200", dvec_of(0, 0, 0), 1, 11, 10, false);
        shape_box(&s, "box", dvec_of(-0.2, -1.3, -0.2), dvec_of(0.2, 1.3, 0.2));
        const char *changes[] = {"scene.crease_angle", angles[i].angle, NULL};
        snprintf(title, sizeof title, "crease angle %s", angles[i].angle);
        if (shot_of_shape(&drawing, &s, "made.glb", shot_line_look(NULL), changes, &views[0])) {
            shape_make_normals(&s, angles[i].degrees);
            compare(title, &drawing, &s, 0.02, true);
        }
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* A normal map of one slant: its x is the way in which u grows, its y that in which v falls, however the map lies and
 * from whichever side it is seen. */
static void normal_maps_know_their_axes(void)
{
    enum { SIDE = 4 };
    static const uint8_t texel[4] = {208, 160, 218, 255};
    static const double  uvs[][2][2] = {
         {{1, 0}, {0, -1}}, {{0, 1}, {1, 0}}, {{-1, 0}, {0, -1}}, {{0.8, 0.6}, {0.6, -0.8}}};
    static const dvec eyes[] = {{1.5, 1, 4}, {-1, 2, -4}};
    for (size_t i = 0; i < 2 * sizeof uvs / sizeof *uvs; i++) {
        const double(*uv)[2] = uvs[i / 2]; /* of u and v: how they grow to the right and up */
        const shot_view view = {.width = 96, .height = 96, .eye = eyes[i % 2], .up = {0, 1, 0}};
        shape           s = {0};
        shot            drawing;
        double          worst = 0;
        int             judged = 0;
        shape_quad(&s, "wall", 1, 0);
        shape_part *wall = &s.parts[0];
        for (int k = 0; k < 4; k++)
            for (int a = 0; a < 2; a++)
                wall->uvs[k][a] = (float)(0.5 + 0.3 * (uv[a][0] * (double)wall->positions[k][0] +
                                                       uv[a][1] * (double)wall->positions[k][1]));
        wall->texture_size = SIDE;
        wall->normal_map = check_alloc(SIDE * SIDE, 4);
        for (int k = 0; k < SIDE * SIDE; k++)
            memcpy(&wall->normal_map[4 * k], texel, 4);
        const double x = texel[0] / 127.5 - 1, y = texel[1] / 127.5 - 1, z = texel[2] / 127.5 - 1;
        const dvec   slanted = dvec_unit(dvec_of(x * uv[0][0] - y * uv[1][0], x * uv[0][1] - y * uv[1][1], z));
        if (shot_of_shape(&drawing, &s, "slanted.glb", shot_line_look(NULL), NULL, &view)) {
            const dvec wanted = shot_to_eye(&drawing, slanted, 0);
            for (int k = 0; k < drawing.width * drawing.height; k++) {
                if (isinf(drawing.depth[k]))
                    continue;
                const dvec found = dvec_from(drawing.normal[k]);
                judged++;
                worst = fmax(worst, fmin(dvec_length(dvec_sub(found, wanted)), dvec_length(dvec_add(found, wanted))));
            }
        }
        check_at_least("maps", judged, 500, "normal map %zu from %s: pixels", i / 2, i % 2 ? "behind" : "the front");
        check_at_most("maps", worst, 0.01, "  normals off by");
        shot_release(&drawing);
        shape_release(&s);
    }
}

static double normalised(const shot *s, int x, int y)
{
    return ((double)s->depth[y * s->width + x] - s->near_depth) / (s->far_depth - s->near_depth);
}

static void depth_is_linear(void)
{
    for (int parallel = 0; parallel < 2; parallel++) {
        shape     s = {0};
        shot      drawing;
        shot_view view = {.width = 200, .height = 200, .eye = {0, 0, 8}, .up = {0, 1, 0}, .orthographic = parallel};
        double    nearest = INFINITY, farthest = 0;
        shape_quad(&s, "far", 1.5, -1);
        shape_quad(&s, "middle", 0.8, 0);
        shape_quad(&s, "near", 0.3, 1);
        if (shot_of_shape(&drawing, &s, "planes.glb", shot_line_look(NULL), NULL, &view)) {
            check_near("P1", normalised(&drawing, 85, 70), 0.5, 1e-4, "a plane at half of the range");
            for (int i = 0; i < 200 * 200; i++) {
                nearest = fmin(nearest, (double)drawing.depth[i]);
                farthest = isinf(drawing.depth[i]) ? farthest : fmax(farthest, (double)drawing.depth[i]);
            }
            check_near("E05", nearest, 7, 1e-4, "eye depth of the nearest plane");
            check_near("E05", farthest, 9, 1e-4, "eye depth of the farthest plane");
            check_that("E19", drawing.near_depth <= nearest && drawing.far_depth >= farthest,
                       "the clip planes enclose the scene");
            check_at_most("E19", (drawing.far_depth - drawing.near_depth) / (farthest - nearest), 1.01,
                          "and are tight around it");
        }
        shot_release(&drawing);
        shape_release(&s);
    }
}

/* Normals of a finely cut sphere against the closed form, as an angle. */
static void sphere_normals(void)
{
    shape  s = {0};
    shot   drawing;
    double worst = 0;
    shape_sphere(&s, "sphere", dvec_of(0, 0, 0), 1, 128, 256, true);
    if (shot_of_shape(&drawing, &s, "sphere.ply", shot_line_look(NULL), NULL, &views[0]))
        for (int i = 0; i < drawing.width * drawing.height; i++) {
            dvec origin, direction;
            shot_ray(&drawing, i % drawing.width + 0.5, i / drawing.width + 0.5, &origin, &direction);
            double a = dvec_dot(direction, direction), b = dvec_dot(origin, direction),
                   root = b * b - a * (dvec_dot(origin, origin) - 1);
            if (root < 0.05 || isinf(drawing.depth[i]))
                continue;
            dvec   p = dvec_add(origin, dvec_scale(direction, (-b - sqrt(root)) / a));
            double c = dvec_dot(shot_to_eye(&drawing, p, 0), dvec_from(drawing.normal[i]));
            worst = fmax(worst, acos(fmin(c, 1)) * 57.29578);
        }
    check_at_most("E05", worst, 1, "degrees between the sphere's normals and the closed form");
    shot_release(&drawing);
    shape_release(&s);
}

/* Outlines are complete against empty background, and coarse meshes with smooth normals stay free of black areas. */
static void background_and_coarse(void)
{
    shape s = {0};
    shot  drawing;
    int   open = 0, border = 0, black = 0, inside = 0;
    shape_sphere(&s, "200", dvec_of(0, 0, 0), 1, 11, 10, true);
    if (shot_of_shape(&drawing, &s, "coarse.ply", shot_line_look(four_tap_lines), NULL, &views[0]))
        for (int y = 1; y + 1 < drawing.height; y++)
            for (int x = 1; x + 1 < drawing.width; x++) {
                int  i = y * drawing.width + x;
                bool full = !isinf(drawing.depth[i]);
                bool outline =
                    full && (isinf(drawing.depth[i - 1]) || isinf(drawing.depth[i + 1]) ||
                             isinf(drawing.depth[i - drawing.width]) || isinf(drawing.depth[i + drawing.width]));
                border += outline;
                open += outline && drawing.edge[4 * i + 2] > 200;
            }
    check_at_least("P2", border, 100, "pixels along the outline");
    check_at_most("P2", open, 0, "of them without a line (four-tap, combined)");
    shot_release(&drawing);
    if (shot_of_shape(&drawing, &s, "coarse.ply", shot_line_look(denormal_lines), NULL, &views[0]))
        for (int y = 3; y + 3 < drawing.height; y++)
            for (int x = 3; x + 3 < drawing.width; x++) {
                bool deep = true;
                for (int k = 0; k < 49; k++)
                    deep = deep && !isinf(drawing.depth[(y + k / 7 - 3) * drawing.width + x + k % 7 - 3]);
                inside += deep;
                black += deep && shot_ink(&drawing, x, y) <= 127;
            }
    check_at_least("OI-07", inside, 1000, "pixels well inside a sphere of 200 faces");
    check_at_most("OI-07", black, 0, "of them blackened (denormal)");
    shot_release(&drawing);
    shape_release(&s);
}

/* What is captured equals what is drawn directly; the report counts the pixels of each part. */
static void capture_and_report(void)
{
    static const char *const looks[] = {"plain", "gooch", "toon", "edges"};
    shape                    s = {0};
    shot                     with, without;
    shape_box(&s, "base", dvec_of(-1, -0.6, -0.7), dvec_of(0.7, 0.5, 0.6));
    shape_torus(&s, "ring", 0.9, 0.2, 64, 32);
    shape_place(&s, dvec_of(1, 0.4, 0), 70, dvec_of(0.1, 0.2, 0.1));
    for (size_t i = 0; i < 4; i++) {
        shot_view view = views[0];
        if (!shot_of_shape(&with, &s, "capture.glb", looks[i], NULL, &view))
            continue;
        view.without_maps = true;
        if (shot_of_shape(&without, &s, "capture.glb", looks[i], NULL, &view)) {
            size_t differ = 0;
            for (int k = 0; k < with.width * with.height * 4; k++)
                differ += with.picture[k] != without.picture[k];
            check_at_most("E01", (double)differ, 0, "bytes that capturing changes in the look %s", looks[i]);
        }
        shot_release(&without);
        if (i == 0) {
            char wanted[64];
            int  pixels = 0;
            for (int k = 0; k < with.width * with.height; k++)
                pixels += with.id[k] == 2;
            snprintf(wanted, sizeof wanted, "\"pixels\": %d", pixels);
            char *position = strstr(with.report, "\"parts_visible\"");
            check_that("report",
                       position && (strstr(position, wanted) ||
                                    (memmove(wanted + 9, wanted + 10, 20), strstr(position, wanted))),
                       "the report counts %d pixels of the second part", pixels);
        }
        shot_release(&with);
    }
    shape_release(&s);
}

/* All channels come from one geometry pass. */
static void one_pass(void)
{
    shape     s = {0};
    shot      drawing;
    int       passes = 0;
    shot_view view = views[0];
    view.profile = true;
    view.without_maps = true;
    shape_box(&s, "one", dvec_of(-1, -1, -1), dvec_of(0.5, 1, 1));
    shape_box(&s, "two", dvec_of(0.2, -0.5, -0.5), dvec_of(1, 0.5, 0.5));
    if (shot_of_shape(&drawing, &s, "pass.glb", "edges", NULL, &view)) {
        json_t *report = json_loads(drawing.report, 0, NULL), *pass;
        size_t  i;
        json_array_foreach(json_object_get(report, "passes"), i, pass)
        {
            const char *name = json_string_value(json_object_get(pass, "name"));
            passes += name && strstr(name, "geometry") != NULL;
        }
        check_near("OI-03", passes, 1, 0, "geometry passes for normal, depth, id and colour");
        json_decref(report);
    }
    shot_release(&drawing);
    shape_release(&s);
}

int main(int argc, char **argv)
{
    static const check_case cases[] = {
        {"smooth", smooth_shapes},
        {"parts", parts_and_placements},
        {"normals", made_normals},
        {"linear", depth_is_linear},
        {"bumps", normal_maps_know_their_axes},
        {"sphere", sphere_normals},
        {"background", background_and_coarse},
        {"capture", capture_and_report},
        {"pass", one_pass},
    };
    int status = check_main(argc, argv, "maps", cases, sizeof cases / sizeof *cases);
    shot_end();
    return status;
}
