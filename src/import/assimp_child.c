/* What runs in the child process. It takes nothing from the parent but the path, and ends with _exit. */
#include <stdio.h>
#include <string.h>
#include <unistd.h>

#include <assimp/cimport.h>
#include <assimp/material.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include "import/assimp_stream.h"

/* Collects small writes; the first failure sticks. */
typedef struct pipe_writer {
    int           descriptor;
    bool          failed;
    size_t        used;
    unsigned char room[1 << 16];
} pipe_writer;

static void flush(pipe_writer *w)
{
    size_t done = 0;
    while (done < w->used && !w->failed) {
        ssize_t put = write(w->descriptor, w->room + done, w->used - done);
        if (put <= 0)
            w->failed = true;
        else
            done += (size_t)put;
    }
    w->used = 0;
}

static void put(pipe_writer *w, const void *bytes, size_t size)
{
    const unsigned char *from = bytes;
    while (size > 0 && !w->failed) {
        size_t some = sizeof w->room - w->used < size ? sizeof w->room - w->used : size;
        memcpy(w->room + w->used, from, some);
        w->used += some;
        from += some;
        size -= some;
        if (w->used == sizeof w->room)
            flush(w);
    }
}

static void put_u32(pipe_writer *w, uint32_t value)
{
    put(w, &value, sizeof value);
}

static void put_float(pipe_writer *w, float value)
{
    put(w, &value, sizeof value);
}

static void put_text(pipe_writer *w, const char *text, size_t size)
{
    put_u32(w, (uint32_t)size);
    put(w, text, size);
}

static void put_string(pipe_writer *w, const struct aiString *s)
{
    put_text(w, s->data, s->length < sizeof s->data ? s->length : sizeof s->data - 1);
}

static float material_float(const struct aiMaterial *m, const char *key, unsigned type, unsigned index, float otherwise)
{
    float value = otherwise;
    return aiGetMaterialFloatArray(m, key, type, index, &value, NULL) == aiReturn_SUCCESS ? value : otherwise;
}

static void put_material(pipe_writer *w, const struct aiMaterial *m)
{
    struct aiString name = {0}, texture = {0};
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

static void put_uvs(pipe_writer *w, const struct aiMesh *m, unsigned set)
{
    for (unsigned i = 0; i < m->mNumVertices; i++) {
        float pair[2] = {m->mTextureCoords[set][i].x, m->mTextureCoords[set][i].y};
        put(w, pair, sizeof pair);
    }
}

static void put_mesh(pipe_writer *w, const struct aiMesh *m)
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

static void put_node(pipe_writer *w, const struct aiNode *n, uint32_t parent, uint32_t *next)
{
    uint32_t own = (*next)++;
    const struct aiMatrix4x4 *t = &n->mTransformation;
    const float columns[16] = {t->a1, t->b1, t->c1, t->d1, t->a2, t->b2, t->c2, t->d2,
                               t->a3, t->b3, t->c3, t->d3, t->a4, t->b4, t->c4, t->d4};
    put_u32(w, parent);
    put_string(w, &n->mName);
    put(w, columns, sizeof columns);
    put_u32(w, n->mNumMeshes);
    put(w, n->mMeshes, n->mNumMeshes * sizeof *n->mMeshes);
    for (unsigned i = 0; i < n->mNumChildren; i++)
        put_node(w, n->mChildren[i], own, next);
}

static void put_scene(pipe_writer *w, const struct aiScene *s)
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

void assimp_child_write(const char *path, int descriptor)
{
    static pipe_writer w; /* this process is a throw-away copy: nobody shares it */
    w = (pipe_writer){.descriptor = descriptor};
    const struct aiScene *s = aiImportFile(path, aiProcess_Triangulate);
    if (s) {
        put_scene(&w, s);
    } else {
        const char *message = aiGetErrorString();
        put(&w, "E", 1);
        put_text(&w, message ? message : "", message ? strlen(message) : 0);
    }
    flush(&w);
}
