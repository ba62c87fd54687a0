#include "formats/gltf/draco.h"

#include <draco/attributes/attribute_octahedron_transform.h>
#include <draco/attributes/attribute_quantization_transform.h>
#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>

#include <array>
#include <cmath>
#include <cstring>
#include <functional>

#include "formats/gltf/accessors.h"
#include "math/vector.h"

namespace steradian::gltf {
namespace {

/// The library believes what its data say about sizes. This asks our budget before it takes the memory: bytes go in,
/// false comes out when there is no more.
using Afford = std::function<bool(uint64_t)>;

/// What the attributes will take, as they are and as the whole numbers that are decoded first.
uint64_t attribute_bytes(const draco::PointCloud& cloud) {
    uint64_t values = 0;
    for (int32_t i = 0; i < cloud.num_attributes(); ++i) {
        const draco::PointAttribute& a = *cloud.attribute(i);
        values += static_cast<uint64_t>(a.num_components()) *
                  (2 * sizeof(int32_t) + static_cast<uint64_t>(draco::DataTypeLength(a.data_type())));
    }
    return values * cloud.num_points();
}

/// Draco bitstream specification, section "Edgebreaker Connectivity Data".
class BoundedEdgebreaker : public draco::MeshEdgebreakerDecoder {
public:
    explicit BoundedEdgebreaker(const Afford& afford) : afford_(afford) {}

protected:
    bool DecodeConnectivity() override {
        draco::DecoderBuffer ahead = *buffer();
        uint32_t vertices = 0, faces = 0;
        uint8_t attributes = 0;
        if (!draco::DecodeVarint(&vertices, &ahead) || !draco::DecodeVarint(&faces, &ahead) ||
            !ahead.Decode(&attributes))
            return false;
        // Tables of corners and of seams: one, and one for each kind of attribute.
        constexpr uint64_t kTable = 64, kSeams = 32;
        return afford_(faces * (kTable + kSeams * attributes)) && MeshEdgebreakerDecoder::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override {
        return afford_(attribute_bytes(*point_cloud())) && MeshEdgebreakerDecoder::DecodeAllAttributes();
    }

private:
    const Afford& afford_;
};

/// Section "Sequential Connectivity Data".
class BoundedSequential : public draco::MeshSequentialDecoder {
public:
    explicit BoundedSequential(const Afford& afford) : afford_(afford) {}

protected:
    bool DecodeConnectivity() override {
        draco::DecoderBuffer ahead = *buffer();
        uint32_t faces = 0;
        if (!draco::DecodeVarint(&faces, &ahead)) return false;
        constexpr uint64_t kFace = 2 * 3 * sizeof(uint32_t);
        return afford_(faces * kFace) && MeshSequentialDecoder::DecodeConnectivity();
    }
    bool DecodeAllAttributes() override {
        return afford_(attribute_bytes(*point_cloud())) && MeshSequentialDecoder::DecodeAllAttributes();
    }

private:
    const Afford& afford_;
};

/// "DRACO", the version, the kind of geometry, the kind of connectivity.
constexpr std::string_view kMagic = "DRACO";
constexpr size_t kMajor = 5, kMinor = 6, kGeometry = 7, kMethod = 8;

draco::Status decode(std::span<const std::byte> bytes, const Afford& afford, draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    draco::DecoderOptions options;
    for (const auto type :
         {draco::GeometryAttribute::POSITION, draco::GeometryAttribute::NORMAL, draco::GeometryAttribute::COLOR,
          draco::GeometryAttribute::TEX_COORD, draco::GeometryAttribute::GENERIC})
        options.SetAttributeBool(type, "skip_attribute_transform", true);
    if (bytes[kMethod] == std::byte{draco::MESH_EDGEBREAKER_ENCODING})
        return BoundedEdgebreaker(afford).Decode(options, &buffer, &mesh);
    return BoundedSequential(afford).Decode(options, &buffer, &mesh);
}

// --- From the library's attributes to elements of accessors ---

/// The library asks only where it dequantises by itself.
constexpr int kMostBits = 30;

/// Whole numbers over a range, as floats; section "Dequantize Values".
class Dequantizer {
public:
    /// False when the data say what makes no sense.
    bool init(const draco::PointAttribute& attribute) {
        if (!transform_.InitFromAttribute(attribute)) return false;
        const int bits = transform_.quantization_bits();
        if (bits < 1 || bits > kMostBits) return false;
        step_ = static_cast<double>(transform_.range()) / ((1u << bits) - 1);
        return true;
    }
    float value(int32_t code, int component) const {
        return static_cast<float>(static_cast<double>(transform_.min_value(component)) + code * step_);
    }

private:
    draco::AttributeQuantizationTransform transform_;
    double step_ = 0;
};

/// Unit vectors on the octahedron |x| + |y| + |z| = 1; section "Octahedral Coords to Unit Vector".
Vec3 unit_vector(int32_t s, int32_t t, int bits) {
    const double largest = (1u << bits) - 2;
    double y = s * 2 / largest - 1, z = t * 2 / largest - 1;
    const double x = 1 - std::fabs(y) - std::fabs(z), fold = max_of(-x, 0.0);
    y += y < 0 ? fold : -fold;
    z += z < 0 ? fold : -fold;
    const double length = std::sqrt(x * x + y * y + z * z);
    if (!(length > 1e-3)) return {0, 0, 0};
    return {static_cast<float>(x / length), static_cast<float>(y / length), static_cast<float>(z / length)};
}

constexpr int kMaxComponents = 4;

/// Calls `put(point, values)` for every point, with values of T; false where the attribute does not have such.
template <class T, class Put>
bool each_value(const draco::Mesh& mesh, const draco::PointAttribute& a, int components, Put put) {
    for (uint32_t i = 0; i < mesh.num_points(); ++i) {
        std::array<T, kMaxComponents> values{};
        const draco::AttributeValueIndex at = a.mapped_index(draco::PointIndex(i));
        if (at.value() >= a.size() || !a.ConvertValue<T>(at, static_cast<int8_t>(components), values.data()))
            return false;
        put(i, values);
    }
    return true;
}

bool read_floats(const draco::Mesh& mesh, const draco::PointAttribute& a, int components, float* out) {
    const draco::AttributeTransformData* transform = a.GetAttributeTransformData();
    if (!transform)
        return a.data_type() == draco::DT_FLOAT32 && a.num_components() == components &&
               each_value<float>(mesh, a, components, [&](uint32_t i, const auto& v) {
                   std::memcpy(out + size_t(i) * static_cast<size_t>(components), v.data(),
                               sizeof(float) * static_cast<size_t>(components));
               });
    if (transform->transform_type() == draco::ATTRIBUTE_QUANTIZATION_TRANSFORM) {
        Dequantizer dequantizer;
        return dequantizer.init(a) && a.num_components() == components &&
               each_value<int32_t>(mesh, a, components, [&](uint32_t i, auto& v) {
                   for (int c = 0; c < components; ++c)
                       out[size_t(i) * static_cast<size_t>(components) + static_cast<size_t>(c)] =
                           dequantizer.value(v[static_cast<size_t>(c)], c);
               });
    }
    draco::AttributeOctahedronTransform octahedron;
    if (!octahedron.InitFromAttribute(a) || a.num_components() != 2 || components != 3) return false;
    if (octahedron.quantization_bits() < 2 || octahedron.quantization_bits() > kMostBits) return false;
    return each_value<int32_t>(mesh, a, 2, [&](uint32_t i, auto& v) {
        const Vec3 n = unit_vector(v[0], v[1], octahedron.quantization_bits());
        for (int c = 0; c < 3; ++c) out[size_t(i) * 3 + static_cast<size_t>(c)] = n[c];
    });
}

/// For an accessor of whole numbers: those that are stored.
template <class T>
bool read_integers(const draco::Mesh& mesh, const draco::PointAttribute& a, int components, std::byte* out) {
    if (a.GetAttributeTransformData() || a.data_type() == draco::DT_FLOAT32 || a.num_components() != components)
        return false;
    return each_value<T>(mesh, a, components, [&](uint32_t i, const auto& v) {
        const size_t size = sizeof(T) * static_cast<size_t>(components);
        std::memcpy(out + i * size, v.data(), size);
    });
}

bool read_attribute(const draco::Mesh& mesh, const draco::PointAttribute& a, const Accessor& as, std::byte* out) {
    const int components = static_cast<int>(as.components);
    switch (as.component) {
        case ComponentType::f32:
            return read_floats(mesh, a, components, reinterpret_cast<float*>(out));
        case ComponentType::i8:
            return read_integers<int8_t>(mesh, a, components, out);
        case ComponentType::u8:
            return read_integers<uint8_t>(mesh, a, components, out);
        case ComponentType::i16:
            return read_integers<int16_t>(mesh, a, components, out);
        case ComponentType::u16:
            return read_integers<uint16_t>(mesh, a, components, out);
        case ComponentType::u32:
            return read_integers<uint32_t>(mesh, a, components, out);
    }
    return false;
}

}  // namespace

struct DracoMeshes::Decoded {
    draco::Mesh mesh;
    std::map<uint32_t, const draco::PointAttribute*> attributes;  ///< by their ids; the first of each
};

const DracoMeshes::Decoded& DracoMeshes::open(const Object& extension) {
    const uint32_t number = extension.require_reference("bufferView", context_.tables.buffer_views);
    if (const auto known = meshes_.find(number); known != meshes_.end()) return *known->second;
    const auto bytes = buffers_.view(number).bytes;
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto fail = [&](const std::string& message) { context_.source.fail(extension.offset(), message); };
    if (!text.starts_with(kMagic) || text.size() <= kMethod) fail("the buffer view does not hold Draco data");
    // Versions before 2.2 are not part of the extension.
    if (text[kMajor] != 2 || text[kMinor] != 2)
        fail("the Draco data are of version " + std::to_string(text[kMajor]) + "." + std::to_string(text[kMinor]) +
             ", expected 2.2");
    if (text[kGeometry] != draco::TRIANGULAR_MESH) fail("the Draco data are a point cloud, expected a mesh");
    if (text[kMethod] != draco::MESH_EDGEBREAKER_ENCODING && text[kMethod] != draco::MESH_SEQUENTIAL_ENCODING)
        fail("the Draco data have an unknown kind of connectivity");
    context_.budget.grant(bytes);
    // No exception passes through the library.
    std::optional<json::ReadFailure> refused;
    const Afford afford = [&](uint64_t wanted) {
        try {
            context_.budget.take(wanted, context_.source, extension.offset());
        } catch (json::ReadFailure& failure) {
            refused = std::move(failure);
        }
        return !refused;
    };
    auto out = std::make_shared<Decoded>();
    const draco::Status status = decode(bytes, afford, out->mesh);
    if (refused) throw std::move(*refused);
    if (!status.ok()) fail("the Draco data cannot be decoded");
    for (int32_t i = 0; i < out->mesh.num_attributes(); ++i)
        out->attributes.emplace(out->mesh.attribute(i)->unique_id(), out->mesh.attribute(i));
    return *meshes_.emplace(number, std::move(out)).first->second;
}

void Accessors::decompress(const Object& primitive) {
    const auto extension = primitive.extension("KHR_draco_mesh_compression");
    if (!extension) return;
    const Object attributes(context_.source, primitive.require("attributes"), "'attributes'");
    const Object ids(context_.source, extension->require("attributes"), "'attributes'");
    const DracoMeshes::Decoded& decoded = draco_.open(*extension);
    const draco::Mesh& mesh = decoded.mesh;
    std::map<std::string_view, Value> accessors;
    for (const json::Member member : attributes.value().members()) accessors.emplace(member.key, member.value);
    if (primitive.integer_or("mode", 4, 0, 6) != 4)
        context_.source.fail(primitive.offset_of("mode"), "a primitive with Draco data must have the mode 4 here");

    // Puts elements in the place of those that the accessor has by itself.
    const auto put = [&](uint32_t number, uint64_t count, const auto& fill) {
        Accessor accessor = open(number);
        if (accessor.count != count)
            context_.source.fail(accessor.offset, "the accessor has " + std::to_string(accessor.count) +
                                                      " elements, its Draco data " + std::to_string(count));
        if (accessor.is_matrix)
            context_.source.fail(accessor.offset, "Draco data are scalars and vectors, not matrices");
        const uint64_t size = accessor.components * size_of(accessor.component);
        context_.budget.take(count * size, context_.source, accessor.offset);
        decoded_.push_back(std::make_unique<std::byte[]>(count * size));
        fill(accessor, decoded_.back().get());
        accessor.data = decoded_.back().get();
        accessor.stride = size;
        accessor.sparse = {};
        open_.insert_or_assign(number, accessor);
    };
    for (const json::Member member : ids.value().members()) {
        const uint64_t id = json::read_integer(context_.source, member.value, quoted(member.key), 0, 0xffffffffu);
        const auto named = accessors.find(member.key);
        if (named == accessors.end()) continue;
        const uint32_t number = read_reference(context_.source, named->second, member.key, context_.tables.accessors);
        if (!decompressed_.insert(number).second) continue;
        const auto attribute = decoded.attributes.find(static_cast<uint32_t>(id));
        if (attribute == decoded.attributes.end())
            context_.source.fail(member.value.offset(), "the Draco data have no attribute " + std::to_string(id));
        put(number, mesh.num_points(), [&](const Accessor& accessor, std::byte* out) {
            if (!read_attribute(mesh, *attribute->second, accessor, out))
                context_.source.fail(member.value.offset(), "the Draco attribute is not of the accessor's type: " +
                                                                std::to_string(accessor.components) + " times " +
                                                                std::string(name_of(accessor.component)));
        });
    }
    const auto indices = primitive.reference("indices", context_.tables.accessors);
    if (!indices) context_.source.fail(primitive.offset(), "a primitive with Draco data needs 'indices'");
    if (!decompressed_.insert(*indices).second) return;
    put(*indices, uint64_t(mesh.num_faces()) * 3, [&](Accessor& accessor, std::byte* out) {
        if (accessor.components != 1 || accessor.component == ComponentType::f32)
            context_.source.fail(accessor.offset, "indices must be scalars of whole numbers");
        const size_t size = size_of(accessor.component);
        for (uint32_t f = 0; f < mesh.num_faces(); ++f)
            for (int c = 0; c < 3; ++c) {
                const uint32_t corner = mesh.face(draco::FaceIndex(f))[c].value();
                if (size < 4 && corner >> 8 * size != 0)
                    context_.source.fail(accessor.offset, "the Draco data have vertices beyond the accessor's type");
                std::memcpy(out + (3 * size_t(f) + static_cast<size_t>(c)) * size, &corner, size);
            }
    });
}

}  // namespace steradian::gltf
