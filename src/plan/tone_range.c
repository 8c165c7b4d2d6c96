#include "plan/tone_range.h"

#include <math.h>
#include <string.h>

#include "base/colour.h"
#include "base/memory.h"
#include "base/work.h"
#include "light/light.h"
#include "look/look.h"
#include "plan/lights.h"
#include "surface/surface.h"

enum { SIDE = 96, TRIANGLES_MOST = 60000, INSTANCES_MOST = 64 };

static const double DARKEST = 0.05, MIDDLE = 0.5, LIGHTEST = 0.98; /* of all that is seen; rims are dark */
static const double MIDDLE_TONE = 0.58;
static const double GAIN_MOST = 3, GAMMA_LEAST = 0.6, GAMMA_MOST = 1.7;

/* One cell of a small picture of what is seen. */
typedef struct seen_cell {
    float depth, tone; /* INFINITY: nothing */
} seen_cell;

typedef struct seen_picture {
    const plan *plan;
    seen_cell  *cells;
    double      axes[3][3]; /* right, up, towards the viewer, world axes */
    double      middle[3], scale;
    light_list  lights;
    float       contrast, texture; /* of the part's rule */
    uint32_t    step;              /* triangles of which one counts */
} seen_picture;

/* --- percentiles ---------------------------------------------------------------------------------------- */

static double percentile(const uint32_t counts[TONE_BINS], double total, double fraction)
{
    double before = 0, wanted = total * fraction;
    for (int i = 0; i < TONE_BINS; i++) {
        if (counts[i] && before + counts[i] >= wanted)
            return (i + fmin(fmax((wanted - before) / counts[i], 0), 1)) / TONE_BINS;
        before += counts[i];
    }
    return 1;
}

tone_range tone_range_of(const uint32_t counts[TONE_BINS])
{
    tone_range out = {.low = 0, .gain = 1, .gamma = 1};
    double     total = 0;
    for (int i = 0; i < TONE_BINS; i++)
        total += counts[i];
    if (!(total > 0))
        return out;
    double low = percentile(counts, total, DARKEST), high = percentile(counts, total, LIGHTEST);
    double middle = percentile(counts, total, MIDDLE), gain = 1 / fmax(high - low, 1 / GAIN_MOST);
    low = high - 1 / gain; /* what is all alike is light */
    double fraction = fmin(fmax((middle - low) * gain, 1e-3), 1 - 1e-3);
    out.low = (float)low;
    out.gain = (float)gain;
    out.gamma = (float)fmin(fmax(log(MIDDLE_TONE) / log(fraction), GAMMA_LEAST), GAMMA_MOST);
    return out;
}

/* --- what is seen --------------------------------------------------------------------------------------- */

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static float luminance(const float light[3])
{
    return 0.2126f * light[0] + 0.7152f * light[1] + 0.0722f * light[2];
}

/* What falls on a surface, of its normal in eye space. Lights with a place count as from the model's middle. */
static double light_on(const seen_picture *s, const double normal[3])
{
    double sum = 0;
    for (int i = 0; i < s->lights.count; i++) {
        const float *l = s->lights.positions[i];
        double       towards[3] = {(double)l[0], (double)l[1], (double)l[2]}, length = sqrt(dot3(towards, towards));
        sum += (double)luminance(s->lights.colours[i]) * fmax(dot3(towards, normal) / fmax(length, 1e-30), 0);
    }
    return fmin(sum, 1);
}

static double wrap(double at, wrap_mode how)
{
    double whole = floor(at), fraction = at - whole;
    if (how == WRAP_CLAMP)
        return fmin(fmax(at, 0), 1);
    return how == WRAP_MIRROR && fmod(fabs(whole), 2) > 0.5 ? 1 - fraction : fraction;
}

/* A texel of a picture, linear; white where there is none. */
static void texel_of(const lmn_scene *scene, const texture_use *use, vec2 uv, float out[3])
{
    const image *picture = use->image >= 0 ? &scene->images[use->image] : NULL;
    out[0] = out[1] = out[2] = 1;
    if (!picture || !picture->pixels || !isfinite(uv.x) || !isfinite(uv.y))
        return;
    double c = cos((double)use->rotation), sine = sin((double)use->rotation), x = (double)(uv.x * use->scale[0]),
           y = (double)(uv.y * use->scale[1]);
    double u = wrap((double)use->offset[0] + c * x + sine * y, use->wrap_u),
           v = wrap((double)use->offset[1] - sine * x + c * y, use->wrap_v);
    size_t column = (size_t)fmin(u * picture->width, (double)picture->width - 1),
           row = (size_t)fmin(v * picture->height, (double)picture->height - 1);
    const uint8_t *texel = &picture->pixels[4 * (row * picture->width + column)];
    for (int k = 0; k < 3; k++)
        out[k] = colour_to_linear((float)texel[k] / 255);
}

/* A place on a triangle. */
typedef struct seen_place {
    const primitive *p;
    const uint32_t  *corners;
    double           weights[3];
} seen_place;

static vec2 uv_at(const seen_place *at, const vec2 *uvs)
{
    vec2 out = {0, 0};
    for (int k = 0; k < 3; k++) {
        out.x += (float)at->weights[k] * uvs[at->corners[k]].x;
        out.y += (float)at->weights[k] * uvs[at->corners[k]].y;
    }
    return out;
}

static vec3 colour_at(const seen_place *at)
{
    vec3 out = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        vec4  own = at->p->colours[at->corners[k]];
        float weight = (float)at->weights[k];
        out = (vec3){out.x + weight * own.x, out.y + weight * own.y, out.z + weight * own.z};
    }
    return out;
}

/* The model's own brightness as the eye counts it: surface/halftone/tone.glsl. */
static double brightness_at(const seen_picture *s, const seen_place *at, const material *m)
{
    float colour[3] = {0.6f, 0.6f, 0.6f}, texel[3] = {1, 1, 1};
    if (m) {
        const vec2 *uvs = m->base_texture.image >= 0 ? at->p->uvs[m->base_texture.uv_set == 1 ? 1 : 0] : NULL;
        memcpy(colour, (float[]){m->base_colour.x, m->base_colour.y, m->base_colour.z}, sizeof colour);
        if (uvs)
            texel_of(s->plan->scene, &m->base_texture, uv_at(at, uvs), texel);
    }
    vec3  own = at->p->colours ? colour_at(at) : (vec3){1, 1, 1};
    float all[3] = {colour[0] * texel[0] * own.x, colour[1] * texel[1] * own.y, colour[2] * texel[2] * own.z};
    return pow((double)fminf(fmaxf(luminance(all), 0), 1), 1 / 2.2);
}

static double tone_at(const seen_picture *s, const seen_place *at, double light)
{
    const lmn_scene *scene = s->plan->scene;
    const material  *m = at->p->material >= 0 ? &scene->materials[at->p->material] : NULL;
    double           bent = pow(m && m->unlit ? 1 : light, (double)s->contrast);
    return s->texture > 0 ? bent * (1 - (double)s->texture + (double)s->texture * brightness_at(s, at, m)) : bent;
}

static void put(const seen_picture *s, int x, int y, double depth, const seen_place *at, double light)
{
    if (x < 0 || y < 0 || x >= SIDE || y >= SIDE || !((float)depth < s->cells[y * SIDE + x].depth))
        return;
    s->cells[y * SIDE + x] = (seen_cell){(float)depth, (float)tone_at(s, at, light)};
}

/* `corner`: cells right and up, and the depth. A triangle that has no cell's middle counts in the cell it lies in. */
static void draw_triangle(const seen_picture *s, const primitive *p, const uint32_t *corners, double corner[3][3],
                          double light)
{
    double low[2], high[2], a[2], b[2];
    for (int k = 0; k < 2; k++) {
        low[k] = fmax(ceil(fmin(corner[0][k], fmin(corner[1][k], corner[2][k])) - 0.5), 0);
        high[k] = fmin(floor(fmax(corner[0][k], fmax(corner[1][k], corner[2][k])) - 0.5), SIDE - 1);
        a[k] = corner[1][k] - corner[0][k];
        b[k] = corner[2][k] - corner[0][k];
    }
    double     area = a[0] * b[1] - a[1] * b[0];
    seen_place at = {p, corners, {1.0 / 3, 1.0 / 3, 1.0 / 3}};
    if (low[0] > high[0] || low[1] > high[1] || area == 0) {
        double middle[3];
        for (int k = 0; k < 3; k++)
            middle[k] = (corner[0][k] + corner[1][k] + corner[2][k]) / 3;
        if (fabs(middle[0]) < 2 * SIDE && fabs(middle[1]) < 2 * SIDE)
            put(s, (int)floor(middle[0]), (int)floor(middle[1]), middle[2], &at, light);
        return;
    }
    for (int y = (int)low[1]; y <= (int)high[1]; y++)
        for (int x = (int)low[0]; x <= (int)high[0]; x++) {
            double off[2] = {x + 0.5 - corner[0][0], y + 0.5 - corner[0][1]};
            at.weights[1] = (off[0] * b[1] - off[1] * b[0]) / area;
            at.weights[2] = (a[0] * off[1] - a[1] * off[0]) / area;
            at.weights[0] = 1 - at.weights[1] - at.weights[2];
            if (at.weights[0] >= 0 && at.weights[1] >= 0 && at.weights[2] >= 0)
                put(s, x, y, at.weights[0] * corner[0][2] + at.weights[1] * corner[1][2] + at.weights[2] * corner[2][2],
                    &at, light);
        }
}

/* The mean of its corners' normals where the file has any, towards the viewer. Eye space. */
static bool normal_of(const seen_picture *s, const primitive *p, const mat4 *world, const uint32_t *corners,
                      const double corner[3][3], double out[3])
{
    double a[3], b[3], sum[3] = {0, 0, 0};
    for (int k = 0; k < 3; k++) {
        a[k] = corner[1][k] - corner[0][k];
        b[k] = corner[2][k] - corner[0][k];
    }
    a[2] = -a[2] * s->scale; /* depths are in the model's unit, and grow away from the viewer */
    b[2] = -b[2] * s->scale;
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
    for (int k = 0; k < 3 && p->normals; k++) {
        vec3   n = p->normals[corners[k]];
        double own[3] = {(double)n.x, (double)n.y, (double)n.z}, turned[3];
        for (int row = 0; row < 3; row++)
            turned[row] = world->m[row] * own[0] + world->m[4 + row] * own[1] + world->m[8 + row] * own[2];
        for (int row = 0; row < 3; row++)
            sum[row] += dot3(s->axes[row], turned);
    }
    if (dot3(sum, sum) > 1e-12)
        memcpy(out, sum, sizeof sum);
    double length = sqrt(dot3(out, out)), sign = out[2] < 0 ? -1 : 1;
    for (int k = 0; k < 3; k++)
        out[k] *= sign / fmax(length, 1e-300);
    return length > 0 && isfinite(length);
}

static void draw_primitive(const seen_picture *s, const primitive *p, const mat4 *world)
{
    for (uint32_t i = 0; i + 2 < p->index_count && !work_stopped(); i += 3 * s->step) {
        double corner[3][3], normal[3];
        for (uint32_t k = 0; k < 3; k++) {
            vec3         v = mat4_transform_point(world, p->positions[p->indices[i + k]]);
            const double off[3] = {(double)v.x - s->middle[0], (double)v.y - s->middle[1], (double)v.z - s->middle[2]};
            corner[k][0] = dot3(s->axes[0], off) * s->scale + SIDE / 2.0;
            corner[k][1] = dot3(s->axes[1], off) * s->scale + SIDE / 2.0;
            corner[k][2] = -dot3(s->axes[2], off);
        }
        if (normal_of(s, p, world, &p->indices[i], (const double(*)[3])corner, normal))
            draw_triangle(s, p, &p->indices[i], corner, light_on(s, normal));
    }
}

/* --- the model ------------------------------------------------------------------------------------------ */

/* What a rule makes of a tone: parameters that halftones have. Other surfaces show all of the model's colours. */
static float value_of(const technique_use *surface, const char *key, float otherwise)
{
    const param *p = surface ? kind_find_param(&kind_surface, surface->technique, key) : NULL;
    return p && p->type == PARAM_FLOAT ? *(const float *)param_field(p, surface->values) : otherwise;
}

static bool is_counted(const plan *p, size_t part)
{
    return p->selected[part] && !p->scene->parts[part].ghost &&
           p->scene->nodes[p->scene->parts[part].node].mesh != NONE;
}

static void draw_part(seen_picture *s, size_t part)
{
    const lmn_scene     *scene = s->plan->scene;
    const node          *n = &scene->nodes[scene->parts[part].node];
    const technique_use *surface = plan_rule(s->plan, part) ? rule_use(plan_rule(s->plan, part), KIND_SURFACE) : NULL;
    const mat4           own = scene_world_matrix(scene, scene->parts[part].node);
    s->contrast = value_of(surface, "contrast", 1);
    s->texture = value_of(surface, "texture", 1);
    for (size_t i = 0; i < n->instance_count || i < 1; i++) {
        mat4 world = n->instance_count ? mat4_multiply(&own, &n->instances[i]) : own;
        for (size_t k = 0; k < scene->meshes[n->mesh].primitive_count; k++)
            draw_primitive(s, &scene->meshes[n->mesh].primitives[k], &world);
        if (i + 1 >= INSTANCES_MOST)
            break;
    }
}

static bool place(seen_picture *s, const view_camera *camera)
{
    box3     box = box3_empty();
    uint64_t triangles = 0;
    for (size_t i = 0; i < s->plan->part_count; i++)
        if (is_counted(s->plan, i)) {
            box = box3_union(box, s->plan->scene->parts[i].bounds);
            triangles += s->plan->scene->parts[i].triangles;
        }
    if (box3_is_empty(box) || !(box3_diagonal(box) > 0))
        return false;
    box3_middle(box, s->middle);
    s->scale = SIDE / box3_diagonal(box);
    s->step = (uint32_t)(triangles / TRIANGLES_MOST) + 1;
    for (int row = 0; row < 3; row++)
        for (int k = 0; k < 3; k++)
            s->axes[row][k] = camera->view.m[4 * k + row];
    return true;
}

lmn_status tone_range_find(tone_range *out, const plan *p, const view_camera *camera, lmn_error *error)
{
    const scene_values *v = p->look->wide[KIND_SCENE].values;
    seen_picture        s = {.plan = p};
    uint32_t            counts[TONE_BINS] = {0};
    *out = (tone_range){.low = 0, .gain = 1, .gamma = 1};
    if (v->tone_range != TONE_RANGE_AUTO || !place(&s, camera))
        return LMN_OK;
    s.lights = lights_list(&(light_conditions){p->look, p->pose, &camera->view, NULL});
    s.cells = mem_alloc(SIDE * SIDE * sizeof *s.cells);
    if (!s.cells)
        return error_memory(error);
    for (int i = 0; i < SIDE * SIDE; i++)
        s.cells[i] = (seen_cell){INFINITY, 0};
    for (size_t i = 0; i < p->part_count; i++)
        if (is_counted(p, i))
            draw_part(&s, i);
    for (int i = 0; i < SIDE * SIDE; i++)
        if (s.cells[i].depth < INFINITY)
            counts[(int)fminf(fmaxf(s.cells[i].tone, 0) * TONE_BINS, TONE_BINS - 1)]++;
    *out = tone_range_of(counts);
    out->automatic = true;
    mem_free(s.cells);
    return work_check(error);
}
