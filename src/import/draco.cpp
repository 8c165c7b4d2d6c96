// Draco for C. No exception leaves this file.
#include "import/draco.h"

#include <cstring>
#include <memory>
#include <new>

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

struct draco_model {
    std::unique_ptr<draco::Mesh> mesh;
};

bool draco_is_built(void)
{
    return true;
}

draco_model *draco_open(const unsigned char *bytes, size_t size)
{
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char *>(bytes), size);
        draco::Decoder decoder;
        auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok())
            return nullptr;
        std::unique_ptr<draco_model> model(new draco_model);
        model->mesh = std::move(decoded).value();
        return model.release();
    } catch (...) {
        return nullptr;
    }
}

void draco_close(draco_model *model)
{
    delete model;
}

size_t draco_vertex_count(const draco_model *model)
{
    return model->mesh->num_points();
}

size_t draco_triangle_count(const draco_model *model)
{
    return model->mesh->num_faces();
}

void draco_read_indices(const draco_model *model, uint32_t *out)
{
    for (uint32_t i = 0; i < model->mesh->num_faces(); i++) {
        const draco::Mesh::Face &face = model->mesh->face(draco::FaceIndex(i));
        for (int k = 0; k < 3; k++)
            *out++ = face[k].value();
    }
}

static float integer_range(draco::DataType type)
{
    switch (type) {
    case draco::DT_INT8: return 127.0f;
    case draco::DT_UINT8: return 255.0f;
    case draco::DT_INT16: return 32767.0f;
    case draco::DT_UINT16: return 65535.0f;
    default: return 1.0f;
    }
}

bool draco_read_attribute(const draco_model *model, uint32_t id, int components, bool normalized, float *out)
{
    const draco::PointAttribute *attribute = model->mesh->GetAttributeByUniqueId(id);
    if (!attribute || components < 1 || components > 4)
        return false;
    int have = attribute->num_components() < components ? attribute->num_components() : components;
    // Draco's own conversion already divides when the attribute says so itself.
    float scale = normalized && !attribute->normalized() ? 1.0f / integer_range(attribute->data_type()) : 1.0f;
    for (uint32_t i = 0; i < model->mesh->num_points(); i++) {
        float value[4] = {0, 0, 0, 1};
        draco::AttributeValueIndex index = attribute->mapped_index(draco::PointIndex(i));
        if (index.value() >= attribute->size() ||
            !attribute->ConvertValue<float>(index, static_cast<int8_t>(have), value))
            return false;
        for (int k = 0; k < have; k++)
            value[k] *= scale;
        std::memcpy(out + static_cast<size_t>(i) * static_cast<size_t>(components), value,
                    static_cast<size_t>(components) * sizeof(float));
    }
    return true;
}
