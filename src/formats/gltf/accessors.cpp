#include "formats/gltf/accessors.h"

#include <array>
#include <cstring>

#include "math/vector.h"

namespace steradian::gltf {
namespace {

constexpr uint64_t kMaxCount = 0xffffffffu;  ///< vertices and indices have 32-bit numbers
constexpr uint64_t kMaxOffset = uint64_t(1) << 53;

template <class T>
T load(const std::byte* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return value;
}

ComponentType read_component_type(const Object& object) {
    const Value value = object.require("componentType");
    const uint64_t number = json::read_integer(object.source(), value, "'componentType'", 0, 0xffff);
    for (const ComponentType type : {ComponentType::i8, ComponentType::u8, ComponentType::i16, ComponentType::u16,
                                     ComponentType::u32, ComponentType::f32})
        if (static_cast<uint64_t>(type) == number) return type;
    object.source().fail(value.offset(), "'componentType' is " + std::to_string(number) +
                                             ", expected 5120, 5121, 5122, 5123, 5125 or 5126");
}

struct Shape {
    std::string_view name;
    uint32_t components, columns;
};
constexpr std::array<Shape, 7> kShapes{{{"SCALAR", 1, 1},
                                        {"VEC2", 2, 1},
                                        {"VEC3", 3, 1},
                                        {"VEC4", 4, 1},
                                        {"MAT2", 4, 2},
                                        {"MAT3", 9, 3},
                                        {"MAT4", 16, 4}}};

Shape read_shape(const Object& accessor) {
    std::array<std::string_view, kShapes.size()> names;
    for (size_t i = 0; i < kShapes.size(); ++i) names[i] = kShapes[i].name;
    return kShapes[json::read_choice(accessor.source(), accessor.require("type"), "'type'", names)];
}

/// The columns of a matrix begin at multiples of four bytes.
uint64_t element_size(Shape shape, ComponentType type) {
    const uint64_t size = shape.components * size_of(type);
    if (shape.columns == 1) return size;
    const uint64_t column = size / shape.columns;
    return (column + 3) / 4 * 4 * shape.columns;
}

uint64_t index_at(const std::byte* data, ComponentType type, uint64_t i) {
    switch (type) {
        case ComponentType::u8:
            return load<uint8_t>(data + i);
        case ComponentType::u16:
            return load<uint16_t>(data + 2 * i);
        default:
            return load<uint32_t>(data + 4 * i);
    }
}

bool is_index_type(ComponentType type) {
    return type == ComponentType::u8 || type == ComponentType::u16 || type == ComponentType::u32;
}

float component(const std::byte* at, ComponentType type, bool normalized) {
    const auto scaled = [&](float value, float most) { return normalized ? max_of(value / most, -1.0f) : value; };
    switch (type) {
        case ComponentType::i8:
            return scaled(load<int8_t>(at), 127);
        case ComponentType::u8:
            return scaled(load<uint8_t>(at), 255);
        case ComponentType::i16:
            return scaled(load<int16_t>(at), 32767);
        case ComponentType::u16:
            return scaled(load<uint16_t>(at), 65535);
        case ComponentType::u32:
            return scaled(static_cast<float>(load<uint32_t>(at)), 4294967295.0f);
        case ComponentType::f32:
            return load<float>(at);
    }
    return 0;
}

}  // namespace

size_t size_of(ComponentType type) noexcept {
    switch (type) {
        case ComponentType::i8:
        case ComponentType::u8:
            return 1;
        case ComponentType::i16:
        case ComponentType::u16:
            return 2;
        case ComponentType::u32:
        case ComponentType::f32:
            return 4;
    }
    return 4;
}

std::string_view name_of(ComponentType type) noexcept {
    switch (type) {
        case ComponentType::i8:
            return "BYTE";
        case ComponentType::u8:
            return "UNSIGNED_BYTE";
        case ComponentType::i16:
            return "SHORT";
        case ComponentType::u16:
            return "UNSIGNED_SHORT";
        case ComponentType::u32:
            return "UNSIGNED_INT";
        case ComponentType::f32:
            return "FLOAT";
    }
    return {};
}

float Accessor::number(uint64_t i, uint32_t c) const noexcept {
    return data ? gltf::component(data + i * stride + c * size_of(component), component, normalized) : 0;
}

float Accessor::element(uint64_t i, uint32_t c) const noexcept {
    uint64_t begin = 0, end = sparse.count;
    while (begin < end) {
        const uint64_t middle = begin + (end - begin) / 2;
        index_at(sparse.indices, sparse.index_type, middle) < i ? begin = middle + 1 : end = middle;
    }
    if (begin == sparse.count || index_at(sparse.indices, sparse.index_type, begin) != i) return number(i, c);
    return gltf::component(sparse.values + (begin * components + c) * size_of(component), component, normalized);
}

void Accessor::add_to(std::span<double> sums, uint32_t width, double factor) const noexcept {
    const auto add = [&](uint64_t i, uint32_t c, float x) { sums[i * width + c] += factor * static_cast<double>(x); };
    const auto is_sparse = [&](uint64_t i, uint64_t next) {
        return next < sparse.count && index_at(sparse.indices, sparse.index_type, next) == i;
    };
    for (uint64_t i = 0, next = 0; data && i < count; ++i)
        if (is_sparse(i, next))
            ++next;
        else
            for (uint32_t c = 0; c < components; ++c) add(i, c, number(i, c));
    for (uint64_t k = 0; k < sparse.count; ++k)
        for (uint32_t c = 0; c < components; ++c)
            add(index_at(sparse.indices, sparse.index_type, k), c,
                gltf::component(sparse.values + (k * components + c) * size_of(component), component, normalized));
}

/// `count` elements without gaps, of which an object says the buffer view and the offset in it.
const std::byte* Accessors::open_array(const Object& object, uint64_t count, uint64_t element_size) {
    const auto view = buffers_.view(object.require_reference("bufferView", context_.tables.buffer_views));
    const uint64_t begin = object.integer_or("byteOffset", 0, 0, kMaxOffset);
    if (begin > view.bytes.size() || count > (view.bytes.size() - begin) / element_size)
        context_.source.fail(object.offset(), std::to_string(count) + " elements of " + std::to_string(element_size) +
                                                  " bytes from byte " + std::to_string(begin) +
                                                  " do not fit into a buffer view with " +
                                                  std::to_string(view.bytes.size()));
    context_.budget.grant(view.bytes.subspan(begin, count * element_size));
    return view.bytes.data() + begin;
}

Accessor::Sparse Accessors::open_sparse(const Object& sparse, const Accessor& accessor) {
    Accessor::Sparse out;
    out.count = json::read_integer(context_.source, sparse.require("count"), "'count'", 1, accessor.count);
    const Object indices(context_.source, sparse.require("indices"), "'indices'");
    const Object values(context_.source, sparse.require("values"), "'values'");
    out.index_type = read_component_type(indices);
    if (!is_index_type(out.index_type))
        context_.source.fail(indices.offset_of("componentType"),
                             "sparse indices must be UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT");
    out.indices = open_array(indices, out.count, size_of(out.index_type));
    out.values = open_array(values, out.count, accessor.components * size_of(accessor.component));
    out.offset = indices.offset();
    return out;
}

/// Which element the k-th sparse one stands for. Fails where there is no such, or where it is not behind the one
/// before.
uint32_t Accessors::sparse_index(const Accessor& a, uint64_t k) const {
    const uint64_t index = index_at(a.sparse.indices, a.sparse.index_type, k);
    if (index >= a.count)
        context_.source.fail(a.sparse.offset, "sparse index " + std::to_string(k) + " is " + std::to_string(index) +
                                                  ", but the accessor has " + std::to_string(a.count) + " elements");
    if (k > 0 && index <= index_at(a.sparse.indices, a.sparse.index_type, k - 1))
        context_.source.fail(a.sparse.offset,
                             "sparse indices must increase, but number " + std::to_string(k) + " does not");
    return static_cast<uint32_t>(index);
}

const Accessor& Accessors::open(uint32_t number) {
    const auto known = open_.find(number);
    return known != open_.end() ? known->second : open_.emplace(number, check(number)).first->second;
}

Accessor Accessors::check(uint32_t number) {
    const Object object(context_.source, context_.tables.accessors.elements[number], "an accessor");
    const Shape shape = read_shape(object);
    Accessor out;
    out.offset = object.offset();
    out.component = read_component_type(object);
    out.normalized = object.boolean_or("normalized", false);
    out.components = shape.components;
    out.is_matrix = shape.columns > 1;
    out.count = json::read_integer(context_.source, object.require("count"), "'count'", 1, kMaxCount);
    if (out.normalized && out.component == ComponentType::f32) {
        context_.warn("an accessor with floats is marked as normalized, which has no effect",
                      object.offset_of("normalized"));
        out.normalized = false;
    }
    const uint64_t size = element_size(shape, out.component);
    if (const auto view_number = object.reference("bufferView", context_.tables.buffer_views)) {
        const auto view = buffers_.view(*view_number);
        const uint64_t begin = object.integer_or("byteOffset", 0, 0, kMaxOffset);
        out.stride = view.stride ? view.stride : size;
        if (out.stride < size)
            context_.source.fail(object.offset(), "elements of " + std::to_string(size) +
                                                      " bytes overlap at a stride of " + std::to_string(out.stride));
        // (count - 1) stride + size cannot wrap: count is below 2^32, the stride below 2^8.
        const uint64_t needed = (out.count - 1) * out.stride + size;
        if (begin > view.bytes.size() || needed > view.bytes.size() - begin)
            context_.source.fail(object.offset(), "the accessor needs " + std::to_string(needed) + " bytes from byte " +
                                                      std::to_string(begin) + " of a buffer view with " +
                                                      std::to_string(view.bytes.size()));
        context_.budget.grant(view.bytes.subspan(begin, needed));
        out.data = view.bytes.data() + begin;
    } else if (object.has("byteOffset")) {
        context_.warn("the byteOffset of an accessor without a buffer view has no effect",
                      object.offset_of("byteOffset"));
    }
    if (const auto sparse = object.object("sparse")) out.sparse = open_sparse(*sparse, out);
    return out;
}

/// Before elements of `size` bytes are made of an accessor's.
void Accessors::claim(const Accessor& a, size_t size) {
    if (a.data)
        context_.budget.take(a.count * size, context_.source, a.offset);
    else
        context_.budget.take_unread(a.count * size, context_.source, a.offset);
}

/// `set` makes an element of its components.
template <class T, class Set>
std::vector<T> Accessors::read(const Accessor& a, Set set) {
    claim(a, sizeof(T));
    std::vector<T> out(a.count);
    if (a.data)
        for (uint64_t i = 0; i < a.count; ++i) out[i] = set([&](uint32_t c) { return a.number(i, c); });
    Accessor changed = a;
    changed.data = a.sparse.values;
    changed.stride = a.components * size_of(a.component);
    for (uint64_t k = 0; k < a.sparse.count; ++k)
        out[sparse_index(a, k)] = set([&](uint32_t c) { return changed.number(k, c); });
    return out;
}

std::vector<Vec2> Accessors::read_vec2(const Accessor& accessor) {
    return read<Vec2>(accessor, [](auto c) { return Vec2{c(0), c(1)}; });
}

std::vector<Vec3> Accessors::read_vec3(const Accessor& accessor) {
    return read<Vec3>(accessor, [](auto c) { return Vec3{c(0), c(1), c(2)}; });
}

std::vector<Rgb> Accessors::read_rgb(const Accessor& accessor) {
    return read<Rgb>(accessor, [](auto c) { return Rgb{c(0), c(1), c(2)}; });
}

std::vector<float> Accessors::read_component(const Accessor& accessor, uint32_t component) {
    return read<float>(accessor, [component](auto c) { return c(component); });
}

std::vector<std::array<float, 4>> Accessors::read_vec4(const Accessor& accessor) {
    return read<std::array<float, 4>>(accessor, [](auto c) { return std::array<float, 4>{c(0), c(1), c(2), c(3)}; });
}

std::vector<Tangent> Accessors::read_tangents(const Accessor& accessor) {
    return read<Tangent>(accessor, [](auto c) { return Tangent{{c(0), c(1), c(2)}, c(3) < 0 ? -1.0f : 1.0f}; });
}

std::vector<uint32_t> Accessors::read_indices(const Accessor& a) {
    if (a.components != 1 || !is_index_type(a.component) || a.normalized)
        context_.source.fail(a.offset, "indices must be scalars of UNSIGNED_BYTE, UNSIGNED_SHORT or UNSIGNED_INT");
    claim(a, sizeof(uint32_t));
    std::vector<uint32_t> out(a.count);
    if (a.data)
        for (uint64_t i = 0; i < a.count; ++i)
            out[i] = static_cast<uint32_t>(index_at(a.data + i * a.stride, a.component, 0));
    for (uint64_t k = 0; k < a.sparse.count; ++k)
        out[sparse_index(a, k)] = static_cast<uint32_t>(index_at(a.sparse.values, a.component, k));
    return out;
}

}  // namespace steradian::gltf
