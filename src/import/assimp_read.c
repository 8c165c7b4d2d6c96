/* What runs behind the fence: assimp, which sees one file, in memory. */
#include <string.h>

#include <assimp/cfileio.h>
#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "base/memory.h"
#include "import/assimp_stream.h"

/* --- files as assimp wants them ------------------------------------------------------------------------- */

enum { OTHERS_MAX = 16 };

typedef struct model_file {
    const char          *name;
    const unsigned char *bytes;
    size_t               size;
    char                *others[OTHERS_MAX]; /* names that were asked for besides */
    uint32_t             other_count;
} model_file;

typedef struct open_file {
    struct aiFile     interface;
    const model_file *model;
    size_t            at;
} open_file;

static open_file *opened(struct aiFile *f)
{
    return (open_file *)f->UserData;
}

static size_t read_file(struct aiFile *f, char *out, size_t size, size_t count)
{
    open_file *o = opened(f);
    size_t     left = size ? (o->model->size - o->at) / size : 0, taken = count < left ? count : left;
    if (taken)
        memcpy(out, o->model->bytes + o->at, taken * size);
    o->at += taken * size;
    return taken;
}

static size_t write_file(struct aiFile *f, const char *bytes, size_t size, size_t count)
{
    (void)f, (void)bytes, (void)size, (void)count;
    return 0;
}

static size_t tell_file(struct aiFile *f)
{
    return opened(f)->at;
}

static size_t size_file(struct aiFile *f)
{
    return opened(f)->model->size;
}

static enum aiReturn seek_file(struct aiFile *f, size_t offset, enum aiOrigin origin)
{
    open_file *o = opened(f);
    size_t     size = o->model->size,
           from = origin == aiOrigin_SET   ? 0
                  : origin == aiOrigin_CUR ? o->at
                                           : size,
           to = from + offset;
    if (to > size)
        return aiReturn_FAILURE;
    o->at = to;
    return aiReturn_SUCCESS;
}

static void flush_file(struct aiFile *f)
{
    (void)f;
}

/* Assimp asks for neighbours of some formats, and of all whether they exist. */
static void remember(model_file *m, const char *name)
{
    for (uint32_t i = 0; i < m->other_count; i++)
        if (strcmp(m->others[i], name) == 0)
            return;
    if (m->other_count < OTHERS_MAX && (m->others[m->other_count] = mem_copy_text(name)))
        m->other_count++;
}

static struct aiFile *open_named(struct aiFileIO *io, const char *name, const char *mode)
{
    model_file *m = (model_file *)io->UserData;
    if (strchr(mode, 'w') || strcmp(name, m->name) != 0) {
        remember(m, name);
        return NULL;
    }
    open_file *o = mem_calloc(1, sizeof *o);
    if (!o)
        return NULL;
    o->model = m;
    o->interface = (struct aiFile){.ReadProc = read_file,
                                   .WriteProc = write_file,
                                   .TellProc = tell_file,
                                   .FileSizeProc = size_file,
                                   .SeekProc = seek_file,
                                   .FlushProc = flush_file,
                                   .UserData = (aiUserData)o};
    return &o->interface;
}

static void close_file(struct aiFileIO *io, struct aiFile *f)
{
    (void)io;
    mem_free(opened(f));
}

/* --- the model as a stream ------------------------------------------------------------------------------ */

static void put(fence_bytes *w, const void *bytes, size_t size)
{
    fence_put(w, bytes, size);
}

static void put_u32(fence_bytes *w, uint32_t value)
{
    fence_put_u32(w, value);
}

static void put_float(fence_bytes *w, float value)
{
    put(w, &value, sizeof value);
}

static void put_text(fence_bytes *w, const char *text, size_t size)
{
    put_u32(w, (uint32_t)size);
    put(w, text, size);
}

static void put_string(fence_bytes *w, const struct aiString *s)
{
    put_text(w, s->data, s->length < sizeof s->data ? s->length : sizeof s->data - 1);
}

static float material_float(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, float otherwise)
{
    float value = otherwise;
    return aiGetMaterialFloatArray(m, key, type, index, &value, NULL) == aiReturn_SUCCESS ? value : otherwise;
}

static void put_material(fence_bytes *w, const struct aiMaterial *m)
{
    struct aiString  name = {0}, texture = {0};
    struct aiColor4D diffuse = {1, 1, 1, 1}, emissive = {0, 0, 0, 1};
    aiGetMaterialString(m, AI_MATKEY_NAME, &name);
    if (aiGetMaterialColor(m, AI_MATKEY_COLOR_DIFFUSE, &diffuse) != aiReturn_SUCCESS)
        aiGetMaterialColor(m, AI_MATKEY_BASE_COLOR, &diffuse);
    aiGetMaterialColor(m, AI_MATKEY_COLOR_EMISSIVE, &emissive);
    if (aiGetMaterialTexture(m, aiTextureType_DIFFUSE, 0, &texture, NULL, NULL, NULL, NULL, NULL, NULL) !=
        aiReturn_SUCCESS)
        aiGetMaterialTexture(m, aiTextureType_BASE_COLOR, 0, &texture, NULL, NULL, NULL, NULL, NULL, NULL);
    put_string(w, &name);
    put_float(w, diffuse.r);
    put_float(w, diffuse.g);
    put_float(w, diffuse.b);
    put_float(w, material_float(m, AI_MATKEY_OPACITY, 1));
    put_float(w, emissive.r);
    put_float(w, emissive.g);
    put_float(w, emissive.b);
    put_float(w, material_float(m, AI_MATKEY_SHININESS, 0));
    put_float(w, material_float(m, AI_MATKEY_TWOSIDED, 0));
    put_string(w, &texture);
}

static void put_uvs(fence_bytes *w, const struct aiMesh *m, unsigned set)
{
    for (unsigned i = 0; i < m->mNumVertices; i++) {
        float pair[2] = {m->mTextureCoords[set][i].x, m->mTextureCoords[set][i].y};
        put(w, pair, sizeof pair);
    }
}

static void put_mesh(fence_bytes *w, const struct aiMesh *m)
{
    uint32_t flags = (m->mNormals ? STREAM_NORMALS : 0u) | (m->mTextureCoords[0] ? STREAM_UV0 : 0u) |
                     (m->mTextureCoords[1] ? STREAM_UV1 : 0u) | (m->mColors[0] ? STREAM_COLOURS : 0u);
    uint32_t triangles = 0;
    for (unsigned i = 0; i < m->mNumFaces; i++)
        triangles += m->mFaces[i].mNumIndices == 3;
    put_string(w, &m->mName);
    put_u32(w, m->mMaterialIndex);
    put_u32(w, flags);
    put_u32(w, m->mNumVertices);
    put_u32(w, triangles * 3);
    put_u32(w, m->mNumFaces - triangles);
    put(w, m->mVertices, (size_t)m->mNumVertices * sizeof *m->mVertices);
    if (m->mNormals)
        put(w, m->mNormals, (size_t)m->mNumVertices * sizeof *m->mNormals);
    if (m->mTextureCoords[0])
        put_uvs(w, m, 0);
    if (m->mTextureCoords[1])
        put_uvs(w, m, 1);
    if (m->mColors[0])
        put(w, m->mColors[0], (size_t)m->mNumVertices * sizeof *m->mColors[0]);
    for (unsigned i = 0; i < m->mNumFaces; i++)
        if (m->mFaces[i].mNumIndices == 3)
            put(w, m->mFaces[i].mIndices, 3 * sizeof(uint32_t));
}

static uint32_t count_nodes(const struct aiNode *n)
{
    uint32_t count = 1;
    for (unsigned i = 0; i < n->mNumChildren; i++)
        count += count_nodes(n->mChildren[i]);
    return count;
}

static void put_node(fence_bytes *w, const struct aiNode *n, uint32_t parent, uint32_t *next)
{
    uint32_t                  own = (*next)++;
    const struct aiMatrix4x4 *t = &n->mTransformation;
    const float               columns[16] = {t->a1, t->b1, t->c1, t->d1, t->a2, t->b2, t->c2, t->d2,
                                             t->a3, t->b3, t->c3, t->d3, t->a4, t->b4, t->c4, t->d4};
    put_u32(w, parent);
    put_string(w, &n->mName);
    put(w, columns, sizeof columns);
    put_u32(w, n->mNumMeshes);
    put(w, n->mMeshes, n->mNumMeshes * sizeof *n->mMeshes);
    for (unsigned i = 0; i < n->mNumChildren; i++)
        put_node(w, n->mChildren[i], own, next);
}

static void put_scene(fence_bytes *w, const struct aiScene *s)
{
    uint32_t next = 0;
    put(w, "M", 1);
    put_u32(w, s->mNumAnimations);
    put_u32(w, s->mNumMaterials);
    for (unsigned i = 0; i < s->mNumMaterials; i++)
        put_material(w, s->mMaterials[i]);
    put_u32(w, s->mNumTextures);
    for (unsigned i = 0; i < s->mNumTextures; i++) {
        /* Height 0 means a packed file of `width` bytes; raw pixels are not handed over. */
        const struct aiTexture *t = s->mTextures[i];
        put_text(w, (const char *)t->pcData, t->mHeight == 0 ? t->mWidth : 0);
    }
    put_u32(w, s->mNumMeshes);
    for (unsigned i = 0; i < s->mNumMeshes; i++)
        put_mesh(w, s->mMeshes[i]);
    put_u32(w, s->mRootNode ? count_nodes(s->mRootNode) : 0);
    if (s->mRootNode)
        put_node(w, s->mRootNode, UINT32_MAX, &next);
    put(w, "Z", 1);
}

lmn_status assimp_read(const unsigned char *request, size_t size, fence_bytes *answer, lmn_error *error)
{
    fence_reader r = fence_read(request, size);
    char        *name = fence_take_text(&r);
    if (!name)
        return error_memory(error);
    model_file            model = {.name = name, .bytes = r.at, .size = (size_t)(r.end - r.at)};
    struct aiFileIO       io = {.OpenProc = open_named, .CloseProc = close_file, .UserData = (aiUserData)&model};
    const struct aiScene *s = aiImportFileEx(name, aiProcess_Triangulate, &io);
    put_u32(answer, model.other_count);
    for (uint32_t i = 0; i < model.other_count; i++) {
        fence_put_text(answer, model.others[i]);
        mem_free(model.others[i]);
    }
    if (s) {
        put_scene(answer, s);
        aiReleaseImport(s);
    } else {
        const char *message = aiGetErrorString();
        put(answer, "E", 1);
        put_text(answer, message ? message : "", message ? strlen(message) : 0);
    }
    mem_free(name);
    return LMN_OK;
}
