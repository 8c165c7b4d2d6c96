/* Fuzzers: one function a parser. Each takes bytes from libFuzzer and must come to an end without a defect whatever
 * they are. */
#ifndef LIMNER_TESTS_FUZZ_H
#define LIMNER_TESTS_FUZZ_H

#include <stddef.h>
#include <stdint.h>

#include "import/import.h"

/* Changes `size` bytes in place; may use up to `most`. Returns the new size. */
typedef size_t (*fuzz_mutator)(uint8_t *bytes, size_t size, size_t most, unsigned seed);

typedef struct fuzz_target {
    const char *name;                               /* the program is called fuzz_NAME */
    void (*run)(const uint8_t *bytes, size_t size); /* a NUL byte stands behind the bytes */
    fuzz_mutator mutate;                            /* NULL: libFuzzer's own */
} fuzz_target;

/* --- models.c --- */

typedef lmn_status (*fuzz_reader)(const import_job *job, lmn_error *error);
/* Reads a model as import_file does. NULL when it is refused; end it with scene_free. */
lmn_scene *fuzz_read_model(fuzz_reader read, char up, const uint8_t *bytes, size_t size);

void fuzz_gltf(const uint8_t *bytes, size_t size);
void fuzz_stl(const uint8_t *bytes, size_t size);
void fuzz_ply(const uint8_t *bytes, size_t size);
void fuzz_obj(const uint8_t *bytes, size_t size);
void fuzz_mtl(const uint8_t *bytes, size_t size);
void fuzz_bvh(const uint8_t *bytes, size_t size);
void fuzz_cityjson(const uint8_t *bytes, size_t size);
void fuzz_geojson(const uint8_t *bytes, size_t size);
void fuzz_footprint(const uint8_t *bytes, size_t size);
void fuzz_terrain(const uint8_t *bytes, size_t size);
void fuzz_citygml(const uint8_t *bytes, size_t size);
void fuzz_gzip(const uint8_t *bytes, size_t size);
void fuzz_script(const uint8_t *bytes, size_t size);
void fuzz_csg(const uint8_t *bytes, size_t size);
void fuzz_dxf(const uint8_t *bytes, size_t size);
void fuzz_step(const uint8_t *bytes, size_t size);
void fuzz_ifc(const uint8_t *bytes, size_t size);
void fuzz_threemf(const uint8_t *bytes, size_t size);
void fuzz_stream(const uint8_t *bytes, size_t size);
void fuzz_image(const uint8_t *bytes, size_t size);
void fuzz_draco(const uint8_t *bytes, size_t size);

/* --- textures.c --- */

void fuzz_stx(const uint8_t *bytes, size_t size);
void fuzz_svg(const uint8_t *bytes, size_t size);

/* --- texts.c --- */

void fuzz_look(const uint8_t *bytes, size_t size);
void fuzz_selector(const uint8_t *bytes, size_t size);
void fuzz_cut(const uint8_t *bytes, size_t size);
void fuzz_set(const uint8_t *bytes, size_t size);
void fuzz_sheet(const uint8_t *bytes, size_t size);

/* --- expressions.c --- */

void fuzz_depict(const uint8_t *bytes, size_t size);

/* --- drawing.c --- */

/* The first DRAWING_CHOICES bytes choose what is done, the rest is the model. */
enum { DRAWING_CHOICES = 8 };
void fuzz_draw(const uint8_t *bytes, size_t size);

/* --- mutate.c, mutate_gltf.c, mutate_csg.c --- */

/* Numbers at random from a state that each call moves on; below `limit`, which is above 0. */
uint32_t fuzz_random(uint32_t *state, uint32_t limit);
/* A number as files have it, often an extreme one. */
double fuzz_number(uint32_t *state, double before);

size_t fuzz_mutate_gltf(uint8_t *bytes, size_t size, size_t most, unsigned seed);
size_t fuzz_mutate_glb(uint8_t *bytes, size_t size, size_t most, unsigned seed);
size_t fuzz_mutate_csg(uint8_t *bytes, size_t size, size_t most, unsigned seed);
size_t fuzz_mutate_look(uint8_t *bytes, size_t size, size_t most, unsigned seed);
size_t fuzz_mutate_draw(uint8_t *bytes, size_t size, size_t most, unsigned seed);

/* libFuzzer's own change of bytes. */
size_t LLVMFuzzerMutate(uint8_t *bytes, size_t size, size_t most);

#endif
