/* A solid that is edited from picture to picture: edit_solid FRAMES OUT-PREFIX [LOOK]
 *
 * A ball and a box have the middle in common; three bores cross it. While the frames are drawn one bore moves through
 * the solid from side to side. Writes OUT-PREFIX000.png and so on. Lengths are millimetres, +z is up. */
#include <limner/limner.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

enum { PATH_CAPACITY = 1024 };

/* Axes of the bores; each matrix turns z to one of them, column after column. */
static const double axes[3][16] = {
    {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1},
    {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1},
    {0, 0, -1, 0, 0, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0, 1},
};
static const float brass[4] = {0.85f, 0.64f, 0.25f, 1}, steel[4] = {0.36f, 0.5f, 0.65f, 1},
                   red[4] = {0.65f, 0.24f, 0.25f, 1};

/* (ball ∩ box) − bores. Gives the bore that will move. */
static lmn_status build(lmn_scene *scene, uint32_t *solid, uint32_t *moving, lmn_error *error)
{
    lmn_shape ball = lmn_shape_sphere(30), box = lmn_shape_box(46, 46, 46), bore = lmn_shape_cylinder(70, 11.5, 11.5);
    uint32_t  middle, part, bores[3];
    ball.facets.fn = bore.facets.fn = 96;
    box.centred = bore.centred = true;
    lmn_status status = lmn_scene_add_solid(scene, "widget", LMN_DIFFERENCE, solid, error);
    if (status == LMN_OK)
        status = lmn_solid_add_operation(scene, *solid, LMN_SOLID_ROOT, LMN_INTERSECTION, &middle, error);
    if (status == LMN_OK)
        status = lmn_solid_add_shape(scene, *solid, middle, &ball, &part, error);
    if (status == LMN_OK)
        status = lmn_solid_set_colour(scene, *solid, part, brass, error);
    if (status == LMN_OK)
        status = lmn_solid_add_shape(scene, *solid, middle, &box, &part, error);
    if (status == LMN_OK)
        status = lmn_solid_set_colour(scene, *solid, part, steel, error);
    for (int i = 0; i < 3 && status == LMN_OK; i++) {
        /* The second and third are copies: they share the first one's mesh. */
        status = i == 0 ? lmn_solid_add_shape(scene, *solid, LMN_SOLID_ROOT, &bore, &bores[0], error)
                        : lmn_solid_add_copy(scene, *solid, LMN_SOLID_ROOT, bores[0], &bores[i], error);
        if (status == LMN_OK)
            status = lmn_solid_set_matrix(scene, *solid, bores[i], axes[i], error);
        if (status == LMN_OK)
            status = lmn_solid_set_colour(scene, *solid, bores[i], red, error);
    }
    *moving = bores[0];
    return status;
}

/* The upright bore goes along x, once there and back. */
static lmn_status move(lmn_scene *scene, uint32_t solid, uint32_t bore, double fraction, lmn_error *error)
{
    double matrix[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 26 * sin(6.283185307179586 * fraction), 0, 0, 1};
    return lmn_solid_set_matrix(scene, solid, bore, matrix, error);
}

static lmn_status draw_frames(lmn_scene *scene, lmn_renderer *renderer, const lmn_look *look, int count,
                              const char *prefix, lmn_error *error)
{
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    uint32_t      solid, bore;
    desc.width = desc.height = 512;
    desc.samples = 4;
    lmn_status status = build(scene, &solid, &bore, error);
    for (int i = 0; i < count && status == LMN_OK; i++) {
        char         path[PATH_CAPACITY];
        lmn_drawing *drawing = NULL;
        snprintf(path, sizeof path, "%s%03d.png", prefix, i);
        status = move(scene, solid, bore, (double)i / count, error);
        if (status == LMN_OK)
            status = lmn_draw(&drawing, renderer, scene, look, &desc, error);
        if (status == LMN_OK)
            status = lmn_drawing_write(drawing, path, NULL, NULL, error);
        lmn_drawing_destroy(&drawing);
    }
    return status;
}

int main(int argc, char **argv)
{
    int count = argc > 2 ? atoi(argv[1]) : 0;
    if (count < 1 || count > 1000) {
        fputs("usage: edit_solid FRAMES OUT-PREFIX [LOOK]     (1 to 1000 frames)\n", stderr);
        return 1;
    }
    lmn_error         error = {0};
    lmn_scene        *scene = NULL;
    lmn_renderer     *renderer = NULL;
    lmn_look         *look = NULL;
    lmn_renderer_desc make = LMN_RENDERER_DESC_INIT;
    lmn_status        status = lmn_scene_create(&scene, &error);
    if (status == LMN_OK)
        status = lmn_renderer_create(&renderer, &make, &error);
    if (status == LMN_OK)
        status = lmn_look_load(&look, argc > 3 ? argv[3] : "edges", &error);
    if (status == LMN_OK)
        status = draw_frames(scene, renderer, look, count, argv[2], &error);
    if (status != LMN_OK)
        fprintf(stderr, "edit_solid: %s\n%s\n", error.message, error.hint);
    lmn_look_destroy(&look);
    lmn_renderer_destroy(&renderer);
    lmn_scene_destroy(&scene);
    return status == LMN_OK ? 0 : 1;
}
