/* The readers against the collection of real models: counts from its index, compressed against plain, damaged
 * files, cut files, and memory that runs out. */
#include "import_support.h"

#include <dirent.h>
#include <math.h>
#include <sys/stat.h>

#include <jansson.h>

static uint64_t own_triangles(const lmn_scene *s)
{
    uint64_t count = 0;
    for (size_t i = 0; i < s->mesh_count; i++)
        count += mesh_triangle_count(&s->meshes[i]);
    return count;
}

/* Triangles that the scene's check left out, from its warnings. */
static uint64_t left_out(const lmn_scene *s)
{
    uint64_t count = 0;
    for (size_t i = 0; i < s->warnings.count; i++)
        if (strstr(s->warnings.items[i].text, "triangles") && strstr(s->warnings.items[i].text, "left out"))
            count += strtoull(s->warnings.items[i].text, NULL, 10);
    return count;
}

/* The index counts polygons for these two, not triangles. */
static uint64_t as_triangles(const char *path, uint64_t faces)
{
    if (strcmp(path, "mesh/cube.ply") == 0)
        return faces * 2;
    return strcmp(path, "mesh/dodecahedron.ply") == 0 ? faces * 3 : faces;
}

static void counts_agree_with_the_index(void **state)
{
    (void)state;
    const char *folder = data_folder();
    char        path[2048], line[4096];
    int         checked = 0;
    if (!folder)
        skip();
    snprintf(path, sizeof path, "%s/index.csv", folder);
    FILE *f = fopen(path, "r");
    assert_non_null(f);
    while (fgets(line, sizeof line, f)) {
        char               name[512];
        unsigned long long bytes, triangles;
        if ((strncmp(line, "mesh/", 5) != 0 && strncmp(line, "gltf/", 5) != 0) ||
            sscanf(line, "%511[^,],%llu,%llu", name, &bytes, &triangles) != 3)
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, name);
        lmn_scene *s = load_or_fail(path);
        if (own_triangles(s) + left_out(s) != as_triangles(name, triangles))
            print_error("%s: %llu and %llu left out, the index has %llu\n", name, (unsigned long long)own_triangles(s),
                        (unsigned long long)left_out(s), triangles);
        assert_int_equal(own_triangles(s) + left_out(s), as_triangles(name, triangles));
        lmn_scene_destroy(&s);
        checked++;
    }
    fclose(f);
    printf("%d models\n", checked);
    assert_true(checked >= 65);
}

/* Vertices in the world, in the rest pose, without the root's rotation. */
static size_t world_vertices(const lmn_scene *s, vec3 *out, size_t capacity)
{
    mat4  *worlds = scene_world_matrices(s, NULL);
    size_t count = 0;
    for (size_t i = 0; i < s->part_count; i++) {
        const node *n = &s->nodes[s->parts[i].node];
        const mesh *m = &s->meshes[n->mesh];
        size_t      joints = n->skin == NONE ? 0 : s->skins[n->skin].joint_count;
        mat4       *matrices = mem_alloc((joints + 1) * sizeof *matrices);
        for (size_t j = 0; j < joints; j++)
            matrices[j] = mat4_multiply(&worlds[s->skins[n->skin].joints[j]], &s->skins[n->skin].inverse_binds[j]);
        for (size_t k = 0; k < m->primitive_count; k++) {
            const primitive *p = &m->primitives[k];
            assert_true(count + p->vertex_count <= capacity);
            mesh_pose(p, NULL, 0, joints ? matrices : NULL, joints, NULL, NULL, p->vertex_count, out + count, NULL);
            for (uint32_t v = 0; !joints && v < p->vertex_count; v++)
                out[count + v] = mat4_transform_point(&worlds[s->parts[i].node], out[count + v]);
            count += p->vertex_count;
        }
        mem_free(matrices);
    }
    mem_free(worlds);
    return count;
}

/* How far the farthest of `a` is from its nearest of `b`. */
static double farthest(const vec3 *a, size_t a_count, const vec3 *b, size_t b_count)
{
    double worst = 0;
    for (size_t i = 0; i < a_count; i++) {
        double best = INFINITY;
        for (size_t k = 0; k < b_count; k++) {
            double x = (double)a[i].x - b[k].x, y = (double)a[i].y - b[k].y, z = (double)a[i].z - b[k].z;
            double d = x * x + y * y + z * z;
            best = d < best ? d : best;
        }
        worst = best > worst ? best : worst;
    }
    return sqrt(worst);
}

static void compressed_models_equal_their_originals(void **state)
{
    (void)state;
    static const char *const pairs[][2] = {
        {"compressed/CesiumMilkTruck-draco.glb", "animated/CesiumMilkTruck.glb"},
        {"compressed/CesiumMilkTruck-meshopt.glb", "animated/CesiumMilkTruck.glb"},
        {"compressed/CesiumMilkTruck-quantized.glb", "animated/CesiumMilkTruck.glb"},
        {"compressed/Fox-meshopt.glb", "animated/Fox.glb"},
        {"compressed/Fox-quantized.glb", "animated/Fox.glb"},
        {"compressed/BoxMeshopt.glb", "compressed/BoxMeshopt.gltf"},
        {"compressed/BoxDraco.gltf", "static/Box.glb"},
    };
    enum { CAPACITY = 8192 };
    static vec3 plain[CAPACITY], packed[CAPACITY];
    const char *folder = data_folder();
    if (!folder)
        skip();
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        char path[2048];
        snprintf(path, sizeof path, "%s/gltf/%s", folder, pairs[i][0]);
        lmn_scene *a = load_or_fail(path);
        snprintf(path, sizeof path, "%s/gltf/%s", folder, pairs[i][1]);
        lmn_scene     *b = load_or_fail(path);
        lmn_scene_info x = lmn_scene_info_of(a), y = lmn_scene_info_of(b);
        double         size = 0;
        for (int k = 0; k < 3; k++)
            size += (y.bounds_max[k] - y.bounds_min[k]) * (y.bounds_max[k] - y.bounds_min[k]);
        size = sqrt(size);
        assert_int_equal(x.triangles, y.triangles);
        assert_int_equal(x.parts, y.parts);
        assert_int_equal(x.animations, y.animations);
        size_t a_count = world_vertices(a, packed, CAPACITY), b_count = world_vertices(b, plain, CAPACITY);
        double there = farthest(packed, a_count, plain, b_count), back = farthest(plain, b_count, packed, a_count);
        printf("%s: off by %.2g of its size\n", pairs[i][0], (there > back ? there : back) / size);
        assert_true(there <= 1e-3 * size && back <= 1e-3 * size);
        lmn_scene_destroy(&a);
        lmn_scene_destroy(&b);
    }
}

/* --- damaged files -------------------------------------------------------------------------------------- */

typedef struct tally {
    int files, accepted, refused, valid;
} tally;

/* Did the Khronos validator find no error in this file? Its report lies beside it. */
static bool is_valid(const char *path)
{
    char name[4096];
    snprintf(name, sizeof name, "%s.report.json", path);
    json_t *report = json_load_file(name, 0, NULL);
    json_t *errors = json_object_get(json_object_get(report, "issues"), "numErrors");
    bool    valid = json_is_integer(errors) && json_integer_value(errors) == 0;
    json_decref(report);
    return valid;
}

/* Statuses of a file that is read: whatever is in it, it is the file that is wrong. */
static void load_one(const char *path, tally *t)
{
    lmn_error  error;
    lmn_status status = load_status(path, &error);
    if (status != LMN_OK && !error.file[0])
        print_error("%s: the message names no file: %s\n", path, error.message);
    assert_true(status == LMN_OK || error.file[0]);
    assert_true(status == LMN_OK || status == LMN_READ || status == LMN_FORMAT || status == LMN_LIMIT ||
                status == LMN_UNSUPPORTED);
    t->files++;
    t->accepted += status == LMN_OK;
    t->refused += status != LMN_OK;
    if (!is_valid(path))
        return;
    t->valid++;
    if (status != LMN_OK)
        print_error("%s is valid, but: %s\n", path, error.message);
    assert_int_equal(status, LMN_OK);
}

static void load_folder(const char *folder, tally *t)
{
    DIR           *list = opendir(folder);
    struct dirent *entry;
    assert_non_null(list);
    while ((entry = readdir(list))) {
        char        path[2048];
        struct stat facts;
        if (entry->d_name[0] == '.')
            continue;
        snprintf(path, sizeof path, "%s/%s", folder, entry->d_name);
        if (stat(path, &facts) == 0 && S_ISDIR(facts.st_mode))
            load_folder(path, t);
        else
            load_one(path, t);
    }
    closedir(list);
}

/* Some of these files ask for minutes or gigabytes; strict limits end them. What takes seconds and then is accepted is
 * read to its end behind the fence; in the process itself, only as long as any valid file takes. */
static void load_damaged(bool in_process)
{
    const char *folder = data_folder();
    char        path[2048];
    tally       t = {0};
    if (!folder)
        skip();
    lmn_task     *task;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.limits = lmn_limits_safe();
    desc.limits.time_s = in_process ? 1 : 3;
    desc.in_process = in_process;
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    snprintf(path, sizeof path, "%s/robust", folder);
    load_folder(path, &t);
    lmn_task_end(&task);
    printf("%d files: %d accepted, %d refused; %d valid by the validator\n", t.files, t.accepted, t.refused, t.valid);
    assert_true(t.files > 200 && t.valid >= 30);
}

static void damaged_files_never_crash(void **state)
{
    (void)state;
    load_damaged(false);
}

static void damaged_files_never_crash_in_process(void **state)
{
    (void)state;
    load_damaged(true);
}

static void valid_ply_syntax_is_accepted(void **state)
{
    (void)state;
    static const char *const names[] = {"cube.ply", "cube_binary.ply", "cube_uv.ply",
                                        "cube_binary_header_with_RN_newline.ply", "cube_binary_starts_with_nl.ply"};
    const char              *folder = data_folder();
    if (!folder)
        skip();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[2048];
        snprintf(path, sizeof path, "%s/robust/scenes/ply-syntax/%s", folder, names[i]);
        lmn_scene     *s = load_or_fail(path);
        lmn_scene_info info = lmn_scene_info_of(s);
        assert_int_equal(info.triangles, 12);
        double side = info.bounds_max[0] - info.bounds_min[0];
        assert_true(side > 0.5);
        for (int k = 1; k < 3; k++) /* a cube */
            assert_true(fabs(info.bounds_max[k] - info.bounds_min[k] - side) <= 1e-4 * side);
        lmn_scene_destroy(&s);
    }
}

static void cut_file(const char *relative, const char *ending, bool must_fail)
{
    char      path[2048], name[64];
    file_data file;
    snprintf(path, sizeof path, "%s/%s", data_folder(), relative);
    assert_int_equal(file_load(&file, path, NULL), LMN_OK);
    snprintf(name, sizeof name, "cut%s", ending);
    for (size_t size = 0; size < file.size; size += 1024) {
        lmn_error  error;
        lmn_status status = load_status(temp_file(name, file.data, size), &error);
        if (must_fail && status == LMN_OK)
            print_error("%s cut at %zu was accepted\n", relative, size);
        if (must_fail)
            assert_int_not_equal(status, LMN_OK);
    }
    file_data_release(&file);
}

static void cut_files_are_refused(void **state)
{
    (void)state;
    if (!data_folder())
        skip();
    cut_file("gltf/animated/Fox.glb", ".glb", true);
    cut_file("mesh/spot-binary.stl", ".stl", true);
    cut_file("mesh/spot-ascii.stl", ".stl", true);
    cut_file("mesh/spot-binary.ply", ".ply", true);
    cut_file("mesh/apple.ply", ".ply", true);
    /* A cut OBJ is often an OBJ of fewer faces. */
    cut_file("mesh/suzanne.obj", ".obj", false);
}

/* Every allocation fails once: an error, no leak (the sanitizers look), and the scene as it was. */
static void memory_may_run_out(void **state)
{
    (void)state;
    static const char *const names[] = {"gltf/animated/BoxAnimated.glb",
                                        "gltf/compressed/BoxMeshopt.glb",
                                        "gltf/animated/RiggedSimple.glb",
                                        "gltf/features/UnlitTest.glb",
                                        "gltf/features/SimpleMorph/SimpleMorph.gltf",
                                        "gltf/compressed/BoxDraco.gltf",
                                        "mesh/cad-atlas/l_hand.stl",
                                        "robust/scenes/stl-syntax/triangle_with_two_solids.stl",
                                        "mesh/cube.ply",
                                        "robust/scenes/obj-syntax/cube_usemtl.obj"};
    const char              *folder = data_folder();
    if (!folder)
        skip();
    for (size_t i = 0; i < sizeof names / sizeof *names; i++) {
        char path[2048];
        snprintf(path, sizeof path, "%s/%s", folder, names[i]);
        lmn_scene *s = load_or_fail(path);
        uint64_t   revision = s->revision;
        size_t     parts = s->part_count, nodes = s->node_count;
        long       n = 1;
        for (; n < 100000; n++) {
            lmn_error error = {0};
            mem_fail_at(n);
            lmn_status status = lmn_scene_add_file(s, path, NULL, &error);
            mem_fail_at(0);
            if (status == LMN_OK)
                break;
            if (status != LMN_MEMORY)
                print_error("%s, allocation %ld: %s\n", names[i], n, error.message);
            assert_int_equal(status, LMN_MEMORY);
            assert_int_equal(s->revision, revision);
            assert_int_equal(s->part_count, parts);
            assert_int_equal(s->node_count, nodes);
        }
        assert_true(n > 10 && n < 100000);
        assert_int_equal(s->part_count, 2 * parts);
        lmn_scene_destroy(&s);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(counts_agree_with_the_index),
        cmocka_unit_test(compressed_models_equal_their_originals),
        cmocka_unit_test(valid_ply_syntax_is_accepted),
        cmocka_unit_test(damaged_files_never_crash),
        cmocka_unit_test(damaged_files_never_crash_in_process),
        cmocka_unit_test(cut_files_are_refused),
        cmocka_unit_test(memory_may_run_out),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
