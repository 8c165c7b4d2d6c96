/* Random cancels: reading and drawing are stopped at random moments, and then done again. A stopped call says so and
 * soon, and leaves nothing behind: the next picture of the same renderer is the one that was never stopped, byte for
 * byte. cancels N EXAMPLES [MODEL…] Prints how long calls took to listen. Fails when a status or a picture is wrong, or
 * when one of a hundred took longer than ALLOWED_MS; the driver's compiler is the one thing that cannot be stopped, so
 * programs are compiled before. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include <limner/limner.h>

enum { ALLOWED_MS = 300, MODELS_MOST = 32, SIDE = 1200 };

static const char *const looks[] = {"edges", "pencil", "hatch", "blueprint", "sketch", "line", "technical", "stipple"};
enum { LOOKS = sizeof looks / sizeof *looks };

static double now_ms(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (double)t.tv_sec * 1e3 + (double)t.tv_nsec / 1e6;
}

static uint32_t random_state = 12345;

static uint32_t random_below(uint32_t n)
{
    random_state = random_state * 1664525u + 1013904223u;
    return (uint32_t)((uint64_t)random_state * n >> 32);
}

/* When to say no; 0: never. */
static bool go_on(double fraction, const char *stage, void *user)
{
    const double *moment = user;
    (void)fraction, (void)stage;
    return *moment == 0 || now_ms() < *moment;
}

typedef struct job {
    const char   *model, *look;
    bool          vectors;
    lmn_renderer *renderer;
    double        moment;
} job;

/* Hash of all that the drawing gives. */
static lmn_status run(job *j, uint64_t *hash, lmn_error *error)
{
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_sheet    *sheet = NULL;
    lmn_load_desc load = LMN_LOAD_DESC_INIT;
    lmn_draw_desc draw = LMN_DRAW_DESC_INIT;
    load.progress = draw.progress = go_on;
    load.progress_user = draw.progress_user = &j->moment;
    draw.width = draw.height = SIDE;
    draw.dpi = 96;
    lmn_status status = lmn_look_load(&look, j->look, error);
    if (status == LMN_OK)
        status = lmn_scene_create(&scene, error);
    if (status == LMN_OK)
        status = lmn_scene_add_file(scene, j->model, &load, error);
    if (status == LMN_OK)
        status = j->vectors ? lmn_draw_sheet(&sheet, j->renderer, scene, look, &draw, NULL, error)
                            : lmn_draw(&drawing, j->renderer, scene, look, &draw, error);
    *hash = 1469598103934665603u;
    const uint8_t *pixels = drawing ? lmn_drawing_pixels(drawing, NULL, NULL) : NULL;
    for (size_t i = 0; pixels && i < (size_t)SIDE * SIDE * 4; i++)
        *hash = (*hash ^ pixels[i]) * 1099511628211u;
    if ((status != LMN_OK) != (!drawing && !sheet))
        status = LMN_INTERNAL; /* a result and an error, or neither */
    lmn_drawing_destroy(&drawing);
    lmn_sheet_destroy(&sheet);
    lmn_scene_destroy(&scene);
    lmn_look_destroy(&look);
    return status;
}

static int compare(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return x < y ? -1 : x > y;
}

/* The whole pair once or twice, then `count` times stopped at random, then whole again. Returns how many were
 * wrong. */
static int test_pair(job *j, int count, double *latencies, size_t *latency_count)
{
    uint64_t  wanted, got;
    lmn_error error;
    int       wrong = 0;
    j->moment = 0;
    lmn_status status = run(j, &wanted, &error);
    if (status != LMN_OK) { /* what this look refuses of this model is no subject here */
        return 0;
    }
    double start = now_ms();
    status = run(j, &wanted, &error);
    double whole = now_ms() - start;
    for (int i = 0; i < count && status == LMN_OK; i++) {
        j->moment = now_ms() + whole * random_below(1000) / 1000.0;
        lmn_status stopped = run(j, &got, &error);
        double     late = now_ms() - j->moment;
        if (stopped == LMN_CANCELLED) {
            latencies[(*latency_count)++] = late;
            if (late > ALLOWED_MS)
                printf("%s, %s%s: %.0f ms after the cancel\n", j->model, j->look, j->vectors ? ", vectors" : "", late);
        } else if (stopped != LMN_OK) {
            printf("%s, %s%s: status %d: %s\n", j->model, j->look, j->vectors ? ", vectors" : "", (int)stopped,
                   error.message);
            wrong++;
        }
    }
    j->moment = 0;
    status = run(j, &got, &error);
    if (status != LMN_OK || (!j->vectors && got != wanted)) {
        printf("%s, %s: the picture after the cancels is %s\n", j->model, j->look,
               status == LMN_OK ? "another one" : error.message);
        wrong++;
    }
    return wrong;
}

int main(int count, char **arguments)
{
    static const char *const own[] = {"spot.obj",      "pump.glb",  "crank.glb",
                                      "csg/valve.csg", "house.glb", "csg/widget.csg"};
    char                     paths[MODELS_MOST][1024];
    int                      models = 0, wrong = 0, wanted = count > 2 ? (int)strtol(arguments[1], NULL, 10) : 0;
    if (wanted < 1) {
        fprintf(stderr, "usage: cancels N EXAMPLES [MODEL…]\n");
        return 1;
    }
    for (size_t i = 0; i < sizeof own / sizeof *own; i++)
        snprintf(paths[models++], sizeof *paths, "%s/%s", arguments[2], own[i]);
    for (int i = 3; i < count && models < MODELS_MOST; i++)
        snprintf(paths[models++], sizeof *paths, "%s", arguments[i]);
    enum { AT_ONCE = 10 };
    double   *latencies = calloc((size_t)wanted + AT_ONCE, sizeof *latencies);
    size_t    latency_count = 0;
    lmn_error error;
    job       j = {0};
    if (!latencies || lmn_renderer_create(&j.renderer, NULL, &error) != LMN_OK) {
        fprintf(stderr, "%s\n", latencies ? error.message : "out of memory");
        return 1;
    }
    for (int done = 0, pair = 0; done < wanted; pair++) {
        int now = wanted - done < AT_ONCE ? wanted - done : AT_ONCE;
        j.model = paths[pair % models];
        j.look = looks[(pair + pair / models) % LOOKS];
        j.vectors = pair % 3 == 2;
        wrong += test_pair(&j, now, latencies, &latency_count);
        done += now;
    }
    lmn_renderer_destroy(&j.renderer);
    qsort(latencies, latency_count, sizeof *latencies, compare);
    if (latency_count) {
        double most = latencies[latency_count - 1], high = latencies[latency_count * 99 / 100];
        printf("%zu cancels heard: median %.1f ms, 99 %% %.1f ms, most %.1f ms; %d wrong\n", latency_count,
               latencies[latency_count / 2], high, most, wrong);
        wrong += high > ALLOWED_MS;
    }
    free(latencies);
    return wrong != 0;
}
