/* A soak: many drawings of mixed models with mixed looks in one process, as pictures and as vectors; memory must stay
 * where it was. soak N EXAMPLES [FOLDER…] Resident memory is printed every 500 drawings. There are so few models that
 * by the first of these each was drawn with every look: what the driver compiles for a pair it keeps, which is growth,
 * but no leak. Growth beyond 2 % since then fails. */
#define _GNU_SOURCE
#include <ftw.h>
#include <malloc.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <limner/limner.h>

enum { FILES_MOST = 200, EVERY = 500, FILE_MOST = 300000 /* bytes; larger ones take long */, TRIANGLES_MOST = 3000 };

/* nftw has no position for a user's pointer. */
static char *files[FILES_MOST];
static int   file_count;

static int note_file(const char *path, const struct stat *facts, int kind, struct FTW *where)
{
    static const char *const endings[] = {".glb", ".gltf", ".obj", ".stl", ".ply", ".csg"};
    (void)where;
    const char *dot = strrchr(path, '.');
    for (size_t i = 0; dot && i < sizeof endings / sizeof *endings; i++)
        if (kind == FTW_F && facts->st_size <= FILE_MOST && strcmp(dot, endings[i]) == 0 && file_count < FILES_MOST)
            files[file_count++] = strdup(path);
    return 0;
}

/* Keeps so many, spread evenly. */
static void thin_out(int most)
{
    if (most < 1 || file_count <= most)
        return;
    for (int i = 0, next = 0; i < file_count; i++)
        if (next < most && i == next * file_count / most)
            files[next++] = files[i];
        else
            free(files[i]);
    file_count = most;
}

static int compare(const void *a, const void *b)
{
    return strcmp(*(char *const *)a, *(char *const *)b);
}

/* Resident memory in KiB. */
static long resident(void)
{
    long  pages = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    malloc_trim(0);
    if (file && fscanf(file, "%*d %ld", &pages) != 1)
        pages = 0;
    if (file)
        fclose(file);
    return pages * (sysconf(_SC_PAGESIZE) / 1024);
}

/* Is it small enough to be drawn thousands of times? */
static bool is_small(const char *path)
{
    lmn_scene *scene = NULL;
    lmn_error  error;
    bool       small = false;
    if (lmn_scene_create(&scene, &error) == LMN_OK && lmn_scene_add_file(scene, path, NULL, &error) == LMN_OK) {
        const lmn_scene_info info = lmn_scene_info_of(scene);
        small = info.triangles > 0 && info.triangles <= TRIANGLES_MOST;
    }
    lmn_scene_destroy(&scene);
    return small;
}

static lmn_status draw_once(lmn_renderer *renderer, const char *path, const char *look_name, long n, lmn_error *error)
{
    lmn_scene    *scene = NULL;
    lmn_look     *look = NULL;
    lmn_drawing  *drawing = NULL;
    lmn_sheet    *sheet = NULL;
    lmn_draw_desc desc = LMN_DRAW_DESC_INIT;
    desc.width = desc.height = 64;
    desc.dpi = 96;
    desc.view = (lmn_view)(n % 7);
    desc.maps = n % 5 == 0;
    lmn_status status = lmn_scene_create(&scene, error);
    if (status == LMN_OK)
        status = lmn_scene_add_file(scene, path, NULL, error);
    if (status == LMN_OK)
        status = lmn_look_load(&look, look_name, error);
    /* Few strokes on surfaces, where a look has any: what is made of them is not what takes memory for good. */
    lmn_error unknown;
    if (status == LMN_OK)
        lmn_look_set(look, "surface.count", "300", &unknown);
    if (status == LMN_OK && n % 4 == 3) {
        static const char *const formats[] = {"svg", "pdf", "dxf"};
        status = lmn_draw_sheet(&sheet, n % 8 == 3 ? renderer : NULL, scene, look, &desc, NULL, error);
        if (status == LMN_OK)
            status = lmn_sheet_write(sheet, "/dev/null", formats[n / 4 % 3], NULL, error);
        lmn_text_free(lmn_sheet_report_json(sheet));
    } else if (status == LMN_OK) {
        status = lmn_draw(&drawing, renderer, scene, look, &desc, error);
        if (status == LMN_OK)
            status = lmn_drawing_write(drawing, "/dev/null", "png", NULL, error);
        lmn_text_free(lmn_drawing_report_json(drawing));
    }
    lmn_sheet_destroy(&sheet);
    lmn_drawing_destroy(&drawing);
    lmn_look_destroy(&look);
    lmn_scene_destroy(&scene);
    return status;
}

static int soak(lmn_renderer *renderer, long count)
{
    long first = 0, last = 0, failed = 0;
    for (long n = 0; n < count; n++) {
        /* All pairs come, each once in as many drawings as there are. */
        const char *path = files[n % file_count],
                   *look = lmn_look_name_at((size_t)(n + n / file_count) % lmn_look_count());
        lmn_error error;
        if (draw_once(renderer, path, look, n, &error) != LMN_OK && failed++ < 10)
            printf("%s with %s: %s\n", path, look, error.message);
        if ((n + 1) % EVERY != 0)
            continue;
        last = resident();
        first = first ? first : last;
        printf("%6ld drawings: %ld KiB, %+.2f %%\n", n + 1, last, 100.0 * (double)(last - first) / (double)first);
        fflush(stdout);
    }
    printf("%ld drawings of %d models with %zu looks, %ld failed\n", count, file_count, lmn_look_count(), failed);
    return failed > 0 || (double)last > (double)first * 1.02;
}

int main(int count, char **words)
{
    if (count < 3) {
        fprintf(stderr, "usage: soak N EXAMPLES [FOLDER…]\n");
        return 2;
    }
    for (int i = 2; i < count; i++)
        nftw(words[i], note_file, 16, FTW_PHYS);
    int small = 0;
    for (int i = 0; i < file_count; i++)
        if (is_small(files[i]))
            files[small++] = files[i];
        else
            free(files[i]);
    file_count = small;
    qsort(files, (size_t)file_count, sizeof *files, compare);
    thin_out(EVERY / (int)lmn_look_count());
    lmn_renderer *renderer = NULL;
    lmn_error     error;
    if (file_count == 0 || lmn_renderer_create(&renderer, NULL, &error) != LMN_OK) {
        fprintf(stderr, "nothing to draw, or nothing to draw with\n");
        return 2;
    }
    const int result = soak(renderer, atol(words[1]));
    lmn_renderer_destroy(&renderer);
    for (int i = 0; i < file_count; i++)
        free(files[i]);
    return result;
}
