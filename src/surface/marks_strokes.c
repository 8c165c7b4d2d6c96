/* strokes: pen strokes that lie on the surface as lines, of which light and distance choose. Freudenberg 2003,
 * sections 5.1.6, 5.3 and 5.4; rows EX-11 to EX-14, EX-26 to EX-29, EX-33. With texture coordinates strokes of a
 * texture, as in Freudenberg's work; without, strokes that follow the form. */
#include <math.h>
#include <string.h>

#include "base/error.h"
#include "base/memory.h"
#include "base/text.h"
#include "stroke_texture/strokes.h"
#include "surface/indication.h"
#include "surface/marks.h"
#include "surface/surface.h"

static const char *const placed_names[] = {"form", "planes", "uv", "grass", NULL};
static const char *const law_names[] = {"thesis", "line", NULL};
static const char *const primitive_names[] = {"quads", "lines", NULL};
static const char *const layout_names[] = {"corners", "packed", "instances", NULL};
static const char *const hiding_names[] = {"outside", "winding", "width", "depth", "discard", "alpha", NULL};

/* The pattern of this name; PATTERN_COUNT: none has it. */
static stroke_pattern pattern_of(const char *name)
{
    int i = 0;
    while (i < PATTERN_COUNT && strcmp(stroke_pattern_names[i], name) != 0)
        i++;
    return (stroke_pattern)i;
}

static lmn_status check_strokes(const char *words, lmn_error *error)
{
    const char *ending = strrchr(words, '.');
    if (!words[0] || pattern_of(words) < PATTERN_COUNT ||
        (ending && (strcmp(ending, ".stx") == 0 || strcmp(ending, ".svg") == 0)))
        return LMN_OK;
    return error_set(error, LMN_USAGE, "'%s' is neither a pattern of strokes nor a file that ends in .stx or .svg",
                     words);
}

static const param params[] = {
    MARK_ROWS(30000, "Strokes"),
    PARAM_ENUM_ROW(
        surface_strokes_values, placed, .names = placed_names, .variant = true,
        .doc = "form: strokes lie side by side along the directions in which the surface bends; planes: where planes "
               "through the model "
               "cut it; uv: a texture of strokes laid out by texture coordinates (models without any: form); grass: "
               "they stand "
               "on it, as grass, hair or fur."),
    PARAM_FLOAT_ROW(surface_strokes_values, width, .def = 0.975, .min = 0.075, .max = 48, .soft_min = 0.375,
                    .soft_max = 4.5, .unit = UNIT_PT, .doc = "Width of strokes, wherever they are."),
    PARAM_FLOAT_ROW(surface_strokes_values, scale, .def = 0.75, .min = 0.15, .max = 150, .soft_min = 0.375,
                    .soft_max = 7.5, .unit = UNIT_PT,
                    .doc = "Mean distance of strokes where it is darkest, all sets together: they come no closer, "
                           "however dark it should be."),
    PARAM_FLOAT_ROW(surface_strokes_values, length, .def = 0.035, .min = 0.0005, .max = 1, .soft_max = 0.2,
                    .unit = UNIT_FRACTION, .cpu_only = true, .only_if = "placed=form,planes,grass",
                    .doc = "Mean length of strokes, fraction of the model's diagonal."),
    PARAM_INT_ROW(surface_strokes_values, series, .def = 2, .min = 1, .max = 4, .unit = UNIT_COUNT, .cpu_only = true,
                  .only_if = "placed=form,planes",
                  .doc = "Sets of strokes that cross each other, later ones where it is darker."),
    PARAM_FLOAT_ROW(surface_strokes_values, turn, .def = 62, .min = -180, .max = 180, .unit = UNIT_DEGREES,
                    .cpu_only = true, .only_if = "series>1", .doc = "Angle between one set of strokes and the next."),
    PARAM_FLOAT_ROW(surface_strokes_values, uneven, .def = 0.35, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .only_if = "placed=form,planes,grass",
                    .doc = "How much strokes differ in length and way."),
    PARAM_FLOAT_ROW(
        surface_strokes_values, taper, .def = 0.25, .min = 0, .max = 0.5, .unit = UNIT_FRACTION,
        .doc =
            "Fraction of its length over which each end of a stroke runs out; of grass, which has a root, half of the "
            "fraction over which its tip does."),
    PARAM_INT_ROW(surface_strokes_values, tuft, .def = 3, .min = 1, .max = 12, .unit = UNIT_COUNT, .cpu_only = true,
                  .only_if = "placed=grass", .doc = "Blades that grow from one place."),
    PARAM_FLOAT_ROW(surface_strokes_values, upright, .def = 0.6, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .only_if = "placed=grass",
                    .doc =
                        "What blades grow towards: 0, away from the surface, as hair does; 1, upwards, as grass does."),
    PARAM_FLOAT_ROW(surface_strokes_values, lean, .def = 28, .min = 0, .max = 85, .unit = UNIT_DEGREES,
                    .cpu_only = true, .only_if = "placed=grass",
                    .doc = "How far blades lean over, in the mean; they bend more and more towards their tips."),
    PARAM_FLOAT_ROW(surface_strokes_values, combed, .def = 0.4, .min = 0, .max = 1, .unit = UNIT_FRACTION,
                    .cpu_only = true, .only_if = "placed=grass",
                    .doc = "How much all lean to the same side, down the surface; 0: each anywhere."),
    PARAM_ENUM_ROW(
        surface_strokes_values, law, .names = law_names, .def = 1, .variant = true,
        .doc = "How strokes are thinned out with distance and tilt: line keeps the ink on the page the same; thesis is "
               "the simpler one of Freudenberg (2003), which leaves too few where strokes are foreshortened."),
    PARAM_TEXT_ROW(surface_strokes_values, strokes, .is_file = true, .example = "brick", .only_if = "placed=uv",
                   .check = check_strokes,
                   .doc = "What is laid out by texture coordinates: a file of strokes (.stx, .svg) or a pattern "
                          "(parallel, cross, contour, brick, stipple, scribble, random). Empty: cross."),
    PARAM_BOOL_ROW(surface_strokes_values, equalised, .def = 1, .only_if = "placed=uv",
                   .doc = "Draws as many strokes of a texture as make the fraction of ink follow the tone; without, a "
                          "stroke is there where its light priority is not below the tone, as in screens that are not "
                          "equalised."),
    PARAM_TEXT_ROW(surface_strokes_values, indication, .is_file = true, .example = "checker", .only_if = "placed=uv",
                   .check = indication_check,
                   .doc = "A picture on the texture coordinates that asks for more strokes where it is dark and fewer "
                          "where it is light, by the middle of each; middle grey changes nothing. checker shows how "
                          "texture coordinates lie."),
    PARAM_FLOAT_ROW(surface_strokes_values, indication_strength, .def = 1, .min = -8, .max = 8, .soft_min = 0,
                    .soft_max = 2, .cpu_only = true, .only_if = "placed=uv&indication",
                    .doc = "Weight of the indication."),
    PARAM_FLOAT_ROW(surface_strokes_values, repeat, .def = 0, .min = 0, .max = 20, .soft_max = 8, .cpu_only = true,
                    .only_if = "placed=uv",
                    .doc = "How often the texture is laid into a unit of texture coordinates; 0: so often that there "
                           "are as many strokes as asked for."),
    PARAM_FLOAT_ROW(
        surface_strokes_values, jitter, .def = 0.01, .min = 0, .max = 0.5, .soft_max = 0.1, .unit = UNIT_FRACTION,
        .cpu_only = true, .only_if = "placed=uv",
        .doc = "How far each copy of a stroke is moved, fraction of the texture, so that it is not seen to repeat."),
    PARAM_ENUM_ROW(
        surface_strokes_values, primitive, .names = primitive_names, .variant = true,
        .doc = "What strokes are drawn with: quads have any width and soft borders; lines are those of the graphics "
               "hardware, a pixel wide and hard, paler where a stroke is thinner. In files of vectors no wider than a "
               "pixel."),
    PARAM_ENUM_ROW(
        surface_strokes_values, layout, .names = layout_names, .variant = true,
        .doc = "How strokes lie in the graphics memory: corners holds all numbers whole at each corner, packed holds "
               "them in 64 bytes, instances holds those once for all corners. The picture is the same."),
    PARAM_ENUM_ROW(surface_strokes_values, hiding, .names = hiding_names, .variant = true, .only_if = "primitive=quads",
                   .doc = "How strokes that are not drawn are left out, by the ways that Freudenberg (2003) compares. "
                          "The picture is the same; outside takes least."),
};

static void describe(text *out, const void *values)
{
    const surface_strokes_values *v = values;
    text_append(out, "strokes %d %d %d %d %d %.9g %d %.9g %.9g %.9g %.9g %s ", v->common.count, v->common.pattern_seed,
                v->primitive, v->layout, v->placed, (double)v->length, v->series, (double)v->turn, (double)v->uneven,
                (double)v->repeat, (double)v->jitter, v->strokes.text);
    if (v->placed == PLACED_GRASS)
        text_append(out, "%d %.9g %.9g %.9g ", v->tuft, (double)v->upright, (double)v->lean, (double)v->combed);
    if (v->indication.text[0]) {
        text_append(out, "%.9g ", (double)v->indication_strength);
        indication_describe(out, v->indication.text);
    }
}

/* The area of the surface in texture coordinates. */
static double area_of_uvs(const mark_surface *s)
{
    double sum = 0;
    for (size_t t = 0; t < s->triangle_count; t++) {
        const vec2 *a = &s->uvs[s->indices[3 * t]], *b = &s->uvs[s->indices[3 * t + 1]],
                   *c = &s->uvs[s->indices[3 * t + 2]];
        sum += 0.5 * fabs(((double)b->x - (double)a->x) * ((double)c->y - (double)a->y) -
                          ((double)b->y - (double)a->y) * ((double)c->x - (double)a->x));
    }
    return sum;
}

/* The map that strokes ask, row 0 at the bottom; the caller frees it. */
static lmn_status take_indication(float **greys, tile_options *options, const surface_strokes_values *v,
                                  lmn_error *error)
{
    mip_chain  chain;
    lmn_status status = indication_make(&chain, v->indication.text, error);
    if (status != LMN_OK)
        return status;
    size_t width = (size_t)chain.width, height = (size_t)chain.height;
    *greys = mem_alloc(width * height * sizeof **greys);
    for (size_t i = 0; *greys && i < width * height; i++)
        (*greys)[(height - 1 - i / width) * width + i % width] = (float)((const uint8_t *)chain.data[0])[i] / 255;
    mip_chain_release(&chain);
    if (!*greys)
        return error_memory(error);
    options->indication = *greys;
    options->indication_width = (int)width;
    options->indication_height = (int)height;
    options->indication_strength = v->indication_strength;
    return LMN_OK;
}

static lmn_status make_tiled(marks *out, const mark_surface *surface, const surface_strokes_values *v, lmn_error *error)
{
    strokes        texture = {NULL, 0, 0, 1};
    lmn_status     status;
    stroke_pattern pattern = v->strokes.text[0] ? pattern_of(v->strokes.text) : PATTERN_CROSS;
    if (pattern == PATTERN_COUNT)
        status = strokes_load(&texture, v->strokes.text, error);
    else
        status = strokes_generate(
            &texture,
            &(pattern_options){.pattern = pattern, .uneven = v->uneven, .seed = (uint32_t)v->common.pattern_seed},
            error);
    double squares = area_of_uvs(surface),
           often = squares > 0 && texture.count > 0 ? sqrt(v->common.count / (squares * (double)texture.count)) : 1;
    tile_options options = {.repeat = v->repeat > 0 ? v->repeat : (float)fmax(floor(often + 0.5), 1),
                            .jitter = v->jitter,
                            .seed = (uint32_t)v->common.pattern_seed};
    float       *greys = NULL;
    if (status == LMN_OK && v->indication.text[0])
        status = take_indication(&greys, &options, v, error);
    if (status == LMN_OK)
        status = marks_tile(out, surface, &texture, &options, error);
    mem_free(greys);
    strokes_release(&texture);
    return status;
}

static lmn_status make_traced(marks *out, const mark_surface *surface, double extent, size_t count,
                              const surface_strokes_values *v, lmn_error *error)
{
    enum { LEVELS = 6 };
    double length = extent * (double)v->length;
    float  turn = v->turn * (3.14159265f / 180);
    if (v->placed == PLACED_PLANES)
        return marks_trace(out, surface,
                           &(trace_options){.count = count,
                                            .length = length,
                                            .uneven = v->uneven,
                                            .series = v->series,
                                            .turn = turn,
                                            .seed = (uint32_t)v->common.pattern_seed},
                           error);
    /* As close as so many strokes of this length lie, but no closer than pictures of the whole model need, and no
     * farther apart than there are lines on it. */
    double apart = mark_surface_area(surface) * v->series / ((double)count * length);
    return marks_streamlines(out, surface,
                             &(flow_options){.apart = fmin(fmax(apart, extent / 500), extent / 40),
                                             .levels = LEVELS,
                                             .length = length,
                                             .uneven = v->uneven,
                                             .series = v->series,
                                             .turn = turn,
                                             .sag = MARK_SAG * length / 3,
                                             .whole = true,
                                             .seed = (uint32_t)v->common.pattern_seed},
                             error);
}

/* Some of a surface's triangles. */
typedef struct fraction_of_surface {
    mark_surface surface;
    uint32_t    *indices, *triangles; /* triangles: of the whole */
} fraction_of_surface;

static bool has_area_of_uvs(const mark_surface *s, uint32_t t)
{
    mark_surface one = *s;
    one.indices = &s->indices[3 * (size_t)t];
    one.triangle_count = 1;
    return area_of_uvs(&one) > 0;
}

static bool take_fraction(fraction_of_surface *out, const mark_surface *s, bool laid_out)
{
    *out = (fraction_of_surface){.surface = *s,
                                 .indices = mem_alloc(3 * (size_t)s->triangle_count * sizeof *out->indices),
                                 .triangles = mem_alloc((size_t)s->triangle_count * sizeof *out->triangles)};
    if (!out->indices || !out->triangles)
        return false;
    out->surface.indices = out->indices;
    out->surface.triangle_count = 0;
    for (uint32_t t = 0; t < s->triangle_count; t++)
        if (has_area_of_uvs(s, t) == laid_out) {
            memcpy(&out->indices[3 * (size_t)out->surface.triangle_count], &s->indices[3 * (size_t)t],
                   3 * sizeof *s->indices);
            out->triangles[out->surface.triangle_count++] = t;
        }
    return true;
}

/* Adds what lies on a fraction to what lies on the whole. */
static bool add_fraction(marks *out, const marks *fraction, const uint32_t *triangles)
{
    if (!mem_grow((void **)&out->lines, &out->line_capacity, out->line_count + fraction->line_count,
                  sizeof *out->lines))
        return false;
    for (size_t i = 0; i < fraction->line_count; i++) {
        mark_line *l = &out->lines[out->line_count++];
        *l = fraction->lines[i];
        l->triangle = triangles[l->triangle];
        l->stroke += (uint32_t)out->stroke_count;
    }
    out->stroke_count += fraction->stroke_count;
    out->line_length += fraction->line_length;
    out->area += fraction->area;
    return true;
}

/* Strokes of a texture where there are texture coordinates, strokes that follow the form where there are none. */
static lmn_status make_both(marks *out, const mark_surface *surface, double extent, const surface_strokes_values *v,
                            lmn_error *error)
{
    memset(out, 0, sizeof *out);
    lmn_status status = LMN_OK;
    double     whole = mark_surface_area(surface);
    for (int laid_out = 0; laid_out < 2 && status == LMN_OK; laid_out++) {
        fraction_of_surface fraction;
        marks               made = {.lines = NULL};
        if (!take_fraction(&fraction, surface, laid_out))
            status = error_memory(error);
        else if (laid_out)
            status = make_tiled(&made, &fraction.surface, v, error);
        else
            status = make_traced(
                &made, &fraction.surface, extent,
                (size_t)(v->common.count * mark_surface_area(&fraction.surface) / fmax(whole, 1e-300)) + 1, v, error);
        if (status == LMN_OK && !add_fraction(out, &made, fraction.triangles))
            status = error_memory(error);
        surface_marks_release(&made);
        mem_free(fraction.indices);
        mem_free(fraction.triangles);
    }
    if (status != LMN_OK)
        surface_marks_release(out);
    return status;
}

static lmn_status make_grass(marks *out, const mark_surface *surface, double extent, const surface_strokes_values *v,
                             lmn_error *error)
{
    const double RADIANS = 3.14159265358979 / 180;
    return marks_grass(out, surface,
                       &(grass_options){.count = (size_t)v->common.count,
                                        .tuft = v->tuft,
                                        .length = extent * (double)v->length,
                                        .upright = (double)v->upright,
                                        .lean = (double)v->lean * RADIANS,
                                        .combed = (double)v->combed,
                                        .uneven = (double)v->uneven,
                                        .up = surface->up,
                                        .seed = (uint32_t)v->common.pattern_seed},
                       error);
}

static lmn_status make(marks *out, const mark_surface *surface, double extent, const void *values, lmn_error *error)
{
    const surface_strokes_values *v = values;
    if (v->placed == PLACED_UV && surface->uvs)
        return make_both(out, surface, extent, v, error);
    if (v->placed == PLACED_GRASS)
        return make_grass(out, surface, extent, v, error);
    return make_traced(out, surface, extent, (size_t)v->common.count, v, error);
}

static const mark_source source = {.describe = describe,
                                   .make = make,
                                   .vertex = "surface/marks_strokes.vert",
                                   .fragment = "surface/marks_strokes.frag"};

const technique surface_strokes = {
    .name = "strokes",
    .doc = "Pen strokes that lie on the surface as lines of their own, whose number makes the tone.",
    .example = "{\"surface\": {\"technique\": \"strokes\"}, \"lines\": \"discontinuity\"}",
    .params = params,
    .param_count = PARAM_COUNT(params),
    .params_size = sizeof(surface_strokes_values),
    .channels = CHANNEL_NORMAL_DEPTH,
    .surface = &(const surface_row){.shader = "surface/marks_paper.glsl", .marks = &source},
};

static float luminance_of(colour c)
{
    return 0.2126f * c.r + 0.7152f * c.g + 0.0722f * c.b;
}

bool surface_mark_style(mark_style *out, const technique_use *use)
{
    if (!use || !use->technique->surface->marks)
        return false;
    const mark_values *v = use->values;
    *out = (mark_style){.fade = v->fade,
                        .most = 1,
                        .shadow = v->shadow,
                        .light = v->light,
                        .contrast = v->contrast,
                        .texture = v->texture,
                        .ink = v->ink};
    colour paper = v->paper;
    if (!isnan(paper.r))
        out->white = luminance_of(v->ink) > luminance_of(paper) * paper.a + 1 - paper.a;
    if (use->technique == &surface_stipple) {
        const stipple_values *s = use->values;
        out->diameter = s->diameter;
        out->most = s->grow * s->grow;
    } else if (use->technique == &surface_lines) {
        const surface_lines_values *l = use->values;
        out->diameter = out->scale = l->scale;
        out->taper = l->taper;
        out->crossed = l->crossed;
        out->least = l->least;
        out->widest = l->widest;
        out->tip = l->tip;
        out->join = l->join;
        out->swell = l->swell;
        out->pressure = l->pressure;
        out->patchy = l->patchy;
        out->stray = l->stray;
        out->room = l->room;
        out->gradient = l->gradient;
        out->sparse = l->sparse;
        out->black = l->room > 0 ? l->black : 0;
        out->series = l->series;
        out->steady = l->steady;
    } else {
        const surface_strokes_values *s = use->values;
        out->thin = s->primitive == 1;
        out->diameter = out->thin ? fminf(s->width, 1) : s->width;
        out->layout = (mark_layout)s->layout;
        out->hiding = out->thin ? HIDE_OUTSIDE : (mark_hiding)s->hiding;
        out->scale = s->scale;
        out->taper = s->taper;
        out->law = s->law;
        out->by_priority = !s->equalised;
        out->crowded = s->placed == PLACED_FORM ? 0 : s->placed == PLACED_GRASS ? 1 : MARK_CROWDED_IN_PLANES;
        if (s->placed == PLACED_GRASS)
            out->stands = s->length * (1 + 0.6f * s->uneven) + 0.12f * 3 * s->length;
    }
    return true;
}
