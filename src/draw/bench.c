/* Measures looks against `plain`: whole frames, drawn in turn, in one process. */
#include <jansson.h>
#include <stdlib.h>
#include <string.h>

#include "base/clock.h"
#include "base/memory.h"
#include "draw/drawing.h"

enum { WARM_UPS = 2 };

typedef struct series {
    session session;
    double *ms, *cpu_ms; /* of each frame: as time passes, and as all threads compute */
} series;

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median_of(const double *values, int count)
{
    double *sorted = mem_copy(values, sizeof(double) * (size_t)count);
    if (!sorted)
        return 0;
    qsort(sorted, (size_t)count, sizeof *sorted, compare);
    double middle = count % 2 ? sorted[count / 2] : (sorted[count / 2 - 1] + sorted[count / 2]) / 2;
    mem_free(sorted);
    return middle;
}

static void time_frame(series *s, double *ms, double *cpu_ms)
{
    gpu_finish(s->session.renderer->g);
    double start = clock_ms(), cpu_start = clock_cpu_ms();
    frame_draw(&s->session.frame, s->session.out);
    gpu_finish(s->session.renderer->g);
    *ms = clock_ms() - start;
    *cpu_ms = clock_cpu_ms() - cpu_start;
}

static json_t *passes_of(series *s, int repeat)
{
    frame *f = &s->session.frame;
    f->profile.on = true;
    for (int i = 0; i < repeat; i++)
        frame_draw(f, s->session.out);
    json_t *array = json_array();
    for (size_t i = 0; i < f->profile.count; i++)
        json_array_append_new(array, json_pack("{s:s, s:f, s:f}", "name", f->profile.times[i].name, "ms",
                                               f->profile.times[i].ms / repeat, "cpu_ms",
                                               f->profile.times[i].cpu_ms / repeat));
    return array;
}

/* Median of the ratios of neighbouring frames. */
static double ratio_of(const double *ms, const double *plain, int repeat)
{
    double *ratios = mem_alloc(sizeof(double) * (size_t)repeat);
    for (int i = 0; ratios && i < repeat; i++)
        ratios[i] = ms[i] / plain[i];
    double middle = ratios ? median_of(ratios, repeat) : 0;
    mem_free(ratios);
    return middle;
}

static json_t *series_json(series *s, const series *plain, int repeat)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:o}", "ms", median_of(s->ms, repeat), "ratio",
                     ratio_of(s->ms, plain->ms, repeat), "cpu_ms", median_of(s->cpu_ms, repeat), "cpu_ratio",
                     ratio_of(s->cpu_ms, plain->cpu_ms, repeat), "passes", passes_of(s, repeat));
}

static lmn_status measure(char **out, series *all, size_t count, const lmn_look *const *looks, lmn_renderer *r,
                          const lmn_draw_desc *desc, int repeat, lmn_error *error)
{
    for (int i = -WARM_UPS; i < repeat; i++)
        for (size_t k = 0; k < count; k++) {
            int at = i < 0 ? 0 : i;
            time_frame(&all[k], &all[k].ms[at], &all[k].cpu_ms[at]);
            if (desc->progress &&
                !desc->progress((double)(i + WARM_UPS) / (repeat + WARM_UPS), "measuring", desc->progress_user))
                return error_set(error, LMN_CANCELLED, "cancelled");
        }
    const gpu_capabilities *facts = gpu_capabilities_of(r->g);
    json_t                 *root = json_object(), *table = json_object();
    json_object_set_new(root, "plain_ms", json_real(median_of(all[0].ms, repeat)));
    json_object_set_new(root, "plain_cpu_ms", json_real(median_of(all[0].cpu_ms, repeat)));
    json_object_set_new(root, "size", json_pack("[i, i]", desc->width, desc->height));
    json_object_set_new(root, "triangles", json_integer((json_int_t)r->up.triangles));
    json_object_set_new(
        root, "gpu",
        json_pack("{s:s, s:s, s:s}", "vendor", facts->vendor, "renderer", facts->renderer, "version", facts->version));
    for (size_t k = 1; k < count; k++)
        json_object_set_new(table, looks[k - 1]->name, series_json(&all[k], &all[0], repeat));
    json_object_set_new(root, "looks", table);
    char *dumped = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(6));
    json_decref(root);
    *out = mem_copy_text(dumped);
    free(dumped);
    return *out ? gpu_check(r->g, error) : error_memory(error);
}

lmn_status bench_json(char **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *const *looks, size_t count,
                      const lmn_look *plain, const lmn_draw_desc *desc, int repeat, lmn_error *error)
{
    *out = NULL;
    lmn_status status = gpu_enter(r->g, error);
    if (status != LMN_OK)
        return status;
    series *all = mem_calloc(count + 1, sizeof *all);
    status = all ? LMN_OK : error_memory(error);
    warnings warnings = {0};
    for (size_t k = 0; k <= count && status == LMN_OK; k++) {
        all[k].ms = mem_calloc((size_t)repeat, sizeof(double));
        all[k].cpu_ms = mem_calloc((size_t)repeat, sizeof(double));
        status = all[k].ms && all[k].cpu_ms ? session_open(&all[k].session, r, scene, k ? looks[k - 1] : plain,
                                                           &(draw_options){.desc = desc}, &warnings, error)
                                            : error_memory(error);
    }
    if (status == LMN_OK)
        status = measure(out, all, count + 1, looks, r, desc, repeat, error);
    for (size_t k = 0; all && k <= count; k++) {
        session_close(&all[k].session);
        mem_free(all[k].ms);
        mem_free(all[k].cpu_ms);
    }
    mem_free(all);
    warnings_release(&warnings);
    return gpu_leave(r->g, status, error);
}
