/* Looks as strokes. Looks whose lines are found in pictures say how wide they are, in which colours, and how those
 * behind are drawn; that is taken over, and strokes answer where lines are. */
#include <math.h>
#include <string.h>

#include "compose/compose.h"
#include "draft/draw.h"
#include "vector/vector_private.h"
#include "finish/finish.h"
#include "layer/layer.h"
#include "light/light.h"
#include "lines/lines.h"
#include "surface/marks.h"

/* What a picture's lines do not say. */
static const float hidden_apart = 3;       /* hidden lines nearer than this turn into grey, pixels */
static const float hidden_fraction = 0.6f; /* width of hidden lines that have none of their own */
enum { FILL_SAMPLES = 9973 }; /* of a texture, for its mean; a prime, so that they do not fall on columns */

static colour or_else(colour c, colour otherwise)
{
    return isnan(c.r) ? otherwise : c;
}

/* Lines behind other surfaces: as the composition of layers has them. */
static void take_layers(stroke_options *options, stroke_style *style, const rule *r)
{
    const technique_use *compose = rule_use(r, KIND_COMPOSE);
    if (!compose || !compose->technique->compose->layered) {
        style->hidden = HIDDEN_NONE;
        return;
    }
    const layer_style *behind = compose->values;
    const layering     how = layering_of(rule_use(r, KIND_LAYERS));
    style->hidden_colour = or_else(behind->hidden_colour, style->colours[STROKE_CONTOUR]);
    style->hidden_colour.a *= behind->hidden_opacity;
    style->hidden_width = isnan(behind->hidden_width) ? style->width * hidden_fraction : behind->hidden_width;
    style->hidden_dash = behind->hidden_dash;
    style->hidden_gap = behind->hidden_gap;
    style->hidden = !(style->hidden_colour.a > 0) ? HIDDEN_NONE
                    : behind->hidden_dash > 0     ? HIDDEN_DASHED
                                                  : HIDDEN_SOLID;
    style->hidden_fade = behind->fade * behind->fade; /* two surfaces are one pair */
    style->hidden_depth = how.several && how.count > 0 ? how.count - 1 : 0;
    style->hidden_crowd = hidden_apart;
    style->halo = fmaxf(style->halo, behind->halo);
    if (how.several && how.count == 1)
        style->hidden = HIDDEN_NONE;
    options->hidden = style->hidden != HIDDEN_NONE;
}

static void take_hand(stroke_style *style, const rule *r)
{
    const technique_use *hand = rule_use(r, KIND_PERTURB);
    if (hand && hand->technique->perturbs->as_hand)
        hand->technique->perturbs->as_hand(style, hand->values);
}

/* The lines that vectors draw: those that are strokes anyway, else the first; NULL: the rule has none. */
static const technique_use *lines_of(const rule *r)
{
    for (size_t i = 0; i < r->use_counts[KIND_LINES]; i++)
        if (technique_draws_strokes(r->uses[KIND_LINES][i].technique))
            return &r->uses[KIND_LINES][i];
    return rule_use(r, KIND_LINES);
}

bool vector_rule_strokes(const rule *r, stroke_options *options, stroke_style *style)
{
    const technique_use *lines = lines_of(r);
    *options = (stroke_options)STROKE_OPTIONS_INIT;
    *style = (stroke_style){.width = 2,
                            .crease_width = 1,
                            .wobble_length = 60,
                            .repeats = 1,
                            .repeat_turn = 2.5f,
                            .overshoot_most = 0.15f,
                            .gap = 4,
                            .hidden = HIDDEN_NONE,
                            .hidden_fade = 1,
                            .hidden_gap = 4};
    if (!lines)
        return false;
    (lines->technique->lines->as_strokes ? lines->technique->lines->as_strokes : lines_as_strokes)(options, style,
                                                                                                   lines->values);
    options->width = style->width;
    if (technique_draws_strokes(lines->technique)) {
        if (style->hidden == HIDDEN_NONE)
            take_layers(options, style, r);
        if (!(style->wobble > 0))
            take_hand(style, r);
        return true;
    }
    take_layers(options, style, r);
    take_hand(style, r);
    return options->contours != CONTOURS_NONE || options->creases || options->borders;
}

void vector_style_in_group(stroke_style *style, double wide)
{
    const float narrow = (float)(wide / 2 * VECTOR_PIXELS_PER_MM);
    style->width = 2 * narrow;
    style->crease_width = 1;
    style->narrow = true;
    style->hidden_width = narrow;
    style->hidden_dash = (float)DRAFT_HIDDEN_DASH * narrow;
    style->hidden_gap = (float)DRAFT_HIDDEN_GAP * narrow;
    style->hidden = style->hidden == HIDDEN_NONE ? HIDDEN_NONE : HIDDEN_DASHED;
    style->hidden_fade = 1;
    style->taper = style->pressure = style->wobble = style->overshoot = style->dash = style->cover = 0;
    style->repeats = 1;
    style->brush = BRUSH_PEN;
    style->hidden_colour = (colour){style->colours[STROKE_CONTOUR].r, style->colours[STROKE_CONTOUR].g,
                                    style->colours[STROKE_CONTOUR].b, 1};
}

/* --- surfaces ------------------------------------------------------------------------------------------- */

static bool same_colour(colour a, colour b)
{
    return fabsf(a.r - b.r) + fabsf(a.g - b.g) + fabsf(a.b - b.b) < 1.0f / 512 && fabsf(a.a - b.a) < 1.0f / 512;
}

/* The one colour of a surface; false when it has more. */
static bool only_colour(const technique_use *surface, colour *out)
{
    return surface->technique->surface->as_fill && surface->technique->surface->as_fill(out, surface->values);
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
    const technique_use *surface = rule_use(r, KIND_SURFACE);
    const technique_use *compose = rule_use(r, KIND_COMPOSE);
    colour               only;
    if (!surface || (compose && compose->technique->compose->lines_only))
        return false; /* nothing but lines */
    return !marks_on_ground(r, ground) &&
           !(only_colour(surface, &only) && (!(only.a > 0) || same_colour(only, ground)));
}

bool vector_needs_pixels(const lmn_look *look)
{
    colour ground = ((const sheet_values *)look->wide[KIND_FINISH].values)->ground;
    if (((const scene_values *)look->wide[KIND_SCENE].values)->ground != GROUND_NONE)
        return true; /* a tone that fades */
    for (size_t i = 0; i < look->rule_count; i++)
        if (vector_rule_needs_pixels(&look->rules[i], ground))
            return true;
    return false;
}

/* The mean colour of a picture, light; white where there is none. */
static vec4 mean_colour(const lmn_scene *scene, int32_t index)
{
    const image *picture = index >= 0 ? &scene->images[index] : NULL;
    if (!picture || !picture->pixels)
        return (vec4){1, 1, 1, 1};
    size_t count = (size_t)picture->width * picture->height, step = count / FILL_SAMPLES + 1, taken = 0;
    double sum[3] = {0}, linear[256];
    for (int i = 0; i < 256; i++)
        linear[i] = (double)colour_to_linear((float)i / 255);
    for (size_t i = 0; i < count; i += step, taken++)
        for (size_t k = 0; k < 3; k++)
            sum[k] += linear[picture->pixels[4 * i + k]];
    return taken ? (vec4){(float)(sum[0] / (double)taken), (float)(sum[1] / (double)taken),
                          (float)(sum[2] / (double)taken), 1}
                 : (vec4){1, 1, 1, 1};
}

colour vector_fill_colour(const rule *r, const lmn_scene *scene, size_t part_index, const colour *datum)
{
    const technique_use *surface = rule_use(r, KIND_SURFACE);
    colour               only;
    if (surface && only_colour(surface, &only) && only.a > 0)
        return only;
    if (datum)
        return *datum;
    const node *n = &scene->nodes[scene->parts[part_index].node];
    int32_t     material =
        n->mesh >= 0 && scene->meshes[n->mesh].primitive_count ? scene->meshes[n->mesh].primitives[0].material : NONE;
    if (material < 0)
        return (colour){0.797f, 0.797f, 0.797f, 1};
    vec4 c = scene->materials[material].base_colour,
         mean = mean_colour(scene, scene->materials[material].base_texture.image);
    return (colour){colour_from_linear(c.x * mean.x), colour_from_linear(c.y * mean.y),
                    colour_from_linear(c.z * mean.z), c.w};
}
