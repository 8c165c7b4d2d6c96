#include "frame/capacity.h"

#include <math.h>

#include "base/limits.h"

static int limit_of(const gpu *g)
{
    const gpu_capabilities *facts = gpu_capabilities_of(g);
    return facts->max_texture < LIMIT_PICTURE_SIDE ? facts->max_texture : LIMIT_PICTURE_SIDE;
}

lmn_status capacity_check_sides(gpu *g, int width, int height, int side, lmn_error *error)
{
    int limit = limit_of(g), longer = width > height ? width : height;
    if (longer * side <= limit)
        return LMN_OK;
    double fraction = (double)(limit / side) / longer;
    error_set(error, LMN_LIMIT,
              "a picture of %dx%d pixels with %d samples a pixel needs %d pixels a side, the limit is %d", width,
              height, side * side, longer * side, limit);
    error_hint(error, "with %d samples at most --size %.0fx%.0f, or fewer --samples", side * side,
               fmax(floor(width * fraction), 1), fmax(floor(height * fraction), 1));
    return LMN_LIMIT;
}

/* The pictures of one pass, beside its depth. */
typedef struct capacity_pass {
    gpu_format formats[GPU_COLOURS_MAX];
    int        count, width, height;
} capacity_pass;

/* The page; what the figures take that are not drawn straight onto it; what solids are gathered in; and what maps
 * take. */
enum { PASSES = 4 };

static bool has_solids(const plan *p)
{
    for (size_t i = 0; i < p->scene->part_count; i++)
        if (p->selected[i] && p->scene->nodes[p->scene->parts[i].node].solid != NONE)
            return true;
    return false;
}

static void add_format(capacity_pass *pass, gpu_format format, bool wanted)
{
    if (wanted)
        pass->formats[pass->count++] = format;
}

/* The channels as src/frame/raster.c has them, and fields of what perturbs. */
static void list_passes(capacity_pass out[PASSES], const plan *p, const capacity_options *w)
{
    unsigned channels = 0;
    bool     perturbed = false;
    int      width = w->width * w->side, height = w->height * w->side;
    for (size_t i = 0; i < p->figure_count; i++) {
        channels |= p->figures[i].direct ? 0 : p->figures[i].channels;
        perturbed = perturbed || rule_use(p->figures[i].rule, KIND_PERTURB);
    }
    for (int i = 0; i < PASSES; i++)
        out[i] = (capacity_pass){.width = i < 3 ? width : w->width, .height = i < 3 ? height : w->height};
    add_format(&out[0], GPU_RGBA16F, true);
    add_format(&out[1], GPU_RGBA32F, (channels & CHANNEL_NORMAL_DEPTH) || perturbed);
    add_format(&out[1], GPU_RG32UI, channels & CHANNEL_ID);
    add_format(&out[1], GPU_RGBA16F, channels & CHANNEL_ALBEDO);
    add_format(&out[1], GPU_RGBA16F, channels & CHANNEL_SHADE);
    add_format(&out[1], GPU_RGBA32F, channels & CHANNEL_REST);
    add_format(&out[1], GPU_RGBA32F, channels & CHANNEL_VELOCITY);
    add_format(&out[1], GPU_RGBA8, channels & CHANNEL_DETAIL);
    add_format(&out[2], GPU_RGBA32UI, has_solids(p));
    add_format(&out[3], GPU_RGBA32F, w->maps);
    add_format(&out[3], GPU_RG32UI, w->maps);
}

/* Does the driver say that it can? */
static bool is_possible(gpu *g, const plan *p, const capacity_options *w)
{
    capacity_pass passes[PASSES];
    list_passes(passes, p, w);
    for (int i = 0; i < PASSES; i++)
        for (int k = 0; k < passes[i].count; k++)
            if (!gpu_target_possible(g, passes[i].width, passes[i].height, passes[i].formats[k]))
                return false;
    return true;
}

/* Can it? The pictures go back to the pool. */
static bool has_pass(gpu *g, const capacity_pass *r, lmn_error *error)
{
    gpu_pass pass = {0};
    for (int i = 0; i < r->count; i++)
        pass.colours[pass.colour_count++] = gpu_target_acquire(g, r->width, r->height, r->formats[i]);
    pass.depth = gpu_target_acquire(g, r->width, r->height, GPU_DEPTH32F);
    if (!gpu_failed(g))
        gpu_pass_begin(g, &pass);
    for (int i = 0; i < r->count; i++)
        gpu_target_release(g, pass.colours[i]);
    gpu_target_release(g, pass.depth);
    return gpu_check(g, error) == LMN_OK;
}

/* *error is set when the driver failed, and not when it says beforehand that it cannot. */
static bool has_capacity(gpu *g, const plan *p, const capacity_options *w, lmn_error *error)
{
    capacity_pass passes[PASSES];
    list_passes(passes, p, w);
    bool fits = is_possible(g, p, w);
    for (int i = 0; i < PASSES && fits; i++)
        fits = passes[i].count == 0 || has_pass(g, &passes[i], error);
    return fits;
}

static capacity_options smaller(const capacity_options *w, double fraction)
{
    capacity_options s = *w;
    s.width = (int)fmax(floor(w->width * fraction), 1);
    s.height = (int)fmax(floor(w->height * fraction), 1);
    return s;
}

/* The largest fraction of the size that there is room for, nearly: as the driver says, or where it says too readily,
 * the first half that is true. */
static double find_fraction(gpu *g, const plan *p, const capacity_options *options)
{
    enum { STEPS = 64, HALVES = 6 };
    int low = 0, high = STEPS;
    while (!is_possible(g, p, options) && high - low > 1) {
        int              middle = (low + high) / 2;
        capacity_options less = smaller(options, (double)middle / STEPS);
        if (is_possible(g, p, &less))
            low = middle;
        else
            high = middle;
    }
    if (high < STEPS || low > 0)
        return (double)low / STEPS;
    double fraction = 0.5;
    for (int i = 0; i < HALVES; i++, fraction /= 2) {
        capacity_options less = smaller(options, fraction);
        bool             fits = has_capacity(g, p, &less, NULL);
        gpu_targets_trim(g);
        if (fits)
            return fraction;
    }
    return 0;
}

/* Pixels that every driver can draw, when there is memory. */
enum { SMALL = 1 << 20 };

lmn_status capacity_check(gpu *g, const plan *p, const capacity_options *options, lmn_error *error)
{
    lmn_error problem = {0};
    if (has_capacity(g, p, options, &problem))
        return LMN_OK;
    gpu_targets_trim(g);
    int samples = options->side * options->side;
    if ((int64_t)options->width * options->height * samples <= SMALL) {
        if (problem.status == LMN_OK)
            error_set(&problem, LMN_MEMORY, "the driver has no memory for a picture of %dx%d pixels", options->width,
                      options->height);
        if (error)
            *error = problem;
        return problem.status;
    }
    double fraction = find_fraction(g, p, options);
    error_set(error, LMN_LIMIT,
              "a picture of %dx%d pixels with %d sample%s a pixel is larger than the driver can draw with this look",
              options->width, options->height, samples, samples == 1 ? "" : "s");
    if (fraction > 0)
        error_hint(error, "with %d sample%s --size %dx%d can be drawn%s", samples, samples == 1 ? "" : "s",
                   smaller(options, fraction).width, smaller(options, fraction).height,
                   samples > 1 ? ", or more with fewer --samples" : "");
    else
        error_hint(error, "ask for a smaller --size%s", samples > 1 ? " or fewer --samples" : "");
    return LMN_LIMIT;
}
