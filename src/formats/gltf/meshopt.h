// EXT_meshopt_compression: buffer views whose data are compressed.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "formats/gltf/object.h"

namespace steradian::gltf::meshopt {

enum class Mode : uint8_t { attributes, triangles, indices };
enum class Filter : uint8_t { none, octahedral, quaternion, exponential };

/// What a buffer view's extension says, as far as it makes sense: counts and strides that the mode and the filter
/// allow.
struct Header {
    Mode mode = Mode::attributes;
    Filter filter = Filter::none;
    uint64_t count = 0;   ///< elements
    uint64_t stride = 0;  ///< bytes of one
    uint64_t bytes() const noexcept { return count * stride; }
};
Header read_header(const Object& extension);

/// The elements; nothing where the data are not what they should be.
std::optional<std::string> decode(const Header& header, std::span<const std::byte> compressed);

/// Undoes a filter in place, in double and rounded once: the same numbers on every machine, which the extension does
/// not ask for. `data` holds whole elements.
void undo_filter(Filter filter, uint64_t stride, std::span<std::byte> data);

}  // namespace steradian::gltf::meshopt
