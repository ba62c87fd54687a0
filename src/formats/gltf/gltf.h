// glTF 2.0, as text (.gltf) and as a binary file (.glb).
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "steradian/load.h"

namespace steradian::gltf {

/// Paths in it are relative to `folder`, and stay inside of it unless the options say otherwise. What is there is
/// read leniently: what can be rendered is, with warnings. Throws json::ReadFailure. `lookup_steps`, for tests: how
/// many members of objects were passed in looking for others.
LoadedScene load(std::string_view bytes, const std::string& name, const std::string& folder, const LoadOptions& options,
                 uint64_t* lookup_steps = nullptr);

}  // namespace steradian::gltf
