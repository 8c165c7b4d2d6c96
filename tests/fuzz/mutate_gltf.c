/* Changes JSON as JSON, so that most of what comes out is read beyond its first byte: numbers, indices, whole
 * members; and the bytes of glTF's buffers behind their base64. */
#include <jansson.h>
#include <math.h>
#include <string.h>

#include "base/memory.h"
#include "fuzz.h"

enum { VALUES_MOST = 4096, BUFFER_MOST = 16384, DEPTH_MOST = 64 };

/* A value and where it hangs. */
typedef struct position {
    json_t     *parent, *value;
    const char *key;   /* of objects */
    size_t      index; /* of arrays */
} position;

typedef struct positions {
    position items[VALUES_MOST];
    size_t   count;
} positions;

static void collect(positions *p, json_t *value, int depth)
{
    if (depth > DEPTH_MOST)
        return;
    if (json_is_object(value)) {
        const char *key;
        json_t     *child;
        json_object_foreach(value, key, child)
        {
            if (p->count < VALUES_MOST)
                p->items[p->count++] = (position){value, child, key, 0};
            collect(p, child, depth + 1);
        }
    } else if (json_is_array(value)) {
        for (size_t i = 0; i < json_array_size(value); i++) {
            if (p->count < VALUES_MOST)
                p->items[p->count++] = (position){value, json_array_get(value, i), NULL, i};
            collect(p, json_array_get(value, i), depth + 1);
        }
    }
}

/* Takes over the reference to `value`. */
static void put(const position *at, json_t *value)
{
    if (at->key)
        json_object_set_new(at->parent, at->key, value);
    else
        json_array_set_new(at->parent, at->index, value);
}

static json_t *number(uint32_t *state, const json_t *before)
{
    const double value = fuzz_number(state, json_number_value(before));
    if (json_is_integer(before) && fuzz_random(state, 8) != 0)
        return json_integer(fuzz_random(state, 2) || !(fabs(value) < 1e18) ? (json_int_t)fuzz_random(state, 8)
                                                                           : (json_int_t)value);
    return json_real(value);
}

/* --- buffers in base64 ---------------------------------------------------------------------------------- */

static const char letters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";

static size_t decode(const char *text, uint8_t *out, size_t most)
{
    size_t   count = 0;
    uint32_t bits = 0;
    int      have = 0;
    for (; *text && *text != '=' && count < most; text++) {
        const char *found = strchr(letters, *text);
        if (!found)
            continue;
        bits = bits << 6 | (uint32_t)(found - letters);
        have += 6;
        if (have >= 8) {
            have -= 8;
            out[count++] = (uint8_t)(bits >> have);
        }
    }
    return count;
}

static void encode(const uint8_t *bytes, size_t size, char *out)
{
    for (size_t i = 0; i < size; i += 3) {
        const uint32_t left = (uint32_t)(size - i);
        const uint32_t bits =
            (uint32_t)bytes[i] << 16 | (left > 1 ? (uint32_t)bytes[i + 1] << 8 : 0) | (left > 2 ? bytes[i + 2] : 0u);
        *out++ = letters[bits >> 18];
        *out++ = letters[bits >> 12 & 63];
        *out++ = left > 1 ? letters[bits >> 6 & 63] : '=';
        *out++ = left > 2 ? letters[bits & 63] : '=';
    }
    *out = '\0';
}

/* Changes what is behind a data URI: as floats and as bytes. */
static void change_buffer(const position *at, uint32_t *state)
{
    const char *text = json_string_value(at->value), *comma = text ? strchr(text, ',') : NULL;
    if (!comma || strncmp(text, "data:", 5) != 0)
        return;
    const size_t head = (size_t)(comma + 1 - text);
    uint8_t     *bytes = mem_alloc(BUFFER_MOST);
    char        *whole = mem_alloc(head + BUFFER_MOST * 2);
    if (bytes && whole) {
        size_t size = decode(comma + 1, bytes, BUFFER_MOST);
        if (size >= 4 && fuzz_random(state, 2)) {
            static const float floats[] = {0, 1, -1, 1e30f, -1e30f, 1e-40f, NAN, INFINITY, 0.5f, 1e7f};
            const size_t       offset = fuzz_random(state, (uint32_t)(size / 4)) * 4;
            memcpy(bytes + offset, &floats[fuzz_random(state, sizeof floats / sizeof *floats)], 4);
        } else {
            const size_t now = LLVMFuzzerMutate(
                bytes, size, size + (fuzz_random(state, 4) ? 0 : 16) < BUFFER_MOST ? size + 16 : BUFFER_MOST);
            /* Buffers that get shorter are all refused in the same way. */
            size = now > size || fuzz_random(state, 16) == 0 ? now : size;
        }
        memcpy(whole, text, head);
        encode(bytes, size, whole + head);
        put(at, json_string(whole));
    }
    mem_free(bytes);
    mem_free(whole);
}

/* --- one change ----------------------------------------------------------------------------------------- */

/* Extensions and members that models may have in many positions. */
static const char *const members[][2] = {
    {"sparse", "{\"count\":1,\"indices\":{\"bufferView\":0,\"componentType\":5121},\"values\":{\"bufferView\":0}}"},
    {"extensions", "{\"KHR_mesh_quantization\":{}}"},
    {"extensions", "{\"EXT_meshopt_compression\":{\"buffer\":0,\"byteLength\":16,\"byteStride\":4,\"count\":4,\"mode\":"
                   "\"ATTRIBUTES\"}}"},
    {"extensions", "{\"KHR_draco_mesh_compression\":{\"bufferView\":0,\"attributes\":{\"POSITION\":0}}}"},
    {"extensions", "{\"EXT_mesh_gpu_instancing\":{\"attributes\":{\"TRANSLATION\":0}}}"},
    {"extensions", "{\"KHR_texture_transform\":{\"offset\":[1,2],\"rotation\":3,\"scale\":[0,1e9],\"texCoord\":1}}"},
    {"extensions", "{\"KHR_lights_punctual\":{\"light\":0}}"},
    {"extensions", "{\"EXT_texture_webp\":{\"source\":0}}"},
    {"extensions", "{\"KHR_materials_variants\":{\"variants\":[{\"name\":\"a\"}]}}"},
    {"children", "[0]"},
    {"mesh", "0"},
    {"skin", "0"},
    {"camera", "0"},
    {"mode", "5"},
    {"targets", "[{\"POSITION\":0}]"},
    {"weights", "[0.5,1e30]"},
    {"indices", "0"},
    {"material", "0"},
    {"byteStride", "4"},
    {"byteOffset", "4"},
    {"normalized", "true"},
    {"matrix", "[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]"},
    {"scale", "[0,-1,1e30]"},
    {"rotation", "[0,0,0,0]"},
    {"translation", "[1e300,0,0]"},
    {"interpolation", "\"CUBICSPLINE\""},
    {"extras", "{\"a\":{\"b\":[1,\"c\"]}}"},
    {"name", "\"a/b, \\\"c\\\"\""},
};

static void add_member(const position *at, uint32_t *state)
{
    const size_t which = fuzz_random(state, sizeof members / sizeof *members);
    json_t      *value = json_loads(members[which][1], JSON_DECODE_ANY, NULL);
    json_t      *object = json_is_object(at->value) ? at->value : at->parent;
    if (json_is_object(object))
        json_object_set_new(object, members[which][0], value);
    else
        json_decref(value);
}

static void change_once(positions *p, json_t *root, uint32_t *state)
{
    p->count = 0;
    collect(p, root, 0);
    if (p->count == 0)
        return;
    const position at = p->items[fuzz_random(state, (uint32_t)p->count)],
                   other = p->items[fuzz_random(state, (uint32_t)p->count)];
    if (json_is_string(at.value) && strchr(json_string_value(at.value), ',')) {
        change_buffer(&at, state);
        return;
    }
    switch (fuzz_random(state, 12)) {
    case 0: /* the other value instead: swaps accessors, views, types */ put(&at, json_deep_copy(other.value)); break;
    case 1:
        if (at.key)
            json_object_del(at.parent, at.key);
        else
            json_array_remove(at.parent, at.index);
        break;
    case 2: /* once more: items of lists, in the list of another */
        if (json_is_array(other.value))
            json_array_append_new(other.value, json_deep_copy(at.value));
        else if (!at.key)
            json_array_append_new(at.parent, json_deep_copy(at.value));
        break;
    case 3: add_member(&at, state); break;
    case 4: /* one deeper */ put(&at, json_pack("[O]", at.value)); break;
    case 5: {
        static const char *const words[] = {"SCALAR", "VEC2",        "VEC3",        "VEC4",     "MAT4",  "STEP",
                                            "LINEAR", "CUBICSPLINE", "translation", "rotation", "scale", "weights",
                                            ""};
        put(&at, json_is_string(at.value) ? json_string(words[fuzz_random(state, sizeof words / sizeof *words)])
                                          : json_null());
        break;
    }
    default:
        if (json_is_number(at.value))
            put(&at, number(state, at.value));
        else if (json_is_boolean(at.value))
            put(&at, json_boolean(!json_is_true(at.value)));
        break;
    }
}

/* Changes a text of JSON a few times. 0 when it is none or does not fit. */
static size_t change_json(uint8_t *bytes, size_t size, size_t most, uint32_t *state)
{
    json_t    *root = json_loadb((const char *)bytes, size, JSON_ALLOW_NUL, NULL);
    positions *p = mem_alloc(sizeof *p);
    size_t     now = 0;
    if (root && p) {
        for (uint32_t n = 1 + fuzz_random(state, 3); n > 0; n--)
            change_once(p, root, state);
        now = json_dumpb(root, (char *)bytes, 0, JSON_COMPACT);
        /* json_dumpb says what it needs; only what fits is written. */
        now = now > 0 && now <= most ? json_dumpb(root, (char *)bytes, most, JSON_COMPACT) : 0;
    }
    mem_free(p);
    json_decref(root);
    return now;
}

size_t fuzz_mutate_look(uint8_t *bytes, size_t size, size_t most, unsigned seed)
{
    uint32_t     state = seed;
    const size_t now = fuzz_random(&state, 4) ? change_json(bytes, size, most, &state) : 0;
    return now ? now : LLVMFuzzerMutate(bytes, size, most);
}

size_t fuzz_mutate_gltf(uint8_t *bytes, size_t size, size_t most, unsigned seed)
{
    uint32_t     state = seed;
    const size_t now = fuzz_random(&state, 10) ? change_json(bytes, size, most, &state) : 0;
    return now ? now : LLVMFuzzerMutate(bytes, size, most);
}

/* --- the binary container ------------------------------------------------------------------------------- */

enum { GLB_HEAD = 12, GLB_CHUNK = 8 };

static void put_word(uint8_t *at, size_t value)
{
    for (int i = 0; i < 4; i++)
        at[i] = (uint8_t)(value >> 8 * i);
}

static size_t get_word(const uint8_t *at)
{
    return at[0] | (size_t)at[1] << 8 | (size_t)at[2] << 16 | (size_t)at[3] << 24;
}

/* The JSON or the binary chunk is changed and the lengths are set right; one time in eight the container itself is
 * changed. */
size_t fuzz_mutate_glb(uint8_t *bytes, size_t size, size_t most, unsigned seed)
{
    uint32_t     state = seed;
    const size_t begin = GLB_HEAD + GLB_CHUNK;
    size_t       json = size > begin ? get_word(bytes + GLB_HEAD) : 0;
    if (size <= begin || json > size - begin || json == 0 || most < size || fuzz_random(&state, 8) == 0)
        return LLVMFuzzerMutate(bytes, size, most);
    const size_t tail = size - begin - json;
    uint8_t     *copy = mem_alloc(most), *rest = mem_alloc(most);
    size_t       now = 0, rest_size = tail;
    if (copy && rest) {
        memcpy(copy, bytes + begin, json);
        memcpy(rest, bytes + begin + json, tail);
        if (tail > GLB_CHUNK && fuzz_random(&state, 3) == 0) {
            now = json;
            rest_size = GLB_CHUNK + LLVMFuzzerMutate(rest + GLB_CHUNK, tail - GLB_CHUNK,
                                                     tail - GLB_CHUNK + 64 < most - GLB_CHUNK ? tail - GLB_CHUNK + 64
                                                                                              : most - GLB_CHUNK);
            put_word(rest, rest_size - GLB_CHUNK);
        } else {
            now = change_json(copy, json, most - 4, &state);
            while (now % 4)
                copy[now++] = ' ';
        }
    }
    if (now && begin + now + rest_size <= most) {
        memcpy(bytes + begin, copy, now);
        memcpy(bytes + begin + now, rest, rest_size);
        put_word(bytes + GLB_HEAD, now);
        size = begin + now + rest_size;
        put_word(bytes + 8, size);
    } else {
        size = LLVMFuzzerMutate(bytes, size, most);
    }
    mem_free(copy);
    mem_free(rest);
    return size;
}
