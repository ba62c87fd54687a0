// Names that a glTF file has and the specification does not.
#pragma once

#include "formats/gltf/context.h"

namespace steradian::gltf {

/// Properties of the objects of section 5 of the specification: those that are spelt nearly as one that is known, or
/// that belong one level deeper, are warned about; others are listed where LoadOptions::locations asks for what has no
/// effect. What is below "extensions" and "extras" may have any names.
void find_unknown_properties(Context& context, const Object& root);

}  // namespace steradian::gltf
