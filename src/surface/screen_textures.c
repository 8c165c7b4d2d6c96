#include "surface/screen_textures.h"

#include <math.h>
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include "base/file.h"
#include "base/memory.h"
#include "fence/image_read.h"
#include "base/store.h"
#include "surface/indication.h"

enum { SIDE_LEAST = 64, SIDE_MOST = 1024, BITMAP_SIDE = 512, PERIOD = 8 };

static const char *const standard_screen = "cross";
static const char *const hatch_map_name = "hatch-map";

static const char *const stroke_endings[] = {".stx", ".svg", NULL};
static const char *const material_name = "material";

static const char *name_of(const screen_values *v)
{
    return v->screen.text[0] ? v->screen.text : standard_screen;
}

bool screen_by_material(void *values, const char *strokes)
{
    screen_values *v = values;
    if (strcmp(v->screen.text, material_name) != 0)
        return false;
    v->screen.text[0] = '\0';
    if (strokes && strlen(strokes) < sizeof v->screen.text)
        memcpy(v->screen.text, strokes, strlen(strokes) + 1);
    return true;
}

static int index_in(const char *const *names, const char *name)
{
    for (int i = 0; names[i]; i++)
        if (strcmp(names[i], name) == 0)
            return i;
    return -1;
}

static bool ends_in(const char *name, const char *const *endings)
{
    char ending[8];
    file_ending(name, ending, sizeof ending);
    return index_in(endings, ending) >= 0;
}

lmn_status screen_check_name(const char *name, lmn_error *error)
{
    if (index_in(stroke_pattern_names, name) >= 0 || index_in(screen_procedure_names, name) >= 0 ||
        strcmp(name, hatch_map_name) == 0 || strcmp(name, material_name) == 0 || ends_in(name, stroke_endings) ||
        image_is_named(name))
        return LMN_OK;
    lmn_status status = error_set(
        error, LMN_USAGE, "screen is '%.200s'; allowed is a pattern, a procedure, the word material, or a file", name);
    const char *names[PATTERN_COUNT + PROCEDURE_COUNT + 2];
    size_t      count = 0;
    for (int i = 0; i < PATTERN_COUNT; i++)
        names[count++] = stroke_pattern_names[i];
    for (int i = 0; i < PROCEDURE_COUNT; i++)
        names[count++] = screen_procedure_names[i];
    names[count++] = hatch_map_name;
    names[count++] = material_name;
    const char *near = text_nearest(name, names, count);
    if (near)
        error_hint(error, "did you mean '%s'? Files end in .stx, .svg, .png, .jpg or .webp", near);
    else
        error_hint(error,
                   "`limner looks ink` lists patterns and procedures; files end in .stx, .svg, .png, .jpg or .webp");
    return status;
}

enum { LAYERS_MOST = 16 };

/* The path of the next picture of a numbered series, wall-1.png, wall-2.png …; false when the first one's name has
 * no number. The caller frees it. */
static bool numbered(const char *first, int number, char **out)
{
    const char *dot = strrchr(first, '.');
    *out = NULL;
    if (!dot || dot - first < 2 || dot[-1] != '1' || dot[-2] != '-')
        return false;
    text path = {0};
    text_append_bytes(&path, first, (size_t)(dot - first) - 1);
    text_append(&path, "%d%s", number, dot);
    *out = text_take(&path);
    return *out != NULL;
}

/* "wall.png" and "-normals" are "wall-normals.png". The caller frees it; NULL: memory is gone. */
static char *name_beside(const char *name, const char *suffix)
{
    const char *dot = strrchr(name, '.');
    text        path = {0};
    text_append_bytes(&path, name, dot ? (size_t)(dot - name) : strlen(name));
    text_append(&path, "%s%s", suffix, dot ? dot : "");
    return text_take(&path);
}

/* The name of the n-th level that was drawn after the finest one. */
static char *name_of_level(const char *name, int level)
{
    char suffix[24];
    snprintf(suffix, sizeof suffix, "-level-%d", level);
    return name_beside(name, suffix);
}

static bool is_there(const char *path)
{
    return path && access(path, F_OK) == 0;
}

/* Pictures beside a painted one that belong to it: its levels, its normals. */
static void describe_beside(text *out, const char *name)
{
    char *normals = name_beside(name, "-normals"), *level = NULL;
    if (is_there(normals))
        text_append(out, " normals %016llx", (unsigned long long)store_hash_of_file(normals));
    mem_free(normals);
    for (int i = 1; i <= LAYERS_MOST && is_there(level = name_of_level(name, i)); i++) {
        text_append(out, " level %016llx", (unsigned long long)store_hash_of_file(level));
        mem_free(level);
        level = NULL;
    }
    mem_free(level);
}

static void describe_file(text *out, const char *name)
{
    if (ends_in(name, stroke_endings) || image_is_named(name))
        text_append(out, " content=%016llx", (unsigned long long)store_hash_of_file(name));
    char *path;
    for (int i = 2; image_is_named(name) && i <= LAYERS_MOST && numbered(name, i, &path); i++) {
        uint64_t content = store_hash_of_file(path);
        mem_free(path);
        if (!content)
            break;
        text_append(out, " %016llx", (unsigned long long)content);
    }
    if (image_is_named(name))
        describe_beside(out, name);
}

void screen_describe(text *out, const void *values)
{
    const screen_values *v = values;
    text_append(out,
                "11 %s%s scale=%.6g width=%.6g detail=%d equalised=%d frames=%d seed=%d relief=%.6g gain=%.6g "
                "page=%d angle=%.6g",
                name_of(v), v->scheme == SCHEME_MULTIPLY ? " multiply" : "", (double)v->scale, (double)v->width,
                v->detail, v->equalised, v->frames, v->pattern_seed, (double)v->relief, (double)v->gain,
                v->common.coordinates == COORDINATES_SCREEN, (double)v->common.angle);
    describe_file(out, name_of(v));
}

/* --- screens of strokes --- */

static lmn_status strokes_of(strokes *out, const screen_values *v, int frame, lmn_error *error)
{
    int pattern = index_in(stroke_pattern_names, name_of(v));
    if (pattern < 0)
        return strokes_load(out, name_of(v), error);
    return strokes_generate(out,
                            &(pattern_options){.pattern = (stroke_pattern)pattern,
                                               .uneven = 0.5f,
                                               .seed = (uint32_t)(v->pattern_seed * 16 + frame)},
                            error);
}

/* Side of the square over the mean distance of its strokes. */
static double strokes_across(const strokes *s)
{
    double length = 0, dots = 0;
    for (size_t i = 0; i < s->count; i++) {
        double own = stroke_length(&s->items[i]);
        length += own;
        dots += own < 1e-6;
    }
    return fmax(fmax(length, sqrt(dots)), 1);
}

/* As many texels as the square has pixels on the page, about, so that strokes can be drawn as wide as they are
 * wanted. */
static screen_options options_of(const screen_values *v, const strokes *s)
{
    double pixels = (double)v->scale * strokes_across(s);
    int    side = SIDE_LEAST;
    while (side < SIDE_MOST && side < pixels * 0.75)
        side *= 2;
    return (screen_options){.side = side,
                            .brush = {.width = fmax((double)v->width * side / pixels, 0.5), .taper = 0.15},
                            .detail = (screen_detail)v->detail,
                            .equalised = v->equalised && v->scheme != SCHEME_MULTIPLY};
}

typedef lmn_status (*strokes_to_chain)(mip_chain *out, const strokes *s, const screen_options *options,
                                       const screen_values *v, lmn_error *error);

static lmn_status to_screen(mip_chain *out, const strokes *s, const screen_options *options, const screen_values *v,
                            lmn_error *error)
{
    return v->scheme == SCHEME_MULTIPLY ? screen_ink_map(out, s, options, error)
                                        : screen_of_strokes(out, s, options, error);
}

static lmn_status to_relief(mip_chain *out, const strokes *s, const screen_options *options, const screen_values *v,
                            lmn_error *error)
{
    return screen_normals(out, s, options, (double)v->relief, error);
}

static lmn_status to_warp(mip_chain *out, const strokes *s, const screen_options *options, const screen_values *v,
                          lmn_error *error)
{
    (void)v;
    return screen_warp(out, s, options, error);
}

/* Puts chains of one layer that are alike into one of several; takes them over. */
static lmn_status join(mip_chain *out, mip_chain *parts, int count, lmn_error *error)
{
    if (count == 1) {
        *out = parts[0];
        memset(&parts[0], 0, sizeof parts[0]);
        return LMN_OK;
    }
    lmn_status status =
        mip_chain_create(out, parts[0].width, parts[0].height, count, parts[0].levels, parts[0].format, error);
    for (int k = 0; status == LMN_OK && k < out->levels; k++)
        for (int i = 0; i < count; i++)
            memcpy(mip_layer(out, k, i), parts[i].data[k], mip_level_bytes(&parts[i], k));
    out->fact = parts[0].fact;
    out->nearest = parts[0].nearest;
    return status;
}

/* One chain a frame, of one size. */
static lmn_status make_of_strokes(mip_chain *out, const screen_values *v, strokes_to_chain convert, lmn_error *error)
{
    enum { FRAMES_MAX = 16 };
    mip_chain      parts[FRAMES_MAX] = {{0}};
    bool           pattern = index_in(stroke_pattern_names, name_of(v)) >= 0;
    int            count = pattern ? v->frames : 1;
    screen_options options = {0};
    lmn_status     status = LMN_OK;
    for (int i = 0; i < count && status == LMN_OK; i++) {
        strokes s = {0};
        status = strokes_of(&s, v, i, error);
        if (status == LMN_OK && i == 0)
            options = options_of(v, &s);
        if (status == LMN_OK)
            status = convert(&parts[i], &s, &options, v, error);
        parts[i].fact = (float)(options.side / strokes_across(&s));
        strokes_release(&s);
    }
    if (status == LMN_OK)
        status = join(out, parts, count, error);
    for (int i = 0; i < count; i++)
        mip_chain_release(&parts[i]);
    return status;
}

/* --- painted screens --- */

/* One picture is the screen; several that are numbered are its layers, the most important one first (IM-12). */
static lmn_status load_layers(image_pixels *out, size_t *count, const char *name, lmn_error *error)
{
    lmn_status status = image_load(&out[0], name, error);
    *count = status == LMN_OK;
    char *path;
    for (int i = 1; status == LMN_OK && i < LAYERS_MOST && numbered(name, i + 1, &path); i++) {
        bool there = access(path, F_OK) == 0;
        if (there)
            status = image_load(&out[i], path, error);
        *count += there && status == LMN_OK;
        mem_free(path);
        if (!there)
            break;
    }
    return status;
}

/* Texels a side for a picture. */
static int side_for(const image_pixels *p)
{
    int side = SIDE_LEAST;
    while (side < BITMAP_SIDE && (uint32_t)side < p->width)
        side *= 2;
    return side;
}

/* The levels that were drawn one by one (IM-04), as they are. *count is 0 when there are none. */
static lmn_status make_of_levels(mip_chain *out, const screen_values *v, size_t *count, lmn_error *error)
{
    image_pixels pixels[LAYERS_MOST] = {{0}};
    screen_layer levels[LAYERS_MOST];
    lmn_status   status = LMN_OK;
    lmn_error    problem = {0};
    *count = 0;
    for (int i = 0; i < LAYERS_MOST && status == LMN_OK; i++) {
        char *path = i ? name_of_level(name_of(v), i) : mem_copy_text(name_of(v));
        bool  there = is_there(path);
        if (there)
            status = image_load(&pixels[i], path, error);
        mem_free(path);
        if (!there || status != LMN_OK)
            break;
        levels[(*count)++] = (screen_layer){pixels[i].rgba, pixels[i].width, pixels[i].height};
    }
    *count = *count > 1 ? *count : 0;
    if (status == LMN_OK && *count) {
        status = screen_of_levels(out, levels, *count, side_for(&pixels[0]), &problem);
        if (status != LMN_OK)
            error_in_file(error, status, name_of(v), 0, "%s", problem.message);
    }
    for (int i = 0; i < LAYERS_MOST; i++)
        mem_free(pixels[i].rgba);
    return status;
}

static lmn_status make_of_picture(mip_chain *out, const screen_values *v, lmn_error *error)
{
    size_t     drawn;
    lmn_status found = make_of_levels(out, v, &drawn, error);
    if (drawn || found != LMN_OK)
        return found;
    image_pixels pixels[LAYERS_MOST] = {{0}};
    screen_layer layers[LAYERS_MOST];
    size_t       count;
    lmn_status   status = load_layers(pixels, &count, name_of(v), error);
    lmn_error    problem = {0};
    int          side = status == LMN_OK ? side_for(&pixels[0]) : SIDE_LEAST;
    for (size_t i = 0; i < count; i++)
        layers[i] = (screen_layer){pixels[i].rgba, pixels[i].width, pixels[i].height};
    if (status == LMN_OK) {
        status = screen_of_layers(out, layers, count, (double)v->gain, side, (screen_detail)v->detail, &problem);
        if (status == LMN_OK && v->equalised && v->scheme != SCHEME_MULTIPLY)
            status = screen_equalise(out, &problem);
        if (status != LMN_OK)
            error_in_file(error, status, name_of(v), 0, "%s", problem.message);
    }
    for (size_t i = 0; i < count; i++)
        mem_free(pixels[i].rgba);
    return status;
}

/* --- all --- */

static lmn_status make_any(mip_chain *out, const screen_values *v, lmn_error *error)
{
    int procedure = index_in(screen_procedure_names, name_of(v));
    if (procedure < 0 && strcmp(name_of(v), hatch_map_name) != 0 && !image_is_named(name_of(v)))
        return make_of_strokes(out, v, to_screen, error);
    lmn_status status = procedure >= 0 ? screen_of_procedure(out, (screen_procedure)procedure, 128, PERIOD, error)
                        : image_is_named(name_of(v)) ? make_of_picture(out, v, error)
                                                     : screen_hatch_map(out, 1024, PERIOD, true, false, error);
    out->fact = PERIOD;
    out->similar = procedure >= 0 || strcmp(name_of(v), hatch_map_name) == 0;
    /* Of these every texel has a value of its own. */
    out->nearest = procedure == PROCEDURE_ORDERED || procedure == PROCEDURE_BLUE_NOISE;
    return status;
}

lmn_status screen_make(mip_chain *out, const void *values, lmn_error *error)
{
    lmn_status status = make_any(out, values, error);
    out->stepped = true;
    return status;
}

/* --- the curve of what lies between two levels --- */

enum {
    CURVE_TONES = 64,
    CURVE_FRACTIONS = 17,
    CURVE_VALUES = 256,
    CURVE_SAMPLES = 192,
    CURVE_SIDE = 96,
    CURVE_PIXELS = CURVE_SIDE * CURVE_SIDE,
    CURVE_ANGLES = 4
};

/* Cosine and sine by which the screen of each ink is turned: turn_of_ink of surface/halftone/position.glsl. */
static const double ink_turns[CURVE_ANGLES][2] = {
    {1, 0}, {0.9659258, 0.2588190}, {0.2588190, 0.9659258}, {0.7071068, 0.7071068}};

/* As a texture unit finds it, in texels of the level. */
static double value_at(const mip_chain *c, int level, double u, double v)
{
    const uint8_t *texels = mip_layer(c, level, 0);
    int            width = mip_width(c, level), height = mip_height(c, level);
    double         x = u * width - (c->nearest ? 0 : 0.5), y = v * height - (c->nearest ? 0 : 0.5);
    int            x0 = (int)floor(x), y0 = (int)floor(y);
    double         s = c->nearest ? 0 : x - x0, t = c->nearest ? 0 : y - y0;
    int            left = (x0 + width) % width, right = (x0 + 1 + width) % width, low = (y0 + height) % height,
        high = (y0 + 1 + height) % height;
    double below = texels[low * width + left] * (1 - s) + texels[low * width + right] * s;
    double above = texels[high * width + left] * (1 - s) + texels[high * width + right] * s;
    return (below * (1 - t) + above * t) / 255;
}

static double clamped(double x)
{
    return x < 0 ? 0 : x > 1 ? 1 : x;
}

/* Ink comes and goes at the ends of the range, in all sharp schemes: surface/screen.glsl. */
static double range_ends(double value, double darkness)
{
    double t = clamped(darkness / 0.02);
    return t * t * (3 - 2 * t) * clamped(255 * (1 - value));
}

/* A pixel and its neighbours in the screen: where it is, and the ways to the next ones. */
typedef struct screen_pixel {
    double at[2], right[2];
} screen_pixel;

static double value_beside(const mip_chain *screen, double fraction, const screen_pixel *p, double x, double y)
{
    double u = p->at[0] + x * p->right[0] - y * p->right[1], v = p->at[1] + x * p->right[1] + y * p->right[0];
    u -= floor(u);
    v -= floor(v);
    double near = value_at(screen, 0, u, v);
    return fraction > 0 ? near + (value_at(screen, screen->levels > 1 ? 1 : 0, u, v) - near) * fraction : near;
}

/* half_plane_fraction of lines/stroke/coverage.glsl. */
static double half_plane(double distance, double x, double y)
{
    double a = fmax(fabs(x), fabs(y)), b = fmin(fabs(x), fabs(y)), away = fabs(distance);
    double left = 0.5 * (a + b) - away;
    double less = away <= 0.5 * (a - b) ? 0.5 - away / fmax(a, 1e-12)
                  : left <= 0           ? 0
                                        : left * left / fmax(2 * a * b, 1e-12);
    return distance < 0 ? less : 1 - less;
}

/* On the page: `ink_of_pixel`. */
static void add_contour(double inks[CURVE_VALUES], const mip_chain *screen, const screen_pixel *p)
{
    double a = value_beside(screen, 0, p, -0.5, -0.5), b = value_beside(screen, 0, p, 0.5, -0.5),
           c = value_beside(screen, 0, p, -0.5, 0.5), d = value_beside(screen, 0, p, 0.5, 0.5);
    double x = 0.5 * (b - a + d - c), y = 0.5 * (c - a + d - b), steep = fmax(hypot(x, y), 1.0 / 128);
    double value = 0.25 * (a + b + c + d);
    for (int k = 0; k < CURVE_VALUES; k++) {
        double darkness = (double)k / (CURVE_VALUES - 1);
        inks[k] +=
            half_plane((darkness - value) / steep, x / steep, y / steep) * range_ends(value, darkness) / CURVE_PIXELS;
    }
}

/* How much of the screen each darkness inks, where it is mixed from two levels. */
static void find_inks(double inks[CURVE_VALUES], const mip_chain *screen, double fraction)
{
    for (int i = 0; i < CURVE_SAMPLES * CURVE_SAMPLES; i++) {
        /* Positions that keep to no grid of the screen's. */
        screen_pixel p = {.at = {(i % CURVE_SAMPLES + 0.618 * (i / CURVE_SAMPLES % 7) / 7) / CURVE_SAMPLES,
                                 (i / CURVE_SAMPLES + 0.382) / CURVE_SAMPLES}};
        inks[(int)(value_beside(screen, fraction, &p, 0, 0) * 255 + 0.5)] += 1;
    }
    /* Half of what has a value is below it. */
    double below = 0;
    for (int k = 0; k < CURVE_VALUES; k++) {
        double own = inks[k];
        inks[k] = (below + own / 2) / (CURVE_SAMPLES * CURVE_SAMPLES);
        below += own;
    }
}

/* How much ink each darkness leaves on the page, of the rows of dots of one ink, which lie to the pixels as they do:
 * the first ones stand for all. */
static void find_inks_of_page(double inks[CURVE_VALUES], const mip_chain *screen, const screen_values *v, double texel,
                              int ink)
{
    double angle = (double)v->common.angle * (3.14159265358979 / 180), c = cos(angle), s = sin(angle);
    double cosine = c * ink_turns[ink][0] - s * ink_turns[ink][1], sine = s * ink_turns[ink][0] + c * ink_turns[ink][1];
    double step = 1 / (texel * mip_width(screen, 0));
    for (int i = 0; i < CURVE_PIXELS; i++) {
        double x = i % CURVE_SIDE + 0.5, y = i / CURVE_SIDE + 0.5;
        add_contour(inks, screen,
                    &(screen_pixel){{step * (x * cosine + y * sine), step * (y * cosine - x * sine)},
                                    {step * cosine, -step * sine}});
    }
}

/* One row: for each darkness the one that leaves so much ink. */
static void invert_row(uint8_t *row, const double inks[CURVE_VALUES])
{
    int value = 0;
    for (int i = 0; i < CURVE_TONES; i++) {
        double wanted = (double)i / (CURVE_TONES - 1);
        while (value < CURVE_VALUES - 1 && inks[value + 1] < wanted)
            value++;
        double before = inks[value], after = inks[value + (value < CURVE_VALUES - 1)];
        double rest = after > before ? clamped((wanted - before) / (after - before)) : 0;
        row[i] = (uint8_t)fmin(value + rest + 0.5, 255);
    }
    row[0] = 0;
    row[CURVE_TONES - 1] = 255;
}

lmn_status screen_make_curve(mip_chain *out, const void *values, lmn_error *error)
{
    const screen_values *v = values;
    mip_chain            screen = {0};
    lmn_status           status = make_any(&screen, values, error);
    if (status == LMN_OK)
        status = mip_chain_create(out, CURVE_TONES, CURVE_FRACTIONS, 1, 1, MIP_R8, error);
    bool page = v->common.coordinates == COORDINATES_SCREEN && screen.similar && !screen.nearest;
    for (int k = 0; status == LMN_OK && k < CURVE_FRACTIONS; k++) {
        double inks[CURVE_VALUES] = {0}, texel = fmax((double)v->scale, 0.5) / (double)screen.fact;
        if (page && k < CURVE_ANGLES)
            find_inks_of_page(inks, &screen, v, texel, k);
        else
            find_inks(inks, &screen, (double)k / (CURVE_FRACTIONS - 1));
        invert_row((uint8_t *)out->data[0] + k * CURVE_TONES, inks);
    }
    if (status == LMN_OK)
        out->clamped = true;
    mip_chain_release(&screen);
    return status;
}

static bool has_strokes(const screen_values *v)
{
    return index_in(stroke_pattern_names, name_of(v)) >= 0 || ends_in(name_of(v), stroke_endings);
}

/* One texel: no slope, no way to a stroke's middle. */
static lmn_status make_flat(mip_chain *out, mip_format format, int value, lmn_error *error)
{
    lmn_status status = mip_chain_create(out, 1, 1, 1, 1, format, error);
    if (status == LMN_OK)
        memset(out->data[0], value, mip_level_bytes(out, 0));
    return status;
}

/* Normals that were painted beside a painted screen; *there tells whether they were. */
static lmn_status make_painted_relief(mip_chain *out, const screen_values *v, bool *there, lmn_error *error)
{
    image_pixels pixels = {0};
    lmn_error    problem = {0};
    char        *path = image_is_named(name_of(v)) ? name_beside(name_of(v), "-normals") : NULL;
    *there = is_there(path);
    lmn_status status = *there ? image_load(&pixels, path, error) : LMN_OK;
    if (status == LMN_OK && *there) {
        screen_layer picture = {pixels.rgba, pixels.width, pixels.height};
        status = screen_normals_of_picture(out, &picture, (double)v->relief, side_for(&pixels), &problem);
        if (status != LMN_OK)
            error_in_file(error, status, path, 0, "%s", problem.message);
    }
    mem_free(pixels.rgba);
    mem_free(path);
    return status;
}

lmn_status screen_make_relief(mip_chain *out, const void *values, lmn_error *error)
{
    bool       there;
    lmn_status status = make_painted_relief(out, values, &there, error);
    if (there || status != LMN_OK)
        return status;
    return has_strokes(values) ? make_of_strokes(out, values, to_relief, error) : make_flat(out, MIP_RG8, 128, error);
}

lmn_status screen_make_warp(mip_chain *out, const void *values, lmn_error *error)
{
    lmn_status status =
        has_strokes(values) ? make_of_strokes(out, values, to_warp, error) : make_flat(out, MIP_RG16F, 0, error);
    out->nearest = true;
    return status;
}

void screen_describe_indication(text *out, const void *values)
{
    indication_describe(out, ((const screen_values *)values)->indication.text);
}

lmn_status screen_make_indication(mip_chain *out, const void *values, lmn_error *error)
{
    return indication_make(out, ((const screen_values *)values)->indication.text, error);
}
