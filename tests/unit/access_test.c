/* Files that a model names: which it may have, and the host that serves them itself. Pictures of each kind, and
 * each kind of refusal. */
#include "import_support.h"

#include <sys/stat.h>

#include <jpeglib.h>
#include <png.h>
#include <webp/encode.h>

#include "base/work.h"
#include "fence/image_read.h"
#include "import/access.h"

static char root[128];

/* root/models/own/model.gltf names the buffer; files lie all around. */
static void make(const char *name, const void *bytes, size_t size)
{
    char path[256];
    snprintf(path, sizeof path, "%s/%s", root, name);
    FILE *f = fopen(path, "wb");
    assert_non_null(f);
    assert_int_equal(fwrite(bytes, 1, size, f), size);
    fclose(f);
}

static const float triangle[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};

static int make_tree(void **state)
{
    (void)state;
    static const char *const folders[] = {
        "", "/models", "/models/own", "/models/own/deep", "/models/textures", "/models/.keys", "/far"};
    char path[256];
    snprintf(root, sizeof root, "%s", temp_folder());
    for (size_t i = 1; i < sizeof folders / sizeof *folders; i++) {
        snprintf(path, sizeof path, "%s%s", root, folders[i]);
        assert_int_equal(mkdir(path, 0700), 0);
    }
    static const char *const files[] = {"models/own/near.bin",
                                        "models/own/deep/deep.bin",
                                        "models/textures/beside.bin",
                                        "models/.keys/hidden.bin",
                                        "far/far.bin",
                                        "top.bin"};
    for (size_t i = 0; i < sizeof files / sizeof *files; i++)
        make(files[i], triangle, sizeof triangle);
    snprintf(path, sizeof path, "%s/models/own/link.bin", root);
    assert_int_equal(symlink("../../far/far.bin", path), 0);
    snprintf(path, sizeof path, "%s/models/own/inward.bin", root);
    assert_int_equal(symlink("deep/deep.bin", path), 0);
    return 0;
}

static lmn_status load_with_buffer(const char *uri, lmn_file_access files, const char *allowed, lmn_error *error)
{
    char json[1024], path[256];
    snprintf(json, sizeof json,
             "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
             "\"buffers\":[{\"byteLength\":36,\"uri\":\"%s\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
             "\"accessors\":[{\"bufferView\":0,\"count\":3,\"componentType\":5126,\"type\":\"VEC3\"}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
             uri);
    make("models/own/model.gltf", json, strlen(json));
    snprintf(path, sizeof path, "%s/models/own/model.gltf", root);
    lmn_task     *task;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.files = files;
    desc.allow_paths = &allowed;
    desc.allow_path_count = allowed != NULL;
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    lmn_status status = load_status(path, error);
    lmn_task_end(&task);
    return status;
}

static void models_read_their_neighbours_alone(void **state)
{
    (void)state;
    static const struct {
        const char *uri;
        bool        near, folder; /* allowed then */
    } rows[] = {
        {"near.bin", true, true},
        {"./deep/../near.bin", true, true},
        {"deep/deep.bin", true, true},
        {"inward.bin", true, true},
        {"../textures/beside.bin", true, false},
        {"%2e%2e/textures/beside.bin", true, false},
        {"../own/near.bin", true, true},
        {"../.keys/hidden.bin", false, false},
        {"../../far/far.bin", false, false},
        {"../../top.bin", false, false},
        {"link.bin", false, false},
        {"deep/../../../top.bin", false, false},
        {"/etc/passwd", false, false},
        {"../../../../../../../../etc/passwd", false, false},
    };
    for (size_t i = 0; i < sizeof rows / sizeof *rows; i++) {
        lmn_error  error;
        lmn_status status = load_with_buffer(rows[i].uri, LMN_FILES_NEAR, NULL, &error);
        if ((status == LMN_OK) != rows[i].near)
            print_error("%s: %s\n", rows[i].uri, error.message);
        assert_int_equal(status, rows[i].near ? LMN_OK : LMN_READ);
        assert_true(rows[i].near || strstr(error.hint, "--allow-path"));
        status = load_with_buffer(rows[i].uri, LMN_FILES_FOLDER, NULL, &error);
        if ((status == LMN_OK) != rows[i].folder)
            print_error("%s, folder alone: %s\n", rows[i].uri, error.message);
        assert_int_equal(status, rows[i].folder ? LMN_OK : LMN_READ);
    }
    lmn_error error;
    assert_int_equal(load_with_buffer("../../far/far.bin", LMN_FILES_ANY, NULL, &error), LMN_OK);
    char far[160];
    snprintf(far, sizeof far, "%s/far", root);
    assert_int_equal(load_with_buffer("../../far/far.bin", LMN_FILES_FOLDER, far, &error), LMN_OK);
    assert_int_equal(load_with_buffer("link.bin", LMN_FILES_NEAR, far, &error), LMN_OK);
    assert_int_equal(load_with_buffer("../../top.bin", LMN_FILES_NEAR, far, &error), LMN_READ);
    /* A folder whose name only begins alike is another one. */
    snprintf(far, sizeof far, "%s/fa", root);
    assert_int_equal(load_with_buffer("../../far/far.bin", LMN_FILES_NEAR, far, &error), LMN_READ);
}

/* The folders themselves, and paths longer than any. */
static void odd_paths_are_refused_at_once(void **state)
{
    (void)state;
    static const char *const folders[] = {".", "..", "../", "../.", "deep/../..", "../own/.."};
    lmn_error                error;
    for (size_t i = 0; i < sizeof folders / sizeof *folders; i++)
        assert_int_equal(load_with_buffer(folders[i], LMN_FILES_NEAR, NULL, &error), LMN_READ);
    lmn_task     *task;
    lmn_task_desc desc = lmn_task_desc_standard();
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    enum { PARTS = 20000 };
    char *path = calloc(PARTS + 1, 2), model[256];
    for (int i = 0; i < PARTS; i++)
        memcpy(path + i * 2, "a/", 2);
    snprintf(model, sizeof model, "%s/models/own/model.gltf", root);
    assert_int_equal(access_check(&(import_job){.path = model}, "buffer", path, &error), LMN_READ);
    assert_non_null(strstr(error.message, "40000 bytes"));
    free(path);
    lmn_task_end(&task);
}

/* Whether a file exists is none of the model's business. */
static void refusals_do_not_tell_what_exists(void **state)
{
    (void)state;
    lmn_error there, missing;
    assert_int_equal(load_with_buffer("../../top.bin", LMN_FILES_NEAR, NULL, &there), LMN_READ);
    assert_int_equal(load_with_buffer("../../tip.bin", LMN_FILES_NEAR, NULL, &missing), LMN_READ);
    char *at = strstr(missing.message, "tip.bin");
    assert_non_null(at);
    at[1] = 'o';
    assert_string_equal(there.message, missing.message);
}

static bool serve(const char *path, const char *what, void **bytes, size_t *size, void *user)
{
    ++*(int *)user;
    if (strcmp(what, "buffer") == 0) {
        assert_non_null(strstr(path, "nowhere.bin"));
        *bytes = lmn_file_alloc(sizeof triangle);
        memcpy(*bytes, triangle, *size = sizeof triangle);
        return true;
    }
    static const char json[] =
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}],"
        "\"buffers\":[{\"byteLength\":36,\"uri\":\"../../../"
        "nowhere.bin\"}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":36}],"
        "\"accessors\":[{\"bufferView\":0,\"count\":3,\"componentType\":5126,\"type\":\"VEC3\"}],"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}";
    if (strcmp(path, "/nowhere/model.gltf") != 0)
        return false;
    *bytes = lmn_file_alloc(strlen(json));
    memcpy(*bytes, json, *size = strlen(json));
    return true;
}

static void hosts_serve_files(void **state)
{
    (void)state;
    lmn_task     *task;
    lmn_error     error;
    int           served = 0;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.read_file = serve;
    desc.read_user = &served;
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    assert_int_equal(load_status("/nowhere/model.gltf", &error), LMN_OK);
    assert_int_equal(served, 2);
    assert_int_equal(load_status("/etc/passwd.gltf", &error), LMN_READ);
    lmn_task_end(&task);
}

/* --- pictures ------------------------------------------------------------------------------------------- */

enum { SIDE = 16 };

static unsigned char packed[1 << 16];
static size_t        packed_size;

static void fill(uint8_t *pixels, int channels)
{
    for (int i = 0; i < SIDE * SIDE; i++)
        for (int k = 0; k < channels; k++)
            pixels[i * channels + k] = (uint8_t)(k == 3 ? 255 - i / 2 : 40 + 50 * k + i / SIDE);
}

static void pack_png(void)
{
    uint8_t          pixels[SIDE * SIDE * 4];
    png_image        png = {.version = PNG_IMAGE_VERSION, .width = SIDE, .height = SIDE, .format = PNG_FORMAT_RGBA};
    png_alloc_size_t size = sizeof packed;
    fill(pixels, 4);
    assert_true(png_image_write_to_memory(&png, packed, &size, 0, pixels, 0, NULL) != 0);
    packed_size = size;
}

/* `inks`: four channels, as Adobe's programs write them when there is an Adobe marker. */
static void pack_jpeg(bool inks, bool adobe)
{
    uint8_t                     pixels[SIDE * SIDE * 4];
    struct jpeg_compress_struct c;
    struct jpeg_error_mgr       manager;
    unsigned char              *out = NULL;
    unsigned long               size = 0;
    c.err = jpeg_std_error(&manager);
    jpeg_create_compress(&c);
    jpeg_mem_dest(&c, &out, &size);
    c.image_width = c.image_height = SIDE;
    c.input_components = inks ? 4 : 3;
    c.in_color_space = inks ? JCS_CMYK : JCS_RGB;
    jpeg_set_defaults(&c);
    jpeg_set_quality(&c, 100, TRUE);
    c.write_Adobe_marker = adobe;
    jpeg_start_compress(&c, TRUE);
    fill(pixels, c.input_components);
    if (inks)
        for (int i = 0; i < SIDE * SIDE; i++)
            memcpy(pixels + 4 * i, (const uint8_t[]){200, 100, 50, 128}, 4);
    for (int y = 0; y < SIDE; y++) {
        JSAMPROW row = pixels + y * SIDE * c.input_components;
        jpeg_write_scanlines(&c, &row, 1);
    }
    jpeg_finish_compress(&c);
    jpeg_destroy_compress(&c);
    assert_true(size <= sizeof packed);
    memcpy(packed, out, packed_size = size);
    free(out);
}

static void pack_webp(void)
{
    uint8_t pixels[SIDE * SIDE * 4], *out = NULL;
    fill(pixels, 4);
    packed_size = WebPEncodeLosslessRGBA(pixels, SIDE, SIDE, SIDE * 4, &out);
    assert_true(packed_size > 0 && packed_size <= sizeof packed);
    memcpy(packed, out, packed_size);
    WebPFree(out);
}

/* What is no picture any more: refused, nothing handed over, whatever stood in the struct before. */
static void refuse_all_cuts(bool ends_matter)
{
    for (size_t size = 0; size < packed_size; size += size < 64 ? 1 : packed_size / 23 + 1) {
        image_pixels   p = {.width = 7, .height = 7, .rgba = (uint8_t *)(uintptr_t)0x10, .halved = 3};
        lmn_error      error = {0};
        unsigned char *copy = mem_copy(packed, size);
        lmn_status     status = image_read(&p, copy, size, 0, &error);
        mem_free(copy);
        if (status == LMN_OK) {
            assert_true(!ends_matter || size + 16 > packed_size); /* the mark at the end of a PNG may be missing */
            mem_free(p.rgba);
            continue;
        }
        assert_true(status == LMN_FORMAT || status == LMN_UNSUPPORTED);
        assert_true(error.message[0]);
        assert_null(p.rgba);
        assert_int_equal(p.width, 0);
    }
}

static void each_decoder_refuses(bool in_process)
{
    lmn_task     *task;
    lmn_task_desc desc = lmn_task_desc_standard();
    desc.in_process = in_process;
    assert_int_equal(lmn_task_begin(&task, &desc, NULL), LMN_OK);
    uint8_t wanted[SIDE * SIDE * 4];
    fill(wanted, 4);
    for (int kind = 0; kind < 4; kind++) {
        image_pixels p = {0};
        kind == 0 ? pack_png() : kind == 1 ? pack_webp() : kind == 2 ? pack_jpeg(false, false) : pack_jpeg(true, true);
        assert_int_equal(image_read(&p, packed, packed_size, 0, NULL), LMN_OK);
        assert_true(p.width == SIDE && p.height == SIDE && p.halved == 0);
        if (kind < 2)
            assert_memory_equal(p.rgba, wanted, sizeof wanted);
        mem_free(p.rgba);
        /* libjpeg fills what is missing with grey. */
        refuse_all_cuts(kind < 2);
        /* Memory that is gone. */
        for (long n = 1;; n++) {
            image_pixels q = {.rgba = (uint8_t *)(uintptr_t)0x10};
            mem_fail_at(n);
            lmn_status status = image_read(&q, packed, packed_size, 0, NULL);
            mem_fail_at(0);
            if (status == LMN_OK) {
                mem_free(q.rgba);
                break;
            }
            assert_int_equal(status, LMN_MEMORY);
            assert_null(q.rgba);
            assert_true(n < 100);
        }
    }
    /* Sides beyond the limit, by the header alone. */
    pack_png();
    memcpy(packed + 16, (const unsigned char[]){0, 0, 0x40, 1}, 4);
    image_pixels p = {.rgba = (uint8_t *)(uintptr_t)0x10};
    assert_int_not_equal(image_read(&p, packed, packed_size, 0, NULL), LMN_OK);
    assert_null(p.rgba);
    lmn_task_end(&task);
}

static void decoders_refuse_behind_the_fence(void **state)
{
    (void)state;
    each_decoder_refuses(false);
}

static void decoders_refuse_in_process(void **state)
{
    (void)state;
    each_decoder_refuses(true);
}

/* Light is what each ink lets through, times what black does. */
static void four_inks_are_light(void **state)
{
    (void)state;
    for (int adobe = 0; adobe < 2; adobe++) {
        const int    stored[4] = {200, 100, 50, 128};
        image_pixels p = {0};
        pack_jpeg(true, adobe);
        assert_int_equal(image_read(&p, packed, packed_size, 0, NULL), LMN_OK);
        for (int k = 0; k < 3; k++) {
            int through = adobe ? stored[k] : 255 - stored[k], black = adobe ? stored[3] : 255 - stored[3],
                wanted = through * black / 255;
            assert_in_range(p.rgba[k] + 3, wanted, wanted + 6);
        }
        assert_int_equal(p.rgba[3], 255);
        mem_free(p.rgba);
    }
}

/* The mean of four in linear light; of black and white that is 188, not 128. */
static void halving_is_in_linear_light(void **state)
{
    (void)state;
    uint8_t pixels[4 * 4 * 4];
    for (int i = 0; i < 16; i++)
        memset(pixels + 4 * i, (i + i / 4) % 2 ? 255 : 0, 4);
    image_pixels p = {.width = 4, .height = 4, .rgba = pixels};
    image_halve(&p);
    assert_true(p.width == 2 && p.height == 2 && p.halved == 1);
    for (int i = 0; i < 4; i++) {
        assert_in_range(p.rgba[4 * i], 187, 189);
        assert_in_range(p.rgba[4 * i + 3], 127, 128);
    }
    image_pixels line = {.width = 1, .height = 3, .rgba = pixels};
    image_halve(&line);
    assert_true(line.width == 1 && line.height == 1);
    pack_png();
    assert_int_equal(image_read(&p, packed, packed_size, 100, NULL), LMN_OK);
    assert_true(p.width == 4 && p.height == 4 && p.halved == 2); /* 64 bytes */
    mem_free(p.rgba);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(models_read_their_neighbours_alone),
        cmocka_unit_test(odd_paths_are_refused_at_once),
        cmocka_unit_test(refusals_do_not_tell_what_exists),
        cmocka_unit_test(hosts_serve_files),
        cmocka_unit_test(decoders_refuse_behind_the_fence),
        cmocka_unit_test(decoders_refuse_in_process),
        cmocka_unit_test(four_inks_are_light),
        cmocka_unit_test(halving_is_in_linear_light),
    };
    return cmocka_run_group_tests(tests, make_tree, remove_temp_folder);
}
