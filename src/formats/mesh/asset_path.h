// Names of files inside of model files.
#pragma once

#include <string>
#include <string_view>

namespace steradian {

/// The name with '/' for '\', made relative to the folder unless it is absolute.
std::string resolve_asset(std::string_view name, const std::string& folder);

/// Whether the name, as it stands, is absolute or climbs out of its folder.
bool leaves_folder(std::string_view name);

/// The folder of a file, "." when the path has none.
std::string folder_of(const std::string& path);

}  // namespace steradian
