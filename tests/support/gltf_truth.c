#include "gltf_truth.h"

#include <jansson.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { BUFFERS_MAX = 8, FLOAT_TYPE = 5126, BYTE_TYPE = 5121, SHORT_TYPE = 5123 };

typedef struct blob {
    unsigned char *bytes;
    size_t         size;
} blob;

struct gltf_truth {
    json_t *root;
    blob    buffers[BUFFERS_MAX];
};

/* Rows of 4 by 4 numbers acting on columns. */
typedef struct matrix {
    double m[4][4];
} matrix;

/* What one node is at a time. */
typedef struct state {
    double t[3], r[4], s[3];
    bool   fixed; /* a matrix of its own */
    matrix own;
    double weights[64];
    size_t weight_count;
} state;

/* --- reading -------------------------------------------------------------------------------------------- */

static blob read_whole(const char *path)
{
    blob  b = {NULL, 0};
    FILE *f = fopen(path, "rb");
    if (!f)
        return b;
    fseek(f, 0, SEEK_END);
    b.size = (size_t)ftell(f);
    rewind(f);
    b.bytes = malloc(b.size + 1);
    if (!b.bytes || fread(b.bytes, 1, b.size, f) != b.size)
        b.size = 0;
    fclose(f);
    return b;
}

static uint32_t word_at(const unsigned char *p)
{
    uint32_t v;
    memcpy(&v, p, sizeof v);
    return v;
}

static json_t *item(const gltf_truth *t, const char *list, size_t index)
{
    return json_array_get(json_object_get(t->root, list), index);
}

static size_t whole(json_t *object, const char *key, size_t otherwise)
{
    json_t *v = json_object_get(object, key);
    return json_is_integer(v) ? (size_t)json_integer_value(v) : otherwise;
}

/* The rest of a .glb behind its JSON is its first buffer. */
static bool open_binary(gltf_truth *t, blob file)
{
    uint32_t size = word_at(file.bytes + 12);
    t->root = json_loadb((const char *)file.bytes + 20, size, 0, NULL);
    size_t at = 20 + (size_t)size;
    if (at + 8 <= file.size) {
        t->buffers[0].size = word_at(file.bytes + at);
        t->buffers[0].bytes = malloc(t->buffers[0].size);
        if (t->buffers[0].bytes)
            memcpy(t->buffers[0].bytes, file.bytes + at + 8, t->buffers[0].size);
    }
    return t->root;
}

gltf_truth *gltf_truth_load(const char *path)
{
    gltf_truth *t = calloc(1, sizeof *t);
    blob        file = read_whole(path);
    bool        good = t && file.size > 20;
    if (good && memcmp(file.bytes, "glTF", 4) == 0)
        good = open_binary(t, file);
    else if (good)
        good = (t->root = json_loadb((const char *)file.bytes, file.size, 0, NULL)) != NULL;
    for (size_t i = 0; good && i < json_array_size(json_object_get(t->root, "buffers")) && i < BUFFERS_MAX; i++) {
        const char *uri = json_string_value(json_object_get(item(t, "buffers", i), "uri")), *slash = strrchr(path, '/');
        char        beside[1024];
        if (!uri)
            continue;
        snprintf(beside, sizeof beside, "%.*s%s", slash ? (int)(slash - path) + 1 : 0, path, uri);
        t->buffers[i] = read_whole(beside);
        good = t->buffers[i].size > 0;
    }
    free(file.bytes);
    if (!good) {
        gltf_truth_destroy(t);
        return NULL;
    }
    return t;
}

void gltf_truth_destroy(gltf_truth *t)
{
    if (!t)
        return;
    for (int i = 0; i < BUFFERS_MAX; i++)
        free(t->buffers[i].bytes);
    json_decref(t->root);
    free(t);
}

static size_t count_of(const gltf_truth *t, size_t accessor)
{
    return whole(item(t, "accessors", accessor), "count", 0);
}

/* One number of an accessor's element; normalised integers as glTF 2.0, section 3.6.2.2 says. */
static double number_at(const gltf_truth *t, size_t accessor, size_t element, size_t component, size_t components)
{
    json_t     *a = item(t, "accessors", accessor), *view = item(t, "bufferViews", whole(a, "bufferView", 0));
    const blob *b = &t->buffers[whole(view, "buffer", 0)];
    size_t      type = whole(a, "componentType", FLOAT_TYPE), size = type == FLOAT_TYPE || type == 5125 ? 4
                                                                     : type == SHORT_TYPE               ? 2
                                                                                                        : 1;
    size_t      stride = whole(view, "byteStride", components * size),
           at = whole(view, "byteOffset", 0) + whole(a, "byteOffset", 0) + element * stride + component * size;
    bool     unit = json_is_true(json_object_get(a, "normalized"));
    float    f;
    uint16_t s;
    if (at + size > b->size)
        return NAN;
    if (type == FLOAT_TYPE) {
        memcpy(&f, b->bytes + at, sizeof f);
        return (double)f;
    }
    if (type == BYTE_TYPE)
        return unit ? b->bytes[at] / 255.0 : b->bytes[at];
    if (type == SHORT_TYPE) {
        memcpy(&s, b->bytes + at, sizeof s);
        return unit ? s / 65535.0 : s;
    }
    return type == 5125 ? (double)word_at(b->bytes + at) : (double)NAN;
}

static void numbers_of(json_t *object, const char *key, double *out, size_t count)
{
    json_t *list = json_object_get(object, key);
    for (size_t i = 0; i < count && i < json_array_size(list); i++)
        out[i] = json_number_value(json_array_get(list, i));
}

/* --- matrices ------------------------------------------------------------------------------------------- */

static matrix identity(void)
{
    matrix m = {{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}};
    return m;
}

static matrix times(const matrix *a, const matrix *b)
{
    matrix m;
    for (int r = 0; r < 4; r++)
        for (int c = 0; c < 4; c++) {
            m.m[r][c] = 0;
            for (int k = 0; k < 4; k++)
                m.m[r][c] += a->m[r][k] * b->m[k][c];
        }
    return m;
}

/* The point turned by a quaternion: q p q*, written out as p + 2 w (u × p) + 2 u × (u × p). */
static void turn(const double q[4], const double p[3], double out[3])
{
    double a[3], b[3];
    for (int k = 0; k < 3; k++)
        a[k] = q[(k + 1) % 3] * p[(k + 2) % 3] - q[(k + 2) % 3] * p[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        b[k] = q[(k + 1) % 3] * a[(k + 2) % 3] - q[(k + 2) % 3] * a[(k + 1) % 3];
    for (int k = 0; k < 3; k++)
        out[k] = p[k] + 2 * q[3] * a[k] + 2 * b[k];
}

static matrix local_of(const state *s)
{
    matrix m = identity();
    if (s->fixed)
        return s->own;
    for (int c = 0; c < 3; c++) {
        double axis[3] = {0, 0, 0}, turned[3];
        axis[c] = s->s[c];
        turn(s->r, axis, turned);
        for (int r = 0; r < 3; r++)
            m.m[r][c] = turned[r];
        m.m[c][3] = s->t[c];
    }
    return m;
}

/* --- nodes at a time ------------------------------------------------------------------------------------ */

static void rest_state(const gltf_truth *t, json_t *node, state *s)
{
    *s = (state){.r = {0, 0, 0, 1}, .s = {1, 1, 1}};
    numbers_of(node, "translation", s->t, 3);
    numbers_of(node, "rotation", s->r, 4);
    numbers_of(node, "scale", s->s, 3);
    double own[16];
    if (json_object_get(node, "matrix")) {
        numbers_of(node, "matrix", own, 16);
        s->fixed = true;
        for (int i = 0; i < 16; i++)
            s->own.m[i % 4][i / 4] = own[i];
    }
    json_t *weights = json_object_get(node, "weights");
    if (!weights && json_object_get(node, "mesh"))
        weights = json_object_get(item(t, "meshes", whole(node, "mesh", 0)), "weights");
    for (size_t i = 0; i < json_array_size(weights) && i < 64; i++)
        s->weights[s->weight_count++] = json_number_value(json_array_get(weights, i));
}

/* Interpolation by appendix C of the specification. `v` has one number for each of `n` components. */
static void sample(const gltf_truth *t, json_t *sampler, double seconds, size_t n, size_t width, bool turns, double *v)
{
    size_t      in = whole(sampler, "input", 0), out = whole(sampler, "output", 0), keys = count_of(t, in), k = 0;
    const char *how = json_string_value(json_object_get(sampler, "interpolation"));
    bool        cubic = how && strcmp(how, "CUBICSPLINE") == 0, step = how && strcmp(how, "STEP") == 0;
#define VALUE(key, part, i)                                                                                            \
    number_at(t, out, ((cubic ? 3 * (key) + (part) : (key)) * n + (i)) / width, ((i) % width), width)
    while (k + 1 < keys && number_at(t, in, k + 1, 0, 1) <= seconds)
        k++;
    double from = number_at(t, in, k, 0, 1), to = k + 1 < keys ? number_at(t, in, k + 1, 0, 1) : from;
    double span = to - from, u = span > 0 && seconds > from ? (seconds - from) / span : 0, dot = 0;
    if (k + 1 == keys || step)
        u = 0;
    for (size_t i = 0; i < n; i++) {
        double a = VALUE(k, 1, i), b = u > 0 ? VALUE(k + 1, 1, i) : a;
        dot += a * b;
        v[i] = a + u * (b - a);
        if (cubic && u > 0)
            v[i] = (2 * u * u * u - 3 * u * u + 1) * a + span * (u * u * u - 2 * u * u + u) * VALUE(k, 2, i) +
                   (-2 * u * u * u + 3 * u * u) * b + span * (u * u * u - u * u) * VALUE(k + 1, 0, i);
    }
    if (turns && !cubic && u > 0) {
        /* Along the great circle: the angle from the chord, which is exact where the cosine is not. */
        double sign = dot < 0 ? -1 : 1, chord = 0, a[4], b[4], sizes[2] = {0, 0};
        for (size_t i = 0; i < 4; i++) {
            sizes[0] += VALUE(k, 1, i) * VALUE(k, 1, i);
            sizes[1] += VALUE(k + 1, 1, i) * VALUE(k + 1, 1, i);
        }
        for (size_t i = 0; i < 4; i++) { /* files write few digits: not quite of length 1, as they should be */
            a[i] = VALUE(k, 1, i) / sqrt(sizes[0]);
            b[i] = sign * VALUE(k + 1, 1, i) / sqrt(sizes[1]);
            chord += (a[i] - b[i]) * (a[i] - b[i]);
        }
        double angle = 2 * asin(fmin(sqrt(chord) / 2, 1));
        for (size_t i = 0; i < 4 && angle > 1e-9; i++)
            v[i] = (sin((1 - u) * angle) * a[i] + sin(u * angle) * b[i]) / sin(angle);
    }
#undef VALUE
    double length = turns ? sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2] + v[3] * v[3]) : 1;
    for (size_t i = 0; i < n; i++)
        v[i] /= length;
}

static void apply(const gltf_truth *t, json_t *clip, double seconds, state *states)
{
    json_t *channel;
    size_t  i;
    json_array_foreach(json_object_get(clip, "channels"), i, channel)
    {
        json_t     *target = json_object_get(channel, "target");
        const char *path = json_string_value(json_object_get(target, "path"));
        json_t     *sampler = json_array_get(json_object_get(clip, "samplers"), whole(channel, "sampler", 0));
        state      *s = &states[whole(target, "node", 0)];
        if (strcmp(path, "rotation") == 0)
            sample(t, sampler, seconds, 4, 4, true, s->r);
        else if (strcmp(path, "weights") == 0)
            sample(t, sampler, seconds, s->weight_count, 1, false, s->weights);
        else
            sample(t, sampler, seconds, 3, 3, false, strcmp(path, "scale") == 0 ? s->s : s->t);
    }
}

static void walk(const gltf_truth *t, const state *states, size_t node, const matrix *above, matrix *worlds,
                 size_t *order, size_t *count)
{
    matrix local = local_of(&states[node]);
    worlds[node] = times(above, &local);
    order[(*count)++] = node;
    json_t *children = json_object_get(item(t, "nodes", node), "children");
    for (size_t i = 0; i < json_array_size(children); i++)
        walk(t, states, (size_t)json_integer_value(json_array_get(children, i)), &worlds[node], worlds, order, count);
}

/* --- corners -------------------------------------------------------------------------------------------- */

/* One matrix a joint, from the mesh to the world; free with free. */
static matrix *skin_matrices(const gltf_truth *t, json_t *skin, const matrix *worlds)
{
    json_t *joints = json_object_get(skin, "joints");
    size_t  binds = whole(skin, "inverseBindMatrices", SIZE_MAX), count = json_array_size(joints);
    matrix *out = calloc(count, sizeof *out);
    for (size_t k = 0; k < count; k++) {
        matrix bind = identity();
        for (size_t i = 0; i < 16 && binds != SIZE_MAX; i++)
            bind.m[i % 4][i / 4] = number_at(t, binds, k, i, 16);
        out[k] = times(&worlds[(size_t)json_integer_value(json_array_get(joints, k))], &bind);
    }
    return out;
}

/* The matrix that a skinned vertex is multiplied with. */
static matrix blended(const gltf_truth *t, const matrix *joints, json_t *attributes, size_t vertex)
{
    matrix sum = {{{0}}};
    size_t numbers = whole(attributes, "JOINTS_0", 0), weights = whole(attributes, "WEIGHTS_0", 0);
    double total = 0, weight[4];
    for (size_t k = 0; k < 4; k++)
        total += weight[k] = number_at(t, weights, vertex, k, 4);
    for (size_t k = 0; k < 4; k++) {
        const matrix *m = weight[k] != 0 ? &joints[(size_t)number_at(t, numbers, vertex, k, 4)] : NULL;
        for (int i = 0; m && i < 16; i++)
            sum.m[i / 4][i % 4] += weight[k] / total * m->m[i / 4][i % 4];
    }
    return sum;
}

static void corner_at(const gltf_truth *t, json_t *primitive, const matrix *joints, const state *s, const matrix *world,
                      size_t vertex, double out[3])
{
    json_t *attributes = json_object_get(primitive, "attributes"), *targets = json_object_get(primitive, "targets");
    double  p[4] = {0, 0, 0, 1};
    for (size_t k = 0; k < 3; k++) {
        p[k] = number_at(t, whole(attributes, "POSITION", 0), vertex, k, 3);
        for (size_t m = 0; m < json_array_size(targets); m++)
            p[k] += s->weights[m] * number_at(t, whole(json_array_get(targets, m), "POSITION", 0), vertex, k, 3);
    }
    matrix full = joints ? blended(t, joints, attributes, vertex) : *world;
    for (int r = 0; r < 3; r++) {
        out[r] = 0;
        for (int c = 0; c < 4; c++)
            out[r] += full.m[r][c] * p[c];
    }
}

static size_t primitive_corners(json_t *primitive, const gltf_truth *t)
{
    size_t indices = whole(primitive, "indices", SIZE_MAX);
    return count_of(t, indices != SIZE_MAX ? indices : whole(json_object_get(primitive, "attributes"), "POSITION", 0));
}

size_t gltf_truth_corners(const gltf_truth *t, size_t clip, double seconds, double (**out)[3])
{
    size_t  nodes = json_array_size(json_object_get(t->root, "nodes")), count = 0, visited = 0, i, k;
    state  *states = calloc(nodes, sizeof *states);
    matrix *worlds = calloc(nodes, sizeof *worlds), top = identity();
    size_t *order = calloc(nodes, sizeof *order);
    json_t *root, *primitive;
    for (i = 0; i < nodes; i++)
        rest_state(t, item(t, "nodes", i), &states[i]);
    if (clip != SIZE_MAX)
        apply(t, item(t, "animations", clip), seconds, states);
    json_array_foreach(json_object_get(item(t, "scenes", whole(t->root, "scene", 0)), "nodes"), i, root)
        walk(t, states, (size_t)json_integer_value(root), &top, worlds, order, &visited);
    *out = NULL;
    for (size_t n = 0; n < visited; n++) {
        json_t *node = item(t, "nodes", order[n]);
        size_t  mesh = whole(node, "mesh", SIZE_MAX), skin = whole(node, "skin", SIZE_MAX);
        if (mesh == SIZE_MAX)
            continue;
        matrix *joints = skin == SIZE_MAX ? NULL : skin_matrices(t, item(t, "skins", skin), worlds);
        json_array_foreach(json_object_get(item(t, "meshes", mesh), "primitives"), k, primitive)
        {
            size_t more = primitive_corners(primitive, t), indices = whole(primitive, "indices", SIZE_MAX);
            *out = realloc(*out, (count + more) * sizeof **out);
            for (size_t c = 0; c < more; c++)
                corner_at(t, primitive, joints, &states[order[n]], &worlds[order[n]],
                          indices == SIZE_MAX ? c : (size_t)number_at(t, indices, c, 0, 1), (*out)[count++]);
        }
        free(joints);
    }
    free(states);
    free(worlds);
    free(order);
    return count;
}

size_t gltf_truth_clip_count(const gltf_truth *t)
{
    return json_array_size(json_object_get(t->root, "animations"));
}

double gltf_truth_duration(const gltf_truth *t, size_t clip)
{
    json_t *sampler;
    size_t  i;
    double  end = 0;
    json_array_foreach(json_object_get(item(t, "animations", clip), "samplers"), i, sampler)
    {
        size_t in = whole(sampler, "input", 0);
        end = fmax(end, number_at(t, in, count_of(t, in) - 1, 0, 1));
    }
    return end;
}
