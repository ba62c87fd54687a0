// Accessors: typed arrays in buffer views.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <vector>

#include "formats/gltf/draco.h"

namespace steradian::gltf {

enum class ComponentType : uint16_t { i8 = 5120, u8 = 5121, i16 = 5122, u16 = 5123, u32 = 5125, f32 = 5126 };
size_t size_of(ComponentType type) noexcept;
std::string_view name_of(ComponentType type) noexcept;

/// Where the elements are, checked: whatever is read by its numbers lies in a buffer. Nothing is believed of "min" and
/// "max". Only which elements are sparse is checked when they are read.
struct Accessor {
    size_t offset = 0;  ///< in the JSON, for messages
    ComponentType component = ComponentType::f32;
    bool normalized = false;  ///< integers stand for [0, 1] or [-1, 1]
    uint32_t components = 1;  ///< of one element
    bool is_matrix = false;
    uint64_t count = 0;
    const std::byte* data = nullptr;  ///< null: all elements are zero
    uint64_t stride = 0;
    struct Sparse {  ///< elements that differ
        uint64_t count = 0;
        ComponentType index_type = ComponentType::u32;
        const std::byte* indices = nullptr;
        const std::byte* values = nullptr;
        size_t offset = 0;  ///< of the indices, in the JSON
    } sparse = {};

    /// Scalars are vectors of one.
    bool has_vectors_of(uint32_t n) const noexcept { return components == n && !is_matrix; }
    /// Component c of element i as a float; `sparse` is not looked at.
    float number(uint64_t i, uint32_t c) const noexcept;
    /// The same with sparse elements in their places; takes the logarithm of their number.
    float element(uint64_t i, uint32_t c) const noexcept;
    /// Adds `factor` times each element to that of `sums`, whose elements have `width` components, at least as many.
    void add_to(std::span<double> sums, uint32_t width, double factor) const noexcept;
};

class Accessors {
public:
    Accessors(Context& context, Buffers& buffers) : context_(context), buffers_(buffers), draco_(context, buffers) {}

    /// Checked when it is first asked for.
    const Accessor& open(uint32_t number);

    /// Draco data of a primitive, if it has some, become what its accessors refer to (draco.cpp). Call it before they
    /// are opened.
    void decompress(const Object& primitive);

    // Elements as they are meant, after normalisation and with sparse ones in place. The number of components must be
    // that of the result; memory is taken from the budget.
    std::vector<Vec2> read_vec2(const Accessor& accessor);
    std::vector<Vec3> read_vec3(const Accessor& accessor);
    /// The first three components; there may be a fourth.
    std::vector<Rgb> read_rgb(const Accessor& accessor);
    /// Component c of each element.
    std::vector<float> read_component(const Accessor& accessor, uint32_t c);
    std::vector<std::array<float, 4>> read_vec4(const Accessor& accessor);
    std::vector<Tangent> read_tangents(const Accessor& accessor);
    /// Whole numbers that are not negative; fails for other types.
    std::vector<uint32_t> read_indices(const Accessor& accessor);

private:
    Accessor check(uint32_t number);
    Accessor::Sparse open_sparse(const Object& sparse, const Accessor& accessor);
    uint32_t sparse_index(const Accessor& accessor, uint64_t k) const;
    const std::byte* open_array(const Object& object, uint64_t count, uint64_t element_size);
    void claim(const Accessor& accessor, size_t size);
    template <class T, class Set>
    std::vector<T> read(const Accessor& accessor, Set set);

    Context& context_;
    Buffers& buffers_;
    std::map<uint32_t, Accessor> open_;
    DracoMeshes draco_;
    std::set<uint32_t> decompressed_;
    std::vector<std::unique_ptr<std::byte[]>> decoded_;
};

}  // namespace steradian::gltf
