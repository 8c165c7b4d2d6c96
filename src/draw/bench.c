/* Measures looks against `plain`: whole frames, each look's in turn with plain ones, in one process. One look after the
 * other, since each may need other meshes on the GPU (normals, walls, rounding), and there is one stage. */
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

typedef struct bench_job {
    const lmn_look *const *looks;
    size_t                 count;
    const lmn_look        *plain;
    const lmn_draw_desc   *desc;
    int                    repeat;
} bench_job;

/* Medians of plain frames beside each look. */
typedef struct bench_plain {
    double *ms, *cpu_ms;
} bench_plain;

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

static lmn_status series_open(series *s, lmn_renderer *r, const lmn_scene *scene, const lmn_look *look,
                              const bench_job *job, warnings *warnings, lmn_error *error)
{
    s->ms = mem_calloc((size_t)job->repeat, sizeof(double));
    s->cpu_ms = mem_calloc((size_t)job->repeat, sizeof(double));
    return s->ms && s->cpu_ms
               ? session_open(&s->session, r, scene, look, &(draw_options){.desc = job->desc}, warnings, error)
               : error_memory(error);
}

static void series_close(series *s)
{
    session_close(&s->session);
    mem_free(s->ms);
    mem_free(s->cpu_ms);
}

/* `at`: of how many looks so many are done. */
static lmn_status measure(series *look, series *plain, const bench_job *job, size_t at, lmn_error *error)
{
    const lmn_draw_desc *desc = job->desc;
    double               frames = job->repeat + WARM_UPS;
    for (int i = -WARM_UPS; i < job->repeat; i++) {
        int k = i < 0 ? 0 : i;
        time_frame(plain, &plain->ms[k], &plain->cpu_ms[k]);
        time_frame(look, &look->ms[k], &look->cpu_ms[k]);
        double done = ((double)at + (i + WARM_UPS) / frames) / (double)job->count;
        if (desc->progress && !desc->progress(done, "measuring", desc->progress_user))
            return error_set(error, LMN_CANCELLED, "cancelled");
    }
    return LMN_OK;
}

static json_t *series_json(series *s, const series *plain, int repeat)
{
    return json_pack("{s:f, s:f, s:f, s:f, s:o}", "ms", median_of(s->ms, repeat), "ratio",
                     ratio_of(s->ms, plain->ms, repeat), "cpu_ms", median_of(s->cpu_ms, repeat), "cpu_ratio",
                     ratio_of(s->cpu_ms, plain->cpu_ms, repeat), "passes", passes_of(s, repeat));
}

/* Writes a row of the table, and what plain frames beside it took. The look is opened last, so that the stage is its.
 */
static lmn_status measure_look(json_t *table, bench_plain *beside, lmn_renderer *r, const lmn_scene *scene, size_t at,
                               const bench_job *job, lmn_error *error)
{
    series     plain = {.ms = NULL}, look = {.ms = NULL};
    warnings   warnings = {0};
    int        repeat = job->repeat;
    lmn_status status = series_open(&plain, r, scene, job->plain, job, &warnings, error);
    if (status == LMN_OK)
        status = series_open(&look, r, scene, job->looks[at], job, &warnings, error);
    if (status == LMN_OK)
        status = measure(&look, &plain, job, at, error);
    if (status == LMN_OK) {
        json_object_set_new(table, job->looks[at]->name, series_json(&look, &plain, repeat));
        beside->ms[at] = median_of(plain.ms, repeat);
        beside->cpu_ms[at] = median_of(plain.cpu_ms, repeat);
    }
    series_close(&look);
    series_close(&plain);
    warnings_release(&warnings);
    return status == LMN_OK ? gpu_check(r->g, error) : status;
}

static lmn_status write_all(char **out, json_t *table, const bench_plain *beside, lmn_renderer *r, const bench_job *job,
                            lmn_error *error)
{
    const gpu_capabilities *facts = gpu_capabilities_of(r->g);
    json_t                 *root = json_object();
    json_object_set_new(root, "plain_ms", json_real(median_of(beside->ms, (int)job->count)));
    json_object_set_new(root, "plain_cpu_ms", json_real(median_of(beside->cpu_ms, (int)job->count)));
    json_object_set_new(root, "size", json_pack("[i, i]", job->desc->width, job->desc->height));
    json_object_set_new(root, "triangles", json_integer((json_int_t)r->up.triangles));
    json_object_set_new(
        root, "gpu",
        json_pack("{s:s, s:s, s:s}", "vendor", facts->vendor, "renderer", facts->renderer, "version", facts->version));
    json_object_set(root, "looks", table);
    char *dumped = json_dumps(root, JSON_INDENT(2) | JSON_REAL_PRECISION(6));
    json_decref(root);
    *out = mem_copy_text(dumped);
    free(dumped);
    return *out ? LMN_OK : error_memory(error);
}

lmn_status bench_json(char **out, lmn_renderer *r, const lmn_scene *scene, const lmn_look *const *looks, size_t count,
                      const lmn_look *plain, const lmn_draw_desc *desc, int repeat, lmn_error *error)
{
    *out = NULL;
    lmn_status status = gpu_enter(r->g, error);
    if (status != LMN_OK)
        return status;
    /* Without looks plain frames are still measured, beside themselves. */
    bench_job   job = {count ? looks : &plain, count ? count : 1, plain, desc, repeat};
    bench_plain beside = {mem_calloc(job.count, sizeof(double)), mem_calloc(job.count, sizeof(double))};
    json_t     *table = json_object();
    status = beside.ms && beside.cpu_ms && table ? LMN_OK : error_memory(error);
    for (size_t k = 0; k < job.count && status == LMN_OK; k++)
        status = measure_look(table, &beside, r, scene, k, &job, error);
    if (!count)
        json_object_clear(table);
    if (status == LMN_OK)
        status = write_all(out, table, &beside, r, &job, error);
    json_decref(table);
    mem_free(beside.ms);
    mem_free(beside.cpu_ms);
    return gpu_leave(r->g, status, error);
}
