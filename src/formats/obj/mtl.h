// Wavefront material libraries.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "formats/mesh_file.h"

namespace steradian {

struct MaterialLibrary {
    std::vector<MeshMaterial> materials;  ///< in file order; of equal names the first one counts
    Diagnostics diagnostics;
};

/// Reads an MTL file from memory; `name` stands for it in messages, texture names are resolved against `folder`.
/// Values that make no sense are warnings with their place and leave the default, since the surfaces do not depend on
/// them. Errors: UTF-16 text; a texture outside the folder where the options do not allow it.
Result<MaterialLibrary> parse_mtl(std::string_view text, const std::string& name, const std::string& folder,
                                  const LoadOptions& options);

}  // namespace steradian
