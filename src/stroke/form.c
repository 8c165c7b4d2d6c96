/* Lines that smooth surfaces have besides their outline. Here: suggestive contours (DeCarlo, Finkelstein,
 * Rusinkiewicz, Santella 2003), where the curvature along the view passes from hollow to convex on the way to the
 * eye: from there an outline would come, were the eye a little elsewhere. */
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "stroke/form_view.h"

/* How fast the curvature must grow to be drawn at strength 1, per unit length squared (FORM_UNIT). It goes with the
 * square of the strength, so that a third is a good start. */
#define SUGGESTIVE_LIMIT 24.0

/* What grows counts the more the further it turns away, as it looks foreshortened; not beyond this cosine. */
#define NEAR_OUTLINE 0.1

typedef struct radial {
    double curvature; /* along the view */
    double growth;    /* towards the eye */
} radial;

/* At a knot. The direction of the view turns with the surface, which the second term accounts for. */
static radial radial_at(const form_view *f, uint32_t knot)
{
    const surface_bend *b = &f->s->bends[knot];
    vec3                p = f->m->positions[f->s->vertices[knot]], n = f->s->normals[knot], d = b->direction;
    double3             to = form_direction(f, (double3){p.x, p.y, p.z});
    double              x = to.x * d.x + to.y * d.y + to.z * d.z;
    double y = to.x * ((double)n.y * d.z - (double)n.z * d.y) + to.y * ((double)n.z * d.x - (double)n.x * d.z) +
               to.z * ((double)n.x * d.y - (double)n.y * d.x);
    double square = x * x + y * y;
    if (square < 1e-6)
        return (radial){b->greater, 0};
    double change = b->change[0] * x * x * x + 3 * b->change[1] * x * x * y + 3 * b->change[2] * x * y * y +
                    b->change[3] * y * y * y;
    double torsion = ((double)b->lesser - b->greater) * x * y / square;
    return (radial){(b->greater * x * x + b->lesser * y * y) / square,
                    change / square - 2 * f->facing[knot] * torsion * torsion};
}

static float suggestive_weight(double growth, double facing, double unit, double limit)
{
    float weight = form_fade(growth * unit * unit / fmax(facing, NEAR_OUTLINE), limit);
    return facing > 0 ? weight : fminf(weight, 0);
}

static bool collect_suggestive(form_view *f, double strength)
{
    radial *radials = mem_alloc(((size_t)f->s->knot_count + 1) * sizeof *radials);
    double  unit = FORM_UNIT * f->s->size, limit = SUGGESTIVE_LIMIT * strength * strength;
    bool    good = radials != NULL;
    for (uint32_t i = 0; i < f->s->knot_count && good; i++)
        radials[i] = radial_at(f, i);
    for (uint32_t face = 0; face < f->s->face_count && good; face++) {
        const uint32_t *knots = f->s->corners[face];
        bool            convex[3];
        for (int k = 0; k < 3; k++)
            convex[k] = radials[knots[k]].curvature >= 0;
        int      side = convex[0] == convex[1] && convex[1] == convex[2] ? 0 : form_side(f, face), count = 0;
        form_end ends[2];
        for (uint32_t k = 0; k < 3 && side; k++) {
            uint32_t a = knots[k], b = knots[(k + 1) % 3];
            double   fraction;
            if (convex[k] == convex[(k + 1) % 3])
                continue;
            ends[count] = form_cross(f, 3 * face + k, radials[a].curvature, radials[b].curvature, &fraction);
            double growth = radials[a].growth + fraction * (radials[b].growth - radials[a].growth),
                   facing = f->facing[a] + fraction * (f->facing[b] - f->facing[a]);
            ends[count++].weight = suggestive_weight(side * growth, side * facing, unit, limit);
        }
        good = count < 2 || form_put(f, STROKE_SUGGESTIVE, face, ends[0], ends[1], false);
    }
    mem_free(radials);
    return good;
}

/* --- all ------------------------------------------------------------------------------------------------ */

static bool collect_item(view_lines *out, const stroke_view *v, const stroke_options *w, uint32_t item,
                         const form_surface *s)
{
    form_view f;
    bool      seen, good = form_view_open(&f, out, v, item, s, &seen);
    bool      calm = has_calm_outline(v->scene, v->scene->items[item].mesh);
    if (good && seen && calm && w->contours != CONTOURS_NONE)
        good = calm_collect(&f);
    else if (good && seen && w->contours == CONTOURS_SMOOTH)
        good = smooth_collect(&f);
    if (good && seen && w->suggestive > 0)
        good = collect_suggestive(&f, w->suggestive);
    if (good && seen && w->ridges > 0)
        good = ridges_collect(&f, STROKE_RIDGE, w->ridges);
    if (good && seen && w->valleys > 0)
        good = ridges_collect(&f, STROKE_VALLEY, w->valleys);
    if (good && seen && w->apparent > 0)
        good = ridges_collect(&f, STROKE_APPARENT, w->apparent);
    form_view_close(&f);
    return good;
}

/* Lists of faces do not move any longer: segments learn where theirs begin. */
static void link_ignored(view_lines *out)
{
    const uint32_t *next = out->ignored;
    for (size_t i = 0; i < out->count; i++)
        if (out->segments[i].ignored_count) {
            out->segments[i].ignored = next;
            next += out->segments[i].ignored_count;
        }
}

static bool is_wanted(const stroke_view *v, const bool *parts, size_t mesh)
{
    for (size_t i = 0; i < v->scene->item_count; i++)
        if (v->scene->items[i].mesh == mesh && (!parts || parts[v->scene->items[i].part_index]))
            return true;
    return false;
}

/* All items of a mesh. */
static lmn_status collect_mesh(view_lines *out, const stroke_view *v, const stroke_options *w, const bool *parts,
                               size_t mesh, bool bends, lmn_error *error)
{
    const stroke_scene *scene = v->scene;
    form_surface        own = {0};
    const form_surface *known = scene->surfaces ? &scene->surfaces[mesh] : NULL;
    const form_surface *s = known && known->corners && (known->bends || !bends) ? known : &own;
    lmn_status          status =
        s == known || !is_wanted(v, parts, mesh) ? LMN_OK : form_surface_make(&own, &scene->meshes[mesh], bends, error);
    for (uint32_t i = 0; i < scene->item_count && status == LMN_OK; i++)
        if (scene->items[i].mesh == mesh && (!parts || parts[scene->items[i].part_index]) &&
            !collect_item(out, v, w, i, s))
            status = error_memory(error);
    form_surface_release(&own);
    return status;
}

bool stroke_options_form(const stroke_options *w)
{
    return w->suggestive > 0 || w->ridges > 0 || w->valleys > 0 || w->apparent > 0;
}

bool stroke_options_bend(const stroke_options *w)
{
    return w->contours == CONTOURS_SMOOTH || stroke_options_form(w);
}

lmn_status form_collect(view_lines *out, const stroke_view *v, const stroke_options *options, const bool *parts,
                        lmn_progress_fn progress, void *user, lmn_error *error)
{
    bool       bends = stroke_options_form(options);
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < v->scene->mesh_count && status == LMN_OK; i++) {
        if (v->scene->meshes[i].solid) /* nobody knows how it bends */
            continue;
        if (!stroke_options_bend(options) && !(options->contours != CONTOURS_NONE && has_calm_outline(v->scene, i)))
            continue;
        if (progress && !progress((double)i / (double)v->scene->mesh_count, "finding lines of form", user))
            status = error_set(error, LMN_CANCELLED, "cancelled while lines of form were found");
        else
            status = collect_mesh(out, v, options, parts, i, bends, error);
    }
    if (status == LMN_OK)
        link_ignored(out);
    return status;
}

bool has_calm_outline(const stroke_scene *s, size_t mesh)
{
    return s->surfaces && s->surfaces[mesh].calm_normals;
}

static bool open_surfaces(stroke_scene *s)
{
    if (!s->surfaces)
        s->surfaces = mem_calloc(s->mesh_count + 1, sizeof *s->surfaces);
    return s->surfaces != NULL;
}

lmn_status stroke_scene_calm(stroke_scene *s, lmn_error *error)
{
    lmn_status status = LMN_OK;
    for (size_t i = 0; i < s->mesh_count && status == LMN_OK; i++)
        if (s->meshes[i].sampling.sampled && !s->meshes[i].refinement && !(s->surfaces && s->surfaces[i].corners))
            status = open_surfaces(s) ? form_surface_make(&s->surfaces[i], &s->meshes[i], false, error)
                                      : error_memory(error);
    return status;
}

lmn_status stroke_scene_bend(stroke_scene *s, lmn_progress_fn progress, void *user, lmn_error *error)
{
    lmn_status status = open_surfaces(s) ? LMN_OK : error_memory(error);
    for (size_t i = 0; i < s->mesh_count && status == LMN_OK; i++) {
        if (s->surfaces[i].bends || s->meshes[i].solid)
            continue;
        form_surface_release(&s->surfaces[i]);
        if (progress && !progress((double)i / (double)s->mesh_count, "finding how surfaces bend", user))
            status = error_set(error, LMN_CANCELLED, "cancelled while surfaces were measured");
        else
            status = form_surface_make(&s->surfaces[i], &s->meshes[i], true, error);
    }
    if (status != LMN_OK)
        form_surfaces_destroy(s);
    return status;
}

void form_surfaces_destroy(stroke_scene *s)
{
    for (size_t i = 0; i < s->mesh_count && s->surfaces; i++)
        form_surface_release(&s->surfaces[i]);
    mem_free(s->surfaces);
    s->surfaces = NULL;
}
