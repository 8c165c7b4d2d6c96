/* What the import tests share: finding the data, temporary files, building GLB bytes, loading. */
#ifndef TESTS_IMPORT_SUPPORT_H
#define TESTS_IMPORT_SUPPORT_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

#include "base/file.h"
#include "base/memory.h"
#include "import/import.h"
#include "limner/scene.h"
#include "limner/task.h"
#include "scene/mesh.h"
#include "scene/scene.h"

#ifndef LIMNER_SOURCE_DIR
#define LIMNER_SOURCE_DIR "."
#endif

/* The folder of models, or NULL (after saying so) when it is not there. */
static inline const char *data_folder(void)
{
    static char path[1024];
    const char *given = getenv("LIMNER_DATA");
    if (given)
        snprintf(path, sizeof path, "%s", given);
    else
        snprintf(path, sizeof path, "%s/../shared/data", LIMNER_SOURCE_DIR);
    if (access(path, R_OK) == 0)
        return path;
    printf("skipped: no models at %s (set LIMNER_DATA)\n", path);
    return NULL;
}

static inline const char *temp_folder(void)
{
    static char path[64];
    if (!path[0]) {
        snprintf(path, sizeof path, "/tmp/limner-test-XXXXXX");
        assert_non_null(mkdtemp(path));
    }
    return path;
}

/* Writes bytes to a file of the temporary folder; the path lives until the next call. */
static inline const char *temp_file(const char *name, const void *bytes, size_t size)
{
    static char path[256];
    snprintf(path, sizeof path, "%s/%s", temp_folder(), name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    fclose(f);
    return path;
}

static inline int remove_temp_folder(void **state)
{
    char command[128];
    (void)state;
    snprintf(command, sizeof command, "rm -rf %s", temp_folder());
    return system(command) < 0;
}

static inline lmn_scene *load_or_fail(const char *path)
{
    lmn_scene *scene = NULL;
    lmn_error  error = {0};
    assert_int_equal(lmn_scene_create(&scene, &error), LMN_OK);
    lmn_status status = lmn_scene_add_file(scene, path, NULL, &error);
    if (status != LMN_OK)
        print_error("%s: %s\n", path, error.message);
    assert_int_equal(status, LMN_OK);
    return scene;
}

/* Loads and gives the status; an error must have words and leave the scene empty. */
static inline lmn_status load_status(const char *path, lmn_error *error)
{
    lmn_scene *scene = NULL;
    memset(error, 0, sizeof *error);
    assert_int_equal(lmn_scene_create(&scene, NULL), LMN_OK);
    lmn_status status = lmn_scene_add_file(scene, path, NULL, error);
    if (status != LMN_OK) {
        assert_int_equal(error->status, status);
        assert_true(error->message[0] != '\0');
        assert_int_equal(scene->part_count, 0);
        assert_int_equal(scene->node_count, 0);
    }
    lmn_scene_destroy(&scene);
    return status;
}

static inline bool has_warning(const lmn_scene *scene, warning_code code)
{
    for (size_t i = 0; i < scene->warnings.count; i++)
        if (scene->warnings.items[i].code == code)
            return true;
    return false;
}

/* --- GLB building --------------------------------------------------------------------------------------- */

typedef struct glb {
    unsigned char bin[65536];
    size_t        bin_size;
    char          json[16384];
} glb;

/* Appends to the binary chunk, aligned to four bytes; returns the offset. */
static inline size_t glb_put(glb *g, const void *bytes, size_t size)
{
    size_t at = (g->bin_size + 3) & ~(size_t)3;
    assert_true(at + size <= sizeof g->bin);
    memset(g->bin + g->bin_size, 0, at - g->bin_size);
    memcpy(g->bin + at, bytes, size);
    g->bin_size = at + size;
    return at;
}

static inline void put_u32(unsigned char *to, uint32_t value)
{
    memcpy(to, &value, 4);
}

static inline size_t glb_bytes(const glb *g, unsigned char *out)
{
    size_t json = strlen(g->json), json_padded = (json + 3) & ~(size_t)3, bin_padded = (g->bin_size + 3) & ~(size_t)3;
    size_t total = 12 + 8 + json_padded + (g->bin_size ? 8 + bin_padded : 0);
    memcpy(out, "glTF", 4);
    put_u32(out + 4, 2);
    put_u32(out + 8, (uint32_t)total);
    put_u32(out + 12, (uint32_t)json_padded);
    memcpy(out + 16, "JSON", 4);
    memset(out + 20, ' ', json_padded);
    memcpy(out + 20, g->json, json);
    if (g->bin_size) {
        unsigned char *chunk = out + 20 + json_padded;
        put_u32(chunk, (uint32_t)bin_padded);
        memcpy(chunk + 4, "BIN\0", 4);
        memset(chunk + 8, 0, bin_padded);
        memcpy(chunk + 8, g->bin, g->bin_size);
    }
    return total;
}

static inline const char *glb_file(const glb *g, const char *name)
{
    static unsigned char bytes[sizeof(glb) + 64];
    return temp_file(name, bytes, glb_bytes(g, bytes));
}

#endif
