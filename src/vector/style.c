/* Looks as strokes. Looks whose lines are found in pictures say how wide they are, in which colours, and how those behind are drawn; that is taken over, and strokes answer where lines are. */
#include <math.h>
#include <string.h>

#include "compose/compose.h"
#include "vector/vector_private.h"
#include "finish/finish.h"
#include "layer/layer.h"
#include "lines/lines.h"
#include "lines/stroke/strokes.h"
#include "surface/marks.h"
#include "surface/surface.h"

/* What a picture's lines do not say. */
static const float inner_share = 0.75f;  /* width of creases beside outlines, as draughtsmen have it */
static const float hidden_apart = 3;     /* hidden lines nearer than this turn into grey, pixels */
static const float hidden_share = 0.6f;  /* width of hidden lines that have none of their own */
static const float sway_share = 0.4f;    /* of a sketch's amount; most places move by much less than the most */
enum { FILL_SAMPLES = 9973 };            /* of a texture, for its mean; a prime, so that they do not fall on columns */
static const float taper_share = 8;      /* how many widths a sketched line takes to thin out */

static float number_of(const technique_use *use, kind_id id, const char *key, float fallback)
{
    const param *p = use ? kind_find_param(kinds[id], use->technique, key) : NULL;
    if (!p || p->type != PARAM_FLOAT || param_is_auto(p, use->values))
        return fallback;
    float value;
    memcpy(&value, param_field(p, use->values), sizeof value);
    return value;
}

static int32_t whole_of(const technique_use *use, kind_id id, const char *key, int32_t fallback)
{
    const param *p = use ? kind_find_param(kinds[id], use->technique, key) : NULL;
    if (!p || p->type != PARAM_INT)
        return fallback;
    int32_t value;
    memcpy(&value, param_field(p, use->values), sizeof value);
    return value;
}

static colour or_else(colour c, colour otherwise)
{
    return isnan(c.r) ? otherwise : c;
}

static bool is_class_inner(int kind)
{
    return kind != STROKE_CONTOUR && kind != STROKE_BORDER;
}

static void take_lines(stroke_wishes *wishes, stroke_style *style, const lines_common *lines)
{
    colour inner = or_else(lines->inner_colour, lines->colour);
    for (int i = 0; i < STROKE_CLASS_COUNT; i++)
        style->colours[i] = is_class_inner(i) ? inner : lines->colour;
    style->width = lines->width;
    style->crease_width = inner_share;
    style->dash = lines->dash;
    style->gap = lines->gap;
    style->overshoot = lines->overshoot;
    style->halo = lines->halo;
    bool outlines = lines->colour.a > 0 && lines->profile_weight > 0, inside = inner.a > 0 && lines->inner_weight > 0;
    wishes->contours = outlines ? CONTOURS_EDGES : CONTOURS_NONE;
    wishes->borders = outlines;
    wishes->creases = wishes->intersections = inside;
    wishes->materials = 0;
}

/* Lines behind other surfaces: as the composition of layers has them. */
static void take_layers(stroke_wishes *wishes, stroke_style *style, const rule *r)
{
    const technique_use *compose = r->use_counts[KIND_COMPOSE] ? &r->uses[KIND_COMPOSE][0] : NULL;
    const technique_use *layers = r->use_counts[KIND_LAYERS] ? &r->uses[KIND_LAYERS][0] : NULL;
    if (!compose || !compose->technique->layered) {
        style->hidden = HIDDEN_NONE;
        return;
    }
    const layer_style *behind = compose->values;
    const peel_values *peel = layers && layers->technique == &layers_peel ? layers->values : NULL;
    style->hidden_colour = or_else(behind->hidden_colour, style->colours[STROKE_CONTOUR]);
    style->hidden_colour.a *= behind->hidden_opacity;
    style->hidden_width = isnan(behind->hidden_width) ? style->width * hidden_share : behind->hidden_width;
    style->hidden_dash = behind->hidden_dash;
    style->hidden_gap = behind->hidden_gap;
    style->hidden = !(style->hidden_colour.a > 0) ? HIDDEN_NONE : behind->hidden_dash > 0 ? HIDDEN_DASHED : HIDDEN_SOLID;
    style->hidden_fade = behind->fade * behind->fade; /* two surfaces are one pair */
    style->hidden_depth = peel && peel->count > 0 ? peel->count - 1 : 0;
    style->hidden_crowd = hidden_apart;
    style->halo = fmaxf(style->halo, behind->halo);
    if (peel && peel->count == 1)
        style->hidden = HIDDEN_NONE;
    wishes->hidden = style->hidden != HIDDEN_NONE;
}

/* A hand that sways, restates lines and presses unevenly. */
static void take_hand(stroke_style *style, const rule *r)
{
    const technique_use *hand = r->use_counts[KIND_PERTURB] ? &r->uses[KIND_PERTURB][0] : NULL;
    if (!hand)
        return;
    float amount = number_of(hand, KIND_PERTURB, "amount", 0), jitter = number_of(hand, KIND_PERTURB, "jitter", 0);
    style->wobble = fmaxf(amount * sway_share, number_of(hand, KIND_PERTURB, "dark_sway", 0));
    style->wobble_length = fmaxf(number_of(hand, KIND_PERTURB, "scale", 90), 4);
    style->pressure = fminf(number_of(hand, KIND_PERTURB, "pressure", 0), 1);
    int32_t copies = whole_of(hand, KIND_PERTURB, "dark", 1);
    if (copies > 1) {
        style->repeats = copies < 3 ? copies : 3;
        style->repeat_apart = jitter + 0.5f;
        style->brush = BRUSH_PENCIL;
    }
    if (style->wobble > 0)
        style->taper = style->width * taper_share;
}

/* The technique whose lines are strokes anyway. */
static const strokes_values *own_strokes(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        if (r->uses[KIND_LINES][i].technique == &lines_strokes)
            return r->uses[KIND_LINES][i].values;
    return NULL;
}

bool vector_rule_strokes(const rule *r, stroke_wishes *wishes, stroke_style *style)
{
    const strokes_values *own = own_strokes(r);
    if (own) {
        *wishes = strokes_wishes_of(own);
        *style = strokes_style_of(own);
        if (!(style->wobble > 0))
            take_hand(style, r);
        return true;
    }
    *wishes = (stroke_wishes)STROKE_WISHES_INIT;
    *style = (stroke_style){.width = 2, .crease_width = 1, .wobble_length = 60, .repeats = 1, .gap = 4, .hidden = HIDDEN_NONE, .hidden_fade = 1, .hidden_gap = 4};
    if (r->use_counts[KIND_LINES] == 0)
        return false;
    take_lines(wishes, style, r->uses[KIND_LINES][0].values);
    if (r->uses[KIND_LINES][0].technique == &lines_shell)
        wishes->creases = wishes->intersections = false;
    take_layers(wishes, style, r);
    take_hand(style, r);
    return wishes->contours != CONTOURS_NONE || wishes->creases || wishes->borders;
}

/* --- surfaces ------------------------------------------------------------------------------------------------------------ */

static bool same_colour(colour a, colour b)
{
    return fabsf(a.r - b.r) + fabsf(a.g - b.g) + fabsf(a.b - b.b) < 1.0f / 512 && fabsf(a.a - b.a) < 1.0f / 512;
}

/* The one colour of a surface without light; false when it has more. */
static bool flat_colour(const technique_use *surface, colour *out)
{
    if (surface->technique != &surface_flat || number_of(surface, KIND_SURFACE, "model_colour", 0) > 0)
        return false;
    memcpy(out, param_field(kind_find_param(kinds[KIND_SURFACE], surface->technique, "colour"), surface->values), sizeof *out);
    return true;
}

/* Marks on paper that is nothing but the page. */
static bool marks_on_ground(const rule *r, colour ground)
{
    const technique_use *marked = vector_rule_marks(r);
    const mark_values   *v = marked ? marked->values : NULL;
    return v && !(v->paper_tint > 0) && (isnan(v->paper.r) || !(v->paper.a > 0) || same_colour(v->paper, ground));
}

bool vector_rule_needs_pixels(const rule *r, colour ground)
{
    const technique_use *surface = r->use_counts[KIND_SURFACE] ? &r->uses[KIND_SURFACE][0] : NULL;
    const technique_use *compose = r->use_counts[KIND_COMPOSE] ? &r->uses[KIND_COMPOSE][0] : NULL;
    colour               only;
    if (!surface || (compose && compose->technique == &compose_wire))
        return false; /* nothing but lines */
    return !marks_on_ground(r, ground) && !(flat_colour(surface, &only) && (!(only.a > 0) || same_colour(only, ground)));
}

bool vector_needs_pixels(const lmn_look *look)
{
    colour ground = ((const sheet_values *)look->wide[KIND_FINISH].values)->ground;
    for (size_t i = 0; i < look->rule_count; i++)
        if (vector_rule_needs_pixels(&look->rules[i], ground))
            return true;
    return false;
}

/* The mean colour of a picture, linear; white where there is none. */
static vec4 mean_colour(const lmn_scene *scene, int32_t index)
{
    const image *picture = index >= 0 ? &scene->images[index] : NULL;
    if (!picture || !picture->pixels)
        return (vec4){1, 1, 1, 1};
    size_t count = (size_t)picture->width * picture->height, step = count / FILL_SAMPLES + 1, taken = 0;
    double sum[3] = {0};
    for (size_t i = 0; i < count; i += step, taken++)
        for (size_t k = 0; k < 3; k++)
            sum[k] += (double)colour_to_linear((float)picture->pixels[4 * i + k] / 255);
    return taken ? (vec4){(float)(sum[0] / (double)taken), (float)(sum[1] / (double)taken), (float)(sum[2] / (double)taken), 1} : (vec4){1, 1, 1, 1};
}

colour vector_fill_colour(const rule *r, const lmn_scene *scene, size_t part_index)
{
    const technique_use *surface = r->use_counts[KIND_SURFACE] ? &r->uses[KIND_SURFACE][0] : NULL;
    colour               only;
    if (surface && flat_colour(surface, &only) && only.a > 0)
        return (colour){colour_to_linear(only.r), colour_to_linear(only.g), colour_to_linear(only.b), only.a};
    const node *n = &scene->nodes[scene->parts[part_index].node];
    int32_t     material = n->mesh >= 0 && scene->meshes[n->mesh].primitive_count ? scene->meshes[n->mesh].primitives[0].material : NONE;
    if (material < 0)
        return (colour){0.6f, 0.6f, 0.6f, 1};
    vec4 c = scene->materials[material].base_colour, mean = mean_colour(scene, scene->materials[material].base_texture.image);
    return (colour){c.x * mean.x, c.y * mean.y, c.z * mean.z, c.w};
}
