/* Fuzzers of model files: what is accepted goes on through everything that is derived from meshes. Side files are
 * looked for where there are none. */
#define _GNU_SOURCE /* memfd_create */
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <sys/mman.h>
#include <unistd.h>

#include "base/limits.h"
#include "base/memory.h"
#include "fuzz.h"
#include "fence/image_read.h"
#include "import/assimp_stream.h"
#include "info/info.h"
#include "import/csg.h"
#include "import/draco.h"
#include "import/step.h"
#include "import/footprint.h"
#include "import/gunzip.h"
#include "import/ifc_text.h"
#include "import/obj.h"
#include "import/retarget.h"
#include "import/terrain.h"
#include "import/threemf.h"
#include "scene/mesh.h"

static lmn_scene *read_at(const char *path, fuzz_reader read, char up, const lmn_load_desc *desc, const uint8_t *bytes,
                          size_t size)
{
    lmn_scene *scene = scene_new(), *into = scene_new();
    bool       done = false;
    uint8_t   *own = mem_alloc(size + 1); /* a reader may cut it */
    file_data  file = {.data = own, .size = size};
    if (scene && into && own) {
        memcpy(own, bytes, size);
        own[size] = '\0';
        import_job job = {.path = path, .file = &file, .scene = scene, .desc = desc};
        lmn_error  error;
        scene->up = into->up = up;
        done = read(&job, &error) == LMN_OK && scene_finish(scene, job.path, &error) == LMN_OK &&
               scene_merge(into, scene, job.path, &error) == LMN_OK;
    }
    file_data_release(&file);
    scene_free(scene);
    if (done)
        return into;
    scene_free(into);
    return NULL;
}

lmn_scene *fuzz_read_model(fuzz_reader read, char up, const uint8_t *bytes, size_t size)
{
    return read_at("/nonexistent/fuzz", read, up, NULL, bytes, size);
}

/* A few numbers can stand for millions of triangles; with sanitizers these would take all the time. */
enum { TRIANGLES_USED = 100000 };

/* All that is worked out from meshes without drawing them. */
static void use(lmn_scene *scene)
{
    if (!scene)
        return;
    const bool small = lmn_scene_info_of(scene).triangles <= TRIANGLES_USED;
    for (size_t i = 0; small && i < scene->mesh_count; i++)
        for (size_t k = 0; k < scene->meshes[i].primitive_count; k++) {
            render_vertices vertices;
            if (mesh_make_normals(&vertices, &scene->meshes[i].primitives[k], 0.5, NULL) == LMN_OK)
                render_vertices_release(&vertices);
            mem_free(mesh_adjacency(&scene->meshes[i].primitives[k]));
        }
    mem_free(scene_info_json(scene));
    scene_free(scene);
}

void fuzz_gltf(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_gltf.read, 'y', bytes, size));
}

void fuzz_cityjson(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_cityjson.read, 'z', bytes, size));
}

/* As it is, and with people and cars along its roads. */
void fuzz_geojson(const uint8_t *bytes, size_t size)
{
    lmn_load_desc populated = LMN_LOAD_DESC_INIT;
    populated.populate = 2;
    use(fuzz_read_model(import_geojson.read, 'z', bytes, size));
    use(read_at("/nonexistent/fuzz", import_geojson.read, 'z', &populated, bytes, size));
}

/* Every edge of a face is one of another face, the other way round. */
static bool is_closed(const city_shape *s)
{
    for (size_t ring = 0, first = 0; ring < s->ring_count; first = s->rings[ring++])
        for (size_t i = first; i < s->rings[ring]; i++) {
            uint32_t a = s->corners[i], b = s->corners[i + 1 < s->rings[ring] ? i + 1 : first];
            int      back = 0;
            for (size_t r = 0, f = 0; r < s->ring_count; f = s->rings[r++])
                for (size_t k = f; k < s->rings[r]; k++)
                    back += s->corners[k] == b && s->corners[k + 1 < s->rings[r] ? k + 1 : f] == a;
            if (back != 1)
                return false;
        }
    return true;
}

/* A footprint and its roof: the form, how fine the grid is that corners lie on, how many corners the first ring has;
 * then two bytes a corner. Whatever comes of it is closed; an area of terrain is made of it, too. */
void fuzz_footprint(const uint8_t *bytes, size_t size)
{
    enum { CORNERS = 100 };
    double p[CORNERS][2];
    size_t counts[2] = {0, 0}, count = size > 3 ? (size - 3) / 2 : 0;
    count = count < CORNERS ? count : CORNERS;
    if (count < 3)
        return;
    counts[0] = bytes[2] < count ? bytes[2] : count;
    counts[1] = count - counts[0];
    if (counts[0] < 3 || counts[1] < 3) {
        counts[0] = count;
        counts[1] = 0;
    }
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < 2; k++)
            p[i][k] =
                bytes[3 + 2 * i + k] * (bytes[1] % 2 ? 1.0 : 0.0137) + (bytes[1] & 2 ? 1e-4 * (double)(i * i % 7) : 0);
    city_shape       shape = {0}, draped = {0};
    footprint_points points = {0}, on = {0};
    footprint        how = {.roof = (roof_form)(bytes[0] % ROOF_FORMS), .base = 0, .eaves = 5, .ridge = 8};
    roof_made        made;
    if (footprint_raise(&shape, &points, &how, (const double(*)[2])p, counts, counts[1] ? 2 : 1, &made) &&
        made != ROOF_MADE_FLAT && !is_closed(&shape))
        __builtin_trap();
    for (size_t i = 0; i < points.count; i++)
        if (!isfinite(points.items[i].x) || !isfinite(points.items[i].y) || !isfinite(points.items[i].z))
            __builtin_trap();
    float   heights[25];
    bool    known[25];
    terrain t = {{-10, 3}, 60.5, 5, 5, heights, known, 0};
    for (int i = 0; i < 25; i++)
        heights[i] = (float)(i * i % 7);
    terrain_drape(&t, &shape, points.items, 0.1, &draped, &on);
    city_shape_release(&shape);
    city_shape_release(&draped);
    mem_free(points.items);
    mem_free(on.items);
}

/* What the process that reads rasters hands back: how long the first answer is, then that, then the sides of the grid,
 * and heights. Whatever is taken has a height everywhere, and things are laid on it. */
void fuzz_terrain(const uint8_t *bytes, size_t size)
{
    geodata_extent   extent;
    char             system[64];
    lmn_error        error;
    size_t           first = size ? bytes[0] : 0;
    terrain          t = {.low = {-7, 3}, .step = 2.5};
    city_shape       square = {0}, draped = {0};
    footprint_points corners = {0}, on = {0};
    if (size < first + 4)
        return;
    fence_bytes answer = {.bytes = (unsigned char *)(uintptr_t)(bytes + 1), .size = first};
    terrain_take_extent(&extent, system, sizeof system, &answer, "fuzz", &error);
    t.columns = 2 + bytes[first + 1] % 12;
    t.rows = 2 + bytes[first + 2] % 12;
    size_t wanted = (size_t)t.columns * t.rows * sizeof(float), rest = size - first - 3;
    answer =
        (fence_bytes){.bytes = (unsigned char *)(uintptr_t)(bytes + first + 3), .size = rest < wanted ? rest : wanted};
    if (terrain_take_heights(&t, &answer, 400, "fuzz", &error) == LMN_OK) {
        for (size_t i = 0; i < (size_t)t.columns * t.rows; i++)
            if (!isfinite(t.heights[i]))
                __builtin_trap();
        for (uint32_t i = 0; i < 4; i++)
            if (!footprint_add_point(&corners, i == 1 || i == 2 ? 11.3 : -9, i > 1 ? 14.1 : 1, 0) ||
                !city_shape_corner(&square, i))
                break;
        if (city_shape_end_ring(&square) && city_shape_end_face(&square, NONE, 0, 0))
            terrain_drape(&t, &square, corners.items, 0.1, &draped, &on);
    }
    mem_free(t.heights);
    mem_free(t.known);
    city_shape_release(&square);
    city_shape_release(&draped);
    mem_free(corners.items);
    mem_free(on.items);
}

void fuzz_citygml(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_citygml.read, 'z', bytes, size));
}

/* What is packed by gzip: it is unpacked or refused. */
void fuzz_gzip(const uint8_t *bytes, size_t size)
{
    unsigned char *copy = mem_copy(bytes, size);
    file_data      file = {.data = copy, .size = size};
    if (copy && gunzip(&file, "fuzz", NULL) == LMN_OK)
        file_data_release(&file);
}

void fuzz_stl(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_stl.read, 'z', bytes, size));
}

void fuzz_ply(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_ply.read, 'y', bytes, size));
}

void fuzz_obj(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_obj.read, 'y', bytes, size));
}

/* A triangle with a skin of four joints. */
static const char skinned[] =
    "{\"asset\":{\"version\":\"2.0\"},\"nodes\":[{\"mesh\":0,\"skin\":0},{\"name\":\"rig:Hips\",\"children\":[2,3],"
    "\"matrix\":[0,1,0,0,-1,0,0,0,0,0,2,0,0,9,0,1]},{\"name\":\"SPINE\",\"scale\":[1,0,1],\"children\":[4]},{\"name\":"
    "\"foot\",\"translation\":[0,-9,0]},{\"name\":\"other\"}],\"skins\":[{\"joints\":[1,2,3,4]}],\"meshes\":[{"
    "\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}],\"accessors\":[{\"bufferView\":0,\"componentType\":5126,"
    "\"type\":\"VEC3\",\"count\":3}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],\"buffers\":[{\"byteLength\":"
    "36,"
    "\"uri\":\"data:;base64,AAAAAAAAAAAAAAAAAACAPwAAAAAAAAAAAAAAAAAAgD8AAAAA\"}]}";

/* What posing relies on. */
static void check_motion(const animation *a)
{
    for (size_t i = 0; i < a->channel_count; i++) {
        const animation_channel *c = &a->channels[i];
        for (size_t k = 0; k < c->key_count * c->components; k++)
            if (!isfinite(c->values[k]))
                __builtin_trap();
        for (size_t k = 1; k < c->key_count; k++)
            if (!(c->times[k] > c->times[k - 1]))
                __builtin_trap();
    }
}

/* What happens is laid out, written as a clip, and told. */
void fuzz_script(const uint8_t *bytes, size_t size)
{
    lmn_scene *scene = fuzz_read_model(import_script.read, 'y', bytes, size);
    if (scene)
        mem_free(scene_dynamics_json(scene));
    use(scene);
}

/* The motion moves its own skeleton, and a model's. */
void fuzz_bvh(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_bvh.read, 'y', bytes, size));
    lmn_scene *motion = scene_new();
    lmn_scene *model = fuzz_read_model(import_gltf.read, 'y', (const uint8_t *)skinned, sizeof skinned - 1);
    if (!model)
        __builtin_trap(); /* the model above is right */
    file_data  file = {.data = bytes, .size = size};
    import_job job = {.path = "/nonexistent/fuzz", .file = &file, .scene = motion};
    lmn_error  error;
    bool       done = false;
    if (motion && import_bvh.read(&job, &error) == LMN_OK && scene_finish(motion, job.path, &error) == LMN_OK) {
        motion->up = 'z';
        retarget_motion(model, motion, job.path, &done, &error);
    }
    if (done)
        check_motion(&model->animations[0]);
    scene_free(motion);
    use(model);
}

void fuzz_csg(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(import_csg.read, 'z', bytes, size));
}

static lmn_status read_stream(const import_job *job, lmn_error *error)
{
    return assimp_stream_read(job, job->file->data, job->file->size, error);
}

static lmn_status read_step_answer(const import_job *job, lmn_error *error)
{
    return step_answer_read(job, STEP_KIND_STEP, job->file->data, job->file->size, error);
}

void fuzz_step(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(read_step_answer, 'z', bytes, size));
}

/* What an IFC file says in words; its shapes are read by a library in a process of its own. */
void fuzz_ifc(const uint8_t *bytes, size_t size)
{
    ifc_text text;
    char    *copy = mem_copy(bytes, size); /* nothing stands behind it */
    if (copy && ifc_text_read(&text, copy, size, NULL) == LMN_OK) {
        char name[IFC_GUID + 1] = {0};
        for (size_t i = 0; i < text.count; i++) {
            memcpy(name, text.things[i].guid, IFC_GUID);
            if (!memchr(name, 0, IFC_GUID) && !ifc_text_find(&text, name))
                abort();
        }
        ifc_text_release(&text);
    }
    mem_free(copy);
}

void fuzz_stream(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(read_stream, 'y', bytes, size));
}

/* The library is a file in memory; the model beside it names it and uses its first materials. */
void fuzz_mtl(const uint8_t *bytes, size_t size)
{
    int descriptor = memfd_create("fuzz", MFD_CLOEXEC);
    if (descriptor < 0)
        return;
    if (size == 0 || write(descriptor, bytes, size) == (ssize_t)size) {
        char model[128];
        int  length =
            snprintf(model, sizeof model,
                     "mtllib %d\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 3 2 1\n", descriptor);
        use(read_at("/proc/self/fd/model.obj", import_obj.read, 'y', NULL, (const uint8_t *)model, (size_t)length));
    }
    close(descriptor);
}

void fuzz_dxf(const uint8_t *bytes, size_t size)
{
    const csg_drawing how = {.layer = "", .scale = 1, .facets = {8, 12, 2}};
    region            figure = {0};
    lmn_error         error;
    csg_dxf((const char *)bytes, size, &how, &figure, &error);
    region_release(&figure);
}

/* Pictures that are large by their header alone are refused by a limit that other tests hold; here they would only
 * take time. */
static bool is_large_png(const uint8_t *bytes, size_t size)
{
    return size >= 24 && bytes[0] == 0x89 &&
           (bytes[16] || bytes[17] || bytes[20] || bytes[21] || bytes[18] > 8 || bytes[22] > 8);
}

void fuzz_image(const uint8_t *bytes, size_t size)
{
    image_pixels pixels;
    lmn_error    error;
    if (is_large_png(bytes, size))
        return;
    if (image_read(&pixels, bytes, size, size % 3 ? 0 : 1 << 14, &error) != LMN_OK && pixels.rgba)
        __builtin_trap(); /* image_read.h: nothing is left after an error */
    mem_free(pixels.rgba);
}

/* A number of Draco's header: four bytes in old files, in new ones seven bits a byte. */
static uint64_t draco_number(const uint8_t *bytes, size_t size, size_t *at, bool old)
{
    uint64_t number = 0;
    for (int i = 0; *at < size && i < (old ? 4 : 5); i++) {
        const uint8_t byte = bytes[(*at)++];
        number |= (uint64_t)(old ? byte : byte & 127) << (old ? 8 : 7) * i;
        if (!old && byte < 128)
            break;
    }
    return number;
}

/* Draco makes room for what a header claims, so that a few bytes can ask for gigabytes. How much it may have is
 * decided where it is called from, not here. */
static bool claims_much(const uint8_t *bytes, size_t size)
{
    enum { METHOD = 8, FLAGS = 10, COUNTS = 11, MOST = 100000 };
    if (size < COUNTS)
        return false;
    const unsigned version = bytes[5] * 256u + bytes[6];
    const bool     edgebreaker = bytes[METHOD] == 1, old = version < (edgebreaker ? 0x200u : 0x202u);
    size_t         at = COUNTS + edgebreaker;
    bool           much = bytes[FLAGS] & 128; /* other data comes first, which may claim as much */
    for (int i = 0; i < 2 + (edgebreaker && version < 0x202); i++)
        much = draco_number(bytes, size, &at, old) > MOST || much;
    return much;
}

/* Attributes of any id that occurs, as the glTF reader asks for them. */
void fuzz_draco(const uint8_t *bytes, size_t size)
{
    draco_model *model = NULL;
    lmn_error    error;
    if (claims_much(bytes, size) || draco_open(&model, bytes, size, &error) != LMN_OK)
        return;
    size_t    vertices = draco_vertex_count(model), triangles = draco_triangle_count(model);
    uint32_t *indices = mem_calloc(triangles, 3 * sizeof *indices);
    float    *values = mem_calloc(vertices, 4 * sizeof *values);
    if (indices && values && vertices <= LIMIT_VERTICES && triangles <= LIMIT_TRIANGLES) {
        draco_read_indices(model, indices);
        for (uint32_t id = 0; id < 8; id++)
            for (int components = 1; components <= 4; components++)
                draco_read_attribute(model, id, components, id % 2, values);
    }
    mem_free(indices);
    mem_free(values);
    draco_close(model);
}

/* A model of one object, as assimp hands it over; then what the package says of it. */
static lmn_status read_package(const import_job *job, lmn_error *error)
{
    static const char triangle[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    file_data         file = {.data = (const uint8_t *)triangle, .size = sizeof triangle - 1};
    import_job        plain = *job;
    plain.file = &file;
    lmn_status status = import_obj.read(&plain, error);
    for (size_t i = 0; i < job->scene->node_count && status == LMN_OK; i++) {
        mem_free(job->scene->nodes[i].name);
        job->scene->nodes[i].name = mem_copy_text("Object_1");
    }
    return status == LMN_OK ? threemf_describe(job, error) : status;
}

void fuzz_threemf(const uint8_t *bytes, size_t size)
{
    use(fuzz_read_model(read_package, 'z', bytes, size));
}
