/* glTF features, each in a GLB built here. */
#include "import_support.h"

#include <math.h>

#include <meshoptimizer.h>

static glb g;

static void begin(void)
{
    memset(&g, 0, sizeof g);
}

#define ASSET  "\"asset\":{\"version\":\"2.0\"}"
#define BUFFER "\"buffers\":[{\"byteLength\":%zu}]"
/* One mesh of accessor 0 at one node. */
#define ONE_NODE "\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0}]"
#define FLOAT3   "\"componentType\":5126,\"type\":\"VEC3\""

static const float square[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}};

static void put_square(void)
{
    begin();
    glb_put(&g, square, sizeof square);
}

static lmn_scene *load(void)
{
    return load_or_fail(glb_file(&g, "built.glb"));
}

static lmn_status refused(lmn_error *error)
{
    return load_status(glb_file(&g, "built.glb"), error);
}

static void strips_and_fans_become_triangles(void **state)
{
    (void)state;
    static const uint32_t strip[6] = {0, 1, 2, 2, 1, 3}, fan[6] = {0, 1, 2, 0, 2, 3};
    for (int mode = 5; mode <= 6; mode++) {
        put_square();
        snprintf(g.json, sizeof g.json,
                 "{" ASSET "," ONE_NODE "," BUFFER ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],"
                 "\"accessors\":[{\"bufferView\":0,\"count\":4," FLOAT3 "}],"
                 "\"meshes\":[{\"primitives\":[{\"mode\":%d,\"attributes\":{\"POSITION\":0}},"
                 "{\"mode\":1,\"attributes\":{\"POSITION\":0}},{\"mode\":0,\"attributes\":{\"POSITION\":0}}]}]}",
                 g.bin_size, mode);
        lmn_scene *s = load();
        assert_int_equal(s->meshes[0].primitive_count, 2); /* triangles, and lines */
        assert_int_equal(s->meshes[0].primitives[0].index_count, 6);
        assert_memory_equal(s->meshes[0].primitives[0].indices, mode == 5 ? strip : fan, sizeof strip);
        assert_true(has_warning(s, WARNING_IGNORED));
        assert_int_equal(s->up, 'y');
        lmn_scene_destroy(&s);
    }
}

static void quantised_positions_keep_their_meaning(void **state)
{
    (void)state;
    begin();
    const int16_t  positions[3][4] = {{0, 0, 0, 0}, {32767, 0, 0, 0}, {0, -32768, 16384, 0}};
    const int8_t   normals[3][4] = {{0, 0, 127, 0}, {0, 127, 0, 0}, {-128, 0, 0, 0}};
    const uint16_t uvs[3][2] = {{0, 0}, {65535, 0}, {0, 32768}};
    const uint8_t  indices[3] = {2, 0, 1};
    size_t         a = glb_put(&g, positions, sizeof positions), b = glb_put(&g, normals, sizeof normals);
    size_t         c = glb_put(&g, uvs, sizeof uvs), d = glb_put(&g, indices, sizeof indices);
    snprintf(
        g.json, sizeof g.json,
        "{" ASSET "," ONE_NODE "," BUFFER ",\"extensionsRequired\":[\"KHR_mesh_quantization\"],\"bufferViews\":["
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":24,\"byteStride\":8},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":12,\"byteStride\":4},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":12},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":3}],"
        "\"accessors\":[{\"bufferView\":0,\"count\":3,\"componentType\":5122,\"normalized\":true,\"type\":\"VEC3\"},"
        "{\"bufferView\":1,\"count\":3,\"componentType\":5120,\"normalized\":true,\"type\":\"VEC3\"},"
        "{\"bufferView\":2,\"count\":3,\"componentType\":5123,\"normalized\":true,\"type\":\"VEC2\"},"
        "{\"bufferView\":3,\"count\":3,\"componentType\":5121,\"type\":\"SCALAR\"}],"
        "\"meshes\":[{\"primitives\":[{\"indices\":3,\"attributes\":{\"POSITION\":0,\"NORMAL\":1,\"TEXCOORD_0\":2}}]}]"
        "}",
        g.bin_size, a, b, c, d);
    lmn_scene       *s = load();
    const primitive *p = &s->meshes[0].primitives[0];
    assert_true(p->positions[1].x == 1 && p->positions[2].y == -1); /* −32768 is clamped */
    assert_float_equal(p->positions[2].z, 16384.0f / 32767.0f, 1e-6f);
    assert_true(p->normals[0].z == 1 && p->normals[1].y == 1 && p->normals[2].x == -1);
    assert_float_equal(p->uvs[0][2].y, 32768.0f / 65535.0f, 1e-6f);
    assert_true(p->indices[0] == 2 && p->indices[1] == 0);
    lmn_scene_destroy(&s);
}

static void sparse_values_replace_zeros(void **state)
{
    (void)state;
    begin();
    const uint16_t where[2] = {1, 2};
    const float    values[2][3] = {{2, 0, 0}, {0, 3, 0}};
    size_t         a = glb_put(&g, where, sizeof where), b = glb_put(&g, values, sizeof values);
    snprintf(g.json, sizeof g.json,
             "{" ASSET "," ONE_NODE "," BUFFER ",\"bufferViews\":[{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":4},"
             "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":24}],\"accessors\":[{\"count\":3," FLOAT3
             ",\"sparse\":{\"count\":2,\"indices\":{\"bufferView\":0,\"componentType\":5123},\"values\":{"
             "\"bufferView\":1}}}],"
             "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
             g.bin_size, a, b);
    lmn_scene       *s = load();
    const primitive *p = &s->meshes[0].primitives[0];
    assert_true(p->positions[0].x == 0 && p->positions[1].x == 2 && p->positions[2].y == 3);
    lmn_scene_destroy(&s);
    put_u32(g.bin, 3 | 2u << 16);
    lmn_error error;
    assert_int_equal(refused(&error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "sparse"));
}

/* Is there a warning with these words in it? */
static bool warns_of(const lmn_scene *s, const char *words)
{
    for (size_t i = 0; i < s->warnings.count; i++)
        if (strstr(s->warnings.items[i].text, words))
            return true;
    return false;
}

/* Found by fuzzing: the number was converted before it was looked at. */
static void texture_coordinate_sets_beyond_any_integer_are_named(void **state)
{
    (void)state;
    static const char *const numbers[] = {"4294967296", "-5000000000", "2"};
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        char words[64];
        put_square();
        snprintf(g.json, sizeof g.json,
                 "{" ASSET "," ONE_NODE "," BUFFER ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],"
                 "\"accessors\":[{\"bufferView\":0,\"count\":3," FLOAT3 "}],"
                 "\"images\":[{\"uri\":\"data:image/"
                 "png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQD"
                 "wAEhQGAhKmMIQAAAABJRU5ErkJggg==\"}],\"textures\":[{\"source\":0}],"
                 "\"materials\":[{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":0,\"texCoord\":%s}}}],"
                 "\"meshes\":[{\"primitives\":[{\"material\":0,\"attributes\":{\"POSITION\":0}}]}]}",
                 g.bin_size, numbers[i]);
        lmn_scene *s = load();
        snprintf(words, sizeof words, "texture coordinate set %s of", numbers[i]);
        assert_true(warns_of(s, words));
        assert_int_equal(s->materials[0].base_texture.uv_set, 0);
        lmn_scene_destroy(&s);
    }
}

static void materials_and_textures_are_read(void **state)
{
    (void)state;
    put_square();
    snprintf(
        g.json, sizeof g.json,
        "{" ASSET "," ONE_NODE "," BUFFER ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],"
        "\"accessors\":[{\"bufferView\":0,\"count\":3," FLOAT3 "}],"
        "\"images\":[{\"uri\":\"data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAADUlEQVR42mP8z8BQD"
        "wAEhQGAhKmMIQAAAABJRU5ErkJggg==\"},{\"uri\":\"not%%20there.png\"},{\"uri\":\"data:,nonsense\"}],"
        "\"samplers\":[{\"wrapS\":33071,\"wrapT\":33648,\"magFilter\":9728}],"
        "\"textures\":[{\"source\":0,\"sampler\":0},{\"source\":1},{\"source\":2}],"
        "\"materials\":[{\"name\":\"one\",\"alphaMode\":\"MASK\",\"alphaCutoff\":0.25,\"doubleSided\":true,"
        "\"emissiveFactor\":[1,0.5,0],\"extensions\":{\"KHR_materials_unlit\":{},"
        "\"KHR_materials_emissive_strength\":{\"emissiveStrength\":2}},\"pbrMetallicRoughness\":{"
        "\"baseColorFactor\":[0.1,0.2,0.3,0.4],\"baseColorTexture\":{\"index\":0,\"texCoord\":0,\"extensions\":{"
        "\"KHR_texture_transform\":{\"offset\":[0.5,0.25],\"scale\":[2,3],\"rotation\":1.5,\"texCoord\":1}}}}},"
        "{\"pbrMetallicRoughness\":{\"baseColorTexture\":{\"index\":1}},\"normalTexture\":{\"index\":2,\"scale\":0.5}}]"
        ","
        "\"meshes\":[{\"primitives\":[{\"material\":0,\"attributes\":{\"POSITION\":0}}]}]}",
        g.bin_size);
    lmn_scene *s = load();
    assert_int_equal(s->material_count, 2);
    const material *m = &s->materials[0];
    assert_string_equal(m->name, "one");
    assert_float_equal(m->base_colour.w, 0.4f, 1e-6f);
    assert_true(m->unlit && m->double_sided && m->alpha == ALPHA_MASK && m->alpha_cutoff == 0.25f);
    assert_true(m->emissive[0] == 2 && m->emissive[1] == 1);
    const texture_use *t = &m->base_texture;
    assert_true(t->image == 0 && t->uv_set == 1 && t->wrap_u == WRAP_CLAMP && t->wrap_v == WRAP_MIRROR && t->nearest);
    assert_true(t->offset[0] == 0.5f && t->scale[1] == 3 && t->rotation == 1.5f);
    assert_int_equal(s->image_count, 1);
    assert_true(s->images[0].width == 1 && s->images[0].height == 1 && s->images[0].pixels);
    assert_int_equal(s->materials[1].base_texture.image, NONE);
    assert_true(has_warning(s, WARNING_MISSING_FILE) && has_warning(s, WARNING_BAD_TEXTURE));
    lmn_scene_destroy(&s);
}

static void instances_are_counted_and_bounded(void **state)
{
    (void)state;
    put_square();
    const float positions[3][3] = {{0, 0, 0}, {10, 0, 0}, {0, 0, -4}}, scales[3][3] = {{1, 1, 1}, {2, 2, 2}, {1, 1, 1}};
    size_t      a = glb_put(&g, positions, sizeof positions), b = glb_put(&g, scales, sizeof scales);
    snprintf(
        g.json, sizeof g.json,
        "{" ASSET ",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"extras\":{\"layer\":\"walls\",\"height\":2.5,"
        "\"list\":[1,2]},\"extensions\":{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":1,\"SCALE\":2}}}}"
        "]," BUFFER
        ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":36},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":36}],\"accessors\":[{\"bufferView\":0,\"count\":3," FLOAT3 "},"
        "{\"bufferView\":1,\"count\":3," FLOAT3 "},{\"bufferView\":2,\"count\":3," FLOAT3 "}],"
        "\"meshes\":[{\"name\":\"leaf\",\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
        g.bin_size, a, b);
    lmn_scene    *s = load();
    lmn_part_info info;
    assert_true(lmn_scene_part_at(s, 0, &info));
    assert_true(info.instances == 3 && info.triangles == 3);
    assert_string_equal(info.name, "leaf");
    assert_true(info.bounds_max[0] == 12 && info.bounds_max[1] == 2 && info.bounds_min[2] == -4);
    const node *n = &s->nodes[s->parts[0].node];
    assert_int_equal(n->attribute_count, 3);
    assert_string_equal(n->attributes[0].value, "walls");
    assert_string_equal(n->attributes[1].value, "2.5");
    assert_string_equal(n->attributes[2].value, "[1,2]");
    lmn_scene_destroy(&s);
}

static void skins_morphs_and_animations_are_read(void **state)
{
    (void)state;
    put_square();
    const uint8_t joints[3][4] = {{1, 0, 0, 0}, {1, 0, 0, 0}, {1, 0, 0, 0}};
    const float   weights[3][4] = {{2, 0, 0, 0}, {2, 0, 0, 0}, {2, 0, 0, 0}}; /* not normalised */
    const float   offsets[3][3] = {{0, 0, 5}, {0, 0, 0}, {0, 0, 0}}, times[2] = {0.5f, 2};
    float         cubic[18], steps[2] = {0, 1};
    for (int i = 0; i < 18; i++)
        cubic[i] = (float)i;
    size_t j = glb_put(&g, joints, sizeof joints), w = glb_put(&g, weights, sizeof weights);
    size_t m = glb_put(&g, offsets, sizeof offsets), t = glb_put(&g, times, sizeof times);
    size_t c = glb_put(&g, cubic, sizeof cubic), e = glb_put(&g, steps, sizeof steps);
    snprintf(
        g.json, sizeof g.json,
        "{" ASSET ",\"scenes\":[{\"nodes\":[0,1]}],\"nodes\":[{\"mesh\":0,\"skin\":0,\"translation\":[99,0,0]},"
        "{\"name\":\"a\",\"children\":[2]},{\"name\":\"b\",\"translation\":[0,0,7]}],\"skins\":[{\"joints\":[1,2]}]"
        "," BUFFER
        ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":12},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":48},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":36},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":8},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":72},"
        "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":8}],\"accessors\":[{\"bufferView\":0,\"count\":3," FLOAT3 "},"
        "{\"bufferView\":1,\"count\":3,\"componentType\":5121,\"type\":\"VEC4\"},"
        "{\"bufferView\":2,\"count\":3,\"componentType\":5126,\"type\":\"VEC4\"},{\"bufferView\":3,\"count\":3," FLOAT3
        "},"
        "{\"bufferView\":4,\"count\":2,\"componentType\":5126,\"type\":\"SCALAR\"},{\"bufferView\":5,\"count\":"
        "6," FLOAT3 "},"
        "{\"bufferView\":6,\"count\":2,\"componentType\":5126,\"type\":\"SCALAR\"}],"
        "\"animations\":[{\"name\":\"go\",\"samplers\":[{\"input\":4,\"output\":5,\"interpolation\":\"CUBICSPLINE\"},"
        "{\"input\":4,\"output\":6,\"interpolation\":\"STEP\"},{\"input\":4,\"output\":0}],\"channels\":["
        "{\"sampler\":0,\"target\":{\"node\":1,\"path\":\"translation\"}},"
        "{\"sampler\":1,\"target\":{\"node\":0,\"path\":\"weights\"}},"
        "{\"sampler\":2,\"target\":{\"node\":1,\"path\":\"scale\"}}]}],"
        "\"meshes\":[{\"weights\":[0.5],\"primitives\":[{\"attributes\":{\"POSITION\":0,\"JOINTS_0\":1,\"WEIGHTS_0\":2}"
        ","
        "\"targets\":[{\"POSITION\":3}]}]}]}",
        g.bin_size, j, w, m, t, c, e);
    lmn_scene     *s = load();
    lmn_scene_info info = lmn_scene_info_of(s);
    /* The joint moves by 7, the morph by half of 5; the node's own position does not count. */
    assert_true(info.bounds_max[0] == 1 && info.bounds_min[2] == 7 && info.bounds_max[2] == 9.5);
    assert_true(s->meshes[0].primitives[0].weights[0] == 1);
    const animation *a = &s->animations[0];
    assert_true(a->channel_count == 2 && a->duration == 2); /* the third has too few values */
    assert_true(has_warning(s, WARNING_BAD_VALUE));
    assert_true(a->channels[0].interpolation == INTERPOLATION_CUBIC && a->channels[0].key_count == 2);
    assert_true(a->channels[0].values[17] == 17 && a->channels[0].components == 3);
    assert_true(a->channels[1].interpolation == INTERPOLATION_STEP && a->channels[1].path == PATH_WEIGHTS);
    assert_int_equal(a->channels[1].components, 1);
    lmn_scene_destroy(&s);
}

static void edge_visibility_is_unpacked(void **state)
{
    (void)state;
    put_square();
    const uint16_t indices[6] = {0, 1, 2, 2, 1, 3};
    /* Edges 1, 2, 0, 3 and 2, 0 in two bits each, lowest first. */
    const uint8_t packed[2] = {1 | 2 << 2 | 0 << 4 | 3 << 6, 2};
    size_t        a = glb_put(&g, indices, sizeof indices), b = glb_put(&g, packed, sizeof packed);
    snprintf(g.json, sizeof g.json,
             "{" ASSET "," ONE_NODE "," BUFFER ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48},"
             "{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":12},{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":2}],"
             "\"accessors\":[{\"bufferView\":0,\"count\":4," FLOAT3
             "},{\"bufferView\":1,\"count\":6,\"componentType\":5123,"
             "\"type\":\"SCALAR\"},{\"bufferView\":2,\"count\":2,\"componentType\":5121,\"type\":\"SCALAR\"}],"
             "\"meshes\":[{\"primitives\":[{\"indices\":1,\"attributes\":{\"POSITION\":0},\"extensions\":{"
             "\"EXT_mesh_primitive_edge_visibility\":{\"visibility\":2}}}]}]}",
             g.bin_size, a, b);
    lmn_scene    *s = load();
    const uint8_t expected[6] = {1, 2, 0, 3, 2, 0};
    assert_memory_equal(s->meshes[0].primitives[0].edges.values, expected, 6);
    lmn_scene_destroy(&s);
}

static void cameras_and_lights_are_read(void **state)
{
    (void)state;
    put_square();
    snprintf(
        g.json, sizeof g.json,
        "{" ASSET ",\"scenes\":[{\"nodes\":[0]}],\"nodes\":[{\"mesh\":0,\"camera\":1,\"extensions\":{"
        "\"KHR_lights_punctual\":{\"light\":1}}}]," BUFFER ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],"
        "\"accessors\":[{\"bufferView\":0,\"count\":3," FLOAT3
        "}],\"cameras\":[{\"name\":\"wide\",\"type\":\"perspective\","
        "\"perspective\":{\"yfov\":0.7,\"znear\":0.1}},{\"type\":\"orthographic\",\"orthographic\":{\"xmag\":2,"
        "\"ymag\":3,"
        "\"znear\":0.5,\"zfar\":9}}],\"extensions\":{\"KHR_lights_punctual\":{\"lights\":[{\"type\":\"directional\"},"
        "{\"type\":\"spot\",\"color\":[1,0.5,0],\"intensity\":4,\"range\":6,\"spot\":{\"outerConeAngle\":0.5}}]}},"
        "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
        g.bin_size);
    lmn_scene *s = load();
    assert_true(s->camera_count == 2 && !s->cameras[0].orthographic && s->cameras[0].fov_y == 0.7 &&
                s->cameras[0].far == 0);
    assert_true(s->cameras[1].orthographic && s->cameras[1].half_height == 3 && s->cameras[1].far == 9);
    assert_true(s->light_count == 2 && s->lights[1].type == LIGHT_SPOT && s->lights[1].intensity == 4);
    assert_true(s->lights[1].outer_cone == 0.5f && s->lights[1].colour[1] == 0.5f);
    const node *n = &s->nodes[s->parts[0].node];
    assert_true(n->camera == 1 && n->light == 1);
    lmn_scene_destroy(&s);
}

static void scenes_order_their_parts(void **state)
{
    (void)state;
    static const char *const scenes[] = {"\"scene\":1,\"scenes\":[{\"nodes\":[0]},{\"nodes\":[2,0]}]", "\"scenes\":[]"};
    static const char *const paths[2][3] = {{"built/c", "built/c/b", "built/a"}, {"built/a", "built/c", "built/c/b"}};
    for (int i = 0; i < 2; i++) {
        put_square();
        snprintf(g.json, sizeof g.json,
                 "{" ASSET
                 ",%s,\"nodes\":[{\"name\":\"a\",\"mesh\":0},{\"name\":\"b\",\"mesh\":0},{\"name\":\"c\",\"mesh\":0,"
                 "\"children\":[1]}]," BUFFER ",\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],"
                 "\"accessors\":[{\"bufferView\":0,\"count\":3," FLOAT3 "}],"
                 "\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
                 scenes[i], g.bin_size);
        lmn_scene *s = load();
        assert_int_equal(s->part_count, 3);
        for (int k = 0; k < 3; k++)
            assert_string_equal(s->parts[k].path, paths[i][k]);
        lmn_scene_destroy(&s);
    }
}

static void side_files_are_found(void **state)
{
    (void)state;
    lmn_error   error;
    const char *json =
        "{" ASSET "," ONE_NODE ",\"buffers\":[{\"byteLength\":48,\"uri\":\"s%C3%A4ule%201.bin\"}],"
        "\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}],\"accessors\":[{\"bufferView\":0,\"count\":3," FLOAT3
        "}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}";
    assert_int_equal(load_status(temp_file("side.gltf", json, strlen(json)), &error), LMN_READ);
    assert_non_null(strstr(error.message, "säule 1.bin"));
    temp_file("säule 1.bin", square, 20);
    assert_int_equal(load_status(temp_file("side.gltf", json, strlen(json)), &error), LMN_FORMAT);
    temp_file("säule 1.bin", square, sizeof square);
    lmn_scene *s = load_or_fail(temp_file("side.gltf", json, strlen(json)));
    assert_int_equal(s->part_count, 1);
    lmn_scene_destroy(&s);
}

static void meshopt_streams_are_decoded(void **state)
{
    (void)state;
    enum { COUNT = 1000 };
    static float         positions[COUNT][3];
    static unsigned char packed[65536];
    for (int i = 0; i < COUNT; i++) {
        positions[i][0] = (float)(i % 37);
        positions[i][1] = (float)(i / 37);
        positions[i][2] = sinf((float)i);
    }
    begin();
    size_t size = meshopt_encodeVertexBuffer(packed, sizeof packed, positions, COUNT, 12);
    glb_put(&g, packed, size);
    snprintf(
        g.json, sizeof g.json,
        "{" ASSET "," ONE_NODE
        ",\"extensionsRequired\":[\"EXT_meshopt_compression\"],\"buffers\":[{\"byteLength\":%zu},"
        "{\"byteLength\":12000,\"extensions\":{\"EXT_meshopt_compression\":{\"fallback\":true}}}],\"bufferViews\":["
        "{\"buffer\":1,\"byteLength\":12000,\"extensions\":{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteLength\":%"
        "zu,"
        "\"byteStride\":12,\"count\":%d,\"mode\":\"ATTRIBUTES\"}}}],\"accessors\":[{\"bufferView\":0,\"count\":"
        "999," FLOAT3 "}],\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]}",
        g.bin_size, size, COUNT);
    lmn_scene       *s = load();
    const primitive *p = &s->meshes[0].primitives[0];
    assert_int_equal(
        p->index_count / 3 + (uint32_t)strtoul(s->warnings.count ? s->warnings.items[0].text : "0", NULL, 10), 333);
    assert_memory_equal(&p->positions[0], positions[0], 12);
    lmn_scene_destroy(&s);
    lmn_error error;
    g.bin[0] ^= 0xFF;
    assert_int_equal(refused(&error), LMN_FORMAT);
    assert_non_null(strstr(error.message, "damaged"));
}

/* Each: what is wrong, and a word that the message must have. */
static void wrong_content_is_explained(void **state)
{
    (void)state;
#define REST ",\"buffers\":[{\"byteLength\":48}],\"bufferViews\":[{\"buffer\":0,\"byteLength\":48}]"
#define MESH ",\"meshes\":[{\"primitives\":[{\"attributes\":{\"POSITION\":0}}]}]"
#define GOOD ",\"accessors\":[{\"bufferView\":0,\"count\":4," FLOAT3 "}]"
    static const struct {
        const char *json, *said;
        lmn_status  status;
    } cases[] = {
        {"{" ASSET ",\"nodes\":[{\"children\":[1]},{\"children\":[0],\"mesh\":0}]" REST GOOD MESH "}", "ancestor",
         LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"children\":[2]},{\"children\":[2]},{\"mesh\":0}]" REST GOOD MESH "}", "twice",
         LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"children\":[7]}]" REST GOOD MESH "}", "nodes[0].children[0]", LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"mesh\":3}]" REST GOOD MESH "}", "meshes[3]", LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"mesh\":0}]" REST ",\"accessors\":[{\"bufferView\":0,\"count\":5," FLOAT3 "}]" MESH
         "}",
         "do not fit", LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"mesh\":0}]" REST
         ",\"accessors\":[{\"bufferView\":0,\"byteOffset\":18446744073709551615,"
         "\"count\":3," FLOAT3 "}]" MESH "}",
         "JSON", LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"mesh\":0}]" REST
         ",\"accessors\":[{\"bufferView\":0,\"byteOffset\":9223372036854775807,"
         "\"count\":3," FLOAT3 "}]" MESH "}",
         "do not fit", LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"mesh\":0}]" REST ",\"accessors\":[{\"count\":999999999999," FLOAT3 "}]" MESH "}",
         "999999999999", LMN_LIMIT},
        {"{" ASSET ",\"nodes\":[{\"mesh\":0}]" REST ",\"accessors\":[{\"bufferView\":0,\"count\":3,\"type\":\"VEC9\","
         "\"componentType\":5126}]" MESH "}",
         "type", LMN_FORMAT},
        {"{" ASSET ",\"nodes\":[{\"mesh\":0}],\"buffers\":[{\"byteLength\":480}],\"bufferViews\":[{\"buffer\":0,"
         "\"byteLength\":48}]" GOOD MESH "}",
         "promised", LMN_FORMAT},
        {"{" ASSET ",\"extensionsRequired\":[\"EXT_magic\"]}", "EXT_magic", LMN_UNSUPPORTED},
        {"{\"asset\":{\"version\":\"1.0\"}}", "1.0", LMN_UNSUPPORTED},
        {"{\"scenes\":[]}", "asset.version", LMN_FORMAT},
        {"{" ASSET ",\"nodes\":{}}", "nodes", LMN_FORMAT},
        {"{" ASSET ",", "JSON", LMN_FORMAT},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        lmn_error error;
        put_square();
        snprintf(g.json, sizeof g.json, "%s", cases[i].json);
        lmn_status status = refused(&error);
        if (status != cases[i].status || !strstr(error.message, cases[i].said))
            print_error("case %zu: %s\n", i, error.message);
        assert_int_equal(status, cases[i].status);
        assert_non_null(strstr(error.message, cases[i].said));
    }
}

static void deep_nesting_is_a_limit(void **state)
{
    (void)state;
    lmn_error error;
    begin();
    int at = snprintf(g.json, sizeof g.json, "{" ASSET ",\"extras\":");
    for (int i = 0; i < 300; i++)
        at += snprintf(g.json + at, sizeof g.json - (size_t)at, "[");
    assert_int_equal(refused(&error), LMN_LIMIT);
    static char big[200000];
    size_t      size = (size_t)snprintf(big, sizeof big, "{" ASSET ",\"nodes\":[");
    for (int i = 1; i < 2000; i++)
        size += (size_t)snprintf(big + size, sizeof big - size, "{\"children\":[%d]},", i);
    size += (size_t)snprintf(big + size, sizeof big - size, "{}]}");
    assert_int_equal(load_status(temp_file("deep.gltf", big, size), &error), LMN_LIMIT);
    assert_non_null(strstr(error.message, "deeper"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(strips_and_fans_become_triangles),
        cmocka_unit_test(quantised_positions_keep_their_meaning),
        cmocka_unit_test(sparse_values_replace_zeros),
        cmocka_unit_test(materials_and_textures_are_read),
        cmocka_unit_test(texture_coordinate_sets_beyond_any_integer_are_named),
        cmocka_unit_test(instances_are_counted_and_bounded),
        cmocka_unit_test(skins_morphs_and_animations_are_read),
        cmocka_unit_test(edge_visibility_is_unpacked),
        cmocka_unit_test(cameras_and_lights_are_read),
        cmocka_unit_test(scenes_order_their_parts),
        cmocka_unit_test(side_files_are_found),
        cmocka_unit_test(meshopt_streams_are_decoded),
        cmocka_unit_test(wrong_content_is_explained),
        cmocka_unit_test(deep_nesting_is_a_limit),
    };
    return cmocka_run_group_tests(tests, NULL, remove_temp_folder);
}
