// The two ways in which a glTF file comes: JSON text, or a binary file (GLB) with the text and one buffer inside.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "steradian/result.h"

namespace steradian::gltf {

/// Views into the file's bytes.
struct Container {
    std::string_view json;
    std::optional<uint64_t> json_begin;      ///< of a binary file: the byte at which the text begins
    std::optional<std::string_view> binary;  ///< what the first buffer without a URI holds
};

/// Told by the first four bytes, whatever the name. GLB must be version 2 (glTF 2.0 specification, section 4), with
/// all lengths inside of the file; chunks of unknown types are skipped, bytes behind the end are a warning.
Result<Container> open_container(std::string_view bytes, const std::string& name, Diagnostics& diagnostics);

}  // namespace steradian::gltf
