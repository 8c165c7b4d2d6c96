#include "plan/lights.h"

#include <math.h>

static void add_light(float positions[][4], float colours[][4], int *count, const double direction[3], double w,
                      const float rgb[3], float strength)
{
    if (*count >= LIGHTS_MAX)
        return;
    double length =
        w > 0 ? 1 : sqrt(direction[0] * direction[0] + direction[1] * direction[1] + direction[2] * direction[2]);
    for (int k = 0; k < 3; k++) {
        positions[*count][k] = (float)(direction[k] / (length > 0 ? length : 1));
        colours[*count][k] = rgb[k] * strength;
    }
    positions[*count][3] = (float)w;
    colours[*count][3] = 1;
    ++*count;
}

static void add_file_lights(const light_conditions *c, float positions[][4], float colours[][4], int *count,
                            float scale)
{
    const lmn_scene *scene = c->pose->scene;
    for (size_t i = 0; i < scene->node_count; i++) {
        if (scene->nodes[i].light < 0)
            continue;
        const light *l = &c->pose->lights[scene->nodes[i].light], *at_rest = &scene->lights[scene->nodes[i].light];
        mat4         eye = mat4_multiply(c->view, &c->pose->worlds[i]);
        /* Lights shine along their node's −Z. Physical units are not used: every light counts as fully bright, and
         * animated ones as bright as they are beside what they are at rest. */
        float  bright = at_rest->intensity > 0 ? l->intensity / at_rest->intensity : l->intensity;
        double back[3] = {eye.m[8], eye.m[9], eye.m[10]}, position[3] = {eye.m[12], eye.m[13], eye.m[14]};
        bool   placed = l->type != LIGHT_DIRECTIONAL;
        add_light(positions, colours, count, placed ? position : back, placed ? 1 : 0, l->colour, scale * bright);
    }
}

/* The direction of the rim light: from behind, and across the page from the key light. A ball seen from far away is lit
 * within 40 degrees of its outline there: atan(1 / RIM_BEHIND). */
#define RIM_BEHIND 1.2

static void rim_direction(const double key[3], double out[3])
{
    double across = hypot(key[0], key[1]);
    out[0] = across > 0 ? -key[0] : 1;
    out[1] = -key[1];
    out[2] = -RIM_BEHIND * (across > 0 ? across : 1);
}

light_list lights_list(const light_conditions *c)
{
    light_list          l = {.rim = -1};
    const scene_values *v = c->look->wide[KIND_SCENE].values;
    if (v->lights == LIGHTS_FILE)
        add_file_lights(c, l.positions, l.colours, &l.count, v->light_scale);
    if (l.count > 0)
        return l;
    static const float white[3] = {1, 1, 1};
    double             key[3] = {v->light_direction.x, v->light_direction.y, v->light_direction.z};
    if (key[0] == 0 && key[1] == 0 && key[2] == 0)
        key[2] = 1;
    /* The light goes with the viewer, but what a mirror shows is lit as the scene itself is. */
    double along = 0;
    for (int k = 0; k < 3 && c->mirror; k++)
        along += key[k] * (double)c->mirror[k];
    for (int k = 0; k < 3 && c->mirror; k++)
        key[k] -= 2 * along * (double)c->mirror[k];
    double fill[3] = {-key[0], -0.3 * key[1], fabs(key[2]) + 0.2};
    add_light(l.positions, l.colours, &l.count, key, 0, white, v->light_scale);
    if (v->fill > 0)
        add_light(l.positions, l.colours, &l.count, fill, 0, white, v->light_scale * v->fill);
    if (v->rim > 0) {
        double rim[3];
        rim_direction(key, rim);
        l.rim = l.count;
        add_light(l.positions, l.colours, &l.count, rim, 0, white, v->light_scale * v->rim);
    }
    return l;
}
