// Draco for C. No exception leaves this file.
#include "import/draco_decode.h"

#include <memory>
#include <new>
#include <vector>

#include <draco/compression/decode.h>
#include <draco/mesh/mesh.h>

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

static bool read_values(const draco::Mesh &mesh, const draco::PointAttribute &attribute, int have,
                        std::vector<float> &values)
{
    for (uint32_t i = 0; i < mesh.num_points(); i++) {
        float *value = &values[static_cast<size_t>(i) * DRACO_COMPONENTS];
        value[3] = 1;
        draco::AttributeValueIndex index = attribute.mapped_index(draco::PointIndex(i));
        if (index.value() >= attribute.size() ||
            !attribute.ConvertValue<float>(index, static_cast<int8_t>(have), value))
            return false;
    }
    return true;
}

static bool put_attribute(const draco::Mesh &mesh, const draco::PointAttribute &attribute, draco_put_fn put, void *to)
{
    int have =
        attribute.num_components() < DRACO_COMPONENTS ? attribute.num_components() : static_cast<int>(DRACO_COMPONENTS);
    // Draco's own conversion already divides when the attribute says so itself.
    draco_attribute head = {attribute.unique_id(), attribute.normalized() ? 1.0f : integer_range(attribute.data_type()),
                            static_cast<uint32_t>(have)};
    std::vector<float> values(static_cast<size_t>(mesh.num_points()) * DRACO_COMPONENTS);
    // Values that cannot be had make an attribute without components: asking for it is an error, the rest is fine.
    if (!read_values(mesh, attribute, have, values))
        head.components = 0;
    return put(to, &head, sizeof head) && put(to, values.data(), values.size() * sizeof(float));
}

static draco_result put_mesh(const draco::Mesh &mesh, draco_put_fn put, void *to)
{
    const uint32_t counts[3] = {static_cast<uint32_t>(mesh.num_points()), static_cast<uint32_t>(mesh.num_faces()),
                                static_cast<uint32_t>(mesh.num_attributes())};
    if (!put(to, counts, sizeof counts))
        return DRACO_TOO_LARGE;
    for (uint32_t i = 0; i < mesh.num_faces(); i++) {
        const draco::Mesh::Face &face = mesh.face(draco::FaceIndex(i));
        const uint32_t           corners[3] = {face[0].value(), face[1].value(), face[2].value()};
        if (!put(to, corners, sizeof corners))
            return DRACO_TOO_LARGE;
    }
    for (int i = 0; i < mesh.num_attributes(); i++)
        if (!put_attribute(mesh, *mesh.attribute(i), put, to))
            return DRACO_TOO_LARGE;
    return DRACO_DONE;
}

draco_result draco_decode(const unsigned char *bytes, size_t size, draco_put_fn put, void *to)
{
    try {
        draco::DecoderBuffer buffer;
        buffer.Init(reinterpret_cast<const char *>(bytes), size);
        draco::Decoder decoder;
        auto           decoded = decoder.DecodeMeshFromBuffer(&buffer);
        if (!decoded.ok())
            return DRACO_DAMAGED;
        return put_mesh(*decoded.value(), put, to);
    } catch (const std::bad_alloc &) {
        return DRACO_TOO_LARGE;
    } catch (...) {
        return DRACO_DAMAGED;
    }
}
