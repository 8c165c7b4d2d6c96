/* The faces that libFuzzer sees. Which parser is fuzzed follows from the name that the program is called by. */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "base/memory.h"
#include "fuzz.h"
#include "limner/task.h"

int    LLVMFuzzerInitialize(int *count, char ***arguments);
int    LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size);
size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t most, unsigned seed);

static const fuzz_target targets[] = {
    {"gltf", fuzz_gltf, fuzz_mutate_gltf},
    {"glb", fuzz_gltf, fuzz_mutate_glb},
    {"stl", fuzz_stl, NULL},
    {"ply", fuzz_ply, NULL},
    {"obj", fuzz_obj, NULL},
    {"mtl", fuzz_mtl, NULL},
    {"bvh", fuzz_bvh, NULL},
    {"cityjson", fuzz_cityjson, NULL},
    {"geojson", fuzz_geojson, NULL},
    {"footprint", fuzz_footprint, NULL},
    {"terrain", fuzz_terrain, NULL},
    {"citygml", fuzz_citygml, NULL},
    {"gzip", fuzz_gzip, NULL},
    {"script", fuzz_script, NULL},
    {"csg", fuzz_csg, fuzz_mutate_csg},
    {"dxf", fuzz_dxf, NULL},
    {"stream", fuzz_stream, NULL},
    {"step", fuzz_step, NULL},
    {"ifc", fuzz_ifc, NULL},
    {"threemf", fuzz_threemf, NULL},
    {"image", fuzz_image, NULL},
    {"draco", fuzz_draco, NULL},
    {"stx", fuzz_stx, NULL},
    {"svg", fuzz_svg, NULL},
    {"look", fuzz_look, fuzz_mutate_look},
    {"selector", fuzz_selector, NULL},
    {"cut", fuzz_cut, NULL},
    {"set", fuzz_set, NULL},
    {"sheet", fuzz_sheet, NULL},
    {"depict", fuzz_depict, NULL},
    {"draw", fuzz_draw, fuzz_mutate_draw},
};
enum { TARGETS = sizeof targets / sizeof *targets };

/* Set once, by the program's name. */
static const fuzz_target *target;

/* Decoders run in this process, where the sanitizers and the fuzzer see them. */
static void begin_task(void)
{
    lmn_task     *task;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.files = LMN_FILES_ANY;
    desc.in_process = true;
    if (lmn_task_begin(&task, &desc, NULL) != LMN_OK)
        abort();
}

int LLVMFuzzerInitialize(int *count, char ***arguments)
{
    setenv("PATH", "/nowhere", 1); /* openscad is not what is tested */
    (void)count;
    const char *slash = strrchr((*arguments)[0], '/'), *name = slash ? slash + 1 : (*arguments)[0];
    for (int i = 0; i < TARGETS; i++)
        if (strncmp(name, "fuzz_", 5) == 0 && strcmp(name + 5, targets[i].name) == 0)
            target = &targets[i];
    if (target) {
        begin_task();
        return 0;
    }
    fprintf(stderr, "call this program by the name of a fuzzer:");
    for (int i = 0; i < TARGETS; i++)
        fprintf(stderr, " fuzz_%s", targets[i].name);
    fprintf(stderr, "\n");
    exit(1);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t size)
{
    /* Readers may rely on the NUL byte behind a file. */
    uint8_t *copy = mem_alloc(size + 1);
    if (!copy)
        return 0;
    if (size > 0)
        memcpy(copy, bytes, size);
    copy[size] = '\0';
    target->run(copy, size);
    mem_free(copy);
    return 0;
}

size_t LLVMFuzzerCustomMutator(uint8_t *bytes, size_t size, size_t most, unsigned seed)
{
    return target->mutate ? target->mutate(bytes, size, most, seed) : LLVMFuzzerMutate(bytes, size, most);
}
