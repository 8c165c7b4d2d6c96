/* Three balls that bounce, told in one still: bouncing_balls OUT.png
 * Prints where they meet the ground. */
#include <limner/limner.h>
#include <math.h>
#include <stdio.h>

enum { RINGS = 16, SIDES = 32, BALLS = 3 };

/* A ball, as rings of vertices from pole to pole. */
static lmn_status add_ball(lmn_scene *scene, double radius, const float colour[3], uint32_t *mesh, lmn_error *error)
{
    static float    positions[(RINGS + 1) * SIDES * 3];
    static uint32_t indices[RINGS * SIDES * 6];
    const double    pi = acos(-1);
    for (int ring = 0; ring <= RINGS; ring++)
        for (int side = 0; side < SIDES; side++) {
            double up = pi * ring / RINGS, around = 2 * pi * side / SIDES;
            float *at = positions + 3 * (ring * SIDES + side);
            at[0] = (float)(radius * sin(up) * cos(around));
            at[1] = (float)(radius * cos(up));
            at[2] = (float)(radius * sin(up) * sin(around));
        }
    for (uint32_t ring = 0; ring < RINGS; ring++)
        for (uint32_t side = 0; side < SIDES; side++) {
            uint32_t       next = (side + 1) % SIDES, a = ring * SIDES, b = a + SIDES;
            const uint32_t two[] = {a + side, a + next, b + next, a + side, b + next, b + side};
            for (int k = 0; k < 6; k++)
                indices[6 * (ring * SIDES + side) + (uint32_t)k] = two[k];
        }
    lmn_material_desc material = LMN_MATERIAL_DESC_INIT;
    lmn_mesh_desc     desc = LMN_MESH_DESC_INIT;
    for (int k = 0; k < 3; k++)
        material.colour[k] = colour[k];
    lmn_status status = lmn_scene_add_material(scene, &material, &desc.material, error);
    desc.positions = positions;
    desc.vertex_count = (RINGS + 1) * SIDES;
    desc.indices = indices;
    desc.index_count = RINGS * SIDES * 6;
    return status == LMN_OK ? lmn_scene_add_mesh(scene, &desc, mesh, error) : status;
}

static lmn_status add_ground(lmn_scene *scene, lmn_error *error)
{
    static const float    corners[] = {-1, 0, -3, 7, 0, -3, 7, 0, 3, -1, 0, 3};
    static const uint32_t triangles[] = {0, 2, 1, 0, 3, 2};
    lmn_mesh_desc         mesh = LMN_MESH_DESC_INIT;
    lmn_node_desc         node = LMN_NODE_DESC_INIT;
    mesh.positions = corners;
    mesh.vertex_count = 4;
    mesh.indices = triangles;
    mesh.index_count = 6;
    node.name = "ground";
    lmn_status status = lmn_scene_add_mesh(scene, &mesh, &node.mesh, error);
    return status == LMN_OK ? lmn_scene_add_node(scene, &node, NULL, error) : status;
}

/* A ball and its way down: under gravity, thrown back by the ground. */
static lmn_status add_falling(lmn_scene *scene, int which, uint32_t *node, uint32_t *fall, lmn_error *error)
{
    static const char *const names[BALLS] = {"green", "red", "blue"};
    static const float       colours[BALLS][3] = {{0.24f, 0.55f, 0.29f}, {0.78f, 0.25f, 0.18f}, {0.23f, 0.38f, 0.71f}};
    lmn_node_desc            ball = LMN_NODE_DESC_INIT;
    lmn_constraint_desc      bounce = LMN_CONSTRAINT_DESC_INIT;
    ball.name = names[which];
    ball.matrix[13] = 4 - which; /* up */
    ball.matrix[14] = 2 * (which - 1);
    lmn_status status = add_ball(scene, 0.5, colours[which], &ball.mesh, error);
    if (status == LMN_OK)
        status = lmn_scene_add_node(scene, &ball, node, error);
    bounce.name = names[which];
    bounce.node = *node;
    bounce.map = LMN_TIME_MAP_BOUNCE;
    bounce.floor_height = 0.5; /* of the ball's middle */
    bounce.velocity[0] = 2;
    bounce.duration_s = 2.2;
    return status == LMN_OK ? lmn_behaviour_add_constraint(scene, &bounce, fall, error) : status;
}

/* One ball after the other, half a second apart. */
static lmn_status fill(lmn_scene *scene, uint32_t *balls, lmn_error *error)
{
    lmn_activity_child rows[BALLS] = {{0, 0, 0}};
    lmn_activity_desc  table = LMN_ACTIVITY_DESC_INIT;
    uint32_t           whole = 0;
    lmn_status         status = add_ground(scene, error);
    for (int i = 0; i < BALLS && status == LMN_OK; i++) {
        status = add_falling(scene, i, &balls[i], &rows[i].activity, error);
        rows[i].start_s = 0.5 * i;
    }
    table.kind = LMN_ACTIVITY_TABLE;
    table.children = rows;
    table.child_count = BALLS;
    if (status == LMN_OK)
        status = lmn_behaviour_add(scene, &table, &whole, error);
    return status == LMN_OK ? lmn_behaviour_play(scene, &whole, 1, error) : status;
}

static lmn_status tell(const lmn_scene *scene, const uint32_t *balls, lmn_error *error)
{
    lmn_dynamics *dynamics = NULL;
    lmn_status    status = lmn_dynamics_create(scene, NULL, &dynamics, error);
    for (int i = 0; i < BALLS && status == LMN_OK; i++) {
        lmn_contact first;
        size_t      count = 0;
        status = lmn_dynamics_contacts(dynamics, balls[i], 0, 4, 1, &first, 1, &count, error);
        if (status == LMN_OK && count > 0)
            printf("ball %d meets node %u at %.3f s, x %.3f\n", i + 1, (unsigned)first.other, first.time_s,
                   first.place[0]);
    }
    lmn_dynamics_destroy(&dynamics);
    return status;
}

int main(int count, char **arguments)
{
    lmn_error     error = {0};
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_renderer *renderer = NULL;
    lmn_drawing  *drawing = NULL;
    uint32_t      balls[BALLS] = {0};
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = 640, desc.height = 400;
    desc.time_s = 1.4; /* what was before is past, what comes is dashed */
    lmn_status status = count == 2 ? lmn_scene_create(&scene, &error) : LMN_USAGE;
    if (status == LMN_OK && (status = fill(scene, balls, &error)) == LMN_OK)
        status = tell(scene, balls, &error);
    if (status == LMN_OK && (status = lmn_depict(scene, &desc, NULL, NULL, &error)) == LMN_OK)
        status = lmn_look_load(&look, "storyboard", &error);
    if (status == LMN_OK && (status = lmn_renderer_create(&renderer, NULL, &error)) == LMN_OK)
        status = lmn_draw(&drawing, renderer, scene, look, &desc, &error);
    if (status == LMN_OK)
        status = lmn_drawing_write(drawing, arguments[1], NULL, NULL, &error);
    if (status != LMN_OK)
        fprintf(stderr, "%s %s\n%s\n", error.file, error.message, error.hint);
    lmn_drawing_destroy(&drawing);
    lmn_renderer_destroy(&renderer);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    return status != LMN_OK;
}
